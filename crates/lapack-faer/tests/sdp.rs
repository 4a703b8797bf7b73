//! Clarabel itself, linked against the symbols of this crate, on semidefinite programs whose optima
//! are known. All cones are of order 4 or more: below that Clarabel uses code of its own.

#![allow(clippy::disallowed_methods, reason = "what is compared need not be the same on every machine")]

extern crate lapack_faer as _;

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSettingsBuilder, DefaultSolver, IPSolver, PSDTriangleConeT, SolverStatus, SupportedConeT,
    ZeroConeT,
};
use std::f64::consts::{PI, SQRT_2};

const TOLERANCE: f64 = 1e-7;

fn settings(chordal: bool) -> DefaultSettings<f64> {
    DefaultSettingsBuilder::default()
        .verbose(false)
        .chordal_decomposition_enable(chordal)
        .tol_gap_abs(1e-10)
        .tol_gap_rel(1e-10)
        .tol_feas(1e-10)
        .build()
        .unwrap()
}

/// Minimizes `<cost, x>` subject to `b - sum of x_i a_i` in the cones, with the columns `a_i`.
fn solve(
    cost: &[f64],
    columns: &[Vec<f64>],
    b: &[f64],
    cones: &[SupportedConeT<f64>],
    chordal: bool,
) -> DefaultSolver<f64> {
    let n = cost.len();
    let (mut colptr, mut rowval, mut nzval) = (vec![0], vec![], vec![]);
    for column in columns {
        for (i, &x) in column.iter().enumerate().filter(|(_, x)| **x != 0.0) {
            rowval.push(i);
            nzval.push(x);
        }
        colptr.push(rowval.len());
    }
    let a = CscMatrix::new(b.len(), n, colptr, rowval, nzval);
    let p = CscMatrix::zeros((n, n));
    let mut solver = DefaultSolver::new(&p, cost, &a, b, cones, settings(chordal)).unwrap();
    solver.solve();
    assert_eq!(solver.solution.status, SolverStatus::Solved);
    solver
}

/// The upper triangle, column by column, with off-diagonal entries times the root of 2: the inner
/// product of two such vectors is that of the matrices.
fn svec(n: usize, f: impl Fn(usize, usize) -> f64) -> Vec<f64> {
    let mut entries = vec![];
    for j in 0..n {
        for i in 0..=j {
            entries.push(if i == j { f(i, j) } else { SQRT_2 * f(i, j) });
        }
    }
    entries
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

#[track_caller]
fn assert_close(got: f64, want: f64) {
    assert!((got - want).abs() <= TOLERANCE, "got {got:.12}, want {want:.12}");
}

/// The least `t` such that `t I - A` is positive semidefinite, and the multiplier, whose inner
/// product with `A` is `t` as well.
fn check_largest_eigenvalue(n: usize, a: impl Fn(usize, usize) -> f64, chordal: bool, want: f64) {
    let identity = svec(n, |i, j| f64::from(i == j));
    let a = svec(n, a);
    let columns = [identity.iter().map(|x| -x).collect()];
    let b: Vec<f64> = a.iter().map(|x| -x).collect();
    let solver = solve(&[1.0], &columns, &b, &[PSDTriangleConeT(n)], chordal);
    assert_close(solver.solution.x[0], want);
    assert_close(dot(&solver.solution.z, &identity), 1.0);
    assert_close(dot(&solver.solution.z, &a), want);
}

/// The complete bipartite graph, whose largest eigenvalue is the root of the product of the sides.
#[test]
fn largest_eigenvalue_of_a_dense_matrix() {
    for (left, right) in [(1, 3), (2, 3), (4, 5)] {
        let crosses = |i: usize, j: usize| (i < left) != (j < left);
        let want = ((left * right) as f64).sqrt();
        check_largest_eigenvalue(left + right, |i, j| f64::from(crosses(i, j)), false, want);
    }
}

/// `((I + path) / 3)^5` is banded, so that Clarabel splits the cone into smaller ones and completes
/// the multiplier afterwards, which is where it uses `dpotrs`.
#[test]
fn largest_eigenvalue_of_a_banded_matrix() {
    let n = 24;
    let step = |i: usize, j: usize| f64::from(i.abs_diff(j) <= 1) / 3.0;
    let mut power: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| step(i, j)).collect()).collect();
    for _ in 1..5 {
        let times = |i: usize, j: usize| (0..n).map(|l| power[i][l] * step(l, j)).sum();
        power = (0..n).map(|i| (0..n).map(|j| times(i, j)).collect()).collect();
    }
    let want = ((1.0 + 2.0 * (PI / (n + 1) as f64).cos()) / 3.0).powi(5);
    check_largest_eigenvalue(n, |i, j| power[i][j], true, want);
}

/// The largest `<cost, X>` over positive semidefinite `X` with `<m, X> = value` for each
/// constraint `(m, value)`.
fn maximize(n: usize, cost: &[f64], constraints: &[(Vec<f64>, f64)]) -> f64 {
    let size = cost.len();
    let columns: Vec<Vec<f64>> = (0..size)
        .map(|entry| {
            let cone = (0..size).map(|i| if i == entry { -1.0 } else { 0.0 });
            cone.chain(constraints.iter().map(|(m, _)| m[entry])).collect()
        })
        .collect();
    let mut b = vec![0.0; size];
    b.extend(constraints.iter().map(|(_, value)| value));
    let cost: Vec<f64> = cost.iter().map(|x| -x).collect();
    let cones = [PSDTriangleConeT(n), ZeroConeT(constraints.len())];
    let solver = solve(&cost, &columns, &b, &cones, false);
    -solver.solution.obj_val
}

/// The Lovász number: the largest sum of entries of `X` of trace 1 that vanishes on the edges.
fn lovasz(n: usize, edge: impl Fn(usize, usize) -> bool) -> f64 {
    let mut constraints = vec![(svec(n, |i, j| f64::from(i == j)), 1.0)];
    for j in 0..n {
        for i in (0..j).filter(|&i| edge(i, j)) {
            constraints.push((svec(n, |k, l| f64::from((k, l) == (i, j))), 0.0));
        }
    }
    maximize(n, &svec(n, |_, _| 1.0), &constraints)
}

#[test]
fn lovasz_number_of_cycles() {
    let cycle = |n: usize| move |i: usize, j: usize| [1, n - 1].contains(&i.abs_diff(j));
    assert_close(lovasz(4, cycle(4)), 2.0);
    assert_close(lovasz(5, cycle(5)), 5_f64.sqrt());
    let c = (PI / 7.0).cos();
    assert_close(lovasz(7, cycle(7)), 7.0 * c / (1.0 + c));
}

#[test]
fn lovasz_number_of_the_petersen_graph() {
    // An outer pentagon, an inner pentagram, and spokes.
    let petersen = |i: usize, j: usize| match (i < 5, j < 5) {
        (true, true) => [1, 4].contains(&i.abs_diff(j)),
        (false, false) => [2, 3].contains(&i.abs_diff(j)),
        _ => i % 5 == j % 5,
    };
    assert_close(lovasz(10, petersen), 4.0);
}

/// The relaxation of max-cut: a quarter of the largest `<L, X>` over `X` of unit diagonal, which is
/// `n / 4` times the largest eigenvalue of the Laplacian `L` for a vertex-transitive graph.
#[test]
fn max_cut_of_cycles() {
    for n in [5, 7, 9] {
        let laplacian = |i: usize, j: usize| match i.abs_diff(j) {
            0 => 2.0,
            d if d == 1 || d == n - 1 => -1.0,
            _ => 0.0,
        };
        let constraints: Vec<_> = (0..n).map(|v| (svec(n, |i, j| f64::from((i, j) == (v, v))), 1.0)).collect();
        let got = maximize(n, &svec(n, laplacian), &constraints) / 4.0;
        assert_close(got, n as f64 / 4.0 * (2.0 + 2.0 * (PI / n as f64).cos()));
    }
}
