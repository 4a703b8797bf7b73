//! What is known of all first derivatives together: (D) of derivation, 13.6, decided with enclosures by subdivision.
//!
//! With `D = [[J, g], [r, d]]` at a point, or the columns of x or that of e alone, `Q - G D - D'G' - D'H D >= 0` says that D lies in the matrix
//! ball `(D - C)'H (D - C) <= S` about `C = -H^-1 G'`, where `S = Q + G H^-1 G'`. Searches know C, S and H, proofs Q, G and H.

use super::PRECISION;
use super::centred::{Centred, negated};
use super::decide::{Decision, Values};
use super::definite::SymmetricValues;
use super::eigen::largest;
use super::engine::Engine;
use super::place::{Place, Places};
use super::pointwise::{Derivatives, product, roots, transposed};
use super::quantity::Part;
use super::suprema::FloatSuprema;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_lang::spec::Bound;
use sigmastar_matrix::{is_positive_definite, is_symmetric};

/// What a ball is enlarged by until it is proved, the boxes that each attempt may take, and the digits of its numbers; the
/// first is for derivatives that do not vary.
const ATTEMPTS: [(f64, usize, u32); 9] = [
    (1e-5, 8, 9),
    (3e-4, 2000, 9),
    (0.001, 2000, 9),
    (0.003, 2000, 9),
    (0.01, 2000, 9),
    (0.03, 3000, 9),
    (0.1, 6000, 9),
    (0.3, 12_000, 9),
    (0.3, 12_000, 15),
];

/// The least share of S that a ball may have.
const LEAST: f64 = 1e-3;

/// Q, G and H by rows, of a part of D with k columns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Slopes {
    /// The part.
    pub part: Part,
    /// Q: symmetric, of order k.
    pub q: Vec<Vec<Rational>>,
    /// G: k rows of n + 1.
    pub g: Vec<Vec<Rational>>,
    /// H: symmetric, positive definite, of order n + 1.
    pub h: Vec<Vec<Rational>>,
}

/// The ball of them in doubles, by rows.
#[derive(Clone, Debug)]
pub struct FloatSlopes {
    /// The part of D.
    pub part: Part,
    /// C.
    pub centre: Vec<Vec<f64>>,
    /// S.
    pub size: Vec<Vec<f64>>,
    /// H.
    pub h: Vec<Vec<f64>>,
}

impl Engine {
    /// Decides (D), with so many boxes at most.
    ///
    /// Guarantee: `True` only if H is positive definite, and for every t, every point of `|y| <= X`, `|e| <= E` around any x_0 within r of
    /// xb, and this part D of the derivatives of (f, q) by (x, e) there in the coordinates y, `Q - G D - D'G' - D'H D` is positive definite.
    /// `False` only if it is not so at a point, or a matrix is not of its shape. For the caller to prove: what [`Engine::decide`] leaves to him.
    #[must_use]
    pub fn decide_slopes(&self, slopes: &Slopes, [x, e]: [&Rational; 2], effort: usize) -> Decision {
        let Slopes { part, q, g, h } = slopes;
        let (order, columns) = (self.states() + 1, part.columns(self.states()).len());
        let fits = g.len() == columns && g.iter().all(|row| row.len() == order);
        if !is_symmetric(q, columns) || !is_symmetric(h, order) || !fits || !is_positive_definite(h) {
            return Decision::FALSE;
        }
        if *x < 0 || *e < 0 {
            return Decision::UNDECIDED;
        }
        self.decide_part(*part, [x, e], effort, |values| slopes.form(values))
    }

    /// (D) for a ball little larger than this one, which is proved with [`Engine::smooth`]; `None` if none is.
    #[must_use]
    pub fn prove_slopes(&self, slopes: &FloatSlopes, at: [&Rational; 2]) -> Option<Slopes> {
        let [x, e] = at;
        self.smooth(x, e).ok()?;
        ATTEMPTS.into_iter().find_map(|(slack, effort, digits)| {
            let rounded = slopes.of_share(1.0 + slack).rounded(digits)?;
            self.decide_slopes(&rounded, at, effort).truth.is_true().then_some(rounded)
        })
    }

    /// X + r in doubles, and E.
    #[must_use]
    pub fn float_arguments(&self, [x, e]: [&Rational; 2]) -> [f64; 2] {
        [self.reach(x), e.to_f64()]
    }
}

impl Slopes {
    /// `Q - G D - D'G' - D'H D` in the coordinates y.
    fn form(&self, values: &Values<'_>) -> Option<SymmetricValues> {
        let frame = values.frame;
        let region = values.engine.region();
        let n = region.states();
        let columns = self.part.columns(n);
        // The columns of x, if it has them, and that of e, in the coordinates x.
        let mut d = values.matrix();
        let of_x = columns.len().min(n) * usize::from(columns.start == 0);
        let of_e: Vec<Vec<Centred>> = d.iter_mut().map(|row| row.split_off(of_x)).collect();
        if of_x > 0 {
            d = values.product(region.matrix(), &d, true);
        }
        d.iter_mut().zip(of_e).for_each(|(row, own)| row.extend(own));
        let of_q = d.pop()?;
        d = values.product(region.inverse(), &d, false);
        d.push(of_q);
        let (turned, weighed) = (values.product(&self.g, &d, false), values.product(&self.h, &d, false));
        let entry = |i: usize, j: usize| {
            let square = d.iter().zip(&weighed).filter(|(d, weighed)| !d[i].is_zero() && !weighed[j].is_zero());
            let zero = frame.constant(Enclosure::zero(PRECISION));
            let square = square.fold(zero, |sum, (d, weighed)| frame.add(&sum, &frame.mul(&d[i], &weighed[j])));
            let taken = frame.add(&frame.add(&turned[i][j], &turned[j][i]), &square);
            frame.add(&frame.rational(&self.q[i][j]), &negated(&taken))
        };
        let order = columns.len();
        let upper = (0..order).flat_map(|i| (i..order).map(move |j| (i, j)));
        Some(SymmetricValues { order, entries: upper.map(|(i, j)| (i, j, entry(i, j))).collect() })
    }
}

impl FloatSlopes {
    /// The ball with S times a number.
    #[must_use]
    pub fn of_share(&self, share: f64) -> FloatSlopes {
        let size = self.size.iter().map(|row| row.iter().map(|entry| entry * share).collect()).collect();
        FloatSlopes { size, ..self.clone() }
    }

    /// Q, G and H, with so many digits; `None` where one is not finite.
    #[must_use]
    pub fn rounded(&self, digits: u32) -> Option<Slopes> {
        let FloatSlopes { part, centre, size, h } = self;
        let short = |value: f64| round_f64(value, digits, Direction::Nearest);
        let symmetric = |of: &Vec<Vec<f64>>| {
            let entry = |i: usize, j: usize| short(of[i.max(j)][i.min(j)]);
            (0..of.len()).map(|i| (0..of.len()).map(|j| entry(i, j)).collect()).collect::<Option<Vec<Vec<_>>>>()
        };
        let weighed = product(h, centre);
        let square = product(&transposed(centre), &weighed);
        let q = size.iter().zip(&square).map(|(a, b)| a.iter().zip(b).map(|(a, b)| a - b).collect()).collect();
        let g: Option<Vec<Vec<Rational>>> =
            transposed(&weighed).iter().map(|row| row.iter().map(|entry| short(-entry)).collect()).collect();
        Some(Slopes { part: *part, q: symmetric(&q)?, g: g?, h: symmetric(h)? })
    }
}

impl FloatSuprema {
    /// The largest share of S that a point asks for, by a longer search; `None` where S is not positive definite, or a value not finite.
    fn largest_share(&self, slopes: &FloatSlopes, at: [f64; 2]) -> Option<f64> {
        let [_, root] = roots(&slopes.size);
        let found = self.refined_of_derivatives(at, |derivatives, _| {
            let mut moved = matrix_of(derivatives, slopes.part);
            for (row, centre) in moved.iter_mut().zip(&slopes.centre) {
                row.iter_mut().zip(centre).for_each(|(entry, centre)| *entry -= centre);
            }
            let moved = product(&moved, &root);
            largest(product(&transposed(&moved), &product(&slopes.h, &moved)))
        });
        found.is_finite().then_some(found.max(0.0))
    }

    /// The ball with the S that samples ask for; `None` where they do not.
    #[must_use]
    pub fn fitted(&self, slopes: &FloatSlopes, at: [f64; 2]) -> Option<FloatSlopes> {
        self.largest_share(slopes, at).map(|need| slopes.of_share(need.max(LEAST)))
    }

    /// Places where derivatives are extreme, which a search may begin with.
    #[must_use]
    pub fn extreme_places(&self, at: [f64; 2]) -> Vec<Place> {
        self.where_largest(
            at,
            &Places::Stride(1),
            [Bound::Rate, Bound::Qx, Bound::Fe, Bound::Fx, Bound::QeMax, Bound::Qe],
        )
    }

    /// This part of D at these places, each once.
    #[must_use]
    pub fn derivatives_at(&self, part: Part, at: [f64; 2], places: &[Place]) -> Vec<Vec<Vec<f64>>> {
        let places = Places::listed(places.to_vec());
        self.of_derivatives(at, &places, |derivatives, _| matrix_of(derivatives, part))
    }

    /// The places, so many at most, where a value of this part of D is largest of those where it is positive.
    #[must_use]
    pub fn places_beyond(
        &self,
        part: Part,
        at: [f64; 2],
        count: usize,
        value: impl Fn(&[Vec<f64>]) -> f64 + Sync,
    ) -> Vec<Place> {
        let worst = self.largest_of_derivatives(at, &Places::Stride(1), count, |derivatives, _| {
            value(&matrix_of(derivatives, part))
        });
        worst.into_iter().filter(|(value, _)| *value > 0.0).map(|(_, place)| place).collect()
    }
}

/// A part of D by rows.
pub(super) fn matrix_of(Derivatives { j, g, r, d }: &Derivatives<'_>, part: Part) -> Vec<Vec<f64>> {
    let n = g.len();
    let columns = part.columns(n);
    let row =
        |of_x: &[f64], of_e: f64| of_x.iter().copied().chain([of_e]).collect::<Vec<f64>>()[columns.clone()].to_vec();
    (0..n).map(|i| row(&j[i * n..(i + 1) * n], g[i])).chain([row(r, *d)]).collect()
}
