//! What a certificate says of a plant, proved again.

use super::cells::in_cell;
use super::cover::covers;
use super::entries::decide_all;
use super::proofs::{Along, ProvenCell};
use super::refusal::{MAX_STATES, PlantRefusal};
use rug::Rational;
use sigmastar_decide::orbit::{decide_forcing, decide_orbit, decide_second};
use sigmastar_exact::parallel;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::model::Constant;
use sigmastar_lang::spec::{OfPlant, Parameters, ProvedCell, ProvedOrbit, ProvedValues, Specification};
use sigmastar_theory::evidence::ProvedTriple;
use sigmastar_theory::evidence::{Coordinates, OrbitProof};

/// Proves again what a certificate says of a plant, without any search.
///
/// Guarantee: as for [`super::reduce()`].
///
/// # Errors
/// The first part that is not proved.
pub fn decide_again(plant: &Plant, of_plant: OfPlant, values: ProvedValues) -> Result<Specification, PlantRefusal> {
    if plant.states() > MAX_STATES {
        return Err(PlantRefusal::TooManyStates { states: plant.states() });
    }
    plant.prove_periodic().map_err(PlantRefusal::NotPeriodic)?;
    // Of the parameters of this plant, whichever the certificate was made for: an undivided orbit is about their nominal values.
    let own = |cell: &ProvedCell| match of_plant.undivided() {
        Some(_) => plant.parameters.clone(),
        None => plant.parameters.in_cell(&cell.parameters.named_ends()),
    };
    let boxes: Vec<Parameters> = of_plant.cells.iter().map(own).collect();
    if !covers(&boxes, &plant.parameters) {
        return Err(PlantRefusal::Uncovered { cells: boxes.len() });
    }
    let coordinates = Coordinates { l: of_plant.coordinates.clone(), p: of_plant.matrix.clone() };
    let rational = |constant: &Constant| constant.as_rational().cloned().unwrap_or_default();
    let [alpha, p_low, p_up] = [&of_plant.triple.alpha, &of_plant.triple.p_low, &of_plant.triple.p_up].map(rational);
    let second = of_plant.existence.as_deref().map(|(triple, matrix)| {
        let [p_low, p_up, alpha] = [&triple.p_low, &triple.p_up, &triple.alpha].map(rational);
        ProvedTriple { matrix: matrix.clone(), p_low, p_up, alpha }
    });
    let decided = |(ProvedCell { orbit, forcing, .. }, parameters): (&ProvedCell, &Parameters)| {
        let of_cell = in_cell(plant, parameters.clone());
        let ProvedOrbit { approximation, defect, tube, radius } = orbit.clone();
        let [alpha, p_low, p_up] = [&alpha, &p_low, &p_up].map(Rational::clone);
        let orbit = OrbitProof { orbit: approximation, defect, tube, radius, alpha, p_low, p_up };
        decide_orbit(&of_cell, &coordinates, &orbit)?;
        decide_forcing(&of_cell, &coordinates, &orbit, forcing)?;
        if let Some(triple) = &second {
            decide_second(&of_cell, &orbit, &coordinates.l, triple)?;
        }
        Ok(ProvenCell { parameters: parameters.clone(), orbit, forcing: forcing.clone() })
    };
    let cells = parallel::map(&of_plant.cells.iter().zip(&boxes).collect::<Vec<_>>(), |&cell| decided(cell));
    let cells = cells.into_iter().collect::<Result<_, _>>().map_err(PlantRefusal::OrbitNotProved)?;
    let along = Along { coordinates, cells, existence: second, why: None };
    let engine = along.engine(plant)?;
    if let Some([x, e]) = values.reach() {
        engine.smooth(&x, &e)?;
    }
    decide_all(&engine, &values, &plant.internal_model.mu)?;
    along.specification(plant, values)
}
