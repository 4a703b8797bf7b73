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

    /// Certify a gain that keeps |e| of the periodic solution at most V (the smallest found), for every n_o, or with --n-o for the numbers
    /// of LIST, which often needs a far smaller gain
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    pub steady_error: Option<String>,

    /// Certify a gain that keeps |e| at most V in the transient from the initial set (the smallest found), for every n_o, or with --n-o for the
    /// numbers of LIST
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    pub peak_error: Option<String>,

    /// Certify a gain that keeps the control, with `input_gain` over `nominal`, at most V in the transient from the initial set (the
    /// smallest found), for every n_o, or with --n-o for the numbers of LIST
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    pub max_control: Option<String>,

    /// Certify a gain with which the rates for the numbers of --n-o are at least V, in 1/time (the smallest found)
    #[arg(long, value_name = "V", allow_hyphen_values = true, requires = "n_o")]
    pub rate: Option<String>,

    /// Certify the regulator at samples this far apart, an exact positive constant; sets or replaces `sampling_period`
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

    /// Write figures (SVG) into this folder, if certified: |e| and u of a simulation, beside what is proved of them
    #[arg(long, value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    pub plots: Option<PathBuf>,

    #[command(flatten)]
    pub replace: Replace,

    /// Find the smallest n_o that certifies sup|e| <= V, of all bounds by the number of oscillators, an exact constant such as `1e-3` or `1/1000`
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    pub target_sup: Option<String>,

    /// Find the smallest n_o that certifies rms(e) <= V, of all bounds by the number of oscillators, an exact constant such as `1e-3` or `1/1000`
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    pub target_rms: Option<String>,

    /// Prove for each of these numbers of oscillators (at most 8, up to 100), at the gain of the claim alone, a rate and a factor with
    /// |e - e_per| <= factor exp(-rate (t - t_0)) in the undisturbed loop, and with `measurement`, `disturbance` or, at samples, `arithmetic` in FILE what these do
    /// to e in the limit and in the transient, and put them into the certificate; e.g. `0,4,10`. Where the report has bounds by the number of
    /// oscillators, these are among them
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    pub n_o: Option<String>,

    /// Certify for every finite set of harmonics that contains 0, and show bounds for oscillators at these, such as `0,1,5,7`; several times for several
    /// sets. It sets or replaces `harmonics` of the internal model
    #[arg(long, value_name = "LIST", value_parser = harmonics(MAX_OSCILLATORS, MAX_OSCILLATORS))]
    pub harmonics: Vec<Oscillators>,

    /// Highest working precision in bits, 128 to 4096
    #[arg(long, value_name = "BITS", default_value_t = CertifyOptions::LARGEST_PRECISION_LIMIT,
          value_parser = clap::value_parser!(u32).range(i64::from(CertifyOptions::LEAST_PRECISION_LIMIT)..=4096))]
    pub precision_limit: u32,

    /// Leave out what other choices would give: bounds at larger gains, what intervals of parameters cost, a limit that can be kept, a smaller
    /// initial set where a plant is not certified; for a plant also the bounds by the number of oscillators, unless a limit such as `--peak-error` needs
    /// them; and, in a whole report and a certificate, the search of the paper's derivations
    #[arg(long, alias = "no-compare")]
    pub no_alternatives: bool,

    /// Tell the stages of the work on standard error, a line for each; on a terminal they are shown anyhow where it takes longer
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

    /// Specification or plant (.json; of .jsonc and .toml what `convert` writes) that the certificate has to be about: other data
    /// make it invalid
    #[arg(long, value_name = "SPEC", value_hint = ValueHint::FilePath)]
    pub spec: Option<PathBuf>,

    /// Sampling period with which `certify` was called: it goes into SPEC before the two are compared
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
    /// Bounding specification (.json, .jsonc, .toml) to look at each item from, or a certificate of one, or `-` for standard input
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

    /// The domain: |y| <= X and |e| <= E; if absent, one quarter larger than what the certificate of the plant needs
    #[arg(long, value_name = "X,E", allow_hyphen_values = true)]
    pub domain: Option<String>,

    /// Say nothing on standard error but errors
    #[arg(short, long)]
    pub quiet: bool,
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
