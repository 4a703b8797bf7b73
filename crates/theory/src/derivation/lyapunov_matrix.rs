//! The paper's quadratic form for stability: rho_0, the rho_ij, R and the threshold sigma_a.

use crate::data::{Bound, Numbers, Problem};
use sigmastar_exact::real::{Operand, Real};

/// rho_0, rho_11, rho_12, rho_22 and R of P:eq:R-lyap1, P:eq:R-lyap2.
#[derive(Clone, Debug)]
pub struct LyapunovMatrix<R> {
    /// rho_0, with its first bracket repaired where `repaired` (E3).
    pub rho_0: R,
    /// rho_11 = rho_0 + (h/mu) b_qx^2.
    pub rho_11: R,
    /// rho_12 = P_up b_fe + b_qx.
    pub rho_12: R,
    /// rho_22 = b_qe + (h/mu) b_qe^2.
    pub rho_22: R,
    /// alpha P_low - rho_11, to be positive.
    pub curvature: R,
    /// The exact threshold: R is positive definite if and only if sigma exceeds it (and `curvature` > 0).
    pub sigma_a: R,
    /// The printed threshold, with 2 in place of 4 (P:eq:ineq_bounds_sigma): sound, larger.
    pub sigma_a_printed: R,
}

/// Where rho_0 and the rho_ij are evaluated.
#[derive(Clone, Debug)]
pub struct LyapunovPoint<R> {
    /// X (x_a in the paper).
    pub x: R,
    /// E (e_a in the paper).
    pub e: R,
    /// X_b.
    pub x_b: R,
    /// E_b.
    pub e_b: R,
    /// h.
    pub h: R,
}

impl<R: Real> LyapunovMatrix<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// Evaluates the functions. `printed` takes rho_0 as in P:eq:def_rho_0, which is 2 P_low times too small in its
    /// first bracket (erratum E3); otherwise rho_0 = P_up [b_fxx X + b_fex E] + (P_up/2) b_fxx(X_b, E)(X_b + X).
    #[must_use]
    pub fn new(problem: &impl Problem<R>, point: &LyapunovPoint<R>, printed: bool) -> LyapunovMatrix<R> {
        let Numbers { p_low, p_up, alpha, mu, .. } = problem.numbers();
        let LyapunovPoint { x, e, x_b, e_b, h } = point;
        let first = problem.bound(Bound::Fxx, x, e) * x + problem.bound(Bound::Fex, x, e) * e;
        let second = problem.bound(Bound::Fxx, x_b, e) * (x_b + x);
        let rho_0 = if printed {
            p_up / (R::int(2) * p_low) * (first + p_low * second)
        } else {
            p_up * (first + second / R::int(2))
        };
        let (q_x, q_e) = (problem.bound(Bound::Qx, x_b, e_b), problem.bound(Bound::Qe, x_b, e_b));
        let h_over_mu = h / mu;
        let rho_11 = &rho_0 + &h_over_mu * q_x.sqr();
        let rho_12 = p_up * problem.bound(Bound::Fe, x_b, e_b) + q_x;
        let rho_22 = &q_e + h_over_mu * q_e.sqr();
        let curvature = alpha * p_low - &rho_11;
        let base = &rho_22 + mu / (R::int(2) * h);
        // Where the curvature is not proved positive there is no threshold.
        let share = if curvature.is_certainly_positive() { rho_12.sqr() / &curvature } else { R::unknown() };
        LyapunovMatrix {
            sigma_a: &base + &share / R::int(4),
            sigma_a_printed: base + share / R::int(2),
            rho_0,
            rho_11,
            rho_12,
            rho_22,
            curvature,
        }
    }

    /// The leading principal minors of R (Sylvester's criterion; P:16, P:17 and P:18 times mu) at sigma.
    #[must_use]
    pub fn leading_minors(&self, problem: &impl Problem<R>, sigma: &R, h: &R) -> [R; 3] {
        let (two, mu) = (R::int(2), &problem.numbers().mu);
        let first = two.clone() * &self.curvature;
        let excess = sigma - &self.rho_22;
        let second = two.clone() * (&first * &excess) - self.rho_12.sqr();
        let mu_h = mu * h;
        let third = &first * (two * (&excess * &mu_h) - mu.sqr()) - self.rho_12.sqr() * mu_h;
        [first, second, third]
    }
}
