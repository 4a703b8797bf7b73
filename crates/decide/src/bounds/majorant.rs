//! Bounding functions as polynomials in X and E.

use super::centred::{Centred, Frame};
use rug::Rational;
use sigmastar_exact::number::write_exact;
use sigmastar_lang::spec::Bound;

/// `sum coefficient X^x E^e`; the powers are all different.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Majorant {
    /// The terms.
    pub terms: Vec<Term>,
}

/// One term.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Term {
    /// The power of X.
    pub x: u32,
    /// The power of E.
    pub e: u32,
    /// The coefficient.
    pub coefficient: Rational,
}

impl Majorant {
    /// A constant.
    #[must_use]
    pub fn constant(value: Rational) -> Majorant {
        Majorant { terms: vec![Term { x: 0, e: 0, coefficient: value }] }
    }

    /// Whether the signs of the coefficients say that it is nondecreasing, and nonnegative where it bounds a norm; for a rate,
    /// nonincreasing.
    #[must_use]
    pub fn is_monotone(&self, kind: Bound) -> bool {
        self.terms.iter().all(|Term { x, e, coefficient }| match (*x == 0 && *e == 0, kind.is_rate()) {
            (true, _) => kind.is_signed() || *coefficient >= 0,
            (false, true) => *coefficient <= 0,
            (false, false) => *coefficient >= 0,
        })
    }

    /// `int_0^1 b(s X, s E) ds` times X (`direction` = [1, 0]) or E ([0, 1]): what a derivative with this bound adds up to
    /// along the segment from 0.
    #[must_use]
    pub fn along_segment(&self, direction: [u32; 2]) -> Majorant {
        let raised = |term: &Term| {
            let coefficient = Rational::from(&term.coefficient / (term.x + term.e + 1));
            Term { x: term.x + direction[0], e: term.e + direction[1], coefficient }
        };
        Majorant { terms: self.terms.iter().map(raised).collect() }
    }

    /// The sum, with the coefficients of equal powers added; terms of 0 are left out.
    #[must_use]
    pub fn plus(&self, other: &Majorant) -> Majorant {
        let mut terms: Vec<Term> = Vec::new();
        for term in self.terms.iter().chain(&other.terms) {
            match terms.iter_mut().find(|known| (known.x, known.e) == (term.x, term.e)) {
                Some(known) => known.coefficient += &term.coefficient,
                None => terms.push(term.clone()),
            }
        }
        terms.retain(|term| !term.coefficient.is_zero());
        terms.sort_by_key(|term| (term.x + term.e, term.e));
        Majorant { terms }
    }

    /// Whether each coefficient is at least that of the other one.
    #[must_use]
    pub fn is_above(&self, other: &Majorant) -> bool {
        let rest = self.plus(&other.map(|coefficient| Rational::from(-coefficient)));
        rest.terms.iter().all(|term| term.coefficient >= 0)
    }

    /// The majorant with these powers whose coefficients are the images of the coefficients of this one.
    #[must_use]
    pub fn map(&self, image: impl Fn(&Rational) -> Rational) -> Majorant {
        let moved = |term: &Term| Term { coefficient: image(&term.coefficient), ..*term };
        Majorant { terms: self.terms.iter().map(moved).collect() }
    }

    /// As an expression of X and E, exactly.
    #[must_use]
    pub fn text(&self) -> String {
        let power = |name: &str, exponent: u32| match exponent {
            0 => None,
            1 => Some(name.to_owned()),
            n => Some(format!("{name}^{n}")),
        };
        let mut text = String::new();
        for Term { x, e, coefficient } in &self.terms {
            let magnitude = Rational::from(coefficient.abs_ref());
            let number = (magnitude != 1 || (*x, *e) == (0, 0)).then(|| write_exact(&magnitude));
            let factors: Vec<String> = number.into_iter().chain(power("X", *x)).chain(power("E", *e)).collect();
            text += match (text.is_empty(), *coefficient < 0) {
                (true, false) => "",
                (true, true) => "-",
                (false, false) => " + ",
                (false, true) => " - ",
            };
            text += &factors.join("*");
        }
        if text.is_empty() { "0".to_owned() } else { text }
    }

    /// The value on a box.
    pub(super) fn on_box(&self, frame: &Frame, x: &Centred, e: &Centred) -> Centred {
        let start = frame.rational(&Rational::new());
        self.terms.iter().fold(start, |sum, Term { x: i, e: j, coefficient }| {
            let factors = [(x, *i), (e, *j)].into_iter().filter(|(_, power)| *power > 0);
            let term = factors.fold(frame.rational(coefficient), |product, (of, power)| {
                (0..power).fold(product, |product, _| frame.mul(&product, of))
            });
            frame.add(&sum, &term)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polynomial(terms: &[(u32, u32, i32, i32)]) -> Majorant {
        let term = |&(x, e, p, q): &(u32, u32, i32, i32)| Term { x, e, coefficient: Rational::from((p, q)) };
        Majorant { terms: terms.iter().map(term).collect() }
    }

    #[test]
    fn segments_sums_and_texts() {
        // b = 1/2 + 3 X + E X^2: the integral of b(s X, s E) X is X/2 + 3 X^2/2 + E X^3/4.
        let b = polynomial(&[(0, 0, 1, 2), (1, 0, 3, 1), (2, 1, 1, 1)]);
        assert_eq!(b.text(), "0.5 + 3*X + X^2*E");
        assert_eq!(b.along_segment([1, 0]).text(), "0.5*X + 1.5*X^2 + 0.25*X^3*E");
        assert_eq!(b.along_segment([0, 1]).text(), "0.5*E + 1.5*X*E + 0.25*X^2*E^2");
        let sum = b.plus(&polynomial(&[(1, 0, -3, 1), (0, 1, -1, 4)]));
        assert_eq!(sum.text(), "0.5 - 0.25*E + X^2*E");
        assert!(sum.is_above(&polynomial(&[(0, 1, -1, 3)])) && !b.is_above(&sum.plus(&b)));
        assert_eq!(Majorant::default().text(), "0");
        assert_eq!(polynomial(&[(0, 0, -1, 3)]).text(), "-1/3");
        assert_eq!(polynomial(&[(0, 0, 1, 1)]).text(), "1");
    }

    #[test]
    fn signs_say_what_is_monotone() {
        let falling = polynomial(&[(0, 0, 1, 2), (1, 0, -3, 1)]);
        assert!(falling.is_monotone(Bound::Rate) && !falling.is_monotone(Bound::Qx));
        let rising = polynomial(&[(0, 0, -1, 2), (1, 1, 3, 1)]);
        assert!(rising.is_monotone(Bound::QeMax) && !rising.is_monotone(Bound::Qe) && !rising.is_monotone(Bound::Rate));
    }
}
