//! Finding the boxes of a proof: bisection in doubles, decided afterwards by [`BoxProof::decide`].

use super::boxes::{BoxProof, MAX_BOXES, MAX_M0, MAX_N0, edge, scalar_test};
use super::float_sums::{FloatGroup, FloatSums};
use crate::data::Data;
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};

/// Bisections of [m - 1/2, m + 1/2] before a cover is given up. With at most 6 bits before the point, every break
/// point is a double.
pub(super) const MAX_DEPTH: u32 = 44;
/// The relative room that a proposed box must have, far more than what rounding takes.
const ROUNDING: f64 = 1e-9;
/// N0 - m0 that are tried in turn.
const N0_STEPS: [u32; 9] = [0, 1, 2, 4, 8, 16, 32, 64, 128];

impl BoxProof {
    /// Finds a proof for a pair, or `None` within the stated effort.
    ///
    /// The smallest m0 that the scalar test allows and, of the N0 that are tried, the first for which the boxes cover the
    /// region. Guarantee: a proof that is returned was decided `True` by [`BoxProof::decide`].
    #[must_use]
    pub fn find(data: &Data<'_>, k0: &Rational, k1: &Rational) -> Option<BoxProof> {
        if *k1 <= 0 {
            return None;
        }
        let pair = [data.rational(k0), data.rational(k1)];
        let m0 = first_m0(data, [&pair[0], &pair[1]])?;
        let last = (m0 + N0_STEPS[N0_STEPS.len() - 1]).min(MAX_N0);
        let sums = FloatSums::new(data, last as usize);
        let floats = pair.each_ref().map(Enclosure::midpoint_f64);
        for n0 in N0_STEPS.iter().map(|step| m0 + step).filter(|n0| (2..=last).contains(n0)) {
            match cover(data, &sums, floats, m0, n0) {
                Ok(proof) if proof.decide(data, k0, k1).0 == Truth::True => return Some(proof),
                // The same N stays in the way of every larger N0.
                Err(Uncovered::OneN) => return None,
                Ok(_) | Err(Uncovered::AllLargeN) => {}
            }
        }
        None
    }
}

/// The smallest m0 that the scalar test allows.
pub(super) fn first_m0(data: &Data<'_>, [k0, k1]: [&Enclosure; 2]) -> Option<u32> {
    (1..=MAX_M0).find(|m0| scalar_test(data, k0, k1, *m0).iter().all(|step| step.lhs.le(&step.rhs).is_true()))
}

/// Which boxes were not found.
enum Uncovered {
    /// Those for all N >= N0 together.
    AllLargeN,
    /// Those for one N < N0.
    OneN,
}

/// Covers [0, m0 - 1/2] for every group of oscillators, the hardest one first.
fn cover(data: &Data<'_>, sums: &FloatSums, pair: [f64; 2], m0: u32, n0: u32) -> Result<BoxProof, Uncovered> {
    let mut left = MAX_BOXES;
    let mut breaks = Vec::with_capacity(n0 as usize);
    let mut add = |group: FloatGroup| {
        let points = cover_group(sums, group, pair, m0, left)?;
        left = left.checked_sub(points.len())?;
        breaks.push(points.iter().map(|x| Rational::from_f64(*x)).collect::<Option<Vec<Rational>>>()?);
        Some(())
    };
    add(FloatSums::all_from(data, n0)).ok_or(Uncovered::AllLargeN)?;
    for n in (1..n0 as usize).rev() {
        add(FloatGroup { last: n, tail: None }).ok_or(Uncovered::OneN)?;
    }
    breaks.reverse();
    debug_assert!(breaks.iter().all(|points| points.last() == Some(&edge(m0))));
    Ok(BoxProof { m0, n0, breaks })
}

/// Increasing break points from 0 to m0 - 1/2 such that every box between two of them holds in doubles.
pub(super) fn cover_group(
    sums: &FloatSums,
    group: FloatGroup,
    pair: [f64; 2],
    m0: u32,
    most: usize,
) -> Option<Vec<f64>> {
    let holds = |a: f64, b: f64, m: usize| {
        sums.box_upper([a, b], m, group) * (1.0 + ROUNDING) <= pair[0] + pair[1] * a * a
            || (a == 0.0 && sums.near_zero(b, group, pair) >= 0.0)
    };
    let mut points = vec![0.0];
    // Half-integers are always break points: the nearest pole changes there.
    for m in 0..m0 as usize {
        let (left, right) = ((m as f64 - 0.5).max(0.0), m as f64 + 0.5);
        let mut stack = vec![(left, right, 0)];
        while let Some((a, b, depth)) = stack.pop() {
            if holds(a, b, m) {
                points.push(b);
            } else if depth == MAX_DEPTH || points.len() + stack.len() >= most {
                return None;
            } else {
                let middle = 0.5 * (a + b);
                stack.push((middle, b, depth + 1));
                stack.push((a, middle, depth + 1));
            }
        }
    }
    Some(points)
}
