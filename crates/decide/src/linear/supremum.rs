//! How large a trigonometric polynomial becomes.

use super::PRECISION;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_theory::transfer::Complex;
use std::sync::LazyLock;

/// In how many parts the period is cut at first; of up to so many the cosines are known: powers of two.
const FIRST_PARTS: usize = 8;
const KNOWN_PARTS: usize = 256;

/// How close a bound is to come: by what share it may be above what an instant has, and the most parts of the period, a power of two.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fineness {
    pub(crate) room: f64,
    parts: usize,
}

impl Fineness {
    /// Of many members of a family.
    pub(crate) const COARSE: Fineness = Fineness { room: 1e-3, parts: KNOWN_PARTS };
    /// Of the states of one.
    pub(crate) const OF_STATES: Fineness = Fineness { room: 1e-3, parts: 1 << 14 };
    /// Of what is claimed of the members of a family, by a sum.
    pub(crate) const OF_SUMS: Fineness = Fineness { room: 1e-4, parts: 1 << 12 };
    /// Of what is claimed of one.
    pub(crate) const FINE: Fineness = Fineness { room: 1e-8, parts: 1 << 17 };
}

/// `cos(m pi/KNOWN_PARTS)` for m = 0, ..., 2 KNOWN_PARTS - 1.
static COSINES: LazyLock<Vec<Enclosure>> = LazyLock::new(|| {
    let angle = |m: usize| Enclosure::pi(PRECISION) * m as i64 / KNOWN_PARTS as i64;
    (0..2 * KNOWN_PARTS).map(|m| angle(m).cos()).collect()
});

/// The cosine and the sine of `m pi/parts`.
fn turned(m: usize, parts: usize) -> [Enclosure; 2] {
    let m = m % (2 * parts);
    if parts <= KNOWN_PARTS {
        // sin(a) = cos(a - pi/2).
        let m = m * (KNOWN_PARTS / parts);
        return [m, m + 2 * KNOWN_PARTS - KNOWN_PARTS / 2].map(|m| COSINES[m % (2 * KNOWN_PARTS)].clone());
    }
    let angle = Enclosure::pi(PRECISION) * m as i64 / parts as i64;
    angle.cos_sin()
}

/// The harmonics `w_k`, k = 0, 1, ..., K, of a vector `sum_k w_k e^{i k s}`, over -K..K with `w_-k = conj(w_k)`: they are the same in length, and w_0 is
/// real.
pub(crate) type Harmonics = Vec<Vec<Complex>>;

/// A vector with numbers in the middle of its coefficients.
struct Middles {
    /// These.
    middles: Harmonics,
    /// How far the vector may be from that with these, and a bound of the second derivative of the latter.
    apart: Enclosure,
    bent: Enclosure,
}

impl Middles {
    fn new(harmonics: &Harmonics) -> Middles {
        let exact = |value: &Enclosure| Enclosure::exactly(value.midpoint_f64());
        let middle = |w: &Complex| Complex { re: exact(&w.re), im: exact(&w.im) };
        let middles: Harmonics = harmonics.iter().map(|part| part.iter().map(middle).collect()).collect();
        let zero = || Enclosure::zero(PRECISION);
        let length =
            |squares: &mut dyn Iterator<Item = Enclosure>| squares.fold(zero(), |sum, square| sum + square).sqrt();
        let apart = harmonics.iter().zip(&middles).enumerate().fold(zero(), |sum, (k, (part, middles))| {
            sum + length(&mut part.iter().zip(middles).map(|(w, middle)| w.sub(middle).norm_squared())) * both(k)
        });
        let bent = middles.iter().enumerate().fold(zero(), |sum, (k, part)| {
            sum + length(&mut part.iter().map(Complex::norm_squared)) * (both(k) * (k * k) as i64)
        });
        Middles { middles, apart, bent }
    }

    /// The length on a part of the period; of one that is `alone` without its slope.
    fn on_part(&self, part: usize, parts: usize, alone: bool) -> Length {
        let zero = || Enclosure::zero(PRECISION);
        let components = self.middles.first().map_or(0, Vec::len);
        let (mut values, mut slopes) = (vec![zero(); components], vec![zero(); components]);
        for (k, part_of) in self.middles.iter().enumerate() {
            let [cos, sin] = turned(k * (2 * part + 1), parts);
            for ((value, slope), w) in values.iter_mut().zip(&mut slopes).zip(part_of) {
                *value = &*value + (&w.re * &cos - &w.im * &sin) * both(k);
                *slope = &*slope - (&w.re * &sin + &w.im * &cos) * (both(k) * k as i64);
            }
        }
        let half = Enclosure::pi(PRECISION) / parts as i64;
        let square = |all: &[Enclosure]| all.iter().fold(zero(), |sum, part| sum + part.sqr());
        let along = values.iter().zip(&slopes).fold(zero(), |sum, (value, slope)| sum + value * slope);
        let (own, of_slope) = (square(&values), square(&slopes));
        // |v + s v'|^2 for |s| <= half.
        let linear = (&own + along.abs() * &half * 2 + &of_slope * half.sqr()).sqrt();
        let curved = half.sqr() / 2 * &self.bent;
        let value = own.sqrt();
        // |v + s v'| <= |v| + s v'v/|v| + s^2 |v'|^2/(2 |v|).
        let tangent = || {
            let rest = of_slope * half.sqr() / (&value * 2) + &curved;
            let helps = value.is_positive().is_true() && (&value + &rest).le(&(&linear + &curved)).is_true();
            helps.then(|| (along / &value, rest))
        };
        Length { along: if alone { None } else { tangent() }, bound: linear + curved, value }
    }
}

/// A length on a part of the period.
struct Length {
    /// In the middle.
    value: Enclosure,
    /// Its slope there, and what it is at most above the tangent; none where the other bound is better in any case.
    along: Option<(Enclosure, Enclosure)>,
    /// On all of the part.
    bound: Enclosure,
}

/// Of k and -k.
fn both(k: usize) -> i64 {
    if k == 0 { 1 } else { 2 }
}

/// The largest sum of the Euclidean norms of such vectors at one s. Its lower end is not above what some instant has, the upper one not below what any
/// has; they are a share apart that the fineness says but for the width of the coefficients, where the parts of the period suffice for that.
///
/// About its middle a part of the period has the second Taylor polynomial as a bound.
pub(crate) fn supremum(vectors: &[Harmonics], fineness: Fineness) -> Enclosure {
    let vectors: Vec<Middles> = vectors.iter().map(Middles::new).collect();
    let zero = || Enclosure::zero(PRECISION);
    let apart = vectors.iter().fold(zero(), |sum, vector| sum + &vector.apart);
    let on_part = |part: usize, parts: usize| {
        let half = Enclosure::pi(PRECISION) / parts as i64;
        let lengths: Vec<Length> =
            vectors.iter().map(|vector| vector.on_part(part, parts, vectors.len() == 1)).collect();
        let value = lengths.iter().fold(zero(), |sum, length| sum + &length.value);
        let apart = lengths.iter().fold(zero(), |sum, length| sum + &length.bound);
        // Slopes of different signs take from each other.
        let (slope, rest) = lengths.iter().fold((zero(), zero()), |(slope, rest), length| match &length.along {
            Some((own, above)) => (slope + own, rest + &length.value + above),
            None => (slope, rest + &length.bound),
        });
        [value, apart.min(&(slope.abs() * half + rest))]
    };
    let mut open: Vec<(usize, usize, Enclosure)> = Vec::new();
    let mut met = zero();
    let look = |part: usize, parts: usize, met: &mut Enclosure| {
        let [value, bound] = on_part(part, parts);
        *met = met.max(&value);
        (part, parts, bound)
    };
    open.extend((0..FIRST_PARTS).map(|part| look(part, FIRST_PARTS, &mut met)));
    let mut above = zero();
    while let Some((part, parts, bound)) = open.pop() {
        if bound.upper_f64() <= met.lower_f64() * (1.0 + fineness.room) || parts == fineness.parts {
            above = above.max(&bound);
        } else {
            let halves = [2 * part, 2 * part + 1].map(|half| look(half, 2 * parts, &mut met));
            open.extend(halves);
        }
    }
    // From what is met at one instant up to the bound of all.
    let [low, high] = [(met - &apart).max(&zero()), above + apart];
    low.hull(&high)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(re: f64, im: f64) -> Complex {
        Complex { re: Enclosure::exactly(re), im: Enclosure::exactly(im) }
    }

    /// Of curves whose largest length is known: 3 cos s; 1 - 2 sin 2s; the circle (cos s, sin s); (1, cos s).
    #[test]
    fn the_largest_length_is_enclosed_closely() {
        let zero = || number(0.0, 0.0);
        let cases = [
            (vec![vec![zero()], vec![number(1.5, 0.0)]], 3.0),
            (vec![vec![number(1.0, 0.0)], vec![zero()], vec![number(0.0, 1.0)]], 3.0),
            (vec![vec![zero(), zero()], vec![number(0.5, 0.0), number(0.0, -0.5)]], 1.0),
            (vec![vec![number(1.0, 0.0), zero()], vec![zero(), number(0.5, 0.0)]], 2.0_f64.sqrt()),
        ];
        for (harmonics, expected) in cases {
            for fineness in [Fineness::COARSE, Fineness::FINE] {
                let (found, room) = (supremum(std::slice::from_ref(&harmonics), fineness), fineness.room);
                assert!(found.lower_f64() <= expected && expected <= found.upper_f64(), "{expected}: {found:?}");
                assert!(found.upper_f64() <= expected * (1.0 + 1.1 * room), "{expected}, {room}: {found:?}");
            }
        }
        // Nothing is nothing, and what is not known exactly is not below what it may be.
        assert_eq!(supremum(&[vec![vec![zero()], vec![zero()]]], Fineness::COARSE).upper_f64(), 0.0);
        let wide = Complex { re: Enclosure::exactly(1.0).hull(&Enclosure::exactly(2.0)), im: Enclosure::exactly(0.0) };
        assert!(supremum(&[vec![vec![zero()], vec![wide]]], Fineness::COARSE).upper_f64() >= 4.0);
    }
    /// 3 |cos s| + 4 |sin s| is 5 at the most, and not 7; 1 + |cos s| is 2.
    #[test]
    fn the_sum_is_taken_at_one_instant() {
        let zero = || number(0.0, 0.0);
        let (cos, sin) = (vec![vec![zero()], vec![number(1.5, 0.0)]], vec![vec![zero()], vec![number(0.0, -2.0)]]);
        let (one, half) = (vec![vec![number(1.0, 0.0)]], vec![vec![zero()], vec![number(0.5, 0.0)]]);
        for (vectors, expected) in [([cos, sin], 5.0), ([one, half], 2.0)] {
            let found = supremum(&vectors, Fineness::FINE);
            assert!(found.lower_f64() <= expected && expected <= found.upper_f64(), "{expected}: {found:?}");
            assert!(found.upper_f64() <= expected * (1.0 + 2e-8), "{expected}: {found:?}");
        }
        assert_eq!(supremum(&[], Fineness::FINE).upper_f64(), 0.0);
    }
}
