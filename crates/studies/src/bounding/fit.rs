//! Polynomials with coefficients of one sign above sampled suprema: proposals in doubles.

use sigmastar_exact::number::Portable;
use sigmastar_matrix::AffineMatrix;
use sigmastar_propose::semidefinite;

/// The largest degree of a polynomial.
const DEGREE: u32 = 3;

/// What counts as nothing, relative to the size of the samples: a value in the weights, and the part of a term at the far
/// corner.
const FLOOR: f64 = 0.05;
const NEGLIGIBLE: f64 = 2e-3;

/// Suprema over `|y| <= x_i`, `|e| <= e_j`.
#[derive(Clone, Debug)]
pub(super) struct Samples {
    /// The x_i, the last one the largest; at least one.
    pub(super) x: Vec<f64>,
    /// The e_j, likewise.
    pub(super) e: Vec<f64>,
    /// One for each pair, those of one x_i together.
    pub(super) values: Vec<f64>,
}

/// Up to here, relative to the largest X and E, a point counts fully.
const INNER: f64 = 0.8;
const OUTER_WEIGHT: f64 = 0.1;

/// A term: the powers of X and E, and the coefficient.
pub(super) type FloatTerm = (u32, u32, f64);

impl Samples {
    /// The largest magnitude.
    pub(super) fn size(&self) -> f64 {
        self.values.iter().map(|value| value.abs()).fold(0.0, f64::max)
    }

    /// The polynomial of degree 3 that is nowhere below the samples and least above them, in the mean and relative to them,
    /// with coefficients that are not negative; the constant may be where `signed`. `None` where the solver has none.
    pub(super) fn fit(&self, signed: bool) -> Option<Vec<FloatTerm>> {
        let [far_x, far_e] = [&self.x, &self.e].map(|ends| ends.last().copied().unwrap_or(0.0));
        let powers = (0..=DEGREE).flat_map(|degree| (0..=degree).map(move |e| (degree - e, e)));
        let mut powers: Vec<(u32, u32)> =
            powers.filter(|(x, e)| (*x == 0 || far_x > 0.0) && (*e == 0 || far_e > 0.0)).collect();
        let coefficients = self.solve(&powers, signed)?;
        // Once more without the terms that hardly matter.
        let mut each = coefficients.iter();
        powers.retain(|powers| each.next().is_some_and(|c| *powers == (0, 0) || *c > NEGLIGIBLE));
        let coefficients = self.solve(&powers, signed)?;
        let size = self.size();
        let unscaled = |((x, e), c): (&(u32, u32), &f64)| {
            let scale = far_x.portable_powi(*x as i32) * far_e.portable_powi(*e as i32);
            let positive = if signed && (*x, *e) == (0, 0) { *c } else { c.max(0.0) };
            (*x, *e, positive * size / scale)
        };
        Some(powers.iter().zip(&coefficients).map(unscaled).collect())
    }

    /// The coefficients, with X and E relative to their largest values and the samples to their size.
    fn solve(&self, powers: &[(u32, u32)], signed: bool) -> Option<Vec<f64>> {
        let size = self.size();
        let relative = |ends: &[f64]| -> Vec<f64> {
            let last = ends.last().copied().unwrap_or(0.0);
            ends.iter().map(|end| if last > 0.0 { end / last } else { 0.0 }).collect()
        };
        let (x, e) = (relative(&self.x), relative(&self.e));
        let points: Vec<(f64, f64)> = x.iter().flat_map(|x| e.iter().map(move |e| (*x, *e))).collect();
        let power = |point: usize, (i, j): (u32, u32)| {
            points[point].0.portable_powi(i as i32) * points[point].1.portable_powi(j as i32)
        };
        let value = |point: usize| self.values[point] / size;
        // Most uses are well inside of the domain; its far ends are there so that a search does not end at them.
        let inner = |point: usize| if points[point].0.max(points[point].1) > INNER { OUTER_WEIGHT } else { 1.0 };
        let weight = |point: usize| inner(point) / (value(point).abs() + FLOOR) / points.len() as f64;
        let cost: Vec<f64> =
            powers.iter().map(|powers| (0..points.len()).map(|at| weight(at) * power(at, *powers)).sum()).collect();
        let above = (0..points.len())
            .map(|at| AffineMatrix::from_fn(1, powers.len(), |_, _| -value(at), |term, _, _| power(at, powers[term])));
        let bounded = (0..powers.len()).filter(|&term| !(signed && powers[term] == (0, 0))).map(|term| {
            AffineMatrix::from_fn(1, powers.len(), |_, _| 0.0, move |other, _, _| f64::from(u8::from(other == term)))
        });
        let constraints: Vec<AffineMatrix<f64>> = above.chain(bounded).collect();
        semidefinite::propose(&cost, &constraints).ok().map(|point| point.x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples(of: impl Fn(f64, f64) -> f64) -> Samples {
        let ends = vec![0.0, 0.3, 0.8, 1.4, 2.0];
        let values = ends.iter().flat_map(|x| ends.iter().map(|e| of(*x, *e)).collect::<Vec<_>>()).collect();
        Samples { x: ends.clone(), e: ends, values }
    }

    #[test]
    fn polynomials_are_found_again_and_others_are_covered() {
        let found = samples(|x, e| 0.189 + x + 0.5 * x * e).fit(false).unwrap();
        let expected = [(0, 0, 0.189), (1, 0, 1.0), (1, 1, 0.5)];
        assert_eq!(found.len(), 3, "{found:?}");
        for ((x, e, c), (i, j, d)) in found.iter().zip(expected) {
            assert!((*x, *e) == (i, j) && (c - d).abs() < 1e-5, "{found:?}");
        }
        let of = |x: f64, e: f64| (1.0 + e * e).sqrt() + x - 3.0;
        let found = samples(of).fit(true).unwrap();
        assert!(found[0].2 < 0.0 && found[1..].iter().all(|(.., c)| *c >= 0.0), "{found:?}");
        for x in [0.0_f64, 0.8, 2.0] {
            for e in [0.0_f64, 1.4, 2.0] {
                let value: f64 = found.iter().map(|(i, j, c)| c * x.powi(*i as i32) * e.powi(*j as i32)).sum();
                assert!(value > of(x, e) - 1e-6 && value < of(x, e) + 0.3, "{x} {e}: {value}");
            }
        }
    }
}
