//! `sigmastar falsify`.

use super::args::FalsifyArgs;
use super::failure::Failure;
use super::files::Input;
use super::output::Shortened;
use super::progress::Bar;
use super::{input, output, parameters};
use sigmastar_lab::falsify::{
    Falsification, FalsificationReport, FrequencyError, TrialSettings, TriedClaim, counterexample_plant, falsify,
    flags, with_base_frequency,
};
use sigmastar_prove::certify::Verdict;

/// Runs the command and returns the exit code.
pub fn run(args: &FalsifyArgs) -> Result<u8, Failure> {
    let input = Input::Certificate(&args.certificate);
    let output = args.replace.asked(args.output.as_deref(), input, "the counterexample")?;
    let others: Vec<_> =
        args.base_frequency.iter().map(|text| input::positive("--base-frequency", text)).collect::<Result<_, _>>()?;
    let claim = TriedClaim::from_document(&input::written(&args.certificate)?)?;
    let claim = claim.with_parameters(&parameters::rational(&args.parameter)?).map_err(|error| {
        let help = error.help();
        Failure::call(error.to_string(), help)
    })?;
    let mut claims = vec![claim];
    if claims[0].sampled.is_some() && !others.is_empty() {
        let message = "the law at samples is certified for the base frequency 2 pi/period alone";
        return Err(Failure::call(message, "leave --base-frequency out"));
    }
    for frequency in &others {
        let claim = with_base_frequency(&claims[0], frequency).map_err(|error| match error {
            FrequencyError::Specification(errors) => Failure::from(errors),
            error @ FrequencyError::NotCertified { .. } => {
                Failure::call(error.to_string(), "see why with `certify`, or leave this base frequency out")
            }
        })?;
        claims.push(claim);
    }
    let only = args.trial.map(u64::from);
    let settings = TrialSettings { trials: u64::from(args.trials), seed: args.seed, only };
    let trials = if only.is_some() { 1 } else { settings.trials };
    let bar = Bar::new(trials * claims.len() as u64, args.quiet);
    let outcomes: Vec<(TriedClaim, Falsification)> = claims
        .into_iter()
        .map(|claim| {
            let outcome = falsify(&claim, settings, &bar);
            (claim, outcome)
        })
        .collect();
    bar.finish();
    let broken = outcomes.iter().find_map(|(claim, outcome)| Some((claim, outcome.counterexample()?)));
    let written = broken.map(|(claim, (trial, violation))| (claim, trial, Some(violation)));
    let asked = || outcomes.iter().find_map(|(claim, outcome)| Some((claim, outcome.worst()?.trial, None)));
    let written = written.or_else(|| only.and_then(|_| asked()));
    if let (Some(file), Some((claim, trial, violation))) = (&output, written) {
        file.write(counterexample_plant(claim, trial, violation)?.text())?;
        if !args.quiet {
            let what = if violation.is_some() { "counterexample" } else { "plant" };
            output::remark(&format!(
                "the {what} is in `{}`; see it with: sigmastar simulate {} {}",
                file.name(),
                file.name(),
                flags(claim, trial)
            ));
        }
    }
    let report = FalsificationReport { tried: &outcomes };
    if let Err(code) = Shortened::new(&report, args.format, args.full).show(args.quiet) {
        return Ok(code);
    }
    Ok(match broken {
        Some(_) => Verdict::Refuted.exit_code(),
        None if outcomes.iter().all(|(_, outcome)| outcome.has_held()) => 0,
        None => Verdict::Undecided.exit_code(),
    })
}
