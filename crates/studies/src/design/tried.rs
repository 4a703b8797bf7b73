//! What a report says of values that were tried.

use super::report::with_oscillators;
use super::values::{Merit, TriedValues, ValuesTried};
use crate::tune::Parameter;
use serde_json::{Map, Value, json};
use sigmastar_document::number::exact;
use sigmastar_document::{Table, clean};
use sigmastar_exact::number::{Direction, write_exact};
use sigmastar_report::row_of;

impl ValuesTried {
    /// " and mu = 3": the best values.
    pub(super) fn taken(&self) -> String {
        let best = self.parameters.iter().zip(&self.all[self.best].values);
        best.map(|(parameter, value)| format!(" and $`{} = {}`$", parameter.name, clean(value))).collect()
    }

    /// What the file has, and which values are best.
    pub(super) fn words(&self) -> String {
        let written = |parameter: &Parameter| format!("$`{} = {}`$", parameter.name, clean(&parameter.written));
        let written: Vec<String> = self.parameters.iter().map(written).collect();
        format!(
            "The file has {}. All that follows is about the file with the best of these values, and so is its certificate. The best ones miss the fewest \
             requirements; of equal ones they have the largest rate with the number of oscillators to take (without requirements, the largest value of the \
             least rate of the table), then the smallest gain.",
            written.join(", ")
        )
    }

    /// A row for each combination of values.
    pub(super) fn table(&self) -> Table {
        let mut titles: Vec<String> = self.parameters.iter().map(|parameter| clean(&parameter.name)).collect();
        titles.extend(["$`sigma`$", "$`n_o`$", "missed", "rate"].map(str::to_owned));
        let titles: Vec<&str> = titles.iter().map(String::as_str).collect();
        let mut table = Table::new(&titles);
        for one in &self.all {
            let mut cells: Vec<String> = one.values.iter().map(|value| clean(value)).collect();
            cells.extend(match &one.outcome {
                Ok(Merit { sigma, oscillators, missed, rate, .. }) => [
                    write_exact(sigma),
                    oscillators.as_ref().map_or_else(|| "all".to_owned(), row_of),
                    missed.to_string(),
                    rate.as_ref().map_or_else(|| "not proved".to_owned(), |rate| exact(rate, Direction::Down)),
                ],
                Err(_) => ["not certified", "-", "-", "-"].map(str::to_owned),
            });
            table.push(cells);
        }
        table
    }

    /// `taken` and `tried` (docs/formats.md).
    pub(super) fn json(&self) -> Value {
        let named = |values: &[String]| -> Map<String, Value> {
            self.parameters
                .iter()
                .zip(values)
                .map(|(parameter, value)| (parameter.name.clone(), json!(value)))
                .collect()
        };
        let one = |tried: &TriedValues| match &tried.outcome {
            Ok(Merit { sigma, oscillators, missed, rate, .. }) => {
                let said = json!({
                    "values": named(&tried.values), "sigma": write_exact(sigma), "missed": missed, "rate": rate.as_ref().map(write_exact),
                });
                with_oscillators(said, oscillators.as_ref())
            }
            Err(why) => json!({ "values": named(&tried.values), "not_certified": why }),
        };
        let tried: Vec<Value> = self.all.iter().map(one).collect();
        json!({ "taken": named(&self.all[self.best].values), "tried": tried })
    }
}
