//! Kind (a): plants that are linear in x and e (docs/mathematics.md, sections 14.3 and 14.6).
//!
//! Guarantee of [`prove`]: Theorem L, or Theorem L_s of a claim at samples, for every member of the family and every gain. The forms fall (`falls`), so that there is one periodic solution
//! for each n_o; `steady` and the sizes of each entry bound it (`entry`), for the number of its n_o or, where no harmonic of the forcing is beyond it,
//! for every larger one.

mod answer;
mod answers;
mod between;
mod bound;
mod boxes;
pub(super) mod complex;
mod entry;
mod falls;
mod held;
pub(super) mod jet;
mod largest;
pub(super) mod oscillators;
mod ring;
mod series;
mod system;
#[cfg(test)]
mod tests;

use crate::machine::{Curves, Machine};
use crate::read::Plant;
use crate::{PRECISION, TAYLOR_PRECISIONS, too_large};
use boxes::{Computation, Whole, not_seen};
use entry::Entry;
use falls::Falls;
use largest::Times;
use oscillators::{Regulator, Sampling};
use proofs_core::input_gain::Gain;
use proofs_core::interval::Interval;
use proofs_core::rules::by_n_o::claimed::{self, RULE};
use proofs_core::rules::by_n_o::linear::Linear;
use proofs_core::rules::sampled::law::Terms;
use proofs_core::spec::Specification;
use proofs_core::verdict::{Outcome, Verdict, demand};
use rug::Rational;
use system::{Evaluator, System};

/// What is claimed and what is to be proved with it.
struct Question<'q> {
    spec: &'q Specification,
    plant: &'q Plant,
    sigma: &'q Rational,
    law: Option<&'q Terms>,
    claimed: &'q [claimed::Entry<'q>],
    witness: &'q Linear,
}

/// Proves (14.3a) of each form, or (14.6a), and `steady` and the sizes of each entry; the formulas are proved to be smooth where they are used. The law is
/// that of a claim at samples, of which S0 is proved.
pub fn prove(
    spec: &Specification,
    plant: &Plant,
    (sigma, law): (&Rational, Option<&Terms>),
    (claimed, witness): (&[claimed::Entry<'_>], &Linear),
    lines: &mut Vec<String>,
) -> Outcome<()> {
    let mut system = System::new(plant)?;
    let forms = witness.forms.iter().map(|form| Falls::new(&mut system, spec, (sigma, law), form));
    let falls: Vec<Falls> = forms.collect::<Outcome<_>>()?;
    if system.model.formulas.is_too_large() {
        return too_large(RULE, "/plant");
    }
    let period = spec.period.nominal.enclose(PRECISION);
    let no_curves = Curves { orbit: Vec::new(), lyapunov: Vec::new() };
    let machine = Machine::new(&system.model.formulas, &no_curves, &(Interval::pi(PRECISION) * 2 / &period));
    let (root, mut values) = (machine.period(&period), machine.values());
    falls.iter().try_for_each(|falls| falls.prove(plant, &machine, &root, &mut values, lines))?;

    let question = Question { spec, plant, sigma, law, claimed, witness };
    let mut count = question.attempt(&system, PRECISION);
    if count.as_ref().is_err_and(|finding| finding.verdict == Verdict::Undecided) {
        count = question.attempt(&system, TAYLOR_PRECISIONS[0]);
    }
    let count = count?;
    for entry in claimed {
        let [e, e_rms, u] = &entry.steady;
        let [e, e_rms, u] = [e, e_rms, u].map(Rational::to_f64);
        lines.push(format!(
            "{RULE}: {}: |e| <= {e}, root mean square {e_rms}, |u| <= {u} along the periodic solution",
            entry.about()
        ));
    }
    lines.push(format!("{RULE}: all of them by {count} boxes of the parameters and the input gain"));
    Ok(())
}

impl Question<'_> {
    /// All bounds at one precision; by how many boxes.
    fn attempt(&self, system: &System, precision: u32) -> Outcome<usize> {
        let Question { spec, plant, sigma, law, claimed, witness } = self;
        let Some(period) = &spec.period.nominal.exact else { return not_seen() };
        let number = |value: &Rational| Interval::rational(value, precision);
        let om = Interval::pi(precision) * 2 / spec.period.nominal.enclose(precision);
        let regulator = Regulator {
            model: &spec.regulator,
            sigma: number(sigma),
            mu: law.map_or_else(|| spec.regulator.mu.enclose(precision), |law| number(&law.gain)),
            om: om.clone(),
            at_samples: law.map(|law| Sampling {
                h: spec.period.nominal.enclose(precision) / i64::from(law.samples),
                samples: law.samples,
                delayed: law.delayed,
            }),
        };
        let count = plant.known.parameters.len();
        let parameters: Vec<&[Rational; 2]> = plant.family.iter().take(count).map(|span| &span.ends).collect();
        let whole = Whole { parameters, gain: Gain::new(spec.input_gain.as_ref(), precision) };
        let mut evaluator = Evaluator::new(system, period, &om);
        let sides: Vec<Interval> =
            whole.parameters.iter().map(|[lo, hi]| Interval::between(lo, hi, precision)).collect();
        let Some(harmonics) = evaluator.harmonics(&sides) else { return not_seen() };
        let most = harmonics.last().copied().unwrap_or(0);
        if let Some(law) = law.filter(|law| 2 * most >= law.samples as usize) {
            let what =
                format!("2 m < {}, m = {most} the last harmonic of the forcing that is seen in its form", law.samples);
            demand(None, RULE, "/plant", what)?;
        }
        for entry in claimed.iter().filter(|entry| entry.or_more) {
            let what =
                format!("no harmonic of the forcing is beyond n_o, the last one that is seen in its form is {most}");
            demand(
                entry.oscillators.contains(most).then_some(true),
                RULE,
                &format!("{}/or_more", entry.pointer),
                what,
            )?;
        }
        let nominal = spec
            .input_gain
            .as_ref()
            .map_or_else(|| Interval::int(1, precision), |gain| gain.nominal.enclose(precision));
        let entries: Vec<Entry> = claimed
            .iter()
            .zip(&witness.sizes)
            .map(|about| Entry::new(about, &regulator, &harmonics, (&nominal, system.states())))
            .collect();
        let times = Times::new(most, precision);
        Computation { system, evaluator, regulator: &regulator, harmonics: &harmonics, times }.prove(&entries, &whole)
    }
}
