//! The regulator at samples, end to end: reading, certifying, the certificate and what reads it, the table, the export.

use crate::support::{files, in_one_line, json, number, program, read, stem, utf8};
use rug::Rational;
use serde_json::{Value, json as object};
use sigmastar_decide::conditions::Ladder;
use sigmastar_exact::number::{Direction, parse_decimal, round_rational, write_exact};
use sigmastar_lang::spec::{Document, ErrorKind, Sampling, Specification};
use sigmastar_prove::certificate::{StatedClaim, is_sampled, read_claim, read_witness, sampled_certificate_json};
use sigmastar_prove::certify::{
    Options, SampledCertification, Verdict, Wanted, certify, certify_for, certify_sampled, recheck_sampled, with_triple,
};
use sigmastar_prove::reduction::FreeNumbers;
use sigmastar_theory::derivation::condition::Condition;
use sigmastar_theory::derivation::sampled::SampledWitness;

const AT_REST: &str = "specs/paper-example-rms-at-rest.json";
const AT_REST_TEXT: &str = include_str!("../../specs/paper-example-rms-at-rest.json");

/// The specification with a field of the internal model changed.
fn document(field: &str, value: Value) -> String {
    let mut document: Value = serde_json::from_str(AT_REST_TEXT).unwrap();
    document["internal_model"][field] = value;
    document.to_string()
}

/// The witness of a certificate about the regulator at samples.
pub fn at_samples(stated: &StatedClaim) -> &SampledWitness {
    match &stated.witness {
        FreeNumbers::Sampled(witness) => witness,
        FreeNumbers::Continuous(_) => panic!("about the regulator in continuous time"),
    }
}

fn sampled(step: &str) -> Specification {
    Specification::from_json("sampled", &document("sampling_period", step.into())).unwrap()
}

/// The run at the samples of a specification, at a gain or at the smallest.
pub fn run<'s>(spec: &'s Specification, gain: Option<&str>) -> SampledCertification<'s> {
    let sampling = spec.internal_model.sampling.clone().unwrap();
    let gain = gain.map(|gain| parse_decimal(gain).unwrap());
    certify_sampled(spec, &sampling, gain.as_ref(), None, Ladder::default()).unwrap()
}

#[test]
fn sampling_periods_that_do_not_fit_are_refused_at_their_place() {
    let refused = |step: &str, kind: ErrorKind, word: &str| {
        let errors = Specification::from_json("x", &document("sampling_period", step.into())).unwrap_err();
        let error = &errors.errors()[0];
        assert_eq!((error.kind, error.pointer.as_str()), (kind, "/internal_model/sampling_period"), "{step}: {errors}");
        assert!(errors.to_string().contains(word), "{step}: {errors}");
    };
    refused("3/1000", ErrorKind::Range, "not a whole number");
    refused("1/2.5", ErrorKind::Range, "2.5");
    refused("1", ErrorKind::Range, "is 1");
    refused("2", ErrorKind::Range, "not a whole number");
    refused("1/65537", ErrorKind::Range, "65537");
    refused("0", ErrorKind::Range, "positive");
    refused("pi/1000", ErrorKind::Range, "not a whole number");
    refused("exp(1)/1000", ErrorKind::Range, "not a whole number");
    refused("exp(log(1/1000))", ErrorKind::Undecided, "not known exactly");
    for step in ["1/2", "1/65536", "0.001", "sqrt(4)/4"] {
        assert!(sampled(step).internal_model.sampling.is_some_and(|sampling| sampling.samples >= 2), "{step}");
    }
    let mut unmatched: Value = serde_json::from_str(AT_REST_TEXT).unwrap();
    unmatched["internal_model"]["matched"] = false.into();
    unmatched["internal_model"]["sampling_period"] = "1/100".into();
    let errors = Specification::from_json("x", &unmatched.to_string()).unwrap_err();
    assert_eq!(errors.errors()[0].kind, ErrorKind::Matched, "{errors}");
}

#[test]
fn an_irrational_period_has_samples_too() {
    let mut document: Value = serde_json::from_str(AT_REST_TEXT).unwrap();
    (document["period"], document["internal_model"]["base_frequency"]) = ("2*pi".into(), "1".into());
    document["internal_model"]["sampling_period"] = "pi/400".into();
    let spec = Specification::from_json("x", &document.to_string()).unwrap();
    let run = run(&spec, None);
    assert_eq!((run.sampling.samples, run.verdict), (800, Verdict::Certified));
    let certificate = sampled_certificate_json(&run).unwrap();
    assert_eq!(certificate["claim"]["sampling_period"], object!("pi/400"));
    let certificate = Document::parse("certificate", &certificate.to_string()).unwrap();
    assert_eq!(at_samples(&read_claim(&certificate).unwrap()).sampling.samples, 800);
}

#[test]
fn the_gain_tends_to_that_of_continuous_time() {
    let plain = Specification::from_json("plain", AT_REST_TEXT).unwrap();
    let continuous = certify(&plain, Options { compare: false, ..Options::default() }).unwrap();
    let continuous = continuous.sigma_star().unwrap().to_f64();
    // Up to 8192 samples the gains of the law are summed one by one; beyond, coarser sums add a share of their own.
    let excess = [200, 1400, 8192].map(|samples| {
        let spec = sampled(&format!("1/{samples}"));
        let run = run(&spec, None);
        let sigma = run.claim().expect("it certifies").witness.sigma.to_f64();
        sigma / continuous - 1.0
    });
    assert!(excess[0] > 1e-4 && excess[0] < 0.02, "{excess:?}");
    // Of the order of h: seven and nearly six times less, to a factor.
    for pair in excess.windows(2) {
        assert!(pair[1] > 0.0 && pair[1] < pair[0] / 5.0, "{excess:?}");
    }
}

#[test]
fn too_large_a_gain_for_the_samples_is_not_certified() {
    let spec = sampled("1/22");
    assert_eq!(run(&spec, Some("21.75")).verdict, Verdict::Certified);
    // Too small for the plant, and too large for the samples: nothing is monotone.
    for gain in ["1", "15", "22.0001", "1000"] {
        let run = run(&spec, Some(gain));
        assert_eq!(run.verdict, Verdict::Undecided, "{gain}");
        assert!(run.claim().is_none() && sampled_certificate_json(&run).is_none());
    }
}

#[test]
fn a_witness_is_decided_again_and_every_altered_one_is_refused() {
    let spec = sampled("1/100");
    let proved = run(&spec, Some("22"));
    let witness = proved.claim().unwrap().witness.clone();
    let verdict = |witness: &SampledWitness| recheck_sampled(&spec, witness, Ladder::default()).unwrap().verdict;
    assert_eq!(verdict(&witness), Verdict::Certified);
    type Change = (&'static str, fn(&mut SampledWitness));
    let changes: [Change; 17] = [
        ("sigma", |w| w.sigma *= Rational::from((1, 2))),
        ("sigma above 1/h", |w| w.sigma = Rational::from(101)),
        ("K", |w| w.law.gain *= Rational::from((101, 100))),
        ("K smaller", |w| w.law.gain *= Rational::from((99, 100))),
        ("Nb2", |w| w.law.weight_sum *= Rational::from((99, 100))),
        ("X_p", |w| w.x_p *= Rational::from((9, 10))),
        ("E_p", |w| w.e_p *= Rational::from((9, 10))),
        ("r_x", |w| w.r_x *= Rational::from((9, 10))),
        ("r_e", |w| w.r_e *= Rational::from((9, 10))),
        ("r_d", |w| w.r_d *= Rational::from((9, 10))),
        ("D_x", |w| w.d_x *= Rational::from((9, 10))),
        ("D_e", |w| w.d_e *= Rational::from((9, 10))),
        ("w_x", |w| w.w_x *= Rational::from((11, 10))),
        ("eta", |w| w.eta *= Rational::from((11, 10))),
        ("k0", |w| w.k0 *= Rational::from((9, 10))),
        ("k1", |w| w.k1 = Rational::from(-1)),
        ("X_0", |w| w.set.x0 *= Rational::from((9, 10))),
    ];
    for (name, change) in changes {
        let mut altered = witness.clone();
        change(&mut altered);
        assert_eq!(verdict(&altered), Verdict::Refuted, "{name}");
    }
}

/// A larger sum makes theta larger, and so K smaller for the same mu: another law than the one that is asked for.
#[test]
fn a_sum_of_the_weights_that_is_too_large_is_refused_with_the_gain_that_fits_it() {
    let spec = sampled("1/100");
    let proved = run(&spec, Some("22"));
    let mut witness = proved.claim().unwrap().witness.clone();
    let sum = witness.law.weight_sum.clone();
    let mut refused = |factor: (u32, u32)| {
        witness.law.weight_sum = &sum * Rational::from(factor);
        // mu = 1 and h = 1/100: K = mu/(1 + mu h Nb2/2).
        witness.law.gain = Rational::from(200) / (&witness.law.weight_sum + Rational::from(200));
        let run = recheck_sampled(&spec, &witness, Ladder::default()).unwrap();
        let of_the_law = |condition: &&Condition| condition.id.starts_with("S0") && !condition.truth().is_true();
        run.conditions().iter().filter(of_the_law).map(|condition| condition.what.clone()).collect::<Vec<_>>()
    };
    assert!(refused((10_000_009, 10_000_000)).is_empty());
    let too_large = ["weight_sum <= Nbar^2 (1 + 1/10^6)"];
    assert_eq!(refused((10_000_011, 10_000_000)), too_large);
    assert_eq!(refused((101, 100)), too_large);
}

/// The smallest gain is that of the form at the end of a sample; the one at its start, which continuous time has too, has room.
#[test]
fn the_form_at_the_end_of_a_sample_is_decided_by_itself() {
    let spec = sampled("1/100");
    let mut witness = run(&spec, None).claim().unwrap().witness.clone();
    witness.sigma *= Rational::from((999, 1000));
    let run = recheck_sampled(&spec, &witness, Ladder::default()).unwrap();
    let failing = |form: &str| {
        let of_the_form = run.conditions().iter().filter(|condition| condition.what.ends_with(form));
        of_the_form.map(|condition| condition.truth()).collect::<Vec<_>>()
    };
    assert!(failing("of Q_0").iter().all(|truth| truth.is_true()) && failing("of Q_0").len() == 3);
    assert!(failing("of Q_h").iter().any(|truth| truth.is_false()) && failing("of Q_h").len() == 3);
}

/// Beyond h k_e = pi the square of h k_e/(1 - h k_e/pi) falls again: the forms alone would not see it.
#[test]
fn damping_that_is_too_fast_for_the_samples_is_refused() {
    let witness = run(&sampled("1/100"), Some("22")).claim().unwrap().witness.clone();
    let of_the_motion = |q_e: &str| {
        let mut document: Value = serde_json::from_str(&document("sampling_period", "1/100".into())).unwrap();
        document["bounds"]["q_e"] = q_e.into();
        document["bounds"]["q_e_max"] = "0".into();
        let spec = Specification::from_json("damped", &document.to_string()).unwrap();
        let run = recheck_sampled(&spec, &witness, Ladder::default()).unwrap();
        let found: Vec<Condition> =
            run.conditions().iter().filter(|condition| condition.what == "0 < 1 - h k_e/pi").cloned().collect();
        assert_eq!(found.len(), 1, "{q_e}");
        found[0].truth()
    };
    assert!(of_the_motion("314").is_true() && of_the_motion("315").is_false() && of_the_motion("5000").is_false());
}

#[test]
fn a_certificate_is_read_back_as_it_was_written() {
    let spec = sampled("1/200");
    let run = run(&spec, Some("25"));
    let file = sampled_certificate_json(&run).unwrap();
    let document = Document::parse("certificate", &file.to_string()).unwrap();
    assert!(is_sampled(&document));
    let stated = read_claim(&document).unwrap();
    let read = at_samples(&stated);
    let witness = &run.claim().unwrap().witness;
    assert_eq!((&read.sigma, &read.law, &read.set), (&witness.sigma, &witness.law, &witness.set));
    assert_eq!((&read.x_p, &read.eta, &read.k1), (&witness.x_p, &witness.eta, &witness.k1));
    assert!(stated.periodic.iter().all(|bound| *bound > 0.0 && bound.is_finite()));
    let again = recheck_sampled(&spec, read, Ladder::default()).unwrap();
    assert_eq!(sampled_certificate_json(&again).unwrap(), file);
    // What is about continuous time refuses it, at its place.
    let errors = read_witness(&document).unwrap_err();
    assert_eq!(errors.errors()[0].pointer, "/claim/regulator", "{errors}");
    // K is the double that is exported.
    assert_eq!(spec.internal_model.sampled_gain(&witness.sampling.step).as_ref(), Some(&witness.law));
    assert_eq!(Rational::from_f64(witness.law.gain.to_f64()).as_ref(), Some(&witness.law.gain));
}

#[test]
fn other_words_and_fields_in_a_certificate_are_errors() {
    let spec = sampled("1/100");
    let file = sampled_certificate_json(&run(&spec, Some("22"))).unwrap();
    let errors = |pointer: &str, name: &str, value: Value| {
        let mut file = file.clone();
        file.pointer_mut(pointer).unwrap()[name] = value;
        let document = Document::parse("certificate", &file.to_string()).unwrap();
        read_claim(&document).map(drop).unwrap_err().errors()[0].pointer.clone()
    };
    assert_eq!(errors("/claim", "regulator", "analogue".into()), "/claim/regulator");
    assert_eq!(errors("/claim", "derivation", "repaired".into()), "/claim/derivation");
    assert_eq!(errors("/claim", "sigma_star", "22".into()), "/claim/sigma_star");
    assert_eq!(errors("/claim", "sigma", "pi".into()), "/claim/sigma");
    assert_eq!(errors("/claim", "samples", object!(1.5)), "/claim/samples");
    assert_eq!(errors("/witness/transfer", "proof", "matched".into()), "/witness/transfer/proof");
    assert_eq!(errors("/witness", "kap", "0".into()), "/witness/kap");
    assert_eq!(errors("", "constants", object!({})), "/constants");
}

#[test]
fn a_given_gain_is_certified_or_not_at_all() {
    let spec = Specification::from_json("plain", AT_REST_TEXT).unwrap();
    let options = Options { compare: false, ..Options::default() };
    let at = |gain: &str| {
        let gain = gain.parse().unwrap();
        certify_for(&spec, options, Wanted { gain: Some(&gain), ..Wanted::default() }).unwrap()
    };
    let run = at("25");
    assert_eq!(run.sigma_star().unwrap(), &Rational::from(25));
    let margin = run.conditions().iter().find(|condition| condition.id == "C5b").unwrap().relative_margin();
    // The box with which e goes the least far takes what the gain leaves.
    assert!(margin > 0.0 && margin < 0.9, "{margin}");
    assert!(run.given_gain.is_some() && run.sensitivities.is_empty() && run.binding.is_none());
    assert_eq!(at("69/5").verdict, Verdict::Undecided);
    assert_eq!(at("1000000").verdict, Verdict::Certified);
}

#[test]
fn the_program_certifies_checks_its_file_and_exports_the_law() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let certificate = path("axis.json");
    let report = program()
        .args(["certify", AT_REST, "--sampling-period", "1/1000", "--sigma", "25", "--format", "json", "-q", "-o"])
        .arg(&certificate)
        .assert()
        .code(0);
    let report = json(&report.get_output().stdout);
    assert_eq!(
        (&report["regulator"], &report["sigma"], &report["samples"]),
        (&object!("digital"), &object!("25"), &object!(1000))
    );
    assert!(report["statement"].as_str().unwrap().contains("every phase of the samples"));
    assert!(report.get("sigma_star").is_none());
    // The witness is of a specification with this sampling period; another one is refused.
    let again = |arguments: &[&str], code: i32| {
        let output = program()
            .args(["certify", AT_REST, "-q", "--full", "--witness", &certificate])
            .args(arguments)
            .assert()
            .code(code);
        utf8(output.get_output().stdout.clone())
    };
    assert!(again(&[], 0).contains("with sigma = 25 and"));
    again(&["--sampling-period", "1/500"], 2);
    let refused = |arguments: &[&str], told: &str| {
        let assert = program().args(["certify", "-q"]).args(arguments).assert().code(2);
        let said = utf8(assert.get_output().stderr.clone());
        assert!(said.contains(told), "{said}");
    };
    let another = "another sampling period is asked for than 0.001, which the certificate is about";
    refused(&[AT_REST, "--sampling-period", "1/500", "--witness", &certificate], another);
    let long = std::fs::read_to_string(AT_REST).unwrap().replace("\"period\": \"1\"", "\"period\": \"2\"");
    std::fs::write(path("long.json"), long.replace("\"2*pi\"", "\"pi\"")).unwrap();
    let samples = "the certificate is about 1000 samples of 0.001 in a period at a matched base frequency, and that is not so here";
    refused(&[&path("long.json"), "--witness", &certificate], samples);
    let continuous = path("continuous.json");
    program().args(["certify", AT_REST, "-q", "-o", &continuous]).assert().code(0);
    let other = "the regulator at samples is asked for, and the certificate is about the one in continuous time";
    refused(&[AT_REST, "--sampling-period", "1/1000", "--witness", &continuous], other);
    refused(&["specs/plants/linear.json", "--witness", &continuous], "the field `plant` is missing");

    let source = path("axis.c");
    program().args(["controller", &certificate, "--n-o", "10", "--format", "c", "-o", &source]).assert().code(0);
    let header = std::fs::read_to_string(path("axis.h")).unwrap();
    let words = in_one_line(&header.replace("\n *", " "));
    assert!(words.contains("The claim is about this law at samples"), "{header}");
    assert!(
        words.contains("every phase of the sampling grid") && !words.contains("does not cover sampling"),
        "{header}"
    );
    let export = program().args(["controller", &certificate, "--n-o", "10"]).assert().code(0);
    let export = json(&export.get_output().stdout);
    assert_eq!(
        (&export["certificate"]["covers_law"], &export["certificate"]["sigma"]),
        (&object!(true), &object!("25"))
    );
    let claimed = read(&certificate);
    let gain: Rational = {
        let text = claimed["claim"]["gain"].as_str().unwrap();
        parse_decimal(text).unwrap()
    };
    assert_eq!(export["discrete"]["K"].as_f64(), Some(gain.to_f64()));
    for wrong in [["--sigma", "26"], ["--sigma", "24"], ["--discretise", "1/2000"]] {
        program().args(["controller", &certificate, "--n-o", "10"]).args(wrong).assert().code(2);
    }
    program().args(["controller", &certificate, "--n-o", "500"]).assert().code(2);
    let told =
        program().args(["controller", &certificate, "--n-o", "10", "--sigma", "26", "--uncertified"]).assert().code(0);
    let told = json(&told.get_output().stdout);
    assert_eq!(told["certificate"]["covers_law"], object!(false));
}

/// The smallest number of oscillators whose bound is at most the target; none where what is between samples is above it.
#[test]
fn targets_are_answered_at_samples() {
    let report = |targets: &[&str]| {
        let call =
            [&["certify", AT_REST, "--sampling-period", "1/100", "--no-alternatives", "--format", "json"], targets]
                .concat();
        json(&program().args(call).assert().code(0).get_output().stdout)
    };
    let plain = report(&[])["consequences"].clone();
    assert_eq!((&plain["most"], &plain["targets"]), (&object!(49), &object!([])));
    let rows = plain["error_bounds"].as_array().expect("rows");
    let sup: Vec<f64> = rows.iter().map(|row| number(&row["sup"])).collect();
    assert_eq!(rows.last().expect("rows")["n_o"], object!(49));
    assert!(sup.windows(2).all(|pair| pair[0] >= pair[1]) && sup[3] < 0.5 * sup[0], "{sup:?}");
    assert!(rows.iter().all(|row| number(&row["rms"]) <= number(&row["sup"])), "{rows:?}");
    // Of the table n_o = 2 is the third row; a little below its bound takes one more.
    for (target, answer, n_o) in [
        (sup[2] * (1.0 + 1e-9), "reached", object!(2)),
        (sup[2] * (1.0 - 1e-9), "reached", object!(3)),
        (sup[sup.len() - 1] * 0.9, "not reached", Value::Null),
    ] {
        let asked = report(&["--target-sup", &format!("{target:e}")])["consequences"]["targets"][0].clone();
        assert_eq!(
            (&asked["norm"], &asked["answer"], &asked["n_o"]),
            (&object!("sup"), &object!(answer), &n_o),
            "{target}"
        );
    }
    let text = program()
        .args(["certify", AT_REST, "-q", "--sampling-period", "1/100", "--target-rms", "1e-9"])
        .assert()
        .code(0);
    let text = utf8(text.get_output().stdout.clone());
    assert!(text.contains("not certified with any number of oscillators up to 49"), "{text}");
    let undecided =
        program().args(["certify", AT_REST, "-q", "--sampling-period", "1/2", "--target-sup", "1"]).assert().code(3);
    assert!(utf8(undecided.get_output().stdout.clone()).contains("The targets are not answered"));
}

#[test]
fn flags_that_make_no_sense_are_refused() {
    for wrong in [
        &["--sampling-period", "1/100", "--transfer", "boxes"][..],
        &["--sampling-period", "3/1000"],
        &["--sampling-period", "-1"],
        &["--sigma", "0"],
        &["--sigma", "pi"],
    ] {
        program().args(["certify", AT_REST, "-q"]).args(wrong).assert().code(2);
    }
}

#[test]
fn the_table_lists_pairs_that_certify() {
    let table = program()
        .args(["sampling", AT_REST, "--sampling-period", "1/200,1/2000", "--sigma", "22,1", "--format", "json", "-q"])
        .assert()
        .code(0);
    let table = json(&table.get_output().stdout);
    let rows = |list: &str| table[list].as_array().unwrap().clone();
    let [by_step, by_gain, round] = [rows("by_sampling_period"), rows("by_sigma"), rows("round")];
    assert_eq!((by_step.len(), by_gain.len()), (2, 2));
    assert_eq!(by_gain[1]["outcome"], object!("not certified"));
    assert!(number(&by_step[0]["sigma"]) > number(&by_step[1]["sigma"]));
    // Only of the gain that has a period; no longer, and 1, 2 or 5 times a power of ten.
    assert_eq!((round.len(), &round[0]["round"], &round[0]["sigma"]), (1, &object!("sampling_period"), &object!("22")));
    let step = number(&round[0]["sampling_period"]);
    assert!(round[0]["samples"].as_u64() >= by_gain[0]["samples"].as_u64());
    assert!([0.01, 0.02, 0.05].contains(&step), "{step}");
    for row in by_step.iter().chain(&by_gain[..1]).chain(&round) {
        assert_eq!(row["outcome"], object!("certified"));
        let spec = Specification::from_json("plain", AT_REST_TEXT).unwrap();
        let step = sampled(row["sampling_period"].as_str().unwrap()).internal_model.sampling.unwrap();
        let sampling = Sampling::new(spec.period.nominal(), step.step).unwrap();
        let gain = parse_decimal(row["sigma"].as_str().unwrap()).unwrap();
        let run = certify_sampled(&spec, &sampling, Some(&gain), None, Ladder::default()).unwrap();
        assert_eq!(run.verdict, Verdict::Certified, "{row}");
    }
    program().args(["sampling", AT_REST, "--sampling-period", "3/1000"]).assert().code(2);
    program().args(["sampling", AT_REST, "--sigma", "1", "-q"]).assert().code(3);
}

/// The longest certified sampling period at 1.5 times the gain of continuous time, for every shipped specification with a matched
/// base frequency: by h sigma. Where no pair is found it counts as 0.
#[test]
fn shipped_specifications_are_certified_at_long_samples() {
    let mut products = Vec::new();
    for path in files("specs") {
        let text = std::fs::read_to_string(&path).unwrap();
        let document: Value = serde_json::from_str(&text).unwrap();
        if document["internal_model"]["matched"] != true {
            continue;
        }
        let spec = Specification::from_json("shipped", &text).unwrap();
        let Ok(spec) = with_triple(&spec, None) else { continue };
        let run = certify(&spec, Options { compare: false, ..Options::default() }).unwrap();
        let Some(sigma) = run.sigma_star() else { continue };
        let gain = round_rational(&(sigma.clone() * Rational::from((3, 2))), 6, Direction::Up);
        let call = ["sampling", path.to_str().unwrap(), "--sigma", &write_exact(&gain), "--format", "json", "-q"];
        let table = json(&program().args(call).output().unwrap().stdout);
        let row = &table["by_sigma"][0];
        let product = match row["outcome"].as_str() {
            Some("certified") => number(&row["h_sigma"]),
            _ => 0.0,
        };
        println!("{}: h sigma = {product}", stem(&path));
        products.push(product);
    }
    products.sort_by(f64::total_cmp);
    assert!(products.len() > 15, "{products:?}");
    assert!(products[products.len() / 2] >= 0.2, "{products:?}");
}
