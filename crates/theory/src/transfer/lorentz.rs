//! T_N(x) on an interval of x: the sums with the nearest pole taken out (derivation, section 2).

use crate::data::Data;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::Weights;

/// The weights n_0, ..., n_L, nu^2, and what is needed of the weights beyond.
#[derive(Clone, Debug)]
pub struct LorentzSums {
    /// n_0, n_1, ...
    weights: Vec<Enclosure>,
    nu_squared: Enclosure,
    precision: u32,
}

/// Which numbers of oscillators an evaluation covers.
#[derive(Clone, Debug)]
pub enum OscillatorRange {
    /// Exactly N.
    Exactly(u32),
    /// Every N >= N0; `tail` bounds sum_{l >= N0} n_l/l^2.
    AtLeast {
        /// N0.
        first: u32,
        /// An upper bound of sum_{l >= N0} n_l / l^2.
        tail: Enclosure,
    },
}

impl LorentzSums {
    /// Prepares the weights up to `last`.
    #[must_use]
    pub fn new(data: &Data<'_>, last: u32) -> LorentzSums {
        let weights = &data.spec.internal_model.weights;
        LorentzSums {
            weights: (0..=u64::from(last)).map(|l| weights.weight(l, data.precision)).collect(),
            nu_squared: data.nu.sqr(),
            precision: data.precision,
        }
    }

    /// The last pole that is summed one by one, if the weights reach it and the tail, if any, may be used near `nearest`.
    fn last(&self, nearest: u32, oscillators: &OscillatorRange) -> Option<u32> {
        let last = match oscillators {
            OscillatorRange::Exactly(n) => *n,
            OscillatorRange::AtLeast { first, .. } if *first > nearest => first - 1,
            OscillatorRange::AtLeast { .. } => return None,
        };
        (self.weights.len() > last as usize).then_some(last)
    }

    /// An enclosure containing T_N(x) for every x in the interval and every N covered.
    ///
    /// `nearest` is an integer m with |x - m| <= 1/2 on the interval, x >= 0. With d = x - m and the pole m <= N taken
    /// out, T = (c_m + R' d^2)/(d^2 + nu^2 (c_m - R d)^2); where N < m, T = g'/(1 + nu^2 g^2). For every N >= N0 the
    /// sums beyond N0 - 1 lie in [0, x th/(1-(x/N0)^2)] and [0, 2 th/(1-(x/N0)^2)^2]; this needs m <= N0 - 1.
    /// Undefined when a hypothesis fails or the interval is too wide.
    #[must_use]
    pub fn enclose(&self, x: &Enclosure, nearest: u32, oscillators: &OscillatorRange) -> Enclosure {
        let Some(last) = self.last(nearest, oscillators) else { return Enclosure::undefined(self.precision) };
        let has_pole = nearest <= last;
        let (mut sum, mut slope) = (Enclosure::zero(self.precision), Enclosure::zero(self.precision));
        // Each term is monotone in x where it is used, so a single use of x keeps the sums tight.
        let mut add = |c: &Enclosure, distance: Enclosure| {
            let inverse = distance.recip();
            slope = &slope + c * inverse.sqr();
            sum = &sum + c * inverse;
        };
        if !(has_pole && nearest == 0) {
            add(&self.weights[0], -x);
        }
        for (l, weight) in self.weights.iter().enumerate().take(last as usize + 1).skip(1) {
            let half = weight / 2;
            add(&half, -(l as i64 + x));
            if l != nearest as usize {
                add(&half, l as i64 - x);
            }
        }
        if let OscillatorRange::AtLeast { first, tail } = oscillators {
            let (more, steeper) = beyond(x, *first, tail);
            sum = sum + x * more;
            slope = slope + steeper;
        }
        if !has_pole {
            return slope / (1 + &self.nu_squared * sum.sqr());
        }
        let residue = if nearest == 0 { self.weights[0].clone() } else { &self.weights[nearest as usize] / 2 };
        let d = x - i64::from(nearest);
        let rest = &residue - sum * &d;
        (residue + slope * d.sqr()) / (d.sqr() + &self.nu_squared * rest.sqr())
    }

    /// The two sides of the bound on [0, b], b <= 1/2, divided by y = x^2, for every N >= 1 covered: where `.0 <= .1` is
    /// proved and k0 >= 1/(nu^2 n_0), T_N(x) <= k0 + k1 x^2 holds on [0, b]. It reaches k0 = T_N(0) itself.
    ///
    /// With S = sum n_l/(l^2 - y) and D = sum n_l (l^2 + y)/(l^2 - y)^2 over 1 <= l <= N, T_N = (n_0 + D y)/(y + nu^2
    /// (n_0 - S y)^2). Multiplied out, the bound has the terms k0 nu^2 n_0^2 - n_0 >= 0 of order 0, and y times
    /// k0 (1 - 2 nu^2 n_0 S + nu^2 S^2 y) + k1 (y + nu^2 (n_0 - S y)^2) - D.
    #[must_use]
    pub fn near_zero(
        &self,
        b: &Enclosure,
        oscillators: &OscillatorRange,
        pair: [&Enclosure; 2],
    ) -> (Enclosure, Enclosure) {
        let undefined = || (Enclosure::undefined(self.precision), Enclosure::undefined(self.precision));
        let Some(last) = self.last(0, oscillators) else { return undefined() };
        if !(2 * b).le(&Enclosure::one(self.precision)).is_true() {
            return undefined();
        }
        let zero = Enclosure::zero(self.precision);
        let x = zero.hull(b);
        let y = x.sqr();
        let (mut s, mut slope) = (zero.clone(), zero);
        for (l, weight) in self.weights.iter().enumerate().take(last as usize + 1).skip(1) {
            let square = Enclosure::from_integer((l * l) as i64, self.precision);
            let inverse = (&square - &y).recip();
            slope = slope + weight * (square + &y) * inverse.sqr();
            s = s + weight * inverse;
        }
        if let OscillatorRange::AtLeast { first, tail } = oscillators {
            let (more, steeper) = beyond(&x, *first, tail);
            s = s + more;
            slope = slope + steeper;
        }
        (slope, divided_at_zero([&self.weights[0], &self.nu_squared], &y, &s, pair))
    }
}

/// `k0 (1 - 2 nu^2 n_0 S + nu^2 S^2 y) + k1 (y + nu^2 (n_0 - S y)^2)`: what D may be near x = 0, y = x^2.
pub(super) fn divided_at_zero(
    [n_0, nu_squared]: [&Enclosure; 2],
    y: &Enclosure,
    s: &Enclosure,
    pair: [&Enclosure; 2],
) -> Enclosure {
    let first = 1 - 2 * (nu_squared * n_0 * s) + nu_squared * s.sqr() * y;
    let second = y + nu_squared * (n_0 - s * y).sqr();
    pair[0] * first + pair[1] * second
}

/// What the poles |l| >= first can add, for any N >= first, or any of them: to the sum, divided by x, and to the slope.
pub(super) fn beyond(x: &Enclosure, first: u32, tail: &Enclosure) -> (Enclosure, Enclosure) {
    let zero = Enclosure::zero(x.precision());
    let gap = 1 - (x / i64::from(first)).sqr();
    (zero.hull(&(tail / &gap)), zero.hull(&(2 * tail / gap.sqr())))
}

/// An upper bound of th = sum_{l >= first} n_l/l^2, first >= 1: `first^-(2+eps)/(2+eps) + first^-(3+eps)` for the power
/// family (an integral), and by W2 `n_first (1/(2 first) + 1/first^2)` otherwise.
#[must_use]
pub fn weight_tail(data: &Data<'_>, first: u32) -> Enclosure {
    let weights = &data.spec.internal_model.weights;
    let n = Enclosure::from_integer(i64::from(first), data.precision);
    match weights {
        Weights::Power { epsilon, .. } => {
            let exponent = 2 + epsilon.enclose(data.precision);
            let power = n.pow(&exponent).recip();
            (&power / exponent + power / n).ceiling()
        }
        Weights::Explicit { .. } => {
            let per = (2 * &n).recip() + n.sqr().recip();
            (weights.weight(u64::from(first), data.precision) * per).ceiling()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rug::Rational;
    use sigmastar_lang::spec::Specification;

    const PAPER_EXAMPLE: &str = include_str!("../../../../specs/paper-example.json");

    fn paper_example() -> Specification {
        Specification::from_json("paper-example", PAPER_EXAMPLE).unwrap()
    }

    /// T_N(x) from its definition, in doubles: good to 1e-9 away from the poles.
    fn direct(x: f64, n: u32, nu: f64) -> f64 {
        let (mut g, mut slope) = (-2.0 / x, 2.0 / (x * x));
        for l in 1..=n {
            let (l, weight) = (f64::from(l), f64::from(l).powf(-1.5) / 2.0);
            g += weight * (1.0 / (l - x) - 1.0 / (l + x));
            slope += weight * (1.0 / (l - x).powi(2) + 1.0 / (l + x).powi(2));
        }
        slope / (1.0 + nu * nu * g * g)
    }

    #[test]
    fn agrees_with_the_definition_and_covers_larger_n() {
        let spec = paper_example();
        let data = Data::new(&spec, 128);
        let sums = LorentzSums::new(&data, 40);
        let nu = data.nu.midpoint_f64();
        let later = OscillatorRange::AtLeast { first: 8, tail: weight_tail(&data, 8) };
        for (numerator, nearest) in [(13, 0), (45, 0), (55, 1), (103, 1), (149, 1), (151, 2), (249, 2), (312, 3)] {
            let x = Enclosure::from_rational(&Rational::from((numerator, 100)), 128);
            let value = f64::from(numerator) / 100.0;
            for n in [1, 2, 3, 7, 8, 20, 40] {
                let exact = sums.enclose(&x, nearest, &OscillatorRange::Exactly(n));
                let expected = direct(value, n, nu);
                assert!((exact.midpoint_f64() / expected - 1.0).abs() < 1e-9, "x = {value}, N = {n}");
                if n >= 8 {
                    let all = sums.enclose(&x, nearest, &later);
                    assert!(all.lower() <= exact.upper() && all.upper() >= exact.lower());
                }
            }
        }
    }

    #[test]
    fn the_poles_are_removable() {
        let spec = paper_example();
        let data = Data::new(&spec, 128);
        let sums = LorentzSums::new(&data, 5);
        let inverse = data.nu.sqr().recip();
        let at = |m: u32| sums.enclose(&Enclosure::from_integer(i64::from(m), 128), m, &OscillatorRange::Exactly(5));
        assert!((at(0) / (&inverse / &data.n_0)).contains(&Rational::from(1)));
        let two = 2 * &inverse / spec.internal_model.weights.weight(2, 128);
        assert!((at(2) / two).contains(&Rational::from(1)));
    }

    #[test]
    fn what_lies_beyond_is_enclosed_as_derived() {
        let half = Enclosure::from_rational(&Rational::from((1, 2)), 128);
        let [value, slope] = <[Enclosure; 2]>::from(beyond(&half, 2, &Enclosure::from_integer(3, 128)));
        // 3/(1 - 1/16) and 2 * 3/(1 - 1/16)^2; N = N0 - 1 + 0 poles add nothing.
        assert!(value.lower() == 0 && value.upper_f64() >= 3.2 && value.upper_f64() < 3.2 + 1e-12);
        let steepest = 6.0 * 256.0 / 225.0;
        assert!(slope.lower() == 0 && (slope.upper_f64() - steepest).abs() < 1e-12);
    }

    /// Every N >= N0 that is summed lies in the enclosure for all of them, on whole boxes next to the first own pole.
    #[test]
    fn all_larger_n_contain_each_of_them() {
        let spec = paper_example();
        let data = Data::new(&spec, 128);
        let sums = LorentzSums::new(&data, 60);
        for first in [1, 2, 3, 8] {
            let later = OscillatorRange::AtLeast { first, tail: weight_tail(&data, first) };
            for numerator in [1, 3, 7, 10 * first - 8, 10 * first - 6, 10 * first - 5] {
                let x = Enclosure::from_rational(&Rational::from((numerator, 10)), 128);
                let nearest = (numerator + 4) / 10;
                let all = sums.enclose(&x, nearest, &later);
                assert!(all.is_bounded() || nearest >= first);
                for n in [first, first + 1, first + 5, 60] {
                    let one = sums.enclose(&x, nearest, &OscillatorRange::Exactly(n));
                    let inside = all.lower() <= one.upper() && one.lower() <= all.upper();
                    let strictly = all.lower() <= one.lower() && one.upper() <= all.upper();
                    assert!(!all.is_defined() || (inside && strictly), "N0 = {first}, N = {n}, x = {numerator}/10");
                }
            }
        }
    }

    #[test]
    fn tails_of_the_weights_are_upper_bounds() {
        let paper = paper_example();
        let family = r#"{ "family": "power", "n0": "2", "epsilon": "1/2" }"#;
        // Nearly l n_l = const, for which the bound from W2 is nearly attained.
        let flat = r#"{"family": "explicit", "values": ["2"], "tail": {"coefficient": "1", "exponent": "1.001"}}"#;
        assert!(PAPER_EXAMPLE.contains(family));
        let flat = Specification::from_json("flat", &PAPER_EXAMPLE.replace(family, flat)).unwrap();
        for (spec, exponent) in [(&paper, 1.5), (&flat, 1.001)] {
            let data = Data::new(spec, 128);
            for first in [1, 2, 5, 30] {
                let sum: f64 = (first..200_000).map(|l| f64::from(l).powf(-2.0 - exponent)).sum();
                let tail = weight_tail(&data, first).upper_f64();
                assert!(sum <= tail && tail < 1.6 * sum, "{exponent} {first}: {sum} {tail}");
            }
        }
    }

    /// The divided form never promises more than the bound itself leaves, for any N that it covers.
    #[test]
    fn the_form_divided_by_x_squared_is_below_the_exact_difference() {
        let spec = paper_example();
        let data = Data::new(&spec, 128);
        let sums = LorentzSums::new(&data, 60);
        let nu_squared = data.nu.midpoint_f64().powi(2);
        let weight = |l: u32| f64::from(l).powf(-1.5);
        let exact = |x: f64, n: u32, [k0, k1]: [f64; 2]| {
            let y = x * x;
            let s: f64 = (1..=n).map(|l| weight(l) / (f64::from(l * l) - y)).sum();
            let d: f64 = (1..=n).map(|l| weight(l) * (f64::from(l * l) + y) / (f64::from(l * l) - y).powi(2)).sum();
            let denominator = y + nu_squared * (2.0 - s * y).powi(2);
            ((k0 + k1 * y) * denominator - 2.0 - d * y - (k0 * nu_squared * 4.0 - 2.0)) / y
        };
        let cases = [(OscillatorRange::Exactly(1), vec![1]), (OscillatorRange::Exactly(5), vec![5])];
        let all = [1, 2, 4].map(|first| {
            (OscillatorRange::AtLeast { first, tail: weight_tail(&data, first) }, vec![first, first + 2, 60])
        });
        for (oscillators, members) in cases.into_iter().chain(all) {
            for pair in [[20.0, 75.0], [25.0, 40.0], [1000.0, 1.0]] {
                for b in [0.5, 0.25, 1.0 / 64.0] {
                    let ends = [pair[0], pair[1], b].map(|v| data.rational(&Rational::from_f64(v).unwrap()));
                    let (lhs, rhs) = sums.near_zero(&ends[2], &oscillators, [&ends[0], &ends[1]]);
                    let promised = rhs.lower_f64() - lhs.upper_f64();
                    for n in &members {
                        for x in [b, 0.9 * b, 0.5 * b, 0.1 * b] {
                            let truth = exact(x, *n, pair);
                            assert!(promised <= truth + 1e-6 * truth.abs(), "{oscillators:?} N = {n} b = {b} x = {x}");
                        }
                    }
                    // And for one N it is nearly that on small boxes.
                    if let (OscillatorRange::Exactly(n), true) = (&oscillators, b < 0.1) {
                        let truth = exact(b, *n, pair);
                        assert!(promised >= truth - 0.05 * truth.abs() - 1.0, "N = {n}: {promised} {truth}");
                    }
                }
            }
        }
        let wide = Enclosure::from_rational(&Rational::from((51, 100)), 128);
        let k = Enclosure::from_integer(1000, 128);
        assert!(!sums.near_zero(&wide, &OscillatorRange::Exactly(5), [&k, &k]).1.is_defined());
    }

    #[test]
    fn hypotheses_are_checked() {
        let spec = paper_example();
        let data = Data::new(&spec, 128);
        let sums = LorentzSums::new(&data, 5);
        let x = Enclosure::from_integer(3, 128);
        assert!(!sums.enclose(&x, 3, &OscillatorRange::Exactly(6)).is_defined());
        let tail = weight_tail(&data, 3);
        assert!(!sums.enclose(&x, 3, &OscillatorRange::AtLeast { first: 3, tail }).is_defined());
    }
}
