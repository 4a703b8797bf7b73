//! Flags of the commands that export the regulator and set it to work.

use super::Replace;
use crate::cli::counts::{LARGEST_HARMONIC, harmonics, one_count};
use crate::cli::output::Format;
use clap::{Args, ValueEnum, ValueHint};
use sigmastar::RegulatorMatrices;
use sigmastar_lab::simulate::MAX_FIXED_STEPS;
use sigmastar_lang::spec::Oscillators;
use std::path::PathBuf;

/// The most oscillators of a simulation.
const MAX_SIMULATED_OSCILLATORS: u32 = 200;

/// The flags of `controller`.
#[derive(Args, Debug)]
pub struct ControllerArgs {
    /// Bounding specification or plant (.json, .jsonc, .toml) with the internal model, or a certificate of one, or `-` for standard input
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub spec: PathBuf,

    /// The gain sigma, an exact positive constant such as `48.5` or `97/2` [default: sigma* of the certificate, where one is given]
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    pub sigma: Option<String>,

    /// The number of oscillators n_o (the high-gain feedback u = -sigma e needs no file: see `simulate --high-gain`)
    #[arg(long, value_name = "N", required_unless_present = "harmonics",
          value_parser = one_count(RegulatorMatrices::MAX_OSCILLATORS))]
    pub n_o: Option<u32>,

    /// The harmonics of the oscillators instead of the first n_o; 0 is one of them: `0,1,5,7,11,13`
    #[arg(long, value_name = "LIST", conflicts_with = "n_o", value_parser = harmonics(RegulatorMatrices::MAX_OSCILLATORS, LARGEST_HARMONIC))]
    pub harmonics: Option<Oscillators>,

    /// Also the law for a computer with this sampling time, an exact positive constant; the control is held over each sample
    #[arg(long, value_name = "DT", allow_hyphen_values = true)]
    pub discretise: Option<String>,

    /// 1: the control is computed in the sample before the one in which it acts; 0: without this delay [default: `delay_samples` of the file, or
    /// of the certificate]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=1))]
    pub delay_samples: Option<u32>,

    /// Certificate for the specification or plant: a gain below its sigma* is refused, and its claim goes into the export
    #[arg(long, value_name = "CERTIFICATE", value_hint = ValueHint::FilePath)]
    pub certificate: Option<PathBuf>,

    /// Export what is refused otherwise: too slow sampling, or a gain below sigma* of the certificate
    #[arg(long)]
    pub uncertified: bool,

    /// Clip the control to |u| <= U, an exact positive constant, without windup; no claim covers this [default: `actuator` of the file, where it
    /// has one]
    #[arg(long, value_name = "U", allow_hyphen_values = true, requires = "discretise")]
    pub saturation: Option<String>,

    /// Form in which the regulator is written
    #[arg(long, value_enum, value_name = "NAME", default_value_t = RegulatorForm::Json)]
    pub format: RegulatorForm,

    /// What the symbols of the C code begin with, for several regulators in one program [default: sigmastar]
    #[arg(long, value_name = "PREFIX")]
    pub prefix: Option<String>,

    /// Write a program beside FILE.c that runs the C code on a small plant: FILE_example.c
    #[arg(long)]
    pub example: bool,

    /// Write to this file; the C source takes its header beside it
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,

    #[command(flatten)]
    pub replace: Replace,

    /// No remarks on standard error; errors, and what --uncertified overrides, are still shown
    #[arg(short, long)]
    pub quiet: bool,
}

/// The flags of `simulate`.
#[derive(Args, Debug)]
pub struct SimulateArgs {
    /// Plant (.json, .jsonc, .toml), or a certificate of one, or `-` for standard input
    #[arg(value_name = "PLANT", value_hint = ValueHint::FilePath)]
    pub plant: PathBuf,

    /// The gain sigma, an exact positive constant such as `48.5` or `97/2` [default: that of the certificate, where one is given]
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    pub sigma: Option<String>,

    /// The number of oscillators n_o, with the internal model of the plant file
    #[arg(long, value_name = "N", required_unless_present_any = ["controller", "high_gain", "harmonics"],
          value_parser = one_count(MAX_SIMULATED_OSCILLATORS))]
    pub n_o: Option<u32>,

    /// The harmonics of the oscillators instead of the first n_o; 0 is one of them: `0,1,5,7,11,13`
    #[arg(long, value_name = "LIST", conflicts_with = "n_o", value_parser = harmonics(MAX_SIMULATED_OSCILLATORS, LARGEST_HARMONIC))]
    pub harmonics: Option<Oscillators>,

    /// The high-gain feedback u = -sigma e without an internal model
    #[arg(long, conflicts_with_all = ["n_o", "harmonics"])]
    pub high_gain: bool,

    /// The regulator from a file that `controller` wrote (JSON)
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with_all = ["sigma", "n_o", "harmonics", "high_gain"])]
    pub controller: Option<PathBuf>,

    /// The regulator at samples H apart, an exact positive constant: the law that `controller --discretise H` exports, with u
    /// held between samples [default: the sampling period of the certificate, where it has one]
    #[arg(long, value_name = "H", allow_hyphen_values = true,
          conflicts_with_all = ["high_gain", "fixed", "noise_power", "noise_everywhere"])]
    pub sampled: Option<String>,

    /// 1: the control acts at the next sample; 0: without this delay [default: `delay_samples` of the plant file; a file of --controller has its
    /// own]
    #[arg(long, value_name = "N", conflicts_with = "controller",
          value_parser = clap::value_parser!(u32).range(0..=1))]
    pub delay_samples: Option<u32>,

    /// Time that a control takes to be computed: it acts D after its sample, 0 <= D <= H
    #[arg(long, value_name = "D", allow_hyphen_values = true)]
    pub delay: Option<String>,

    /// Measure e in multiples of QE and, if QU is given, output u in multiples of QU
    #[arg(long, value_name = "QE[,QU]", value_delimiter = ',', allow_hyphen_values = true)]
    pub quantise: Vec<String>,

    /// Clip the control to |u| <= U, with the exported law's anti-windup [default: `actuator` of the plant file, where it has one]
    #[arg(long, value_name = "U", allow_hyphen_values = true)]
    pub saturation: Option<String>,

    /// Time of the first sample, where the run starts: the phase of the sampling grid
    #[arg(long, value_name = "P", allow_hyphen_values = true)]
    pub phase: Option<String>,

    /// Length of the run from the initial condition, in periods
    #[arg(long, value_name = "P", default_value_t = 30, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub periods: u32,

    /// Integrate the run with this many classical Runge-Kutta steps per period instead of adaptive steps of order 8;
    /// raised to a multiple of --samples
    #[arg(long, value_name = "STEPS", value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_FIXED_STEPS)))]
    pub fixed: Option<u32>,

    /// The true gain of the actuator, an exact positive constant [default: the nominal one of the plant file's `input_gain`]
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    pub input_gain: Option<String>,

    /// The true period, an exact positive constant [default: the nominal one of the plant file's `period`]
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    pub period: Option<String>,

    /// Simulate with another value of a parameter than the nominal one, an exact constant; repeat the flag for several parameters. The regulator
    /// stays that of the file
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true)]
    pub parameter: Vec<String>,

    /// Samples per period in the CSV file and the time response
    #[arg(long, value_name = "S", default_value_t = 200, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub samples: u32,

    /// Fourier coefficients in the report
    #[arg(long, value_name = "K", default_value_t = 12, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub coefficients: u32,

    /// Also run with measurement noise of this power spectral density through s^2/(s^2 + 3 s + 2)
    #[arg(long, value_name = "POWER", allow_hyphen_values = true)]
    pub noise_power: Option<String>,

    /// Seed of the noise
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    pub seed: u64,

    /// Runge-Kutta steps per period of the run with noise, which is held over each
    #[arg(long, value_name = "STEPS", default_value_t = 10_000,
          value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub noise_steps: u32,

    /// Feed the noise back through -sigma (e + v) as well, not only into the internal model
    #[arg(long)]
    pub noise_everywhere: bool,

    /// Format of the report
    #[arg(long, value_enum, value_name = "NAME", default_value_t = Format::Text)]
    pub format: Format,

    /// Write the samples of the run to this file (CSV)
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub csv: Option<PathBuf>,

    /// Write figures (SVG) into this folder
    #[arg(long, value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    pub plots: Option<PathBuf>,

    #[command(flatten)]
    pub replace: Replace,

    /// No progress and no remarks on standard error; errors are still shown
    #[arg(short, long)]
    pub quiet: bool,
}

impl SimulateArgs {
    /// The oscillators that are asked for by their number or their harmonics.
    pub fn oscillators(&self) -> Option<Oscillators> {
        self.harmonics.clone().or(self.n_o.map(Oscillators::first))
    }
}

impl ControllerArgs {
    /// The oscillators; one of both flags is there.
    pub fn oscillators(&self) -> Oscillators {
        self.harmonics.clone().unwrap_or_else(|| Oscillators::first(self.n_o.unwrap_or_default()))
    }
}

/// The flags of `reproduce`.
#[derive(Args, Debug)]
pub struct ReproduceArgs {
    /// Folder for the report and the figures; created where it does not exist
    #[arg(short, long, value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    pub output: PathBuf,

    #[command(flatten)]
    pub replace: Replace,

    /// Only these parts (several can be given, separated by commas)
    #[arg(long, value_enum, value_name = "PART", value_delimiter = ',')]
    pub only: Vec<PartArg>,

    /// Seeds of the noise: ranges are over seeds 1 to this number
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=100))]
    pub seeds: u32,

    /// Runge-Kutta steps per period of the runs with noise (the paper has 100000)
    #[arg(long, value_name = "STEPS", default_value_t = 10_000,
          value_parser = clap::value_parser!(u32).range(1000..=1_000_000))]
    pub noise_steps: u32,

    /// No progress and no remarks on standard error; errors are still shown
    #[arg(short, long)]
    pub quiet: bool,
}

/// The flags of `falsify`.
#[derive(Args, Debug)]
pub struct FalsifyArgs {
    /// Certificate (JSON), or `-` for standard input
    #[arg(value_name = "CERT", value_hint = ValueHint::FilePath)]
    pub certificate: PathBuf,

    /// Number of plants
    #[arg(long, value_name = "N", default_value_t = 50, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub trials: u32,

    /// Seed of the random numbers; the same seed gives the same trials
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    pub seed: u64,

    /// Run this trial alone; `-o` then writes its plant also where every bound holds
    #[arg(
        long, value_name = "K", conflicts_with_all = ["trials", "base_frequency"],
        value_parser = clap::value_parser!(u32).range(1..=1_000_000)
    )]
    pub trial: Option<u32>,

    /// Also certify the specification at these other base frequencies, exact positive constants separated by commas, and
    /// try those certificates
    #[arg(long, value_name = "LIST", value_delimiter = ',', allow_hyphen_values = true)]
    pub base_frequency: Vec<String>,

    /// Try only oscillators at these harmonics; 0 is one of them: `0,1,5,7`. Repeat the flag for several sets, which the trials then have in turn.
    /// Without it a number n_o of oscillators is drawn for each trial
    #[arg(long, value_name = "LIST", value_parser = harmonics(MAX_SIMULATED_OSCILLATORS, LARGEST_HARMONIC))]
    pub harmonics: Vec<Oscillators>,

    /// Try only this value of a parameter that has an interval, an exact number; repeat the flag for several parameters. Without it the corners
    /// of the intervals come first
    #[arg(long, value_name = "NAME=VALUE", conflicts_with = "base_frequency", allow_hyphen_values = true)]
    pub parameter: Vec<String>,

    /// Format of the report
    #[arg(long, value_enum, value_name = "NAME", default_value_t = Format::Text)]
    pub format: Format,

    /// Show the whole report, not its short form (HTML and JSON are always whole)
    #[arg(long)]
    pub full: bool,

    /// Write the first counterexample to this plant file, or with `--trial` the plant of the trial
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,

    #[command(flatten)]
    pub replace: Replace,

    /// No progress and no remarks on standard error; errors are still shown
    #[arg(short, long)]
    pub quiet: bool,
}

/// A part of the paper's numerical section.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PartArg {
    /// High-gain feedback, without noise
    Table1,
    /// Internal model, without noise
    Table2,
    /// The columns with noise of both tables
    Noise,
    /// The five figures
    Figures,
    /// The constants for the bounds of the example, printed and repaired, beside the proved ones
    Constants,
}

/// A form of the regulator.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum RegulatorForm {
    /// JSON
    Json,
    /// NumPy archive (needs -o)
    Npz,
    /// Script for MATLAB and Octave
    Matlab,
    /// C99 source and header with a step function (needs --discretise and -o FILE.c)
    C,
}
