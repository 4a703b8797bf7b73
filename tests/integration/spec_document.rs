//! The strict reader of JSON: limits, encodings, syntax, places, and that it never panics.

use crate::support::{EXAMPLE_TEXT, every, program, utf8};
use proptest::prelude::*;
use sigmastar_lang::spec::{
    Document, ErrorKind, Errors, MAX_BYTES, MAX_NESTING, MAX_VALUES, SpecErrors, Specification,
};

fn refused(text: &str) -> SpecErrors {
    Document::parse("test.json", text).expect_err(text)
}

fn kind_and_text(text: &str) -> (ErrorKind, String) {
    let errors = refused(text);
    assert_eq!(errors.errors().len(), 1);
    let error = &errors.errors()[0];
    (error.kind, text[error.span.clone()].to_owned())
}

#[test]
fn what_is_not_json_is_refused_in_its_place() {
    for (text, place) in [
        ("{\"a\": 1,}", "}"),
        ("[1, 2,]", "]"),
        ("[1 2]", "2"),
        ("{\"a\" 1}", "1"),
        ("{a: 1}", "a"),
        ("['a']", "'"),
        ("[1] [2]", "["),
        ("[1] x", "x"),
        ("[01]", "1"),
        ("[NaN]", "N"),
        ("[+1]", "+"),
        ("[1] // end", "/"),
        ("[tru]", "]"),
        ("[\"\\x41\"]", "x"),
    ] {
        assert_eq!(kind_and_text(text), (ErrorKind::Syntax, place.to_owned()), "{text}");
    }
    for text in [
        "[",
        "[1",
        "{\"a\":",
        "\"a",
        "[.5]",
        "[5.]",
        "[0x10]",
        "[\"\\ud800\"]",
        "[\"\\udc00x\"]",
        "[\"a\tb\"]",
        "[1e]",
        "-",
    ] {
        assert_eq!(refused(text).errors()[0].kind, ErrorKind::Syntax, "{text}");
    }
    for text in ["", " ", "\n\t "] {
        assert_eq!(refused(text).errors()[0].message, "the document is empty");
    }
}

#[test]
fn encodings_are_refused() {
    // A byte order mark is no part of the text, two are one too many.
    let marked = Document::parse("x", "\u{feff}{\"a\": 1}").expect("read");
    let plain = Document::parse("x", "{\"a\": 1}").expect("read");
    assert_eq!((marked.text(), marked.root().sha256()), (plain.text(), plain.root().sha256()));
    assert_eq!(kind_and_text("\u{feff}\u{feff}{}").0, ErrorKind::Syntax);
    for bytes in [&b"\xff\xfe{\0}\0"[..], b"\xfe\xff\0{\0}"] {
        let errors = Document::from_bytes("x", bytes).expect_err("not UTF-8");
        assert_eq!(errors.errors()[0].message, "the file is UTF-16, not UTF-8");
    }
    let errors = Document::from_bytes("x", b"{\"a\": \"\xff\"}").expect_err("not UTF-8");
    assert_eq!(errors.errors()[0].kind, ErrorKind::Encoding);
    assert_eq!(errors.errors()[0].message, "byte 7 (0xff) is not UTF-8");
    assert_eq!(errors.errors()[0].span, 7..7);
    assert!(errors.render(false).contains("x:1:8"));
}

#[test]
fn limits_are_exact() {
    let nested = |depth: usize| format!("{}{}", "[".repeat(depth), "]".repeat(depth));
    assert!(Document::parse("x", &nested(MAX_NESTING)).is_ok());
    assert_eq!(refused(&nested(MAX_NESTING + 1)).errors()[0].kind, ErrorKind::Limit);
    assert!(Document::parse("x", &"{\"a\":[".repeat(33)).expect_err("too deep").errors()[0].kind == ErrorKind::Limit);

    // The array itself is a value, too; empty arrays count once, strings hide their content.
    let array = |element: &str, count: usize| format!("[{}]", vec![element; count].join(","));
    for element in ["1", "[]", "{ }", "\",[{\""] {
        assert!(Document::parse("x", &array(element, MAX_VALUES - 1)).is_ok(), "{element}");
        assert_eq!(refused(&array(element, MAX_VALUES)).errors()[0].kind, ErrorKind::Limit, "{element}");
    }

    let padded = |length: usize| format!("[]{}", " ".repeat(length - 2));
    assert!(Document::parse("x", &padded(MAX_BYTES)).is_ok());
    let errors = refused(&padded(MAX_BYTES + 1));
    assert_eq!(errors.errors()[0].kind, ErrorKind::Limit);
    assert!(errors.text().is_empty());

    for (numeral, accepted) in [
        ("1e4000", true),
        ("1E-4000", true),
        ("1e+0004000", true),
        ("1e4001", false),
        ("1e-4001", false),
        ("1e999999999", false),
        ("1e99999999999999999999", false),
        (&"9".repeat(1000), true),
        (&"9".repeat(1001), false),
    ] {
        let text = format!("[{numeral}]");
        assert_eq!(Document::parse("x", &text).is_ok(), accepted, "{numeral}");
        if !accepted {
            assert_eq!(kind_and_text(&text), (ErrorKind::Limit, numeral.to_owned()));
        }
    }
}

#[test]
fn hostile_documents_are_refused() {
    let huge = "[1,".repeat(100 << 20 >> 2);
    for text in [
        "[".repeat(100_000),
        "{\"a\":".repeat(100_000),
        "1e999999999".to_owned(),
        format!("[{}]", vec!["1e-4000"; MAX_VALUES - 1].join(",")),
        format!("{{{}}}", (0..60_000).map(|i| format!("\"k{i}\":0")).collect::<Vec<_>>().join(",")),
        format!("{{\"{}\":[{}]}}", "k".repeat(500_000), vec!["{\"a\":0,\"a\":1}"; 1000].join(",")),
        format!("\"{}\"", "\\u0041".repeat(100_000)),
        huge,
    ] {
        let errors = Specification::from_json("x", &text).expect_err("refused");
        assert!(errors.render(false).len() < 100_000);
        assert!(errors.to_string().len() < 10_000);
    }
}

#[test]
fn hostile_expressions_are_refused() {
    let weights = |value: &str, count: usize| {
        let values = vec![format!("\"{value}\""); count].join(",");
        let list = format!(
            "{{\"family\": \"explicit\", \"values\": [{values}], \"tail\": {{\"coefficient\": 1, \"exponent\": 2}}}}"
        );
        let family = "{ \"family\": \"power\", \"n0\": \"2\", \"epsilon\": \"1/2\" }";
        EXAMPLE_TEXT.replace(family, &list)
    };
    for text in [
        weights(&vec!["sin(1e1200)"; 80].join("+"), 100),
        weights(&"exp(".repeat(90), 1000),
        weights(&format!("{}1{}", "exp(".repeat(90), ")".repeat(90)), 1000),
        weights("(1+1e-300)^1000", 1000 / every(10)),
        EXAMPLE_TEXT.replace("\"mu\": \"1\"", &format!("\"mu\": \"{}\"", vec!["sin(1e1200)"; 800].join("*"))),
        EXAMPLE_TEXT.replace("\"mu\": \"1\"", "\"mu\": \"2^1000^2^1000\""),
    ] {
        assert_ne!(text, EXAMPLE_TEXT);
        assert!(Specification::from_json("x", &text).is_err(), "{}", &text[..80]);
    }
}

#[test]
fn a_large_file_is_not_read_to_its_end() {
    let file = tempfile::NamedTempFile::new().expect("a temporary file");
    file.as_file().set_len(1 << 40).expect("a sparse file");
    let call = program().arg("certify").arg(file.path()).assert().code(2);
    assert!(utf8(call.get_output().stderr.clone()).contains("error[limit]: the document has more than"));
}

#[test]
fn the_number_of_errors_is_bounded() {
    let fields: Vec<String> = (0..100).map(|i| format!("\"unknown{i}\": 0")).collect();
    let document = Document::parse("x", &format!("{{{}}}", fields.join(", "))).expect("valid JSON");
    let mut errors = Errors::new();
    let outcome = document.root().object(&mut errors).map(|object| object.finish(&mut errors));
    let errors = errors.conclude(&document, outcome).expect_err("unknown fields");
    // The first few with a suggestion, the rest counted: a suggestion for each would take time that grows with their number.
    assert_eq!((errors.errors().len(), errors.omitted()), (5, 95));
    assert!(errors.render(false).ends_with("95 more errors are not shown\n"));
    assert!(errors.to_string().ends_with("95 more errors are not shown"));
}

#[test]
fn places_are_mapped_back_through_escapes() {
    let text = r#"{"q": "a\u00e9\ud83d\ude00\\b\"é"}"#;
    let document = Document::parse("x", text).expect("valid JSON");
    let value = document.at("/q").expect("there");
    let decoded = value.text().expect("a string");
    assert_eq!(decoded, "aé😀\\b\"é");
    let raw = ["a", "\\u00e9", "\\ud83d\\ude00", "\\\\", "b", "\\\"", "é"];
    for ((at, c), raw) in decoded.char_indices().zip(raw) {
        let error = value.error_in(ErrorKind::Expression, &(at..at + c.len_utf8()), "here");
        assert_eq!(&text[error.span.clone()], raw);
        // A place between two characters.
        assert_eq!(value.error_in(ErrorKind::Expression, &(at..at), "here").span, error.span.start..error.span.start);
    }
    let whole = value.error_in(ErrorKind::Expression, &(0..decoded.len()), "here");
    assert_eq!(&text[whole.span.clone()], raw.concat());
    let end = value.error_in(ErrorKind::Expression, &(decoded.len()..decoded.len()), "here");
    assert_eq!(end.span, whole.span.end..whole.span.end);
    assert_eq!(value.span(), whole.span.start - 1..whole.span.end + 1);
}

#[test]
fn pointers_lead_back_to_their_values() {
    let document = Document::parse("x", r#"{"a/b": [{"~": 1}, true], "": null}"#).expect("valid JSON");
    let one = document.at("/a~1b/0/~0").expect("there");
    assert_eq!((one.numeral(), one.pointer()), (Some("1"), "/a~1b/0/~0"));
    assert_eq!(document.at("/").expect("there").type_name(), "null");
    assert_eq!(document.at("").expect("there").type_name(), "an object");
    for pointer in ["a", "/c", "/a~1b/2", "/a~1b/x", "/a~1b/0/~0/0"] {
        assert!(document.at(pointer).is_none(), "{pointer}");
    }
}

#[test]
fn typed_readers_report_the_type_they_found() {
    let document =
        Document::parse("x", r#"{"a": [1, "s", null, {}, true, 1.0, -1, 18446744073709551616]}"#).expect("JSON");
    let mut errors = Errors::new();
    let elements = document.at("/a").expect("there").array(&mut errors).expect("an array");
    assert_eq!(elements[0].integer(&mut errors), Ok(1));
    assert_eq!(elements[1].string(&mut errors), Ok("s"));
    assert_eq!(elements[4].boolean(&mut errors), Ok(true));
    for index in [1, 5, 6, 7] {
        assert!(elements[index].integer(&mut errors).is_err(), "{index}");
    }
    assert!(elements[2].object(&mut errors).is_err());
    assert!(elements[3].array(&mut errors).is_err());
    assert!(elements[0].boolean(&mut errors).is_err());
    assert!(elements[0].string(&mut errors).is_err());
    let errors = errors.conclude(&document, Ok(())).expect_err("eight errors");
    assert_eq!(errors.errors().len(), 8);
    assert!(errors.errors().iter().all(|error| error.kind == ErrorKind::Type));
    assert_eq!(errors.errors()[0].expected.as_deref(), Some("expected true or false"));
    // File order, whatever the order in which they were found.
    assert!(errors.errors().windows(2).all(|pair| pair[0].span.start <= pair[1].span.start));
}

#[test]
fn the_canonical_form_is_documented_to_the_byte() {
    let text = " { \"b\" : [ 1.50e+3 , 1E2, -0, 0.10, true , null ] , \"a\" : \"\\u00e9\\u0001\\/\\t\\\"\\u007f\", \"A\": {} } ";
    let document = Document::parse("x", text).expect("valid JSON");
    let canonical = "{\"A\":{},\"a\":\"é\\u0001/\\t\\\"\u{7f}\",\"b\":[1.50e+3,1E2,-0,0.10,true,null]}";
    assert_eq!(document.root().canonical(), canonical);
    assert_eq!(
        document.root().to_json().to_string(),
        "{\"b\":[1.50e+3,1E2,-0,0.10,true,null],\"a\":\"é\\u0001/\\t\\\"\u{7f}\",\"A\":{}}"
    );
    // Neither white space nor the order of keys matters to the digest, every character of a number does.
    let digest = |text: &str| Document::parse("x", text).expect("valid JSON").root().sha256();
    assert_eq!(digest(canonical), document.root().sha256());
    assert_eq!(digest("{}"), "44136fa355b3678a1146ad16f7e8649e94fb4fc21fe77e8310c060f61caaff8a");
    assert_ne!(digest("[1.5e3]"), digest("[1.50e3]"));
    assert_ne!(digest("[1e3]"), digest("[1E3]"));
}

fn json() -> impl Strategy<Value = serde_json::Value> {
    let leaf = prop_oneof![
        Just(serde_json::Value::Null),
        any::<bool>().prop_map(serde_json::Value::from),
        any::<i64>().prop_map(serde_json::Value::from),
        any::<f64>().prop_filter("JSON has finite numbers only", |x| x.is_finite()).prop_map(serde_json::Value::from),
        any::<String>().prop_map(serde_json::Value::from),
    ];
    leaf.prop_recursive(6, 64, 8, |inner| {
        prop_oneof![
            prop::collection::vec(inner.clone(), 0..8).prop_map(serde_json::Value::from),
            prop::collection::hash_map(any::<String>(), inner, 0..8)
                .prop_map(|map| serde_json::Value::Object(map.into_iter().collect())),
        ]
    })
}

/// A specification in which one value was replaced.
fn mangled() -> impl Strategy<Value = String> {
    let base: serde_json::Value = serde_json::from_str(EXAMPLE_TEXT).expect("a valid example");
    let pointers = [
        "/format",
        "/version",
        "/name",
        "/period",
        "/lyapunov",
        "/lyapunov/p_low",
        "/lyapunov/alpha",
        "/bounds",
        "/bounds/q",
        "/domain",
        "/domain/X",
        "/internal_model",
        "/internal_model/mu",
        "/internal_model/base_frequency",
        "/internal_model/matched",
        "/internal_model/weights",
        "/internal_model/weights/family",
        "/internal_model/weights/n0",
        "/internal_model/weights/epsilon",
        "/initial_set",
        "/initial_set/kind",
    ];
    let text = "[-+*/^()0-9eEXpisqrtanlog., ]{0,20}".prop_map(serde_json::Value::from);
    (prop::sample::select(pointers.to_vec()), prop_oneof![json(), text]).prop_map(move |(pointer, value)| {
        let mut document = base.clone();
        *document.pointer_mut(pointer).expect("there") = value;
        document.to_string()
    })
}

proptest! {
    #[test]
    fn arbitrary_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        if let Err(errors) = Document::from_bytes("x", &bytes) {
            prop_assert!(!errors.render(true).is_empty());
        }
    }

    #[test]
    fn arbitrary_json_like_text_never_panics(text in "[\\[\\]{}:,\"\\\\a-f0-9eE.+\\- u\u{e9}\t\n]{0,80}") {
        if let Err(errors) = Specification::from_json("x", &text) {
            prop_assert!(!errors.render(false).is_empty() && !errors.errors().is_empty());
        }
        // The two readers agree on what is JSON, apart from duplicate keys.
        let ours = Document::parse("x", &text);
        let theirs = serde_json::from_str::<serde_json::Value>(&text);
        match &ours {
            Ok(_) => prop_assert!(theirs.is_ok()),
            Err(errors) if errors.errors()[0].kind == ErrorKind::Syntax => prop_assert!(theirs.is_err()),
            Err(_) => {}
        }
    }

    #[test]
    fn mangled_specifications_never_panic(text in mangled()) {
        if let Err(errors) = Specification::from_json("x", &text) {
            for error in errors.errors() {
                prop_assert!(text.get(error.span.clone()).is_some());
            }
            prop_assert!(!errors.render(false).is_empty());
        }
    }

    #[test]
    fn valid_json_is_read_as_it_is(value in json()) {
        for text in [value.to_string(), format!("{value:#}")] {
            let document = Document::parse("x", &text).map_err(|e| TestCaseError::fail(e.to_string()))?;
            // Numbers are compared as `serde_json` reads them.
            let again: serde_json::Value = serde_json::from_str(&document.root().to_json().to_string()).expect("JSON");
            prop_assert_eq!(&again, &serde_json::from_str::<serde_json::Value>(&text).expect("JSON"));
            let canonical = document.root().canonical();
            let reread = Document::parse("x", &canonical).expect("canonical JSON");
            prop_assert_eq!(reread.root().canonical(), canonical);
        }
    }

    #[test]
    fn strings_are_written_as_serde_json_writes_them(text in any::<String>()) {
        let written = serde_json::to_string(&text).expect("a string");
        let document = Document::parse("x", &written).expect("a string is JSON");
        prop_assert_eq!(document.root().text(), Some(text.as_str()));
        prop_assert_eq!(document.root().canonical(), written);
    }
}
