//! Entries of a table of bounds. In the coordinates y of a plant, `x = x_0 + L y`, and with its derivative along the orbit x_0, the
//! bounds are (derivation, 11.3):
//!
//! | bound | of |
//! |---|---|
//! | `Fx` | `\|L^-1 f_x L\| <= value` |
//! | `Fe` | `\|L^-1 f_e\| <= value` |
//! | `Qx` | `\|q_x L\| <= value` |
//! | `Qe`, `QeMax` | `\|q_e\| <= value`, `q_e <= value` |
//! | `Qtx` | `\|(q_tx + q_xx x_0') L\| <= value` |
//! | `Qte` | `\|q_te + q_xe x_0'\| <= value` |
//! | `Rate` | `P' + P J + J^T P <= -2 value P`, `J = L^-1 f_x L` |
//! | `RateExistence` | the same with the P of existence |
//! | `Q`, `Qt` | `\|q\| <= value`, `\|q_t + q_x x_0'\| <= value` |
//! | `Fxx` | `\|L^-1 f_xx (L ., L .)\| <= value`: the norm of the matrix with the second index pair in one, which is not below that of the bilinear map |
//! | `Fex` | `\|L^-1 f_ex L\| <= value` |

use rug::Rational;
use sigmastar_lang::spec::Bound;

/// Those that a certificate may list, in the order of the table.
pub const TABLE: [Bound; 9] = [
    Bound::Fx,
    Bound::Fe,
    Bound::Qx,
    Bound::Qe,
    Bound::QeMax,
    Bound::Qtx,
    Bound::Qte,
    Bound::Rate,
    Bound::RateExistence,
];

/// Its value among those of [`TABLE`]; not a number where it is not of the table.
#[must_use]
pub fn of_table(bound: Bound, table: &[f64; TABLE.len()]) -> f64 {
    TABLE.iter().zip(table).find(|(other, _)| **other == bound).map_or(f64::NAN, |(_, value)| *value)
}

/// One number of the table: the bound holds with this value on `G(x, e)`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Which bound.
    pub bound: Bound,
    /// X, not negative.
    pub x: Rational,
    /// E, not negative.
    pub e: Rational,
    /// The value.
    pub value: Rational,
}
