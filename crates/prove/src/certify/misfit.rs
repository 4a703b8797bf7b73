//! Options that do not go with what they are asked of. Each caller names them as its users write them.

use super::options::{Derivation, Options, TransferChoice};

/// An option that does not fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Misfit {
    /// A derivation for which a plant does not give the data.
    OfPlant(Derivation),
    /// A derivation other than the sharp one, of the regulator at samples.
    DerivationAtSamples,
    /// A choice of transfer constants, of the regulator at samples.
    TransferAtSamples,
    /// A given gain in a derivation other than the sharp one.
    Gain,
}

impl Options {
    /// What does not fit a plant, the regulator at samples, or a gain that is given.
    #[must_use]
    pub fn misfit(&self, of_plant: bool, at_samples: bool, gain: bool) -> Option<Misfit> {
        let sharp = self.derivation == Derivation::Sharp;
        let found = [
            (at_samples && !sharp, Misfit::DerivationAtSamples),
            (at_samples && self.transfer != TransferChoice::Best, Misfit::TransferAtSamples),
            (gain && !sharp, Misfit::Gain),
            (of_plant && !sharp, Misfit::OfPlant(self.derivation)),
        ];
        found.into_iter().find(|(wrong, _)| *wrong).map(|(_, misfit)| misfit)
    }
}

impl Misfit {
    /// What is wrong; `name` makes of the word of an option what the user writes.
    #[must_use]
    pub fn message(self, name: impl Fn(&str) -> String) -> String {
        let at_samples =
            |option: &str, why: &str| format!("{} is not for the regulator at samples: {why}", name(option));
        match self {
            Misfit::OfPlant(derivation) => {
                let derivation = derivation.name();
                format!("the derivation `{derivation}` needs bounding functions that a plant does not give")
            }
            Misfit::DerivationAtSamples => at_samples("derivation", "only the sharp derivation covers samples"),
            Misfit::TransferAtSamples => at_samples("transfer", "its constants are checked harmonic by harmonic"),
            Misfit::Gain => format!("{} is for the sharp derivation", name("sigma")),
        }
    }

    /// What to do about it.
    #[must_use]
    pub fn help(self, name: impl Fn(&str) -> String) -> String {
        let [derivation, transfer, sigma] = ["derivation", "transfer", "sigma"].map(name);
        match self {
            Misfit::OfPlant(_) => format!("leave {derivation} out, or give a bounding specification"),
            Misfit::DerivationAtSamples => format!("leave {derivation} or the sampling period out"),
            Misfit::TransferAtSamples => format!("leave {transfer} or the sampling period out"),
            Misfit::Gain => format!("leave {derivation} or {sigma} out"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_does_not_fit_is_refused() {
        let options = |derivation, transfer| Options { derivation, transfer, ..Options::default() };
        let (sharp, best) = (Derivation::Sharp, TransferChoice::Best);
        for at in [[false; 3], [true, false, true], [true, true, true], [false, true, false]] {
            assert_eq!(options(sharp, best).misfit(at[0], at[1], at[2]), None);
        }
        let boxes = options(sharp, TransferChoice::Boxes);
        assert_eq!(boxes.misfit(true, false, true), None);
        assert_eq!(boxes.misfit(false, true, false), Some(Misfit::TransferAtSamples));
        let repaired = options(Derivation::Repaired, best);
        assert_eq!(repaired.misfit(false, false, false), None);
        assert_eq!(repaired.misfit(true, false, false), Some(Misfit::OfPlant(Derivation::Repaired)));
        assert_eq!(repaired.misfit(false, true, false), Some(Misfit::DerivationAtSamples));
        assert_eq!(repaired.misfit(false, false, true), Some(Misfit::Gain));
        let flag = |option: &str| format!("--{option}");
        assert_eq!(Misfit::Gain.message(flag), "--sigma is for the sharp derivation");
        assert_eq!(Misfit::Gain.help(flag), "leave --derivation or --sigma out");
    }
}
