//! Verdicts and exit codes, the same in every command.

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
