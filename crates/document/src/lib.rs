//! The document that every command reports with, and its renderers.
//!
//! A report makes blocks once; a renderer is one function of them, in a file of its own. JSON is data and not text: each
//! report writes it from the same figures, because its fields are a contract that headings and sentences are not.

#![deny(missing_docs)]
// What tests compare with need not be the same on every machine.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

mod block;
mod html;
mod made;
mod markdown;
pub mod number;
pub mod plot;
pub mod progress;
mod span;
mod text;

pub use block::{Align, Block, Column, Extent, Table, clean, clean_sentence, is_hidden};
pub use made::Made;
pub use span::{plain, plain_all};

/// A report that can be written in every format, with the same content in each.
pub trait Readable {
    /// The document that the renderers of text, Markdown and HTML share.
    fn blocks(&self) -> Vec<Block>;

    /// As JSON: claims are strings, enclosures `["lo", "hi"]`; floating point that claims nothing may be a number.
    fn json(&self) -> serde_json::Value;

    /// Whether its short form leaves something out.
    fn has_detail(&self) -> bool {
        let blocks = self.blocks();
        let whole = blocks.iter().filter(|block| !matches!(block, Block::Detail)).count();
        Extent::Short.of(blocks).len() < whole
    }

    /// As plain text, readable without colour at 100 columns.
    fn text(&self, extent: Extent) -> String {
        text::render(&extent.of(self.blocks()))
    }

    /// As GitHub-flavoured Markdown.
    fn markdown(&self, extent: Extent) -> String {
        markdown::render(&extent.of(self.blocks()))
    }

    /// As one HTML page that needs no other file: always whole, for what is long is folded there.
    fn html(&self) -> String {
        html::render(&self.blocks())
    }
}
