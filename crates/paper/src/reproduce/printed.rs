//! What the paper prints: its two tables.

use sigmastar_exact::number::Portable;
use std::f64::consts::TAU;

/// One of the two tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PrintedTable {
    /// P:table:high-gain.
    HighGain,
    /// P:table:example-norms.
    InternalModel,
}

/// A row of a table: its parameters, and its cells as printed.
#[derive(Clone, Copy, Debug)]
pub struct PrintedRow {
    /// The table.
    pub table: PrintedTable,
    /// sigma.
    pub sigma: f64,
    /// The number of oscillators; `None` in the table of the high-gain feedback.
    pub n_o: Option<u32>,
    /// The base frequency over 2 pi/T, as a name.
    pub ratio: &'static str,
    /// sup|e_p| and the second column, without noise.
    pub quiet: [&'static str; 2],
    /// sup|e_p| and the second column, with noise.
    pub noisy: [&'static str; 2],
}

impl PrintedRow {
    /// The base frequency; T = 1.
    #[must_use]
    pub fn base_frequency(&self) -> f64 {
        match self.ratio {
            "0.99" => 0.99 * TAU,
            "0.95" => 0.95 * TAU,
            "golden" => TAU * (1.0 + 5.0_f64.sqrt()) / 2.0,
            _ => TAU,
        }
    }
}

/// The place value of the last printed digit: 1e-4 of `0.3074`, 1e-10 of `3.04e-8`.
#[must_use]
pub fn last_place(printed: &str) -> f64 {
    let (mantissa, exponent) = printed.split_once('e').unwrap_or((printed, "0"));
    let decimals = mantissa.split_once('.').map_or(0, |(_, fraction)| fraction.len() as i32);
    10_f64.portable_powi(exponent.parse::<i32>().unwrap_or(0) - decimals)
}

const fn high_gain(sigma: f64, quiet: [&'static str; 2], noisy: [&'static str; 2]) -> PrintedRow {
    PrintedRow { table: PrintedTable::HighGain, sigma, n_o: None, ratio: "-", quiet, noisy }
}

const fn model(ratio: &'static str, n_o: u32, quiet: [&'static str; 2], noisy: [&'static str; 2]) -> PrintedRow {
    PrintedRow { table: PrintedTable::InternalModel, sigma: 2.0, n_o: Some(n_o), ratio, quiet, noisy }
}

/// Every row of both tables, in the order of the paper.
pub const ROWS: [PrintedRow; 19] = [
    high_gain(2.0, ["1.2555", "0.9657"], ["1.3023", "0.9743"]),
    high_gain(5.0, ["0.6577", "0.4083"], ["0.7995", "0.4244"]),
    high_gain(10.0, ["0.400", "0.2166"], ["0.6619", "0.2489"]),
    high_gain(20.0, ["0.2248", "0.1126"], ["0.6201", "0.1765"]),
    high_gain(40.0, ["0.1181", "0.0572"], ["0.6736", "0.1735"]),
    model("-", 0, ["0.3074", "0.1777"], ["0.3915", "0.2024"]),
    model("1", 1, ["0.0917", "0.0549"], ["0.2453", "0.0872"]),
    model("1", 2, ["0.0178", "0.0099"], ["0.1822", "0.0545"]),
    model("1", 3, ["0.0049", "0.0035"], ["0.1679", "0.0514"]),
    model("1", 4, ["3.04e-8", "1.66e-8"], ["0.1730", "0.0523"]),
    model("0.99", 1, ["0.1145", "0.0587"], ["0.2716", "0.0985"]),
    model("0.99", 2, ["0.0835", "0.0371"], ["0.2391", "0.0814"]),
    model("0.99", 3, ["0.0837", "0.0369"], ["0.2292", "0.0790"]),
    model("0.95", 1, ["0.2045", "0.0996"], ["0.3693", "0.1478"]),
    model("0.95", 2, ["0.2038", "0.0980"], ["0.3818", "0.1498"]),
    model("0.95", 3, ["0.2041", "0.0982"], ["0.3876", "0.1499"]),
    model("golden", 1, ["0.2915", "0.1788"], ["0.3764", "0.2020"]),
    model("golden", 2, ["0.2928", "0.1790"], ["0.3761", "0.2017"]),
    model("golden", 3, ["0.2929", "0.1790"], ["0.3792", "0.2015"]),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn printed_cells_are_numbers_with_a_last_place() {
        for row in &ROWS {
            assert!(row.quiet.iter().chain(&row.noisy).all(|cell| cell.parse::<f64>().is_ok_and(|value| value > 0.0)));
        }
        assert!((last_place("0.3074") / 1e-4 - 1.0).abs() < 1e-12);
        assert!((last_place("3.04e-8") / 1e-10 - 1.0).abs() < 1e-12);
    }
}
