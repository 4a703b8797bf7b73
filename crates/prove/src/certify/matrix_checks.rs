//! What the matrix inequalities say about a run: C5 as a semidefinite program beside its closed form, the contraction matrix
//! with weights and as a Stein inequality; and Sylvester's criterion for R of the repaired derivation.

use crate::lmi::{CrossCheck, CrossCheckError, contraction, cross_check};
use rug::Rational;
use sigmastar_decide::conditions::{RepairedProof, SharpProof};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_f64, round_rational};
use sigmastar_lang::spec::model::Specification;
use sigmastar_matrix::leading_minors;
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::contraction::ContractionMatrix;

/// The checks of a run.
#[derive(Clone, Debug, Default)]
pub struct MatrixChecks {
    /// C5 as a matrix inequality, for a proof of the sharp derivation.
    pub decay: Option<Result<CrossCheck, CrossCheckError>>,
    /// The contraction matrix, for a proof of the sharp derivation: where its spectral radius is below 1 the periodic solution is
    /// the only one in its set.
    pub contraction: Option<ContractionCheck>,
}

/// The spectral radius at upper ends of the contraction matrix.
#[derive(Clone, Debug)]
pub struct ContractionCheck {
    /// Bounds of the spectral radius of the matrix of upper ends, from Perron weights; the
    /// upper one bounds that of the contraction matrix.
    pub spectral_radius: [Rational; 2],
    /// The diagonal of D with `D - M' D M > 0` proved exactly, where the solver found one.
    pub stein: Option<Vec<Rational>>,
}

/// R at its worst within the enclosures, with its leading minors, exactly.
#[derive(Clone, Debug)]
pub struct SylvesterCheck {
    /// The rows: diagonal entries rounded down, the magnitudes of the others up, so that R is positive definite if this is.
    pub rows: Vec<Vec<Rational>>,
    /// The leading minors, up to the first that is not positive.
    pub minors: Vec<Rational>,
}

impl SylvesterCheck {
    /// Whether R is proved to be positive definite.
    #[must_use]
    pub fn is_positive_definite(&self) -> bool {
        self.minors.len() == 3 && self.minors.iter().all(|minor| *minor > 0)
    }

    /// R = [[2(alpha P_low - rho_11), -rho_12, 0], [., 2(sigma - rho_22), -mu], [., ., mu h]]. Its determinants are those of a
    /// tridiagonal matrix: while it is positive definite they increase with the diagonal and decrease with the magnitudes beside.
    pub(super) fn new(spec: &Specification, proof: &RepairedProof) -> Option<SylvesterCheck> {
        let data = Data::new(spec, proof.precision);
        let (matrix, h) = (&proof.evaluation.lyapunov, &proof.evaluation.point.h);
        let down = |value: &Enclosure| Some(round_rational(&value.lower_rational()?, 10, Direction::Down));
        let beside = |value: &Enclosure| Some(-round_rational(&value.abs().upper_rational()?, 10, Direction::Up));
        let diagonal = [&matrix.curvature * 2, (&proof.evaluation.sigma - &matrix.rho_22) * 2, &data.mu * h];
        let [first, second, third] = diagonal.each_ref().map(down);
        let (upper, lower) = (beside(&matrix.rho_12)?, beside(&data.mu)?);
        let zero = Rational::new;
        let rows =
            vec![vec![first?, upper.clone(), zero()], vec![upper, second?, lower.clone()], vec![zero(), lower, third?]];
        Some(SylvesterCheck { minors: leading_minors(&rows), rows })
    }
}

impl MatrixChecks {
    /// Works them out for the proof of a run.
    #[must_use]
    pub fn new(spec: &Specification, sharp: Option<&SharpProof>) -> MatrixChecks {
        MatrixChecks {
            // With a matrix inequality of its own C5 is not asked for. With an input gain it contains sigma in another way than the program.
            decay: sharp
                .filter(|proof| proof.evaluation.by_matrix.is_none())
                .map(|proof| (proof, Data::new(spec, proof.precision)))
                .filter(|(_, data)| data.input_gain.is_none())
                .map(|(proof, data)| cross_check(&proof.evaluation, &proof.witness, &data)),
            contraction: sharp.and_then(contraction),
        }
    }

    /// Whether the two figures for C5 are both there and differ by more than the solver's tolerance can explain: then one
    /// of the two is wrong, and nothing may be claimed.
    #[must_use]
    pub fn disagree(&self) -> bool {
        matches!(&self.decay, Some(Ok(check)) if check.contradicts())
    }
}

fn contraction(proof: &SharpProof) -> Option<ContractionCheck> {
    let matrix = &proof.evaluation.contraction;
    let upper = |entry: &Enclosure| Some(round_rational(&entry.upper_rational()?, 12, Direction::Up));
    // The weights of C3 belong to the transpose.
    let rows = vec![vec![upper(&matrix.xx)?, upper(&matrix.ex)?], vec![upper(&matrix.xe)?, upper(&matrix.ee)?]];
    let [x, e] = [&proof.witness.x_p, &proof.witness.e_p].map(|size| size.to_f64().recip());
    let entries = [&matrix.xx, &matrix.xe, &matrix.ex, &matrix.ee].map(Enclosure::midpoint_f64);
    let [xx, xe, ex, ee] = entries;
    let weights = ContractionMatrix { xx, xe, ex, ee }.perron_weights(&x, &e);
    let largest = weights[0].max(weights[1]);
    let [first, second] = weights.map(|weight| round_f64(weight / largest, 14, Direction::Nearest));
    let weights = [first?, second?];
    let spectral_radius = contraction::spectral_radius(&rows, &weights)?;
    let stein = contraction::propose_stein(&rows).ok().filter(|d| contraction::stein_holds(&rows, d));
    Some(ContractionCheck { spectral_radius, stein })
}
