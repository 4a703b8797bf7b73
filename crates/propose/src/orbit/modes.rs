//! Axes along the modes of the linear part: each oscillation as `[[-a, w], [-w, -a]]`, each real eigenvalue by itself, and the
//! sizes of the modes such that e acts on each as much as it acts on q. In them a linear plant is the same in whatever units
//! and axes its states are written. Doubles; nothing rests on them.

use nalgebra::{Complex, DMatrix, DVector, Schur};

/// The ratio of the singular values beyond which modes are so nearly parallel that they are no axes.
const PARALLEL: f64 = 1e6;

/// What e does to a mode, or a mode to q, relative to what rounding leaves of it: below this it is nothing.
const NOTHING: f64 = 1e-11;

/// The size of a mode on which e does not act, or that does not act on q, relative to the largest.
const APART: f64 = 1e-3;

/// Steps of an inverse iteration.
const STEPS: usize = 3;

/// The columns of real and imaginary parts of the eigenvectors; `None` where there are too few of them, or where they are nearly
/// parallel. `f_e` and `q_x` set their sizes.
pub(super) fn modes(matrix: &DMatrix<f64>, f_e: &DVector<f64>, q_x: &DVector<f64>) -> Option<DMatrix<f64>> {
    let n = matrix.nrows();
    let mut values: Vec<Complex<f64>> =
        Schur::try_new(matrix.clone(), f64::EPSILON, 10_000)?.complex_eigenvalues().iter().copied().collect();
    values.retain(|value| value.im >= 0.0);
    values.sort_by(|a, b| a.re.total_cmp(&b.re).then(a.im.total_cmp(&b.im)));
    let mut columns: Vec<DVector<f64>> = Vec::new();
    // The first column of each mode, and their number.
    let mut blocks = Vec::new();
    for value in values {
        let vector = eigenvector(matrix, value)?;
        let parts = if value.im == 0.0 { 1 } else { 2 };
        blocks.push((columns.len(), parts));
        columns.push(vector.map(|entry| entry.re));
        if parts == 2 {
            columns.push(vector.map(|entry| entry.im));
        }
    }
    if columns.len() != n {
        return None;
    }
    let mut basis = DMatrix::from_columns(&columns);
    let singular = basis.clone().singular_values();
    // False for NaN as well.
    let apart = singular.max() <= PARALLEL * singular.min();
    if !apart {
        return None;
    }
    let inverse = basis.clone().try_inverse()?;
    let (inputs, outputs) = (&inverse * f_e, basis.transpose() * q_x);
    let part = |vector: &DVector<f64>, (first, parts): (usize, usize)| vector.rows(first, parts).norm();
    let sizes: Vec<[f64; 2]> = blocks
        .iter()
        .map(|block| {
            let (first, parts) = *block;
            let lost = NOTHING * f_e.norm() * inverse.rows(first, parts).norm();
            let lost_out = NOTHING * q_x.norm() * basis.columns(first, parts).norm();
            let kept = |size: f64, lost: f64| if size > lost { size } else { 0.0 };
            [kept(part(&inputs, *block), lost), kept(part(&outputs, *block), lost_out)]
        })
        .collect();
    let largest = sizes.iter().map(|[input, output]| (input * output).sqrt()).fold(0.0, f64::max);
    for ((first, parts), [input, output]) in blocks.into_iter().zip(sizes) {
        let factor = match (input > 0.0, output > 0.0) {
            (true, true) => (input / output).sqrt(),
            (true, false) if largest > 0.0 => input / (APART * largest),
            (false, true) if largest > 0.0 => APART * largest / output,
            (true, false) => input,
            (false, true) => output.recip(),
            (false, false) => 1.0,
        };
        basis.columns_mut(first, parts).scale_mut(factor);
    }
    basis.iter().all(|entry| entry.is_finite()).then_some(basis)
}

/// A vector of length 1, by inverse iteration; real where the eigenvalue is.
fn eigenvector(matrix: &DMatrix<f64>, value: Complex<f64>) -> Option<DVector<Complex<f64>>> {
    let n = matrix.nrows();
    let size = matrix.amax().max(f64::MIN_POSITIVE);
    let shifted = DMatrix::from_fn(n, n, |i, j| {
        // Moved away from the eigenvalue, so that the system is not singular.
        let own = if i == j { value + Complex::from(8.0 * f64::EPSILON * size) } else { Complex::from(0.0) };
        Complex::from(matrix[(i, j)]) - own
    });
    let solver = shifted.lu();
    let mut vector = DVector::from_fn(n, |i, _| Complex::from(1.0 + 0.1 * i as f64));
    for _ in 0..STEPS {
        vector = solver.solve(&vector)?;
        let length = vector.norm();
        if !(length.is_finite() && length > 0.0) {
            return None;
        }
        vector.unscale_mut(length);
    }
    Some(vector)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A flexible shaft and a lag in axes that hide them: each stands by itself, whatever the units of the states are.
    #[test]
    fn modes_stand_by_themselves_in_any_units() {
        let plain = DMatrix::from_row_slice(3, 3, &[-30.0, 55.0, 0.0, -55.0, -30.0, 0.0, 0.0, 0.0, -7.0]);
        let (f_e, q_x) = (DVector::from_vec(vec![3.0, 4.0, 1.0]), DVector::from_vec(vec![5.0, 0.0, 1.0]));
        for units in [[1.0, 1.0, 1.0], [1e-3, 10.0, 1.0]] {
            let axes = DMatrix::from_row_slice(3, 3, &[1.0, 0.5, -0.2, 0.0, 1.0, 0.7, 0.3, 0.0, 1.0]);
            let axes = DMatrix::from_fn(3, 3, |i, j| axes[(i, j)] * units[i]);
            let inverse = axes.clone().try_inverse().unwrap();
            let (matrix, f_e, q_x) = (&axes * &plain * &inverse, &axes * &f_e, inverse.transpose() * &q_x);
            let basis = modes(&matrix, &f_e, &q_x).unwrap();
            let own = basis.clone().try_inverse().unwrap();
            let found = &own * matrix * &basis;
            let symmetric = (&found + found.transpose()) / 2.0;
            for (i, expected) in [-30.0, -30.0, -7.0].into_iter().enumerate() {
                assert!((symmetric[(i, i)] - expected).abs() < 1e-6, "{symmetric}");
                assert!((0..i).all(|j| symmetric[(i, j)].abs() < 1e-6), "{symmetric}");
            }
            // e acts on each as much as it acts on q: 5 and 5, 1 and 1.
            let (inputs, outputs) = (&own * f_e, basis.transpose() * q_x);
            for (first, parts, size) in [(0, 2, 5.0), (2, 1, 1.0)] {
                for vector in [&inputs, &outputs] {
                    assert!((vector.rows(first, parts).norm() - size).abs() < 1e-6);
                }
            }
        }
    }

    /// Equal lags in a row have one eigenvector only.
    #[test]
    fn without_enough_eigenvectors_there_are_no_axes() {
        let chain = DMatrix::from_row_slice(2, 2, &[-1.0, 1.0, 0.0, -1.0]);
        let vector = DVector::from_vec(vec![1.0, 1.0]);
        assert!(modes(&chain, &vector, &vector).is_none());
    }
}
