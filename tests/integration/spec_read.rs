//! What a specification means once it is read: numbers, ranges, `matched`, initial sets.

use crate::support::{EXAMPLE_TEXT, PLANT_TEXT};
use rug::Rational;
use sigmastar_exact::number::parse_decimal;
use sigmastar_lang::plant::{InitialRegulator, Plant};
use sigmastar_lang::spec::{Bound, Constant, Document, ErrorKind, InitialSet, SpecErrors, Specification, Weights};

/// The example with one piece of its text replaced.
fn with(old: &str, new: &str) -> Result<Specification, SpecErrors> {
    assert_eq!(EXAMPLE_TEXT.matches(old).count(), 1, "{old}");
    Specification::from_json("test.json", &EXAMPLE_TEXT.replace(old, new))
}

fn read(old: &str, new: &str) -> Specification {
    with(old, new).unwrap_or_else(|errors| panic!("{}", errors.render(false)))
}

/// Kind, pointer and message of the only error.
fn refused(old: &str, new: &str) -> (ErrorKind, String, String) {
    let errors = with(old, new).expect_err(new);
    assert_eq!(errors.errors().len(), 1, "{errors}");
    let error = &errors.errors()[0];
    (error.kind, error.pointer.clone(), error.message.clone())
}

const PERIOD: &str = "\"period\": \"1\"";
const FREQUENCY: &str = "\"base_frequency\": \"2*pi\"";
const MATCHED: &str = "\"matched\": true";
const SET: &str = "\"initial_set\": { \"kind\": \"paper\" }";

#[test]
fn the_example_means_what_it_says() {
    let specification = Specification::from_json("x", EXAMPLE_TEXT).expect("valid");
    assert_eq!(specification.period.nominal().as_rational(), Some(&Rational::from(1)));
    assert_eq!(specification.lyapunov.triple().unwrap().p_up.as_rational(), Some(&Rational::from((15512, 10000))));
    assert_eq!(specification.bounds.get(Bound::Q).unwrap().text(), "4.822 + X + atan(E*(X + 0.189))");
    assert_eq!(specification.bounds.named().count(), 8);
    assert!(specification.internal_model.matched);
    assert!(matches!(specification.initial_set, InitialSet::Paper));
    assert!(specification.relative_degree.is_none());
    let domain = specification.domain.expect("given");
    assert_eq!((domain.x.to_f64(), domain.e.to_f64()), (10.0, 10.0));
}

#[test]
fn numbers_are_taken_as_written() {
    for text in ["0.1", "1.50e+3", "15E-1", "0.10", "1e-4000", "123456789.123456789123456789"] {
        let wanted = parse_decimal(text).expect("a decimal");
        assert_eq!(
            read("\"X\": \"10\"", &format!("\"X\": {text}")).domain.expect("given").x.as_rational(),
            Some(&wanted)
        );
        let string = read("\"X\": \"10\"", &format!("\"X\": \"{text}\"")).domain.expect("given").x;
        assert_eq!((string.as_rational(), string.text.as_str()), (Some(&wanted), text));
    }
}

#[test]
fn the_document_is_kept_as_written() {
    let specification = read("\"mu\": \"1\"", "\"mu\": 1.50E+3");
    let written = specification.document.to_string();
    assert!(written.contains("\"mu\":1.50E+3"), "{written}");
    assert!(written.starts_with("{\"format\":\"sigmastar/bounding-spec\",\"version\":1,\"name\":"), "{written}");
    let again = Specification::from_json("x", &written).expect("valid");
    assert_eq!(again.sha256, specification.sha256);
    assert_ne!(read("\"mu\": \"1\"", "\"mu\": 1.50e+3").sha256, specification.sha256);
    assert_eq!(read(MATCHED, "\n\n \"matched\" : true").sha256, read(SET, SET).sha256);
}

#[test]
fn an_embedded_specification_is_read_in_place() {
    let outer = format!("{{\"specification\": {}}}", EXAMPLE_TEXT.replace("\"4.822 + ", "\"4.822 +* "));
    let document = Document::parse("certificate.json", &outer).expect("JSON");
    let errors = Specification::from_value(&document.at("/specification").expect("there")).expect_err("an error");
    assert_eq!(errors.errors()[0].pointer, "/specification/bounds/q");
    assert_eq!(&outer[errors.errors()[0].span.clone()], "*");

    let outer = format!("{{\"specification\": {EXAMPLE_TEXT}}}");
    let document = Document::parse("certificate.json", &outer).expect("JSON");
    let embedded = Specification::from_value(&document.at("/specification").expect("there")).expect("valid");
    assert_eq!(embedded.sha256, Specification::from_json("x", EXAMPLE_TEXT).expect("valid").sha256);
    let text = embedded.bounds.get(Bound::Q).unwrap().text().to_owned();
    let part = text.find("atan").map(|at| at..at + 4).expect("there");
    let errors = embedded.errors_at("/bounds/q", &part, ErrorKind::Range, "decreases here", Some("mend it".to_owned()));
    assert_eq!(errors.errors()[0].pointer, "/specification/bounds/q");
    assert_eq!(&outer[errors.errors()[0].span.clone()], "atan");
    assert!(errors.render(false).contains("help: mend it"));
}

#[test]
fn signs_are_proved() {
    for (text, kind) in [
        ("\"0\"", ErrorKind::Range),
        ("-1", ErrorKind::Range),
        ("\"pi - 22/7\"", ErrorKind::Range),
        ("\"sqrt(2) - sqrt(8)/2\"", ErrorKind::Range),
        ("\"sqrt(2) + sqrt(3) - sqrt(5 + 2*sqrt(6))\"", ErrorKind::Undecided),
        ("\"exp(-1) - exp(-1)\"", ErrorKind::Undecided),
        ("\"sqrt(-1)\"", ErrorKind::Expression),
        ("\"log(0)\"", ErrorKind::Expression),
        ("\"X\"", ErrorKind::Expression),
        ("\"\"", ErrorKind::Expression),
        ("null", ErrorKind::Type),
    ] {
        for (field, pointer) in [
            ("\"mu\": \"1\"", "/internal_model/mu"),
            ("\"alpha\": \"0.58\"", "/lyapunov/alpha"),
            (PERIOD, "/period"),
            ("\"p_low\": \"1\"", "/lyapunov/p_low"),
            ("\"E\": \"10\"", "/domain/E"),
            (FREQUENCY, "/internal_model/base_frequency"),
        ] {
            let name = field.split(':').next().expect("a field");
            let (found, at, _) = refused(field, &format!("{name}: {text}"));
            assert_eq!((found, at.as_str()), (kind, pointer), "{text}");
        }
    }
    // Close to 0 and yet decided: the difference is about 1e-120.
    read("\"mu\": \"1\"", "\"mu\": \"exp(1e-60) - 1 - 1e-60\"");
    read("\"mu\": \"1\"", "\"mu\": \"355/113 - pi\"");
}

#[test]
fn p_low_may_equal_p_up() {
    read("\"p_low\": \"1\"", "\"p_low\": 1.5512");
    read("\"p_low\": \"1\"", "\"p_low\": \"3878/2500\"");
    let (kind, pointer, message) = refused("\"p_low\": \"1\"", "\"p_low\": \"1.55120000000000000001\"");
    assert_eq!((kind, pointer.as_str()), (ErrorKind::Range, "/lyapunov/p_up"));
    assert_eq!(message, "p_low <= p_up fails: p_low = 1.55120000000000000001 and p_up = 1.5512");
    assert_eq!(refused("\"p_low\": \"1\"", "\"p_low\": \"exp(log(1.5512))\"").0, ErrorKind::Undecided);
}

#[test]
fn matched_is_proved_exactly_or_refused() {
    for (period, frequency) in
        [("1", "2*pi"), ("1/3", "6*pi"), ("0.001", "2000*pi"), ("2*pi", "1"), ("sqrt(2)*pi", "sqrt(2)"), ("pi", "2")]
    {
        let text = EXAMPLE_TEXT
            .replace(PERIOD, &format!("\"period\": \"{period}\""))
            .replace(FREQUENCY, &format!("\"base_frequency\": \"{frequency}\""));
        assert!(Specification::from_json("x", &text).is_ok(), "{period} {frequency}");
        // Not asserting what holds is allowed, and leaves it unasserted.
        let silent = Specification::from_json("x", &text.replace("\"matched\": true", "\"matched\": false"));
        assert!(!silent.expect("valid").internal_model.matched);
    }
    for frequency in ["6.283185307179586", "44/7", "2*pi + 1e-300", "3", "2*pi*(1 + 1e-200)", "exp(1)"] {
        let errors = with(FREQUENCY, &format!("\"base_frequency\": \"{frequency}\"")).expect_err(frequency);
        assert_eq!(errors.errors()[0].kind, ErrorKind::Matched, "{frequency}");
        assert_eq!(errors.errors()[0].expected.as_deref(), Some("`2*pi` would be right"));
        let unmatched = EXAMPLE_TEXT.replace(MATCHED, "\"matched\": false");
        let unmatched = unmatched.replace(FREQUENCY, &format!("\"base_frequency\": \"{frequency}\""));
        assert!(Specification::from_json("x", &unmatched).is_ok());
    }
    for (period, right) in [("2", "pi"), ("3", "2/3*pi"), ("0.1", "20*pi"), ("sqrt(2)", "2*pi/(sqrt(2))")] {
        let errors = with(PERIOD, &format!("\"period\": \"{period}\"")).expect_err(period);
        assert_eq!(errors.errors()[0].expected, Some(format!("`{right}` would be right")));
        // The suggestion is right.
        let mended = EXAMPLE_TEXT
            .replace(PERIOD, &format!("\"period\": \"{period}\""))
            .replace(FREQUENCY, &format!("\"base_frequency\": \"{right}\""));
        assert!(Specification::from_json("x", &mended).expect("valid").internal_model.matched);
    }
    let (kind, pointer, _) = refused(FREQUENCY, "\"base_frequency\": \"2*pi*exp(0)\"");
    assert_eq!((kind, pointer.as_str()), (ErrorKind::Undecided, "/internal_model/base_frequency"));
    // Not asserted where it is not there.
    assert!(!read("\"matched\": true,", "").internal_model.matched);
}

#[test]
fn initial_sets_have_their_own_fields() {
    let set = |text: &str| format!("\"initial_set\": {text}");
    let at_rest = read(SET, &set("{ \"kind\": \"at-rest\", \"X0\": 0.5 }")).initial_set;
    assert!(matches!(&at_rest, InitialSet::AtRest { x0: Some(x0), e0: None } if x0.to_f64() == 0.5));
    let zero = read(SET, &set("{ \"kind\": \"box\", \"X0\": 0, \"E0\": \"0\", \"Z0\": \"1/3\" }")).initial_set;
    assert!(matches!(&zero, InitialSet::Box { z0, .. } if z0.as_rational() == Some(&Rational::from((1, 3)))));
    for (text, kind, pointer) in [
        ("{ \"kind\": \"box\", \"X0\": 1, \"E0\": 1 }", ErrorKind::MissingField, "/initial_set/Z0"),
        ("{ \"kind\": \"at-rest\", \"Z0\": 1 }", ErrorKind::UnknownField, "/initial_set/Z0"),
        ("{ \"kind\": \"paper\", \"E0\": 1 }", ErrorKind::UnknownField, "/initial_set/E0"),
        ("{ \"X0\": 1 }", ErrorKind::MissingField, "/initial_set/kind"),
        ("{ \"kind\": \"box\", \"X0\": 1, \"E0\": 1, \"Z0\": \"-1e-9\" }", ErrorKind::Range, "/initial_set/Z0"),
        ("{ \"kind\": \"at-rest\", \"E0\": \"-1\" }", ErrorKind::Range, "/initial_set/E0"),
        ("{ \"kind\": \"at-rest\", \"E0\": \"log(exp(1)) - 1\" }", ErrorKind::Undecided, "/initial_set/E0"),
        ("\"paper\"", ErrorKind::Type, "/initial_set"),
    ] {
        let (found, at, _) = refused(SET, &set(text));
        assert_eq!((found, at.as_str()), (kind, pointer), "{text}");
    }
}

/// `aligned` has the sizes of `at-rest`, and says of z itself what it is.
#[test]
fn an_aligned_set_has_no_z0() {
    let set = |text: &str| format!("\"initial_set\": {text}");
    let half = Rational::from((1, 2));
    for (sizes, expected) in [
        ("", [None, None]),
        (", \"X0\": 0.5", [Some(&half), None]),
        (", \"E0\": \"1/2\"", [None, Some(&half)]),
        (", \"X0\": \"0.5\", \"E0\": 0.5", [Some(&half), Some(&half)]),
    ] {
        let found = read(SET, &set(&format!("{{ \"kind\": \"aligned\"{sizes} }}"))).initial_set;
        assert!(matches!(found, InitialSet::Aligned { .. }) && found.is_aligned(), "{sizes}");
        assert_eq!(found.given().map(|size| size.and_then(Constant::as_rational)), expected, "{sizes}");
    }
    for (field, kind) in [
        ("\"Z0\": 0", ErrorKind::UnknownField),
        ("\"E0\": \"-1\"", ErrorKind::Range),
        ("\"ball\": 1", ErrorKind::UnknownField),
    ] {
        let name = field.split('"').nth(1).unwrap();
        let (found, at, message) = refused(SET, &set(&format!("{{ \"kind\": \"aligned\", {field} }}")));
        assert_eq!((found, at), (kind, format!("/initial_set/{name}")), "{field}: {message}");
    }
}

/// A plant may ask for a ball, in the place of X0; and its `initial` has no z, which would contradict `aligned`.
#[test]
fn an_aligned_plant_sets_z_itself() {
    let plant = |set: &str, z: &str| {
        let (old, end) =
            ("\"initial\": { \"x\": [\"1\", \"-2\"], \"e\": \"4\" }", "\"initial\": { \"x\": [1, -2], \"e\": 4");
        assert_eq!(PLANT_TEXT.matches(old).count(), 1);
        let new = format!("\"initial_set\": {set}, {end}{z} }}");
        Plant::from_json("plant.json", &PLANT_TEXT.replace(old, &new))
    };
    let aligned = plant("{ \"kind\": \"aligned\", \"ball\": \"1/2\", \"E0\": 2 }", "").unwrap();
    assert_eq!(aligned.initial.z, InitialRegulator::Aligned);
    assert_eq!(aligned.ball.as_ref().and_then(Constant::as_rational), Some(&Rational::from((1, 2))));
    assert!(aligned.initial_set.is_aligned() && aligned.initial_set.given()[1].is_some());
    let z = ", \"z\": [4, 4, 0]";
    let at_rest = plant("{ \"kind\": \"at-rest\" }", z).unwrap();
    assert_eq!(at_rest.initial.z, InitialRegulator::Given(vec![4.0, 4.0, 0.0]));
    assert_eq!(plant("{ \"kind\": \"at-rest\" }", "").unwrap().initial.z, InitialRegulator::AtRest);
    for (set, z, at, words) in [
        ("{ \"kind\": \"aligned\", \"ball\": 1, \"X0\": 1 }", "", "/initial_set/X0", "`X0` and `ball`"),
        ("{ \"kind\": \"aligned\" }", z, "/initial/z", "sets z itself"),
        ("{ \"kind\": \"aligned\" }", z, "/initial/z", "leave `z` out"),
        ("{ \"kind\": \"aligned\", \"Z0\": 1 }", "", "/initial_set/Z0", "Z0"),
    ] {
        let errors = plant(set, z).unwrap_err();
        let [error] = errors.errors() else { panic!("{set}: {errors}") };
        assert_eq!((error.kind, error.pointer.as_str()), (ErrorKind::UnknownField, at), "{set}");
        assert!(errors.render(false).contains(words), "{}", errors.render(false));
    }
}

#[test]
fn relative_degree_takes_one_to_three_rationals() {
    let degree = |list: &str| format!("{SET}, \"relative_degree\": {{ \"a\": {list} }}");
    let a = read(SET, &degree("[\"1/3\", -2, \"sqrt(4)\"]")).relative_degree.expect("given").a;
    let values: Vec<f64> = a.iter().map(sigmastar_lang::spec::Constant::to_f64).collect();
    assert_eq!(values, [1.0 / 3.0, -2.0, 2.0]);
    let list = |count: usize| format!("[{}]", vec!["1"; count].join(","));
    read(SET, &degree(&list(3)));
    for (text, pointer) in [
        ("[]".to_owned(), "/relative_degree/a"),
        (list(4), "/relative_degree/a"),
        ("[1, \"pi\"]".to_owned(), "/relative_degree/a/1"),
        ("[\"exp(0)\"]".to_owned(), "/relative_degree/a/0"),
    ] {
        let (kind, at, _) = refused(SET, &degree(&text));
        assert_eq!((kind, at.as_str()), (ErrorKind::Range, pointer), "{text}");
    }
    let words = with(SET, &degree(&list(4))).expect_err("4 coefficients").render(false);
    assert!(words.contains("relative degree 2 to 4"), "{words}");
}

#[test]
fn every_field_is_known_and_every_required_one_is_there() {
    let value: serde_json::Value = serde_json::from_str(EXAMPLE_TEXT).expect("JSON");
    let optional = ["/description", "/domain", "/internal_model/matched"];
    let mut pointers = Vec::new();
    for (key, inner) in value.as_object().expect("an object") {
        pointers.push(format!("/{key}"));
        pointers
            .extend(inner.as_object().into_iter().flat_map(|inner| inner.keys()).map(|name| format!("/{key}/{name}")));
    }
    assert_eq!(pointers.len(), 28);
    for pointer in pointers {
        let (parent, name) = pointer.rsplit_once('/').expect("a pointer");
        let object = |value: &mut serde_json::Value, edit: &dyn Fn(&mut serde_json::Map<String, serde_json::Value>)| {
            edit(value.pointer_mut(parent).and_then(serde_json::Value::as_object_mut).expect("an object"));
        };
        let mut without = value.clone();
        object(&mut without, &|map| drop(map.shift_remove(name)));
        let outcome = Specification::from_json("x", &without.to_string());
        if optional.contains(&pointer.as_str()) {
            assert!(outcome.is_ok(), "{pointer}");
        } else {
            let errors = outcome.expect_err(&pointer);
            assert_eq!(errors.errors().len(), 1, "{errors}");
            assert_eq!(
                (errors.errors()[0].kind, errors.errors()[0].pointer.as_str()),
                (ErrorKind::MissingField, &*pointer)
            );
        }
        let mut extra = value.clone();
        object(&mut extra, &|map| drop(map.insert(format!("{name}_"), serde_json::Value::Null)));
        let errors = Specification::from_json("x", &extra.to_string()).expect_err(&pointer);
        let error = &errors.errors()[0];
        assert_eq!((error.kind, &error.pointer), (ErrorKind::UnknownField, &format!("{pointer}_")));
        // Of the fields that are near, one that is still absent.
        let near = match name {
            "f" => "f_x",
            "q_t" => "q_tx",
            _ => name,
        };
        assert_eq!(error.expected, Some(format!("did you mean `{near}`?")), "{pointer}");
    }
}

#[test]
fn headers_stop_the_reading() {
    for (old, new, kinds) in [
        ("\"version\": 1,", "\"version\": 3, \"whatever\": 0,", vec![ErrorKind::Version]),
        ("\"version\": 1,", "\"version\": \"1\", \"whatever\": 0,", vec![ErrorKind::Type]),
        ("\"version\": 1,", "\"version\": 1.0,", vec![ErrorKind::Type]),
        ("\"version\": 1,", "\"whatever\": 0,", vec![ErrorKind::MissingField]),
        (
            "sigmastar/bounding-spec\", \"version\": 1,",
            "other\", \"version\": 2,",
            vec![ErrorKind::Format, ErrorKind::Version],
        ),
    ] {
        let errors = with(old, new).expect_err(new);
        assert_eq!(errors.errors().iter().map(|error| error.kind).collect::<Vec<_>>(), kinds, "{new}");
    }
}

#[test]
fn colour_is_an_option() {
    let errors = with(PERIOD, "\"period\": \"-1\"").expect_err("negative");
    assert!(!errors.render(false).contains('\u{1b}'));
    assert!(errors.render(true).contains('\u{1b}'));
    assert_eq!(errors.to_string(), "test.json:5:14: `period` must be positive, but it is -1");
    assert_eq!((errors.label(), errors.omitted()), ("test.json", 0));
}

#[test]
fn control_characters_are_never_passed_on() {
    let text = "{\"\\u001b[31mred\\u0007\": 0, \"format\": \"\\u001b[2J\", \"version\": 1}";
    let errors = Specification::from_json("a\u{1b}[31m.json", text).expect_err("wrong format");
    assert!(!errors.render(false).contains(['\u{1b}', '\u{7}']));
    let text = EXAMPLE_TEXT.replace("\"kind\"", "\"kind\\u001b[31m\"").replace(PERIOD, "\"period\": \"\\u001b[31m\"");
    let errors = Specification::from_json("x", &text).expect_err("unknown field");
    assert!(!errors.render(false).contains('\u{1b}'), "{}", errors.render(false));
}

#[test]
fn weights_are_read_into_their_families() {
    let weights = Specification::from_json("x", EXAMPLE_TEXT).expect("valid").internal_model.weights;
    assert!(matches!(&weights, Weights::Power { n0, epsilon } if n0.to_f64() == 2.0 && epsilon.to_f64() == 0.5));
    // n_0 + zeta(3/2).
    let total = weights.total(128);
    assert_eq!(total.decimals(), ["4.6123753486854883", "4.6123753486854884"]);
    assert_eq!(weights.weight(4, 64).decimals(), ["0.125", "0.125"]);
}

/// What is no entry of a Jacobian is told all three forms that are.
#[test]
fn an_entry_of_a_jacobian_of_another_type_is_told_what_may_stand_there() {
    let triple = r#"{ "p_low": "1", "p_up": "1.5512", "alpha": "0.58" }"#;
    for entry in ["null", "true", "{}"] {
        let errors = with(triple, &format!("{{ \"jacobian\": [[{entry}]] }}")).expect_err(entry);
        let [error] = errors.errors() else { panic!("{errors}") };
        assert_eq!((error.kind, error.pointer.as_str()), (ErrorKind::Type, "/lyapunov/jacobian/0/0"));
        assert!(
            error.expected.as_ref().is_some_and(|expected| expected.contains("a number, an interval")),
            "{error:?}"
        );
    }
}
