//! The page of a stored certificate: what the independent checker decided, and what the claim says, proved again from the witness.

use super::edge::Drawn;
use super::failure::Failure;
use super::output::shown;
use super::subject::Asked;
use sigmastar_document::{Block, Extent, Made, Readable};
use sigmastar_lang::spec::Document;
use sigmastar_prove::certificate::{is_stated, read_for, stated_counts};
use sigmastar_prove::certify::{NoRatesOfClaim, Options};
use sigmastar_prove::reduction::Prepared;
use sigmastar_report::{Origin, run_report};
use std::path::Path;

/// The page of a certificate that the checker found valid; `words` are the checker's. `None` where the claim that the witness proves here is
/// not the one that is stored.
///
/// # Errors
/// What keeps the certificate from being read, or its data from being proved.
pub fn page(path: &Path, certificate: Document, words: String) -> Result<Option<Made>, Failure> {
    let asked = Asked::of(path, certificate.clone())?;
    let subject = asked.subject()?;
    let prepared = Prepared::again(&subject, read_for(&certificate, &subject)?).map_err(Failure::Documents)?;
    let options = Options { compare: false, ..Options::default() };
    let mut run = prepared.certify(options).map_err(Failure::Documents)?;
    let no_rates = |reason: NoRatesOfClaim| Failure::call(reason.message("claim.for_n_o"), reason.help());
    run.prove_rates(&stated_counts(&certificate)).map_err(no_rates)?;
    if !is_stated(&run, &certificate) {
        return Ok(None);
    }
    let report = run_report(&run, &[], Origin::Checked, Extent::Full);
    let drawn = Drawn::of(&run).map_or_else(|| Made::of(&*report), |drawn| drawn.in_front_of_the_rest(&*report));
    let mut blocks = drawn.blocks();
    let place = blocks.iter().position(|block| matches!(block, Block::Verdict(_))).map_or(0, |verdict| verdict + 1);
    let decided = [
        Block::says(format!("The independent checker decided this certificate, `{}`; its words:", shown(path))),
        Block::Code(words),
        Block::says(
            "What follows is proved again from the certificate. What only the search knows is not in it: what sets the gain, and what would \
             lower it.",
        ),
    ];
    blocks.splice(place..place, decided);
    Ok(Some(Made::new(blocks, serde_json::Value::Null)))
}
