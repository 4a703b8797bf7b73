//! Flat evaluation of a plant's right sides in double precision.

use super::float::{binary, unary};
use super::formulas::{Formula, Formulas};
use super::graph::{Graph, Id, Term, operands, step};
use super::syntax::{Binary, Unary};
use super::{MAX_VARIED, PlantExpr, PlantVariable};
use std::sync::Arc;

/// An operation; the frequent ones stand by themselves, so that the loop over them makes no calls.
#[derive(Clone, Copy, Debug)]
enum Operation {
    Add,
    Sub,
    Mul,
    Div,
    Neg,
    Unary(Unary),
    Binary(Binary),
    Step,
}

impl Operation {
    fn of_one(operation: Unary) -> Operation {
        match operation {
            Unary::Neg => Operation::Neg,
            other => Operation::Unary(other),
        }
    }

    fn of_two(operation: Binary) -> Operation {
        match operation {
            Binary::Add => Operation::Add,
            Binary::Sub => Operation::Sub,
            Binary::Mul => Operation::Mul,
            Binary::Div => Operation::Div,
            other => Operation::Binary(other),
        }
    }
}

/// One operation on slots; its result goes to the next slot.
#[derive(Clone, Copy, Debug)]
struct Instruction {
    operation: Operation,
    a: u32,
    b: u32,
}

/// What a sine, a power or the like costs, in additions.
const FUNCTION_WEIGHT: usize = 10;

/// Several expressions of a plant, compiled together: equal parts are computed once, and what depends on the time
/// alone is computed once for each time.
///
/// Double precision without guarantees: it serves simulations, never claims. Undefined values are NaN or, where
/// floating point has a limit for them (1/0), infinities. Elementary functions are the same on every machine.
#[derive(Clone, Debug)]
pub struct Program {
    states: usize,
    /// What the slots hold at the start: constants, then room for t, the states, e, the parameters and the results.
    slots: Vec<f64>,
    /// The slot of t; the states, e and the parameters follow it.
    time: usize,
    time_code: Vec<Instruction>,
    code: Vec<Instruction>,
    /// The slots computed from the time alone that `code` or the outputs read.
    time_results: Vec<u32>,
    outputs: Vec<u32>,
    /// How much of `code` the first outputs take: none of them, the first one, the first two, ...
    lengths: Vec<usize>,
}

impl Program {
    /// The values of some expressions of a plant with `states` states, in their order.
    #[must_use]
    pub fn values(outputs: &[&PlantExpr], states: usize) -> Program {
        let mut formulas = Formulas::new();
        let outputs: Vec<Formula> = outputs.iter().map(|output| formulas.insert(output)).collect();
        Program::of_formulas(&formulas, &outputs, states)
    }

    /// The values, followed by the derivatives of all expressions with respect to the first state, the second, ...,
    /// and e: `(1 + states + 1)` blocks.
    #[must_use]
    pub fn with_derivatives(outputs: &[&PlantExpr], states: usize) -> Program {
        let mut formulas = Formulas::new();
        let values: Vec<Formula> = outputs.iter().map(|output| formulas.insert(output)).collect();
        let mut all = values.clone();
        for variable in (0..states).map(PlantVariable::State).chain([PlantVariable::Error]) {
            all.extend(formulas.derivatives(&values, variable));
        }
        Program::of_formulas(&formulas, &all, states)
    }

    /// The values of some formulas of a plant with `states` states, in their order. Where min, max or abs have a corner, a
    /// derivative is that of one side.
    #[must_use]
    pub fn of_formulas(formulas: &Formulas, outputs: &[Formula], states: usize) -> Program {
        let mut graph = Graph::default();
        let outputs = formulas.walk(outputs).evaluate(&mut graph);
        Program::compile(&graph, &outputs, states)
    }

    fn compile(graph: &Graph, outputs: &[Id], states: usize) -> Program {
        let terms = graph.terms();
        let first = first_output(terms, outputs);
        let needed: Vec<bool> = first.iter().map(|output| *output < outputs.len()).collect();
        let mut timely = vec![true; terms.len()];
        for (id, &term) in terms.iter().enumerate() {
            timely[id] = match term {
                Term::Variable(variable) => variable == PlantVariable::Time,
                _ => operands(term).all(|operand| timely[operand]),
            };
        }
        let mut slot = vec![0_u32; terms.len()];
        let mut slots = Vec::new();
        for id in (0..terms.len()).filter(|&id| needed[id]) {
            if let Term::Number(bits) = terms[id] {
                slot[id] = slots.len() as u32;
                slots.push(f64::from_bits(bits));
            }
        }
        let time = slots.len();
        for (id, term) in terms.iter().enumerate() {
            if let Term::Variable(variable) = term {
                let offset = match variable {
                    PlantVariable::Time => 0,
                    PlantVariable::State(index) => 1 + index,
                    PlantVariable::Error => 1 + states,
                    PlantVariable::Parameter(index) => 2 + states + (*index).min(MAX_VARIED - 1),
                };
                slot[id] = (time + offset) as u32;
            }
        }
        slots.resize(time + states + 2 + MAX_VARIED, 0.0);
        let [time_code, code] = [true, false].map(|wanted| {
            let mut code = Vec::new();
            // What the first outputs take comes first; no operand of it comes later.
            let mut own: Vec<Id> = (0..terms.len()).filter(|&id| needed[id] && timely[id] == wanted).collect();
            own.sort_by_key(|&id| first[id]);
            for id in own {
                let instruction = match terms[id] {
                    Term::Number(_) | Term::Variable(_) => continue,
                    Term::Unary(operation, a) => (Operation::of_one(operation), a, a),
                    Term::Step(a) => (Operation::Step, a, a),
                    Term::Binary(operation, a, b) => (Operation::of_two(operation), a, b),
                };
                let (operation, a, b) = instruction;
                slot[id] = slots.len() as u32;
                slots.push(0.0);
                code.push(Instruction { operation, a: slot[a], b: slot[b] });
            }
            code
        });
        let computed = |id: &Id| timely[*id] && !matches!(terms[*id], Term::Number(_));
        let read = (0..terms.len()).filter(|&id| needed[id] && !timely[id]).flat_map(|id| operands(terms[id]));
        let mut time_results: Vec<u32> =
            read.chain(outputs.iter().copied()).filter(computed).map(|id| slot[id]).collect();
        time_results.sort_unstable();
        time_results.dedup();
        let is_code =
            |id: &Id| needed[*id] && !timely[*id] && !matches!(terms[*id], Term::Number(_) | Term::Variable(_));
        let mut of_code: Vec<usize> = (0..terms.len()).filter(is_code).map(|id| first[id]).collect();
        of_code.sort_unstable();
        let lengths = (0..=outputs.len()).map(|count| of_code.partition_point(|first| *first < count)).collect();
        let outputs = outputs.iter().map(|&output| slot[output]).collect();
        Program { states, slots, time, time_code, code, time_results, outputs, lengths }
    }

    /// This program with these values of the parameters, at which it is evaluated unless others are set; 0 without.
    #[must_use]
    pub fn with_parameters(mut self, values: &[f64]) -> Program {
        let first = self.time + self.states + 2;
        self.slots[first..first + MAX_VARIED].iter_mut().zip(values).for_each(|(slot, value)| *slot = *value);
        self
    }

    /// The number of outputs.
    #[must_use]
    pub fn outputs(&self) -> usize {
        self.outputs.len()
    }

    /// The number of operations of one evaluation, those that depend on the time alone among them; an elementary function
    /// counts as `FUNCTION_WEIGHT` additions.
    #[must_use]
    pub fn operations(&self) -> usize {
        let weight = |instruction: &Instruction| match instruction.operation {
            Operation::Unary(_) | Operation::Binary(_) => FUNCTION_WEIGHT,
            _ => 1,
        };
        self.time_code.iter().chain(&self.code).map(weight).sum()
    }

    /// The number of values that [`Evaluator::time_values`] gives.
    #[must_use]
    pub fn time_values(&self) -> usize {
        self.time_results.len()
    }
}

/// The first of the outputs that needs each term; that after the last one where none does.
fn first_output(terms: &[Term], outputs: &[Id]) -> Vec<usize> {
    let mut first = vec![outputs.len(); terms.len()];
    for (index, &output) in outputs.iter().enumerate().rev() {
        first[output] = index;
    }
    for id in (0..terms.len()).rev() {
        for operand in operands(terms[id]) {
            first[operand] = first[operand].min(first[id]);
        }
    }
    first
}

/// A program with the memory that it works in.
#[derive(Clone, Debug)]
pub struct Evaluator {
    program: Arc<Program>,
    slots: Vec<f64>,
}

impl Evaluator {
    /// Memory for a program.
    #[must_use]
    pub fn new(program: Arc<Program>) -> Evaluator {
        let slots = program.slots.clone();
        Evaluator { program, slots }
    }

    /// Sets the parameters of which intervals are known.
    pub fn set_parameters(&mut self, values: &[f64]) {
        let first = self.program.time + self.program.states + 2;
        self.slots[first..first + MAX_VARIED].iter_mut().zip(values).for_each(|(slot, value)| *slot = *value);
    }

    /// Sets the time and computes what depends on it alone.
    pub fn set_time(&mut self, t: f64) {
        let program = &self.program;
        self.slots[program.time] = t;
        let first = program.time + program.states + 2 + MAX_VARIED;
        run(&program.time_code, first, &mut self.slots);
    }

    /// Appends what the last [`Evaluator::set_time`] computed, as far as anything else reads it.
    pub fn time_values(&self, row: &mut Vec<f64>) {
        row.extend(self.program.time_results.iter().map(|&slot| self.slots[slot as usize]));
    }

    /// Restores what [`Evaluator::time_values`] gave, in place of [`Evaluator::set_time`]; `row` has the length
    /// [`Program::time_values`].
    #[inline]
    pub fn load_time_values(&mut self, row: &[f64]) {
        for (&slot, &value) in self.program.time_results.iter().zip(row) {
            self.slots[slot as usize] = value;
        }
    }

    /// Evaluates at a state and an error, at the time set before. `states` has the plant's dimension, `outputs` the
    /// length [`Program::outputs`], or less where the first outputs alone are asked for.
    #[inline]
    pub fn evaluate(&mut self, states: &[f64], e: f64, outputs: &mut [f64]) {
        let program = &*self.program;
        let first = program.time + 1;
        self.slots[first..first + program.states].copy_from_slice(states);
        self.slots[first + program.states] = e;
        let results = first + program.states + 1 + MAX_VARIED + program.time_code.len();
        let length = program.lengths.get(outputs.len()).copied().unwrap_or(program.code.len());
        run(&program.code[..length], results, &mut self.slots);
        for (output, &slot) in outputs.iter_mut().zip(&program.outputs) {
            *output = self.slots[slot as usize];
        }
    }
}

/// Runs instructions whose results go to the slots from `first` on.
#[inline]
fn run(code: &[Instruction], first: usize, slots: &mut [f64]) {
    for (offset, instruction) in code.iter().enumerate() {
        let (a, b) = (slots[instruction.a as usize], slots[instruction.b as usize]);
        slots[first + offset] = match instruction.operation {
            Operation::Add => a + b,
            Operation::Sub => a - b,
            Operation::Mul => a * b,
            Operation::Div => a / b,
            Operation::Neg => -a,
            Operation::Unary(operation) => unary(operation, a),
            Operation::Binary(operation) => binary(operation, a, b),
            Operation::Step => step(a),
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::PlantNames;

    fn expr(text: &str) -> PlantExpr {
        let names = PlantNames::new(vec!["x".to_owned(), "y".to_owned()]).unwrap();
        PlantExpr::parse(text, &names).unwrap_or_else(|error| panic!("{text}: {error}"))
    }

    fn all(program: Program, t: f64, x: [f64; 2], e: f64) -> Vec<f64> {
        let mut outputs = vec![0.0; program.outputs()];
        let mut evaluator = Evaluator::new(Arc::new(program));
        evaluator.set_time(t);
        evaluator.evaluate(&x, e, &mut outputs);
        outputs
    }

    /// With exponents k/2^m a power is made of roots: its value and its derivative are those of the power, below 0 and at 0 too.
    #[test]
    fn powers_by_roots_are_powers() {
        for (exponent, value) in
            [("1/4", 0.25_f64), ("-3/2", -1.5), ("5/8", 0.625), ("-1/16", -0.0625), ("1/32", 0.03125)]
        {
            let power = expr(&format!("x^({exponent})"));
            let at = |x: f64| all(Program::with_derivatives(&[&power], 2), 0.0, [x, 0.0], 0.0);
            for x in [1e-12, 0.3, 1.0, 7.0, 1e9] {
                let [found, slope, ..] = at(x)[..] else { panic!("{exponent}") };
                let [power, derivative] = [x.powf(value), value * x.powf(value - 1.0)];
                assert!((found / power - 1.0).abs() < 1e-14, "{x}^({exponent}): {found} {power}");
                assert!((slope / derivative - 1.0).abs() < 1e-13, "{x}^({exponent}): {slope} {derivative}");
            }
            assert!(at(-1.0)[0].is_nan());
            assert_eq!(at(0.0)[0].is_finite(), value > 0.0, "{exponent}");
        }
    }

    const EXPRESSIONS: [&str; 15] = [
        "x*y - e/x + t",
        "sin(x*t) + cos(y)^3 - 2*x^-2",
        "exp(-x^2) + log(1 + y^2)",
        "sqrt(1 + x^2 + e^2)",
        "tan(x/3) + tanh(e*y)",
        "atan(e*y) + abs(x - y)",
        "max(x, y, e) + min(x*y, e)",
        "(1 + x^2)^(y/2)",
        "2^x + (2 + sin(t))^e",
        "-(x - y)*-e",
        "cos(2*pi*t) + cos(2*pi*t)^4",
        "0*x + t",
        "pi",
        "exprelr(x - 0.7) + y*exprelr(3*x + e)",
        "sinc(x - 0.7) + y*sinc(3*x + e)",
    ];

    #[test]
    fn values_are_those_of_the_formulas() {
        let (t, x, y, e) = (0.3_f64, 0.7_f64, -1.2_f64, 0.4_f64);
        let expected = [
            x * y - e / x + t,
            (x * t).sin() + y.cos().powi(3) - 2.0 / (x * x),
            (-x * x).exp() + (1.0 + y * y).ln(),
            (1.0 + x * x + e * e).sqrt(),
            (x / 3.0).tan() + (e * y).tanh(),
            (e * y).atan() + (x - y).abs(),
            x.max(y).max(e) + (x * y).min(e),
            (1.0 + x * x).powf(y / 2.0),
            2_f64.powf(x) + (2.0 + t.sin()).powf(e),
            (x - y) * e,
            (std::f64::consts::TAU * t).cos() + (std::f64::consts::TAU * t).cos().powi(4),
            t,
            std::f64::consts::PI,
            1.0 + y * (3.0 * x + e) / (3.0 * x + e).exp_m1(),
            1.0 + y * (3.0 * x + e).sin() / (3.0 * x + e),
        ];
        let parsed: Vec<PlantExpr> = EXPRESSIONS.iter().map(|text| expr(text)).collect();
        let parsed: Vec<&PlantExpr> = parsed.iter().collect();
        let values = all(Program::values(&parsed, 2), t, [x, y], e);
        for ((text, value), expected) in EXPRESSIONS.iter().zip(values).zip(expected) {
            assert!((value - expected).abs() < 1e-14 * (1.0 + expected.abs()), "{text}: {value} {expected}");
        }
    }

    #[test]
    fn derivatives_agree_with_difference_quotients() {
        let parsed: Vec<PlantExpr> = EXPRESSIONS.iter().map(|text| expr(text)).collect();
        let parsed: Vec<&PlantExpr> = parsed.iter().collect();
        let n = parsed.len();
        for (t, x, y, e) in [(0.3, 0.7, -1.2, 0.4), (1.1, -0.4, 0.9, -2.0)] {
            let exact = all(Program::with_derivatives(&parsed, 2), t, [x, y], e);
            let h = 1e-6;
            for (block, shift) in [[h, 0.0, 0.0], [0.0, h, 0.0], [0.0, 0.0, h]].iter().enumerate() {
                let at = |sign: f64| {
                    let program = Program::values(&parsed, 2);
                    all(program, t, [x + sign * shift[0], y + sign * shift[1]], e + sign * shift[2])
                };
                let (up, down) = (at(1.0), at(-1.0));
                for (i, text) in EXPRESSIONS.iter().enumerate() {
                    let quotient = (up[i] - down[i]) / (2.0 * h);
                    let derivative = exact[n * (1 + block) + i];
                    let error = (quotient - derivative).abs();
                    assert!(error < 1e-8 * (1.0 + derivative.abs()), "{text} {block}: {derivative} {quotient}");
                }
            }
        }
    }

    #[test]
    fn what_depends_on_the_time_alone_can_be_kept() {
        let (f, g) = (expr("x*sin(t) + cos(t)^2*e + 3"), expr("sin(t)"));
        let program = Arc::new(Program::values(&[&f, &g], 2));
        assert_eq!(program.time_values(), 2);
        let mut first = Evaluator::new(program.clone());
        first.set_time(0.8);
        let mut row = Vec::new();
        first.time_values(&mut row);
        let mut second = Evaluator::new(program);
        second.load_time_values(&row);
        let (mut a, mut b) = ([0.0; 2], [0.0; 2]);
        first.evaluate(&[1.5, 0.0], -0.5, &mut a);
        second.evaluate(&[1.5, 0.0], -0.5, &mut b);
        assert_eq!(a, b);
    }

    /// Those that are left out are not computed, and the others are the same.
    #[test]
    fn the_first_outputs_alone() {
        let parsed: Vec<PlantExpr> = EXPRESSIONS.iter().map(|text| expr(text)).collect();
        let parsed: Vec<&PlantExpr> = parsed.iter().collect();
        let program = Arc::new(Program::with_derivatives(&parsed, 2));
        let mut evaluator = Evaluator::new(program.clone());
        evaluator.set_time(0.3);
        let mut all = vec![0.0; program.outputs()];
        evaluator.evaluate(&[0.7, -1.2], 0.4, &mut all);
        for count in 0..=program.outputs() {
            let mut evaluator = Evaluator::new(program.clone());
            evaluator.set_time(0.3);
            let mut first = vec![f64::NAN; count];
            evaluator.evaluate(&[0.7, -1.2], 0.4, &mut first);
            assert_eq!(first, all[..count]);
        }
        assert_eq!((program.lengths[0], program.lengths[program.outputs()]), (0, program.code.len()));
        assert!(program.lengths.is_sorted() && program.lengths[1] < program.code.len());
    }

    #[test]
    fn equal_parts_are_computed_once() {
        let f = expr("sin(x*y) + sin(x*y)^2 + 2*sin(x*y)");
        // x*y, its sine, the square, the double and two sums.
        assert_eq!(Program::values(&[&f], 2).code.len(), 6);
        assert_eq!(Program::values(&[&expr("sqrt(4)*pi - 1")], 2).code.len(), 0);
    }

    #[test]
    fn undefined_values_are_not_numbers() {
        let values = |text: &str| all(Program::values(&[&expr(text)], 2), 0.0, [-1.0, 2.0], 0.0)[0];
        for text in ["sqrt(x)", "log(x)", "x^y", "max(1, sqrt(x))", "0*sqrt(x)"] {
            assert!(values(text).is_nan(), "{text}");
        }
        assert_eq!(values("x^2"), 1.0);
    }
}
