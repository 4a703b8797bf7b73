//! What a claim says besides for given oscillators, the first n_o or those of a set of harmonics: how fast the error decays.

use super::words;
use rug::Rational;
use serde_json::{Value, json};
use sigmastar_document::number::{estimate, exact};
use sigmastar_document::{Block, Table, plain};
use sigmastar_exact::number::{Direction, write_exact};
use sigmastar_lang::spec::{Oscillators, Specification};
use sigmastar_propose::rates::Limit;
use sigmastar_prove::certify::{Certification, RowNoise, SampledCertification};
use sigmastar_prove::rate::bound::RateBound;
use sigmastar_prove::rate::found::ForCount;
use sigmastar_prove::rate::noise::{NoNoiseBound, NoiseBound};

/// The section; nothing where no number was asked about.
pub(super) fn section(run: &Certification<'_>) -> Vec<Block> {
    if run.for_n_o.is_empty() {
        return Vec::new();
    }
    let mut blocks = vec![
        Block::heading("For given numbers of oscillators"),
        Block::says(format!(
            "For every start in the set $`|e(t) - e_per(t)| <= factor exp(-rate (t - t_0))`${}. This is a part of the claim, for this $`n_o`$ and this gain \
             alone. It is proved from the bounds on the error box, or from the derivatives there. The factor is for the whole set at once and far above what most \
             starts need. What limits the rate is an estimate. `not proved` says nothing either way.",
            undisturbed(run.spec.disturbances.any())
        )),
        Block::Table(rates(&run.for_n_o)),
    ];
    blocks.extend(not_proved(&run.for_n_o, &run.why_no_rate()));
    if run.matrix_arguments().is_some() && run.for_n_o.iter().any(|found| found.bound.is_none()) {
        blocks.push(Block::says(
            "The claim rests on a matrix inequality. A rate needs more: the loop has to decay with any of the first derivatives on the whole error box, held \
             constant. Where it would grow with some of them no rate is proved, although no solution stays where they are so.",
        ));
    }
    blocks.extend(noise_section(run));
    blocks
}

/// Why some of the rates are not proved.
fn not_proved<P, Q>(found: &[ForCount<P, Q>], why: &str) -> Option<Block> {
    found.iter().any(|found| found.bound.is_none()).then(|| Block::says(format!("Not proved: {why}.")))
}

/// Of which loop rates and factors are, where the document has something that disturbs it.
fn undisturbed(any: bool) -> &'static str {
    if any { ", in the loop without noise, disturbance and rounding" } else { "" }
}

/// The rates, one a line.
fn rates<P, Q>(found: &[ForCount<P, Q>]) -> Table {
    let row = |ForCount { oscillators, bound, .. }: &ForCount<P, Q>| match bound {
        None => [words::row_of(oscillators), "not proved".to_owned(), String::new(), String::new()],
        Some(RateBound { rate, factor, limit, .. }) => {
            [words::row_of(oscillators), exact(rate, Direction::Down), exact(factor, Direction::Up), limited_by(*limit)]
        }
    };
    Table::of(&["$`n_o`$", "rate in 1/time", "factor in the unit of $`e`$", "<limited by"], found.iter().map(row))
}

/// What noise and a disturbance do to the error, where the document has them.
fn noise_section(run: &Certification<'_>) -> Vec<Block> {
    let words = under_signals(run.spec);
    let said = Said {
        title: "Noise and disturbances",
        words,
        without: "them",
        decay: "$`lambda`$ in 1/time",
        falls: "without inputs its quadratic form falls at least as $`exp(-2 lambda t)`$",
        at_samples: false,
    };
    let asked = asked(&run.for_n_o, |proof| &proof.witness.rate);
    let elsewhere = at_other_gains(&asked, (run.sigma_star(), &run.noise_of_rows));
    let mut blocks = disturbed(run.spec, asked, &said);
    blocks.extend(elsewhere);
    blocks
}

/// By what share a deviation has to be smaller at another gain to be told.
const LESS: f64 = 0.99;

/// At which other gain of the table noise and a disturbance are bounded, where they are not at this one, and where the bound is least.
fn at_other_gains(asked: &[Asked<'_>], (own, rows): (Option<&Rational>, &[RowNoise])) -> Vec<Block> {
    let mut blocks = Vec::new();
    for (oscillators, noise) in asked {
        let is_other = |row: &&RowNoise| row.oscillators == **oscillators && Some(&row.sigma) != own;
        let there: Vec<&RowNoise> = rows.iter().filter(is_other).collect();
        let [first, least] = [there.first(), there.iter().min_by(|a, b| a.limit.cmp(&b.limit))];
        let (Some(first), Some(least)) = (first, least) else { continue };
        let at =
            |row: &RowNoise| format!("{} at the gain {}", exact(&row.limit, Direction::Up), write_exact(&row.sigma));
        let mut parts = Vec::new();
        if noise.is_err() {
            parts.push(format!("it is proved at a larger gain of the table, first with the limit {}", at(first)));
        }
        let than = noise.as_ref().map_or(&first.limit, |own| &own.limit);
        if least.limit.to_f64() < LESS * than.to_f64() {
            parts.push(format!("the smallest limit that is proved is {}", at(least)));
        }
        if !parts.is_empty() {
            let of = capitalised(&words::with(oscillators));
            blocks.push(Block::says(format!("{of}: {}.", parts.join("; "))));
        }
    }
    blocks
}

/// What acts on the loop, in words.
fn under_signals(spec: &Specification) -> String {
    format!("under {}: any measurable signals within these bounds", spec.disturbances.in_words())
}

/// The arithmetic of the law at samples.
const IN_DOUBLES: &str = "with the rounding of the exported C code, which computes in double precision";

/// What is shown of bounds under noise with some oscillators, or why there are none.
type Asked<'f> = (&'f Oscillators, Result<Shown, NoNoiseBound>);

/// What is shown of all oscillators for which there may be one; `decay` of what proves it.
fn asked<P, Q>(found: &[ForCount<P, Q>], decay: impl Fn(&Q) -> &Rational) -> Vec<Asked<'_>> {
    let of = |NoiseBound { proof, limit, peak, .. }: &NoiseBound<Q>| Shown {
        limit: limit.clone(),
        peak: peak.clone(),
        decay: decay(proof).clone(),
    };
    let noise = |found: &ForCount<P, Q>| Some(found.noise.as_ref()?.as_ref().map(of).map_err(|why| *why));
    found.iter().filter_map(|found| Some((&found.oscillators, noise(found)?))).collect()
}

/// What is shown of such a bound.
struct Shown {
    limit: Rational,
    peak: Rational,
    decay: Rational,
}

/// The words of a section on noise, a disturbance and rounding.
struct Said {
    title: &'static str,
    /// What disturbs the loop.
    words: String,
    /// What the periodic solution is without.
    without: &'static str,
    /// The title of the decay of the quadratic form that proves the bounds, and how fast that falls.
    decay: &'static str,
    falls: &'static str,
    /// Whether rates hold at the sampling instants.
    at_samples: bool,
}

/// The section on noise and a disturbance.
fn disturbed(spec: &Specification, asked: Vec<Asked<'_>>, said: &Said) -> Vec<Block> {
    if asked.is_empty() {
        return Vec::new();
    }
    let Said { title, words, without, decay, falls, at_samples } = said;
    let mut table = Table::new(&["n_o", "in the limit", "at all times", decay]);
    let mut reasons: Vec<(NoNoiseBound, Vec<&Oscillators>)> = Vec::new();
    for (oscillators, noise) in asked {
        table.push(match noise {
            Ok(Shown { limit, peak, decay }) => [
                words::row_of(oscillators),
                exact(&limit, Direction::Up),
                exact(&peak, Direction::Up),
                exact(&decay, Direction::Nearest),
            ],
            Err(reason) => {
                match reasons.iter_mut().find(|(told, _)| *told == reason) {
                    Some((_, of)) => of.push(oscillators),
                    None => reasons.push((reason, vec![oscillators])),
                }
                [words::row_of(oscillators), "not proved".to_owned(), String::new(), String::new()]
            }
        });
    }
    let mut blocks = vec![
        Block::heading(*title),
        Block::says(format!(
            "The table bounds $`|e(t) - e_per(t)|`$ {words}. The bounds hold for every start in the set, in the limit and at all times from the start on. \
             They are a part of the claim, for this $`n_o`$ and this gain alone. Here $`e_per`$ is the $`e`$ of the periodic solution without {without}. {} \
             An ellipsoid proves the bounds: {falls}.",
            match (words::limit_adds_to_the_way(spec), at_samples) {
                (true, false) => "In the transient $`|e(t) - e_per(t)| <= factor exp(-rate (t - t_0)) + the limit`$.",
                (true, true) =>
                    "At the sampling instants $`|e(t) - e_per(t)| <= factor exp(-rate (t - t_0)) + the limit`$; the bound at all times holds \
                     between samples, too.",
                (false, _) => "The start is $`z = M e`$ with the measured $`e`$.",
            },
        )),
        Block::Table(table),
    ];
    blocks.extend(
        reasons
            .into_iter()
            .map(|(reason, of)| Block::says(format!("{}: {}.", capitalised(&all_of(&of)), reason.message()))),
    );
    blocks
}

/// With a capital letter, where it begins with one that has some.
fn capitalised(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().into_iter().flat_map(char::to_uppercase).chain(letters).collect()
}

/// `$n_o = 0, 4$`, then each set in words.
fn all_of(oscillators: &[&Oscillators]) -> String {
    let numbers: Vec<String> = oscillators.iter().filter_map(|one| one.n_o()).map(|n_o| n_o.to_string()).collect();
    let numbers = (!numbers.is_empty()).then(|| format!("$`n_o = {}`$", numbers.join(", ")));
    let sets = oscillators.iter().filter(|one| one.n_o().is_none()).map(|one| words::with(one));
    numbers.into_iter().chain(sets).collect::<Vec<_>>().join("; ")
}

fn limited_by(limit: Limit) -> String {
    match limit {
        Limit::Plant(rate) => format!("the plant: $`x`$ decays at $`a_2 = {}`$ in the error box", estimate(rate)),
        Limit::Oscillators(rate) => format!("the slowest mode of the loop, {}", estimate(rate)),
        Limit::Middle(rate) => {
            format!(
                "the slowest mode of the loop, {} in the middle of the derivatives, and how they vary",
                estimate(rate)
            )
        }
    }
}

/// What was found as JSON; none where no number was asked about.
pub(super) fn rates_json<P, Q>(found: &[ForCount<P, Q>], why_not: &str) -> Option<Value> {
    (!found.is_empty()).then(|| found.iter().map(|found| one_json(found, why_not)).collect())
}

fn one_json<P, Q>(ForCount { oscillators, bound, noise }: &ForCount<P, Q>, why_not: &str) -> Value {
    let mut value = match oscillators.n_o() {
        Some(n_o) => json!({ "n_o": n_o }),
        None => json!({ "harmonics": oscillators.all().collect::<Vec<u32>>() }),
    };
    let [rate, factor, limited_by] = match bound {
        None => [Value::Null, Value::Null, format!("not proved: {why_not}").into()],
        Some(RateBound { rate, factor, limit, .. }) => {
            [write_exact(rate), write_exact(factor), plain(&limited_by(*limit))].map(Value::String)
        }
    };
    (value["rate"], value["factor"], value["limited_by"]) = (rate, factor, limited_by);
    match noise {
        None => {}
        Some(Ok(NoiseBound { limit, peak, .. })) => {
            value["noise"] = json!({ "limit": write_exact(limit), "peak": write_exact(peak) });
        }
        Some(Err(reason)) => value["noise"] = json!({ "limit": null, "peak": null, "reason": reason.message() }),
    }
    value
}

/// The section of a claim at samples.
pub(super) fn sampled_section(run: &SampledCertification<'_>) -> Vec<Block> {
    if run.for_n_o.is_empty() {
        return Vec::new();
    }
    vec![
        Block::heading("For given numbers of oscillators"),
        Block::says(format!(
            "For every start in the set at a sampling instant $`t_0`$, $`|e(t) - e_per(t)| <= factor exp(-rate (t - t_0))`$ at every sampling instant \
             $`t >= t_0`${}. This is a part of the claim, for this $`n_o`$, this gain and this sampling period alone. It is proved from the bounds on the \
             error box. The factor is for the whole set at once, and far above what most starts need. What limits the rate is an \
             estimate. `not proved` says nothing either way.",
            undisturbed(run.spec.disturbances.any_at_samples())
        )),
        Block::Table(rates(&run.for_n_o)),
    ]
    .into_iter()
    .chain(not_proved(&run.for_n_o, &run.why_no_rate()))
    .chain(sampled_noise(run))
    .collect()
}

fn sampled_noise(run: &SampledCertification<'_>) -> Vec<Block> {
    let disturbances = &run.spec.disturbances;
    let signals = disturbances.any().then(|| under_signals(run.spec));
    let (title, words, without) = match (signals, disturbances.in_doubles()) {
        (Some(words), true) => {
            ("Noise, disturbances and rounding", format!("{words}, and {IN_DOUBLES}"), "them and without rounding")
        }
        (Some(words), false) => ("Noise and disturbances", words, "them"),
        (None, _) => ("Rounding", IN_DOUBLES.to_owned(), "rounding"),
    };
    let said = Said {
        title,
        words,
        without,
        decay: "$`c`$, decay per sample",
        falls: "without inputs its quadratic form falls at least by the factor $`1/(1 + c)`$ in each sample",
        at_samples: true,
    };
    let asked = asked(&run.for_n_o, |proof| &proof.witness.c);
    let own = run.claim().map(|proof| &proof.witness.sigma);
    let elsewhere = at_other_gains(&asked, (own, &run.noise_of_rows));
    let mut blocks = disturbed(run.spec, asked, &said);
    blocks.extend(elsewhere);
    blocks
}
