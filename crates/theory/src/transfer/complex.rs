//! Rectangular complex enclosures: just what the proof of the poles needs.

use sigmastar_exact::enclosure::Enclosure;

/// A rectangle of the complex plane proved to contain a number.
#[derive(Clone, Debug)]
pub(super) struct Complex {
    pub(super) re: Enclosure,
    pub(super) im: Enclosure,
}

impl Complex {
    pub(super) fn sub(&self, other: &Complex) -> Complex {
        Complex { re: &self.re - &other.re, im: &self.im - &other.im }
    }

    pub(super) fn mul(&self, other: &Complex) -> Complex {
        Complex { re: &self.re * &other.re - &self.im * &other.im, im: &self.re * &other.im + &self.im * &other.re }
    }

    /// |z|^2.
    pub(super) fn norm_squared(&self) -> Enclosure {
        self.re.sqr() + self.im.sqr()
    }

    /// z/w = z conj(w)/|w|^2; undefined if w may be 0.
    pub(super) fn div(&self, other: &Complex) -> Complex {
        let norm = other.norm_squared();
        let conjugate = Complex { re: other.re.clone(), im: -&other.im };
        let product = self.mul(&conjugate);
        Complex { re: product.re / &norm, im: product.im / norm }
    }
}
