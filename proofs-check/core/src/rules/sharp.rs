//! The sharp derivation: every condition from the witness (docs/mathematics.md, sections 5 and 10).
//!
//! Guarantee, if all conditions hold and the bounding functions are as proved up to `arguments`: for every n_o >= 0 and
//! every sigma' >= sigma there is a T-periodic solution with |x| <= x_per, |e| <= e_per, |zeta|_N <= Z, and every
//! solution from the claimed set, at any initial time, converges to it exponentially.

use super::gains::kappas;
use super::mean_squares::{self, Solution};
use super::set;
use super::stability::{ErrorBox, distances, level};
use super::transfer::{self, Proof};
use crate::data::Data;
use crate::interval::Interval;
use crate::verdict::{Condition, Outcome, invalid};
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
    pub existence: mean_squares::Witness,
    pub w_x: Rational,
    pub h: Rational,
    pub k0: Rational,
    pub k1: Rational,
    pub transfer: Proof,
}

impl Witness {
    fn signs(&self) -> Outcome<()> {
        let mut named = vec![("X_p", &self.x_p), ("E_p", &self.e_p), ("D_x", &self.d_x), ("D_e", &self.d_e)];
        let w = &self.existence;
        named.extend(["r_x", "r_e", "r_d"].into_iter().zip(&w.r));
        named.extend(["refined/r_x", "refined/r_e", "refined/r_d"].into_iter().zip(w.refined.iter().flatten()));
        if w.kap < 0 {
            return invalid("signs", &format!("{}/kap", self.pointer), format!("0 <= kap fails: kap = {}", w.kap));
        }
        named.extend([("w_x", &self.w_x), ("h", &self.h), ("k1", &self.k1), ("sigma", &self.sigma)]);
        set::positive(&named, &self.pointer)
    }
}

/// What the conditions, the claim and the constants are about.
pub struct Sharp {
    pub solution: Solution,
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
    w.signs()?;
    let [sigma, d_x, d_e, w_x, h] = [&w.sigma, &w.d_x, &w.d_e, &w.w_x, &w.h].map(|q| d.number(q));
    let at = [d.number(&w.x_p), d.number(&w.e_p)];
    let pair = [d.number(&w.k0), d.number(&w.k1)];
    let kappa = kappas(d, &pair[0], &pair[1]);
    let solution = mean_squares::evaluate(d, &w.existence, &w.sigma, at.each_ref(), pair.each_ref(), &kappa);
    let (periodic, z) = ([&solution.x, &solution.e], solution.z_squared.sqrt());
    let error_box = ErrorBox::new(d, periodic, [&d_x, &d_e]);
    let decay = error_box.decay(d, &w_x, &h);
    let arguments = [at[0].max(&error_box.x_b), at[1].max(&error_box.e_b)];
    let transfer = transfer::check(d, &w.k0, &w.k1, &w.transfer, &format!("{}/transfer", w.pointer))?;

    let mut conditions = set::covers(d, &w.set, [&w.x_p, &w.e_p], &z);
    conditions.extend(set::domain(d, &arguments[0], &arguments[1]));
    conditions.push(transfer[0].clone());
    conditions.extend(solution.conditions.iter().cloned());
    let reach = distances(d, &w.set, [periodic[0], periodic[1], &z]);
    let [start, exit] = level(d, &reach, [&d_x, &d_e, &w_x, &h]);
    let what = "w_x P_up dX^2 + dE^2 + h dZ^2 < min{w_x P_low D_x^2, D_e^2}";
    conditions.push(Condition::less("C4", what, start, exit));
    let threshold = decay[2].clone();
    conditions.extend(error_box.conditions(decay, sigma, "sigma"));
    Ok(Sharp { solution, z, error_box, threshold, conditions, transfer, arguments })
}
