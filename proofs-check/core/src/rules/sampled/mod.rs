//! Claims about a sampled regulator: one gain sigma, one sampling period h (docs/mathematics.md, section 12).
//!
//! Guarantee, if all conditions hold and the bounding functions are as proved up to `arguments`: for this sigma and h, every
//! n_o < N_s/2 and every phase of the sampling grid there is a T-periodic solution with |x| <= x_per, |e| <= e_per at all times and
//! |zeta_k|_N <= Z at the samples, and every solution that is in the claimed set at a sample converges to it exponentially. It is
//! about exact arithmetic, without delay, quantisation or saturation.

pub mod claim;
pub mod existence;
pub mod gains;
pub mod law;
pub mod stability;
pub mod transfer;

use super::mean_squares::Means;
use super::set;
use super::stability::{ErrorBox, distances, level};
use crate::data::Data;
use crate::interval::Interval;
use crate::json::Fields;
use crate::verdict::{Condition, Outcome, bad, demand};
use existence::Solution;
use law::{Law, Terms};
use rug::Rational;

/// The free numbers.
#[derive(Clone, Debug)]
pub struct Witness {
    /// Where it stands in the file.
    pub pointer: String,
    pub terms: Terms,
    /// X_0, E_0, Z_0.
    pub set: [Rational; 3],
    pub x_p: Rational,
    pub e_p: Rational,
    /// r_x, r_e, r_d.
    pub r: Means,
    pub d_x: Rational,
    pub d_e: Rational,
    pub w_x: Rational,
    /// The weight of zeta, `h` in the file.
    pub eta: Rational,
    pub k0: Rational,
    pub k1: Rational,
}

/// What the conditions and the claim are about.
pub struct Sampled {
    pub solution: Solution,
    pub conditions: Vec<Condition>,
    /// The comparison at j = 0 of the transfer proof, which stands in the list of conditions too.
    pub transfer: Vec<Condition>,
    /// The largest X and E at which bounding functions are used.
    pub arguments: [Interval; 2],
}

impl Witness {
    /// Takes the free numbers out of a witness.
    pub fn read(fields: &mut Fields<'_>, claimed: &claim::Regulator<'_>, set: [Rational; 3]) -> Outcome<Witness> {
        let mut proof = fields.required("transfer")?.fields()?;
        let kind = proof.required("proof")?;
        if kind.text()? != "sampled" {
            return bad(&kind.pointer, "expected `sampled`, for a sampled regulator");
        }
        proof.finish()?;
        let pointer = fields.pointer.clone();
        let mut number = |name: &str| fields.required(name)?.rational();
        let weight_sum = number("weight_sum")?;
        Ok(Witness {
            terms: Terms {
                sigma: claimed.sigma.clone(),
                samples: claimed.samples,
                gain: claimed.gain.clone(),
                weight_sum,
            },
            x_p: number("X_p")?,
            e_p: number("E_p")?,
            r: [number("r_x")?, number("r_e")?, number("r_d")?],
            d_x: number("D_x")?,
            d_e: number("D_e")?,
            w_x: number("w_x")?,
            eta: number("h")?,
            k0: number("k0")?,
            k1: number("k1")?,
            pointer,
            set,
        })
    }

    fn signs(&self) -> Outcome<()> {
        set::positive(&[("sigma", &self.terms.sigma), ("gain", &self.terms.gain)], "/claim")?;
        let mut named = vec![("X_p", &self.x_p), ("E_p", &self.e_p), ("D_x", &self.d_x), ("D_e", &self.d_e)];
        named.extend(["r_x", "r_e", "r_d"].into_iter().zip(&self.r));
        named.extend([("w_x", &self.w_x), ("h", &self.eta), ("k0", &self.k0)]);
        set::positive(&named, &self.pointer)?;
        demand(Some(self.k1 >= 0), "signs", &format!("{}/k1", self.pointer), "0 <= k1")
    }
}

/// Evaluates all conditions; S0, the transfer proof and the signs are decided here.
pub fn evaluate(d: &Data<'_>, w: &Witness) -> Outcome<Sampled> {
    w.signs()?;
    let law = Law::new(d, &w.terms);
    let of_law = law.conditions("/claim")?;
    let transfer = transfer::check(&law, &w.k0, &w.k1, &format!("{}/k0", w.pointer))?;
    let [x_p, e_p, d_x, d_e, w_x, eta, k0, k1] =
        [&w.x_p, &w.e_p, &w.d_x, &w.d_e, &w.w_x, &w.eta, &w.k0, &w.k1].map(|value| d.number(value));
    let solution = existence::evaluate(&law, &w.r, [&x_p, &e_p], [&k0, &k1]);
    let error_box = ErrorBox::new(d, [&solution.x, &solution.e], [&d_x, &d_e]);
    let arguments = [x_p.max(&error_box.x_b), e_p.max(&error_box.e_b)];

    let mut conditions = set::covers(d, &w.set, [&w.x_p, &w.e_p], &solution.z);
    conditions.extend(set::domain(d, &arguments[0], &arguments[1]));
    conditions.push(transfer.clone());
    conditions.extend(of_law);
    conditions.extend(solution.conditions.iter().cloned());
    let reach = distances(d, &w.set, [&solution.x, &solution.e, &solution.z]);
    let [start, exit] = level(d, &reach, [&d_x, &d_e, &w_x, &eta]);
    let what = "w_x P_up dX^2 + dE^2 + h dZ^2 < min{w_x P_low D_x^2, D_e^2}";
    conditions.push(Condition::less("C4", what, start, exit));
    conditions.extend(error_box.one_sided.iter().cloned());
    conditions.extend(stability::conditions(&law, &error_box, &stability::Weights { w_x: &w_x, eta: &eta }));
    Ok(Sampled { solution, conditions, transfer: vec![transfer], arguments })
}
