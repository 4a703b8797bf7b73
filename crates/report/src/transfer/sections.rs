//! The sections of the report on the transfer bound.

use sigmastar_document::number::{compact, exact, lower, upper};
use sigmastar_document::{Block, Table};
use sigmastar_exact::number::{Direction, write_exact};
use sigmastar_theory::data::Data;
use sigmastar_theory::transfer::{CertifiedPair, MatchedPair, Uniformity};

/// The claim itself.
pub(super) fn pair(data: &Data<'_>, pair: &CertifiedPair) -> Vec<Block> {
    let [kappa_0, kappa_1] = data.kappas(&data.rational(&pair.k0), &data.rational(&pair.k1));
    let mut blocks = vec![
        Block::Verdict(format!(
            "Proved: $`T_N(x) <= k0 + k1 x^2`$ with $`k0 = {}`$ and $`k1 = {}`$, for every number of oscillators $`N = n_o >= 0`$ and every \
             $`x = omega/w >= 0`$, where $`nu = {} = {}`$.",
            write_exact(&pair.k0),
            write_exact(&pair.k1),
            // That of the smallest input gain serves all of an interval.
            if data.input_gain.is_some() { "b_lo mu/w" } else { "mu/w" },
            compact(&data.nu),
        )),
        Block::says(format!(
            "So $`zeta* N zeta <= (kappa_0 + kappa_1 omega^2) |v|^2`$ at every frequency $`omega`$, with $`kappa_0 = {}`$ and $`kappa_1 = \
             {}`$, whatever $`n_o`$ is.",
            upper(&kappa_0),
            upper(&kappa_1),
        )),
        Block::says(
            "Computed with enclosures. No independent program checks this report; where `certify` uses a pair, the checker \
             decides that pair again from the certificate.",
        ),
        Block::says(format!(
            "The proof: {} boxes over $`x`$ in [0, {}] for each $`N < {}`$ and for all $`N >= {}`$ together, and one scalar test for \
             $`x`$ beyond ($`m0 = {}`$, $`N0 = {}`$).",
            pair.proof.boxes(),
            f64::from(pair.proof.m0) - 0.5,
            pair.proof.n0,
            pair.proof.n0,
            pair.proof.m0,
            pair.proof.n0,
        )),
    ];
    if let (Some(point), Some(excess)) = (&pair.binding, pair.excess(data)) {
        blocks.push(Block::says(format!(
            "With this $`k0`$ no $`k1`$ below {} is admissible, because of $`T_{}({}) = {}`$: $`k1`$ is at most {} % above the best.",
            lower(&point.least_k1),
            point.n_o,
            exact(&point.x, Direction::Nearest),
            compact(&point.value),
            upper(&(100 * excess)),
        )));
    }
    blocks
}

/// One line for each number of oscillators.
pub(super) fn uniformity(rows: &[Uniformity]) -> Vec<Block> {
    if rows.is_empty() {
        return Vec::new();
    }
    let mut table = Table::new(&["$`n_o`$", "at least", "at most", "at $`x`$", "slowest decay, 1/time"]);
    for Uniformity { sup, decay } in rows {
        table.push([
            sup.n_o.to_string(),
            lower(&sup.ratio),
            upper(&sup.ratio),
            exact(&sup.x, Direction::Nearest),
            decay.as_ref().map_or_else(|| "-".to_owned(), compact),
        ]);
    }
    vec![
        Block::heading("How much of the bound each n_o uses"),
        Block::says(
            "The supremum of $`T_N(x)/(k0 + k1 x^2)`$ over $`x >= 0`$, enclosed; its lower end is the value at $`x`$. Beside it is the \
             decay rate of the slowest mode of the internal model, $`Phi - mu M M'N`$, from its enclosed poles. The bound \
             does not depend on $`n_o`$, but this rate tends to 0.",
        ),
        Block::Table(table),
    ]
}

/// Proved pairs along the curve.
pub(super) fn trade_off(data: &Data<'_>, pairs: &[CertifiedPair]) -> Vec<Block> {
    let mut table = Table::new(&["k0", "k1", "above the best, %", "m0", "N0", "boxes"]);
    for pair in pairs {
        let excess = pair.excess(data).map_or_else(|| "unknown".to_owned(), |excess| upper(&(100 * excess)));
        let proof = &pair.proof;
        table.push([
            exact(&pair.k0, Direction::Up),
            exact(&pair.k1, Direction::Up),
            excess,
            proof.m0.to_string(),
            proof.n0.to_string(),
            proof.boxes().to_string(),
        ]);
    }
    vec![
        Block::heading("The trade-off between k0 and k1"),
        Block::says(
            "Each pair is proved; k1 is compared with a proved lower bound of every k1 that goes with that k0.",
        ),
        Block::Table(table),
    ]
}

/// The pair that only integers x need.
pub(super) fn matched(data: &Data<'_>, matched: &MatchedPair) -> Vec<Block> {
    let [kappa_0, kappa_1] = data.kappas(&data.rational(&matched.k0), &data.rational(&matched.k1));
    vec![
        Block::heading("Matched base frequency"),
        Block::says(format!(
            "The base frequency is exactly $`2 pi/T`$, so only integers $`x`$ occur. Proved for these: $`k0 = {}`$, $`k1 = {}`$ \
             (harmonics below {} one by one, the others by one inequality), that is $`kappa_0 = {}`$, $`kappa_1 = {}`$.",
            exact(&matched.k0, Direction::Up),
            exact(&matched.k1, Direction::Up),
            matched.first_of_tail,
            upper(&kappa_0),
            upper(&kappa_1),
        )),
    ]
}
