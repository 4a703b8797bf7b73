//! What a person, or a script, reads about a run: text, Markdown and JSON with the same content.
//!
//! A [`Report`] is made of a [`Certification`] and of what follows from it. The sections make [`blocks`] that the two
//! renderers share; JSON is written from the same figures. Numbers that are claims are rounded outward; what is only
//! an estimate says so.

pub mod blocks;
mod conditions;
mod consequences;
mod constants;
mod errata;
mod exact_regulation;
mod failures;
mod json;
mod lyapunov;
mod markdown;
mod matrix_checks;
mod number;
mod obstacles;
mod printed;
mod rate;
mod relative_degree;
mod remarks;
mod sensitivity;
mod sets;
mod text;
mod transfer;
mod verdict;

pub use consequences::{Consequences, Target, TargetKind, TargetOutcome};
pub use errata::ErrataReport;
pub use failures::failure_json;
pub use json::{FORMAT, VERSION};
pub use lyapunov::LyapunovReport;
pub use markdown::render as markdown;
pub use rate::RateReport;
pub(crate) use remarks::remarks;
pub use text::render as text;
pub use transfer::{PairChoice, TransferReport, TransferRequest, plot_svg};
pub use verdict::sentence;

use crate::certify::Certification;
use blocks::{Block, clean};

/// A report that can be written in every format, with the same content in each.
pub trait Readable {
    /// The document that the renderers of text and Markdown share.
    fn blocks(&self) -> Vec<Block>;

    /// As JSON: numbers are strings, enclosures `["lo", "hi"]`.
    fn json(&self) -> serde_json::Value;

    /// As plain text, readable without colour at 100 columns.
    fn text(&self) -> String {
        text::render(&self.blocks())
    }

    /// As GitHub-flavoured Markdown.
    fn markdown(&self) -> String {
        markdown::render(&self.blocks())
    }
}

/// Everything that a report is made from.
pub struct Report<'r> {
    run: &'r Certification<'r>,
    consequences: Option<Consequences>,
    rechecked: bool,
    unanswered: bool,
}

impl<'r> Report<'r> {
    /// The report of a run, with answers to the targets.
    ///
    /// Guarantee: the certified figures in it follow from the conditions that the run proved; without a certified
    /// claim there are none.
    #[must_use]
    pub fn new(run: &'r Certification<'r>, targets: &[Target]) -> Report<'r> {
        let consequences = Consequences::new(run, targets);
        let unanswered = consequences.is_none() && !targets.is_empty();
        Report { run, consequences, rechecked: false, unanswered }
    }

    /// The same report, of a run that decided a given witness again and searched for nothing.
    #[must_use]
    pub fn rechecked(mut self, rechecked: bool) -> Report<'r> {
        self.rechecked = rechecked;
        self
    }
}

impl Readable for Report<'_> {
    fn blocks(&self) -> Vec<Block> {
        let run = self.run;
        let name = clean(&run.spec.name);
        let name = if name.is_empty() { "(no name)" } else { &name };
        let mut blocks = vec![Block::Title(format!("{name}: {}", run.verdict))];
        blocks.extend(verdict::section(run, self.rechecked));
        if self.unanswered {
            blocks.push(Block::says("The targets are not answered: without a certified gain there is no error bound."));
        }
        blocks.extend(sets::section(run));
        blocks.extend(conditions::section(run));
        blocks.extend(matrix_checks::section(run));
        blocks.extend(constants::section(run));
        blocks.extend(printed::section(run, self.rechecked));
        blocks.extend(sensitivity::section(run));
        blocks.extend(self.consequences.iter().flat_map(Consequences::section));
        blocks.extend(exact_regulation::section(run, self.rechecked));
        blocks.extend(relative_degree::section(run));
        blocks
    }

    fn json(&self) -> serde_json::Value {
        json::report(self)
    }
}
