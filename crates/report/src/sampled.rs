//! The report on a certification of the regulator at samples.

use super::by_count::counts_json;
use super::conditions::conditions_with_truth;
use super::failures::{FORMAT, VERSION, errors_json};
use super::for_n_o::{rates_json, sampled_section};
use super::json::{actuator, bounds_json, control, input_gain, interval_costs, targets_json};
use super::limits;
use super::obstacles::{
    SLOWER, SMALLER_START, again, describe, first_failing, first_of, first_unproved, not_found, other_gain, rest_of,
    smaller_by, wider,
};
use super::of_plant::plant_json;
use super::remarks::sampled_remarks;
use super::sets::{Boxes, NORMS, Sizes};
use super::verdict::{of_actuator, of_the_data};
use super::words;
use super::{Origin, about, brief, conditions, consequences, gains, of_plant};
use rug::Rational;
use serde_json::{Value, json};
use sigmastar_decide::conditions::SampledProof;
use sigmastar_document::number::{estimate, exact, full, upper};
use sigmastar_document::{Block, Readable, clean, plain, plain_all};
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_exact::number::{Direction, write_exact};
use sigmastar_propose::search::Failing;
use sigmastar_prove::certificate::{no_plant_json, set_fields};
use sigmastar_prove::certify::{Outcome, SampledCertification, Verdict};
use sigmastar_theory::derivation::targets::{SampledConsequences, Target};

/// Everything that the report is made from.
pub(super) struct SampledReport<'r> {
    run: &'r SampledCertification<'r>,
    consequences: Option<SampledConsequences>,
    origin: Origin,
    unanswered: bool,
}

impl<'r> SampledReport<'r> {
    /// The report of a run, with answers to the targets.
    pub(super) fn new(run: &'r SampledCertification<'r>, targets: &[Target], origin: Origin) -> SampledReport<'r> {
        let consequences = run.consequences(targets);
        let unanswered = consequences.is_none() && !targets.is_empty();
        SampledReport { run, consequences, origin, unanswered }
    }

    fn basis(&self) -> Vec<String> {
        let run = self.run;
        let mut items = vec![
            format!(
                "Derivation: sharp, for the regulator at samples (section 12 of the mathematics{}).",
                [
                    if run.sampling.delayed { ", 13.4 for the delay" } else { "" },
                    if run.spec.input_gain.is_some() { ", 13.1 for the input gain" } else { "" },
                    of_actuator(run.spec),
                ]
                .concat()
            ),
            "The gain is a value for this sampling period, not a threshold: nothing follows for a larger gain or a shorter sampling \
             period."
                .to_owned(),
            format!(
                "Assumed of the computer: $`u`$ is held over each sample, {}, no rounding{}, no quantisation{}{}. A period has exactly a \
                 whole number of samples.",
                if run.sampling.delayed {
                    "what is computed from a measurement is put out exactly at the next sample"
                } else {
                    "no delay of the computation"
                },
                match run.counts_noise() && run.spec.disturbances.in_doubles() {
                    true => " (except that the bounds with rounding for given $`n_o`$ include that of the exported C code)",
                    false => "",
                },
                match run.counts_noise() && run.spec.v_bar() > 0 {
                    true => " (except that the bounds with noise for given $`n_o`$ include that of $`e`$)",
                    false => "",
                },
                if run.spec.actuator.is_some() { "" } else { ", no saturation" }
            ),
        ];
        if run.sampling.delayed {
            items.push(
                "With a delay the claim rests on norms: matrix inequalities over a plant's derivatives are for the bounds by the number of oscillators alone."
                    .to_owned(),
            );
        }
        items.extend(of_the_data(run.spec, run.largest_arguments(), None));
        items.push("Used: the base frequency is exactly $`2 pi / period`$ (proved of the numbers given).".to_owned());
        items
    }

    fn limit(&self) -> Option<String> {
        let (proposal, limit) = self.run.found?;
        Some(format!("{}. The margin of the forms is about {}.", limit.describe(), estimate(1.0 - proposal.radius)))
    }
}

/// The verdict in one sentence.
pub(super) fn sentence(run: &SampledCertification<'_>) -> String {
    let step = clean(&run.sampling.text());
    match run.claim() {
        Some(proof) => certified(run, proof),
        None => format!(
            "{}: nothing is certified at the sampling period $`h = {step}`${}; {}. Nothing is claimed about the plant either way.",
            if run.verdict == Verdict::Refuted { "Refuted" } else { "Undecided" },
            run.given_gain.as_ref().map_or_else(String::new, |gain| format!(" with $`sigma = {}`$", write_exact(gain))),
            obstacle(run),
        ),
    }
}

fn obstacle(run: &SampledCertification<'_>) -> String {
    if run.given_gain.as_ref().is_some_and(|gain| run.sampling.fits(gain).is_false()) {
        return "$`h sigma`$ exceeds 1: the law would overshoot from sample to sample".to_owned();
    }
    match &run.outcome {
        Outcome::NotFound(obstacle) => not_found(obstacle, run.spec),
        Outcome::NotProved { failing, .. } => first_failing(failing),
        Outcome::Proved(_) => {
            first_unproved(&run.unproved_bounds, "the arguments of the bounding functions are not bounded")
        }
    }
}

/// What to try where nothing is certified.
fn advice(run: &SampledCertification<'_>, rechecked: bool) -> Vec<String> {
    let mut items: Vec<String> = Vec::new();
    let mut add = |text: &str| items.push(text.to_owned());
    match &run.outcome {
        Outcome::NotFound(obstacle) => obstacle_advice(run, obstacle.failing, &mut add),
        Outcome::NotProved { failing, .. } => {
            let undecided = failing.iter().all(|condition| condition.truth() == Truth::Undecided);
            add(match (undecided, rechecked) {
                (true, _) => "raise --precision-limit",
                (false, true) => "search again (without --witness): another witness may exist",
                (false, false) => "other units of time, $`x`$ and $`e`$, in which the data have ordinary magnitudes",
            });
        }
        Outcome::Proved(_) => {
            add("rewrite the bounding function as sums, products and compositions of nondecreasing functions");
        }
    }
    items
}

fn obstacle_advice(run: &SampledCertification<'_>, failing: Failing, add: &mut dyn FnMut(&str)) {
    match failing {
        Failing::Hold { given: true, .. } => add("a smaller gain, or a shorter sampling period"),
        Failing::Hold { .. } => add("a shorter sampling period"),
        Failing::Delay { .. } => add("a shorter sampling period, or a smaller $`mu`$"),
        Failing::Sampling | Failing::Coupling | Failing::Existence => {
            if run.given_gain.is_some() {
                add("another gain, or none: without --sigma the smallest one is sought");
            }
            add("a shorter sampling period: `sigmastar sampling` lists which gains go with which");
            add("a smaller $`mu`$: $`theta = h mu Nbar^2/2`$ is what the oscillators lose to the sampling");
        }
        Failing::Limit { which, beside, .. } => {
            if run.given_gain.is_some() {
                add(other_gain(which));
            }
            add(&format!("{}, or a shorter sampling period", wider(which, beside.map(|(other, _)| other))));
            if let Some(divisor) = run.divisor_that_keeps() {
                add(&smaller_by(divisor));
            }
        }
        Failing::NotDecidedAgain { refused, .. } => add(again(refused)),
        Failing::Start { .. } => add(SMALLER_START),
        Failing::Rate { .. } => add(&format!("{SLOWER}, or a shorter sampling period")),
        _ => add("the continuous-time claim first, without a sampling period: its report says more"),
    }
}

/// The claim in one sentence.
fn certified(run: &SampledCertification<'_>, proof: &SampledProof) -> String {
    let (spec, witness) = (run.spec, &proof.witness);
    let samples = witness.sampling.samples;
    let sets = spec.internal_model.asks_every_set().then(|| format!("set of harmonics below {samples}/2"));
    format!(
        "Certified: the regulator at samples $`h = {}`$ apart ({samples} in a period){} with $`sigma = {}`$ and $`K = {}`$, $`mu = {}`$ and base \
         frequency $`{}`$, for {} and every phase of the samples{}{}. The closed loop has a T-periodic solution, $`T = {}`$. Every solution that \
         starts at a sampling instant from {}{} converges exponentially to it.{}",
        clean(&witness.sampling.text()),
        if witness.sampling.delayed { ", each control computed in the sample before it acts," } else { "" },
        write_exact(&witness.sigma),
        sigmastar_document::number::compact(&proof.evaluation.law.gain),
        clean(&spec.internal_model.mu.text),
        clean(&spec.internal_model.base_frequency.text),
        words::oscillators(&format!("n_o < {samples}/2"), sets.as_deref()),
        words::of_all(spec),
        limits::of_actuator(spec),
        clean(&spec.period.nominal().text),
        words::set(spec, &witness.set),
        match &witness.delay {
            None => String::new(),
            Some(delay) => format!(
                " and a prediction of $`e`$ that is off by at most $`h Y_0`$, $`Y_0 = {}`$ (at rest $`et_0 = u_0 = 0`$ is)",
                exact(&delay.y_0, Direction::Down)
            ),
        },
        limits::sampled_sentence(run),
    )
}

/// The law and the sets of a certified claim.
fn sets(run: &SampledCertification<'_>) -> Vec<Block> {
    let (Some(proof), Some(periodic)) = (run.claim(), run.periodic_solution()) else { return Vec::new() };
    let (witness, evaluation) = (&proof.witness, &proof.evaluation);
    let set = &witness.set;
    let mut sizes = Sizes::new(run.spec);
    sizes.of_claim(set, &periodic);
    let radii = [&witness.d_x, &witness.d_e].map(|radius| exact(radius, Direction::Up));
    sizes.row("error box around it (radii)", radii);
    if let Some(arguments) = run.largest_arguments().map(|arguments| arguments.each_ref().map(upper)) {
        sizes.row("bounding functions used up to", arguments);
    }
    let law = &evaluation.law;
    let boxes = Boxes {
        state: run.spec.state_name(),
        initial: [&set.x0, &set.e0].map(Rational::to_f64),
        periodic: [&periodic[0], &periodic[1]].map(Enclosure::upper_f64),
        error: [&witness.d_x, &witness.d_e].map(Rational::to_f64),
        used: run.largest_arguments().map(|arguments| arguments.each_ref().map(Enclosure::upper_f64)),
        ellipse: false,
    };
    let mut blocks = vec![
        Block::Heading(format!("The law and the sets at h = {}", clean(&witness.sampling.text()))),
        Block::facts([
            ("samples in a period", witness.sampling.samples.to_string()),
            ("$`h sigma`$", upper(&evaluation.product)),
            ("$`K`$, of $`u = -sigma e + K v`$", sigmastar_document::number::compact(&law.gain)),
            (
                match law.input_gain {
                    None => "$`theta = h mu Nbar^2/2`$",
                    Some(_) => "$`theta`$ at the largest input gain",
                },
                upper(&theta(law)),
            ),
        ]),
        Block::Table(sizes.table),
    ];
    blocks.extend(boxes.figure().map(Block::Drawing));
    blocks.push(Block::says(format!(
        "Solutions from the initial set stay in the error box around the periodic solution, between samples too. {NORMS} Both \
         are taken at samples.{}",
        match run.for_n_o.is_empty() {
            true => " The rate of convergence depends on $`n_o`$ and is not part of the claim.",
            false => "",
        }
    )));
    blocks
}

/// theta.
fn theta(law: &sigmastar_theory::derivation::sampled::SampledLaw<Enclosure>) -> Enclosure {
    &law.enlarged - Enclosure::one(law.enlarged.precision())
}

impl Readable for SampledReport<'_> {
    fn blocks(&self) -> Vec<Block> {
        let run = self.run;
        let name = clean(&run.spec.name);
        let name = if name.is_empty() { "(no name)" } else { &name };
        let mut blocks = vec![Block::Title(format!("{name}: {}", run.verdict)), Block::Verdict(sentence(run))];
        blocks.extend(sampled_remarks(run).into_iter().map(Block::says));
        if self.unanswered {
            blocks.push(Block::says(consequences::UNANSWERED));
        }
        blocks.extend(self.consequences.iter().flat_map(|all| consequences::answers(&all.targets, all.most)));
        if run.claim().is_some() {
            blocks.extend(brief::of_samples(run, self.consequences.as_ref(), self.origin));
            blocks.push(Block::Detail);
            blocks.extend(sampled_section(run));
            let by_count = run.by_count.is_some();
            blocks.extend(self.consequences.iter().flat_map(|all| consequences::sampled_section(all, by_count)));
            blocks.extend(gains::sampled_section(run));
            blocks.push(Block::heading("What the claim rests on"));
            blocks.push(about::facts(run.spec, Some(&run.sampling)));
            blocks.push(Block::List(self.basis()));
        } else {
            let failing: Vec<String> = match &run.outcome {
                Outcome::NotProved { failing, .. } => failing.iter().map(describe).collect(),
                _ => Vec::new(),
            };
            blocks.extend(first_of("Conditions that are not proved:", failing.clone()));
            blocks.push(Block::says("What to try:"));
            blocks.push(Block::List(advice(run, self.origin.is_given())));
            blocks.push(Block::Detail);
            blocks.extend(rest_of("Further conditions that are not proved", failing));
        }
        blocks.extend(sets(run));
        if let Some(limit) = self.limit() {
            blocks.push(Block::heading("Limiting condition"));
            blocks.push(Block::says(format!("{limit} This is floating point and an explanation, not a claim.")));
        }
        blocks.extend(of_plant::section(run.spec, run.claim().map(|proof| &proof.witness.set)));
        blocks.extend(conditions::of("Conditions of the regulator at samples", run.conditions()));
        blocks
    }

    /// As JSON: `{"format": "sigmastar/report", "version": 1, "regulator": "digital", ...}`.
    fn json(&self) -> Value {
        let run = self.run;
        let mut report = json!({
            "format": FORMAT, "version": VERSION, "regulator": "digital",
            "verdict": run.verdict.to_string(), "statement": plain(&sentence(run)), "remarks": plain_all(sampled_remarks(run)),
            "no_plant": run.no_plant.as_ref().map(no_plant_json), "derivation": "sharp",
            "specification": { "name": run.spec.name, "sha256": run.spec.sha256 },
            "sampling_period": run.sampling.text(), "samples": run.sampling.samples,
            "given_gain": run.given_gain.is_some(),
        });
        if run.sampling.delayed {
            report["delay_samples"] = json!(1);
        }
        if let (Some(proof), Some(periodic)) = (run.claim(), run.periodic_solution()) {
            let (witness, law) = (&proof.witness, &proof.evaluation.law);
            report["sigma"] = json!(write_exact(&witness.sigma));
            report["gain"] = json!(write_exact(&witness.law.gain));
            report["h_sigma"] = json!(full(&proof.evaluation.product));
            report["theta"] = json!(full(&theta(law)));
            report["basis"] = json!(plain_all(self.basis()));
            report["initial_set"] = set_fields(&witness.set).collect();
            let [x, e, zeta, z] = periodic.each_ref().map(full);
            report["periodic_solution"] = json!({ "x": x, "e": e, "zeta": zeta, "z": z });
            report["control"] = control(run.control());
            if let Some(rates) = rates_json(&run.for_n_o, &run.why_no_rate()) {
                report["for_n_o"] = rates;
            }
            if let Some(SampledConsequences { by_n_o, targets, most }) = &self.consequences {
                report["consequences"] =
                    json!({ "error_bounds": bounds_json(by_n_o), "targets": targets_json(targets), "most": most });
            }
            report["by_n_o"] = counts_json(run.by_count.as_ref());
            report["gain_to_use"] = gains::to_use_json(&run.gains);
            report["gains"] = gains::rows_json(&run.gains);
            if let Some(kept) = limits::sampled_json(run) {
                report["limits"] = kept;
            }
            if !run.interval_costs.is_empty() {
                report["sigma_without_interval_estimates"] = interval_costs(&run.interval_costs);
            }
            report["error_box"] = json!({ "D_x": write_exact(&witness.d_x), "D_e": write_exact(&witness.d_e) });
        } else {
            report["advice"] = json!(plain_all(advice(run, self.origin.is_given())));
        }
        if let Some(gain) = input_gain(run.spec) {
            report["input_gain"] = gain;
        }
        if let Some(actuator) = actuator(run.spec) {
            report["actuator"] = actuator;
        }
        if let Some([x, e]) = run.largest_arguments().map(|arguments| arguments.each_ref().map(full)) {
            report["largest_arguments"] = json!({ "X": x, "E": e });
        }
        if !run.unproved_bounds.is_empty() {
            let errors: Vec<_> = run.unproved_bounds.iter().map(|problem| problem.errors(run.spec)).collect();
            report["errors"] = errors_json(&errors);
        }
        report["conditions"] = conditions_with_truth(run.conditions());
        report["limit"] = match run.found {
            Some((proposal, limit)) => json!({
                "name": limit.name(), "sentence": limit.describe(), "margin": estimate(1.0 - proposal.radius),
            }),
            None => Value::Null,
        };
        report["plant"] = plant_json(run.spec, run.claim().map(|proof| &proof.witness.set));
        report
    }
}
