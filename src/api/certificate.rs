//! Certifying, and what a certificate says.

use super::error::Error;
use super::options::CertifyOptions;
use super::specification::Specification;
use super::{json_text, rounded_down, rounded_up};
use crate::certificate::{certificate_json, statement};
use crate::certify::{self, Certification, Refusal, with_triple};
use crate::derivation::condition;
use crate::derivation::sharp::ClaimedSet;
use crate::enclosure::{Enclosure, Truth};
use crate::number::write_exact;
use crate::report::{remarks, sentence};
use rug::Rational;

/// Certifies a specification: a Lyapunov triple for its Jacobian where it has one, the search for a small gain, and the
/// rigorous decision of every condition.
///
/// Guarantee: there is a [`Certificate`] only where the bounding functions are proved on every argument that is used and
/// every condition is proved. The same specification and options give the same bytes. The gain is the smallest that was
/// found, not the smallest that works.
///
/// # Errors
/// - [`Range`](crate::ErrorKind::Range): a bounding function is refuted, the filter of a relative degree is not stable, an
///   option is out of range, or the specification asks for the regulator at samples (`sampling_period`), which the program
///   certifies;
/// - [`Undecided`](crate::ErrorKind::Undecided): no Lyapunov triple was found for the Jacobian, or a bounding function was
///   neither proved nor refuted;
/// - [`NotCertified`](crate::ErrorKind::NotCertified): no gain was found, or a condition was not proved; the conditions are
///   those of [`Error::conditions`].
pub fn certify(specification: &Specification, options: &CertifyOptions) -> Result<Certificate, Error> {
    let options = options.checked()?;
    let refused = |refusal: Refusal| Error::documents(&refusal.errors(&specification.read));
    let spec = with_triple(&specification.read, None).map_err(refused)?;
    let run = certify::certify(&spec, options).map_err(refused)?;
    if let Some(certificate) = Certificate::new(&run) {
        return Ok(certificate);
    }
    if !run.unproved_bounds.is_empty() {
        return Err(refused(Refusal::Bounds(run.unproved_bounds)));
    }
    Err(Error::not_certified(sentence(&run), conditions(&run)))
}

/// A certified claim, the conditions that prove it, and the file from which both can be checked again.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Certificate {
    claim: Claim,
    conditions: Vec<Condition>,
    remarks: Vec<String>,
    json: String,
}

impl Certificate {
    /// `None` where nothing was certified.
    fn new(run: &Certification<'_>) -> Option<Certificate> {
        let json = json_text(&certificate_json(run)?);
        let remarks = remarks(run);
        Some(Certificate { claim: Claim::new(run)?, conditions: conditions(run), remarks, json })
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
}

/// A claim: with this gain, or any larger one, and for every number of oscillators, every plant that the specification
/// describes has a periodic solution to which every solution from the initial set converges exponentially.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Claim {
    sigma_star: String,
    sigma_star_up: f64,
    statement: String,
    initial_set: InitialSet,
    periodic_solution: PeriodicSolution,
    sha256: String,
}

impl Claim {
    fn new(run: &Certification<'_>) -> Option<Claim> {
        let (sigma, set) = (run.sigma_star()?, run.claimed_set()?);
        let [x, e, zeta, z] = run.periodic_solution()?.map(|bound| bound.upper_f64());
        Some(Claim {
            sigma_star: write_exact(sigma),
            sigma_star_up: rounded_up(sigma),
            statement: statement(run, sigma, set),
            initial_set: InitialSet::new(set),
            periodic_solution: PeriodicSolution { x, e, zeta, z },
            sha256: run.spec.sha256.clone(),
        })
    }

    /// The gain sigma*, exactly: a decimal or a fraction.
    #[must_use]
    pub fn sigma_star(&self) -> &str {
        &self.sigma_star
    }

    /// The smallest double that is not below sigma*: the claim holds for it too.
    #[must_use]
    pub fn sigma_star_f64(&self) -> f64 {
        self.sigma_star_up
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

    /// SHA-256, in hexadecimal, of the specification that the claim is about ([`Specification::sha256`]).
    #[must_use]
    pub fn specification_sha256(&self) -> &str {
        &self.sha256
    }
}

/// The set `|x| <= x0`, `|e| <= e0`, `sqrt(z'Nz) <= z0`.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct InitialSet {
    exact: [String; 3],
    down: [f64; 3],
}

impl InitialSet {
    fn new(set: &ClaimedSet) -> InitialSet {
        let sizes: [&Rational; 3] = [&set.x0, &set.e0, &set.z0];
        InitialSet { exact: sizes.map(write_exact), down: sizes.map(rounded_down) }
    }

    /// x0, e0 and z0, exactly.
    #[must_use]
    pub fn exact(&self) -> [&str; 3] {
        self.exact.each_ref().map(String::as_str)
    }

    /// x0, rounded down: the smaller set is covered too.
    #[must_use]
    pub fn x0(&self) -> f64 {
        self.down[0]
    }

    /// e0, rounded down.
    #[must_use]
    pub fn e0(&self) -> f64 {
        self.down[1]
    }

    /// z0, rounded down.
    #[must_use]
    pub fn z0(&self) -> f64 {
        self.down[2]
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

/// A condition: a comparison of two real numbers, each known between two doubles.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Condition {
    id: &'static str,
    text: String,
    lhs: [f64; 2],
    rhs: [f64; 2],
    relation: &'static str,
    holds: Option<bool>,
}

impl Condition {
    fn new(condition: &condition::Condition) -> Condition {
        let ends = |side: &Enclosure| [side.lower_f64(), side.upper_f64()];
        Condition {
            id: condition.id,
            text: condition.what.clone(),
            lhs: ends(&condition.lhs),
            rhs: ends(&condition.rhs),
            relation: match condition.relation {
                condition::Relation::Less => "<",
                condition::Relation::LessOrEqual => "<=",
            },
            holds: match condition.truth() {
                Truth::True => Some(true),
                Truth::False => Some(false),
                Truth::Undecided => None,
            },
        }
    }

    /// Its name: `C1`, `C2`, ... (`docs/mathematics.md`).
    #[must_use]
    pub fn id(&self) -> &'static str {
        self.id
    }

    /// What it says, in a few words.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The left side lies between these doubles, rounded outward; NaN where it is not known to be defined.
    #[must_use]
    pub fn lhs(&self) -> [f64; 2] {
        self.lhs
    }

    /// The right side, in the same way.
    #[must_use]
    pub fn rhs(&self) -> [f64; 2] {
        self.rhs
    }

    /// `<` or `<=`.
    #[must_use]
    pub fn relation(&self) -> &'static str {
        self.relation
    }

    /// Whether it holds, decided at a higher precision than the doubles; `None` where that is not known.
    #[must_use]
    pub fn holds(&self) -> Option<bool> {
        self.holds
    }
}

fn conditions(run: &Certification<'_>) -> Vec<Condition> {
    run.conditions().iter().map(Condition::new).collect()
}
