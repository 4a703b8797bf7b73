//! The matrix inequality of existence (docs/mathematics.md, 13.7, (E)) on linear loops with periodic coefficients. A semidefinite
//! program proposes it, the engine decides it, and the library's bounds are never below the periodic solution, which is computed
//! harmonic by harmonic in doubles: of random forces, and of the worst one for each bound.
//!
//! `SIGMASTAR_CASES=0..300 cargo test --release --test integration periodic_bounds` takes other seeds than an ordinary run.

mod answers;
mod linear_loop;

use crate::support::cases;
use answers::{Answers, FORCED};
use linear_loop::{Loop, Weights};
use nalgebra::{Complex, DMatrix, DVector};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::energy::{EnergyBounds, EnergyNumbers};
use sigmastar_theory::derivation::harmonics::AtOrigin;
use sigmastar_theory::derivation::mean_squares::{ErrorGains, Forcing, Gains};
use std::f64::consts::TAU;

/// Seeds of an ordinary run, and of a night.
const SEEDS: [u64; 2] = [8, 300];

/// How far beyond a bound the rounding of the solution may lead.
const ROUNDING: f64 = 1e-9;

/// Random forces beside the worst ones.
const RANDOM_FORCES: usize = 2;

/// What is compared with a bound of (13.7d), and the share of the bound that some loop reaches.
const COMPARED: [(&str, f64); 6] = [
    ("rms(v) / r_y", 0.98),
    ("rms(e) / (k_p Q_m/(2 sqrt(c_e c_y)))", 0.98),
    ("rms(x) / (k_p Q_m/(2 sqrt(c_x c_y)))", 0.98),
    ("sup|e| / (bt r_y)", 0.9),
    ("rms(e) / (r_y/sg)", 0.98),
    ("rms(e') / r_y", 0.98),
];

/// The ratios of a solution to its bounds, in the order of [`COMPARED`]; the last harmonic is a part of what is not known of q_0.
fn ratios(
    of: &Loop,
    weights: &Weights,
    answers: &Answers,
    force: &DVector<f64>,
    with_rest: bool,
) -> [f64; COMPARED.len()] {
    let complex = force.map(Complex::from);
    let spectrum = &answers.forces * &complex;
    let known = of.first + FORCED - usize::from(with_rest);
    // The mean has no part in the solution, nor in Q_m.
    let size = |k: usize| if k == 0 { 3.0 } else { spectrum[answers.last as usize + k].norm() };
    let harmonics: Vec<f64> = (0..known).map(size).collect();
    let rest = if with_rest { 2f64.sqrt() * size(known) } else { 0.0 };
    let spec = of.specification(&harmonics, rest);
    let data = Data::new(&spec, 128);
    let exact = |value: f64| data.rational(&Rational::from_f64(value).expect("it is finite"));
    let (sigma, origin) = (exact(of.sigma), AtOrigin::new(&data));
    let [k_p, c_x, c_y, value] = [weights.k_p, weights.c_x, weights.c_y, weights.value].map(exact);
    let bounds = EnergyBounds::new(&EnergyNumbers { k_p, c_x, c_y, value }, &origin, &sigma);
    // Nothing else is known of the forces: no other bound is smaller.
    let unknown = || exact(1e100);
    let forcing = Forcing { q_rms: unknown(), q_rate_rms: unknown(), change: [unknown(), unknown()] };
    let gains = ErrorGains::new(&data, &sigma).with_energy(Some(bounds.clone()));
    let response = gains.response(&origin, &forcing);
    let [v, e, x, e_rate] = answers.signals(of.sigma).map(|signal| (signal * &complex).norm());
    let compared: [(f64, &Enclosure); COMPARED.len()] = [
        (v, &bounds.y),
        (e, &bounds.e),
        (x, &bounds.x),
        (answers.largest_error(force), &response.sup),
        (e, &response.rms),
        (e_rate, &response.rate_rms),
    ];
    compared.map(|(value, bound)| value / bound.upper_f64())
}

/// The largest ratios, of the worst force for each signal and of random ones.
fn largest_ratios(of: &Loop, weights: &Weights, random: &mut StdRng) -> [f64; COMPARED.len()] {
    let answers = of.answers();
    let mut forces: Vec<DVector<f64>> = answers.signals(of.sigma).iter().map(|signal| answers.worst(signal)).collect();
    forces.push(answers.highest());
    forces.extend((0..RANDOM_FORCES).map(|_| DVector::from_fn(2 * FORCED, |_, _| random.random_range(-1.0..1.0))));
    let mut largest = [0.0_f64; COMPARED.len()];
    for (force, with_rest) in forces.iter().flat_map(|force| [(force, false), (force, true)]) {
        let ratios = ratios(of, weights, &answers, &force.normalize(), with_rest);
        largest = std::array::from_fn(|i| largest[i].max(ratios[i]));
    }
    largest
}

#[test]
fn random_linear_loops_are_within_their_bounds() {
    let mut largest = [0.0_f64; COMPARED.len()];
    let (mut loops, mut failures) = (0, Vec::new());
    for seed in cases(SEEDS[0], SEEDS[1]) {
        let random = &mut StdRng::seed_from_u64(seed);
        let Some((of, weights)) = Loop::random(random) else { continue };
        loops += 1;
        failures.extend(of.decide(&weights).err().map(|error| format!("{seed}: {error}")));
        let ratios = largest_ratios(&of, &weights, random);
        largest = std::array::from_fn(|i| largest[i].max(ratios[i]));
        let above = ratios.iter().zip(COMPARED).filter(|(ratio, _)| ratio.is_nan() || **ratio > 1.0 + ROUNDING);
        failures.extend(above.map(|(ratio, (what, _))| format!("{seed}: {what} is {ratio}")));
    }
    println!("{loops} loops");
    COMPARED.iter().zip(largest).for_each(|((what, _), ratio)| println!("{ratio:.6} {what}"));
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// `x' = -a x + e`, `q = q_0`: of forces that are slow or fast in comparison with sigma and a, the numbers that make a bound least make it
/// what the solution is.
#[test]
fn the_bounds_are_reached() {
    let (slow, fast) = (600.0, 0.05);
    let random = &mut StdRng::seed_from_u64(0);
    // The share of sigma that is the threshold, k_p times it, and c_y in units of k_p.
    let numbers =
        [(slow, 0.999, 100.0, 0.994), (slow, 0.5, 1.0, 0.499), (slow, 0.999, 2.0, 0.499), (fast, 0.999, 100.0, 0.994)];
    let mut largest = [0.0_f64; COMPARED.len()];
    for (size, share, in_threshold, of_k_p) in numbers {
        let vertices = vec![DMatrix::from_row_slice(2, 2, &[-size, 1.0, 0.0, 0.0])];
        let of = Loop {
            period: "1",
            omega: TAU,
            ratio: 0.37,
            mu: 1e-4,
            oscillators: 0,
            sigma: size,
            vertices,
            turns: 1,
            first: 1,
        };
        let value = share * size;
        let k_p = in_threshold / value;
        let c_y = of_k_p * k_p;
        // What is left of 2 tau is for x: p^2/(2 a p - c_x) with p = c_x/a.
        let c_x = size * size * (2.0 * value - 1.0 / (k_p - c_y)) * 0.999;
        let weights = Weights { p: DMatrix::from_element(1, 1, c_x / size), k_p, c_x, c_y, value };
        assert!(of.decide(&weights).is_ok(), "{numbers:?}");
        let ratios = largest_ratios(&of, &weights, random);
        assert!(ratios.iter().all(|ratio| *ratio <= 1.0 + ROUNDING), "{ratios:?}");
        largest = std::array::from_fn(|i| largest[i].max(ratios[i]));
    }
    for ((what, floor), ratio) in COMPARED.iter().zip(largest) {
        println!("{ratio:.6} {what}");
        assert!(ratio >= *floor, "{what} is {ratio}");
    }
}
