use super::bound::bound;
use crate::certify::certify_sampled;
use crate::rate::bound::{Place, RateBound};
use rug::Rational;
use sigmastar_decide::conditions::Ladder;
use sigmastar_decide::rates::OscillatorMatrix;
use sigmastar_decide::rates::at_samples::*;
use sigmastar_decide::rates::inequality::LoopBounds;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::{Oscillators, Specification};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::initial_set::claimed_distances;
use sigmastar_theory::derivation::sampled::SampledLaw;

/// The paper's example at so many samples of a period of 1, with an input gain in an interval.
fn example(samples: u32, [low, high]: [&str; 2]) -> Specification {
    let text = include_str!("../../../../../specs/paper-example.json");
    let mut document: serde_json::Value = serde_json::from_str(text).expect("JSON");
    document["internal_model"]["sampling_period"] = format!("1/{samples}").into();
    document["input_gain"] = serde_json::json!({ "nominal": "1", "low": low, "high": high });
    Specification::from_json("test", &document.to_string()).expect("a sound specification")
}

fn law(data: &Data<'_>) -> SampledLaw<Enclosure> {
    let model = &data.spec.internal_model;
    let sampling = model.sampling.clone().expect("sampled");
    let gain = model.sampled_gain(&sampling.step).expect("a gain");
    SampledLaw::new(data, &sampling, &gain)
}

fn rational(p: i32, q: i32) -> Rational {
    Rational::from((p, q))
}

fn bounds() -> LoopBounds {
    LoopBounds {
        has_x: true,
        x_decay: rational(1, 4),
        root_p_up: rational(5, 4),
        k_x: rational(3, 1),
        k_f: rational(8, 7),
        slopes: [rational(-7, 6), rational(2, 3)],
    }
}

/// Doubles in [-1, 1) from a linear congruence.
fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / 2f64.powi(52) - 1.0
    }
}

fn double(value: f64) -> Rational {
    Rational::from_f64(value).expect("finite")
}

/// The first few numbers of oscillators, and sets with gaps.
fn sets() -> impl Iterator<Item = Oscillators> {
    let with_gaps = [&[0, 2][..], &[0, 2, 5]].map(|set| Oscillators::at(set).expect("a set"));
    (0..4).map(Oscillators::first).chain(with_gaps)
}

/// The entries against the words of Proposition R_h, written out with zeta itself, at both gains.
#[test]
fn the_matrix_is_that_of_the_quadratic_form() {
    let spec = example(40, ["3/4", "3/2"]);
    let data = Data::new(&spec, 128);
    let (law, bounds, sigma) = (law(&data), bounds(), rational(30, 1));
    let (h, k) = (1.0 / 40.0, law.gain.midpoint_f64());
    let s = 30.0;
    // Section 13.6, in doubles.
    let (k_l, m, k_x) = (7.0 / 6.0, 2.0 / 3.0, 3.0);
    let k_e: f64 = 7.0 / 6.0;
    let kp = 1.0 - h * k_e / std::f64::consts::PI;
    let g = h * k_e / 12f64.sqrt() / kp;
    let g2 = h * h * k_e * k_e / (6.0 * kp);
    let c_x = h * k_x / (std::f64::consts::PI * kp);
    let c_e = (1.0 - h * s + h * h * s * s / 3.0).sqrt() + h * k_e / (std::f64::consts::PI * kp);
    let c_y = h / (3f64.sqrt() * kp);
    let [lo1, hi1] = [-(1.0 - h * s / 2.0) * k_l - g * k_e, (1.0 - h * s / 2.0) * m + g * k_e];
    let [lo2, hi2] = [-h / 2.0 * k_l - g2, h / 2.0 * m + g2];
    for set in sets() {
        let oscillators = OscillatorMatrix::new(&data, &set);
        let dynamics = SampledDynamics::new(&data, (&oscillators, &law), &sigma, &bounds).expect("kp > 0");
        let harmonics: Vec<usize> = set.all().map(|l| l as usize).collect();
        let n = 2 * harmonics.len();
        let mut next = numbers(harmonics.len() as u64);
        let mut positive = || 1.5 + next();
        let [c, l_slope, l_hold, w, l_x, l_e, l_y] = std::array::from_fn(|_| positive());
        let pi: Vec<Vec<f64>> = (0..n).map(|i| (0..=i).map(|_| next()).collect()).collect();
        let witness = SampledRateWitness {
            pi: pi.iter().map(|row| row.iter().map(|entry| double(*entry)).collect()).collect(),
            c: double(c),
            l_slope: double(l_slope),
            l_hold: double(l_hold),
            of_x: Some(OfX { w: double(w), l_x: double(l_x), l_e: double(l_e), l_y: double(l_y) }),
            inputs: Inputs { g_d: Some(double(0.5)), g_v: Some(double(0.75)), g_r: Some(double(0.25)) },
        };
        let v: Vec<f64> = (0..n + 9).map(|_| next()).collect();
        let weighted = Weighted::new(&dynamics, &witness.pi);
        for (b_u, gain) in [0.75, 1.5].into_iter().zip(dynamics.gains()) {
            let form = weighted.form(&witness, &gain);
            assert_eq!(form.order, n + 9);
            let pairs = (0..n + 9).flat_map(|i| (0..n + 9).map(move |j| (i, j)));
            let value: f64 = pairs.map(|(i, j)| v[i] * v[j] * form.at(i, j).midpoint_f64()).sum();

            let (x, y) = (v[0], &v[1..=n]);
            let [w1, w2, p, rho_e, rho_y, d, noise, rho_d] = std::array::from_fn(|at| v[n + 1 + at]);
            let weight = |l: usize| if l == 0 { 2.0 } else { (l as f64).powf(-1.5) };
            let oscillator = |state: usize| harmonics[state.div_ceil(2)];
            let first = |state: usize| state == 0 || state % 2 == 1;
            let zeta: Vec<f64> = (0..n - 1).map(|i| y[i + 1] / weight(oscillator(i)).sqrt()).collect();
            // R zeta by the angle of each oscillator.
            let turn = |zeta: &[f64]| -> Vec<f64> {
                let of = |i: usize| {
                    let (sin, cos) = (std::f64::consts::TAU * oscillator(i) as f64 * h).sin_cos();
                    match (i, first(i)) {
                        (0, _) => zeta[0],
                        (_, true) => cos * zeta[i] + sin * zeta[i + 1],
                        (_, false) => -sin * zeta[i - 1] + cos * zeta[i],
                    }
                };
                (0..n - 1).map(of).collect()
            };
            let see = |turned: &[f64]| -> f64 {
                (0..n - 1).filter(|i| first(*i)).map(|i| weight(oscillator(i)) * turned[i]).sum()
            };
            let m_vector: Vec<f64> = (0..n - 1).map(|i| f64::from(u8::from(first(i)))).collect();
            let (turned, of_m) = (turn(&zeta), turn(&m_vector));
            let seen = see(&turned);
            let e = y[0];
            let y_u = (1.0 - b_u) * s * e + b_u * k * seen + w1 + w2 + p + d - b_u * (s + k * see(&of_m)) * noise;
            let mut after = vec![(1.0 - h * s) * e + h * y_u];
            after.extend((0..n - 1).map(|i| {
                let moved = turned[i] - m_vector[i] * h * y_u + ((1.0 - h * s) * m_vector[i] - of_m[i]) * noise;
                moved * weight(oscillator(i)).sqrt()
            }));
            let norm = |z: &[f64]| -> f64 {
                (0..n)
                    .flat_map(|i| (0..n).map(move |j| (i, j)))
                    .map(|(i, j)| z[i] * z[j] * pi[i.max(j)][i.min(j)])
                    .sum()
            };
            let kf = h * 1.25 * 8.0 / 7.0;
            let rho = c_x * x + rho_e + rho_y + rho_d;
            let expected = -w * (-2.0 * 0.25 * h * x * x + 2.0 * kf * x * rho + c * (x + kf * rho).powi(2))
                - (1.0 + c) * norm(&after)
                + norm(y)
                - l_slope * (hi1 * e - w1) * (w1 - lo1 * e)
                - l_hold * (hi2 * y_u - w2) * (w2 - lo2 * y_u)
                - l_x * ((k_x * (1.0 + g) * x).powi(2) - p * p)
                - l_e * ((c_e * e).powi(2) - rho_e * rho_e)
                - l_y * ((c_y * y_u).powi(2) - rho_y * rho_y)
                + 0.5 * d * d
                + 0.75 * noise * noise
                + 0.25 * rho_d * rho_d;
            assert!((value - expected).abs() < 1e-9 * (1.0 + expected.abs()), "{set} {b_u}: {value} {expected}");
        }
    }
}

/// A proof stays one with numbers a little off, and none of those that make it false passes.
#[test]
fn what_is_not_positive_definite_is_not_proved() {
    let spec = example(2000, ["0.9", "1.1"]);
    let sampling = spec.internal_model.sampling.clone().expect("sampled");
    let gain = rational(75, 1);
    let run = certify_sampled(&spec, &sampling, Some(&gain), None, Ladder::default()).expect("not refuted");
    let proof = run.claim().expect("certified");
    let data = Data::new(&spec, 128);
    let evaluation = &proof.evaluation;
    let periodic = [&evaluation.size.x_per, &evaluation.size.e_per, &evaluation.z];
    let distances = claimed_distances(&data, &proof.witness.set, periodic);
    let place = Place { sigma: &gain, error_box: &evaluation.error_box, distances: distances.each_ref() };
    let found = bound(&data, &evaluation.law, &place, &Oscillators::first(2)).expect("a rate");
    let RateBound { proof: witness, rate, .. } = found;
    assert!(rate > 0);
    let bounds = LoopBounds::of_error(&data, &evaluation.error_box).expect("bounded");
    let proves = |n_o: u32, sigma: &Rational, bounds: &LoopBounds, witness: &SampledRateWitness| {
        let oscillators = OscillatorMatrix::new(&data, &Oscillators::first(n_o));
        let dynamics = SampledDynamics::new(&data, (&oscillators, &evaluation.law), sigma, bounds);
        dynamics.is_some_and(|dynamics| dynamics.proves(witness))
    };
    assert!(proves(2, &gain, &bounds, &witness));
    let altered = |change: &dyn Fn(&mut SampledRateWitness)| {
        let mut other = witness.clone();
        change(&mut other);
        proves(2, &gain, &bounds, &other)
    };
    assert!(altered(&|other| other.c = Rational::from(&witness.c / 2)));
    assert!(!altered(&|other| other.c = Rational::from(&witness.c * 2)));
    assert!(!altered(&|other| other.c = Rational::new()));
    assert!(!altered(&|other| other.of_x = None));
    assert!(!altered(&|other| other.pi[1][1] = -other.pi[1][1].clone()));
    assert!(!altered(&|other| other.pi.truncate(4)));
    for scale in [-1, 0, 100] {
        assert!(!altered(&|other| other.l_slope *= scale), "{scale}");
        assert!(!altered(&|other| other.l_hold *= Rational::from(scale * 1000)), "{scale}");
        for which in 0..4 {
            let change = |other: &mut SampledRateWitness| {
                let OfX { w, l_x, l_e, l_y } = other.of_x.as_mut().expect("with x");
                *[w, l_x, l_e, l_y][which] *= Rational::from(scale * 1000);
            };
            assert!(!altered(&change), "{which} {scale}");
        }
    }
    // The other loop, and a plant with more of it.
    assert!(!proves(3, &gain, &bounds, &witness));
    assert!(!proves(2, &Rational::from(&gain * 2), &bounds, &witness));
    for change in [
        (|bounds: &mut LoopBounds| bounds.x_decay /= 4) as fn(&mut LoopBounds),
        |bounds| bounds.k_x *= 4,
        |bounds| bounds.k_f *= 4,
        |bounds| bounds.slopes[0] *= 20,
        |bounds| bounds.slopes[1] += 40,
    ] {
        let mut other = bounds.clone();
        change(&mut other);
        assert!(!proves(2, &gain, &other, &witness), "{other:?}");
    }
}

/// u of the differences is `-sigma e + K M'N R zeta`, written out with zeta itself, whatever the input gain.
#[test]
fn the_control_is_that_of_the_law() {
    let spec = example(40, ["3/4", "3/2"]);
    let data = Data::new(&spec, 128);
    let (law, bounds) = (law(&data), bounds());
    let mut next = numbers(11);
    for set in sets() {
        let oscillators = OscillatorMatrix::new(&data, &set);
        let dynamics = SampledDynamics::new(&data, (&oscillators, &law), &rational(30, 1), &bounds).expect("kp > 0");
        let weight = |l: u32| spec.internal_model.weights.weight(u64::from(l), 128).midpoint_f64();
        let control = dynamics.control();
        assert_eq!(control.len(), 2 * set.count() + 2);
        let e = next();
        let mut y = vec![e];
        let mut sum = 0.0;
        for l in set.all() {
            let angle = data.base_frequency.midpoint_f64() * f64::from(l) / 40.0;
            let zeta = [next(), if l == 0 { 0.0 } else { next() }];
            sum += weight(l) * (zeta[0] * angle.cos() + zeta[1] * angle.sin());
            y.extend(zeta.iter().take(if l == 0 { 1 } else { 2 }).map(|value| value * weight(l).sqrt()));
        }
        let found: f64 = control.iter().zip(&y).map(|(entry, y)| entry.midpoint_f64() * y).sum();
        let expected = -30.0 * e + law.gain.midpoint_f64() * sum;
        assert!((found - expected).abs() < 1e-12 * (1.0 + expected.abs()), "{set}: {found} {expected}");
    }
}
