//! Rule T: T_N(x) <= k0 + k1 x^2 for every N >= 0 and every x that occurs (docs/mathematics.md, section 2).
//!
//! Guarantee: closed form and boxes, for every x >= 0; matched, for every integer x >= 0, which are all that occur when
//! base_frequency = 2 pi/T. Every comparison is evaluated once; there is no search. Of a claim about every finite set H of harmonics that contains 0
//! the same of T_H (section 14.7): the closed form is about it as it is, matched with (14.7b), and boxes are not.

use super::every_set::{self, Step};
use crate::data::Data;
use crate::interval::Interval;
use crate::json::Field;
use crate::scope::Scope;
use crate::verdict::{Condition, Outcome, Verdict, bad, finding, invalid};
use rug::Rational;

/// Limits of a proof: harmonics, m0, N0 and boxes.
const MAX_HARMONICS: u32 = 4096;
const MAX_M0: u32 = 64;
const MAX_N0: u32 = 256;
const MAX_BOXES: usize = 20_000;
const RULE: &str = "transfer bound";

/// How (k0, k1) is proved.
#[derive(Clone, Debug)]
pub enum Proof {
    /// By the closed-form constants.
    ClosedForm,
    /// Integers x only: harmonics below K one by one, the others by one inequality.
    Matched(u32),
    /// Boxes on [0, m0 - 1/2] for N = 1, ..., N0 - 1 and for all N >= N0, and a scalar test beyond.
    Boxes {
        /// m0.
        m0: u32,
        /// N0.
        n0: u32,
        /// N0 lists of break points.
        breaks: Vec<Vec<Rational>>,
    },
}

impl Proof {
    /// Reads how the transfer bound is proved.
    pub fn read(field: &Field<'_>) -> Outcome<Proof> {
        field.object(|fields| {
            let kind = fields.required("proof")?;
            match kind.text()? {
                "closed-form" => Ok(Proof::ClosedForm),
                "matched" => Ok(Proof::Matched(fields.required("K")?.whole()?)),
                "boxes" => {
                    let (m0, n0) = (fields.required("m0")?.whole()?, fields.required("N0")?.whole()?);
                    let breaks = fields.required("boxes")?.list(|list| list.list(Field::rational))?;
                    Ok(Proof::Boxes { m0, n0, breaks })
                }
                _ => bad(&kind.pointer, "expected `closed-form`, `matched` or `boxes`"),
            }
        })
    }
}

/// The closed-form k0, k1: `(pi^2-4)/2 n_1 + max{(1/nu^2 + n_1^2)/n_0, 4 n_0 - 2 n_1}`,
/// `(8/n_1)(1/nu^2 + (2 n_0 + n_1/3)^2)`.
pub fn closed_form(d: &Data<'_>) -> [Interval; 2] {
    let (n_0, n_1, inverse) = (&d.n_0, &d.n_1, d.nu.sqr().recip());
    let k0 = pi_part(d) + ((&inverse + n_1.sqr()) / n_0).max(&(n_0 * 4 - n_1 * 2));
    [k0, 8 / n_1 * (inverse + (n_0 * 2 + n_1 / 3).sqr())]
}

/// `(pi^2 - 4)/2 n_1`.
fn pi_part(d: &Data<'_>) -> Interval {
    (Interval::pi(d.precision).sqr() - 4) / 2 * &d.n_1
}

/// Proves the bound, and returns the comparisons that a certificate may show; `pointer` is that of the proof.
pub fn check(
    d: &Data<'_>,
    [k0, k1]: [&Rational; 2],
    (proof, scope): (&Proof, Scope),
    pointer: &str,
) -> Outcome<Vec<Condition>> {
    let pair = [d.number(k0), d.number(k1)];
    let refuse = |message: &str| invalid(RULE, pointer, message);
    if *k1 <= 0 {
        return refuse("k1 must be positive");
    }
    let (name, steps) = match proof {
        Proof::ClosedForm => {
            let step = |(least, name): (Interval, &str), given: &Interval| {
                (format!("closed form of {name}"), least, given.clone())
            };
            let [least_0, least_1] = closed_form(d);
            ("closed-form", vec![step((least_0, "k0"), &pair[0]), step((least_1, "k1"), &pair[1])])
        }
        Proof::Matched(_) if !d.spec.regulator.matched => {
            return refuse("a matched proof needs `matched` in the specification");
        }
        Proof::Matched(k) if (1..=MAX_HARMONICS).contains(k) => {
            let mut steps = matched(d, &pair, *k);
            if scope == Scope::EverySet {
                let message = "for every set of harmonics: no K up to 4096 is seen to have (14.7c)";
                let undecided = || finding(Verdict::Undecided, RULE, pointer, message);
                steps.extend(every_set::steps(d).ok_or_else(undecided)?);
            }
            ("matched", steps)
        }
        Proof::Matched(_) => return refuse("K must lie between 1 and 4096"),
        Proof::Boxes { .. } if scope == Scope::EverySet => {
            return refuse("boxes are about the first n_o harmonics, not about every set");
        }
        Proof::Boxes { m0, n0, breaks } => {
            let count = breaks.iter().map(Vec::len).sum::<usize>();
            if *m0 < 1 || m0 > n0 || *m0 > MAX_M0 || *n0 > MAX_N0 || count > MAX_BOXES {
                return refuse("a proof by boxes needs 1 <= m0 <= N0, m0 <= 64, N0 <= 256, and at most 20000 boxes");
            }
            covers(*m0, *n0, breaks, pointer)?;
            boxes(d, &pair, *n0, breaks, pointer)?;
            let at_zero = (d.nu.sqr() * &d.n_0).recip();
            let first = ("T_N(0) = 1/(nu^2 n_0) <= k0".to_owned(), at_zero, pair[0].clone());
            let mut steps = vec![first];
            steps.extend(scalar_test(d, &pair, *m0));
            ("boxes", steps)
        }
    };
    let step = |(what, lhs, rhs)| Condition::at_most("T", format!("transfer bound, {name}: {what}"), lhs, rhs);
    let steps: Vec<Condition> = steps.into_iter().map(step).collect();
    steps.iter().try_for_each(|step| step.demand(RULE, pointer))?;
    Ok(steps)
}

/// Whether `T(k) <= 2/(nu^2 n_k)` for every k >= 1 with all oscillators that the claim is about, at a matched base frequency: of the first n_o by Lemma
/// T'', of every set by (14.7b), which a matched proof has demanded. Only the form with `q_0` asks for it.
pub fn at_poles(d: &Data<'_>, proof: &Proof, scope: Scope) -> bool {
    let proved = || match (scope, proof) {
        (Scope::First, _) | (Scope::EverySet, Proof::Matched(_)) => true,
        (Scope::EverySet, _) => every_set::holds(d),
    };
    d.spec.q_0.is_some() && d.spec.regulator.matched && proved()
}

/// Lemma T'': T_N(0) = 1/(nu^2 n_0) and T_N(k) <= 2/(nu^2 n_k) for k >= 1; by W3 n_k >= K^2 n_K/k^2 for k >= K.
fn matched(d: &Data<'_>, [k0, k1]: &[Interval; 2], tail: u32) -> Vec<Step> {
    let inverse = d.nu.sqr().recip();
    let weight = |k: u32| d.weight(u64::from(k));
    let square = |k: u32| d.int(i64::from(k)).sqr();
    let mut steps = vec![("k = 0: 1/(nu^2 n_0) <= k0".to_owned(), &inverse / &d.n_0, k0.clone())];
    for k in 1..tail {
        let what = format!("k = {k}: 2/(nu^2 n_k) <= k0 + k1 k^2");
        steps.push((what, 2 * &inverse / weight(k), k0 + k1 * square(k)));
    }
    let what = format!("every k >= {tail}: 2/(nu^2 K^2 n_K) <= k1");
    steps.push((what, 2 * inverse / (square(tail) * weight(tail)), k1.clone()));
    steps
}

/// m0 - 1/2.
fn edge(m0: u32) -> Rational {
    Rational::from((2 * i64::from(m0) - 1, 2))
}

/// N0 lists, each of increasing points from 0 to m0 - 1/2.
fn covers(m0: u32, n0: u32, breaks: &[Vec<Rational>], pointer: &str) -> Outcome<()> {
    if breaks.len() != n0 as usize {
        let message = format!("{} lists of break points, not N0 = {n0}", breaks.len());
        return invalid(RULE, &format!("{pointer}/boxes"), message);
    }
    for (index, list) in breaks.iter().enumerate() {
        let whole = list.first().is_some_and(|first| *first == 0) && list.last() == Some(&edge(m0));
        if !whole || list.windows(2).any(|pair| pair[0] >= pair[1]) {
            let message = "the break points must increase from 0 to m0 - 1/2";
            return invalid(RULE, &format!("{pointer}/boxes/{index}"), message);
        }
    }
    Ok(())
}

/// (ii) x >= m0 - 1/2, any N: with a = m0^2 n_m0, b = m0 n_m0, s = max(A_m0 - k0, 0), D = sqrt(b/(2 m0 [k1 (m0-1/2)^2 - s])),
/// `D <= 1/2` (so the root is defined) and `(2/a)(1/nu^2 + Rh^2) + s/m0^2 <= k1 (1 - D/m0)^2`.
fn scalar_test(d: &Data<'_>, [k0, k1]: &[Interval; 2], m0: u32) -> Vec<Step> {
    let (n_0, n_1) = (&d.n_0, &d.n_1);
    let (m, left) = (d.int(i64::from(m0)), d.number(&edge(m0)));
    let weight = d.weight(u64::from(m0));
    let slope = pi_part(d) + (n_0 - n_1 / 2) / left.sqr();
    let sum = (n_0 + n_1 * (d.ratio(47, 20) + d.ratio(3, 2) * m.log())) / &left + n_1 / (&m * (4 * &m - 1));
    let s = (slope - k0).max(&d.int(0));
    let distance = (&weight / ((k1 * left.sqr() - &s) * 2)).sqrt();
    let at_pole = 2 / (m.sqr() * weight) * (d.nu.sqr().recip() + sum.sqr()) + s / m.sqr();
    vec![
        (format!("scalar test, twice the distance from the pole, m0 = {m0}"), &distance * 2, d.int(1)),
        (format!("scalar test, at the pole, m0 = {m0}"), at_pole, k1 * (1 - distance / m).sqr()),
    ]
}

/// (i) Every box: [a, b] within |x - m| <= 1/2 of an integer m, and sup T <= k0 + k1 a^2 there in the pole-free form; a
/// box [0, b] may instead be proved in the form divided by x^2.
fn boxes(d: &Data<'_>, pair: &[Interval; 2], n0: u32, breaks: &[Vec<Rational>], pointer: &str) -> Outcome<()> {
    let weights: Vec<_> = (0..=u64::from(n0)).map(|l| d.weight(l)).collect();
    let half = Rational::from((1, 2));
    for (index, list) in breaks.iter().enumerate() {
        let n = index as u32 + 1;
        let tail = (n == n0).then(|| d.spec.regulator.weights.square_tail(n0, d.precision));
        let sums = Sums { d, weights: &weights[..(n as usize + usize::from(n < n0))], tail, n0: i64::from(n0) };
        for (position, ends) in list.windows(2).enumerate() {
            let (a, b) = (&ends[0], &ends[1]);
            let middle = Rational::from(a + b) / 2u32 + &half;
            let nearest = middle.floor().numer().to_u32().unwrap_or(0);
            let fits = Rational::from(a + &half) >= nearest && Rational::from(b - &half) <= nearest;
            let lhs = if fits {
                sums.bound(&Interval::between(a, b, d.precision), nearest as usize)
            } else {
                Interval::undefined(d.precision)
            };
            let relation = if n == n0 { "N >=" } else { "N =" };
            let what = format!("box [{a}, {b}], {relation} {n}");
            let step = Condition::at_most("T", what, lhs.ceiling(), &pair[0] + &pair[1] * d.number(a).sqr());
            let at_origin = *a == 0 && *b <= half && sums.origin_form(d.number(b).sqr().ceiling(), pair);
            if !at_origin {
                step.demand(RULE, &format!("{pointer}/boxes/{index}/{position}"))?;
            }
        }
    }
    Ok(())
}

/// The sums over the poles for one N, or for all N >= N0 at once.
struct Sums<'a> {
    d: &'a Data<'a>,
    /// n_0, ..., up to N, or up to N0 - 1 with the rest in `tail`.
    weights: &'a [Interval],
    /// th, for N >= N0.
    tail: Option<Interval>,
    n0: i64,
}

impl Sums<'_> {
    /// Contains T on the box around m: with d = x - m, `(c_m + R' d^2)/(d^2 + nu^2 (c_m - R d)^2)`, or
    /// `g'/(1 + nu^2 g^2)` where there is no pole m.
    fn bound(&self, x: &Interval, m: usize) -> Interval {
        let has_pole = m < self.weights.len();
        let (mut sum, mut slope) = (self.d.int(0), self.d.int(0));
        for (l, weight) in self.weights.iter().enumerate() {
            let c = if l == 0 { weight.clone() } else { weight / 2 };
            let (ahead, behind) = (l as i64 - x, l as i64 + x);
            if l != m {
                (sum, slope) = (sum + &c / &ahead, slope + &c / ahead.sqr());
            }
            if l > 0 {
                (sum, slope) = (sum - &c / &behind, slope + &c / behind.sqr());
            }
        }
        if let Some(tail) = &self.tail {
            if !has_pole {
                return Interval::undefined(self.d.precision);
            }
            let gap = 1 - (x / self.n0).sqr();
            let zero = self.d.int(0);
            sum = sum + zero.hull(&(x * tail / &gap));
            slope = slope + zero.hull(&(tail * 2 / gap.sqr()));
        }
        let nu_squared = self.d.nu.sqr();
        if !has_pole {
            return slope / (1 + nu_squared * sum.sqr());
        }
        let c = if m == 0 { self.weights[0].clone() } else { &self.weights[m] / 2 };
        let d = x - m as i64;
        let rest = &c - sum * &d;
        (c + slope * d.sqr()) / (d.sqr() + nu_squared * rest.sqr())
    }

    /// The box [0, b], b^2 = `end`, in the form divided by y = x^2: with S = sum n_l/(l^2-y), D = sum n_l (l^2+y)/(l^2-y)^2,
    /// T <= k0 + k1 y follows from k0 >= 1/(nu^2 n_0), the terms of order y^0, and
    /// `k0 (1 - 2 nu^2 n_0 S + nu^2 S^2 y) + k1 (y + nu^2 (n_0 - S y)^2) >= D`, y times the rest.
    fn origin_form(&self, end: Interval, [k0, k1]: &[Interval; 2]) -> bool {
        let y = self.d.int(0).hull(&end);
        let nu_squared = self.d.nu.sqr();
        let (mut s, mut big_d) = (self.d.int(0), self.d.int(0));
        for (l, weight) in self.weights.iter().enumerate().skip(1) {
            let square = (l * l) as i64;
            let gap = square - &y;
            s = s + weight / &gap;
            big_d = big_d + weight * (square + &y) / gap.sqr();
        }
        if let Some(tail) = &self.tail {
            let gap = 1 - &end / (self.n0 * self.n0);
            let zero = self.d.int(0);
            s = s + zero.hull(&(tail / &gap));
            big_d = big_d + zero.hull(&(tail * 2 / gap.sqr()));
        }
        let n_0 = &self.d.n_0;
        let first = 1 - 2 * &nu_squared * n_0 * &s + &nu_squared * s.sqr() * &y;
        let second = &y + &nu_squared * (n_0 - s * &y).sqr();
        let order_zero = (nu_squared * n_0).recip().le(k0) == Some(true);
        order_zero && big_d.le(&(k0 * first + k1 * second)) == Some(true)
    }
}
