//! The report on the reproduction.

use super::printed::PrintedTable;
use super::run::{ComputedRow, NoiseRange, Reproduction, units};
use serde_json::{Value, json};
use sigmastar_document::plot::Figure;
use sigmastar_document::{Block, Made, Readable, Table};
use sigmastar_lab::simulate::Noise;

/// The report on the reproduction. Deviations are in units of the last printed place, after rounding to it.
pub struct ReproductionReport<'r> {
    /// What was computed.
    pub reproduction: &'r Reproduction,
    /// Its figures, each with the name of its file.
    pub figures: &'r [(&'static str, Figure)],
    /// The report on the paper's constants for its example, where it is wanted.
    pub constants: Option<Made>,
}

impl Readable for ReproductionReport<'_> {
    fn blocks(&self) -> Vec<Block> {
        let ReproductionReport { reproduction, figures, constants } = self;
        let mut blocks = vec![
            Block::Title("The paper's numerical section, computed again".to_owned()),
            Block::says(
                "Floating point, no proof. Steady states by Newton shooting. Deviations are in units of the last printed \
                 place, after rounding to it. The second printed column is headed $`(1/T) int e^2`$; what is printed there is \
                 its square root, the rms (erratum E19), and the rms is what is computed here.",
            ),
        ];
        let parts = reproduction.settings.parts;
        for (wanted, table, n_0, title) in [
            (parts.table_1, PrintedTable::HighGain, None, "Table 1, high-gain feedback, without noise"),
            (parts.table_2, PrintedTable::InternalModel, Some(1.0), "Table 2, internal model, n_0 = 1, without noise"),
            (parts.table_2, PrintedTable::InternalModel, Some(2.0), "Table 2, internal model, n_0 = 2, without noise"),
        ] {
            if !wanted {
                continue;
            }
            blocks.push(Block::heading(title));
            match n_0 {
                Some(1.0) => {
                    blocks.push(Block::says("The printed values were computed with $`n_0 = 1`$ (erratum E20)."))
                }
                Some(_) => blocks.push(Block::says("What the text states; the printed values do not belong to it.")),
                None => {}
            }
            blocks.push(quiet_table(reproduction, table, n_0));
        }
        if parts.noise {
            blocks.extend(noise_blocks(reproduction));
        }
        if !figures.is_empty() {
            blocks.push(Block::heading("Figures"));
            blocks.push(Block::Figures(names(figures)));
            blocks.extend(figures.iter().map(|(_, figure)| Block::Drawing(figure.clone())));
        }
        blocks.extend(constants.iter().flat_map(Made::as_section));
        blocks
    }

    /// As JSON: `{"format": "sigmastar/reproduction", "version": 1, ...}`: every cell as printed, computed, and apart.
    fn json(&self) -> Value {
        let ReproductionReport { reproduction, figures, constants } = self;
        let rows: Vec<Value> = reproduction.rows.iter().map(row_json).collect();
        json!({
            "format": "sigmastar/reproduction", "version": 1,
            "seeds": reproduction.settings.seeds, "noise_steps": reproduction.settings.noise_steps,
            "rows": rows, "largest_noise": reproduction.largest_noise, "figures": names(figures),
            "constants": constants.as_ref().map(Readable::json),
        })
    }
}

fn names(figures: &[(&'static str, Figure)]) -> Vec<String> {
    figures.iter().map(|(name, _)| (*name).to_owned()).collect()
}

/// A computed value with a digit more than is printed.
fn here(value: f64) -> String {
    if value < 1e-3 { format!("{value:.4e}") } else { format!("{value:.5}") }
}

fn deviation(printed: &str, value: f64) -> String {
    match units(printed, value) {
        0.0 => "0".to_owned(),
        units => format!("{units:+}"),
    }
}

fn parameters(row: &ComputedRow) -> [String; 3] {
    let printed = row.row;
    [printed.ratio.to_owned(), printed.n_o.map_or("-".to_owned(), |n_o| n_o.to_string()), printed.sigma.to_string()]
}

fn quiet_table(reproduction: &Reproduction, printed: PrintedTable, n_0: Option<f64>) -> Block {
    let mut table = Table::new(&[
        "$`w T/(2 pi)`$",
        "$`n_o`$",
        "$`sigma`$",
        "sup printed",
        "here",
        "deviation",
        "rms printed",
        "here",
        "deviation",
        "multiplier",
    ]);
    for row in reproduction.rows.iter().filter(|row| row.row.table == printed && row.n_0 == n_0) {
        let mut cells: Vec<String> = parameters(row).into();
        match (row.cells(), &row.quiet) {
            (Some(values), _) => {
                for cell in values {
                    cells.extend([cell.printed.to_owned(), here(cell.here), deviation(cell.printed, cell.here)]);
                }
            }
            (None, Some(Err(error))) => cells.push(error.to_string()),
            (None, _) => {}
        }
        cells.resize(9, String::new());
        cells.push(row.multiplier.map_or_else(String::new, |multiplier| format!("{multiplier:.3}")));
        table.push(cells);
    }
    Block::Table(table)
}

/// How a law of the noise is called in text and in JSON.
fn words(law: Noise) -> [&'static str; 2] {
    match law {
        Noise::Printed => ["as printed", "printed"],
        Noise::Everywhere => ["$`-sigma (e + v)`$", "everywhere"],
    }
}

fn range([low, high]: [f64; 2]) -> String {
    format!("{low:.4} to {high:.4}")
}

fn noise_blocks(reproduction: &Reproduction) -> Vec<Block> {
    let settings = reproduction.settings;
    let largest: Vec<String> = reproduction.largest_noise.iter().map(|value| format!("{value:.1}")).collect();
    let mut table = Table::new(&[
        "$`w T/(2 pi)`$",
        "$`n_o`$",
        "$`sigma`$",
        "$`n_0`$",
        "<law",
        "sup printed",
        "here",
        "rms printed",
        "here",
    ]);
    for row in &reproduction.rows {
        for NoiseRange { law, sup, rms } in &row.noisy {
            let [law, _] = words(*law);
            let mut cells: Vec<String> = parameters(row).into();
            cells.push(row.n_0.map_or("-".to_owned(), |n_0| n_0.to_string()));
            cells.extend([law.to_owned(), row.row.noisy[0].to_owned(), range(*sup)]);
            cells.extend([row.row.noisy[1].to_owned(), range(*rms)]);
            table.push(cells);
        }
    }
    vec![
        Block::heading("Both tables, with measurement noise"),
        Block::says(format!(
            "Ranges over single periods among the last 30 of 150, over seeds 1 to {}, with {} steps per period. Two \
             laws: as the paper prints it, and with $`u = -sigma (e + v) + mu M'N(z - M(e + v))`$ (erratum E22). Nothing \
             is tuned to meet the printed values.",
            settings.seeds, settings.noise_steps
        )),
        Block::says(format!(
            "The paper states $`|v| <= 40`$. At its sampling time of 1e-5 the largest $`|v|`$ over 150 s is {} for these \
             seeds.",
            largest.join(", ")
        )),
        Block::Table(table),
    ]
}

fn row_json(row: &ComputedRow) -> Value {
    let printed = row.row;
    let cells = row.cells().map(|[sup, rms]| {
        let cell = |cell: super::run::Cell| {
            json!({
                "printed": cell.printed, "here": cell.here, "units_of_last_place": units(cell.printed, cell.here),
            })
        };
        json!({ "sup": cell(sup), "rms": cell(rms) })
    });
    let error = row.quiet.as_ref().and_then(|quiet| quiet.as_ref().err()).map(ToString::to_string);
    let amplitudes = row.quiet.as_ref().and_then(|quiet| quiet.as_ref().ok()).map(|figures| &figures.amplitudes);
    let noisy: Vec<Value> = row
        .noisy
        .iter()
        .map(|range| {
            let [_, law] = words(range.law);
            json!({
                "law": law,
                "sup": { "printed": printed.noisy[0], "range": range.sup },
                "rms": { "printed": printed.noisy[1], "range": range.rms },
            })
        })
        .collect();
    json!({
        "table": match printed.table { PrintedTable::HighGain => 1, PrintedTable::InternalModel => 2 },
        "sigma": printed.sigma, "n_o": printed.n_o, "base_frequency_ratio": printed.ratio, "n_0": row.n_0,
        "without_noise": cells, "error": error, "amplitudes": amplitudes, "multiplier": row.multiplier,
        "with_noise": noisy,
    })
}
