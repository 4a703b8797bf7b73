//! `falsify` on certificates of the law at samples: true ones hold at every n_o and phase that is tried, forged ones do not.

use crate::support::{EXAMPLE_TEXT, every, json, number, program, read, stored, tried};
use serde_json::Value;
use sigmastar_decide::conditions::Ladder;
use sigmastar_lab::falsify::Finding;
use sigmastar_lang::spec::Specification;
use sigmastar_prove::certificate::sampled_certificate_json;
use sigmastar_prove::certify::certify_sampled;
use std::sync::LazyLock;

/// The samples of a period of the certificate, which the paper's example has at this gain.
pub const SAMPLES: u32 = 200;
const SIGMA: u32 = 75;

/// The certificate of the paper's example for the law at samples.
pub static CERTIFICATE: LazyLock<Value> = LazyLock::new(|| certified(|_| ()));

/// The same for the law with a delay.
pub static DELAYED: LazyLock<Value> =
    LazyLock::new(|| certified(|document| document["internal_model"]["delay_samples"] = 1.into()));

pub fn certified(change: impl FnOnce(&mut Value)) -> Value {
    let mut document: Value = serde_json::from_str(EXAMPLE_TEXT).unwrap();
    document["internal_model"]["sampling_period"] = format!("1/{SAMPLES}").into();
    change(&mut document);
    let spec = Specification::from_json("example", &document.to_string()).unwrap();
    let sampling = spec.internal_model.sampling.clone().unwrap();
    let run = certify_sampled(&spec, &sampling, Some(&SIGMA.into()), None, Ladder::default()).unwrap();
    sampled_certificate_json(&run).expect("certified")
}

#[test]
fn a_true_claim_holds() {
    let outcome = tried(&CERTIFICATE, 8, 1);
    let (mut tried_n_o, mut phases) = (Vec::new(), Vec::new());
    for finding in &outcome.findings {
        let Finding::Holds { trial, shares } = finding else { panic!("{finding:?}") };
        assert_eq!(trial.sigma, f64::from(SIGMA));
        assert!((0.0..1.0).contains(&trial.phase.unwrap()));
        tried_n_o.push(trial.oscillators.n_o().unwrap());
        phases.push(trial.phase.unwrap());
        // Convergence, four sizes of the periodic solution, two of the box, two of the control, and the Lyapunov function.
        assert_eq!(shares.len(), 10);
        let used = |quantity: &str| shares.iter().find(|(name, _)| name.contains(quantity)).unwrap().1;
        assert!(
            used("sup|zeta|_N") > 1e-3
                && used("sup|e|") > 1e-5
                && used("against $`D_e`$") > 0.01
                && used("|u - u_p|") > 0.01,
            "{shares:?}"
        );
    }
    assert_eq!(tried_n_o[..8], [0, 99, 1, 2, 3, 5, 8, 49]);
    assert!(phases[0] == 0.0 && phases.windows(2).all(|pair| pair[0] != pair[1]), "{phases:?}");
}

/// One number of the certificate replaced by that times a factor.
pub fn forged(certificate: &Value, pointer: &str, factor: f64) -> Value {
    let mut certificate = certificate.clone();
    let value = certificate.pointer_mut(pointer).unwrap_or_else(|| panic!("{pointer}"));
    *value = format!("{:?}", number(value) * factor).into();
    certificate
}

#[test]
fn a_forged_claim_is_contradicted() {
    for (pointer, factor, quantity, trials) in [
        ("/claim/sigma", 0.02, "", 4),
        ("/claim/initial_set/E0", 40.0, "against $`D_e`$", 4),
        ("/claim/initial_set/X0", 40.0, "against $`D_x`$", 4),
        ("/claim/periodic_solution/x", 0.01, "sup|x|", 4),
        ("/claim/periodic_solution/e", 0.01, "sup|e|", 4),
        ("/claim/periodic_solution/zeta", 0.01, "sup|zeta|_N", 4),
        ("/claim/periodic_solution/z", 0.01, "sup|z|_N", 4),
        ("/claim/control/steady", 0.01, "sup|u|", 4),
        ("/claim/control/transient", 0.01, "|u - u_p|", 4),
        ("/witness/D_e", 0.03, "against $`D_e`$", 4),
        ("/witness/D_x", 0.03, "against $`D_x`$", 4),
        // A gain K of the wrong sign feeds the oscillators.
        ("/claim/gain", -5.0, "", 4),
    ]
    .into_iter()
    .step_by(every(4))
    {
        let outcome = tried(&forged(&CERTIFICATE, pointer, factor), trials, 1);
        let Some((trial, violation)) = outcome.counterexample() else {
            panic!(
                "{pointer}: {:?}",
                outcome.closest().iter().map(|closest| (closest.quantity, closest.share)).collect::<Vec<_>>()
            )
        };
        assert!(violation.quantity.contains(quantity), "{pointer}: {violation:?}");
        assert!(violation.found > violation.bound && trial.phase.is_some(), "{pointer}: {violation:?}");
    }
}

#[test]
fn a_certificate_whose_samples_are_no_period_is_not_tried() {
    let mut certificate = CERTIFICATE.clone();
    certificate["claim"]["samples"] = 150.into();
    let outcome = tried(&certificate, 2, 1);
    assert!(outcome.findings.iter().all(|finding| matches!(finding, Finding::Unfinished(_))), "{:?}", outcome.findings);
}

/// The command, with the report, the plant of a trial, and the `simulate` call in it.
#[test]
fn the_command_reports_and_writes_the_plant() {
    let folder = tempfile::tempdir().unwrap();
    let (file, plant) = (stored(folder.path(), "certificate.json", &CERTIFICATE), folder.path().join("plant.json"));
    let call = || {
        let mut call = program();
        call.arg("falsify").arg(&file).args(["-q", "--format", "json"]);
        call
    };
    let report = json(&call().args(["--trials", "2"]).assert().code(0).get_output().stdout);
    assert_eq!((&report["sigma"], &report["sampled"]["samples"]), (&Value::from(75.0), &SAMPLES.into()));
    assert!(report.get("sigma_star").is_none() && report["trials"][1]["phase"].as_f64().unwrap() > 0.0);
    assert!(report["worst"]["phase"].is_number());
    call().args(["--trial", "2", "-o"]).arg(&plant).assert().code(0);
    let written = read(&plant);
    let description = written["description"].as_str().unwrap();
    let flags = description.strip_prefix("Simulate it with ").unwrap().trim_end_matches('.').replace('"', "");
    assert!(flags.starts_with("--sigma 75.0 --n-o 99 --sampled 0.005 --phase 0."), "{flags}");
    let simulated = program().arg("simulate").arg(&plant).args(flags.split(' ')).args(["--periods", "2"]).assert();
    simulated.code(0).stdout(predicates::str::contains("it attracts its neighbours"));
    call().args(["--base-frequency", "3*pi"]).assert().code(2);
    // A forged one: exit code 1 and a counterexample.
    std::fs::write(&file, forged(&CERTIFICATE, "/claim/initial_set/E0", 40.0).to_string()).unwrap();
    let report =
        json(&call().args(["--trials", "2", "--force", "-o"]).arg(&plant).assert().code(1).get_output().stdout);
    assert_eq!(report["refuted"], true);
    assert!(std::fs::read_to_string(&plant).unwrap().contains("Counterexample: |e - e_p|"));
}
