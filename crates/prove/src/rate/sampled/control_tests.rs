use crate::certify::certify_sampled;
use crate::rate::found::SampledRateForCount;
use rug::Rational;
use sigmastar_decide::conditions::Ladder;
use sigmastar_lang::spec::{Oscillators, Specification};

const H: f64 = 1.0 / 200.0;
const SIGMA: f64 = 8.0;

/// The law of [`Specification`]s with mu = 1 and w = 2 pi, as the exported code runs it, with a plant e' = slope e + d + u of which d is held over a sample.
struct Loop {
    weights: Vec<f64>,
    gain: f64,
    slope: f64,
}

impl Loop {
    /// e and u at each sample, from z = M z_0 and e = 0, with this d and v in the first sample alone.
    fn responses(&self, [d, v, z_0]: [f64; 3], samples: usize) -> Vec<[f64; 2]> {
        let grown = (self.slope * H).exp();
        let mut z = vec![[z_0, 0.0]; self.weights.len()];
        let mut e = 0.0;
        let one = |k: usize| {
            let [d, v] = if k == 0 { [d, v] } else { [0.0; 2] };
            let measured = e + v;
            let mut sum = 0.0;
            for (l, (z, weight)) in z.iter_mut().zip(&self.weights).enumerate() {
                let (sin, cos) = (std::f64::consts::TAU * l as f64 * H).sin_cos();
                let [a, b] = [z[0] - measured, z[1]];
                *z = [cos * a + sin * b, cos * b - sin * a];
                sum += weight * z[0];
                z[0] += (1.0 - H * SIGMA) * measured;
            }
            let u = self.gain * sum - SIGMA * measured;
            let before = e;
            e = grown * e + (grown - 1.0) / self.slope * (u + d);
            [before, u]
        };
        (0..samples).map(one).collect()
    }
}

/// No bound of e or u is below what the worst inputs of a member do, which change sign with the responses, and an aligned start that noise misleads: by the law
/// itself, step by step.
#[test]
fn bounds_are_above_what_the_worst_inputs_do_at_samples() {
    let text = include_str!("../../../../../specs/no-x.json").replace(r#""kind": "paper""#, r#""kind": "aligned""#);
    let [d_bar, v_bar] = [1e-7, 1e-8];
    let inputs = r#""sampling_period": "1/200", "mu""#;
    let text = text.replacen("\"mu\"", inputs, 1);
    let noise = r#""measurement": { "noise": "1e-8" }, "disturbance": "1e-7", "internal_model""#;
    let text = text.replacen("\"internal_model\"", noise, 1);
    let spec = Specification::from_json("test", &text).expect("a sound specification");
    let sampling = spec.internal_model.sampling.clone().expect("sampled");
    let sigma = Rational::from(8);
    let mut run = certify_sampled(&spec, &sampling, Some(&sigma), None, Ladder::default()).expect("not refuted");
    run.prove_rates(&[0, 1, 3].map(Oscillators::first)).expect("by norms");
    let gain = run.claim().expect("certified").evaluation.law.gain.midpoint_f64();
    for SampledRateForCount { oscillators, noise, .. } in &run.for_n_o {
        let n_o = oscillators.largest();
        let noise = noise.as_ref().expect("asked").as_ref().unwrap_or_else(|why| panic!("{n_o}: {why:?}"));
        let weights: Vec<f64> =
            (0..=n_o).map(|l| spec.internal_model.weights.weight(u64::from(l), 128).midpoint_f64()).collect();
        for slope in [-1.0, 1.0] {
            let of = Loop { weights: weights.clone(), gain, slope };
            let sums = |input| {
                let all = of.responses(input, 40_000);
                [0, 1].map(|which| all.iter().map(|now| now[which].abs()).sum::<f64>())
            };
            let (of_d, of_v) = (sums([d_bar, 0.0, 0.0]), sums([0.0, v_bar, 0.0]));
            let start = of.responses([0.0, 0.0, v_bar], 40_000);
            let largest = [0, 1].map(|which| start.iter().map(|now| now[which].abs()).fold(0.0, f64::max));
            let worst = [0, 1].map(|which| of_d[which] + of_v[which]);
            let control = noise.control.as_ref().expect("proved").to_f64();
            let shares = [
                worst[0] / noise.limit.to_f64(),
                largest[0] / noise.misled.to_f64(),
                (worst[1] + largest[1]) / control,
            ];
            println!("n_o = {n_o}, slope {slope}: {shares:?} of what is said of e, of the start, and of u");
            assert!(shares.iter().all(|share| *share <= 1.0 && *share > 0.02), "{n_o} {slope}: {shares:?}");
        }
    }
}
