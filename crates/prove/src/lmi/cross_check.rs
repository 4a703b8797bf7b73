//! The matrix inequality of C5 against its closed form, on a certificate.

use super::decay::{DecayData, verify_decay};
use super::level::{LevelData, propose_lyapunov_weights};
use super::propose::{propose_multipliers, propose_sigma, two_sided_threshold};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_propose::semidefinite::SolverFailure;
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::initial_set::claimed_distances;
use sigmastar_theory::derivation::sharp::{SharpEvaluation, SharpWitness};
use sigmastar_theory::derivation::stability::DecayCondition;
use thiserror::Error;

/// Two independent answers to the same question, twice: for the weights of the certificate, and for the best ones in its box.
#[derive(Clone, Debug)]
pub struct CrossCheck {
    /// The smallest sigma for the certificate's w_x and h.
    pub fixed: SigmaBothWays,
    /// The smallest sigma for any w_x and h that satisfy C4 in the certificate's error box, and the closed form for these.
    pub free: Result<SigmaBothWays, SolverFailure>,
    /// Multipliers (l_x, l_e, l_f) with which the matrix at the witness's sigma is proved positive definite, where they were
    /// found: C5 then holds by the matrix inequality too, whatever the closed form says.
    pub multipliers: Option<[Rational; 3]>,
}

/// The smallest sigma with C5, in two ways.
#[derive(Clone, Debug)]
pub struct SigmaBothWays {
    /// The threshold of sigma by the closed form, rigorously for the w_x, h at hand.
    pub closed_form: Enclosure,
    /// The smallest sigma of the matrix inequality, by the solver.
    pub solver_sigma: f64,
    /// The size of what adds up to the threshold: that of the threshold itself, or for a one-sided dq/de, where most of it may
    /// cancel, that of the threshold without damping told apart. No solver sees a difference much smaller than this.
    pub scale: f64,
    /// |solver_sigma - closed_form| / scale, in floating point; NaN where there is no threshold.
    pub relative_difference: f64,
    /// The solver's own words, where it stopped short of its tolerance.
    pub remark: Option<String>,
}

/// The largest relative difference that the solver's tolerance explains; on trial data over many orders of magnitude it
/// stays below 1e-6.
pub const AGREEMENT: f64 = 1e-5;

impl SigmaBothWays {
    fn new(closed_form: Enclosure, solver_sigma: f64, two_sided: f64, remark: Option<String>) -> SigmaBothWays {
        let threshold = closed_form.midpoint_f64();
        let scale = if two_sided > threshold { two_sided } else { threshold };
        let relative_difference = ((solver_sigma - threshold) / scale).abs();
        SigmaBothWays { scale, relative_difference, closed_form, solver_sigma, remark }
    }

    /// Whether the two agree to the solver's tolerance.
    #[must_use]
    pub fn agree(&self) -> bool {
        self.relative_difference <= AGREEMENT
    }
}

impl CrossCheck {
    /// Whether one of the two is wrong by more than a solver that reached its tolerance explains:
    ///
    /// | weights     | a contradiction is                                                                      |
    /// |-------------|-----------------------------------------------------------------------------------------|
    /// | fixed       | a smallest sigma other than that of the closed form                                     |
    /// | best        | a sigma below what the closed form needs for these weights (above it, weights are spent) |
    /// | best, fixed | best weights that need a larger sigma than those of the certificate                     |
    #[must_use]
    pub fn contradicts(&self) -> bool {
        (self.fixed.remark.is_none() && !self.fixed.agree()) || self.free_contradicts()
    }

    /// Whether the last two lines of that table say so.
    #[must_use]
    pub fn free_contradicts(&self) -> bool {
        let largest = self.fixed.closed_form.upper_f64() + self.fixed.scale * AGREEMENT;
        self.free.as_ref().is_ok_and(|free| {
            let possible = free.solver_sigma >= free.closed_form.lower_f64() - free.scale * AGREEMENT;
            free.remark.is_none() && !(possible && free.solver_sigma <= largest)
        })
    }
}

/// Why there is nothing to compare.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum CrossCheckError {
    /// C5 has no bounded data or no threshold for this witness.
    #[error("C5 has no bounded data for this witness")]
    Unbounded,
    /// The solver has no answer.
    #[error(transparent)]
    Solver(#[from] SolverFailure),
}

/// Holds the matrix inequality of C5 against the closed form, for the numbers of an evaluated witness, and C4 with C5 as one
/// program in (w_x, h, sigma, l_x, l_e, l_f) against the closed form at the w_x, h that it finds.
///
/// Guarantee: what `multipliers` prove is proved in exact arithmetic. The solver's figures and the differences are floating
/// point: a large difference points to an error in one of the two, a small one proves nothing.
///
/// # Errors
/// Data without bounds, and a solver without an answer for the weights of the witness.
pub fn cross_check(
    evaluation: &SharpEvaluation,
    witness: &SharpWitness,
    data: &Data<'_>,
) -> Result<CrossCheck, CrossCheckError> {
    let closed_form = evaluation.decay.sigma_threshold.clone();
    let decay =
        DecayData::new(data, &evaluation.error_box, &witness.w_x, &witness.h).ok_or(CrossCheckError::Unbounded)?;
    if !closed_form.is_bounded() {
        return Err(CrossCheckError::Unbounded);
    }
    let smallest = propose_sigma(&decay)?;
    let at_sigma = propose_multipliers(&decay, &witness.sigma)?;
    let proves = |multipliers: &[Rational; 3]| verify_decay(&decay, &witness.sigma, multipliers);
    // Short numbers where they do, the solver's own doubles otherwise.
    let short = at_sigma.multipliers.map(|value| round_f64(value, 9, Direction::Nearest));
    let [l_x, l_e, l_f] = short;
    let short = l_x.zip(l_e).zip(l_f).map(|((l_x, l_e), l_f)| [l_x, l_e, l_f]);
    let multipliers = short.filter(proves).or_else(|| at_sigma.exact_multipliers().filter(proves));
    Ok(CrossCheck {
        fixed: SigmaBothWays::new(closed_form, smallest.sigma, two_sided_threshold(&decay), smallest.remark),
        free: best_weights(evaluation, witness, data, &decay),
        multipliers,
    })
}

/// The program with C4, and the closed form at the weights that it finds.
fn best_weights(
    evaluation: &SharpEvaluation,
    witness: &SharpWitness,
    data: &Data<'_>,
    decay: &DecayData,
) -> Result<SigmaBothWays, SolverFailure> {
    let periodic = [&evaluation.periodic.x_per, &evaluation.periodic.e_per, &evaluation.z];
    let [dist_x, dist_e, dist_z] = claimed_distances(data, &witness.set, periodic).map(|distance| distance.upper_f64());
    let (p_low, p_up) = (data.p_low.midpoint_f64(), data.p_up.midpoint_f64());
    let (d_x, d_e) = (witness.d_x.to_f64(), witness.d_e.to_f64());
    let level = LevelData {
        start: [p_up * dist_x * dist_x, dist_e * dist_e, dist_z * dist_z],
        exit: [p_low * d_x * d_x, d_e * d_e],
    };
    let found = propose_lyapunov_weights(decay, &level)?;
    let weight =
        |value: f64| Rational::from_f64(value).map(|value| data.rational(&value)).ok_or(SolverFailure::Unusable);
    let (w_x, h) = (weight(found.w_x)?, weight(found.h)?);
    let closed_form = DecayCondition::new(data, &evaluation.error_box, [&w_x, &h], &evaluation.sigma);
    let exact = |value: f64| Rational::from_f64(value).ok_or(SolverFailure::Unusable);
    let there = DecayData { w_x: exact(found.w_x)?, h: exact(found.h)?, ..decay.clone() };
    Ok(SigmaBothWays::new(closed_form.sigma_threshold, found.sigma, two_sided_threshold(&there), found.remark))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figures(closed_form: i64, solver_sigma: f64, remark: Option<&str>) -> SigmaBothWays {
        SigmaBothWays::new(Enclosure::from_integer(closed_form, 64), solver_sigma, 0.0, remark.map(str::to_owned))
    }

    #[test]
    fn a_difference_that_the_tolerance_does_not_explain_is_a_contradiction() {
        let check = |fixed: SigmaBothWays, free: Result<SigmaBothWays, SolverFailure>| {
            CrossCheck { fixed, free, multipliers: None }.contradicts()
        };
        let good = || figures(10, 10.000_01, None);
        assert!(!check(good(), Ok(good())));
        assert!(!check(good(), Err(SolverFailure::Infeasible)));
        assert!(check(figures(10, 10.001, None), Ok(good())));
        assert!(check(figures(10, 9.999, None), Ok(good())));
        assert!(check(good(), Ok(figures(10, 9.999, None))));
        assert!(check(figures(10, f64::NAN, None), Ok(good())));
        // A solver that stopped early contradicts nothing.
        assert!(!check(figures(10, 10.001, Some("AlmostSolved")), Ok(good())));
        assert!(!check(good(), Ok(figures(12, 13.0, Some("AlmostSolved")))));
        // The best weights cannot need more than those of the certificate; they may need less.
        assert!(check(good(), Ok(figures(11, 11.0, None))));
        assert!(!check(good(), Ok(figures(9, 9.0, None))));
        // A difference below what the solver sees of numbers that cancel.
        let cancelled = |found| SigmaBothWays::new(Enclosure::from_integer(10, 64), found, 1e6, None);
        assert!(!check(cancelled(10.5), Ok(cancelled(10.5))) && check(cancelled(21.0), Ok(good())));
        // What it finds for them need not be the smallest.
        assert!(!check(good(), Ok(figures(9, 9.1, None))));
        assert!(check(good(), Ok(figures(9, f64::NAN, None))));
    }
}
