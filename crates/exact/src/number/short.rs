//! Rounding to short rationals: from floating-point proposals to numbers a certificate can carry.

use super::decimal::write_exact;
use rug::ops::{DivRounding, Pow};
use rug::{Integer, Rational};

/// Which way a number is rounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Towards minus infinity.
    Down,
    /// Towards plus infinity.
    Up,
    /// To the nearest, ties upward.
    Nearest,
}

/// Rounds a rational to `digits` significant decimal digits in the given direction.
///
/// Guarantee: `Down` never exceeds the value and `Up` never falls below it; the result differs from the value by
/// less than one unit in the last of the `digits` places. Zero stays zero; `digits` is at least 1.
#[must_use]
pub fn round_rational(value: &Rational, digits: u32, direction: Direction) -> Rational {
    if value.is_zero() {
        return Rational::new();
    }
    let places = i64::from(digits.max(1)) - magnitude(value);
    let scale = Rational::from(Integer::from(10).pow(places.unsigned_abs() as u32));
    let scaled = if places >= 0 { Rational::from(value * &scale) } else { Rational::from(value / &scale) };
    let (numerator, denominator) = scaled.into_numer_denom();
    let integer = match direction {
        Direction::Down => numerator.div_floor(denominator),
        Direction::Up => numerator.div_ceil(denominator),
        Direction::Nearest => (numerator * 2u32 + &denominator).div_floor(denominator * 2u32),
    };
    if places >= 0 { Rational::from(integer) / scale } else { Rational::from(integer) * scale }
}

/// Rounds a finite double to `digits` significant decimal digits; `None` for NaN and infinities.
#[must_use]
pub fn round_f64(value: f64, digits: u32, direction: Direction) -> Option<Rational> {
    Rational::from_f64(value).map(|exact| round_rational(&exact, digits, direction))
}

/// The number m with `10^(m-1) <= |value| < 10^m`, for a nonzero value.
fn magnitude(value: &Rational) -> i64 {
    let numerator = Integer::from(value.numer().abs_ref());
    let bits = i64::from(numerator.significant_bits()) - i64::from(value.denom().significant_bits());
    // 2^(bits-1) < |value| < 2^(bits+1); start below and step up: at most three steps.
    let mut m = ((bits - 1) as f64 * std::f64::consts::LOG10_2).floor() as i64;
    loop {
        let power = Integer::from(10).pow(m.unsigned_abs() as u32);
        let reached = if m >= 0 {
            numerator >= Integer::from(value.denom() * &power)
        } else {
            Integer::from(&numerator * &power) >= *value.denom()
        };
        if !reached {
            return m;
        }
        m += 1;
    }
}

/// A number of a message, in so many digits.
#[must_use]
pub fn in_digits(value: f64, digits: u32) -> String {
    round_f64(value, digits, Direction::Nearest).map_or_else(|| value.to_string(), |value| write_exact(&value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn ratio(numerator: i64, denominator: i64) -> Rational {
        Rational::from((numerator, denominator))
    }

    #[test]
    fn rounding_goes_the_way_it_is_told() {
        let x = ratio(22, 7);
        assert_eq!(round_rational(&x, 3, Direction::Down), ratio(314, 100));
        assert_eq!(round_rational(&x, 3, Direction::Up), ratio(315, 100));
        assert_eq!(round_rational(&x, 3, Direction::Nearest), ratio(314, 100));
        assert_eq!(round_rational(&ratio(-22, 7), 3, Direction::Down), ratio(-315, 100));
        assert_eq!(round_rational(&ratio(99_999, 100), 3, Direction::Up), ratio(1000, 1));
        assert_eq!(round_rational(&ratio(1, 1000), 4, Direction::Up), ratio(1, 1000));
        assert_eq!(round_f64(f64::NAN, 3, Direction::Up), None);
        assert_eq!(round_f64(f64::INFINITY, 3, Direction::Up), None);
        assert_eq!(round_f64(0.0, 3, Direction::Up), Some(Rational::new()));
    }

    proptest! {
        #[test]
        fn direction_and_distance(numerator in any::<i64>(), denominator in 1..i64::MAX, digits in 1u32..20, shift in -300i32..300) {
            let value = ratio(numerator, denominator) << shift;
            let down = round_rational(&value, digits, Direction::Down);
            let up = round_rational(&value, digits, Direction::Up);
            let near = round_rational(&value, digits, Direction::Nearest);
            prop_assert!(down <= value && value <= up);
            prop_assert!(near == down || near == up);
            let unit = Rational::from(value.abs_ref()) / Rational::from(Integer::from(10).pow(digits - 1));
            prop_assert!(Rational::from(&up - &down) <= unit);
        }
    }
}
