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
    /// Of |e| along the periodic solution.
    pub steady_error: Option<Rational>,
    /// Of |e| in the transient from the initial set, at all times.
    pub peak_error: Option<Rational>,
    /// Of what is put out, in the transient from the initial set, at all times.
    pub control: Option<Rational>,
    /// Whether these three are judged by all that is proved at the gain of the claim, what is proved by the number of oscillators included
    /// ([`Certification::set_counts`](super::Certification::set_counts)): for these numbers, or for every one where there are none. `None`: by what the
    /// conditions of the claim prove for every number.
    pub by_count: Option<Vec<u32>>,
    /// Of the rates for the numbers of oscillators that are asked about, in 1/time: each is at least this.
    pub rate: Option<Rational>,
}

impl Limits {
    /// Whether nothing is asked for.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rate.is_none() && !self.bounds_anything()
    }

    /// Whether something other than rates is asked for.
    #[must_use]
    pub fn bounds_anything(&self) -> bool {
        self.named().iter().any(|(_, limit)| limit.is_some())
    }

    /// The steady error, the peak and the control.
    pub(super) fn named(&self) -> [(Limited, Option<&Rational>); 3] {
        [
            (Limited::SteadyError, self.steady_error.as_ref()),
            (Limited::PeakError, self.peak_error.as_ref()),
            (Limited::Control, self.control.as_ref()),
        ]
    }

    /// Those of them that the conditions of a claim are to prove.
    pub(super) fn of_conditions(&self) -> [(Limited, Option<&Rational>); 3] {
        self.named().map(|(which, limit)| (which, limit.filter(|_| self.by_count.is_none())))
    }

    /// The same limits, judged by the conditions of a claim alone: what keeps to these keeps to those.
    pub(super) fn by_conditions(&self) -> Limits {
        Limits { by_count: None, ..self.clone() }
    }

    /// Whether something is for the conditions of a claim to prove.
    pub(crate) fn are_of_conditions(&self) -> bool {
        self.of_conditions().iter().any(|(_, limit)| limit.is_some())
    }

    /// Whether what the conditions of a claim prove at its gain keeps to them: of |e| along the periodic solution and in the transient, and of the
    /// control. Rates, and what is judged by the number of oscillators, are no part of it.
    #[must_use]
    pub fn kept(&self, [steady, peak]: [&Enclosure; 2], control: &Control<Enclosure>) -> bool {
        let largest = &control.steady + &control.transient;
        let bounds = [steady, peak, &largest];
        self.of_conditions().into_iter().zip(bounds).all(|((_, limit), bound)| {
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
