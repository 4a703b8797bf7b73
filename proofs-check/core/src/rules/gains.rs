//! Gains of periodic linear equations: the internal model, the loop of e, the equation of x (docs/mathematics.md, sections 2, 3
//! and 10.2). What `q_0` gives: the harmonics of q(t,0,0), the response to them, and the rest (section 10.3).

use crate::bound::Bound;
use crate::data::Data;
use crate::interval::Interval;
use crate::spec::{Forcing, Size};
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
/// (docs/mathematics.md, section 10.4). With a gain [`crate::input_gain::Gain::damped`].
pub fn damped(d: &Data<'_>, sigma: &Rational, kap: &Rational) -> Interval {
    if let Some(gain) = &d.gain {
        gain.damped(&d.number(sigma), &d.number(kap))
    } else if kap <= sigma {
        d.number(&Rational::from(sigma + kap)).recip()
    } else {
        (d.number(&Rational::from(sigma * kap)).sqrt() * 2).recip()
    }
}

/// What `q_0` gives at sigma: of the response to the harmonics, and of the rest.
pub struct Forced {
    /// C_0, C_1, ...
    pub harmonics: Vec<Interval>,
    pub sup_e: Interval,
    pub rms_e: Interval,
    /// rms of the derivative of the harmonics.
    pub rate: Interval,
    /// r_0, r_1.
    pub rest: [Interval; 2],
}

/// The numbers of `q_0` under their names in the derivation: C_k, r_0, r_1.
pub fn forcing(d: &Data<'_>, given: &Forcing) -> (Vec<Interval>, [Interval; 2]) {
    let number = |size: &Size| size.enclose(d.precision);
    let harmonics: Vec<Interval> = given.harmonics.iter().map(number).collect();
    let zero = d.int(0);
    // What follows from the other data bounds it too.
    let derived = d.bound(Bound::QtRms, &zero, &zero) + derivative(d, &harmonics);
    let rest_t = given.rest_t_rms.as_ref().map_or(derived.clone(), |rest_t| number(rest_t).least(&derived));
    (harmonics, [number(&given.rest_rms), rest_t])
}

/// `sqrt(sum_{k>=1} 2 (k Om C_k)^2)`.
fn derivative(d: &Data<'_>, harmonics: &[Interval]) -> Interval {
    twice_sum(d, harmonics, |k, c| (c * d.period.fastest() * k).sqr()).sqrt()
}

/// `2 sum_{k>=1} term(k, C_k)`.
pub fn twice_sum(d: &Data<'_>, harmonics: &[Interval], term: impl Fn(i64, &Interval) -> Interval) -> Interval {
    (1..).zip(harmonics.iter().skip(1)).fold(d.int(0), |sum, (k, c)| sum + term(k, c)) * 2
}

impl Forced {
    /// At sigma.
    pub fn new(d: &Data<'_>, sigma: &Interval, given: &Forcing) -> Forced {
        let (harmonics, rest) = forcing(d, given);
        let gain = |k: i64| sigma.sqr() + (d.period.slowest() * k).sqr();
        Forced {
            sup_e: d.of_error(twice_sum(d, &harmonics, |k, c| c / gain(k).sqrt())),
            rms_e: d.of_error(twice_sum(d, &harmonics, |k, c| c.sqr() / gain(k)).sqrt()),
            rate: derivative(d, &harmonics),
            harmonics,
            rest,
        }
    }

    /// `sqrt(C_0^2 + 2 sum C_k^2) + r_0`.
    pub fn rms(&self, d: &Data<'_>) -> Interval {
        self.with_mean(d, self.harmonics[0].sqr())
    }

    /// `sqrt(square + 2 sum C_k^2) + r_0`: the rms of the forcing with another square of its mean.
    pub fn with_mean(&self, d: &Data<'_>, square: Interval) -> Interval {
        (square + twice_sum(d, &self.harmonics, |_, c| c.sqr())).sqrt() + &self.rest[0]
    }
}
