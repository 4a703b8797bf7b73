//! Rules on the claimed initial set, the domain and the signs of the witness (docs/mathematics.md, sections 1 and 5).

use crate::constant::Constant;
use crate::data::Data;
use crate::interval::Interval;
use crate::spec::AskedSet;
use crate::verdict::{Condition, Outcome, invalid};
use rug::Rational;

/// The initial conditions of a claim: |x| <= x0, |e| <= e0, and |z|_N <= z0; without z0 the regulator sets z = M e at its first
/// instant (section 13.7).
#[derive(Clone, Debug)]
pub struct ClaimedSet {
    pub x0: Rational,
    pub e0: Rational,
    pub z0: Option<Rational>,
}

/// The claimed set covers what the specification asks for. Differences of rationals are exact, so equality is decided.
pub fn covers(d: &Data<'_>, set: &ClaimedSet, [x_p, e_p]: [&Rational; 2], z: &Interval) -> Vec<Condition> {
    let exact = |required: &Rational, claimed: &Rational| d.number(&Rational::from(required - claimed));
    let twice = |value: &Rational, claimed| exact(&Rational::from(value * 2u32), claimed);
    // That a ball lies in the claimed set is decided exactly, with the claim.
    let ball = d.spec.plant.as_ref().is_some_and(|plant| plant.ball.is_some());
    let user = |constant: &Constant, claimed: &Rational| match constant.rational() {
        Some(required) => exact(&required, claimed),
        None => constant.enclose(d.precision) - d.number(claimed),
    };
    let [of_x, of_e] = match &d.spec.initial_set {
        AskedSet::Paper => [None, None],
        AskedSet::AtRest([x0, e0]) | AskedSet::Aligned([x0, e0]) => [x0.as_ref(), e0.as_ref()],
        AskedSet::Box([x0, e0, _]) => [Some(x0), Some(e0)],
    };
    let excess_x = match of_x {
        _ if ball => d.int(0),
        Some(x0) => user(x0, &set.x0),
        None => twice(x_p, &set.x0),
    };
    let excess_e = of_e.map_or_else(|| twice(e_p, &set.e0), |e0| user(e0, &set.e0));
    let excess_z = match (&d.spec.initial_set, &set.z0) {
        (AskedSet::Aligned(_), None) => None,
        (AskedSet::Paper, Some(z0)) => Some((z + &d.n_bar * d.number(e_p)) * 2 - d.number(z0)),
        (AskedSet::AtRest(_), Some(z0)) => Some(exact(&Rational::new(), z0)),
        (AskedSet::Box([_, _, asked]), Some(z0)) => Some(user(asked, z0)),
        // One starts with z = M e, the other does not: they are not compared, and 1 <= 0 is false.
        (AskedSet::Aligned(_), Some(_)) | (_, None) => Some(d.int(1)),
    };
    let what = |name| format!("the required {name} - the claimed {name} <= 0");
    let named = [("X0", Some(excess_x)), ("E0", Some(excess_e)), ("Z0", excess_z)];
    let demanded = named.into_iter().filter_map(|(name, excess)| Some((name, excess?)));
    demanded.map(|(name, excess)| Condition::at_most("set", what(name), excess, d.int(0))).collect()
}

/// The largest arguments lie in the domain; without one the bounding functions hold everywhere.
pub fn domain(d: &Data<'_>, x: &Interval, e: &Interval) -> Vec<Condition> {
    d.spec.domain.as_ref().map_or_else(Vec::new, |[domain_x, domain_e]| {
        let at_most = |what, used: &Interval, end: &Constant| {
            Condition::at_most("domain", what, used.clone(), end.enclose(d.precision))
        };
        vec![at_most("largest X used <= domain X", x, domain_x), at_most("largest E used <= domain E", e, domain_e)]
    })
}

/// Every number named is positive.
pub fn positive(named: &[(&str, &Rational)], pointer: &str) -> Outcome<()> {
    match named.iter().find(|(_, value)| **value <= 0) {
        None => Ok(()),
        Some((name, value)) => {
            invalid("signs", &format!("{pointer}/{name}"), format!("0 < {name} fails: {name} = {value}"))
        }
    }
}
