//! The weights n_0 > n_1 > ... of the internal model.

use super::model::Constant;

/// The two families of weights that are read.
#[derive(Clone, Debug)]
pub enum Weights {
    /// n_0 given, n_l = l^-(1 + epsilon) for l >= 1, with n_0 > 1 and 0 < epsilon <= 1.
    Power {
        /// n_0.
        n0: Constant,
        /// epsilon.
        epsilon: Constant,
    },
    /// n_0, ..., n_L listed; n_l = coefficient * l^-exponent for l > L, with coefficient > 0, 1 < exponent <= 2.
    Explicit {
        /// n_0, ..., n_L; at least one.
        values: Vec<Constant>,
        /// The coefficient of the tail.
        coefficient: Constant,
        /// The exponent of the tail.
        exponent: Constant,
    },
}
