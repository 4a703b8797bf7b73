//! Existence and size of the periodic solution (derivation, section 4).

use super::contraction::ContractionMatrix;
use super::gains;
use crate::data::{Bound, Numbers, Problem};
use sigmastar_exact::real::{Operand, Real};

/// What the data say about x' at (X_p, E_p).
#[derive(Clone, Debug)]
pub struct StateBounds<R> {
    /// X_p.
    pub x_p: R,
    /// E_p.
    pub e_p: R,
    /// b_fe(X_p, E_p).
    pub f_e: R,
    /// b_fxx(X_p, 0).
    pub f_xx: R,
    /// b_fex(X_p, E_p).
    pub f_ex: R,
}

impl<R: Real> StateBounds<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// Evaluates the bounding functions.
    #[must_use]
    pub fn new(problem: &impl Problem<R>, x_p: R, e_p: R) -> StateBounds<R> {
        let at_box = |which| problem.bound(which, &x_p, &e_p);
        let f_xx = problem.bound(Bound::Fxx, &x_p, &problem.zero());
        StateBounds { f_e: at_box(Bound::Fe), f_ex: at_box(Bound::Fex), f_xx, x_p, e_p }
    }

    /// The left side of (C1) and of P:12: `(k/alpha)(b_fe E_p + b_fxx X_p^2/2)`, to be at most X_p; k = c or K_alpha.
    #[must_use]
    pub fn invariance_lhs(&self, problem: &impl Problem<R>, k: &R) -> R {
        k / &problem.numbers().alpha * (&self.f_e * &self.e_p + &self.f_xx * self.x_p.sqr() / R::int(2))
    }

    /// `(k/alpha)(b_fex E_p + factor b_fxx X_p)`, the first entry of the contraction matrix, to be below 1 in (C3); `factor`
    /// is 1 (sharp) or 2 (P:eq:def_ypsilon).
    #[must_use]
    pub fn contraction_xx(&self, problem: &impl Problem<R>, k: &R, factor: i64) -> R {
        k / &problem.numbers().alpha * (&self.f_ex * &self.e_p + R::int(factor) * (&self.f_xx * &self.x_p))
    }
}

/// The bounding functions at (X_p, E_p), and b_fxx at (X_p, 0).
#[derive(Clone, Debug)]
pub struct PeriodicBounds<R> {
    /// Those of x'.
    pub state: StateBounds<R>,
    /// b_qe(X_p, E_p).
    pub q_e: R,
    /// b_qx(X_p, E_p).
    pub q_x: R,
}

impl<R: Real> PeriodicBounds<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// Evaluates the bounding functions.
    #[must_use]
    pub fn new(problem: &impl Problem<R>, x_p: R, e_p: R) -> PeriodicBounds<R> {
        let state = StateBounds::new(problem, x_p, e_p);
        let at_box = |which| problem.bound(which, &state.x_p, &state.e_p);
        let (q_e, q_x) = (at_box(Bound::Qe), at_box(Bound::Qx));
        PeriodicBounds { state, q_e, q_x }
    }

    /// The contraction matrix with gain k (c or K_alpha), `factor` 1 (sharp) or 2 (P:eq:def_ypsilon) in front of
    /// b_fxx X_p, and `error_gain` beta_s(sigma) or beta(sigma).
    #[must_use]
    pub fn contraction(&self, problem: &impl Problem<R>, k: &R, factor: i64, error_gain: &R) -> ContractionMatrix<R> {
        ContractionMatrix {
            xx: self.state.contraction_xx(problem, k, factor),
            xe: k / &problem.numbers().alpha * &self.state.f_e,
            ex: error_gain * &self.q_x,
            ee: error_gain * &self.q_e,
        }
    }

    /// The paper's `Z^2 = (T/mu + kappa_0 + 54 kappa_1 b_qe^2) b_q^2 + 3 kappa_1 (b_qt^2 + b_qx^2 b_f^2)`
    /// (proof of P:prop:periodic_solution): sound with sound kappas.
    #[must_use]
    pub fn z_squared_printed(&self, problem: &impl Problem<R>, kappa_0: &R, kappa_1: &R) -> R {
        let Numbers { period, mu, .. } = problem.numbers();
        let at_box = |which| problem.bound(which, &self.state.x_p, &self.state.e_p);
        (period / mu + kappa_0 + R::int(54) * (kappa_1 * self.q_e.sqr())) * at_box(Bound::Q).sqr()
            + R::int(3) * (kappa_1 * (at_box(Bound::Qt).sqr() + self.q_x.sqr() * at_box(Bound::F).sqr()))
    }

    /// b_q(X_p, E_p), which the paper has in place of the root mean square.
    #[must_use]
    pub fn q(&self, problem: &impl Problem<R>) -> R {
        problem.bound(Bound::Q, &self.state.x_p, &self.state.e_p)
    }
}

/// The infima of the sigma with C2 and C3 at (X_p, E_p), each by itself.
#[derive(Clone, Debug)]
pub struct LeastSigma<R> {
    /// Of the sigma with C2: beta^-1(E/b_q).
    pub by_size: R,
    /// Of the sigma with C3, given A < 1: the inverse of beta at the level (1 - A)/((1 - A) b_qe + B b_qx), from
    /// 1 - tr + det > 0.
    pub by_contraction: R,
}

impl<R: Real> LeastSigma<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// Those of the repaired derivation. Hypotheses: C1 with K_alpha and Y_xx < 1. Unknown where a level is not certainly
    /// positive.
    #[must_use]
    pub fn repaired(problem: &impl Problem<R>, bounds: &PeriodicBounds<R>) -> LeastSigma<R> {
        let Numbers { period, c, alpha, .. } = problem.numbers();
        let by_size = reached(&bounds.state.e_p, &bounds.q(problem), |level| gains::beta_inverse(level, period));
        let k = gains::k_alpha(c, alpha, period);
        let [free, demand] = contraction_level(&bounds.contraction(problem, &k, 2, &R::int(1)));
        let by_contraction = reached(&free, &demand, |level| gains::beta_inverse(level, period));
        LeastSigma { by_size, by_contraction }
    }

    /// sigma_p*, the infimum of the sigma with both.
    #[must_use]
    pub fn sigma_p(&self) -> R {
        self.by_size.max(&self.by_contraction)
    }
}

/// The inverse of a gain at the level `size/demand`; 0 where nothing is demanded.
fn reached<R: Real>(size: &R, demand: &R, inverse: impl Fn(&R) -> R) -> R
where
    for<'a> &'a R: Operand<R>,
{
    if demand.is_zero() { R::int(0) } else { inverse(&(size / demand)) }
}

/// 1 - A and (1 - A) b_qe + B b_qx of the contraction matrix at an error gain of 1.
fn contraction_level<R: Real>(at_unit_gain: &ContractionMatrix<R>) -> [R; 2]
where
    for<'a> &'a R: Operand<R>,
{
    let free = R::int(1) - &at_unit_gain.xx;
    let demand = &free * &at_unit_gain.ee + &at_unit_gain.xe * &at_unit_gain.ex;
    [free, demand]
}
