//! Trials of families (docs/mathematics.md, section 14.4): plants with a parameter a in an interval, whose periodic solutions are known.

use crate::trials_support::{
    Case, FORMULAS, L, OFF, SIGMA, Wave, answered, asks_for_a_domain, expected, first, largest, oscillators, text,
};
use proofs_check::verdict::Verdict::{BadInput, Invalid};
use serde_json::{Value, json};
use std::f64::consts::TAU;

/// How far a is from 1.
const APART: f64 = 0.1;

/// The share of the slope of x that the orbit has.
const OF_ORBIT: f64 = 0.25;

/// f and q of x, e and a.
fn values(x: f64, e: f64, a: f64) -> [f64; 2] {
    let [_, q] = (FORMULAS.values)(x, e);
    [-2.0 * a * x - x.powi(3) / 60.0 + e / 2.0, q + (a - 1.0) * e]
}

/// The coefficients of `a - 1` of a polynomial of the degree 4 in it, by its values at -2, ..., 2.
fn coefficients(value: impl Fn(f64) -> f64) -> [f64; 5] {
    let [a, b, c, d, e] = [-2.0, -1.0, 0.0, 1.0, 2.0].map(value);
    let (odd, more) = ((d - b) / 2.0, (e - a) / 4.0);
    let (even, twice) = ((d + b) / 2.0 - c, ((e + a) / 2.0 - c) / 4.0);
    let (third, fourth) = ((more - odd) / 3.0, (twice - even) / 3.0);
    [c, odd - third, even - fourth, third, fourth]
}

/// The curves of the solution that stand beside `a - 1`: of x and e, and q along them.
fn slopes(n_o: usize) -> [Wave; 3] {
    let e: Vec<[f64; 2]> =
        (1..=3).map(|k| if k <= n_o { [0.0; 2] } else { [[0.0, 0.1], [0.2, -0.4], [0.3, 0.0]][k - 1] }).collect();
    let free = [[-0.4, 0.3], [0.2, 0.2], [0.0, 0.0]];
    let q = (1..=3).map(|k| if k <= n_o { free[k - 1] } else { answered(&first(n_o), k, e[k - 1]) }).collect();
    [Wave(-0.5, vec![[0.3, -0.2], [0.1, 0.0]]), Wave(0.0, e), Wave(-0.2, q)]
}

/// `first + (a - 1) slope`.
fn moved(first: &Wave, slope: &Wave, apart: f64) -> Wave {
    let count = first.1.len().max(slope.1.len());
    let pair = |wave: &Wave, k: usize| wave.1.get(k).copied().unwrap_or_default();
    let sum = |k: usize| [0, 1].map(|i| pair(first, k)[i] + apart * pair(slope, k)[i]);
    Wave(first.0 + apart * slope.0, (0..count).map(sum).collect())
}

/// `e' - q`.
fn control(e: &Wave, q: &Wave) -> Wave {
    let u = Wave::of(|t| e.at(t, 1) - q.at(t, 0));
    Wave(u.0, u.1[..3].to_vec())
}

/// The exponents of a member, with its curves.
fn member(powers: &[u32], x: &Wave, e: &Wave, u: &Wave) -> Value {
    json!({ "powers": powers, "x": x.json(true, true), "e": e.json(false, false), "u": u.json(true, false) })
}

/// A family whose solutions are affine in a; the orbit moves by a share of what x does.
fn case(n_o: usize) -> Case {
    let mut case = Case::new(n_o, FORMULAS);
    let [x, e, q] = slopes(n_o);
    let at = |apart: f64| [moved(&case.x, &x, apart), moved(&case.e, &e, apart), moved(&case.q, &q, apart)];
    let needed = |t: f64, which: usize| {
        coefficients(|apart| {
            let [x, e, q] = at(apart);
            let own = values(x.at(t, 0), e.at(t, 0), 1.0 + apart)[which];
            [x.at(t, 1), q.at(t, 0)][which] - own
        })
    };
    let besides = |which: usize| -> String {
        let of = |j: usize| format!(" + (a - 1)^{j}*({})", Wave::of(|t| needed(t, which)[j]).text());
        (0..5).map(of).collect()
    };
    let f = format!("-2*a*x - x^3/60 + e/2{}", besides(0));
    let text_of_q = format!("{} + (a - 1)*e{}", FORMULAS.q, besides(1));
    case = case
        .part("/plant/f", json!([f]))
        .part("/plant/q", text_of_q)
        .part("/plant/parameters", json!({ "a": { "nominal": "1", "low": "0.9", "high": "1.1" } }));
    let slope = moved(&Wave(0.0, Vec::new()), &x, OF_ORBIT);
    case.parts.0["witness"]["orbit"]["sensitivities"] = json!([slope.json(true, true)]);
    case.parts.0["witness"]["forcing"]["sensitivities"] = json!([{ "mean": "0", "harmonics": [] }]);
    case.trial["members"] = json!([member(&[1], &x, &e, &control(&e, &q))]);
    // The slope of q by e is larger by up to 0.1.
    case.trial("/q_e", "1.1").trial("/q_x", "1.7").trial("/forms/0/c_y", "0.1").trial("/forms/0/c_x", "1.2")
}

#[test]
fn the_solutions_themselves_are_a_trial() {
    for n_o in 0..3 {
        case(n_o).accepted();
        case(n_o).steady_alone().accepted();
    }
    // Curves that do not move are not those of the members.
    let mut without = case(1);
    without.trial.as_object_mut().unwrap().remove("members");
    without.refused(Invalid, "/defect_x");
    // Each curve counts, at each harmonic.
    for (at, value, place) in [
        ("/x/mean/0", "-0.501", "/defect_x"),
        ("/x/harmonics/1/sin/0", "0.001", "/defect_x"),
        ("/e/harmonics/1/cos", "0.201", "/defect_x"),
        ("/u/mean", "0.201", "/defect_q"),
        ("/u/harmonics/0/cos", "0.401", "/defect_q"),
    ] {
        case(1).trial(&format!("/members/0{at}"), value).refused(Invalid, place);
    }
    // What is beyond n_o is in kappa.
    let u = case(1).trial["members"][0]["u"]["harmonics"][2]["cos"].as_str().unwrap().parse::<f64>().unwrap();
    case(1).trial("/members/0/u/harmonics/2/cos", text(u + 1e-3)).refused(Invalid, "/defect_q");
    // The formulas are those of all members.
    let wider = json!({ "a": { "nominal": "1", "low": "0.9", "high": "1.1001" } });
    case(1).part("/plant/parameters", wider).accepted();
    let other = json!({ "a": { "nominal": "1.01", "low": "0.9", "high": "1.1" } });
    case(1).part("/plant/parameters", other).refused(Invalid, "/defect_x");
}

/// A trial that is off by a known size, along a alone.
#[test]
fn defects_are_those_of_all_members() {
    let off = |at: &str, value: &str| case(1).trial(&format!("/members/0{at}"), value);
    let of_q = off("/u/mean", "0.21");
    of_q.trial("/defect_q", "0.001001").accepted();
    of_q.trial("/defect_q", "0.000999").refused(Invalid, "/defect_q");
    // At the nominal member it is 0: one that is off there alone.
    let both = of_q.trial("/u/mean", "-0.3002");
    both.trial("/defect_q", "0.001201").accepted();
    both.trial("/defect_q", "0.001199").refused(Invalid, "/defect_q");
}

/// A harmonic that the law does not put out is in the defect, and in kappa once more, that of every power of `a - 1`.
#[test]
fn what_the_law_does_not_put_out_counts_for_every_member() {
    let at = "/members/0/u/harmonics/2/cos";
    let u = case(1).trial.pointer(at).unwrap().as_str().unwrap().parse::<f64>().unwrap();
    let off = case(1).trial(at, text(u + 1e-3));
    off.trial("/defect_q", text(2e-3 * APART * (1.0 + 1e-4))).accepted();
    off.trial("/defect_q", text(2e-3 * APART * (1.0 - 1e-4))).refused(Invalid, "/defect_q");
}

/// One that is large in a corner of the interval alone: at the middle it is 0 to fifteen digits, with all its derivatives.
#[test]
fn a_defect_is_seen_where_it_is() {
    let q =
        case(1).parts.0["plant"]["q"].as_str().unwrap().to_owned() + " + (1 + tanh(400*(a - 1.09)))*cos(4*pi*t)/1000";
    let case = case(1).part("/plant/q", q);
    case.trial("/defect_q", "1e-6").refused(Invalid, "/defect_q");
    case.trial("/defect_q", "0.002001").accepted();
    case.trial("/defect_q", "0.00199").refused(Invalid, "/defect_q");
}

/// Sizes are those of all members: the sum at each time of what stands beside each power.
#[test]
fn sizes_are_those_of_all_members() {
    for n_o in 0..3 {
        let case = case(n_o);
        let [x, e, q] = slopes(n_o);
        let u = control(&e, &q);
        let nominal = expected(&case);
        let of_e = largest(|t| case.e.at(t, 0).abs() + APART * e.at(t, 0).abs());
        let rms = |wave: &Wave| (wave.1.iter().flatten().map(|part| part * part).sum::<f64>() / 2.0).sqrt();
        let of_u = largest(|t| (case.e.at(t, 1) - case.q.at(t, 0)).abs() + APART * u.at(t, 0).abs());
        for (at, right, alone) in [
            ("e", of_e, nominal.steady[0]),
            ("e_rms", rms(&case.e) + APART * rms(&e), nominal.steady[1]),
            ("u", of_u, nominal.steady[2]),
        ] {
            let at = format!("/steady/{at}");
            case.entry(&at, text(right * (1.0 + 1e-7) + 1e-9)).accepted();
            if right > alone {
                assert!(alone < right * (1.0 - 1e-3) || right == 0.0, "{at} {alone} {right}");
                case.entry(&at, text(right * (1.0 - 1e-7))).refused(Invalid, &format!(":/claim/by_n_o/0{at}"));
            }
        }
        // How far x is from the orbit of the member, and which solution it is.
        let x_n = largest(|t| (OFF[0] + APART * (1.0 - OF_ORBIT) * x.at(t, 0).abs()) / L) + OFF[1];
        let small = case.steady_alone().trial("/box/x", "0.1").trial("/box/e", "0.1");
        for (which, size) in [(0, x_n), (1, of_e)] {
            let with = |factor: f64| {
                let mut radii = [1.0; 2];
                radii[which] = (size + 0.1) * factor;
                Case { error_box: radii.map(|radius| format!("{radius:e}")), ..small.clone() }
            };
            with(1.0 + 1e-7).accepted();
            with(1.0 - 1e-7).refused(Invalid, "");
        }
        let sizes = [L * (x_n + 2.0), of_e + 2.0];
        asks_for_a_domain(|| case.clone(), sizes, [1e-6, 1e-6], "/box");
    }
}

/// Of an interval whose ends are not as far from the nominal value the further one counts.
#[test]
fn the_further_end_counts() {
    let (of_both, [_, e, _]) = (case(1), slopes(1));
    let of_e = largest(|t| of_both.e.at(t, 0).abs() + APART * e.at(t, 0).abs());
    for [low, high] in [["0.9", "1.05"], ["0.95", "1.1"]] {
        let case = of_both.part("/plant/parameters", json!({ "a": { "nominal": "1", "low": low, "high": high } }));
        case.entry("/steady/e", text(of_e * (1.0 + 1e-7))).accepted();
        case.entry("/steady/e", text(of_e * (1.0 - 1e-7))).refused(Invalid, ":/claim/by_n_o/0/steady/e");
    }
}

/// zhat moves with the members, too: what it adds counts in the peaks.
#[test]
fn the_peaks_are_those_of_all_members() {
    let case = case(2);
    let [x, _, q] = slopes(2);
    let size = |wave: &Wave| {
        let within = |k: usize| wave.1[k - 1].iter().map(|part| part * part).sum::<f64>() / (k as f64).powf(-1.5);
        (wave.0 * wave.0 / 2.0 + within(1) + within(2)).sqrt()
    };
    let beyond = |wave: &Wave| {
        let [both, _, slope] = oscillators(&first(2), 3);
        let [a, b] = wave.1[2];
        slope * both * a.hypot(b) / TAU
    };
    let [_, e, _] = slopes(2);
    let z_n = size(&case.q) + beyond(&case.e) + APART * (size(&q) + beyond(&e));
    let e_n = largest(|t| case.e.at(t, 0).abs() + APART * e.at(t, 0).abs());
    let x_n = largest(|t| (OFF[0] + APART * (1.0 - OF_ORBIT) * x.at(t, 0).abs()) / L) + OFF[1];
    let n_bar = crate::trials_support::n_bar(2);
    let [d_x, d_e, d_z] = [0.05 + x_n, 0.04 + e_n, 0.1 + n_bar * 0.04 + z_n];
    let v_0 = d_x * d_x + 0.1 * d_x * d_e + d_e * d_e + 0.4 * d_z * d_z;
    let u = control(&e, &q);
    let of_u = largest(|t| (case.e.at(t, 1) - case.q.at(t, 0)).abs() + APART * u.at(t, 0).abs());
    let e_low = 0.9975;
    let bounds = [
        ("/largest/e", e_n + (v_0 / e_low).sqrt()),
        ("/largest/u", of_u + (v_0 * (SIGMA * SIGMA / e_low + 2.0 * n_bar * n_bar / 0.8)).sqrt()),
    ];
    for (at, number) in bounds {
        case.entry(at, text(number * (1.0 + 1e-7))).accepted();
        case.entry(at, text(number * (1.0 - 1e-7))).refused(Invalid, &format!(":/claim/by_n_o/0{at}"));
    }
}

/// The box is around the curves of each member, and the formulas are those of the member.
#[test]
fn the_box_is_that_of_every_member() {
    let case = case(1);
    let [x, e, _] = slopes(1);
    let apart = |j: i32| f64::from(j) / 50.0 * APART;
    let most = |value: &dyn Fn(f64, f64) -> f64| {
        let at = |j: i32| largest(|t| value(t, apart(j)).abs());
        [(-50..=50).map(at).fold(0.0, f64::max), at(0)]
    };
    // In the coordinates `r = 1 + e/5`.
    let [r, nominal] = most(&|t, apart| 1.0 + (case.e.at(t, 0) + apart * e.at(t, 0) + 2.0) / 5.0);
    assert!(nominal < r * (1.0 - 2e-3), "{nominal} {r}");
    case.trial("/q_x", text(r * 1.0001)).accepted();
    case.trial("/q_x", text(r * 0.9999)).refused(Invalid, "/q_x");
    // `d = a - 1 - 3 e^2/50 + x/10`: the least is where a is.
    let [d, nominal] = most(&|t, apart| {
        let (x, e) = (case.x.at(t, 0) + apart * x.at(t, 0), case.e.at(t, 0) + apart * e.at(t, 0));
        0.06 * (e.abs() + 2.0).powi(2) + (4.0 - x) / 10.0 - apart
    });
    assert!(nominal < d * (1.0 - 2e-2), "{nominal} {d}");
    case.trial("/q_e", text(d * 1.0001)).accepted();
    case.trial("/q_e", text(d * 0.9999)).refused(Invalid, "/q_e");
    // (14.4b) at x = 0 and the least a: `3.6 - 2 c` against `g^2/gamma`, g = 1/4.
    let c = 1.8 - 0.0625 / 0.05 / 2.0;
    case.trial("/states/c", text(c * 0.9999)).accepted();
    case.trial("/states/c", text(c * 1.0001)).refused(Invalid, "/states");
    let alone = crate::trials_support::Case::new(1, FORMULAS);
    alone.trial("/states/c", text(c * 1.0001)).accepted();
}

#[test]
fn the_form_of_members() {
    let changed = |change: &dyn Fn(&mut Value)| {
        let mut case = case(1);
        change(&mut case.trial["members"]);
        case
    };
    for name in ["powers", "x", "e", "u"] {
        changed(&|list| drop(list[0].as_object_mut().unwrap().remove(name))).refused(BadInput, "/members/0");
    }
    for powers in [json!([]), json!([1, 0]), json!([1, 1]), json!([0]), json!([9])] {
        case(1).trial("/members/0/powers", powers).refused(BadInput, "/members/0/powers");
    }
    for powers in [json!([-1]), json!([0.5]), json!(["1"])] {
        case(1).trial("/members/0/powers", powers).refused(BadInput, "/members/0/powers/0");
    }
    case(1).trial("/members/0/powers", json!(1)).refused(BadInput, "/members/0/powers");
    changed(&|list| *list = json!([list[0], list[0]])).refused(BadInput, "/members/1/powers");
    changed(&|list| *list = json!([])).refused(BadInput, "/members");
    changed(&|list| *list = json!(vec![list[0].clone(); 65])).refused(BadInput, "/members");
    changed(&|list| list[0]["more"] = "1".into()).refused(BadInput, "/members/0/more");
    changed(&|list| list[0]["e"]["harmonics"][0]["cos"] = "1e-30".into()).refused(Invalid, "/members/0/e");
    // Of the eighth power, with curves that are 0, nothing is said.
    let nothing = |powers: &[u32]| member(powers, &Wave(0.0, vec![]), &Wave(0.0, vec![]), &Wave(0.0, vec![]));
    changed(&|list| *list = json!([list[0], nothing(&[8])])).accepted();
    // Where nothing is an interval there is no such part.
    let mut alone = Case::new(1, FORMULAS);
    alone.trial["members"] = json!([nothing(&[])]);
    alone.refused(BadInput, "/members");
}

/// `e' = -a e + cos(4 pi t) + u` with one oscillator: the harmonic of e is `1/(2 D)`, `D = i om + a + sigma + i y (i om + sigma)`, and what is left of its
/// Taylor polynomial of degree K in `a - 1` is `|(a - 1)/D|^(K+1)` at the largest, with D at 1.
#[test]
fn a_plant_without_states() {
    let [_, y, _] = oscillators(&first(1), 2);
    let om = 2.0 * TAU;
    // The number before e in u is minus `sigma + i y (i om + sigma)`.
    let turn = [SIGMA - y * om, y * SIGMA];
    let d = [1.0 + turn[0], om + turn[1]];
    let over =
        |[a, b]: [f64; 2], [c, d]: [f64; 2]| [(a * c + b * d) / (c * c + d * d), (b * c - a * d) / (c * c + d * d)];
    let times = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [a * c - b * d, a * d + b * c];
    let waves = |value: [f64; 2]| Wave(0.0, vec![[0.0; 2], [value[0], -value[1]]]);
    let curves = |j: i32| {
        let e = (0..j).fold(over([1.0, 0.0], d), |e, _| over([-e[0], -e[1]], d));
        let u = times([-turn[0], -turn[1]], e);
        [waves(e), waves(u)]
    };
    let with = |degree: i32, apart: f64| {
        let formulas = crate::trials_support::Formulas { q: "e/10", values: |_, e| [0.0, e / 10.0], ..FORMULAS };
        let mut case = Case::without_states(1, formulas).part("/plant/q", "-a*e + cos(4*pi*t)").part(
            "/plant/parameters",
            json!({ "a": { "nominal": "1", "low": (1.0 - apart).to_string(), "high": (1.0 + apart).to_string() } }),
        );
        case.parts.0["witness"]["orbit"]["sensitivities"] = json!([{ "mean": [], "harmonics": [] }]);
        case.parts.0["witness"]["forcing"]["sensitivities"] = json!([{ "mean": "0", "harmonics": [] }]);
        let members = (1..=degree).map(|j| {
            let [e, u] = curves(j);
            json!({ "powers": [j], "e": e.json(false, false), "u": u.json(true, false) })
        });
        case.trial["members"] = members.collect();
        let [e, u] = curves(0);
        case.trial["e"] = e.json(false, false);
        case.trial["u"] = u.json(true, false);
        case.trial("/q_e", "1.5").trial("/forms/0/k_p", "0.8").trial("/forms/0/c_y", "0.15").trial("/box/e", "2")
    };
    for (degree, apart) in [(1, 0.5), (2, 0.5), (3, 0.25)] {
        let size = (apart / d[0].hypot(d[1])).powi(degree + 1);
        let case = with(degree, apart);
        case.trial("/defect_q", text(size * (1.0 + 1e-3))).accepted();
        case.trial("/defect_q", text(size * (1.0 - 1e-3))).refused(Invalid, "/defect_q");
    }
    let mut of_x = with(1, 0.5).trial("/defect_q", "0.01");
    of_x.accepted();
    of_x.trial["members"][0]["x"] = json!({ "mean": [], "harmonics": [] });
    of_x.refused(BadInput, "/members/0/x");
}
