//! Parameter studies: many cases, each certified by itself, wherever it runs.

use super::error::{Error, ErrorKind};
use super::json_text;
use sigmastar_lang::spec::{self, Document, Notation};
use sigmastar_studies::sweep::{self, Case, Results, ResultsError, SubjectSource, Sweep, csv, solve};
use std::path::Path;

/// A study with its subject (`docs/formats.md`): what values go where. Its cases can be run in any order and in different
/// processes; their table is the bytes of `sigmastar sweep STUDY -o FILE`.
///
/// ```no_run
/// # fn main() -> Result<(), sigmastar::Error> {
/// use sigmastar::Study;
/// # let text: &[u8] = b"";
/// let study = Study::from_bytes("study.json", text, |path| std::fs::read(path).map_err(|error| error.to_string()))?;
/// let lines = (0..study.cases()).map(|index| study.run_case(index)).collect::<Result<Vec<_>, _>>()?;
/// println!("{}", study.results(lines.iter().map(String::as_str))?);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Study {
    sweep: Sweep,
}

/// One case of a study.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct StudyCase {
    /// Its number, from 0 on.
    pub index: u64,
    /// The names of the parameters and their values, exactly.
    pub values: Vec<(String, String)>,
    /// The document with the values in it, which [`certify`](sigmastar_prove::certify) takes.
    pub json: String,
    /// SHA-256 of the document.
    pub sha256: String,
}

impl Study {
    /// Reads a study from the bytes of its file; `name` is what errors call it, and its ending says the notation, as that of the subject's path
    /// does (`Subject::from_bytes`). `subject` is asked for the bytes of the
    /// subject, by its path in the study, where the study does not have it in it.
    ///
    /// # Errors
    /// What is wrong with the study or its subject, and the reason that `subject` gives.
    pub fn from_bytes(
        name: &str,
        bytes: &[u8],
        subject: impl FnOnce(&str) -> Result<Vec<u8>, String>,
    ) -> Result<Study, Error> {
        let study = sweep::Study::read(&Document::from_bytes_as(name, bytes, Notation::of(Path::new(name)))?)?;
        let document = match &study.subject {
            SubjectSource::Embedded(_) => None,
            SubjectSource::Path(path) => match subject(path) {
                Ok(bytes) => Some(Document::from_bytes_as(path, &bytes, Notation::of(Path::new(path)))?),
                Err(reason) => {
                    let message = format!("the subject `{path}` was not read: {reason}");
                    let kind = spec::ErrorKind::Unreadable;
                    return Err(study.source.errors_at("/subject", &(0..0), kind, message, None).into());
                }
            },
        };
        Ok(Study { sweep: Sweep::new(study, document.as_ref())? })
    }

    /// Its name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.sweep.study.name
    }

    /// How many cases there are.
    #[must_use]
    pub fn cases(&self) -> u64 {
        self.sweep.count()
    }

    /// One case.
    ///
    /// # Errors
    /// [`Range`](ErrorKind::Range) beyond the last one; a document that is too large with these values.
    pub fn case(&self, index: u64) -> Result<StudyCase, Error> {
        let case = self.made(index)?;
        let names = self.sweep.study.parameters.iter().map(|parameter| parameter.name.clone());
        Ok(StudyCase {
            index,
            values: names.zip(case.values).collect(),
            json: json_text(&case.document.root().to_json()),
            sha256: case.sha256,
        })
    }

    /// Certifies one case and returns it as a line, without a line feed, from which [`Study::results`] makes the table. Nothing is an error here that the line
    /// tells: a case that is refused or not certified has a line that says why.
    ///
    /// # Errors
    /// Those of [`Study::case`].
    pub fn run_case(&self, index: u64) -> Result<String, Error> {
        Ok(solve(&self.made(index)?).line())
    }

    /// The table of results (CSV) from the lines of all cases, in any order: the bytes of `sigmastar sweep STUDY -o FILE`.
    ///
    /// # Errors
    /// [`Results`](ErrorKind::Results): a line that is not of this study or not as it was written, two that contradict each
    /// other, a case without a line.
    pub fn results<'l>(&self, lines: impl IntoIterator<Item = &'l str>) -> Result<String, Error> {
        let refused = |error: ResultsError| Error::new(ErrorKind::Results, error.to_string(), error.help());
        Results::of_lines(&self.sweep, lines).map_err(refused).map(|results| csv(&results))
    }

    fn made(&self, index: u64) -> Result<Case, Error> {
        if index >= self.cases() {
            let message = format!("there is no case {index}: the study has {}", self.cases());
            return Err(Error::new(ErrorKind::Range, message, "cases are counted from 0"));
        }
        Ok(self.sweep.case(index)?)
    }
}
