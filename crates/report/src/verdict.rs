//! The verdict in one sentence, and what it rests on.

use super::about;
use super::limits;
use super::obstacles;
use super::remarks::remarks;
use super::words;
use sigmastar_document::number::{exact, upper};
use sigmastar_document::{Block, clean};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, write_exact};
use sigmastar_lang::spec::model::{Lyapunov, LyapunovSource};
use sigmastar_lang::spec::{Bound, Specification};
use sigmastar_prove::certificate::members;
use sigmastar_prove::certify::{Certification, Verdict};
use sigmastar_theory::transfer::TransferProof;

/// The verdict in one sentence that a control engineer understands.
pub(super) fn sentence(run: &Certification<'_>) -> String {
    let spec = run.spec;
    match (run.sigma_star(), run.claimed_set()) {
        (Some(sigma), Some(set)) => format!(
            "Certified: with $`sigma = {}`${}, $`mu = {}`$ and base frequency $`{}`${}, for {}{}, the closed loop has a T-periodic solution{}. Every solution \
             that starts at any time from {} converges exponentially to it.{}",
            if spec.actuator.is_some() { write_exact(sigma) } else { exact(sigma, Direction::Up) },
            if spec.actuator.is_some() { "" } else { " (or any larger)" },
            clean(&spec.internal_model.mu.text),
            clean(&spec.internal_model.base_frequency.text),
            limits::of_actuator(spec),
            words::oscillators("n_o >= 0", run.is_for_every_set().then_some("set of harmonics")),
            words::of_all(spec),
            match spec.period.interval() {
                None => format!(", $`T = {}`$", clean(&spec.period.nominal().text)),
                Some(_) => String::new(),
            },
            words::set(spec, set),
            limits::sentence(run),
        ),
        _ => obstacles::sentence(run),
    }
}

/// The sentence; without a certificate, what failed and what to try.
pub(super) fn section(run: &Certification<'_>, rechecked: bool) -> Vec<Block> {
    let mut blocks = vec![Block::Verdict(sentence(run))];
    blocks.extend(remarks(run).into_iter().map(Block::says));
    if run.verdict != Verdict::Certified {
        blocks.extend(obstacles::section(run, rechecked));
    }
    blocks
}

/// What the claim rests on; without one, the conditions that `section` had no room for.
pub(super) fn detail(run: &Certification<'_>) -> Vec<Block> {
    let mut blocks = Vec::new();
    if run.verdict == Verdict::Certified {
        blocks.push(Block::heading("What the claim rests on"));
        blocks.push(about::facts(run.spec, None));
        if run.spec.actuator.is_some() {
            blocks.push(Block::says(
                "The claim is about this gain alone. At another gain the control may exceed the limits of the actuator. At this gain, from the \
                 initial set and without noise, it never does, so the saturation changes nothing.",
            ));
        } else if run.given_gain.is_some() {
            blocks.push(Block::says(
                "The gain was given. The claim is about it and all larger gains; smaller gains may be certified, too. The relative margin of C5b says \
                 how far this gain is from the threshold.",
            ));
        }
        blocks.push(Block::List(basis(run)));
    } else {
        blocks.extend(obstacles::detail(run));
    }
    blocks
}

/// What the claim rests on: derivation, assumptions about the plant, the transfer constants.
pub(super) fn basis(run: &Certification<'_>) -> Vec<String> {
    let by_matrix = run.sharp.attempt().is_some_and(|proof| proof.evaluation.by_matrix.is_some());
    let of_stability = match (by_matrix, run.spec.bounds.proved_values().joint_stability.as_ref()) {
        (_, Some(_)) => ", and (Jm) of 13.7 in the place of C4 and C5",
        (true, None) => ", and (M) of 13.7 in the place of C5",
        (false, None) => "",
    };
    let of_gain = if run.spec.input_gain.is_some() { ", 13.1 for the input gain" } else { "" };
    let of_actuator = of_actuator(run.spec);
    let derivation =
        format!("Derivation: sharp (sections 2, 3, 5 and 10 of the mathematics{of_gain}{of_actuator}{of_stability}).");
    let mut items = vec![derivation];
    let further = run.exact_arguments().filter(|_| run.largest_arguments().is_some());
    items.extend(of_the_data(run.spec, run.largest_arguments(), further));
    items.extend(of_the_transfer_bound(run));
    items
}

/// What is assumed and what is proved of the data: those of a plant's formulas, or the bounding functions up to the arguments
/// that are used.
pub(super) fn of_the_data(
    spec: &Specification,
    used: Option<[Enclosure; 2]>,
    further: Option<[Enclosure; 2]>,
) -> Vec<String> {
    let mut items = Vec::new();
    if spec.plant().is_some() {
        let of_states = if spec.state_name().is_some() { "the orbit $`x_0`$, the rate, " } else { "" };
        items.push(format!(
            "Proved from the formulas: that they have the period and are smooth where they are used, {of_states}the harmonics \
             and every bound (section 11)."
        ));
        items.push(format!("Assumed: {}.", assumed(spec, used, further)));
        return items;
    }
    match &spec.lyapunov {
        LyapunovSource::Proved { triple, existence, .. } => {
            let shown = |triple: &Lyapunov| {
                format!(
                    "$`p_low = {}`$, $`p_up = {}`$, $`alpha = {}`$",
                    triple.p_low.text, triple.p_up.text, triple.alpha.text
                )
            };
            let other = existence
                .as_ref()
                .map(|other| format!("; for the existence of the periodic solution {}", shown(&other.0)));
            items.push(format!(
                "Proved for every $`t`$ and every matrix of the Jacobian: the Lyapunov triple {}{}.",
                shown(triple),
                other.unwrap_or_default()
            ));
        }
        LyapunovSource::Given(_) | LyapunovSource::Wanted(_) | LyapunovSource::Plant(_) => {}
    }
    items.push(format!("Assumed of the plant: {}.", assumed(spec, used, further)));
    items.push(
        "Proved of the bounding functions: they are finite and nondecreasing there (a rate is nonincreasing). Of a bound of a norm the \
         positive part is used. Proved of the weights: W1 to W3."
        .to_owned(),
    );
    items
}

/// The sections behind what is claimed of an actuator.
pub(super) fn of_actuator(spec: &Specification) -> &'static str {
    match &spec.actuator {
        None => "",
        Some(actuator) if actuator.by_count => ", 13.5 and 14.5 for the actuator, by the number of oscillators",
        Some(_) => ", 13.5 for the actuator",
    }
}

/// What nobody proves: that the formulas are the plant, or that the data of a specification bound it up to the arguments that
/// are used; and what is assumed of the actuator.
pub(super) fn assumed(spec: &Specification, used: Option<[Enclosure; 2]>, further: Option<[Enclosure; 2]>) -> String {
    let of_the_actuator = words::input_gain(
        spec,
        [", and that the gain of the actuator is", ", and that the gain of the actuator is one constant from"],
    );
    let of_the_actuator = of_the_actuator.unwrap_or_default();
    let of_the_period = words::period(spec)
        .map_or_else(String::new, |interval| format!(", and that the period is one constant from {interval}"));
    let of_its_limit = spec.actuator.as_ref().map_or_else(String::new, |actuator| {
        format!(", and that the actuator takes {} as it is", words::taken(actuator))
    });
    assumed_of_the_plant(spec, used, further) + &of_the_actuator + &of_its_limit + &of_the_period
}

fn assumed_of_the_plant(spec: &Specification, used: Option<[Enclosure; 2]>, further: Option<[Enclosure; 2]>) -> String {
    if let Some(plant) = spec.plant() {
        let domain = plant.domain.as_ref().map_or_else(String::new, |domain| {
            let (x, e) = (clean(&domain.x.text), clean(&domain.e.text));
            spec.state_name().map_or_else(
                || format!(", for $`|e| <= {e}`$"),
                |_| format!(", for $`|x - x_0| <= {x}`$, $`|e| <= {e}`$"),
            )
        });
        return match members(&plant.parameters) {
            None => format!("that these formulas are the plant{domain}"),
            Some(members) => format!("that these formulas, with {members}, are the plant{domain}"),
        };
    }
    let [used, further] = [used, further].map(|some| some.map(|arguments| arguments.each_ref().map(upper)));
    let of_the_zero_dynamics = match &spec.lyapunov {
        LyapunovSource::Proved { .. } => "that its Jacobian $`df/dx(t,0,0)`$ is within the one given",
        _ if spec.bounds.own(Bound::Rate).is_some() => "the Lyapunov triple $`(p_low, p_up, alpha)`$ and the rate",
        _ => "the Lyapunov triple $`(p_low, p_up, alpha)`$",
    };
    let of_the_disturbance =
        if spec.q_0.is_some() { ", that $`q_0`$ bounds the harmonics of $`q(t,0,0)`$ and the rest" } else { "" };
    format!(
        "{of_the_zero_dynamics}{of_the_disturbance}, and that the bounding functions bound the plant{}{}",
        used.map_or_else(String::new, |[x, e]| format!(
            " for $`|x| <= {x}`$, $`|e| <= {e}`$ and at all smaller arguments"
        )),
        further.map_or_else(String::new, |[x, e]| format!(
            "; exact regulation needs them for $`|x| <= {x}`$, $`|e| <= {e}`$"
        )),
    )
}

/// Whether the claim uses that the base frequency fits the period.
fn of_the_transfer_bound(run: &Certification<'_>) -> Option<String> {
    run.claim().map(|claim| {
        match claim.transfer {
            TransferProof::Matched { .. } => {
                "Used: the base frequency is exactly $`2 pi / period`$, which is proved of the given numbers. `--transfer boxes` does not \
                 use it."
            }
            TransferProof::ClosedForm | TransferProof::Boxes(_) => "Not used: that the base frequency fits the period.",
        }
        .to_owned()
    })
}
