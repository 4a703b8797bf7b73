//! `sigmastar sweep`.

use super::args::{Replace, SweepArgs};
use super::failure::Failure;
use super::files::{Input, OutputFile};
use super::output::{reason, shown};
use super::progress::Bar;
use super::subject::Asked;
use super::{input, output};
use sigmastar_lang::spec::SpecErrors;
use sigmastar_prove::certify::Verdict;
use sigmastar_sweep::sweep::{
    FigureError, Header, Results, ResultsError, Row, Shard, Study, SubjectSource, Sweep, best, csv,
    run as certify_cases, summary, sweep_figure,
};
use std::fs::{File, OpenOptions};
use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// The largest file of results that is read, in bytes.
const MAX_RESULTS: u64 = 1 << 29;

/// Runs the command and returns the exit code.
pub fn run(args: &SweepArgs) -> Result<u8, Failure> {
    let study = Study::read(&input::document(&args.study)?)?;
    let subject = subject_path(&study, &args.study);
    let document = subject.as_deref().map(Asked::read).transpose()?.map(|asked| asked.document);
    let sweep = Sweep::new(study, document.as_ref())?;
    if let Some(index) = args.case {
        return one_case(&sweep, index);
    }
    let shard = args.shard.as_deref().map(shard).transpose()?;
    let files = Files::new(args, subject.as_deref())?;
    let header = Header::new(&sweep, shard);
    let mut results = match &files.results {
        Some((path, _)) => taken_over(&sweep, header, path)?,
        None => Results::new(header),
    };
    if files.plot.is_some() {
        // What cannot be drawn is said before any work is done.
        sweep_figure(&sweep, &results).map_err(|error| no_figure(&error))?;
    }
    let known = results.rows.len();
    let missing: Vec<u64> =
        (0..sweep.count()).filter(|index| results.header.has(*index) && !results.rows.contains_key(index)).collect();
    // A case that is too large to be read is said before any work is done.
    missing.iter().try_for_each(|index| sweep.case(*index).map(drop))?;
    let appended = match &files.results {
        // A line that was cut off is no longer there when the first one is appended.
        Some((path, file)) => {
            file.write(results.text())?;
            Some(Mutex::new(append(path)?))
        }
        None => None,
    };
    let rows = Mutex::new(Vec::new());
    let bar = Bar::new(missing.len() as u64, args.quiet);
    let done: Result<(), Failure> = certify_cases(&sweep, &missing, &bar, |row: Row| {
        if let (Some(file), Some((path, _))) = (&appended, &files.results) {
            // One call for a whole line: a process that is killed leaves whole lines, but for the last.
            let mut file = file.lock().unwrap_or_else(PoisonError::into_inner);
            file.write_all((row.line() + "\n").as_bytes()).map_err(|error| unwritable(path, &error))?;
        }
        rows.lock().unwrap_or_else(PoisonError::into_inner).push(row);
        Ok(())
    });
    bar.finish();
    done?;
    drop(appended);
    let computed = rows.into_inner().unwrap_or_else(PoisonError::into_inner);
    results.rows.extend(computed.into_iter().map(|row| (row.index, row)));
    if let Some((_, file)) = &files.results {
        file.write(results.text())?;
    }
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
    let mut text = summary(&results, args.minimise.is_some());
    text += &format!("taken over: {known}, computed: {}\n", missing.len());
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
    results: Option<(PathBuf, OutputFile)>,
    table: Option<OutputFile>,
    plot: Option<OutputFile>,
}

impl Files {
    /// Checks them before any work: none is read or written twice.
    fn new(args: &SweepArgs, subject: Option<&Path>) -> Result<Files, Failure> {
        // The results are gone on with, not replaced; a table and a plot are made anew.
        let going_on = Replace { force: true };
        let named = |path: &Option<PathBuf>, what: &str, replace: Replace| {
            let path = path.as_deref();
            if let (Some(path), Some(subject)) = (path, subject) {
                replace.file(path, Input::Specification(subject), what)?;
            }
            replace.asked(path, Input::Study(&args.study), what)
        };
        let all: Vec<&PathBuf> = [&args.output, &args.csv, &args.plot].into_iter().flatten().collect();
        let same =
            |a: &Path, b: &Path| a == b || a.canonicalize().is_ok_and(|a| b.canonicalize().is_ok_and(|b| a == b));
        for (index, path) in all.iter().enumerate() {
            if all[..index].iter().any(|other| same(path, other)) {
                let message = format!("`{}` is to be written twice", shown(path));
                return Err(Failure::call(message, "give each file a name of its own"));
            }
        }
        let results = named(&args.output, "the results", going_on)?;
        let plot = |path: &PathBuf| super::transfer::svg_file(path, &args.study, args.replace);
        let plot = args.plot.as_ref().map(plot).transpose()?;
        named(&args.plot, "the plot", args.replace)?;
        let table = named(&args.csv, "the table", args.replace)?;
        Ok(Files { results: args.output.clone().zip(results), table, plot })
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

fn shard(text: &str) -> Result<Shard, Failure> {
    Shard::read(text).ok_or_else(|| {
        let message = format!("`{text}` in --shard is no part of a study");
        Failure::call(message, "write i/n with i from 1 to n, such as `1/8` for the first of eight parts")
    })
}

/// The rows of the file that still hold: those of this study whose case is the same.
fn taken_over(sweep: &Sweep, header: Header, path: &Path) -> Result<Results, Failure> {
    let Some(bytes) = existing(path)?.filter(|bytes| !bytes.is_empty()) else { return Ok(Results::new(header)) };
    let mut results = Results::read(&shown(path), &bytes).map_err(|error| unreadable(&error))?;
    if results.header != header {
        let message = format!("`{}` has results of another study, shard or version of this program", shown(path));
        return Err(Failure::call(message, "name another file; a study that is changed is another study"));
    }
    let mut wrong: Option<SpecErrors> = None;
    results.rows.retain(|index, row| match sweep.case(*index) {
        Ok(case) => case.has(row),
        Err(errors) => {
            wrong = Some(errors);
            false
        }
    });
    wrong.map_or(Ok(results), |errors| Err(errors.into()))
}

/// What is in a file of results; `None` where there is none.
pub fn existing(path: &Path) -> Result<Option<Vec<u8>>, Failure> {
    let name = shown(path);
    let mut bytes = Vec::new();
    match File::open(path).and_then(|file| file.take(MAX_RESULTS + 1).read_to_end(&mut bytes)) {
        Ok(_) if bytes.len() as u64 > MAX_RESULTS => {
            let message = format!("`{name}` has more than {MAX_RESULTS} bytes");
            Err(Failure::call(message, "name a file that `sigmastar sweep -o` wrote"))
        }
        Ok(_) => Ok(Some(bytes)),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        Err(error) => {
            Err(Failure::call(format!("cannot read `{name}`: {}", reason(&error)), "check the permissions of the file"))
        }
    }
}

/// What is wrong with a file of results.
pub fn unreadable(error: &ResultsError) -> Failure {
    Failure::call(error.to_string(), error.help())
}

fn append(path: &Path) -> Result<File, Failure> {
    OpenOptions::new().append(true).open(path).map_err(|error| unwritable(path, &error))
}

fn unwritable(path: &Path, error: &std::io::Error) -> Failure {
    let message = format!("cannot write `{}`: {}; what is in it is kept", shown(path), reason(error));
    Failure::call(message, "make room, and run the same command again: it goes on where it stopped")
}

fn no_figure(error: &FigureError) -> Failure {
    Failure::call(error.to_string(), "leave --plot out; --csv writes a table for other programs")
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
