//! The constants of the three derivations side by side.

use sigmastar_document::number::{compact, estimate};
use sigmastar_document::{Block, Table};
use sigmastar_prove::certify::Certification;
use sigmastar_theory::derivation::table::{At, Entry, Row, Status, Value};

/// The tables, one for each place of evaluation, with notes and sources.
pub(super) fn section(run: &Certification<'_>) -> Vec<Block> {
    let has_entry = |row: &&Row| [&row.printed, &row.repaired, &row.sharp].iter().any(|entry| entry.is_some());
    let rows: Vec<&Row> = run.constants.iter().filter(has_entry).collect();
    if rows.is_empty() {
        return Vec::new();
    }
    // A plant has those of the sharp derivation alone.
    let alone = rows.iter().all(|row| row.printed.is_none() && row.repaired.is_none());
    let title = if alone { "Constants" } else { "Constants in the three derivations" };
    let rounded = "Rounded to the nearest digits shown; [lower, upper] where the enclosure is wider than these. The full enclosures are in the \
                   certificate and in the JSON report.";
    let marks = "(!) marks a printed value that is not sound, (none) one whose defining condition has no solution. p/s is printed/sharp and r/s \
                 is repaired/sharp, both estimates.";
    let legend = if alone { rounded.to_owned() } else { format!("{rounded} {marks}") };
    let mut blocks = vec![Block::Aside(title.to_owned()), Block::says(legend)];
    let mut notes = Vec::new();
    for at in [At::Data, At::Common, At::Own] {
        let columns = ["<", "printed", "repaired", "sharp", "p/s", "r/s"];
        let mut table = if alone { Table::new(&["<", "value"]) } else { Table::new(&columns) };
        for row in rows.iter().filter(|row| row.at == at) {
            let [name, printed, repaired, sharp, by_printed, by_repaired] = cells(row, &mut notes);
            if alone {
                table.push([name, sharp]);
            } else {
                table.push([name, printed, repaired, sharp, by_printed, by_repaired]);
            }
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
    for row in &rows {
        collect(&mut sources, &source(row), row.name.clone());
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

fn cells(row: &Row, notes: &mut Vec<(String, Vec<String>)>) -> [String; 6] {
    let mut cell = |derivation: &str, entry: &Option<Entry>| match entry {
        None => "-".to_owned(),
        Some(Entry { value: Value::Number(value) | Value::Span(value), status, .. }) => {
            let mark = if *status == Status::Sound { "" } else { " (!)" };
            format!("{}{mark}", compact(value))
        }
        Some(Entry { value: Value::Infeasible(reason) | Value::Unavailable(reason), .. }) => {
            collect(notes, reason, format!("{} ({derivation})", row.name));
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
        row.name.clone(),
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
