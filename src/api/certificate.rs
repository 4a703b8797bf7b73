//! What a certificate says.

use super::claimed::{ClaimedBounds, ClaimedRate, bounds, rates};
use super::condition::Condition;
use super::report::Report;
use super::subject::Subject;
use super::{json_text, nearest, rounded_down, rounded_up};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::write_exact;
use sigmastar_lang::spec::{Specification, StartSizes};
use sigmastar_prove::certificate::{certificate_of, sampled_statement, statement};
use sigmastar_prove::certify::claimed_ball;
use sigmastar_prove::reduction::Run;
use sigmastar_report::run_remarks;
use sigmastar_theory::derivation::initial_set::ClaimedSet;

/// A certified claim, the conditions that prove it, and the file from which both can be checked again.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Certificate {
    claim: Claim,
    conditions: Vec<Condition>,
    remarks: Vec<String>,
    json: String,
    report: Report,
    subject: Subject,
}

impl Certificate {
    /// `None` where nothing was certified; `again` where a witness was decided again.
    pub(super) fn new(run: &Run<'_>, subject: &Subject, again: bool) -> Option<Certificate> {
        let written = certificate_of(run)?;
        let claim = Claim { rates: rates(&written["claim"]), bounds: bounds(&written["claim"]), ..Claim::new(run)? };
        let (json, subject) = (json_text(&written), subject.clone());
        let (remarks, report) = (run_remarks(run), Report::of_run(run, again));
        Some(Certificate { claim, conditions: Condition::of_run(run), remarks, json, report, subject })
    }

    /// What is claimed.
    #[must_use]
    pub fn claim(&self) -> &Claim {
        &self.claim
    }

    /// The conditions, all of which are proved.
    #[must_use]
    pub fn conditions(&self) -> &[Condition] {
        &self.conditions
    }

    /// What the data are to be looked at for, in sentences: that no plant satisfies them, where that is proved, or that the
    /// bounds seem to be taken before the shift by the zero dynamics. The claim holds all the same.
    #[must_use]
    pub fn remarks(&self) -> &[String] {
        &self.remarks
    }

    /// The certificate file: self-contained, with the specification in it; [`check`](crate::check) decides it again. The
    /// bytes are those of `sigmastar certify -o`.
    #[must_use]
    pub fn to_json(&self) -> &str {
        &self.json
    }

    /// The report of `sigmastar certify`: the claim, what it rests on, the conditions, and what follows from it.
    #[must_use]
    pub fn report(&self) -> &Report {
        &self.report
    }

    /// The specification or plant that the claim is about, with the sampling period where the options gave one.
    #[must_use]
    pub fn subject(&self) -> &Subject {
        &self.subject
    }
}

/// A claim: with this gain, or any larger one, and for every number of oscillators, every plant that the specification
/// describes (the plant, where its formulas are given) has a periodic solution to which every solution from the initial set
/// converges exponentially.
///
/// With an `actuator` the claim is one of exactly this gain. About the regulator at samples ([`Claim::samples`]) the claim is one of exactly this gain, and of every number of
/// oscillators below half of the samples of a period.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Claim {
    sigma_star: String,
    sigma_star_f64: f64,
    samples: Option<Samples>,
    statement: String,
    initial_set: InitialSet,
    periodic_solution: PeriodicSolution,
    rates: Vec<ClaimedRate>,
    bounds: Vec<ClaimedBounds>,
    sha256: String,
}

impl Claim {
    fn new(run: &Run<'_>) -> Option<Claim> {
        let certified = run.certified()?;
        let (sigma, set) = (certified.sigma, certified.set);
        let (sigma_star_f64, samples, statement) = match run {
            // Where the claim is about one gain a larger double is not covered either.
            Run::Continuous(run) => {
                let rounded = if run.spec.actuator.is_some() { nearest(sigma) } else { rounded_up(sigma) };
                (rounded, None, statement(run.spec, sigma, set, run.is_for_every_set()))
            }
            Run::Sampled(run) => {
                let witness = &run.claim()?.witness;
                let gain = write_exact(&witness.law.gain);
                let sampling = &witness.sampling;
                let samples =
                    Samples { period: sampling.text(), count: sampling.samples, gain, delayed: sampling.delayed };
                (nearest(sigma), Some(samples), sampled_statement(run.spec, witness))
            }
        };
        Some(Claim {
            sigma_star: write_exact(sigma),
            sigma_star_f64,
            samples,
            statement,
            initial_set: InitialSet::new(run.spec(), set),
            periodic_solution: PeriodicSolution::new(&certified.periodic),
            rates: Vec::new(),
            bounds: Vec::new(),
            sha256: run.spec().sha256.clone(),
        })
    }

    /// The gain sigma*, exactly: a decimal or a fraction. At samples, and with an actuator, the one gain that the claim is about.
    #[must_use]
    pub fn sigma_star(&self) -> &str {
        &self.sigma_star
    }

    /// The smallest double that is not below sigma*: the claim holds for it too. At samples and with an actuator, where it holds for no
    /// other gain, the double nearest to it.
    #[must_use]
    pub fn sigma_star_f64(&self) -> f64 {
        self.sigma_star_f64
    }

    /// The samples of the regulator that the claim is about; `None` where it is about the one in continuous time.
    #[must_use]
    pub fn samples(&self) -> Option<&Samples> {
        self.samples.as_ref()
    }

    /// The claim in words, with what it speaks of and what is given and not proved.
    #[must_use]
    pub fn statement(&self) -> &str {
        &self.statement
    }

    /// The initial conditions from which convergence is proved.
    #[must_use]
    pub fn initial_set(&self) -> &InitialSet {
        &self.initial_set
    }

    /// Upper bounds of the periodic solution.
    #[must_use]
    pub fn periodic_solution(&self) -> &PeriodicSolution {
        &self.periodic_solution
    }

    /// Rates at this gain alone, for the numbers of [`CertifyOptions::n_o`](crate::CertifyOptions::n_o) of which one is proved.
    #[must_use]
    pub fn rates(&self) -> &[ClaimedRate] {
        &self.rates
    }

    /// Bounds of the error and of the control at this gain alone by the number of oscillators, or by their harmonics: far smaller, as a rule, than those for
    /// every gain. None of a bounding specification.
    #[must_use]
    pub fn bounds(&self) -> &[ClaimedBounds] {
        &self.bounds
    }

    /// SHA-256, in hexadecimal, of the specification or plant that the claim is about
    /// ([`Specification::sha256`](crate::Specification::sha256), [`Subject::sha256`]).
    #[must_use]
    pub fn specification_sha256(&self) -> &str {
        &self.sha256
    }
}

/// The samples of a regulator that a computer runs.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Samples {
    /// The sampling period, exactly.
    pub period: String,
    /// How many of them are in a period of the disturbance.
    pub count: u32,
    /// K of the law `u = -sigma e + K v`, a double, exactly.
    pub gain: String,
    /// Whether it is the law whose control is computed in the sample before it acts (`delay_samples` 1).
    pub delayed: bool,
}

/// The set `|x| <= x0`, `|e| <= e0`, `sqrt(z'Nz) <= z0`, or `z = M e` in the place of the last; of a plant by its formulas
/// `|L^-1 (x - x_0(t))| <= x0` in the place of `|x| <= x0`, with the orbit x_0 and the coordinates L of its certificate.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct InitialSet {
    exact: StartSizes<String>,
    down: StartSizes<f64>,
    ball: Option<String>,
}

impl InitialSet {
    fn new(spec: &Specification, set: &ClaimedSet) -> InitialSet {
        let ball = spec.plant().and_then(|plant| claimed_ball(plant, &set.x0));
        InitialSet { exact: set.map(write_exact), down: set.map(rounded_down), ball: ball.as_ref().map(write_exact) }
    }

    /// Of a plant: a radius such that the set contains all x with `|x - x_0(t)|` up to it, exactly.
    #[must_use]
    pub fn ball(&self) -> Option<&str> {
        self.ball.as_deref()
    }

    /// x0, e0 and z0, exactly; no z0 where the regulator sets `z = M e`.
    #[must_use]
    pub fn exact(&self) -> (&str, &str, Option<&str>) {
        (&self.exact.x0, &self.exact.e0, self.exact.z0.as_deref())
    }

    /// x0, rounded down: the smaller set is covered too.
    #[must_use]
    pub fn x0(&self) -> f64 {
        self.down.x0
    }

    /// e0, rounded down.
    #[must_use]
    pub fn e0(&self) -> f64 {
        self.down.e0
    }

    /// z0, rounded down; `None` where the regulator sets `z = M e` at its first instant.
    #[must_use]
    pub fn z0(&self) -> Option<f64> {
        self.down.z0
    }
}

/// Upper bounds of the periodic solution at every gain from sigma* on, each rounded up.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct PeriodicSolution {
    /// Of `|x|`.
    pub x: f64,
    /// Of `|e|`.
    pub e: f64,
    /// Of `sqrt(zeta'N zeta)`, where `zeta = z - M e`.
    pub zeta: f64,
    /// Of `sqrt(z'Nz)`.
    pub z: f64,
}

impl PeriodicSolution {
    fn new(bounds: &[Enclosure; 4]) -> PeriodicSolution {
        let [x, e, zeta, z] = bounds.each_ref().map(Enclosure::upper_f64);
        PeriodicSolution { x, e, zeta, z }
    }
}
