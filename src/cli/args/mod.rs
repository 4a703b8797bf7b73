//! The one table of commands and flags: help, completions and the manual page are made from it. The commands are here, their
//! flags in `claims`, `studies`, `regulator` and `files`.

mod claims;
mod files;
mod regulator;
mod studies;

pub use claims::{
    BoundArgs, CertifyArgs, CheckArgs, ConstantsArgs, ErrataArgs, LyapunovArgs, SamplingArgs, TransferArgs,
};
pub use files::{ConvertArgs, NewArg, NewArgs, SchemaArgs};
pub use regulator::{ControllerArgs, FalsifyArgs, PartArg, RegulatorForm, ReproduceArgs, SimulateArgs};
pub use studies::{DesignArgs, SweepArgs, TuneArgs, TuneGoal};

use clap::{Args, ColorChoice, CommandFactory, Parser, Subcommand};
use clap_complete::Shell;

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
  sigmastar certify plant.json --peak-error 2 -o plant.certificate.json
  sigmastar certify plant.json --witness plant.certificate.json
  sigmastar certify plant.json --sampling-period 1/1000 --sigma 60
  sigmastar certify - --format json < plant.json";

/// Examples of `design`.
const DESIGN_EXAMPLES: &str = "Examples:
  sigmastar design plant.json
  sigmastar design plant.json --steady-error 0.01 --peak-error 2 --max-control 50 -o plant.certificate.json
  sigmastar design plant.json --steady-error 0.01 --settle 20 --n-o 0,2,4,6
  sigmastar design plant.json --sigma 20,40,80 --sampling-period 1/1000
  sigmastar design plant.json --steady-error 0.01 --choose mu --sampling-periods";

/// Examples of `sampling`.
const SAMPLING_EXAMPLES: &str = "Examples:
  sigmastar sampling plant.json
  sigmastar sampling plant.json --sampling-period 1/200,1/1000 --sigma 50,100 --plot sampling.svg";

/// Examples of `sweep`.
const SWEEP_EXAMPLES: &str = "Examples:
  sigmastar sweep specs/studies/linear.json -o results.csv --minimise sigma_star --plot gains.svg
  sigmastar sweep study.json --case 17 | sigmastar certify - -o case17.certificate.json";

/// Examples of `tune`.
const TUNE_EXAMPLES: &str = "Examples:
  sigmastar tune plant.json
  sigmastar tune plant.json --over mu=1/10..10,n0,epsilon --minimise feedback -o tuned.json
  sigmastar tune plant.json --over mu --error-at 10";

/// Examples of `transfer`.
const TRANSFER_EXAMPLES: &str = "Examples:
  sigmastar transfer plant.json
  sigmastar transfer plant.json --k0 1/2 --n-o 0..10,inf
  sigmastar transfer plant.json --sets
  sigmastar transfer plant.json --minimise 1,2/3 --plot bound.svg";

/// Examples of `bound`.
const BOUND_EXAMPLES: &str = "Examples:
  sigmastar bound plant.json
  sigmastar bound plant.json --domain 0.5,2 -o spec.json";

/// Examples of `controller`.
const CONTROLLER_EXAMPLES: &str = "Examples:
  sigmastar controller plant.certificate.json --n-o 4 --discretise 1/1000 --format c -o regulator.c --example
  sigmastar controller plant.json --sigma 48 --n-o 4 --format matlab -o regulator.m";

/// Examples of `new`.
const NEW_EXAMPLES: &str = "Examples:
  sigmastar new plant -o plant.jsonc
  sigmastar certify plant.jsonc
  sigmastar new study -o study.toml
  sigmastar sweep study.toml -o results.csv --minimise sigma_star";

/// Examples of `convert`.
const CONVERT_EXAMPLES: &str = "Examples:
  sigmastar convert spec.toml -o spec.json
  sigmastar convert spec.toml | sigmastar check spec.certificate.json --spec -";

/// Examples of simulations.
pub const SIMULATE_EXAMPLES: &str = "Examples:
  sigmastar simulate plant.json --sigma 2 --n-o 4
  sigmastar simulate plant.json --sigma 2 --high-gain --plots figures
  sigmastar simulate plant.json --sigma 2 --n-o 4 --sampled 1/1000 --delay 1/2000 --saturation 20
  sigmastar simulate plant.json --controller controller.json --noise-power 1e-3 --seed 7
  sigmastar simulate plant.certificate.json --n-o 4";

/// Examples of `falsify`.
const FALSIFY_EXAMPLES: &str = "Examples:
  sigmastar falsify plant.certificate.json
  sigmastar falsify plant.certificate.json --trials 1000 --seed 7 -o counterexample.json
  sigmastar falsify plant.certificate.json --trial 12 -o trial12.json
  sigmastar falsify plant.certificate.json --harmonics 0,1,5,7,11,13
  sigmastar falsify family.certificate.json --parameter k=4.4";

/// Certified gains for output regulation: from a plant's formulas, or bounding functions of it, to a gain that provably works
/// for every number of oscillators.
#[derive(Debug, Parser)]
#[command(name = "sigmastar", version, after_long_help = EXIT_CODES, max_term_width = 100)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,

    /// Colours of diagnostics and help; `auto`: on a terminal, unless NO_COLOR is set
    #[arg(long, global = true, value_enum, value_name = "WHEN", default_value_t = ColorChoice::Auto)]
    pub color: ColorChoice,
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
    /// Certify a gain for a plant or a bounding specification
    ///
    /// Searches for the smallest gain sigma*, decides every condition in rigorous arithmetic, and reports what is
    /// proved. The report goes to standard output, remarks and errors to standard error.
    #[command(after_help = CERTIFY_EXAMPLES, after_long_help = format!("{CERTIFY_EXAMPLES}\n\n{EXIT_CODES}"))]
    Certify(Box<CertifyArgs>),
    /// Find which gain and how many oscillators to take for your requirements
    ///
    /// Makes a table of several gains with several numbers of oscillators. Each row has proved bounds of the steady error, of the largest error
    /// and control, and a rate. Each row is a claim that the independent checker decides.
    ///
    /// With requirements the report names the smallest gain of the table at which all are proved to be met, and the fewest oscillators at this
    /// gain. Where the file states noise, a disturbance or rounding, the requirements are about the loop with them; with an `actuator` or
    /// `delay_samples` 1 they are about the loop without them. Exit code 3 says that a requirement is not proved.
    ///
    /// Without requirements the report names the smallest gain that meets two conditions with each number of oscillators. First, the bound of
    /// the largest error is at most twice the larger of E0 and the bound of the steady error. Second, the proved rate is at least half of the
    /// largest one for that number.
    #[command(after_help = DESIGN_EXAMPLES, after_long_help = format!("{DESIGN_EXAMPLES}\n\n{EXIT_CODES}"))]
    Design(DesignArgs),
    /// Show which gains go with which sampling periods: the smallest gain for a period, the longest period for a gain
    ///
    /// Each pair is certified as by `certify --sampling-period H --sigma V`. A pair keeps to an `actuator` only if the conditions of the claim
    /// prove it; bounds by the number of oscillators are not tried. A gain is certified for its sampling period only. Nothing follows for a
    /// larger gain or a shorter period.
    #[command(after_help = SAMPLING_EXAMPLES, after_long_help = format!("{SAMPLING_EXAMPLES}\n\n{EXIT_CODES}"))]
    Sampling(SamplingArgs),
    /// Certify a specification or plant for many values of its numbers: a grid or a Latin hypercube
    ///
    /// Each case is certified by itself, as `certify` does it, on all cores of this machine. Each is a row of one table. Nothing is claimed
    /// between the cases, and no certificates are written. With the Python package a study can run on several machines.
    #[command(after_help = SWEEP_EXAMPLES)]
    Sweep(SweepArgs),
    /// Look for values of mu, the weights and other free numbers with a smaller certified gain
    ///
    /// Each proposal is certified by itself, as `certify` does it. The search runs over the logarithms of the numbers within their ranges, from
    /// several starts. The report says what the better values cost: a smaller sigma* may come with a larger mu Nbar^2.
    #[command(after_help = TUNE_EXAMPLES, after_long_help = format!("{TUNE_EXAMPLES}\n\n{EXIT_CODES}"))]
    Tune(TuneArgs),
    /// Prove the transfer bound T(x) <= k0 + k1 x^2 for every number of oscillators
    ///
    /// Finds constants k0, k1 that are proved for every n_o and every frequency. Shows how much of the bound each n_o uses,
    /// and compares the paper's constants with it. This program proves the bound with enclosures; no independent program checks it.
    #[command(after_help = TRANSFER_EXAMPLES, after_long_help = format!("{TRANSFER_EXAMPLES}\n\n{TRANSFER_EXIT_CODES}"))]
    Transfer(TransferArgs),
    /// Check a certificate with the independent checker
    ///
    /// Decides the claim again from the certificate alone, with none of the code that made it. It is the same as the program
    /// `proofs-check`. The answer says what is proved, of which specification, and what is assumed.
    ///
    /// Exit codes: 0 valid, 1 invalid, 2 bad-input, 3 undecided.
    Check(CheckArgs),
    /// Write the regulator of a specification, plant or certificate: matrices, the law for a computer, C code
    ///
    /// Every number is the exact one, rounded once to double precision (the limit of an actuator is rounded up). For a certificate the gain is
    /// its sigma*, unless --sigma gives another. Only a certificate with a sampling period covers the sampling. The command refuses what is
    /// known to be bad: samples that cannot tell the oscillators apart, DT sigma > 1, or a gain below sigma* of the certificate.
    #[command(after_help = CONTROLLER_EXAMPLES)]
    Controller(ControllerArgs),
    /// Simulate a plant with a regulator: steady state, long run, measurement noise
    ///
    /// Floating point, no claim. The report goes to standard output; --csv and --plots write files.
    #[command(after_help = SIMULATE_EXAMPLES)]
    Simulate(Box<SimulateArgs>),
    /// Reproduce the tables and figures of the paper
    ///
    /// Floating point, no claim. Writes report.md, report.html, report.json and the figures into a folder.
    Reproduce(ReproduceArgs),
    /// Try to break a certificate by simulation
    ///
    /// Draws plants within the bounding functions, or takes the plant of the certificate. Each trial starts on the boundary of the initial set
    /// and checks every bound of the claim, a little above sigma*; a claim at samples is tried with exactly its gain. If no counterexample is
    /// found, nothing is proved. If one is found, the exit code is 1 and `-o` writes its plant file.
    #[command(after_help = FALSIFY_EXAMPLES)]
    Falsify(FalsifyArgs),
    /// List what is wrong in the paper, with evidence
    ///
    /// With a specification, also says what each item means for it.
    Errata(ErrataArgs),
    /// The paper's constants for a bounding specification, printed and repaired, beside the proved ones
    ///
    /// Shows every formula of the paper as it is printed, with the smallest sound repair, and as it is in the proof of the claim. Beside them
    /// are Sylvester's criterion, the spectral radius and the matrix inequalities. The whole report of `certify` has the same table.
    #[command(after_long_help = EXIT_CODES)]
    Constants(ConstantsArgs),
    /// Find and prove the Lyapunov triple of a Jacobian, or the orbit of a plant
    ///
    /// Prints P, the triple that is proved for every t, and the Floquet exponents (floating point). Of a plant it proves the periodic solution
    /// of its zero dynamics and the rate along it.
    Lyapunov(LyapunovArgs),
    /// Write a bounding specification for a plant: polynomials in X and E, each proved
    ///
    /// For reading and editing. The file has bounds of f, q and their derivatives on a domain that it states. They are relative to
    /// the periodic solution x_0(t), in the coordinates of the certificate. `certify` takes the file, and finds a larger gain than
    /// for the plant itself.
    #[command(after_help = BOUND_EXAMPLES)]
    Bound(BoundArgs),
    /// Write a commented template that works as it stands
    ///
    /// A specification or a plant, for `certify`, or a study, for `sweep`, in JSON with comments (.jsonc) or TOML (.toml), each field
    /// explained: change the values.
    #[command(after_help = NEW_EXAMPLES)]
    New(NewArgs),
    /// Write a specification, plant or study as JSON, whatever its notation
    ///
    /// Numbers keep their text. The independent checker reads JSON only: convert a .toml or .jsonc file for it.
    #[command(after_help = CONVERT_EXAMPLES)]
    Convert(ConvertArgs),
    /// Write the JSON Schema of a file to standard output
    ///
    /// For editors and validators (draft 2020-12). The schema knows fields and types; `certify` may still refuse a file that it accepts.
    Schema(SchemaArgs),
    /// Write a completion script for a shell to standard output
    Completions {
        /// The shell
        #[arg(value_name = "SHELL")]
        shell: Shell,
    },
    /// Write the manual page (roff) to standard output
    Man,
}

/// The flag of every command that writes files.
#[derive(Args, Clone, Copy, Debug)]
pub struct Replace {
    /// Replace files that exist already
    #[arg(long)]
    pub force: bool,
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
            "certify s --n-o -1",
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
