//! Random plants of one to three states of which the periodic solution is known exactly, with an edge, a pole or an end of a
//! domain a little outside of the ball, and often a steep place at its rim: where a box that protrudes from the ball would
//! tell another story than the ball.
//!
//! `x_0 = mean + cos cos(2 pi t) + sin sin(2 pi t)`; with `u = x - x_0` and `W = c u` the right sides are
//! `x_0' - DECAY u + gain (H(W) - H(0)) + e (...)`, so that they are x_0' at u = 0, e = 0.

use super::{any, decimal};
use proofs_check::effort;
use proofs_check::json::{Field, Json, parse};
use proofs_check::rules::derivation::Inequalities;
use proofs_check::verdict::Outcome;
use rand::RngExt;
use rand::rngs::StdRng;
use rug::{Float, Rational};
use serde_json::{Value, json};
use sigmastar_decide::bounds::{Engine, Region};
use sigmastar_exact::number::{parse_decimal, write_exact};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Bound, PeriodicMatrix, TrigonometricVector};
use sigmastar_propose::bounds::{FloatCurve, FloatSuprema};
use sigmastar_theory::evidence::{Coordinates, OrbitProof};

/// Bounds of the P(t) that are drawn, and the sizes of their parts.
const BETWEEN: [&str; 2] = ["0.65", "1.35"];
const WAVE: f64 = 0.05;

/// Steps of interval arithmetic that the checker may take.
const STEPS: u64 = 24_000_000;

/// A plant with everything that is known of it.
pub struct Drawn {
    pub plant: Plant,
    document: Value,
    pub l: Vec<Vec<Rational>>,
    pub orbit: TrigonometricVector,
    /// The P of the rate and that of existence.
    pub p: [PeriodicMatrix; 2],
    pub x: Rational,
    pub e: Rational,
    /// The y in the unit ball at which W is largest.
    pub ray: Vec<f64>,
    /// Around the orbit: a tube and the rate of each P in it.
    pub tube: Rational,
    pub alpha: [Rational; 2],
}

pub fn rational(text: &str) -> Rational {
    parse_decimal(text).expect("a decimal number")
}

fn number(value: f64) -> String {
    format!("{value:.5e}")
}

/// A function of W with slopes of about `slope`, smooth up to |W| = reach, with an edge at c.
fn edge(random: &mut StdRng, slope: f64, reach: f64, c: f64) -> String {
    let (s, r, c) = (number(slope), number(slope * reach), number(c));
    match random.random_range(0..14) {
        0 | 10 => format!("{s}*min(W - {c}, 0)"),
        1 | 11 => format!("{s}*max({c} - W, 0)"),
        2 | 12 => format!("{s}*(W - abs(W - {c}))"),
        3 | 13 => format!("min({s}*(W - {c}), {s}*7*(W - {c}))"),
        4 => format!("{r}*sqrt(1 - W/{c})"),
        5 => format!("{r}*log(1 - W/{c})"),
        6 => format!("{r}/(1.0001 - W/{c})/50"),
        7 => format!("{r}*tan(pi/2*W/{c})/20"),
        8 => format!("{r}*(1 - W/{c})^(3/2)"),
        _ => format!("{r}*(1 - W/{c})^-1/50"),
    }
}

/// A steep place at the rim of the ball.
fn bump(random: &mut StdRng, slope: f64, reach: f64) -> String {
    let (at, steep) = (reach * random.random_range(0.993..1.0), 10_f64.powf(random.random_range(1.0..3.0)) / reach);
    format!("{}*tanh({}*(W - {}))", number(slope / steep), number(steep), number(at))
}

/// A function of W and e that vanishes with e.
fn of_error(random: &mut StdRng, slope: f64, reach: f64, c: f64, e: f64) -> String {
    // The edge of the first is at W = c - (slope/by) e, which no |e| moves into the ball.
    let (s, by, c) = (number(slope), number(random.random_range(1.2..3.0) * slope * e / (c - reach)), number(c));
    match random.random_range(0..8) {
        0 => format!("min({s}*e, {by}*({c} - W))"),
        1 => format!("-max({s}*e, {by}*(W - {c}))"),
        2 => format!("{s}*e*sqrt(1 - W/{c})"),
        3 => format!("{s}*e*log(1 - W/{c})"),
        4 => format!("{s}*e/(1.0001 - W/{c})/30"),
        5 => format!("{s}*tanh(e)*{}", bump(random, 1.0, reach)),
        6 => format!("{s}*e^2*W"),
        _ => format!("{s}*e"),
    }
}

/// The orbit's component and its derivative as texts.
fn wave([mean, cos, sin]: [&str; 3]) -> [String; 2] {
    [
        format!("({mean} + {cos}*cos(2*pi*t) + {sin}*sin(2*pi*t))"),
        format!("2*pi*({sin}*cos(2*pi*t) - {cos}*sin(2*pi*t))"),
    ]
}

fn matrix(random: &mut StdRng, order: usize, moves: bool) -> PeriodicMatrix {
    let mut symmetric = |size: f64, one: i32| {
        let mut rows = vec![vec![Rational::new(); order]; order];
        for (i, j) in (0..order).flat_map(|i| (0..=i).map(move |j| (i, j))) {
            let own = rational(&decimal(random, 3, -size, size)) + i32::from(i == j) * one;
            rows[i][j].clone_from(&own);
            rows[j][i] = own;
        }
        rows
    };
    let mean = symmetric(if moves { WAVE } else { 0.0 }, 1);
    PeriodicMatrix { mean, harmonics: if moves { vec![[symmetric(WAVE, 0), symmetric(WAVE, 0)]] } else { Vec::new() } }
}

impl Drawn {
    pub fn new(random: &mut StdRng) -> Drawn {
        let order = random.random_range(1..=3);
        let still = random.random_bool(0.3);
        let mut entry = |size: f64| decimal(random, 2, -size, size);
        let l: Vec<Vec<Rational>> =
            (0..order).map(|i| (0..order).map(|j| rational(&entry(0.3)) + i32::from(i == j)).collect()).collect();
        let size = if still { 0.0 } else { 0.5 };
        let waves: Vec<[String; 3]> = (0..order).map(|_| [entry(0.5), entry(size), entry(size)]).collect();
        let direction: Vec<String> = (0..order).map(|_| decimal(random, 2, 0.2, 1.0)).collect();
        let [x, e] = [decimal(random, 2, 0.2, 2.0), decimal(random, 2, 0.1, 1.0)];
        // W = c L y (X + r).
        let ray: Vec<f64> = (0..order)
            .map(|j| (0..order).map(|i| rational(&direction[i]).to_f64() * l[i][j].to_f64()).sum::<f64>())
            .collect();
        let norm = ray.iter().map(|c| c * c).sum::<f64>().sqrt();
        let (reach, largest_e) = (norm * rational(&x).to_f64(), rational(&e).to_f64());

        let orbit_texts: Vec<[String; 2]> =
            waves.iter().map(|parts| wave(parts.each_ref().map(String::as_str))).collect();
        let u: Vec<String> = (0..order).map(|i| format!("(x{} - {})", i + 1, orbit_texts[i][0])).collect();
        let w: Vec<String> = (0..order).map(|i| format!("{}*{}", direction[i], u[i])).collect();
        let w = format!("({})", w.join(" + "));
        let mut feature = |error: bool| {
            let slope = 10_f64.powf(random.random_range(-0.5..2.0));
            // Boxes whose middle lies beyond the edge are those at the rim, unless the edge is far.
            let beyond = if random.random_bool(0.7) { 0.05 } else { 0.5 };
            let c = reach * (1.002 + random.random_range(0.0..beyond));
            let mut text = match error {
                true => of_error(random, slope, reach, c, largest_e),
                false => edge(random, slope, reach, c),
            };
            if !error && random.random_bool(0.85) {
                let steeper = slope * random.random_range(0.3..2.0);
                text = format!("{text} + {}", bump(random, steeper, reach));
            }
            let factor = *any(random, &["1", "1", "(1 + cos(2*pi*t)/3)", "tanh(1 + sin(2*pi*t))"]);
            let less = text.replace('W', "0");
            [format!("{factor}*({text} - ({less}))").replace('W', &w), format!("{factor}*({text})").replace('W', &w)]
        };
        let (along, error) = (feature(false)[0].clone(), feature(true)[1].clone());
        let [in_q, error_in_q] = [feature(false)[1].clone(), feature(true)[1].clone()];
        let mut gain = || decimal(random, 2, -1.0, 1.0);
        let f: Vec<String> = (0..order)
            .map(|i| {
                let coupled = format!("{}*{}", gain(), u[(i + 1) % order]);
                let velocity = &orbit_texts[i][1];
                format!("{velocity} - DECAY*{} + {coupled} + {}*({along}) + {}*({error})", u[i], gain(), gain())
            })
            .collect();
        let q = format!("{in_q} + {error_in_q} + {}*tanh(3*sin(2*pi*t)) + {}*x1", gain(), gain());

        let column = |k: usize| waves.iter().map(|parts| rational(&parts[k])).collect::<Vec<_>>();
        let harmonics = if still { Vec::new() } else { vec![[column(1), column(2)]] };
        let orbit = TrigonometricVector { mean: column(0), harmonics };
        let moves = random.random_bool(0.4);
        let p = [matrix(random, order, moves), matrix(random, order, false)];
        let names: Vec<String> = (1..=order).map(|i| format!("x{i}")).collect();
        let document = json!({
            "format": "sigmastar/plant", "version": 1, "name": "drawn", "period": "1", "states": names, "f": f, "q": q,
            "internal_model": {
                "mu": "1", "base_frequency": "2*pi", "matched": true,
                "weights": { "family": "power", "n0": "2", "epsilon": "1/2" },
            },
        });
        let (x, e) = (rational(&x), rational(&e));
        let ray = ray.iter().map(|c| c / norm).collect();
        damped(document, l, orbit, p, [x, e], ray)
    }

    /// The right sides, around the orbit.
    pub fn engine(&self) -> Engine {
        let region = Region::new(self.l.clone(), self.orbit.clone(), radius()).expect("a region");
        let [first, second] = self.p.clone().map(Some);
        Engine::new(&self.plant, region, first, second).expect("matrices of its order")
    }

    pub fn samples(&self) -> FloatSuprema {
        samples(&self.plant, &self.l, &self.orbit, &self.p)
    }

    pub fn coordinates(&self) -> Coordinates {
        Coordinates { l: self.l.clone(), p: self.p[0].clone() }
    }

    /// What is known of the orbit.
    pub fn proof(&self) -> OrbitProof {
        OrbitProof {
            orbit: self.orbit.clone().into(),
            defect: defect(),
            tube: self.tube.clone(),
            radius: radius(),
            alpha: self.alpha[0].clone(),
            p_low: rational(BETWEEN[0]),
            p_up: rational(BETWEEN[1]),
        }
    }

    /// The parts of a witness, with these bounds: their name and value at (X, E).
    pub fn witness(&self, proof: &OrbitProof, rests: [&Rational; 2], bounds: &[(&str, &Rational)]) -> Value {
        let row = |row: &Vec<Rational>| -> Value { row.iter().map(write_exact).collect() };
        let rows = |rows: &Vec<Vec<Rational>>| -> Value { rows.iter().map(row).collect() };
        let lyapunov = |which: usize| {
            let p = &self.p[which];
            let harmonic = |[cos, sin]: &[Vec<Vec<Rational>>; 2]| json!({ "cos": rows(cos), "sin": rows(sin) });
            let harmonics: Value = p.harmonics.iter().map(harmonic).collect();
            let alpha = if which == 0 { &proof.alpha } else { &self.alpha[1] };
            json!({
                "P": rows(&p.mean), "harmonics": harmonics, "alpha": write_exact(alpha),
                "p_low": write_exact(&proof.p_low), "p_up": write_exact(&proof.p_up),
            })
        };
        let pair = |[cos, sin]: &[Vec<Rational>; 2]| json!({ "cos": row(cos), "sin": row(sin) });
        let harmonics: Value = proof.orbit.centre.harmonics.iter().map(pair).collect();
        let [x, e] = [&self.x, &self.e].map(write_exact);
        let entry =
            |(name, value): &(&str, &Rational)| json!({ "bound": name, "X": x, "E": e, "value": write_exact(value) });
        json!({
            "coordinates": rows(&self.l),
            "orbit": {
                "mean": row(&proof.orbit.centre.mean), "harmonics": harmonics, "defect": write_exact(&proof.defect),
                "tube": write_exact(&proof.tube), "radius": write_exact(&proof.radius),
            },
            "lyapunov": lyapunov(0),
            "lyapunov_existence": lyapunov(1),
            "forcing": {
                "mean": "0", "harmonics": [], "rest": write_exact(rests[0]), "rest_t": write_exact(rests[1]),
            },
            "bounds": bounds.iter().map(entry).collect::<Value>(),
        })
    }

    /// Whether the checker proves all of it; `None` where its steps do not suffice.
    pub fn checked(&self, witness: &Value) -> Option<bool> {
        let (answer, steps) = effort::limited(STEPS, || self.judged(witness));
        match answer {
            Err(_) if steps >= STEPS => None,
            answer => Some(answer.is_ok()),
        }
    }

    fn judged(&self, witness: &Value) -> Outcome<()> {
        let [plant, witness]: [Json; 2] =
            [&self.document, witness].map(|part| parse(part.to_string().as_bytes()).expect("JSON"));
        let mut fields = Field { json: &witness, pointer: "/witness".to_owned() }.fields()?;
        let field = Field { json: &plant, pointer: "/plant".to_owned() };
        let (spec, plant) = proofs_check::plants::read::read(&field, &mut fields)?;
        fields.finish()?;
        let none = Float::new(128);
        proofs_check::plants::prove(&spec, &plant, [&none, &none], Inequalities::default(), &mut Vec::new())
    }

    pub fn name(&self) -> String {
        self.document.to_string()
    }
}

/// A radius and a defect of an orbit that is exact.
fn radius() -> Rational {
    rational("1e-14")
}

fn defect() -> Rational {
    rational("1e-16")
}

fn samples(plant: &Plant, l: &[Vec<Rational>], orbit: &TrigonometricVector, p: &[PeriodicMatrix; 2]) -> FloatSuprema {
    let doubles = l.iter().map(|row| row.iter().map(Rational::to_f64).collect()).collect();
    FloatSuprema::new(plant, FloatCurve::from(orbit), doubles, [Some(&p[0]), Some(&p[1])])
}

/// With so much damping that both P have a rate near the orbit.
fn damped(
    document: Value,
    l: Vec<Vec<Rational>>,
    orbit: TrigonometricVector,
    p: [PeriodicMatrix; 2],
    [x, e]: [Rational; 2],
    ray: Vec<f64>,
) -> Drawn {
    let tube = Rational::from(&x / 1000);
    let mut decay = 2;
    loop {
        let mut document = document.clone();
        for f in document["f"].as_array_mut().expect("a list") {
            *f = f.as_str().expect("a text").replace("DECAY", &decay.to_string()).into();
        }
        let plant = Plant::from_json("drawn", &document.to_string()).expect("a plant");
        let sampled = samples(&plant, &l, &orbit, &p);
        let rates = [Bound::Rate, Bound::RateExistence].map(|kind| sampled.at(kind, tube.to_f64(), 0.0));
        if rates.iter().all(|rate| *rate > 0.5) {
            let alpha = rates.map(|rate| rational(&number(0.9 * rate)));
            return Drawn { plant, document, l, orbit, p, x, e, ray, tube, alpha };
        }
        decay *= 4;
        assert!(decay < 1 << 20, "{document}");
    }
}
