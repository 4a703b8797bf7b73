//! Existence and size of the periodic solution by C1-C3, as the paper and the repaired derivation have them (docs/mathematics.md,
//! sections 3 and 4).

use proofs_core::bound::Bound;
use proofs_core::data::Data;
use proofs_core::interval::Interval;

/// The bounding functions at (X_p, E_p), b_f and b_fxx at (X_p, 0), and what follows.
pub struct Existence {
    pub x_p: Interval,
    pub e_p: Interval,
    pub f_box: Interval,
    pub f_e: Interval,
    pub f_xx: Interval,
    pub f_ex: Interval,
    pub q: Interval,
    pub q_e: Interval,
    pub q_x: Interval,
    pub q_t: Interval,
}

impl Existence {
    /// Evaluates the bounding functions. (X_p, E_p) must lie in the domain.
    pub fn new(d: &Data<'_>, x_p: Interval, e_p: Interval) -> Existence {
        let at = |which| d.bound(which, &x_p, &e_p);
        let [f_box, f_e, f_ex] = [Bound::F, Bound::Fe, Bound::Fex].map(at);
        let [q, q_e, q_x, q_t] = [Bound::Q, Bound::Qe, Bound::Qx, Bound::Qt].map(at);
        let f_xx = d.bound(Bound::Fxx, &x_p, &d.int(0));
        Existence { f_box, f_e, f_xx, f_ex, q, q_e, q_x, q_t, x_p, e_p }
    }

    /// `(k/alpha)(b_fe E_p + b_fxx X_p^2/2)`, the left side of C1; k is c or K_alpha.
    pub fn invariance(&self, d: &Data<'_>, k: &Interval) -> Interval {
        k / &d.alpha * (&self.f_e * &self.e_p + &self.f_xx * self.x_p.sqr() / 2)
    }

    /// The entries xx, xe, ex, ee of the contraction matrix: A with 2 in front of b_fxx X_p, B, and the error
    /// gain (beta_s or beta) times b_qx, b_qe.
    pub fn contraction(&self, d: &Data<'_>, k: &Interval, error_gain: &Interval) -> [Interval; 4] {
        let gain = k / &d.alpha;
        let xx = &gain * (&self.f_ex * &self.e_p + &self.f_xx * &self.x_p * 2);
        [xx, gain * &self.f_e, error_gain * &self.q_x, error_gain * &self.q_e]
    }

    /// The paper's `Z^2 = (T/mu + kappa_0 + 54 kappa_1 b_qe^2) b_q^2 + 3 kappa_1 (b_qt^2 + b_qx^2 b_f^2)`.
    pub fn z_squared_paper(&self, d: &Data<'_>, kappa: &[Interval; 2]) -> Interval {
        (d.period.only() / &d.mu + &kappa[0] + &kappa[1] * self.q_e.sqr() * 54) * self.q.sqr()
            + &kappa[1] * (self.q_t.sqr() + self.q_x.sqr() * self.f_box.sqr()) * 3
    }
}
