//! Trials (derivation, 14.4).

use crate::linear::{Harmonics, Loop, PRECISION};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::plant::{CurveTerm, Plant};
use sigmastar_lang::spec::{Interval, OrbitCurve, Oscillators, TrigonometricVector, Wave};
use sigmastar_theory::transfer::Complex;

/// `(xhat, ehat, uhat)` of each member, for given oscillators.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Trial {
    /// At 0, ..., N, or at another set H.
    pub oscillators: Oscillators,
    /// Whether it is the trial of every larger number, too: of the first N alone.
    pub or_more: bool,
    /// The terms of the curves; that of the nominal member is the first. No ehat has a mean or harmonics of the oscillators.
    pub terms: Vec<CurveTerm>,
    /// Where the parameters lie of which intervals are known.
    pub parameters: Vec<Interval>,
    /// Where b lies, if that is an interval.
    pub gain: Option<Interval>,
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

/// The harmonics of a wave, from k = 0 on.
pub(super) fn of_wave(wave: &Wave) -> Vec<Complex> {
    let mean = Complex::real(Enclosure::from_rational(&wave.mean, PRECISION));
    std::iter::once(mean).chain((1..=wave.harmonics.len()).map(|k| harmonic(wave, k))).collect()
}

impl Trial {
    /// Where p, and then b, lie.
    pub(super) fn intervals(&self) -> impl Iterator<Item = &Interval> {
        self.parameters.iter().chain(&self.gain)
    }

    /// Whether no ehat has a mean or harmonics that an oscillator meets; for every larger number no harmonics at all, and uhat only those that all
    /// of them meet. The terms begin with that of the nominal member, and have as many powers as something is an interval.
    #[must_use]
    pub fn is_admissible(&self) -> bool {
        let first = self.oscillators.n_o().is_some();
        let count = self.intervals().count();
        let is_0 = |pair: &[Rational; 2]| pair.iter().all(|part| *part == 0);
        let of_term = |CurveTerm { powers, error: Wave { mean, harmonics }, control, .. }: &CurveTerm| {
            let mut of_error = (1..).zip(harmonics).filter(|(k, _)| self.or_more || self.oscillators.meets(*k));
            let mut of_control = (1..).zip(&control.harmonics).filter(|(k, _)| !self.oscillators.meets(*k));
            let error_is_met = *mean == 0 && of_error.all(|(_, pair)| is_0(pair));
            let control_is_met = !self.or_more || first && of_control.all(|(_, pair)| is_0(pair));
            error_is_met && control_is_met && powers.len() == count
        };
        self.terms.first().is_some_and(CurveTerm::is_nominal) && self.terms.iter().all(of_term)
    }

    /// The largest `|delta^alpha|` of these powers.
    pub(super) fn scale(&self, powers: &[u32]) -> Enclosure {
        let all = powers.iter().zip(self.intervals()).fold(Rational::from(1), |product, (power, interval)| {
            (0..*power).fold(product, |product, _| product * interval.reach())
        });
        Enclosure::from_rational(&all, PRECISION)
    }

    /// The curve of the states of the nominal member; without components where there is no term.
    #[must_use]
    pub fn states(&self) -> TrigonometricVector {
        let nominal = self.terms.first().map(|term| term.states.clone());
        nominal.unwrap_or_else(|| TrigonometricVector::constant(Vec::new()))
    }

    /// Waves of the terms, each times the largest `|delta^alpha|`.
    pub(super) fn scaled(&self, of: impl Fn(&CurveTerm) -> &Wave) -> Vec<Harmonics> {
        let scaled = |term: &CurveTerm| {
            let scale = self.scale(&term.powers);
            of_wave(of(term)).iter().map(|wave| vec![wave.scaled(&scale)]).collect()
        };
        self.terms.iter().map(scaled).collect()
    }

    /// kappa: over all terms the sum of `sup|delta^alpha|` times twice the sum of `|uhat_k + (sigma + i y_k (i om_k + sigma)) ehat_k|` over the k <= K that are not in H;
    /// at samples of `|(e^{i om_k h} - 1)/(i om_k h) uhat_k + kappa_k ehat_k|`, for there uhat is what is put out in the mean.
    #[must_use]
    pub fn mismatch(&self, own: &Loop) -> Enclosure {
        let zero = || Enclosure::zero(PRECISION);
        let of_term = |CurveTerm { powers, error, control, .. }: &CurveTerm| {
            let degree = error.harmonics.len().max(control.harmonics.len());
            let of = |k: usize| {
                let answer = own.beyond(&self.oscillators, k).turn;
                own.put_out(k, harmonic(control, k)).add(&answer.mul(&harmonic(error, k))).norm() * 2
            };
            let beyond = (1..=degree).filter(|k| !self.oscillators.meets(*k));
            let all = beyond.fold(zero(), |sum, k| sum + of(k));
            all * self.scale(powers)
        };
        self.terms.iter().fold(zero(), |sum, term| sum + of_term(term))
    }

    /// The plant about the curves of its members.
    #[must_use]
    pub fn about(&self, plant: &Plant) -> Plant {
        plant.about(&self.terms, self.gain.clone())
    }

    /// The curve of the nominal states, which all members have in [`Trial::about`].
    #[must_use]
    pub fn centre(&self) -> OrbitCurve {
        let centre = self.states();
        let still = TrigonometricVector::constant(vec![Rational::new(); centre.mean.len()]);
        OrbitCurve { sensitivities: vec![still; self.intervals().count()], centre }
    }
}
