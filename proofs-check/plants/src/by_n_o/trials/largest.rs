//! The largest length over t of a vector of trigonometric polynomials (docs/mathematics.md, section 14.4).
//!
//! On a cell with the middle c and the half width h, `v(t) = v(c) + v'(c) (t - c) + rest`, and the rest is at most `sup|v''| h^2/2`. So |v| is at most
//! `sqrt(|v(c)|^2 + 2 |v(c) v'(c)| h + |v'(c)|^2 h^2) + sup|v''| h^2/2`. Cells on which that is not above what |v| is somewhere else are done;
//! the others are halved.

use crate::time::{Table, Wave, waves};
use proofs_core::interval::Interval;

/// A polynomial or a derivative of it, by the order of that.
pub type Part<'w> = (&'w Wave, usize);

/// How often cells are halved, and how many there may be.
const MOST_HALVINGS: u32 = 40;
const MOST_CELLS: usize = 4_096;

/// A component, a sum of parts.
struct Component {
    tables: Vec<(Table, usize)>,
}

impl Component {
    fn sum(&self, of: impl Fn(&Table, usize) -> Interval, precision: u32) -> Interval {
        self.tables.iter().fold(Interval::int(0, precision), |sum, (table, order)| sum + of(table, *order))
    }
}

/// An upper bound of `sup|v|`, of v by its components, that is above it by about `2^-share` of itself or less; the period and Om have the precision.
pub fn largest(vector: &[Vec<Part<'_>>], [om, period]: [&Interval; 2], share: u32) -> Interval {
    let p = om.precision();
    let zero = || Interval::int(0, p);
    let table = |(wave, order): &Part<'_>| (Table::new(wave, om, order + 2), *order);
    let components: Vec<Component> =
        vector.iter().map(|parts| Component { tables: parts.iter().map(table).collect() }).collect();
    let count = vector.iter().flatten().map(|(wave, _)| wave.harmonics.len()).max().unwrap_or(0);
    let norm = |of: &dyn Fn(&Component) -> Interval| {
        components.iter().fold(zero(), |sum, component| sum + of(component).sqr()).sqrt()
    };
    let bend = norm(&|component| component.sum(|table, order| table.bound(order + 2, p), p));
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
            let at = |component: &Component, slope: usize| {
                component.sum(|table, order| table.at(order + slope, &there, p), p)
            };
            let both: Vec<[Interval; 2]> = components.iter().map(|of| [0, 1].map(|slope| at(of, slope))).collect();
            let (mut square, mut moved, mut speed) = (zero(), zero(), zero());
            for [value, slope] in &both {
                (square, moved, speed) = (square + value.sqr(), moved + value * slope, speed + slope.sqr());
            }
            let reach = &square + moved.abs() * &half * 2 + speed * half.sqr();
            least = least.max(&square.sqrt().floor());
            open.push((j, (reach.sqrt() + &bend * half.sqr() / 2).ceiling()));
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

    fn of(vector: &[Vec<Part<'_>>], share: u32) -> f64 {
        let (om, period) = (Interval::pi(53) * 2, Interval::int(1, 53));
        largest(vector, [&om, &period], share).hi().to_f64()
    }

    #[test]
    fn it_is_a_bound_and_a_sharp_one() {
        // 1 + 3 cos + 4 sin has the largest value 6, and a length of 5 with its other part.
        let a = wave(1, &[[(3, 1), (4, 1)]]);
        let found = of(&[vec![(&a, 0)]], 30);
        assert!((6.0..6.0 * (1.0 + 2e-9)).contains(&found), "{found}");
        let [b, c] = [[(3, 1), (4, 1)], [(4, 1), (-3, 1)]].map(|pair| wave(0, &[pair]));
        let found = of(&[vec![(&b, 0)], vec![(&c, 0)]], 30);
        // It is largest everywhere, so that the cells are too many in the end.
        assert!((5.0..5.0 * (1.0 + 1e-6)).contains(&found), "{found}");
        // The derivative of the first less that itself: 5 sqrt(1 + 4 pi^2) and 1.
        let less = wave(-1, &[[(-3, 1), (-4, 1)]]);
        let right = 32.81132565783664;
        let found = of(&[vec![(&a, 1), (&less, 0)]], 30);
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
            let found = of(&[vec![(&d, 0)]], share);
            assert!((right * (1.0 - 1e-12)..right * (1.0 + more)).contains(&found), "{found} {right}");
        }
        assert!(
            of(&[vec![(&wave(0, &[]), 0)]], 30) == 0.0
                && of(&[], 7) == 0.0
                && of(&[vec![(&wave(-2, &[]), 0)]], 30) < 2.1
        );
    }
}
