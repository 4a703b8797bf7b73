//! Flags of the commands for many cases.

use super::Replace;
use crate::cli::counts::{harmonics, one_count};
use crate::cli::output::Format;
use clap::{Args, ValueEnum, ValueHint};
use sigmastar::{RegulatorMatrices, TuneOptions};
use sigmastar_lang::spec::Oscillators;
use sigmastar_prove::rate::bound::MAX_OSCILLATORS;
use std::path::PathBuf;

/// The flags of `design`.
#[derive(Args, Debug)]
pub struct DesignArgs {
    /// Plant or bounding specification (.json, .jsonc, .toml), or a certificate of one, or `-` for standard input
    #[arg(value_name = "SPEC", value_hint = ValueHint::FilePath)]
    pub spec: PathBuf,

    /// Require |e| to be at most V along the periodic solution, with noise in the limit
    #[arg(long, value_name = "V")]
    pub steady_error: Option<String>,

    /// Require |e| to be at most V at all times from the initial set
    #[arg(long, value_name = "V")]
    pub peak_error: Option<String>,

    /// Require |u| to be at most V at all times from the initial set. Here u is the output of the regulator: with `input_gain` the control
    /// divided by `nominal`. If `actuator` has two limits, u is measured from the middle of its range
    #[arg(long, value_name = "V")]
    pub max_control: Option<String>,

    /// Require that |e| stays at most the V of --steady-error after so many periods (a time divided by the period). With a sampling period this
    /// is about the sampling instants
    #[arg(long, value_name = "PERIODS", requires = "steady_error")]
    pub settle: Option<String>,

    /// Require |e - e_per| to be at most V in the limit, with the noise, disturbance and rounding that the file states
    #[arg(long, value_name = "V")]
    pub noise: Option<String>,

    /// Numbers of oscillators in the table, 8 at most: a list `0,2,4` or a range `0..6` [default: 0,1,2,3,5]
    #[arg(long, value_name = "LIST")]
    pub n_o: Option<String>,

    /// Add oscillators at these harmonics to the table, such as `0,1,5,7`; repeat the flag for several sets. The claims are then about every
    /// finite set of harmonics that contains 0: the flag sets or replaces `harmonics` of the internal model
    #[arg(long, value_name = "LIST", value_parser = harmonics(MAX_OSCILLATORS, MAX_OSCILLATORS))]
    pub harmonics: Vec<Oscillators>,

    /// Gains in the table, 20 at most [default: the smallest gain found, and multiples of it]
    #[arg(long, value_name = "LIST")]
    pub sigma: Option<String>,

    /// Take the regulator with the sampling period H; the period must be a whole multiple of H
    #[arg(long, value_name = "H")]
    pub sampling_period: Option<String>,

    /// Also show, for each gain, the longest sampling period that is certified with it
    #[arg(long, conflicts_with = "sampling_period")]
    pub sampling_periods: bool,

    /// Choose values of these numbers of the file: mu, n0, epsilon and others, as `tune --over` names them. A name may have a range, as in
    /// `mu=1/10..10`; that of mu is 1/T..8/T by default, with the period T, around the usual 3/T to 5/T. The numbers are chosen one after the other. Each time a table is made
    /// for the value of the file and for four others. The report shows the best table
    #[arg(long, value_name = "LIST")]
    pub choose: Option<String>,

    /// Leave out the simulations that are shown beside the proved numbers
    #[arg(long)]
    pub no_simulation: bool,

    /// Show on standard error which gain or value is proved next, one a line
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

    /// Certify at most so many proposals; the values of the file count as one
    #[arg(long, value_name = "N", default_value_t = 120, value_parser = clap::value_parser!(u32).range(2..=i64::from(TuneOptions::MOST_TRIES)))]
    pub tries: u32,

    /// Format of the report
    #[arg(long, value_enum, value_name = "NAME", default_value_t = Format::Text)]
    pub format: Format,

    /// Write the specification or plant with the tuned numbers to this file, if they are better
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
