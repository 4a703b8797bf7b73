//! Certified pairs near the optimum: against a dense search, against plain sums at random points, and slightly smaller.

use crate::support::every;
use crate::transfer_sums::power;
use rand::rngs::StdRng;
use rand::{Rng, SeedableRng};
use rayon::prelude::*;
use rug::ops::Pow;
use rug::{Float, Rational};
use sigmastar_exact::enclosure::Truth;
use sigmastar_lang::spec::Specification;
use sigmastar_theory::data::Data;
use sigmastar_theory::transfer::{BoxProof, CertifiedPair, PairStatus, pair_status, smallest_k1};

const BITS: u32 = 200;

/// n_0 = 2, n_l = l^-(1+eps), mu = 1 and this base frequency, so nu = 1/w.
fn specification(frequency: &str, epsilon: &str) -> Specification {
    power("2", epsilon, "1").specification_at(frequency, false)
}

/// One row of the table: the base frequency, epsilon, k0 in units of 1/(nu^2 n_0) or as a number, the allowed k1.
struct Case {
    frequency: &'static str,
    epsilon: &'static str,
    k0: K0,
    at_most: Option<f64>,
}

enum K0 {
    Number(Rational),
    /// This multiple of the smallest possible, T_N(0).
    TimesSmallest(Rational),
}

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for epsilon in ["1/2", "1"] {
        let number = |n: i32, d: i32| K0::Number(Rational::from((n, d)));
        cases.push(Case { frequency: "1", epsilon, k0: number(7, 1), at_most: Some(17.7) });
        cases.push(Case { frequency: "1", epsilon, k0: number(1, 2), at_most: Some(27.3) });
        let at_most = Some(if epsilon == "1" { 81.0 } else { 75.0 });
        cases.push(Case { frequency: "2*pi", epsilon, k0: K0::TimesSmallest(Rational::from(1)), at_most });
    }
    for frequency in ["1/10", "100"] {
        let k0 = K0::TimesSmallest(Rational::from((3, 2)));
        cases.push(Case { frequency, epsilon: "1/2", k0, at_most: None });
    }
    cases
}

/// The certified pair of a row.
fn certified(case: &Case, data: &Data<'_>) -> CertifiedPair {
    let smallest = (data.nu.sqr() * &data.n_0).recip().upper_rational().unwrap();
    let k0 = match &case.k0 {
        K0::Number(k0) => k0.clone(),
        K0::TimesSmallest(factor) => smallest * factor,
    };
    smallest_k1(data, &k0).unwrap()
}

#[test]
fn pairs_are_near_the_optimum_and_no_smaller_one_is_accepted() {
    for case in cases() {
        let name = format!("w = {}, eps = {}", case.frequency, case.epsilon);
        let spec = specification(case.frequency, case.epsilon);
        let data = Data::new(&spec, 128);
        let pair = certified(&case, &data);
        assert_eq!(pair.proof.decide(&data, &pair.k0, &pair.k1).0, Truth::True, "{name}");
        assert!(pair.k1.to_f64() <= case.at_most.unwrap_or(f64::INFINITY), "{name}: {}", pair.k1.to_f64());
        let dense = dense_search(data.nu.midpoint_f64(), case.epsilon == "1", pair.k0.to_f64());
        let k1 = pair.k1.to_f64();
        assert!(k1 <= 1.01 * dense && k1 >= dense, "{name}: {k1} against {dense}");
        // The proved lower bound agrees with the search.
        let least = &pair.binding.as_ref().unwrap().least_k1;
        assert!(least.upper_f64() <= k1 && least.lower_f64() >= 0.999 * dense, "{name}");

        let lower = &pair.k1 * Rational::from((98, 100));
        assert_ne!(pair.proof.decide(&data, &pair.k0, &lower).0, Truth::True, "{name}");
        assert!(BoxProof::find(&data, &pair.k0, &lower).is_none(), "{name}");
        let status = pair_status(&data, &data.rational(&pair.k0), &data.rational(&lower));
        assert!(matches!(status, PairStatus::Refuted(_)), "{name}");
    }
}

/// The smallest k1 for a given k0 on a dense grid, in doubles: the sup over N <= 80 and x <= 40 of (T_N(x) - k0)/x^2.
fn dense_search(nu: f64, eps_is_one: bool, k0: f64) -> f64 {
    let weight = |l: u32| f64::from(l).powf(if eps_is_one { -2.0 } else { -1.5 });
    let weights: Vec<f64> = (1..=80).map(weight).collect();
    let at = |x: f64| {
        let (mut g, mut slope, mut best) = (-2.0 / x, 2.0 / (x * x), 0.0_f64);
        for (index, n) in weights.iter().enumerate() {
            let square = (index as f64 + 1.0).powi(2);
            g += n * x / (square - x * x);
            slope += n * (square + x * x) / (square - x * x).powi(2);
            best = best.max(slope / (1.0 + nu * nu * g * g));
        }
        (best - k0) / (x * x)
    };
    let coarse = (1..400_000_u32).into_par_iter().map(|k| at((f64::from(k) + 0.123) * 1e-4));
    coarse.reduce(|| 0.0, f64::max)
}

/// T_N(x) = g'/(1 + nu^2 g^2) by the definition at 200 bits, for every N up to the length of the list; x no integer.
fn plain(weights: &[Float], x: &Float, nu_squared: &Float) -> Vec<Float> {
    let square = Float::with_val(BITS, x.square_ref());
    let mut g = Float::with_val(BITS, -2 / x);
    let mut slope = Float::with_val(BITS, 2 / &square);
    let value = |g: &Float, slope: &Float| {
        let scaled = Float::with_val(BITS, g.square_ref()) * nu_squared + 1u32;
        Float::with_val(BITS, slope / scaled)
    };
    let mut values = vec![value(&g, &slope)];
    for (index, n) in weights.iter().enumerate() {
        let l = Float::with_val(BITS, index + 1);
        let l_squared = Float::with_val(BITS, l.square_ref());
        let inverse = Float::with_val(BITS, &l_squared - &square).recip();
        let term = Float::with_val(BITS, n * &inverse);
        g += Float::with_val(BITS, x * &term);
        slope += Float::with_val(BITS, &l_squared + &square) * inverse * term;
        values.push(value(&g, &slope));
    }
    values
}

/// A random x up to about `reach`, mostly near an integer, at every scale.
fn random_x(rng: &mut StdRng, reach: u32) -> Float {
    let unit = |rng: &mut StdRng| f64::from(rng.next_u32()) / 4_294_967_296.0;
    let m = f64::from(rng.next_u32() % (reach + 1));
    let offset = match rng.next_u32() % 4 {
        0 => unit(rng) - 0.5,
        _ => (unit(rng) - 0.5) * 2f64.powf(-20.0 * unit(rng)),
    };
    // A tenth of the points lies near 0, where the bound is tight for the smallest k0.
    let m = if rng.next_u32().is_multiple_of(10) { 0.0 } else { m };
    Float::with_val(BITS, m + offset).abs() + Float::with_val(BITS, 2f64.powi(-60))
}

#[test]
fn bounds_hold_at_random_points_against_a_plain_sum() {
    let mut rng = StdRng::seed_from_u64(20_261_121);
    for case in cases().into_iter().step_by(every(2)) {
        let spec = specification(case.frequency, case.epsilon);
        let data = Data::new(&spec, 128);
        let pair = certified(&case, &data);
        let exponent = if case.epsilon == "1" { -2.0 } else { -1.5 };
        let weights: Vec<Float> =
            (1..=10_000).map(|l| Float::with_val(BITS, l).pow(Float::with_val(BITS, exponent))).collect();
        let pi = Float::with_val(BITS, rug::float::Constant::Pi);
        let nu = match case.frequency {
            "1" => Float::with_val(BITS, 1),
            "2*pi" => Float::with_val(BITS, pi * 2u32).recip(),
            "1/10" => Float::with_val(BITS, 10),
            _ => Float::with_val(BITS, 100).recip(),
        };
        let nu_squared = nu.square();
        let holds = |value: &Float, x: &Float, n: usize| {
            let bound = Float::with_val(BITS, x.square_ref()) * &pair.k1 + &pair.k0;
            assert!(
                *value <= bound,
                "w = {}, eps = {}, N = {n}, x = {x}: {value} > {bound}",
                case.frequency,
                case.epsilon
            );
        };
        // All N <= 200 at each of 500 and more x: 1e5 points.
        let points: Vec<Float> = (0..600).map(|_| random_x(&mut rng, 220)).collect();
        points.par_iter().for_each(|x| {
            for (n, value) in plain(&weights[..200], x, &nu_squared).iter().enumerate() {
                holds(value, x, n);
            }
        });
        // And 1e3 with N up to 1e4, x among the poles that N has and beyond.
        let far: Vec<(usize, Float)> = (0..1000)
            .map(|_| {
                // At every scale up to 1e4.
                let n = 10f64.powf(4.0 * f64::from(rng.next_u32()) / 4_294_967_295.0).round() as usize;
                let reach = if rng.next_u32().is_multiple_of(2) { 30 } else { n as u32 + 3 };
                (n, random_x(&mut rng, reach))
            })
            .collect();
        far.par_iter().for_each(|(n, x)| {
            let values = plain(&weights[..*n], x, &nu_squared);
            holds(&values[*n], x, *n);
        });
    }
}
