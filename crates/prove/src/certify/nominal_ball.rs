//! The ball about the nominal orbit of a family that lies in the initial set of every member (derivation, 13.2).

use super::ball::largest_ball;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::{OfPlant, TrigonometricVector};
use sigmastar_matrix::inverse;

/// Bits of the norms.
const PRECISION: u32 = 128;

/// A radius R of a few digits with which `|x - xb(t;p^0)| <= R` implies `|L^-1 (x - x_0(t;p))| <= X_0` for every p of the family: X_0 less r
/// and less `sup |L^-1 (xb(t;p) - xb(t;p^0))|`, over `|L^-1|`. `None` for a single plant, without states, and where nothing is left.
///
/// With a period that is known to an interval, at the same phase.
#[must_use]
pub fn nominal_ball(plant: &OfPlant, x_0: &Rational) -> Option<Rational> {
    plant.parameters.intervals().next()?;
    let inverse = inverse(&plant.coordinates)?;
    let nominal = plant.parameters.nominal();
    let centre = plant.cells.iter().find(|cell| cell.parameters.contain(&nominal))?;
    let centre = centre.orbit.approximation.at(&centre.parameters.deviations(&nominal));
    let mut farthest = Rational::new();
    for cell in &plant.cells {
        // xb is affine in p, and a norm convex: the corners are the worst.
        for values in cell.parameters.looked_at() {
            let member = cell.orbit.approximation.at(&cell.parameters.deviations(&values));
            let apart = largest_norm(&inverse, &difference(&member, &centre))?;
            farthest = farthest.max(apart + &cell.orbit.radius);
        }
    }
    let left = Rational::from(x_0 - &farthest);
    if left <= 0 {
        return None;
    }
    largest_ball(&plant.coordinates, &left).filter(|radius| *radius > 0)
}

fn difference(a: &TrigonometricVector, b: &TrigonometricVector) -> TrigonometricVector {
    let zero = vec![Rational::new(); a.mean.len()];
    a.with(b, &zero, |a, b| a.iter().zip(b).map(|(a, b)| Rational::from(a - b)).collect())
}

/// A number that `|K x(t)|` never exceeds: `|K m| + sum_k sqrt(|K a_k|^2 + |K b_k|^2)`.
fn largest_norm(k: &[Vec<Rational>], x: &TrigonometricVector) -> Option<Rational> {
    let square = |vector: &[Rational]| -> Rational {
        let row =
            |row: &Vec<Rational>| -> Rational { row.iter().zip(vector).map(|(a, b)| Rational::from(a * b)).sum() };
        k.iter().map(row).map(|entry| Rational::from(&entry * &entry)).sum()
    };
    let root = |square: Rational| Enclosure::from_rational(&square, PRECISION).sqrt();
    let mean = root(square(&x.mean));
    let norm = x.harmonics.iter().fold(mean, |sum, [a, b]| sum + root(square(a) + square(b)));
    norm.upper_rational()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vector(mean: [i32; 2], harmonics: &[[[i32; 2]; 2]]) -> TrigonometricVector {
        let rational = |pair: [i32; 2]| pair.map(Rational::from).to_vec();
        TrigonometricVector {
            mean: rational(mean),
            harmonics: harmonics.iter().map(|pair| pair.map(rational)).collect(),
        }
    }

    #[test]
    fn distances_of_curves() {
        let (circle, point) = (vector([1, 0], &[[[3, 0], [0, 3]]]), vector([1, 4], &[]));
        let apart = difference(&circle, &point);
        assert_eq!(apart, vector([0, -4], &[[[3, 0], [0, 3]]]));
        assert_eq!(difference(&point, &circle), vector([0, 4], &[[[-3, 0], [0, -3]]]));
        let half = |a: i32, b: i32| vec![Rational::from((a, 2)), Rational::from((b, 2))];
        let found = largest_norm(&[half(1, 0), half(0, 1)], &apart).unwrap().to_f64();
        // Half of 4 + sqrt(18), which is not below what is taken, half of 7.
        assert!((found - (4.0 + 18.0_f64.sqrt()) / 2.0).abs() < 1e-12, "{found}");
    }
}
