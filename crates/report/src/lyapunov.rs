//! The report of `sigmastar lyapunov`: P, the proved triple, the candidates, and the Floquet exponents beside.

use rug::Rational;
use serde_json::{Value, json};
use sigmastar_document::number::estimate;
use sigmastar_document::{Block, Readable, Table, clean};
use sigmastar_exact::number::write_exact;
use sigmastar_lang::spec::model::{Lyapunov, LyapunovSource, PeriodicMatrix};
use sigmastar_prove::certificate::matrix_json;
use sigmastar_prove::certify::Resolution;

/// The report on a Jacobian whose triple was found and proved.
pub struct LyapunovReport {
    resolution: Resolution,
    triple: Lyapunov,
    matrix: PeriodicMatrix,
}

impl LyapunovReport {
    /// The report; `None` where the specification of the resolution carries no proved triple, which `resolve` never returns.
    #[must_use]
    pub fn new(resolution: Resolution) -> Option<LyapunovReport> {
        let LyapunovSource::Proved { triple, matrix, .. } = &resolution.spec.lyapunov else { return None };
        let (triple, matrix) = (triple.clone(), matrix.clone());
        Some(LyapunovReport { resolution, triple, matrix })
    }
}

impl Readable for LyapunovReport {
    fn blocks(&self) -> Vec<Block> {
        let triple = &self.triple;
        let mut blocks = vec![
            Block::Title(format!("{}: the Lyapunov triple of its Jacobian", clean(&self.resolution.spec.name))),
            Block::Verdict(format!(
                "Proved for every $`t`$ and every matrix F of the Jacobian: $`p_low I <= P <= p_up I`$ and $`P' + P F + F'P <= -2 alpha P`$ \
                 with $`p_low = {}`$, $`p_up = {}`$, $`alpha = {}`$.",
                triple.p_low.text, triple.p_up.text, triple.alpha.text
            )),
            Block::heading("P"),
        ];
        let waves = self.matrix.harmonics.iter().zip(1..).flat_map(|([cos, sin], k)| {
            [
                (format!("the factor of $`cos({k} w t)`$, $`w = 2 pi/period`$"), cos),
                (format!("the factor of $`sin({k} w t)`$"), sin),
            ]
        });
        let mean = if self.matrix.harmonics.is_empty() { "constant" } else { "the mean" };
        for (title, rows) in std::iter::once((mean.to_owned(), &self.matrix.mean)).chain(waves) {
            blocks.push(Block::says(format!("P, {title}, by rows:")));
            blocks.push(Block::List(rows.iter().map(|row| row_text(row)).collect()));
        }
        blocks.push(Block::Detail);
        blocks.push(Block::heading("Candidates"));
        blocks.push(Block::says(
            "Floating point: what was tried, by its rate. The one with the smallest $`sigma*`$ that could be proved is the one above.",
        ));
        let tried = self.resolution.candidates.found.iter().zip(&self.resolution.sigmas).map(|(candidate, sigma)| {
            [
                estimate(candidate.alpha),
                estimate(candidate.ratio),
                candidate.matrix.harmonics.len().to_string(),
                sigma.map_or_else(|| "-".to_owned(), estimate),
            ]
        });
        blocks.push(Block::Table(Table::of(&["$`alpha`$", "$`p_up/p_low`$", "degree of P", "$`sigma*`$"], tried)));
        blocks.extend(floquet_section("Of the middle of the Jacobian", &self.resolution.candidates.floquet));
        blocks
    }

    /// As JSON: `{"format": "sigmastar/lyapunov", "version": 1, ...}`.
    fn json(&self) -> Value {
        let Lyapunov { p_low, p_up, alpha, .. } = &self.triple;
        let mut report = proved_json(&self.matrix, [p_low, p_up, alpha].map(|value| value.text.clone()));
        let tried = self.resolution.candidates.found.iter().zip(&self.resolution.sigmas);
        let candidates = tried.map(|(candidate, sigma)| {
            json!({
                "alpha": estimate(candidate.alpha), "ratio": estimate(candidate.ratio),
                "degree": candidate.matrix.harmonics.len(), "sigma_star": sigma.map(estimate),
            })
        });
        report["candidates_estimates"] = candidates.collect();
        let floquet = self.resolution.candidates.floquet.iter().map(|pair| json!(pair.map(estimate)));
        report["floquet_exponents_not_certified"] = floquet.collect();
        report
    }
}

/// The section on Floquet exponents, those of `whose`.
pub(super) fn floquet_section(whose: &str, exponents: &[[f64; 2]]) -> [Block; 3] {
    [
        Block::heading("Floquet exponents (floating point, not certified)"),
        Block::says(format!("{whose}, in 1/time. Minus the largest real part bounds $`alpha`$ for every P(t).")),
        Block::Table(Table::of(&["real part", "imaginary part"], exponents.iter().map(|parts| parts.map(estimate)))),
    ]
}

/// The first fields of the report as JSON: P(t), and its p_low, p_up and alpha.
pub(super) fn proved_json(matrix: &PeriodicMatrix, triple: [String; 3]) -> Value {
    let mut report = json!({ "format": "sigmastar/lyapunov", "version": 1, "verdict": "certified" });
    for (name, value) in matrix_json(matrix) {
        report[name] = value;
    }
    for (name, value) in ["p_low", "p_up", "alpha"].into_iter().zip(triple) {
        report[name] = json!(value);
    }
    report
}

fn row_text(row: &[Rational]) -> String {
    let entries: Vec<String> = row.iter().map(write_exact).collect();
    format!("[ {} ]", entries.join(", "))
}
