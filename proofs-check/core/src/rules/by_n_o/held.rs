//! How far the periodic solution of a regulator at samples is from a trial: Theorem T_s of section 14.6 of docs/mathematics.md.
//!
//! Here uhat is what the control is in the mean over the sample that follows; it is held meanwhile, and uhat is not. The difference has the mean 0 over each sample,
//! so that what it moves e by is 0 at both ends of one, and at most `(h^2/8) sup|b uhat'|` between them.

use super::oscillators::Oscillators;
use super::trials::{States, Trial};
use super::tube::{Slope, Tube};
use crate::data::Data;
use crate::interval::Interval;
use crate::rules::sampled::law::Terms;

impl Tube {
    /// The numbers of the theorem; `d` has K in the place of mu. Of an entry about so many oscillators or more they are the fewest that it is about.
    pub(super) fn at_samples(
        d: &Data<'_>,
        (law, own): (&Terms, &Oscillators),
        (trial, or_more): (&Trial, bool),
        slope: &Slope,
    ) -> Tube {
        let Some((metric, extent)) = trial.forms.first() else {
            // A trial has a form.
            let unknown = || Interval::undefined(d.precision);
            return Tube { x: unknown(), e: unknown(), e_rms: unknown(), e_at_law: unknown(), zeta: unknown() };
        };
        let (period, sigma, samples) = (d.period.only(), d.number(&law.sigma), i64::from(law.samples));
        let h = &period / samples;
        let across = &h / Interval::pi(d.precision);
        let [low, high] = [d.by_gain(|gain| &gain.low, &d.int(1)), d.by_gain(|gain| &gain.high, &d.int(1))];
        let [[d_x, d_q], [b_x, b_e]] =
            [&trial.defects, &trial.slopes].map(|pair| pair.each_ref().map(|of| d.number(of)));
        let [c_x, c_e, c_y] = metric.least.each_ref().map(|value| d.number(value));
        let (lambda, p_up) = (d.number(&metric.lambda), d.number(&extent.p_up));
        // A form at samples has a gamma.
        let gamma = metric.gamma.as_ref().map_or_else(|| Interval::undefined(d.precision), |gamma| d.number(gamma));

        let swings = &high * &across * &slope.rms;
        let ripple = &high * h.sqr() / 8 * &slope.sup;
        let has_states = trial.states.is_some();
        let of_states = if has_states { (&p_up * &d_x).sqr() * 2 / &c_x } else { d.int(0) };
        let g = gamma * d_q.sqr() + lambda * (&across * &swings).sqr() * 9 / 5 + of_states;
        let rho_y = (&g / c_y).sqrt();

        // (14.4b) at a periodic solution: rho_x <= answer rho_e + rest.
        let of_states = |States { up, decay: [c, gamma], .. }: &States| {
            let [up, c, gamma] = [up, c, gamma].map(|value| d.number(value));
            [(gamma / &c).sqrt(), up * &d_x / c]
        };
        let [answer, rest] = trial.states.as_ref().map_or_else(|| [d.int(0), d.int(0)], of_states);
        let kept = 1 - &across * (&b_e + &b_x * &answer);
        let by_y = (&rho_y / &sigma + &across * (&b_x * &rest + &d_q + &swings)) / &kept;
        let mut rho_e = (&g / c_e).sqrt();
        if d.int(0).lt(&kept) == Some(true) {
            rho_e = rho_e.least(&by_y);
        }
        let by_form = if has_states { (&g * 2 / c_x).sqrt() } else { d.int(0) };
        let rho_x = by_form.least(&(answer * &rho_e + rest));

        let at_law = squares(d, (&sigma, own.next()), (&h, law.samples)).sqrt() * &rho_y;
        let input = &b_x * &rho_x + &b_e * &rho_e + d_q;
        let e = &at_law + ripple + (&h * &period).sqrt() / 2 * &input;
        let x = trial.states.as_ref().map_or_else(|| d.int(0), |states| states.follow(d, &e, &trial.defects[0]));

        let shift = (&high - 1).max(&(1 - &low));
        let driven = input + shift * &rho_y;
        let loss = 1 - &high * &d.mu * &h * d.n_bar.sqr() / 2;
        let swing = period / (&low * &d.mu * &loss * 2);
        let zeta = (swing + largest(d, own, or_more, (&low, &h, law.samples, &loss))).sqrt() * driven;
        // Where K is too large nothing is known of zeta.
        let zeta = if d.int(0).lt(&loss) == Some(true) { zeta } else { Interval::undefined(d.precision) };
        Tube { x, e_rms: rho_e.least(&e), e, e_at_law: at_law, zeta }
    }
}

/// A bound of the sum of `1/(sigma^2 + a w_j^2)` over the harmonics j of y, `next <= j <= N_s - next`, `a = 1 - h sigma`: `w_j = (2/h) sin(pi j/N_s) >= 4 j/T` up to
/// the middle. Without that it is at most the integral over both halves, and the terms are at most `1/sigma^2`.
fn squares(d: &Data<'_>, (sigma, next): (&Interval, u32), (h, samples): (&Interval, u32)) -> Interval {
    let (period, next) = (d.period.only(), i64::from(next));
    let a = 1 - h * sigma;
    let all = i64::from(samples) / sigma.sqr();
    if d.int(0).lt(&a) != Some(true) {
        return all;
    }
    let tail = d.ratio(1, next * next) + d.ratio(1, next);
    let by_order = period.sqr() / (&a * 8) * tail;
    let by_integral = Interval::pi(d.precision) * period / (a.sqrt() * sigma * 4);
    all.least(&by_order).least(&by_integral)
}

/// What the mean of `|zeta|_N^2` is at most, over that of the square of what drives it: at an oscillator `1/(b K)^2` over `c_k`, elsewhere all poles are a harmonic
/// away at least. Of so many oscillators or more those below half of the samples count, whose weights do not rise.
fn largest(
    d: &Data<'_>,
    own: &Oscillators,
    or_more: bool,
    (low, h, samples, loss): (&Interval, &Interval, u32, &Interval),
) -> Interval {
    let last = [(samples - 1) / 2];
    let later = if or_more { &last[..] } else { &own.harmonics()[1..] };
    let at_mean = 1 / d.weight(0);
    let poles = later.iter().fold(at_mean, |most, k| most.max(&(2 / d.weight(u64::from(*k)))));
    let sin = (Interval::pi(d.precision) / i64::from(samples)).sin();
    let beyond = (h * &d.n_bar / (sin * loss * 2)).sqr();
    (poles / (low * &d.mu).sqr()).max(&beyond)
}
