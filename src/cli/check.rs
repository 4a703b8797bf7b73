//! `sigmastar check`.

use super::args::CheckArgs;
use super::failure::Failure;
use super::input;
use super::output::{self, Format, json_text, reason, shown};
use super::subject::has_format;
use sigmastar::program::{MAX_CERTIFICATE, check_bytes, page};
use sigmastar::{CheckReport, CheckVerdict, Report};
use sigmastar_document::clean;
use sigmastar_lang::plant::FORMAT as PLANT;
use sigmastar_lang::spec::{Document, FORMAT as SPECIFICATION, Notation, report};
use sigmastar_prove::certificate::FORMAT as CERTIFICATE;
use std::fs::File;
use std::io::{Cursor, Read};
use std::path::Path;

/// Runs the command and returns the exit code: that of the independent checker.
pub fn run(args: &CheckArgs) -> Result<u8, Failure> {
    let (answer, page) = answer(args)?;
    // The words of the checker's report are its own.
    let text = output::report(page.as_ref().unwrap_or(answer.report()), args.format);
    Ok(output::data(&text).err().unwrap_or(answer.verdict().exit_code()))
}

/// The answer, and of a valid certificate the page where one is asked for.
fn answer(args: &CheckArgs) -> Result<(CheckReport, Option<Report>), Failure> {
    let certificate = open(&args.certificate, "name a certificate that was written with `certify -o`")?;
    let specification = args.spec.as_deref().map(|path| specification(path, args)).transpose()?;
    let bytes = |file: Box<dyn Read>| {
        let mut bytes = Vec::new();
        let read = file.take(MAX_CERTIFICATE as u64 + 1).read_to_end(&mut bytes);
        read.map(|_| bytes).map_err(|error| {
            let message = format!("cannot read `{}`: {}", shown(&args.certificate), reason(&error));
            Failure::call(message, "name files, not folders")
        })
    };
    let (certificate, specification) = (bytes(certificate)?, specification.map(bytes).transpose()?);
    let answer = check_bytes(&certificate, specification.as_deref(), args.verbose);
    match answer.verdict() {
        CheckVerdict::Invalid if !args.quiet => tell_difference(args),
        CheckVerdict::BadInput if !args.quiet => tell_no_certificate(&args.certificate),
        CheckVerdict::Valid if args.format == Format::Html => {
            let page = page_of(args, &certificate, &answer);
            return Ok((answer, page));
        }
        _ => {}
    }
    Ok((answer, None))
}

/// The page of a valid certificate; where the same claim is not proved from it here, there is none, and a remark says what tells more.
fn page_of(args: &CheckArgs, certificate: &[u8], answer: &CheckReport) -> Option<Report> {
    let page = page(&shown(&args.certificate), certificate, answer.text().to_owned()).ok().flatten();
    if page.is_none() && !args.quiet {
        output::remark(
            "the page has the words of the checker alone: this version does not prove the same claim from the \
             certificate; `certify FILE --witness FILE` says what it proves",
        );
    }
    page
}

/// The specification to compare with: the file as it is, or what `convert` makes of it where it is no JSON, and `certify` with
/// `--sampling-period`.
fn specification(path: &Path, args: &CheckArgs) -> Result<Box<dyn Read>, Failure> {
    let is_json = Notation::of(path) == Notation::Json;
    if is_json && args.sampling_period.is_none() {
        return open(path, "name the specification that you have");
    }
    let mut document = input::document(path)?;
    if let Some(text) = &args.sampling_period {
        document = input::with_sampling_period(&document, "--sampling-period", text)?;
    }
    if !is_json && !args.quiet {
        let name = shown(path);
        output::remark(&format!(
            "the independent checker reads JSON alone: what it compares is what `sigmastar convert {name}` writes"
        ));
    }
    Ok(Box::new(Cursor::new(json_text(&document.root().to_json()))))
}

/// Says of a file that is no certificate what one is.
fn tell_no_certificate(path: &Path) {
    const WRITES: &str = "`sigmastar certify FILE -o CERTIFICATE` writes one";
    if path == Path::new("-") {
        return;
    }
    let written = input::written(path).ok();
    if written.as_ref().is_some_and(|document| has_format(document, CERTIFICATE)) {
        return;
    }
    let name = shown(path);
    // What people write may have comments, or be TOML.
    let document = input::document(path).ok();
    let is = |format: &str| document.as_ref().is_some_and(|document| has_format(document, format));
    let what = [(PLANT, "a plant"), (SPECIFICATION, "a specification")].into_iter().find(|(format, _)| is(format));
    let told = written.as_ref().and_then(|document| report(document.at("/format")?.text()?));
    output::remark(&match (what, told) {
        (Some((_, what)), _) => format!(
            "`{name}` is {what}, not a certificate: `sigmastar certify {name} -o CERTIFICATE` writes one, and `sigmastar check CERTIFICATE` \
             checks it"
        ),
        (None, Some(report)) => format!("`{name}` is {report}, not a certificate: {WRITES}"),
        (None, None) => format!("`{name}` is no certificate: {WRITES}"),
    });
}

/// Says where a certificate and the specification that it was compared with differ in the sampling period, and where that is a certificate
/// itself. Where one of them
/// cannot be read again there is nothing to say.
fn tell_difference(args: &CheckArgs) {
    let Some(path) = &args.spec else { return };
    let again = |path: &Path| (path != Path::new("-")).then(|| input::document(path).ok()).flatten();
    let (Some(certificate), Some(specification)) = (again(&args.certificate), again(path)) else { return };
    if has_format(&specification, CERTIFICATE) {
        let name = shown(path);
        output::remark(&format!(
            "`{name}` is a certificate: --spec takes the specification or plant that you have yourself"
        ));
        return;
    }
    let period = |document: &Document, place: &str| {
        let value = document.at(&format!("{place}/internal_model/sampling_period"))?;
        value.text().or_else(|| value.numeral()).map(str::to_owned)
    };
    let embedded = period(&certificate, "/specification").or_else(|| period(&certificate, "/plant"));
    let asked = args.sampling_period.clone().or_else(|| period(&specification, ""));
    if let Some(embedded) = embedded.filter(|embedded| Some(embedded) != asked.as_ref()) {
        let embedded = clean(&embedded);
        output::remark(&format!(
            "the certificate is about the sampling period {embedded}, and so is the specification in it; where that came \
             from `certify --sampling-period {embedded}`, compare with the same flag"
        ));
    }
}

fn open(path: &Path, help: &'static str) -> Result<Box<dyn Read>, Failure> {
    if path == Path::new("-") {
        return Ok(Box::new(std::io::stdin().lock()));
    }
    let file = File::open(path)
        .map_err(|error| Failure::call(format!("cannot read `{}`: {}", shown(path), reason(&error)), help))?;
    Ok(Box::new(file))
}
