//! The shipped specifications: the valid ones are read, the invalid ones are refused in the right place.

use crate::support::{files, stem};
use sigmastar_lang::spec::{ErrorKind, Specification};

#[test]
fn valid_examples_are_read() {
    let files = files("specs");
    assert!(files.len() >= 10);
    for path in files {
        let text = std::fs::read_to_string(&path).expect("readable");
        let specification =
            Specification::from_json(stem(&path), &text).unwrap_or_else(|e| panic!("{}", e.render(false)));
        assert!(!specification.name.is_empty(), "{}", path.display());
        assert!(specification.description.is_some_and(|description| description.len() > 30), "{}", path.display());
    }
}

/// Kind, pointer and the text at the span of an error.
type Found<'t> = (ErrorKind, &'t str, &'t str);

/// These are read: what is wrong with them is for the proof of the bounding functions to find.
const READ_FINE: [&str; 4] = ["decreasing-bound", "decreasing-one-sided", "increasing-rate", "negative-bound"];

#[test]
fn invalid_examples_are_refused_where_they_are_wrong() {
    use ErrorKind::*;
    // File; for each error in file order: kind, pointer, text at the span.
    let expected: &[(&str, &[Found<'_>])] = &[
        ("bad-expression", &[(Expression, "/bounds/q", ")")]),
        ("bad-family", &[(UnknownName, "/internal_model/weights/family", "\"geometric\"")]),
        ("bad-kind", &[(UnknownName, "/initial_set/kind", "\"at_rest\"")]),
        ("duplicate-key", &[(DuplicateKey, "/period", "\"period\"")]),
        ("empty", &[(Syntax, "", "")]),
        ("escaped-text", &[(Expression, "/bounds/f_xx", "\\u00e9")]),
        ("exponent-too-large", &[(Limit, "", "1e999999999")]),
        ("foreign-field", &[(UnknownField, "/initial_set/X0", "\"X0\"")]),
        ("half-a-domain", &[(MissingField, "/domain/E", "\"domain\"")]),
        ("irrational-coefficient", &[(Range, "/relative_degree/a/0", "sqrt(2)")]),
        (
            "jacobian",
            &[
                (Range, "/lyapunov/jacobian/0/0", "sin(3*t)"),
                (Range, "/lyapunov/jacobian/0/1", "["),
                (Range, "/lyapunov/jacobian/1/0", "-sqrt(3) + t"),
            ],
        ),
        (
            "many-errors",
            &[
                (Range, "/period", "0"),
                (Expression, "/bounds/f_xx", ""),
                (UnknownName, "/initial_set/kind", "\"papr\""),
            ],
        ),
        ("matched-undecided", &[(Undecided, "/internal_model/base_frequency", "exp(log(2*pi))")]),
        ("missing-field", &[(MissingField, "/period", "{"), (MissingField, "/bounds/q_t", "\"bounds\"")]),
        ("misspelt-field", &[(MissingField, "/bounds/q_e", "\"bounds\""), (UnknownField, "/bounds/qe", "\"qe\"")]),
        ("negative-harmonic", &[(Range, "/q_0/harmonics/1", "-0.8")]),
        ("rate-beside-jacobian", &[(UnknownField, "/lyapunov/rate", "\"rate\"")]),
        ("negative-initial-set", &[(Range, "/initial_set/X0", "-1")]),
        ("negative-period", &[(Range, "/period", "-1")]),
        ("no-tail", &[(MissingField, "/internal_model/weights/tail", "\"weights\"")]),
        ("no-value", &[(Expression, "/period", "1/0")]),
        ("not-json", &[(Syntax, "", "/")]),
        ("not-matched", &[(Matched, "/internal_model/base_frequency", "6.283185307179586")]),
        ("p-order", &[(Range, "/lyapunov/p_up", "1.5512")]),
        ("too-deep", &[(Limit, "", "[")]),
        ("trailing-comma", &[(Syntax, "", "}")]),
        ("undecided-sign", &[(Undecided, "/lyapunov/alpha", "sin(pi)")]),
        ("unknown-field", &[(UnknownField, "/lyapunov/aplha", "\"aplha\"")]),
        ("unknown-function", &[(Expression, "/bounds/q", "atn")]),
        ("unquoted-escape", &[(Expression, "/bounds/q", "\\\\")]),
        ("variable-in-constant", &[(Expression, "/period", "X")]),
        ("weights-epsilon", &[(Weights, "/internal_model/weights/epsilon", "1.01")]),
        ("weights-junction", &[(Weights, "/internal_model/weights/values/2", "0.3")]),
        ("weights-n0", &[(Weights, "/internal_model/weights/n0", "1")]),
        ("weights-undecided", &[(Undecided, "/internal_model/weights/values/2", "1/2")]),
        ("weights-w2", &[(Weights, "/internal_model/weights/values/2", "0.6")]),
        ("weights-w3", &[(Weights, "/internal_model/weights/values/2", "0.2")]),
        ("wrong-format", &[(Format, "/format", "\"sigmastar/certificate\"")]),
        ("wrong-type", &[(Type, "/period", "true")]),
        ("wrong-version", &[(Version, "/version", "2")]),
        ("zero-alpha", &[(Range, "/lyapunov/alpha", "0")]),
    ];
    let mut seen = Vec::new();
    for path in files("specs/invalid") {
        let name = stem(&path).to_owned();
        let label = format!("{name}.json");
        let text = std::fs::read_to_string(&path).expect("readable");
        let outcome = Specification::from_json(&label, &text);
        seen.push(name.clone());
        if READ_FINE.contains(&name.as_str()) {
            assert!(outcome.is_ok(), "{name}");
            continue;
        }
        let errors = outcome.expect_err(&name);
        let (_, wanted) =
            expected.iter().find(|(file, _)| *file == name).unwrap_or_else(|| panic!("{name} is not listed"));
        let found: Vec<Found<'_>> = errors
            .errors()
            .iter()
            .map(|error| (error.kind, error.pointer.as_str(), &text[error.span.clone()]))
            .collect();
        assert_eq!(found, *wanted, "{name}");
        assert_eq!(errors.is_undecided(), wanted.iter().all(|(kind, ..)| *kind == Undecided), "{name}");
        insta::assert_snapshot!(format!("invalid-{name}"), errors.render(false));
    }
    assert_eq!(seen.len(), expected.len() + READ_FINE.len());
}
