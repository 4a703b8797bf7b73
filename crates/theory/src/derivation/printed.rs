//! The printed derivation: the paper's formulas to the letter (K_phi read as K_alpha), at given free numbers.
//!
//! Nothing here may certify: several formulas are unsound (errata). Where a printed condition has no solution the
//! result is a typed [`Infeasible`] with its reason.

use super::existence::PeriodicBounds;
use super::gains;
use super::lyapunov_matrix::{LyapunovMatrix, LyapunovPoint};
use crate::data::{Bound, Data, Numbers, Problem};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::real::{Operand, Real};
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

/// What the printed formulas give at x_p = x_a, e_p = e_a, h.
#[derive(Clone, Debug)]
pub struct PrintedEvaluation<R> {
    /// zeta_a = zeta_p + 2 Nbar e (P:eq:boundzeta_item1).
    pub zeta_a: R,
    /// x_b, e_b of P:eq:temp_bound_xe2 and h.
    pub point: LyapunovPoint<R>,
    /// The rho and sigma_a.
    pub lyapunov: LyapunovMatrix<R>,
    /// sigma_p* from (19), or why there is none.
    pub sigma_p: Result<R, Infeasible>,
    /// sigma_a* from P:eq:ineq_bounds_sigma, or why its hypotheses fail.
    pub sigma_a: Result<R, Infeasible>,
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
        sigmastar_exact::enclosure::Truth::True => {
            Err(Infeasible::LevelCondition { reached: reached.upper_decimal(6) })
        }
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
        sigmastar_exact::enclosure::Truth::True => {
            Err(Infeasible::LevelConditionInfinite { ratio: ratio.lower_decimal(6) })
        }
        _ => Ok(()),
    }
}

/// The error box: x_b = (3 sqrt 2 c + 2) x_a and e_b = 6 e_a (P:eq:temp_bound_xe2).
#[must_use]
pub fn error_box<R: Real>(problem: &impl Problem<R>, x_a: &R, e_a: &R) -> (R, R)
where
    for<'a> &'a R: Operand<R>,
{
    let factor = (R::int(18) * problem.numbers().c.sqr()).sqrt() + R::int(2);
    (factor * x_a, R::int(6) * e_a)
}

impl<R: Real> PrintedEvaluation<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// Evaluates the printed formulas, with the printed kappas; `h` chooses h, given the largest one that
    /// P:eq:ineq_bounds_b allows.
    #[must_use]
    pub fn new(
        problem: &impl Problem<R>,
        [kappa_0, kappa_1]: [&R; 2],
        x_a: &R,
        e_a: &R,
        h: impl FnOnce(&R) -> R,
    ) -> PrintedEvaluation<R> {
        let bounds = PeriodicBounds::new(problem, x_a.clone(), e_a.clone());
        let zeta_p = bounds.z_squared_printed(problem, kappa_0, kappa_1).sqrt();
        let zeta_a = zeta_p + R::int(2) * (&problem.numbers().n_bar * e_a);
        let (x_b, e_b) = error_box(problem, x_a, e_a);
        let largest = h_limit(problem, [&x_b, &e_b], [x_a, e_a], &zeta_a);
        let point = LyapunovPoint { x: x_a.clone(), e: e_a.clone(), x_b, e_b, h: h(&largest) };
        let lyapunov = LyapunovMatrix::new(problem, &point, true);
        let sigma_p = sigma_p(problem, &bounds);
        let sigma_a = sigma_a(problem, &lyapunov, &point, &largest);
        PrintedEvaluation { zeta_a, point, lyapunov, sigma_p, sigma_a }
    }
}

/// P:eq:ineq_bounds_b: `(1/3) min{ min{P_low (x_b-x_a)^2, (e_b-e_a)^2}/(3 zeta_a)^2, mu alpha P_low/b_qx(x_b,e_b)^2 }`.
fn h_limit<R: Real>(problem: &impl Problem<R>, [x_b, e_b]: [&R; 2], [x_a, e_a]: [&R; 2], zeta_a: &R) -> R
where
    for<'a> &'a R: Operand<R>,
{
    let Numbers { p_low, alpha, mu, .. } = problem.numbers();
    let exit = (p_low * (x_b - x_a).sqr()).min(&(e_b - e_a).sqr());
    let by_level = exit / (R::int(9) * zeta_a.sqr());
    let q_x = problem.bound(Bound::Qx, x_b, e_b).sqr();
    // b_qx = 0 leaves the second member without effect.
    let limit = if q_x.is_zero() { by_level } else { by_level.min(&(mu * alpha * p_low / q_x)) };
    limit / R::int(3)
}

/// sigma_p* from the three inequalities (19).
fn sigma_p<R: Real>(problem: &impl Problem<R>, bounds: &PeriodicBounds<R>) -> Result<R, Infeasible>
where
    for<'a> &'a R: Operand<R>,
{
    let Numbers { period, c, alpha, .. } = problem.numbers();
    let k = gains::k_alpha(c, alpha, period);
    let gain = &k / alpha;
    if (bounds.state.invariance_lhs(problem, &k) - &bounds.state.x_p).is_certainly_positive() {
        return Err(Infeasible::Existence { what: "(12)" });
    }
    let bracket = &bounds.state.f_ex * &bounds.state.e_p + R::int(2) * (&bounds.state.f_xx * &bounds.state.x_p);
    let free = R::int(1) - &gain * &bracket;
    if free.is_zero() || (-free.clone()).is_certainly_positive() {
        return Err(Infeasible::Existence { what: "(14)" });
    }
    let determinant = gain * (&bounds.state.f_e * &bounds.q_x - &bracket * &bounds.q_e);
    let mut sigma = gains::beta_inverse(&(&bounds.state.e_p / bounds.q(problem)), period);
    let second = &bounds.q_e + &determinant;
    if second.is_certainly_positive() {
        sigma = sigma.max(&gains::beta_inverse(&(free / second), period));
    }
    let third = R::int(1) / &determinant;
    if third.is_certainly_positive() {
        sigma = sigma.max(&gains::beta_inverse(&third, period));
    } else if (-determinant).is_certainly_positive() {
        return Err(Infeasible::NegativeLevel { level: third.above() });
    }
    Ok(sigma)
}

/// sigma_a* with its hypotheses P:eq:boundx_bounde_2 and P:eq:ineq_bounds_b.
fn sigma_a<R: Real>(
    problem: &impl Problem<R>,
    lyapunov: &LyapunovMatrix<R>,
    point: &LyapunovPoint<R>,
    h_limit: &R,
) -> Result<R, Infeasible>
where
    for<'a> &'a R: Operand<R>,
{
    let Numbers { p_low, alpha, .. } = problem.numbers();
    if (R::int(3) * &lyapunov.rho_0 - alpha * p_low).is_certainly_positive() {
        return Err(Infeasible::Stability { what: "P:eq:boundx_bounde_2, rho_0 <= alpha P_low/3," });
    }
    if (&point.h - h_limit).is_certainly_positive() {
        return Err(Infeasible::Stability { what: "P:eq:ineq_bounds_b" });
    }
    Ok(lyapunov.sigma_a_printed.clone())
}
