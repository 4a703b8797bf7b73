//! Files that appear whole or not at all.

use super::args::Replace;
use super::failure::Failure;
use super::output::{reason, shown};
use super::temporary::{Temporary, place};
use sigmastar_document::plot::Figure;
use std::io;
use std::path::{Path, PathBuf};

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
    /// A study.
    Study(&'p Path),
}

impl Input<'_> {
    /// What the file is, and where.
    fn file(&self) -> Option<(&'static str, &Path)> {
        match self {
            Input::None => None,
            Input::Specification(path) => Some(("specification", path)),
            Input::Certificate(path) => Some(("certificate", path)),
            Input::Plant(path) => Some(("plant file", path)),
            Input::Study(path) => Some(("study", path)),
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
    /// Checks that the file can be meant: it does not exist, its folder does, and it is no folder or device itself. `what`
    /// is what will be written, for messages.
    ///
    /// # Errors
    /// The call is wrong; nothing was touched.
    pub fn new(path: &Path, input: Input<'_>, what: &str) -> Result<OutputFile, Failure> {
        let file = OutputFile::replacing(path, input, what)?;
        if file.target.exists() {
            let help = "name another file, or add --force to replace it";
            return Err(Failure::call(format!("`{}` exists already", file.name()), help));
        }
        Ok(file)
    }

    /// A file that is to be written and may exist, unless it is `input`.
    ///
    /// # Errors
    /// The call is wrong; nothing was touched.
    pub fn replacing(path: &Path, input: Input<'_>, what: &str) -> Result<OutputFile, Failure> {
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

impl Replace {
    /// A file that is to be written: with `--force` one that exists is replaced.
    ///
    /// # Errors
    /// Those of [`OutputFile::new`].
    pub fn file(self, path: &Path, input: Input<'_>, what: &str) -> Result<OutputFile, Failure> {
        if self.force { OutputFile::replacing(path, input, what) } else { OutputFile::new(path, input, what) }
    }

    /// A file that is to be written, of a flag that may be absent: with `--force` one that exists is replaced.
    ///
    /// # Errors
    /// Those of [`OutputFile::new`].
    pub fn asked(self, path: Option<&Path>, input: Input<'_>, what: &str) -> Result<Option<OutputFile>, Failure> {
        path.map(|path| self.file(path, input, what)).transpose()
    }

    /// A folder for files that are made, created where it does not exist. Other files in it are left alone.
    ///
    /// # Errors
    /// It cannot be created, it is something else, or one of the files is in it already and may not be replaced.
    pub fn folder(self, path: &Path, files: &[&str]) -> Result<(), Failure> {
        if path.metadata().is_ok_and(|metadata| !metadata.is_dir()) {
            let message = format!("cannot write into `{}`: it is a file, not a folder", shown(path));
            return Err(Failure::call(message, "name a folder; it is created where it does not exist"));
        }
        if let Some(file) = files.iter().map(|name| path.join(name)).find(|file| !self.force && file.exists()) {
            let help = "name another folder, or add --force to replace the files in it";
            return Err(Failure::call(format!("`{}` exists already", shown(&file)), help));
        }
        std::fs::create_dir_all(path).map_err(|error| {
            let message = format!("cannot create the folder `{}`: {}", shown(path), reason(&error));
            Failure::call(message, "name a folder that exists or can be created")
        })
    }

    /// Writes figures into a folder, each under its name; `help` is what to do where one cannot be drawn.
    ///
    /// # Errors
    /// A figure that cannot be drawn, and the file system's reason.
    pub fn figures(
        self,
        folder: &Path,
        figures: &[(&str, Figure)],
        input: Input<'_>,
        help: &str,
    ) -> Result<(), Failure> {
        for (name, figure) in figures {
            let svg = figure.svg().map_err(|error| Failure::call(error.to_string(), help))?;
            self.file(&folder.join(name), input, "a figure")?.write(svg)?;
        }
        Ok(())
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
