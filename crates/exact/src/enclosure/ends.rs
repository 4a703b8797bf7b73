//! The ends of an enclosure: numbers of any precision, or doubles that stand for numbers of 53 bits.
//!
//! Doubles are used where they give the very bits that MPFR would give at 53 bits: within the range of [`fits`] a sum, a product or a
//! quotient of doubles is rounded to nearest by the hardware, what it is away from the exact value is a double too, and its sign says
//! whether the neighbour below or above is the one that was asked for. Nothing but IEEE arithmetic is used for that, no fused
//! operation. What leaves the range is computed by MPFR.

use rug::Float;
use rug::float::Round;

#[cfg(all(target_arch = "x86", not(target_feature = "sse2")))]
compile_error!("enclosures need doubles that are rounded to 53 bits: build with the target feature sse2");

/// The bits of a double.
pub(super) const SHORT: u32 = f64::MANTISSA_DIGITS;

/// The exponents of 2 between which a double is an end; products and quotients of such numbers, and what these are away from the
/// exact ones, are far from the ends of the range of doubles.
const EXPONENTS: std::ops::Range<u64> = 1023 - 400..1023 + 400;

/// Whether a double may be an end: it is 0 or of moderate size.
#[inline]
pub(super) fn fits(value: f64) -> bool {
    EXPONENTS.contains(&((value.to_bits() >> 52) & 0x7ff)) || value == 0.0
}

/// A number that an end can be.
pub(super) trait End: Clone + PartialOrd {
    /// Whether it is at least 0.
    fn is_nonnegative(&self) -> bool;

    /// Whether it is at most 0.
    fn is_nonpositive(&self) -> bool;

    /// The sum, rounded.
    fn add(&self, other: &Self, precision: u32, round: Round) -> Self;

    /// The difference, rounded.
    fn sub(&self, other: &Self, precision: u32, round: Round) -> Self;

    /// The product, rounded. An infinite end is a bound, not a value, so `0 * inf` is 0 here.
    fn mul(&self, other: &Self, precision: u32, round: Round) -> Self;

    /// The quotient by what is not 0, rounded. `inf / inf` only meets as "bound over bound" and gives the trivial bound, which for the
    /// lower end of a nonnegative quotient is 0 and for the upper end infinity.
    fn div(&self, other: &Self, precision: u32, round: Round) -> Self;

    /// This number, unchanged, at a precision that is at least its own.
    fn at(&self, precision: u32) -> Self;

    /// The opposite.
    fn opposite(&self) -> Self;

    /// The smaller one, exactly. (`Float::min` rounds to nearest at the precision of its receiver, which need not be outward.)
    fn smaller(&self, other: &Self, precision: u32) -> Self {
        if self <= other { self.at(precision) } else { other.at(precision) }
    }

    /// The larger one, exactly, in the same way.
    fn larger(&self, other: &Self, precision: u32) -> Self {
        if self >= other { self.at(precision) } else { other.at(precision) }
    }
}

impl End for Float {
    fn is_nonnegative(&self) -> bool {
        *self >= 0
    }

    fn is_nonpositive(&self) -> bool {
        *self <= 0
    }

    fn add(&self, other: &Float, precision: u32, round: Round) -> Float {
        Float::with_val_round(precision, self + other, round).0
    }

    fn sub(&self, other: &Float, precision: u32, round: Round) -> Float {
        Float::with_val_round(precision, self - other, round).0
    }

    fn mul(&self, other: &Float, precision: u32, round: Round) -> Float {
        if self.is_zero() || other.is_zero() {
            return Float::new(precision);
        }
        Float::with_val_round(precision, self * other, round).0
    }

    fn div(&self, other: &Float, precision: u32, round: Round) -> Float {
        if self.is_zero() {
            return Float::new(precision);
        }
        if self.is_infinite() && other.is_infinite() {
            let positive = self.is_sign_positive() == other.is_sign_positive();
            let trivial = match (positive, round) {
                (true, Round::Down) | (false, Round::Up) => rug::float::Special::Zero,
                (true, _) => rug::float::Special::Infinity,
                (false, _) => rug::float::Special::NegInfinity,
            };
            return Float::with_val(precision, trivial);
        }
        Float::with_val_round(precision, self / other, round).0
    }

    fn at(&self, precision: u32) -> Float {
        Float::with_val(precision, self)
    }

    fn opposite(&self) -> Float {
        Float::with_val(self.prec(), -self)
    }
}

/// `a + b - s` for `s = a + b` rounded to nearest: a double, and this one (Knuth).
#[inline]
fn rest_of_sum(a: f64, b: f64, s: f64) -> f64 {
    let part = s - a;
    (a - (s - part)) + (b - part)
}

/// The upper 26 bits of a number below 2^900 (an end, or a quotient of two), and the rest of it (Veltkamp).
#[inline]
fn halves(a: f64) -> [f64; 2] {
    let scaled = 134_217_729.0 * a;
    let upper = scaled - (scaled - a);
    [upper, a - upper]
}

/// `a b - p` for `p = a b` rounded to nearest: a double, and this one (Dekker).
#[inline]
fn rest_of_product(a: f64, b: f64, p: f64) -> f64 {
    let [[a, low_a], [b, low_b]] = [halves(a), halves(b)];
    ((a * b - p) + a * low_b + low_a * b) + low_a * low_b
}

/// The neighbour on the side that is asked for, of a number that is rounded to nearest; `rest` has the sign of what is missing.
#[inline]
fn rounded(nearest: f64, rest: f64, round: Round) -> f64 {
    match round {
        Round::Down if rest < 0.0 => nearest.next_down(),
        Round::Up if rest > 0.0 => nearest.next_up(),
        _ => nearest,
    }
}

/// Doubles that [`fits`] holds of; what comes out may be beyond its range, and then is any number that is beyond it too.
impl End for f64 {
    #[inline]
    fn is_nonnegative(&self) -> bool {
        *self >= 0.0
    }

    #[inline]
    fn is_nonpositive(&self) -> bool {
        *self <= 0.0
    }

    #[inline]
    fn add(&self, other: &f64, _: u32, round: Round) -> f64 {
        let sum = self + other;
        rounded(sum, rest_of_sum(*self, *other, sum), round)
    }

    #[inline]
    fn sub(&self, other: &f64, precision: u32, round: Round) -> f64 {
        self.add(&-other, precision, round)
    }

    #[inline]
    fn mul(&self, other: &f64, _: u32, round: Round) -> f64 {
        if *self == 0.0 || *other == 0.0 {
            return 0.0;
        }
        let product = self * other;
        rounded(product, rest_of_product(*self, *other, product), round)
    }

    /// What is missing has the sign of `(a - q b)/b`; `a - q b` is a double.
    #[inline]
    fn div(&self, other: &f64, _: u32, round: Round) -> f64 {
        if *self == 0.0 {
            return 0.0;
        }
        let quotient = self / other;
        let product = quotient * other;
        let rest = (self - product) - rest_of_product(quotient, *other, product);
        rounded(quotient, if *other > 0.0 { rest } else { -rest }, round)
    }

    #[inline]
    fn at(&self, _: u32) -> f64 {
        *self
    }

    #[inline]
    fn opposite(&self) -> f64 {
        // 0 has one sign.
        0.0 - self
    }
}

/// The square root of what is not negative; what is missing has the sign of `a - s^2`, a double.
#[inline]
pub(super) fn square_root(a: f64, round: Round) -> f64 {
    let root = a.sqrt();
    let square = root * root;
    rounded(root, (a - square) - rest_of_product(root, root, square), round)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    /// A power of two.
    fn two(exponent: i32) -> f64 {
        f64::from_bits(((1023 + exponent) as u64) << 52)
    }

    /// Doubles in the range, with few bits or many, near its ends and near each other.
    fn end() -> impl Strategy<Value = f64> {
        let with =
            |(bits, exponent): (u64, i32)| f64::from_bits((bits & 0x800f_ffff_ffff_ffff) | two(exponent).to_bits());
        let few = (-40..40_i32, -399..390_i32).prop_map(|(n, exponent)| f64::from(n) * two(exponent));
        let corners = [0.0, 1.0, -1.0, 1.0 + f64::EPSILON, 1.0 - f64::EPSILON / 2.0, 3.0, 0.1, two(-400), -two(399)];
        prop_oneof![
            4 => (any::<u64>(), -400..400_i32).prop_map(with),
            2 => few,
            1 => (any::<u64>(), -2..3_i32).prop_map(with),
            1 => prop::sample::select(corners.to_vec()),
        ]
    }

    /// A double beside another one.
    fn pair() -> impl Strategy<Value = (f64, f64)> {
        let near = (end(), -3..4_i64, any::<bool>()).prop_map(|(a, steps, opposite)| {
            let b = Some(f64::from_bits((a.to_bits() as i64 + steps) as u64)).filter(|b| fits(*b)).unwrap_or(a);
            (a, if opposite { -b } else { b })
        });
        prop_oneof![3 => (end(), end()), 1 => near]
    }

    fn long(value: f64) -> Float {
        Float::with_val(SHORT, value)
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 20_000, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

        /// Every operation gives the bits of MPFR, or leaves the range with it.
        #[test]
        fn doubles_are_rounded_as_mpfr_rounds((a, b) in pair()) {
            for round in [Round::Down, Round::Up] {
                let same = |double: f64, long: Float| match fits(double) {
                    true => long == double,
                    false => !fits(long.to_f64()),
                };
                let (x, y) = (long(a), long(b));
                prop_assert!(same(a.add(&b, SHORT, round), x.add(&y, SHORT, round)), "{a:e} + {b:e}");
                prop_assert!(same(a.sub(&b, SHORT, round), x.sub(&y, SHORT, round)), "{a:e} - {b:e}");
                prop_assert!(same(a.mul(&b, SHORT, round), x.mul(&y, SHORT, round)), "{a:e} * {b:e}");
                if b != 0.0 {
                    prop_assert!(same(a.div(&b, SHORT, round), x.div(&y, SHORT, round)), "{a:e} / {b:e}");
                }
                let root = Float::with_val_round(SHORT, long(a.abs()).sqrt_ref(), round).0;
                prop_assert!(same(square_root(a.abs(), round), root), "sqrt {a:e}");
            }
        }
    }

    #[test]
    fn the_range_of_ends() {
        for (value, expected) in [
            (0.0, true),
            (-0.0, true),
            (two(-400), true),
            (two(-400).next_down(), false),
            (two(400), false),
            (two(400).next_down(), true),
            (f64::MIN_POSITIVE, false),
            (5e-324, false),
            (f64::MAX, false),
            (f64::INFINITY, false),
            (f64::NAN, false),
        ] {
            assert_eq!((fits(value), fits(-value)), (expected, expected), "{value:e}");
        }
    }
}
