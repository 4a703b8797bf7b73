//! Rule (R_h): rates and noise of some oscillators at samples (docs/mathematics.md, section 13.6), by the bounds of section 12.3.
//!
//! From a sample to the next, with the measurement `e_k + v`, a disturbance d of mean D within the interval, `y_u = sigma e_k + mean(q + d) + b_u u_k`, R
//! = e^(Phi h) and `b1 = b'R b`, all of them differences to the periodic solution,
//!   `y_u = (1-b_u) sigma e + b_u K b'R zs + mean(q + d) - b_u (sigma + K b1) v`,
//!   `e+ = (1 - h sigma) e + h y_u`, `zs+ = R zs - h b y_u + ((1 - h sigma) I - R) b v`,
//! and `e(kh+s) = (1 - s sigma) e + s y_u + G(s)`, G = 0 at both ends, `G' = q + d - mean(q + d)`. With X the root mean square of xi,
//! `kp = 1 - h k_e/pi`, `g = h k_e/(sqrt(12) kp)`, `g2 = (h k_e)^2/(6 kp)` that of e is at most
//!   `rho = c_X X + c_E |e| + c_Y |y_u| + c_d d_bar`, `c_X = h k_x/(pi kp)`, `c_E = sqrt(1 - hs + hs^2/3) + h k_e/(pi kp)`, `c_Y = h/(sqrt(3) kp)`,
//!   `c_d = h/(pi kp)`, and `mean(q + d) = w1 + w2 + p + D` for some
//!   w1 between lo1 e and hi1 e, `lo1 = -(1 - hs/2) k_l - g k_e`, `hi1 = (1 - hs/2) m + g k_e`,
//!   w2 between lo2 y_u and hi2 y_u, `lo2 = -(h/2) k_l - g2`, `hi2 = max{0, (h/2) m + g2}`,
//!   `|p| <= k_x (1+g) X`, `|D| <= (1+g) d_bar`.
//! And `xi+^2 - xi^2 <= -2 a_2 h X^2 + 2 h kf X rho`, `xi+ <= X + h kf rho`, `kf = sqrt(P_up) k_f`, for a_2 > 0.
//!
//! Guarantee: with `W = w xi^2 + y'Pi y`, c and all multipliers above 0, the form
//!   `-w [-2 a_2 h X^2 + 2 h kf X rho + c (X + h kf rho)^2] - (1+c) (e+, zs+)'Pi(e+, zs+) + (e, zs)'Pi(e, zs)`
//!   `- l_slope (hi1 e - w1)(w1 - lo1 e) - l_hold (hi2 y_u - w2)(w2 - lo2 y_u) - l_x (k_x^2 (1+g)^2 X^2 - p^2) - l_e (c_E^2 e^2 - rho_E^2)`
//!   `- l_y (c_Y^2 y_u^2 - rho_Y^2) + g_d D^2 + g_v v^2 + g_r rho_d^2`, `rho = c_X X + rho_E + rho_Y + rho_d`,
//! positive definite at both ends of b_u, in which what it subtracts is convex (lo2 <= 0 <= hi2), W after a sample is at most
//! `(W + g_d D^2 + g_v v^2 + g_r rho_d^2)/(1+c)`. So without inputs it falls by exp(-2 h rate), and from rest it stays below the sum of
//! `g_d (1+g)^2 d_bar^2`, `g_v v_bar^2` and `g_r c_d^2 d_bar^2` over c. Where k_x = 0 the equations of y do not have xi, and all that stands beside it is left
//! out.
//!
//! With rounding ([`super::rounding`]) `|D| <= (1+g) d_bar + b_hi du_b`, for the u of a sample is off by one number, and `N^(1/2) dz` is added to zs+, beside
//! the form: `sqrt(W)` is a norm, and at most `sqrt((W + ...)/(1+c)) + sqrt(z_up) dz_b` after a sample.
//!
//! Between samples `|e| <= s + |G|` where s bounds it at samples, and `|G| <= (h/2) sup|q + d|`, `|q| <= k_x xi + k_e |e|`, `xi <= kappa sup|e|`.

use super::claimed::{RULE, Rate};
use super::form::{Form, Linear};
use super::noise::{Known, added, of_states, weight};
use super::norm::{Norm, Stored, of_x, positive};
use super::rounding::Rounding;
use crate::interval::Interval;
use crate::json::{Field, Fields};
use crate::matrix::positive_definite;
use crate::rules::by_n_o::oscillators::Oscillators;
use crate::rules::sampled::law::Law;
use crate::rules::sampled::stability::Within;
use crate::rules::stability::ErrorBox;
use crate::verdict::{Condition, Outcome, demand};
use rug::Rational;

/// The multipliers by their names: of the slopes, and of x.
const OF_SLOPES: [&str; 3] = ["c", "l_slope", "l_hold"];
const OF_X: [&str; 4] = ["w", "l_x", "l_e", "l_y"];

/// A form with what proves that it is positive definite.
pub struct Proof {
    stored: Stored,
    /// c, l_slope and l_hold.
    of_slopes: [Rational; 3],
    /// w, l_x, l_e and l_y; none where x has no part in it.
    of_x: Option<[Rational; 4]>,
}

/// What proves the limits with noise.
pub struct OfNoise {
    pub(super) proof: Proof,
    g_d: Option<Rational>,
    g_v: Option<Rational>,
    g_r: Option<Rational>,
    pub(super) rounding: Option<Rounding>,
}

impl Proof {
    /// Takes it out of a part for these oscillators.
    pub fn read(fields: &mut Fields<'_>, oscillators: &Oscillators) -> Outcome<Proof> {
        let stored = Stored::read(fields, oscillators, 0)?;
        Ok(Proof { stored, of_slopes: fields.numbers(OF_SLOPES)?, of_x: fields.together(OF_X)? })
    }
}

impl OfNoise {
    /// Takes the part `noise` out of a part for these oscillators.
    pub fn read(fields: &mut Fields<'_>, oscillators: &Oscillators) -> Outcome<OfNoise> {
        let proof = Proof::read(fields, oscillators)?;
        let [g_d, g_v, g_r] = ["g_d", "g_v", "g_r"].map(|name| fields.part(name, Field::rational));
        Ok(OfNoise { proof, g_d: g_d?, g_v: g_v?, g_r: g_r?, rounding: Rounding::read(fields)? })
    }
}

/// The bounds of a step, under their names above.
struct Step {
    within: Within,
    /// lo1 and hi1, lo2 and hi2.
    slopes: [[Interval; 2]; 2],
    c_d: Interval,
    kf: Interval,
}

impl Step {
    /// Of a law whose kp is demanded to be above 0; S0 has `h sigma <= 1`.
    fn new(law: &Law<'_>, error_box: &ErrorBox, pointer: &str) -> Outcome<Step> {
        let (d, within) = (law.d, Within::new(law, error_box, [&law.h, &law.share]));
        let ErrorBox { k_f, k_e: k_l, most, .. } = error_box;
        Condition::less("R", "0 < 1 - h k_e/pi", d.int(0), within.room.clone()).demand(RULE, pointer)?;
        let (first, second, bend) = (1 - &law.share / 2, &law.h / 2, &within.g * &within.k_e);
        Ok(Step {
            slopes: [
                [-(&first * k_l + &bend), &first * most + bend],
                [-(&second * k_l + &within.bend), (&second * most + &within.bend).max(&d.int(0))],
            ],
            c_d: &law.h / Interval::pi(d.precision) / &within.room,
            kf: d.p_up.sqrt() * k_f,
            within,
        })
    }
}

/// The error system of some oscillators from sample to sample, with Pi.
pub(super) struct Loop<'a> {
    law: &'a Law<'a>,
    error_box: &'a ErrorBox,
    step: Step,
    pub(super) norm: Norm,
    pointer: &'a str,
    /// cos and sin of l w h, w h = 2 pi/N_s, for each of the harmonics l.
    turns: Vec<[Interval; 2]>,
    /// c, l_slope and l_hold.
    pub(super) of_slopes: [Interval; 3],
    /// w, l_x, l_e and l_y.
    pub(super) of_x: Option<[Interval; 4]>,
}

impl<'a> Loop<'a> {
    /// Of a witness whose signs are right, with Pi above diag(e_low, 0), for harmonics below N_s/2.
    pub(super) fn new(law: &'a Law<'a>, error_box: &'a ErrorBox, proof: &'a Proof) -> Outcome<Loop<'a>> {
        let (d, pointer, oscillators) = (law.d, proof.stored.pointer.as_str(), &proof.stored.oscillators);
        oscillators.demand_apart(law.samples, RULE, pointer)?;
        OF_SLOPES.into_iter().zip(&proof.of_slopes).try_for_each(|(name, value)| positive(name, value, pointer))?;
        let of_x = of_x(d, OF_X, proof.of_x.as_ref(), &error_box.k_x, pointer)?;
        let norm = Norm::new(d, &proof.stored)?;
        norm.lies_above()?;
        let turn = |l: u32| {
            let angle = Interval::pi(d.precision) * i64::from(2 * l) / i64::from(law.samples);
            [angle.cos(), angle.sin()]
        };
        Ok(Loop {
            step: Step::new(law, error_box, pointer)?,
            turns: oscillators.harmonics().iter().copied().map(turn).collect(),
            of_slopes: proof.of_slopes.each_ref().map(|value| d.number(value)),
            of_x,
            law,
            error_box,
            norm,
            pointer,
        })
    }

    /// The ends of b_u.
    pub(super) fn ends(&self) -> Vec<Interval> {
        self.law.d.ends(&self.law.sigma).into_iter().map(|(_, [b_u, _])| b_u).collect()
    }

    /// `b'R`, with 0 at e.
    fn row_of_turn(&self) -> Vec<Interval> {
        let entry = |k: usize| match k {
            0 => self.law.d.int(0),
            second if second > 1 && second % 2 == 1 => &self.norm.b[second - 1] * &self.turns[second / 2][1],
            first => &self.norm.b[first] * &self.turns[first / 2][0],
        };
        (0..self.norm.order()).map(entry).collect()
    }

    /// What e+ and zs+ have besides `h B y_u`; v is none where there is no noise.
    fn kept(&self, i: usize, v: Option<usize>) -> Linear {
        let of = |variable: usize, factor: Interval| Linear::of(variable, factor);
        let of_v = |factor: Interval| v.map_or_else(Linear::zero, |v| of(v, factor));
        let (a, b) = (&self.law.a, &self.norm.b);
        let [cos, sin] = &self.turns[i / 2];
        match i {
            0 => of(0, a.clone()),
            1 => of(1, self.law.d.int(1)) + of_v((a - 1) * &b[1]),
            first if first % 2 == 0 => {
                of(first, cos.clone()) + of(first + 1, sin.clone()) + of_v((a - cos) * &b[first])
            }
            second => of(second, cos.clone()) + of(second - 1, -sin) + of_v(sin * &b[second - 1]),
        }
    }

    /// The lower triangle of the form at an end of b_u, in (e, zs, w1, w2), then (X, p, rho_E, rho_Y) where x has a part in it, then D, v and rho_d
    /// as far as they have weights.
    pub(super) fn form(&self, b_u: &Interval, inputs: [Option<&Interval>; 3]) -> Vec<Vec<Interval>> {
        let (d, law, step, norm) = (self.law.d, self.law, &self.step, &self.norm);
        let order = norm.order();
        let one = || d.int(1);
        let [w1, w2] = [order, order + 1];
        let mut variables = order + 2;
        let mut next = |is_there: bool| {
            variables += usize::from(is_there);
            is_there.then_some(variables - 1)
        };
        let of_x = [(); 4].map(|()| next(self.of_x.is_some()));
        let [of_d, of_v, of_r] = inputs.map(|weight| next(weight.is_some()));
        let of = |variable: Option<usize>| variable.map_or_else(Linear::zero, |variable| Linear::of(variable, one()));
        let [e, w1, w2] = [0, w1, w2].map(|variable| of(Some(variable)));
        let [x, p, rho_e, rho_y] = of_x.map(of);
        let mut form = Form::zero(variables, d.precision);

        let turned = self.row_of_turn();
        let of_own = turned.iter().zip(&norm.b).skip(1).fold(d.int(0), |sum, (row, b)| sum + row * b);
        let gain = b_u * &law.gain;
        let mut y = e.times(&((1 - b_u) * &law.sigma)) + w1.clone() + w2.clone() + p.clone() + of(of_d);
        y = y + of(of_v).times(&-(b_u * &law.sigma + &gain * of_own));
        for (k, value) in turned.iter().enumerate().skip(1) {
            y = y + Linear::of(k, &gain * value);
        }

        // The sum of `Pi_ij a_i a_j` over i and j, of (e, zs) and of what (e+, zs+) keep.
        let kept: Vec<Linear> = (0..order).map(|i| self.kept(i, of_v)).collect();
        let [c, l_slope, l_hold] = &self.of_slopes;
        let after = -(c + 1);
        for i in 0..order {
            for j in 0..=i {
                let entry = if i == j { norm.at(i, j).clone() } else { norm.at(i, j) * 2 };
                form.add(&entry, &of(Some(i)), &of(Some(j)));
                form.add(&(&after * entry), &kept[i], &kept[j]);
            }
        }
        // With `h B y_u`: `2 h (Pi B)'kept y_u + h^2 B'Pi B y_u^2`.
        let cross = kept.iter().zip(&norm.image).fold(Linear::zero(), |sum, (own, image)| sum + own.times(image));
        form.add(&(&after * &law.h * 2), &cross, &y);
        let own = (0..order).fold(d.int(0), |sum, k| sum + &norm.image[k] * norm.at_input(k));
        form.add_square(&(&after * law.h.sqr() * own), &y);

        let mut sector = |l: &Interval, of: &Linear, w: &Linear, [lo, hi]: &[Interval; 2]| {
            let [below, above] = [w.clone() + of.times(&-lo), of.times(hi) + w.times(&d.int(-1))];
            form.add(&-l, &above, &below);
        };
        let [of_e, of_y] = &step.slopes;
        sector(l_slope, &e, &w1, of_e);
        sector(l_hold, &y, &w2, of_y);

        if let Some([w, l_x, l_e, l_y]) = &self.of_x {
            let ErrorBox { k_x, rate: a_2, .. } = self.error_box;
            let rho = x.times(&step.within.c_x) + rho_e.clone() + rho_y.clone() + of(of_r);
            let reach = &law.h * &step.kf;
            form.add_square(&(w * a_2 * &law.h * 2), &x);
            form.add(&-(w * &reach * 2), &x, &rho);
            form.add_square(&-(w * c), &(x.clone() + rho.times(&reach)));
            let mut within = |l: &Interval, bound: Interval, of: &Linear, own: &Linear| {
                form.add_square(&-(l * bound.sqr()), of);
                form.add_square(l, own);
            };
            within(l_x, k_x * (1 + &step.within.g), &x, &p);
            within(l_e, step.within.c_e.clone(), &e, &rho_e);
            within(l_y, step.within.c_y.clone(), &y, &rho_y);
        }
        for (variable, weight) in [of_d, of_v, of_r].into_iter().zip(inputs) {
            if let Some(weight) = weight {
                form.add_square(weight, &of(variable));
            }
        }
        form.rows
    }

    fn decays(&self, inputs: [Option<&Interval>; 3], what: &str) -> Outcome<()> {
        let at = format!("{}/Pi", self.pointer);
        self.ends().iter().try_for_each(|b_u| demand(positive_definite(self.form(b_u, inputs)), RULE, &at, what))
    }
}

/// Proves (R_h) and that c is large enough for a rate, and gives W at the start and e_low; `reach`: dX, dE and dZ.
pub fn rate(
    law: &Law<'_>,
    error_box: &ErrorBox,
    (claimed, proof, ends): (&Rate<'_>, &Proof, &[Rational; 2]),
    reach: &[Interval; 3],
) -> Outcome<[Interval; 2]> {
    let d = law.d;
    let made = Loop::new(law, error_box, proof)?;
    let growth = (&law.h * d.number(&claimed.rate) * 2).exp();
    let [c, ..] = &made.of_slopes;
    let condition = Condition::at_most("R", "exp(2 h rate) <= 1 + c", growth, c + 1);
    condition.demand(RULE, &format!("{}/rate", claimed.pointer))?;
    made.decays([None; 3], &format!("(R_h) for {}", claimed.oscillators.about()))?;
    let start = made.norm.start(d, made.of_x.as_ref().map(|[w, ..]| w * &d.p_up).as_ref(), ends, reach)?;
    Ok([start, made.norm.e_low])
}

/// Proves (R_h) with noise, and gives S, at all times, and kappa.
pub fn noise(law: &Law<'_>, (error_box, known): (&ErrorBox, &Known), proof: &OfNoise) -> Outcome<[Interval; 2]> {
    let (d, pointer) = (law.d, proof.proof.stored.pointer.as_str());
    let oscillators = &proof.proof.stored.oscillators;
    let made = Loop::new(law, error_box, &proof.proof)?;
    let rounding = Rounding::demanded(d, proof.rounding.as_ref(), pointer)?;
    let [d_bar, v_bar] = [d.spec.noise.d_bar(), d.spec.noise.v_bar()];
    let through_x = d_bar > 0 && made.of_x.is_some();
    let g_d = weight(d, ("g_d", proof.g_d.as_ref()), d_bar > 0 || rounding.is_some(), pointer)?;
    let g_v = weight(d, ("g_v", proof.g_v.as_ref()), v_bar > 0 || rounding.is_some(), pointer)?;
    let g_r = weight(d, ("g_r", proof.g_r.as_ref()), through_x, pointer)?;
    let [g_d, g_v, g_r] = [&g_d, &g_v, &g_r].map(Option::as_ref);
    made.decays([g_d, g_v, g_r], &format!("(R_h) with noise for {}", oscillators.about()))?;
    let (step, [c, ..]) = (&made.step, &made.of_slopes);
    let d_bar = d.number(&d_bar);
    let own = (1 + &step.within.g) * &d_bar;
    let of_inputs =
        |of_d: &Interval| added(d, g_d, of_d) + added(d, g_v, &known.off) + added(d, g_r, &(&step.c_d * &d_bar));
    let at_samples = match rounding {
        None => (of_inputs(&own) / c / &made.norm.e_low).sqrt(),
        Some(rounding) => {
            let [du_b, dz_b] = rounding.errors(law, known, oscillators)?;
            let sum = of_inputs(&(own + d.by_gain(|gain| &gain.high, &du_b)));
            rounding.level(&made.norm, [&sum, c, &dz_b])? / made.norm.e_low.sqrt()
        }
    };
    let (kappa, half) = (of_states(d, error_box, pointer)?, &law.h / 2);
    Ok([between(&at_samples, [&half, &d_bar], &step.within.k_e + &error_box.k_x * &kappa, pointer)?, kappa])
}

/// A bound of |e| at all times, from one at samples: `sup|e| <= s + half (steepness sup|e| + d_bar)`, half = h/2.
pub(super) fn between(
    s: &Interval,
    [half, d_bar]: [&Interval; 2],
    steepness: Interval,
    pointer: &str,
) -> Outcome<Interval> {
    let room = 1 - half * steepness;
    let zero = Interval::int(0, s.precision());
    Condition::less("N", "0 < 1 - (h/2)(k_e + k_x kappa)", zero, room.clone()).demand(RULE, pointer)?;
    Ok((s + half * d_bar) / room)
}
