//! `sigmastar sampling`.

use super::args::SamplingArgs;
use super::failure::Failure;
use super::files::OutputFile;
use super::output;
use super::progress::working;
use super::subject::{Asked, seeking_triple};
use super::transfer::svg_file;
use sigmastar::program::{PairsPart, pairs_of};
use sigmastar::{SamplingPairs, Verdict};

/// Runs the command and returns the exit code.
pub fn run(args: &SamplingArgs) -> Result<u8, Failure> {
    let plot = args.plot.as_deref().map(|path| svg_file(path, &args.spec, args.replace)).transpose()?;
    let subject = Asked::read(&args.spec)?.subject()?;
    let [periods, sigmas] = [&args.sampling_period, &args.sigma]
        .map(|list| list.as_ref().map(|list| list.split(',').map(str::trim).collect::<Vec<_>>()));
    let waiting = |part| match part {
        PairsPart::Triple => seeking_triple("", args.quiet),
        PairsPart::OfSpecification => working("certifying pairs of a gain and a sampling period", "", args.quiet),
        PairsPart::OfPlant => working("finding the orbit, proving the bounds of every pair", "", args.quiet),
    };
    let lists = [periods.as_deref(), sigmas.as_deref()];
    let pairs = pairs_of(subject, lists, ["--sampling-period", "--sigma"], waiting)?;
    if let Some(file) = &plot {
        draw(&pairs, file, args.quiet)?;
    }
    let text = output::report(pairs.report(), args.format);
    let verdict = if pairs.has_pair() { Verdict::Certified } else { Verdict::Undecided };
    Ok(output::data(&text).err().unwrap_or(verdict.exit_code()))
}

fn draw(pairs: &SamplingPairs, file: &OutputFile, quiet: bool) -> Result<(), Failure> {
    if !pairs.has_pair() {
        output::remark(&format!("`{}` was not written: nothing is certified", file.name()));
        return Ok(());
    }
    let svg = pairs.figure().svg();
    file.write(svg.map_err(|error| Failure::call(error.to_string(), "leave --plot out, and report this"))?)?;
    if !quiet {
        output::remark(&format!("the plot is in `{}`", file.name()));
    }
    Ok(())
}
