//! Why there is no proved orbit, and what to try.

use super::undefined::Undefined;
use super::words::short;
use thiserror::Error;

/// The most states of a plant whose orbit is sought, as for a Jacobian of a specification: semidefinite programs and proofs of
/// a rate grow with a high power of their number.
pub const MAX_STATES: usize = 12;

/// Why no orbit was found, in floating point.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum OrbitFailure {
    /// Newton's method found no periodic solution.
    #[error(
        "no T-periodic solution of x' = f(t,x,0) was found: Newton's method with {harmonics} harmonics stopped at a residual \
         of {} of the right side",
        short(*residual)
    )]
    NotFound {
        /// The largest residual at the points of the collocation, relative to the size of the terms.
        residual: f64,
        /// The number of harmonics of that try.
        harmonics: usize,
    },
    /// A periodic solution that does not attract its neighbours.
    #[error(
        "the T-periodic solution of x' = f(t,x,0) that was found has the Floquet exponents {} (floating point): the real part \
         of the first is not negative. The rate of any P(t) along the orbit is at most minus that real part, so there is no \
         certificate of this kind for this plant",
        listed(floquet)
    )]
    NotStable {
        /// The exponents (real, imaginary) in 1/time, the largest real part first.
        floquet: Vec<[f64; 2]>,
    },
    /// A combination of the states on which no state acts.
    #[error(
        "no T-periodic solution of x' = f(t,x,0) attracts its neighbours: no state acts on {sum}, which only adds up its right side{} (floating \
         point)",
        mean.map_or_else(String::new, |mean| format!(", and the mean of that over a period is {}, not 0, so that it grows for ever", short(mean)))
    )]
    AddsUp {
        /// The combination, in words.
        sum: String,
        /// The state with the largest part in it.
        largest: usize,
        /// The mean of its right side over a period, where it is not 0.
        mean: Option<f64>,
    },
    /// Too many states.
    #[error("{states} states; the orbit of at most {MAX_STATES} is sought")]
    TooLarge {
        /// How many there are.
        states: usize,
    },
    /// An operation of f has no value at an instant, whatever the states are: no solution goes through it.
    #[error("no T-periodic solution of x' = f(t,x,0) was found, and none is there as f is written: {0}")]
    Undefined(Box<Undefined>),
    /// The right sides have no values where the search starts.
    #[error(
        "no T-periodic solution of x' = f(t,x,0) was found: the right sides, or their derivatives, are not finite at x = 0, \
         where the search starts, and from other states{} it comes to none{}",
        if *stated { ", those of `initial` among them," } else { "" },
        cause.as_ref().map_or_else(String::new, |cause| format!("; {cause}"))
    )]
    Singular {
        /// Whether the file has an `initial`.
        stated: bool,
        /// What has no value at the state of `initial`, where that is known.
        cause: Option<Box<Undefined>>,
    },
    /// Numbers out of range.
    #[error("the right sides, or their derivatives, are not finite along x_0(t) in floating point")]
    NotFinite,
}

impl OrbitFailure {
    /// What to try, where that is known.
    #[must_use]
    pub fn way_out(&self) -> Option<String> {
        let known = match self {
            OrbitFailure::Undefined(cause) => return Some(cause.advice()),
            OrbitFailure::Singular { stated: true, cause: Some(cause) } => {
                return Some(format!(
                    "state another `initial`, nearer to the periodic solution; or {}",
                    cause.advice()
                ));
            }
            OrbitFailure::NotFound { .. } => Some(
                "look with `simulate` whether x' = f(t,x,0) has a T-periodic response, and state the period of all right \
                 sides together",
            ),
            OrbitFailure::NotStable { .. } => Some(
                "the zero dynamics have to be stable: close a loop around them first, or choose another output e; where they \
                 have another periodic solution, which is stable, state an `initial` of the plant file that is near it",
            ),
            OrbitFailure::AddsUp { mean: None, .. } => Some(
                "no other orbit is stable either: give it a term that pulls it back, close a loop around it first, or leave out a state that \
                 neither q nor another state needs; where it is what is to be regulated, and e its rate, state the plant with another e (the \
                 user guide, `Relative degree above 1`)",
            ),
            OrbitFailure::AddsUp { mean: Some(_), .. } => Some(
                "a load that acts where u does stands in q, where the regulator takes up its mean; else give what adds up a term that pulls it \
                 back, or leave out a state that neither q nor another state needs",
            ),
            OrbitFailure::Singular { stated: true, .. } => {
                Some("state another `initial`, nearer to the periodic solution")
            }
            OrbitFailure::Singular { .. } => {
                Some("state an `initial` of the plant file that is near the periodic solution")
            }
            OrbitFailure::TooLarge { .. } => None,
            OrbitFailure::NotFinite => Some("write the plant in units in which its numbers are of ordinary size"),
        };
        known.map(str::to_owned)
    }
}

/// Why an orbit is not proved; nothing is said about its truth.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum OrbitNotProved {
    /// Matrices or vectors of another order, numbers that are not positive, a singular L.
    #[error("the orbit, L and P do not fit the plant: {0}")]
    Shape(&'static str),
    /// The defect could not be enclosed.
    #[error(
        "{}",
        cause.as_ref().map_or_else(
            || {
                format!(
                    "f(t,xb,0) or q(t,xb,0) cannot be expanded in t near t/T = {s}: an operation there may be undefined or have a corner"
                )
            },
            |cause| format!("f or q has no value along the orbit x_0(t) that was found: {cause}")
        )
    )]
    NotSmooth {
        /// Where, in periods.
        s: f64,
        /// An operation that has no value there, where doubles find one.
        cause: Option<Box<Undefined>>,
    },
    /// The defect is small at sampled times, and between them f changes too fast for what is proved of it.
    #[error(
        "f(t,xb,0) changes so fast near t/T = {} that {cells} steps of a period do not resolve it: at sampled times the orbit that was found has the \
         defect {}, and what is proved of it between them is {}",
        short(*s),
        short(*sampled),
        short(*proved)
    )]
    NotResolved {
        /// Where, in periods.
        s: f64,
        /// The steps.
        cells: usize,
        /// The defect at sampled times.
        sampled: f64,
        /// The bound of it.
        proved: f64,
    },
    /// `(c/alpha) eps <= r < rho` fails for every tube that was tried.
    #[error("the defect {} is too large for every tube in which the contraction is proved: r would be {}", short(*defect), short(*radius))]
    DefectTooLarge {
        /// eps.
        defect: f64,
        /// The least radius that it allows.
        radius: f64,
    },
    /// The bound of the defect is larger than the stated one.
    #[error("|L^-1 (f(t,xb,0) - xb')| <= {} is not proved; what is proved is {}", short(*stated), short(*found))]
    Defect {
        /// The bound that was found.
        found: f64,
        /// eps.
        stated: f64,
    },
    /// A bound of what the harmonics leave is larger than the stated one.
    #[error("|q(t,x_0,0) - qb|, or its derivative, is not proved to be at most {}; what is proved is {}", short(*stated), short(*found))]
    Rest {
        /// The bound that was found.
        found: f64,
        /// r_0 or r_1.
        stated: f64,
    },
    /// The rate is not proved.
    #[error("the rate {} is not proved in the tube |v| <= {}: {reason}", short(*alpha), short(*tube))]
    Rate {
        /// alpha.
        alpha: f64,
        /// The tube.
        tube: f64,
        /// In words.
        reason: String,
    },
    /// P is not proved to be positive definite and bounded.
    #[error("p_low I <= P(t) <= p_up I is not proved: {0}")]
    Bounds(String),
}

impl OrbitNotProved {
    /// What to try.
    #[must_use]
    pub fn way_out(&self) -> String {
        let advice = match self {
            OrbitNotProved::NotSmooth { cause: Some(cause), .. } => return cause.advice(),
            OrbitNotProved::NotResolved { .. } => {
                "the periodic solution may well exist; other units change nothing. A corner of a right side that is hardly rounded, or a switch, has \
                 to be wider for this proof (and is another model then)"
            }
            OrbitNotProved::DefectTooLarge { .. } => {
                "right sides that are smoother in t along the orbit, or a larger rate of the zero dynamics: the radius is the defect over that rate"
            }
            _ => "write the plant in units in which its numbers are of ordinary size",
        };
        advice.to_owned()
    }
}
fn listed(exponents: &[[f64; 2]]) -> String {
    let one = |[real, imaginary]: &[f64; 2]| {
        let sign = if *imaginary < 0.0 { '-' } else { '+' };
        match *imaginary == 0.0 {
            true => short(*real),
            false => format!("{} {sign} {}i", short(*real), short(imaginary.abs())),
        }
    };
    exponents.iter().map(one).collect::<Vec<_>>().join(", ")
}
