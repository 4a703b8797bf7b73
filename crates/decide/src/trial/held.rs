//! The tube theorem at samples (derivation, 14.6): how far the periodic solution of the law at samples may be from a trial.
//!
//! Here uhat is what the control is in the mean over the sample that follows. Within a sample the control is held and uhat moves on, so that e leaves ehat by
//! `b int (u - uhat)`, which is 0 at both ends.

use super::conclude::{Known, OfAllCounts, Off, TubeProof, exact, fineness, mean_square, of_states_from};
use super::curves::Trial;
use crate::bounds::{StatesForm, WithinSample};
use crate::linear::{AtSamples, Harmonics, PRECISION, supremum};
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_lang::plant::CurveTerm;
use sigmastar_lang::spec::{Level, Metric};
use sigmastar_theory::transfer::Complex;

impl Off {
    /// Theorem T_s. It says nothing of a law with a delay, of metrics that join x and e, nor where the samples do not tell the harmonics of the trial and of the
    /// oscillators apart.
    pub(super) fn at_samples(
        trial: &Trial,
        (proof, WithinSample { lambda, gamma }): (&TubeProof, &WithinSample),
        known: &Known<'_>,
        AtSamples { samples, step, delayed }: &AtSamples,
    ) -> Option<Off> {
        let Known { own, period, .. } = known;
        let (Metric { cross, c_x, c_e, c_y, .. }, Level { p_up, .. }) = proof.forms.first()?;
        let apart = 2 * trial.degree().max(trial.oscillators.largest() as usize) < *samples as usize;
        let is_alone = cross.iter().all(|entry| *entry == 0) && proof.or_more.is_none() && proof.x_first.is_none();
        if *delayed || !apart || !is_alone {
            return None;
        }
        let zero = || Enclosure::zero(PRECISION);
        let one = || Enclosure::one(PRECISION);
        let is_positive = |value: &Enclosure| zero().lt(value) == Truth::True;
        let [low, high] = &own.gain;
        let [b_x, b_e] = proof.slopes.each_ref().map(exact);
        let [d_x, d_q] = proof.defects.each_ref().map(exact);
        let across = step / Enclosure::pi(PRECISION);
        let slope = trial.slope_of_control(&own.fundamental);
        // What the control moves within a sample has no mean there, and this root mean square at most.
        let d_w = high * &across * slope.iter().fold(zero(), |sum, harmonics| sum + mean_square(harmonics));
        let ripple = high * step.sqr() / 8 * supremum(&slope, fineness(trial));

        let of_states = match proof.states {
            Some(_) => exact(p_up).sqr() * d_x.sqr() * 2 / exact(c_x),
            None => zero(),
        };
        let of_ripple = exact(lambda) * (&across * &d_w).sqr() * 9 / 5;
        let all = exact(gamma) * d_q.sqr() + of_ripple + of_states;
        let of_y = (&all / exact(c_y)).sqrt();
        // By (14.4b): of_x is at most `answer of_e + rest`.
        let (answer, rest) = match &proof.states {
            None => (zero(), zero()),
            Some(StatesForm { q_up, c, gamma, .. }) => {
                let [q_up, c, gamma] = [q_up, c, gamma].map(exact);
                ((gamma / &c).sqrt(), q_up * &d_x / c)
            }
        };
        let mut of_e = (&all / exact(c_e)).sqrt();
        let left = one() - &across * (&b_e + &b_x * &answer);
        if is_positive(&left) {
            of_e = of_e.min(&((&of_y / &own.sigma + &across * (&b_x * &rest + &d_q + d_w)) / left));
        }
        let of_x = match proof.states {
            Some(_) => (&all * 2 / exact(c_x)).sqrt().min(&(answer * &of_e + rest)),
            None => zero(),
        };
        let e_at_law = (inverse_squares(trial, known, (*samples, step))?).sqrt() * &of_y;
        let of_q = &b_x * &of_x + &b_e * &of_e + d_q;
        let s_e = &e_at_law + ripple + (step * *period).sqrt() / 2 * &of_q;
        let x = of_states_from(proof.states.as_ref(), &s_e, &d_x);

        let gains = (high - one()).max(&(one() - low));
        let of_p = of_q + gains * &of_y;
        // 1 - b_hi K h N^2/2.
        let kept = one() - high * &own.mu * step * &own.n_bar_squared / 2;
        if !is_positive(&kept) {
            return None;
        }
        let swing = *period / (low * &own.mu * &kept * 2);
        let zeta = (swing + largest_answer(trial, known, (*samples, step, &kept))?).sqrt() * of_p;
        Some(Off { x, e_mean_square: of_e.min(&s_e), e: s_e, e_at_law, zeta })
    }
}

/// A bound of the sum of `1/(sigma^2 + a om_j^2)` over the harmonics of y: by `om_j >= 4 j/T`, which is `sin x >= 2 x/pi`, by the integral, and by sigma alone.
/// `None` where h sigma may be above 1.
fn inverse_squares(
    trial: &Trial,
    Known { own, period, .. }: &Known<'_>,
    (samples, step): (u32, &Enclosure),
) -> Option<Enclosure> {
    let one = || Enclosure::one(PRECISION);
    let a = one() - step * &own.sigma;
    let first = i64::from(trial.oscillators.first_missing());
    let squares = Enclosure::from_integer(i64::from(samples), PRECISION) / own.sigma.sqr();
    if Enclosure::zero(PRECISION).lt(&a) != Truth::True {
        return (Enclosure::zero(PRECISION).le(&a) == Truth::True).then_some(squares);
    }
    let by_order = period.sqr() / (&a * 8) * (one() / (first * first) + one() / first);
    let by_integral = Enclosure::pi(PRECISION) * *period / (a.sqrt() * &own.sigma * 4);
    Some(squares.min(&by_order).min(&by_integral))
}

/// kappa_s: the largest mean of `|zeta|_N^2` over that of the square of what drives it.
fn largest_answer(
    trial: &Trial,
    Known { own, of_all, .. }: &Known<'_>,
    (samples, step, kept): (u32, &Enclosure, &Enclosure),
) -> Option<Enclosure> {
    let of_mu = (&own.gain[0] * &own.mu).sqr();
    let one = |weight: &Enclosure, times: i64| Enclosure::from_integer(times, PRECISION) / weight / &of_mu;
    let [_, sin] = (Enclosure::pi(PRECISION) / i64::from(samples)).cos_sin();
    let beyond = step.sqr() * &own.n_bar_squared / (sin.sqr() * 4 * kept.sqr());
    let mean = beyond.max(&one(own.weights.first()?, 1));
    match (trial.or_more, of_all) {
        (true, OfAllCounts::AtSamples(least)) => Some(mean.max(&one(least, 2))),
        (true, OfAllCounts::Continuous(_)) => None,
        (false, _) => {
            let mut others = trial.oscillators.beyond_mean().iter();
            others.try_fold(mean, |most, l| Some(most.max(&one(own.weights.get(*l as usize)?, 2))))
        }
    }
}

impl Trial {
    /// The largest number of a harmonic.
    fn degree(&self) -> usize {
        let of = |CurveTerm { states, error, control, .. }: &CurveTerm| {
            states.harmonics.len().max(error.harmonics.len()).max(control.harmonics.len())
        };
        self.terms.iter().map(of).max().unwrap_or(0)
    }

    /// `d uhat/dt` of the terms, each times the largest `|delta^alpha|`.
    fn slope_of_control(&self, fundamental: &Enclosure) -> Vec<Harmonics> {
        let mut waves = self.scaled(|term| &term.control);
        for harmonics in &mut waves {
            for (k, wave) in (0_i64..).zip(harmonics) {
                for part in wave {
                    let frequency = fundamental * k;
                    *part = Complex { re: (&part.im * &frequency).negate(), im: &part.re * &frequency };
                }
            }
        }
        waves
    }
}
