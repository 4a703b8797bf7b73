//! The printed derivation: the paper's formulas to the letter (K_phi read as K_alpha), at given free numbers.
//!
//! Nothing here may certify: several formulas are unsound (errata). Where a printed condition has no solution the
//! result is a typed [`Infeasible`] with its reason.

use super::contraction::ContractionMatrix;
use super::existence::PeriodicBounds;
use super::gains;
use super::repaired::{LyapunovMatrix, LyapunovPoint};
use crate::data::{Bound, Data};
use crate::enclosure::Enclosure;
use crate::transfer::{PrintedTransfer, printed_transfer};
use rug::Rational;
use thiserror::Error;

/// Why a printed condition has no solution, or a printed constant no value.
#[derive(Clone, Debug, Error)]
pub enum Infeasible {
    /// P:eq:boundx_bounde_1 (erratum E1).
    #[error(
        "P:eq:boundx_bounde_1 has no solution x_a, e_a > 0: multiplying its two parts gives 81 <= 3.5 (3 sqrt(2)/c + 1/(2 c^2)), \
         which is at most {reached} for c = sqrt(P_up/P_low) of this specification (E1)"
    )]
    LevelCondition {
        /// Upper end of the right side.
        reached: String,
    },
    /// P:eq:bound_xe_inf (erratum E2).
    #[error(
        "P:eq:bound_xe_inf has no solution: it needs P_up/P_low <= (6 + 4 sqrt(2))/9 = 1.2952, here at least {ratio} (E2)"
    )]
    LevelConditionInfinite {
        /// Lower end of P_up/P_low.
        ratio: String,
    },
    /// The third line of (19) (erratum E5).
    #[error("the third line of (19) asks beta(sigma) to be below {level}, which no sigma satisfies (E5)")]
    NegativeLevel {
        /// The right side.
        level: String,
    },
    /// (12) or (14) fails before sigma enters.
    #[error("{what} fails at these x_p, e_p for every sigma")]
    Existence {
        /// The condition.
        what: &'static str,
    },
    /// P:eq:boundx_bounde_2 or P:eq:ineq_bounds_b fails.
    #[error("{what} fails at these x_a, e_a, h")]
    Stability {
        /// The condition.
        what: &'static str,
    },
}

/// The printed constants at x_p = x_a, e_p = e_a, h, sigma.
#[derive(Clone, Debug)]
pub struct PrintedEvaluation {
    /// K_alpha (P:app:Kalpha1).
    pub k_alpha: Enclosure,
    /// K_{alpha,2} (P:app:Kalpha2).
    pub k_alpha_2: Enclosure,
    /// The bounding functions at (x_p, e_p).
    pub bounds: PeriodicBounds,
    /// The constants of the transfer lemma.
    pub transfer: PrintedTransfer,
    /// zeta_p.
    pub z: Enclosure,
    /// zeta_a = zeta_p + 2 Nbar e (P:eq:boundzeta_item1).
    pub zeta_a: Enclosure,
    /// r_e = b_q + Nbar zeta_p, printed without its factor mu (E10).
    pub r_e: Enclosure,
    /// r_x.
    pub r_x: Enclosure,
    /// psi_2 = (T/2pi)^2 b_q^2, printed without its factor T (E11).
    pub psi_2: Enclosure,
    /// x_b, e_b of P:eq:temp_bound_xe2 and h.
    pub point: LyapunovPoint,
    /// The rho and sigma_a.
    pub lyapunov: LyapunovMatrix,
    /// The largest h that P:eq:ineq_bounds_b allows.
    pub h_limit: Enclosure,
    /// sigma_p* from (19), or why there is none.
    pub sigma_p: Result<Enclosure, Infeasible>,
    /// sigma_a* from P:eq:ineq_bounds_sigma, or why its hypotheses fail.
    pub sigma_a: Result<Enclosure, Infeasible>,
}

/// Whether P:eq:boundx_bounde_1 can be satisfied: never (erratum E1). The evidence is evaluated for the data.
///
/// Guarantee: for c >= 1 the two parts `9 P_up x_a^2 <= 3.5 e_a^2` and
/// `9 e_a^2 <= (3 sqrt 2 sqrt(P_up P_low) + P_low/2) x_a^2` multiply to 81 <= 3.5 (3 sqrt 2/c + 1/(2c^2)); an error is
/// returned when that is proved false. `Ok` would mean that rounding prevented the proof.
///
/// # Errors
/// [`Infeasible::LevelCondition`].
pub fn level_condition(data: &Data<'_>) -> Result<(), Infeasible> {
    let seven_halves = Enclosure::from_rational(&Rational::from((7, 2)), data.precision);
    let root_two = Enclosure::from_integer(2, data.precision).sqrt();
    let reached = seven_halves * (3 * root_two / &data.c + (2 * data.c.sqr()).recip());
    match reached.lt(&Enclosure::from_integer(81, data.precision)) {
        crate::enclosure::Truth::True => Err(Infeasible::LevelCondition { reached: reached.upper_decimal(6) }),
        _ => Ok(()),
    }
}

/// Whether P:eq:bound_xe_inf (theorem 2) can be satisfied: only for P_up/P_low <= (6 + 4 sqrt 2)/9 (erratum E2).
///
/// # Errors
/// [`Infeasible::LevelConditionInfinite`] when the ratio is certainly larger.
pub fn level_condition_infinite(data: &Data<'_>) -> Result<(), Infeasible> {
    let ratio = &data.p_up / &data.p_low;
    let largest = (6 + 4 * Enclosure::from_integer(2, data.precision).sqrt()) / 9;
    match ratio.gt(&largest) {
        crate::enclosure::Truth::True => Err(Infeasible::LevelConditionInfinite { ratio: ratio.lower_decimal(6) }),
        _ => Ok(()),
    }
}

/// x_b = (3 sqrt 2 c + 2) x_a and e_b = 6 e_a (P:eq:temp_bound_xe2).
#[must_use]
pub fn error_box(data: &Data<'_>, x_a: &Enclosure, e_a: &Enclosure) -> (Enclosure, Enclosure) {
    let factor = 3 * (Enclosure::from_integer(2, data.precision).sqrt() * &data.c) + 2;
    (factor * x_a, 6 * e_a)
}

impl PrintedEvaluation {
    /// Evaluates the printed formulas. `h = None` takes the largest h that P:eq:ineq_bounds_b allows.
    #[must_use]
    pub fn new(data: &Data<'_>, x_a: &Enclosure, e_a: &Enclosure, h: Option<&Enclosure>) -> PrintedEvaluation {
        let k_alpha = gains::k_alpha(&data.c, &data.alpha, &data.period);
        let k_alpha_2 = gains::k_alpha_2_printed(&k_alpha, &data.alpha, &data.period);
        let bounds = PeriodicBounds::new(data, x_a.clone(), e_a.clone());
        let transfer = printed_transfer(data);
        let z = bounds.z_squared_printed(data, &transfer.kappa_0, &transfer.kappa_1).sqrt();
        let zeta_a = &z + 2 * (&data.n_bar * e_a);
        let r_e = &bounds.q + &data.n_bar * &z;
        let denominator = &data.alpha - &k_alpha * &bounds.f_xx * x_a / 2;
        let r_x = &k_alpha * &bounds.f_e / denominator * &r_e;
        let two_pi = 2 * Enclosure::pi(data.precision);
        let psi_2 = (&data.period / two_pi).sqr() * bounds.q.sqr();
        let (x_b, e_b) = error_box(data, x_a, e_a);
        let h_limit = h_limit(data, &x_b, &e_b, x_a, e_a, &zeta_a);
        let point = LyapunovPoint { x: x_a.clone(), e: e_a.clone(), x_b, e_b, h: h.unwrap_or(&h_limit).clone() };
        let lyapunov = LyapunovMatrix::new(data, &point, true);
        let sigma_p = sigma_p(data, &bounds, &k_alpha);
        let sigma_a = sigma_a(data, &lyapunov, &point, &h_limit);
        PrintedEvaluation {
            k_alpha,
            k_alpha_2,
            bounds,
            transfer,
            z,
            zeta_a,
            r_e,
            r_x,
            psi_2,
            point,
            lyapunov,
            h_limit,
            sigma_p,
            sigma_a,
        }
    }

    /// The printed contraction matrix (P:eq:def_ypsilon) at sigma.
    #[must_use]
    pub fn contraction(&self, data: &Data<'_>, sigma: &Enclosure) -> ContractionMatrix {
        self.bounds.contraction(data, &self.k_alpha, 2, &gains::beta(sigma, &data.period))
    }
}

/// P:eq:ineq_bounds_b: `(1/3) min{ min{P_low (x_b-x_a)^2, (e_b-e_a)^2}/(3 zeta_a)^2, mu alpha P_low/b_qx(x_b,e_b)^2 }`.
fn h_limit(
    data: &Data<'_>,
    x_b: &Enclosure,
    e_b: &Enclosure,
    x_a: &Enclosure,
    e_a: &Enclosure,
    zeta_a: &Enclosure,
) -> Enclosure {
    let exit = (&data.p_low * (x_b - x_a).sqr()).min(&(e_b - e_a).sqr());
    let by_level = exit / (9 * zeta_a.sqr());
    let q_x = data.bound(Bound::Qx, x_b, e_b).sqr();
    let numerator = &data.mu * &data.alpha * &data.p_low;
    // b_qx = 0 leaves the second member without effect.
    let limit = if q_x == Enclosure::zero(2) { by_level } else { by_level.min(&(numerator / q_x)) };
    limit / 3
}

/// sigma_p* from the three inequalities (19).
fn sigma_p(data: &Data<'_>, bounds: &PeriodicBounds, k_alpha: &Enclosure) -> Result<Enclosure, Infeasible> {
    let gain = k_alpha / &data.alpha;
    if bounds.invariance_lhs(data, k_alpha).gt(&bounds.x_p).is_true() {
        return Err(Infeasible::Existence { what: "(12)" });
    }
    let bracket = &bounds.f_ex * &bounds.e_p + 2 * (&bounds.f_xx * &bounds.x_p);
    let free = 1 - &gain * &bracket;
    if free.le(&data.zero()).is_true() {
        return Err(Infeasible::Existence { what: "(14)" });
    }
    let determinant = &gain * (&bounds.f_e * &bounds.q_x - &bracket * &bounds.q_e);
    let mut sigma = gains::beta_inverse(&(&bounds.e_p / &bounds.q), &data.period);
    let second = &bounds.q_e + &determinant;
    if second.is_positive().is_true() {
        sigma = sigma.max(&gains::beta_inverse(&(free / second), &data.period));
    }
    let third = determinant.recip();
    if third.is_positive().is_true() {
        sigma = sigma.max(&gains::beta_inverse(&third, &data.period));
    } else if determinant.lt(&data.zero()).is_true() {
        return Err(Infeasible::NegativeLevel { level: third.upper_decimal(6) });
    }
    Ok(sigma)
}

/// sigma_a* with its hypotheses P:eq:boundx_bounde_2 and P:eq:ineq_bounds_b.
fn sigma_a(
    data: &Data<'_>,
    lyapunov: &LyapunovMatrix,
    point: &LyapunovPoint,
    h_limit: &Enclosure,
) -> Result<Enclosure, Infeasible> {
    if (3 * &lyapunov.rho_0).gt(&(&data.alpha * &data.p_low)).is_true() {
        return Err(Infeasible::Stability { what: "P:eq:boundx_bounde_2, rho_0 <= alpha P_low/3," });
    }
    if point.h.gt(h_limit).is_true() {
        return Err(Infeasible::Stability { what: "P:eq:ineq_bounds_b" });
    }
    Ok(lyapunov.sigma_a_printed.clone())
}
