//! What `q_0` gives: the harmonics of q(t,0,0), the response to them, and the rest (docs/mathematics.md, section 10.3).

use crate::bound::Bound;
use crate::data::Data;
use crate::interval::Interval;
use crate::spec::Forcing;

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
    let number = |size: &crate::spec::Size| size.enclose(d.precision);
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
