//! Newton's method for a periodic solution: damped, with derivatives that are used again while they help.

use super::integration::IntegrationFailure;
use nalgebra::{DMatrix, DVector, Dyn, LU};
use thiserror::Error;

/// Derivatives that Newton's method takes in one try, and steps.
const MAX_DERIVATIVES: usize = 12;
const MAX_STEPS: usize = 60;

/// A step that leaves at most this share of the residual was worth it: the next one uses the same derivative.
const ENOUGH: f64 = 0.1;

/// The shares of a step that are tried in turn: the first after which a period can be integrated and the residual is smaller.
const SHARES: [f64; 9] =
    [1.0, 1.0 / 4.0, 1.0 / 16.0, 1.0 / 64.0, 1.0 / 256.0, 1.0 / 1024.0, 1.0 / 4096.0, 1.0 / 16_384.0, 1.0 / 65_536.0];

/// Relative to 1 + max|y|, the derivatives at two points this close to each other have the same multipliers, to the digits
/// that are shown.
const CLOSE_BY: f64 = 1e-9;

/// A residual at which Newton's method has nothing left to do, relative to 1 + max|y|. It is below rounding: as the
/// slowest multiplier comes close to 1 the residual understates the error, so steps go on while they help.
const CONVERGED: f64 = 1e-16;

/// A residual that is accepted where rounding allows no smaller one.
pub(super) const ACCEPTED: f64 = 1e-11;

/// Why Newton's method arrived nowhere; it says nothing about the solution from where it started.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum NewtonFailure {
    /// An integration over a period from one of its points did not come to its end.
    #[error("came to a state from which no period can be integrated: {0}")]
    Integration(#[from] IntegrationFailure),
    /// It did not converge.
    #[error("did not converge; its smallest residual is {residual:.3e}")]
    NoConvergence {
        /// The smallest residual.
        residual: f64,
    },
}

impl NewtonFailure {
    pub(super) fn is_too_much_work(&self) -> bool {
        matches!(self, NewtonFailure::Integration(IntegrationFailure::TooMuchWork { .. }))
    }
}

/// What Newton's method arrived at.
pub(super) struct Shot {
    pub(super) start: Vec<f64>,
    pub(super) residual: f64,
    pub(super) monodromy: DMatrix<f64>,
}

/// A point, y(T) - y(0) from there, and its largest component.
struct Point {
    y: DVector<f64>,
    defect: DVector<f64>,
    residual: f64,
}

impl Point {
    fn new(
        y: DVector<f64>,
        end: &mut impl FnMut(&[f64]) -> Result<Vec<f64>, IntegrationFailure>,
    ) -> Result<Point, IntegrationFailure> {
        let defect = DVector::from_vec(end(y.as_slice())?) - &y;
        let residual = defect.amax();
        Ok(Point { y, defect, residual })
    }

    fn scale(&self) -> f64 {
        1.0 + self.y.amax()
    }

    fn is_accepted(&self) -> bool {
        self.residual <= ACCEPTED * self.scale()
    }

    /// The point after the first of some shares of a step that leaves a smaller residual.
    fn after(
        &self,
        step: &DVector<f64>,
        shares: &[f64],
        end: &mut impl FnMut(&[f64]) -> Result<Vec<f64>, IntegrationFailure>,
    ) -> Result<After, IntegrationFailure> {
        let mut whole = None;
        for share in shares {
            let y = &self.y + step * *share;
            if !y.iter().all(|value| value.is_finite()) {
                continue;
            }
            match Point::new(y, end) {
                Ok(point) if point.residual < self.residual => return Ok(After::Smaller(point)),
                Err(failure @ IntegrationFailure::TooMuchWork { .. }) => return Err(failure),
                outcome => whole = whole.or(Some(outcome)),
            }
            // Once rounding is all that is left, further points only move about.
            if self.is_accepted() {
                break;
            }
        }
        Ok(After::NotSmaller(whole))
    }
}

/// What a step leads to.
enum After {
    /// A point with a smaller residual.
    Smaller(Point),
    /// None; and what the largest share of it that is finite leads to.
    NotSmaller(Option<Result<Point, IntegrationFailure>>),
}

/// Newton's method for y(T; y0) - y0 = 0, with `end` for y(T; y0) and `derivative` for dy(T)/dy0.
///
/// The derivative costs as much as all flows together, so a step uses the last one again while that helps
/// ([`ENOUGH`]); the one at the solution gives the multipliers.
pub(super) fn shoot(
    guess: &[f64],
    mut end: impl FnMut(&[f64]) -> Result<Vec<f64>, IntegrationFailure>,
    mut derivative: impl FnMut(&[f64]) -> Result<DMatrix<f64>, IntegrationFailure>,
) -> Result<Shot, NewtonFailure> {
    let mut at = Point::new(DVector::from_column_slice(guess), &mut end)?;
    let mut best = (at.residual, at.y.clone());
    let mut known: Option<Known> = None;
    let (mut derivatives, mut helped) = (0, false);
    for _ in 0..MAX_STEPS {
        if at.residual <= CONVERGED * at.scale() {
            break;
        }
        let near = known.as_ref().is_some_and(|known| known.is_near(&at.y));
        let again = helped || (at.is_accepted() && near);
        if !again || known.is_none() {
            if derivatives == MAX_DERIVATIVES {
                break;
            }
            derivatives += 1;
            known = Some(Known::new(&at.y, derivative(at.y.as_slice())?));
        }
        let Some(step) = known.as_ref().and_then(|known| known.factors.solve(&at.defect)) else { break };
        let next = match at.after(&step, if again { &SHARES[..1] } else { &SHARES }, &mut end)? {
            After::Smaller(next) => next,
            After::NotSmaller(_) if at.is_accepted() => break,
            // A derivative from here may do better.
            After::NotSmaller(_) if again => {
                helped = false;
                continue;
            }
            // The residual may have to grow before it falls.
            After::NotSmaller(Some(Ok(next))) => next,
            After::NotSmaller(Some(Err(failure))) => return Err(failure.into()),
            After::NotSmaller(None) => break,
        };
        helped = next.residual <= ENOUGH * at.residual;
        at = next;
        if at.residual < best.0 {
            best = (at.residual, at.y.clone());
        }
    }
    let (residual, y) = best;
    if residual.is_nan() || residual > ACCEPTED * (1.0 + y.amax()) {
        return Err(NewtonFailure::NoConvergence { residual });
    }
    // A derivative from close by is the one here.
    let monodromy = match known.filter(|known| known.is_near(&y)) {
        Some(known) => known.monodromy,
        None => derivative(y.as_slice())?,
    };
    Ok(Shot { start: y.as_slice().to_vec(), residual, monodromy })
}

/// A derivative that was computed, and where.
struct Known {
    at: DVector<f64>,
    monodromy: DMatrix<f64>,
    /// Of I - monodromy.
    factors: LU<f64, Dyn, Dyn>,
}

impl Known {
    fn new(at: &DVector<f64>, monodromy: DMatrix<f64>) -> Known {
        let d = monodromy.nrows();
        Known { at: at.clone(), factors: (DMatrix::identity(d, d) - &monodromy).lu(), monodromy }
    }

    fn is_near(&self, y: &DVector<f64>) -> bool {
        (&self.at - y).amax() <= CLOSE_BY * (1.0 + y.amax())
    }
}
