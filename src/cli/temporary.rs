//! Files that appear whole or not at all, several of them together, with nothing left behind by a process that is
//! interrupted.

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, Once, PoisonError};
use tempfile::{Builder, NamedTempFile};

/// The temporary files that exist. Whoever creates, renames or removes one holds the lock, so that an interruption finds
/// either none of it done or all.
static PENDING: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// The exit code of a process that was interrupted, as shells have it for SIGINT.
const INTERRUPTED: i32 = 130;

fn pending() -> MutexGuard<'static, Vec<PathBuf>> {
    // A list of paths cannot be half changed.
    PENDING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// From the first temporary file on, an interruption removes those that exist before it ends the process.
fn watch() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        // Without a handler the files are written all the same.
        let _ = ctrlc::set_handler(|| {
            let files = pending();
            files.iter().for_each(|path| drop(std::fs::remove_file(path)));
            std::process::exit(INTERRUPTED);
        });
    });
}

fn builder() -> Builder<'static, 'static> {
    let mut builder = Builder::new();
    builder.prefix(".sigmastar-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // As for any new file, the user's mask applies.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder
}

/// A complete file that is not in its place yet; removed when dropped.
#[derive(Debug)]
pub struct Temporary {
    file: Option<NamedTempFile>,
    path: PathBuf,
}

impl Temporary {
    /// Writes a file beside its place.
    ///
    /// # Errors
    /// The file system's reason; nothing is left behind.
    pub fn write(folder: &Path, content: &[u8]) -> io::Result<Temporary> {
        watch();
        let mut temporary = {
            let mut pending = pending();
            let file = builder().tempfile_in(folder)?;
            let path = file.path().to_path_buf();
            pending.push(path.clone());
            Temporary { file: Some(file), path }
        };
        if let Some(file) = &mut temporary.file {
            file.write_all(content)?;
            file.as_file().sync_all()?;
        }
        Ok(temporary)
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        let mut pending = pending();
        self.file = None;
        pending.retain(|path| *path != self.path);
    }
}

/// Why files were not put into their places.
#[derive(Debug)]
pub struct PlaceError {
    /// The index of the file that could not be renamed.
    pub index: usize,
    /// The file system's reason.
    pub error: io::Error,
    /// The indices of files that could not be put back either: they are new while the others are old.
    pub left: Vec<usize>,
}

/// Puts files into their places, all of them or none: where one cannot be renamed, those before it are put back as they
/// were.
///
/// # Errors
/// [`PlaceError`].
pub fn place(mut files: Vec<(Temporary, &Path)>) -> Result<(), PlaceError> {
    // An interruption waits; the temporary files are dropped after this.
    let _pending = pending();
    let last = files.len().saturating_sub(1);
    let mut placed: Vec<(usize, &Path, Option<NamedTempFile<()>>)> = Vec::new();
    for (index, (temporary, target)) in files.iter_mut().enumerate() {
        // Nothing is renamed after the last one, so only those before it may have to be put back.
        let kept = if index < last { keep(target) } else { Ok(None) };
        let renamed = kept.and_then(|kept| match temporary.file.take() {
            Some(file) => file.persist(*target).map(|_| kept).map_err(|error| error.error),
            None => Ok(kept),
        });
        match renamed {
            Ok(kept) => placed.push((index, target, kept)),
            Err(error) => {
                let restore = |(_, target, kept): &mut (usize, &Path, Option<NamedTempFile<()>>)| match kept.take() {
                    Some(kept) => kept.persist(target).is_ok(),
                    None => std::fs::remove_file(target).is_ok(),
                };
                let left = placed.iter_mut().rev().filter_map(|entry| (!restore(entry)).then_some(entry.0)).collect();
                return Err(PlaceError { index, error, left });
            }
        }
    }
    Ok(())
}

/// A second name of a file that is about to be replaced; `None` where there is no file.
fn keep(target: &Path) -> io::Result<Option<NamedTempFile<()>>> {
    if !target.exists() {
        return Ok(None);
    }
    let folder = target.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    // Some file systems have no second names.
    let link = |path: &Path| std::fs::hard_link(target, path);
    let copy = |path: &Path| std::fs::copy(target, path).map(drop);
    builder().make_in(folder, link).or_else(|_| builder().make_in(folder, copy)).map(Some)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> =
            fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn all_files_or_none() {
        let folder = tempfile::tempdir().unwrap();
        let [first, second] = ["first", "second"].map(|name| folder.path().join(name));
        let write = |text: &str| Temporary::write(folder.path(), text.as_bytes()).unwrap();
        place(vec![(write("a"), &first), (write("b"), &second)]).unwrap();
        assert_eq!((fs::read(&first).unwrap(), fs::read(&second).unwrap()), (b"a".to_vec(), b"b".to_vec()));
        place(vec![(write("c"), &first), (write("d"), &second)]).unwrap();
        assert_eq!((fs::read(&first).unwrap(), fs::read(&second).unwrap()), (b"c".to_vec(), b"d".to_vec()));
        assert_eq!(names(folder.path()), ["first", "second"]);
        // A folder in the place of the second: no file can be renamed to it.
        fs::remove_file(&second).unwrap();
        fs::create_dir(&second).unwrap();
        let failure = place(vec![(write("e"), &first), (write("f"), &second)]).unwrap_err();
        assert_eq!((failure.index, failure.left), (1, Vec::new()));
        assert_eq!(fs::read(&first).unwrap(), b"c");
        // Where there was none before, there is none after.
        fs::remove_file(&first).unwrap();
        place(vec![(write("g"), &first), (write("h"), &second)]).unwrap_err();
        assert_eq!(names(folder.path()), ["second"]);
    }

    #[test]
    fn nothing_is_left_behind() {
        let folder = tempfile::tempdir().unwrap();
        drop(Temporary::write(folder.path(), b"text").unwrap());
        assert!(names(folder.path()).is_empty());
        assert!(pending().iter().all(|path| !path.starts_with(folder.path())));
    }
}
