//! Data on standard output, remarks on standard error.

use super::colour;
use clap::ValueEnum;
use sigmastar::Verdict;
use sigmastar_document::{Extent, Made, Readable, is_hidden};
use sigmastar_lang::spec::SpecErrors;
use std::io::{self, ErrorKind, Write};
use std::path::Path;

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

/// Writes a report to standard output. A reader that has seen enough (`| head`) is no failure; any other error is
/// told on standard error and returned as an exit code.
pub fn data(text: &str) -> Result<(), u8> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Ok(()) => Ok(()),
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        Err(failure) => {
            error(
                &format!("standard output cannot be written: {}", reason(&failure)),
                "check where it is redirected to, and the space left there",
            );
            Err(Verdict::BadInput.exit_code())
        }
    }
}

/// A report in the format that was asked for.
pub fn report(report: &dyn Readable, format: Format) -> String {
    written(report, format, Extent::Full)
}

fn written(report: &dyn Readable, format: Format, extent: Extent) -> String {
    match format {
        Format::Text => report.text(extent),
        Format::Markdown => report.markdown(extent),
        Format::Html => report.html(),
        Format::Json => json_text(&report.json()),
    }
}

/// How much of a report is written: HTML and JSON are whole in any case.
pub fn extent(format: Format, full: bool) -> Extent {
    if full || !matches!(format, Format::Text | Format::Markdown) { Extent::Full } else { Extent::Short }
}

/// A report in the format that was asked for, short unless it is asked for whole.
pub struct Shortened {
    text: String,
    more: bool,
}

impl Shortened {
    /// The report as it is written.
    pub fn new(report: &dyn Readable, format: Format, full: bool) -> Shortened {
        if extent(format, full) == Extent::Full {
            return Shortened { text: written(report, format, Extent::Full), more: false };
        }
        // The blocks are made once: some of what they say is worked out as they are made.
        let made = Made::new(report.blocks(), serde_json::Value::Null);
        Shortened { text: written(&made, format, Extent::Short), more: made.has_detail() }
    }

    /// Writes it to standard output, as [`data`] does; a remark says how to see the rest.
    pub fn show(&self, quiet: bool) -> Result<(), u8> {
        data(&self.text)?;
        if self.more && !quiet {
            remark("this is the short form; `--full` shows the whole report");
        }
        Ok(())
    }
}

/// JSON as it is written: indented, ending in a line feed.
pub fn json_text(value: &serde_json::Value) -> String {
    // The alternate form of a JSON value is its indented text.
    format!("{value:#}\n")
}

/// Writes to standard error; when that is closed there is nobody to tell.
fn tell(text: &str) {
    let _ = io::stderr().lock().write_all(text.as_bytes());
}

/// A remark: one line on standard error.
pub fn remark(text: &str) {
    tell(&format!("sigmastar: {text}\n"));
}

/// An error without a place in a document.
pub fn error(message: &str, help: &str) {
    let [red, cyan, bold, plain] =
        if colour::on_stderr() { ["\u{1b}[1;31m", "\u{1b}[1;36m", "\u{1b}[1m", "\u{1b}[0m"] } else { [""; 4] };
    tell(&format!("{red}error{plain}{bold}: {message}{plain}\n  {cyan}={plain} {bold}help{plain}: {help}\n"));
}

/// Errors in their source.
pub fn diagnostics(all: &[SpecErrors]) {
    let rendered: Vec<String> = all.iter().map(|errors| errors.render(colour::on_stderr())).collect();
    tell(&rendered.join("\n"));
}

/// Why a file operation failed, in words.
pub fn reason(error: &io::Error) -> String {
    match error.kind() {
        ErrorKind::NotFound => "there is no such file".to_owned(),
        ErrorKind::PermissionDenied => "permission is denied".to_owned(),
        ErrorKind::IsADirectory => "it is a folder".to_owned(),
        ErrorKind::StorageFull => "no space is left".to_owned(),
        ErrorKind::NotADirectory => "a part of the path is a file, not a folder".to_owned(),
        ErrorKind::AlreadyExists => "it exists already".to_owned(),
        ErrorKind::ReadOnlyFilesystem => "the file system is read-only".to_owned(),
        ErrorKind::InvalidFilename => "the name is too long, or no name here".to_owned(),
        _ => {
            // The system's words without its number.
            let text = error.to_string();
            text.split(" (os error").next().unwrap_or(&text).to_lowercase()
        }
    }
}

/// A path as messages show it: what is not shown, or moves the cursor, is marked.
pub fn shown(path: &Path) -> String {
    path.display().to_string().chars().map(|c| if is_hidden(c) { '\u{fffd}' } else { c }).collect()
}
