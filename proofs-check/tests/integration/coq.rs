//! `--coq`: of which certificates a theorem is written, that nothing of a file becomes a part of the script, and, where coqc is
//! installed, that Coq accepts what is true and refuses what is not.

use crate::common::{PAPER, certificate, folder, names, text};
use crate::coq_support::{assert_accepted, assert_refused_at, coqc, every_case, plants, proofs, written};
use crate::input_gain::made as with_a_gain;
use proofs_check::coq::theorem;
use proofs_check::verdict::Verdict;
use serde_json::{Value, json};
use std::process::Command;

/// The files and exit code of a call of the program.
fn program(arguments: &[&str]) -> (i32, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_proofs-check")).args(arguments).output().expect("the program runs");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (output.status.code().unwrap_or(-1), text(&output.stdout), text(&output.stderr))
}

#[test]
fn a_theorem_is_written_of_every_stored_certificate_in_continuous_time() {
    let specifications = names("certificates").into_iter().map(|name| ("certificates", name));
    let gains = names("gain").into_iter().map(|name| ("gain", name));
    for (of, name) in specifications.chain(plants().map(|name| ("plants", name))).chain(gains) {
        let bytes = text(of, &name);
        let written = theorem(bytes.as_bytes()).unwrap_or_else(|finding| panic!("{name}: {finding:?}"));
        assert!(written.contains("Print Assumptions certificate."), "{name}");
    }
    assert_refused_at(&text("sampled", "no-x"), Verdict::Undecided, "/claim/regulator");
    assert_refused_at(&text("plants", "converter-samples.certificate"), Verdict::Undecided, "/claim/regulator");
    assert_refused_at("{}", Verdict::BadInput, "");
}

#[test]
fn the_numbers_are_those_of_the_certificate() {
    let text = written(&certificate(PAPER));
    for line in [
        "  period := 1;",
        "  p_up := 1.5512;",
        "  w := (2 * PI);",
        "  n := power 2 (1 / 2);",
        "  b_fe := fun X E => (X + 0.189);",
        "  domain := Some (10, 10);",
        "  sigma := 41.4618;",
        "  Z_0 := Some (14.445071);",
        "  r_d := 0.59128947;",
        "  damped := None;",
        "  path_q := straight",
        "Proof. decide_matched cert the_weights 2%nat. Qed.",
    ] {
        assert!(text.lines().any(|other| other == line), "{line}");
    }
    assert!(text.contains("  known := by_functions {| b_f := "));
    assert!(text.contains("; b_q := fun X E => ((4.822 + X) + (atan (E * (X + 0.189)))); b_qt := "));
    assert!(text.contains("canonical specification:") && !text.contains("orbit"));
    assert!(text.contains("8f15618c51d5361f8e1b68c697826eac53d91447e93b710fb0af923c0893016c"));
    let damped = written(&certificate("refined.means"));
    assert!(damped.contains("  damped := Some ({| kap := 350; kap_small := false |});"));
    assert!(damped.contains("  refined := Some (0.65584880181913, 1.311697603637, 555.33489025715);"));
    let aligned = written(&certificate("paper-example-aligned.sharp"));
    assert!(aligned.contains("  Z_0 := None;") && aligned.contains("  path_q := x_first\n"));
    let listed = written(&certificate("explicit-weights.sharp"));
    assert!(listed.contains("  n := explicit (cons 2 (cons 1 (cons 0.4 (cons 0.22 nil)))) 1 (1 / 2);"));
    let harmonics = written(&certificate("harmonics.means"));
    assert!(harmonics.contains("  forcing := Some ({| C_k := (cons "));
    // Without the matched criterion the transfer bound is a hypothesis.
    let boxes = written(&certificate("paper-example.boxes"));
    assert!(boxes.contains("  transfer_bound cert ->\n") && boxes.contains("  matched := false;"));
}

/// Names and descriptions are not written, and nothing is decided: a certificate that is wrong gets a theorem like any other.
#[test]
fn no_free_text_is_written_and_nothing_is_decided() {
    let mut made = certificate(PAPER);
    for (object, field) in [("/specification", "name"), ("/specification", "description"), ("/tool", "version")] {
        made.pointer_mut(object).unwrap()[field] = json!("\" *) Axiom wrong : False. (*");
    }
    made["claim"]["statement"] = json!("*) Axiom wrong : False. (*");
    made["claim"]["sigma_star"] = json!("1/3");
    let text = written(&made);
    assert!(!text.contains("Axiom") && text.contains("  sigma := (1 / 3);"));
    made["specification"]["bounds"]["f"] = json!("X^(1/2)");
    assert_refused_at(&made.to_string(), Verdict::Undecided, "/specification/bounds/f");
    for name in ["exprelr", "sinc"] {
        made["specification"]["bounds"]["f"] = json!(format!("X + {name}(X)"));
        let finding = theorem(made.to_string().as_bytes()).expect_err("Coq has no such function");
        assert!(finding.verdict == Verdict::Undecided && finding.message.contains(name), "{}", finding.message);
    }
    made["specification"]["bounds"]["f"] = json!("min(X^2, tanh(E))/exp(-X) + abs(X)^-2");
    assert!(written(&made).contains("fun X E => (((min2 (X ^ 2) (tanh_exp E)) / (exp (- X))) + (/ (Rabs X) ^ 2));"));
}

#[test]
fn the_program_writes_and_refuses() {
    let path = |of: &str, name: &str| folder(of).join(format!("{name}.json")).to_string_lossy().into_owned();
    let (code, out, err) = program(&["--coq", &path("certificates", PAPER)]);
    assert!(code == 0 && err.is_empty() && out == written(&certificate(PAPER)));
    let (code, out, err) = program(&["--coq", &path("sampled", "no-x")]);
    assert!(code == 3 && out.is_empty() && err.contains("/claim/regulator"), "{err}");
    let (code, out, _) = program(&["--coq", &path("plants", "paper-example")]);
    assert!(code == 2 && out.is_empty());
    for flags in [["--coq", "--verbose"], ["--format", "json"]] {
        let (code, out, err) = program(&[flags[0], flags[1], "--coq", &path("certificates", PAPER)]);
        assert!(code == 2 && out.is_empty() && err.contains("--coq goes with no other flag"), "{err}");
    }
}

#[test]
fn coq_accepts_what_is_true() {
    let Some(proofs) = proofs() else { return };
    for name in names("certificates").iter().filter(|_| every_case()) {
        let made = certificate(name);
        assert_accepted(name, coqc(proofs, &name.replace(['.', '-'], "_"), &made));
    }
    if every_case() {
        assert_accepted("gain", coqc(proofs, "gain", &with_a_gain()));
    }
    // Functions of every kind, also where a condition takes them by their names.
    let mut made = certificate("linear.sharp");
    for (bound, function) in [
        ("f_xx", "min(X, 0)"),
        ("f_ex", "max(0, tanh(-E))"),
        ("q_t_rms", "tanh(20)*20 + max(0, E)"),
        ("q_e_max", "min(1/4, tanh(1))"),
    ] {
        made["specification"]["bounds"][bound] = json!(function);
    }
    assert_accepted("functions", coqc(proofs, "functions", &made));
}

#[test]
fn coq_refuses_what_is_not() {
    let Some(proofs) = proofs() else { return };
    let refused = |name: &str, edit: &dyn Fn(&mut Value), said: &str| {
        if !every_case() && name != "altered" {
            return;
        }
        let mut made = certificate(PAPER);
        edit(&mut made);
        let answer = coqc(proofs, name, &made).expect_err(name);
        assert!(answer.contains("not proved") && answer.contains(said), "{name}: {answer}");
    };
    // A per cent below; the conditions of existence fail first.
    refused("lowered", &|made| made["claim"]["sigma_star"] = json!("41.05"), "damped cert");
    refused("altered", &|made| made["specification"]["bounds"]["f_e"] = json!("X + 0.19"), "<= X_p cert");
    refused("size", &|made| made["claim"]["periodic_solution"]["x"] = json!("0.049417"), "x_per cert");
    // No plant has it, and no solution the sizes that would follow.
    refused("negative", &|made| made["specification"]["bounds"]["q_t"] = json!("-20"), "0 <= x_per cert");
    refused("transfer", &|made| made["witness"]["transfer"]["K"] = json!(1), "<= k_1 cert");
    if !every_case() {
        return;
    }
    let mut wider = with_a_gain();
    wider["specification"]["input_gain"]["high"] = json!("2.9");
    let answer = coqc(proofs, "gain_wider", &wider).expect_err("a wider interval");
    assert!(answer.contains("not proved") && answer.contains("level cert"), "{answer}");
}
