//! The size of the periodic solution under the law at samples (derivation, 12.2).

use super::gains::{SampledGains, SampledResponse};
use super::law::SampledLaw;
use crate::data::{Numbers, Problem};
use crate::derivation::harmonics::AtOrigin;
use crate::derivation::mean_squares::{Forcing, MeanSquares, SetBounds, sup_by_mean_squares};
use crate::real::{Operand, Real};

/// Bounds of the periodic solution, from mean squares that bound it.
#[derive(Clone, Debug)]
pub struct SampledSize<R> {
    /// R_q and R_1.
    pub forcing: Forcing<R>,
    /// e_per, of sup|e|, between samples too.
    pub e_per: R,
    /// x_per, of sup|x|.
    pub x_per: R,
}

impl<R: Real> SampledSize<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// `e_per = min{E_p, the left side of S2, sqrt(T r_e r_d)}`, `x_per = min{X_p, (c/a_1) b_fe e_per, K2(a_1) b_fe r_e}`.
    #[must_use]
    pub fn new(
        problem: &impl Problem<R>,
        bounds: &SetBounds<R>,
        origin: &AtOrigin<R>,
        gains: &SampledGains<R>,
        squares: &MeanSquares<R>,
    ) -> SampledSize<R> {
        let forcing = Forcing::new(bounds, origin, squares);
        let by_squares = sup_by_mean_squares(problem, squares);
        let e_per = bounds.e_p.min(&SampledResponse::new(gains, &forcing).sup).min(&by_squares);
        let x_per = bounds.x_per(&e_per, squares);
        SampledSize { forcing, e_per, x_per }
    }

    /// `Z^2 = (1+theta)^2 [ (T/(2 mu) + k0/w^2) R_q^2 + (k1/w^4) R_1^2 ]`, a bound of sup_k |zeta_k|_N^2.
    #[must_use]
    pub fn z_squared(&self, problem: &impl Problem<R>, law: &SampledLaw<R>, [k0, k1]: [&R; 2]) -> R {
        let Numbers { period, .. } = problem.numbers();
        let [kappa_0, kappa_1] = problem.numbers().kappas(k0, k1);
        let swing = period / (R::int(2) * &law.mu);
        law.enlarged.sqr() * ((swing + kappa_0) * self.forcing.q_rms.sqr() + kappa_1 * self.forcing.q_rate_rms.sqr())
    }
}
