//! The results of a study: a row for each case.

use super::Sweep;
use super::row::Row;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use thiserror::Error;

/// The rows of a study, by their index.
#[derive(Clone, Debug)]
pub struct Results {
    /// The name of the study.
    pub name: String,
    /// The names of its parameters.
    pub parameters: Vec<String>,
    /// How many cases it has.
    pub cases: u64,
    /// The rows.
    pub rows: BTreeMap<u64, Row>,
}

/// What is wrong with lines of results.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum ResultsError {
    /// A line is none that was written.
    #[error("line {line} is no result: {reason}")]
    Line {
        /// The line, from 1 on.
        line: usize,
        /// Why.
        reason: String,
    },
    /// Two lines say different things of one case.
    #[error("line {line} says of case {index} another thing than a line before it")]
    Contradiction {
        /// The later line, from 1 on.
        line: usize,
        /// The case.
        index: u64,
    },
    /// A line that was made from another document.
    #[error("line {line} is not of case {index} of this study as it is now")]
    OtherCase {
        /// The line, from 1 on.
        line: usize,
        /// The case that it names.
        index: u64,
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
            ResultsError::Line { .. } | ResultsError::Contradiction { .. } => {
                "leave this line out, and run its case again"
            }
            ResultsError::OtherCase { .. } => {
                "a study or subject that is changed is another study: run its cases again"
            }
            ResultsError::Missing { .. } => "run the cases that are missing",
        }
    }
}

impl Results {
    /// No rows yet.
    #[must_use]
    pub fn new(sweep: &Sweep) -> Results {
        let study = &sweep.study;
        Results {
            name: study.name.clone(),
            parameters: study.parameters.iter().map(|parameter| parameter.name.clone()).collect(),
            cases: sweep.count(),
            rows: BTreeMap::new(),
        }
    }

    /// The rows of all cases of a sweep from their lines, in any order.
    ///
    /// # Errors
    /// A line that is not as it is written, of a case that the sweep does not have, or of another document than that case; two
    /// lines that contradict each other; a case without a line.
    pub fn of_lines<'l>(sweep: &Sweep, lines: impl IntoIterator<Item = &'l str>) -> Result<Results, ResultsError> {
        let mut results = Results::new(sweep);
        for (at, text) in lines.into_iter().enumerate() {
            let line = at + 1;
            let row = row(text).map_err(|reason| ResultsError::Line { line, reason })?;
            let index = row.index;
            if index >= results.cases {
                let reason = format!("there is no case {index}");
                return Err(ResultsError::Line { line, reason });
            }
            if !sweep.case(index).is_ok_and(|case| case.has(&row)) {
                return Err(ResultsError::OtherCase { line, index });
            }
            match results.rows.entry(index) {
                Entry::Occupied(known) if *known.get() != row => {
                    return Err(ResultsError::Contradiction { line, index });
                }
                Entry::Occupied(_) => {}
                Entry::Vacant(place) => drop(place.insert(row)),
            }
        }
        results.complete()?;
        Ok(results)
    }

    /// Whether every case has its row.
    fn complete(&self) -> Result<(), ResultsError> {
        let cases = self.cases;
        let missing = cases.saturating_sub(self.rows.len() as u64);
        match (0..cases).find(|index| !self.rows.contains_key(index)) {
            Some(first) => Err(ResultsError::Missing { missing, cases, first }),
            None => Ok(()),
        }
    }
}

/// A row from a line, if it is written so.
fn row(line: &str) -> Result<Row, String> {
    let row = Row::read(line).map_err(|errors| errors.to_string())?;
    if row.line() == line { Ok(row) } else { Err("it is not as it was written".to_owned()) }
}
