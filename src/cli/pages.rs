//! Completion scripts and the manual page, made from the table of flags.

use super::args::Cli;
use super::output;
use clap::CommandFactory;
use clap_complete::Shell;

/// Writes the completion script of a shell; returns the exit code.
pub fn completions(shell: Shell) -> u8 {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "sigmastar", &mut script);
    write(&script)
}

/// Writes the manual page, with a part for each command; returns the exit code.
pub fn man() -> u8 {
    let mut command = Cli::command();
    command.build();
    let mut page = Vec::new();
    // Writing to memory cannot fail; an error would leave the page incomplete, which the exit code says.
    let mut complete = clap_mangen::Man::new(command.clone()).render(&mut page).is_ok();
    for part in command.get_subcommands().filter(|part| part.get_name() != "help") {
        complete &= clap_mangen::Man::new(part.clone()).render(&mut page).is_ok();
    }
    let code = write(&page);
    if complete { code } else { 2 }
}

fn write(bytes: &[u8]) -> u8 {
    output::data(&String::from_utf8_lossy(bytes)).map_or_else(|code| code, |()| 0)
}
