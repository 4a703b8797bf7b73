//! "From a plant to a controller that ships" (docs/guide/ships.md): its commands run, and say what the page says.

use crate::controller::installed;
use crate::controller_c::gcc;
use crate::support::{every, in_one_line, json, made, number, program};
use serde_json::Value;
use std::path::Path;

const FILE: &str = "specs/shipping/motor-axis.toml";

/// The exit code, the report and the certificate of a call on the page, made once.
fn certified(more: &[&str]) -> (i32, Value, Vec<u8>) {
    let call = ["certify", FILE, "--n-o", "0,4,10", "--format", "json", "-q"];
    let (output, certificate) = made(&[&call[..], more].concat());
    (output.status.code().unwrap(), json(&output.stdout), certificate)
}

/// A bound in four digits, rounded up, and the shortest way to write it.
fn up(value: &Value) -> String {
    let value = number(value);
    let unit = 10f64.powi(value.log10().floor() as i32 - 3);
    let rounded = ((value / unit - 1e-9).ceil() * unit * 1e6).round() / 1e6;
    rounded.to_string()
}

#[test]
fn the_page_says_what_its_commands_say() {
    let page = std::fs::read_to_string("docs/guide/ships.md").unwrap();
    let lines: Vec<&str> = page.lines().filter(|line| line.starts_with('|')).collect();
    let line = |start: &str| *lines.iter().find(|line| line.starts_with(start)).unwrap_or_else(|| panic!("{start}"));
    for (asked, flags) in
        [("--peak-error 25", &["--peak-error", "25"][..]), ("--peak-error 15", &["--peak-error", "15"])]
    {
        let (code, report, _) = certified(flags);
        assert_eq!(code, 0, "{report:#}");
        let own = &report["gains"][0];
        let control = number(&own["control"]["steady"]) + number(&own["control"]["transient"]);
        let four = &report["for_n_o"][1];
        let cells = [
            report["sigma"].as_str().unwrap().to_owned(),
            up(&own["peak_error"]),
            up(&control.to_string().into()),
            up(&four["noise"]["limit"]),
        ];
        assert!(line(&format!("| `{asked}` |")).contains(&cells.join(" | ")), "{asked}: {cells:?}");
        if asked == "--peak-error 25" {
            let steady = format!("at most {} without oscillators", up(&report["by_n_o"][0]["steady_error"]));
            assert!(in_one_line(&page).contains(&steady), "{steady}");
            for found in report["for_n_o"].as_array().unwrap() {
                let cells = [&found["noise"]["limit"], &found["noise"]["peak"]].map(up);
                let row = line(&format!("| {} |", found["n_o"]));
                assert!(row.contains(&cells.join(" | ")), "{row} {cells:?}");
                assert!(row.contains(&format!("| {} exp(-", up(&found["factor"]))), "{row}");
            }
        }
    }
    // Its search tries many gains.
    if every(2) == 1 {
        let (code, missed, _) = certified(&["--peak-error", "60", "--rate", "4"]);
        let said = missed["statement"].as_str().unwrap();
        assert!(
            code == 3 && said.contains("n_o = 10 is not proved to be at least 4") && said.contains("about 1.41"),
            "{said}"
        );
    }
}

#[test]
fn its_controller_compiles_and_its_header_says_all_of_it() {
    let folder = tempfile::tempdir().unwrap();
    let (code, _, made) = certified(&["--peak-error", "60"]);
    assert_eq!(code, 0);
    let [certificate, source] = ["axis.certificate.json", "axis.c"].map(|name| folder.path().join(name));
    std::fs::write(&certificate, made).unwrap();
    program().arg("check").arg(&certificate).assert().success();
    let call = ["--n-o", "4", "--format", "c", "-o"];
    program().arg("controller").arg(&certificate).args(call).arg(&source).assert().success();
    let header = std::fs::read_to_string(source.with_extension("h")).unwrap();
    let header = header.split_whitespace().filter(|word| *word != "*").collect::<Vec<_>>().join(" ");
    for words in [
        "a constant 'load' of the file in [1350, 1650]",
        "noise of at most (40/4096) on the measurement of e",
        "The bounds of the certificate with n_o = 4 that say",
        "quantisation that these bounds do not name",
    ] {
        assert!(header.contains(words), "{words}: {header}");
    }
    if installed("gcc", &["--version"]) {
        gcc(&[Path::new("-c"), &source], &folder.path().join("axis.o"));
    }
}
