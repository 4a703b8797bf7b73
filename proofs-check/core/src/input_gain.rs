//! Rule: an input gain that is known to an interval (docs/guide.md), and its numbers b (docs/mathematics.md, section 13.1).
//!
//! The gain of the actuator signal is one constant in `[low, high]`, and the regulator puts out u/nominal. So what reaches the plant is
//! b u with a constant b in `[b_lo, b_hi] = [low/nominal, high/nominal]`.
//!
//! Guarantee: `0 < low <= nominal <= high`, so `0 < b_lo <= 1 <= b_hi`.
//!
//! What it changes: `e' = q + b u` with a constant b in `[b_lo, b_hi]`, `0 < b_lo <= 1 <= b_hi`. With `y := q + (1-b) sigma e + b mu s` it is
//! `e' = y - sigma e`, `zeta' = Phi zeta - M y`: the loop of gain 1 with `b mu` for mu and `q + (1-b) sigma e` for q. With G as in section
//! 3, which is imaginary at `i om`, `Y := b mu G/i` and the harmonics q_j of a T-periodic q,
//! `|i om + b sigma + i Y (i om + sigma)|^2 = b^2 sigma^2 + om^2 + 2 (1-b) sigma om Y + (sigma^2 + om^2) Y^2`, of which the least over Y is
//! `(b sigma^2 + om^2)^2/(sigma^2 + om^2)`. So `|e_j| <= |q_j| sqrt(sigma^2 + om^2)/(b sigma^2 + om^2)`, and `e_0 = 0`.

use crate::constant::{Constant, expression_with, positive_with};
use crate::expr::Named;
use crate::interval::Interval;
use crate::json::{Field, Fields};
use crate::plant::parameters::Parameter;
use crate::range::{Range, Span, both, ends};
use crate::verdict::{Outcome, bad};

/// The name of the rule.
pub const RULE: &str = "input gain";

/// Takes `input_gain` out of a file, if it is there. Names of a plant's constants may stand in its numbers, and those of parameters of which
/// intervals are given. In `nominal` these have their nominal values; of an expression `low` is a number below, and `high` one above, what
/// it is for all values of them.
pub fn read(file: &mut Fields<'_>, constants: &[Named], intervals: &[Parameter]) -> Outcome<Option<Range>> {
    let names: Vec<&str> = intervals.iter().map(|parameter| parameter.name.as_str()).collect();
    let family: Vec<Span> = intervals.iter().map(|parameter| parameter.span.clone()).collect();
    let nominal = intervals.iter().map(|Parameter { name, range, .. }| Named {
        name: name.clone(),
        text: range.nominal.text.clone(),
        value: range.nominal.expr().clone(),
    });
    let at_nominal: Vec<Named> = constants.iter().cloned().chain(nominal).collect();
    let positive = |fields: &mut Fields<'_>, name: &str| {
        let field = fields.required(name)?;
        let text = field.numeral()?;
        if name == "nominal" {
            return positive_with(&field, name, &at_nominal);
        }
        if !names.iter().any(|name| occurs(name, text)) {
            return positive_with(&field, name, constants);
        }
        let (expr, written) = expression_with(&field, &names, constants)?;
        let Some([low, high]) = ends(&expr, &family).filter(|[low, _]| *low > 0) else {
            return bad(&field.pointer, "this need not be positive for all values of its parameters");
        };
        Ok(Constant::standing_for(written, if name == "low" { low } else { high }))
    };
    file.part("input_gain", |field| Range::read(field, RULE, positive))
}

/// Whether a name occurs in the text of an expression.
fn occurs(name: &str, text: &str) -> bool {
    text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_' || c == '.')).any(|word| word == name)
}

/// b_lo and b_hi.
pub fn factors(gain: &Range, precision: u32) -> [Interval; 2] {
    let one = Interval::int(1, precision);
    let factor = |end: &Constant| match end.rational().zip(gain.nominal.rational()) {
        Some((end, nominal)) => Interval::rational(&(end / nominal), precision),
        None => end.enclose(precision) / gain.nominal.enclose(precision),
    };
    [factor(&gain.low).min(&one), factor(&gain.high).max(&one)]
}

/// That a claim names the gain of the file, and names none where the file has none.
pub fn agrees(asked: Option<&Range>, claimed: Option<&Field<'_>>, claim: &str) -> Outcome<()> {
    both(RULE, "input_gain", asked, claimed, claim)?.map_or(Ok(()), |(asked, field)| asked.agrees(field, RULE))
}

/// What a claim is about besides, where there is a gain.
pub fn in_words(gain: Option<&Range>) -> String {
    let Some(Range { nominal, low, high }) = gain else { return String::new() };
    let [nominal, low, high] = [nominal, low, high].map(|constant| &constant.words);
    let which = match low == high {
        true => format!("the input gain {low} ("),
        false => format!("every input gain in [{low}, {high}] (one constant; "),
    };
    format!(" and {which}the regulator divides its control by the nominal gain {nominal})")
}

/// What the regulator puts out, in words: u over the nominal gain.
pub fn output(gain: &Range) -> String {
    let nominal = &gain.nominal.words;
    // Another quotient or product is one number.
    if nominal.parse::<f64>().is_ok() { format!("u/{nominal}") } else { format!("u/({nominal})") }
}

/// b_lo and b_hi, which are not both 1.
#[derive(Clone, Debug)]
pub struct Gain {
    pub low: Interval,
    pub high: Interval,
}

impl Gain {
    /// That of a file; none where b is 1.
    pub fn new(given: Option<&Range>, precision: u32) -> Option<Gain> {
        let [low, high] = factors(given.filter(|given| !given.is_nominal())?, precision);
        Some(Gain { low, high })
    }

    /// `b_m = min{1, b_lo} = b_lo`: what bounds e by q or by q' is divided by it, for `b sigma^2 + om^2 >= b_m (sigma^2 + om^2)`.
    pub fn of_error(&self) -> &Interval {
        &self.low
    }

    /// d_b at b_lo: `|om e_j| <= d_b |q_j|`, where d_b is 1 from b = 1/2 on, else `1/(2 sqrt(b (1-b)))`, which decreases in b and is
    /// not below 1.
    pub fn of_slope(&self) -> Interval {
        let one = Interval::int(1, self.low.precision());
        if one.le(&(&self.low * 2)) == Some(true) {
            return one;
        }
        ((&self.low * (1 - &self.low)).sqrt() * 2).recip().max(&one)
    }

    /// c_m, the lesser of c_b at both ends, with `c_b = b` for `b <= 1`, else `2/sqrt(3 + b)`: `|y_j|^2 (1 + Y^2) <= |q_j|^2/c_b^2`.
    pub fn of_answer(&self) -> Interval {
        self.low.min(&(2 / (&self.high + 3).sqrt()))
    }

    /// `b_lo^3 <= b c_b^2`: over a period sup - inf of `|zeta|_N^2` is at most `T rms(y - b mu s)^2/(2 b mu)`, and `|y_j - b mu s_j| <= |q_j|/c_b`.
    pub fn of_swing(&self) -> Interval {
        self.low.sqr() * &self.low
    }

    /// `(1-b) moved` at b_lo and at b_hi.
    pub fn shifts(&self, moved: &Interval) -> [Interval; 2] {
        [(1 - &self.low) * moved, (1 - &self.high) * moved]
    }

    /// The two sides of (B), `(1 + ht (1-b) sigma)^2` where it is largest and `4 ht sigma`: the first below the second means that
    /// `2 sigma e^2 - 2 (1 + ht (1-b) sigma) e y + 2 ht y^2` is positive definite for every b.
    pub fn undamped(&self, ht: &Interval, sigma: &Interval) -> [Interval; 2] {
        let moved = ht * sigma;
        let [low, high] = self.shifts(&moved).map(|shift| (1 + shift).sqr());
        [low.max(&high), moved * 4]
    }

    /// The k_e and the upper end of `delta + (1-b) sigma` over b, with delta between `-k_e` and max(most, 0), or `most` itself where (B)
    /// holds. C5 by it holds at every larger sigma.
    ///
    /// At `sigma' = sigma/l`, 0 < l <= 1, `ht' = l ht` serves. In `sqrt(l) e` and `y/sqrt(l)` the form of `e`, `y` and delta is l times that at
    /// sigma and (1 - l) times that of delta = 0, of which (B) says that it is not negative. Without (B), 0 is one of the delta.
    pub fn sector(&self, [ht, sigma]: [&Interval; 2], [k_e, most]: [&Interval; 2]) -> [Interval; 2] {
        let [undamped, room] = self.undamped(ht, sigma);
        let zero = Interval::int(0, ht.precision());
        let most = if undamped.lt(&room) == Some(true) { most.clone() } else { most.max(&zero) };
        let [up, down] = self.shifts(sigma);
        [k_e - down, most + up]
    }

    /// `g_k` of section 10.4, with the numbers sigma and kap: `1/(b_lo sigma + kap)` if `kap <= (2 - b_lo) sigma`, else
    /// `1/(2 sqrt(sigma (kap - (1 - b_lo) sigma)))`, which is nowhere below it. With `beta = b sigma + kap` it is the largest
    /// `sqrt(sigma^2 + om^2)/(beta sigma + om^2)`, and it decreases in b and in sigma.
    pub fn damped(&self, sigma: &Interval, kap: &Interval) -> Interval {
        if kap.le(&((2 - &self.low) * sigma)) == Some(true) {
            return (&self.low * sigma + kap).recip();
        }
        ((sigma * (kap - (1 - &self.low) * sigma)).sqrt() * 2).recip()
    }
}
