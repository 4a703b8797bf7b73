//! What a certificate claims, as a simulation can check it.

use crate::certificate::{WitnessFile, read_witness};
use crate::constants::consequences::{ErrorBounds, Psi, error_bounds};
use crate::constants::existence::PeriodicBounds;
use crate::data::Data;
use crate::enclosure::{DEFAULT_PRECISION, Enclosure};
use crate::spec::{Constant, Document, ErrorKind, Errors, Reported, SpecErrors, Specification, Value, any_constant};
use rug::Rational;

/// The claim of a certificate in double precision.
#[derive(Clone, Debug)]
pub struct Claim {
    /// The specification inside the certificate.
    pub spec: Specification,
    /// sigma*.
    pub sigma: f64,
    /// X0, E0, Z0: the initial set.
    pub initial: [f64; 3],
    /// Bounds of sup|x|, sup|e| and sup|zeta|_N along the periodic solution: the smaller of the claim's and the
    /// witness's.
    pub periodic: [f64; 3],
    /// D_x, D_e: the error box, where the derivation has one.
    pub error_box: Option<[f64; 2]>,
    /// psi_1 and psi_x: sup|e| <= psi_1/sigma and sup|x| <= psi_x/sigma.
    pub psi: [f64; 2],
    /// The arguments up to which plants have to lie within the bounding functions.
    pub reach: [f64; 2],
    witness: [Rational; 2],
}

impl Claim {
    /// Reads the claim, the witness and the specification of a certificate. Nothing is checked: what a falsified
    /// certificate says is taken as it is.
    ///
    /// # Errors
    /// What cannot be read, in its place.
    pub fn from_document(document: &Document) -> Result<Claim, SpecErrors> {
        let witness = read_witness(document)?;
        let mut errors = Errors::new();
        let root = document.root();
        let Some(embedded) = document.at("/specification") else {
            let error = root.error(ErrorKind::MissingField, "the field `specification` is missing");
            let reported: Result<Claim, Reported> = Err(errors.report(error));
            return errors.conclude(document, reported);
        };
        let spec = Specification::from_value(&embedded)?;
        let stated = ["x", "e", "zeta"].map(|name| match document.at(&format!("/claim/periodic_solution/{name}")) {
            Some(value) => bound(&value, &mut errors),
            None => {
                let message = format!("the bound `periodic_solution.{name}` is missing");
                Err(errors.report(root.error(ErrorKind::MissingField, message)))
            }
        });
        let [x, e, zeta] = stated;
        let stated = x.and_then(|x| Ok([x, e?, zeta?]));
        let stated = errors.conclude(document, stated)?;
        Ok(Claim::new(spec, &witness, stated))
    }

    fn new(spec: Specification, witness: &WitnessFile, stated: [f64; 3]) -> Claim {
        let (sigma, set, x_p, e_p, error_box) = match witness {
            WitnessFile::Sharp { witness, .. } => {
                let radii = [witness.d_x.to_f64(), witness.d_e.to_f64()];
                (&witness.sigma, &witness.set, &witness.x_p, &witness.e_p, Some(radii))
            }
            WitnessFile::Repaired { witness } => (&witness.sigma, &witness.set, &witness.x, &witness.e, None),
        };
        let periodic = [stated[0].min(x_p.to_f64()), stated[1].min(e_p.to_f64()), stated[2]];
        let initial = [set.x0.to_f64(), set.e0.to_f64(), set.z0.to_f64()];
        let [radius_x, radius_e] =
            error_box.unwrap_or([4.0 * (initial[0] + periodic[0]), 4.0 * (initial[1] + periodic[1])]);
        let reach = match &spec.domain {
            Some(domain) => [domain.x.to_f64(), domain.e.to_f64()],
            None => [2.0 * (stated[0] + radius_x), 2.0 * (stated[1] + radius_e)],
        };
        let psi = {
            let data = Data::new(&spec, DEFAULT_PRECISION);
            let psi = Psi::new(&data, &PeriodicBounds::new(&data, data.rational(x_p), data.rational(e_p)));
            [psi.psi_1.upper_f64(), psi.psi_x.upper_f64()]
        };
        let (sigma, witness) = (sigma.to_f64(), [x_p.clone(), e_p.clone()]);
        Claim { spec, sigma, initial, periodic, error_box, psi, reach, witness }
    }

    /// The bounds of rms(e) and sup|e| with n_o oscillators at a gain of at least sigma*, for a matched base frequency.
    #[must_use]
    pub fn matched_bounds(&self, sigma: f64, n_o: u32) -> Option<[f64; 2]> {
        if !self.spec.internal_model.matched {
            return None;
        }
        let data = Data::new(&self.spec, DEFAULT_PRECISION);
        let [x_p, e_p] = &self.witness;
        let bounds = PeriodicBounds::new(&data, data.rational(x_p), data.rational(e_p));
        let sigma = data.rational(&Rational::from_f64(sigma)?);
        let e_per: Enclosure = bounds.e_p.clone();
        let ErrorBounds { rms, sup } = error_bounds(&data, &bounds, &sigma, &e_per, u64::from(n_o));
        Some([rms.upper_f64(), sup.upper_f64()])
    }
}

/// An upper end of the claim; `inf` where there is none.
fn bound(value: &Value<'_>, errors: &mut Errors) -> Result<f64, Reported> {
    if value.text() == Some("inf") {
        return Ok(f64::INFINITY);
    }
    any_constant(value, errors).as_ref().map(Constant::to_f64).map_err(|reported| *reported)
}
