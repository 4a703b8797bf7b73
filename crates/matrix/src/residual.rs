//! Definiteness of larger matrices by an exact residual: no pivots and no divisions, only integer products.
//!
//! Let A be symmetric and L lower triangular with a positive diagonal. If `A - L L'` is diagonally dominant with a
//! nonnegative diagonal, it is positive semidefinite (Gershgorin), and `L L'` is positive definite: so is A. L comes from
//! floating point and may be anything; the residual is computed in integers, without any rounding.
//!
//! A may be known only up to an error: if the entries (i, j) are off by at most R_ij, then `v'E v >= -sum_i r_i v_i^2` with the
//! row sums r_i of R (by `2 |v_i v_j| <= v_i^2 + v_j^2`), so it is enough that `A - diag(r)` is positive definite.

use faer::linalg::solvers::Llt;
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Mat, Par, Side};
use rug::Float;
use rug::float::Round;
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_exact::number::Portable;
use sigmastar_exact::parallel;

/// Bits after the point of the entries of L. With at most [`MAX_ORDER`] rows and entries of L at most 1, no sum of products
/// reaches 2^126 units of 2^-116, so 128-bit integers never overflow.
const FACTOR_BITS: u32 = 58;

/// Bits after the point of the entries of the matrix and of the residual.
const ENTRY_BITS: u32 = 2 * FACTOR_BITS;

/// The largest order that is tried.
pub const MAX_ORDER: usize = 1024;

/// What is taken from the diagonal before it is factorised, as a power of 2 relative to a diagonal of about 1: it has to
/// cover the rounding of L. The large one suits well-conditioned matrices, which need no second step; the small one is
/// twice below a least eigenvalue of 1e-13 at order 400.
const SHIFTS: [i32; 2] = [-20, -46];

/// A symmetric matrix, scaled by a diagonal of powers of 2 so that its diagonal lies in [1/4, 1), as integers in units of
/// 2^-116, with the row sums of its errors already taken from the diagonal.
#[derive(Clone, Debug)]
pub struct ScaledMatrix {
    order: usize,
    /// Row by row, the entries up to the diagonal.
    lower: Vec<i128>,
}

/// Where row `i` starts in the packed lower triangle.
fn row_start(i: usize) -> usize {
    i * (i + 1) / 2
}

/// Row `i` of a packed lower triangle.
fn row<T>(packed: &[T], i: usize) -> &[T] {
    &packed[row_start(i)..row_start(i + 1)]
}

/// One entry in units of 2^-116 and a bound of its error in the same units.
type Entry = (i128, i128);

impl ScaledMatrix {
    /// The matrix of these doubles, each taken exactly; `allowance[i]` bounds the sum of the errors of row i.
    ///
    /// `entry(i, j)` is asked for j <= i only. `None` if the order exceeds [`MAX_ORDER`], a number is not finite, or the matrix
    /// cannot be positive definite for its diagonal and 2x2 minors (nothing is claimed then).
    #[must_use]
    pub fn from_doubles(
        order: usize,
        entry: impl Fn(usize, usize) -> f64 + Sync,
        allowance: &[f64],
    ) -> Option<ScaledMatrix> {
        let exponents: Option<Vec<i32>> = (0..order.min(MAX_ORDER + 1)).map(|i| half_exponent(entry(i, i))).collect();
        let exponents = exponents?;
        let allowances: Option<Vec<i128>> = (0..order)
            .map(|i| {
                let value = *allowance.get(i)?;
                // The mantissa is rounded up by at most one unit.
                let (units, error) = fixed(value, 2 * exponents.get(i)?)?;
                (value >= 0.0).then_some(units + error)
            })
            .collect();
        Self::assemble(order, &allowances?, |i, j| fixed(entry(i, j), exponents[i] + exponents[j]))
    }

    /// The matrices whose entries lie in these enclosures; `entry(i, j)` is asked for j <= i only.
    ///
    /// `None` as for [`ScaledMatrix::from_doubles`].
    #[must_use]
    pub fn from_enclosures(order: usize, entry: impl Fn(usize, usize) -> Enclosure + Sync) -> Option<ScaledMatrix> {
        // Of the upper ends, so that the whole of each enclosure is in range.
        let exponents: Option<Vec<i32>> =
            (0..order.min(MAX_ORDER + 1)).map(|i| half_exponent(entry(i, i).upper_f64())).collect();
        let exponents = exponents?;
        Self::assemble(order, &vec![0; order], |i, j| {
            let entry = entry(i, j);
            let shift = ENTRY_BITS as i32 - exponents[i] - exponents[j];
            let units = |value: &Float, round| {
                let scaled = Float::with_val(value.prec(), value << shift);
                scaled.to_integer_round(round).and_then(|(units, _)| units.to_i128()).filter(|units| within(*units))
            };
            let (low, up) = (units(&entry.lower(), Round::Down)?, units(&entry.upper(), Round::Up)?);
            let middle = (low + up) >> 1;
            Some((middle, up - middle))
        })
    }

    /// Collects the entries and takes the row sums of the errors from the diagonal.
    fn assemble(
        order: usize,
        allowances: &[i128],
        entry: impl Fn(usize, usize) -> Option<Entry> + Sync,
    ) -> Option<ScaledMatrix> {
        if order > MAX_ORDER {
            return None;
        }
        let rows: Option<Vec<Vec<Entry>>> =
            parallel::numbered(order, |i| (0..=i).map(|j| entry(i, j)).collect()).into_iter().collect();
        let mut lower: Vec<i128> = Vec::with_capacity(row_start(order));
        let mut taken = allowances.to_vec();
        for (i, row) in rows?.into_iter().enumerate() {
            for (j, (units, error)) in row.into_iter().enumerate() {
                lower.push(units);
                taken[i] = taken[i].saturating_add(error);
                if i != j {
                    taken[j] = taken[j].saturating_add(error);
                }
            }
        }
        for (i, taken) in taken.into_iter().enumerate() {
            let diagonal = &mut lower[row_start(i) + i];
            *diagonal = diagonal.checked_sub(taken).filter(|rest| *rest > 0)?;
        }
        Some(ScaledMatrix { order, lower })
    }

    /// `True` if the matrix (each matrix within the errors) is proved to be symmetric positive definite, else `Undecided`.
    ///
    /// Guarantee: never `True` for a matrix that is not positive definite, whatever floating point does. Decides least
    /// eigenvalues down to about 1e-13 of the largest at order 400. The cost is that of two Cholesky factorisations and of
    /// n^3/6 to n^3/3 integer products; rows are spread over threads, and the answer does not depend on their number.
    #[must_use]
    pub fn is_positive_definite(&self) -> Truth {
        let proved = SHIFTS.iter().enumerate().any(|(attempt, shift)| {
            let Some(factor) = self.cholesky(*shift) else { return false };
            let Some(units) = Factor::round(self.order, |i, j| (factor[(i, j)], 0)) else { return false };
            let residual = self.residual(&units);
            if dominates(self.order, &residual) {
                return true;
            }
            // Better digits pay only where the shift is too small for those of doubles.
            attempt > 0 && self.refined(&units, &factor, &residual, *shift)
        });
        if proved || self.order == 0 { Truth::True } else { Truth::Undecided }
    }

    /// The factor of the matrix less 2^shift on the diagonal, in floating point.
    fn cholesky(&self, shift: i32) -> Option<Mat<f64>> {
        let unit = 2f64.portable_powi(-(ENTRY_BITS as i32));
        let matrix = Mat::from_fn(self.order, self.order, |i, j| match j <= i {
            true => row(&self.lower, i)[j] as f64 * unit - if i == j { 2f64.portable_powi(shift) } else { 0.0 },
            false => 0.0,
        });
        Llt::new(matrix.as_ref(), Side::Lower).ok().map(|factor| factor.L().to_owned())
    }

    /// One step of refinement: with `E = L^-1 (A - 2^shift I - L L') L^-T`, `L (I + Phi(E))` with Phi(E) the lower triangle of E
    /// and half its diagonal is the factor to twice the digits.
    fn refined(&self, units: &Factor, factor: &Mat<f64>, residual: &[i128], shift: i32) -> bool {
        let (n, unit) = (self.order, 2f64.portable_powi(-(ENTRY_BITS as i32)));
        let shift = 2f64.portable_powi(shift);
        let mut correction = Mat::from_fn(n, n, |i, j| {
            let entry = row(residual, i.max(j))[i.min(j)] as f64 * unit;
            if i == j { entry - shift } else { entry }
        });
        for _ in 0..2 {
            solve_lower_triangular_in_place(factor.as_ref(), correction.as_mut(), Par::Seq);
            correction = correction.transpose().to_owned();
        }
        let half = Mat::from_fn(n, n, |i, j| match i.cmp(&j) {
            std::cmp::Ordering::Less => 0.0,
            std::cmp::Ordering::Equal => correction[(i, j)] / 2.0,
            std::cmp::Ordering::Greater => correction[(i, j)],
        });
        let correction = factor * &half;
        let better = Factor::round(n, |i, j| (correction[(i, j)], row(&units.lower, i)[j]));
        better.is_some_and(|better| dominates(n, &self.residual(&better)))
    }

    /// The lower triangle of `A - L L'`, exactly.
    fn residual(&self, factor: &Factor) -> Vec<i128> {
        let rows: Vec<Vec<i128>> = parallel::numbered(self.order, |i| {
            let left = row(&factor.lower, i);
            let entries = row(&self.lower, i).iter().enumerate();
            entries.map(|(j, entry)| entry - product(&left[..=j], row(&factor.lower, j))).collect()
        });
        rows.concat()
    }
}

/// The exact sum of products.
fn product(a: &[i64], b: &[i64]) -> i128 {
    a.iter().zip(b).map(|(a, b)| i128::from(*a) * i128::from(*b)).sum()
}

/// L in units of 2^-58, with a positive diagonal and entries of magnitude at most 1.
struct Factor {
    lower: Vec<i64>,
}

impl Factor {
    /// The nearest units to the doubles, plus the given units; `None` where L is not as it must be.
    fn round(order: usize, entry: impl Fn(usize, usize) -> (f64, i64)) -> Option<Factor> {
        let one = 1_i64 << FACTOR_BITS;
        let mut lower = Vec::with_capacity(row_start(order));
        for i in 0..order {
            for j in 0..=i {
                let (double, units) = entry(i, j);
                // A cast of NaN is 0 and one of a large number the largest integer: both are refused or harmless.
                let value = ((double * one as f64).round() as i64).checked_add(units)?;
                let sound = value.unsigned_abs() <= one.unsigned_abs() && (i != j || value > 0);
                lower.push(Some(value).filter(|_| sound)?);
            }
        }
        Some(Factor { lower })
    }
}

/// Whether every diagonal entry is at least the sum of the magnitudes of the others in its row; "no" where that sum is beyond
/// the range of the integers.
fn dominates(order: usize, lower: &[i128]) -> bool {
    let mut others = vec![Some(0_i128); order];
    for i in 0..order {
        for (j, entry) in row(lower, i)[..i].iter().enumerate() {
            for at in [i, j] {
                others[at] = others[at].and_then(|sum| sum.checked_add(entry.checked_abs()?));
            }
        }
    }
    others.iter().enumerate().all(|(i, others)| others.is_some_and(|others| row(lower, i)[i] >= others))
}

/// Whether an entry is less than 1 in magnitude, as every entry of a positive definite matrix with a diagonal below 1 is.
fn within(units: i128) -> bool {
    units.unsigned_abs() <= 1 << ENTRY_BITS
}

/// The least s with `diagonal < 4^s`, for a positive diagonal entry; scaled by 4^-s it lies in [1/4, 1).
fn half_exponent(diagonal: f64) -> Option<i32> {
    if !(diagonal.is_finite() && diagonal > 0.0) {
        return None;
    }
    let exponent = libm::frexp(diagonal).1;
    Some(exponent.div_euclid(2) + exponent.rem_euclid(2))
}

/// The double divided by 2^exponent in units of 2^-116, rounded down, with a bound of the error.
fn fixed(value: f64, exponent: i32) -> Option<Entry> {
    if !value.is_finite() {
        return None;
    }
    let (fraction, own) = libm::frexp(value);
    // 53 bits: an integer.
    let mantissa = libm::ldexp(fraction, 53) as i128;
    let shift = own - 53 - exponent + ENTRY_BITS as i32;
    if mantissa == 0 {
        return Some((0, 0));
    }
    match shift {
        // Beyond 2^117 it cannot be within 1.
        65.. => None,
        0..65 => Some(mantissa << shift).filter(|units| within(*units)).map(|units| (units, 0)),
        _ => {
            let units = mantissa >> (-shift).min(100);
            Some((units, i128::from(units << (-shift).min(100) != mantissa)))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rug::Rational;

    /// Doubles in [-1, 1) from a linear congruence: the same on every machine.
    fn numbers(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
        move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / 2f64.powi(52) - 1.0
        }
    }

    /// Q diag(values) Q' with an orthogonal Q from the QR factorisation of a random matrix, and its true least eigenvalue up
    /// to the rounding of the product.
    fn with_spectrum(n: usize, seed: u64, values: impl Fn(usize) -> f64) -> Mat<f64> {
        let mut next = numbers(seed);
        let random = Mat::from_fn(n, n, |_, _| next());
        let q = random.qr().compute_Q();
        let scaled = Mat::from_fn(n, n, |i, j| q[(i, j)] * values(j));
        &scaled * q.transpose()
    }

    fn decided(matrix: &Mat<f64>, allowance: f64) -> Option<Truth> {
        let n = matrix.nrows();
        ScaledMatrix::from_doubles(n, |i, j| matrix[(i, j)], &vec![allowance; n]).map(|m| m.is_positive_definite())
    }

    #[test]
    fn matrices_made_by_hand() {
        let matrix = |rows: [[f64; 2]; 2]| Mat::from_fn(2, 2, |i, j| rows[i][j]);
        assert_eq!(decided(&matrix([[2.0, -1.0], [-1.0, 2.0]]), 0.0), Some(Truth::True));
        assert_eq!(decided(&matrix([[2.0, -1.0], [-1.0, 2.0]]), 0.999), Some(Truth::True));
        assert_eq!(decided(&matrix([[2.0, -1.0], [-1.0, 2.0]]), 1.0), Some(Truth::Undecided));
        assert_eq!(decided(&matrix([[1e300, 1.0], [1.0, 1e-300]]), 0.0), Some(Truth::Undecided));
        assert_eq!(decided(&matrix([[1e200, 1.0], [1.0, 1e-100]]), 0.0), Some(Truth::True));
        for not_definite in [[[1.0, 1.0], [1.0, 1.0]], [[1.0, 2.0], [2.0, 1.0]]] {
            assert_ne!(decided(&matrix(not_definite), 0.0), Some(Truth::True));
        }
        for unfit in [[[-1.0, 0.0], [0.0, 1.0]], [[0.0, 0.0], [0.0, 1.0]], [[f64::NAN, 0.0], [0.0, 1.0]]] {
            assert_eq!(decided(&matrix(unfit), 0.0), None);
        }
        assert_eq!(decided(&matrix([[1.0, f64::INFINITY], [f64::INFINITY, 1.0]]), 0.0), None);
        assert_eq!(decided(&matrix([[1.0, 0.0], [0.0, 1.0]]), -1.0), None);
        assert_eq!(decided(&Mat::zeros(0, 0), 0.0), Some(Truth::True));
        assert!(ScaledMatrix::from_doubles(MAX_ORDER + 1, |i, j| f64::from(i == j), &[0.0; MAX_ORDER + 1]).is_none());
        assert!(ScaledMatrix::from_doubles(2, |i, j| f64::from(i == j), &[0.0]).is_none());
    }

    /// The least eigenvalue decides, relative to the largest, from 1e-2 to 1e-13; with the sign changed nothing is proved.
    #[test]
    fn the_least_eigenvalue_decides_down_to_1e_13() {
        for (n, seed) in [(5, 1), (30, 2), (120, 3)] {
            for exponent in [2, 6, 10, 12, 13] {
                let least = 10f64.powi(-exponent);
                let spread = |j: usize| least.powf((n - 1 - j) as f64 / (n - 1) as f64);
                let matrix = with_spectrum(n, seed, |j| spread(n - 1 - j));
                assert_eq!(decided(&matrix, 0.0), Some(Truth::True), "{n} {exponent}");
                let matrix = with_spectrum(n, seed, |j| if j == 0 { -least } else { spread(n - 1 - j) });
                assert_ne!(decided(&matrix, 0.0), Some(Truth::True), "{n} {exponent}");
            }
        }
    }

    #[test]
    fn beyond_the_digits_nothing_is_claimed() {
        let matrix = with_spectrum(40, 7, |j| if j == 0 { 1e-17 } else { 1.0 });
        assert_ne!(decided(&matrix, 0.0), Some(Truth::False));
        // Singular, exactly: all ones.
        assert_eq!(decided(&Mat::full(40, 40, 1.0), 0.0), Some(Truth::Undecided));
    }

    /// What the test proves is confirmed by exact elimination, near the edge where it stops.
    #[test]
    fn what_is_proved_is_true() {
        let mut proved = 0;
        for seed in 0..60 {
            let least = [1e-14, 1e-15, 1e-16, -1e-16, -1e-15, 0.0][seed as usize % 6];
            let matrix = with_spectrum(7, seed, |j| if j == 0 { least } else { 1.0 / (1 + j) as f64 });
            let symmetric = |i: usize, j: usize| Rational::from_f64(matrix[(i.max(j), i.min(j))]).unwrap();
            let rows: Vec<Vec<Rational>> = (0..7).map(|i| (0..7).map(|j| symmetric(i, j)).collect()).collect();
            if decided(&matrix, 0.0) == Some(Truth::True) {
                assert!(super::super::ldl::is_positive_definite(&rows), "{seed}");
                proved += 1;
            }
        }
        assert!(proved >= 10, "{proved}");
    }

    /// The error is subtracted: [[1, 1/2], [1/2, 1]] has the least eigenvalue 1/2, and row sums of errors up to it are allowed.
    #[test]
    fn enclosures_are_taken_at_their_worst() {
        let matrix = |radius: (i32, i32)| {
            ScaledMatrix::from_enclosures(2, |i, j| {
                let (middle, radius) = (Rational::from((if i == j { 2 } else { 1 }, 2)), Rational::from(radius));
                Enclosure::between(&Rational::from(&middle - &radius), &(middle + radius), 128)
            })
        };
        let truth = |radius| matrix(radius).map(|matrix| matrix.is_positive_definite());
        assert_eq!(truth((0, 1)), Some(Truth::True));
        assert_eq!(truth((24, 100)), Some(Truth::True));
        assert_eq!(truth((1, 4)), Some(Truth::Undecided));
        assert_eq!(truth((6, 10)), None);
        let undefined = ScaledMatrix::from_enclosures(1, |_, _| Enclosure::undefined(64));
        assert!(undefined.is_none());
    }

    /// A diagonal around a power of 4, where the scale changes, is decided as any other.
    #[test]
    fn an_enclosure_around_a_power_of_4_is_decided() {
        let definite = |beside: (i32, i32)| {
            let between =
                |low: (i32, i32), high: (i32, i32)| Enclosure::between(&Rational::from(low), &Rational::from(high), 64);
            let entry = |i: usize, j: usize| match (i, j) {
                (0, 0) => between((606, 10_000), (632, 10_000)),
                (1, 1) => between((2, 1), (2, 1)),
                _ => between(beside, beside),
            };
            ScaledMatrix::from_enclosures(2, entry).is_some_and(|matrix| matrix.is_positive_definite().is_true())
        };
        assert!(definite((1, 15)) && !definite((7, 20)));
    }

    #[test]
    fn a_singular_matrix_is_undecided() {
        let definite = |more: Rational| {
            let entry = |i: usize, j: usize| match i == j {
                true => Rational::from((2, 3)) + &more,
                false => Rational::from((-1, 3)),
            };
            let matrix = ScaledMatrix::from_enclosures(3, |i, j| Enclosure::from_rational(&entry(i, j), 128));
            matrix.expect("finite").is_positive_definite()
        };
        // 2/3 - 2/3 = 0 is the least eigenvalue.
        assert_eq!(definite(Rational::new()), Truth::Undecided);
        assert_eq!(definite(Rational::from((1, 1_000_000))), Truth::True);
    }

    #[test]
    fn dominance_counts_both_triangles() {
        for (lower, yes) in [
            (&[1, 1, 1][..], true),
            (&[1, -1, 1], true),
            (&[0, 1, 5], false),
            (&[5, -1, 0], false),
            (&[2, 1, 1, -1, 0, 1], true),
            (&[2, 1, 1, -2, 0, 9], false),
            (&[2, 1, 9, 0, 2, 1], false),
            (&[-1], false),
            (&[0], true),
            // Sums beyond the integers.
            (&[i128::MAX, i128::MIN, i128::MAX], false),
            (&[i128::MAX, i128::MAX, i128::MAX, 1, 0, 1], false),
        ] {
            let order = (1..4).find(|n| row_start(*n) == lower.len()).unwrap();
            assert_eq!(dominates(order, lower), yes, "{lower:?}");
        }
    }

    #[test]
    fn doubles_become_units() {
        assert_eq!(fixed(0.5, 0), Some((1 << 115, 0)));
        assert_eq!(fixed(-0.75, 1), Some((-(3 << 113), 0)));
        assert_eq!(fixed(2f64.powi(-116), 0), Some((1, 0)));
        assert_eq!(fixed(1.5 * 2f64.powi(-116), 0), Some((1, 1)));
        assert_eq!(fixed(-1.5 * 2f64.powi(-116), 0), Some((-2, 1)));
        assert_eq!(fixed(f64::MIN_POSITIVE / 8.0, 0), Some((0, 1)));
        assert_eq!(fixed(1.5, 0), None);
        assert_eq!([0.25, 0.9, 1.0, 3.9, 4.0].map(half_exponent), [0, 0, 1, 1, 2].map(Some));
    }
}
