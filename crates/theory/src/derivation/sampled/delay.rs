//! What a claim adds where a control takes the sample after its measurement to be computed (derivation, 13.4): what of the last y is
//! stored in the Lyapunov function, and how far the prediction may be off at the start.

use super::law::SampledLaw;
use super::witness::{DelayWitness, SampledWitness};
use crate::data::Data;
use crate::derivation::condition::Condition;
use crate::derivation::sign_conditions;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::real::{Operand, Real};

/// `gm h (Y_0 + y_per)^2`, what the last y has in the level at the start.
pub(super) fn stored<R: Real>(step: &R, gm: &R, [y_0, y_per]: [&R; 2]) -> R
where
    for<'a> &'a R: Operand<R>,
{
    gm * step * (y_0 + y_per).sqr()
}

/// The signs of the further numbers, and that a start with et_0 = 0 is within them: `E_0 <= h Y_0`.
pub(super) fn conditions(data: &Data<'_>, witness: &SampledWitness, law: &SampledLaw<Enclosure>) -> Vec<Condition> {
    let DelayWitness { gm, y_0 } = witness.delay_numbers();
    let e_0 = &witness.set.e0;
    // Exactly where h is rational: both may be equal.
    let room = match witness.sampling.step.as_rational() {
        Some(step) => data.rational(&(Rational::from(step * &y_0) - e_0)),
        None => &law.step * data.rational(&y_0) - data.rational(e_0),
    };
    let mut conditions = sign_conditions(data, &[("gm", &gm)]);
    conditions.push(Condition::at_most("set", "0 <= h Y_0 - E_0", data.zero(), room));
    conditions
}
