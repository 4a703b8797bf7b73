//! The paper's own constants of the transfer bound, to the letter: compared, never used for a claim, and held against
//! what is proved.

use super::closed_form::closed_form_pair;
use super::pair::{PairStatus, pair_status};
use crate::data::Data;
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};

/// The numbers of the paper's supplementary lemma (P:lemma:transfer_function). Unsound as printed: the value at 0 and
/// the case m = 0 are wrong (E7), nu is read as mu (E6), 512 should be 2048 (E8).
#[derive(Clone, Debug)]
pub struct PrintedTransfer {
    /// S = n_0/n_1 + n_0/(3 n_2) + 10/3 (P:29).
    pub s: Enclosure,
    /// a = max{(2 + sqrt 2) S, 25/8} (P:30).
    pub a: Enclosure,
    /// varpi = 1/(48 (a + 2)) (P:31).
    pub varpi: Enclosure,
    /// kappa_0 = 7 n_0 / 2.
    pub kappa_0: Enclosure,
    /// kappa_1 = 4 n_0/varpi^2 + 512/(mu^2 n_1).
    pub kappa_1: Enclosure,
}

impl PrintedTransfer {
    /// Evaluates the printed constants.
    #[must_use]
    pub fn new(n_0: &Enclosure, n_1: &Enclosure, n_2: &Enclosure, mu: &Enclosure) -> PrintedTransfer {
        let p = n_0.precision();
        let rational = |n: i64, d: i64| Enclosure::from_rational(&Rational::from((n, d)), p);
        let s = n_0 / n_1 + n_0 / (3 * n_2) + rational(10, 3);
        let a = ((2 + Enclosure::from_integer(2, p).sqrt()) * &s).max(&rational(25, 8));
        let varpi = (48 * (&a + 2)).recip();
        let kappa_0 = 7 * n_0 / 2;
        let kappa_1 = 4 * n_0 / varpi.sqr() + 512 / (mu.sqr() * n_1);
        PrintedTransfer { s, a, varpi, kappa_0, kappa_1 }
    }
}

/// The printed constants for the data.
#[must_use]
pub fn printed_transfer(data: &Data<'_>) -> PrintedTransfer {
    PrintedTransfer::new(&data.n_0, &data.n_1, &data.spec.internal_model.weights.weight(2, data.precision), &data.mu)
}

/// The interval `[varpi/m, 1/5]` from which lambda is to be chosen for m >= 1 (P:eq:ineq_lambda). (For m = 0, which the
/// proof needs, it is not defined: erratum E7.)
#[must_use]
pub fn lambda_interval(printed: &PrintedTransfer, m: u32) -> Option<(Enclosure, Enclosure)> {
    let p = printed.varpi.precision();
    (m >= 1).then(|| (&printed.varpi / i64::from(m), Enclosure::from_rational(&Rational::from((1, 5)), p)))
}

/// One printed statement that is held against the truth.
#[derive(Clone, Debug)]
pub struct PrintedCheck {
    /// What is compared, in words.
    pub what: &'static str,
    /// The printed side.
    pub printed: Enclosure,
    /// What it must reach.
    pub needed: Enclosure,
    /// Whether it does.
    pub holds: Truth,
}

/// The printed constants and what becomes of them.
#[derive(Clone, Debug)]
pub struct PrintedChecks {
    /// S, a, varpi, kappa_0, kappa_1.
    pub constants: PrintedTransfer,
    /// What is known of the printed pair, read in the units of omega.
    pub status: PairStatus,
    /// The closed-form pair.
    pub repaired: (Enclosure, Enclosure),
    /// Statement by statement.
    pub checks: [PrintedCheck; 4],
}

impl PrintedChecks {
    /// Decides each statement for the data.
    #[must_use]
    pub fn new(data: &Data<'_>) -> PrintedChecks {
        let constants = printed_transfer(data);
        let w = &data.base_frequency;
        // Printed are kappa_0 and kappa_1; in units of x they are k0 = kappa_0 w^2 and k1 = kappa_1 w^4.
        let status = pair_status(data, &(&constants.kappa_0 * w.sqr()), &(&constants.kappa_1 * w.sqr().sqr()));
        let mu_squared = data.mu.sqr();
        let at_zero = (&mu_squared * &data.n_0).recip();
        let at_one = 2 / (&mu_squared * &data.n_1);
        let check = |what, printed: Enclosure, needed: Enclosure| PrintedCheck {
            what,
            holds: needed.le(&printed),
            printed,
            needed,
        };
        let checks = [
            check("the value at omega = 0 (E7): 2 l^2/(mu^2 n_1) at l = 0", data.zero(), at_zero.clone()),
            check("kappa_0 = 7 n_0/2 at omega = 0 (E7)", constants.kappa_0.clone(), at_zero),
            check(
                "kappa_0 + kappa_1 w^2 at omega = w, n_o >= 1 (E6)",
                &constants.kappa_0 + &constants.kappa_1 * w.sqr(),
                at_one,
            ),
            check("512/mu^2 where the proof needs 2048/mu^2 (E8)", 512 / &mu_squared, 2048 / &mu_squared),
        ];
        PrintedChecks { constants, status, repaired: closed_form_pair(data), checks }
    }
}
