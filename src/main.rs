//! The command line of `sigmastar`.

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::run()
}
