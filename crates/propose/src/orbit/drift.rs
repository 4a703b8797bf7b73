//! Zero dynamics that only add up what acts on them: a combination of the states on which no state acts, in doubles.

use super::failure::OrbitFailure;
use super::field::Field;
use nalgebra::{DMatrix, DVector};
use sigmastar_exact::number::{Direction, round_f64, write_exact};
use sigmastar_lang::expr::quoted;

/// Times of a period at which f is looked at, a prime, so that hardly a harmonic has a mean over them; and which of them serve for the
/// derivatives, at states of such sizes in the units of the field.
const TIMES: u32 = 509;
const EACH: usize = 17;
const SIZES: [f64; 3] = [0.0, 0.7, -1.3];

/// By how much one state is larger than the one before it, so that none is as large as another.
const APART: f64 = 0.37;

/// A share of the largest below which a number is 0, of a rate one over the period where that is less: beside a fast state a slow one is not
/// without any. The same of a mean.
const NOTHING: f64 = 1e-10;
const NO_MEAN: f64 = 1e-6;

/// The combination `w'x` with `w' df/dx = 0` wherever that was looked at, of those the one whose right side has the largest mean over a
/// period: no orbit attracts its neighbours along it, and with a mean there is none. `None` where there is no such combination, and none
/// with a mean where one is `wanted`.
pub(super) fn drift(field: &mut Field, names: &[String], wanted: bool) -> Option<OrbitFailure> {
    let n = field.states();
    let share = |j: u32| f64::from(j) / f64::from(TIMES);
    let mut derivatives = Vec::new();
    for size in SIZES {
        let x: Vec<f64> = (0..n).map(|i| size * (1.0 + APART * i as f64)).collect();
        for j in (0..TIMES).step_by(EACH) {
            field.set(share(j), &x, 0.0);
            derivatives.extend(field.jacobian().iter().copied());
        }
    }
    let (mut mean, mut size) = (DVector::zeros(n), 0.0_f64);
    for j in 0..TIMES {
        field.set(share(j), &vec![0.0; n], 0.0);
        let f = field.f();
        size = size.max(f.amax());
        mean += f / f64::from(TIMES);
    }
    let all = DMatrix::from_vec(n, derivatives.len() / n, derivatives);
    if !all.iter().chain(&mean).all(|entry| entry.is_finite()) {
        return None;
    }
    let scale = all.amax().min(field.period.recip());
    let decomposed = all.svd(true, false);
    let (left, values) = (decomposed.u?, decomposed.singular_values);
    let free: Vec<usize> = (0..n).filter(|i| values[*i] <= NOTHING * scale).collect();
    let first = left.column(*free.first()?).clone_owned();
    let along = free.iter().fold(DVector::zeros(n), |sum, i| sum + left.column(*i) * left.column(*i).dot(&mean));
    let has_mean = along.norm() > NO_MEAN * size;
    if wanted && !has_mean {
        return None;
    }
    let weights = if wanted { along } else { first };
    // In the units of the plant, with the largest weight 1.
    let weights = DVector::from_fn(n, |i, _| weights[i] / field.units()[i]);
    let largest = weights.iamax();
    let weights = &weights / weights[largest];
    let mean: f64 = (0..n).map(|i| weights[i] * mean[i] * field.units()[i]).sum();
    Some(OrbitFailure::AddsUp { sum: in_words(&weights, names), largest, mean: wanted.then_some(mean) })
}

/// `'x'`, or `'x' + 0.5*'v'`.
fn in_words(weights: &DVector<f64>, names: &[String]) -> String {
    let mut words = String::new();
    for (weight, name) in weights.iter().zip(names).filter(|(weight, _)| weight.abs() > NOTHING) {
        let size = round_f64(weight.abs(), 3, Direction::Nearest).map_or_else(String::new, |size| write_exact(&size));
        words += match (words.is_empty(), *weight < 0.0) {
            (true, false) => "",
            (true, true) => "-",
            (false, false) => " + ",
            (false, true) => " - ",
        };
        let name = quoted(name);
        words += &if size == "1" { name } else { format!("{size}*{name}") };
    }
    words
}
