//! The repaired derivation: the paper's architecture, every condition from the witness (docs/mathematics.md, sections 4 and 5).
//!
//! A report shows it beside the derivation of the claim; no claim rests on it.

use super::existence::Existence;
use proofs_core::bound::Bound;
use proofs_core::data::Data;
use proofs_core::interval::Interval;
use proofs_core::json::Fields;
use proofs_core::rules::derivation::{all, without_domain};
use proofs_core::rules::gains::{beta_s, k_alpha, kappas};
use proofs_core::rules::set::{self, ClaimedSet};
use proofs_core::rules::stability::distances;
use proofs_core::rules::transfer::{self, Proof};
use proofs_core::verdict::{Condition, Outcome};
use rug::Rational;

/// The free numbers.
#[derive(Clone, Debug)]
pub struct Witness {
    /// Where it stands in the file.
    pub pointer: String,
    pub sigma: Rational,
    /// The initial conditions.
    pub set: ClaimedSet,
    pub x: Rational,
    pub e: Rational,
    pub level: Rational,
    pub h: Rational,
    pub p_x: Rational,
    pub p_e: Rational,
    pub k0: Rational,
    pub k1: Rational,
    pub transfer: Proof,
}

impl Witness {
    /// Takes the free numbers out of a witness; what is left there is the caller's to refuse.
    pub fn read(fields: &mut Fields<'_>, sigma: Rational, set: ClaimedSet) -> Outcome<Witness> {
        let pointer = fields.pointer.clone();
        let [x, e, level, h, p_x, p_e, k0, k1] = fields.numbers(["X", "E", "L", "h", "p_x", "p_e", "k0", "k1"])?;
        let transfer = Proof::read(&fields.required("transfer")?)?;
        Ok(Witness { pointer, sigma, set, x, e, level, h, p_x, p_e, k0, k1, transfer })
    }
}

/// What the conditions and the constants are about.
pub struct Repaired {
    pub existence: Existence,
    /// rho_0, rho_11, rho_12, rho_22.
    pub rho: [Interval; 4],
    /// The three leading minors of R at sigma.
    pub minors: [Interval; 3],
    pub sigma_a: Interval,
    conditions: Vec<Condition>,
    /// The comparisons of the transfer proof.
    transfer: Vec<Condition>,
    /// X_b, E_b: the largest arguments.
    pub arguments: [Interval; 2],
}

/// Proves the derivation: its conditions, and the bounding functions up to its arguments.
pub fn prove(d: &Data<'_>, w: &Witness) -> Outcome<Repaired> {
    let repaired = evaluate(d, w)?;
    let mut lines = Vec::new();
    all("repaired", &w.pointer, repaired.transfer.iter().chain(&repaired.conditions), &mut lines)?;
    without_domain(d, &repaired.arguments, &mut lines)?;
    Ok(repaired)
}

/// Evaluates all conditions; nothing but the transfer proof and the signs is decided yet.
pub fn evaluate(d: &Data<'_>, w: &Witness) -> Outcome<Repaired> {
    let named = [
        ("X", &w.x),
        ("E", &w.e),
        ("L", &w.level),
        ("h", &w.h),
        ("p_x", &w.p_x),
        ("p_e", &w.p_e),
        ("k1", &w.k1),
        ("sigma", &w.sigma),
    ];
    set::positive(&named, &w.pointer)?;
    let [sigma, x, e, big_l, h, p_x, p_e] = [&w.sigma, &w.x, &w.e, &w.level, &w.h, &w.p_x, &w.p_e].map(|q| d.number(q));
    let k = k_alpha(d);
    let beta = beta_s(d, &sigma) * 2;
    let ex = Existence::new(d, x.clone(), e.clone());
    let z = ex.z_squared_paper(d, &kappas(d, &d.number(&w.k0), &d.number(&w.k1))).sqrt();
    let (x_b, e_b) = (&x + (&big_l / &d.p_low).sqrt(), &e + big_l.sqrt());
    let inner = d.bound(Bound::Fxx, &x, &e) * &x + d.bound(Bound::Fex, &x, &e) * &e;
    let rho_0 = &d.p_up * (inner + d.bound(Bound::Fxx, &x_b, &e) * (&x_b + &x) / 2);
    let (q_x, q_e) = (d.bound(Bound::Qx, &x_b, &e_b), d.bound(Bound::Qe, &x_b, &e_b));
    let ht = &h / &d.mu;
    let rho_11 = &rho_0 + &ht * q_x.sqr();
    let rho_12 = &d.p_up * d.bound(Bound::Fe, &x_b, &e_b) + q_x;
    let rho_22 = &q_e + ht * q_e.sqr();
    let room = &d.alpha * &d.p_low - &rho_11;
    let share = if room.is_positive() { rho_12.sqr() / (&room * 4) } else { Interval::undefined(d.precision) };
    let sigma_a = &rho_22 + &d.mu / (&h * 2) + share;
    // R = [[2 room, -rho_12, 0], [., 2 (sigma - rho_22), -mu], [., ., mu h]].
    let (first, excess) = (&room * 2, (&sigma - &rho_22) * 2);
    let second = &first * &excess - rho_12.sqr();
    let third = &d.mu * &h * &second - d.mu.sqr() * &first;
    let transfer = transfer::check(d, &w.k0, &w.k1, &w.transfer, &format!("{}/transfer", w.pointer))?;

    let mut conditions = set::covers(d, &w.set, [&w.x, &w.e], &z);
    conditions.extend(set::domain(d, &x_b, &e_b));
    conditions.push(transfer[0].clone());
    let what = "(K_alpha/alpha)(b_fe E + b_fxx X^2/2) <= X";
    conditions.push(Condition::at_most("C1", what, ex.invariance(d, &k), x.clone()));
    conditions.push(Condition::at_most("C2", "beta(sigma) b_q <= E", &beta * &ex.q, e.clone()));
    let [xx, xe, xe_gain, ee] = ex.contraction(d, &k, &beta);
    let (column_x, column_e) = (xx * &p_x + xe_gain * &p_e, xe * &p_x + ee * &p_e);
    conditions.push(Condition::less("C3", "Y_xx p_x + Y_ex p_e < p_x", column_x, p_x));
    conditions.push(Condition::less("C3b", "Y_xe p_x + Y_ee p_e < p_e", column_e, p_e));
    let [dx, de, dz] = distances(d, &w.set, [&x, &e, &z]);
    let start = &d.p_up * dx.sqr() + de.sqr() + h * dz.sqr();
    conditions.push(Condition::less("C4", "P_up (X_0+X)^2 + (E_0+E)^2 + h (Z_0+Nbar E_0+Z)^2 < L", start, big_l));
    conditions.push(Condition::less("C5", "rho_11 < alpha P_low", rho_11.clone(), &d.alpha * &d.p_low));
    conditions.push(Condition::less("C5b", "sigma_a < sigma", sigma_a.clone(), sigma));
    let (rho, minors, arguments) = ([rho_0, rho_11, rho_12, rho_22], [first, second, third], [x_b, e_b]);
    Ok(Repaired { existence: ex, rho, minors, sigma_a, conditions, transfer, arguments })
}
