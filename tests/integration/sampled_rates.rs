//! Rates for given n_o at samples as a part of claims (derivation, 13.6): against the loops that the data allow, and along solutions.

use crate::support::{Shipped, certified};
use faer::Mat;
use rug::Rational;
use sigmastar_lang::spec::Specification;
use sigmastar_prove::certify::{Ladder, SampledCertification, certify_sampled};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_rational};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::stability::ErrorBox;

const COUNTS: [u32; 4] = [0, 1, 4, 10];

/// The samples of a period that are tried, in this order.
const SAMPLES: [u32; 7] = [60, 120, 250, 500, 2000, 8000, 30000];

/// exp of a matrix, by squaring.
fn exponential(matrix: &Mat<f64>) -> Mat<f64> {
    let n = matrix.nrows();
    let size = (0..n).map(|i| (0..n).map(|j| matrix[(i, j)].abs()).sum::<f64>()).fold(0.0, f64::max);
    let halvings = (size.log2().ceil().max(0.0) as i32) + 6;
    let small = Mat::from_fn(n, n, |i, j| matrix[(i, j)] / 2f64.powi(halvings));
    let (mut sum, mut term) = (Mat::<f64>::identity(n, n), Mat::<f64>::identity(n, n));
    for k in 1..12 {
        term = &term * &small;
        term = Mat::from_fn(n, n, |i, j| term[(i, j)] / f64::from(k));
        sum += &term;
    }
    (0..halvings).fold(sum, |power, _| &power * &power)
}

/// How fast linear plants with one state converge at samples, at the periodic solution: `x' = -a x + g e`, `q = r x + d e` with P = p_up, u
/// held by the law; all of |g| = k_f, |r| = b_qx and the ends and the middle of d are within the data. The slowest of all signs.
fn slowest(data: &Data<'_>, error_box: &ErrorBox<Enclosure>, run: &SampledCertification<'_>, n_o: u32) -> f64 {
    let of = |value: &Enclosure| value.midpoint_f64();
    let proof = run.claim().expect("certified");
    let (law, sigma) = (&proof.evaluation.law, proof.witness.sigma.to_f64());
    let (h, k) = (of(&law.step), of(&law.gain));
    let (a, k_f, k_x) = (of(&error_box.rate), of(&error_box.k_f), of(&error_box.k_x) * of(&data.p_low).sqrt());
    // Where q does not have x, e does not have its rate either.
    let a = if k_x == 0.0 { 1e3 / h } else { a };
    let (below, above) = (-of(&error_box.sector.below), of(&error_box.sector.above));
    let weight = |l: usize| data.spec.internal_model.weights.weight(l as u64, 128).midpoint_f64();
    let angle = std::f64::consts::TAU / f64::from(law.samples);
    let order = 2 * n_o as usize + 1;
    // M'N R: what the law sees of zeta.
    let seen = |j: usize| match j {
        0 => weight(0),
        _ => {
            let l = j.div_ceil(2);
            let (sin, cos) = (angle * l as f64).sin_cos();
            weight(l) * if j % 2 == 1 { cos } else { sin }
        }
    };
    let turned = |i: usize, j: usize| {
        if i == 0 || j == 0 || i.div_ceil(2) != j.div_ceil(2) {
            return if i == j { 1.0 } else { 0.0 };
        }
        let (sin, cos) = (angle * i.div_ceil(2) as f64).sin_cos();
        if i == j { cos } else if i < j { sin } else { -sin }
    };
    let mut found = f64::INFINITY;
    for sign in [-1.0, 0.0, 1.0] {
        for d in [below, f64::midpoint(below, above), above] {
            // (x, e, u) within a sample.
            let within = exponential(&Mat::from_fn(3, 3, |i, j| {
                h * [[-a, sign * k_f, 0.0], [k_x, d, 1.0], [0.0; 3]][i][j]
            }));
            // (x, e, zeta): e+ = (1 - h sigma) e + h y, zeta+ = R zeta - h M y.
            let control = |j: usize| match j {
                0 => 0.0,
                1 => -sigma,
                _ => k * seen(j - 2),
            };
            let next = |i: usize, j: usize| if j < 2 { within[(i, j)] } else { 0.0 } + within[(i, 2)] * control(j);
            let matrix = Mat::from_fn(order + 2, order + 2, |i, j| {
                if i < 2 {
                    return next(i, j);
                }
                let moved = next(1, j) - if j == 1 { 1.0 - h * sigma } else { 0.0 };
                let in_m = i == 2 || (i - 2) % 2 == 1;
                let own = if j >= 2 { turned(i - 2, j - 2) } else { 0.0 };
                own - if in_m { moved } else { 0.0 }
            });
            let values = matrix.eigenvalues().expect("finite");
            found = values.iter().map(|value| -value.norm().ln() / h).fold(found, f64::min);
        }
    }
    found
}

/// At 1.5 times the certified gain each rate is at least a share of that of the slowest of a few members, and never more: by the median 0.3.
#[test]
fn rates_at_samples_are_near_those_of_the_loops() {
    let mut shares: Vec<(f64, String)> = Vec::new();
    for Shipped { name, spec, .. } in certified() {
        let found = SAMPLES.iter().find_map(|samples| {
            let mut document = spec.document.clone();
            document["internal_model"]["sampling_period"] = format!("({})/{samples}", spec.period.nominal().text).into();
            let sampling = Specification::from_json("sampled", &document.to_string()).ok()?.internal_model.sampling?;
            let least = certify_sampled(spec, &sampling, None, None, Ladder::default()).ok()?;
            let gain = Rational::from(&least.claim()?.witness.sigma * Rational::from((3, 2)));
            let gain = round_rational(&gain, 6, Direction::Up);
            let run = certify_sampled(spec, &sampling, Some(&gain), None, Ladder::default()).ok()?;
            run.claim().is_some().then_some(run)
        });
        let Some(mut run) = found else {
            println!("{name}: no claim at samples");
            continue;
        };
        run.prove_rates(&COUNTS).expect("by norms");
        let proof = run.claim().expect("certified");
        let data = Data::new(spec, 128);
        let periodic = [&proof.evaluation.size.x_per, &proof.evaluation.size.e_per];
        let there = ErrorBox::new(&data, proof.witness.paths, periodic, [&data.zero(), &data.zero()]);
        for found in &run.for_n_o {
            let n_o = found.n_o;
            let true_rate = slowest(&data, &there, &run, n_o);
            let Some(bound) = found.bound.as_ref() else {
                println!("{name} {n_o}: no rate ({true_rate})");
                shares.push((0.0, format!("{name} {n_o}")));
                continue;
            };
            let share = bound.rate.to_f64() / true_rate;
            println!("{name} N_s = {} n_o = {n_o}: rate {} of {true_rate} share {share} factor {}", run.sampling.samples, bound.rate.to_f64(), bound.factor.to_f64());
            assert!(share <= 1.0 + 1e-9, "{name} {n_o}: {share}");
            assert!(bound.factor.to_f64() >= proof.witness.set.e0.to_f64(), "{name} {n_o}");
            shares.push((share, format!("{name} {n_o}")));
        }
    }
    shares.sort_by(|a, b| a.0.total_cmp(&b.0));
    let median = shares[shares.len() / 2].0;
    println!("{shares:?}");
    assert!(median >= 0.3, "{median} {shares:?}");
}
