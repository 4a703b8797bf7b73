//! The periodic answers of the regulator to random q at gains and periods of intervals, harmonic by harmonic in doubles, against the bounds
//! of the library: none is ever exceeded, and some are nearly reached.

use crate::support::cases;
use nalgebra::Complex;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rug::Rational;
use serde_json::json;
use sigmastar_lang::spec::Specification;
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::harmonics::AtOrigin;
use sigmastar_theory::derivation::mean_squares::{ErrorGains, Forcing, Gains};
use sigmastar_theory::transfer::closed_form_pair;
use std::f64::consts::TAU;

type C = Complex<f64>;

/// Harmonics of q, and instants at which the largest values are sought.
const FORCED: usize = 5;
const INSTANTS: usize = 400;

/// A regulator on e' = q(t) + b u.
struct Loop {
    mu: f64,
    /// w over 2 pi: never so that a harmonic of q is one of the oscillators.
    ratio: f64,
    oscillators: usize,
    sigma: f64,
    /// b_lo and b_hi.
    ends: [f64; 2],
    /// T_lo and T_hi; T is 1 nominally.
    periods: [f64; 2],
    /// c_0, c_1, ..., of q.
    q: Vec<C>,
}

fn weight(l: usize) -> f64 {
    if l == 0 { 2.0 } else { (l as f64).powf(-1.5) }
}

impl Loop {
    fn random(random: &mut StdRng) -> Loop {
        let q = (0..=FORCED).map(|k| {
            let size = 10f64.powf(random.random_range(-2.0..0.5));
            C::from_polar(size, if k == 0 { 0.0 } else { random.random_range(0.0..TAU) })
        });
        Loop {
            q: q.collect(),
            mu: 10f64.powf(random.random_range(-2.0..1.5)),
            ratio: (random.random_range(0.11..2.3_f64) * 1e3).round() / 1e3 + 0.000_37,
            oscillators: [0, 1, 3, 8][random.random_range(0..4_usize)],
            sigma: 10f64.powf(random.random_range(-1.5..2.5)),
            ends: [random.random_range(0.08..1.0), random.random_range(1.0..3.0)],
            periods: if random.random_bool(0.5) {
                [1.0; 2]
            } else {
                [0.8..1.0, 1.0..1.25].map(|end| random.random_range(end))
            },
        }
    }

    /// e and the components of zeta at the harmonic k >= 1, at the gain b and the period T.
    fn answer(&self, k: usize, [b, period]: [f64; 2]) -> (C, Vec<C>) {
        let s = C::new(0.0, TAU * k as f64 / period);
        let frequency = |l: usize| TAU * self.ratio * l as f64;
        let blocks = (1..=self.oscillators).map(|l| weight(l) * s / (s * s + frequency(l).powi(2)));
        let through = blocks.fold(C::from(weight(0)) / s, |sum, block| sum + block);
        let e = self.q[k] / (s + b * self.sigma + b * self.mu * through * (s + self.sigma));
        let y = (s + self.sigma) * e;
        let mut zeta = vec![-y / s];
        for l in 1..=self.oscillators {
            let over = s * s + frequency(l).powi(2);
            zeta.extend([-s * y / over, frequency(l) * y / over]);
        }
        (e, zeta)
    }

    /// rms(e), rms(e'), sup|e| and sup|zeta|_N at the gain b and the period T.
    fn sizes(&self, [b, period]: [f64; 2]) -> [f64; 4] {
        let answers: Vec<(C, Vec<C>)> = (1..=FORCED).map(|k| self.answer(k, [b, period])).collect();
        let rms = |value: &dyn Fn(usize, C) -> f64| {
            (2.0 * answers.iter().zip(1..).map(|((e, _), k)| value(k, *e).powi(2)).sum::<f64>()).sqrt()
        };
        // The constant part of q is answered by the integrator alone: n_0 zeta_0 b mu = -c_0.
        let still = -self.q[0].re / (b * self.mu * weight(0));
        let (mut sup, mut largest) = (0.0_f64, 0.0_f64);
        for i in 0..INSTANTS {
            let turn = |k: usize| C::from_polar(2.0, TAU * (k * i) as f64 / INSTANTS as f64);
            let e: f64 = answers.iter().zip(1..).map(|((e, _), k)| (e * turn(k)).re).sum();
            let zeta = (0..=2 * self.oscillators).map(|j| {
                let moving: f64 = answers.iter().zip(1..).map(|((_, zeta), k)| (zeta[j] * turn(k)).re).sum();
                weight(j.div_ceil(2)) * (moving + if j == 0 { still } else { 0.0 }).powi(2)
            });
            (sup, largest) = (sup.max(e.abs()), largest.max(zeta.sum::<f64>().sqrt()));
        }
        [rms(&|_, e| e.norm()), rms(&|k, e| TAU * k as f64 / period * e.norm()), sup, largest]
    }

    fn specification(&self) -> Specification {
        let [low, high] = self.ends.map(|end| end.to_string());
        let sizes: Vec<String> = self.q.iter().map(|c| (c.norm() * (1.0 + 1e-12)).to_string()).collect();
        let text = json!({
            "format": "sigmastar/bounding-spec", "version": 1, "name": "a loop",
            "period": { "nominal": "1", "low": self.periods[0].to_string(), "high": self.periods[1].to_string() },
            "lyapunov": { "p_low": "1", "p_up": "1", "alpha": "1" },
            "bounds": { "f": "0", "f_e": "0", "f_xx": "0", "f_ex": "0", "q": "1", "q_e": "1", "q_x": "0", "q_t": "1" },
            "q_0": { "harmonics": sizes, "rest_rms": "0" },
            "internal_model": { "mu": self.mu.to_string(), "base_frequency": format!("{}*2*pi", self.ratio),
                "weights": { "family": "power", "n0": "2", "epsilon": "1/2" } },
            "input_gain": { "nominal": "1", "low": low, "high": high },
            "initial_set": { "kind": "paper" }
        });
        Specification::from_json("a loop", &text.to_string())
            .unwrap_or_else(|errors| panic!("{}", errors.render(false)))
    }

    /// The bounds of [`Loop::sizes`], by the size and the rate of q as a whole, and by its harmonics.
    fn bounds(&self) -> [[f64; 4]; 2] {
        let spec = self.specification();
        let data = Data::new(&spec, 128);
        let exact = |value: f64| data.rational(&Rational::from_f64(value).expect("it is finite"));
        let sigma = exact(self.sigma);
        let origin = AtOrigin::new(&data);
        let square = |factor: &dyn Fn(usize) -> f64| {
            let of = |k: usize| (if k == 0 { 1.0 } else { 2.0 }) * (factor(k) * self.q[k].norm()).powi(2);
            ((0..=FORCED).map(of).sum::<f64>().sqrt()) * (1.0 + 1e-12)
        };
        let (q_rms, q_rate_rms) = (exact(square(&|_| 1.0)), exact(square(&|k| TAU * k as f64 / self.periods[0])));
        let (k0, k1) = closed_form_pair(&data);
        [exact(1e100), data.zero()].map(|change| {
            let change = [change.clone(), change];
            let forcing = Forcing { q_rms: q_rms.clone(), q_rate_rms: q_rate_rms.clone(), change };
            let gains = ErrorGains::new(&data, &sigma);
            let response = gains.response(&origin, &forcing);
            let z = gains.z_squared(&data, &forcing, [&k0, &k1]).sqrt();
            [response.rms, response.rate_rms, response.sup, z].map(|bound| bound.upper_f64())
        })
    }
}

#[test]
fn answers_are_within_their_bounds_at_every_gain() {
    let mut largest = [0.0_f64; 4];
    for seed in cases(150, 3000) {
        let random = &mut StdRng::seed_from_u64(seed);
        let of = Loop::random(random);
        let [low, high] = of.ends;
        let bounds = of.bounds();
        let [shortest, longest] = of.periods;
        let periods = [shortest, longest, 1.0];
        for (b, period) in
            [low, high, random.random_range(low..high), 1.0].into_iter().flat_map(|b| periods.map(|t| (b, t)))
        {
            let sizes = of.sizes([b, period]);
            for (i, size) in sizes.into_iter().enumerate() {
                for bounds in &bounds {
                    let share = size / bounds[i];
                    assert!(share <= 1.0 + 1e-9, "seed {seed}, b = {b}, T = {period}: {i} is {share} of its bound");
                    largest[i] = largest[i].max(share);
                }
            }
        }
    }
    println!("rms(e), rms(e'), sup|e|, |zeta|_N: {largest:?}");
    assert!(largest[0] > 0.9 && largest[1] > 0.8 && largest[2] > 0.8 && largest[3] > 0.05, "{largest:?}");
}
