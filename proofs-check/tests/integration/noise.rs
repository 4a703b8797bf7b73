//! Noise and a disturbance, of given numbers of oscillators (docs/mathematics.md, section 13.6): in continuous time and at samples, accepted as
//! they are written, and refused where anything of them is not what it is. The certificates are those of shipped specifications, with larger error
//! boxes and with witnesses that were found apart from both programs.

use crate::common::{
    accepted, assert_refused, assert_words_are_ignored, edited, judged, names, parsed, rehash, said, without,
};
use crate::rates::{each_refused, rates_in_words, refused, signs_are_demanded_at, times};
use proofs_check::verdict::Verdict::{BadInput, Invalid, Undecided};
use serde_json::{Value, json};

const FOLDER: &str = "noise";
/// Those with x, for n_o = 0 and 2, with each of the three inputs.
const PAPER: [&str; 2] = ["paper-example", "sampled"];

pub fn stored(name: &str) -> Value {
    parsed(FOLDER, name)
}

/// With another document: its digest is made right.
pub fn with_document(certificate: &Value, changes: &[(impl AsRef<str>, Value)]) -> Value {
    let mut made = edited(certificate.clone(), changes);
    rehash(&mut made);
    made
}

fn is_sampled(certificate: &Value) -> bool {
    certificate["claim"]["regulator"] == "digital"
}

pub fn count(certificate: &Value) -> usize {
    certificate["claim"]["for_n_o"].as_array().unwrap().len()
}

/// The witness of the noise of an entry, with its pointer and its names but for Pi.
pub fn of_noise(certificate: &Value, i: usize) -> (String, Vec<String>) {
    let pointer = format!("/witness/for_n_o/{i}/noise");
    let fields = certificate.pointer(&pointer).unwrap().as_object().unwrap();
    (pointer, fields.keys().filter(|name| *name != "Pi").cloned().collect())
}

#[test]
fn stored_ones_are_accepted() {
    for name in names(FOLDER) {
        let certificate = stored(&name);
        let report = accepted(&certificate);
        assert!(said(&judged(&certificate)).ends_with(&rates_in_words(&certificate)), "{name}");
        let subject = report.subject.as_ref().unwrap();
        assert_eq!(subject.statement.matches("limit superior").count(), count(&certificate), "{name}");
        let assumed = subject.assumed.join("\n");
        assert!(
            assumed.contains("noise except where the claim says so") && assumed.contains("e + v for e"),
            "{assumed}"
        );
    }
}

#[test]
fn the_words_name_each_input() {
    let [statement, of_quantum, of_disturbance] =
        ["paper-example", "aligned", "no-x"].map(|name| said(&judged(&stored(name))).to_owned());
    assert!(statement.contains(
        " With n_o = 2 and sigma = 60 exactly, noise of at most 0.0005 on the measurement of e, a measurement of e in steps of (1/1000), a \
         disturbance of at most 0.01 added to q: |e(t) - e_per(t)| <= "
    ));
    assert!(of_quantum.contains(" exactly, a measurement of e in steps of 0.002: |e"));
    assert!(of_disturbance.contains(" exactly, a disturbance of at most (1/10) added to q: |e"));
}

#[test]
fn each_number_matters() {
    for name in names(FOLDER) {
        let certificate = stored(&name);
        for i in 0..count(&certificate) {
            let claim = format!("/claim/for_n_o/{i}/noise");
            let (witness, fields) = of_noise(&certificate, i);
            let [limit, pi] = [format!("{claim}/limit"), format!("{witness}/Pi")];
            let mut changes = vec![
                (limit.clone(), 1.0 - 1e-4, limit.clone()),
                (format!("{claim}/peak"), 1.0 - 1e-4, format!("{claim}/peak")),
                (format!("{pi}/0/0"), 3.0, witness.clone()),
                (format!("{pi}/1/1"), 3.0, witness.clone()),
                (format!("{pi}/1/1"), -1.0, format!("{witness}/e_low")),
            ];
            for field in fields {
                let pointer = format!("{witness}/{field}");
                changes.extend(match field.as_str() {
                    "e_low" => vec![
                        (pointer, 1.5, format!("{witness}/e_low")),
                        (witness.clone() + "/e_low", 0.99, limit.clone()),
                    ],
                    // Slower is easier, and says less.
                    "lambda" | "c" => vec![(pointer.clone(), 0.95, limit.clone()), (pointer, 5.0, pi.clone())],
                    // An input that weighs more raises W by more.
                    "g_d" | "g_v" | "g_r" => vec![(pointer.clone(), 1.5, limit.clone()), (pointer, 0.2, pi.clone())],
                    _ => vec![(pointer.clone(), 30.0, pi.clone()), (pointer, 1.0 / 30.0, pi.clone())],
                });
            }
            each_refused(&certificate, &changes);
        }
    }
}

#[test]
fn signs_are_demanded() {
    for name in names(FOLDER) {
        let certificate = stored(&name);
        let (witness, fields) = of_noise(&certificate, 0);
        signs_are_demanded_at(&certificate, fields.iter().map(|field| format!("{witness}/{field}")));
        // What is claimed is at least what is proved, which is above 0.
        for field in ["limit", "peak"] {
            let pointer = format!("/claim/for_n_o/0/noise/{field}");
            refused(edited(certificate.clone(), &[(&pointer, json!("0"))]), Invalid, "rates", &pointer);
        }
    }
}

/// The claim and the witness have it both, with all of its parts, and with no others.
#[test]
fn nothing_is_left_out_and_nothing_is_added() {
    for name in names(FOLDER) {
        let certificate = stored(&name);
        let (witness, fields) = of_noise(&certificate, 0);
        let without = |pointer: &str| edited(certificate.clone(), &[(pointer, Value::Null)]);
        refused(without("/claim/for_n_o/0/noise"), BadInput, "format", "/witness/for_n_o/0");
        refused(without(&witness), BadInput, "format", "/witness/for_n_o/0");
        accepted(&edited(without(&witness), &[("/claim/for_n_o/0/noise", Value::Null)]));
        for field in fields.iter().map(String::as_str).chain(["Pi"]) {
            let verdict = if field.starts_with("g_") { (Invalid, "rates") } else { (BadInput, "format") };
            refused(without(&format!("{witness}/{field}")), verdict.0, verdict.1, &witness);
        }
        for field in ["g_d", "g_v", "g_r", "lambda", "c", "w", "l", "l_x", "e_up", "k"] {
            if !fields.iter().any(|own| own == field) {
                let added = edited(certificate.clone(), &[(&format!("{witness}/{field}"), json!("1"))]);
                let report = judged(&added);
                assert!(matches!(report.verdict, Invalid | BadInput), "{name} {field}");
                assert!(report.finding.unwrap().pointer.starts_with(&witness), "{name} {field}");
            }
        }
        for pointer in ["/claim/for_n_o/0/noise/limit", "/claim/for_n_o/0/noise/peak"] {
            refused(without(pointer), BadInput, "format", "/claim/for_n_o/0/noise");
        }
        let more = edited(certificate.clone(), &[("/claim/for_n_o/0/noise/rate", json!("1"))]);
        refused(more, BadInput, "format", "/claim/for_n_o/0/noise/rate");
    }
}

/// Pi of another n_o, of the other regulator, or of the rate, whose (N) is no less than what is wanted.
#[test]
fn a_proof_is_that_of_its_own_number() {
    for name in PAPER {
        let certificate = stored(name);
        let noise = |i: usize| certificate["witness"]["for_n_o"][i]["noise"].clone();
        let lent = edited(certificate.clone(), &[("/witness/for_n_o/1/noise", noise(0))]);
        refused(lent, BadInput, "format", "/witness/for_n_o/1/noise/Pi");
        let claimed = certificate["claim"]["for_n_o"][0]["noise"].clone();
        let lent = edited(certificate.clone(), &[("/claim/for_n_o/1/noise", claimed)]);
        refused(lent, Invalid, "rates", "/claim/for_n_o/1/noise/limit");
    }
    let [continuous, sampled] = PAPER.map(|name| stored(name)["witness"]["for_n_o"][0]["noise"].clone());
    for (name, other) in PAPER.into_iter().zip([sampled, continuous]) {
        let lent = edited(stored(name), &[("/witness/for_n_o/0/noise", other)]);
        refused(lent, BadInput, "format", "/witness/for_n_o/0/noise");
    }
}

/// What is proved at one end of the input gain alone is refused.
#[test]
fn both_ends_of_a_gain_count() {
    for name in ["input-gain", "sampled-input-gain"] {
        let of_one_end = parsed("one-end", name);
        for part in of_one_end.as_array().unwrap() {
            let limits = json!({ "limit": "0.1", "peak": "1.4" });
            let changes = [("/witness/for_n_o/0/noise", part.clone()), ("/claim/for_n_o/0/noise", limits)];
            refused(edited(stored(name), &changes), Invalid, "rates", "/witness/for_n_o/0/noise/Pi");
        }
    }
}

/// The file has the noise that is spoken of.
#[test]
fn the_noise_is_that_of_the_file() {
    for name in PAPER {
        let certificate = stored(name);
        let [measurement, disturbance] = ["/specification/measurement", "/specification/disturbance"];
        let at = "/witness/for_n_o/0/noise";
        let none = with_document(&certificate, &[(measurement, Value::Null), (disturbance, Value::Null)]);
        refused(none, Invalid, "rates", "/claim/for_n_o/0/noise");
        let zero = [(measurement, json!({ "noise": 0, "quantum": "0.0" })), (disturbance, json!("0"))];
        refused(with_document(&certificate, &zero), Invalid, "rates", "/claim/for_n_o/0/noise");
        // An input that the file has not; and one that it has more of.
        refused(with_document(&certificate, &[(disturbance, Value::Null)]), Invalid, "rates", &format!("{at}/g_d"));
        refused(with_document(&certificate, &[(measurement, Value::Null)]), Invalid, "rates", &format!("{at}/g_v"));
        let limit = "/claim/for_n_o/0/noise/limit";
        for (pointer, more) in [(disturbance, "0.0101"), ("/specification/measurement/noise", "0.000501")] {
            refused(with_document(&certificate, &[(pointer, json!(more))]), Invalid, "rates", limit);
        }
        // A step counts by its half.
        refused(
            with_document(&certificate, &[("/specification/measurement/quantum", json!("0.001002"))]),
            Invalid,
            "rates",
            limit,
        );
        let halved =
            [("/specification/measurement/noise", json!("0.001")), ("/specification/measurement/quantum", Value::Null)];
        accepted(&with_document(&certificate, &halved));
        let less = [("/specification/measurement/noise", json!(0.0004)), (disturbance, json!("0.005"))];
        accepted(&with_document(&certificate, &less));
        // The words are those of the file.
        let report = judged(&with_document(&certificate, &less));
        assert!(said(&report).contains("noise of at most 0.0004 on the measurement of e, "), "{}", report.text(false));
    }
}

#[test]
fn what_the_file_may_say_is_strict() {
    for (about, certificate) in [("specification", stored("paper-example")), ("plant", stored("plant"))] {
        let measurement = format!("/{about}/measurement");
        for (pointer, value, verdict) in [
            (measurement.clone(), json!({}), BadInput),
            (measurement.clone(), json!("0.1"), BadInput),
            (measurement.clone(), json!({ "noise": "0.1", "bias": "0.1" }), BadInput),
            (format!("{measurement}/noise"), json!("-0.1"), Invalid),
            (format!("{measurement}/noise"), json!("sqrt(2)"), BadInput),
            (format!("{measurement}/quantum"), json!([1]), BadInput),
            (format!("/{about}/disturbance"), json!("-1/1000"), Invalid),
            (format!("/{about}/disturbance"), json!({ "max": "1" }), BadInput),
            (format!("/{about}/noise"), json!("1"), BadInput),
        ] {
            let report = judged(&edited(certificate.clone(), &[(&pointer, value.clone())]));
            let rule = if verdict == Invalid { "specification" } else { "format" };
            assert_refused(&report, verdict, rule, &pointer);
        }
    }
}

/// With much more noise the solution need not stay in the error box: by x first, whose room is the smaller one here, then by e.
#[test]
fn the_error_box_has_room() {
    for name in PAPER {
        let certificate = stored(name);
        for (factor, what) in [(3.0, "< D_x"), (60.0, "< D_e")] {
            let mut changes = vec![];
            for field in ["measurement/noise", "measurement/quantum", "disturbance"] {
                let pointer = format!("/specification/{field}");
                changes.push((pointer.clone(), times(&certificate, &pointer, factor)));
            }
            let large = json!({ "limit": "100", "peak": "100" });
            changes.extend((0..2).map(|i| (format!("/claim/for_n_o/{i}/noise"), large.clone())));
            let report = judged(&with_document(&certificate, &changes));
            assert_refused(&report, Invalid, "rates", "/witness/for_n_o");
            assert!(report.finding.unwrap().message.ends_with(what), "{name} {what}");
        }
    }
}

/// The regulator sets z = M e with the e that it measures: without Nbar v_bar in it the peak would be too small.
#[test]
fn an_aligned_start_is_off_by_the_noise() {
    for (name, plain) in [("aligned", "1.60474"), ("sampled-aligned", "1.59244")] {
        let certificate = stored(name);
        let peak = "/claim/for_n_o/0/noise/peak";
        let before: f64 = certificate.pointer(peak).unwrap().as_str().unwrap().parse().unwrap();
        assert!((1e-4..1e-3).contains(&(before - plain.parse::<f64>().unwrap())), "{before} {plain}");
        refused(edited(certificate.clone(), &[(peak, json!(plain))]), Invalid, "rates", peak);
        let statement = certificate["claim"]["statement"].as_str().unwrap();
        assert_words_are_ignored(&certificate, &statement.replace(" (z = M e of the measured e)", ""));
    }
}

/// What an actuator takes is proved without noise.
#[test]
fn with_an_actuator_there_is_no_noise() {
    let certificate = stored("paper-example");
    let sigma = certificate["claim"]["sigma_star"].clone();
    let changes = [
        ("/specification/actuator", json!({ "max": "1000" })),
        ("/claim/actuator", json!({ "max": "1000" })),
        ("/claim/sigma_star", Value::Null),
        ("/claim/sigma", sigma),
    ];
    let made = with_document(&certificate, &changes);
    refused(made.clone(), Undecided, "actuator", "/claim/for_n_o/0/noise");
    let parts = |part: &str| (0..2).map(move |i| format!("/{part}/for_n_o/{i}/noise")).collect::<Vec<_>>();
    accepted(&without(&made, ["claim", "witness"].into_iter().flat_map(parts)));
}

/// The gain of the claim, and no other.
#[test]
fn the_gain_is_that_of_the_claim() {
    let certificate = stored("paper-example");
    let changes = [("/claim/sigma_star", json!("400")), ("/claim/control", Value::Null)];
    refused(edited(certificate, &changes), Invalid, "rates", "/witness/for_n_o/0");
}

#[test]
fn data_that_say_less_prove_less() {
    for name in PAPER {
        let certificate = stored(name);
        for (bound, more) in [("q_x", "sqrt(1 + E^2) + 3"), ("f_e", "X + 9"), ("q_e", "X + 9")] {
            let changed = with_document(&certificate, &[(&format!("/specification/bounds/{bound}"), json!(more))]);
            assert_eq!(judged(&changed).verdict, Invalid, "{name} {bound}");
        }
    }
}

/// A certificate at samples has both kinds of sentences.
#[test]
fn at_samples_the_limits_hold_between_them_too() {
    for name in names(FOLDER).iter().filter(|name| is_sampled(&stored(name))) {
        let certificate = stored(name);
        let report = judged(&certificate);
        let (statement, n) = (said(&report), count(&certificate));
        assert_eq!(statement.matches(" at the sampling instants t for these solutions").count(), n);
        assert_eq!(statement.matches(" and all t >= t_0, and its limit superior").count(), n);
        assert_words_are_ignored(&certificate, &statement.replacen(" at the sampling instants t", "", 1));
    }
}
