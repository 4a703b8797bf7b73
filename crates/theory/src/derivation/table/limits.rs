//! The limits x_p* and e_p*(X_p) below which the paper's existence proof works; the sharp one has none.

use super::common::Common;
use super::{At, Entry, Row, Status, Value, row};
use crate::data::{Bound, Data, Problem};
use crate::derivation::existence::PeriodicBounds;
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};

pub(super) fn size_rows(data: &Data<'_>, common: &Common<'_>) -> Vec<Row> {
    let k = &common.k_alpha;
    let entry = |value| Entry { value, status: Status::Sound, source: "P:prop:periodic_solution" };
    let [x, e] = [largest_x(data, &(k * 2)), largest_e(data, k, &common.bounds)].map(|value| value.map(entry));
    vec![row("x_p*", At::Data, x.clone(), x, None), row("e_p*(X_p)", At::Common, e.clone(), e, None)]
}

/// Encloses the largest argument below `limit` with `holds`, for a property that is true below a threshold, by
/// bisection on certain answers; `None` if it does not certainly hold near 0.
fn threshold(data: &Data<'_>, limit: Option<Rational>, holds: impl Fn(&Enclosure) -> Truth) -> Option<Value> {
    let at = |value: &Rational| holds(&data.rational(value));
    let mut high = limit.clone().unwrap_or_else(|| Rational::from(1) << 200);
    if at(&high).is_true() {
        return Some(Value::Unavailable(if limit.is_some() {
            "the whole domain".to_owned()
        } else {
            "unbounded".to_owned()
        }));
    }
    if !at(&high).is_false() {
        return Some(Value::Unavailable("not decided".to_owned()));
    }
    let mut low = Rational::from(&high >> 400);
    if !at(&low).is_true() {
        return Some(Value::Unavailable("no positive value".to_owned()));
    }
    // First in the exponent: both ends of the answer lie between these.
    while high > Rational::from(&low * 2u32) {
        let exponent = |q: &Rational| i64::from(q.numer().significant_bits()) - i64::from(q.denom().significant_bits());
        let shift = ((exponent(&high) - exponent(&low)) / 2).clamp(1, 400) as u32;
        let middle = Rational::from(&low << shift);
        if middle >= high {
            break;
        }
        match at(&middle) {
            Truth::True => low = middle,
            Truth::False => high = middle,
            // The threshold itself, or next to it.
            Truth::Undecided => {
                let (half, double) = (Rational::from(&middle >> 1), Rational::from(&middle << 1));
                if at(&half).is_true() && at(&double).is_false() {
                    (low, high) = (half, double);
                }
                break;
            }
        }
    }
    // Then in the mantissa, the last number at which it certainly holds and the first at which it certainly does not: at the
    // threshold itself, which may be a number that is met, neither is certain.
    let last = halve(low.clone(), high.clone(), |middle| at(middle).is_true());
    let first = halve(low, high, |middle| !at(middle).is_false());
    Some(Value::Number(Enclosure::new(data.rational(&last.0).lower(), data.rational(&first.1).upper())))
}

/// Sixty-four halvings of [low, high], in which `below` is true below a number and false above.
fn halve(mut low: Rational, mut high: Rational, below: impl Fn(&Rational) -> bool) -> (Rational, Rational) {
    for _ in 0..64 {
        let middle = Rational::from(&low + &high) / 2u32;
        if below(&middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    (low, high)
}

/// The X with `gain b_fxx(X,0) X = alpha`: x_p* with gain 2 K_alpha.
fn largest_x(data: &Data<'_>, gain: &Enclosure) -> Option<Value> {
    let limit = data.spec.domain.as_ref().and_then(|domain| domain.x.as_rational().cloned());
    threshold(data, limit, |x| (gain * data.bound(Bound::Fxx, x, &data.zero()) * x).lt(&data.alpha))
}

/// The largest E with the two conditions of e_p*(X_p), gain K_alpha.
fn largest_e(data: &Data<'_>, gain: &Enclosure, bounds: &PeriodicBounds<Enclosure>) -> Option<Value> {
    let limit = data.spec.domain.as_ref().and_then(|domain| domain.e.as_rational().cloned());
    let x_p = &bounds.state.x_p;
    let invariance = &data.alpha / gain * x_p - &bounds.state.f_xx * x_p.sqr() / 2;
    let contraction = &data.alpha / gain - &bounds.state.f_xx * x_p * 2;
    threshold(data, limit, |e| {
        (e * data.bound(Bound::Fe, x_p, e)).le(&invariance).and((e * data.bound(Bound::Fex, x_p, e)).lt(&contraction))
    })
}
