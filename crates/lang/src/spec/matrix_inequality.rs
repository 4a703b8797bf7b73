//! A matrix inequality of stability that was proved from a plant's formulas (derivation, 13.7, (M)).

use rug::Rational;

/// F of the derivation, 13.7 (M), with the P of stability times `w_x`, `kp = 2 h/mu`, `value` in the place of sigma and J + `rate` I
/// in that of J, is positive semidefinite for the derivatives (J, g, r, d) of f and q at one t: with (J, r) at a point of
/// `|x| <= X`, `|e| <= E` and (g, d) at another one of another such region where there is a splitting, else all at the same point.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MatrixInequality {
    /// X >= 0, of (J, r); of all derivatives where there is no splitting.
    pub x: Rational,
    /// E >= 0, of (g, d); of all derivatives where there is no splitting.
    pub e: Rational,
    /// w_x > 0.
    pub w_x: Rational,
    /// h > 0.
    pub h: Rational,
    /// The rate that x keeps, above 0, in 1/time: with it F is positive definite at every larger sigma.
    pub rate: Rational,
    /// The threshold of sigma, in 1/time.
    pub value: Rational,
    /// What the derivatives at two points are compared with.
    pub splitting: Option<Splitting>,
}

/// A symmetric S of order n + 1, in (x, y): F without the row and the column of e is at least S for every (J, r), and
/// `[[S, v], [v', 2 sigma]]` is positive semidefinite for the column v that e has in F, for every (g, d).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Splitting {
    /// E >= 0 of (J, r).
    pub e: Rational,
    /// X >= 0 of (g, d).
    pub x: Rational,
    /// S by rows.
    pub matrix: Vec<Vec<Rational>>,
}

impl MatrixInequality {
    /// (X, E) of (J, r), and of (g, d).
    #[must_use]
    pub fn arguments(&self) -> [[&Rational; 2]; 2] {
        let Self { x, e, splitting, .. } = self;
        let of_states = splitting.as_ref().map_or(e, |splitting| &splitting.e);
        let of_error = splitting.as_ref().map_or(x, |splitting| &splitting.x);
        [[x, of_states], [of_error, e]]
    }
}
