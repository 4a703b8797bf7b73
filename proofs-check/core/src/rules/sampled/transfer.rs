//! Rule T for a sampled regulator: `T_d(j) <= ((1+theta)^2/w^2)(k0 + k1 (om_j/w)^2)` for every harmonic j and every n_o < N_s/2
//! (docs/mathematics.md, section 12.2).
//!
//! It follows from `k0 >= 1/(nu^2 n_0)` and `k0 + k1 (om_j/w)^2 >= max{2/(nu^2 n_j), s_j}` for j = 1, ..., floor(N_s/2), with
//! `s_j = x^2 sum_{|l|<j} c_l/sin^2((j-l) x)`, `x = w h/2 = pi/N_s`. These are finitely many, but may be many; om_j and 1/n_j grow with
//! j, so a block of them is settled at once where its ends allow it, and halved where they do not.

use super::law::{Law, RULE};
use crate::effort;
use crate::interval::Interval;
use crate::verdict::{Condition, Outcome, Verdict, finding};
use rug::Rational;

/// A pair (k0, k1), and what it has to bound.
pub struct Pair<'a> {
    law: &'a Law<'a>,
    k0: Interval,
    k1: Interval,
    /// 1/nu^2, nu = mu/w.
    inverse: Interval,
    /// x = pi/N_s.
    x: Interval,
    /// The sum of all weights.
    total: Interval,
}

/// Decides the finite check, and returns the comparison at j = 0.
pub fn check(law: &Law<'_>, k0: &Rational, k1: &Rational, pointer: &str) -> Outcome<Condition> {
    let pair = Pair::new(law, k0, k1);
    let what = "transfer bound, sampled: 1/(nu^2 n_0) <= k0";
    let mean = Condition::at_most("T", what, &pair.inverse / &law.d.n_0, pair.k0.clone());
    mean.demand(RULE, pointer)?;
    // The last one that is pushed is the next to be looked at, so they are looked at in order.
    let mut blocks = vec![(1, law.samples / 2)];
    while let Some((first, last)) = blocks.pop() {
        if effort::exhausted() {
            return Err(finding(Verdict::Undecided, RULE, pointer, "the harmonics take more steps than there are"));
        }
        let room = pair.at(first);
        let settled = |lhs: Interval| lhs.le(&room) == Some(true);
        if settled(pair.pole(last)) && pair.beyond(first, last).into_iter().any(settled) {
            continue;
        }
        if first < last {
            let middle = first + (last - first) / 2;
            blocks.extend([(middle + 1, last), (first, middle)]);
            continue;
        }
        let what = format!("max{{2/(nu^2 n_j), s_j}} <= k0 + k1 (om_j/w)^2 at j = {first}");
        let largest = pair.pole(first).max(&pair.sum(first));
        Condition::at_most("T", what, largest, room).demand(RULE, pointer)?;
    }
    Ok(mean)
}

impl<'a> Pair<'a> {
    /// Encloses what the bounds are made of.
    pub fn new(law: &'a Law<'a>, k0: &Rational, k1: &Rational) -> Pair<'a> {
        let d = law.d;
        Pair {
            k0: d.number(k0),
            k1: d.number(k1),
            inverse: (&d.w / &law.mu).sqr(),
            x: Interval::pi(d.precision) / i64::from(law.samples),
            total: d.n_bar.sqr(),
            law,
        }
    }

    /// `k0 + k1 (om_j/w)^2`: it does not decrease up to N_s/2.
    fn at(&self, j: u32) -> Interval {
        let squared = self.law.frequency_squared(&self.law.sine(j)) / self.law.d.w.sqr();
        &self.k0 + &self.k1 * squared
    }

    /// n_l.
    fn weight(&self, l: u32) -> Interval {
        self.law.d.weight(u64::from(l))
    }

    /// `2/(nu^2 n_j)`, for n_o >= j: it increases with j by W2.
    fn pole(&self, j: u32) -> Interval {
        &self.inverse * 2 / self.weight(j)
    }

    /// Bounds of s_j for every j from `first` to `last` (12.5b): `pi^2 Nbar^2/4`, since `|sin| >= 2/pi` times the angle; and, with m =
    /// first/2, `(pi^2/3) n_{m+1}/2` for |l| > m, since `sum_{d=1}^{N_s-1} x^2/sin^2(d x) < pi^2/3`, with `x^2 Nbar^2/sin^2` for the
    /// others, at the least sine from first - m to last + m < N_s, which stands at an end.
    pub fn beyond(&self, first: u32, last: u32) -> [Interval; 2] {
        let pi_squared = Interval::pi(self.law.d.precision).sqr();
        let m = first / 2;
        let least = self.law.sine(first - m).min(&self.law.sine(last + m));
        let far = &self.total * (&self.x / least).sqr();
        [&pi_squared * &self.total / 4, pi_squared * self.weight(m + 1) / 6 + far]
    }

    /// s_j itself, for n_o < j.
    pub fn sum(&self, j: u32) -> Interval {
        let term = |distance: u32| (&self.x / self.law.sine(distance)).sqr();
        let pairs = (1..j).map(|l| self.weight(l) / 2 * (term(j - l) + term(j + l)));
        pairs.fold(&self.law.d.n_0 * term(j), |sum, pair| sum + pair)
    }
}
