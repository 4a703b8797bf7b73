//! The box of a family cut into cells, where one curve that is affine in the parameters is not close enough to the orbits of all members
//! (derivation, 13.2).

use super::refusal::PlantRefusal;
use super::watch::Watch;
use crate::attempt::{prove_forcing, prove_orbit_at, without_value};
use rug::Rational;
use sigmastar_decide::bounds::{Engine, Region};
use sigmastar_decide::orbit::OrbitNotProved;
use sigmastar_exact::number::{Direction, Portable, round_f64, write_exact};
use sigmastar_exact::parallel;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Bound, OrbitCurve, Parameters, ProvedForcing};
use sigmastar_propose::bounds::{FloatCurve, FloatSuprema};
use sigmastar_propose::orbit::{OrbitFailure, defects_by_parameter, find_orbit, round_orbit};
use sigmastar_theory::evidence::{Coordinates, OrbitProof};
use std::f64::consts::{SQRT_2, TAU};
use std::sync::atomic::{AtomicUsize, Ordering};

/// The most cells.
pub(super) const MAX_CELLS: usize = 64;

/// The shares up to which a tube is narrow: of the sizes that it is added to. The second one is for a family of which no gain is found with
/// the first.
pub(super) const NARROW: [f64; 2] = [0.25, 0.05];

/// Halves whose tube is wider than this share of what it was are not halved again: what is left is not of the parameters that are cut.
const HELPS: f64 = 0.9;

/// A periodic solution has about this share of what the root mean square of q does in a period.
const OF_FORCING: f64 = 0.1;

/// The least root mean square of the derivative of q over a period, relative to that of q.
const LEAST_SLOPE: f64 = 1e-2;

/// The members whose parameters lie in a box, as a family of its own about the nominal values of the box, and the curve that follows
/// them.
#[derive(Clone, Debug)]
pub(super) struct Cell {
    pub(super) plant: Plant,
    pub(super) curve: OrbitCurve,
}

/// Cells that cover the box of a family.
#[derive(Debug)]
pub(super) struct Cells {
    pub(super) list: Vec<Cell>,
    /// Why it is cut, where it is.
    pub(super) why: Option<String>,
    /// The share up to which their tubes were to be narrow.
    pub(super) narrow: f64,
}

impl Cell {
    /// Finds the curve.
    fn new(plant: Plant) -> Result<Cell, PlantRefusal> {
        let found = find_orbit(&plant).map_err(PlantRefusal::NoOrbit)?;
        let curve = round_orbit(&plant, &found).ok_or(PlantRefusal::NoOrbit(OrbitFailure::NotFinite))?;
        Ok(Cell { plant, curve })
    }

    /// Whether there is a parameter along which the box can be cut: it cannot along the clock.
    pub(super) fn can_be_cut(&self) -> bool {
        self.plant.parameters.named_intervals().next().is_some()
    }

    /// That f and q are smooth on the curve itself, so that what is not is told at its operation before anything is proved with it.
    pub(super) fn smooth(&self) -> Result<(), PlantRefusal> {
        let n = self.plant.states();
        let unit = (0..n).map(|i| (0..n).map(|j| Rational::from(u8::from(i == j))).collect());
        let region = Region::new(unit.collect(), self.curve.clone(), Rational::new());
        let engine = region.and_then(|region| Engine::new(&self.plant, region, None, None));
        let zero = Rational::new();
        let smooth = engine.map_err(|_| PlantRefusal::Coordinates)?.smooth(&zero, &zero);
        smooth.map_err(|failure| match without_value(&self.plant, &self.curve) {
            Some(cause) => PlantRefusal::OrbitNotProved(OrbitNotProved::NotSmooth { s: cause.s, cause: Some(cause) }),
            None => failure.into(),
        })
    }

    /// How wide the tube is: the largest share of r and of the rests of q of what they are added to, roughly; and the rate in it, which is at
    /// most this.
    fn width(&self, coordinates: &Coordinates, most: Option<&Rational>) -> Result<(f64, Rational), PlantRefusal> {
        self.smooth()?;
        let orbit =
            prove_orbit_at(&self.plant, &self.curve, coordinates, most).map_err(PlantRefusal::OrbitNotProved)?;
        let forcing = prove_forcing(&self.plant, coordinates, &orbit).map_err(PlantRefusal::OrbitNotProved)?;
        let period = self.plant.period.nominal().to_f64();
        let [size, slope] = sizes(&forcing, period);
        let of_radius = self.share_of_radius(coordinates, &orbit, OF_FORCING * size * period);
        let shares = [forcing.rest.to_f64() / size, forcing.rest_t.to_f64() / slope, of_radius];
        // Of a q that is 0 nothing is a share.
        Ok((shares.into_iter().filter(|share| !share.is_nan()).fold(0.0, f64::max), orbit.alpha))
    }

    /// The share of r of the deviation of x that an error of this size causes; 0 where derivatives are everywhere the same, or an error
    /// does not act on x.
    fn share_of_radius(&self, coordinates: &Coordinates, orbit: &OrbitProof, error: f64) -> f64 {
        let l = coordinates.l.iter().map(|row| row.iter().map(Rational::to_f64).collect()).collect();
        let samples = FloatSuprema::new(&self.plant, FloatCurve::from(&self.curve), l, [Some(&coordinates.p), None]);
        let at_orbit = |bound| samples.at(bound, 0.0, 0.0);
        let size = at_orbit(Bound::Fe) / at_orbit(Bound::Rate) * error;
        if samples.varies() && size > 0.0 { orbit.radius.to_f64() / size } else { 0.0 }
    }

    /// The halves along the named parameter that adds most to the defect; none without one.
    fn halves(&self, coordinates: &Coordinates) -> Option<Result<[Cell; 2], PlantRefusal>> {
        let defects = defects_by_parameter(&self.plant, &self.curve, coordinates);
        // The first of equal ones.
        let most = (0..defects.len()).reduce(|most, i| if defects[i] > defects[most] { i } else { most })?;
        let ends = self.plant.parameters.named_ends();
        let [low, high] = ends.get(most)?;
        let middle = Rational::from(low + high) / 2;
        let half = |ends_of_half: [&Rational; 2]| {
            let mut ends = ends.clone();
            ends[most] = ends_of_half.map(Rational::clone);
            Cell::new(in_cell(&self.plant, self.plant.parameters.in_cell(&ends)))
        };
        let (low, high) = rayon::join(|| half([low, &middle]), || half([&middle, high]));
        Some(low.and_then(|low| Ok([low, high?])))
    }

    /// The least rate of the nominal member and of those at the corners, each proved by itself: without that no cells are small enough.
    fn at_corners(&self, coordinates: &Coordinates) -> Result<Option<Rational>, PlantRefusal> {
        let alone = |values: &Vec<Rational>| Cell::new(self.plant.member(values))?.width(coordinates, None);
        let rates: Vec<_> =
            parallel::map(&self.plant.parameters.looked_at(), alone).into_iter().collect::<Result<_, _>>()?;
        Ok(rates.into_iter().map(|(_, rate)| rate).min())
    }
}

/// The family of the members with these parameters.
pub(super) fn in_cell(plant: &Plant, parameters: Parameters) -> Plant {
    Plant { parameters, ..plant.clone() }
}

/// The root mean squares of qb and of its derivative, about the nominal values.
fn sizes(forcing: &ProvedForcing, period: f64) -> [f64; 2] {
    let amplitude = |[a, b]: &[Rational; 2]| a.to_f64().portable_hypot(b.to_f64()) / SQRT_2;
    let (mut size, mut slope) = (forcing.mean.to_f64(), 0.0_f64);
    for (pair, k) in forcing.harmonics.iter().zip(1..) {
        size = size.portable_hypot(amplitude(pair));
        slope = slope.portable_hypot(TAU * f64::from(k) * amplitude(pair));
    }
    [size, slope.max(LEAST_SLOPE * size) / period]
}

impl Cells {
    /// The whole box, or cells of it in which the tube is narrow in the first of these coordinates: first whatever is not proved is halved, along the
    /// parameter that adds most to the defect, then what is wider than `narrow`, until nothing is or there are [`MAX_CELLS`].
    ///
    /// # Errors
    /// What is not proved in one of them, or of the whole box where a corner is not proved by itself.
    pub(super) fn new(
        whole: &Cell,
        candidates: &[Coordinates],
        narrow: f64,
        watch: &dyn Watch,
    ) -> Result<Cells, PlantRefusal> {
        let coordinates = candidates.first().filter(|_| whole.can_be_cut());
        let first = coordinates.map(|coordinates| (coordinates, whole.width(coordinates, None)));
        let first = first.filter(|(_, width)| width.as_ref().map_or(true, |(width, _)| *width > narrow));
        let Some((coordinates, first)) = first else {
            return Ok(Cells { list: vec![whole.clone()], why: None, narrow });
        };
        let rate = match &first {
            Ok((_, rate)) => Some(rate.clone()),
            Err(refusal) => whole.at_corners(coordinates).map_err(|_| refusal.clone())?,
        };
        let why = reason(whole, first);
        let (mut level, mut done, mut count) = (vec![(whole.clone(), f64::INFINITY)], Vec::new(), 1);
        let looked_at = AtomicUsize::new(0);
        while !level.is_empty() {
            let width = |(cell, _): &(Cell, f64)| {
                let width = cell.width(coordinates, rate.as_ref()).map(|(width, _)| width);
                // So many with those that were halved, as far as is known yet.
                watch.part(looked_at.fetch_add(1, Ordering::Relaxed) + 1, 2 * count - 1);
                width
            };
            let widths: Vec<Result<f64, PlantRefusal>> = parallel::map(&level, width);
            let mut cells: Vec<_> = std::mem::take(&mut level).into_iter().zip(widths).collect();
            cells.sort_by_key(|(_, width)| width.is_ok());
            for ((cell, before), width) in cells {
                let is_narrow = width.as_ref().is_ok_and(|width| *width <= narrow || *width > HELPS * before);
                let halves = if is_narrow || count == MAX_CELLS { None } else { cell.halves(coordinates) };
                match (halves.transpose()?, width) {
                    (Some(halves), width) => {
                        let width = width.unwrap_or(f64::INFINITY);
                        level.extend(halves.map(|half| (half, width)));
                        count += 1;
                    }
                    (None, Ok(_)) => done.push(cell),
                    (None, Err(refusal)) => return Err(refusal),
                }
            }
        }
        done.sort_by_key(|cell: &Cell| cell.plant.parameters.named_ends());
        let why = (done.len() > 1).then_some(why);
        Ok(Cells { list: done, why, narrow })
    }

    /// The members of each cell, and their curve.
    pub(super) fn curves(&self) -> Vec<(&Plant, &OrbitCurve)> {
        self.list.iter().map(|Cell { plant, curve }| (plant, curve)).collect()
    }

    /// The parameters of each cell, and the curve in doubles.
    pub(super) fn in_doubles(&self) -> impl Iterator<Item = (&Parameters, FloatCurve)> {
        self.list.iter().map(|Cell { plant, curve }| (&plant.parameters, FloatCurve::from(curve)))
    }
}

/// Why the box is cut, in words.
fn reason(cell: &Cell, width: Result<(f64, Rational), PlantRefusal>) -> String {
    match width {
        Ok((width, _)) => {
            let share =
                round_f64(100.0 * width, 2, Direction::Nearest).map_or_else(String::new, |share| write_exact(&share));
            format!(
                "in one tube around an orbit that is affine in the parameters its size is {share} % of what it is added to"
            )
        }
        Err(PlantRefusal::OrbitNotProved(failure)) => {
            format!("one orbit that is affine in the parameters is not proved: {failure}")
        }
        Err(refusal) => {
            let told = refusal.errors(&cell.plant);
            let told: Vec<&str> =
                told.iter().flat_map(|errors| errors.errors()).map(|error| error.message.as_str()).collect();
            format!("around one orbit that is affine in the parameters, {}", told.join("; "))
        }
    }
}
