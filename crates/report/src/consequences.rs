//! What a certified claim says about the regulated error, and the number of oscillators that a target needs.

use super::words;
use sigmastar_document::number::upper;
use sigmastar_document::plot::{Curve, Figure, Scale, Style};
use sigmastar_document::{Block, Table, clean};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::Specification;
use sigmastar_theory::derivation::consequences::{ErrorBounds, Psi};
use sigmastar_theory::derivation::mistuned::MAX_TUNED;
use sigmastar_theory::derivation::targets::{
    Consequences, MistunedSummary, SampledConsequences, Target, TargetOutcome,
};

/// Above so many oscillators an answer says that they are hardly practical.
const PRACTICAL: u64 = 1000;

/// Where there is no claim.
pub(super) const UNANSWERED: &str = "The targets are not answered: without a certified gain there is no error bound.";

/// The section of the report; `by_count`: whether a table of bounds by the number of oscillators stands above, which are of one gain.
pub(super) fn section(spec: &Specification, consequences: &Consequences, by_count: bool) -> Vec<Block> {
    let mut blocks = vec![Block::heading(title(by_count))];
    blocks.extend(weaker(by_count));
    blocks.push(Block::List(psi_items(spec, consequences)));
    let (at, which) = match spec.actuator {
        None => (
            "at $`sigma*`$ and for every larger $`sigma`$",
            " $`psi_1/sigma`$ shows how $`sup|e|`$ falls with $`sigma`$ for every $`n_o`$. The table shows what each $`n_o`$ brings at $`sigma*`$. Both \
             hold: use the smaller bound.",
        ),
        Some(_) => ("at the gain of the claim", ""),
    };
    blocks.push(Block::says(format!(
        "The table bounds the error along the periodic solution for each number of oscillators, {at}.{which} {UNCHECKED}"
    )));
    blocks.push(Block::Table(table(&consequences.by_n_o)));
    blocks.extend(consequences.mistuned.as_ref().map(|mistuned| Block::says(mistuned_words(spec, mistuned))));
    blocks.push(Block::Drawing(figure(spec, consequences)));
    blocks
}

/// Who computes the table.
const UNCHECKED: &str =
    "This program computes these bounds from the claim with enclosures. No independent program checks them:";

/// The heading; of what is weaker than the table near the top, where one stands there.
fn title(by_count: bool) -> &'static str {
    if by_count { "The regulated error: weaker bounds" } else { "The regulated error" }
}

/// What these bounds rest on, where better ones stand near the top.
fn weaker(by_count: bool) -> Option<Block> {
    by_count.then(|| {
        Block::says(
            "For the gain of the claim use the table near the top of the report. It is worked out for one number of oscillators at a time, and its \
             bounds are smaller as a rule. The bounds here follow from the conditions of the claim alone. Both hold: use the smaller bound.",
        )
    })
}

/// What the oscillators are worth away from a matched base frequency.
fn mistuned_words(spec: &Specification, mistuned: &MistunedSummary) -> String {
    let MistunedSummary { largest, last_that_pays, enough } = mistuned;
    let why = match words::period(spec) {
        Some(interval) => format!("The period is one constant from {interval}"),
        None => "The base frequency is not asserted to be $`2 pi / period`$".to_owned(),
    };
    let distance = format!(
        "{why}: the harmonics are up to {} away from the oscillators, relative to their frequency, so that none vanishes.",
        upper(largest)
    );
    let worth = match (*last_that_pays, *enough) {
        (0, _) => "At this distance no oscillator lowers a bound: the table is the same for every $`n_o`$.".to_owned(),
        (last, enough) => {
            let last_words = match last == MAX_TUNED as u64 {
                true => format!(
                    "Of the first {last} oscillators each lowers the bound of its harmonic, and more are not counted"
                ),
                false => {
                    format!("An oscillator pays up to $`k = {last}`$: from $`n_o = {last}`$ on no bound falls any more")
                }
            };
            format!("{last_words}; from $`n_o = {enough}`$ on that of $`sup|e|`$ falls by 1 % or less.")
        }
    };
    format!("{distance} {worth}")
}

/// The section of the report on the regulator at samples; `by_count` as in [`section`].
pub(super) fn sampled_section(consequences: &SampledConsequences, by_count: bool) -> Vec<Block> {
    let says = "The table bounds the error along the periodic solution, between samples too, for each number of oscillators that the samples can tell \
                apart. The bounds hold at this gain and sampling period alone.";
    let says = Block::says(format!("{says} {UNCHECKED}"));
    let heading = Block::heading(title(by_count));
    [heading].into_iter().chain(weaker(by_count)).chain([says, Block::Table(table(&consequences.by_n_o))]).collect()
}

fn table(by_n_o: &[(u64, ErrorBounds)]) -> Table {
    let row = |(n_o, bounds): &(u64, ErrorBounds)| [n_o.to_string(), upper(&bounds.rms), upper(&bounds.sup)];
    Table::of(&["$`n_o`$", "$`rms(e)`$ at most", "$`sup|e|`$ at most"], by_n_o.iter().map(row))
}

/// The answers to the targets, if there are any, where so many oscillators were looked at.
pub(super) fn answers(targets: &[(Target, TargetOutcome)], most: u64) -> Option<Block> {
    let answers: Vec<String> = targets.iter().map(|(target, outcome)| answer(target, *outcome, most)).collect();
    (!answers.is_empty()).then_some(Block::List(answers))
}

/// The bounds over n_o + 1, which is positive, so that both axes are logarithmic. It is drawn from doubles and claims nothing.
fn figure(spec: &Specification, consequences: &Consequences) -> Figure {
    let curve = |label: &str, of: fn(&ErrorBounds) -> &Enclosure| {
        let points = consequences.by_n_o.iter().map(|(n_o, bounds)| (*n_o as f64 + 1.0, of(bounds).upper_f64()));
        // A bound of 0 has no place on the axis.
        let points = points.filter(|(_, bound)| *bound > 0.0).collect();
        Curve { label: label.to_owned(), points, style: Style::Marked }
    };
    Figure {
        title: match spec.actuator {
            None => "Bounds of the regulated error, at sigma* and above".to_owned(),
            Some(_) => "Bounds of the regulated error, at the gain of the claim".to_owned(),
        },
        x: "n_o + 1 [pure number]".to_owned(),
        y: "e [unit of e]".to_owned(),
        scale: Scale::LogLog,
        floor: 0.0,
        curves: vec![curve("sup|e|", |bounds| &bounds.sup), curve("rms(e)", |bounds| &bounds.rms)],
    }
}

fn psi_items(spec: &Specification, consequences: &Consequences) -> Vec<String> {
    let Psi { psi_1, psi_x, psi_2 } = &consequences.psi;
    let mut items = Vec::new();
    // With an actuator nothing is said of another gain.
    if spec.actuator.is_none() {
        items
            .push(format!("$`sup|e| <= psi_1/sigma`$ with $`psi_1 = {}`$, for every $`n_o`$ and $`mu`$", upper(psi_1)));
        items.extend(spec.state_name().map(|state| {
            format!("$`sup|{state}| <= psi_x/sigma`$ with $`psi_x = {}`$, for every $`n_o`$ and $`mu`$", upper(psi_x))
        }));
    }
    if consequences.mistuned.is_none() {
        items.push(format!(
            "the integral of $`e^2`$ over a period $`<= psi_2/(n_o + 1)^2`$ with $`psi_2 = {}`$",
            upper(psi_2)
        ));
    }
    items
}

/// That so many oscillators are too many for a computer, where they are.
fn many(n_o: u64) -> &'static str {
    match n_o > PRACTICAL {
        true => ". So many oscillators are hardly practical: a larger gain (`--sigma`) or a larger target needs fewer",
        false => "",
    }
}

fn answer(target: &Target, outcome: TargetOutcome, most: u64) -> String {
    let wanted = format!("$`{} <= {}`$", target.kind.name(), clean(&target.value.text));
    match outcome {
        TargetOutcome::Reached(n_o) => {
            format!(
                "Target {wanted}: certified with $`n_o = {n_o}`$ oscillators, the least for these bounds{}",
                many(n_o)
            )
        }
        TargetOutcome::ReachedAtGain(n_o, larger) => {
            let larger = larger.map_or_else(String::new, |larger| format!("; with {larger} at every larger gain, too"));
            format!(
                "Target {wanted}: certified with $`n_o = {n_o}`$ oscillators at this gain alone, the least for these bounds{larger}{}",
                many(n_o)
            )
        }
        TargetOutcome::NotReached => {
            format!("Target {wanted}: not certified with any number of oscillators up to {most}")
        }
    }
}
