//! Whether the length of a vector of expansions is at most a number everywhere on their box.
//!
//! By the sums of the sizes of the coefficients; and where that does not suffice, on halves of the box, to which the polynomials are shifted:
//! `xi = (xi' +- 1)/2`.

use super::expansion::Expansion;
use super::powers::Powers;
use proofs_core::effort;
use proofs_core::interval::Interval;
use std::collections::VecDeque;

/// The most parts of a box.
const MOST_PARTS: usize = 4_096;

/// What was found.
pub enum Found {
    /// It is.
    Within,
    /// It is not, at such xi.
    Above(Vec<Interval>),
    /// The rest, or the number of parts, is too large to tell.
    Open,
}

/// A part of a box: xi is `middle + half * xi'` in each number.
struct Part {
    place: Vec<[Interval; 2]>,
    vector: Vec<Expansion>,
}

/// Decides `|vector| <= most`.
pub fn within(powers: &Powers, vector: Vec<Expansion>, most: &Interval) -> Found {
    let p = most.precision();
    let numbers = powers.list.first().map_or(0, Vec::len);
    let zero = Interval::int(0, p);
    let norm = |of: &dyn Fn(&Expansion) -> Interval, part: &Part| {
        part.vector.iter().fold(zero.clone(), |sum, one| sum + of(one).sqr()).sqrt()
    };
    let place = vec![[zero.clone(), Interval::int(1, p)]; numbers];
    let mut queue = VecDeque::from([Part { place, vector }]);
    let mut count = 0;
    // The largest first.
    while let Some(part) = queue.pop_front() {
        count += 1;
        if norm(&|one| one.first().abs() + one.apart(), &part).le(most) == Some(true) {
            continue;
        }
        let least = |one: &Expansion| (one.first().abs().floor() - &one.rest).max(&zero).floor();
        if most.lt(&norm(&least, &part)) == Some(true) {
            return Found::Above(part.place.into_iter().map(|[middle, _]| middle).collect());
        }
        let at_middle = norm(&|one| one.first().abs() + &one.rest, &part);
        if at_middle.le(most) != Some(true) || count > MOST_PARTS || effort::exhausted() {
            return Found::Open;
        }
        let shares = shares(powers, &part.vector, numbers, 1);
        let Some((number, _)) = shares.into_iter().enumerate().max_by(|a, b| a.1.total_cmp(&b.1)) else {
            return Found::Open;
        };
        queue.extend([-1, 1].map(|side| half(powers, &part, number, side)));
    }
    Found::Within
}

/// How much each number adds to the sizes of the coefficients from a degree on: a hint.
pub fn shares(powers: &Powers, vector: &[Expansion], numbers: usize, from: usize) -> Vec<f64> {
    let mut shares = vec![0.0; numbers];
    for (place, value) in vector.iter().flat_map(|one| one.coefficients.iter().enumerate()) {
        let degree = powers.degree_of(place);
        if degree >= from.max(1) && !value.is_zero() {
            let own = value.to_f64().abs() / degree as f64;
            shares
                .iter_mut()
                .zip(&powers.list[place])
                .for_each(|(share, exponent)| *share += own * f64::from(*exponent));
        }
    }
    shares
}

/// The lower (-1) or the upper half (1) of a part along a number.
fn half(powers: &Powers, part: &Part, number: usize, side: i64) -> Part {
    let mut place = part.place.clone();
    let [middle, width] = &place[number];
    let width = width / 2;
    place[number] = [middle + &width * side, width];
    let vector = part.vector.iter().map(|one| shifted(powers, one, number, side)).collect();
    Part { place, vector }
}

/// With `xi = (xi' + side)/2` for one number: by Horner's scheme for the powers of it.
fn shifted(powers: &Powers, one: &Expansion, number: usize, side: i64) -> Expansion {
    let mut coefficients = one.coefficients.clone();
    let count = coefficients.len();
    for first in (0..count).filter(|place| powers.list[*place][number] == 0) {
        let next = |place: &usize| powers.raised(*place, number).filter(|place| *place < count);
        let line: Vec<usize> = std::iter::successors(Some(first), next).collect();
        for (k, place) in line.iter().enumerate().skip(1) {
            coefficients[*place] = &coefficients[*place] / (1_i64 << k);
        }
        for from in 0..line.len() - 1 {
            for pair in line[from..].windows(2).rev() {
                let [low, high] = [pair[0], pair[1]].map(|place| &coefficients[place]);
                coefficients[pair[0]] = if side < 0 { low - high } else { low + high };
            }
        }
    }
    Expansion { coefficients, rest: one.rest.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rug::Rational;

    fn number(numerator: i64, denominator: i64) -> Interval {
        Interval::rational(&Rational::from((numerator, denominator)), 53)
    }

    /// By coefficients of powers.
    fn expansion(powers: &Powers, terms: &[(&[u32], i64)], rest: Interval) -> Expansion {
        let of = |alpha: &Vec<u32>| terms.iter().find(|term| term.0 == alpha).map_or(0, |term| term.1);
        Expansion { coefficients: powers.list.iter().map(|alpha| number(of(alpha), 1)).collect(), rest }
    }

    fn value(powers: &Powers, one: &Expansion, xi: &[Interval]) -> Interval {
        powers.list.iter().zip(&one.coefficients).fold(number(0, 1), |sum, (alpha, a)| {
            sum + alpha.iter().zip(xi).fold(a.clone(), |term, (n, xi)| term * xi.powi(*n as i32))
        })
    }

    #[test]
    fn a_half_has_the_same_values() {
        let powers = Powers::new(2, 5);
        let whole = Expansion {
            coefficients: (1..).zip(&powers.list[..18]).map(|(k, _)| number(k * k % 7 - 3, 1)).collect(),
            rest: number(1, 8),
        };
        for (which, side) in [(0, -1), (0, 1), (1, -1), (1, 1)] {
            let half = shifted(&powers, &whole, which, side);
            assert!(half.rest.le(&whole.rest) == Some(true) && whole.rest.le(&half.rest) == Some(true));
            for (x, y) in [(1, 1), (-1, 1), (0, 0), (1, 0), (0, -1), (-1, -1)] {
                let xi = [number(x, 1), number(y, 1)];
                let mut there = xi.clone();
                there[which] = (&xi[which] + side) / 2;
                let [found, right] = [value(&powers, &half, &xi), value(&powers, &whole, &there)];
                assert!(found.is_point() && found.contains(&right), "{which} {side} {x} {y}");
            }
        }
    }

    /// Of Chebyshev's polynomials the sizes of the coefficients are far above the largest value, 1.
    #[test]
    fn the_largest_value_decides() {
        let powers = Powers::new(2, 5);
        let fifth: &[(&[u32], i64)] = &[(&[0, 1], 5), (&[0, 3], -20), (&[0, 5], 16)];
        let decide = |most: Interval, rest: Interval| {
            let vector = vec![expansion(&powers, fifth, rest)];
            within(&powers, vector, &most)
        };
        let [zero, share] = [number(0, 1), number(1, 1000)];
        assert!(matches!(decide(number(1001, 1000), zero.clone()), Found::Within));
        // A claim below it is refuted, at a place where that is seen.
        let Found::Above(place) = decide(number(999, 1000), zero.clone()) else { panic!() };
        let there = value(&powers, &expansion(&powers, fifth, zero.clone()), &place);
        assert!(number(999, 1000).lt(&there.abs()) == Some(true));
        // The rest counts, and what lies within it is open.
        assert!(matches!(decide(number(1003, 1000), share.clone()), Found::Within));
        assert!(matches!(decide(number(10005, 10000), share.clone()), Found::Open));
        assert!(matches!(decide(number(9995, 10000), share), Found::Open));
        assert!(matches!(decide(number(2, 1), Interval::undefined(53)), Found::Open));
        // Exactly nothing is at most nothing.
        assert!(matches!(within(&powers, vec![expansion(&powers, &[], zero.clone())], &zero), Found::Within));
        assert!(matches!(within(&powers, vec![expansion(&powers, &[], zero)], &number(-1, 1)), Found::Above(_)));
    }

    /// It is the length that counts: (3 xi_0, 4 xi_1) reaches 5 in the corners, and (x y, x - y) the root of 5.
    #[test]
    fn the_length_of_a_vector() {
        let powers = Powers::new(2, 2);
        let one = |terms: &[(&[u32], i64)]| expansion(&powers, terms, number(0, 1));
        let corners = || vec![one(&[(&[1, 0], 3)]), one(&[(&[0, 1], 4)])];
        assert!(matches!(within(&powers, corners(), &number(50001, 10000)), Found::Within));
        assert!(matches!(within(&powers, corners(), &number(49, 10)), Found::Above(_)));
        let mixed = || vec![one(&[(&[1, 1], 1)]), one(&[(&[1, 0], 1), (&[0, 1], -1)])];
        assert!(matches!(within(&powers, mixed(), &number(2237, 1000)), Found::Within));
        assert!(matches!(within(&powers, mixed(), &number(22, 10)), Found::Above(_)));
    }
}
