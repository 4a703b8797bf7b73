//! Loops of plants that are linear in x and e with a law at samples, simulated in floating point: the law is run with its states, and the plant is
//! integrated between samples with the control held. Nothing of section 14.6 is used but what a number bounds.

use crate::by_n_o_support::{AtSamples, Loop, Numbers, coordinates, weight};
use proofs_check::rules::sampled::law::Terms;
use proofs_check::scope::Scope;
use rug::Rational;
use serde_json::{Value, json};
use std::f64::consts::PI;

/// A little above the sum of all weights.
pub const WEIGHT_SUM: &str = "4.6123753533";

/// A law at samples for a loop of the period 1.
#[derive(Clone)]
pub struct Law {
    pub samples: usize,
    /// K.
    pub gain: f64,
    pub delayed: bool,
}

/// A loop with oscillators at some harmonics, at one factor and one gain.
struct Run<'r> {
    of: &'r Loop,
    law: &'r Law,
    own: &'r [usize],
    factor: f64,
    gain: f64,
    /// The time of the first sample.
    phase: f64,
}

/// The states at a sample: x_0, x, e, z, and with a delay the prediction of e and the control.
#[derive(Clone)]
struct State {
    x_0: Vec<f64>,
    x: Vec<f64>,
    e: f64,
    z: Vec<[f64; 2]>,
    predicted: f64,
    u: f64,
}

/// What is seen at each sample of a period: e, u, `L^-1 (x - x_0)`, zeta by components, and the last y; and on the way e and q' at each step.
#[derive(Default)]
pub struct Seen {
    e: Vec<f64>,
    u: Vec<f64>,
    x: Vec<Vec<f64>>,
    zeta: Vec<Vec<f64>>,
    y: Vec<f64>,
    way: Vec<Vec<[f64; 2]>>,
}

impl State {
    fn numbers(&self) -> Vec<f64> {
        let z = self.z.iter().flatten().copied();
        self.x_0.iter().chain(&self.x).copied().chain([self.e, self.predicted, self.u]).chain(z).collect()
    }

    fn from(numbers: &[f64], states: usize) -> State {
        let (x_0, rest) = numbers.split_at(states);
        let (x, rest) = rest.split_at(states);
        let z = rest[3..].chunks(2).map(|pair| [pair[0], pair[1]]).collect();
        State { x_0: x_0.to_vec(), x: x.to_vec(), e: rest[0], predicted: rest[1], u: rest[2], z }
    }
}

impl Law {
    /// Steps of the integration in a sample.
    fn steps(&self) -> usize {
        if self.samples < 50 { 24 } else { 6 }
    }
}

impl Run<'_> {
    fn h(&self) -> f64 {
        1.0 / self.law.samples as f64
    }

    fn wave(waves: &[[f64; 2]], t: f64) -> [f64; 2] {
        let term = |(h, [cos, sin]): (usize, &[f64; 2])| {
            let rate = 2.0 * PI * (h + 1) as f64;
            let (s, c) = (rate * t).sin_cos();
            [cos * c + sin * s, rate * (sin * c - cos * s)]
        };
        waves.iter().enumerate().map(term).fold([0.0; 2], |sum, term| [sum[0] + term[0], sum[1] + term[1]])
    }

    /// The derivative of x_0, x and e, one after the other.
    fn velocity(&self, at: &[f64], u: f64, t: f64) -> Vec<f64> {
        let n = self.of.a.len();
        let e = at[2 * n];
        let moved = |x: &[f64], i: usize, e: f64| {
            let own: f64 = self.of.a[i].iter().zip(x).map(|(a, x)| self.factor * a * x).sum();
            own + self.of.b[i] * e + Run::wave(&self.of.f_0[i], t)[0]
        };
        let mut all: Vec<f64> = (0..n).map(|i| moved(&at[..n], i, 0.0)).collect();
        all.extend((0..n).map(|i| moved(&at[n..2 * n], i, e)));
        all.push(self.q(&at[n..=2 * n], t) + self.gain * u);
        all
    }

    /// q at x and e.
    fn q(&self, at: &[f64], t: f64) -> f64 {
        let of_x: f64 = self.of.c.iter().zip(at).map(|(c, x)| c * x).sum();
        of_x + self.of.d * at[at.len() - 1] + self.of.mean + Run::wave(&self.of.q_0, t)[0]
    }

    /// R (z - M e): each block is turned by its angle.
    fn turned(&self, z: &[[f64; 2]], e: f64) -> Vec<[f64; 2]> {
        let turn = |([first, second], l): (&[f64; 2], &usize)| {
            let (s, c) = (2.0 * PI * *l as f64 * self.h()).sin_cos();
            let first = first - e;
            [c * first + s * second, c * second - s * first]
        };
        z.iter().zip(self.own).map(turn).collect()
    }

    fn heard(&self, z: &[[f64; 2]]) -> f64 {
        z.iter().zip(self.own).map(|([first, _], l)| weight(*l) * first).sum()
    }

    /// One sample; what is seen in it.
    fn step(&self, state: &State, j: usize, seen: Option<&mut Seen>) -> State {
        let (h, sigma, gain, n) = (self.h(), self.of.sigma, self.law.gain, self.of.a.len());
        let turned = self.turned(&state.z, state.e);
        let (u, predicted) = match self.law.delayed {
            false => (-sigma * state.e + gain * self.heard(&turned), (1.0 - h * sigma) * state.e),
            true => (state.u, state.e - h * sigma * state.predicted),
        };
        let z: Vec<[f64; 2]> = turned.iter().map(|[first, second]| [first + predicted, *second]).collect();
        let next_u = -sigma * predicted + gain * self.heard(&self.turned(&z, predicted));

        let mut at: Vec<f64> = state.x_0.iter().chain(&state.x).copied().chain([state.e]).collect();
        let steps = self.law.steps();
        let (start, small) = (self.phase + j as f64 * h, h / steps as f64);
        let mut way = Vec::new();
        let mut note = |at: &[f64], t: f64| {
            let v = self.velocity(at, u, t);
            let of_x: f64 = self.of.c.iter().zip(&v[n..]).map(|(c, v)| c * v).sum();
            way.push([at[2 * n], of_x + self.of.d * v[2 * n] + Run::wave(&self.of.q_0, t)[1]]);
        };
        for i in 0..steps {
            let t = start + i as f64 * small;
            note(&at, t);
            let moved = |by: &[f64], f: f64| at.iter().zip(by).map(|(a, b)| a + f * b).collect::<Vec<f64>>();
            let k1 = self.velocity(&at, u, t);
            let k2 = self.velocity(&moved(&k1, small / 2.0), u, t + small / 2.0);
            let k3 = self.velocity(&moved(&k2, small / 2.0), u, t + small / 2.0);
            let k4 = self.velocity(&moved(&k3, small), u, t + small);
            for (i, a) in at.iter_mut().enumerate() {
                *a += small / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
            }
        }
        note(&at, start + h);
        if let Some(seen) = seen {
            seen.e.push(state.e);
            seen.u.push(u);
            let off: Vec<f64> = state.x.iter().zip(&state.x_0).map(|(x, x_0)| x - x_0).collect();
            seen.x.push(match off.as_slice() {
                [] => Vec::new(),
                [x] => vec![x / coordinates(1)[0][0]],
                [x, y, ..] => {
                    let l = coordinates(2);
                    let second = y / l[1][1];
                    vec![(x - l[0][1] * second) / l[0][0], second]
                }
            });
            let zeta = state.z.iter().flat_map(|[first, second]| [first - state.e, *second]);
            seen.zeta.push(zeta.collect());
            seen.y.push((state.e - state.predicted) / h);
            seen.way.push(way);
        }
        State {
            x_0: at[..n].to_vec(),
            x: at[n..2 * n].to_vec(),
            e: at[2 * n],
            z,
            // Without a delay nothing is stored.
            predicted: if self.law.delayed { predicted } else { 0.0 },
            u: if self.law.delayed { next_u } else { 0.0 },
        }
    }

    /// The periodic solution: the map over a period is affine.
    fn periodic(&self) -> Seen {
        let n = self.of.a.len();
        let over = |numbers: &[f64]| {
            let start = State::from(numbers, n);
            (0..self.law.samples).fold(start, |state, j| self.step(&state, j, None)).numbers()
        };
        let order = 2 * n + 3 + 2 * self.own.len();
        let offset = over(&vec![0.0; order]);
        let mut rows: Vec<Vec<f64>> = offset.iter().map(|value| [vec![0.0; order], vec![*value]].concat()).collect();
        for i in 0..order {
            let mut unit = vec![0.0; order];
            unit[i] = 1.0;
            let image = over(&unit);
            for (j, row) in rows.iter_mut().enumerate() {
                row[i] = f64::from(u8::from(i == j)) - (image[j] - offset[j]);
            }
        }
        // The second component at 0 is never moved.
        let idle = 2 * n + 4;
        rows[idle][idle] = 1.0;
        let start = State::from(&solved(rows), n);
        let mut seen = Seen::default();
        let end = (0..self.law.samples).fold(start.clone(), |state, j| self.step(&state, j, Some(&mut seen)));
        let apart = start.numbers().iter().zip(end.numbers()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-8, "it is periodic: {apart}");
        seen
    }
}

/// The solution of linear equations.
fn solved(mut rows: Vec<Vec<f64>>) -> Vec<f64> {
    let n = rows.len();
    for step in 0..n {
        let best = (step..n).max_by(|a, b| rows[*a][step].abs().total_cmp(&rows[*b][step].abs())).unwrap();
        rows.swap(step, best);
        let own = rows[step].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != step) {
            let factor = row[step] / own[step];
            row.iter_mut().zip(&own).for_each(|(entry, other)| *entry -= factor * other);
        }
    }
    (0..n).map(|i| rows[i][n] / rows[i][i]).collect()
}

/// The harmonic k of a sequence over a period.
fn harmonic(values: impl Iterator<Item = f64>, count: usize, k: usize) -> [f64; 2] {
    let term = |(j, value): (usize, f64)| {
        let (s, c) = (2.0 * PI * (j * k % count) as f64 / count as f64).sin_cos();
        [value * c / count as f64, -value * s / count as f64]
    };
    values.enumerate().map(term).fold([0.0; 2], |sum, term| [sum[0] + term[0], sum[1] + term[1]])
}

fn size([re, im]: [f64; 2]) -> f64 {
    re.hypot(im)
}

fn both(k: usize) -> f64 {
    if k == 0 { 1.0 } else { 2.0 }
}

/// The largest length over all angles of a vector of polynomials with these harmonics.
fn most(parts: &[Vec<[f64; 2]>]) -> f64 {
    let at = |angle: f64| {
        let value = |waves: &Vec<[f64; 2]>| -> f64 {
            let term = |(k, [re, im]): (usize, &[f64; 2])| {
                let (s, c) = (k as f64 * angle).sin_cos();
                both(k) * (re * c - im * s)
            };
            waves.iter().enumerate().map(term).sum()
        };
        parts.iter().map(|waves| value(waves).powi(2)).sum::<f64>().sqrt()
    };
    (0..3000).map(|i| at(2.0 * PI * f64::from(i) / 3000.0)).fold(0.0, f64::max)
}

impl Law {
    /// The largest |e|, its root mean square, |u|, |L^-1 (x - x_0)|, |zeta|_N and |y| that are seen for some phases of the samples.
    pub fn largest(&self, of: &Loop, own: &[usize], [factor, gain]: [f64; 2]) -> [f64; 6] {
        let mut all = [0.0_f64; 6];
        for i in 0..5 {
            let phase = f64::from(i) / 5.0 / self.samples as f64;
            let seen = Run { of, law: self, own, factor, gain, phase }.periodic();
            let peak = |values: &mut dyn Iterator<Item = f64>| values.map(f64::abs).fold(0.0, f64::max);
            let way = || seen.way.iter().flat_map(|way| &way[..self.steps()]).map(|[e, _]| *e);
            let mean = way().map(|e| e * e).sum::<f64>() / (self.samples * self.steps()) as f64;
            let length = |x: &Vec<f64>| x.iter().map(|x| x * x).sum::<f64>().sqrt();
            let norm = |zeta: &Vec<f64>| {
                let parts = zeta.iter().zip(0..).map(|(part, i)| weight(own[i / 2]) * part * part);
                parts.sum::<f64>().sqrt()
            };
            let numbers = [
                peak(&mut way()),
                mean.sqrt(),
                peak(&mut seen.u.iter().copied()),
                peak(&mut seen.x.iter().map(length)),
                peak(&mut seen.zeta.iter().map(norm)),
                peak(&mut seen.y.iter().copied()),
            ];
            all.iter_mut().zip(numbers).for_each(|(all, number)| *all = all.max(number));
        }
        all
    }

    /// What section 14.6 says of them, from the harmonics of what is seen: the numbers, with how much of the first is between samples.
    fn bounds_at(&self, of: &Loop, own: &[usize], [factor, gain]: [f64; 2]) -> ([f64; 6], f64) {
        let seen = Run { of, law: self, own, factor, gain, phase: 0.0 }.periodic();
        let (count, last) = (self.samples, of.q_0.len());
        let waves = |at: &dyn Fn(usize) -> f64| -> Vec<[f64; 2]> {
            let all = (0..=last).map(|k| harmonic((0..count).map(at), count, k));
            all.collect()
        };
        let e = waves(&|j| seen.e[j]);
        let rates: Vec<f64> = (0..=self.steps())
            .map(|i| waves(&|j| seen.way[j][i][1]).into_iter().map(size).collect::<Vec<f64>>())
            .reduce(|a, b| a.iter().zip(b).map(|(a, b)| a.max(b)).collect())
            .unwrap();
        let share = 1.0 / (8.0 * (count * count) as f64);
        let sum = |of: &dyn Fn(usize) -> f64| (0..=last).map(|k| both(k) * of(k)).sum::<f64>();
        let between = share * sum(&|k| rates[k]);
        let states: Vec<Vec<[f64; 2]>> = (0..of.a.len()).map(|i| waves(&|j| seen.x[j][i])).collect();
        let zeta: Vec<Vec<[f64; 2]>> = (0..2 * own.len()).map(|i| waves(&|j| seen.zeta[j][i])).collect();
        let square = |k: usize| -> f64 {
            zeta.iter().enumerate().map(|(i, waves)| weight(own[i / 2]) * size(waves[k]).powi(2)).sum()
        };
        let within = sum(&|k| if own.contains(&k) { square(k) } else { 0.0 }).sqrt();
        let beyond = sum(&|k| if own.contains(&k) { 0.0 } else { square(k).sqrt() });
        let y = waves(&|j| seen.y[j]);
        let numbers = [
            most(std::slice::from_ref(&e)) + between,
            sum(&|k| size(e[k]).powi(2)).sqrt() + share * sum(&|k| rates[k].powi(2)).sqrt(),
            most(&[waves(&|j| seen.u[j])]),
            most(&states),
            within + beyond,
            if self.delayed { sum(&|k| size(y[k])) } else { 0.0 },
        ];
        (numbers, between)
    }

    /// The numbers of all members, the largest of each, with that between samples.
    pub fn bounds(&self, of: &Loop, own: &[usize]) -> ([f64; 6], f64) {
        let steps = |[low, high]: [f64; 2]| {
            let count = if low < high { 4 } else { 1 };
            (0..count).map(move |i| low + (high - low) * f64::from(i) / f64::from((count - 1).max(1)))
        };
        let members = steps(of.factor).flat_map(|factor| steps(of.gain).map(move |gain| [factor, gain]));
        let all = members.map(|member| self.bounds_at(of, own, member));
        all.fold(([0.0; 6], 0.0), |(numbers, between), (own, more)| {
            let larger = std::array::from_fn(|i| f64::max(numbers[i], own[i]));
            (larger, f64::max(between, more))
        })
    }

    /// The law of the checker, with a bound of |y| where there is a delay.
    pub fn terms(&self, of: &Loop, y: f64) -> AtSamples {
        let number = |value: f64| Rational::from_f64(value).unwrap();
        let terms = Terms {
            sigma: number(of.sigma),
            samples: self.samples as u32,
            gain: number(self.gain),
            weight_sum: proofs_check::json::decimal(WEIGHT_SUM).unwrap(),
            delayed: self.delayed,
            scope: Scope::First,
        };
        AtSamples { terms, y: self.delayed.then_some(y) }
    }

    /// `F_s` of (14.6a) as it is written, in (x, e, y, G, v, p), for one member, s and sign.
    fn form(&self, of: &Loop, numbers: [f64; 4], [factor, gain]: [f64; 2], [s, sign]: [f64; 2]) -> Vec<Vec<f64>> {
        let [p, k_p, lambda, g_m] = numbers;
        let (n, h, sigma) = (of.a.len(), 1.0 / self.samples as f64, of.sigma);
        let [e, y, g, v, last] = [n, n + 1, n + 2, n + 3, n + 4];
        let order = if self.delayed { n + 5 } else { n + 4 };
        let highest = of.gain[1];
        let theta = highest * self.gain * h * WEIGHT_SUM.parse::<f64>().unwrap() / 2.0;
        // Linear functions of the variables, and products of them.
        let unit = |i: usize| (0..order).map(|j| f64::from(u8::from(i == j))).collect::<Vec<f64>>();
        let plus = |a: &[f64], b: &[f64], f: f64| a.iter().zip(b).map(|(a, b)| a + f * b).collect::<Vec<f64>>();
        let zero = vec![0.0; order];
        let (hat, bar) = match self.delayed {
            false => (unit(y), unit(e)),
            true => (plus(&unit(y), &unit(last), h * sigma), plus(&unit(e), &unit(last), -h)),
        };
        let e_s = plus(&plus(&plus(&zero, &unit(e), 1.0 - s * sigma), &hat, s), &unit(g), 1.0);
        let q = (0..n).fold(plus(&zero, &e_s, of.d), |sum, i| plus(&sum, &unit(i), of.c[i]));
        let mut f = vec![vec![0.0; order]; order];
        let mut add = |a: &[f64], b: &[f64], factor: f64| {
            for i in 0..order {
                for j in 0..order {
                    f[i][j] += factor * (a[i] * b[j] + a[j] * b[i]) / 2.0;
                }
            }
        };
        for i in 0..n {
            for j in 0..n {
                add(&unit(i), &unit(j), -2.0 * p * factor * of.a[i][j]);
            }
            add(&unit(i), &e_s, -2.0 * p * of.b[i]);
        }
        add(&unit(e), &unit(e), sigma * (2.0 - h * sigma));
        add(&unit(e), &hat, -2.0 * (1.0 - h * sigma));
        add(&hat, &hat, -h);
        add(&unit(y), &unit(y), k_p * (1.0 - theta));
        add(&unit(y), &q, -k_p);
        add(&bar, &unit(y), -k_p * (1.0 - gain) * sigma);
        add(&unit(g), &unit(g), lambda);
        add(&unit(v), &q, 2.0 * lambda * h / PI);
        add(&unit(v), &unit(v), lambda);
        if self.delayed {
            add(&unit(last), &unit(last), g_m);
            add(&unit(y), &unit(y), -g_m);
            add(&unit(y), &unit(last), sign * 2.0 * theta * k_p);
        }
        f
    }

    /// The least pivot of all of them over the diagonal: above 0 where the form falls.
    pub fn least(&self, of: &Loop, numbers: [f64; 4]) -> f64 {
        let h = 1.0 / self.samples as f64;
        let mut worst = f64::INFINITY;
        for (factor, gain) in of.factor.into_iter().flat_map(|factor| of.gain.map(|gain| (factor, gain))) {
            for at in [[0.0, 1.0], [0.0, -1.0], [h, 1.0], [h, -1.0]] {
                let mut f = self.form(of, numbers, [factor, gain], at);
                let sizes: Vec<f64> = (0..f.len()).map(|i| f[i][i]).collect();
                for step in 0..f.len() {
                    worst = worst.min(f[step][step] / sizes[step].abs());
                    let above = f[step].clone();
                    for row in f.iter_mut().skip(step + 1) {
                        let factor = row[step] / above[step];
                        row.iter_mut().zip(&above).for_each(|(entry, other)| *entry -= factor * other);
                    }
                }
            }
        }
        if worst.is_nan() { f64::NEG_INFINITY } else { worst }
    }

    /// p, k_p, lambda and g_m of a form that falls, with w = 1, by a search along each of them.
    pub fn found(&self, of: &Loop) -> [f64; 4] {
        let mut best = [0.1, 1.0 / of.sigma, 4.0 * of.sigma, 0.1 / of.sigma];
        let mut score = self.least(of, best);
        let mut spread = 8.0_f64;
        while spread > 1.01 {
            let mut moved = false;
            for which in 0..4 {
                for factor in [spread, 1.0 / spread] {
                    let mut next = best;
                    next[which] *= factor;
                    let value = self.least(of, next);
                    if value > score {
                        (best, score, moved) = (next, value, true);
                    }
                }
            }
            if !moved {
                spread = spread.sqrt();
            }
        }
        assert!(score > 1e-6, "a form that falls is found: {score}");
        best
    }

    /// These numbers as a form of a file, in the coordinates of the claim.
    pub fn written(&self, of: &Loop, [p, k_p, lambda, g_m]: [f64; 4]) -> Value {
        let n = of.a.len();
        let l = coordinates(n);
        let entry = |i: usize, j: usize| p * (0..n).map(|m| l[m][i] * l[m][j]).sum::<f64>();
        let rows: Vec<Vec<String>> = (0..n).map(|i| (0..n).map(|j| format!("{:.15}", entry(i, j))).collect()).collect();
        let trace: f64 = 1e-9 + (0..n).map(|i| entry(i, i)).sum::<f64>();
        let mut form = json!({ "P": rows, "p_up": format!("{trace:.15}"), "w": "1" });
        form["k_p"] = format!("{k_p:.15e}").into();
        form["lambda"] = format!("{lambda:.15e}").into();
        if self.delayed {
            form["gm"] = format!("{g_m:.15e}").into();
        }
        form
    }
}

/// The first five of them, each times a factor.
pub fn numbers(bounds: &[f64; 6], factors: [f64; 6]) -> Numbers {
    Numbers::of(std::array::from_fn(|i| bounds[i] * factors[i]))
}
