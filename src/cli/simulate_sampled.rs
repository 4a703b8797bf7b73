//! `sigmastar simulate --sampled`.

use super::args::SimulateArgs;
use super::failure::Failure;
use super::files::Input;
use super::input;
use super::output::{self, shown};
use super::parameters;
use super::progress::Bar;
use super::simulate_call::{at_period, gain_remarks, ordinary, told, wanted};
use sigmastar::program::run_sampled_loop;
use sigmastar_lab::simulate::{Converters, FIGURE_FILES, SampledLoop, SampledSettings};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Actuator, Constant};
use sigmastar_regulator::{Design, Discrete, Regulator, read_discrete, read_regulator};

/// Runs the command with this plant, gain and sampling time, and returns the exit code.
///
/// # Errors
/// What is wrong with the call or its files.
pub fn run(args: &SimulateArgs, plant: Plant, sigma: Option<&Constant>, step: &Constant) -> Result<u8, Failure> {
    let csv_file = args.replace.asked(args.csv.as_deref(), Input::Plant(&args.plant), "the samples")?;
    let converters = converters(args, step)?;
    let limit = args.saturation.as_deref().map(|text| input::positive("--saturation", text)).transpose()?;
    let phase = args.phase.as_deref().map(|text| input::nonnegative("--phase", text)).transpose()?;
    let gain = args.input_gain.as_deref().map(|text| input::positive("--input-gain", text)).transpose()?;
    let member = at_period(args, parameters::member(&plant, &args.parameter, args.quiet)?)?;
    let (regulator, discrete) = match (&args.controller, sigma, args.oscillators()) {
        (Some(_), ..) => from_file(args, step)?,
        (None, Some(sigma), Some(oscillators)) => {
            let design = Design::new(&plant.internal_model, sigma, oscillators).for_actuator(plant.input_gain.as_ref());
            let delayed = args.delay_samples.map_or(design.is_delayed(), |count| count == 1);
            let design = design.with_delay(delayed);
            if !args.quiet {
                for error in design.sampling_errors(step) {
                    output::remark(&format!("{error}; it is simulated as it is"));
                }
            }
            (design.regulator(), design.discretise(step).ok_or_else(beyond)?)
        }
        _ => {
            return Err(Failure::call(
                "no regulator is given",
                "give --sigma and --n-o or --harmonics, or --controller",
            ));
        }
    };
    if discrete.prediction.is_some() && converters.delay > 0.0 {
        let help = "leave --delay out, or take the law without a delay: --delay-samples 0";
        return Err(Failure::call(
            "the law with a delay puts its control out at the next sample: --delay is not for it",
            help,
        ));
    }
    // What is cut off by the actuator the law is told, as its export is.
    let limit =
        limit.map(|limit| limit.to_f64()).or(plant.actuator.as_ref().map(Actuator::limit)).or(discrete.saturation);
    let discrete = discrete.saturated(limit);
    if !args.quiet {
        gain_remarks(&plant, gain.as_ref(), &regulator);
    }
    let plant = member;
    let sampled = SampledLoop::new(&plant, regulator, discrete);
    let mut sampled = match &gain {
        Some(gain) => sampled.with_input_gain(ordinary(gain)?),
        None => sampled,
    };
    (sampled.converters, sampled.phase) = (converters, phase.map_or(0.0, |phase| phase.to_f64()));
    let ordinary = sampled.regulator.is_representable() && sampled.discrete.is_representable();
    if !ordinary || !sampled.period().is_normal() || !sampled.phase.is_finite() {
        return Err(beyond());
    }
    if let Some(folder) = &args.plots {
        args.replace.folder(folder, &FIGURE_FILES)?;
    }
    let settings = SampledSettings {
        periods: args.periods as usize,
        samples: args.samples as usize,
        harmonics: args.coefficients as usize,
    };
    let bar = Bar::new(u64::from(args.periods), args.quiet);
    let simulation = run_sampled_loop(&plant, &sampled, &settings, wanted(args), &bar)?;
    bar.finish();
    told(args, &simulation, csv_file.as_ref())
}

fn beyond() -> Failure {
    let help = "use units of time in which the gains, frequencies, times and limits have ordinary magnitudes";
    Failure::call("a number of this simulation is beyond double precision", help)
}

fn converters(args: &SimulateArgs, step: &Constant) -> Result<Converters, Failure> {
    let delay = args.delay.as_deref().map(|text| input::nonnegative("--delay", text)).transpose()?;
    let quanta = args.quantise.iter().map(|text| input::positive("--quantise", text)).collect::<Result<Vec<_>, _>>()?;
    let quanta: Vec<f64> = quanta.iter().map(Constant::to_f64).collect();
    if quanta.len() > 2 {
        return Err(Failure::call("--quantise has more than two values", "give QE for e, or QE,QU for e and u"));
    }
    let delay = delay.map_or(0.0, |delay| delay.to_f64());
    // Both are rounded once, so equal constants stay equal.
    if delay > step.to_f64() {
        let message = format!("the delay {delay} is longer than the sampling time {}", step.to_f64());
        return Err(Failure::call(message, "a control that takes longer needs a longer sampling time: 0 <= D <= H"));
    }
    if quanta.iter().any(|quantum| !quantum.is_normal()) {
        return Err(beyond());
    }
    Ok(Converters { delay, measured: quanta.first().copied(), put_out: quanta.get(1).copied() })
}

/// The regulator and its law from a file of `controller`.
fn from_file(args: &SimulateArgs, step: &Constant) -> Result<(Regulator, Discrete), Failure> {
    let Some(path) = &args.controller else { return Err(beyond()) };
    let document = input::written(path)?;
    let regulator = read_regulator(&document)?;
    let name = shown(path);
    let Some(discrete) = read_discrete(&document)? else {
        let message = format!("`{name}` has no law at samples");
        return Err(Failure::call(message, "write it with `controller --discretise`, or give --sigma and --n-o"));
    };
    if discrete.step != step.to_f64() {
        let message = format!("the law in `{name}` is for the sampling time {}, not {}", discrete.step, step.to_f64());
        return Err(Failure::call(message, "give that one to --sampled, or export the regulator for the other"));
    }
    if discrete.dimension() != regulator.dimension() + usize::from(discrete.prediction.is_some()) {
        let message = format!("the law in `{name}` is not of the dimension of its regulator");
        return Err(Failure::call(message, "export the regulator again"));
    }
    Ok((regulator, discrete))
}
