//! Two quadratic forms in the states and the error, and what was proved of them from a plant's formulas (derivation, 13.7, (Jm)).

use rug::Rational;

/// A metric `Pi = [P p; p' w]` of (x, e) with the weight `k_p` of the internal model, and what its matrix is definite by.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Metric {
    /// P by rows: symmetric.
    pub matrix: Vec<Vec<Rational>>,
    /// p: an entry for each state. The far metric has zeros.
    pub cross: Vec<Rational>,
    /// w.
    pub weight: Rational,
    /// k_p > 0.
    pub k_p: Rational,
    /// c_x > 0.
    pub c_x: Rational,
    /// c_e > 0.
    pub c_e: Rational,
    /// c_y > 0.
    pub c_y: Rational,
}

/// At every t and every point of `|y| <= X`, `|e| <= E`, with the derivatives J, g, r, d of f and q there in the coordinates y, the
/// following two are positive semidefinite, for P, p, w, k_p of the metric in question, p_1 and w_1 of the near one:
/// near `[[-(P J + J'P) - c_x I, -(P g - value p) - J'p, -p - (k_p/2) r'], [., 2 value w - 2 p'g - c_e, -w - (k_p/2) d], [., ., k_p - c_y]]`,
/// far `[[-(P J + J'P) - c_x I, -(P g - value p_1), -(k_p/2) r'], [., 2 value (w_1 + w) - c_e, -w - (k_p/2) d], [., ., k_p - c_y]]`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JointInequality {
    /// X >= 0.
    pub x: Rational,
    /// E >= 0.
    pub e: Rational,
    /// The threshold of sigma, in 1/time.
    pub value: Rational,
    /// The metric at the threshold.
    pub near: Metric,
    /// The metric towards which the one of a larger sigma moves.
    pub far: Metric,
}

/// What a metric is between.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Level {
    /// `P <= p_up I`.
    pub p_up: Rational,
    /// `Pi >= diag(x_low I, 0)`, above 0.
    pub x_low: Rational,
    /// `Pi >= diag(0, e_low)`, above 0.
    pub e_low: Rational,
}

/// A joint inequality that proves stability, with the levels of the near and of the far metric.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JointStability {
    /// The inequality.
    pub inequality: JointInequality,
    /// Of the near and of the far metric.
    pub levels: [Level; 2],
}

impl JointInequality {
    /// Both metrics.
    #[must_use]
    pub fn metrics(&self) -> [&Metric; 2] {
        [&self.near, &self.far]
    }
}
