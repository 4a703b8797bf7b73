//! What the sampled loop makes of a periodic input, uniformly in n_o (docs/mathematics.md, sections 12.1 and 12.2, S3).
//!
//! The harmonic j of e is `S_j h/(e^{i om h} - a)` times that of the mean input, `|e^{i om h} - a|^2 = (h sigma)^2 + a (h om_j)^2`, and
//! `|S_j| <= Sb_j = min{1 + theta, 1/|cos(pi j/N_s)|}`, of every set of harmonics 1 + theta (section 14.7); S_0 = 0. With a gain (section 13.1) [`Law::of_error`] stands for it.

use super::law::Law;
use crate::interval::Interval;
use crate::scope::Scope;

/// Up to so many samples 1/|cos| is used; beyond, where theta is small, Sb_j = 1 + theta and sg_S = sg_h/(1 + theta).
const MAX_SHARPENED: u32 = 8192;

/// The gains from the mean input over a step, or from its differences over h.
pub struct Gains {
    /// `bt_S^2 = sum_{j=1}^{N_s-1} Sb_j^2/(sigma^2 + a om_j^2)`: sup|e_k| over rms(q). Each term is `|e_j|^2` over `|q_j|^2`.
    pub sup: Interval,
    /// `bt_h^2 = sum_{j=1}^{N_s-1} 1/(sigma^2 + a om_j^2)`: sup|e_k| over the rms of y, whose sum is 0.
    pub sup_y: Interval,
    /// `tau_S^2 = sum_{j=1}^{N_s-1} Sb_j^2/(om_j^2 (sigma^2 + a om_j^2))`: sup|e_k| over rms(q').
    pub sup_t: Interval,
    /// 1/sg_S: rms(e_k) over rms(q), and rms of (e_{k+1} - e_k)/h over rms(q').
    pub rms: Interval,
    /// 1/(om_1 sg_S): rms(e_k) over rms(q').
    pub rms_t: Interval,
    /// `2 (1 + theta)/(2 - h sigma)`: rms of (e_{k+1} - e_k)/h over rms(q). With a gain the largest `om_j |e_j|` over `|q_j|`, which is not
    /// below 1: at b = 1 it is at least om_j/|D_j| for j = floor(N_s/2), whose `om_j^2 >= 3/h^2 >= sigma/h`.
    pub slope: Interval,
    /// `2/(2 - h sigma)` times the largest `|y_j|` over `|q_j|`, which is at most 1 + theta without a gain.
    pub slope_by_y: Interval,
    /// The largest `|y_j|` over `|q_j|`.
    pub of_y: Interval,
    /// The largest `|et_j|` over `|q_j|` of the prediction with a delay, which is `|y_j/D_j|`; e has 1 + h sigma more. Without one that of e.
    pub prediction: Interval,
}

impl Gains {
    /// Over the harmonics; j and N_s - j are equal.
    pub fn new(law: &Law<'_>) -> Gains {
        let d = law.d;
        // (S3) is about the first n_o.
        let sharpened = law.samples <= MAX_SHARPENED && !law.delayed && law.scope == Scope::First;
        let largest = law.of_y().sqr();
        // The squares of |e_j| over |q_j|, of om_j, and of |D_j| = |e^{i om h} - a|/h.
        let harmonic = |j| {
            let sine = law.sine(j);
            let frequency = law.frequency_squared(&sine);
            let size = law.sigma.sqr() + &law.a * &frequency;
            let error = if d.gain.is_some() {
                law.of_error(&frequency, &size)
            } else if sharpened {
                // At j = N_s/2 the cosine is 0.
                largest.least(&(1 - sine.sqr()).recip()) / &size
            } else {
                &largest / &size
            };
            [error, frequency, size]
        };
        let all: Vec<_> = (1..=law.samples / 2).map(harmonic).collect();
        type Of = fn(&[Interval; 3]) -> Interval;
        let times = |j: u32| if 2 * j == law.samples { 1 } else { 2 };
        let sum = |of: Of| all.iter().zip(1..).fold(d.int(0), |sum, (at, j)| sum + of(at) * times(j)).sqrt();
        let most = |of: Of| all.iter().fold(d.int(0), |most, at| most.max(&of(at))).sqrt();
        let by_y = |y: &Interval| y * 2 / (2 - &law.share);
        let [rms, rms_t, slope, of_y] = if d.gain.is_some() {
            let of_y = most(|[error, _, size]| error * size);
            let slope = most(|[error, frequency, _]| error * frequency);
            [most(|[error, ..]| error.clone()), most(|[error, frequency, _]| error / frequency), slope, of_y]
        } else {
            let (rms, of_y) = (slowest(law, sharpened).recip(), law.of_y());
            let rms_t = &rms / law.frequency_squared(&law.sine(1)).sqrt();
            [rms, rms_t, by_y(&of_y), of_y]
        };
        // Up to here all is of y_j/D_j, which is e without a delay and the prediction with one.
        let (prediction, ahead) = (rms.clone(), law.ahead());
        let of_e = |value: Interval| if law.delayed { value * &ahead } else { value };
        Gains {
            sup: of_e(sum(|[error, ..]| error.clone())),
            sup_y: sum(|[.., size]| size.recip()),
            sup_t: of_e(sum(|[error, frequency, _]| error / frequency)),
            rms: of_e(rms),
            rms_t: of_e(rms_t),
            slope: of_e(slope),
            slope_by_y: of_e(by_y(&of_y)),
            of_y,
            prediction,
        }
    }
}

/// `sg_S = max{ sg_h/(1+theta), min{ cos(pi/N_s) sg_h, sqrt(sigma^2 + 4 a s*/h^2)/(1+theta) } }`, `s* = 1 - (1+theta)^-2`: at most
/// `sqrt(sigma^2 + a om_j^2)/Sb_j` for every j. With s = sin^2, `(1 - s)(sigma^2 + 4 a s/h^2)` is concave, so least at an end of
/// [s_1, s*]; beyond s* the other part of Sb_j counts.
fn slowest(law: &Law<'_>, sharpened: bool) -> Interval {
    let d = law.d;
    let sine = law.sine(1);
    let speed = |squared: Interval| (law.sigma.sqr() + &law.a * squared).sqrt();
    let first = speed(law.frequency_squared(&sine));
    if !sharpened {
        return first / law.of_y();
    }
    let cosine = (1 - sine.sqr()).max(&d.int(0)).sqrt();
    let turn = (1 - law.growth.sqr().recip()).max(&d.int(0));
    let at_turn = speed(turn * 4 / law.h.sqr()) / &law.growth;
    (&first / &law.growth).max(&(cosine * first).min(&at_turn))
}
