//! Cells of a family: boxes that cover its parameters, each with an orbit of its own.

use super::families::{A, G, family, interval};
use super::periods_of_plants::{BOTH, at_rest};
use super::plant_certificates::stored;
use super::plant_support::{Parts, judged, read};
use proofs_check::check;
use proofs_check::json::{Field, parse};
use proofs_check::spec::Size;
use proofs_check::verdict::Verdict::{BadInput, Invalid, Valid};
use rug::Rational;
use serde_json::{Value, json};

/// A cell of [`family`], a and g in these: the orbit at the middle, with its derivative in a.
fn cell(a: [f64; 2], g: [f64; 2]) -> Value {
    let om = 2.0 * std::f64::consts::PI;
    let [at, by] = [a, g].map(|[low, high]| (low + high) / 2.0);
    let square = at * at + om * om;
    let (cos, sin) = (at / square, om / square);
    let (of_cos, of_sin) = ((om * om - at * at) / (square * square), -2.0 * at * om / (square * square));
    let wave = |cos: f64, sin: f64| json!([{ "cos": format!("{cos:.17}"), "sin": format!("{sin:.17}") }]);
    let waves = |cos: f64, sin: f64| json!([{ "cos": [format!("{cos:.17}")], "sin": [format!("{sin:.17}")] }]);
    let side = |[low, high]: [f64; 2]| json!({ "low": low, "high": high });
    json!({
        "parameters": [side(a), side(g)],
        "orbit": {
            "mean": ["0"], "harmonics": waves(cos, sin), "defect": "9.5e-5", "tube": "0.1", "radius": "1.08e-4",
            "sensitivities": [{ "mean": ["0"], "harmonics": waves(of_cos, of_sin) }, { "mean": ["0"] }],
        },
        "forcing": {
            "mean": "0", "harmonics": wave(cos, by + sin), "rest": "1.1e-4", "rest_t": "2.2e-4",
            "sensitivities": [{ "mean": "0", "harmonics": wave(of_cos, of_sin) }, { "mean": "0", "harmonics": wave(0.0, 1.0) }],
        },
    })
}

/// The family with a in [0.9, 1.1] and g in [0.5, 1.5] by cells.
fn by_cells(cells: Value) -> Parts {
    let mut parts = family(A, G).with("/witness/cells", cells);
    ["orbit", "forcing"].iter().for_each(|part| drop(parts.0["witness"].as_object_mut().unwrap().remove(*part)));
    parts
}

const HALVES: [[f64; 2]; 2] = [[0.9, 1.0], [1.0, 1.1]];
const ALL: [f64; 2] = [0.5, 1.5];

fn halves() -> Value {
    json!(HALVES.map(|a| cell(a, ALL)))
}

#[test]
fn a_family_by_halves() {
    by_cells(halves()).accepted();
    let lines = judged(&by_cells(halves()).0).unwrap();
    assert!(["cell 1 of 2", "cell 2 of 2"].iter().all(|cell| lines.iter().any(|line| line == cell)), "{lines:?}");
    // One cell of all is the family; then it needs what that needs.
    let whole = |defect: &str| {
        let mut one = cell([0.9, 1.1], ALL);
        let values = [
            ("orbit/defect", defect),
            ("orbit/radius", "2.9e-4"),
            ("forcing/rest", "3e-4"),
            ("forcing/rest_t", "6e-4"),
        ];
        values.iter().for_each(|(at, value)| *one.pointer_mut(&format!("/{at}")).unwrap() = json!(value));
        by_cells(json!([one]))
    };
    whole("2.6e-4").accepted();
    whole("2.4e-4").refused(Invalid, "orbit", "/witness/cells/0/orbit/defect");
}

/// Each number counts in each cell.
#[test]
fn what_one_cell_breaks() {
    let with = |at: &str, value: Value| {
        let mut cells = halves();
        *cells.pointer_mut(at).unwrap() = value;
        by_cells(cells)
    };
    for k in 0..2 {
        let (orbit, forcing) = (format!("/{k}/orbit"), format!("/{k}/forcing"));
        for (at, value, rule) in [
            (format!("{orbit}/defect"), json!("5.8e-5"), "orbit"),
            (format!("{orbit}/radius"), json!("1.05e-4"), "orbit"),
            (format!("{orbit}/tube"), json!("1.08e-4"), "orbit"),
            (format!("{forcing}/rest"), json!("1.07e-4"), "forcing"),
            (format!("{forcing}/rest_t"), json!("2e-4"), "forcing"),
        ] {
            with(&at, value).refused(Invalid, rule, &format!("/witness/cells{}", at.rsplit_once('/').unwrap().0));
        }
        // The orbit of the other cell, and its forcing.
        for (part, rule) in [(&orbit, "orbit"), (&forcing, "forcing")] {
            let other = halves().pointer(&part.replace(&k.to_string(), &(1 - k).to_string())).unwrap().clone();
            with(part, other).refused(Invalid, rule, &format!("/witness/cells{part}"));
        }
    }
    // A bound that the first cell keeps and the second does not; and the rate, the other way.
    for (bound, enough, less) in [("f_x", "1.1001", "1.03"), ("rate", "0.8999", "0.97")] {
        let with = |value: &str| by_cells(halves()).bounds(&[(bound, "1", "0", value)]);
        with(enough).accepted();
        with(less).refused(Invalid, "bounds of the plant", "/witness/bounds/0");
    }
    by_cells(halves()).with("/witness/lyapunov/alpha", json!("0.92")).refused(Invalid, "orbit", "/witness/lyapunov");
    // (M) as of the whole family.
    let with = |sigma: f64| by_cells(halves()).inequality(["1", "1"], ["2", "3"], "0.001", sigma);
    with(1.12).accepted();
    with(1.11).refused(Invalid, "matrix inequality", "/witness/matrix_inequality");
}

#[test]
fn cells_that_do_not_cover() {
    let with =
        |cells: &[([f64; 2], [f64; 2])]| by_cells(json!(cells.iter().map(|(a, g)| cell(*a, *g)).collect::<Vec<_>>()));
    let [low, high] = HALVES;
    for missing in [
        vec![(low, ALL)],
        vec![(high, ALL)],
        vec![(low, ALL), ([1.000_000_001, 1.1], ALL)],
        vec![(low, ALL), ([1.0, 1.099_999_999], ALL)],
        vec![(low, ALL), (high, [0.5, 1.0])],
        vec![(low, ALL), (high, [0.5, 1.0]), (high, [1.000_001, 1.5])],
        // A hole inside, between four.
        vec![(low, [0.5, 1.0]), ([0.9, 0.99], [1.0, 1.5]), ([0.99, 1.1], [1.1, 1.5]), (high, [0.5, 1.1])],
    ] {
        with(&missing).refused(Invalid, "cells", "/witness/cells");
    }
    // They may overlap, stand in any order, and reach beyond; turned around the middle they leave nothing.
    for covering in [
        vec![(high, ALL), (low, ALL)],
        vec![([0.95, 1.04], ALL), ([0.89, 0.98], ALL), ([1.02, 1.11], ALL)],
        vec![(high, [0.5, 1.0]), (low, ALL), (high, [1.0, 1.5])],
        vec![
            ([0.9, 0.98], [0.5, 1.2]),
            ([0.9, 1.02], [1.2, 1.5]),
            ([1.02, 1.1], [0.8, 1.5]),
            ([0.98, 1.1], [0.5, 0.8]),
            ([0.98, 1.02], [0.8, 1.2]),
        ],
    ] {
        let all = with(&covering).with("/witness/lyapunov/alpha", json!("0.8899"));
        all.bounds(&[("f_x", "1", "0", "1.1101")]).accepted();
    }
    // The family that is covered is that of the plant.
    let wider = by_cells(halves()).with("/plant/parameters/a/high", json!("1.1000001"));
    wider.refused(Invalid, "cells", "/witness/cells");
    by_cells(halves()).with("/plant/parameters/a/high", json!("1.05")).accepted();
}

#[test]
fn cells_that_are_none() {
    let list = "/witness/cells";
    for wrong in [json!([]), json!({}), json!(vec![cell(HALVES[0], ALL); 65])] {
        by_cells(wrong).refused(BadInput, "format", list);
    }
    let with = |at: &str, value: Value| {
        let mut cells = halves();
        let (parent, name) = at.rsplit_once('/').unwrap();
        cells.pointer_mut(parent).unwrap()[name] = value;
        by_cells(cells)
    };
    let side = json!({ "low": "0.9", "high": "1" });
    for (at, value) in [
        ("/0/parameters", json!([side])),
        ("/0/parameters", json!([side, side, side])),
        ("/0/parameters", json!([side, { "low": "0.5" }])),
        ("/0/parameters", json!([side, { "low": "0.5", "high": "1.5", "nominal": "1" }])),
        ("/0/parameters", json!([side, { "low": "0.5", "high": "pi" }])),
        ("/0/orbit", Value::Null),
        ("/0/forcing", Value::Null),
        ("/0/more", json!("1")),
    ] {
        let place = if at.ends_with("parameters") { at } else { "/0" };
        with(at, value).refused(BadInput, "format", &format!("/witness/cells{place}"));
    }
    let turned = json!([{ "low": "1", "high": "0.9" }, { "low": "0.5", "high": "1.5" }]);
    with("/0/parameters", turned).refused(Invalid, "cells", "/witness/cells/0/parameters/0");
    // Beside them there is no other orbit.
    for part in ["orbit", "forcing"] {
        let at = format!("/witness/{part}");
        let both = by_cells(halves()).with(&at, family(A, G).0.pointer(&at).unwrap().clone());
        both.refused(BadInput, "format", &at);
    }
}

/// `whole + by part`, number by number, of two curves of one form; what one of them does not list is 0.
fn moved(whole: &Value, part: &Value, by: &Rational) -> Value {
    let number = |value: &Value| match value {
        Value::Null => Rational::new(),
        _ => Field { json: &parse(value.to_string().as_bytes()).unwrap(), pointer: String::new() }.rational().unwrap(),
    };
    let some = |value: &Value| if value.is_null() { part.clone() } else { value.clone() };
    match some(whole) {
        Value::Array(list) => {
            let count = list.len().max(part.as_array().map_or(0, Vec::len));
            let at = |of: &Value, i: usize| of.get(i).cloned().unwrap_or_default();
            (0..count).map(|i| moved(&at(whole, i), &at(part, i), by)).collect()
        }
        Value::Object(map) => map.keys().map(|key| (key.clone(), moved(&whole[key], &part[key], by))).collect(),
        _ => json!((number(whole) + number(part) * by).to_string()),
    }
}

/// A certificate of a family, with the first of its two parameters, c in [0, 1/5] about 1/10, in these cells: the same orbits, about the
/// middles of the cells.
fn certificate(cells: &[[(i32, i32); 2]]) -> Value {
    let mut made = stored("family-example");
    let k = made["plant"]["parameters"]["k"].clone();
    let witness = made["witness"].as_object_mut().unwrap();
    let [orbit, forcing] = ["orbit", "forcing"].map(|part| witness.remove(part).unwrap());
    let about = |whole: &Value, by: &Rational| {
        let mut part = whole.clone();
        for name in ["mean", "harmonics"] {
            part[name] = moved(&whole[name], &whole["sensitivities"][0][name], by);
        }
        part
    };
    let cell = |ends: &[(i32, i32); 2]| {
        let [low, high] = ends.map(Rational::from);
        let by = Rational::from(&low + &high) / 2u32 - Rational::from((1, 10));
        let of_c = json!({ "low": low.to_string(), "high": high.to_string() });
        json!({
            "parameters": [of_c, { "low": k["low"], "high": k["high"] }],
            "orbit": about(&orbit, &by), "forcing": about(&forcing, &by),
        })
    };
    witness.insert("cells".to_owned(), cells.iter().map(cell).collect());
    made
}

#[test]
fn a_certificate_by_cells() {
    let verdict = |made: &Value| {
        let report = check(made.to_string().as_bytes());
        let pointer = report.finding.as_ref().map_or_else(String::new, |finding| finding.pointer.clone());
        (report.verdict, pointer)
    };
    let whole = [(0, 1), (1, 5)];
    let halves = [[(0, 1), (2, 25)], [(2, 25), (1, 5)]];
    for cells in [&[whole][..], &halves, &[halves[1], whole]] {
        assert_eq!(verdict(&certificate(cells)), (Valid, String::new()), "{cells:?}");
    }
    for cells in [&[halves[0]][..], &[halves[1]], &[halves[0], [(3, 25), (1, 5)]]] {
        assert_eq!(verdict(&certificate(cells)), (Invalid, "/witness/cells".to_owned()), "{cells:?}");
    }
    // The orbits about the middle of all, in one of the halves.
    let mut forged = certificate(&halves);
    forged["witness"]["cells"][0]["orbit"] = certificate(&[whole])["witness"]["cells"][0]["orbit"].clone();
    assert_eq!(verdict(&forged), (Invalid, "/witness/cells/0/orbit/defect".to_owned()));
}

/// The clock is not cut: each cell has all of it.
#[test]
fn cells_and_the_clock() {
    let half = |low: &str, high: &str, sensitivities: usize| {
        let all = |one: Value| Value::Array(vec![one; sensitivities]);
        json!({
            "parameters": [{ "low": low, "high": high }],
            "orbit": { "mean": ["0"], "defect": "0", "tube": "0.1", "radius": "0.05", "sensitivities": all(json!({ "mean": ["0"] })) },
            "forcing": { "mean": "0", "rest": "10", "rest_t": "100", "sensitivities": all(json!({ "mean": "0" })) },
        })
    };
    let with = |sensitivities: usize, value: &str| {
        let cells = json!([half("-1", "0", sensitivities), half("0", "1", sensitivities)]);
        let mut parts = at_rest("-x + e", "e*sin(phase) + p*x", BOTH)
            .with("/plant/parameters", json!({ "p": interval(["0.5", "-1", "1"]) }))
            .with("/witness/cells", cells)
            .bounds(&[("q_te", "0", "3", value)]);
        ["orbit", "forcing"].iter().for_each(|part| drop(parts.0["witness"].as_object_mut().unwrap().remove(*part)));
        parts
    };
    // 5/4 times 2 pi.
    with(2, "7.86").accepted();
    with(2, "7.85").refused(Invalid, "bounds of the plant", "/witness/bounds/0");
    for wrong in [1, 3] {
        with(wrong, "7.86").refused(BadInput, "format", "/witness/cells/0/orbit/sensitivities");
    }
}

/// C_k, r_0, r_1: the largest of all cells, whichever it is.
#[test]
fn what_is_known_of_the_forcing_is_the_largest() {
    let mut cells = halves();
    let values = [
        ("/0/forcing/mean", "-3"),
        ("/1/forcing/mean", "2"),
        ("/0/forcing/rest", "0.1"),
        ("/1/forcing/rest", "0.2"),
        ("/0/forcing/rest_t", "7"),
        ("/1/forcing/rest_t", "6"),
    ];
    values.iter().for_each(|(at, value)| *cells.pointer_mut(at).unwrap() = json!(value));
    cells[0]["forcing"]["harmonics"] = json!([{ "cos": "0", "sin": "0" }, { "cos": "2", "sin": "0" }]);
    cells[1]["forcing"]["harmonics"] = json!([{ "cos": "4", "sin": "0" }]);
    for cell in 0..2 {
        cells[cell]["forcing"]["sensitivities"] = json!([{ "mean": "0" }, { "mean": "0" }]);
    }
    // The deviations are those from the middle of the cell: at most 1/20.
    cells[1]["forcing"]["sensitivities"][0] = json!({ "mean": "40" });
    let (spec, _) = read(&by_cells(cells).0).unwrap();
    let q_0 = spec.q_0.unwrap();
    let size = |size: &Size| match size {
        Size::Number(value) | Size::Root(value) => value.clone(),
        Size::Constant(_) => panic!("a number"),
    };
    let number = |n, m| Rational::from((n, m));
    let harmonics: Vec<Rational> = q_0.harmonics.iter().map(size).collect();
    assert_eq!(harmonics, [number(4, 1), number(4, 1), number(1, 1)]);
    assert_eq!([size(&q_0.rest_rms), size(&q_0.rest_t_rms.unwrap())], [number(1, 5), number(7, 1)]);
}
