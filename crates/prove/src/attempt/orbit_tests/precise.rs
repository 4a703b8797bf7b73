//! The paper's orbit by a Taylor method in forty digits, which shares nothing with the proof.

use super::{paper, proved};
use rug::float::Constant;
use rug::{Float, Rational};

const PRECISION: u32 = 150;
const ORDER: usize = 30;
const STEPS: u32 = 64;

fn number(value: f64) -> Float {
    Float::with_val(PRECISION, value)
}

/// The coefficients of `sin(w t + phase)` about t.
fn wave(w: &Float, t: &Float, quarter: u32) -> Vec<Float> {
    let angle = Float::with_val(PRECISION, w * t);
    let values = [angle.clone().sin(), angle.clone().cos(), -angle.clone().sin(), -angle.cos()];
    let mut power = number(1.0);
    (0..=ORDER)
        .map(|j| {
            let term = Float::with_val(PRECISION, &values[(j + quarter as usize) % 4] * &power);
            power *= w;
            power /= (j + 1) as u32;
            term
        })
        .collect()
}

/// One step of length h from (t, x).
fn step(t: &Float, h: &Float, x: &[Float; 2]) -> [Float; 2] {
    let w = Float::with_val(PRECISION, Constant::Pi) * 2_u32;
    let [double, triple] = [2_u32, 3].map(|k| Float::with_val(PRECISION, &w * k));
    let first = wave(&w, t, 0);
    // cos(2 w t) (1 + sin(w t)) = cos(2 w t) + (sin(3 w t) - sin(w t))/2.
    let (even, odd) = (wave(&double, t, 1), wave(&triple, t, 0));
    let root = number(3.0).sqrt();
    let zero = || vec![number(0.0); ORDER + 1];
    let (mut a, mut b, mut sin, mut cos) = (zero(), zero(), zero(), zero());
    a[0].clone_from(&x[0]);
    b[0].clone_from(&x[1]);
    sin[0] = x[1].clone().sin();
    cos[0] = x[1].clone().cos();
    for k in 0..ORDER {
        let square: Float = (0..=k).fold(number(0.0), |sum, i| sum + Float::with_val(PRECISION, &b[i] * &b[k - i]));
        let forcing = number(0.0) + &even[k] + Float::with_val(PRECISION, &odd[k] - &first[k]) / 2_u32;
        let da = Float::with_val(PRECISION, &root * &b[k]) - Float::with_val(PRECISION, &a[k] / 5_u32)
            + Float::with_val(PRECISION, &sin[k] / 10_u32)
            + &first[k];
        let db = -Float::with_val(PRECISION, &root * &a[k]) - &b[k] + square / 10_u32 + forcing;
        a[k + 1] = da / (k + 1) as u32;
        b[k + 1] = db / (k + 1) as u32;
        let sum = |other: &[Float]| {
            (1..=k + 1)
                .fold(number(0.0), |sum, i| sum + Float::with_val(PRECISION, &b[i] * &other[k + 1 - i]) * i as u32)
                / (k + 1) as u32
        };
        let next = [sum(&cos), -sum(&sin)];
        let [s, c] = next;
        sin[k + 1] = s;
        cos[k + 1] = c;
    }
    [a, b].map(|series| series.iter().rev().fold(number(0.0), |value, c| value * h + c))
}

/// The states at k/64, k = 0, ..., 64.
fn period(start: &[Float; 2]) -> Vec<[Float; 2]> {
    let h = number(1.0) / STEPS;
    let mut path = vec![start.clone()];
    for k in 0..STEPS {
        let t = Float::with_val(PRECISION, &h * k);
        let next = step(&t, &h, &path[k as usize]);
        path.push(next);
    }
    path
}

/// The periodic solution by Newton's method for the period map, with difference quotients in forty digits.
fn orbit() -> Vec<[Float; 2]> {
    let mut start = [number(-0.17869), number(0.073256)];
    let last = |path: &[[Float; 2]]| path[STEPS as usize].clone();
    let base = last(&period(&start));
    let shift = number(1e-18);
    let columns = [0, 1].map(|i| {
        let mut moved = start.clone();
        moved[i] += &shift;
        let end = last(&period(&moved));
        [0, 1].map(|j| Float::with_val(PRECISION, &end[j] - &base[j]) / &shift)
    });
    // M = I - dPhi; x + M^-1 (Phi(x) - x).
    let entry = |i: usize, j: usize| number(f64::from(u8::from(i == j))) - &columns[j][i];
    let determinant = entry(0, 0) * entry(1, 1) - entry(0, 1) * entry(1, 0);
    for _ in 0..6 {
        let end = last(&period(&start));
        let [u, v] = [0, 1].map(|i| Float::with_val(PRECISION, &end[i] - &start[i]));
        let own = (entry(1, 1) * &u - entry(0, 1) * &v) / &determinant;
        let other = (entry(0, 0) * &v - entry(1, 0) * &u) / &determinant;
        start[0] += own;
        start[1] += other;
    }
    let path = period(&start);
    let gap = [0, 1].map(|i| Float::with_val(PRECISION, &path[STEPS as usize][i] - &start[i]).abs());
    assert!(gap.iter().all(|gap| *gap < 1e-35), "{gap:?}");
    path
}

#[test]
fn the_orbit_of_the_paper_lies_in_the_tube() {
    let path = orbit();
    assert!((path[0][0].to_f64() + 0.17869).abs() < 1e-5 && (path[0][1].to_f64() - 0.073256).abs() < 1e-6);
    let (coordinates, proof) = proved(&paper());
    let inverse = sigmastar_matrix::inverse(&coordinates.l).unwrap();
    let turn = Float::with_val(PRECISION, Constant::Pi) * 2_u32;
    let mut largest = number(0.0);
    for (k, x) in path.iter().enumerate() {
        let v = [0, 1].map(|i| {
            let mut value = Float::with_val(PRECISION, &proof.orbit.centre.mean[i]);
            for (index, [a, b]) in proof.orbit.centre.harmonics.iter().enumerate() {
                let part = Rational::from(((index + 1) * k % STEPS as usize, STEPS as usize));
                let angle = Float::with_val(PRECISION, &turn * part);
                value += Float::with_val(PRECISION, angle.clone().cos() * &a[i]);
                value += Float::with_val(PRECISION, angle.sin() * &b[i]);
            }
            Float::with_val(PRECISION, &x[i] - value)
        });
        let norm = [0, 1].map(|i| {
            let component: Float =
                Float::with_val(PRECISION, &v[0] * &inverse[i][0]) + Float::with_val(PRECISION, &v[1] * &inverse[i][1]);
            component.square()
        });
        let norm = (norm[0].clone() + &norm[1]).sqrt();
        assert!(norm < proof.radius, "{k}: {norm} {}", proof.radius);
        largest = largest.max(&norm);
    }
    // The proof is not far from the truth.
    assert!(largest.to_f64() > 1e-4 * proof.radius.to_f64(), "{largest}");
}
