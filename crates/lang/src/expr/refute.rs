//! Counterexamples: exact points that prove a property false.

use super::failure::{BoundingFailure, Counterexample, DomainBox, Evaluation, Property};
use super::settings::ProofSettings;
use super::{Expr, FloatExpr};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use std::ops::Range;

/// Points per side of the grid on which counterexamples are sought first.
const GRID: u32 = 9;

/// Looks for counterexamples at given points; everything it returns is proved.
pub(super) struct Refuter<'a> {
    expr: &'a Expr,
    float: FloatExpr,
    settings: &'a ProofSettings,
}

impl<'a> Refuter<'a> {
    pub(super) fn new(expr: &'a Expr, settings: &'a ProofSettings) -> Refuter<'a> {
        Refuter { expr, float: expr.to_float(), settings }
    }

    /// Evaluates at a point; an error when that alone refutes a property.
    pub(super) fn evaluate(&self, x: &Rational, e: &Rational, precision: u32) -> Result<Evaluation, BoundingFailure> {
        let (at, undefined) = self.expr.at_point(x, e, precision);
        if let Some(span) = undefined {
            let counterexample = Counterexample::Undefined { x: x.clone(), e: e.clone() };
            return Err(refuted(Property::Finite, counterexample, Some(span)));
        }
        let evaluation = Evaluation { x: x.clone(), e: e.clone(), value: at.value };
        if !self.settings.signed && evaluation.value.is_nonnegative().is_false() {
            return Err(refuted(Property::Nonnegative, Counterexample::Negative(evaluation), None));
        }
        Ok(evaluation)
    }

    /// Whether the second value is certainly smaller, for a second point with a larger argument.
    fn compare(&self, from: &Evaluation, to: &Evaluation, property: Property) -> Result<(), BoundingFailure> {
        if to.value.lt(&from.value).is_true() {
            let counterexample = Counterexample::Decrease { from: from.clone(), to: to.clone() };
            return Err(refuted(property, counterexample, None));
        }
        Ok(())
    }

    /// Tries a regular grid on the domain: its points, and neighbours in each direction.
    pub(super) fn grid(&self, domain: &DomainBox) -> Result<(), BoundingFailure> {
        let side = |ends: &[Rational; 2]| -> Vec<Rational> {
            if ends[0] == ends[1] {
                return vec![ends[0].clone()];
            }
            let width = Rational::from(&ends[1] - &ends[0]);
            (0..GRID).map(|k| Rational::from((k, GRID - 1)) * &width + &ends[0]).collect()
        };
        let (xs, es) = (side(&domain.x), side(&domain.e));
        let mut previous: Option<Vec<Evaluation>> = None;
        for x in &xs {
            let column = es
                .iter()
                .map(|e| self.evaluate(x, e, self.settings.precision))
                .collect::<Result<Vec<Evaluation>, BoundingFailure>>()?;
            for pair in column.windows(2) {
                self.compare(&pair[0], &pair[1], Property::NondecreasingInE)?;
            }
            for (from, to) in previous.iter().flatten().zip(&column) {
                self.compare(from, to, Property::NondecreasingInX)?;
            }
            previous = Some(column);
        }
        Ok(())
    }

    /// Tries the corners and the middle of a box.
    pub(super) fn corners(&self, region: &DomainBox, precision: u32) -> Result<(), BoundingFailure> {
        let at = |i: usize, k: usize| self.evaluate(&region.x[i], &region.e[k], precision);
        let corners = [at(0, 0)?, at(1, 0)?, at(0, 1)?, at(1, 1)?];
        self.compare(&corners[0], &corners[1], Property::NondecreasingInX)?;
        self.compare(&corners[2], &corners[3], Property::NondecreasingInX)?;
        self.compare(&corners[0], &corners[2], Property::NondecreasingInE)?;
        self.compare(&corners[1], &corners[3], Property::NondecreasingInE)?;
        let middle = |ends: &[Rational; 2]| Rational::from(&ends[0] + &ends[1]) / 2u32;
        self.evaluate(&middle(&region.x), &middle(&region.e), precision).map(drop)
    }

    /// Whether double precision suggests a counterexample at the corners or the middle of a box, so that
    /// [`Refuter::corners`] is worth its time.
    pub(super) fn is_suspicious(&self, region: &DomainBox) -> bool {
        let [x1, x2, e1, e2] = [&region.x[0], &region.x[1], &region.e[0], &region.e[1]].map(Rational::to_f64);
        let [a, b, c, d] = [(x1, e1), (x2, e1), (x1, e2), (x2, e2)].map(|(x, e)| self.float.eval(x, e));
        let middle = self.float.eval(x1 / 2.0 + x2 / 2.0, e1 / 2.0 + e2 / 2.0);
        let suspicious = |value: f64| !value.is_finite() || value < 0.0;
        [a, b, c, d, middle].into_iter().any(suspicious) || a > b || c > d || a > c || b > d
    }
}

fn refuted(property: Property, counterexample: Counterexample, span: Option<Range<usize>>) -> BoundingFailure {
    BoundingFailure::Refuted { property, counterexample: Box::new(counterexample), span }
}

/// The sides of a box as enclosures, X first.
pub(super) fn sides(region: &DomainBox, precision: u32) -> [Enclosure; 2] {
    [&region.x, &region.e].map(|ends| Enclosure::between(&ends[0], &ends[1], precision))
}
