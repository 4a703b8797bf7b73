//! Functions on a box of some numbers, each by its value in the middle, its values on the box, and its derivatives there.
//!
//! `f(z) = f(c) + sum_i (z_i - c_i) D_i` with D_i in the enclosure of the i-th derivative on the box, where f is continuously differentiable on it
//! (mean value theorem). So a bound of f exceeds its largest value by what is of second order in the widths. An operation that is not smooth on the
//! whole box has undefined derivatives there; the values on the box stay what they are.

use super::complex::Complex;
use proofs_core::interval::Interval;

/// What a jet is made of.
pub trait Number: Clone {
    /// The sum.
    fn plus(&self, other: &Self) -> Self;
    /// The opposite number.
    fn opposite(&self) -> Self;
    /// The product.
    fn times(&self, other: &Self) -> Self;
    /// The quotient; undefined where the divisor may be 0.
    fn over(&self, other: &Self) -> Self;
    /// The product with every number of a real interval.
    fn by(&self, factor: &Interval) -> Self;
    /// What two enclosures of one number have in common; the first, where the second is undefined.
    fn meet(&self, other: &Self) -> Self;
}

impl Number for Interval {
    fn plus(&self, other: &Interval) -> Interval {
        self + other
    }

    fn opposite(&self) -> Interval {
        -self
    }

    fn times(&self, other: &Interval) -> Interval {
        self * other
    }

    fn over(&self, other: &Interval) -> Interval {
        self / other
    }

    fn by(&self, factor: &Interval) -> Interval {
        self * factor
    }

    fn meet(&self, other: &Interval) -> Interval {
        if other.is_defined() { self.intersect(other) } else { self.clone() }
    }
}

impl Number for Complex {
    fn plus(&self, other: &Complex) -> Complex {
        Complex { re: &self.re + &other.re, im: &self.im + &other.im }
    }

    fn opposite(&self) -> Complex {
        Complex { re: -&self.re, im: -&self.im }
    }

    fn times(&self, other: &Complex) -> Complex {
        Complex { re: &self.re * &other.re - &self.im * &other.im, im: &self.re * &other.im + &self.im * &other.re }
    }

    fn over(&self, other: &Complex) -> Complex {
        let square = other.square();
        let product = self.times(&other.conjugate());
        Complex { re: product.re / &square, im: product.im / square }
    }

    fn by(&self, factor: &Interval) -> Complex {
        self.scaled(factor)
    }

    fn meet(&self, other: &Complex) -> Complex {
        Complex { re: self.re.meet(&other.re), im: self.im.meet(&other.im) }
    }
}

/// A function on a box.
#[derive(Clone, Debug)]
pub struct Jet<T> {
    /// In the middle.
    pub middle: T,
    /// On the box.
    pub all: T,
    /// The derivatives on the box along the first axes; it does not change along the others.
    pub slopes: Vec<T>,
}

/// The axes of a box, by bounds of the distance from the middle.
pub struct Axes {
    /// As intervals around 0.
    around: Vec<Interval>,
}

impl Axes {
    /// With these half widths.
    pub fn new(half_widths: &[Interval]) -> Axes {
        Axes { around: half_widths.iter().map(crate::time::around).collect() }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.around.len()
    }

    /// How far a function moves from its middle, with these bounds of its derivatives.
    pub fn reach(&self, slopes: &[Interval], precision: u32) -> Interval {
        slopes
            .iter()
            .zip(&self.around)
            .fold(Interval::int(0, precision), |sum, (slope, around)| sum + slope.abs() * around.ceiling())
    }

    /// A bound of the distance from the middle along an axis; a hint.
    pub fn width(&self, axis: usize) -> f64 {
        self.around.get(axis).map_or(0.0, |around| around.hi().to_f64())
    }

    /// What the mean value theorem says of the values on the box is put beside what is known of them.
    pub fn narrowed<T: Number>(&self, jet: Jet<T>) -> Jet<T> {
        let by_slopes = jet
            .slopes
            .iter()
            .zip(&self.around)
            .fold(jet.middle.clone(), |sum, (slope, around)| sum.plus(&slope.by(around)));
        Jet { all: jet.all.meet(&by_slopes), ..jet }
    }

    /// The product.
    pub fn times<T: Number>(&self, a: &Jet<T>, b: &Jet<T>) -> Jet<T> {
        let slopes = along(a, b, |slope| slope.times(&b.all), |slope| a.all.times(slope));
        self.narrowed(Jet { middle: a.middle.times(&b.middle), all: a.all.times(&b.all), slopes })
    }

    /// The quotient q = a/b, with the derivatives `(a' - q b')/b`.
    pub fn over<T: Number>(&self, a: &Jet<T>, b: &Jet<T>) -> Jet<T> {
        let all = a.all.over(&b.all);
        let slopes = along(a, b, T::clone, |slope| all.times(slope).opposite());
        let slopes = slopes.iter().map(|slope| slope.over(&b.all)).collect();
        self.narrowed(Jet { middle: a.middle.over(&b.middle), slopes, all })
    }

    /// The square of the modulus.
    pub fn square(&self, z: &Jet<Complex>) -> Jet<Interval> {
        let slope = |slope: &Complex| (&z.all.re * &slope.re + &z.all.im * &slope.im) * 2;
        self.narrowed(Jet {
            middle: z.middle.square(),
            all: z.all.square(),
            slopes: z.slopes.iter().map(slope).collect(),
        })
    }

    /// The root of what is not negative; its derivatives are undefined where that may be 0.
    pub fn root(&self, square: &Jet<Interval>) -> Jet<Interval> {
        let all = square.all.sqrt();
        let slopes = square.slopes.iter().map(|slope| slope / (&all * 2)).collect();
        self.narrowed(Jet { middle: square.middle.sqrt(), slopes, all })
    }

    /// A number that the function does not exceed on the box.
    pub fn most(&self, jet: &Jet<Interval>) -> Interval {
        self.narrowed(jet.clone()).all.ceiling()
    }
}

/// The derivatives of a function of two: along each axis the sum of what moves with the one and with the other.
fn along<T: Number>(a: &Jet<T>, b: &Jet<T>, of_a: impl Fn(&T) -> T, of_b: impl Fn(&T) -> T) -> Vec<T> {
    let at = |i: usize| {
        let parts = [a.slopes.get(i).map(&of_a), b.slopes.get(i).map(&of_b)];
        parts.into_iter().flatten().reduce(|a, b| a.plus(&b))
    };
    (0..a.slopes.len().max(b.slopes.len())).filter_map(at).collect()
}

impl<T: Number> Jet<T> {
    /// A number that does not change.
    pub fn constant(value: &T) -> Jet<T> {
        Jet { middle: value.clone(), all: value.clone(), slopes: Vec::new() }
    }

    /// The sum.
    pub fn plus(&self, other: &Jet<T>) -> Jet<T> {
        let slopes = along(self, other, T::clone, T::clone);
        Jet { middle: self.middle.plus(&other.middle), all: self.all.plus(&other.all), slopes }
    }

    /// The difference.
    pub fn minus(&self, other: &Jet<T>) -> Jet<T> {
        self.plus(&other.mapped(T::opposite))
    }

    /// A linear function of it.
    pub fn mapped<S>(&self, map: impl Fn(&T) -> S) -> Jet<S> {
        Jet { middle: map(&self.middle), all: map(&self.all), slopes: self.slopes.iter().map(map).collect() }
    }
}

#[cfg(test)]
#[allow(clippy::disallowed_methods, reason = "what is compared need not be the same on every machine")]
mod tests {
    use super::*;
    use crate::PRECISION;
    use crate::by_n_o::linear::tests::number;

    /// A coordinate between `middle - w` and `middle + w`.
    fn coordinate(axis: usize, middle: f64, w: f64) -> Jet<Complex> {
        let one = Complex::real(number(1.0));
        let slopes = (0..=axis).map(|i| if i == axis { one.clone() } else { Complex::zero(PRECISION) });
        let all = number(middle - w).hull(&number(middle + w));
        Jet { middle: Complex::real(number(middle)), all: Complex::real(all), slopes: slopes.collect() }
    }

    /// `|(x + i y)/(2 - x y) - i x|` on boxes: no value of it is larger, and the bound is near the largest one.
    #[test]
    fn values_of_a_function_stay_below_its_bound() {
        let i = Jet::constant(&Complex { re: number(0.0), im: number(1.0) });
        let two = Jet::constant(&Complex::real(number(2.0)));
        for (x, y, w) in [(0.5, 0.25, 0.05), (-0.75, 0.5, 0.01), (1.0, -1.0, 0.1)] {
            let axes = Axes::new(&[number(w), number(w)]);
            let [a, b] = [coordinate(0, x, w), coordinate(1, y, w)];
            let above = a.plus(&axes.times(&i, &b));
            let below = two.minus(&axes.times(&a, &b));
            let f = axes.over(&above, &below).minus(&axes.times(&i, &a));
            let most = axes.most(&axes.root(&axes.square(&f))).hi().to_f64();
            let value = |x: f64, y: f64| (x / (2.0 - x * y)).hypot(y / (2.0 - x * y) - x);
            let ends = |middle: f64| (-8..=8).map(move |k| middle + w * f64::from(k) / 8.0);
            let largest = ends(x).flat_map(|x| ends(y).map(move |y| value(x, y))).fold(0.0, f64::max);
            assert!(largest <= most && most < largest * (1.0 + 10.0 * w * w), "{largest} {most}");
        }
    }

    /// Where a divisor or a root may be 0 nothing is known of the derivatives.
    #[test]
    fn what_is_not_smooth_has_no_derivatives() {
        let axes = Axes::new(&[number(0.5)]);
        let x = coordinate(0, 0.25, 0.5);
        let one = Jet::constant(&Complex::real(number(1.0)));
        assert!(!axes.over(&one, &x).all.re.is_defined() && !axes.over(&one, &x).slopes[0].re.is_defined());
        let size = axes.root(&axes.square(&x));
        assert!(!size.slopes[0].is_defined() && axes.most(&size).hi().to_f64() < 0.751);
    }
}
