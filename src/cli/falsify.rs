//! `sigmastar falsify`.

use super::args::FalsifyArgs;
use super::failure::Failure;
use super::files::Input;
use super::output::Shortened;
use super::progress::Bar;
use super::{input, output, parameters};
use sigmastar::program::{Attempt, TrialSettings};
use sigmastar::{FalsificationOutcome, Verdict};

/// Runs the command and returns the exit code.
pub fn run(args: &FalsifyArgs) -> Result<u8, Failure> {
    let input = Input::Certificate(&args.certificate);
    let output = args.replace.asked(args.output.as_deref(), input, "the counterexample")?;
    let others: Vec<_> =
        args.base_frequency.iter().map(|text| input::positive("--base-frequency", text)).collect::<Result<_, _>>()?;
    let attempt = Attempt::new(&input::written(&args.certificate)?)?;
    let attempt = attempt.with_parameters(&parameters::rational(&args.parameter)?)?.with_base_frequencies(&others)?;
    let attempt = attempt.with_oscillators(&args.harmonics)?;
    let only = args.trial.map(u64::from);
    let settings = TrialSettings { trials: u64::from(args.trials), seed: args.seed, only };
    let trials = if only.is_some() { 1 } else { settings.trials };
    let bar = Bar::new(trials * (1 + others.len() as u64), args.quiet);
    let found = attempt.run(settings, &bar)?;
    bar.finish();
    if let (Some(file), Some(trial)) = (&output, found.trial()) {
        file.write(&trial.text)?;
        if !args.quiet {
            let what = if trial.broken { "counterexample" } else { "plant" };
            output::remark(&format!(
                "the {what} is in `{}`; see it with: sigmastar simulate {} {}",
                file.name(),
                file.name(),
                trial.flags
            ));
        }
    }
    if let Err(code) = Shortened::new(found.report(), args.format, args.full).show(args.quiet) {
        return Ok(code);
    }
    Ok(match found.outcome() {
        FalsificationOutcome::Broken => Verdict::Refuted.exit_code(),
        FalsificationOutcome::Held => 0,
        _ => Verdict::Undecided.exit_code(),
    })
}
