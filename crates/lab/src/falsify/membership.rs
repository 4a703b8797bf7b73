//! Whether a plant lies within the bounding functions: decided with outward rounding.

use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::expr::{Expr, Variables};
use sigmastar_theory::data::Bound;
use std::collections::VecDeque;

/// Bits of the enclosures.
const PRECISION: u32 = 64;

/// Executions of an operation that the proofs of all draws of one trial may take together.
pub(super) const MAX_OPERATIONS: u64 = 500_000;

/// Boxes after which a plant is not accepted: one with a little more room needs a few dozen.
const MAX_BOXES: usize = 200;

/// A box of X and E.
type Region = [[Rational; 2]; 2];

/// Whether `bound(X, E) <= max{allowed(X, E), 0}` for every (X, E) in [0, reach X] x [0, reach E], the axes and the origin
/// included; of a bounding function `which` that bounds no norm and may be negative, `bound(X, E) <= allowed(X, E)`.
///
/// Guarantee: if true, it is proved. With D = allowed - bound, on a box with lower corner (X_0, E_0)
/// `D(X, E) >= D(X_0, E_0) + (X - X_0) min(0, S_X) + (E - E_0) min(0, S_E)` where S_X and S_E are the least slopes of D on
/// the box; boxes for which this does not give D >= 0 are halved. So D may vanish at the origin, where most bounds of f
/// do. Where D is a polynomial with rational coefficients, none of them negative, that is decided exactly, so that D may be
/// 0 all over. False where D < 0 somewhere, and where too many boxes would be needed, or more operations than are `left`.
#[must_use]
pub fn respects(which: Bound, bound: &str, allowed: &Expr, reach: &[Rational; 2], left: &mut u64) -> bool {
    let texts = [format!("({}) - ({bound})", allowed.text()), format!("-({bound})")];
    let [Ok(difference), Ok(negative)] = texts.map(|text| Expr::parse(&text, Variables::XAndE)) else {
        return false;
    };
    if difference.has_no_negative_coefficient() {
        return true;
    }
    // max{allowed, 0} - bound is the larger of the two differences.
    let lower_bound = |region: &Region| {
        let side = |[low, high]: &[Rational; 2]| Enclosure::between(low, high, PRECISION);
        // Where the bounding function may be undefined, so is its positive part.
        let defined = difference.enclose(&side(&region[0]), &side(&region[1])).is_defined();
        let by_function = lower_bound(&difference, region);
        let by_zero = (defined && !which.is_signed()).then(|| lower_bound(&negative, region)).flatten();
        match (by_function, by_zero) {
            (Some(a), Some(b)) => Some(a.max(b)),
            (a, b) => a.or(b),
        }
    };
    let whole: Region = reach.clone().map(|end| [Rational::new(), end]);
    let mut queue = VecDeque::from([whole]);
    let mut examined = 0;
    // The box itself, and where it is halved the four halves; each by the value and the slopes of both differences.
    let operations = 15 * difference.to_float().operations() as u64;
    while let Some(region) = queue.pop_front() {
        examined += 1;
        let Some(less) = left.checked_sub(operations) else { return false };
        *left = less;
        if examined > MAX_BOXES {
            return false;
        }
        match lower_bound(&region) {
            None => return false,
            Some(least) if least >= 0.0 => {}
            // The cut after which the halves are better: what costs in one variable may come from the other's width.
            Some(_) => {
                let cuts = [0, 1].map(|along| halves(&region, along));
                let gains = cuts.each_ref().map(|parts| {
                    let least = |part| lower_bound(part).unwrap_or(f64::NEG_INFINITY);
                    parts.iter().map(least).sum::<f64>()
                });
                let [by_x, by_e] = cuts;
                queue.extend(if gains[1] > gains[0] { by_e } else { by_x });
            }
        }
    }
    true
}

/// A lower bound of D on a region; `None` where D is negative at its lower corner.
fn lower_bound(difference: &Expr, region: &Region) -> Option<f64> {
    let side = |[low, high]: &[Rational; 2]| Enclosure::between(low, high, PRECISION);
    let slopes = difference.enclose_slopes(&side(&region[0]), &side(&region[1]));
    // Exact where it can be: D may vanish there.
    let at_corner = difference.enclose_at(&region[0][0], &region[1][0], PRECISION);
    let zero = Enclosure::zero(PRECISION);
    if at_corner.lt(&zero).is_true() {
        return None;
    }
    let widths = region.each_ref().map(|[low, high]| Enclosure::from_rational(&Rational::from(high - low), PRECISION));
    let loss = slopes.slope_x.min(&zero) * &widths[0] + slopes.slope_e.min(&zero) * &widths[1];
    let [direct, by_slopes] = [slopes.value, at_corner + loss].map(|bound| bound.lower_f64());
    // An undefined bound is none.
    Some(direct.max(by_slopes)).filter(|least| !least.is_nan()).or(Some(f64::NEG_INFINITY))
}

fn halves(region: &Region, along: usize) -> [Region; 2] {
    let [low, high] = &region[along];
    let middle = Rational::from(low + high) / 2u32;
    let half = |ends: [Rational; 2]| {
        let mut part = region.clone();
        part[along] = ends;
        part
    };
    [half([low.clone(), middle.clone()]), half([middle.clone(), high.clone()])]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_work_is_counted_and_limited() {
        let (reach, allowed) = ([Rational::from(10), Rational::from(10)], "1.0001*X*E/(1 + X*E)");
        let allowed = Expr::parse(allowed, Variables::XAndE).unwrap();
        let mut left = MAX_OPERATIONS;
        assert!(!respects(Bound::F, "X*E/(1 + X*E)", &allowed, &reach, &mut left));
        let used = MAX_OPERATIONS - left;
        assert!(used > 0 && used < MAX_OPERATIONS / 2, "{used}");
        let mut short = used / 3;
        assert!(!respects(Bound::F, "X*E/(1 + X*E)", &allowed, &reach, &mut short));
        assert!(short < used / 3);
    }

    #[test]
    fn what_fits_and_what_does_not() {
        let reach = [Rational::from(10), Rational::from(10)];
        for (bound, allowed, fits) in [
            ("2*X + E/4", "2.1*X + E/4", true),
            ("2*X + E/4", "2*X + E/4", true),
            // Equal, and neither number a double.
            ("0.1*X + E*(1/3)", "X/10 + E/3", true),
            ("0.1*X + E*0.333333334", "X/10 + E/3", false),
            ("2*X + X^2/100", "2*X + E/4", false),
            // Below almost everywhere: only close to X = 1, E = 0 the first is larger.
            ("X*(2 - X)*(1 - min(E*1000, 1))", "0.999", false),
            ("1.9*X + E*(0.1 + 0.9*min(X, 3))", "2*X + E*(X + 0.2)", true),
            ("1.9*X + E*(0.1 + min(X, 3))", "2*X + X*E", false),
            ("0.29 + min(E, 0.7)", "0.3 + atan(2*E)", true),
            ("0.3 + min(E, 1.6)", "0.3 + atan(2*E)", false),
            // A narrow peak away from every corner, in one variable and in the other.
            ("max(0, 1 - 10*abs(X - 3.1))", "0.5", false),
            ("max(0, 1 - 10*abs(E - 3.1))", "0.5", false),
            // 0 at the origin, where rounding alone would not show it.
            ("0.9*X + E*0.9", "X + 0.1*exp(X) - 0.1 + E", true),
            ("1.2*X", "X + 0.1*exp(X) - 0.1 + E", false),
            // The positive part counts.
            ("0*X", "X - 1", true),
            ("X/2", "X - 1", false),
            // An undefined bounding function allows nothing.
            ("0", "1 + 0*sqrt(X - 1)", false),
        ] {
            let allowed = Expr::parse(allowed, Variables::XAndE).unwrap();
            assert_eq!(respects(Bound::F, bound, &allowed, &reach, &mut { MAX_OPERATIONS }), fits, "{bound}");
        }
    }

    #[test]
    fn what_may_be_negative_has_no_positive_part() {
        let reach = [Rational::from(10), Rational::from(10)];
        for (bound, allowed, fits) in [
            ("-400 + X", "X - 400", true),
            ("-3", "-3 + atan(E)", true),
            ("0", "X - 1", false),
            ("0", "-1", false),
            ("-(2) + min(X, 1)", "-1 - E/1000", false),
            ("-(2) + min(X, 1)*0.9", "-1 - E/1000", true),
        ] {
            let allowed = Expr::parse(allowed, Variables::XAndE).unwrap();
            assert_eq!(respects(Bound::QeMax, bound, &allowed, &reach, &mut { MAX_OPERATIONS }), fits, "{bound}");
        }
    }
}
