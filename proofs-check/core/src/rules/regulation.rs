//! Exact regulation with infinitely many oscillators (docs/mathematics.md, sections 6, Theorem 2, and 10.6).
//!
//! Guarantee, for a matched base frequency: with n_o infinite, for every sigma' >= sigma, solutions from the claimed
//! set are bounded and x, e -> 0. S1-S3 are not used; the error box is around 0.

use super::gains::forcing;
use super::inequality::Inequality;
use super::joint;
use super::paths::Paths;
use super::set::{self, ClaimedSet};
use super::stability::{ErrorBox, distances, level};
use crate::bound::Bound;
use crate::data::Data;
use crate::interval::Interval;
use crate::json::Field;
use crate::verdict::{Condition, Outcome, invalid};
use rug::Rational;

/// The free numbers.
#[derive(Clone, Debug)]
pub struct Witness {
    pub pointer: String,
    pub sigma: Rational,
    /// sigma*_oo as it is written.
    pub sigma_text: String,
    pub d_x: Rational,
    pub d_e: Rational,
    pub w_x: Rational,
    pub h: Rational,
    pub paths: Paths,
}

impl Witness {
    /// Reads the part `exact_regulation`.
    pub fn read(field: &Field<'_>) -> Outcome<Witness> {
        field.object(|fields| {
            let sigma = fields.required("sigma_star_oo")?;
            let (sigma, sigma_text) = (sigma.rational()?, sigma.numeral()?.to_owned());
            let [d_x, d_e, w_x, h] = fields.numbers(["D_x", "D_e", "w_x", "h"])?;
            let (paths, pointer) = (Paths::read(fields)?, field.pointer.clone());
            Ok(Witness { pointer, sigma, sigma_text, d_x, d_e, w_x, h, paths })
        })
    }
}

/// `z_oo = (1/mu) sqrt(b_q_rms(0,0)^2/n_0 + (2/n_1)(T/2pi)^2 b_qt_rms(0,0)^2)`, or, where it is less and `q_0` is given, `(1/mu)[sqrt(C_0^2/n_0 + sum_{k>=1} 4 C_k^2/n_k) + sqrt(r_0^2/n_0 + (2/n_1)(T/2pi)^2 r_1^2)]`. With a gain b the internal
/// model puts out -q/b: b_lo mu stands for mu.
fn steady_state(d: &Data<'_>) -> Interval {
    let zero = d.int(0);
    let at = |which| d.bound(which, &zero, &zero);
    let time = d.period.only() / (Interval::pi(d.precision) * 2);
    let root = |q: &Interval, q_t: &Interval| (q.sqr() / &d.n_0 + (q_t * &time).sqr() * 2 / &d.n_1).sqrt();
    let generic = root(&at(Bound::QRms), &at(Bound::QtRms));
    let mu = d.gain.as_ref().map_or_else(|| d.mu.clone(), |gain| &gain.low * &d.mu);
    let Some(given) = &d.spec.q_0 else { return generic / mu };
    let (harmonics, [rest, rest_t]) = forcing(d, given);
    let weight = |k: u64| d.weight(k);
    let later = (1..).zip(&harmonics[1..]).fold(d.int(0), |sum, (k, c)| sum + c.sqr() * 4 / weight(k));
    let forced = (harmonics[0].sqr() / &d.n_0 + later).sqrt() + root(&rest, &rest_t);
    generic.least(&forced) / mu
}

/// Evaluates the conditions; only `matched` and the signs are decided yet. An inequality of the claim serves here too, where it is
/// about the same weights; with joint metrics the conditions by norms serve, or else theirs.
pub fn evaluate(
    d: &Data<'_>,
    set: &ClaimedSet,
    w: &Witness,
    stability: Option<&Inequality>,
) -> Outcome<Vec<Condition>> {
    if !d.spec.regulator.matched {
        return invalid("exact regulation", &w.pointer, "it needs base_frequency = 2 pi/period, asserted by `matched`");
    }
    let named = [("sigma_star_oo", &w.sigma), ("D_x", &w.d_x), ("D_e", &w.d_e), ("w_x", &w.w_x), ("h", &w.h)];
    set::positive(&named, &w.pointer)?;
    let [sigma, d_x, d_e, w_x, h] = named.map(|(_, value)| d.number(value));
    let zero = d.int(0);
    let error_box = ErrorBox::new(d, w.paths, [&zero, &zero], [&d_x, &d_e]);
    let reach = distances(d, set, [&zero, &zero, &steady_state(d)]);
    let largest = d.by_gain(|gain| &gain.high, &h);
    let [start, exit] = level(d, &reach, [&d_x, &d_e, &w_x, &largest]);
    let domain = set::domain(d, &d_x, &d_e);
    let mut conditions = domain.clone();
    conditions.push(Condition::less("C4", "level condition around the origin", start, exit));
    let place = (w.paths, [&zero, &zero], &error_box);
    conditions.extend(match stability.filter(|part| part.is_for([&w.w_x, &w.h])) {
        Some(part) => part.conditions(d, place, (&w.sigma, "sigma_oo")),
        None => error_box.conditions(error_box.decay(d, [&w_x, &h], &sigma), sigma, "sigma_oo"),
    });
    let by_norms = conditions.iter().all(|condition| condition.truth() == Some(true));
    Ok(match stability.and_then(|part| part.pair().map(|pair| (part, pair))).filter(|_| !by_norms) {
        Some((part, pair)) => {
            let levels = joint::levels(d, pair, &reach, [&w.d_x, &w.d_e]);
            domain.into_iter().chain(levels).chain(part.conditions(d, place, (&w.sigma, "sigma_oo"))).collect()
        }
        None => conditions,
    })
}
