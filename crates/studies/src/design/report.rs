//! The report on a design table: which pair to take, what is required beside what is proved, and the table.

use super::choice::Choice;
use super::requirements::{Compared, Requirement, Requirements};
use super::row::{Cell, Row, Simulated};
use rug::Rational;
use serde_json::{Value, json};
use sigmastar_document::number::{estimate, exact, full, upper};
use sigmastar_document::{Block, Readable, Table, clean, plain};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, write_exact};

/// The format of the JSON.
const FORMAT: &str = "sigmastar/design";

/// Its version.
const VERSION: u64 = 1;

/// The share of the largest error below which a simulated size is shown as 0.
const ROUNDING: f64 = 1e-12;

/// A design table of what has this name.
pub struct DesignReport<'d> {
    /// The rows in the order of their gains, at least one.
    pub rows: &'d [Row],
    /// The pair to take, of these rows.
    pub choice: &'d Choice,
    /// What is required.
    pub requirements: &'d Requirements,
    /// The shortest period of the document.
    pub period: &'d Enclosure,
    /// The gains at which nothing is certified.
    pub refused: &'d [Rational],
    /// The sampling period and the samples of a period, of the law at samples.
    pub sampling: Option<(String, u32)>,
    /// The name of the specification or plant.
    pub name: &'d str,
    /// SHA-256 of its canonical form.
    pub sha256: &'d str,
}

impl Readable for DesignReport<'_> {
    fn blocks(&self) -> Vec<Block> {
        let mut blocks =
            vec![Block::Title(format!("{}: design table", clean(self.name))), Block::says(self.sentence())];
        if !self.choice.compared.is_empty() {
            blocks.push(Block::heading("What is required"));
            blocks.push(Block::Table(required(&self.choice.compared)));
            blocks.extend(self.others().map(Block::says));
        }
        blocks.push(Block::heading("Gains and numbers of oscillators"));
        blocks.push(Block::says(self.basis()));
        blocks.push(Block::Table(self.table()));
        blocks.push(Block::List(self.remarks()));
        blocks
    }

    /// As JSON: `{"format": "sigmastar/design", "version": 1, ...}`.
    fn json(&self) -> Value {
        let Choice { row, cell, is_met, compared, others } = self.choice;
        let sigma = |row: &usize| write_exact(&self.rows[*row].sigma);
        let n_o = |row: usize, cell: usize| self.rows[row].cells[cell].n_o;
        let compared: Vec<Value> = compared.iter().map(compared_json).collect();
        let others: Vec<Value> =
            others.iter().map(|[row, cell]| json!({ "sigma": sigma(row), "n_o": n_o(*row, *cell) })).collect();
        let rows: Vec<Value> = self.rows.iter().map(|row| self.row_json(row)).collect();
        let sampling = self.sampling.as_ref();
        json!({
            "format": FORMAT, "version": VERSION, "sentence": plain(&self.sentence()),
            "specification": { "name": self.name, "sha256": self.sha256 },
            "sampling": sampling.map(|(step, samples)| json!({ "sampling_period": step, "samples": samples })),
            "take": {
                "sigma": sigma(row), "n_o": cell.map(|cell| n_o(*row, cell)), "met": is_met, "requirements": compared,
                "others": others,
            },
            "rows": rows, "not_certified": self.refused.iter().map(write_exact).collect::<Vec<_>>(),
        })
    }
}

impl DesignReport<'_> {
    /// The pair to take, in a sentence.
    fn sentence(&self) -> String {
        let Choice { row, cell, is_met, compared, .. } = self.choice;
        let row = &self.rows[*row];
        let sigma = write_exact(&row.sigma);
        let Some(n_o) = cell.map(|cell| row.cells[cell].n_o) else {
            return match is_met {
                true => format!(
                    "Take $`sigma = {sigma}`$: the smallest gain of the table at which, with each number of oscillators, the largest $`|e|`$ is at most \
                     twice the larger of $`E0`$ and the steady error, and the rate is at least half of the largest in the table."
                ),
                false => format!(
                    "No gain of the table has, with each number of oscillators, a largest $`|e|`$ of at most twice the larger of $`E0`$ and the steady error \
                     and at least half of the largest rate. $`sigma = {sigma}`$ comes closest."
                ),
            };
        };
        if *is_met {
            return format!("Take $`sigma = {sigma}`$ with $`n_o = {n_o}`$: every requirement is proved to be met.");
        }
        let missed: Vec<&str> =
            compared.iter().filter(|one| !one.is_met()).map(|one| one.requirement.words()).collect();
        format!(
            "No pair of the table is proved to meet every requirement. $`sigma = {sigma}`$ with $`n_o = {n_o}`$ comes closest; not met: {}.",
            missed.join(", ")
        )
    }

    /// The other numbers of oscillators with which every requirement is met.
    fn others(&self) -> Option<String> {
        let pair = |[row, cell]: &[usize; 2]| {
            let row = &self.rows[*row];
            format!("$`n_o = {}`$ from $`sigma = {}`$", row.cells[*cell].n_o, write_exact(&row.sigma))
        };
        let all: Vec<String> = self.choice.others.iter().map(pair).collect();
        (!all.is_empty()).then(|| format!("In the table these meet every requirement, too: {}.", all.join(", ")))
    }

    fn basis(&self) -> String {
        let samples = match &self.sampling {
            Some((step, samples)) => format!(
                " All of it is about samples that are {} apart, {samples} in a period, and rates are those at the sampling instants.",
                clean(step)
            ),
            None => String::new(),
        };
        let noise = if self.has_noise() { " They are without noise, of which the last column is." } else { "" };
        let simulated = match self.has_simulations() {
            true => {
                " Columns `sim.` are of simulations of the nominal plant, from starts in the initial set that seem to be the worst; they prove nothing."
            }
            false => "",
        };
        format!(
            "Steady is along the periodic solution, largest is at all times from the initial set.{noise} Each row is a claim of its own that the independent \
             checker has decided, for every plant and gain of the actuator of the document.{samples}{simulated}"
        )
    }

    fn has_simulations(&self) -> bool {
        self.cells().any(|cell| cell.simulated.is_some())
    }

    fn has_noise(&self) -> bool {
        self.cells().any(|cell| cell.noise.is_some())
    }

    fn cells(&self) -> impl Iterator<Item = &Cell> {
        self.rows.iter().flat_map(|row| &row.cells)
    }

    fn table(&self) -> Table {
        let simulated = self.has_simulations();
        let noise = self.has_noise();
        let e0 = self.rows.windows(2).any(|pair| pair[0].e0 != pair[1].e0);
        let within = self.requirements.steady_error.as_ref();
        let mut titles = vec!["$`sigma`$"];
        titles.extend(e0.then_some("$`E0`$"));
        titles.push("$`n_o`$");
        for title in ["steady $`|e|`$", "largest $`|e|`$", "largest $`|u|`$"] {
            titles.push(title);
            titles.extend(simulated.then_some("sim."));
        }
        titles.push("rate");
        titles.extend(within.map(|_| "settles in"));
        titles.extend(noise.then_some("noise in $`|e|`$"));
        let mut table = Table::new(&titles);
        let not_proved = || "not proved".to_owned();
        for row in self.rows {
            for cell in &row.cells {
                let found = cell.simulated;
                let of_runs = |index: usize| found.and_then(|found| Some(found.largest?[index]));
                let mut cells = vec![write_exact(&row.sigma)];
                cells.extend(e0.then(|| exact(&row.e0, Direction::Down)));
                cells.push(cell.n_o.to_string());
                for (bound, found) in [
                    (&cell.steady_error, found.map(|found| found.steady_error)),
                    (&cell.peak_error, of_runs(0)),
                    (&cell.control, of_runs(1)),
                ] {
                    cells.push(upper(bound));
                    cells.extend(
                        simulated.then(|| {
                            found.map_or_else(|| "-".to_owned(), |found| estimate(above_rounding(found, cell)))
                        }),
                    );
                }
                let rate = cell.decay.as_ref().map(|decay| exact(&decay.rate, Direction::Down));
                cells.push(rate.unwrap_or_else(not_proved));
                cells.extend(within.map(|limit| {
                    let settling = cell.settling(limit, self.period);
                    settling.as_ref().map_or_else(not_proved, upper)
                }));
                let limit = cell.noise.as_ref().map(|limit| exact(limit, Direction::Up));
                cells.extend(noise.then(|| limit.unwrap_or_else(not_proved)));
                table.push(cells);
            }
        }
        table
    }

    fn remarks(&self) -> Vec<String> {
        let n_o = match self.choice.cell {
            Some(cell) => self.rows[self.choice.row].cells[cell].n_o.to_string(),
            None => "N".to_owned(),
        };
        let mut remarks = vec![
            format!(
                "next: `-o FILE` writes the certificate of the gain to take; `sigmastar check FILE` decides it again, `sigmastar controller FILE --n-o {n_o}` \
                 writes the regulator"
            ),
            "rule: the smallest gain of the table with which every requirement is proved to be met, with the fewest oscillators; without requirements \
             the one that the first sentence says"
                .to_owned(),
        ];
        if let Some(limit) = &self.requirements.steady_error {
            remarks.push(format!(
                "settles in: after so many periods $`|e|`$ is at most {} for good{}, by the proved rate and its factor; the true number is smaller, as a rule",
                write_exact(limit),
                if self.sampling.is_some() { " at the sampling instants" } else { "" }
            ));
        }
        if self.cells().any(|cell| !cell.steady_is_checked) {
            remarks.push(
                "steady error: where the certificate has no bounds by the number of oscillators, that of a number follows from the claim by formulas that no \
                 independent program decides"
                    .to_owned(),
            );
        }
        if !self.refused.is_empty() {
            let all: Vec<String> = self.refused.iter().map(write_exact).collect();
            remarks.push(format!("not certified: $`sigma = {}`$", all.join(", ")));
        }
        if self.cells().any(|cell| cell.decay.is_none()) {
            remarks.push(
                "rates: where none is proved nothing is said about it; fewer oscillators or a larger gain may have one"
                    .to_owned(),
            );
        }
        remarks
    }

    fn row_json(&self, row: &Row) -> Value {
        let cell = |cell: &Cell| {
            let settling = self.requirements.steady_error.as_ref().and_then(|limit| cell.settling(limit, self.period));
            let decay = cell.decay.as_ref();
            json!({
                "n_o": cell.n_o, "steady_error": full(&cell.steady_error), "peak_error": full(&cell.peak_error),
                "max_control": full(&cell.control), "rate": decay.map(|decay| write_exact(&decay.rate)),
                "factor": decay.map(|decay| write_exact(&decay.factor)), "settle": settling.as_ref().map(full),
                "noise": cell.noise.as_ref().map(write_exact), "simulated": cell.simulated.map(simulated_json),
            })
        };
        let cells: Vec<Value> = row.cells.iter().map(cell).collect();
        json!({ "sigma": write_exact(&row.sigma), "E0": write_exact(&row.e0), "cells": cells })
    }
}

/// A simulated size, or 0 where it is what rounding leaves of numbers like the largest error.
fn above_rounding(found: f64, cell: &Cell) -> f64 {
    if found < ROUNDING * cell.peak_error.upper_f64() { 0.0 } else { found }
}

fn simulated_json(Simulated { steady_error, largest }: Simulated) -> Value {
    json!({
        "steady_error": steady_error, "peak_error": largest.map(|[error, _]| error),
        "max_control": largest.map(|[_, control]| control),
    })
}

fn required(compared: &[Compared]) -> Table {
    let mut table = Table::new(&["<required", "at most", "proved", "<"]);
    for one in compared {
        let proved = one.proved.as_ref().map_or_else(|| "nothing".to_owned(), |proved| exact(proved, Direction::Up));
        let met = if one.is_met() { "met" } else { "missed" };
        table.push([one.requirement.words().to_owned(), write_exact(&one.asked), proved, met.to_owned()]);
    }
    table
}

fn compared_json(one: &Compared) -> Value {
    json!({
        "name": Requirement::name(one.requirement), "asked": write_exact(&one.asked), "met": one.is_met(),
        "proved": one.proved.as_ref().map(|proved: &Rational| full(&Enclosure::from_rational(proved, 128))),
    })
}
