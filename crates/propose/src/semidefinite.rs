//! The one call of Clarabel: a linear cost under linear matrix inequalities.

// Clarabel's semidefinite cone needs BLAS and LAPACK; naming the crate makes the linker see its symbols.
extern crate lapack_faer as _;

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSettingsBuilder, DefaultSolver, IPSolver, PSDTriangleConeT, SolverStatus, SupportedConeT,
};
use sigmastar_matrix::doubles::largest_of;
use sigmastar_matrix::{AffineMatrix, Symmetric};
use thiserror::Error;

/// Why there is no candidate.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum SolverFailure {
    /// A number that must be finite, or positive, is not so in doubles.
    #[error("a number that must be finite, or positive, is not so in floating point")]
    Unusable,
    /// The number of costs and the number of variables of a constraint differ.
    #[error("{costs} costs for {variables} variables")]
    Shape {
        /// The number of costs.
        costs: usize,
        /// The number of variables.
        variables: usize,
    },
    /// The solver claims, without proof, that no point satisfies the constraints.
    #[error("the solver finds no feasible point")]
    Infeasible,
    /// The solver claims, without proof, that the cost has no minimum.
    #[error("the solver finds no minimum")]
    Unbounded,
    /// The solver stopped early, or with reduced accuracy where full accuracy was asked for; its last point is not used.
    #[error("the solver stopped without a solution: {0}")]
    Stopped(String),
    /// The solver refused the problem.
    #[error("the solver refused the problem: {0}")]
    Refused(String),
}

/// Settings, the same for every run; with one thread and no clock the same input gives the same bits on one machine
/// (the linear algebra picks its kernels by the width of the processor's vectors).
fn settings() -> Result<DefaultSettings<f64>, SolverFailure> {
    DefaultSettingsBuilder::default()
        // Nothing on standard output.
        .verbose(false)
        // Problems of this size take 10 to 30 steps.
        .max_iter(200)
        // Never the clock: the answer must not depend on the load of the machine.
        .time_limit(f64::INFINITY)
        // One thread: the order of summation is fixed.
        .max_threads(1)
        // The built-in factorisation, not whatever "auto" means in the next version.
        .direct_solve_method("qdldl".to_owned())
        // The accuracy asked for, absolute; the problems are scaled so that the optimum is about 1.
        .tol_gap_abs(TOLERANCE)
        // The same, relative.
        .tol_gap_rel(TOLERANCE)
        // The residuals of the constraints, relative.
        .tol_feas(TOLERANCE)
        // The callers scale their problems; scaling them again makes the accuracy worse.
        .equilibrate_enable(false)
        // Dense small matrices: nothing to decompose.
        .chordal_decomposition_enable(false)
        // No row is removed: the constraint that is solved is the one that was passed.
        .presolve_enable(false)
        .build()
        .map_err(|error| SolverFailure::Refused(error.to_string()))
}

/// The solver's tolerance. Trial data over many orders of magnitude reach it but for one problem in a thousand; at 1e-10
/// three problems in a hundred end with reduced accuracy, and at 1e-8 a minimum may be off by some 1e-7.
const TOLERANCE: f64 = 3e-9;

/// The order of a block from which on its variables keep their zeros.
const LARGE_BLOCK: usize = 7;

/// What the solver proposes for a problem.
#[derive(Clone, Debug, PartialEq)]
pub struct SolverPoint {
    /// The variables.
    pub x: Vec<f64>,
    /// The dual matrices, one per constraint: nonnegative, with `cost_k = sum tr(A_k Y)` up to the tolerance.
    pub duals: Vec<Symmetric<f64>>,
    /// The solver's own words, where it stopped short of its tolerance: such a point may be tried, and must be reported.
    pub remark: Option<String>,
}

/// Minimises `cost . x` subject to `M(x)` positive semidefinite for every M of `constraints`, in floating point. Where the
/// solver stops at reduced accuracy or makes no more progress, its last point is given, and [`SolverPoint::remark`] says so.
///
/// Guarantee: none about the result, which is a proposal to be verified; but it is finite.
///
/// # Errors
/// Every other outcome of the solver, by name, and data that are not finite or do not fit together.
pub fn propose(cost: &[f64], constraints: &[AffineMatrix<f64>]) -> Result<SolverPoint, SolverFailure> {
    if let Some(odd) = constraints.iter().find(|constraint| constraint.terms().len() != cost.len()) {
        return Err(SolverFailure::Shape { costs: cost.len(), variables: odd.terms().len() });
    }
    // Clarabel's form: s = b - A x in the cone, so b is the constant and the columns of A are minus the coefficients.
    let b: Vec<f64> = constraints.iter().flat_map(|constraint| constraint.constant().cone_vector()).collect();
    // With many large blocks the factorisation must eliminate the rows of the blocks first, each block by itself. Where
    // its variables have fewer entries than a block has rows, its ordering (AMD) takes the variables first, and that fills
    // in everything between all blocks: ten times the work and more.
    let keep_zeros = constraints.len() > 2 && constraints.iter().any(|constraint| constraint.order() >= LARGE_BLOCK);
    let (mut column_starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
    for variable in 0..cost.len() {
        let column = constraints.iter().flat_map(|constraint| constraint.terms()[variable].cone_vector());
        for (row, value) in column.enumerate().filter(|(_, value)| keep_zeros || *value != 0.0) {
            rows.push(row);
            values.push(-value);
        }
        column_starts.push(rows.len());
    }
    // Clarabel may panic on such data.
    if !cost.iter().chain(&b).chain(&values).all(|value| value.is_finite()) {
        return Err(SolverFailure::Unusable);
    }
    let a = CscMatrix::new(b.len(), cost.len(), column_starts, rows, values);
    let quadratic = CscMatrix::zeros((cost.len(), cost.len()));
    let cones: Vec<SupportedConeT<f64>> =
        constraints.iter().map(|constraint| PSDTriangleConeT(constraint.order())).collect();
    let mut solver = DefaultSolver::new(&quadratic, cost, &a, &b, &cones, settings()?)
        .map_err(|error| SolverFailure::Refused(error.to_string()))?;
    solver.solve();
    let orders: Vec<usize> = constraints.iter().map(AffineMatrix::order).collect();
    let solution = solver.solution;
    candidate(solution.status, solution.x, &solution.z, &orders)
}

/// Up to so many constraints are posed all at once; of more, so many at first, spread evenly, and so many more at a time.
const AT_ONCE: usize = 32;
const MORE: usize = 8;

/// How often constraints are added before all of them are posed.
const ADDITIONS: usize = 12;

/// What a constraint may be violated by, as a share of its size: the solver is hardly more accurate.
const VIOLATION: f64 = 1e-7;

/// Minimises as [`propose`] does, where many of the constraints are alike, as those at neighbouring points are, and few of them count: of `many` a few
/// are posed with `others`, and then those besides that the solution violates most, until it violates none.
///
/// Guarantee: none about the result, which is a proposal to be verified; but it is finite.
///
/// # Errors
/// Those of [`propose`].
pub fn propose_among(
    cost: &[f64],
    many: &[AffineMatrix<f64>],
    others: &[AffineMatrix<f64>],
) -> Result<Vec<f64>, SolverFailure> {
    let posed = |places: &[usize]| {
        let chosen = places.iter().map(|place| &many[*place]).chain(others);
        propose(cost, &chosen.cloned().collect::<Vec<_>>()).map(|found| found.x)
    };
    let all: Vec<usize> = (0..many.len()).collect();
    if many.len() <= AT_ONCE {
        return posed(&all);
    }
    let mut places: Vec<usize> = (0..AT_ONCE).map(|i| i * many.len() / AT_ONCE).collect();
    for _ in 0..ADDITIONS {
        let x = match posed(&places) {
            Ok(x) => x,
            // With more constraints it is no better.
            Err(SolverFailure::Infeasible) => return Err(SolverFailure::Infeasible),
            Err(_) => break,
        };
        let others = all.iter().filter(|place| !places.contains(place));
        let lacks: Vec<(f64, usize)> = others.map(|place| (lack(&many[*place], &x), *place)).collect();
        if !lacks.iter().all(|(lack, _)| lack.is_finite()) {
            return Err(SolverFailure::Unusable);
        }
        let mut violated: Vec<(f64, usize)> = lacks.into_iter().filter(|(lack, _)| *lack > VIOLATION).collect();
        if violated.is_empty() {
            return Ok(x);
        }
        // Of those that are equal the first.
        violated.sort_by(|(a, _), (b, _)| b.total_cmp(a));
        places.extend(violated.iter().take(MORE).map(|(_, place)| *place));
        places.sort_unstable();
    }
    posed(&all)
}

/// By how much a matrix is not positive semidefinite at a point, as a share of the largest sum of sizes that is an entry; no number where that is not
/// finite.
fn lack(matrix: &AffineMatrix<f64>, x: &[f64]) -> f64 {
    let order = matrix.order();
    let terms = |i: usize, k: usize| {
        let own = matrix.terms().iter().zip(x).map(move |(term, x)| term.at(i, k) * x);
        std::iter::once(*matrix.constant().at(i, k)).chain(own)
    };
    let sizes = Symmetric::from_fn(order, |i, k| terms(i, k).map(f64::abs).sum::<f64>());
    if !sizes.entries().iter().all(|size| size.is_finite()) {
        return f64::NAN;
    }
    let size = sizes.entries().iter().copied().fold(0.0, f64::max);
    if size == 0.0 {
        return 0.0;
    }
    let opposite = Symmetric::from_fn(order, |i, k| -terms(i, k).sum::<f64>() / size);
    largest_of(&mut opposite.rows().concat(), order)
}

/// Only `Solved` gives a candidate without a remark; where the solver came close, its last point is one with a remark.
fn candidate(status: SolverStatus, x: Vec<f64>, z: &[f64], orders: &[usize]) -> Result<SolverPoint, SolverFailure> {
    let remark = match status {
        SolverStatus::Solved => None,
        SolverStatus::AlmostSolved | SolverStatus::InsufficientProgress => Some(status.to_string()),
        SolverStatus::PrimalInfeasible => return Err(SolverFailure::Infeasible),
        SolverStatus::DualInfeasible => return Err(SolverFailure::Unbounded),
        other => return Err(SolverFailure::Stopped(other.to_string())),
    };
    if !x.iter().chain(z).all(|value| value.is_finite()) {
        return Err(SolverFailure::Unusable);
    }
    let mut rest = z;
    let mut duals = Vec::with_capacity(orders.len());
    for order in orders {
        let (own, others) = rest.split_at((order * (order + 1) / 2).min(rest.len()));
        duals.push(Symmetric::from_cone_vector(*order, own));
        rest = others;
    }
    Ok(SolverPoint { x, duals, remark })
}

/// The margin with which a constraint is posed, so that its rounded solution can be proved: max{1e-6 |A|, 2 n tol}, where |A|
/// is the size of the entries of the matrix at the solution, n its order and tol the solver's tolerance.
#[must_use]
pub fn margin(size: f64, order: usize) -> f64 {
    (1e-6 * size).max(2.0 * order as f64 * TOLERANCE)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The minimum, where the solver reaches its full tolerance.
    fn minimise(cost: &[f64], constraints: &[AffineMatrix<f64>]) -> Result<Vec<f64>, SolverFailure> {
        let candidate = propose(cost, constraints)?;
        candidate.remark.map_or(Ok(candidate.x), |status| Err(SolverFailure::Stopped(status)))
    }

    /// `C + x A` of order 1.
    fn scalar(constant: f64, coefficient: f64) -> AffineMatrix<f64> {
        AffineMatrix::from_fn(1, 1, |_, _| constant, |_, _, _| coefficient)
    }

    /// The least eigenvalue of [[2, 0, 1], [0, 5, 0], [1, 0, 2]] is 1. Any other order of the triangle, or off-diagonal
    /// entries without the root of 2, gives another number.
    #[test]
    fn least_eigenvalue_of_a_matrix_made_by_hand() {
        let entries = [[2.0, 0.0, 1.0], [0.0, 5.0, 0.0], [1.0, 0.0, 2.0]];
        let matrix = AffineMatrix::from_fn(3, 0, |i, j| entries[i][j], |_, _, _| 0.0).minus_identity();
        let solution = minimise(&[-1.0], std::slice::from_ref(&matrix)).expect("solved");
        assert!((solution[0] - 1.0).abs() <= 1e-7, "{solution:?}");
        assert_eq!(minimise(&[-1.0], &[matrix]).expect("solved")[0].to_bits(), solution[0].to_bits());
    }

    /// x >= 3 and x <= 7.
    #[test]
    fn several_constraints_hold_together() {
        let constraints = [scalar(-3.0, 1.0), scalar(7.0, -1.0)];
        let least = minimise(&[1.0], &constraints).expect("solved")[0];
        let largest = minimise(&[-1.0], &constraints).expect("solved")[0];
        assert!((least - 3.0).abs() <= 1e-6 && (largest - 7.0).abs() <= 1e-6, "{least} {largest}");
    }

    #[test]
    fn what_has_no_minimum_gives_no_candidate() {
        let contradiction = [scalar(-8.0, 1.0), scalar(7.0, -1.0)];
        assert_eq!(minimise(&[1.0], &contradiction), Err(SolverFailure::Infeasible));
        assert_eq!(minimise(&[1.0], &[scalar(7.0, -1.0)]), Err(SolverFailure::Unbounded));
    }

    #[test]
    fn unfit_data_are_refused_before_the_solver_sees_them() {
        for odd in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(minimise(&[odd], &[scalar(1.0, 1.0)]), Err(SolverFailure::Unusable));
            assert_eq!(minimise(&[1.0], &[scalar(odd, 1.0)]), Err(SolverFailure::Unusable));
            assert_eq!(minimise(&[1.0], &[scalar(1.0, odd)]), Err(SolverFailure::Unusable));
        }
        let shape = SolverFailure::Shape { costs: 2, variables: 1 };
        assert_eq!(minimise(&[1.0, 1.0], &[scalar(1.0, 1.0)]), Err(shape));
    }

    #[test]
    fn only_solved_gives_a_candidate_without_a_remark() {
        use SolverStatus::*;
        let at = |status, x: f64| candidate(status, vec![x], &[3.0], &[1]);
        let plain = at(Solved, 1.0).expect("solved");
        assert_eq!((plain.x, plain.duals[0].entries(), plain.remark), (vec![1.0], &[3.0][..], None));
        assert_eq!(at(Solved, f64::NAN), Err(SolverFailure::Unusable));
        assert_eq!(candidate(Solved, vec![1.0], &[f64::INFINITY], &[1]), Err(SolverFailure::Unusable));
        for status in [AlmostSolved, InsufficientProgress] {
            assert_eq!(at(status, 1.0).expect("tried").remark, Some(status.to_string()));
            assert_eq!(at(status, f64::NAN), Err(SolverFailure::Unusable));
        }
        assert_eq!(at(PrimalInfeasible, 1.0), Err(SolverFailure::Infeasible));
        assert_eq!(at(DualInfeasible, 1.0), Err(SolverFailure::Unbounded));
        let others = [Unsolved, AlmostPrimalInfeasible, AlmostDualInfeasible, MaxIterations, MaxTime];
        for status in others.into_iter().chain([NumericalError, CallbackTerminated]) {
            assert_eq!(at(status, 1.0), Err(SolverFailure::Stopped(status.to_string())));
        }
    }

    /// The dual of the least eigenvalue is the projector on its eigenvector, here (1, 0, -1)/sqrt(2).
    #[test]
    fn the_dual_matrix_of_a_problem_made_by_hand() {
        let entries = [[2.0, 0.0, 1.0], [0.0, 5.0, 0.0], [1.0, 0.0, 2.0]];
        let matrix = AffineMatrix::from_fn(3, 0, |i, j| entries[i][j], |_, _, _| 0.0).minus_identity();
        let dual = &propose(&[-1.0], &[matrix]).expect("solved").duals[0];
        for (found, expected) in dual.entries().iter().zip([0.5, 0.0, 0.0, -0.5, 0.0, 0.5]) {
            assert!((found - expected).abs() <= 1e-6, "{dual:?}");
        }
    }

    /// The largest x + 2 y at most 1 from each of many points of a circle, of which the farthest are not among the first.
    #[test]
    fn of_many_constraints_those_count_that_are_violated() {
        const COST: [f64; 2] = [-1.0, -2.0];
        let disc = |count: u32, i: u32| {
            let (b, a) = libm::sincos(std::f64::consts::TAU * (f64::from(i) + 0.5) / f64::from(count));
            let constant = move |i: usize, k: usize| match (i, k) {
                (0, 2) => -a / 2.0,
                (1, 2) => -b / 2.0,
                _ => f64::from(i == k),
            };
            AffineMatrix::from_fn(3, 2, constant, |variable, i, k| f64::from((i, k) == (variable, 2)))
        };
        for count in [8, 900] {
            let many: Vec<_> = (0..count).map(|i| disc(count, i)).collect();
            let found = propose_among(&COST, &many, &[]).expect("solved");
            let all = propose(&COST, &many).expect("solved").x;
            assert!((found[0] - all[0] + 2.0 * (found[1] - all[1])).abs() <= 1e-6, "{count}: {found:?}, {all:?}");
            // A constraint besides them counts too.
            let found = propose_among(&COST, &many, &[scalar_of([-0.25, -1.0, 0.0])]).expect("solved");
            assert!(found[0] <= -0.25 + 1e-6, "{count}: {found:?}");
            assert!(many.iter().all(|disc| lack(disc, &found) <= 1e-6), "{count}: {found:?}");
        }
        // Where they contradict each other, that is said, also of what is not among the first.
        let mut many: Vec<_> = (0..100).map(|i| disc(100, i)).collect();
        many[7] = scalar_of([-3.0, 1.0, 0.0]);
        assert_eq!(propose_among(&COST, &many, &[]), Err(SolverFailure::Infeasible));
        many[7] = scalar_of([f64::NAN, 1.0, 0.0]);
        assert_eq!(propose_among(&COST, &many, &[]), Err(SolverFailure::Unusable));
    }

    /// `c + a x + b y` of order 1.
    fn scalar_of([c, a, b]: [f64; 3]) -> AffineMatrix<f64> {
        AffineMatrix::from_fn(1, 2, |_, _| c, |variable, _, _| if variable == 0 { a } else { b })
    }

    /// diag(1, x) less what is beside its diagonal: 2 of size 5.
    #[test]
    fn a_lack_is_a_share() {
        let matrix = AffineMatrix::from_fn(2, 1, |i, k| if i == k { 1.0 } else { 3.0 }, |_, i, k| f64::from(i == k));
        assert!(
            (lack(&matrix, &[0.0]) - 2.0 / 3.0).abs() <= 1e-12 && (lack(&matrix, &[4.0]) + 2.0 / 5.0).abs() <= 1e-12
        );
        assert_eq!(lack(&scalar_of([0.0, 1.0, 0.0]), &[0.0, 0.0]), 0.0);
        assert!(lack(&scalar_of([1.0, -1.0, 0.0]), &[1.0 + 1e-9, 0.0]) < 1e-8);
    }

    #[test]
    fn margins_follow_the_larger_of_size_and_tolerance() {
        assert_eq!(margin(16.0, 4), 16e-6);
        assert_eq!(margin(0.0, 4), 8.0 * TOLERANCE);
    }
}
