//! What a run is asked for.

use sigmastar_exact::enclosure::{DEFAULT_PRECISION, MAX_PRECISION};

/// The derivation on which a claim rests.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Derivation {
    /// Sections 2-6 of the derivation.
    #[default]
    Sharp,
    /// The paper's architecture, repaired.
    Repaired,
    /// The paper to the letter: never certifies.
    Printed,
}

impl Derivation {
    /// The word in certificates.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Derivation::Sharp => "sharp",
            Derivation::Repaired => "repaired",
            Derivation::Printed => "printed",
        }
    }
}

/// Which proof of the transfer bound the sharp derivation uses. The repaired derivation always has the closed form.
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
    /// The derivation that the verdict is about (default: sharp).
    pub derivation: Derivation,
    /// The transfer constants of the sharp derivation (default: the best available).
    pub transfer: TransferChoice,
    /// The working precisions (default: 128 to 1024 bits).
    pub ladder: Ladder,
    /// Whether the other derivations are worked out too, for comparison (default: yes).
    pub compare: bool,
}

impl Default for Options {
    fn default() -> Options {
        Options {
            derivation: Derivation::default(),
            transfer: TransferChoice::default(),
            ladder: Ladder::default(),
            compare: true,
        }
    }
}
