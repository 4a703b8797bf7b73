//! Options that do not go with what they are asked of. Each caller names them as its users write them.

use super::options::{Options, TransferChoice};

/// A choice of transfer constants, of the regulator at samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Misfit;

impl Options {
    /// What does not fit the regulator at samples.
    #[must_use]
    pub fn misfit(&self, at_samples: bool) -> Option<Misfit> {
        (at_samples && self.transfer != TransferChoice::Best).then_some(Misfit)
    }
}

impl Misfit {
    /// What is wrong; `name` makes of the word of an option what the user writes.
    #[must_use]
    pub fn message(self, name: impl Fn(&str) -> String) -> String {
        let option = name("transfer");
        format!("{option} is not for the regulator at samples: its constants are checked harmonic by harmonic")
    }

    /// What to do about it.
    #[must_use]
    pub fn help(self, name: impl Fn(&str) -> String) -> String {
        format!("leave {} or the sampling period out", name("transfer"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_does_not_fit_is_refused() {
        let boxes = Options { transfer: TransferChoice::Boxes, ..Options::default() };
        assert_eq!([Options::default().misfit(false), Options::default().misfit(true), boxes.misfit(false)], [None; 3]);
        let misfit = boxes.misfit(true).unwrap();
        assert_eq!(misfit.help(|option| format!("--{option}")), "leave --transfer or the sampling period out");
        assert!(misfit.message(str::to_owned).starts_with("transfer is not for the regulator at samples"));
    }
}
