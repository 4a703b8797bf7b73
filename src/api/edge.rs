//! The first figures of a claim: a simulation from the edge of its set, and what is proved.
//!
//! The laboratory draws them from the certificate; the verdict, the exit code and every text do not know of them.

use super::json_text;
use serde_json::Value;
use sigmastar_document::plot::Figure;
use sigmastar_document::{Block, Made, Readable};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lab::falsify::{Edge, ProvedBounds, Shown, TriedClaim, from_the_edge};
use sigmastar_lang::spec::Document;
use sigmastar_prove::certificate::certificate_of;
use sigmastar_prove::certify::ByCount;
use sigmastar_prove::reduction::Run;
use sigmastar_theory::derivation::control::Control;

/// The names of the files of the figures.
pub const FIGURE_FILES: [&str; 2] = ["error.svg", "control.svg"];

/// |e| and u, and what they are of; why there are none, where there is a claim.
pub struct Drawn {
    words: String,
    figures: Option<[Figure; 2]>,
}

impl Drawn {
    /// The figures of a run; nothing without a claim.
    pub fn of(run: &Run<'_>) -> Option<Drawn> {
        let (certificate, proved) = (certificate_of(run)?, proved(run)?);
        Some(match edge(&certificate, &shown(run)) {
            Ok(edge) => {
                let words = format!(
                    "Proved, of every solution from the set: the thick line holds at all times{}; what holds in the limit is drawn over the second half of the \
                     time that is shown, of |e| by thin lines, of |u| by a band. The other lines: a simulation {}, floating point, which proves nothing.",
                    if is_of_first(run) { " with every n_o" } else { "" },
                    edge.words
                );
                Drawn { words, figures: Some(edge.figures(&proved)) }
            }
            Err(why) => Drawn { words: format!("No simulation is drawn: {why}."), figures: None },
        })
    }

    /// A report with the figures behind what it says first.
    pub fn in_front_of_the_rest(self, report: &dyn Readable) -> Made {
        let mut blocks = report.blocks();
        let place = blocks.iter().position(|block| matches!(block, Block::Detail)).unwrap_or(blocks.len());
        let figures = self.figures.into_iter().flatten().map(Block::Drawing);
        blocks.splice(place..place, std::iter::once(Block::says(self.words)).chain(figures));
        Made::new(blocks, Value::Null)
    }

    /// The figures with the names of their files.
    ///
    /// # Errors
    /// In words: why there are none.
    pub fn named(&self) -> Result<Vec<(&'static str, Figure)>, String> {
        let figures = self.figures.clone().ok_or_else(|| self.words.clone())?;
        Ok(FIGURE_FILES.into_iter().zip(figures).collect())
    }
}

/// The numbers of oscillators where none are asked about, and how many of those that are.
const N_O: [u32; 3] = [0, 3, 10];
const MOST: usize = 4;

/// The numbers of oscillators that are asked about, or a few, each with what is proved of its steady error.
fn shown(run: &Run<'_>) -> Vec<Shown> {
    let asked: Vec<u32> = run.rates().into_iter().map(|(n_o, _)| n_o).take(MOST).collect();
    let numbers = if asked.is_empty() { N_O.to_vec() } else { asked };
    let bound = |n_o: u32| run.bounds_of(&n_o.into()).map(|bounds| bounds.steady_error.bound.upper_f64());
    numbers.into_iter().map(|n_o| (n_o, bound(n_o).filter(|bound| bound.is_finite()))).collect()
}

/// Whether the bounds at all times are of the first harmonics, and the claim of every set of them.
fn is_of_first(run: &Run<'_>) -> bool {
    let (by_count, every_set) = match run {
        Run::Continuous(run) => (&run.by_count, run.is_for_every_set()),
        Run::Sampled(run) => (&run.by_count, run.spec.internal_model.asks_every_set()),
    };
    every_set && by_count.as_ref().is_some_and(ByCount::is_about_all)
}

fn edge(certificate: &Value, shown: &[Shown]) -> Result<Edge, String> {
    let claim = Document::parse("certificate", &json_text(certificate));
    let claim = claim.and_then(|document| TriedClaim::from_document(&document));
    from_the_edge(&claim.map_err(|errors| errors.to_string())?, shown)
}

fn proved(run: &Run<'_>) -> Option<ProvedBounds> {
    let (steady, peak, control) = match run {
        Run::Continuous(run) => run.best_bounds()?,
        Run::Sampled(run) => run.best_bounds()?,
    };
    let Control { steady: along, transient } = &control;
    let [steady, error, along, largest] = [&steady, &peak, along, &(along + transient)].map(Enclosure::upper_f64);
    Some(ProvedBounds { error, control: [along, largest], steady })
}
