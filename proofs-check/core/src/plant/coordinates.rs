//! The coordinates y of the deviation, `x = x_0 + L y`, exactly (docs/mathematics.md, sections 11 and 11.5).

use crate::json::Field;
use crate::matrix::{Matrix, is_semidefinite, shifted};
use crate::verdict::{Outcome, bad, demand};
use rug::Rational;

/// The name of this rule.
pub const RULE: &str = "coordinates";

/// Square rational matrices of the order of the states: L and its inverse.
#[derive(Clone, Debug)]
pub struct Coordinates {
    pub matrix: Matrix,
    pub inverse: Matrix,
}

impl Coordinates {
    /// Reads `coordinates`, the rows of L, `[]` without states. L must be invertible.
    pub fn read_part(field: &Field<'_>, order: usize) -> Outcome<Coordinates> {
        let matrix = field.matrix([order; 2], "one for each state")?;
        match inverse(&matrix) {
            Some(inverse) => Ok(Coordinates { matrix, inverse }),
            None => {
                demand(Some(false), RULE, &field.pointer, "L is invertible")?;
                bad(&field.pointer, "L is not invertible")
            }
        }
    }

    /// Whether `|x - x_0| <= ball` implies `|L^-1 (x - x_0)| <= size`: `size^2 L L' - ball^2 I >= 0`.
    pub fn covers_ball(&self, size: &Rational, ball: &Rational) -> bool {
        let [size, ball] = [size, ball].map(|value| Rational::from(value.square_ref()));
        is_semidefinite(shifted(&self.products(), &size, &ball))
    }

    /// Whether `|L^-1 (x - x_0)| <= size` implies `|x - x_0| <= domain`: `domain^2 I - size^2 L'L >= 0`.
    pub fn lies_within(&self, size: &Rational, domain: &Rational) -> bool {
        let [size, domain] = [size, domain].map(|value| -Rational::from(value.square_ref()));
        is_semidefinite(shifted(&self.products(), &size, &domain))
    }

    /// L L', the products of the rows of L. L'L has the same eigenvalues, so that a multiple of I is below both or below none.
    fn products(&self) -> Matrix {
        let product = |a: &Vec<Rational>, b: &Vec<Rational>| {
            a.iter().zip(b).fold(Rational::new(), |sum, (a, b)| sum + Rational::from(a * b))
        };
        self.matrix.iter().map(|a| self.matrix.iter().map(|b| product(a, b)).collect()).collect()
    }
}

/// The inverse, if there is one (Gauss and Jordan).
fn inverse(matrix: &Matrix) -> Option<Matrix> {
    let order = matrix.len();
    let unit = |i: usize| (0..order).map(move |j| Rational::from(u32::from(i == j)));
    let mut rows: Matrix =
        matrix.iter().enumerate().map(|(i, row)| row.iter().cloned().chain(unit(i)).collect()).collect();
    for k in 0..order {
        let pivot = (k..order).find(|i| rows[*i][k] != 0)?;
        rows.swap(k, pivot);
        let scale = Rational::from(rows[k][k].recip_ref());
        rows[k].iter_mut().for_each(|entry| *entry *= &scale);
        let above = rows[k].clone();
        for (i, row) in rows.iter_mut().enumerate() {
            if i == k || row[k] == 0 {
                continue;
            }
            let factor = row[k].clone();
            row.iter_mut().zip(&above).for_each(|(entry, other)| *entry -= Rational::from(&factor * other));
        }
    }
    Some(rows.into_iter().map(|row| row[order..].to_vec()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix<const N: usize>(rows: [[(i32, i32); N]; N]) -> Matrix {
        rows.map(|row| row.map(Rational::from).to_vec()).to_vec()
    }

    #[test]
    fn definiteness_is_decided_exactly() {
        let quarter = |value: i32| matrix([[(1, 1), (1, 2)], [(1, 2), (value, 1_000_000)]]);
        let [least, more, less] = [250_000, 250_001, 249_999].map(|value| is_semidefinite(quarter(value)));
        assert!(least && more && !less);
        assert!(is_semidefinite(matrix([[(0, 1), (0, 1)], [(0, 1), (3, 1)]])));
        assert!(!is_semidefinite(matrix([[(0, 1), (1, 9)], [(1, 9), (3, 1)]])) && is_semidefinite(Vec::new()));
    }

    #[test]
    fn balls_and_domains_are_those_of_l() {
        // L has the singular values 1 and 3.
        let l = matrix([[(2, 1), (1, 1)], [(1, 1), (2, 1)]]);
        let found = Coordinates { inverse: inverse(&l).unwrap(), matrix: l };
        // One that is not symmetric, with 1 and 4: it turns the axes.
        let turned = matrix([[(0, 1), (-4, 1)], [(1, 1), (0, 1)]]);
        let turned = Coordinates { inverse: inverse(&turned).unwrap(), matrix: turned };
        assert_eq!(found.inverse, matrix([[(2, 3), (-1, 3)], [(-1, 3), (2, 3)]]));
        let number = |value: (i32, i32)| Rational::from(value);
        assert!(found.covers_ball(&number((5, 2)), &number((5, 2))));
        assert!(!found.covers_ball(&number((5, 2)), &number((2_501, 1000))));
        assert!(found.lies_within(&number((1, 3)), &number((1, 1))));
        assert!(!found.lies_within(&number((1, 3)), &number((999, 1000))));
        assert!(turned.covers_ball(&number((3, 1)), &number((3, 1))));
        assert!(!turned.covers_ball(&number((3, 1)), &number((3_001, 1000))));
        assert!(turned.lies_within(&number((3, 1)), &number((12, 1))));
        assert!(!turned.lies_within(&number((3, 1)), &number((11_999, 1000))));
        assert!(inverse(&matrix([[(1, 1), (2, 1)], [(2, 1), (4, 1)]])).is_none());
        // A pivot that is 0 at first.
        assert!(inverse(&matrix([[(0, 1), (1, 1)], [(1, 1), (0, 1)]])).is_some());
    }
}
