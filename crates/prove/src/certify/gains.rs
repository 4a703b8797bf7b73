//! What larger gains bring (derivation, 13.5): bounds at multiples of the gain of a claim.

use super::best::model;
use super::bounding::prove_up_to;
use super::certification::Certification;
use super::gain_row::{GainRow, RowProof, SHOWN_N_O};
use super::options::Ladder;
use super::proof::{SampledProof, SharpProof};
use super::round::{TransferKind, round_again};
use super::sampled::{SampledCertification, certify_sampled};
use crate::search::{FloatModel, Goal, SampledProposal, SharpProposal, search_sharp_at};
use rug::Rational;
use sigmastar_exact::number::{Direction, round_rational};
use sigmastar_exact::parallel;
use sigmastar_lang::spec::Specification;
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::consequences::error_bounds;
use sigmastar_theory::derivation::mistuned::Mistuning;
use std::sync::Arc;

/// The gains, in tenths of that of the claim.
const TENTHS: [u32; 5] = [12, 15, 20, 30, 50];

/// So many tenths of a gain.
fn larger(tenths: u32, sigma: &Rational) -> Rational {
    round_rational(&(Rational::from((tenths, 10)) * sigma), 6, Direction::Up)
}

/// The row of a proof.
fn row_of(spec: &Specification, proof: SharpProof, other: Option<Arc<Specification>>) -> GainRow {
    let data = Data::new(spec, proof.precision);
    let (evaluation, mistuning) = (&proof.evaluation, Mistuning::new(&data));
    let sigma = data.rational(&proof.witness.sigma);
    let e_per = &evaluation.periodic.e_per;
    let sup = |n_o| error_bounds(&data, &evaluation.excitation, mistuning.as_ref(), &sigma, e_per, n_o).sup;
    GainRow {
        sigma: proof.witness.sigma.clone(),
        e0: proof.witness.set.e0.clone(),
        steady: SHOWN_N_O.map(sup).into(),
        peak: evaluation.peak.clone(),
        control: evaluation.control.clone(),
        rates: Vec::new(),
        proof: RowProof::Continuous(Box::new(proof), other),
    }
}

/// The rows of larger gains than that of a claim; one at which nothing is proved from near `start` has none. The error boxes are those with the
/// smallest bound of |e| that are found.
///
/// `spec` has the data of the claim, or others of the same plant, which the rows then keep.
fn gain_rows(
    spec: &Specification,
    proof: &SharpProof,
    (model, start): (&FloatModel, &SharpProposal),
    other: Option<&Arc<Specification>>,
) -> Vec<GainRow> {
    let model = model.with_goal(Goal::Peak);
    let reach = proof.decided().reach();
    let row = |tenths: &u32| {
        let sigma = larger(*tenths, &proof.witness.sigma);
        let found = search_sharp_at(&model, sigma.to_f64(), Some(start)).ok()?;
        let (k0, k1) = (proof.witness.k0.clone(), proof.witness.k1.clone());
        let pair = (k0, k1, proof.witness.transfer.clone());
        let data = Data::new(spec, proof.precision);
        let ladder = Ladder { start: proof.precision, limit: proof.precision };
        let proof = round_again(&data, &model, (&found, &sigma), pair, ladder)?;
        // The data of the claim are proved on a domain, or up to the arguments that it uses.
        let [x, e] = proof.decided().reach()?;
        let within = reach.as_ref().is_some_and(|[known_x, known_e]| x <= *known_x && e <= *known_e);
        let known = spec.domain.is_some() || spec.plant().is_some() || within || prove_up_to(spec, &x, &e).is_ok();
        known.then(|| row_of(spec, proof, other.cloned()))
    };
    parallel::map(&TENTHS, row).into_iter().flatten().collect()
}

impl Certification<'_> {
    /// The rows of a run that is certified without an actuator; of one with an actuator nothing is said of another gain.
    pub(super) fn set_gains(&mut self, model: &FloatModel, start: &SharpProposal) {
        let Some(proof) = self.sharp.proved().filter(|_| self.claim().is_some() && self.spec.actuator.is_none()) else {
            return;
        };
        let mut rows = vec![row_of(self.spec, proof.clone(), None)];
        rows.extend(gain_rows(self.spec, proof, (model, start), None));
        self.gains = rows;
    }

    /// Whether the bound of |e| on the way at the gain of the claim is far above what it is at the start.
    #[must_use]
    pub fn goes_far(&self) -> bool {
        self.gains.first().is_some_and(GainRow::goes_far)
    }

    /// The rows with those of other data of the same plant, in their place where |e| stays smaller. Hypothesis: in the same
    /// coordinates, where the set is stated in them.
    pub fn with_gains_of(&mut self, spec: &Specification, start: &SharpProposal) {
        let Some(proof) = self.sharp.proved().filter(|_| !self.gains.is_empty()) else { return };
        let model = model(&Data::new(spec, proof.precision), TransferKind::of(&proof.witness.transfer));
        let other = Arc::new(spec.clone());
        for row in gain_rows(spec, proof, (&model, start), Some(&other)) {
            match self.gains.iter_mut().find(|known| known.sigma == row.sigma) {
                Some(known) if row.peak.lt(&known.peak).is_true() => *known = row,
                Some(_) => {}
                None => self.gains.push(row),
            }
        }
        self.gains.sort_by(|a, b| a.sigma.cmp(&b.sigma));
    }
}

impl SampledCertification<'_> {
    /// The rows at the gain of the claim and at larger ones, at the same samples: what a call with that gain certifies. Without a claim, and with an
    /// actuator, there are none.
    pub(crate) fn set_gains(&mut self, start: Option<&SampledProposal>, ladder: Ladder) {
        let Some(proof) = self.claim().filter(|_| self.spec.actuator.is_none()) else { return };
        let row = |proof: &SampledProof| GainRow {
            sigma: proof.witness.sigma.clone(),
            e0: proof.witness.set.e0.clone(),
            steady: vec![proof.evaluation.size.e_per.clone()],
            peak: proof.evaluation.peak.clone(),
            control: proof.evaluation.control.clone(),
            rates: Vec::new(),
            proof: RowProof::Sampled(Box::new(proof.clone())),
        };
        let at = |tenths: &u32| {
            let sigma = larger(*tenths, &proof.witness.sigma);
            let run = certify_sampled(self.spec, &self.sampling, Some(&sigma), start, ladder).ok()?;
            run.claim().map(row)
        };
        let more: Vec<GainRow> = parallel::map(&TENTHS, at).into_iter().flatten().collect();
        self.gains = std::iter::once(row(proof)).chain(more).collect();
    }
}
