//! The supremum of T_H(x) over every finite set H of harmonics that contains 0 (derivation, 14.7).

use super::lorentz::{beyond, divided_at_zero, weight_tail};
use crate::data::Data;
use sigmastar_exact::enclosure::Enclosure;

/// The weights n_0, ..., n_(N0-1), nu^2, and a bound of the sum of n_l/l^2 over l >= N0.
#[derive(Clone, Debug)]
pub(super) struct SetSums {
    weights: Vec<Enclosure>,
    nu_squared: Enclosure,
    first_of_tail: u32,
    tail: Enclosure,
    precision: u32,
}

/// What the pairs of poles l and -l, l >= 1, of any H without the pole m add, each from 0 for none of them to that for all.
struct Pairs {
    /// To -g, by those below m.
    below: Enclosure,
    /// To g, by those above m.
    above: Enclosure,
    /// To g'.
    slope: Enclosure,
}

impl SetSums {
    /// Prepares the weights below N0, `first_of_tail`.
    pub(super) fn new(data: &Data<'_>, first_of_tail: u32) -> SetSums {
        let weights = &data.spec.internal_model.weights;
        SetSums {
            weights: (0..u64::from(first_of_tail)).map(|l| weights.weight(l, data.precision)).collect(),
            nu_squared: data.nu.sqr(),
            first_of_tail,
            tail: weight_tail(data, first_of_tail),
            precision: data.precision,
        }
    }

    fn zero(&self) -> Enclosure {
        Enclosure::zero(self.precision)
    }

    /// Of `n_l x/(l^2 - x^2)` and `n_l (l^2 + x^2)/(l^2 - x^2)^2`, written so that each is used where it is monotone in x.
    fn pairs(&self, x: &Enclosure, nearest: u32) -> Pairs {
        let (mut below, mut above, mut slope) = (self.zero(), self.zero(), self.zero());
        for (l, weight) in (1..).zip(&self.weights[1..]).filter(|(l, _)| *l != i64::from(nearest)) {
            let half = weight / 2;
            let [near, far] = [(l - x).recip(), (l + x).recip()];
            slope = slope + &half * (near.sqr() + far.sqr());
            let signed = half * (near - far);
            if l < i64::from(nearest) {
                below = below - signed;
            } else {
                above = above + signed;
            }
        }
        let (more, steeper) = beyond(x, self.first_of_tail, &self.tail);
        let (above, slope) = (above + x * more, slope + steeper);
        let zero = self.zero();
        let [below, above, slope] = [below, above, slope].map(|part| zero.hull(&part));
        Pairs { below, above, slope }
    }

    /// An upper bound, as the upper end, of T_H(x) for every x in the interval and every H.
    ///
    /// `nearest` is an integer m < N0 with |x - m| <= 1/2 on the interval, x >= 0. With d = x - m, B = n_0/x, and P and Nn what the pairs above and below m
    /// add: for m in H `T = (c_m + R' d^2)/(d^2 + nu^2 (c_m - R d)^2)` with R in [-B - n_m/(2(m+x)) - Nn, -B - n_m/(2(m+x)) + P], for m = 0 in [0, P];
    /// for m not in H `T = g'/(1 + nu^2 g^2)` with g in [-B - Nn, -B + P]. Undefined where a hypothesis fails or the interval is too wide.
    pub(super) fn supremum(&self, x: &Enclosure, nearest: u32) -> Enclosure {
        let Some(weight) = self.weights.get(nearest as usize) else { return Enclosure::undefined(self.precision) };
        let Pairs { below, above, slope } = self.pairs(x, nearest);
        let d = x - i64::from(nearest);
        let with_pole = |residue: &Enclosure, sum: Enclosure, slope: Enclosure| {
            let rest = residue - sum * &d;
            (residue + slope * d.sqr()) / (d.sqr() + &self.nu_squared * rest.sqr())
        };
        if nearest == 0 {
            return with_pole(weight, above, slope);
        }
        let inverse = x.recip();
        let sum = above - below - &self.weights[0] * &inverse;
        let slope = slope + &self.weights[0] * inverse.sqr();
        let without = &slope / (1 + &self.nu_squared * sum.sqr());
        let (half, opposite) = (weight / 2, (i64::from(nearest) + x).recip());
        with_pole(&half, sum - &half * &opposite, slope + &half * opposite.sqr()).max(&without)
    }

    /// The two sides of the bound on [0, b], b <= 1/2, divided by x^2, for every H: where `.0 <= .1` is proved and k0 >= 1/(nu^2 n_0),
    /// T_H(x) <= k0 + k1 x^2 holds on [0, b]. It reaches k0 = T_H(0) itself.
    pub(super) fn near_zero(&self, b: &Enclosure, pair: [&Enclosure; 2]) -> (Enclosure, Enclosure) {
        if !(2 * b).le(&Enclosure::one(self.precision)).is_true() {
            return (Enclosure::undefined(self.precision), Enclosure::undefined(self.precision));
        }
        let x = self.zero().hull(b);
        let y = x.sqr();
        let mut sum = self.zero();
        for (l, weight) in (1..).zip(&self.weights[1..]) {
            sum = sum + weight * (l * l - &y).recip();
        }
        let (more, _) = beyond(&x, self.first_of_tail, &self.tail);
        let sum = self.zero().hull(&(sum + more));
        let slope = self.pairs(&x, 0).slope;
        (slope.ceiling(), divided_at_zero([&self.weights[0], &self.nu_squared], &y, &sum, pair))
    }
}

#[cfg(test)]
mod tests {
    use super::super::weights_only::weights_only;
    use super::*;
    use rug::Rational;

    /// T_H(x) by its definition, of the harmonics l >= 1 whose bits are set, and 0; x is no pole.
    fn transfer(bits: u32, x: f64, nu: f64, weight: impl Fn(u32) -> f64) -> f64 {
        let (mut g, mut slope) = (-weight(0) / x, weight(0) / (x * x));
        for l in (1..16).filter(|l| bits >> l & 1 == 1) {
            let half = weight(l) / 2.0;
            let [near, far] = [1.0 / (f64::from(l) - x), -1.0 / (f64::from(l) + x)];
            g += half * (near + far);
            slope += half * (near * near + far * far);
        }
        slope / (1.0 + nu * nu * g * g)
    }

    /// All sets of the first nine harmonics, near and between poles: none is above the supremum, and some come close, with the nearest pole and without it.
    #[test]
    fn no_set_is_above_the_supremum() {
        for (n_0, epsilon, mu) in [("2", "1/2", "1"), ("1.25", "1/8", "16"), ("4", "1", "1/8")] {
            let spec = weights_only(n_0, epsilon, mu, "1");
            let data = Data::new(&spec, 128);
            let weight = |l: u32| spec.internal_model.weights.weight_f64(u64::from(l));
            let sums = SetSums::new(&data, 12);
            for (numerator, nearest) in
                [(1, 0), (30, 0), (70, 1), (99, 1), (130, 1), (201, 2), (250, 3), (301, 3), (399, 4)]
            {
                let x = f64::from(numerator) / 100.0;
                let bound = sums.supremum(&data.rational(&Rational::from((numerator, 100))), nearest).upper_f64();
                let sets = || (0..1 << 9).map(|bits: u32| bits << 1);
                let most = sets().map(|bits| transfer(bits, x, data.nu.midpoint_f64(), weight)).fold(0.0, f64::max);
                assert!(
                    most <= bound * (1.0 + 1e-12) && bound < 3.0 * most,
                    "{n_0} {epsilon} {mu} {x}: {most} {bound}"
                );
            }
        }
    }

    /// An interval bounds each of its points; what is beyond the harmonics that are added one by one counts.
    #[test]
    fn an_interval_bounds_its_points() {
        let spec = weights_only("2", "1/2", "1", "1");
        let data = Data::new(&spec, 128);
        let [few, many] = [4, 40].map(|first| SetSums::new(&data, first));
        let interval = Enclosure::between(&Rational::from((13, 5)), &Rational::from((27, 10)), 128);
        let whole = few.supremum(&interval, 3).upper_f64();
        for numerator in [260, 265, 270] {
            let x = data.rational(&Rational::from((numerator, 100)));
            let [rough, fine] = [&few, &many].map(|sums| sums.supremum(&x, 3).upper_f64());
            assert!(fine <= rough && rough <= whole && whole < 2.5 * fine, "{numerator}: {fine} {rough} {whole}");
        }
        // m is not below N0, and the interval meets the pole 2.
        assert!(!few.supremum(&interval, 4).is_defined());
        let wide = Enclosure::between(&Rational::from((19, 10)), &Rational::from((27, 10)), 128);
        assert!(!few.supremum(&wide, 3).is_bounded());
    }
}
