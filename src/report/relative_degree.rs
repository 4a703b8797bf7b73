//! A relative degree above 1: from the filtered error to the regulated output.

use super::blocks::Block;
use super::number::upper;
use crate::enclosure::Enclosure;

/// The constants of the filter e = xi_r + a_{r-1} xi_{r-1} + ... + a_1 xi_1.
#[derive(Clone, Debug)]
pub struct RelativeDegreeBounds {
    /// k_infinity, the L1 norm of the impulse response from e to xi_1.
    pub k_infinity: Enclosure,
    /// k_2, the squared H-infinity norm from e to xi_1.
    pub k_2: Enclosure,
}

impl RelativeDegreeBounds {
    /// The section of the report.
    pub(super) fn section(&self) -> Vec<Block> {
        vec![
            Block::Heading("Relative degree".to_owned()),
            Block::List(vec![
                format!(
                    "along the periodic solution sup|xi_1| <= k_infinity sup|e| with k_infinity = {}",
                    upper(&self.k_infinity)
                ),
                format!(
                    "the integral of xi_1^2 over a period <= k_2 times that of e^2 with k_2 = {}",
                    upper(&self.k_2)
                ),
            ]),
        ]
    }
}
