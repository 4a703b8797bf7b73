//! Certified pairs (k0, k1): the smallest k1 for a given k0, and the pair that is cheapest for given weights.

use super::boxes::BoxProof;
use super::curve::{Sample, SampledGraph};
use super::lorentz::{LorentzSums, OscillatorRange};
use super::{TransferProof, decide};
use crate::data::Data;
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_exact::number::{Direction, round_f64, write_exact};
use thiserror::Error;

/// Significant digits of a certified k1, and of a k0 that the program chooses.
pub(super) const DIGITS: u32 = 6;
/// Significant digits of a point at which T is evaluated.
const POINT_DIGITS: u32 = 10;
/// Relative room above the sampled curve that is tried in turn.
pub(super) const ROOMS: [f64; 8] = [3e-4, 1e-3, 3e-3, 6e-3, 9e-3, 0.03, 0.1, 0.3];
/// The first of [`ROOMS`] for the pairs of a table: fewer boxes.
const TABLE_ROOMS: &[f64] = ROOMS.split_at(2).1;

/// By how much k1 grows from one attempt to the next where the cheapest pair has no proof.
const FALLBACK: f64 = 1.5;

/// How far the table of the trade-off goes, in units of its first k0.
const TABLE_REACH: f64 = 32.0;

/// A pair with its proof, and how far it is from the best.
#[derive(Clone, Debug)]
pub struct CertifiedPair {
    /// k0.
    pub k0: Rational,
    /// k1.
    pub k1: Rational,
    /// The proof that T_N(x) <= k0 + k1 x^2 for every N >= 0 and every x >= 0.
    pub proof: BoxProof,
    /// Why k1 cannot be much smaller for this k0, if some point shows it.
    pub binding: Option<BindingPoint>,
}

/// A point that forces k1 up.
#[derive(Clone, Debug)]
pub struct BindingPoint {
    /// The number of oscillators.
    pub n_o: u32,
    /// x.
    pub x: Rational,
    /// T_N(x).
    pub value: Enclosure,
    /// (T_N(x) - k0)/x^2: no k1 below its lower end is admissible with this k0.
    pub least_k1: Enclosure,
}

impl CertifiedPair {
    /// By how much, relatively, k1 exceeds the proved lower bound of every admissible k1 with this k0, rounded up.
    #[must_use]
    pub fn excess(&self, data: &Data<'_>) -> Option<Enclosure> {
        self.excess_of(data, &self.k1)
    }

    /// The same of another k1 with this k0.
    #[must_use]
    pub fn excess_of(&self, data: &Data<'_>, k1: &Rational) -> Option<Enclosure> {
        let least = &self.binding.as_ref()?.least_k1;
        least.is_positive().is_true().then(|| (data.rational(k1) / least - 1).ceiling())
    }
}

/// Why there is no certified pair.
#[derive(Clone, Debug, Error)]
pub enum PairError {
    /// k0 lies below T_N(0).
    #[error("k0 = {} is too small: T_N(0) = 1/(nu^2 n_0) is at least {least}, for every N", write_exact(k0))]
    BelowZeroValue {
        /// The k0 asked for.
        k0: Rational,
        /// A lower bound of T_N(0).
        least: String,
    },
    /// The search works in doubles, and k0 or k1 leave their range.
    #[error(
        "no pair was found: T_N(0) = 1/(nu^2 n_0) is about {at_zero}, and it, k0 or k1 leaves the range of doubles"
    )]
    OutOfRange {
        /// T_N(0).
        at_zero: String,
    },
    /// No proof was found.
    #[error(
        "no proof was found for k0 = {} and k1 up to {k1:.6}: the scalar test or the boxes would need more than they may",
        write_exact(k0)
    )]
    NotFound {
        /// k0.
        k0: Rational,
        /// The largest k1 that was tried.
        k1: f64,
    },
}

impl PairError {
    /// What to try.
    #[must_use]
    pub fn way_out(&self) -> &'static str {
        match self {
            PairError::BelowZeroValue { .. } => "choose a k0 that is not below T_N(0)",
            PairError::OutOfRange { .. } => {
                "scale mu, base_frequency or the weights, or choose a k0 within 1e-300 to 1e300"
            }
            PairError::NotFound { .. } => "choose a smaller k0, which lets k1 be larger",
        }
    }

    /// Whether it is proved that there is no such pair; otherwise none was found.
    #[must_use]
    pub fn is_refuted(&self) -> bool {
        matches!(self, PairError::BelowZeroValue { .. })
    }
}

/// The smallest k1, nearly, with which a given k0 is proved admissible.
///
/// Guarantee: the pair is admissible for every N >= 0 and every x >= 0. How near k1 is to the best is a figure of the
/// result (`excess`), proved as well.
///
/// # Errors
/// k0 certainly below T_N(0), or no proof within the effort.
pub fn smallest_k1(data: &Data<'_>, k0: &Rational) -> Result<CertifiedPair, PairError> {
    let at_zero = data.transfer_at_zero();
    if at_zero.gt(&data.rational(k0)).is_true() {
        return Err(PairError::BelowZeroValue { k0: k0.clone(), least: at_zero.lower_decimal(8) });
    }
    let graph = SampledGraph::new(data);
    prove_smallest_k1(data, &graph, k0, &ROOMS)
}

fn prove_smallest_k1(
    data: &Data<'_>,
    graph: &SampledGraph,
    k0: &Rational,
    rooms: &[f64],
) -> Result<CertifiedPair, PairError> {
    let (least, sample) = graph.smallest_k1(k0.to_f64());
    let at_zero = data.transfer_at_zero();
    let out_of_range = || PairError::OutOfRange { at_zero: at_zero.upper_decimal(3) };
    if !least.is_normal() || !k0.to_f64().is_normal() {
        return Err(out_of_range());
    }
    let binding = sample.and_then(|sample| binding(data, k0, sample));
    for room in rooms {
        let Some(k1) = round_f64(least * (1.0 + room), DIGITS, Direction::Up) else { break };
        if let Some(proof) = BoxProof::find(data, k0, &k1) {
            return Ok(CertifiedPair { k0: k0.clone(), k1, proof, binding });
        }
    }
    if !at_zero.midpoint_f64().is_normal() {
        return Err(out_of_range());
    }
    Err(PairError::NotFound { k0: k0.clone(), k1: least * (1.0 + ROOMS[ROOMS.len() - 1]) })
}

/// The pair with nearly the smallest `a k0 + b k1`, for a, b >= 0; where that one has no proof within the effort, a pair
/// with a larger k1.
///
/// Guarantee: as for [`smallest_k1`]. The choice of k0 is a floating-point one.
///
/// # Errors
/// No proof within the effort.
pub fn cheapest_pair(data: &Data<'_>, a: f64, b: f64) -> Result<CertifiedPair, PairError> {
    let graph = SampledGraph::new(data);
    let trade_off = graph.trade_off();
    let best = trade_off.best(a, b);
    let mut result = prove_near(data, &graph, best.0, &ROOMS);
    let mut k1 = best.1;
    for candidate in trade_off.candidates.iter().rev() {
        if result.is_ok() {
            break;
        }
        if candidate.1 >= FALLBACK * k1 {
            k1 = candidate.1;
            result = prove_near(data, &graph, candidate.0, TABLE_ROOMS);
        }
    }
    result
}

/// Pairs along the trade-off, k0 increasing from about T_N(0) to `TABLE_REACH` times that, at most `most` of them;
/// those without a proof are left out.
#[must_use]
pub fn trade_off_pairs(data: &Data<'_>, most: usize) -> Vec<CertifiedPair> {
    let graph = SampledGraph::new(data);
    let mut candidates = graph.trade_off().candidates;
    let largest = candidates.first().map_or(0.0, |first| TABLE_REACH * first.0);
    candidates.retain(|candidate| candidate.0 <= largest);
    let stride = candidates.len().div_ceil(most.max(1)).max(1);
    candidates.iter().step_by(stride).filter_map(|(k0, _, _)| prove_near(data, &graph, *k0, TABLE_ROOMS).ok()).collect()
}

fn prove_near(data: &Data<'_>, graph: &SampledGraph, k0: f64, rooms: &[f64]) -> Result<CertifiedPair, PairError> {
    let rounded = round_f64(k0, DIGITS, Direction::Up).unwrap_or_default();
    prove_smallest_k1(data, graph, &rounded, rooms)
}

/// What is known of a pair that somebody else names.
#[derive(Clone, Debug)]
pub enum PairStatus {
    /// Admissible for every N >= 0 and every x >= 0.
    Proved,
    /// T_N(x) > k0 + k1 x^2 at a point.
    Refuted(PairCounterexample),
    /// Neither.
    Undecided,
}

/// A point at which T exceeds a bound.
#[derive(Clone, Debug)]
pub struct PairCounterexample {
    /// The number of oscillators.
    pub n_o: u32,
    /// x.
    pub x: Rational,
    /// T_N(x).
    pub value: Enclosure,
    /// k0 + k1 x^2.
    pub bound: Enclosure,
}

/// Proves or refutes the admissibility of a pair, given as enclosures.
#[must_use]
pub fn pair_status(data: &Data<'_>, k0: &Enclosure, k1: &Enclosure) -> PairStatus {
    let at_zero = data.transfer_at_zero();
    if at_zero.gt(k0).is_true() {
        let found = PairCounterexample { n_o: 0, x: Rational::new(), value: at_zero, bound: k0.clone() };
        return PairStatus::Refuted(found);
    }
    let graph = SampledGraph::new(data);
    let tightest = graph.tightest(k0.midpoint_f64(), k1.midpoint_f64());
    if let Some((n_o, x, value)) = tightest.and_then(|sample| value_at(data, sample)) {
        let bound = k0 + k1 * data.rational(&x).sqr();
        if value.gt(&bound).is_true() {
            return PairStatus::Refuted(PairCounterexample { n_o, x, value, bound });
        }
    }
    let (Some(k0), Some(k1)) = (k0.lower_rational(), k1.lower_rational()) else { return PairStatus::Undecided };
    let proved =
        decide(data, &k0, &k1, &TransferProof::ClosedForm).0 == Truth::True || BoxProof::find(data, &k0, &k1).is_some();
    if proved { PairStatus::Proved } else { PairStatus::Undecided }
}

/// N, x and an enclosure of T_N(x) at a sample.
fn value_at(data: &Data<'_>, sample: Sample) -> Option<(u32, Rational, Enclosure)> {
    // Short, so that the point that is shown is the one that was looked at.
    let x = round_f64(sample.x, POINT_DIGITS, Direction::Nearest)?;
    let n_o = u32::try_from(sample.n).ok()?;
    let nearest = sample.x.round() as u32;
    let value = LorentzSums::new(data, n_o).enclose(&data.rational(&x), nearest, &OscillatorRange::Exactly(n_o));
    value.is_bounded().then_some((n_o, x, value))
}

/// Decides how large T is at a sample.
fn binding(data: &Data<'_>, k0: &Rational, sample: Sample) -> Option<BindingPoint> {
    let (n_o, x, value) = value_at(data, sample)?;
    let least_k1 = (&value - data.rational(k0)) / data.rational(&x).sqr();
    Some(BindingPoint { n_o, x, value, least_k1 })
}

/// Proves a pair that a floating-point search proposed, or one a little above it in both members.
#[must_use]
pub fn prove_above(data: &Data<'_>, k0: f64, k1: f64, digits: u32) -> Option<(Rational, Rational, BoxProof)> {
    [0.0, 3e-3, 0.02, 0.2].into_iter().find_map(|room| {
        let up = |value: f64| round_f64(value * (1.0 + room), digits, Direction::Up);
        let (k0, k1) = (up(k0)?, up(k1)?);
        let proof = BoxProof::find(data, &k0, &k1)?;
        Some((k0, k1, proof))
    })
}

#[cfg(test)]
mod tests {
    use super::super::weights_only::weights_only;
    use super::*;
    use crate::transfer::TradeOff;

    fn exact(data: &Data<'_>, text: &str) -> Rational {
        match text {
            // T_N(0) itself, or the first number above it that a double can hold.
            "T(0)" => {
                let at_zero = data.transfer_at_zero();
                at_zero.upper_rational().unwrap()
            }
            _ => sigmastar_exact::number::parse_decimal(text).unwrap(),
        }
    }

    #[test]
    fn the_smallest_k1_is_within_a_hundredth_of_the_best() {
        for (n0, epsilon, frequency, k0) in [
            ("2", "1/2", "1", "7"),
            ("2", "1", "1", "7"),
            ("2", "1/2", "1", "T(0)"),
            ("2", "1", "1", "T(0)"),
            ("2", "1/2", "2*pi", "T(0)"),
            ("2", "1", "2*pi", "T(0)"),
            ("2", "1/2", "1/10", "0.0075"),
            ("2", "1/2", "100", "7500"),
            ("50", "1", "1", "0.1"),
            ("1.01", "1/100", "3", "20"),
        ] {
            let spec = weights_only(n0, epsilon, "1", frequency);
            let data = Data::new(&spec, 128);
            let k0 = exact(&data, k0);
            let case = format!("n0 {n0}, eps {epsilon}, w {frequency}, k0 {}", k0.to_f64());
            let pair = smallest_k1(&data, &k0).unwrap_or_else(|error| panic!("{case}: {error}"));
            assert_eq!(pair.proof.decide(&data, &pair.k0, &pair.k1).0, Truth::True);
            let excess = pair.excess(&data).unwrap_or_else(|| panic!("{case}: no binding point"));
            assert!(excess.upper_f64() < 0.01, "{case}: {}", excess.upper_f64());
        }
    }

    /// Where k0 alone costs, a larger k1 saves boxes; where the cheapest pair needs too many, another one is found.
    #[test]
    fn cheapest_pairs_are_found_where_one_of_the_two_hardly_counts() {
        // (n_0, eps, w, a, b, the most boxes, by what factor the cost may exceed that of the curve)
        let cases =
            [("7.9", "0.02", "2/1000000", 1.0, 1.0, 4000, 1.01), ("728", "0.0988", "1/51", 1e-4, 1.0, 20_000, 4.0)];
        for (n0, epsilon, frequency, a, b, most, factor) in cases {
            let spec = weights_only(n0, epsilon, "1", frequency);
            let data = Data::new(&spec, 128);
            let case = format!("n0 {n0}, eps {epsilon}, w {frequency}");
            let pair = cheapest_pair(&data, a, b).unwrap_or_else(|error| panic!("{case}: {error}"));
            assert_eq!(pair.proof.decide(&data, &pair.k0, &pair.k1).0, Truth::True);
            assert!(pair.proof.boxes() <= most, "{case}: {} boxes", pair.proof.boxes());
            let costs = TradeOff::curve(&data).candidates.into_iter().map(|(k0, k1, _)| a * k0 + b * k1);
            let cost = a * pair.k0.to_f64() + b * pair.k1.to_f64();
            let least = costs.fold(f64::INFINITY, f64::min);
            assert!(cost <= factor * least, "{case}: {cost} {least}");
        }
    }

    #[test]
    fn the_binding_point_is_what_it_shows() {
        let spec = weights_only("2", "1/2", "1", "1");
        let data = Data::new(&spec, 128);
        let pair = smallest_k1(&data, &Rational::from(7)).unwrap();
        let binding = pair.binding.as_ref().unwrap();
        // T_N(x) lies on the line of slope `least_k1` through (0, k0).
        let on_line = data.rational(&pair.k0) + &binding.least_k1 * data.rational(&binding.x).sqr();
        assert!(on_line.intersect(&binding.value).is_defined());
        let excess = pair.excess(&data).unwrap();
        let needed = data.rational(&pair.k1) / (1 + &excess);
        assert!(needed.le(&binding.least_k1.ceiling()).is_true() && excess.upper_f64() < 0.01);
    }

    #[test]
    fn the_status_of_a_named_pair_is_no_more_than_what_is_known() {
        let spec = weights_only("2", "1/2", "1", "1");
        let data = Data::new(&spec, 128);
        let of = |low: i32, high: i32| Enclosure::between(&Rational::from(low), &Rational::from(high), 128);
        assert!(matches!(pair_status(&data, &of(7, 7), &of(18, 18)), PairStatus::Proved));
        match pair_status(&data, &of(7, 7), &of(17, 17)) {
            PairStatus::Refuted(point) => assert!(point.value.gt(&point.bound).is_true()),
            other => panic!("{other:?}"),
        }
        // The pair may be any one in the enclosures: some of these are admissible and some are not.
        assert!(matches!(pair_status(&data, &of(7, 7), &of(10, 1000)), PairStatus::Undecided));
        assert!(matches!(pair_status(&data, &of(1, 100), &of(18, 18)), PairStatus::Undecided));
    }

    #[test]
    fn data_beyond_doubles_are_told_apart_from_hard_ones() {
        for (n0, frequency) in [("2", "1e300"), ("2", "1e-300"), ("1e300", "1")] {
            let spec = weights_only(n0, "1/2", "1", frequency);
            let data = Data::new(&spec, 128);
            let error = cheapest_pair(&data, 1.0, 1.0).unwrap_err();
            assert!(matches!(error, PairError::OutOfRange { .. }), "{n0} {frequency}: {error}");
        }
        let spec = weights_only("2", "1/2", "1", "1");
        let large = Rational::from_str_radix(&format!("1{}", "0".repeat(400)), 10).unwrap();
        let error = smallest_k1(&Data::new(&spec, 128), &large).unwrap_err();
        assert!(matches!(error, PairError::OutOfRange { .. }), "{error}");
    }
}
