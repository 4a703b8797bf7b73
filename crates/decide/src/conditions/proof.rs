//! A witness with what was decided about it, in the sharp or the repaired derivation or at samples; one view of both derivations in
//! continuous time.

use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::condition::{self, Condition};
use sigmastar_theory::derivation::exact_regulation::ExactWitness;
use sigmastar_theory::derivation::initial_set::ClaimedSet;
use sigmastar_theory::derivation::repaired::{RepairedEvaluation, RepairedWitness};
use sigmastar_theory::derivation::sampled::{SampledEvaluation, SampledWitness};
use sigmastar_theory::derivation::sharp::{SharpEvaluation, SharpWitness};
use sigmastar_theory::transfer::TransferProof;

/// Free numbers that conditions decide.
pub trait Decidable: Sized {
    /// Everything that is computed from them.
    type Evaluation;

    /// Evaluates all quantities and conditions at the precision of `data`.
    fn evaluate(&self, data: &Data<'_>) -> Self::Evaluation;

    /// All conditions in order.
    fn conditions(evaluation: &Self::Evaluation) -> &[Condition];
}

/// The free numbers of a derivation of the regulator in continuous time.
pub trait Witness: Decidable {
    /// What both derivations say.
    fn decided(proof: &Proof<Self>) -> Decided<'_>;
}

/// The free numbers of a claim in continuous time, given to be decided.
#[derive(Clone, Debug)]
pub struct GivenWitness {
    /// The free numbers.
    pub witness: Box<SharpWitness>,
    /// Exact regulation, where it is claimed.
    pub exact: Option<ExactWitness>,
}

/// A witness and what was decided about it.
#[derive(Clone, Debug)]
pub struct Proof<W: Decidable> {
    /// The free numbers.
    pub witness: W,
    /// The evaluation at the precision that decided.
    pub evaluation: W::Evaluation,
    /// That precision in bits.
    pub precision: u32,
}

/// Of the sharp derivation.
pub type SharpProof = Proof<SharpWitness>;

/// Of the repaired derivation.
pub type RepairedProof = Proof<RepairedWitness>;

/// Of the regulator at samples.
pub type SampledProof = Proof<SampledWitness>;

macro_rules! decidable {
    ($($witness:ident => $evaluation:ident),+) => {$(
        impl Decidable for $witness {
            type Evaluation = $evaluation;

            fn evaluate(&self, data: &Data<'_>) -> $evaluation {
                $evaluation::new(data, self)
            }

            fn conditions(evaluation: &$evaluation) -> &[Condition] {
                &evaluation.conditions
            }
        }
    )+};
}

decidable!(SharpWitness => SharpEvaluation, RepairedWitness => RepairedEvaluation, SampledWitness => SampledEvaluation);

impl<W: Decidable> Proof<W> {
    /// The truth of all conditions together.
    #[must_use]
    pub fn truth(&self) -> Truth {
        condition::all(W::conditions(&self.evaluation))
    }
}

impl<W: Witness> Proof<W> {
    /// The view that does not depend on the derivation.
    #[must_use]
    pub fn decided(&self) -> Decided<'_> {
        W::decided(self)
    }
}

/// What was decided about a witness, whichever derivation it is of.
#[derive(Clone, Debug)]
pub struct Decided<'p> {
    /// The gain.
    pub sigma: &'p Rational,
    /// The initial set.
    pub set: &'p ClaimedSet,
    /// k0 and k1.
    pub pair: [&'p Rational; 2],
    /// Why T_N(x) <= k0 + k1 x^2.
    pub transfer: &'p TransferProof,
    /// All conditions in order, proved or not.
    pub conditions: &'p [Condition],
    /// Upper bounds of sup|x|, sup|e| and sup|zeta|_N along the periodic solution. The repaired conditions imply C1-C3 with X, E
    /// in place of x_per, e_per.
    pub periodic: [&'p Enclosure; 3],
    /// The radii of the error box in x and e.
    pub error_box: [Enclosure; 2],
    /// The largest X and E at which a bounding function is used.
    pub arguments: [Enclosure; 2],
    /// The precision that decided, in bits.
    pub precision: u32,
}

impl Decided<'_> {
    /// The largest arguments, rounded up; `None` where they are not bounded.
    #[must_use]
    pub fn reach(&self) -> Option<[Rational; 2]> {
        let [x, e] = self.arguments.each_ref().map(Enclosure::upper_rational);
        Some([x?, e?])
    }
}

impl Witness for SharpWitness {
    fn decided(proof: &SharpProof) -> Decided<'_> {
        let Proof { witness, evaluation, precision } = proof;
        let SharpEvaluation { bounds, periodic, error_box, .. } = evaluation;
        Decided {
            sigma: &witness.sigma,
            set: &witness.set,
            pair: [&witness.k0, &witness.k1],
            transfer: &witness.transfer,
            conditions: &evaluation.conditions,
            periodic: [&periodic.x_per, &periodic.e_per, &evaluation.z],
            error_box: [&witness.d_x, &witness.d_e].map(|radius| Enclosure::from_rational(radius, *precision)),
            arguments: [bounds.x_p.max(&error_box.x_b), bounds.e_p.max(&error_box.e_b)],
            precision: *precision,
        }
    }
}

impl Witness for RepairedWitness {
    fn decided(proof: &RepairedProof) -> Decided<'_> {
        let Proof { witness, evaluation, precision } = proof;
        let RepairedEvaluation { bounds, point, .. } = evaluation;
        Decided {
            sigma: &witness.sigma,
            set: &witness.set,
            pair: [&witness.k0, &witness.k1],
            transfer: &witness.transfer,
            conditions: &evaluation.conditions,
            periodic: [&bounds.state.x_p, &bounds.state.e_p, &evaluation.z],
            error_box: [&point.x_b - &point.x, &point.e_b - &point.e],
            // X <= X_b and E <= E_b.
            arguments: [point.x_b.clone(), point.e_b.clone()],
            precision: *precision,
        }
    }
}
