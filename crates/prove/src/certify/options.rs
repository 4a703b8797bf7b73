//! What a run is asked for.

use rug::Rational;
use sigmastar_decide::conditions::Ladder;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_propose::search::Limited;
use sigmastar_theory::derivation::control::Control;

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

/// What a run does; every field has a default.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// The transfer constants (default: the best available).
    pub transfer: TransferChoice,
    /// The working precisions (default: 128 to 1024 bits).
    pub ladder: Ladder,
    /// Whether what else would give is worked out too, and the paper's derivations are searched where their constants are asked for
    /// (default: yes).
    pub compare: bool,
}

impl Default for Options {
    fn default() -> Options {
        Options { transfer: TransferChoice::default(), ladder: Ladder::default(), compare: true }
    }
}

impl Options {
    /// What does not fit the regulator at samples, or a claim about every set of harmonics, and what to do about it; `transfer` is what the user writes for
    /// that option.
    #[must_use]
    pub fn misfit(&self, (at_samples, every_set): (bool, bool), transfer: &str) -> Option<[String; 2]> {
        if every_set && self.transfer == TransferChoice::Boxes {
            return Some([
                format!(
                    "{transfer} boxes is about the first n_o harmonics, and the claim is to be about every set of them"
                ),
                format!("leave {transfer} out, or `harmonics`"),
            ]);
        }
        (at_samples && self.transfer != TransferChoice::Best).then(|| {
            [
                format!(
                    "{transfer} is not for the regulator at samples: its constants are checked harmonic by harmonic"
                ),
                format!("leave {transfer} or the sampling period out"),
            ]
        })
    }
}

/// What a claim is to keep to, at its gain; each where it is asked for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Limits {
    /// Of |e| along the periodic solution, for every n_o, or for those of `steady_with`.
    pub steady_error: Option<Rational>,
    /// The numbers of oscillators with which the steady error is meant; empty for every one.
    pub steady_with: Vec<u32>,
    /// Of |e| on the way from the initial set, at all times.
    pub peak_error: Option<Rational>,
    /// Of what is put out, on the way from the initial set, at all times.
    pub control: Option<Rational>,
    /// Of the rates for the numbers of oscillators that are asked about, in 1/time: each is at least this.
    pub rate: Option<Rational>,
}

impl Limits {
    /// Whether nothing is asked for.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rate.is_none() && self.steady_error.is_none() && self.named().all(|(_, limit)| limit.is_none())
    }

    /// That of |e| along the periodic solution for every n_o.
    pub(super) fn steady_for_every(&self) -> Option<&Rational> {
        self.steady_error.as_ref().filter(|_| self.steady_with.is_empty())
    }

    fn named(&self) -> impl Iterator<Item = (Limited, Option<&Rational>)> {
        [
            (Limited::SteadyError, self.steady_for_every()),
            (Limited::PeakError, self.peak_error.as_ref()),
            (Limited::Control, self.control.as_ref()),
        ]
        .into_iter()
    }

    /// Whether the bounds at the gain of a proof are certainly not above, rates and the steady error with some n_o apart: of |e| along the periodic solution and on the way, and of the
    /// control.
    #[must_use]
    pub fn kept(&self, [steady, peak]: [&Enclosure; 2], control: &Control<Enclosure>) -> bool {
        let largest = &control.steady + &control.transient;
        let bounds = [steady, peak, &largest];
        self.named().zip(bounds).all(|((_, limit), bound)| {
            limit.is_none_or(|limit| bound.upper_rational().is_some_and(|upper| upper <= *limit))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_does_not_fit_is_refused() {
        let boxes = Options { transfer: TransferChoice::Boxes, ..Options::default() };
        let fits = [(Options::default(), false), (Options::default(), true), (boxes, false)];
        assert!(fits.iter().all(|(options, at_samples)| options.misfit((*at_samples, false), "transfer").is_none()));
        let [message, help] = boxes.misfit((true, false), "--transfer").unwrap();
        assert_eq!(help, "leave --transfer or the sampling period out");
        assert!(message.starts_with("--transfer is not for the regulator at samples"));
    }
}
