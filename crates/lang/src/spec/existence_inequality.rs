//! A matrix inequality of existence that was proved from a plant's formulas (derivation, 13.7, (E)).

use rug::Rational;

/// At every t and every point of `|y| <= X`, `|e| <= E`, with the derivatives J, g, r, d of f and q there in the coordinates y,
/// `[[-(P J + J'P) - c_x I, -P g, -(k_p/2) r'], [., 2 value, -1 - (k_p/2) d], [., ., k_p - c_y]]` is positive semidefinite.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExistenceInequality {
    /// X >= 0.
    pub x: Rational,
    /// E >= 0.
    pub e: Rational,
    /// P by rows: symmetric, of any sign.
    pub matrix: Vec<Vec<Rational>>,
    /// k_p > 0.
    pub k_p: Rational,
    /// c_x > 0.
    pub c_x: Rational,
    /// c_y > 0.
    pub c_y: Rational,
    /// The threshold of sigma, in 1/time.
    pub value: Rational,
}
