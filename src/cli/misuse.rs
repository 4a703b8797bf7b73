//! Words that people try on the command line, and what is meant by them here.

use super::args::command;
use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use std::ffi::OsString;

/// A flag that other programs have, and that of the same meaning, of the commands that have it.
const FLAG: (&str, &str) = ("--gain", "sigma");

/// Names of fields that are tried as flags, and what the file has for them.
const FIELDS: [(&str, &str); 9] = [
    ("--mu", "`internal_model.mu`"),
    ("--base-frequency", "`internal_model.base_frequency`"),
    ("--period", "`period`"),
    ("--parameter", "`parameters`"),
    ("--parameters", "`parameters`"),
    ("--input-gain", "`input_gain`"),
    ("--measurement", "`measurement`"),
    ("--noise", "`measurement.noise`"),
    ("--disturbance", "`disturbance`"),
];

/// Where a study runs on more machines than one.
const MACHINES: &str =
    "a study on several machines is run from Python: `sigmastar.run_case` and `sigmastar.write_results`";

/// Commands that there are not, and what there is.
const COMMANDS: [(&str, &str); 4] = [
    (
        "verify",
        "did you mean `check`? It decides a certificate again; `certify` makes one from a plant or a specification",
    ),
    ("report", "`certify` shows a report; `--full` shows all of it, `--format html` writes a page"),
    ("merge", MACHINES),
    ("rate", "`certify --n-o LIST` proves rates, with `--sigma V` at a larger gain"),
];

/// Flags that another one needs, as errors show them, and what for.
const NEEDED: [(&str, &str); 2] = [
    (
        "--steady-error <V>",
        "--settle says after how many periods |e| stays at most the required steady error: add `--steady-error V` with that error",
    ),
    ("--n-o <LIST>", "--rate is about given numbers of oscillators: add them, as `--n-o 0,4`"),
];

/// A flag that there is not, and what there is.
const SHARD: (&str, &str) = ("--shard", MACHINES);

/// The error about a call, with the word that was meant in the place of one that is only spelt like it.
pub fn with_advice(mut error: clap::Error, arguments: impl IntoIterator<Item = OsString>) -> clap::Error {
    let is = |kind: ContextKind, word: &str| error.get(kind) == Some(&ContextValue::String(word.to_owned()));
    let unknown = error.kind() == ErrorKind::UnknownArgument;
    let command = COMMANDS.iter().find(|(name, _)| is(ContextKind::InvalidSubcommand, name));
    let field = FIELDS.iter().find(|(flag, _)| unknown && is(ContextKind::InvalidArg, flag));
    let needed = NEEDED.iter().find(|(flag, _)| {
        let missing = error.get(ContextKind::InvalidArg).filter(|_| error.kind() == ErrorKind::MissingRequiredArgument);
        matches!(missing, Some(ContextValue::Strings(flags)) if flags.iter().any(|one| one == flag))
    });
    if let Some((_, advice)) = needed {
        suggest(&mut error, (*advice).to_owned());
    } else if is(ContextKind::InvalidArg, FLAG.0) && has_flag(arguments, FLAG.1) {
        error.remove(ContextKind::Suggested);
        error.insert(ContextKind::SuggestedArg, ContextValue::String(format!("--{}", FLAG.1)));
    } else if let Some((_, field)) = field {
        suggest(&mut error, format!("it is a field of the file: {field}"));
    } else if unknown && is(ContextKind::InvalidArg, SHARD.0) {
        suggest(&mut error, SHARD.1.to_owned());
    } else if let Some(commands) = commands_with(&error).filter(|_| unknown) {
        suggest(&mut error, format!("it is a flag of {commands}"));
    } else if let Some((_, words)) = command {
        error.remove(ContextKind::SuggestedSubcommand);
        suggest(&mut error, (*words).to_owned());
    }
    error
}

/// Says this in the place of a word that is spelt alike.
fn suggest(error: &mut clap::Error, what: String) {
    error.remove(ContextKind::SuggestedArg);
    error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![StyledStr::from(what)]));
}

/// The commands that have the flag which the called one has not.
fn commands_with(error: &clap::Error) -> Option<String> {
    let Some(ContextValue::String(flag)) = error.get(ContextKind::InvalidArg) else { return None };
    let name = flag.strip_prefix("--")?;
    let commands = command();
    let having =
        commands.get_subcommands().filter(|command| command.get_arguments().any(|one| one.get_long() == Some(name)));
    let named: Vec<String> = having.map(|command| format!("`{}`", command.get_name())).collect();
    (!named.is_empty()).then(|| named.join(", "))
}

/// Whether the command that is called has this flag.
fn has_flag(arguments: impl IntoIterator<Item = OsString>, flag: &str) -> bool {
    let commands = command();
    let called = arguments.into_iter().find_map(|word| commands.find_subcommand(word));
    called.is_some_and(|called| called.get_arguments().any(|argument| argument.get_long() == Some(flag)))
}
