//! The parts of a page: a title, or none, with the blocks below it and a name for links.

use crate::block::Block;
use std::collections::HashSet;

/// What starts a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Start<'b> {
    /// Nothing: the document has no title.
    Nothing,
    /// The title of a report.
    Title(&'b str),
    /// The title of a section.
    Heading(&'b str),
    /// The title of a section that is folded.
    Aside(&'b str),
}

impl<'b> Start<'b> {
    fn of(block: &'b Block) -> Option<Start<'b>> {
        match block {
            Block::Title(title) => Some(Start::Title(title)),
            Block::Heading(title) => Some(Start::Heading(title)),
            Block::Aside(title) => Some(Start::Aside(title)),
            _ => None,
        }
    }

    /// The words of the title.
    pub(super) fn words(self) -> &'b str {
        match self {
            Start::Nothing => "",
            Start::Title(title) | Start::Heading(title) | Start::Aside(title) => title,
        }
    }
}

/// A part.
pub(super) struct Part<'b> {
    /// What it starts with.
    pub(super) start: Start<'b>,
    /// Its name in links; no other part or heading has it.
    pub(super) anchor: String,
    /// What follows as far as the next part.
    pub(super) blocks: &'b [Block],
}

/// The parts of a document in their order.
pub(super) fn parts<'b>(blocks: &'b [Block], anchors: &mut Anchors) -> Vec<Part<'b>> {
    let mut parts = Vec::new();
    let mut rest = blocks;
    while let Some(first) = rest.first() {
        let (start, below) = match Start::of(first) {
            Some(start) => (start, &rest[1..]),
            None => (Start::Nothing, rest),
        };
        let length = below.iter().position(|block| Start::of(block).is_some()).unwrap_or(below.len());
        let (blocks, next) = below.split_at(length);
        parts.push(Part { start, anchor: anchors.name(start.words()), blocks });
        rest = next;
    }
    parts
}

/// The names that links have already.
#[derive(Default)]
pub(super) struct Anchors {
    taken: HashSet<String>,
}

impl Anchors {
    /// A new name that looks like the title: its ASCII letters and digits in small letters, `-` for what stands between them.
    pub(super) fn name(&mut self, title: &str) -> String {
        let words: Vec<String> = title
            .split(|c: char| !c.is_ascii_alphanumeric())
            .filter(|word| !word.is_empty())
            .map(str::to_owned)
            .collect();
        let plain = if words.is_empty() { "part".to_owned() } else { words.join("-").to_ascii_lowercase() };
        let mut name = plain.clone();
        let mut number = 1;
        while !self.taken.insert(name.clone()) {
            number += 1;
            name = format!("{plain}-{number}");
        }
        name
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_plain_and_their_own() {
        let mut anchors = Anchors::default();
        let names = ["sigma* = 1/2 <b>", "a", "a-2", "a", "A", "\u{e9}*"].map(|title| anchors.name(title));
        assert_eq!(names, ["sigma-1-2-b", "a", "a-2", "a-3", "a-4", "part"]);
    }

    #[test]
    fn every_block_is_in_one_part() {
        let text = || Block::says("x");
        let blocks = [
            text(),
            Block::Title("T".to_owned()),
            text(),
            text(),
            Block::heading("H"),
            Block::Aside("A".to_owned()),
            text(),
        ];
        let found = parts(&blocks, &mut Anchors::default());
        let shape: Vec<(Start<'_>, usize)> = found.iter().map(|part| (part.start, part.blocks.len())).collect();
        let expected = [(Start::Nothing, 1), (Start::Title("T"), 2), (Start::Heading("H"), 0), (Start::Aside("A"), 1)];
        assert_eq!(shape, expected);
        assert!(parts(&[], &mut Anchors::default()).is_empty());
    }
}
