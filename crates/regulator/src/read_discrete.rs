//! Reading the law at samples back from the JSON export of a regulator.

use super::Discrete;
use super::export::VERSION;
use super::read::positive;
use sigmastar_lang::spec::{
    Document, ErrorKind, Errors, Object, Reported, SpecErrors, Value, any_constant, read_delay,
};

/// Reads the law at samples back, every number the double that was written; `None` where the file has none, or is of version 1,
/// which had another law.
///
/// # Errors
/// A field that is missing, unknown, or no finite number, in its place.
pub fn read_discrete(document: &Document) -> Result<Option<Discrete>, SpecErrors> {
    document.root().read(discrete)
}

fn discrete(root: &Value<'_>, errors: &mut Errors) -> Result<Option<Discrete>, Reported> {
    let current = root.member("version").is_some_and(|version| version.numeral() == Some(&VERSION.to_string()));
    let Some(law) = root.member("discrete").filter(|law| current && law.type_name() != "null") else { return Ok(None) };
    let mut file = law.object(errors)?;
    for told in ["hold", "law", "sampled_loop"] {
        let _ = file.optional(told);
    }
    let single = |file: &mut Object<'_>, name, errors: &mut Errors| {
        file.required(name, errors).and_then(|value| number(&value, errors))
    };
    let [step, gain, weight_sum, decay, feedthrough] =
        ["step", "K", "weight_sum", "decay", "D"].map(|name| single(&mut file, name, errors));
    let [input, output] =
        ["Gamma", "C"].map(|name| file.required(name, errors).and_then(|value| value.each(errors, number)));
    let phi = file
        .required("Phi", errors)
        .and_then(|value| value.each(errors, |row: &Value<'_>, errors| row.each(errors, number)));
    let delayed = file.optional("delay_samples").map_or(Ok(false), |value| read_delay(&value, errors));
    let prediction = match delayed {
        Ok(true) => single(&mut file, "prediction", errors).map(Some),
        other => other.map(|_| None),
    };
    let saturation = file.optional("saturation").filter(|value| value.type_name() != "null");
    let saturation = saturation.map(|value| positive(&value, errors)).transpose();
    file.finish(errors);
    let (phi, input, output) = (phi?, input?, output?);
    let block = |l: usize| Some([*phi.get(2 * l + 1)?.get(2 * l + 1)?, *phi.get(2 * l + 1)?.get(2 * l + 2)?]);
    let prediction = prediction?;
    // Of z alone.
    let own = input.len().saturating_sub(usize::from(prediction.is_some()));
    let rotations: Option<Vec<[f64; 2]>> = (0..own / 2).map(block).collect();
    let Some(rotations) = rotations.filter(|_| own % 2 == 1 && output.len() == input.len()) else {
        let error = law.error(ErrorKind::Range, "`Phi`, `Gamma` and `C` are of different dimensions");
        return Err(errors.report(error.expected("expected 2 n_o + 1 each, with `delay_samples` one more")));
    };
    Ok(Some(Discrete {
        step: step?,
        gain: gain?,
        weight_sum: weight_sum?,
        decay: decay?,
        prediction,
        rotations,
        input,
        output,
        feedthrough: feedthrough?,
        saturation: saturation?,
    }))
}

fn number(value: &Value<'_>, errors: &mut Errors) -> Result<f64, Reported> {
    Ok(any_constant(value, errors)?.to_f64())
}
