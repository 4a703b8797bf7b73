//! Reading the claim and the witness of a certificate of the regulator at samples.

use super::fields::{EXISTENCE_INEQUALITY, INEQUALITY, NumberFields, PLANT_FIELDS, rational, read_paths};
use super::read::{COMMON, embedded, own_actuator, read_set, skip_by_count, skip_said, small_integer};
use super::sampled::{REGULATOR, SAMPLED};
use super::triple::{EXISTENCE, STABILITY};
use super::write::{FORMAT, VERSION};
use rug::Rational;
use sigmastar_lang::spec::{
    Document, ErrorKind, Errors, Object, Reported, SampledGain, Sampling, SpecErrors, Value, positive_constant,
    read_delay,
};
use sigmastar_theory::derivation::initial_set::ClaimedSet;
use sigmastar_theory::derivation::sampled::{DelayWitness, SampledWitness};

/// Whether a certificate says that it is about the regulator at samples.
#[must_use]
pub fn is_sampled(document: &Document) -> bool {
    document.at("/claim/regulator").is_some()
}

/// Reads the numbers of the claim and the witness; everything else is known and not used. That the samples are those of the
/// period is not proved here.
///
/// # Errors
/// Every field that is missing, unknown or not an exact rational, with its place.
pub fn read_sampled_witness(document: &Document) -> Result<SampledWitness, SpecErrors> {
    document.root().read(read)
}

fn read(root: &Value<'_>, errors: &mut Errors) -> Result<SampledWitness, Reported> {
    let mut file = root.object(errors)?;
    file.header(FORMAT, &[VERSION], errors)?;
    for unused in COMMON {
        let _ = file.optional(unused);
    }
    let subject = embedded(root);
    let claim = file.required("claim", errors).and_then(|value| read_claim(&value, subject.as_ref(), errors));
    let witness = file.required("witness", errors);
    file.finish(errors);
    let (Claim { sigma, sampling, gain, set }, witness) = (claim?, witness?);
    let mut fields = witness.object(errors)?;
    skip_by_count(&mut fields);
    let of_plant: &[&'static str] = if root.member("plant").is_some() { &PLANT_FIELDS } else { &[] };
    for field in [STABILITY, EXISTENCE].iter().chain(of_plant) {
        if let Some(value) = fields.optional(field).filter(|_| sampling.delayed && BY_MATRIX.contains(field)) {
            let error = value.error(ErrorKind::NotAvailable, format!("`{field}` says nothing of the law with a delay"));
            let expected = "expected a witness by norms, as `certify` writes it for `delay_samples` 1";
            return Err(errors.report(error.expected(expected)));
        }
    }
    let witness = SampledWitness::read(&mut fields, errors, |fields, errors| {
        let weight_sum = rational(fields, "weight_sum", errors);
        let transfer = fields.required("transfer", errors).and_then(|value| read_transfer(&value, errors));
        let law = SampledGain { gain, weight_sum: weight_sum? };
        let paths = read_paths(fields, errors);
        let delay = sampling.delayed.then(|| DelayWitness::read(fields, errors, |_, _| Ok(()))).transpose();
        transfer?;
        Ok((sigma, sampling, law, set, paths?, delay?))
    });
    fields.finish(errors);
    witness
}

/// Matrix inequalities, which are of the law without a delay.
const BY_MATRIX: [&str; 2] = [INEQUALITY, EXISTENCE_INEQUALITY];

/// What the claim contributes to the witness.
struct Claim {
    sigma: Rational,
    sampling: Sampling,
    gain: Rational,
    set: ClaimedSet,
}

fn read_claim(value: &Value<'_>, subject: Option<&Value<'_>>, errors: &mut Errors) -> Result<Claim, Reported> {
    let mut claim = value.object(errors)?;
    skip_said(&mut claim);
    let regulator = word(&mut claim, "regulator", REGULATOR, errors);
    let derivation = word(&mut claim, "derivation", "sharp", errors);
    let sigma = rational(&mut claim, "sigma", errors);
    let step = claim.required("sampling_period", errors).and_then(|value| positive_constant(&value, errors));
    let samples = small_integer(&mut claim, "samples", errors);
    let delayed = claim.optional("delay_samples").map_or(Ok(false), |value| read_delay(&value, errors));
    let gain = rational(&mut claim, "gain", errors);
    let actuator = own_actuator(&mut claim, value, subject, errors);
    let set = read_set(&mut claim, errors);
    claim.finish(errors);
    regulator.and(derivation).and(actuator)?;
    let sampling = Sampling { step: step?, samples: samples?, delayed: delayed? };
    Ok(Claim { sigma: sigma?, sampling, gain: gain?, set: set? })
}

fn read_transfer(value: &Value<'_>, errors: &mut Errors) -> Result<(), Reported> {
    let mut transfer = value.object(errors)?;
    let proof = word(&mut transfer, "proof", SAMPLED, errors);
    transfer.finish(errors);
    proof
}

/// A field that can hold one word only.
fn word(
    object: &mut Object<'_>,
    name: &'static str,
    expected: &'static str,
    errors: &mut Errors,
) -> Result<(), Reported> {
    let value = object.required(name, errors)?;
    let found = value.string(errors)?;
    if found == expected {
        return Ok(());
    }
    let error = value.error(ErrorKind::UnknownName, format!("`{name}` is `{found}`"));
    Err(errors.report(error.expected(format!("expected `{expected}`"))))
}
