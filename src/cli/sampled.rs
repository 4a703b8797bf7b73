//! `sigmastar certify` for the regulator at samples.

use super::args::{CertifyArgs, Format};
use super::certify::{data, tell_other_specification, write_certificate};
use super::failure::Failure;
use super::files::OutputFile;
use super::output::Shortened;
use super::progress::{Audience, Working};
use super::subject::{IntoData, Subject};
use super::{input, output};
use rug::Rational;
use sigmastar::certificate::{read_sampled_witness, sampled_certificate_json};
use sigmastar::certify::{SampledCertification, certify_sampled, recheck_sampled};
use sigmastar::reduction::at_samples;
use sigmastar::report::SampledReport;
use sigmastar::spec::{Document, Sampling, SpecErrors, Specification};

/// Runs it and returns the exit code.
pub fn run(
    args: &CertifyArgs,
    subject: Subject,
    witness: Option<&Document>,
    gain: Option<&Rational>,
    output: Option<&OutputFile>,
) -> Result<u8, Failure> {
    refuse(args)?;
    let audience = if args.quiet { Audience::Nobody } else { Audience::Terminal };
    let (spec, start) = match (witness, subject.sampling().cloned()) {
        (None, Some(sampling)) => subject.into_sampled_data(&sampling, gain, args.quiet)?,
        (given, _) => (data(subject, given, args.quiet)?.0, None),
    };
    let working = Working::new("searching the free numbers, deciding the conditions", audience);
    let ladder = args.options().ladder;
    let run = match (witness, &spec.internal_model.sampling) {
        (Some(document), asked) => {
            let witness = read_sampled_witness(document)?;
            tell_other_specification(&spec, document, args.quiet);
            same_samples(&spec, &witness.sampling, asked.as_ref())?;
            recheck_sampled(&spec, &witness, ladder)
        }
        (None, Some(sampling)) => certify_sampled(&spec, sampling, gain, start.as_ref(), ladder),
        (None, None) => return Err(Failure::call("no sampling period is given", "give it with --sampling-period")),
    };
    drop(working);
    let run = run.map_err(|refusal| Failure::Documents(refusal.errors(&spec)))?;
    tell(args, &run, witness.is_some(), output)
}

fn tell(
    args: &CertifyArgs,
    run: &SampledCertification<'_>,
    rechecked: bool,
    file: Option<&OutputFile>,
) -> Result<u8, Failure> {
    let shown = Shortened::new(&SampledReport::new(run, rechecked), args.format, args.full);
    if let Some(file) = file {
        write_certificate(sampled_certificate_json(run), run.verdict, file, args.quiet)?;
    }
    if let Err(code) = shown.show(args.quiet) {
        return Ok(code);
    }
    let unproved: Vec<SpecErrors> = run.unproved_bounds.iter().map(|problem| problem.errors(run.spec)).collect();
    if !unproved.is_empty() && args.format != Format::Json {
        output::diagnostics(&unproved);
    }
    Ok(run.verdict.exit_code())
}

/// Flags that make no sense for the regulator at samples.
fn refuse(args: &CertifyArgs) -> Result<(), Failure> {
    if let Some(misfit) = args.options().misfit(false, true, false) {
        return Err(Failure::misfit(misfit));
    }
    let wrong = [
        (args.target_sup.is_some(), "--target-sup", "bounds by the number of oscillators are of continuous time"),
        (args.target_rms.is_some(), "--target-rms", "bounds by the number of oscillators are of continuous time"),
    ];
    match wrong.into_iter().find(|(given, ..)| *given) {
        Some((_, flag, why)) => {
            let message = format!("{flag} is not for the regulator at samples: {why}");
            Err(Failure::call(message, format!("leave {flag} or the sampling period out")))
        }
        None => Ok(()),
    }
}

/// The samples of a witness have to be those of the specification's period, and of its own sampling period.
fn same_samples(spec: &Specification, stated: &Sampling, asked: Option<&Sampling>) -> Result<(), Failure> {
    let step = stated.text();
    if asked.is_some_and(|asked| !asked.is(&stated.step)) {
        let message =
            format!("the certificate is about the sampling period {step}, the specification asks for another one");
        return Err(Failure::call(message, "certify without --witness"));
    }
    match Sampling::new(&spec.period, stated.step.clone()) {
        Some(real) if real.samples == stated.samples && spec.internal_model.matched => Ok(()),
        _ => {
            let samples = stated.samples;
            let message = format!(
                "the certificate is about {samples} samples of {step} in a period at a matched base frequency, and that is \
                 not so here"
            );
            Err(Failure::call(message, "certify without --witness"))
        }
    }
}

/// The document with another sampling period, or itself where it has no internal model: what is wrong with it is told as ever.
///
/// # Errors
/// A period that is not an exact positive constant, and a document that is too large with it.
pub fn with_sampling_period(document: &Document, text: &str) -> Result<Document, Failure> {
    let step = input::positive("--sampling-period", text)?;
    Ok(at_samples(document, &step, "--sampling-period")?)
}
