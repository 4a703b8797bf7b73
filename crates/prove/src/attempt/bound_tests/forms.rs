//! Forms that are decided together: on the same boxes, and true only if each of them is.

use super::*;
use sigmastar_lang::spec::{Level, Metric};

const EFFORT: usize = 2_000;

/// A loop that is weakly coupled.
fn weak() -> Case {
    let plant = plant(&["x"], &["-x + sin(e)/10 + cos(2*pi*t)"], "x/10");
    case(&plant, &[vec![1.0]], curve(&["0"], &[["0.1", "0"]]), "0.01")
}

/// With P = w = k_p = 1 and this margin c_x: `-2 P J` is 2.
fn form(c_x: &str) -> (Metric, Level) {
    let one = || rational("1");
    let [c_e, c_y] = [(); 2].map(|()| rational("0.01"));
    let metric = Metric {
        matrix: vec![vec![one()]],
        cross: vec![rational("0")],
        weight: one(),
        k_p: one(),
        c_x: rational(c_x),
        c_e,
        c_y,
    };
    (metric, Level { p_up: rational("1.1"), x_low: rational("0.9"), e_low: rational("0.9") })
}

#[test]
fn together_they_hold_only_if_each_of_them_does() {
    let Case { engine, .. } = weak();
    let sigma = rational("3");
    let [x, e, eta] = ["1", "2", "0.1"].map(rational);
    let splitting = vec![vec![rational("0.5"), rational("0")], vec![rational("0"), rational("0.5")]];
    let [wide, narrow, wrong] = ["0.1", "0.2", "2.5"].map(form);
    for (forms, expected) in [
        (vec![wide.clone()], true),
        (vec![wide.clone(), narrow.clone()], true),
        (vec![wrong.clone()], false),
        (vec![wide.clone(), wrong.clone()], false),
        (vec![wrong, wide, narrow], false),
    ] {
        let found = engine.decide_forms(&forms, &sigma, [&x, &e], EFFORT).truth.is_true();
        assert_eq!(found, expected, "{forms:?}");
        let splittings = vec![splitting.clone(); forms.len()];
        let found = engine.decide_forms_x_first(&forms, &splittings, &sigma, ([&x, &e], &eta), EFFORT);
        assert_eq!(found.truth.is_true(), expected, "{forms:?}");
        // One without its S.
        let found = engine.decide_forms_x_first(&forms, &splittings[1..], &sigma, ([&x, &e], &eta), EFFORT);
        assert!(!found.truth.is_true(), "{forms:?}");
    }
}

/// What holds on few boxes of one form needs those of the other too; no more boxes than are given are looked at.
#[test]
fn the_boxes_are_those_of_all() {
    let Case { engine, .. } = weak();
    let [sigma, x, e] = ["3", "1", "2"].map(rational);
    let [wide, tight] = ["0.1", "1.9"].map(form);
    let boxes = |forms: &[(Metric, Level)]| engine.decide_forms(forms, &sigma, [&x, &e], EFFORT);
    let [alone, both] = [boxes(std::slice::from_ref(&wide)), boxes(&[wide.clone(), tight.clone()])];
    assert!(alone.truth.is_true() && both.truth.is_true() && alone.boxes <= both.boxes, "{alone:?} {both:?}");
    let few = engine.decide_forms(&[wide, tight], &sigma, [&x, &e], both.boxes - 1);
    assert!(!few.truth.is_true() && few.boxes == both.boxes - 1, "{few:?}");
}
