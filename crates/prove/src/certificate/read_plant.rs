//! Reading what a certificate of a plant adds to the witness. What is read is taken as it is: nothing of it is proved here.

use super::fields::{
    CELLS, EXISTENCE_INEQUALITY, INEQUALITY, JOINT_INEQUALITY, NumberFields, SENSITIVITIES, SPLITTING, rational,
};
use super::read::{each, harmonics, listed, matrix, read_numbers, read_rows, read_triple, vector};
use super::read_joint::{read_joint, read_joint_stability};
use super::triple::{EXISTENCE, STABILITY};
use crate::reduction::FreeNumbers;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{
    Bound, Document, ErrorKind, Errors, ExistenceInequality, MatrixInequality, Object, OfPlant, OrbitCurve, Parameters,
    ProvedCell, ProvedForcing, ProvedOrbit, ProvedValue, ProvedValues, Reported, SampledExistence, SampledInequalities,
    SampledInequality, SpecErrors, Splitting, TrigonometricVector, Value, Wave,
};
use sigmastar_theory::derivation::sampled::SampledWitness;

/// The plant in a certificate, and what its witness says of it; `numbers` are the free numbers of that witness.
///
/// # Errors
/// What is missing, unknown or not exact, in its place.
pub fn read_plant_witness(
    document: &Document,
    numbers: &FreeNumbers,
) -> Result<(Plant, OfPlant, ProvedValues), SpecErrors> {
    let embedded = document.at("/plant").map_or_else(
        || {
            document.root().read(|root, errors| {
                Err(errors.report(root.error(ErrorKind::MissingField, "the field `plant` is missing")))
            })
        },
        |value| Plant::from_value(&value),
    )?;
    let (of_plant, values) = document.root().read(|root, errors| {
        let mut witness = root.object(errors)?.required("witness", errors)?.object(errors)?;
        parts(&mut witness, &embedded, numbers, errors)
    })?;
    Ok((embedded, of_plant, values))
}

fn parts(
    witness: &mut Object<'_>,
    plant: &Plant,
    numbers: &FreeNumbers,
    errors: &mut Errors,
) -> Result<(OfPlant, ProvedValues), Reported> {
    let coordinates = witness.required("coordinates", errors)?;
    let n = plant.states();
    let rows = read_rows(&coordinates, "an entry of L", errors)?;
    if rows.len() != n || rows.iter().any(|row| row.len() != n) {
        let message = format!("a matrix of {n} rows and columns is needed for {n} states");
        return Err(errors.report(coordinates.error(ErrorKind::Range, message)));
    }
    let cells = match witness.optional(CELLS) {
        Some(cells) => read_cells(&cells, witness, plant, errors),
        None => read_cell(witness, plant.parameters.clone(), n, errors).map(|cell| vec![cell]),
    };
    let triple = witness.required(STABILITY, errors).and_then(|value| read_triple(&value, errors));
    let values = witness.required("bounds", errors).and_then(|value| read_values(&value, errors));
    let values = match numbers {
        FreeNumbers::Continuous(_) => with_continuous(values, witness, n, errors),
        FreeNumbers::Sampled(known) => with_sampled(values, witness, known, errors),
    };
    let existence = witness.optional(EXISTENCE).map(|value| read_triple(&value, errors)).transpose();
    let (triple, matrix) = triple?.stated();
    let of_plant = OfPlant {
        parameters: plant.parameters.clone(),
        coordinates: rows,
        cells: cells?,
        why_cut: None,
        triple,
        matrix,
        existence: existence?.map(|triple| Box::new(triple.stated())),
        domain: plant.domain.clone(),
        ball: plant.ball.clone(),
    };
    let values = values?;
    Ok((of_plant, values))
}

/// With the matrix inequalities of the continuous regulator.
fn with_continuous(
    values: Result<ProvedValues, Reported>,
    witness: &mut Object<'_>,
    n: usize,
    errors: &mut Errors,
) -> Result<ProvedValues, Reported> {
    let inequality = witness.optional(INEQUALITY).map(|value| read_inequality(&value, witness, errors));
    let of_existence = witness.optional(EXISTENCE_INEQUALITY);
    // The joint form has metrics.
    let is_joint = of_existence.as_ref().is_some_and(|value| value.member("near").is_some());
    let (joint, single) = if is_joint { (of_existence, None) } else { (None, of_existence) };
    let single = single.map(|value| read_existence(&value, errors));
    let joint = joint.map(|value| read_joint(&value, n, errors));
    let of_joint = witness.optional(JOINT_INEQUALITY).map(|value| read_joint_stability(&value, n, errors));
    Ok(ProvedValues {
        inequality: inequality.transpose()?,
        existence: single.transpose()?,
        joint_existence: joint.transpose()?,
        joint_stability: of_joint.transpose()?,
        ..values?
    })
}

/// With those of the regulator at samples.
fn with_sampled(
    values: Result<ProvedValues, Reported>,
    witness: &mut Object<'_>,
    known: &SampledWitness,
    errors: &mut Errors,
) -> Result<ProvedValues, Reported> {
    let stability = witness.optional(INEQUALITY).map(|value| read_sampled(&value, known, errors));
    let existence = witness.optional(EXISTENCE_INEQUALITY).map(|value| read_sampled_existence(&value, known, errors));
    let at_samples = SampledInequalities { stability: stability.transpose()?, existence: existence.transpose()? };
    Ok(ProvedValues { at_samples, ..values? })
}

fn read_sampled(value: &Value<'_>, known: &SampledWitness, errors: &mut Errors) -> Result<SampledInequality, Reported> {
    read_numbers(value, errors, |_, _| Ok((known.w_x.clone(), known.eta.clone(), known.about())))
}

fn read_sampled_existence(
    value: &Value<'_>,
    known: &SampledWitness,
    errors: &mut Errors,
) -> Result<SampledExistence, Reported> {
    read_numbers(value, errors, |fields, errors| Ok((matrix(fields, "P", errors)?, known.about())))
}

fn read_existence(value: &Value<'_>, errors: &mut Errors) -> Result<ExistenceInequality, Reported> {
    read_numbers(value, errors, |fields, errors| Ok((matrix(fields, "P", errors)?,)))
}

/// The matrix inequality, with the weights of the witness.
fn read_inequality(
    value: &Value<'_>,
    witness: &mut Object<'_>,
    errors: &mut Errors,
) -> Result<MatrixInequality, Reported> {
    let [w_x, h] = ["w_x", "h"].map(|name| rational(witness, name, errors));
    read_numbers(value, errors, |fields, errors| {
        let splitting = fields.optional(SPLITTING).map(|value| read_splitting(&value, errors)).transpose();
        Ok((w_x?, h?, splitting?))
    })
}

fn read_splitting(value: &Value<'_>, errors: &mut Errors) -> Result<Splitting, Reported> {
    read_numbers(value, errors, |fields, errors| Ok((matrix(fields, "S", errors)?,)))
}

/// `orbit` and `forcing`, about the nominal values of these parameters.
fn read_cell(
    fields: &mut Object<'_>,
    parameters: Parameters,
    n: usize,
    errors: &mut Errors,
) -> Result<ProvedCell, Reported> {
    let orbit = fields.required("orbit", errors).and_then(|value| read_orbit(&value, n, errors));
    let forcing = fields.required("forcing", errors).and_then(|value| read_forcing(&value, errors));
    Ok(ProvedCell { parameters, orbit: orbit?, forcing: forcing? })
}

/// Cells, in the place of the one that is the whole box; that they cover it is not looked at.
fn read_cells(
    value: &Value<'_>,
    witness: &mut Object<'_>,
    plant: &Plant,
    errors: &mut Errors,
) -> Result<Vec<ProvedCell>, Reported> {
    if let Some(other) = witness.optional("orbit").or_else(|| witness.optional("forcing")) {
        let message = "an orbit and a forcing beside `cells`, which have their own";
        return Err(errors.report(other.error(ErrorKind::UnknownField, message)));
    }
    let named = plant.parameters.named_intervals().count();
    each(value, errors, |fields, errors| {
        let ends = fields.required("parameters", errors).and_then(|value| {
            let ends = each(&value, errors, |interval, errors| {
                let [low, high] = ["low", "high"].map(|name| rational(interval, name, errors));
                Ok([low?, high?])
            })?;
            if ends.len() != named {
                let message = format!("the ends of {} intervals, and the plant has {named}", ends.len());
                return Err(errors.report(value.error(ErrorKind::Range, message)));
            }
            Ok(ends)
        });
        // What is read beside is told as well.
        let parameters = ends.map(|ends| plant.parameters.in_cell(&ends));
        let read = read_cell(fields, plant.parameters.clone(), plant.states(), errors);
        Ok(ProvedCell { parameters: parameters?, ..read? })
    })
}

fn read_orbit(value: &Value<'_>, n: usize, errors: &mut Errors) -> Result<ProvedOrbit, Reported> {
    let mut fields = value.object(errors)?;
    let centre = read_curve(&mut fields, n, errors);
    let sensitivities = listed(&mut fields, SENSITIVITIES, errors, |part, errors| read_curve(part, n, errors));
    let [defect, tube, radius] = ["defect", "tube", "radius"].map(|name| rational(&mut fields, name, errors));
    fields.finish(errors);
    let approximation = OrbitCurve { centre: centre?, sensitivities: sensitivities? };
    Ok(ProvedOrbit { approximation, defect: defect?, tube: tube?, radius: radius? })
}

/// `mean` and `harmonics` of vectors.
fn read_curve(fields: &mut Object<'_>, n: usize, errors: &mut Errors) -> Result<TrigonometricVector, Reported> {
    let mean = fields.required("mean", errors).and_then(|value| vector(&value, n, errors));
    let harmonics = harmonics(fields, errors, |pair, name, errors| {
        pair.required(name, errors).and_then(|value| vector(&value, n, errors))
    })?;
    Ok(TrigonometricVector { mean: mean?, harmonics })
}

fn read_forcing(value: &Value<'_>, errors: &mut Errors) -> Result<ProvedForcing, Reported> {
    let mut fields = value.object(errors)?;
    let wave = read_wave(&mut fields, errors);
    let sensitivities = listed(&mut fields, SENSITIVITIES, errors, read_wave);
    let [rest, rest_t] = ["rest", "rest_t"].map(|name| rational(&mut fields, name, errors));
    fields.finish(errors);
    let Wave { mean, harmonics } = wave?;
    Ok(ProvedForcing { mean, harmonics, sensitivities: sensitivities?, rest: rest?, rest_t: rest_t? })
}

/// `mean` and `harmonics` of numbers.
fn read_wave(fields: &mut Object<'_>, errors: &mut Errors) -> Result<Wave, Reported> {
    let mean = rational(fields, "mean", errors);
    let harmonics = harmonics(fields, errors, rational)?;
    Ok(Wave { mean: mean?, harmonics })
}

fn read_values(value: &Value<'_>, errors: &mut Errors) -> Result<ProvedValues, Reported> {
    let entries = each(value, errors, |fields, errors| {
        let bound = fields.required("bound", errors).and_then(|value| {
            let name = value.string(errors)?;
            Bound::ALL.into_iter().find(|bound| bound.field() == name).ok_or_else(|| {
                errors.report(value.error(ErrorKind::UnknownName, "this is no bounding function of a plant"))
            })
        });
        ProvedValue::read(fields, errors, |_, _| Ok((bound?, None)))
    });
    entries.map(ProvedValues::new)
}
