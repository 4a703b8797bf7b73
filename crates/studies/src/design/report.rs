//! The report on a design table: which pair to take, what is required beside what is proved, and the table.

use super::choice::Choice;
use super::period::LongestPeriod;
use super::requirements::{Compared, Requirement, Requirements};
use super::row::{Cell, Noise, Row, Simulated};
use super::values::ValuesTried;
use rug::Rational;
use serde_json::{Value, json};
use sigmastar_document::number::{estimate, exact, full, upper};
use sigmastar_document::{Block, Readable, Table, clean, clean_sentence, plain};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, write_exact};
use sigmastar_lang::spec::{Oscillators, Sampling};
use sigmastar_report::{ClaimInWords, oscillators_in_words, row_of};

/// The format of the JSON.
const FORMAT: &str = "sigmastar/design";

/// Its version.
const VERSION: u64 = 1;

/// The share of the largest error below which a simulated steady error is shown as 0.
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
    /// The gains at which nothing is certified, and why.
    pub refused: &'d [(Rational, String)],
    /// The longest sampling period of each row, where these are asked for.
    pub longest: Option<&'d [Option<LongestPeriod>]>,
    /// The numbers that were to be chosen, where there were some, and the values that were tried; the document has the best of them.
    pub values: Option<&'d ValuesTried>,
    /// Whether the document states noise, a disturbance or rounding that counts.
    pub disturbed: bool,
    /// What of the document excludes bounds with noise: then all of the table is about the loop without.
    pub no_noise_with: Option<&'d str>,
    /// Whether the document states E0; else it goes with the gain.
    pub states_e0: bool,
    /// Whether the document leaves a size of the initial set open.
    pub leaves_sizes_open: bool,
    /// What the data are to be looked at for, in sentences, of the claim with the gain to take.
    pub notes: &'d [String],
    /// The initial set of that claim, what is assumed of the plant, and what the letters are.
    pub in_words: &'d ClaimInWords,
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
        blocks.extend(self.at_samples().map(Block::says));
        blocks.extend(self.notes.iter().map(|note| Block::says(note.clone())));
        if let Some(values) = self.values {
            blocks.push(Block::heading("Values that were tried"));
            blocks.push(Block::says(values.words()));
            blocks.push(Block::Table(values.table()));
        }
        if !self.choice.compared.is_empty() {
            blocks.push(Block::heading("What is required"));
            blocks.push(Block::Table(self.required()));
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
        let which = |row: usize, cell: usize| self.rows[row].cells[cell].oscillators.clone();
        let compared: Vec<Value> = compared.iter().map(compared_json).collect();
        let others: Vec<Value> = others
            .iter()
            .map(|[row, cell]| with_oscillators(json!({ "sigma": sigma(row) }), Some(&which(*row, *cell))))
            .collect();
        let rows: Vec<Value> = self.rows.iter().enumerate().map(|(index, row)| self.row_json(index, row)).collect();
        let sampling = self.sampling.as_ref();
        json!({
            "format": FORMAT, "version": VERSION, "sentence": plain(&self.sentence()),
            "specification": { "name": self.name, "sha256": self.sha256 },
            "sampling": sampling.map(|(step, samples)| json!({ "sampling_period": step, "samples": samples })),
            "take": with_oscillators(json!({
                "sigma": sigma(row), "met": is_met | cell.is_none(),
                "keeps_rule": cell.is_none().then_some(is_met), "requirements": compared, "others": others,
            }), cell.map(|cell| which(*row, cell)).as_ref()),
            "notes": self.notes, "initial_set": plain(&self.in_words.initial_set),
            "assumed": plain(&self.in_words.assumed), "without_noise": self.disturbed,
            "values": self.values.map(ValuesTried::json), "rows": rows, "not_certified": self.refused.iter().map(|(sigma, _)| write_exact(sigma)).collect::<Vec<_>>(),
        })
    }
}

impl DesignReport<'_> {
    /// The pair to take, in a sentence.
    fn sentence(&self) -> String {
        let Choice { row, cell, is_met, compared, .. } = self.choice;
        let row = &self.rows[*row];
        let (sigma, values) = (write_exact(&row.sigma), self.values.map_or_else(String::new, ValuesTried::taken));
        let Some(which) = cell.map(|cell| oscillators_in_words(&row.cells[cell].oscillators)) else {
            return match is_met {
                true => format!(
                    "Take $`sigma = {sigma}`${values}. It is the smallest gain of the table that meets two conditions with each number of oscillators. First, the bound of the \
                     largest $`|e|`$ is at most twice the larger of $`E0`$ and the bound of the steady error. Second, each proved rate is at least half of the largest one \
                     for that number."
                ),
                false => format!(
                    "No gain of the table meets two conditions with each number of oscillators; $`sigma = {sigma}`${values} comes closest. First, the bound of the largest $`|e|`$ \
                     is to be at most twice the larger of $`E0`$ and the bound of the steady error. Second, each proved rate is to be at least half of the largest one for \
                     that number."
                ),
            };
        };
        if *is_met {
            let scope = match (self.counts_noise(), self.disturbed) {
                (true, _) => " in the loop with noise",
                (false, true) => " in the loop without noise",
                (false, false) => "",
            };
            return format!(
                "Take $`sigma = {sigma}`$ with {which}{values}: every requirement is proved to be met{scope}."
            );
        }
        let missed: Vec<&str> = compared.iter().filter(|one| !one.is_met()).map(|one| self.words(one)).collect();
        format!(
            "No pair of the table is proved to meet every requirement. $`sigma = {sigma}`$ with {which}{values} comes closest; not met: {}.",
            missed.join(", ")
        )
    }

    /// Which sampling period goes with the gain to take, where that is asked.
    fn at_samples(&self) -> Option<String> {
        let row = &self.rows[self.choice.row];
        let sigma = write_exact(&row.sigma);
        self.longest?;
        Some(match self.longest_of(self.choice.row) {
            Some(longest) => format!(
                "At samples it is certified with the sampling period $`h = {}`$, too, by a claim of its own.",
                clean(&longest.text())
            ),
            None => format!("No sampling period was found that is certified with $`sigma = {sigma}`$."),
        })
    }

    /// The other numbers of oscillators with which every requirement is met.
    fn others(&self) -> Option<String> {
        let pair = |[row, cell]: &[usize; 2]| {
            let row = &self.rows[*row];
            format!(
                "{} with $`sigma = {}`$",
                oscillators_in_words(&row.cells[*cell].oscillators),
                write_exact(&row.sigma)
            )
        };
        let all: Vec<String> = self.choice.others.iter().map(pair).collect();
        (!all.is_empty()).then(|| format!("In the table these meet every requirement, too: {}.", all.join(", ")))
    }

    fn basis(&self) -> String {
        let samples = match &self.sampling {
            Some((step, samples)) => format!(
                " The whole table is about the regulator at samples {} apart, {samples} in a period. Rates hold at the sampling instants.",
                clean(step)
            ),
            None => String::new(),
        };
        let without =
            " The whole table is about the loop without noise, disturbance and rounding; nothing is proved about these";
        let noise = match (self.disturbed, self.has_noise()) {
            (false, _) => String::new(),
            (true, true) => {
                " The time to settle and the four columns on noise are about the loop with the noise, disturbance and rounding of the document. Of them only the \
                 noise in $`|e|`$ is in the certificate; this program alone derives the others from it. All other columns are about the loop without noise."
                    .to_owned()
            }
            (true, false) => match self.no_noise_with {
                Some(other) => format!("{without} with {other}."),
                None => format!("{without}."),
            },
        };
        let simulated = match self.has_simulations() {
            true => {
                " Columns `sim.` show simulations of the nominal plant from the starts that seem to be the worst. They prove nothing."
            }
            false => "",
        };
        format!(
            "Steady values hold along the periodic solution, largest values at all times from the initial set. All hold for every plant, period and gain of the \
             actuator of the document. {} Each row is a claim of its own, which the independent checker has decided. Its numbers are those of its \
             certificate, unless a remark says otherwise.{noise}{samples}{simulated}",
            self.in_words.letters
        )
    }

    fn has_simulations(&self) -> bool {
        self.cells().any(|cell| cell.simulated.is_some())
    }

    /// Whether requirements are about the loop with noise.
    fn counts_noise(&self) -> bool {
        self.disturbed && self.no_noise_with.is_none()
    }

    fn has_noise(&self) -> bool {
        self.cells().any(|cell| cell.noise_limit().is_some())
    }

    fn cells(&self) -> impl Iterator<Item = &Cell> {
        self.rows.iter().flat_map(|row| &row.cells)
    }

    fn table(&self) -> Table {
        let simulated = self.has_simulations();
        let noise = self.has_noise();
        let e0 = self.e0_moves();
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
        titles.extend(within.filter(|_| simulated).map(|_| "sim."));
        let of_noise = ["noise in $`|e|`$", "steady with it", "largest with it", "$`|u|`$ with it"];
        titles.extend(of_noise.into_iter().filter(|_| noise));
        titles.extend(self.longest.map(|_| "longest $`h`$"));
        let mut table = Table::new(&titles);
        let not_proved = || "not proved".to_owned();
        for (index, row) in self.rows.iter().enumerate() {
            let longest = self.longest.map(|all| all[index].as_ref().map_or_else(not_proved, LongestPeriod::text));
            for cell in &row.cells {
                let found = cell.simulated;
                let of_runs = |index: usize| found.and_then(|found| Some(found.largest?[index]));
                let mut cells = vec![write_exact(&row.sigma)];
                cells.extend(e0.then(|| exact(&row.e0, Direction::Down)));
                cells.push(row_of(&cell.oscillators));
                for (bound, found) in [
                    (&cell.steady_error, found.map(|found| above_rounding(found.steady_error, cell))),
                    (&cell.peak_error, of_runs(0)),
                    (&cell.control, of_runs(1)),
                ] {
                    cells.push(upper(bound));
                    cells.extend(simulated.then(|| found.map_or_else(|| "-".to_owned(), estimate)));
                }
                let rate = cell.decay.as_ref().map(|decay| exact(&decay.rate, Direction::Down));
                cells.push(rate.unwrap_or_else(not_proved));
                cells.extend(within.map(|limit| {
                    let settling = cell.settling(limit, self.period);
                    settling.as_ref().map_or_else(not_proved, upper)
                }));
                cells.extend(within.filter(|_| simulated).map(|_| {
                    let settling = found.and_then(|found| found.settling);
                    settling.map_or_else(|| "-".to_owned(), estimate)
                }));
                let limit = cell.noise_limit().map(|limit| exact(limit, Direction::Up));
                let with_noise = limit.zip(cell.in_all());
                let of_noise = with_noise.map(|(limit, [steady, peak])| {
                    [limit, upper(steady), upper(peak), cell.control_in_all().map_or_else(not_proved, upper)]
                });
                cells.extend(of_noise.unwrap_or_else(|| [(); 4].map(|()| not_proved())).into_iter().filter(|_| noise));
                cells.extend(longest.clone());
                table.push(cells);
            }
        }
        table
    }

    fn remarks(&self) -> Vec<String> {
        let Choice { row, cell, is_met, .. } = self.choice;
        let row = &self.rows[*row];
        let which = cell.map_or_else(|| "--n-o N".to_owned(), |cell| row.cells[cell].flag());
        let is_taken = *is_met || cell.is_none();
        let mut remarks = Vec::new();
        if is_taken {
            remarks.push(format!(
                "next: the certificate of the gain to take is what `-o FILE` writes; `sigmastar check FILE` decides it again, `sigmastar controller FILE {which}` \
                 writes the regulator"
            ));
        } else {
            let missed = self.choice.compared.iter().filter(|one| !one.is_met());
            remarks.extend(missed.map(|one| self.remedy((row, *cell), one)));
        }
        if !self.choice.compared.is_empty() {
            remarks.push(
                "rule: take the smallest gain of the table at which every requirement is proved to be met, and there the fewest oscillators"
                    .to_owned(),
            );
        }
        if self.longest.is_some() {
            let sigma = write_exact(&row.sigma);
            let step = self.longest_of(self.choice.row).map_or_else(|| "H".to_owned(), LongestPeriod::text);
            remarks.push(format!(
                "longest $`h`$: the longest round sampling period found at which the regulator at samples is certified with this gain, for every \
                 number of oscillators. It is a claim of its own, about this $`h`$ alone, with other bounds: `--sigma {sigma} --sampling-period {step}` shows them"
            ));
        }
        if let Some(limit) = &self.requirements.steady_error {
            remarks.push(format!(
                "settles in: after so many periods $`|e|`$ stays at most {}{}, by the proved rate and factor. One exponential function bounds all \
                 of the transient, so the true number is often far smaller at large gains",
                write_exact(limit),
                if self.sampling.is_some() { " at the sampling instants" } else { "" }
            ));
        }
        let ClaimInWords { initial_set: set, assumed, .. } = self.in_words;
        let of_gain = if is_taken {
            "of the gain to take".to_owned()
        } else {
            format!("at $`sigma = {}`$", write_exact(&row.sigma))
        };
        let open = if self.leaves_sizes_open {
            "; the file leaves sizes of it open, which differ from gain to gain"
        } else {
            ""
        };
        remarks.push(format!("initial set, {of_gain}: {set}{open}"));
        remarks.push(format!("assumed: {assumed}"));
        for (which, said) in [
            "steady error: some or all of these bounds are in no certificate; this program derives them from the claim, and the checker does not decide them",
            "largest error: some or all of these bounds are in no certificate; this program derives them from the proof of the claim, and the checker does not decide them",
        ]
        .into_iter()
        .enumerate()
        {
            if self.cells().any(|cell| !cell.are_in_certificate[which]) {
                remarks.push(said.to_owned());
            }
        }
        if self.is_same_for_all(row) {
            remarks.push(
                "steady error: more oscillators do not lower this bound, because nothing is proved by their number here. At samples such bounds are for \
                 plants by formulas; with a delay the plant has to be linear in x and e"
                    .to_owned(),
            );
        }
        let refused = |(sigma, why): &(Rational, String)| {
            format!("not certified: $`sigma = {}`$: {}", write_exact(sigma), clean_sentence(why))
        };
        remarks.extend(self.refused.iter().map(refused));
        if self.cells().any(|cell| cell.decay.is_none()) {
            remarks.push(
                "rates: `not proved` says nothing about the loop. Fewer oscillators or a larger gain may give a rate"
                    .to_owned(),
            );
        }
        remarks
    }

    /// The longest sampling period of a row.
    fn longest_of(&self, row: usize) -> Option<&LongestPeriod> {
        self.longest.and_then(|all| all[row].as_ref())
    }

    /// Whether E0 goes with the gain.
    fn e0_moves(&self) -> bool {
        self.rows.windows(2).any(|pair| pair[0].e0 != pair[1].e0)
    }

    /// What helps, as a rule, to meet a requirement that is missed by this cell of the row.
    fn remedy(&self, (row, cell): (&Row, Option<usize>), one: &Compared) -> String {
        let steady_control = cell.map(|cell| &row.cells[cell].steady_control);
        let too_much = steady_control.filter(|steady| steady.upper_rational().is_some_and(|steady| steady > one.asked));
        let fewer_or = "fewer oscillators (`--n-o`) or";
        let of_noise = self.counts_noise() && !matches!(one.requirement, Requirement::Settling | Requirement::Noise);
        let help = match one.requirement {
            _ if of_noise && one.proved.is_none() && !self.has_noise() => {
                "nothing is proved of `measurement`, `disturbance` and `arithmetic` of the document at the gains of the table; larger gains (`--sigma`) or \
                 a bounding specification (`sigmastar bound`) may help, and without these lines the requirement is about the loop without noise"
                    .to_owned()
            }
            _ if of_noise && one.proved.is_none() => {
                format!("nothing is proved of the noise at this gain; {fewer_or} a larger gain (`--sigma`) may help")
            }
            Requirement::PeakError if one.asked < row.e0 => {
                let e0 = exact(&row.e0, Direction::Down);
                match self.states_e0 {
                    true => format!(
                        "no gain can do that, because the initial set has $`|e|`$ up to $`E0 = {e0}`$ at the start; state a smaller `E0`"
                    ),
                    false => format!(
                        "at this gain the initial set has $`|e|`$ up to $`E0 = {e0}`$ at the start; state a smaller `E0`, or take a larger gain (`--sigma`)"
                    ),
                }
            }
            Requirement::PeakError => "a larger gain (`--sigma`) or a smaller initial set may help".to_owned(),
            Requirement::SteadyError if self.is_same_for_all(row) => "a larger gain (`--sigma`) may help".to_owned(),
            Requirement::SteadyError => "more oscillators (`--n-o`) or a larger gain (`--sigma`) may help".to_owned(),
            Requirement::Control => too_much.map_or_else(
                || format!("a smaller initial set, {fewer_or} a smaller gain (`--sigma`) may help"),
                |steady| {
                    format!(
                        "another gain hardly helps, because along the periodic solution alone the bound of $`|u|`$ is {}, above the limit; require more \
                         than that, or take a stronger actuator",
                        upper(steady)
                    )
                },
            ),
            Requirement::Settling if one.proved.is_none() && self.misses(Requirement::SteadyError) => {
                "the steady error is not proved to be below what is required, so no time to settle is proved".to_owned()
            }
            Requirement::Settling => format!("{fewer_or} a larger gain (`--sigma`) may help, or another `mu`"),
            Requirement::Noise => format!("less noise, {fewer_or} a smaller gain (`--sigma`) may help"),
        };
        format!("{}: {help}", self.words(one))
    }

    /// Whether nothing is known of the steady error by the number of oscillators, at samples.
    fn is_same_for_all(&self, row: &Row) -> bool {
        let known_by_count = |cell: &Cell| cell.are_in_certificate[1];
        self.sampling.is_some() && row.cells.len() > 1 && !self.cells().any(known_by_count)
    }

    /// A requirement in words.
    fn words(&self, one: &Compared) -> &'static str {
        one.requirement.words(self.sampling.is_some(), self.counts_noise())
    }

    fn misses(&self, requirement: Requirement) -> bool {
        self.choice.compared.iter().any(|one| one.requirement == requirement && !one.is_met())
    }

    /// The requirements beside what is proved.
    fn required(&self) -> Table {
        let mut table = Table::new(&["<required", "at most", "proved", "<"]);
        for one in &self.choice.compared {
            let proved = one.proved.as_ref().map_or_else(|| "none".to_owned(), |proved| exact(proved, Direction::Up));
            let met = if one.is_met() { "met" } else { "missed" };
            table.push([self.words(one).to_owned(), write_exact(&one.asked), proved, met.to_owned()]);
        }
        table
    }

    fn row_json(&self, index: usize, row: &Row) -> Value {
        let cell = |cell: &Cell| {
            let settling = self.requirements.steady_error.as_ref().and_then(|limit| cell.settling(limit, self.period));
            let decay = cell.decay.as_ref();
            let said = json!({
                "steady_error": full(&cell.steady_error), "peak_error": full(&cell.peak_error),
                "max_control": full(&cell.control), "rate": decay.map(|decay| write_exact(&decay.rate)),
                "factor": decay.map(|decay| write_exact(&decay.factor)), "settle": settling.as_ref().map(full),
                "noise": cell.noise_limit().map(write_exact), "with_noise": with_noise_json(cell), "not_in_certificate": outside(cell), "simulated": cell.simulated.map(simulated_json),
            });
            with_oscillators(said, Some(&cell.oscillators))
        };
        let cells: Vec<Value> = row.cells.iter().map(cell).collect();
        let mut said = json!({ "sigma": write_exact(&row.sigma), "E0": write_exact(&row.e0), "cells": cells });
        if let Some(longest) = self.longest {
            let sampling = |at: &Sampling| json!({ "sampling_period": at.text(), "samples": at.samples });
            said["longest_h"] = json!(longest[index].as_ref().map(|LongestPeriod { longest, round }| json!({
                "longest": sampling(longest), "round": round.as_ref().map(sampling),
            })));
        }
        said
    }
}

/// An object with `n_o`, or with `harmonics` where the oscillators are at a set with gaps; the other one is null.
pub(super) fn with_oscillators(mut said: Value, oscillators: Option<&Oscillators>) -> Value {
    let harmonics = oscillators.filter(|set| set.n_o().is_none()).map(|set| set.all().collect::<Vec<u32>>());
    said["n_o"] = json!(oscillators.and_then(Oscillators::n_o));
    said["harmonics"] = json!(harmonics);
    said
}

/// A simulated steady error, or 0 where it is what rounding leaves of numbers like the largest error.
fn above_rounding(found: f64, cell: &Cell) -> f64 {
    if found < ROUNDING * cell.peak_error.upper_f64() { 0.0 } else { found }
}

/// The bounds of a cell that are in no certificate.
fn outside(cell: &Cell) -> Vec<&'static str> {
    let named = ["steady_error", "peak_error"].into_iter().zip(cell.are_in_certificate);
    named.filter(|(_, is_in)| !is_in).map(|(name, _)| name).collect()
}

/// What is proved in the loop with noise; null where nothing is proved of it, and without.
fn with_noise_json(cell: &Cell) -> Option<Value> {
    let Noise::Proved(found) = &cell.noise else { return None };
    Some(json!({
        "steady_error": full(&found.steady_error), "peak_error": full(&found.peak_error), "max_control": found.control.as_ref().map(full),
    }))
}

fn simulated_json(Simulated { steady_error, largest, settling }: Simulated) -> Value {
    json!({
        "steady_error": steady_error, "peak_error": largest.map(|[error, _]| error),
        "max_control": largest.map(|[_, control]| control), "settle": settling,
    })
}

fn compared_json(one: &Compared) -> Value {
    json!({
        "name": Requirement::name(one.requirement), "asked": write_exact(&one.asked), "met": one.is_met(),
        "proved": one.proved.as_ref().map(|proved: &Rational| full(&Enclosure::from_rational(proved, 128))),
    })
}
