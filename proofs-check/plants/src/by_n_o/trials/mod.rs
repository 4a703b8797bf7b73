//! Trials at one gain of the law (docs/mathematics.md, sections 14.4 and 14.5).
//!
//! Guarantee of [`prove`]: for each entry Theorem T holds of its trial for every member of the family and every gain of the actuator, the solution is that
//! of the claim, and what the entry says is true. The defects are bounded (`defects`), the formulas are proved on the box around the trial (`around`), the
//! sizes of its curves are bounded (`sizes`, by `largest` and `answer`), and what follows is in `proofs_core::rules::by_n_o::tube`.

mod answer;
mod around;
mod defects;
mod largest;
mod sizes;

use super::linear::oscillators::{Regulator, Sampling};
use crate::read::Plant;
use crate::{ARGUMENT_PRECISION, PRECISION};
use around::Around;
use proofs_core::data::Data;
use proofs_core::interval::Interval;
use proofs_core::rules::by_n_o::claimed::{Entry, RULE};
use proofs_core::rules::by_n_o::trials::Trial;
use proofs_core::rules::by_n_o::{About, demand_form, tube};
use proofs_core::spec::Specification;
use proofs_core::verdict::Outcome;
use sizes::Of;

/// Proves every entry with its trial.
pub fn prove(
    spec: &Specification,
    plant: &Plant,
    about: &About<'_>,
    (claimed, trials): (&[Entry<'_>], &[Trial]),
    lines: &mut Vec<String>,
) -> Outcome<()> {
    demand_form(spec, claimed)?;
    let d = Data::new(spec, ARGUMENT_PRECISION);
    let regulator = Regulator {
        model: &spec.regulator,
        sigma: d.number(about.sigma),
        mu: about.at_samples.map_or_else(|| d.mu.clone(), |law| d.number(&law.terms.gain)),
        om: d.period.slowest(),
        at_samples: about.at_samples.map(|law| Sampling {
            h: d.period.only() / i64::from(law.terms.samples),
            samples: law.terms.samples,
            delayed: law.terms.delayed,
        }),
    };
    let circle = |p: u32| {
        let period = spec.period.nominal.enclose(p);
        [Interval::pi(p) * 2 / &period, period]
    };
    let in_short = circle(PRECISION);
    for (entry, trial) in claimed.iter().zip(trials) {
        let of = Of::new(&d, plant, &regulator, (&entry.oscillators, trial));
        let sizes = of.sizes(in_short.each_ref());
        let larger = trial.x_first.iter().map(|first| (&first.pointer, &first.radii));
        for (pointer, radii) in [(&trial.pointer, &trial.radii)].into_iter().chain(larger) {
            let [d_x, d_e] = radii.each_ref().map(|radius| d.number(radius));
            let [x, e] = [&sizes.x + d_x, &sizes.e + d_e];
            plant.known.lies_within([&*x.hi(), &*e.hi()], &format!("{pointer}/box"))?;
        }
        tube::prove(&d, about, (entry, trial), &sizes)?;

        let (around, name) =
            (Around::new(spec, plant, (about.sigma, about.at_samples.map(|law| law.terms)), trial)?, entry.about());
        let kappa = d.by_gain(|gain| &gain.high, &of.kappa);
        let cells = around.defects(circle, &kappa, &name)?;
        let boxes = around.on_box(in_short.each_ref(), &sizes.e, &name)?;
        lines.push(format!(
            "{RULE}: {name}: the periodic solution near the trial, by {boxes} boxes and {cells} cells of t"
        ));
    }
    Ok(())
}
