use super::*;
use crate::certify::{Certification, Options, Wanted, certify_for};
use crate::rate::found::RateForCount;
use faer::linalg::solvers::DenseSolveCore;
use faer::{Mat, c64};
use sigmastar_lang::spec::{Oscillators, Specification};
use sigmastar_theory::derivation::stability::ErrorBox;

const COUNTS: [u32; 4] = [0, 1, 4, 10];

/// A shipped specification with further fields, at 1.5 times a gain.
fn with(text: &str, fields: &str) -> Specification {
    let text = text.replacen("\"internal_model\"", &format!("{fields} \"internal_model\""), 1);
    Specification::from_json("test", &text).expect("a sound specification")
}

fn certified<'s>(spec: &'s Specification, gain: &str, counts: &[u32]) -> Certification<'s> {
    let gain = sigmastar_exact::number::parse_decimal(gain).expect("a decimal");
    let options = Options { compare: false, ..Options::default() };
    let mut run = certify_for(spec, options, Wanted { gain: Some(&gain), ..Wanted::default() }).expect("not refuted");
    assert_eq!(run.sigma_star(), Some(&gain));
    run.prove_rates(&counts.iter().copied().map(Oscillators::first).collect::<Vec<_>>()).expect("by norms");
    run
}

/// The largest |e| that inputs of these sizes, d and v, lead to in linear plants with one state within the data (those of
/// `rates_of_claims`): the integrals of |impulse response|, which the inputs reach that change sign with it; and the largest |e| from z = M v, all else at
/// rest, as an aligned start is misled. The same of u.
fn worst(
    data: &Data<'_>,
    there: &ErrorBox<Enclosure>,
    sigma: f64,
    n_o: u32,
    [d_bar, v_bar]: [f64; 2],
) -> [[f64; 2]; 2] {
    let of = |value: &Enclosure| value.midpoint_f64();
    let (a, k_f, k_x) = (of(&there.rate), of(&there.k_f), of(&there.k_x) * of(&data.p_low).sqrt());
    let (mu, w) = (of(&data.mu), of(&data.base_frequency));
    let weight = |l: usize| data.spec.internal_model.weights.weight(l as u64, 128).midpoint_f64();
    let order = 2 * n_o as usize + 3;
    let total: f64 = (0..=n_o as usize).map(weight).sum();
    let of_state = |i: usize| if i == 2 { Some(0) } else { (i % 2 == 1 && i > 2).then(|| (i - 1) / 2) };
    let mut found = [[0.0_f64; 2]; 2];
    for sign in [-1.0, 1.0] {
        for slope in [-of(&there.sector.below), of(&there.sector.above)] {
            // The law with e + v, in (x, e, z): e' = r x + slope e + d + u, u = -sigma (e + v) + mu sum n_l (z_l - e - v).
            let matrix = Mat::from_fn(order, order, |i, j| match (i, j) {
                (0, 0) => -a,
                (0, 1) => sign * k_f,
                (0, _) => 0.0,
                (1, 0) => k_x,
                (1, 1) => slope - sigma - mu * total,
                (1, j) => of_state(j).map_or(0.0, |l| mu * weight(l)),
                (i, 1) => match of_state(i) {
                    Some(_) => -sigma,
                    None => ((i - 2) / 2) as f64 * w,
                },
                (i, j) if i > 2 && i % 2 == 1 && j == i + 1 => ((i - 1) / 2) as f64 * w,
                (i, j) if i > 2 && i % 2 == 0 && j == i - 1 => -(((i - 2) / 2) as f64) * w,
                _ => 0.0,
            });
            // v comes in where e is measured.
            let of_d: Vec<f64> = (0..order).map(|i| f64::from(u8::from(i == 1))).collect();
            let of_v: Vec<f64> =
                (0..order).map(|i| matrix[(i, 1)] - [sign * k_f, slope].get(i).unwrap_or(&0.0)).collect();
            let of_start: Vec<f64> = (0..order).map(|i| f64::from(u8::from(of_state(i).is_some()))).collect();
            let eigen = matrix.eigen().expect("finite");
            let values: Vec<c64> = eigen.S().column_vector().iter().copied().collect();
            let inverse = eigen.U().partial_piv_lu().inverse();
            // e and u, but for what v is in it directly.
            let outputs: [Vec<f64>; 2] = [
                (0..order).map(|i| f64::from(u8::from(i == 1))).collect(),
                (0..order).map(|j| matrix[(1, j)] - [k_x, slope].get(j).unwrap_or(&0.0)).collect(),
            ];
            // The integral of the size of an output from this start, and its largest value.
            let response = |input: &[f64], output: &[f64]| {
                let residues: Vec<c64> = (0..order)
                    .map(|k| {
                        (0..order).fold(c64::new(0.0, 0.0), |sum, i| sum + inverse[(k, i)] * input[i])
                            * (0..order).fold(c64::new(0.0, 0.0), |sum, i| sum + eigen.U()[(i, k)] * output[i])
                    })
                    .collect();
                let slowest = values.iter().map(|value| -value.re).fold(f64::INFINITY, f64::min);
                let largest = values.iter().fold(0.0_f64, |size, value| size.max(value.norm()));
                assert!(slowest > 0.0);
                // First as fast as the fastest mode, then as the fastest that is left, in runs of equal steps.
                let (mut sum, mut most, mut t) = (0.0, 0.0_f64, 0.0);
                while t < 8.0 / slowest {
                    let left = values.iter().filter(|value| -value.re * t < 20.0);
                    let fastest = left.fold(0.0_f64, |size, value| size.max(value.norm())).min(largest);
                    let h = 0.1 / fastest;
                    let at = |value: c64, time: f64| {
                        let size = (value.re * time).exp();
                        c64::new(size * (value.im * time).cos(), size * (value.im * time).sin())
                    };
                    let mut modes: Vec<c64> = residues
                        .iter()
                        .zip(&values)
                        .map(|(residue, value)| residue * at(*value, t + 0.5 * h))
                        .collect();
                    let turns: Vec<c64> = values.iter().map(|value| at(*value, h)).collect();
                    for _ in 0..1000 {
                        let size = modes.iter().map(|mode| mode.re).sum::<f64>().abs();
                        (sum, most) = (sum + size * h, most.max(size));
                        modes.iter_mut().zip(&turns).for_each(|(mode, turn)| *mode *= turn);
                    }
                    t += 1000.0 * h;
                }
                [sum, most]
            };
            for ((output, directly), found) in outputs.iter().zip([0.0, sigma + mu * total]).zip(&mut found) {
                let [[of_d, _], [of_v, _], [_, of_start]] =
                    [&of_d, &of_v, &of_start].map(|input| response(input, output));
                *found = [found[0].max(d_bar * of_d + v_bar * (of_v + directly)), found[1].max(v_bar * of_start)];
            }
        }
    }
    found
}

/// No bound is below what a member of the data does under the worst inputs, and none is far above it.
#[test]
fn limits_are_above_what_the_worst_inputs_do() {
    let specs = [
        ("paper-example-at-rest", include_str!("../../../../../specs/paper-example-at-rest.json"), "39.8919"),
        ("no-x", include_str!("../../../../../specs/no-x.json"), ""),
        ("linear", include_str!("../../../../../specs/linear.json"), ""),
    ];
    for (name, text, gain) in specs {
        for (fields, sizes) in [
            ("\"disturbance\": \"1e-6\",", [1e-6, 0.0]),
            ("\"measurement\": { \"noise\": \"1e-9\" },", [0.0, 1e-9]),
            ("\"measurement\": { \"quantum\": \"2e-8\" }, \"disturbance\": \"1e-6\",", [1e-6, 1e-8]),
        ] {
            let spec = with(text, fields);
            let gain = if gain.is_empty() {
                let run =
                    crate::certify::certify(&spec, Options { compare: false, ..Options::default() }).expect("run");
                sigmastar_exact::number::write_exact(&(Rational::from((3, 2)) * run.sigma_star().expect("certified")))
            } else {
                gain.to_owned()
            };
            let begin = std::time::Instant::now();
            let run = certified(&spec, &gain, &COUNTS);
            let seconds = begin.elapsed().as_secs_f64();
            let proof = run.sharp.proved().expect("certified");
            let data = Data::new(&spec, 128);
            let periodic = [&proof.evaluation.periodic.x_per, &proof.evaluation.periodic.e_per];
            let there = ErrorBox::new(&data, proof.witness.paths, periodic, [&data.zero(), &data.zero()]);
            for RateForCount { oscillators, noise, .. } in &run.for_n_o {
                let n_o = oscillators.largest();
                let noise =
                    noise.as_ref().expect("asked").as_ref().unwrap_or_else(|why| panic!("{name} {n_o}: {why:?}"));
                assert_eq!(noise.misled, 0);
                let [[worst, _], [worst_control, _]] =
                    worst(&data, &there, gain.parse().expect("a decimal"), n_o, sizes);
                let ratio = noise.limit.to_f64() / worst;
                println!(
                    "{name} {n_o} {fields} gain {gain} limit {:.4e} worst {worst:.4e} ratio {ratio:.3} of u {:.3} lambda {:.3e} {seconds:.1} s",
                    noise.limit.to_f64(),
                    noise.control.as_ref().expect("proved").to_f64() / worst_control,
                    noise.proof.witness.rate.to_f64()
                );
                let of_control = noise.control.as_ref().expect("proved").to_f64() / worst_control;
                assert!(ratio >= 1.0 && of_control >= 1.0, "{name} {n_o} {fields}: {ratio} {of_control}");
            }
        }
    }
}

/// What misleads an aligned start moves e by no more than is said, and not by far less; a disturbance misleads none.
#[test]
fn an_aligned_start_is_misled_by_what_is_measured() {
    let text = include_str!("../../../../../specs/linear.json").replace(r#""kind": "paper""#, r#""kind": "aligned""#);
    let shipped = Specification::from_json("test", &text).expect("a sound specification");
    let found =
        crate::certify::certify(&shipped, Options { compare: false, ..Options::default() }).expect("not refuted");
    let sigma = Rational::from((3, 2)) * found.sigma_star().expect("certified");
    let gain = sigmastar_exact::number::write_exact(&sigma);
    let spec = with(&text, r#""measurement": { "noise": "1e-9" },"#);
    let run = certified(&spec, &gain, &COUNTS);
    let proof = run.sharp.proved().expect("certified");
    let data = Data::new(&spec, 128);
    let periodic = [&proof.evaluation.periodic.x_per, &proof.evaluation.periodic.e_per];
    let there = ErrorBox::new(&data, proof.witness.paths, periodic, [&data.zero(), &data.zero()]);
    for RateForCount { oscillators, noise, .. } in &run.for_n_o {
        let n_o = oscillators.largest();
        let noise = noise.as_ref().expect("asked").as_ref().expect("proved");
        let [[_, largest], [of_inputs, of_start]] =
            worst(&data, &there, gain.parse().expect("a decimal"), n_o, [0.0, 1e-9]);
        let ratio = noise.misled.to_f64() / largest;
        let of_control = noise.control.as_ref().expect("proved").to_f64() / (of_inputs + of_start);
        println!("n_o = {n_o}: {:.4e}, {ratio:.3} times what is simulated, u {of_control:.3}", noise.misled.to_f64());
        assert!((1.0..20.0).contains(&ratio) && of_control >= 1.0, "{n_o}: {ratio} {of_control}");
    }
    let quiet = with(&text, r#""disturbance": "1e-9","#);
    assert!(
        certified(&quiet, &gain, &[1])
            .for_n_o
            .iter()
            .all(|found| found.proved_noise().is_some_and(|noise| noise.misled == 0))
    );
}
