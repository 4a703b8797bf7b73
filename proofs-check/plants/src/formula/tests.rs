//! Sums of leaves, and what is no such sum.

use super::*;

/// A sum in two orders is one node, with one term for each leaf, whatever was added before.
#[test]
fn one_term_for_each_leaf() {
    let mut formulas = Formulas::default();
    let [x, y] = [Leaf::State(0), Leaf::State(1)].map(|leaf| formulas.leaf(leaf));
    let [two, three] = [2, 3].map(|value| formulas.int(value));
    let double = formulas.make(two * x);
    let first = formulas.make(double + y);
    let second = formulas.make(y - x);
    let triple = formulas.make(x * three);
    let second = formulas.make(triple + second);
    assert_eq!(first, second);
    let rest = formulas.make(first - double);
    assert_eq!(rest, y);
    let none = formulas.make(second - first);
    assert!(formulas.is(none, 0));
    let other = formulas.make(first - y);
    assert_ne!(other, x, "2 x is not x");
    let half = formulas.make(double / two);
    assert_eq!(half, x);
    // With a constant, and a factor that is not rational.
    let shifted = formulas.make(x + three);
    let back = formulas.make(shifted - three);
    assert_eq!(back, x);
    let pi = formulas.apply(&Op::Pi, [Id::NONE; 2]);
    let turned = formulas.make(pi * x);
    let apart = formulas.make(turned - x);
    assert_ne!(apart, turned);
}

/// What is no such sum stays what it is: a product, and a quotient by 0.
#[test]
fn products_and_quotients_by_zero_are_left() {
    let mut formulas = Formulas::default();
    let [x, y] = [Leaf::State(0), Leaf::State(1)].map(|leaf| formulas.leaf(leaf));
    let zero = formulas.int(0);
    for id in [formulas.make(x * y), formulas.make(x / zero)] {
        assert!(!formulas.linear.contains_key(&id), "{:?}", formulas.node(id));
    }
    let product = formulas.make(x * y);
    let twice = formulas.make(product + product);
    assert!(!formulas.is(twice, 0) && twice != product);
}
