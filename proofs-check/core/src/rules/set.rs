//! Rules on the claimed initial set, the domain and the signs of the witness (docs/mathematics.md, sections 1 and 5).

use crate::constant::Constant;
use crate::data::Data;
use crate::interval::Interval;
use crate::spec::AskedSet;
use crate::verdict::{Condition, Outcome, invalid};
use rug::Rational;

/// The claimed set covers what the specification asks for. Differences of rationals are exact, so equality is decided.
pub fn covers(d: &Data<'_>, set: &[Rational; 3], [x_p, e_p]: [&Rational; 2], z: &Interval) -> Vec<Condition> {
    let exact = |required: &Rational, i: usize| d.number(&Rational::from(required - &set[i]));
    let twice = |value: &Rational, i| exact(&Rational::from(value * 2u32), i);
    // That a ball lies in the claimed set is decided exactly, with the claim.
    let ball = d.spec.plant.as_ref().is_some_and(|plant| plant.ball.is_some());
    let user = |constant: &Constant, i: usize| match constant.rational() {
        Some(required) => exact(&required, i),
        None => constant.enclose(d.precision) - d.number(&set[i]),
    };
    let mut excess = match &d.spec.initial_set {
        AskedSet::Paper => [twice(x_p, 0), twice(e_p, 1), (z + &d.n_bar * d.number(e_p)) * 2 - d.number(&set[2])],
        AskedSet::AtRest([x0, e0]) => [
            x0.as_ref().map_or_else(|| twice(x_p, 0), |x0| user(x0, 0)),
            e0.as_ref().map_or_else(|| twice(e_p, 1), |e0| user(e0, 1)),
            exact(&Rational::new(), 2),
        ],
        AskedSet::Box(given) => [0, 1, 2].map(|i| user(&given[i], i)),
    };
    if ball {
        excess[0] = exact(&Rational::new(), 0);
    }
    let what = |name| format!("the required {name} - the claimed {name} <= 0");
    let named = ["X0", "E0", "Z0"].into_iter().zip(excess);
    named.map(|(name, excess)| Condition::at_most("set", what(name), excess, d.int(0))).collect()
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
