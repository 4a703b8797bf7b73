//! Reports in the formats of the program.

use sigmastar_document::{Block, Extent, Made, Readable};
use sigmastar_lang::spec::Constant;
use sigmastar_prove::reduction::Run;
use sigmastar_report::{Origin, run_report};
use sigmastar_theory::derivation::targets::{Target, TargetKind};
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
        Report::of(&*report_of(run, [None, None], origin, Extent::Full))
    }

    /// Its parts, for a report that it is a part of.
    #[doc(hidden)]
    #[must_use]
    pub fn into_made(self) -> Made {
        *self.made
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

/// The report on a run, with answers to targets of sup|e| and rms e.
pub fn report_of<'r>(
    run: &'r Run<'r>,
    targets: [Option<Constant>; 2],
    origin: Origin,
    extent: Extent,
) -> Box<dyn Readable + 'r> {
    let kinds = [TargetKind::Sup, TargetKind::Rms].into_iter().zip(targets);
    let targets: Vec<Target> = kinds.filter_map(|(kind, value)| Some(Target { kind, value: value? })).collect();
    run_report(run, &targets, origin, extent)
}

/// For the program, which writes short forms, too.
#[doc(hidden)]
impl Readable for Report {
    fn blocks(&self) -> Vec<Block> {
        self.made.blocks()
    }

    fn json(&self) -> serde_json::Value {
        self.made.json()
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
