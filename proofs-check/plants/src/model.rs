//! A plant's formulas in the variables of the proof: t, v with `x = xb(t) + L v`, and e (docs/mathematics.md, section 11.3); or t,
//! x, and e (section 11.6).

use super::formula::{Axis, Demand, Formulas, Id, Leaf};
use super::machine::Curves;
use super::read::Plant;
use super::time::Wave;
use proofs_core::expr::Op;
use proofs_core::jacobian::Witness;
use proofs_core::range::Span;

/// What the states of the formulas are.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Frame {
    /// v, with `x = xb(t) + L v`; and of a trial e, from what it is measured from.
    Moving,
    /// x.
    Still,
}

/// The formulas of a plant and what is made from them.
pub struct Model {
    pub formulas: Formulas,
    /// `L^-1 f`.
    pub f: Vec<Id>,
    pub q: Id,
    /// `f - xb'`, like all that are derivatives in t.
    pub apart: Vec<Id>,
    /// `L^-1 (f - xb')`: at v = 0, e = 0 the defect of the orbit.
    pub defect: Vec<Id>,
    /// `J = L^-1 f_x L`, by rows.
    pub jacobian: Vec<Vec<Id>>,
    /// `q_x L`.
    pub row: Vec<Id>,
    /// The entries of each P(t).
    pub lyapunov: Vec<Vec<Vec<Id>>>,
    /// What the operations of the formulas ask for.
    pub demands: Vec<(Id, Demand)>,
}

impl Model {
    /// From a plant and its witness.
    pub fn new(plant: &Plant, frame: Frame) -> Model {
        let order = plant.states();
        let mut formulas = Formulas::default();
        let mut demands = Vec::new();
        formulas.clock = plant.clock().map(|clock| formulas.leaf(Leaf::Parameter(clock)));
        let linear = |formulas: &mut Formulas, row: &[rug::Rational], nodes: &[Id]| {
            let numbers: Vec<Id> = row.iter().map(|value| formulas.number(value)).collect();
            formulas.dot(numbers.into_iter().zip(nodes.iter().copied()))
        };
        let states: Vec<Id> = (0..order).map(|j| formulas.leaf(Leaf::State(j))).collect();
        let mut output = formulas.leaf(Leaf::Output);
        if frame == Frame::Moving && !plant.error.is_empty() {
            let error = wave(&mut formulas, plant, order + 1, 0);
            output = formulas.make(error + output);
        }
        let mut variables = vec![formulas.leaf(Leaf::Time), output];
        for (i, row) in plant.known.coordinates.matrix.iter().enumerate() {
            let orbit = wave(&mut formulas, plant, i, 0);
            let moved = linear(&mut formulas, row, &states);
            variables.push(if frame == Frame::Moving { formulas.make(orbit + moved) } else { states[i] });
        }
        variables.extend((0..plant.known.parameters.len()).map(|i| formulas.leaf(Leaf::Parameter(i))));
        let f: Vec<Id> = plant.f.iter().map(|formula| formulas.read(&formula.expr, &variables, &mut demands)).collect();
        let q = formulas.read(&plant.q.expr, &variables, &mut demands);
        let apart: Vec<Id> = (0..order)
            .map(|i| {
                let slope = wave(&mut formulas, plant, i, 1);
                let velocity = formulas.in_time(slope);
                formulas.make(f[i] - velocity)
            })
            .collect();
        let inverse = &plant.known.coordinates.inverse;
        let defect = inverse.iter().map(|row| linear(&mut formulas, row, &apart)).collect();
        let f: Vec<Id> = inverse.iter().map(|row| linear(&mut formulas, row, &f)).collect();
        // The derivatives along y.
        let slopes = |formulas: &mut Formulas, id: Id| -> Vec<Id> {
            let along: Vec<Id> = (0..order).map(|j| formulas.derivative(id, Axis::State(j))).collect();
            if frame == Frame::Moving {
                return along;
            }
            let column = |j: usize| plant.known.coordinates.matrix.iter().map(|row| row[j].clone()).collect::<Vec<_>>();
            (0..order).map(|j| linear(formulas, &column(j), &along)).collect()
        };
        let jacobian = f.iter().map(|id| slopes(&mut formulas, *id)).collect();
        let row = slopes(&mut formulas, q);
        let matrices = plant.lyapunov.iter().enumerate();
        let lyapunov = matrices.map(|(which, w)| matrix(&mut formulas, which, w)).collect();
        Model { formulas, f, q, apart, defect, jacobian, row, lyapunov, demands }
    }

    /// The number of states.
    pub fn states(&self) -> usize {
        self.f.len()
    }
}

/// A derivative along the axis of time of a component of xb(t;p), or after them of qb(t;p), or of what e is measured from: the nominal one, and powers of
/// the numbers of the family less their nominal values, which of an orbit are of degree 1, times those of the sensitivities. Numbers stand where nothing
/// moves.
pub fn wave(formulas: &mut Formulas, plant: &Plant, which: usize, order: usize) -> Id {
    let mut sum = formulas.int(0);
    for (member, waves) in plant.waves().enumerate() {
        let part = match waves.get(which).filter(|wave| wave.is_constant()) {
            Some(wave) if order == 0 => formulas.number(&wave.mean),
            Some(_) => formulas.int(0),
            None => formulas.leaf(Leaf::Orbit { state: member * waves.len() + which, order }),
        };
        let part = match member.checked_sub(1) {
            None => part,
            Some(member) => {
                let factor = power(formulas, plant, &plant.powers[member]);
                formulas.product(factor, part)
            }
        };
        sum = formulas.make(sum + part);
    }
    sum
}

/// The product of these powers of the numbers of the family less their nominal values.
fn power(formulas: &mut Formulas, plant: &Plant, powers: &[u32]) -> Id {
    let mut product = formulas.int(1);
    for (i, (Span { nominal, .. }, n)) in plant.family.iter().zip(powers).enumerate() {
        let (nominal, value) = (formulas.number(nominal), formulas.leaf(Leaf::Parameter(i)));
        let apart = formulas.make(value - nominal);
        // Exponents are small.
        let factor = formulas.apply(&Op::Power(*n as i32), [apart, Id::NONE]);
        product = formulas.make(product * factor);
    }
    product
}

/// P(t): numbers where it is constant.
pub fn matrix(formulas: &mut Formulas, which: usize, w: &Witness) -> Vec<Vec<Id>> {
    let order = w.mean.len();
    let mut entry = |i: usize, j: usize| {
        if entry_of(w, i, j).is_constant() {
            return formulas.number(&w.mean[i][j]);
        }
        // P is symmetric: one leaf for both entries.
        formulas.leaf(Leaf::Lyapunov { which, entry: [i.max(j), i.min(j)], order: 0 })
    };
    (0..order).map(|i| (0..order).map(|j| entry(i, j)).collect()).collect()
}

fn entry_of(w: &Witness, i: usize, j: usize) -> Wave {
    let harmonics = w.harmonics.iter().map(|[cos, sin]| [cos[i][j].clone(), sin[i][j].clone()]).collect();
    Wave { mean: w.mean[i][j].clone(), harmonics }
}

/// The entries of P as trigonometric polynomials.
pub fn polynomials(w: &Witness) -> Vec<Vec<Wave>> {
    let order = w.mean.len();
    (0..order).map(|i| (0..order).map(|j| entry_of(w, i, j)).collect()).collect()
}

/// The trigonometric polynomials of a witness: the components of xb and qb, then those of each sensitivity.
pub fn curves(plant: &Plant) -> Curves {
    Curves { orbit: plant.waves().flatten().collect(), lyapunov: plant.lyapunov.iter().map(polynomials).collect() }
}
