//! Where the periodic solution is the only one in its set (derivation, 10.3): reported, required by nothing.

use super::contraction::ContractionMatrix;
use super::mean_squares::{ErrorGains, SetBounds};
use crate::data::{Bound, Problem};
use sigmastar_exact::real::{Operand, Real};

/// The contraction matrix of (C3) in mean squares: `[[A, B], [b_qx/sg, b_qe/sg]]` with `A = (c/alpha)(b_fex E_p + b_fxx X_p)`,
/// `B = (c/alpha) b_fe`, c and alpha those of the P for existence.
///
/// Guarantee: where its spectral radius is below 1, the map of the paper contracts the set of 10.3 in mean squares, so that
/// there is no other T-periodic solution in it.
#[must_use]
pub fn contraction<R: Real>(
    problem: &impl Problem<R>,
    bounds: &SetBounds<R>,
    gains: &ErrorGains<R>,
) -> ContractionMatrix<R>
where
    for<'a> &'a R: Operand<R>,
{
    let triple = &problem.numbers().existence;
    let f_xx = problem.bound(Bound::Fxx, &bounds.x_p, &problem.zero());
    let f_ex = problem.bound(Bound::Fex, &bounds.x_p, &bounds.e_p);
    let gain = &triple.c / &triple.alpha;
    ContractionMatrix {
        xx: &gain * (f_ex * &bounds.e_p + f_xx * &bounds.x_p),
        xe: gain * &bounds.f_e,
        ex: &gains.rms * &bounds.q_x,
        ee: &gains.rms * &bounds.q_e,
    }
}
