//! What `sigmastar simulate` is asked for: a plant, and of a certificate its gain and its samples where the call has none.

use super::args::SimulateArgs;
use super::failure::Failure;
use super::subject::Asked;
use super::{input, output};
use sigmastar_exact::number::write_exact;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::Constant;

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
