//! Exact regulation with infinitely many oscillators: sigma*_oo (derivation, section 6; P:thm2 repaired).

use super::condition::{self, Condition};
use super::harmonics;
use super::initial_set::{ClaimedSet, claimed_distances};
use super::joint;
use super::matrix_inequality;
use super::paths::Paths;
use super::sharp::{by_norms_conditions, one_sided};
use super::stability::{DecayCondition, ErrorBox, level_condition};
use super::{domain_conditions, sign_conditions};
use crate::data::{Bound, Data, Problem};
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_exact::real::Real;

/// The free numbers of the exact-regulation claim, exactly.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExactWitness {
    /// sigma*_oo.
    pub sigma: Rational,
    /// D_x > 0.
    pub d_x: Rational,
    /// D_e > 0.
    pub d_e: Rational,
    /// w_x > 0.
    pub w_x: Rational,
    /// h > 0.
    pub h: Rational,
    /// Along which paths f and q are split on the error box.
    pub paths: Paths,
}

/// `z_oo = (1/mu) sqrt( b_q_rms(0,0)^2/n_0 + (2/n_1)(T/2pi)^2 b_qt_rms(0,0)^2 )`: the norm of the steady state of the
/// internal model (the paper drops the k = 0 term, a square root and n_0: erratum E13); where harmonics of q(t,0,0) are known,
/// `(1/mu)[ sqrt(C_0^2/n_0 + sum_{k>=1} 4 C_k^2/n_k) + sqrt(r_0^2/n_0 + (2/n_1)(T/2pi)^2 r_1^2) ]`, if that is smaller
/// (derivation, 10.6). Only the mean squares of q(t,0,0) and of its derivative enter (Parseval). With an input gain b the internal
/// model has to put out -q(t,0,0)/b: all of it is over b_lo (derivation, 13.1).
#[must_use]
pub fn steady_state_norm(data: &Data<'_>) -> Enclosure {
    let at_origin = |which| data.bound(which, &data.zero(), &data.zero());
    let norm = |size: &Enclosure, rate: &Enclosure| {
        let constant = size.sqr() / &data.n_0;
        (constant + 2 * (rate / &data.fundamental).sqr() / &data.n_1).sqrt()
    };
    let general = norm(&at_origin(Bound::QRms), &at_origin(Bound::QtRms));
    let norm = match &data.q_0 {
        None => general,
        Some(known) => {
            let rest = norm(&known.rest_rms, &harmonics::rest_t_rms(data, known));
            general.min_known(&(harmonics::weighted_norm(data, known) + rest))
        }
    };
    let norm = norm / &data.mu;
    data.input_gain.as_ref().map_or_else(|| norm.clone(), |gain| &norm / &gain.low)
}

/// Everything computed for exact regulation.
#[derive(Clone, Debug)]
pub struct ExactEvaluation {
    /// z_oo.
    pub z: Enclosure,
    /// C4 and C5 around the origin, and the domain.
    pub conditions: Vec<Condition>,
}

impl ExactEvaluation {
    /// Evaluates C4 and C5 with x_per = e_per = 0.
    ///
    /// Hypotheses: base_frequency = 2 pi/T. Guarantee: if [`ExactEvaluation::truth`] is `True` and the bounding
    /// functions are as proved up to (D_x, D_e), then with infinitely many oscillators, for every sigma' >= sigma,
    /// solutions from the claimed set are bounded and x, e -> 0. No rate, and nothing on z.
    #[must_use]
    pub fn new(data: &Data<'_>, set: &ClaimedSet, witness: &ExactWitness) -> ExactEvaluation {
        let number = |value: &Rational| data.rational(value);
        let z = steady_state_norm(data);
        let (d_x, d_e) = (number(&witness.d_x), number(&witness.d_e));
        let (w_x, h, sigma) = (number(&witness.w_x), number(&witness.h), number(&witness.sigma));
        let error_box = ErrorBox::new(data, witness.paths, [&data.zero(), &data.zero()], [&d_x, &d_e]);
        let decay = DecayCondition::new(data, &error_box, [&w_x, &h], &sigma);
        let mut conditions = sign_conditions(
            data,
            &[
                ("sigma", &witness.sigma),
                ("D_x", &witness.d_x),
                ("D_e", &witness.d_e),
                ("w_x", &witness.w_x),
                ("h", &witness.h),
            ],
        );
        if !data.spec.internal_model.matched {
            conditions.push(Condition::less(
                "matched",
                "exact regulation needs base_frequency = 2 pi / period",
                Enclosure::one(data.precision),
                data.zero(),
            ));
        }
        conditions.extend(domain_conditions(data, error_box.x_b.clone(), error_box.e_b.clone()));
        let distances = claimed_distances(data, set, [&data.zero(), &data.zero(), &z]);
        let of = "exact regulation: ";
        if let Some(joint) = &data.spec.bounds.proved_values().joint_stability {
            let radii = [&d_x, &d_e];
            conditions.extend(joint::conditions(
                data,
                joint,
                distances.each_ref(),
                radii,
                &error_box,
                (&witness.sigma, of),
            ));
            return ExactEvaluation { z, conditions };
        }
        let inequality = matrix_inequality::proved_for(data, &witness.w_x, &witness.h);
        if inequality.is_none() {
            conditions.extend(one_sided(data, witness.paths.q.place_of_de(), &error_box.sector_at));
        }
        let (start, exit) = level_condition(data, distances.each_ref(), [&d_x, &d_e, &w_x, &h]);
        conditions.push(Condition::less("C4", format!("{of}level condition around the origin"), start, exit));
        if let Some(inequality) = inequality {
            let place = (witness.paths, [&data.zero(), &data.zero()], &error_box);
            conditions.extend(matrix_inequality::conditions(data, inequality, place, &sigma, of));
            return ExactEvaluation { z, conditions };
        }
        conditions.extend(by_norms_conditions(&decay, &sigma, of));
        ExactEvaluation { z, conditions }
    }

    /// The truth of all conditions together.
    #[must_use]
    pub fn truth(&self) -> Truth {
        condition::all(&self.conditions)
    }
}
