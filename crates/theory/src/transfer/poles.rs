//! The poles of the internal model for moderate N, proved one by one; T_N as a sum of Lorentzians.
//!
//! The eigenvalues of Phi - mu M M'N are s_k = i w z_k with the 2N + 1 roots z_k of `1 + i nu g_N(z) = 0`, because
//! 1 + mu G(s) = 1 + i nu g_N(z) at s = i w z. With P(z) = `prod (z - l) (1 + i nu sum c_l/(l - z))`, monic of degree
//! n = 2N + 1, `1 + i nu g_N = prod (z - z_k)/prod (z - l)`.
//!
//! All Im z_k > 0: at a root g = i/nu, and Im g = `Im z sum c_l/|l - z|^2`. On the real axis the argument of the left side
//! is arctan(nu g) modulo pi, that of z - l is constant between poles, and d/dx arg(x - z_k) = Im z_k/|x - z_k|^2. Hence
//! `T_N(x) = (1/nu) d/dx arctan(nu g_N) = (1/nu) sum_k Im z_k/|x - z_k|^2`.

use super::complex::Complex;
use super::pole_sums::{OscillatorCount, PoleSums};
use crate::data::Data;
use num_complex::Complex64;
use rug::Float;
use sigmastar_exact::enclosure::Enclosure;
use std::cmp::Ordering;
use thiserror::Error;

/// The most oscillators of which the poles are enclosed.
pub const MAX_POLE_OSCILLATORS: u64 = 64;
/// Sweeps of the search in doubles before it is given up.
const SWEEPS: usize = 500;
/// Corrections at the working precision: each doubles the number of correct bits.
const REFINEMENTS: usize = 3;

/// A disc that contains exactly one root z_k of 1 + i nu g_N(z) = 0, where Im z_k > 0; pure numbers.
#[derive(Clone, Debug)]
pub struct PoleDisc {
    /// The centre, exactly: its real and its imaginary part.
    pub centre: [Enclosure; 2],
    /// An upper bound of the radius.
    pub radius: Enclosure,
}

impl PoleDisc {
    fn around(&self, coordinate: &Enclosure) -> Enclosure {
        (coordinate - &self.radius).hull(&(coordinate + &self.radius))
    }

    /// Re z_k: the frequency of the mode over the base frequency.
    #[must_use]
    pub fn real_part(&self) -> Enclosure {
        self.around(&self.centre[0])
    }

    /// Im z_k > 0: the decay rate of the mode over the base frequency.
    #[must_use]
    pub fn imaginary_part(&self) -> Enclosure {
        let rate = self.around(&self.centre[1]);
        // The root lies in the upper half plane, whatever the disc.
        rate.max(&Enclosure::zero(rate.precision()))
    }
}

/// Why the poles are not enclosed.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum PolesError {
    /// More oscillators than are treated.
    #[error("the poles of {n} oscillators were asked for; expected at most {max}: the sums of g_N have no such limit")]
    TooMany {
        /// The number asked for.
        n: u64,
        /// The largest number treated.
        max: u64,
    },
    /// The search in floating point did not settle.
    #[error("the search for the {degree} poles did not converge; mu/base_frequency may be out of the range of doubles")]
    NotFound {
        /// 2N + 1.
        degree: usize,
    },
    /// The discs overlap or are unbounded.
    #[error("the discs around poles {first} and {second} of {degree} are not proved disjoint; try a higher precision")]
    Undecided {
        /// The index of a disc, in the order of the real parts.
        first: usize,
        /// The index of another disc; the same one when it is unbounded.
        second: usize,
        /// 2N + 1.
        degree: usize,
    },
}

/// Encloses the roots z_k of 1 + i nu g_N(z) = 0 for N = `n`, in the order of their real parts.
///
/// Guarantee: the discs are pairwise disjoint and each contains exactly one of the 2N + 1 roots. With approximations
/// z_k and w_k = `P(z_k)/prod_{j != k} (z_k - z_j)` the radius is n |w_k| (Smith's theorem: by Lagrange interpolation P is the
/// characteristic polynomial of diag(z_k) - w 1', whose Gershgorin discs by rows have centres z_k - w_k and radii
/// (n - 1)|w_k|; a disc apart from all others holds one eigenvalue). How the approximations were found is of no
/// consequence.
///
/// # Errors
/// More than [`MAX_POLE_OSCILLATORS`], a search that does not converge, or discs that are not proved disjoint.
pub fn internal_model_poles(data: &Data<'_>, n: u64) -> Result<Vec<PoleDisc>, PolesError> {
    if n > MAX_POLE_OSCILLATORS {
        return Err(PolesError::TooMany { n, max: MAX_POLE_OSCILLATORS });
    }
    let sums = PoleSums::new(data, OscillatorCount::Finite(n));
    // n <= 64, so neither conversion wraps.
    let residues: Vec<(i64, Enclosure)> =
        (-(n as i64)..=n as i64).filter_map(|l| sums.residue(l.unsigned_abs()).map(|residue| (l, residue))).collect();
    let degree = residues.len();
    let found = approximate(&residues, data.nu.midpoint_f64()).ok_or(PolesError::NotFound { degree })?;
    let work = data.precision.saturating_add(32);
    let exact = |value: f64| Enclosure::point(&Float::with_val(work, value));
    let mut centres: Vec<Complex> = found.iter().map(|z| Complex { re: exact(z.re), im: exact(z.im) }).collect();
    for _ in 0..REFINEMENTS {
        let steps = corrections(&centres, &residues, sums.nu());
        centres = centres.iter().zip(&steps).map(|(centre, step)| middle(&centre.sub(step), work)).collect();
    }
    let order = |a: &Enclosure, b: &Enclosure| a.lower().partial_cmp(&b.lower()).unwrap_or(Ordering::Equal);
    centres.sort_by(|a, b| order(&a.re, &b.re).then(order(&a.im, &b.im)));
    let radius = |step: &Complex| (step.norm_squared().sqrt() * degree as i64).ceiling();
    let radii: Vec<Enclosure> = corrections(&centres, &residues, sums.nu()).iter().map(radius).collect();
    for (first, centre) in centres.iter().enumerate() {
        if !radii[first].is_bounded() {
            return Err(PolesError::Undecided { first, second: first, degree });
        }
        for second in first + 1..degree {
            let reach = (&radii[first] + &radii[second]).sqr();
            if !reach.lt(&centre.sub(&centres[second]).norm_squared()).is_true() {
                return Err(PolesError::Undecided { first, second, degree });
            }
        }
    }
    let disc = |(centre, radius): (Complex, Enclosure)| PoleDisc { centre: [centre.re, centre.im], radius };
    Ok(centres.into_iter().zip(radii).map(disc).collect())
}

/// `w min_k Im z_k`: the rate at which the slowest mode of zeta' = (Phi - mu M M'N) zeta decays, in 1/time.
#[must_use]
pub fn slowest_decay(data: &Data<'_>, poles: &[PoleDisc]) -> Enclosure {
    let rates = poles.iter().map(PoleDisc::imaginary_part);
    let least = rates.reduce(|least, rate| least.min(&rate));
    least.map_or_else(|| Enclosure::undefined(data.precision), |least| &data.base_frequency * least)
}

/// `P(z_k)/prod_{j != k} (z_k - z_j)` for every k, as `(1 + i nu g(z_k)) prod_l (z_k - l)/prod_{j != k} (z_k - z_j)`.
fn corrections(centres: &[Complex], residues: &[(i64, Enclosure)], nu: &Enclosure) -> Vec<Complex> {
    let one = |z: &Complex| {
        let precision = z.re.precision();
        let zero = || Enclosure::zero(precision);
        let mut g = Complex { re: zero(), im: zero() };
        let mut product = Complex { re: Enclosure::one(precision), im: zero() };
        for (l, residue) in residues {
            let distance = Complex { re: &z.re - *l, im: z.im.clone() };
            // c/(l - z) = -c conj(z - l)/|z - l|^2.
            let scale = residue / distance.norm_squared();
            g = Complex { re: g.re - &distance.re * &scale, im: g.im + &distance.im * &scale };
            product = product.mul(&distance);
        }
        let factor = Complex { re: 1 - nu * &g.im, im: nu * &g.re };
        product.mul(&factor)
    };
    let numerators = centres.iter().map(one).enumerate();
    let quotient = |(k, numerator): (usize, Complex)| {
        let others = centres.iter().enumerate().filter(|(j, _)| *j != k).map(|(_, other)| centres[k].sub(other));
        match others.reduce(|product, factor| product.mul(&factor)) {
            Some(product) => numerator.div(&product),
            None => numerator,
        }
    };
    numerators.map(quotient).collect()
}

/// A number near the middle of the rectangle, exactly.
fn middle(z: &Complex, precision: u32) -> Complex {
    let of = |part: &Enclosure| Enclosure::point(&(Float::with_val(precision, part.lower() + part.upper()) / 2u32));
    Complex { re: of(&z.re), im: of(&z.im) }
}

/// The roots in doubles by the iteration of Ehrlich and Aberth on P'/P = sum 1/(z - l) + F'/F, F = 1 + i nu g; `None` if
/// it does not settle. Only rational operations, so the same on every machine.
fn approximate(residues: &[(i64, Enclosure)], nu: f64) -> Option<Vec<Complex64>> {
    let terms: Vec<(f64, f64)> = residues.iter().map(|(l, residue)| (*l as f64, nu * residue.midpoint_f64())).collect();
    // For small nu the root near l is l + i nu c_l; the offset keeps off the symmetry axis and the real axis.
    let start = |(l, width): &(f64, f64)| Complex64::new(l + 0.03, width / (1.0 + width) + 0.01);
    let mut roots: Vec<Complex64> = terms.iter().map(start).collect();
    for _ in 0..SWEEPS {
        let mut largest: f64 = 0.0;
        for k in 0..roots.len() {
            let z = roots[k];
            let (mut factor, mut slope) = (Complex64::new(1.0, 0.0), Complex64::new(0.0, 0.0));
            let mut logarithmic = Complex64::new(0.0, 0.0);
            for (l, width) in &terms {
                let inverse = (z - l).inv();
                factor -= Complex64::new(0.0, *width) * inverse;
                slope += Complex64::new(0.0, *width) * inverse * inverse;
                logarithmic += inverse;
            }
            logarithmic += slope / factor;
            let others = roots.iter().enumerate().filter(|(j, _)| *j != k);
            let repulsion: Complex64 = others.map(|(_, other)| (z - other).inv()).sum();
            let step = (logarithmic - repulsion).inv();
            // At a root to the last bit the factor is 0 and the step is not a number.
            if factor.norm_sqr() == 0.0 {
                continue;
            }
            roots[k] = z - step;
            let relative = step.norm_sqr() / (1.0 + z.norm_sqr());
            if !relative.is_finite() {
                return None;
            }
            largest = largest.max(relative);
        }
        if largest < 1e-26 {
            return Some(roots);
        }
    }
    None
}
