//! Flags of the commands for many cases.

use super::Replace;
use crate::cli::counts::one_count;
use crate::cli::output::Format;
use clap::{Args, ValueEnum, ValueHint};
use sigmastar::{RegulatorMatrices, TuneOptions};
use std::path::PathBuf;

/// The flags of `design`.
#[derive(Args, Debug)]
pub struct DesignArgs {
    /// Plant or bounding specification (.json, .jsonc, .toml), or a certificate of one, or `-` for standard input
    #[arg(value_name = "SPEC", value_hint = ValueHint::FilePath)]
    pub spec: PathBuf,

    /// Require |e| of the periodic solution to be at most V
    #[arg(long, value_name = "V")]
    pub steady_error: Option<String>,

    /// Require |e| at all times, from the whole initial set, to be at most V
    #[arg(long, value_name = "V")]
    pub peak_error: Option<String>,

    /// Require |u| at all times, from the whole initial set, to be at most V: the control over `nominal` where the file has `input_gain`,
    /// measured from the middle of the range where its `actuator` has two limits
    #[arg(long, value_name = "V")]
    pub max_control: Option<String>,

    /// Require |e| to be at most the required steady error for good after so many periods; at samples at the sampling instants
    #[arg(long, value_name = "PERIODS", requires = "steady_error")]
    pub settle: Option<String>,

    /// Require the error that the noise, disturbance and rounding of the document cause in the limit to be at most V
    #[arg(long, value_name = "V")]
    pub noise: Option<String>,

    /// Numbers of oscillators of the table, 8 at most: `0,2,4` or a range `0..6` (default: 0,1,2,3,5)
    #[arg(long, value_name = "LIST")]
    pub n_o: Option<String>,

    /// Gains of the table, 20 at most, in the place of the smallest one that is found and multiples of it
    #[arg(long, value_name = "LIST")]
    pub sigma: Option<String>,

    /// Take the regulator at samples that are H apart, of which the period is a whole multiple
    #[arg(long, value_name = "H")]
    pub sampling_period: Option<String>,

    /// Also show, for each gain, the longest sampling period that is certified with it
    #[arg(long, conflicts_with = "sampling_period")]
    pub sampling_periods: bool,

    /// Choose these numbers of the file: mu, n0, epsilon and others, as `tune --over` names them, each with a range if wanted, `mu=1/10..10`; a
    /// table is made of the values of the file and of four others of each number in turn, and the best one is shown (usual range of mu, with the
    /// period T: 1/T..8/T)
    #[arg(long, value_name = "LIST")]
    pub choose: Option<String>,

    /// Leave the simulations beside the proved numbers out
    #[arg(long)]
    pub no_simulation: bool,

    /// Tell on standard error which gains and values are proved next, a line for each
    #[arg(long, conflicts_with = "quiet")]
    pub progress: bool,

    /// Format of the report
    #[arg(long, value_enum, value_name = "NAME", default_value_t = Format::Text)]
    pub format: Format,

    /// Write the certificate of the gain to take to this file
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,

    #[command(flatten)]
    pub replace: Replace,

    /// No progress and no remarks on standard error; errors are still shown
    #[arg(short, long)]
    pub quiet: bool,
}

/// The flags of `sweep`.
#[derive(Args, Debug)]
pub struct SweepArgs {
    /// Study (.json, .jsonc, .toml), or `-` for standard input; its subject may be a certificate
    #[arg(value_name = "STUDY", value_hint = ValueHint::FilePath)]
    pub study: PathBuf,

    /// Write the table of results to this file (CSV)
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath, required_unless_present = "case")]
    pub output: Option<PathBuf>,

    /// Draw sigma* over the one parameter of a grid, or over the first of two, as SVG, into this file
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub plot: Option<PathBuf>,

    #[command(flatten)]
    pub replace: Replace,

    /// Say which case is the best
    #[arg(long, value_enum, value_name = "NAME")]
    pub minimise: Option<Minimised>,

    /// Write the specification or plant of this case to standard output and do nothing else
    #[arg(long, value_name = "INDEX", conflicts_with_all = ["output", "plot", "minimise", "force"])]
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

/// The flags of `tune`.
#[derive(Args, Debug)]
pub struct TuneArgs {
    /// Bounding specification or plant (.json, .jsonc, .toml), or a certificate of one, or `-` for standard input
    #[arg(value_name = "SPEC", value_hint = ValueHint::FilePath)]
    pub spec: PathBuf,

    /// The free numbers, separated by commas: mu, n0, epsilon; of listed weights n0, n1, ..., coefficient, exponent;
    /// base_frequency where it is not matched; each may have a range, `mu=1/10..10`
    #[arg(long, value_name = "LIST", default_value = "mu,n0", allow_hyphen_values = true)]
    pub over: String,

    /// What is to be as small as possible
    #[arg(long, value_enum, value_name = "NAME", default_value_t = TuneGoal::SigmaStar)]
    pub minimise: TuneGoal,

    /// Make the certified bound of sup|e| with N oscillators, at sigma*, as small as possible instead
    #[arg(long, value_name = "N", conflicts_with = "minimise", value_parser = one_count(RegulatorMatrices::MAX_OSCILLATORS))]
    pub error_at: Option<u32>,

    /// Certify at most so many proposals, the values of the file among them
    #[arg(long, value_name = "N", default_value_t = 120, value_parser = clap::value_parser!(u32).range(2..=i64::from(TuneOptions::MOST_TRIES)))]
    pub tries: u32,

    /// Format of the report
    #[arg(long, value_enum, value_name = "NAME", default_value_t = Format::Text)]
    pub format: Format,

    /// Write the specification or plant with the tuned numbers to this file, where they are better
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,

    #[command(flatten)]
    pub replace: Replace,

    /// No progress and no remarks on standard error; errors are still shown
    #[arg(short, long)]
    pub quiet: bool,
}

/// What a tuning makes small.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TuneGoal {
    /// The certified gain
    #[value(name = "sigma_star")]
    SigmaStar,
    /// sigma* + mu Nbar^2, the largest factor by which the law multiplies e
    Feedback,
}
