//! Bounds, and matrix inequalities, decided in the states themselves (docs/mathematics.md, section 11.6).
//!
//! A derivative that t enters through the orbit alone is a function of those states and e that it names: where three coordinates
//! and t move one state, one side is to be cut in the place of four. The set is larger than G(X,E), each state over all that it is
//! there, so what is not proved on it says nothing.

use super::formula::Id;
use super::machine::{At, Cell, Curves, Machine, Values};
use super::model::{self, Frame, Model};
use super::question::{Answer, Question};
use super::read::Plant;
use super::region::{Around, Region, Shape};
use super::time::around;
use proofs_core::interval::Interval;
use proofs_core::verdict::Outcome;
use std::rc::Rc;

/// The most boxes that an attempt may take.
const MAX_PIECES: usize = 20_000;
/// How many cells of t there are for the range of the orbit.
const RANGE_CELLS_LOG: u32 = 8;

/// Questions in x; `None` where one moves with t.
pub struct Still {
    model: Model,
    /// The components of xb.
    orbit: Vec<Id>,
    questions: Vec<Option<Question>>,
}

/// The questions of [`Still`] with what is needed for deciding them.
pub struct Prepared<'s> {
    still: &'s Still,
    machine: Machine<'s>,
    root: Rc<Cell>,
    values: Values,
    /// What each component of xb is over a period, for all parameters.
    ranges: Vec<Interval>,
}

impl Still {
    /// For what `ask` makes of a model in x.
    pub fn new(plant: &Plant, ask: impl FnOnce(&mut Model) -> Outcome<Vec<Option<Question>>>) -> Outcome<Still> {
        let mut model = Model::new(plant, Frame::Still);
        let orbit = (0..plant.states()).map(|state| model::wave(&mut model.formulas, plant, state, 0)).collect();
        let still = |question: Option<Question>| question.filter(|question| !question.moves());
        let questions = ask(&mut model)?.into_iter().map(still).collect();
        Ok(Still { model, orbit, questions })
    }

    /// With the orbit; `om` has the precision.
    pub fn prepared(&self, plant: &Plant, curves: &Curves, om: &Interval, period: &Interval) -> Prepared<'_> {
        let machine = Machine::new(&self.model.formulas, curves, om);
        let (root, mut values) = (machine.period(period), machine.values());
        let program = machine.program(&self.orbit);
        let rest = Region::of_family(plant, machine.precision).whole(&machine, root.clone()).sides;
        let cells = root.parts(RANGE_CELLS_LOG);
        let mut range = |id: Id| {
            let on = |cell: &Rc<Cell>| {
                machine.run(&program, At::Box, cell, &[], &rest, &mut values);
                machine.get(id, At::Box, cell, &values)
            };
            cells.iter().map(on).reduce(|all, next| all.hull(&next))
        };
        let none = || Interval::undefined(om.precision());
        let ranges = self.orbit.iter().map(|id| range(*id).unwrap_or_else(none)).collect();
        Prepared { still: self, machine, root, values, ranges }
    }
}

impl Prepared<'_> {
    /// Whether one of them is proved on all states that a region in v around xb has, whose e is that of the model in x; by how many boxes. `None`
    /// says nothing.
    pub fn proves(&mut self, plant: &Plant, which: usize, region: &Region) -> Option<usize> {
        let question = self.still.questions.get(which)?.as_ref()?;
        let Shape::Ball(radius) = &region.shape else { return None };
        if self.still.model.formulas.is_too_large() {
            return None;
        }
        let shape = Shape::Sides(self.sides(plant, radius)?, self.around(plant, radius, question)?);
        let region = Region { shape, ..region.clone() };
        match question.decide(&self.machine, &self.root, &region, MAX_PIECES, &mut self.values) {
            Answer::Proved(count) => Some(count),
            Answer::Refuted(_) | Answer::Open(_) => None,
        }
    }

    /// What is known of the components that a question names, together.
    fn around(&self, plant: &Plant, radius: &Interval, question: &Question) -> Option<Around> {
        let named = (0..plant.states()).filter(|state| question.names(*state));
        let rows =
            named.map(|state| (state, plant.known.coordinates.matrix[state].as_slice(), self.ranges[state].clone()));
        Around::new(rows.collect(), radius.clone())
    }

    /// `|x_i - xb_i| <= |row i of L| radius`.
    fn sides(&self, plant: &Plant, radius: &Interval) -> Option<Vec<Interval>> {
        let p = self.machine.precision;
        let side = |(range, row): (&Interval, &Vec<rug::Rational>)| {
            let number = |value: &rug::Rational| Interval::rational(value, p);
            let size = row.iter().fold(Interval::int(0, p), |sum, value| sum + number(value).sqr()).sqrt();
            let side = range + around(&(size * radius));
            side.is_bounded().then_some(side)
        };
        self.ranges.iter().zip(&plant.known.coordinates.matrix).map(side).collect()
    }
}
