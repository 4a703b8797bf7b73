//! Rates of claims by a matrix inequality or by joint metrics (docs/mathematics.md, section 13.6): stored parts of certificates that are stored
//! elsewhere, and what is refused where anything of them is not what it is.

use crate::common::{accepted, assert_refused, certificate, edited, every, judged, parsed, rehash};
use crate::rates::{each_refused, refused, signs_are_demanded_at, times};
use proofs_check::json::decimal;
use proofs_check::verdict::Verdict;
use serde_json::{Value, json};
use std::f64::consts::PI;

/// The part, the certificate that it is of, the least and the largest b, and how many times (D) is asked: in both cells of a family.
const STORED: [(&str, &str, &str, [f64; 2], usize); 6] = [
    ("pendulum", "plants", "pendulum.certificate", [1.0, 1.0], 2),
    ("splitting", "plants", "splitting.certificate", [1.0, 1.0], 1),
    ("joint", "plants", "joint.certificate", [1.0, 1.0], 2),
    ("gain-converter", "gain", "converter", [0.9, 1.1], 2),
    ("family-gain", "plants", "family-gain.certificate", [0.9 / 1.3, 1.1 / 0.7], 4),
    ("periods-motor-axis", "periods", "motor-axis", [1.0, 1.0], 2),
];

/// Stored certificates with slopes of `[J; r]` and of `[g; d]` apart.
const IN_PARTS: [(&str, &str, &str, [f64; 2], usize); 3] = [
    ("splitting.parts", "plants", "splitting.certificate", [1.0, 1.0], 4),
    ("gain-splitting.parts", "gain", "splitting", [0.5, 1.5], 4),
    ("family-example.parts", "plants", "family-example.certificate", [1.0, 1.0], 2),
];

fn all() -> impl Iterator<Item = (&'static str, &'static str, &'static str, [f64; 2], usize)> {
    STORED.into_iter().chain(IN_PARTS)
}

/// A certificate with a part of `tests/slopes`.
fn with(part: &str, [folder, name]: [&str; 2]) -> Value {
    let part = parsed("slopes", part);
    let places = [("/claim/for_n_o", part["claim"].clone()), ("/witness/for_n_o", part["witness"].clone())];
    edited(parsed(folder, name), &places)
}

fn stored(name: &str) -> Value {
    let (part, folder, of, ..) = all().find(|stored| stored.0 == name).unwrap();
    with(part, [folder, of])
}

fn number(value: &Value) -> f64 {
    let (numerator, denominator) = value.as_str().unwrap().split_once('/').unwrap_or((value.as_str().unwrap(), "1"));
    (decimal(numerator).unwrap() / decimal(denominator).unwrap()).to_f64()
}

#[test]
fn stored_ones_are_accepted() {
    for (name, .., asked) in all() {
        let certificate = stored(name);
        let report = accepted(&certificate);
        let statement = &report.subject.as_ref().unwrap().statement;
        for rate in certificate["claim"]["for_n_o"].as_array().unwrap() {
            assert!(statement.contains(&format!(" With n_o = {} and ", rate["n_o"])), "{name}: {statement}");
        }
        // All columns up to X and E of what the claim rests on, parts of them where its splitting has them.
        let part = ["matrix_inequality", "joint_inequality"].map(|name| &certificate["witness"][name]);
        let part = part.into_iter().find(|part| !part.is_null()).unwrap();
        let number = |of: &Value, name: &str| of[name].as_str().unwrap().parse::<f64>().unwrap();
        let place = |x: &Value, e: &Value| format!(" at X = {}, E = {}, by ", number(x, "X"), number(e, "E"));
        let lines: Vec<&String> = report.lines.iter().filter(|line| line.starts_with("rates: (D")).collect();
        assert_eq!(lines.len(), asked, "{name}: {:?}", report.lines);
        for line in lines {
            let other = &part["splitting"];
            let expected = match line.split_once(", ").unwrap().0 {
                "rates: (D)" => place(part, part),
                "rates: (D_s)" => place(part, other),
                "rates: (D_e)" => place(other, part),
                _ => panic!("{line}"),
            };
            assert!(line.contains(&expected), "{name}: {line}");
        }
    }
}

/// Where the slopes of a witness stand, and from which place on they say something of a.
fn pieces(certificate: &Value, witness: &str) -> Vec<(String, usize)> {
    let states = certificate["plant"]["states"].as_array().map_or(0, Vec::len);
    let at = |name: &str| format!("{witness}/slopes{name}");
    match certificate.pointer(&at("/states")) {
        None => vec![(at(""), 0)],
        Some(_) => vec![(at("/states"), 0), (at("/error"), states)],
    }
}

/// The smallest pivot of the form of (K), by other means: from the matrices of the loop at the gain b.
fn pivot(certificate: &Value, which: usize, b: f64, rate: f64) -> f64 {
    let witness = &certificate["witness"]["for_n_o"][which];
    let symmetric = |rows: &Value| -> Vec<Vec<f64>> {
        let order = rows.as_array().unwrap().len();
        (0..order).map(|i| (0..order).map(|j| number(&rows[i.max(j)][i.min(j)])).collect()).collect()
    };
    let pi = symmetric(&witness["Pi"]);
    let (order, n_o) = (pi.len(), witness["n_o"].as_u64().unwrap() as usize);
    let e = order - 2 * n_o - 2;
    let inputs = e + 1;
    let parts: Vec<_> = pieces(certificate, &format!("/witness/for_n_o/{which}"))
        .into_iter()
        .map(|(at, first)| {
            let slopes = certificate.pointer(&at).unwrap();
            (first, symmetric(&slopes["Q"]), &slopes["G"], symmetric(&slopes["H"]))
        })
        .collect();
    let sigma = number(&certificate["claim"]["sigma_star"]);
    let model = &certificate["plant"]["internal_model"];
    let mu = number(&model["mu"]);
    let w = match model["base_frequency"].as_str().unwrap() {
        "2*pi" => 2.0 * PI,
        "100*pi" => 100.0 * PI,
        other => panic!("{other}"),
    };
    assert_eq!((number(&model["weights"]["n0"]), number(&model["weights"]["epsilon"])), (2.0, 0.5));
    let mut column = vec![0.0; order];
    column[e] = 1.0;
    let mut measured = vec![0.0; order];
    for l in 0..=n_o {
        let place = if l == 0 { e + 1 } else { e + 2 * l };
        let root = if l == 0 { 2.0_f64.sqrt() } else { (l as f64).powf(-0.75) };
        column[place] = -root;
        measured[place] = b * mu * root;
    }
    measured[e] = (1.0 - b) * sigma;
    // eta' = A eta + B omega.
    let mut a: Vec<Vec<f64>> = (0..order).map(|i| (0..order).map(|j| column[i] * measured[j]).collect()).collect();
    a[e][e] -= sigma;
    for l in 1..=n_o {
        a[e + 2 * l][e + 2 * l + 1] += l as f64 * w;
        a[e + 2 * l + 1][e + 2 * l] -= l as f64 * w;
    }
    let inward = |i: usize, k: usize| if k < e { f64::from(u8::from(i == k)) } else { column[i] };
    let moved = |i: usize, j: usize| (0..order).map(|k| pi[i][k] * a[k][j]).sum::<f64>();
    let driven = |i: usize, k: usize| (0..order).map(|j| pi[i][j] * inward(j, k)).sum::<f64>();
    // Of part p: whether a place of (x, e, zs) is one of its columns, and which.
    let column_of = |p: usize, i: usize| i.checked_sub(parts[p].0).filter(|place| *place < parts[p].1.len());
    let of_q = |p: usize, i: usize, j: usize| match (column_of(p, i), column_of(p, j)) {
        (Some(i), Some(j)) => parts[p].1[i][j],
        _ => 0.0,
    };
    let of_g = |p: usize, i: usize, k: usize| column_of(p, i).map_or(0.0, |i| number(&parts[p].2[i][k]));
    let size = order + inputs * parts.len();
    let mut form = vec![vec![0.0; size]; size];
    for (i, row) in form.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().enumerate() {
            let [place, other] = [i, j].map(|i| i.checked_sub(order).map(|k| (k / inputs, k % inputs)));
            *entry = match (place, other) {
                (None, None) => {
                    let own = -moved(i, j) - moved(j, i) - 2.0 * rate * pi[i][j];
                    own - (0..parts.len()).map(|p| of_q(p, i, j)).sum::<f64>()
                }
                (Some((p, k)), Some((q, l))) => {
                    if p == q {
                        parts[p].3[k][l]
                    } else {
                        0.0
                    }
                }
                (None, Some((p, k))) => of_g(p, i, k) - driven(i, k),
                (Some((p, k)), None) => of_g(p, j, k) - driven(j, k),
            };
        }
    }
    let mut least = f64::MAX;
    while let Some(row) = form.pop() {
        // By elimination from the last row on.
        let Some((pivot, rest)) = row.split_last() else { break };
        least = least.min(*pivot);
        if *pivot <= 0.0 {
            break;
        }
        for (above, factor) in form.iter_mut().zip(rest) {
            above.pop();
            above.iter_mut().zip(rest).for_each(|(entry, other)| *entry -= factor / pivot * other);
        }
    }
    least
}

/// (K) holds up to the rate up to which the loop written down in another way says so, at the worse end of an input gain.
#[test]
fn up_to_the_rate_that_the_loop_has() {
    for (name, _, _, ends, _) in all() {
        let certificate = stored(name);
        for which in 0..certificate["claim"]["for_n_o"].as_array().unwrap().len() {
            let place = format!("/claim/for_n_o/{which}/rate");
            let before = number(certificate.pointer(&place).unwrap());
            let holds = |rate: f64| ends.into_iter().all(|b| pivot(&certificate, which, b, rate) > 0.0);
            let (mut low, mut high) = (before, 4.0 * before);
            assert!(holds(low) && !holds(high), "{name} {which}");
            for _ in 0..40 {
                let middle = f64::midpoint(low, high);
                if holds(middle) { low = middle } else { high = middle }
            }
            let at = |factor: f64| edited(certificate.clone(), &[(&place, json!(format!("{:.12}", low * factor)))]);
            // The range of an input gain of parameters is a little wider in the checker.
            accepted(&at(1.0 - 1e-5));
            refused(at(1.0 + 1e-5), Verdict::Invalid, "rates", &format!("/witness/for_n_o/{which}/Pi"));
        }
    }
}

#[test]
fn each_number_matters() {
    for (name, ..) in all() {
        let certificate = stored(name);
        let count = certificate["claim"]["for_n_o"].as_array().unwrap().len();
        for i in 0..count {
            let (claim, witness) = (format!("/claim/for_n_o/{i}"), format!("/witness/for_n_o/{i}"));
            let mut changes = vec![
                (format!("{claim}/factor"), 1.0 - 1e-2, format!("{claim}/factor")),
                (format!("{witness}/e_low"), 1.0 - 2e-2, format!("{claim}/factor")),
                (format!("{witness}/e_low"), 3.0, format!("{witness}/e_low")),
                (format!("{witness}/x_up"), 0.3, format!("{witness}/z_up")),
                (format!("{witness}/e_up"), 0.3, format!("{witness}/z_up")),
                (format!("{witness}/z_up"), 0.3, format!("{witness}/z_up")),
                (format!("{witness}/Pi/0/0"), 9.0, witness.clone()),
                (format!("{witness}/Pi/0/0"), -1.0, format!("{witness}/e_low")),
                (format!("{witness}/Pi/1/1"), 9.0, witness.clone()),
                (format!("{witness}/Pi/2/2"), 9.0, witness.clone()),
            ];
            // What is larger costs a larger factor.
            changes
                .extend(["x_up", "e_up", "z_up"].map(|up| (format!("{witness}/{up}"), 3.0, format!("{claim}/factor"))));
            each_refused(&certificate, &changes);
        }
    }
}

/// The pointers of the numbers of a matrix of slopes that stand there.
fn entries(certificate: &Value, slopes: &str, matrix: &str) -> Vec<String> {
    let rows = certificate.pointer(&format!("{slopes}/{matrix}")).unwrap().as_array().unwrap();
    let row = |(i, row): (usize, &Value)| (0..row.as_array().unwrap().len()).map(move |j| (i, j)).collect::<Vec<_>>();
    let places = rows.iter().enumerate().flat_map(row);
    places.map(|(i, j)| format!("{slopes}/{matrix}/{i}/{j}")).collect()
}

/// Every entry of Q, G and H by much, in both directions: (K) or (D) fails. Of those on the diagonal of Q and H one says which.
#[test]
fn each_number_of_the_slopes_matters() {
    for (name, ..) in all() {
        let certificate = stored(name);
        let witness = "/witness/for_n_o/0";
        for (slopes, matrix) in
            pieces(&certificate, witness).iter().flat_map(|(slopes, _)| ["Q", "G", "H"].map(|matrix| (slopes, matrix)))
        {
            let places = entries(&certificate, slopes, matrix);
            let value = |place: &String| certificate.pointer(place).unwrap().clone();
            let size = places.iter().map(|place| number(&value(place)).abs()).fold(0.0, f64::max);
            for (offset, place) in places.iter().enumerate() {
                // Up and down by turns in an ordinary run.
                for sign in [1.0, -1.0].into_iter().skip(offset % every(2)).step_by(every(2)) {
                    let moved = json!(format!("{:.12}", number(&value(place)) + sign * 3.0 * size));
                    let made = edited(certificate.clone(), &[(place, moved)]);
                    let diagonal = place.ends_with("/0/0") || place.ends_with("/1/1");
                    let expected = match (matrix, diagonal, sign > 0.0) {
                        ("Q", true, true) => format!("{witness}/Pi"),
                        ("Q", true, false) | ("H", true, true) => slopes.clone(),
                        ("H", true, false) => format!("{slopes}/H"),
                        _ => witness.to_owned(),
                    };
                    // Before the square of a slope in e that is none, or, in the small ball of the first, nearly none.
                    let small: &[&str] = if name == "splitting.parts" { &["/0/0", "/1/1"] } else { &["/0/0"] };
                    let of_error = place.contains("/error/H/") && sign > 0.0;
                    if of_error && small.iter().any(|end| place.ends_with(end)) {
                        accepted(&made);
                        continue;
                    }
                    refused(made, Verdict::Invalid, "rates", &expected);
                }
            }
        }
    }
}

/// H has to be definite: (K) says so of one that is semidefinite.
#[test]
fn h_is_definite() {
    let certificate = stored("pendulum");
    let witness = "/witness/for_n_o/0";
    let (h, zero) = (format!("{witness}/slopes/H"), json!([["0"], ["0", "0"], ["0", "0", "0"]]));
    let report = judged(&edited(certificate.clone(), &[(&h, zero)]));
    assert!(report.verdict == Verdict::Undecided || report.verdict == Verdict::Invalid);
    assert!(report.finding.unwrap().pointer.starts_with(&format!("{witness}/Pi")));
    for (i, value) in [(0, "-1e-30"), (1, "-1"), (2, "-1e-9")] {
        let made = edited(certificate.clone(), &[(&format!("{h}/{i}/{i}"), json!(value))]);
        refused(made, Verdict::Invalid, "rates", &h);
    }
}

#[test]
fn signs_are_demanded() {
    let certificate = stored("pendulum");
    for (pointer, names) in [("/claim/for_n_o/0", &["rate", "factor"][..]), ("/witness/for_n_o/0", &["e_low"])] {
        signs_are_demanded_at(&certificate, names.iter().map(|name| format!("{pointer}/{name}")));
    }
    for name in ["x_up", "e_up", "z_up"] {
        let pointer = format!("/witness/for_n_o/0/{name}");
        for value in ["0", "-1"] {
            let made = edited(certificate.clone(), &[(&pointer, json!(value))]);
            refused(made, Verdict::Invalid, "rates", "/witness/for_n_o/0/z_up");
        }
    }
}

/// Slopes that hold at thousands of drawn points, and not near e = 0, where friction is steep: everything but (D) is right.
#[test]
fn what_holds_at_points_alone_is_refused() {
    let sampled = with("family-gain.sampled", ["plants", "family-gain.certificate"]);
    let slopes = &sampled["witness"]["for_n_o"][0]["slopes"];
    let entry = |name: &str, i: usize, j: usize| number(&slopes[name][i][j]);
    let (q, h) =
        (|i: usize, j: usize| entry("Q", i.max(j), i.min(j)), |i: usize, j: usize| entry("H", i.max(j), i.min(j)));
    let holds = |j: f64, b: f64, e: f64| {
        let d = [[-200.0, 150.0], [100.0 / j, -(b + 40.0 / e.cosh().powi(2)) / j]];
        let sum = |value: &dyn Fn(usize, usize) -> f64| (0..4).map(|place| value(place / 2, place % 2)).sum::<f64>();
        let g_d = |i: usize, j: usize| (0..2).map(|k| entry("G", i, k) * d[k][j]).sum::<f64>();
        let left = |i: usize, j: usize| q(i, j) - g_d(i, j) - g_d(j, i) - sum(&|k, l| d[k][i] * h(k, l) * d[l][j]);
        left(0, 0) > 0.0 && left(0, 0) * left(1, 1) > left(0, 1).powi(2)
    };
    for k in 0..1000_u32 {
        let share = |of: u32| f64::from(k % of) / f64::from(of - 1);
        let e = 6_116_565.8 * (2.0 * f64::from(k) / 999.0 - 1.0);
        assert!(holds(0.7 + 0.6 * share(7), 30.0 + 60.0 * share(11), e), "{k}");
    }
    assert!(!holds(0.7, 90.0, 0.0));
    let report = judged(&sampled);
    assert!(
        report.lines.iter().filter(|line| line.trim_start().starts_with("R holds")).count() == 2,
        "{:?}",
        report.lines
    );
    assert_refused(&report, Verdict::Invalid, "rates", "/witness/for_n_o/0/slopes");
}

/// Slopes in parts that hold nearer to e = 0 than the inequality does, and everything but that is right: (D_s) within a tenth of the E of
/// the splitting, (D_e) within a twentieth of its own.
#[test]
fn what_holds_in_a_smaller_region_is_refused() {
    for (part, verdict, at) in [("states", Verdict::Invalid, "states"), ("error", Verdict::Undecided, "error")] {
        let made = with(&format!("gain-splitting.{part}"), ["gain", "splitting"]);
        let rate = number(&made["claim"]["for_n_o"][0]["rate"]);
        assert!([0.5, 1.5].into_iter().all(|b| pivot(&made, 0, b, rate) > 0.0), "{part}");
        let report = judged(&made);
        assert_refused(&report, verdict, "rates", &format!("/witness/for_n_o/0/slopes/{at}"));
        assert!(report.lines.iter().any(|line| line.trim_start().starts_with("R holds")), "{:?}", report.lines);
    }
}

/// Both ends of an input gain are asked for: each of these is right at one end and at 1.
#[test]
fn both_ends_of_an_input_gain() {
    for (part, fails, ends) in
        [("gain-converter.low", ", at b_hi", [0.9, 1.0]), ("gain-converter.high", ", at b_lo", [1.0, 1.1])]
    {
        let made = with(part, ["gain", "converter"]);
        let rate = number(&made["claim"]["for_n_o"][0]["rate"]);
        assert!(ends.into_iter().all(|b| pivot(&made, 0, b, rate) > 0.0), "{part}");
        let report = judged(&made);
        assert_refused(&report, Verdict::Invalid, "rates", "/witness/for_n_o/0/Pi");
        let message = report.finding.unwrap().message;
        assert!(message.contains("(K) for n_o = 0") && message.ends_with(fails), "{message}");
    }
}

/// What proves one n_o proves no other.
#[test]
fn a_rate_is_that_of_its_own_number() {
    let certificate = stored("joint");
    let [claim, witness] = ["claim", "witness"].map(|part| certificate[part]["for_n_o"].clone());
    let with = |changes: &[(&str, Value)]| edited(certificate.clone(), changes);
    let other = with(&[("/claim/for_n_o/1/n_o", json!(3)), ("/witness/for_n_o/1/n_o", json!(3))]);
    refused(other, Verdict::BadInput, "format", "/witness/for_n_o/1/Pi");
    refused(with(&[("/claim/for_n_o/1/n_o", json!(3))]), Verdict::BadInput, "format", "/witness/for_n_o/1/n_o");
    let both = |claim: Value, witness: Value| with(&[("/claim/for_n_o", claim), ("/witness/for_n_o", witness)]);
    refused(both(claim.clone(), json!([witness[0]])), Verdict::BadInput, "format", "/witness/for_n_o");
    refused(both(json!([claim[0]]), witness.clone()), Verdict::BadInput, "format", "/witness/for_n_o");
    refused(with(&[("/witness/for_n_o", Value::Null)]), Verdict::BadInput, "format", "/witness/for_n_o");
    refused(with(&[("/claim/for_n_o", Value::Null)]), Verdict::BadInput, "format", "/witness/for_n_o");
    accepted(&both(json!([claim[1]]), json!([witness[1]])));
    let lent = with(&[("/claim/for_n_o/1/rate", claim[0]["rate"].clone())]);
    refused(lent, Verdict::Invalid, "rates", "/witness/for_n_o/1/Pi");
    // The Pi of n_o = 2 with what stands in the last oscillator left out is none of n_o = 1.
    let mut shorter = both(json!([claim[1]]), json!([witness[1]]));
    let pi = witness[1]["Pi"].as_array().unwrap();
    shorter["claim"]["for_n_o"][0]["n_o"] = json!(1);
    shorter["witness"]["for_n_o"][0]["n_o"] = json!(1);
    shorter["witness"]["for_n_o"][0]["Pi"] = json!(pi[..6]);
    shorter["claim"]["for_n_o"][0]["rate"] = claim[0]["rate"].clone();
    refused(shorter, Verdict::Invalid, "rates", "/witness/for_n_o/0/Pi");
}

/// A rate is proved at the gain of the claim, and for its set.
#[test]
fn a_rate_is_that_of_the_gain_and_of_the_set() {
    let certificate = stored("pendulum");
    let larger = times(&certificate, "/claim/sigma_star", 8.0);
    let moved = edited(certificate, &[("/claim/sigma_star", larger)]);
    let alone = edited(moved.clone(), &[("/claim/for_n_o", Value::Null), ("/witness/for_n_o", Value::Null)]);
    accepted(&alone);
    refused(moved, Verdict::Invalid, "rates", "/witness/for_n_o/0/Pi");
    // A larger set, of a claim that has room for it.
    let certificate = stored("joint");
    let larger = edited(certificate, &[("/claim/initial_set/E0", json!("0.11"))]);
    let alone = edited(larger.clone(), &[("/claim/for_n_o", Value::Null), ("/witness/for_n_o", Value::Null)]);
    accepted(&alone);
    refused(larger, Verdict::Invalid, "rates", "/claim/for_n_o/0/factor");
}

/// (D) is about the formulas: other ones, under their own digest, whose claim holds all the same.
#[test]
fn other_formulas_have_other_slopes() {
    for (name, pointer, value) in [
        ("pendulum", "/plant/q", "theta + e/4 - e/2 + cos(2*pi*t) + cos(4*pi*t)/3"),
        ("joint", "/plant/q", "-4*a + 2*b - e - 7*tanh(e) - e + sin(2*pi*t)"),
    ] {
        let with = |certificate: Value| {
            let mut made = edited(certificate, &[(pointer, json!(value))]);
            rehash(&mut made);
            made
        };
        let report = judged(&with(stored(name)));
        // Either the claim itself does not hold, or its rates do not.
        assert_eq!(report.verdict, Verdict::Invalid, "{name}: {}", report.text(false));
    }
}

#[test]
fn what_cannot_be_read_is_named() {
    let certificate = stored("pendulum");
    let witness = "/witness/for_n_o/0";
    let at = |place: &str| format!("{witness}/{place}");
    for (place, value, refused_at) in [
        ("w", json!("1"), "w"),
        ("l", json!("1"), "l"),
        ("k", json!("1"), "k"),
        ("noise", json!({}), "noise"),
        ("n_o", json!(1), "Pi"),
        ("n_o", json!(101), "n_o"),
        ("Pi", json!([]), "Pi"),
        ("Pi/0", json!([]), "Pi/0"),
        ("Pi/0", json!(["1", "1"]), "Pi/0"),
        ("slopes", json!([]), "slopes"),
        ("slopes/P", json!("1"), "slopes/P"),
        ("slopes/Q", json!([["1"], ["0", "1"]]), "slopes/Q"),
        ("slopes/Q/2", json!(["1", "0"]), "slopes/Q/2"),
        ("slopes/G", json!([["1"], ["0", "1"], ["0", "0", "1"]]), "slopes/G"),
        ("slopes/G/1", json!(["0", "1", "0", "0"]), "slopes/G"),
        ("slopes/H", json!([["1"], ["0", "1"], ["0", "0", "1"], ["0", "0", "0", "1"]]), "slopes/H"),
        ("slopes/H/0", json!("1"), "slopes/H/0"),
        ("slopes/H/1/0", json!("sqrt(2)"), "slopes/H/1/0"),
        ("slopes", Value::Null, "slopes"),
        ("slopes/Q", Value::Null, "slopes/Q"),
        ("slopes/G", Value::Null, "slopes/G"),
        ("slopes/H", Value::Null, "slopes/H"),
        ("x_up", Value::Null, "x_up"),
        ("e_low", Value::Null, "e_low"),
        ("e_up", Value::Null, "e_up"),
        ("z_up", Value::Null, "z_up"),
        ("x_up", json!("inf"), "x_up"),
    ] {
        // What is missing is named as a field of the part that it is missing in.
        let expected =
            if value.is_null() { refused_at.rsplit_once('/').map_or("", |(part, _)| part) } else { refused_at };
        let report = judged(&edited(certificate.clone(), &[(&at(place), value)]));
        assert_refused(&report, Verdict::BadInput, "format", at(expected).trim_end_matches('/'));
    }
    let report = judged(&edited(certificate, &[("/witness/for_n_o", json!([]))]));
    assert_refused(&report, Verdict::BadInput, "format", "/witness/for_n_o");
}

/// Of parts: shapes, what is left out, and what stands beside them.
#[test]
fn parts_that_cannot_be_read_are_named() {
    let certificate = stored("splitting.parts");
    let slopes = "/witness/for_n_o/1/slopes";
    let part = |name: &str| certificate.pointer(&format!("{slopes}/{name}")).unwrap().clone();
    let [of_states, of_error] = [part("states"), part("error")];
    let all = parsed("slopes", "splitting")["witness"][0]["slopes"].clone();
    let longer = |mut rows: Value, row: Value| {
        rows.as_array_mut().unwrap().push(row);
        rows
    };
    let without_last = |rows: &Value| json!(rows.as_array().unwrap().split_last().unwrap().1);
    for (place, value, refused_at) in [
        // Of all columns in the place of two, and the other way round.
        ("states", all.clone(), "states/Q"),
        ("states/Q", all["Q"].clone(), "states/Q"),
        ("states/G", all["G"].clone(), "states/G"),
        ("states/G/1", json!(["1", "2"]), "states/G"),
        ("states/G", json!([["1", "2"], ["3", "4"], ["5", "6"]]), "states/G"),
        ("states/H", of_states["Q"].clone(), "states/H"),
        ("states/Q", without_last(&of_states["Q"]), "states/Q"),
        ("error/Q", longer(of_error["Q"].clone(), json!(["0", "1"])), "error/Q"),
        ("error/Q", json!("1"), "error/Q"),
        ("error/G", longer(of_error["G"].clone(), json!(["0", "0", "1"])), "error/G"),
        ("error/G", json!([]), "error/G"),
        ("error/G", json!([["1"], ["2"], ["3"]]), "error/G"),
        ("error/H", without_last(&of_error["H"]), "error/H"),
        // The two exchanged, and one for both.
        ("states", of_error.clone(), "states/Q"),
        ("error", of_states.clone(), "error/Q"),
        ("error", Value::Null, ""),
        ("states", Value::Null, ""),
        ("states/H", Value::Null, "states"),
        ("error/Q", Value::Null, "error"),
        ("Q", all["Q"].clone(), "Q"),
        ("whole", of_states.clone(), "whole"),
        ("error/x", json!("1"), "error/x"),
    ] {
        let report = judged(&edited(certificate.clone(), &[(&format!("{slopes}/{place}"), value)]));
        let expected = format!("{slopes}/{refused_at}");
        assert_refused(&report, Verdict::BadInput, "format", expected.trim_end_matches('/'));
    }
}

/// Parts stand only in a claim whose inequality has a splitting; beside them, for another n_o, slopes of all columns may.
#[test]
fn parts_need_a_corner() {
    let parts = stored("splitting.parts");
    let slopes = parts["witness"]["for_n_o"][1]["slopes"].clone();
    for name in ["pendulum", "joint"] {
        let report = judged(&edited(stored(name), &[("/witness/for_n_o/0/slopes", slopes.clone())]));
        assert_refused(&report, Verdict::BadInput, "format", "/witness/for_n_o/0/slopes/states");
        let message = report.finding.unwrap().message;
        assert!(message.contains("the slopes of its parts need a path with a corner"), "{message}");
    }
    let straight = edited(parts.clone(), &[("/witness/matrix_inequality/splitting", Value::Null)]);
    refused(straight, Verdict::BadInput, "format", "/witness/for_n_o/0/slopes/states");
    let by_norms = parsed("rates", "paper-example-at-rest");
    let made = edited(by_norms, &[("/witness/for_n_o/0/slopes", slopes)]);
    refused(made, Verdict::BadInput, "format", "/witness/for_n_o/0/slopes");

    let all = stored("splitting");
    let mixed = [("/claim/for_n_o/1", "claim"), ("/witness/for_n_o/1", "witness")]
        .map(|(place, part)| (place, all[part]["for_n_o"][0].clone()));
    let report = accepted(&edited(parts, &mixed));
    let asked = report.lines.iter().filter(|line| line.starts_with("rates: (D"));
    let names: Vec<&str> = asked.map(|line| line["rates: ".len()..].split_once(',').unwrap().0).collect();
    assert_eq!(names, ["(D_s)", "(D_e)", "(D)"]);
}

/// H of each part is demanded not to be negative.
#[test]
fn h_of_each_part_is_definite() {
    let certificate = stored("splitting.parts");
    for (slopes, _) in pieces(&certificate, "/witness/for_n_o/1") {
        for i in 0..3 {
            let at = format!("{slopes}/H");
            let made = edited(certificate.clone(), &[(&format!("{at}/{i}/{i}"), json!("-1e-30"))]);
            refused(made, Verdict::Invalid, "rates", &at);
        }
    }
}

/// Slopes have no place in a claim by norms, w and l none in one by a matrix inequality.
#[test]
fn each_kind_of_claim_has_its_own() {
    let pendulum = stored("pendulum");
    let by_norms = parsed("rates", "paper-example-at-rest");
    let slopes = pendulum["witness"]["for_n_o"][0]["slopes"].clone();
    let made = edited(by_norms.clone(), &[("/witness/for_n_o/0/slopes", slopes)]);
    refused(made, Verdict::BadInput, "format", "/witness/for_n_o/0/slopes");
    let made = edited(by_norms, &[("/witness/for_n_o/0/x_up", json!("1"))]);
    refused(made, Verdict::BadInput, "format", "/witness/for_n_o/0/x_up");
    // The inequality taken away, what is left is a claim by norms, if it is one.
    let made = edited(pendulum.clone(), &[("/witness/matrix_inequality", Value::Null)]);
    refused(made, Verdict::BadInput, "format", "/witness/for_n_o/0");
    // A specification has no formulas.
    let inequality = pendulum["witness"]["matrix_inequality"].clone();
    let mut made = certificate("paper-example.sharp");
    made["witness"]["matrix_inequality"] = inequality;
    made["claim"]["for_n_o"] = pendulum["claim"]["for_n_o"].clone();
    made["witness"]["for_n_o"] = pendulum["witness"]["for_n_o"].clone();
    assert_refused(&judged(&made), Verdict::BadInput, "format", "/witness");
    // At samples there are none by slopes.
    let mut made = parsed("sampled", "plant-motor-axis");
    made["claim"]["for_n_o"] = pendulum["claim"]["for_n_o"].clone();
    made["witness"]["for_n_o"] = pendulum["witness"]["for_n_o"].clone();
    assert_refused(&judged(&made), Verdict::BadInput, "format", "/witness/for_n_o");
}

/// `e' = u + q(t)`: Q, G and H are numbers, and there is no x_up.
#[test]
fn without_states() {
    let mut made = parsed("plants", "no-states.certificate");
    made["witness"].as_object_mut().unwrap().remove("exact_regulation");
    let metric = json!({
        "P": [], "w": "1", "k_p": "1", "c_x": "1", "c_e": "1/10", "c_y": "1/10", "P_up": "1/1000000", "x_low": "1", "e_low": "1",
    });
    let mut near = metric.clone();
    near["p"] = json!([]);
    let sigma = made["claim"]["sigma_star"].clone();
    made["witness"]["joint_inequality"] =
        json!({ "X": "1000", "E": "1000", "sigma": sigma, "near": near, "far": metric });
    for radius in ["D_x", "D_e"] {
        made["witness"][radius] = "100".into();
    }
    made["claim"]["for_n_o"] = json!([{ "n_o": 0, "rate": "1.9", "factor": "2.2" }]);
    made["witness"]["for_n_o"] = json!([{
        "n_o": 0, "Pi": [["1"], ["0", "1"]], "slopes": { "Q": [["0"]], "G": [["0"]], "H": [["100"]] },
        "e_low": "0.99", "e_up": "1.01", "z_up": "1.01",
    }]);
    accepted(&made);
    let witness = "/witness/for_n_o/0";
    for (at, value, verdict, place) in [
        ("x_up", json!("1"), Verdict::BadInput, "x_up"),
        ("Pi", json!([["1"], ["0", "1"], ["0", "0", "1"]]), Verdict::BadInput, "Pi"),
        ("slopes/Q", json!([]), Verdict::BadInput, "slopes/Q"),
        ("slopes/Q/0/0", json!("-1e-9"), Verdict::Invalid, "slopes"),
        ("slopes/Q/0/0", json!("37"), Verdict::Invalid, "Pi"),
        ("slopes/H/0/0", json!("0.1"), Verdict::Invalid, "Pi"),
        ("slopes/H/0/0", json!("-1"), Verdict::Invalid, "slopes/H"),
        ("slopes/G/0/0", json!("-80"), Verdict::Invalid, "Pi"),
    ] {
        let rule = if verdict == Verdict::BadInput { "format" } else { "rates" };
        let forged = edited(made.clone(), &[(&format!("{witness}/{at}"), value)]);
        refused(forged, verdict, rule, &format!("{witness}/{place}"));
    }
    // zs falls at the rate 2, for b'b mu = 2.
    let faster = edited(made, &[("/claim/for_n_o/0/rate", json!("2.01"))]);
    refused(faster, Verdict::Invalid, "rates", &format!("{witness}/Pi"));
}
