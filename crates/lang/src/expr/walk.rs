//! Evaluation of many formulas at once, by one walk over what they need.

use super::PlantVariable;
use super::formulas::{Formula, Formulas, Operations, Term};
use rug::Rational;

/// A set of variables of a plant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct VariableSet(u128);

impl VariableSet {
    /// None.
    pub const NONE: VariableSet = VariableSet(0);
    /// All of them.
    pub const ALL: VariableSet = VariableSet(u128::MAX);
    /// The states, e and the parameters.
    pub const ALL_BUT_TIME: VariableSet = VariableSet(u128::MAX - 1);

    /// One variable. There are at most [`super::MAX_STATES`] states and [`super::MAX_VARIED`] parameters, which 118 and 8 places
    /// hold; more would share the last one.
    #[must_use]
    pub fn of(variable: PlantVariable) -> VariableSet {
        let place = match variable {
            PlantVariable::Time => 0,
            PlantVariable::Error => 1,
            PlantVariable::State(index) => (2 + index).min(119),
            PlantVariable::Parameter(index) => (120 + index).min(127),
        };
        VariableSet(1 << place)
    }

    /// The variables of either.
    #[must_use]
    pub fn and(self, other: VariableSet) -> VariableSet {
        VariableSet(self.0 | other.0)
    }

    /// Whether the two have a variable in common.
    #[must_use]
    pub fn meets(self, other: VariableSet) -> bool {
        self.0 & other.0 != 0
    }

    /// Whether the variable is in it.
    #[must_use]
    pub fn has(self, variable: PlantVariable) -> bool {
        self.meets(VariableSet::of(variable))
    }
}

/// What some formulas need, in an order in which each follows its operands.
#[derive(Clone, Debug)]
pub struct Walk {
    terms: Vec<Term>,
    numbers: Vec<Rational>,
    outputs: Vec<usize>,
    /// The variables that each term depends on.
    variables: Vec<VariableSet>,
}

/// The values of a walk's terms, kept from one evaluation to the next as far as the variables have not changed.
#[derive(Clone, Debug)]
pub struct Memory<V> {
    values: Vec<Option<V>>,
}

impl<V> Default for Memory<V> {
    fn default() -> Memory<V> {
        Memory { values: Vec::new() }
    }
}

impl Formulas {
    /// Prepares the evaluation of some formulas, in their order.
    #[must_use]
    pub fn walk(&self, outputs: &[Formula]) -> Walk {
        let needed = self.reachable(outputs);
        let mut places = vec![usize::MAX; needed.len()];
        let mut terms = Vec::new();
        let mut variables: Vec<VariableSet> = Vec::new();
        // Operands come first and are needed, so their places are known.
        let moved = |places: &[usize], formula: Formula| Formula(places[formula.0]);
        for id in (0..needed.len()).filter(|&id| needed[id]) {
            let term = match self.terms()[id] {
                Term::Unary(operation, a) => Term::Unary(operation, moved(&places, a)),
                Term::Binary(operation, a, b) => Term::Binary(operation, moved(&places, a), moved(&places, b)),
                Term::Power(a, exponent) => Term::Power(moved(&places, a), exponent),
                Term::Step(a) => Term::Step(moved(&places, a)),
                leaf => leaf,
            };
            let own = match term {
                Term::Variable(variable) => VariableSet::of(variable),
                _ => VariableSet::NONE,
            };
            let all = term.operands().into_iter().flatten().fold(own, |all, operand| all.and(variables[operand.0]));
            places[id] = terms.len();
            terms.push(term);
            variables.push(all);
        }
        let outputs = outputs.iter().map(|output| places[output.0]).collect();
        Walk { terms, numbers: self.numbers().to_vec(), outputs, variables }
    }
}

impl Walk {
    /// The variables that the outputs depend on together.
    #[must_use]
    pub fn all_variables(&self) -> VariableSet {
        self.outputs.iter().fold(VariableSet::NONE, |all, &place| all.and(self.variables[place]))
    }

    /// The values of the outputs.
    pub fn evaluate<A: Operations>(&self, algebra: &mut A) -> Vec<A::Value> {
        self.evaluate_again(algebra, &mut Memory::default(), VariableSet::ALL)
    }

    /// The values of the outputs, computing again only what depends on the variables that have changed since `memory` was
    /// used last. The memory must have been used with this walk and with algebras that agree on everything else.
    pub fn evaluate_again<A: Operations>(
        &self,
        algebra: &mut A,
        memory: &mut Memory<A::Value>,
        changed: VariableSet,
    ) -> Vec<A::Value> {
        let values = &mut memory.values;
        if values.len() != self.terms.len() {
            values.clear();
            values.resize_with(self.terms.len(), || None);
        }
        for (id, term) in self.terms.iter().enumerate() {
            if values[id].is_some() && !self.variables[id].meets(changed) {
                continue;
            }
            // A term's operands have smaller numbers, so their values stand.
            let at = |formula: &Formula| values[formula.0].as_ref().expect("operands precede their operation");
            let value = match term {
                Term::Number(index) => algebra.number(&self.numbers[*index]),
                Term::Pi => algebra.pi(),
                Term::Variable(variable) => algebra.variable(*variable),
                Term::Unary(operation, a) => algebra.unary(*operation, at(a)),
                Term::Binary(operation, a, b) => algebra.binary(*operation, at(a), at(b)),
                Term::Power(base, exponent) => algebra.power(at(base), *exponent),
                Term::Step(a) => algebra.step(at(a)),
            };
            values[id] = Some(value);
        }
        self.outputs.iter().map(|&output| values[output].clone().expect("every term has its value")).collect()
    }
}
