//! `sigmastar simulate`.

use super::args::SimulateArgs;
use super::failure::Failure;
use super::files::Input;
use super::input;
use super::output::{self, shown};
use super::parameters;
use super::progress::Bar;
use super::simulate_call::{Called, at_period, gain_remarks, nominal, ordinary, told, wanted};
use super::simulate_sampled;
use sigmastar::program::run_loop;
use sigmastar_lab::simulate::{ClosedLoop, FIGURE_FILES, Integrator, Noise, NoiseSettings, SimulationSettings};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::Constant;
use sigmastar_regulator::{Design, Regulator, read_regulator};

/// Runs the command and returns the exit code.
pub fn run(args: &SimulateArgs) -> Result<u8, Failure> {
    let called = Called::read(args)?;
    match called.step {
        None => in_continuous_time(args, called.plant, called.sigma.as_ref()),
        Some(step) => simulate_sampled::run(args, called.plant, called.sigma.as_ref(), &step),
    }
}

fn in_continuous_time(args: &SimulateArgs, plant: Plant, sigma: Option<&Constant>) -> Result<u8, Failure> {
    let csv_file = args.replace.asked(args.csv.as_deref(), Input::Plant(&args.plant), "the samples")?;
    let power = args.noise_power.as_deref().map(|text| input::positive("--noise-power", text)).transpose()?;
    let gain = args.input_gain.as_deref().map(|text| input::positive("--input-gain", text)).transpose()?;
    let member = at_period(args, parameters::member(&plant, &args.parameter, args.quiet)?)?;
    let regulator = match (&args.controller, sigma, args.oscillators()) {
        (Some(path), ..) => read_regulator(&input::written(path)?)?,
        (None, Some(sigma), Some(oscillators)) => {
            Design::new(&plant.internal_model, sigma, oscillators).for_actuator(plant.input_gain.as_ref()).regulator()
        }
        (None, Some(sigma), None) => Regulator::high_gain(sigma.to_f64()).for_actuator(nominal(&plant)),
        (None, None, _) => return Err(Failure::call("no regulator is given", "give --sigma or --controller")),
    };
    let power = power.map(|power| power.to_f64());
    let period = member.period.nominal().to_f64();
    if !regulator.is_representable()
        || !power.is_none_or(|power| power > 0.0 && power.is_finite())
        || !period.is_normal()
    {
        let help = "use units of time in which the gains, frequencies and the period have ordinary magnitudes";
        return Err(Failure::call("a number of this simulation is beyond double precision", help));
    }
    if let Some(folder) = &args.plots {
        args.replace.folder(folder, &FIGURE_FILES)?;
    }
    let entry = if args.noise_everywhere { Noise::Everywhere } else { Noise::Printed };
    let settings = SimulationSettings {
        periods: args.periods as usize,
        integrator: args.fixed.map_or(Integrator::Adaptive, |steps| Integrator::Fixed(steps as usize)),
        samples: args.samples as usize,
        noise: power.map(|power| (NoiseSettings { power, seed: args.seed }, entry)),
        noise_steps: args.noise_steps as usize,
        harmonics: args.coefficients as usize,
    };
    if !args.quiet {
        remarks(&plant, &regulator, &settings, args);
        gain_remarks(&plant, gain.as_ref(), &regulator);
    }
    // The regulator is that of the file, the plant may be another member of its family.
    let plant = member;
    let closed_loop = ClosedLoop::new(&plant, regulator);
    let closed_loop = match &gain {
        Some(gain) => closed_loop.with_input_gain(ordinary(gain)?),
        None => closed_loop,
    };
    let runs = if power.is_some() { 2 } else { 1 };
    let bar = Bar::new(u64::from(args.periods) * runs, args.quiet);
    let simulation = run_loop(&plant, &closed_loop, &settings, wanted(args), &bar)?;
    bar.finish();
    told(args, &simulation, csv_file.as_ref())
}

/// What is done otherwise than the call may suggest.
fn remarks(plant: &Plant, regulator: &Regulator, settings: &SimulationSettings, args: &SimulateArgs) {
    if let (Some(asked), Some(steps)) = (args.fixed, settings.fixed_steps())
        && steps != asked as usize
    {
        let samples = settings.samples;
        output::remark(&format!(
            "--fixed {asked} is raised to {steps} steps per period, a multiple of --samples {samples}"
        ));
    }
    let base = plant.internal_model.base_frequency.to_f64();
    if let (Some(path), Some(first)) = (&args.controller, regulator.frequencies.first())
        // The file holds the exact number rounded once.
        && (first - base).abs() > 1e-12 * base
    {
        output::remark(&format!(
            "the base frequency of `{}` is {first}, that of the plant file is {base}: the regulator is simulated as it is",
            shown(path)
        ));
    }
}
