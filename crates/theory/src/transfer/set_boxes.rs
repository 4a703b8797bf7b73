//! A proof by boxes of T_H(x) <= k0 + k1 x^2 for every finite set H of harmonics that contains 0 and every x >= 0, once for all H (derivation, 14.7).

use super::boxes::{MAX_BOXES, MAX_M0, MAX_N0, covers, nearest_pole, scalar_test};
use super::decide_steps;
use super::set_sums::SetSums;
use crate::condition::Condition;
use crate::data::Data;
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_exact::parallel;
use std::cmp::Ordering;

/// The proof as data: consecutive boxes cover [0, m0 - 1/2], and one scalar test settles x >= m0 - 1/2.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SetBoxProof {
    /// m0 >= 1.
    pub m0: u32,
    /// N0 >= m0: harmonics below it are added one by one.
    pub n0: u32,
    /// Increasing break points from 0 to m0 - 1/2.
    pub breaks: Vec<Rational>,
}

/// The two sides on one box: the supremum of T_H over it and every H, and k0 + k1 a^2 at its left end a; or, for a box that starts at 0 where these do not
/// prove it, the two sides of the form divided by x^2.
pub(super) fn sides(
    data: &Data<'_>,
    sums: &SetSums,
    [a, b]: [&Rational; 2],
    pair: [&Enclosure; 2],
) -> (Enclosure, Enclosure) {
    let value = match nearest_pole([a, b]) {
        Some(nearest) => sums.supremum(&Enclosure::between(a, b, data.precision), nearest),
        None => Enclosure::undefined(data.precision),
    };
    let (lhs, rhs) = (value.ceiling(), pair[0] + pair[1] * data.rational(a).sqr());
    if a.cmp0() == Ordering::Equal && !lhs.le(&rhs).is_true() {
        return sums.near_zero(&data.rational(b), pair);
    }
    (lhs, rhs)
}

impl SetBoxProof {
    /// The number of boxes.
    #[must_use]
    pub fn boxes(&self) -> usize {
        self.breaks.len().saturating_sub(1)
    }

    /// Decides the proof: coverage without gaps, every box, the scalar test, and k0 >= T_H(0).
    ///
    /// Hypotheses: W1-W3. Guarantee: `True` means T_H(x) <= k0 + k1 x^2 for every finite set H of harmonics that contains 0 and every x >= 0.
    #[must_use]
    pub fn decide(&self, data: &Data<'_>, k0: &Rational, k1: &Rational) -> (Truth, Condition) {
        let refuse = |what| (Truth::False, Condition::at_most("T", what, Enclosure::one(data.precision), data.zero()));
        let in_bounds = (1..=self.n0).contains(&self.m0)
            && self.n0 <= MAX_N0
            && self.m0 <= MAX_M0
            && self.boxes() <= MAX_BOXES
            && *k1 > 0;
        if !in_bounds {
            return refuse("a proof by boxes needs 1 <= m0 <= N0, k1 > 0, and bounded numbers of poles and boxes");
        }
        if !covers(&self.breaks, self.m0) {
            return refuse("the boxes must cover [0, m0 - 1/2] in order");
        }
        let sums = SetSums::new(data, self.n0);
        let (k0, k1) = (data.rational(k0), data.rational(k1));
        let at_zero = Condition::at_most("T", "T_H(0) = 1/(nu^2 n_0) <= k0", data.transfer_at_zero(), k0.clone());
        let mut steps = vec![at_zero.clone()];
        steps.extend(scalar_test(data, &k0, &k1, self.m0));
        if steps.iter().all(|step| step.truth().is_true()) {
            let boxes: Vec<[&Rational; 2]> = self.breaks.windows(2).map(|pair| [&pair[0], &pair[1]]).collect();
            steps.extend(parallel::map(&boxes, |[a, b]| {
                let (lhs, rhs) = sides(data, &sums, [a, b], [&k0, &k1]);
                Condition::at_most("T", format!("box [{a}, {b}], every set of harmonics"), lhs, rhs)
            }));
        }
        decide_steps(steps, at_zero)
    }
}

#[cfg(test)]
mod tests {
    use super::super::boxes::edge;
    use super::super::weights_only::weights_only;
    use super::super::{BoxProof, smallest_k1, smallest_k1_for_every_set};
    use super::*;

    fn rational(text: &str) -> Rational {
        sigmastar_exact::number::parse_decimal(text).unwrap()
    }

    /// The values of 14.7, which a floating-point search found: with k0 = 7 and nu = 1 k1 = 17.85, for the first harmonics alone 17.58; with k0 = 19.74 and
    /// nu = 1/(2 pi) 74.36 and 74.32.
    #[test]
    fn the_pairs_are_those_of_the_derivation() {
        for (frequency, k0, [every_set, first]) in [("1", "7", [17.85, 17.58]), ("2*pi", "19.74", [74.36, 74.32])] {
            let spec = weights_only("2", "1/2", "1", frequency);
            let data = Data::new(&spec, 128);
            let k0 = rational(k0);
            let pair = smallest_k1_for_every_set(&data, &k0).unwrap();
            assert_eq!(pair.proof.decide(&data, &pair.k0, &pair.k1).0, Truth::True);
            let (k1, of_first) = (pair.k1.to_f64(), smallest_k1(&data, &k0).unwrap().k1.to_f64());
            assert!((k1 / every_set - 1.0).abs() < 2e-3 && k1 > of_first, "{k1} {of_first}");
            assert!((of_first / first - 1.0).abs() < 2e-3, "{of_first}");
        }
    }

    /// A pair for the first harmonics alone is not proved; none is proved that a set with gaps exceeds.
    #[test]
    fn what_serves_the_first_harmonics_need_not_serve_every_set() {
        let spec = weights_only("2", "1/2", "1", "1");
        let data = Data::new(&spec, 128);
        let (k0, k1) = (rational("7"), rational("17.7"));
        assert!(BoxProof::find(&data, &k0, &k1).is_some());
        assert_eq!(SetBoxProof::find(&data, &k0, &k1), None);
    }

    #[test]
    fn damaged_proofs_are_refused() {
        let spec = weights_only("2", "1/2", "1", "1");
        let data = Data::new(&spec, 128);
        let (k0, k1) = (rational("7"), rational("18"));
        let proof = SetBoxProof::find(&data, &k0, &k1).unwrap();
        assert_eq!(proof.decide(&data, &k0, &k1).0, Truth::True);
        let change = |f: &dyn Fn(&mut SetBoxProof)| {
            let mut other = proof.clone();
            f(&mut other);
            other
        };
        for (what, other) in [
            ("one wide box", change(&|p| p.breaks = vec![Rational::new(), edge(p.m0)])),
            ("a missing end", change(&|p| drop(p.breaks.pop()))),
            ("a late start", change(&|p| p.breaks[0] = Rational::from((1, 100)))),
            ("a reversal", change(&|p| p.breaks.swap(1, 2))),
            ("nothing", change(&|p| p.breaks.clear())),
            ("N0 below m0", change(&|p| p.n0 = p.m0 - 1)),
            ("m0 = 0", change(&|p| p.m0 = 0)),
            ("too many harmonics", change(&|p| p.n0 = u32::MAX)),
        ] {
            assert_ne!(other.decide(&data, &k0, &k1).0, Truth::True, "{what}");
        }
        for (k0, k1) in [("0.49", "100"), ("7", "17.5"), ("7", "-1")] {
            assert_ne!(proof.decide(&data, &rational(k0), &rational(k1)).0, Truth::True, "{k0} {k1}");
        }
    }

    /// k0 = T_H(0) itself is reached, and no k0 below it.
    #[test]
    fn the_least_k0_has_a_pair() {
        for (n0, epsilon, frequency) in [("2", "1/2", "1"), ("2", "1", "2*pi"), ("3", "1/10", "1/5")] {
            let spec = weights_only(n0, epsilon, "1", frequency);
            let data = Data::new(&spec, 128);
            let k0 = data.transfer_at_zero().upper_rational().unwrap();
            assert!(smallest_k1_for_every_set(&data, &k0).is_some(), "{n0} {epsilon} {frequency}");
            assert!(smallest_k1_for_every_set(&data, &(k0 * Rational::from((99, 100)))).is_none());
        }
    }
}
