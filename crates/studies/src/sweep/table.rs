//! Results as a table for other programs, and in a few words.

use super::results::Results;
use super::row::Row;
use super::values::number;
use rug::Rational;
use sigmastar_document::is_hidden;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::parse_decimal;
use sigmastar_lang::spec::StartSizes;
use sigmastar_prove::certify::Verdict;
use std::cmp::Ordering;

/// The columns behind the parameters.
const COLUMNS: [&str; 14] = [
    "verdict",
    "sigma_star",
    "sampling_period",
    "X0",
    "X0_bounds",
    "E0",
    "Z0",
    "x",
    "e",
    "zeta",
    "z",
    "no_plant",
    "sha256",
    "message",
];

/// The table (RFC 4180): a row for each case. Numbers are as in the results, exactly; but a fraction becomes a double, of a
/// parameter the nearest one, and of a claim the next one at which the claim holds: the gain and the sizes of the periodic
/// solution are rounded up, the initial set down.
#[must_use]
pub fn csv(results: &Results) -> String {
    let names = results.parameters.iter().map(String::as_str);
    let mut text = record(std::iter::once("index").chain(names).chain(COLUMNS).map(str::to_owned));
    for row in results.rows.values() {
        let none = || std::iter::repeat_n(String::new(), 11).collect::<Vec<_>>();
        let claimed = row.claim.as_ref().map_or_else(none, |claim| {
            let up = |text: &String| claimed_number(text, Enclosure::upper_f64);
            let StartSizes { x0, e0, z0 } = claim.initial_set.map(|text| claimed_number(text, Enclosure::lower_f64));
            let set = [x0, claim.x0_bounds.to_owned(), e0, z0.unwrap_or_else(|| "M e".to_owned())];
            let sizes = set.into_iter().chain(claim.periodic.iter().map(up));
            let gain = [up(&claim.sigma_star), claim.sampling_period.clone().unwrap_or_default()];
            gain.into_iter().chain(sizes).chain([claim.no_plant.to_string()]).collect()
        });
        let message = row.errors.first().map(|error| error.message.clone()).or_else(|| row.reason.clone());
        let start = std::iter::once(row.index.to_string()).chain(row.values.iter().map(|text| decimal(text)));
        let end = [row.sha256.clone(), message.unwrap_or_default()];
        text += &record(start.chain(std::iter::once(row.verdict.to_string())).chain(claimed).chain(end));
    }
    text
}

/// A number that other programs read, where the text is a constant.
fn decimal(text: &str) -> String {
    if parse_decimal(text).is_ok() {
        return text.to_owned();
    }
    number(text).map_or_else(|| text.to_owned(), |number| number.to_string())
}

/// A number that is claimed, for other programs: as it is where it is a decimal, else rounded to a side.
fn claimed_number(text: &str, side: fn(&Enclosure) -> f64) -> String {
    let fraction = exact(text).filter(|_| parse_decimal(text).is_err());
    fraction.map_or_else(|| decimal(text), |value| side(&Enclosure::from_rational(&value, 53)).to_string())
}

fn record(fields: impl Iterator<Item = String>) -> String {
    let quoted = |field: String| match field.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", field.replace('"', "\"\"")),
        false => field,
    };
    fields.map(quoted).collect::<Vec<_>>().join(",") + "\r\n"
}

/// The row with the smallest certified gain, the first of several.
#[must_use]
pub fn best(results: &Results) -> Option<&Row> {
    let gain = |row: &Row| exact(&row.claim.as_ref()?.sigma_star);
    let known = results.rows.values().filter_map(|row| Some((gain(row)?, row)));
    // Of equal ones the first is kept.
    known.min_by(|a, b| a.0.partial_cmp(&b.0).unwrap_or(Ordering::Equal)).map(|(_, row)| row)
}

/// A rational number as results have it: a decimal, or p/q.
fn exact(text: &str) -> Option<Rational> {
    parse_decimal(text).ok().or_else(|| text.parse().ok())
}

/// How many cases came to which verdict, and the best case where it is asked for.
#[must_use]
pub fn summary(results: &Results, with_best: bool) -> String {
    let name: String = results.name.chars().filter(|character| !is_hidden(*character)).collect();
    let count = |verdict| results.rows.values().filter(|row| row.verdict == verdict).count();
    let counts: Vec<String> = [Verdict::Certified, Verdict::Undecided, Verdict::Refuted, Verdict::BadInput]
        .into_iter()
        .map(|verdict| (count(verdict), verdict))
        .filter(|(count, _)| *count > 0)
        .map(|(count, verdict)| format!("{count} {verdict}"))
        .collect();
    let mut text = format!("{name}: {} cases: {}\n", results.cases, counts.join(", "));
    if !with_best {
        return text;
    }
    let Some(row) = best(results) else { return text + "smallest sigma_star: nothing is certified\n" };
    if let Some(claim) = &row.claim {
        text += &format!("smallest sigma_star: {} (case {})\n", claim.sigma_star, row.index);
        for (name, value) in results.parameters.iter().zip(&row.values) {
            let shown = |text: &str| text.chars().filter(|character| !is_hidden(*character)).collect::<String>();
            text += &format!("  {} = {}\n", shown(name), shown(value));
        }
        if let Some(step) = &claim.sampling_period {
            text += &format!("  for the sampling period {step} alone\n");
        }
        if claim.no_plant {
            text += "  no plant with a state has these data: the claim says nothing about any\n";
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_claimed_fraction_is_rounded_to_the_side_where_the_claim_holds() {
        let [down, up] = [Enclosure::lower_f64, Enclosure::upper_f64].map(|side| claimed_number("1/3", side));
        let exact = |text: &str| Rational::from_f64(text.parse().unwrap()).unwrap();
        assert!(exact(&down) < Rational::from((1, 3)) && exact(&up) > Rational::from((1, 3)), "{down} {up}");
        assert_eq!(claimed_number("41.4618", Enclosure::upper_f64), "41.4618");
        assert_eq!([decimal("1/4"), decimal("2*pi")], ["0.25".to_owned(), std::f64::consts::TAU.to_string()]);
    }
}
