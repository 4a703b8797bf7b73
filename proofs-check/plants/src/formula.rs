//! The formulas of a plant as one graph, in which equal parts are one node (docs/mathematics.md, section 11).
//!
//! The plant is written in the variables of the proof: the states are `x = xb(t) + L v`, so a formula is a function of t, v and e,
//! and the approximation xb of the orbit, its derivatives, and those of P are leaves that depend on t alone. Constants are
//! exact where they have an exact form. What is left out because it is 0 may have been undefined: so what each operation that is
//! written asks of its operands is written down apart, when a formula is read ([`Formulas::read`]); and what is differentiated
//! on a set is asked once more there ([`Formulas::corners`]).

use super::linear::Linear;
use super::read::MAX_STATES;
use proofs_core::exact::Exact;
use proofs_core::expr::{Expr, Op, exact_op};
use proofs_core::interval::Interval;
use rug::Rational;
use std::collections::HashMap;

/// The place of a node; its operands have smaller ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Id(pub usize);

impl Id {
    /// Stands where an operation has no operand.
    pub const NONE: Id = Id(0);
}

/// The most nodes, of the formulas and of all their derivatives.
const MAX_NODES: usize = 40_000;

/// What a formula is made from, besides numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Leaf {
    Time,
    /// v_j: the deviation from xb(t) in the coordinates of L.
    State(usize),
    /// e.
    Output,
    /// A derivative of one of the waves of [`super::model::curves`].
    Orbit {
        state: usize,
        order: usize,
    },
    /// A derivative of an entry of the first or second P(t).
    Lyapunov {
        which: usize,
        entry: [usize; 2],
        order: usize,
    },
    /// A parameter of which an interval is given, or after them the clock.
    Parameter(usize),
    /// A component of `L^-1 (x_0' - xb')`: any number between two bounds, at each t.
    Drift(usize),
}

impl Leaf {
    /// The derivative of this order of the same function of t, if it is a derivative.
    pub fn of_order(self, order: usize) -> Leaf {
        match self {
            Leaf::Orbit { state, .. } => Leaf::Orbit { state, order },
            Leaf::Lyapunov { which, entry, .. } => Leaf::Lyapunov { which, entry, order },
            other => other,
        }
    }
}

/// An axis along which derivatives are taken: t along the moving frame, a component of v, e, or a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Axis {
    Time,
    State(usize),
    Output,
    Parameter(usize),
}

impl Axis {
    /// The bit that says that a node depends on it.
    pub fn bit(self) -> u16 {
        match self {
            Axis::Time => 1,
            Axis::Output => 2,
            Axis::State(j) => 4 << j,
            Axis::Parameter(i) => (4 << MAX_STATES) << i,
        }
    }
}

/// The bit of everything that is constant along all axes, but no number.
const DRIFT: u16 = 1 << 15;

/// What a node is.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    Leaf(Leaf),
    /// An operation on nodes; operands that do not belong to it are [`Id::NONE`].
    Apply(Op, [Id; 2]),
    /// 1 or -1, where the sign is certain: the derivative of `abs`.
    Sign(Id),
}

/// A node with what it depends on.
#[derive(Clone, Debug)]
pub struct Node {
    pub kind: Kind,
    /// The bits of the axes; 0 for a number.
    pub depends: u16,
    /// The exact value of a number, where it has one.
    pub exact: Option<Exact>,
}

/// What an operation asks of a node for being smooth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Demand {
    /// It has a finite value.
    Finite,
    Nonzero,
    Positive,
}

impl Demand {
    /// Whether every number of an enclosure is so. Of one sign: an interval with numbers of both signs has 0.
    pub fn holds(self, value: &Interval) -> bool {
        match self {
            Demand::Finite => value.is_bounded(),
            Demand::Nonzero => value.is_positive() || (-value).is_positive(),
            Demand::Positive => value.is_positive(),
        }
    }
}

/// All nodes.
#[derive(Clone, Debug, Default)]
pub struct Formulas {
    nodes: Vec<Node>,
    places: HashMap<Kind, Id>,
    pub(super) derivatives: HashMap<(Id, Axis), Id>,
    /// v, with a period that is an interval ([`Formulas::in_time`]).
    pub clock: Option<Id>,
    /// Those that are sums of leaves times numbers.
    linear: HashMap<Id, Linear>,
    overflow: bool,
}

impl Formulas {
    /// The number of nodes.
    pub fn size(&self) -> usize {
        self.nodes.len()
    }

    /// Whether there were too many: then nodes are not what they should be, and nothing may be concluded from them.
    pub fn is_too_large(&self) -> bool {
        self.overflow
    }

    /// A node.
    pub fn node(&self, id: Id) -> &Node {
        &self.nodes[id.0]
    }

    /// What it depends on.
    pub fn depends(&self, id: Id) -> u16 {
        self.node(id).depends
    }

    fn insert(&mut self, kind: Kind, depends: u16, exact: Option<Exact>) -> Id {
        if let Some(id) = self.places.get(&kind) {
            return *id;
        }
        if self.nodes.len() >= MAX_NODES {
            // Any node does: whoever reads one has to ask first whether there were too many.
            self.overflow = true;
            return Id(0);
        }
        let id = Id(self.nodes.len());
        self.places.insert(kind.clone(), id);
        self.nodes.push(Node { kind, depends, exact });
        id
    }

    /// A rational number.
    pub fn number(&mut self, value: &Rational) -> Id {
        let op = Op::Number(value.clone());
        let id = self.insert(Kind::Apply(op, [Id::NONE; 2]), 0, Exact::rational(value));
        self.linear.insert(id, Linear::number(value));
        id
    }

    /// A whole number.
    pub fn int(&mut self, value: i64) -> Id {
        self.number(&Rational::from(value))
    }

    /// A leaf.
    pub fn leaf(&mut self, leaf: Leaf) -> Id {
        let depends = match leaf {
            Leaf::Time | Leaf::Orbit { .. } | Leaf::Lyapunov { .. } => Axis::Time.bit(),
            Leaf::State(j) => Axis::State(j).bit(),
            Leaf::Output => Axis::Output.bit(),
            Leaf::Parameter(i) => Axis::Parameter(i).bit(),
            Leaf::Drift(_) => DRIFT,
        };
        let id = self.insert(Kind::Leaf(leaf), depends, None);
        self.linear.insert(id, Linear::leaf(id.0));
        id
    }

    /// The sign of a node.
    pub(super) fn sign(&mut self, a: Id) -> Id {
        self.insert(Kind::Sign(a), self.depends(a), None)
    }

    fn is(&self, id: Id, value: i32) -> bool {
        matches!(&self.node(id).kind, Kind::Apply(Op::Number(number), _) if *number == value)
    }

    /// An operation, simplified where an operand is 0 or 1.
    pub fn apply(&mut self, op: &Op, [a, b]: [Id; 2]) -> Id {
        let (a, b) = (a, if op.operands() == 2 { b } else { Id::NONE });
        if op.operands() > 0
            && let Some(sum) = Linear::apply(op, self.linear.get(&a), self.linear.get(&b))
        {
            return self.sum(sum);
        }
        let simpler = match op {
            Op::Add if self.is(a, 0) => Some(b),
            Op::Add | Op::Sub if self.is(b, 0) => Some(a),
            Op::Sub if self.is(a, 0) => Some(self.apply(&Op::Neg, [b, Id::NONE])),
            Op::Sub if a == b => Some(self.int(0)),
            Op::Mul if self.is(a, 0) || self.is(b, 0) => Some(self.int(0)),
            Op::Mul if self.is(a, 1) => Some(b),
            Op::Mul if self.is(b, 1) => Some(a),
            Op::Mul if self.is(a, -1) => Some(self.apply(&Op::Neg, [b, Id::NONE])),
            Op::Mul if self.is(b, -1) => Some(self.apply(&Op::Neg, [a, Id::NONE])),
            Op::Mul if a == b => Some(self.apply(&Op::Power(2), [a, Id::NONE])),
            Op::Div if self.is(a, 0) => Some(a),
            Op::Div if self.is(b, 1) => Some(a),
            Op::Power(0) => Some(self.int(1)),
            Op::Power(1) => Some(a),
            Op::Neg => match self.node(a).kind {
                Kind::Apply(Op::Neg, [inner, _]) => Some(inner),
                _ => None,
            },
            _ => None,
        };
        if let Some(simpler) = simpler {
            return simpler;
        }
        let count = op.operands();
        let depends = [a, b].into_iter().take(count).fold(0, |all, id| all | self.depends(id));
        if depends != 0 {
            return self.insert(Kind::Apply(op.clone(), [a, b]), depends, None);
        }
        let value = |index: usize, id: Id| (index < count).then(|| self.node(id).exact.clone());
        let exact = exact_op(op, value(0, a), value(1, b));
        match exact.as_ref().and_then(Exact::as_rational) {
            Some(value) => self.number(&value),
            None => self.insert(Kind::Apply(op.clone(), [a, b]), 0, exact),
        }
    }

    /// The node of a sum of leaves times numbers.
    fn sum(&mut self, linear: Linear) -> Id {
        let mut sum = None;
        for (leaf, factor) in linear.terms() {
            let term = match *factor == 1 || *factor == -1 {
                true => Id(*leaf),
                false => {
                    let size = self.number(&factor.clone().abs());
                    self.insert_operation(Op::Mul, [size, Id(*leaf)])
                }
            };
            sum = Some(match (sum, *factor > 0) {
                (None, true) => term,
                (None, false) => self.insert_operation(Op::Neg, [term, Id::NONE]),
                (Some(sum), true) => self.insert_operation(Op::Add, [sum, term]),
                (Some(sum), false) => self.insert_operation(Op::Sub, [sum, term]),
            });
        }
        let Some(sum) = sum else { return self.number(linear.constant()) };
        let sum = match *linear.constant() == 0 {
            true => sum,
            false => {
                let constant = self.number(linear.constant());
                self.insert_operation(Op::Add, [sum, constant])
            }
        };
        self.linear.insert(sum, linear);
        sum
    }

    fn insert_operation(&mut self, op: Op, both: [Id; 2]) -> Id {
        let depends = both.into_iter().take(op.operands()).fold(0, |all, id| all | self.depends(id));
        self.insert(Kind::Apply(op, both), depends, None)
    }

    /// A product that counts as one leaf in sums: what is added up of several states finds it in each of them.
    pub fn product(&mut self, a: Id, b: Id) -> Id {
        let id = self.apply(&Op::Mul, [a, b]);
        self.linear.entry(id).or_insert_with(|| Linear::leaf(id.0));
        id
    }

    /// The derivative in t, from that along the axis of time: with a period that is an interval this axis is s, and d/dt is v d/ds
    /// (docs/mathematics.md, section 13.3).
    pub fn in_time(&mut self, slope: Id) -> Id {
        self.clock.map_or(slope, |clock| self.product(clock, slope))
    }

    /// The sum of products, as in a row times a column.
    pub fn dot(&mut self, pairs: impl IntoIterator<Item = (Id, Id)>) -> Id {
        let zero = self.int(0);
        pairs.into_iter().fold(zero, |sum, (a, b)| {
            let product = self.apply(&Op::Mul, [a, b]);
            self.apply(&Op::Add, [sum, product])
        })
    }

    /// An expression in t, e and states, which are these nodes; what its operations ask for is added to `demands`.
    pub fn read(&mut self, expr: &Expr, variables: &[Id], demands: &mut Vec<(Id, Demand)>) -> Id {
        let root = expr.fold(|op, a: Option<Id>, b: Option<Id>| match op {
            Op::Variable(index) => variables[*index],
            _ => {
                let operands = [a, b].map(|operand| operand.unwrap_or(Id::NONE));
                let value = self.apply(op, operands);
                self.demand(op, operands, value, demands);
                value
            }
        });
        // A well-formed expression has a value.
        root.unwrap_or(Id::NONE)
    }

    fn demand(&mut self, op: &Op, [a, b]: [Id; 2], value: Id, demands: &mut Vec<(Id, Demand)>) {
        if op.operands() == 0 {
            return;
        }
        let constant = [a, b].iter().take(op.operands()).all(|id| self.depends(*id) == 0);
        if constant {
            // A constant is smooth where it is a number: `sqrt(0)` and `abs(0)` are.
            demands.push((value, Demand::Finite));
        }
        // A divisor stands for itself: of 0/b nothing is left that would show it.
        if !constant || *op == Op::Div {
            demands.extend(self.asks(op, [a, b]));
        }
    }

    /// What an operation asks for being smooth.
    fn asks(&mut self, op: &Op, [a, b]: [Id; 2]) -> Option<(Id, Demand)> {
        match op {
            Op::Div => Some((b, Demand::Nonzero)),
            Op::Sqrt | Op::Log | Op::Pow => Some((a, Demand::Positive)),
            Op::Abs => Some((a, Demand::Nonzero)),
            Op::Power(n) if *n < 0 => Some((a, Demand::Nonzero)),
            Op::Tan => Some((self.apply(&Op::Cos, [a, Id::NONE]), Demand::Nonzero)),
            // Two formulas that are the same have no corner where they meet, and are refused all the same.
            Op::Min | Op::Max => Some((self.apply(&Op::Sub, [a, b]), Demand::Nonzero)),
            _ => None,
        }
    }

    /// What has to hold at each point of a set for nodes to be continuously differentiable on it, with the derivatives that
    /// [`Formulas::derivative`] gives: every operation below them inside of where it is smooth, and every sign that is left of a
    /// corner constant. The formulas' own demands hold on G alone, and a box may reach out of it.
    pub fn corners(&mut self, roots: &[Id]) -> Vec<(Id, Demand)> {
        let mut all = Vec::new();
        for id in self.below(roots) {
            if self.depends(id) == 0 {
                continue;
            }
            let asked = match self.node(id).kind.clone() {
                Kind::Leaf(_) => None,
                Kind::Sign(a) => Some((a, Demand::Nonzero)),
                Kind::Apply(op, operands) => self.asks(&op, operands),
            };
            all.extend(asked.filter(|asked| !all.contains(asked)));
        }
        all
    }

    /// The nodes that these are made from, and themselves, in the order in which they can be computed.
    pub fn below(&self, roots: &[Id]) -> Vec<Id> {
        let Some(last) = roots.iter().max() else { return Vec::new() };
        let mut wanted = vec![false; last.0 + 1];
        roots.iter().for_each(|root| wanted[root.0] = true);
        for id in (0..=last.0).rev().filter(|id| *id < self.nodes.len()) {
            if wanted[id] {
                self.operands(Id(id)).into_iter().for_each(|operand| wanted[operand.0] = true);
            }
        }
        (0..=last.0).filter(|id| wanted[*id]).map(Id).collect()
    }

    /// The nodes that one is made from directly.
    pub fn operands(&self, id: Id) -> Vec<Id> {
        match &self.node(id).kind {
            Kind::Leaf(_) => Vec::new(),
            Kind::Sign(a) => vec![*a],
            Kind::Apply(op, both) => both[..op.operands()].to_vec(),
        }
    }
}

#[cfg(test)]
mod tests;
