//! Polynomials with a rest (Taylor models): functions of the time and of parameters on a box, for what all but cancels there, such as the defect of a
//! trial of a family (derivation, 14.4). Mean values in the parameters would need far smaller boxes.
//!
//! The variables are x_0, x_1, ..., each from -1 to 1. A [`Model`] is a polynomial in them of a degree that is the same for all and a number that the
//! function is from it at most; what a product has beyond that degree goes there.

use super::taylor::Taylor;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use std::collections::HashMap;

/// Bits of the coefficients. Rests are sizes, for which doubles are precise enough.
pub(crate) const PRECISION: u32 = 96;

/// A function on the box.
///
/// Guarantee of [`Models`](super::models::Models): where the models of the variables are those of smooth functions and the rest of the result is bounded, the formula is smooth at
/// every point of the box and its value is, with some number in each coefficient, the polynomial up to the rest.
#[derive(Clone, Debug)]
pub(crate) struct Model {
    /// Of the monomials in the order of [`Space`]; those that are left out are 0.
    pub(super) coefficients: Vec<Enclosure>,
    /// How far the function is from the polynomial at most: its upper end counts.
    pub(super) rest: Enclosure,
}

/// All monomials up to a degree.
#[derive(Debug)]
pub(crate) struct Space {
    degree: usize,
    /// By rising degree, that of 1 first.
    pub(super) monomials: Vec<Vec<u8>>,
    /// Of each of them.
    degrees: Vec<usize>,
    /// Where each of them stands.
    places: HashMap<Vec<u8>, usize>,
    /// For each i the pairs (j, k) with `monomial i * monomial j = monomial k`.
    products: Vec<Vec<(usize, usize)>>,
}

/// Bits of sizes.
const SIZE_PRECISION: u32 = f64::MANTISSA_DIGITS;

fn zero() -> Enclosure {
    Enclosure::zero(PRECISION)
}

/// What |value| is at most: its upper end counts. A double where it is in the range of doubles.
fn size(value: &Enclosure) -> Enclosure {
    let largest = value.upper_f64().max(-value.lower_f64());
    if largest.is_normal() || largest == 0.0 { Enclosure::exactly(largest) } else { value.abs() }
}

/// The size of 0.
fn no_size() -> Enclosure {
    Enclosure::exactly(0.0)
}

/// All that is at most a size away from a value.
fn around(middle: &Enclosure, reach: &Enclosure) -> Enclosure {
    middle + reach.negate().hull(reach)
}

fn is_nothing(value: &Enclosure) -> bool {
    value.is_exact() && value.contains_zero()
}

fn degree_of(powers: &[u8]) -> usize {
    powers.iter().map(|power| usize::from(*power)).sum()
}

impl Space {
    /// Of so many variables, at least one.
    pub(crate) fn new(variables: usize, degree: usize) -> Space {
        let mut monomials: Vec<Vec<u8>> = vec![Vec::new()];
        for _ in 0..variables {
            let longer = |powers: &Vec<u8>| {
                let left = degree - degree_of(powers);
                (0..=left).map(|power| powers.iter().copied().chain([power as u8]).collect()).collect::<Vec<_>>()
            };
            monomials = monomials.iter().flat_map(longer).collect();
        }
        monomials.sort_by_key(|powers| degree_of(powers));
        let places: HashMap<Vec<u8>, usize> = monomials.iter().cloned().zip(0..).collect();
        let products = monomials.iter().map(|own| {
            let times = |(j, other): (usize, &Vec<u8>)| {
                let sum: Vec<u8> = own.iter().zip(other).map(|(a, b)| a + b).collect();
                Some((j, *places.get(&sum)?))
            };
            monomials.iter().enumerate().filter_map(times).collect()
        });
        let products = products.collect();
        let degrees = monomials.iter().map(|powers| degree_of(powers)).collect();
        Space { degree, monomials, degrees, places, products }
    }

    /// That up to which polynomials go.
    pub(crate) fn degree(&self) -> usize {
        self.degree
    }

    /// A number.
    pub(crate) fn constant(&self, value: Enclosure) -> Model {
        Model { coefficients: vec![value], rest: no_size() }
    }

    /// `middle + reach x_i`.
    pub(crate) fn variable(&self, i: usize, middle: Enclosure, reach: Enclosure) -> Model {
        let mut powers = vec![0; self.monomials.first().map_or(0, Vec::len)];
        let mut model = self.constant(middle);
        if let Some(power) = powers.get_mut(i) {
            *power = 1;
        }
        match self.places.get(&powers).copied() {
            Some(place) => {
                model.coefficients.resize(place + 1, zero());
                model.coefficients[place] = reach;
            }
            // Of degree 0.
            None => model.rest = size(&reach),
        }
        model
    }

    /// `sum_j values_j x_0^j`, up to the rest.
    pub(crate) fn in_time(&self, values: &[Enclosure], rest: Enclosure) -> Model {
        let mut model = Model { coefficients: Vec::new(), rest: size(&rest) };
        for (place, powers) in self.monomials.iter().enumerate() {
            let alone = powers.iter().skip(1).all(|power| *power == 0);
            if let Some(value) = powers.first().filter(|_| alone).and_then(|power| values.get(usize::from(*power))) {
                model.coefficients.resize(place + 1, zero());
                model.coefficients[place] = value.clone();
            }
        }
        model
    }

    /// What the coefficients of each degree are at most.
    fn by_degree(&self, model: &Model) -> Vec<Enclosure> {
        let mut sums = vec![no_size(); self.degree + 1];
        for (value, degree) in model.coefficients.iter().zip(&self.degrees).filter(|(value, _)| !is_nothing(value)) {
            sums[*degree] = &sums[*degree] + size(value);
        }
        sums
    }

    /// Of |model| on the box.
    pub(crate) fn bound(&self, model: &Model) -> Enclosure {
        model.coefficients.iter().fold(model.rest.clone(), |sum, value| sum + size(value))
    }

    pub(crate) fn sum(&self, a: &Model, b: &Model) -> Model {
        let count = a.coefficients.len().max(b.coefficients.len());
        let entry = |i: usize| match (a.coefficients.get(i), b.coefficients.get(i)) {
            (Some(a), Some(b)) => a + b,
            (Some(one), None) | (None, Some(one)) => one.clone(),
            (None, None) => zero(),
        };
        Model { coefficients: (0..count).map(entry).collect(), rest: &a.rest + &b.rest }
    }

    pub(crate) fn scaled(&self, a: &Model, factor: &Enclosure) -> Model {
        let coefficients = a.coefficients.iter().map(|value| value * factor).collect();
        Model { coefficients, rest: &a.rest * size(factor) }
    }

    pub(crate) fn product(&self, a: &Model, b: &Model) -> Model {
        self.product_up_to(a, b, self.degree)
    }

    /// The product with what is above a degree in the rest.
    fn product_up_to(&self, a: &Model, b: &Model, limit: usize) -> Model {
        let (of_a, of_b) = (self.by_degree(a), self.by_degree(b));
        let all = |sums: &[Enclosure]| sums.iter().fold(no_size(), |sum, value| sum + value);
        let mut rest = &a.rest * (all(&of_b) + &b.rest) + &b.rest * all(&of_a);
        for (i, a) in of_a.iter().enumerate() {
            for b in of_b.iter().skip((limit + 1).saturating_sub(i)).filter(|b| !is_nothing(b)) {
                rest = rest + a * b;
            }
        }
        let is_there: Vec<bool> = b.coefficients.iter().map(|value| !is_nothing(value)).collect();
        let mut coefficients: Vec<Enclosure> = Vec::new();
        for (value, products) in a.coefficients.iter().zip(&self.products).filter(|(value, _)| !is_nothing(value)) {
            for (j, k) in products.iter().take_while(|(_, k)| self.degrees[*k] <= limit) {
                if is_there.get(*j) == Some(&true) {
                    if coefficients.len() <= *k {
                        coefficients.resize(*k + 1, zero());
                    }
                    coefficients[*k] = &coefficients[*k] + value * &b.coefficients[*j];
                }
            }
        }
        Model { coefficients, rest }
    }

    /// A function of one number of a model, from its series at numbers: by Taylor's formula about the value in the middle of the box, with Lagrange's
    /// form of the rest.
    pub(super) fn composed(&self, a: &Model, series: impl Fn(&Taylor, usize) -> Taylor) -> Model {
        let (middle, apart) = self.about_middle(a);
        let reach = self.bound(&apart);
        let at = |value: Enclosure, order: usize| {
            let one = Enclosure::one(value.precision());
            series(&vec![value, one], order)
        };
        let about = at(middle.clone(), self.degree);
        // For the rest, a size.
        let over = at(around(&middle, &reach).at_precision(SIZE_PRECISION), self.degree + 1);
        let smooth = over.iter().chain(&about).all(Enclosure::is_defined);
        let mut result = Model { coefficients: Vec::new(), rest: no_size() };
        // Of what is to be multiplied by the j-th power of what has no constant the degrees up to the largest less j count.
        for (j, value) in about.iter().enumerate().rev() {
            result = self.sum(
                &self.product_up_to(&result, &apart, self.degree.saturating_sub(j)),
                &self.constant(value.clone()),
            );
        }
        let last = match (smooth, over.get(self.degree + 1)) {
            (false, _) => Enclosure::undefined(PRECISION),
            (true, None) => no_size(),
            (true, Some(last)) => (0..=self.degree).fold(size(last), |rest, _| rest * &reach),
        };
        result.rest = result.rest + last;
        result
    }

    /// The value in the middle of the box, and how far the others are from it.
    fn about_middle(&self, a: &Model) -> (Enclosure, Model) {
        let mut apart = a.clone();
        let middle = apart.coefficients.first_mut().map(|first| std::mem::replace(first, zero()));
        (middle.unwrap_or_else(zero), apart)
    }

    /// Where the values of a model are.
    pub(super) fn range(&self, a: &Model) -> Enclosure {
        let (middle, apart) = self.about_middle(a);
        let reach = self.bound(&apart);
        around(&middle, &reach)
    }

    /// The model on the half of the box where x_i is below 0, or above.
    fn half(&self, a: &Model, i: usize, above: bool) -> Model {
        // x = (y - 1)/2 or (y + 1)/2, by the binomials, a power of two at a time.
        let mut result = Model { coefficients: vec![zero(); a.coefficients.len()], rest: a.rest.clone() };
        for (value, powers) in a.coefficients.iter().zip(&self.monomials).filter(|(value, _)| !is_nothing(value)) {
            let power = powers.get(i).copied().unwrap_or(0);
            let scaled = value / Enclosure::from_rational(&(Rational::from(1) << u32::from(power)), PRECISION);
            let mut binomial = Rational::from(1);
            let mut own = powers.clone();
            for left in (0..=power).rev() {
                if let Some(entry) = own.get_mut(i) {
                    *entry = left;
                }
                let Some(place) = self.places.get(&own).copied() else { continue };
                let sign = if above || (power - left) % 2 == 0 { 1 } else { -1 };
                let factor = Enclosure::from_rational(&(Rational::from(&binomial) * sign), PRECISION);
                result.coefficients[place] = &result.coefficients[place] + &scaled * factor;
                // The next binomial coefficient.
                binomial = binomial * u32::from(left) / u32::from(power - left + 1);
            }
        }
        result
    }

    /// An upper bound of |model| on the box, by halves of it while it is not at most `enough` and they help, up to so many times.
    pub(crate) fn largest(&self, model: &Model, enough: f64, times: u32) -> Enclosure {
        let bound = self.bound(model);
        let may_help = model.rest.upper_f64() <= enough && bound.upper_f64() > enough;
        if times == 0 || !may_help {
            return bound;
        }
        let variables = self.monomials.first().map_or(0, Vec::len);
        let weight = |i: usize| {
            let with = model.coefficients.iter().zip(&self.monomials).filter(|(_, powers)| powers[i] > 0);
            with.map(|(value, _)| value.abs().upper_f64()).sum::<f64>()
        };
        let Some(widest) = (0..variables).max_by(|i, j| weight(*i).total_cmp(&weight(*j))) else { return bound };
        let halves = [false, true].map(|above| self.largest(&self.half(model, widest, above), enough, times - 1));
        halves[0].max(&halves[1]).min(&bound)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Coefficients beyond the range of doubles have no size in doubles, and what follows from them is bounded all the same.
    #[test]
    fn what_is_enormous_has_a_size() {
        let space = Space::new(1, 3);
        let huge = Enclosure::from_integer(10, PRECISION).pow_integer(&340.into());
        let tiny = huge.recip();
        let x = space.variable(0, huge.clone(), huge.clone());
        let by_hand = |model: &Model, low: &Enclosure, high: &Enclosure| {
            let bound = space.bound(model);
            assert!(low.le(&bound).is_true() && bound.le(high).is_true(), "{bound:?}");
        };
        by_hand(&x, &(&huge * 3 / 2), &(&huge * 3));
        let small = space.scaled(&space.product(&x, &x), &(&tiny * &tiny));
        by_hand(&small, &Enclosure::from_integer(3, PRECISION), &(Enclosure::from_integer(41, PRECISION) / 10));
        let nothing = space.product(&x, &space.constant(Enclosure::zero(PRECISION)));
        assert!(space.bound(&nothing).upper_f64() == 0.0);
        assert!(!space.bound(&space.constant(Enclosure::undefined(PRECISION))).is_bounded());
        assert!(!space.bound(&space.constant(Enclosure::entire(PRECISION))).is_bounded());
    }

    /// T_5(x_1) of size 1 has coefficients with a sum of 41.
    #[test]
    fn halves_bound_what_cancels() {
        let space = Space::new(2, 6);
        let exact = |value: i64| Enclosure::from_integer(value, PRECISION);
        let x = space.variable(1, exact(0), exact(1));
        let powers: Vec<Model> = (0..5)
            .scan(space.constant(exact(1)), |power, _| {
                *power = space.product(power, &x);
                Some(power.clone())
            })
            .collect();
        let terms = [(4, 16), (2, -20), (0, 5)].map(|(which, factor)| space.scaled(&powers[which], &exact(factor)));
        let chebyshev = terms.iter().fold(space.constant(exact(0)), |sum, term| space.sum(&sum, term));
        assert_eq!(space.bound(&chebyshev).upper_f64(), 41.0);
        let bound = space.largest(&chebyshev, 1.2, 10).upper_f64();
        assert!((1.0..=1.2).contains(&bound), "{bound}");
        // It is 1 somewhere, so that no halving gets below.
        assert!(space.largest(&chebyshev, 0.99, 10).upper_f64() >= 1.0);
    }
}
