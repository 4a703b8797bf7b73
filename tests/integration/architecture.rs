//! The table of imports in `docs/architecture.md` is what the sources import.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

type Imports = BTreeMap<String, BTreeSet<String>>;

/// The names in backticks of a cell: folders, and files without their ending.
fn names(cell: &str) -> BTreeSet<String> {
    let quoted = cell.split('`').skip(1).step_by(2);
    quoted.map(|name| name.trim_end_matches('/').trim_end_matches(".rs").to_owned()).collect()
}

/// The rows of the tables below a heading, as what each folder may import: what is named, and with "and below" all that those
/// may import.
fn table(heading: &str) -> (Imports, Imports) {
    let text = std::fs::read_to_string("docs/architecture.md").unwrap();
    let (_, section) = text.split_once(&format!("\n## {heading}\n")).unwrap();
    let section = section.split("\n## ").next().unwrap();
    let (mut named, mut allowed) = (Imports::new(), Imports::new());
    for row in section.lines().filter(|line| line.starts_with("| `")) {
        let cells: Vec<&str> = row.split('|').collect();
        let imports = names(cells[3]);
        let mut all = imports.clone();
        if cells[3].contains("and below") {
            all.extend(imports.iter().filter_map(|name| allowed.get(name)).flatten().cloned().collect::<Vec<_>>());
        }
        for folder in names(cells[1]) {
            named.insert(folder.clone(), imports.clone());
            allowed.insert(folder, all.clone());
        }
    }
    (named, allowed)
}

/// Every source of a folder that is no test.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap();
        if name == "tests" {
            continue;
        } else if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            found.push(path);
        }
    }
    found
}

/// What follows a path such as `crate::` in a text, with each name of a group.
fn imported(text: &str, path: &str) -> BTreeSet<String> {
    let first = |text: &str| text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    let mut found = BTreeSet::new();
    for (at, _) in text.match_indices(path) {
        // Another path that ends in this one, or the end of another crate's name.
        if text[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == ':') {
            continue;
        }
        let rest = &text[at + path.len()..];
        let Some(group) = rest.strip_prefix('{') else {
            found.insert(first(rest));
            continue;
        };
        let mut depth = 1;
        let mut start = true;
        for (at, c) in group.char_indices() {
            match c {
                '{' => depth += 1,
                '}' => depth -= 1,
                _ if depth == 1 && start && !c.is_whitespace() => {
                    found.insert(first(&group[at..]));
                    start = false;
                }
                _ => {}
            }
            start |= c == ',' && depth == 1;
            if depth == 0 {
                break;
            }
        }
    }
    found
}

/// A source without its tests and comments.
fn code(path: &Path) -> String {
    let text = std::fs::read_to_string(path).unwrap();
    let code = text.split("#[cfg(test)]\nmod tests").next().unwrap();
    code.lines().filter(|line| !line.trim_start().starts_with("//")).map(|line| format!("{line}\n")).collect()
}

/// What each folder or file at the top of `src` imports of the others, its tests aside.
fn found(src: &str) -> Imports {
    let mut found = Imports::new();
    for path in sources(Path::new(src)) {
        let top = path.strip_prefix(src).unwrap().components().next().unwrap();
        let top = Path::new(&top).file_stem().unwrap().to_str().unwrap().to_owned();
        found.entry(top).or_default().extend(imported(&code(&path), "crate::"));
    }
    let tops: BTreeSet<String> = found.keys().cloned().collect();
    for (top, imports) in &mut found {
        imports.retain(|name| name != top && tops.contains(name));
    }
    found
}

/// Each complaint about a table, held against what was found.
fn complaints(heading: &str, src: &str, roots: &[&str]) -> Vec<String> {
    let (named, allowed) = table(heading);
    let found = found(src);
    let mut complaints = Vec::new();
    for (folder, imports) in found.iter().filter(|(folder, _)| !roots.contains(&folder.as_str())) {
        let Some(allowed) = allowed.get(folder) else {
            complaints.push(format!("{src}/{folder} has no row"));
            continue;
        };
        complaints.extend(imports.difference(allowed).map(|name| format!("{src}/{folder} imports {name}")));
    }
    for (folder, imports) in named.iter().filter(|(folder, _)| !roots.contains(&folder.as_str())) {
        let Some(found) = found.get(folder) else {
            complaints.push(format!("{src}/{folder} is no more"));
            continue;
        };
        let idle = imports.difference(found).filter(|name| *name != "proofs_check");
        complaints.extend(idle.map(|name| format!("{src}/{folder} does not import {name}")));
    }
    complaints
}

/// The names that a `mod.rs` makes public under its own path, with the files that they come from.
fn exported(folder: &Path) -> BTreeMap<String, String> {
    let Some(text) = ["mod.rs", "lib.rs"].iter().map(|name| folder.join(name)).find(|path| path.exists()) else {
        return BTreeMap::new();
    };
    let text = code(&text);
    let mut found = BTreeMap::new();
    for (at, _) in text.match_indices(" use ") {
        let line = text[at + " use ".len()..].split(';').next().unwrap();
        let Some((file, names)) = line.split_once("::") else { continue };
        for name in names.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|name| !name.is_empty()) {
            found.insert(name.to_owned(), file.to_owned());
        }
    }
    found
}

/// The files and folders of a folder, of which each imports another one of them and is imported by one: those of circles, and
/// what is between two circles.
fn circles(folder: &Path, path: &str) -> Vec<String> {
    let exported = exported(folder);
    let mut imports = Imports::new();
    for file in sources(folder) {
        let inner: Vec<_> = file.strip_prefix(folder).unwrap().components().collect();
        let name = Path::new(&inner[0]).file_stem().unwrap().to_str().unwrap().to_owned();
        if ["mod", "lib", "main"].contains(&name.as_str()) {
            continue;
        }
        // How far up the folder is.
        let up = inner.len() - usize::from(inner.len() > 1 && file.ends_with("mod.rs"));
        let text = code(&file);
        let mut all = imported(&text, &"super::".repeat(up));
        all.extend(imported(&text, path));
        imports.entry(name).or_default().extend(all);
    }
    let names: BTreeSet<String> = imports.keys().cloned().collect();
    for (own, imported) in &mut imports {
        let file = |name: &String| if names.contains(name) { Some(name) } else { exported.get(name) }.cloned();
        *imported = imported.iter().filter_map(file).filter(|name| name != own && names.contains(name)).collect();
    }
    loop {
        let before = imports.len();
        let imported: BTreeSet<String> = imports.values().flatten().cloned().collect();
        imports.retain(|name, names| !names.is_empty() && imported.contains(name));
        let left: BTreeSet<String> = imports.keys().cloned().collect();
        imports.values_mut().for_each(|names| names.retain(|name| left.contains(name)));
        if imports.len() == before {
            return imports.into_keys().map(|name| format!("{path}{name}")).collect();
        }
    }
}

/// The same of a folder and of all folders in it.
fn all_circles(folder: &Path, path: &str) -> Vec<String> {
    let mut found = circles(folder, path);
    for entry in std::fs::read_dir(folder).unwrap() {
        let inner = entry.unwrap().path();
        let name = inner.file_stem().unwrap().to_str().unwrap().to_owned();
        if inner.is_dir() && name != "tests" {
            found.extend(all_circles(&inner, &format!("{path}{name}::")));
        }
    }
    found
}

#[test]
fn no_files_import_each_other() {
    assert_eq!(all_circles(Path::new("src"), "crate::"), Vec::<String>::new());
    // A specification may carry a plant, and a plant is read with the parts that both have.
    assert_eq!(all_circles(Path::new("proofs-check/src"), "crate::"), ["crate::plant", "crate::spec"]);
}

#[test]
fn folders_import_what_the_table_says() {
    assert_eq!(complaints("The folders of src", "src", &["lib", "main", "cli"]), Vec::<String>::new());
    assert_eq!(complaints("proofs-check/src", "proofs-check/src", &["lib", "main"]), Vec::<String>::new());
}

#[test]
fn every_way_to_import_is_seen() {
    let text = "use crate::number::{a, b};\nuse crate::{spec::{self, x}, data, real};\nlet y = crate::expr::f(proofs_crate::no);";
    let expected = ["number", "spec", "data", "real", "expr"].map(str::to_owned);
    assert_eq!(imported(text, "crate::"), BTreeSet::from(expected));
    let text = "use super::{a, b};\nuse super::super::c;\nuse super::d::e;";
    assert_eq!(imported(text, "super::"), BTreeSet::from(["a", "b", "super", "d"].map(str::to_owned)));
    assert_eq!(imported(text, "super::super::"), BTreeSet::from(["c".to_owned()]));
}
