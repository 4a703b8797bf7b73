//! `sigmastar falsify`.

use super::args::{FalsifyArgs, Format, SimulationFormat};
use super::failure::Failure;
use super::input;
use super::output::{self, OutputFile};
use super::progress::Bar;
use sigmastar::certificate::Verdict;
use sigmastar::falsify::{Claim, Finding, Settings, counterexample_plant, falsify, json, text};

/// Runs the command and returns the exit code.
pub fn run(args: &FalsifyArgs) -> u8 {
    attempt(args).unwrap_or_else(|failure| failure.tell(Format::Text, args.quiet))
}

fn attempt(args: &FalsifyArgs) -> Result<u8, Failure> {
    let what = "the counterexample";
    let output = args.output.as_deref().map(|path| OutputFile::new(path, &args.certificate, what)).transpose()?;
    let claim = Claim::from_document(&input::document(&args.certificate)?)?;
    let bar = Bar::new(u64::from(args.trials), args.quiet);
    let settings = Settings { trials: u64::from(args.trials), seed: args.seed };
    let outcome = falsify(&claim, settings, &bar);
    bar.finish();
    if let (Some(file), Some((trial, violation))) = (&output, outcome.counterexample()) {
        file.write(counterexample_plant(&claim, trial, Some(violation))?.text())?;
        if !args.quiet {
            output::remark(&format!(
                "the counterexample is in `{}`; see it with: sigmastar simulate {} --sigma {:?} --n-o {}",
                file.name(),
                file.name(),
                trial.sigma,
                trial.n_o
            ));
        }
    }
    let report = match args.format {
        SimulationFormat::Text => text(&claim, &outcome),
        SimulationFormat::Json => output::json_text(&json(&claim, &outcome)),
    };
    if let Err(code) = output::data(&report) {
        return Ok(code);
    }
    let held = outcome.findings.iter().any(|finding| matches!(finding, Finding::Holds { .. }));
    Ok(match outcome.counterexample() {
        Some(_) => Verdict::Refuted.exit_code(),
        None if held => 0,
        None => Verdict::Undecided.exit_code(),
    })
}
