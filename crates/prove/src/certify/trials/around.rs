//! A trial with everything that is evaluated around it (derivation, 14.4).

use rug::Rational;
use sigmastar_decide::bounds::{Engine, Region};
use sigmastar_decide::linear::{Loop, PRECISION, Start};
use sigmastar_decide::trial::{Concluded, Known, OfAllCounts, Trial};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_lang::plant::{CurveTerm, Plant};
use sigmastar_lang::spec::{Interval, OfPlant, Oscillators, ProvedCell, SampledLoop, Specification};
use sigmastar_matrix::inverse;
use sigmastar_propose::bounds::{FloatCurve, FloatSuprema};
use sigmastar_propose::orbit::FloatSeries;
use sigmastar_propose::trial::{Members, TrialLoop, sampled_defects};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::control::Reach;
use sigmastar_theory::derivation::initial_set::ClaimedSet;
use sigmastar_theory::derivation::sampled::SampledWitness;
use sigmastar_theory::derivation::sharp::SharpWitness;
use sigmastar_theory::input_gain::moves;

/// From where on all of them may be looked at once, each number before by itself; the share of q that they leave then.
const ONE_BY_ONE: usize = 12;
const LEFT: f64 = 1e-9;

/// Defects that are small enough, beside q, and the velocity of the states.
const SMALL: f64 = 1e-10;

/// By how much a defect may be above what is met of it.
const ROOM: f64 = 1.5;
const ROOM_OF_FAMILY: f64 = 2.0;

/// What harmonics that are left out have at most, as a share of the whole; of families, whose trials are polynomials in the parameters.
const SMALL_OF_ONE: f64 = 1e-15;
const SMALL_OF_FAMILY: f64 = 1e-6;

/// Digits of bounds.
pub(super) const SHORT: u32 = 4;

/// The claim that such bounds are added to.
pub(in crate::certify) struct Asked<'a> {
    pub(in crate::certify) plant: &'a Plant,
    pub(in crate::certify) spec: &'a Specification,
    pub(in crate::certify) sigma: &'a Rational,
    pub(in crate::certify) set: &'a ClaimedSet,
    /// What proves it.
    pub(in crate::certify) proof: ClaimProof<'a>,
    /// Oscillators that are looked at besides.
    pub(in crate::certify) besides: &'a [Oscillators],
}

/// What proves the claim.
pub(in crate::certify) struct ClaimProof<'a> {
    /// Its free numbers.
    pub(in crate::certify) witness: ClaimWitness<'a>,
    /// `x_per` and `e_per`.
    pub(in crate::certify) periodic: [Enclosure; 2],
    /// The numbers of the formulas.
    pub(in crate::certify) data: Data<'a>,
}

/// The free numbers of the claim.
pub(in crate::certify) enum ClaimWitness<'a> {
    /// In continuous time.
    Continuous {
        /// These.
        witness: &'a SharpWitness,
        /// kappa_0 and kappa_1.
        kappas: [Enclosure; 2],
    },
    /// At samples, without a delay.
    AtSamples {
        /// These.
        witness: &'a SampledWitness,
        /// The gain, N_s, K and Nb2.
        law: SampledLoop,
        /// The least one of an oscillator below half of the samples.
        weight: Enclosure,
    },
}

impl ClaimProof<'_> {
    /// D_x and D_e.
    pub(super) fn error_box(&self) -> [&Rational; 2] {
        match &self.witness {
            ClaimWitness::Continuous { witness, .. } => [&witness.d_x, &witness.d_e],
            ClaimWitness::AtSamples { witness, .. } => [&witness.d_x, &witness.d_e],
        }
    }

    /// How far solutions that begin at these distances from the periodic one are from it, by the function of the claim; the sum of the weights is that of a loop.
    pub(super) fn reach(&self, own: &Loop, distances: [&Enclosure; 3]) -> Reach<Enclosure> {
        let data = self.data.with_oscillators(&own.n_bar_squared);
        match &self.witness {
            ClaimWitness::Continuous { witness, .. } => witness.reach(&data, distances),
            ClaimWitness::AtSamples { witness, .. } => witness.reach(&data, distances),
        }
    }
}

impl Asked<'_> {
    /// N_s and the rest of the law, at samples.
    pub(super) fn law(&self) -> Option<&SampledLoop> {
        match &self.proof.witness {
            ClaimWitness::Continuous { .. } => None,
            ClaimWitness::AtSamples { law, .. } => Some(law),
        }
    }
}

/// The oscillators of one trial.
pub(super) struct Around<'a> {
    pub(super) asked: &'a Asked<'a>,
    pub(super) of_plant: &'a OfPlant,
    pub(super) cell: &'a ProvedCell,
    pub(super) oscillators: Oscillators,
    pub(super) or_more: bool,
}

/// A trial with everything that is evaluated around it.
pub(super) struct Prepared {
    pub(super) trial: Trial,
    pub(super) own: Loop,
    pub(super) period: Enclosure,
    pub(super) start: Start,
    pub(super) engine: Engine,
    pub(super) samples: FloatSuprema,
    /// d_x, d_q and d_t.
    pub(super) defects: [Rational; 3],
    /// The distances of the start from the periodic solution: of x, e, zeta.
    pub(super) distances: [f64; 3],
}

/// A bound in short numbers; none of what is no number.
pub(super) fn up(value: f64, digits: u32) -> Option<Rational> {
    if value.is_nan() {
        return None;
    }
    // Of 0 too a bound that is above it: what is proved is strict.
    round_f64(value.max(f64::MIN_POSITIVE), digits, Direction::Up)
}

impl Around<'_> {
    pub(super) fn known<'p>(&'p self, prepared: &'p Prepared) -> Known<'p> {
        let orbit = &self.cell.orbit;
        Known {
            own: &prepared.own,
            period: &prepared.period,
            orbit: &orbit.approximation,
            radius: &orbit.radius,
            of_all: match &self.asked.proof.witness {
                ClaimWitness::Continuous { kappas, .. } => OfAllCounts::Continuous(kappas),
                ClaimWitness::AtSamples { weight, .. } => OfAllCounts::AtSamples(weight),
            },
        }
    }

    /// From which number of oscillators on what they leave of q is as small as nothing, of a loop in which they leave no error; `None` where that is
    /// not soon.
    pub(super) fn met_by(&self) -> Option<u32> {
        let control = self.proposed()?.into_iter().next()?.control;
        let sizes =
            control.harmonics.iter().map(|[cos, sin]| libm::hypot(cos.to_f64(), sin.to_f64())).collect::<Vec<f64>>();
        let all = control.mean.to_f64().abs() + sizes.iter().sum::<f64>();
        let left = |met: usize| sizes.iter().skip(met).sum::<f64>();
        let enough = if self.is_family() { SMALL_OF_FAMILY } else { LEFT };
        (0..=ONE_BY_ONE).find(|met| left(*met) <= enough * all).map(|met| met as u32)
    }

    /// Where b lies, if that is an interval: outwards.
    fn gain(&self) -> Option<Interval> {
        let [low, high] = moves(self.asked.plant, PRECISION)?.map(|moved| Rational::from(1) - moved);
        Some(Interval { nominal: Rational::from(1), low, high })
    }

    /// Whether something is an interval.
    pub(super) fn is_family(&self) -> bool {
        self.asked.plant.is_family() || self.gain().is_some()
    }

    fn proposed(&self) -> Option<Vec<CurveTerm>> {
        let Asked { plant, spec, sigma, .. } = self.asked;
        let model = &spec.internal_model;
        let weight = |l: u32| model.weights.weight(u64::from(l), PRECISION).midpoint_f64();
        let weights: Vec<f64> = self.oscillators.all().map(weight).collect();
        let law = self.asked.law();
        let mu = law.map_or_else(|| model.mu.enclose(PRECISION).midpoint_f64(), |law| law.law.gain.to_f64());
        let gain = self.gain();
        let members = Members { plant, orbit: &self.cell.orbit.approximation, gain: gain.as_ref() };
        members.propose(|plant, gain| TrialLoop {
            plant,
            gain,
            sigma: sigma.to_f64(),
            mu,
            samples: law.map(|law| law.samples),
            oscillators: self.oscillators.clone(),
            weights: weights.clone(),
            resolved: if self.is_family() { SMALL_OF_FAMILY } else { SMALL_OF_ONE },
            or_more: self.or_more,
        })
    }

    /// The trial, and what is evaluated around it; `None` where there is none.
    pub(super) fn prepared(&self) -> Option<Prepared> {
        let Asked { plant, spec, sigma, set, .. } = self.asked;
        let model = &spec.internal_model;
        let oscillators = self.oscillators.clone();
        let parameters = plant.parameters.intervals().cloned().collect();
        let (terms, gain) = (self.proposed()?, self.gain());
        let trial = Trial { oscillators, or_more: self.or_more, terms, parameters, gain };
        let l = &self.of_plant.coordinates;
        let degree = trial.terms.iter().map(|term| term.error.harmonics.len()).max()?;
        let gain = spec.input_gain.as_ref().and_then(|gain| gain.factors(PRECISION));
        let last = degree.max(trial.oscillators.largest() as usize);
        let mut own = Loop::new(sigma, model, last, gain, inverse(l)?);
        if let Some(SampledLoop { samples, law, .. }) = self.asked.law() {
            own = own.at_samples(law, *samples, false);
        }
        let own = if self.or_more { own } else { own.with_oscillators(&trial.oscillators)? };
        let about = trial.about(plant);
        let defects = self.defects(&trial, &about, &own)?;
        let region = Region::new(l.clone(), trial.centre(), Rational::new()).ok()?;
        let rows = l.iter().map(|row| row.iter().map(Rational::to_f64).collect()).collect();
        let samples = FloatSuprema::new(&about, FloatCurve::from(&trial.states()), rows, [None; 2]);
        let engine = Engine::new(&about, region, None, None).ok()?;
        let exact = |value: &Rational| Enclosure::from_rational(value, PRECISION);
        let z0 = set.z0.as_ref().map(exact);
        let start = Start { x0: exact(&set.x0), e0: exact(&set.e0), z0, y0: Enclosure::zero(PRECISION) };
        let period = plant.period.nominal().enclose(PRECISION);
        let mut prepared = Prepared { trial, own, period, start, engine, samples, defects, distances: [0.0; 3] };
        let sizes = Concluded::sizes_of(&prepared.trial, &self.known(&prepared))?;
        let distances = prepared.start.distances(&prepared.own, sizes.each_ref());
        prepared.distances = distances.map(|size| size.upper_f64());
        Some(prepared)
    }

    /// d_x, d_q and d_t in short numbers; `about`: the plant around the trial.
    fn defects(&self, trial: &Trial, about: &Plant, own: &Loop) -> Option<[Rational; 3]> {
        let states = trial.states();
        let doubles = own.inverse.iter().map(|row| row.iter().map(Rational::to_f64).collect()).collect::<Vec<_>>();
        // What a trial leaves out is in the defects however small the parts of the period are.
        let room = if self.is_family() { ROOM_OF_FAMILY } else { ROOM };
        let met = sampled_defects(about, &FloatSeries::from(&states), &doubles).map(|defect| room * defect);
        let small = self.small(trial, own)?;
        // Beyond the range of doubles there is no bound to write.
        if !met.iter().chain(&small).all(|size| *size < f64::INFINITY) {
            return None;
        }
        let enough = [0, 1, 2].map(|i| small[i].max(met[i]));
        let found = trial.defects(self.asked.plant, &own.inverse, enough).ok()?;
        // What decides it again has as much room.
        let has_room = |i: usize| self.is_family() && (i < 2 || self.or_more);
        let known = |i: usize| if has_room(i) { found[i].upper_f64().max(enough[i]) } else { found[i].upper_f64() };
        let [d_x, d_q, d_t] = [0, 1, 2].map(|i| Enclosure::exactly(known(i)));
        let d_q = d_q + trial.mismatch(own) * &own.gain[1];
        let short = |defect: &Enclosure| up(defect.upper_f64(), SHORT);
        Some([short(&d_x)?, short(&d_q)?, short(&d_t)?])
    }

    /// Defects that are as small as nothing: beside the velocity of the states, q, and its slope.
    fn small(&self, trial: &Trial, own: &Loop) -> Option<[f64; 3]> {
        let states = trial.states();
        let control = &trial.terms.first()?.control;
        let q = control.parts().map(|part| part.to_f64().abs()).sum::<f64>();
        let frequency = own.fundamental.upper_f64();
        let speed = |(k, [a, b]): (usize, &[Vec<Rational>; 2])| {
            (k + 1) as f64 * frequency * a.iter().chain(b).map(|part| part.to_f64().abs()).sum::<f64>()
        };
        let velocity = states.harmonics.iter().enumerate().map(speed).sum::<f64>();
        let scale = own.inverse.iter().flatten().map(|entry| entry.to_f64().abs()).fold(0.0, f64::max);
        let share = if self.is_family() { SMALL_OF_FAMILY } else { SMALL };
        Some([share * velocity * scale, share * q, if self.or_more { share * q * frequency } else { f64::MAX }])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bound that is no number would be read as one that is as small as possible.
    #[test]
    fn bounds_are_written_above_what_they_bound() {
        assert_eq!([f64::NAN, f64::INFINITY].map(|value| up(value, SHORT)), [None, None]);
        assert!(up(0.0, SHORT).is_some_and(|bound| bound > 0));
        assert!(up(0.123456, SHORT).is_some_and(|bound| bound == Rational::from((1235, 10_000))));
    }
}
