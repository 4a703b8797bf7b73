//! Why no orbit was found, and what to try.

use sigmastar_exact::number::in_digits;
use sigmastar_theory::Undefined;
use sigmastar_theory::evidence::MAX_STATES;
use thiserror::Error;

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

/// A number of a message, in few digits.
fn short(value: f64) -> String {
    in_digits(value, 4)
}
