//! Rule T: the transfer bound, by its three kinds of proof.

use crate::common::*;
use proofs_check::verdict::Verdict::{BadInput, Invalid, Undecided};
use rug::Rational;
use serde_json::{Value, json};

const RULE: &str = "transfer bound";
const AT: &str = "/witness/transfer";

fn scaled(name: &str, pointer: &str, by: (i64, i64)) -> String {
    let stored = certificate(name).pointer(pointer).unwrap().as_str().unwrap().to_owned();
    (proofs_check::json::decimal(&stored).unwrap() * Rational::from(by)).to_string()
}

#[test]
fn closed_form() {
    let name = "paper-example.closed-form";
    assert_refused(&changed(name, "/witness/k0", scaled(name, "/witness/k0", (999_999, 1_000_000))), Invalid, RULE, AT);
    assert_refused(&changed(name, "/witness/k1", scaled(name, "/witness/k1", (999_999, 1_000_000))), Invalid, RULE, AT);
}

#[test]
fn matched() {
    // The next K proves it too; K = 1 needs the whole tail at once and the pair of this certificate has no room for it.
    assert_valid(&changed(PAPER, "/witness/transfer/K", 3));
    for k in [0, 4097] {
        assert_refused(&changed(PAPER, "/witness/transfer/K", k), Invalid, RULE, AT);
    }
    assert_refused(&changed(PAPER, "/witness/k1", "0"), Invalid, "signs", "/witness/k1");
    assert_refused(&changed(PAPER, "/witness/k1", "-59"), Invalid, "signs", "/witness/k1");
    let k1 = scaled(PAPER, "/witness/k1", (9999, 10_000));
    assert_refused(&changed(PAPER, "/witness/k1", k1), Invalid, RULE, AT);
    // A matched proof says nothing about other frequencies.
    assert_refused(&changed(PAPER, "/specification/internal_model/matched", false), Invalid, RULE, AT);
}

#[test]
fn boxes_cover_the_region() {
    let lists = certificate(BOXES).pointer("/witness/transfer/boxes").unwrap().clone();
    let list = |index: usize| lists[index].as_array().unwrap().clone();
    let with_list = |index: usize, list: Vec<Value>| changed(BOXES, &format!("/witness/transfer/boxes/{index}"), list);
    // More boxes prove what fewer do.
    let mut finer = list(0);
    let point = |at: usize| proofs_check::json::decimal(finer[at].as_str().unwrap()).unwrap();
    let middle = (point(2) + point(3)) / 2u32;
    finer.insert(3, json!(middle.to_string()));
    assert_valid(&with_list(0, finer));
    let mut gap = list(1);
    gap.remove(0);
    assert_refused(&with_list(1, gap), Invalid, RULE, AT);
    let mut twice = list(1);
    twice.insert(1, twice[1].clone());
    assert_refused(&with_list(1, twice), Invalid, RULE, AT);
    let mut backwards = list(2);
    backwards.swap(3, 4);
    assert_refused(&with_list(2, backwards), Invalid, RULE, AT);
    assert_refused(&with_list(0, vec![]), Invalid, RULE, AT);
    assert_refused(&with_list(0, vec![json!("0")]), Invalid, RULE, AT);
    let stored = |field: &str| certificate(BOXES)["witness"]["transfer"][field].as_u64().unwrap();
    let (m0, n0) = (stored("m0"), stored("N0"));
    for (field, value) in
        [("m0", 0), ("m0", m0 - 1), ("m0", m0 + 1), ("m0", 65), ("N0", n0 - 1), ("N0", n0 + 1), ("N0", 257)]
    {
        assert_refused(&changed(BOXES, &format!("{AT}/{field}"), value), Invalid, RULE, AT);
    }
    // Points in order, and too many.
    let many = (0..=20_000).map(|k| json!(format!("{}/40000", (2 * m0 - 1) * k))).collect();
    let report = with_list(0, many);
    assert_refused(&report, Invalid, RULE, AT);
    assert!(report.finding.unwrap().message.ends_with("at most 20000 boxes"));
    assert_refused(&changed(BOXES, "/witness/transfer/proof", "matched"), BadInput, "format", AT);
}

#[test]
fn a_box_must_stay_near_one_pole_and_be_narrow_enough() {
    let lists = certificate(BOXES).pointer("/witness/transfer/boxes").unwrap().clone();
    let all = lists[0].as_array().unwrap();
    // Without the half-integer 3/2 one box reaches over it.
    let merged: Vec<_> = all.iter().filter(|point| **point != json!("1.5")).cloned().collect();
    assert_eq!(merged.len() + 1, all.len());
    assert_refused(&changed(BOXES, "/witness/transfer/boxes/0", merged), Undecided, RULE, AT);
    let coarse = json!(["0", "0.5", "1.5", "2.5"]);
    let report = changed(BOXES, "/witness/transfer/boxes/0", coarse);
    assert!(matches!(report.verdict, Undecided | Invalid) && report.finding.unwrap().rule == RULE);
}

#[test]
fn boxes_need_room_above_the_true_curve() {
    for pointer in ["/witness/k0", "/witness/k1"] {
        let report = changed(BOXES, pointer, scaled(BOXES, pointer, (9, 10)));
        assert_eq!(report.finding.map(|finding| finding.rule), Some(RULE), "{pointer}");
    }
}
