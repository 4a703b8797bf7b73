//! Words that people try on the command line, and what is meant by them here.

use super::args::command;
use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue};
use std::ffi::OsString;

/// A flag that other programs have, and that of the same meaning, of the commands that have it.
const FLAG: (&str, &str) = ("--gain", "sigma");

/// A command that there is not, and what there is.
const COMMAND: (&str, &str) =
    ("report", "`certify` shows a report; `--full` shows all of it, `--format html` writes a page");

/// The error about a call, with the word that was meant in the place of one that is only spelt like it.
pub fn with_advice(mut error: clap::Error, arguments: impl IntoIterator<Item = OsString>) -> clap::Error {
    let is = |kind: ContextKind, word: &str| error.get(kind) == Some(&ContextValue::String(word.to_owned()));
    if is(ContextKind::InvalidArg, FLAG.0) && has_flag(arguments, FLAG.1) {
        error.remove(ContextKind::Suggested);
        error.insert(ContextKind::SuggestedArg, ContextValue::String(format!("--{}", FLAG.1)));
    } else if is(ContextKind::InvalidSubcommand, COMMAND.0) {
        error.remove(ContextKind::SuggestedSubcommand);
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![StyledStr::from(COMMAND.1)]));
    }
    error
}

/// Whether the command that is called has this flag.
fn has_flag(arguments: impl IntoIterator<Item = OsString>, flag: &str) -> bool {
    let commands = command();
    let called = arguments.into_iter().find_map(|word| commands.find_subcommand(word));
    called.is_some_and(|called| called.get_arguments().any(|argument| argument.get_long() == Some(flag)))
}
