//! The function that falls along every solution where a claim rests on joint metrics (derivation, 13.7, (Jm)).

use rug::Rational;
use sigmastar_exact::number::Portable;
use sigmastar_lang::spec::{Metric, Specification};

/// `V = (y, e)' Pi (y, e) + (k_p mu/2) |zeta|_N^2` of the metric that belongs to a gain.
#[derive(Clone, Debug)]
pub struct JointFunction {
    near: Form,
    far: Form,
    /// The threshold of the near metric.
    value: f64,
    mu: f64,
}

#[derive(Clone, Debug)]
struct Form {
    matrix: Vec<Vec<f64>>,
    cross: Vec<f64>,
    weight: f64,
    k_p: f64,
}

impl From<&Metric> for Form {
    fn from(Metric { matrix, cross, weight, k_p, .. }: &Metric) -> Form {
        let row = |row: &Vec<Rational>| row.iter().map(Rational::to_f64).collect();
        let (matrix, cross) = (matrix.iter().map(row).collect(), row(cross));
        Form { matrix, cross, weight: weight.to_f64(), k_p: k_p.to_f64() }
    }
}

impl Form {
    fn at(&self, y: &[f64], e: f64, of_zeta: f64) -> f64 {
        let dot = |a: &[f64]| a.iter().zip(y).map(|(a, b)| a * b).sum::<f64>();
        let of_states: f64 = self.matrix.iter().zip(y).map(|(row, y)| y * dot(row)).sum();
        of_states + 2.0 * e * dot(&self.cross) + self.weight * e * e + self.k_p * of_zeta
    }
}

impl JointFunction {
    /// That of the proved data of a claim, where there is one.
    pub(super) fn of(spec: &Specification) -> Option<JointFunction> {
        let joint = &spec.bounds.proved_values().joint_stability.as_ref()?.inequality;
        let [near, far] = joint.metrics().map(Form::from);
        Some(JointFunction { near, far, value: joint.value.to_f64(), mu: spec.internal_model.mu.to_f64() })
    }

    /// V of a difference at a gain, with |zeta|_N.
    pub(super) fn at(&self, sigma: f64, y: &[f64], e: f64, zeta: f64) -> f64 {
        let share = (self.value / sigma).min(1.0);
        let of_zeta = 0.5 * self.mu * zeta.portable_powi(2);
        share * self.near.at(y, e, of_zeta) + (1.0 - share) * self.far.at(y, e, of_zeta)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn form(entries: [f64; 5]) -> Form {
        let [p, q, cross, weight, k_p] = entries;
        Form { matrix: vec![vec![p, q], vec![q, p]], cross: vec![cross, -cross], weight, k_p }
    }

    /// Of the near metric at the threshold, of the far one at gains without end, between them in between.
    #[test]
    fn the_metric_moves_with_the_gain() {
        let near = form([3.0, 1.0, 0.5, 2.0, 4.0]);
        let far = form([5.0, 0.0, 0.0, 1.0, 8.0]);
        let function = JointFunction { near, far, value: 2.0, mu: 3.0 };
        let at = |sigma: f64| function.at(sigma, &[1.0, -2.0], 0.5, 2.0);
        // 3 + 12 - 4, 2 e (1/2 + 1), 2 e^2, 4 (3/2) 4; and 5 + 20, e^2, 8 (3/2) 4.
        let (near, far) = (11.0 + 1.5 + 0.5 + 24.0, 25.0 + 0.25 + 48.0);
        assert_eq!(at(2.0), near);
        assert_eq!(at(4.0), 0.5 * (near + far));
        assert_eq!(at(8.0), 0.25 * near + 0.75 * far);
        assert!((at(2e12) - far).abs() < 1e-9);
        // Never outside of the two.
        assert_eq!(at(1.0), near);
    }
}
