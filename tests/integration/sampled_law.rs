//! The law at samples (derivation, section 12): stable on e' = u for every number of oscillators that the samples can tell
//! apart, with the balance of energy of continuous time; and the law that it replaced, which was neither.

use crate::controller::{constant, example};
use crate::support::every;
use faer::Mat;
use proptest::prelude::*;
use sigmastar_lang::spec::{Constant, InternalModel};
use sigmastar_regulator::{Convergence, Design, Discrete, Regulator, Stepper, spectral_radius};

/// The internal model of the paper's example with another mu; T = 1.
fn model(mu: &str) -> InternalModel {
    InternalModel { mu: constant(mu), ..example().internal_model }
}

fn step(samples: u32) -> Constant {
    constant(&format!("1/{samples}"))
}

fn sampled(model: &InternalModel, sigma: &str, n_o: u32, samples: u32) -> (Regulator, Discrete, Convergence) {
    let (sigma, step) = (constant(sigma), step(samples));
    let design = Design::new(model, &sigma, n_o);
    assert!(design.sampling_errors(&step).is_empty());
    let (regulator, discrete) = (design.regulator(), design.discretise(&step).unwrap());
    let sampled = Convergence::new(&design, &step, &regulator, &discrete).unwrap();
    (regulator, discrete, sampled)
}

/// The loop on e' = u in (e, root(N) (z - M e)), found by one sample from each unit vector: it is the code itself that is
/// looked at, not a formula for it.
fn loop_by_probes(regulator: &Regulator, discrete: &Discrete) -> Mat<f64> {
    let (n, m) = (regulator.dimension(), regulator.m());
    let roots: Vec<f64> = regulator.n_diagonal().iter().map(|weight| weight.sqrt()).collect();
    let mut columns = vec![vec![0.0; n + 1]; n + 1];
    for (at, column) in columns.iter_mut().enumerate() {
        let e = if at == 0 { 1.0 } else { 0.0 };
        let zeta = |i: usize| if at == i + 1 { 1.0 / roots[i] } else { 0.0 };
        let z: Vec<f64> = (0..n).map(|i| zeta(i) + m[i] * e).collect();
        let mut stepper = Stepper::starting(regulator.clone(), discrete.clone(), z).unwrap();
        let next = e + discrete.step * stepper.step(e);
        column[0] = next;
        for i in 0..n {
            column[i + 1] = roots[i] * (stepper.state()[i] - m[i] * next);
        }
    }
    Mat::from_fn(n + 1, n + 1, |row, column| columns[column][row])
}

/// The largest radius over these numbers of oscillators, and where it is.
fn largest(mu: &str, sigma: &str, samples: u32, oscillators: impl IntoIterator<Item = u32>) -> (f64, u32) {
    let model = model(mu);
    oscillators.into_iter().fold((0.0, 0), |worst, n_o| {
        let (regulator, discrete, told) = sampled(&model, sigma, n_o, samples);
        let radius = spectral_radius(&loop_by_probes(&regulator, &discrete)).unwrap();
        assert!(radius < 1.0, "mu {mu} sigma {sigma} samples {samples} n_o {n_o}: {radius}");
        assert!((radius - told.spectral_radius()).abs() < 2e-9, "{radius} {told}");
        assert_eq!(told.verdict(), "stable");
        if radius > worst.0 { (radius, n_o) } else { worst }
    })
}

#[test]
fn every_number_of_oscillators_below_half_the_samples_is_stable() {
    for samples in [20, 101, 50].into_iter().step_by(every(2)) {
        for mu in ["0.1", "1", "10"] {
            // sigma enters by 1 - h sigma alone; the other one is for the code.
            for sigma in if samples == 20 { vec!["2", "10"] } else { vec!["2", "10", "47"] } {
                let (radius, n_o) = largest(mu, sigma, samples, 0..samples.div_ceil(2));
                println!(
                    "mu {mu}, sigma {sigma}, {samples} samples: largest radius 1 - {:.3e} at n_o = {n_o}",
                    1.0 - radius
                );
            }
        }
    }
}

#[test]
fn a_thousand_samples_with_few_and_with_all_oscillators() {
    for mu in ["1", "0.1", "10"].into_iter().step_by(every(3)) {
        for sigma in ["2", "10", "47"] {
            let (radius, n_o) = largest(mu, sigma, 1000, [0, 1, 10, 100]);
            println!("mu {mu}, sigma {sigma}, 1000 samples: largest radius 1 - {:.3e} at n_o = {n_o}", 1.0 - radius);
        }
        let (radius, n_o) = largest(mu, "10", 1000, [249, 499]);
        println!("mu {mu}, sigma 10, 1000 samples: largest radius 1 - {:.3e} at n_o = {n_o}", 1.0 - radius);
        // Of all others, and of these, it is proved: 0 < h sigma < 2, K h Nb2 < 2 and no two modes that turn alike.
        let (model, sigma) = (model(mu), constant("47"));
        for n_o in (0..500).step_by(every(83)) {
            let design = Design::new(&model, &sigma, n_o);
            assert!(design.converges(&step(1000)) && design.discretise(&step(1000)).is_some(), "mu {mu}, n_o {n_o}");
        }
        assert!(!Design::new(&model, &sigma, 500).converges(&step(1000)));
    }
}

/// The law that was exported before: e^(Phi h) exactly, the error held over the sample, u = -sigma e + mu M'N (z - M e).
/// Nobody should go back to it: it is unstable for many oscillators.
fn old_law(mu: f64, sigma: f64, n_o: u32, samples: u32) -> f64 {
    let h = 1.0 / f64::from(samples);
    let n = 2 * n_o as usize + 1;
    let (mut matrix, mut sum) = (Mat::<f64>::zeros(n + 1, n + 1), 2.0);
    (matrix[(0, 1)], matrix[(1, 1)], matrix[(1, 0)]) = (h * mu * 2.0, 1.0, -sigma * h);
    for l in 1..=n_o {
        let weight = f64::from(l).powf(-1.5);
        let frequency = std::f64::consts::TAU * f64::from(l);
        let (sine, cosine) = (frequency * h).sin_cos();
        let (at, ratio) = (2 * l as usize, sigma / frequency);
        sum += weight;
        matrix[(0, at)] = h * mu * weight;
        (matrix[(at, at)], matrix[(at + 1, at + 1)]) = (cosine, cosine);
        (matrix[(at, at + 1)], matrix[(at + 1, at)]) = (sine, -sine);
        matrix[(at, 0)] = 1.0 - cosine - ratio * sine;
        matrix[(at + 1, 0)] = sine + ratio * (1.0 - cosine);
    }
    matrix[(0, 0)] = 1.0 - h * sigma - h * mu * sum;
    spectral_radius(&matrix).unwrap()
}

#[test]
fn the_old_law_is_unstable_where_the_new_one_is_not() {
    for (mu, samples, n_o, least, most) in [
        ("1", 50, 20, 1.00005, 1.0003),
        ("1", 50, 24, 1.00005, 1.0003),
        ("10", 50, 20, 1.001, 1.0035),
        ("10", 50, 24, 1.001, 1.0035),
        ("1", 100, 49, 1.00001, 1.0004),
        ("100", 50, 1, 1.0 + 1e-6, 10.0),
    ] {
        for sigma in ["2", "47"] {
            let old = old_law(mu.parse().unwrap(), sigma.parse().unwrap(), n_o, samples);
            println!("the old law: mu {mu}, sigma {sigma}, {samples} samples, n_o {n_o}: {old:.6}");
            assert!(least < old && old < most, "mu {mu} sigma {sigma} samples {samples} n_o {n_o}: {old}");
            largest(mu, sigma, samples, [n_o]);
        }
    }
    // What section 12 calls moderate: few oscillators were stable.
    assert!(old_law(1.0, 2.0, 1, 100) < 1.0);
}

#[test]
fn k_is_a_number_for_which_the_balance_is_proved() {
    for (mu, samples) in [("1/10", 20), ("1", 50), ("10", 101), ("1e6", 1000)] {
        let model = model(mu);
        let (_, discrete, _) = sampled(&model, "2", 3, samples);
        let [gain, sum] = [discrete.gain, discrete.weight_sum].map(|value| rug::Rational::from_f64(value).unwrap());
        assert!(gain * sum < 2 * samples);
        let total = model.weights.total(128);
        assert!(total.upper_f64() <= discrete.weight_sum && discrete.weight_sum < total.upper_f64() * (1.0 + 1e-15));
        let (mu, h) = (mu.parse().unwrap_or(0.1), 1.0 / f64::from(samples));
        let expected = mu / (1.0 + h * mu * discrete.weight_sum / 2.0);
        assert!((discrete.gain / expected - 1.0).abs() < 1e-14);
        // One K for every number of oscillators.
        assert_eq!(sampled(&model, "2", 0, samples).1.gain, discrete.gain);
    }
    // Beyond 2^53 the doubles cannot tell K h Nb2 from 2.
    let model = model("1e30");
    assert!(Design::new(&model, &constant("1"), 1).discretise(&constant("1/10")).is_none());
}

/// zeta'N zeta of zeta = z - M e.
fn energy(regulator: &Regulator, z: &[f64], e: f64) -> f64 {
    let zeta: Vec<f64> = z.iter().zip(regulator.m()).map(|(z, m)| z - m * e).collect();
    regulator.weighted_norm(&zeta).powi(2)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// |zeta_next|^2 = |zeta|^2 - (2 h/K) ((1 - K h b/2) y^2 - y q) on e' = q + u, and e_next = (1 - h sigma) e + h y; the same for
    /// zeta where u is clipped, because z is told what is applied.
    #[test]
    fn the_energy_is_balanced(
        n_o in 0_u32..25, mu in 1_u32..40, sigma in 1_u32..50, clipped in any::<bool>(),
        disturbance in prop::collection::vec(-3.0..3.0_f64, 40), start in -2.0..2.0_f64,
    ) {
        let model = model(&format!("{mu}/4"));
        let (regulator, discrete, _) = sampled(&model, &sigma.to_string(), n_o, 50);
        let discrete = discrete.saturated(clipped.then_some(1.5));
        let (h, gain) = (discrete.step, discrete.gain);
        let b: f64 = regulator.weights.iter().sum();
        prop_assert!(1.0 - gain * h * b / 2.0 >= 1.0 - gain * h * discrete.weight_sum / 2.0);
        let (mut stepper, mut e) = (Stepper::new(regulator.clone(), discrete.clone()), start);
        for q in disturbance {
            let before = energy(&regulator, stepper.state(), e);
            // v from the state, by the formula.
            let state = stepper.state().to_vec();
            let rotated = discrete.rotations.iter().enumerate().map(|(at, [cosine, sine])| {
                cosine * (state[2 * at + 1] - e) + sine * state[2 * at + 2]
            });
            let v = std::iter::once(state[0] - e).chain(rotated).zip(&regulator.weights).map(|(r, n)| n * r).sum::<f64>();
            let u = stepper.step(e);
            let wanted = gain * v - regulator.sigma * e;
            let expected = if clipped { wanted.clamp(-1.5, 1.5) } else { wanted };
            prop_assert!((u - expected).abs() < 1e-11 * (1.0 + wanted.abs()));
            let next = e + h * (q + u);
            let y = q + gain * v;
            prop_assert!((next - ((1.0 - h * regulator.sigma) * e + h * (y + u - wanted))).abs() < 1e-11 * (1.0 + next.abs() + wanted.abs()));
            let after = energy(&regulator, stepper.state(), next);
            // The clipped part of u moves e and M'z alike: zeta does not see it.
            let fall = 2.0 * h / gain * ((1.0 - gain * h * b / 2.0) * y * y - y * q);
            prop_assert!((after - (before - fall)).abs() < 1e-9 * (1.0 + before + fall.abs()), "{after} {before} {fall}");
            e = next;
        }
    }
}

/// Anti-windup: a disturbance larger than the limit for a while leaves nothing behind in zeta, and e comes back at once.
#[test]
fn clipping_does_not_wind_up() {
    let model = model("1");
    let (regulator, discrete, _) = sampled(&model, "10", 5, 100);
    let run = |limit: Option<f64>| {
        let (mut stepper, mut e, mut largest) =
            (Stepper::new(regulator.clone(), discrete.clone().saturated(limit)), 0.0_f64, 0.0_f64);
        for k in 0..6000 {
            let q = if (2000..2600).contains(&k) { 4.0 } else { (std::f64::consts::TAU * f64::from(k) / 100.0).sin() };
            e += discrete.step * (q + stepper.step(e));
            if k >= 5000 {
                largest = largest.max(e.abs());
            }
        }
        (stepper, e, largest)
    };
    let (free, free_e, free_end) = run(None);
    let (clipped, clipped_e, clipped_end) = run(Some(3.0));
    let m = regulator.m();
    let distance =
        (0..m.len()).map(|i| ((free.state()[i] - m[i] * free_e) - (clipped.state()[i] - m[i] * clipped_e)).abs());
    assert!(distance.fold(0.0, f64::max) < 1e-9);
    assert!((free_end - clipped_end).abs() < 1e-6, "{free_end} {clipped_end}");
}
