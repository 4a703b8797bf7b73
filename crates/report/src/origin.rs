//! What a run was made from.

/// What a run was made from: what a report does not know, and what it advises next, go by that.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// A search.
    Search,
    /// The witness of a certificate, decided again; nothing was searched for.
    Witness,
    /// The witness of a certificate that the independent checker found valid, decided again.
    Checked,
}

impl Origin {
    /// Whether a given witness was decided again.
    pub(super) fn is_given(self) -> bool {
        self != Origin::Search
    }
}
