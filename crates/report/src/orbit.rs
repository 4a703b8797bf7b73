//! The report of `sigmastar lyapunov` on a plant: its orbit, the coordinates in which it contracts, what was tried.

use super::lyapunov::{floquet_section, proved_json};
use rug::Rational;
use serde_json::{Value, json};
use sigmastar_document::number::{estimate, exact};
use sigmastar_document::{Block, Readable, Table, clean};
use sigmastar_exact::number::{Direction, write_exact};
use sigmastar_lang::plant::Plant;
use sigmastar_prove::certificate::{members, rows};
use sigmastar_prove::reduction::OrbitStudy;

/// The report on the zero dynamics of a plant.
pub struct OrbitReport<'r> {
    /// The plant.
    pub plant: &'r Plant,
    /// What was found and proved.
    pub study: &'r OrbitStudy,
}

impl Readable for OrbitReport<'_> {
    fn blocks(&self) -> Vec<Block> {
        let OrbitStudy { coordinates, orbit, candidates, floquet } = self.study;
        let title = Block::Title(format!("{}: the zero dynamics along their orbit", clean(&self.plant.name)));
        if self.plant.states() == 0 {
            let nothing =
                "Proved: the plant has no state, so there are no zero dynamics, and nothing of them to prove.";
            return vec![title, Block::Verdict(nothing.to_owned())];
        }
        let up = |value: &Rational| exact(value, Direction::Up);
        let mut blocks = vec![
            title,
            Block::Verdict(format!(
                "Proved: {}$`x' = f(t,x,0)`$ has exactly one T-periodic solution $`x_0`$ with $`|L^-1 (x_0 - xb)| <= {}`$ for all $`t`$; it has \
                 $`|L^-1 (x_0 - xb)| <= {}`$; along it $`p_low I <= P <= p_up I`$ and $`P' + P J + J'P <= -2 alpha P`$, $`J = L^-1 df/dx L`$, \
                 with $`p_low = {}`$, $`p_up = {}`$, $`alpha = {}`$.",
                members(&self.plant.parameters)
                    .map_or_else(String::new, |members| format!("of every plant with {members}, ")),
                exact(&orbit.tube, Direction::Down),
                up(&orbit.radius),
                exact(&orbit.p_low, Direction::Down),
                up(&orbit.p_up),
                exact(&orbit.alpha, Direction::Down)
            )),
            Block::heading("L, by rows"),
            Block::List(rows_text(&coordinates.l)),
        ];
        let p = if coordinates.p.harmonics.is_empty() { "P is the identity." } else { "P varies with $`t`$." };
        blocks.push(Block::says(p));
        blocks.push(Block::Detail);
        blocks.push(Block::heading("Candidates (floating point)"));
        let tried = candidates.iter().map(|candidate| {
            let degree = candidate.coordinates.p.harmonics.len().to_string();
            [estimate(candidate.rate), degree, rows_text(&candidate.coordinates.l).join(" ")]
        });
        blocks.push(Block::Table(Table::of(&["rate", "degree of P", "<L"], tried)));
        blocks.extend(floquet_section("Along the orbit", floquet));
        blocks
    }

    /// As JSON: `{"format": "sigmastar/lyapunov", "version": 1, ...}`.
    fn json(&self) -> Value {
        let OrbitStudy { coordinates, orbit, candidates, floquet } = self.study;
        let mut report = proved_json(&coordinates.p, [&orbit.p_low, &orbit.p_up, &orbit.alpha].map(write_exact));
        report["coordinates"] = rows(&coordinates.l);
        report["orbit"] = json!({
            "harmonics": orbit.orbit.harmonics(), "defect": write_exact(&orbit.defect),
            "tube": write_exact(&orbit.tube), "radius": write_exact(&orbit.radius),
        });
        let tried = candidates.iter().map(|candidate| {
            json!({
                "alpha": estimate(candidate.rate), "degree": candidate.coordinates.p.harmonics.len(),
                "coordinates": rows(&candidate.coordinates.l),
            })
        });
        report["candidates_estimates"] = tried.collect();
        report["floquet_exponents_not_certified"] = floquet.iter().map(|pair| json!(pair.map(estimate))).collect();
        report
    }
}

fn rows_text(matrix: &[Vec<Rational>]) -> Vec<String> {
    matrix.iter().map(|row| format!("[{}]", row.iter().map(write_exact).collect::<Vec<_>>().join(", "))).collect()
}
