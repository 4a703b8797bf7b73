//! `sigmastar reproduce`.

use super::args::{PartArg, ReproduceArgs};
use super::constants;
use super::failure::Failure;
use super::files::Input;
use super::output;
use super::progress::Bar;
use sigmastar_document::{Extent, Readable};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::Specification;
use sigmastar_paper::reproduce::{FIGURE_FILES, Parts, ReproductionReport, ReproductionSettings, figures, reproduce};

/// The plant of the paper's numerical example.
const PAPER_PLANT: &str = include_str!("../../specs/plants/paper-example.json");

/// The bounding functions that it is said to have.
const PAPER_BOUNDS: &str = include_str!("../../specs/paper-example.json");

/// Runs the command and returns the exit code.
pub fn run(args: &ReproduceArgs) -> Result<u8, Failure> {
    let has = |part| args.only.is_empty() || args.only.contains(&part);
    let parts = Parts {
        table_1: has(PartArg::Table1),
        table_2: has(PartArg::Table2),
        noise: has(PartArg::Noise),
        figures: has(PartArg::Figures),
    };
    let settings = ReproductionSettings { parts, seeds: u64::from(args.seeds), noise_steps: args.noise_steps as usize };
    let mut files = vec!["report.json", "report.html", "report.md"];
    files.extend(FIGURE_FILES.iter().filter(|_| parts.figures));
    args.replace.folder(&args.output, &files)?;
    let bar = Bar::new(settings.work(), args.quiet);
    let plant = Plant::from_json("specs/plants/paper-example.json", PAPER_PLANT)?;
    let reproduction = reproduce(&plant, settings, &bar);
    bar.finish();
    let figures = if parts.figures { figures(&plant) } else { Vec::new() };
    args.replace.figures(&args.output, &figures, Input::None, "leave the figures out with --only")?;
    let bounds = Specification::from_json("specs/paper-example.json", PAPER_BOUNDS)?;
    let constants = if has(PartArg::Constants) { constants::beside(&bounds) } else { None };
    let report = ReproductionReport { reproduction: &reproduction, figures: &figures, constants };
    let markdown = report.markdown(Extent::Full);
    let files = [
        ("report.json", output::json_text(&report.json())),
        ("report.html", report.html()),
        ("report.md", markdown.clone()),
    ];
    for (name, text) in files {
        args.replace.file(&args.output.join(name), Input::None, "the report")?.write(text)?;
    }
    Ok(output::data(&markdown).err().unwrap_or(0))
}
