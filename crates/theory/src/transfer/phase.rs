//! The phase of the internal model on the imaginary axis: T_N as its derivative.

use super::pole_sums::{OscillatorCount, PoleSums, integer, nearest_integers, point};
use rug::Float;
use sigmastar_exact::enclosure::Enclosure;

impl PoleSums {
    /// `theta_N(x) = arctan(nu g_N(x)) + pi #{poles l: 0 < l < x}`, continued through the poles, for every x >= 0 in the
    /// enclosure; in radians.
    ///
    /// g tends to +oo on the left of a pole and to -oo on the right, so theta is continuous with
    /// `theta(m) = (m - 1/2) pi` at every pole 0 <= m <= N; at x = 0 this is the limit from the right. It increases,
    /// `theta' = nu T_N`, from -pi/2 to N pi, so an interval is enclosed by the values at its ends. Near a pole
    /// m <= N, with d = x - m: `tan(theta - m pi) = -nu (c_m - R d)/d`, hence `theta = (m - 1/2) pi + phi`, phi the argument
    /// of `nu (c_m - R d) + i d`, in (-pi, pi).
    ///
    /// Undefined where x may be negative or is unbounded, and beyond
    /// [`MAX_DIRECT_POLES`](super::MAX_DIRECT_POLES).
    #[must_use]
    pub fn phase(&self, x: &Enclosure) -> Enclosure {
        let at = |end: &Float| match nearest_integers(&point(end)) {
            Some((nearest, _)) => self.phase_at(&point(end), nearest),
            None => Enclosure::undefined(x.precision()),
        };
        let left = at(&x.lower());
        if x.is_exact() { left } else { left.hull(&at(&x.upper())) }
    }

    fn phase_at(&self, x: &Enclosure, nearest: u64) -> Enclosure {
        let around = self.around(x, nearest);
        let (nu, d) = (self.nu(), &around.distance);
        let half_turn = Enclosure::pi(x.precision().max(nu.precision()));
        let turns = |poles: u64| integer(poles, half_turn.precision()) * &half_turn;
        let Some(residue) = &around.residue else {
            // The poles below x are all there are.
            let OscillatorCount::Finite(last) = self.count() else { return Enclosure::undefined(x.precision()) };
            return turns(last) + (nu * &around.sum).atan();
        };
        let real = nu * (residue - &around.sum * d);
        let argument = if real.is_positive().is_true() {
            (d / real).atan()
        } else if d.is_positive().is_true() {
            &half_turn / 2 - (real / d).atan()
        } else if (-d).is_positive().is_true() {
            -(&half_turn / 2) - (real / d).atan()
        } else {
            return Enclosure::undefined(x.precision());
        };
        turns(nearest) - &half_turn / 2 + argument
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Data;
    use rug::Rational;
    use sigmastar_lang::spec::Specification;
    use std::path::Path;

    /// Every form of the argument: from either neighbouring pole, close to it and far from it.
    #[test]
    fn both_neighbouring_poles_give_the_same_phase() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../specs/paper-example.json");
        let spec = Specification::load(&path).unwrap();
        let data = Data::new(&spec, 128);
        let sums = PoleSums::new(&data, OscillatorCount::Finite(5));
        for m in 0..5 {
            for percent in [1, 20, 50, 80, 99] {
                let x = data.rational(&Rational::from((100 * m + percent, 100)));
                let (left, right) = (sums.phase_at(&x, m), sums.phase_at(&x, m + 1));
                assert!(left.intersect(&right).is_defined(), "{m}, {percent}: {left:?} {right:?}");
                assert!(Float::with_val(64, left.upper() - left.lower()) < 1e-30);
            }
        }
    }
}
