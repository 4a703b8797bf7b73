//! The matrices that a Jacobian of the specification stands for.

use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::expr::Monomial;
use sigmastar_lang::expr::TrigonometricPolynomial;
use sigmastar_lang::spec::Period;
use sigmastar_lang::spec::model::{Constant, Jacobian, JacobianEntry};

/// Up to this many interval entries every vertex is looked at (2^6 of them); beyond, a ball that contains the box.
const MAX_VERTEX_ENTRIES: usize = 6;

/// All F(t) = centre(t) + D with D as in [`Deviation`], in 1/time, w = 2 pi / period.
#[derive(Clone, Debug)]
pub struct Family {
    /// w; of a period that is known to an interval all that it may be.
    pub frequency: Enclosure,
    /// The rows of the centre, as polynomials in the angle w t.
    pub centre: Vec<Vec<TrigonometricPolynomial>>,
    /// What is added to it.
    pub deviation: Deviation,
}

/// What the interval entries add to the centre; it may change with time.
#[derive(Clone, Debug)]
pub enum Deviation {
    /// The convex hull of these sparse matrices (row, column, entry); one empty list where there are no intervals.
    Vertices(Vec<Vec<(usize, usize, Enclosure)>>),
    /// Every matrix of norm (Euclidean, induced) at most this: a bound of the root of the sum of the squared radii.
    Ball(Enclosure),
}

impl Family {
    /// The family of a Jacobian at a precision. `None` if the reader's promise is broken: an entry that is no trigonometric
    /// polynomial of the period.
    #[must_use]
    pub fn new(jacobian: &Jacobian, period: &Period, precision: u32) -> Option<Family> {
        let unit = Monomial::rational(Rational::from(1));
        let exact = jacobian.period.as_ref().unwrap_or(&unit);
        let (mut centre, mut radii) = (Vec::new(), Vec::new());
        for (i, row) in jacobian.rows.iter().enumerate() {
            let mut entries = Vec::new();
            for (j, entry) in row.iter().enumerate() {
                entries.push(match entry {
                    JacobianEntry::Function(expr) => expr.trigonometric(exact, precision).ok()?,
                    JacobianEntry::Interval(ends) => {
                        let [low, up] = &**ends;
                        let (low, up) = (low.enclose(precision), up.enclose(precision));
                        radii.push((i, j, ((&up - &low) / 2).ceiling()));
                        TrigonometricPolynomial { mean: (low + up) / 2, harmonics: Vec::new() }
                    }
                });
            }
            centre.push(entries);
        }
        let deviation = if radii.len() <= MAX_VERTEX_ENTRIES {
            let vertex = |signs: usize| {
                let signed = |(at, (i, j, radius)): (usize, &(usize, usize, Enclosure))| {
                    (*i, *j, if signs >> at & 1 == 1 { radius.negate() } else { radius.clone() })
                };
                radii.iter().enumerate().map(signed).collect()
            };
            Deviation::Vertices((0..1 << radii.len()).map(vertex).collect())
        } else {
            let squares = radii.iter().fold(Enclosure::zero(precision), |sum, (_, _, radius)| sum + radius.sqr());
            Deviation::Ball(squares.sqrt().ceiling())
        };
        let frequency = |end: &Constant| Enclosure::pi(precision) * 2 / end.enclose(precision);
        let frequency = frequency(period.longest()).hull(&frequency(period.shortest()));
        Some(Family { frequency, centre, deviation })
    }

    /// n.
    #[must_use]
    pub fn order(&self) -> usize {
        self.centre.len()
    }

    /// The highest harmonic of the centre.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.centre.iter().flatten().map(|entry| entry.harmonics.len()).max().unwrap_or(0)
    }
}

/// What the cells of a proof may cost at least, in multiplications; a proof whose cells, none of them halved, cost more is
/// not tried.
pub const MAX_COST: u64 = 20_000_000;

/// The cells that [0, 2 pi] is cut into at first, for matrices of this degree.
#[must_use]
pub fn cells(degree: usize) -> u64 {
    8 * (degree as u64 + 1)
}

/// What the cells of a proof cost, none of them halved: for so many matrices of an order and degree the sines and cosines,
/// the entries, the definiteness at both ends.
#[must_use]
pub fn proof_cost(order: usize, degree: usize, matrices: u64) -> u64 {
    let (n, k) = (order as u64, degree as u64 + 1);
    cells(degree) * matrices * (100 + (n * (n + 1) + 8) * k + n * n * n)
}

/// Whether a P(t) of a degree is worth proposing for a family: its proof would not take too much work.
#[must_use]
pub fn is_provable(order: usize, degree: usize, vertices: usize) -> bool {
    proof_cost(order, degree, vertices as u64) <= MAX_COST
}
