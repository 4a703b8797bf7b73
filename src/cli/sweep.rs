//! `sigmastar sweep`.

use super::args::SweepArgs;
use super::failure::Failure;
use super::files::{Input, OutputFile};
use super::output::shown;
use super::progress::Bar;
use super::subject::Asked;
use super::{input, output};
use sigmastar::Verdict;
use sigmastar_studies::sweep::{
    FigureError, Results, Study, SubjectSource, Sweep, best, csv, run as certify_cases, summary, sweep_figure,
};
use std::path::{Path, PathBuf};

/// Runs the command and returns the exit code.
pub fn run(args: &SweepArgs) -> Result<u8, Failure> {
    let study = Study::read(&input::document(&args.study)?)?;
    let subject = subject_path(&study, &args.study);
    let document = subject.as_deref().map(Asked::read).transpose()?.map(|asked| asked.document);
    let sweep = Sweep::new(study, document.as_ref())?;
    if let Some(index) = args.case {
        return one_case(&sweep, index);
    }
    let files = Files::new(args, subject.as_deref())?;
    if files.plot.is_some() {
        // What cannot be drawn is said before any work is done.
        sweep_figure(&sweep, &Results::new(&sweep)).map_err(|error| no_figure(&error))?;
    }
    // A case that is too large to be read is said before any work is done.
    (0..sweep.count()).try_for_each(|index| sweep.case(index).map(drop))?;
    let bar = Bar::new(sweep.count(), args.quiet);
    let results = certify_cases(&sweep, &bar);
    bar.finish();
    if let Some(file) = &files.table {
        file.write(csv(&results))?;
    }
    if let Some(file) = &files.plot {
        draw(&sweep, &results, file)?;
    }
    let wrong = sweep.errors_of(results.rows.values(), document.as_ref());
    if !wrong.is_empty() {
        output::diagnostics(&wrong);
    }
    let text = summary(&results, args.minimise.is_some());
    let verdict = match args.minimise.is_some() && best(&results).is_none() {
        true => Verdict::Undecided,
        false => Verdict::Certified,
    };
    Ok(output::data(&text).err().unwrap_or(verdict.exit_code()))
}

/// The path of the subject, where the study does not have it in it: relative to the study, or to the current folder of a
/// study from standard input.
fn subject_path(study: &Study, path: &Path) -> Option<PathBuf> {
    match &study.subject {
        SubjectSource::Embedded(_) => None,
        SubjectSource::Path(subject) => {
            let folder = path.parent().filter(|_| path != Path::new("-"));
            Some(folder.map_or_else(|| PathBuf::from(subject), |folder| folder.join(subject)))
        }
    }
}

/// The files that are written.
struct Files {
    table: Option<OutputFile>,
    plot: Option<OutputFile>,
}

impl Files {
    /// Checks them before any work: none is read or written twice.
    fn new(args: &SweepArgs, subject: Option<&Path>) -> Result<Files, Failure> {
        let named = |path: &Option<PathBuf>, what: &str| {
            let path = path.as_deref();
            if let (Some(path), Some(subject)) = (path, subject) {
                args.replace.file(path, Input::Specification(subject), what)?;
            }
            args.replace.asked(path, Input::Study(&args.study), what)
        };
        let same =
            |a: &Path, b: &Path| a == b || a.canonicalize().is_ok_and(|a| b.canonicalize().is_ok_and(|b| a == b));
        if let (Some(table), Some(plot)) = (&args.output, &args.plot)
            && same(table, plot)
        {
            let message = format!("`{}` is to be written twice", shown(plot));
            return Err(Failure::call(message, "give each file a name of its own"));
        }
        let table = named(&args.output, "the table")?;
        let plot = |path: &PathBuf| super::transfer::svg_file(path, &args.study, args.replace);
        let plot = args.plot.as_ref().map(plot).transpose()?;
        named(&args.plot, "the plot")?;
        Ok(Files { table, plot })
    }
}

/// Writes a case as a document, for `certify`.
fn one_case(sweep: &Sweep, index: u64) -> Result<u8, Failure> {
    if index >= sweep.count() {
        let message = format!("there is no case {index}: the study has {}", sweep.count());
        return Err(Failure::call(message, "cases are counted from 0"));
    }
    let text = output::json_text(&sweep.case(index)?.document.root().to_json());
    Ok(output::data(&text).err().unwrap_or(Verdict::Certified.exit_code()))
}

fn no_figure(error: &FigureError) -> Failure {
    Failure::call(error.to_string(), "leave --plot out; the table is for other programs")
}

fn draw(sweep: &Sweep, results: &Results, file: &OutputFile) -> Result<(), Failure> {
    let figure = sweep_figure(sweep, results).map_err(|error| no_figure(&error))?;
    if figure.curves.is_empty() {
        output::remark(&format!("`{}` was not written: nothing is certified", file.name()));
        return Ok(());
    }
    file.write(figure.svg().map_err(|error| Failure::call(error.to_string(), "leave --plot out, and report this"))?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sigmastar_lang::spec::Document;

    #[test]
    fn a_subject_is_beside_its_study() {
        let text = r#"{ "format": "sigmastar/study", "version": 1, "name": "n", "subject": "../a.json", "design": "grid",
            "parameters": [{ "pointer": "/period", "values": [1] }] }"#;
        let study = Study::read(&Document::parse("study", text).unwrap()).unwrap();
        assert_eq!(subject_path(&study, Path::new("x/y.json")), Some(PathBuf::from("x/../a.json")));
        assert_eq!(subject_path(&study, Path::new("-")), Some(PathBuf::from("../a.json")));
    }
}
