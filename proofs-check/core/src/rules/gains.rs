//! Gains of periodic linear equations: the internal model, the loop of e, the equation of x (docs/mathematics.md, sections 2, 3
//! and 10.2).

use crate::data::Data;
use crate::interval::Interval;
use rug::Rational;

/// kappa_0 = k0/w^2, kappa_1 = k1/w^4: the transfer bound in the units of omega.
pub fn kappas(d: &Data<'_>, k0: &Interval, k1: &Interval) -> [Interval; 2] {
    [k0 / d.w.sqr(), k1 / d.w.sqr().sqr()]
}

/// `beta_s(s) = sqrt((T/(2 s)) coth(s T/2))`: of a decay rate s > 0, from the root mean square of a T-periodic input to the
/// supremum. So `K2(a) = c beta_s(a)`.
pub fn beta_s(d: &Data<'_>, s: &Interval) -> Interval {
    let period = d.period.longest();
    (period * (s * period / 2).coth() / (s * 2)).sqrt()
}

/// `tau(sigma) = (1/sigma) sqrt(T^2/12 - (T/(2 sigma)) coth(sigma T/2) + 1/sigma^2)`, at most T^2/sqrt(720): sup|e| over rms(q').
pub fn tau(d: &Data<'_>, sigma: &Interval) -> Interval {
    let value = |y: &Interval| (twelfth(y) - zero_mean(y)) / y.sqr();
    scaled(d, sigma, 720, value) * d.period.longest().sqr()
}

/// `bt(sigma) = sqrt(beta_s^2 - 1/sigma^2)`, at most T/sqrt(12): sup|e| over rms(q).
pub fn bt(d: &Data<'_>, sigma: &Interval) -> Interval {
    scaled(d, sigma, 12, zero_mean) * d.period.longest()
}

fn twelfth(y: &Interval) -> Interval {
    Interval::rational(&Rational::from((1, 12)), y.precision())
}

/// `coth(y/2)/(2y) - 1/y^2 = bt^2/T^2`.
fn zero_mean(y: &Interval) -> Interval {
    (y / 2).coth() / (y * 2) - y.sqr().recip()
}

/// The root of a decreasing function of y = sigma T that is at most 1/most. It is taken at the two ends of y, with as many more
/// bits as the closed form may cancel.
fn scaled(d: &Data<'_>, sigma: &Interval, most: i64, square: impl Fn(&Interval) -> Interval) -> Interval {
    let y = sigma * d.period.longest();
    let (Some(lo), Some(hi)) = (y.lower(), y.upper()) else { return Interval::undefined(d.precision) };
    let range = d.int(0).hull(&d.int(most).sqrt().recip());
    let at = |y: &Rational| {
        let small = y.denom().significant_bits().saturating_sub(y.numer().significant_bits());
        let p = d.precision + 4 * small.min(1000) + 64;
        square(&Interval::rational(y, p)).max(&Interval::int(0, p)).sqrt().intersect(&range)
    };
    at(&lo).hull(&at(&hi)).round(d.precision)
}

/// `g_k = 1/(sigma + kap)` if kap <= sigma, else `1/(2 sqrt(sigma kap))`: rms(e) over the input of the loop with -kap e
/// (docs/mathematics.md, section 10.4). With a gain [`crate::gain::Gain::damped`].
pub fn damped(d: &Data<'_>, sigma: &Rational, kap: &Rational) -> Interval {
    if let Some(gain) = &d.gain {
        gain.damped(&d.number(sigma), &d.number(kap))
    } else if kap <= sigma {
        d.number(&Rational::from(sigma + kap)).recip()
    } else {
        (d.number(&Rational::from(sigma * kap)).sqrt() * 2).recip()
    }
}
