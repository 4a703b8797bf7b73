//! What depends on t alone, on one interval of it.

use super::PRECISION;
use super::centred::Centred;
use super::side::Side;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use std::sync::OnceLock;

/// The waves `cos(2 pi k s)`, `sin(2 pi k s)` for s = t/T in an interval: in its middle and all over it.
#[derive(Clone, Debug)]
pub(super) struct Waves {
    middle: Vec<[Enclosure; 2]>,
    range: Vec<[Enclosure; 2]>,
    half: Enclosure,
}

/// `d^n/ds^n` of a wave is `(2 pi k)^n` times one of: itself, and so on.
fn turned([cos, sin]: [&Enclosure; 2], [a, b]: [&Rational; 2], order: u32) -> Enclosure {
    // a cos + b sin, b cos - a sin, -a cos - b sin, -b cos + a sin.
    let times = |value: &Rational, wave: &Enclosure| Enclosure::from_rational(value, PRECISION) * wave;
    match order % 4 {
        0 => times(a, cos) + times(b, sin),
        1 => times(b, cos) - times(a, sin),
        2 => (times(a, cos) + times(b, sin)).negate(),
        _ => times(a, sin) - times(b, cos),
    }
}

impl Waves {
    /// The first `degree` harmonics on a part of the period.
    pub(super) fn new(side: Side, degree: usize) -> Waves {
        let turn = Enclosure::pi(PRECISION) * 2;
        let [low, middle, high] = side.unit();
        let middle = Enclosure::from_rational(&middle, PRECISION) * &turn;
        let range = Enclosure::between(&low, &high, PRECISION) * &turn;
        let waves = |angle: &Enclosure| -> Vec<[Enclosure; 2]> {
            let multiples = (1..=degree as i64).map(|k| angle * k);
            multiples.map(|angle| angle.cos_sin()).collect()
        };
        let half = Enclosure::from_rational(&side.half(), PRECISION);
        Waves { middle: waves(&middle), range: waves(&range), half }
    }

    /// `mean + sum a_k cos + b_k sin`, or its first derivative with respect to s, as a value whose only side is s.
    ///
    /// The slope of F is `F'(c) + (s - c)/2 F''` with F'' anywhere in the interval.
    pub(super) fn polynomial<'a>(
        &self,
        mean: &Rational,
        coefficients: impl Iterator<Item = [&'a Rational; 2]> + Clone,
        derivative: bool,
    ) -> Centred {
        let turn = Enclosure::pi(PRECISION) * 2;
        let first = u32::from(derivative);
        let sum = |waves: &[[Enclosure; 2]], order: u32| {
            let start = match order {
                0 => Enclosure::from_rational(mean, PRECISION),
                _ => Enclosure::zero(PRECISION),
            };
            waves.iter().zip(coefficients.clone()).zip(1_i64..).fold(start, |sum, (([cos, sin], pair), k)| {
                let frequency = (&turn * k).pow_integer(&rug::Integer::from(order));
                sum + turned([cos, sin], pair, order) * frequency
            })
        };
        let centre = sum(&self.middle, first);
        let mut slope = sum(&self.middle, first + 1);
        if self.half.is_positive().is_true() {
            let change = &self.half / 2 * sum(&self.range, first + 2).abs();
            slope = slope + change.negate().hull(&change);
        }
        let reach = slope.abs() * &self.half;
        let linear = &centre + reach.negate().hull(&reach);
        let range = sum(&self.range, first).intersect(&linear);
        let varies = !(slope.is_exact() && slope.contains_zero());
        Centred { centre, range, slopes: vec![varies.then_some(slope)] }
    }
}

/// The orbit, the velocity x_0' and P on one interval of t. The only side is s = t/T.
#[derive(Clone, Debug)]
pub(super) struct TimeCell {
    /// The centre of xb.
    pub(super) orbit: Vec<Centred>,
    /// What is added to it times `p_i - p_i^0`, for each parameter.
    pub(super) sensitivities: Vec<Vec<Centred>>,
    /// f(t, xb + L v, 0) for all |v| <= r and all p, once it is asked for.
    pub(super) velocity: OnceLock<Vec<Centred>>,
    /// P and dP/dt, for the rate and the rate of existence.
    pub(super) matrices: [Option<[Vec<Vec<Centred>>; 2]>; 2],
}
