//! `proofs-check CERT.json [--spec SPEC.json] [--verbose] [--format text|json]`: exit code 0 valid, 1 invalid, 2 bad-input,
//! 3 undecided. `proofs-check --coq CERT.json`: the certificate as a Coq theorem; 0 written, 1 invalid data, 2 bad-input,
//! 3 no theorem of its kind.

use proofs_check::verdict::{Verdict, escaped};
use std::ffi::OsString;
use std::fs::File;
use std::io::{Read, Write};
use std::path::Path;
use std::process::ExitCode;

const USAGE: &str = "usage: proofs-check CERT.json [--spec SPEC.json] [--verbose] [--format text|json]
       proofs-check --coq CERT.json";

const HELP: &str = "
Decides the claim of a certificate again, and says what it is about and what it takes for granted.

  --spec SPEC.json     the certificate must be about the data of this specification, else it is invalid
  --verbose            the argument, line by line
  --format text|json   the form of the answer
  --coq                decides nothing, and writes the certificate as a theorem for Coq, which decides it with the proofs in
                       proofs-check/coq: `proofs-check --coq CERT.json > cert.v`, then
                       `coqc -Q proofs-check/coq SigmaStar cert.v`

exit codes: 0 valid, 1 invalid, 2 bad-input, 3 undecided;
with --coq: 0 written, 1 invalid data, 2 bad-input, 3 no theorem is written of a certificate of this kind";

fn main() -> ExitCode {
    let (mut path, mut spec, mut verbose, mut json): (Option<OsString>, Option<OsString>, _, _) =
        (None, None, false, None);
    let mut coq = false;
    let mut arguments = std::env::args_os().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.to_str() {
            Some("--verbose" | "-v") => verbose = true,
            Some("--format") => match arguments.next().as_deref().and_then(|format| format.to_str()) {
                Some(format @ ("text" | "json")) => json = Some(format == "json"),
                _ => return wrong_call("--format takes text or json"),
            },
            Some("--coq") => coq = true,
            Some("--spec") => match arguments.next() {
                Some(file) => spec = Some(file),
                None => return wrong_call("--spec takes a specification file"),
            },
            Some("--help" | "-h") => {
                println!("{USAGE}\n{HELP}");
                return ExitCode::SUCCESS;
            }
            Some(flag) if flag.starts_with('-') => return wrong_call(&format!("unknown flag {flag}")),
            _ if path.is_some() => return wrong_call("one certificate at a time"),
            _ => path = Some(argument),
        }
    }
    let Some(path) = path else { return wrong_call("no certificate is named") };
    let open = |path: &OsString| {
        File::open(path).map_err(|error| format!("cannot read {}: {error}", Path::new(path).display()))
    };
    if coq {
        if spec.is_some() || verbose || json.is_some() {
            return wrong_call("--coq goes with no other flag");
        }
        return match open(&path) {
            Ok(mut certificate) => write_theorem(&mut certificate),
            Err(message) => wrong_call(&message),
        };
    }
    let named = [Some(&path), spec.as_ref()].into_iter().flatten();
    let other_notation =
        named.map(Path::new).find(|path| path.extension().is_some_and(|end| end == "toml" || end == "jsonc"));
    let read = open(&path).and_then(|mut certificate| {
        let mut specification = spec.as_ref().map(open).transpose()?;
        let specification = specification.as_mut().map(|file| file as &mut dyn Read);
        proofs_check::check_reader(&mut certificate, specification).map_err(|error| format!("cannot read: {error}"))
    });
    let report = match read {
        Ok(report) => report,
        Err(message) => return wrong_call(&message),
    };
    if let Some(path) = other_notation.filter(|_| report.verdict == Verdict::BadInput) {
        tell_notation(path);
    }
    let text = if json == Some(true) { format!("{:#}\n", report.json()) } else { report.text(verbose) };
    // A closed stream is no reason to fail differently.
    let _ = std::io::stdout().write_all(text.as_bytes());
    ExitCode::from(report.verdict.exit_code())
}

/// Says what makes JSON of a file whose name is that of another notation: JSON alone is read.
fn tell_notation(path: &Path) {
    let path = escaped(&path.display().to_string());
    eprintln!(
        "proofs-check: JSON alone is read: `sigmastar convert {path} -o FILE.json` writes a specification or plant as that, for --spec; its certificate is \
         what `sigmastar certify {path} -o CERTIFICATE` writes"
    );
}

/// Writes the theorem to the output, or why there is none to the errors.
fn write_theorem(certificate: &mut dyn Read) -> ExitCode {
    match proofs_check::coq::theorem_of(certificate) {
        Err(error) => wrong_call(&format!("cannot read: {error}")),
        Ok(Ok(text)) => {
            let _ = std::io::stdout().write_all(text.as_bytes());
            ExitCode::SUCCESS
        }
        Ok(Err(finding)) => {
            let [pointer, message] = [&finding.pointer, &finding.message].map(|text| escaped(text));
            eprintln!("proofs-check: {}: {pointer}: {message}", finding.verdict);
            ExitCode::from(finding.verdict.exit_code())
        }
    }
}

fn wrong_call(message: &str) -> ExitCode {
    eprintln!("proofs-check: {message}\n{USAGE}");
    ExitCode::from(2)
}
