//! Bounds, and the matrix inequalities, decided in the states themselves (docs/mathematics.md, section 11.6).
//!
//! A derivative that t enters through the orbit alone is a function of those states and e that it names: where three coordinates
//! and t move one state, one side is to be cut in the place of four. The set is larger than G(X,E), each state over all that it is
//! there, so what is not proved on it says nothing.

use super::form::Said;
use super::formula::Id;
use super::inequality;
use super::machine::{At, Cell, Curves, Machine, Values};
use super::model::{self, Frame, Model};
use super::question::{Answer, Question};
use super::read::Plant;
use super::region::{Around, Region, Shape};
use super::time::around;
use super::{PRECISION, end, of_entry, radius};
use proofs_core::interval::Interval;
use proofs_core::plant::entries;
use proofs_core::rules::derivation::Inequalities;
use proofs_core::spec::Specification;
use proofs_core::verdict::Outcome;
use rug::Float;
use std::rc::Rc;

/// The most boxes that an attempt may take.
const MAX_PIECES: usize = 20_000;
/// How many cells of t there are for the range of the orbit.
const RANGE_CELLS_LOG: u32 = 8;

/// The entries and the parts of the inequalities as questions in x; `None` where one moves with t.
pub struct Still {
    model: Model,
    /// The components of xb.
    orbit: Vec<Id>,
    questions: Vec<Option<Said>>,
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
    /// For all entries of a plant, and for the inequalities that there are, with mu and the period.
    pub fn new(plant: &Plant, inequalities: Inequalities<'_>, spec: &Specification) -> Outcome<Still> {
        let mut model = Model::new(plant, Frame::Still);
        let orbit = (0..plant.states()).map(|state| model::wave(&mut model.formulas, plant, state, 0)).collect();
        let question = |entry: &entries::Entry| {
            let moves = entry.name.is_of_motion();
            (!moves).then(|| of_entry(&mut model, entry))
        };
        let mut questions: Vec<_> = plant.known.entries.list.iter().map(question).collect();
        questions.extend(inequality::questions(&mut model, inequalities, spec)?.into_iter().map(Some));
        let questions = questions.into_iter().map(|said| said.filter(|said| !said.question.moves())).collect();
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
    /// Whether one of them is proved on all states that G(X,E) has; by how many boxes. `None` says nothing.
    pub fn proves(&mut self, plant: &Plant, which: usize) -> Option<usize> {
        let Said { question, at: [x, e], .. } = self.still.questions.get(which)?.as_ref()?;
        if self.still.model.formulas.is_too_large() {
            return None;
        }
        let shape = Shape::Sides(self.sides(plant, x)?, self.around(plant, x, question)?);
        let region = Region { states: plant.states(), shape, output: end(e), ..Region::of_family(plant, PRECISION) };
        match question.decide(&self.machine, &self.root, &region, MAX_PIECES, &mut self.values) {
            Answer::Proved(count) => Some(count),
            Answer::Refuted(_) | Answer::Open(_) => None,
        }
    }

    /// What is known of the components that a question names, together.
    fn around(&self, plant: &Plant, x: &Float, question: &Question) -> Option<Around> {
        let named = (0..plant.states()).filter(|state| question.names(*state));
        let rows =
            named.map(|state| (state, plant.known.coordinates.matrix[state].as_slice(), self.ranges[state].clone()));
        Around::new(rows.collect(), radius(plant, x))
    }

    /// `|x_i - xb_i| <= |row i of L| (X + r)`.
    fn sides(&self, plant: &Plant, x: &Float) -> Option<Vec<Interval>> {
        let (p, radius) = (self.machine.precision, radius(plant, x));
        let side = |(range, row): (&Interval, &Vec<rug::Rational>)| {
            let number = |value: &rug::Rational| Interval::rational(value, p);
            let size = row.iter().fold(Interval::int(0, p), |sum, value| sum + number(value).sqr()).sqrt();
            let side = range + around(&(size * &radius));
            side.is_bounded().then_some(side)
        };
        self.ranges.iter().zip(&plant.known.coordinates.matrix).map(side).collect()
    }
}
