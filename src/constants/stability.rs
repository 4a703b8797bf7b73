//! Stability and domain of attraction (derivation, section 5): the quadratic form of C5 and its closed form.

use crate::data::{Bound, Data};
use crate::enclosure::{Enclosure, Truth};

/// The error box and what the plant's data give on it.
///
/// The periodic solution is bounded by (x_per, e_per), which is (0, 0) for exact regulation.
#[derive(Clone, Debug)]
pub struct ErrorBox {
    /// X_b = x_per + D_x.
    pub x_b: Enclosure,
    /// E_b = e_per + D_e.
    pub e_b: Enclosure,
    /// k_x = b_qx(X_b, E_b)/sqrt(P_low).
    pub k_x: Enclosure,
    /// k_e = b_qe(X_b, E_b).
    pub k_e: Enclosure,
    /// k_f = b_fe(X_b, E_b).
    pub k_f: Enclosure,
    /// gam = c [b_fxx(x_per,0) x_per + b_fex(x_per,e_per) e_per + b_fxx(X_b,e_per) D_x/2], in 1/time: what the
    /// nonlinearity takes from alpha.
    pub gamma: Enclosure,
}

impl ErrorBox {
    /// Evaluates the bounding functions on the error box |xt| <= D_x, |et| <= D_e around a periodic solution with
    /// sup|x| <= x_per, sup|e| <= e_per. Hypothesis: (X_b, E_b) lies in the domain.
    #[must_use]
    pub fn new(data: &Data<'_>, x_per: &Enclosure, e_per: &Enclosure, d_x: &Enclosure, d_e: &Enclosure) -> ErrorBox {
        let (x_b, e_b) = (x_per + d_x, e_per + d_e);
        let gamma = &data.c
            * (data.bound(Bound::Fxx, x_per, &data.zero()) * x_per
                + data.bound(Bound::Fex, x_per, e_per) * e_per
                + data.bound(Bound::Fxx, &x_b, e_per) * d_x / 2);
        ErrorBox {
            k_x: data.bound(Bound::Qx, &x_b, &e_b) / data.p_low.sqrt(),
            k_e: data.bound(Bound::Qe, &x_b, &e_b),
            k_f: data.bound(Bound::Fe, &x_b, &e_b),
            gamma,
            x_b,
            e_b,
        }
    }
}

/// (C5) by its closed form, for given weights w_x, h of the Lyapunov function
/// U = w_x xt'P_x xt + et^2 + h zt'N zt.
#[derive(Clone, Debug)]
pub struct DecayCondition {
    /// ht k_x^2, to be below `curvature`; ht = h/mu.
    pub coupling: Enclosure,
    /// 4 A = 4 w_x (alpha - gam).
    pub curvature: Enclosure,
    /// The threshold that sigma must exceed; meaningful when `coupling < curvature` is proved.
    pub sigma_threshold: Enclosure,
}

impl DecayCondition {
    /// `sigma > (1 + ht k_e)^2/(4 ht) + (w_x sqrt(P_up) k_f + k_x (1 + ht k_e)/2)^2 / (4A - ht k_x^2)`.
    ///
    /// Guarantee: with `coupling < curvature` and sigma above the threshold, U' <= -rho (xi^2 + et^2 + s^2) for some
    /// rho > 0 in the error box (complete the square in s, take the worst signs of u_x, u_e, phi).
    #[must_use]
    pub fn new(data: &Data<'_>, error_box: &ErrorBox, w_x: &Enclosure, h: &Enclosure) -> DecayCondition {
        let h_over_mu = h / &data.mu;
        let ErrorBox { k_x, k_e, k_f, gamma, .. } = error_box;
        let coupling = &h_over_mu * k_x.sqr();
        let curvature = 4 * (w_x * (&data.alpha - gamma));
        let one_plus = 1 + &h_over_mu * k_e;
        let cross = w_x * data.p_up.sqrt() * k_f + k_x * &one_plus / 2;
        let margin = &curvature - &coupling;
        // Where the margin is not proved positive the threshold has no meaning; undefined keeps it from being used.
        let share =
            if margin.is_positive().is_true() { cross.sqr() / margin } else { Enclosure::undefined(data.precision) };
        let sigma_threshold = one_plus.sqr() / (4 * &h_over_mu) + share;
        DecayCondition { coupling, curvature, sigma_threshold }
    }

    /// Whether C5 holds at sigma.
    #[must_use]
    pub fn holds(&self, sigma: &Enclosure) -> Truth {
        match self.coupling.lt(&self.curvature) {
            Truth::True => self.sigma_threshold.lt(sigma),
            other => other,
        }
    }
}

/// The two sides of (C4): `w_x P_up dX^2 + dE^2 + h dZ^2 < min{w_x P_low D_x^2, D_e^2}`.
///
/// Guarantee: when it holds, the initial set lies in a sublevel set of U that lies in the error box.
#[must_use]
pub fn level_condition(
    data: &Data<'_>,
    distances: [&Enclosure; 3],
    [d_x, d_e, w_x, h]: [&Enclosure; 4],
) -> (Enclosure, Enclosure) {
    let [dist_x, dist_e, dist_z] = distances;
    let start = w_x * &data.p_up * dist_x.sqr() + dist_e.sqr() + h * dist_z.sqr();
    let exit = (w_x * &data.p_low * d_x.sqr()).min(&d_e.sqr());
    (start, exit)
}
