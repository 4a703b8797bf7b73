//! Bounds by the number of oscillators at samples, of plants that are linear in x and e (derivation, 14.6): against loops whose law is run as it is coded,
//! and whose plant is moved between the samples by the exponential of its matrix.

use crate::controller::installed;
use crate::linear_case::{Case, PARTS, Start};
use crate::support::{assert_valid, cases, certified_in, number, program, read, utf8};
use nalgebra::{DMatrix, DVector};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rug::Rational;
use serde_json::json;
use sigmastar_decide::linear::{Answers, Falling, FallingHeld, LinearPlant, Loop, sizes};
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Document, Oscillators, SampledGain};
use std::f64::consts::TAU;

/// Phases of the samples.
const PHASES: usize = 5;

fn weight(l: u32) -> f64 {
    if l == 0 { 2.0 } else { f64::from(l).powf(-1.5) }
}

/// A law at samples with oscillators at these harmonics.
struct Law {
    samples: u32,
    sigma: f64,
    gain: f64,
    delayed: bool,
    oscillators: Vec<u32>,
}

/// What is seen over a period: the largest |e|, |u|, |x - x_0|, |zeta|_N and |y|, all but the first at the samples, and the root mean square of e there.
#[derive(Debug, Default)]
struct Seen {
    error: f64,
    control: f64,
    states: f64,
    zeta: f64,
    mean: f64,
    rms: f64,
}

impl Case {
    /// The periodic solution of the loop with the gain b of the actuator; `None` where the loop is close to having none.
    fn periodic(&self, law: &Law, b: f64) -> Option<Seen> {
        let n = self.rows.nrows() - 1;
        let h = f64::from(law.samples).recip();
        let flows: Vec<DMatrix<f64>> = (1..=PARTS).map(|part| self.flow(h * part as f64 / PARTS as f64)).collect();
        let mut seen = Seen::default();
        let mut squares = 0.0;
        for phase in 0..PHASES {
            let angle = TAU * h * phase as f64 / PHASES as f64;
            // x_0, x, e, and the states of the law: z, the prediction and the control that is ready.
            let z = 2 * law.oscillators.len() - 1;
            let order = 2 * n + 1 + z + 2;
            let pass = |start: &DVector<f64>, driven: bool, seen: &mut Option<(&mut Seen, &mut f64)>| {
                let mut state = DVector::zeros(self.flow_order());
                state.rows_mut(0, n + 1).copy_from(&start.rows(0, n + 1));
                state.rows_mut(n + 2, n).copy_from(&start.rows(n + 1, n));
                let mut of_law = start.rows(2 * n + 1, z + 2).into_owned();
                for sample in 0..law.samples {
                    for k in 0..self.waves.len() {
                        let at = k as f64 * (angle + TAU * h * f64::from(sample));
                        let share = if driven { 1.0 } else { 0.0 };
                        (state[2 * n + 2 + 2 * k], state[2 * n + 3 + 2 * k]) = (share * at.cos(), share * at.sin());
                    }
                    let e = state[n];
                    let (u, next) = law.step(e, &of_law, h);
                    let zeta = law.level(&of_law.rows(0, z).into_owned(), e);
                    let predicted = if law.delayed { of_law[z] } else { (1.0 - h * law.sigma) * e };
                    state[n + 1] = b * u;
                    let ways: Vec<DVector<f64>> = flows.iter().map(|flow| flow * &state).collect();
                    if let Some((seen, squares)) = seen {
                        **squares += e * e;
                        seen.error = ways.iter().fold(seen.error, |most, at| most.max(at[n].abs()));
                        seen.control = seen.control.max(u.abs());
                        seen.zeta = seen.zeta.max(zeta);
                        let states = (0..n).map(|i| (state[i] - state[n + 2 + i]).powi(2)).sum::<f64>();
                        seen.states = seen.states.max(states.sqrt());
                        // The last y, of which the prediction of e knows.
                        seen.mean = seen.mean.max(if law.delayed { (e - predicted).abs() / h } else { 0.0 });
                    }
                    state = ways[PARTS - 1].clone();
                    of_law = next;
                }
                let mut after = DVector::zeros(order);
                after.rows_mut(0, n + 1).copy_from(&state.rows(0, n + 1));
                after.rows_mut(n + 1, n).copy_from(&state.rows(n + 2, n));
                after.rows_mut(2 * n + 1, z + 2).copy_from(&of_law);
                after
            };
            let driven = pass(&DVector::zeros(order), true, &mut None);
            let columns: Vec<DVector<f64>> = (0..order)
                .map(|i| pass(&DVector::from_fn(order, |k, _| f64::from(i == k)), false, &mut None))
                .collect();
            let map = DMatrix::from_columns(&columns);
            let system = DMatrix::identity(order, order) - map;
            // What the loop makes of a small change is not to be large, for the simulation is in doubles.
            if system.clone().svd(false, false).singular_values.min() < 1e-6 {
                return None;
            }
            let start = system.lu().solve(&driven)?;
            pass(&start, true, &mut Some((&mut seen, &mut squares)));
        }
        seen.rms = (squares / (PHASES as f64 * f64::from(law.samples))).sqrt();
        Some(seen)
    }
}

impl Law {
    /// M, N and R (z - M e), one real block after the other.
    fn turned(&self, z: &DVector<f64>, e: f64, h: f64) -> DVector<f64> {
        let mut turned = z.clone();
        turned[0] = z[0] - e;
        for (at, l) in (1..).step_by(2).zip(&self.oscillators[1..]) {
            let (sin, cos) = (TAU * f64::from(*l) * h).sin_cos();
            let [first, second] = [z[at] - e, z[at + 1]];
            (turned[at], turned[at + 1]) = (cos * first + sin * second, cos * second - sin * first);
        }
        turned
    }

    /// M'N of a state.
    fn heard(&self, z: &DVector<f64>) -> f64 {
        let others = (1..).step_by(2).zip(&self.oscillators[1..]).map(|(at, l)| weight(*l) * z[at]);
        2.0 * z[0] + others.sum::<f64>()
    }

    /// With M times a number added.
    fn with(&self, mut z: DVector<f64>, e: f64) -> DVector<f64> {
        z[0] += e;
        (1..z.len()).step_by(2).for_each(|at| z[at] += e);
        z
    }

    /// |z - M e|_N.
    fn level(&self, z: &DVector<f64>, e: f64) -> f64 {
        let zeta = self.with(z.clone(), -e);
        let others = (1..).step_by(2).zip(&self.oscillators[1..]);
        let sum: f64 = others.map(|(at, l)| weight(*l) * (zeta[at].powi(2) + zeta[at + 1].powi(2))).sum();
        (2.0 * zeta[0].powi(2) + sum).sqrt()
    }

    /// The control of this sample, and the states (z, prediction, next control) after it.
    fn step(&self, e: f64, state: &DVector<f64>, h: f64) -> (f64, DVector<f64>) {
        let z = state.rows(0, state.len() - 2).into_owned();
        let turned = self.turned(&z, e, h);
        let (u, moved, predicted, ready) = if self.delayed {
            let predicted = e - h * self.sigma * state[z.len()];
            let next = self.with(turned, predicted);
            let ahead = self.turned(&next, predicted, h);
            (state[z.len() + 1], next, predicted, -self.sigma * predicted + self.gain * self.heard(&ahead))
        } else {
            let u = -self.sigma * e + self.gain * self.heard(&turned);
            (u, self.with(turned, (1.0 - h * self.sigma) * e), 0.0, 0.0)
        };
        let mut after = DVector::zeros(state.len());
        after.rows_mut(0, moved.len()).copy_from(&moved);
        (after[moved.len()], after[moved.len() + 1]) = (predicted, ready);
        (u, after)
    }
}

/// 1500 loops in a night: what the formulas say of the samples is so to rounding, and nothing goes beyond a bound.
#[test]
fn harmonics_at_samples_are_those_of_the_loop() {
    let (mut looked_at, mut ratios) = (0, Vec::new());
    for index in cases(150, 1500) {
        let mut random = StdRng::seed_from_u64(index);
        let (n, m) = (random.random_range(0..=2), random.random_range(1..=3));
        let case = Case::random(&mut random, n, m);
        let plant =
            Plant::from_value(&Document::parse("linear", &case.document().to_string()).unwrap().root()).unwrap();
        let linear = LinearPlant::of(&plant).unwrap();
        assert_eq!(linear.lines(), m);
        let samples = random.random_range(2 * m as u32 + 1..=40);
        let delayed = random.random::<bool>();
        let sigma = (random.random::<f64>() * f64::from(samples) * 1024.0).round() / 1024.0 + 0.25;
        let sigma = sigma.min(f64::from(samples));
        // 3 K h Nb2 < 2.
        let gain = (random.random::<f64>() * f64::from(samples) / 8.0 * 1024.0).round() / 1024.0 + 1.0 / 1024.0;
        let b = [1.0, 0.75, 1.25][random.random_range(0..3)];
        let set = [&[0][..], &[0, 1], &[0, 1, 2], &[0, 2], &[0, 1, 3]][random.random_range(0..5)];
        if 2 * set[set.len() - 1] >= samples {
            continue;
        }
        let law = Law { samples, sigma, gain, delayed, oscillators: set.to_vec() };
        let Some(seen) = case.periodic(&law, b) else { continue };
        looked_at += 1;
        let exact = |value: f64| Rational::from_f64(value).unwrap();
        let oscillators = Oscillators::at(set).unwrap();
        let identity = (0..n).map(|i| (0..n).map(|k| Rational::from(i32::from(i == k))).collect()).collect();
        let gains = [Enclosure::exactly(b), Enclosure::exactly(b)];
        let of_law = SampledGain { gain: exact(gain), weight_sum: exact(4.625) };
        let own = Loop::new(&exact(sigma), &plant.internal_model, 3.max(m), Some(gains), identity)
            .at_samples(&of_law, samples, delayed);
        let found = sizes(&Answers::new(&linear, own.clock()), &own, &oscillators, 1).unwrap();
        let lowest = found.mean_square.lower_f64();
        assert!((lowest - seen.rms).abs() <= 1e-10 * (1.0 + seen.rms), "{index}: {lowest} {}", seen.rms);
        for (name, seen, found) in [
            ("e", seen.error, &found.error),
            ("u", seen.control, &found.control),
            ("x", seen.states, &found.states),
            ("zeta", seen.zeta, &found.zeta),
            ("y", seen.mean, &found.mean),
        ] {
            let bound = found.upper_f64();
            assert!(seen <= bound * (1.0 + 1e-9) + 1e-9, "{index}, {name}: {seen} {bound}");
            if name == "e" || name == "u" {
                // Some instant of some phase has what is met, and so has one of those that are looked at nearly.
                assert!(found.lower_f64() * 0.8 <= seen + 1e-9, "{index}, {name}: {seen} {found:?}");
                if seen > 1e-6 {
                    ratios.push(seen / bound);
                }
            }
        }
    }
    ratios.sort_by(f64::total_cmp);
    assert!(looked_at > 100 && ratios[ratios.len() / 2] > 0.9, "{looked_at} {:?}", ratios[ratios.len() / 2]);
}

/// Forms of e' = -e/2 + q_0(t) + b u: one that falls with each law, and what keeps others from it.
#[test]
fn forms_at_samples_that_do_not_fall_are_refused() {
    let case = Case {
        rows: DMatrix::from_element(1, 1, -0.5),
        waves: vec![[DVector::zeros(1), DVector::zeros(1)], [DVector::from_element(1, 1.0), DVector::zeros(1)]],
    };
    let plant = Plant::from_value(&Document::parse("linear", &case.document().to_string()).unwrap().root()).unwrap();
    let linear = LinearPlant::of(&plant).unwrap();
    let number = |value: (i32, i32)| Rational::from(value);
    let decided = |delayed: bool, gain: (i32, i32), form: &Falling| {
        let of_law = SampledGain { gain: number(gain), weight_sum: number((37, 8)) };
        let gains = [Enclosure::exactly(0.75), Enclosure::exactly(1.25)];
        let own = Loop::new(&number((5, 1)), &plant.internal_model, 1, Some(gains), Vec::new())
            .at_samples(&of_law, 50, delayed);
        form.decide(&linear, &own, &[])
    };
    let form = |k_p: (i32, i32), lambda: (i32, i32), past: Option<(i32, i32)>| Falling {
        matrix: Vec::new(),
        p_up: number((1, 1)),
        weight: number((1, 1)),
        k_p: number(k_p),
        held: Some(FallingHeld { lambda: number(lambda), past: past.map(number) }),
    };
    let (k_p, lambda, past) = ((1, 2), (10, 1), (1, 10));
    let [plain, delayed] = [None, Some(past)].map(|past| form(k_p, lambda, past));
    assert_eq!([decided(false, (1, 1), &plain), decided(true, (1, 1), &delayed)], [Truth::True; 2]);
    for (with_delay, own) in [(false, &plain), (true, &delayed)] {
        let past = own.held.as_ref().and_then(|held| held.past.is_some().then_some(past));
        for (gain, wrong, is) in [
            ((1, 1), form(k_p, (-10, 1), past), Truth::False),
            ((1, 1), form((-1, 2), lambda, past), Truth::False),
            ((1, 1), Falling { held: None, ..own.clone() }, Truth::False),
            // What belongs to the other law.
            ((1, 1), if with_delay { plain.clone() } else { delayed.clone() }, Truth::False),
            // Too little for G, for y, and more than the samples take.
            ((1, 1), form(k_p, (1, 1000), past), Truth::Undecided),
            ((1, 1), form((1, 100), lambda, past), Truth::Undecided),
            ((17, 1), own.clone(), Truth::Undecided),
        ] {
            assert_eq!(decided(with_delay, gain, &wrong), is, "{with_delay} {gain:?} {wrong:?}");
        }
    }
    // g_m takes from y what it gives to the last one.
    for past in [(-1, 10), (0, 1)] {
        assert_eq!(decided(true, (1, 1), &form(k_p, lambda, Some(past))), Truth::False);
    }
    for past in [(1, 2), (1, 1000)] {
        assert_eq!(decided(true, (1, 1), &form(k_p, lambda, Some(past))), Truth::Undecided);
    }
}

/// A plant whose numbers by n_o, and for a set, a certificate has, with a delay and without: its C code in closed loop keeps to them, and comes close
/// to those along the periodic solution.
#[test]
fn the_exported_law_keeps_to_what_its_certificate_says() {
    if !installed("gcc", &["--version"]) {
        return;
    }
    for delayed in [0, 1] {
        let case = Case {
            rows: DMatrix::from_row_slice(2, 2, &[-3.0, 0.5, 0.625, -0.375]),
            waves: [[0.0, 1.0], [1.0, 1.0], [0.0, 0.5], [0.0, 0.25]]
                .map(|cos| [DVector::from_row_slice(&cos), DVector::zeros(2)])
                .into(),
        };
        let mut document = case.document();
        document["input_gain"] = json!({ "nominal": 2, "low": "9/5", "high": "11/5" });
        document["internal_model"]["sampling_period"] = json!("1/100");
        document["internal_model"]["delay_samples"] = json!(delayed);
        document["internal_model"]["harmonics"] = json!("every-set");
        let folder = tempfile::tempdir().unwrap();
        let (certificate, report) =
            certified_in(folder.path(), &document, &["--harmonics", "0,2", "--target-sup", "1/1000"]);
        assert_valid(&certificate);
        let claim = &read(&certificate)["claim"];
        let entries = claim["by_n_o"].as_array().unwrap();
        assert_eq!(entries.len(), 5);
        assert_eq!(report["by_n_o"].as_array().unwrap().len(), 5);
        // A target is answered by the least of what is proved: by norms no number of oscillators is enough.
        let consequences = &report["consequences"];
        let by_norms = consequences["error_bounds"].as_array().unwrap();
        assert!(by_norms.iter().all(|bounds| number(&bounds["sup"]) > 1e-3), "{consequences}");
        assert_eq!(consequences["targets"][0]["n_o"], 3, "{consequences}");
        for entry in entries {
            let which = match entry["n_o"].as_u64() {
                Some(n_o) => ["--n-o".to_owned(), n_o.to_string()],
                None => ["--harmonics".to_owned(), "0,2".to_owned()],
            };
            let code = folder.path().join("law.c");
            let export = program()
                .arg("controller")
                .arg(&certificate)
                .args(&which)
                .args(["--format", "c", "--prefix", "law"])
                .args(["--force", "-o"])
                .arg(&code)
                .output()
                .unwrap();
            assert!(export.status.success(), "{}", utf8(export.stderr));
            let of = |part: &str, name: &str| number(&entry[part][name]);
            for b in [0.9, 1.1] {
                let start = Start { phase: 0.0, away: DVector::from_element(1, 1.0), error: -1.0 };
                let seen = case.looped(&code, 100, &start, 2.0 * b);
                assert!(seen.settled, "{seen:?}");
                let within = |seen: f64, bound: f64| seen <= bound * (1.0 + 1e-6) + 1e-9;
                let [steady, steady_u] = [seen.steady, seen.steady_control];
                assert!(within(steady, of("steady", "e")) && within(steady_u, of("steady", "u")), "{entry} {seen:?}");
                assert!(
                    within(seen.peak, of("largest", "e")) && within(seen.control, of("largest", "u")),
                    "{entry} {seen:?}"
                );
                // Where only what happens within a sample is left, that is bounded less closely.
                let room = if entry["or_more"] == true { 1.3 } else { 1.02 };
                assert!(b > 1.0 || of("steady", "e") <= room * steady + 1e-9, "{entry} {seen:?}");
            }
        }
    }
}
