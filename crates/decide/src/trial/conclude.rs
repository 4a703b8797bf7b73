//! The tube theorem (derivation, 14.4): what (14.4a), (14.4b) and the defects say of the periodic solution.

use super::curves::{Trial, of_wave};
use crate::bounds::{StatesForm, WithinSample};
use crate::linear::{Beyond, Fineness, Harmonics, Loop, PRECISION, supremum};
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_lang::plant::CurveTerm;
use sigmastar_lang::spec::{Level, Metric, OrbitCurve, TrigonometricVector};
use sigmastar_theory::transfer::Complex;

/// What is proved around a trial, each number a bound.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TubeProof {
    /// d_x and d_q.
    pub defects: [Rational; 2],
    /// D_x and D_e.
    pub radii: [Rational; 2],
    /// b_x and b_e.
    pub slopes: [Rational; 2],
    /// Forms with (14.4a) on the box; the first is that of the theorem.
    pub forms: Vec<(Metric, Level)>,
    /// (14.4b); none without states.
    pub states: Option<StatesForm>,
    /// For the trial of every larger number of oscillators, too.
    pub or_more: Option<OrMore>,
    /// What falls on a larger box.
    pub x_first: Option<XFirst>,
    /// At samples what each of the forms has there, with (14.6b) in the place of (14.4a); else nothing.
    pub within: Vec<WithinSample>,
}

/// Forms with (14.5a) on a larger box.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct XFirst {
    /// D_x' and D_e'.
    pub radii: [Rational; 2],
    /// eta.
    pub eta: Rational,
    /// The forms; one of them keeps solutions in the box.
    pub forms: Vec<(Metric, Level)>,
    /// S of each.
    pub splittings: Vec<Vec<Vec<Rational>>>,
}

/// What the corollary of 14.4 asks for besides, of the box around a trial: bounds, each at least 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OrMore {
    /// d_t.
    pub defect_t: Rational,
    /// b_qtx and b_qte.
    pub in_time: [Rational; 2],
    /// b_fx and b_fe.
    pub states: [Rational; 2],
}

/// What is known besides.
#[derive(Clone, Debug)]
pub struct Known<'a> {
    /// The loop; its coordinates are those of the norms.
    pub own: &'a Loop,
    /// T.
    pub period: &'a Enclosure,
    /// xb, of each member.
    pub orbit: &'a OrbitCurve,
    /// r.
    pub radius: &'a Rational,
    /// What is known of every number of oscillators.
    pub of_all: OfAllCounts<'a>,
}

/// What a trial for every larger number of oscillators rests on besides.
#[derive(Clone, Copy, Debug)]
pub enum OfAllCounts<'a> {
    /// kappa_0 and kappa_1, proved for every number.
    Continuous(&'a [Enclosure; 2]),
    /// At samples: the least weight of an oscillator below half of their number.
    AtSamples(&'a Enclosure),
}

/// Bounds of the periodic solution.
#[derive(Clone, Debug)]
pub struct Concluded {
    /// s_x and s_e, of the distances from the trial.
    pub distances: [Enclosure; 2],
    /// E_N, of |e|.
    pub error: Enclosure,
    /// Of the root mean square of e.
    pub mean_square: Enclosure,
    /// Of |u| of the law.
    pub control: Enclosure,
    /// X_N, of `|L^-1 (x - x_0)|`.
    pub states: Enclosure,
    /// Z_N, of `|zeta|_N`.
    pub zeta: Enclosure,
}

pub(super) fn exact(value: &Rational) -> Enclosure {
    Enclosure::from_rational(value, PRECISION)
}

/// The Euclidean norm.
pub(super) fn length(vector: &[Rational]) -> Enclosure {
    let squares = vector.iter().map(|entry| exact(entry).sqr());
    squares.fold(Enclosure::zero(PRECISION), |sum, square| sum + square).sqrt()
}

impl Concluded {
    /// The bounds of Theorem T; `None` where it says nothing: the box may be too small for them, or the trial is none.
    ///
    /// Hypotheses: the numbers of `proof` are decided, for this trial, sigma and every member of the plant, whose period is known; the formulas are smooth
    /// on the box. Guarantee: the loop of every member has exactly one T-periodic solution in its box, and that has these bounds.
    #[must_use]
    pub fn of(trial: &Trial, proof: &TubeProof, known: &Known<'_>) -> Option<Concluded> {
        let own = known.own;
        // Without (14.4b) nothing is known of states.
        let has_states = !trial.states().mean.is_empty();
        if !trial.is_admissible() || has_states != proof.states.is_some() {
            return None;
        }
        let off = match (&own.held, proof.within.first()) {
            (None, None) => Off::continuous(trial, proof, known)?,
            (Some(samples), Some(within)) => Off::at_samples(trial, (proof, within), known, samples)?,
            _ => return None,
        };
        let inside = [&off.x, &off.e].into_iter().zip(&proof.radii).zip([has_states, true]);
        let is_inside = |((distance, end), asked): ((&Enclosure, &Rational), bool)| {
            !asked || distance.lt(&exact(end)) == Truth::True
        };
        if !inside.into_iter().all(is_inside) {
            return None;
        }
        let n_bar = own.n_bar_squared.sqrt();
        // At samples the control is the mean of uhat over the sample that follows.
        let control = supremum(&trial.scaled(|term| &term.control), fineness(trial))
            + trial.mismatch(own)
            + &own.sigma * &off.e_at_law
            + &own.mu * n_bar * &off.zeta;
        let of_error = trial.scaled(|term| &term.error);
        let zero = Enclosure::zero(PRECISION);
        let square = of_error.iter().fold(zero, |sum, harmonics| sum + mean_square(harmonics));
        let [states, error, zeta] = Concluded::sizes_of(trial, known)?;
        let concluded = Concluded {
            error: error + &off.e,
            mean_square: square + off.e_mean_square,
            control,
            states: states + &off.x,
            zeta: zeta + off.zeta,
            distances: [off.x, off.e],
        };
        let Concluded { error, mean_square, control, states, zeta, .. } = &concluded;
        let bounded = [error, mean_square, control, states, zeta].into_iter().all(Enclosure::is_bounded);
        bounded.then_some(concluded)
    }
}

/// How far the periodic solution may be from the trial: not more than this, if that is inside the box.
pub(super) struct Off {
    /// s_x, of the states.
    pub(super) x: Enclosure,
    /// s_e, of e at all times; at samples with what e moves within one.
    pub(super) e: Enclosure,
    /// Of the root mean square of e.
    pub(super) e_mean_square: Enclosure,
    /// Of the e that the law has.
    pub(super) e_at_law: Enclosure,
    /// s_z, of `|zeta|_N`.
    pub(super) zeta: Enclosure,
}

impl Off {
    /// Theorem T.
    fn continuous(trial: &Trial, proof: &TubeProof, known: &Known<'_>) -> Option<Off> {
        let Known { own, period, .. } = known;
        let (Metric { cross, k_p, c_x, c_e, c_y, .. }, Level { p_up, .. }) = proof.forms.first()?;
        if trial.or_more != proof.or_more.is_some() {
            return None;
        }
        let [d_x, d_q] = proof.defects.each_ref().map(exact);
        let [c_e, c_y, k_p] = [c_e, c_y, k_p].map(exact);
        let of_states = match proof.states {
            Some(_) => exact(p_up).sqr() / exact(c_x) + length(cross).sqr() / &c_e,
            None => Enclosure::zero(PRECISION),
        };
        let all = d_x.sqr() * 4 * of_states + k_p.sqr() * d_q.sqr() / &c_y;
        let of_y = (&all / &c_y).sqrt();
        let next = &own.fundamental * i64::from(trial.oscillators.first_missing());
        let of_e = (&all / &c_e).sqrt().min(&(&of_y / (own.sigma.sqr() + next.sqr()).sqrt()));
        let s_e = (*period * &of_e * &of_y).sqrt();
        let of_x = proof.states.as_ref().map(|_| (&all / exact(c_x)).sqrt());
        let of_x = of_x.unwrap_or_else(|| Enclosure::zero(PRECISION));
        let [low, high] = &own.gain;
        let one = || Enclosure::one(PRECISION);
        let [b_x, b_e] = proof.slopes.each_ref().map(exact);
        let b_e = b_e + &own.sigma * (high - one()).max(&(one() - low));
        let of_q = &b_x * &of_x + &b_e * &of_e + d_q;
        let swing = *period / (low * &own.mu * 2);
        let zeta = match &proof.or_more {
            None => (swing + largest_answer(trial, own)?).sqrt() * of_q,
            Some(OrMore { defect_t, in_time, states }) => {
                let OfAllCounts::Continuous(kappas) = known.of_all else { return None };
                let [[b_qtx, b_qte], [b_fx, b_fe]] = [in_time, states].map(|pair| pair.each_ref().map(exact));
                let slope = b_qtx * &of_x + b_qte * &of_e + b_x * (b_fx * &of_x + b_fe * &of_e + &d_x);
                let slope = slope + b_e * &of_y + exact(defect_t);
                let [kappa_0, kappa_1] = kappas.each_ref().map(|kappa| kappa / low.sqr());
                ((swing + kappa_0) * of_q.sqr() + kappa_1 * slope.sqr()).sqrt()
            }
        };
        let x = of_states_from(proof.states.as_ref(), &s_e, &d_x);
        Some(Off { x, e_mean_square: of_e, e_at_law: s_e.clone(), e: s_e, zeta })
    }
}

/// s_x by (14.4b), of an error that is at most s_e and a defect of at most d_x.
pub(super) fn of_states_from(states: Option<&StatesForm>, s_e: &Enclosure, d_x: &Enclosure) -> Enclosure {
    let Some(StatesForm { q_low, q_up, c, gamma, .. }) = states else { return Enclosure::zero(PRECISION) };
    let [q_low, q_up, c, gamma] = [q_low, q_up, c, gamma].map(exact);
    let inner = gamma * s_e.sqr() + q_up.sqr() * d_x.sqr() / &c;
    (&q_up / (q_low * &c) * inner).sqrt()
}

impl Concluded {
    /// Bounds of `|L^-1 (xhat - x_0)|`, `|ehat|` and zhat, of a trial alone and all its members; `None` where it has more oscillators than the loop has
    /// weights.
    #[must_use]
    pub fn sizes_of(trial: &Trial, Known { own, orbit, radius, .. }: &Known<'_>) -> Option<[Enclosure; 3]> {
        let zeta = |term: &CurveTerm| Some(of_zeta(trial, own, term)? * trial.scale(&term.powers));
        let zero = Enclosure::zero(PRECISION);
        Some([
            supremum(&from_orbit(trial, orbit, own), Fineness::OF_STATES) + exact(radius),
            supremum(&trial.scaled(|term| &term.error), fineness(trial)),
            trial.terms.iter().try_fold(zero, |sum, term| Some(sum + zeta(term)?))?,
        ])
    }
}

/// The root mean square of a wave without a mean.
pub(super) fn mean_square(harmonics: &Harmonics) -> Enclosure {
    let zero = Enclosure::zero(PRECISION);
    let squares = harmonics.iter().flatten().fold(zero, |sum, wave| sum + wave.norm_squared());
    (squares * 2).sqrt()
}

/// How closely the sizes of curves are bounded: those of a family are sums.
pub(super) fn fineness(trial: &Trial) -> Fineness {
    if trial.terms.len() > 1 { Fineness::OF_SUMS } else { Fineness::FINE }
}

/// kappa_N of the first N, kappa_H of another set (14.7).
fn largest_answer(Trial { oscillators, .. }: &Trial, own: &Loop) -> Option<Enclosure> {
    let of_mu = (&own.gain[0] * &own.mu).sqr();
    let one =
        |l: u32, times: i64| Some(Enclosure::from_integer(times, PRECISION) / own.weights.get(l as usize)? / &of_mu);
    let beyond = match oscillators.n_o() {
        Some(n_o) => one(0, i64::from(n_o) + 1)?,
        None => one(0, 1)?.max(&(&own.n_bar_squared / own.fundamental.sqr())),
    };
    oscillators.beyond_mean().iter().try_fold(beyond, |largest, l| Some(largest.max(&one(*l, 2)?)))
}

/// zhat of one term.
fn of_zeta(trial: &Trial, own: &Loop, CurveTerm { error, control, .. }: &CurveTerm) -> Option<Enclosure> {
    let oscillators = &trial.oscillators;
    let (mut within, mut beyond) = (Enclosure::zero(PRECISION), Enclosure::zero(PRECISION));
    for (k, u) in of_wave(control).iter().enumerate().filter(|(k, _)| oscillators.meets(*k)) {
        let both = if k == 0 { 1 } else { 4 };
        within = within + u.norm_squared() / own.mu.sqr() / own.weights.get(k)? * both;
    }
    for (k, e) in of_wave(error).iter().enumerate().filter(|(k, _)| !oscillators.meets(*k)) {
        let Beyond { mean, zeta, .. } = own.beyond(oscillators, k);
        beyond = beyond + zeta * mean * e.norm() * 2;
    }
    Some(within.sqrt() + beyond)
}

/// The harmonics of `L^-1 (xhat - xb)`: what stands beside each power of delta, times the largest value of that.
fn from_orbit(trial: &Trial, orbit: &OrbitCurve, own: &Loop) -> Vec<Harmonics> {
    let zeros = vec![Rational::new(); own.inverse.len()];
    let minus = |a: &Vec<Rational>, b: &Vec<Rational>| -> Vec<Rational> {
        a.iter().zip(b).map(|(a, b)| Rational::from(a - b)).collect()
    };
    let mut apart: Vec<(Vec<u32>, TrigonometricVector)> =
        trial.terms.iter().map(|term| (term.powers.clone(), term.states.clone())).collect();
    for (which, part) in orbit.parts().enumerate() {
        // Of the nominal curve no power, of a sensitivity that of its parameter; the orbit does not move with the gain of the actuator.
        let powers: Vec<u32> = (1..=trial.intervals().count()).map(|i| u32::from(i == which)).collect();
        match apart.iter_mut().find(|(own, _)| *own == powers) {
            Some((_, states)) => *states = states.with(part, &zeros, minus),
            None => apart.push((powers, TrigonometricVector::constant(zeros.clone()).with(part, &zeros, minus))),
        }
    }
    let harmonics = |(powers, states): &(Vec<u32>, TrigonometricVector)| {
        let scale = trial.scale(powers);
        let row = |apart: &Vec<Rational>, row: &Vec<Rational>| {
            let sum = row.iter().zip(apart).fold(Rational::new(), |sum, (l, x)| sum + Rational::from(l * x));
            exact(&sum) * &scale
        };
        let all = states.map(|apart| own.inverse.iter().map(|of| row(apart, of)).collect::<Vec<_>>());
        let mean = all.mean.into_iter().map(Complex::real).collect();
        let pair = |[cos, sin]: [Vec<Enclosure>; 2]| {
            cos.into_iter().zip(sin).map(|(cos, sin)| Complex { re: cos / 2, im: sin / -2 }).collect()
        };
        std::iter::once(mean).chain(all.harmonics.into_iter().map(pair)).collect()
    };
    apart.iter().map(harmonics).collect()
}
