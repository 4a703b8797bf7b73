//! Certifying the cases: each as `certify` does, in parallel over the cases.

use super::cases::{Case, Sweep};
use super::row::{Claim, Row, RowError};
use crate::certify::{
    BoundingProblem, Certification, Derivation, DigitalCertification, Ladder, Options, Verdict, certify_digital,
    certify_near, with_triple,
};
use crate::plant::{self, Plant};
use crate::progress::Progress;
use crate::reduction::{reduce, reduce_digital};
use crate::report::{DigitalReport, sentence};
use crate::search::{DigitalProposal, SharpProposal};
use crate::spec::{Document, Sampling, SpecErrors, Specification};
use rayon::prelude::*;

/// Certifies the cases of some indices on all cores and hands over each row as it is done.
///
/// A row depends on its case alone, so it is the same in every order.
///
/// # Errors
/// The first error of `done`, after which no further case is begun.
pub fn run<E: Send>(
    sweep: &Sweep,
    indices: &[u64],
    progress: &impl Progress,
    done: impl Fn(Row) -> Result<(), E> + Sync,
) -> Result<(), E> {
    // One case at a time for each thread: they differ widely in their work.
    indices.par_iter().with_max_len(1).try_for_each(|index| {
        let row = match sweep.case(*index) {
            Ok(case) => solve(&case, sweep.study().derivation),
            Err(errors) => Row { index: *index, values: Vec::new(), sha256: String::new(), ..refused(vec![errors]) },
        };
        progress.advance();
        done(row)
    })
}

/// The row of a case.
///
/// Guarantee: `certified` only where the certification of the document is.
#[must_use]
pub fn solve(case: &Case, derivation: Derivation) -> Row {
    let row = with_run(&case.document, derivation, row).unwrap_or_else(refused);
    Row { index: case.index, values: case.values.clone(), sha256: case.sha256.clone(), ..row }
}

/// What came of a document.
#[derive(Clone, Copy, Debug)]
pub enum Run<'r> {
    /// Of the regulator in continuous time.
    Continuous(&'r Certification<'r>),
    /// Of the regulator at samples.
    AtSamples(&'r DigitalCertification<'r>),
}

/// Certifies a specification or plant as `certify` does, and hands over what came of it.
///
/// # Errors
/// What keeps the document from a run.
pub fn with_run<T>(
    document: &Document,
    derivation: Derivation,
    see: impl FnOnce(Run<'_>) -> T,
) -> Result<T, Vec<SpecErrors>> {
    let options = Options { derivation, compare: false, ..Options::default() };
    let root = document.root();
    if document.at("/format").is_some_and(|format| format.text() == Some(plant::FORMAT)) {
        let plant = Plant::from_value(&root).map_err(|errors| vec![errors])?;
        if let Some(sampling) = &plant.internal_model.sampling {
            let reduced = reduce_digital(&plant, sampling, None).map_err(|refusal| refusal.errors(&plant))?;
            return at_samples(&reduced.spec, sampling, Some(&reduced.proposal), see);
        }
        let reduced = reduce(&plant).map_err(|refusal| refusal.errors(&plant))?;
        return continuous(&reduced.spec, Some(&reduced.proposal), options, see);
    }
    let spec = Specification::from_value(&root).map_err(|errors| vec![errors])?;
    let spec = with_triple(&spec, None).map_err(|refusal| refusal.errors(&spec))?;
    match &spec.internal_model.sampling {
        Some(sampling) => at_samples(&spec, sampling, None, see),
        None => continuous(&spec, None, options, see),
    }
}

fn continuous<T>(
    spec: &Specification,
    start: Option<&SharpProposal>,
    options: Options,
    see: impl FnOnce(Run<'_>) -> T,
) -> Result<T, Vec<SpecErrors>> {
    let run = certify_near(spec, options, start).map_err(|refusal| refusal.errors(spec))?;
    Ok(see(Run::Continuous(&run)))
}

fn at_samples<T>(
    spec: &Specification,
    sampling: &Sampling,
    start: Option<&DigitalProposal>,
    see: impl FnOnce(Run<'_>) -> T,
) -> Result<T, Vec<SpecErrors>> {
    let run = certify_digital(spec, sampling, None, start, Ladder::default());
    let run = run.map_err(|refusal| refusal.errors(spec))?;
    Ok(see(Run::AtSamples(&run)))
}

/// The row of what came of a case.
fn row(run: Run<'_>) -> Row {
    let problems = |unproved: &[BoundingProblem], spec| unproved.iter().map(|problem| problem.errors(spec)).collect();
    match run {
        Run::Continuous(run) => {
            let unproved: Vec<SpecErrors> = problems(&run.unproved_bounds, run.spec);
            told(run.verdict, continuous_claim(run), || sentence(run), &unproved)
        }
        Run::AtSamples(run) => {
            let unproved: Vec<SpecErrors> = problems(&run.unproved_bounds, run.spec);
            told(run.verdict, digital_claim(run), || DigitalReport::new(run, false).sentence(), &unproved)
        }
    }
}

/// The claim of a run, if certified.
fn continuous_claim(run: &Certification<'_>) -> Option<Claim> {
    let (sigma, set, periodic) = (run.sigma_star()?, run.claimed_set()?, run.periodic_solution()?);
    Some(Claim::new(sigma, set, &periodic, run.no_plant.is_some()))
}

fn digital_claim(run: &DigitalCertification<'_>) -> Option<Claim> {
    let (witness, periodic) = (&run.claim()?.witness, run.periodic_solution()?);
    let claim = Claim::new(&witness.sigma, &witness.set, &periodic, run.no_plant.is_some());
    Some(Claim { sampling_period: Some(run.sampling.text()), ..claim })
}

/// The row of a run: its claim, or why there is none.
fn told(verdict: Verdict, claim: Option<Claim>, reason: impl Fn() -> String, unproved: &[SpecErrors]) -> Row {
    // A claim is not to rest on one field.
    let verdict = if verdict == Verdict::Certified && claim.is_none() { Verdict::Undecided } else { verdict };
    let claim = claim.filter(|_| verdict == Verdict::Certified);
    let reason = claim.is_none().then(reason);
    Row { verdict, claim, reason, ..empty(errors(unproved)) }
}

/// The row of a case that came to no run.
fn refused(all: Vec<SpecErrors>) -> Row {
    let undecided = all.iter().all(SpecErrors::is_undecided);
    Row { verdict: if undecided { Verdict::Undecided } else { Verdict::BadInput }, ..empty(errors(&all)) }
}

fn empty(errors: Vec<RowError>) -> Row {
    Row {
        index: 0,
        values: Vec::new(),
        sha256: String::new(),
        verdict: Verdict::Undecided,
        claim: None,
        reason: None,
        errors,
    }
}

fn errors(all: &[SpecErrors]) -> Vec<RowError> {
    let every = all.iter().flat_map(SpecErrors::errors);
    let one = |error: &crate::spec::SpecError| RowError {
        code: error.kind.code().to_owned(),
        pointer: error.pointer.clone(),
        message: error.message.clone(),
    };
    every.map(one).collect()
}
