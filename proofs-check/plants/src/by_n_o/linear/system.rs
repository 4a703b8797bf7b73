//! A plant that is linear in x and e, read off its formulas (docs/mathematics.md, section 14.3): `f = A x + b_e e + f_0(t)`,
//! `q = c x + d e + q_0(t)`, in the coordinates `y = L^-1 x` of the claim.
//!
//! Guarantee of [`System::new`]: no derivative of the formulas by x or e depends on t, x or e, and what the operations of the formulas ask of their
//! operands does not either. That is proved where the formulas are used ([`crate::smooth`]); so they are defined and smooth at every x and e, the
//! derivatives are constant there, and f and q are of that form, with f_0 and q_0 what they are at x = 0, e = 0.

use super::ring::{Harmonics, Reading};
use crate::form::of_output;
use crate::formula::{Axis, Demand, Id, Leaf};
use crate::machine::{At, Cell, Curves, Machine, Program, Values};
use crate::model::{Frame, Model};
use crate::read::{MAX_STATES, Plant};
use crate::too_large;
use proofs_core::exact::Exact;
use proofs_core::interval::Interval;
use proofs_core::rules::by_n_o::claimed::RULE;
use proofs_core::verdict::{Outcome, Verdict, finding};
use std::rc::Rc;

/// The formulas of such a plant.
pub struct System {
    /// The formulas with the derivatives by x and e.
    pub model: Model,
    /// J by rows, g, r and d, one after the other, and the same of each parameter's derivatives.
    parts: Vec<Vec<Id>>,
    /// The components of `L^-1 f_0`, and q_0, and the same of each parameter's derivatives.
    forcing: Vec<Vec<Id>>,
    /// What makes all of them continuously differentiable in the parameters.
    corners: Vec<(Id, Demand)>,
    /// The parameters on which anything depends.
    pub parameters: Vec<usize>,
    states: usize,
}

/// The numbers of a system for some parameters.
pub struct Numbers {
    /// J by rows, g, r and d.
    pub parts: Vec<Interval>,
    /// The components of `L^-1 f_0`, and q_0.
    pub forcing: Vec<Harmonics>,
}

impl System {
    /// From a plant.
    pub fn new(plant: &Plant) -> Outcome<System> {
        let states = plant.states();
        let mut model = Model::new(plant, Frame::Still);
        let column = of_output(&mut model);
        let slope = model.formulas.derivative(model.q, Axis::Output);
        let of_f: Vec<Id> = model.jacobian.iter().flatten().chain(&column).copied().collect();
        let of_q: Vec<Id> = model.row.iter().copied().chain([slope]).collect();

        // At x = 0 and e = 0; t and the parameters stay.
        let formulas = &mut model.formulas;
        let zero = formulas.int(0);
        let mut variables = vec![formulas.leaf(Leaf::Time), zero];
        variables.extend(vec![zero; states]);
        variables.extend((0..plant.known.parameters.len()).map(|i| formulas.leaf(Leaf::Parameter(i))));
        let mut at_rest = |expr| formulas.read(expr, &variables, &mut Vec::new());
        let f: Vec<Id> = plant.f.iter().map(|formula| at_rest(&formula.expr)).collect();
        let q = at_rest(&plant.q.expr);
        let mut forcing: Vec<Id> = Vec::new();
        for row in &plant.known.coordinates.inverse {
            let row: Vec<Id> = row.iter().map(|value| formulas.number(value)).collect();
            forcing.push(formulas.dot(row.into_iter().zip(f.iter().copied())));
        }
        forcing.push(q);

        let parts = [of_f.clone(), of_q.clone()].concat();
        let all = |depends: u16, ids: &[Id]| ids.iter().fold(depends, |all, id| all | model.formulas.depends(*id));
        let depends = all(all(0, &parts), &forcing);
        let parameters: Vec<usize> =
            (0..plant.known.parameters.len()).filter(|i| depends & Axis::Parameter(*i).bit() != 0).collect();
        let mut with_slopes = |ids: Vec<Id>| {
            let formulas = &mut model.formulas;
            let along: Vec<Vec<Id>> = parameters
                .iter()
                .map(|i| ids.iter().map(|id| formulas.derivative(*id, Axis::Parameter(*i))).collect())
                .collect();
            [vec![ids], along].concat()
        };
        let (parts, forcing) = (with_slopes(parts), with_slopes(forcing));
        let corners = model.formulas.corners(&[parts[0].as_slice(), &forcing[0]].concat());
        if model.formulas.is_too_large() {
            return too_large(RULE, "/plant");
        }
        let system = System { model, parts, forcing, corners, parameters, states };
        system.demand_linear([&of_f, &of_q], &plant.q.pointer)?;
        Ok(system)
    }

    fn demand_linear(&self, [of_f, of_q]: [&[Id]; 2], of_output: &str) -> Outcome<()> {
        let states = (0..MAX_STATES).fold(0, |all, j| all | Axis::State(j).bit());
        let moving = states | Axis::Time.bit() | Axis::Output.bit();
        let moves = |id: &Id| self.model.formulas.depends(*id) & moving != 0;
        let undecided = |pointer: &str, what: &str| {
            let message = format!("it is not seen that the plant is linear in x and e: {what} may depend on t, x or e");
            Err(finding(Verdict::Undecided, RULE, pointer, message))
        };
        if of_f.iter().any(moves) {
            return undecided("/plant/f", "a derivative of f by x or e");
        }
        if of_q.iter().any(moves) {
            return undecided(of_output, "a derivative of q by x or e");
        }
        if self.model.demands.iter().any(|(id, _)| moves(id)) {
            return undecided("/plant", "whether an operation of the formulas is defined");
        }
        Ok(())
    }

    /// The number of states.
    pub fn states(&self) -> usize {
        self.states
    }
}

/// A system with what evaluates it at one precision.
pub struct Evaluator<'s> {
    system: &'s System,
    machine: Machine<'s>,
    /// Any cell of t: nothing that is computed depends on t.
    cell: Rc<Cell>,
    period: &'s Exact,
    program: Program,
    values: Values,
}

impl<'s> Evaluator<'s> {
    /// At the precision of Om; the period is known exactly.
    pub fn new(system: &'s System, period: &'s Exact, om: &Interval) -> Evaluator<'s> {
        let formulas = &system.model.formulas;
        let machine = Machine::new(formulas, &Curves { orbit: Vec::new(), lyapunov: Vec::new() }, om);
        let roots = system.parts.iter().chain(&system.forcing).flatten().copied();
        let roots: Vec<Id> = roots.chain(system.corners.iter().map(|(id, _)| *id)).collect();
        let free = |id: &Id| formulas.depends(*id) & Axis::Time.bit() == 0;
        let free: Vec<Id> = formulas.below(&roots).into_iter().filter(free).collect();
        let (cell, values) = (machine.period(om), machine.values());
        Evaluator { program: machine.program(&free), system, cell, period, values, machine }
    }

    fn run(&mut self, parameters: &[Interval]) {
        let zero = Interval::int(0, self.machine.precision);
        let rest: Vec<Interval> = [zero].into_iter().chain(parameters.iter().cloned()).collect();
        self.machine.run(&self.program, At::Box, &self.cell, &[], &rest, &mut self.values);
    }

    /// The numbers of the system, or of its derivative along a parameter that counts, for these parameters. None where f_0 or q_0 is no
    /// trigonometric polynomial by its form.
    fn numbers(&self, which: usize) -> Option<Numbers> {
        let value = |id: Id| self.machine.get(id, At::Box, &self.cell, &self.values);
        let parts = self.system.parts.get(which)?.iter().map(|id| value(*id)).collect();
        let reading =
            Reading { formulas: self.machine.formulas, period: self.period, precision: self.machine.precision, value };
        Some(Numbers { parts, forcing: reading.read(self.system.forcing.get(which)?)? })
    }

    /// The harmonics of the forcing that are not exactly 0 for all of these parameters, in order.
    pub fn harmonics(&mut self, parameters: &[Interval]) -> Option<Vec<usize>> {
        self.run(parameters);
        self.numbers(0).map(|numbers| numbers.harmonics(self.machine.precision))
    }

    /// Those in the middle of a box, on the box, and of the derivatives on the box, which are none where an operation may not be smooth on it.
    pub fn on(&mut self, parameters: &[Interval]) -> Option<(Numbers, Numbers, Vec<Numbers>)> {
        self.run(&parameters.iter().map(Interval::middle).collect::<Vec<_>>());
        let middle = self.numbers(0)?;
        self.run(parameters);
        let all = self.numbers(0)?;
        let value = |id: Id| self.machine.get(id, At::Box, &self.cell, &self.values);
        let smooth = self.system.corners.iter().all(|(id, what)| what.holds(&value(*id)));
        let mut slopes: Vec<Numbers> =
            (1..=self.system.parameters.len()).map(|which| self.numbers(which)).collect::<Option<_>>()?;
        if !smooth {
            let none = Interval::undefined(self.machine.precision);
            slopes.iter_mut().for_each(|numbers| numbers.fill(&none));
        }
        Some((middle, all, slopes))
    }
}

impl Numbers {
    /// The harmonics of the forcing that are not exactly 0, in order.
    fn harmonics(&self, precision: u32) -> Vec<usize> {
        let most = self.forcing.iter().map(Harmonics::len).max().unwrap_or(0);
        let is_there = |k: &usize| self.forcing.iter().any(|part| !part.at(*k, precision).is_zero());
        (0..most).filter(is_there).collect()
    }

    fn fill(&mut self, value: &Interval) {
        self.parts.iter_mut().for_each(|part| part.clone_from(value));
        self.forcing.iter_mut().for_each(|harmonics| harmonics.fill(value));
    }
}
