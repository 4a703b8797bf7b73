//! Trigonometric polynomials in t, enclosed at a time and around it (docs/mathematics.md, section 11.6).

use proofs_core::interval::Interval;
pub use proofs_core::wave::Wave;
use rug::Rational;

/// All numbers that are at most `size` in magnitude.
pub fn around(size: &Interval) -> Interval {
    let size = size.abs().ceiling();
    (-&size).hull(&size)
}

/// A polynomial with its derivatives, ready to be evaluated at one precision.
pub struct Table {
    /// By order: the value at harmonic 0, then the coefficients of cos and sin.
    orders: Vec<(Interval, Vec<[Interval; 2]>)>,
    /// By order: an upper bound of the magnitude, at every t.
    bounds: Vec<Interval>,
}

impl Table {
    /// The derivatives up to `last` and a bound of each are wanted.
    pub fn new(wave: &Wave, om: &Interval, last: usize) -> Table {
        let p = om.precision();
        let number = |q: &Rational| Interval::rational(q, p);
        let mut mean = number(&wave.mean);
        let mut coefficients: Vec<[Interval; 2]> =
            wave.harmonics.iter().map(|pair| pair.each_ref().map(number)).collect();
        let mut table = Table { orders: Vec::new(), bounds: Vec::new() };
        for _ in 0..=last {
            let bound = coefficients.iter().fold(mean.abs(), |sum, [a, b]| sum + a.abs() + b.abs());
            table.bounds.push(bound.ceiling());
            // (a cos + b sin)' = k Om (b cos - a sin).
            let next = (1..).zip(&coefficients).map(|(k, [a, b])| {
                let rate = om * k;
                [&rate * b, -(&rate * a)]
            });
            let next = next.collect();
            table.orders.push((mean, std::mem::replace(&mut coefficients, next)));
            mean = Interval::int(0, p);
        }
        table
    }

    /// A bound of the magnitude of a derivative, at every t; undefined beyond the last order.
    pub fn bound(&self, order: usize, precision: u32) -> Interval {
        self.bounds.get(order).cloned().unwrap_or_else(|| Interval::undefined(precision))
    }

    /// A derivative at the time of these waves; undefined beyond the last order.
    pub fn at(&self, order: usize, waves: &[[Interval; 2]], precision: u32) -> Interval {
        let Some((mean, coefficients)) = self.orders.get(order) else { return Interval::undefined(precision) };
        mean.plus_products(coefficients.iter().flatten().zip(waves.iter().flatten()))
    }

    /// Derivatives from `order` on, `values`, at the middle of a cell: that of `order` on the cell `middle +- half`, by Taylor's
    /// formula with the last derivative bounded at every t.
    pub fn around(&self, order: usize, values: &[Interval], half: &Interval) -> Interval {
        let p = half.precision();
        let none = Interval::undefined(p);
        let delta = around(half);
        let last = values.len();
        let Some(bound) = self.bounds.get(order + last) else { return none };
        if self.bounds.get(order).is_some_and(Interval::is_zero) {
            return Interval::int(0, p);
        }
        // The remainder first: f^(m)/m! delta^m, then Horner's rule downwards.
        let mut sum = around(bound);
        for (k, value) in values.iter().enumerate().rev() {
            sum = value + &delta * sum / (k as i64 + 1);
        }
        sum.intersect(&around(&self.bounds[order]))
    }
}

/// cos and sin of k Om t for k = 1, ..., count at a time: by addition theorems in a tree, so that rounding grows slowly.
pub fn waves(om: &Interval, time: &Interval, count: usize) -> Vec<[Interval; 2]> {
    let angle = om * time;
    let mut list: Vec<[Interval; 2]> = Vec::with_capacity(count);
    for k in 1..=count {
        if k == 1 {
            list.push([angle.cos(), angle.sin()]);
            continue;
        }
        let ([c, s], [d, r]) = (&list[k / 2 - 1], &list[k.div_ceil(2) - 1]);
        list.push([c * d - s * r, s * d + c * r]);
    }
    list
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_contains_what_its_times_give() {
        let p = 128;
        let number = |q: (i64, i64)| Interval::rational(&Rational::from(q), p);
        let om = Interval::pi(p) * 2;
        let wave = Wave {
            mean: Rational::from((1, 3)),
            harmonics: [((1, 2), (-1, 4)), ((0, 1), (1, 5)), ((1, 7), (0, 1))]
                .map(|(a, b)| [Rational::from(a), Rational::from(b)])
                .to_vec(),
        };
        let table = Table::new(&wave, &om, 7);
        let at = |order: usize, t: &Interval| table.at(order, &waves(&om, t, 3), p);
        let (middle, half) = (number((2, 9)), number((1, 40)));
        for order in 0..4 {
            let values: Vec<Interval> = (order..order + 3).map(|order| at(order, &middle)).collect();
            let on_cell = table.around(order, &values, &half);
            for part in -3..=3 {
                let there = at(order, &(&middle + &half * part / 3));
                assert!(on_cell.intersect(&there).is_defined(), "{order} at {part}");
            }
            // By the formula itself.
            let direct = (1..=3_i64).zip(&wave.harmonics).fold(number((0, 1)), |sum, (k, [a, b])| {
                let angle = &om * k * &middle;
                let turned = [
                    (angle.cos(), angle.sin()),
                    (-angle.sin(), angle.cos()),
                    (-angle.cos(), -angle.sin()),
                    (angle.sin(), -angle.cos()),
                ];
                let (cos, sin) = &turned[order % 4];
                let power = (&om * k).powi(order as i32);
                sum + power * (Interval::rational(a, p) * cos + Interval::rational(b, p) * sin)
            });
            let direct = if order == 0 { direct + number((1, 3)) } else { direct };
            assert!((direct - at(order, &middle)).abs().hi().to_f64() < 1e-30);
        }
        assert!(!table.around(5, &[at(5, &middle), at(6, &middle), at(7, &middle)], &half).is_defined());
    }
}
