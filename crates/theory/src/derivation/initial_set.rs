//! The initial set that a specification asks for, and how far it is from the periodic solution.

use super::condition::Condition;
use crate::data::{Data, Problem};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::real::{Operand, Real};

/// The set of initial conditions |x| <= x0, |e| <= e0, |z|_N <= z0 of a claim, exactly.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClaimedSet {
    /// X_0.
    pub x0: Rational,
    /// E_0.
    pub e0: Rational,
    /// Z_0.
    pub z0: Rational,
}

impl ClaimedSet {
    /// dX, dE, dZ ([`distances`]) from a periodic solution bounded by x_per, e_per, Z.
    #[must_use]
    pub fn distances(&self, data: &Data<'_>, periodic: [&Enclosure; 3]) -> [Enclosure; 3] {
        let [x0, e0, z0] = [&self.x0, &self.e0, &self.z0].map(|size| data.rational(size));
        distances(data, [&x0, &e0, &z0], periodic)
    }
}

/// The paper's Z_0 = 2 (Z + Nbar E_p).
#[must_use]
pub fn paper_z0<R: Real>(problem: &impl Problem<R>, e_p: &R, z: &R) -> R
where
    for<'a> &'a R: Operand<R>,
{
    R::int(2) * (z + &problem.numbers().n_bar * e_p)
}

/// dX = X_0 + x_per, dE = E_0 + e_per, dZ = Z_0 + Nbar E_0 + Z: how far an initial set is from the periodic solution.
#[must_use]
pub fn distances<R: Real>(problem: &impl Problem<R>, [x0, e0, z0]: [&R; 3], [x_per, e_per, z]: [&R; 3]) -> [R; 3]
where
    for<'a> &'a R: Operand<R>,
{
    [x0 + x_per, e0 + e_per, z0 + &problem.numbers().n_bar * e0 + z]
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
pub fn required_set(data: &Data<'_>, x_p: &Rational, e_p: &Rational, z: &Enclosure) -> [Size; 3] {
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
    let claimed = [("X0", &set.x0), ("E0", &set.e0), ("Z0", &set.z0)];
    let condition = |(size, (name, claimed)): (Size, (&str, &Rational))| {
        let excess = match size {
            Size::Exact(required) => data.rational(&(required - claimed)),
            Size::Enclosed(required) => required - data.rational(claimed),
        };
        Condition::at_most("set", format!("the required {name} - the claimed {name} <= 0"), excess, data.zero())
    };
    required_set(data, x_p, e_p, z).into_iter().zip(claimed).map(condition).collect()
}
