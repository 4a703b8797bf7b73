//! The ball `|x - x_0| <= R_0` inside an initial set `|L^-1 (x - x_0)| <= X_0` of a plant (derivation, 11.5).

use nalgebra::DMatrix;
use rug::Rational;
use sigmastar_exact::number::{Direction, round_f64, round_rational};
use sigmastar_lang::spec::{Constant, OfPlant};
use sigmastar_matrix::is_positive_definite;

/// Significant digits of a radius.
const DIGITS: u32 = 6;

/// Significant digits of an irrational radius that was asked for: fewer than the room that its X_0 leaves.
const ASKED_DIGITS: u32 = 12;

/// Bits at which it is enclosed.
const PRECISION: u32 = 128;

/// How far below the estimate the radii that are tried are.
const SHORT_OF: [f64; 5] = [1e-12, 1e-9, 1e-6, 1e-3, 0.1];

/// Whether `X_0^2 L L' - R^2 I` is positive definite, exactly: then `|x - x_0| <= R` implies `|L^-1 (x - x_0)| < X_0`.
#[must_use]
pub fn covers_ball(coordinates: &[Vec<Rational>], x_0: &Rational, radius: &Rational) -> bool {
    is_positive_definite(&excess(coordinates, x_0, radius))
}

/// Whether `D^2 I - X^2 L' L` is positive definite, exactly: then `|L^-1 (x - x_0)| <= X` implies `|x - x_0| < D`.
#[must_use]
pub fn within_ball(coordinates: &[Vec<Rational>], x: &Rational, distance: &Rational) -> bool {
    let transposed: Vec<Vec<Rational>> =
        (0..coordinates.len()).map(|j| coordinates.iter().map(|row| row[j].clone()).collect()).collect();
    let negated: Vec<Vec<Rational>> =
        excess(&transposed, x, distance).into_iter().map(|row| row.into_iter().map(|entry| -entry).collect()).collect();
    is_positive_definite(&negated)
}

/// `X^2 L L' - R^2 I`.
fn excess(rows: &[Vec<Rational>], x: &Rational, radius: &Rational) -> Vec<Vec<Rational>> {
    let square = |value: &Rational| Rational::from(value * value);
    let (size, diagonal) = (square(x), square(radius));
    let entry = |i: usize, j: usize| {
        let product: Rational = rows[i].iter().zip(&rows[j]).map(|(a, b)| Rational::from(a * b)).sum();
        let product = product * &size;
        if i == j { product - &diagonal } else { product }
    };
    (0..rows.len()).map(|i| (0..rows.len()).map(|j| entry(i, j)).collect()).collect()
}

/// The ball of a claim: the one that was asked for where it is proved, else the largest R_0 of a few digits; `None` without
/// states.
#[must_use]
pub fn claimed_ball(plant: &OfPlant, x_0: &Rational) -> Option<Rational> {
    let largest = largest_ball(&plant.coordinates, x_0)?;
    let covered = plant.ball.as_ref().and_then(at_least).filter(|asked| covers_ball(&plant.coordinates, x_0, asked));
    Some(match covered {
        Some(asked) if asked > largest => asked,
        _ => largest,
    })
}

/// The radius that was asked for; of an irrational one a few more digits, rounded up.
fn at_least(ball: &Constant) -> Option<Rational> {
    let upper = || ball.enclose(PRECISION).upper_rational();
    ball.as_rational().cloned().or_else(|| Some(round_rational(&upper()?, ASKED_DIGITS, Direction::Up)))
}

/// The largest R_0 of a few digits that is proved; 0 where none is. `None` without states.
#[must_use]
pub fn largest_ball(coordinates: &[Vec<Rational>], x_0: &Rational) -> Option<Rational> {
    let n = coordinates.len();
    if n == 0 {
        return None;
    }
    let l = DMatrix::from_fn(n, n, |i, j| coordinates[i][j].to_f64());
    let smallest = l.singular_values().min();
    let estimate = x_0.to_f64() * smallest;
    let radii = SHORT_OF.into_iter().filter_map(|short| round_f64(estimate * (1.0 - short), DIGITS, Direction::Down));
    Some(radii.into_iter().find(|radius| *radius > 0 && covers_ball(coordinates, x_0, radius)).unwrap_or_default())
}

/// The norm of `L^-1`, as far as doubles know it: the X_0 that covers a ball is so many times its radius.
#[must_use]
pub fn inverse_norm(coordinates: &[Vec<Rational>]) -> f64 {
    let n = coordinates.len();
    let l = DMatrix::from_fn(n, n, |i, j| coordinates[i][j].to_f64());
    if n == 0 { 1.0 } else { l.singular_values().min().recip() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(rows: &[&[i32]]) -> Vec<Vec<Rational>> {
        rows.iter().map(|row| row.iter().map(|entry| Rational::from(*entry)).collect()).collect()
    }

    /// L = diag(2, 5) takes the ball of radius 1 to an ellipse with half axes 2 and 5.
    #[test]
    fn balls_inside_and_outside_of_an_ellipsoid() {
        let l = matrix(&[&[2, 0], &[0, 5]]);
        let ratio = |p: i32, q: i32| Rational::from((p, q));
        assert!(covers_ball(&l, &ratio(1, 1), &ratio(1999, 1000)));
        assert!(!covers_ball(&l, &ratio(1, 1), &ratio(2001, 1000)));
        assert!(within_ball(&l, &ratio(1, 1), &ratio(5001, 1000)));
        assert!(!within_ball(&l, &ratio(1, 1), &ratio(4999, 1000)));
        // A shear: the transposed matrix would answer otherwise only in the order of its singular values.
        let l = matrix(&[&[1, 3], &[0, 1]]);
        let found = largest_ball(&l, &ratio(1, 1)).unwrap();
        let smallest = (11.0_f64 - 117.0_f64.sqrt()).mul_add(0.5, 0.0).sqrt();
        assert!((found.to_f64() / smallest - 1.0).abs() < 1e-5, "{found}");
        assert!((inverse_norm(&l) * smallest - 1.0).abs() < 1e-9);
        assert_eq!(largest_ball(&[], &ratio(1, 1)), None);
    }
}
