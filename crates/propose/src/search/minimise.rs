//! Local minimisation by the simplex method of Nelder and Mead (Computer Journal 7, 1965, 308-313), with their factors: 1 for the
//! reflection, 2 for the expansion, 1/2 for both contractions and for shrinking.

/// A point and its cost.
type Vertex = (Vec<f64>, f64);

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
    // A large finite cost keeps infeasible points out without spoiling the method's arithmetic.
    let bounded = |point: &[f64]| cost(point).filter(|cost| cost.is_finite()).unwrap_or(1e9);
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
        match nelder_mead(&bounded, simplex, descent) {
            found if found.1 < best.1 - least => best = found,
            found if found.1 < best.1 => {
                best = found;
                break;
            }
            _ if scale < 0.05 => break,
            _ => {}
        }
        scale *= -0.4;
    }
    Some(best)
}

/// The best vertex that the method reaches from a simplex.
fn nelder_mead(cost: &dyn Fn(&[f64]) -> f64, simplex: Vec<Vec<f64>>, descent: Descent) -> Vertex {
    let valued = |point: Vec<f64>| {
        let cost = cost(&point);
        (point, cost)
    };
    let mut simplex: Vec<Vertex> = simplex.into_iter().map(valued).collect();
    let last = simplex.len() - 1;
    simplex.sort_by(|a, b| a.1.total_cmp(&b.1));
    for _ in 0..descent.iterations {
        if deviation(&simplex) < descent.tolerance {
            break;
        }
        let centroid = centroid(&simplex[..last]);
        let at = |point: &[f64], factor: f64| valued(along(&centroid, point, factor));
        let (best, second, worst) = (simplex[0].1, simplex[last - 1].1, simplex[last].1);
        let reflected = at(&simplex[last].0, -1.0);
        let taken = if reflected.1 < best {
            let expanded = at(&reflected.0, 2.0);
            Some(if expanded.1 < reflected.1 { expanded } else { reflected })
        } else if reflected.1 < second {
            Some(reflected)
        } else if reflected.1 < worst {
            Some(at(&reflected.0, 0.5)).filter(|outside| outside.1 <= reflected.1)
        } else {
            Some(at(&simplex[last].0, 0.5)).filter(|inside| inside.1 < worst)
        };
        match taken {
            Some(vertex) => simplex[last] = vertex,
            None => {
                let (best, others) = simplex.split_at_mut(1);
                others.iter_mut().for_each(|vertex| *vertex = valued(along(&best[0].0, &vertex.0, 0.5)));
            }
        }
        // The order of equal costs is kept, so that every run takes the same points.
        simplex.sort_by(|a, b| a.1.total_cmp(&b.1));
    }
    simplex.swap_remove(0)
}

/// `from + factor (to - from)`
fn along(from: &[f64], to: &[f64], factor: f64) -> Vec<f64> {
    from.iter().zip(to).map(|(from, to)| from + (to - from) * factor).collect()
}

fn centroid(vertices: &[Vertex]) -> Vec<f64> {
    let share = 1.0 / vertices.len() as f64;
    (0..vertices[0].0.len()).map(|i| vertices.iter().map(|vertex| vertex.0[i]).sum::<f64>() * share).collect()
}

/// The standard deviation of the costs.
fn deviation(simplex: &[Vertex]) -> f64 {
    let count = simplex.len() as f64;
    let mean = simplex.iter().map(|vertex| vertex.1).sum::<f64>() / count;
    (1.0 / (count - 1.0) * simplex.iter().map(|vertex| (vertex.1 - mean) * (vertex.1 - mean)).sum::<f64>()).sqrt()
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

    #[test]
    fn finds_the_end_of_the_valley_of_rosenbrock() {
        let cost = |p: &[f64]| Some(100.0 * (p[1] - p[0] * p[0]).powi(2) + (1.0 - p[0]).powi(2));
        let (parameters, value) = minimise(&cost, &[-1.2, 1.0], &[0.5, 0.5], DESCENT).unwrap();
        assert!(value < 1e-10, "{value}");
        assert!(parameters.iter().all(|p| (p - 1.0).abs() < 1e-4), "{parameters:?}");
    }

    #[test]
    fn finds_the_minimum_of_a_quadratic_in_three_dimensions() {
        let cost = |p: &[f64]| Some((p[0] - 1.0).powi(2) + 10.0 * (p[1] + 2.0).powi(2) + (p[2] - p[0]).powi(2) + 5.0);
        let (parameters, value) = minimise(&cost, &[0.0; 3], &[0.5; 3], DESCENT).unwrap();
        assert!((value - 5.0).abs() < 1e-9, "{value}");
        assert!(parameters.iter().zip([1.0, -2.0, 1.0]).all(|(p, exact)| (p - exact).abs() < 1e-4), "{parameters:?}");
    }

    #[test]
    fn finds_a_minimum_in_one_dimension() {
        let (parameters, value) = minimise(&|p| Some((p[0] - 3.0).powi(4) - 2.0), &[0.0], &[0.25], DESCENT).unwrap();
        assert!((value + 2.0).abs() < 1e-10, "{value}");
        assert!((parameters[0] - 3.0).abs() < 1e-2, "{parameters:?}");
    }

    /// 1/x + 1/y + x + y, infinite where x or y is not positive: the minimum is 4 at (1, 1).
    #[test]
    fn stays_where_the_cost_is_finite() {
        let cost = |p: &[f64]| {
            let inside = p.iter().all(|x| *x > 0.0);
            Some(if inside { p.iter().map(|x| x + 1.0 / x).sum() } else { f64::INFINITY })
        };
        let (parameters, value) = minimise(&cost, &[0.05, 4.0], &[-0.5, -5.0], DESCENT).unwrap();
        assert!((value - 4.0).abs() < 1e-9, "{value}");
        assert!(parameters.iter().all(|p| (p - 1.0).abs() < 1e-4), "{parameters:?}");
    }

    /// The points of a minimisation in one dimension, without restarts.
    fn points(cost: fn(f64) -> f64, start: f64, step: f64, iterations: u64) -> Vec<f64> {
        let points = std::cell::RefCell::new(Vec::new());
        let recorded = |p: &[f64]| {
            points.borrow_mut().push(p[0]);
            Some(cost(p[0]))
        };
        minimise(&recorded, &[start], &[step], Descent { restarts: 0, iterations, tolerance: 0.0 });
        points.into_inner()
    }

    /// By hand: two expansions, a contraction outside, two inside; then the iterations are used up.
    #[test]
    fn takes_the_points_of_the_method() {
        let taken = points(|x| x * x, 8.0, 1.0, 5);
        assert_eq!(taken, [8.0, 8.0, 9.0, 7.0, 6.0, 4.0, 2.0, -2.0, 0.0, -2.0, 1.0, -1.0, 0.5]);
    }

    #[test]
    fn shrinks_where_no_trial_is_better() {
        let isolated = |x: f64| [(0.0, 0.0), (2.0, 1.0)].iter().find(|(at, _)| *at == x).map_or(5.0, |(_, cost)| *cost);
        assert_eq!(points(isolated, 0.0, 2.0, 1), [0.0, 0.0, 2.0, -2.0, 1.0, 1.0]);
    }
}
