//! Rigorous bounds of semidefinite programs: what the solver proposes is proved, and the known optimum lies between.

use crate::sdpa::{random, read, write};

/// Minimise x_1 + 2 x_2 subject to [[x_1, 1], [1, x_2]] >= 0 and x_1 <= 5, x_2 <= 5: x_1 x_2 >= 1, so 2 sqrt(2).
const BY_HAND: &str = "\"A comment
* another
 2 = m
 2 = blocks
 {2, -2}
 {1.0, 2.0}
0 1 1 2 -1
0 2 1 1 -5
0 2 2 2 -5
1 1 1 1 1
1 2 1 1 -1
2 1 2 2 1
2 2 2 2 -1
";

#[test]
fn a_problem_made_by_hand() {
    let problem = read(BY_HAND).expect("well formed");
    assert_eq!(problem.blocks, [2, -2]);
    assert_eq!(read(&write(&problem)), Ok(problem.clone()));
    let bounds = problem.verify(&problem.solve().expect("solved")).expect("proved");
    let optimum = 8f64.sqrt();
    assert!(bounds.lower <= optimum && bounds.upper >= optimum, "{bounds:?}");
    assert!(bounds.upper - bounds.lower <= 1e-4);
}

#[test]
fn what_is_not_such_a_file_is_refused() {
    for (text, part) in [
        ("", "m is missing"),
        ("x\n", "not a count"),
        ("1\n1\n", "block sizes is missing"),
        ("1\n1\n2\n1\n1 1 1\n", "not an entry"),
        ("1\n1\n2\n1\n2 1 1 1 3\n", "outside its matrix"),
        ("1\n1\n2\n1\n1 1 1 3 3\n", "outside its matrix"),
        ("1\n1\n2\n1\n1 1 0 1 3\n", "outside its matrix"),
        ("1\n1\n-2\n1\n1 1 1 2 3\n", "outside its matrix"),
        ("1\n1\n2\n1\n1 1 1 1 inf\n", "outside its matrix"),
        ("2\n1\n2\n1\n", "fit their counts"),
    ] {
        let error = read(text).expect_err(text);
        assert!(error.contains(part), "{text}: {error}");
    }
}

/// Sizes 3 to 60: each is solved, both bounds are proved, they enclose the known optimum, and they are close.
#[test]
fn random_strictly_feasible_problems_are_bounded_from_both_sides() {
    let sizes = [(3, 2), (4, 5), (5, 3), (8, 8), (12, 6), (16, 20), (20, 10), (30, 25), (60, 5)];
    for (seed, (order, variables)) in
        sizes.into_iter().flat_map(|size| (0..if size.0 < 30 { 6 } else { 1 }).map(move |seed| (seed, size)))
    {
        let (problem, optimum) = random(order, variables, 100 * order as u64 + seed);
        assert_eq!(read(&write(&problem)).as_ref(), Ok(&problem));
        let candidate = problem.solve().expect("a candidate");
        let bounds = problem.verify(&candidate).unwrap_or_else(|| panic!("{order} {seed}: not proved"));
        // The constructed optimum is itself rounded.
        let rounding = 1e-11 * (1.0 + optimum.abs());
        assert!(bounds.lower <= optimum + rounding && bounds.upper >= optimum - rounding, "{order} {seed}");
        let gap = (bounds.upper - bounds.lower).to_f64();
        assert!(gap <= 1e-3 * (1.0 + optimum.abs()), "{order} {seed}: {gap}");
    }
}

/// A dual that is not feasible, and an x that is not, prove nothing.
#[test]
fn what_is_not_feasible_proves_nothing() {
    let (problem, _) = random(6, 4, 1);
    let candidate = problem.solve().expect("solved");
    let mut moved = candidate.clone();
    moved.x[0] -= 3.0;
    assert!(problem.verify(&moved).is_none());
    let mut negative = candidate;
    negative.duals[0] = sigmastar::matrix::Symmetric::from_fn(6, |i, j| match (i, j) {
        (0, 0) => -1e3,
        (1, 1) => 1e3,
        _ => 0.0,
    });
    assert!(problem.verify(&negative).is_none());
}
