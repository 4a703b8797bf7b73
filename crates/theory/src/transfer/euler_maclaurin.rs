//! The poles from L on, summed by the Euler-Maclaurin formula: the cost does not grow with their number.
//!
//! For 0 <= x < L the sums are over s = L, L + 1, ..., N (N may be infinite) of
//!
//! `f(s) = s^-p x/(s^2 - x^2)` and its derivative in x, `f_x(s) = s^-p (1/(s-x)^2 + 1/(s+x)^2)/2`, and with K >= 0
//!
//! `sum = int_L^N f ds + (f(L) + f(N))/2 + sum_{k=1}^{K} B_2k/(2k)! (f^(2k-1)(N) - f^(2k-1)(L)) + R_K`,
//! `R_K = int_L^N (B_{2K+2} - B_{2K+2}({s}))/(2K+2)! f^(2K+2)(s) ds`.
//!
//! **The remainder lies between 0 and the first omitted term, T_{K+1}.** On s > x the functions s^-p, 1/(s-x), 1/(s+x)
//! are completely monotone, so their products and sums f/x and f_x are, and every even derivative is >= 0. The factor
//! B_2m - B_2m({s}) has the sign of B_2m, which alternates in m. So R_K has the sign of B_{2K+2}, R_{K+1} the opposite
//! one, and R_K - R_{K+1} = T_{K+1} gives 0 <= R_K/T_{K+1} <= 1. Hence K is a matter of width, never of soundness.
//!
//! f^(j)(s) = (-1)^j j! b_j, where b_j >= 0 are the Taylor coefficients in -t of f(s + t); dividing a series by
//! (s - x) + t is one recurrence without cancellation. The integrals are geometric series, see [`integrals`].

use rug::float::Round;
use rug::{Float, Integer, Rational};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::bernoulli_over_factorial;

/// One end of the range of summation: s and s^-p.
#[derive(Clone, Debug)]
pub(super) struct End {
    /// s.
    pub(super) at: Enclosure,
    /// s^-p.
    pub(super) power: Enclosure,
}

/// `sum_{s=L}^{N} f(s)` and `sum_{s=L}^{N} f_x(s)` for every x in the enclosure; no `end` means N infinite.
///
/// Hypotheses: 0 <= x < L proved by the enclosures (undefined otherwise), L <= N, p > 1, and `bernoulli` from
/// [`bernoulli_over_index`]. The corrections end at the last number given, when they are negligible, or when they grow;
/// of the series for the integrals at most `terms` terms are added.
pub(super) fn tail_sums(
    x: &Enclosure,
    p: &Enclosure,
    (start, end): (&End, Option<&End>),
    bernoulli: &[Enclosure],
    terms: u32,
) -> [Enclosure; 2] {
    let work = p.precision();
    let below = Enclosure::zero(2).le(x).and(x.lt(&start.at)).is_true();
    let Some((first, others)) = bernoulli.split_first().filter(|_| below) else {
        return [Enclosure::undefined(work), Enclosure::undefined(work)];
    };
    let mut at_start = Derivatives::new(x, p, start);
    let mut at_end = end.map(|end| Derivatives::new(x, p, end));
    let mut sums = integrals(x, p, (start, end), terms);
    let values = [Some(at_start.step()), at_end.as_mut().map(Derivatives::step)];
    for value in values.into_iter().flatten() {
        sums = pairwise(&sums, &value, |sum, value| sum + value / 2);
    }
    // B_2k/(2k)! (f^(2k-1)(N) - f^(2k-1)(L)) = B_2k/(2k) (b_{2k-1}(L) - b_{2k-1}(N)).
    let mut difference = |steps: usize| {
        let advance = |series: &mut Derivatives| (1..steps).fold(series.step(), |_, _| series.step());
        let left = advance(&mut at_start);
        match at_end.as_mut().map(advance) {
            Some(right) => pairwise(&left, &right, |left, right| left - right),
            None => left,
        }
    };
    let mut omitted = difference(1).map(|d| first * d);
    for number in others {
        if omitted.iter().zip(&sums).all(|(term, sum)| is_negligible(term, sum, work)) {
            break;
        }
        let next = difference(2).map(|d| number * d);
        // The corrections of f_x, with its double pole, are the first to grow.
        if !next[1].abs().lt(&omitted[1].abs()).is_true() {
            break;
        }
        sums = pairwise(&sums, &omitted, |sum, term| sum + term);
        omitted = next;
    }
    pairwise(&sums, &omitted, |sum, term| sum + term.hull(&Enclosure::zero(work)))
}

fn pairwise(a: &[Enclosure; 2], b: &[Enclosure; 2], f: impl Fn(&Enclosure, &Enclosure) -> Enclosure) -> [Enclosure; 2] {
    [f(&a[0], &b[0]), f(&a[1], &b[1])]
}

/// Whether a term is below the last bits of the sum: more of them would not make the result narrower.
fn is_negligible(term: &Enclosure, sum: &Enclosure, work: u32) -> bool {
    term.abs().upper() <= Float::with_val_round(work, sum.lower() >> work, Round::Down).0
}

/// `int_L^N f ds = x sum_j I_j` and `int_L^N f_x ds = sum_j (2j+1) I_j`, where
/// `I_j = x^2j int_L^N s^-(p+2j+2) ds = x^2j (L^-(p+2j+1) - N^-(p+2j+1))/(p+2j+1)`.
///
/// Remainder after j < J: I_j >= 0 and I_{j+1} <= q I_j with q = (x/L)^2 < 1, because s >= L. So the omitted parts lie in
/// [0, I_J/(1-q)] and [0, I_J ((2J+1)/(1-q) + 2q/(1-q)^2)].
fn integrals(x: &Enclosure, p: &Enclosure, (start, end): (&End, Option<&End>), terms: u32) -> [Enclosure; 2] {
    let work = p.precision();
    let zero = Enclosure::zero(work);
    let leading = |end: &End| (&end.power / &end.at, (x / &end.at).sqr());
    let (mut at_start, q) = leading(start);
    let mut at_end = end.map(leading);
    let room = (1 - &q).recip();
    let curvature = 2 * &q * room.sqr();
    let (mut value, mut slope) = (zero.clone(), zero.clone());
    for j in 0_u32.. {
        let odd = i64::from(j) * 2 + 1;
        let difference = at_end.as_ref().map_or_else(|| at_start.clone(), |(power, _)| &at_start - power);
        let term = difference / (p + odd);
        let rest = [&term * &room, &term * (odd * &room + &curvature)];
        if j >= terms || (is_negligible(&rest[0], &value, work) && is_negligible(&rest[1], &slope, work)) {
            let [rest_value, rest_slope] = rest.map(|rest| rest.hull(&zero));
            value = value + rest_value;
            slope = slope + rest_slope;
            break;
        }
        slope = slope + odd * &term;
        value = value + term;
        at_start = at_start * &q;
        at_end = at_end.map(|(power, q)| (power * &q, q));
    }
    [x * value, slope]
}

/// The Taylor coefficients b_0, b_1, ... in -t of f(s + t) and f_x(s + t), one after the other.
struct Derivatives<'a> {
    x: &'a Enclosure,
    p: &'a Enclosure,
    /// 1/s, 1/(s - x), 1/(s + x).
    inverse: [Enclosure; 3],
    index: i64,
    /// The next coefficient of s^-p.
    power: Enclosure,
    /// The last coefficients of s^-p times 1/(s-x), 1/(s-x)^2, 1/(s+x), 1/(s+x)^2, 1/((s-x)(s+x)).
    last: [Enclosure; 5],
}

impl<'a> Derivatives<'a> {
    fn new(x: &'a Enclosure, p: &'a Enclosure, end: &End) -> Derivatives<'a> {
        let zero = || Enclosure::zero(p.precision());
        Derivatives {
            x,
            p,
            inverse: [end.at.recip(), (&end.at - x).recip(), (&end.at + x).recip()],
            index: 0,
            power: end.power.clone(),
            last: [zero(), zero(), zero(), zero(), zero()],
        }
    }

    /// The next pair of coefficients. If a(t) = sum (-t)^j a_j then a(t)/(d + t) has b_j = (a_j + b_{j-1})/d.
    fn step(&mut self) -> [Enclosure; 2] {
        let [inverse, behind, ahead] = &self.inverse;
        let [b, bb, a, aa, ab] = &self.last;
        let b = (&self.power + b) * behind;
        let bb = (&b + bb) * behind;
        let a = (&self.power + a) * ahead;
        let aa = (&a + aa) * ahead;
        let ab = (&b + ab) * ahead;
        let pair = [self.x * &ab, (&bb + &aa) / 2];
        self.last = [b, bb, a, aa, ab];
        self.power = &self.power * (self.p + self.index) * inverse / (self.index + 1);
        self.index += 1;
        pair
    }
}

/// B_2k/(2k) for k = 1, ..., `count`, each exact before it is rounded outward.
pub(super) fn bernoulli_over_index(count: usize, precision: u32) -> Vec<Enclosure> {
    let mut factorial = Integer::from(1);
    let exact = |(index, number): (usize, Rational)| {
        // (2k - 1)! from (2k - 3)!.
        let k = index as u64 + 1;
        factorial *= (2 * k - 1) * (2 * k - 2).max(1);
        Enclosure::from_rational(&(number * &factorial), precision)
    };
    bernoulli_over_factorial(count).into_iter().enumerate().map(exact).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const WORK: u32 = 160;

    fn rational(numerator: i64, denominator: i64, precision: u32) -> Enclosure {
        Enclosure::from_rational(&Rational::from((numerator, denominator)), precision)
    }

    fn end(s: u64, p: &Enclosure) -> End {
        let at = Enclosure::from_integer(s as i64, p.precision());
        End { power: at.pow(&-p), at }
    }

    /// The two sums term by term, at 300 bits.
    fn direct(x: (i64, i64), p: (i64, i64), first: u64, last: u64) -> [Enclosure; 2] {
        let (x, p) = (rational(x.0, x.1, 300), rational(p.0, p.1, 300));
        let zero = || Enclosure::zero(300);
        (first..=last).fold([zero(), zero()], |[value, slope], l| {
            let s = Enclosure::from_integer(l as i64, 300);
            let (power, gap) = (s.pow(&-&p), s.sqr() - x.sqr());
            [value + &power * &x / &gap, slope + power * (s.sqr() + x.sqr()) / gap.sqr()]
        })
    }

    fn contains(outer: &Enclosure, inner: &Enclosure) -> bool {
        outer.lower() <= inner.lower() && inner.upper() <= outer.upper()
    }

    fn width(value: &Enclosure) -> f64 {
        Float::with_val(64, value.upper() - value.lower()).to_f64()
    }

    const CASES: [((i64, i64), (i64, i64)); 5] =
        [((0, 1), (3, 2)), ((1, 3), (3, 2)), ((7, 2), (2, 1)), ((21, 5), (1001, 1000)), ((9, 2), (11, 10))];

    #[test]
    fn contains_the_direct_sum_from_every_start() {
        let bernoulli = bernoulli_over_index(40, WORK);
        for (x, p) in CASES {
            let (x_near, p_near) = (rational(x.0, x.1, WORK), rational(p.0, p.1, WORK));
            for (first, last) in [(5, 6), (5, 5), (6, 90), (12, 400), (30, 2000), (40, 41), (48, 700)] {
                let ends = (end(first, &p_near), end(last, &p_near));
                let sums = tail_sums(&x_near, &p_near, (&ends.0, Some(&ends.1)), &bernoulli, 400);
                let truth = direct(x, p, first, last);
                for (sum, truth) in sums.iter().zip(&truth) {
                    assert!(contains(sum, truth), "x {x:?}, p {p:?}, {first}..{last}: {sum:?} {truth:?}");
                    assert!(first < 40 || width(sum) < 1e-44, "x {x:?}, p {p:?}, {first}..{last}: {}", width(sum));
                }
            }
        }
    }

    /// The remainders are where soundness lies: every early cut contains the truth, and more terms are narrower.
    #[test]
    fn every_cut_is_sound() {
        let bernoulli = bernoulli_over_index(12, WORK);
        for (x, p) in CASES {
            let (x_near, p_near) = (rational(x.0, x.1, WORK), rational(p.0, p.1, WORK));
            for (first, last) in [(5, 9), (6, 60), (9, 500)] {
                let ends = (end(first, &p_near), end(last, &p_near));
                let truth = direct(x, p, first, last);
                let sums = |corrections: usize, terms: u32| {
                    tail_sums(&x_near, &p_near, (&ends.0, Some(&ends.1)), &bernoulli[..corrections], terms)
                };
                for corrections in 1..=bernoulli.len() {
                    for terms in [0, 1, 2, 5, 20, 400] {
                        let cut = sums(corrections, terms);
                        let fits = cut.iter().zip(&truth).all(|(sum, truth)| contains(sum, truth));
                        assert!(fits, "x {x:?}, p {p:?}, {first}..{last}, {corrections} corrections, {terms} terms");
                    }
                }
                if x.0 > 0 && first == 9 {
                    for index in 0..2 {
                        assert!(width(&sums(3, 400)[index]) < width(&sums(1, 400)[index]) / 2.0);
                        assert!(width(&sums(3, 5)[index]) < width(&sums(3, 1)[index]) / 2.0);
                    }
                }
            }
        }
    }

    #[test]
    fn infinitely_many_poles_are_the_limit() {
        let bernoulli = bernoulli_over_index(40, WORK);
        for (x, p) in CASES {
            let (x, p) = (rational(x.0, x.1, WORK), rational(p.0, p.1, WORK));
            let start = end(40, &p);
            let all = tail_sums(&x, &p, (&start, None), &bernoulli, 400);
            let rest = tail_sums(&x, &p, (&end(100_001, &p), None), &bernoulli, 400);
            let part = tail_sums(&x, &p, (&start, Some(&end(100_000, &p))), &bernoulli, 400);
            for ((all, part), rest) in all.iter().zip(part).zip(rest) {
                assert!((part + rest).intersect(all).is_defined() && width(all) < 1e-44, "{all:?}");
            }
        }
        // x = 0, p = 2: sum_{s >= 1} s^-4 = pi^4/90.
        let p = Enclosure::from_integer(2, WORK);
        let zero = Enclosure::zero(WORK);
        let [value, slope] = tail_sums(&zero, &p, (&end(40, &p), None), &bernoulli, 400);
        let head = direct((0, 1), (2, 1), 1, 39);
        let expected = Enclosure::pi(300).sqr().sqr() / 90 - &head[1];
        assert!(value.is_exact() && value.contains_zero() && contains(&slope, &expected));
    }

    #[test]
    fn hypotheses_are_enforced() {
        let bernoulli = bernoulli_over_index(4, WORK);
        let p = rational(3, 2, WORK);
        let start = end(5, &p);
        let beyond = [rational(5, 1, WORK), rational(11, 2, WORK), rational(-1, 10, WORK), Enclosure::undefined(WORK)];
        let wide = Enclosure::between(&Rational::from(4), &Rational::from(6), WORK);
        for x in beyond.into_iter().chain([wide]) {
            let sums = tail_sums(&x, &p, (&start, None), &bernoulli, 400);
            assert!(sums.iter().all(|sum| !sum.is_defined()), "{x:?}");
        }
        let without = tail_sums(&rational(1, 2, WORK), &p, (&start, None), &[], 400);
        assert!(without.iter().all(|sum| !sum.is_defined()));
    }

    #[test]
    fn bernoulli_numbers_are_the_known_ones() {
        let known = [(1, 6), (-1, 30), (1, 42), (-1, 30), (5, 66), (-691, 2730), (7, 6), (-3617, 510)];
        for (index, (value, known)) in bernoulli_over_index(8, WORK).iter().zip(known).enumerate() {
            let exact = Rational::from(known) / (2 * index as u32 + 2);
            assert!(*value == Enclosure::from_rational(&exact, WORK), "{index}");
        }
    }
}
