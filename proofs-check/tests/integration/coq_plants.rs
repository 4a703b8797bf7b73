//! `--coq` of the certificates of plants: which values of the table are written, and, where coqc is installed, that Coq accepts what is
//! true and refuses what is not.

use crate::common::{names, parsed};
use crate::coq_support::{assert_accepted, assert_refused_at, coqc, every_case, plants, proofs, written};
use proofs_check::verdict::Verdict;
use serde_json::{Value, json};

fn certificate(name: &str) -> Value {
    parsed("plants", &format!("{name}.certificate"))
}

#[test]
fn the_values_are_those_that_the_conditions_take() {
    let norms = written(&certificate("paper-example-aligned"));
    for line in [
        "  b_fe := fun _ _ => 0.245159;",
        "  rate := Some (fun _ _ => 0.56735);",
        "  domain := Some (0.070876842, 0.28020764);",
        "  b_q_rms := None;",
        "  Z_0 := None;",
    ] {
        assert!(norms.lines().any(|other| other == line), "{line}");
    }
    assert!(norms.contains("canonical plant:") && norms.contains("the coordinates around its orbit"));
    // x first: df/dx and dq/dx at e_per, df/de and dq/de at X_b; none of them is that of (X_p, E_p).
    let entry = |e: &str, value: &str| format!("{{| up_to_X := 0.71601305; up_to_E := {e}; value := {value} |}}");
    let (at_dx, at_de) = ("0.28020764", "1.784896");
    let known = [
        format!("of_qx := {}; of_qe := {};", entry(at_dx, "1.17828"), entry(at_de, "0.971851")),
        format!(
            "by_norms {} {} (Some {})",
            entry(at_de, "0.894068"),
            entry(at_dx, "0.351596"),
            entry(at_de, "0.971851")
        ),
    ];
    known.iter().for_each(|part| assert!(norms.contains(part), "{part}"));
    let matrix = written(&certificate("pendulum"));
    let reach = "X_m := 0.74660118; E_m := 2.5115702; X_per_m := 0.74660118; E_per_m := 2.5115702;";
    assert!(matrix.contains(&format!("by_matrix {{| {reach} delta_m := 0.0000002; tau_m := 0.72864 |}}")));
    // e first: the periodic solution alone is kept to the X of the splitting.
    let splitting = written(&certificate("splitting"));
    assert!(splitting.contains("X_m := 0.25197836; E_m := 1.5937286; X_per_m := 0.0035685049; E_per_m := 1.5937286;"));
    // Without states there is a value for everything that is about them.
    let none = written(&certificate("no-states"));
    assert!(none.contains("  b_qx := fun _ _ => 0;") && none.contains("up_to_E := 3.998521; value := 0 |}"));
}

#[test]
fn a_value_that_is_missing_is_named() {
    let without = |name: &str, bound: &str| {
        let mut made = certificate(name);
        made["witness"]["bounds"].as_array_mut().unwrap().retain(|entry| entry["bound"] != bound);
        made
    };
    for bound in ["f_x", "f_e", "q_x", "q_e", "q_tx", "q_te", "rate", "rate_existence"] {
        let made = without("paper-example-aligned", bound);
        assert_refused_at(&made.to_string(), Verdict::Undecided, "/witness/bounds");
    }
    assert!(written(&without("paper-example-aligned", "q_e_max")).contains("  q_e_max := None;"));
    // (M) takes neither f_e nor a rate of stability, but f_e is one of existence.
    let mut made = certificate("pendulum");
    let stability = |entry: &Value| entry["X"] == "0.74660118" && (entry["bound"] == "f_e" || entry["bound"] == "rate");
    made["witness"]["bounds"].as_array_mut().unwrap().retain(|entry| !stability(entry));
    written(&made);
}

/// Of the matrices the numbers that conditions have are written: of p its length.
#[test]
fn the_numbers_of_the_matrices_are_written() {
    let joint = written(&certificate("joint"));
    for part in [
        "  existence := Some ({| X_i := 12.325293; E_i := 1.220157; tau_i := 3.98; form_i := two {| k_p := 4.512; c_x := 0.05; ",
        "  known := by_metrics {| X_j := 40.594799; E_j := 20.579692; tau_j := 3.98;\n",
        "near_m := {| k_p := 0.13271; c_x := 0.0002; c_e := 0.01; c_y := 0.000195 |}; ",
        "near_x := {| weight := 1.04709; cross := (sqrt 0.0233263994); P_up := 0.49749; x_low := 0.46584; e_low := 0.99999 |};",
        "far_x := {| weight := 1; cross := 0; P_up := 0.83734; x_low := 0.81023; e_low := 0.99999 |} |};",
    ] {
        assert!(joint.contains(part), "{part}");
    }
    let block = parsed("gain", "converter");
    let form = "tau_i := 1730.6784; form_i := one 0.0011692696 1.56 0.0000225823 |});";
    assert!(written(&block).contains(form) && written(&block).contains("gain := Some ({| low := (0.9 / 1); "));
    // Only a plant has formulas that a matrix could be about.
    let mut made = crate::common::certificate("linear.sharp");
    for name in ["existence_inequality", "joint_inequality"] {
        made["witness"][name] = certificate("joint")["witness"][name].clone();
        assert_refused_at(&made.to_string(), Verdict::BadInput, &format!("/witness/{name}"));
        made["witness"].as_object_mut().unwrap().remove(name);
    }
}

#[test]
fn coq_accepts_plants() {
    let Some(proofs) = proofs() else { return };
    let stored = plants().map(|name| ("plants", name)).chain(names("gain").into_iter().map(|name| ("gain", name)));
    for (of, name) in stored.filter(|(_, name)| every_case() || name == "joint.certificate") {
        let made = parsed(of, &name);
        assert_accepted(&name, coqc(proofs, &format!("{of}_{}", name.replace(['.', '-'], "_")), &made));
    }
}

#[test]
fn coq_refuses_of_plants_what_is_not() {
    let Some(proofs) = proofs() else { return };
    let refused = |of: &str, name: &str, edit: &dyn Fn(&mut Value), said: &str| {
        if !every_case() && name != "rate" {
            return;
        }
        let mut made = certificate(of);
        edit(&mut made);
        let answer = coqc(proofs, &format!("plant_{name}"), &made).expect_err(name);
        assert!(answer.contains("not proved") && answer.contains(said), "{name}: {answer}");
    };
    // A per cent below the gain; the conditions of existence fail first.
    refused("pendulum", "lowered", &|made| made["claim"]["sigma_star"] = json!("0.7256"), "damped cert");
    refused("splitting", "tau", &|made| made["witness"]["matrix_inequality"]["sigma"] = json!("0.93"), "tau_m");
    refused(
        "pendulum",
        "reach",
        &|made| made["witness"]["matrix_inequality"]["X"] = json!("0.7465"),
        "domain_of_decline",
    );
    let alter = |made: &mut Value, index: usize, name: &str, value: &str| {
        let entry = &mut made["witness"]["bounds"][index];
        assert_eq!(entry["bound"], name);
        entry["value"] = json!(value);
    };
    // A value of existence, and one of stability.
    refused("paper-example-aligned", "existence", &|made| alter(made, 7, "f_e", "0.246"), "<= X_p cert");
    refused("motor-axis", "rate", &|made| alter(made, 2, "rate", "100"), "a_2 cert");
    refused("pendulum", "transfer", &|made| made["witness"]["transfer"]["K"] = json!(1), "<= k_1 cert");
    // Below the threshold of both; then each of the numbers of stability and one of existence.
    refused("joint", "joint_lowered", &|made| made["claim"]["sigma_star"] = json!("3.96"), "3.98 <= 3.96");
    let of_stability: [(&str, &str, &str); 6] = [
        ("near/P_up", "0.55", "C4_of"),
        ("sigma", "4.1", "<= sigma cert"),
        ("X", "38", "X_b cert"),
        ("near/k_p", "0.16", "C4_of"),
        ("far/x_low", "0.4", "C4_of"),
        ("far/e_low", "0.9", "C4_of"),
    ];
    for (field, value, said) in of_stability {
        let name = format!("joint_{}", field.replace('/', "_"));
        let pointer = format!("/witness/joint_inequality/{field}");
        refused("joint", &name, &|made| *made.pointer_mut(&pointer).unwrap() = json!(value), said);
    }
    refused(
        "joint",
        "joint_c_y",
        &|made| made["witness"]["existence_inequality"]["near"]["c_y"] = json!("0.9"),
        "not proved",
    );
}
