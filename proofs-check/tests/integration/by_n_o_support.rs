//! Loops of plants that are linear in x and e, solved in floating point, and what is proved of their formulas.

use crate::plant_support::{Parts, read};
use proofs_check::effort;
use proofs_check::json::{Field, parse};
use proofs_check::plants::by_n_o;
use proofs_check::rules::by_n_o::claimed::Entry;
use proofs_check::rules::by_n_o::{self as by_n_o_rules, About, Witness};
use proofs_check::rules::sampled::law::Terms;
use proofs_check::rules::set::ClaimedSet;
use proofs_check::verdict::Outcome;
use rug::Rational;
use serde_json::{Value, json};
use std::f64::consts::PI;

/// A complex number.
#[derive(Clone, Copy, Debug)]
struct Z(f64, f64);

impl Z {
    fn times(self, other: Z) -> Z {
        Z(self.0 * other.0 - self.1 * other.1, self.0 * other.1 + self.1 * other.0)
    }

    fn over(self, other: Z) -> Z {
        let Z(re, im) = self.times(Z(other.0, -other.1));
        let square = other.size().powi(2);
        Z(re / square, im / square)
    }

    fn less(self, other: Z) -> Z {
        Z(self.0 - other.0, self.1 - other.1)
    }

    fn size(self) -> f64 {
        self.0.hypot(self.1)
    }

    /// Of `z e^(i angle)` and its conjugate together.
    fn at(self, angle: f64) -> f64 {
        2.0 * (self.0 * angle.cos() - self.1 * angle.sin())
    }
}

/// The solution of linear equations.
fn solved(mut rows: Vec<Vec<Z>>) -> Vec<Z> {
    let n = rows.len();
    for step in 0..n {
        let best = (step..n).max_by(|a, b| rows[*a][step].size().total_cmp(&rows[*b][step].size())).unwrap();
        rows.swap(step, best);
        let own = rows[step].clone();
        for row in rows.iter_mut().skip(step + 1) {
            let factor = row[step].over(own[step]);
            row.iter_mut().zip(&own).for_each(|(entry, other)| *entry = entry.less(factor.times(*other)));
        }
    }
    let mut x = vec![Z(0.0, 0.0); n];
    for i in (0..n).rev() {
        let rest = (i + 1..n).fold(rows[i][n], |rest, j| rest.less(rows[i][j].times(x[j])));
        x[i] = rest.over(rows[i][i]);
    }
    x
}

/// `x' = k A x + b e + f_0(t)`, `e' = c x + d e + q_0(t) + g u`, of the period 1: the factors k and the gains g between two ends.
#[derive(Clone)]
pub struct Loop {
    pub a: Vec<Vec<f64>>,
    pub b: Vec<f64>,
    pub c: Vec<f64>,
    pub d: f64,
    /// Of each state the coefficients of cos and sin.
    pub f_0: Vec<Vec<[f64; 2]>>,
    pub q_0: Vec<[f64; 2]>,
    /// The mean of q_0.
    pub mean: f64,
    pub sigma: f64,
    pub mu: f64,
    pub factor: [f64; 2],
    pub gain: [f64; 2],
}

/// The largest |e|, the root mean square of e, |u|, |L^-1 (x - x_0)|, and the bound of |zeta|_N.
pub struct Numbers([f64; 5]);

/// A law at samples, and with a delay a bound of |y|.
pub struct AtSamples {
    pub terms: Terms,
    pub y: Option<f64>,
}

impl Numbers {
    pub fn of(numbers: [f64; 5]) -> Numbers {
        Numbers(numbers)
    }

    pub fn large() -> Numbers {
        Numbers([1e9; 5])
    }

    pub fn all(&self) -> [f64; 5] {
        self.0
    }

    /// In their order.
    pub fn times(&self, factors: [f64; 5]) -> Numbers {
        Numbers([0, 1, 2, 3, 4].map(|i| self.0[i] * factors[i]))
    }

    pub fn place(which: usize) -> String {
        let (of, name) = match which {
            0..3 => ("claim/by_n_o/0/steady", ["e", "e_rms", "u"][which]),
            _ => ("witness/by_n_o/linear/sizes/0", ["x", "zeta"][which - 3]),
        };
        format!("/{of}/{name}")
    }
}

/// Formulas of a plant with one state.
pub struct Formulas {
    pub f: String,
    pub q: String,
}

/// 0, 1, ..., n_o.
fn first(n_o: usize) -> Vec<usize> {
    (0..=n_o).collect()
}

/// What an entry is about.
fn about(n_o: usize, or_more: bool) -> Value {
    if or_more { json!({ "n_o": n_o, "or_more": true }) } else { json!({ "n_o": n_o }) }
}

pub fn weight(l: usize) -> f64 {
    if l == 0 { 2.0 } else { (l as f64).powf(-1.5) }
}

/// L of one or two states.
pub fn coordinates(states: usize) -> Vec<Vec<f64>> {
    [vec![], vec![vec![0.5]], vec![vec![2.0, 1.0], vec![0.0, 0.25]]][states].clone()
}

/// `L^-1 x`.
fn in_coordinates(x: &[Z]) -> Vec<Z> {
    match x {
        [x] => vec![Z(2.0 * x.0, 2.0 * x.1)],
        [x, y] => {
            let second = Z(4.0 * y.0, 4.0 * y.1);
            let first = x.less(second);
            vec![Z(first.0 / 2.0, first.1 / 2.0), second]
        }
        _ => Vec::new(),
    }
}

/// The harmonics of one loop.
struct Solution {
    e: Vec<Z>,
    u: Vec<Z>,
    x: Vec<Vec<Z>>,
    /// Of each the two components of all oscillators, of the first one.
    zeta: Vec<Vec<Z>>,
}

/// The most of a function over a period.
fn most(of: impl Fn(f64) -> f64) -> f64 {
    (0..2000).map(|j| of(f64::from(j) / 2000.0)).fold(0.0, f64::max)
}

/// At a time, by the harmonics.
fn at(waves: impl Iterator<Item = Z>, t: f64) -> f64 {
    waves.enumerate().map(|(k, z)| if k == 0 { z.0 } else { z.at(2.0 * PI * k as f64 * t) }).sum()
}

impl Loop {
    /// The equations of all states with oscillators at these harmonics at one frequency: e after x, and then z.
    fn solution(&self, own: &[usize], k: f64, g: f64) -> Solution {
        let n = self.a.len();
        let order = n + 2 * own.len();
        let first = |place: usize| if place == 0 { n + 1 } else { n + 2 * place };
        let mut m = vec![vec![0.0; order]; order];
        for (row, own) in m.iter_mut().zip(&self.a) {
            row.iter_mut().zip(own).for_each(|(entry, a)| *entry = k * a);
        }
        for (i, (b, c)) in self.b.iter().zip(&self.c).enumerate() {
            (m[i][n], m[n][i]) = (*b, *c);
        }
        let total: f64 = own.iter().map(|l| weight(*l)).sum();
        m[n][n] = self.d - g * (self.sigma + self.mu * total);
        for (place, l) in own.iter().enumerate() {
            let (at, rate) = (first(place), 2.0 * PI * *l as f64);
            m[n][at] = g * self.mu * weight(*l);
            m[at][n] = -self.sigma;
            if place > 0 {
                (m[at][at + 1], m[at + 1][at], m[at + 1][n]) = (rate, -rate, rate);
            }
        }
        let forced = |waves: &[[f64; 2]], mean: f64, h: usize| match h {
            0 => Z(mean, 0.0),
            _ => waves.get(h - 1).map_or(Z(0.0, 0.0), |[cos, sin]| Z(cos / 2.0, -sin / 2.0)),
        };
        let mut all = Solution { e: vec![], u: vec![], x: vec![], zeta: vec![] };
        for h in 0..=self.q_0.len() {
            let omega = 2.0 * PI * h as f64;
            let equations = |m: &[Vec<f64>], right: &[Z]| {
                let entry = |i: usize, j: usize| Z(-m[i][j], if i == j { omega } else { 0.0 });
                let rows = (0..m.len()).map(|i| (0..m.len()).map(|j| entry(i, j)).chain([right[i]]).collect());
                solved(rows.collect())
            };
            let mut right: Vec<Z> = self.f_0.iter().map(|waves| forced(waves, 0.0, h)).collect();
            let of_x: Vec<Vec<f64>> = m[..n].iter().map(|row| row[..n].to_vec()).collect();
            let at_rest = equations(&of_x, &right);
            right.push(forced(&self.q_0, self.mean, h));
            right.resize(order, Z(0.0, 0.0));
            let found = equations(&m, &right);
            let e = found[n];
            let s = own.iter().enumerate().fold(Z(0.0, 0.0), |sum, (place, l)| {
                let part = found[first(place)].less(e);
                Z(sum.0 + weight(*l) * part.0, sum.1 + weight(*l) * part.1)
            });
            all.u.push(Z(self.mu * s.0 - self.sigma * e.0, self.mu * s.1 - self.sigma * e.1));
            all.x.push(in_coordinates(
                &found[..n].iter().zip(&at_rest).map(|(x, rest)| x.less(*rest)).collect::<Vec<_>>(),
            ));
            let zeta = (0..own.len()).flat_map(|place| {
                let second = if place == 0 { Z(0.0, 0.0) } else { found[first(place) + 1] };
                [found[first(place)].less(e), second]
            });
            all.zeta.push(zeta.collect());
            all.e.push(e);
        }
        all
    }

    /// The bound of |zeta|_N, and its largest value.
    pub fn oscillators(&self, n_o: usize, k: f64, g: f64) -> [f64; 2] {
        self.oscillators_of(&first(n_o), k, g)
    }

    /// The same with oscillators at these harmonics.
    pub fn oscillators_of(&self, own: &[usize], k: f64, g: f64) -> [f64; 2] {
        let zeta = self.solution(own, k, g).zeta;
        let of = |i: usize| weight(own[i / 2]);
        let square = |parts: &[Z]| parts.iter().enumerate().map(|(i, z)| of(i) * z.size().powi(2)).sum::<f64>();
        let within: f64 = zeta
            .iter()
            .enumerate()
            .filter(|(h, _)| own.contains(h))
            .map(|(h, parts)| if h == 0 { 1.0 } else { 2.0 } * square(parts))
            .sum();
        let others = zeta.iter().enumerate().filter(|(h, _)| !own.contains(h));
        let beyond: f64 = others.map(|(_, parts)| 2.0 * square(parts).sqrt()).sum();
        let part = |i: usize, t: f64| at(zeta.iter().map(|parts| parts[i]), t);
        let largest = most(|t| (0..2 * own.len()).map(|i| of(i) * part(i, t).powi(2)).sum::<f64>().sqrt());
        [within.sqrt() + beyond, largest]
    }

    /// The numbers, the largest over factors and gains.
    pub fn largest(&self, n_o: usize) -> Numbers {
        self.largest_of(&first(n_o))
    }

    /// The same with oscillators at these harmonics.
    pub fn largest_of(&self, own: &[usize]) -> Numbers {
        let steps = |[low, high]: [f64; 2]| {
            let count = if low < high { 7 } else { 1 };
            (0..count).map(move |i| low + (high - low) * f64::from(i) / f64::from((count - 1).max(1)))
        };
        let mut all = [0.0_f64; 5];
        for (k, g) in steps(self.factor).flat_map(|k| steps(self.gain).map(move |g| (k, g))) {
            let solution = self.solution(own, k, g);
            let states = |t: f64| {
                let part = |i: usize| at(solution.x.iter().map(|x| x[i]), t);
                (0..self.a.len()).map(|i| part(i).powi(2)).sum::<f64>().sqrt()
            };
            let numbers = [
                most(|t| at(solution.e.iter().copied(), t).abs()),
                solution.e.iter().skip(1).map(|e| 2.0 * e.size().powi(2)).sum::<f64>().sqrt(),
                most(|t| at(solution.u.iter().copied(), t).abs()),
                most(states),
                self.oscillators_of(own, k, g)[0],
            ];
            all.iter_mut().zip(numbers).for_each(|(all, number)| *all = all.max(number));
        }
        Numbers(all)
    }

    /// A form that falls, of this loop.
    pub fn form(&self) -> Value {
        self.form_of(&self.a, [&self.b, &self.c], self.d)
    }

    /// `P = p I` in the plant's coordinates and k_p, with w = 1, by the least pivot.
    pub fn form_of(&self, a: &[Vec<f64>], [b, c]: [&[f64]; 2], d: f64) -> Value {
        let n = a.len();
        let steps = || (-24..=12).map(|i| 1.5_f64.powi(i));
        let least = |p: f64, k_p: f64| {
            let mut worst = f64::INFINITY;
            for (k, g) in self.factor.into_iter().flat_map(|k| self.gain.map(|g| (k, g))) {
                let mut f = vec![vec![0.0; n + 2]; n + 2];
                for i in 0..n {
                    for j in 0..n {
                        f[i][j] = -p * k * (a[i][j] + a[j][i]);
                    }
                    (f[n][i], f[n + 1][i]) = (-p * b[i], -k_p / 2.0 * c[i]);
                    (f[i][n], f[i][n + 1]) = (f[n][i], f[n + 1][i]);
                }
                let beside = -1.0 - k_p / 2.0 * (d + (1.0 - g) * self.sigma);
                (f[n][n], f[n][n + 1], f[n + 1][n], f[n + 1][n + 1]) = (2.0 * self.sigma, beside, beside, k_p);
                let sizes: Vec<f64> = (0..n + 2).map(|i| f[i][i]).collect();
                for step in 0..n + 2 {
                    worst = worst.min(f[step][step] / sizes[step]);
                    let above = f[step].clone();
                    for row in f.iter_mut().skip(step + 1) {
                        let factor = row[step] / above[step];
                        row.iter_mut().zip(&above).for_each(|(entry, other)| *entry -= factor * other);
                    }
                }
            }
            worst
        };
        let all = steps().flat_map(|p| steps().map(move |k_p| (p, k_p)));
        let (p, k_p) = all.max_by(|a, b| least(a.0, a.1).total_cmp(&least(b.0, b.1))).unwrap();
        assert!(least(p, k_p) > 0.0, "a form that falls is found");
        let l = coordinates(n);
        let entry = |i: usize, j: usize| p * (0..n).map(|m| l[m][i] * l[m][j]).sum::<f64>();
        let rows: Vec<Vec<String>> = (0..n).map(|i| (0..n).map(|j| format!("{:.15}", entry(i, j))).collect()).collect();
        let trace: f64 = 1e-9 + (0..n).map(|i| entry(i, i)).sum::<f64>();
        json!({ "P": rows, "p_up": format!("{trace:.15}"), "w": "1", "k_p": format!("{k_p:.15}") })
    }

    fn formulas(&self) -> (Vec<String>, String) {
        let waves = |waves: &[[f64; 2]]| -> String {
            let term = |(h, [cos, sin]): (usize, &[f64; 2])| {
                format!(" + ({cos:.6})*cos({}*pi*t) + ({sin:.6})*sin({0}*pi*t)", 2 * (h + 1))
            };
            waves.iter().enumerate().map(term).collect()
        };
        let row =
            |row: &[f64]| -> String { row.iter().enumerate().map(|(j, a)| format!(" + ({a:.6})*x{j}")).collect() };
        let f = |i: usize| format!("k*(0{}) + ({:.6})*e{}", row(&self.a[i]), self.b[i], waves(&self.f_0[i]));
        let q = format!("{:.6}{} + ({:.6})*e{}", self.mean, row(&self.c), self.d, waves(&self.q_0));
        ((0..self.a.len()).map(f).collect(), q)
    }

    /// What is proved of one n_o, or of it and every larger one.
    pub fn judged(&self, form: &Value, n_o: usize, or_more: bool, numbers: &Numbers) -> Outcome<Vec<String>> {
        let names: Vec<String> = (0..self.a.len()).map(|i| format!("x{i}")).collect();
        self.judged_of((names, self.formulas()), form, about(n_o, or_more), (numbers, None))
    }

    /// What is proved of a law at samples, of an entry without its numbers.
    pub fn judged_at_samples(
        &self,
        form: &Value,
        entry: &Value,
        numbers: &Numbers,
        law: &AtSamples,
    ) -> Outcome<Vec<String>> {
        let names: Vec<String> = (0..self.a.len()).map(|i| format!("x{i}")).collect();
        self.judged_of((names, self.formulas()), form, entry.clone(), (numbers, Some(law)))
    }

    /// What is proved with oscillators at these harmonics.
    pub fn judged_of_set(&self, form: &Value, own: &[usize], numbers: &Numbers) -> Outcome<Vec<String>> {
        let names: Vec<String> = (0..self.a.len()).map(|i| format!("x{i}")).collect();
        self.judged_of((names, self.formulas()), form, json!({ "harmonics": own }), (numbers, None))
    }

    /// The same of other formulas in one state x.
    pub fn judged_as(
        &self,
        formulas: &Formulas,
        form: &Value,
        n_o: usize,
        or_more: bool,
        numbers: &Numbers,
    ) -> Outcome<Vec<String>> {
        let of = (vec![formulas.f.clone()], formulas.q.clone());
        self.judged_of((vec!["x".to_owned()], of), form, about(n_o, or_more), (numbers, None))
    }

    fn judged_of(
        &self,
        (names, (f, q)): (Vec<String>, (Vec<String>, String)),
        form: &Value,
        mut entry: Value,
        (numbers, law): (&Numbers, Option<&AtSamples>),
    ) -> Outcome<Vec<String>> {
        let states = names.len();
        let zeros = json!(vec!["0"; states]);
        let unit: Vec<Vec<f64>> =
            (0..states).map(|i| (0..states).map(|j| f64::from(u8::from(i == j))).collect()).collect();
        let [low, high] = self.gain.map(|g| g.to_string());
        let [from, to] = self.factor.map(|k| k.to_string());
        let moved = if self.factor[0] < self.factor[1] { 1 } else { 0 };
        let still = |curve: Value| json!({ "mean": curve, "harmonics": [] });
        let parts = Parts::scalar("0", "0")
            .with("/plant/states", json!(names))
            .with("/plant/f", json!(f))
            .with("/plant/q", json!(q))
            .with("/plant/parameters", json!({ "k": { "nominal": "1", "low": from, "high": to } }))
            .with("/plant/input_gain", json!({ "nominal": "1", "low": low, "high": high }))
            .with("/plant/internal_model/mu", json!(self.mu.to_string()))
            .with("/witness/coordinates", json!(coordinates(states)))
            .with("/witness/lyapunov/P", json!(unit))
            .with(
                "/witness/orbit",
                json!({ "mean": zeros, "harmonics": [], "sensitivities": vec![still(zeros.clone()); moved], "defect": "0", "tube": "1", "radius": "0" }),
            )
            .with(
                "/witness/forcing",
                json!({ "mean": "0", "harmonics": [], "sensitivities": vec![still(json!("0")); moved], "rest": "0", "rest_t": "0" }),
            );
        let mut parts = parts.0;
        if moved == 0 {
            for part in ["orbit", "forcing"] {
                parts["witness"][part].as_object_mut().unwrap().remove("sensitivities");
            }
        }
        let (spec, plants) = read(&parts)?;
        let [e, e_rms, u, x, zeta] = numbers.0.map(|number| format!("{number:.15e}"));
        entry["steady"] = json!({ "e": e, "e_rms": e_rms, "u": u });
        entry["largest"] = json!({ "e": "0", "u": "0" });
        let mut sizes = json!({ "zeta": zeta });
        if states > 0 {
            sizes["x"] = x.into();
        }
        if let Some(y) = law.and_then(|law| law.y) {
            sizes["y"] = format!("{y:.15e}").into();
        }
        let zero = Rational::new();
        let at_samples =
            law.map(|law| by_n_o_rules::AtSamples { terms: &law.terms, y_0: law.terms.delayed.then_some(&zero) });
        let [claim, witness] = [json!([entry]), json!({ "linear": { "forms": [form], "sizes": [sizes] } })]
            .map(|part| parse(part.to_string().as_bytes()).unwrap());
        let place = |of: &str| format!("/{of}/by_n_o");
        let claimed =
            Entry::read_all(&Field { json: &claim, pointer: place("claim") }, law.map(|law| law.terms.samples))?;
        let witness =
            Witness::read(Some(&Field { json: &witness, pointer: place("witness") }), &claimed, &spec, at_samples)?
                .unwrap();
        let sigma = Rational::from_f64(self.sigma).unwrap();
        let mut lines = Vec::new();
        // The set, the error box, k0, k1 and the function of the claim say something of trials alone.
        let set = ClaimedSet { x0: zero.clone(), e0: zero.clone(), z0: None };
        let periodic = [zero.clone(), zero.clone()];
        let [error_box, transfer, weights] = [[&zero; 2]; 3];
        let about =
            About { sigma: &sigma, set: &set, error_box, periodic, transfer, weights, stability: None, at_samples };
        let prove = || by_n_o::prove(&spec, &plants, &about, (&claimed, &witness), &mut lines);
        effort::limited(effort::LIMIT, prove).0.map(|()| lines)
    }
}
