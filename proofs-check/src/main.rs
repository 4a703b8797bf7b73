//! `proofs-check CERT.json [--verbose] [--format text|json]`: exit code 0 valid, 1 invalid, 2 bad-input, 3 undecided.

use std::io::Write;
use std::process::ExitCode;

const USAGE: &str = "usage: proofs-check CERT.json [--verbose] [--format text|json]";

fn main() -> ExitCode {
    let (mut path, mut verbose, mut json) = (None, false, false);
    let mut arguments = std::env::args_os().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.to_str() {
            Some("--verbose" | "-v") => verbose = true,
            Some("--format") => match arguments.next().as_deref().and_then(|format| format.to_str()) {
                Some(format @ ("text" | "json")) => json = format == "json",
                _ => return wrong_call("--format takes text or json"),
            },
            Some("--help" | "-h") => {
                println!("{USAGE}\n\nexit codes: 0 valid, 1 invalid, 2 bad-input, 3 undecided");
                return ExitCode::SUCCESS;
            }
            Some(flag) if flag.starts_with("--") => return wrong_call(&format!("unknown flag {flag}")),
            _ if path.is_some() => return wrong_call("one certificate at a time"),
            _ => path = Some(argument),
        }
    }
    let Some(path) = path else { return wrong_call("no certificate is named") };
    let report = match std::fs::File::open(&path).and_then(proofs_check::check_reader) {
        Ok(report) => report,
        Err(error) => return wrong_call(&format!("cannot read {}: {error}", path.display())),
    };
    let text = if json { format!("{:#}\n", report.json()) } else { report.text(verbose) };
    // A closed stream is no reason to fail differently.
    let _ = std::io::stdout().write_all(text.as_bytes());
    ExitCode::from(report.verdict.exit_code())
}

fn wrong_call(message: &str) -> ExitCode {
    eprintln!("proofs-check: {message}\n{USAGE}");
    ExitCode::from(2)
}
