//! The largest over t of a sum of lengths of vectors of trigonometric polynomials (docs/mathematics.md, section 14.4).
//!
//! On a cell with the middle c and the half width h, `v(t) = v(c) + v'(c) (t - c) + rest`, and the rest is at most `sup|v''| h^2/2`. So |v| is at most
//! `sqrt(|v(c)|^2 + 2 |v(c) v'(c)| h + |v'(c)|^2 h^2) + sup|v''| h^2/2`; and, as `sqrt(a + b) <= sqrt(a) + b/(2 sqrt(a))`, where v(c) is not 0 at most
//! `|v(c)| + s (t - c) + |v'(c)|^2 h^2/(2 |v(c)|) + sup|v''| h^2/2` with the slope `s = v(c) v'(c)/|v(c)|`: slopes of several vectors are added up with
//! their signs. Cells on which the sum of these is not above what the sum is somewhere else are done; the others are halved.

use crate::time::{Table, Wave, waves};
use proofs_core::interval::Interval;

/// A vector by its components, with a factor of its length.
pub struct Part {
    /// 0 or more.
    pub factor: Interval,
    /// Its components.
    pub vector: Vec<Wave>,
}

/// How often cells are halved, and how many there may be.
const MOST_HALVINGS: u32 = 40;
const MOST_CELLS: usize = 4_096;

/// An upper bound of the supremum of `sum factor |v|`, that is above it by about `2^-share` of itself or less; the period and Om have the precision.
pub fn largest(parts: &[Part], [om, period]: [&Interval; 2], share: u32) -> Interval {
    let p = om.precision();
    let zero = || Interval::int(0, p);
    let tables: Vec<(Interval, Vec<Table>)> = parts
        .iter()
        .map(|Part { factor, vector }| (factor.round(p), vector.iter().map(|wave| Table::new(wave, om, 2)).collect()))
        .collect();
    let count = parts.iter().flat_map(|part| &part.vector).map(|wave| wave.harmonics.len()).max().unwrap_or(0);
    let bends = |(factor, vector): &(Interval, Vec<Table>)| {
        let square = vector.iter().fold(zero(), |sum, table| sum + table.bound(2, p).sqr());
        factor * square.sqrt()
    };
    let bend = tables.iter().map(bends).fold(zero(), |sum, part| sum + part);
    let room = 1 + Interval::int(1, p) / (1_i64 << share.min(32));

    // The j-th of 2^depth cells, at first four for each harmonic.
    let first = (4 * count.max(1)).next_power_of_two().trailing_zeros();
    let mut cells: Vec<i64> = (0..1_i64 << first).collect();
    let mut least = zero();
    let mut most = zero();
    for depth in first..first + MOST_HALVINGS {
        let half = period / (1_i64 << (depth + 1));
        let mut open: Vec<(i64, Interval)> = Vec::new();
        for j in cells {
            let there = waves(om, &(&half * (2 * j + 1)), count);
            let (mut there_all, mut reach_all, mut slope_all, mut curve_all) = (zero(), zero(), zero(), zero());
            for (factor, vector) in &tables {
                let (mut square, mut moved, mut speed) = (zero(), zero(), zero());
                for table in vector {
                    let [value, slope] = [0, 1].map(|order| table.at(order, &there, p));
                    (square, moved, speed) = (square + value.sqr(), moved + &value * &slope, speed + slope.sqr());
                }
                let reach = &square + moved.abs() * &half * 2 + &speed * half.sqr();
                let length = square.sqrt();
                slope_all = slope_all + factor * moved / &length;
                curve_all = curve_all + factor * speed / &length;
                there_all = there_all + factor * length;
                reach_all = reach_all + factor * reach.sqrt();
            }
            let by_slope = &there_all + slope_all.abs() * &half + curve_all * half.sqr() / 2;
            least = least.max(&there_all.floor());
            open.push((j, (reach_all.least(&by_slope) + &bend * half.sqr() / 2).ceiling()));
        }
        most = (&least * &room).ceiling();
        open.retain(|(_, bound)| bound.le(&most) != Some(true));
        let last = depth + 1 == first + MOST_HALVINGS || open.len() > MOST_CELLS;
        if last {
            return open.iter().fold(most, |most, (_, bound)| most.max(bound));
        }
        cells = open.into_iter().flat_map(|(j, _)| [2 * j, 2 * j + 1]).collect();
        if cells.is_empty() {
            break;
        }
    }
    most
}

#[cfg(test)]
mod tests {
    use super::*;
    use rug::Rational;

    fn wave(mean: i32, harmonics: &[[(i32, i32); 2]]) -> Wave {
        Wave { mean: mean.into(), harmonics: harmonics.iter().map(|pair| pair.map(Rational::from)).collect() }
    }

    /// Of one vector, or of two.
    fn of(vectors: &[&[&Wave]], share: u32) -> f64 {
        let (om, period) = (Interval::pi(53) * 2, Interval::int(1, 53));
        let part = |vector: &&[&Wave]| Part {
            factor: Interval::int(1, 53),
            vector: vector.iter().map(|wave| (*wave).clone()).collect(),
        };
        largest(&vectors.iter().map(part).collect::<Vec<_>>(), [&om, &period], share).hi().to_f64()
    }

    #[test]
    fn it_is_a_bound_and_a_sharp_one() {
        // 1 + 3 cos + 4 sin has the largest value 6, and a length of 5 with its other part.
        let a = wave(1, &[[(3, 1), (4, 1)]]);
        let found = of(&[&[&a]], 30);
        assert!((6.0..6.0 * (1.0 + 2e-9)).contains(&found), "{found}");
        let [b, c] = [[(3, 1), (4, 1)], [(4, 1), (-3, 1)]].map(|pair| wave(0, &[pair]));
        let found = of(&[&[&b, &c]], 30);
        // It is largest everywhere, so that the cells are too many in the end.
        assert!((5.0..5.0 * (1.0 + 1e-6)).contains(&found), "{found}");
        // 5 |cos| and 5 |sin| together: less than the sum of the largest of each.
        let [found, right] = [of(&[&[&b], &[&c]], 30), 5.0 * 2.0_f64.sqrt()];
        assert!((right * (1.0 - 1e-15)..right * (1.0 + 2e-9)).contains(&found), "{found}");
        // Far from smooth, against its values.
        let d = wave(0, &[[(1, 2), (0, 1)], [(0, 1), (-1, 3)], [(0, 1), (0, 1)], [(1, 5), (1, 7)]]);
        let om = Interval::pi(53) * 2;
        let value = |j: i64| {
            let there = waves(&om, &(Interval::int(j, 53) / 10_000), 4);
            Table::new(&d, &om, 0).at(0, &there, 53).abs().to_f64()
        };
        let right = (0..10_000).map(value).fold(0.0, f64::max);
        for (share, more) in [(30, 1e-5), (7, 1e-2)] {
            let found = of(&[&[&d]], share);
            assert!((right * (1.0 - 1e-12)..right * (1.0 + more)).contains(&found), "{found} {right}");
        }
        assert!(of(&[&[&wave(0, &[])]], 30) == 0.0 && of(&[], 7) == 0.0 && of(&[&[&wave(-2, &[])]], 30) < 2.1);
    }

    /// Factors count.
    #[test]
    fn a_sum_with_factors() {
        let (om, period) = (Interval::pi(53) * 2, Interval::int(1, 53));
        let part = |factor: i64, mean: i32| Part { factor: Interval::int(factor, 53), vector: vec![wave(mean, &[])] };
        let found = largest(&[part(1, 3), part(7, -2)], [&om, &period], 30).hi().to_f64();
        assert!((17.0..17.0 * (1.0 + 2e-9)).contains(&found), "{found}");
    }
}
