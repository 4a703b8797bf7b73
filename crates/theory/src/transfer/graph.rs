//! The graph of T_N in doubles, for a picture.

use super::curve::sample_points;
use super::float_sums::FloatSums;
use super::pole_sums::OscillatorCount;
use crate::data::Data;
use sigmastar_exact::number::Portable;

/// As many poles as a picture can show; larger N look the same.
const POLES: u64 = 256;
/// Points that are spread evenly over the logarithm of x.
const EVEN: u32 = 800;

/// Points (x, T_N(x)) with x increasing from `from` to `to`, 0 < from < to, dense where T_N has peaks. Estimates.
#[must_use]
pub fn transfer_graph(data: &Data<'_>, n_o: OscillatorCount, from: f64, to: f64) -> Vec<(f64, f64)> {
    let poles = match n_o {
        OscillatorCount::Finite(n) => n.min(POLES),
        OscillatorCount::Infinite => POLES,
    } as usize;
    let sums = FloatSums::new(data, poles);
    let reach = poles.min(to.max(0.0).ceil() as usize);
    let mut points = sample_points(&sums, reach, |m| if m < poles { vec![poles] } else { Vec::new() });
    points.extend((0..=EVEN).map(|k| from * (to / from).portable_pow(f64::from(k) / f64::from(EVEN))));
    points.retain(|x| (from..=to).contains(x));
    points.sort_by(f64::total_cmp);
    points.dedup();
    points.into_iter().map(|x| (x, sums.transfer(x, poles))).collect()
}
