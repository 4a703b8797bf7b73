//! What noise and a disturbance add to the error of some oscillators, from what they do from rest (docs/mathematics.md, section 13.6, Propositions N
//! and R_h).
//!
//! While a solution is in the error box, its difference to the periodic solution solves a linear system with slopes that are within the bounds
//! of C5; from a first exit on take those of the periodic solution. It is the sum of part 1, with the start and without inputs, and part 2, with
//! the inputs from rest. Of part 1 U does not exceed its start, at most L_0, and it tends to 0. Part 2 has |e_2| <= S and so
//! `xi_2 <= kappa S`, `kappa = sqrt(P_up) k_f/a_2`, for `xi' <= -a_2 xi + sqrt(P_up) k_f |e|`.
//!
//! Guarantee of [`prove`]: the sum stays in the box, `limit >= S` and `peak >= sqrt(L_0) + S`. A regulator that sets z = M e at its first instant
//! does so with the e that it measures: then zeta is M v there, within Nbar v_bar of 0.
//!
//! Where the regulator computes in doubles the e that it takes is one, the nearest to what is measured. In the box it is off by at most
//! `v_d = v_bar + u0 (E_b + v_bar) + 2^-1074`, u0 = 2^-53, which stands for v_bar everywhere.

use super::claimed::{Limits, RULE, Rate};
use super::norm::{positive, power};
use crate::actuator;
use crate::data::Data;
use crate::interval::Interval;
use crate::rules::common::Free;
use crate::rules::stability::{ErrorBox, level};
use crate::verdict::{Condition, Outcome, Verdict, finding, invalid};
use rug::Rational;

/// Where a claim says something of noise, the file has some, and no actuator, for the bound of what is put out does not know it.
pub fn demand_noise(d: &Data<'_>, claimed: &[Rate<'_>], at_samples: bool) -> Outcome<()> {
    let Some(Limits { pointer, .. }) = claimed.iter().find_map(|rate| rate.noise.as_ref()) else { return Ok(()) };
    if d.spec.noise.is_none(at_samples) {
        let rounds = if d.spec.noise.is_rounded(true) { "; rounding counts at samples alone" } else { "" };
        return invalid(RULE, pointer, format!("the file states no noise and no disturbance{rounds}"));
    }
    if d.spec.actuator.is_some() {
        let message = "with an actuator nothing is proved of noise: the bound of what is put out does not know it";
        return Err(finding(Verdict::Undecided, actuator::RULE, pointer, message));
    }
    Ok(())
}

/// What is known of the solutions of a claim with some oscillators before anything is said of what noise does from rest.
pub struct Known {
    /// The most that a measurement is off: v_bar, or v_d.
    pub off: Interval,
    /// L_0.
    pub start: Interval,
    /// Z + sqrt(L_0/eta_w), which bounds |zeta|_N but for what noise adds: U has eta_w |zeta|_N^2, with an input gain b eta, b_lo eta at least.
    pub zeta: Interval,
    /// E_b, which bounds |e| in the error box.
    pub e_b: Interval,
}

impl Known {
    /// Of solutions that begin so far from the periodic one, without noise, of which |zeta|_N is at most `z`; of a claim at samples, or in continuous time.
    pub fn new(
        d: &Data<'_>,
        free: &Free,
        (mut reach, z): ([Interval; 3], &Interval),
        (e_b, at_samples): (&Interval, bool),
    ) -> Known {
        let v_bar = d.number(&d.spec.noise.v_bar());
        let off = if d.spec.noise.is_rounded(at_samples) { of_doubles(d, [&v_bar, e_b]) } else { v_bar };
        if free.set.z0.is_none() {
            reach[2] = &reach[2] + &d.n_bar * &off;
        }
        let [d_x, d_e, w_x, h] = [&free.d_x, &free.d_e, &free.w_x, &free.h].map(|value| d.number(value));
        let [start, _] = level(d, &reach, [&d_x, &d_e, &w_x, &d.by_gain(|gain| &gain.high, &h)]);
        let zeta = z + (&start / d.by_gain(|gain| &gain.low, &h)).sqrt();
        Known { off, start, zeta, e_b: e_b.clone() }
    }
}

/// v_d, of a double that is the nearest to what is measured where |e| <= e_b.
pub(super) fn of_doubles(d: &Data<'_>, [v_bar, e_b]: [&Interval; 2]) -> Interval {
    v_bar + power(d, -53) * (e_b + v_bar) + power(d, -1074)
}

/// kappa, with a_2 > 0.
pub fn of_states(d: &Data<'_>, error_box: &ErrorBox, pointer: &str) -> Outcome<Interval> {
    let a_2 = &error_box.rate;
    Condition::less("N", "0 < a_2", d.int(0), a_2.clone()).demand(RULE, pointer)?;
    Ok(d.p_up.sqrt() * &error_box.k_f / a_2)
}

/// Proves what is claimed from S and kappa; `pointer` is the place of the witness.
pub fn prove(
    d: &Data<'_>,
    (free, known): (&Free, &Known),
    claimed: &Limits<'_>,
    [s, kappa]: [&Interval; 2],
    pointer: &str,
    lines: &mut Vec<String>,
) -> Outcome<()> {
    let [d_x, d_e, w_x] = [&free.d_x, &free.d_e, &free.w_x].map(|value| d.number(value));
    let largest = known.start.sqrt() + s;
    let of_x = ((&known.start / w_x).sqrt() + kappa * s) / d.p_low.sqrt();
    let [limit, peak] = [&claimed.limit, &claimed.peak].map(|value| d.number(value));
    let conditions = [
        (Condition::at_most("N", "S <= limit", s.clone(), limit), format!("{}/limit", claimed.pointer)),
        (Condition::at_most("N", "sqrt(L_0) + S <= peak", largest.clone(), peak), format!("{}/peak", claimed.pointer)),
        (Condition::less("N", "sqrt(L_0) + S < D_e", largest, d_e), pointer.to_owned()),
        (Condition::less("N", "(sqrt(L_0/w_x) + kappa S)/sqrt(P_low) < D_x", of_x, d_x), pointer.to_owned()),
    ];
    lines.extend(conditions.iter().map(|(condition, _)| condition.line()));
    conditions.iter().try_for_each(|(condition, place)| condition.demand(RULE, place))
}

/// The multiplier of an input, above 0, exactly where there is such an input: none where there is not.
pub fn weight(
    d: &Data<'_>,
    (name, multiplier): (&str, Option<&Rational>),
    is_there: bool,
    pointer: &str,
) -> Outcome<Option<Interval>> {
    match (multiplier, is_there) {
        (None, false) => Ok(None),
        (Some(value), true) => positive(name, value, pointer).map(|()| Some(d.number(value))),
        (None, true) => invalid(RULE, pointer, format!("`{name}` is missing, and there is such an input")),
        (Some(_), false) => invalid(RULE, &format!("{pointer}/{name}"), "there is no such input"),
    }
}

/// What an input of this bound adds to W in a step, or per time.
pub fn added(d: &Data<'_>, weight: Option<&Interval>, bound: &Interval) -> Interval {
    weight.map_or_else(|| d.int(0), |weight| weight * bound.sqr())
}
