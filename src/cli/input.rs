//! Documents from files and standard input, and constants from flags.

use super::failure::Failure;
use super::output::{reason, shown};
use sigmastar_lang::spec::{Document, MAX_BYTES, Notation};
use std::fs::File;
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// Constants from flags.
pub use sigmastar::program::{nonnegative, positive, rational, real, steady_error, with_sampling_period};

/// Reads a document that people write, in the notation that the name of its file says, or from standard input for `-`, in
/// JSON; never more than the limit on documents.
///
/// # Errors
/// A file that cannot be read, and what is wrong with the document in its notation.
pub fn document(path: &Path) -> Result<Document, Failure> {
    read(path, Notation::of(path))
}

/// Reads a document that this program has written, which is JSON whatever its name.
///
/// # Errors
/// A file that cannot be read, and what is wrong with the document as JSON.
pub fn written(path: &Path) -> Result<Document, Failure> {
    read(path, Notation::Json)
}

fn read(path: &Path, notation: Notation) -> Result<Document, Failure> {
    let limit = MAX_BYTES as u64 + 1;
    let mut bytes = Vec::new();
    if path == Path::new("-") {
        let read = io::stdin().lock().take(limit).read_to_end(&mut bytes);
        read.map_err(|error| {
            let message = format!("cannot read standard input: {}", reason(&error));
            Failure::call(message, "name a file instead of `-`")
        })?;
        return Ok(Document::from_bytes_as("<stdin>", &bytes, notation)?);
    }
    let name = shown(path);
    File::open(path).and_then(|file| file.take(limit).read_to_end(&mut bytes)).map_err(|error| {
        let help = match error.kind() {
            ErrorKind::NotFound if name.parse::<f64>().is_ok() => {
                "a number stands where a file is expected: the value of a flag follows it at once, as in `--sigma 5 FILE`"
            }
            ErrorKind::NotFound => "check the spelling and the current folder",
            ErrorKind::IsADirectory => "name a file in it",
            ErrorKind::PermissionDenied => "check the permissions of the file",
            _ => "check the file, or pass its content through standard input with `-`",
        };
        Failure::call(format!("cannot read `{name}`: {}", reason(&error)), help)
    })?;
    Ok(Document::from_bytes_as(&name, &bytes, notation)?)
}
