//! Complex numbers that depend on the sides of a box, in mean value form: what a family leaves open is then bounded closely on few boxes.

use super::PRECISION;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_theory::transfer::Complex;

/// A number that depends on the sides of a box: its value in the middle, its values on the box, and its derivatives along the sides there. A side of which
/// there is no derivative is one on which it does not depend.
///
/// What is not known exactly, but does not depend on the sides, may be in the first two alone.
#[derive(Clone, Debug)]
pub(super) struct Jet {
    middle: Complex,
    all: Complex,
    slopes: Vec<Complex>,
}

/// How far the points of a box are from its middle, along each side.
#[derive(Clone, Debug, Default)]
pub(super) struct Offsets(pub(super) Vec<Enclosure>);

fn zero() -> Complex {
    Complex::real(Enclosure::zero(PRECISION))
}

fn negated(value: &Complex) -> Complex {
    Complex { re: value.re.negate(), im: value.im.negate() }
}

fn is_bounded(value: &Complex) -> bool {
    value.re.is_bounded() && value.im.is_bounded()
}

impl Jet {
    /// What does not depend on a side.
    pub(super) fn constant(value: Complex) -> Jet {
        Jet { middle: value.clone(), all: value, slopes: Vec::new() }
    }

    /// A real number.
    pub(super) fn real(value: Enclosure) -> Jet {
        Jet::constant(Complex::real(value))
    }

    /// From its value in the middle, those on the box, and its derivatives.
    pub(super) fn new([middle, all]: [Complex; 2], slopes: Vec<Complex>) -> Jet {
        Jet { middle, all, slopes }
    }

    /// The k-th side itself.
    pub(super) fn side(middle: Enclosure, all: Enclosure, k: usize) -> Jet {
        let slope = |i| Complex::real(Enclosure::from_integer(i64::from(i == k), PRECISION));
        Jet { middle: Complex::real(middle), all: Complex::real(all), slopes: (0..=k).map(slope).collect() }
    }

    /// Its values on the box.
    pub(super) fn all(&self) -> &Complex {
        &self.all
    }

    /// Whether its values on the box have a bound.
    pub(super) fn is_bounded(&self) -> bool {
        is_bounded(&self.all)
    }

    /// |z| on the box.
    pub(super) fn norm(&self) -> Enclosure {
        self.all.norm()
    }

    /// Each part by itself.
    fn each(&self, of: impl Fn(&Complex) -> Complex) -> Jet {
        Jet { middle: of(&self.middle), all: of(&self.all), slopes: self.slopes.iter().map(of).collect() }
    }

    fn with(&self, other: &Jet, of: impl Fn(&Complex, &Complex) -> Complex) -> Jet {
        let none = zero();
        let count = self.slopes.len().max(other.slopes.len());
        let slope = |k: usize| of(self.slopes.get(k).unwrap_or(&none), other.slopes.get(k).unwrap_or(&none));
        Jet {
            middle: of(&self.middle, &other.middle),
            all: of(&self.all, &other.all),
            slopes: (0..count).map(slope).collect(),
        }
    }

    /// z + w.
    pub(super) fn add(&self, other: &Jet) -> Jet {
        self.with(other, Complex::add)
    }

    /// z - w.
    pub(super) fn sub(&self, other: &Jet) -> Jet {
        self.with(other, Complex::sub)
    }

    /// -z.
    pub(super) fn negate(&self) -> Jet {
        self.each(negated)
    }

    /// The product with a real number that depends on nothing.
    pub(super) fn scaled(&self, factor: &Enclosure) -> Jet {
        self.each(|value| value.scaled(factor))
    }

    /// The product with a number that depends on nothing.
    pub(super) fn times(&self, factor: &Complex) -> Jet {
        self.each(|value| value.mul(factor))
    }

    /// With a number of this rectangle added, which one does not depend on the sides.
    pub(super) fn within(&self, rest: &Complex) -> Jet {
        Jet { middle: self.middle.add(rest), all: self.all.add(rest), slopes: self.slopes.clone() }
    }

    /// `a w + z b` of the derivatives a of z and b of w.
    fn of_product(&self, other: &Jet) -> Vec<Complex> {
        let count = self.slopes.len().max(other.slopes.len());
        let slope = |k: usize| match (self.slopes.get(k), other.slopes.get(k)) {
            (Some(a), Some(b)) => a.mul(&other.all).add(&self.all.mul(b)),
            (Some(a), None) => a.mul(&other.all),
            (None, Some(b)) => self.all.mul(b),
            (None, None) => zero(),
        };
        (0..count).map(slope).collect()
    }

    /// z w.
    pub(super) fn mul(&self, other: &Jet, offsets: &Offsets) -> Jet {
        let slopes = self.of_product(other);
        let all = self.all.mul(&other.all);
        let middle = if slopes.is_empty() { all.clone() } else { self.middle.mul(&other.middle) };
        offsets.narrowed(Jet { middle, all, slopes })
    }

    /// 1/z; undefined if z may be 0.
    pub(super) fn recip(&self, offsets: &Offsets) -> Jet {
        let one = Complex::real(Enclosure::one(PRECISION));
        let all = one.div(&self.all);
        let middle = if self.slopes.is_empty() { all.clone() } else { one.div(&self.middle) };
        let square = negated(&all.mul(&all));
        let slopes = self.slopes.iter().map(|slope| slope.mul(&square)).collect();
        offsets.narrowed(Jet { middle, all, slopes })
    }

    /// z/w; undefined if w may be 0.
    pub(super) fn div(&self, other: &Jet, offsets: &Offsets) -> Jet {
        if self.slopes.is_empty() && other.slopes.is_empty() {
            return Jet::constant(self.all.div(&other.all));
        }
        self.mul(&other.recip(offsets), offsets)
    }
}

impl Offsets {
    /// One more side, a real number between these ends; no side where they are one.
    pub(super) fn with_side(&mut self, [low, high]: &[Rational; 2]) -> Jet {
        let all = Enclosure::between(low, high, PRECISION);
        if low == high {
            return Jet::real(all);
        }
        let middle = Enclosure::from_rational(&(Rational::from(low + high) / 2), PRECISION);
        self.0.push(&all - &middle);
        Jet::side(middle, all, self.0.len() - 1)
    }

    /// What is on the box, by the mean value theorem for the real and the imaginary part, too.
    pub(super) fn narrowed(&self, jet: Jet) -> Jet {
        let Jet { middle, all, slopes } = jet;
        // Where a formula has a corner there is no derivative.
        if slopes.is_empty() || !slopes.iter().all(is_bounded) || !is_bounded(&middle) {
            return Jet { middle, all, slopes };
        }
        let by_mean =
            slopes.iter().zip(&self.0).fold(middle.clone(), |sum, (slope, offset)| sum.add(&slope.scaled(offset)));
        let all = match is_bounded(&all) {
            true => Complex { re: all.re.intersect(&by_mean.re), im: all.im.intersect(&by_mean.im) },
            false => by_mean,
        };
        Jet { middle, all, slopes }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn side(low: f64, high: f64, k: usize) -> (Jet, Enclosure) {
        let (middle, all) =
            (Enclosure::exactly((low + high) / 2.0), Enclosure::exactly(low).hull(&Enclosure::exactly(high)));
        (Jet::side(middle.clone(), all.clone(), k), all - middle)
    }

    /// x (1 - x) and x/(x + i y) on a box: they contain what the points have, and are closer than the values of the operations alone.
    #[test]
    fn the_values_on_a_box_are_contained_closely() {
        let ((x, of_x), (y, of_y)) = (side(0.4, 0.6, 0), side(2.0, 2.25, 1));
        let offsets = Offsets(vec![of_x, of_y]);
        let one = Jet::real(Enclosure::one(PRECISION));
        let product = x.mul(&one.sub(&x), &offsets);
        let turned = y.times(&Complex { re: Enclosure::zero(PRECISION), im: Enclosure::one(PRECISION) });
        let ratio = x.div(&x.add(&turned), &offsets);
        for i in 0..=10 {
            for k in 0..=10 {
                let (x, y) = (0.4 + 0.02 * f64::from(i), 2.0 + 0.025 * f64::from(k));
                let has = |found: &Enclosure, value: f64| {
                    assert!(
                        found.lower_f64() <= value + 1e-12 && value - 1e-12 <= found.upper_f64(),
                        "{value} {found:?}"
                    );
                };
                has(&product.all().re, x * (1.0 - x));
                let square = x * x + y * y;
                has(&ratio.all().re, x * x / square);
                has(&ratio.all().im, -x * y / square);
            }
        }
        let width = |found: &Enclosure| found.upper_f64() - found.lower_f64();
        // By the operations alone it is 0.2, and 0.177; in truth 0.01 and 0.103.
        assert!(width(&product.all().re) < 0.05, "{product:?}");
        assert!(width(&ratio.all().im) < 0.15, "{}", width(&ratio.all().im));
    }

    #[test]
    fn what_has_no_derivative_or_is_0_is_as_without() {
        let (x, offset) = side(-1.0, 1.0, 0);
        let offsets = Offsets(vec![offset]);
        assert!(!is_bounded(x.recip(&offsets).all()));
        let corner = Jet::new(
            [Complex::real(Enclosure::zero(PRECISION)), x.all().clone()],
            vec![Complex::real(Enclosure::undefined(PRECISION))],
        );
        let product = corner.mul(&Jet::real(Enclosure::exactly(2.0)), &offsets);
        assert_eq!([product.all().re.lower_f64(), product.all().re.upper_f64()], [-2.0, 2.0]);
    }
}
