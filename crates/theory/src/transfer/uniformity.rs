//! How much of a certified bound each number of oscillators uses: sup_x T_N(x)/(k0 + k1 x^2), enclosed.

use super::boxes::{MAX_BOXES, MAX_M0, edge, group, scalar_test, sides};
use super::cover::cover_group;
use super::curve::sample_points;
use super::float_sums::{FloatGroup, FloatSums};
use super::lorentz::LorentzSums;
use super::pole_sums::{OscillatorCount, PoleSums};
use crate::data::Data;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_rational};
use sigmastar_exact::parallel;

/// Up to here each N is looked at by itself; all larger N share one upper bound at each height.
const LAST_ALONE: u64 = 32;
/// How far above the largest value that was found an upper bound is tried, relatively.
const STEPS: [f64; 6] = [1e-4, 3e-4, 1e-3, 1e-2, 0.1, 1.0];
/// How far above it a bound that is already proved is good enough.
const ENOUGH: f64 = 1e-3;
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
    // What all N > LAST_ALONE share: the places to look at, and a height proved for all of them, near the value for the last.
    let places = places(&sums, LAST_ALONE as usize, [k0, k1]);
    let many = |n_o: &OscillatorCount| n_o.includes(LAST_ALONE + 1);
    let height = (counts.iter().filter(|n_o| many(n_o)).count() > 1)
        .then(|| sup_ratio(data, &sums, [k0, k1], OscillatorCount::Infinite, &places, None).ratio.upper_rational())
        .flatten();
    parallel::map(counts, |n_o| {
        let ratio = if many(n_o) {
            sup_ratio(data, &sums, [k0, k1], *n_o, &places, height.as_ref())
        } else {
            sup_ratio(data, &sums, [k0, k1], *n_o, &self::places(&sums, last_alone(*n_o), [k0, k1]), None)
        };
        done();
        ratio
    })
}

/// N, or the number that stands for all larger ones.
fn last_alone(n_o: OscillatorCount) -> usize {
    match n_o {
        OscillatorCount::Finite(n) => n.min(LAST_ALONE) as usize,
        OscillatorCount::Infinite => LAST_ALONE as usize,
    }
}

/// Where the ratio may be largest, as short decimals.
fn places(sums: &FloatSums, last: usize, pair: [&Rational; 2]) -> Vec<Rational> {
    let peaks = peaks(sums, last, pair.map(Rational::to_f64)).into_iter().filter_map(Rational::from_f64);
    peaks.map(|x| round_rational(&x, DIGITS, Direction::Nearest)).collect()
}

/// `height` is an upper bound of the ratio for every N > [`LAST_ALONE`], proved, if it is known.
fn sup_ratio(
    data: &Data<'_>,
    sums: &FloatSums,
    [k0, k1]: [&Rational; 2],
    n_o: OscillatorCount,
    places: &[Rational],
    height: Option<&Rational>,
) -> SupRatio {
    let at = |x: &Rational, value: Enclosure| value / (data.rational(k0) + data.rational(k1) * data.rational(x).sqr());
    let at_zero = at(&Rational::new(), data.transfer_at_zero());
    if n_o == OscillatorCount::Finite(0) {
        // T_0 = n_0/(x^2 + nu^2 n_0^2) decreases.
        return SupRatio { n_o, ratio: at_zero, x: Rational::new() };
    }
    let pole_sums = PoleSums::new(data, n_o);
    let last = last_alone(n_o);
    let (mut best, mut place) = (at_zero, Rational::new());
    // At the last pole T_N(N) = 1/(nu^2 c_N), without any sum.
    let last_pole = match n_o {
        OscillatorCount::Finite(n) => {
            let residue = data.spec.internal_model.weights.weight(n, data.precision) / 2;
            Some(((data.nu.sqr() * residue).recip(), Rational::from(n)))
        }
        OscillatorCount::Infinite => None,
    };
    let proposed = places.iter().map(|x| (pole_sums.transfer_at(&data.rational(x)), x.clone()));
    for (value, x) in proposed.chain(last_pole) {
        let value = at(&x, value);
        if value.lower() > best.lower() {
            (best, place) = (value, x);
        }
    }
    let near = |height: &&Rational| {
        data.rational(height).upper_f64() <= best.lower_f64() * (1.0 + ENOUGH) && n_o.includes(LAST_ALONE + 1)
    };
    let known = height.filter(near).map(|height| data.rational(height));
    let find = || {
        STEPS.iter().find_map(|step| {
            let height = round_rational(&(best.upper_rational()? * Rational::from_f64(1.0 + step)?), 10, Direction::Up);
            (height < 1 && stays_below(data, sums, n_o, last, [k0, k1].map(|k| Rational::from(k * &height))))
                .then(|| data.rational(&height))
        })
    };
    let upper = known.or_else(find).unwrap_or_else(|| Enclosure::one(data.precision));
    let ratio = Enclosure::new(best.lower(), upper.upper());
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
    let first = LAST_ALONE as u32 + 1;
    // As in a proof with N0 = `first`: a list for each smaller N, and the last one for all others.
    let oscillators = group(data, first, if alone { last - 1 } else { first as usize - 1 });
    let group = if alone { FloatGroup { last, tail: None } } else { FloatSums::all_from(data, first) };
    let [k0, k1] = pair.each_ref().map(|k| data.rational(k));
    let beyond_all = |m: u32| {
        let x = edge(m);
        let gap = Rational::from(&x - last as u32);
        if !alone || gap <= 0 {
            return false;
        }
        let bound = &k0 + &k1 * data.rational(&x).sqr();
        beyond_last_pole(data, &data.rational(&x), &data.rational(&gap)).iter().any(|upper| upper.le(&bound).is_true())
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
    data.transfer_at_zero().le(&k0).is_true()
        && breaks.windows(2).all(|pair| {
            let (lhs, rhs) = sides(data, &sums, &oscillators, [&pair[0], &pair[1]], [&k0, &k1]);
            lhs.le(&rhs).is_true()
        })
}

/// `1/(2 nu (x - N))` and `x/(nu^2 n_0 (x - N))` for a gap x - N > 0: upper bounds of T_N(x) (Lemmas T' and T'').
fn beyond_last_pole(data: &Data<'_>, x: &Enclosure, gap: &Enclosure) -> [Enclosure; 2] {
    [(2 * (&data.nu * gap)).recip(), x / (data.nu.sqr() * &data.n_0 * gap)]
}

#[cfg(test)]
mod tests {
    use super::super::weights_only::weights_only;
    use super::*;
    use crate::transfer::smallest_k1;

    #[test]
    fn lemmas_beyond_the_last_pole() {
        let spec = weights_only("2", "1/2", "4", "1");
        let data = Data::new(&spec, 128);
        let of = |n: i32, d: i32| data.rational(&Rational::from((n, d)));
        // x = 7/2, N = 3: 1/(2 * 4 * 1/2) = 1/4 and (7/2)/(16 * 2 * 1/2) = 7/32.
        let [first, second] = beyond_last_pole(&data, &of(7, 2), &of(1, 2));
        assert!(first.contains(&Rational::from((1, 4))) && second.contains(&Rational::from((7, 32))));
        for n in [1_u64, 2, 5] {
            let sums = PoleSums::new(&data, OscillatorCount::Finite(n));
            for tenths in [1, 5, 20, 300] {
                let x = of(10 * n as i32 + tenths, 10);
                let value = sums.transfer_at(&x);
                for upper in beyond_last_pole(&data, &x, &of(tenths, 10)) {
                    assert!(value.le(&upper).is_true(), "N = {n}, x = N + {tenths}/10");
                }
            }
        }
    }

    /// Refuses every height below a value that is attained, for one N and for all N > 32 together.
    #[test]
    fn no_height_below_an_attained_ratio_is_proved() {
        for mu in ["1/10", "1", "10"] {
            let spec = weights_only("2", "1/2", mu, "1");
            let data = Data::new(&spec, 128);
            let k0 = 2 * data.transfer_at_zero();
            let k0 = k0.upper_rational().unwrap();
            let pair = smallest_k1(&data, &k0).unwrap();
            let floats = FloatSums::new(&data, LAST_ALONE as usize);
            for n_o in
                [1, 2, 5, 32, 33, 1000].map(OscillatorCount::Finite).into_iter().chain([OscillatorCount::Infinite])
            {
                let last = last_alone(n_o);
                let found = sup_ratios(&data, &pair.k0, &pair.k1, &[n_o], || ()).remove(0);
                let attained = found.ratio.lower_rational().unwrap();
                // Not above the value at x, and equal to it up to rounding.
                let finer = Data::new(&spec, 256);
                let value = PoleSums::new(&finer, n_o).transfer_at(&finer.rational(&found.x));
                let bound = finer.rational(&pair.k0) + finer.rational(&pair.k1) * finer.rational(&found.x).sqr();
                let excess = value / bound / finer.rational(&attained) - 1;
                assert!(excess.lower() >= 0 && excess.upper() < 1e-30, "mu = {mu}, N = {n_o}: {excess:?}");
                for percent in [1, 30, 60, 90, 99] {
                    let height = &attained * Rational::from((percent, 100));
                    let scaled = [&pair.k0, &pair.k1].map(|k| Rational::from(k * &height));
                    assert!(!stays_below(&data, &floats, n_o, last, scaled), "mu = {mu}, N = {n_o}, {percent} %");
                }
            }
        }
    }

    #[test]
    fn a_k0_below_the_value_at_zero_is_refused() {
        let spec = weights_only("2", "1/2", "1", "1");
        let data = Data::new(&spec, 128);
        let floats = FloatSums::new(&data, LAST_ALONE as usize);
        for n in [1, 3, 1000] {
            let below = |k0: Rational| {
                let last = n.min(LAST_ALONE) as usize;
                stays_below(&data, &floats, OscillatorCount::Finite(n), last, [k0, Rational::from(40)])
            };
            // T_N(0) = 1/2.
            assert!(below(Rational::from((1, 2))), "N = {n}");
            assert!(!below(Rational::from((499_999_999, 1_000_000_000))), "N = {n}");
        }
    }

    /// The bound that all large N share is one for each of them, and no N <= 32 uses it.
    #[test]
    fn together_and_alone_the_enclosures_agree() {
        let spec = weights_only("2", "1/2", "1", "1");
        let data = Data::new(&spec, 128);
        let pair = smallest_k1(&data, &Rational::from(7)).unwrap();
        let counts = [1, 32, 33, 34, 60, 5000].map(OscillatorCount::Finite);
        let together = sup_ratios(&data, &pair.k0, &pair.k1, &counts, || ());
        for (n_o, shared) in counts.into_iter().zip(together) {
            let own = sup_ratios(&data, &pair.k0, &pair.k1, &[n_o], || ()).remove(0);
            assert!(shared.ratio.lower() == own.ratio.lower() && shared.x == own.x, "N = {n_o}");
            assert!(shared.ratio.upper_f64() <= 1.002 * own.ratio.upper_f64(), "N = {n_o}");
            assert!(n_o.includes(LAST_ALONE + 1) || shared.ratio == own.ratio, "N = {n_o}");
        }
    }

    /// N = 10^6 and more are looked at through their last pole alone, without summing up to it.
    #[test]
    fn the_last_pole_is_its_own_place() {
        // With so small a k1 the value at the last pole, 2/(nu^2 n_N) = 2 N^(3/2), stands out.
        let spec = weights_only("2", "1/2", "1", "1");
        let data = Data::new(&spec, 128);
        let n = 1_048_577;
        let (k0, k1) = (Rational::from(10_000_000_000_u64), Rational::from((1, 1_000_000_000)));
        let found = sup_ratios(&data, &k0, &k1, &[OscillatorCount::Finite(n)], || ()).remove(0);
        assert_eq!(found.x, Rational::from(n));
        let last = 2.0 * (n as f64).powf(1.5) / (1e10 + 1e-9 * (n as f64).powi(2));
        assert!((found.ratio.lower_f64() / last - 1.0).abs() < 1e-9);
    }
}
