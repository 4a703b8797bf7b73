//! A proof by boxes of T_N(x) <= k0 + k1 x^2 for every N and every x >= 0 (derivation, section 2, "certified").

use super::decide_steps;
use super::lorentz::{LorentzSums, OscillatorRange, weight_tail};
use crate::condition::Condition;
use crate::data::Data;
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_exact::parallel;
use std::cmp::Ordering;

/// The largest N0 that is tried or accepted.
pub const MAX_N0: u32 = 256;
/// The largest m0 that is tried or accepted.
pub const MAX_M0: u32 = 64;
/// The most boxes that a proof may have.
pub const MAX_BOXES: usize = 20_000;

/// The proof as data: the region [0, m0 - 1/2] is covered by consecutive boxes for each N = 1, ..., N0 - 1 and for all
/// N >= N0 together, and one scalar test settles x >= m0 - 1/2.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BoxProof {
    /// m0 >= 1.
    pub m0: u32,
    /// N0 >= m0.
    pub n0: u32,
    /// N0 lists of increasing break points from 0 to m0 - 1/2: for N = 1, ..., N0 - 1, then for N >= N0.
    pub breaks: Vec<Vec<Rational>>,
}

/// m0 - 1/2.
pub(super) fn edge(m0: u32) -> Rational {
    Rational::from((2 * i64::from(m0) - 1, 2))
}

/// Which oscillators the list with this index is about.
pub(super) fn group(data: &Data<'_>, n0: u32, index: usize) -> OscillatorRange {
    if index + 1 == n0 as usize {
        OscillatorRange::AtLeast { first: n0, tail: weight_tail(data, n0) }
    } else {
        OscillatorRange::Exactly(index as u32 + 1)
    }
}

/// The integer m with [a, b] in [m - 1/2, m + 1/2]: the nearest one of the middle, where the box does not reach beyond its half-integers.
pub(super) fn nearest_pole([a, b]: [&Rational; 2]) -> Option<u32> {
    let half = Rational::from((1, 2));
    let nearest = (Rational::from(a + b) / 2u32 + &half).floor();
    let fits = Rational::from(&nearest - &half) <= *a && *b <= Rational::from(&nearest + &half);
    nearest.numer().to_u32().filter(|_| fits)
}

/// Whether break points cover [0, m0 - 1/2] in order.
pub(super) fn covers(breaks: &[Rational], m0: u32) -> bool {
    breaks.first().is_some_and(|first| first.cmp0() == Ordering::Equal)
        && breaks.last() == Some(&edge(m0))
        && breaks.windows(2).all(|pair| pair[0] < pair[1])
}

/// The two sides on one box: the supremum of T over it, and k0 + k1 a^2 at its left end a; or, for a box that starts
/// at 0 where these do not prove it, the two sides of the form divided by x^2.
pub(super) fn sides(
    data: &Data<'_>,
    sums: &LorentzSums,
    oscillators: &OscillatorRange,
    [a, b]: [&Rational; 2],
    pair: [&Enclosure; 2],
) -> (Enclosure, Enclosure) {
    let value = match nearest_pole([a, b]) {
        Some(nearest) => sums.enclose(&Enclosure::between(a, b, data.precision), nearest, oscillators),
        None => Enclosure::undefined(data.precision),
    };
    let (lhs, rhs) = (value.ceiling(), pair[0] + pair[1] * data.rational(a).sqr());
    if a.cmp0() == Ordering::Equal && !lhs.le(&rhs).is_true() {
        return sums.near_zero(&data.rational(b), oscillators, pair);
    }
    (lhs, rhs)
}

impl BoxProof {
    /// The number of boxes.
    #[must_use]
    pub fn boxes(&self) -> usize {
        self.breaks.iter().map(|breaks| breaks.len().saturating_sub(1)).sum()
    }

    /// Decides the proof: coverage without gaps, every box, the scalar test, and k0 >= T_N(0).
    ///
    /// Hypotheses: W1-W3. Guarantee: `True` means T_N(x) <= k0 + k1 x^2 for every N >= 0 and every x >= 0.
    #[must_use]
    pub fn decide(&self, data: &Data<'_>, k0: &Rational, k1: &Rational) -> (Truth, Condition) {
        let refuse = |what| (Truth::False, Condition::at_most("T", what, Enclosure::one(data.precision), data.zero()));
        if !(1..=self.n0).contains(&self.m0)
            || self.n0 > MAX_N0
            || self.m0 > MAX_M0
            || self.boxes() > MAX_BOXES
            || *k1 <= 0
        {
            return refuse("a proof by boxes needs 1 <= m0 <= N0, k1 > 0, and bounded numbers of poles and boxes");
        }
        if self.breaks.len() != self.n0 as usize || !self.breaks.iter().all(|breaks| covers(breaks, self.m0)) {
            return refuse("the boxes must cover [0, m0 - 1/2] in order, once for each N < N0 and once for N >= N0");
        }
        let sums = LorentzSums::new(data, self.n0);
        let (k0, k1) = (data.rational(k0), data.rational(k1));
        let at_zero = Condition::at_most("T", "T_N(0) = 1/(nu^2 n_0) <= k0", data.transfer_at_zero(), k0.clone());
        let mut steps = vec![at_zero.clone()];
        steps.extend(scalar_test(data, &k0, &k1, self.m0));
        if steps.iter().all(|step| step.truth().is_true()) {
            let boxes = |index: usize| {
                let oscillators = group(data, self.n0, index);
                let relation = if index + 1 == self.n0 as usize { "N >=" } else { "N =" };
                let one = |pair: &[Rational]| {
                    let (lhs, rhs) = sides(data, &sums, &oscillators, [&pair[0], &pair[1]], [&k0, &k1]);
                    let what = format!("box [{}, {}], {relation} {}", pair[0], pair[1], index + 1);
                    Condition::at_most("T", what, lhs, rhs)
                };
                self.breaks[index].windows(2).map(one).collect::<Vec<Condition>>()
            };
            // In the order of the lists, whatever the number of threads.
            steps.extend(parallel::numbered(self.breaks.len(), boxes).into_iter().flatten());
        }
        decide_steps(steps, at_zero)
    }
}

/// The scalar test for x >= m0 - 1/2 and any N, as comparisons (derivation, section 2, (ii)): with a = m0^2 n_m0,
/// b = m0 n_m0, s = max(A_m0 - k0, 0) and d = sqrt(b/(2 m0 [k1 (m0-1/2)^2 - s])),
/// `s < k1 (m0-1/2)^2`, `d <= 1/2` and `(2/a)(1/nu^2 + Rh^2) + s/m0^2 <= k1 (1 - d/m0)^2`.
pub(super) fn scalar_test(data: &Data<'_>, k0: &Enclosure, k1: &Enclosure, m0: u32) -> Vec<Condition> {
    let p = data.precision;
    let ratio =
        |numerator: i64, denominator: i64| Enclosure::from_rational(&Rational::from((numerator, denominator)), p);
    let (n_0, n_1) = (&data.n_0, &data.n_1);
    let m = Enclosure::from_integer(i64::from(m0), p);
    let left = data.rational(&edge(m0));
    let weight = data.spec.internal_model.weights.weight(u64::from(m0), p);
    let (a, b) = (m.sqr() * &weight, &m * weight);
    let pi_term = (Enclosure::pi(p).sqr() - 4) / 2 * n_1;
    let slope_bound = pi_term + (n_0 - n_1 / 2) / left.sqr();
    let sum_bound = (n_0 + n_1 * (ratio(47, 20) + ratio(3, 2) * m.log())) / &left + n_1 / (&m * (4 * &m - 1));
    let s = (slope_bound - k0).max(&data.zero());
    let room = k1 * left.sqr() - &s;
    let d = (b / (2 * (&m * &room))).sqrt();
    let step = |what: &str, lhs, rhs| Condition::at_most("T", format!("{what}, m0 = {m0}"), lhs, rhs);
    vec![
        // `room` > 0 is implied by d being defined; 2 d <= 1 is the second condition.
        step("scalar test, twice the distance from the pole", 2 * &d, Enclosure::one(p)),
        step(
            "scalar test, at the pole",
            2 / a * (data.nu.sqr().recip() + sum_bound.sqr()) + s / m.sqr(),
            k1 * (1 - d / m).sqr(),
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::super::weights_only::weights_only;
    use super::*;
    use crate::transfer::TradeOff;

    fn decimal(text: &str) -> Rational {
        sigmastar_exact::number::parse_decimal(text).unwrap()
    }

    #[test]
    fn near_optimal_pairs_are_proved_and_smaller_ones_refused() {
        // nu = 1, n_0 = 2: the smallest k1 with k0 = 7 is about 17.6, with k0 = 1/2 (= T(0)) about 27.1. At k0 = T(0)
        // itself no box that contains x = 0 can be proved in this form.
        let spec = weights_only("2", "1/2", "1", "1");
        let data = Data::new(&spec, 128);
        for (k0, k1) in [("7", "17.7"), ("0.501", "27.3")] {
            let (k0, k1) = (decimal(k0), decimal(k1));
            let proof = BoxProof::find(&data, &k0, &k1).expect("near-optimal pairs have a proof");
            assert_eq!(proof.decide(&data, &k0, &k1).0, Truth::True);
            let lower = &k1 * Rational::from((98, 100));
            assert_ne!(proof.decide(&data, &k0, &lower).0, Truth::True);
            assert_eq!(BoxProof::find(&data, &k0, &lower), None);
            let small = &k0 * Rational::from((1, 20));
            assert_ne!(proof.decide(&data, &small, &k1).0, Truth::True, "k0 below T(0)");
        }
    }

    #[test]
    fn the_proposed_curve_can_be_proved() {
        for (n0, epsilon, mu) in [("2", "1/2", "1"), ("2", "1", "0.159"), ("1.5", "1/10", "10"), ("5", "1/2", "0.01")] {
            let spec = weights_only(n0, epsilon, mu, "1");
            let data = Data::new(&spec, 128);
            let curve = TradeOff::curve(&data);
            for (k0, k1, _) in curve.candidates.iter().step_by(30) {
                let (k0, k1) = (Rational::from_f64(*k0).unwrap(), Rational::from_f64(k1 * 1.02).unwrap());
                let proof = BoxProof::find(&data, &k0, &k1);
                let proof = proof.unwrap_or_else(|| panic!("n0 {n0}, eps {epsilon}, mu {mu}, k0 {k0}, k1 {k1}"));
                assert_eq!(proof.decide(&data, &k0, &k1).0, Truth::True);
            }
        }
    }

    /// n_0 = 2, eps = 1/2, nu = 1, m0 = 2 by the formulas of the derivation in doubles: `k0 = 1` leaves s > 0.
    #[test]
    fn the_scalar_test_is_the_one_of_the_derivation() {
        let spec = weights_only("2", "1/2", "1", "1");
        let data = Data::new(&spec, 128);
        let weight = 2f64.powf(-1.5);
        let (a, b) = (4.0 * weight, 2.0 * weight);
        let sum = (2.0 + 2.35 + 1.5 * 2f64.ln()) / 1.5 + 1.0 / 14.0;
        let slope = (std::f64::consts::PI.powi(2) - 4.0) / 2.0 + 1.5 / 2.25;
        for (k0, k1) in [(1.0, 9.0), (1.0, 40.0), (50.0, 40.0)] {
            let s = (slope - k0).max(0.0);
            let d = (b / (4.0 * (k1 * 2.25 - s))).sqrt();
            let expected =
                [(2.0 * d, 1.0), (2.0 / a * (1.0 + sum * sum) + s / 4.0, k1 * (1.0 - d / 2.0) * (1.0 - d / 2.0))];
            let pair = [k0, k1].map(|k| data.rational(&Rational::from_f64(k).unwrap()));
            let steps = scalar_test(&data, &pair[0], &pair[1], 2);
            assert_eq!(steps.len(), 2);
            for (step, (lhs, rhs)) in steps.iter().zip(expected) {
                assert!((step.lhs.midpoint_f64() / lhs - 1.0).abs() < 1e-12, "{k0}, {k1}: {}", step.what);
                assert!((step.rhs.midpoint_f64() / rhs - 1.0).abs() < 1e-12, "{k0}, {k1}: {}", step.what);
            }
        }
        // Without room for d there is nothing to compare: A_m0 - k0 > k1 (m0 - 1/2)^2.
        let pair = [decimal("1"), decimal("1")].map(|k| data.rational(&k));
        assert!(scalar_test(&data, &pair[0], &pair[1], 2).iter().all(|step| !step.truth().is_true()));
    }

    #[test]
    fn a_box_uses_the_least_bound_on_it_and_one_pole() {
        let spec = weights_only("2", "1/2", "1", "1");
        let data = Data::new(&spec, 128);
        let sums = LorentzSums::new(&data, 4);
        let pair = [decimal("7"), decimal("18")].map(|k| data.rational(&k));
        let sides_of = |a: &str, b: &str, oscillators: &OscillatorRange| {
            sides(&data, &sums, oscillators, [&decimal(a), &decimal(b)], [&pair[0], &pair[1]])
        };
        let (lhs, rhs) = sides_of("0.75", "0.8", &OscillatorRange::Exactly(3));
        assert!(lhs.is_bounded() && rhs.contains(&decimal("17.125")), "7 + 18 (3/4)^2");
        assert!(!sides_of("0.4", "0.6", &OscillatorRange::Exactly(3)).0.is_defined());
        // The same beyond the last pole, where no pole would be hit.
        assert!(!sides_of("2.4", "2.6", &OscillatorRange::Exactly(1)).0.is_defined());
        match group(&data, 4, 3) {
            OscillatorRange::AtLeast { first: 4, tail } => assert!(tail == weight_tail(&data, 4)),
            other => panic!("{other:?}"),
        }
        assert!(matches!(group(&data, 4, 2), OscillatorRange::Exactly(3)));
    }

    /// The form divided by x^2 would hold: only the comparison at 0 itself refuses.
    #[test]
    fn k0_below_the_value_at_zero_is_refused() {
        let spec = weights_only("2", "1/2", "1", "1");
        let data = Data::new(&spec, 128);
        let (k0, k1) = (decimal("0.5"), decimal("30"));
        let proof = BoxProof::find(&data, &k0, &k1).unwrap();
        let (truth, step) = proof.decide(&data, &decimal("0.499999999"), &k1);
        assert_eq!(truth, Truth::False);
        assert!(step.what.contains("T_N(0)"), "{}", step.what);
    }

    #[test]
    fn damaged_proofs_are_refused() {
        let spec = weights_only("2", "1/2", "1", "1");
        let data = Data::new(&spec, 128);
        let (k0, k1) = (decimal("7"), decimal("18"));
        let proof = BoxProof::find(&data, &k0, &k1).unwrap();
        let damaged: Vec<(&str, BoxProof)> = {
            let change = |what, f: &dyn Fn(&mut BoxProof)| {
                let mut other = proof.clone();
                f(&mut other);
                (what, other)
            };
            vec![
                change("one wide box", &|p| p.breaks[0] = vec![Rational::new(), edge(p.m0)]),
                change("a missing group", &|p| drop(p.breaks.pop())),
                change("a missing end", &|p| drop(p.breaks[1].pop())),
                change("a late start", &|p| p.breaks[1][0] = Rational::from((1, 100))),
                change("a reversal", &|p| p.breaks[1].swap(1, 2)),
                change("an empty list", &|p| p.breaks[0].clear()),
                change("N0 below m0", &|p| p.n0 = p.m0 - 1),
                change("m0 = 0", &|p| p.m0 = 0),
                change("too many groups", &|p| p.n0 = u32::MAX),
            ]
        };
        for (what, other) in damaged {
            assert_ne!(other.decide(&data, &k0, &k1).0, Truth::True, "{what}");
        }
        assert_eq!(proof.decide(&data, &k0, &Rational::from(-1)).0, Truth::False);
    }
}
