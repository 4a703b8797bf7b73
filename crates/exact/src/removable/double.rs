//! Values in doubles, for searches and simulations; the same bits on every machine. They decide nothing.

use super::{Family, downward, mirrored, of_reciprocal, upward};
use std::sync::LazyLock;

/// Terms of Taylor's polynomials: for `|x| < 2 + k` the rest is below the last digit for the derivatives that anybody asks for.
const TERMS: usize = 40;

/// How many of them are enough up to which |x|: `|x|^J/J!` is below 2^-56 there.
const ENOUGH: [(f64, usize); 4] = [(0.02, 8), (0.2, 12), (1.1, 20), (3.0, 30)];

/// The orders of which the coefficients are known.
const KNOWN: usize = 8;

/// `I_(k+j)(0)/j!` for j = 0, 1, ...
fn coefficients(family: Family, k: usize) -> [f64; TERMS] {
    let mut factorial = 1.0;
    std::array::from_fn(|j| {
        factorial *= j.max(1) as f64;
        family.sign(k + j) as f64 / ((k + j + 1) as f64 * factorial)
    })
}

/// Those of the two families.
static COEFFICIENTS: LazyLock<[[[f64; TERMS]; KNOWN]; 2]> = LazyLock::new(|| {
    [Family::Exponential, Family::Wave].map(|family| std::array::from_fn(|k| coefficients(family, k)))
});

/// `I_k` near 0.
fn taylor(family: Family, x: f64, k: usize) -> f64 {
    let terms = ENOUGH.iter().find(|(most, _)| x.abs() <= *most).map_or(TERMS, |(_, terms)| *terms);
    let sum = |all: &[f64; TERMS]| all[..terms].iter().rev().fold(0.0, |sum, own| sum * x + own);
    let known = COEFFICIENTS[usize::from(family == Family::Wave)].get(k);
    known.map_or_else(|| sum(&coefficients(family, k)), sum)
}

/// The derivative of some order of `x/(e^x - 1)`, which is 1 at 0.
#[must_use]
pub fn exprelr(x: f64, order: u32) -> f64 {
    let (y, k) = (x.abs(), order as usize);
    if y.is_infinite() {
        // b, b' and the others go to 0 on the right, to -x, -1 and 0 on the left.
        return mirrored(k, &y, 0.0, x < 0.0);
    }
    // E_k, scaled by e^-y.
    let (decay, ends) = (libm::exp(-y), [1.0; 4]);
    let all = if y < 2.0 + k as f64 {
        downward(&y, taylor(Family::Exponential, y, k) * decay, &ends, k)
    } else {
        upward(&y, &(1.0 - decay), &ends, k)
    };
    mirrored(k, &y, decay * of_reciprocal(&all, &1.0), x < 0.0)
}

/// The derivative of some order of `sin(x)/x`, which is 1 at 0.
#[must_use]
pub fn sinc(x: f64, order: u32) -> f64 {
    let k = order as usize;
    if x.is_infinite() {
        return 0.0;
    }
    if x.abs() < 1.0 + k as f64 {
        return taylor(Family::Wave, x, k);
    }
    let (sin, cos) = libm::sincos(x);
    upward(&x, &sin, &[sin, cos, -sin, -cos], k).pop().unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::enclosure::Enclosure;
    use crate::number::Portable;

    /// Against enclosures at 256 bits, relatively; near a zero of a derivative of sinc absolutely.
    #[test]
    fn doubles_are_near_enclosures() {
        for step in -400..=400 {
            let magnitude = 10f64.portable_pow(f64::from(step) / 12.0 - 12.0);
            for x in [magnitude, -magnitude, f64::from(step) / 16.0] {
                let wide = Enclosure::exactly(x).at_precision(256);
                for order in 0..5 {
                    let (value, exact) = (exprelr(x, order), wide.exprelr(order).midpoint_f64());
                    // b''' is 0 at 0.
                    let size = if order < 3 { exact.abs().max(f64::MIN_POSITIVE) } else { 0.01 };
                    assert!((value - exact).abs() <= 1e-10 * size, "b {order} at {x}: {value} {exact}");
                    let (value, exact) = (sinc(x, order), wide.sinc(order).midpoint_f64());
                    assert!((value - exact).abs() <= 1e-12, "sinc {order} at {x}: {value} {exact}");
                }
            }
        }
    }

    #[test]
    fn corners() {
        for (k, (b, s)) in [(1.0, 1.0), (-0.5, 0.0), (1.0 / 6.0, -1.0 / 3.0), (0.0, 0.0)].into_iter().enumerate() {
            assert!((exprelr(0.0, k as u32) - b).abs() < 1e-15 && (sinc(0.0, k as u32) - s).abs() < 1e-15, "{k}");
        }
        assert_eq!([exprelr(0.0, 0), sinc(0.0, 0)], [1.0, 1.0]);
        assert_eq!([0, 1, 2].map(|k| exprelr(f64::INFINITY, k)), [0.0; 3]);
        assert_eq!([0, 1, 2].map(|k| exprelr(f64::NEG_INFINITY, k)), [f64::INFINITY, -1.0, 0.0]);
        assert_eq!([exprelr(1e6, 0), exprelr(-1e6, 0), sinc(f64::INFINITY, 0)], [0.0, 1e6, 0.0]);
        assert!(exprelr(f64::NAN, 0).is_nan() && sinc(f64::NAN, 1).is_nan());
    }
}
