//! Where a slope is extreme over all errors, for samples: a friction that changes over a small part of them is not seen by shares of the
//! largest one.

use sigmastar_exact::number::Portable;

/// It is sought at these powers of ten, of either sign, so many to each, and by so many steps between neighbours.
const DECADES: std::ops::RangeInclusive<i32> = -6..=6;
const IN_A_DECADE: i32 = 4;
const STEPS_BETWEEN: u32 = 24;

/// The share of the changes of the slope that is worth a place of its own.
const WORTH_A_PLACE: f64 = 0.01;

/// At each of so many times the errors at which the slope is largest and least; none where these are 0 and the largest errors alone.
pub(super) fn extreme_errors(times: usize, mut slope: impl FnMut(usize, f64) -> f64) -> Option<Vec<[f64; 2]>> {
    let part = |part: i32| 10f64.portable_pow(f64::from(part) / f64::from(IN_A_DECADE));
    let sizes = DECADES.flat_map(|k| (0..IN_A_DECADE).map(move |of| (k, of)));
    let positive: Vec<f64> = sizes.map(|(k, of)| 10f64.portable_powi(k) * part(of)).collect();
    let negative = positive.iter().rev().map(|size| -size);
    let grid: Vec<f64> = negative.chain([0.0]).chain(positive.iter().copied()).collect();
    let last = grid.len() - 1;
    let (mut found, mut gain, mut spread) = (Vec::new(), 0.0_f64, 0.0_f64);
    for time in 0..times {
        let values: Vec<f64> = grid.iter().map(|e| slope(time, *e)).collect();
        let extreme = [1.0, -1.0].map(|sign| {
            let value = |i: usize| if values[i].is_finite() { sign * values[i] } else { f64::NEG_INFINITY };
            let best = (0..=last).max_by(|i, j| value(*i).total_cmp(&value(*j))).unwrap_or(0);
            let (mut e, mut largest) = (grid[best], value(best));
            let mut step = 0.5 * (grid[(best + 1).min(last)] - grid[best.saturating_sub(1)]);
            for _ in 0..STEPS_BETWEEN {
                let next = [e - step, e + step].map(|e| e.clamp(grid[0], grid[last]));
                let [below, above] = next.map(|e| (sign * slope(time, e), e));
                let (other, place) = if below.0 > above.0 { below } else { above };
                if other > largest {
                    (largest, e) = (other, place);
                } else {
                    step *= 0.5;
                }
            }
            let seen = [0, last / 2, last].into_iter().map(value).fold(f64::NEG_INFINITY, f64::max);
            gain = gain.max(largest - seen);
            (e, sign * largest)
        });
        spread = spread.max(extreme[0].1 - extreme[1].1);
        found.push(extreme.map(|(e, _)| e));
    }
    (gain > WORTH_A_PLACE * spread).then_some(found)
}
