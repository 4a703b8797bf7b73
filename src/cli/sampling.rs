//! `sigmastar sampling`.

use super::args::SamplingArgs;
use super::failure::Failure;
use super::files::OutputFile;
use super::progress::working;
use super::subject::{Asked, Subject, proved};
use super::transfer::svg_file;
use super::{input, output};
use rug::Rational;
use sigmastar_lang::spec::{Constant, Sampling};
use sigmastar_prove::certify::Verdict;
use sigmastar_prove::reduction::with_sampled_pairs;
use sigmastar_studies::sampling::{OfPlant, OfSpecification, SamplingReport, SamplingStudy, Unfit, sampling_figure};

/// Runs the command and returns the exit code.
pub fn run(args: &SamplingArgs) -> Result<u8, Failure> {
    let plot = args.plot.as_deref().map(|path| svg_file(path, &args.spec, args.replace)).transpose()?;
    let subject = Asked::read(&args.spec)?.subject()?;
    let (name, sha256, period) =
        (subject.name().to_owned(), subject.sha256().to_owned(), subject.period().nominal().clone());
    if !subject.is_matched() {
        return Err(unfit(&Unfit::NotMatched));
    }
    let steps = args.sampling_period.as_deref().map(|list| steps(list, &period)).transpose()?;
    let gains = args.sigma.as_deref().map(gains).transpose()?;
    let study = match subject {
        Subject::Plant(plant) => {
            let _working = working("finding the orbit, proving the bounds of every pair", "", args.quiet);
            let study =
                with_sampled_pairs(&plant, |pairs| SamplingStudy::new(&OfPlant { pairs }, &period, steps, gains));
            study.map_err(|refusal| Failure::Documents(refusal.errors(&plant)))?
        }
        specification @ Subject::Specification(_) => {
            let spec = proved(specification, args.quiet)?.0;
            let _working = working("certifying pairs of a gain and a sampling period", "", args.quiet);
            SamplingStudy::new(&OfSpecification { spec: &spec }, &period, steps, gains)
        }
    };
    if let Some(file) = &plot {
        draw(&study, file, args.quiet)?;
    }
    let report = SamplingReport { study: &study, name: &name, sha256: &sha256 };
    let text = output::report(&report, args.format);
    let verdict = if study.has_pair() { Verdict::Certified } else { Verdict::Undecided };
    Ok(output::data(&text).err().unwrap_or(verdict.exit_code()))
}

fn draw(study: &SamplingStudy, file: &OutputFile, quiet: bool) -> Result<(), Failure> {
    if !study.has_pair() {
        output::remark(&format!("`{}` was not written: nothing is certified", file.name()));
        return Ok(());
    }
    let svg = sampling_figure(study).svg();
    file.write(svg.map_err(|error| Failure::call(error.to_string(), "leave --plot out, and report this"))?)?;
    if !quiet {
        output::remark(&format!("the plot is in `{}`", file.name()));
    }
    Ok(())
}

/// The sampling periods of a list, each with a whole number of them in the period.
fn steps(list: &str, period: &Constant) -> Result<Vec<Sampling>, Failure> {
    list.split(',')
        .map(|text| {
            let step = input::positive("--sampling-period", text.trim())?;
            let wrong = || Unfit::NoWholeMultiple { period: period.clone(), step: text.trim().to_owned() };
            Sampling::new(period, step).ok_or_else(|| unfit(&wrong()))
        })
        .collect()
}

fn unfit(unfit: &Unfit) -> Failure {
    Failure::call(unfit.to_string(), unfit.help())
}

fn gains(list: &str) -> Result<Vec<Rational>, Failure> {
    list.split(',').map(|text| input::rational("--sigma", text.trim())).collect()
}
