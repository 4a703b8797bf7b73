//! Rectangular complex enclosures.

use sigmastar_exact::enclosure::Enclosure;

/// A rectangle of the complex plane proved to contain a number.
#[derive(Clone, Debug)]
pub struct Complex {
    /// The real part.
    pub re: Enclosure,
    /// The imaginary part.
    pub im: Enclosure,
}

impl Complex {
    /// A real number.
    #[must_use]
    pub fn real(re: Enclosure) -> Complex {
        let im = Enclosure::zero(re.precision());
        Complex { re, im }
    }

    /// z + w.
    #[must_use]
    pub fn add(&self, other: &Complex) -> Complex {
        Complex { re: &self.re + &other.re, im: &self.im + &other.im }
    }

    /// The product with a real number.
    #[must_use]
    pub fn scaled(&self, factor: &Enclosure) -> Complex {
        Complex { re: &self.re * factor, im: &self.im * factor }
    }

    /// |z|.
    #[must_use]
    pub fn norm(&self) -> Enclosure {
        self.norm_squared().sqrt()
    }

    /// z - w.
    #[must_use]
    pub fn sub(&self, other: &Complex) -> Complex {
        Complex { re: &self.re - &other.re, im: &self.im - &other.im }
    }

    /// z w.
    #[must_use]
    pub fn mul(&self, other: &Complex) -> Complex {
        Complex { re: &self.re * &other.re - &self.im * &other.im, im: &self.re * &other.im + &self.im * &other.re }
    }

    /// |z|^2.
    #[must_use]
    pub fn norm_squared(&self) -> Enclosure {
        self.re.sqr() + self.im.sqr()
    }

    /// z/w = z conj(w)/|w|^2; undefined if w may be 0.
    #[must_use]
    pub fn div(&self, other: &Complex) -> Complex {
        let norm = other.norm_squared();
        let conjugate = Complex { re: other.re.clone(), im: -&other.im };
        let product = self.mul(&conjugate);
        Complex { re: product.re / &norm, im: product.im / norm }
    }
}
