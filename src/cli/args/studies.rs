//! Flags of the commands for many cases.

use clap::{Args, ValueEnum, ValueHint};
use std::path::PathBuf;

/// The flags of `sweep`.
#[derive(Args, Debug)]
pub struct SweepArgs {
    /// Study (.json, .jsonc, .toml), or `-` for standard input
    #[arg(value_name = "STUDY", value_hint = ValueHint::FilePath)]
    pub study: PathBuf,

    /// Write the results to this file (JSON Lines); what is in it already is not computed again
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath, required_unless_present = "case")]
    pub output: Option<PathBuf>,

    /// Also write a table (CSV)
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub csv: Option<PathBuf>,

    /// Draw sigma* over the one parameter of a grid, or over the first of two, as SVG, into this file
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub plot: Option<PathBuf>,

    /// Say which case is the best
    #[arg(long, value_enum, value_name = "NAME")]
    pub minimise: Option<Minimised>,

    /// Only every N-th case, from the I-th on: part I of N
    #[arg(long, value_name = "I/N")]
    pub shard: Option<String>,

    /// Write the specification or plant of this case to standard output and do nothing else
    #[arg(long, value_name = "INDEX", conflicts_with_all = ["output", "csv", "plot", "minimise", "shard"])]
    pub case: Option<u64>,

    /// No progress and no remarks on standard error; errors are still shown
    #[arg(short, long)]
    pub quiet: bool,
}

/// What the best case has the least of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Minimised {
    /// The certified gain
    #[value(name = "sigma_star")]
    SigmaStar,
}

/// The flags of `merge`.
#[derive(Args, Debug)]
pub struct MergeArgs {
    /// Files of results of one study
    #[arg(value_name = "FILES", required = true, value_hint = ValueHint::FilePath)]
    pub files: Vec<PathBuf>,

    /// Write the joined results to this file
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: PathBuf,

    /// Join them although cases are missing; `sweep -o` with this file computes the rest
    #[arg(long)]
    pub incomplete: bool,
}
