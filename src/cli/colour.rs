//! Whether diagnostics have colours. Nothing is said by a colour alone.

use clap::{ColorChoice, ValueEnum};
use std::ffi::OsString;
use std::io::{self, IsTerminal};
use std::sync::OnceLock;

/// What the call says; `auto` until it is read.
static CHOICE: OnceLock<ColorChoice> = OnceLock::new();

/// Takes the choice of a call, once.
pub fn choose(choice: ColorChoice) {
    // There is one call in a process.
    let _ = CHOICE.set(choice);
}

/// The choice in the arguments of a call that was not understood, so that its error is told in the colours asked for.
pub fn in_arguments(arguments: impl IntoIterator<Item = OsString>) -> ColorChoice {
    let read = |text: &str| ColorChoice::from_str(text, false).ok();
    let mut found = None;
    let mut after_flag = false;
    for argument in arguments {
        let argument = argument.to_string_lossy();
        if argument == "--" {
            break;
        }
        if after_flag {
            found = read(&argument).or(found);
        }
        after_flag = argument == "--color";
        found = argument.strip_prefix("--color=").and_then(read).or(found);
    }
    found.unwrap_or_default()
}

/// Whether standard error is written to in colour. Without a word from the call: where it is a terminal that can show it, and
/// `NO_COLOR` is unset or empty.
pub fn on_stderr() -> bool {
    let set = |name| std::env::var_os(name).filter(|value| !value.is_empty());
    match CHOICE.get().copied().unwrap_or_default() {
        ColorChoice::Always => true,
        ColorChoice::Never => false,
        ColorChoice::Auto => {
            io::stderr().is_terminal() && set("NO_COLOR").is_none() && set("TERM").is_none_or(|term| term != "dumb")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_choice_is_found_in_a_call_that_is_wrong_otherwise() {
        let choice = |line: &str| in_arguments(line.split(' ').map(OsString::from));
        assert_eq!(choice("certify --wrong --color always"), ColorChoice::Always);
        assert_eq!(choice("--color=never certify"), ColorChoice::Never);
        for line in ["certify a", "certify --color", "certify --color red", "certify -- --color always"] {
            assert_eq!(choice(line), ColorChoice::Auto, "{line}");
        }
    }
}
