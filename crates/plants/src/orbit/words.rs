//! Numbers of messages.

use sigmastar_exact::number::{Direction, round_f64, write_exact};

/// A number of a message, in few digits.
pub(super) fn short(value: f64) -> String {
    round_f64(value, 4, Direction::Nearest).map_or_else(|| "unknown".to_owned(), |value| write_exact(&value))
}
