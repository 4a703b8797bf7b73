//! Pairs (k0, k1) that serve every finite set of harmonics that contains 0: the smallest k1 for a given k0, proposed from samples and proved by boxes.

use super::boxes::{MAX_BOXES, MAX_M0, MAX_N0};
use super::cover::{MAX_DEPTH, first_m0};
use super::curve::{SampledGraph, sample_points};
use super::float_sums::FloatSums;
use super::pair::{DIGITS, ROOMS};
use super::set_boxes::{SetBoxProof, sides};
use super::set_sums::SetSums;
use crate::data::Data;
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_exact::parallel;

/// N0 - m0 that are tried in turn.
const N0_STEPS: [u32; 2] = [16, 128];

/// Harmonics that are added one by one where T is sampled: far enough beyond the last sample for the rest to be small.
const SAMPLED_HARMONICS: u32 = MAX_M0 + 32;

/// A pair with a proof that serves every set.
#[derive(Clone, Debug)]
pub struct SetPair {
    /// k0.
    pub k0: Rational,
    /// k1.
    pub k1: Rational,
    /// The proof.
    pub proof: SetBoxProof,
}

impl SetBoxProof {
    /// Finds a proof for a pair, or `None` within the stated effort: the smallest m0 that the scalar test allows, and boxes by bisection.
    ///
    /// Guarantee: a proof that is returned was decided `True` by [`SetBoxProof::decide`].
    #[must_use]
    pub fn find(data: &Data<'_>, k0: &Rational, k1: &Rational) -> Option<SetBoxProof> {
        if *k1 <= 0 {
            return None;
        }
        let pair = [data.rational(k0), data.rational(k1)];
        let m0 = first_m0(data, [&pair[0], &pair[1]])?;
        let proof = |step: &u32| {
            let n0 = (m0 + step).min(MAX_N0);
            let breaks = cover(data, &SetSums::new(data, n0), [&pair[0], &pair[1]], m0)?;
            let proof = SetBoxProof { m0, n0, breaks };
            (proof.decide(data, k0, k1).0 == Truth::True).then_some(proof)
        };
        N0_STEPS.iter().find_map(proof)
    }
}

/// Break points from 0 to m0 - 1/2 with boxes that hold between them. At most 6 bits stand before the point, so each is a double.
fn cover(data: &Data<'_>, sums: &SetSums, pair: [&Enclosure; 2], m0: u32) -> Option<Vec<Rational>> {
    let mut points = vec![Rational::new()];
    // Half-integers are always break points: the nearest pole changes there.
    for m in 0..m0 {
        let right = Rational::from((2 * i64::from(m) + 1, 2));
        let left = if m == 0 { Rational::new() } else { Rational::from(&right - 1u32) };
        let mut stack = vec![(left, right, 0)];
        while let Some((a, b, depth)) = stack.pop() {
            let (lhs, rhs) = sides(data, sums, [&a, &b], pair);
            if lhs.le(&rhs).is_true() {
                points.push(b);
            } else if depth == MAX_DEPTH || points.len() + stack.len() >= MAX_BOXES {
                return None;
            } else {
                let middle = Rational::from(&a + &b) / 2u32;
                stack.push((middle.clone(), b, depth + 1));
                stack.push((a, middle, depth + 1));
            }
        }
    }
    Some(points)
}

/// The smallest k1, nearly, with which a given k0 is proved to serve every set; `None` where no proof was found within the effort.
///
/// Guarantee: T_H(x) <= k0 + k1 x^2 for every finite set H of harmonics that contains 0 and every x >= 0.
#[must_use]
pub fn smallest_k1_for_every_set(data: &Data<'_>, k0: &Rational) -> Option<SetPair> {
    // {0, ..., N} is a set, too.
    let of_first = SampledGraph::new(data).smallest_k1(k0.to_f64()).0;
    let least = steepest(data, k0.to_f64()).max(of_first);
    ROOMS.iter().find_map(|room| {
        let k1 = round_f64(least * (1.0 + room), DIGITS, Direction::Up)?;
        let proof = SetBoxProof::find(data, k0, &k1)?;
        Some(SetPair { k0: k0.clone(), k1, proof })
    })
}

/// The largest (T(x) - k0)/x^2 of the samples, T the bound for every set.
fn steepest(data: &Data<'_>, k0: f64) -> f64 {
    let floats = FloatSums::new(data, SAMPLED_HARMONICS as usize);
    let points = sample_points(&floats, MAX_M0 as usize, |m| vec![m + 1, SAMPLED_HARMONICS as usize]);
    let sums = SetSums::new(data, SAMPLED_HARMONICS);
    let slope = |x: &f64| {
        let nearest = x.round() as u32;
        (sums.supremum(&Enclosure::exactly(*x).at_precision(data.precision), nearest).upper_f64() - k0) / (x * x)
    };
    parallel::map(&points, slope).into_iter().filter(|slope| slope.is_finite()).fold(0.0, f64::max)
}
