//! Units in which the entries of matrices are of one size.

use nalgebra::DMatrix;

/// Sweeps over the rows at most.
const SWEEPS: usize = 60;

/// Powers of two by which the components are to be divided, so that rows and columns of the matrices have similar sizes (Osborne,
/// On pre-conditioning of matrices, 1960).
pub(super) fn balance(matrices: &[DMatrix<f64>]) -> Vec<f64> {
    let n = matrices.first().map_or(0, DMatrix::nrows);
    let mut scale = vec![1.0_f64; n];
    for _ in 0..SWEEPS {
        let mut changed = false;
        for i in 0..n {
            let (mut row, mut column) = (0.0, 0.0);
            for matrix in matrices {
                for j in (0..n).filter(|j| *j != i) {
                    row += matrix[(i, j)].abs() * scale[j] / scale[i];
                    column += matrix[(j, i)].abs() * scale[i] / scale[j];
                }
            }
            if row > 0.0 && column > 0.0 && row.is_finite() && column.is_finite() {
                // The nearest power of two to the root of the quotient.
                let (fraction, exponent) = libm::frexp((row / column).sqrt());
                let exponent = if fraction < std::f64::consts::FRAC_1_SQRT_2 { exponent - 1 } else { exponent };
                scale[i] *= libm::ldexp(1.0, exponent);
                changed |= exponent != 0;
            }
        }
        if !changed {
            break;
        }
    }
    scale
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The entries of a matrix in other units come back to one size.
    #[test]
    fn units_far_apart_are_brought_to_one_size() {
        let plain = DMatrix::from_row_slice(3, 3, &[-1.0, 2.0, 0.5, 1.0, -3.0, 1.0, 0.7, 2.0, -1.0]);
        let units = [1e-6, 3.0, 1e7];
        let written = DMatrix::from_fn(3, 3, |i, j| plain[(i, j)] * units[i] / units[j]);
        let scale = balance(std::slice::from_ref(&written));
        for i in 0..3 {
            for j in 0..3 {
                let entry = (written[(i, j)] * scale[j] / scale[i]).abs();
                assert!(entry > 0.2 && entry < 8.0, "{entry}");
            }
        }
    }

    /// A component that acts on nothing, or on which nothing acts, has no size, and none is made up.
    #[test]
    fn a_component_apart_keeps_its_unit() {
        let matrix = DMatrix::from_row_slice(2, 2, &[-1.0, 1e9, 0.0, -2.0]);
        assert_eq!(balance(&[matrix]), [1.0, 1.0]);
    }
}
