//! Plants of period 1 that are linear in x and e, and their loop with exported C code: the law runs as it is exported, and the exponential of a matrix
//! moves the plant between its samples, so that nothing is left to an integrator.

use crate::controller_c::gcc;
use crate::support::utf8;
use nalgebra::{DMatrix, DVector};
use rand::RngExt;
use rand::rngs::StdRng;
use serde_json::{Value, json};
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

/// Parts of a sample at which e is looked at.
pub const PARTS: usize = 8;

/// By how much e may change from a period to the next where the loop has settled, and how many periods it has for that.
const SAME: f64 = 1e-13;
const MOST_PERIODS: u32 = 40_000;

/// A plant of period 1 with n states: `X' = rows X + sum of (cos, sin) of the harmonics k = 0, 1, ... + B b u`, X = (x, e).
pub struct Case {
    pub rows: DMatrix<f64>,
    pub waves: Vec<[DVector<f64>; 2]>,
}

/// Where a loop starts: at this share of the period, so far from `x_0`, and with this error.
pub struct Start {
    pub phase: f64,
    pub away: DVector<f64>,
    pub error: f64,
}

/// What is seen of a loop: the largest |e| and |u| of all times, those of its last period with the root mean square of e in it, and whether it had settled
/// by then.
#[derive(Clone, Copy, Debug)]
pub struct Looped {
    pub peak: f64,
    pub control: f64,
    pub steady: f64,
    pub steady_control: f64,
    pub rms: f64,
    pub settled: bool,
}

impl Case {
    /// One of n states with m harmonics; the numbers have three digits.
    pub fn random(random: &mut StdRng, n: usize, m: usize) -> Case {
        let mut number = |size: f64| ((random.random::<f64>() * 2.0 - 1.0) * size * 1000.0).round() / 1000.0;
        let mut rows = DMatrix::from_fn(n + 1, n + 1, |_, _| number(3.0));
        for i in 0..n {
            rows[(i, i)] = -6.0 - number(4.0);
        }
        let mut wave = |k: usize| {
            let mut part = || DVector::from_fn(n + 1, |_, _| number(2.0 / (1.0 + k as f64)));
            [part(), part()]
        };
        Case { rows, waves: (0..=m).map(&mut wave).collect() }
    }

    pub fn document(&self) -> Value {
        let n = self.rows.nrows() - 1;
        let names = ["v", "w"];
        let row = |i: usize| {
            let mut text = String::new();
            for (j, name) in names[..n].iter().chain(["e"].iter()).enumerate() {
                write!(text, "+ ({})*{name} ", self.rows[(i, j)]).unwrap();
            }
            for (k, [cos, sin]) in self.waves.iter().enumerate() {
                write!(text, "+ ({})*cos({k}*phase) + ({})*sin({k}*phase) ", cos[i], sin[i]).unwrap();
            }
            text.trim_start_matches("+ ").to_owned()
        };
        json!({
            "format": "sigmastar/plant", "version": 1, "name": "linear", "period": 1, "states": names[..n],
            "f": (0..n).map(row).collect::<Vec<String>>(), "q": row(n),
            "initial_set": { "kind": "aligned", "ball": 1, "E0": 1 },
            "internal_model": {
                "mu": 3, "base_frequency": "2*pi", "matched": true,
                "weights": { "family": "power", "n0": 2, "epsilon": "1/2" },
            },
        })
    }

    /// (x, e, b u, x_0, cosines, sines) after so much time, over the same before.
    pub fn flow(&self, time: f64) -> DMatrix<f64> {
        let (n, m) = (self.rows.nrows() - 1, self.waves.len());
        let mut matrix = DMatrix::zeros(2 * n + 2 + 2 * m, 2 * n + 2 + 2 * m);
        matrix.view_mut((0, 0), (n + 1, n + 1)).copy_from(&self.rows);
        matrix[(n, n + 1)] = 1.0;
        matrix.view_mut((n + 2, n + 2), (n, n)).copy_from(&self.rows.view((0, 0), (n, n)));
        for (k, [cos, sin]) in self.waves.iter().enumerate() {
            let at = 2 * n + 2 + 2 * k;
            matrix.view_mut((0, at), (n + 1, 1)).copy_from(cos);
            matrix.view_mut((0, at + 1), (n + 1, 1)).copy_from(sin);
            matrix.view_mut((n + 2, at), (n, 1)).copy_from(&cos.rows(0, n));
            matrix.view_mut((n + 2, at + 1), (n, 1)).copy_from(&sin.rows(0, n));
            (matrix[(at, at + 1)], matrix[(at + 1, at)]) = (-TAU * k as f64, TAU * k as f64);
        }
        (matrix * time).exp()
    }

    /// How many numbers [`Case::flow`] moves.
    pub fn flow_order(&self) -> usize {
        2 * (self.rows.nrows() - 1) + 2 + 2 * self.waves.len()
    }

    /// `x_0` at this share of the period, the periodic solution of x' = f(t, x, 0): its harmonic `p cos + q sin` has `k w q = A p + a`, `-k w p = A q + b`.
    fn at_rest(&self, phase: f64) -> DVector<f64> {
        let n = self.rows.nrows() - 1;
        let mut x = DVector::zeros(n);
        for (k, [cos, sin]) in self.waves.iter().enumerate().filter(|_| n > 0) {
            let own = -self.rows.view((0, 0), (n, n));
            let turn = DMatrix::identity(n, n) * (TAU * k as f64);
            let mut system = DMatrix::zeros(2 * n, 2 * n);
            system.view_mut((0, 0), (n, n)).copy_from(&own);
            system.view_mut((n, n), (n, n)).copy_from(&own);
            system.view_mut((0, n), (n, n)).copy_from(&turn);
            system.view_mut((n, 0), (n, n)).copy_from(&-turn);
            let drive = DVector::from_fn(2 * n, |i, _| if i < n { cos[i] } else { sin[i - n] });
            let found = system.lu().solve(&drive).expect("the states decay");
            let (s, c) = (TAU * k as f64 * phase).sin_cos();
            x += found.rows(0, n) * c + found.rows(n, n) * s;
        }
        x
    }

    /// The numbers that [`Case::flow`] moves, at a start.
    fn starting(&self, start: &Start) -> DVector<f64> {
        let n = self.rows.nrows() - 1;
        let at_rest = self.at_rest(start.phase);
        let mut state = DVector::zeros(self.flow_order());
        state.rows_mut(0, n).copy_from(&(&at_rest + &start.away));
        state[n] = start.error;
        state.rows_mut(n + 2, n).copy_from(&at_rest);
        for k in 0..self.waves.len() {
            let (sin, cos) = (TAU * k as f64 * start.phase).sin_cos();
            (state[2 * n + 2 + 2 * k], state[2 * n + 3 + 2 * k]) = (cos, sin);
        }
        state
    }

    /// Runs the code of a law with the prefix `law`, aligned with the error at the start, with the gain b of the actuator, until e is the same at the
    /// samples of two periods, or for so many periods.
    pub fn looped(&self, code: &Path, samples: u32, start: &Start, b: f64) -> Looped {
        let (source, program) = (code.with_file_name("loop.c"), code.with_file_name("loop"));
        std::fs::write(&source, self.loop_in_c(samples, start, b)).unwrap();
        gcc(&[&source, code], &program);
        let said = utf8(Command::new(&program).output().unwrap().stdout);
        let numbers: Vec<f64> = said.split_whitespace().map(|word| word.parse().unwrap()).collect();
        let [peak, control, steady, steady_control, mean_square, changed] = numbers[..] else { panic!("{said}") };
        Looped { peak, control, steady, steady_control, rms: mean_square.sqrt(), settled: changed <= SAME }
    }

    fn loop_in_c(&self, samples: u32, start: &Start, b: f64) -> String {
        let list = |numbers: &mut dyn Iterator<Item = f64>| {
            let numbers: Vec<String> = numbers.map(|entry| format!("{entry:.17e}")).collect();
            format!("{{{}}}", numbers.join(", "))
        };
        let ways: Vec<String> = (1..=PARTS)
            .map(|part| self.flow(part as f64 / (f64::from(samples) * PARTS as f64)))
            .map(|flow| list(&mut flow.transpose().iter().copied()))
            .collect();
        let (order, error) = (self.flow_order(), self.rows.nrows() - 1);
        format!(
            r#"#include "law.h"
#include <math.h>
#include <stdio.h>

enum {{ ORDER = {order}, ERROR = {error}, PARTS = {PARTS}, SAMPLES = {samples}, MOST_PERIODS = {MOST_PERIODS} }};

static const double ways[PARTS][ORDER * ORDER] = {{{ways}}};

static double larger(double most, double value)
{{
    double size = fabs(value);

    return size > most ? size : most;
}}

static void moved(const double *matrix, const double *from, double *to)
{{
    int i, k;

    for (i = 0; i < ORDER; i++) {{
        to[i] = 0.0;
        for (k = 0; k < ORDER; k++) {{
            to[i] += matrix[i * ORDER + k] * from[k];
        }}
    }}
}}

int main(void)
{{
    law_controller controller;
    double state[ORDER] = {state}, way[ORDER], before[SAMPLES] = {{0.0}}, ready = 0.0;
    double peak = 0.0, control = 0.0, steady = 0.0, steady_control = 0.0, squares = 0.0, changed = 1.0;
    int period, sample, part, i;

    law_reset(&controller, state[ERROR]);
    for (period = 0; period < MOST_PERIODS && changed > {SAME:e}; period++) {{
        steady = steady_control = squares = changed = 0.0;
        for (sample = 0; sample < SAMPLES; sample++) {{
            double next = law_step(&controller, state[ERROR]);
#ifdef LAW_DELAY_SAMPLES
            double u = ready;
#else
            double u = next;

            (void)ready;
#endif
            ready = next;
            changed = larger(changed, state[ERROR] - before[sample]);
            before[sample] = state[ERROR];
            peak = larger(peak, state[ERROR]);
            steady_control = larger(steady_control, u);
            state[ERROR + 1] = {b:.17e} * u;
            for (part = 0; part < PARTS; part++) {{
                moved(ways[part], state, way);
                steady = larger(steady, way[ERROR]);
                squares += way[ERROR] * way[ERROR];
            }}
            for (i = 0; i < ORDER; i++) {{
                state[i] = way[i];
            }}
        }}
        peak = larger(peak, steady);
        control = larger(control, steady_control);
    }}
    printf("%.17e %.17e %.17e %.17e %.17e %.17e\n", peak, control, steady, steady_control,
           squares / (SAMPLES * PARTS), changed);
    return 0;
}}
"#,
            ways = ways.join(", "),
            state = list(&mut self.starting(start).iter().copied()),
        )
    }
}
