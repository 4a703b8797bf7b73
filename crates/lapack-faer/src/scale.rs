//! Scaling by powers of two, so that a decomposition neither overflows nor underflows on the way.

/// A pair of powers of two with product 1. Multiplying by `down` brings a matrix near unit size;
/// multiplying by `up` takes its eigenvalues or singular values back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    pub down: f64,
    pub up: f64,
}

impl Scale {
    /// The scale of a matrix with the given entries, or `None` if one of them is not finite.
    ///
    /// The largest entry ends in `[1, 4)`, or in `[2^-52, 1)` if it is a subnormal number. Both
    /// factors are normal numbers, so the multiplications are exact except for entries that
    /// underflow next to the largest one.
    pub fn of(entries: impl Iterator<Item = f64>) -> Option<Self> {
        let mut max = 0.0_f64;
        for x in entries {
            if !x.is_finite() {
                return None;
            }
            max = max.max(x.abs());
        }
        const BIAS: u64 = 1023;
        // The biased exponent; 0 for a subnormal, at most 2046 for a finite number.
        let exponent = (max.to_bits() >> 52).clamp(1, 2 * BIAS - 1);
        Some(Self { down: f64::from_bits((2 * BIAS - exponent) << 52), up: f64::from_bits(exponent << 52) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_are_inverse_and_normalize() {
        for max in [f64::MIN_POSITIVE, 1e-200, 0.75, 1.0, 3.0, 1e200, f64::MAX] {
            let scale = Scale::of([0.0, -max, max / 2.0].into_iter()).unwrap();
            assert_eq!(scale.down * scale.up, 1.0);
            assert!(scale.down.is_normal() && scale.up.is_normal());
            let size = max * scale.down;
            assert!((1.0..4.0).contains(&size), "{max:e} became {size}");
        }
    }

    #[test]
    fn extremes() {
        for tiny in [0.0, f64::from_bits(1)] {
            let scale = Scale::of([tiny].into_iter()).unwrap();
            assert_eq!(tiny * scale.down * scale.up, tiny);
        }
        assert!(Scale::of(core::iter::empty()).is_some());
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(Scale::of([1.0, bad, 2.0].into_iter()), None);
        }
    }
}
