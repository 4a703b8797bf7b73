//! The harmonics of q(t, x_0, 0) (derivation, 11.4): proposed in doubles, the rest proved.

use super::cells::enclose;
use super::coordinates::Coordinates;
use super::curve::{MAX_HARMONICS, PRECISION};
use super::defect::{CELLS, CLOSE, ORDER, first_exponent, largest};
use super::failure::OrbitNotProved;
use super::field::Field;
use super::linear::norm;
use super::prove::{Around, OrbitProof, with_cause};
use super::recurrences::{combine, mul};
use super::round::to_grain;
use super::sampled::doubles;
use super::series::FloatSeries;
use super::taylor::Expansion;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, Portable, round_f64};
use sigmastar_exact::parallel;
use sigmastar_lang::expr::{Enclosing, Formula, Formulas, PlantVariable, Walk};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{OrbitCurve, ProvedForcing, TrigonometricVector, Wave};
use std::f64::consts::TAU;

/// The most harmonics of qb that are proposed, and the points of the transform.
const PROPOSED_HARMONICS: usize = 128;
const POINTS: usize = 1024;

/// What is left out and rounded, relative to the root mean square of q(t,x_0,0) and of its derivative.
const WANTED_REST: f64 = 1e-8;

/// Significant digits of the bounds of the rest.
const DIGITS: u32 = 6;

/// The least size of the derivative (per period) relative to that of q: what varies less is rounding.
const LEAST_SLOPE: f64 = 1e-2;

/// The least rest that is looked for, as a share of the size: below it cells are not made smaller for it.
const NEGLIGIBLE_REST: f64 = 1e-12;

/// The harmonics of q along a curve.
fn harmonics_of(plant: &Plant, orbit: &TrigonometricVector) -> FloatSeries {
    let mut field = Field::new(plant);
    let curve = field.own(&doubles(orbit));
    let sample = |j: usize| {
        let s = j as f64 / POINTS as f64;
        field.set(s, &curve.at(s).0, 0.0);
        vec![field.q()]
    };
    let samples: Vec<Vec<f64>> = (0..POINTS).map(sample).collect();
    FloatSeries::from_samples(&samples, PROPOSED_HARMONICS)
}

/// qb in doubles, rounded: the harmonics that matter, with short coefficients, and how they change with the parameters of which
/// intervals are known, by quotients of differences. `None` where q is not finite.
fn propose(plant: &Plant, orbit: &OrbitCurve) -> Option<(Wave, Vec<Wave>)> {
    let nominal = plant.parameters.nominal();
    let of_member =
        |values: &[Rational]| harmonics_of(&plant.member(values), &orbit.at(&plant.parameters.deviations(values)));
    let series = of_member(&nominal);
    let pairs: Vec<[f64; 2]> = series.harmonics.iter().map(|[a, b]| [a[0], b[0]]).collect();
    let mean = series.mean[0];
    let amplitude = |[a, b]: [f64; 2]| libm::hypot(a, b);
    let square = |weight: &dyn Fn(usize) -> f64| -> f64 {
        pairs.iter().enumerate().map(|(at, pair)| (weight(at + 1) * amplitude(*pair)).portable_powi(2) / 2.0).sum()
    };
    let size = (mean * mean + square(&|_| 1.0)).sqrt();
    let slope = square(&|k| TAU * k as f64).sqrt().max(LEAST_SLOPE * size);
    if !(size.is_finite() && slope.is_finite()) {
        return None;
    }
    // From the highest harmonic down, those are left out that do not matter together.
    let (mut count, mut left_out, mut left_out_slope) = (pairs.len(), 0.0, 0.0);
    while let Some(pair) = count.checked_sub(1).and_then(|last| pairs.get(last)) {
        left_out += amplitude(*pair);
        left_out_slope += TAU * count as f64 * amplitude(*pair);
        if left_out > WANTED_REST * size || left_out_slope > WANTED_REST * slope {
            break;
        }
        count -= 1;
    }
    let number = (2 * count + 1) as f64;
    let unit = |k: usize| -> f64 {
        let of_slope = if k == 0 { f64::INFINITY } else { WANTED_REST * slope / (TAU * k as f64) };
        (WANTED_REST * size).min(of_slope) / number.sqrt()
    };
    let round = |value: f64, k: usize| match value == 0.0 {
        true => Some(Rational::new()),
        false => to_grain(value, unit(k).max(f64::MIN_POSITIVE)),
    };
    let rounded = |mean: f64, pairs: &[[f64; 2]]| -> Option<Wave> {
        let pairs = pairs.iter().enumerate().map(|(at, [a, b])| Some([round(*a, at + 1)?, round(*b, at + 1)?]));
        Some(Wave { mean: round(mean, 0)?, harmonics: pairs.collect::<Option<_>>()? })
    };
    let sensitivities = plant.parameters.intervals().enumerate().map(|(i, interval)| {
        let at = |end: &Rational| {
            let mut values = nominal.clone();
            values[i] = end.clone();
            of_member(&values)
        };
        let width = Rational::from(&interval.high - &interval.low).to_f64();
        let change = at(&interval.high).slope_from(&at(&interval.low), 1.0);
        let pairs: Vec<[f64; 2]> = change.harmonics.iter().map(|[a, b]| [a[0], b[0]]).collect();
        // Rounded as what is added, and not as the quotient.
        let wave = rounded(change.mean[0], &pairs[..count])?;
        let width = Rational::from_f64(width)?;
        Some(wave.map(|value| Rational::from(value / &width)))
    });
    let sensitivities = sensitivities.collect::<Option<_>>()?;
    Some((rounded(mean, &pairs[..count])?, sensitivities))
}

/// The harmonics of q(t, x_0, 0) for a proved orbit, with the rest proved.
///
/// # Errors
/// [`OrbitNotProved`]; nothing is claimed then.
pub fn prove_forcing(
    plant: &Plant,
    coordinates: &Coordinates,
    proved: &OrbitProof,
) -> Result<ProvedForcing, OrbitNotProved> {
    let around = Around::new(plant, &proved.orbit, coordinates)?;
    let none = OrbitNotProved::Shape("q(t,xb,0) is not finite in floating point");
    let (Wave { mean, harmonics }, sensitivities) = propose(plant, &proved.orbit).ok_or_else(|| none.clone())?;
    let mut forcing = ProvedForcing { mean, harmonics, sensitivities, rest: Rational::new(), rest_t: Rational::new() };
    let sizes = sampled_rests(plant, &proved.orbit, &forcing);
    let found = rests(&around, &forcing, proved, sizes.map(|size| CLOSE * size));
    let [rest, rest_t] = found.map_err(|failure| with_cause(failure, plant, &proved.orbit))?;
    let up = |bound: &Enclosure| round_f64(bound.upper_f64(), DIGITS, Direction::Up).ok_or_else(|| none.clone());
    forcing.rest = up(&rest)?;
    forcing.rest_t = up(&rest_t)?;
    Ok(forcing)
}

/// Decides qb and its rests again for a proved orbit, which has to be decided apart.
///
/// # Errors
/// What is not proved; nothing is said about its truth.
pub fn decide_forcing(
    plant: &Plant,
    coordinates: &Coordinates,
    proved: &OrbitProof,
    forcing: &ProvedForcing,
) -> Result<(), OrbitNotProved> {
    let around = Around::new(plant, &proved.orbit, coordinates)?;
    let stated = [&forcing.rest, &forcing.rest_t];
    // Just below, so that rounding does not ask for smaller cells than the bound needs.
    let found = rests(&around, forcing, proved, stated.map(|stated| stated.to_f64() * (1.0 - f64::EPSILON)))?;
    for (found, stated) in found.iter().zip(stated) {
        if !found.le(&Enclosure::from_rational(stated, PRECISION)).is_true() {
            return Err(OrbitNotProved::Rest { found: found.upper_f64(), stated: stated.to_f64() });
        }
    }
    Ok(())
}

/// The largest rests of all members that are looked at.
fn sampled_rests(plant: &Plant, orbit: &OrbitCurve, forcing: &ProvedForcing) -> [f64; 2] {
    let members = plant.parameters.looked_at();
    members.iter().fold([0.0; 2], |largest, values| {
        let deviations = plant.parameters.deviations(values);
        let found = rests_of_member(&plant.member(values), &orbit.at(&deviations), &forcing.at(&deviations));
        [0, 1].map(|i| f64::max(largest[i], found[i]))
    })
}

/// The largest rests at sampled times, in doubles, but no less than what is negligible.
fn rests_of_member(plant: &Plant, orbit: &TrigonometricVector, forcing: &Wave) -> [f64; 2] {
    let mut field = Field::new(plant);
    let curve = field.own(&doubles(orbit));
    let vector = |value: &Rational| vec![value.to_f64()];
    let harmonics = forcing.harmonics.iter().map(|pair| pair.each_ref().map(vector)).collect();
    let qb = FloatSeries { mean: vector(&forcing.mean), harmonics };
    let samples = (0..POINTS).map(|j| {
        let s = (j as f64 + 0.5) / POINTS as f64;
        field.set(s, &curve.at(s).0, 0.0);
        (field.q(), qb.at(s).0[0])
    });
    let (mut rest, mut rest_t, mut size, mut last) = (0.0_f64, 0.0_f64, 0.0_f64, None);
    for (q, qb) in samples {
        let difference = q - qb;
        rest = rest.max(difference.abs());
        size = size.max(q.abs());
        // A quotient of differences is close enough for an estimate.
        rest_t = rest_t.max(last.map_or(0.0, |last: f64| (difference - last).abs() * POINTS as f64));
        last = Some(difference);
    }
    let period = field.period;
    let least = NEGLIGIBLE_REST * size;
    [rest.max(least), rest_t.max(least * TAU) / period]
}

/// Upper bounds of r_0 and r_1 of 11.4, over more and smaller cells while one of them is above `enough`, and above twice its
/// terms in r and eps, which smaller cells do not change much; the least of each.
fn rests(
    around: &Around<'_>,
    forcing: &ProvedForcing,
    proved: &OrbitProof,
    enough: [f64; 2],
) -> Result<[Enclosure; 2], OrbitNotProved> {
    let of_forcing =
        forcing.sensitivities.iter().map(|part| part.harmonics.len()).fold(forcing.harmonics.len(), usize::max);
    if of_forcing > MAX_HARMONICS {
        return Err(OrbitNotProved::Shape("too many harmonics"));
    }
    if forcing.sensitivities.len() != around.members.sensitivities.len() {
        return Err(OrbitNotProved::Shape("the forcing has not one sensitivity for each parameter with an interval"));
    }
    let formulas = Rows::new(around.plant);
    let harmonics = around.harmonics().max(of_forcing);
    let mut best: Result<[Enclosure; 2], OrbitNotProved> = Err(OrbitNotProved::NotSmooth { s: 0.0, cause: None });
    for exponent in first_exponent(harmonics)..=*CELLS.end() {
        let (found, of_radius) = match rests_on(around, &formulas, forcing, proved, exponent) {
            Ok(found) => found,
            Err(failure) => {
                best = best.or(Err(failure));
                continue;
            }
        };
        best = Ok(match best {
            Ok(best) => {
                [0, 1].map(|i| if found[i].upper() < best[i].upper() { found[i].clone() } else { best[i].clone() })
            }
            Err(_) => found,
        });
        let reached = |bounds: &[Enclosure; 2]| {
            (0..2).all(|i| bounds[i].upper_f64() <= enough[i].max(2.0 * of_radius[i].upper_f64()))
        };
        if best.as_ref().is_ok_and(reached) {
            break;
        }
    }
    best
}

/// The formulas of 11.4 at e = 0.
struct Rows {
    /// q.
    value: Walk,
    /// q_x and D_x.
    derivatives: Walk,
    /// q_x, and then q_p for each parameter.
    slopes: Walk,
    /// f and q, to see that both are smooth where the derivatives are taken.
    smooth: Walk,
}

impl Rows {
    fn new(plant: &Plant) -> Rows {
        let states = || (0..plant.states()).map(PlantVariable::State);
        let mut formulas = Formulas::new();
        let mut all: Vec<Formula> = plant.f.iter().map(|f| formulas.insert(f)).collect();
        let q = formulas.insert(&plant.q);
        let slope = |formulas: &mut Formulas, of: Formula, variable| formulas.derivatives(&[of], variable)[0];
        let q_x: Vec<Formula> = states().map(|state| slope(&mut formulas, q, state)).collect();
        // D = q_t + q_x f.
        let mut along = plant.derivatives_in_time(&mut formulas, &[q])[0];
        for (q_x, f) in q_x.iter().zip(&all) {
            let term = formulas.product(*q_x, *f);
            along = formulas.sum(along, term);
        }
        let d_x: Vec<Formula> = states().map(|state| slope(&mut formulas, along, state)).collect();
        let rows: Vec<Formula> = q_x.iter().copied().chain(d_x).collect();
        let parameters = (0..plant.parameters.intervals().count()).map(PlantVariable::Parameter);
        let slopes: Vec<Formula> =
            q_x.into_iter().chain(parameters.map(|parameter| slope(&mut formulas, q, parameter))).collect();
        all.push(q);
        let [value, derivatives] = [vec![q], rows].map(|outputs| formulas.walk(&outputs));
        Rows { value, derivatives, slopes: formulas.walk(&slopes), smooth: formulas.walk(&all) }
    }
}

/// The two bounds over `2^exponent` cells, and their terms in r and eps.
fn rests_on(
    around: &Around<'_>,
    formulas: &Rows,
    forcing: &ProvedForcing,
    proved: &OrbitProof,
    exponent: u32,
) -> Result<([Enclosure; 2], [Enclosure; 2]), OrbitNotProved> {
    let n = around.plant.states();
    let qb = forcing.nominal().map(enclose);
    let parts: Vec<_> = forcing.sensitivities.iter().map(|part| part.map(enclose)).collect();
    let curve = around.curve(exponent, std::iter::once(&qb).chain(&parts));
    let parameters = &around.members.parameters;
    let cells = &curve.cells;
    let (radius, defect, zero) = (enclose(&proved.radius), enclose(&proved.defect), Enclosure::zero(PRECISION));
    let reach: Vec<Enclosure> = around.l.iter().map(|row| norm(row.iter().cloned(), PRECISION) * &radius).collect();
    // The norm of a row times L.
    let norm_of = |row: &[Enclosure]| {
        let column = |j: usize| (0..n).fold(zero.clone(), |sum, i| sum + &row[i] * &around.l[i][j]);
        norm((0..n).map(column), PRECISION)
    };
    let bounds: Vec<[Enclosure; 4]> = parallel::numbered(cells.count, |cell| {
        let states = curve.states(cell, ORDER + 1);
        let own = curve.along(&formulas.value, cell, (&states, &parameters.nominal), ORDER);
        let known = cells.expand(&qb, cell, ORDER);
        let [middle, over] = [0, 1].map(|which| combine(&own[which][0], &known[which], -1));
        let expansion = Expansion::new(&middle, &over, ORDER, PRECISION);
        // By the mean value theorem in p, as the defect.
        let sensitivities = curve.sensitivities(cell, ORDER + 1);
        let members = curve.of_members(&states, &sensitivities, parameters);
        let values = if parts.is_empty() {
            [Vec::new(), Vec::new()]
        } else {
            curve.along(&formulas.slopes, cell, (&members, &parameters.values), ORDER)
        };
        let in_parameters: Vec<Expansion> = (0..parts.len())
            .map(|i| {
                let known = cells.expand(&parts[i], cell, ORDER);
                let [middle, over] = [0, 1].map(|which| {
                    let own = combine(&values[which][n + i], &known[which], -1);
                    (0..n).fold(own, |sum, j| {
                        combine(&sum, &mul(&values[which][j], &sensitivities[i][which][j], ORDER), 1)
                    })
                });
                Expansion::new(&middle, &over, ORDER, PRECISION)
            })
            .collect();
        let with_members = |own: Enclosure, bound: &dyn Fn(&Expansion) -> Enclosure| {
            let parts = in_parameters.iter().zip(&parameters.reaches);
            parts.fold(own, |sum, (part, reach)| sum + bound(part) * reach)
        };
        let widened = members[1].iter().zip(&reach).map(|(series, reach)| &series[0] + reach.negate().hull(reach));
        let tube: Vec<Enclosure> = widened.collect();
        let [_, time] = cells.time(cell, &curve.period);
        if !curve.in_box(&formulas.smooth, &time[0], &tube) {
            return [(); 4].map(|()| Enclosure::undefined(PRECISION));
        }
        let mut natural = Enclosing { t: &time[0], x: &tube, e: &zero, p: &parameters.values, precision: PRECISION };
        let rows = formulas.derivatives.evaluate(&mut natural);
        let [of_q, of_d] = [norm_of(&rows[..n]), norm_of(&rows[n..])];
        let [rest, rest_t] = [&radius * &of_q, &radius * of_d + &defect * of_q];
        let value = with_members(expansion.bound(&cells.half), &|part| part.bound(&cells.half)) + &rest;
        let slope = with_members(expansion.slope_bound(&cells.half), &|part| part.slope_bound(&cells.half));
        let slope = slope / &curve.elapsed + &rest_t;
        [value, slope, rest, rest_t]
    });
    let bound = |which: usize| {
        let own: Vec<Enclosure> = bounds.iter().map(|all| all[which].clone()).collect();
        largest(&own, cells.count)
    };
    Ok(([bound(0)?, bound(1)?], [bound(2)?, bound(3)?]))
}
