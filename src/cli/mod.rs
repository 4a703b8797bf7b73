//! The command line: flags, files, streams and exit codes. Everything else is the library's.

mod args;
mod bound;
mod certify;
mod check;
mod colour;
mod constants;
mod controller;
mod counts;
mod design;
mod failure;
mod falsify;
mod files;
mod given;
mod input;
mod lyapunov;
mod misuse;
mod output;
mod pages;
mod parameters;
mod progress;
mod reproduce;
mod sampling;
mod simulate;
mod simulate_call;
mod simulate_sampled;
mod stages;
mod subject;
mod sweep;
mod temporary;
mod transfer;
mod tune;
mod write_files;

use args::{Cli, Command, command};
use clap::FromArgMatches;
use output::Format;
use sigmastar::Verdict;
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
    // What comes of the command, and how a failure of it is told: in which format, and whether quietly.
    let (outcome, format, quiet) = match cli.command {
        Command::Certify(args) => (certify::run(&args), args.format, args.quiet),
        Command::Design(args) => (design::run(&args), args.format, args.quiet),
        Command::Sampling(args) => (sampling::run(&args), args.format, args.quiet),
        Command::Sweep(args) => (sweep::run(&args), Format::Text, args.quiet),
        Command::Tune(args) => (tune::run(&args), args.format, args.quiet),
        Command::Transfer(args) => (transfer::run(&args), args.format, args.quiet),
        Command::Check(args) => (check::run(&args), args.format, false),
        Command::Controller(args) => (controller::run(&args), Format::Text, false),
        Command::Simulate(args) => (simulate::run(&args), args.format, args.quiet),
        Command::Reproduce(args) => (reproduce::run(&args), Format::Text, args.quiet),
        Command::Falsify(args) => (falsify::run(&args), args.format, args.quiet),
        Command::Errata(args) => (constants::errata(&args), args.format, false),
        Command::Constants(args) => (constants::run(&args), args.format, args.quiet),
        Command::Lyapunov(args) => (lyapunov::run(&args), args.format, false),
        Command::Bound(args) => (bound::run(&args), Format::Text, args.quiet),
        Command::New(args) => (write_files::new(&args), Format::Text, false),
        Command::Convert(args) => (write_files::convert(&args), Format::Text, false),
        Command::Schema(args) => (Ok(write_files::schema(&args)), Format::Text, false),
        Command::Completions { shell } => (Ok(pages::completions(shell)), Format::Text, false),
        Command::Man => (Ok(pages::man()), Format::Text, false),
    };
    ExitCode::from(outcome.unwrap_or_else(|failure| failure.tell(format, quiet)))
}
