//! A regulator that sets z = M e at its first instant: what is certified, what the checker says, and where each export and each
//! simulation starts.

use crate::controller::{array, constant, controller, installed};
use crate::controller_c::gcc;
use crate::sampled;
use crate::support::{
    self, PLANT_TEXT, ROOT, certificate, certified_in, document, json, number, options, program, tried, utf8,
};
use serde_json::{Value, json as object};
use sigmastar_lab::falsify::Finding;
use sigmastar_lab::simulate::ClosedLoop;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::Specification;
use sigmastar_prove::certificate::sampled_certificate_json;
use sigmastar_prove::certify::certify;
use sigmastar_regulator::Design;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A certificate that is stored with the checker.
const STORED: &str = "proofs-check/tests/certificates/paper-example-aligned.sharp.json";

fn stored() -> Value {
    support::read(Path::new(ROOT).join(STORED))
}

/// A shipped specification with another kind of set and another sampling period.
fn read(name: &str, kind: &str, step: Option<&str>) -> Specification {
    let mut document = document(name);
    document["initial_set"] = object!({ "kind": kind });
    if let Some(step) = step {
        document["internal_model"]["sampling_period"] = step.into();
    }
    Specification::from_json(name, &document.to_string()).unwrap()
}

/// The claim has no Z0 and says what the regulator does, and the checker accepts it.
#[track_caller]
fn assert_valid(certificate: &Value) {
    let claim = &certificate["claim"];
    let names: Vec<&String> = claim["initial_set"].as_object().unwrap().keys().collect();
    assert!(!names.contains(&&"Z0".to_owned()) && claim["initial_set"]["kind"] == "aligned", "{names:?}");
    let statement = claim["statement"].as_str().unwrap();
    assert!(statement.contains(", z = M e, at any ") && !statement.contains("sqrt(z'Nz)"), "{statement}");
    let report = proofs_check::check(certificate.to_string().as_bytes());
    assert!(report.is_valid(), "{}", report.text(false));
}

/// What an aligned start is for: a gain that is smaller than the one at rest.
#[test]
fn the_gain_is_below_the_one_at_rest() {
    for (name, most) in [("paper-example-at-rest", 25.9), ("paper-example-rms-at-rest", 13.2)] {
        let (at_rest, aligned) = (read(name, "at-rest", None), read(name, "aligned", None));
        let [rest, start] = [&at_rest, &aligned].map(|spec| certify(spec, options()).unwrap());
        let [of_rest, gain] = [&rest, &start].map(|run| run.sigma_star().unwrap().to_f64());
        assert!(gain <= most && gain < of_rest, "{name}: {gain} {of_rest}");
        // What is said of it where it is not asked for, and that nothing is where it is.
        let estimate = rest.alternatives.aligned.expect("an estimate");
        assert!(
            (estimate / gain - 1.0).abs() < 1e-3 && start.alternatives.aligned.is_none(),
            "{name}: {estimate} {gain}"
        );
        assert_valid(&certificate(&aligned));
    }
}

/// The same at samples, whose level condition has the same dZ.
#[test]
fn the_gain_at_samples_is_no_larger_than_the_one_at_rest() {
    let certified = |kind: &str| {
        let spec = read("paper-example-rms-at-rest", kind, Some("1/500"));
        let run = sampled::run(&spec, None);
        (run.claim().expect("it certifies").witness.sigma.to_f64(), sampled_certificate_json(&run).unwrap())
    };
    let ((of_rest, _), (gain, certificate)) = (certified("at-rest"), certified("aligned"));
    assert!(gain <= of_rest, "{gain} {of_rest}");
    assert_valid(&certificate);
}

fn aligned_plant() -> Value {
    let mut plant: Value = serde_json::from_str(PLANT_TEXT).unwrap();
    plant["initial_set"] = object!({ "kind": "aligned" });
    plant
}

/// What is said of a plant by a matrix inequality: an aligned start is estimated closely, norms from above the gain; and of the aligned
/// plant itself nothing of a start.
#[test]
fn a_report_says_what_else_a_plant_could_have() {
    let folder = tempfile::tempdir().unwrap();
    let report = |kind: &str| {
        let mut plant = document("plants/paper-example");
        plant["initial_set"] = object!({ "kind": kind });
        certified_in(folder.path(), &plant, &[]).1
    };
    let [rest, aligned] = ["at-rest", "aligned"].map(report);
    let [of_rest, gain] = [&rest, &aligned].map(|report| number(&report["sigma_star"]));
    let estimate = number(&rest["sigma_star_aligned_estimate"]);
    assert!((estimate / gain - 1.0).abs() < 0.02 && gain < of_rest, "{estimate} {gain} {of_rest}");
    assert_eq!(aligned["sigma_star_aligned_estimate"], Value::Null);
    for (report, gain) in [(&rest, of_rest), (&aligned, gain)] {
        let by_norms = number(&report["sigma_star_by_norms_estimate"]);
        assert!(by_norms > 1.05 * gain && by_norms < 2.0 * gain, "{by_norms} {gain}");
    }
}

/// By its formulas, with the bounds proved where both paths take them.
#[test]
fn a_plant_is_certified_and_checked() {
    let folder = tempfile::tempdir().unwrap();
    let certificate = support::read(certified_in(folder.path(), &aligned_plant(), &[]).0);
    let gain = number(&certificate["claim"]["sigma_star"]);
    assert!(gain <= 7.6, "{gain}");
    assert_valid(&certificate);
}

/// zeta = z - M e is 0 at the start of a simulation; at rest it is -M e.
#[test]
fn a_simulation_starts_aligned() {
    let start = |plant: &Value| {
        let plant = Plant::from_json("plant", &plant.to_string()).unwrap();
        let regulator = Design::new(&plant.internal_model, &constant("7"), 2).regulator();
        let closed_loop = ClosedLoop::new(&plant, regulator);
        closed_loop.start_of(&plant.initial).unwrap()
    };
    assert_eq!(start(&aligned_plant()), [1.0, -2.0, 4.0, 4.0, 4.0, 0.0, 4.0, 0.0]);
    let at_rest: Value = serde_json::from_str(PLANT_TEXT).unwrap();
    assert_eq!(start(&at_rest), [1.0, -2.0, 4.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    // And from the command line.
    let folder = tempfile::tempdir().unwrap();
    let (plant, run) = (folder.path().join("plant.json"), folder.path().join("run.csv"));
    std::fs::write(&plant, aligned_plant().to_string()).unwrap();
    for at_samples in [&[][..], &["--sampled", "1/100"]] {
        let call = ["--sigma", "7", "--n-o", "2", "--periods", "1", "--quiet", "--force", "--csv"];
        program().arg("simulate").arg(&plant).args(call).arg(&run).args(at_samples).assert().success();
        let csv = std::fs::read_to_string(&run).unwrap();
        let row: Vec<f64> = csv.lines().nth(1).unwrap().split(',').map(|cell| cell.parse().unwrap()).collect();
        // t, x, e, u, z.
        assert_eq!(row, [0.0, 1.0, -2.0, 4.0, -28.0, 4.0, 4.0, 0.0, 4.0, 0.0], "{at_samples:?}");
    }
}

/// The C code of the stored certificate, with a program that resets it with each error of a list, steps twice with it, and writes
/// the bits of both controls.
fn exported(folder: &Path, n_o: u32, errors: &[f64]) -> PathBuf {
    let (source, main) = (folder.join("law.c"), folder.join("main.c"));
    let n_o = n_o.to_string();
    let call = [STORED, "--n-o", &n_o, "--discretise", "1/500", "--format", "c", "--example", "--force", "-o"];
    controller(&call).arg(&source).assert().success();
    let inputs: Vec<String> = errors.iter().map(|e| format!("0x{:016x}ULL", e.to_bits())).collect();
    let text = format!(
        "#include \"law.h\"\n#include <stdio.h>\n#include <string.h>\n\
         static const unsigned long long inputs[] = {{ {} }};\n\
         static void put(double value) {{ unsigned long long bits; memcpy(&bits, &value, 8); printf(\"%llx\\n\", bits); }}\n\
         int main(void) {{ sigmastar_controller c; unsigned i;\n\
         for (i = 0; i < {}; i++) {{ double e; memcpy(&e, &inputs[i], 8); sigmastar_reset(&c, e);\n\
         put(sigmastar_step(&c, e)); put(sigmastar_step(&c, e)); }} return 0; }}\n",
        inputs.join(", "),
        errors.len()
    );
    std::fs::write(&main, text).unwrap();
    let binary = folder.join("law");
    for other in [&folder.join("law_example.c"), &main] {
        gcc(&[&source, other], &binary);
    }
    binary
}

/// With zeta = 0 the first control is -sigma e, to the last bit and whatever was in the state before; the second one is not.
#[test]
fn exported_c_starts_aligned() {
    if !installed("gcc", &["--version"]) {
        return;
    }
    let claim = stored()["claim"]["sigma_star"].as_str().unwrap().to_owned();
    let sigma = sigmastar_exact::number::parse_decimal(&claim).unwrap();
    let errors = [1.0, -0.3, 1e-300, 7.3e11, -1.0 / 3.0];
    for n_o in [0, 1, 7] {
        let folder = tempfile::tempdir().unwrap();
        let output = Command::new(exported(folder.path(), n_o, &errors)).output().unwrap();
        let words = utf8(output.stdout);
        let controls: Vec<f64> =
            words.lines().map(|word| f64::from_bits(u64::from_str_radix(word, 16).unwrap())).collect();
        assert_eq!(controls.len(), 2 * errors.len());
        for (pair, e) in controls.chunks(2).zip(errors) {
            // The gain of the export is sigma*, or the next double above it.
            let gain = -controls[0];
            assert!(rug::Rational::from_f64(gain).unwrap() >= sigma && gain < sigma.to_f64() * (1.0 + 1e-15));
            assert_eq!(pair[0].to_bits(), (-gain * e).to_bits(), "n_o = {n_o}, e = {e}");
            assert_ne!(pair[0], pair[1], "n_o = {n_o}, e = {e}");
        }
    }
}

/// Every other form says how to start, and one at rest says the other thing.
#[test]
fn every_export_says_the_start() {
    let folder = tempfile::tempdir().unwrap();
    let words = "The initial set is `aligned`: start with z = M e, where e is the error at the first instant.";
    for (file, sigma, is_aligned) in [(STORED, None, true), ("specs/linear.json", Some("2"), false)] {
        let export = |format: &str, file_out: &Path| {
            let mut call = controller(&[file, "--n-o", "1", "--format", format, "--force", "-o"]);
            call.arg(file_out);
            if let Some(sigma) = sigma {
                call.args(["--sigma", sigma]);
            }
            call.assert().success();
        };
        let at = |name: &str| folder.path().join(name);
        export("json", &at("law.json"));
        let law = json(&std::fs::read(at("law.json")).unwrap());
        assert_eq!(law["start"], if is_aligned { "z = M e" } else { "z = 0" });
        export("matlab", &at("law.m"));
        let script = std::fs::read_to_string(at("law.m")).unwrap();
        let start = if is_aligned { "\nz_start = @(e) M*e;\n" } else { "\nz_start = @(e) 0*M;\n" };
        let comments: Vec<&str> = script.lines().filter_map(|line| line.strip_prefix('%')).map(str::trim).collect();
        assert!(script.contains(start), "{script}");
        assert_eq!(comments.join(" ").contains(words), is_aligned, "{script}");
        export("npz", &at("law.npz"));
        assert_eq!(array(&at("law.npz"), "aligned"), ("|b1".to_owned(), String::new(), vec![u8::from(is_aligned)]));
        assert_eq!(utf8(array(&at("law.npz"), "notice").2).contains(words), is_aligned);
    }
    // What is exported is read again.
    let plant = folder.path().join("plant.json");
    std::fs::write(&plant, aligned_plant().to_string()).unwrap();
    let law = folder.path().join("law.json");
    controller(&[STORED, "--n-o", "1", "--force", "-o"]).arg(&law).assert().success();
    let simulate = |law: &Path| {
        program().arg("simulate").arg(&plant).arg("--controller").arg(law).args(["--periods", "1", "--quiet"]).assert()
    };
    simulate(&law).success();
}

/// Where dq/de grows beyond all gains with |x|, q is split over e first, with dq/de at the periodic solution's |x|; no other path
/// of q proves the claim.
#[test]
fn a_slope_that_grows_with_x_is_taken_along_the_other_path() {
    let mut document = document("linear");
    document["bounds"]["q_e"] = "exp(exp(X))".into();
    document["initial_set"] = object!({ "kind": "box", "X0": "10", "E0": "1", "Z0": "0" });
    let made = certificate(&Specification::from_json("steep", &document.to_string()).unwrap());
    let check = |certificate: &Value| proofs_check::check(certificate.to_string().as_bytes());
    assert_eq!(made["witness"]["paths"]["q"], "e-first");
    assert!(check(&made).is_valid(), "{}", check(&made).text(false));
    for path in ["x-first", "straight"] {
        let mut other = made.clone();
        other["witness"]["paths"]["q"] = path.into();
        let report = check(&other);
        assert!(report.finding.is_some_and(|finding| finding.message.contains("C5")), "{path}");
    }
}

/// Plants within the bounds, from the boundary of the set, where zeta is 0: nothing contradicts the claim.
#[test]
fn no_trial_contradicts_an_aligned_claim() {
    let outcome = tried(&stored(), 6, 3);
    assert_eq!(outcome.findings.len(), 6);
    for finding in &outcome.findings {
        let Finding::Holds { trial, .. } = finding else { panic!("{finding:?}") };
        let (e, z) = trial.start[trial.plant.names().len()..].split_first().unwrap();
        assert!((e.abs() / 0.50092652 - 1.0).abs() < 1e-12, "{e}");
        let m = (0..z.len()).map(|i| if i == 0 || i % 2 == 1 { *e } else { 0.0 });
        assert!(z.len() == 2 * trial.oscillators.count() + 1 && z.iter().copied().eq(m), "{e} {z:?}");
    }
}
