//! Square, square root, powers, exponential, logarithm, hyperbolic tangent and cotangent.

use super::ends::square_root;
use super::{Enclosure, Ends};
use rug::float::{Round, Special};
use rug::ops::Pow;
use rug::{Float, Integer};

impl Enclosure {
    /// Applies a nondecreasing, everywhere defined function whose MPFR version is correctly rounded.
    pub(super) fn nondecreasing(&self, f: impl Fn(&Float, u32, Round) -> Float) -> Enclosure {
        let p = self.precision();
        if !self.is_defined() {
            return Enclosure::undefined(p);
        }
        let [lower, upper] = self.long();
        Enclosure::new(f(&lower, p, Round::Down), f(&upper, p, Round::Up))
    }

    /// The square; tighter than a product because both factors are the same number.
    #[must_use]
    pub fn sqr(&self) -> Enclosure {
        // A product of the magnitude with itself takes the same ends.
        let magnitude = self.abs();
        &magnitude * &magnitude
    }

    /// The square root; undefined if a part of the interval is negative.
    #[must_use]
    pub fn sqrt(&self) -> Enclosure {
        match &self.ends {
            _ if !self.is_nonnegative().is_true() => Enclosure::undefined(self.precision()),
            // The root of an end is one.
            Ends::Short([lower, upper]) => {
                Enclosure { ends: Ends::Short([square_root(*lower, Round::Down), square_root(*upper, Round::Up)]) }
            }
            Ends::Long(_) => self.nondecreasing(|x, p, round| Float::with_val_round(p, x.sqrt_ref(), round).0),
        }
    }

    /// The exponential.
    #[must_use]
    pub fn exp(&self) -> Enclosure {
        self.nondecreasing(|x, p, round| Float::with_val_round(p, x.exp_ref(), round).0)
    }

    /// The natural logarithm; undefined if a part of the interval is not positive.
    #[must_use]
    pub fn log(&self) -> Enclosure {
        if self.is_positive().is_true() {
            self.nondecreasing(|x, p, round| Float::with_val_round(p, x.ln_ref(), round).0)
        } else {
            Enclosure::undefined(self.precision())
        }
    }

    /// The hyperbolic tangent.
    #[must_use]
    pub fn tanh(&self) -> Enclosure {
        self.nondecreasing(|x, p, round| Float::with_val_round(p, x.tanh_ref(), round).0)
    }

    /// The hyperbolic cotangent, decreasing on each side of 0; undefined if 0 lies in the interval.
    #[must_use]
    pub fn coth(&self) -> Enclosure {
        let p = self.precision();
        if !self.is_defined() || self.contains_zero() {
            return Enclosure::undefined(p);
        }
        let [lower, upper] = self.long();
        Enclosure::new(
            Float::with_val_round(p, upper.coth_ref(), Round::Down).0,
            Float::with_val_round(p, lower.coth_ref(), Round::Up).0,
        )
    }

    // The integer power x^n by the sign of x = [x1, x2] and the parity of n:
    //
    //            n = 0     n > 0 even              n > 0 odd       n < 0
    // 0 <= x1    1         x1^n, x2^n              x1^n, x2^n      1 / x^|n|, undefined if 0 in x
    // x2 <= 0    1         x2^n, x1^n              x1^n, x2^n
    // mixed      1         0, max(|x1|, x2)^n      x1^n, x2^n
    /// The integer power; `x^0 = 1` for every x, and a negative power is undefined if 0 lies in the interval.
    #[must_use]
    pub fn pow_integer(&self, exponent: &Integer) -> Enclosure {
        let p = self.precision();
        if !self.is_defined() {
            return Enclosure::undefined(p);
        }
        if exponent.is_zero() {
            return Enclosure::one(p);
        }
        if *exponent < 0 {
            return self.pow_integer(&Integer::from(-exponent)).recip();
        }
        if *exponent == 2 {
            return self.sqr();
        }
        let base = if exponent.is_even() { self.abs() } else { self.clone() };
        base.nondecreasing(|x, p, round| Float::with_val_round(p, Pow::pow(x, exponent), round).0)
    }

    /// The real power `x^y = exp(y log x)` for x > 0, extended by `0^y = 0` for y > 0.
    ///
    /// Undefined if x may be negative, or if x may be 0 while y may be 0 or less. (For an exponent known to be an
    /// integer use [`Enclosure::pow_integer`], which also takes negative bases.)
    #[must_use]
    pub fn pow(&self, exponent: &Enclosure) -> Enclosure {
        let p = self.precision().max(exponent.precision());
        let defined = self.is_nonnegative().is_true()
            && exponent.is_defined()
            && (self.is_positive().is_true() || exponent.is_positive().is_true());
        if !defined {
            return Enclosure::undefined(p);
        }
        // x^y is monotone in x for fixed y and in y for fixed x, so its extremes over the box are at corners.
        let corner = |x: &Float, y: &Float, round: Round| {
            let value = Float::with_val_round(p, Pow::pow(x, y), round).0;
            // inf^0 and 1^inf stand for limits that need not exist: fall back to the trivial bound.
            let indefinite = value.is_nan() || (x.is_infinite() && y.is_zero()) || (*x == 1 && y.is_infinite());
            match (indefinite, round) {
                (false, _) => value,
                (true, Round::Down) => Float::new(p),
                (true, _) => Float::with_val(p, Special::Infinity),
            }
        };
        let ([x1, x2], [y1, y2]) = (self.long(), exponent.long());
        // With one exponent it rises in x above 0, and falls below.
        if exponent.is_exact() && !exponent.contains_zero() {
            let (least, largest) = if *y1 > 0 { (&x1, &x2) } else { (&x2, &x1) };
            return Enclosure::new(corner(least, &y1, Round::Down), corner(largest, &y1, Round::Up));
        }
        let corners = [(&*x1, &*y1), (&*x1, &*y2), (&*x2, &*y1), (&*x2, &*y2)];
        let extreme = |round: Round, choose: fn(Float, &Float) -> Float| {
            corners
                .iter()
                .skip(1)
                .fold(corner(corners[0].0, corners[0].1, round), |best, (x, y)| choose(best, &corner(x, y, round)))
        };
        Enclosure::new(extreme(Round::Down, Float::min), extreme(Round::Up, Float::max))
    }
}
