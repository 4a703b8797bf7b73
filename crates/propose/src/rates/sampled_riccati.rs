//! The quadratic function of a decay at samples, proposed in floating point by a discrete Riccati equation.
//!
//! For `y+ = A y + B u`, `out = C y + D u` ask for Pi with `y'Pi y + |u|^2 - |out|^2 - (y+)'Pi (y+) >= 0`. There is one if and only if the largest
//! gain from u to out is at most 1 (A being Schur), and the least one is what the worst u gets out from y on:
//! `Pi = A_0'Pi (I - G Pi)^-1 A_0 + H_0`, `A_0 = A + B E D'C`, `G = B E B'`, `H_0 = C'(I + D E D')C`, `E = (I - D'D)^-1`. Doubling the number of steps
//! that are looked at (the structure-preserving doubling algorithm) gets there with few products of matrices. The largest one is the
//! inverse of the least one of the transposed system.

use faer::Mat;
use faer::linalg::solvers::DenseSolveCore;

/// Doublings at most: 2^40 samples.
const DOUBLINGS: u32 = 40;

/// What a doubling has to add, relative to what there is, to go on.
const SETTLED: f64 = 1e-15;

/// A linear system from u to out.
#[derive(Clone, Debug)]
pub(super) struct System {
    pub(super) a: Mat<f64>,
    pub(super) b: Mat<f64>,
    pub(super) c: Mat<f64>,
    pub(super) d: Mat<f64>,
}

fn inverse(matrix: &Mat<f64>) -> Option<Mat<f64>> {
    let inverse = matrix.partial_piv_lu().inverse();
    inverse.as_ref().is_all_finite().then_some(inverse)
}

fn identity(order: usize) -> Mat<f64> {
    Mat::identity(order, order)
}

fn symmetric(matrix: &Mat<f64>) -> Mat<f64> {
    Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| f64::midpoint(matrix[(i, j)], matrix[(j, i)]))
}

fn size(matrix: &Mat<f64>) -> f64 {
    (0..matrix.nrows()).map(|i| matrix[(i, i)].abs()).fold(0.0, f64::max)
}

impl System {
    /// The least Pi; `None` where it is not met.
    pub(super) fn least(&self) -> Option<Mat<f64>> {
        let System { a, b, c, d } = self;
        if ![a, b, c, d].iter().all(|matrix| matrix.as_ref().is_all_finite()) {
            return None;
        }
        let of_input = inverse(&(identity(d.ncols()) - d.transpose() * d))?;
        let through = &of_input * d.transpose();
        let mut a = a + b * &through * c;
        let mut g = symmetric(&(b * &of_input * b.transpose()));
        let mut h = symmetric(&(c.transpose() * (identity(d.nrows()) + d * &through) * c));
        let n = a.nrows();
        for _ in 0..DOUBLINGS {
            let w = inverse(&(identity(n) - &g * &h))?;
            let moved = &w * &a;
            let more = symmetric(&(a.transpose() * &h * &moved));
            let further = symmetric(&(&a * &w * &g * a.transpose()));
            a = &a * &moved;
            let grown = size(&more);
            h += more;
            g += further;
            if ![&a, &g, &h].iter().all(|matrix| matrix.as_ref().is_all_finite()) {
                return None;
            }
            if grown <= SETTLED * size(&h) {
                return Some(h);
            }
        }
        None
    }

    /// The largest Pi; `None` where it is not met.
    pub(super) fn largest(&self) -> Option<Mat<f64>> {
        let [a, b, c, d] = [&self.a, &self.b, &self.c, &self.d].map(|matrix| matrix.transpose().to_owned());
        let dual = System { a, b: c, c: b, d };
        dual.least().and_then(|least| inverse(&least)).map(|matrix| symmetric(&matrix))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of one state: the quadratic equation by hand. `y+ = a y + b u`, out = c y: `Pi = a^2 Pi/(1 - b^2 Pi) + c^2`.
    #[test]
    fn of_one_state_both_solutions_are_known() {
        let one = |value: f64| Mat::from_fn(1, 1, |_, _| value);
        let (a, b, c) = (0.8, 0.3, 0.5);
        let system = System { a: one(a), b: one(b), c: one(c), d: one(0.0) };
        let [least, largest] = [system.least(), system.largest()].map(|pi| pi.expect("below 1")[(0, 0)]);
        for pi in [least, largest] {
            assert!((a * a * pi / (1.0 - b * b * pi) + c * c - pi).abs() < 1e-12, "{pi}");
        }
        assert!(0.0 < least && least < largest && largest < 1.0 / (b * b), "{least} {largest}");
        // The gain b c/(1 - a) above 1.
        let steep = System { c: one(0.7), ..system };
        assert!(steep.least().is_none_or(|pi| pi[(0, 0)] < 0.0 || pi[(0, 0)] * b * b >= 1.0));
    }
}
