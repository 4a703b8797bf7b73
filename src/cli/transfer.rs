//! `sigmastar transfer`.

use super::args::{Replace, TransferArgs};
use super::counts::counts;
use super::failure::Failure;
use super::files::{Input, OutputFile};
use super::format::Format;
use super::output::Shortened;
use super::progress::Bar;
use super::subject::{Asked, Subject, proved};
use super::{input, output};
use sigmastar_document::progress::Progress;
use sigmastar_exact::enclosure::DEFAULT_PRECISION;
use sigmastar_prove::certify::Verdict;
use sigmastar_report::{TransferReport, pair_failure_json, transfer_figure};
use sigmastar_theory::transfer::{PairChoice, PairError, TransferStudy};
use std::path::Path;

/// Runs the command and returns the exit code.
pub fn run(args: &TransferArgs) -> Result<u8, Failure> {
    let plot = args.plot.as_deref().map(|path| svg_file(path, &args.spec, args.replace)).transpose()?;
    let pair = match (&args.k0, &args.minimise) {
        (Some(text), _) => PairChoice::SmallestK1(input::positive("--k0", text)?),
        (None, Some(text)) => {
            let Some((a, b)) = text.split_once(',') else {
                return Err(Failure::call(
                    format!("`{text}` are not two weights"),
                    "write --minimise A,B with positive constants, such as `--minimise 1,2/3`",
                ));
            };
            let [a, b] = [a, b].map(|text| input::positive("--minimise", text.trim()));
            PairChoice::Cheapest { a: a?, b: b? }
        }
        (None, None) => PairChoice::ForData,
    };
    let n_o = counts(&args.n_o)?;
    let spec = match Asked::read(&args.spec)?.subject()? {
        Subject::Specification(spec) => *spec,
        plant @ Subject::Plant(_) => proved(plant, args.quiet)?.0,
    };
    let bar = Bar::new(n_o.len() as u64, args.quiet);
    let study = TransferStudy::new(&spec, DEFAULT_PRECISION, &pair, &n_o, || bar.advance());
    bar.finish();
    let study = match study {
        Ok(study) => study,
        Err(error) => return Ok(no_pair(args, &error)),
    };
    if let Some(file) = &plot {
        let svg = transfer_figure(&study).svg();
        let svg = svg.map_err(|error| Failure::call(error.to_string(), "leave --plot out, and report this"))?;
        file.write(&svg)?;
        if !args.quiet {
            output::remark(&format!("the plot is in `{}`", file.name()));
        }
    }
    let shown = Shortened::new(&TransferReport(&study), args.format, args.full);
    Ok(shown.show(args.quiet).err().unwrap_or(Verdict::Certified.exit_code()))
}

/// The file of the plot, whose name says what is in it.
pub fn svg_file(path: &Path, input: &Path, replace: Replace) -> Result<OutputFile, Failure> {
    let file = replace.file(path, Input::Specification(input), "the plot")?;
    if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("svg")) {
        return Ok(file);
    }
    let message = format!("`{}` does not end in `.svg`, and the plot is written as SVG only", file.name());
    Err(Failure::call(message, "name a file that ends in `.svg`; other programs turn it into PNG or PDF"))
}

/// Says why there is no pair, and returns the exit code.
fn no_pair(args: &TransferArgs, error: &PairError) -> u8 {
    let verdict = if error.is_refuted() { Verdict::Refuted } else { Verdict::Undecided };
    if args.format == Format::Json {
        let text = output::json_text(&pair_failure_json(verdict, error));
        return output::data(&text).err().unwrap_or(verdict.exit_code());
    }
    output::error(&error.to_string(), error.way_out());
    output::remark(&verdict.to_string());
    verdict.exit_code()
}
