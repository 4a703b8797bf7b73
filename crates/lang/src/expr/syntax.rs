//! The operations of an expression in postfix order, and how an algebra evaluates them.

use rug::Rational;
use std::ops::Range;

/// A variable of a bounding function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Argument {
    X,
    E,
}

/// One operation and the bytes of the text it was read from. `V` is the kind of variables that may occur, so that an
/// expression in the variables of a plant can never be taken for a bounding function.
#[derive(Clone, Debug)]
pub(super) struct Node<V = Argument> {
    pub(super) kind: NodeKind<V>,
    pub(super) span: Range<usize>,
}

/// What a node does with the values before it.
#[derive(Clone, Debug)]
pub(super) enum NodeKind<V = Argument> {
    Number(Rational),
    Pi,
    Variable(V),
    Unary(Unary),
    Binary(Binary),
    /// The power with a constant integer exponent.
    Power(i32),
}

/// The operation of a constant as one among expressions with variables; none of a constant is a variable.
pub(super) fn carried<V>(node: &Node) -> Option<NodeKind<V>> {
    Some(match &node.kind {
        NodeKind::Number(value) => NodeKind::Number(value.clone()),
        NodeKind::Pi => NodeKind::Pi,
        NodeKind::Unary(operation) => NodeKind::Unary(*operation),
        NodeKind::Binary(operation) => NodeKind::Binary(*operation),
        NodeKind::Power(exponent) => NodeKind::Power(*exponent),
        NodeKind::Variable(_) => return None,
    })
}

/// Operations on one value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Unary {
    /// The opposite.
    Neg,
    /// The square root.
    Sqrt,
    /// The exponential.
    Exp,
    /// The natural logarithm.
    Log,
    /// The sine.
    Sin,
    /// The cosine.
    Cos,
    /// The tangent.
    Tan,
    /// The arc tangent.
    Atan,
    /// The hyperbolic tangent.
    Tanh,
    /// The absolute value.
    Abs,
    /// The derivative of this order of `x/(e^x - 1)`, which is 1 at 0. Texts have the order 0; derivatives of formulas have others.
    Exprelr(u32),
    /// The derivative of this order of `sin(x)/x`, which is 1 at 0; orders as for the other one.
    Sinc(u32),
}

/// Operations on two values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Binary {
    /// The sum.
    Add,
    /// The difference.
    Sub,
    /// The product.
    Mul,
    /// The quotient.
    Div,
    /// The real power.
    Pow,
    /// The smaller one.
    Min,
    /// The larger one.
    Max,
}

/// A meaning of the operations: numbers, enclosures, slopes, machine code, ...
pub(super) trait Algebra<V = Argument> {
    type Value;
    fn number(&mut self, value: &Rational) -> Self::Value;
    fn pi(&mut self) -> Self::Value;
    fn variable(&mut self, variable: V) -> Self::Value;
    fn unary(&mut self, operation: Unary, a: Self::Value) -> Self::Value;
    fn binary(&mut self, operation: Binary, a: Self::Value, b: Self::Value) -> Self::Value;
    fn power(&mut self, base: Self::Value, exponent: i32) -> Self::Value;
    /// Called with the value of every node, in postfix order.
    fn note(&mut self, _node: &Node<V>, _value: &Self::Value) {}
}

/// Applies one node to the values on the stack.
pub(super) fn step<V: Copy, A: Algebra<V>>(node: &Node<V>, stack: &mut Vec<A::Value>, algebra: &mut A) {
    // The parser pushes a node only after its operands, so the stack holds at least `arity` values here.
    let mut pop = || stack.pop().expect("operands precede their operation");
    let value = match &node.kind {
        NodeKind::Number(number) => algebra.number(number),
        NodeKind::Pi => algebra.pi(),
        NodeKind::Variable(variable) => algebra.variable(*variable),
        NodeKind::Unary(operation) => {
            let a = pop();
            algebra.unary(*operation, a)
        }
        NodeKind::Binary(operation) => {
            let b = pop();
            let a = pop();
            algebra.binary(*operation, a, b)
        }
        NodeKind::Power(exponent) => {
            let base = pop();
            algebra.power(base, *exponent)
        }
    };
    algebra.note(node, &value);
    stack.push(value);
}

/// The value of a whole expression: a loop over the postfix order, so that no depth of nesting can overflow the
/// call stack.
pub(super) fn evaluate<V: Copy, A: Algebra<V>>(nodes: &[Node<V>], algebra: &mut A) -> A::Value {
    let mut stack = Vec::with_capacity(16);
    for node in nodes {
        step(node, &mut stack, algebra);
    }
    // Every parsed expression leaves exactly one value: each operand pushes one, each operation of arity n replaces
    // n by one, and the grammar combines all of them.
    stack.pop().expect("an expression has one value")
}
