//! `sigmastar rate`.

use super::args::RateArgs;
use super::certify::triple;
use super::counts::finite_counts;
use super::failure::Failure;
use super::{input, output};
use sigmastar::certificate::{Options, Verdict, certify};
use sigmastar::data::Data;
use sigmastar::rate::{MAX_OSCILLATORS, rates};
use sigmastar::report::{RateReport, bounding_errors, filter_errors};
use sigmastar::spec::Specification;

/// Runs the command and returns the exit code.
pub fn run(args: &RateArgs) -> u8 {
    attempt(args).unwrap_or_else(|failure| failure.tell(args.format, false))
}

fn attempt(args: &RateArgs) -> Result<u8, Failure> {
    let n_o = finite_counts(&args.n_o, MAX_OSCILLATORS)?;
    let mut spec = Specification::from_value(&input::document(&args.spec)?.root())?;
    let sigma = args.sigma.as_ref().map(|text| input::positive("--sigma", text)).transpose()?;
    let sigma = sigma.map(|sigma| {
        let help = "write it as a decimal or a fraction";
        sigma.as_rational().cloned().ok_or_else(|| Failure::call("--sigma is not a rational number", help))
    });
    let sigma = sigma.transpose()?;
    if let Some(proved) = triple(&spec, None, false)? {
        spec = proved;
    }
    let run = certify(&spec, Options { compare: false, ..Options::default() }).map_err(|problems| {
        Failure::Documents(problems.iter().map(|problem| bounding_errors(&spec, problem)).collect())
    })?;
    if let Some(errors) = filter_errors(&run) {
        return Err(errors.into());
    }
    let (Some(sigma_star), Some(proof)) = (run.sigma_star(), run.sharp.proved()) else {
        output::remark(&format!(
            "{}: without a certified gain there are no rates; see `sigmastar certify`",
            run.verdict
        ));
        return Ok(run.verdict.exit_code());
    };
    if let Some(reason) = &run.no_plant {
        // A rate of all of them would be one of a plant without x.
        output::remark(&format!("{}: {reason}; there are no rates", Verdict::Undecided));
        return Ok(Verdict::Undecided.exit_code());
    }
    let sigma = sigma.unwrap_or_else(|| sigma_star.clone());
    if sigma < *sigma_star {
        let message = format!("--sigma is below the certified sigma* = {}", sigmastar::number::write_exact(sigma_star));
        return Err(Failure::call(message, "give a gain of at least sigma*, or leave the flag out for sigma* itself"));
    }
    let data = Data::new(&spec, proof.precision);
    let found = rates(&data, proof, &sigma, &n_o);
    let Some(report) = RateReport::new(&run, &sigma, found) else { return Ok(Verdict::Undecided.exit_code()) };
    let text = output::report(&report, args.format);
    Ok(output::data(&text).map_or_else(|code| code, |()| 0))
}
