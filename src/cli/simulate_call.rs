//! What `sigmastar simulate` is asked for: a plant, of a certificate its gain and its samples where the call has none, the
//! period and the gain of the actuator; and how it answers.

use super::args::SimulateArgs;
use super::failure::Failure;
use super::files::{Input, OutputFile};
use super::subject::Asked;
use super::{input, output};
use sigmastar::program::Wanted;
use sigmastar::{Simulation, Verdict};
use sigmastar_exact::number::write_exact;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Constant, InputGain};
use sigmastar_regulator::Regulator;

/// A call, with what a certificate adds to it.
pub struct Called {
    /// The plant of the file.
    pub plant: Plant,
    /// The gain; `None` where the regulator is that of a file.
    pub sigma: Option<Constant>,
    /// The sampling time, where the regulator at samples is asked for.
    pub step: Option<Constant>,
}

impl Called {
    /// Reads the plant. A file of `--controller` has its own gain: a certificate then is its plant alone.
    ///
    /// # Errors
    /// What is wrong with the file and the flags, and a call without a gain.
    pub fn read(args: &SimulateArgs) -> Result<Called, Failure> {
        let positive =
            |flag, text: &Option<String>| text.as_deref().map(|text| input::positive(flag, text)).transpose();
        let sigma = positive("--sigma", &args.sigma)?;
        let step = positive("--sampled", &args.sampled)?;
        let asked = Asked::read(&args.plant)?;
        let plant = asked.plant("`simulate`")?;
        let Some(given) = asked.given.filter(|_| args.controller.is_none()) else {
            if sigma.is_none() && args.controller.is_none() {
                let help =
                    "give --sigma, or --controller, or name a certificate of the plant, whose gain is taken then";
                return Err(Failure::call("no gain is given", help));
            }
            at_samples(args, step.as_ref())?;
            return Ok(Called { plant, sigma, step });
        };
        if let (Some(own), None) = (given.step(), &step) {
            let of_continuous_time = [
                ("--high-gain", args.high_gain),
                ("--fixed", args.fixed.is_some()),
                ("--noise-power", args.noise_power.is_some()),
                ("--noise-everywhere", args.noise_everywhere),
            ];
            if let Some((flag, _)) = of_continuous_time.into_iter().find(|(_, asked)| *asked) {
                let message = format!(
                    "the certificate is about the regulator at samples {} apart, and {flag} is of continuous time",
                    own.text
                );
                return Err(Failure::call(message, format!("leave {flag} out, or name the plant in its place")));
            }
        }
        let step = step.or_else(|| given.step().cloned());
        at_samples(args, step.as_ref())?;
        let sigma = sigma.unwrap_or_else(|| Constant::rational(given.sigma()));
        if !args.quiet && args.sigma.is_none() {
            let at = step.as_ref().map(|step| format!(", at samples {} apart", step.text)).unwrap_or_default();
            output::remark(&format!("sigma = {}, from the certificate{at}", write_exact(given.sigma())));
        }
        if let Some(far) = given.far_start(&plant).filter(|_| !args.quiet) {
            output::remark(&far.describe());
        }
        Ok(Called { plant, sigma: Some(sigma), step })
    }
}

/// What is made of the simulation beside its report.
pub fn wanted(args: &SimulateArgs) -> Wanted {
    Wanted { csv: args.csv.is_some(), figures: args.plots.is_some() }
}

/// Writes the files of a simulation, shows its report, and returns the exit code.
pub fn told(args: &SimulateArgs, simulation: &Simulation, csv_file: Option<&OutputFile>) -> Result<u8, Failure> {
    let text = output::report(simulation.report(), args.format);
    if let Some((file, table)) = csv_file.zip(simulation.csv()) {
        file.write(table)?;
    }
    if let Some(folder) = &args.plots {
        args.replace.figures(folder, simulation.figures(), Input::Plant(&args.plant), "leave --plots out")?;
    }
    if let Err(code) = output::data(&text) {
        return Ok(code);
    }
    if simulation.is_complete() {
        return Ok(0);
    }
    if !args.quiet {
        output::remark("undecided: a part of the simulation has no figures; the report says why and what to try");
    }
    Ok(Verdict::Undecided.exit_code())
}

/// Flags of the regulator at samples need a sampling time, from the call or from a certificate.
fn at_samples(args: &SimulateArgs, step: Option<&Constant>) -> Result<(), Failure> {
    let of_samples = [
        ("--delay-samples", args.delay_samples.is_some()),
        ("--delay", args.delay.is_some()),
        ("--quantise", !args.quantise.is_empty()),
        ("--saturation", args.saturation.is_some()),
        ("--phase", args.phase.is_some()),
    ];
    match of_samples.into_iter().find(|(_, asked)| *asked).filter(|_| step.is_none()) {
        None => Ok(()),
        Some((flag, _)) => Err(Failure::call(
            format!("{flag} is of the regulator at samples, and no sampling period is given"),
            "give --sampled H, or name a certificate of the regulator at samples, whose sampling period is taken then",
        )),
    }
}

/// The plant of a call with the period that is asked for.
///
/// # Errors
/// What is wrong with the period.
pub fn at_period(args: &SimulateArgs, plant: Plant) -> Result<Plant, Failure> {
    let period = args.period.as_deref().map(|text| input::positive("--period", text)).transpose()?;
    let Some(period) = period else { return Ok(plant) };
    let value = period.to_f64();
    let [low, high] = [plant.period.shortest(), plant.period.longest()];
    if !args.quiet && (value < low.to_f64() || value > high.to_f64()) {
        output::remark(&match plant.period.interval() {
            None => format!("the plant file states the period {}: no claim covers {}", low.text, period.text),
            Some(_) => format!(
                "the period {} is outside of `period`, from {} to {}: no claim covers it",
                period.text, low.text, high.text
            ),
        });
    }
    Ok(plant.at_period(&period))
}

/// The nominal gain of the actuator of a plant, where it states one.
pub fn nominal(plant: &Plant) -> Option<f64> {
    plant.input_gain.as_ref().map(|gain| gain.nominal.to_f64())
}

/// A gain in double precision.
///
/// # Errors
/// One that is beyond it.
pub fn ordinary(gain: &Constant) -> Result<f64, Failure> {
    let gain = gain.to_f64();
    if gain > 0.0 && gain.is_finite() {
        return Ok(gain);
    }
    Err(Failure::call("--input-gain is beyond double precision", "give a gain of an ordinary magnitude"))
}

/// What no claim covers of a gain of the actuator, and what does not fit it.
pub fn gain_remarks(plant: &Plant, gain: Option<&Constant>, regulator: &Regulator) {
    match (&plant.input_gain, gain) {
        (None, Some(_)) => {
            output::remark("the plant file states no `input_gain`: no claim about it covers another gain than 1");
        }
        (Some(InputGain { low, high, .. }), Some(gain)) => {
            let value = gain.to_f64();
            if value < low.to_f64() || value > high.to_f64() {
                output::remark(&format!(
                    "the gain {} is outside of `input_gain`, from {} to {}: no claim covers it",
                    gain.text, low.text, high.text
                ));
            }
        }
        (_, None) => {}
    }
    if regulator.divisor() != nominal(plant).unwrap_or(1.0) {
        output::remark(
            "the regulator is not divided by the nominal input gain of the plant file: it is simulated as it is",
        );
    }
}
