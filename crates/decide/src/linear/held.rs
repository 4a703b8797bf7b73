//! What a linear plant does within a sample, while its control is held (derivation, 14.6).

use super::PRECISION;
use super::jet::{Jet, Offsets};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_theory::transfer::Complex;

/// The most terms of a series, and what may be left of one, in comparison with its first term.
const MAX_TERMS: u32 = 120;
const LEFT: f64 = 1e-19;

/// `[[A, b], [c, d]]` of the members with parameters in a box, and what follows for one sample.
#[derive(Clone, Debug)]
pub(super) struct Held {
    /// `[[A, b], [c, d]]` by rows.
    rows: Vec<Vec<Jet>>,
    /// h.
    step: Enclosure,
    /// E = (exp(h [[A, b], [c, d]]) - I)/h, by rows.
    pub(super) step_map: Vec<Vec<Jet>>,
    /// The mean over a sample of what a held control makes of (x, e), over h: G.
    pub(super) by_control: Vec<Jet>,
    /// (c, d) exp(s [[A, b], [c, d]]) for every s of a part of a sample.
    slopes: Vec<Vec<Enclosure>>,
}

/// In how many parts a sample is cut for a bound of what happens within it.
const PARTS: i64 = 4;

impl Held {
    /// Of samples this far apart. `None` where a series does not become small.
    pub(super) fn new(rows: &[Vec<Jet>], step: &Enclosure, offsets: &Offsets) -> Option<Held> {
        let step_map = map_of_step(rows, step, offsets)?;
        let by_control = driven(rows, step, None, offsets)?;
        let slope = |part: i64| slope_on(rows, &(step * part / PARTS).hull(&(step * (part + 1) / PARTS)), offsets);
        let slopes = (0..PARTS).map(slope).collect::<Option<_>>()?;
        Some(Held { rows: rows.to_vec(), step: step.clone(), step_map, by_control, slopes })
    }

    /// The mean over a sample of what `e^{i omega s}`, added to e', makes of (x, e), over h: F for c_k = 1.
    pub(super) fn driven(&self, frequency: &Enclosure, offsets: &Offsets) -> Option<Vec<Jet>> {
        driven(&self.rows, &self.step, Some(frequency), offsets)
    }

    /// A bound of |q'| of a harmonic `c_k e^{i omega t}` of q, of the values (x, e) at its sampling instants, and of the control b u.
    pub(super) fn rate_of_q(
        &self,
        (frequency, driving): (&Enclosure, &Jet),
        (at_samples, control): (&[Jet], &Jet),
        offsets: &Offsets,
    ) -> Enclosure {
        let mut rates: Vec<Jet> = self.rows.iter().map(|row| product(row, at_samples, offsets)).collect();
        if let Some(last) = rates.last_mut() {
            *last = last.add(control).add(driving);
        }
        let rates: Vec<Jet> = rates.into_iter().map(|rate| offsets.narrowed(rate)).collect();
        // i omega c_k e^{i omega s}.
        let driving = driving.all();
        let of_driving = Complex { re: driving.im.negate(), im: driving.re.clone() }.scaled(frequency);
        let on_part = |(part, slope): (i64, &Vec<Enclosure>)| {
            let within = (&self.step * part / PARTS).hull(&(&self.step * (part + 1) / PARTS));
            let angle = frequency * &within;
            let [re, im] = angle.cos_sin();
            let own = of_driving.mul(&Complex { re, im });
            let sum = rates.iter().zip(slope).fold(own, |sum, (rate, slope)| sum.add(&rate.all().scaled(slope)));
            sum.norm()
        };
        let most = (0..).zip(&self.slopes).map(on_part).fold(Enclosure::zero(PRECISION), |most, part| most.max(&part));
        // What comes with e'' = ... + i omega c_k e^{i omega s} within the sample.
        let through = self.slopes.iter().filter_map(|slope| slope.last());
        let through = through.fold(Enclosure::zero(PRECISION), |most, slope| most.max(&slope.abs()));
        most + &self.step * through * of_driving.norm()
    }
}

/// The sum of the products.
pub(super) fn product(row: &[Jet], column: &[Jet], offsets: &Offsets) -> Jet {
    let zero = Jet::real(Enclosure::zero(PRECISION));
    row.iter().zip(column).fold(zero, |sum, (a, b)| sum.add(&a.mul(b, offsets)))
}

/// A bound of the row sums of h times a matrix, and of h times a frequency.
fn size(rows: &[Vec<Jet>], step: &Enclosure, frequency: &Enclosure) -> f64 {
    let sum = |row: &Vec<Jet>| row.iter().fold(Enclosure::zero(PRECISION), |sum, entry| sum + entry.norm());
    let all = rows.iter().map(sum).fold(frequency.abs(), |most, sum| most.max(&sum));
    (all * step.abs()).upper_f64()
}

/// What is left of `sum over i of a^i/i!` after so many terms, a an upper end: `(a^J/J!)/(1 - a/(J+1))`; and how many terms leave next to nothing.
fn terms(size: f64) -> Option<(u32, Enclosure)> {
    let a = Enclosure::exactly(size);
    let mut left = Enclosure::one(PRECISION);
    for count in 1..=MAX_TERMS {
        left = left * &a / i64::from(count);
        let share = Enclosure::one(PRECISION) - &a / i64::from(count + 1);
        if share.is_positive().is_true() {
            let rest = &left / share;
            if rest.upper_f64() <= LEFT {
                return Some((count, rest));
            }
        }
    }
    None
}

/// Any number that is not larger, in both parts.
fn not_above(rest: &Enclosure) -> Complex {
    let part = rest.negate().hull(rest);
    Complex { re: part.clone(), im: part }
}

/// `sum over j >= 1 of h^{j-1} g_j/j!`, `g_1 = first` and `g_j = A g_{j-1} + (i omega)^{j-1} B`, B the last unit vector where there is an omega, up to so
/// many terms.
fn series(
    rows: &[Vec<Jet>],
    (first, step): (Vec<Jet>, &Enclosure),
    (frequency, count): (Option<&Enclosure>, u32),
    offsets: &Offsets,
) -> Vec<Jet> {
    let mut power = Complex::real(Enclosure::one(PRECISION));
    // h^{j-1}/j! g_j, and h^{j-1}/j! (i omega)^{j-1}.
    let mut term = first;
    let mut sum = term.clone();
    for j in 2..=i64::from(count) {
        let factor = step / j;
        term = rows.iter().map(|row| product(row, &term, offsets).scaled(&factor)).collect();
        if let Some(frequency) = frequency {
            power = Complex { re: power.im.negate(), im: power.re.clone() }.scaled(&(frequency * &factor));
            if let Some(last) = term.last_mut() {
                *last = last.within(&power);
            }
        }
        sum.iter_mut().zip(&term).for_each(|(sum, term)| *sum = sum.add(term));
    }
    sum.into_iter().map(|sum| offsets.narrowed(sum)).collect()
}

/// `(exp(h A) - I)/h = sum over j >= 1 of h^{j-1} A^j/j!`; what is left after J terms is at most a times that of [`terms`] in each entry, a the largest row
/// sum.
fn map_of_step(rows: &[Vec<Jet>], step: &Enclosure, offsets: &Offsets) -> Option<Vec<Vec<Jet>>> {
    let order = rows.len();
    let zero = Enclosure::zero(PRECISION);
    let (count, rest) = terms(size(rows, step, &zero))?;
    let largest = size(rows, &Enclosure::one(PRECISION), &zero);
    let rest = not_above(&(rest * Enclosure::exactly(largest)));
    let column = |j: usize| {
        let first = rows.iter().map(|row| row[j].clone()).collect();
        series(rows, (first, step), (None, count), offsets)
    };
    let columns: Vec<Vec<Jet>> = (0..order).map(column).collect();
    Some((0..order).map(|i| columns.iter().map(|column| column[i].within(&rest)).collect()).collect())
}

/// `r exp(s A) = r + s sum over j >= 1 of s^{j-1} r A^j/j!` for every s of a part of a sample, r the last row of A. What is left after J terms is at most a |r|
/// times that of [`terms`] in each entry, a the largest column sum.
fn slope_on(rows: &[Vec<Jet>], within: &Enclosure, offsets: &Offsets) -> Option<Vec<Enclosure>> {
    let order = rows.len();
    let transposed: Vec<Vec<Jet>> = (0..order).map(|j| rows.iter().map(|row| row[j].clone()).collect()).collect();
    let last = rows.last()?;
    let zero = Enclosure::zero(PRECISION);
    let (count, rest) = terms(size(&transposed, within, &zero))?;
    let largest = Enclosure::exactly(size(&transposed, &Enclosure::one(PRECISION), &zero));
    let of_row = last.iter().fold(zero, |most, entry| most.max(&entry.norm()));
    let rest = not_above(&(rest * largest * of_row));
    let first = transposed.iter().map(|row| product(row, last, offsets)).collect();
    let moved = series(&transposed, (first, within), (None, count), offsets);
    let entry =
        |(moved, last): (Jet, &Jet)| offsets.narrowed(moved.within(&rest).scaled(within).add(last)).all().re.clone();
    Some(moved.into_iter().zip(last).map(entry).collect())
}

/// `(1/h) int_0^h exp((h-s) A) B e^{i omega s} ds = sum over j >= 1 of h^{j-1} g_j/j!`, B the last unit vector, g_1 = B and
/// `g_j = A g_{j-1} + (i omega)^{j-1} B`. In the norm of the largest component `|g_j| <= j a^{j-1}`. Without an omega it is 0.
fn driven(rows: &[Vec<Jet>], step: &Enclosure, frequency: Option<&Enclosure>, offsets: &Offsets) -> Option<Vec<Jet>> {
    let order = rows.len();
    let zero = Enclosure::zero(PRECISION);
    let (count, rest) = terms(size(rows, step, frequency.unwrap_or(&zero)))?;
    let unit = |i: usize| Jet::real(Enclosure::from_integer(i64::from(i + 1 == order), PRECISION));
    let first = (0..order).map(unit).collect();
    let sum = series(rows, (first, step), (frequency, count), offsets);
    Some(sum.into_iter().map(|part| part.within(&not_above(&rest))).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(entries: &[&[f64]]) -> Vec<Vec<Jet>> {
        entries.iter().map(|row| row.iter().map(|entry| Jet::real(Enclosure::exactly(*entry))).collect()).collect()
    }

    const ALONE: Offsets = Offsets(Vec::new());

    fn holds(found: &Enclosure, expected: f64, share: f64) {
        let [low, high] = [found.lower_f64(), found.upper_f64()];
        assert!(low <= expected + 1e-15 && expected - 1e-15 <= high, "{expected}: {found:?}");
        assert!(high - low <= share * (1e-12 + expected.abs()), "{expected}: {found:?}");
    }

    /// One variable: (e^{ah} - 1)/h, (e^{ah} - 1)/(ah), and (e^{iwh} - e^{ah})/(h (iw - a)).
    #[test]
    fn a_scalar_is_held_in_closed_form() {
        for (a, h, w) in [(-3.0f64, 0.25f64, 7.0f64), (2.0, 0.01, 100.0), (-40.0, 0.1, 0.5), (1e-9, 0.5, 3.0)] {
            let held = Held::new(&rows(&[&[a]]), &Enclosure::exactly(h), &ALONE).unwrap();
            let grown = (a * h).exp_m1();
            holds(&held.step_map[0][0].all().re, grown / h, 1e-6);
            holds(&held.by_control[0].all().re, grown / (a * h), 1e-6);
            let driven = held.driven(&Enclosure::exactly(w), &ALONE).unwrap();
            let driven = driven[0].all();
            let (re, im) = ((w * h).cos() - (a * h).exp(), (w * h).sin());
            let square = h * (a * a + w * w);
            holds(&driven.re, (-re * a + im * w) / square, 1e-6);
            holds(&driven.im, (-im * a - re * w) / square, 1e-6);
        }
    }

    /// The oscillator x' = e, e' = -x: its map over a sample is a rotation.
    #[test]
    fn a_rotation_is_one() {
        let h = 0.75f64;
        let held = Held::new(&rows(&[&[0.0, 1.0], &[-1.0, 0.0]]), &Enclosure::exactly(h), &ALONE).unwrap();
        let expected = [[h.cos() - 1.0, h.sin()], [-h.sin(), h.cos() - 1.0]];
        for (row, expected) in held.step_map.iter().zip(expected) {
            row.iter().zip(expected).for_each(|(entry, expected)| holds(&entry.all().re, expected / h, 1e-10));
        }
        holds(&held.by_control[0].all().re, (1.0 - h.cos()) / h, 1e-10);
        holds(&held.by_control[1].all().re, h.sin() / h, 1e-10);
    }

    /// e' = d e + c e^{iwt} + u: q = d e + c e^{iwt} has the derivative d e' + iwc e^{iwt}, on a grid of the sample.
    #[test]
    fn the_rate_of_q_is_bounded_closely() {
        let (d, h, w, e, u) = (-4.0f64, 0.05f64, 9.0f64, 0.3f64, -1.0f64);
        let held = Held::new(&rows(&[&[d]]), &Enclosure::exactly(h), &ALONE).unwrap();
        let real = |value: f64| Jet::real(Enclosure::exactly(value));
        let bound = held.rate_of_q((&Enclosure::exactly(w), &real(2.0)), (&[real(e)], &real(u)), &ALONE).upper_f64();
        let (mut value, mut most) = ((e, 0.0), 0.0f64);
        let steps = 10_000;
        for step in 0..=steps {
            let s = h * f64::from(step) / f64::from(steps);
            let (c, i) = (2.0 * (w * s).cos(), 2.0 * (w * s).sin());
            let rate = (d * value.0 + c + u, d * value.1 + i);
            most = most.max((d * rate.0 - w * i).hypot(d * rate.1 + w * c));
            value = (value.0 + rate.0 * h / f64::from(steps), value.1 + rate.1 * h / f64::from(steps));
        }
        assert!(most <= bound && bound <= 1.6 * most, "{most} {bound}");
    }

    #[test]
    fn what_does_not_become_small_is_not_summed() {
        assert!(Held::new(&rows(&[&[1e4]]), &Enclosure::exactly(1.0), &ALONE).is_none());
        assert!(Held::new(&rows(&[&[f64::MAX]]), &Enclosure::exactly(1.0), &ALONE).is_none());
        let held = Held::new(&rows(&[&[1.0]]), &Enclosure::exactly(1.0), &ALONE).unwrap();
        assert!(held.driven(&Enclosure::exactly(1e6), &ALONE).is_none());
    }
}
