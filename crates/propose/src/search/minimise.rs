//! Local minimisation by the simplex method of Nelder and Mead (library `argmin`).

use argmin::core::{CostFunction, Error, Executor, State};
use argmin::solver::neldermead::NelderMead;

/// Behind a pointer, so that the method is compiled once.
struct Cost<'a>(&'a dyn Fn(&[f64]) -> Option<f64>);

impl CostFunction for Cost<'_> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, parameters: &Vec<f64>) -> Result<f64, Error> {
        // A large finite cost keeps infeasible points out without spoiling the method's arithmetic.
        Ok((self.0)(parameters).filter(|cost| cost.is_finite()).unwrap_or(1e9))
    }
}

/// How long a minimisation goes on.
#[derive(Clone, Copy, Debug)]
pub struct Descent {
    /// Restarts at most.
    pub restarts: usize,
    /// Iterations between restarts at most.
    pub iterations: u64,
    /// The standard deviation of the costs of a simplex at which it has converged.
    pub tolerance: f64,
}

/// Minimises `cost` from `start` with initial steps `steps`; `None` marks an infeasible point. Returns the best
/// parameters found and their cost, or `None` if every point tried was infeasible.
///
/// Deterministic. The method is restarted from its result with smaller steps until that no longer helps, because a simplex
/// can collapse against the boundary of the feasible set.
pub fn minimise(
    cost: &dyn Fn(&[f64]) -> Option<f64>,
    start: &[f64],
    steps: &[f64],
    descent: Descent,
) -> Option<(Vec<f64>, f64)> {
    let mut best = (start.to_vec(), cost(start).filter(|c| c.is_finite())?);
    let mut scale = 1.0;
    let least = 100.0 * descent.tolerance;
    for _ in 0..=descent.restarts {
        let mut simplex = vec![best.0.clone()];
        for (index, step) in steps.iter().enumerate() {
            let mut vertex = best.0.clone();
            vertex[index] += step * scale;
            simplex.push(vertex);
        }
        let solver = NelderMead::new(simplex).with_sd_tolerance(descent.tolerance).ok()?;
        let run = Executor::new(Cost(cost), solver);
        let run = run.configure(|state| state.max_iters(descent.iterations)).run().ok()?;
        let found = run.state().get_best_param().cloned().zip(Some(run.state().get_best_cost()));
        match found {
            Some((parameters, value)) if value < best.1 - least => best = (parameters, value),
            Some((parameters, value)) if value < best.1 => {
                best = (parameters, value);
                break;
            }
            _ if scale < 0.05 => break,
            _ => {}
        }
        scale *= -0.4;
    }
    Some(best)
}

#[cfg(test)]
mod tests {
    use super::*;

    const DESCENT: Descent = Descent { restarts: 12, iterations: 400, tolerance: 1e-11 };

    #[test]
    fn finds_a_constrained_minimum() {
        let cost = |p: &[f64]| (p[0] + p[1] >= 1.0).then(|| p[0] * p[0] + 2.0 * p[1] * p[1]);
        let (parameters, value) = minimise(&cost, &[3.0, 2.0], &[0.5, 0.5], DESCENT).unwrap();
        assert!((value - 2.0 / 3.0).abs() < 1e-4, "{value}");
        assert!((parameters[0] - 2.0 / 3.0).abs() < 1e-2);
    }

    #[test]
    fn an_infeasible_start_is_reported() {
        assert_eq!(minimise(&|_| None, &[0.0], &[1.0], DESCENT), None);
    }
}
