//! Every leaf of the parts with joint metrics replaced: what is accepted is true, by eliminations in doubles.

use super::common::judged;
use super::existence_inequality::number;
use super::joint_inequality::{EXISTENCE, PARTS, PLACE};
use super::matrix_inequality::stored;
use super::mutations::replacements;
use crate::common::every;
use proofs_check::verdict::Verdict;
use serde_json::{Value, json};

/// Positive definite by elimination, in doubles.
fn definite(mut a: Vec<Vec<f64>>) -> bool {
    let order = a.len();
    (0..order).all(|i| {
        let pivot = a[i][i];
        for row in i + 1..order {
            for column in row..order {
                a[row][column] -= a[i][row] * a[i][column] / pivot;
            }
        }
        pivot > 0.0
    })
}

/// Whether the metrics of a part are what they are said to be for this plant, at both ends of dq/de up to E, and lie where they must.
fn is_true(certificate: &Value, place: &str) -> bool {
    let w = &certificate["witness"];
    let part = certificate.pointer(place).unwrap();
    let l = |i: usize, j: usize| number(&w["coordinates"][i][j]);
    let det = l(0, 0) * l(1, 1) - l(0, 1) * l(1, 0);
    let inverse = [[l(1, 1) / det, -l(0, 1) / det], [-l(1, 0) / det, l(0, 0) / det]];
    let sum = |term: &dyn Fn(usize) -> f64| term(0) + term(1);
    let (f_x, f_e, q_x) = ([[-0.3, -3.0], [3.0, -0.3]], [4.0, 0.0], [-4.0, 2.0]);
    let j = |i: usize, m: usize| sum(&|b| sum(&|a| inverse[i][a] * f_x[a][b]) * l(b, m));
    let g = |i: usize| sum(&|a| inverse[i][a] * f_e[a]);
    let r = |m: usize| sum(&|b| q_x[b] * l(b, m));
    let sigma = number(&part["sigma"]);
    let p = |i: usize| number(&part["near"]["p"][i]);
    let matrix = |name: &str, d: f64| {
        let of = |field: &str| number(&part[name][field]);
        let big = |i: usize, m: usize| number(&part[name]["P"][i][m]);
        let (own, w_1) = (f64::from(u8::from(name == "near")), number(&part["near"]["w"]));
        let total = if name == "near" { w_1 } else { w_1 + of("w") };
        let entry = |i: usize, m: usize| match (i, m) {
            (0..2, 0..2) => -sum(&|b| big(i, b) * j(b, m) + j(b, i) * big(b, m)) - if i == m { of("c_x") } else { 0.0 },
            (0..2, 2) => -sum(&|b| big(i, b) * g(b)) + sigma * p(i) - own * sum(&|b| j(b, i) * p(b)),
            (0..2, 3) => -own * p(i) - of("k_p") / 2.0 * r(i),
            (2, 2) => 2.0 * sigma * total - own * 2.0 * sum(&|b| p(b) * g(b)) - of("c_e"),
            (2, 3) => -of("w") - of("k_p") / 2.0 * d,
            _ => of("k_p") - of("c_y"),
        };
        (0..4).map(|i| (0..4).map(|m| entry(i.min(m), i.max(m))).collect()).collect::<Vec<Vec<f64>>>()
    };
    let last = -1.0 - 7.0 * (1.0 - number(&part["E"]).tanh().powi(2));
    let holds = |name: &str| [-8.0, last].iter().all(|d| definite(matrix(name, *d)));
    let symmetric = |name: &str| part[name]["P"][0][1] == part[name]["P"][1][0];
    let mut truth = ["near", "far"].iter().all(|name| holds(name) && symmetric(name));
    truth &= sigma <= number(&certificate["claim"]["sigma_star"]) && number(&part["far"]["w"]) >= 0.0;
    let [x, e] = ["X", "E"].map(|name| number(&part[name]));
    let of = |name: &str| number(&w[name]);
    if place == EXISTENCE {
        return truth && of("X_p") <= x && of("E_p") <= e;
    }
    // A little below what is proved of the periodic solution, in favour of a certificate.
    let of_solution = |name: &str| number(&certificate["claim"]["periodic_solution"][name]) / 1.0002;
    let set = |name: &str| number(&certificate["claim"]["initial_set"][name]);
    let (d_x, d_e) = (of("D_x"), of("D_e"));
    let reach = [set("X0") + of_solution("x"), set("E0") + of_solution("e"), 2.1476 * set("E0") + of_solution("zeta")];
    truth &= of_solution("x") + d_x <= x && of_solution("e") + d_e <= e;
    truth
        && ["near", "far"].iter().all(|name| {
            let field = |field: &str| number(&part[name][field]);
            let own = f64::from(u8::from(*name == "near"));
            let pi = |x_low: f64, e_low: f64| {
                let entry = |i: usize, m: usize| match (i, m) {
                    (0..2, 0..2) => number(&part[name]["P"][i][m]) - if i == m { x_low } else { 0.0 },
                    (2, 2) => field("w") - e_low,
                    _ => own * p(i.min(m)),
                };
                definite((0..3).map(|i| (0..3).map(|m| entry(i, m)).collect()).collect())
            };
            let above = |up: f64| {
                let entry = |i: usize, m: usize| f64::from(u8::from(i == m)) * up - number(&part[name]["P"][i][m]);
                definite((0..2).map(|i| (0..2).map(|m| entry(i, m)).collect()).collect())
            };
            let level = field("P_up") * reach[0].powi(2)
                + 2.0 * own * p(0).hypot(p(1)) * reach[0] * reach[1]
                + field("w") * reach[1].powi(2)
                + field("k_p") / 2.0 * reach[2].powi(2);
            let exit = (field("x_low") * d_x * d_x).min(field("e_low") * d_e * d_e);
            pi(field("x_low"), 0.0) && pi(0.0, field("e_low")) && above(field("P_up")) && level < exit
        })
}

/// Whatever a leaf is replaced by: what is accepted is true. Every leaf, and every kind of replacement, in an ordinary run not of every leaf.
#[test]
fn leaves_of_the_parts() {
    let (mut counts, stride) = ([0, 0], every(11));
    for (place, _) in PARTS {
        let original = stored("joint");
        assert!(is_true(&original, place));
        let mut leaves: Vec<String> = ["X", "E", "sigma", "near/p/0", "near/p/1"].map(str::to_owned).to_vec();
        for metric in ["near", "far"] {
            let of = ["P/0/0", "P/0/1", "P/1/0", "P/1/1", "w", "k_p", "c_x", "c_e", "c_y"];
            leaves.extend(of.map(|leaf| format!("{metric}/{leaf}")));
            let extents = ["P_up", "x_low", "e_low"].map(|leaf| format!("{metric}/{leaf}"));
            leaves.extend(extents.into_iter().filter(|_| place == PLACE));
        }
        for (offset, leaf) in leaves.into_iter().enumerate() {
            let at = format!("{place}/{leaf}");
            let mut all = replacements(original.pointer(&at).unwrap());
            let value = number(original.pointer(&at).unwrap());
            let factors = [0.5, 0.9, 0.99, 1.01, 1.1, 2.0];
            all.extend(factors.map(|factor| ("scaled", json!((value * factor).to_string()))));
            for (kind, replacement) in all.into_iter().skip(offset % stride).step_by(stride) {
                let mut mutant = original.clone();
                *mutant.pointer_mut(&at).unwrap() = replacement.clone();
                let mirror = [("P/0/1", "P/1/0"), ("P/1/0", "P/0/1")].iter().find(|(one, _)| leaf.ends_with(one));
                if let Some((one, other)) = mirror {
                    *mutant.pointer_mut(&at.replace(one, other)).unwrap() = replacement.clone();
                }
                let valid = judged(&mutant).verdict == Verdict::Valid;
                assert!(!valid || is_true(&mutant, place), "accepted and not true: {at} {kind} {replacement}");
                counts[usize::from(valid)] += 1;
            }
        }
    }
    println!("{} refused, {} accepted and true", counts[0], counts[1]);
    assert!(counts[0] * stride > 500 && counts[1] * stride > 50);
}
