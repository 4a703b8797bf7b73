//! What samples say of all first derivatives together: a matrix ball for (D) of derivation, 13.6, in doubles. It proposes, and nothing rests
//! on it.
//!
//! With `D = [[J, g], [r, d]]` at a point, or the columns of x or that of e alone, `Q - G D - D'G' - D'H D >= 0` says that D lies in the matrix
//! ball `(D - C)'H (D - C) <= S` about `C = -H^-1 G'`, where `S = Q + G H^-1 G'`. Here C, S and H are sought; Q, G and H, rounded, are
//! what is to be decided.

use super::place::{Place, Places};
use super::pointwise::Derivatives;
use super::suprema::FloatSuprema;
use rug::Rational;
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_lang::spec::Bound;
use sigmastar_matrix::doubles::{largest, product, roots, transposed};
use sigmastar_theory::evidence::{Part, Slopes};

/// The least share of S that a ball may have.
const LEAST: f64 = 1e-3;

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
pub fn matrix_of(Derivatives { j, g, r, d }: &Derivatives<'_>, part: Part) -> Vec<Vec<f64>> {
    let n = g.len();
    let columns = part.columns(n);
    let row =
        |of_x: &[f64], of_e: f64| of_x.iter().copied().chain([of_e]).collect::<Vec<f64>>()[columns.clone()].to_vec();
    (0..n).map(|i| row(&j[i * n..(i + 1) * n], g[i])).chain([row(r, *d)]).collect()
}
