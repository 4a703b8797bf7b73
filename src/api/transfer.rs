//! The transfer bound by itself.

use super::error::{Error, ErrorKind};
use super::specification::Specification;
use super::{positive, rounded_up};
use crate::data::Data;
use crate::enclosure::DEFAULT_PRECISION;
use crate::number::write_exact;
use crate::transfer::{rational_k0, smallest_k1};

/// A proved bound `T_N(x) <= k0 + k1 x^2` of the internal model, for every number of oscillators N >= 0 and every
/// `x = omega/w >= 0`.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct TransferBound {
    k0: String,
    k1: String,
    up: [f64; 2],
    excess: Option<f64>,
}

impl TransferBound {
    /// k0, exactly.
    #[must_use]
    pub fn k0(&self) -> &str {
        &self.k0
    }

    /// k1, exactly.
    #[must_use]
    pub fn k1(&self) -> &str {
        &self.k1
    }

    /// k0 as a double, rounded up: with it the bound holds too.
    #[must_use]
    pub fn k0_f64(&self) -> f64 {
        self.up[0]
    }

    /// k1 as a double, rounded up.
    #[must_use]
    pub fn k1_f64(&self) -> f64 {
        self.up[1]
    }

    /// By how much, relatively, k1 exceeds a proved lower bound of every k1 that would do with this k0; rounded up. `None`
    /// where no such bound is proved.
    #[must_use]
    pub fn excess(&self) -> Option<f64> {
        self.excess
    }
}

/// Proves the transfer bound of the internal model of a specification with nearly the smallest k1 for a given k0, an exact
/// positive constant. A k0 that is not rational is rounded up.
///
/// # Errors
/// What is wrong with k0; [`Refuted`](ErrorKind::Refuted) where k0 lies below T_N(0), which the message names;
/// [`Undecided`](ErrorKind::Undecided) where no proof was found within the effort.
///
/// ```no_run
/// # fn run(specification: &sigmastar::Specification) -> Result<(), sigmastar::Error> {
/// let bound = sigmastar::transfer_bound(specification, "20")?;
/// println!("T_N(x) <= {} + {} x^2", bound.k0(), bound.k1());
/// # Ok(())
/// # }
/// ```
pub fn transfer_bound(specification: &Specification, k0: &str) -> Result<TransferBound, Error> {
    let k0 = positive("k0", k0)?;
    let exact = rational_k0(&k0, DEFAULT_PRECISION);
    let exact = exact.ok_or_else(|| Error::new(ErrorKind::Overflow, "k0 is too large", "choose a smaller k0"))?;
    let data = Data::new(&specification.read, DEFAULT_PRECISION);
    let pair = smallest_k1(&data, &exact).map_err(|error| {
        let kind = if error.is_refuted() { ErrorKind::Refuted } else { ErrorKind::Undecided };
        Error::new(kind, error.to_string(), error.way_out())
    })?;
    let excess = pair.excess(&data).map(|excess| excess.upper_f64());
    let up = [rounded_up(&pair.k0), rounded_up(&pair.k1)];
    Ok(TransferBound { k0: write_exact(&pair.k0), k1: write_exact(&pair.k1), up, excess })
}
