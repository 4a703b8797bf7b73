//! C5 together with the level condition C4, as one semidefinite program in (w_x, h, sigma, l_x, l_e, l_f).

use super::decay::DecayData;
use super::propose::{MARGIN, Scale};
use rug::Rational;
use sigmastar_matrix::AffineMatrix;
use sigmastar_propose::semidefinite::{SolverFailure, propose};

/// The numbers of C4, `w_x P_up dX^2 + dE^2 + h dZ^2 < min{w_x P_low D_x^2, D_e^2}`, in doubles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelData {
    /// P_up dX^2, dE^2, dZ^2: what the initial set takes.
    pub start: [f64; 3],
    /// P_low D_x^2, D_e^2: what the error box allows.
    pub exit: [f64; 2],
}

/// Weights of the Lyapunov function, and the gain they seem to need.
#[derive(Clone, Debug, PartialEq)]
pub struct WeightsProposal {
    /// w_x.
    pub w_x: f64,
    /// h.
    pub h: f64,
    /// sigma, in 1/time.
    pub sigma: f64,
    /// The solver's own words, where it stopped short of its tolerance.
    pub remark: Option<String>,
}

/// The unknowns (w_x, h) as `centre + units * y`: w_x about its value in the data, on the scale on which C4 feels it.
///
/// With rho near 1 almost all of the level is w_x P_up dX^2, and C4 leaves w_x a relative width of rho^2 - 1 only.
struct Shift {
    centre: f64,
    units: [f64; 2],
}

impl Shift {
    fn new(data: &DecayData, level: &LevelData) -> Shift {
        let [start_x, start_e, start_z] = level.start;
        let [w_x, h] = [data.w_x.to_f64(), data.h.to_f64()];
        Shift { centre: w_x, units: [w_x.min((start_e + h * start_z) / start_x), h] }
    }
}

impl LevelData {
    /// The two inequalities of C4 in units of dE^2 + h dZ^2, as matrices of order 1, affine in y.
    fn constraints(&self, shift: &Shift, variables: usize) -> [AffineMatrix<f64>; 2] {
        let [start_x, start_e, start_z] = self.start;
        let [exit_x, exit_e] = self.exit;
        let unit = start_e + shift.units[1] * start_z;
        let scalar = |constant: f64, w_x: f64, h: f64| {
            let coefficient = |variable: usize| match variable {
                0 => w_x * shift.units[0] / unit,
                1 => h * shift.units[1] / unit,
                _ => 0.0,
            };
            let constant = (constant + w_x * shift.centre) / unit;
            AffineMatrix::from_fn(1, variables, |_, _| constant, |variable, _, _| coefficient(variable))
        };
        [scalar(-start_e, exit_x - start_x, -start_z), scalar(exit_e - start_e, -start_x, -start_z)]
    }
}

/// The smallest sigma that C4 and C5 allow in one error box, with w_x and h free; those of `data` only give the scale.
///
/// Guarantee: none, a proposal. Where mu is not exactly known its lower bound is taken.
///
/// # Errors
/// What the solver did instead of solving; [`SolverFailure::Unusable`] as for [`super::propose_sigma`], and
/// [`SolverFailure::Infeasible`] where the solver finds no w_x, h with both conditions for any sigma.
pub fn propose_lyapunov_weights(data: &DecayData, level: &LevelData) -> Result<WeightsProposal, SolverFailure> {
    let mut data = data.clone();
    let mut rescalings = 0;
    loop {
        let (found, expected) = solve(&data, level)?;
        // The solver's accuracy is relative to the scale: where the answer lies far below it, once more from there.
        if found.sigma > 0.1 * expected || rescalings == RESCALINGS {
            return Ok(found);
        }
        rescalings += 1;
        let exact = Rational::from_f64(found.w_x).zip(Rational::from_f64(found.h)).ok_or(SolverFailure::Unusable)?;
        (data.w_x, data.h) = exact;
    }
}

/// How often the problem is scaled anew, at most.
const RESCALINGS: usize = 8;

/// One call of the solver, and the sigma that the scale expects.
fn solve(data: &DecayData, level: &LevelData) -> Result<(WeightsProposal, f64), SolverFailure> {
    let scale = Scale::new(data, None)?;
    let shift = Shift::new(data, level);
    let units: Vec<f64> = shift.units.iter().chain(&scale.units).copied().collect();
    let matrix = data.matrix_in_weights(&data.mu[0]).about(std::slice::from_ref(&data.w_x));
    let mut constraints = vec![matrix.scaled(&scale.roots, &units).with_margin(MARGIN)];
    constraints.extend(level.constraints(&shift, units.len()));
    let mut cost = vec![0.0; units.len()];
    // Minimise sigma in units of its expected value.
    cost[2] = 1.0;
    let found = propose(&cost, &constraints)?;
    let at = |index: usize| found.x[index] * units[index];
    let proposal = WeightsProposal { w_x: shift.centre + at(0), h: at(1), sigma: at(2), remark: found.remark };
    Ok((proposal, units[2]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// k_x = k_e = 0, alpha - gam = P_up = mu = k_f = 1: sigma > 1/(4 h) + w_x/4.
    fn without_u() -> DecayData {
        let one = || Rational::from(1);
        DecayData {
            w_x: one(),
            h: one(),
            mu: [one(), one()],
            rate: one(),
            root_p_up: one(),
            k_x: Rational::new(),
            sector: [Rational::new(), Rational::new()],
            k_f: one(),
        }
    }

    /// C4: w_x + 1 + h < min{4 w_x, 5}. On w_x = (1 + h)/3 sigma is 1/(4 h) + (1 + h)/12, least at h = root of 3,
    /// where the second member, w_x + 1 + h < 5, does not bind.
    #[test]
    fn a_case_by_hand() {
        let level = LevelData { start: [1.0, 1.0, 1.0], exit: [4.0, 5.0] };
        let found = propose_lyapunov_weights(&without_u(), &level).expect("solved");
        let h = 3f64.sqrt();
        let expected = [(1.0 + h) / 3.0, h, 1.0 / (4.0 * h) + (1.0 + h) / 12.0];
        for (value, expected, tolerance) in
            [(found.w_x, expected[0], 1e-3), (found.h, expected[1], 1e-3), (found.sigma, expected[2], 1e-6)]
        {
            assert!((value / expected - 1.0).abs() <= tolerance, "{found:?}");
        }
    }

    /// With D_e^2 = 3 the second member binds: h = 5/4, w_x = 3/4.
    #[test]
    fn both_members_bind() {
        let level = LevelData { start: [1.0, 1.0, 1.0], exit: [4.0, 3.0] };
        let found = propose_lyapunov_weights(&without_u(), &level).expect("solved");
        for (value, expected) in [(found.w_x, 0.75), (found.h, 1.25), (found.sigma, 0.2 + 0.1875)] {
            assert!((value / expected - 1.0).abs() <= 1e-6, "{found:?}");
        }
    }

    #[test]
    fn a_box_that_is_too_small_has_no_weights() {
        for exit in [[1.0, 5.0], [0.5, 5.0], [4.0, 1.0], [4.0, 0.5]] {
            let level = LevelData { start: [1.0, 1.0, 1.0], exit };
            assert_eq!(propose_lyapunov_weights(&without_u(), &level), Err(SolverFailure::Infeasible), "{exit:?}");
        }
        let level = LevelData { start: [1.0, 1.0, f64::NAN], exit: [4.0, 5.0] };
        assert_eq!(propose_lyapunov_weights(&without_u(), &level), Err(SolverFailure::Unusable));
    }
}
