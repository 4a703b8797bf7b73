//! Random stable linear plants: section 10 proves each of them for a large enough gain, so all are certified, all certificates
//! are valid, the gain does not depend on the units of the states and of time, and it is near the least one for which the same
//! Lyapunov function proves stability, which one semidefinite program in doubles says.
//!
//! `SIGMASTAR_CASES=0..200 cargo test --release --test integration random_linear -- --include-ignored` takes other seeds than the search tier.

use crate::support::{cases, checked, json, number, program, stored};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use serde_json::{Value, json as value};
use sigmastar_matrix::AffineMatrix;
use sigmastar_propose::semidefinite::propose;
use std::path::Path;
use tempfile::TempDir;

/// Seeds of an ordinary run, and of a night.
const SEEDS: [u64; 2] = [1, 200];

/// The gain in other units, relative to the gain in the first.
const CLOSE: f64 = 0.02;

/// The gain in the place of the least one, which existence and the initial set have no part in.
const NEAR: f64 = 1.3;

/// A gain so small in a period need not be near anything.
const SMALL: f64 = 1e-3;

/// Decimal exponents of units.
const EXPONENTS: std::ops::RangeInclusive<i32> = -6..=6;

/// A whole number times a power of ten, so that other units change no digit.
#[derive(Clone, Copy)]
struct Decimal {
    digits: i64,
    exponent: i32,
}

impl Decimal {
    fn new(value: f64, decimals: i32) -> Decimal {
        Decimal { digits: (value * 10f64.powi(decimals)).round() as i64, exponent: -decimals }
    }

    fn times(self, power: i32) -> Decimal {
        Decimal { exponent: self.exponent + power, ..self }
    }

    fn value(self) -> f64 {
        self.digits as f64 * 10f64.powi(self.exponent)
    }

    fn text(self) -> String {
        format!("({}*10^({}))", self.digits, self.exponent)
    }
}

/// `x' = A x + b e + g sin(...)`, `q = c x + d e + ...` with the period 1.
struct Linear {
    a: Vec<Vec<Decimal>>,
    b: Vec<Decimal>,
    c: Vec<Decimal>,
    d: Decimal,
    forces: Vec<(Decimal, u32)>,
    waves: [Decimal; 3],
    harmonic: u32,
}

/// The product of two square matrices.
fn product(a: &[Vec<f64>], b: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let entry = |row: &Vec<f64>, j: usize| row.iter().zip(b).map(|(x, row)| x * row[j]).sum();
    a.iter().map(|row| (0..b.len()).map(|j| entry(row, j)).collect()).collect()
}

impl Linear {
    /// One to six states: lags, and oscillations with damping ratios from 0.01 to 1, from 0.3 to 50 radians a period, in axes
    /// that mix them.
    fn random(random: &mut StdRng) -> Linear {
        let n = random.random_range(1..=6_usize);
        let mut modes = vec![vec![0.0; n]; n];
        let mut at = 0;
        while at < n {
            let frequency = 10f64.powf(random.random_range(-0.5..1.7));
            if n - at >= 2 && random.random_bool(0.6) {
                let ratio = 10f64.powf(random.random_range(-2.0..0.0));
                let (decay, turn) = (ratio * frequency, frequency * (1.0 - ratio * ratio).sqrt());
                (modes[at][at], modes[at][at + 1]) = (-decay, turn);
                (modes[at + 1][at], modes[at + 1][at + 1]) = (-turn, -decay);
                at += 2;
            } else {
                modes[at][at] = -frequency;
                at += 1;
            }
        }
        // Axes are mixed by shears, whose inverses are known.
        let mut a = modes;
        for i in 0..n {
            for j in (0..n).filter(|j| *j != i) {
                let (mut shear, mut back) = (identity(n), identity(n));
                shear[i][j] = random.random_range(-0.3..0.3);
                back[i][j] = -shear[i][j];
                a = product(&product(&shear, &a), &back);
            }
        }
        let mut number = |low: f64, high: f64, decimals: i32| Decimal::new(random.random_range(low..high), decimals);
        let b = (0..n).map(|_| number(-1.0, 1.0, 3)).collect();
        let c = (0..n).map(|_| number(-1.0, 1.0, 3)).collect();
        let (d, waves) = (number(-2.0, 1.0, 2), [number(0.0, 2.0, 2), number(0.0, 1.0, 2), number(-1.0, 1.0, 2)]);
        let forces: Vec<Decimal> = (0..n).map(|_| number(-1.0, 1.0, 2)).collect();
        let forces = forces.into_iter().map(|force| (force, random.random_range(1..=3))).collect();
        let a = a.iter().map(|row| row.iter().map(|entry| Decimal::new(*entry, 8)).collect()).collect();
        Linear { a, b, c, d, forces, waves, harmonic: random.random_range(2..=5) }
    }

    /// The least sigma with `[[-(P A + A'P), -P b, -(k/2) c'], [., 2 sigma, -1 - (k/2) d], [., ., k]] >= 0` for some P and k: what the
    /// function `x'P x + e^2 + (k mu/2) |zeta|^2` needs to decrease. Time in units of the largest entry of A.
    fn least_gain(&self) -> f64 {
        let n = self.b.len();
        let unit = self.a.iter().flatten().map(|entry| entry.value().abs()).fold(1.0, f64::max);
        let places: Vec<(usize, usize)> = (0..n).flat_map(|j| (0..=j).map(move |i| (i, j))).collect();
        let (k, sigma) = (places.len(), places.len() + 1);
        let constant = |i: usize, j: usize| if (i.min(j), i.max(j)) == (n, n + 1) { -1.0 } else { 0.0 };
        let term = |variable: usize, i: usize, j: usize| {
            let (i, j) = (i.min(j), i.max(j));
            match (i < n, j < n) {
                _ if variable == sigma => {
                    if (i, j) == (n, n) {
                        2.0
                    } else {
                        0.0
                    }
                }
                _ if variable == k => match (i < n, i == n, j == n + 1) {
                    (true, _, true) => -0.5 * self.c[i].value() / unit,
                    (_, true, true) => -0.5 * self.d.value() / unit,
                    (false, false, true) => 1.0,
                    _ => 0.0,
                },
                (first, second) => {
                    let (row, column) = places[variable];
                    // Entry (i, m) of the matrix with ones there.
                    let one =
                        |i: usize, m: usize| f64::from(u8::from((i, m) == (row, column) || (m, i) == (row, column)));
                    let times = |i: usize, j: usize| (0..n).map(|m| one(i, m) * self.a[m][j].value()).sum::<f64>();
                    match (first, second) {
                        (true, true) => -(times(i, j) + times(j, i)) / unit,
                        (true, false) if j == n => -(0..n).map(|m| one(i, m) * self.b[m].value()).sum::<f64>() / unit,
                        _ => 0.0,
                    }
                }
            }
        };
        let mut cost = vec![0.0; sigma + 1];
        cost[sigma] = 1.0;
        let found = propose(&cost, &[AffineMatrix::from_fn(n + 2, sigma + 1, constant, term)]);
        found.map_or(f64::NAN, |found| found.x[sigma] * unit)
    }

    /// The plant file with the states and the time in units of these powers of ten.
    fn written(&self, name: &str, units: &[i32], time: i32) -> Value {
        let n = self.b.len();
        let wave = |kind: &str, k: u32| format!("{kind}({}*pi*t/10^({time}))", 2 * k);
        let sum = |terms: Vec<String>| terms.join(" + ");
        let f: Vec<String> = (0..n)
            .map(|i| {
                let own = |j: usize| format!("{}*x{j}", self.a[i][j].times(units[i] - units[j] - time).text());
                let mut terms: Vec<String> = (0..n).map(own).collect();
                terms.push(format!("{}*e", self.b[i].times(units[i] - time).text()));
                let (force, k) = self.forces[i];
                terms.push(format!("{}*{}", force.times(units[i] - time).text(), wave("sin", k)));
                sum(terms)
            })
            .collect();
        let mut q: Vec<String> = (0..n).map(|j| format!("{}*x{j}", self.c[j].times(-units[j] - time).text())).collect();
        let [first, second, mean] = self.waves.map(|wave| wave.times(-time).text());
        q.push(format!("{}*e", self.d.times(-time).text()));
        q.push(format!("{first}*{} + {second}*{} + {mean}", wave("cos", 1), wave("sin", self.harmonic)));
        value!({
            "format": "sigmastar/plant", "version": 1, "name": name, "period": format!("10^({time})"),
            "states": (0..n).map(|i| format!("x{i}")).collect::<Vec<_>>(), "f": f, "q": sum(q),
            "internal_model": {
                "mu": format!("10^({})", -time), "base_frequency": format!("2*pi/10^({time})"), "matched": true,
                "weights": { "family": "power", "n0": "2", "epsilon": "1/2" }
            }
        })
    }
}

fn identity(n: usize) -> Vec<Vec<f64>> {
    (0..n).map(|i| (0..n).map(|j| f64::from(u8::from(i == j))).collect()).collect()
}

/// The gain, certified and checked; a reason without one.
fn gain(folder: &Path, name: &str, plant: &Value) -> Result<f64, String> {
    let file = stored(folder, &format!("{name}.json"), plant);
    let certificate = folder.join(format!("{name}.certificate.json"));
    let call = ["--quiet", "--no-alternatives", "--format", "json", "-o"];
    let output = program().arg("certify").arg(&file).args(call).arg(&certificate).output().unwrap();
    let report = json(&output.stdout);
    if report["verdict"] != "certified" {
        return Err(report["errors"].to_string());
    }
    let answer = checked(&certificate);
    if answer["verdict"] != "valid" {
        return Err(format!("the checker: {answer}"));
    }
    Ok(number(&report["sigma_star"]))
}

#[test]
#[ignore = "search tier"]
fn random_linear_plants_are_certified_in_any_units() {
    let folder = TempDir::new().unwrap();
    let mut failures = Vec::new();
    for seed in cases(SEEDS[0], SEEDS[1]) {
        let random = &mut StdRng::seed_from_u64(seed);
        let plant = Linear::random(random);
        let n = plant.b.len();
        let units: Vec<i32> = (0..n).map(|_| random.random_range(EXPONENTS)).collect();
        let time = random.random_range(EXPONENTS);
        let name = format!("linear-{seed}");
        let first = gain(folder.path(), &name, &plant.written(&name, &vec![0; n], 0));
        let name = format!("linear-{seed}-in-other-units");
        let second = gain(folder.path(), &name, &plant.written(&name, &units, time));
        match (first, second) {
            (Ok(first), Ok(second)) => {
                let second = second * 10f64.powi(time);
                let least = plant.least_gain();
                println!("{seed}: {n} states, {first} and {second}, at least {least}");
                if first > NEAR * least && first > SMALL {
                    failures.push(format!("{seed}: {n} states, {first} is not near {least}"));
                }
                if (second / first - 1.0).abs() > CLOSE {
                    failures.push(format!("{seed}: {first} and {second} in units {units:?}, {time}"));
                }
            }
            (first, second) => failures.push(format!("{seed}: {n} states: {first:?}, {second:?} in {units:?}, {time}")),
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
