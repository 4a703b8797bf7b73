//! Complex numbers with enclosed parts.

use proofs_core::interval::Interval;

/// `re + i im`.
#[derive(Clone, Debug)]
pub struct Complex {
    /// The real part.
    pub re: Interval,
    /// The imaginary part.
    pub im: Interval,
}

impl Complex {
    /// A real number.
    pub fn real(re: Interval) -> Complex {
        let im = Interval::int(0, re.precision());
        Complex { re, im }
    }

    /// 0.
    pub fn zero(precision: u32) -> Complex {
        Complex::real(Interval::int(0, precision))
    }

    /// `re - i im`.
    pub fn conjugate(&self) -> Complex {
        Complex { re: self.re.clone(), im: -&self.im }
    }

    /// A real multiple.
    pub fn scaled(&self, factor: &Interval) -> Complex {
        Complex { re: &self.re * factor, im: &self.im * factor }
    }

    /// The square of the modulus.
    pub fn square(&self) -> Interval {
        self.re.sqr() + self.im.sqr()
    }

    /// Exactly 0.
    pub fn is_zero(&self) -> bool {
        self.re.is_zero() && self.im.is_zero()
    }
}
