//! The report on a certification: what a person, or a script, reads about a run.

use super::{
    Origin, brief, conditions, consequences, constants, exact_regulation, for_n_o, gains, json, of_plant,
    relative_degree, sensitivity, sets, verdict,
};
use sigmastar_document::{Block, Extent, Readable, clean};
use sigmastar_prove::certify::Certification;
use sigmastar_theory::derivation::consequences::MAX_OSCILLATORS;
use sigmastar_theory::derivation::targets::{Consequences, Target};

/// Everything that a report is made from.
pub(super) struct Report<'r> {
    run: &'r Certification<'r>,
    consequences: Option<Consequences>,
    origin: Origin,
    unanswered: bool,
    extent: Extent,
}

impl<'r> Report<'r> {
    /// The report of a run, with answers to the targets. For a short form the paper's constants are not worked out.
    ///
    /// Guarantee: the certified figures in it follow from the conditions that the run proved; without a certified
    /// claim there are none.
    pub(super) fn new(run: &'r Certification<'r>, targets: &[Target], origin: Origin, extent: Extent) -> Report<'r> {
        let consequences = run.consequences(targets);
        let unanswered = consequences.is_none() && !targets.is_empty();
        Report { run, consequences, origin, unanswered, extent }
    }
}

impl Readable for Report<'_> {
    fn blocks(&self) -> Vec<Block> {
        let (run, rechecked) = (self.run, self.origin.is_given());
        let name = clean(&run.spec.name);
        let name = if name.is_empty() { "(no name)" } else { &name };
        let mut blocks = vec![Block::Title(format!("{name}: {}", run.verdict))];
        blocks.extend(verdict::section(run, rechecked));
        if self.unanswered {
            blocks.push(Block::says(consequences::UNANSWERED));
        }
        blocks.extend(self.consequences.iter().flat_map(|all| consequences::answers(&all.targets, MAX_OSCILLATORS)));
        blocks.extend(brief::of_run(run, self.consequences.as_ref(), self.origin));
        blocks.push(Block::Detail);
        blocks.extend(for_n_o::section(run));
        blocks.extend(verdict::detail(run));
        blocks.extend(sets::section(run));
        blocks.extend(of_plant::section(run.spec, run.claimed_set()));
        blocks.extend(conditions::section(run));
        if self.extent == Extent::Full {
            blocks.extend(constants::sections(run));
        }
        blocks.extend(sensitivity::section(run));
        blocks.extend(
            self.consequences.iter().flat_map(|all| consequences::section(run.spec, all, run.by_count.is_some())),
        );
        blocks.extend(gains::section(run));
        blocks.extend(exact_regulation::section(run, rechecked));
        blocks.extend(relative_degree::section(run));
        blocks
    }

    /// As JSON: `{"format": "sigmastar/report", "version": 1, ...}`.
    fn json(&self) -> serde_json::Value {
        json::report(self.run, self.consequences.as_ref(), self.origin.is_given())
    }
}
