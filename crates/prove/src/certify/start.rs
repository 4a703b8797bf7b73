//! Whether a simulation of a plant starts far outside of a certified set. Floating point: no claim rests on it.

use rug::Rational;
use sigmastar_exact::number::in_digits;
use sigmastar_lang::plant::Initial;
use sigmastar_lang::spec::OfPlant;
use sigmastar_matrix::inverse;

/// A start that is so many times as far from the orbit as the set reaches is far outside: a set whose sizes nobody stated is a few times the
/// periodic solution, wherever simulations start.
const FAR: f64 = 3.0;

/// A share of the sizes at hand below which a distance may be rounding.
const ROUNDING: f64 = 1e-9;

/// A start at t = 0 far outside of a set about the orbit.
#[derive(Clone, Debug, PartialEq)]
pub struct FarStart {
    /// x(0).
    pub x: Vec<f64>,
    /// e(0).
    pub e: f64,
    /// x_0(0), of the nominal plant of a family.
    pub x_0: Vec<f64>,
    /// `|L^-1 (x(0) - x_0(0))|` and |e(0)|.
    pub away: [f64; 2],
    /// X_0 and E_0.
    pub set: [f64; 2],
}

impl FarStart {
    /// The start, where it is far outside of the set `|L^-1 (x - x_0)| <= X_0`, `|e| <= E_0` of a plant.
    #[must_use]
    pub fn of(plant: &OfPlant, initial: &Initial, set: [&Rational; 2]) -> Option<FarStart> {
        let inverse = inverse(&plant.coordinates)?;
        let nominal = plant.parameters.nominal();
        let cell = plant.cells.iter().find(|cell| cell.parameters.contain(&nominal))?;
        let orbit = cell.orbit.approximation.at(&cell.parameters.deviations(&nominal));
        let at_start =
            |i: usize| orbit.mean[i].to_f64() + orbit.harmonics.iter().map(|[cos, _]| cos[i].to_f64()).sum::<f64>();
        let x_0: Vec<f64> = (0..plant.states()).map(at_start).collect();
        let norm = |vector: &dyn Fn(usize) -> f64| -> f64 {
            let row = |row: &Vec<Rational>| -> f64 {
                row.iter().enumerate().map(|(j, entry)| entry.to_f64() * vector(j)).sum()
            };
            inverse.iter().map(row).map(|entry| entry * entry).sum::<f64>().sqrt()
        };
        let x = &initial.x;
        let away = [norm(&|i| x[i] - x_0[i]), initial.e.abs()];
        let set = set.map(Rational::to_f64);
        let unsure = [ROUNDING * (norm(&|i| x[i].abs()) + norm(&|i| x_0[i].abs())), 0.0];
        let far = (0..2).any(|i| away[i] > FAR * set[i] + unsure[i]);
        far.then(|| FarStart { x: x.clone(), e: initial.e, x_0, away, set })
    }

    /// The same in a sentence without a final stop.
    #[must_use]
    pub fn describe(&self) -> String {
        let FarStart { x, e, x_0, away: [y, error], set: [x0, e0] } = self;
        let list = |numbers: &[f64]| numbers.iter().map(|number| short(*number)).collect::<Vec<_>>().join(", ");
        // The state is within, or there is none.
        if *y <= FAR * x0 && *error > FAR * e0 {
            return format!(
                "`simulate` starts at e = {}, far outside of the certified set |e| <= {}: nothing is claimed from there",
                short(*e),
                short(*e0)
            );
        }
        format!(
            "`simulate` starts at x = ({}), e = {}, far outside of the certified set |y| <= {}, |e| <= {}: the orbit that it is about has x_0(0) = \
             ({}), and |y| is {} at that start, where nothing is claimed; the plant may have another orbit there",
            list(x),
            short(*e),
            short(*x0),
            short(*e0),
            list(x_0),
            short(*y)
        )
    }
}

/// Four digits.
fn short(value: f64) -> String {
    in_digits(value, 4)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sigmastar_lang::plant::InitialRegulator;
    use sigmastar_lang::spec::{
        Constant, Lyapunov, Parameters, PeriodicMatrix, ProvedCell, ProvedForcing, ProvedOrbit, TrigonometricVector,
    };

    /// x_0(0) = 1 + 1/2, and L = 2.
    fn plant() -> OfPlant {
        let rational = |p: i32, q: i32| Rational::from((p, q));
        let curve = TrigonometricVector {
            mean: vec![rational(1, 1)],
            harmonics: vec![[vec![rational(1, 2)], vec![rational(7, 1)]]],
        };
        let [defect, tube, radius] = [(); 3].map(|()| rational(1, 100));
        let (mean, rest, rest_t) = (Rational::new(), Rational::new(), Rational::new());
        let forcing = ProvedForcing { mean, harmonics: Vec::new(), sensitivities: Vec::new(), rest, rest_t };
        let orbit = ProvedOrbit { approximation: curve.into(), defect, tube, radius };
        let one = || Constant::rational(&rational(1, 1));
        OfPlant {
            parameters: Parameters::default(),
            coordinates: vec![vec![rational(2, 1)]],
            cells: vec![ProvedCell { parameters: Parameters::default(), orbit, forcing }],
            why_cut: None,
            triple: Lyapunov { p_low: one(), p_up: one(), alpha: one() },
            matrix: PeriodicMatrix { mean: vec![vec![rational(1, 1)]], harmonics: Vec::new() },
            existence: None,
            domain: None,
            ball: None,
        }
    }

    #[test]
    fn a_start_is_far_in_the_norm_of_the_set() {
        let far = |x: f64, e: f64| {
            let initial = Initial { x: vec![x], e, z: InitialRegulator::AtRest };
            FarStart::of(&plant(), &initial, [&Rational::from((1, 2)), &Rational::from(1)])
        };
        // |y| = |x - 3/2|/2, and 3/2 is far of 1/2.
        assert_eq!((far(4.4, 2.9), far(-1.4, 0.0)), (None, None));
        let other = far(-1.6, 0.0).unwrap();
        assert!((other.away[0] - 1.55).abs() < 1e-12 && other.x_0 == [1.5], "{other:?}");
        assert!(other.describe().contains("x_0(0) = (1.5), and |y| is 1.55 at that start"), "{}", other.describe());
        let error = far(1.5, -3.1).unwrap().describe();
        assert!(error.contains("starts at e = -3.1, far outside") && !error.contains("x_0"), "{error}");
    }
}
