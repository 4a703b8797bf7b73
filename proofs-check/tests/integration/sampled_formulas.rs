//! Every formula of section 12 against floating point, and against the sampled loop itself.

use crate::common::{certificate, every};
use proofs_check::data::Data;
use proofs_check::interval::Interval;
use proofs_check::json::{Field, decimal, parse};
use proofs_check::rules::common::Free;
use proofs_check::rules::paths::{Path, Paths};
use proofs_check::rules::sampled::existence;
use proofs_check::rules::sampled::gains::Gains;
use proofs_check::rules::sampled::law::{Law, Terms};
use proofs_check::rules::sampled::stability;
use proofs_check::rules::sampled::transfer;
use proofs_check::rules::set::ClaimedSet;
use proofs_check::rules::stability::ErrorBox;
use proofs_check::scope::Scope;
use proofs_check::spec::Specification;
use proofs_check::verdict::Verdict;
use rug::Rational;
use serde_json::json;
use std::f64::consts::PI;

/// n_0 = 2, n_l = l^-1.5: the sum of all.
pub const NBAR_SQUARED: f64 = 4.612_375_348_685_488;

/// The paper's example with another T and mu, and q steep enough for its parts to be seen.
fn specification(period: &str, mu: f64, [low, high]: [f64; 2]) -> Specification {
    let mut document = certificate("paper-example.means")["specification"].clone();
    document["period"] = json!(period);
    document["internal_model"]["mu"] = json!(format!("{mu}"));
    document["internal_model"]["base_frequency"] = json!(format!("2*pi/({period})"));
    if low < high {
        document["input_gain"] = json!({ "nominal": "2", "low": 2.0 * low, "high": 2.0 * high });
    }
    document["bounds"]["q_e"] = json!("0.5 + 2*X + 3*E");
    document["bounds"]["q_x"] = json!("0.3 + 0.5*X + 0.7*E");
    document["bounds"]["q_e_max"] = json!("0.1 + X + E");
    let (json, none) = (parse(document.to_string().as_bytes()).unwrap(), parse(b"{}").unwrap());
    let field = |json| Field { json, pointer: String::new() };
    Specification::read(&field(&json), &mut field(&none).fields().unwrap()).unwrap_or_else(|e| panic!("{e:?}"))
}

pub fn rational(value: f64) -> Rational {
    Rational::from_f64(value).unwrap()
}

/// The law of section 12 in floating point.
#[derive(Clone, Copy, Debug)]
pub struct Float {
    pub period: f64,
    pub mu: f64,
    pub sigma: f64,
    pub samples: u32,
    pub h: f64,
    pub gain: f64,
    /// With b_hi K.
    pub growth: f64,
    pub a: f64,
    /// Of b.
    pub ends: [f64; 2],
    /// Whether a control is computed in the sample before it acts.
    pub delayed: bool,
    /// Which oscillators the claim is about.
    pub scope: Scope,
}

impl Float {
    pub fn new(period: f64, mu: f64, samples: u32, share: f64) -> Float {
        let h = period / f64::from(samples);
        let growth = 1.0 + h * mu * NBAR_SQUARED / 2.0;
        let sigma = share / h;
        Float {
            period,
            mu,
            sigma,
            samples,
            h,
            gain: mu / growth,
            growth,
            a: 1.0 - h * sigma,
            ends: [1.0; 2],
            delayed: false,
            scope: Scope::First,
        }
    }

    pub fn with_gain(self, ends: [f64; 2]) -> Float {
        Float { growth: 1.0 / (1.0 - ends[1] * self.loss()), ends, ..self }
    }

    /// K h Nb2/2.
    pub fn loss(&self) -> f64 {
        self.gain * self.h * NBAR_SQUARED / 2.0
    }

    /// b_lo K (1 + theta), with its own theta.
    pub fn least_mu(&self) -> f64 {
        self.ends[0] * self.gain / (1.0 - self.ends[0] * self.loss())
    }

    /// b from its least to its largest.
    pub fn gains(&self) -> impl Iterator<Item = f64> {
        let [low, high] = self.ends;
        (0..=8).map(move |i| low + f64::from(i) / 8.0 * (high - low))
    }

    /// |D_j|, and its real part.
    pub fn size(&self, j: u32) -> [f64; 2] {
        let squared = self.frequency(j).powi(2);
        [(self.sigma.powi(2) + self.a * squared).sqrt(), self.sigma - self.h / 2.0 * squared]
    }

    /// That of D_j = (e^{i phi} - a)/h.
    pub fn imaginary(&self, j: u32) -> f64 {
        (2.0 * f64::from(j) * self.angle()).sin() / self.h
    }

    /// The least |D_j| times the distance of a point (1-b) sigma from its line.
    pub fn room(&self, j: u32) -> f64 {
        let [size, real] = self.size(j);
        let at = |b: f64| size * size / self.growth - (1.0 - b) * self.sigma * real;
        at(self.ends[0]).min(at(self.ends[1]))
    }

    /// The bound of |e_j| over |q_j|, of the first n_o harmonics.
    pub fn error(&self, j: u32) -> f64 {
        let [size, _] = self.size(j);
        if self.ends == [1.0; 2] {
            return self.growth.min(1.0 / (f64::from(j) * self.angle()).cos().abs()) / size;
        }
        size / self.room(j)
    }

    /// The largest of a number of each harmonic.
    pub fn most(&self, of: impl Fn(u32) -> f64) -> f64 {
        (1..self.samples).map(of).fold(0.0, f64::max)
    }

    pub fn terms(&self) -> Terms {
        let weight_sum = decimal("4.612375348685489").unwrap();
        Terms {
            sigma: rational(self.sigma),
            samples: self.samples,
            gain: rational(self.gain),
            weight_sum,
            delayed: self.delayed,
            scope: self.scope,
        }
    }

    /// pi/N_s.
    pub fn angle(&self) -> f64 {
        PI / f64::from(self.samples)
    }

    pub fn frequency(&self, j: u32) -> f64 {
        2.0 / self.h * (f64::from(j) * self.angle()).sin()
    }

    pub fn w(&self) -> f64 {
        2.0 * PI / self.period
    }
}

fn weight(l: i64) -> f64 {
    if l == 0 { 2.0 } else { (l as f64).powf(-1.5) }
}

/// c_l.
fn share(l: i64) -> f64 {
    if l == 0 { 2.0 } else { weight(l.abs()) / 2.0 }
}

/// Laws of every kind: few samples and many, h sigma up to 1, theta small and large.
pub fn laws() -> Vec<Float> {
    let mut laws = Vec::new();
    for (period, mu) in [(1.0, 1.0), (2.0, 0.05), (0.5, 40.0)] {
        for samples in [2, 3, 4, 5, 8, 31, 64] {
            laws.extend([0.03, 0.4, 0.96875].map(|share| Float::new(period, mu, samples, share)));
        }
    }
    let uncertain = laws.iter().flat_map(|law| GAINS.map(|ends| law.with_gain(ends)));
    let known = |law: &Float| law.growth > 0.0 && (1..law.samples).all(|j| law.room(j) > 1e-3);
    let uncertain: Vec<Float> = uncertain.filter(known).collect();
    assert!(uncertain.len() > 3 * laws.len() && laws.len() == 63);
    laws.extend(uncertain);
    laws
}

const GAINS: [[f64; 2]; 5] = [[0.75, 1.25], [0.875, 1.125], [0.5, 1.0], [1.0, 1.5], [0.25, 4.0]];

pub fn with_law(float: &Float, check: impl FnOnce(&Law<'_>)) {
    let spec = specification(&format!("{}", float.period), float.mu, float.ends);
    let data = Data::new(&spec, 192);
    let law = Law::new(&data, &float.terms());
    law.conditions("").unwrap_or_else(|finding| panic!("{float:?}: {finding:?}"));
    check(&law);
}

#[track_caller]
pub fn close(what: &str, value: &Interval, expected: f64, float: &Float) {
    let (lo, hi) = (value.lo().to_f64(), value.hi().to_f64());
    let apart = (lo - expected).abs() + (hi - expected).abs();
    assert!(apart <= 1e-9 * expected.abs(), "{what}: [{lo}, {hi}], not {expected}: {float:?}");
}

#[test]
fn numbers_of_the_law() {
    for float in laws() {
        with_law(&float, |law| {
            close("growth", &law.growth, float.growth, &float);
            close("mu", &law.mu, float.least_mu(), &float);
            close("loss", &law.loss, 1.0 - 1.0 / float.growth, &float);
            close("a", &law.a, float.a, &float);
            close("om", &law.frequency_squared(&law.sine(1)), float.frequency(1).powi(2), &float);
        });
    }
}

/// The sums, each against the closed form where 1/|cos| is nowhere less than 1 + theta, and the gain sg_S against every harmonic.
#[test]
fn gains_of_the_loop() {
    for float in laws() {
        with_law(&float, |law| {
            let gains = Gains::new(law);
            let sum = |term: &dyn Fn(u32) -> f64| (1..float.samples).map(term).sum::<f64>().sqrt();
            close("bt", &gains.sup, sum(&|j| float.error(j).powi(2)), &float);
            close("tau", &gains.sup_t, sum(&|j| (float.error(j) / float.frequency(j)).powi(2)), &float);
            close("bt_h", &gains.sup_y, sum(&|j| float.size(j)[0].powi(-2)), &float);
            let (rms, slope) = (gains.rms.lo().to_f64(), 2.0 / (2.0 - float.h * float.sigma));
            let by_y = float.most(|j| float.error(j) * float.size(j)[0]);
            let by_y = if float.ends == [1.0; 2] { float.growth } else { by_y };
            close("slope_by_y", &gains.slope_by_y, slope * by_y, &float);
            if float.ends != [1.0; 2] {
                close("rms", &gains.rms, float.most(|j| float.error(j)), &float);
                close("rms_t", &gains.rms_t, float.most(|j| float.error(j) / float.frequency(j)), &float);
                let steepest = float.most(|j| float.error(j) * float.frequency(j));
                close("slope", &gains.slope, steepest, &float);
                assert!(steepest >= 1.0, "{float:?}");
                return;
            }
            let worst = float.most(|j| float.error(j));
            assert!(
                rms >= worst * (1.0 - 1e-12) && rms <= float.growth / float.size(1)[0] * (1.0 + 1e-12),
                "{float:?}"
            );
            close("rms_t", &gains.rms_t, rms / float.frequency(1), &float);
            close("slope", &gains.slope, slope * float.growth, &float);
            // 12.1: the closed forms, which S3 does not exceed.
            let (n, a, sigma) = (f64::from(float.samples), float.a, float.sigma);
            let power = a.powf(n);
            let bt = float.period * (1.0 + power) / (sigma * (2.0 - float.h * sigma) * (1.0 - power)) - sigma.powi(-2);
            let tau = ((float.period.powi(2) - float.h.powi(2)) / 12.0 - a * bt) / sigma.powi(2);
            let ceiling = |square: f64| float.growth * square.sqrt() * (1.0 + 1e-6);
            assert!(gains.sup.hi().to_f64() <= ceiling(bt) && gains.sup_t.hi().to_f64() <= ceiling(tau), "{float:?}");
        });
    }
    // Beyond 8192 samples the closed forms, to the last digit that floating point has.
    let float = Float::new(1.0, 1.0, 8193, 0.25);
    with_law(&float, |law| {
        let gains = Gains::new(law);
        let bt = float.period / (float.sigma * (2.0 - 0.25)) - float.sigma.powi(-2);
        close("bt", &gains.sup, float.growth * bt.sqrt(), &float);
        let slowest = (float.sigma.powi(2) + float.a * float.frequency(1).powi(2)).sqrt();
        close("sg", &gains.rms, float.growth / slowest, &float);
    });
}

/// `T_d(j) w^2/(1+theta)^2` of the sampled internal model with n_o oscillators at the gain b, from its formula in z.
fn transfer_of(float: &Float, b: f64, n_o: u32, j: u32) -> f64 {
    let angle = |l: i64| (i64::from(j) - l) as f64 * float.angle();
    let scale = float.w().powi(2) / float.growth.powi(2);
    if j <= n_o {
        return scale / ((b * float.gain).powi(2) * share(i64::from(j)));
    }
    let squares: f64 = (-i64::from(n_o)..=i64::from(n_o)).map(|l| share(l) / angle(l).sin().powi(2)).sum();
    scale * float.h.powi(2) / 4.0 * squares / through(float, b, n_o, j).iter().map(|part| part * part).sum::<f64>()
}

/// `1 + b K h G` at a harmonic beyond n_o: its two parts.
fn through(float: &Float, b: f64, n_o: u32, j: u32) -> [f64; 2] {
    let range = -i64::from(n_o)..=i64::from(n_o);
    let half = b * float.gain * float.h / 2.0;
    let cotangents: f64 = range.clone().map(|l| share(l) / ((i64::from(j) - l) as f64 * float.angle()).tan()).sum();
    [1.0 - half * range.map(share).sum::<f64>(), -half * cotangents]
}

/// |e_j| over |q_j| at the gain b: `D_j e = y`, `y (kept + i off) = q + (1-b) sigma e`.
fn error_of(float: &Float, b: f64, j: u32, [kept, off]: [f64; 2]) -> f64 {
    let [size, real] = float.size(j);
    let imaginary = float.imaginary(j);
    assert!((real.hypot(imaginary) / size - 1.0).abs() < 1e-9);
    let [re, im] = [real * kept - imaginary * off - (1.0 - b) * float.sigma, real * off + imaginary * kept];
    1.0 / re.hypot(im)
}

/// What a gain makes of a harmonic, for every b and every n_o, and no less than that: e, and what zeta is driven by.
#[test]
fn responses_of_the_loop_with_a_gain() {
    for float in laws().into_iter().filter(|float| float.ends != [1.0; 2]) {
        let apart = (1.0 - float.ends[0]).max(float.ends[1] - 1.0);
        let more = 1.0 + apart * float.sigma * float.most(|j| float.error(j));
        let scale = float.growth.powi(2) / float.w().powi(2);
        for j in 1..=float.samples / 2 {
            let bound = float.error(j);
            let beyond = (0..=(float.samples - 1) / 2).filter(|n_o| *n_o < j);
            for (b, n_o) in float.gains().flat_map(|b| beyond.clone().map(move |n_o| (b, n_o))) {
                let error = error_of(&float, b, j, through(&float, b, n_o, j));
                assert!(error <= bound * (1.0 + 1e-9), "b = {b}, n_o = {n_o}, j = {j}: {error} > {bound}, {float:?}");
                // |zeta_j|^2 over |q_j|^2: its input is y (1 + b K h G).
                let input =
                    error * float.size(j)[0] * through(&float, b, n_o, j)[0].hypot(through(&float, b, n_o, j)[1]);
                assert!(input <= more * (1.0 + 1e-9), "{float:?}");
                let zeta = scale * transfer_of(&float, b, n_o, j) * input * input;
                assert!(zeta <= scale * demanded(&float, j) * more * more * (1.0 + 1e-9), "{float:?}");
            }
            // With the largest theta and the worst cotangents: i D_j moves the difference along its line.
            let worst = |b: f64| {
                let off = (b - 1.0) * float.sigma * float.imaginary(j) / float.size(j)[0].powi(2);
                error_of(&float, b, j, [1.0 / float.growth, off])
            };
            let largest = float.ends.map(worst).into_iter().fold(0.0, f64::max);
            assert!((largest / bound - 1.0).abs() < 1e-9, "j = {j}: {largest} {bound}, {float:?}");
        }
    }
}

/// `max{2/(nu^2 n_j), s_j}`.
fn demanded(float: &Float, j: u32) -> f64 {
    let pole = 2.0 / (float.least_mu() / float.w()).powi(2) / weight(i64::from(j));
    let j = i64::from(j);
    let angle = |l: i64| (j - l) as f64 * float.angle();
    (1 - j..j).map(|l| share(l) * (float.angle() / angle(l).sin()).powi(2)).sum::<f64>().max(pole)
}

#[test]
fn the_pair_bounds_the_transfer_of_every_loop() {
    for float in laws().into_iter().step_by(every(4)) {
        let last = float.samples / 2;
        let speed = |j: u32| (float.frequency(j) / float.w()).powi(2);
        for n_o in 0..=(float.samples - 1) / 2 {
            for j in 1..=last {
                let bound = demanded(&float, j);
                let truth = float.gains().map(|b| transfer_of(&float, b, n_o, j)).fold(0.0, f64::max);
                assert!(truth <= bound * (1.0 + 1e-9), "n_o = {n_o}, j = {j}: {truth} > {bound}, {float:?}");
            }
        }
        let least = 1.0 / ((float.least_mu() / float.w()).powi(2) * 2.0);
        for factor in [1.000_001, 1.7, 30.0] {
            let k0 = least * factor;
            let k1 = (1..=last).map(|j| (demanded(&float, j) - k0) / speed(j)).fold(0.0, f64::max);
            let accepts = |k0: f64, k1: f64| {
                let mut answer = None;
                with_law(&float, |law| answer = Some(transfer::check(law, &rational(k0), &rational(k1), "")));
                answer.unwrap().map(drop).map_err(|finding| (finding.verdict, finding.message))
            };
            assert_eq!(accepts(k0, k1 * (1.0 + 1e-9)), Ok(()), "{float:?}");
            if k1 > 0.0 {
                let refused = accepts(k0, k1 * (1.0 - 1e-6)).unwrap_err();
                assert!(refused.0 == Verdict::Invalid && refused.1.contains("at j = "), "{refused:?}");
            }
            assert!(accepts(least * 0.999_999, k1 * 2.0 + 1.0).unwrap_err().1.contains("1/(nu^2 n_0) <= k0"));
        }
    }
}

/// The bounds of a block of harmonics hold for each in it, and are not far from the truth.
#[test]
fn blocks_of_harmonics() {
    for samples in [2, 3, 10, 31, 64, 200] {
        let float = Float::new(1.0, 1.0, samples, 0.5);
        with_law(&float, |law| {
            let pair = transfer::Pair::new(law, &Rational::from(1), &Rational::from(1));
            let last = samples / 2;
            let sums: Vec<f64> = (1..=last).map(|j| pair.sum(j).hi().to_f64()).collect();
            for j in 1..=last {
                let l = i64::from(j);
                let angle = |l: i64| (i64::from(j) - l) as f64 * float.angle();
                let sum: f64 = (1 - l..l).map(|l| share(l) * (float.angle() / angle(l).sin()).powi(2)).sum();
                close("s_j", &pair.sum(j), sum, &float);
            }
            for first in 1..=last {
                for end in first..=last {
                    let block = &sums[first as usize - 1..end as usize];
                    let most = block.iter().copied().fold(0.0, f64::max);
                    let bounds = pair.beyond(first, end).map(|bound| bound.lo().to_f64());
                    assert!(bounds.iter().all(|bound| *bound >= most), "{first} to {end}: {most}, {bounds:?}");
                    let least = bounds[0].min(bounds[1]);
                    assert!(end > 2 * first || least <= 8.0 * most, "{first} to {end}: {most}, {bounds:?}");
                }
            }
            let [widest, _] = pair.beyond(1, last);
            close("pi^2 Nbar^2/4", &widest, PI * PI * NBAR_SQUARED / 4.0, &float);
        });
    }
}

/// One pair for as many harmonics as there may be, of which each is settled by its block or by itself.
#[test]
fn many_harmonics() {
    let accepts = |mu: f64, k0: f64, k1: f64| {
        let float = Float::new(1.0, mu, 65_536, 0.1);
        let mut answer = None;
        let (_, steps) = proofs_check::effort::limited(proofs_check::effort::LIMIT, || {
            with_law(&float, |law| answer = Some(transfer::check(law, &rational(k0), &rational(k1), "").is_ok()));
        });
        (answer.unwrap(), steps)
    };
    let (accepted, steps) = accepts(1.0, 19.74, 59.22);
    assert!(accepted && steps < proofs_check::effort::LIMIT / 50, "{steps}");
    // nu is large: k0 alone bounds s_j for the first harmonics, and the poles 2/(nu^2 n_j) rise slowly.
    let (accepted, steps) = accepts(100.0, 3.0, 0.01);
    assert!(accepted && steps < proofs_check::effort::LIMIT / 20, "{steps}");
    assert!(!accepts(100.0, 1.0, 0.01).0);
}

pub const AT: [f64; 2] = [0.25, 0.5];

/// What S2 is at [`AT`] with the means (1/8, 1/4, 2) and the pair (20, 60).
pub fn existence_at(law: &Law<'_>) -> existence::Solution {
    let d = law.d;
    let [x, e] = AT.map(|value| d.number(&rational(value)));
    let pair = [d.number(&Rational::from(20)), d.number(&Rational::from(60))];
    existence::evaluate(law, (&[0.125, 0.25, 2.0].map(rational), None), [&x, &e], [&pair[0], &pair[1]])
}

/// S2 by its parts at (X_p, E_p) = (1/4, 1/2), (r_x, r_e, r_d) = (1/8, 1/4, 2).
#[test]
fn parts_of_existence() {
    for float in laws() {
        with_law(&float, |law| {
            let found = existence_at(law);
            let (c, alpha, t, h) = (1.5512_f64.sqrt(), 0.58, float.period, float.h);
            let [x_p, e_p] = AT;
            let rate = alpha - c * 0.2237 * x_p / 2.0;
            let f_e = x_p + 0.189;
            let f_x = 2.302 + 0.112 * x_p + 0.2237 * x_p;
            let (q_x, q_e) = (0.3 + 0.5 * x_p + 0.7 * e_p, 0.5 + 2.0 * x_p + 3.0 * e_p);
            let d_0 = q_x * 0.125 + q_e * 0.25;
            let r_q = (4.822 + x_p + (e_p * f_e).atan()).min(4.822 + d_0);
            let r_1 = 24.18 + 2.106 * e_p + q_x * (f_x * 0.125 + f_e * 0.25) + q_e * 2.0;
            let gains = Gains::new(law);
            let [sup, sup_t, rms, rms_t, slope, by_y] =
                [&gains.sup, &gains.sup_t, &gains.rms, &gains.rms_t, &gains.slope, &gains.slope_by_y]
                    .map(|gain| gain.hi().to_f64());
            let side = |id: &str| {
                let condition = found.conditions.iter().find(|condition| condition.id == id).unwrap();
                condition.lhs.clone()
            };
            let at_samples = (sup * r_q).min(sup_t * r_1) + h / (2.0 * PI) * (h * t).sqrt() * r_1;
            let sup_e = at_samples.min((t * 0.25 * 2.0).sqrt());
            close("S2", &side("S2"), sup_e, &float);
            close("S2b", &side("S2b"), (rms * r_q).min(rms_t * r_1) + (h / PI).powi(2) * r_1, &float);
            close("S2c", &side("S2c"), (slope * r_q).min((rms.powi(2) + (h / PI).powi(2)).sqrt() * r_1), &float);
            close("S1c", &side("S1c"), c / rate * f_e * 0.25, &float);
            close("e_per", &found.e, sup_e.min(e_p), &float);
            let k2 = c * (t / (rate * t / 2.0).tanh() / (2.0 * rate)).sqrt();
            close("x_per", &found.x, x_p.min(c / rate * f_e * sup_e.min(e_p)).min(k2 * f_e * 0.25), &float);
            let mean = (t / (2.0 * float.least_mu()) + 20.0 / float.w().powi(2)) * r_q.powi(2);
            let z = float.growth * (mean + 60.0 / float.w().powi(4) * r_1.powi(2)).sqrt();
            let [low, high] = float.ends;
            let z = z * (1.0 + (1.0 - low).max(high - 1.0) * float.sigma * rms);
            close("Z", &found.z, z, &float);
            let by_parts = float.sigma * sup_e.min(e_p) + float.gain * NBAR_SQUARED.sqrt() * z;
            let factor = if low < high {
                (1.0 + by_y) / low
            } else if by_y <= 3.0 {
                2.0 / (4.0 - by_y).sqrt()
            } else {
                by_y - 1.0
            };
            let by_rate = factor * ((t * t - h * h) / 12.0).sqrt() * r_1;
            close("steady", &found.steady, (r_q / low + by_rate).min(by_parts), &float);
        });
    }
}

#[test]
fn parts_of_stability() {
    let (x_per, e_per, d_x, d_e, w_x, eta) = (0.01, 0.02, 0.04, 0.08, 3.0, 0.7);
    let (x_b, e_b) = (x_per + d_x, e_per + d_e);
    // The e of d/dx and the x of d/de.
    let places = [(Path::StateFirst, e_per, x_b), (Path::ErrorFirst, e_b, x_per), (Path::Straight, e_b, x_b)];
    let pairs = places.into_iter().flat_map(|f| places.map(|q| (f, q)));
    let cases = pairs.flat_map(|pair| laws().into_iter().step_by(every(2)).map(move |float| (float, pair)));
    for (float, ((f, e_f, x_f), (q, e_q, x_q))) in cases {
        with_law(&float, |law| {
            let number = |value: f64| law.d.number(&rational(value));
            let [x_p, e_p, far_x, far_e] = [x_per, e_per, d_x, d_e].map(number);
            let error_box = ErrorBox::new(law.d, Paths { f, q }, [&x_p, &e_p], [&far_x, &far_e]);
            let (w, zeta) = (number(w_x), number(eta));
            let found = stability::conditions(law, &error_box, [&w, &zeta], None);
            let c = 1.5512_f64.sqrt();
            let rate = 0.58 - c * (0.2237 * x_per + e_f + 0.2237 * d_x / 2.0);
            let (k_x, k_l, m, k_f) =
                (0.3 + 0.5 * x_b + 0.7 * e_q, 0.5 + 2.0 * x_q + 3.0 * e_b, 0.1 + x_q + e_b, x_f + 0.189);
            let (h, k_e, s) = (float.h, k_l, eta / float.gain);
            let room = 1.0 - h * k_e / PI;
            close("kp", &found[0].rhs, room, &float);
            let coupling = w_x * c * k_f;
            for (t, at_end, first) in [(0.0, 0.0, 1), (h, 1.0, 4)] {
                let ts = t * float.sigma;
                let drift = t * k_e / (PI * room);
                let (c_x, c_e, c_y) =
                    (t * k_x / (PI * room), (1.0 - ts + ts * ts / 3.0).sqrt() + drift, t / (3.0_f64.sqrt() * room));
                let g = t * k_e / 12.0_f64.sqrt() / room;
                let p_y = t * t * k_e * k_e / (6.0 * room);
                let side = |b: f64, slope: f64| 1.0 - ts + s * ((1.0 - ts / 2.0) * slope + (1.0 - b) * float.sigma);
                let d_t = float.gains().flat_map(|b| [m, -k_l].map(|slope| side(b, slope).abs())).fold(0.0, f64::max);
                let xx = 2.0 * w_x * rate - 2.0 * coupling * c_x;
                let xe = -coupling * c_e;
                let xy = -coupling * c_y - s * k_x * (1.0 + g);
                let ee = float.sigma * (2.0 - ts);
                let ey = -d_t - s * g * k_e;
                let yy = 2.0 * s * (1.0 - at_end * (1.0 - 1.0 / float.growth)) - t - s * t * m - 2.0 * s * p_y;
                let second = xx * ee - xe * xe;
                let third = xx * (ee * yy - ey * ey) - xe * (xe * yy - ey * xy) + xy * (xe * ey - ee * xy);
                for (i, minor) in [xx, second, third].into_iter().enumerate() {
                    let (lo, hi) = (found[first + i].rhs.lo().to_f64(), found[first + i].rhs.hi().to_f64());
                    let scale =
                        [xx.abs(), xx.abs() * ee + xe * xe, xx.abs() * (ee * yy.abs() + ey * ey) + ee * xy * xy];
                    let near = (lo - minor).abs() + (hi - minor).abs() <= 1e-9 * scale[i];
                    assert!(near, "minor {} at t = {t}: [{lo}, {hi}], not {minor}: {float:?}", i + 1);
                }
            }
        });
    }
}

/// At either end of b, whichever is worse; in continuous time with both ends at once.
#[test]
fn how_far_the_control_goes() {
    let spec = specification("1", 1.0, [0.5, 2.0]);
    let d = Data::new(&spec, 128);
    let number = |value: f64| d.number(&rational(value));
    let mut seen = [0; 2];
    for (h, sigma, gain) in [(0.01, 3.0, 2.0), (0.3, 20.0, 0.5), (1.0, 1.0, 1.0)] {
        let [x_p, e_p, d_x, d_e, w_x, weight] = [1.0, 1.0, 1.0, 1.0, 3.0, h].map(rational);
        let [k0, k1] = [1.0, 1.0].map(rational);
        let set = ClaimedSet { x0: k0.clone(), e0: k0.clone(), z0: None };
        let paths = Paths { f: Path::Straight, q: Path::Straight };
        let r = [1.0; 3].map(rational);
        let free = Free { pointer: String::new(), set, x_p, e_p, r, d_x, d_e, w_x, h: weight, k0, k1, paths };
        let of = |level: f64, b: f64| {
            let level = 3.0 * 1.5512 * 0.04 + 0.09 + level * h * 4.0;
            (level * (sigma * sigma + gain * gain * NBAR_SQUARED / (b * h))).sqrt()
        };
        let ends = [of(0.5, 0.5), of(2.0, 2.0)];
        seen[usize::from(ends[1] > ends[0])] += 1;
        for (at_samples, expected) in [(true, ends[0].max(ends[1])), (false, of(2.0, 0.5))] {
            let reach = [0.2, 0.3, 2.0].map(number);
            let (_, found) = free.level(&d, &reach, [&number(sigma), &number(gain)], (at_samples, &number(1.0), None));
            close("transient", &found, expected, &Float::new(1.0, 1.0, 2, 0.5));
        }
    }
    assert!(seen.iter().all(|count| *count > 0), "{seen:?}");
}
