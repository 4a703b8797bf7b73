//! Bounds of a periodic solution of the regulator at samples by a matrix inequality over the derivatives of a plant (derivation,
//! section 13.7, (E) at samples).

use super::gains::SampledGains;
use super::witness::SampledWitness;
use crate::data::Data;
use crate::derivation::condition::{Condition, Relation};
use crate::derivation::energy::{EnergyBounds, within};
use crate::derivation::harmonics::AtOrigin;
use crate::derivation::mean_squares::{Forcing, Gains, MeanSquares, SetBounds, sup_by_mean_squares};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::real::{Operand, Real};
use sigmastar_lang::spec::SampledExistence;

/// The numbers of such an inequality that bounds are made of.
#[derive(Clone, Copy, Debug)]
pub struct SampledEnergyNumbers<R> {
    /// c_x.
    pub c_x: R,
    /// c_e.
    pub c_e: R,
    /// c_y.
    pub c_y: R,
    /// gamma.
    pub gamma: R,
}

impl<R: Real> SampledEnergyNumbers<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// `sqrt(gamma/c) Q_m` of rms(x), of rms(e) and of the mean square of y over the samples; unknown where no harmonics of q(t,0,0)
    /// are known.
    ///
    /// Guarantee, where the inequality holds on `|x| <= X`, `|e| <= E`: they are true of every T-periodic solution in there of the loop at
    /// samples with l q(t,0,0), 0 <= l <= 1, in the place of q(t,0,0), for every n_o < N_s/2. For over a period
    /// `U = x'P x + e^2 + (k_p K/2) |zeta|_N^2` comes back, y has the sum 0, so that the mean of q(t,0,0) does not count, and over each
    /// sample -U falls by no less than the mean of F.
    #[must_use]
    pub fn bounds(&self, origin: &AtOrigin<R>) -> EnergyBounds<R> {
        let SampledEnergyNumbers { c_x, c_e, c_y, gamma } = self;
        let moved = origin.known.as_ref().map_or_else(R::unknown, |known| known.rms_without_mean.clone());
        let of = |weight: &R| &moved * (gamma / weight).sqrt();
        EnergyBounds { y: of(c_y), e: of(c_e), x: of(c_x) }
    }
}

/// The inequality that is proved for the gain and the law of a witness, if there is one.
fn known<'d>(data: &'d Data<'_>, witness: &SampledWitness) -> Option<&'d SampledExistence> {
    let known = data.spec.bounds.proved_values().at_samples.existence.as_ref();
    known.filter(|known| known.at == witness.about())
}

/// Its bounds.
#[must_use]
pub fn proved(
    data: &Data<'_>,
    origin: &AtOrigin<Enclosure>,
    witness: &SampledWitness,
) -> Option<EnergyBounds<Enclosure>> {
    known(data, witness).map(|known| bounds_of(data, origin, known))
}

/// The bounds of an inequality.
#[must_use]
pub fn bounds_of(data: &Data<'_>, origin: &AtOrigin<Enclosure>, known: &SampledExistence) -> EnergyBounds<Enclosure> {
    let SampledExistence { c_x, c_e, c_y, gamma, .. } = known;
    let [c_x, c_e, c_y, gamma] = [c_x, c_e, c_y, gamma].map(|number| data.rational(number));
    SampledEnergyNumbers { c_x, c_e, c_y, gamma }.bounds(origin)
}

/// What is left to decide of it: that (X_p, E_p) lies where it holds.
#[must_use]
pub fn conditions(data: &Data<'_>, witness: &SampledWitness) -> Vec<Condition> {
    let Some(SampledExistence { x, e, .. }) = known(data, witness) else { return Vec::new() };
    within(data, [&witness.x_p, &witness.e_p], [x, e]).into()
}

/// (S1) and (S2) with it, strictly.
///
/// All that bounds a periodic solution bounds those with l q(t,0,0) in the place of q(t,0,0), 0 < l <= 1, as long as no bound of q
/// as a whole is used. Where each of them is strictly inside of the sizes X_p, E_p, r_x, r_e, r_d, no such solution is on their
/// boundary, and there is one for l = 1 (Leray and Schauder).
#[must_use]
pub fn existence_conditions(
    data: &Data<'_>,
    bounds: &SetBounds<Enclosure>,
    origin: &AtOrigin<Enclosure>,
    gains: &SampledGains<Enclosure>,
    squares: &MeanSquares<Enclosure>,
) -> Vec<Condition> {
    let of_changes = bounds.clone().of_changes();
    let response = gains.response(origin, &Forcing::new(&of_changes, origin, squares));
    let sup = response.sup.min(&sup_by_mean_squares(data, squares));
    let x_rms = of_changes.x_rms(squares).min_known(&gains.rms_of_states());
    let least = [
        ("min{(c/a_1) b_fe r_e, sqrt(gamma/c_x) Q_m}".to_owned(), x_rms),
        ("min{12.2, sqrt(T r_e r_d), bt_h r_y + (sqrt(h T)/2) R_q}".to_owned(), sup),
        ("min{12.2, sqrt(gamma/c_e) Q_m}".to_owned(), response.rms),
        ("min{12.2, sqrt((2 r_y/(2 - h sigma))^2 + R_q^2)}".to_owned(), response.rate_rms),
    ];
    bounds.existence(data, squares, Relation::Less, least)
}
