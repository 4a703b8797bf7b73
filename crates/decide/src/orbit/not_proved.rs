//! Why an orbit is not proved, and what to try.

use sigmastar_exact::number::in_digits;
use sigmastar_theory::Undefined;
use thiserror::Error;

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

/// A number of a message, in few digits.
fn short(value: f64) -> String {
    in_digits(value, 4)
}
