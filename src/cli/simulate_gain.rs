//! The gain of the actuator and the period in `sigmastar simulate`.

use super::args::SimulateArgs;
use super::failure::Failure;
use super::{input, output};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Constant, InputGain};
use sigmastar_regulator::Regulator;

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
