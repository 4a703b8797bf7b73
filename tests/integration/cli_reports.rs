//! Reports as users see them, held against reviewed copies in `tests/integration/snapshots`: one report as a whole, and of
//! the others what is special to them, so that a digit that changes is in few copies.

use crate::support::{answer, utf8};
use insta::assert_snapshot;
use std::sync::LazyLock;

/// What `sigmastar certify` writes to both streams, and its exit code.
fn shown(args: &[&str]) -> String {
    let output = answer(&[&["certify"], args].concat());
    format!(
        "exit code {}\n--- standard output\n{}--- standard error\n{}",
        output.status.code().map_or_else(|| "none".to_owned(), |code| code.to_string()),
        utf8(output.stdout),
        utf8(output.stderr)
    )
}

/// The standard output of a run with this exit code and no errors.
fn output(shown: &str, code: i32) -> &str {
    let output = shown.strip_prefix(&format!("exit code {code}\n--- standard output\n"));
    output.and_then(|rest| rest.strip_suffix("--- standard error\n")).unwrap_or_else(|| panic!("{shown}"))
}

const TARGETS: [&str; 6] = ["specs/paper-example.json", "--target-sup", "1e-3", "--target-rms", "1/1000", "--full"];

/// The report that is held as a whole.
static EXAMPLE: LazyLock<String> = LazyLock::new(|| shown(&TARGETS));

/// Tables and sentences fit a terminal of 100 columns.
fn fits(report: &str) {
    for line in report.lines() {
        assert!(line.chars().count() <= 100, "{line}");
    }
}

/// Where the sections of a report start, and their titles: in Markdown what `#` marks; in a text what is underlined, and
/// paragraphs of one line that end with a colon.
fn titles(report: &str) -> Vec<(usize, String)> {
    let lines: Vec<&str> = report.lines().collect();
    let markdown = report.starts_with('#');
    let empty = |at: usize| lines.get(at).is_none_or(|line| line.is_empty());
    let underlined = |at: usize| {
        let same = |mark: char| lines.get(at + 1).is_some_and(|rule| *rule == mark.to_string().repeat(lines[at].len()));
        same('=') || same('-')
    };
    let title = |(at, line): (usize, &&str)| {
        let text = match line.strip_prefix('#') {
            Some(rest) if markdown => rest.trim_start_matches('#').trim().replace('\\', ""),
            _ if markdown || line.is_empty() || line.starts_with(' ') => return None,
            _ if underlined(at) => (*line).to_owned(),
            _ if at > 0 && empty(at - 1) && empty(at + 1) => line.strip_suffix(':')?.to_owned(),
            _ => return None,
        };
        Some((at, text))
    };
    lines.iter().enumerate().filter_map(title).collect()
}

/// The titles below that of the report; that with sigma* without its digits.
fn outline(report: &str) -> Vec<String> {
    let plain = |(_, title): (usize, String)| match title.split_once(" = ") {
        Some(("sigma*", rest)) => rest.split_once(' ').map_or_else(String::new, |(_, rest)| format!("sigma* {rest}")),
        _ => title,
    };
    titles(report).into_iter().skip(1).map(plain).collect()
}

/// The sections whose titles start like this, in this order, each as far as the next title.
fn sections(report: &str, wanted: &[&str]) -> String {
    let (lines, titles): (Vec<&str>, _) = (report.lines().collect(), titles(report));
    let section = |wanted: &&str| {
        let found: Vec<usize> = (0..titles.len()).filter(|at| titles[*at].1.starts_with(wanted)).collect();
        assert_eq!(found.len(), 1, "{wanted}: {titles:?}");
        let end = titles.get(found[0] + 1).map_or(lines.len(), |next| next.0);
        lines[titles[found[0]].0..end].join("\n").trim_end().to_owned()
    };
    wanted.iter().map(section).collect::<Vec<_>>().join("\n\n")
}

/// The words of a report, without what draws tables, lists and titles.
fn words(report: &str) -> Vec<String> {
    let plain = report.replace(['\\', '|', '#'], "");
    let words = plain.split_whitespace().filter(|word| word.chars().any(|c| !"-:=".contains(c)));
    words.map(|word| word.trim_end_matches(':').to_owned()).collect()
}

const SPECIFICATION: &str = "From the specification alone";
const CERTIFICATE: &str = "At X_p, E_p, sigma of the certificate";
const WITHOUT: &str = "Without a value";
const PRINTED: &str = "What the printed formulas say";
const LIMITING: &str = "Limiting condition of sigma* (estimates)";

/// In Markdown there is the same as in the text.
#[test]
fn paper_example() {
    fits(&EXAMPLE);
    assert_snapshot!("text-paper-example", *EXAMPLE);
    let text = output(&EXAMPLE, 0);
    let markdown = shown(&[&TARGETS[..], &["--format", "markdown"]].concat());
    let markdown = output(&markdown, 0);
    assert_eq!(words(markdown), words(text));
    assert_eq!(outline(markdown), outline(text));
    let special = sections(markdown, &["Example of the paper", SPECIFICATION, WITHOUT, PRINTED]);
    assert_snapshot!("markdown-paper-example", special);
}

#[test]
fn other_plants() {
    let titles = outline(output(&EXAMPLE, 0));
    for (name, special) in [
        ("no-x", &["Matrix inequalities", SPECIFICATION, WITHOUT, PRINTED, LIMITING][..]),
        ("linear", &["Linear", "Conditions", WITHOUT, LIMITING]),
        ("ill-conditioned", &[CERTIFICATE, WITHOUT, PRINTED]),
    ] {
        let report = shown(&[&format!("specs/{name}.json"), "--full"]);
        fits(&report);
        let report = output(&report, 0);
        assert_eq!(outline(report), titles, "{name}");
        assert_snapshot!(format!("text-{name}"), sections(report, special));
    }
}

#[test]
fn refusals() {
    for name in ["decreasing-bound", "negative-bound", "matched-undecided", "misspelt-field"] {
        let path = format!("specs/invalid/{name}.json");
        assert_snapshot!(format!("refused-{name}"), shown(&[&path]));
    }
    assert_snapshot!("refused-json", shown(&["specs/invalid/decreasing-bound.json", "--format", "json"]));
    assert_snapshot!("refused-missing-file", shown(&["specs/papr-example.json"]));
    assert_snapshot!("refused-target", shown(&["specs/paper-example.json", "--target-sup", "1/0"]));
}

/// A command with a report is called in the tests that hold every report, and with a short form in those of short forms.
#[test]
fn every_command_with_a_report_is_in_the_tests_of_reports() {
    let help = |arguments: &[&str]| utf8(answer(&[arguments, &["--help"]].concat()).stdout);
    let listed = help(&[]);
    let (_, commands) = listed.split_once("Commands:\n").expect("the commands");
    let named = commands.lines().take_while(|line| !line.is_empty()).filter(|line| !line.starts_with("   "));
    let mut reports = 0;
    for name in named.map(|line| line.split_whitespace().next().expect("a name")).filter(|name| *name != "help") {
        let flags = help(&[name]);
        if !flags.contains("- markdown:") {
            continue;
        }
        reports += 1;
        let call = format!("[\"{name}\"");
        let every = [
            ("html.rs", include_str!("html.rs"), true),
            ("chromium.rs", include_str!("chromium.rs"), true),
            ("formats.rs", include_str!("formats.rs"), true),
            ("short_reports.rs", include_str!("short_reports.rs"), flags.contains("--full")),
        ];
        for (file, text, expected) in every {
            assert!(!expected || text.contains(&call), "`{name}` has a report, and no call is in {file}");
        }
    }
    assert!(reports >= 10, "{listed}");
}
