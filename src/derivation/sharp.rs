//! The sharp derivation: conditions C1-C5 decided from a rational witness (derivation, sections 4 and 5).

use super::condition::{self, Condition};
use super::contraction::ContractionMatrix;
use super::existence::{PeriodicBounds, PeriodicSolution, kappas};
use super::gains;
use super::initial_set::{distances, set_conditions};
use super::stability::{DecayCondition, ErrorBox, level_condition};
use super::{domain_conditions, sign_conditions};
use crate::data::Data;
use crate::enclosure::{Enclosure, Truth};
use crate::transfer::{self, TransferProof};
use rug::Rational;

/// The set of initial conditions |x| <= x0, |e| <= e0, |z|_N <= z0 of a claim, exactly.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClaimedSet {
    /// X_0.
    pub x0: Rational,
    /// E_0.
    pub e0: Rational,
    /// Z_0.
    pub z0: Rational,
}

impl ClaimedSet {
    /// dX, dE, dZ ([`distances`]) from a periodic solution bounded by x_per, e_per, Z.
    #[must_use]
    pub fn distances(&self, data: &Data<'_>, periodic: [&Enclosure; 3]) -> [Enclosure; 3] {
        let [x0, e0, z0] = [&self.x0, &self.e0, &self.z0].map(|size| data.rational(size));
        distances(data, [&x0, &e0, &z0], periodic)
    }
}

/// The free numbers of the sharp derivation, exactly.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SharpWitness {
    /// The gain to be certified.
    pub sigma: Rational,
    /// X_p > 0.
    pub x_p: Rational,
    /// E_p > 0.
    pub e_p: Rational,
    /// D_x > 0.
    pub d_x: Rational,
    /// D_e > 0.
    pub d_e: Rational,
    /// p_x > 0.
    pub p_x: Rational,
    /// p_e > 0.
    pub p_e: Rational,
    /// w_x > 0.
    pub w_x: Rational,
    /// h > 0.
    pub h: Rational,
    /// k0, in units of x = omega/w.
    pub k0: Rational,
    /// k1, in units of x = omega/w.
    pub k1: Rational,
    /// Why T_N(x) <= k0 + k1 x^2.
    pub transfer: TransferProof,
    /// The initial set to be covered.
    pub set: ClaimedSet,
}

/// Everything the sharp derivation computes from a witness.
#[derive(Clone, Debug)]
pub struct SharpEvaluation {
    /// sigma.
    pub sigma: Enclosure,
    /// The bounding functions at (X_p, E_p).
    pub bounds: PeriodicBounds<Enclosure>,
    /// e_per and x_per at sigma.
    pub periodic: PeriodicSolution<Enclosure>,
    /// kappa_0 = k0/w^2.
    pub kappa_0: Enclosure,
    /// kappa_1 = k1/w^4.
    pub kappa_1: Enclosure,
    /// Z.
    pub z: Enclosure,
    /// The contraction matrix of C3 at sigma.
    pub contraction: ContractionMatrix<Enclosure>,
    /// The error box.
    pub error_box: ErrorBox<Enclosure>,
    /// C5.
    pub decay: DecayCondition<Enclosure>,
    /// All conditions in order.
    pub conditions: Vec<Condition>,
}

impl SharpEvaluation {
    /// Evaluates all quantities and conditions at the precision of `data`.
    ///
    /// Guarantee: if [`SharpEvaluation::truth`] is `True` and the bounding functions are finite, nonnegative and
    /// nondecreasing up to (max{X_p, X_b}, max{E_p, E_b}), then for every n_o >= 0 and every sigma' >= sigma there is a
    /// T-periodic solution with sup|x| <= x_per, sup|e| <= e_per, sup|zeta|_N <= Z, and every solution from the claimed
    /// set, at any initial time, converges to it exponentially.
    #[must_use]
    pub fn new(data: &Data<'_>, witness: &SharpWitness) -> SharpEvaluation {
        let number = |value: &Rational| data.rational(value);
        let sigma = number(&witness.sigma);
        // Lemma K of the derivation: c in place of K_alpha.
        let k = &data.c;
        let bounds = PeriodicBounds::new(data, number(&witness.x_p), number(&witness.e_p));
        let periodic = PeriodicSolution::new(data, &bounds, &sigma);
        let (kappa_0, kappa_1) = kappas(data, &number(&witness.k0), &number(&witness.k1));
        let z = bounds.z_squared_sharp(data, &kappa_0, &kappa_1).sqrt();

        let (d_x, d_e) = (number(&witness.d_x), number(&witness.d_e));
        let (w_x, h) = (number(&witness.w_x), number(&witness.h));
        let error_box = ErrorBox::new(data, &periodic.x_per, &periodic.e_per, &d_x, &d_e);
        let decay = DecayCondition::new(data, &error_box, &w_x, &h);

        let mut conditions = sign_conditions(
            data,
            &[
                ("sigma", &witness.sigma),
                ("X_p", &witness.x_p),
                ("E_p", &witness.e_p),
                ("D_x", &witness.d_x),
                ("D_e", &witness.d_e),
                ("p_x", &witness.p_x),
                ("p_e", &witness.p_e),
                ("w_x", &witness.w_x),
                ("h", &witness.h),
                ("k1", &witness.k1),
            ],
        );
        conditions.extend(set_conditions(data, &witness.set, &witness.x_p, &witness.e_p, &z));
        conditions.extend(domain_conditions(
            data,
            bounds.state.x_p.max(&error_box.x_b),
            bounds.state.e_p.max(&error_box.e_b),
        ));
        let (_, step) = transfer::decide(data, &witness.k0, &witness.k1, &witness.transfer);
        conditions.push(Condition::at_most(
            "T",
            format!("transfer bound, {}: {}", witness.transfer.name(), step.what),
            step.lhs,
            step.rhs,
        ));
        conditions.push(Condition::at_most(
            "C1",
            "(c/alpha)(b_fe E_p + b_fxx X_p^2/2) <= X_p",
            bounds.state.invariance_lhs(data, k),
            bounds.state.x_p.clone(),
        ));
        conditions.push(Condition::less(
            "C1b",
            "(c/alpha) b_fxx X_p/2 < 1",
            bounds.state.quadratic_share(data, k),
            Enclosure::one(data.precision),
        ));
        conditions.push(Condition::at_most(
            "C2",
            "min{beta_s(sigma) qr, tau(sigma) q1} <= E_p",
            periodic.by_size.min(&periodic.by_rate),
            bounds.state.e_p.clone(),
        ));
        let (p_x, p_e) = (number(&witness.p_x), number(&witness.p_e));
        let matrix = bounds.contraction(data, k, 1, &gains::beta_s(&sigma, &data.period));
        let [column_x, column_e] = matrix.weighted_columns(&p_x, &p_e);
        conditions.push(Condition::less("C3", "A p_x + beta_s b_qx p_e < p_x", column_x, p_x));
        conditions.push(Condition::less("C3b", "B p_x + beta_s b_qe p_e < p_e", column_e, p_e));

        let [dist_x, dist_e, dist_z] = witness.set.distances(data, [&periodic.x_per, &periodic.e_per, &z]);
        let (start, exit) = level_condition(data, [&dist_x, &dist_e, &dist_z], [&d_x, &d_e, &w_x, &h]);
        conditions.push(Condition::less(
            "C4",
            "w_x P_up dX^2 + dE^2 + h dZ^2 < min{w_x P_low D_x^2, D_e^2}",
            start,
            exit,
        ));
        conditions.push(Condition::less(
            "C5",
            "(h/mu) k_x^2 < 4 w_x (alpha - gam)",
            decay.coupling.clone(),
            decay.curvature.clone(),
        ));
        conditions.push(Condition::less(
            "C5b",
            "threshold of the quadratic form < sigma",
            decay.sigma_threshold.clone(),
            sigma.clone(),
        ));
        SharpEvaluation {
            sigma,
            bounds,
            periodic,
            kappa_0,
            kappa_1,
            z,
            contraction: matrix,
            error_box,
            decay,
            conditions,
        }
    }

    /// The truth of all conditions together.
    #[must_use]
    pub fn truth(&self) -> Truth {
        condition::all(&self.conditions)
    }
}
