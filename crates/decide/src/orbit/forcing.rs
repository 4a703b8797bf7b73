//! The harmonics qb of q(t, x_0, 0) and the bounds r_0, r_1 of their rest, decided over enclosures for given harmonics (derivation, 11.4).

use super::around::Around;
use super::cells::enclose;
use super::curve::PRECISION;
use super::defect::{CELLS, ORDER, first_exponent, largest};
use super::linear::norm;
use super::not_proved::OrbitNotProved;
use super::recurrences::{combine, mul};
use super::taylor::Expansion;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::parallel;
use sigmastar_lang::expr::{Enclosing, Formula, Formulas, PlantVariable, Walk};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::ProvedForcing;
use sigmastar_theory::evidence::{Coordinates, MAX_HARMONICS, OrbitProof};

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

/// Upper bounds of r_0 and r_1 of 11.4, over more and smaller cells while one of them is above `enough`, and above twice its
/// terms in r and eps, which smaller cells do not change much; the least of each.
pub fn rests(
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
