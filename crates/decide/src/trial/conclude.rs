//! The tube theorem (derivation, 14.4): what (14.4a), (14.4b) and the defects say of the periodic solution.

use super::curves::{Trial, of_wave};
use crate::bounds::StatesForm;
use crate::linear::{Fineness, Harmonics, Loop, PRECISION, supremum};
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
    /// kappa_0 and kappa_1, proved for every number of oscillators.
    pub kappas: &'a [Enclosure; 2],
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

fn exact(value: &Rational) -> Enclosure {
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
        let Known { own, period, .. } = known;
        let (Metric { cross, k_p, c_x, c_e, c_y, .. }, Level { p_up, .. }) = proof.forms.first()?;
        // Without (14.4b) nothing is known of states.
        let has_states = !trial.states().mean.is_empty();
        if !trial.is_admissible() || has_states != proof.states.is_some() || trial.or_more != proof.or_more.is_some() {
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
        let (s_x, of_x) = match &proof.states {
            None => (Enclosure::zero(PRECISION), Enclosure::zero(PRECISION)),
            Some(StatesForm { q_low, q_up, c, gamma, .. }) => {
                let [q_low, q_up, c, gamma] = [q_low, q_up, c, gamma].map(exact);
                let inner = gamma * s_e.sqr() + q_up.sqr() * d_x.sqr() / &c;
                ((&q_up / (q_low * &c) * inner).sqrt(), (&all / exact(c_x)).sqrt())
            }
        };
        let inside = [&s_x, &s_e].into_iter().zip(&proof.radii).zip([proof.states.is_some(), true]);
        let is_inside = |((distance, end), asked): ((&Enclosure, &Rational), bool)| {
            !asked || distance.lt(&exact(end)) == Truth::True
        };
        if !inside.into_iter().all(is_inside) {
            return None;
        }
        let [low, high] = &own.gain;
        let one = || Enclosure::one(PRECISION);
        let [b_x, b_e] = proof.slopes.each_ref().map(exact);
        let b_e = b_e + &own.sigma * (high - one()).max(&(one() - low));
        let of_q = &b_x * &of_x + &b_e * &of_e + d_q;
        let swing = *period / (low * &own.mu * 2);
        let s_z = match &proof.or_more {
            None => (swing + largest_answer(trial, own)?).sqrt() * of_q,
            Some(OrMore { defect_t, in_time, states }) => {
                let [[b_qtx, b_qte], [b_fx, b_fe]] = [in_time, states].map(|pair| pair.each_ref().map(exact));
                let slope = b_qtx * &of_x + b_qte * &of_e + b_x * (b_fx * &of_x + b_fe * &of_e + d_x);
                let slope = slope + b_e * &of_y + exact(defect_t);
                let [kappa_0, kappa_1] = known.kappas.each_ref().map(|kappa| kappa / low.sqr());
                ((swing + kappa_0) * of_q.sqr() + kappa_1 * slope.sqr()).sqrt()
            }
        };

        let n_bar = own.n_bar_squared.sqrt();
        let control = supremum(&trial.scaled(|term| &term.control), fineness(trial))
            + trial.mismatch(own)
            + &own.sigma * &s_e
            + &own.mu * n_bar * &s_z;
        let zero = || Enclosure::zero(PRECISION);
        let mean_square = |harmonics: &Harmonics| {
            let squares = harmonics.iter().flatten().fold(zero(), |sum, wave| sum + wave.norm_squared());
            (squares * 2).sqrt()
        };
        let of_error = trial.scaled(|term| &term.error);
        let square = of_error.iter().fold(zero(), |sum, harmonics| sum + mean_square(harmonics));
        let [states, error, zeta] = Concluded::sizes_of(trial, known)?;
        let concluded = Concluded {
            error: error + &s_e,
            mean_square: square + of_e,
            control,
            states: states + &s_x,
            zeta: zeta + s_z,
            distances: [s_x, s_e],
        };
        let Concluded { error, mean_square, control, states, zeta, .. } = &concluded;
        let bounded = [error, mean_square, control, states, zeta].into_iter().all(Enclosure::is_bounded);
        bounded.then_some(concluded)
    }
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

/// How closely the sizes of curves are bounded: those of a family are sums.
fn fineness(trial: &Trial) -> Fineness {
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
        let of_y = ((&own.fundamental * k as i64).sqr() + own.sigma.sqr()).sqrt() * e.norm();
        beyond = beyond + own.poles(oscillators, k, 2).sqrt() * of_y / &own.fundamental * 2;
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
