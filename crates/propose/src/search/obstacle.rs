//! What stands in the way of a candidate: what failed, and where.

use super::binding::Binding;
use sigmastar_exact::number::in_digits;
use sigmastar_theory::data::Bound;

/// What failed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Failing {
    /// A number, or a bounding function at X = E = 0, is beyond what the search can work with.
    Magnitude(Extreme),
    /// A bounding function has no finite value; none of them is named where a number that is made of them has none.
    NotFinite(Option<Bound>),
    /// The arguments are beyond those up to which the bounds of a plant are known, this one first.
    Beyond {
        /// How they are known.
        known: Known,
        /// The first of them.
        bound: Bound,
    },
    /// S1 or S2 fails (C1 or C3 in the repaired derivation).
    Existence,
    /// X_b leaves the domain.
    DomainX,
    /// E_b leaves the domain.
    DomainE,
    /// a_2 <= 0: the nonlinearity in the error box takes all of alpha.
    Curvature,
    /// (h/mu) k_x^2 >= 4 w_x a_2.
    Coupling,
    /// The gain that is given is below the smallest one that is found.
    Gain {
        /// The given one.
        given: f64,
        /// About the smallest one, and what sets it, where one was found.
        smallest: Option<(f64, Binding)>,
    },
    /// h sigma > 1, for the gain that is given, or for every one that may do.
    Hold {
        /// The gain, or about the smallest one that may do.
        sigma: f64,
        /// 1/h.
        largest: f64,
        /// Whether the gain is given.
        given: bool,
    },
    /// 3 K h Nb2/2 >= 1, which a law with a delay needs to be less (derivation, 13.4).
    Delay {
        /// 3 K h Nb2/2.
        share: f64,
    },
    /// The interval of the input gain is so wide that C5 has no h for it at any gain (derivation, 13.1).
    InputGain {
        /// b_lo.
        low: f64,
        /// b_hi.
        high: f64,
    },
    /// C5h: the decay from sample to sample is not positive.
    Sampling,
    /// A period would need more samples than are taken.
    Samples,
    /// What is to be kept is not, for every gain and error box that was tried.
    Limit {
        /// What is to be kept.
        which: Limited,
        /// What it is to be.
        asked: f64,
        /// The other limit that is asked for at the same time and comes closest to being missed, and what that is to be.
        beside: Option<(Limited, f64)>,
        /// The least that is found to do.
        least: f64,
        /// The gain for which that does.
        sigma: f64,
        /// Whether a claim is proved that keeps to it; else it is of the search in floating point.
        proved: bool,
    },
    /// Every condition is proved, and the independent checker does not come to the same.
    NotDecidedAgain {
        /// Whether it refuses the certificate; else it gives up.
        refused: bool,
        /// The gain.
        sigma: f64,
    },
    /// |e| is to stay below less than what it is at the start.
    Start {
        /// The limit.
        asked: f64,
        /// E0.
        e0: f64,
    },
    /// For a number of oscillators no rate is proved that is as large as was asked for, for every gain that was tried.
    Rate {
        /// n_o.
        n_o: u32,
        /// What the rate is to be at least, in 1/time.
        asked: f64,
        /// The largest one that is found, where there is one.
        largest: Option<f64>,
        /// The gain for which that is.
        sigma: f64,
    },
    /// A proof was found, but the bounding functions are not proved up to its arguments.
    Bounds,
    /// A proof was found, but the bounds of the plant are not proved up to its arguments; this is the first of those that are not.
    Unproved(Bound),
}

/// What a claim may have to keep to at its gain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limited {
    /// |e| along the periodic solution.
    SteadyError,
    /// |e| on the way from the initial set.
    PeakError,
    /// What is put out, as it is asked for.
    Control,
    /// What is put out, as the actuator takes it: C6.
    Actuator,
}

impl Limited {
    /// What is bounded.
    #[must_use]
    pub fn quantity(self) -> &'static str {
        match self {
            Limited::SteadyError => "the steady |e|",
            Limited::PeakError => "|e| in the transient",
            Limited::Control | Limited::Actuator => "|u| in the transient",
        }
    }

    /// Whether it is a limit of what is put out, not of e.
    #[must_use]
    pub fn is_of_control(self) -> bool {
        matches!(self, Limited::Control | Limited::Actuator)
    }

    /// What is to be at most what it is asked to be.
    #[must_use]
    pub fn describe(self) -> &'static str {
        match self {
            Limited::SteadyError => "the steady |e| is not proved to be at most",
            Limited::PeakError => "|e| in the transient is not proved to be at most",
            Limited::Control => "|u| in the transient is not proved to be at most",
            Limited::Actuator => "|u| in the transient is not proved to be at most what the actuator takes,",
        }
    }
}

/// How far the bounds of a plant are known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Known {
    /// As far as its derivatives are sampled.
    Samples,
    /// As far as they are proved.
    Proofs,
}

/// A number that is too large or too small.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Extreme {
    /// One that has a name, and its size.
    Number(&'static str, f64),
    /// A bounding function at X = E = 0.
    Bound(Bound),
}

/// What stands in the way of a candidate, or of the one that came closest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Obstacle {
    /// What failed.
    pub failing: Failing,
    /// X and E at which it did, where it is about arguments.
    pub at: Option<[f64; 2]>,
}

impl From<Failing> for Obstacle {
    fn from(failing: Failing) -> Obstacle {
        Obstacle { failing, at: None }
    }
}

impl Failing {
    /// At these arguments.
    #[must_use]
    pub fn at(self, x: f64, e: f64) -> Obstacle {
        Obstacle { failing: self, at: Some([x, e]) }
    }

    /// Larger ones come closer to a certificate.
    fn rank(self) -> u8 {
        match self {
            Failing::Magnitude(_) | Failing::InputGain { .. } => 0,
            Failing::NotFinite(_) | Failing::Beyond { .. } => 1,
            Failing::Existence => 2,
            Failing::DomainX => 3,
            Failing::DomainE => 4,
            Failing::Curvature => 5,
            Failing::Coupling => 6,
            Failing::Gain { .. } => 7,
            Failing::Hold { .. } | Failing::Delay { .. } => 8,
            Failing::Sampling => 9,
            Failing::Samples => 10,
            Failing::Bounds | Failing::Unproved(_) => 11,
            Failing::Limit { .. } | Failing::Rate { .. } | Failing::Start { .. } => 12,
            Failing::NotDecidedAgain { .. } => 13,
        }
    }
}

impl Obstacle {
    /// The one of two that came closer; of two of a kind that with the smaller arguments, then the first.
    fn closer(self, other: Obstacle) -> Obstacle {
        let size = |obstacle: &Obstacle| obstacle.at.map_or(f64::INFINITY, |[x, e]| x.max(e));
        let (rank, others) = (self.failing.rank(), other.failing.rank());
        if others > rank || (others == rank && size(&other) < size(&self)) { other } else { self }
    }

    /// What failed and where, and what that means: no candidate was found, or one that is not enough.
    #[must_use]
    pub fn sentence(&self) -> String {
        match self.failing {
            Failing::NotDecidedAgain { .. } | Failing::Rate { .. } | Failing::Start { .. } | Failing::Limit { .. } => {
                self.describe()
            }
            _ => format!("no candidate was found: {}", self.describe()),
        }
    }

    /// What failed and where, for reports.
    #[must_use]
    pub fn describe(&self) -> String {
        let place = self.at.map_or_else(String::new, |[x, e]| format!(" (X = {}, E = {})", short(x), short(e)));
        match self.failing {
            Failing::Magnitude(extreme) => {
                let what = match extreme {
                    Extreme::Number(name, value) => format!("{name} = {}", short(value)),
                    Extreme::Bound(bound) => format!("the bounding function {} at X = E = 0", bound.field()),
                };
                format!("{what} is beyond the range of double precision, in which the search works")
            }
            Failing::NotFinite(Some(bound)) => format!(
                "the bounding function {} has no finite value at the arguments of any candidate that was tried; the \
                 smallest were{place}",
                bound.field()
            ),
            Failing::NotFinite(None) => format!(
                "a number of the proof is beyond the range of double precision for every candidate that was tried{place}"
            ),
            Failing::Beyond { known: Known::Samples, .. } => format!(
                "every error box that was tried is at least a million times as large as the orbit and the initial set; the smallest was{place}. No \
                 bounds of the plant are sought that far out"
            ),
            Failing::Beyond { known: Known::Proofs, .. } => format!(
                "every error box that was tried reaches further than the bounds of the plant are proved; the smallest was{place}"
            ),
            Failing::Existence => {
                format!("existence: no set was found that the map of the proof takes into itself{place}")
            }
            Failing::DomainX => format!("domain X: solutions from this set may leave the domain{place}"),
            Failing::DomainE => format!("domain E: solutions from this set may leave the domain{place}"),
            Failing::Curvature => {
                format!("C5: a_2 <= 0, the nonlinearity over the error box takes all of the decay rate{place}")
            }
            Failing::Coupling => format!("C5: (h/mu) k_x^2 >= 4 w_x a_2{place}"),
            Failing::Gain { given, smallest: Some((smallest, binding)) } => format!(
                "the gain {} is below the smallest one found, about {}, which is limited by {}",
                short(given),
                short(smallest),
                binding.describe()
            ),
            Failing::Gain { given, smallest: None } => format!(
                "C5: the gain {} is below the threshold of the quadratic form for every error box that was tried{place}",
                short(given)
            ),
            Failing::Hold { sigma, largest, given: true } => {
                format!("h sigma > 1: the gain is {}, and 1/h is {}", short(sigma), short(largest))
            }
            Failing::Hold { sigma, largest, given: false } => format!(
                "h sigma > 1 for every gain that may be proved by norms: even in continuous time the smallest one found is about \
                 {}, and 1/h is {}",
                short(sigma),
                short(largest)
            ),
            Failing::Delay { share } => format!(
                "3 K h Nb2/2 = {}, where Nb2 is the sum of all weights: the law with a delay needs it below 1",
                short(share)
            ),
            Failing::InputGain { low, high } => format!(
                "the input gain is too uncertain: with b from {} to {} times the nominal one C5 has no weight of the internal model at \
                 any gain, which asks for sqrt(b_hi) < 2 + sqrt(b_lo)",
                short(low),
                short(high)
            ),
            Failing::Sampling => {
                format!("C5h: the decay from sample to sample is not positive for any error box that was tried{place}")
            }
            Failing::Limit { which, asked, beside, least, sigma, proved } => format!(
                "{} {}{}; {} {}, at the gain {}",
                which.describe(),
                short(asked),
                beside.map_or_else(String::new, |(other, asked)| {
                    format!(", together with {} at most {}", other.quantity(), short(asked))
                }),
                if proved {
                    "the least for which a proof is found is"
                } else {
                    "the least that floating point finds is about"
                },
                short(least),
                short(sigma)
            ),
            Failing::NotDecidedAgain { refused: false, sigma } => format!(
                "every condition is proved here with the gain {}, but the independent checker does not decide the certificate within the work that \
                 it allows itself",
                short(sigma)
            ),
            Failing::NotDecidedAgain { refused: true, sigma } => format!(
                "every condition is proved here with the gain {}, but the independent checker refuses the certificate: one of the two programs is \
                 wrong",
                short(sigma)
            ),
            Failing::Start { asked, e0 } => format!(
                "|e| in the transient cannot be kept at most {} by any gain, because the initial set has |e| up to E0 = {} at the start",
                short(asked),
                short(e0)
            ),
            Failing::Rate { n_o, asked, largest, sigma } => {
                let found = largest.map_or_else(
                    || format!("none is proved at the gain {}", short(sigma)),
                    |largest| {
                        format!("the largest one found is about {}, at the gain {}", short(largest), short(sigma))
                    },
                );
                format!("the rate for n_o = {n_o} is not proved to be at least {}: {found}", short(asked))
            }
            Failing::Samples => "a period would need more samples than are taken".to_owned(),
            Failing::Unproved(Bound::Rate) => format!(
                "the proof that was found needs zero dynamics that contract up to a certain distance from the orbit{place}, and this is not \
                 proved; farther from the orbit they need not contract, as between two wells"
            ),
            Failing::Unproved(_) => format!(
                "an error box was found over samples of the plant's derivatives, but the bounds that are proved on it are larger, and with them the \
                 error box reaches further than they are proved{place}"
            ),
            Failing::Bounds => {
                format!("the bounding functions are not proved up to the arguments of the proof that was found{place}")
            }
        }
    }
}

/// Four digits.
fn short(value: f64) -> String {
    in_digits(value, 4)
}

/// The obstacle of the candidate that came closest: only what was recorded can be told.
#[derive(Clone, Copy, Debug, Default)]
pub struct Closest(Option<Obstacle>);

impl Closest {
    /// Records an obstacle.
    pub fn record(&mut self, obstacle: Obstacle) {
        self.0 = Some(self.0.map_or(obstacle, |known| known.closer(obstacle)));
    }

    /// What was found, or else the obstacle; where none was recorded, nothing was tried, for want of a finite number to start from.
    ///
    /// # Errors
    /// The obstacle.
    pub fn or<T>(self, found: Option<T>) -> Result<T, Obstacle> {
        found.ok_or_else(|| self.0.unwrap_or(Failing::NotFinite(None).into()))
    }

    /// What was found at the least cost, of equal ones the first, or else the obstacle as in [`Closest::or`].
    ///
    /// # Errors
    /// The obstacle.
    pub fn least<T>(
        outcomes: impl IntoIterator<Item = Result<T, Obstacle>>,
        cost: impl Fn(&T) -> f64,
    ) -> Result<T, Obstacle> {
        let mut closest = Closest::default();
        let mut best: Option<T> = None;
        for outcome in outcomes {
            match outcome {
                Ok(found) if best.as_ref().is_none_or(|best| cost(&found) < cost(best)) => best = Some(found),
                Ok(_) => {}
                Err(obstacle) => closest.record(obstacle),
            }
        }
        closest.or(best)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_closest_one_is_told_and_no_start_value() {
        let mut closest = Closest::default();
        closest.record(Failing::NotFinite(Some(Bound::Qe)).at(3.0, 4.0));
        closest.record(Failing::NotFinite(Some(Bound::Fe)).at(1.0, 2.0));
        closest.record(Failing::NotFinite(Some(Bound::Qx)).at(5.0, 2.0));
        assert_eq!(closest.or(None::<()>), Err(Failing::NotFinite(Some(Bound::Fe)).at(1.0, 2.0)));
        closest.record(Failing::Curvature.at(7.0, 8.0));
        closest.record(Failing::Existence.at(0.1, 0.1));
        assert_eq!(closest.or(None::<()>), Err(Failing::Curvature.at(7.0, 8.0)));
        assert_eq!(closest.or(Some(1)), Ok(1));
        let told = closest.or(None::<()>).unwrap_err().describe();
        assert!(told.contains("a_2 <= 0") && told.contains("X = 7, E = 8"), "{told}");
    }

    /// Of a bound that is known up to some arguments it is not said that it is the one in the way, nor that it has no value beyond.
    #[test]
    fn what_is_not_known_further_is_not_called_infinite() {
        let bound = Bound::Qx;
        for known in [Known::Samples, Known::Proofs] {
            let told = Failing::Beyond { known, bound }.at(1.0, 2.0).describe();
            assert!(!told.contains("q_x") && !told.contains("finite") && told.contains("X = 1, E = 2"), "{told}");
        }
        let told = Failing::Unproved(bound).at(1.0, 2.0).describe();
        assert!(!told.contains("q_x") && told.contains("X = 1, E = 2"), "{told}");
        assert!(Failing::NotFinite(Some(bound)).at(1.0, 2.0).describe().contains("q_x has no finite value"));
    }
}
