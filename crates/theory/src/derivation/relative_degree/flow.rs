//! The flow of `1/p` in coordinates in which it is a contraction.
//!
//! With the polynomials q_k and the numbers b_k of [`Routh`], z_k = q_{k-1}(d/dt) g (k = 1, ..., n) satisfies
//! `z_k' = z_{k+1} - b_{n-k+2} z_{k-1}` for k < n (no second term for k = 1) and `z_n' = -b_1 z_n - b_2 z_{n-1}`, with
//! z(0+) = e_n and g = z_1. Put y_k = sqrt(P_k) z_k with P_n = 1 and P_k = b_2 ... b_{n-k+1}. Then
//!
//! ```text
//! y' = S y,   S = (skew, tridiagonal: S_{k,k+1} = r_k = -S_{k+1,k}, r_k = sqrt(b_{n-k+1})) - b_1 e_n e_n',
//! (|y|^2)' = -2 b_1 y_n^2 <= 0,   so   |exp(S t)| <= 1 for every t >= 0   (spectral norm),
//! g = y_1/sqrt(P_1),   y(0) = e_n.
//! ```
//!
//! So errors only add up along the flow, whatever the stiffness, and squaring exp(S h) doubles its error at most.

use super::Routh;
use super::ranges::{NORM_PRECISION, Ranges, dot, factor, norm, point_norm, scale, split};
use rug::Float;
use rug::float::Round;
use rug::ops::{AddAssignRound, AssignRound, DivAssignRound, SubAssignRound};
use sigmastar_exact::enclosure::Enclosure;

/// A point vector y~ with |y - y~| <= error.
#[derive(Clone, Debug)]
pub(super) struct State {
    pub(super) y: Vec<Float>,
    pub(super) error: Enclosure,
}

/// A point matrix M, row by row, with |exp(S h) - M| <= error in the spectral norm, h = 2^exponent.
#[derive(Clone, Debug)]
pub(super) struct Block {
    matrix: Vec<Float>,
    error: Enclosure,
    pub(super) exponent: i32,
}

/// The matrix S and exp(S h) for h = h_0, 2 h_0, 4 h_0, ...
#[derive(Clone, Debug)]
pub(super) struct Flow {
    n: usize,
    links: Vec<Enclosure>,
    damping: Enclosure,
    precision: u32,
    pub(super) blocks: Vec<Block>,
}

impl Flow {
    /// The first block has h_0 |S| <= 1/4 (by a crude bound of |S|); `None` when the scales are out of range.
    pub(super) fn new(routh: &Routh, precision: u32) -> Option<Flow> {
        let n = routh.b.len();
        let damping = Enclosure::from_rational(&routh.b[0], precision);
        // Links 1, ..., n-1: sqrt of b_n, ..., b_2.
        let links: Vec<Enclosure> =
            routh.b[1..].iter().rev().map(|b| Enclosure::from_rational(b, precision).sqrt()).collect();
        // A tridiagonal matrix: row sums are at most b_1 + 2 max r_k, and so is the spectral norm.
        let size = links.iter().fold(Enclosure::zero(precision), |m, r| m.max(r)) * 2 + &damping;
        let exponent = size.upper().get_exp().filter(|e| e.abs() < 1 << 20)?;
        let mut flow = Flow { n, links, damping, precision, blocks: Vec::new() };
        let block = flow.first_block(-exponent - 2)?;
        flow.blocks.push(block);
        Some(flow)
    }

    /// The precision in bits of the states.
    pub(super) fn precision(&self) -> u32 {
        self.precision
    }

    /// S v.
    pub(super) fn apply(&self, v: &Ranges) -> Ranges {
        let mut result = Ranges::zero(self.n, self.precision);
        for k in 0..self.n {
            let (lower, upper) = (&mut result.lower[k], &mut result.upper[k]);
            // The factors are positive: the lower end of r [a, b] is r's upper end times a when a < 0, and so on.
            if k + 1 < self.n {
                let (a, b) = (&v.lower[k + 1], &v.upper[k + 1]);
                lower.assign_round(a * factor(&self.links[k], a, Round::Down), Round::Down);
                upper.assign_round(b * factor(&self.links[k], b, Round::Up), Round::Up);
            } else {
                let (a, b) = (&v.lower[k], &v.upper[k]);
                lower.sub_assign_round(b * factor(&self.damping, b, Round::Up), Round::Down);
                upper.sub_assign_round(a * factor(&self.damping, a, Round::Down), Round::Up);
            }
            if k > 0 {
                let (a, b) = (&v.lower[k - 1], &v.upper[k - 1]);
                lower.sub_assign_round(b * factor(&self.links[k - 1], b, Round::Up), Round::Down);
                upper.sub_assign_round(a * factor(&self.links[k - 1], a, Round::Down), Round::Up);
            }
        }
        result
    }

    /// `-integral of y_1 from a state on`, relative to it: the row w with w S = e_1', so that
    /// `integral_t^oo y_1 = -w y(t)`. The columns of w S = e_1' give w_2, w_4, ... and, back from the last column, the
    /// entries w_k of the other parity.
    pub(super) fn inverse_row(&self) -> Vec<Enclosure> {
        let n = self.n;
        let mut w = vec![Enclosure::zero(self.precision); n];
        let r = &self.links;
        if n == 1 {
            w[0] = -self.damping.recip();
            return w;
        }
        // Column j (from 0): w_{j-1} r_{j-1} - w_{j+1} r_j = (1 if j = 0), and w_{n-2} r_{n-2} = b_1 w_{n-1} last.
        w[1] = -r[0].recip();
        for j in (2..n - 1).step_by(2) {
            w[j + 1] = &w[j - 1] * &r[j - 1] / &r[j];
        }
        let first = if n.is_multiple_of(2) {
            w[n - 2] = &self.damping * &w[n - 1] / &r[n - 2];
            n - 2
        } else {
            w[n - 1] = &w[n - 2] * &r[n - 2] / &self.damping;
            n - 1
        };
        for j in (2..=first).rev().step_by(2) {
            w[j - 2] = &w[j] * &r[j - 1] / &r[j - 2];
        }
        w
    }

    /// exp(S h) by its Taylor polynomial, column by column. The remainder after k terms is
    /// `int_0^h (h-s)^{k-1}/(k-1)! exp(S s) S^k ds`, at most |h S|^k/k! because the flow contracts.
    fn first_block(&self, exponent: i32) -> Option<Block> {
        // |h S| <= 1/4, so that |h S|^k/k! < 2^-2k.
        let terms = self.precision / 2 + 1;
        let mut entries = vec![Enclosure::zero(self.precision); self.n * self.n];
        for column in 0..self.n {
            let mut term = Ranges::zero(self.n, self.precision);
            term.lower[column] += 1;
            term.upper[column] += 1;
            let mut sum = term.clone();
            for k in 1..terms {
                term = self.apply(&term);
                for row in 0..self.n {
                    let (lower, upper) = (&mut term.lower[row], &mut term.upper[row]);
                    *lower <<= exponent;
                    *upper <<= exponent;
                    lower.div_assign_round(k, Round::Down);
                    upper.div_assign_round(k, Round::Up);
                    sum.lower[row].add_assign_round(&*lower, Round::Down);
                    sum.upper[row].add_assign_round(&*upper, Round::Up);
                }
            }
            for row in 0..self.n {
                entries[row * self.n + column] = sum.get(row);
            }
        }
        let (matrix, error) = split(&entries, self.precision);
        let remainder = Float::with_val(NORM_PRECISION, 1) >> (2 * terms);
        let error = (error + Enclosure::new(remainder.clone(), remainder)).ceiling();
        error.is_bounded().then_some(Block { matrix, error, exponent })
    }

    /// Adds the block of twice the length. With |E| <= 1 and |E - M| <= d: `|E^2 - M^2| <= 2 d + d^2`.
    pub(super) fn double(&mut self) -> Option<()> {
        let block = self.blocks.last()?;
        let n = self.n;
        let entries: Vec<Enclosure> = (0..n * n)
            .map(|index| {
                let row = block.matrix[index / n * n..index / n * n + n].iter();
                dot(row, block.matrix.iter().skip(index % n).step_by(n), self.precision)
            })
            .collect();
        let (matrix, error) = split(&entries, self.precision);
        let error = (error + &block.error * 2 + block.error.sqr()).ceiling();
        let exponent = block.exponent + 1;
        error.is_bounded().then(|| self.blocks.push(Block { matrix, error, exponent }))
    }

    /// The state at time 0: e_n, exactly.
    pub(super) fn start(&self) -> State {
        let mut y = vec![Float::new(self.precision); self.n];
        if let Some(last) = y.last_mut() {
            *last += 1;
        }
        State { y, error: Enclosure::zero(NORM_PRECISION) }
    }

    /// The state after a block. With y = y~ + d: `exp(S h) y - M y~ = exp(S h) d + (exp(S h) - M) y~`.
    pub(super) fn advance(&self, state: &State, block: &Block) -> State {
        let entries: Vec<Enclosure> =
            block.matrix.chunks(self.n).map(|row| dot(row.iter(), state.y.iter(), self.precision)).collect();
        let (y, rounding) = split(&entries, self.precision);
        State { y, error: (&state.error + &block.error * point_norm(&state.y) + rounding).ceiling() }
    }
}

impl State {
    /// An upper bound of |y|.
    pub(super) fn norm(&self) -> Enclosure {
        (point_norm(&self.y) + &self.error).ceiling()
    }

    /// The point vector.
    pub(super) fn points(&self) -> Ranges {
        Ranges { lower: self.y.clone(), upper: self.y.clone() }
    }

    /// An enclosure of w y for a row w.
    pub(super) fn project(&self, w: &[Enclosure]) -> Enclosure {
        let precision = w.iter().map(Enclosure::precision).max().unwrap_or(NORM_PRECISION);
        let value = w.iter().zip(&self.y).fold(Enclosure::zero(precision), |sum, (w, y)| sum + w * Enclosure::point(y));
        let error = (norm(w.iter()) * &self.error).ceiling();
        value + error.negate().hull(&error)
    }
}

impl Block {
    /// The length h, exactly.
    pub(super) fn length(&self) -> Enclosure {
        scale(&Enclosure::one(NORM_PRECISION), self.exponent)
    }

    /// An upper bound of |exp(S h)|: the Frobenius norm of M plus the error.
    pub(super) fn frobenius(&self) -> Enclosure {
        (point_norm(&self.matrix) + &self.error).ceiling()
    }

    /// A sharper upper bound of |exp(S h)|, from `|M|^32 = |(M'M)^16| <= Frobenius norm of (M'M)^16`.
    pub(super) fn spectral(&self, n: usize) -> Enclosure {
        let precision = 2 * NORM_PRECISION;
        let column = |j: usize| self.matrix.iter().skip(j).step_by(n);
        let mut power: Vec<Enclosure> =
            (0..n * n).map(|index| dot(column(index / n), column(index % n), precision)).collect();
        for _ in 0..4 {
            power = (0..n * n)
                .map(|index| {
                    let row = power[index / n * n..index / n * n + n].iter();
                    row.zip(power.iter().skip(index % n).step_by(n))
                        .fold(Enclosure::zero(precision), |sum, (a, b)| sum + a * b)
                })
                .collect();
        }
        let root = (0..5).fold(norm(power.iter()), |x, _| x.sqrt());
        (root + &self.error).ceiling().min(&self.frobenius())
    }
}
