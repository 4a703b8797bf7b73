//! A family of plants with known bounds, and whether a member lies within some bounding functions.

use super::claim::Claim;
use crate::expr::FloatExpr;
use std::cmp::Ordering;

/// a cos(k Om t + phase).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Harmonic {
    /// The amplitude a.
    pub amplitude: f64,
    /// k.
    pub order: u32,
    /// The phase.
    pub phase: f64,
}

/// A plant with n = 2 states, or none:
/// f = F x + e (g + g_1 v (v'x)) + (kappa/2) w (w'x)^2 and q = A(t) + (beta + d r(e)) m'x + c r(e), with unit vectors
/// v, w, m, r(e) = s tanh(e/s), and A a sum of harmonics.
///
/// |F| is the spectral norm, |g| the Euclidean one. Then |f| <= |F| X + E(|g| + g_1 X) + kappa X^2/2,
/// |df/de| <= |g| + g_1 X, |d2f/dedx| = g_1, |d2f/dxdx| = kappa, |q| <= sup|A| + (beta + d R) X + c R,
/// |dq/de| <= c + d X, |dq/dx| <= beta + d R, |dq/dt| <= sup|A'|, with R = min(E, s).
#[derive(Clone, Debug, PartialEq)]
pub struct Family {
    /// F, row by row; absent without states.
    pub jacobian: Option<[[f64; 2]; 2]>,
    /// |F|.
    pub jacobian_norm: f64,
    /// g.
    pub g: [f64; 2],
    /// g_1 >= 0.
    pub g_1: f64,
    /// kappa >= 0.
    pub kappa: f64,
    /// v, w, m.
    pub directions: [[f64; 2]; 3],
    /// beta >= 0.
    pub beta: f64,
    /// c >= 0.
    pub c: f64,
    /// d >= 0.
    pub d: f64,
    /// s > 0.
    pub saturation: f64,
    /// A.
    pub harmonics: Vec<Harmonic>,
    /// The period T.
    pub period: f64,
}

/// Ratio of neighbouring grid points.
const RATIO: f64 = 1.02;
/// The smallest grid point over the largest.
const SMALLEST: f64 = 1e-4;
/// The bounds in the order of [`Family::bounds`].
pub(super) const CONDITIONS: [&str; 10] = ["f", "f_e", "f_xx", "f_ex", "q", "q_e", "q_x", "q_t", "q_rms", "q_t_rms"];

impl Family {
    /// The bounds of the plant at (X, E), in the order of the fields of a specification. All are nondecreasing.
    #[must_use]
    pub fn bounds(&self, x: f64, e: f64) -> [f64; 10] {
        let omega = std::f64::consts::TAU / self.period;
        let amplitude = |power: i32| {
            self.harmonics.iter().map(move |h| h.amplitude.abs() * (f64::from(h.order) * omega).powi(power))
        };
        let rms = |power: i32| {
            let mean = |(h, size): (&Harmonic, f64)| if h.order == 0 { size * size } else { size * size / 2.0 };
            self.harmonics.iter().zip(amplitude(power)).map(mean).sum::<f64>().sqrt()
        };
        let (sup, slope): (f64, f64) = (amplitude(0).sum(), amplitude(1).sum());
        let r = e.min(self.saturation);
        let g = self.g[0].hypot(self.g[1]) + self.g_1 * x;
        let state_part = (self.beta + self.d * r) * x + self.c * r;
        [
            self.jacobian_norm * x + e * g + 0.5 * self.kappa * x * x,
            g,
            self.kappa,
            self.g_1,
            sup + state_part,
            self.c + self.d * x,
            self.beta + self.d * r,
            slope,
            rms(0) + state_part,
            rms(1),
        ]
    }

    /// The first bounding function that the plant is not shown to respect on X, E up to the reach of the claim.
    ///
    /// The bounds of the plant at the upper corner of each cell of a grid are compared with the bounding functions at
    /// the lower corner; both are nondecreasing, so that the cells cover the region from 1e-4 of the reach on. Closer
    /// to the axes, where both may tend to 0, the axes themselves are compared.
    #[must_use]
    pub fn exceeds(&self, claim: &Claim, compiled: &[FloatExpr]) -> Option<&'static str> {
        let cells = claim.reach.map(|last| {
            let count = (libm::log(1.0 / SMALLEST) / libm::log(RATIO)).ceil() as i32;
            let mut cells = vec![[0.0, 0.0]];
            cells.extend((0..count).rev().map(|k| [last * RATIO.powi(-k - 1), last * RATIO.powi(-k)]));
            cells
        });
        for x in &cells[0] {
            for e in &cells[1] {
                let plant = self.bounds(x[1], e[1]);
                for (index, (bound, expr)) in plant.iter().zip(compiled).enumerate() {
                    let allowed = expr.eval(x[0], e[0]);
                    // An undefined bounding function allows nothing.
                    if bound.partial_cmp(&allowed).is_none_or(Ordering::is_gt) {
                        return Some(CONDITIONS[index]);
                    }
                }
            }
        }
        None
    }
}
