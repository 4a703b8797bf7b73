//! What binds sigma*, and which datum would lower it most.

use super::words::of_interval;
use rug::Rational;
use sigmastar_document::number::{estimate, exact};
use sigmastar_document::{Block, Table};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::Direction;
use sigmastar_lang::spec::Specification;
use sigmastar_propose::search::Datum;
use sigmastar_prove::certify::{Certification, Verdict};
use sigmastar_theory::transfer::TransferProof;

/// The least share of sigma* that a better datum has to save to be told: what is less is rounding of the search.
pub(super) const TOLD: f64 = 1e-6;

/// The binding condition and the sensitivities of the sharp derivation.
pub(super) fn section(run: &Certification<'_>) -> Vec<Block> {
    if run.verdict != Verdict::Certified {
        return Vec::new();
    }
    let Some(binding) = run.binding else { return Vec::new() };
    let mut blocks = vec![
        Block::heading("Limiting condition of sigma* (estimates)"),
        Block::says(format!(
            "$`sigma*`$ is limited by {}. {}",
            binding.describe(),
            binding.advice(run.spec.plant().is_some(), run.spec.initial_set.is_aligned())
        )),
    ];
    blocks.extend(run.alternatives.by_norms.map(|sigma| {
        Block::says(format!(
            "With norms instead of the matrix inequality $`sigma*`$ would be about {} (an estimate at few samples; better coordinates may \
             lower it).",
            estimate(sigma)
        ))
    }));
    blocks.extend(run.alternatives.aligned.map(|sigma| Block::says(format!("Aligned start: {}.", aligned(sigma)))));
    blocks.extend(
        run.alternatives
            .nominal_gain
            .map(|sigma| Block::says(format!("What the interval of the input gain costs: {}.", nominal_gain(sigma)))),
    );
    if !run.interval_costs.is_empty() {
        blocks.push(Block::says(
            "What each interval costs: $`sigma*`$ if this value were exactly the nominal one. It comes from a full search and is not proved.",
        ));
        let costs = run.interval_costs.iter().map(|(name, sigma)| [of_interval(run.spec, name), found(*sigma)]);
        blocks.push(Block::Table(Table::of(&["<exactly known", "$`sigma*`$"], costs)));
    }
    blocks.extend(ingredients(run).map(Block::Table));
    if !run.without_optional.is_empty() {
        blocks.push(Block::says("What each optional datum brings: $`sigma*`$ without it."));
        let without =
            run.without_optional.iter().map(|(datum, sigma)| [format!("$`{}`$", datum.field()), found(*sigma)]);
        blocks.push(Block::Table(Table::of(&["<without", "$`sigma*`$"], without)));
    }
    let shown: Vec<_> = run.sensitivities.iter().filter(|(_, gain)| *gain >= TOLD).collect();
    if let Some((datum, gain)) = shown.first() {
        let sentence = one_per_cent(run.spec, *datum);
        blocks.push(Block::says(format!(
            "{}{} lowers $`sigma*`$ by about {} %, more than anything else that is compared: {}. These are estimates in floating point, \
             re-optimised locally.",
            sentence[..1].to_uppercase(),
            &sentence[1..],
            estimate(100.0 * gain),
            compared(run)
        )));
        let rows = shown.iter().map(|(datum, gain)| [name(run.spec, *datum), format!("{} %", estimate(100.0 * gain))]);
        let table = Table::of(&["<1 % better", "lowers $`sigma*`$ by"], rows);
        blocks.push(Block::Table(table.with_bars(shown.iter().map(|(_, gain)| *gain).collect())));
    }
    blocks
}

/// A gain that was sought.
fn found(sigma: Option<f64>) -> String {
    sigma.map_or_else(|| "none found".to_owned(), estimate)
}

/// What a start with z = M e would bring.
pub(super) fn aligned(sigma: f64) -> String {
    format!("$`sigma*`$ would be about {} with the set `\"kind\": \"aligned\"` (an estimate)", estimate(sigma))
}

/// What an input gain that is known would bring.
pub(super) fn nominal_gain(sigma: f64) -> String {
    format!("$`sigma*`$ would be about {} if the gain were exactly the nominal one (an estimate)", estimate(sigma))
}

/// What a datum is called in the file; the X0 of a plant may be given by a ball.
pub(super) fn name(spec: &Specification, datum: Datum) -> String {
    match (datum, spec.plant().is_some_and(|plant| plant.ball.is_some())) {
        (Datum::Size(0), true) => "ball".to_owned(),
        (Datum::Domain, _) => datum.name(),
        _ => format!("$`{}`$", datum.name()),
    }
}

/// "making E0 1 % smaller".
pub(super) fn one_per_cent(spec: &Specification, datum: Datum) -> String {
    let larger = match datum {
        Datum::Alpha | Datum::Domain => true,
        Datum::Bound(bound) => bound.is_rate(),
        Datum::Mu { larger } => larger,
        Datum::PUp | Datum::Harmonics | Datum::Size(_) => false,
    };
    let name = match datum {
        Datum::Mu { .. } => "$`mu`$".to_owned(),
        _ => name(spec, datum),
    };
    format!("making {name} 1 % {}", if larger { "larger" } else { "smaller" })
}

/// What the sensitivities compare, and what they leave out.
fn compared(run: &Certification<'_>) -> String {
    // What another mu needs is not worked out where it takes boxes.
    let by_boxes = run.sharp.proved().is_some_and(|proof| matches!(proof.witness.transfer, TransferProof::Boxes(_)));
    let (mu, rest) = if by_boxes { ("", "$`mu`$ and the weights") } else { (", and $`mu`$", "the weights") };
    match run.spec.plant().is_some() {
        true => format!(
            "the sizes of the initial set that the file states{mu}, with the bounds that are proved for the present set. Not \
             compared: {rest} (`sigmastar tune` tries them), the domain and the formulas"
        ),
        false => format!(
            "the triple, the bounding functions, the harmonics, the sizes of the initial set and the domain that the file \
             states{mu}. Not compared: {rest} (`sigmastar tune` tries them)"
        ),
    }
}

/// The two terms of the threshold of C5 by norms beside sigma*. They are made from doubles and claim nothing.
fn ingredients(run: &Certification<'_>) -> Option<Table> {
    // A matrix inequality has no such terms.
    let proof = run.sharp.proved().filter(|proof| proof.evaluation.by_matrix.is_none())?;
    let decay = &proof.evaluation.decay;
    let [slope, all] = [&decay.by_slope, &decay.sigma_threshold].map(Enclosure::midpoint_f64);
    let term = |name: &str, value: f64| (name.to_owned(), value, estimate(value));
    let gain = |name: &str, sigma: &Rational| (name.to_owned(), sigma.to_f64(), exact(sigma, Direction::Up));
    let mut entries = vec![
        term("C5: $`dq/de`$ and the internal model's start", slope),
        term("C5: the loop through $`x`$", all - slope),
        gain("$`sigma*`$", &proof.witness.sigma),
    ];
    entries.extend(run.exact.as_ref().map(|claim| gain("$`sigma*_oo`$ ($`n_o`$ infinite)", &claim.witness.sigma)));
    let rows = entries.iter().map(|(name, _, text)| [name.clone(), text.clone()]);
    let table = Table::of(&["<$`sigma*`$ and the two terms of C5 whose sum it exceeds", "1/time"], rows);
    Some(table.with_bars(entries.into_iter().map(|(_, value, _)| value).collect()))
}
