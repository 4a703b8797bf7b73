//! Rules C1-C3: existence and size of the periodic solution (docs/mathematics.md, sections 3 and 4).

use crate::data::Data;
use crate::interval::Interval;
use crate::spec::Bound;

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
    /// qr = b_q_rms.
    pub qr: Interval,
    /// q1 = b_qt_rms + b_qx x1 + b_qe qr, x1 = b_f(X_p,0) + b_fxx X_p^2 + b_fe E_p.
    pub q1: Interval,
}

impl Existence {
    /// Evaluates the bounding functions. (X_p, E_p) must lie in the domain.
    pub fn new(d: &Data<'_>, x_p: Interval, e_p: Interval) -> Existence {
        let at = |which| d.bound(which, &x_p, &e_p);
        let at_zero = |which| d.bound(which, &x_p, &d.int(0));
        let (f_xx, f_e, q_e, q_x, qr) =
            (at_zero(Bound::Fxx), at(Bound::Fe), at(Bound::Qe), at(Bound::Qx), at(Bound::QRms));
        let x1 = at_zero(Bound::F) + &f_xx * x_p.sqr() + &f_e * &e_p;
        let q1 = at(Bound::QtRms) + &q_x * x1 + &q_e * &qr;
        let (f_box, f_ex, q, q_t) = (at(Bound::F), at(Bound::Fex), at(Bound::Q), at(Bound::Qt));
        Existence { f_box, f_e, f_xx, f_ex, q, q_e, q_x, q_t, qr, q1, x_p, e_p }
    }

    /// `(k/alpha)(b_fe E_p + b_fxx X_p^2/2)`, the left side of C1; k is c or K_alpha.
    pub fn invariance(&self, d: &Data<'_>, k: &Interval) -> Interval {
        k / &d.alpha * (&self.f_e * &self.e_p + &self.f_xx * self.x_p.sqr() / 2)
    }

    /// `(k/alpha) b_fxx X_p/2`, below 1 in C1.
    pub fn share(&self, d: &Data<'_>, k: &Interval) -> Interval {
        k / &d.alpha * &self.f_xx * &self.x_p / 2
    }

    /// The entries xx, xe, ex, ee of the contraction matrix: A with `factor` in front of b_fxx X_p, B, and the error
    /// gain (beta_s or beta) times b_qx, b_qe.
    pub fn contraction(&self, d: &Data<'_>, k: &Interval, factor: i64, error_gain: &Interval) -> [Interval; 4] {
        let gain = k / &d.alpha;
        let xx = &gain * (&self.f_ex * &self.e_p + &self.f_xx * &self.x_p * factor);
        [xx, gain * &self.f_e, error_gain * &self.q_x, error_gain * &self.q_e]
    }

    /// `Z^2 = (T/(2 mu) + kappa_0) qr^2 + kappa_1 q1^2`.
    pub fn z_squared(&self, d: &Data<'_>, kappa: &[Interval; 2]) -> Interval {
        (&d.period / (&d.mu * 2) + &kappa[0]) * self.qr.sqr() + &kappa[1] * self.q1.sqr()
    }

    /// The paper's `Z^2 = (T/mu + kappa_0 + 54 kappa_1 b_qe^2) b_q^2 + 3 kappa_1 (b_qt^2 + b_qx^2 b_f^2)`.
    pub fn z_squared_paper(&self, d: &Data<'_>, kappa: &[Interval; 2]) -> Interval {
        (&d.period / &d.mu + &kappa[0] + &kappa[1] * self.q_e.sqr() * 54) * self.q.sqr()
            + &kappa[1] * (self.q_t.sqr() + self.q_x.sqr() * self.f_box.sqr()) * 3
    }

    /// `(c/alpha) b_fe/(1 - (c/alpha) b_fxx X_p/2)`: sup|x| over sup|e|.
    pub fn x_gain(&self, d: &Data<'_>) -> Interval {
        &d.c / &d.alpha * &self.f_e / (1 - self.share(d, &d.c))
    }
}
