//! Rates and noise at samples (docs/mathematics.md, section 13.6, Proposition R_h): what is particular to them.

use crate::common::{accepted, assert_refused, edited, judged, names, parsed, without};
use crate::noise::stored;
use crate::rates::{each_refused, refused, signs_are_demanded_at};
use proofs_check::verdict::Verdict::{BadInput, Invalid};
use serde_json::{Value, json};

fn sampled() -> Vec<String> {
    names("noise").into_iter().filter(|name| name.starts_with("sampled")).collect()
}

#[test]
fn each_number_of_a_rate_matters() {
    for name in sampled() {
        let certificate = stored(&name);
        for i in 0..certificate["claim"]["for_n_o"].as_array().unwrap().len() {
            let (claim, witness) = (format!("/claim/for_n_o/{i}"), format!("/witness/for_n_o/{i}"));
            let pi = format!("{witness}/Pi");
            let mut changes = vec![
                (format!("{claim}/rate"), 1.001, format!("{claim}/rate")),
                (format!("{claim}/factor"), 1.0 - 1e-4, format!("{claim}/factor")),
                (format!("{witness}/c"), 0.99, format!("{claim}/rate")),
                (format!("{witness}/c"), 5.0, pi.clone()),
                (format!("{witness}/e_low"), 1.5, format!("{witness}/e_low")),
                (format!("{witness}/e_low"), 0.99, format!("{claim}/factor")),
                (format!("{witness}/e_up"), 1.01, format!("{claim}/factor")),
                (format!("{witness}/z_up"), 1.01, format!("{claim}/factor")),
                (format!("{witness}/e_up"), 0.5, format!("{witness}/z_up")),
                (format!("{witness}/z_up"), 0.5, format!("{witness}/z_up")),
                (format!("{pi}/1/1"), -1.0, format!("{witness}/e_low")),
                (format!("{pi}/0/0"), 3.0, witness.clone()),
            ];
            for multiplier in ["l_slope", "l_hold", "w", "l_x", "l_e", "l_y"] {
                if certificate["witness"]["for_n_o"][i][multiplier].is_string() {
                    let pointer = format!("{witness}/{multiplier}");
                    changes.extend([30.0, 1.0 / 30.0].map(|factor| (pointer.clone(), factor, pi.clone())));
                }
            }
            each_refused(&certificate, &changes);
        }
    }
}

#[test]
fn signs_are_demanded() {
    for name in sampled() {
        let certificate = stored(&name);
        let names = ["c", "e_low", "l_slope", "l_hold", "w", "l_x", "l_e", "l_y"].map(|name| ("witness", name));
        let all = names.into_iter().chain([("claim", "rate"), ("claim", "factor")]);
        let all = all.map(|(part, name)| format!("/{part}/for_n_o/0/{name}"));
        signs_are_demanded_at(&certificate, all.filter(|pointer| certificate.pointer(pointer).is_some()));
    }
}

/// All that belongs to x stands there, or nothing of it, where x has no part in e.
#[test]
fn x_is_left_out_where_it_has_no_part() {
    for (place, inputs) in [("/witness/for_n_o/0", None), ("/witness/for_n_o/0/noise", Some("g_r"))] {
        let certificate = stored("sampled");
        let without = |names: &[&str]| without(&certificate, names.iter().map(|name| format!("{place}/{name}")));
        refused(without(&["l_y"]), BadInput, "format", place);
        refused(without(&["w", "l_x"]), BadInput, "format", place);
        let all: Vec<&str> = ["w", "l_x", "l_e", "l_y"].into_iter().chain(inputs).collect();
        refused(without(&all), Invalid, "rates", place);
    }
    assert!(stored("sampled-no-x")["witness"]["for_n_o"][0].get("w").is_none());
}

/// The claim is about `n_o < samples/2` alone.
#[test]
fn there_are_samples_enough() {
    let certificate = stored("sampled-no-x");
    let pi: Vec<Vec<String>> = (0..42).map(|i| (0..=i).map(|j| u8::from(i == j).to_string()).collect()).collect();
    let mut made =
        edited(certificate, &[("/claim/for_n_o/1/noise", Value::Null), ("/witness/for_n_o/1/noise", Value::Null)]);
    for part in ["claim", "witness"] {
        made[part]["for_n_o"][1]["n_o"] = json!(20);
    }
    made["witness"]["for_n_o"][1]["Pi"] = json!(pi);
    let report = judged(&made);
    assert_refused(&report, Invalid, "rates", "/witness/for_n_o/1/n_o");
    assert!(report.finding.unwrap().message.contains("20 is below 40/2"));
}

/// The numbers of the law are those of the claim: another sigma or K.
#[test]
fn the_law_is_that_of_the_claim() {
    let certificate = stored("sampled");
    for (sigma, verdict) in [("60.001", None), ("75", Some(Invalid))] {
        let changes = [("/claim/sigma", json!(sigma)), ("/claim/control", Value::Null)];
        let made = edited(certificate.clone(), &changes);
        match verdict {
            None => drop(accepted(&made)),
            Some(verdict) => assert_refused(&judged(&made), verdict, "rates", "/witness/for_n_o/0"),
        }
    }
}

/// Neither a matrix inequality nor a law with a delay has rates.
#[test]
fn other_claims_have_no_rates() {
    let rates = stored("sampled");
    for (name, place) in [
        ("plant-paper-example", None),
        ("gain-inequalities", Some("/claim/for_n_o")),
        ("paper-example-delay", Some("/claim/for_n_o")),
    ] {
        let other = parsed("sampled", name);
        let changes = ["claim", "witness"].map(|part| {
            let mut list = rates[part]["for_n_o"].clone();
            list.as_array_mut()
                .unwrap()
                .iter_mut()
                .for_each(|entry| drop(entry.as_object_mut().unwrap().remove("noise")));
            (format!("/{part}/for_n_o"), list)
        });
        let report = judged(&edited(other, &changes));
        match place {
            Some(place) => assert_refused(&report, BadInput, "format", place),
            // By norms: it is not their proof.
            None => assert_refused(&report, Invalid, "rates", "/claim/for_n_o/0/rate"),
        }
    }
}
