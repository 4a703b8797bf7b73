//! The first line of a file of results: of which study, and which part of it.

use super::row::{text, texts};
use super::{MAX_CASES, Sweep};
use serde_json::json;
use sigmastar_lang::spec::{Document, ErrorKind, Errors, Object, Reported, SpecErrors};

/// The format of a file of results.
pub(super) const FORMAT: &str = "sigmastar/sweep";
/// The version that is written and read.
pub(super) const VERSION: u64 = 1;

/// Every n-th case, from the i-th on, counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    part: u64,
    of: u64,
}

impl Shard {
    /// Shard `part` of `of`; `None` where there is no such part, or more of them than a study has cases.
    #[must_use]
    pub fn new(part: u64, of: u64) -> Option<Shard> {
        ((1..=of).contains(&part) && of <= MAX_CASES).then_some(Shard { part, of })
    }

    /// Reads `i/n`.
    #[must_use]
    pub fn read(text: &str) -> Option<Shard> {
        let (part, of) = text.split_once('/')?;
        Shard::new(part.trim().parse().ok()?, of.trim().parse().ok()?)
    }

    /// Whether a case is in it.
    #[must_use]
    pub fn has(self, index: u64) -> bool {
        index % self.of == self.part - 1
    }

    fn text(self) -> String {
        format!("{}/{}", self.part, self.of)
    }
}

/// The first line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Header {
    /// The version of the program that made the rows.
    pub tool: String,
    /// The name of the study.
    pub name: String,
    /// SHA-256 of the study with the subject in it.
    pub study_sha256: String,
    /// SHA-256 of the subject.
    pub subject_sha256: String,
    /// How many cases the whole study has.
    pub cases: u64,
    /// The pointers and names of the parameters.
    pub parameters: Vec<(String, String)>,
    /// The part of the study, if not all of it.
    pub shard: Option<Shard>,
}

impl Header {
    /// That of a sweep.
    #[must_use]
    pub fn new(sweep: &Sweep, shard: Option<Shard>) -> Header {
        let parameters = &sweep.study.parameters;
        Header {
            tool: env!("CARGO_PKG_VERSION").to_owned(),
            name: sweep.study.name.clone(),
            study_sha256: sweep.study_sha256.clone(),
            subject_sha256: sweep.subject_sha256.clone(),
            cases: sweep.count(),
            parameters: parameters.iter().map(|at| (at.pointer.clone(), at.name.clone())).collect(),
            shard,
        }
    }

    /// Whether a case is to be in the file.
    #[must_use]
    pub fn has(&self, index: u64) -> bool {
        index < self.cases && self.shard.is_none_or(|shard| shard.has(index))
    }

    /// The line, without its end.
    #[must_use]
    pub fn line(&self) -> String {
        let parameters: Vec<_> =
            self.parameters.iter().map(|(pointer, name)| json!({ "pointer": pointer, "name": name })).collect();
        json!({
            "format": FORMAT, "version": VERSION,
            "tool": { "name": "sigmastar", "version": self.tool },
            "name": self.name, "study_sha256": self.study_sha256, "subject_sha256": self.subject_sha256,
            "cases": self.cases, "parameters": parameters, "shard": self.shard.map(Shard::text),
        })
        .to_string()
    }

    /// Reads a line that was written so.
    ///
    /// # Errors
    /// What is wrong with it.
    pub(super) fn read(line: &str) -> Result<Header, SpecErrors> {
        let document = Document::parse("line", line)?;
        document.root().read(|root, errors| read(root.object(errors)?, errors))
    }
}

fn read(mut object: Object<'_>, errors: &mut Errors) -> Result<Header, Reported> {
    object.header(FORMAT, &[VERSION], errors)?;
    let tool = object.required("tool", errors).and_then(|value| {
        let mut tool = value.object(errors)?;
        tool.required("name", errors)?;
        let version = tool.required("version", errors).and_then(|value| text(&value, errors));
        tool.finish(errors);
        version
    });
    let [name, study, subject] = ["name", "study_sha256", "subject_sha256"]
        .map(|field| object.required(field, errors).and_then(|value| text(&value, errors)));
    let cases = object.required("cases", errors).and_then(|value| {
        let cases = value.integer(errors)?;
        if cases <= MAX_CASES {
            return Ok(cases);
        }
        Err(errors.report(value.error(ErrorKind::Limit, format!("{cases} cases; a study has at most {MAX_CASES}"))))
    });
    let parameters = object.required("parameters", errors).and_then(|value| value.array(errors)).and_then(|list| {
        list.iter()
            .map(|value| texts(value, ["pointer", "name"], errors).map(Into::into))
            .collect::<Result<Vec<_>, Reported>>()
    });
    let shard = object.required("shard", errors).map(|value| value.text().and_then(Shard::read));
    object.finish(errors);
    Ok(Header {
        tool: tool?,
        name: name?,
        study_sha256: study?,
        subject_sha256: subject?,
        cases: cases?,
        parameters: parameters?,
        shard: shard?,
    })
}
