//! A plant of one state whose loop has a known periodic solution, with the trial that is this solution (docs/mathematics.md, section 14.4).
//!
//! x and e are trigonometric polynomials, e without mean and without harmonics up to n_o. The q that the regulator answers with that e has free
//! harmonics up to n_o, and those of the theory beyond; the trial has u = e' - q. What f and q need besides of t follows, and is a polynomial again.

use crate::plant_support::{Parts, read};
use proofs_check::json::{Field, Json, decimal, parse};
use proofs_check::plants as plant;
use proofs_check::rules::by_n_o::claimed::Entry;
use proofs_check::rules::by_n_o::{About, Witness};
use proofs_check::rules::inequality::Inequality;
use proofs_check::rules::set::ClaimedSet;
use proofs_check::verdict::{Outcome, Verdict};
use rug::Rational;
use serde_json::{Value, json};
use std::f64::consts::TAU;

pub const SIGMA: f64 = 4.0;
/// n_0 and n_1; n_l is `l^-1.5`.
pub const WEIGHTS: [f64; 2] = [2.0, 1.0];
/// L.
pub const L: f64 = 2.0;
/// At so many times.
const TIMES: usize = 64;
/// Harmonics of what f and q need of t.
const HARMONICS: usize = 12;

/// n_l.
fn weight(l: usize) -> f64 {
    if l == 0 { WEIGHTS[0] } else { (l as f64).powf(-1.5) }
}

/// The root of the sum of the weights of so many oscillators.
pub fn n_bar(n_o: usize) -> f64 {
    n_bar_of(&first(n_o))
}

/// Of those at these harmonics.
pub fn n_bar_of(own: &[usize]) -> f64 {
    own.iter().map(|l| weight(*l)).sum::<f64>().sqrt()
}

/// 0, 1, ..., n_o.
pub fn first(n_o: usize) -> Vec<usize> {
    (0..=n_o).collect()
}

/// The root of the sum of all weights: n_0 and zeta(3/2).
const N_BAR: f64 = 2.147_644_139_210_565;

/// By its mean and `[a_k, b_k]`.
#[derive(Clone)]
pub struct Wave(pub f64, pub Vec<[f64; 2]>);

impl Wave {
    /// A derivative, the wave itself or the first one.
    pub fn at(&self, t: f64, order: usize) -> f64 {
        let of = |(k, [a, b]): (usize, &[f64; 2])| {
            let om = TAU * (k + 1) as f64;
            let (sin, cos) = (om * t).sin_cos();
            if order == 0 { a * cos + b * sin } else { om * (b * cos - a * sin) }
        };
        let mean = if order == 0 { self.0 } else { 0.0 };
        mean + self.1.iter().enumerate().map(of).sum::<f64>()
    }

    /// Of a function with no more than these harmonics.
    pub fn of(value: impl Fn(f64) -> f64) -> Wave {
        let count = TIMES as f64;
        let sum = |of: &dyn Fn(f64) -> f64| {
            (0..TIMES).map(|j| j as f64 / count).map(|t| value(t) * of(t)).sum::<f64>() / count
        };
        let pair = |k: usize| {
            let om = TAU * k as f64;
            [sum(&|t| 2.0 * (om * t).cos()), sum(&|t| 2.0 * (om * t).sin())]
        };
        Wave(sum(&|_| 1.0), (1..=HARMONICS).map(pair).collect())
    }

    /// As an expression in t.
    pub fn text(&self) -> String {
        let part = |(k, [a, b]): (usize, &[f64; 2])| {
            let k = 2 * (k + 1);
            format!(" + {}*cos({k}*pi*t) + {}*sin({k}*pi*t)", number(*a), number(*b))
        };
        let parts: String = self.1.iter().enumerate().map(part).collect();
        number(self.0) + &parts
    }

    /// As a file has it, its mean with it or not, in lists of one number or not.
    pub fn json(&self, with_mean: bool, of_states: bool) -> Value {
        let value = |x: f64| if of_states { json!([format!("{x:e}")]) } else { json!(format!("{x:e}")) };
        let harmonics: Vec<Value> = self.1.iter().map(|[a, b]| json!({ "cos": value(*a), "sin": value(*b) })).collect();
        if with_mean {
            json!({ "mean": value(self.0), "harmonics": harmonics })
        } else {
            json!({ "harmonics": harmonics })
        }
    }
}

fn number(value: f64) -> String {
    format!("({value:.18})")
}

/// The largest size of a function of the period 1.
pub fn largest(value: impl Fn(f64) -> f64) -> f64 {
    let size = |t: f64| value(t).abs();
    let (mut best, mut step) =
        ((0..20_000).map(|j| f64::from(j) / 2e4).max_by(|a, b| size(*a).total_cmp(&size(*b))).unwrap(), 5e-5);
    while step > 1e-10 {
        best = [best - step, best, best + step].into_iter().max_by(|a, b| size(*a).total_cmp(&size(*b))).unwrap();
        step /= 2.0;
    }
    size(best)
}

/// The harmonics of e, beyond n_o, and those of q up to n_o.
const OF_ERROR: [[f64; 2]; 3] = [[0.1, 0.2], [0.3, 0.0], [0.0, -0.1]];
const FREE: [[f64; 2]; 3] = [[0.2, -0.1], [0.05, 0.1], [0.0, 0.0]];

/// `|i om_k + sigma|` and, with oscillators at these harmonics and mu = 1, y_k and `sqrt(g_H'(k))`.
pub fn oscillators(own: &[usize], k: usize) -> [f64; 3] {
    let poles = own.iter().flat_map(|l| if *l == 0 { vec![0.0] } else { vec![*l as f64, -(*l as f64)] });
    let (mut g, mut slope) = (0.0, 0.0);
    for l in poles {
        let (c, from) = (if l == 0.0 { WEIGHTS[0] } else { l.abs().powf(-1.5) / 2.0 }, l - k as f64);
        (g, slope) = (g + c / from, slope + c / (from * from));
    }
    // The period is 1.
    [(TAU * k as f64).hypot(SIGMA), g / TAU, slope.sqrt()]
}

/// `(i om_k + sigma)(1 + i y_k)` times the harmonic `(a - i b)/2` of e, of q.
pub fn answered(own: &[usize], k: usize, pair: [f64; 2]) -> [f64; 2] {
    answered_at(1.0, own, k, pair)
}

/// With this mu.
fn answered_at(mu: f64, own: &[usize], k: usize, [a, b]: [f64; 2]) -> [f64; 2] {
    let y = mu * oscillators(own, k)[1];
    let om = TAU * k as f64;
    let (re, im) = (SIGMA - om * y, om + SIGMA * y);
    [re * a + im * b, re * b - im * a]
}

/// f and q without what they need of t besides, as texts and as functions of x and e.
#[derive(Clone, Copy)]
pub struct Formulas {
    pub f: &'static str,
    pub q: &'static str,
    pub values: fn(f64, f64) -> [f64; 2],
}

pub const FORMULAS: Formulas = Formulas {
    f: "-2*x - x^3/60 + e/2",
    q: "x/2 - e^3/50 + x*e/10",
    values: |x, e| [-2.0 * x - x.powi(3) / 60.0 + e / 2.0, x / 2.0 - e.powi(3) / 50.0 + x * e / 10.0],
};

/// A claim about one n_o with its witness.
#[derive(Clone)]
pub struct Case {
    pub parts: Parts,
    pub entry: Value,
    pub trial: Value,
    pub sigma: &'static str,
    pub error_box: [String; 2],
    pub periodic: [&'static str; 2],
    /// k0 and k1.
    pub transfer: [&'static str; 2],
    /// w_x and h.
    pub weights: [&'static str; 2],
    pub stability: Option<Inequality>,
    pub x: Wave,
    pub e: Wave,
    pub q: Wave,
    /// The harmonics of the oscillators.
    pub own: Vec<usize>,
    pub mu: f64,
    /// b_lo and b_hi.
    pub gain: [f64; 2],
    /// By what the size of u, and zhat, is larger than that of the nominal member.
    pub of_u: f64,
}

/// Of the set: X0, E0, Z0.
pub const SET: [f64; 3] = [0.05, 0.04, 0.1];
/// xb is xhat less this, and this is its radius.
pub const OFF: [f64; 2] = [0.3, 0.01];

impl Case {
    /// With the defects 1e-12, the box 2 and 2, and numbers of the claim that are far too large.
    pub fn new(n_o: usize, formulas: Formulas) -> Case {
        Case::of(n_o, formulas, Case::waves(&first(n_o), 1.0))
    }

    /// The same with oscillators at these harmonics, which the entry names, and this mu.
    pub fn of_set(own: &[usize], mu: f64, formulas: Formulas) -> Case {
        let case = Case::of(0, formulas, Case::waves(own, mu));
        let mut case = case.part("/plant/internal_model/mu", mu.to_string());
        case.entry.as_object_mut().unwrap().remove("n_o");
        case.entry["harmonics"] = json!(own);
        Case { own: own.to_vec(), mu, ..case }
    }

    /// e and q.
    fn waves(own: &[usize], mu: f64) -> [Wave; 2] {
        let of_e = |k: usize| if own.contains(&k) { [0.0; 2] } else { OF_ERROR[k - 1] };
        let of_q = |k: usize| if own.contains(&k) { FREE[k - 1] } else { answered_at(mu, own, k, of_e(k)) };
        [Wave(0.0, (1..=3).map(of_e).collect()), Wave(0.3, (1..=3).map(of_q).collect())]
    }

    /// Of two oscillators or more, without an error; the bounds of derivatives are far too large.
    pub fn or_more(formulas: Formulas) -> Case {
        let mut case = Case::of(2, formulas, [Wave(0.0, Vec::new()), Wave(0.3, FREE[..2].to_vec())]);
        case.entry["or_more"] = true.into();
        let more = [("defect_q_t", "1e-10"), ("q_tx", "2"), ("q_te", "1.5"), ("f_x", "5"), ("f_e", "1")];
        more.iter().for_each(|(name, value)| case.trial[*name] = (*value).into());
        case
    }

    /// With these e and q.
    pub fn of(n_o: usize, formulas: Formulas, [e, q]: [Wave; 2]) -> Case {
        let x = Wave(0.1, [[0.4, 0.2], [0.0, 0.05]].to_vec());
        let along = |t: f64| (formulas.values)(x.at(t, 0), e.at(t, 0));
        let of_f = Wave::of(|t| x.at(t, 1) - along(t)[0]);
        let of_q = Wave::of(|t| q.at(t, 0) - along(t)[1]);
        let f = format!("{} + {}", formulas.f, of_f.text());
        let parts = Parts::scalar(&f, &format!("{} + {}", formulas.q, of_q.text()));
        let (orbit, forcing) = (Wave(x.0 - OFF[0], x.1.clone()), Wave(0.0, Vec::new()));
        let mut orbit = orbit.json(true, true);
        for (name, value) in [("defect", "0"), ("tube", "0.1"), ("radius", "0.01")] {
            orbit[name] = value.into();
        }
        let mut forcing = forcing.json(true, false);
        forcing["rest"] = "0".into();
        forcing["rest_t"] = "0".into();
        let parts = parts
            .with("/witness/coordinates", json!([["2"]]))
            .with("/witness/orbit", orbit)
            .with("/witness/forcing", forcing);
        // u = e' - q.
        let u = Wave::of(|t| e.at(t, 1) - q.at(t, 0));
        let u = Wave(u.0, u.1[..q.1.len()].to_vec());
        let trial = json!({
            "x": x.json(true, true), "e": e.json(false, false), "u": u.json(true, false),
            "defect_x": "1e-12", "defect_q": "1e-12",
            "box": { "x": "2", "e": "2" },
            "q_x": "1.5", "q_e": "0.9",
            "forms": [{
                "P": [["1"]], "p": ["0.05"], "w": "1", "k_p": "0.8", "c_x": "1.5", "c_e": "2", "c_y": "0.15",
                "P_up": "1", "x_low": "0.9975", "e_low": "0.9975",
            }],
            "states": { "Q": [["1"]], "Q_low": "1", "Q_up": "1", "c": "1", "gamma": "0.05" },
        });
        let entry = json!({
            "n_o": n_o,
            "steady": { "e": "9", "e_rms": "9", "u": "99" },
            "largest": { "e": "9", "u": "99" },
        });
        let (error_box, periodic) = (["1", "1"].map(str::to_owned), ["0.1", "0.1"]);
        // A function that is too large to be of use.
        let (transfer, weights) = (["19.8", "79.1"], ["1e9", "1e9"]);
        let (sigma, stability, gain, of_u) = ("4", None, [1.0; 2], 1.0);
        let (own, mu) = (first(n_o), 1.0);
        Case {
            parts,
            entry,
            trial,
            sigma,
            error_box,
            periodic,
            transfer,
            weights,
            stability,
            x,
            e,
            q,
            own,
            mu,
            gain,
            of_u,
        }
    }

    /// Of a plant without states, with this q; its trial has nothing of states.
    pub fn without_states(n_o: usize, formulas: Formulas) -> Case {
        Case::new(n_o, formulas).stateless()
    }

    /// Its plant without its states, on which q may not depend.
    pub fn stateless(&self) -> Case {
        let mut case = self
            .part("/plant/states", json!([]))
            .part("/plant/f", json!([]))
            .part("/witness/coordinates", json!([]))
            .part("/witness/orbit", json!({ "mean": [], "defect": "0", "tube": "0.1", "radius": "0" }))
            .part("/witness/lyapunov/P", json!([]));
        for (object, name) in [("", "x"), ("", "defect_x"), ("/box", "x"), ("", "q_x"), ("", "states")] {
            case.trial.pointer_mut(object).unwrap().as_object_mut().unwrap().remove(name);
        }
        for name in ["q_tx", "f_x", "f_e"] {
            case.trial.as_object_mut().unwrap().remove(name);
        }
        case.trial("/forms/0/P", json!([])).trial("/forms/0/p", json!([]))
    }

    /// Whether its entry is about so many oscillators or more.
    pub fn is_or_more(&self) -> bool {
        self.entry.get("or_more").is_some()
    }

    /// Another value in the trial.
    pub fn trial(&self, at: &str, value: impl Into<Value>) -> Case {
        let mut case = self.clone();
        *case.trial.pointer_mut(at).unwrap_or_else(|| panic!("{at} exists")) = value.into();
        case
    }

    /// Another number in the entry of the claim.
    pub fn entry(&self, at: &str, value: impl Into<Value>) -> Case {
        let mut case = self.clone();
        *case.entry.pointer_mut(at).unwrap_or_else(|| panic!("{at} exists")) = value.into();
        case
    }

    /// Without `largest`.
    pub fn steady_alone(&self) -> Case {
        let mut case = self.clone();
        case.entry.as_object_mut().unwrap().remove("largest");
        case
    }

    /// Another value in the plant, or the parts of its witness.
    pub fn part(&self, at: &str, value: impl Into<Value>) -> Case {
        Case { parts: self.parts.clone().with(at, value.into()), ..self.clone() }
    }

    /// The lines of the argument.
    pub fn judged(&self) -> Outcome<Vec<String>> {
        let parsed = |value: Value| -> Json { parse(value.to_string().as_bytes()).unwrap() };
        let (claim, witness) = (parsed(json!([self.entry])), parsed(json!({ "trials": [self.trial] })));
        let (spec, cells) = read(&self.parts.0)?;
        let claimed = Entry::read_all(&Field { json: &claim, pointer: "/claim/by_n_o".to_owned() }, None)?;
        let field = Field { json: &witness, pointer: "/witness/by_n_o".to_owned() };
        let witness = Witness::read(Some(&field), &claimed, &spec, None)?.unwrap();
        let value = |text: &str| decimal(text).unwrap();
        let [x0, e0, z0] = SET.map(|size| value(&size.to_string()));
        let set = ClaimedSet { x0, e0, z0: Some(z0) };
        let ([d_x, d_e], sigma): ([Rational; 2], _) =
            (self.error_box.each_ref().map(|text| value(text)), value(self.sigma));
        let (error_box, periodic, pair) = ([&d_x, &d_e], self.periodic.map(value), self.transfer.map(value));
        let (weights, transfer) = (self.weights.map(value), pair.each_ref());
        let (weights, stability) = (weights.each_ref(), self.stability.as_ref());
        let about =
            About { sigma: &sigma, set: &set, error_box, periodic, transfer, weights, stability, at_samples: None };
        let mut lines = Vec::new();
        plant::by_n_o::prove(&spec, &cells, &about, (&claimed, &witness), &mut lines).map(|()| lines)
    }

    #[track_caller]
    pub fn accepted(&self) {
        if let Err(finding) = self.judged() {
            panic!("{finding:?}");
        }
    }

    /// Refused with this verdict, at this place below the trial, or of the claim.
    #[track_caller]
    pub fn refused(&self, verdict: Verdict, place: &str) {
        let place = match place.split_once(':') {
            Some((_, whole)) => whole.to_owned(),
            None => format!("/witness/by_n_o/trials/0{place}"),
        };
        match self.judged() {
            Ok(_) => panic!("accepted: {}", self.trial),
            Err(finding) => assert!(finding.verdict == verdict && finding.pointer == place, "{finding:?}"),
        }
    }
}

/// What section 14.4 says with the numbers of a trial of [`Case`], computed apart.
pub struct Expected {
    pub s_x: f64,
    pub s_e: f64,
    /// steady: e, its root mean square, u.
    pub steady: [f64; 3],
    /// X_N and E_N.
    pub sizes: [f64; 2],
    /// d_X, d_E, d_Z.
    pub distances: [f64; 3],
    pub v_0: f64,
    /// largest: e, u.
    pub largest: [f64; 2],
}

pub fn expected(case: &Case) -> Expected {
    expected_with(case, if case.is_or_more() { N_BAR } else { n_bar_of(&case.own) })
}

/// With this root of the sum of the weights.
pub fn expected_with(case: &Case, n_bar: f64) -> Expected {
    let value = |at: &str| {
        let text = case.trial.pointer(at).unwrap_or_else(|| panic!("{at}")).as_str().unwrap();
        text.parse::<f64>().unwrap()
    };
    let of_form = |name: &str| value(&format!("/forms/0/{name}"));
    let [d_x, d_q, b_x, b_e] = ["/defect_x", "/defect_q", "/q_x", "/q_e"].map(value);
    let [w, k_p, c_x, c_e, c_y, p_up, e_low] = ["w", "k_p", "c_x", "c_e", "c_y", "P_up", "e_low"].map(of_form);
    let p = value("/forms/0/p/0");
    let [q_low, q_up, c, gamma] = ["Q_low", "Q_up", "c", "gamma"].map(|name| value(&format!("/states/{name}")));
    let g = 4.0 * d_x * d_x * (p_up * p_up / c_x + p * p / c_e) + k_p * k_p * d_q * d_q / c_y;
    let (rho_x, rho_y) = ((g / c_x).sqrt(), (g / c_y).sqrt());
    let (own, mu) = (&case.own, case.mu);
    let next = (1..).find(|k| !own.contains(k)).unwrap();
    let rho_e = (g / c_e).sqrt().min(rho_y / SIGMA.hypot(TAU * next as f64));
    let s_e = (rho_e * rho_y).sqrt();
    let s_x = (q_up / (q_low * c) * (gamma * s_e * s_e + q_up * q_up * d_x * d_x / c)).sqrt();
    let [low, high] = case.gain;
    let b_e = b_e + SIGMA * (high - 1.0).max(1.0 - low);
    let input = b_x * rho_x + b_e * rho_e + d_q;
    let (kappa, other) = if case.is_or_more() {
        let [d_t, q_tx, q_te, f_x, f_e] = ["/defect_q_t", "/q_tx", "/q_te", "/f_x", "/f_e"].map(value);
        let rate = q_tx * rho_x + q_te * rho_e + b_x * (f_x * rho_x + f_e * rho_e + d_x) + b_e * rho_y + d_t;
        let [k0, k1] = case.transfer.map(|text| text.parse::<f64>().unwrap());
        (k0 / TAU.powi(2), k1 / TAU.powi(4) * rate * rate)
    } else {
        // Times `(b_lo mu)^2`.
        let at_mean = if case.entry["harmonics"].is_null() {
            own.len() as f64 / WEIGHTS[0]
        } else {
            (1.0 / WEIGHTS[0]).max((low * mu * n_bar / TAU).powi(2))
        };
        (own.iter().skip(1).map(|k| 2.0 / weight(*k)).fold(at_mean, f64::max) / (mu * mu), 0.0)
    };
    let s_z = ((0.5 / (low * mu) + kappa / (low * low)) * input * input + other / (low * low)).sqrt();
    let size = |[a, b]: [f64; 2]| a.hypot(b);
    let within = |k: usize| size(case.q.1[k - 1]).powi(2) / (k as f64).powf(-1.5);
    let known = own.iter().copied().filter(|k| (1..=case.q.1.len()).contains(k));
    let first = (case.q.0 * case.q.0 / WEIGHTS[0] + known.map(within).sum::<f64>()).sqrt() / mu;
    let beyond = |k: usize| {
        let [both, _, slope] = oscillators(own, k);
        slope * both * size(case.e.1[k - 1]) / TAU
    };
    let z_n = case.of_u * first + (1..=case.e.1.len()).filter(|k| !own.contains(k)).map(beyond).sum::<f64>() + s_z;
    let e_n = largest(|t| case.e.at(t, 0)) + s_e;
    let rms = (case.e.1.iter().map(|pair| size(*pair).powi(2)).sum::<f64>() / 2.0).sqrt();
    let u = case.of_u * largest(|t| case.e.at(t, 1) - case.q.at(t, 0)) + SIGMA * s_e + mu * n_bar * s_z;
    let x_n = OFF[0] / L + OFF[1] + s_x;
    let [d_x, d_e, d_z] = [SET[0] + x_n, SET[1] + e_n, SET[2] + n_bar * SET[1] + z_n];
    let at = |b: f64| p_up * d_x * d_x + 2.0 * p * d_x * d_e + w * d_e * d_e + k_p * b * mu / 2.0 * d_z * d_z;
    let of_u = |b: f64| (at(b) * (SIGMA * SIGMA / e_low + 2.0 * mu * n_bar * n_bar / (b * k_p))).sqrt();
    let v_0 = at(high);
    Expected {
        s_x,
        s_e,
        steady: [e_n, rms + rho_e, u],
        sizes: [x_n, e_n],
        distances: [d_x, d_e, d_z],
        largest: [e_n + (v_0 / e_low).sqrt(), u + of_u(low).max(of_u(high))],
        v_0,
    }
}

/// `largest` by a function that is at most `level` at the start, and never below `weight e^2 + h |zeta|_N^2`.
pub fn peaks(case: &Case, level: f64, [weight, h]: [f64; 2]) -> [f64; 2] {
    let n_bar = if case.is_or_more() { N_BAR } else { n_bar_of(&case.own) };
    let Expected { steady: [e, _, u], .. } = expected(case);
    [e + (level / weight).sqrt(), u + (level * (SIGMA * SIGMA / weight + (case.mu * n_bar).powi(2) / h)).sqrt()]
}

pub fn text(value: f64) -> Value {
    format!("{value:e}").into()
}

/// A domain of these sizes is just large enough for the box at a place of the trial; smaller by such a share in x or in e it is not.
pub fn asks_for_a_domain(case: impl Fn() -> Case, [x, e]: [f64; 2], less: [f64; 2], at: &str) {
    let with = |x: f64, e: f64| case().part("/plant/domain", json!({ "x": format!("{x:.9}"), "e": format!("{e:.9}") }));
    let more = 1.0 + 1e-6;
    with(x * more, e * more).accepted();
    with(x * (1.0 - less[0]), e * more).refused(Verdict::Invalid, at);
    with(x * more, e * (1.0 - less[1])).refused(Verdict::Invalid, at);
}

/// Each number of the entry is refused if it is a ten-millionth too small.
pub fn asks_for_every_number(case: &Case) {
    let expected = expected(case);
    let steady = ["e", "e_rms", "u"].map(|name| format!("/steady/{name}"));
    let peaks = ["e", "u"].map(|name| format!("/largest/{name}"));
    for (at, number) in steady.iter().zip(expected.steady).chain(peaks.iter().zip(expected.largest)) {
        case.entry(at, text(number * (1.0 + 1e-7))).accepted();
        case.entry(at, text(number * (1.0 - 1e-7))).refused(Verdict::Invalid, &format!(":/claim/by_n_o/0{at}"));
    }
}

/// A tube that touches the box is no tube.
pub fn asks_for_a_tube_inside(case: &Case) {
    let Expected { s_x, s_e, .. } = expected(case);
    for (at, size) in [("/box/x", s_x), ("/box/e", s_e)] {
        case.trial(at, text(size * (1.0 + 1e-9))).accepted();
        case.trial(at, text(size * (1.0 - 1e-9))).refused(Verdict::Invalid, at);
    }
}
