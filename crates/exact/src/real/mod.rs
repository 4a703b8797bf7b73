//! The numbers over which every formula of a derivation is written once: enclosures, which decide, and doubles, with which
//! a search proposes.
//!
//! A formula that is generic over [`Real`] needs its operators on references too; the bound that says so is
//! `for<'a> &'a R: Operand<R>`.

mod double;
mod enclosure;
mod series;

use std::ops::{Add, Div, Mul, Neg, Sub};

/// What can stand left of an operator whose right side is a number, or a reference to one.
pub trait Operand<R>:
    Add<R, Output = R>
    + Sub<R, Output = R>
    + Mul<R, Output = R>
    + Div<R, Output = R>
    + for<'a> Add<&'a R, Output = R>
    + for<'a> Sub<&'a R, Output = R>
    + for<'a> Mul<&'a R, Output = R>
    + for<'a> Div<&'a R, Output = R>
    + Sized
{
}

impl<R, T> Operand<R> for T where
    T: Add<R, Output = R>
        + Sub<R, Output = R>
        + Mul<R, Output = R>
        + Div<R, Output = R>
        + for<'a> Add<&'a R, Output = R>
        + for<'a> Sub<&'a R, Output = R>
        + for<'a> Mul<&'a R, Output = R>
        + for<'a> Div<&'a R, Output = R>
        + Sized
{
}

/// A real number: an [`crate::enclosure::Enclosure`], which contains it, or a double, which is near it.
///
/// Guarantee of every function: over enclosures, inclusion; over doubles none, and NaN stands where an enclosure would be
/// undefined. Predicates are "certainly so" or "could be either".
pub trait Real: Clone + Operand<Self> + Neg<Output = Self> {
    /// An integer, exactly.
    fn int(value: i64) -> Self;
    /// Nothing known.
    fn unknown() -> Self;
    /// x^2.
    fn sqr(&self) -> Self;
    /// The square root.
    fn sqrt(&self) -> Self;
    /// e^x.
    fn exp(&self) -> Self;
    /// coth x for x > 0.
    fn coth(&self) -> Self;
    /// The smaller of two numbers.
    fn min(&self, other: &Self) -> Self;
    /// The larger of two numbers.
    fn max(&self, other: &Self) -> Self;
    /// Whether nothing is known of it, or it is undefined.
    fn is_unknown(&self) -> bool;
    /// The smaller one of two upper bounds of one quantity; where one of them is not known, the other one.
    fn min_known(&self, other: &Self) -> Self {
        match (self.is_unknown(), other.is_unknown()) {
            (true, _) => other.clone(),
            (_, true) => self.clone(),
            _ => self.min(other),
        }
    }
    /// The larger one of two lower bounds of one quantity; where one of them is not known, the other one.
    fn max_known(&self, other: &Self) -> Self {
        match (self.is_unknown(), other.is_unknown()) {
            (true, _) => other.clone(),
            (_, true) => self.clone(),
            _ => self.max(other),
        }
    }
    /// Whether it is certainly exactly 0.
    fn is_zero(&self) -> bool;
    /// Whether it is certainly above 0.
    fn is_certainly_positive(&self) -> bool;
    /// The number u > 0 with coth(u)/u equal to this one, which is positive; unknown where it may not be.
    fn coth_ratio_inverse(&self) -> Self;
    /// `sum_{j != 0} 1/((2 pi j)^2 (y^2 + (2 pi j)^2))` for y > 0, which is `(1/12 - coth(y/2)/(2y) + 1/y^2)/y^2`: it decreases
    /// from 1/720 to 0.
    fn oscillator_sum(&self) -> Self;
    /// `sum_{j != 0} 1/(y^2 + (2 pi j)^2)` for y > 0, which is `coth(y/2)/(2y) - 1/y^2` and `1/12 - y^2 S(y)` with S of
    /// [`Real::oscillator_sum`]: it decreases from 1/12 to 0.
    fn zero_mean_sum(&self) -> Self;
    /// An upper bound, in a few digits, for a message.
    fn above(&self) -> String;
}
