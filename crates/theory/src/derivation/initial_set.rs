//! The initial set that a specification asks for, and how far it is from the periodic solution.

use super::condition::Condition;
use crate::data::{Data, Problem};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::real::{Operand, Real};
use sigmastar_lang::spec::StartSizes;

/// The set of initial conditions of a claim, exactly.
pub type ClaimedSet = StartSizes<Rational>;

/// The paper's Z_0 = 2 (Z + Nbar E_p).
#[must_use]
pub fn paper_z0<R: Real>(problem: &impl Problem<R>, e_p: &R, z: &R) -> R
where
    for<'a> &'a R: Operand<R>,
{
    R::int(2) * (z + &problem.numbers().n_bar * e_p)
}

/// dX = X_0 + x_per, dE = E_0 + e_per, dZ = Z_0 + Nbar E_0 + Z: how far an initial set is from a periodic solution bounded by
/// x_per, e_per, Z. With z = M e at the first instant zeta is 0 there, and dZ = Z (section 13.7).
#[must_use]
pub fn distances<R: Real>(problem: &impl Problem<R>, set: &StartSizes<R>, [x_per, e_per, z]: [&R; 3]) -> [R; 3]
where
    for<'a> &'a R: Operand<R>,
{
    let of_zeta = match &set.z0 {
        Some(z0) => z0 + &problem.numbers().n_bar * &set.e0 + z,
        None => z.clone(),
    };
    [&set.x0 + x_per, &set.e0 + e_per, of_zeta]
}

/// How far a claimed set is from a periodic solution, as [`distances`], enclosed.
#[must_use]
pub fn claimed_distances(data: &Data<'_>, set: &ClaimedSet, periodic: [&Enclosure; 3]) -> [Enclosure; 3] {
    distances(data, &set.map(|size| data.rational(size)), periodic)
}

/// A size of the required set: exactly, so that equality is decided, or enclosed.
#[derive(Clone, Debug)]
pub enum Size {
    /// A rational number.
    Exact(Rational),
    /// Any other.
    Enclosed(Enclosure),
}

/// The sizes that the specification asks for, given X_p, E_p and Z.
#[must_use]
pub fn required_set(data: &Data<'_>, x_p: &Rational, e_p: &Rational, z: &Enclosure) -> StartSizes<Size> {
    let user = data.spec.initial_set.map(|constant| match constant.as_rational() {
        Some(exact) => Size::Exact(exact.clone()),
        None => Size::Enclosed(constant.enclose(data.precision)),
    });
    let twice = |value: &Rational| Size::Exact(Rational::from(value * 2u32));
    let z0 = || Size::Enclosed(paper_z0(data, &data.rational(e_p), z));
    user.required([twice(x_p), twice(e_p)], z0, Size::Exact(Rational::new()))
}

/// The claimed set must cover what the specification asks for. Each condition is written "required - claimed <= 0", with the
/// difference of rationals taken exactly.
#[must_use]
pub fn set_conditions(
    data: &Data<'_>,
    set: &ClaimedSet,
    x_p: &Rational,
    e_p: &Rational,
    z: &Enclosure,
) -> Vec<Condition> {
    let required = required_set(data, x_p, e_p, z);
    let condition = |((name, required), (_, claimed)): ((&str, &Size), (&str, &Rational))| {
        let excess = match required {
            Size::Exact(required) => data.rational(&Rational::from(required - claimed)),
            Size::Enclosed(required) => required - data.rational(claimed),
        };
        Condition::at_most("set", format!("the required {name} - the claimed {name} <= 0"), excess, data.zero())
    };
    let mut conditions: Vec<Condition> = required.named().zip(set.named()).map(condition).collect();
    if required.z0.is_some() != set.z0.is_some() {
        // One starts with z = M e, the other does not: they are not compared. 1 <= 0 is certainly false.
        let what = "the start of the regulator (z = M e, or not) is the one that is asked for";
        conditions.push(Condition::at_most("set", what, Enclosure::one(data.precision), data.zero()));
    }
    conditions
}
