//! The paper's own constants of the transfer bound beside the proved ones: which fail, and where.

use sigmastar_document::number::{compact, exact};
use sigmastar_document::{Block, Table};
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_exact::number::Direction;
use sigmastar_theory::data::Data;
use sigmastar_theory::transfer::{CertifiedPair, PairStatus, PrintedChecks, lambda_interval};

/// The m for which the interval of lambda is shown.
const LAMBDA_ROWS: u32 = 3;

/// The verdict on the printed pair as one sentence.
fn sentence(status: &PairStatus) -> String {
    match status {
        PairStatus::Proved => {
            "The printed $`kappa_0`$, $`kappa_1`$ do bound the transfer here (proved by other means than the printed proof)."
                .to_owned()
        }
        PairStatus::Refuted(point) => format!(
            "The printed $`kappa_0`$, $`kappa_1`$ are refuted: at $`n_o = {}`$ and $`omega = {} w`$ the transfer times $`w^2`$ is {}, \
             and they allow {}.",
            point.n_o,
            exact(&point.x, Direction::Nearest),
            compact(&point.value),
            compact(&point.bound),
        ),
        PairStatus::Undecided => "The printed $`kappa_0`$, $`kappa_1`$ are neither proved nor refuted here.".to_owned(),
    }
}

/// The section.
pub(super) fn section(printed: &PrintedChecks, data: &Data<'_>, pair: &CertifiedPair) -> Vec<Block> {
    let w = &data.base_frequency;
    let mut constants = Table::new(&["<constant", "printed", "repaired", "proved"]);
    let mut row = |name: &str, value: &Enclosure, repaired: Enclosure, proved: Enclosure| {
        constants.push([name.to_owned(), compact(value), compact(&repaired), compact(&proved)]);
    };
    let [kappa_0, kappa_1] = data.kappas(&data.rational(&pair.k0), &data.rational(&pair.k1));
    row("$`kappa_0`$", &printed.constants.kappa_0, &printed.repaired.0 / w.sqr(), kappa_0);
    row("$`kappa_1`$", &printed.constants.kappa_1, &printed.repaired.1 / w.sqr().sqr(), kappa_1);
    for (name, value) in [("S", &printed.constants.s), ("a", &printed.constants.a), ("varpi", &printed.constants.varpi)]
    {
        constants.push([name.to_owned(), compact(value)]);
    }
    constants.push(["$`lambda`$, $`m = 0`$".to_owned(), "undefined (varpi/0)".to_owned()]);
    for m in 1..=LAMBDA_ROWS {
        if let Some((low, high)) = lambda_interval(&printed.constants, m) {
            let text = format!("{} to {}", compact(&low), compact(&high));
            constants.push([format!("$`lambda`$, $`m = {m}`$"), text]);
        }
    }
    let checks = printed.checks.iter().map(|check| {
        let verdict = match check.holds {
            Truth::True => "holds",
            Truth::False => "fails",
            Truth::Undecided => "undecided",
        };
        [check.what.to_owned(), compact(&check.printed), compact(&check.needed), verdict.to_owned()]
    });
    vec![
        Block::Aside("Printed, repaired and proved constants".to_owned()),
        Block::says(
            "In the units of $`omega`$. The printed proof reads $`mu`$ for $`nu = mu/w`$ and drops the powers of $`w`$ (E6); for \
             $`m = 0`$, which it needs, its $`lambda`$ is not defined (E7).",
        ),
        Block::Table(constants),
        Block::Table(Table::of(&["<printed statement", "printed", "needed", "<"], checks)),
        Block::says(sentence(&printed.status)),
    ]
}
