//! What a run was made from.

/// What a run was made from: what a report does not know, and what it advises next, go by that.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// A search.
    Search,
    /// A search whose certificate, if there is one, is written to a file.
    Written,
    /// The witness of a certificate, decided again; nothing was searched for.
    Witness,
    /// The witness of a certificate that the independent checker found valid, decided again.
    Checked,
}

impl Origin {
    /// Whether a given witness was decided again.
    pub(super) fn is_given(self) -> bool {
        !matches!(self, Origin::Search | Origin::Written)
    }
}
