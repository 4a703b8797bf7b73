//! Existence and size of the periodic solution (derivation, section 4).

use super::contraction::ContractionMatrix;
use super::gains;
use crate::data::{Bound, Data};
use crate::enclosure::Enclosure;

/// The bounding functions at (X_p, E_p), b_fxx at (X_p, 0), and the norms of the right sides that follow.
#[derive(Clone, Debug)]
pub struct PeriodicBounds {
    /// X_p.
    pub x_p: Enclosure,
    /// E_p.
    pub e_p: Enclosure,
    /// b_f(X_p, 0).
    pub f: Enclosure,
    /// b_f(X_p, E_p).
    pub f_at_box: Enclosure,
    /// b_fe(X_p, E_p).
    pub f_e: Enclosure,
    /// b_fxx(X_p, 0).
    pub f_xx: Enclosure,
    /// b_fex(X_p, E_p).
    pub f_ex: Enclosure,
    /// b_q(X_p, E_p).
    pub q: Enclosure,
    /// b_qe(X_p, E_p).
    pub q_e: Enclosure,
    /// b_qx(X_p, E_p).
    pub q_x: Enclosure,
    /// b_qt(X_p, E_p).
    pub q_t: Enclosure,
    /// qr = b_q_rms(X_p, E_p), a bound of rms(q).
    pub q_rms: Enclosure,
    /// x1 = b_f(X_p,0) + b_fxx X_p^2 + b_fe E_p, a bound of |x'|.
    pub x_rate: Enclosure,
    /// q1 = b_qt_rms + b_qx x1 + b_qe qr, a bound of rms(dq/dt) along the solution.
    pub q_rate_rms: Enclosure,
}

impl PeriodicBounds {
    /// Evaluates the bounding functions.
    ///
    /// Guarantee: when (X_p, E_p) lies in the domain, every member bounds what it says for all T-periodic (x, e) of
    /// the set |x| <= X_p, |e| <= E_p, |x'| <= x1, rms(e') <= qr.
    #[must_use]
    pub fn new(data: &Data<'_>, x_p: Enclosure, e_p: Enclosure) -> PeriodicBounds {
        let at_box = |which| data.bound(which, &x_p, &e_p);
        let at_zero_error = |which| data.bound(which, &x_p, &data.zero());
        let (f, f_xx, f_e) = (at_zero_error(Bound::F), at_zero_error(Bound::Fxx), at_box(Bound::Fe));
        let (q_e, q_x, q_rms) = (at_box(Bound::Qe), at_box(Bound::Qx), at_box(Bound::QRms));
        let x_rate = &f + &f_xx * x_p.sqr() + &f_e * &e_p;
        let q_rate_rms = at_box(Bound::QtRms) + &q_x * &x_rate + &q_e * &q_rms;
        PeriodicBounds {
            f_at_box: at_box(Bound::F),
            f_ex: at_box(Bound::Fex),
            q: at_box(Bound::Q),
            q_t: at_box(Bound::Qt),
            f,
            f_e,
            f_xx,
            q_e,
            q_x,
            q_rms,
            x_rate,
            q_rate_rms,
            x_p,
            e_p,
        }
    }

    /// The left side of (C1) and of P:12: `(k/alpha)(b_fe E_p + b_fxx X_p^2/2)`, to be at most X_p; k = c or K_alpha.
    #[must_use]
    pub fn invariance_lhs(&self, data: &Data<'_>, k: &Enclosure) -> Enclosure {
        k / &data.alpha * (&self.f_e * &self.e_p + &self.f_xx * self.x_p.sqr() / 2)
    }

    /// `(k/alpha) b_fxx X_p/2`, to be below 1 in (C1).
    #[must_use]
    pub fn quadratic_share(&self, data: &Data<'_>, k: &Enclosure) -> Enclosure {
        k / &data.alpha * &self.f_xx * &self.x_p / 2
    }

    /// The contraction matrix with gain k (c or K_alpha), `factor` 1 (sharp) or 2 (P:eq:def_ypsilon) in front of
    /// b_fxx X_p, and `error_gain` beta_s(sigma) or beta(sigma).
    #[must_use]
    pub fn contraction(
        &self,
        data: &Data<'_>,
        k: &Enclosure,
        factor: i64,
        error_gain: &Enclosure,
    ) -> ContractionMatrix {
        let gain = k / &data.alpha;
        ContractionMatrix {
            xx: &gain * (&self.f_ex * &self.e_p + factor * (&self.f_xx * &self.x_p)),
            xe: gain * &self.f_e,
            ex: error_gain * &self.q_x,
            ee: error_gain * &self.q_e,
        }
    }

    /// `Z^2 = (T/(2 mu) + kappa_0) qr^2 + kappa_1 q1^2` (derivation, section 4), with kappa in the units of omega.
    ///
    /// Guarantee: sup sqrt(zeta'N zeta) <= Z along the periodic solution, for every n_o and every sigma.
    #[must_use]
    pub fn z_squared_sharp(&self, data: &Data<'_>, kappa_0: &Enclosure, kappa_1: &Enclosure) -> Enclosure {
        (&data.period / (2 * &data.mu) + kappa_0) * self.q_rms.sqr() + kappa_1 * self.q_rate_rms.sqr()
    }

    /// The paper's `Z^2 = (T/mu + kappa_0 + 54 kappa_1 b_qe^2) b_q^2 + 3 kappa_1 (b_qt^2 + b_qx^2 b_f^2)`
    /// (proof of P:prop:periodic_solution): sound with sound kappas.
    #[must_use]
    pub fn z_squared_printed(&self, data: &Data<'_>, kappa_0: &Enclosure, kappa_1: &Enclosure) -> Enclosure {
        (&data.period / &data.mu + kappa_0 + 54 * (kappa_1 * self.q_e.sqr())) * self.q.sqr()
            + 3 * (kappa_1 * (self.q_t.sqr() + self.q_x.sqr() * self.f_at_box.sqr()))
    }
}

/// kappa_0 = k0/w^2 and kappa_1 = k1/w^4: the transfer bound in the units of omega.
#[must_use]
pub fn kappas(data: &Data<'_>, k0: &Enclosure, k1: &Enclosure) -> (Enclosure, Enclosure) {
    let w_squared = data.base_frequency.sqr();
    (k0 / &w_squared, k1 / w_squared.sqr())
}

/// The size of the periodic solution at a given sigma (derivation, section 4).
#[derive(Clone, Debug)]
pub struct PeriodicSolution {
    /// beta_s(sigma) qr.
    pub by_size: Enclosure,
    /// tau(sigma) q1.
    pub by_rate: Enclosure,
    /// e_per = min{E_p, beta_s qr, tau q1}.
    pub e_per: Enclosure,
    /// x_per = min{X_p, (c/alpha) b_fe e_per / (1 - (c/alpha) b_fxx X_p/2)}.
    pub x_per: Enclosure,
}

impl PeriodicSolution {
    /// Evaluates the bounds. Hypotheses: C1, C2, C3 hold at sigma. Guarantee: sup|e| <= e_per and sup|x| <= x_per for
    /// every sigma' >= sigma and every n_o.
    #[must_use]
    pub fn new(data: &Data<'_>, bounds: &PeriodicBounds, sigma: &Enclosure) -> PeriodicSolution {
        let by_size = gains::beta_s(sigma, &data.period) * &bounds.q_rms;
        let by_rate = gains::tau(sigma, &data.period) * &bounds.q_rate_rms;
        let e_per = bounds.e_p.min(&by_size).min(&by_rate);
        let x_per = bounds.x_p.min(&(x_per_gain(data, bounds) * &e_per));
        PeriodicSolution { by_size, by_rate, e_per, x_per }
    }
}

/// `(c/alpha) b_fe / (1 - (c/alpha) b_fxx X_p/2)`: sup|x| over sup|e| along the periodic solution, under C1.
#[must_use]
pub fn x_per_gain(data: &Data<'_>, bounds: &PeriodicBounds) -> Enclosure {
    // Lemma K of the derivation: c in place of K_alpha.
    let k = &data.c;
    k / &data.alpha * &bounds.f_e / (1 - bounds.quadratic_share(data, k))
}

/// The level below which the error gain (beta_s or beta) makes the contraction matrix a contraction:
/// `(1 - A) / ((1 - A) b_qe + B b_qx)` (from 1 - tr + det > 0 with A < 1); `None` where every gain does.
fn contraction_level(matrix_at_unit_gain: &ContractionMatrix) -> Option<Enclosure> {
    let free = 1 - &matrix_at_unit_gain.xx;
    let demand = &free * &matrix_at_unit_gain.ee + &matrix_at_unit_gain.xe * &matrix_at_unit_gain.ex;
    (demand != Enclosure::zero(2)).then(|| free / demand)
}

/// sigma_p* of the sharp derivation: the infimum of the sigma with C2 and C3 at (X_p, E_p),
/// `max{ min{beta_s^-1(E_p/qr), tau^-1(E_p/q1)}, beta_s^-1((1-A)/((1-A) b_qe + B b_qx)) }`.
///
/// Hypotheses: C1 and A < 1. Undefined where a level is not certainly positive.
#[must_use]
pub fn sigma_p_sharp(data: &Data<'_>, bounds: &PeriodicBounds) -> Enclosure {
    let zero = Enclosure::zero(2);
    let (qr, q1) = (&bounds.q_rms, &bounds.q_rate_rms);
    let by_size = if *qr == zero { data.zero() } else { gains::beta_s_inverse(&(&bounds.e_p / qr), &data.period) };
    let by_rate = if *q1 == zero { data.zero() } else { gains::tau_inverse(&(&bounds.e_p / q1), &data.period) };
    let unit = bounds.contraction(data, &data.c, 1, &Enclosure::one(data.precision));
    let by_contraction =
        contraction_level(&unit).map_or_else(|| data.zero(), |level| gains::beta_s_inverse(&level, &data.period));
    by_size.min(&by_rate).max(&by_contraction)
}

/// sigma_p* of the repaired derivation: the infimum of the sigma with `beta(sigma) b_q <= E` and a contraction.
///
/// Hypotheses: C1 with K_alpha and Y_xx < 1. Undefined where a level is not certainly positive.
#[must_use]
pub fn sigma_p_repaired(data: &Data<'_>, bounds: &PeriodicBounds) -> Enclosure {
    let by_size = if bounds.q == Enclosure::zero(2) {
        data.zero()
    } else {
        gains::beta_inverse(&(&bounds.e_p / &bounds.q), &data.period)
    };
    let k = gains::k_alpha(&data.c, &data.alpha, &data.period);
    let unit = bounds.contraction(data, &k, 2, &Enclosure::one(data.precision));
    let by_contraction =
        contraction_level(&unit).map_or_else(|| data.zero(), |level| gains::beta_inverse(&level, &data.period));
    by_size.max(&by_contraction)
}
