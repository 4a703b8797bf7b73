//! Bounds by sampling, in doubles: they guide a search, and nothing rests on them.

use super::climb::{Point, ball_points, climb};
use super::float_waves::{FloatCurve, FloatMatrix};
use super::narrow::extreme_errors;
use super::place::{Moment, Outputs, Place, Places, keep, merged};
use super::pointwise::{Asked, Derivatives, MatrixAt, Pointwise};
use rug::Rational;
use sigmastar_exact::parallel;
use sigmastar_lang::expr::{Evaluator, Formulas, PlantVariable, Program};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Bound, Parameters, PeriodicMatrix};
use sigmastar_theory::evidence::of_table;
use sigmastar_theory::input_gain::moves;
use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

/// The precision of the ends of an input gain, in bits.
const PRECISION: u32 = 53;

/// Points of a period.
const TIMES: usize = 64;

/// How often the step of a local search is halved: roughly, from many points, and for a proof.
const ROUGH: u32 = 3;
const COARSE: u32 = 7;
const FINE: u32 = 14;

/// The best points from which a fine local search starts.
const STARTS: usize = 6;

/// The shares of E that are looked at.
const ERRORS: [f64; 3] = [-1.0, 0.0, 1.0];

/// Where local searches start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Starts {
    /// At the best places of the grid.
    Best,
    /// At the best place at each time: where a form was fitted to many points, the best of all are of a few times alone.
    AtEachTime,
}

/// A sampled supremum.
#[derive(Clone, Copy, Debug)]
pub struct Sampled {
    /// The supremum; for a rate the infimum.
    pub value: f64,
    /// The difference between the largest and the smallest value that was met.
    pub spread: f64,
}

/// A member of a family.
#[derive(Clone, Debug)]
struct Member {
    /// How much faster than nominally its time runs.
    clock: f64,
    parameters: Vec<f64>,
    /// The curve of its cell.
    orbit: Arc<FloatCurve>,
    /// What they differ from the nominal ones of the cell.
    deviations: Vec<f64>,
}

/// The suprema of all bounds by sampling, for one plant, orbit and L.
#[derive(Clone, Debug)]
pub struct FloatSuprema {
    order: usize,
    period: f64,
    matrix: Vec<Vec<f64>>,
    inverse: Vec<Vec<f64>>,
    matrices: [Option<FloatMatrix>; 2],
    pub(super) program: Arc<Program>,
    pub(super) moments: Arc<Vec<Moment>>,
    /// The nominal member, and the corners of the box; the middles of cells.
    members: Arc<Vec<Member>>,
    /// Points of the unit ball.
    pub(super) ball: Arc<Vec<Vec<f64>>>,
    /// Whether anything depends on e.
    by_error: bool,
    /// At each time the errors at which dq/de is largest and least, where it is so at others than 0 and the largest ones: a friction that
    /// changes over a small part of the errors is not seen by shares of them.
    narrow: Option<Arc<Vec<[f64; 2]>>>,
    velocity: Arc<Program>,
    /// The 1 - b at both ends of an input gain.
    pub moves: Option<[f64; 2]>,
    /// See [`FloatSuprema::with_tube`].
    drift: f64,
}

impl FloatSuprema {
    /// Prepares sampling; `matrix` is L, and `lyapunov` the P of the rate and that of the rate of existence.
    #[must_use]
    pub fn new(
        plant: &Plant,
        orbit: FloatCurve,
        matrix: Vec<Vec<f64>>,
        lyapunov: [Option<&PeriodicMatrix>; 2],
    ) -> FloatSuprema {
        FloatSuprema::of_cells(plant, [(&plant.parameters, orbit)], matrix, lyapunov)
    }

    /// Prepares sampling of a family that is cut into cells. Each cell gives its parameters and the curve that follows its members; `matrix`
    /// and `lyapunov` are those of [`FloatSuprema::new`]. Hypothesis: the cells cover the box of the parameters.
    #[must_use]
    pub fn of_cells<'c>(
        plant: &Plant,
        cells: impl IntoIterator<Item = (&'c Parameters, FloatCurve)>,
        matrix: Vec<Vec<f64>>,
        lyapunov: [Option<&PeriodicMatrix>; 2],
    ) -> FloatSuprema {
        let n = plant.states();
        let (mut formulas, sides) = plant.formulas();
        let (f, q) = sides.split_at(n);
        let states: Vec<PlantVariable> = (0..n).map(PlantVariable::State).collect();
        let rows = |formulas: &mut Formulas, of: &[sigmastar_lang::expr::Formula]| {
            let columns: Vec<Vec<_>> = states.iter().map(|x| formulas.derivatives(of, *x)).collect();
            (0..of.len()).flat_map(|row| columns.iter().map(move |column| column[row]).collect::<Vec<_>>()).collect()
        };
        let mut outputs: Vec<sigmastar_lang::expr::Formula> = rows(&mut formulas, f);
        outputs.extend(formulas.derivatives(f, PlantVariable::Error));
        let q_x: Vec<_> = rows(&mut formulas, q);
        let q_e = formulas.derivatives(q, PlantVariable::Error);
        outputs.extend(q_x.iter().chain(&q_e));
        outputs.extend(plant.derivatives_in_time(&mut formulas, &q_x));
        outputs.extend(plant.derivatives_in_time(&mut formulas, &q_e));
        outputs.extend(rows(&mut formulas, &q_x));
        outputs.extend(rows(&mut formulas, &q_e));
        let program = Arc::new(Program::of_formulas(&formulas, &outputs, n));
        // What depends on nothing need not be looked at in more than one place: a linear plant has one matrix.
        let variables = formulas.walk(&outputs).all_variables();
        let by_states = states.iter().any(|state| variables.has(*state));
        let by_error = variables.has(PlantVariable::Error);
        let matrices = lyapunov.map(|matrix| matrix.map(FloatMatrix::new));
        let steady = matrices.iter().flatten().all(|matrix| matrix.steady.is_some());
        let times = if by_states || by_error || !steady || variables.has(PlantVariable::Time) { TIMES } else { 1 };
        let velocity = Arc::new(Program::of_formulas(&formulas, f, n));
        let doubles = |values: &[Rational]| values.iter().map(Rational::to_f64).collect();
        let cells: Vec<(&Parameters, Arc<FloatCurve>)> =
            cells.into_iter().map(|(cell, orbit)| (cell, Arc::new(orbit))).collect();
        let mut looked_at = plant.parameters.looked_at();
        if cells.len() > 1 {
            looked_at.extend(cells.iter().map(|(cell, _)| cell.nominal()));
        }
        let member = |values: &Vec<Rational>| {
            let (cell, orbit) = cells.iter().find(|(cell, _)| cell.contain(values)).or(cells.first())?;
            Some(Member {
                clock: plant.parameters.clock().map_or(1.0, |clock| values[clock].to_f64()),
                parameters: doubles(values),
                orbit: orbit.clone(),
                deviations: doubles(&cell.deviations(values)),
            })
        };
        let members: Vec<Member> = looked_at.iter().filter_map(member).collect();
        let mut suprema = FloatSuprema {
            order: n,
            period: plant.period.nominal().to_f64(),
            inverse: inverse(&matrix),
            matrix,
            matrices,
            program,
            moments: Arc::default(),
            members: Arc::new(members),
            ball: Arc::new(if by_states { ball_points(n) } else { vec![vec![0.0; n]] }),
            by_error,
            narrow: None,
            velocity,
            moves: moves(plant, PRECISION).map(|moves| moves.map(|share| share.to_f64())),
            drift: 0.0,
        };
        let mut evaluator = Evaluator::new(suprema.program.clone());
        let mut slow = Evaluator::new(suprema.velocity.clone());
        let places = (0..suprema.members.len()).flat_map(|member| (0..times).map(move |i| (member, i)));
        let moment = |(member, i): (usize, usize)| {
            suprema.moment((i as f64 + 0.5) / TIMES as f64, member, &mut evaluator, &mut slow)
        };
        suprema.moments = Arc::new(places.map(moment).collect());
        suprema.narrow = if by_error { suprema.sought_narrow() } else { None };
        suprema
    }

    /// See [`FloatSuprema::narrow`].
    fn sought_narrow(&self) -> Option<Arc<Vec<[f64; 2]>>> {
        let mut evaluator = Evaluator::new(self.program.clone());
        let mut outputs = vec![0.0; self.program.outputs()];
        let (at, mut last) = (self.order * self.order + 2 * self.order, None);
        let found = extreme_errors(self.moments.len(), |time, e| {
            let moment = &self.moments[time];
            if last != Some(time) {
                self.load(moment, &mut evaluator);
                last = Some(time);
            }
            evaluator.evaluate(&moment.orbit, e, &mut outputs);
            outputs[at]
        });
        found.map(Arc::new)
    }

    /// The suprema where x_0' is as unknown as a program may leave it that knows of the orbit only the defect eps and the radius r of a
    /// tube: `|L^-1 (x_0' - xb')| <= eps + r |J|` in each component. eps is at most r |J|, for it is r times a rate; so 2 r |J| is taken.
    #[must_use]
    pub fn with_tube(&self, radius: f64) -> FloatSuprema {
        let mut evaluator = Evaluator::new(self.program.clone());
        let mut outputs = vec![0.0; self.program.outputs()];
        let mut pointwise = self.pointwise();
        let mut size = |moment: &Moment| {
            self.load(moment, &mut evaluator);
            evaluator.evaluate(&moment.orbit, 0.0, &mut outputs);
            pointwise.derivatives(&outputs).j.iter().map(|entry| entry * entry).sum::<f64>().sqrt()
        };
        let largest = self.moments.iter().map(&mut size).fold(0.0, f64::max);
        FloatSuprema { drift: 2.0 * radius * largest, ..self.clone() }
    }

    /// The error at a place.
    pub(super) fn error(&self, [i, _, k]: Place, e: f64) -> f64 {
        match (ERRORS.get(k), &self.narrow) {
            (Some(share), _) => share * e,
            (None, Some(narrow)) => narrow[i][k - ERRORS.len()].max(-e).min(e),
            (None, None) => 0.0,
        }
    }

    /// The suprema in other coordinates and with other matrices P; the formulas are not differentiated again. Hypothesis: each P is constant.
    #[must_use]
    pub fn in_coordinates(&self, matrix: Vec<Vec<f64>>, lyapunov: [Option<&PeriodicMatrix>; 2]) -> FloatSuprema {
        let matrices = lyapunov.map(|matrix| matrix.map(FloatMatrix::new));
        FloatSuprema { inverse: inverse(&matrix), matrix, matrices, drift: 0.0, ..self.clone() }
    }

    fn moment(&self, time: f64, member: usize, evaluator: &mut Evaluator, slow: &mut Evaluator) -> Moment {
        let Member { parameters, orbit, deviations, .. } = &self.members[member];
        let orbit = orbit.at(time, deviations);
        let mut velocity = vec![0.0; self.order];
        slow.set_parameters(parameters);
        slow.set_time(time * self.period);
        slow.evaluate(&orbit, 0.0, &mut velocity);
        evaluator.set_time(time * self.period);
        let mut kept = Vec::new();
        evaluator.time_values(&mut kept);
        Moment { time, orbit, velocity, kept, member }
    }

    /// Makes ready for evaluations at a moment.
    pub(super) fn load(&self, moment: &Moment, evaluator: &mut Evaluator) {
        evaluator.set_parameters(&self.members[moment.member].parameters);
        evaluator.load_time_values(&moment.kept);
    }

    /// The supremum of one bound, roughly; for a rate the infimum. `reach` is X + r.
    #[must_use]
    pub fn at(&self, kind: Bound, reach: f64, e: f64) -> f64 {
        self.search(kind, reach, e, ROUGH, 1).value
    }

    /// The places of the grid that are looked at for these sizes, in the order of their times.
    pub(super) fn places(&self, e: f64, places: &Places) -> Vec<Place> {
        let errors: &[usize] = match places {
            _ if e == 0.0 || !self.by_error => &[1],
            Places::Stride(1) | Places::Listed(_) if self.narrow.is_some() => &[0, 1, 2, 3, 4],
            Places::Stride(1) | Places::Listed(_) => &[0, 1, 2],
            Places::Stride(_) if self.narrow.is_some() => &[0, 2, 3, 4],
            Places::Stride(_) => &[0, 2],
        };
        match places {
            Places::Listed(listed) => {
                let mut own: Vec<Place> = listed.to_vec();
                if errors.len() == 1 {
                    own.iter_mut().for_each(|place| place[2] = 1);
                    own.dedup();
                }
                own
            }
            Places::Stride(stride) => {
                let sparse = if *stride > 1 && self.order > 2 { 3 } else { 1 };
                let times = (0..self.moments.len()).step_by(*stride);
                let points = |i: usize| (0..self.ball.len()).step_by(sparse).map(move |j| (i, j));
                times.flat_map(points).flat_map(|(i, j)| errors.iter().map(move |k| [i, j, *k])).collect()
            }
        }
    }

    /// The 1 - b at both ends of an input gain; none where it is 1.
    #[must_use]
    pub fn moves(&self) -> Option<[f64; 2]> {
        self.moves
    }

    /// Whether the derivatives depend on the states or on the error.
    #[must_use]
    pub fn varies(&self) -> bool {
        self.by_error || self.ball.len() > 1
    }

    /// The number of states.
    pub(super) fn states(&self) -> usize {
        self.order
    }

    /// The largest value of them by a longer search.
    pub(super) fn refined_of_derivatives(
        &self,
        at: [f64; 2],
        value: impl Fn(&Derivatives<'_>, &MatrixAt) -> f64 + Sync,
    ) -> f64 {
        let found = self.climbed(at, (FINE, STARTS), Asked::FIRST, |pointwise, at| {
            value(&pointwise.derivatives(at.outputs), &at.matrices[0])
        });
        found.largest()
    }

    /// The points where searches from these starts end, with the values there, and what a function makes of the first derivatives there.
    pub(super) fn refined_points<T>(
        &self,
        (at, starts): ([f64; 2], Starts),
        value: impl Fn(&Derivatives<'_>) -> f64 + Sync,
        of: impl Fn(&Derivatives<'_>) -> T,
    ) -> Vec<(f64, T)> {
        let value = |pointwise: &mut Pointwise, at: Outputs<'_>| value(&pointwise.derivatives(at.outputs));
        let ends = match starts {
            Starts::Best => self.climbed(at, (FINE, STARTS), Asked::FIRST, value).ends,
            Starts::AtEachTime => {
                let starts = self.best_at_each_time(at, value);
                self.climbed_from(at, (COARSE, &starts), Asked::FIRST, value)
            }
        };
        let mut single = Single::new(self, at, Asked::FIRST);
        let seen =
            |(point, value)| (value, single.value(&point, |pointwise, at| of(&pointwise.derivatives(at.outputs))));
        ends.into_iter().map(seen).collect()
    }

    /// The best place of the grid at each of its times, with its value.
    fn best_at_each_time(
        &self,
        at: [f64; 2],
        value: impl Fn(&mut Pointwise, Outputs<'_>) -> f64 + Sync,
    ) -> Vec<(f64, Place)> {
        let pieces =
            self.in_pieces(at, &Places::Stride(1), Asked::FIRST, BTreeMap::new, |best, pointwise, place, at| {
                let found = value(pointwise, at);
                let known = best.entry(place[0]).or_insert((f64::NEG_INFINITY, place));
                if found > known.0 {
                    *known = (found, place);
                }
            });
        let mut best: BTreeMap<usize, (f64, Place)> = BTreeMap::new();
        for (time, found) in pieces.into_iter().flatten() {
            let known = best.entry(time).or_insert(found);
            if found.0 > known.0 {
                *known = found;
            }
        }
        best.into_values().collect()
    }

    pub(super) fn pointwise(&self) -> Pointwise {
        Pointwise::new(&self.matrix, &self.inverse, self.drift)
    }

    /// The supremum of one bound by a longer search.
    #[must_use]
    pub fn refined(&self, kind: Bound, reach: f64, e: f64) -> Sampled {
        self.search(kind, reach, e, FINE, STARTS)
    }

    /// The largest value at these points of the nominal member: t/T, y in the unit ball, e/E; of a rate the negative.
    #[must_use]
    pub fn largest_at(&self, kind: Bound, at: [f64; 2], points: &[(f64, Vec<f64>, f64)]) -> f64 {
        let asked = Asked::only(kind);
        self.largest_of(at, points, asked, |pointwise, at| {
            of_table(kind, &pointwise.at(at.outputs, &at.moment.velocity, at.matrices, asked))
        })
    }

    /// The largest value of the first derivatives and P at these points of the nominal member.
    pub fn largest_of_derivatives_at(
        &self,
        at: [f64; 2],
        points: &[(f64, Vec<f64>, f64)],
        mut value: impl FnMut(&Derivatives<'_>, &MatrixAt) -> f64,
    ) -> f64 {
        self.largest_of(at, points, Asked::FIRST, |pointwise, at| {
            value(&pointwise.derivatives(at.outputs), &at.matrices[0])
        })
    }

    fn largest_of(
        &self,
        at: [f64; 2],
        points: &[(f64, Vec<f64>, f64)],
        asked: Asked,
        mut value_of: impl FnMut(&mut Pointwise, Outputs<'_>) -> f64,
    ) -> f64 {
        let mut single = Single::new(self, at, asked);
        let value = |(time, y, e): &(f64, Vec<f64>, f64)| {
            single.value(&Point { time: *time, y: y.clone(), e: *e, member: 0 }, &mut value_of)
        };
        points.iter().map(value).fold(f64::NEG_INFINITY, f64::max)
    }

    /// The largest value at the points of the grid, and a local search from the best of them.
    fn search(&self, kind: Bound, reach: f64, e: f64, halvings: u32, starts: usize) -> Sampled {
        let asked = Asked::only(kind);
        let found = self.climbed([reach, e], (halvings, starts), asked, |pointwise, at| {
            of_table(kind, &pointwise.at(at.outputs, &at.moment.velocity, at.matrices, asked))
        });
        let largest = found.largest();
        Sampled { value: if kind.is_rate() { -largest } else { largest }, spread: largest - found.least }
    }

    /// Where local searches from the best points of the grid end, and the least value on the grid.
    fn climbed(
        &self,
        at: [f64; 2],
        (halvings, starts): (u32, usize),
        asked: Asked,
        value_of: impl Fn(&mut Pointwise, Outputs<'_>) -> f64 + Sync,
    ) -> Climbed {
        // The best values with their points, and the least value.
        let nothing = || (Vec::new(), f64::INFINITY);
        let pieces = self.in_pieces(at, &Places::Stride(1), asked, nothing, |(best, least), pointwise, place, at| {
            let value = value_of(pointwise, at);
            *least = least.min(value);
            keep(best, starts, value, place);
        });
        let (best, least): (Vec<_>, Vec<f64>) = pieces.into_iter().unzip();
        Climbed {
            ends: self.climbed_from(at, (halvings, &merged(best, starts)), asked, value_of),
            least: least.into_iter().fold(f64::INFINITY, f64::min),
        }
    }

    /// Where local searches from these places of the grid end, with the values there.
    fn climbed_from(
        &self,
        at @ [_, e]: [f64; 2],
        (halvings, starts): (u32, &[(f64, Place)]),
        asked: Asked,
        value_of: impl Fn(&mut Pointwise, Outputs<'_>) -> f64 + Sync,
    ) -> Vec<(Point, f64)> {
        let from = |(value, place @ [i, j, _]): &(f64, Place)| {
            let share = if e > 0.0 { self.error(*place, e) / e } else { 0.0 };
            let Moment { time, member, .. } = self.moments[*i];
            let point = Point { time, y: self.ball[*j].clone(), e: share, member };
            let mut single = Single::new(self, at, asked);
            climb(point, *value, halvings, e != 0.0, |point| single.value(point, &value_of))
        };
        parallel::map(starts, from)
    }

    /// xb + (X + r) L y.
    pub(super) fn place(&self, orbit: &[f64], y: &[f64], reach: f64, x: &mut [f64]) {
        for ((x, orbit), row) in x.iter_mut().zip(orbit).zip(&self.matrix) {
            *x = orbit + reach * row.iter().zip(y).map(|(l, y)| l * y).sum::<f64>();
        }
    }

    pub(super) fn matrices_at(&self, moment: &Moment) -> [MatrixAt; 2] {
        let period = self.period / self.members[moment.member].clock;
        self.matrices.each_ref().map(|matrix| match matrix {
            None => MatrixAt::Missing,
            Some(matrix) => matrix.steady.clone().unwrap_or_else(|| MatrixAt::Moving(matrix.at(moment.time, period))),
        })
    }
}

/// What local searches find.
struct Climbed {
    /// Where each of them ends, and the value there.
    ends: Vec<(Point, f64)>,
    /// The least value on the grid.
    least: f64,
}

impl Climbed {
    /// Where there is no value anywhere, as of a rate without a P, not a number.
    fn largest(&self) -> f64 {
        self.ends.iter().map(|(_, value)| *value).fold(f64::NAN, f64::max)
    }
}

/// Values at single points, anywhere.
struct Single<'a> {
    suprema: &'a FloatSuprema,
    at: [f64; 2],
    pointwise: Pointwise,
    evaluator: Evaluator,
    slow: Evaluator,
    /// The moments that were met, by the bits of the time and the member: a search comes back to most of them.
    moments: HashMap<(u64, usize), Moment>,
    x: Vec<f64>,
    outputs: Vec<f64>,
}

impl<'a> Single<'a> {
    fn new(suprema: &'a FloatSuprema, at: [f64; 2], asked: Asked) -> Single<'a> {
        Single {
            suprema,
            at,
            pointwise: suprema.pointwise(),
            evaluator: Evaluator::new(suprema.program.clone()),
            slow: Evaluator::new(suprema.velocity.clone()),
            moments: HashMap::new(),
            x: vec![0.0; suprema.order],
            outputs: vec![0.0; asked.outputs(suprema.order)],
        }
    }

    fn value<T>(
        &mut self,
        Point { time, y, e, member }: &Point,
        value_of: impl FnOnce(&mut Pointwise, Outputs<'_>) -> T,
    ) -> T {
        let Single { suprema, at: [reach, largest], pointwise, evaluator, slow, moments, x, outputs } = self;
        let of_time = || suprema.moment(*time, *member, evaluator, slow);
        let moment = &*moments.entry((time.to_bits(), *member)).or_insert_with(of_time);
        suprema.load(moment, evaluator);
        suprema.place(&moment.orbit, y, *reach, x);
        evaluator.evaluate(x, e * *largest, outputs);
        value_of(pointwise, Outputs { outputs, moment, matrices: &suprema.matrices_at(moment) })
    }
}

/// The inverse in doubles, by Gauss and Jordan with pivots; without one, entries that are not numbers. Rows may be in units of
/// their own: they are brought to one size first.
fn inverse(matrix: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let n = matrix.len();
    let size = |row: &Vec<f64>| row.iter().fold(0.0_f64, |size, entry| size.max(entry.abs()));
    let sizes: Vec<f64> = matrix.iter().map(size).collect();
    let unit = |i: usize| (0..n).map(move |j| f64::from(i == j));
    let scaled = |(i, row): (usize, &Vec<f64>)| row.iter().map(|entry| entry / sizes[i]).chain(unit(i)).collect();
    let mut rows: Vec<Vec<f64>> = matrix.iter().enumerate().map(scaled).collect();
    for column in 0..n {
        let pivot = (column..n).max_by(|&a, &b| rows[a][column].abs().total_cmp(&rows[b][column].abs()));
        rows.swap(column, pivot.unwrap_or(column));
        let divisor = rows[column][column];
        rows[column].iter_mut().for_each(|entry| *entry /= divisor);
        let pivot = rows[column].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != column) {
            let factor = row[column];
            row.iter_mut().zip(&pivot).for_each(|(entry, by)| *entry -= factor * by);
        }
    }
    let written = |row: Vec<f64>| row.into_iter().skip(n).zip(&sizes).map(|(entry, size)| entry / size).collect();
    rows.into_iter().map(written).collect()
}
