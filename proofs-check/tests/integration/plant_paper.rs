//! The paper's example from its formulas: bounds with little room, and how long it takes to decide them.

use super::plant_support::{judged, stored};

#[test]
fn the_bounds_of_the_example_are_decided() {
    let start = std::time::Instant::now();
    let answer = judged(&stored("paper-example"));
    let time = start.elapsed();
    println!("{time:?}\n{answer:#?}");
    assert!(answer.is_ok());
}
