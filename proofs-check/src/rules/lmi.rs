//! C5 as a matrix inequality, where a certificate gives multipliers (derivation, section 5).
//!
//! Guarantee: with l_x, l_e, l_f >= 0, the symmetric matrix of the quadratic form in (xi, et, s, u_x, u_e, phi) plus the
//! multipliers' terms is positive definite for all data in the enclosures: all pivots of its elimination, in intervals,
//! are positive. Rows u_x, u_e, phi whose k is 0 are dropped.

use super::stability::ErrorBox;
use crate::data::Data;
use crate::interval::Interval;
use crate::verdict::{Outcome, demand, invalid};
use rug::Rational;

/// Proves the matrix positive definite; `[w_x, h, sigma]` are those of the witness.
pub fn check(
    d: &Data<'_>,
    b: &ErrorBox,
    [w_x, h, sigma]: [&Interval; 3],
    multipliers: &[Rational; 3],
    pointer: &str,
) -> Outcome<()> {
    if multipliers.iter().any(|l| *l < 0) {
        return invalid("matrix inequality", pointer, "the multipliers must be nonnegative");
    }
    let [l_x, l_e, l_f] = [0, 1, 2].map(|i| d.number(&multipliers[i]));
    let mut m = vec![vec![d.int(0); 6]; 6];
    let diagonal = [
        w_x * (&d.alpha - &b.gam) * 2 - &l_x * b.k_x.sqr(),
        sigma * 2 - &l_e * b.k_e.sqr() - &l_f * b.k_f.sqr(),
        h * &d.mu * 2,
        l_x,
        l_e,
        l_f,
    ];
    for (i, value) in diagonal.into_iter().enumerate() {
        m[i][i] = value;
    }
    let sides = [
        (0, 5, -(w_x * d.p_up.sqrt())),
        (1, 2, -&d.mu),
        (1, 3, d.int(-1)),
        (1, 4, d.int(-1)),
        (2, 3, h.clone()),
        (2, 4, h.clone()),
    ];
    for (i, j, value) in sides {
        m[i][j] = value.clone();
        m[j][i] = value;
    }
    let keep: Vec<usize> = (0..6).filter(|i| *i < 3 || ![&b.k_x, &b.k_e, &b.k_f][i - 3].is_zero()).collect();
    for (position, &k) in keep.iter().enumerate() {
        let positive = d.int(0).lt(&m[k][k]);
        demand(
            positive,
            "matrix inequality",
            pointer,
            format!("pivot {} of the matrix of C5 is positive", position + 1),
        )?;
        for &i in &keep[position + 1..] {
            for &j in &keep[position + 1..] {
                m[i][j] = &m[i][j] - &m[i][k] * &m[k][j] / &m[k][k];
            }
        }
    }
    Ok(())
}
