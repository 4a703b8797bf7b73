//! `sigmastar transfer`.

use super::args::{Replace, TransferArgs};
use super::counts::counts;
use super::failure::Failure;
use super::files::{Input, OutputFile};
use super::output::{Format, Shortened};
use super::progress::Bar;
use super::subject::{Asked, Subject, proving};
use super::{input, output};
use sigmastar::program::{PairError, transfer_of};
use sigmastar::{TransferOptions, Verdict};
use sigmastar_document::progress::Progress;
use sigmastar_report::pair_failure_json;
use std::path::Path;

/// Runs the command and returns the exit code.
pub fn run(args: &TransferArgs) -> Result<u8, Failure> {
    let plot = args.plot.as_deref().map(|path| svg_file(path, &args.spec, args.replace)).transpose()?;
    let options = TransferOptions::new();
    let options = match (&args.k0, &args.minimise) {
        (Some(text), _) => options.k0(input::positive("--k0", text)?.text),
        (None, Some(text)) => {
            let Some((a, b)) = text.split_once(',') else {
                return Err(Failure::call(
                    format!("`{text}` are not two weights"),
                    "write --minimise A,B with positive constants, such as `--minimise 1,2/3`",
                ));
            };
            let [a, b] = [a, b].map(|text| input::positive("--minimise", text.trim()));
            options.cheapest(a?.text, b?.text)
        }
        (None, None) => options,
    };
    let options = if args.sets { options.every_set() } else { options };
    let n_o = counts(&args.n_o)?;
    let subject = Asked::read(&args.spec)?.subject()?;
    // The internal model needs no Lyapunov triple.
    let spec = match subject {
        Subject::Specification(spec) => *spec,
        plant @ Subject::Plant(_) => {
            let _working = proving(&plant, "", args.quiet);
            plant.proved().map_err(Failure::Documents)?.0
        }
    };
    let bar = Bar::new(n_o.len() as u64, args.quiet);
    let asked = options.n_o(n_o).checked()?;
    let study = transfer_of(&spec, &asked, plot.is_some(), || bar.advance());
    bar.finish();
    let (study, figure) = match study {
        Ok(found) => found,
        Err(error) => return Ok(no_pair(args, &error)),
    };
    if let Some((file, figure)) = plot.zip(figure) {
        let svg = figure.svg();
        let svg = svg.map_err(|error| Failure::call(error.to_string(), "leave --plot out, and report this"))?;
        file.write(&svg)?;
        if !args.quiet {
            output::remark(&format!("the plot is in `{}`", file.name()));
        }
    }
    let shown = Shortened::new(study.report(), args.format, args.full);
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
