//! The repaired derivation: the paper's architecture with the smallest sound repair of each formula.

use super::condition::{self, Condition};
use super::existence::PeriodicBounds;
use super::gains;
use super::initial_set::{ClaimedSet, claimed_distances, set_conditions};
use super::lyapunov_matrix::{LyapunovMatrix, LyapunovPoint};
use super::{domain_conditions, sign_conditions};
use crate::data::Data;
use crate::transfer::{self, TransferProof};
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};

/// The free numbers of the repaired derivation, exactly.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RepairedWitness {
    /// The gain to be certified.
    pub sigma: Rational,
    /// X > 0, the bound of the periodic x.
    pub x: Rational,
    /// E > 0, the bound of the periodic e.
    pub e: Rational,
    /// L > 0, the level of the Lyapunov function.
    pub level: Rational,
    /// h > 0.
    pub h: Rational,
    /// p_x > 0.
    pub p_x: Rational,
    /// p_e > 0.
    pub p_e: Rational,
    /// k0, in units of x = omega/w.
    pub k0: Rational,
    /// k1, in units of x = omega/w.
    pub k1: Rational,
    /// Why T_N(x) <= k0 + k1 x^2.
    pub transfer: TransferProof,
    /// The initial set to be covered.
    pub set: ClaimedSet,
}

/// Everything the repaired derivation computes from a witness.
#[derive(Clone, Debug)]
pub struct RepairedEvaluation {
    /// sigma.
    pub sigma: Enclosure,
    /// The bounding functions at (X, E).
    pub bounds: PeriodicBounds<Enclosure>,
    /// kappa_0 = k0/w^2.
    pub kappa_0: Enclosure,
    /// kappa_1 = k1/w^4.
    pub kappa_1: Enclosure,
    /// Z.
    pub z: Enclosure,
    /// Where the rho are taken.
    pub point: LyapunovPoint<Enclosure>,
    /// The rho and sigma_a.
    pub lyapunov: LyapunovMatrix<Enclosure>,
    /// All conditions in order.
    pub conditions: Vec<Condition>,
}

impl RepairedEvaluation {
    /// Evaluates all quantities and conditions at the precision of `data`.
    ///
    /// Guarantee: if [`RepairedEvaluation::truth`] is `True` and the bounding functions are finite, nonnegative and
    /// nondecreasing up to (X_b, E_b), the claim of the sharp derivation holds with X, E in place of x_per, e_per.
    #[must_use]
    pub fn new(data: &Data<'_>, witness: &RepairedWitness) -> RepairedEvaluation {
        let number = |value: &Rational| data.rational(value);
        let (sigma, x, e) = (number(&witness.sigma), number(&witness.x), number(&witness.e));
        let (level, h) = (number(&witness.level), number(&witness.h));
        let k = gains::k_alpha(&data.c, &data.alpha, &data.period);
        let beta = gains::beta(&sigma, &data.period);
        let bounds = PeriodicBounds::new(data, x.clone(), e.clone());
        let [kappa_0, kappa_1] = data.kappas(&number(&witness.k0), &number(&witness.k1));
        let z = bounds.z_squared_printed(data, &kappa_0, &kappa_1).sqrt();
        let point = LyapunovPoint {
            x_b: &x + (&level / &data.p_low).sqrt(),
            e_b: &e + level.sqrt(),
            x: x.clone(),
            e: e.clone(),
            h: h.clone(),
        };
        let lyapunov = LyapunovMatrix::new(data, &point, false);

        let mut conditions = sign_conditions(
            data,
            &[
                ("sigma", &witness.sigma),
                ("X", &witness.x),
                ("E", &witness.e),
                ("L", &witness.level),
                ("h", &witness.h),
                ("p_x", &witness.p_x),
                ("p_e", &witness.p_e),
                ("k1", &witness.k1),
            ],
        );
        conditions.extend(set_conditions(data, &witness.set, &witness.x, &witness.e, &z));
        conditions.extend(domain_conditions(data, point.x_b.clone(), point.e_b.clone()));
        conditions.push(transfer::decide(data, &witness.k0, &witness.k1, &witness.transfer).1);
        conditions.push(Condition::at_most(
            "C1",
            "(K_alpha/alpha)(b_fe E + b_fxx X^2/2) <= X",
            bounds.state.invariance_lhs(data, &k),
            x.clone(),
        ));
        conditions.push(Condition::at_most("C2", "beta(sigma) b_q <= E", &beta * bounds.q(data), e.clone()));
        let (p_x, p_e) = (number(&witness.p_x), number(&witness.p_e));
        let [column_x, column_e] = bounds.contraction(data, &k, 2, &beta).weighted_columns(&p_x, &p_e);
        conditions.push(Condition::less("C3", "Y_xx p_x + Y_ex p_e < p_x", column_x, p_x));
        conditions.push(Condition::less("C3b", "Y_xe p_x + Y_ee p_e < p_e", column_e, p_e));
        let [dist_x, dist_e, dist_z] = claimed_distances(data, &witness.set, [&x, &e, &z]);
        conditions.push(Condition::less(
            "C4",
            "P_up (X_0+X)^2 + (E_0+E)^2 + h (Z_0+Nbar E_0+Z)^2 < L",
            &data.p_up * dist_x.sqr() + dist_e.sqr() + &h * dist_z.sqr(),
            level,
        ));
        conditions.push(Condition::less(
            "C5",
            "rho_11 < alpha P_low",
            lyapunov.rho_11.clone(),
            &data.alpha * &data.p_low,
        ));
        conditions.push(Condition::less("C5b", "sigma_a < sigma", lyapunov.sigma_a.clone(), sigma.clone()));
        RepairedEvaluation { sigma, bounds, kappa_0, kappa_1, z, point, lyapunov, conditions }
    }

    /// The truth of all conditions together.
    #[must_use]
    pub fn truth(&self) -> Truth {
        condition::all(&self.conditions)
    }
}
