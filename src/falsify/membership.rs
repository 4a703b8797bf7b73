//! Whether a plant lies within the bounding functions: decided with outward rounding.

use crate::enclosure::Enclosure;
use crate::expr::{Expr, Variables};
use rug::Rational;
use std::collections::VecDeque;

/// Bits of the enclosures.
const PRECISION: u32 = 64;

/// Boxes after which a plant is not accepted: one with a little more room needs a few dozen.
const MAX_BOXES: usize = 200;

/// A box of X and E.
type Region = [[Rational; 2]; 2];

/// Whether `bound(X, E) <= allowed(X, E)` for every (X, E) in [0, reach X] x [0, reach E], the axes and the origin
/// included.
///
/// Guarantee: if true, it is proved. With D = allowed - bound, on a box with lower corner (X_0, E_0)
/// `D(X, E) >= D(X_0, E_0) + (X - X_0) min(0, S_X) + (E - E_0) min(0, S_E)` where S_X and S_E are the least slopes of D on
/// the box; boxes for which this does not give D >= 0 are halved. So D may vanish at the origin, where most bounds of f
/// do. False where D < 0 somewhere, and where too many boxes would be needed.
#[must_use]
pub fn respects(bound: &str, allowed: &Expr, reach: &[Rational; 2]) -> bool {
    let Ok(difference) = Expr::parse(&format!("({}) - ({bound})", allowed.text()), Variables::XAndE) else {
        return false;
    };
    let whole: Region = reach.clone().map(|end| [Rational::new(), end]);
    let mut queue = VecDeque::from([whole]);
    let mut examined = 0;
    while let Some(region) = queue.pop_front() {
        examined += 1;
        if examined > MAX_BOXES {
            return false;
        }
        match settle(&difference, &region) {
            Settled::Holds => {}
            Settled::Fails => return false,
            Settled::Cut(along) => queue.extend(halves(region, along)),
        }
    }
    true
}

enum Settled {
    Holds,
    Fails,
    /// Undecided; the side to be cut.
    Cut(usize),
}

fn settle(difference: &Expr, region: &Region) -> Settled {
    let side = |[low, high]: &[Rational; 2]| Enclosure::between(low, high, PRECISION);
    let slopes = difference.enclose_slopes(&side(&region[0]), &side(&region[1]));
    if slopes.value.is_nonnegative().is_true() {
        return Settled::Holds;
    }
    let corner = region.clone().map(|[low, _]| Enclosure::from_rational(&low, PRECISION));
    let at_corner = difference.enclose(&corner[0], &corner[1]);
    if Enclosure::zero(PRECISION).gt(&at_corner).is_true() {
        return Settled::Fails;
    }
    let zero = Enclosure::zero(PRECISION);
    let loss = [&slopes.slope_x, &slopes.slope_e].map(|slope| slope.min(&zero));
    let widths = region.clone().map(|[low, high]| Enclosure::from_rational(&(high - low), PRECISION));
    let losses = [&loss[0] * &widths[0], &loss[1] * &widths[1]];
    if (&at_corner + &losses[0] + &losses[1]).is_nonnegative().is_true() {
        return Settled::Holds;
    }
    let [x, e] = losses.map(|loss| loss.lower_f64());
    Settled::Cut(usize::from(e < x))
}

fn halves(region: Region, along: usize) -> [Region; 2] {
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
    fn what_fits_and_what_does_not() {
        let reach = [Rational::from(10), Rational::from(10)];
        for (bound, allowed, fits) in [
            ("2*X + E/4", "2.1*X + E/4", true),
            ("2*X + E/4", "2*X + E/4", true),
            ("2*X + X^2/100", "2*X + E/4", false),
            // Below almost everywhere: only close to X = 1, E = 0 the first is larger.
            ("X*(2 - X)*(1 - min(E*1000, 1))", "0.999", false),
            ("1.9*X + E*(0.1 + 0.9*min(X, 3))", "2*X + E*(X + 0.2)", true),
            ("1.9*X + E*(0.1 + min(X, 3))", "2*X + X*E", false),
            ("0.3 + min(E, 0.7)", "0.3 + atan(2*E)", true),
            ("0.3 + min(E, 1.6)", "0.3 + atan(2*E)", false),
            // An undefined bounding function allows nothing.
            ("0", "1 + 0*sqrt(X - 1)", false),
        ] {
            let allowed = Expr::parse(allowed, Variables::XAndE).unwrap();
            assert_eq!(respects(bound, &allowed, &reach), fits, "{bound}");
        }
    }
}
