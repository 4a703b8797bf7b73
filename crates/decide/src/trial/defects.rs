//! Trials and their defects (derivation, 14.4).

use crate::linear::{Loop, PRECISION};
use crate::orbit::{Around, OrbitNotProved, rests};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{ProvedForcing, TrigonometricVector, Wave};
use sigmastar_theory::evidence::{Coordinates, OrbitProof};
use sigmastar_theory::transfer::Complex;

/// `(xhat, ehat, qhat)` for a number of oscillators.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Trial {
    /// N.
    pub n_o: u64,
    /// Whether it is the trial of every larger number, too.
    pub or_more: bool,
    /// xhat, in the plant's own coordinates.
    pub states: TrigonometricVector,
    /// ehat, without a mean and harmonics up to N.
    pub error: Wave,
    /// qhat.
    pub forcing: Wave,
}

/// Harmonic k >= 1 of a wave, that of `e^{i k Om t}`.
fn harmonic(wave: &Wave, k: usize) -> Complex {
    let exact = |value: &Rational| Enclosure::from_rational(value, PRECISION);
    let part = wave.harmonics.get(k - 1);
    part.map_or_else(
        || Complex::real(Enclosure::zero(PRECISION)),
        |[cos, sin]| Complex { re: exact(cos) / 2, im: exact(sin) / -2 },
    )
}

impl Trial {
    /// N as an index.
    pub(super) fn met(&self) -> usize {
        usize::try_from(self.n_o).unwrap_or(usize::MAX)
    }

    /// Whether ehat has neither a mean nor harmonics that an oscillator meets; for every larger number no harmonics at all, and qhat only those that all
    /// of them meet.
    #[must_use]
    pub fn is_admissible(&self) -> bool {
        let Wave { mean, harmonics } = &self.error;
        let met = if self.or_more { usize::MAX } else { self.met() };
        let mut beyond = self.forcing.harmonics.iter().skip(self.met()).flatten();
        let forcing_is_met = !self.or_more || beyond.all(|part| *part == 0);
        *mean == 0 && harmonics.iter().take(met).flatten().all(|part| *part == 0) && forcing_is_met
    }

    /// K.
    pub(super) fn degree(&self) -> usize {
        self.error.harmonics.len().max(self.forcing.harmonics.len())
    }

    /// The harmonics of ehat, from k = 0 on.
    pub(super) fn of_error(&self) -> Vec<Complex> {
        let zero = Complex::real(Enclosure::zero(PRECISION));
        std::iter::once(zero).chain((1..=self.degree()).map(|k| harmonic(&self.error, k))).collect()
    }

    /// Those of qhat.
    pub(super) fn of_forcing(&self) -> Vec<Complex> {
        let mean = Complex::real(Enclosure::from_rational(&self.forcing.mean, PRECISION));
        std::iter::once(mean).chain((1..=self.degree()).map(|k| harmonic(&self.forcing, k))).collect()
    }

    /// kappa: twice the sum of `|qhat_k - (i om_k + sigma)(1 + i y_k) ehat_k|` over N < k <= K.
    #[must_use]
    pub fn mismatch(&self, own: &Loop) -> Enclosure {
        let zero = Enclosure::zero(PRECISION);
        let one = || Enclosure::one(PRECISION);
        let of = |k: usize| {
            let y = &own.mu / &own.fundamental * own.poles(self.met(), k, 1);
            let frequency = &own.fundamental * k as i64;
            let answer = Complex { re: own.sigma.clone(), im: frequency }.mul(&Complex { re: one(), im: y });
            harmonic(&self.forcing, k).sub(&answer.mul(&harmonic(&self.error, k))).norm() * 2
        };
        (self.met().saturating_add(1)..=self.degree()).fold(zero, |sum, k| sum + of(k))
    }

    /// Upper bounds of `|f(t,xhat,ehat) - xhat'|` in the norm of `L^-1 x`, of `|q(t,xhat,ehat) - qhat|` and of the derivative of that difference over all t;
    /// kappa is not in the second. Cells of time are halved while they are not at most `enough`.
    ///
    /// # Errors
    /// The formulas are not seen to be smooth along the trial, or shapes do not fit.
    pub fn defects(
        &self,
        plant: &Plant,
        coordinates: &Coordinates,
        enough: [f64; 3],
    ) -> Result<[Enclosure; 3], OrbitNotProved> {
        let moved = plant.with_error_moved(&self.error);
        let around = Around::new(&moved, &self.states.clone().into(), coordinates)?;
        let of_states = match plant.states() {
            0 => Enclosure::zero(PRECISION),
            _ => around.defect(enough[0])?,
        };
        let zero = Rational::new;
        // The curve itself is the one that q is followed along: nothing is around it.
        let on_curve = OrbitProof {
            orbit: self.states.clone().into(),
            defect: zero(),
            tube: zero(),
            radius: zero(),
            alpha: Rational::from(1),
            p_low: Rational::from(1),
            p_up: Rational::from(1),
        };
        let Wave { mean, harmonics } = self.forcing.clone();
        let forcing = ProvedForcing { mean, harmonics, sensitivities: Vec::new(), rest: zero(), rest_t: zero() };
        let [of_error, in_time] = rests(&around, &forcing, &on_curve, [enough[1], enough[2]])?;
        Ok([of_states, of_error, in_time])
    }
}
