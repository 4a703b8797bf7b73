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

/// kappa_0 = k0/w^2, kappa_1 = k1/w^4: the transfer bound in the units of omega.
pub fn kappas(d: &Data<'_>, k0: &Interval, k1: &Interval) -> [Interval; 2] {
    [k0 / d.w.sqr(), k1 / d.w.sqr().sqr()]
}

/// `K_alpha = c (e^{alpha T} - 1 + c) e^{-alpha T}`.
pub fn k_alpha(d: &Data<'_>) -> Interval {
    &d.c * (1 + (&d.c - 1) * (-(&d.alpha * &d.period)).exp())
}

/// `beta_s(sigma) = sqrt((T/(2 sigma)) coth(sigma T/2))`.
pub fn beta_s(d: &Data<'_>, sigma: &Interval) -> Interval {
    (&d.period * (sigma * &d.period / 2).coth() / (sigma * 2)).sqrt()
}

/// `tau(sigma) = (1/sigma) sqrt(T^2/12 - (T/(2 sigma)) coth(sigma T/2) + 1/sigma^2)`, at most T^2/sqrt(720).
///
/// In y = sigma T it is T^2 t(y) with a decreasing t; t is taken at the two ends of y, with as many more bits as the
/// closed form may cancel.
pub fn tau(d: &Data<'_>, sigma: &Interval) -> Interval {
    let y = sigma * &d.period;
    let most = d.int(720).sqrt().recip();
    let (Some(lo), Some(hi)) = (y.lower(), y.upper()) else { return Interval::undefined(d.precision) };
    let at = |y: &rug::Rational| {
        let small = y.denom().significant_bits().saturating_sub(y.numer().significant_bits());
        let p = d.precision + 4 * small.min(1000) + 64;
        let y = Interval::rational(y, p);
        let inside =
            Interval::rational(&rug::Rational::from((1, 12)), p) - (&y / 2).coth() / (&y * 2) + y.sqr().recip();
        (inside.max(&Interval::int(0, p)).sqrt() / y).intersect(&d.int(0).hull(&most))
    };
    let value = at(&lo).hull(&at(&hi)) * d.period.sqr();
    value.round(d.precision)
}
