//! The one table of commands and flags: help, completions and the manual page are made from it.

use clap::{Args, CommandFactory, Parser, Subcommand, ValueEnum, ValueHint};
use clap_complete::Shell;
use sigmastar::certify::{Derivation, Ladder, Options, TransferChoice};
use sigmastar::enclosure::{DEFAULT_PRECISION, MAX_PRECISION};
use sigmastar::regulator::MAX_EXPORTED_OSCILLATORS;
use sigmastar::simulate::MAX_FIXED_STEPS;
use std::path::PathBuf;

/// The exit codes, as help and manual page tell them.
pub const EXIT_CODES: &str = "Exit codes:
  0  certified  the claim is proved
  1  refuted    it is proved not to hold
  2  bad-input  the input or the call is wrong; nothing was written
  3  undecided  nothing is claimed either way, and why is said";

/// The exit codes of `transfer`, whose results go into no certificate.
const TRANSFER_EXIT_CODES: &str = "Exit codes:
  0  proved     the bound is proved, computed with enclosures; no independent program checks it
  1  refuted    it is proved not to hold for this k0
  2  bad-input  the input or the call is wrong; nothing was written
  3  undecided  nothing is claimed either way, and why is said";

/// Examples of the main command.
pub const CERTIFY_EXAMPLES: &str = "Examples:
  sigmastar certify plant.json
  sigmastar certify plant.json -o plant.certificate.json
  sigmastar certify plant.json --target-rms 1e-3
  sigmastar certify plant.json --witness plant.certificate.json
  sigmastar certify plant.json --sampling-period 1/1000 --sigma 60
  sigmastar certify - --format json < plant.json";

/// Examples of `sampling`.
const SAMPLING_EXAMPLES: &str = "Examples:
  sigmastar sampling plant.json
  sigmastar sampling plant.json --sampling-period 1/200,1/1000 --sigma 50,100 --plot sampling.svg";

/// Examples of `sweep`.
const SWEEP_EXAMPLES: &str = "Examples:
  sigmastar sweep specs/studies/linear.json -o results.jsonl --minimise sigma_star --plot gains.svg
  sigmastar sweep study.json -o part3.jsonl --shard 3/8
  sigmastar merge part*.jsonl -o results.jsonl
  sigmastar sweep study.json --case 17 | sigmastar certify - -o case17.certificate.json";

/// Examples of `transfer`.
const TRANSFER_EXAMPLES: &str = "Examples:
  sigmastar transfer plant.json
  sigmastar transfer plant.json --k0 1/2 --n-o 0..10,inf
  sigmastar transfer plant.json --minimise 1,2/3 --plot bound.svg";

/// Examples of `bound`.
const BOUND_EXAMPLES: &str = "Examples:
  sigmastar bound plant.json
  sigmastar bound plant.json --domain 0.5,2 -o spec.json";

/// Examples of `controller`.
const CONTROLLER_EXAMPLES: &str = "Examples:
  sigmastar controller plant.certificate.json --n-o 4 --discretise 1/1000 --format c -o regulator.c --example
  sigmastar controller plant.json --sigma 48 --n-o 4 --format matlab -o regulator.m";

/// Examples of simulations.
pub const SIMULATE_EXAMPLES: &str = "Examples:
  sigmastar simulate plant.json --sigma 2 --n-o 4
  sigmastar simulate plant.json --sigma 2 --high-gain --plots figures
  sigmastar simulate plant.json --sigma 2 --n-o 4 --sampled 1/1000 --delay 1/2000 --saturation 20
  sigmastar simulate plant.json --controller controller.json --noise-power 1e-3 --seed 7";

/// Certified gains for output regulation: from bounding functions of a plant to a gain that provably works for every
/// number of oscillators.
#[derive(Debug, Parser)]
#[command(name = "sigmastar", version, after_long_help = EXIT_CODES, max_term_width = 100)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,
}

/// The command line of [`Cli`], on which a negative number after a flag is its value: `--n-o -1` is a number that is
/// refused, not an unknown flag.
pub fn command() -> clap::Command {
    let number = |arg: clap::Arg| {
        let has_value = arg.get_long().is_some() && arg.get_action().takes_values();
        if has_value { arg.allow_negative_numbers(true) } else { arg }
    };
    Cli::command().mut_subcommands(|command| command.mut_args(number))
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Certify a gain for a bounding specification
    ///
    /// Searches for the smallest gain sigma*, decides every condition in rigorous arithmetic, and reports what is
    /// proved. The report goes to standard output, remarks and errors to standard error.
    #[command(after_help = CERTIFY_EXAMPLES, after_long_help = format!("{CERTIFY_EXAMPLES}\n\n{EXIT_CODES}"))]
    Certify(Box<CertifyArgs>),
    /// For how fast a computer: the smallest certified gain for sampling periods, and the longest one for gains
    ///
    /// Each pair is certified as `certify --sampling-period H --sigma V` does. A gain is certified for its sampling period alone:
    /// neither a larger gain nor a shorter period follows from it.
    #[command(after_help = SAMPLING_EXAMPLES, after_long_help = format!("{SAMPLING_EXAMPLES}\n\n{EXIT_CODES}"))]
    Sampling(SamplingArgs),
    /// Certify a specification or plant with many values put in: a grid or a Latin hypercube
    ///
    /// Each case is certified by itself, as `certify` does it; nothing is claimed between the cases, and no certificates are
    /// written. A sweep that was interrupted goes on where it stopped: run the same command again.
    #[command(after_help = SWEEP_EXAMPLES)]
    Sweep(SweepArgs),
    /// Join the results of the shards of a sweep
    ///
    /// The shards must be of one study, and no case may be missing. The bytes are those of a sweep without shards.
    Merge(MergeArgs),
    /// Prove the transfer bound T(x) <= k0 + k1 x^2 for every number of oscillators
    ///
    /// Finds constants k0, k1 that are proved for every n_o and every frequency, says how much of the bound each n_o uses,
    /// and holds the paper's constants against them. Computed with enclosures; there is no file for the independent checker.
    #[command(after_help = TRANSFER_EXAMPLES, after_long_help = format!("{TRANSFER_EXAMPLES}\n\n{TRANSFER_EXIT_CODES}"))]
    Transfer(TransferArgs),
    /// Check a certificate with the independent checker
    ///
    /// Decides the claim again from the certificate alone, with none of the code that made it: the same as the program
    /// `proofs-check`. Says what is proved, of which specification, and what is assumed; figures on which no claim rests
    /// have an answer of their own. Exit codes: 0 valid, 1 invalid, 2 bad-input, 3 undecided.
    Check(CheckArgs),
    /// Write the regulator of a specification, plant or certificate: matrices, the law for a computer, C code
    ///
    /// Every number is the exact one rounded once to double precision. Of a certificate the gain is its sigma* unless --sigma
    /// says otherwise. What is known to be bad is refused: sampling that cannot tell the oscillators apart, DT sigma > 1, a gain
    /// below sigma* of the certificate. No claim covers the sampling.
    #[command(after_help = CONTROLLER_EXAMPLES)]
    Controller(ControllerArgs),
    /// Simulate a plant with a regulator: steady state, long run, measurement noise
    ///
    /// Floating point, no claim. The report goes to standard output; --csv and --plots write files.
    #[command(after_help = SIMULATE_EXAMPLES)]
    Simulate(SimulateArgs),
    /// Reproduce the tables and figures of the paper
    ///
    /// Floating point, no claim. Writes report.md, report.json and the figures into a folder.
    Reproduce(ReproduceArgs),
    /// Try to break a certificate by simulation
    ///
    /// Draws plants within the bounding functions, starts on the boundary of the initial set and checks every bound of
    /// the claim a little above sigma*, or of the law at samples with exactly its gain. Finding nothing proves nothing; exit code 1 and a plant file if it finds one.
    Falsify(FalsifyArgs),
    /// List what is wrong in the paper, with evidence
    ///
    /// With a specification, also says what each item means for it.
    Errata(ErrataArgs),
    /// Find and prove the Lyapunov triple of a specification with a Jacobian
    ///
    /// Prints P, the triple that is proved for every t, and the Floquet exponents (floating point) beside.
    Lyapunov(LyapunovArgs),
    /// Write a bounding specification for a plant: polynomials in X and E, each proved
    ///
    /// For reading and editing: the bounds of f, q and their derivatives relative to the periodic solution x_0(t), in the
    /// coordinates of the certificate, on a domain that is stated. `certify` of it works, with a gain that is a little larger
    /// than that of the plant itself.
    #[command(after_help = BOUND_EXAMPLES)]
    Bound(BoundArgs),
    /// Prove rates of convergence for given numbers of oscillators
    ///
    /// They tend to 0 as n_o grows, while sigma* does not move. Printed next to the spectral abscissa of the oscillators.
    /// Computed with enclosures; there is no file for the independent checker.
    Rate(RateArgs),
    /// Write a completion script for a shell to standard output
    Completions {
        /// The shell
        #[arg(value_name = "SHELL")]
        shell: Shell,
    },
    /// Write the manual page (roff) to standard output
    Man,
}

/// The flags of `certify`.
#[derive(Args, Debug)]
pub struct CertifyArgs {
    /// Bounding specification or plant (JSON), or `-` for standard input
    #[arg(value_name = "SPEC", value_hint = ValueHint::FilePath)]
    pub spec: PathBuf,

    /// Derivation that the verdict is about
    #[arg(long, value_enum, value_name = "NAME", default_value_t = DerivationArg::Sharp)]
    pub derivation: DerivationArg,

    /// Transfer constants of the sharp derivation
    #[arg(long, value_enum, value_name = "NAME", default_value_t = TransferArg::Best)]
    pub transfer: TransferArg,

    /// Certify this gain, a positive rational number, instead of the smallest one that is found
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    pub sigma: Option<String>,

    /// Certify the regulator at samples this far apart, an exact positive constant; sets or replaces `sampling_period`
    #[arg(long, value_name = "H", allow_hyphen_values = true)]
    pub sampling_period: Option<String>,

    /// Decide the witness of this certificate again instead of searching
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath,
          conflicts_with_all = ["derivation", "transfer", "sigma"])]
    pub witness: Option<PathBuf>,

    /// Format of the report
    #[arg(long, value_enum, value_name = "NAME", default_value_t = Format::Text)]
    pub format: Format,

    /// Write the certificate (JSON) to this file, if certified
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,

    /// Find the smallest n_o that certifies sup|e| <= V, an exact constant such as `1e-3` or `1/1000`
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    pub target_sup: Option<String>,

    /// Find the smallest n_o that certifies rms(e) <= V, an exact constant such as `1e-3` or `1/1000`
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    pub target_rms: Option<String>,

    /// Highest working precision in bits, 128 to 4096
    #[arg(long, value_name = "BITS", default_value_t = MAX_PRECISION,
          value_parser = clap::value_parser!(u32).range(i64::from(DEFAULT_PRECISION)..=4096))]
    pub precision_limit: u32,

    /// Do not work out the other derivations for comparison
    #[arg(long)]
    pub no_compare: bool,

    /// No remarks on standard error; errors are still shown
    #[arg(short, long)]
    pub quiet: bool,
}

impl CertifyArgs {
    /// The options of the run.
    pub fn options(&self) -> Options {
        Options {
            derivation: match self.derivation {
                DerivationArg::Sharp => Derivation::Sharp,
                DerivationArg::Repaired => Derivation::Repaired,
                DerivationArg::Printed => Derivation::Printed,
            },
            transfer: match self.transfer {
                TransferArg::Best => TransferChoice::Best,
                TransferArg::Boxes => TransferChoice::Boxes,
                TransferArg::ClosedForm => TransferChoice::ClosedForm,
            },
            ladder: Ladder { start: DEFAULT_PRECISION, limit: self.precision_limit },
            compare: !self.no_compare,
        }
    }
}

/// The flags of `sampling`.
#[derive(Args, Debug)]
pub struct SamplingArgs {
    /// Bounding specification or plant (JSON) with a matched base frequency, or `-` for standard input
    #[arg(value_name = "SPEC", value_hint = ValueHint::FilePath)]
    pub spec: PathBuf,

    /// Sampling periods, separated by commas: exact constants of which the period is a whole multiple [default: some that fit
    /// the gain of the continuous-time regulator]
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    pub sampling_period: Option<String>,

    /// Gains, positive rational numbers separated by commas [default: 1.1, 1.5, 2, 3 and 5 times the gain of the
    /// continuous-time regulator]
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    pub sigma: Option<String>,

    /// Draw the certified pairs, as SVG, into this file
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub plot: Option<PathBuf>,

    /// Format of the report
    #[arg(long, value_enum, value_name = "NAME", default_value_t = Format::Text)]
    pub format: Format,

    /// No remarks and no progress on standard error; errors are still shown
    #[arg(short, long)]
    pub quiet: bool,
}

/// The flags of `sweep`.
#[derive(Args, Debug)]
pub struct SweepArgs {
    /// Study (JSON), or `-` for standard input
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

/// The flags of `transfer`.
#[derive(Args, Debug)]
pub struct TransferArgs {
    /// Bounding specification or plant (JSON), or `-` for standard input
    #[arg(value_name = "SPEC", value_hint = ValueHint::FilePath)]
    pub spec: PathBuf,

    /// Find the smallest k1 for this k0, an exact constant such as `7` or `2*pi^2`
    #[arg(long, value_name = "V", allow_hyphen_values = true, conflicts_with = "minimise")]
    pub k0: Option<String>,

    /// Find the pair with the smallest A k0 + B k1 [default: the weights of the specification's data at X = E = 0]
    #[arg(long, value_name = "A,B", allow_hyphen_values = true)]
    pub minimise: Option<String>,

    /// Numbers of oscillators to look at: a list of numbers and ranges; `inf` is allowed
    #[arg(long, value_name = "LIST", allow_hyphen_values = true, default_value = "0,1,2,3,5,10,20,50,1000000000,inf")]
    pub n_o: String,

    /// Draw T for these n_o under the bound, as SVG, into this file
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub plot: Option<PathBuf>,

    /// Format of the report
    #[arg(long, value_enum, value_name = "NAME", default_value_t = Format::Text)]
    pub format: Format,

    /// No remarks and no progress on standard error; errors are still shown
    #[arg(short, long)]
    pub quiet: bool,
}

/// The flags of `check`.
#[derive(Args, Debug)]
pub struct CheckArgs {
    /// Certificate (JSON), or `-` for standard input
    #[arg(value_name = "CERTIFICATE", value_hint = ValueHint::FilePath)]
    pub certificate: PathBuf,

    /// Specification that the certificate has to be about: other data make it invalid
    #[arg(long, value_name = "SPEC", value_hint = ValueHint::FilePath)]
    pub spec: Option<PathBuf>,

    /// Show the argument, line by line
    #[arg(short, long)]
    pub verbose: bool,

    /// Format of the answer
    #[arg(long, value_enum, value_name = "NAME", default_value_t = Format::Text)]
    pub format: Format,
}

/// The flags of `errata`.
#[derive(Args, Debug)]
pub struct ErrataArgs {
    /// Bounding specification (JSON) to look at each item from, or `-` for standard input
    #[arg(value_name = "SPEC", value_hint = ValueHint::FilePath)]
    pub spec: Option<PathBuf>,

    /// Format of the list
    #[arg(long, value_enum, value_name = "NAME", default_value_t = Format::Text)]
    pub format: Format,
}

/// The flags of `lyapunov`.
#[derive(Args, Debug)]
pub struct LyapunovArgs {
    /// Bounding specification with a Jacobian, or plant (JSON), or `-` for standard input
    #[arg(value_name = "SPEC", value_hint = ValueHint::FilePath)]
    pub spec: PathBuf,

    /// Format of the report
    #[arg(long, value_enum, value_name = "NAME", default_value_t = Format::Text)]
    pub format: Format,
}

/// The flags of `bound`.
#[derive(Args, Debug)]
pub struct BoundArgs {
    /// Plant (JSON), or `-` for standard input
    #[arg(value_name = "PLANT", value_hint = ValueHint::FilePath)]
    pub plant: PathBuf,

    /// Write the specification to this file; standard output if absent
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,

    /// The domain: |y| <= X and |e| <= E; if absent, one quarter larger than what the certificate of the plant needs
    #[arg(long, value_name = "X,E", allow_hyphen_values = true)]
    pub domain: Option<String>,

    /// Say nothing on standard error but errors
    #[arg(short, long)]
    pub quiet: bool,
}

/// The flags of `rate`.
#[derive(Args, Debug)]
pub struct RateArgs {
    /// Bounding specification or plant (JSON), or `-` for standard input
    #[arg(value_name = "SPEC", value_hint = ValueHint::FilePath)]
    pub spec: PathBuf,

    /// Numbers of oscillators, each at most 200: a list of numbers and ranges, such as `0,1,5..10`
    #[arg(long, value_name = "LIST", default_value = "0,1,2,4,8,16", allow_hyphen_values = true)]
    pub n_o: String,

    /// The gain, an exact constant of at least sigma*; sigma* itself if absent
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    pub sigma: Option<String>,

    /// Format of the report
    #[arg(long, value_enum, value_name = "NAME", default_value_t = Format::Text)]
    pub format: Format,
}

/// The flags of `controller`.
#[derive(Args, Debug)]
pub struct ControllerArgs {
    /// Bounding specification or plant (JSON) with the internal model, or a certificate of one, or `-` for standard input
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub spec: PathBuf,

    /// The gain sigma, an exact positive constant such as `48.5` or `97/2` [default: sigma* of the certificate, where one is given]
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    pub sigma: Option<String>,

    /// The number of oscillators n_o (the high-gain feedback u = -sigma e needs no file: see `simulate --high-gain`)
    #[arg(long, value_name = "N",
          value_parser = clap::value_parser!(u32).range(0..=i64::from(MAX_EXPORTED_OSCILLATORS)))]
    pub n_o: u32,

    /// Also the law for a computer with this sampling time, an exact positive constant; the control is held over each sample
    #[arg(long, value_name = "DT", allow_hyphen_values = true)]
    pub discretise: Option<String>,

    /// Certificate for the specification or plant: a gain below its sigma* is refused, and its claim goes into the export
    #[arg(long, value_name = "CERTIFICATE", value_hint = ValueHint::FilePath)]
    pub certificate: Option<PathBuf>,

    /// Export what is refused otherwise: too slow sampling, or a gain below sigma* of the certificate
    #[arg(long)]
    pub uncertified: bool,

    /// Clip the control to |u| <= U, an exact positive constant, without windup; outside every claim
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
}

/// The flags of `simulate`.
#[derive(Args, Debug)]
pub struct SimulateArgs {
    /// Plant (JSON), or `-` for standard input
    #[arg(value_name = "PLANT", value_hint = ValueHint::FilePath)]
    pub plant: PathBuf,

    /// The gain sigma, an exact positive constant such as `48.5` or `97/2`
    #[arg(long, value_name = "V", allow_hyphen_values = true, required_unless_present = "controller")]
    pub sigma: Option<String>,

    /// The number of oscillators n_o, with the internal model of the plant file
    #[arg(long, value_name = "N", required_unless_present_any = ["controller", "high_gain"],
          value_parser = clap::value_parser!(u32).range(0..=200))]
    pub n_o: Option<u32>,

    /// The high-gain feedback u = -sigma e without an internal model
    #[arg(long, conflicts_with = "n_o")]
    pub high_gain: bool,

    /// The regulator from a file that `controller` wrote (JSON)
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with_all = ["sigma", "n_o", "high_gain"])]
    pub controller: Option<PathBuf>,

    /// The regulator at samples H apart, an exact positive constant: the law that `controller --discretise H` exports, with u
    /// held between samples
    #[arg(long, value_name = "H", allow_hyphen_values = true,
          conflicts_with_all = ["high_gain", "fixed", "noise_power", "noise_everywhere"])]
    pub sampled: Option<String>,

    /// Time that a control takes to be computed: it acts D after its sample, 0 <= D <= H
    #[arg(long, value_name = "D", requires = "sampled", allow_hyphen_values = true)]
    pub delay: Option<String>,

    /// Measure e in multiples of QE and, if QU is given, put u out in multiples of QU
    #[arg(long, value_name = "QE[,QU]", requires = "sampled", value_delimiter = ',', allow_hyphen_values = true)]
    pub quantise: Vec<String>,

    /// Clip the control to |u| <= U, with the exported law's anti-windup
    #[arg(long, value_name = "U", requires = "sampled", allow_hyphen_values = true)]
    pub saturation: Option<String>,

    /// Time of the first sample, where the run starts: the phase of the sampling grid
    #[arg(long, value_name = "P", requires = "sampled", allow_hyphen_values = true)]
    pub phase: Option<String>,

    /// Length of the run from the initial condition, in periods
    #[arg(long, value_name = "P", default_value_t = 30, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub periods: u32,

    /// Integrate the run with this many classical Runge-Kutta steps per period instead of adaptive steps of order 8;
    /// raised to a multiple of --samples
    #[arg(long, value_name = "STEPS", value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_FIXED_STEPS)))]
    pub fixed: Option<u32>,

    /// Samples per period in the CSV file and the time response
    #[arg(long, value_name = "S", default_value_t = 200, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub samples: u32,

    /// Fourier coefficients in the report
    #[arg(long, value_name = "K", default_value_t = 12, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub harmonics: u32,

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

    /// No progress and no remarks on standard error; errors are still shown
    #[arg(short, long)]
    pub quiet: bool,
}

/// The flags of `reproduce`.
#[derive(Args, Debug)]
pub struct ReproduceArgs {
    /// Folder for the report and the figures; created where it does not exist
    #[arg(short, long, value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    pub output: PathBuf,

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

    /// Format of the report
    #[arg(long, value_enum, value_name = "NAME", default_value_t = Format::Text)]
    pub format: Format,

    /// Write the first counterexample to this plant file, or with `--trial` the plant of the trial
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,

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

/// A derivation.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum DerivationArg {
    /// The tightest bounds
    Sharp,
    /// The paper's architecture, each formula repaired
    Repaired,
    /// The paper to the letter; never certifies
    Printed,
}

/// A choice of transfer constants.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum TransferArg {
    /// Those of a matched base frequency where the specification asserts it, else boxes
    Best,
    /// Proved by boxes, valid for every base frequency
    Boxes,
    /// The closed form, valid for every base frequency, larger
    ClosedForm,
}

/// A format of a report, the same for every command.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Plain text for a terminal
    Text,
    /// GitHub-flavoured Markdown
    Markdown,
    /// One HTML page with figures, which needs no other file
    Html,
    /// JSON, also for failures
    Json,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_of_flags_is_consistent() {
        command().debug_assert();
    }

    /// No flag with a number takes the minus sign in front of it for another flag.
    #[test]
    fn a_negative_number_is_a_value() {
        for line in [
            "rate s --n-o -1",
            "transfer s --n-o -1..2",
            "controller s --sigma 1 --n-o -1",
            "certify s --precision-limit -1",
        ] {
            match command().try_get_matches_from(["sigmastar"].into_iter().chain(line.split(' '))) {
                Ok(_) => {}
                Err(error) => assert_eq!(error.kind(), clap::error::ErrorKind::ValueValidation, "{line}: {error}"),
            }
        }
    }
}
