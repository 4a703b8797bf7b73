//! The front door beside one claim: stored certificates, bounds of a plant, pairs for samples, triples, better values, simulations, trials.

use crate::support::{EXAMPLE_TEXT, PLANT_TEXT};
use serde_json::Value;
use sigmastar::{
    Certificate, CertifyOptions, Error, ErrorKind, FalsificationOutcome, ReportFormat, SimulationOptions, Study,
    Subject, TuneGoal, TuneOptions, bounding_specification, certify, check, falsify, lyapunov, reread, sampling,
    simulate, tune,
};

const LINEAR: &str = include_str!("../../specs/linear.json");
const LINEAR_PLANT: &str = include_str!("../../specs/plants/linear.json");
const JACOBIAN: &str = include_str!("../../specs/paper-example-jacobian.json");

fn subject(text: &str) -> Subject {
    Subject::from_json(text).unwrap()
}

fn certified(text: &str, options: &CertifyOptions) -> Certificate {
    certify(subject(text), options).unwrap()
}

#[test]
fn a_stored_certificate_is_decided_again_to_what_it_was() {
    let plain = CertifyOptions::new();
    for (text, options) in [
        (LINEAR, plain.clone()),
        (LINEAR, plain.clone().compare(false)),
        (LINEAR, plain.clone().sigma("3").n_o([0, 2])),
        (LINEAR, plain.clone().sampling_period("1/100")),
        (JACOBIAN, plain.clone()),
        (LINEAR_PLANT, plain.clone()),
        (LINEAR_PLANT, plain.clone().n_o([0, 1, 6]).harmonics([0, 2])),
        (PLANT_TEXT, plain.clone().sigma("9")),
    ] {
        let certificate = certified(text, &options);
        let again = reread("certificate", certificate.to_json().as_bytes()).unwrap();
        // But for the repaired derivation, which is beside the claim and not in the witness.
        let claimed = |certificate: &Certificate| {
            let mut made: Value = serde_json::from_str(certificate.to_json()).unwrap();
            made.as_object_mut().unwrap().retain(|name, _| !["comparison", "constants"].contains(&name.as_str()));
            made
        };
        assert_eq!(claimed(&again), claimed(&certificate));
        assert!(check(again.to_json()).is_valid());
        assert_eq!(again.claim(), certificate.claim());
        assert_eq!(again.conditions(), certificate.conditions());
        assert_eq!(again.subject().sha256(), certificate.subject().sha256());
    }
}

#[test]
fn a_stored_certificate_that_was_altered_is_refused() {
    let certificate = certified(EXAMPLE_TEXT, &CertifyOptions::new());
    let altered = |pointer: &str, value: &str| -> ErrorKind {
        let mut document: Value = serde_json::from_str(certificate.to_json()).unwrap();
        *document.pointer_mut(pointer).unwrap() = value.into();
        let text = document.to_string();
        assert!(!check(&text).is_valid(), "{pointer}");
        reread("certificate", text.as_bytes()).unwrap_err().kind()
    };
    for (pointer, value) in [
        ("/claim/sigma_star", "50"),
        ("/claim/periodic_solution/e", "1/10"),
        ("/specification_sha256", "0"),
        // Other data, for which the same witness proves less.
        ("/specification/bounds/q_t", "1"),
    ] {
        assert_eq!(altered(pointer, value), ErrorKind::Claim, "{pointer}");
    }
    // What it says in words is for people, and the claim is what its numbers say.
    let mut worded: Value = serde_json::from_str(certificate.to_json()).unwrap();
    worded["claim"]["statement"] = "Everything is certified.".into();
    let worded = worded.to_string();
    assert_eq!(check(&worded).statement(), check(certificate.to_json()).statement());
    assert_eq!(reread("certificate", worded.as_bytes()).unwrap().claim().statement(), certificate.claim().statement());
    assert_eq!(altered("/claim/sigma_star", "39"), ErrorKind::NotCertified);
    assert_eq!(altered("/claim/initial_set/X0", "1"), ErrorKind::NotCertified);
    assert_eq!(altered("/witness/D_e", "1/1000"), ErrorKind::NotCertified);
    assert_eq!(altered("/witness/D_e", "many"), ErrorKind::Expression);
    let kind = |text: &str| reread("certificate", text.as_bytes()).unwrap_err().kind();
    assert_eq!(
        [kind("{"), kind("[]"), kind("{}"), kind(EXAMPLE_TEXT)].map(|kind| kind == ErrorKind::Claim),
        [false; 4]
    );
}

#[test]
fn the_bounds_of_a_plant_certify() {
    let bounded = bounding_specification(subject(LINEAR_PLANT), None).unwrap();
    let certificate = certified(bounded.to_json(), &CertifyOptions::new());
    assert!(check(certificate.to_json()).is_valid());
    let asked = bounding_specification(subject(LINEAR_PLANT), Some(["1/2", "2"])).unwrap();
    assert_eq!((asked.domain(), asked.is_limited()), (["0.5", "2"], false));
    let kind = |text, domain| bounding_specification(subject(text), domain).unwrap_err().kind();
    assert_eq!(kind(LINEAR, None), ErrorKind::Format);
    assert_eq!(kind(LINEAR_PLANT, Some(["0", "1"])), ErrorKind::Range);
}

fn json(report: &sigmastar::Report) -> Value {
    serde_json::from_str(&report.render(ReportFormat::Json)).unwrap()
}

#[test]
fn triples_orbits_and_pairs_have_the_reports_of_the_program() {
    assert_eq!(json(&lyapunov(subject(JACOBIAN)).unwrap())["format"], "sigmastar/lyapunov");
    assert!(json(&lyapunov(subject(PLANT_TEXT)).unwrap())["orbit"].is_object());
    assert_eq!(lyapunov(subject(LINEAR)).unwrap_err().kind(), ErrorKind::Options);
    let pairs = sampling(subject(LINEAR), Some(&["1/100"]), Some(&["3"])).unwrap();
    let report = json(pairs.report());
    assert!(pairs.has_pair());
    assert_eq!(
        (&report["by_sampling_period"][0]["samples"], &report["by_sigma"][0]["sigma"]),
        (&100.into(), &"3".into())
    );
    let kind = |text: &str, period| sampling(subject(text), Some(&[period]), None).unwrap_err().kind();
    assert_eq!(kind(LINEAR, "3/10"), ErrorKind::Range);
    assert_eq!(kind(&LINEAR.replace("true", "false"), "1/100"), ErrorKind::Options);
}

#[test]
fn better_values_are_those_of_the_program() {
    let tuned = tune(subject(EXAMPLE_TEXT), &TuneOptions::new().over("mu=1/10..10").tries(8)).unwrap();
    let report = json(tuned.report());
    let document = tuned.document().expect("something better");
    assert!(tuned.has_claim());
    // What it is certified with is what the report says.
    let again = certified(document, &CertifyOptions::new());
    assert_eq!(report["after"]["sigma_star"], again.claim().sigma_star());
    assert_eq!(report["parameters"][0]["after"], subject_value(document, "/internal_model/mu"));
    // With a sampling period beside it, it is the document that has it.
    let mut stated: Value = serde_json::from_str(EXAMPLE_TEXT).unwrap();
    stated["internal_model"]["sampling_period"] = "1/500".into();
    let of = |subject: Subject| {
        let tuned = tune(subject, &TuneOptions::new().over("mu=1/10..10").tries(8)).unwrap();
        (json(tuned.report()), tuned.document().map(str::to_owned))
    };
    let beside = of(subject(EXAMPLE_TEXT).at_samples("1/500").unwrap());
    assert_eq!(beside, of(subject(&stated.to_string())));
    assert!(beside.1.is_some_and(|document| document.contains("\"sampling_period\"")));
    let kind = |text: &str, options| tune(subject(text), &options).unwrap_err().kind();
    let options = TuneOptions::new;
    assert_eq!(kind(LINEAR, options().tries(1)), ErrorKind::Range);
    assert_eq!(kind(LINEAR, options().goal(TuneGoal::ErrorAt(u32::MAX))), ErrorKind::Range);
    assert_eq!(kind(LINEAR, options().over("mo")), ErrorKind::Options);
    assert_eq!(kind(&LINEAR.replace("true", "false"), options().goal(TuneGoal::ErrorAt(1))), ErrorKind::Options);
    let sampled = LINEAR.replace("\"matched\"", "\"sampling_period\": \"1/1000\", \"matched\"");
    assert_eq!(kind(&sampled, options().goal(TuneGoal::Feedback)), ErrorKind::Options);
}

fn subject_value(document: &str, pointer: &str) -> Value {
    let document: Value = serde_json::from_str(document).unwrap();
    document.pointer(pointer).unwrap().clone()
}

/// The notation is that of the name, as for the program; without one it is JSON.
#[test]
fn a_file_is_read_in_the_notation_of_its_name() {
    let toml = include_str!("../../src/cli/templates/plant.toml");
    let [json, commented] = ["plant.json", "plant.jsonc"].map(|name| {
        let text = include_str!("../../src/cli/templates/plant.jsonc");
        Subject::from_bytes(name, text.as_bytes()).map(|subject| subject.sha256().to_owned())
    });
    assert_eq!(Subject::from_bytes("a/plant.toml", toml.as_bytes()).unwrap().sha256(), commented.unwrap());
    assert_eq!(json.unwrap_err().kind(), ErrorKind::Document);
    assert!(Subject::from_json(toml).is_err());
    let study = include_str!("../../src/cli/templates/study.toml");
    let study = Study::from_bytes("study.toml", study.as_bytes(), |_| Err(String::new())).unwrap();
    assert_eq!(study.cases(), 6);
}

#[test]
fn simulations_and_trials_say_how_they_end() -> Result<(), Error> {
    let options = SimulationOptions::new("2").periods(2).samples(5);
    for options in [options.clone(), options.clone().n_o(1), options.clone().n_o(1).sampling_period("1/100")] {
        let simulation = simulate(subject(LINEAR_PLANT), &options)?;
        assert!(simulation.is_complete());
        assert!(simulation.csv().is_some_and(|csv| csv.starts_with("t,e,u") && csv.lines().count() > 10));
    }
    let kind = |text, options| simulate(subject(text), &options).unwrap_err().kind();
    assert_eq!(kind(LINEAR, options.clone()), ErrorKind::Format);
    for wrong in [options.clone().n_o(201), options.clone().periods(0), options.clone().samples(100_001)] {
        assert_eq!(kind(LINEAR_PLANT, wrong), ErrorKind::Range);
    }
    assert_eq!(kind(LINEAR_PLANT, options.clone().sampling_period("1/100")), ErrorKind::Options);
    assert_eq!(kind(LINEAR_PLANT, SimulationOptions::new("1e400")), ErrorKind::Overflow);

    let certificate = certified(LINEAR, &CertifyOptions::new()).to_json().to_owned();
    let held = falsify("certificate", certificate.as_bytes(), 3, 1)?;
    assert_eq!((held.outcome(), held.counterexample()), (FalsificationOutcome::Held, None));
    let mut forged: Value = serde_json::from_str(&certificate).unwrap();
    forged["claim"]["periodic_solution"]["z"] = "1e-9".into();
    let broken = falsify("certificate", forged.to_string().as_bytes(), 3, 1)?;
    assert_eq!(broken.outcome(), FalsificationOutcome::Broken);
    // Its start is for the regulator of the trial.
    let error = simulate(subject(broken.counterexample().unwrap()), &options).unwrap_err();
    assert!(error.kind() == ErrorKind::Range && error.to_string().contains("the initial z"));
    assert_eq!(falsify("certificate", certificate.as_bytes(), 0, 1).unwrap_err().kind(), ErrorKind::Range);
    Ok(())
}
