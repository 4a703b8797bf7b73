//! Claims about a sampled regulator: one gain sigma, one sampling period h (docs/mathematics.md, section 12).
//!
//! Guarantee, if all conditions hold and the bounding functions are as proved up to `arguments`: for this sigma and h, every
//! n_o < N_s/2 and every phase of the sampling grid there is a T-periodic solution with |x| <= x_per, |e| <= e_per at all times and
//! |zeta_k|_N <= Z at the samples, and every solution that is in the claimed set at a sample converges to it exponentially. With an
//! input gain, or for a family, that is so of each. It is about exact arithmetic, without quantisation or saturation, and without a delay of
//! the computation, or with one of a sample that the law knows of (section 13.4). A matrix inequality, proved of the plant's formulas, may stand in the place of C5h, and another one beside S1 and S2.

pub mod claim;
pub mod delay;
pub mod existence;
pub mod gains;
pub mod inequality;
pub mod law;
pub mod stability;
pub mod transfer;

use super::common::{Evaluated, Free, Sizes};
use super::control;
use super::existence::covers;
use super::inequality::{RULE, demand_plant, reaches};
use super::set::{self, ClaimedSet};
use crate::data::Data;
use crate::json::Fields;
use crate::verdict::{Outcome, bad, demand};
use delay::Past;
use inequality::{Existence, Inequalities, Stability};
use law::{Law, Terms};

/// The free numbers.
#[derive(Clone, Debug)]
pub struct Witness {
    pub free: Free,
    pub terms: Terms,
    /// What stands in the place of C5h, where it is given.
    pub stability: Option<Stability>,
    /// What adds to S1 and S2, where it is given.
    pub existence: Option<Existence>,
    /// What a delay adds.
    pub past: Option<Past>,
}

impl Witness {
    /// Takes the free numbers out of a witness.
    pub fn read(fields: &mut Fields<'_>, claimed: &claim::Regulator<'_>, set: ClaimedSet) -> Outcome<Witness> {
        fields.required("transfer")?.object(|proof| {
            let kind = proof.required("proof")?;
            let sampled = kind.text()? == "sampled";
            if sampled { Ok(()) } else { bad(&kind.pointer, "expected `sampled`, for a sampled regulator") }
        })?;
        let (sigma, gain, samples) = (claimed.sigma.clone(), claimed.gain.clone(), claimed.samples);
        let weight_sum = fields.number("weight_sum")?;
        let free = Free::read(fields, set)?;
        let stability = fields.part("matrix_inequality", |field| Stability::read(field, [&free.w_x, &free.h]))?;
        let existence = fields.part("existence_inequality", Existence::read)?;
        let delayed = claimed.delayed;
        let by_matrix = stability.as_ref().map(|part: &Stability| &part.pointer);
        if let (true, Some(pointer)) = (delayed, by_matrix.or(existence.as_ref().map(|part| &part.pointer))) {
            return bad(pointer, "a matrix inequality says nothing of a law with a delay");
        }
        let past = if delayed { Some(Past::read(fields)?) } else { None };
        Ok(Witness { free, terms: Terms { sigma, samples, gain, weight_sum, delayed }, stability, existence, past })
    }

    /// Those that have to be proved of the formulas.
    pub fn inequalities(&self) -> Inequalities<'_> {
        Inequalities { law: &self.terms, stability: self.stability.as_ref(), existence: self.existence.as_ref() }
    }

    fn signs(&self) -> Outcome<()> {
        set::positive(&[("sigma", &self.terms.sigma), ("gain", &self.terms.gain)], "/claim")?;
        self.free.signs(&[("k0", &self.free.k0)])?;
        demand(Some(self.free.k1 >= 0), "signs", &format!("{}/k1", self.free.pointer), "0 <= k1")
    }
}

/// Evaluates all conditions; S0, the transfer proof and the signs are decided here.
pub fn evaluate(d: &Data<'_>, w: &Witness) -> Outcome<Evaluated> {
    w.signs()?;
    let (free, law) = (&w.free, Law::new(d, &w.terms));
    let mut pointers = w.existence.iter().map(|part| &part.pointer).chain(w.stability.iter().map(|part| &part.pointer));
    pointers.try_for_each(|pointer| demand_plant(d, pointer))?;
    let of_law = law.conditions("/claim")?;
    let transfer = transfer::check(&law, &free.k0, &free.k1, &format!("{}/k0", free.pointer))?;
    let [x_p, e_p, w_x, eta, k0, k1] =
        [&free.x_p, &free.e_p, &free.w_x, &free.h, &free.k0, &free.k1].map(|value| d.number(value));
    let solution = existence::evaluate(&law, (&free.r, w.existence.as_ref()), [&x_p, &e_p], [&k0, &k1]);
    let sizes = Sizes { x: solution.x, e: solution.e, zeta: solution.z };
    let covers = w.existence.iter().flat_map(|part| covers(d, [&free.x_p, &free.e_p], [&part.x, &part.e]));
    let existence = of_law.into_iter().chain(covers).chain(solution.conditions);
    let (error_box, reach, mut evaluated) = free.evaluate(d, sizes, vec![transfer], existence);
    let (level, transient) = match &w.past {
        None => free.level(d, &reach, [&law.sigma, &law.gain], (true, &d.int(1))),
        Some(past) => {
            evaluated.conditions.push(past.conditions(&law, &free.set.e0, &free.pointer)?);
            past.level(&law, free, &reach, &solution.largest_y)
        }
    };
    evaluated.conditions.push(level);
    evaluated.control = control::put_out(d, [solution.steady, transient]);
    if let Some(part) = &w.stability {
        evaluated.conditions.extend(reaches(d, &error_box, [&part.x, &part.e], RULE));
    } else {
        evaluated.conditions.extend(error_box.one_sided.iter().cloned());
        let gm = w.past.as_ref().map(|past| d.number(&past.gm));
        evaluated.conditions.extend(stability::conditions(&law, &error_box, [&w_x, &eta], gm.as_ref()));
    }
    evaluated.conditions.extend(control::saturation(d, &evaluated.control));
    Ok(evaluated)
}
