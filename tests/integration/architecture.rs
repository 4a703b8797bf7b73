//! The table of crates in `docs/architecture.md` is what their manifests say, and neither folders nor files go in circles.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

type Imports = BTreeMap<String, BTreeSet<String>>;

/// The rows of the table below a heading: a name, and the names in backticks of what it imports.
fn table(heading: &str) -> Imports {
    let text = std::fs::read_to_string("docs/architecture.md").unwrap();
    let (_, section) = text.split_once(&format!("\n## {heading}\n")).unwrap();
    let section = section.split("\n## ").next().unwrap();
    let names = |cell: &str| -> BTreeSet<String> { cell.split('`').skip(1).step_by(2).map(str::to_owned).collect() };
    let cells = section.lines().filter(|line| line.starts_with("| `")).map(|row| row.split('|').collect::<Vec<_>>());
    cells.map(|cells| (names(cells[1]).into_iter().collect::<String>(), names(cells[3]))).collect()
}

/// A package's folder, under the name that it has in the table.
fn packages() -> Vec<(String, PathBuf)> {
    let crates = std::fs::read_dir("crates").unwrap().map(|entry| entry.unwrap().path());
    let named = crates.map(|path| (path.file_name().unwrap().to_str().unwrap().to_owned(), path));
    let others = [("sigmastar", "."), ("proofs-check", "proofs-check")].into_iter();
    let parts = ["core", "plants"].map(|part| (format!("proofs-{part}"), PathBuf::from("proofs-check").join(part)));
    let named = named.filter(|(name, _)| name != "lapack-faer");
    named.chain(others.map(|(name, path)| (name.to_owned(), PathBuf::from(path)))).chain(parts).collect()
}

/// The packages of this project that a manifest names as dependencies, those of tests aside.
fn dependencies(manifest: &str) -> BTreeSet<String> {
    let (_, section) = manifest.split_once("\n[dependencies]\n").unwrap();
    let section = section.split("\n[").next().unwrap();
    let names = section.lines().filter_map(|line| line.split_once(" = ").map(|(name, _)| name));
    let own = |name: &str| name.starts_with("sigmastar-") || name.starts_with("proofs-") || name == "lapack-faer";
    names.filter(|name| own(name)).map(|name| name.trim_start_matches("sigmastar-").to_owned()).collect()
}

/// Every source of a folder that is no test.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap();
        if name == "tests" || name.ends_with("_tests") {
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
        if inner.is_dir() && name != "tests" && !name.ends_with("_tests") {
            found.extend(all_circles(&inner, &format!("{path}{name}::")));
        }
    }
    found
}

#[test]
fn no_files_import_each_other() {
    for (name, folder) in packages() {
        assert_eq!(all_circles(&folder.join("src"), "crate::"), Vec::<String>::new(), "{name}");
    }
}

/// The compiler holds a crate to its manifest; the page says what is in it, and nothing is in it that is not imported.
#[test]
fn crates_import_what_the_table_says() {
    let mut table = table("The crates");
    table.extend(self::table("The checker"));
    for (name, folder) in packages() {
        let dependencies = dependencies(&std::fs::read_to_string(folder.join("Cargo.toml")).unwrap());
        assert_eq!(table.remove(&name).as_ref(), Some(&dependencies), "{name}");
        let text: String = sources(&folder.join("src")).iter().map(|path| code(path)).collect();
        for other in dependencies {
            let module = other.replace('-', "_");
            let used = [format!("sigmastar_{module}::"), format!("{module}::"), format!("crate {module} ")];
            assert!(used.iter().any(|used| text.contains(used)), "{name} does not use {other}");
        }
    }
    assert_eq!(table, Imports::new());
}

/// The crates of this project that the files of a folder import.
fn crates_of(folder: &str) -> BTreeSet<String> {
    let named = |text: &str| -> BTreeSet<String> {
        let words = text.split(|c: char| !c.is_alphanumeric() && c != '_');
        let own = |word: &&str| word.starts_with("sigmastar_") || word.starts_with("proofs_");
        words.filter(own).map(|word| word.trim_start_matches("sigmastar_").to_owned()).collect()
    };
    sources(Path::new(folder)).iter().flat_map(|path| named(&code(path))).collect()
}

#[test]
fn the_program_asks_the_front_door() {
    let may = ["document", "exact", "lab", "lang", "paper", "prove", "regulator", "report", "schema", "studies"];
    assert_eq!(crates_of("src/cli"), BTreeSet::from(may.map(str::to_owned)));
    let checks = |path: &PathBuf| code(path).contains("proofs_check");
    let checking: Vec<PathBuf> = sources(Path::new("src")).into_iter().filter(checks).collect();
    assert_eq!(checking, [Path::new("src/api/check.rs")]);
}

/// All names in the dependencies of a package of `crates`, and of those that it names, in turn.
fn closure(name: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut open = vec![name.to_owned()];
    while let Some(name) = open.pop() {
        let manifest = std::fs::read_to_string(Path::new("crates").join(&name).join("Cargo.toml")).unwrap();
        let (_, section) = manifest.split_once("\n[dependencies]\n").unwrap();
        for line in section.split("\n[").next().unwrap().lines() {
            let Some((other, _)) = line.split_once(" = ") else { continue };
            if found.insert(other.to_owned())
                && let Some(own) = other.strip_prefix("sigmastar-")
            {
                open.push(own.to_owned());
            }
        }
    }
    found
}

#[test]
fn what_decides_cannot_name_what_proposes() {
    let decides = closure("decide");
    assert!(closure("prove").is_superset(&decides) && closure("prove").contains("clarabel"));
    for proposes in ["sigmastar-propose", "sigmastar-prove", "clarabel", "lapack-faer", "nalgebra", "argmin"] {
        assert!(!decides.contains(proposes), "decide reaches {proposes}");
    }
    // The solver of semidefinite programs is called in one crate.
    for (name, folder) in packages() {
        let manifest = std::fs::read_to_string(folder.join("Cargo.toml")).unwrap();
        let (_, section) = manifest.split_once("\n[dependencies]\n").unwrap();
        let names_solver = section.split("\n[").next().unwrap().contains("clarabel");
        assert_eq!(names_solver, name == "propose", "{name}");
    }
}

/// The public functions of a source: the arguments and the result of each.
fn signatures(text: &str) -> Vec<(String, String)> {
    let starts = text.match_indices("pub fn ").map(|(at, _)| &text[at..]);
    let signature = |text: &str| {
        let (arguments, result) = text[..text.find("{\n").unwrap_or(text.len())].rsplit_once("->")?;
        Some((arguments.to_owned(), result.to_owned()))
    };
    starts.filter_map(signature).collect()
}

/// A verdict is a `Decision`, a proof, or that nothing is in the way.
fn is_verdict(result: &str) -> bool {
    ["Decision", "Truth", "Proof<", "ExactEvaluation", "Result<(),", "bool"]
        .iter()
        .any(|verdict| result.contains(verdict))
}

#[test]
fn no_double_is_an_argument_of_a_verdict() {
    let mut verdicts = 0;
    for path in sources(Path::new("crates/decide/src")) {
        for (arguments, result) in signatures(&code(&path)).into_iter().filter(|(_, result)| is_verdict(result)) {
            assert!(!arguments.contains("f64"), "{}: {arguments}", path.display());
            assert!(!result.contains("f64"), "{}: {arguments}", path.display());
            verdicts += 1;
        }
    }
    assert!(verdicts >= 20, "{verdicts}");
    // It would be seen.
    let [(arguments, result)] = &signatures("pub fn decide(value: f64,\n    x: &X,\n) -> Decision {\n")[..] else {
        panic!()
    };
    assert!(arguments.contains("f64") && is_verdict(result));
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
