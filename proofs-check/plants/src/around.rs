//! Some of the states around an orbit: a box of them that is in no ball of all coordinates, at no time.

use proofs_core::interval::Interval;
use rug::Rational;

/// Some components of `x = xb(t) + L y`, `|y| <= radius`.
///
/// With the rows R of L that they have, `w = x - xb = R y`. The parts `u_i = sum_j g_ij r_j` of the rows that are orthogonal to each
/// other give `g_i w = u_i y`, and so `sum_i (g_i w)^2 / |u_i|^2 <= |y|^2` (Bessel).
#[derive(Clone)]
pub struct Around {
    radius: Interval,
    /// The components, and what xb has of each over a period.
    middle: Vec<(usize, Interval)>,
    /// g_i and `|u_i|^2 > 0`.
    forms: Vec<(Vec<Interval>, Interval)>,
}

impl Around {
    /// From the components, each with its row of L and with what xb has of it over a period. `None` where the rows are not seen
    /// to be independent.
    pub fn new(components: Vec<(usize, &[Rational], Interval)>, radius: Interval) -> Option<Around> {
        let p = radius.precision();
        let product =
            |a: &[Interval], b: &[Interval]| a.iter().zip(b).fold(Interval::int(0, p), |sum, (a, b)| sum + a * b);
        let mut forms: Vec<(Vec<Interval>, Interval)> = Vec::new();
        let mut orthogonal: Vec<Vec<Interval>> = Vec::new();
        for (i, (_, row, _)) in components.iter().enumerate() {
            let row: Vec<Interval> = row.iter().map(|value| Interval::rational(value, p)).collect();
            let mut form: Vec<Interval> = (0..components.len()).map(|j| Interval::int(i64::from(i == j), p)).collect();
            let mut part = row.clone();
            for ((before, square), other) in forms.iter().zip(&orthogonal) {
                let share = product(&row, other) / square;
                let less = |from: &mut Vec<Interval>, of: &[Interval]| {
                    from.iter_mut().zip(of).for_each(|(value, of)| *value = &*value - &share * of);
                };
                less(&mut part, other);
                less(&mut form, before);
            }
            let square = part.iter().fold(Interval::int(0, p), |sum, value| sum + value.sqr());
            if !square.is_positive() {
                return None;
            }
            forms.push((form, square));
            orthogonal.push(part);
        }
        let middle = components.into_iter().map(|(state, _, range)| (state, range)).collect();
        Some(Around { radius, middle, forms })
    }

    /// Whether no x of a box lies in it, at any time; a `false` says nothing.
    pub fn excludes(&self, x: &[Interval]) -> bool {
        let zero = || Interval::int(0, self.radius.precision());
        let from: Vec<Interval> = self.middle.iter().map(|(state, middle)| &x[*state] - middle).collect();
        let part = |(form, square): &(Vec<Interval>, Interval)| {
            let value = form.iter().zip(&from).fold(zero(), |sum, (factor, from)| sum + factor * from);
            value.sqr() / square
        };
        let distance = self.forms.iter().map(part).fold(zero(), |sum, part| sum + part);
        self.radius.sqr().lt(&distance) == Some(true)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Place = [(i32, i32); 3];

    /// The second and the third of three coordinates, and what they are at y where xb = (0, 1, 0).
    fn around(radius: i64) -> (Around, impl Fn(Place) -> Vec<Interval>) {
        let l = [[2, 0, 0], [3, -1, 0], [1, 5, 4]].map(|row| row.map(Rational::from));
        let number = |value: &Rational| Interval::rational(value, 128);
        let rows = (1..3).map(|i| (i, l[i].as_slice(), number(&Rational::from(i == 1)))).collect();
        let around = Around::new(rows, Interval::int(radius, 128)).unwrap();
        let place = move |y: Place| {
            let y = y.map(Rational::from);
            let x = |(i, row): (usize, &[Rational; 3])| {
                row.iter().zip(&y).fold(Rational::from(i == 1), |sum, (l, y)| sum + Rational::from(l * y))
            };
            l.iter().enumerate().map(|row| number(&x(row))).collect()
        };
        (around, place)
    }

    /// Every place of the ball stays, those on its edge too; of those beyond, the ones that no other first coordinate brings back.
    #[test]
    fn no_place_of_the_ball_is_left_out() {
        let (around, place) = around(1);
        // Pythagorean: on the sphere.
        for (y, other) in [((3, 5), (4, 5)), ((-3, 5), (4, 5)), ((4, 5), (-3, 5)), ((0, 1), (1, 1)), ((-1, 1), (0, 1))]
        {
            for y in [[y, other, (0, 1)], [(0, 1), y, other], [other, (0, 1), y]] {
                assert!(!around.excludes(&place(y)), "{y:?}");
            }
        }
        // Beyond along the plane of the two rows.
        for y in [[(3, 2), (-1, 2), (0, 1)], [(1, 10), (5, 4), (1, 1)]] {
            assert!(around.excludes(&place(y)), "{y:?}");
        }
        // The direction that is orthogonal to both rows moves neither component.
        assert!(!around.excludes(&place([(-400, 1), (-1200, 1), (1600, 1)])));
    }

    /// Rows that depend on each other say nothing.
    #[test]
    fn dependent_rows_are_told() {
        let row = [Rational::from(1), Rational::from(2)];
        let zero = || Interval::int(0, 128);
        let rows = vec![(0, row.as_slice(), zero()), (1, row.as_slice(), zero())];
        assert!(Around::new(rows, Interval::int(1, 128)).is_none());
    }
}
