//! Rule T for a sampled regulator: `T_d(j) <= ((1+theta)^2/w^2)(k0 + k1 (om_j/w)^2)` for every harmonic j and every n_o < N_s/2
//! (docs/mathematics.md, section 12.2).
//!
//! It follows from `k0 >= 1/(nu^2 n_0)` and `k0 + k1 (om_j/w)^2 >= max{2/(nu^2 n_j), s_j}` for j = 1, ..., floor(N_s/2), with
//! `s_j = x^2 sum_{|l|<j} c_l/sin^2((j-l) x)`, `x = w h/2 = pi/N_s`. These are finitely many, but may be many; om_j and 1/n_j grow with
//! j, so a block of them is settled at once where its ends allow it, and halved where they do not.
//!
//! Of a claim about every set of harmonics below N_s/2 that contains 0, s_j is the sum over all `|l| < N_s/2`, `|l| != j` (14.7a): so the numerator of
//! T_d(j) is bounded whichever of them are in the set.

use super::law::{Law, RULE};
use crate::effort;
use crate::interval::Interval;
use crate::scope::Scope;
use crate::verdict::{Condition, Outcome, Verdict, finding};
use rug::Rational;
use std::cell::OnceCell;

/// So many terms of s_j of every set are added one by one before all are, and twice j more.
const FEW: u32 = 256;

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
    /// What s_j of every set is made of, where it was asked for.
    parts: OnceCell<Parts>,
}

/// `x^2/sin^2(d x)` for d up to N_s/2 (for d = 0 nothing), and c_l for l < N_s/2.
struct Parts {
    terms: Vec<Interval>,
    weights: Vec<Interval>,
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
        let alone = (first == last).then(|| pair.near(first)).flatten();
        if settled(pair.pole(last)) && pair.beyond(first, last).into_iter().chain(alone).any(settled) {
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
            parts: OnceCell::new(),
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
    /// others, at the least sine from first - m to last + m < N_s, which stands at an end. Of every set too: the numbers j - l are in different classes
    /// modulo N_s, none in that of 0.
    pub fn beyond(&self, first: u32, last: u32) -> [Interval; 2] {
        let pi_squared = Interval::pi(self.law.d.precision).sqr();
        let m = first / 2;
        let least = self.law.sine(first - m).min(&self.law.sine(last + m));
        let far = &self.total * (&self.x / least).sqr();
        [&pi_squared * &self.total / 4, pi_squared * self.weight(m + 1) / 6 + far]
    }

    /// s_j itself, for `1 <= j <= N_s/2`.
    pub fn sum(&self, j: u32) -> Interval {
        match self.law.scope {
            Scope::First => self.sum_of_first(j),
            Scope::EverySet => self.sum_of_every_set(j),
        }
    }

    /// For n_o < j.
    fn sum_of_first(&self, j: u32) -> Interval {
        let term = |distance: u32| (&self.x / self.law.sine(distance)).sqr();
        let pairs = (1..j).map(|l| self.weight(l) / 2 * (term(j - l) + term(j + l)));
        pairs.fold(&self.law.d.n_0 * term(j), |sum, pair| sum + pair)
    }

    /// A bound of (14.7a) where that has many terms: those with `|l| <= m` one by one, `(pi^2/6) n_{m+1}` for the others.
    fn near(&self, j: u32) -> Option<Interval> {
        let most = 2 * j + FEW;
        if self.law.scope == Scope::First || 2 * most >= self.law.samples {
            return None;
        }
        let term = |distance: u32| (&self.x / self.law.sine(distance)).sqr();
        let others = (1..=most).filter(|l| *l != j);
        let pairs = others.map(|l| self.weight(l) / 2 * (term(j.abs_diff(l)) + term(j + l)));
        let rest = Interval::pi(self.law.d.precision).sqr() / 6 * self.weight(most + 1);
        Some(pairs.fold(&self.law.d.n_0 * term(j) + rest, |sum, pair| sum + pair))
    }

    /// (14.7a): of every l, l and -l together.
    fn sum_of_every_set(&self, j: u32) -> Interval {
        let Parts { terms, weights } = self.parts.get_or_init(|| self.parts());
        let samples = self.law.samples;
        // The sine of d x is that of (N_s - d) x, and 0 < d < N_s: j is at most N_s/2, and l below it.
        let term = |d: u32| terms.get(d.min(samples.saturating_sub(d)) as usize);
        let of = |l: u32, c: &Interval| match (l, term(j.abs_diff(l)), term(j + l)) {
            (0, Some(term), _) => c * term,
            (_, Some(behind), Some(ahead)) => c * (behind + ahead),
            _ => Interval::undefined(self.law.d.precision),
        };
        let others = (0..).zip(weights).filter(|(l, _)| *l != j);
        others.fold(self.law.d.int(0), |sum, (l, c)| sum + of(l, c))
    }

    fn parts(&self) -> Parts {
        let samples = self.law.samples;
        let none = Interval::undefined(self.law.d.precision);
        let term = |d: u32| (&self.x / self.law.sine(d)).sqr();
        let later = (1..samples.div_ceil(2)).map(|l| self.weight(l) / 2);
        Parts {
            terms: [none].into_iter().chain((1..=samples / 2).map(term)).collect(),
            weights: [self.law.d.n_0.clone()].into_iter().chain(later).collect(),
        }
    }
}
