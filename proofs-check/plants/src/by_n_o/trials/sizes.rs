//! How large the curves of a trial are, over t and over all members (docs/mathematics.md, section 14.4): each is a sum over powers of delta, and the size
//! of a power is its largest one. What is at one time is added up there, and then the largest is taken over t; a root mean square of a sum is at most
//! the sum of those of its parts (Minkowski).

use super::answer::Answer;
use super::largest::{Part, largest};
use crate::by_n_o::linear::oscillators::Regulator;
use crate::read::Plant;
use crate::time::Wave;
use proofs_core::data::Data;
use proofs_core::interval::Interval;
use proofs_core::rules::by_n_o::curves::Curves;
use proofs_core::rules::by_n_o::oscillators::Oscillators;
use proofs_core::rules::by_n_o::trials::Trial;
use proofs_core::rules::by_n_o::tube::{Sizes, Slope};
use rug::Rational;
use std::iter::repeat;

/// The sizes of the curves are known to this share of themselves, in bits.
const SHARE: u32 = 30;

/// A trial of a plant.
pub struct Of<'t> {
    d: &'t Data<'t>,
    plant: &'t Plant,
    trial: &'t Trial,
    /// kappa.
    pub kappa: Interval,
    /// zhat.
    zeta: Interval,
}

impl<'t> Of<'t> {
    /// With these oscillators.
    pub fn new(
        d: &'t Data<'t>,
        plant: &'t Plant,
        regulator: &Regulator<'_>,
        (own, trial): (&Oscillators, &'t Trial),
    ) -> Of<'t> {
        let mut of = Of { d, plant, trial, kappa: d.int(0), zeta: d.int(0) };
        for curves in &trial.curves {
            let (answer, size) = (Answer::new(regulator, own, curves), of.size(&curves.powers));
            of.kappa = of.kappa + answer.kappa * &size;
            of.zeta = of.zeta + answer.zeta * size;
        }
        of
    }

    /// `sup|delta^alpha|`.
    fn size(&self, powers: &[u32]) -> Interval {
        let parameters = self.plant.family.iter().map(|span| {
            let apart = span.ends.each_ref().map(|end| Rational::from(end - &span.nominal).abs());
            let [low, high] = apart.each_ref().map(|end| self.d.number(end));
            low.max(&high)
        });
        let gain = self.d.gain.iter().map(|gain| (1 - &gain.low).max(&(&gain.high - 1)));
        let all = parameters.chain(gain).zip(powers);
        // Exponents are small.
        all.fold(self.d.int(1), |size, (most, exponent)| size * most.powi(*exponent as i32))
    }

    /// Those of all curves.
    pub fn sizes(&self, circle: [&Interval; 2]) -> Sizes {
        let of = |size: Interval| size.round(self.d.precision);
        let sum = |vector: &dyn Fn(&Curves) -> Vec<Wave>| {
            let part = |curves: &Curves| Part { factor: self.size(&curves.powers), vector: vector(curves) };
            of(largest(&self.trial.curves.iter().map(part).collect::<Vec<_>>(), circle, SHARE))
        };
        let rms = |curves: &Curves| {
            let parts = curves.e.harmonics.iter().flatten();
            let square = parts.fold(Rational::new(), |sum, part| sum + Rational::from(part.square_ref()));
            self.size(&curves.powers) * self.d.number(&(square / 2u32)).sqrt()
        };
        let x = match self.plant.states() {
            0 => self.d.int(0),
            _ => of(largest(&self.apart(), circle, SHARE)) + self.d.number(&self.plant.orbit.radius),
        };
        Sizes {
            x,
            e: sum(&|curves| vec![curves.e.clone()]),
            e_rms: self.trial.curves.iter().map(rms).fold(self.d.int(0), |sum, part| sum + part),
            u: sum(&|curves| vec![curves.u.clone()]) + &self.kappa,
            zeta: self.zeta.clone(),
            slope: self.slope(circle),
        }
    }

    /// Of uhat': that of each wave is Om times one with `k b_k` and `-k a_k`.
    fn slope(&self, circle: [&Interval; 2]) -> Slope {
        let turned = |wave: &Wave| {
            let of = |(k, [a, b]): (u32, &[Rational; 2])| [Rational::from(b * k), -Rational::from(a * k)];
            Wave { mean: Rational::new(), harmonics: (1_u32..).zip(&wave.harmonics).map(of).collect() }
        };
        let om = self.d.period.slowest();
        let part = |curves: &Curves| Part { factor: self.size(&curves.powers), vector: vec![turned(&curves.u)] };
        let parts: Vec<Part> = self.trial.curves.iter().map(part).collect();
        let square = |wave: &Wave| {
            let all = wave.harmonics.iter().flatten();
            all.fold(Rational::new(), |sum, part| sum + Rational::from(part.square_ref())) / 2u32
        };
        let rms = |Part { factor, vector }: &Part| {
            let squares = vector.iter().map(square).fold(Rational::new(), |sum, part| sum + part);
            factor * self.d.number(&squares).sqrt()
        };
        let rms = parts.iter().map(rms).fold(self.d.int(0), |sum, part| sum + part);
        Slope { sup: &om * largest(&parts, circle, SHARE).round(self.d.precision), rms: om * rms }
    }

    /// `L^-1 (xhat - xb)`, of each power of delta that one of both has.
    fn apart(&self) -> Vec<Part> {
        let curves = &self.trial.curves;
        let numbers = curves.first().map_or(0, |curves| curves.powers.len());
        // The orbit does not move with the gain, which is the last of the numbers.
        let long = |powers: &[u32]| -> Vec<u32> { powers.iter().copied().chain(repeat(0)).take(numbers).collect() };
        let of_orbit = [&[][..]].into_iter().chain(self.plant.powers.iter().map(Vec::as_slice)).map(long);
        let of_orbit: Vec<(Vec<u32>, &Vec<Wave>)> = of_orbit.zip(&self.plant.orbit.waves).collect();
        let mut all: Vec<&Vec<u32>> = curves.iter().map(|curves| &curves.powers).collect();
        for (powers, _) in &of_orbit {
            if !all.contains(&powers) {
                all.push(powers);
            }
        }
        let of = |powers: &Vec<u32>| {
            let x = curves.iter().find(|curves| curves.powers == *powers).map_or(&[][..], |curves| &curves.x);
            let orbit = of_orbit.iter().find(|(own, _)| own == powers).map_or(&[][..], |(_, waves)| waves);
            let waves: Vec<&Wave> = x.iter().chain(orbit).collect();
            let component = |row: &Vec<Rational>| {
                let (plus, minus) = (row.iter().cloned(), row.iter().map(|value| Rational::from(-value)));
                let factors: Vec<Rational> = plus.take(x.len()).chain(minus.take(orbit.len())).collect();
                combined(&factors, &waves)
            };
            let vector = self.plant.known.coordinates.inverse.iter().map(component).collect();
            Part { factor: self.size(powers), vector }
        };
        all.into_iter().map(of).collect()
    }
}

/// A sum of waves with these factors.
fn combined(factors: &[Rational], waves: &[&Wave]) -> Wave {
    let count = waves.iter().map(|wave| wave.harmonics.len()).max().unwrap_or(0);
    let sum = |of: &dyn Fn(&Wave) -> Rational| {
        factors.iter().zip(waves).fold(Rational::new(), |sum, (factor, wave)| sum + of(wave) * factor)
    };
    let harmonic = |k: usize| [0, 1].map(|part| sum(&|wave| wave.harmonic(k)[part].clone()));
    Wave { mean: sum(&|wave| wave.mean.clone()), harmonics: (1..=count).map(harmonic).collect() }
}
