//! What is required of a loop, and whether what is proved keeps it.

use super::row::{Cell, Row};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;

/// A quantity of which a largest value may be required.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Requirement {
    /// |e| along the periodic solution; with noise its limit superior.
    SteadyError,
    /// |e| at all times.
    PeakError,
    /// What is put out at all times.
    Control,
    /// After how many periods |e| is at most the required steady error for good, at samples at the sampling instants.
    Settling,
    /// |e - e_per| in the limit, with the noise of the document.
    Noise,
}

impl Requirement {
    /// All, in the order of reports.
    pub const ALL: [Requirement; 5] = [
        Requirement::SteadyError,
        Requirement::PeakError,
        Requirement::Control,
        Requirement::Settling,
        Requirement::Noise,
    ];

    /// Its name in JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Requirement::SteadyError => "steady_error",
            Requirement::PeakError => "peak_error",
            Requirement::Control => "max_control",
            Requirement::Settling => "settle",
            Requirement::Noise => "noise",
        }
    }

    /// In words, its formulas marked; of the law at samples, or not, and of the loop with noise, or not.
    #[must_use]
    pub fn words(self, at_samples: bool, noisy: bool) -> &'static str {
        match self {
            Requirement::SteadyError if noisy => "steady $`|e|`$ with noise",
            Requirement::PeakError if noisy => "largest $`|e|`$ with noise",
            Requirement::Control if noisy => "largest $`|u|`$ with noise",
            Requirement::Settling if at_samples && noisy => "periods to settle with noise, at samples",
            Requirement::Settling if noisy => "periods to settle with noise",
            Requirement::Settling if at_samples => "periods to settle, at samples",
            Requirement::SteadyError => "steady $`|e|`$",
            Requirement::PeakError => "largest $`|e|`$",
            Requirement::Control => "largest $`|u|`$",
            Requirement::Settling => "periods to settle",
            Requirement::Noise => "noise in $`|e|`$",
        }
    }

    /// Whether a larger gain is what helps, as a rule.
    #[must_use]
    pub fn falls(self) -> bool {
        !matches!(self, Requirement::Control | Requirement::Noise)
    }
}

/// Largest values, each where one is required.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Requirements {
    /// Of |e| along the periodic solution.
    pub steady_error: Option<Rational>,
    /// Of |e| at all times.
    pub peak_error: Option<Rational>,
    /// Of what is put out at all times.
    pub control: Option<Rational>,
    /// Of the periods until |e| is at most [`Requirements::steady_error`] for good, which is to be there.
    pub settling: Option<Rational>,
    /// Of |e - e_per| in the limit, with the noise of the document.
    pub noise: Option<Rational>,
}

/// A requirement beside what is proved.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Compared {
    /// What is required.
    pub requirement: Requirement,
    /// The largest value.
    pub asked: Rational,
    /// The least upper bound that is proved; none where there is none.
    pub proved: Option<Rational>,
}

impl Compared {
    /// Whether it is proved to be met.
    #[must_use]
    pub fn is_met(&self) -> bool {
        self.proved.as_ref().is_some_and(|proved| *proved <= self.asked)
    }

    /// What is proved over what is required, rounded.
    pub(super) fn share(&self) -> f64 {
        self.proved.as_ref().map_or(f64::INFINITY, |proved| proved.to_f64() / self.asked.to_f64())
    }
}

impl Requirements {
    /// The value that is required of a quantity.
    #[must_use]
    pub fn of(&self, requirement: Requirement) -> Option<&Rational> {
        match requirement {
            Requirement::SteadyError => self.steady_error.as_ref(),
            Requirement::PeakError => self.peak_error.as_ref(),
            Requirement::Control => self.control.as_ref(),
            Requirement::Settling => self.settling.as_ref(),
            Requirement::Noise => self.noise.as_ref(),
        }
    }

    /// Whether nothing is required.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        Requirement::ALL.iter().all(|requirement| self.of(*requirement).is_none())
    }

    /// Each requirement beside what is proved in a cell, in the loop with the noise of the document; `period` is that of [`Cell::settling`].
    #[must_use]
    pub fn compared(&self, cell: &Cell, period: &Enclosure) -> Vec<Compared> {
        let proved = |requirement| match requirement {
            Requirement::SteadyError => cell.in_all().and_then(|[steady, _]| steady.upper_rational()),
            Requirement::PeakError => cell.in_all().and_then(|[_, peak]| peak.upper_rational()),
            Requirement::Control => cell.control_in_all().and_then(Enclosure::upper_rational),
            Requirement::Settling => {
                self.steady_error.as_ref().and_then(|limit| cell.settling(limit, period)?.upper_rational())
            }
            Requirement::Noise => cell.noise_limit().cloned(),
        };
        let one = |requirement: &Requirement| {
            let asked = self.of(*requirement)?.clone();
            Some(Compared { requirement: *requirement, asked, proved: proved(*requirement) })
        };
        Requirement::ALL.iter().filter_map(one).collect()
    }

    /// How far a row is from the requirements with the number of oscillators that comes closest to them: of how many nothing is proved, and the largest
    /// share of the others.
    pub(super) fn distance(&self, row: &Row, period: &Enclosure) -> (usize, f64) {
        closest(row.cells.iter().map(|cell| distance(&self.compared(cell, period))))
    }
}

/// Of how many requirements nothing is proved, and the largest share of the others, rounded: a share of what is not proved says nothing.
pub(super) fn distance(compared: &[Compared]) -> (usize, f64) {
    let proved = compared.iter().filter(|one| one.proved.is_some());
    (compared.len() - proved.clone().count(), proved.map(Compared::share).fold(0.0, f64::max))
}

/// The least of these.
pub(super) fn closest(all: impl Iterator<Item = (usize, f64)>) -> (usize, f64) {
    all.fold((usize::MAX, f64::INFINITY), |least, one| if one < least { one } else { least })
}

#[cfg(test)]
mod tests {
    use super::super::row::Noise;
    use super::super::row::tests::{cell, falling, noisy};
    use super::*;

    /// Each requirement is met, and missed by a little.
    #[test]
    fn each_requirement_is_held_against_its_own_bound() {
        let period = Enclosure::exactly(1.0);
        let bounds = falling(cell(2, [1.0, 2.0, 3.0]), (1, 1), (5, 1));
        let with_noise = noisy(bounds.clone(), (1, 4), 0);
        let with = |requirement: Requirement, value: (u32, u32)| {
            let value = Some(Rational::from(value));
            match requirement {
                Requirement::SteadyError => Requirements { steady_error: value, ..Requirements::default() },
                Requirement::PeakError => Requirements { peak_error: value, ..Requirements::default() },
                Requirement::Control => Requirements { control: value, ..Requirements::default() },
                Requirement::Settling => {
                    Requirements { settling: value, steady_error: Some(2.into()), ..Requirements::default() }
                }
                Requirement::Noise => Requirements { noise: value, ..Requirements::default() },
            }
        };
        let quiet = [
            (Requirement::SteadyError, (1, 1), (99, 100)),
            (Requirement::PeakError, (2, 1), (199, 100)),
            (Requirement::Control, (3, 1), (299, 100)),
            // 1 + 5 exp(-t) is 2 at log 5 = 1.6094...
            (Requirement::Settling, (16095, 10000), (16094, 10000)),
        ];
        // With noise |e| has its limit besides, and the control what the noise adds.
        let noisy = [
            (Requirement::SteadyError, (5, 4), (124, 100)),
            (Requirement::PeakError, (9, 4), (224, 100)),
            (Requirement::Control, (10, 1), (999, 100)),
            // 1.25 + 5 exp(-t) is 2 at log(20/3) = 1.89711...
            (Requirement::Settling, (189_712, 100_000), (189_711, 100_000)),
            (Requirement::Noise, (1, 4), (249, 1000)),
        ];
        let all = quiet.map(|case| (&bounds, case)).into_iter().chain(noisy.map(|case| (&with_noise, case)));
        for (cell, (requirement, least, below)) in all {
            let met = |value| {
                let compared = with(requirement, value).compared(cell, &period);
                compared.iter().find(|one| one.requirement == requirement).map(Compared::is_met)
            };
            assert_eq!([met(least), met(below)], [Some(true), Some(false)], "{requirement:?}");
        }
        // What is not proved is not met.
        let unknown = Cell { noise: Noise::NotProved, ..bounds };
        for requirement in Requirement::ALL {
            let compared = with(requirement, (100, 1)).compared(&unknown, &period);
            let one = compared.iter().find(|one| one.requirement == requirement).unwrap();
            assert!(one.proved.is_none() && !one.is_met(), "{requirement:?}");
        }
        assert!(Requirements::default().is_empty() && !with(Requirement::Noise, (1, 1)).is_empty());
    }
}
