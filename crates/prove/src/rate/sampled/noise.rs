//! Bounds of what noise and a disturbance do to the error of the law at samples, for one n_o (derivation, section 13.6).
//!
//! What is measured is e + v, and d is added to q: any measurable signals with |v| <= v_bar, |d| <= d_bar. By the form of [`sigmastar_decide::rates::at_samples`] with these
//! inputs W of what they add from 0 on stays below `e_low s^2`,
//! `s^2 = (g_d (1+g)^2 d_bar^2 + g_v v_bar^2 + g_r c_d^2 d_bar^2)/(c e_low)`, so that it moves e by at most s at the samples. Between them e is a straight
//! line and at most `(h/2) sup|q + d|` more, |q| <= k_x xi + k_e |e|, xi <= kappa sup|e|, kappa = sqrt(P_up) k_f/a_2: with
//!
//!   `S := (s + (h/2) d_bar)/(1 - (h/2)(k_e + k_x kappa))`,  the denominator being positive,
//!
//! it moves e by at most S at all times. The rest is as in [`crate::rate::noise`], L_0 being the left side of C4 at samples.
//!
//! Of a law that is computed in doubles ([`super::rounding`]) v_bar is that of the double that is measured, D is at most `(1+g) d_bar + b_hi du`, and
//! zs+ is moved by a vector of at most dz besides, which adds `sqrt(z_up) dz` to the root of W. With I what the inputs add to W in a sample and a
//! level with `sqrt((level^2 + I)/(1+c)) + sqrt(z_up) dz <= level`, that root stays below the level, and s is `level/sqrt(e_low)`.

use super::bound::{DIGITS, Proposal};
use super::condition::SampledCondition;
use super::rounding::{
    Computed, ComputedLaw, Rounded, RoundingWitness, are_zeta_bounds, largest_of_zeta, measured, settled, zeta_bounds,
};
use crate::rate::bound::Place;
use crate::rate::descent::{Point, Thoroughness, descend};
use crate::rate::noise::{Confinement, NoNoiseBound, NoiseBound};
use faer::linalg::solvers::DenseSolveCore;
use rug::Rational;
use sigmastar_decide::rates::OscillatorMatrix;
use sigmastar_decide::rates::at_samples::{Inputs, SampledDynamics, SampledRateWitness};
use sigmastar_decide::rates::inequality::{LoopBounds, is_above};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_f64, round_rational};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::sampled::SampledLaw;
use std::cell::Cell;

/// Shares of the c of the search that are claimed, in this order: what is left makes the form definite.
const SHARES: [f64; 3] = [0.99, 0.9, 0.6];

/// By what share the weights of the inputs may be above, and e_low below what is best.
const ROOM: f64 = 1e-3;

/// Digits of the numbers beside Pi.
const FIGURES: u32 = 6;

/// What is given away of what the scalar condition leaves over, tried in turn: g_r falls with it.
const SLACKS: [f64; 3] = [0.003, 0.05, 0.3];

/// Steps of a search in the rate, in the size of the inputs, and in their ratio.
const STEPS: [usize; 3] = [12, 8, 8];

/// Orders of Pi from which on fewer steps are made.
const LARGE: usize = 50;

/// What proves bounds under noise at samples.
#[derive(Clone, Debug)]
pub struct SampledNoise {
    /// What proves the form with inputs.
    pub witness: SampledRateWitness,
    /// What is proved besides of a law in doubles.
    pub rounding: Option<RoundingWitness>,
}

/// The best bounds that are found.
///
/// Guarantee: with n_o oscillators at the gain of `place`, the law and every input gain of the data, and any measurable inputs within the bounds
/// of the specification, every solution that is within the distances of `place` at a sampling instant t_0 has `|e(t) - e_per(t)| <= peak` at all times
/// t >= t_0, between samples too, and a limit superior of that of at most `limit`, e_per being of the periodic solution without inputs; whoever the
/// plant is of which the bounds of the error box hold. Where the specification says so the law is computed in doubles, by the operations of the
/// exported C code, and e_per is that of the loop without rounding.
///
/// # Errors
/// What was not found or not proved.
pub fn noise_bound(
    data: &Data<'_>,
    law: &SampledLaw<Enclosure>,
    place: &Place<'_>,
    confinement: &Confinement<'_>,
    n_o: u32,
) -> Result<NoiseBound<SampledNoise>, NoNoiseBound> {
    let in_doubles = data.spec.disturbances.in_doubles();
    if data.spec.actuator.is_some() {
        return Err(if in_doubles { NoNoiseBound::ActuatorInDoubles } else { NoNoiseBound::Actuator });
    }
    let not_found = NoNoiseBound::NotFound;
    let bounds = LoopBounds::of_error(data, place.error_box).ok_or(not_found)?;
    let oscillators = OscillatorMatrix::new(data, n_o);
    let dynamics = SampledDynamics::new(data, (&oscillators, law), place.sigma, &bounds).ok_or(not_found)?;
    let number = |value: &Rational| data.rational(value);
    let d_bar = number(&data.spec.d_bar());
    let v_bar = measured(data, &place.error_box.e_b);
    let computed = in_doubles.then(|| Computed {
        law: ComputedLaw::new(data, &dynamics),
        measured: &place.error_box.e_b + &v_bar,
        zeta: confinement.zeta.clone(),
        misled: &data.n_bar * &v_bar,
    });
    let sample = &dynamics.sample;
    let largest_gain = law.input_gain.as_ref().map(|gain| &gain.high);
    let acting = |control: &Enclosure| largest_gain.map_or_else(|| control.clone(), |gain| gain * control);
    // D: what a disturbance adds, and what rounding adds to u.
    let added = |control: Option<&Enclosure>| {
        let of_d = &sample.enlarged * &d_bar;
        control.map_or(of_d.clone(), |control| of_d + acting(control))
    };
    let disturbance = data.spec.d_bar().to_f64();
    let [enlarged, c_d] = [&sample.enlarged, &sample.c_d].map(Enclosure::upper_f64);
    let (sizes, moved) = match computed.as_ref().map(|computed| computed.rounded(&data.zero())) {
        None => ([disturbance, data.spec.v_bar().to_f64()], None),
        Some(Rounded { control, state }) => {
            ([disturbance + acting(&control).upper_f64() / enlarged, v_bar.upper_f64()], Some(state.upper_f64()))
        }
    };
    let strengths = Strengths { sizes, of_d: [enlarged * sizes[0], c_d * disturbance], moved };
    let search = Search::new(&dynamics, strengths).ok_or(not_found)?;
    let found = search.best().ok_or(not_found)?;
    let of = |share: &f64| DIGITS.iter().find_map(|digits| proved(&dynamics, &found, *share, *digits));
    let Proved { witness, e_low, of_zeta } = SHARES.iter().find_map(of).ok_or(not_found)?;

    let Inputs { g_d, g_v, g_r } = &witness.inputs;
    let weighed = |weight: &Option<Rational>, size: Enclosure| {
        weight.as_ref().map_or_else(|| data.zero(), |weight| number(weight) * size.sqr())
    };
    let inputs = |control: Option<&Enclosure>| {
        weighed(g_d, added(control)) + weighed(g_v, v_bar.clone()) + weighed(g_r, &sample.c_d * &d_bar)
    };
    let c = number(&witness.c);
    let rounding = match (&computed, of_zeta) {
        (Some(computed), Some(of_zeta)) => {
            Some(settled(computed, &c, of_zeta, |rounded| inputs(Some(&rounded.control)))?)
        }
        _ => None,
    };
    let at_samples = match &rounding {
        None => (inputs(None) / (c * number(&e_low))).sqrt(),
        Some(RoundingWitness { level, .. }) => number(level) / number(&e_low).sqrt(),
    };
    let error_box = place.error_box;
    let kappa = data.p_up.sqrt() * &error_box.k_f / &error_box.rate;
    let two = data.rational(&Rational::from(2));
    let half = &law.step / &two;
    let k_e = error_box.sector.below.max(&error_box.sector.above);
    let coupling = if bounds.has_x { &error_box.k_x * &kappa } else { data.zero() };
    let bracket = Enclosure::one(data.precision) - &half * (k_e + coupling);
    let s = (at_samples + half * d_bar) / &bracket;
    let peak = confinement.level.sqrt() + &s;
    let [d_x, d_e] = confinement.radii.map(number);
    let of_x = ((&confinement.level / number(confinement.w_x)).sqrt() + kappa * &s) / data.p_low.sqrt();
    if !(data.zero().lt(&error_box.rate).is_true() && data.zero().lt(&bracket).is_true()) {
        return Err(not_found);
    }
    if !(peak.lt(&d_e).is_true() && of_x.lt(&d_x).is_true()) {
        let needed = (&peak / d_e).max(&(of_x / d_x)).upper_f64();
        return Err(NoNoiseBound::LeavesBox { limit: s.upper_f64(), needed });
    }
    let up = |value: &Enclosure| {
        value.upper_rational().map(|upper| round_rational(&upper, FIGURES, Direction::Up)).ok_or(not_found)
    };
    Ok(NoiseBound { proof: SampledNoise { witness, rounding }, e_low, limit: up(&s)?, peak: up(&peak)? })
}

/// What is proved of the numbers of a search.
struct Proved {
    witness: SampledRateWitness,
    e_low: Rational,
    /// z_low and z_up; of a law in doubles.
    of_zeta: Option<[Rational; 2]>,
}

/// A witness with a share of the proposed c and Pi in so many digits, and e_low; proved.
fn proved(dynamics: &SampledDynamics<'_>, found: &Found, share: f64, digits: u32) -> Option<Proved> {
    let Proposal { c, pi, l_slope, l_hold, of_x } = &found.proposal;
    let scaled = Proposal { c: c * share, pi: pi.clone(), l_slope: *l_slope, l_hold: *l_hold, of_x: of_x.clone() };
    let round = |weight: f64| round_f64(weight * (1.0 + ROOM), FIGURES, Direction::Up);
    let weight = |weight: Option<f64>| match weight {
        None => Some(None),
        Some(weight) => round(weight).map(Some),
    };
    let Inputs { g_d, g_v, g_r } = found.inputs;
    let inputs = Inputs { g_d: weight(g_d)?, g_v: weight(g_v)?, g_r: weight(g_r)? };
    let witness = SampledRateWitness { inputs, ..scaled.in_digits(digits)? };
    let e_low = round_f64(found.e_low * (1.0 - ROOM), FIGURES, Direction::Down).filter(|e_low| *e_low > 0)?;
    let precision = dynamics.law.step.precision();
    let of_zeta = if found.rounds { Some(zeta_bounds(pi)?) } else { None };
    let between = of_zeta.as_ref().is_none_or(|of_zeta| are_zeta_bounds(&witness.pi, of_zeta, precision));
    let holds = dynamics.proves(&witness) && is_above(&witness.pi, &e_low, precision) && between;
    holds.then_some(Proved { witness, e_low, of_zeta })
}

/// The numbers of a proof in doubles.
struct Found {
    proposal: Proposal,
    inputs: Inputs<f64>,
    /// 1 over the first entry of the inverse of Pi.
    e_low: f64,
    /// s^2.
    square: f64,
    /// Whether the law rounds.
    rounds: bool,
}

/// The sizes of the inputs.
#[derive(Clone, Copy)]
struct Strengths {
    /// Of d, of which rounding is a part, and of v.
    sizes: [f64; 2],
    /// Of D, and c_d d_bar.
    of_d: [f64; 2],
    /// dz, where the law rounds.
    moved: Option<f64>,
}

struct Search {
    condition: SampledCondition,
    largest: f64,
    strengths: Strengths,
}

impl Search {
    fn new(dynamics: &SampledDynamics<'_>, strengths: Strengths) -> Option<Search> {
        let condition = SampledCondition::new(dynamics)?;
        let largest = condition.largest_rate()?;
        Some(Search { condition, largest, strengths })
    }

    /// About the least s: over the rate, the size of the inputs, with both over their ratio, and what is given away.
    fn best(&self) -> Option<Found> {
        let large = self.condition.order() > LARGE;
        let steps = if large { STEPS.map(|steps| steps / 3) } else { STEPS };
        let slack = Cell::new(SLACKS[0]);
        let cost = |point: Point, slack: f64| self.solve(point, slack).map_or(f64::INFINITY, |found| found.square);
        let settle = |at: Point| {
            let best = SLACKS.into_iter().min_by(|one, other| cost(at, *one).total_cmp(&cost(at, *other)));
            slack.set(best.unwrap_or_else(|| slack.get()));
        };
        let thoroughness = Thoroughness { steps, last: 6.0 };
        let at = descend(thoroughness, self.strengths.sizes, |point| cost(point, slack.get()), settle);
        self.solve(at, slack.get())
    }

    fn solve(&self, point: Point, slack: f64) -> Option<Found> {
        let rate = point.rate(self.largest);
        let multipliers = self.condition.multipliers(rate, slack)?;
        let Strengths { sizes: [d, v], of_d: [of_d, within], moved } = self.strengths;
        let [gam_d, gam_v] = point.weights(multipliers.room, self.strengths.sizes, self.condition.noise_gain);
        let system = self.condition.disturbed(rate, &multipliers, [gam_d, gam_v]);
        let pi = system.largest()?;
        let first = pi.partial_piv_lu().inverse()[(0, 0)];
        let inputs = Inputs {
            g_d: (d > 0.0).then_some(1.0 / gam_d),
            g_v: (v > 0.0).then_some(1.0 / gam_v),
            g_r: (within > 0.0 && multipliers.of_x.is_some()).then_some(multipliers.g_r),
        };
        let weighed = |weight: Option<f64>, size: f64| weight.map_or(0.0, |weight| weight * size * size);
        let level = weighed(inputs.g_d, of_d) + weighed(inputs.g_v, v) + weighed(inputs.g_r, within);
        let c = self.condition.c(rate);
        let square = match moved {
            None => level * first / c,
            Some(moved) => {
                let moved = largest_of_zeta(&pi)?.sqrt() * moved;
                let root = (moved * (1.0 + c) + (moved * moved * (1.0 + c) + c * level).sqrt()) / c;
                root * root * first
            }
        };
        let (l_slope, l_hold, of_x) = (multipliers.l_slope, multipliers.l_hold, multipliers.of_x);
        let proposal = Proposal { c, pi, l_slope, l_hold, of_x };
        let rounds = moved.is_some();
        (square.is_finite() && square > 0.0).then_some(Found { proposal, inputs, e_low: 1.0 / first, square, rounds })
    }
}
