//! Where the trade-off curve between k0 and k1 runs for every x >= 0, in floating point: candidates for a proof.
//!
//! A pair is admissible when the line k0 + k1 y lies above every point (y, T) = (x^2, sup_N T_N(x)). So the trade-off
//! is the upper concave hull of these points, its vertices are the lines through consecutive ones, and the smallest k1
//! for a given k0 is the steepest line from (0, k0).

use super::boxes::MAX_M0;
use super::float_sums::FloatSums;
use super::matched::TradeOff;
use crate::data::Data;
use sigmastar_exact::number::Portable;

/// The largest number of oscillators that is sampled.
const POLES: usize = 72;
/// The largest pole around which T is sampled: boxes may have to reach that far.
const REACH: usize = MAX_M0 as usize;
/// The room above the sampled curve, relative, in both members, so that boxes of finite size can prove it.
const ROOM: f64 = 1e-3;
/// The most edges of the hull that a curve keeps.
const MAX_EDGES: usize = 160;
/// k1 falls at most by this factor from one candidate to the next.
const LARGEST_STEP: f64 = 2.0;
/// The share of the cost that is given up for a larger k1: a much smaller one may cost thousands of boxes and gain nothing.
const SLACK: f64 = 1e-3;

/// Points at which peaks of T_N can be seen: a grid up to `reach`, the surroundings of every pole below it at the scale
/// nu c_m of its Lorentzian, and of every zero of g_N between m and m + 1 for the N that `members` names, where T_N
/// peaks with half width 1/(nu g_N').
pub(super) fn sample_points(sums: &FloatSums, reach: usize, members: impl Fn(usize) -> Vec<usize>) -> Vec<f64> {
    const STEPS: [f64; 10] = [0.05, 0.1, 0.2, 0.4, 0.7, 1.0, 1.5, 2.5, 4.0, 8.0];
    let mut points: Vec<f64> = (1..=reach * 32).map(|k| k as f64 / 32.0).collect();
    let mut around = |centre: f64, width: f64| {
        points.push(centre);
        let both = STEPS.iter().flat_map(|step| [centre - width * step, centre + width * step]);
        points.extend(both.filter(|x| (x - centre).abs() <= 0.75));
    };
    for m in 0..reach {
        around(m as f64, sums.nu * sums.residue(m));
        for n in members(m) {
            let (x, width) = sums.peak(m, n);
            around(x, width);
        }
    }
    points.retain(|x| *x > 1e-12);
    points
}

/// A sampled point of the graph.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    /// x > 0.
    pub x: f64,
    /// sup_N T_N(x) over the N sampled.
    pub value: f64,
    /// Where it is attained.
    pub n: usize,
}

/// sup_N T_N, sampled at and around its peaks, in order of x.
#[derive(Clone, Debug)]
pub(super) struct SampledGraph {
    sums: FloatSums,
    samples: Vec<Sample>,
    /// No k1 much smaller passes the scalar test.
    floor: f64,
}

impl SampledGraph {
    pub(super) fn new(data: &Data<'_>) -> SampledGraph {
        let sums = FloatSums::new(data, POLES);
        // N far above m behaves like the largest.
        let points = sample_points(&sums, REACH, |m| (m + 1..m + 7).chain([POLES]).collect());
        // A box is never proved for less than what the scalar test needs beyond the largest m0.
        let m = f64::from(MAX_M0);
        let weights = &data.spec.internal_model.weights;
        let [n_0, n_1, last] = [0, 1, u64::from(MAX_M0)].map(|l| weights.weight_f64(l));
        let sum_bound = (n_0 + n_1 * (2.35 + 1.5 * m.portable_ln())) / (m - 0.5);
        let slope_bound = 3.0 * n_1 + n_0 / (m * m);
        let floor = 2.0 / (m * m * last) * (1.0 / (sums.nu * sums.nu) + sum_bound * sum_bound) + slope_bound / (m * m);
        let mut graph = SampledGraph { sums, samples: Vec::new(), floor };
        graph.add(points);
        // Refine around the vertices of the hull: only they matter.
        for _ in 0..2 {
            let x = |index: usize| graph.samples.get(index).map_or(f64::from(MAX_M0), |sample| sample.x);
            let mut finer = Vec::new();
            for index in graph.hull() {
                let left = if index == 0 { 0.0 } else { x(index - 1) };
                let right = x(index + 1);
                finer.extend((1..12).map(|k| left + (right - left) * f64::from(k) / 12.0));
            }
            graph.add(finer);
        }
        graph
    }

    fn add(&mut self, points: Vec<f64>) {
        let sums = &self.sums;
        let new = points.into_iter().map(|x| {
            let (value, n) = sums.supremum(x);
            Sample { x, value, n }
        });
        self.samples.extend(new.filter(|sample| sample.value.is_finite()));
        self.samples.sort_by(|p, q| p.x.total_cmp(&q.x));
        self.samples.dedup_by(|p, q| p.x == q.x);
    }

    /// The indices of the samples on the upper concave hull that starts at (0, T(0)) and does not fall.
    fn hull(&self) -> Vec<usize> {
        let mut hull: Vec<usize> = Vec::new();
        let point = |index: usize| (self.samples[index].x.portable_powi(2), self.samples[index].value);
        let start = (0.0, self.sums.at_zero());
        for index in 0..self.samples.len() {
            let (y, value) = point(index);
            loop {
                let (before, last) = match hull[..] {
                    [] => break,
                    [last] => (start, point(last)),
                    [.., before, last] => (point(before), point(last)),
                };
                // The last vertex goes when it does not lie above the chord.
                if (last.1 - before.1) * (y - before.0) > (value - before.1) * (last.0 - before.0) {
                    break;
                }
                hull.pop();
            }
            // A falling end supports no line with k1 > 0.
            let last = hull.last().map_or(start, |last| point(*last));
            if value > last.1 {
                hull.push(index);
            }
        }
        hull
    }

    /// The smallest k1 for a given k0, and the sample that forces it up the most.
    pub(super) fn smallest_k1(&self, k0: f64) -> (f64, Option<Sample>) {
        let needed = |sample: &Sample| (sample.value - k0) / (sample.x * sample.x);
        let steepest = self.samples.iter().copied().max_by(|p, q| needed(p).total_cmp(&needed(q)));
        let slope = steepest.as_ref().map_or(0.0, needed);
        (slope.max(self.floor), steepest)
    }

    /// The sample at which T is largest in proportion to k0 + k1 x^2.
    pub(super) fn tightest(&self, k0: f64, k1: f64) -> Option<Sample> {
        let ratio = |sample: &Sample| sample.value / (k0 + k1 * sample.x * sample.x);
        self.samples.iter().copied().max_by(|p, q| ratio(p).total_cmp(&ratio(q)))
    }

    /// Pairs a little above the trade-off, k1 decreasing.
    pub(super) fn trade_off(&self) -> TradeOff {
        let vertices = self.vertices();
        let stride = vertices.len().div_ceil(MAX_EDGES);
        let mut lines: Vec<(f64, f64)> = Vec::new();
        for (k0, k1) in vertices.into_iter().step_by(stride) {
            // Lines between two admissible ones are admissible.
            if let Some((before, steeper)) = lines.last().copied() {
                let ratio = steeper / k1;
                let steps = (ratio.portable_ln() / LARGEST_STEP.portable_ln()).ceil().min(200.0);
                let between = (1..steps as i32).map(|step| {
                    let share =
                        (ratio.portable_pow(f64::from(step) / steps).recip() - ratio.recip()) / (1.0 - ratio.recip());
                    (k0 + (before - k0) * share, k1 + (steeper - k1) * share)
                });
                lines.extend(between.collect::<Vec<_>>());
            }
            lines.push((k0, k1));
        }
        let candidates = lines
            .into_iter()
            .map(|(k0, k1)| (k0 * (1.0 + ROOM), k1 * (1.0 + ROOM), 0))
            .filter(|(k0, k1, _)| k0.is_finite() && k1.is_finite() && *k0 > 0.0)
            .collect();
        TradeOff { candidates, slack: SLACK }
    }

    /// The vertices of the trade-off, k1 decreasing, without any room.
    fn vertices(&self) -> Vec<(f64, f64)> {
        let mut lines = Vec::new();
        let mut from = (0.0, self.sums.at_zero());
        for index in self.hull() {
            let to = (self.samples[index].x.portable_powi(2), self.samples[index].value);
            let slope = (to.1 - from.1) / (to.0 - from.0);
            if slope < self.floor {
                break;
            }
            lines.push((from.1 - slope * from.0, slope));
            from = to;
        }
        // The flattest line that the scalar test allows.
        lines.push((from.1 - self.floor * from.0, self.floor));
        lines
    }
}

impl TradeOff {
    /// Pairs just above the trade-off curve, from k0 just above T(0) on.
    ///
    /// Floating point and sampled: each pair is to be proved by boxes before it is used.
    #[must_use]
    pub fn curve(data: &Data<'_>) -> TradeOff {
        SampledGraph::new(data).trade_off()
    }
}
