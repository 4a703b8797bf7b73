//! How long work tells whoever waits for it that it goes on.

/// Hears of work done, for a progress bar.
pub trait Progress: Sync {
    /// One more unit of work is done.
    fn advance(&self);
}

/// Nobody listens.
#[derive(Clone, Copy, Debug)]
pub struct Silent;

impl Progress for Silent {
    fn advance(&self) {}
}
