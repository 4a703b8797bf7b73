//! C5 as a matrix inequality, where the certificate has multipliers for it (docs/mathematics.md, section 5).
//!
//! Guarantee: with v = (xi, et, s, u_x, u_e, phi), the form of C5 plus `l_x (u_x^2 - k_x^2 xi^2) + l_e (u_e - m et)(u_e + k_e et) +
//! l_f (phi^2 - k_f^2 et^2)` is positive definite, where dq/de lies in [-k_e, m] (section 10.4; m = k_e in section 5). So C5 holds by it too, whatever the closed form says: the terms added
//! are at most 0 on the signals that are allowed.
//!
//! Every number that is not rational enters as an interval that contains it, and the matrix is proved positive definite for
//! all members of the intervals, the true one among them. A row is dropped only where its k is exactly 0, so that its
//! signal is 0, or where dq/de is exactly one number; then its multiplier must be 0. (The diagonal has the other multipliers, which are positive therefore.)

use proofs_core::data::Data;
use proofs_core::interval::Interval;
use proofs_core::json::{Field, join};
use proofs_core::matrix::positive_definite;
use proofs_core::rules::stability::ErrorBox;
use proofs_core::verdict::{Outcome, demand};
use rug::Rational;

const RULE: &str = "matrix inequality of C5";
const NAMES: [&str; 3] = ["l_x", "l_e", "l_f"];

/// Demands that the matrix at sigma, w_x, h with the multipliers of the part `lmi` is positive definite.
pub fn check(d: &Data<'_>, error_box: &ErrorBox, [sigma, w_x, h]: [&Rational; 3], part: &Field<'_>) -> Outcome<()> {
    let multipliers = part.object(|fields| fields.numbers(NAMES))?;
    let [sigma, w_x, h] = [sigma, w_x, h].map(|value| d.number(value));
    let [l_x, l_e, l_f] = multipliers.each_ref().map(|value| d.number(value));
    let ErrorBox { k_x, k_e, most, k_f, rate, .. } = error_box;
    let (o, one) = (d.int(0), d.int(1));
    let xi = &w_x * rate * 2 - &l_x * k_x.sqr();
    let mut et = &sigma * 2 - &l_e * most * k_e - &l_f * k_f.sqr();
    let mut et_s = -&d.mu;
    // Where dq/de is one number, u_e is `most` et.
    if (most + k_e).is_zero() {
        (et, et_s) = (et - most * 2, et_s + &h * most);
    }
    let cross = -(w_x * d.p_up.sqrt());
    // The lower triangle, in the order of v.
    let rows = [
        vec![xi],
        vec![o.clone(), et],
        vec![o.clone(), et_s, &h * &d.mu * 2],
        vec![o.clone(), -&one, h.clone(), l_x],
        vec![o.clone(), &l_e * (k_e - most) / 2 - one, h, o.clone(), l_e],
        vec![cross, o.clone(), o.clone(), o.clone(), o, l_f],
    ];
    let present = [!k_x.is_zero(), !(most + k_e).is_zero(), !k_f.is_zero()];
    for (index, value) in multipliers.iter().enumerate() {
        let fits = present[index] || *value == 0;
        demand(Some(fits), RULE, &join(&part.pointer, NAMES[index]), "the multiplier of a signal that vanishes is 0")?;
    }
    let keep = |index: usize| index < 3 || present[index - 3];
    let kept = |row: &Vec<Interval>| row.iter().enumerate().filter(|(j, _)| keep(*j)).map(|(_, x)| x.clone()).collect();
    let rows = rows.iter().enumerate().filter(|(i, _)| keep(*i)).map(|(_, row)| kept(row)).collect();
    demand(positive_definite(rows), RULE, &part.pointer, "the form of C5 with its multipliers is positive definite")
}
