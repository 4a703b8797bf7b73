//! The derivative of a period of the loop.
//!
//! The law is linear in z and e, so its derivative is the law itself, without a limit where it did not clip and with the limit 0
//! where it did. The plant between two samples is a smooth map of (x, e) and u: its derivative is by difference quotients,
//! whose number does not depend on the oscillators.

use super::sampled_loop::{BEGIN, Piece, SampledLoop, SampledRun};
use crate::simulate::adaptive::flow;
use crate::simulate::integration::{IntegrationFailure, Tolerance};
use nalgebra::DMatrix;
use sigmastar_regulator::Stepper;

/// Displacements of difference quotients, relative to 1 + the value: the errors of the formula and of rounding are alike.
pub(super) const DISPLACEMENT: f64 = 1e-5;

/// A column of the derivative on its way.
struct Column {
    plant: Vec<f64>,
    stepper: Stepper,
    held: f64,
}

/// dy(T)/dy(0) for a state y at the first sample, with these displacements; `None` where the law quantises, which has no
/// derivative, or the state has another dimension.
///
/// # Errors
/// [`IntegrationFailure`].
pub fn period_derivative(
    sampled: &SampledLoop,
    y: &[f64],
    displacement: f64,
) -> Result<Option<DMatrix<f64>>, IntegrationFailure> {
    let Some(mut run) = SampledRun::new(sampled, 0, y).filter(|_| sampled.converters.are_smooth()) else {
        return Ok(None);
    };
    let d = sampled.dimension();
    let unit = |at: usize| (0..d).map(move |i| if i == at { 1.0 } else { 0.0 }).collect::<Vec<f64>>();
    let Some(mut columns) = (0..d).map(|at| column(sampled, &unit(at))).collect::<Option<Vec<Column>>>() else {
        return Ok(None);
    };
    let limit = sampled.discrete.saturation;
    for _ in 0..sampled.samples_rounded_up() {
        let work = (d * (8 * sampled.regulator.dimension() + 4 * sampled.states().pow(2) + 8)) as u64;
        sampled.plant().pay(run.time(), work)?;
        let pieces = run.advance(1, Tolerance::TIGHT)?;
        let clipped = limit.is_some_and(|limit| run.put_out().abs() >= limit);
        let maps = pieces.iter().map(|piece| piece_derivative(sampled, piece, displacement));
        let maps: Vec<Vec<Vec<f64>>> = maps.collect::<Result<_, _>>()?;
        for column in &mut columns {
            column.stepper.clip(clipped.then_some(0.0));
            let e = column.plant.last().copied().unwrap_or_default();
            let u = column.stepper.step(e);
            for (at, map) in maps.iter().enumerate() {
                // With a delay the control of the last sample acts first.
                let control = if at == 0 && sampled.delay() > 0.0 { column.held } else { u };
                apply(map, &mut column.plant, control);
            }
            column.held = u;
        }
    }
    let mut matrix = DMatrix::zeros(d, d);
    for (at, column) in columns.iter().enumerate() {
        let held = (sampled.delay() > 0.0).then_some(column.held);
        let values = column.plant.iter().chain(column.stepper.state()).copied().chain(held);
        values.enumerate().for_each(|(row, value)| matrix[(row, at)] = value);
    }
    Ok(Some(matrix))
}

fn column(sampled: &SampledLoop, unit: &[f64]) -> Option<Column> {
    let (plant, rest) = unit.split_at_checked(sampled.states() + 1)?;
    let (z, held) = rest.split_at_checked(sampled.discrete.dimension())?;
    let stepper = Stepper::starting(sampled.regulator.clone(), sampled.discrete.clone(), z.to_vec())?;
    Some(Column { plant: plant.to_vec(), stepper, held: held.first().copied().unwrap_or(0.0) })
}

/// The derivative of (x, e) at the end of a piece by (x, e) at its start and by u, column by column.
fn piece_derivative(
    sampled: &SampledLoop,
    piece: &Piece,
    displacement: f64,
) -> Result<Vec<Vec<f64>>, IntegrationFailure> {
    let mut plant = sampled.plant().clone();
    let Some(start) = piece.states.first() else { return Ok(Vec::new()) };
    let length = piece.unit * (piece.states.len() - 1) as f64;
    let mut columns = Vec::with_capacity(start.len() + 1);
    for at in 0..=start.len() {
        let value = start.get(at).copied().unwrap_or(piece.u);
        let by = displacement * (1.0 + value.abs());
        let mut end = |by: f64| {
            let (mut y, mut u) = (start.clone(), piece.u);
            match y.get_mut(at) {
                Some(value) => *value += by,
                None => u += by,
            }
            plant.hold(u);
            plant.pay(piece.t, BEGIN)?;
            flow(&plant, piece.t, length, &y, Tolerance::TIGHT)
        };
        let (up, down) = (end(by)?, end(-by)?);
        columns.push(up.iter().zip(&down).map(|(a, b)| (a - b) / (2.0 * by)).collect());
    }
    Ok(columns)
}

/// Moves a displacement of (x, e) through a piece.
fn apply(map: &[Vec<f64>], plant: &mut [f64], u: f64) {
    let before: Vec<f64> = plant.iter().copied().chain([u]).collect();
    plant.fill(0.0);
    for (column, factor) in map.iter().zip(&before) {
        plant.iter_mut().zip(column).for_each(|(value, entry)| *value += factor * entry);
    }
}
