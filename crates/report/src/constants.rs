//! The paper's constants, printed and repaired, beside those of the claim; the matrix inequalities; what the printed formulas say.

use super::conditions::conditions_with_truth;
use super::failures::VERSION;
use super::matrix_checks::{checks_json, section as matrix_inequalities};
use super::verdict::sentence;
use rug::Rational;
use serde_json::{Value as Json, json};
use sigmastar_document::number::{compact, estimate, exact};
use sigmastar_document::{Block, Readable, Table, clean};
use sigmastar_exact::number::{Direction, write_exact};
use sigmastar_lang::spec::InputGain;
use sigmastar_prove::certificate::constants_json;
use sigmastar_prove::certify::{Certification, Constants, Outcome, PrintedFigure};
use sigmastar_prove::rate::oscillators::Lemma;
use sigmastar_theory::derivation::table::{At, Entry, Row, Status, Value};

/// The report of `constants`, of a specification by bounds.
pub struct ConstantsReport<'r> {
    /// The run.
    pub run: &'r Certification<'r>,
    /// Lemma 1 of the paper for some numbers of oscillators; none where nothing is proved.
    pub lemma_1: &'r [(u32, Option<Lemma>)],
}

impl Readable for ConstantsReport<'_> {
    fn blocks(&self) -> Vec<Block> {
        let name = clean(&self.run.spec.name);
        let name = if name.is_empty() { "(no name)" } else { &name };
        let mut blocks = vec![Block::Title(format!("{name}: the paper's constants")), Block::says(sentence(self.run))];
        blocks.extend(lemma_1(self.lemma_1));
        blocks.extend(sections(self.run));
        blocks
    }

    /// As JSON: `{"format": "sigmastar/constants", "version": 1, ...}`.
    fn json(&self) -> Json {
        let run = self.run;
        let mut report = json!({
            "format": "sigmastar/constants", "version": VERSION, "verdict": run.verdict.to_string(),
            "specification": { "name": run.spec.name, "sha256": run.spec.sha256 },
        });
        for (name, value) in parts_json(run) {
            report[name] = value;
        }
        report["lemma_1"] = self.lemma_1.iter().map(lemma_json).collect();
        report
    }
}

/// What is proved of P_zeta, with the decay rate of the oscillators alone.
fn lemma_1(lemmas: &[(u32, Option<Lemma>)]) -> Vec<Block> {
    let says = "There is a $`P_zeta`$ with $`P_zeta (Phi - mu M M'N) + (.)' <= -N`$ and $`0 < P_zeta <= p N`$. Every $`kappa > 0`$ is admissible in \
                $`N + kappa P_zeta`$; the rate of the oscillators alone, in $`|z|_N`$, tends to $`1/(2 p)`$ as $`kappa`$ grows. The spectral abscissa \
                is an estimate.";
    let mut table = Table::new(&["$`n_o`$", "$`p`$ (proved)", "rate $`1/(2 p)`$ (1/time)", "spectral abscissa"]);
    for (n_o, lemma) in lemmas {
        let [p, rate, abscissa] = lemma.as_ref().map_or_else(
            || ["-"; 3].map(str::to_owned),
            |Lemma { p, rate, abscissa }| [exact(p, Direction::Up), exact(rate, Direction::Down), estimate(*abscissa)],
        );
        table.push([n_o.to_string(), p, rate, abscissa]);
    }
    vec![Block::heading("Lemma 1 of the paper"), Block::says(says), Block::Table(table)]
}

fn lemma_json((n_o, lemma): &(u32, Option<Lemma>)) -> Json {
    let lemma = lemma.as_ref();
    json!({
        "n_o": n_o, "p": lemma.map(|lemma| write_exact(&lemma.p)), "rate": lemma.map(|lemma| write_exact(&lemma.rate)),
        "spectral_abscissa_estimate": lemma.map(|lemma| estimate(lemma.abscissa)),
    })
}

/// The constants of a run; none of a plant, for they are about bounding functions.
fn of_bounds<'r>(run: &'r Certification<'_>) -> Option<&'r Constants> {
    run.spec.plant().is_none().then(|| run.constants())
}

/// The matrix inequalities, the constants, and what the printed formulas say; of a plant the first alone.
pub(super) fn sections(run: &Certification<'_>) -> Vec<Block> {
    let constants = of_bounds(run);
    let mut blocks = matrix_inequalities(&run.checks, constants.and_then(|known| known.sylvester.as_ref()));
    if let Some(constants) = constants {
        blocks.extend(tables(&constants.rows));
        // They know of no input gain.
        if run.spec.input_gain.as_ref().is_none_or(InputGain::is_nominal) {
            blocks.extend(printed(run, &constants.printed));
        }
    }
    blocks
}

/// The matrix inequalities, the constants and what the printed formulas say as JSON, by the names of the fields.
pub(super) fn parts_json(run: &Certification<'_>) -> [(&'static str, Json); 4] {
    fn of<P>(outcome: &Outcome<P>, sigma: impl Fn(&P) -> &Rational) -> Json {
        match outcome {
            Outcome::Proved(proof) => json!({ "outcome": "proved", "sigma": write_exact(sigma(proof)) }),
            Outcome::NotProved { failing, .. } => {
                json!({ "outcome": "not proved", "failing": conditions_with_truth(failing) })
            }
            Outcome::NotFound(obstacle) => json!({ "outcome": "not found", "obstacle": obstacle.describe() }),
        }
    }
    let constants = of_bounds(run);
    let repaired = constants
        .and_then(|known| known.repaired.as_ref())
        .map_or_else(|| json!({ "outcome": "skipped" }), |repaired| of(repaired, |proof| &proof.witness.sigma));
    [
        ("matrix_inequalities", checks_json(&run.checks, constants.and_then(|known| known.sylvester.as_ref()))),
        ("derivations", json!({ "sharp": of(&run.sharp, |proof| &proof.witness.sigma), "repaired": repaired })),
        ("constants", constants_json(constants.map_or(&[], |known| &known.rows))),
        ("printed", printed_json(constants.map_or(&PrintedFigure::default(), |known| &known.printed))),
    ]
}

/// The tables, one for each place of evaluation, with notes and sources.
fn tables(rows: &[Row]) -> Vec<Block> {
    if rows.is_empty() {
        return Vec::new();
    }
    let legend = "Rounded to the nearest digits shown; [lower, upper] where the enclosure is wider than these. The full enclosures are in the \
                  certificate and in the JSON report. (!) marks a printed value that is not sound, (none) one whose defining condition has no \
                  solution. p/s is printed/sharp and r/s is repaired/sharp, both estimates.";
    let mut blocks = vec![Block::Aside("Constants in the three derivations".to_owned()), Block::says(legend)];
    let mut notes = Vec::new();
    for at in [At::Data, At::Common, At::Own] {
        let mut table = Table::new(&["<", "printed", "repaired", "sharp", "p/s", "r/s"]);
        for row in rows.iter().filter(|row| row.at == at) {
            table.push(cells(row, &mut notes));
        }
        if !table.rows.is_empty() {
            blocks.push(Block::Subheading(heading(at).to_owned()));
            blocks.push(Block::Table(table));
        }
    }
    if !notes.is_empty() {
        blocks.push(Block::Subheading("Without a value".to_owned()));
        blocks.push(listed(notes));
    }
    blocks.push(Block::Subheading("Sources (P: labels of the paper; sections of the derivation)".to_owned()));
    let mut sources = Vec::new();
    for row in rows {
        collect(&mut sources, &source(row), named(row));
    }
    blocks.push(listed(sources));
    blocks
}

fn heading(at: At) -> &'static str {
    match at {
        At::Data => "From the specification alone",
        At::Common => "At X_p, E_p, sigma of the certificate, so that only the formulas differ",
        At::Own => "At the free numbers that each derivation finds best",
    }
}

/// The name of a constant; a label of the paper in it is no formula.
fn named(row: &Row) -> String {
    match row.name.split_once(" P:") {
        Some((name, label)) => format!("$`{name}`$ P:{label}"),
        None => format!("$`{}`$", row.name),
    }
}

fn cells(row: &Row, notes: &mut Vec<(String, Vec<String>)>) -> [String; 6] {
    let mut cell = |derivation: &str, entry: &Option<Entry>| match entry {
        None => "-".to_owned(),
        Some(Entry { value: Value::Number(value) | Value::Span(value), status, .. }) => {
            let mark = if *status == Status::Sound { "" } else { " (!)" };
            format!("{}{mark}", compact(value))
        }
        Some(Entry { value: Value::Infeasible(reason) | Value::Unavailable(reason), .. }) => {
            collect(notes, reason, format!("{} ({derivation})", named(row)));
            "(none)".to_owned()
        }
    };
    // Free numbers of different derivations have no meaningful quotient.
    let comparable = row.at != At::Own || row.name.starts_with("sigma");
    let quotient = |entry| {
        let factor = if comparable { factor(entry, &row.sharp) } else { None };
        factor.map_or_else(|| "-".to_owned(), estimate)
    };
    [
        named(row),
        cell("printed", &row.printed),
        cell("repaired", &row.repaired),
        cell("sharp", &row.sharp),
        quotient(&row.printed),
        quotient(&row.repaired),
    ]
}

/// Adds a name to those that share a text.
fn collect(lists: &mut Vec<(String, Vec<String>)>, text: &str, name: String) {
    match lists.iter_mut().find(|(known, _)| known == text) {
        Some((_, names)) => names.push(name),
        None => lists.push((text.to_owned(), vec![name])),
    }
}

/// "a, b: text" for each text.
fn listed(lists: Vec<(String, Vec<String>)>) -> Block {
    Block::facts(lists.into_iter().map(|(text, names)| (names.join(", "), text)))
}

/// The quotient of two values in floating point, where both are positive numbers.
fn factor(entry: &Option<Entry>, reference: &Option<Entry>) -> Option<f64> {
    let number = |entry: &Option<Entry>| match entry {
        Some(Entry { value: Value::Number(value), .. }) => Some(value.midpoint_f64()).filter(|v| *v > 0.0),
        _ => None,
    };
    Some(number(entry)? / number(reference)?).filter(|factor| factor.is_finite())
}

fn source(row: &Row) -> String {
    let entries = [("printed", &row.printed), ("repaired", &row.repaired), ("sharp", &row.sharp)];
    let mut parts: Vec<(&str, Vec<&str>)> = Vec::new();
    for (derivation, entry) in entries {
        let Some(entry) = entry else { continue };
        match parts.iter_mut().find(|(source, _)| *source == entry.source) {
            Some((_, derivations)) => derivations.push(derivation),
            None => parts.push((entry.source, vec![derivation])),
        }
    }
    let parts: Vec<String> =
        parts.iter().map(|(source, derivations)| format!("{source} ({})", derivations.join(", "))).collect();
    parts.join("; ")
}

/// Why the printed derivation gives nothing, and the figure that its other conditions would give.
fn printed(run: &Certification<'_>, printed: &PrintedFigure) -> Vec<Block> {
    let mut items = Vec::new();
    match &printed.refutation {
        Some(reason) => items.push(format!("{reason}.")),
        None => items.push("P:eq:boundx_bounde_1 was not refuted at this precision.".to_owned()),
    }
    if let Some(sigma) = &printed.sigma {
        let factor = run.sharp.proved().map_or_else(String::new, |proof| {
            let factor = sigma.midpoint_f64() / proof.witness.sigma.to_f64();
            format!(", about {} times the sharp one", estimate(factor))
        });
        items.push(format!(
            "Without that condition, the other printed conditions would give $`sigma* = {}`${factor}. This is no theorem: \
             several of the formulas are unsound.",
            compact(sigma)
        ));
    } else if printed.evaluation.is_some() {
        let reasons: Vec<String> = named_reasons(printed).map(|(name, reason)| format!("{name}: {reason}")).collect();
        let reasons = if reasons.is_empty() { "their figures are not finite".to_owned() } else { reasons.join("; ") };
        items.push(format!(
            "Without that condition, the other printed conditions give no $`sigma*`$ either ({reasons})."
        ));
    } else if !run.options.compare {
        items.push("Its other conditions were not searched.".to_owned());
    } else {
        items.push(
            "Without that condition, no free numbers were found that satisfy the other printed conditions either."
                .to_owned(),
        );
    }
    vec![Block::Aside("What the printed formulas say".to_owned()), Block::List(items)]
}

/// Why the printed formulas give no figure, by the names of their two parts.
fn named_reasons(printed: &PrintedFigure) -> impl Iterator<Item = (&'static str, String)> {
    let parts = printed.evaluation.iter().flat_map(|of| [("sigma_p*", &of.sigma_p), ("sigma_a*", &of.sigma_a)]);
    parts.filter_map(|(name, value)| Some((name, value.as_ref().err()?.to_string())))
}

fn printed_json(printed: &PrintedFigure) -> Json {
    json!({
        "refutation": printed.refutation.as_ref().map(ToString::to_string),
        "sigma_without_it": printed.sigma.as_ref().map(|sigma| sigma.decimals()),
        "reasons": named_reasons(printed).map(|(_, reason)| reason).collect::<Vec<_>>(),
    })
}
