//! `sigmastar tune`.

use super::args::{TuneArgs, TuneGoal as Minimised};
use super::failure::Failure;
use super::files::Input;
use super::output::{self, shown};
use super::progress::Bar;
use super::subject::{Asked, Subject};
use sigmastar::program::tune_watched;
use sigmastar::{TuneGoal, TuneOptions, Verdict};
use sigmastar_lang::spec::Notation;

/// Runs the command and returns the exit code.
pub fn run(args: &TuneArgs) -> Result<u8, Failure> {
    let file =
        args.replace.asked(args.output.as_deref(), Input::Specification(&args.spec), "the tuned specification")?;
    let Asked { document, .. } = Asked::read(&args.spec)?;
    if let Some(path) = args.output.as_deref().filter(|path| !document.notation().is_part_of(Notation::of(path))) {
        let message =
            format!("`{}` would be read in another notation than `{}` is written in", shown(path), document.label());
        return Err(Failure::call(message, "give it a name with the same ending: all but the numbers stays as it is"));
    }
    let goal = match (args.error_at, args.minimise) {
        (Some(n_o), _) => TuneGoal::ErrorAt(n_o),
        (None, Minimised::SigmaStar) => TuneGoal::SigmaStar,
        (None, Minimised::Feedback) => TuneGoal::Feedback,
    };
    let options = TuneOptions::new().over(&args.over).goal(goal).tries(args.tries);
    let bar = Bar::new(u64::from(args.tries), args.quiet);
    let tuned = tune_watched((&Subject::read(&document)?, &document), &options, &bar)?;
    bar.finish();
    let text = output::report(tuned.report(), args.format);
    if let Some(file) = &file {
        match tuned.text() {
            Some(text) => {
                file.write(text)?;
                if !args.quiet {
                    let name = file.name();
                    output::remark(&format!("the tuned specification is in `{name}`: sigmastar certify {name}"));
                }
            }
            None => output::remark(&format!("`{}` was not written: nothing better was found", file.name())),
        }
    }
    let verdict = if tuned.has_claim() { Verdict::Certified } else { Verdict::Undecided };
    Ok(output::data(&text).err().unwrap_or(verdict.exit_code()))
}
