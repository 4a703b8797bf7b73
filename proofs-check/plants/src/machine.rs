//! Formulas evaluated over intervals: what depends on t alone once for each cell of t, the rest for each box.

use super::formula::{Axis, Formulas, Id, Kind, Leaf};
use super::time::{Table, Wave, waves};
use proofs_core::expr::interval_op;
use proofs_core::interval::Interval;
use std::cell::{OnceCell, RefCell};
use std::collections::HashMap;
use std::rc::Rc;

/// Derivatives of xb and P of higher order than this are not needed, but for Taylor's formula around a time.
const MAX_ORDER: usize = 4;
/// Terms of Taylor's formula.
const TERMS: usize = 3;
/// Cells of t are kept for all questions down to this depth.
const KEPT_DEPTH: u32 = 9;

/// The trigonometric polynomials of a witness: those of [`super::model::curves`], and the matrices P by their entries.
#[derive(Clone, Debug)]
pub struct Curves {
    pub orbit: Vec<Wave>,
    pub lyapunov: Vec<Vec<Vec<Wave>>>,
}

impl Curves {
    fn most_harmonics(&self) -> usize {
        let all = self.orbit.iter().chain(self.lyapunov.iter().flatten().flatten());
        all.map(|wave| wave.harmonics.len()).max().unwrap_or(0)
    }
}

/// An interval of t with what has been computed on it.
pub struct Cell {
    pub all: Interval,
    pub middle: Interval,
    depth: u32,
    waves: OnceCell<Vec<[Interval; 2]>>,
    /// Of leaves with their order, at the middle.
    derivatives: RefCell<HashMap<Leaf, Interval>>,
    /// Values at the middle, and on the cell, by the places of nodes that depend on t alone.
    values: [RefCell<Vec<Option<Interval>>>; 2],
    halves: OnceCell<[Rc<Cell>; 2]>,
}

impl Cell {
    fn new(all: Interval, depth: u32) -> Rc<Cell> {
        let values = [RefCell::new(Vec::new()), RefCell::new(Vec::new())];
        let (waves, derivatives, halves) = Default::default();
        Rc::new(Cell { middle: all.middle(), all, depth, waves, derivatives, values, halves })
    }

    /// The two halves, which are the same ones whenever they are asked for, unless they are very small.
    pub fn halves(&self) -> [Rc<Cell>; 2] {
        let make = || self.all.halves().map(|half| Cell::new(half, self.depth + 1));
        if self.depth < KEPT_DEPTH { self.halves.get_or_init(make).clone() } else { make() }
    }

    /// It, halved so many times.
    pub fn parts(self: &Rc<Cell>, times: u32) -> Vec<Rc<Cell>> {
        (0..times).fold(vec![self.clone()], |cells, _| cells.iter().flat_map(|cell| cell.halves()).collect())
    }
}

/// Where formulas are evaluated: on a whole box, or at its middle.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum At {
    Middle = 0,
    Box = 1,
}

/// The formulas with everything that is needed to evaluate them at one precision.
pub struct Machine<'f> {
    pub formulas: &'f Formulas,
    pub precision: u32,
    om: Interval,
    count: usize,
    orbit: Vec<Table>,
    lyapunov: Vec<Vec<Vec<Table>>>,
    /// What L^-1 (x_0' - xb') lies within, in each component.
    pub drift: Interval,
    /// The place of a node among those that depend on t alone.
    places: Vec<usize>,
    none: Interval,
}

/// The values of nodes by their ids: numbers from the beginning, the rest as it was last computed.
pub struct Values(Vec<Interval>);

/// What has to be computed for some nodes.
pub struct Program {
    time: Vec<Id>,
    rest: Vec<Id>,
}

impl<'f> Machine<'f> {
    /// `om` has the precision.
    pub fn new(formulas: &'f Formulas, curves: &Curves, om: &Interval) -> Machine<'f> {
        let last = MAX_ORDER + TERMS;
        let table = |wave: &Wave| Table::new(wave, om, last);
        let matrix = |rows: &Vec<Vec<Wave>>| rows.iter().map(|row| row.iter().map(table).collect()).collect();
        let mut next = 0;
        let places = (0..formulas.size()).map(|id| {
            next += usize::from(formulas.depends(Id(id)) == Axis::Time.bit());
            next.saturating_sub(1)
        });
        Machine {
            formulas,
            precision: om.precision(),
            count: curves.most_harmonics(),
            orbit: curves.orbit.iter().map(table).collect(),
            lyapunov: curves.lyapunov.iter().map(matrix).collect(),
            drift: Interval::int(0, om.precision()),
            places: places.collect(),
            none: Interval::undefined(om.precision()),
            om: om.clone(),
        }
    }

    /// A whole period.
    pub fn period(&self, period: &Interval) -> Rc<Cell> {
        Cell::new(Interval::int(0, self.precision).hull(&period.ceiling()), 0)
    }

    /// Numbers, evaluated.
    pub fn values(&self) -> Values {
        let mut values = Values(vec![self.none.clone(); self.formulas.size()]);
        for id in (0..self.formulas.size()).map(Id).filter(|id| self.formulas.depends(*id) == 0) {
            values.0[id.0] = self.apply(id, |operand| values.0[operand.0].clone());
        }
        values
    }

    /// The value of a number.
    pub fn number(&self, id: Id, values: &Values) -> Interval {
        values.0.get(id.0).unwrap_or(&self.none).clone()
    }

    /// What has to be computed for these nodes.
    pub fn program(&self, roots: &[Id]) -> Program {
        let needed = self.formulas.below(roots).into_iter().filter(|id| self.formulas.depends(*id) != 0);
        let (time, rest) = needed.partition(|id| self.formulas.depends(*id) == Axis::Time.bit());
        Program { time, rest }
    }

    /// Computes the nodes of a program on a box: a cell of t, v_j in `states`, and `rest`, e and the parameters.
    pub fn run(
        &self,
        program: &Program,
        at: At,
        cell: &Cell,
        states: &[Interval],
        rest: &[Interval],
        values: &mut Values,
    ) {
        let mut on_cell = cell.values[at as usize].borrow_mut();
        for id in &program.time {
            let place = self.places[id.0];
            if on_cell.len() <= place {
                on_cell.resize(place + 1, None);
            }
            if on_cell[place].is_none() {
                let value = match &self.formulas.node(*id).kind {
                    Kind::Leaf(leaf) => self.timed(*leaf, at, cell),
                    _ => self.apply(*id, |operand| self.value(operand, &on_cell, values)),
                };
                on_cell[place] = Some(value);
            }
        }
        for id in &program.rest {
            let value = match &self.formulas.node(*id).kind {
                Kind::Leaf(Leaf::State(j)) => states.get(*j).unwrap_or(&self.none).clone(),
                Kind::Leaf(Leaf::Output) => rest.first().unwrap_or(&self.none).clone(),
                Kind::Leaf(Leaf::Parameter(i)) => rest.get(1 + i).unwrap_or(&self.none).clone(),
                Kind::Leaf(Leaf::Drift(_)) => self.drift.clone(),
                Kind::Leaf(_) => self.none.clone(),
                Kind::Sign(a) => self.find(*a, &on_cell, values).sign(),
                Kind::Apply(op, [a, b]) => {
                    interval_op(op, self.find(*a, &on_cell, values), self.find(*b, &on_cell, values))
                }
            };
            values.0[id.0] = value;
        }
    }

    /// The value of a node after [`Machine::run`].
    pub fn get(&self, id: Id, at: At, cell: &Cell, values: &Values) -> Interval {
        self.value(id, &cell.values[at as usize].borrow(), values)
    }

    fn find<'v>(&'v self, id: Id, on_cell: &'v [Option<Interval>], values: &'v Values) -> &'v Interval {
        if self.formulas.depends(id) == Axis::Time.bit() {
            return on_cell.get(self.places[id.0]).and_then(Option::as_ref).unwrap_or(&self.none);
        }
        &values.0[id.0]
    }

    fn value(&self, id: Id, on_cell: &[Option<Interval>], values: &Values) -> Interval {
        self.find(id, on_cell, values).clone()
    }

    /// A node that is no leaf.
    fn apply(&self, id: Id, value: impl Fn(Id) -> Interval) -> Interval {
        match &self.formulas.node(id).kind {
            Kind::Leaf(_) => self.none.clone(),
            Kind::Sign(a) => value(*a).sign(),
            Kind::Apply(op, [a, b]) => match op.operands() {
                0 => interval_op(op, &self.none, &self.none),
                1 => interval_op(op, &value(*a), &self.none),
                _ => interval_op(op, &value(*a), &value(*b)),
            },
        }
    }

    /// A leaf that depends on t.
    fn timed(&self, leaf: Leaf, at: At, cell: &Cell) -> Interval {
        let (table, order) = match leaf {
            Leaf::Time if at == At::Middle => return cell.middle.clone(),
            Leaf::Time => return cell.all.clone(),
            Leaf::Orbit { state, order } => (self.orbit.get(state), order),
            Leaf::Lyapunov { which, entry: [i, j], order } => {
                (self.lyapunov.get(which).and_then(|rows| rows.get(i)?.get(j)), order)
            }
            Leaf::State(_) | Leaf::Output | Leaf::Parameter(_) | Leaf::Drift(_) => (None, 0),
        };
        let Some(table) = table else { return self.none.clone() };
        let waves = cell.waves.get_or_init(|| waves(&self.om, &cell.middle, self.count));
        let value = |order| {
            let mut known = cell.derivatives.borrow_mut();
            known.entry(leaf.of_order(order)).or_insert_with(|| table.at(order, waves, self.precision)).clone()
        };
        if at == At::Middle {
            return value(order);
        }
        let values: Vec<Interval> = (order..order + TERMS).map(value).collect();
        table.around(order, &values, &cell.all.half_width())
    }
}
