//! `--format html`: every report is one page with balanced tags, links within itself alone, and no markup from files.

use crate::support::{EXAMPLE, EXAMPLE_TEXT, PLANT, PLANT_TEXT, answer, made, program, refuted_witness, utf8};
use insta::assert_snapshot;
use std::collections::HashSet;

const AT_REST: &str = "specs/paper-example-at-rest.json";
const JACOBIAN: &str = "specs/paper-example-jacobian.json";

/// The page of a call with this exit code.
#[track_caller]
fn page(arguments: &[&str], code: i32) -> String {
    let assert = program().args(arguments).args(["--format", "html"]).assert().code(code);
    utf8(assert.get_output().stdout.clone())
}

/// An element with the names and values of its attributes, and the one that it is in.
struct Element {
    name: String,
    attributes: Vec<(String, String)>,
    parent: String,
}

impl Element {
    fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str())
    }
}

/// Every `&` starts a character reference.
#[track_caller]
fn only_references(text: &str) {
    for rest in text.split('&').skip(1) {
        let known = ["lt;", "gt;", "amp;", "quot;", "apos;"].iter().any(|name| rest.starts_with(name));
        assert!(known, "&{}", rest.chars().take(20).collect::<String>());
    }
}

/// The attributes of a tag: names and values in double quotes.
#[track_caller]
fn attributes(mut rest: &str) -> Vec<(String, String)> {
    let mut found: Vec<(String, String)> = Vec::new();
    while !rest.trim().is_empty() {
        let (name, after) = rest.trim_start().split_once("=\"").unwrap_or_else(|| panic!("no value: {rest}"));
        let (value, after) = after.split_once('"').unwrap_or_else(|| panic!("no end: {rest}"));
        let plain = name.chars().all(|c| c.is_ascii_alphanumeric() || c == '-');
        assert!(plain && !name.starts_with("on") && found.iter().all(|(known, _)| known != name), "{name}");
        only_references(value);
        found.push((name.to_owned(), value.to_owned()));
        rest = after;
    }
    found
}

/// The elements of a page in their order; a tag that is not closed where it should be fails.
#[track_caller]
fn elements(page: &str) -> Vec<Element> {
    let mut rest = page.strip_prefix("<!DOCTYPE html>").expect("a page");
    let (mut open, mut found): (Vec<String>, Vec<Element>) = (Vec::new(), Vec::new());
    while let Some((text, tagged)) = rest.split_once('<') {
        let style = open.last().is_some_and(|name| name == "style");
        assert!(style || !text.contains('>'), "{text}");
        if !style {
            only_references(text);
        }
        let (tag, after) = tagged.split_once('>').expect("the end of a tag");
        rest = after;
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop().as_deref(), Some(name), "{found}", found = found.len());
            continue;
        }
        let closed = tag.ends_with('/');
        let tag = tag.trim_end_matches('/');
        let (name, given) = tag.split_once(' ').unwrap_or((tag, ""));
        let parent = open.last().cloned().unwrap_or_default();
        found.push(Element { name: name.to_owned(), attributes: attributes(given), parent });
        if !closed && name != "meta" {
            open.push(name.to_owned());
        }
    }
    assert!(open.is_empty() && rest.trim().is_empty(), "{open:?} {rest}");
    found
}

/// Where the parts of lists and tables belong.
const PARENTS: [(&str, &[&str]); 9] = [
    ("li", &["ul"]),
    ("dt", &["dl"]),
    ("dd", &["dl"]),
    ("thead", &["table"]),
    ("tbody", &["table"]),
    ("tr", &["thead", "tbody"]),
    ("th", &["tr"]),
    ("td", &["tr"]),
    ("summary", &["details"]),
];

/// The elements of a page that is whole in itself.
#[track_caller]
fn sound(page: &str) -> Vec<Element> {
    let found = elements(page);
    let mut names = HashSet::new();
    for element in &found {
        if let Some(id) = element.attribute("id") {
            assert!(names.insert(id.to_owned()), "two elements have the id {id}");
        }
        if let Some((_, parents)) = PARENTS.iter().find(|(name, _)| *name == element.name) {
            assert!(parents.contains(&element.parent.as_str()), "{} in {}", element.name, element.parent);
        }
        let foreign = ["script", "link", "img", "iframe", "object", "embed", "base", "form"];
        assert!(!foreign.contains(&element.name.as_str()), "{}", element.name);
        assert!(element.attribute("src").is_none() && element.attribute("style").is_none());
    }
    for link in found.iter().filter_map(|element| element.attribute("href")) {
        let name = link.strip_prefix('#').unwrap_or_else(|| panic!("a link to elsewhere: {link}"));
        assert!(names.contains(name), "no element has the id {name}");
    }
    // Every title can be linked to.
    for title in found.iter().filter(|element| ["h1", "h2", "h3"].contains(&element.name.as_str())) {
        assert_eq!(title.attribute("id").is_none(), title.parent == "summary", "{}", title.name);
    }
    let policy =
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline';";
    assert!(page.contains(policy));
    assert!(!page.contains("://") && !page.contains("url(") && !page.contains("@import"));
    found
}

fn count(found: &[Element], name: &str) -> usize {
    found.iter().filter(|element| element.name == name).count()
}

/// A call, its exit code, and how many figures and folded sections its page has.
type Case = (Vec<&'static str>, i32, [usize; 2]);

/// The titles and tables of a page are those of the report in Markdown.
#[track_caller]
fn every(cases: &[Case]) {
    for (arguments, code, expected) in cases {
        let page = answer(&[arguments, &["--format", "html"][..]].concat());
        assert_eq!(page.status.code(), Some(*code), "{arguments:?}");
        let found = sound(&utf8(page.stdout));
        assert_eq!(["figure", "details"].map(|name| count(&found, name)), *expected, "{arguments:?}");
        // A page is whole.
        let full = if ["certify", "transfer", "lyapunov"].contains(&arguments[0]) { &["--full"][..] } else { &[] };
        let output = answer(&[arguments, &["--format", "markdown"][..], full].concat());
        assert_eq!(output.status.code(), Some(*code), "{arguments:?}");
        let markdown = utf8(output.stdout);
        let lines = |starts: &str| markdown.lines().filter(|line| line.starts_with(starts)).count();
        let tables = lines("| --:") + lines("| :--");
        let titles = [lines("# "), lines("## "), lines("### "), tables];
        assert_eq!(["h1", "h2", "h3", "table"].map(|name| count(&found, name)), titles, "{arguments:?}");
    }
}

#[test]
fn reports_on_claims_are_pages() {
    every(&[
        (vec!["certify", EXAMPLE, "--target-sup", "1e-3"], 0, [4, 2]),
        (vec!["certify", EXAMPLE, "--witness", refuted_witness()], 1, [0, 1]),
        (vec!["certify", PLANT, "-q"], 0, [4, 0]),
        (vec!["certify", AT_REST, "-q", "--sampling-period", "1/1000"], 0, [3, 0]),
        (vec!["sampling", AT_REST, "-q", "--sampling-period", "1/1000", "--sigma", "1,25"], 0, [1, 0]),
        (vec!["transfer", EXAMPLE, "-q", "--n-o", "0,1,inf"], 0, [1, 1]),
        (vec!["lyapunov", JACOBIAN], 0, [0, 0]),
        (vec!["lyapunov", PLANT], 0, [0, 0]),
        (vec!["errata", EXAMPLE], 0, [0, 2]),
        (vec!["constants", EXAMPLE], 0, [0, 2]),
        (vec!["design", EXAMPLE, "-q", "--sigma", "50", "--n-o", "0"], 0, [0, 0]),
        (vec!["tune", EXAMPLE, "-q", "--over", "mu", "--tries", "8"], 0, [0, 0]),
    ]);
}

#[test]
fn reports_on_simulations_are_pages() {
    let simulate = ["simulate", PLANT, "-q", "--sigma", "2", "--n-o", "1", "--periods", "2"];
    let noisy = [&simulate[..], &["--noise-power", "1e-3"]].concat();
    let sampled = [&simulate[..], &["--sampled", "1/50"]].concat();
    every(&[(simulate.to_vec(), 0, [6, 0]), (noisy, 0, [6, 0]), (sampled, 0, [5, 0])]);
}

/// The checker's report is its own text.
#[test]
fn reports_on_certificates_are_pages() {
    let folder = tempfile::tempdir().unwrap();
    let certificate = folder.path().join("certificate.json");
    let certificate = certificate.to_str().expect("a plain name");
    program().args(["certify", AT_REST, "-q", "-o", certificate]).assert().success();
    let falsified = sound(&page(&["falsify", certificate, "-q", "--trials", "2"], 0));
    assert_eq!(["h1", "table", "figure"].map(|name| count(&falsified, name)), [1, 1, 0]);
    // A bar behind each row.
    assert_eq!(count(&falsified, "svg") + 1, count(&falsified, "tr"));
    let checked = page(&["check", certificate], 0);
    let found = sound(&checked);
    assert_eq!(["h1", "pre", "figure"].map(|name| count(&found, name)), [1, 1, 4]);
    assert!(checked.contains("<pre tabindex=\"0\">valid") && checked.contains("SHA-256"), "{checked}");
    // Through standard input too.
    let text = std::fs::read_to_string(certificate).unwrap();
    let piped = |text: &str| program().args(["check", "-", "--format", "html"]).write_stdin(text).assert();
    let output = piped(&text).code(0).get_output().clone();
    assert_eq!(utf8(output.stdout).replace("<code>-</code>", &format!("<code>{certificate}</code>")), checked);
    // The page trusts nothing that the checker refuses, nor words that its numbers do not give here.
    let refused = utf8(piped(&text.replacen("\"E0\": \"", "\"E0\": \"9", 1)).code(1).get_output().stdout.clone());
    assert_eq!([count(&sound(&refused), "h1"), count(&sound(&refused), "pre")], [0, 1]);
    let older = "proofs-check/tests/certificates/paper-example.sharp.json";
    let output = program().args(["check", older, "--format", "html"]).assert().code(0).get_output().clone();
    assert_eq!(count(&sound(&utf8(output.stdout)), "h1"), 0);
    assert!(utf8(output.stderr).contains("the page has the words of the checker alone"));
}

/// The page of a certificate of every kind says what the one of its claim says, its digest, and what is to be done after a check.
#[test]
fn a_stored_certificate_has_a_page() {
    let folder = tempfile::tempdir().unwrap();
    for (name, call) in [
        ("sampled", &["certify", AT_REST, "--no-alternatives", "--sampling-period", "1/1000"][..]),
        ("plant", &["certify", "specs/plants/pendulum.json", "--no-alternatives", "--n-o", "0,2"]),
        ("family", &["certify", "specs/machines/quarter-car.toml", "--no-alternatives"]),
    ] {
        let file = folder.path().join(name);
        let file = file.to_str().expect("a plain name");
        let (output, certificate) = made(&[call, &["-q", "--format", "html"]].concat());
        let claimed = utf8(output.stdout);
        std::fs::write(file, certificate).unwrap();
        let text = |arguments: &[&str]| utf8(program().args(arguments).assert().success().get_output().stdout.clone());
        let stored = page(&["check", file], 0);
        let found = sound(&stored);
        assert_eq!(count(&found, "h1"), 1, "{name}");
        let verdict = |page: &str| {
            page.split("<p class=\"verdict\">").nth(1).expect("a verdict").split("</p>").next().unwrap().to_owned()
        };
        assert_eq!(verdict(&stored), verdict(&claimed), "{name}");
        let said: serde_json::Value = serde_json::from_str(&text(&["check", file, "--format", "json"])).unwrap();
        let kind = if name == "sampled" { "specification_sha256" } else { "plant_sha256" };
        let digest = said[kind].as_str().expect("a digest");
        // Once by the checker and once by the report.
        assert_eq!(stored.matches(digest).count(), 2, "{name}");
        assert!(claimed.contains(digest), "{name}");
        let law = if name == "sampled" { "z_next" } else { "z'" };
        assert!(stored.contains("<dt>law</dt>") && stored.contains(law), "{name}");
        let next = |page: &str| {
            let (_, said) = page.split_once("<dt>next</dt>").expect("what is next");
            ["check", "controller", "simulate", "falsify"]
                .map(|command| said.split("</dd>").next().unwrap().contains(command))
        };
        assert_eq!(next(&claimed), [true, true, false, false], "{name}");
        // A simulation takes a plant.
        assert_eq!(next(&stored), [false, true, name != "sampled", true], "{name}");
    }
}

/// Names and texts of files are text, in titles, figures and anchors too.
#[test]
fn names_from_files_are_no_markup() {
    let hostile = "<script>alert('x')</script> $`n_o`$ & \\\" onload=\\\"y";
    let folder = tempfile::tempdir().unwrap();
    for (text, command) in [
        (EXAMPLE_TEXT, &["certify", "-q", "--no-alternatives"][..]),
        (EXAMPLE_TEXT, &["transfer", "-q", "--n-o", "1"]),
        (EXAMPLE_TEXT, &["errata"]),
        (PLANT_TEXT, &["simulate", "-q", "--sigma", "2", "--n-o", "1", "--periods", "1"]),
    ] {
        let start = text.find("\"name\": \"").expect("a name") + "\"name\": \"".len();
        let end = start + text[start..].find('"').expect("its end");
        let file = folder.path().join("hostile.json");
        std::fs::write(&file, format!("{}{hostile}{}", &text[..start], &text[end..])).unwrap();
        let page = page(&[command, &[file.to_str().expect("a plain name")]].concat(), 0);
        sound(&page);
        let shown = "&lt;script&gt;alert('x')&lt;/script&gt; $'n_o'$ &amp; &quot; onload=&quot;y";
        assert!(page.contains(&format!("<title>{shown}")) || page.contains(&format!("seen from {shown}")), "{page}");
    }
}

/// A page says what the text says; what is wrong with the input is told as ever, and there is no page.
#[test]
fn a_page_has_the_words_of_the_text() {
    let words = |text: &str| -> Vec<String> {
        let words = text.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
        words.map(str::to_owned).collect()
    };
    let arguments = ["sampling", AT_REST, "-q", "--sampling-period", "1/1000", "--sigma", "1,25"];
    let first = utf8(answer(&[&arguments[..], &["--format", "html"]].concat()).stdout);
    assert_eq!(first, page(&arguments, 0));
    let mut shown = String::new();
    let body = first.split_once("</head>").expect("a head").1;
    // The text has no figures.
    let (before, figure) = body.split_once("<figure").expect("a figure");
    let body = format!("{before}{}", figure.split_once("</figure>").expect("its end").1);
    for piece in body.replace("#</a>", "</a>").split('<').skip(1) {
        shown.push_str(piece.split_once('>').expect("the end of a tag").1);
        shown.push(' ');
    }
    let shown = [("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&amp;", "&"), ("σ", "sigma"), ("θ", "theta")]
        .iter()
        .fold(shown, |text, (reference, character)| text.replace(reference, character));
    let text = utf8(program().args(arguments).assert().success().get_output().stdout.clone());
    assert_eq!(words(&shown), words(&text));
    let refused = program().args(["certify", "specs/invalid/unknown-field.json", "--format", "html"]).assert().code(2);
    assert!(refused.get_output().stdout.is_empty() && !refused.get_output().stderr.is_empty());
}

#[test]
fn a_short_page() {
    let page = page(&["lyapunov", JACOBIAN], 0);
    let (head, body) = page.split_once("</style>").expect("a style");
    assert!(head.starts_with("<!DOCTYPE html>\n<html lang=\"en\"><head>\n<meta charset=\"utf-8\">\n"), "{head}");
    assert_snapshot!("html-lyapunov", body);
}
