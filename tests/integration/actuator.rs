//! An actuator that saturates, limits of the error and the control, and the rows of larger gains (docs/mathematics.md, 13.5): what is certified,
//! that no member of a claim saturates, and what a regulator and a simulation make of it.

use crate::support::{count, document, every, json, number, options, program, specification_text, tried, utf8};
use proofs_check::verdict::Verdict as Answer;
use rug::Rational;
use serde_json::{Value, json as object};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lab::falsify::Finding;
use sigmastar_lang::spec::{Document, Specification};
use sigmastar_propose::search::{Failing, Limited, Obstacle};
use sigmastar_prove::certificate::{certificate_json, certificate_of, read_witness};
use sigmastar_prove::certify::{Certification, Options, Outcome, Verdict, certify, recheck};
use sigmastar_prove::reduction::{Prepared, Subject};
use std::path::Path;

const NAME: &str = "paper-example-rms-at-rest";

/// A shipped file with other members.
fn text(name: &str, members: &[(&str, Value)]) -> String {
    let mut document = document(name);
    for (pointer, value) in members {
        let (parent, member) = pointer.rsplit_once('/').unwrap();
        document.pointer_mut(parent).unwrap()[member] = value.clone();
    }
    document.to_string()
}

fn actuator(max: &str) -> (&'static str, Value) {
    ("/actuator", object!({ "max": max }))
}

fn with_max(max: &str) -> Specification {
    Specification::from_json("spec", &text(NAME, &[actuator(max)])).unwrap()
}

/// About the least max for which a proof is found, and its gain.
fn least(run: &Certification<'_>) -> [f64; 2] {
    match &run.sharp {
        Outcome::NotFound(Obstacle {
            failing: Failing::Limit { which: Limited::Actuator, least, sigma, .. }, ..
        }) => [*least, *sigma],
        other => panic!("{other:?}"),
    }
}

/// The certificate of a document of any kind.
fn certificate(text: &str) -> Value {
    let subject = Subject::read(&Document::parse("document", text).unwrap()).unwrap();
    let prepared = Prepared::new(subject, None).unwrap();
    certificate_of(&prepared.certify(options()).unwrap()).expect("certified")
}

#[test]
fn one_positive_constant() {
    let read = |part: Value| Specification::from_json("spec", &text(NAME, &[("/actuator", part)]));
    assert_eq!(read(object!({ "max": "3*sqrt(2)" })).unwrap().actuator.unwrap().max.text, "3*sqrt(2)");
    for (wrong, place) in [
        (object!({ "max": "0" }), "/actuator/max"),
        (object!({ "max": "-3" }), "/actuator/max"),
        (object!({ "max": "x" }), "/actuator/max"),
        (object!({ "max": "3", "min": "1" }), "/actuator/min"),
        (object!({}), "/actuator/max"),
        (object!("3"), "/actuator"),
        (object!(null), "/actuator"),
    ] {
        let errors = read(wrong.clone()).unwrap_err();
        assert!(errors.errors().iter().any(|error| error.pointer == place), "{wrong}: {}", errors.render(false));
    }
    // Limits to both sides have an answer of their own, and it is the only one.
    let one_sided = read(object!({ "min": "0", "max": "3.9" })).unwrap_err();
    let text = one_sided.render(false);
    let said = text.contains("for plants by their formulas") && text.contains("(min + max)/2");
    assert!(one_sided.errors().len() == 1 && said, "{text}");
}

/// A claim is certified down to about the least max that is told, at one gain, and below that nothing is claimed.
#[test]
fn the_least_max_that_is_told_is_where_claims_end() {
    let tight = with_max("1");
    let run = certify(&tight, options()).unwrap();
    assert_eq!(run.verdict, Verdict::Undecided);
    let [least_max, sigma] = least(&run);
    assert!((20.0..30.0).contains(&least_max) && (10.0..100.0).contains(&sigma), "{least_max} {sigma}");
    for (share, certified) in [(1.001, true), (0.999, false)] {
        let spec = with_max(&format!("{:.6}", share * least_max));
        let run = certify(&spec, options()).unwrap();
        assert_eq!(run.verdict == Verdict::Certified, certified, "{share}");
        assert!(run.exact.is_none() && run.gains.is_empty());
    }
    // With room the claim is that of the smallest gain.
    let [plain, roomy] = [Specification::from_json("spec", &specification_text(NAME)).unwrap(), with_max("1000")];
    let [plain, roomy] = [&plain, &roomy].map(|spec| certify(spec, options()).unwrap());
    assert_eq!(plain.sigma_star(), roomy.sigma_star());
    assert!(plain.exact.is_some() && roomy.exact.is_none());
    assert_eq!(roomy.conditions().last().map(|condition| condition.id), Some("C6"));
}

#[test]
fn the_claim_is_about_one_gain() {
    let spec = with_max("26");
    let run = certify(&spec, Options::default()).unwrap();
    let certificate = certificate_json(&run).expect("certified");
    let claim = &certificate["claim"];
    assert!(claim["sigma"].is_string() && claim.get("sigma_star").is_none());
    assert_eq!(claim["actuator"], object!({ "max": "26" }));
    let statement = claim["statement"].as_str().unwrap();
    assert!(
        statement.contains("the gain sigma = ") && statement.contains("limits what is put out to 26 in size"),
        "{statement}"
    );
    assert!(certificate.get("comparison").is_none() && certificate["witness"].get("exact_regulation").is_none());
    let answer = proofs_check::check(certificate.to_string().as_bytes());
    assert!(answer.is_valid(), "{}", answer.text(false));
    // Decided again from the certificate; refuted where the actuator takes less.
    let witness = read_witness(&Document::parse("certificate", &certificate.to_string()).unwrap()).unwrap();
    assert_eq!(recheck(&spec, &witness, options()).unwrap().verdict, Verdict::Certified);
    assert_eq!(recheck(&with_max("25.5"), &witness, options()).unwrap().verdict, Verdict::Refuted);
    // A claim with the one and a file with the other are not read.
    for (from, to) in [("/claim/sigma", "/claim/sigma_star"), ("/claim/actuator", "/claim/acutator")] {
        let mut forged = certificate.clone();
        let moved = forged.pointer_mut(from).unwrap().take();
        let claim = forged["claim"].as_object_mut().unwrap();
        claim.remove(from.rsplit('/').next().unwrap());
        claim.insert(to.rsplit('/').next().unwrap().to_owned(), moved);
        let document = Document::parse("certificate", &forged.to_string()).unwrap();
        assert!(read_witness(&document).is_err(), "{from}");
    }
}

const IN_THE_TRANSIENT: &str = "$`|u|`$ in the transient, against what the actuator takes";

/// Of each kind of claim: the checker agrees, and no member of it asks the actuator for more than it takes; told that it takes less, one does.
#[test]
fn from_the_set_the_actuator_never_saturates() {
    let gain = object!({ "nominal": "2", "low": "1.8", "high": "2.2" });
    let sampled = ("/internal_model/sampling_period", object!("1/1000"));
    for (name, members) in [
        (NAME, vec![actuator("26")]),
        (NAME, vec![actuator("30"), sampled]),
        (NAME, vec![actuator("15.5"), ("/input_gain", gain)]),
        ("plants/paper-example", vec![actuator("24")]),
        ("plants/linear", vec![actuator("1e6")]),
    ]
    .into_iter()
    .step_by(every(2))
    {
        let made = certificate(&text(name, &members));
        let answer = proofs_check::check(made.to_string().as_bytes());
        assert_eq!(answer.verdict, Answer::Valid, "{name}: {}", answer.text(false));
        let trials = count(2, 6).into();
        let outcome = tried(&made, trials, 3);
        let gain = number(&made["claim"]["sigma"]);
        let mut largest = 0.0_f64;
        for finding in &outcome.findings {
            let Finding::Holds { trial, shares } = finding else { panic!("{name}: {finding:?}") };
            assert!((trial.sigma / gain - 1.0).abs() < 1e-14);
            let share = shares.iter().find(|(quantity, _)| *quantity == IN_THE_TRANSIENT).unwrap().1;
            largest = largest.max(share);
        }
        assert!(largest <= 1.0 && (largest > 0.02 || name.ends_with("linear")), "{name}: {largest}");
        // Of what it asks for a tenth.
        let max = number(&members[0].1["max"]);
        let mut forged = made.clone();
        let less = format!("{:.9}", 0.5 * largest * max);
        let about = if forged.get("plant").is_some() { "plant" } else { "specification" };
        forged[about]["actuator"]["max"] = less.clone().into();
        forged["claim"]["actuator"]["max"] = less.into();
        let found = tried(&forged, trials, 3);
        let (_, violation) = found.counterexample().expect("it asks for more");
        assert_eq!(violation.quantity, IN_THE_TRANSIENT, "{name}");
    }
}

/// The bounds of the control and of the way hold for every member that is drawn, and are of the size of what is met.
#[test]
#[ignore = "search tier"]
fn the_bounds_of_the_control_are_no_larger_than_they_need_be() {
    let mut best = [0.0_f64; 2];
    for name in ["linear", NAME, "plants/linear", "plants/duffing"] {
        let made = certificate(&specification_text(name));
        let outcome = tried(&made, count(6, 250).into(), 5);
        assert!(outcome.counterexample().is_none(), "{name}");
        for closest in outcome.closest() {
            match closest.quantity {
                "$`sup|u|`$ of the periodic solution" => best[0] = best[0].max(closest.share),
                "$`|u - u_p|`$ in the transient, against its bound" => best[1] = best[1].max(closest.share),
                _ => {}
            }
        }
    }
    assert!(best[0] > 0.5 && best[1] > 0.2 && best.iter().all(|share| *share <= 1.0), "{best:?}");
}

fn written(folder: &Path, name: &str, text: &str) -> String {
    let path = folder.join(name);
    std::fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

fn report(arguments: &[&str]) -> (i32, Value) {
    let output = program().arg("certify").args(arguments).args(["--format", "json", "-q"]).output().unwrap();
    (output.status.code().unwrap(), json(&output.stdout))
}

/// The gain that is certified keeps what was asked for, hardly a smaller one does, and what cannot be kept is undecided.
#[test]
fn a_gain_that_keeps_to_limits() {
    let file = format!("specs/{NAME}.json");
    let (_, plain) = report(&[&file]);
    let least_gain = number(&plain["sigma_star"]);
    for (flag, asked, part) in [
        ("--steady-error", "1/100", "steady_error"),
        ("--peak-error", "0.9", "peak_error"),
        ("--max-control", "26", "control"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("certificate.json");
        let (code, kept) = report(&[&file, flag, asked, "-o", path.to_str().unwrap()]);
        assert_eq!(code, 0, "{flag}");
        let limit = if asked == "1/100" { 0.01 } else { asked.parse().unwrap() };
        let proved = number(&kept["limits"][part]["proved"]);
        assert!(proved <= limit * (1.0 + 1e-12) && proved > 0.99 * limit, "{flag}: {proved}");
        let gain = number(&kept["sigma_star"]);
        assert!(gain > least_gain && number(&kept["sigma_star_estimate"]) <= gain * 1.01, "{flag} {gain}");
        assert!(proofs_check::check(&std::fs::read(path).unwrap()).is_valid());
        // Just below it no proof that keeps it is found.
        let below = format!("{:.6}", 0.98 * gain);
        let (code, missed) = report(&[&file, flag, asked, "--sigma", &below]);
        assert_eq!((code, missed["verdict"].as_str().unwrap()), (3, "undecided"), "{flag}");
        assert!(missed["statement"].as_str().unwrap().contains("the least for which a proof is found is "));
        let (code, given) = report(&[&file, flag, asked, "--sigma", &format!("{:.6}", gain * 1.001)]);
        assert_eq!((code, &given["given_gain"]), (0, &object!(true)), "{flag}");
    }
    let (code, never) = report(&[&file, "--max-control", "1"]);
    assert_eq!(code, 3);
    assert!(never["statement"].as_str().unwrap().contains("|u| in the transient is not proved to be at most 1"));
    // Below what it is at the start no gain keeps it, in continuous time and at samples.
    let folder = tempfile::tempdir().unwrap();
    let started = text(NAME, &[("/initial_set", object!({ "kind": "at-rest", "X0": "1/10", "E0": "1/10" }))]);
    let started = written(folder.path(), "started.json", &started);
    for more in [&[][..], &["--sampling-period", "1/1000"]] {
        let (code, never) = report(&[&[started.as_str(), "--peak-error", "0.05"], more].concat());
        let said = never["statement"].as_str().unwrap();
        assert!(code == 3 && said.contains("cannot be kept at most 0.05 by any gain, because the initial set has |e| up to E0 = 0.1 at the start"), "{said}");
        assert_eq!(report(&[&[started.as_str(), "--peak-error", "1"], more].concat()).0, 0);
    }
    for wrong in ["0", "-1", "x", "sqrt(2)"] {
        program().args(["certify", &file, "--peak-error", wrong]).assert().code(2);
    }
    program().args(["certify", &file, "--witness", &file, "--max-control", "1"]).assert().code(2);
}

/// Each row is what `--sigma` certifies at that gain, or less.
#[test]
fn rows_of_larger_gains() {
    for (file, at_least) in [(format!("specs/{NAME}.json"), 5), ("specs/plants/linear.json".to_owned(), 2)] {
        let (_, whole) = report(&[&file]);
        let rows = whole["gains"].as_array().unwrap();
        assert!(rows.len() >= at_least, "{file}: {rows:?}");
        assert_eq!(rows[0]["sigma"], whole["sigma_star"]);
        let tried = if every(2) == 1 { rows.len() } else { at_least };
        for (at, row) in rows.iter().enumerate().take(tried).skip(1) {
            assert!(number(&row["sigma"]) > 1.19 * number(&rows[0]["sigma"]));
            let (code, own) = report(&[&file, "--sigma", row["sigma"].as_str().unwrap()]);
            assert_eq!(code, 0);
            let steady = number(&row["steady_error"][0]["sup"]);
            let of_claim = number(&own["periodic_solution"]["e"]);
            assert!((steady / of_claim - 1.0).abs() < 1e-3, "{file} {at}: {steady} {of_claim}");
            assert!(steady <= number(&rows[at - 1]["steady_error"][0]["sup"]) * (1.0 + 1e-9));
            let peak = number(&row["peak_error"]);
            assert!(peak <= (of_claim + number(&own["error_box"]["D_e"])) * (1.0 + 1e-3), "{file} {at}: {peak}");
        }
    }
    let (_, without) = report(&[&format!("specs/{NAME}.json"), "--no-alternatives"]);
    assert_eq!(without["gains"], object!([]));
}

/// The rates of rows are about those that `--sigma` proves at that gain: by norms, by matrices, and at samples, whose rows are what it certifies.
#[test]
fn rows_have_the_rates_that_are_asked_for() {
    let spec = format!("specs/{NAME}.json");
    let plant = "specs/plants/motor-axis.json";
    let cases: [(&[&str], usize); 3] = [(&[&spec], 6), (&[plant], 2), (&[&spec, "--sampling-period", "1/1000"], 6)];
    for (call, at_least) in cases.into_iter().take(if every(2) == 1 { 3 } else { 2 }) {
        let asked = [call, &["--n-o", "0,4"]].concat();
        let (_, whole) = report(&asked);
        let rows = whole["gains"].as_array().unwrap();
        assert!(rows.len() >= at_least, "{call:?}: {rows:?}");
        for own in [0, 1].map(|i| &whole["for_n_o"][i]) {
            assert!(
                rows[0]["rates"].as_array().unwrap().contains(&object!({ "n_o": own["n_o"], "rate": own["rate"] }))
            );
        }
        for row in rows[1..at_least].iter().step_by(every(3)) {
            let (code, own) = report(&[&asked[..], &["--sigma", row["sigma"].as_str().unwrap()]].concat());
            assert_eq!(code, 0);
            for (i, n_o) in [0, 4].into_iter().enumerate() {
                assert_eq!(row["rates"][i]["n_o"], n_o);
                let [rate, of_claim] = [&row["rates"][i], &own["for_n_o"][i]].map(|found| number(&found["rate"]));
                assert!((0.7..1.1).contains(&(rate / of_claim)), "{call:?} {}: {rate} {of_claim}", row["sigma"]);
            }
            if call.len() > 1 {
                let [e, e_per] = [&row["steady_error"][0]["sup"], &own["periodic_solution"]["e"]].map(number);
                assert!((e / e_per - 1.0).abs() < 1e-3, "{}: {e} {e_per}", row["sigma"]);
            }
        }
    }
    let (_, plain) = report(&[&spec]);
    assert!(plain["gains"][0].get("rates").is_none());
}

/// Code clips at the least double that is not below `max`: what is proved to stay within `max` never is clipped, whichever side the nearest double is on.
#[test]
fn code_clips_at_no_double_below_max() {
    let mut nearest_is_below = 0;
    for max in ["30", "26.5", "0.3", "30.1", "30.7", "1/3", "2/3", "1e-7", "123456789.123456789", "3*sqrt(2)", "10*pi"]
    {
        let actuator = with_max(max).actuator.unwrap();
        let (limit, exact) = (actuator.limit(), actuator.max.enclose(400));
        let of = |double: f64| Enclosure::from_rational(&Rational::from_f64(double).unwrap(), 400);
        assert!(of(limit).ge(&exact).is_true(), "{max}: {limit:?}");
        assert!(of(limit.next_down()).lt(&exact).is_true(), "{max}: {limit:?}");
        nearest_is_below += u32::from(of(exact.midpoint_f64()).lt(&exact).is_true());
    }
    assert!(nearest_is_below >= 3, "{nearest_is_below}");
    // In the exports, and in the code: 30.7 is between two doubles, of which the nearer one is below.
    let folder = tempfile::tempdir().unwrap();
    let file = written(folder.path(), "spec.json", &text(NAME, &[actuator("30.7")]));
    let call = ["controller", &file, "--sigma", "20", "--n-o", "1", "--discretise", "1/1000"];
    let made = json(&program().args(call).assert().success().get_output().stdout);
    let above = 30.7_f64.next_up();
    assert_eq!((&made["actuator"]["max"], &made["discrete"]["saturation"]), (&object!(above), &object!(above)));
    let notice = made["notice"].to_string();
    assert!(
        notice.contains(
            "|u| <= 30.700000000000003, the least double that is not below the 30.7 that the actuator takes. Ag"
        ),
        "{notice}"
    );
}

/// Exports clip, and say what the certificate says of that; another gain is refused.
#[test]
fn exports_clip_where_the_actuator_saturates() {
    let folder = tempfile::tempdir().unwrap();
    let sampled = ("/internal_model/sampling_period", object!("1/1000"));
    for (members, at_samples) in [(vec![actuator("30")], false), (vec![actuator("30"), sampled], true)] {
        let certificate = certificate(&text(NAME, &members));
        let file = written(folder.path(), "certificate.json", &certificate.to_string());
        let export = |more: &[&str]| {
            let mut call = program();
            call.args(["controller", &file, "--n-o", "3"]).args(more);
            call
        };
        let json_of = |more: &[&str]| json(&export(more).assert().success().get_output().stdout);
        let step = if at_samples { vec![] } else { vec!["--discretise", "1/1000"] };
        let made = json_of(&step);
        assert_eq!((&made["actuator"]["max"], &made["discrete"]["saturation"]), (&object!(30.0), &object!(30.0)));
        assert!(made["certificate"].get("sigma").is_some() && made["certificate"].get("sigma_star").is_none());
        let notice = made["notice"].to_string();
        let exactly = "From the set of the certificate what this law puts out, computed exactly and without noise, stays within that.";
        let elsewhere = "is proved of the law in continuous time, without noise, and not at samples.";
        let clipped = "u is clipped to |u| <= 30, the least double that is not below the 30 that the actuator takes. ";
        assert!(notice.contains(clipped), "{notice}");
        assert_eq!([exactly, elsewhere].map(|said| notice.contains(said)), [at_samples, !at_samples], "{notice}");
        // The saturation is in the claim about this law alone: one about the law in continuous time says nothing of its samples.
        assert_eq!(notice.contains("quantisation, or saturation"), !at_samples, "{notice}");
        let script =
            utf8(export(&[&step[..], &["--format", "matlab"]].concat()).assert().success().get_output().stdout.clone());
        assert!(script.contains("actuator_max = 30;") && script.contains("saturation = 30;"), "{script}");
        let c = folder.path().join("regulator.c");
        let call = [&step[..], &["--format", "c", "--force", "-o", c.to_str().unwrap()]].concat();
        export(&call).assert().success();
        assert!(std::fs::read_to_string(&c).unwrap().contains("if (u > limit)"));
        // The law in continuous time is the one of the claim.
        if !at_samples {
            let notice = json_of(&[])["notice"].to_string();
            assert!(
                notice.contains("Clip u to |u| <= 30, ") && notice.contains(exactly) && !notice.contains(elsewhere),
                "{notice}"
            );
        }
        // Another limit is outside of the claim, and another gain is not the one that is claimed.
        let other = json_of(&["--discretise", "1/1000", "--saturation", "20"]);
        assert!(other["certificate"].get("sigma").is_some());
        assert!(other.get("actuator").is_none() && other["discrete"]["saturation"] == 20.0);
        let notice = other["notice"].to_string();
        assert!(notice.contains("u is clipped to |u| <= 20. Against"), "{notice}");
        assert!(!notice.contains("stays within that") && notice.contains("quantisation, or saturation"), "{notice}");
        let refused = export(&[&step[..], &["--sigma", "300"]].concat()).assert().code(2);
        let told = utf8(refused.get_output().stderr.clone());
        assert!(told.contains(if at_samples { "another one" } else { "alone, and this is another gain" }), "{told}");
    }
}

/// A run in continuous time and at samples is cut off at what the actuator takes.
#[test]
fn simulations_saturate() {
    let folder = tempfile::tempdir().unwrap();
    let start = object!({ "x": [], "e": 10 });
    let plant = text("plants/linear", &[actuator("3"), ("/initial", start)]);
    let file = written(folder.path(), "plant.json", &plant);
    for sampled in [&[][..], &["--sampled", "1/500"]] {
        let csv = folder.path().join("run.csv");
        let call = ["simulate", &file, "--sigma", "2", "--n-o", "2", "--periods", "3", "--force", "--csv"];
        program().args(call).arg(&csv).args(sampled).output().unwrap();
        let rows = std::fs::read_to_string(&csv).unwrap();
        let column = rows.lines().next().unwrap().split(',').position(|name| name == "u").unwrap();
        let u: Vec<f64> =
            rows.lines().skip(1).map(|row| row.split(',').nth(column).unwrap().parse().unwrap()).collect();
        assert!(u.iter().all(|u| u.abs() <= 3.0) && u.iter().filter(|u| u.abs() == 3.0).count() > 20, "{sampled:?}");
    }
}
