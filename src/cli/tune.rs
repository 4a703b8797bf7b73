//! `sigmastar tune`.

use super::args::{TuneArgs, TuneGoal};
use super::failure::Failure;
use super::files::Input;
use super::output;
use super::output::shown;
use super::progress::Bar;
use super::subject::{Asked, Subject};
use sigmastar_lang::spec::Notation;
use sigmastar_prove::certify::Verdict;
use sigmastar_studies::tune::{Goal, Settings, TuneError, TuningReport, parameters, tune};

/// The number of oscillators for which the error is told where the call names none.
const N_O: u32 = 5;

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
    let subject = Subject::read(&document)?;
    let (name, sha256, model) = match &subject {
        Subject::Specification(spec) => (&spec.name, &spec.sha256, &spec.internal_model),
        Subject::Plant(plant) => (&plant.name, &plant.sha256, &plant.internal_model),
    };
    let goal = match (args.error_at, args.minimise) {
        (Some(n_o), _) => Goal::Error(u64::from(n_o)),
        (None, TuneGoal::SigmaStar) => Goal::Sigma,
        (None, TuneGoal::Feedback) => Goal::Feedback,
    };
    goal.fits(&subject).map_err(|error| wrong(&error))?;
    let parameters = parameters(&args.over, &document, model).map_err(|error| wrong(&error))?;
    let settings = Settings { goal, n_o: u64::from(args.error_at.unwrap_or(N_O)), tries: args.tries };
    let bar = Bar::new(u64::from(args.tries), args.quiet);
    let tuning = tune(&document, parameters, settings, &bar)?;
    bar.finish();
    let text = output::report(&TuningReport { tuning: &tuning, name, sha256 }, args.format);
    if let Some(file) = &file {
        match &tuning.after {
            Some((_, tuned)) => {
                file.write(tuned.text())?;
                if !args.quiet {
                    let name = file.name();
                    output::remark(&format!("the tuned specification is in `{name}`: sigmastar certify {name}"));
                }
            }
            None => output::remark(&format!("`{}` was not written: nothing better was found", file.name())),
        }
    }
    let verdict = if tuning.has_claim() { Verdict::Certified } else { Verdict::Undecided };
    Ok(output::data(&text).err().unwrap_or(verdict.exit_code()))
}

fn wrong(error: &TuneError) -> Failure {
    Failure::call(error.to_string(), error.way_out())
}
