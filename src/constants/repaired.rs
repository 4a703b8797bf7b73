//! The repaired derivation: the paper's architecture with the smallest sound repair of each formula.

use super::condition::{self, Condition};
use super::existence::{PeriodicBounds, kappas};
use super::gains;
use super::sharp::ClaimedSet;
use super::{domain_conditions, set_conditions, sign_conditions};
use crate::data::{Bound, Data};
use crate::enclosure::{Enclosure, Truth};
use crate::transfer::{self, TransferProof};
use rug::Rational;

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

/// rho_0, rho_11, rho_12, rho_22 and R of P:eq:R-lyap1, P:eq:R-lyap2.
#[derive(Clone, Debug)]
pub struct LyapunovMatrix {
    /// rho_0, with its first bracket repaired where `repaired` (E3).
    pub rho_0: Enclosure,
    /// rho_11 = rho_0 + (h/mu) b_qx^2.
    pub rho_11: Enclosure,
    /// rho_12 = P_up b_fe + b_qx.
    pub rho_12: Enclosure,
    /// rho_22 = b_qe + (h/mu) b_qe^2.
    pub rho_22: Enclosure,
    /// alpha P_low - rho_11, to be positive.
    pub curvature: Enclosure,
    /// The exact threshold: R is positive definite if and only if sigma exceeds it (and `curvature` > 0).
    pub sigma_a: Enclosure,
    /// The printed threshold, with 2 in place of 4 (P:eq:ineq_bounds_sigma): sound, larger.
    pub sigma_a_printed: Enclosure,
}

/// Where rho_0 and the rho_ij are evaluated.
#[derive(Clone, Debug)]
pub struct LyapunovPoint {
    /// X (x_a in the paper).
    pub x: Enclosure,
    /// E (e_a in the paper).
    pub e: Enclosure,
    /// X_b.
    pub x_b: Enclosure,
    /// E_b.
    pub e_b: Enclosure,
    /// h.
    pub h: Enclosure,
}

impl LyapunovMatrix {
    /// Evaluates the functions. `printed` takes rho_0 as in P:eq:def_rho_0, which is 2 P_low times too small in its
    /// first bracket (erratum E3); otherwise rho_0 = P_up [b_fxx X + b_fex E] + (P_up/2) b_fxx(X_b, E)(X_b + X).
    #[must_use]
    pub fn new(data: &Data<'_>, point: &LyapunovPoint, printed: bool) -> LyapunovMatrix {
        let LyapunovPoint { x, e, x_b, e_b, h } = point;
        let first = data.bound(Bound::Fxx, x, e) * x + data.bound(Bound::Fex, x, e) * e;
        let second = data.bound(Bound::Fxx, x_b, e) * (x_b + x);
        let rho_0 = if printed {
            &data.p_up / (2 * &data.p_low) * (first + &data.p_low * second)
        } else {
            &data.p_up * (first + second / 2)
        };
        let (q_x, q_e) = (data.bound(Bound::Qx, x_b, e_b), data.bound(Bound::Qe, x_b, e_b));
        let h_over_mu = h / &data.mu;
        let rho_11 = &rho_0 + &h_over_mu * q_x.sqr();
        let rho_12 = &data.p_up * data.bound(Bound::Fe, x_b, e_b) + q_x;
        let rho_22 = &q_e + h_over_mu * q_e.sqr();
        let curvature = &data.alpha * &data.p_low - &rho_11;
        let base = &rho_22 + &data.mu / (2 * h);
        // Where the curvature is not proved positive there is no threshold.
        let share = if curvature.is_positive().is_true() {
            rho_12.sqr() / &curvature
        } else {
            Enclosure::undefined(data.precision)
        };
        LyapunovMatrix {
            sigma_a: &base + &share / 4,
            sigma_a_printed: base + share / 2,
            rho_0,
            rho_11,
            rho_12,
            rho_22,
            curvature,
        }
    }

    /// The leading principal minors of R (Sylvester's criterion; P:16, P:17 and P:18 times mu) at sigma.
    #[must_use]
    pub fn leading_minors(&self, data: &Data<'_>, sigma: &Enclosure, h: &Enclosure) -> [Enclosure; 3] {
        let first = 2 * &self.curvature;
        let excess = sigma - &self.rho_22;
        let second = 2 * (&first * &excess) - self.rho_12.sqr();
        let mu_h = &data.mu * h;
        let third = &first * (2 * (&excess * &mu_h) - data.mu.sqr()) - self.rho_12.sqr() * mu_h;
        [first, second, third]
    }
}

/// Everything the repaired derivation computes from a witness.
#[derive(Clone, Debug)]
pub struct RepairedEvaluation {
    /// sigma.
    pub sigma: Enclosure,
    /// The bounding functions at (X, E).
    pub bounds: PeriodicBounds,
    /// kappa_0 = k0/w^2.
    pub kappa_0: Enclosure,
    /// kappa_1 = k1/w^4.
    pub kappa_1: Enclosure,
    /// Z.
    pub z: Enclosure,
    /// Where the rho are taken.
    pub point: LyapunovPoint,
    /// The rho and sigma_a.
    pub lyapunov: LyapunovMatrix,
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
        let (kappa_0, kappa_1) = kappas(data, &number(&witness.k0), &number(&witness.k1));
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
        let (_, step) = transfer::decide(data, &witness.k0, &witness.k1, &witness.transfer);
        let what = format!("transfer bound, {}: {}", witness.transfer.name(), step.what);
        conditions.push(Condition::at_most("T", what, step.lhs, step.rhs));
        conditions.push(Condition::at_most(
            "C1",
            "(K_alpha/alpha)(b_fe E + b_fxx X^2/2) <= X",
            bounds.invariance_lhs(data, &k),
            x.clone(),
        ));
        conditions.push(Condition::at_most("C2", "beta(sigma) b_q <= E", &beta * &bounds.q, e.clone()));
        let (p_x, p_e) = (number(&witness.p_x), number(&witness.p_e));
        let [column_x, column_e] = bounds.contraction(data, &k, 2, &beta).weighted_columns(&p_x, &p_e);
        conditions.push(Condition::less("C3", "Y_xx p_x + Y_ex p_e < p_x", column_x, p_x));
        conditions.push(Condition::less("C3b", "Y_xe p_x + Y_ee p_e < p_e", column_e, p_e));
        let [dist_x, dist_e, dist_z] = super::sharp::distances(data, &witness.set, [&x, &e, &z]);
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
