//! Certificates at samples with `by_n_o`, without a delay and with one (docs/mathematics.md, section 14.6): a stored certificate of a linear family with an
//! input gain, at a larger gain sigma, with numbers of the loop that is simulated.

use crate::by_n_o_held::{Law, WEIGHT_SUM};
use crate::by_n_o_support::Loop;
use crate::common::{accepted, assert_refused, deleted, edited, every, judged, parsed, rehash};
use crate::plant_mutations::mutate_in;
use crate::rates::{refused, times};
use proofs_check::verdict::Verdict::{BadInput, Invalid, Undecided};
use serde_json::{Value, json};
use std::sync::OnceLock;

const RULE: &str = "by n_o";
const CLAIM: &str = "/claim/by_n_o";
const LINEAR: &str = "/witness/by_n_o/linear";
const SIGMA: f64 = 2.0;
/// K of the stored certificate.
const K: f64 = 0.977_457_984_419_440_9;
const X_0: &str = "0.68";
const E_0: &str = "0.75";
const Y_0: &str = "80";
/// Above what is simulated, so that few boxes are needed.
const ROOM: f64 = 1.02;
const MORE: f64 = 1.5;

fn plant(forcing: f64) -> Loop {
    Loop {
        a: vec![vec![-1.0]],
        b: vec![1.0],
        c: vec![1.0],
        d: 0.0,
        f_0: vec![vec![[1.0, 0.0]]],
        q_0: vec![[0.0, forcing]],
        mean: 0.0,
        sigma: SIGMA,
        mu: 1.0,
        factor: [0.8, 1.25],
        gain: [0.9, 1.1],
    }
}

fn law(delayed: bool) -> Law {
    Law { samples: 100, gain: K, delayed }
}

/// The stored one with other free numbers, and with a delay.
fn plain(delayed: bool) -> Value {
    let mut made = parsed("sampled", "gain-family");
    let witness = &mut made["witness"];
    for (name, value) in [
        ("h", "0.4"),
        ("w_x", "1.03"),
        ("X_p", "0.33"),
        ("E_p", "0.36"),
        ("r_x", "0.33"),
        ("r_e", "0.25"),
        ("r_d", "1.5"),
        ("D_x", "300"),
        ("D_e", "300"),
    ] {
        witness[name] = value.into();
    }
    // The plant is linear: its bounds hold on any box.
    for entry in witness["bounds"].as_array_mut().unwrap() {
        for at in ["X", "E"].into_iter().filter(|at| entry[*at] != "0").collect::<Vec<_>>() {
            entry[at] = "400".into();
        }
    }
    let claim = &mut made["claim"];
    claim["sigma"] = SIGMA.to_string().into();
    claim["periodic_solution"] = json!({ "x": "0.35", "e": "0.4", "zeta": "3.5", "z": "4.5" });
    claim["control"] = json!({ "steady": "5", "transient": "2000" });
    (claim["initial_set"]["X0"], claim["initial_set"]["E0"]) = (X_0.into(), E_0.into());
    if delayed {
        claim["delay_samples"] = 1.into();
        made["plant"]["internal_model"]["delay_samples"] = 1.into();
        (made["witness"]["gm"], made["witness"]["Y_0"]) = ("0.03".into(), Y_0.into());
        rehash(&mut made);
    }
    made
}

fn text(value: f64) -> String {
    format!("{value:.14e}")
}

fn number(certificate: &Value, pointer: &str) -> f64 {
    certificate.pointer(pointer).unwrap().as_str().unwrap().parse().unwrap()
}

/// Every n_o, and 1 or more.
fn entries() -> [(Vec<usize>, Value); 2] {
    [(vec![0], json!({ "n_o": 0 })), (vec![0, 1], json!({ "n_o": 1, "or_more": true }))]
}

/// The bounds of an entry by the simulation, of all members.
fn simulated(law: &Law, own: &[usize]) -> [f64; 6] {
    // Linear in the forcing: the ends count.
    let all = [0.5, 1.5].map(|forcing| law.bounds(&plant(forcing), own).0);
    // L is 1 here and 1/2 in the simulation.
    let mut most = all.into_iter().reduce(|a, b| std::array::from_fn(|i| a[i].max(b[i]))).unwrap();
    most[3] /= 2.0;
    most
}

/// The corollary of section 14.6 for an entry of a certificate.
fn peaks(made: &Value, entry: usize, delayed: bool) -> [f64; 2] {
    let form = |name: &str| number(made, &format!("{LINEAR}/forms/0/{name}"));
    let size = |name: &str| number(made, &format!("{LINEAR}/sizes/{entry}/{name}"));
    let steady = |name: &str| number(made, &format!("{CLAIM}/{entry}/steady/{name}"));
    let [sum, x_0, e_0] = [WEIGHT_SUM, X_0, E_0].map(|text| text.parse::<f64>().unwrap());
    let sum = made.pointer("/witness/weight_sum").map_or(sum, |sum| sum.as_str().unwrap().parse().unwrap());
    let n_bar = f64::sqrt(2.0 + 2.612_375_348_685_488);
    let [x, e, zeta] = [x_0 + size("x"), e_0 + steady("e"), n_bar * e_0 + size("zeta")];
    let (k_p, h) = (form("k_p"), 0.01);
    let [stored, late] = match delayed {
        false => [0.0; 2],
        true => {
            let y = Y_0.parse::<f64>().unwrap() + size("y");
            [form("gm") * h * y * y, h * (SIGMA + K * sum).powi(2) / form("gm")]
        }
    };
    let level = |b: f64| form("p_up") * x * x + form("w") * e * e + b * K * k_p / 2.0 * zeta * zeta + stored;
    let moved = |b: f64| level(b) * (SIGMA * SIGMA / form("w") + 2.0 * K * sum / (b * k_p) + late);
    [steady("e") + (level(1.1) / form("w")).sqrt(), steady("u") + moved(0.9).max(moved(1.1)).sqrt() / 2.0]
}

/// Made once.
fn made(delayed: bool) -> Value {
    static MADE: [OnceLock<Value>; 2] = [OnceLock::new(), OnceLock::new()];
    MADE[usize::from(delayed)].get_or_init(|| put_together(delayed)).clone()
}

fn put_together(delayed: bool) -> Value {
    let (mut made, law) = (plain(delayed), law(delayed));
    let [p, k_p, lambda, g_m] = law.found(&plant(1.0));
    let mut form = json!({ "P": [[text(p)]], "p_up": text(p), "w": "1", "k_p": text(k_p), "lambda": text(lambda) });
    if delayed {
        form["gm"] = text(g_m).into();
    }
    let (mut claimed, mut sizes) = (Vec::new(), Vec::new());
    for (own, mut entry) in entries() {
        let [e, e_rms, u, x, zeta, y] = simulated(&law, &own).map(|bound| bound * ROOM + 1e-12);
        // Where e vanishes at the samples x is a small difference of large numbers.
        let x = if own.len() > 1 { x * MORE } else { x };
        entry["steady"] = json!({ "e": text(e), "e_rms": text(e_rms), "u": text(u / 2.0) });
        entry["largest"] = json!({ "e": "1e9", "u": "1e9" });
        claimed.push(entry);
        let mut size = json!({ "x": text(x), "zeta": text(zeta) });
        if delayed {
            size["y"] = text(y).into();
        }
        sizes.push(size);
    }
    made["claim"]["by_n_o"] = claimed.into();
    made["witness"]["by_n_o"] = json!({ "linear": { "forms": [form], "sizes": sizes } });
    for entry in 0..2 {
        let [e, u] = peaks(&made, entry, delayed).map(|bound| text(bound * (1.0 + 1e-9)));
        made["claim"]["by_n_o"][entry]["largest"] = json!({ "e": e, "u": u });
    }
    made
}

#[test]
fn what_is_said() {
    for delayed in [false, true] {
        let made = made(delayed);
        let report = accepted(&made);
        let statement = &report.subject.as_ref().unwrap().statement;
        for (place, about) in ["n_o = 0", "every n_o >= 1 below 100/2"].into_iter().enumerate() {
            let text = |of: &str| made.pointer(&format!("{CLAIM}/{place}{of}")).unwrap().as_str().unwrap();
            let [e, rms, u] = ["/steady/e", "/steady/e_rms", "/steady/u"].map(text);
            let [most_e, most_u] = ["/largest/e", "/largest/u"].map(text);
            let sentence = format!(
                " With {about} and sigma = 2 exactly, |e| <= {e} (root mean square <= {rms}) and |u/2| <= {u} along the T-periodic solution, \
                 and |e| <= {most_e} and |u/2| <= {most_u} at all times for these solutions."
            );
            assert!(statement.contains(&sentence), "{sentence}\n{statement}");
        }
        let forms = report.lines.iter().filter(|line| line.contains("F_s > 0 for s = ")).count();
        assert_eq!(forms, if delayed { 8 } else { 4 }, "{:?}", report.lines);
    }
}

/// No number of the claim, and none that it rests on, is smaller. (How sharp those along the periodic solution are is seen of drawn loops.)
#[test]
fn smaller_numbers_are_refused() {
    for delayed in [false, true] {
        let made = made(delayed);
        let mut places = Vec::new();
        for entry in 0..2 {
            places.extend(["e", "e_rms", "u"].map(|name| (format!("{CLAIM}/{entry}/steady/{name}"), 0.5)));
            places.extend(["e", "u"].map(|name| (format!("{CLAIM}/{entry}/largest/{name}"), 1.0 - 3e-9)));
            places.push((format!("{LINEAR}/sizes/{entry}/zeta"), 0.5));
            places.push((format!("{LINEAR}/sizes/{entry}/x"), if entry == 1 { 0.5 / MORE } else { 0.5 }));
        }
        if delayed {
            places.push((format!("{LINEAR}/sizes/0/y"), 0.5));
        }
        for (place, factor) in places {
            // With room for what rests on it.
            let mut changes = vec![(place.clone(), times(&made, &place, factor))];
            if place.contains("/steady/") || place.contains("/sizes/") {
                let entry = place.split('/').find_map(|part| part.parse::<usize>().ok()).unwrap();
                changes.push((format!("{CLAIM}/{entry}/largest"), json!({ "e": "1e9", "u": "1e9" })));
            }
            let report = judged(&edited(made.clone(), &changes));
            let finding = report.finding.as_ref().unwrap_or_else(|| panic!("{place} is accepted"));
            assert_eq!((finding.rule, &finding.pointer), (RULE, &place), "{finding:?}");
            assert_ne!(report.verdict, BadInput, "{place}");
            if place.contains("/largest/") {
                accepted(&edited(made.clone(), &[(&place, times(&made, &place, 1.0 + 1e-6))]));
            }
        }
    }
}

/// In continuous time no error is left of every larger number; between samples some is.
#[test]
fn an_error_is_left_between_samples() {
    for delayed in [false, true] {
        let made = made(delayed);
        assert!(plant(1.5).largest(1).all()[0] < 1e-9);
        let place = format!("{CLAIM}/1/steady/e");
        for value in ["0", "1e-5"] {
            refused(edited(made.clone(), &[(&place, json!(value))]), Undecided, RULE, &place);
        }
    }
}

#[test]
fn what_is_not_said_at_samples() {
    for delayed in [false, true] {
        let made = made(delayed);
        let first = deleted(&deleted(&made, &format!("{CLAIM}/1")), &format!("{LINEAR}/sizes/1"));
        let of_first = |name: &str, value: Value| edited(first.clone(), &[(format!("{CLAIM}/0/{name}"), value)]);
        refused(of_first("or_more", true.into()), Undecided, RULE, &format!("{CLAIM}/0/or_more"));
        for n_o in [50, 51, 100] {
            refused(of_first("n_o", n_o.into()), Invalid, RULE, &format!("{CLAIM}/0/n_o"));
        }
        refused(deleted(&first, &format!("{CLAIM}/0/largest")), BadInput, "format", CLAIM);
        // With a delay nothing is proved by trials; without, they have their parts.
        let trials = edited(first.clone(), &[("/witness/by_n_o", json!({ "trials": [{}] }))]);
        let report = judged(&trials);
        assert_refused(&report, BadInput, "format", "/witness/by_n_o/trials");
        assert_eq!(report.finding.unwrap().message.contains("with a delay"), delayed);
        // Fields of a form, and the form itself.
        for name in if delayed { &["lambda", "gm"][..] } else { &["lambda"] } {
            refused(deleted(&made, &format!("{LINEAR}/forms/0/{name}")), BadInput, "format", LINEAR);
            let place = format!("{LINEAR}/forms/0/{name}");
            let large = edited(made.clone(), &[(&place, times(&made, &place, 1e4))]);
            let roomy =
                edited(large, &[0, 1].map(|i| (format!("{CLAIM}/{i}/largest"), json!({ "e": "1e9", "u": "1e9" }))));
            refused(roomy, Invalid, RULE, LINEAR);
        }
        let (place, spare) = (format!("{LINEAR}/forms/0/gm"), format!("{LINEAR}/sizes/0/y"));
        if !delayed {
            refused(edited(made.clone(), &[(&place, json!("1"))]), BadInput, "format", &place);
            refused(edited(made.clone(), &[(&spare, json!("1"))]), BadInput, "format", &spare);
        }
    }
}

/// Every leaf of what is said by n_o, and of what proves it, altered.
#[test]
fn leaves_of_a_certificate_by_n_o_at_samples() {
    for delayed in [false, true] {
        mutate_in(&made(delayed), every(29), &["/by_n_o/"]);
    }
}
