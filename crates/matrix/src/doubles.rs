//! Eigenvalues of small symmetric matrices in doubles, by Jacobi's rotations. They propose; nothing rests on them.

use sigmastar_exact::number::Portable;

/// Sweeps after which the rotations end; convergence is quadratic.
const SWEEPS: usize = 12;

/// Rotates a symmetric matrix by rows until it is diagonal, and the rows of `vectors` with it.
fn rotate(matrix: &mut [f64], order: usize, vectors: &mut [f64]) {
    for _ in 0..SWEEPS {
        let mut rotated = false;
        for p in 0..order {
            for q in p + 1..order {
                let off = matrix[p * order + q];
                let (at_p, at_q) = (matrix[p * order + p], matrix[q * order + q]);
                // A NaN ends it as well.
                if off == 0.0 || off.abs() <= (at_p.abs() + at_q.abs()) * 1e-15 || !off.is_finite() {
                    continue;
                }
                rotated = true;
                let theta = (at_q - at_p) / (2.0 * off);
                let tangent = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
                let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
                let sine = tangent * cosine;
                for row in matrix.chunks_mut(order).chain(vectors.chunks_mut(order)) {
                    let (a, b) = (row[p], row[q]);
                    (row[p], row[q]) = (cosine * a - sine * b, sine * a + cosine * b);
                }
                for k in 0..order {
                    let (a, b) = (matrix[p * order + k], matrix[q * order + k]);
                    (matrix[p * order + k], matrix[q * order + k]) = (cosine * a - sine * b, sine * a + cosine * b);
                }
            }
        }
        if !rotated {
            break;
        }
    }
}

/// The eigenvalues of a symmetric matrix, and the eigenvectors as columns. Of the entries both triangles are read.
#[must_use]
pub fn eigen(matrix: Vec<Vec<f64>>) -> (Vec<f64>, Vec<Vec<f64>>) {
    let order = matrix.len();
    let mut matrix = matrix.concat();
    let mut vectors: Vec<f64> = (0..order * order).map(|k| f64::from(k / order == k % order)).collect();
    rotate(&mut matrix, order, &mut vectors);
    let rows = vectors.chunks(order.max(1)).map(<[f64]>::to_vec).collect();
    ((0..order).map(|i| matrix[i * order + i]).collect(), rows)
}

/// The largest eigenvalue of a symmetric matrix; of order 0, negative infinity.
#[must_use]
pub fn largest(matrix: Vec<Vec<f64>>) -> f64 {
    if let [[a, b], [_, d]] = matrix.iter().map(Vec::as_slice).collect::<Vec<_>>()[..] {
        return (a + d) / 2.0 + ((a - d).portable_powi(2) / 4.0 + b * b).sqrt();
    }
    eigen(matrix).0.into_iter().fold(f64::NEG_INFINITY, f64::max)
}

/// The same of a matrix by rows, which is used as working memory.
pub fn largest_of(matrix: &mut [f64], order: usize) -> f64 {
    match (order, &*matrix) {
        (1, [a]) => return *a,
        (2, [a, b, _, d]) => return (a + d) / 2.0 + ((a - d).portable_powi(2) / 4.0 + b * b).sqrt(),
        (3, [a, b, c, _, d, e, _, _, f]) => return largest_of_three([*a, *d, *f], [*b, *c, *e]),
        _ => {}
    }
    rotate(matrix, order, &mut []);
    (0..order).map(|i| matrix[i * order + i]).fold(f64::NEG_INFINITY, f64::max)
}

/// The largest root of the characteristic polynomial, by cosines; from the diagonal and (1,2), (1,3), (2,3).
fn largest_of_three([a, d, f]: [f64; 3], [b, c, e]: [f64; 3]) -> f64 {
    let mean = (a + d + f) / 3.0;
    let off = b * b + c * c + e * e;
    let [a, d, f] = [a - mean, d - mean, f - mean];
    let size = ((a * a + d * d + f * f + 2.0 * off) / 6.0).sqrt();
    if size == 0.0 {
        return mean;
    }
    let determinant = a * (d * f - e * e) - b * (b * f - e * c) + c * (b * e - d * c);
    let cosine = (determinant / (2.0 * size.portable_powi(3))).clamp(-1.0, 1.0);
    mean + 2.0 * size * libm::cos(libm::acos(cosine) / 3.0)
}

/// The product of two matrices by rows.
#[must_use]
pub fn product(a: &[Vec<f64>], b: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let columns = b.first().map_or(0, Vec::len);
    let entry = |row: &Vec<f64>, j: usize| row.iter().zip(b).map(|(x, row)| x * row[j]).sum();
    a.iter().map(|row| (0..columns).map(|j| entry(row, j)).collect()).collect()
}

/// The transposed matrix by rows.
#[must_use]
pub fn transposed<T: Clone>(of: &[Vec<T>]) -> Vec<Vec<T>> {
    (0..of.first().map_or(0, Vec::len)).map(|i| of.iter().map(|row| row[i].clone()).collect()).collect()
}

/// The symmetric root of P, and its inverse.
#[must_use]
pub fn roots(p: &[Vec<f64>]) -> [Vec<Vec<f64>>; 2] {
    let n = p.len();
    let (values, vectors) = eigen(p.to_vec());
    [1.0, -1.0].map(|sign| {
        let weight = |k: usize| if sign > 0.0 { values[k].sqrt() } else { values[k].sqrt().recip() };
        let entry = |i: usize, j: usize| (0..n).map(|k| vectors[i][k] * vectors[j][k] * weight(k)).sum();
        (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_find_the_same_largest_one() {
        for order in 1..=6 {
            let entry = |i: usize, j: usize| libm::sin((3 * i.min(j) + 7 * i.max(j) + order) as f64);
            let rows: Vec<Vec<f64>> = (0..order).map(|i| (0..order).map(|j| entry(i, j)).collect()).collect();
            assert!((largest_of(&mut rows.concat(), order) - largest(rows)).abs() < 1e-12, "{order}");
        }
    }

    #[test]
    fn eigenvalues_by_hand() {
        let matrix = vec![vec![2.0, 1.0, 0.0], vec![1.0, 2.0, 0.0], vec![0.0, 0.0, -5.0]];
        let (mut values, vectors) = eigen(matrix.clone());
        for (k, value) in values.iter().enumerate() {
            for row in 0..3 {
                let image: f64 = (0..3).map(|j| matrix[row][j] * vectors[j][k]).sum();
                assert!((image - value * vectors[row][k]).abs() < 1e-12);
            }
        }
        values.sort_by(f64::total_cmp);
        assert!(values.iter().zip([-5.0, 1.0, 3.0]).all(|(a, b)| (a - b).abs() < 1e-12));
        assert!((largest(vec![vec![2.0, 1.0], vec![1.0, 2.0]]) - 3.0).abs() < 1e-12);
    }
}
