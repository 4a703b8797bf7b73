//! Where the trade-off curve between k0 and k1 runs for every x >= 0, in floating point: candidates for a proof.

use super::boxes::MAX_M0;
use super::matched::TradeOff;
use crate::data::Data;
use crate::number::Portable;

/// The largest pole and the largest number of oscillators that are sampled.
const POLES: usize = 48;
/// The largest x that is sampled, as an integer.
const REACH: usize = 24;
/// How much k1 lies above the sampled curve, so that boxes of finite size can prove it.
const ROOM: f64 = 1.003;

impl TradeOff {
    /// Pairs just above the trade-off curve, for k0 from just above T(0) to a hundred times that.
    ///
    /// Floating point and sampled: each pair is to be proved by boxes before it is used.
    #[must_use]
    pub fn curve(data: &Data<'_>) -> TradeOff {
        let weights: Vec<f64> = (0..=POLES as u64).map(|l| data.spec.internal_model.weights.weight_f64(l)).collect();
        let nu = data.nu.midpoint_f64();
        let samples: Vec<(f64, f64)> =
            sample_points(&weights, nu).into_iter().map(|x| (x, supremum(&weights, nu, x))).collect();
        let least = 1.0 / (nu * nu * weights[0]);
        // No k1 much smaller passes the scalar test at the largest m0 that is tried.
        let m = f64::from(MAX_M0);
        let last = data.spec.internal_model.weights.weight_f64(u64::from(MAX_M0));
        let sum_bound = (weights[0] + weights[1] * (2.35 + 1.5 * m.portable_ln())) / (m - 0.5);
        let floor = 1.1 * 2.0 / (m * m * last) * (1.0 / (nu * nu) + sum_bound * sum_bound);
        let candidates = (0..=120)
            .map(|step| {
                let k0 = least * (1.0 + 3e-3 * 1.091_f64.powi(step));
                let k1 = samples.iter().map(|(x, value)| (value - k0) / (x * x)).fold(0.0, f64::max);
                (k0, (k1 * ROOM).max(floor), 0)
            })
            .filter(|(k0, k1, _)| k0.is_finite() && k1.is_finite())
            .collect();
        TradeOff { candidates }
    }
}

/// Points around every pole at the scale of its Lorentzian, whose half width is about nu c_m, and a uniform grid.
fn sample_points(weights: &[f64], nu: f64) -> Vec<f64> {
    let mut points: Vec<f64> = (1..=REACH * 40).map(|k| k as f64 / 40.0).collect();
    for (m, weight) in weights.iter().enumerate().take(REACH) {
        let width = nu * if m == 0 { *weight } else { weight / 2.0 };
        let around = (-40..=40).map(|k| m as f64 + width * f64::from(k) / 8.0);
        points.extend(around.filter(|x| *x > 1e-9 && (x - m as f64).abs() <= 0.5));
    }
    points
}

/// The largest T_N(x) over N = 0, ..., POLES, in the form with the nearest pole taken out.
fn supremum(weights: &[f64], nu: f64, x: f64) -> f64 {
    let nearest = x.round() as usize;
    let d = x - nearest as f64;
    let (mut sum, mut slope, mut best) = (0.0, 0.0, 0.0_f64);
    for (l, weight) in weights.iter().enumerate() {
        let pole = l as f64;
        if l == 0 {
            if nearest != 0 {
                sum -= weight / x;
                slope += weight / (x * x);
            }
        } else {
            sum -= weight / 2.0 / (pole + x);
            slope += weight / 2.0 / (pole + x).powi(2);
            if l != nearest {
                sum += weight / 2.0 / (pole - x);
                slope += weight / 2.0 / (pole - x).powi(2);
            }
        }
        let value = if l < nearest {
            slope / (1.0 + nu * nu * sum * sum)
        } else {
            let residue = if nearest == 0 { weights[0] } else { weights[nearest] / 2.0 };
            (residue + slope * d * d) / (d * d + (nu * (residue - sum * d)).powi(2))
        };
        best = best.max(value);
    }
    best
}
