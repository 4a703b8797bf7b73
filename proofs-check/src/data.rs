//! The data of a specification, enclosed at one working precision (docs/mathematics.md, section 1).

use crate::interval::Interval;
use crate::spec::{Bound, Specification};
use rug::Rational;

/// The numbers of derivation, section 1, under their names there.
pub struct Data<'s> {
    pub spec: &'s Specification,
    pub precision: u32,
    pub period: Interval,
    pub p_low: Interval,
    pub p_up: Interval,
    pub alpha: Interval,
    pub mu: Interval,
    pub w: Interval,
    /// c = sqrt(P_up/P_low) >= 1.
    pub c: Interval,
    /// nu = mu/w.
    pub nu: Interval,
    pub n_0: Interval,
    pub n_1: Interval,
    pub n_bar: Interval,
}

impl<'s> Data<'s> {
    /// Encloses everything at `precision` bits.
    pub fn new(spec: &'s Specification, precision: u32) -> Data<'s> {
        let number = |constant: &crate::constant::Constant| constant.enclose(precision);
        let (p_low, p_up, mu, w) =
            (number(&spec.p_low), number(&spec.p_up), number(&spec.mu), number(&spec.base_frequency));
        Data {
            period: number(&spec.period),
            alpha: number(&spec.alpha),
            // P_low <= P_up was checked, so c >= 1 holds whatever the rounding.
            c: (&p_up / &p_low).sqrt().max(&Interval::int(1, precision)),
            nu: &mu / &w,
            n_0: spec.weights.weight(0, precision),
            n_1: spec.weights.weight(1, precision),
            n_bar: spec.weights.total(precision).sqrt(),
            p_low,
            p_up,
            mu,
            w,
            spec,
            precision,
        }
    }

    /// An exact number.
    pub fn number(&self, value: &Rational) -> Interval {
        Interval::rational(value, self.precision)
    }

    /// An integer.
    pub fn int(&self, value: i64) -> Interval {
        Interval::int(value, self.precision)
    }

    /// A fraction.
    pub fn ratio(&self, numerator: i64, denominator: i64) -> Interval {
        self.number(&Rational::from((numerator, denominator)))
    }

    /// The positive part of a bounding function at (X, E). A root mean square is at most the supremum, so b_q and b_qt serve
    /// for rms bounds that are not given, or are larger.
    pub fn bound(&self, which: Bound, x: &Interval, e: &Interval) -> Interval {
        let value = |which: Bound| {
            let expr = self.spec.bounds[which as usize].as_ref()?;
            Some(expr.enclose(x, e).max(&self.int(0)))
        };
        let supremum = match which {
            Bound::QRms => value(Bound::Q),
            Bound::QtRms => value(Bound::Qt),
            _ => None,
        };
        let own = value(which);
        match (own, supremum) {
            (Some(own), Some(supremum)) => own.min(&supremum),
            (own, supremum) => own.or(supremum).unwrap_or_else(|| Interval::undefined(self.precision)),
        }
    }
}
