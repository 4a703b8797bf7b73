//! The cells that a period is cut into, and trigonometric polynomials as Taylor series on them.

use super::taylor::Taylor;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::expr::TrigonometricPolynomial;
use sigmastar_lang::spec::TrigonometricVector;

/// The precision of the enclosures, in bits: cells lose a dozen of them, and a defect is some 40 below the terms.
pub(super) const PRECISION: u32 = 96;

/// A trigonometric polynomial `mean + sum_k (cos_k cos(2 pi k s) + sin_k sin(2 pi k s))`, s = t/T, with enclosed coefficients.
pub(super) type Wave = TrigonometricPolynomial;

/// A rational coefficient as one of a wave.
pub(super) fn enclose(value: &Rational) -> Enclosure {
    Enclosure::from_rational(value, PRECISION)
}

/// The components of a vector as waves.
pub(super) fn waves(vector: &TrigonometricVector) -> Vec<Wave> {
    (0..vector.mean.len()).map(|i| vector.map(|part| enclose(&part[i]))).collect()
}

/// `count` cells of equal length that cover [0, 1] in s = t/T, and what every expansion on them needs.
///
/// Cell j has the middle `(2j+1)/(2 count)` and the half-width `1/(2 count)`, both exact.
pub(super) struct Cells {
    /// A power of two.
    pub(super) count: usize,
    pub(super) half: Enclosure,
    /// `[-half, half]`.
    pub(super) width: Enclosure,
    pub(super) precision: u32,
    /// (cos, sin) of `2 pi m/(2 count)`, m = 0, 1, ..., 2 count - 1.
    circle: Vec<[Enclosure; 2]>,
    /// `(2 pi k)^j/j!` for k = 1, 2, ... and j = 0, 1, ...
    powers: Vec<Vec<Enclosure>>,
}

impl Cells {
    /// `2^exponent` cells, for so many harmonics and series up to an order.
    pub(super) fn new(exponent: u32, precision: u32, harmonics: usize, order: usize) -> Cells {
        let count = 1_usize << exponent;
        let ratio = |numerator: i64, denominator: usize| {
            Enclosure::from_rational(&Rational::from((numerator, denominator as u64)), precision)
        };
        let half = ratio(1, 2 * count);
        let turn = Enclosure::pi(precision) * 2;
        let circle = (0..2 * count)
            .map(|m| {
                let angle = &turn * ratio(m as i64, 2 * count);
                angle.cos_sin()
            })
            .collect();
        let powers = (1..=harmonics)
            .map(|k| {
                let w = &turn * k as i64;
                let next = |(j, power): &(i64, Enclosure)| Some((j + 1, power * &w / (j + 1)));
                let all = std::iter::successors(Some((0, Enclosure::one(precision))), next);
                all.take(order + 2).map(|(_, power)| power).collect()
            })
            .collect();
        Cells { count, width: half.negate().hull(&half), half, precision, circle, powers }
    }

    /// The middle of a cell.
    pub(super) fn middle(&self, cell: usize) -> Rational {
        Rational::from((2 * cell as u64 + 1, 2 * self.count as u64))
    }

    /// The time as a Taylor series about the middle of a cell, and over the cell.
    pub(super) fn time(&self, cell: usize, period: &Enclosure) -> [Taylor; 2] {
        let middle = Enclosure::from_rational(&self.middle(cell), self.precision);
        let over = &middle + &self.width;
        [middle, over].map(|s| vec![s * period, period.clone()])
    }

    /// The coefficients up to `order` of a wave, within what the cells were made for, about the middle of a cell, and over the cell.
    ///
    /// About the middle by the addition theorem; over the cell by Lagrange's form of Taylor's formula for each derivative: with
    /// w = 2 pi k and R a bound of `sum |c_k| w^M/M!`, M = order + 1,
    /// `coefficient j over the cell = sum_{i=j..order} C(i,j) c_i [-half,half]^(i-j) + C(M,j) [-R,R] [-half,half]^(M-j)`.
    pub(super) fn expand(&self, wave: &Wave, cell: usize, order: usize) -> [Taylor; 2] {
        let zero = Enclosure::zero(self.precision);
        let mut middle = vec![zero.clone(); order + 1];
        middle[0] = wave.mean.clone();
        let mut rest = zero;
        for (index, ([a, b], powers)) in wave.harmonics.iter().zip(&self.powers).enumerate() {
            if [a, b].iter().all(|part| part.is_exact() && part.contains_zero()) {
                continue;
            }
            let k = index + 1;
            let [cos, sin] = &self.circle[k * (2 * cell + 1) % self.circle.len()];
            // a cos + b sin and its derivative with respect to the angle; from there on each is minus the one before the last.
            let (value, slope) = (a * cos + b * sin, b * cos - a * sin);
            for (j, (coefficient, power)) in middle.iter_mut().zip(powers).enumerate() {
                let term = power * if j % 2 == 0 { &value } else { &slope };
                *coefficient = if j % 4 < 2 { &*coefficient + term } else { &*coefficient - term };
            }
            rest = rest + (a.sqr() + b.sqr()).sqrt() * &powers[order + 1];
        }
        let rest = rest.ceiling();
        let mut over: Taylor = middle.clone();
        over.push(rest.negate().hull(&rest));
        // Powers of the width times binomials, by Horner's rule shifted once for each coefficient (synthetic division) with
        // the interval in place of a number.
        for j in 0..=order {
            for i in (j..=order).rev() {
                let next = &over[i + 1] * &self.width;
                over[i] = &over[i] + next;
            }
        }
        over.truncate(order + 1);
        [middle, over]
    }
}
