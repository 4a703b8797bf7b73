//! Rule (R) and (N): rates and noise of some oscillators in continuous time (docs/mathematics.md, section 13.6).
//!
//! With `zs = N^(1/2) zeta`, `b = N^(1/2) M`, `y = (e, zs)` and `B = (1, -b)`, all of them differences to the periodic solution, in the
//! error box `y' = A y + B (delta e + u + d) + B_v v`, `A = [-sigma, mu b'; 0, Phi - mu b b']`, `delta` in `[-k_e, most]`, `|u| <= k_x xi`, and
//! `(xi^2)' <= -2 a_2 xi^2 + 2 sqrt(P_up) k_f xi |e|`. Of v the law has `z' = Phi z + Gamma (e + v)` and `-(sigma + mu b'b) v` in u, so that
//! `B_v = (-(sigma + mu b'b); -Phi b + mu b (b'b))`.
//!
//! With an input gain b_u the loop has `b_u mu` for mu and `delta + (1-b_u) sigma` for delta (section 13.1), and
//! `B_v = (-b_u (sigma + mu b'b); -Phi b - (1-b_u) sigma b + b_u mu b (b'b))`: all of it is affine in `(b_u, delta)`, and the four corners serve.
//!
//! Guarantee: with `W = w xi^2 + y'Pi y`, `w, l > 0`, and the form
//! `2 w (a_2 - rate) xi^2 - 2 w sqrt(P_up) k_f xi e - 2 y'Pi ((A + rate) y + B delta e + B u + B d + B_v v) + l (u^2 - k_x^2 xi^2) + g_d d^2 + g_v v^2`
//! positive definite at each corner, `W' <= -2 rate W + g_d d^2 + g_v v^2` (for e < 0 by the form at (xi, -y, -u, -d, -v); its corner l is
//! above 0). Without w and l, k_x is 0: then the equations of y do not have xi, and `W = y'Pi y` serves.
//!
//! So without inputs `e^2 <= W/e_low` falls from at most `w P_up dX^2 + e_up dE^2 + z_up dZ^2`, which `factor^2 e_low` is not below; and
//! from rest `W <= (g_d d_bar^2 + g_v v_bar^2)/(2 lambda)`.

use super::claimed::{RULE, Rate};
use super::noise::{added, of_states, weight};
use super::norm::{Norm, Stored, of_x, positive};
use crate::data::Data;
use crate::interval::Interval;
use crate::json::{Field, Fields};
use crate::matrix::positive_definite;
use crate::rules::by_n_o::oscillators::Oscillators;
use crate::rules::stability::ErrorBox;
use crate::verdict::{Outcome, demand};
use rug::Rational;

/// The multipliers of x by their names.
const OF_X: [&str; 2] = ["w", "l"];

/// A form with what proves that it is positive definite, but for the rate.
pub struct Proof {
    stored: Stored,
    /// w and l; none where x has no part in it.
    of_x: Option<[Rational; 2]>,
}

/// What proves the limits with noise.
pub struct OfNoise {
    pub(super) proof: Proof,
    lambda: Rational,
    g_d: Option<Rational>,
    g_v: Option<Rational>,
}

impl Proof {
    /// Takes it out of a part for these oscillators.
    pub fn read(fields: &mut Fields<'_>, oscillators: &Oscillators) -> Outcome<Proof> {
        Ok(Proof { stored: Stored::read(fields, oscillators, 0)?, of_x: fields.together(OF_X)? })
    }
}

impl OfNoise {
    /// Takes the part `noise` out of a part for these oscillators.
    pub fn read(fields: &mut Fields<'_>, oscillators: &Oscillators) -> Outcome<OfNoise> {
        let proof = Proof::read(fields, oscillators)?;
        let lambda = fields.number("lambda")?;
        let [g_d, g_v] = ["g_d", "g_v"].map(|name| fields.part(name, Field::rational));
        Ok(OfNoise { proof, lambda, g_d: g_d?, g_v: g_v? })
    }
}

/// A corner: b_u, b_u mu and delta.
pub(super) struct Corner {
    gain: Interval,
    mu: Interval,
    slope: Interval,
}

/// The error system of some oscillators, with Pi.
pub struct Loop<'a> {
    d: &'a Data<'a>,
    error_box: &'a ErrorBox,
    sigma: Interval,
    pub(super) norm: Norm,
    pointer: &'a str,
    /// w and l.
    pub(super) of_x: Option<[Interval; 2]>,
}

impl<'a> Loop<'a> {
    /// Of a witness whose signs are right, with Pi above diag(e_low, 0).
    pub fn new(d: &'a Data<'a>, error_box: &'a ErrorBox, sigma: &Rational, proof: &'a Proof) -> Outcome<Loop<'a>> {
        let pointer = proof.stored.pointer.as_str();
        let norm = Norm::new(d, &proof.stored)?;
        let of_x = of_x(d, OF_X, proof.of_x.as_ref(), &error_box.k_x, pointer)?;
        norm.lies_above()?;
        Ok(Loop { d, error_box, sigma: d.number(sigma), norm, pointer, of_x })
    }

    pub(super) fn corners(&self) -> Vec<Corner> {
        let ErrorBox { k_e, most, .. } = self.error_box;
        let slopes = [-k_e, most.clone()];
        let at = |gain: &Interval, moved: &Interval, slope: &Interval| Corner {
            gain: gain.clone(),
            mu: gain * &self.d.mu,
            slope: slope + moved,
        };
        let ends = self.d.ends(&self.sigma);
        ends.iter().flat_map(|(_, [gain, moved])| slopes.each_ref().map(|slope| at(gain, moved, slope))).collect()
    }

    /// `Pi B_v`: -Phi b has `l w sqrt(n_l)` at the second state of an oscillator.
    fn image_of_noise(&self, Corner { gain, mu, .. }: &Corner) -> Vec<Interval> {
        let b = &self.norm.b;
        let total = b[1..].iter().fold(self.d.int(0), |sum, value| sum + value.sqr());
        let along = mu * &total - (1 - gain) * &self.sigma;
        let entry = |k: usize| match k {
            0 => -(gain * &self.sigma + mu * &total),
            second if second > 1 && second % 2 == 1 => self.norm.turn(second) * &b[second - 1],
            first => &along * &b[first],
        };
        self.norm.times(&(0..self.norm.order()).map(entry).collect::<Vec<_>>())
    }

    /// The lower triangle of the form in (y, u, xi, d, v): without u and xi where x has no part in it, and of d and v with those that have a weight.
    pub(super) fn form(&self, rate: &Interval, corner: &Corner, inputs: [Option<&Interval>; 2]) -> Vec<Vec<Interval>> {
        let order = self.norm.order();
        // `delta e` is one more input: `(delta, mu b')` comes back through B.
        let mut rows = self.norm.falls(&self.sigma, [&corner.mu, &corner.slope], rate);
        // The row of an input: `-2 y'Pi (its image) (it)`, its weight on the diagonal, and 0 between.
        let add = |rows: &mut Vec<Vec<Interval>>, image: &[Interval], weight: &Interval| {
            let mut row: Vec<Interval> = image.iter().map(|value| -value).collect();
            row.resize(rows.len(), self.d.int(0));
            row.push(weight.clone());
            rows.push(row);
        };
        if let Some([w, l]) = &self.of_x {
            let ErrorBox { k_x, k_f, rate: a_2, .. } = self.error_box;
            add(&mut rows, &self.norm.image, l);
            let mut last = vec![self.d.int(0); order + 1];
            last[0] = -(w * self.d.p_up.sqrt() * k_f);
            last.push(w * (a_2 - rate) * 2 - l * k_x.sqr());
            rows.push(last);
        }
        let [g_d, g_v] = inputs;
        if let Some(weight) = g_d {
            add(&mut rows, &self.norm.image, weight);
        }
        if let Some(weight) = g_v {
            add(&mut rows, &self.image_of_noise(corner), weight);
        }
        rows
    }

    fn decays(&self, rate: &Interval, inputs: [Option<&Interval>; 2], what: &str) -> Outcome<()> {
        let at = format!("{}/Pi", self.pointer);
        self.corners()
            .iter()
            .try_for_each(|corner| demand(positive_definite(self.form(rate, corner, inputs)), RULE, &at, what))
    }
}

/// Proves (R) at a rate, and gives W at the start and e_low; `reach`: dX, dE and dZ.
pub fn rate(
    d: &Data<'_>,
    (error_box, sigma): (&ErrorBox, &Rational),
    (claimed, proof, ends): (&Rate<'_>, &Proof, &[Rational; 2]),
    reach: &[Interval; 3],
) -> Outcome<[Interval; 2]> {
    let made = Loop::new(d, error_box, sigma, proof)?;
    let what = format!("(R) for {}, rate {}", claimed.oscillators.about(), claimed.rate);
    made.decays(&d.number(&claimed.rate), [None, None], &what)?;
    let start = made.norm.start(d, made.of_x.as_ref().map(|[w, _]| w * &d.p_up).as_ref(), ends, reach)?;
    Ok([start, made.norm.e_low])
}

/// Proves (N), and gives S and kappa.
pub fn noise(d: &Data<'_>, (error_box, sigma): (&ErrorBox, &Rational), proof: &OfNoise) -> Outcome<[Interval; 2]> {
    let pointer = proof.proof.stored.pointer.as_str();
    positive("lambda", &proof.lambda, pointer)?;
    let made = Loop::new(d, error_box, sigma, &proof.proof)?;
    let [d_bar, v_bar] = [d.spec.noise.d_bar(), d.spec.noise.v_bar()];
    let g_d = weight(d, ("g_d", proof.g_d.as_ref()), d_bar > 0, pointer)?;
    let g_v = weight(d, ("g_v", proof.g_v.as_ref()), v_bar > 0, pointer)?;
    let lambda = d.number(&proof.lambda);
    let about = proof.proof.stored.oscillators.about();
    let what = format!("(N) for {about}, lambda {}", proof.lambda);
    made.decays(&lambda, [g_d.as_ref(), g_v.as_ref()], &what)?;
    let sum = added(d, g_d.as_ref(), &d.number(&d_bar)) + added(d, g_v.as_ref(), &d.number(&v_bar));
    let s = (sum / (lambda * 2) / &made.norm.e_low).sqrt();
    Ok([s, of_states(d, error_box, pointer)?])
}
