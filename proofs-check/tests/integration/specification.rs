//! Rule: the embedded specification, its digest, and the weights.

use crate::common::*;
use proofs_check::check;
use proofs_check::verdict::Verdict::{BadInput, Invalid, Undecided, Valid};
use serde_json::{Value, json};

/// The specification of a folder's file in the paper's certificate, with the right digest.
fn embedded(text: &str) -> proofs_check::Report {
    let mut certificate = certificate(PAPER);
    certificate["specification"] = Value::String("HERE".to_owned());
    check(certificate.to_string().replacen("\"HERE\"", text, 1).as_bytes())
}

#[test]
fn every_shipped_certificate_is_valid() {
    for name in names("certificates") {
        let report = check(text("certificates", &name).as_bytes());
        assert_valid(&report);
        assert!(report.lines.len() > 15, "{name}: the argument has a line for every condition");
    }
}

#[test]
fn every_invalid_specification_is_refused() {
    for name in names("../../specs/invalid") {
        let text = std::fs::read_to_string(folder("../../specs/invalid").join(format!("{name}.json"))).unwrap();
        let report = embedded(&text);
        let finding = report.finding.as_ref().expect(&name);
        // It must fall with the specification itself, not merely with the digest that no longer fits.
        if report.verdict == Invalid && finding.rule == "digest" {
            assert!(
                ["decreasing-bound", "decreasing-one-sided", "increasing-rate", "negative-bound", "not-hurwitz"]
                    .contains(&name.as_str()),
                "{name}: only the digest"
            );
        }
    }
}

#[test]
fn ranges() {
    let spec = |pointer: &str| format!("/specification/{pointer}");
    for (pointer, value, verdict) in [
        ("period", "0", Invalid),
        ("period", "-1", Invalid),
        ("lyapunov/alpha", "0", Invalid),
        ("lyapunov/alpha", "sin(pi)", Undecided),
        ("lyapunov/p_up", "0.999", Invalid),
        ("internal_model/mu", "-1", Invalid),
        ("domain/X", "0", Invalid),
        ("internal_model/base_frequency", "2*pi + 1e-30", Invalid),
        ("internal_model/base_frequency", "exp(log(2*pi))", Undecided),
    ] {
        assert_refused(&changed(PAPER, &spec(pointer), value), verdict, "specification", "/specification");
    }
    // 2 pi in other words, which the sentence repeats without the white space.
    let report = changed(PAPER, &spec("internal_model/base_frequency"), " 4 * pi\t/2\n");
    assert!(
        said(&report).contains(" and base frequency 4*pi/2, the closed loop of every plant"),
        "{}",
        report.text(false)
    );
}

#[test]
fn unknown_fields_and_missing_ones() {
    for object in ["", "/specification", "/specification/bounds", "/claim", "/witness", "/witness/transfer", "/tool"] {
        assert_refused(&with(PAPER, object, "extra", 1), BadInput, "format", &format!("{object}/extra"));
    }
    // Nothing is used of its name, which has to be there.
    assert_refused(
        &judged(&without(&certificate(PAPER), ["/specification/name"])),
        BadInput,
        "format",
        "/specification",
    );
    for (object, name) in [("/specification", "name"), ("/specification", "description")] {
        assert_refused(&with(PAPER, object, name, 1), BadInput, "format", &format!("{object}/{name}"));
    }
    assert_refused(
        &changed(PAPER, "/specification/initial_set/kind", "ball"),
        BadInput,
        "format",
        "/specification/initial_set/kind",
    );
    assert_refused(
        &with(PAPER, "/specification/initial_set", "X0", "1"),
        BadInput,
        "format",
        "/specification/initial_set/X0",
    );
}

#[test]
fn the_digest_is_over_numbers_as_written() {
    let original = text("certificates", "no-x.sharp");
    assert_eq!(check(original.as_bytes()).verdict, Valid);
    for (from, to) in [("\"p_low\": 1,", "\"p_low\": 1.0,"), ("\"alpha\": 1\n", "\"alpha\": 1E0\n")] {
        let changed = original.replacen(from, to, 1);
        assert_ne!(changed, original);
        let report = check(changed.as_bytes());
        assert_refused(&report, Invalid, "digest", "/specification_sha256");
    }
    // White space and the order of keys have no meaning.
    let loose = original.replacen("\"p_low\": 1,", "", 1).replacen("\"p_up\": 1,", "\"p_up\" :1,\"p_low\":1 ,", 1);
    assert_ne!(loose, original);
    assert_valid(&check(loose.as_bytes()));
    assert_eq!(
        proofs_check::sha256::hex_digest(b"abc"),
        "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
    );
    let long = "a".repeat(1000);
    assert_eq!(
        proofs_check::sha256::hex_digest(long.as_bytes()),
        "41edece42d63e8d9bf515a9ba6932e1c20cbc9f5a5d134645adb5db1b9737ea3"
    );
}

#[test]
fn weights() {
    let set = |weights: Value| with(PAPER, "/specification/internal_model", "weights", weights);
    let tail = |exponent: &str| json!({ "coefficient": "1", "exponent": exponent });
    let explicit = |values: &[&str], exponent: &str| {
        set(json!({ "family": "explicit", "values": values, "tail": tail(exponent) }))
    };
    let power = |n0: &str, epsilon: &str| set(json!({ "family": "power", "n0": n0, "epsilon": epsilon }));
    let rule = |report: proofs_check::Report| report.finding.map(|finding| (finding.verdict, finding.rule));
    let broken = Some((Invalid, "weights"));
    for report in [
        power("1", "1/2"),
        power("2", "0"),
        power("2", "1.0001"),
        power("2", "-1"),
        explicit(&["2", "1"], "1"),
        explicit(&["2", "1"], "2.1"),
        explicit(&["2", "2"], "3/2"),
        explicit(&["2", "1", "0.6"], "3/2"),
        explicit(&["2", "1", "0.2"], "3/2"),
        explicit(&["3", "2", "1/2"], "3/2"),
        explicit(&["2", "-1"], "3/2"),
    ] {
        assert_eq!(rule(report), broken);
    }
    let undecided = explicit(&["2", "exp(log(2))/2", "1/2", "1/3"], "1 + 1e-9");
    assert_eq!(rule(undecided), Some((Undecided, "weights")));
    // Equality in W2 and W3 is allowed, and decided exactly.
    for report in [
        explicit(&["2", "1", "1/2"], "5/4"),
        explicit(&["2", "1", "1/4", "1/9"], "2"),
        explicit(&["2", "1", "sqrt(2)/4"], "3/2"),
        power("2", "1"),
    ] {
        assert_ne!(rule(report), broken);
    }
}

#[test]
fn the_filter_is_hurwitz() {
    let a = |list: &[&str]| with(PAPER, "/specification", "relative_degree", json!({ "a": list }));
    assert_valid(&a(&["6", "11", "6"]));
    assert_valid(&a(&["1"]));
    // (10, 1, 1) of erratum E14, a pair on the imaginary axis, a wrong sign.
    for list in [&["10", "1", "1"][..], &["1", "0"], &["6", "6", "1"], &["-1"], &["1", "-1", "1"]] {
        assert_refused(&a(list), Invalid, "specification", "/specification/relative_degree");
    }
    assert_refused(&a(&[]), BadInput, "format", "/specification/relative_degree");
    // (s + 1)^4: of relative degree 5.
    assert_refused(&a(&["1", "4", "6", "4"]), BadInput, "format", "/specification/relative_degree");
    assert_refused(&a(&["pi"]), BadInput, "format", "/specification/relative_degree");
}

#[test]
fn certificates_of_every_tool_are_read() {
    // Who wrote a certificate is a free text: it proves nothing.
    for version in ["0.1.0", "12.345.6789", "", "1.0.0-beta"] {
        assert_valid(&changed(PAPER, "/tool/version", version));
    }
    let report = changed(PAPER, "/tool/name", "another");
    assert_valid(&report);
    assert!(report.text(false).contains("tool (free text): another 0.1.0"), "{}", report.text(false));
    assert_refused(&changed(PAPER, "/tool/version", 1), BadInput, "format", "/tool/version");
}
