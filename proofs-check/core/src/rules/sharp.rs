//! The sharp derivation: every condition from the witness (docs/mathematics.md, sections 5 and 10).
//!
//! Guarantee, if all conditions hold and the bounding functions are as proved up to `arguments`: for every n_o >= 0 and
//! every sigma' >= sigma (with an actuator for sigma alone) there is a T-periodic solution with |x| <= x_per, |e| <= e_per, |zeta|_N <= Z, and every
//! solution from the claimed set, at any initial time, converges to it exponentially.

use super::common::{Evaluated, Free};
use super::control;
use super::existence::{Existence, covers};
use super::gains::kappas;
use super::inequality::{Inequality, demand_plant};
use super::joint::Joint;
use super::mean_squares;
use super::set::ClaimedSet;
use super::transfer::{self, Proof};
use crate::data::Data;
use crate::input_gain;
use crate::json::Fields;
use crate::rules::common::Sizes;
use crate::verdict::{Outcome, Verdict, bad, finding, invalid};
use rug::Rational;

/// The free numbers.
#[derive(Clone, Debug)]
pub struct Witness {
    pub free: Free,
    pub sigma: Rational,
    pub existence: mean_squares::Witness,
    pub transfer: Proof,
    pub stability: Stability,
}

/// What proves that the error decays in the error box.
#[derive(Clone, Debug)]
pub enum Stability {
    /// C5, by norms.
    Norms,
    /// A matrix inequality in its place.
    Matrix(Box<Inequality>),
    /// Two joint metrics in its place and in that of C4.
    Joint(Box<Joint>),
}

impl Stability {
    fn read(fields: &mut Fields<'_>, free: &Free) -> Outcome<Stability> {
        match (fields.optional("matrix_inequality"), fields.optional("joint_inequality")) {
            (None, None) => Ok(Stability::Norms),
            (Some(field), None) => {
                Inequality::read(&field, [&free.w_x, &free.h]).map(|known| Stability::Matrix(Box::new(known)))
            }
            (None, Some(field)) => Joint::read(&field).map(|joint| Stability::Joint(Box::new(joint))),
            (Some(_), Some(field)) => bad(&field.pointer, "it has no place beside `matrix_inequality`"),
        }
    }

    /// An inequality is about formulas; two metrics are what they are said to be.
    fn demand(&self, d: &Data<'_>) -> Outcome<()> {
        match self {
            Stability::Norms => Ok(()),
            Stability::Matrix(inequality) => demand_plant(d, &inequality.pointer),
            Stability::Joint(joint) => joint.demand(d),
        }
    }

    /// The matrix inequality, where there is one.
    pub fn matrix(&self) -> Option<&Inequality> {
        if let Stability::Matrix(inequality) = self { Some(inequality) } else { None }
    }

    /// The joint one, where there is one.
    pub fn joint(&self) -> Option<&Joint> {
        if let Stability::Joint(joint) = self { Some(joint) } else { None }
    }
}

impl Witness {
    /// Takes the free numbers out of a witness; what is left there is the caller's to read or to refuse.
    pub fn read(fields: &mut Fields<'_>, sigma: Rational, set: ClaimedSet) -> Outcome<Witness> {
        if fields.has("p_x") && !fields.has("r_x") {
            return bad(&fields.pointer, "this witness, by p_x and p_e, is of an older form: certify again");
        }
        let free = Free::read(fields, set)?;
        let existence = mean_squares::Witness {
            r: free.r.clone(),
            kap: fields.number("kap")?,
            refined: fields.part("refined", mean_squares::read)?,
            inequality: fields.part("existence_inequality", Existence::read)?,
        };
        let transfer = Proof::read(&fields.required("transfer")?)?;
        let stability = Stability::read(fields, &free)?;
        Ok(Witness { free, sigma, existence, transfer, stability })
    }

    /// With two metrics nothing is proved about a gain.
    fn without_gain(&self, d: &Data<'_>) -> Outcome<()> {
        let existence = self.existence.inequality.as_ref().and_then(Existence::joint);
        match self.stability.joint().map(|joint| &joint.pointer).or(existence).filter(|_| d.gain.is_some()) {
            None => Ok(()),
            Some(pointer) => {
                let message = "two metrics are not available with `input_gain`: nothing is proved of them";
                Err(finding(Verdict::Undecided, input_gain::RULE, pointer, message))
            }
        }
    }

    fn signs(&self) -> Outcome<()> {
        let (w, pointer) = (&self.existence, &self.free.pointer);
        if w.kap < 0 {
            return invalid("signs", &format!("{pointer}/kap"), format!("0 <= kap fails: kap = {}", w.kap));
        }
        let refined = ["refined/r_x", "refined/r_e", "refined/r_d"].into_iter().zip(w.refined.iter().flatten());
        let others: Vec<_> = refined.chain([("k1", &self.free.k1), ("sigma", &self.sigma)]).collect();
        self.free.signs(&others)
    }
}

/// Evaluates all conditions; nothing but the transfer proof and the signs is decided yet.
pub fn evaluate(d: &Data<'_>, w: &Witness) -> Outcome<Evaluated> {
    w.signs()?;
    w.stability.demand(d)?;
    w.without_gain(d)?;
    let (free, inequality) = (&w.free, w.existence.inequality.iter());
    inequality.clone().try_for_each(|part| demand_plant(d, &part.pointer))?;
    let covers = inequality.flat_map(|part| covers(d, [&free.x_p, &free.e_p], [&part.x, &part.e]));
    let [sigma, w_x, h, x_p, e_p, k0, k1] =
        [&w.sigma, &free.w_x, &free.h, &free.x_p, &free.e_p, &free.k0, &free.k1].map(|value| d.number(value));
    let kappa = kappas(d, &k0, &k1);
    let solution = mean_squares::evaluate(d, &w.existence, &w.sigma, [&x_p, &e_p], [&k0, &k1], &kappa);
    let transfer = transfer::check(d, &free.k0, &free.k1, &w.transfer, &format!("{}/transfer", free.pointer))?;
    let sizes = Sizes { x: solution.x.clone(), e: solution.e.clone(), zeta: solution.z_squared.sqrt() };
    let existence = covers.chain(solution.conditions.iter().cloned());
    let (error_box, reach, mut evaluated) = free.evaluate(d, sizes, transfer, existence);
    let (levels, transient) = match w.stability.joint() {
        Some(joint) => {
            let levels = joint.levels(d, &reach, [&free.d_x, &free.d_e]);
            let transient = joint.transient(d, &levels, &w.sigma);
            (levels.to_vec(), transient)
        }
        None => {
            let share = match (&w.stability, &d.gain) {
                (Stability::Matrix(inequality), Some(_)) => d.number(&inequality.sigma) / &sigma,
                _ => d.int(1),
            };
            let (level, transient) = free.level(d, &reach, [&sigma, &d.mu], (false, &share));
            (vec![level], transient)
        }
    };
    evaluated.conditions.extend(levels);
    evaluated.control = control::put_out(d, [solution.steady.clone(), transient]);
    match &w.stability {
        Stability::Joint(joint) => evaluated.conditions.extend(joint.conditions(d, &error_box, &w.sigma)),
        Stability::Matrix(inequality) => {
            let place = (free.paths, [&solution.x, &solution.e], &error_box);
            evaluated.conditions.extend(inequality.conditions(d, place, (sigma, "sigma")));
        }
        Stability::Norms => {
            let decay = error_box.decay(d, [&w_x, &h], &sigma);
            evaluated.conditions.extend(error_box.conditions(decay, sigma, "sigma"));
        }
    }
    evaluated.conditions.extend(control::saturation(d, &evaluated.control));
    Ok(evaluated)
}
