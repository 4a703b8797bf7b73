//! Reports in the formats of the program.

use sigmastar_document::{Extent, Made, Readable};
use sigmastar_prove::reduction::Run;
use sigmastar_report::{Origin, run_report};
use std::fmt;

/// The form of a report. The content is the same in each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ReportFormat {
    /// Plain text, at most 100 columns wide where it can be.
    Text,
    /// GitHub-flavoured Markdown.
    Markdown,
    /// One HTML page that needs no other file.
    Html,
    /// JSON, for other programs (`docs/formats.md`).
    Json,
}

/// A report, to be written in any form. The bytes are those of `sigmastar` with `--format` and, where there is a short form, `--full`.
#[derive(Clone)]
pub struct Report {
    made: Box<Made>,
}

impl Report {
    pub(super) fn of(report: &dyn Readable) -> Report {
        Report { made: Box::new(Made::of(report)) }
    }

    /// That of `sigmastar certify`; `again` where a witness was decided again.
    pub(super) fn of_run(run: &Run<'_>, again: bool) -> Report {
        let origin = if again { Origin::Witness } else { Origin::Search };
        Report::of(&*run_report(run, &[], origin, Extent::Full))
    }

    pub(super) fn new(made: Made) -> Report {
        Report { made: Box::new(made) }
    }

    /// The report as text of this form.
    #[must_use]
    pub fn render(&self, format: ReportFormat) -> String {
        match format {
            ReportFormat::Text => self.made.text(Extent::Full),
            ReportFormat::Markdown => self.made.markdown(Extent::Full),
            ReportFormat::Html => self.made.html(),
            ReportFormat::Json => super::json_text(&self.made.json()),
        }
    }
}

impl fmt::Debug for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Report").finish_non_exhaustive()
    }
}

impl fmt::Display for Report {
    /// As plain text.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(ReportFormat::Text))
    }
}
