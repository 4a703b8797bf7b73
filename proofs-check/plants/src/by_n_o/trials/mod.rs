//! Trials of one plant at one gain (docs/mathematics.md, sections 14.4 and 14.5).
//!
//! Guarantee of [`prove`]: for each entry Theorem T holds of its trial, the solution is that of the claim, and what the entry says is true. The
//! formulas are proved on the box around the trial (`around`), the sizes of its curves are bounded (`largest`, `answer`), and what follows is in
//! `proofs_core::rules::by_n_o::tube`.

mod answer;
mod around;
mod largest;

use super::linear::oscillators::Regulator;
use crate::read::Plant;
use crate::time::Wave;
use crate::{ARGUMENT_PRECISION, PRECISION, at_rising_precision};
use answer::Answer;
use around::Around;
use largest::largest;
use proofs_core::data::Data;
use proofs_core::interval::Interval;
use proofs_core::rules::by_n_o::claimed::{Entry, RULE};
use proofs_core::rules::by_n_o::trials::{Trial, demand_form};
use proofs_core::rules::by_n_o::{About, tube};
use proofs_core::spec::Specification;
use proofs_core::verdict::Outcome;
use rug::Rational;

/// The sizes of the curves are known to this share of themselves, in bits.
const SHARE: u32 = 30;

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
    let regulator =
        Regulator { model: &spec.regulator, sigma: d.number(about.sigma), mu: d.mu.clone(), om: d.period.slowest() };
    let circle = |p: u32| {
        let period = spec.period.nominal.enclose(p);
        [Interval::pi(p) * 2 / &period, period]
    };
    let in_short = circle(PRECISION);
    for (entry, trial) in claimed.iter().zip(trials) {
        let answer = Answer::new(&regulator, entry.n_o as usize, trial);
        let curves = curves(&d, plant, trial, &answer, in_short.each_ref());
        let larger = trial.x_first.iter().map(|first| (&first.pointer, &first.radii));
        for (pointer, radii) in [(&trial.pointer, &trial.radii)].into_iter().chain(larger) {
            let [d_x, d_e] = radii.each_ref().map(|radius| d.number(radius));
            let [x, e] = [&curves.x + d_x, &curves.e + d_e];
            plant.known.lies_within([&*x.hi(), &*e.hi()], &format!("{pointer}/box"))?;
        }
        tube::prove(&d, about, (entry, trial), &curves)?;

        let (around, name) = (Around::new(plant, about.sigma, trial)?, entry.about());
        let cells = at_rising_precision(|p| around.defects(circle(p).each_ref(), &answer.kappa, &name))?;
        let boxes = around.on_box(in_short.each_ref(), &curves.e, &name)?;
        lines.push(format!(
            "{RULE}: {name}: the periodic solution near the trial, by {boxes} boxes and {cells} cells of t"
        ));
    }
    Ok(())
}

/// The sizes of the curves of a trial.
fn curves(d: &Data<'_>, plant: &Plant, trial: &Trial, answer: &Answer, circle: [&Interval; 2]) -> tube::Curves {
    let opposite = |wave: &Wave| combined(&[Rational::from(-1)], &[wave]);
    let of = |size: Interval| size.round(d.precision);
    let (from_orbit, input) = (from_orbit(plant, trial), opposite(&trial.q));
    let from_orbit: Vec<Vec<largest::Part<'_>>> = from_orbit.iter().map(|wave| vec![(wave, 0)]).collect();
    let mean_square =
        trial.e.harmonics.iter().flatten().fold(Rational::new(), |sum, part| sum + Rational::from(part.square_ref()));
    let x = if plant.states() > 0 {
        of(largest(&from_orbit, circle, SHARE)) + d.number(&plant.orbit.radius)
    } else {
        d.int(0)
    };
    tube::Curves {
        x,
        e: of(largest(&[vec![(&trial.e, 0)]], circle, SHARE)),
        e_rms: d.number(&(mean_square / 2u32)).sqrt(),
        u: of(largest(&[vec![(&trial.e, 1), (&input, 0)]], circle, SHARE)) + &answer.kappa,
        zeta: answer.zeta.clone(),
    }
}

/// The components of `L^-1 (xhat - xb)`.
fn from_orbit(plant: &Plant, trial: &Trial) -> Vec<Wave> {
    // Without intervals there are no sensitivities.
    let orbit = plant.orbit.waves.first().map_or(&[][..], Vec::as_slice);
    let waves: Vec<&Wave> = trial.x.iter().chain(orbit).collect();
    let of = |row: &Vec<Rational>| {
        let factors: Vec<Rational> =
            row.iter().cloned().chain(row.iter().map(|value| Rational::from(-value))).collect();
        combined(&factors, &waves)
    };
    plant.known.coordinates.inverse.iter().map(of).collect()
}

/// A sum of waves with these factors.
fn combined(factors: &[Rational], waves: &[&Wave]) -> Wave {
    let count = waves.iter().map(|wave| wave.harmonics.len()).max().unwrap_or(0);
    let sum = |of: &dyn Fn(&Wave) -> Rational| {
        factors.iter().zip(waves).fold(Rational::new(), |sum, (factor, wave)| sum + of(wave) * factor)
    };
    let harmonic = |k: usize| [0, 1].map(|part| sum(&|wave| wave.harmonic(k)[part].clone()));
    Wave { mean: sum(&|wave| wave.mean.clone()), harmonics: (1..=count).map(harmonic).collect() }
}
