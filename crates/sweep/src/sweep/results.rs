//! A file of results: a first line, then one line for each case.

use super::Sweep;
use super::header::Header;
use super::row::Row;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use thiserror::Error;

/// The rows of a file, by their index.
#[derive(Clone, Debug)]
pub struct Results {
    /// The first line.
    pub header: Header,
    /// The rows.
    pub rows: BTreeMap<u64, Row>,
    /// Whether a last line was cut off in its middle, and is left out.
    pub torn: bool,
}

/// What is wrong with files of results.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum ResultsError {
    /// The first line is none.
    #[error("`{file}` is no file of results: {reason}")]
    Header {
        /// The file.
        file: String,
        /// Why.
        reason: String,
    },
    /// A line is none that was written.
    #[error("line {line} of `{file}` is no result: {reason}")]
    Line {
        /// The file.
        file: String,
        /// The line, from 1 on.
        line: usize,
        /// Why.
        reason: String,
    },
    /// Two lines say different things of one case.
    #[error("`{file}` says of case {index} another thing than a line before it")]
    Contradiction {
        /// The file with the later line.
        file: String,
        /// The case.
        index: u64,
    },
    /// A line that was made from another document.
    #[error("a line of `{file}` is not of case {index} of this study as it is now")]
    OtherCase {
        /// Where the line is.
        file: String,
        /// The case that it names.
        index: u64,
    },
    /// Files of different studies.
    #[error("`{file}` is of another study than `{first}`")]
    OtherStudy {
        /// The file.
        file: String,
        /// The first file.
        first: String,
    },
    /// Cases without a line.
    #[error("{missing} of {cases} cases are missing, the first of them case {first}")]
    Missing {
        /// How many.
        missing: u64,
        /// How many there are to be.
        cases: u64,
        /// The first one.
        first: u64,
    },
}

impl ResultsError {
    /// What to do about it.
    #[must_use]
    pub fn help(&self) -> &'static str {
        match self {
            ResultsError::Header { .. } => "name a file that `sigmastar sweep -o` wrote, or a new one",
            ResultsError::Line { .. } | ResultsError::Contradiction { .. } => {
                "remove this line: `sigmastar sweep` works its case out again"
            }
            ResultsError::OtherCase { .. } => {
                "a study or subject that is changed is another study: run its cases again"
            }
            ResultsError::OtherStudy { .. } => {
                "shards are of one study, one subject and one version of this program; name the files of one study"
            }
            ResultsError::Missing { .. } => {
                "run the shards that are missing or not finished, or join what there is with --incomplete"
            }
        }
    }
}

impl Results {
    /// No rows yet.
    #[must_use]
    pub fn new(header: Header) -> Results {
        Results { header, rows: BTreeMap::new(), torn: false }
    }

    /// Reads a file, of which a process may have been killed while it wrote the last line.
    ///
    /// # Errors
    /// What is not as it is written, at its line.
    pub fn read(file: &str, bytes: &[u8]) -> Result<Results, ResultsError> {
        let name = || file.to_owned();
        // What follows the last line feed may be cut off anywhere, also within a character.
        let end = bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |at| at + 1);
        let (whole, rest) = bytes.split_at(end);
        let not_text = |_| ResultsError::Header { file: name(), reason: "it is not UTF-8".to_owned() };
        let mut lines = std::str::from_utf8(whole).map_err(not_text)?.lines();
        let no_header = |reason: String| ResultsError::Header { file: name(), reason };
        let first = lines.next().ok_or_else(|| no_header("it has no first line".to_owned()))?;
        let header = Header::read(first).map_err(|errors| no_header(errors.to_string()))?;
        if header.line() != first {
            return Err(no_header("its first line is not as it was written".to_owned()));
        }
        let mut results = Results::new(header);
        for (index, line) in lines.enumerate() {
            let wrong = |reason| ResultsError::Line { file: name(), line: index + 2, reason };
            results.add(row(line).map_err(wrong)?, file, index + 2)?;
        }
        if !rest.is_empty() {
            match std::str::from_utf8(rest).ok().and_then(|line| row(line).ok()) {
                Some(row) => results.add(row, file, whole.iter().filter(|byte| **byte == b'\n').count() + 1)?,
                None => results.torn = true,
            }
        }
        Ok(results)
    }

    /// The rows of a sweep from their lines, in any order; `name` is what errors call them.
    ///
    /// # Errors
    /// A line that is not as it is written, of a case that the sweep does not have, or of another document than that case; two
    /// lines that contradict each other.
    pub fn of_lines<'l>(
        sweep: &Sweep,
        name: &str,
        lines: impl IntoIterator<Item = &'l str>,
    ) -> Result<Results, ResultsError> {
        let mut results = Results::new(Header::new(sweep, None));
        for (line, text) in lines.into_iter().enumerate() {
            let wrong = |reason| ResultsError::Line { file: name.to_owned(), line: line + 1, reason };
            let row = row(text).map_err(wrong)?;
            let index = row.index;
            if results.header.has(index) && !sweep.case(index).is_ok_and(|case| case.has(&row)) {
                return Err(ResultsError::OtherCase { file: name.to_owned(), index });
            }
            results.add(row, name, line + 1)?;
        }
        Ok(results)
    }

    /// Whether every case has its row.
    ///
    /// # Errors
    /// Cases without a row.
    pub fn complete(&self) -> Result<(), ResultsError> {
        let cases = self.header.cases;
        let missing = cases.saturating_sub(self.rows.len() as u64);
        match (0..cases).find(|index| !self.rows.contains_key(index)) {
            Some(first) => Err(ResultsError::Missing { missing, cases, first }),
            None => Ok(()),
        }
    }

    /// Adds a row that is read.
    fn add(&mut self, row: Row, file: &str, line: usize) -> Result<(), ResultsError> {
        let index = row.index;
        if !self.header.has(index) || row.values.len() != self.header.parameters.len() {
            let reason =
                format!("case {index} with {} values does not belong to this study or shard", row.values.len());
            return Err(ResultsError::Line { file: file.to_owned(), line, reason });
        }
        match self.rows.entry(index) {
            Entry::Occupied(known) if *known.get() != row => {
                Err(ResultsError::Contradiction { file: file.to_owned(), index })
            }
            Entry::Occupied(_) => Ok(()),
            Entry::Vacant(place) => {
                place.insert(row);
                Ok(())
            }
        }
    }

    /// The file: the first line, and the rows by their index.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text = self.header.line() + "\n";
        for row in self.rows.values() {
            text.push_str(&row.line());
            text.push('\n');
        }
        text
    }
}

/// A row from a line, if it is written so.
fn row(line: &str) -> Result<Row, String> {
    let row = Row::read(line).map_err(|errors| errors.to_string())?;
    if row.line() == line { Ok(row) } else { Err("it is not as it was written".to_owned()) }
}

/// Files that are joined.
#[derive(Clone, Debug)]
pub struct Merge {
    first: String,
    results: Results,
}

impl Merge {
    /// Starts with a file; the result is of the whole study, whatever shard the file is.
    #[must_use]
    pub fn new(file: &str, first: Results) -> Merge {
        let header = Header { shard: None, ..first.header };
        Merge { first: file.to_owned(), results: Results { header, torn: false, ..first } }
    }

    /// Adds another file.
    ///
    /// # Errors
    /// It is of another study, or says something else of a case.
    pub fn add(&mut self, file: &str, more: Results) -> Result<(), ResultsError> {
        if (Header { shard: None, ..more.header }) != self.results.header {
            return Err(ResultsError::OtherStudy { file: file.to_owned(), first: self.first.clone() });
        }
        more.rows.into_values().try_for_each(|row| self.results.add(row, file, 0))
    }

    /// The joined rows; all of them, unless some may be missing.
    ///
    /// # Errors
    /// Cases without a line.
    pub fn finish(self, incomplete: bool) -> Result<Results, ResultsError> {
        if !incomplete {
            self.results.complete()?;
        }
        Ok(self.results)
    }
}
