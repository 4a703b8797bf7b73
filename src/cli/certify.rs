//! `sigmastar certify`.

use super::args::{CertifyArgs, Format};
use super::failure::Failure;
use super::files::{Input, OutputFile};
use super::output::Shortened;
use super::progress::{Audience, Working};
use super::subject::{IntoData, Subject, seeking_triple};
use super::{input, output, sampled};
use serde_json::Value;
use sigmastar::certificate::{certificate_json, is_sampled, read_lyapunov, read_plant_witness, read_witness};
use sigmastar::certify::{Verdict, certify_at, certify_near, recheck, with_triple};
use sigmastar::derivation::targets::TargetKind;
use sigmastar::plant::Plant;
use sigmastar::reduction::{PlantRefusal, decide_again};
use sigmastar::report::Report;
use sigmastar::search::SharpProposal;
use sigmastar::spec::{Document, SpecErrors, Specification};

/// Runs the command and returns the exit code.
pub fn run(args: &CertifyArgs) -> u8 {
    attempt(args).unwrap_or_else(|failure| failure.tell(args.format, args.quiet))
}

fn attempt(args: &CertifyArgs) -> Result<u8, Failure> {
    // What is wrong with the call is said before any work is done.
    let output = args.replace.asked(args.output.as_deref(), Input::Specification(&args.spec), "the certificate")?;
    let flags =
        [(TargetKind::Sup, "--target-sup", &args.target_sup), (TargetKind::Rms, "--target-rms", &args.target_rms)];
    let targets = flags
        .into_iter()
        .filter_map(|(kind, flag, text)| text.as_ref().map(|text| input::target(kind, flag, text)))
        .collect::<Result<Vec<_>, _>>()?;
    if args.spec == args.witness.clone().unwrap_or_default() {
        let message = "the specification and the witness cannot be the same file";
        return Err(Failure::call(message, "--witness names a certificate written with -o"));
    }
    let document = input::document(&args.spec)?;
    let subject = match &args.sampling_period {
        Some(text) => Subject::read(&sampled::with_sampling_period(&document, text)?)?,
        None => Subject::read(&document)?,
    };
    let witness = args.witness.as_deref().map(input::written).transpose()?;
    let gain = args.sigma.as_deref().map(|text| input::rational("--sigma", text)).transpose()?;
    if witness.as_ref().is_some_and(is_sampled) || (witness.is_none() && subject.sampling().is_some()) {
        return sampled::run(args, subject, witness.as_ref(), gain.as_ref(), output.as_ref());
    }
    if subject.sampling().is_some() {
        let message =
            "the witness is of the regulator in continuous time, and `sampling_period` asks for the one at samples";
        return Err(Failure::call(message, "leave the sampling period out, or certify without --witness"));
    }
    let of_plant = matches!(subject, Subject::Plant(_));
    if let Some(misfit) = args.options().misfit(of_plant, false, gain.is_some()) {
        return Err(Failure::misfit(misfit));
    }
    let (spec, start) = data(subject, witness.as_ref(), args.quiet)?;

    let audience = if args.quiet { Audience::Nobody } else { Audience::Terminal };
    let working = Working::new("searching the free numbers, deciding the conditions", audience);
    let run = match &witness {
        None => match &gain {
            None => certify_near(&spec, args.options(), start.as_ref()),
            Some(gain) => certify_at(&spec, args.options(), start.as_ref(), gain),
        },
        Some(document) => {
            let witness = read_witness(document)?;
            tell_other_specification(&spec, document, args.quiet);
            recheck(&spec, &witness, args.options())
        }
    };
    drop(working);
    let run = run.map_err(|refusal| Failure::Documents(refusal.errors(&spec)))?;
    let report = Report::new(&run, &targets).rechecked(args.witness.is_some());
    let shown = Shortened::new(&report, args.format, args.full);
    if let Some(file) = &output {
        write_certificate(certificate_json(&run), run.verdict, file, args.quiet)?;
    }
    if let Err(code) = shown.show(args.quiet) {
        return Ok(code);
    }
    let unproved: Vec<SpecErrors> = run.unproved_bounds.iter().map(|problem| problem.errors(&spec)).collect();
    if !unproved.is_empty() && args.format != Format::Json {
        output::diagnostics(&unproved);
    }
    Ok(run.verdict.exit_code())
}

/// The specification with proved data: those of the witness, proved again, or those that are found.
pub fn data(
    subject: Subject,
    witness: Option<&Document>,
    quiet: bool,
) -> Result<(Specification, Option<SharpProposal>), Failure> {
    match (subject, witness) {
        (Subject::Plant(plant), Some(document)) => Ok((proved_again(&plant, document)?, None)),
        (Subject::Specification(spec), Some(document)) => {
            let wanted = spec.lyapunov.triple().is_none();
            let _working = wanted.then(|| seeking_triple(quiet));
            let given = wanted.then(|| read_lyapunov(document)).transpose()?;
            let proved = with_triple(&spec, given.as_ref());
            Ok((proved.map_err(|refusal| Failure::Documents(refusal.errors(&spec)))?.into_owned(), None))
        }
        (subject, None) => subject.into_data(quiet),
    }
}

/// Says where a witness was made for something else.
pub fn tell_other_specification(spec: &Specification, certificate: &Document, quiet: bool) {
    let digest = if spec.plant().is_some() { "/plant_sha256" } else { "/specification_sha256" };
    let made_for = certificate.at(digest);
    if made_for.is_some_and(|digest| digest.text() != Some(&spec.sha256)) && !quiet {
        let subject = if spec.plant().is_some() { "plant" } else { "specification" };
        output::remark(&format!("the certificate was made for another {subject}; its witness is tried on this one"));
    }
}

/// The data that the witness of a certificate says of a plant, proved again.
pub fn proved_again(plant: &Plant, document: &Document) -> Result<Specification, Failure> {
    let (_, of_plant, values) = read_plant_witness(document)?;
    let other = document.at("/plant_sha256").is_some_and(|digest| digest.text() != Some(&plant.sha256));
    decide_again(plant, of_plant, values).map_err(|refusal| {
        let refusal = if other { PlantRefusal::OfAnother(Box::new(refusal)) } else { refusal };
        Failure::Documents(refusal.errors(plant))
    })
}

/// Writes the certificate, or says why there is none.
pub fn write_certificate(
    certificate: Option<Value>,
    verdict: Verdict,
    file: &OutputFile,
    quiet: bool,
) -> Result<(), Failure> {
    let name = file.name();
    match certificate {
        Some(certificate) => {
            file.write(output::json_text(&certificate))?;
            if !quiet {
                output::remark(&format!("the certificate is in `{name}`"));
            }
        }
        None => output::remark(&format!("`{name}` was not written: the verdict is {verdict}")),
    }
    Ok(())
}
