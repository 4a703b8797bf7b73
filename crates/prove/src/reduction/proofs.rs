//! What is proved along an orbit, and what proves bounds there.

use super::cells::Cell;
use super::coordinates::Start;
use super::entries::{Needed, prove_all};
use super::refusal::PlantRefusal;
use super::sampling::{Sampling, float_matrix};
use super::specification::specification;
use super::tube::TubeOfFamily;
use super::watch::Watch;
use crate::attempt::{prove_forcing, prove_orbits};
use crate::certify::Alternatives;
use rug::Rational;
use sigmastar_decide::bounds::{Engine, Region};
use sigmastar_exact::parallel;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::model::{Constant, Lyapunov};
use sigmastar_lang::spec::{
    OfPlant, OrbitCurve, Parameters, PeriodicMatrix, ProvedCell, ProvedForcing, ProvedOrbit, ProvedValues,
    Specification,
};
use sigmastar_propose::bounds::{FloatCurve, FloatSuprema};
use sigmastar_propose::search::{FloatModel, SharpProposal};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::paths::Path;
use sigmastar_theory::evidence::ProvedTriple;
use sigmastar_theory::evidence::{Coordinates, OrbitProof};
use sigmastar_theory::transfer::TradeOff;
use std::sync::atomic::AtomicUsize;

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
    /// Other data of the plant in the same coordinates, and where the search for their gains may start: those without joint metrics, where the gain
    /// rests on such, and those for larger gains. Of a larger gain than the smallest one they may say more.
    pub others: Vec<ProvedData>,
    /// The choice that it was proved of, for a family.
    pub(super) near: Option<Box<Near>>,
}

/// A choice for a family of plants, with a constant P.
#[derive(Clone)]
pub(super) struct Near {
    /// Its coordinates, as they were rounded.
    pub(super) coordinates: Coordinates,
    /// The free numbers, in these.
    pub(super) start: Start,
    /// The path of the matrix inequality that it rests on; norms without.
    pub(super) path: Option<Path>,
    /// The share up to which the tubes of the cells are narrow.
    pub(super) narrow: f64,
    /// The gain near it of the family itself, of the regulator in continuous time or of the one at samples.
    pub(super) gain: f64,
}

/// A specification whose data were proved, and where the search for its gain may start.
pub type ProvedData = (Specification, SharpProposal);

/// The transfer constants that a claim will use: without a matched base frequency those of the closed form may be so much larger
/// that no gain is found with them.
pub(super) fn trade_off(data: &Data<'_>) -> TradeOff {
    if data.spec.internal_model.matched { TradeOff::matched(data) } else { TradeOff::curve(data) }
}

/// The orbit and the harmonics of q, proved in some coordinates, in each cell of a family; a P of existence, where there is one.
pub(super) struct Along {
    pub(super) coordinates: Coordinates,
    pub(super) cells: Vec<ProvenCell>,
    pub(super) existence: Option<ProvedTriple>,
    /// Why the box of the parameters is cut, where it is.
    pub(super) why: Option<String>,
}

/// What was proved of the members in one cell. All cells have one alpha, p_low and p_up.
pub(super) struct ProvenCell {
    pub(super) parameters: Parameters,
    pub(super) orbit: OrbitProof,
    pub(super) forcing: ProvedForcing,
}

pub(super) fn along(cells: &[Cell], coordinates: &Coordinates) -> Result<Along, PlantRefusal> {
    let curves: Vec<_> = cells.iter().map(|Cell { plant, curve }| (plant, curve)).collect();
    let orbits = prove_orbits(&curves, coordinates).map_err(PlantRefusal::OrbitNotProved)?;
    let of_one = |(cell, orbit): &(&Cell, OrbitProof)| {
        let forcing = prove_forcing(&cell.plant, coordinates, orbit).map_err(PlantRefusal::OrbitNotProved)?;
        Ok(ProvenCell { parameters: cell.plant.parameters.clone(), orbit: orbit.clone(), forcing })
    };
    let cells: Vec<_> = cells.iter().zip(orbits).collect();
    let cells = parallel::map(&cells, of_one).into_iter().collect::<Result<_, PlantRefusal>>()?;
    Ok(Along { coordinates: coordinates.clone(), cells, existence: None, why: None })
}

impl Along {
    /// The specification with these values.
    pub(super) fn specification(&self, plant: &Plant, values: ProvedValues) -> Result<Specification, PlantRefusal> {
        let none = PlantRefusal::Coordinates;
        let OrbitProof { alpha, p_low, p_up, .. } = &self.cells.first().ok_or(none)?.orbit;
        let [p_low, p_up, alpha] = [p_low, p_up, alpha].map(Constant::rational);
        let cell = |ProvenCell { parameters, orbit, forcing }: &ProvenCell| {
            let OrbitProof { orbit, defect, tube, radius, .. } = orbit.clone();
            let orbit = ProvedOrbit { approximation: orbit, defect, tube, radius };
            ProvedCell { parameters: parameters.clone(), orbit, forcing: forcing.clone() }
        };
        let of_plant = OfPlant {
            parameters: plant.parameters.clone(),
            coordinates: self.coordinates.l.clone(),
            cells: self.cells.iter().map(cell).collect(),
            triple: Lyapunov { p_low, p_up, alpha },
            matrix: self.coordinates.p.clone(),
            existence: self.existence.as_ref().map(|triple| Box::new(triple.stated())),
            why_cut: self.why.clone(),
            domain: plant.domain.clone(),
            ball: plant.ball.clone(),
        };
        specification(plant, of_plant, values)
    }

    /// The tube with the largest r of the cells.
    pub(super) fn tube(&self) -> TubeOfFamily {
        let is_family = self.cells.iter().any(|cell| cell.parameters.intervals().next().is_some());
        let radius = self.cells.iter().map(|cell| cell.orbit.radius.to_f64()).fold(0.0, f64::max);
        TubeOfFamily { l: float_matrix(&self.coordinates.l), radius: if is_family { radius } else { 0.0 } }
    }

    /// The P of existence, where there is one.
    pub(super) fn second(&self) -> Option<&PeriodicMatrix> {
        self.existence.as_ref().map(|triple| &triple.matrix)
    }

    /// What samples the bounds.
    pub(super) fn suprema(&self, sampling: &Sampling<'_>) -> FloatSuprema {
        sampling.suprema(&float_matrix(&self.coordinates.l), [Some(&self.coordinates.p), self.second()])
    }

    pub(super) fn engine(&self, plant: &Plant) -> Result<Engine, PlantRefusal> {
        let cells =
            self.cells.iter().map(|ProvenCell { parameters, orbit, .. }| (parameters, &orbit.orbit, &orbit.radius));
        engine_around(plant, &self.coordinates, cells, self.second().cloned())
    }
}

fn engine_around<'c>(
    plant: &Plant,
    Coordinates { l, p, .. }: &Coordinates,
    cells: impl Iterator<Item = (&'c Parameters, &'c OrbitCurve, &'c Rational)>,
    existence: Option<PeriodicMatrix>,
) -> Result<Engine, PlantRefusal> {
    let region = |(parameters, orbit, radius): (&'c Parameters, &OrbitCurve, &Rational)| {
        Region::new(l.clone(), orbit.clone(), radius.clone()).map(|region| (parameters, region))
    };
    let regions = cells.map(region).collect::<Result<Vec<_>, _>>();
    let engine = regions.and_then(|regions| Engine::of_cells(plant, regions, Some(p.clone()), existence));
    engine.map_err(|_| PlantRefusal::Coordinates)
}

/// What decides bounds of a plant around its proved orbit, and what samples them.
///
/// # Errors
/// Data that are not of this plant.
pub fn bounds_around(plant: &Plant, of_plant: &OfPlant) -> Result<(Engine, FloatSuprema), PlantRefusal> {
    let OfPlant { coordinates, cells, matrix, existence, .. } = of_plant;
    let second = existence.as_ref().map(|second| &second.1);
    let coordinates = Coordinates { l: coordinates.clone(), p: matrix.clone() };
    let around = cells.iter().map(|cell| (&cell.parameters, &cell.orbit.approximation, &cell.orbit.radius));
    let engine = engine_around(plant, &coordinates, around, second.cloned())?;
    let rows = coordinates.l.iter().map(|row| row.iter().map(Rational::to_f64).collect()).collect();
    let curves = cells.iter().map(|cell| (&cell.parameters, FloatCurve::from(&cell.orbit.approximation)));
    Ok((engine, FloatSuprema::of_cells(plant, curves, rows, [Some(matrix), second])))
}

/// What proves bounds of a plant at arguments.
pub(super) struct Proofs<'a> {
    pub(super) plant: &'a Plant,
    pub(super) along: &'a Along,
    pub(super) engine: Engine,
    pub(super) suprema: FloatSuprema,
    pub(super) watch: &'a dyn Watch,
    /// How many attempts failed at the inequality of stability before the last one.
    tried: AtomicUsize,
}

impl<'a> Proofs<'a> {
    pub(super) fn new(along: &'a Along, sampling: &'a Sampling<'_>) -> Result<Proofs<'a>, PlantRefusal> {
        let plant = sampling.plant;
        Ok(Proofs {
            plant,
            along,
            engine: along.engine(plant)?,
            suprema: along.suprema(sampling),
            watch: sampling.watch,
            tried: AtomicUsize::new(0),
        })
    }

    pub(super) fn states(&self) -> usize {
        self.plant.states()
    }

    /// Whether existence has a P of its own.
    pub(super) fn has_second(&self) -> bool {
        self.along.second().is_some()
    }

    /// The values that are needed, each proved.
    pub(super) fn values(&self, needed: &Needed) -> Result<ProvedValues, PlantRefusal> {
        prove_all(&self.engine, &self.suprema, needed, (&self.plant.internal_model.mu, &self.tried), self.watch)
    }

    /// The specification with the values that are needed, each proved, and as a model; `joint` is proved.
    pub(super) fn with_needed(
        &self,
        needed: &Needed,
        joint: impl FnOnce(ProvedValues) -> ProvedValues,
    ) -> Result<(FloatModel, Specification), PlantRefusal> {
        let [x, e] = needed.largest();
        self.engine.smooth(&x, &e)?;
        let spec = self.along.specification(self.plant, joint(self.values(needed)?))?;
        let data = Data::new(&spec, PRECISION);
        Ok((FloatModel::new(&data, trade_off(&data)), spec))
    }
}
