//! The norm `y'Pi y` of a witness for some oscillators, at the harmonics 0, ..., n_o or at those of a set, in `y = (e, zs)`, `zs = N^(1/2) zeta`, or in `y = (x, e, zs)` (docs/mathematics.md, section 13.6),
//! and the part of the loop that is in all of its forms.
//!
//! Guarantee: with [`Norm::lies_above`] and [`Norm::start`] `e_low e^2 <= y'Pi y <= x_up |x|^2 + e_up e^2 + z_up |zeta|_N^2`.

use super::claimed::RULE;
use crate::data::Data;
use crate::interval::Interval;
use crate::json::{Field, Fields};
use crate::matrix::{Matrix, positive_definite};
use crate::rules::by_n_o::oscillators::Oscillators;
use crate::verdict::{Outcome, bad, demand, invalid};
use rug::{Integer, Rational};

/// Pi as a witness has it.
pub struct Stored {
    /// Where it stands in the file.
    pub pointer: String,
    pub oscillators: Oscillators,
    /// How many states of the plant are in y.
    states: usize,
    /// The lower triangle of Pi, by rows.
    rows: Matrix,
    e_low: Rational,
}

impl Stored {
    /// Takes `Pi` and `e_low` out of the part for these oscillators, with so many states of the plant.
    pub fn read(fields: &mut Fields<'_>, oscillators: &Oscillators, states: usize) -> Outcome<Stored> {
        let what = match states {
            0 => "one for e and one for each state of zeta",
            _ => "one for each state, one for e and one for each state of zeta",
        };
        let rows = triangle(&fields.required("Pi")?, states + 2 * oscillators.count(), what)?;
        let e_low = fields.number("e_low")?;
        Ok(Stored { pointer: fields.pointer.clone(), oscillators: oscillators.clone(), states, rows, e_low })
    }
}

/// What [`Stored`] has, enclosed, with `B = (1, -b)` for (e, zs), `b = N^(1/2) M`.
pub struct Norm {
    pointer: String,
    /// The place of e, after the states of the plant.
    pub of_e: usize,
    pub e_low: Interval,
    rows: Vec<Vec<Interval>>,
    /// From the place of e on: 1, and sqrt(n_l) at the states of zs, 0 at the second one of an oscillator.
    pub b: Vec<Interval>,
    /// Pi B.
    pub image: Vec<Interval>,
    /// l w of each oscillator, that of the integrator, 0, the first: Phi turns its two states so fast.
    turns: Vec<Interval>,
}

impl Norm {
    /// Encloses it; e_low is demanded to be above 0.
    pub fn new(d: &Data<'_>, stored: &Stored) -> Outcome<Norm> {
        positive("e_low", &stored.e_low, &stored.pointer)?;
        let root = |l: u32| d.weight(u64::from(l)).sqrt();
        let harmonics = stored.oscillators.harmonics();
        let mut b = vec![d.int(1), root(0)];
        harmonics[1..].iter().for_each(|l| b.extend([root(*l), d.int(0)]));
        let turns = harmonics.iter().map(|l| &d.w * i64::from(*l)).collect();
        let rows = enclosed(d, &stored.rows);
        let (pointer, e_low) = (stored.pointer.clone(), d.number(&stored.e_low));
        let mut norm = Norm { pointer, of_e: stored.states, e_low, rows, b, image: Vec::new(), turns };
        let direction: Vec<Interval> = (0..norm.order()).map(|k| norm.at_input(k)).collect();
        norm.image = norm.times(&direction);
        Ok(norm)
    }

    /// The order of Pi.
    pub fn order(&self) -> usize {
        self.rows.len()
    }

    /// An entry of Pi.
    pub fn at(&self, i: usize, j: usize) -> &Interval {
        &self.rows[i.max(j)][i.min(j)]
    }

    /// An entry of B.
    pub fn at_input(&self, k: usize) -> Interval {
        match k.checked_sub(self.of_e) {
            None => Interval::int(0, self.e_low.precision()),
            Some(0) => self.b[0].clone(),
            Some(state) => -&self.b[state],
        }
    }

    /// `Pi` times a vector.
    pub fn times(&self, vector: &[Interval]) -> Vec<Interval> {
        let zero = Interval::int(0, self.e_low.precision());
        let row = |i: usize| {
            let parts = vector.iter().enumerate().filter(|(_, value)| !value.is_zero());
            parts.fold(zero.clone(), |sum, (k, value)| sum + self.at(i, k) * value)
        };
        (0..self.order()).map(row).collect()
    }

    /// l w of a state of zs, counted from 1.
    pub fn turn(&self, state: usize) -> Interval {
        self.turns[state / 2].clone()
    }

    /// `(Pi A)_ij` with `A y = (0, -sigma e, Phi zs) + B (slope e + mu b'zs)`, `Phi = l w [0, 1; -1, 0]`.
    fn moved(&self, i: usize, j: usize, sigma: &Interval, [mu, slope]: [&Interval; 2]) -> Interval {
        match j.checked_sub(self.of_e) {
            None => Interval::int(0, self.e_low.precision()),
            Some(0) => &self.image[i] * slope - self.at(i, j) * sigma,
            Some(state) => {
                let through = &self.image[i] * &(mu * &self.b[state]);
                match state {
                    1 => through,
                    first if first % 2 == 0 => through - self.at(i, j + 1) * self.turn(state),
                    _ => through + self.at(i, j - 1) * self.turn(state),
                }
            }
        }
    }

    /// The lower triangle of `-(Pi A + A'Pi + 2 rate Pi)`.
    pub fn falls(&self, sigma: &Interval, back: [&Interval; 2], rate: &Interval) -> Vec<Vec<Interval>> {
        let moved = |i: usize, j: usize| self.moved(i, j, sigma, back);
        self.triangle(&|i, j| -(moved(i, j) + moved(j, i) + self.at(i, j) * rate * 2))
    }

    fn triangle(&self, entry: &dyn Fn(usize, usize) -> Interval) -> Vec<Vec<Interval>> {
        (0..self.order()).map(|i| (0..=i).map(|j| entry(i, j)).collect()).collect()
    }

    /// `Pi > diag(0, e_low, 0)`.
    pub fn lies_above(&self) -> Outcome<()> {
        let rest = self.triangle(&|i, j| {
            let own = self.at(i, j);
            if [i, j] == [self.of_e; 2] { own - &self.e_low } else { own.clone() }
        });
        demand(positive_definite(rest), RULE, &format!("{}/e_low", self.pointer), "Pi > diag(0, e_low, 0)")
    }

    /// `Pi > diag(0, 0, z_low I)`, and its block of zs is below z_up I.
    pub fn holds_oscillators(&self, [z_low, z_up]: [&Interval; 2]) -> Outcome<()> {
        let rest = self.triangle(&|i, j| {
            let own = self.at(i, j);
            if i == j && i > self.of_e { own - z_low } else { own.clone() }
        });
        let at = |name: &str| format!("{}/{name}", self.pointer);
        demand(positive_definite(rest), RULE, &at("z_low"), "Pi > diag(0, 0, z_low I)")?;
        let block: Vec<Vec<Interval>> = (self.of_e + 1..self.order())
            .map(|i| (self.of_e + 1..=i).map(|j| if i == j { z_up - self.at(i, i) } else { -self.at(i, j) }).collect())
            .collect();
        demand(positive_definite(block), RULE, &at("z_up"), "the block of zs in Pi is below z_up I")
    }

    /// Demands `Pi < diag(x_up I, e_up, z_up I)`, and bounds y'Pi y from above at a start within dX, dE and dZ. `of_x`: x_up; where Pi has no x, what
    /// stands before |x|^2 besides, none where x has no part in it.
    pub fn start(
        &self,
        d: &Data<'_>,
        of_x: Option<&Interval>,
        ends: &[Rational; 2],
        reach: &[Interval; 3],
    ) -> Outcome<Interval> {
        let zero = d.int(0);
        let x_up = of_x.unwrap_or(&zero);
        let [e_up, z_up] = ends.each_ref().map(|value| d.number(value));
        let end = |i: usize| {
            if i < self.of_e {
                x_up
            } else if i == self.of_e {
                &e_up
            } else {
                &z_up
            }
        };
        let rest = self.triangle(&|i, j| if i == j { end(i) - self.at(i, i) } else { -self.at(i, j) });
        let what = "Pi < diag(x_up I, e_up, z_up I)";
        demand(positive_definite(rest), RULE, &format!("{}/z_up", self.pointer), what)?;
        let terms = [x_up, &e_up, &z_up].into_iter().zip(reach).map(|(end, distance)| end * distance.sqr());
        Ok(terms.fold(d.int(0), |sum, term| sum + term))
    }
}

/// The lower triangle of a matrix of so many rows; `what` they are.
pub fn triangle(rows: &Field<'_>, order: usize, what: &str) -> Outcome<Matrix> {
    let list = rows.elements()?;
    if list.len() != order {
        return bad(&rows.pointer, format!("expected {order} rows, {what}"));
    }
    let matrix = rows.list(|row| row.list(Field::rational))?;
    if let Some(i) = matrix.iter().enumerate().position(|(i, row)| row.len() != i + 1) {
        return bad(&list[i].pointer, format!("expected {} numbers, up to the diagonal", i + 1));
    }
    Ok(matrix)
}

/// The rows of a matrix, enclosed.
pub fn enclosed(d: &Data<'_>, rows: &Matrix) -> Vec<Vec<Interval>> {
    rows.iter().map(|row| row.iter().map(|value| d.number(value)).collect()).collect()
}

/// That a number of a witness or a claim is above 0.
pub fn positive(name: &str, value: &Rational, pointer: &str) -> Outcome<()> {
    if *value > 0 {
        return Ok(());
    }
    invalid(RULE, &format!("{pointer}/{name}"), format!("0 < {name} fails: {name} = {value}"))
}

/// The multipliers of x by their names, enclosed: all above 0, and left out only where x has no part in e.
pub fn of_x<const N: usize>(
    d: &Data<'_>,
    names: [&str; N],
    given: Option<&[Rational; N]>,
    k_x: &Interval,
    pointer: &str,
) -> Outcome<Option<[Interval; N]>> {
    let Some(all) = given else {
        let truth = if k_x.is_zero() { Some(true) } else { k_x.is_positive().then_some(false) };
        return demand(truth, RULE, pointer, "k_x = 0, where there is no `w`").map(|()| None);
    };
    names.into_iter().zip(all).try_for_each(|(name, value)| positive(name, value, pointer))?;
    Ok(Some(all.each_ref().map(|value| d.number(value))))
}

/// 2 to this power.
pub fn power(d: &Data<'_>, exponent: i32) -> Interval {
    let whole = Integer::from(1) << exponent.unsigned_abs();
    let value = Rational::from(whole);
    d.number(&if exponent < 0 { value.recip() } else { value })
}
