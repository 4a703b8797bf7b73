//! The proof of a triple: p_low I <= P(t) <= p_up I and P' + P F + F'P <= -2 alpha P for every t and every F of the family.
//!
//! P and the centre of F are trigonometric polynomials in the angle a = w t, so the three matrices
//! `P - p_low I`, `p_up I - P` and `-(P' + P F + F'P + 2 alpha P)` are too, of known degree, with enclosed coefficients. The
//! last is affine in the deviation of F, which may change with time: at each t it is enough that it is positive definite at
//! the vertices. With a ball of radius r instead, `|P D + D'P| <= 2 p_up r` is taken from the diagonal.
//!
//! For every angle: on a cell of half-width h around a_0, `Q(a) = Q(a_0) + (a - a_0) Q'(a_0) + R` with
//! `|R_ij| <= h^2/2 sum_k k^2 (|a_k| + |b_k|)`. The affine part is positive definite on the cell if it is at both ends; the row sums
//! of the bounds of R are taken from the diagonal. Cells that are not proved are halved. They cover [0, 2 pi].

use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::parallel;
use sigmastar_lang::expr::TrigonometricPolynomial;
use sigmastar_lang::spec::model::PeriodicMatrix;
use sigmastar_matrix::{ScaledMatrix, Symmetric, is_symmetric};
use sigmastar_theory::evidence::ProvedTriple;
use sigmastar_theory::jacobian::{Deviation, Family, MAX_COST, cells, proof_cost};
use thiserror::Error;

/// Which inequality could not be proved, and where.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum NotProved {
    /// Matrices that are not symmetric, or not of the order of the Jacobian, or numbers that are not positive.
    #[error("P is not symmetric of the order of the Jacobian, or p_low, p_up or alpha is not positive")]
    Shape,
    /// More work than a proof may take.
    #[error(
        "the proof would take more than {MAX_COST} multiplications: P or the Jacobian has too many harmonics for its order"
    )]
    TooMuchWork,
    /// One of the inequalities.
    #[error("{what} is not proved at the angle 2 pi t/period = {angle}")]
    Inequality {
        /// In words.
        what: &'static str,
        /// Near which angle, in radians.
        angle: f64,
    },
}

/// What the halves of its cells may cost: so many times what the cells do, or this much together.
const HALVES: u64 = 8;
const COST_OF_HALVES: u64 = 8_000_000;

/// Cells are halved at most this many times.
const MAX_HALVINGS: u32 = 11;

/// Proves the two inequalities of the triple.
///
/// Guarantee: if `Ok`, then for every t and every F of the family, P(t) being periodic with its period:
/// p_low I <= P(t) <= p_up I with 0 < p_low, and P' + P F + F'P <= -2 alpha P with alpha > 0 (strictly, in fact).
///
/// # Errors
/// The first inequality that is not proved; this says nothing about its truth.
pub fn prove(family: &Family, witness: &ProvedTriple) -> Result<(), NotProved> {
    let order = family.order();
    let ProvedTriple { matrix, p_low, p_up, alpha } = witness;
    let positive = [p_low, p_up, alpha].iter().all(|number| **number > 0);
    // A matrix that varies needs a period that the family is known to have; a constant one has every period.
    if order == 0 || !positive || !matrix.parts().all(|rows| is_symmetric(rows, order)) {
        return Err(NotProved::Shape);
    }
    let precision = family.frequency.precision();
    let rational = |value: &Rational| Enclosure::from_rational(value, precision);
    let p = entries(matrix, precision);
    prove_bounds(matrix, p_low, p_up, precision)?;
    let twice_alpha = rational(alpha) * 2;
    let centre = Symmetric::from_fn(order, |j, i| {
        let mut sum = p[i][j].derivative().scaled(&family.frequency).plus(&p[i][j].scaled(&twice_alpha), 1);
        for (k, centre) in family.centre.iter().enumerate() {
            sum = sum.plus(&p[i][k].times(&centre[j]), 1).plus(&p[k][j].times(&centre[i]), 1);
        }
        sum.scaled(&Enclosure::from_integer(-1, precision))
    });
    const DECAY: &str = "P' + P F + F'P <= -2 alpha P";
    match &family.deviation {
        Deviation::Vertices(vertices) => vertices.iter().try_for_each(|vertex| {
            let at_vertex = Entries::from_fn(order, |j, i| {
                let mut entry = centre.at(i, j).clone();
                for (row, column, offset) in vertex {
                    // (P D)_ij has P_i,row D_row,j, and (D'P)_ij has D_row,i P_row,j.
                    if *column == j {
                        entry = entry.plus(&p[i][*row].scaled(offset), -1);
                    }
                    if *column == i {
                        entry = entry.plus(&p[*row][j].scaled(offset), -1);
                    }
                }
                entry
            });
            at_vertex.is_positive_definite(DECAY, vertices.len() as u64)
        }),
        Deviation::Ball(radius) => {
            let taken = rational(p_up) * radius * 2;
            let at_worst = Entries::from_fn(order, |j, i| {
                let mut entry = centre.at(i, j).clone();
                if i == j {
                    entry.mean = entry.mean - &taken;
                }
                entry
            });
            at_worst.is_positive_definite(DECAY, 1)
        }
    }
}

/// The entries of a matrix, row by row.
fn entries(matrix: &PeriodicMatrix, precision: u32) -> Vec<Vec<TrigonometricPolynomial>> {
    let entry = |i: usize, j: usize| matrix.map(|rows| Enclosure::from_rational(&rows[i][j], precision));
    let order = matrix.mean.len();
    (0..order).map(|i| (0..order).map(|j| entry(i, j)).collect()).collect()
}

/// Proves `p_low I <= P(t) <= p_up I` for every t; all parts of P are symmetric and of one order, at least 1.
///
/// # Errors
/// The inequality that is not proved; this says nothing about its truth.
pub fn prove_bounds(
    matrix: &PeriodicMatrix,
    p_low: &Rational,
    p_up: &Rational,
    precision: u32,
) -> Result<(), NotProved> {
    let p = entries(matrix, precision);
    // Symmetric, so entry (i, j) with j <= i is asked for.
    let shifted = |scale: i64, shift: &Rational| {
        Entries::from_fn(p.len(), |j, i| {
            let mut entry = p[i][j].scaled(&Enclosure::from_integer(scale, precision));
            if i == j {
                entry.mean = entry.mean + Enclosure::from_rational(shift, precision);
            }
            entry
        })
    };
    shifted(1, &Rational::from(-p_low)).is_positive_definite("p_low I <= P", 1)?;
    shifted(-1, p_up).is_positive_definite("P <= p_up I", 1)
}

/// A symmetric matrix of trigonometric polynomials in the angle.
struct Entries(Symmetric<TrigonometricPolynomial>);

impl Entries {
    fn from_fn(order: usize, entry: impl Fn(usize, usize) -> TrigonometricPolynomial) -> Entries {
        Entries(Symmetric::from_fn(order, entry))
    }

    /// Proves that the matrix, one of so many, is positive definite at every angle.
    fn is_positive_definite(&self, what: &'static str, matrices: u64) -> Result<(), NotProved> {
        let degree = self.0.entries().iter().map(|entry| entry.harmonics.len()).max().unwrap_or(0);
        let failure = |angle: f64| NotProved::Inequality { what, angle };
        if degree == 0 {
            let proved = definite(self.0.order(), |i, j| self.0.at(i, j).mean.clone());
            return if proved { Ok(()) } else { Err(failure(0.0)) };
        }
        let cost = proof_cost(self.0.order(), degree, matrices);
        if cost > MAX_COST {
            return Err(NotProved::TooMuchWork);
        }
        let curvature = self.curvature();
        let count = cells(degree) as u32;
        let most = (HALVES.max(COST_OF_HALVES / cost) * u64::from(count)) as usize;
        // 2 pi < 62832/10000.
        let half = Rational::from((62_832, 20_000)) / count;
        let mut pending: Vec<Rational> = (0..count).map(|cell| Rational::from(&half * (2 * cell + 1))).collect();
        let mut half = half;
        let mut examined = 0;
        // Level by level, so that what is examined does not depend on the number of threads.
        for _ in 0..=MAX_HALVINGS {
            examined += pending.len();
            let outcomes: Vec<Option<bool>> = parallel::map(&pending, |angle| {
                let holds = |half: &Rational| self.holds_on(angle, half, degree, &curvature);
                // What fails at a single angle fails on every half around it.
                if holds(&half) { Some(true) } else { holds(&Rational::new()).then_some(false) }
            });
            if let Some(at) = outcomes.iter().position(Option::is_none) {
                return Err(failure(pending[at].to_f64()));
            }
            let quarter = Rational::from(&half / 2u32);
            let open = pending.iter().zip(&outcomes).filter(|(_, outcome)| **outcome == Some(false));
            pending = open
                .flat_map(|(angle, _)| [Rational::from(angle - &quarter), Rational::from(angle + &quarter)])
                .collect();
            half = quarter;
            let Some(first) = pending.first() else { return Ok(()) };
            if examined + pending.len() > most {
                return Err(failure(first.to_f64()));
            }
        }
        Err(failure(pending.first().map_or(0.0, Rational::to_f64)))
    }

    /// Row sums of the bounds of the second derivative: `sum_j sum_k k^2 (|a_k| + |b_k|)` over the entries of each row.
    fn curvature(&self) -> Vec<Enclosure> {
        let precision = self.0.at(0, 0).mean.precision();
        let entry = |i: usize, j: usize| self.0.at(i, j).harmonics.iter().zip(1_i64..);
        (0..self.0.order())
            .map(|i| {
                (0..self.0.order())
                    .flat_map(|j| entry(i, j))
                    .fold(Enclosure::zero(precision), |sum, ([a, b], k)| sum + (a.abs() + b.abs()).ceiling() * (k * k))
            })
            .collect()
    }

    /// Whether the matrix is proved to be positive definite at every angle within `half` of `angle`.
    fn holds_on(&self, angle: &Rational, half: &Rational, degree: usize, curvature: &[Enclosure]) -> bool {
        let precision = curvature[0].precision();
        let angle = Enclosure::from_rational(angle, precision);
        // By the addition theorem: a sine or cosine costs as much as fifty products.
        let first = angle.cos_sin();
        let next =
            |[cos, sin]: &[Enclosure; 2]| Some([cos * &first[0] - sin * &first[1], sin * &first[0] + cos * &first[1]]);
        let waves: Vec<[Enclosure; 2]> = std::iter::successors(Some(first.clone()), next).take(degree).collect();
        let value_and_slope = self.0.map(|_, _, entry| {
            let start = [entry.mean.clone(), Enclosure::zero(precision)];
            entry.harmonics.iter().zip(&waves).zip(1_i64..).fold(start, |[value, slope], (([a, b], [cos, sin]), k)| {
                [value + a * cos + b * sin, slope + (b * cos - a * sin) * k]
            })
        });
        let half = Enclosure::from_rational(half, precision);
        let remainder = half.sqr() / 2;
        [1_i64, -1].iter().all(|sign| {
            let step = &half * *sign;
            definite(self.0.order(), |i, j| {
                let [value, slope] = value_and_slope.at(i, j);
                let entry = value + &step * slope;
                if i == j { entry - &remainder * &curvature[i] } else { entry }
            })
        })
    }
}

fn definite(order: usize, entry: impl Fn(usize, usize) -> Enclosure + Sync) -> bool {
    ScaledMatrix::from_enclosures(order, entry).is_some_and(|matrix| matrix.is_positive_definite().is_true())
}

#[cfg(test)]
mod tests {
    use super::*;
    use sigmastar_lang::expr::{Expr, Variables};
    use sigmastar_lang::spec::model::{Constant, Jacobian, JacobianEntry};

    fn constant(text: &str) -> Constant {
        let expr = Expr::parse(text, Variables::None).unwrap();
        Constant { text: text.to_owned(), exact: expr.exact(), expr }
    }

    /// Entries with a comma are intervals.
    fn family(rows: &[&[&str]]) -> Family {
        let entry = |text: &&str| match text.split_once(',') {
            Some((low, up)) => JacobianEntry::Interval(Box::new([constant(low), constant(up)])),
            None => JacobianEntry::Function(Expr::parse(text, Variables::Time).unwrap()),
        };
        let rows = rows.iter().map(|row| row.iter().map(entry).collect()).collect();
        let period = constant("1");
        Family::new(&Jacobian { rows, period: period.exact.clone() }, &period.into(), 128).unwrap()
    }

    fn rows(entries: &[&[(i32, i32)]]) -> Vec<Vec<Rational>> {
        entries.iter().map(|row| row.iter().map(|entry| Rational::from(*entry)).collect()).collect()
    }

    fn scalar(alpha: (i32, i32)) -> ProvedTriple {
        let matrix = PeriodicMatrix { mean: rows(&[&[(1, 1)]]), harmonics: Vec::new() };
        ProvedTriple {
            matrix,
            p_low: Rational::from((99, 100)),
            p_up: Rational::from((101, 100)),
            alpha: Rational::from(alpha),
        }
    }

    #[test]
    fn a_constant_rate_is_proved_up_to_its_value() {
        let family = family(&[&["-1/3"]]);
        assert_eq!(prove(&family, &scalar((333_333, 1_000_000))), Ok(()));
        assert!(matches!(prove(&family, &scalar((333_334, 1_000_000))), Err(NotProved::Inequality { .. })));
        for (p_low, p_up) in [((1, 1), (101, 100)), ((99, 100), (1, 1)), ((2, 1), (3, 1)), ((1, 3), (1, 2))] {
            let moved = ProvedTriple { p_low: Rational::from(p_low), p_up: Rational::from(p_up), ..scalar((1, 4)) };
            assert!(prove(&family, &moved).is_err(), "{p_low:?} {p_up:?}");
        }
        for alpha in [(0, 1), (-1, 1)] {
            assert_eq!(prove(&family, &scalar(alpha)), Err(NotProved::Shape));
        }
    }

    /// x' = (-1 + 2 cos(2 pi t)) x: with constant P the rate is -1, and `P = exp(-2 int 2 cos)` has the rate 1. Its Fourier
    /// series is known, and five harmonics are close enough for a rate of 0.99.
    #[test]
    fn a_periodic_matrix_proves_what_no_constant_one_can() {
        let family = family(&[&["-1 + 2*cos(2*pi*t)"]]);
        assert!(prove(&family, &scalar((1, 1000))).is_err());
        // exp(-z sin a), z = 2/pi: I_0(z) + 2 sum ..., by quadrature.
        let z = 2.0 / std::f64::consts::PI;
        let samples: Vec<(f64, f64)> = (0..64)
            .map(|s| {
                let angle = std::f64::consts::TAU * f64::from(s) / 64.0;
                (angle, (-z * angle.sin()).exp())
            })
            .collect();
        let short = |value: f64| vec![vec![Rational::from_f64((value * 1e9).round() / 1e9).unwrap()]];
        let mean =
            |wave: &dyn Fn(f64) -> f64| samples.iter().map(|(angle, value)| value * wave(*angle)).sum::<f64>() / 64.0;
        let harmonics: Vec<_> = (1..=8)
            .map(|k| {
                let k = f64::from(k);
                [short(2.0 * mean(&|a| (k * a).cos())), short(2.0 * mean(&|a| (k * a).sin()))]
            })
            .collect();
        let matrix = PeriodicMatrix { mean: short(mean(&|_| 1.0)), harmonics };
        let witness = |alpha: (i32, i32)| ProvedTriple {
            matrix: matrix.clone(),
            p_low: Rational::from((1, 2)),
            p_up: Rational::from((19, 10)),
            alpha: Rational::from(alpha),
        };
        assert_eq!(prove(&family, &witness((99, 100))), Ok(()));
        assert!(prove(&family, &witness((101, 100))).is_err());
        // exp(-2/pi) = 0.5291 is the least value and exp(2/pi) = 1.890 the largest.
        let high = ProvedTriple { p_low: Rational::from((53, 100)), ..witness((1, 2)) };
        assert!(matches!(prove(&family, &high), Err(NotProved::Inequality { what: "p_low I <= P", .. })));
        let low = ProvedTriple { p_up: Rational::from((189, 100)), ..witness((1, 2)) };
        assert!(matches!(prove(&family, &low), Err(NotProved::Inequality { what: "P <= p_up I", .. })));
    }

    /// [[-1, d], [0, -1]] with |d| <= 1/2 and P = I: the rate is 1 - 1/4.
    #[test]
    fn intervals_are_taken_at_their_vertices_or_in_a_ball() {
        let matrix = PeriodicMatrix { mean: rows(&[&[(1, 1), (0, 1)], &[(0, 1), (1, 1)]]), harmonics: Vec::new() };
        let witness = |alpha: (i32, i32)| ProvedTriple { matrix: matrix.clone(), ..scalar(alpha) };
        let vertices = family(&[&["-1", "-1/2,1/2"], &["0", "-1"]]);
        assert_eq!(prove(&vertices, &witness((749, 1000))), Ok(()));
        assert!(prove(&vertices, &witness((751, 1000))).is_err());
        let lopsided = family(&[&["-1", "0,1/2"], &["0", "-2,-1"]]);
        assert_eq!(prove(&lopsided, &witness((749, 1000))), Ok(()));
        assert!(prove(&lopsided, &witness((751, 1000))).is_err());
        // The worst vertex has the lower end of one entry and the upper end of the other.
        let mixed = family(&[&["-1", "-3/4,1/4"], &["0", "-2,-1"]]);
        assert_eq!(prove(&mixed, &witness((624, 1000))), Ok(()));
        assert!(prove(&mixed, &witness((626, 1000))).is_err());
        // p_up = 101/100 enters the ball.
        let ball =
            Family { deviation: Deviation::Ball(Enclosure::from_rational(&Rational::from((1, 4)), 128)), ..vertices };
        assert_eq!(prove(&ball, &witness((746, 1000))), Ok(()));
        assert!(prove(&ball, &witness((749, 1000))).is_err());
    }

    /// One cell: what the values and slopes at its middle say, less the curvature over it.
    #[test]
    fn a_cell_counts_slope_and_curvature() {
        let holds = |mean: (i32, i32), harmonics: &[(i64, i64)], half: (i32, i32)| {
            let integer = |value: i64| Enclosure::from_integer(value, 128);
            let polynomial = TrigonometricPolynomial {
                mean: Enclosure::from_rational(&Rational::from(mean), 128),
                harmonics: harmonics.iter().map(|(a, b)| [integer(*a), integer(*b)]).collect(),
            };
            let degree = harmonics.len();
            let squares: i64 = harmonics.iter().zip(1_i64..).map(|((a, b), k)| (a.abs() + b.abs()) * k * k).sum();
            let entries = Entries::from_fn(1, |_, _| polynomial.clone());
            assert_eq!(entries.curvature()[0].lower_rational(), Some(Rational::from(squares)));
            entries.holds_on(&Rational::new(), &Rational::from(half), degree, &entries.curvature())
        };
        // 1/2 + cos a: positive up to 2 pi/3; its tangent at 0 is flat.
        assert!(holds((1, 2), &[(1, 0)], (1, 10)));
        assert!(!holds((1, 2), &[(1, 0)], (3, 1)));
        // cos 3a - 1/10 is negative at 1/2.
        assert!(holds((-1, 10), &[(0, 0), (0, 0), (1, 0)], (1, 5)));
        assert!(!holds((-1, 10), &[(0, 0), (0, 0), (1, 0)], (1, 2)));
        // 1/2 + sin 2a is negative at -3/10, and so is 1/2 - sin 2a at 3/10.
        for sign in [1, -1] {
            assert!(holds((1, 1), &[(0, 0), (0, sign)], (3, 10)));
            assert!(!holds((1, 2), &[(0, 0), (0, sign)], (3, 10)));
        }
    }

    #[test]
    fn what_is_not_a_symmetric_matrix_of_the_order_is_refused() {
        let family = family(&[&["-1", "0"], &["0", "-1"]]);
        assert_eq!(prove(&family, &scalar((1, 2))), Err(NotProved::Shape));
        let odd = PeriodicMatrix { mean: rows(&[&[(1, 1), (1, 10)], &[(0, 1), (1, 1)]]), harmonics: Vec::new() };
        assert_eq!(prove(&family, &ProvedTriple { matrix: odd, ..scalar((1, 2)) }), Err(NotProved::Shape));
        let mean = rows(&[&[(1, 1), (0, 1)], &[(0, 1), (1, 1)]]);
        let short = PeriodicMatrix { mean: mean.clone(), harmonics: vec![[mean, rows(&[&[(0, 1)]])]] };
        assert_eq!(prove(&family, &ProvedTriple { matrix: short, ..scalar((1, 2)) }), Err(NotProved::Shape));
    }
}
