//! Functions whose formulas are 0/0 at 0, with their derivatives: `(e^x - 1)/x`, its reciprocal `x/(e^x - 1)`, `sin(x)/x`.
//!
//! Written as quotients they are undefined at 0, and near it every digit of theirs cancels. Here they are families of integrals
//! without a singularity (derivation, 11.7):
//!
//! ```text
//! E_k(x) = (d/dx)^k (e^x - 1)/x = int_0^1 s^k e^(s x) ds,
//! S_k(x) = (d/dx)^k sin(x)/x    = int_0^1 s^k cos(s x + k pi/2) ds.
//! ```
//!
//! Integration by parts makes a ladder of each, `x I_0 = d`, `x I_k + k I_(k-1) = d_k`. Going up it divides by x, which loses no
//! digits where `|x| >= 1` but those of k!; going down it divides by k, and errors shrink where `|x| < 1`. There it starts from
//! Taylor's polynomial at 0. The derivatives of `x/(e^x - 1) = 1/E_0(x)` are the coefficients of the reciprocal of a series.

mod double;
mod enclosure;

pub use double::{exprelr, sinc};

use crate::real::{Operand, Real};

/// Which of the two families.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Family {
    /// E_k.
    Exponential,
    /// S_k.
    Wave,
}

impl Family {
    /// The sign of `I_m(0)`, which is this over `m + 1`.
    fn sign(self, m: usize) -> i64 {
        match (self, m % 4) {
            (Family::Exponential, _) | (Family::Wave, 0) => 1,
            (Family::Wave, 2) => -1,
            (Family::Wave, _) => 0,
        }
    }
}

/// `I_0, ..., I_last` from `x I_0 = start` and the `d_k`, which recur after four.
fn upward<R: Real>(x: &R, start: &R, ends: &[R; 4], last: usize) -> Vec<R>
where
    for<'a> &'a R: Operand<R>,
{
    let mut all = vec![start / x];
    for k in 1..=last {
        let next = (&ends[k % 4] - &all[k - 1] * R::int(k as i64)) / x;
        all.push(next);
    }
    all
}

/// `I_0, ..., I_last` by recursion downward from `I_last`.
fn downward<R: Real>(x: &R, top: R, ends: &[R; 4], last: usize) -> Vec<R>
where
    for<'a> &'a R: Operand<R>,
{
    let mut all = vec![top];
    for k in (1..=last).rev() {
        let next = (&ends[k % 4] - x * &all[last - k]) / R::int(k as i64);
        all.push(next);
    }
    all.reverse();
    all
}

/// The k-th derivative of 1/I from those of I, `I_0, ..., I_k`: with `f_j = I_j/j!` the coefficients r of the reciprocal have
/// `f_0 r_0 = 1` and `f_0 r_k = -(f_1 r_(k-1) + ... + f_k r_0)`.
fn of_reciprocal<R: Real>(all: &[R], one: &R) -> R
where
    for<'a> &'a R: Operand<R>,
{
    let mut factorial = one.clone();
    let mut f: Vec<R> = Vec::with_capacity(all.len());
    for (j, value) in all.iter().enumerate() {
        factorial = if j > 1 { factorial * R::int(j as i64) } else { factorial };
        f.push(value / &factorial);
    }
    let mut r: Vec<R> = Vec::with_capacity(f.len());
    for k in 0..f.len() {
        let own = if k == 0 { one.clone() } else { R::int(0) };
        let next = (1..=k).fold(own, |rest, i| rest - &f[i] * &r[k - i]) / &f[0];
        r.push(next);
    }
    r.pop().map_or_else(R::unknown, |last| last * factorial)
}

/// The k-th derivative of `b(x) = x/(e^x - 1)` from that at |x|: `b(-y) = b(y) + y`.
fn mirrored<R: Real>(k: usize, y: &R, at_y: R, negative: bool) -> R
where
    for<'a> &'a R: Operand<R>,
{
    match k {
        _ if !negative => at_y,
        0 => at_y + y,
        1 => R::int(-1) - at_y,
        _ if k % 2 == 1 => -at_y,
        _ => at_y,
    }
}
