//! The formats of reports.

use clap::ValueEnum;

/// A format of a report, the same for every command.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Plain text for a terminal
    Text,
    /// GitHub-flavoured Markdown
    Markdown,
    /// One HTML page with figures, which needs no other file
    Html,
    /// JSON, also for failures
    Json,
}
