//! Certifying: the whole way from a document to a certificate, or to the reason why there is none.

use super::certificate::Certificate;
use super::check::{CheckVerdict, verdict_within};
use super::condition::Condition;
use super::error::{Error, ErrorKind};
use super::options::{Asked, CertifyOptions};
use super::report::Report;
use super::subject::Subject;
use super::{json_text, with_sampling_period};
use sigmastar_lang::spec::Oscillators;
use sigmastar_prove::certificate::certificate_of;
use sigmastar_prove::certify::Options;
use sigmastar_prove::reduction::{Checked, Prepared, Run, Stage, Subject as Read, Unwatched, Watch, for_every_set};
use sigmastar_report::run_sentence;
use std::fmt;
use std::sync::{Mutex, PoisonError};

/// Certifies a specification or a plant: a Lyapunov triple for a Jacobian or the orbit and bounds of a plant, the search for a
/// small gain, and the rigorous decision of every condition.
///
/// The claim is about the regulator in continuous time, or, where the document or the options have a sampling period, about the
/// one that a computer runs at samples so far apart.
///
/// Guarantee: there is a [`Certificate`] only where the bounding functions are proved on every argument that is used and
/// every condition is proved. The same document and options give the same bytes. The gain is the smallest that was
/// found, not the smallest that works.
///
/// # Errors
/// - [`Range`](crate::ErrorKind::Range): a bounding function is refuted, the filter of a relative degree is not stable, the
///   right sides of a plant are not periodic, or an option is out of range;
/// - [`Options`](crate::ErrorKind::Options): options that do not go together, or not with this document;
/// - [`Undecided`](crate::ErrorKind::Undecided): no Lyapunov triple was found for the Jacobian, the data of a plant could not be
///   proved, or a bounding function was neither proved nor refuted;
/// - [`NotCertified`](crate::ErrorKind::NotCertified): no gain was found, or a condition was not proved; the conditions are
///   those of [`Error::conditions`].
///
/// [`Error::verdict`] is the verdict of the program.
pub fn certify(subject: impl Into<Subject>, options: &CertifyOptions) -> Result<Certificate, Error> {
    run(&subject.into(), options, (&Unwatched, &|_| {}))
}

/// [`certify`], which tells what it is at: a phrase for each stage as it begins, as "proving the bounds of the formulas". A stage may come again. Nothing
/// that is found depends on it.
///
/// # Errors
/// Those of [`certify`].
pub fn certify_telling(
    subject: impl Into<Subject>,
    options: &CertifyOptions,
    tell: &(dyn Fn(&str) + Sync),
) -> Result<Certificate, Error> {
    let telling = Telling { tell, last: Mutex::new(None) };
    run(&subject.into(), options, (&telling, &|next| tell(&next.to_string())))
}

/// Tells a stage when it begins.
struct Telling<'t> {
    tell: &'t (dyn Fn(&str) + Sync),
    last: Mutex<Option<Stage>>,
}

impl Watch for Telling<'_> {
    fn enter(&self, stage: Stage) {
        let last = self.last.lock().unwrap_or_else(PoisonError::into_inner).replace(stage);
        if last != Some(stage) {
            (self.tell)(&stage.to_string());
        }
    }

    fn part(&self, _: usize, _: usize) {}

    fn tried(&self, _: usize) {}

    fn searched(&self, _: usize, _: usize, _: usize) {}
}

/// Who is told of the stages, and of those that follow the claim.
type Told<'t> = (&'t dyn Watch, &'t dyn Fn(Afterwards));

fn run(subject: &Subject, options: &CertifyOptions, (watch, begin): Told<'_>) -> Result<Certificate, Error> {
    let Asked { options, gain, step, counts, sets, limits } = options.checked()?;
    let mut asked = subject.clone();
    if step.is_some() || !sets.is_empty() {
        let mut document = match &step {
            Some(step) => with_sampling_period(&subject.source, "sampling_period", step)?,
            None => subject.source.clone(),
        };
        if !sets.is_empty() {
            document = for_every_set(&document)?;
        }
        asked.read = Read::read(&document)?;
    }
    if let Some([message, help]) = not_told_apart(&sets, &asked.read, "harmonics") {
        return Err(Error::new(ErrorKind::Options, message, &help));
    }
    let sampled = asked.read.sampling().is_some();
    let kind = (sampled, asked.read.internal_model().asks_every_set());
    if let Some([message, help]) = options.misfit(kind, "`transfer`") {
        return Err(Error::new(ErrorKind::Options, message, &help));
    }
    let prepared = Prepared::seeking(&asked.read, gain, (&limits, &counts), options, watch)
        .map_err(|all| Error::documents(&all))?
        .with_sets(sets);
    let run = decided(&prepared, (options, &counts), ["`n_o`", "`harmonics`"], watch, begin)?;
    Certificate::new(&run, &asked, false).ok_or_else(|| not_certified(&run))
}

/// Why the samples of a document do not tell oscillators at these harmonics apart, and what to do about it; `option` is the list as the user writes it.
#[must_use]
pub fn not_told_apart(sets: &[Oscillators], read: &Read, option: &str) -> Option<[String; 2]> {
    let samples = read.sampling()?.samples;
    let largest = sets.iter().map(Oscillators::largest).max().unwrap_or(0);
    (2 * u64::from(largest) >= u64::from(samples)).then(|| {
        [
            format!(
                "{option}: the claim is about harmonics below {samples}/2, half of the samples in a period, and {largest} is not"
            ),
            "take a shorter sampling period, or smaller harmonics".to_owned(),
        ]
    })
}

/// What follows a claim that was decided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Afterwards {
    /// Rates for given oscillators.
    Rates,
    /// The certificate with these rates, by the independent checker.
    Checked,
}

impl fmt::Display for Afterwards {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Afterwards::Rates => "proving rates",
            Afterwards::Checked => "letting the independent checker decide",
        })
    }
}

/// The claim of what is prepared, decided and decided again by the independent checker, with rates for these numbers of oscillators and for its sets of
/// harmonics, the arguments of which are called so. Nothing is claimed that the checker does not decide as well.
///
/// # Errors
/// What the data are refused for, and a claim that has no rates for these numbers and sets. Of a law with a delay no rates are proved for sets: it has their
/// bounds alone.
pub fn decided<'p>(
    prepared: &'p Prepared,
    (options, counts): (Options, &[u32]),
    [n_o, harmonics]: [&str; 2],
    watch: &dyn Watch,
    begin: &dyn Fn(Afterwards),
) -> Result<Run<'p>, Error> {
    let run = prepared.certify_checked(options, &checked, watch);
    let mut run = run.map_err(|all| Error::documents(&all))?;
    begin(Afterwards::Rates);
    let delayed = matches!(&run, Run::Sampled(run) if run.sampling.delayed);
    let sets = if delayed { &[][..] } else { prepared.sets() };
    let asked: Vec<Oscillators> = first(counts).chain(sets.iter().cloned()).collect();
    let option = match (counts, sets) {
        (_, []) => n_o.to_owned(),
        ([], _) => harmonics.to_owned(),
        _ => format!("{n_o} and {harmonics}"),
    };
    run.prove_rates(&asked).map_err(|reason| Error::no_rates(reason, &option))?;
    if !asked.is_empty() {
        begin(Afterwards::Checked);
        run.answered(checked_within(1, &run));
    }
    Ok(run)
}

/// Oscillators at the first harmonics, for each of these numbers of them.
fn first(counts: &[u32]) -> impl Iterator<Item = Oscillators> + '_ {
    counts.iter().copied().map(Oscillators::first)
}

/// The claim of what is prepared, decided and decided again by the independent checker, with rates for these numbers of oscillators where the claim has
/// some and the checker decides these, too.
///
/// # Errors
/// What the data are refused for.
pub(super) fn with_rates<'p>(
    prepared: &'p Prepared,
    (options, asked): (Options, &[Oscillators]),
) -> Result<Run<'p>, Error> {
    let decided_by = |check: &dyn Fn(&Run<'_>) -> Checked| {
        prepared.certify_checked(options, check, &Unwatched).map_err(|all| Error::documents(&all))
    };
    // As a rule the checker decides all of it at once.
    let mut run = decided_by(&|_| Checked::Decided)?;
    if run.certified().is_none() {
        return Ok(run);
    }
    let has_rates = run.prove_rates(asked).is_ok();
    if has_rates && checked_within(1, &run) == Checked::Decided {
        return Ok(run);
    }
    let mut run = decided_by(&checked)?;
    // Without numbers it judges what is kept by the number of oscillators.
    run.prove_rates(&[]).map_err(|reason| Error::no_rates(reason, "`n_o`"))?;
    Ok(run)
}

/// What a claim may take of what the checker spends with its bounds by the number of oscillators: the rest is for rates.
const SHARE: u64 = 2;

/// What the independent checker says of the certificate of a run without rates: within all of its effort of a claim alone, so that it says what `check` says.
fn checked(run: &Run<'_>) -> Checked {
    checked_within(if run.says_by_count() { SHARE } else { 1 }, run)
}

/// What the independent checker says of the certificate of a run, within a share of its effort.
fn checked_within(share: u64, run: &Run<'_>) -> Checked {
    let Some(certificate) = certificate_of(run) else { return Checked::Decided };
    match verdict_within(share, &json_text(&certificate)) {
        CheckVerdict::Valid => Checked::Decided,
        CheckVerdict::Undecided => Checked::GivenUp,
        _ => Checked::Refused,
    }
}

/// Why a run has no certificate: the bounding functions that are not proved, or what the report says in one sentence.
pub(super) fn not_certified(run: &Run<'_>) -> Error {
    let (verdict, sentence) = (run.verdict().without_claim(), run_sentence(run));
    Error::not_certified(verdict, sentence, &run.unproved(), Condition::of_run(run), Report::of_run(run, false))
}
