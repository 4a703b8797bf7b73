//! What is passed on: every package says what a registry wants to know, versions agree, and `THIRD-PARTY.md` names all that is linked.

use crate::support::ROOT;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;

fn text(path: &str) -> String {
    std::fs::read_to_string(Path::new(ROOT).join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// What cargo says of the workspace and of what it depends on.
fn metadata(options: &[&str]) -> Value {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.current_dir(ROOT).args(["metadata", "--format-version", "1", "--locked"]);
    let output = command.args(options).output().expect("cargo runs");
    assert!(output.status.success(), "cargo fetch? {}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("cargo writes JSON")
}

/// The value of a key in a manifest, the first one.
fn value<'t>(text: &'t str, key: &str) -> &'t str {
    let line = text.lines().find_map(|line| line.strip_prefix(key)).unwrap_or_else(|| panic!("no {key}"));
    line.trim_matches([' ', '=', ':', '"'])
}

/// What each package has to say: cargo itself asks for no keywords and no readme.
#[test]
fn every_package_can_be_published() {
    let metadata = metadata(&["--no-deps"]);
    let packages = metadata["packages"].as_array().unwrap();
    assert!(packages.len() >= 20);
    // A wheel is made of this one.
    let of_wheel = |package: &&Value| package["name"] == "sigmastar-python";
    assert!(packages.iter().find(of_wheel).unwrap()["publish"].as_array().unwrap().is_empty());
    for package in packages {
        let name = package["name"].as_str().unwrap();
        for dependency in package["dependencies"].as_array().unwrap() {
            let own = !dependency["path"].is_null();
            let exactly = format!("={}", package["version"].as_str().unwrap());
            // Another version may prove another number.
            assert!(!own || dependency["req"] == *exactly, "{name}: {}", dependency["name"]);
        }
        if of_wheel(&package) {
            continue;
        }
        for field in ["description", "license", "repository", "readme", "rust_version"] {
            assert!(package[field].as_str().is_some_and(|text| !text.is_empty()), "{name}: {field}");
        }
        for field in ["keywords", "categories"] {
            let words = package[field].as_array().unwrap();
            // The limits of the registry.
            assert!((1..=5).contains(&words.len()), "{name}: {field}");
            let longest = if field == "keywords" { 20 } else { 64 };
            assert!(words.iter().all(|word| word.as_str().unwrap().len() <= longest), "{name}: {field}");
        }
        assert!(package["publish"].is_null(), "{name} is not to be published");
    }
}

#[test]
fn versions_agree() {
    let root = text("Cargo.toml");
    assert_eq!(value(&text("CITATION.cff"), "version"), value(&root, "version"));
    let oldest = value(&root, "rust-version");
    for manifest in ["benches/Cargo.toml", "examples/outside/Cargo.toml"] {
        assert_eq!(value(&text(manifest), "rust-version"), oldest, "{manifest}");
    }
    for document in ["README.md", "CONTRIBUTING.md", "bindings/python/README.md"] {
        assert!(text(document).contains(&format!("Rust {oldest}")), "{document}");
    }
}

/// The licences that `THIRD-PARTY.md` says what is asked by.
const EXPLAINED: [&str; 9] =
    ["MIT", "MIT-0", "Apache-2.0", "BSD-2-Clause", "BSD-3-Clause", "Zlib", "Unlicense", "Unicode-3.0", "LGPL-3.0+"];

/// Whether at least one of the alternatives of each part of an expression is explained.
fn is_explained(licence: &str) -> bool {
    let plain = licence.replace(['(', ')'], "").replace('/', " OR ");
    let offered = |part: &str| part.split(" OR ").any(|one| EXPLAINED.contains(&one.trim()));
    plain.split(" AND ").all(offered)
}

/// A package by name and version, with its licence.
type Linked = BTreeMap<(String, String), String>;

/// What is linked into what a package makes, in all: packages of others that it needs, those that run at build time aside.
fn linked(metadata: &Value, root: &str) -> Linked {
    let packages = metadata["packages"].as_array().unwrap();
    let named: BTreeMap<&str, &Value> = packages.iter().map(|one| (one["id"].as_str().unwrap(), one)).collect();
    let nodes = metadata["resolve"]["nodes"].as_array().unwrap();
    let nodes: BTreeMap<&str, &Value> = nodes.iter().map(|one| (one["id"].as_str().unwrap(), one)).collect();
    let is_macro =
        |package: &Value| package["targets"].as_array().unwrap().iter().any(|one| one["kind"][0] == "proc-macro");
    let start = packages.iter().find(|one| one["name"] == root && one["source"].is_null()).unwrap();
    let mut open = vec![start["id"].as_str().unwrap()];
    let mut seen = BTreeSet::new();
    let mut found = Linked::new();
    while let Some(id) = open.pop() {
        let package = named[id];
        if is_macro(package) || !seen.insert(id) {
            continue;
        }
        let field = |name: &str| package[name].as_str().unwrap_or("none").to_owned();
        if !package["source"].is_null() {
            found.insert((field("name"), field("version")), field("license"));
        }
        for edge in nodes[id]["deps"].as_array().unwrap() {
            if edge["dep_kinds"].as_array().unwrap().iter().any(|kind| kind["kind"].is_null()) {
                open.push(edge["pkg"].as_str().unwrap());
            }
        }
    }
    found
}

/// The tables of `THIRD-PARTY.md`, from its heading "Packages" on.
fn tables(program: &Linked, wheel: &Linked) -> String {
    let table = |linked: &mut dyn Iterator<Item = (&(String, String), &String)>| {
        let rows = linked.map(|((name, version), licence)| format!("| {name} | {version} | {licence} |\n"));
        format!("| package | version | licence |\n|---|---|---|\n{}", rows.collect::<String>())
    };
    let beside = table(&mut wheel.iter().filter(|(package, _)| !program.contains_key(*package)));
    let program = table(&mut program.iter());
    format!("## Packages\n\nIn the program:\n\n{program}\nBeside most of these, in the wheel:\n\n{beside}")
}

/// `SIGMASTAR_THIRD_PARTY=write` writes the tables again.
#[test]
fn what_is_linked_is_named() {
    let all = metadata(&["--filter-platform", "x86_64-unknown-linux-gnu"]);
    let (program, wheel) = (linked(&all, "sigmastar"), linked(&all, "sigmastar-python"));
    for ((name, version), licence) in program.iter().chain(&wheel) {
        assert!(is_explained(licence), "{name} {version}: THIRD-PARTY.md does not say what {licence} asks");
    }
    let page = text("THIRD-PARTY.md");
    let (words, _) = page.split_once("## Packages\n").expect("the heading of the tables");
    let made = format!("{words}{}", tables(&program, &wheel));
    if std::env::var_os("SIGMASTAR_THIRD_PARTY").is_some_and(|value| value == "write") {
        std::fs::write(Path::new(ROOT).join("THIRD-PARTY.md"), made).unwrap();
    } else {
        assert!(page == made, "THIRD-PARTY.md: make it again with SIGMASTAR_THIRD_PARTY=write");
    }
}

#[test]
fn licences_that_are_not_explained_are_seen() {
    for licence in
        ["MIT", "MIT/Apache-2.0", "Apache-2.0 / MIT", "GPL-3.0 OR MIT", "(MIT OR Apache-2.0) AND Unicode-3.0"]
    {
        assert!(is_explained(licence), "{licence}");
    }
    for licence in ["GPL-3.0", "none", "(MIT OR Apache-2.0) AND GPL-2.0", "MPL-2.0 OR GPL-3.0", ""] {
        assert!(!is_explained(licence), "{licence}");
    }
}
