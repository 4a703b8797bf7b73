//! Sums of leaves, and what is no such sum.

use super::*;

/// The same sum in two orders is one node, with one term for each leaf, whatever was added on the way.
#[test]
fn one_term_for_each_leaf() {
    let mut formulas = Formulas::default();
    let [x, y] = [Leaf::State(0), Leaf::State(1)].map(|leaf| formulas.leaf(leaf));
    let [two, three] = [2, 3].map(|value| formulas.int(value));
    let double = formulas.mul(two, x);
    let first = formulas.add(double, y);
    let second = formulas.sub(y, x);
    let triple = formulas.mul(x, three);
    let second = formulas.add(triple, second);
    assert_eq!(first, second);
    let rest = formulas.sub(first, double);
    assert_eq!(rest, y);
    let none = formulas.sub(second, first);
    assert!(formulas.is_zero(none));
    let other = formulas.sub(first, y);
    assert_ne!(other, x, "2 x is not x");
    let half = formulas.apply(&Op::Div, [double, two]);
    assert_eq!(half, x);
    // With a constant, and a factor that is not rational.
    let shifted = formulas.add(x, three);
    let back = formulas.sub(shifted, three);
    assert_eq!(back, x);
    let pi = formulas.apply(&Op::Pi, [0, 0]);
    let turned = formulas.mul(pi, x);
    let apart = formulas.sub(turned, x);
    assert_ne!(apart, turned);
}

/// What is no such sum stays what it is: a product, and a quotient by 0.
#[test]
fn products_and_quotients_by_zero_are_left() {
    let mut formulas = Formulas::default();
    let [x, y] = [Leaf::State(0), Leaf::State(1)].map(|leaf| formulas.leaf(leaf));
    let zero = formulas.int(0);
    for id in [formulas.mul(x, y), formulas.apply(&Op::Div, [x, zero])] {
        assert!(!formulas.linear.contains_key(&id), "{:?}", formulas.node(id));
    }
    let product = formulas.mul(x, y);
    let twice = formulas.add(product, product);
    assert!(!formulas.is_zero(twice) && twice != product);
}
