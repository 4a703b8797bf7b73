//! Floating-point proposals for C5: the smallest sigma, and multipliers for a given sigma.

use super::decay::DecayData;
use rug::Rational;
use sigmastar_propose::semidefinite::{SolverFailure, propose};
use sigmastar_theory::derivation::stability::{DecayTerms, Sector};

/// What the solver proposes for C5.
#[derive(Clone, Debug, PartialEq)]
pub struct DecayProposal {
    /// sigma, in 1/time: proposed by [`propose_sigma`], given to [`propose_multipliers`].
    pub sigma: f64,
    /// (l_x, l_e, l_f), 0 for a signal that is not present.
    pub multipliers: [f64; 3],
    /// The smallest eigenvalue of the scaled matrix, in the solver's opinion.
    pub margin: f64,
    /// The solver's own words, where it stopped short of its tolerance.
    pub remark: Option<String>,
}

impl DecayProposal {
    /// The multipliers as the exact rationals that the doubles are; `None` if one is not finite.
    #[must_use]
    pub fn exact_multipliers(&self) -> Option<[Rational; 3]> {
        let [l_x, l_e, l_f] = self.multipliers.map(Rational::from_f64);
        Some([l_x?, l_e?, l_f?])
    }
}

/// The margin that the smallest sigma leaves in the scaled matrix: small against the six digits that are compared.
pub(super) const MARGIN: f64 = 1e-9;

/// The smallest sigma for which there are multipliers such that the scaled matrix is at least `MARGIN`.
///
/// Guarantee: none, a proposal. Where mu is not exactly known its lower bound is taken.
///
/// # Errors
/// What the solver did instead of solving; [`SolverFailure::Unusable`] where w_x, h, mu or alpha - gam is not positive, or a
/// number is out of range, in doubles.
pub fn propose_sigma(data: &DecayData) -> Result<DecayProposal, SolverFailure> {
    let scale = Scale::new(data, None)?;
    let matrix = data.matrix(&data.mu[0]).scaled(&scale.roots, &scale.units).with_margin(MARGIN);
    let mut cost = vec![0.0; scale.units.len()];
    // Minimise sigma in units of its expected value.
    cost[0] = 1.0;
    let found = propose(&cost, &[matrix])?;
    let multipliers = scale.multipliers(data, &found.x[1..]);
    Ok(DecayProposal { sigma: found.x[0] * scale.units[0], multipliers, margin: MARGIN, remark: found.remark })
}

/// The multipliers that make the smallest eigenvalue of the scaled matrix largest, for a given sigma.
///
/// Guarantee: none, a proposal; a margin below 0 suggests that there are no multipliers for this sigma. These multipliers
/// stand in the middle of the admissible ones, so that they survive rounding for a sigma just above the smallest, where
/// those of [`propose_sigma`] often do not.
///
/// # Errors
/// As for [`propose_sigma`].
pub fn propose_multipliers(data: &DecayData, sigma: &Rational) -> Result<DecayProposal, SolverFailure> {
    let scale = Scale::new(data, Some(sigma))?;
    let matrix = data.matrix(&data.mu[0]).substitute(std::slice::from_ref(sigma));
    let matrix = matrix.scaled(&scale.roots, &scale.units[1..]).minus_identity();
    let mut cost = vec![0.0; scale.units.len()];
    let last = cost.len() - 1;
    // Maximise the eigenvalue, the last unknown.
    cost[last] = -1.0;
    let found = propose(&cost, &[matrix])?;
    let multipliers = scale.multipliers(data, &found.x[..last]);
    Ok(DecayProposal { sigma: sigma.to_f64(), multipliers, margin: found.x[last], remark: found.remark })
}

/// The threshold of C5 in doubles with |dq/de| at most the larger end of the sector: no damping is told apart.
#[must_use]
pub fn two_sided_threshold(data: &DecayData) -> f64 {
    let [w_x, h, mu, rate] = [&data.w_x, &data.h, &data.mu[0], &data.rate].map(Rational::to_f64);
    let [p, k_x, k_f] = [&data.root_p_up, &data.k_x, &data.k_f].map(Rational::to_f64);
    let [below, above] = data.sector.each_ref().map(|end| end.to_f64().abs());
    let end = if below > above { below } else { above };
    let terms = DecayTerms::new([&w_x, &h], [&rate, &mu, &p], [&k_x, &k_f], &Sector { below: end, above: end });
    terms.threshold(terms.curvature - terms.coupling)
}

/// The scales of rows and unknowns for which the solution is expected to have ones on the diagonal.
pub(super) struct Scale {
    /// The root of the expected (positive part of the) diagonal entry, per row.
    pub(super) roots: Vec<f64>,
    /// The expected value of sigma and of the multipliers that are present.
    pub(super) units: Vec<f64>,
}

impl Scale {
    /// The closed form of C5 gives the scale. With p = sqrt(P_up), et = 1 and C the cross term of [`DecayTerms`], the worst
    /// signals are u_x = k_x xi, u_e = m (or both with the other sign, u_e = -k_l), phi = k_f, s = (1/ht - u)/(2 mu), and
    /// `xi = 2 C/(4A - ht k_x^2)`. They are the null vector of the matrix at the threshold, and its rows u_x, u_e, phi then
    /// give, with `w = D + ht k_x xi`: `l_x = w/(2 k_x xi)`, `l_e = w/(k_l + m)`, `l_f = w_x p xi/k_f`.
    ///
    /// Only the scale depends on this: the solver sees the whole matrix.
    pub(super) fn new(data: &DecayData, sigma: Option<&Rational>) -> Result<Scale, SolverFailure> {
        let [w_x, h, mu, rate] = [&data.w_x, &data.h, &data.mu[0], &data.rate].map(Rational::to_f64);
        let [p, k_x, k_f] = [&data.root_p_up, &data.k_x, &data.k_f].map(Rational::to_f64);
        let [below, above] = data.sector.each_ref().map(Rational::to_f64);
        let terms = DecayTerms::new([&w_x, &h], [&rate, &mu, &p], [&k_x, &k_f], &Sector { below, above });
        let DecayTerms { coupling, curvature, .. } = terms;
        // Where the closed form has no solution, the scale is that of a neighbour that has one.
        let margin = if coupling < curvature { curvature - coupling } else { coupling };
        let xi = 2.0 * terms.cross / margin;
        let sigma = sigma.map_or(terms.threshold(margin), Rational::to_f64);
        let worst = terms.worst + terms.h_over_mu * k_x * xi;
        let multipliers = [worst / (2.0 * k_x * xi), worst / (below + above), w_x * p * xi / k_f];
        let present = multipliers.into_iter().zip(data.present()).filter_map(|(unit, present)| present.then_some(unit));
        let units: Vec<f64> = std::iter::once(sigma).chain(present).collect();
        // The entry of et also has -2 c_0, the middle of the sector.
        let diagonal = [2.0 * w_x * rate, 2.0 * sigma + below - above, 2.0 * h * mu]
            .into_iter()
            .chain(units.iter().skip(1).copied());
        let roots: Vec<f64> = diagonal.map(f64::sqrt).collect();
        let usable = |value: &f64| value.is_finite() && *value > 0.0;
        if roots.iter().chain(&units).all(usable) { Ok(Scale { roots, units }) } else { Err(SolverFailure::Unusable) }
    }

    /// The multipliers in their own units, with 0 for the signals that are not present.
    fn multipliers(&self, data: &DecayData, solution: &[f64]) -> [f64; 3] {
        let mut scaled = solution.iter().zip(&self.units[1..]).map(|(value, unit)| value * unit);
        data.present().map(|present| if present { scaled.next().unwrap_or(f64::NAN) } else { 0.0 })
    }
}
