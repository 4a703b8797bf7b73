//! The command line: flags, files, streams and exit codes. Everything else is the library's.

mod args;
mod bound;
mod certify;
mod check;
mod colour;
mod controller;
mod counts;
mod edge;
mod errata;
mod failure;
mod falsify;
mod files;
mod format;
mod given;
mod input;
mod lyapunov;
mod merge;
mod misuse;
mod output;
mod pages;
mod parameters;
mod progress;
mod rate;
mod reproduce;
mod sampling;
mod simulate;
mod simulate_call;
mod simulate_gain;
mod simulate_sampled;
mod stages;
mod stored;
mod subject;
mod sweep;
mod temporary;
mod transfer;
mod tune;
mod write_files;

use args::{Cli, Command, command};
use clap::FromArgMatches;
use sigmastar_prove::certify::Verdict;
use std::process::ExitCode;

/// Runs the command of the process's arguments and returns its exit code.
pub fn run() -> ExitCode {
    let parsed = command().try_get_matches().and_then(|matches| Cli::from_arg_matches(&matches));
    let cli = match parsed {
        Ok(cli) => cli,
        Err(error) => {
            let choice = colour::in_arguments(std::env::args_os().skip(1));
            let error = misuse::with_advice(error, std::env::args_os().skip(1));
            let error = error.format(&mut command().color(choice));
            // A closed stream is no reason to fail differently.
            let _ = error.print();
            let asked = !error.use_stderr();
            return ExitCode::from(if asked { 0 } else { Verdict::BadInput.exit_code() });
        }
    };
    colour::choose(cli.color);
    let code = match cli.command {
        Command::Certify(args) => certify::run(&args),
        Command::Sampling(args) => sampling::run(&args),
        Command::Sweep(args) => sweep::run(&args),
        Command::Merge(args) => merge::run(&args),
        Command::Tune(args) => tune::run(&args),
        Command::Transfer(args) => transfer::run(&args),
        Command::Check(args) => check::run(&args),
        Command::Controller(args) => controller::run(&args),
        Command::Simulate(args) => simulate::run(&args),
        Command::Reproduce(args) => reproduce::run(&args),
        Command::Falsify(args) => falsify::run(&args),
        Command::Errata(args) => errata::run(&args),
        Command::Lyapunov(args) => lyapunov::run(&args),
        Command::Bound(args) => bound::run(&args),
        Command::Rate(args) => rate::run(&args),
        Command::New(args) => write_files::new(&args),
        Command::Convert(args) => write_files::convert(&args),
        Command::Schema(args) => write_files::schema(&args),
        Command::Completions { shell } => pages::completions(shell),
        Command::Man => pages::man(),
    };
    ExitCode::from(code)
}
