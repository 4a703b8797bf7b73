//! How thorough a search is: less so for long bounding functions, so that the work stays bounded.

use super::minimise::Descent;

/// The tolerance to the last digit, and that of what is only compared.
const TOLERANCE: f64 = 1e-11;
const ROUGH: f64 = 1e-6;

/// The room between both sides of S1 and S2 that a search leaves: well below the digits of sigma*.
pub const ROOM: f64 = 1e-10;

/// The room between both sides of S1 and S2 that a search leaves where results are compared. The set of the least gain at which there is
/// one may be of any size, and needs values that no proof gives; with this room a set of about the same gain can be used.
pub const ROOMY: f64 = 5e-2;

/// Operations of all bounding functions together up to which a search is thorough.
const THOROUGH: usize = 600;

/// The numbers of candidates and steps of a search.
///
/// A search evaluates the bounding functions some million times. With k times [`THOROUGH`] operations each evaluation costs
/// k times as much, so about k times fewer candidates are tried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Every so many values of X are scanned.
    pub x_step: usize,
    /// Every so many depths of E_p are scanned.
    pub e_step: usize,
    /// Every so many values of rho and of eta are scanned.
    pub shape_step: usize,
    /// Restarts of a refinement, out of those that are asked for.
    pub restarts_share: usize,
    /// Iterations of a refinement between restarts.
    pub iterations: u64,
    /// The relative change at which a refinement has converged.
    pub tolerance: f64,
    /// The room between both sides of S1 and S2, relatively.
    pub room: f64,
}

impl Effort {
    /// The effort for bounding functions of so many operations together.
    #[must_use]
    pub fn new(operations: usize) -> Effort {
        let less = operations.div_ceil(THOROUGH).max(1);
        Effort {
            x_step: less.min(4),
            e_step: less.div_ceil(4).min(4),
            // The values of rho times those of eta.
            shape_step: less.isqrt().clamp(1, 12),
            restarts_share: less,
            iterations: (400 / less as u64).max(40),
            tolerance: TOLERANCE,
            room: ROOM,
        }
    }

    /// That of a search whose result is only compared with others.
    #[must_use]
    pub fn rough(self) -> Effort {
        Effort { restarts_share: 4 * self.restarts_share, tolerance: ROUGH, room: ROOMY, ..self }
    }

    /// A refinement, for which so many restarts are asked.
    #[must_use]
    pub fn descent(self, restarts: usize) -> Descent {
        Descent { restarts: restarts / self.restarts_share, iterations: self.iterations, tolerance: self.tolerance }
    }

    /// Whether every datum is worth a refinement of its own, to see its influence.
    #[must_use]
    pub fn sensitivities(self) -> bool {
        self.restarts_share <= 4
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The error boxes of a scan times the operations of the bounding functions.
    fn work(operations: usize) -> usize {
        let step = Effort::new(operations).shape_step;
        15_usize.div_ceil(step) * 37_usize.div_ceil(step) * operations
    }

    #[test]
    fn the_work_of_a_search_is_bounded() {
        let thorough = work(THOROUGH);
        for operations in [THOROUGH + 1, 1_000, 2_000, 3_000, 5_000, 10_000, 20_000, 50_000] {
            assert!(work(operations) <= 2 * thorough, "{operations}: {}", work(operations));
        }
        assert_eq!(Effort::new(0), Effort::new(THOROUGH));
        assert_eq!(Effort::new(1).descent(12).restarts, 12);
    }
}
