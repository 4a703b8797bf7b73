//! Claims about a sampled regulator: one gain sigma, one sampling period h (docs/mathematics.md, section 12).
//!
//! Guarantee, if all conditions hold and the bounding functions are as proved up to `arguments`: for this sigma and h, every
//! n_o < N_s/2 and every phase of the sampling grid there is a T-periodic solution with |x| <= x_per, |e| <= e_per at all times and
//! |zeta_k|_N <= Z at the samples, and every solution that is in the claimed set at a sample converges to it exponentially. With an
//! input gain, or for a family, that is so of each. A claim about every set of harmonics below N_s/2 that contains 0 is one about these in the place of the
//! first n_o (section 14.7). It is about exact arithmetic, without quantisation or saturation, and without a delay of
//! the computation, or with one of a sample that the law knows of (section 13.4). A matrix inequality, proved of the plant's formulas, may stand in the place of C5h, and another one beside S1 and S2.

pub mod claim;
pub mod delay;
pub mod existence;
pub mod gains;
pub mod law;
pub mod stability;
pub mod transfer;

use super::common::{Evaluated, Free, Sizes};
use super::control;
use super::inequality::List;
use super::set;
use crate::data::Data;
use crate::json::Fields;
use crate::scope::Scope;
use crate::verdict::{Outcome, bad, demand};
use delay::Past;
use law::{Law, Terms};

/// What it has besides the free numbers that both regulators have.
#[derive(Clone, Debug)]
pub struct Witness {
    pub terms: Terms,
    /// What a delay adds.
    pub past: Option<Past>,
}

impl Witness {
    /// Takes it out of a witness; `scope`: which oscillators the claim is about.
    pub fn read(fields: &mut Fields<'_>, claimed: &claim::Regulator<'_>, scope: Scope) -> Outcome<Witness> {
        fields.required("transfer")?.object(|proof| {
            let kind = proof.required("proof")?;
            let sampled = kind.text()? == "sampled";
            if sampled { Ok(()) } else { bad(&kind.pointer, "expected `sampled`, for a sampled regulator") }
        })?;
        let (sigma, gain, samples, delayed) =
            (claimed.sigma.clone(), claimed.gain.clone(), claimed.samples, claimed.delayed);
        let terms = Terms { sigma, samples, gain, weight_sum: fields.number("weight_sum")?, delayed, scope };
        Ok(Witness { terms, past: if delayed { Some(Past::read(fields)?) } else { None } })
    }

    fn signs(&self, free: &Free) -> Outcome<()> {
        set::positive(&[("sigma", &self.terms.sigma), ("gain", &self.terms.gain)], "/claim")?;
        free.signs(&[("k0", &free.k0)])?;
        demand(Some(free.k1 >= 0), "signs", &format!("{}/k1", free.pointer), "0 <= k1")
    }
}

/// Evaluates all conditions; S0, the transfer proof and the signs are decided here.
pub fn evaluate(d: &Data<'_>, (free, inequalities): (&Free, &List), w: &Witness) -> Outcome<Evaluated> {
    w.signs(free)?;
    let (law, List { stability, existence }) = (Law::new(d, &w.terms), inequalities);
    inequalities.demand(d)?;
    let of_law = law.conditions("/claim")?;
    let transfer = transfer::check(&law, &free.k0, &free.k1, &format!("{}/k0", free.pointer))?;
    let [x_p, e_p, w_x, eta, k0, k1] =
        [&free.x_p, &free.e_p, &free.w_x, &free.h, &free.k0, &free.k1].map(|value| d.number(value));
    let solution = existence::evaluate(&law, (&free.r, existence.as_ref()), [&x_p, &e_p], [&k0, &k1]);
    let covers = existence.iter().flat_map(|part| part.covers(d, [&free.x_p, &free.e_p]));
    let sizes = Sizes { x: solution.x, e: solution.e, zeta: solution.z };
    let existence = of_law.into_iter().chain(covers).chain(solution.conditions);
    let (error_box, reach, mut evaluated) = free.evaluate(d, sizes, vec![transfer], existence);
    if let Some(past) = &w.past {
        evaluated.conditions.push(past.conditions(&law, &free.set.e0, &free.pointer)?);
    }
    let past = w.past.as_ref().map(|past| past.level(&law, &solution.largest_y));
    let (level, transient) = free.level(d, &reach, [&law.sigma, &law.gain], (true, &d.int(1), past));
    evaluated.conditions.push(level);
    evaluated.control = control::put_out(d, [solution.steady, transient]);
    if let Some(part) = stability {
        let place = (free.paths, [&evaluated.sizes.x, &evaluated.sizes.e], &error_box);
        evaluated.conditions.extend(part.conditions(d, place, (&w.terms.sigma, "sigma")));
    } else {
        evaluated.conditions.extend(error_box.one_sided.iter().cloned());
        let gm = w.past.as_ref().map(|past| d.number(&past.gm));
        evaluated.conditions.extend(stability::conditions(&law, &error_box, [&w_x, &eta], gm.as_ref()));
    }
    evaluated.conditions.extend(control::saturation(d, &evaluated.control));
    Ok(evaluated)
}
