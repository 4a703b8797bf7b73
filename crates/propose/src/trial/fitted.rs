//! Trials of a family (derivation, 14.4): polynomials in what the members differ by from the nominal one, through the trials of some members.

use super::{FloatTrial, TrialLoop};
use crate::orbit::FloatSeries;
use nalgebra::DMatrix;
use rug::Rational;
use sigmastar_lang::plant::{CurveTerm, Plant};
use sigmastar_lang::spec::{Interval, OrbitCurve};
use std::f64::consts::PI;

/// The degree of the polynomials where so many numbers are intervals, from one on; with more there is no trial.
const DEGREES: [u32; 5] = [4, 4, 2, 2, 1];

/// Singular values that are this share of the largest one are 0.
const SINGULAR: f64 = 1e-12;

/// A family with a loop for each of its members.
#[derive(Clone, Debug)]
pub struct Members<'a> {
    /// The family, or a plant of which nothing is an interval.
    pub plant: &'a Plant,
    /// Its orbit.
    pub orbit: &'a OrbitCurve,
    /// Where b lies, if that is an interval.
    pub gain: Option<&'a Interval>,
}

impl Members<'_> {
    /// The terms of a trial; `of` makes a loop of a member and its b. `None` where one of the trials of members is not found, or too much is an interval.
    #[must_use]
    pub fn propose<'p>(&self, of: impl for<'m> Fn(&'m Plant, f64) -> TrialLoop<'m>) -> Option<Vec<CurveTerm>> {
        let sides: Vec<&Interval> = self.plant.parameters.intervals().chain(self.gain).collect();
        let trial_of = |deviations: &[f64]| {
            let exact = deviations.iter().map(|deviation| Rational::from_f64(*deviation));
            let exact: Vec<Rational> = exact.collect::<Option<_>>()?;
            let values: Vec<Rational> =
                sides.iter().zip(&exact).map(|(side, deviation)| Rational::from(&side.nominal + deviation)).collect();
            let count = self.plant.parameters.intervals().count();
            let member = self.plant.member(&values[..count]);
            let gain = values.get(count).map_or(1.0, Rational::to_f64);
            of(&member, gain).propose(&FloatSeries::from(&self.orbit.at(&exact[..count])))
        };
        let Some(last) = sides.len().checked_sub(1) else {
            let trial = trial_of(&[])?;
            return Some(vec![of(self.plant, 1.0).term(&trial, Vec::new(), 1.0)]);
        };
        let degree = *DEGREES.get(last)?;
        let nodes = nodes(&sides, degree);
        let trials: Vec<FloatTrial> = nodes.iter().map(|node| trial_of(node)).collect::<Option<_>>()?;
        let reaches: Vec<f64> = sides.iter().map(|side| side.reach().to_f64()).collect();
        let powers = powers(sides.len(), degree);
        // With lengths in which they are at most 1.
        let value = |deviations: &[f64], powers: &[u32]| -> f64 {
            let each = deviations.iter().zip(&reaches).zip(powers);
            each.map(|((deviation, reach), power)| raised(deviation / reach, *power)).product()
        };
        let values = DMatrix::from_fn(nodes.len(), powers.len(), |i, j| value(&nodes[i], &powers[j]));
        let weights = values.svd(true, true).pseudo_inverse(SINGULAR).ok()?;
        let program = of(self.plant, 1.0);
        let term = |(j, powers): (usize, &Vec<u32>)| {
            let scale: f64 = reaches.iter().zip(powers).map(|(reach, power)| raised(*reach, *power)).product();
            let weights = weights.row(j).iter().map(|weight| weight / scale).collect::<Vec<f64>>();
            let each: Vec<&FloatSeries> = trials.iter().map(|trial| &trial.series).collect();
            let sizes = trials.iter().map(|trial| &trial.sizes);
            let sizes = sizes.fold(vec![0.0_f64; each[0].dimension()], |largest, sizes| {
                largest.iter().zip(sizes).map(|(a, b)| a.max(*b)).collect()
            });
            program.term(&FloatTrial { series: FloatSeries::combined(&each, &weights), sizes }, powers.clone(), scale)
        };
        Some(powers.iter().enumerate().map(term).collect())
    }
}

/// A power, by multiplications: the same on all machines.
fn raised(value: f64, power: u32) -> f64 {
    (0..power).fold(1.0, |product, _| product * value)
}

/// What the members differ by at which the trials are found: along each side the points between which a polynomial of this degree goes best.
fn nodes(sides: &[&Interval], degree: u32) -> Vec<Vec<f64>> {
    let count = degree + 1;
    let along = |side: &Interval| -> Vec<f64> {
        let [low, high] = side.deviations().map(|end| end.to_f64());
        let cosine = |j: u32| libm::cos(PI * f64::from(2 * j + 1) / f64::from(2 * count));
        (0..count).map(|j| (low + high) / 2.0 + (high - low) / 2.0 * cosine(j)).collect()
    };
    sides.iter().fold(vec![Vec::new()], |nodes: Vec<Vec<f64>>, side| {
        let along = along(side);
        let longer = |node: &Vec<f64>| {
            along.iter().map(|value| node.iter().copied().chain([*value]).collect()).collect::<Vec<_>>()
        };
        nodes.iter().flat_map(longer).collect()
    })
}

/// All powers with a sum of at most `degree`, that of 0 first.
fn powers(sides: usize, degree: u32) -> Vec<Vec<u32>> {
    let mut all = (0..sides).fold(vec![Vec::new()], |all: Vec<Vec<u32>>, _| {
        let longer = |powers: &Vec<u32>| {
            let left = degree - powers.iter().sum::<u32>();
            (0..=left).map(|power| powers.iter().copied().chain([power]).collect()).collect::<Vec<_>>()
        };
        all.iter().flat_map(longer).collect()
    });
    all.sort_by_key(|powers| powers.iter().sum::<u32>());
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_begin_with_the_nominal_member() {
        assert_eq!(powers(2, 2), [[0, 0], [0, 1], [1, 0], [0, 2], [1, 1], [2, 0]]);
        assert_eq!(powers(1, 4).len(), 5);
        assert_eq!(powers(3, 2).len(), 10);
    }

    #[test]
    fn nodes_lie_inside_of_the_box() {
        let side = |low: i32, high: i32| Interval { nominal: 1.into(), low: low.into(), high: high.into() };
        let (a, b) = (side(0, 2), side(1, 5));
        let found = nodes(&[&a, &b], 3);
        assert_eq!(found.len(), 16);
        // Deviations from 1: of the second side from 0 to 4.
        assert!(found.iter().all(|node| node[0].abs() < 1.0 && 0.0 < node[1] && node[1] < 4.0));
        let furthest = found.iter().map(|node| node[1]).fold(0.0, f64::max);
        assert!((furthest - 2.0 * (1.0 + libm::cos(PI / 8.0))).abs() < 1e-12, "{furthest}");
    }
}
