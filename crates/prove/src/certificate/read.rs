//! Reading the witness of a certificate, to decide it again without any search.

use super::fields::{HARMONICS, NumberFields, PLANT_FIELDS, RefinedSquares, exact_rational, rational, read_paths};
use super::triple::{EXISTENCE, STABILITY};
use super::write::{FORMAT, VERSION};
use crate::rate::bound::MAX_OSCILLATORS;
use rug::Rational;
use sigmastar_decide::conditions::GivenWitness;
use sigmastar_lang::spec::model::PeriodicMatrix;
use sigmastar_lang::spec::{
    Actuator, Document, ErrorKind, Errors, InputGain, Object, Oscillators, Parameters, Reported, SpecErrors, Value,
    read_claimed_actuator, read_input_gain, read_parameters,
};
use sigmastar_theory::derivation::initial_set::ClaimedSet;
use sigmastar_theory::derivation::sharp::SharpWitness;
use sigmastar_theory::evidence::{ProvedTriple, ProvedTriples};
use sigmastar_theory::transfer::{BoxProof, TransferProof};

/// Reads the claim's numbers and the witness of a certificate file. Everything else in it (the embedded
/// specification, the printed conditions and constants) is known and not used: it is computed again.
///
/// # Errors
/// Every field that is missing, unknown or not an exact rational, with its place.
pub fn read_witness(document: &Document) -> Result<GivenWitness, SpecErrors> {
    document.root().read(read)
}

/// The fields of every certificate that are computed again.
pub(super) const COMMON: [&str; 7] =
    ["tool", "precision_bits", "specification", "specification_sha256", "plant", "plant_sha256", "conditions"];

fn read(root: &Value<'_>, errors: &mut Errors) -> Result<GivenWitness, Reported> {
    let mut file = root.object(errors)?;
    file.header(FORMAT, &[VERSION], errors)?;
    for unused in COMMON.iter().chain(&["no_plant", "comparison", "constants"]) {
        let _ = file.optional(unused);
    }
    let subject = embedded(root);
    let claim = file.required("claim", errors).and_then(|value| claim_part(&value, subject.as_ref(), errors));
    let witness = file.required("witness", errors);
    file.finish(errors);
    let ((sigma, set), witness) = (claim?, witness?);
    let mut fields = witness.object(errors)?;
    if let (Some(p_x), None) = (witness.member("p_x"), witness.member("r_x")) {
        let message = "this witness proves existence by a contraction, as earlier versions did";
        let error = p_x.error(ErrorKind::UnknownField, message).expected("expected `r_x`, `r_e`, `r_d`, `kap`");
        return Err(errors.report(error.help("`certify` writes a new one")));
    }
    // Read by `read_lyapunov`, where the specification asks for it.
    let of_plant: &[&'static str] = if root.member("plant").is_some() { &PLANT_FIELDS } else { &[] };
    for field in [STABILITY, EXISTENCE].iter().chain(of_plant) {
        let _ = fields.optional(field);
    }
    let result = read_sharp(&mut fields, errors, sigma, set);
    fields.finish(errors);
    result
}

/// Reads the parts `witness.lyapunov` and `witness.lyapunov_existence` of a certificate: P(t) and the triple of each, for a
/// specification with a Jacobian.
///
/// # Errors
/// The first part, where it is missing, or fields that are missing, unknown or not exact rationals, with their places.
pub fn read_lyapunov(document: &Document) -> Result<ProvedTriples, SpecErrors> {
    document.root().read(|root, errors| {
        let mut file = root.object(errors)?;
        let mut witness = file.required("witness", errors)?.object(errors)?;
        let stability = read_triple(&witness.required(STABILITY, errors)?, errors)?;
        let existence = witness.optional(EXISTENCE).map(|value| read_triple(&value, errors)).transpose()?;
        Ok(ProvedTriples { stability, existence })
    })
}

pub(super) fn read_triple(value: &Value<'_>, errors: &mut Errors) -> Result<ProvedTriple, Reported> {
    let mut fields = value.object(errors)?;
    let mean = fields.required("P", errors).and_then(|value| read_rows(&value, "an entry of a matrix", errors));
    let harmonics = harmonics(&mut fields, errors, |pair, name, errors| {
        pair.required(name, errors).and_then(|value| read_rows(&value, "an entry of a matrix", errors))
    })?;
    let [p_low, p_up, alpha] = ["p_low", "p_up", "alpha"].map(|name| rational(&mut fields, name, errors));
    fields.finish(errors);
    let matrix = PeriodicMatrix { mean: mean?, harmonics };
    Ok(ProvedTriple { matrix, p_low: p_low?, p_up: p_up?, alpha: alpha? })
}

/// A list of objects.
pub(super) fn each<T>(
    value: &Value<'_>,
    errors: &mut Errors,
    read: impl Fn(&mut Object<'_>, &mut Errors) -> Result<T, Reported>,
) -> Result<Vec<T>, Reported> {
    let mut all = Vec::new();
    for one in value.array(errors)? {
        let mut fields = one.object(errors)?;
        let read = read(&mut fields, errors);
        fields.finish(errors);
        all.push(read?);
    }
    Ok(all)
}

/// A list of objects in the field `name`, which is left out where the list is empty.
pub(super) fn listed<T>(
    fields: &mut Object<'_>,
    name: &'static str,
    errors: &mut Errors,
    read: impl Fn(&mut Object<'_>, &mut Errors) -> Result<T, Reported>,
) -> Result<Vec<T>, Reported> {
    fields.optional(name).map_or(Ok(Vec::new()), |value| each(&value, errors, read))
}

/// `harmonics`, as a list that may be left out: `cos` and `sin` of each.
pub(super) fn harmonics<T>(
    fields: &mut Object<'_>,
    errors: &mut Errors,
    read: impl Fn(&mut Object<'_>, &'static str, &mut Errors) -> Result<T, Reported>,
) -> Result<Vec<[T; 2]>, Reported> {
    listed(fields, "harmonics", errors, |pair, errors| {
        let [cos, sin] = ["cos", "sin"].map(|name| read(pair, name, errors));
        Ok([cos?, sin?])
    })
}

/// A field that holds a matrix.
pub(super) fn matrix(
    fields: &mut Object<'_>,
    name: &'static str,
    errors: &mut Errors,
) -> Result<Vec<Vec<Rational>>, Reported> {
    fields.required(name, errors).and_then(|value| read_rows(&value, &format!("an entry of {name}"), errors))
}

/// Lists of exact rationals.
pub(super) fn read_rows(value: &Value<'_>, what: &str, errors: &mut Errors) -> Result<Vec<Vec<Rational>>, Reported> {
    let mut rows = Vec::new();
    for row in value.array(errors)? {
        let mut entries = Vec::new();
        for entry in row.array(errors)? {
            entries.push(exact_rational(&entry, what, errors)?);
        }
        rows.push(entries);
    }
    Ok(rows)
}

/// Passes over what the claim of a certificate about either regulator says besides: it follows from the free numbers.
pub(super) fn skip_said(claim: &mut Object<'_>) {
    for said in [
        "verdict",
        "n_o",
        "harmonics",
        "mu",
        "parameters",
        "periodic_solution",
        "control",
        "for_n_o",
        "by_n_o",
        "statement",
    ] {
        let _ = claim.optional(said);
    }
}

/// Passes over what proves numbers for given numbers of oscillators: it is worked out again for those that are asked about.
pub(super) fn skip_by_count(witness: &mut Object<'_>) {
    for part in ["for_n_o", "by_n_o"] {
        let _ = witness.optional(part);
    }
}

/// What the claim contributes to the witness: the gain, and the initial set. Its input gain and actuator are those of the embedded document.
fn claim_part(
    value: &Value<'_>,
    subject: Option<&Value<'_>>,
    errors: &mut Errors,
) -> Result<(Rational, ClaimedSet), Reported> {
    let mut claim = value.object(errors)?;
    if let Some(regulator) = value.member("regulator") {
        let message = "this certificate is about the regulator at samples, not about the one in continuous time";
        let error = regulator.error(ErrorKind::UnknownField, message);
        return Err(errors.report(error.help("`certify --witness`, `controller` and `check` take it")));
    }
    skip_said(&mut claim);
    let _ = claim.optional("period");
    let derivation = claim.required("derivation", errors).and_then(|value| match value.string(errors)? {
        "sharp" => Ok(()),
        other => {
            let message = format!("no witness is read for the derivation `{other}`");
            Err(errors.report(value.error(ErrorKind::UnknownName, message).expected("expected `sharp`")))
        }
    });
    let actuator = own_actuator(&mut claim, value, subject, errors);
    // With an actuator nothing is said of a larger gain.
    let gain = if value.member("actuator").is_some() { "sigma" } else { "sigma_star" };
    let sigma = rational(&mut claim, gain, errors);
    let set = read_set(&mut claim, errors);
    claim.finish(errors);
    derivation?;
    actuator?;
    Ok((sigma?, set?))
}

/// That the input gain and the actuator of a claim are those of the document that it embeds.
pub(super) fn own_actuator(
    claim: &mut Object<'_>,
    value: &Value<'_>,
    subject: Option<&Value<'_>>,
    errors: &mut Errors,
) -> Result<(), Reported> {
    let gain = own_part(claim, value, subject, ("input_gain", read_input_gain, InputGain::is), errors);
    let read = |value: &Value<'_>, parameters: &Parameters, errors: &mut Errors| {
        read_claimed_actuator(value, parameters.definitions(), errors)
    };
    gain.and(own_part(claim, value, subject, ("actuator", read, Actuator::is), errors))
}

/// A part with constants: its name, how it is read, and whether two of it are the same.
type Part<T> = (&'static str, fn(&Value<'_>, &Parameters, &mut Errors) -> Result<T, Reported>, fn(&T, &T) -> bool);

fn own_part<T>(
    claim: &mut Object<'_>,
    value: &Value<'_>,
    subject: Option<&Value<'_>>,
    part: Part<T>,
    errors: &mut Errors,
) -> Result<(), Reported> {
    match (claim.optional(part.0), subject.and_then(|subject| subject.member(part.0))) {
        (None, None) => Ok(()),
        (stated, embedded) => {
            let parameters = subject.and_then(|subject| subject.member("parameters"));
            let parameters = parameters.map(|value| read_parameters(&value, &[], errors)).transpose();
            parameters.and_then(|parameters| {
                same_part(stated, embedded, (value, &parameters.unwrap_or_default()), part, errors)
            })
        }
    }
}

/// The document in a certificate: a plant or a specification; `None` where there is neither.
#[must_use]
pub fn embedded<'v>(root: &Value<'v>) -> Option<Value<'v>> {
    ["plant", "specification"].into_iter().find_map(|name| root.member(name))
}

/// That they are the same numbers or expressions of parameters; in the document the names of constants may stand.
fn same_part<T>(
    stated: Option<Value<'_>>,
    embedded: Option<Value<'_>>,
    (claim, parameters): (&Value<'_>, &Parameters),
    (name, read, same): Part<T>,
    errors: &mut Errors,
) -> Result<(), Reported> {
    let place = stated.clone().unwrap_or_else(|| claim.clone());
    let [stated, embedded] =
        [stated, embedded].map(|value| value.map(|value| read(&value, parameters, errors)).transpose());
    let same = match (stated?, embedded?) {
        (Some(stated), Some(embedded)) => same(&stated, &embedded),
        _ => false,
    };
    if same {
        return Ok(());
    }
    let message = format!("the claim and the document in the certificate differ in `{name}`");
    let error = place.error(ErrorKind::Range, message).expected("expected the same numbers in both, or in neither");
    Err(errors.report(error.help("`certify` writes a new one")))
}

/// `initial_set` of a claim.
pub(super) fn read_set(claim: &mut Object<'_>, errors: &mut Errors) -> Result<ClaimedSet, Reported> {
    let value = claim.required("initial_set", errors)?;
    let mut set = value.object(errors)?;
    let aligned = set.optional("kind").is_some_and(|kind| kind.text() == Some("aligned"));
    let _ = set.optional("ball");
    let [x0, e0] = ["X0", "E0"].map(|name| rational(&mut set, name, errors));
    let z0 = (!aligned).then(|| rational(&mut set, "Z0", errors)).transpose();
    set.finish(errors);
    Ok(ClaimedSet { x0: x0?, e0: e0?, z0: z0? })
}

fn read_transfer(fields: &mut Object<'_>, errors: &mut Errors) -> Result<TransferProof, Reported> {
    let value = fields.required("transfer", errors)?;
    let mut transfer = value.object(errors)?;
    let proof = transfer.required("proof", errors).and_then(|value| match value.string(errors)? {
        "closed-form" => Ok(TransferProof::ClosedForm),
        "matched" => Ok(TransferProof::Matched { k: small_integer(&mut transfer, "K", errors)? }),
        "boxes" => {
            let (m0, n0) = (small_integer(&mut transfer, "m0", errors), small_integer(&mut transfer, "N0", errors));
            let breaks =
                transfer.required("boxes", errors).and_then(|value| read_rows(&value, "a break point", errors));
            Ok(TransferProof::Boxes(BoxProof { m0: m0?, n0: n0?, breaks: breaks? }))
        }
        other => {
            let message = format!("no transfer proof `{other}` is read");
            let expected = "expected `closed-form`, `matched` or `boxes`";
            Err(errors.report(value.error(ErrorKind::UnknownName, message).expected(expected)))
        }
    });
    transfer.finish(errors);
    proof
}

/// A field that holds a whole number below 2^32.
pub(super) fn small_integer(object: &mut Object<'_>, name: &'static str, errors: &mut Errors) -> Result<u32, Reported> {
    let value = object.required(name, errors)?;
    small(&value, name, errors)
}

fn small(value: &Value<'_>, name: &str, errors: &mut Errors) -> Result<u32, Reported> {
    let number = value.integer(errors)?;
    u32::try_from(number).map_err(|_| {
        let message = format!("`{name}` is too large");
        errors.report(value.error(ErrorKind::Range, message).expected("expected a small whole number"))
    })
}

/// A number of oscillators, or a harmonic, that a certificate may name.
fn within(value: &Value<'_>, name: &str, errors: &mut Errors) -> Result<u32, Reported> {
    let number = small(value, name, errors)?;
    if number <= MAX_OSCILLATORS {
        return Ok(number);
    }
    let error = value.error(ErrorKind::Range, format!("`{name}` is too large"));
    Err(errors.report(error.expected(format!("expected at most {MAX_OSCILLATORS}"))))
}

/// The oscillators of an object, at the first n_o harmonics or at those of a set.
pub(super) fn read_oscillators(object: &mut Object<'_>, errors: &mut Errors) -> Result<Oscillators, Reported> {
    let Some(value) = object.optional(HARMONICS) else {
        let value = object.required("n_o", errors)?;
        return within(&value, "n_o", errors).map(Oscillators::first);
    };
    let mut harmonics = Vec::new();
    for one in value.array(errors)? {
        harmonics.push(within(&one, HARMONICS, errors)?);
    }
    Oscillators::at(&harmonics).map_err(|wrong| errors.report(value.error(ErrorKind::Range, wrong.to_string())))
}

fn read_sharp(
    fields: &mut Object<'_>,
    errors: &mut Errors,
    sigma: Rational,
    set: ClaimedSet,
) -> Result<GivenWitness, Reported> {
    let mut exact = Ok(None);
    let witness = SharpWitness::read(fields, errors, |fields, errors| {
        let transfer = read_transfer(fields, errors);
        let _ = fields.optional("lmi");
        skip_by_count(fields);
        exact = fields
            .optional("exact_regulation")
            .map(|value| {
                read_numbers(&value, errors, |fields, errors| read_paths(fields, errors).map(|paths| (paths,)))
            })
            .transpose();
        let refined = fields.optional("refined");
        let refined = refined.map(|value| read_numbers::<RefinedSquares>(&value, errors, |_, _| Ok(()))).transpose();
        let paths = read_paths(fields, errors);
        Ok((sigma, set, transfer?, refined?, paths?))
    });
    Ok(GivenWitness { witness: Box::new(witness?), exact: exact? })
}

/// An object that holds numbers, and what `other` reads.
pub(super) fn read_numbers<N: NumberFields>(
    value: &Value<'_>,
    errors: &mut Errors,
    other: impl FnOnce(&mut Object<'_>, &mut Errors) -> Result<N::Other, Reported>,
) -> Result<N, Reported> {
    let mut fields = value.object(errors)?;
    let numbers = N::read(&mut fields, errors, other);
    fields.finish(errors);
    numbers
}

/// Numbers, one for each state.
pub(super) fn vector(value: &Value<'_>, length: usize, errors: &mut Errors) -> Result<Vec<Rational>, Reported> {
    let elements = value.array(errors)?;
    if elements.len() != length {
        let message = format!("{} numbers for {length} states", elements.len());
        return Err(errors.report(value.error(ErrorKind::Range, message)));
    }
    elements.iter().map(|element| exact_rational(element, "a coefficient", errors)).collect()
}
