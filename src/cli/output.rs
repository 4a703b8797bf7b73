//! Data on standard output, remarks on standard error, and files that appear whole or not at all.

use super::args::Format;
use super::failure::Failure;
use super::temporary::{Temporary, place};
use sigmastar::certify::Verdict;
use sigmastar::report::Readable;
use sigmastar::spec::SpecErrors;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::path::{Path, PathBuf};

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
pub fn report(report: &impl Readable, format: Format) -> String {
    match format {
        Format::Text => report.text(),
        Format::Markdown => report.markdown(),
        Format::Json => json_text(&report.json()),
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
        if colour() { ["\u{1b}[1;31m", "\u{1b}[1;36m", "\u{1b}[1m", "\u{1b}[0m"] } else { [""; 4] };
    tell(&format!("{red}error{plain}{bold}: {message}{plain}\n  {cyan}={plain} {bold}help{plain}: {help}\n"));
}

/// Errors in their source.
pub fn diagnostics(all: &[SpecErrors]) {
    let rendered: Vec<String> = all.iter().map(|errors| errors.render(colour())).collect();
    tell(&rendered.join("\n"));
}

/// Whether standard error wants colour: a terminal that can show it, and `NO_COLOR` is unset or empty.
fn colour() -> bool {
    let set = |name| std::env::var_os(name).filter(|value| !value.is_empty());
    io::stderr().is_terminal() && set("NO_COLOR").is_none() && set("TERM").is_none_or(|term| term != "dumb")
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

/// A path as messages show it: control characters would move the cursor.
pub fn shown(path: &Path) -> String {
    path.display().to_string().chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect()
}

/// The file that a command reads, which none of its output may replace.
#[derive(Clone, Copy, Debug)]
pub enum Input<'p> {
    /// There is none.
    None,
    /// A specification.
    Specification(&'p Path),
    /// A certificate.
    Certificate(&'p Path),
    /// A plant file.
    Plant(&'p Path),
}

impl Input<'_> {
    /// What the file is, and where.
    fn file(&self) -> Option<(&'static str, &Path)> {
        match self {
            Input::None => None,
            Input::Specification(path) => Some(("specification", path)),
            Input::Certificate(path) => Some(("certificate", path)),
            Input::Plant(path) => Some(("plant file", path)),
        }
    }
}

/// A file that is to be written, checked before the work starts.
#[derive(Debug)]
pub struct OutputFile {
    typed: PathBuf,
    target: PathBuf,
    folder: PathBuf,
}

impl OutputFile {
    /// Checks that the file can be meant: its folder exists, it is no folder or device itself, and it is not `input`.
    /// `what` is what will be written, for messages.
    ///
    /// # Errors
    /// The call is wrong; nothing was touched.
    pub fn new(path: &Path, input: Input<'_>, what: &str) -> Result<OutputFile, Failure> {
        let name = shown(path);
        if path == Path::new("-") {
            let help = "name a file; for the report as JSON on standard output, use --format json";
            return Err(Failure::call(format!("{what} cannot go to standard output"), help));
        }
        // An existing file is written through its links, so that a link stays one.
        let target = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
        if let Ok(metadata) = target.metadata() {
            if !metadata.is_file() {
                let what = if metadata.is_dir() { "a folder" } else { "not a regular file" };
                return Err(Failure::call(format!("cannot write `{name}`: it is {what}"), "name a file"));
            }
            if let Some((word, input)) = input.file()
                && input.canonicalize().is_ok_and(|input| input == target)
            {
                let message = format!("cannot write `{name}`: it is the {word} itself");
                return Err(Failure::call(message, "name another file"));
            }
        }
        let (Some(parent), Some(_)) = (target.parent(), target.file_name()) else {
            return Err(Failure::call(format!("cannot write `{name}`: it is not the name of a file"), "name a file"));
        };
        let folder = if parent.as_os_str().is_empty() { Path::new(".") } else { parent }.to_path_buf();
        if !folder.is_dir() {
            let message = format!("cannot write `{name}`: there is no folder `{}`", shown(&folder));
            return Err(Failure::call(message, "create the folder, or name another file"));
        }
        Ok(OutputFile { typed: path.to_path_buf(), target, folder })
    }

    /// The path as it was typed.
    pub fn name(&self) -> String {
        shown(&self.typed)
    }

    /// Writes the file through a temporary one in the same folder: it appears whole or not at all.
    ///
    /// # Errors
    /// The file system's reason.
    pub fn write(&self, content: impl AsRef<[u8]>) -> Result<(), Failure> {
        write_together(&[(self, content.as_ref())])
    }

    fn failure(&self, error: &io::Error, more: &str) -> Failure {
        let message = format!("cannot write `{}`: {}{more}", self.name(), reason(error));
        Failure::call(message, "check the permissions of the folder and the space left there")
    }
}

/// Writes files that belong together: all of them appear, or none is touched.
///
/// # Errors
/// The file system's reason, and which file stays changed where one cannot be put back.
pub fn write_together(files: &[(&OutputFile, &[u8])]) -> Result<(), Failure> {
    let more = if files.len() > 1 { "; none of the files that belong together was changed" } else { "" };
    let mut temporaries = Vec::new();
    for (file, content) in files {
        let temporary = Temporary::write(&file.folder, content).map_err(|error| file.failure(&error, more))?;
        temporaries.push((temporary, file.target.as_path()));
    }
    place(temporaries).map_err(|failure| {
        let left: Vec<String> = failure.left.iter().map(|index| format!("`{}`", files[*index].0.name())).collect();
        let more = match left.is_empty() {
            true => more.to_owned(),
            false => format!("; what was in {} before could not be put back", left.join(" and ")),
        };
        files[failure.index].0.failure(&failure.error, &more)
    })
}

/// A folder for files that are made, created where it does not exist.
///
/// # Errors
/// It cannot be created, or it is something else.
pub fn folder(path: &Path) -> Result<(), Failure> {
    if path.metadata().is_ok_and(|metadata| !metadata.is_dir()) {
        let message = format!("cannot write into `{}`: it is a file, not a folder", shown(path));
        return Err(Failure::call(message, "name a folder; it is created where it does not exist"));
    }
    std::fs::create_dir_all(path).map_err(|error| {
        let message = format!("cannot create the folder `{}`: {}", shown(path), reason(&error));
        Failure::call(message, "name a folder that exists or can be created")
    })
}
