//! The documents: every link and every anchor resolves, in the book as on a code host, and formulas are written so that
//! both typeset them.

use crate::support::ROOT;
use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Documents outside of the book.
const OUTSIDE: [&str; 5] = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md", "THIRD-PARTY.md"];

/// The texts of documents by their paths from the root.
type Texts = BTreeMap<String, String>;

fn shipped() -> Texts {
    let pages = |folder: &'static str| {
        let entries = std::fs::read_dir(Path::new(ROOT).join(folder)).into_iter().flatten();
        entries
            .map(move |entry| {
                format!("{folder}/{}", entry.expect("an entry").file_name().to_str().expect("plain names"))
            })
            .filter(|path| path.ends_with(".md"))
    };
    let chapters = pages("docs").chain(pages("docs/guide"));
    let text = |path: String| {
        let text =
            std::fs::read_to_string(Path::new(ROOT).join(&path)).unwrap_or_else(|error| panic!("{path}: {error}"));
        (path, text)
    };
    OUTSIDE.map(str::to_owned).into_iter().chain(chapters).map(text).collect()
}

fn parser(text: &str) -> Parser<'_> {
    Parser::new_ext(text, Options::ENABLE_TABLES | Options::ENABLE_STRIKETHROUGH)
}

/// The targets of links and images.
fn links(text: &str) -> Vec<String> {
    let target = |event| match event {
        Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => Some(dest_url.into_string()),
        _ => None,
    };
    parser(text).filter_map(target).collect()
}

/// The anchors of the headings, by the rule that mdBook and code hosts share: small letters, digits, `-` and `_` stay, a
/// space becomes `-`, anything else goes; a second one of a name gets `-1`.
fn anchors(text: &str) -> BTreeSet<String> {
    let mut anchors = BTreeSet::new();
    let mut heading: Option<String> = None;
    for event in parser(text) {
        match event {
            Event::Start(Tag::Heading { .. }) => heading = Some(String::new()),
            Event::Text(text) | Event::Code(text) => {
                if let Some(heading) = &mut heading {
                    heading.push_str(&text);
                }
            }
            Event::End(TagEnd::Heading(_)) => {
                let name: String = heading
                    .take()
                    .unwrap_or_default()
                    .trim()
                    .to_lowercase()
                    .chars()
                    .filter(|c| c.is_alphanumeric() || matches!(c, '-' | '_' | ' '))
                    .map(|c| if c == ' ' { '-' } else { c })
                    .collect();
                let mut unique = name.clone();
                let mut count = 0;
                while !anchors.insert(unique.clone()) {
                    count += 1;
                    unique = format!("{name}-{count}");
                }
            }
            _ => {}
        }
    }
    anchors
}

/// A path relative to the folder of a document, from the root; none where it leaves the root.
fn from_root(document: &str, path: &str) -> Option<String> {
    let mut parts: Vec<&str> = document.split('/').collect();
    parts.pop();
    for part in path.split('/') {
        match part {
            "." => {}
            ".." => drop(parts.pop()?),
            _ => parts.push(part),
        }
    }
    Some(parts.join("/"))
}

/// The links that do not resolve.
fn broken(texts: &Texts, exists: &dyn Fn(&str) -> bool) -> Vec<String> {
    let anchors: BTreeMap<&str, _> = texts.iter().map(|(path, text)| (path.as_str(), anchors(text))).collect();
    let mut broken = Vec::new();
    for (document, text) in texts {
        for link in links(text).iter().filter(|link| !link.contains("://")) {
            let mut says = |what: &str| broken.push(format!("{document}: {link}: {what}"));
            let (path, anchor) =
                link.split_once('#').map_or((link.as_str(), None), |(path, anchor)| (path, Some(anchor)));
            let target = if path.is_empty() { Some(document.clone()) } else { from_root(document, path) };
            match target.filter(|target| exists(target)) {
                None => says("no such file"),
                Some(target) => {
                    if document.starts_with("docs/") && !target.starts_with("docs/") {
                        says("the book has no such page");
                    }
                    let known = |anchor| anchors.get(target.as_str()).is_some_and(|names| names.contains(anchor));
                    if anchor.is_some_and(|anchor| !known(anchor)) {
                        says("no such heading");
                    }
                }
            }
        }
    }
    broken
}

/// Formulas that one of the two would not typeset: `$` on one side only, or a bar in a table, where Markdown wants `\|`
/// and TeX reads it as the double bar of a norm.
fn bad_formulas(text: &str) -> Vec<String> {
    let events: Vec<Event> = parser(text).collect();
    let mut bad = Vec::new();
    let mut in_table = false;
    for (index, event) in events.iter().enumerate() {
        match event {
            Event::Start(Tag::Table(_)) => in_table = true,
            Event::End(TagEnd::Table) => in_table = false,
            Event::Code(code) => {
                let text = |index: Option<usize>| match index.and_then(|index| events.get(index)) {
                    Some(Event::Text(text)) => text.to_string(),
                    _ => String::new(),
                };
                let opens = text(index.checked_sub(1)).ends_with('$');
                let closes = text(Some(index + 1)).starts_with('$');
                if opens != closes || (opens && in_table && code.contains('|')) {
                    bad.push(code.to_string());
                }
            }
            _ => {}
        }
    }
    bad
}

#[test]
fn every_link_of_the_documents_resolves() {
    let broken = broken(&shipped(), &|path| Path::new(ROOT).join(path).exists());
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

#[test]
fn links_that_do_not_resolve_are_found() {
    let texts = |guide: &str| {
        let readme = "# Read me\n\n## The same\n\n## The same\n\n[guide](docs/guide.md#use-it-now)".to_owned();
        let guide = format!("# Guide\n\n## Use *it*, `now`!\n\n{guide}");
        Texts::from([("README.md".to_owned(), readme), ("docs/guide.md".to_owned(), guide)])
    };
    let exists = |path: &str| matches!(path, "README.md" | "docs/guide.md" | "docs/figures/one.svg");
    let right = "[a](#guide) [b](guide.md#use-it-now) ![c](figures/one.svg) [d](./guide.md) [e](https://example.org/x)";
    assert_eq!(broken(&texts(right), &exists), Vec::<String>::new());
    for (wrong, says) in [
        ("[a](#gide)", "docs/guide.md: #gide: no such heading"),
        ("[a](guide.md#the-same)", "docs/guide.md: guide.md#the-same: no such heading"),
        ("[a](errata.md)", "docs/guide.md: errata.md: no such file"),
        ("![a](figures/two.svg)", "docs/guide.md: figures/two.svg: no such file"),
        ("[a](../README.md)", "docs/guide.md: ../README.md: the book has no such page"),
        ("[a](../../README.md)", "docs/guide.md: ../../README.md: no such file"),
    ] {
        assert_eq!(broken(&texts(wrong), &exists), [says]);
    }
    let twice = anchors("## The same\n\n## The same");
    assert_eq!(twice, BTreeSet::from(["the-same".to_owned(), "the-same-1".to_owned()]));
}

/// What is in docs is a chapter, and what the book lists is there.
#[test]
fn every_document_is_a_chapter_of_the_book() {
    let texts = shipped();
    let listed: BTreeSet<String> =
        links(&texts["docs/SUMMARY.md"]).iter().filter_map(|link| from_root("docs/SUMMARY.md", link)).collect();
    let there: BTreeSet<String> =
        texts.into_keys().filter(|path| path.starts_with("docs/") && path != "docs/SUMMARY.md").collect();
    assert_eq!(listed, there);
}

#[test]
fn formulas_are_typeset_everywhere() {
    for (document, text) in shipped() {
        assert_eq!(bad_formulas(&text), Vec::<String>::new(), "{document}");
    }
    assert_eq!(bad_formulas("Then $`a < b`$ and `c`."), Vec::<String>::new());
    assert_eq!(bad_formulas("Then $`a < b` and `c`."), ["a < b"]);
    assert_eq!(bad_formulas("Then `a < b`$."), ["a < b"]);
    assert_eq!(bad_formulas("| a |\n|---|\n| $`\\vert x \\vert`$ |"), Vec::<String>::new());
    assert_eq!(bad_formulas("| a |\n|---|\n| $`\\|x\\|`$ |"), ["|x|"]);
}

/// Where m4 is missing GMP is built without it, as the README says: by a setting that a build from the cache does not need and
/// nobody would miss before a new machine does.
#[test]
fn the_build_without_m4_is_set_up() {
    let folder = Path::new(ROOT).join(".cargo");
    let config = std::fs::read_to_string(folder.join("config.toml")).unwrap();
    assert!(
        config.contains("\n[env]\n")
            && config.contains("\nCONFIG_SITE = { value = \".cargo/config.site\", relative = true }\n")
    );
    assert!(std::fs::read_to_string(folder.join("config.site")).unwrap().contains("gmp_cv_prog_m4"));
}

/// The numbers of section 13 of the mathematics: its subsections, its formulas and its results.
fn numbers_of_13(mathematics: &str) -> [BTreeSet<String>; 3] {
    let after = |before: &'static str, end: char| -> BTreeSet<String> {
        let found = mathematics.split(before).skip(1);
        found.filter_map(|rest| rest.split_once(end)).map(|(number, _)| format!("13.{number}")).collect()
    };
    let results = ["**Theorem 13.", "**Proposition 13."].into_iter();
    let results = results.flat_map(|before| after(before, '*')).map(|name| name.trim_end_matches('.').to_owned());
    [after("\n### 13.", ' '), after("\\tag{13.", '}'), results.collect()]
}

/// The references to section 13 of a text that name nothing, or a result like a subsection.
fn wrong_references(text: &str, [subsections, formulas, results]: &[BTreeSet<String>; 3]) -> Vec<String> {
    let mut wrong = Vec::new();
    for (at, _) in text.match_indices("13.") {
        let (before, rest) = text.split_at(at);
        let end = rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '.')).unwrap_or(rest.len());
        let number = rest[..end].trim_end_matches('.');
        let line = before.rsplit('\n').next().unwrap_or_default();
        let of_result = ["Theorem ", "Proposition ", "Propositions "].iter().any(|name| before.ends_with(name));
        let in_parentheses = before.ends_with('(') && rest[end..].starts_with(')');
        let known = match (of_result, in_parentheses) {
            (true, _) => results.contains(number),
            // A formula, or "see there".
            (false, true) => formulas.contains(number) || subsections.contains(number),
            (false, false) => true,
        };
        if !known {
            wrong.push(format!("{line}{number}"));
        }
    }
    wrong
}

/// 13.4 is a subsection and nothing else: formulas and results have numbers of their own, in the documents, the code and the Coq files.
#[test]
fn numbers_of_section_13_name_one_thing() {
    let texts = shipped();
    let numbers = numbers_of_13(&texts["docs/mathematics.md"]);
    let [subsections, formulas, results] = &numbers;
    assert_eq!(
        subsections.iter().map(String::as_str).collect::<Vec<_>>(),
        ["13.1", "13.2", "13.3", "13.4", "13.5", "13.6", "13.7"]
    );
    assert!(formulas.len() == 13 && results.len() == 11, "{numbers:?}");
    assert!(formulas.is_disjoint(subsections) && results.is_disjoint(subsections) && results.is_disjoint(formulas));
    let mut all: Vec<(String, String)> = texts.into_iter().filter(|(path, _)| path != "CHANGELOG.md").collect();
    for (folder, endings) in [("proofs-check", &[".rs", ".v", ".md"][..]), ("crates", &[".rs"]), ("src", &[".rs"])] {
        let mut folders = vec![Path::new(ROOT).join(folder)];
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(&folder).expect("a folder") {
                let path = entry.expect("an entry").path();
                let name = path.to_str().expect("plain names").to_owned();
                if path.is_dir() {
                    folders.push(path);
                } else if endings.iter().any(|ending| name.ends_with(ending)) {
                    all.push((name, std::fs::read_to_string(&path).expect("a text")));
                }
            }
        }
    }
    assert!(all.len() > 300, "{}", all.len());
    for (path, text) in &all {
        assert_eq!(wrong_references(text, &numbers), Vec::<String>::new(), "{path}");
    }
    // What it finds.
    for (text, count) in [
        ("by (13.7c), (13.4) and Theorem 13.7.5; 13.4", 0),
        ("by (13.14)", 1),
        ("Proposition 13.4 and Theorem 13.5", 2),
        ("Theorem 13.7.12", 1),
        ("13.7 of 10.3", 0),
    ] {
        assert_eq!(wrong_references(text, &numbers).len(), count, "{text}");
    }
}

/// The commands that a text speaks of: `sigmastar NAME` within backticks, after `$ ` or behind a pipe.
fn commands(text: &str) -> BTreeSet<String> {
    let starts = ["`sigmastar ", "$ sigmastar ", "| sigmastar "];
    let rests = starts.iter().flat_map(|start| text.split(start).skip(1));
    let name = |rest: &str| rest.chars().take_while(|c| c.is_ascii_lowercase()).collect::<String>();
    rests.map(name).filter(|name| !name.is_empty()).collect()
}

/// What a document, a message or a comment tells people to call is there to be called.
#[test]
fn every_command_that_is_spoken_of_exists() {
    let help = String::from_utf8(crate::support::answer(&["--help"]).stdout).unwrap();
    let (_, listed) = help.split_once("Commands:\n").expect("the commands");
    let listed = listed.lines().take_while(|line| !line.is_empty()).filter(|line| !line.starts_with("   "));
    let known: BTreeSet<&str> = listed.filter_map(|line| line.split_whitespace().next()).collect();
    let mut texts = shipped();
    // Its section on what is gone names what is gone.
    texts.remove("CHANGELOG.md");
    for folder in ["crates", "src", "bindings/python/python", "bindings/python/src", "proofs-check/src"] {
        collect_sources(&Path::new(ROOT).join(folder), &mut texts);
    }
    let mut met = BTreeSet::new();
    for (path, text) in &texts {
        for name in commands(text) {
            assert!(known.contains(name.as_str()), "{path} speaks of `sigmastar {name}`");
            met.insert(name);
        }
    }
    assert!(met.len() > 12, "{met:?}");
    assert_eq!(
        commands("see `sigmastar rate FILE` or\n$ sigmastar check x; sigmastar itself"),
        BTreeSet::from(["rate", "check"].map(str::to_owned))
    );
}

/// The Rust and Python sources of a folder, by their paths.
fn collect_sources(folder: &Path, texts: &mut Texts) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            collect_sources(&path, texts);
        } else if path.extension().is_some_and(|ending| ending == "rs" || ending == "py") {
            texts.insert(path.display().to_string(), std::fs::read_to_string(&path).expect("a source"));
        }
    }
}
