//! The forms against the laws themselves, in doubles: z and e as the regulator has them, from which `zs = N^(1/2) (z - M e)` follows.

use super::{Kind, Proof, Witness, claimed::Rate, continuous, sampled};
use crate::data::Data;
use crate::interval::Interval;
use crate::json::{Field, Json, parse};
use crate::rules::common::Sizes;
use crate::rules::derivation::Derivation;
use crate::rules::sampled::claim::Regulator;
use crate::rules::sampled::law::Law;
use crate::rules::set::ClaimedSet;
use crate::rules::stability::ErrorBox;
use crate::scope::Scope;
use crate::spec::Specification;
use rug::Rational;

mod rounding;

/// Numbers in [-1, 1), the same in every run (SplitMix64).
fn drawn() -> impl FnMut() -> f64 {
    let mut state = 1_u64;
    move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

fn double(value: &Interval) -> f64 {
    value.lo().to_f64()
}

fn rational(json: &Json, name: &str) -> Rational {
    Field { json, pointer: String::new() }.fields().unwrap().required(name).unwrap().rational().unwrap()
}

fn part<'a>(json: &'a Json, name: &str) -> Field<'a> {
    Field { json, pointer: String::new() }.fields().unwrap().required(name).unwrap()
}

/// Those of the periodic solution, as a claim has them.
fn sizes(d: &Data<'_>, claim: &Json) -> Sizes {
    let [x, e, zeta] = ["x", "e", "zeta"].map(|size| d.number(&rational(part(claim, "periodic_solution").json, size)));
    Sizes { x, e, zeta }
}

/// What a stored certificate is made of.
fn with_stored(name: &str, use_it: impl Fn(&Data<'_>, (&Derivation, &Rational), &ErrorBox, &Witness)) {
    let path = format!("{}/../tests/{name}.json", env!("CARGO_MANIFEST_DIR"));
    let json = parse(&std::fs::read(path).unwrap()).unwrap();
    let mut witness = part(&json, "witness").fields().unwrap();
    let spec = Specification::read(&part(&json, "specification"), &mut witness).unwrap();
    let claim = part(&json, "claim");
    let set = part(claim.json, "initial_set");
    let [x0, e0] = ["X0", "E0"].map(|size| rational(set.json, size));
    let z0 = set.fields().unwrap().optional("Z0").map(|field| field.rational().unwrap());
    let set = ClaimedSet { x0, e0, z0 };
    let mut fields = claim.fields().unwrap();
    let scope = Scope::of_claim(fields.optional("harmonics").as_ref());
    let (derivation, sigma) = match Regulator::read(&mut fields).unwrap() {
        Some(regulator) => (Derivation::read_sampled(&mut witness, &regulator, (set, scope)), regulator.sigma),
        None => {
            let sigma = rational(claim.json, "sigma_star");
            (Derivation::read(&mut witness, sigma.clone(), (set, scope)), sigma)
        }
    };
    let derivation = derivation.unwrap();
    let rates = Rate::read_all(&fields.required("for_n_o").unwrap()).unwrap();
    let kind = if derivation.law().is_some() { Kind::Sampled } else { Kind::Continuous };
    let proofs = witness.optional("for_n_o");
    let proofs = Witness::read_all(proofs.as_ref(), &rates, kind).unwrap();
    let d = Data::new(&spec, 128);
    let free = &derivation.free;
    let Sizes { x, e, .. } = sizes(&d, claim.json);
    let radii = [d.number(&free.d_x), d.number(&free.d_e)];
    let error_box = ErrorBox::new(&d, free.paths, [&x, &e], radii.each_ref());
    for proof in &proofs {
        use_it(&d, (&derivation, &sigma), &error_box, proof);
    }
}

/// The value of a form with this lower triangle.
fn value(rows: &[Vec<Interval>], at: &[f64]) -> f64 {
    assert_eq!(rows.len(), at.len());
    let entry = |(i, j): (usize, usize)| double(&rows[i][j]) * at[i] * at[j] * if i == j { 1.0 } else { 2.0 };
    (0..at.len()).flat_map(|i| (0..=i).map(move |j| (i, j))).map(entry).sum()
}

/// The regulator, in its own coordinates.
struct Oscillators {
    /// The harmonics without 0.
    harmonics: Vec<u32>,
    /// n_l of each state, and M.
    weights: Vec<f64>,
    m: Vec<f64>,
}

impl Oscillators {
    fn new(d: &Data<'_>, all: &[u32]) -> Oscillators {
        let harmonics = all[1..].to_vec();
        let weight = |l: u32| double(&d.weight(u64::from(l)));
        let (mut weights, mut m) = (vec![weight(0)], vec![1.0]);
        for l in &harmonics {
            weights.extend([weight(*l); 2]);
            m.extend([1.0, 0.0]);
        }
        Oscillators { harmonics, weights, m }
    }

    /// z from e and zs, and e with zs from e and z.
    fn state(&self, e: f64, zs: &[f64]) -> Vec<f64> {
        (0..zs.len()).map(|k| zs[k] / self.weights[k].sqrt() + self.m[k] * e).collect()
    }

    fn own(&self, e: f64, z: &[f64]) -> Vec<f64> {
        [e].into_iter().chain((0..z.len()).map(|k| self.weights[k].sqrt() * (z[k] - self.m[k] * e))).collect()
    }

    /// `M'N z`.
    fn output(&self, z: &[f64]) -> f64 {
        (0..z.len()).map(|k| self.m[k] * self.weights[k] * z[k]).sum()
    }

    /// Each oscillator turned by l times an angle, or (its derivative) moved by l w.
    fn turned(&self, z: &[f64], of: impl Fn(f64, [f64; 2]) -> [f64; 2], of_first: f64) -> Vec<f64> {
        let pairs = z[1..].chunks(2).zip(&self.harmonics);
        let rest = pairs.flat_map(|(pair, l)| of(f64::from(*l), [pair[0], pair[1]]));
        [of_first * z[0]].into_iter().chain(rest).collect()
    }
}

fn quadratic(pi: &super::norm::Norm, a: &[f64], b: &[f64]) -> f64 {
    (0..a.len()).map(|i| (0..b.len()).map(|j| double(pi.at(i, j)) * a[i] * b[j]).sum::<f64>()).sum()
}

#[test]
fn the_form_in_continuous_time_is_that_of_the_law() {
    for name in ["noise/paper-example", "noise/input-gain", "sets/continuous"] {
        with_stored(name, |d, (_, sigma), error_box, witness| {
            let Proof::Continuous(_, Some(proof)) = &witness.proof else { panic!("{name}") };
            let made = continuous::Loop::new(d, error_box, sigma, &proof.proof).unwrap();
            let [w, l] = made.of_x.as_ref().unwrap().each_ref().map(double);
            let [sigma, mu, om] = [&d.number(sigma), &d.mu, &d.w].map(double);
            let [k_x, a_2] = [&error_box.k_x, &error_box.rate].map(double);
            let kf = double(&(d.p_up.sqrt() * &error_box.k_f));
            let [k_l, most] = [&error_box.k_e, &error_box.most].map(double);
            let oscillators = Oscillators::new(d, witness.oscillators.harmonics());
            let gains = d.gain.as_ref().map_or(vec![1.0], |gain| vec![double(&gain.low), double(&gain.high)]);
            let at: Vec<[f64; 2]> = gains.iter().flat_map(|b| [[*b, -k_l], [*b, most]]).collect();
            let mut draw = drawn();
            for (corner, [b_u, delta]) in made.corners().iter().zip(at) {
                let y: Vec<f64> = (0..oscillators.m.len() + 1).map(|_| draw()).collect();
                let [e, u_x, xi, dist, v] = [y[0], draw(), draw(), draw(), draw()];
                let z = oscillators.state(e, &y[1..]);
                let off = |z: &[f64], e: f64| (0..z.len()).map(|k| z[k] - oscillators.m[k] * e).collect::<Vec<_>>();
                let u = -sigma * (e + v) + mu * oscillators.output(&off(&z, e + v));
                let e_t = delta * e + u_x + dist + b_u * u;
                // z' = Phi z - (Phi + sigma) M (e + v).
                let turned = oscillators.turned(&off(&z, e + v), |l, [a, b]| [l * om * b, -l * om * a], 0.0);
                let z_t: Vec<f64> = (0..z.len())
                    .map(|k| turned[k] - sigma * oscillators.m[k] * (e + v) - oscillators.m[k] * e_t)
                    .collect();
                let y_t: Vec<f64> =
                    [e_t].into_iter().chain((0..z.len()).map(|k| oscillators.weights[k].sqrt() * z_t[k])).collect();
                let lambda = 0.3;
                let [g_d, g_v] = [3.0, 5.0];
                let expected = 2.0 * w * (a_2 - lambda) * xi * xi
                    - 2.0 * w * kf * xi * e
                    - 2.0 * quadratic(&made.norm, &y, &y_t)
                    - 2.0 * lambda * quadratic(&made.norm, &y, &y)
                    + l * (u_x * u_x - k_x * k_x * xi * xi)
                    + g_d * dist * dist
                    + g_v * v * v;
                let weights = [g_d, g_v].map(|g| d.number(&Rational::from_f64(g).unwrap()));
                let lambda = d.number(&Rational::from_f64(lambda).unwrap());
                let form = made.form(&lambda, corner, [Some(&weights[0]), Some(&weights[1])]);
                let found = value(&form, &[&y[..], &[u_x, xi, dist, v]].concat());
                assert!((found - expected).abs() < 1e-9 * expected.abs().max(1.0), "{name} {found} {expected}");
            }
        });
    }
}

#[test]
fn the_form_at_samples_is_that_of_the_law() {
    for name in ["noise/sampled", "noise/sampled-input-gain", "sets/noise-at-samples"] {
        with_stored(name, |d, (derivation, _), error_box, witness| {
            let Proof::Sampled(_, Some(proof)) = &witness.proof else { panic!("{name}") };
            let law = Law::new(d, derivation.law().unwrap());
            let made = sampled::Loop::new(&law, error_box, &proof.proof).unwrap();
            let [c, l_slope, l_hold] = made.of_slopes.each_ref().map(double);
            let [w, l_x, l_e, l_y] = made.of_x.as_ref().unwrap().each_ref().map(double);
            let [sigma, gain, h] = [&law.sigma, &law.gain, &law.h].map(double);
            let [k_x, a_2] = [&error_box.k_x, &error_box.rate].map(double);
            let kf = double(&(d.p_up.sqrt() * &error_box.k_f));
            let [k_l, m] = [&error_box.k_e, &error_box.most].map(double);
            // The numbers of the section.
            let (hs, k_e) = (h * sigma, k_l.max(m));
            let kp = 1.0 - h * k_e / std::f64::consts::PI;
            let (g, g2) = (h * k_e / 12_f64.sqrt() / kp, h * h * k_e * k_e / (6.0 * kp));
            let c_x = h * k_x / (std::f64::consts::PI * kp);
            let c_e = (1.0 - hs + hs * hs / 3.0).sqrt() + h * k_e / (std::f64::consts::PI * kp);
            let c_y = h / (3_f64.sqrt() * kp);
            let [lo1, hi1] = [-(1.0 - hs / 2.0) * k_l - g * k_e, (1.0 - hs / 2.0) * m + g * k_e];
            let [lo2, hi2] = [-h / 2.0 * k_l - g2, (h / 2.0 * m + g2).max(0.0)];
            let oscillators = Oscillators::new(d, witness.oscillators.harmonics());
            let angle = 2.0 * std::f64::consts::PI / f64::from(law.samples);
            let turn = |z: &[f64]| {
                let of = |l: f64, [a, b]: [f64; 2]| {
                    let (sin, cos) = (l * angle).sin_cos();
                    [cos * a + sin * b, cos * b - sin * a]
                };
                oscillators.turned(z, of, 1.0)
            };
            let mut draw = drawn();
            for end in made.ends() {
                let b_u = double(&end);
                let y: Vec<f64> = (0..oscillators.m.len() + 1).map(|_| draw()).collect();
                let [w1, w2, x, p, rho_e, rho_y, dist, v, rho_d] = [(); 9].map(|()| draw());
                let e = y[0];
                let z = oscillators.state(e, &y[1..]);
                let measured: Vec<f64> = (0..z.len()).map(|k| z[k] - oscillators.m[k] * (e + v)).collect();
                let turned = turn(&measured);
                let u = -sigma * (e + v) + gain * oscillators.output(&turned);
                let mean = w1 + w2 + p + dist;
                let after = e + h * (mean + b_u * u);
                let z_after: Vec<f64> =
                    (0..z.len()).map(|k| turned[k] + (1.0 - hs) * oscillators.m[k] * (e + v)).collect();
                let y_after = oscillators.own(after, &z_after);
                let y_u = sigma * e + mean + b_u * u;
                let rho = c_x * x + rho_e + rho_y + rho_d;
                let [g_d, g_v, g_r] = [3.0, 5.0, 7.0];
                let expected = -w * (-2.0 * a_2 * h * x * x + 2.0 * h * kf * x * rho + c * (x + h * kf * rho).powi(2))
                    - (1.0 + c) * quadratic(&made.norm, &y_after, &y_after)
                    + quadratic(&made.norm, &y, &y)
                    - l_slope * (hi1 * e - w1) * (w1 - lo1 * e)
                    - l_hold * (hi2 * y_u - w2) * (w2 - lo2 * y_u)
                    - l_x * (k_x * k_x * (1.0 + g).powi(2) * x * x - p * p)
                    - l_e * (c_e * c_e * e * e - rho_e * rho_e)
                    - l_y * (c_y * c_y * y_u * y_u - rho_y * rho_y)
                    + g_d * dist * dist
                    + g_v * v * v
                    + g_r * rho_d * rho_d;
                let weights = [g_d, g_v, g_r].map(|g| d.number(&Rational::from_f64(g).unwrap()));
                let form = made.form(&end, weights.each_ref().map(Some));
                let found = value(&form, &[&y[..], &[w1, w2, x, p, rho_e, rho_y, dist, v, rho_d]].concat());
                assert!((found - expected).abs() < 1e-9 * expected.abs().max(1.0), "{name} {found} {expected}");
            }
        });
    }
}

/// Between samples the error is not larger than `(s + (h/2) d_bar)/(1 - (h/2) steepness)`, which needs a positive denominator.
#[test]
fn between_samples_the_interval_is_short_enough() {
    let number = |value: f64| Interval::rational(&Rational::from_f64(value).unwrap(), 128);
    let [s, half, d_bar] = [0.5, 0.25, 2.0].map(number);
    let bound = sampled::between(&s, [&half, &d_bar], number(2.0), "").unwrap();
    assert_eq!(double(&bound), 2.0);
    for steepness in [4.0, 5.0] {
        assert!(sampled::between(&s, [&half, &d_bar], number(steepness), "").is_err());
    }
}
