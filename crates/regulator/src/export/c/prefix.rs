//! The prefix of the symbols of exported C code.

use std::fmt;
use thiserror::Error;

/// The most characters: with `_reset_` and eight digits the 31 are kept that C99 promises to tell apart in external names.
const LONGEST: usize = 16;

/// Why a text cannot be the prefix of C symbols.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[error("a prefix is a lower-case letter, then lower-case letters, digits or `_`, at most {LONGEST} characters")]
pub struct PrefixError;

/// The prefix of the symbols of exported C code. Macros have it in upper case, so that two prefixes that differ do so there too.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Prefix(String);

impl Prefix {
    /// The prefix of this text.
    ///
    /// # Errors
    /// [`PrefixError`].
    pub fn new(text: &str) -> Result<Prefix, PrefixError> {
        let first = text.starts_with(|c: char| c.is_ascii_lowercase());
        let ordinary = text.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_');
        if first && ordinary && text.len() <= LONGEST { Ok(Prefix(text.to_owned())) } else { Err(PrefixError) }
    }

    /// As macros have it.
    pub(super) fn upper(&self) -> String {
        self.0.to_ascii_uppercase()
    }
}

impl Default for Prefix {
    fn default() -> Prefix {
        Prefix("sigmastar".to_owned())
    }
}

impl fmt::Display for Prefix {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prefixes() {
        for good in ["a", "axis_1", "sigmastar", "a234567890123456"] {
            assert_eq!(Prefix::new(good).map(|prefix| prefix.to_string()), Ok(good.to_owned()));
        }
        for bad in ["", "1a", "_a", "Axis", "a-b", "a b", "ä", "a2345678901234567"] {
            assert_eq!(Prefix::new(bad), Err(PrefixError), "{bad}");
        }
        assert_eq!(Prefix::default().upper(), "SIGMASTAR");
    }
}
