//! Reading a regulator back from its JSON export.

use super::Regulator;
use super::export::{FORMAT, VERSIONS};
use sigmastar_lang::spec::{Document, ErrorKind, Errors, Reported, SpecErrors, Value, any_constant};

/// Reads the gains, frequencies and weights of a regulator; the matrices follow from them and are not read.
///
/// # Errors
/// What is missing, unknown, not a number, not positive, or of the wrong length, in its place.
pub fn read_regulator(document: &Document) -> Result<Regulator, SpecErrors> {
    document.root().read(read)
}

fn read(root: &Value<'_>, errors: &mut Errors) -> Result<Regulator, Reported> {
    let mut file = root.object(errors)?;
    file.header(FORMAT, &VERSIONS, errors)?;
    for derived in [
        "name",
        "n_o",
        "harmonics",
        "start",
        "law",
        "Phi",
        "Gamma",
        "M",
        "N_diagonal",
        "discrete",
        "certificate",
        "notice",
    ] {
        let _ = file.optional(derived);
    }
    let sigma = file.required("sigma", errors).and_then(|value| positive(&value, errors));
    let mu = file.required("mu", errors).and_then(|value| positive(&value, errors));
    let frequencies = file.required("frequencies", errors).and_then(|value| value.each(errors, positive));
    let weights = file.required("weights", errors).and_then(|value| {
        let weights = value.each(errors, positive)?;
        let expected = frequencies.as_ref().map_or(weights.len(), |frequencies| frequencies.len() + 1);
        if weights.len() == expected {
            return Ok(weights);
        }
        let message = format!("{} weights for {} frequencies", weights.len(), expected - 1);
        let error = value.error(ErrorKind::Range, message).expected("expected one more than frequencies");
        // The high-gain feedback u = -sigma e has no internal model, and so no file.
        let help = "without an internal model use `simulate --high-gain --sigma V` instead of a file";
        Err(errors.report(if weights.is_empty() { error.help(help) } else { error }))
    });
    let nominal = file.optional("input_gain").map(|value| {
        let mut gain = value.object(errors)?;
        let nominal = gain.required("nominal", errors).and_then(|value| positive(&value, errors));
        gain.finish(errors);
        nominal
    });
    file.finish(errors);
    let nominal = nominal.transpose();
    Ok(Regulator { sigma: sigma?, mu: mu?, frequencies: frequencies?, weights: weights?, nominal: nominal? })
}

pub(super) fn positive(value: &Value<'_>, errors: &mut Errors) -> Result<f64, Reported> {
    let number = any_constant(value, errors)?.to_f64();
    if number > 0.0 && number.is_finite() {
        return Ok(number);
    }
    let error = value.error(ErrorKind::Range, "this number is not a positive double");
    Err(errors.report(error.expected("expected a positive number")))
}
