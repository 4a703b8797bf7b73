//! Rounding of a regulator at samples (docs/mathematics.md, section 13.6, Proposition A): accepted as it is written, and refused where anything of it is
//! not what it is. The certificates are those of `noise` with a regulator that computes in doubles, and two with nothing but that; their numbers
//! were found by bisection, so that each is next to the least that is accepted.

use crate::common::{accepted, assert_refused, assert_words_are_ignored, edited, judged, names, parsed, said, without};
use crate::noise::{count, of_noise, stored as noisy, with_document};
use crate::rates::{each_refused, rates_in_words, refused, times};
use proofs_check::check_against;
use proofs_check::verdict::Verdict::{BadInput, Invalid, Undecided, Valid};
use serde_json::{Value, json};

const FOLDER: &str = "arithmetic";
const FIELDS: [&str; 4] = ["z_low", "z_up", "z_noise", "level"];
const WORDS: &str = "computed in double precision as exported";
/// Those without noise and disturbance.
const ALONE: [&str; 2] = ["alone", "input-gain-alone"];

fn stored(name: &str) -> Value {
    parsed(FOLDER, name)
}

/// Refused at this place, with a message that ends so.
#[track_caller]
fn refused_with(certificate: Value, place: &str, message: &str) {
    let report = judged(&certificate);
    assert_refused(&report, Invalid, "rates", place);
    let found = report.finding.unwrap().message;
    assert!(found.ends_with(message), "{found}");
}

#[test]
fn stored_ones_are_accepted() {
    for name in names(FOLDER) {
        let certificate = stored(&name);
        let report = accepted(&certificate);
        assert!(said(&judged(&certificate)).ends_with(&rates_in_words(&certificate)), "{name}");
        let subject = report.subject.as_ref().unwrap();
        let said = format!("{WORDS}: |e(t) - e_per(t)| <= ");
        assert_eq!(subject.statement.matches(&said).count(), count(&certificate), "{name}");
        let assumed = subject.assumed.join("\n");
        for part in [
            "of R except where the claim says so",
            "e + v for e",
            "rounded to nearest on its own",
            "its z starts as doubles",
        ] {
            assert!(assumed.contains(part), "{name} {assumed}");
        }
    }
    // Without it nothing is assumed of doubles.
    let subject = accepted(&noisy("sampled")).subject.unwrap();
    assert!(!subject.assumed.join("\n").contains("doubles") && !subject.statement.contains(WORDS));
}

/// Of doubles alone the limit is about 10^-11.
#[test]
fn rounding_alone_is_a_claim() {
    for name in ALONE {
        let certificate = stored(name);
        let statement = certificate["claim"]["statement"].as_str().unwrap();
        assert!(statement.contains(&format!(" exactly, {WORDS}, also |e")), "{statement}");
        for entry in certificate["claim"]["for_n_o"].as_array().unwrap() {
            let limit: f64 = entry["noise"]["limit"].as_str().unwrap().parse().unwrap();
            assert!((1e-13..1e-10).contains(&limit), "{limit}");
        }
    }
}

#[test]
fn each_number_matters() {
    for name in names(FOLDER) {
        let certificate = stored(&name);
        let alone = ALONE.contains(&name.as_str());
        for i in 0..count(&certificate) {
            let claim = format!("/claim/for_n_o/{i}/noise");
            let (witness, fields) = of_noise(&certificate, i);
            let [pi, level] = ["Pi", "level"].map(|field| format!("{witness}/{field}"));
            let [limit, z_noise, z_low, z_up] =
                [(&claim, "limit"), (&witness, "z_noise"), (&witness, "z_low"), (&witness, "z_up")]
                    .map(|(part, field)| format!("{part}/{field}"));
            let less = 1.0 - 1e-5;
            let mut changes = vec![
                (limit.clone(), less, limit.clone()),
                (format!("{claim}/peak"), less, format!("{claim}/peak")),
                (level.clone(), less, level.clone()),
                (level.clone(), 1.0 + 1e-5, z_noise.clone()),
                (z_noise.clone(), less, z_noise.clone()),
                (z_low.clone(), less, z_noise),
                (z_low.clone(), 1.0 + 1e-5, z_low),
                (z_up.clone(), less, z_up.clone()),
                (format!("{witness}/c"), 0.99, level.clone()),
                (format!("{witness}/c"), 5.0, pi.clone()),
                (format!("{witness}/e_low"), 0.99, limit),
                (format!("{witness}/e_low"), 1.5, format!("{witness}/e_low")),
            ];
            if alone {
                changes.push((z_up, 1.01, level.clone()));
            }
            for field in ["g_d", "g_v", "g_r"].into_iter().filter(|field| fields.iter().any(|own| own == field)) {
                // Inputs that are as small as u0 count by their weights too.
                let more = if alone { 1e6 } else { 1e30 };
                changes.push((format!("{witness}/{field}"), more, level.clone()));
                changes.push((format!("{witness}/{field}"), 1e-3, pi.clone()));
            }
            each_refused(&certificate, &changes);
        }
    }
}

#[test]
fn signs_are_demanded() {
    for name in names(FOLDER) {
        let certificate = stored(&name);
        for field in FIELDS {
            let pointer = format!("/witness/for_n_o/0/noise/{field}");
            for value in [json!("0"), times(&certificate, &pointer, -1.0)] {
                refused_with(edited(certificate.clone(), &[(&pointer, value.clone())]), &pointer, &{
                    format!("0 < {field} fails: {field} = {}", value.as_str().unwrap())
                });
            }
        }
    }
}

/// The four numbers stand where the regulator computes in doubles, and nowhere else, and so do the weights of the inputs.
#[test]
fn nothing_is_left_out_and_nothing_is_added() {
    let at = "/witness/for_n_o/0/noise";
    for name in names(FOLDER) {
        let certificate = stored(&name);
        let without = |fields: &[&str]| without(&certificate, fields.iter().map(|field| format!("{at}/{field}")));
        for field in FIELDS {
            refused(without(&[field]), BadInput, "format", at);
            let others: Vec<&str> = FIELDS.into_iter().filter(|other| *other != field).collect();
            refused(without(&others), BadInput, "format", at);
        }
        refused_with(without(&FIELDS), at, "are missing, and the file has the arithmetic `double`");
        for field in ["g_d", "g_v"] {
            refused_with(without(&[field]), at, &format!("`{field}` is missing, and there is such an input"));
        }
        let more = edited(certificate.clone(), &[(&format!("{at}/u_noise"), json!("1"))]);
        refused(more, BadInput, "format", &format!("{at}/u_noise"));
        // Outside of what is said of noise they are not known, and no rate takes them.
        for field in FIELDS.into_iter().filter(|field| *field != "z_up") {
            let place = format!("/witness/for_n_o/0/{field}");
            refused(edited(certificate.clone(), &[(&place, json!("1"))]), BadInput, "format", &place);
        }
        // The whole of it may be left out.
        let parts = ["claim", "witness"].map(|part| {
            (0..count(&certificate))
                .map(move |i| (format!("/{part}/for_n_o/{i}/noise"), Value::Null))
                .collect::<Vec<_>>()
        });
        let parts = parts.concat();
        accepted(&edited(certificate.clone(), &parts));
    }
    for name in ALONE {
        let added = edited(stored(name), &[(&format!("{at}/g_r"), json!("1"))]);
        refused_with(added, &format!("{at}/g_r"), "there is no such input");
    }
    // Of exact arithmetic, whether that is written or not.
    for arithmetic in [json!("exact"), Value::Null] {
        for (name, place) in [("all", "level"), ("aligned", "level"), ("alone", "")] {
            let made = with_document(&stored(name), &[("/specification/arithmetic", arithmetic.clone())]);
            let (place, message) = match place {
                "" => ("/claim/for_n_o/0/noise".to_owned(), "the file states no noise and no disturbance"),
                _ => (format!("{at}/{place}"), "the file has exact arithmetic: there is no rounding"),
            };
            refused_with(made, &place, message);
        }
        accepted(&with_document(&noisy("sampled"), &[("/specification/arithmetic", arithmetic)]));
    }
}

/// What is proved of exact arithmetic says nothing of doubles, and the words are those of the file.
#[test]
fn a_claim_of_exact_arithmetic_is_none_of_doubles() {
    for name in names("noise").into_iter().filter(|name| name.starts_with("sampled")) {
        let made = with_document(&noisy(&name), &[("/specification/arithmetic", json!("double"))]);
        refused_with(
            made.clone(),
            "/witness/for_n_o/0/noise",
            "`z_low`, `z_up`, `z_noise` and `level` are missing, and the file has the arithmetic `double`",
        );
    }
    let certificate = stored("all");
    let statement = certificate["claim"]["statement"].as_str().unwrap();
    for words in [format!(", {WORDS}"), format!(" {WORDS},"), " as exported".to_owned()] {
        assert_words_are_ignored(&certificate, &statement.replacen(&words, "", 1));
    }
}

#[test]
fn what_the_file_may_say_is_strict() {
    for (about, certificate) in [("specification", stored("all")), ("plant", noisy("plant"))] {
        let pointer = format!("/{about}/arithmetic");
        for (value, message) in [
            (json!("single"), "nothing is proved of single precision: the regulator is exported in double precision"),
            (json!("Double"), "expected `double`, in which the regulator is exported, or `exact`"),
            (json!("float"), "expected `double`, in which the regulator is exported, or `exact`"),
            (json!(""), "expected `double`, in which the regulator is exported, or `exact`"),
        ] {
            let report = judged(&edited(certificate.clone(), &[(&pointer, value)]));
            assert_refused(&report, BadInput, "format", &pointer);
            assert_eq!(report.finding.unwrap().message, message);
        }
        for value in [json!(64), json!(true), json!({ "type": "double" }), json!(["double"])] {
            let report = judged(&edited(certificate.clone(), &[(&pointer, value)]));
            assert_refused(&report, BadInput, "format", &pointer);
        }
        let more = edited(certificate.clone(), &[(&format!("/{about}/precision"), json!("double"))]);
        assert_refused(&judged(&more), BadInput, "format", &format!("/{about}/precision"));
    }
}

/// In continuous time nothing rounds: the claim of noise is what it was, and without noise there is none.
#[test]
fn rounding_counts_at_samples_alone() {
    for name in names("noise").into_iter().filter(|name| !name.starts_with("sampled") && !name.starts_with("plant")) {
        let certificate = noisy(&name);
        let double = ("/specification/arithmetic", json!("double"));
        accepted(&with_document(&certificate, std::slice::from_ref(&double)));
        let none = ["measurement", "disturbance"].map(|field| format!("/specification/{field}"));
        let alone = with_document(&certificate, &[double, (&none[0], Value::Null), (&none[1], Value::Null)]);
        refused_with(
            alone,
            "/claim/for_n_o/0/noise",
            "the file states no noise and no disturbance; rounding counts at samples alone",
        );
        for field in FIELDS {
            let place = format!("/witness/for_n_o/0/noise/{field}");
            refused(edited(certificate.clone(), &[(&place, json!("1"))]), BadInput, "format", &place);
        }
    }
}

/// z_noise is part of what is rounded: a large one makes the step worse, and a huge one overflows.
#[test]
fn what_noise_does_to_the_regulator_counts() {
    for name in ALONE {
        let certificate = stored(name);
        let [z_noise, at] = ["/witness/for_n_o/0/noise/z_noise", "/witness/for_n_o/0/noise"];
        let with = |value: &str| edited(certificate.clone(), &[(z_noise, json!(value))]);
        refused_with(with("1"), &format!("{at}/level"), "sqrt(z_up) dz_b <= level");
        refused_with(with(&format!("1{}", "0".repeat(299))), &format!("{at}/level"), "sqrt(z_up) dz_b <= level");
        let huge = format!("1{}", "0".repeat(301));
        refused_with(with(&huge), at, "A, (1 + K) Nbar w_b + sigma m_b < 2^1000");
    }
}

/// With a nominal gain that is small what is put out overflows before u does, and no gain is less than a normal double. The interval of b is the
/// same, and so is all else.
#[test]
fn what_is_put_out_is_in_range() {
    let certificate = stored("input-gain-alone");
    let with = |scale: &str, z_noise: Option<&str>| {
        let [nominal, low, high] = ["2", "1.8", "2.2"].map(|value| format!("{value}{scale}"));
        let gain = json!({ "nominal": nominal, "low": low, "high": high });
        let mut changes = vec![
            ("/specification/input_gain", gain.clone()),
            ("/claim/input_gain", gain),
            ("/claim/control", Value::Null),
        ];
        changes.extend(z_noise.map(|value| ("/witness/for_n_o/0/noise/z_noise", json!(value))));
        with_document(&certificate, &changes)
    };
    accepted(&with("e-6", None));
    accepted(&with("e6", None));
    let at = "/witness/for_n_o/0/noise";
    refused_with(with("e-6", Some(&format!("1{}", "0".repeat(297)))), at, "sigma m_b < 2^1000 nominal");
    refused_with(with("e-280", None), at, "A, 2^-900 < nominal");
    refused_with(with("e280", None), at, "A, nominal < 2^900");
}

/// The proof of other inputs, or of another n_o, is none.
#[test]
fn a_proof_is_that_of_its_own_inputs() {
    let (alone, all) = (stored("alone"), stored("all"));
    let part = |certificate: &Value, part: &str, i: usize| certificate[part]["for_n_o"][i]["noise"].clone();
    let mut lent = part(&alone, "witness", 0);
    lent["g_r"] = part(&all, "witness", 0)["g_r"].clone();
    let made = edited(
        all.clone(),
        &[("/witness/for_n_o/0/noise", lent), ("/claim/for_n_o/0/noise", part(&alone, "claim", 0))],
    );
    refused(made, Invalid, "rates", "/witness/for_n_o/0/noise/level");
    let made = edited(all.clone(), &[("/claim/for_n_o/1/noise", part(&all, "claim", 0))]);
    refused(made, Invalid, "rates", "/claim/for_n_o/1/noise/limit");
    let numbers =
        FIELDS.map(|field| (format!("/witness/for_n_o/1/noise/{field}"), part(&alone, "witness", 0)[field].clone()));
    refused(edited(alone.clone(), &numbers), Invalid, "rates", "/witness/for_n_o/1/noise/z_low");
    // The proof of one entry is no proof of the other.
    let lent = edited(alone.clone(), &[("/witness/for_n_o/1/noise", part(&alone, "witness", 0))]);
    refused(lent, BadInput, "format", "/witness/for_n_o/1/noise/Pi");
}

/// More of an input, or a larger law, than what is proved.
#[test]
fn the_inputs_are_those_of_the_file() {
    let level = "/witness/for_n_o/0/noise/level";
    let all = stored("all");
    for (pointer, more) in [("/specification/measurement/noise", "0.000501"), ("/specification/disturbance", "0.0101")]
    {
        refused(with_document(&all, &[(pointer, json!(more))]), Invalid, "rates", level);
    }
    let noise = json!({ "noise": "0.000001" });
    refused(with_document(&stored("alone"), &[("/specification/measurement", noise)]), Invalid, "rates", level);
    let disturbed = with_document(&stored("alone"), &[("/specification/disturbance", json!("0.000001"))]);
    refused_with(disturbed, "/witness/for_n_o/0/noise", "`g_r` is missing, and there is such an input");
    // Without states of the plant in the way it is the level that fails.
    let more = with_document(&stored("no-x"), &[("/specification/measurement", json!({ "noise": "0.01" }))]);
    refused(more, Invalid, "rates", level);
}

/// With much of it the solution need not stay in the error box.
#[test]
fn the_error_box_has_room() {
    let certificate = stored("all");
    let witness = "/witness/for_n_o/0/noise";
    let mut changes = vec![("/claim/for_n_o/0/noise".to_owned(), json!({ "limit": "100", "peak": "100" }))];
    for (factor, what) in [(3.0, "< D_x"), (60.0, "< D_e")] {
        changes.truncate(1);
        for field in ["level", "z_noise"] {
            let pointer = format!("{witness}/{field}");
            changes.push((pointer.clone(), times(&certificate, &pointer, factor)));
        }
        refused_with(edited(certificate.clone(), &changes), witness, what);
    }
}

/// What an actuator takes is proved without rounding too.
#[test]
fn with_an_actuator_nothing_is_said_of_rounding() {
    for name in ["all", "alone"] {
        let certificate = stored(name);
        let changes =
            [("/specification/actuator", json!({ "max": "1000" })), ("/claim/actuator", json!({ "max": "1000" }))];
        refused(with_document(&certificate, &changes), Undecided, "actuator", "/claim/for_n_o/0/noise");
    }
}

/// Exact arithmetic need not be written, in the file that is asked for either; another one is another file.
#[test]
fn exact_is_the_default() {
    let certificate = noisy("sampled");
    for (own, asked, same) in [
        (None, Some("exact"), true),
        (Some("exact"), None, true),
        (Some("exact"), Some("exact"), true),
        (None, Some("double"), false),
        (Some("exact"), Some("double"), false),
        (Some("double"), Some("double"), true),
        (Some("double"), None, false),
        (Some("double"), Some("exact"), false),
    ] {
        let of = |value: Option<&str>| value.map_or(Value::Null, |value| json!(value));
        let base = if own == Some("double") { stored("all") } else { certificate.clone() };
        let pointer = "/specification/arithmetic";
        let made = with_document(&base, &[(pointer, of(own))]);
        let asked = edited(base, &[(pointer, of(asked))])["specification"].to_string();
        let report = check_against(made.to_string().as_bytes(), Some(asked.as_bytes()));
        match same {
            true => assert_eq!(report.verdict, Valid, "{}", report.text(false)),
            false => assert_refused(&report, Invalid, "the specification that was asked for", pointer),
        }
    }
}
