//! `sigmastar rate`.

use super::args::RateArgs;
use super::counts::finite_counts;
use super::failure::Failure;
use super::subject::{Asked, proved};
use super::{input, output};
use sigmastar_exact::number::write_exact;
use sigmastar_prove::certify::{
    Options, Verdict, WITHOUT_INPUT_GAIN, Wanted, certify_for, not_available_with_input_gain,
};
use sigmastar_report::RateReport;
use sigmastar_studies::rate::{MAX_OSCILLATORS, NoRates, certified_rates};

/// Runs the command and returns the exit code.
pub fn run(args: &RateArgs) -> Result<u8, Failure> {
    let n_o = finite_counts(&args.n_o, MAX_OSCILLATORS)?;
    let asked = Asked::read(&args.spec)?;
    let subject = asked.subject()?;
    let sigma = args.sigma.as_ref().map(|text| input::rational("--sigma", text)).transpose()?;
    if asked.given.as_ref().is_some_and(|given| given.step().is_some()) {
        let message =
            "this certificate is about the regulator at samples, and `rate` is about the one in continuous time";
        return Err(Failure::call(message, "`certify --n-o LIST` proves rates at samples"));
    }
    let whose = if sigma.is_some() { "--sigma" } else { "the gain of the certificate" };
    let sigma = sigma.or_else(|| asked.given.map(|given| given.sigma().clone()));
    if subject.input_gain().is_some_and(|gain| !gain.is_nominal()) {
        subject.without_input_gain("`rate`").map_err(Failure::Documents)?;
    }
    let (spec, start) = proved(subject, args.quiet)?;
    let wanted = Wanted { start: start.as_ref(), ..Wanted::default() };
    let run = certify_for(&spec, Options { compare: false, ..Options::default() }, wanted)
        .map_err(|refusal| Failure::Documents(refusal.errors(&spec)))?;
    let (sigma, found) = match certified_rates(&run, sigma, &n_o) {
        Ok(found) => found,
        Err(NoRates::BelowSigmaStar(sigma_star)) => {
            let message = format!("{whose} is below the certified sigma* = {}", write_exact(&sigma_star));
            let help = "give --sigma a gain of at least sigma*; without it, of a specification or plant, sigma* itself is taken";
            return Err(Failure::call(message, help));
        }
        Err(NoRates::OtherGain(sigma)) => {
            let message = format!("with `actuator` only sigma = {} is certified", write_exact(&sigma));
            return Err(Failure::call(message, "leave --sigma out, or `actuator`"));
        }
        Err(NoRates::InputGain) => {
            return Err(Failure::call(not_available_with_input_gain("`rate`"), WITHOUT_INPUT_GAIN));
        }
        Err(NoRates::NotCertified(verdict)) => {
            output::remark(&format!("{verdict}: without a certified gain there are no rates; see `sigmastar certify`"));
            return Ok(verdict.exit_code());
        }
        Err(NoRates::NoPlant(reason)) => {
            output::remark(&format!("{}: {reason}; there are no rates", Verdict::Undecided));
            return Ok(Verdict::Undecided.exit_code());
        }
    };
    let Some(report) = RateReport::new(&run, &sigma, found) else { return Ok(Verdict::Undecided.exit_code()) };
    let text = output::report(&report, args.format);
    Ok(output::data(&text).err().unwrap_or(0))
}
