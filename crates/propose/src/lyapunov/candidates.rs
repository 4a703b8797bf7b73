//! Candidates for a Jacobian: from the largest rate that was found down to the smallest ratio p_up/p_low.

use super::float::FloatFamily;
use super::propose::{fourier, lyapunov_samples, program_cost, smallest_ratio};
use faer::Mat;
use rug::Rational;
use sigmastar_exact::enclosure::DEFAULT_PRECISION;
use sigmastar_exact::number::{Direction, in_digits, round_f64};
use sigmastar_lang::spec::Period;
use sigmastar_lang::spec::model::{Jacobian, PeriodicMatrix};
use sigmastar_theory::jacobian::{Family, is_provable};
use thiserror::Error;

/// What was found for a Jacobian, in floating point; nothing is claimed of them.
pub struct Candidates {
    /// Candidates, the largest rate first; not empty. As [`candidates`] gives them, none has both a smaller rate and a larger
    /// ratio than another; [`Candidates::beside`] finds more.
    pub found: Vec<Candidate>,
    /// The Floquet exponents of the middle of the Jacobian, (real, imaginary) in 1/time, the largest real part first:
    /// floating point, certified by nothing. Minus the first real part bounds every rate that can be proved.
    pub floquet: Vec<[f64; 2]>,
    /// What the semidefinite programs cost, of [`MAX_PROGRAM_COST`]; those of [`Candidates::beside`] a quarter of it more at
    /// most.
    pub cost: u64,
    family: Family,
}

/// A P(t) with p_low = 1 and what it seems to give.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// P(t), exactly.
    pub matrix: PeriodicMatrix,
    /// The rate in floating point, in 1/time.
    pub alpha: f64,
    /// p_up/p_low in floating point.
    pub ratio: f64,
}

impl Candidates {
    /// The matrices that they are for.
    #[must_use]
    pub fn family(&self) -> &Family {
        &self.family
    }

    /// Further candidates of the same degree, with rates between that of a candidate and those of its neighbours; none where
    /// the semidefinite program of that degree is too large.
    #[must_use]
    pub fn beside(&self, index: usize) -> Vec<Candidate> {
        let Some(here) = self.found.get(index) else { return Vec::new() };
        let float = FloatFamily::new(&self.family);
        // Up to four programs.
        let affordable = |cost: u64| cost <= MAX_PROGRAM_COST / 16;
        if !program_cost(&float, here.matrix.harmonics.len()).is_some_and(affordable) {
            return Vec::new();
        }
        let neighbours = [index.checked_sub(1), index.checked_add(1)];
        let ends = neighbours.iter().flatten().filter_map(|at| self.found.get(*at)).map(|candidate| candidate.alpha);
        let rates = ends.flat_map(|end| [1.0, 2.0].map(|part| here.alpha + part / 3.0 * (end - here.alpha)));
        rates
            .filter_map(|alpha| smallest_ratio(&float, here.matrix.harmonics.len(), alpha))
            .filter_map(|proposal| rounded(&float, &proposal))
            .collect()
    }
}

/// Why there is no triple.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum LyapunovFailure {
    /// Floating point says that the middle of the Jacobian is not stable; not proved.
    #[error(
        "in floating point the middle of the Jacobian has the Floquet exponent {}, which is not negative: there is \
         no triple with alpha > 0",
        short(*exponent)
    )]
    NotStable {
        /// The largest real part, in 1/time.
        exponent: f64,
    },
    /// Numbers out of range.
    #[error("the Floquet exponents of the Jacobian cannot be computed in floating point")]
    NotFinite,
    /// Nothing that was proposed could be proved.
    #[error("no P(t) that was tried is proved for every matrix of the Jacobian; its middle has the rate {}", short(*rate))]
    NotFound {
        /// Minus the largest Floquet exponent of the middle, in 1/time.
        rate: f64,
    },
}

/// A number of a message, in few digits.
fn short(value: f64) -> String {
    in_digits(value, 6)
}

/// Shares of the largest rate at which the smallest ratio is sought.
const SHARES: [f64; 12] = [0.9998, 0.98, 0.94, 0.88, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1];

/// Degrees of P(t) that a semidefinite program is tried for, where F varies.
const DEGREES: [usize; 4] = [0, 1, 2, 4];

/// What all semidefinite programs for one Jacobian may cost together, in entries that their factorisations touch: some
/// seconds. Where less is left than `FEWEST_PROGRAMS` of a degree cost, that degree is left to the periodic Lyapunov equation.
pub const MAX_PROGRAM_COST: u64 = 150_000_000;
const FEWEST_PROGRAMS: u64 = 8;

/// Bisections for the largest rate of a degree.
const BISECTIONS: u64 = 12;

/// Degrees of P(t) that the periodic Lyapunov equation is cut off at.
const CUTS: [usize; 7] = [1, 2, 4, 8, 12, 16, 24];

/// Candidates for a Jacobian.
///
/// Guarantee: none; a better triple than all of them may exist.
///
/// # Errors
/// Nothing was found; nothing is claimed about there being nothing.
pub fn candidates(jacobian: &Jacobian, period: &Period) -> Result<Candidates, LyapunovFailure> {
    candidates_of(Family::new(jacobian, period, DEFAULT_PRECISION).ok_or(LyapunovFailure::NotFinite)?)
}

/// Candidates for a family of matrices, in the same way.
///
/// # Errors
/// Those of [`candidates`].
pub fn candidates_of(family: Family) -> Result<Candidates, LyapunovFailure> {
    let float = FloatFamily::new(&family);
    // Steps in time are counted by the norm.
    if !float.size.is_finite() {
        return Err(LyapunovFailure::NotFinite);
    }
    let floquet = float.floquet_exponents().ok_or(LyapunovFailure::NotFinite)?;
    let exponent = floquet.first().map_or(f64::NAN, |first| first[0]);
    if exponent.is_nan() || exponent >= 0.0 {
        return Err(LyapunovFailure::NotStable { exponent });
    }
    let limit = -exponent;
    let mut proposals = Vec::new();
    let (mut best, mut left) = (0.0, MAX_PROGRAM_COST);
    for degree in DEGREES.into_iter().take_while(|degree| float.degree() > 0 || *degree == 0) {
        let reached = by_programs(&float, degree, limit, &mut left, &mut proposals);
        // A higher degree is tried while it may reach a larger rate.
        best = f64::max(best, reached);
        if best > 0.97 * limit {
            break;
        }
    }
    by_equation(&float, limit, &mut proposals);
    let mut found: Vec<Candidate> = proposals.iter().filter_map(|p| rounded(&float, p)).collect();
    found.sort_by(|a, b| b.alpha.total_cmp(&a.alpha).then(a.ratio.total_cmp(&b.ratio)));
    let mut least = f64::INFINITY;
    found.retain(|candidate| {
        let better = candidate.ratio < least;
        least = least.min(candidate.ratio);
        better
    });
    let none = LyapunovFailure::NotFound { rate: limit };
    if found.is_empty() { Err(none) } else { Ok(Candidates { found, floquet, cost: MAX_PROGRAM_COST - left, family }) }
}

/// The Floquet exponents of the middle of a Jacobian as in [`Candidates::floquet`]; `None` if they cannot be computed.
#[must_use]
pub fn floquet_exponents(jacobian: &Jacobian, period: &Period) -> Option<Vec<[f64; 2]>> {
    FloatFamily::new(&Family::new(jacobian, period, DEFAULT_PRECISION)?).floquet_exponents()
}

/// Collects the P(t) of a degree with the smallest ratio at shares of the largest rate; returns the rate. With fewer
/// programs where not all can be paid for out of `left`.
fn by_programs(
    family: &FloatFamily,
    degree: usize,
    limit: f64,
    left: &mut u64,
    proposals: &mut Vec<Vec<Mat<f64>>>,
) -> f64 {
    let Some(cost) = program_cost(family, degree) else { return 0.0 };
    if !is_provable(family.order, degree + family.degree(), family.vertices.len()) {
        return 0.0;
    }
    let programs = (*left / cost).min(BISECTIONS + SHARES.len() as u64);
    if programs < FEWEST_PROGRAMS {
        return 0.0;
    }
    let bisections = programs / 2;
    let shares = (programs - bisections) as usize;
    let at = |alpha: f64| {
        let p = smallest_ratio(family, degree, alpha)?;
        let alpha = family.assess(&p)?.alpha;
        Some((p, alpha))
    };
    // The largest rate, by bisection on whether there is an answer.
    let (mut low, mut high) = (0.0, limit);
    for _ in 0..bisections {
        let middle = (low + high) / 2.0;
        *left -= cost;
        match at(middle) {
            Some(_) => low = middle,
            None => high = middle,
        }
    }
    if low == 0.0 {
        return 0.0;
    }
    *left -= shares as u64 * cost;
    // Fewer shares are spread over the same range.
    let chosen = (0..shares).map(|k| SHARES[k * SHARES.len() / shares]);
    proposals.extend(chosen.filter_map(|share| at(share * low)).map(|(p, _)| p));
    low
}

/// Collects the P(t) of the periodic Lyapunov equation, cut off where its rate is nearly reached.
fn by_equation(family: &FloatFamily, limit: f64, proposals: &mut Vec<Vec<Mat<f64>>>) {
    for share in [0.97, 0.9, 0.7, 0.4] {
        let Some(samples) = lyapunov_samples(family, share * limit) else { continue };
        if family.degree() == 0 {
            proposals.push(fourier(&samples[..1], 0));
            continue;
        }
        let reaches = |p: &Vec<Mat<f64>>| family.assess(p).is_some_and(|given| given.alpha >= 0.999 * share * limit);
        let degrees = CUTS
            .into_iter()
            .filter(|degree| is_provable(family.order, degree + family.degree(), family.vertices.len()));
        proposals.extend(degrees.map(|degree| fourier(&samples, degree)).find(reaches));
    }
}

/// Rounds a proposal to short decimals, with p_low = 1.
fn rounded(float: &FloatFamily, proposal: &[Mat<f64>]) -> Option<Candidate> {
    let given = float.assess(proposal)?;
    // Ten decimals next to an eigenvalue of 1: far below the room.
    const DECIMALS: f64 = 1e10;
    let n = float.order;
    let grain = |value: f64| (value / given.p_low * DECIMALS).round() / DECIMALS;
    let exact = |matrix: &Mat<f64>| -> Option<Vec<Vec<Rational>>> {
        (0..n)
            .map(|i| (0..n).map(|j| round_f64(grain(matrix[(i.min(j), i.max(j))]), 14, Direction::Nearest)).collect())
            .collect()
    };
    let (mean, waves) = proposal.split_first()?;
    let harmonics: Option<Vec<[Vec<Vec<Rational>>; 2]>> =
        waves.chunks(2).map(|pair| Some([exact(&pair[0])?, exact(&pair[1])?])).collect();
    let matrix = PeriodicMatrix { mean: exact(mean)?, harmonics: harmonics? };
    Some(Candidate { matrix, alpha: given.alpha, ratio: given.ratio() })
}
