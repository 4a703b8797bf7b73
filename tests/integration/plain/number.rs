//! Real numbers to 400 bits, without enclosures: what the second computation counts in.

use rug::{Float, Rational};
use std::borrow::Borrow;
use std::ops::{Add, Div, Mul, Sub};

/// Working precision in bits.
pub const BITS: u32 = 400;

/// A real number to 400 bits.
#[derive(Clone, Debug, PartialEq, PartialOrd)]
pub struct R(pub Float);

macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl<T: Borrow<R>> $trait<T> for &R {
            type Output = R;
            fn $method(self, other: T) -> R {
                R(Float::with_val(BITS, $trait::$method(&self.0, &other.borrow().0)))
            }
        }
        impl<T: Borrow<R>> $trait<T> for R {
            type Output = R;
            fn $method(self, other: T) -> R {
                $trait::$method(&self, other)
            }
        }
    };
}
operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

pub fn r(value: f64) -> R {
    R(Float::with_val(BITS, value))
}

impl R {
    pub fn rational(value: &Rational) -> R {
        R(Float::with_val(BITS, value))
    }
    pub fn sqrt(&self) -> R {
        R(Float::with_val(BITS, self.0.sqrt_ref()))
    }
    pub fn sq(&self) -> R {
        self * self
    }
    /// NaN if either is, so that nothing undefined is believed.
    pub fn min(&self, other: &R) -> R {
        if self <= other {
            self.clone()
        } else if other < self {
            other.clone()
        } else {
            r(f64::NAN)
        }
    }
    pub fn max(&self, other: &R) -> R {
        if self >= other {
            self.clone()
        } else if other > self {
            other.clone()
        } else {
            r(f64::NAN)
        }
    }
}
