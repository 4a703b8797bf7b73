//! What is said about the trials.

use super::claim::TriedClaim;
use super::counterexample::counterexample_plant;
use super::finding::{Closest, Falsification, Finding, Trial};
use super::oscillators::harmonics_flag;
use serde_json::{Value, json};
use sigmastar_document::{Block, Readable, Table, clean, plain};
use sigmastar_exact::number::{Direction, round_f64, told_apart, write_exact};

/// The report on the trials of a certificate, and of those at other base frequencies.
pub struct FalsificationReport<'r> {
    /// The claims that were tried, the certificate's own first.
    pub tried: &'r [(TriedClaim, Falsification)],
}

impl Readable for FalsificationReport<'_> {
    fn blocks(&self) -> Vec<Block> {
        self.tried.iter().flat_map(|(claim, outcome)| blocks(claim, outcome)).collect()
    }

    /// As JSON: `{"format": "sigmastar/falsification", "version": 1, ...}`, with the reports on other base frequencies in
    /// a field of their own.
    fn json(&self) -> Value {
        let mut reports = self.tried.iter().map(|(claim, outcome)| json(claim, outcome));
        let mut first = reports.next().unwrap_or_default();
        let others: Vec<Value> = reports.collect();
        if !others.is_empty() {
            first["other_base_frequencies"] = others.into();
        }
        first
    }
}

fn blocks(claim: &TriedClaim, outcome: &Falsification) -> Vec<Block> {
    let mut blocks = vec![Block::Title(format!("{}: falsification", clean(&claim.spec.name)))];
    let (mut held, mut unfinished) = (0, Vec::new());
    for finding in &outcome.findings {
        match finding {
            Finding::Holds { .. } => held += 1,
            Finding::Unfinished(why) => unfinished.push(why.as_str()),
            Finding::Violated(..) => {}
        }
    }
    let violated = outcome.findings.len() - held - unfinished.len();
    let gains = match (&claim.sampled, &claim.own) {
        (Some(sampled), own) => {
            let of = if own.is_some() { "of the plant itself with" } else { "with" };
            format!(
                "{of} the law at samples, exactly $`h = {}`$ ({} samples a period) and $`K = {:?}`$, at different phases of the \
                 sampling grid,",
                sampled.step.text,
                sampled.samples,
                sampled.law.gain.to_f64()
            )
        }
        (None, Some(_)) if claim.spec.actuator.is_some() => "of the plant itself at the gain of the claim,".to_owned(),
        (None, None) if claim.spec.actuator.is_some() => "at the gain of the claim,".to_owned(),
        (None, Some(_)) => "of the plant itself at $`sigma*`$ and above,".to_owned(),
        (None, None) => "at $`1.000001 sigma*`$,".to_owned(),
    };
    let of_one_gain = claim.sampled.is_some() || claim.spec.actuator.is_some();
    let name = if of_one_gain { "sigma" } else { "sigma*" };
    blocks.push(Block::says(format!(
        "{} trials {gains} $`{name} = {}`$, base frequency $`{}`$, seed {}: {held} keep every bound, {violated} break one, \
         {} could not be finished. The trials are in floating point: a counterexample can be simulated again, and finding none proves \
         nothing.",
        outcome.findings.len(),
        round_f64(claim.sigma, 9, Direction::Nearest).map_or_else(|| claim.sigma.to_string(), |sigma| write_exact(&sigma)),
        claim.spec.internal_model.base_frequency.text,
        outcome.settings.seed,
        unfinished.len()
    )));
    if let Some((trial, violation)) = outcome.counterexample() {
        blocks.push(Block::heading("Counterexample"));
        let [found, bound] = told_apart([violation.found, violation.bound]);
        blocks.push(Block::says(format!(
            "Trial {}, {}{}: {} is about {found}, and the claim allows about {bound}.",
            trial.number,
            oscillators_in_words(trial),
            member_words(trial),
            violation.quantity
        )));
    }
    if let Some(worst) = outcome.worst() {
        blocks.push(Block::heading("The largest share of each bound that was reached"));
        let number = worst.trial.number;
        let mut table = Table::new(&["<quantity", "found/bound", "in trial", &format!("trial {number}")]);
        let shown = shown(claim, outcome);
        let bars = shown.iter().map(|closest| closest.share).collect();
        for Closest { quantity, share, trial, .. } in shown {
            let of_worst = worst.shares.iter().find(|(name, _)| *name == quantity);
            let of_worst = of_worst.map_or_else(String::new, |(_, share)| format!("{share:.3}"));
            table.push([quantity.to_owned(), format!("{share:.3}"), trial.number.to_string(), of_worst]);
        }
        blocks.push(Block::Table(table.with_bars(bars)));
    }
    unfinished.sort_unstable();
    unfinished.dedup();
    if !unfinished.is_empty() {
        blocks.push(Block::heading("Not finished"));
        blocks.push(Block::List(unfinished.into_iter().map(str::to_owned).collect()));
    }
    if let Some(worst) = outcome.worst() {
        let sets = claim.sets.iter().map(|set| format!(" {}", harmonics_flag(set)));
        blocks.extend(plant_blocks(&worst, (outcome.settings.seed, &sets.collect::<String>())));
    }
    blocks
}

/// What came closest to each bound; of a plant without states, without those of a state.
fn shown<'o>(claim: &TriedClaim, outcome: &'o Falsification) -> Vec<Closest<'o>> {
    let stateless = claim.spec.state_name().is_none();
    outcome.closest().into_iter().filter(|closest| !(stateless && closest.quantity.contains("|x"))).collect()
}

/// The worst plant, and how to simulate it and the others again, with the sets that were chosen.
fn plant_blocks(worst: &Closest<'_>, (seed, sets): (u64, &str)) -> Vec<Block> {
    let Closest { quantity, share, trial, .. } = worst;
    let ((f, q), names) = (trial.plant.texts(), trial.plant.names());
    let (x, rest) = trial.start.split_at(f.len());
    let (e, z) = rest.split_first().map_or((0.0, &[][..]), |(e, z)| (*e, z));
    let mut facts: Vec<(String, String)> =
        f.into_iter().zip(names).map(|(text, name)| (format!("$`d{name}/dt`$"), text)).collect();
    facts.push(("$`de/dt - u`$".to_owned(), q));
    let of_state = if x.is_empty() { String::new() } else { format!("x = {x:?}, ") };
    facts.push(("start".to_owned(), format!("{of_state}$`e = {e:?}`$, z = {z:?}")));
    vec![
        Block::heading("The worst plant"),
        Block::says(format!(
            "Trial {}, $`sigma = {:?}`$, {}{}{}, came closest to one of the bounds: {quantity} reached {share:.3} of its bound. \
             (The multiplier and the Lyapunov function come close to their bounds with any plant.) `sigmastar falsify` with \
             `--seed {seed}{sets} --trial {} -o FILE` writes it as a plant file, with the call of `simulate` in its description. Another \
             number writes another trial.",
            trial.number,
            trial.sigma,
            oscillators_in_words(trial),
            member_words(trial),
            trial.phase.map_or_else(String::new, |phase| format!(", first sample at $`t = {phase:?}`$")),
            trial.number
        )),
        Block::Detail,
        Block::facts(facts),
    ]
}

/// The worst plant as JSON, with the plant file.
fn worst_json(claim: &TriedClaim, worst: &Closest<'_>) -> Value {
    let Closest { quantity, share, trial, .. } = worst;
    let Trial { number, sigma, .. } = trial;
    let plant = counterexample_plant(claim, trial, None).map_or(Value::Null, |document| document.root().to_json());
    let (name, which) = oscillators_json(trial);
    let mut worst =
        json!({ "trial": number, "quantity": plain(quantity), "share": share, "sigma": sigma, name: which });
    worst["plant"] = plant;
    with_member(worst, trial)
}

fn json(claim: &TriedClaim, outcome: &Falsification) -> Value {
    let trials: Vec<Value> = outcome
        .findings
        .iter()
        .map(|finding| match finding {
            Finding::Holds { trial, shares } => {
                let shares: Vec<Value> = shares
                    .iter()
                    .map(|(quantity, share)| json!({ "quantity": plain(quantity), "share": share }))
                    .collect();
                let (name, which) = oscillators_json(trial);
                with_member(json!({ "finding": "holds", name: which, "shares": shares }), trial)
            }
            Finding::Violated(trial, violation) => {
                let (name, which) = oscillators_json(trial);
                let finding = json!({
                    "finding": "violated", name: which, "quantity": plain(violation.quantity), "found": violation.found, "bound": violation.bound,
                });
                with_member(finding, trial)
            }
            Finding::Unfinished(why) => json!({ "finding": "unfinished", "reason": why }),
        })
        .collect();
    let closest: Vec<Value> = outcome
        .closest()
        .iter()
        .map(|Closest { quantity, share, trial, .. }| {
            json!({ "quantity": plain(quantity), "share": share, "trial": trial.number })
        })
        .collect();
    let gain = if claim.sampled.is_some() { "sigma" } else { "sigma_star" };
    let mut report = json!({
        "format": "sigmastar/falsification", "version": 1, "name": clean(&claim.spec.name), gain: claim.sigma,
        "base_frequency": claim.spec.internal_model.base_frequency.text,
        "seed": outcome.settings.seed, "trials": trials, "closest": closest,
        "worst": outcome.worst().map(|worst| worst_json(claim, &worst)), "refuted": outcome.counterexample().is_some(),
    });
    if let Some(sampled) = &claim.sampled {
        report["sampled"] = json!({
            "sampling_period": sampled.step.text, "samples": sampled.samples, "K": sampled.law.gain.to_f64(),
        });
    }
    report
}

/// The gain of the actuator, the period and the parameters, of a claim for intervals of them.
fn member_words(trial: &Trial) -> String {
    let gain = trial.input_gain.map(|gain| format!(", input gain {gain:?}"));
    let period = trial.period.as_ref().map(|period| format!(", period {:?}", period.to_f64()));
    let parameters = trial.parameters.iter().map(|(name, value)| format!(", {name} = {value}"));
    gain.into_iter().chain(period).chain(parameters).collect()
}

/// The oscillators of a trial.
fn oscillators_in_words(trial: &Trial) -> String {
    trial.oscillators.n_o().map_or_else(|| trial.oscillators.to_string(), |n_o| format!("$`n_o = {n_o}`$"))
}

/// The same as a field.
fn oscillators_json(trial: &Trial) -> (&'static str, Value) {
    match trial.oscillators.n_o() {
        Some(n_o) => ("n_o", json!(n_o)),
        None => ("harmonics", trial.oscillators.all().collect()),
    }
}

/// A trial of the law at samples with the time of its first sample, and with its input gain and parameters where there are any.
fn with_member(mut finding: Value, trial: &Trial) -> Value {
    if let Some(phase) = trial.phase {
        finding["phase"] = json!(phase);
    }
    if let Some(gain) = trial.input_gain {
        finding["input_gain"] = json!(gain);
    }
    if let Some(period) = &trial.period {
        finding["period"] = json!(period.to_f64());
    }
    if !trial.parameters.is_empty() {
        finding["parameters"] = trial.parameters.iter().cloned().collect();
    }
    finding
}
