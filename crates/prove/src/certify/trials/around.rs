//! A trial with everything that is evaluated around it (derivation, 14.4).

use rug::Rational;
use sigmastar_decide::bounds::{Engine, Region};
use sigmastar_decide::linear::{Loop, PRECISION, Start};
use sigmastar_decide::trial::{Concluded, Known, Trial};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{OfPlant, ProvedCell, Specification};
use sigmastar_matrix::inverse;
use sigmastar_propose::bounds::{FloatCurve, FloatSuprema};
use sigmastar_propose::orbit::FloatSeries;
use sigmastar_propose::trial::{ProposedTrial, TrialLoop};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::initial_set::ClaimedSet;
use sigmastar_theory::derivation::sharp::SharpWitness;
use sigmastar_theory::evidence::Coordinates;

/// From where on all of them may be looked at once, each number before by itself; the share of q that they leave then.
const ONE_BY_ONE: usize = 12;
const LEFT: f64 = 1e-9;

/// Defects that are small enough, beside q, and the velocity of the states.
const SMALL: f64 = 1e-10;

/// Digits of bounds.
pub(super) const SHORT: u32 = 4;

/// The claim that such bounds are added to.
pub(in crate::certify) struct Asked<'a> {
    pub(in crate::certify) plant: &'a Plant,
    pub(in crate::certify) spec: &'a Specification,
    pub(in crate::certify) sigma: &'a Rational,
    pub(in crate::certify) set: &'a ClaimedSet,
    /// What proves it.
    pub(in crate::certify) witness: &'a SharpWitness,
    /// Its `x_per` and `e_per`.
    pub(in crate::certify) periodic: [Enclosure; 2],
    /// The numbers of its formulas.
    pub(in crate::certify) data: Data<'a>,
    /// kappa_0 and kappa_1.
    pub(in crate::certify) kappas: [Enclosure; 2],
    /// Numbers of oscillators that are looked at besides.
    pub(in crate::certify) counts: &'a [u32],
}

/// One number of oscillators.
pub(super) struct Around<'a> {
    pub(super) asked: &'a Asked<'a>,
    pub(super) of_plant: &'a OfPlant,
    pub(super) cell: &'a ProvedCell,
    pub(super) n_o: u64,
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

/// A bound in short numbers.
pub(super) fn up(value: f64, digits: u32) -> Option<Rational> {
    // Of 0 too a bound that is above it: what is proved is strict.
    round_f64(value.max(f64::MIN_POSITIVE), digits, Direction::Up)
}

impl Around<'_> {
    pub(super) fn known<'p>(&'p self, prepared: &'p Prepared) -> Known<'p> {
        let orbit = &self.cell.orbit;
        Known {
            own: &prepared.own,
            period: &prepared.period,
            orbit: &orbit.approximation.centre,
            radius: &orbit.radius,
            kappas: &self.asked.kappas,
        }
    }

    /// From which number of oscillators on what they leave of q is as small as nothing, of a loop in which they leave no error; `None` where that is
    /// not soon.
    pub(super) fn met_by(&self) -> Option<u64> {
        let forcing = self.proposed()?.forcing;
        let sizes =
            forcing.harmonics.iter().map(|[cos, sin]| libm::hypot(cos.to_f64(), sin.to_f64())).collect::<Vec<f64>>();
        let all = forcing.mean.to_f64().abs() + sizes.iter().sum::<f64>();
        let left = |met: usize| sizes.iter().skip(met).sum::<f64>();
        (0..=ONE_BY_ONE).find(|met| left(*met) <= LEFT * all).map(|met| met as u64)
    }

    fn proposed(&self) -> Option<ProposedTrial> {
        let Asked { plant, spec, sigma, .. } = self.asked;
        let model = &spec.internal_model;
        let weight = |l: u64| model.weights.weight(l, PRECISION).midpoint_f64();
        let program = TrialLoop {
            plant,
            sigma: sigma.to_f64(),
            mu: model.mu.enclose(PRECISION).midpoint_f64(),
            weights: (0..=self.n_o).map(weight).collect(),
            or_more: self.or_more,
        };
        let orbit = &self.cell.orbit.approximation.centre;
        let doubles = |vector: &Vec<Rational>| vector.iter().map(Rational::to_f64).collect();
        let curve = FloatSeries {
            mean: doubles(&orbit.mean),
            harmonics: orbit.harmonics.iter().map(|pair| pair.each_ref().map(doubles)).collect(),
        };
        program.propose(&curve)
    }

    /// The trial, and what is evaluated around it; `None` where there is none.
    pub(super) fn prepared(&self) -> Option<Prepared> {
        let Asked { plant, spec, sigma, set, .. } = self.asked;
        let model = &spec.internal_model;
        let met = usize::try_from(self.n_o).ok()?;
        let ProposedTrial { states, error, forcing } = self.proposed()?;
        let trial = Trial { n_o: self.n_o, or_more: self.or_more, states, error, forcing };
        let l = &self.of_plant.coordinates;
        let lines = met.max(trial.error.harmonics.len());
        let own = Loop::new(sigma, model, lines, None, inverse(l)?);
        let own = if self.or_more { own } else { own.with_oscillators(met) };
        let coordinates = Coordinates { l: l.clone(), p: self.of_plant.matrix.clone() };
        let q = trial.forcing.parts().map(|part| part.to_f64().abs()).sum::<f64>();
        let frequency = own.fundamental.upper_f64();
        let speed = |(k, [a, b]): (usize, &[Vec<Rational>; 2])| {
            (k + 1) as f64 * frequency * a.iter().chain(b).map(|part| part.to_f64().abs()).sum::<f64>()
        };
        let velocity = trial.states.harmonics.iter().enumerate().map(speed).sum::<f64>();
        let scale = own.inverse.iter().flatten().map(|entry| entry.to_f64().abs()).fold(0.0, f64::max);
        let of_slope = if self.or_more { SMALL * q * frequency } else { f64::INFINITY };
        let enough = [SMALL * velocity * scale, SMALL * q, of_slope];
        let [d_x, d_q, d_t] = trial.defects(plant, &coordinates, enough).ok()?;
        let d_q = d_q + trial.mismatch(&own);
        let moved = plant.with_error_moved(&trial.error);
        let region = Region::new(l.clone(), trial.states.clone(), Rational::new()).ok()?;
        let rows = l.iter().map(|row| row.iter().map(Rational::to_f64).collect()).collect();
        let samples = FloatSuprema::new(&moved, FloatCurve::from(&trial.states), rows, [None; 2]);
        let engine = Engine::new(&moved, region, None, None).ok()?;
        let exact = |value: &Rational| Enclosure::from_rational(value, PRECISION);
        let start = Start { x0: exact(&set.x0), e0: exact(&set.e0), z0: set.z0.as_ref().map(exact) };
        let period = plant.period.nominal().enclose(PRECISION);
        let short = |defect: &Enclosure| up(defect.upper_f64(), SHORT);
        let defects = [short(&d_x)?, short(&d_q)?, short(&d_t)?];
        let mut prepared = Prepared { trial, own, period, start, engine, samples, defects, distances: [0.0; 3] };
        let sizes = Concluded::sizes_of(&prepared.trial, &self.known(&prepared))?;
        let distances = prepared.start.distances(&prepared.own, sizes.each_ref());
        prepared.distances = distances.map(|size| size.upper_f64());
        Some(prepared)
    }
}
