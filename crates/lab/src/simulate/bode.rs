//! The transfer function of the linear example e' = u + q.

use sigmastar_exact::number::Portable;
use sigmastar_regulator::Regulator;

/// |e/q| at the angular frequency omega > 0 for e' = u + q with a regulator: 1/(|i omega + sigma| |1 + mu G|) with
/// G(i omega) = M'N(i omega I - Phi)^-1 M = n_0/(i omega) + sum n_l i omega/((l w)^2 - omega^2) (derivation,
/// section 3); 0 at the poles of G.
#[must_use]
pub fn magnitude(regulator: &Regulator, omega: f64) -> f64 {
    let Some((n_0, weights)) = regulator.weights.split_first() else {
        return 1.0 / omega.portable_hypot(regulator.sigma);
    };
    let sum = weights
        .iter()
        .zip(&regulator.frequencies)
        .fold(-n_0 / omega, |sum, (n_l, pole)| sum + n_l * omega / ((pole - omega) * (pole + omega)));
    // At a pole the sum is infinite and the magnitude 0.
    1.0 / (omega.portable_hypot(regulator.sigma) * 1.0_f64.portable_hypot(regulator.mu * sum))
}

/// `count` angular frequencies from `first` to `last`, evenly spaced on a logarithmic scale.
#[must_use]
pub fn frequencies(first: f64, last: f64, count: usize) -> Vec<f64> {
    let ratio = libm::log(last / first);
    let last_index = count.saturating_sub(1).max(1) as f64;
    (0..count).map(|k| first * libm::exp(ratio * k as f64 / last_index)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::ClosedLoop;
    use nalgebra::{DMatrix, DVector};
    use num_complex::Complex;
    use sigmastar_lang::plant::Plant;
    use std::f64::consts::{PI, TAU};

    fn regulators() -> [Regulator; 2] {
        let weights = (0..=10).map(|l| if l == 0 { 2.0 } else { f64::from(l).powf(-1.5) }).collect();
        [Regulator::high_gain(2.0), Regulator::new(2.0, 1.0, TAU, weights)]
    }

    #[test]
    fn the_reference_values_of_the_paper_example() {
        let [high_gain, internal_model] = regulators();
        for (omega, without, with) in [
            (1.0, 0.44721, 0.20236),
            (PI, 0.26851, 0.23823),
            (21.0 * PI, 0.015151, 0.015113),
            (1000.0, 9.9999800e-4, 9.9999002e-4),
        ] {
            let close = |value: f64, expected: f64| (value / expected - 1.0).abs() < 4e-5;
            assert!(close(magnitude(&high_gain, omega), without), "{omega}");
            assert!(close(magnitude(&internal_model, omega), with), "{omega} {}", magnitude(&internal_model, omega));
        }
        assert!((magnitude(&high_gain, 1000.0) - 9.9999800e-4).abs() < 1e-11);
        assert!((magnitude(&internal_model, 1000.0) - 9.9999002e-4).abs() < 1e-11);
        assert!(magnitude(&internal_model, 3.0 * TAU) < 1e-14);
    }

    #[test]
    fn the_formula_is_that_of_the_simulated_closed_loop() {
        let plant = Plant::from_json("linear", include_str!("../../../../specs/plants/linear.json")).unwrap();
        for regulator in regulators() {
            let closed_loop = ClosedLoop::new(&plant, regulator.clone());
            let d = closed_loop.dimension();
            let jacobian = closed_loop.linearise(&mut closed_loop.derivative_evaluator(), 0.3, &vec![0.0; d]);
            for omega in frequencies(0.1, 1000.0, 200) {
                let system = DMatrix::from_fn(d, d, |row, column| {
                    let diagonal = if row == column { omega } else { 0.0 };
                    Complex::new(-jacobian[row * d + column], diagonal)
                });
                // q enters e'.
                let mut input = DVector::from_element(d, Complex::new(0.0, 0.0));
                input[0] = Complex::new(1.0, 0.0);
                let response = system.lu().solve(&input).expect("no eigenvalue is imaginary");
                assert!((response[0].norm() - magnitude(&regulator, omega)).abs() < 1e-10, "{omega}");
            }
        }
    }
}
