//! What the decisions share: formulas with their derivatives, and what depends on t alone.

use super::PRECISION;
use super::centred::{Centred, Frame, OnBox};
use super::chart::{Active, Chart};
use super::extent::extent;
use super::quantity::Quantity;
use super::region::{Region, RegionError};
use super::requirement::Requirement;
use super::side::Side;
use super::time_cell::{TimeCell, Waves};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::expr::{Formulas, Walk};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Bound, Constant, Interval, Parameters, PeriodicMatrix, TrigonometricVector};
use sigmastar_matrix::is_symmetric;
use sigmastar_theory::evidence::Part;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// The parts of the period of which is remembered what depends on t alone; more are computed again each time.
const REMEMBERED: usize = 1 << 14;

/// The members of a family whose parameters lie in one box, and the region around their curves.
#[derive(Debug)]
pub(super) struct Tube {
    pub(super) region: Region,
    /// Where the parameters lie of which intervals are known.
    parameters: Vec<Interval>,
    cells: Mutex<HashMap<Side, Arc<TimeCell>>>,
    extents: Vec<OnceLock<[Rational; 2]>>,
}

impl Tube {
    fn new(parameters: &Parameters, region: Region) -> Result<Tube, RegionError> {
        let parameters: Vec<Interval> = parameters.intervals().cloned().collect();
        if region.orbit().sensitivities.len() != parameters.len() {
            return Err(RegionError::Shape);
        }
        let extents = (0..region.states()).map(|_| OnceLock::new()).collect();
        Ok(Tube { region, parameters, cells: Mutex::new(HashMap::new()), extents })
    }

    /// An interval that contains a component of xb at all t and p.
    pub(super) fn extent(&self, index: usize) -> [Rational; 2] {
        let all = || {
            let orbit = self.region.orbit();
            let [low, high] = extent(&orbit.centre, index);
            let parts = orbit.sensitivities.iter().zip(&self.parameters);
            let reach = parts.fold(Rational::new(), |sum, (part, interval)| {
                let [low, high] = extent(part, index);
                sum + low.abs().max(high.abs()) * interval.reach()
            });
            [low - &reach, high + reach]
        };
        self.extents[index].get_or_init(all).clone()
    }
}

/// Decides bounds of one plant on tubes of one region, or of a family on those of each cell of its box.
///
/// Every answer holds for all t if f and q have the period, which is for [`Plant::prove_periodic`] to prove.
#[derive(Debug)]
pub struct Engine {
    first: Tube,
    others: Vec<Tube>,
    /// T; with a clock its nominal value, and time is the nominal one.
    pub(super) period: Constant,
    /// The parameter that is the clock.
    clock: Option<usize>,
    quantities: [Option<Quantity>; Bound::ALL.len()],
    first_derivatives: [Quantity; Part::EACH.len()],
    pub(super) requirements: Vec<Requirement>,
    /// f.
    velocity: Walk,
    /// The P of the rate and that of the rate of existence.
    matrices: [Option<PeriodicMatrix>; 2],
    /// The 1 - b at both ends of an input gain; none where it is 1.
    moves: Option<[Rational; 2]>,
}

impl Engine {
    /// The bounds of a plant around an orbit. Without a P its rate is never proved.
    ///
    /// # Errors
    /// A region of another number of states, and a P that is not symmetric of their order.
    pub fn new(
        plant: &Plant,
        region: Region,
        matrix: Option<PeriodicMatrix>,
        existence: Option<PeriodicMatrix>,
    ) -> Result<Engine, RegionError> {
        Engine::of_cells(plant, [(&plant.parameters, region)], matrix, existence)
    }

    /// The bounds of a family that is cut into cells. Each cell gives its parameters and the region around its members; all regions have
    /// the same coordinates. What is decided is decided in every cell. For the caller to prove: the cells cover the box of the parameters.
    ///
    /// # Errors
    /// Those of [`Engine::new`]; no cell at all; a cell with other coordinates.
    pub fn of_cells<'c>(
        plant: &Plant,
        cells: impl IntoIterator<Item = (&'c Parameters, Region)>,
        matrix: Option<PeriodicMatrix>,
        existence: Option<PeriodicMatrix>,
    ) -> Result<Engine, RegionError> {
        let mut tubes = cells.into_iter().map(|(parameters, region)| Tube::new(parameters, region));
        let first = tubes.next().ok_or(RegionError::Shape)??;
        let others = tubes.collect::<Result<Vec<Tube>, RegionError>>()?;
        let region = &first.region;
        let order = plant.states();
        let fits = |matrix: &PeriodicMatrix| matrix.parts().all(|rows| is_symmetric(rows, order));
        let matrices = [matrix, existence];
        let count = plant.parameters.intervals().count();
        let alike = |tube: &Tube| tube.parameters.len() == count && tube.region.matrix() == region.matrix();
        if !alike(&first) || !others.iter().all(alike) {
            return Err(RegionError::Shape);
        }
        if region.states() != order || !matrices.iter().flatten().all(fits) {
            return Err(RegionError::Shape);
        }
        let mut formulas = Formulas::new();
        let (mut sides, mut requirements) = (Vec::new(), Vec::new());
        for (index, expr) in plant.f.iter().chain([&plant.q]).enumerate() {
            let (formula, demands) = formulas.insert_with_demands(expr);
            sides.push(formula);
            requirements.extend(demands.into_iter().map(|demand| Requirement::new(index, expr, demand, &formulas)));
        }
        // There is one right side at least, that of q.
        let (f, q) = sides.split_at(order);
        let quantity = |kind: Bound, formulas: &mut Formulas| {
            let moves = matrices[usize::from(kind == Bound::RateExistence)].as_ref();
            let moves = moves.is_some_and(|matrix| !matrix.harmonics.is_empty());
            Quantity::new(plant, formulas, f, q[0], kind, moves)
        };
        let quantities = Bound::ALL.map(|kind| quantity(kind, &mut formulas));
        let is_moving = matrices[0].as_ref().is_some_and(|matrix| !matrix.harmonics.is_empty());
        let first_derivatives =
            Part::EACH.map(|part| Quantity::first_derivatives(&mut formulas, &sides, part, is_moving));
        let velocity = formulas.walk(f);
        let (period, clock) = (plant.period.nominal().clone(), plant.parameters.clock());
        let moves = sigmastar_theory::input_gain::moves(plant, PRECISION);
        Ok(Engine {
            first,
            others,
            period,
            clock,
            quantities,
            first_derivatives,
            requirements,
            velocity,
            matrices,
            moves,
        })
    }

    /// The number of states.
    #[must_use]
    pub fn states(&self) -> usize {
        self.region().states()
    }

    /// The radius r of the tube in doubles, the largest of all cells.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.tubes().map(|tube| tube.region.radius().to_f64()).fold(0.0, f64::max)
    }

    /// X + r in doubles, with that r.
    #[must_use]
    pub fn reach(&self, x: &Rational) -> f64 {
        let largest = self.tubes().map(|tube| tube.region.radius()).max();
        largest.map_or_else(|| x.to_f64(), |radius| Rational::from(x + radius).to_f64())
    }

    /// The cells.
    pub(super) fn tubes(&self) -> impl Iterator<Item = &Tube> {
        std::iter::once(&self.first).chain(&self.others)
    }

    /// A region with the coordinates, which all cells have in common.
    #[must_use]
    pub fn region(&self) -> &Region {
        &self.first.region
    }

    /// What a bound is of; `None` where it is not computed of a plant.
    pub(super) fn quantity(&self, kind: Bound) -> Option<&Quantity> {
        self.quantities[kind as usize].as_ref()
    }

    /// First derivatives of f and q.
    pub(super) fn first_derivatives(&self, part: Part) -> &Quantity {
        &self.first_derivatives[part as usize]
    }

    /// The 1 - b at both ends of an input gain; none where it is 1.
    #[must_use]
    pub fn moves(&self) -> Option<&[Rational; 2]> {
        self.moves.as_ref()
    }

    /// What d of a matrix inequality is moved by at a threshold of sigma, in turn: (1-b) sigma at both ends of an input gain, 0 without one.
    pub(super) fn moved_slopes(&self, threshold: &Rational) -> Vec<Rational> {
        let moved = |share: &Rational| Rational::from(share * threshold);
        self.moves().map_or_else(|| vec![Rational::new()], |moves| moves.iter().map(moved).collect())
    }

    /// Whether there is a P for a rate.
    #[must_use]
    pub fn has_matrix(&self, kind: Bound) -> bool {
        self.matrices[usize::from(kind == Bound::RateExistence)].is_some()
    }

    /// T.
    #[must_use]
    pub fn period(&self) -> Enclosure {
        self.period.enclose(PRECISION)
    }

    /// The coordinates of a decision about what depends on these variables.
    pub(super) fn chart(&self, tube: &Tube, active: &Active, at: [&Rational; 2]) -> Chart {
        Chart::new((&tube.region, &tube.parameters), self.period(), active, at, |index| tube.extent(index))
    }

    /// What depends on t alone on a part of the period.
    pub(super) fn time_cell(&self, tube: &Tube, side: Side) -> Arc<TimeCell> {
        // Whoever panics while he holds the lock has changed nothing but whole entries.
        let lock = || tube.cells.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(cell) = lock().get(&side) {
            return cell.clone();
        }
        let cell = Arc::new(self.new_cell(tube, side));
        let mut cells = lock();
        if cells.len() < REMEMBERED {
            cells.insert(side, cell.clone());
        }
        cell
    }

    fn new_cell(&self, Tube { region, parameters, .. }: &Tube, side: Side) -> TimeCell {
        let orbit = region.orbit();
        let degrees = self.matrices.iter().flatten().map(|matrix| matrix.harmonics.len());
        let waves = Waves::new(side, degrees.chain([orbit.harmonics()]).max().unwrap_or(0));
        let order = region.states();
        let along = |part: &TrigonometricVector| -> Vec<Centred> {
            let component = |i: usize| {
                let coefficients = part.harmonics.iter().map(move |[a, b]| [&a[i], &b[i]]);
                waves.polynomial(&part.mean[i], coefficients, false)
            };
            (0..order).map(component).collect()
        };
        let sensitivities: Vec<Vec<Centred>> = orbit.sensitivities.iter().map(along).collect();
        let orbit = along(&orbit.centre);
        let frame = frame_in_time(side);
        let period = self.period();
        let clock = self.clock.map(|clock| &parameters[clock]);
        let frequency = clock.map_or_else(|| period.recip(), |clock| between([&clock.low, &clock.high]) / &period);
        let matrices = self.matrices.each_ref().map(|matrix| {
            matrix.as_ref().map(|matrix| {
                [false, true].map(|derivative| {
                    let entry = |i: usize, j: usize| {
                        let coefficients = matrix.harmonics.iter().map(move |[a, b]| [&a[i][j], &b[i][j]]);
                        let value = waves.polynomial(&matrix.mean[i][j], coefficients, derivative);
                        // d/dt is d/ds over T, and that is T_nom over the clock.
                        if derivative { frame.scale(&value, &frequency) } else { value }
                    };
                    (0..order).map(|i| (0..order).map(|j| entry(i, j)).collect()).collect()
                })
            })
        });
        TimeCell { orbit, sensitivities, velocity: OnceLock::new(), matrices }
    }

    /// f(t, xb + L v, 0) for all |v| <= r and all p on a part of the period: few bounds ask for it.
    pub(super) fn velocity<'c>(&self, tube: &Tube, side: Side, cell: &'c TimeCell) -> &'c [Centred] {
        cell.velocity.get_or_init(|| self.velocity_of(tube, side, cell))
    }

    fn velocity_of(&self, Tube { region, parameters, .. }: &Tube, side: Side, cell: &TimeCell) -> Vec<Centred> {
        let TimeCell { orbit, sensitivities, .. } = cell;
        let frame = frame_in_time(side);
        let period = self.period();
        let radius = region.radius();
        let x: Vec<Centred> = orbit
            .iter()
            .zip(region.matrix())
            .map(|(value, row)| {
                // (L v)_i for |v| <= r: the same for all t, and unknown.
                let reach = super::chart::norm_above(row) * radius;
                let deviation = Enclosure::between(&Rational::from(-&reach), &reach, PRECISION);
                frame.add(value, &frame.constant(deviation))
            })
            .collect();
        // As unknown as v: all members at once.
        let deviations: Vec<Enclosure> =
            parameters.iter().map(|interval| between(interval.deviations().each_ref())).collect();
        let x: Vec<Centred> = x
            .into_iter()
            .enumerate()
            .map(|(i, value)| {
                sensitivities.iter().zip(&deviations).fold(value, |sum, (part, deviation)| {
                    frame.add(&sum, &frame.mul(&part[i], &frame.constant(deviation.clone())))
                })
            })
            .collect();
        let p: Vec<Centred> =
            parameters.iter().map(|interval| frame.constant(between([&interval.low, &interval.high]))).collect();
        let [low, middle, high] = side.unit();
        let t = Centred {
            centre: Enclosure::from_rational(&middle, PRECISION) * &period,
            range: Enclosure::between(&low, &high, PRECISION) * &period,
            slopes: vec![Some(period)],
        };
        let e = frame.constant(Enclosure::zero(PRECISION));
        self.velocity.evaluate(&mut OnBox { frame: &frame, t: &t, x: &x, e: &e, p: &p })
    }
}

fn between([low, high]: [&Rational; 2]) -> Enclosure {
    Enclosure::between(low, high, PRECISION)
}

/// A part of the period, of which the only side is s = t/T.
fn frame_in_time(side: Side) -> Frame {
    Frame { halves: vec![Enclosure::from_rational(&side.half(), PRECISION)], precision: PRECISION }
}
