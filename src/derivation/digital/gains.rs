//! What the law at samples makes of a periodic q, for every n_o < N_s/2 (derivation, 12.1).

use super::law::SampledLaw;
use crate::derivation::mean_squares::Forcing;
use crate::real::{Operand, Real};

/// The gains at one sigma, between bounds R_q of rms(q), R_1 of rms(q') and those of e.
#[derive(Clone, Debug)]
pub struct SampledGains<R> {
    /// bt_S: sup|e_k| <= bt_S rms(q).
    pub sup: R,
    /// tau_S: sup|e_k| <= tau_S rms(q').
    pub sup_by_rate: R,
    /// 1/sg_S: the rms of the e_k over rms(q), and that of (e_{k+1} - e_k)/h over rms(q').
    pub rms: R,
    /// 1/(om_1 sg_S): the rms of the e_k over rms(q').
    pub rms_by_rate: R,
    /// 2 (1 + theta)/(2 - h sigma): rms(e') over rms(q).
    pub rate: R,
    /// sqrt(1/sg_S^2 + (h/pi)^2): rms(e') over rms(q').
    pub rate_by_rate: R,
    /// (h/(2 pi)) sqrt(h T): what e is off its straight lines between samples, over rms(q').
    pub between: R,
    /// (h/pi)^2: the same in the mean.
    pub between_rms: R,
}

impl<R: Real> SampledGains<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// Evaluates the gains. Hypotheses: K h Nb2 < 2, h sigma <= 1.
    ///
    /// With Sb_j = min{1 + theta, 1/|cos(pi j/N_s)|} the harmonics of y are at most Sb_j times those of the means of q, and 0
    /// for j <= n_o; the sums are over j = 1, ..., N_s - 1, of which j and N_s - j are alike.
    #[must_use]
    pub fn new(law: &SampledLaw<R>, sigma: &R, period: &R) -> SampledGains<R> {
        let one = R::int(1);
        let product = &law.step * sigma;
        let decay = &one - &product;
        let share = |sine: &R| sigma.sqr() + &decay * law.frequency_squared(sine);
        let largest = law.enlarged.sqr();
        let nothing = &largest * R::int(0);
        let (mut sup, mut sup_by_rate) = (nothing.clone(), nothing);
        for (j, sine) in (1_u32..).zip(law.sines.iter()) {
            let cosine = &one - sine;
            let gain = if cosine.is_certainly_positive() { largest.min(&(&one / cosine)) } else { largest.clone() };
            let times = if 2 * j == law.samples { one.clone() } else { R::int(2) };
            let term = times * gain / share(sine);
            sup_by_rate = sup_by_rate + &term / law.frequency_squared(sine);
            sup = sup + term;
        }
        let first = law.first_frequency_squared();
        let rms = &one / slowest(law, sigma, &decay);
        let in_between = &law.step / &law.pi;
        SampledGains {
            sup: sup.sqrt(),
            sup_by_rate: sup_by_rate.sqrt(),
            rms_by_rate: &rms / first.sqrt(),
            rate: R::int(2) * &law.enlarged / (R::int(2) - product),
            rate_by_rate: (rms.sqr() + in_between.sqr()).sqrt(),
            rms,
            between: &in_between / R::int(2) * (&law.step * period).sqrt(),
            between_rms: in_between.sqr(),
        }
    }
}

/// sg_S = max{ sg_h/(1+theta), min{ cos(pi/N_s) sg_h, sqrt(sigma^2 + 4 a s*/h^2)/(1+theta) } }, s* = 1 - (1+theta)^-2: at most
/// every sqrt(sigma^2 + a om_j^2)/Sb_j.
fn slowest<R: Real>(law: &SampledLaw<R>, sigma: &R, decay: &R) -> R
where
    for<'a> &'a R: Operand<R>,
{
    let one = R::int(1);
    let first = sigma.sqr() + decay * law.first_frequency_squared();
    let squared = law.enlarged.sqr();
    let turn = &one - &one / &squared;
    let cosine = law.sines.first().map_or_else(R::unknown, |sine| &one - sine);
    let at_turn = (sigma.sqr() + decay * law.frequency_squared(&turn)) / &squared;
    (&first / &squared).max(&(cosine * &first).min(&at_turn)).sqrt()
}

/// The right sides of (S2) for the law at samples.
#[derive(Clone, Debug)]
pub struct SampledResponse<R> {
    /// Of sup|e|, without `sqrt(T r_e r_d)`.
    pub sup: R,
    /// Of rms(e).
    pub rms: R,
    /// Of rms(e').
    pub rate_rms: R,
}

impl<R: Real> SampledResponse<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// `min{bt_S R_q, tau_S R_1} + (h/(2 pi)) sqrt(h T) R_1`, `min{R_q, R_1/om_1}/sg_S + (h/pi)^2 R_1`,
    /// `min{2 (1+theta)/(2 - h sigma) R_q, sqrt(1/sg_S^2 + (h/pi)^2) R_1}`.
    #[must_use]
    pub fn new(gains: &SampledGains<R>, forcing: &Forcing<R>) -> SampledResponse<R> {
        let Forcing { q_rms, q_rate_rms, .. } = forcing;
        let least = |by_size: &R, by_rate: &R| (by_size * q_rms).min_known(&(by_rate * q_rate_rms));
        SampledResponse {
            sup: least(&gains.sup, &gains.sup_by_rate) + &gains.between * q_rate_rms,
            rms: least(&gains.rms, &gains.rms_by_rate) + &gains.between_rms * q_rate_rms,
            rate_rms: least(&gains.rate, &gains.rate_by_rate),
        }
    }
}
