//! `sigmastar merge`.

use super::args::MergeArgs;
use super::failure::Failure;
use super::files::Input;
use super::output::{self, shown};
use super::sweep::{existing, unreadable};
use sigmastar_prove::certify::Verdict;
use sigmastar_sweep::sweep::{Merge, Results, summary};
use std::path::Path;

/// Runs the command and returns the exit code.
pub fn run(args: &MergeArgs) -> Result<u8, Failure> {
    let mut file = None;
    let mut merge: Option<Merge> = None;
    for path in &args.files {
        file = Some(args.replace.file(&args.output, Input::Results(path), "the results")?);
        let (name, results) = (shown(path), read(path)?);
        if results.torn {
            output::remark(&format!("the last line of `{name}` was cut off and is left out"));
        }
        merge = Some(match merge {
            None => Merge::new(&name, results),
            Some(mut merge) => {
                merge.add(&name, results).map_err(|error| unreadable(&error))?;
                merge
            }
        });
    }
    let (Some(file), Some(merge)) = (file, merge) else {
        return Err(Failure::call("no file is named", "name the files of the shards"));
    };
    let results = merge.finish(args.incomplete).map_err(|error| unreadable(&error))?;
    file.write(results.text())?;
    let text = summary(&results, false);
    Ok(output::data(&text).err().unwrap_or(Verdict::Certified.exit_code()))
}

fn read(path: &Path) -> Result<Results, Failure> {
    let name = shown(path);
    let bytes = existing(path)?.ok_or_else(|| {
        Failure::call(
            format!("cannot read `{name}`: there is no such file"),
            "check the spelling and the current folder",
        )
    })?;
    Results::read(&name, &bytes).map_err(|error| unreadable(&error))
}
