//! The paper's own constants of the transfer bound, to the letter: compared, never used for a claim.

use crate::data::Data;
use crate::enclosure::Enclosure;
use rug::Rational;

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

/// Evaluates the printed constants.
#[must_use]
pub fn printed_transfer(data: &Data<'_>) -> PrintedTransfer {
    let p = data.precision;
    let rational = |n: i64, d: i64| Enclosure::from_rational(&Rational::from((n, d)), p);
    let n_2 = data.spec.internal_model.weights.weight(2, p);
    let s = &data.n_0 / &data.n_1 + &data.n_0 / (3 * &n_2) + rational(10, 3);
    let a = ((2 + Enclosure::from_integer(2, p).sqrt()) * &s).max(&rational(25, 8));
    let varpi = (48 * (&a + 2)).recip();
    let kappa_0 = 7 * &data.n_0 / 2;
    let kappa_1 = 4 * &data.n_0 / varpi.sqr() + 512 / (data.mu.sqr() * &data.n_1);
    PrintedTransfer { s, a, varpi, kappa_0, kappa_1 }
}

/// The interval `[varpi/m, 1/5]` from which lambda is to be chosen for m >= 1 (P:eq:ineq_lambda). (For m = 0, which the
/// proof needs, it is not defined: erratum E7.)
#[must_use]
pub fn lambda_interval(printed: &PrintedTransfer, m: u32) -> Option<(Enclosure, Enclosure)> {
    let p = printed.varpi.precision();
    (m >= 1).then(|| (&printed.varpi / i64::from(m), Enclosure::from_rational(&Rational::from((1, 5)), p)))
}
