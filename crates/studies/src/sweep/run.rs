//! Certifying the cases: each as `certify` does, in parallel over the cases.

use super::cases::{Case, Sweep};
use super::results::Results;
use super::row::{Row, RowClaim, RowError};
use rayon::prelude::*;
use sigmastar_document::progress::Progress;
use sigmastar_lang::spec::SpecErrors;
use sigmastar_prove::certify::{Options, Verdict, verdict_of_errors};
use sigmastar_prove::reduction::{Prepared, Subject};
use sigmastar_report::run_sentence;

/// Certifies every case, on all cores. A row depends on its case alone, so it is the same in every order.
#[must_use]
pub fn run(sweep: &Sweep, progress: &impl Progress) -> Results {
    let indices: Vec<u64> = (0..sweep.count()).collect();
    // One case at a time for each thread: they differ widely in their work.
    let rows = indices.par_iter().with_max_len(1).map(|index| {
        let row = match sweep.case(*index) {
            Ok(case) => solve(&case),
            Err(errors) => Row { index: *index, values: Vec::new(), sha256: String::new(), ..refused(vec![errors]) },
        };
        progress.advance();
        (*index, row)
    });
    Results { rows: rows.collect(), ..Results::new(sweep) }
}

/// The row of a case.
///
/// Guarantee: `certified` only where the certification of the document is.
#[must_use]
pub fn solve(case: &Case) -> Row {
    let row = attempt(case).unwrap_or_else(refused);
    Row { index: case.index, values: case.values.clone(), sha256: case.sha256.clone(), ..row }
}

fn attempt(case: &Case) -> Result<Row, Vec<SpecErrors>> {
    let options = Options { compare: false, ..Options::default() };
    let subject = Subject::read(&case.document).map_err(|errors| vec![errors])?;
    let prepared = Prepared::new(subject, None)?;
    let run = prepared.certify(options)?;
    let claim = run.certified().map(|certified| RowClaim::new(&certified));
    let verdict = if claim.is_some() { run.verdict() } else { run.verdict().without_claim() };
    let reason = claim.is_none().then(|| run_sentence(&run));
    Ok(Row { verdict, claim, reason, ..empty(errors(&run.unproved())) })
}

/// The row of a case that came to no run.
fn refused(all: Vec<SpecErrors>) -> Row {
    Row { verdict: verdict_of_errors(&all), ..empty(errors(&all)) }
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
    let one = |error: &sigmastar_lang::spec::SpecError| RowError {
        code: error.kind.code().to_owned(),
        pointer: error.pointer.clone(),
        message: error.message.clone(),
    };
    every.map(one).collect()
}
