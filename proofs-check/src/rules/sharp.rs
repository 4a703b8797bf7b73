//! The sharp derivation: every condition from the witness (docs/mathematics.md, sections 4 and 5).
//!
//! Guarantee, if all conditions hold and the bounding functions are as proved up to `arguments`: for every n_o >= 0 and
//! every sigma' >= sigma there is a T-periodic solution with |x| <= x_per, |e| <= e_per, |zeta|_N <= Z, and every
//! solution from the claimed set, at any initial time, converges to it exponentially.

use super::existence::{Existence, beta_s, kappas, tau};
use super::set;
use super::stability::{ErrorBox, distances, level};
use super::transfer::{self, Proof};
use crate::data::Data;
use crate::interval::Interval;
use crate::verdict::{Condition, Outcome};
use rug::Rational;

/// The free numbers.
#[derive(Clone, Debug)]
pub struct Witness {
    /// Where it stands in the file.
    pub pointer: String,
    pub sigma: Rational,
    /// X_0, E_0, Z_0.
    pub set: [Rational; 3],
    pub x_p: Rational,
    pub e_p: Rational,
    pub d_x: Rational,
    pub d_e: Rational,
    pub p_x: Rational,
    pub p_e: Rational,
    pub w_x: Rational,
    pub h: Rational,
    pub k0: Rational,
    pub k1: Rational,
    pub transfer: Proof,
}

/// What the conditions, the claim and the constants are about.
pub struct Sharp {
    pub existence: Existence,
    pub x_per: Interval,
    pub e_per: Interval,
    pub z: Interval,
    pub error_box: ErrorBox,
    pub threshold: Interval,
    pub conditions: Vec<Condition>,
    /// The comparisons of the transfer proof, any of which may stand for it in the list of conditions.
    pub transfer: Vec<Condition>,
    /// The largest X and E at which bounding functions are used.
    pub arguments: [Interval; 2],
}

/// Evaluates all conditions; nothing but the transfer proof and the signs is decided yet.
pub fn evaluate(d: &Data<'_>, w: &Witness) -> Outcome<Sharp> {
    #[rustfmt::skip]
    let named = [
        ("X_p", &w.x_p), ("E_p", &w.e_p), ("D_x", &w.d_x), ("D_e", &w.d_e), ("p_x", &w.p_x), ("p_e", &w.p_e),
        ("w_x", &w.w_x), ("h", &w.h), ("k1", &w.k1), ("sigma", &w.sigma),
    ];
    set::positive(&named, &w.pointer)?;
    let [sigma, d_x, d_e, p_x, p_e, w_x, h] =
        [&w.sigma, &w.d_x, &w.d_e, &w.p_x, &w.p_e, &w.w_x, &w.h].map(|q| d.number(q));
    let ex = Existence::new(d, d.number(&w.x_p), d.number(&w.e_p));
    let kappa = kappas(d, &d.number(&w.k0), &d.number(&w.k1));
    let z = ex.z_squared(d, &kappa).sqrt();
    let size = (beta_s(d, &sigma) * &ex.qr).min(&(tau(d, &sigma) * &ex.q1));
    let e_per = ex.e_p.min(&size);
    let x_per = ex.x_p.min(&(ex.x_gain(d) * &e_per));
    let error_box = ErrorBox::new(d, [&x_per, &e_per], &d_x, &d_e);
    let [coupling, curvature, threshold] = error_box.decay(d, &w_x, &h);
    let arguments = [ex.x_p.max(&error_box.x_b), ex.e_p.max(&error_box.e_b)];
    let transfer = transfer::check(d, &w.k0, &w.k1, &w.transfer, &format!("{}/transfer", w.pointer))?;

    let mut conditions = set::covers(d, &w.set, [&w.x_p, &w.e_p], &z);
    conditions.extend(set::domain(d, &arguments[0], &arguments[1]));
    conditions.push(transfer[0].clone());
    let [xx, xe, xe_gain, ee] = ex.contraction(d, &d.c, 1, &beta_s(d, &sigma));
    let [start, exit] = level(d, &distances(d, &w.set, [&x_per, &e_per, &z]), [&d_x, &d_e, &w_x, &h]);
    let what = "(c/alpha)(b_fe E_p + b_fxx X_p^2/2) <= X_p";
    conditions.push(Condition::at_most("C1", what, ex.invariance(d, &d.c), ex.x_p.clone()));
    conditions.push(Condition::less("C1b", "(c/alpha) b_fxx X_p/2 < 1", ex.share(d, &d.c), d.int(1)));
    conditions.push(Condition::at_most("C2", "min{beta_s(sigma) qr, tau(sigma) q1} <= E_p", size, ex.e_p.clone()));
    let (column_x, column_e) = (xx * &p_x + xe_gain * &p_e, xe * &p_x + ee * &p_e);
    conditions.push(Condition::less("C3", "A p_x + beta_s b_qx p_e < p_x", column_x, p_x));
    conditions.push(Condition::less("C3b", "B p_x + beta_s b_qe p_e < p_e", column_e, p_e));
    let what = "w_x P_up dX^2 + dE^2 + h dZ^2 < min{w_x P_low D_x^2, D_e^2}";
    conditions.push(Condition::less("C4", what, start, exit));
    conditions.push(Condition::less("C5", "(h/mu) k_x^2 < 4 w_x (alpha - gam)", coupling, curvature));
    conditions.push(Condition::less("C5b", "threshold of the quadratic form < sigma", threshold.clone(), sigma));
    Ok(Sharp { existence: ex, x_per, e_per, z, error_box, threshold, conditions, transfer, arguments })
}
