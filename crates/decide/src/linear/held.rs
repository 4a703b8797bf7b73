//! What a linear plant does within a sample, while its control is held (derivation, 14.6).

use super::PRECISION;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_theory::transfer::Complex;

/// The most terms of a series, and what may be left of one, in comparison with its first term.
const MAX_TERMS: u32 = 120;
const LEFT: f64 = 1e-19;

/// `[[A, b], [c, d]]` of the members with parameters in a box, and what follows for one sample.
#[derive(Clone, Debug)]
pub(super) struct Held {
    /// `[[A, b], [c, d]]` by rows.
    rows: Vec<Vec<Enclosure>>,
    /// h.
    step: Enclosure,
    /// E = (exp(h [[A, b], [c, d]]) - I)/h.
    pub(super) step_map: Vec<Vec<Enclosure>>,
    /// The mean over a sample of what a held control makes of (x, e), over h: G.
    pub(super) by_control: Vec<Enclosure>,
    /// (c, d) exp(s [[A, b], [c, d]]) for every s of a sample.
    slope: Vec<Enclosure>,
}

impl Held {
    /// Of samples this far apart. `None` where a series does not become small.
    pub(super) fn new(rows: &[Vec<Enclosure>], step: &Enclosure) -> Option<Held> {
        let order = rows.len();
        let step_map = map_of_step(rows, step)?;
        let by_control = driven(rows, step, &Enclosure::zero(PRECISION))?.into_iter().map(|part| part.re).collect();
        let within = Enclosure::zero(PRECISION).hull(step);
        let turned = map_of_step(rows, &within)?;
        let last = rows.last()?;
        let slope = (0..order)
            .map(|j| (0..order).fold(last[j].clone(), |sum, k| sum + &within * &last[k] * &turned[k][j]))
            .collect();
        Some(Held { rows: rows.to_vec(), step: step.clone(), step_map, by_control, slope })
    }

    /// The mean over a sample of what `e^{i omega s}`, added to e', makes of (x, e), over h: F for c_k = 1.
    pub(super) fn driven(&self, frequency: &Enclosure) -> Option<Vec<Complex>> {
        driven(&self.rows, &self.step, frequency)
    }

    /// A bound of |q'| of a harmonic `c_k e^{i omega t}` of q, of the values (x, e) at its sampling instants, and of the control b u.
    pub(super) fn rate_of_q(
        &self,
        (frequency, driving): (&Enclosure, &Complex),
        at_samples: &[Complex],
        control: &Complex,
    ) -> Enclosure {
        let start = |row: &Vec<Enclosure>| {
            let zero = Complex::real(Enclosure::zero(PRECISION));
            row.iter().zip(at_samples).fold(zero, |sum, (entry, value)| sum.add(&value.scaled(entry)))
        };
        let mut rates: Vec<Complex> = self.rows.iter().map(start).collect();
        if let Some(last) = rates.last_mut() {
            *last = last.add(control).add(driving);
        }
        // i omega c_k e^{i omega s}.
        let angle = frequency * Enclosure::zero(PRECISION).hull(&self.step);
        let turned = Complex { re: angle.cos(), im: angle.sin() };
        let of_driving = Complex { re: driving.im.negate(), im: driving.re.clone() }.scaled(frequency);
        let own = of_driving.mul(&turned);
        let sum = rates.iter().zip(&self.slope).fold(own, |sum, (rate, slope)| sum.add(&rate.scaled(slope)));
        // What comes with e'' = ... + i omega c_k e^{i omega s} within the sample.
        let through = self.slope.last().map_or_else(|| Enclosure::zero(PRECISION), Enclosure::abs);
        sum.norm() + &self.step * through * of_driving.norm()
    }
}

/// A bound of the row sums of h times a matrix, and of h times a frequency.
fn size(rows: &[Vec<Enclosure>], step: &Enclosure, frequency: &Enclosure) -> f64 {
    let sum = |row: &Vec<Enclosure>| row.iter().fold(Enclosure::zero(PRECISION), |sum, entry| sum + entry.abs());
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

/// Any number that is not larger.
fn within(rest: &Enclosure) -> Enclosure {
    rest.negate().hull(rest)
}

/// `(exp(h A) - I)/h = sum over j >= 1 of h^{j-1} A^j/j!`; what is left after J terms is at most a times that of [`terms`] in each entry, a the largest row
/// sum.
fn map_of_step(rows: &[Vec<Enclosure>], step: &Enclosure) -> Option<Vec<Vec<Enclosure>>> {
    let order = rows.len();
    let unit = Enclosure::one(PRECISION);
    let (count, rest) = terms(size(rows, step, &Enclosure::zero(PRECISION)))?;
    let largest = size(rows, &unit, &Enclosure::zero(PRECISION));
    let rest = within(&(rest * Enclosure::exactly(largest)));
    let mut term = rows.to_vec();
    let mut sum = rows.to_vec();
    for j in 2..=i64::from(count) {
        let factor = step / j;
        let entry = |i: usize, k: usize| {
            let product = (0..order).fold(Enclosure::zero(PRECISION), |sum, l| sum + &rows[i][l] * &term[l][k]);
            product * &factor
        };
        term = (0..order).map(|i| (0..order).map(|k| entry(i, k)).collect()).collect();
        sum.iter_mut().zip(&term).for_each(|(sum, term)| {
            sum.iter_mut().zip(term).for_each(|(sum, term)| *sum = &*sum + term);
        });
    }
    Some(sum.into_iter().map(|row| row.into_iter().map(|entry| entry + &rest).collect()).collect())
}

/// `(1/h) int_0^h exp((h-s) A) B e^{i omega s} ds = sum over j >= 1 of h^{j-1} g_j/j!`, B the last unit vector, g_1 = B and
/// `g_j = A g_{j-1} + (i omega)^{j-1} B`. In the norm of the largest component `|g_j| <= j a^{j-1}`.
fn driven(rows: &[Vec<Enclosure>], step: &Enclosure, frequency: &Enclosure) -> Option<Vec<Complex>> {
    let order = rows.len();
    let (count, rest) = terms(size(rows, step, frequency))?;
    let rest = within(&rest);
    let zero = || Complex::real(Enclosure::zero(PRECISION));
    let mut power = Complex::real(Enclosure::one(PRECISION));
    let mut term: Vec<Complex> = (0..order).map(|_| zero()).collect();
    // h^{j-1}/j! g_j, and h^{j-1}/j! (i omega)^{j-1}.
    if let Some(last) = term.last_mut() {
        *last = power.clone();
    }
    let mut sum = term.clone();
    for j in 2..=i64::from(count) {
        let factor = step / j;
        power = Complex { re: power.im.negate(), im: power.re.clone() }.scaled(&(frequency * &factor));
        let entry = |row: &Vec<Enclosure>| {
            let product = row.iter().zip(&term).fold(zero(), |sum, (entry, part)| sum.add(&part.scaled(entry)));
            product.scaled(&factor)
        };
        let mut next: Vec<Complex> = rows.iter().map(entry).collect();
        if let Some(last) = next.last_mut() {
            *last = last.add(&power);
        }
        term = next;
        sum.iter_mut().zip(&term).for_each(|(sum, term)| *sum = sum.add(term));
    }
    Some(sum.into_iter().map(|part| Complex { re: part.re + &rest, im: part.im + &rest }).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(entries: &[&[f64]]) -> Vec<Vec<Enclosure>> {
        entries.iter().map(|row| row.iter().map(|entry| Enclosure::exactly(*entry)).collect()).collect()
    }

    fn holds(found: &Enclosure, expected: f64, share: f64) {
        let [low, high] = [found.lower_f64(), found.upper_f64()];
        assert!(low <= expected + 1e-15 && expected - 1e-15 <= high, "{expected}: {found:?}");
        assert!(high - low <= share * (1e-12 + expected.abs()), "{expected}: {found:?}");
    }

    /// One variable: (e^{ah} - 1)/h, (e^{ah} - 1)/(ah), and (e^{iwh} - e^{ah})/(h (iw - a)).
    #[test]
    fn a_scalar_is_held_in_closed_form() {
        for (a, h, w) in [(-3.0f64, 0.25f64, 7.0f64), (2.0, 0.01, 100.0), (-40.0, 0.1, 0.5), (1e-9, 0.5, 3.0)] {
            let held = Held::new(&rows(&[&[a]]), &Enclosure::exactly(h)).unwrap();
            let grown = (a * h).exp_m1();
            holds(&held.step_map[0][0], grown / h, 1e-6);
            holds(&held.by_control[0], grown / (a * h), 1e-6);
            let driven = &held.driven(&Enclosure::exactly(w)).unwrap()[0];
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
        let held = Held::new(&rows(&[&[0.0, 1.0], &[-1.0, 0.0]]), &Enclosure::exactly(h)).unwrap();
        let expected = [[h.cos() - 1.0, h.sin()], [-h.sin(), h.cos() - 1.0]];
        for (row, expected) in held.step_map.iter().zip(expected) {
            row.iter().zip(expected).for_each(|(entry, expected)| holds(entry, expected / h, 1e-10));
        }
        holds(&held.by_control[0], (1.0 - h.cos()) / h, 1e-10);
        holds(&held.by_control[1], h.sin() / h, 1e-10);
    }

    /// e' = d e + c e^{iwt} + u: q = d e + c e^{iwt} has the derivative d e' + iwc e^{iwt}, on a grid of the sample.
    #[test]
    fn the_rate_of_q_is_bounded_closely() {
        let (d, h, w, e, u) = (-4.0f64, 0.05f64, 9.0f64, 0.3f64, -1.0f64);
        let held = Held::new(&rows(&[&[d]]), &Enclosure::exactly(h)).unwrap();
        let real = |value: f64| Complex::real(Enclosure::exactly(value));
        let bound = held.rate_of_q((&Enclosure::exactly(w), &real(2.0)), &[real(e)], &real(u)).upper_f64();
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
        assert!(Held::new(&rows(&[&[1e4]]), &Enclosure::exactly(1.0)).is_none());
        assert!(Held::new(&rows(&[&[f64::MAX]]), &Enclosure::exactly(1.0)).is_none());
        let held = Held::new(&rows(&[&[1.0]]), &Enclosure::exactly(1.0)).unwrap();
        assert!(held.driven(&Enclosure::exactly(1e6)).is_none());
    }
}
