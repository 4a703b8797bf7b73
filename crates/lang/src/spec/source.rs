//! Where values and errors stand.

/// The text of a document, and the name under which errors show it.
#[derive(Debug)]
pub(super) struct Source {
    pub(super) label: String,
    pub(super) text: String,
}

impl Source {
    /// Line and column (in characters) of a byte, both from 1.
    pub(super) fn line_and_column(&self, at: usize) -> (usize, usize) {
        let before = self.text.get(..at).unwrap_or(&self.text);
        let line = 1 + before.matches('\n').count();
        let column = 1 + before.rsplit('\n').next().map_or(0, |line| line.chars().count());
        (line, column)
    }
}
