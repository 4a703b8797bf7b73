//! Every formula of section 10 against floating point, with bounding functions that tell all arguments apart.

use crate::common::{PAPER, certificate};
use proofs_check::data::Data;
use proofs_check::interval::Interval;
use proofs_check::json::{Field, parse};
use proofs_check::rules::control::Answer;
use proofs_check::rules::gains::{beta_s, bt, damped, kappas, tau};
use proofs_check::rules::mean_squares::{self, Witness};
use proofs_check::rules::paths::{Path, Paths};
use proofs_check::rules::regulation;
use proofs_check::rules::set::ClaimedSet;
use proofs_check::rules::stability::ErrorBox;
use proofs_check::spec::Specification;
use rug::Rational;
use serde_json::{Value, json};

fn specification(document: &Value) -> Specification {
    let (json, none) = (parse(document.to_string().as_bytes()).unwrap(), parse(b"{}").unwrap());
    let field = |json| Field { json, pointer: String::new() };
    Specification::read(&field(&json), &mut field(&none).fields().unwrap()).unwrap_or_else(|e| panic!("{e:?}"))
}

#[track_caller]
fn close(what: &str, value: &Interval, expected: f64) {
    let (lo, hi) = (value.lo().to_f64(), value.hi().to_f64());
    assert!(
        (lo - expected).abs() + (hi - expected).abs() <= 1e-9 * expected.abs(),
        "{what}: [{lo}, {hi}], not {expected}"
    );
}

/// Which optional data are there.
#[derive(Clone, Copy, Debug)]
struct Given {
    f_x: bool,
    most: bool,
    bends: bool,
    rms: bool,
    /// `q_0`, and its `rest_t_rms`.
    q_0: [bool; 2],
    matched: bool,
    /// b_lo and b_hi of `input_gain`.
    gain: Option<[f64; 2]>,
    /// The ends of the period, which else is 2.
    period: Option<[f64; 2]>,
}

/// Of the optional data nothing.
const NOTHING: Given = Given {
    f_x: false,
    most: false,
    bends: false,
    rms: false,
    q_0: [false; 2],
    matched: true,
    gain: None,
    period: None,
};

const C: [f64; 4] = [3.0, 0.5, 0.25, 0.125];
const REST: [f64; 2] = [0.0625, 0.5];

/// T = 2, w = pi or 3, mu = 1/2, n_0 = 2, n_l = l^-1.5, P_low = 1, P_up = 4, alpha = 1/2, and linear bounding functions.
fn plant(given: Given) -> Specification {
    let mut document = certificate(PAPER)["specification"].clone();
    document["period"] = match given.period {
        Some([low, high]) => json!({ "nominal": "2", "low": low, "high": high }),
        None => json!("2"),
    };
    document["internal_model"]["mu"] = json!("1/2");
    document["internal_model"]["base_frequency"] = json!(if given.matched { "pi" } else { "3" });
    document["internal_model"]["matched"] = json!(given.matched);
    document["lyapunov"] = json!({ "p_low": "1", "p_up": "4", "alpha": "1/2", "rate": "3 - X - 2*E" });
    document["bounds"] = json!({
        "f": "2*X + 3*E", "f_e": "0.2 + X + 2*E", "f_xx": "3 + 5*X + 7*E", "f_ex": "5 + 7*X + 11*E",
        "q": "17 + 11*X + 13*E", "q_e": "0.5 + 2*X + 3*E", "q_x": "0.3 + 0.5*X + 0.7*E", "q_t": "37 + 19*X + 23*E"
    });
    let mut add = |name: &str, text: &str| document["bounds"][name] = json!(text);
    if given.rms {
        add("q_rms", "4 + X + 2*E");
        add("q_t_rms", "9 + 3*X + E");
    }
    if given.f_x {
        add("f_x", "1 + X + 100*E");
    }
    if given.most {
        add("q_e_max", "X/10 + E/10 - 0.4");
    }
    if given.bends {
        add("q_tx", "0.7 + X/3 + E/5");
        add("q_te", "0.9 + X/7 + E/11");
    }
    if given.q_0[0] {
        let mut q_0 = json!({ "harmonics": C, "rest_rms": REST[0] });
        if given.q_0[1] {
            q_0["rest_t_rms"] = json!(REST[1]);
        }
        document["q_0"] = q_0;
    }
    if let Some([low, high]) = given.gain {
        document["input_gain"] = json!({ "nominal": "2", "low": 2.0 * low, "high": 2.0 * high });
    }
    specification(&document)
}

/// Compares what [`mean_squares::evaluate`] says with the formulas of sections 10.1 to 10.4; whether the form of `q_0` gives Z.
fn compare(given: Given, sigma: Rational, kap: Rational, r: [Rational; 3], last: Option<[Rational; 3]>) -> bool {
    let spec = plant(given);
    let d = Data::new(&spec, 128);
    let (k0, k1) = (40.0, 30.0);
    let pair = [d.int(40), d.int(30)];
    let w = Witness { r: r.clone(), kap: kap.clone(), refined: last.clone() };
    let kappa = kappas(&d, &pair[0], &pair[1]);
    let solution = mean_squares::evaluate(
        &d,
        (&w, None),
        &sigma,
        [&d.ratio(1, 4), &d.ratio(3, 8)],
        ([&pair[0], &pair[1]], d.spec.regulator.matched),
        &kappa,
    );

    // Om of the longest period, and of the shortest (section 13.3).
    let [fast, om] = given.period.unwrap_or([2.0; 2]).map(|end| 2.0 * std::f64::consts::PI / end);
    let (t, mu, w) = (given.period.map_or(2.0, |[_, high]| high), 0.5_f64, if given.matched { om } else { 3.0 });
    let (s, kap, x_p, e_p, c) = (sigma.to_f64(), kap.to_f64(), 0.25_f64, 0.375_f64, 2.0_f64);
    let least = |list: &[f64]| list.iter().copied().fold(f64::INFINITY, f64::min);
    let coth = |z: f64| 1.0 / z.tanh();
    let (f_e, q_x, q_e) = (0.2 + x_p + 2.0 * e_p, 0.3 + 0.5 * x_p + 0.7 * e_p, 0.5 + 2.0 * x_p + 3.0 * e_p);
    let secant = (2.0 * x_p + (3.0 + 5.0 * x_p) * x_p * x_p) / x_p;
    let f_x = if given.f_x { least(&[secant, 1.0 + x_p]) } else { secant };
    let rms = |x: f64, e: f64| if given.rms { 4.0 + x + 2.0 * e } else { 17.0 + 11.0 * x + 13.0 * e };
    let rms_t = |x: f64, e: f64| if given.rms { 9.0 + 3.0 * x + e } else { 37.0 + 19.0 * x + 23.0 * e };
    let m = if given.most { least(&[x_p / 10.0 + e_p / 10.0 - 0.4, q_e]) } else { q_e };
    let sum = |term: &dyn Fn(f64, f64) -> f64| (1..4).map(|k| 2.0 * term(k as f64, C[k])).sum::<f64>();
    let gain = |k: f64| s * s + (k * om).powi(2);
    let slope = sum(&|k, c| (k * fast * c).powi(2)).sqrt();
    let rest = [REST[0], if given.q_0[1] { REST[1] } else { rms_t(0.0, 0.0) + slope }];
    let q_0 = if given.q_0[0] {
        least(&[rms(0.0, 0.0), (C[0] * C[0] + sum(&|_, c| c * c)).sqrt() + rest[0]])
    } else {
        rms(0.0, 0.0)
    };
    // Of section 13.1: b_m, d_b, c_m, and b_lo^3.
    let [b_m, d_b, c_m, swung] = given.gain.map_or([1.0; 4], |[low, high]| {
        let d_b = if low >= 0.5 { 1.0 } else { 0.5 / (low * (1.0 - low)).sqrt() };
        [low, d_b, f64::min(low, 2.0 / (3.0 + high).sqrt()), low.powi(3)]
    });
    let sg = b_m * (s * s + om * om).sqrt();
    let bt = (t / (2.0 * s) * coth(s * t / 2.0) - 1.0 / (s * s)).sqrt();
    let [tau, bt] = [(t * t / 12.0 - bt * bt).sqrt() / s / b_m, bt / b_m];
    let a_1: f64 = f64::max(3.0 - x_p, 0.5 - c * (3.0 + 5.0 * x_p) * x_p / 2.0);
    let k2 = c * (t * coth(a_1 * t / 2.0) / (2.0 * a_1)).sqrt();

    struct Follows {
        sup_e: f64,
        rms_e: f64,
        rms_d: f64,
        rates: [f64; 2],
        apart: [f64; 2],
    }
    let at = |[r_x, r_e, r_d]: [f64; 3]| {
        let d_0 = q_x * r_x + q_e * r_e;
        let along = q_x * (f_x * r_x + f_e * r_e) + q_e * r_d;
        let mut d_1 = rms_t(x_p, e_p) + rms_t(0.0, 0.0) + along;
        if given.bends {
            let (q_tx, q_te) = (0.7 + x_p / 3.0 + e_p / 5.0, 0.9 + x_p / 7.0 + e_p / 11.0);
            d_1 = least(&[d_1, q_tx * r_x + q_te * r_e + along]);
        }
        let r_q = least(&[rms(x_p, e_p), q_0 + d_0]);
        let mut r_1 = rms_t(x_p, e_p) + along;
        let (mut more_sup, mut more_rms) = (f64::INFINITY, f64::INFINITY);
        if given.q_0[0] {
            r_1 = least(&[r_1, slope + rest[1] + d_1]);
            more_sup = sum(&|k, c| c / gain(k).sqrt()) / b_m
                + least(&[bt * rest[0], tau * rest[1]])
                + least(&[bt * d_0, tau * d_1]);
            more_rms = sum(&|k, c| c * c / gain(k)).sqrt() / b_m
                + least(&[rest[0] / sg, rest[1] / (om * sg)])
                + least(&[d_0 / sg, d_1 / (om * sg)]);
        }
        Follows {
            sup_e: least(&[bt * r_q, tau * r_1, (t * r_e * r_d).sqrt(), more_sup]),
            rms_e: least(&[r_q / sg, r_1 / (om * sg), more_rms]),
            rms_d: least(&[d_b * r_q, r_1 / sg]),
            rates: [r_q, r_1],
            apart: [d_0, d_1],
        }
    };
    let g_k = if kap <= (2.0 - b_m) * s { 1.0 / (b_m * s + kap) } else { 0.5 / (s * (kap - (1.0 - b_m) * s)).sqrt() };
    let rho = f64::max(m + kap, q_e - kap);
    let rt = |r: [f64; 3]| q_0 + q_x * r[0] + rho * r[1];
    let slope_of = |r: [f64; 3]| if given.gain.is_some() { d_b * rt(r) } else { rt(r) + kap * r[1] };
    let floats = |r: &[Rational; 3]| [r[0].to_f64(), r[1].to_f64(), r[2].to_f64()];
    let r = floats(&r);
    let per_e = c / a_1 * f_e;
    let mut expected =
        vec![("S1", 0.0, a_1), ("S1b", least(&[per_e * e_p, k2 * f_e * r[1]]), x_p), ("S1c", per_e * r[1], r[0])];
    if kap > 0.0 {
        expected.push(("S2", (t * r[1] * r[2]).sqrt(), e_p));
        expected.extend([("S2b", g_k * rt(r), r[1]), ("S2c", slope_of(r), r[2])]);
        expected.extend(given.most.then_some(("M", -q_e, x_p / 10.0 + e_p / 10.0 - 0.4)));
    } else {
        let follows = at(r);
        expected.extend([("S2", follows.sup_e, e_p), ("S2b", follows.rms_e, r[1]), ("S2c", follows.rms_d, r[2])]);
    }
    let l = last.as_ref().map_or(r, floats);
    let follows = at(l);
    if last.is_some() {
        let mut g = [follows.rms_e, follows.rms_d];
        if kap > 0.0 {
            g = [least(&[g[0], g_k * rt(l)]), least(&[g[1], slope_of(l)])];
        }
        expected.extend([("S3", per_e * l[1], l[0]), ("S3b", g[0], l[1]), ("S3c", g[1], l[2])]);
    }
    let ids: Vec<&str> = solution.conditions.iter().map(|condition| condition.id).collect();
    assert_eq!(ids, expected.iter().map(|(id, ..)| *id).collect::<Vec<_>>());
    for (condition, (id, lhs, rhs)) in solution.conditions.iter().zip(expected) {
        close(id, &condition.lhs, lhs);
        close(id, &condition.rhs, rhs);
        let strict = id == "S1" || id.starts_with("S3");
        assert_eq!(condition.relation.symbol(), if strict { "<" } else { "<=" }, "{id}");
    }
    let e_per = least(&[e_p, follows.sup_e]);
    close("e_per", &solution.e, e_per);
    close("x_per", &solution.x, least(&[x_p, per_e * e_per, k2 * f_e * l[1]]));
    close("R_q", &solution.rates[0], follows.rates[0]);
    close("R_1", &solution.rates[1], follows.rates[1]);
    // Section 13.5: the sum of |u_j| over rms(q').
    let lam = 1.0 + 2.0 / (4.0 * b_m - 1.0 + (1.0 + 8.0 * b_m).sqrt());
    close("u over rms(q')", &Answer::continuous(&d).by_rate, lam.sqrt() / b_m * t / 12.0_f64.sqrt());
    let nu = b_m * mu / w;
    let kappa = [k0 / (w * w), k1 / w.powi(4)];
    let mean = |[q, q_t]: [f64; 2]| (kappa[0] * q * q + kappa[1] * q_t * q_t) / (c_m * c_m);
    let swing = t / (2.0 * mu) * follows.rates[0].powi(2) / swung;
    let plain = swing + mean(follows.rates);
    let mut z_squared = plain;
    if given.q_0[0] {
        let pole = |k: f64| if given.matched { 2.0 / (nu * nu * k.powf(-1.5)) } else { f64::INFINITY };
        let transfer = |k: f64| least(&[k0 + k1 * (k * fast / w).powi(2), pole(k)]);
        let harmonics = C[0] * C[0] / (nu * nu * 2.0) + sum(&|k, c| transfer(k) * c * c);
        let z = harmonics.sqrt() / w / c_m + mean(rest).sqrt() + mean(follows.apart).sqrt();
        z_squared = least(&[z_squared, swing + z * z]);
    }
    close("Z^2", &solution.z_squared, z_squared);
    z_squared < plain
}

#[test]
fn existence() {
    let number = |n: i32, m: i32| Rational::from((n, m));
    let means = [
        [number(1, 5), number(1, 10), number(3, 1)],
        [number(1, 1000), number(1, 500), number(1, 100)],
        [number(20, 1), number(1, 3), number(1, 7)],
        [number(1, 100), number(30, 1), number(200, 1)],
    ];
    let mut seen = [[0; 2]; 2];
    for bits in 0..128_u32 {
        let bit = |index: u32| bits >> index & 1 == 1;
        let q_0 = [bit(4), bit(5)];
        // Without a gain, and with one that has each of the cases of its numbers.
        let gain = [None, Some([0.375, 1.5]), None, Some([0.875, 4.0])][(bits.count_ones() % 4) as usize];
        // An interval of the period where it need not match, for every other of these.
        let period = (!bit(6) && bits.count_ones() / 2 % 2 == 1).then_some([1.5, 2.75]);
        let given = Given { f_x: bit(0), most: bit(1), bends: bit(2), rms: bit(3), q_0, matched: bit(6), gain, period };
        for (sigma, kap) in [((3, 1), (0, 1)), ((40, 1), (0, 1)), ((2, 1), (1, 2)), ((2, 1), (5, 1)), ((9, 1), (9, 1))]
        {
            for (index, r) in means.iter().enumerate() {
                let last = (index % 2 == 1).then(|| means[index - 1].clone());
                let forced = compare(given, number(sigma.0, sigma.1), number(kap.0, kap.1), r.clone(), last);
                seen[usize::from(period.is_some())][usize::from(forced)] += 1;
            }
        }
    }
    assert!(seen.iter().flatten().all(|count| *count > 10), "{seen:?}");
}

#[test]
fn stability() {
    let places = [Path::StateFirst, Path::ErrorFirst, Path::Straight];
    let pairs = places.into_iter().flat_map(|f| places.map(|q| Paths { f, q }));
    for (paths, most, rate) in pairs.flat_map(|paths| {
        [(false, false), (true, false), (false, true), (true, true)].map(|(most, rate)| (paths, most, rate))
    }) {
        let mut spec = plant(Given { most, ..NOTHING });
        if !rate {
            spec.rate = None;
        }
        let d = Data::new(&spec, 128);
        let (x, e, dx, de, p_up) = (0.25, 0.125, 0.5, 1.0, 4.0_f64);
        let periodic = [&d.ratio(1, 4), &d.ratio(1, 8)];
        let error_box = ErrorBox::new(&d, paths, periodic, [&d.ratio(1, 2), &d.int(1)]);
        let (x_b, e_b) = (x + dx, e + de);
        // The e of d/dx and the x of d/de.
        let place = |path| match path {
            Path::StateFirst => (e, x_b),
            Path::ErrorFirst => (e_b, x),
            Path::Straight => (e_b, x_b),
        };
        let ((e_f, x_f), (e_q, x_q)) = (place(paths.f), place(paths.q));
        let bends = (3.0 + 5.0 * x) * x + (3.0 + 5.0 * x_b + 7.0 * e_f) * dx / 2.0;
        let gam = 2.0 * (bends + (5.0 + 7.0 * x + 11.0 * e_f) * e_f);
        let a_2 = if rate { f64::max(0.5 - gam, 3.0 - x_b - 2.0 * e_f) } else { 0.5 - gam };
        let k_l = 0.5 + 2.0 * x_q + 3.0 * e_b;
        let m = if most { f64::min(k_l, x_q / 10.0 + e_b / 10.0 - 0.4) } else { k_l };
        close("a_2", &error_box.rate, a_2);
        assert_eq!(error_box.one_sided.is_some(), most);
        for (n, q) in [(1, 100), (1, 10), (1, 2)] {
            let (w_x, h) = (2.0, n as f64 / q as f64);
            let (ht, k_x, k_f) = (h / 0.5, 0.3 + 0.5 * x_b + 0.7 * e_q, 0.2 + x_f + 2.0 * e_b);
            let size = f64::max((1.0 + ht * m).abs(), (1.0 - ht * k_l).abs());
            let [coupling, curvature, threshold] = error_box.decay(&d, [&d.int(2), &d.ratio(n, q)], &d.int(1));
            close("ht k_x^2", &coupling, ht * k_x * k_x);
            close("4A", &curvature, 4.0 * w_x * a_2);
            if 4.0 * w_x * a_2 > ht * k_x * k_x {
                let cross = w_x * p_up.sqrt() * k_f + k_x * size / 2.0;
                let share = cross * cross / (4.0 * w_x * a_2 - ht * k_x * k_x);
                close("threshold", &threshold, size * size / (4.0 * ht) + share);
            } else {
                assert!(!threshold.is_defined());
            }
        }
    }
}

/// bt and tau against their series, of which the rest after J terms lies between two integrals.
#[test]
fn periodic_facts() {
    let spec = plant(NOTHING);
    let d = Data::new(&spec, 128);
    let (t, om) = (2.0_f64, std::f64::consts::PI);
    for (n, m) in [(1, 1000), (1, 10), (1, 1), (7, 2), (50, 1), (1000, 1)] {
        let (sigma, s) = (d.ratio(n, m), n as f64 / m as f64);
        let terms = 20_000;
        let sum = |term: &dyn Fn(f64) -> f64| (1..=terms).rev().map(|j| 2.0 * term(f64::from(j) * om)).sum::<f64>();
        let rest = |from: f64| 2.0 / (om * s) * (std::f64::consts::FRAC_PI_2 - (from * om / s).atan());
        let squared = sum(&|w| 1.0 / (s * s + w * w));
        let value = bt(&d, &sigma);
        let (lo, hi) = (value.lo().to_f64().powi(2), value.hi().to_f64().powi(2));
        assert!(hi >= squared + rest(f64::from(terms) + 1.0) - 1e-12 && lo <= squared + rest(f64::from(terms)) + 1e-12);
        assert!((hi - lo) <= 1e-15 && hi <= t * t / 12.0 * (1.0 + 1e-15), "{s}: [{lo}, {hi}]");
        let squared = sum(&|w| 1.0 / (w * w * (s * s + w * w)));
        let value = tau(&d, &sigma);
        let (lo, hi) = (value.lo().to_f64().powi(2), value.hi().to_f64().powi(2));
        assert!((hi - squared).abs() <= 1e-8 * hi && (lo - squared).abs() <= 1e-8 * hi, "{s}: [{lo}, {hi}], {squared}");
    }
    // Enormous and tiny gains: bounded, and never more than T/sqrt(12), nor T^2/sqrt(720).
    for exponent in [-300, -60, 60, 300] {
        let power = Rational::from(10).clone();
        let gain = (0..i32::abs(exponent)).fold(Rational::from(1), |product, _| product * &power);
        let sigma = d.number(&if exponent < 0 { gain.recip() } else { gain });
        for (value, most) in [(bt(&d, &sigma), t / 12.0_f64.sqrt()), (tau(&d, &sigma), t * t / 720.0_f64.sqrt())] {
            assert!(value.is_bounded() && value.is_nonnegative() && value.hi().to_f64() <= most * (1.0 + 1e-15));
            assert!(exponent > 0 || value.lo().to_f64() >= most * (1.0 - 1e-12), "{exponent}");
        }
    }
    // K2(a)/c = beta_s(a): chi' = -a chi + g with g = e^{a t} on a period attains it.
    for a in [0.1_f64, 1.0, 5.0] {
        let beta = beta_s(&d, &d.number(&Rational::from_f64(a).unwrap()));
        let kernel = |s: f64| (-a * s).exp() / (1.0 - (-a * t).exp());
        let steps = 100_000;
        let mean = (0..steps).map(|i| kernel((f64::from(i) + 0.5) * t / f64::from(steps)).powi(2)).sum::<f64>();
        let expected = (mean * t / f64::from(steps)).sqrt() * t.sqrt();
        assert!((beta.hi().to_f64() - expected).abs() < 1e-8, "{a}: {expected}");
    }
    // g_k is the largest of |1/((i om + sigma)(1 + i B) + kap)| over om and B.
    for (s, kap) in [(2, 1), (2, 2), (2, 5), (1, 100)] {
        let gain = damped(&d, &Rational::from(s), &Rational::from(kap)).hi().to_f64();
        let (s, kap) = (f64::from(s), f64::from(kap));
        let scale = |i: i32| (f64::from(i) / 20.0).sinh();
        let size = |om: f64, b: f64| 1.0 / ((s + kap - om * b).powi(2) + (om + s * b).powi(2)).sqrt();
        let all = (-120..=120).flat_map(|i| (-120..=120).map(move |j| (i, j)));
        let most = all.map(|(i, j)| size(scale(i), scale(j))).fold(0.0, f64::max);
        assert!(most <= gain * (1.0 + 1e-12) && most >= 0.97 * gain, "{s}, {kap}: {most}, {gain}");
    }
}

/// z_oo, from the level condition of exact regulation; and with z = M e at the first instant, when zeta is 0.
#[test]
fn exact_regulation() {
    let cases = [(false, [false; 2]), (true, [false; 2]), (true, [true, false]), (true, [true; 2])];
    let variants = [(false, None), (true, None), (false, Some([0.75, 1.5])), (true, Some([0.75, 1.5]))];
    for ((rms, q_0), (aligned, gain)) in cases.into_iter().flat_map(|case| variants.map(|variant| (case, variant))) {
        let spec = plant(Given { most: true, rms, q_0, gain, ..NOTHING });
        let d = Data::new(&spec, 128);
        let one = || Rational::from(1);
        let w = regulation::Witness {
            pointer: String::new(),
            sigma: one(),
            sigma_text: String::new(),
            d_x: Rational::from((1, 2)),
            d_e: one(),
            w_x: one(),
            h: one(),
            paths: Paths { f: Path::StateFirst, q: Path::Straight },
        };
        let z0 = (!aligned).then(|| Rational::from(2));
        let set = ClaimedSet { x0: Rational::from((1, 4)), e0: Rational::from((1, 8)), z0 };
        let (mu, n_bar, om) = (0.5, (2.0_f64 + 2.612_375_348_685_488).sqrt(), std::f64::consts::PI);
        let root = |q: f64, q_t: f64| (q * q / 2.0 + 2.0 * (q_t / om).powi(2)).sqrt();
        let mut z = if rms { root(4.0, 9.0) } else { root(17.0, 37.0) };
        if q_0[0] {
            let harmonics = C[0] * C[0] / 2.0 + (1..4).map(|k| 4.0 * C[k] * C[k] * (k as f64).powf(1.5)).sum::<f64>();
            let slope = (1..4).map(|k| 2.0 * (k as f64 * om * C[k]).powi(2)).sum::<f64>().sqrt();
            let rest_t = if q_0[1] { REST[1] } else { 9.0 + slope };
            z = f64::min(z, harmonics.sqrt() + root(REST[0], rest_t));
        }
        let conditions = regulation::evaluate(&d, &set, &w, None).unwrap();
        let ids: Vec<&str> = conditions.iter().map(|condition| condition.id).collect();
        assert_eq!(ids, ["domain", "domain", "C4", "M", "C5", "C5b"]);
        let [low, high] = gain.unwrap_or([1.0; 2]);
        let z = z / (low * mu);
        let reach = if aligned { z } else { 2.0 + n_bar * 0.125 + z };
        close("C4", &conditions[2].lhs, 4.0 / 16.0 + 1.0 / 64.0 + high * reach * reach);
        // Around the origin: (D_x, D_e), and the rate at (D_x, 0), or at (D_x, D_e) where f is not split over x first.
        close("C5", &conditions[4].rhs, 4.0 * 2.5);
        for f in [Path::ErrorFirst, Path::Straight] {
            let conditions = regulation::evaluate(
                &d,
                &set,
                &regulation::Witness { paths: Paths { f, ..w.paths }, ..w.clone() },
                None,
            );
            close("C5", &conditions.unwrap()[4].rhs, 4.0 * 0.5);
        }
    }
}
