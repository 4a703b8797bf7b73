//! `sigmastar certify`.

use super::args::{CertifyArgs, Format};
use super::failure::Failure;
use super::files::{Input, OutputFile};
use super::progress::{Audience, Working};
use super::{input, output};
use sigmastar::certificate::{certificate_json, read_lyapunov, read_witness};
use sigmastar::certify::{Certification, certify, recheck, with_triple};
use sigmastar::derivation::targets::TargetKind;
use sigmastar::report::Report;
use sigmastar::spec::{Document, SpecErrors, Specification};
use std::borrow::Cow;

/// Runs the command and returns the exit code.
pub fn run(args: &CertifyArgs) -> u8 {
    attempt(args).unwrap_or_else(|failure| failure.tell(args.format, args.quiet))
}

fn attempt(args: &CertifyArgs) -> Result<u8, Failure> {
    // What is wrong with the call is said before any work is done.
    let output = args
        .output
        .as_deref()
        .map(|path| OutputFile::new(path, Input::Specification(&args.spec), "the certificate"))
        .transpose()?;
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
    let spec = Specification::from_value(&input::document(&args.spec)?.root())?;
    let witness = args.witness.as_deref().map(input::document).transpose()?;
    let spec = triple(&spec, witness.as_ref(), args.quiet)?;

    let audience = if args.quiet { Audience::Nobody } else { Audience::Terminal };
    let working = Working::new("searching the free numbers, deciding the conditions", audience);
    let run = match &witness {
        None => certify(&spec, args.options()),
        Some(document) => {
            let witness = read_witness(document)?;
            let made_for = document.at("/specification_sha256");
            if made_for.is_some_and(|digest| digest.text() != Some(&spec.sha256)) && !args.quiet {
                output::remark("the certificate was made for another specification; its witness is tried on this one");
            }
            recheck(&spec, &witness, args.options())
        }
    };
    drop(working);
    let run = run.map_err(|refusal| Failure::Documents(refusal.errors(&spec)))?;
    let report = Report::new(&run, &targets).rechecked(args.witness.is_some());
    let text = output::report(&report, args.format);
    if let Some(file) = &output {
        write_certificate(&run, file, args.quiet)?;
    }
    if let Err(code) = output::data(&text) {
        return Ok(code);
    }
    let unproved: Vec<SpecErrors> = run.unproved_bounds.iter().map(|problem| problem.errors(&spec)).collect();
    if !unproved.is_empty() && args.format != Format::Json {
        output::diagnostics(&unproved);
    }
    Ok(run.verdict.exit_code())
}

/// The specification with a proved triple: where it has a Jacobian, that of the witness, or one that is found.
pub(super) fn triple<'s>(
    spec: &'s Specification,
    witness: Option<&Document>,
    quiet: bool,
) -> Result<Cow<'s, Specification>, Failure> {
    let wanted = spec.lyapunov.triple().is_none();
    let _working = wanted.then(|| seeking_triple(quiet));
    let given = witness.filter(|_| wanted).map(read_lyapunov).transpose()?;
    with_triple(spec, given.as_ref()).map_err(|refusal| Failure::Documents(refusal.errors(spec)))
}

/// Says that a triple is sought, where that takes long.
pub(super) fn seeking_triple(quiet: bool) -> Working {
    let audience = if quiet { Audience::Nobody } else { Audience::Everywhere };
    Working::new("finding and proving the Lyapunov triple of the Jacobian", audience)
}

/// Writes the certificate, or says why there is none.
fn write_certificate(run: &Certification<'_>, file: &OutputFile, quiet: bool) -> Result<(), Failure> {
    let name = file.name();
    match certificate_json(run) {
        Some(certificate) => {
            file.write(output::json_text(&certificate))?;
            if !quiet {
                output::remark(&format!("the certificate is in `{name}`"));
            }
        }
        None => output::remark(&format!("`{name}` was not written: the verdict is {}", run.verdict)),
    }
    Ok(())
}
