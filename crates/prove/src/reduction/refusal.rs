//! What keeps a plant from being certified, as errors at their places in its file.

use super::shrunk::INITIAL_SET;
use sigmastar_decide::bounds::SmoothnessFailure;
use sigmastar_decide::orbit::OrbitNotProved;
use sigmastar_exact::number::in_digits;
use sigmastar_lang::plant::{PeriodicityFailure, Plant};
use sigmastar_lang::spec::{ErrorKind, InitialSet, SpecErrors};
use sigmastar_propose::orbit::OrbitFailure;
use sigmastar_propose::search::{Failing, Obstacle};
use sigmastar_theory::data::Bound;
use std::ops::Range;

/// Why a plant comes to no run.
#[derive(Clone, Debug)]
pub enum PlantRefusal {
    /// A right side that is not proved to have the period: bad input, as it is written.
    NotPeriodic(PeriodicityFailure),
    /// An operation of a right side that is not proved to be smooth where it is used.
    NotSmooth {
        /// The index of the right side: a state, or the number of states for q.
        index: usize,
        /// The bytes of the operation in its text.
        span: Range<usize>,
        /// In words.
        message: String,
        /// What to do.
        help: String,
    },
    /// More states than are taken.
    TooManyStates {
        /// How many there are.
        states: usize,
    },
    /// No orbit was found, or an unstable one.
    NoOrbit(OrbitFailure),
    /// The orbit, or q along it, is not proved.
    OrbitNotProved(OrbitNotProved),
    /// No coordinates in which the zero dynamics contract.
    NoContraction,
    /// No gain was found in floating point.
    NoGain(Obstacle),
    /// What keeps the witness of another plant from being one of this plant.
    OfAnother(Box<PlantRefusal>),
    /// A bound is not proved, at an argument that is needed.
    NotProved {
        /// Its name.
        bound: &'static str,
        /// X and E.
        at: [f64; 2],
    },
    /// A ball or a domain that L cannot be compared with.
    Coordinates,
    /// Cells of a certificate that are too many, or do not cover the box of the parameters.
    Uncovered {
        /// How many there are.
        cells: usize,
    },
    /// Harmonics of q whose size leaves the exponents of the arithmetic.
    Forcing,
}

impl From<SmoothnessFailure> for PlantRefusal {
    fn from(failure: SmoothnessFailure) -> PlantRefusal {
        let message = failure.to_string();
        let help = failure.advice();
        PlantRefusal::NotSmooth { index: failure.index, span: failure.span, message, help }
    }
}

/// The most states of a plant that is to be certified.
pub const MAX_STATES: usize = 6;

impl PlantRefusal {
    /// Whether a narrower tube around the orbit may help.
    pub(super) fn may_be_of_tube(&self) -> bool {
        use PlantRefusal::{NoGain, NotProved, NotSmooth, OrbitNotProved};
        matches!(self, NoGain(_) | NotProved { .. } | NotSmooth { .. } | OrbitNotProved(_))
    }

    /// The errors at their places in the plant file; not empty.
    #[must_use]
    pub fn errors(&self, plant: &Plant) -> Vec<SpecErrors> {
        let states = plant.states();
        let field = |index: usize| if index < states { format!("/f/{index}") } else { "/q".to_owned() };
        let undecided = |place: &str, message: String, help: Option<&str>| {
            vec![plant.errors_at(place, &(0..0), ErrorKind::Undecided, message, help.map(str::to_owned))]
        };
        let at = |place: &str, span: &Range<usize>, message: String, help: Option<String>| {
            vec![plant.errors_at(place, span, ErrorKind::Undecided, message, help)]
        };
        match self {
            PlantRefusal::NotPeriodic(failure) => {
                let help = "write the disturbance with sin(2*pi*k*t/period), cos(...) and the like, k whole";
                let message = format!("the period is not proved: {failure}");
                vec![plant.errors_at(
                    &field(failure.index),
                    &failure.span,
                    ErrorKind::Range,
                    message,
                    Some(help.into()),
                )]
            }
            PlantRefusal::NotSmooth { index, span, message, help } => {
                at(&field(*index), span, message.clone(), Some(help.clone()))
            }
            PlantRefusal::TooManyStates { states } => {
                let message = format!("{states} states; a plant of at most {MAX_STATES} is certified");
                let help = "leave out states that do not act on e, or give a bounding specification";
                vec![plant.errors_at("/states", &(0..0), ErrorKind::Range, message, Some(help.into()))]
            }
            PlantRefusal::NoOrbit(failure @ OrbitFailure::AddsUp { largest, .. }) => {
                undecided(&field(*largest), failure.to_string(), failure.way_out().as_deref())
            }
            PlantRefusal::NoOrbit(failure @ OrbitFailure::Undefined(cause)) => {
                at(&field(cause.index), &cause.span, failure.to_string(), failure.way_out())
            }
            PlantRefusal::NoOrbit(failure) => undecided("/f", failure.to_string(), failure.way_out().as_deref()),
            PlantRefusal::OrbitNotProved(failure @ OrbitNotProved::NotSmooth { cause: Some(cause), .. }) => {
                at(&field(cause.index), &cause.span, failure.to_string(), Some(failure.way_out()))
            }
            PlantRefusal::OrbitNotProved(failure) if plant.is_family() => undecided(
                "/parameters",
                format!("x_0(t) is not proved for every value of the parameters: {failure}"),
                Some(
                    "narrower intervals: in each of at most 64 cells of their box one orbit that is affine in the parameters has to serve all \
                     of them",
                ),
            ),
            PlantRefusal::OrbitNotProved(failure) => undecided("/f", failure.to_string(), Some(&failure.way_out())),
            PlantRefusal::NoContraction => undecided(
                "/f",
                "no matrix P was found in which the zero dynamics x' = f(t,x,0) contract along their periodic solution"
                    .to_owned(),
                Some(
                    "they have to be stable with a margin: close a loop around them first, or choose another output e",
                ),
            ),
            PlantRefusal::NoGain(obstacle) if is_of_set(obstacle) => {
                undecided(place_of_set(plant), no_gain(obstacle), Some(help_of_set(plant, obstacle)))
            }
            PlantRefusal::NoGain(obstacle) => undecided("", no_gain(obstacle), Some(help(obstacle))),
            PlantRefusal::OfAnother(refusal) => {
                let all = refusal.errors(plant);
                let told: Vec<&str> =
                    all.iter().flat_map(|errors| errors.errors()).map(|error| error.message.as_str()).collect();
                let message = format!(
                    "the certificate was made for another plant, and what it says is not proved of this one: {}",
                    told.join("; ")
                );
                undecided(
                    "",
                    message,
                    Some(
                        "give the plant that the certificate is of, or search for a witness of this one (without --witness)",
                    ),
                )
            }
            PlantRefusal::NotProved { bound, at: [x, e] } => undecided(
                place_of_set(plant),
                format!("the bound `{bound}` is not proved for |y| <= {x:.6}, |e| <= {e:.6} within the effort"),
                Some("a smaller initial set, or a smoother plant"),
            ),
            PlantRefusal::Uncovered { cells } => undecided(
                "/parameters",
                format!("the {cells} cells of the certificate do not cover the intervals, or are more than 64"),
                Some("search for a witness of this plant (without --witness)"),
            ),
            PlantRefusal::Forcing => undecided(
                "/q",
                "the harmonics of q(t,x_0,0) are too large or too small to be enclosed".to_owned(),
                Some("write the plant in units in which its numbers are of ordinary size"),
            ),
            PlantRefusal::Coordinates => undecided(
                "/initial_set",
                "the coordinates are too ill-conditioned to turn this ball or domain into their norm".to_owned(),
                Some("write the states in units in which they are of one size"),
            ),
        }
    }
}

fn no_gain(obstacle: &Obstacle) -> String {
    let what = match obstacle.failing {
        Failing::Gain { given, .. } | Failing::Hold { sigma: given, given: true, .. } => {
            format!("the gain {} could not be proved for this set", in_digits(given, 4))
        }
        _ => "no proof was found for this initial set".to_owned(),
    };
    format!("{what}. {}", obstacle.describe())
}

/// Whether a smaller initial set may be all that it takes.
fn is_of_set(obstacle: &Obstacle) -> bool {
    use Failing::{Beyond, Bounds, Coupling, Curvature, DomainE, DomainX, NotFinite, Unproved};
    let failing = obstacle.failing;
    matches!(
        failing,
        NotFinite(Some(_)) | DomainX | DomainE | Curvature | Coupling | Bounds | Unproved(_) | Beyond { .. }
    )
}

/// The initial set, where the plant states one.
fn place_of_set(plant: &Plant) -> &'static str {
    if plant.document.get("initial_set").is_some() { INITIAL_SET } else { "" }
}

/// What helps against such an obstacle: a smaller set, or where its sizes are left open, which makes it the smallest, something else.
fn help_of_set(plant: &Plant, obstacle: &Obstacle) -> &'static str {
    match &plant.initial_set {
        InitialSet::AtRest { x0: None, e0: None } | InitialSet::Aligned { x0: None, e0: None } => {
            match obstacle.failing {
                Failing::DomainX | Failing::DomainE => {
                    "a larger `domain`: the initial set is the smallest of its kind already"
                }
                _ => {
                    "the initial set is the smallest of its kind already, since its sizes are left open: the kind `aligned` asks for less than \
                 `at-rest`, and so do a smaller load, a larger rate of the zero dynamics and less coupling between e and x"
                }
            }
        }
        _ => help(obstacle),
    }
}

/// What helps where no gain was found, for the very reason.
fn help(obstacle: &Obstacle) -> &'static str {
    match obstacle.failing {
        Failing::Magnitude(_) | Failing::NotFinite(None) => {
            "write the plant in units in which its numbers are of ordinary size"
        }
        Failing::NotFinite(Some(_)) => {
            "a smaller initial set (`at-rest` without sizes is the smallest): around this one the error box reaches where a \
             right side has no finite derivative"
        }
        Failing::Beyond { .. } => {
            "another gain, units in which x, e and q are of one size, or less coupling between e and x; of a plant whose derivatives vary a smaller \
             initial set"
        }
        Failing::Existence => {
            "a larger rate of the zero dynamics, less coupling between e and x, or units in which the numbers are of one size"
        }
        Failing::DomainX | Failing::DomainE => {
            "a larger `domain`, or a smaller initial set (`at-rest` without sizes is the smallest)"
        }
        Failing::Curvature | Failing::Unproved(Bound::Rate) => {
            "a smaller initial set (`at-rest` without sizes is the smallest): on the error box around this one the zero \
             dynamics do not contract"
        }
        Failing::Coupling => {
            "a smaller initial set (`at-rest` without sizes is the smallest), or less coupling between e and x"
        }
        Failing::Gain { .. } => "a larger gain, or none: the smallest one is then sought",
        Failing::Limit { .. } => "a larger limit",
        Failing::NotDecidedAgain { .. } => {
            "a smaller initial set, or narrower intervals where there are some, of which fewer boxes are to be decided"
        }
        Failing::Start { .. } => "a smaller `E0`, or a limit above it",
        Failing::Rate { .. } => "a smaller rate, or fewer oscillators",
        Failing::InputGain { .. } => "a narrower `input_gain`",
        Failing::Delay { .. } => "a shorter sampling period, or a smaller mu",
        Failing::Hold { given: true, .. } => "a smaller gain, or a shorter sampling period",
        Failing::Hold { given: false, .. } | Failing::Samples => "a shorter sampling period, or a smaller gain",
        Failing::Sampling => "a shorter sampling period, a smaller mu, or another gain",
        Failing::Bounds | Failing::Unproved(_) => "a smaller initial set, or a smoother plant",
    }
}
