//! A certificate as a theorem: the text of a Coq file that states what a certificate in continuous time says and proves it, by the
//! theorems of `proofs-check/coq`.
//!
//! Nothing is decided here, not even whether the numbers fit together: they are written as the certificate has them, and Coq refuses a
//! file whose conditions do not hold. What a specification must be to be one at all is read by the rules of the checker.

mod numbers;
mod plants;
mod terms;
mod text;

use proofs_core::json::{Field, MAX_BYTES, parse};
use proofs_core::rules::claim::Claim;
use proofs_core::rules::common::Free;
use proofs_core::rules::derivation::{Derivation, Witness};
use proofs_core::rules::inequality::List;
use proofs_core::rules::sharp;
use proofs_core::sha256;
use proofs_core::spec::{Specification, header};
use proofs_core::verdict::{Outcome, bad};
use rug::Rational;
use std::io::Read;
use terms::unsupported;

/// What a theorem is written of.
struct Parts {
    /// The SHA-256 of the canonical specification that is in the file.
    digest: String,
    spec: Specification,
    free: Free,
    inequalities: List,
    witness: sharp::Witness,
    /// The bounds of sup|x|, sup|e| and sup|zeta|_N that the claim states.
    sizes: [Rational; 3],
}

/// The Coq file of a certificate.
///
/// # Errors
/// `bad-input` where the file is no certificate, `undecided` where no theorem of its kind can be written; with the place.
pub fn theorem(bytes: &[u8]) -> Outcome<String> {
    let json = parse(bytes)?;
    let parts = read(&Field { json: &json, pointer: String::new() })?;
    Ok(text::file(&parts.digest, &numbers::record(&parts)?, &parts))
}

/// Reads at most what is accepted, and writes its theorem.
///
/// # Errors
/// A stream that cannot be read; what [`theorem`] answers.
pub fn theorem_of(certificate: &mut dyn Read) -> std::io::Result<Outcome<String>> {
    let mut bytes = Vec::new();
    certificate.take(MAX_BYTES as u64 + 1).read_to_end(&mut bytes)?;
    Ok(theorem(&bytes))
}

fn read(file: &Field<'_>) -> Outcome<Parts> {
    let mut file = file.fields()?;
    header(&mut file, "sigmastar/certificate")?;
    let mut fields = file.required("witness")?.fields()?;
    let (embedded, spec) = match file.optional("plant") {
        Some(plant) => {
            let (spec, _) = proofs_plants::read::read(&plant, &mut fields)?;
            (plant, spec)
        }
        None => {
            let embedded = file.required("specification")?;
            let spec = Specification::read(&embedded, &mut fields)?;
            (embedded, spec)
        }
    };
    let mut canonical = String::new();
    embedded.json.canonical(&mut canonical);
    let has_states = spec.plant.as_ref().is_some_and(|plant| plant.states > 0);
    let claim = Claim::read(&file.required("claim")?, has_states)?;
    if claim.sampled.is_some() {
        let message =
            "no theorem is written of a claim about the regulator at samples: certify without `sampling_period`";
        return unsupported("/claim/regulator", message);
    }
    if spec.period.range().is_some() {
        let pointer = format!("{}/period", embedded.pointer);
        return unsupported(&pointer, "no theorem is written of a claim about every period of an interval");
    }
    if spec.actuator.is_some() {
        let pointer = format!("{}/actuator", embedded.pointer);
        return unsupported(&pointer, "no theorem is written of a claim with an actuator: certify without `actuator`");
    }
    if spec.plant.as_ref().is_some_and(|plant| !plant.parameters.is_empty()) {
        let pointer = format!("{}/parameters", embedded.pointer);
        return unsupported(&pointer, "no theorem is written of a claim about every parameter of an interval");
    }
    let read = Derivation::read(&mut fields, claim.sigma.clone(), (claim.set.clone(), claim.scope()))?;
    let Derivation { free, inequalities, witness: Witness::Sharp(witness), .. } = read else {
        return unsupported("/witness", "no theorem is written of this kind of witness");
    };
    if let Some(part) = inequalities.all().next().filter(|_| spec.plant.is_none()) {
        return bad(&part.pointer, "a matrix inequality is about the formulas of a plant");
    }
    let mut periodic = claim.periodic.fields()?;
    let mut size = |name| periodic.required(name)?.rational();
    let sizes = [size("x")?, size("e")?, size("zeta")?];
    Ok(Parts { digest: sha256::hex_digest(canonical.as_bytes()), spec, free, inequalities, witness: *witness, sizes })
}
