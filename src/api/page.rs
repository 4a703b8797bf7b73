//! The page of a stored certificate: what the independent checker decided, and what the claim says, proved again from the witness.

use super::edge::Drawn;
use super::error::Error;
use super::report::Report;
use super::reread::decided_again;
use sigmastar_document::{Block, Extent, Made, Readable};
use sigmastar_lang::spec::Document;
use sigmastar_prove::reduction::Run;
use sigmastar_report::{Origin, run_report};

/// The page of a certificate that the checker found valid, whose file is called `name`; `words` are the checker's. `None` where the claim that
/// the witness proves here is not the one that is stored.
///
/// # Errors
/// What keeps the certificate from being read, or its data from being proved.
pub fn page(name: &str, certificate: &[u8], words: String) -> Result<Option<Report>, Error> {
    let certificate = Document::from_bytes(name, certificate)?;
    decided_again(name, &certificate, |run, _, stated| Ok(stated.then(|| proved_again(run, name, words))))
}

fn proved_again(run: &Run<'_>, name: &str, words: String) -> Report {
    let report = run_report(run, &[], Origin::Checked, Extent::Full);
    let drawn = Drawn::of(run).map_or_else(|| Made::of(&*report), |drawn| drawn.in_front_of_the_rest(&*report));
    let mut blocks = drawn.blocks();
    let place = blocks.iter().position(|block| matches!(block, Block::Verdict(_))).map_or(0, |verdict| verdict + 1);
    let decided = [
        Block::says(format!("The independent checker decided this certificate, `{name}`; its words:")),
        Block::Code(words),
        Block::says(
            "What follows is proved again from the certificate. What only the search knows is not in it: what sets the gain, and what would \
             lower it.",
        ),
    ];
    blocks.splice(place..place, decided);
    Report::new(Made::new(blocks, serde_json::Value::Null))
}
