//! `sigmastar reproduce`.

use super::args::{Format, PartArg, ReproduceArgs};
use super::failure::Failure;
use super::output::{self, Input, OutputFile};
use super::progress::Bar;
use sigmastar::reproduce::{Parts, Settings, figures, json, markdown, reproduce};
use std::path::Path;

/// Runs the command and returns the exit code.
pub fn run(args: &ReproduceArgs) -> u8 {
    attempt(args).unwrap_or_else(|failure| failure.tell(Format::Text, args.quiet))
}

fn attempt(args: &ReproduceArgs) -> Result<u8, Failure> {
    let has = |part| args.only.is_empty() || args.only.contains(&part);
    let parts = Parts {
        table_1: has(PartArg::Table1),
        table_2: has(PartArg::Table2),
        noise: has(PartArg::Noise),
        figures: has(PartArg::Figures),
    };
    let settings = Settings { parts, seeds: u64::from(args.seeds), noise_steps: args.noise_steps as usize };
    output::folder(&args.output)?;
    let bar = Bar::new(settings.work(), args.quiet);
    let reproduction = reproduce(settings, &bar)?;
    bar.finish();
    let figures = if parts.figures { figures()? } else { Vec::new() };
    let names: Vec<&str> = figures.iter().map(|(name, _)| *name).collect();
    for (name, figure) in &figures {
        let svg =
            figure.svg().map_err(|error| Failure::call(error.to_string(), "leave the figures out with --only"))?;
        write(&args.output, name, &svg)?;
    }
    let report = markdown(&reproduction, &names);
    write(&args.output, "report.json", &output::json_text(&json(&reproduction, &names)))?;
    write(&args.output, "report.md", &report)?;
    Ok(output::data(&report).map_or_else(|code| code, |()| 0))
}

fn write(folder: &Path, name: &str, text: &str) -> Result<(), Failure> {
    OutputFile::new(&folder.join(name), Input::None, "the report")?.write(text)
}
