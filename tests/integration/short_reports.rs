//! The short forms of reports, and how to see the rest.

use crate::support::{EXAMPLE, PLANT, ROOT, answer, every, files, guide, refuted_witness, stem, utf8};

const AT_REST: &str = "specs/paper-example-at-rest.json";
const JACOBIAN: &str = "specs/paper-example-jacobian.json";
const REMARK: &str = "this is the short form; `--full` shows the whole report";

/// Standard output, standard error, and the exit code.
fn run(arguments: &[&str]) -> (String, String, i32) {
    let output = answer(arguments);
    (utf8(output.stdout), utf8(output.stderr), output.status.code().expect("it ends by itself"))
}

/// A screen: 25 lines of 100 columns, beside a table by the number of oscillators.
#[track_caller]
fn fits(report: &str) {
    let is_row = |line: &str| line.split_whitespace().next().is_some_and(|first| first.parse::<u64>().is_ok());
    let is_of_table = |line: &&str| {
        line.contains("n_o  steady |e|") || line.starts_with("  ---") || (line.starts_with("  ") && is_row(line))
    };
    let table = report.lines().filter(is_of_table).count();
    assert!(table <= 8, "{report}");
    assert!(report.lines().count() - table <= 25, "{report}");
    assert!(report.lines().all(|line| line.chars().count() <= 100), "{report}");
}

#[track_caller]
fn answers(report: &str) {
    assert!(
        ["sigma", "exactly that sigma"].iter().any(|gain| report.contains(&format!("  - gain: {gain}"))),
        "{report}"
    );
    for fact in ["initial set: |", "next: `", "limited by: ", "periodic solution: |", "assumed: "] {
        assert!(report.contains(&format!("  - {fact}")), "{fact}: {report}");
    }
}

#[test]
fn claims_fit_a_screen() {
    for path in files("specs").into_iter().step_by(every(3)) {
        let path = format!("specs/{}.json", stem(&path));
        let (report, remarks, code) = run(&["certify", &path, "--no-alternatives"]);
        assert_eq!(code, 0, "{path}");
        fits(&report);
        answers(&report);
        assert!(remarks.contains(REMARK), "{remarks}");
    }
    for arguments in [
        &["certify", PLANT][..],
        &["certify", AT_REST, "--sampling-period", "1/1000"],
        &["certify", "specs/plants/motor-axis.json", "--sampling-period", "1/20000", "--no-alternatives"],
        &["certify", EXAMPLE, "--target-sup", "1e-3", "--target-rms", "1e-3"],
    ] {
        let (report, _, code) = run(&[arguments, &["-q"]].concat());
        assert_eq!(code, 0, "{arguments:?}");
        fits(&report);
        answers(&report);
    }
}

/// What failed, why, and what to try.
#[test]
fn what_is_not_certified_fits_a_screen() {
    for (arguments, code, words) in [
        (&["certify", EXAMPLE, "--witness", refuted_witness()][..], 1, "Refuted: no sigma is certified here"),
        (&["certify", EXAMPLE, "--sigma", "30"], 3, "Undecided: no sigma is certified here"),
        (
            &["certify", AT_REST, "--sampling-period", "1/10"],
            3,
            "Undecided: nothing is certified at the sampling period",
        ),
    ] {
        let (report, _, got) = run(&[arguments, &["-q"]].concat());
        assert_eq!(got, code, "{arguments:?}");
        fits(&report);
        assert!(report.contains(words) && report.contains("What to try:\n\n  - "), "{report}");
    }
}

/// A witness of which nearly every condition fails: three are shown, the rest with `--full`.
#[test]
fn of_many_conditions_the_first_are_shown() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("certificate.json");
    let name = file.to_str().expect("a plain name");
    assert_eq!(run(&["certify", EXAMPLE, "-q", "-o", name]).2, 0);
    let mut certificate: serde_json::Value = serde_json::from_slice(&std::fs::read(&file).unwrap()).unwrap();
    for number in ["r_e", "r_d", "D_x", "k0"] {
        certificate["witness"][number] = "1e-9".into();
    }
    std::fs::write(&file, certificate.to_string()).unwrap();
    let (short, _, code) = run(&["certify", EXAMPLE, "-q", "--witness", name]);
    assert_eq!(code, 1, "{short}");
    fits(&short);
    let (full, ..) = run(&["certify", EXAMPLE, "-q", "--full", "--witness", name]);
    let more = short.split_once("  - and ").expect("more than three").1.split_once(" more").expect("their number").0;
    let further = full.split_once("Further conditions that are not proved").expect("the rest").1;
    let list: Vec<&str> = further.trim_start_matches(['-', '\n']).lines().take_while(|line| !line.is_empty()).collect();
    let items = list.iter().filter(|line| line.starts_with("  - ")).count();
    assert_eq!((items, more), (more.parse().unwrap(), items.to_string().as_str()), "{full}");
}

/// The short form is how the whole report starts; HTML and JSON are whole either way.
#[test]
fn the_whole_report_starts_with_the_short_one() {
    let certificate = "proofs-check/tests/certificates/paper-example.means.json";
    for arguments in [
        &["certify", EXAMPLE][..],
        &["certify", EXAMPLE, "--witness", refuted_witness()],
        &["certify", AT_REST, "--sampling-period", "1/1000"],
        &["transfer", EXAMPLE, "--n-o", "0,1"],
        &["lyapunov", JACOBIAN],
        &["lyapunov", PLANT],
        &["falsify", certificate, "--trials", "2"],
    ]
    .into_iter()
    .step_by(every(2))
    {
        let with = |more: &[&str]| run(&[arguments, more].concat());
        for format in ["text", "markdown"] {
            let (short, remarks, _) = with(&["--format", format]);
            let (full, quiet, _) = with(&["--format", format, "--full"]);
            assert!(full.starts_with(&short) && full.len() > short.len(), "{arguments:?}: {short}");
            assert_eq!((remarks.matches(REMARK).count(), quiet.matches(REMARK).count()), (1, 0), "{remarks}");
        }
        for format in ["html", "json"] {
            let (usual, remarks, _) = with(&["--format", format]);
            assert_eq!(usual, with(&["--format", format, "--full"]).0, "{arguments:?}");
            assert!(!remarks.contains(REMARK), "{remarks}");
        }
    }
    // Nothing is promised where there is nothing more.
    let (_, remarks, _) = run(&["certify", AT_REST, "--sampling-period", "1/10"]);
    assert!(!remarks.contains(REMARK), "{remarks}");
    let (_, remarks, _) = run(&["certify", EXAMPLE, "--no-alternatives", "--quiet"]);
    assert!(remarks.is_empty(), "{remarks}");
}

/// What README.md shows of the example is what the program says.
#[test]
fn the_example_of_the_readme_is_the_report() {
    let readme = std::fs::read_to_string(std::path::Path::new(ROOT).join("README.md")).unwrap();
    let shown = readme.split_once("```text\n").and_then(|(_, rest)| rest.split_once("```")).expect("an example").0;
    assert_eq!(shown, run(&["certify", EXAMPLE, "-q"]).0);
    assert!(guide().contains(&format!("```text\n{shown}```")), "{shown}");
}
