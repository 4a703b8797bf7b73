//! The regulator at samples with an actuator whose gain is known to an interval, and of families of plants (docs/mathematics.md, 12 and
//! 13.1): what is certified, what of a witness is refused, and what trials say.

use super::{gain, text};
use crate::sampled::run;
use crate::support::{
    certified_in, decided_again, document, every, in_one_line, json, number, program, read, tried, utf8,
};
use rug::Rational;
use serde_json::{Value, json as object};
use sigmastar_decide::conditions::Ladder;
use sigmastar_lab::falsify::Finding;
use sigmastar_lang::spec::{Document, Specification};
use sigmastar_prove::certificate::{read_sampled_witness, sampled_certificate_json};
use sigmastar_prove::certify::{SampledCertification, Verdict, recheck_sampled};
use sigmastar_theory::derivation::sampled::SampledWitness;
use std::path::{Path, PathBuf};

/// A shipped specification at so many samples a period of 1, with an input gain or without one.
fn spec(name: &str, samples: u32, gain: Option<Value>) -> Specification {
    let mut file = gain.map_or_else(|| document(name), |gain| shipped(name, &gain));
    file["internal_model"]["sampling_period"] = format!("1/{samples}").into();
    Specification::from_json(name, &file.to_string()).unwrap()
}

fn witness(run: &SampledCertification<'_>) -> SampledWitness {
    run.claim().expect("certified").witness.clone()
}

/// A file certified at samples: the certificate and the report.
fn certified(folder: &Path, file: &Value, step: &str) -> (PathBuf, Value) {
    certified_in(folder, file, &["--sampling-period", step])
}

/// The exit code of a file at such samples, decided again with the witness of a certificate.
fn again(folder: &Path, file: &Value, step: &str, certificate: &Path) -> Option<i32> {
    let mut file = file.clone();
    file["internal_model"]["sampling_period"] = step.into();
    decided_again(folder, &file, certificate).0
}

fn shipped(name: &str, gain: &Value) -> Value {
    json(text(name, gain).as_bytes())
}

/// With the gain known the claim is the one without the field, number by number; what is put out is over the nominal gain.
#[test]
fn a_gain_that_is_known_changes_no_number() {
    let name = "paper-example-rms-at-rest";
    let (plain, known) = (spec(name, 200, None), spec(name, 200, Some(gain("4", "4", "4"))));
    let [plain, known] = [&plain, &known].map(|spec| sampled_certificate_json(&run(spec, None)).unwrap());
    for part in ["witness", "conditions"] {
        assert_eq!(plain[part], known[part], "{part}");
    }
    assert_eq!(known["claim"]["input_gain"], gain("4", "4", "4"));
    for bound in ["steady", "transient"] {
        let [plain, known] = [&plain, &known].map(|file| number(&file["claim"]["control"][bound]));
        assert!((plain / known / 4.0 - 1.0).abs() < 1e-9, "{bound}");
    }
}

/// A wider interval needs a larger gain, and near continuous time nearly that of continuous time.
#[test]
fn an_interval_costs_about_what_it_costs_in_continuous_time() {
    let name = "paper-example-rms-at-rest";
    let mut before = 0.0;
    for (low, high) in [("1", "1"), ("0.95", "1.1"), ("0.8", "1.25"), ("0.5", "2")] {
        let own = spec(name, 400, Some(gain("1", low, high)));
        let sigma = witness(&run(&own, None)).sigma.to_f64();
        assert!(sigma > 1.02 * before, "{low} {high}: {sigma} {before}");
        before = sigma;
    }
    let own = spec(name, 4000, Some(gain("1", "0.8", "1.25")));
    let sigma = witness(&run(&own, None)).sigma.to_f64();
    // 19.63 in continuous time, for every larger gain, with coarser bounds of single harmonics.
    assert!((19.0..19.7).contains(&sigma), "{sigma}");
    // Beyond sqrt(b_hi) < 2 + sqrt(b_lo) there is none.
    let wide = spec(name, 400, Some(gain("1", "1", "9")));
    let run = run(&wide, None);
    assert_eq!(run.verdict, Verdict::Undecided);
    assert!(run.outcome.attempt().is_none());
}

/// Each number of a witness counts, and the interval does.
#[test]
fn a_witness_is_decided_again_and_every_altered_one_is_refused() {
    let own = spec("paper-example-rms-at-rest", 100, Some(gain("1", "0.8", "1.25")));
    let witness = witness(&run(&own, None));
    let verdict = |witness: &SampledWitness| recheck_sampled(&own, witness, Ladder::default()).unwrap().verdict;
    assert_eq!(verdict(&witness), Verdict::Certified);
    let smaller = Rational::from((97, 100));
    type Change = (&'static str, fn(&mut SampledWitness, &Rational));
    let changes: [Change; 12] = [
        ("sigma", |w, less| w.sigma *= less),
        ("K", |w, less| w.law.gain *= less),
        ("Nb2", |w, less| w.law.weight_sum *= less),
        ("X_p", |w, less| w.x_p *= less),
        ("E_p", |w, less| w.e_p *= less),
        ("r_x", |w, less| w.r_x *= less),
        ("r_e", |w, less| w.r_e *= less),
        ("r_d", |w, less| w.r_d *= less),
        ("D_e", |w, less| w.d_e *= less),
        ("eta", |w, less| w.eta /= less),
        ("k0", |w, less| w.k0 *= less),
        ("X_0", |w, less| w.set.x0 *= less),
    ];
    for (name, change) in changes {
        let mut altered = witness.clone();
        change(&mut altered, &smaller);
        assert_eq!(verdict(&altered), Verdict::Refuted, "{name}");
    }
    // Of a wider interval it says nothing: by the first pair the small gain, by the second the large one.
    for (low, high) in [("0.75", "1.25"), ("0.8", "1.35")] {
        let wider = spec("paper-example-rms-at-rest", 100, Some(gain("1", low, high)));
        assert_eq!(recheck_sampled(&wider, &witness, Ladder::default()).unwrap().verdict, Verdict::Refuted, "{low}");
    }
    // b_hi K h Nb2 is above 2, and a denominator vanishes.
    let beyond = spec("paper-example-rms-at-rest", 100, Some(gain("1", "0.8", "50")));
    let run = recheck_sampled(&beyond, &witness, Ladder::default()).unwrap();
    let is_false = |id: &str| run.conditions().iter().any(|one| one.id == id && !one.truth().is_true());
    assert!(run.verdict == Verdict::Refuted && is_false("S0c") && is_false("S0e"));
}

#[test]
fn the_claim_and_the_report_say_so() {
    let folder = tempfile::tempdir().unwrap();
    let file = shipped("no-x", &gain("2", "1.8", "2.5"));
    let (certificate, report) = certified(folder.path(), &file, "1/200");
    assert_eq!(report["input_gain"], gain("2", "1.8", "2.5"));
    assert!(report["statement"].as_str().unwrap().contains("every constant input gain from 1.8 to 2.5"));
    assert!(number(&report["sigma_without_interval_estimates"]["input_gain"]) < number(&report["sigma"]));
    let written = read(&certificate);
    assert_eq!(written["claim"]["input_gain"], gain("2", "1.8", "2.5"));
    let statement = written["claim"]["statement"].as_str().unwrap();
    let expected = "for every number of oscillators n_o < 200/2 and every phase of the sampling grid and every input gain in [1.8, 2.5] (one \
                    constant; the regulator divides its control by the nominal gain 2), with period T = 1, ";
    assert!(statement.contains(expected), "{statement}");
    let input = folder.path().join("input.json");
    let again_by_flag =
        program().args(["certify", "-q", "--no-alternatives", "--witness"]).arg(&certificate).arg(&input).output();
    assert_eq!(again_by_flag.unwrap().status.code(), Some(0));
    let said = utf8(program().arg("certify").arg(&input).args(["--sampling-period", "1/200"]).output().unwrap().stdout);
    let said = in_one_line(&said);
    assert!(
        said.contains(
            "input gain: any constant from 1.8 to 2.5; the regulator divides its control by the nominal gain 2"
        ),
        "{said}"
    );
    assert!(said.contains("if input_gain were known exactly"), "{said}");
    // A claim about another interval than the document's is refused.
    let refused = |change: &dyn Fn(&mut Value)| {
        let mut other = written.clone();
        change(&mut other);
        read_sampled_witness(&Document::parse("certificate", &other.to_string()).unwrap()).unwrap_err().render(false)
    };
    for message in [
        refused(&|file| file["claim"]["input_gain"]["high"] = "3".into()),
        refused(&|file| drop(file["claim"].as_object_mut().unwrap().remove("input_gain"))),
        refused(&|file| drop(file["specification"].as_object_mut().unwrap().remove("input_gain"))),
    ] {
        assert!(message.contains("differ in `input_gain`"), "{message}");
    }
    // The table of gains and sampling periods takes it, too.
    let call = ["--sampling-period", "1/100", "--sigma", "50", "--format", "json", "-q"];
    let table = utf8(program().arg("sampling").arg(&input).args(call).assert().code(0).get_output().stdout.clone());
    assert!(table.contains("certified"), "{table}");
}

/// By the matrix inequalities, from formulas; a witness of a narrow interval is none of a wide one.
#[test]
fn plants_are_certified_for_every_gain_of_the_interval() {
    let folder = tempfile::tempdir().unwrap();
    let file = shipped("plants/motor-axis", &gain("1", "0.9", "1.1"));
    let (certificate, report) = certified(folder.path(), &file, "1/10000");
    let sigma = number(&report["sigma"]);
    // 20.29 for a gain that is known.
    assert!((20.5..22.5).contains(&sigma), "{sigma}");
    let written = read(&certificate);
    assert!(written["witness"].get("matrix_inequality").is_some());
    let of = |gain: &Value| again(folder.path(), &shipped("plants/motor-axis", gain), "1/10000", &certificate);
    assert_eq!(of(&gain("1", "0.9", "1.1")), Some(0));
    assert_eq!(of(&gain("5", "4.5", "5.5")), Some(0));
    assert_ne!(of(&gain("1", "0.6", "1.1")), Some(0));
    assert_ne!(of(&gain("1", "0.9", "1.6")), Some(0));
}

/// A motor axis two constants of which are known to intervals, with an uncertain gain or without one.
fn family(interval: [&str; 2], gain: Option<Value>) -> Value {
    let mut file = document("plants/motor-axis");
    file["f"][0] = "-200*i + c*e + 40*sin(100*pi*t)".into();
    file["q"] = "100*i - d*e - 40*tanh(e) + 2000 + 1500*cos(100*pi*t) + 400*sin(200*pi*t)".into();
    file["parameters"] = object!({
        "c": { "nominal": "150", "low": interval[0], "high": interval[1] },
        "d": { "nominal": "60", "low": "55", "high": "65" },
    });
    if let Some(gain) = gain {
        file["input_gain"] = gain;
    }
    file
}

/// One certificate of a family at samples: the intervals are in the claim, each costs something, and the corners are tried first.
#[test]
#[ignore = "search tier"]
fn families_are_certified_at_samples() {
    let folder = tempfile::tempdir().unwrap();
    let file = family(["145", "155"], Some(gain("2", "1.9", "2.1")));
    let (certificate, report) = certified(folder.path(), &file, "1/10000");
    let sigma = number(&report["sigma"]);
    assert!((20.29..45.0).contains(&sigma), "{sigma}");
    let costs = report["sigma_without_interval_estimates"].as_object().unwrap();
    assert_eq!(costs.keys().collect::<Vec<_>>(), ["input_gain", "c", "d"]);
    assert!(costs.values().all(|cost| number(cost) <= sigma * 1.01), "{costs:?}");
    let written = read(&certificate);
    let statement = written["claim"]["statement"].as_str().unwrap();
    assert!(
        statement
            .contains("every plant of these formulas with a constant 'c' of the file in [145, 155] and a constant 'd' of the file in [55, 65]")
            && statement.contains("sampling grid and every input gain in [1.9, 2.1]"),
        "{statement}"
    );
    assert_eq!(written["claim"]["parameters"]["c"], object!({ "nominal": "150", "low": "145", "high": "155" }));
    // Decided again; of a wider family it is no witness.
    let of = |plant: &Value| again(folder.path(), plant, "1/10000", &certificate);
    assert_eq!(of(&file), Some(0));
    assert_ne!(of(&family(["100", "200"], Some(gain("2", "1.9", "2.1")))), Some(0));
    let trials = program().arg("falsify").arg(&certificate).args(["-q", "--format", "json", "--trials", "9"]).output();
    let trials = json(&trials.unwrap().stdout);
    assert_eq!(trials["refuted"], false);
    let trials = trials["trials"].as_array().unwrap();
    let corner = |trial: &Value| {
        let parameter = |name: &str| trial["parameters"][name].as_str().unwrap().to_owned();
        (trial["input_gain"].as_f64().unwrap(), parameter("c"), parameter("d"))
    };
    let corners: Vec<_> = trials[..8].iter().map(corner).collect();
    for gain in [1.9, 2.1] {
        for c in ["145", "155"] {
            for d in ["55", "65"] {
                assert!(corners.contains(&(gain, c.to_owned(), d.to_owned())), "{corners:?}");
            }
        }
    }
    let (gain, c, _) = corner(&trials[8]);
    assert!(gain > 1.9 && gain < 2.1 && c != "145" && c != "155");
    assert!(trials.iter().all(|trial| trial["finding"] == "holds"), "{trials:#?}");
}

/// Trials of true claims at both ends of the gain and inside, at every number of oscillators; a false claim is contradicted.
#[test]
#[ignore = "search tier"]
fn trials_with_an_uncertain_gain() {
    let cases: Vec<_> = ["paper-example", "paper-example-rms-at-rest", "motor-axis", "linear"]
        .into_iter()
        .flat_map(|name| [50, 200].map(|samples| (name, samples)))
        .flat_map(|(name, samples)| [("0.9", "1.1"), ("0.8", "1.25")].map(|ends| (name, samples, ends)))
        .collect();
    let mut largest = 0.0_f64;
    for (name, samples, (low, high)) in cases.into_iter().skip(2).step_by(every(14)) {
        let mut file = shipped(name, &gain("1", low, high));
        let period = file["period"].as_str().map_or_else(|| file["period"].to_string(), str::to_owned);
        file["internal_model"]["sampling_period"] = format!("({period})/{samples}").into();
        let own = Specification::from_json(name, &file.to_string()).unwrap();
        let run = run(&own, None);
        // So few samples are too few for some.
        let Some(certificate) = sampled_certificate_json(&run) else { continue };
        let outcome = tried(&certificate, 10, 3);
        let mut gains = Vec::new();
        for finding in &outcome.findings {
            match finding {
                Finding::Holds { trial, shares } => {
                    gains.push(trial.input_gain.unwrap());
                    largest = shares.iter().fold(largest, |largest, (_, share)| largest.max(*share));
                }
                Finding::Unfinished(_) => {}
                Finding::Violated(..) => panic!("{name} {samples} {low} {high}: {finding:?}"),
            }
        }
        let ends = [low, high].map(|end| end.parse::<f64>().unwrap());
        assert!(ends.iter().all(|end| gains.contains(end)) && gains.len() > 4, "{name} {samples}: {gains:?}");
        assert!(gains.iter().all(|gain| (ends[0]..=ends[1]).contains(gain)));
        let mut forged = certificate.clone();
        forged["claim"]["periodic_solution"]["zeta"] = "1e-4".into();
        let outcome = tried(&forged, 4, 3);
        assert!(outcome.counterexample().is_some_and(|(trial, _)| trial.input_gain.is_some()), "{name}");
    }
    assert!(largest > 0.05, "{largest}");
}
