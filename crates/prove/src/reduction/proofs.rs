//! What is proved along an orbit, and what proves bounds there.

use super::entries::{Needed, prove_all};
use super::refusal::PlantRefusal;
use super::sampling::{Sampling, float_matrix};
use super::specification::specification;
use crate::certify::Alternatives;
use crate::search::{FloatModel, SharpProposal};
use rug::Rational;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::model::{Constant, Lyapunov};
use sigmastar_lang::spec::{
    OfPlant, OrbitCurve, PeriodicMatrix, ProvedForcing, ProvedOrbit, ProvedValues, Specification,
};
use sigmastar_plants::bounds::{Engine, FloatCurve, FloatSuprema, Region};
use sigmastar_plants::orbit::{Coordinates, OrbitProof, SecondTriple, prove_forcing, prove_orbit};
use sigmastar_theory::data::Data;
use sigmastar_theory::transfer::TradeOff;

/// Bits at which the numbers of a search are enclosed before they are rounded to doubles.
pub(super) const PRECISION: u32 = 64;

/// A specification whose data were proved from a plant's formulas, and where the search for its gain may start.
pub struct Reduced {
    /// The specification.
    pub spec: Specification,
    /// Free numbers for it, in floating point.
    pub proposal: SharpProposal,
    /// What else was looked at.
    pub alternatives: Alternatives,
}

/// The transfer constants that a claim will use: without a matched base frequency those of the closed form may be so much larger
/// that no gain is found with them.
pub(super) fn trade_off(data: &Data<'_>) -> TradeOff {
    if data.spec.internal_model.matched { TradeOff::matched(data) } else { TradeOff::curve(data) }
}

/// The orbit and the harmonics of q, proved in some coordinates; a P of existence, where there is one.
pub(super) struct Along {
    pub(super) coordinates: Coordinates,
    pub(super) orbit: OrbitProof,
    pub(super) forcing: ProvedForcing,
    pub(super) existence: Option<(PeriodicMatrix, SecondTriple)>,
}

pub(super) fn along(plant: &Plant, curve: &OrbitCurve, coordinates: &Coordinates) -> Result<Along, PlantRefusal> {
    let orbit = prove_orbit(plant, curve, coordinates).map_err(PlantRefusal::OrbitNotProved)?;
    let forcing = prove_forcing(plant, coordinates, &orbit).map_err(PlantRefusal::OrbitNotProved)?;
    Ok(Along { coordinates: coordinates.clone(), orbit, forcing, existence: None })
}

impl Along {
    /// The specification with these values.
    pub(super) fn specification(&self, plant: &Plant, values: ProvedValues) -> Result<Specification, PlantRefusal> {
        let OrbitProof { orbit, defect, tube, radius, alpha, p_low, p_up } = &self.orbit;
        let of_plant = OfPlant {
            parameters: plant.parameters.clone(),
            coordinates: self.coordinates.l.clone(),
            orbit: ProvedOrbit {
                approximation: orbit.clone(),
                defect: defect.clone(),
                tube: tube.clone(),
                radius: radius.clone(),
            },
            triple: Lyapunov {
                p_low: Constant::rational(p_low),
                p_up: Constant::rational(p_up),
                alpha: Constant::rational(alpha),
            },
            matrix: self.coordinates.p.clone(),
            existence: self.existence.as_ref().map(|(matrix, SecondTriple { alpha, p_low, p_up })| {
                let [p_low, p_up, alpha] = [p_low, p_up, alpha].map(Constant::rational);
                Box::new((Lyapunov { p_low, p_up, alpha }, matrix.clone()))
            }),
            forcing: self.forcing.clone(),
            domain: plant.domain.clone(),
            ball: plant.ball.clone(),
        };
        specification(plant, of_plant, values)
    }

    /// The P of existence, where there is one.
    pub(super) fn second(&self) -> Option<&PeriodicMatrix> {
        self.existence.as_ref().map(|(matrix, _)| matrix)
    }

    /// What samples the bounds.
    pub(super) fn suprema(&self, sampling: &Sampling<'_>) -> FloatSuprema {
        sampling.suprema(&float_matrix(&self.coordinates.l), [Some(&self.coordinates.p), self.second()])
    }

    pub(super) fn engine(&self, plant: &Plant) -> Result<Engine, PlantRefusal> {
        let orbit = (&self.orbit.orbit, &self.orbit.radius);
        engine_around(plant, &self.coordinates, orbit, self.second().cloned())
    }
}

fn engine_around(
    plant: &Plant,
    Coordinates { l, p, .. }: &Coordinates,
    (orbit, radius): (&OrbitCurve, &Rational),
    existence: Option<PeriodicMatrix>,
) -> Result<Engine, PlantRefusal> {
    let region = Region::new(l.clone(), orbit.clone(), radius.clone());
    let engine = region.and_then(|region| Engine::new(plant, region, Some(p.clone()), existence));
    engine.map_err(|_| PlantRefusal::Coordinates)
}

/// What decides bounds of a plant around its proved orbit, and what samples them.
///
/// # Errors
/// Data that are not of this plant.
pub fn bounds_around(plant: &Plant, of_plant: &OfPlant) -> Result<(Engine, FloatSuprema), PlantRefusal> {
    let OfPlant { coordinates, orbit, matrix, existence, .. } = of_plant;
    let second = existence.as_ref().map(|second| &second.1);
    let coordinates = Coordinates { l: coordinates.clone(), p: matrix.clone(), rate: f64::NAN };
    let engine = engine_around(plant, &coordinates, (&orbit.approximation, &orbit.radius), second.cloned())?;
    let rows = coordinates.l.iter().map(|row| row.iter().map(Rational::to_f64).collect()).collect();
    let samples = FloatSuprema::new(plant, FloatCurve::from(&orbit.approximation), rows, [Some(matrix), second]);
    Ok((engine, samples))
}

/// What proves bounds of a plant at arguments.
pub(super) struct Proofs<'a> {
    pub(super) plant: &'a Plant,
    pub(super) along: &'a Along,
    pub(super) engine: Engine,
    pub(super) suprema: FloatSuprema,
}

impl<'a> Proofs<'a> {
    pub(super) fn new(along: &'a Along, sampling: &'a Sampling<'_>) -> Result<Proofs<'a>, PlantRefusal> {
        let plant = sampling.plant;
        Ok(Proofs { plant, along, engine: along.engine(plant)?, suprema: along.suprema(sampling) })
    }

    pub(super) fn states(&self) -> usize {
        self.plant.states()
    }

    /// Whether existence has a P of its own.
    pub(super) fn has_second(&self) -> bool {
        self.along.second().is_some()
    }

    /// The specification with the values that are needed, each proved, and as a model; `joint` is proved.
    pub(super) fn with_needed(
        &self,
        needed: &Needed,
        joint: impl FnOnce(ProvedValues) -> ProvedValues,
    ) -> Result<(FloatModel, Specification), PlantRefusal> {
        let [x, e] = needed.largest();
        self.engine.smooth(&x, &e)?;
        let values = prove_all(&self.engine, &self.suprema, needed, &self.plant.internal_model.mu)?;
        let spec = self.along.specification(self.plant, joint(values))?;
        let data = Data::new(&spec, PRECISION);
        Ok((FloatModel::new(&data, trade_off(&data)), spec))
    }
}
