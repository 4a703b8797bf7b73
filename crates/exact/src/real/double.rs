//! Doubles as reals: proposals for a search, the same bits on every machine. They decide nothing.

use super::Real;
use super::series::COEFFICIENTS;
use crate::number::Portable;

/// Steps of the iterations below at most; they need a handful.
const STEPS: usize = 40;

/// Relative changes at which they end.
const NEAR: f64 = 4.0 * f64::EPSILON;

impl Real for f64 {
    fn int(value: i64) -> f64 {
        value as f64
    }

    fn unknown() -> f64 {
        f64::NAN
    }

    fn sqr(&self) -> f64 {
        self * self
    }

    fn sqrt(&self) -> f64 {
        f64::sqrt(*self)
    }

    fn exp(&self) -> f64 {
        self.portable_exp()
    }

    fn coth(&self) -> f64 {
        self.portable_tanh().recip()
    }

    fn min(&self, other: &f64) -> f64 {
        if self < other || self.is_nan() { *self } else { *other }
    }

    fn max(&self, other: &f64) -> f64 {
        if self > other || self.is_nan() { *self } else { *other }
    }

    fn is_unknown(&self) -> bool {
        self.is_nan()
    }

    fn is_zero(&self) -> bool {
        *self == 0.0
    }

    fn is_certainly_positive(&self) -> bool {
        *self > 0.0
    }

    /// Newton's method for u tanh u = 1/v, from above; u tanh u is between u^2/(1 + u) and u.
    fn coth_ratio_inverse(&self) -> f64 {
        let target = self.recip();
        if !self.is_certainly_positive() || target == 0.0 || target.is_infinite() {
            // Beyond the range of doubles the root is target or its square root.
            return if *self > 0.0 { target.max(f64::MIN_POSITIVE) } else { f64::NAN };
        }
        let mut u = 0.5 * (target + target.sqrt() * (target + 4.0).sqrt());
        for _ in 0..STEPS {
            // tanh is 1 to all digits there.
            let tanh = if u > 20.0 { 1.0 } else { u.portable_tanh() };
            let step = (u * tanh - target) / (tanh + u * (1.0 - tanh * tanh));
            u -= step;
            if step.abs() <= NEAR * u {
                break;
            }
        }
        u
    }

    /// The closed form loses all digits for small arguments, where the series has them.
    fn oscillator_sum(&self) -> f64 {
        let y = *self;
        if y < 1.0 {
            let square = y * y;
            COEFFICIENTS.iter().rev().fold(0.0, |sum, (n, d)| sum * square + *n as f64 / *d as f64)
        } else {
            (1.0 / 12.0 - (y / 2.0).coth() / (2.0 * y) + 1.0 / (y * y)) / (y * y)
        }
    }

    /// Each form where it loses no digits.
    fn zero_mean_sum(&self) -> f64 {
        let y = *self;
        if y < 1.0 { 1.0 / 12.0 - y * y * y.oscillator_sum() } else { (y / 2.0).coth() / (2.0 * y) - 1.0 / (y * y) }
    }

    fn above(&self) -> String {
        format!("{self:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::enclosure::Enclosure;
    use proptest::prelude::*;
    use rug::Rational;

    fn exactly(value: f64) -> Enclosure {
        Enclosure::from_rational(&Rational::from_f64(value).unwrap(), 256)
    }

    fn near(value: f64, enclosure: &Enclosure, relative: f64) -> bool {
        let middle = enclosure.midpoint_f64();
        enclosure.is_bounded() && (value - middle).abs() <= relative * middle.abs()
    }

    proptest! {
        /// A function over doubles is near its enclosure.
        #[test]
        fn doubles_are_near_enclosures(exponent in -30.0_f64..30.0) {
            let x = 10f64.powf(exponent);
            let wide = exactly(x);
            prop_assert!(near(x.coth(), &Real::coth(&wide), 1e-15));
            prop_assert!(near(x.oscillator_sum(), &wide.oscillator_sum(), 4e-13));
            prop_assert!(near(x.zero_mean_sum(), &wide.zero_mean_sum(), 1e-14));
            prop_assert!(near(x.coth_ratio_inverse(), &wide.coth_ratio_inverse(), 1e-14));
        }

    }

    #[test]
    fn the_ends_of_the_range() {
        assert_eq!(0.0_f64.coth_ratio_inverse().to_bits(), f64::NAN.to_bits());
        assert!((-1.0_f64).coth_ratio_inverse().is_nan());
        assert!((1e-300_f64.coth_ratio_inverse() / 1e300 - 1.0).abs() < 1e-12);
        assert!((1e300_f64.coth_ratio_inverse() / 1e-150 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn nothing_known_stays_nothing_known() {
        for (a, b) in [(f64::NAN, 1.0), (1.0, f64::NAN)] {
            assert!(Real::min(&a, &b).is_nan() && Real::max(&a, &b).is_nan());
        }
    }
}
