//! Vectors of enclosures and of points: products, norms and midpoints with outward rounding.

use rug::Float;
use rug::float::Round;
use rug::ops::AddAssignRound;
use sigmastar_exact::enclosure::Enclosure;

/// Precision of norms and error bounds.
pub(super) const NORM_PRECISION: u32 = 64;

/// Enclosures of the entries of a vector, end by end (updated in place: the inner loops live on these).
#[derive(Clone, Debug)]
pub(super) struct Ranges {
    pub(super) lower: Vec<Float>,
    pub(super) upper: Vec<Float>,
}

impl Ranges {
    /// Zeros.
    pub(super) fn zero(n: usize, precision: u32) -> Ranges {
        Ranges { lower: vec![Float::new(precision); n], upper: vec![Float::new(precision); n] }
    }

    /// The entry k.
    pub(super) fn get(&self, k: usize) -> Enclosure {
        Enclosure::new(self.lower[k].clone(), self.upper[k].clone())
    }

    /// An upper bound of the Euclidean norm.
    pub(super) fn norm(&self) -> Enclosure {
        let entries: Vec<Enclosure> = (0..self.lower.len()).map(|k| self.get(k)).collect();
        norm(entries.iter())
    }
}

/// The end of a positive factor that makes its product with x extreme in the given direction.
pub(super) fn factor(positive: &Enclosure, x: &Float, direction: Round) -> Float {
    if (*x >= 0) == (direction == Round::Up) { positive.upper() } else { positive.lower() }
}

/// The exact scalar product of point vectors, enclosed: both accumulators are rounded outward at every step.
pub(super) fn dot<'a>(
    x: impl Iterator<Item = &'a Float>,
    y: impl Iterator<Item = &'a Float>,
    precision: u32,
) -> Enclosure {
    let (mut lower, mut upper) = (Float::new(precision), Float::new(precision));
    for (a, b) in x.zip(y) {
        lower.add_assign_round(a * b, Round::Down);
        upper.add_assign_round(a * b, Round::Up);
    }
    Enclosure::new(lower, upper)
}

/// The Euclidean norm of enclosed numbers, as an upper bound of it.
pub(super) fn norm<'a>(entries: impl Iterator<Item = &'a Enclosure>) -> Enclosure {
    let zero = Enclosure::zero(NORM_PRECISION);
    entries.fold(zero, |sum, x| sum + x.at_precision(NORM_PRECISION).sqr()).sqrt().ceiling()
}

/// The Euclidean norm of point entries, as an upper bound of it.
pub(super) fn point_norm(entries: &[Float]) -> Enclosure {
    dot(entries.iter(), entries.iter(), NORM_PRECISION).max(&Enclosure::zero(NORM_PRECISION)).sqrt().ceiling()
}

/// Midpoints, and what they leave out.
pub(super) fn middles(entries: &[Enclosure], precision: u32) -> (Vec<Float>, Vec<Enclosure>) {
    let middles: Vec<Float> = entries.iter().map(|x| Float::with_val(precision, x.lower() + x.upper()) / 2).collect();
    let rest = entries.iter().zip(&middles).map(|(x, m)| x - Enclosure::point(m)).collect();
    (middles, rest)
}

/// Midpoints and a bound of the norm of what they leave out.
pub(super) fn split(entries: &[Enclosure], precision: u32) -> (Vec<Float>, Enclosure) {
    let (middles, rest) = middles(entries, precision);
    (middles, norm(rest.iter()))
}

/// x 2^exponent, exactly.
pub(super) fn scale(x: &Enclosure, exponent: i32) -> Enclosure {
    Enclosure::new(x.lower() << exponent, x.upper() << exponent)
}
