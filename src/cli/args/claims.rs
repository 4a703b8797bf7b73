//! Flags of the commands that prove something, or say what was proved.

use super::Replace;
use crate::cli::counts::harmonics;
use crate::cli::output::Format;
use clap::{Args, ValueEnum, ValueHint};
use sigmastar::program::Options;
use sigmastar::{CertifyOptions, TransferChoice};
use sigmastar_lang::spec::Oscillators;
use sigmastar_prove::rate::bound::MAX_OSCILLATORS;
use std::path::PathBuf;

/// The flags of `certify`.
#[derive(Args, Debug)]
pub struct CertifyArgs {
    /// Bounding specification or plant (.json, .jsonc, .toml), or a certificate of one, or `-` for standard input
    #[arg(value_name = "SPEC", value_hint = ValueHint::FilePath)]
    pub spec: PathBuf,

    /// Which proof of the transfer bound
    #[arg(long, value_enum, value_name = "NAME", default_value_t = TransferArg::Best)]
    pub transfer: TransferArg,

    /// Certify this gain, a positive rational number, instead of the smallest one found
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    pub sigma: Option<String>,

    /// Certify the smallest gain found that keeps |e| along the periodic solution at most V. The limit counts for every n_o. With --n-o it
    /// counts for the numbers of LIST alone, which often needs a far smaller gain
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    pub steady_error: Option<String>,

    /// Certify the smallest gain found that keeps |e| at most V at all times from the initial set. The limit counts for every n_o, or with
    /// --n-o for the numbers of LIST alone
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    pub peak_error: Option<String>,

    /// Certify the smallest gain found that keeps |u| at most V at all times from the initial set. Here u is the output of the regulator: with
    /// `input_gain` the control divided by `nominal`. If `actuator` has two limits, u is measured from the middle of its range. The limit counts
    /// for every n_o, or with --n-o for the numbers of LIST alone
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    pub max_control: Option<String>,

    /// Certify the smallest gain found with a rate of at least V, in 1/time, for each number of --n-o
    #[arg(long, value_name = "V", allow_hyphen_values = true, requires = "n_o")]
    pub rate: Option<String>,

    /// Certify the regulator with this sampling period, an exact positive constant; sets or replaces `sampling_period` of the file
    #[arg(long, value_name = "H", allow_hyphen_values = true)]
    pub sampling_period: Option<String>,

    /// Decide the witness of this certificate again instead of searching
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath,
          conflicts_with_all = ["transfer", "sigma", "steady_error", "peak_error", "max_control", "rate"])]
    pub witness: Option<PathBuf>,

    /// Format of the report
    #[arg(long, value_enum, value_name = "NAME", default_value_t = Format::Text)]
    pub format: Format,

    /// Show the whole report, not its short form (HTML and JSON are always whole)
    #[arg(long)]
    pub full: bool,

    /// Write the certificate (JSON) to this file, if certified
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,

    /// Write figures (SVG) into this folder, if certified: |e| and u of a simulation, with the proved bounds
    #[arg(long, value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    pub plots: Option<PathBuf>,

    #[command(flatten)]
    pub replace: Replace,

    /// Find the smallest n_o for which sup|e| <= V is proved along the periodic solution, at the gain of the claim; V is an exact constant such
    /// as `1e-3` or `1/1000`
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    pub target_sup: Option<String>,

    /// Find the smallest n_o for which rms(e) <= V is proved along the periodic solution, at the gain of the claim; V is an exact constant such
    /// as `1e-3` or `1/1000`
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    pub target_rms: Option<String>,

    /// Prove a rate of convergence for each of these numbers of oscillators, such as `0,4,10` (at most 8 numbers, up to 100): |e - e_per| <=
    /// factor exp(-rate (t - t_0)) in the loop without noise. If the file states `measurement` or `disturbance`, or at samples `arithmetic`,
    /// bounds of |e - e_per| with these are proved, too. All of this holds at the gain of the claim alone, and is in the certificate. Without
    /// --rate, limits such as --peak-error then count for these numbers alone. The report has rows for these numbers, too
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    pub n_o: Option<String>,

    /// Prove a rate and bounds for oscillators at these harmonics, such as `0,1,5,7`, as --n-o does for the first ones; repeat the flag for several
    /// sets. The claim is then about every finite set of harmonics that contains 0: the flag sets or replaces `harmonics` of the internal model.
    /// With a delay there is no rate
    #[arg(long, value_name = "LIST", value_parser = harmonics(MAX_OSCILLATORS, MAX_OSCILLATORS))]
    pub harmonics: Vec<Oscillators>,

    /// Highest working precision in bits, 128 to 4096
    #[arg(long, value_name = "BITS", default_value_t = CertifyOptions::LARGEST_PRECISION_LIMIT,
          value_parser = clap::value_parser!(u32).range(i64::from(CertifyOptions::LEAST_PRECISION_LIMIT)..=4096))]
    pub precision_limit: u32,

    /// Certify, and compute nothing else. This saves time. Left out are: bounds at larger gains; what intervals of parameters cost; if nothing is
    /// certified, a limit that can be kept or a smaller initial set; for a plant the bounds by the number of oscillators, unless a limit such as
    /// --peak-error needs them; and the search for the paper's derivations
    #[arg(long, alias = "no-compare")]
    pub no_alternatives: bool,

    /// Show the stages of the work on standard error, one a line. On a terminal long work shows them without this flag
    #[arg(long, conflicts_with = "quiet")]
    pub progress: bool,

    /// No remarks on standard error; errors are still shown
    #[arg(short, long)]
    pub quiet: bool,
}

impl CertifyArgs {
    /// The options of the run.
    pub fn options(&self) -> Options {
        let transfer = match self.transfer {
            TransferArg::Best => TransferChoice::Best,
            TransferArg::Boxes => TransferChoice::Boxes,
            TransferArg::ClosedForm => TransferChoice::ClosedForm,
        };
        let options = CertifyOptions::new().transfer(transfer).precision_limit(self.precision_limit);
        options.compare(!self.no_alternatives).of_run()
    }
}

/// The flags of `sampling`.
#[derive(Args, Debug)]
pub struct SamplingArgs {
    /// Bounding specification or plant (.json, .jsonc, .toml) with a matched base frequency, or a certificate of one, or `-` for
    /// standard input
    #[arg(value_name = "SPEC", value_hint = ValueHint::FilePath)]
    pub spec: PathBuf,

    /// Sampling periods, separated by commas: exact constants. The period must be a whole multiple of each [default: some that fit
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

    #[command(flatten)]
    pub replace: Replace,

    /// Format of the report
    #[arg(long, value_enum, value_name = "NAME", default_value_t = Format::Text)]
    pub format: Format,

    /// No remarks and no progress on standard error; errors are still shown
    #[arg(short, long)]
    pub quiet: bool,
}

/// The flags of `transfer`.
#[derive(Args, Debug)]
pub struct TransferArgs {
    /// Bounding specification or plant (.json, .jsonc, .toml), or a certificate of one, or `-` for standard input
    #[arg(value_name = "SPEC", value_hint = ValueHint::FilePath)]
    pub spec: PathBuf,

    /// Find the smallest k1 for this k0, an exact constant such as `7` or `2*pi^2`
    #[arg(long, value_name = "V", allow_hyphen_values = true, conflicts_with = "minimise")]
    pub k0: Option<String>,

    /// Find the pair with the smallest A k0 + B k1 [default: the weights of the specification's data at X = E = 0]
    #[arg(long, value_name = "A,B", allow_hyphen_values = true)]
    pub minimise: Option<String>,

    /// Numbers of oscillators to look at: a list of numbers and ranges, such as `0..10,20..100/10`; `inf` is allowed
    #[arg(long, value_name = "LIST", allow_hyphen_values = true, default_value = "0,1,2,3,5,10,20,50,1000000000,inf")]
    pub n_o: String,

    /// Also prove a pair that serves oscillators at every finite set of harmonics that contains 0, not only at the first n_o
    #[arg(long)]
    pub sets: bool,

    /// Draw T for these n_o under the bound, as SVG, into this file
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub plot: Option<PathBuf>,

    #[command(flatten)]
    pub replace: Replace,

    /// Format of the report
    #[arg(long, value_enum, value_name = "NAME", default_value_t = Format::Text)]
    pub format: Format,

    /// Show the whole report, not its short form (HTML and JSON are always whole)
    #[arg(long)]
    pub full: bool,

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

    /// The specification or plant that the certificate must be about, as .json (`convert` makes it from a .jsonc or .toml file). If the
    /// certificate is about other data, the answer is invalid
    #[arg(long, value_name = "SPEC", value_hint = ValueHint::FilePath)]
    pub spec: Option<PathBuf>,

    /// The sampling period with which `certify` was called; it is put into SPEC before the comparison
    #[arg(long, value_name = "H", requires = "spec", allow_hyphen_values = true)]
    pub sampling_period: Option<String>,

    /// Show the argument, line by line
    #[arg(short, long)]
    pub verbose: bool,

    /// Format of the answer
    #[arg(long, value_enum, value_name = "NAME", default_value_t = Format::Text)]
    pub format: Format,

    /// No remarks on standard error; errors are still shown
    #[arg(short, long)]
    pub quiet: bool,
}

/// The flags of `errata`.
#[derive(Args, Debug)]
pub struct ErrataArgs {
    /// Bounding specification (.json, .jsonc, .toml) for which each item is evaluated, or a certificate of one, or `-` for standard input
    #[arg(value_name = "SPEC", value_hint = ValueHint::FilePath)]
    pub spec: Option<PathBuf>,

    /// Format of the list
    #[arg(long, value_enum, value_name = "NAME", default_value_t = Format::Text)]
    pub format: Format,
}

/// The flags of `constants`.
#[derive(Args, Debug)]
pub struct ConstantsArgs {
    /// Bounding specification (.json, .jsonc, .toml), or a certificate of one, or `-` for standard input
    #[arg(value_name = "SPEC", value_hint = ValueHint::FilePath)]
    pub spec: PathBuf,

    /// Format of the table
    #[arg(long, value_enum, value_name = "NAME", default_value_t = Format::Text)]
    pub format: Format,

    /// No remarks on standard error; errors are still shown
    #[arg(short, long)]
    pub quiet: bool,
}

/// The flags of `lyapunov`.
#[derive(Args, Debug)]
pub struct LyapunovArgs {
    /// Bounding specification with a Jacobian, or plant (.json, .jsonc, .toml), or a certificate of one, or `-` for standard input
    #[arg(value_name = "SPEC", value_hint = ValueHint::FilePath)]
    pub spec: PathBuf,

    /// Format of the report
    #[arg(long, value_enum, value_name = "NAME", default_value_t = Format::Text)]
    pub format: Format,

    /// Show the whole report, not its short form (HTML and JSON are always whole)
    #[arg(long)]
    pub full: bool,
}

/// The flags of `bound`.
#[derive(Args, Debug)]
pub struct BoundArgs {
    /// Plant (.json, .jsonc, .toml), or a certificate of one, or `-` for standard input
    #[arg(value_name = "PLANT", value_hint = ValueHint::FilePath)]
    pub plant: PathBuf,

    /// Write the specification to this file; standard output if absent
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,

    #[command(flatten)]
    pub replace: Replace,

    /// The domain: |y| <= X and |e| <= E [default: a quarter larger than what the certificate of the plant needs]
    #[arg(long, value_name = "X,E", allow_hyphen_values = true)]
    pub domain: Option<String>,

    /// Say nothing on standard error but errors
    #[arg(short, long)]
    pub quiet: bool,
}

/// A choice of transfer constants.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum TransferArg {
    /// The proof for a matched base frequency if the file asserts one, else boxes
    Best,
    /// Proved by boxes, valid for every base frequency
    Boxes,
    /// A closed form, valid for every base frequency; its bound is larger
    ClosedForm,
}
