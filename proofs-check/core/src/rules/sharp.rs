//! The sharp derivation: every condition from the witness (docs/mathematics.md, sections 5 and 10).
//!
//! Guarantee, if all conditions hold and the bounding functions are as proved up to `arguments`: for every n_o >= 0, or every finite set of
//! harmonics that contains 0 in the place of the first n_o (section 14.7), and every sigma' >= sigma (with an actuator for sigma alone) there is a T-periodic solution with |x| <= x_per, |e| <= e_per, |zeta|_N <= Z, and every
//! solution from the claimed set, at any initial time, converges to it exponentially.

use super::common::{Evaluated, Free, Sizes};
use super::control;
use super::gains::kappas;
use super::inequality::{Inequality, List, share};
use super::joint;
use super::mean_squares;
use super::transfer::{self, Proof};
use crate::data::Data;
use crate::json::Fields;
use crate::scope::Scope;
use crate::verdict::{Outcome, invalid};
use rug::Rational;

/// What it has besides the free numbers that both regulators have.
#[derive(Clone, Debug)]
pub struct Witness {
    pub sigma: Rational,
    /// Which oscillators the claim is about.
    pub scope: Scope,
    pub existence: mean_squares::Witness,
    pub transfer: Proof,
}

impl Witness {
    /// Takes it out of a witness; what is left there is the caller's to read or to refuse.
    pub fn read(fields: &mut Fields<'_>, (sigma, scope): (Rational, Scope), free: &Free) -> Outcome<Witness> {
        let existence = mean_squares::Witness {
            r: free.r.clone(),
            kap: fields.number("kap")?,
            refined: fields.part("refined", mean_squares::read)?,
        };
        let transfer = Proof::read(&fields.required("transfer")?)?;
        Ok(Witness { sigma, scope, existence, transfer })
    }

    fn signs(&self, free: &Free) -> Outcome<()> {
        let (w, pointer) = (&self.existence, &free.pointer);
        if w.kap < 0 {
            return invalid("signs", &format!("{pointer}/kap"), format!("0 <= kap fails: kap = {}", w.kap));
        }
        let refined = ["refined/r_x", "refined/r_e", "refined/r_d"].into_iter().zip(w.refined.iter().flatten());
        let others: Vec<_> = refined.chain([("k1", &free.k1), ("sigma", &self.sigma)]).collect();
        free.signs(&others)
    }
}

/// Evaluates all conditions; nothing but the transfer proof and the signs is decided yet.
pub fn evaluate(d: &Data<'_>, (free, inequalities): (&Free, &List), w: &Witness) -> Outcome<Evaluated> {
    w.signs(free)?;
    let List { stability, existence } = inequalities;
    inequalities.demand(d)?;
    stability.iter().try_for_each(Inequality::demand_extents)?;
    inequalities.without_gain(d)?;
    let covers = existence.iter().flat_map(|part| part.covers(d, [&free.x_p, &free.e_p]));
    let [sigma, w_x, h, x_p, e_p, k0, k1] =
        [&w.sigma, &free.w_x, &free.h, &free.x_p, &free.e_p, &free.k0, &free.k1].map(|value| d.number(value));
    let kappa = kappas(d, &k0, &k1);
    let of_existence = (&w.existence, existence.as_ref());
    let place = format!("{}/transfer", free.pointer);
    let transfer = transfer::check(d, [&free.k0, &free.k1], (&w.transfer, w.scope), &place)?;
    let pair = ([&k0, &k1], transfer::at_poles(d, &w.transfer, w.scope));
    let solution = mean_squares::evaluate(d, of_existence, &w.sigma, [&x_p, &e_p], pair, &kappa);
    let sizes = Sizes { x: solution.x.clone(), e: solution.e.clone(), zeta: solution.z_squared.sqrt() };
    let existence = covers.chain(solution.conditions.iter().cloned());
    let (error_box, reach, mut evaluated) = free.evaluate(d, sizes, transfer, existence);
    let (levels, transient) = match stability.as_ref().and_then(|part| part.pair().map(|pair| (part, pair))) {
        Some((part, pair)) => {
            let levels = joint::levels(d, pair, &reach, [&free.d_x, &free.d_e]);
            let transient = joint::transient(d, pair, &levels, [&part.sigma, &w.sigma]);
            (levels.to_vec(), transient)
        }
        None => {
            let share = share(d, stability.as_ref(), &w.sigma);
            let (level, transient) = free.level(d, &reach, [&sigma, &d.mu], (false, &share, None));
            (vec![level], transient)
        }
    };
    evaluated.conditions.extend(levels);
    evaluated.control = control::put_out(d, [solution.steady.clone(), transient]);
    evaluated.conditions.extend(match stability {
        Some(part) => part.conditions(d, (free.paths, [&solution.x, &solution.e], &error_box), (&w.sigma, "sigma")),
        None => error_box.conditions(error_box.decay(d, [&w_x, &h], &sigma), sigma, "sigma"),
    });
    evaluated.conditions.extend(control::saturation(d, &evaluated.control));
    Ok(evaluated)
}
