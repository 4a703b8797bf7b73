//! JSON, JSON with comments and TOML are the same documents: what is read is what is written, exactly, whatever the notation.

use crate::support::{EXAMPLE, ROOT, files, guide, json, program, stem, utf8};
use predicates::prelude::*;
use predicates::str::{contains, is_empty};
use serde_json::Value;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Document, ErrorKind, MAX_NESTING, MAX_VALUES, Notation, Specification};
use sigmastar_studies::sweep::{Study, Sweep};
use std::fmt::Write;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A value inside of a line.
fn inline(value: &Value) -> String {
    match value {
        Value::Array(elements) => format!("[{}]", elements.iter().map(inline).collect::<Vec<_>>().join(", ")),
        Value::Object(fields) => {
            let fields = fields.iter().map(|(name, value)| format!("\"{name}\" = {}", inline(value)));
            format!("{{ {} }}", fields.collect::<Vec<_>>().join(", "))
        }
        // The escapes of JSON are escapes of TOML.
        scalar => scalar.to_string(),
    }
}

/// An object as TOML with headers: fields first, then tables and arrays of tables.
fn tables(value: &Value, path: &str, text: &mut String) {
    let is_table = |value: &Value| value.is_object();
    let is_tables = |value: &Value| {
        value.as_array().is_some_and(|elements| !elements.is_empty() && elements.iter().all(Value::is_object))
    };
    let fields = value.as_object().expect("an object");
    for (name, value) in fields.iter().filter(|(_, value)| !is_table(value) && !is_tables(value)) {
        writeln!(text, "\"{name}\" = {} # a remark", inline(value)).unwrap();
    }
    for (name, value) in fields {
        let path = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
        if is_table(value) {
            writeln!(text, "\n[{path}]").unwrap();
            tables(value, &path, text);
        } else if is_tables(value) {
            for element in value.as_array().expect("an array") {
                writeln!(text, "\n[[{path}]]").unwrap();
                tables(element, &path, text);
            }
        }
    }
}

/// An object as TOML with dotted keys.
fn dotted(value: &Value, path: &str, text: &mut String) {
    for (name, value) in value.as_object().expect("an object") {
        let path = if path.is_empty() { name.clone() } else { format!("{path} . {name}") };
        match value {
            Value::Object(fields) if !fields.is_empty() => dotted(value, &path, text),
            value => writeln!(text, "{path} = {}", inline(value)).unwrap(),
        }
    }
}

fn toml(write: impl Fn(&Value, &str, &mut String), value: &Value) -> String {
    let mut text = String::new();
    write(value, "", &mut text);
    text
}

/// The same document with comments between its lines and behind them.
fn commented(text: &str) -> String {
    text.lines().map(|line| line.to_owned() + " // \"/* , }\n/* { \" \n */\n").collect()
}

pub fn read(text: &str, notation: Notation) -> Document {
    Document::parse_as("test", text, notation).unwrap_or_else(|errors| panic!("{}\n{text}", errors.render(false)))
}

/// The notations of a file in JSON.
fn others(text: &str) -> [(Notation, String); 5] {
    let value = Document::parse("test", text).expect("JSON").root().to_json();
    [
        (Notation::Json, format!("\u{feff}{text}")),
        (Notation::JsonWithComments, format!("\u{feff}{}", commented(text))),
        (Notation::Toml, format!("\u{feff}{}", toml(tables, &value))),
        (Notation::Toml, toml(dotted, &value)),
        (Notation::Toml, toml(dotted, &value).replace('\n', "\r\n")),
    ]
}

#[test]
fn every_shipped_file_is_the_same_in_every_notation() {
    let all = ["specs", "specs/plants", "specs/studies"].map(files).concat();
    assert!(all.len() > 30);
    for path in all {
        let text = fs::read_to_string(&path).expect("readable");
        let plain = Document::parse("test", &text).expect("JSON");
        for (notation, text) in others(&text) {
            let other = read(&text, notation);
            assert_eq!(other.root().canonical(), plain.root().canonical(), "{notation:?} {}", path.display());
            match plain.at("/format").and_then(|format| format.text()) {
                Some("sigmastar/bounding-spec") => {
                    let [ours, theirs] =
                        [&plain, &other].map(|document| Specification::from_value(&document.root()).expect("read"));
                    assert_eq!((ours.document, ours.sha256), (theirs.document, theirs.sha256));
                }
                Some("sigmastar/plant") => {
                    let [ours, theirs] =
                        [&plain, &other].map(|document| Plant::from_value(&document.root()).expect("read"));
                    assert_eq!((ours.document, ours.sha256), (theirs.document, theirs.sha256));
                }
                _ => drop(Study::read(&other).expect("read")),
            }
        }
    }
}

/// The program: one claim, one digest and one embedded document, and the checker agrees with each file.
#[test]
fn the_claim_is_the_same_in_every_notation() {
    let folder = TempDir::new().expect("a folder");
    let text = fs::read_to_string(Path::new(ROOT).join("specs/linear.json")).expect("shipped");
    let value: Value = serde_json::from_str(&text).expect("JSON");
    let with_schema = text.replacen('{', "{ \"$schema\": \"x.json\",", 1);
    let mut certificates = Vec::new();
    for (name, text) in [
        ("a.json", with_schema.clone()),
        ("b.jsonc", commented(&with_schema)),
        ("c.TOML", format!("\"$schema\" = \"x\"\n{}", toml(tables, &value))),
        ("d.json", text),
    ] {
        let file = folder.path().join(name);
        let certificate = folder.path().join(format!("{name}.certificate.json"));
        fs::write(&file, text).expect("written");
        let call = ["certify", "-q", "--no-alternatives"];
        program().args(call).arg(&file).arg("-o").arg(&certificate).assert().code(0).stderr(is_empty());
        let value = json(&fs::read(&certificate).expect("written"));
        assert!(value["specification"].get("$schema").is_none(), "{name}");
        certificates.push([
            value["claim"].clone(),
            value["specification"].clone(),
            value["specification_sha256"].clone(),
        ]);
        // The checker reads JSON alone: what it compares of another notation is what `convert` makes of it.
        let check = || {
            let mut check = program();
            check.arg("check").arg(&certificate).arg("--spec");
            check
        };
        let said = check().arg(&file).assert().code(0).get_output().stderr.clone();
        assert_eq!(utf8(said).contains("what `sigmastar convert"), !name.ends_with(".json"), "{name}");
        let changed = folder.path().join(format!("changed-{name}"));
        fs::write(&changed, fs::read_to_string(&file).expect("written").replace("0.58", "0.59")).expect("written");
        check().arg(&changed).assert().code(1).stdout(contains("/specification/lyapunov/alpha"));
        let converted = program().arg("convert").arg(&file).assert().code(0).get_output().stdout.clone();
        check().arg("-").write_stdin(converted.clone()).assert().code(0);
        let other = utf8(converted).replace("\"0.58\"", "\"0.59\"");
        check().arg("-").write_stdin(other).assert().code(1).stdout(contains("/specification/lyapunov/alpha"));
    }
    certificates.iter().for_each(|other| assert_eq!(*other, certificates[0]));
}

/// A field that the checker does not know is not carried: neither by this program, nor past the checker.
#[test]
fn a_certificate_has_no_schema_in_it() {
    let kept = Path::new(ROOT).join("proofs-check/tests/certificates/linear.sharp.json");
    let mut certificate: Value = serde_json::from_slice(&fs::read(kept).expect("kept")).expect("JSON");
    certificate["specification"]["$schema"] = "x".into();
    let report = proofs_check::check(certificate.to_string().as_bytes());
    assert_eq!(report.verdict, proofs_check::verdict::Verdict::BadInput);
    assert_eq!(report.finding.expect("a finding").pointer, "/specification/$schema");
    let document = Document::parse("test", &certificate.to_string()).expect("JSON");
    let errors = Specification::from_value(&document.at("/specification").expect("there")).expect_err("unknown");
    assert_eq!(
        (errors.errors()[0].kind, errors.errors()[0].pointer.as_str()),
        (ErrorKind::UnknownField, "/specification/$schema")
    );
}

#[test]
fn the_schema_is_a_text_that_is_ignored() {
    let text = fs::read_to_string(Path::new(ROOT).join(EXAMPLE)).expect("shipped");
    let plain = Specification::from_json("test", &text).expect("read");
    for (schema, good) in [("\"a.json\"", true), ("\"\"", true), ("1", false), ("null", false), ("{}", false)] {
        let text = text.replacen('{', &format!("{{ \"$schema\": {schema},"), 1);
        match Specification::from_json("test", &text) {
            Ok(read) => assert!(good && read.sha256 == plain.sha256 && read.document == plain.document, "{schema}"),
            Err(errors) => {
                assert!(
                    !good && errors.errors()[0].pointer == "/$schema" && errors.errors()[0].kind == ErrorKind::Type
                );
            }
        }
    }
    // A study, and the subject in it: the cases have the digests that `certify` gives them.
    let study = fs::read_to_string(Path::new(ROOT).join("specs/studies/linear.json")).expect("shipped");
    let subject = fs::read_to_string(Path::new(ROOT).join("specs/linear.json")).expect("shipped");
    let sweep = |schema: &str| {
        let subject = Document::parse("test", &subject.replacen('{', &format!("{{ {schema}"), 1)).expect("JSON");
        let study = Document::parse("test", &study.replacen('{', &format!("{{ {schema}"), 1)).expect("JSON");
        Sweep::new(Study::read(&study).expect("a study"), Some(&subject)).expect("a sweep")
    };
    let [with, without] = ["\"$schema\": \"x\",", ""].map(sweep);
    let case = with.case(1).expect("a case");
    assert_eq!(case.sha256, without.case(1).expect("a case").sha256);
    assert_eq!(case.sha256, Specification::from_value(&case.document.root()).expect("read").sha256);
}

#[test]
fn the_notation_is_that_of_the_name() {
    for (name, notation) in [
        ("a.json", Notation::Json),
        ("a", Notation::Json),
        ("a.toml.json", Notation::Json),
        ("toml", Notation::Json),
        (".toml", Notation::Json),
        ("a.jsonc", Notation::JsonWithComments),
        ("a.JsonC", Notation::JsonWithComments),
        ("a.b.toml", Notation::Toml),
    ] {
        assert_eq!(Notation::of(Path::new(name)), notation, "{name}");
    }
    // Standard input is JSON and nothing else.
    let call = |text: &str| program().args(["certify", "-"]).write_stdin(text.to_owned()).assert().code(2);
    call("period = 1").stderr(contains("not-json"));
    call("// a\n{}").stderr(contains("not-json").and(contains(".jsonc")));
}

/// What is wrong with a document, where, and as what: the text at the place.
fn refused(text: &str, notation: Notation) -> (ErrorKind, String, String) {
    let errors = Document::parse_as("test", text, notation).expect_err(text);
    let error = &errors.errors()[0];
    // The words for JSON, limits and places are those of JSON.
    let own = notation == Notation::Toml && error.kind != ErrorKind::Limit;
    assert!(!own || error.help.is_some(), "{text}: {error}");
    assert!(errors.render(false).contains(&error.message), "{text}");
    (error.kind, error.pointer.clone(), text[error.span.clone()].to_owned())
}

#[test]
fn what_json_cannot_write_is_refused_in_toml() {
    use ErrorKind::{DuplicateKey, Limit, TomlSyntax, Type};
    let long = format!("a = {}", "1".repeat(1001));
    for (text, kind, pointer, at) in [
        ("a = inf", Type, "/a", "inf"),
        ("a = [1, -inf]", Type, "/a/1", "-inf"),
        ("a = +nan", Type, "/a", "+nan"),
        ("a = 0x10", Type, "/a", "0x10"),
        ("a = 0x", Type, "/a", "0x"),
        ("a = 0o17", Type, "/a", "0o17"),
        ("[b]\na = 0b1", Type, "/b/a", "0b1"),
        ("a = 1979-05-27", Type, "/a", "1979-05-27"),
        ("a = 07:32:00", Type, "/a", "07:32:00"),
        ("a = 1e9999", Limit, "/a", "1e9999"),
        ("a = 1_0e+4_001", Limit, "/a", "1_0e+4_001"),
        (&long, Limit, "/a", &long[4..]),
        ("a = 1\na = 2", DuplicateKey, "", "a"),
        ("[a]\n[a]", DuplicateKey, "", "a"),
        ("a.b = 1\n[a]\nb = 2", DuplicateKey, "", "a"),
        ("a = { b = 1, b = 2 }", DuplicateKey, "", "b"),
        ("a = 1\n\"\\u0061\" = 2", DuplicateKey, "", "\"\\u0061\""),
    ] {
        assert_eq!(refused(text, Notation::Toml), (kind, pointer.to_owned(), at.to_owned()), "{text}");
    }
    // Tables that are not closed, and what no notation allows: refused, never guessed.
    for text in [
        "a = 01",
        "a = 1__0",
        "a = _1",
        "a = 1_",
        "a = .5",
        "a = 5.",
        "a = 1e",
        "a = 1.e3",
        "a = --1",
        "a = 1 2",
        "a =",
        "a = 1, b = 2",
        "a = 2*pi",
        "a: 1",
        "a = 'b",
        "[a",
        "a = [1",
        "a = { b = 1",
        "= 1",
        "a = 1e1.0",
        "a = 0_x1",
        "a = ++1",
        "a = 1\nb",
        "a.b = 1\na = 2",
        "[[a]]\n[a]",
        "a = [1]\n[[a]]",
        "a = {}\n[a.b]",
        "{ \"a\": 1 }",
        "a = null",
    ] {
        let (kind, ..) = refused(text, Notation::Toml);
        assert!(matches!(kind, TomlSyntax | DuplicateKey), "{text}: {kind:?}");
    }
}

#[test]
fn numbers_of_toml_are_those_that_are_written() {
    for (written, read_as) in [
        ("0.1", "0.1"),
        ("1_000", "1000"),
        ("+1", "1"),
        ("-0", "-0"),
        ("-0.0", "-0.0"),
        ("1e-400", "1e-400"),
        ("+1_0.0_1e+0_3", "10.01e+03"),
        ("5E+22", "5E+22"),
        ("9007199254740993", "9007199254740993"),
        ("170141183460469231731687303715884105728", "170141183460469231731687303715884105728"),
    ] {
        let document = read(&format!("a = {written}"), Notation::Toml);
        assert_eq!(document.at("/a").expect("there").numeral(), Some(read_as), "{written}");
    }
    // A text stays a text, in every kind of quotes.
    let document = read("a = \"1_000\"\nb = '\\u0041'\nc = \"\"\"\nx\"\"\"\nd = '1e3'", Notation::Toml);
    let texts = ["/a", "/b", "/c", "/d"].map(|pointer| document.at(pointer).and_then(|value| value.text()));
    assert_eq!(texts, [Some("1_000"), Some("\\u0041"), Some("x"), Some("1e3")]);
}

#[test]
fn tables_of_toml_are_objects_wherever_they_stand() {
    for text in [
        "a.b = [ { c = 1 }, { c = 2 } ]\na.d.e = true",
        "[a]\nd.e = true\n[[a.b]]\nc = 1\n[[a.b]]\nc = 2",
        "[[a.b]]\n\"c\" = 1\n[a.d]\ne = true\n[[a.b]]\nc = 2",
        "a = { b = [{ c = 1 }, { 'c' = 2 }], d.e = true }",
        "[a.d]\ne = true\n[a]\nb = [\n # no field: c = 3\n { c = 1 },\n { c = 2 },\n]",
    ] {
        let expected = r#"{"a":{"b":[{"c":1},{"c":2}],"d":{"e":true}}}"#;
        assert_eq!(read(text, Notation::Toml).root().canonical(), expected, "{text}");
    }
}

#[test]
fn comments_are_read_over_and_nothing_else() {
    let value = |text: &str| read(text, Notation::JsonWithComments).root().canonical();
    assert_eq!(value("{ // a\n \"a\": /* b */ 1 /**/ }"), "{\"a\":1}");
    assert_eq!(value("{ \"a\": \"http://x/*y*/\" }"), "{\"a\":\"http://x/*y*/\"}");
    assert_eq!(value("// \"a\": 1\n{}//"), "{}");
    for text in [
        "{ \"a\": 1/**/2 }",
        "{ \"a\": t/**/rue }",
        "{ \"a\": 1, }",
        "[1, /* a */ ]",
        "{ 'a': 1 }",
        "{ a: 1 }",
        "# a\n{}",
        "{} /* a",
        "{} /",
        "{ \"a\": 0x1 }",
        "{ \"a\": +1 }",
        "{ \"a\": .5 }",
        "{ \"a\": Infinity }",
        "{} // a\n{}",
        "//",
        "/*",
        "{ \"a\": 1 /* /* */ */ }",
        "{ \"a\" /* \" */ : \"\\x41\" }",
        "{ \"a\": 01 }",
    ] {
        assert_eq!(refused(text, Notation::JsonWithComments).0, ErrorKind::Syntax, "{text}");
    }
    let twice = refused("{ \"a\": 1, // b\n \"a\": 2 }", Notation::JsonWithComments);
    assert_eq!(twice, (ErrorKind::DuplicateKey, "/a".to_owned(), "\"a\"".to_owned()));
    // In JSON itself there are none.
    assert_eq!(refused("{} // a", Notation::Json).0, ErrorKind::Syntax);
}

/// What some editors show as a new line, or from right to left, and a reader takes otherwise.
#[test]
fn what_is_read_is_what_is_shown() {
    for hidden in ["\r", "\u{b}", "\u{c}", "\u{85}", "\u{2028}", "\u{2029}", "\u{202e}", "\u{2066}"] {
        for (text, notation) in [
            (format!("{{ \"a\": 1 //{hidden}, \"b\": 2\n }}"), Notation::JsonWithComments),
            (format!("a = 1 #{hidden}b = 2\n"), Notation::Toml),
        ] {
            assert_eq!(refused(&text, notation), (ErrorKind::Encoding, String::new(), hidden.to_owned()), "{text:?}");
        }
    }
}

#[test]
fn utf_16_is_refused_with_a_word() {
    for notation in [Notation::Json, Notation::JsonWithComments, Notation::Toml] {
        for bytes in [&b"\xff\xfe{\0}\0"[..], b"\xfe\xff\0{\0}"] {
            let errors = Document::from_bytes_as("x", bytes, notation).expect_err("UTF-16");
            assert_eq!(errors.errors()[0].kind, ErrorKind::Encoding);
            assert!(errors.render(false).contains("UTF-16"));
        }
        let marked = Document::from_bytes_as("x", b"\xef\xbb\xbf\xef\xbb\xbf{}", notation).expect_err("two marks");
        assert!(matches!(marked.errors()[0].kind, ErrorKind::Syntax | ErrorKind::TomlSyntax));
    }
}

/// Errors have the place in the file that was written, in the text of a field too.
#[test]
fn errors_have_places_in_every_notation() {
    let text = fs::read_to_string(Path::new(ROOT).join("specs/linear.json")).expect("shipped");
    let value: Value = serde_json::from_str(&text.replace("3 + X + E/4", "3 + X + Y/4")).expect("JSON");
    let literal = toml(tables, &value).replace("\"3 + X + Y/4\"", "'''\n3 + X + Y/4'''");
    for (notation, text) in [
        (Notation::JsonWithComments, commented(&text.replace("3 + X + E/4", "3 + X + Y/4"))),
        (Notation::Toml, toml(tables, &value)),
        (Notation::Toml, literal),
    ] {
        let errors = Specification::from_value(&read(&text, notation).root()).expect_err("Y");
        let error = &errors.errors()[0];
        assert_eq!((error.pointer.as_str(), &text[error.span.clone()]), ("/bounds/q", "Y"));
        let line = 1 + text[..error.span.start].matches('\n').count();
        assert_eq!(errors.place(error).0, line);
    }
    // Where a text has escapes, its whole literal is shown.
    let escaped = "a = \"1 + \\u0058\"";
    let document = read(escaped, Notation::Toml);
    let error = document.at("/a").expect("there").error_in(ErrorKind::Expression, &(4..5), "x");
    assert_eq!(&escaped[error.span], "\"1 + \\u0058\"");
    let missing = Specification::from_value(&read("# nothing", Notation::Toml).root()).expect_err("fields");
    assert_eq!(missing.errors()[0].kind, ErrorKind::MissingField);
    assert!(Specification::from_value(&read("\u{feff}#", Notation::Toml).root()).is_err());
}

#[test]
fn limits_hold_in_toml() {
    let nested = |depth: usize| format!("a = {}{}", "[".repeat(depth), "]".repeat(depth));
    assert!(Document::parse_as("x", &nested(MAX_NESTING - 1), Notation::Toml).is_ok());
    for text in [
        nested(MAX_NESTING),
        nested(100_000),
        format!("a = {}", "[".repeat(500_000)),
        format!("a = {}", "{a=".repeat(200_000)),
        format!("{}a = 1", "a.".repeat(400_000)),
        format!("[{}a]", "a.".repeat(400_000)),
        format!("{}a = 1", "a.".repeat(MAX_NESTING)),
        // The deepest that the parser makes before it says no.
        format!("[{}a]\n{}a = {}1", "a.".repeat(78), "a.".repeat(78), format!("{{{}a = ", "a.".repeat(78)).repeat(78)),
        format!(
            "[{}a]\n{}a = {}1{}",
            "a.".repeat(78),
            "a.".repeat(78),
            format!("{{{}a = ", "a.".repeat(78)).repeat(78),
            "}".repeat(78)
        ),
        format!("a = [{}]", "1,".repeat(MAX_VALUES)),
        format!("a = \"{}\"", "a".repeat(1 << 20)),
    ] {
        let errors = Document::parse_as("x", &text, Notation::Toml).expect_err("beyond a limit");
        let kind = errors.errors()[0].kind;
        assert!(matches!(kind, ErrorKind::Limit | ErrorKind::TomlSyntax), "{kind:?} {}", &text[..30]);
        assert!(!errors.render(false).is_empty());
    }
}

#[test]
fn templates_work_as_they_stand() {
    use sigmastar_schema::Schema;
    let folder = TempDir::new().expect("a folder");
    for (kind, schema) in [("spec", Schema::Specification), ("plant", Schema::Plant), ("study", Schema::Study)] {
        let file = folder.path().join(format!("{kind}.jsonc"));
        program().args(["new", kind, "-o"]).arg(&file).assert().code(0).stdout(is_empty()).stderr(is_empty());
        let printed = program().args(["new", kind]).assert().code(0).get_output().stdout.clone();
        assert_eq!(printed, fs::read(&file).expect("written"));
        if kind == "study" {
            let results = folder.path().join(format!("{kind}.csv"));
            let sweep = program().args(["sweep", "-q"]).arg(&file).arg("-o").arg(&results).assert().code(0);
            sweep.stdout(contains("6 cases: 6 certified"));
        } else {
            program().args(["certify", "-q"]).arg(&file).assert().code(0).stdout(contains("Certified: with sigma ="));
        }
        let text = utf8(printed);
        let plain = read(&text, Notation::JsonWithComments);
        for (name, sign) in [("a.jsonc", "//"), ("a.toml", "#"), ("a.json", ""), ("a", "")] {
            let file = folder.path().join(format!("{kind}-{name}"));
            program().args(["new", kind, "-o"]).arg(&file).assert().code(0).stderr(is_empty());
            let text = fs::read_to_string(&file).expect("written");
            let document = read(&text, Notation::of(&file));
            assert_eq!(document.root().canonical(), plain.root().canonical(), "{kind} {name}");
            if sign.is_empty() {
                continue;
            }
            // Every field has its line: none of those that are required is left out, and the others are named in comments.
            let is_comment = |line: &&str| line.trim_start().starts_with(sign);
            assert!(text.lines().filter(is_comment).count() > 12, "{kind} {name}");
            let left_out = if kind == "study" { "sampling_period" } else { "domain" };
            assert!(text.lines().filter(is_comment).any(|line| line.contains(left_out)), "{kind} {name}");
            // The schema agrees, also with the reference to it that the comment offers.
            let text = text.replace(&format!("{sign} \"$schema\""), "\"$schema\"");
            let document = read(&text, Notation::of(&file)).root().to_json();
            assert!(crate::validator::Validator::new(&schema.json()).is_valid(&document), "{kind} {name}");
            assert!(document["$schema"].is_string());
        }
    }
    program().args(["new", "spce"]).assert().code(2).stderr(contains("spec"));
}

/// The example of the guide is read, and is the specification that it says.
#[test]
fn the_example_of_the_guide_is_read() {
    let guide = guide();
    let block = guide
        .split("```toml\n")
        .skip(1)
        .filter_map(|rest| rest.split("```").next())
        .find(|text| text.contains("lyapunov = "));
    let block = block.expect("a block of TOML");
    let spec = Specification::from_value(&read(block, Notation::Toml).root());
    let spec = spec.unwrap_or_else(|errors| panic!("{}", errors.render(false)));
    assert_eq!(spec.document["lyapunov"]["alpha"].to_string(), "0.58");
    assert_eq!(spec.document["initial_set"], serde_json::json!({ "kind": "paper" }));
}

#[test]
fn a_study_in_toml_finds_its_subject() {
    let folder = TempDir::new().expect("a folder");
    let subject = fs::read_to_string(Path::new(ROOT).join("specs/linear.json")).expect("shipped");
    let value: Value = serde_json::from_str(&subject).expect("JSON");
    fs::write(folder.path().join("subject.toml"), toml(tables, &value)).expect("written");
    let study = "format = \"sigmastar/study\"\nversion = 1\nname = 'n'\nsubject = 'subject.toml'\ndesign = 'grid'\n\
                 [[parameters]]\npointer = '/lyapunov/alpha'\nvalues = [0.58, 1_0e-1]\n";
    let file = folder.path().join("study.toml");
    fs::write(&file, study).expect("written");
    let case = program().args(["sweep", "--case", "1"]).arg(&file).assert().code(0).get_output().stdout.clone();
    let case = utf8(case);
    assert!(case.contains("\"alpha\": 10e-1"), "{case}");
    let plain = folder.path().join("converted.json");
    program().arg("convert").arg(&file).arg("-o").arg(&plain).assert().code(0).stdout(is_empty());
    let again = program().args(["sweep", "--case", "1"]).arg(&plain).assert().code(0).get_output().stdout.clone();
    assert_eq!(utf8(again), case);
    assert_eq!(stem(&plain), "converted");
}

/// The same values are found in every notation, and what is written is in that of the file.
#[test]
fn files_are_tuned_in_their_own_notation() {
    let folder = TempDir::new().expect("a folder");
    let text = fs::read_to_string(Path::new(ROOT).join("specs/paper-example-at-rest.json")).expect("shipped");
    let value: Value = serde_json::from_str(&text).expect("JSON");
    let tuned = |name: &str, text: &str, output: &str| {
        let (file, output) = (folder.path().join(name), folder.path().join(output));
        fs::write(&file, text).expect("written");
        let mut call = program();
        call.args(["tune", "--over", "mu", "--tries", "12", "--format", "json", "-q"]).arg(&file).arg("-o").arg(output);
        call.assert()
    };
    let better = |name: &str, text: &str, output: &str| {
        let report = json(&tuned(name, text, output).code(0).get_output().stdout);
        let mut again = program();
        again.args(["certify", "-q", "--no-alternatives", "--format", "json"]).arg(folder.path().join(output));
        let certified = json(&again.assert().code(0).get_output().stdout);
        assert_eq!(certified["sigma_star"], report["after"]["sigma_star"], "{name}");
        assert_ne!(report["after"]["sigma_star"], report["before"]["sigma_star"], "{name}");
        (report["after"].clone(), fs::read_to_string(folder.path().join(output)).expect("written"))
    };
    let (plain, _) = better("a.json", &text, "a-tuned.jsonc");
    let (with_comments, written) = better("b.jsonc", &commented(&text), "b-tuned.jsonc");
    assert!(written.contains("/*") && written.contains("//"), "{written}");
    let (of_toml, written) = better("c.toml", &format!("# kept\n{}", toml(tables, &value)), "c-tuned.toml");
    assert!(written.starts_with("# kept\n"), "{written}");
    assert_eq!((&with_comments, &of_toml), (&plain, &plain));
    // What is written would not be read again as it is meant.
    for (name, text, output) in [("b.jsonc", commented(&text), "b.json"), ("c.toml", toml(tables, &value), "c.json")] {
        tuned(name, &text, output).code(2).stdout(contains("another notation"));
        assert!(!folder.path().join(output).exists());
    }
}
