//! The periodic solution of x' = f(t, x, 0) in doubles: from 0 or from a simulation, with as many harmonics as it needs.

use super::collocation::collocate;
use super::drift::drift;
use super::failure::OrbitFailure;
use super::field::Field;
use super::floquet::{floquet_exponents, is_neutral, is_stable};
use super::series::{FloatSeries, Turn};
use nalgebra::DVector;
use rug::Rational;
use sigmastar_lang::plant::Plant;
use sigmastar_theory::evidence::MAX_STATES;
use sigmastar_theory::undefined_along;

/// The numbers of harmonics, in turn.
const HARMONICS: [usize; 5] = [8, 16, 32, 64, 128];

/// Unknowns of Newton's method; its effort grows with their cube.
const MAX_UNKNOWNS: usize = 1_200;

/// From here on more harmonics are not worth it: a defect relative to the size of the terms.
const SMALL_DEFECT: f64 = 1e-11;

/// A defect that does not fall any more is accepted below this.
const RESOLVED: f64 = 1e-6;

/// Points for each one of the collocation at which the defect is sampled.
const BETWEEN: usize = 4;

/// Periods that are simulated before Newton's method is tried again.
const APPROACHES: [usize; 2] = [10, 100];

/// Where x = 0 is singular, as a level's root is, these values of all components are tried, in the units of the field.
const SIZES: [f64; 7] = [1.0, 0.1, 10.0, 0.01, 100.0, 1e-4, 1e4];

/// Times of a period at which that is looked at.
const TIMES: u8 = 16;

/// Steps of a simulated period, and of all of them.
const LEAST_STEPS: usize = 128;
const MAX_STEPS: usize = 400_000;

/// A curve that nearly solves x' = f(t, x, 0), in doubles.
#[derive(Clone, Debug)]
pub struct FloatOrbit {
    /// The curve.
    pub series: FloatSeries,
    /// The largest `|f(t,xb,0) - xb'|` at sampled times relative to the size of the two terms.
    pub defect: f64,
    /// The Floquet exponents along it, as in [`OrbitFailure::NotStable`].
    pub floquet: Vec<[f64; 2]>,
    /// How the curve changes with each parameter of which an interval is known: by the quotient of differences between its ends.
    pub sensitivities: Vec<FloatSeries>,
}

/// The periodic solution of a plant's zero dynamics, in doubles; of a family that of the nominal plant, and its sensitivities.
///
/// Guarantee: none; `prove_orbit` of sigmastar-prove proves one.
///
/// # Errors
/// [`OrbitFailure`]: none was found, or none that attracts its neighbours; nothing is proved by that.
pub fn find_orbit(plant: &Plant) -> Result<FloatOrbit, OrbitFailure> {
    let nominal = plant.parameters.nominal();
    let mut found = find_one(&plant.member(&nominal))?;
    for (i, interval) in plant.parameters.intervals().enumerate() {
        let at = |end: &Rational| {
            let mut values = nominal.clone();
            values[i] = end.clone();
            find_one(&plant.member(&values)).map(|orbit| orbit.series)
        };
        let (low, high) = (at(&interval.low)?, at(&interval.high)?);
        found.sensitivities.push(high.slope_from(&low, Rational::from(&interval.high - &interval.low).to_f64()));
    }
    Ok(found)
}

/// The orbit of a single plant.
fn find_one(plant: &Plant) -> Result<FloatOrbit, OrbitFailure> {
    let n = plant.states();
    if n > MAX_STATES {
        return Err(OrbitFailure::TooLarge { states: n });
    }
    let mut field = Field::new(plant);
    if n == 0 {
        return Ok(FloatOrbit {
            series: FloatSeries::zero(0),
            defect: 0.0,
            floquet: Vec::new(),
            sensitivities: Vec::new(),
        });
    }
    // Another start may lead to another orbit: the first that is stable is taken, and the first failure told.
    let own = |mean: &[f64]| field.own(&FloatSeries::constant(mean)).mean;
    let (zero, initial) = (own(&vec![0.0; n]), own(&plant.initial.x));
    let singular = !is_finite_at(&mut field, &zero);
    // Where the right sides have no value at 0, other sizes do as well.
    let mut states = vec![zero, initial];
    states.extend(SIZES.into_iter().filter(|_| singular).map(|size| vec![size; n]));
    let constant = states.iter().take(if singular { states.len() } else { 1 }).map(|start| (start, 0));
    let simulated = APPROACHES.into_iter().flat_map(|periods| states.iter().map(move |start| (start, periods)));
    let mut first = None;
    for (start, periods) in constant.chain(simulated) {
        let curve = match periods {
            0 => Some(FloatSeries::constant(start)),
            _ => simulate(&mut field, start, periods),
        };
        let Some(curve) = curve else { continue };
        match from(&mut field, &curve) {
            Ok(orbit) => return Ok(FloatOrbit { series: field.written(&orbit.series), ..orbit }),
            // An unstable orbit says more than none.
            Err(failure @ OrbitFailure::NotStable { .. }) if !matches!(first, Some(OrbitFailure::NotStable { .. })) => {
                first = Some(failure);
            }
            Err(failure) => first = first.or(Some(failure)),
        }
    }
    if let None | Some(OrbitFailure::NotFinite | OrbitFailure::NotFound { .. }) = first
        && let Some(failure) = without_values(plant, singular)
    {
        return Err(failure);
    }
    match first {
        // What the exponents are of, or why there is no solution.
        Some(OrbitFailure::NotStable { floquet }) if is_neutral(&floquet, field.period) => {
            let named = drift(&mut field, plant.names.states(), false);
            Err(named.unwrap_or(OrbitFailure::NotStable { floquet }))
        }
        Some(failure @ OrbitFailure::NotFound { .. }) => {
            Err(drift(&mut field, plant.names.states(), true).unwrap_or(failure))
        }
        first => Err(first.unwrap_or(OrbitFailure::NotFinite)),
    }
}

/// Why no orbit was found where the right sides have no values: at an instant, whatever the state, or where the search starts.
fn without_values(plant: &Plant, singular: bool) -> Option<OrbitFailure> {
    let cause = undefined_along(plant, |_| plant.initial.x.clone()).map(Box::new);
    match cause {
        Some(cause) if cause.states.is_none() && cause.index < plant.states() => Some(OrbitFailure::Undefined(cause)),
        cause => singular.then(|| OrbitFailure::Singular { stated: plant.document.get("initial").is_some(), cause }),
    }
}

/// Whether the right sides and their derivatives have values at a state, at some times of a period.
fn is_finite_at(field: &mut Field, x: &[f64]) -> bool {
    (0..TIMES).all(|at| {
        field.set(f64::from(at) / f64::from(TIMES), x, 0.0);
        field.f().iter().chain(field.jacobian().iter()).all(|value| value.is_finite())
    })
}

/// Newton's method from a curve, with more and more harmonics.
fn from(field: &mut Field, start: &FloatSeries) -> Result<FloatOrbit, OrbitFailure> {
    let mut best: Option<(FloatSeries, f64)> = None;
    let mut failure = OrbitFailure::NotFinite;
    let n = field.states();
    for harmonics in HARMONICS.into_iter().filter(|k| *k == HARMONICS[0] || (2 * k + 1) * n <= MAX_UNKNOWNS) {
        let curve = best.as_ref().map_or(start, |(series, _)| series);
        let found = collocate(field, curve, harmonics);
        if !found.converged() {
            if found.residual.is_finite() && best.is_none() {
                failure = OrbitFailure::NotFound { residual: found.residual, harmonics };
            }
            continue;
        }
        let defect = defect(field, &found.series);
        let last = best.as_ref().map_or(f64::INFINITY, |(_, defect)| *defect);
        if defect < last {
            best = Some((found.series, defect));
        }
        if defect <= SMALL_DEFECT || (last <= RESOLVED && defect > last / 2.0) {
            break;
        }
    }
    let Some((series, defect)) = best else { return Err(failure) };
    let floquet = floquet_exponents(field, &series).ok_or(OrbitFailure::NotFinite)?;
    if !is_stable(&floquet, field.period) {
        return Err(OrbitFailure::NotStable { floquet });
    }
    Ok(FloatOrbit { series, defect, floquet, sensitivities: Vec::new() })
}

/// The largest `|f(t,xb,0) - xb'|` between the points, relative to the size of the terms; NaN counts as infinite.
pub(super) fn defect(field: &mut Field, series: &FloatSeries) -> f64 {
    let turn = Turn::new(BETWEEN * (2 * series.harmonics.len() + 1).max(2 * HARMONICS[0]));
    let (mut largest, mut size) = (0.0_f64, 0.0_f64);
    for j in 0..turn.parts() {
        let (x, slope) = series.at_part(&turn, j);
        field.set(j as f64 / turn.parts() as f64, &x, 0.0);
        let f = field.f() * field.period;
        size = size.max(field.size(&x));
        for i in 0..x.len() {
            let difference = (f[i] - slope[i]).abs();
            if !difference.is_finite() {
                return f64::INFINITY;
            }
            largest = largest.max(difference);
            size = size.max(slope[i].abs());
        }
    }
    if largest == 0.0 { 0.0 } else { largest / size }
}

/// The last of so many periods from a state at t = 0 by the classical Runge-Kutta rule; `None` where it leaves the doubles or
/// the zero dynamics are too stiff for it.
fn simulate(field: &mut Field, start: &[f64], periods: usize) -> Option<FloatSeries> {
    let kept = 2 * HARMONICS[1] + 1;
    field.set(0.0, start, 0.0);
    // |J| h is at most 1/2.
    let needed = 2.0 * field.jacobian().norm() * field.period;
    let per_sample = (needed.max(LEAST_STEPS as f64) / kept as f64).ceil();
    // False for NaN as well.
    let affordable = per_sample * (kept * periods) as f64 <= MAX_STEPS as f64;
    if !affordable {
        return None;
    }
    let per_sample = per_sample as usize;
    let steps = per_sample * kept;
    let h = 1.0 / steps as f64;
    let mut x = DVector::from_column_slice(start);
    let mut samples = Vec::with_capacity(kept);
    let mut right = |s: f64, x: &DVector<f64>| {
        field.set(s, x.as_slice(), 0.0);
        field.f() * field.period
    };
    for period in 0..periods {
        for step in 0..steps {
            if period + 1 == periods && step % per_sample == 0 {
                samples.push(x.as_slice().to_vec());
            }
            let s = step as f64 * h;
            let k1 = right(s, &x);
            let k2 = right(s + h / 2.0, &(&x + &k1 * (h / 2.0)));
            let k3 = right(s + h / 2.0, &(&x + &k2 * (h / 2.0)));
            let k4 = right(s + h, &(&x + &k3 * h));
            x += (k1 + (k2 + k3) * 2.0 + k4) * (h / 6.0);
        }
        if !x.iter().all(|entry| entry.is_finite()) {
            return None;
        }
    }
    Some(FloatSeries::from_samples(&samples, HARMONICS[1]))
}
