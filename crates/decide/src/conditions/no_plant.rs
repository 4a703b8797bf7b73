//! Data that no plant with a state can have.
//!
//! For a plant with n >= 1 states and `F(t) = df/dx(t,0,0)`, Taylor's formula gives `|F x| <= |f(t,x,0)| + b_fxx(X,0) X^2/2` on
//! |x| = X, so for every X > 0 at which the bounding functions hold
//!
//! ```text
//! sup_t |F(t)| <= b_f(X,0)/X + b_fxx(X,0) X/2,   and where b_fx is given   sup_t |F(t)| <= b_fx(X,0).
//! ```
//!
//! Along `x' = F x` the triple gives `|x(t)| <= c e^(-alpha t) |x(0)|`, and `|x(t)| >= e^(-t sup|F|) |x(0)|` always, so
//! `alpha <= sup|F|`; and so is a rate a(0,0) that is given for the same P. A Jacobian says more: at each t, |F(t)| is at least the Euclidean norm of a column, hence of the least
//! magnitudes of its entries. Where one X contradicts one of the two, no plant with a state satisfies the data, and what
//! is proved about all of them is proved about none. Data without x (no Jacobian, and b_f, b_fe, b_fxx, b_fex, b_qx all 0)
//! are those of a plant without states.

use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, Portable, round_f64, round_rational, write_exact};
use sigmastar_lang::expr::Expr;
use sigmastar_lang::spec::model::{Jacobian, JacobianEntry};
use sigmastar_theory::data::{Bound, Data, Problem};
use sigmastar_theory::jacobian::Family;
use std::fmt;

/// Digits of the X that is named.
const DIGITS: u32 = 6;
/// X is scanned over this many decades below and above 1, in steps of a quarter of a decade.
const DECADES: i32 = 40;
/// The best candidates are decided over enclosures, and of the others each of this number: cancellation in double precision
/// may make bad ones look best.
const DECIDED: usize = 8;
/// Times in a period at which the columns of a Jacobian are looked at.
const TIMES: u32 = 64;

/// Why no plant with a state x satisfies the data.
#[derive(Clone, Debug)]
pub struct NoPlant {
    /// X > 0.
    pub x: Rational,
    /// `b_f(X,0)/X + b_fxx(X,0) X/2`, or b_fx(X,0) where that is smaller, which |df/dx(t,0,0)| cannot exceed.
    pub rate_at_most: Enclosure,
    /// Whether it is b_fx.
    pub by_f_x: bool,
    /// What exceeds it.
    pub exceeded_by: ExceededBy,
}

/// A lower bound of sup|F|.
#[derive(Clone, Debug)]
pub enum ExceededBy {
    /// alpha.
    Alpha {
        /// Its value.
        alpha: Enclosure,
    },
    /// a(0, 0), a rate that is given.
    Rate {
        /// Its value.
        rate: Enclosure,
    },
    /// A column of the Jacobian.
    Jacobian {
        /// The time as a fraction of the period.
        fraction: Rational,
        /// The index of the column, from 0.
        column: usize,
        /// The norm of the least magnitudes of its entries.
        norm: Enclosure,
    },
}

impl fmt::Display for NoPlant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (x, rate) = (write_exact(&self.x), self.rate_at_most.upper_decimal(6));
        let formula = if self.by_f_x { "f_x(X,0)" } else { "f(X,0)/X + f_xx(X,0) X/2" };
        write!(
            f,
            "no plant with a state x satisfies these data: at X = {x} they allow |df/dx(t,0,0)| <= {formula} <= {rate}, \
             but "
        )?;
        let least = self.exceeded_by.value().lower_decimal(6);
        match &self.exceeded_by {
            ExceededBy::Alpha { .. } => write!(f, "alpha >= {least} needs |df/dx(t,0,0)| >= alpha at some t"),
            ExceededBy::Rate { .. } => {
                write!(f, "a rate of at least {least} at X = E = 0 needs |df/dx(t,0,0)| to be as large at some t")
            }
            ExceededBy::Jacobian { fraction, column, .. } => {
                let (column, t) = (column + 1, write_exact(fraction));
                write!(f, "column {column} of the Jacobian has a norm of at least {least} at t = {t} periods")
            }
        }
    }
}

impl ExceededBy {
    /// The lower bound.
    #[must_use]
    pub fn value(&self) -> &Enclosure {
        match self {
            ExceededBy::Alpha { alpha } => alpha,
            ExceededBy::Rate { rate } => rate,
            ExceededBy::Jacobian { norm, .. } => norm,
        }
    }
}

/// Whether the data speak of a state x, as far as arguments up to `reach` tell.
#[must_use]
pub fn has_states(data: &Data<'_>, reach: &[Rational; 2]) -> bool {
    let [x, e] = reach.each_ref().map(|end| data.rational(end));
    let vanishes = |which| data.bound(which, &x, &e).upper().is_zero();
    let all = [Bound::F, Bound::Fe, Bound::Fxx, Bound::Fex, Bound::Qx];
    data.spec.lyapunov.jacobian().is_some() || !all.into_iter().all(vanishes)
}

/// Looks for an X that proves that no plant with a state satisfies the data: in the domain, up to `used` where that is
/// given.
///
/// Guarantee: `Some` is a proof, decided over enclosures at the exact X. `None` says nothing.
#[must_use]
pub fn no_plant(data: &Data<'_>, used: Option<&[Rational; 2]>) -> Option<NoPlant> {
    // Rounded down, so that X lies in the domain; of a domain whose ends are out of range nothing is said.
    let inner = match &data.spec.domain {
        Some(domain) => Some([
            domain.x.enclose(data.precision).lower_rational()?,
            domain.e.enclose(data.precision).lower_rational()?,
        ]),
        None => None,
    };
    let reach = inner.or_else(|| used.cloned());
    let one = || Rational::from(1);
    if !has_states(data, reach.as_ref().unwrap_or(&[one(), one()])) {
        return None;
    }
    let largest = reach.map(|[x, _]| round_rational(&x, 2 * DIGITS, Direction::Down));
    let column = data.spec.lyapunov.jacobian().and_then(|jacobian| largest_column(data, jacobian));
    let decide = |x: Rational| {
        let at = data.rational(&x);
        let on_axis = |which| data.bound(which, &at, &data.zero());
        let taylor = on_axis(Bound::F) / &at + on_axis(Bound::Fxx) * &at / 2;
        let given = data.given(Bound::Fx).then(|| on_axis(Bound::Fx));
        let by_f_x = given.as_ref().is_some_and(|given| given.lt(&taylor).is_true());
        let rate = given.map_or(taylor.clone(), |given| given.min(&taylor));
        let alpha = Some(ExceededBy::Alpha { alpha: data.alpha.clone() });
        let given_rate = data
            .given(Bound::Rate)
            .then(|| ExceededBy::Rate { rate: data.bound(Bound::Rate, &data.zero(), &data.zero()) });
        let exceeded_by = alpha
            .into_iter()
            .chain(given_rate)
            .chain(column.clone())
            .find(|least| least.value().gt(&rate).is_true())?;
        Some(NoPlant { x, rate_at_most: rate, by_f_x, exceeded_by })
    };
    let decided: Vec<NoPlant> = candidates(data, largest.as_ref()).into_iter().filter_map(decide).collect();
    let rate = |reason: &NoPlant| reason.rate_at_most.upper_f64();
    let least = decided.iter().map(rate).fold(f64::INFINITY, f64::min);
    // Of those that show it as well, the most ordinary X.
    let unusual = |reason: &NoPlant| reason.x.to_f64().portable_ln().abs();
    let good = decided.into_iter().filter(|reason| rate(reason) <= least * (1.0 + 1e-3));
    good.min_by(|a, b| unusual(a).total_cmp(&unusual(b)))
}

/// Values of X > 0 with small rates, as far as double precision tells.
fn candidates(data: &Data<'_>, largest: Option<&Rational>) -> Vec<Rational> {
    let [Some(f), Some(f_xx)] = [Bound::F, Bound::Fxx].map(|bound| bound.of(data.spec).map(Expr::to_float)) else {
        return Vec::new();
    };
    let f_x = Bound::Fx.of(data.spec).map(Expr::to_float);
    let positive = |value: f64| if value < 0.0 { 0.0 } else { value };
    let rate = |x: f64| {
        let taylor = positive(f.eval(x, 0.0)) / x + positive(f_xx.eval(x, 0.0)) * x / 2.0;
        f_x.as_ref().map_or(taylor, |f_x| positive(f_x.eval(x, 0.0)).min(taylor))
    };
    let limit = largest.map_or(f64::INFINITY, Rational::to_f64);
    let mut grid: Vec<f64> =
        (-4 * DECADES..=4 * DECADES).map(|k| 10f64.portable_pow(f64::from(k) / 4.0)).filter(|x| *x < limit).collect();
    if limit.is_finite() && limit > 0.0 {
        grid.push(limit);
    }
    let mut order: Vec<usize> = (0..grid.len()).filter(|k| rate(grid[*k]).is_finite()).collect();
    order.sort_by(|a, b| rate(grid[*a]).total_cmp(&rate(grid[*b])));
    let refined = order.first().map(|best| {
        let (mut low, mut high) = (grid[best.saturating_sub(1)], grid[(best + 1).min(grid.len() - 1)]);
        for _ in 0..60 {
            let [a, b] = [1.0, 2.0].map(|share| low * (high / low).portable_pow(share / 3.0));
            if rate(a) <= rate(b) { high = b } else { low = a }
        }
        low
    });
    let rounded = |x: f64| match largest {
        Some(largest) if x >= limit => Some(largest.clone()),
        _ => round_f64(x, DIGITS, Direction::Down),
    };
    let best =
        order.iter().enumerate().filter(|(place, _)| *place < DECIDED || place % DECIDED == 0).map(|(_, k)| grid[*k]);
    refined.into_iter().chain(best).filter_map(rounded).filter(|x| *x > 0).collect()
}

/// The column with the largest certain norm over a period.
fn largest_column(data: &Data<'_>, jacobian: &Jacobian) -> Option<ExceededBy> {
    let family = Family::new(jacobian, &data.spec.period, data.precision)?;
    let times = if family.degree() == 0 { 1 } else { TIMES };
    let mut largest: Option<(f64, ExceededBy)> = None;
    for k in 0..times {
        let fraction = Rational::from((k, times));
        let angle = Enclosure::pi(data.precision) * 2 * data.rational(&fraction);
        for column in 0..family.order() {
            let squares = jacobian.rows.iter().zip(&family.centre).map(|(row, centre)| {
                let entry = match &row[column] {
                    JacobianEntry::Interval(ends) => {
                        let [low, up] = ends.each_ref().map(|end| end.enclose(data.precision));
                        low.hull(&up)
                    }
                    JacobianEntry::Function(_) => centre[column].at(&angle),
                };
                // The least magnitude.
                let size = entry.abs();
                Enclosure::new(size.lower(), size.lower()).sqr()
            });
            let norm = squares.fold(data.zero(), |sum, square| sum + square).sqrt();
            let least = norm.lower_f64();
            if largest.as_ref().is_none_or(|(most, _)| least > *most) {
                let fraction = fraction.clone();
                largest = Some((least, ExceededBy::Jacobian { fraction, column, norm }));
            }
        }
    }
    largest.map(|(_, column)| column)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sigmastar_lang::spec::Specification;

    const PAPER: &str = include_str!("../../../../specs/paper-example.json");

    fn spec(lyapunov: &str, f: &str, others: [&str; 4], domain: bool) -> Specification {
        let [f_e, f_xx, f_ex, q_x] = others;
        let domain = if domain { r#""domain": { "X": "10", "E": "10" },"# } else { "" };
        let text = format!(
            r#"{{ "format": "sigmastar/bounding-spec", "version": 1, "name": "test", "period": "1", "lyapunov": {lyapunov},
            "bounds": {{ "f": "{f}", "f_e": "{f_e}", "f_xx": "{f_xx}", "f_ex": "{f_ex}", "q": "1", "q_e": "1",
              "q_x": "{q_x}", "q_t": "1" }}, {domain}
            "internal_model": {{ "mu": "1", "base_frequency": "2*pi", "matched": true,
              "weights": {{ "family": "power", "n0": "2", "epsilon": "1/2" }} }}, "initial_set": {{ "kind": "paper" }} }}"#
        );
        Specification::from_json("test", &text).unwrap()
    }

    fn triple(alpha: &str) -> String {
        format!(r#"{{ "p_low": "1", "p_up": "2", "alpha": "{alpha}" }}"#)
    }

    fn found(spec: &Specification) -> Option<NoPlant> {
        no_plant(&Data::new(spec, 128), None)
    }

    #[test]
    fn a_rate_that_the_bounds_do_not_allow() {
        for (alpha, f, f_xx, rate) in [
            ("50", "0.01*X", "0", 0.01),
            ("15", "3*X + 0.1*X^2/2", "0.1", 3.0),
            // b_f(0,0) > 0: the rate is least inside, at X = 10 or where 1/X = X/2.
            ("0.3", "1", "0", 0.1),
            ("1.5", "1", "1", std::f64::consts::SQRT_2),
            ("1", "0.1*exp(X) - 0.1", "0", 0.1),
        ] {
            let spec = spec(&triple(alpha), f, ["1", f_xx, "0", "1"], true);
            let reason = found(&spec).unwrap_or_else(|| panic!("{f}"));
            assert!(matches!(reason.exceeded_by, ExceededBy::Alpha { .. }));
            assert!((reason.rate_at_most.upper_f64() / rate - 1.0).abs() < 3e-3, "{f}: {:?}", reason.rate_at_most);
            assert!(reason.x.to_f64() > 1e-4, "{f}: {}", reason.x);
            assert!(reason.x > 0 && reason.x <= 10);
        }
    }

    #[test]
    fn data_of_a_plant_pass() {
        // Equality is no contradiction: x' = -3 x has alpha = 3 = |F|.
        for (alpha, f, f_xx) in [("3", "3*X", "0"), ("2.9", "3*X", "0"), ("1.4", "1", "1"), ("7", "0.01*X", "10000")] {
            assert!(found(&spec(&triple(alpha), f, ["1", f_xx, "0", "1"], true)).is_none() == (alpha != "7"), "{f}");
        }
        assert!(found(&Specification::from_json("paper", PAPER).unwrap()).is_none());
    }

    #[test]
    fn plants_without_states_have_nothing_to_show() {
        assert!(found(&spec(&triple("5"), "0", ["0", "0", "0", "0"], true)).is_none());
        // One bounding function of x is enough for a state.
        for others in [["1", "0", "0", "0"], ["0", "1", "0", "0"], ["0", "0", "1", "0"], ["0", "0", "0", "1"]] {
            assert!(found(&spec(&triple("5"), "0", others, false)).is_some(), "{others:?}");
        }
    }

    #[test]
    fn a_jacobian_that_the_bounds_do_not_allow() {
        // Columns (-4, 3) and (cos, -2): the first has the norm 5, alpha is not known.
        let jacobian = |entry: &str| format!(r#"{{ "jacobian": [["{entry}", "cos(2*pi*t)"], ["3", "-2"]] }}"#);
        let reason = found(&spec(&jacobian("-4"), "4.9*X", ["1", "0", "0", "1"], true)).unwrap();
        match &reason.exceeded_by {
            ExceededBy::Jacobian { column: 0, norm, .. } => assert!((norm.midpoint_f64() - 5.0).abs() < 1e-12),
            other => panic!("{other:?}"),
        }
        assert!(found(&spec(&jacobian("-4"), "5*X", ["1", "0", "0", "1"], true)).is_none());
        // Of an interval only the least magnitude is certain, and 0 where the sign changes.
        for (interval, bound, contradicted) in [(r#"["-6", "-4"]"#, "5.1*X", false), (r#"["-6", "-4"]"#, "4.9*X", true)]
        {
            let jacobian = format!(r#"{{ "jacobian": [[{interval}, "0"], ["3", "-2"]] }}"#);
            let reason = found(&spec(&jacobian, bound, ["1", "0", "0", "1"], true));
            assert_eq!(reason.is_some(), contradicted, "{bound}");
        }
        let across = r#"{ "jacobian": [[["-6", "4"], "0"], ["3", "-2"]] }"#;
        assert!(found(&spec(across, "3.1*X", ["1", "0", "0", "1"], true)).is_none());
        // A column that is large at one time only.
        let moving = r#"{ "jacobian": [["-1 + 3*sin(2*pi*t)"]] }"#;
        let reason = found(&spec(moving, "3.9*X", ["1", "0", "0", "1"], true)).unwrap();
        assert!(
            matches!(reason.exceeded_by, ExceededBy::Jacobian { fraction, .. } if fraction == Rational::from((3, 4)))
        );
    }

    #[test]
    fn arguments_beyond_what_a_claim_uses_do_not_count() {
        let spec = spec(&triple("0.3"), "1", ["1", "0", "0", "1"], false);
        let data = Data::new(&spec, 128);
        let up_to = |x: i32| no_plant(&data, Some(&[Rational::from(x), Rational::from(1)]));
        assert!(up_to(3).is_none());
        assert!(up_to(4).is_some_and(|reason| reason.x <= 4));
        assert!(no_plant(&data, None).is_some());
    }
}
