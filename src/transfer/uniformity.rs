//! How much of a certified bound each number of oscillators uses: sup_x T_N(x)/(k0 + k1 x^2), enclosed.

use super::boxes::{MAX_BOXES, MAX_M0, edge, scalar_test, sides};
use super::cover::cover_group;
use super::curve::sample_points;
use super::float_sums::{FloatGroup, FloatSums};
use super::lorentz::{LorentzSums, Oscillators, weight_tail};
use super::pole_sums::{OscillatorCount, PoleSums};
use crate::data::Data;
use crate::enclosure::Enclosure;
use crate::number::{Direction, round_rational};
use rayon::prelude::*;
use rug::Rational;

/// Up to here each N is looked at by itself; all larger N share one upper bound at each height.
const LAST_ALONE: u64 = 32;
/// How far above the largest value that was found an upper bound is tried, relatively.
const STEPS: [f64; 6] = [1e-4, 3e-4, 1e-3, 1e-2, 0.1, 1.0];
/// Significant digits of the place where the supremum is attained, nearly.
const DIGITS: u32 = 8;

/// sup over x >= 0 of T_N(x)/(k0 + k1 x^2), for one N.
#[derive(Clone, Debug)]
pub struct SupRatio {
    /// N.
    pub n_o: OscillatorCount,
    /// An enclosure of the supremum.
    pub ratio: Enclosure,
    /// Where the lower end is attained.
    pub x: Rational,
}

/// Encloses the supremum for each N asked for, in their order.
///
/// Hypothesis: (k0, k1) is proved admissible, so that 1 is an upper bound of every ratio. Guarantee: each supremum lies in
/// its enclosure; its lower end is the value at `x`. Deterministic on any number of threads; `done` is called once after
/// each N.
#[must_use]
pub fn sup_ratios(
    data: &Data<'_>,
    k0: &Rational,
    k1: &Rational,
    counts: &[OscillatorCount],
    done: impl Fn() + Sync,
) -> Vec<SupRatio> {
    let sums = FloatSums::new(data, LAST_ALONE as usize);
    counts
        .par_iter()
        .map(|n_o| {
            let ratio = sup_ratio(data, &sums, [k0, k1], *n_o);
            done();
            ratio
        })
        .collect()
}

fn sup_ratio(data: &Data<'_>, sums: &FloatSums, [k0, k1]: [&Rational; 2], n_o: OscillatorCount) -> SupRatio {
    let at = |x: &Rational, value: Enclosure| value / (data.rational(k0) + data.rational(k1) * data.rational(x).sqr());
    let at_zero = at(&Rational::new(), (data.nu.sqr() * &data.n_0).recip());
    if n_o == OscillatorCount::Finite(0) {
        // T_0 = n_0/(x^2 + nu^2 n_0^2) decreases.
        return SupRatio { n_o, ratio: at_zero, x: Rational::new() };
    }
    let pole_sums = PoleSums::new(data, n_o);
    let last = match n_o {
        OscillatorCount::Finite(n) => n.min(LAST_ALONE) as usize,
        OscillatorCount::Infinite => LAST_ALONE as usize,
    };
    let (mut best, mut place) = (at_zero, Rational::new());
    let last_pole = match n_o {
        OscillatorCount::Finite(n) => Some(Rational::from(n)),
        OscillatorCount::Infinite => None,
    };
    let proposed = peaks(sums, last, [k0.to_f64(), k1.to_f64()]).into_iter().filter_map(Rational::from_f64);
    for x in proposed.chain(last_pole) {
        let x = round_rational(&x, DIGITS, Direction::Nearest);
        let value = at(&x, pole_sums.transfer_at(&data.rational(&x)));
        if value.lower() > best.lower() {
            (best, place) = (value, x);
        }
    }
    let upper = STEPS.iter().find_map(|step| {
        let height = round_rational(&(best.upper_rational()? * Rational::from_f64(1.0 + step)?), 10, Direction::Up);
        (height < 1 && stays_below(data, sums, n_o, last, [k0, k1].map(|k| Rational::from(k * &height))))
            .then(|| data.rational(&height))
    });
    let upper = upper.unwrap_or_else(|| Enclosure::one(data.precision));
    let ratio = Enclosure::new(best.lower().clone(), upper.upper().clone());
    SupRatio { n_o, ratio, x: place }
}

/// The largest few local maxima of T_N/(k0 + k1 x^2), in doubles.
fn peaks(sums: &FloatSums, n: usize, [k0, k1]: [f64; 2]) -> Vec<f64> {
    const PEAKS: usize = 4;
    let ratio = |x: f64| sums.transfer(x, n) / (k0 + k1 * x * x);
    let mut points = sample_points(sums, n + 1, |m| if m < n { vec![n] } else { Vec::new() });
    for _ in 0..3 {
        points.sort_by(f64::total_cmp);
        points.dedup();
        let values: Vec<f64> = points.iter().map(|x| ratio(*x)).collect();
        let is_peak = |i: &usize| {
            (*i == 0 || values[i - 1] <= values[*i]) && values.get(i + 1).is_none_or(|next| *next <= values[*i])
        };
        let mut tops: Vec<usize> = (0..points.len()).filter(is_peak).collect();
        tops.sort_by(|i, j| values[*j].total_cmp(&values[*i]).then(i.cmp(j)));
        tops.truncate(PEAKS);
        for i in tops {
            let left = if i == 0 { 0.5 * points[0] } else { points[i - 1] };
            let right = points.get(i + 1).copied().unwrap_or(points[i]);
            points.extend((1..16).map(|k| left + (right - left) * f64::from(k) / 16.0));
        }
    }
    points.sort_by(|x, y| ratio(*y).total_cmp(&ratio(*x)).then(x.total_cmp(y)));
    points.truncate(PEAKS);
    points
}

/// Whether T_N(x) <= k0 + k1 x^2 is proved for every x >= 0 and this N >= 1 (for all N > `LAST_ALONE` together).
///
/// From m - 1/2 on, by the scalar test (any N), or where m - 1/2 > N by T_N <= 1/(2 nu (x - N)) (Lemma T') or
/// T_N <= x/(nu^2 n_0 (x - N)) (Lemma T''), both decreasing in x; before, by boxes.
fn stays_below(data: &Data<'_>, sums: &FloatSums, n_o: OscillatorCount, last: usize, pair: [Rational; 2]) -> bool {
    let alone = n_o == OscillatorCount::Finite(last as u64);
    let oscillators = if alone {
        Oscillators::Exactly(last as u32)
    } else {
        let first = LAST_ALONE as u32 + 1;
        Oscillators::AtLeast { first, tail: weight_tail(data, first) }
    };
    let group = if alone { FloatGroup { last, tail: None } } else { FloatSums::all_from(data, LAST_ALONE as u32 + 1) };
    let [k0, k1] = pair.each_ref().map(|k| data.rational(k));
    let beyond_all = |m: u32| {
        let x = edge(m);
        let gap = Rational::from(&x - last as u32);
        if !alone || gap <= 0 {
            return false;
        }
        let bound = &k0 + &k1 * data.rational(&x).sqr();
        let gap = data.rational(&gap);
        (2 * (&data.nu * &gap)).recip().le(&bound).is_true()
            || (data.rational(&x) / (data.nu.sqr() * &data.n_0 * gap)).le(&bound).is_true()
    };
    let settled =
        |m: &u32| beyond_all(*m) || scalar_test(data, &k0, &k1, *m).iter().all(|step| step.lhs.le(&step.rhs).is_true());
    // The group of all larger N is only covered below its first own pole.
    let most = if alone { MAX_M0 } else { LAST_ALONE as u32 };
    let Some(m) = (1..=most).find(settled) else { return false };
    let floats = pair.each_ref().map(Rational::to_f64);
    let Some(points) = cover_group(sums, group, floats, m, MAX_BOXES) else { return false };
    let Some(breaks) = points.into_iter().map(Rational::from_f64).collect::<Option<Vec<Rational>>>() else {
        return false;
    };
    let sums = LorentzSums::new(data, last as u32);
    // The form divided by x^2 needs k0 >= T_N(0).
    (data.nu.sqr() * &data.n_0).recip().le(&k0).is_true()
        && breaks.windows(2).all(|pair| {
            let (lhs, rhs) = sides(data, &sums, &oscillators, [&pair[0], &pair[1]], [&k0, &k1]);
            lhs.le(&rhs).is_true()
        })
}
