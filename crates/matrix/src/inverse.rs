//! The inverse of a rational matrix, exactly.

use rug::Rational;

/// The inverse of a square rational matrix, exactly, by Gauss and Jordan's elimination; `None` if it is not square or singular.
#[must_use]
pub fn inverse(matrix: &[Vec<Rational>]) -> Option<Vec<Vec<Rational>>> {
    let n = matrix.len();
    if matrix.iter().any(|row| row.len() != n) {
        return None;
    }
    let identity = |i: usize| (0..n).map(move |j| Rational::from(u8::from(i == j)));
    let mut rows: Vec<Vec<Rational>> =
        matrix.iter().enumerate().map(|(i, row)| row.iter().cloned().chain(identity(i)).collect()).collect();
    for k in 0..n {
        let pivot = (k..n).find(|i| !rows[*i][k].is_zero())?;
        rows.swap(k, pivot);
        let scale = rows[k][k].clone();
        rows[k].iter_mut().for_each(|entry| *entry /= &scale);
        let own = rows[k].clone();
        for (i, row) in rows.iter_mut().enumerate() {
            let factor = row[k].clone();
            if i == k || factor.is_zero() {
                continue;
            }
            for (entry, pivot) in row.iter_mut().zip(&own) {
                *entry -= Rational::from(&factor * pivot);
            }
        }
    }
    Some(rows.into_iter().map(|row| row[n..].to_vec()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverses_are_exact() {
        let matrix = |rows: [[i32; 3]; 3]| -> Vec<Vec<Rational>> {
            rows.iter().map(|row| row.iter().map(|entry| Rational::from(*entry)).collect()).collect()
        };
        let a = matrix([[0, 2, 1], [3, 1, 0], [1, 0, -5]]);
        let b = inverse(&a).unwrap();
        for (i, row) in a.iter().enumerate() {
            let entry = |j: usize| -> Rational { row.iter().zip(&b).map(|(a, b)| Rational::from(a * &b[j])).sum() };
            assert!((0..3).all(|j| entry(j) == u8::from(i == j)));
        }
        assert_eq!(inverse(&matrix([[1, 2, 3], [2, 4, 6], [0, 0, 1]])), None);
        assert_eq!(inverse(&[vec![Rational::from(1), Rational::new()]]), None);
        assert_eq!(inverse(&[]), Some(Vec::new()));
    }
}
