//! What is passed on: every package says what a registry wants to know, versions agree, and `THIRD-PARTY.md` names all that is linked.

use crate::support::ROOT;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;

fn text(path: &str) -> String {
    std::fs::read_to_string(Path::new(ROOT).join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// What cargo says of a manifest and of what it depends on; none, with the reason on standard error, where it cannot.
fn metadata(manifest: &str, options: &[&str]) -> Option<Value> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.current_dir(ROOT).args(["metadata", "--format-version", "1", "--locked", "--manifest-path", manifest]);
    let output = command.args(options).output().expect("cargo runs");
    if !output.status.success() {
        eprintln!("{}", String::from_utf8_lossy(&output.stderr));
        return None;
    }
    Some(serde_json::from_slice(&output.stdout).expect("cargo writes JSON"))
}

/// The value of a key in a manifest, the first one.
fn value<'t>(text: &'t str, key: &str) -> &'t str {
    let line = text.lines().find_map(|line| line.strip_prefix(key)).unwrap_or_else(|| panic!("no {key}"));
    line.trim_matches([' ', '=', ':', '"'])
}

/// What each package has to say: cargo itself asks for no keywords and no readme.
#[test]
fn every_package_can_be_published() {
    let metadata = metadata("Cargo.toml", &["--no-deps"]).expect("the workspace is read");
    let packages = metadata["packages"].as_array().unwrap();
    assert!(packages.len() >= 20);
    for package in packages {
        let name = package["name"].as_str().unwrap();
        for field in ["description", "license", "repository", "readme", "rust_version"] {
            assert!(package[field].as_str().is_some_and(|text| !text.is_empty()), "{name}: {field}");
        }
        for field in ["keywords", "categories"] {
            let words = package[field].as_array().unwrap();
            // The limits of the registry.
            assert!((1..=5).contains(&words.len()), "{name}: {field}");
            assert!(words.iter().all(|word| word.as_str().unwrap().len() <= 20), "{name}: {field}");
        }
        assert!(package["publish"].is_null(), "{name} is not to be published");
        for dependency in package["dependencies"].as_array().unwrap() {
            let own = !dependency["path"].is_null();
            let exactly = format!("={}", package["version"].as_str().unwrap());
            // Another version may prove another number.
            assert!(!own || dependency["req"] == *exactly, "{name}: {}", dependency["name"]);
        }
    }
}

#[test]
fn versions_agree() {
    let root = text("Cargo.toml");
    assert_eq!(value(&text("bindings/python/Cargo.toml"), "version"), value(&root, "version"));
    assert_eq!(value(&text("CITATION.cff"), "version"), value(&root, "version"));
    let oldest = value(&root, "rust-version");
    for manifest in ["benches/Cargo.toml", "examples/outside/Cargo.toml", "bindings/python/Cargo.toml"] {
        assert_eq!(value(&text(manifest), "rust-version"), oldest, "{manifest}");
    }
    for document in ["README.md", "CONTRIBUTING.md", "bindings/python/README.md"] {
        assert!(text(document).contains(&format!("Rust {oldest}")), "{document}");
    }
}
