//! Rules of section 12, each with a case beside it that passes.

use crate::common::{PAPER, assert_refused, assert_valid, certificate, rehash};
use crate::sampled_support::{answer, dead_beat, fails, holds, made, open, refuses};
use proofs_check::check;
use proofs_check::verdict::Verdict::{BadInput, Invalid, Undecided, Valid};
use serde_json::{Value, json};

const LAW: &str = "sampled regulator";

#[test]
fn claims_that_are_true() {
    for certificate in [made(), dead_beat()] {
        let report = answer(certificate, &[]);
        assert_eq!(report.verdict, Valid, "{}", report.text(false));
    }
    // Nothing rests on the embedded sampling period, but where it is given it must be that of the claim.
    holds(made(), &[("/specification/internal_model/sampling_period", Value::Null)]);
    holds(made(), &[("/claim/periodic_solution/z", Value::Null)]);
    holds(made(), &[("/claim/sampling_period", json!("0.005")), ("/claim/sigma", json!("60.0"))]);
}

#[test]
fn the_law() {
    // h sigma = 1 is the largest.
    let over = [("/claim/sigma", json!("100.0000001"))];
    refuses(dead_beat(), &over, Invalid, LAW, "/claim");
    let report = answer(dead_beat(), &over);
    assert!(report.finding.unwrap().message.contains("S0, h sigma <= 1"));
    // The sum of all weights is 4.612375348685...
    holds(made(), &[("/witness/weight_sum", json!("4.6123753487"))]);
    refuses(made(), &[("/witness/weight_sum", json!("4.61239"))], Invalid, LAW, "/claim");
    refuses(made(), &[("/witness/weight_sum", json!("4.6123753486"))], Invalid, LAW, "/claim");
    refuses(made(), &[("/witness/weight_sum", json!("2.98"))], Invalid, LAW, "/claim");
    // A K for another mu; mu may be off by 1e-6.
    holds(made(), &[("/claim/gain", json!("0.9886008"))]);
    for gain in ["0.988602", "0.988599", "1", "0.5", "80", "86.7", "87"] {
        refuses(made(), &[("/claim/gain", json!(gain))], Invalid, LAW, "/claim");
    }
    let message = |gain: &str| answer(made(), &[("/claim/gain", json!(gain))]).finding.unwrap().message;
    assert!(message("86.7").contains("S0d") && message("87").contains("S0c"));
    refuses(made(), &[("/specification/internal_model/mu", json!("1.000002"))], Invalid, LAW, "/claim");
    for (name, value) in [("sigma", "0"), ("sigma", "-1"), ("gain", "0"), ("gain", "-1")] {
        let pointer = format!("/claim/{name}");
        refuses(made(), &[(&pointer, json!(value))], Invalid, "signs", &pointer);
    }
}

#[test]
fn the_sampling_period_is_exact() {
    let both = |sampling: &str, samples: u32| {
        [
            ("/claim/sampling_period", json!(sampling)),
            ("/specification/internal_model/sampling_period", json!(sampling)),
            ("/claim/samples", json!(samples)),
        ]
    };
    let place = "/claim/sampling_period";
    for samples in [199, 201, 100, 400, 2] {
        let report = answer(made(), &[("/claim/samples", json!(samples))]);
        assert_eq!(report.verdict, Invalid, "{samples}");
    }
    // A gain that is right for either number of samples: then it is the number alone that is wrong.
    let gain = ("/claim/gain", json!("0.98865692"));
    refuses(made(), &[("/claim/samples", json!(201)), gain], Invalid, LAW, place);
    refuses(made(), &[(place, json!("1/201"))], Invalid, LAW, place);
    refuses(made(), &[(place, json!("0.0050000001"))], Invalid, "specification", place);
    refuses(made(), &[(place, json!("exp(log(1/200))"))], Undecided, "specification", place);
    refuses(made(), &[(place, json!("pi/600"))], Invalid, "specification", place);
    refuses(made(), &both("1", 1), Invalid, "specification", "/specification/internal_model/sampling_period");
    refuses(made(), &both("3/400", 133), Invalid, "specification", "/specification/internal_model/sampling_period");
    let asked = "/specification/internal_model/sampling_period";
    refuses(made(), &[(asked, json!("1/400"))], Invalid, LAW, place);
    for samples in [json!(0), json!(1)] {
        refuses(made(), &[("/claim/samples", samples)], Invalid, LAW, "/claim");
    }
    for samples in [json!("200"), json!(200.5), json!(-200), Value::Null] {
        refuses(made(), &[("/claim/samples", samples)], BadInput, "format", "/claim");
    }
}

#[test]
fn many_samples_are_decided_and_too_many_are_not() {
    let samples = |n: u32| {
        let text = format!("1/{n}");
        // mu = K (1 + theta), theta = h mu Nb2/2.
        let gain = 1.0 / (1.0 + 4.6123753533 / (2.0 * f64::from(n)));
        vec![
            ("/claim/sampling_period", json!(text)),
            ("/specification/internal_model/sampling_period", json!(text)),
            ("/claim/samples", json!(n)),
            ("/claim/gain", json!(format!("{gain:.15}"))),
        ]
    };
    for n in [400, 8192, 8193, 65_536] {
        let report = answer(made(), &samples(n));
        assert_eq!(report.verdict, Valid, "{n}: {}{:?}", report.text(false), open(&report));
        assert!(report.steps < proofs_check::effort::LIMIT / 10 * 3, "{n}: {} steps", report.steps);
    }
    for n in [65_537, 999_999_999] {
        refuses(made(), &samples(n), Undecided, LAW, "/claim");
        assert!(answer(made(), &samples(n)).steps < proofs_check::effort::LIMIT / 10, "no sums are formed");
    }
}

#[test]
fn a_sampling_period_in_continuous_time_changes_nothing() {
    let with = |sampling: Value, matched: bool| {
        let mut certificate = certificate(PAPER);
        certificate["specification"]["internal_model"]["sampling_period"] = sampling;
        certificate["specification"]["internal_model"]["matched"] = json!(matched);
        rehash(&mut certificate);
        check(certificate.to_string().as_bytes())
    };
    for sampling in ["1/2", "0.001", "1/3", "1e-12", "sqrt(4)/200"] {
        assert_valid(&with(json!(sampling), true));
    }
    let place = "/specification/internal_model/sampling_period";
    for sampling in ["1", "2", "0.3", "2/3", "pi/10", "-1/2", "0"] {
        assert_refused(&with(json!(sampling), true), Invalid, "specification", place);
    }
    assert_refused(&with(json!("1/2"), false), Invalid, "specification", place);
    assert_refused(&with(json!("cos(1)^2/2 + sin(1)^2/2"), true), Undecided, "specification", place);
    for sampling in [json!(true), json!(["1/2"]), json!("1/t"), json!("")] {
        assert_refused(&with(sampling, true), BadInput, "format", place);
    }
}

#[test]
fn the_pair_of_the_transfer_bound() {
    let pair = |k0: &str, k1: &str| [("/witness/k0", json!(k0)), ("/witness/k1", json!(k1))];
    // At j = 0, at j = 1, and at j = 2 alone; Z grows with the pair, and with it the set that is asked for.
    refuses(made(), &pair("19.7392", "59.2225563058"), Invalid, LAW, "/witness/k0");
    refuses(made(), &pair("19.7392088419", "59.222"), Invalid, LAW, "/witness/k0");
    let sizes = ("/claim/periodic_solution/zeta", json!("6.92"));
    let sizes = [sizes, ("/claim/periodic_solution/z", json!("7.17"))];
    holds(made(), &[&pair("19.73922", "59.22255")[..], &sizes].concat());
    let two = |k1: &str| answer(made(), &pair("60", k1));
    assert!(two("40.9").verdict == Invalid && open(&two("40.9"))[0].starts_with("set"));
    assert!(two("40.8").finding.unwrap().message.contains("at j = 2"));
    let report = answer(made(), &pair("19.7392088419", "0"));
    assert!(report.finding.unwrap().message.contains("at j = 1"));
    refuses(made(), &pair("19.8", "-1"), Invalid, "signs", "/witness/k1");
    refuses(made(), &[("/witness/transfer/proof", json!("matched"))], BadInput, "format", "/witness/transfer");
    refuses(made(), &[("/witness/transfer/K", json!(2))], BadInput, "format", "/witness/transfer/K");
}

#[test]
fn existence() {
    let at = |name: &str, value: &str| (format!("/witness/{name}"), json!(value));
    let wrong = |name: &str, value: &str, ids: &[&str]| {
        let (pointer, value) = at(name, value);
        fails(made(), &[(&pointer, value)], ids);
    };
    wrong("r_x", "0.031159", &["S1c"]);
    wrong("r_e", "0.065077", &["S2b"]);
    wrong("r_d", "0.41036", &["S2c"]);
    wrong("E_p", "0.115", &["S2 "]);
    for name in ["X_p", "E_p", "r_x", "r_e", "r_d", "D_x", "D_e", "w_x", "h", "k0"] {
        for value in ["0", "-1"] {
            let (pointer, value) = at(name, value);
            refuses(made(), &[(&pointer, value)], Invalid, "signs", &pointer);
        }
    }
    // A rate that is no damping.
    let report = answer(made(), &[("/specification/lyapunov/alpha", json!("0.004"))]);
    assert!(report.verdict == Invalid && open(&report)[0].starts_with("S1 "), "{:?}", open(&report));
    // Harmonics bound q, not the response to them: R_q and R_1 gain, and nothing else is used.
    let q_0 = |rest: &str| {
        let value = json!({ "harmonics": ["1.8756", "0.79156", "0.49414", "0.12493", "0.062502"], "rest_rms": rest, "rest_t_rms": "1e-3" });
        ("/specification/q_0", value)
    };
    let less = [("/witness/r_e", json!("0.05"))];
    holds(made(), &[&less[..], &[q_0("1e-5")]].concat());
    fails(made(), &less, &["S2b"]);
    fails(made(), &[&less[..], &[q_0("1")]].concat(), &["S2b"]);
    let bends = [("/specification/bounds/q_tx", json!("0")), ("/specification/bounds/q_te", json!("2.106"))];
    let less = [("/witness/r_e", json!("0.05")), ("/witness/r_d", json!("0.3")), ("/witness/E_p", json!("0.1"))];
    holds(made(), &[&less[..], &bends, &[q_0("1e-5")]].concat());
    fails(made(), &[&less[..], &[q_0("1e-5")]].concat(), &["S2 ", "S2c"]);
}

#[test]
fn stability() {
    let with = |name: &str, value: &str| [(format!("/witness/{name}"), json!(value))];
    let wrong = |name: &str, value: &str, ids: &[&str]| {
        let [(pointer, value)] = with(name, value);
        fails(made(), &[(&pointer, value)], ids);
    };
    wrong("D_x", "0.6559", &["C4"]);
    wrong("D_e", "2.6172", &["C4"]);
    // One of the two forms alone.
    wrong("h", "0.0064", &["C5h FAILS: 0 < minor 3 of Q_h"]);
    holds(made(), &[("/witness/h", json!("0.0069"))]);
    wrong("h", "0.001", &["C5h FAILS: 0 < minor 3 of Q_0", "C5h FAILS: 0 < minor 3 of Q_h"]);
    let report = answer(made(), &[("/witness/w_x", json!("44.4"))]);
    let found = open(&report);
    assert!(found.len() == 2 && found[0].starts_with("C4") && found[1].contains("minor 3 of Q_0"), "{found:?}");
    // A steep q moves far within a step.
    let steep = [("/specification/bounds/q_e", json!("700 + X")), ("/specification/bounds/q_e_max", json!("-690 + X"))];
    let found = open(&answer(made(), &steep));
    assert!(found.iter().any(|line| line.contains("0 < 1 - h k_e/pi")), "{found:?}");
    // -b_qe <= q_e_max is asked for.
    let most = |value: &str| answer(made(), &[("/specification/bounds/q_e_max", json!(value))]);
    assert!(most("-2").verdict == Invalid && open(&most("-2"))[0].starts_with("M "));
    assert_eq!(most("0").verdict, Valid);
}

#[test]
fn domain_and_bounding_functions() {
    let domain = |x: &str, e: &str| answer(made(), &[("/specification/domain", json!({ "X": x, "E": e }))]);
    assert_eq!(domain("0.6876", "2.7323").verdict, Valid);
    for (x, e) in [("0.6875", "3"), ("1", "2.7322")] {
        let report = domain(x, e);
        assert!(report.verdict == Invalid && open(&report)[0].starts_with("domain"), "{:?}", open(&report));
    }
    let place = "/specification/bounds/q_x";
    holds(made(), &[("/specification/domain", Value::Null)]);
    let wrong = [("/specification/domain", Value::Null), (place, json!("sqrt(1 + E^2) - X/100"))];
    refuses(made(), &wrong, Invalid, "bounding functions", place);
}

#[test]
fn the_claimed_set_and_sizes() {
    for (name, value) in [("X0", "0.0644"), ("E0", "0.2301"), ("Z0", "14.317")] {
        fails(made(), &[(&format!("/claim/initial_set/{name}"), json!(value))], &["set"]);
    }
    for (name, large, small) in [
        ("x", "0.0315844", "0.0315843"),
        ("e", "0.1150012", "0.1150010"),
        ("zeta", "6.911845", "6.911844"),
        ("z", "7.158827", "7.158826"),
    ] {
        let pointer = format!("/claim/periodic_solution/{name}");
        holds(made(), &[(&pointer, json!(large))]);
        refuses(made(), &[(&pointer, json!(small))], Invalid, "claim", &pointer);
    }
    refuses(made(), &[("/claim/periodic_solution/zeta", Value::Null)], BadInput, "format", "/claim/periodic_solution");
}
