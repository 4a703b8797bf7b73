//! The report on certified pairs of a gain and a sampling period, and their figure.

use super::{Asked, Pair, RoundForm, Row, SamplingStudy};
use serde_json::{Value, json};
use sigmastar_document::number::{estimate, full, upper};
use sigmastar_document::plot::{Curve, Figure, Scale, Style};
use sigmastar_document::{Block, Readable, Table, clean};
use sigmastar_exact::number::write_exact;

/// The format of the JSON.
const FORMAT: &str = "sigmastar/sampling";

/// Its version.
const VERSION: u64 = 1;

/// The rows of a study, of what has this name and digest.
pub struct SamplingReport<'s> {
    /// The rows.
    pub study: &'s SamplingStudy,
    /// The name of the specification or plant.
    pub name: &'s str,
    /// SHA-256 of its canonical form.
    pub sha256: &'s str,
}

impl Readable for SamplingReport<'_> {
    fn blocks(&self) -> Vec<Block> {
        let SamplingStudy { continuous, by_step, by_gain, round } = self.study;
        let mut blocks = vec![
            Block::Title(format!("{}: gains and sampling periods", clean(self.name))),
            Block::says(
                "Each pair is certified by itself, as `certify --sampling-period H --sigma V` does (with an `actuator` by the conditions alone). A gain is a value for its \
                 sampling period, not a threshold: nothing follows for a larger gain, a shorter period, or between two rows.",
            ),
        ];
        if let Some(sigma) = continuous {
            blocks.push(Block::says(format!(
                "In continuous time norms ask for about $`sigma = {}`$ (an estimate); a matrix inequality may ask for less. The longest sampling periods \
                 are sought with norms first: there may be longer ones.",
                estimate(*sigma)
            )));
        }
        if self.study.has_pair() {
            blocks.push(Block::Drawing(sampling_figure(self.study)));
        }
        for (heading, rows) in [
            ("The smallest gain found for a sampling period", by_step),
            ("The longest sampling period found for a gain", by_gain),
            ("The longest round sampling period found for a gain", round),
        ] {
            if !rows.is_empty() {
                blocks.push(Block::heading(heading));
                blocks.extend(what_is_round(rows).map(Block::says));
                blocks.push(Block::Table(table(rows)));
                blocks.extend(legend(rows));
            }
        }
        blocks
    }

    /// As JSON: `{"format": "sigmastar/sampling", "version": 1, ...}`.
    fn json(&self) -> Value {
        let SamplingStudy { continuous, by_step, by_gain, round } = self.study;
        let rows = |rows: &[Row]| -> Vec<Value> { rows.iter().map(row_json).collect() };
        json!({
            "format": FORMAT, "version": VERSION,
            "specification": { "name": self.name, "sha256": self.sha256 },
            "continuous_sigma": continuous.map(estimate),
            "by_sampling_period": rows(by_step), "by_sigma": rows(by_gain), "round": rows(round),
        })
    }
}

fn asked(row: &Row) -> [String; 2] {
    match &row.asked {
        Asked::Step(sampling) => [sampling.text(), "-".to_owned()],
        Asked::Gain(gain) | Asked::Round(gain, _) => ["-".to_owned(), write_exact(gain)],
    }
}

fn table(rows: &[Row]) -> Table {
    let mut table = Table::new(&["$`h`$", "samples", "$`sigma`$", "$`h sigma`$", "$`theta`$", "margin", "<limited by"]);
    for row in rows {
        let none = || "-".to_owned();
        match &row.found {
            Ok(pair) => {
                let (limit, margin) = match pair.limit {
                    Some((limit, margin)) => (limit.name().to_owned(), estimate(margin)),
                    None => (none(), none()),
                };
                table.push([
                    clean(&pair.sampling.text()),
                    pair.sampling.samples.to_string(),
                    write_exact(&pair.sigma),
                    upper(&pair.product),
                    upper(&pair.theta),
                    margin,
                    limit,
                ]);
            }
            Err(_) => {
                let [step, gain] = asked(row);
                table.push([clean(&step), none(), gain, none(), none(), none(), "nothing certified".to_owned()]);
            }
        }
    }
    table
}

/// What the words of the last column mean, and what stands in the way where nothing is certified.
fn legend(rows: &[Row]) -> Option<Block> {
    let mut facts: Vec<(&'static str, String)> = Vec::new();
    for row in rows {
        let fact = match &row.found {
            Ok(Pair { limit: Some((limit, _)), .. }) => (limit.name(), limit.describe().to_owned()),
            Ok(_) => continue,
            Err(obstacle) => ("nothing certified", obstacle.describe().to_owned()),
        };
        if !facts.contains(&fact) {
            facts.push(fact);
        }
    }
    (!facts.is_empty()).then(|| Block::facts(facts))
}

/// What is round of the sampling periods, where they are.
fn what_is_round(rows: &[Row]) -> Option<&'static str> {
    let forms: Vec<RoundForm> = rows
        .iter()
        .filter_map(|row| match row.asked {
            Asked::Round(_, form) => Some(form),
            _ => None,
        })
        .collect();
    if forms.contains(&RoundForm::Samples) {
        return Some(
            "Above, the period has any whole number of samples. Here that number is 1, 2 or 5 times a power of ten; no sampling period of \
             that form fits.",
        );
    }
    (!forms.is_empty()).then_some(
        "Above, the period has any whole number of samples. Here the sampling period is 1, 2 or 5 times a power of ten besides: the longest \
         such one that is tried and certified.",
    )
}

fn row_json(row: &Row) -> Value {
    let mut value = outcome_json(row);
    if let Asked::Round(_, form) = &row.asked {
        value["round"] = match form {
            RoundForm::Period => "sampling_period",
            RoundForm::Samples => "samples",
        }
        .into();
    }
    value
}

fn outcome_json(row: &Row) -> Value {
    match &row.found {
        Ok(pair) => json!({
            "outcome": "certified", "sampling_period": pair.sampling.text(), "samples": pair.sampling.samples,
            "sigma": write_exact(&pair.sigma), "gain": write_exact(&pair.gain), "h_sigma": full(&pair.product),
            "theta": full(&pair.theta),
            "limit": pair.limit.map(|(limit, margin)| json!({
                "name": limit.name(), "sentence": limit.describe(), "margin": estimate(margin),
            })),
        }),
        Err(obstacle) => {
            let mut value = json!({ "outcome": "not certified", "obstacle": obstacle.describe() });
            match &row.asked {
                Asked::Step(sampling) => {
                    value["sampling_period"] = sampling.text().into();
                    value["samples"] = sampling.samples.into();
                }
                Asked::Gain(gain) | Asked::Round(gain, _) => value["sigma"] = write_exact(gain).into(),
            }
            value
        }
    }
}

/// The pairs, and the line h sigma = 1, which no claim crosses. It is drawn from doubles and proves nothing.
#[must_use]
pub fn sampling_figure(study: &SamplingStudy) -> Figure {
    let points = |rows: &[Row]| -> Vec<(f64, f64)> {
        let pairs = rows.iter().filter_map(|row| row.found.as_ref().ok());
        let mut points: Vec<(f64, f64)> =
            pairs.map(|pair| (pair.sampling.step.to_f64(), pair.sigma.to_f64())).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points
    };
    let [by_step, by_gain] = [points(&study.by_step), points(&study.by_gain)];
    let limit: Vec<(f64, f64)> = by_step.iter().chain(&by_gain).map(|(h, _)| (*h, h.recip())).collect();
    let mut limit = limit;
    limit.sort_by(|a, b| a.0.total_cmp(&b.0));
    let curve = |label: &str, points, style| Curve { label: label.to_owned(), points, style };
    let curves = [
        curve("h sigma = 1", limit, Style::Bound),
        curve("smallest gain for h", by_step, Style::Points),
        curve("longest h for a gain", by_gain, Style::Points),
    ];
    Figure {
        title: "Certified gains and sampling periods".to_owned(),
        x: "sampling period h [time]".to_owned(),
        y: "sigma [1/time]".to_owned(),
        scale: Scale::LogLog,
        floor: 0.0,
        curves: curves.into_iter().filter(|curve| !curve.points.is_empty()).collect(),
    }
}
