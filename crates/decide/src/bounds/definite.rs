//! Whether a symmetric matrix is positive definite all over a box, or a number nonnegative.
//!
//! S depends on the point z of the box through centred values. With a matrix K near the eigenvectors of S in the middle, `K^T S K`
//! is near a diagonal there, and over the box its entries are enclosed by their slopes: the entry that belongs to the least
//! eigenvalue to second order, the others by first, which enters the definiteness by squares. K is any matrix of doubles: if
//! `K^T S K` is positive definite then K has an inverse, and S is positive definite.

use super::PRECISION;
use super::centred::{Centred, Frame, plus};
use super::chart::Ball;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::Portable;
use sigmastar_matrix::doubles::eigen;

/// Entries of K, which are at most 1, are whole multiples of one over this.
const GRID: f64 = 1_048_576.0;

/// Steps of the bisection for the multiplier of the ball.
const BISECTIONS: usize = 40;

/// What is known of a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Verdict {
    /// The inequality holds all over it.
    Holds,
    /// It certainly fails in the middle.
    Fails,
    /// Halving this side helps most.
    Halve(usize),
    /// No side would help.
    Stuck,
}

/// A symmetric matrix of centred values: the upper triangle, without entries that are 0.
pub(super) struct SymmetricValues {
    pub(super) order: usize,
    pub(super) entries: Vec<(usize, usize, Centred)>,
}

/// How much each side contributes to what is not known; infinite where nothing is.
struct Blame {
    excess: Vec<f64>,
    change: Vec<f64>,
}

impl Blame {
    fn new(frame: &Frame) -> Blame {
        Blame { excess: vec![0.0; frame.sides()], change: vec![0.0; frame.sides()] }
    }

    fn add(&mut self, frame: &Frame, value: &Centred) {
        for (i, slope) in value.slopes.iter().enumerate() {
            let Some(slope) = slope else { continue };
            let half = frame.halves[i].upper_f64();
            if !slope.is_bounded() {
                self.excess[i] = f64::INFINITY;
                continue;
            }
            self.excess[i] += half * (slope.upper_f64() - slope.lower_f64());
            self.change[i] += half * slope.abs().upper_f64();
        }
    }

    /// An entry off the diagonal counts by the square of its reach over the pivot.
    fn add_off_diagonal(&mut self, frame: &Frame, value: &Centred, weight: f64) {
        for (i, slope) in value.slopes.iter().enumerate() {
            let Some(slope) = slope else { continue };
            self.excess[i] += weight * frame.halves[i].upper_f64() * slope.abs().upper_f64();
        }
    }

    fn verdict(&self, frame: &Frame) -> Verdict {
        let first = |list: &[f64]| {
            let largest = list.iter().copied().fold(0.0, f64::max);
            // Where nothing is known, the widest side.
            let width = |i: usize| if largest == f64::INFINITY { frame.halves[i].upper_f64() } else { 0.0 };
            let candidates = (0..list.len()).filter(|&i| list[i] == largest && largest > 0.0);
            candidates.max_by(|&i, &j| width(i).total_cmp(&width(j)).then(j.cmp(&i)))
        };
        first(&self.excess).or_else(|| first(&self.change)).map_or(Verdict::Stuck, Verdict::Halve)
    }
}

/// A lower bound of the value over the box, or over its part in the ball.
fn lower_bound(frame: &Frame, value: &Centred, ball: &Ball) -> Enclosure {
    let natural = value.range.floor();
    let Some(linear) = lower_bound_in_ball(frame, value, ball) else { return natural };
    if !natural.is_defined() || !linear.is_defined() { natural } else { natural.max(&linear) }
}

/// `min sum g_i (s_i - c_i)` over box and ball, from below by duality: for every multiplier m >= 0 it is at least
/// `sum_i min_{s_i} (g_i (s_i - c_i) + m s_i^2) - m`, the terms with m for the coordinates of the ball alone. The rest of the
/// slopes is taken by its magnitude. `None` where the box lies inside the ball, so that the slopes have said it all.
fn lower_bound_in_ball(frame: &Frame, value: &Centred, ball: &Ball) -> Option<Enclosure> {
    let farthest = ball
        .ends
        .iter()
        .zip(&ball.member)
        .filter(|(_, member)| **member)
        .map(|([low, _, high], _)| low.upper_f64().abs().max(high.upper_f64().abs()).portable_powi(2));
    if farthest.sum::<f64>() <= 1.0 || !value.range.is_defined() || !value.centre.is_defined() {
        return None;
    }
    let slopes: Vec<f64> =
        value.slopes.iter().map(|slope| slope.as_ref().map_or(0.0, Enclosure::midpoint_f64)).collect();
    if slopes.iter().any(|slope| !slope.is_finite()) {
        return None;
    }
    let ends: Vec<[f64; 3]> = ball.ends.iter().map(|ends| ends.each_ref().map(Enclosure::midpoint_f64)).collect();
    let multiplier = multiplier(&slopes, &ends, &ball.member)?;
    let weight = Enclosure::exactly(multiplier);
    let mut sum = value.centre.floor() - &weight;
    for (i, slope) in value.slopes.iter().enumerate() {
        let [low, middle, high] = &ball.ends[i];
        let taken = Enclosure::exactly(slopes[i]);
        if let Some(slope) = slope {
            sum = sum - (slope - &taken).abs() * &frame.halves[i];
        }
        if !ball.member[i] {
            sum = sum - taken.abs() * &frame.halves[i];
            continue;
        }
        // g (s - c) + m s^2 is convex: least where g + 2 m s = 0, or at an end. The unconstrained minimum is a lower bound.
        let rate = |s: &Enclosure| &taken + &weight * s * 2;
        let at = |s: &Enclosure| &taken * (s - middle) + &weight * s.sqr();
        sum = sum
            + if rate(low).is_nonnegative().is_true() {
                at(low)
            } else if rate(high).is_positive().is_false() {
                at(high)
            } else {
                (&taken * middle).negate() - taken.sqr() / (&weight * 4)
            };
    }
    Some(sum.floor())
}

/// A multiplier near the best: where the minimiser meets the sphere. `None` if the ball does not bind, or never is met.
fn multiplier(slopes: &[f64], ends: &[[f64; 3]], member: &[bool]) -> Option<f64> {
    let square = |multiplier: f64| -> f64 {
        let coordinate = |i: usize| {
            let [low, _, high] = ends[i];
            let free = if multiplier > 0.0 { -slopes[i] / (2.0 * multiplier) } else { -slopes[i] * f64::INFINITY };
            // A slope of 0 times infinity: the nearest point to 0.
            if free.is_nan() { 0.0_f64.clamp(low, high) } else { free.clamp(low, high) }
        };
        (0..slopes.len()).filter(|&i| member[i]).map(|i| coordinate(i).portable_powi(2)).sum()
    };
    if square(0.0) <= 1.0 {
        return None;
    }
    let norm = slopes.iter().zip(member).filter(|(_, member)| **member).map(|(slope, _)| slope * slope).sum::<f64>();
    let mut high = norm.sqrt();
    // From |g|/2 on the free minimiser lies in the ball; the ends of the box may hold it outside until later.
    let mut doubled = 0;
    while square(high) > 1.0 {
        high *= 2.0;
        doubled += 1;
        if doubled > BISECTIONS {
            return None;
        }
    }
    let mut low = 0.0;
    for _ in 0..BISECTIONS {
        let middle = (low + high) / 2.0;
        if square(middle) > 1.0 { low = middle } else { high = middle }
    }
    (high > 0.0 && high.is_finite()).then_some(high)
}

/// Whether a number is nonnegative, or positive where `strict`, all over the box.
pub(super) fn nonnegative(frame: &Frame, value: &Centred, ball: &Ball, strict: bool) -> Verdict {
    let holds = |lower: &Enclosure| match strict {
        true => lower.is_positive().is_true(),
        false => lower.is_nonnegative().is_true(),
    };
    if holds(&value.range) || holds(&lower_bound(frame, value, ball)) {
        return Verdict::Holds;
    }
    let fails = match strict {
        true => value.centre.is_positive().is_false(),
        false => value.centre.is_nonnegative().is_false(),
    };
    if fails {
        return Verdict::Fails;
    }
    let mut blame = Blame::new(frame);
    blame.add(frame, value);
    blame.verdict(frame)
}

/// Whether the matrix is positive definite all over the box.
pub(super) fn definite(frame: &Frame, matrix: &SymmetricValues, ball: &Ball) -> Verdict {
    let order = matrix.order;
    let mut middle = vec![vec![0.0; order]; order];
    for (i, j, value) in &matrix.entries {
        let double = value.centre.midpoint_f64();
        if !double.is_finite() {
            let mut blame = Blame::new(frame);
            blame.excess.fill(f64::INFINITY);
            return blame.verdict(frame);
        }
        (middle[*i][*j], middle[*j][*i]) = (double, double);
    }
    let (values, vectors) = eigen(middle);
    // The least eigenvalue last, so that it is met when all others have been eliminated.
    let mut places: Vec<usize> = (0..order).collect();
    places.sort_by(|&a, &b| values[b].total_cmp(&values[a]));
    // So that products of two entries, and their sums, are doubles.
    let short = |entry: f64| ((entry * GRID).round() / GRID).clamp(-1.0, 1.0);
    let columns: Vec<Vec<f64>> =
        places.iter().map(|&k| (0..order).map(|row| short(vectors[row][k])).collect()).collect();
    // Entry (a, b) of K^T S K.
    let transformed = |a: usize, b: usize| {
        let zero = frame.constant(Enclosure::zero(PRECISION));
        let sum = matrix.entries.iter().fold(zero, |sum, (i, j, value)| {
            let mut factor = columns[a][*i] * columns[b][*j];
            if i != j {
                factor += columns[a][*j] * columns[b][*i];
            }
            // 0 times what may be undefined is undefined.
            match factor == 0.0 && value.range.is_defined() {
                true => sum,
                false => plus(&sum, &frame.scale(value, &Enclosure::exactly(factor))),
            }
        });
        frame.tightened(sum)
    };
    let entries: Vec<Vec<Centred>> = (0..order).map(|a| (0..=a).map(|b| transformed(a, b)).collect()).collect();
    let lowers: Vec<Enclosure> = (0..order).map(|a| lower_bound(frame, &entries[a][a], ball)).collect();
    let Err(at) = eliminate(&entries, &lowers) else { return Verdict::Holds };
    // A vector with a negative form in the middle of the box.
    if entries.iter().enumerate().any(|(a, row)| row[a].centre.is_nonnegative().is_false()) {
        return Verdict::Fails;
    }
    let mut blame = Blame::new(frame);
    blame.add(frame, &entries[at][at]);
    for b in 0..at {
        let pivot = lowers[b].lower_f64().max(f64::MIN_POSITIVE);
        let weight = 2.0 * entries[at][b].range.abs().upper_f64() / pivot;
        if weight.is_finite() {
            blame.add_off_diagonal(frame, &entries[at][b], weight);
        }
    }
    blame.verdict(frame)
}

/// Whether a product is 0 for the factor's sake: 0 times what may be undefined is undefined.
pub(super) fn leaves_out(factor: &Rational, value: &Centred) -> bool {
    factor.is_zero() && value.range.is_defined()
}

/// Elimination by enclosures with lower bounds of the diagonal: whether every pivot is positive, or the first that is not.
///
/// A matrix with a larger diagonal is positive definite if this one is, so lower bounds serve.
fn eliminate(entries: &[Vec<Centred>], lowers: &[Enclosure]) -> Result<(), usize> {
    let order = lowers.len();
    let mut rows: Vec<Vec<Enclosure>> = (0..order)
        .map(|a| (0..=a).map(|b| if a == b { lowers[a].clone() } else { entries[a][b].range.clone() }).collect())
        .collect();
    for k in 0..order {
        if !rows[k][k].is_positive().is_true() {
            return Err(k);
        }
        for i in k + 1..order {
            for j in k + 1..=i {
                let change = if i == j { rows[i][k].sqr() } else { &rows[i][k] * &rows[j][k] };
                rows[i][j] = &rows[i][j] - change / &rows[k][k];
            }
        }
    }
    Ok(())
}
