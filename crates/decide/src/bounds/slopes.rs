//! What is known of all first derivatives together: (D) of derivation, 13.6, decided with enclosures by subdivision.
//!
//! With `D = [[J, g], [r, d]]` at a point, or the columns of x or that of e alone, `Q - G D - D'G' - D'H D >= 0` says that D lies in the matrix
//! ball `(D - C)'H (D - C) <= S` about `C = -H^-1 G'`, where `S = Q + G H^-1 G'`. Here Q, G and H are given; searches know C, S and H.

use super::PRECISION;
use super::centred::{Centred, negated};
use super::decide::{Decision, Values};
use super::definite::SymmetricValues;
use super::engine::Engine;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_matrix::{is_positive_definite, is_symmetric};
use sigmastar_theory::evidence::Slopes;

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
        self.decide_part(*part, [x, e], effort, |values| form(slopes, values))
    }

    /// X + r in doubles, and E.
    #[must_use]
    pub fn float_arguments(&self, [x, e]: [&Rational; 2]) -> [f64; 2] {
        [self.reach(x), e.to_f64()]
    }
}

/// `Q - G D - D'G' - D'H D` in the coordinates y.
fn form(slopes: &Slopes, values: &Values<'_>) -> Option<SymmetricValues> {
    let frame = values.frame;
    let region = values.engine.region();
    let n = region.states();
    let columns = slopes.part.columns(n);
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
    let (turned, weighed) = (values.product(&slopes.g, &d, false), values.product(&slopes.h, &d, false));
    let entry = |i: usize, j: usize| {
        let square = d.iter().zip(&weighed).filter(|(d, weighed)| !d[i].is_zero() && !weighed[j].is_zero());
        let zero = frame.constant(Enclosure::zero(PRECISION));
        let square = square.fold(zero, |sum, (d, weighed)| frame.add(&sum, &frame.mul(&d[i], &weighed[j])));
        let taken = frame.add(&frame.add(&turned[i][j], &turned[j][i]), &square);
        frame.add(&frame.rational(&slopes.q[i][j]), &negated(&taken))
    };
    let order = columns.len();
    let upper = (0..order).flat_map(|i| (i..order).map(move |j| (i, j)));
    Some(SymmetricValues { order, entries: upper.map(|(i, j)| (i, j, entry(i, j))).collect() })
}
