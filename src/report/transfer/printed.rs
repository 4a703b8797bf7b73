//! The paper's own constants of the transfer bound beside the proved ones: which fail, and where.

use crate::data::Data;
use crate::enclosure::{Enclosure, Truth};
use crate::number::Direction;
use crate::report::blocks::{Block, Table};
use crate::report::number::{compact, exact};
use crate::transfer::{
    CertifiedPair, PairStatus, PrintedTransfer, closed_form_pair, lambda_interval, pair_status, printed_transfer,
};

/// The m for which the interval of lambda is shown.
const LAMBDA_ROWS: u32 = 3;

/// One printed statement that is held against the truth.
pub(super) struct Check {
    /// What is compared, in words.
    pub what: String,
    /// The printed side.
    pub printed: Enclosure,
    /// What it must reach.
    pub needed: Enclosure,
    /// Whether it does.
    pub holds: Truth,
}

/// The printed constants and what becomes of them.
pub(super) struct PrintedVerdict {
    /// S, a, varpi, kappa_0, kappa_1.
    pub constants: PrintedTransfer,
    /// What is known of the printed pair, read in the units of omega.
    pub status: PairStatus,
    /// The closed-form pair.
    pub repaired: (Enclosure, Enclosure),
    /// Statement by statement.
    pub checks: Vec<Check>,
}

impl PrintedVerdict {
    pub(super) fn new(data: &Data<'_>) -> PrintedVerdict {
        let constants = printed_transfer(data);
        let w = &data.base_frequency;
        // Printed are kappa_0 and kappa_1; in units of x they are k0 = kappa_0 w^2 and k1 = kappa_1 w^4.
        let status = pair_status(data, &(&constants.kappa_0 * w.sqr()), &(&constants.kappa_1 * w.sqr().sqr()));
        let mu_squared = data.mu.sqr();
        let at_zero = (&mu_squared * &data.n_0).recip();
        let at_one = 2 / (&mu_squared * &data.n_1);
        let check = |what: &str, printed: Enclosure, needed: Enclosure| Check {
            what: what.to_owned(),
            holds: needed.le(&printed),
            printed,
            needed,
        };
        let checks = vec![
            check("the value at omega = 0 (E7): 2 l^2/(mu^2 n_1) at l = 0", data.zero(), at_zero.clone()),
            check("kappa_0 = 7 n_0/2 at omega = 0 (E7)", constants.kappa_0.clone(), at_zero),
            check(
                "kappa_0 + kappa_1 w^2 at omega = w, n_o >= 1 (E6)",
                &constants.kappa_0 + &constants.kappa_1 * w.sqr(),
                at_one,
            ),
            check("512/mu^2 where the proof needs 2048/mu^2 (E8)", 512 / &mu_squared, 2048 / &mu_squared),
        ];
        PrintedVerdict { constants, status, repaired: closed_form_pair(data), checks }
    }

    /// The verdict on the printed pair as one sentence.
    pub(super) fn sentence(&self) -> String {
        match &self.status {
            PairStatus::Proved => {
                "The printed kappa_0, kappa_1 do bound the transfer here (proved by other means than the printed proof)."
                    .to_owned()
            }
            PairStatus::Refuted(point) => format!(
                "The printed kappa_0, kappa_1 are refuted: at n_o = {} and omega = {} w the transfer times w^2 is {}, \
                 and they allow {}.",
                point.n_o,
                exact(&point.x, Direction::Nearest),
                compact(&point.value),
                compact(&point.bound),
            ),
            PairStatus::Undecided => {
                "The printed kappa_0, kappa_1 are neither proved nor refuted here.".to_owned()
            }
        }
    }

    pub(super) fn section(&self, data: &Data<'_>, pair: &CertifiedPair) -> Vec<Block> {
        let w = &data.base_frequency;
        let mut constants = Table::new(&["<constant", "printed", "repaired", "proved"]);
        let mut row = |name: &str, printed: &Enclosure, repaired: Enclosure, proved: Enclosure| {
            constants.push([name.to_owned(), compact(printed), compact(&repaired), compact(&proved)]);
        };
        let (k0, k1) = (data.rational(&pair.k0), data.rational(&pair.k1));
        row("kappa_0", &self.constants.kappa_0, &self.repaired.0 / w.sqr(), k0 / w.sqr());
        row("kappa_1", &self.constants.kappa_1, &self.repaired.1 / w.sqr().sqr(), k1 / w.sqr().sqr());
        for (name, value) in [("S", &self.constants.s), ("a", &self.constants.a), ("varpi", &self.constants.varpi)] {
            constants.push([name.to_owned(), compact(value)]);
        }
        constants.push(["lambda, m = 0".to_owned(), "undefined (varpi/0)".to_owned()]);
        for m in 1..=LAMBDA_ROWS {
            if let Some((low, high)) = lambda_interval(&self.constants, m) {
                let text = format!("{} to {}", compact(&low), compact(&high));
                constants.push([format!("lambda, m = {m}"), text]);
            }
        }
        let mut checks = Table::new(&["<printed statement", "printed", "needed", "<"]);
        for check in &self.checks {
            let verdict = match check.holds {
                Truth::True => "holds",
                Truth::False => "fails",
                Truth::Undecided => "undecided",
            };
            checks.push([check.what.clone(), compact(&check.printed), compact(&check.needed), verdict.to_owned()]);
        }
        vec![
            Block::Heading("Printed, repaired and proved constants".to_owned()),
            Block::says(
                "In the units of omega. The printed proof reads mu for nu = mu/w and drops the powers of w (E6); for \
                 m = 0, which it needs, its lambda is not defined (E7).",
            ),
            Block::Table(constants),
            Block::Table(checks),
            Block::says(self.sentence()),
        ]
    }
}
