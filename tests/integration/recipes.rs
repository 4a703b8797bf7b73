//! "Recipes" (docs/guide/recipes.md): each of its files is certified as the page says, and its certificate is decided by the checker.

use crate::gallery::{page, table};
use crate::support::{ROOT, assert_valid, json, made, number, stem, stored};
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;
use tempfile::TempDir;

/// Of the file that the table of `mu` is about, and the gain that it is for.
const DRAG: &str = "specs/recipes/drag.toml";
const AT: &str = "5";

#[test]
fn each_recipe_certifies_as_the_page_says() {
    let rows = table(&page("guide/recipes.md"), "| file | what it shows | sigma* |");
    let folder = std::fs::read_dir(Path::new(ROOT).join("specs/recipes")).unwrap();
    let there: BTreeSet<String> = folder.map(|entry| stem(&entry.unwrap().path()).to_owned()).collect();
    assert!(rows.keys().eq(&there), "{there:?}");
    let folder = TempDir::new().unwrap();
    for (name, cells) in rows {
        let file = format!("specs/recipes/{name}.toml");
        let (output, certificate) = made(&["certify", &file, "--quiet", "--no-alternatives", "--format", "json"]);
        let report = json(&output.stdout);
        assert_eq!(report["verdict"], "certified", "{name}: {report:#}");
        let gain = report.get("sigma_star").unwrap_or(&report["sigma"]);
        assert_eq!(Value::from(cells[2].as_str()), *gain, "{name}");
        assert_valid(&stored(folder.path(), &format!("{name}.json"), &json(&certificate)));
    }
}

#[test]
#[ignore = "search tier"]
fn the_rates_by_mu_are_those_of_the_page() {
    let text = page("guide/recipes.md");
    let header = "| mu | rate, n_o = 0 | rate, n_o = 3 |";
    let rows = text.lines().skip_while(|line| *line != header).skip(2).map_while(|line| line.strip_prefix("| "));
    let rows: Vec<Vec<&str>> = rows.map(|row| row.trim_end_matches(" |").split(" | ").collect()).collect();
    assert_eq!(rows.len(), 5, "{rows:?}");
    let folder = TempDir::new().unwrap();
    let plain = std::fs::read_to_string(DRAG).unwrap();
    for row in rows {
        let file = folder.path().join(format!("drag-{}.toml", row[0]));
        let changed = plain.replace("\nmu = 3\n", &format!("\nmu = {}\n", row[0]));
        assert!(row[0] == "3" || changed != plain, "the file has no such line");
        std::fs::write(&file, changed).unwrap();
        let file = file.to_str().unwrap();
        let (output, _) =
            made(&["certify", file, "--sigma", AT, "--n-o", "0,3", "--quiet", "--no-alternatives", "--format", "json"]);
        let report = json(&output.stdout);
        for (place, cell) in row.iter().enumerate().skip(1) {
            let rate = number(&report["for_n_o"][place - 1]["rate"]);
            let shown: f64 = cell.parse().unwrap();
            assert!((shown / rate - 1.0).abs() < 1e-3 && shown <= rate, "mu = {}: {cell}, not {rate}", row[0]);
        }
    }
}
