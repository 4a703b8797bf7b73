//! A period that is known to an interval: claims about specifications and stored ones about plants, with each of their parts forged,
//! and where it is not available.

use super::coq_support::assert_refused_at;
use super::families::interval;
use super::plant_certificates::stored;
use super::plant_mutations::mutate;
use crate::common::{
    BOXES, assert_refused, assert_valid, assert_words_are_ignored, certificate, edited, every, folder, judged, open,
    rehash, said,
};
use proofs_check::Report;
use proofs_check::constant::Constant;
use proofs_check::data::Data;
use proofs_check::interval::Interval;
use proofs_check::json::{Field, parse};
use proofs_check::period::Period;
use proofs_check::verdict::Verdict::{self, BadInput, Invalid, Undecided, Valid};
use rug::Rational;
use serde_json::{Value, json};

const RULE: &str = "period";

/// Without `q_0` every bound takes the longest period, so what is proved of T = 1 is proved of the interval.
const INTERVAL: [&str; 3] = ["0.99", "0.9", "1"];

/// The claim of a specification that is proved by boxes, for every frequency, with this period.
fn with(period: Value) -> Value {
    let mut made = certificate(BOXES);
    made["constants"] = json!({});
    made["specification"]["internal_model"]["matched"] = json!(false);
    made["specification"]["period"] = period.clone();
    if period.is_object() {
        made["claim"]["period"] = period;
    }
    let without = [("/comparison", Value::Null), ("/witness/exact_regulation", Value::Null)];
    let mut made = edited(made, &without);
    rehash(&mut made);
    made
}

fn made() -> Value {
    with(interval(INTERVAL))
}

/// A claim about a plant with a period that is an interval, and joint metrics; that of `converter` has those of existence too.
fn of_plant(name: &str) -> Value {
    serde_json::from_str(&std::fs::read_to_string(folder("periods").join(format!("{name}.json"))).unwrap()).unwrap()
}

/// The answer after the changes, with the digest made right.
fn answer(made: Value, changes: &[(&str, Value)]) -> Report {
    let mut made = edited(made, changes);
    rehash(&mut made);
    judged(&made)
}

#[track_caller]
fn refused(made: Value, changes: &[(&str, Value)], verdict: Verdict, rule: &str, pointer: &str) {
    assert_refused(&answer(made, changes), verdict, rule, pointer);
}

#[track_caller]
fn valid(made: Value, changes: &[(&str, Value)]) -> Report {
    let report = answer(made, changes);
    assert_eq!(report.verdict, Valid, "{:?} {}", open(&report), report.text(false));
    report
}

#[test]
fn a_claim_about_every_period() {
    let report = judged(&made());
    assert_valid(&report);
    let subject = report.subject.as_ref().unwrap();
    let said = "with every period in [0.9, 1] (one constant T; nominal 0.99), mu = 1";
    assert!(subject.statement.contains(said), "{}", subject.statement);
    let assumed = "T is one constant in [0.9, 1], and time enters the plant through the phase";
    assert!(subject.assumed.iter().any(|line| line.contains(assumed)), "{:?}", subject.assumed);
    // The conditions of the longest period, to the last digit.
    let exact = valid(with(json!("1")), &[]);
    let conditions = |report: &Report| -> Vec<String> {
        report.lines.iter().filter(|line| line.contains(" holds: ")).cloned().collect()
    };
    assert!(conditions(&report).len() > 8 && conditions(&report) == conditions(&exact));
    // A longer one breaks them, whatever the nominal and the shortest are.
    for period in [["0.99", "0.9", "1.01"], ["1.01", "1.01", "1.02"], ["1.005", "0.5", "1.01"]] {
        refused(with(interval(period)), &[], Invalid, "sharp", "/witness");
    }
    // With an interval of the input gain the words of both.
    let gain = interval(["2", "2", "4/2"]);
    let both = valid(made(), &[("/specification/input_gain", gain.clone()), ("/claim/input_gain", gain)]);
    let statement = &both.subject.as_ref().unwrap().statement;
    assert!(
        statement.contains("divides its control by the nominal gain 2), with every period in [0.9, 1]"),
        "{statement}"
    );
}

#[test]
fn claim_and_file_name_the_same_interval() {
    for (name, others) in [("low", ["0.8", "0.95"]), ("high", ["0.995", "1.2"]), ("nominal", ["0.98", "1"])] {
        for other in others {
            let at = format!("/claim/period/{name}");
            refused(made(), &[(&at, json!(other))], Invalid, RULE, &at);
            // Of the file alone, with its words: a period that is proved too is no period that is claimed.
            let here = format!("/specification/period/{name}");
            let report = answer(made(), &[(&here, json!(other))]);
            assert_eq!(report.verdict, Invalid, "{name} {other}");
            if name != "high" {
                assert_refused(&report, Invalid, RULE, &at);
            }
        }
    }
    valid(made(), &[("/claim/period/low", json!("9/10"))]);
    refused(made(), &[("/claim/period", Value::Null)], Invalid, RULE, "/claim");
    refused(made(), &[("/claim/period/low", Value::Null)], BadInput, "format", "/claim/period");
    refused(made(), &[("/claim/period/mean", json!("1"))], BadInput, "format", "/claim/period/mean");
    refused(made(), &[("/specification/period", json!("1"))], Invalid, RULE, "/claim/period");
    refused(with(json!("1")), &[("/claim/period", interval(INTERVAL))], Invalid, RULE, "/claim/period");
    let statement = made()["claim"]["statement"].as_str().unwrap().replace("[0.9, 1]", "[0.8, 1]");
    assert_words_are_ignored(&made(), &format!("{statement} "));
}

#[test]
fn intervals_that_are_none_are_refused() {
    let at = "/specification/period";
    for (period, verdict, rule, place) in [
        (["0.8", "0.9", "1"], Invalid, RULE, ""),
        (["1.1", "0.9", "1"], Invalid, RULE, ""),
        (["0.95", "1", "0.9"], Invalid, RULE, ""),
        (["0.5", "0", "1"], Invalid, "specification", "/low"),
        (["0.5", "-1", "1"], Invalid, "specification", "/low"),
        (["0.5", "t", "1"], BadInput, "format", "/low"),
        (["0.5", "1/(1 - 1)", "1"], BadInput, "format", "/low"),
    ] {
        refused(with(interval(period)), &[], verdict, rule, &format!("{at}{place}"));
    }
    refused(with(json!({ "nominal": "0.95", "low": "0.9" })), &[], BadInput, "format", at);
    let more = json!({ "nominal": "0.95", "low": "0.9", "high": "1", "mean": "1" });
    refused(with(more), &[], BadInput, "format", "/specification/period/mean");
}

/// It may match then, and a claim does not name it.
#[test]
fn an_interval_of_one_point_is_that_number() {
    let mut made = certificate(BOXES);
    let one = interval(["1", "1.0", "2/2"]);
    made["specification"]["period"] = one.clone();
    rehash(&mut made);
    let report = judged(&made);
    assert_valid(&report);
    assert!(said(&report).contains("with period T = 1, mu"), "{}", report.text(false));
    assert_refused(&judged(&edited(made, &[("/claim/period", one)])), Invalid, RULE, "/claim/period");
}

#[test]
fn what_needs_one_period_is_refused() {
    let model = "/specification/internal_model";
    let matched = format!("{model}/matched");
    refused(made(), &[(&matched, json!(true))], BadInput, "format", &matched);
    let sampling = format!("{model}/sampling_period");
    refused(made(), &[(&sampling, json!("0.01"))], BadInput, "format", &sampling);
    let exact = certificate(BOXES)["witness"]["exact_regulation"].clone();
    let regulation = "/witness/exact_regulation";
    refused(made(), &[(regulation, exact)], Invalid, "exact regulation", regulation);
    let proof = json!({ "proof": "matched", "K": 3 });
    refused(made(), &[("/witness/transfer", proof)], Invalid, "transfer bound", "/witness/transfer");
    assert_refused_at(&made().to_string(), Undecided, "/specification/period");
    assert_refused_at(&of_plant("motor-axis").to_string(), Undecided, "/plant/period");
    // At samples, where nothing says that it matches.
    let samples = |matched: bool| {
        let mut made = stored("converter-samples");
        made["plant"]["period"] = interval(["1/50", "1/51", "1/50"]);
        made["plant"]["internal_model"]["matched"] = json!(matched);
        drop(made["plant"]["internal_model"].as_object_mut().unwrap().remove("sampling_period"));
        made["plant"]["q"] = json!(made["plant"]["q"].as_str().unwrap().replace("100*pi*t", "phase"));
        made["plant"]["q"] = json!(made["plant"]["q"].as_str().unwrap().replace("300*pi*t", "3*phase"));
        made["plant"]["f"][1] = json!(made["plant"]["f"][1].as_str().unwrap().replace("100*pi*t", "phase"));
        made["claim"]["period"] = made["plant"]["period"].clone();
        made["witness"]["orbit"]["sensitivities"] = json!([{ "mean": ["0", "0"] }]);
        made["witness"]["forcing"]["sensitivities"] = json!([{ "mean": "0" }]);
        answer(made, &[])
    };
    assert_refused(&samples(true), BadInput, "format", "/plant/internal_model/matched");
    assert_eq!(samples(false).verdict, Invalid, "{}", samples(false).text(false));
}

/// v = T_nom/T: exact where the quotients are rational, else rounded outward.
#[test]
fn the_clock() {
    let period = |[nominal, low, high]: [&str; 3]| {
        let json = parse(json!({ "period": interval([nominal, low, high]) }).to_string().as_bytes()).unwrap();
        Period::read(&mut Field { json: &json, pointer: String::new() }.fields().unwrap(), &[]).unwrap()
    };
    let clock = |of: [&str; 3]| period(of).clock("").unwrap().unwrap();
    let ratio = |n, m| Rational::from((n, m));
    for (of, ends) in [
        (["1/50", "1/50.5", "1/49.5"], [ratio(99, 100), ratio(101, 100)]),
        (["pi", "3*pi/4", "2*pi"], [ratio(1, 2), ratio(4, 3)]),
        (["sqrt(2)", "sqrt(2)", "sqrt(8)"], [ratio(1, 2), ratio(1, 1)]),
    ] {
        let clock = clock(of);
        assert_eq!((clock.ends, clock.nominal), (ends, ratio(1, 1)), "{of:?}");
    }
    // 22/7 over sqrt(10) and over pi.
    let [low, high] = clock(["22/7", "pi", "sqrt(10)"]).ends;
    let (square, least) = (Rational::from(low.square_ref()) * 10u32, ratio(22 * 22, 49));
    let tiny = Rational::from((1, 1_i64 << 62));
    assert!(square < least && square > least.clone() - tiny.clone(), "{low}");
    let pi = Interval::pi(2000);
    let product = Interval::rational(&high, 2000) * &pi;
    let [end, beyond] = [ratio(22, 7), ratio(22, 7) + tiny].map(|value| Interval::rational(&value, 2000));
    assert_eq!((end.lt(&product), product.lt(&beyond)), (Some(true), Some(true)));
    assert!(period(["1", "1", "1.0"]).clock("").unwrap().is_none());
}

/// What a rule may take: the longest, Om of it, Om of the shortest; of an interval no other.
#[test]
fn the_ends_of_an_interval() {
    let [interval, exact] = [interval(["3", "2", "4"]), json!("3")].map(|period| {
        let json = parse(json!({ "period": period }).to_string().as_bytes()).unwrap();
        Period::read(&mut Field { json: &json, pointer: String::new() }.fields().unwrap(), &[]).unwrap()
    });
    let ends = interval.ends(128);
    let near = |value: &Interval, expected: f64| (value.lo().to_f64() - expected).abs() < 1e-15;
    let half_pi = std::f64::consts::FRAC_PI_2;
    assert!(near(ends.longest(), 4.0) && near(&ends.slowest(), half_pi) && near(&ends.fastest(), 2.0 * half_pi));
    assert!(!ends.only().is_defined() && interval.exact().is_none());
    let ends = exact.ends(128);
    assert!(near(ends.longest(), 3.0) && near(&ends.only(), 3.0));
    assert!(near(&ends.slowest(), 2.0 * std::f64::consts::PI / 3.0));
    assert!(near(&ends.fastest(), 2.0 * std::f64::consts::PI / 3.0));
    assert_eq!(exact.exact().and_then(Constant::rational), Some(Rational::from(3)));
}

#[test]
fn certificates_of_plants_are_valid() {
    for (name, low, high) in [("motor-axis", "1/50.3", "1/49.75"), ("converter", "1/50.05", "1/49.95")] {
        let report = valid(of_plant(name), &[]);
        let said = format!("with every period in [{low}, {high}] (one constant T; nominal 1/50)");
        assert!(report.subject.as_ref().unwrap().statement.contains(&said), "{}", report.text(false));
        let proved = |rule: &str| report.lines.iter().any(|line| line.starts_with(rule) && line.contains("boxes"));
        assert!(proved("joint inequality") && proved("existence inequality") == (name == "converter"));
        assert!(report.steps < 10_000_000, "{name}: {}", report.steps);
    }
}

/// One period, and oscillators at another frequency; the phase may be written for it too.
#[test]
fn a_plant_whose_oscillators_are_mistuned() {
    for (name, frequency) in [("motor-axis", "99.9*pi"), ("converter", "99.9999*pi")] {
        let exact = [
            ("/plant/period", json!("1/50")),
            ("/claim/period", Value::Null),
            ("/witness/orbit/sensitivities", Value::Null),
            ("/witness/forcing/sensitivities", Value::Null),
        ];
        let mistuned = |frequency: &str, proof: Value| {
            let mut made = edited(of_plant(name), &exact);
            made["plant"]["internal_model"]["base_frequency"] = json!(frequency);
            made["witness"]["transfer"] = proof;
            answer(made, &[])
        };
        let closed_form = || json!({ "proof": "closed-form" });
        let report = mistuned(frequency, closed_form());
        assert_eq!(report.verdict, Valid, "{name}: {:?} {}", open(&report), report.text(false));
        // The transfer constants are those of this frequency, and of no proof that needs the other.
        assert_refused(&mistuned("101*pi", closed_form()), Invalid, "transfer bound", "/witness/transfer");
        let matched = json!({ "proof": "matched", "K": 3 });
        assert_refused(&mistuned(frequency, matched), Invalid, "transfer bound", "/witness/transfer");
    }
}

#[test]
fn forged_certificates_of_plants() {
    let both = |made: Value, [nominal, low, high]: [&str; 3]| {
        let period = interval([nominal, low, high]);
        answer(made, &[("/plant/period", period.clone()), ("/claim/period", period)])
    };
    for (name, wider) in [
        ("motor-axis", ["1/50", "1/51", "1/49.75"]),
        ("motor-axis", ["1/50", "1/50.3", "1/49"]),
        ("converter", ["1/50", "1/50.4", "1/49.95"]),
        ("converter", ["1/50", "1/50.05", "1/49.5"]),
    ] {
        assert_eq!(both(of_plant(name), wider).verdict, Invalid, "{name} {wider:?}");
        let period = interval(wider);
        let in_claim = answer(of_plant(name), &[("/claim/period", period.clone())]);
        assert_refused(&in_claim, Invalid, RULE, "/claim/period");
        assert_eq!(answer(of_plant(name), &[("/plant/period", period)]).verdict, Invalid, "{name} {wider:?}");
    }
    // Narrower in both it holds; about another middle it does not.
    assert_eq!(both(of_plant("motor-axis"), ["1/50", "1/50.2", "1/49.9"]).verdict, Valid);
    assert_refused(&both(of_plant("motor-axis"), ["1/50.1", "1/50.3", "1/49.9"]), Invalid, "orbit", "/witness/orbit");
    for name in ["motor-axis", "converter"] {
        for (part, first) in [("orbit", "orbit"), ("forcing", "forcing")] {
            let list = format!("/witness/{part}/sensitivities");
            for wrong in [Value::Null, json!([])] {
                refused(of_plant(name), &[(&list, wrong)], BadInput, "format", &format!("/witness/{part}"));
            }
            let states = of_plant(name)["plant"]["states"].as_array().unwrap().len();
            let still = if part == "orbit" { json!([{ "mean": vec!["0"; states] }]) } else { json!([{ "mean": "0" }]) };
            refused(of_plant(name), &[(&list, still)], Invalid, first, &format!("/witness/{part}"));
            let opposite = of_plant(name).pointer(&format!("{list}/0/harmonics/0/sin")).unwrap().to_string();
            let opposite: Value = serde_json::from_str(&match opposite.contains("\"-") {
                true => opposite.replace("\"-", "\""),
                false => opposite.replacen('"', "\"-", 1),
            })
            .unwrap();
            refused(
                of_plant(name),
                &[(&format!("{list}/0/harmonics/0/sin"), opposite)],
                Invalid,
                first,
                &format!("/witness/{part}"),
            );
        }
    }
    let q = of_plant("motor-axis")["plant"]["q"].as_str().unwrap().replace("2*phase", "200*pi*t");
    refused(of_plant("motor-axis"), &[("/plant/q", json!(q))], BadInput, "format", "/plant/q");
    let half = of_plant("motor-axis")["plant"]["q"].as_str().unwrap().replace("2*phase", "phase/2");
    refused(of_plant("motor-axis"), &[("/plant/q", json!(half))], Invalid, "periodicity", "/plant/q");
}

#[test]
fn leaves_of_certificates_of_plants() {
    mutate("periods/motor-axis", every(23));
    mutate("periods/converter", every(47));
}

/// The bounds of a claim about a plant grow with its longest period, and its harmonics with the shortest.
#[test]
fn conditions_of_a_plant_take_both_ends() {
    let made = of_plant("motor-axis");
    let sides = |period: Value| {
        let json = parse(edited(made.clone(), &[("/plant/period", period)])["plant"].to_string().as_bytes()).unwrap();
        let witness = parse(made["witness"].to_string().as_bytes()).unwrap();
        let field = |json, pointer: &str| Field { json, pointer: pointer.to_owned() };
        let mut fields = field(&witness, "/witness").fields().unwrap();
        proofs_check::plants::read::read(&field(&json, "/plant"), &mut fields).unwrap().0
    };
    let spec = sides(interval(["1/50", "1/60", "1/40"]));
    let d = Data::new(&spec, 128);
    let answer = proofs_check::rules::control::Answer::continuous(&d);
    assert!((answer.by_rate.lo().to_f64() * 3.0 * 40.0 - 1.0).abs() < 1e-12);
    let (harmonics, _) = proofs_check::rules::gains::forcing(&d, spec.q_0.as_ref().unwrap());
    // At v = 60/50 the harmonic of the cosine is (1490.9396 + 0.2 * 3.8343, 5.768 - 0.2 * 8.2090), at 4/5 the other way.
    let size = |v: f64| (1490.939632991 + v * 3.83433936).hypot(5.768008783 - v * 8.209025034) / 2.0;
    let largest = f64::max(size(0.2), size(-0.2));
    assert!((harmonics[1].lo().to_f64() / largest - 1.0).abs() < 1e-9, "{:?}", harmonics[1]);
}
