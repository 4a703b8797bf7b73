//! Trigonometric polynomials, whatever their coefficients are.

/// `mean + sum_k (a_k cos(k w t) + b_k sin(k w t))`, w = 2 pi / period.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Fourier<T> {
    /// The mean over a period.
    pub mean: T,
    /// (a_k, b_k) for k = 1, 2, ...; empty for a constant.
    pub harmonics: Vec<[T; 2]>,
}

impl<T> Fourier<T> {
    /// A constant.
    #[must_use]
    pub fn constant(mean: T) -> Fourier<T> {
        Fourier { mean, harmonics: Vec::new() }
    }

    /// The coefficients: the mean, and then those of each harmonic.
    pub fn parts(&self) -> impl Iterator<Item = &T> {
        std::iter::once(&self.mean).chain(self.harmonics.iter().flatten())
    }

    /// With a value of each coefficient in its place.
    #[must_use]
    pub fn map<U>(&self, of: impl Fn(&T) -> U) -> Fourier<U> {
        let harmonics = self.harmonics.iter().map(|pair| pair.each_ref().map(&of)).collect();
        Fourier { mean: of(&self.mean), harmonics }
    }

    /// With a value of each coefficient and that of another one in its place; `zero` is what the shorter one has in place of the
    /// harmonics that it lacks.
    #[must_use]
    pub fn with<U>(&self, other: &Fourier<T>, zero: &T, of: impl Fn(&T, &T) -> U) -> Fourier<U> {
        let pair = |k: usize| {
            let ([a, b], [c, d]) = (self.harmonic(k, zero), other.harmonic(k, zero));
            [of(a, c), of(b, d)]
        };
        let count = self.harmonics.len().max(other.harmonics.len());
        Fourier { mean: of(&self.mean, &other.mean), harmonics: (0..count).map(pair).collect() }
    }

    fn harmonic<'a>(&'a self, index: usize, zero: &'a T) -> [&'a T; 2] {
        self.harmonics.get(index).map_or([zero; 2], <[T; 2]>::each_ref)
    }
}
