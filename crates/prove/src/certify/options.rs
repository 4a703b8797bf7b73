//! What a run is asked for.

use sigmastar_exact::enclosure::{DEFAULT_PRECISION, MAX_PRECISION};

/// Which proof of the transfer bound a claim uses. The repaired derivation always has the closed form.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum TransferChoice {
    /// Harmonic by harmonic where the specification has a matched base frequency, by boxes otherwise.
    #[default]
    Best,
    /// By boxes: valid for every base frequency.
    Boxes,
    /// By the closed form: valid for every base frequency, with a larger gain.
    ClosedForm,
}

/// The precisions that are tried: from `start`, doubled, up to `limit` bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ladder {
    /// The first precision in bits.
    pub start: u32,
    /// The last precision in bits.
    pub limit: u32,
}

impl Default for Ladder {
    fn default() -> Ladder {
        Ladder { start: DEFAULT_PRECISION, limit: MAX_PRECISION }
    }
}

/// What a run does; every field has a default.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// The transfer constants (default: the best available).
    pub transfer: TransferChoice,
    /// The working precisions (default: 128 to 1024 bits).
    pub ladder: Ladder,
    /// Whether the printed and the repaired derivation are worked out too, for comparison (default: yes).
    pub compare: bool,
}

impl Default for Options {
    fn default() -> Options {
        Options { transfer: TransferChoice::default(), ladder: Ladder::default(), compare: true }
    }
}
