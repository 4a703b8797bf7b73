//! Verdicts and exit codes, the same in every command.

use sigmastar_lang::spec::SpecErrors;
use std::fmt;

/// What a run concludes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Proved.
    Certified,
    /// Proved not to hold.
    Refuted,
    /// The input or the call is wrong.
    BadInput,
    /// Nothing is claimed either way.
    Undecided,
}

impl Verdict {
    /// The exit code.
    #[must_use]
    pub fn exit_code(self) -> u8 {
        match self {
            Verdict::Certified => 0,
            Verdict::Refuted => 1,
            Verdict::BadInput => 2,
            Verdict::Undecided => 3,
        }
    }

    /// The verdict where there is no claim to show, which is never [`Verdict::Certified`]: a claim is not to rest on one word.
    #[must_use]
    pub fn without_claim(self) -> Verdict {
        if self == Verdict::Certified { Verdict::Undecided } else { self }
    }
}

/// The verdict of what came to no run: undecided where nothing was found to be wrong, else bad input.
#[must_use]
pub fn verdict_of_errors(all: &[SpecErrors]) -> Verdict {
    if all.iter().all(SpecErrors::is_undecided) { Verdict::Undecided } else { Verdict::BadInput }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Verdict::Certified => "certified",
            Verdict::Refuted => "refuted",
            Verdict::BadInput => "bad-input",
            Verdict::Undecided => "undecided",
        })
    }
}
