//! Rule: bounding functions are finite and nondecreasing in X and in E, and nowhere certainly negative (docs/mathematics.md,
//! section 1).
//!
//! The proof, a list of cuts and reasons, is proposed and then verified ([`crate::monotone`]). What is used of a function is its
//! positive part (but for `q_e_max` and `rate`, which may be negative): a bound of a norm is one without its negative values too, so a sign that rounding leaves open, as at an
//! origin where the value is exactly 0, does no harm.

use crate::bound::{BOUND_NAMES, Bound};
use crate::data::Data;
use crate::effort;
use crate::expr::Expr;
use crate::interval::Interval;
use crate::monotone::Function;
use crate::propose::{Proposal, cuts, square_free};
use crate::verdict::{Outcome, Verdict, finding, invalid};
use rug::Rational;

/// The name of this rule.
pub const RULE: &str = "bounding functions";
const NONDECREASING: [&str; 2] = ["nondecreasing", "decreases"];
/// For the opposite of an expression.
const NONINCREASING: [&str; 2] = ["nonincreasing", "increases"];

/// Proves the bound of a norm finite and nondecreasing on [0, x] x [0, e], and not negative at the origin.
///
/// # Errors
/// `invalid` with two points where it certainly decreases, or one where it is certainly negative; `undecided` with a
/// place, when the bounded effort does not settle it.
pub fn prove(name: &str, expr: &Expr, x: &Rational, e: &Rational, precision: u32) -> Outcome<()> {
    let pointer = format!("/specification/bounds/{name}");
    let zero = Interval::int(0, precision);
    if expr.enclose(&zero, &zero).lt(&zero) == Some(true) {
        return invalid(RULE, &pointer, "it is negative at X = 0, E = 0");
    }
    nondecreasing(&pointer, NONDECREASING, expr, [x, e], precision)
}

/// Proves an expression of any sign finite and nondecreasing on [0, x] x [0, e]; the words say what is proved and what refutes
/// it.
///
/// # Errors
/// As for [`prove`].
pub fn nondecreasing(
    pointer: &str,
    [proved, refuted]: [&str; 2],
    expr: &Expr,
    [x, e]: [&Rational; 2],
    precision: u32,
) -> Outcome<()> {
    let function = Function::new(expr, &square_free, precision);
    let whole = [x, e].map(|end| [Rational::new(), end.clone()]);
    let open = match effort::aside(|| cuts(&function, &whole)) {
        Proposal::Steps(steps) if function.verify(whole.clone(), &steps) => return Ok(()),
        Proposal::Decrease([low, high]) if decreases(&function, &low, &high) => {
            let [x0, e0, x1, e1] = [&low[0], &low[1], &high[0], &high[1]].map(Rational::to_f64);
            let message = format!("it {refuted} from X = {x0}, E = {e0} to X = {x1}, E = {e1}");
            return invalid(RULE, pointer, message);
        }
        Proposal::Open(piece) => piece,
        _ => whole,
    };
    let [[x0, x1], [e0, e1]] = open.each_ref().map(|ends| ends.each_ref().map(Rational::to_f64));
    let message = format!("that it is finite and {proved} is not proved on [{x0}, {x1}] x [{e0}, {e1}]");
    Err(finding(Verdict::Undecided, RULE, pointer, message))
}

/// Whether it certainly decreases from a point to one that is nowhere below it.
fn decreases(function: &Function<'_>, low: &[Rational; 2], high: &[Rational; 2]) -> bool {
    let above = low[0] <= high[0] && low[1] <= high[1];
    above && function.at(high.each_ref()).lt(&function.at(low.each_ref())) == Some(true)
}

/// Proves every bounding function on [0, x] times [0, e]: q_e_max may have any sign, and a rate does not increase.
pub fn prove_all(d: &Data<'_>, [x, e]: [&Interval; 2], lines: &mut Vec<String>) -> Outcome<()> {
    let (Some(x), Some(e)) = (x.upper(), e.upper()) else {
        return invalid(RULE, "/witness", "an argument is not finite");
    };
    for (index, (name, expr)) in BOUND_NAMES.iter().zip(&d.spec.bounds).enumerate() {
        match expr {
            Some(expr) if index == Bound::QeMax as usize => {
                nondecreasing("/specification/bounds/q_e_max", NONDECREASING, expr, [&x, &e], d.precision)?;
            }
            Some(expr) => prove(name, expr, &x, &e, d.precision)?,
            None => {}
        }
    }
    if let Some(rate) = &d.spec.rate {
        nondecreasing("/specification/lyapunov/rate", NONINCREASING, &rate.negated(), [&x, &e], d.precision)?;
    }
    let (x, e) = (x.to_f64(), e.to_f64());
    lines.push(format!("bounding functions: finite, nondecreasing, nowhere certainly negative up to X = {x}, E = {e}"));
    Ok(())
}
