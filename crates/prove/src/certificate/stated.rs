//! What a certificate states: its specification, its witness, and its bounds of the periodic solution.

use super::by_count::BY_N_O;
use super::fields::exact_rational;
use super::read::read_lyapunov;
use super::read_plant::read_plant_witness;
use super::run::{of_entry, read_numbers};
use crate::certify::resolve_with;
use crate::rate::bound::MAX_COUNTS;
use crate::reduction::{FreeNumbers, PlantRefusal, specification};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{
    Constant, Document, ErrorKind, Errors, Oscillators, Reported, SpecErrors, Specification, Value,
};

/// The statement of a certificate, for whoever holds it against something else.
#[derive(Clone, Debug)]
pub struct StatedClaim {
    /// The specification inside the certificate, with its triple where that is proved by the witness.
    pub spec: Specification,
    /// The free numbers.
    pub witness: FreeNumbers,
    /// The stated bounds of sup|x|, sup|e|, sup|zeta|_N and sup|z|_N along the periodic solution; infinite where there is none.
    pub periodic: [f64; 4],
    /// The stated bounds of |u| along it and of what it differs by from the initial set, at the gain of the claim; older certificates have
    /// none.
    pub control: Option<[f64; 2]>,
    /// What is stated for given n_o under noise and disturbances.
    pub noise: Vec<StatedNoise>,
    /// What is stated by the number of oscillators, and for sets of harmonics.
    pub by_count: Vec<StatedBounds>,
    /// Whether it is about every set of harmonics that contains 0.
    pub every_set: bool,
    /// The plant, where the certificate is of one.
    pub plant: Option<Plant>,
}

/// Bounds of |e - e_per| for some oscillators, at the gain of the claim, with the noise and the disturbance of the document.
#[derive(Clone, Debug)]
pub struct StatedNoise {
    /// The oscillators.
    pub oscillators: Oscillators,
    /// In the limit.
    pub limit: f64,
    /// At all times from the start on.
    pub peak: f64,
}

/// Bounds with these oscillators, at the gain of the claim, without noise and disturbance.
#[derive(Clone, Debug)]
pub struct StatedBounds {
    /// The oscillators.
    pub oscillators: Oscillators,
    /// Whether they hold with every larger number of oscillators, too.
    pub or_more: bool,
    /// Of sup|e|, rms(e) and sup|u| along the periodic solution.
    pub steady: [f64; 3],
    /// Of |e| and |u| at all times, where they are stated.
    pub largest: Option<[f64; 2]>,
}

impl StatedBounds {
    /// Whether they are about these oscillators.
    #[must_use]
    pub fn are_about(&self, oscillators: &Oscillators) -> bool {
        let is_more = |(own, n_o): (u32, u32)| self.or_more && own < n_o;
        self.oscillators == *oscillators || self.oscillators.n_o().zip(oscillators.n_o()).is_some_and(is_more)
    }
}

/// Reads the claim, the witness and the specification of a certificate about either regulator. What a falsified certificate says is
/// taken as it is; only a triple for a Jacobian is proved again.
///
/// # Errors
/// What cannot be read, in its place, and a triple that is not proved.
pub fn read_claim(document: &Document) -> Result<StatedClaim, SpecErrors> {
    let witness = read_numbers(document)?;
    let every_set = document.at("/claim/harmonics").is_some();
    let root = document.root();
    let refused = |error| root.read(|_, errors| Err(errors.report(error)));
    if document.at("/plant").is_some() {
        let (plant, of_plant, values) = read_plant_witness(document, &witness)?;
        let spec = match specification(&plant, of_plant, values) {
            Ok(spec) => spec,
            Err(refusal) => {
                let (place, message) = match refusal {
                    PlantRefusal::Forcing => ("/witness/forcing", "these harmonics are too large or too small"),
                    _ => ("/witness/coordinates", "this matrix is singular, or too nearly so"),
                };
                let place = document.at(place).unwrap_or(root.clone());
                return refused(place.error(ErrorKind::Range, message));
            }
        };
        let (periodic, control) = (stated_periodic(document)?, stated_control(document)?);
        let (noise, by_count) = (stated_noise(document)?, stated_bounds(document)?);
        return Ok(StatedClaim { spec, witness, periodic, control, noise, by_count, every_set, plant: Some(plant) });
    }
    let Some(embedded) = document.at("/specification") else {
        return refused(root.error(ErrorKind::MissingField, "the field `specification` is missing"));
    };
    let mut spec = Specification::from_value(&embedded)?;
    if spec.lyapunov.triple().is_none() {
        match resolve_with(&spec, &read_lyapunov(document)?) {
            Some(Ok(proved)) => spec = proved,
            Some(Err(failure)) => {
                let place = document.at("/witness/lyapunov").unwrap_or(root.clone());
                let error = place.error(ErrorKind::Range, format!("this triple is not proved: {failure}"));
                return refused(error.help("`sigmastar check` decides the certificate"));
            }
            None => {}
        }
    }
    let (periodic, control) = (stated_periodic(document)?, stated_control(document)?);
    let (noise, by_count) = (stated_noise(document)?, stated_bounds(document)?);
    Ok(StatedClaim { spec, witness, periodic, control, noise, by_count, every_set, plant: None })
}

/// The stated bounds of the periodic solution.
fn stated_periodic(document: &Document) -> Result<[f64; 4], SpecErrors> {
    stated(document, "periodic_solution", ["x", "e", "zeta", "z"])
}

/// Those of the control, where there are any.
fn stated_control(document: &Document) -> Result<Option<[f64; 2]>, SpecErrors> {
    document.at("/claim/control").map(|_| stated(document, "control", ["steady", "transient"])).transpose()
}

/// Those for given oscillators, where there are any; an entry about nothing that a certificate may state is left out.
fn stated_noise(document: &Document) -> Result<Vec<StatedNoise>, SpecErrors> {
    let parts = (0..MAX_COUNTS).map(|i| format!("for_n_o/{i}"));
    let parts = parts.filter(|part| document.at(&format!("/claim/{part}/noise")).is_some());
    let own = parts.filter_map(|part| Some((of_entry(&document.at(&format!("/claim/{part}"))?.to_json())?, part)));
    own.map(|(oscillators, part)| {
        let [limit, peak] = stated(document, &format!("{part}/noise"), ["limit", "peak"])?;
        Ok(StatedNoise { oscillators, limit, peak })
    })
    .collect()
}

/// Those by the number of oscillators and for sets of harmonics, where there are any; an entry about nothing that a certificate may state is left out.
fn stated_bounds(document: &Document) -> Result<Vec<StatedBounds>, SpecErrors> {
    let entries = (0..).map(|i| format!("{BY_N_O}/{i}"));
    let entries = entries.map_while(|part| Some((document.at(&format!("/claim/{part}"))?.to_json(), part)));
    let own = entries.filter_map(|(entry, part)| Some((of_entry(&entry)?, entry["or_more"] == true, part)));
    own.map(|(oscillators, or_more, part)| {
        let steady = stated(document, &format!("{part}/steady"), ["e", "e_rms", "u"])?;
        let largest = format!("{part}/largest");
        let largest = document.at(&format!("/claim/{largest}")).map(|_| stated(document, &largest, ["e", "u"]));
        Ok(StatedBounds { oscillators, or_more, steady, largest: largest.transpose()? })
    })
    .collect()
}

fn stated<const N: usize>(document: &Document, part: &str, names: [&str; N]) -> Result<[f64; N], SpecErrors> {
    let root = document.root();
    let mut errors = Errors::new();
    let found = names.map(|name| match document.at(&format!("/claim/{part}/{name}")) {
        Some(value) => bound(&value, &mut errors),
        None => {
            let message = format!("the bound `{part}.{name}` is missing");
            Err(errors.report(root.error(ErrorKind::MissingField, message)))
        }
    });
    let reported = found.iter().find_map(|bound| bound.as_ref().err().copied());
    errors.conclude(document, reported.map_or(Ok(()), Err))?;
    Ok(found.map(|bound| bound.unwrap_or(f64::INFINITY)))
}

/// An upper end of the claim; `inf` where there is none.
fn bound(value: &Value<'_>, errors: &mut Errors) -> Result<f64, Reported> {
    if value.text() == Some("inf") {
        return Ok(f64::INFINITY);
    }
    exact_rational(value, "this bound", errors).map(|bound| Constant::rational(&bound).to_f64())
}
