//! What a certificate claims, as a simulation can check it.

use super::finding::Trial;
use super::frame::{ABOVE, OwnPlant};
use super::joint::JointFunction;
use super::sampled_claim::SampledClaim;
use rug::Rational;
use sigmastar_decide::conditions::GivenWitness;
use sigmastar_exact::enclosure::DEFAULT_PRECISION;
use sigmastar_lang::spec::{Constant, Document, Oscillators, SpecErrors, Specification, StartSizes};
use sigmastar_prove::certificate::{StatedBounds, StatedClaim, StatedNoise, read_claim};
use sigmastar_prove::reduction::FreeNumbers;
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::consequences::{ErrorBounds, Excitation, Psi, error_bounds};
use sigmastar_theory::derivation::mistuned::Mistuning;
use sigmastar_theory::derivation::sharp::SharpEvaluation;

/// The claim of a certificate in double precision.
#[derive(Clone, Debug)]
pub struct TriedClaim {
    /// The specification inside the certificate, with its triple where that is proved by the witness.
    pub spec: Specification,
    /// sigma*.
    pub sigma: f64,
    /// The initial set.
    pub initial: StartSizes<f64>,
    /// Bounds of sup|x|, sup|e| and sup|zeta|_N along the periodic solution: the smaller of the claim's and the
    /// witness's.
    pub periodic: [f64; 3],
    /// The bound of sup|z|_N along the periodic solution.
    pub periodic_z: f64,
    /// Bounds of |u| along it, and of what u differs by on the way, at the gain of the claim.
    pub control: Option<[f64; 2]>,
    /// Bounds for given n_o under noise and disturbances, at the gain of the claim.
    pub noise: Vec<StatedNoise>,
    /// Bounds by the number of oscillators and for sets of harmonics, at the gain of the claim.
    pub by_count: Vec<StatedBounds>,
    /// D_x, D_e: the error box.
    pub error_box: [f64; 2],
    /// w_x P_low, w_x P_up and h of the Lyapunov function w_x x'P_x x + e^2 + h z'N z in error coordinates, where the
    /// derivation has one of this form.
    pub lyapunov: Option<[f64; 3]>,
    /// What falls in its place where the claim rests on joint metrics.
    pub joint: Option<JointFunction>,
    /// psi_1 and psi_x: sup|e| <= psi_1/sigma and sup|x| <= psi_x/sigma, in continuous time.
    pub psi: Option<[f64; 2]>,
    /// The arguments up to which plants lie within the bounding functions: the domain, or what the claim rests on.
    pub reach: [Rational; 2],
    /// What drives the periodic error, and E_p.
    drive: Option<(Excitation, Rational)>,
    /// The plant that the claim is about, where it is about one; it is tried in the place of drawn ones.
    pub own: Option<OwnPlant>,
    /// Values of the parameters with intervals with which alone it is tried, where one was chosen.
    pub(super) chosen: Vec<Option<Rational>>,
    /// The law at samples, where the claim is about it: then it is about exactly its gain.
    pub sampled: Option<SampledClaim>,
    /// Whether it is about every set of harmonics that contains 0.
    pub(super) every_set: bool,
    /// The sets with which alone it is tried, where some were chosen.
    pub(super) sets: Vec<Oscillators>,
}

impl TriedClaim {
    /// The claim of a certificate, as [`read_claim`] reads it; the matrices that are drawn rest on its proved triple.
    ///
    /// # Errors
    /// Those of [`read_claim`].
    pub fn from_document(document: &Document) -> Result<TriedClaim, SpecErrors> {
        let StatedClaim {
            spec,
            witness,
            periodic: [x, e, zeta, periodic_z],
            control,
            noise,
            by_count,
            every_set,
            plant,
        } = read_claim(document)?;
        let own = plant.zip(spec.plant()).and_then(|(plant, proved)| OwnPlant::new(plant, proved));
        let data = Data::new(&spec, DEFAULT_PRECISION);
        let (p_low, p_up) = (data.p_low.lower_f64(), data.p_up.upper_f64());
        let quadratic = |w_x: &Rational, h: &Rational| Some([w_x.to_f64() * p_low, w_x.to_f64() * p_up, h.to_f64()]);
        let (sigma, set, [x_p, e_p], error_box, lyapunov) = match &witness {
            FreeNumbers::Continuous(GivenWitness { witness: w, .. }) => {
                (&w.sigma, &w.set, [&w.x_p, &w.e_p], [&w.d_x, &w.d_e], quadratic(&w.w_x, &w.h))
            }
            FreeNumbers::Sampled(w) => {
                (&w.sigma, &w.set, [&w.x_p, &w.e_p], [&w.d_x, &w.d_e], quadratic(&w.w_x, &w.eta))
            }
        };
        let joint = JointFunction::of(&spec);
        let lyapunov = lyapunov.filter(|_| joint.is_none());
        let error_box = error_box.map(Rational::to_f64);
        let periodic = [x.min(x_p.to_f64()), e.min(e_p.to_f64()), zeta];
        let initial = set.map(Rational::to_f64);
        let reach = reach(&spec, periodic, [x_p, e_p], error_box);
        let (excitation, sampled) = match &witness {
            FreeNumbers::Continuous(given) => (Some(SharpEvaluation::new(&data, &given.witness).excitation), None),
            FreeNumbers::Sampled(witness) => (None, Some(SampledClaim::new(witness))),
        };
        let psi = excitation.as_ref().map(|excitation| {
            let psi = Psi::new(&data, excitation);
            [psi.psi_1.upper_f64(), psi.psi_x.upper_f64()]
        });
        let (sigma, drive) = (sigma.to_f64(), excitation.map(|excitation| (excitation, e_p.clone())));
        Ok(TriedClaim {
            spec,
            sigma,
            initial,
            periodic,
            periodic_z,
            control,
            noise,
            by_count,
            error_box,
            lyapunov,
            joint,
            psi,
            reach,
            drive,
            own,
            chosen: Vec::new(),
            sampled,
            every_set,
            sets: Vec::new(),
        })
    }

    /// The weight of |zeta|_N^2 in what falls in a trial, as a share of h: with an input gain b the true gain over the nominal one, and at
    /// a larger sigma less in proportion (derivation, 13.1).
    pub(super) fn share_of_h(&self, trial: &Trial) -> f64 {
        let Some((gain, uncertain)) = trial.input_gain.zip(self.spec.input_gain.as_ref()) else { return 1.0 };
        let threshold = self.spec.bounds.proved_values().inequality.as_ref().map(|known| known.value.to_f64());
        let falls = if uncertain.is_nominal() { 1.0 } else { threshold.unwrap_or(self.sigma) / trial.sigma };
        gain / uncertain.nominal.to_f64() * falls
    }

    /// The bounds of rms(e) and sup|e| with n_o oscillators at a gain of at least sigma*.
    #[must_use]
    pub fn error_bounds(&self, sigma: f64, n_o: u32) -> Option<[f64; 2]> {
        let data = Data::new(&self.spec, DEFAULT_PRECISION);
        let (excitation, e_p) = self.drive.as_ref()?;
        let sigma = data.rational(&Rational::from_f64(sigma)?);
        let (mistuning, e_p) = (Mistuning::new(&data), data.rational(e_p));
        let ErrorBounds { rms, sup } =
            error_bounds(&data, excitation, mistuning.as_ref(), &sigma, &e_p, u64::from(n_o));
        Some([rms.upper_f64(), sup.upper_f64()])
    }

    /// The bounds of the control, which are for the gain of the claim alone.
    #[must_use]
    pub fn control_at(&self, sigma: f64) -> Option<[f64; 2]> {
        self.control.filter(|_| sigma <= self.sigma * ABOVE)
    }

    /// The bounds for the oscillators of a trial, which are for the gain of the claim alone.
    pub(super) fn bounds_at(&self, trial: &Trial) -> Option<&StatedBounds> {
        let of_trial = |stated: &&StatedBounds| stated.are_about(&trial.oscillators);
        self.by_count.iter().find(of_trial).filter(|_| trial.sigma <= self.sigma * ABOVE)
    }

    /// The numbers of oscillators of its trials: those of the bounds under noise, where there are any.
    pub(super) fn tried_n_o(&self, otherwise: &[u32]) -> Vec<u32> {
        let stated: Vec<u32> = self.noise.iter().filter_map(|stated| stated.oscillators.n_o()).collect();
        if stated.is_empty() { otherwise.to_vec() } else { stated }
    }

    /// The gain of a trial over that of the claim: with an actuator the claim is about its gain alone.
    pub(super) fn gain_of(&self, share: f64) -> f64 {
        if self.spec.actuator.is_some() { 1.0 } else { share }
    }

    /// The largest |u| that the actuator takes.
    pub(super) fn actuator(&self) -> Option<f64> {
        self.spec.actuator.as_ref().map(|actuator| actuator.max.to_f64())
    }

    /// A claim about a specification that claims nothing, for tests of what is drawn.
    #[cfg(test)]
    pub(super) fn for_tests(spec: Specification, reach: [f64; 2]) -> TriedClaim {
        let reach = reach.map(|end| Rational::from_f64(end).unwrap());
        let (drive, own) = (None, None);
        let initial = StartSizes { x0: 0.0, e0: 0.0, z0: Some(0.0) };
        let (periodic, error_box) = ([0.0; 3], [0.0; 2]);
        let (periodic_z, control, lyapunov, joint, psi, sampled) = (0.0, None, None, None, None, None);
        TriedClaim {
            spec,
            sigma: 1.0,
            noise: Vec::new(),
            by_count: Vec::new(),
            initial,
            periodic,
            periodic_z,
            control,
            error_box,
            lyapunov,
            joint,
            psi,
            reach,
            drive,
            own,
            chosen: Vec::new(),
            sampled,
            every_set: false,
            sets: Vec::new(),
        }
    }
}

/// The arguments up to which plants are to lie within the bounding functions.
fn reach(spec: &Specification, periodic: [f64; 3], [x_p, e_p]: [&Rational; 2], error_box: [f64; 2]) -> [Rational; 2] {
    match &spec.domain {
        Some(domain) => [&domain.x, &domain.e].map(data_end),
        // Rounded up: plants within the bounding functions on a larger box are within them on a smaller one.
        None => [(periodic[0], x_p, error_box[0]), (periodic[1], e_p, error_box[1])].map(|(per, p, radius)| {
            Rational::from_f64((per + radius).max(p.to_f64()) * 1.001).unwrap_or_else(|| Rational::from(1))
        }),
    }
}

/// The end of the domain, which the reader has seen to be positive and bounded.
fn data_end(constant: &Constant) -> Rational {
    constant.enclose(DEFAULT_PRECISION).upper_rational().unwrap_or_else(|| Rational::from(1))
}
