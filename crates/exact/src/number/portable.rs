//! Elementary functions of doubles that give the same bits on every machine.
//!
//! The system's mathematical library may differ in the last place from one machine to the next, and a search amplifies
//! that into other free numbers. The search uses these instead (library `libm`), so that the same input gives the same
//! certificate everywhere. They decide nothing.

/// Elementary functions with the same result on every machine.
pub trait Portable {
    /// The exponential.
    fn portable_exp(self) -> f64;
    /// The natural logarithm.
    fn portable_ln(self) -> f64;
    /// The hyperbolic tangent.
    fn portable_tanh(self) -> f64;
    /// The power.
    fn portable_pow(self, exponent: f64) -> f64;
    /// The power with a whole exponent.
    fn portable_powi(self, exponent: i32) -> f64;
    /// `sqrt(self^2 + other^2)` without overflow.
    fn portable_hypot(self, other: f64) -> f64;
}

impl Portable for f64 {
    fn portable_exp(self) -> f64 {
        libm::exp(self)
    }

    fn portable_ln(self) -> f64 {
        libm::log(self)
    }

    fn portable_tanh(self) -> f64 {
        libm::tanh(self)
    }

    fn portable_pow(self, exponent: f64) -> f64 {
        libm::pow(self, exponent)
    }

    #[inline]
    fn portable_powi(self, exponent: i32) -> f64 {
        let (mut power, mut square, mut left) = (1.0, self, exponent.unsigned_abs());
        while left > 0 {
            if left % 2 == 1 {
                power *= square;
            }
            square *= square;
            left /= 2;
        }
        if exponent < 0 { 1.0 / power } else { power }
    }

    fn portable_hypot(self, other: f64) -> f64 {
        libm::hypot(self, other)
    }
}
