//! The loop at samples as a library: against exact solutions, against continuous time, and its derivative.

use crate::controller::constant;
use crate::support::PLANT_TEXT;
use nalgebra::{DMatrix, DVector};
use sigmastar_document::progress::Silent;
use sigmastar_lab::simulate::{
    ClosedLoop, Converters, SampledLoop, SampledRun, SampledSettings, SampledSteadyError, SteadyFigures, Tolerance,
    period_derivative, sampled_steady_state, simulate_sampled, steady_state,
};
use sigmastar_lang::plant::Plant;
use sigmastar_regulator::{Design, Stepper};
use std::f64::consts::TAU;

/// The loop of a plant with its own internal model.
pub fn sampled(plant: &Plant, sigma: &str, n_o: u32, step: &str, limit: Option<f64>) -> SampledLoop {
    let (sigma, step) = (constant(sigma), constant(step));
    let design = Design::new(&plant.internal_model, &sigma, n_o);
    SampledLoop::new(plant, design.regulator(), design.discretise(&step).unwrap().saturated(limit))
}

fn example() -> Plant {
    Plant::from_json("paper-example", PLANT_TEXT).unwrap()
}

/// x' = -x + e/2 + cos(wt)/2, y' = rate (x + e - y), e' = x - y/2 - e/3 + sin(wt) + u.
fn linear(rate: f64) -> Plant {
    let text = format!(
        r#"{{"format": "sigmastar/plant", "version": 1, "name": "linear", "period": 1, "states": ["x", "y"],
        "f": ["-x + e/2 + cos(2*pi*t)/2", "{rate}*(x + e - y)"], "q": "x - y/2 - e/3 + sin(2*pi*t)",
        "internal_model": {{"mu": 1, "base_frequency": "2*pi", "weights": {{"family": "power", "n0": "2", "epsilon": "1/2"}}}}}}"#
    );
    Plant::from_json("linear", &text).unwrap_or_else(|errors| panic!("{}", errors.render(false)))
}

/// (x, y, e, u, cos, sin)' = A (x, y, e, u, cos, sin).
fn generator(rate: f64) -> DMatrix<f64> {
    let rows = [
        [-1.0, 0.0, 0.5, 0.0, 0.5, 0.0],
        [rate, -rate, rate, 0.0, 0.0, 0.0],
        [1.0, -0.5, -1.0 / 3.0, 1.0, 0.0, 1.0],
        [0.0; 6],
        [0.0, 0.0, 0.0, 0.0, 0.0, -TAU],
        [0.0, 0.0, 0.0, 0.0, TAU, 0.0],
    ];
    DMatrix::from_fn(6, 6, |i, j| rows[i][j])
}

/// Between samples a linear plant moves by the exponential of its matrix, however stiff it is; so with a delay, a limit, and
/// another phase of the sampling grid.
#[test]
fn a_linear_plant_moves_by_the_matrix_exponential() {
    for rate in [3.0, 1e3, 1e6] {
        let plant = linear(rate);
        for (delay, limit, phase) in
            [(0.0, None, 0.0), (0.013, None, 0.0), (0.02, Some(1.0), 0.007), (0.0, Some(0.8), 0.6)]
        {
            let mut sampled = sampled(&plant, "5", 3, "1/50", limit);
            sampled.converters = Converters { delay, ..Converters::default() };
            sampled.phase = phase;
            let start: Vec<f64> = [0.4, -0.3, 0.7].into_iter().chain(vec![0.0; sampled.dimension() - 3]).collect();
            let mut run = SampledRun::new(&sampled, 0, &start).unwrap();
            let mut stepper = Stepper::new(sampled.regulator.clone(), sampled.discrete.clone());
            let (first, second) = ((generator(rate) * delay).exp(), (generator(rate) * (0.02 - delay)).exp());
            let (mut exact, mut held, mut clipped) = (DVector::from_column_slice(&[0.4, -0.3, 0.7]), 0.0, 0);
            // Implicit steps take their time.
            let samples = if rate > 1e5 { 10 } else { 100 };
            for k in 0..samples {
                let u = stepper.step(exact[2]);
                clipped += usize::from(limit.is_some_and(|limit| u.abs() == limit));
                let angle = TAU * (phase + k as f64 / 50.0);
                let mut y = DVector::from_column_slice(&[exact[0], exact[1], exact[2], held, angle.cos(), angle.sin()]);
                y = &first * y;
                y[3] = u;
                y = &second * y;
                (exact, held) = (y.rows(0, 3).into_owned(), u);
                run.advance(1, Tolerance::TIGHT).unwrap();
                for (found, expected) in run.plant_state().iter().zip(exact.iter()) {
                    let off = (found - expected).abs();
                    assert!(off < 2e-10, "rate {rate} delay {delay} sample {k}: {found} {expected}");
                }
            }
            assert!(limit.is_none() || (2..=samples).contains(&clipped), "{clipped}");
        }
    }
}

/// As h tends to 0 the steady state tends to that of continuous time, with an error of the first order.
#[test]
fn short_samples_give_continuous_time() {
    let plant = example();
    let sigma = constant("5");
    let regulator = Design::new(&plant.internal_model, &sigma, 2).regulator();
    let closed_loop = ClosedLoop::new(&plant, regulator);
    let start = closed_loop.start_of(&plant.initial).unwrap();
    let steady = steady_state(&closed_loop, &start, &Silent).unwrap();
    let exact = SteadyFigures::new(&closed_loop, &steady, 4).unwrap();
    let settings = SampledSettings { periods: 1, samples: 1, harmonics: 4 };
    let errors: Vec<[f64; 3]> = ["1/100", "1/200", "1/400", "1/800"]
        .iter()
        .map(|step| {
            let sampled = sampled(&plant, "5", 2, step, None);
            let (steady_at_samples, sums) = simulate_sampled(&sampled, &start, &settings, &Silent).steady.unwrap();
            let slowest = steady_at_samples.multipliers.unwrap()[0] - steady.multipliers[0];
            // The energy has a part of second order that is larger here.
            assert!((sums.period.energy / exact.period.energy - 1.0).abs() < 2e-4);
            [sums.sup - exact.sup, sums.rms - exact.rms, slowest]
        })
        .collect();
    for pair in errors.windows(2) {
        for (coarse, fine) in pair[0].iter().zip(&pair[1]) {
            let ratio = coarse / fine;
            assert!((1.8..2.4).contains(&ratio), "{errors:?}");
        }
    }
    assert!(errors[3][0].abs() < 0.01 * exact.sup && errors[3][1].abs() < 0.01 * exact.rms, "{errors:?}");
}

/// The derivative of a period against difference quotients of periods, where nothing, a delay, or a limit is in the way.
#[test]
fn the_derivative_is_that_of_a_period() {
    let plant = example();
    for (delay, limit) in [(0.0, None), (0.03, None), (0.05, Some(3.0))] {
        let mut sampled = sampled(&plant, "3", 2, "1/20", limit);
        sampled.converters.delay = delay;
        let y: Vec<f64> = (0..sampled.dimension()).map(|i| 0.4 * (1.3 * i as f64).sin()).collect();
        let mut clipped = 0;
        let mut end = |y: &[f64]| {
            let mut run = SampledRun::new(&sampled, 0, y).unwrap();
            for _ in 0..20 {
                run.advance(1, Tolerance::TIGHT).unwrap();
                clipped += usize::from(limit.is_some_and(|limit| run.put_out().abs() == limit));
            }
            run.whole_state()
        };
        let derivative = period_derivative(&sampled, &y, 1e-5).unwrap().unwrap();
        for column in 0..y.len() {
            let shifted = |by: f64| y.iter().enumerate().map(|(i, v)| v + if i == column { by } else { 0.0 }).collect();
            let (up, down): (Vec<f64>, Vec<f64>) = (shifted(1e-5), shifted(-1e-5));
            let (up, down) = (end(&up), end(&down));
            for row in 0..y.len() {
                let quotient = (up[row] - down[row]) / 2e-5;
                assert!((derivative[(row, column)] - quotient).abs() < 1e-7, "{delay} {limit:?} {row} {column}");
            }
        }
        let most = 2 * 20 * y.len();
        assert!(limit.is_none() || (most / 20..most).contains(&clipped), "{clipped}");
        assert_eq!(period_derivative(&sampled, &y[2..], 1e-5).unwrap(), None);
        sampled.converters.measured = Some(0.1);
        assert_eq!(period_derivative(&sampled, &y, 1e-5).unwrap(), None);
    }
}

/// The steady state is that of a long run, and the multiplier the rate at which a run comes near it.
#[test]
fn a_long_run_comes_to_the_steady_state() {
    let plant = example();
    for delay in [0.0, 0.01] {
        let mut sampled = sampled(&plant, "4", 1, "1/50", None);
        sampled.converters.delay = delay;
        let mut start = vec![1.0, -2.0, 4.0];
        start.resize(sampled.dimension(), 0.0);
        let settings = SampledSettings { periods: 60, samples: 400, harmonics: 3 };
        let simulation = simulate_sampled(&sampled, &start, &settings, &Silent);
        assert!(!simulation.is_unstable());
        let ((steady, sums), run) = (simulation.steady.unwrap(), simulation.long.unwrap());
        assert!(steady.residual < 1e-13 && steady.uncertainty < 1e-7);
        let last = &run.last_period;
        // The largest |e| is between states, of which the run has fewer.
        let figures =
            [(sums.sup, last.sup, 1e-4), (sums.rms, last.rms, 1e-5), (sums.period.energy, last.period.energy, 1e-5)];
        for (a, b, allowed) in figures {
            assert!((a / b - 1.0).abs() < allowed, "{a} {b}");
        }
        assert!(sums.sup > sums.sup_at_samples && sums.amplitudes_at_samples[0] < 1e-14);
        let distances = &run.return_distances;
        let rate = (distances[25] / distances[10]).powf(1.0 / 15.0);
        let multiplier = steady.largest_multiplier().unwrap();
        // Other modes are nearly as slow.
        assert!((rate - multiplier).abs() < 0.05, "{rate} {multiplier}");
        assert_eq!(run.settled.map(|period| distances[period - 1] < 1e-5 && distances[period - 2] > 1e-6), Some(true));
        // Integrals of e over the pieces against those of a fine sum.
        let pieces = run.intervals[59 * 50..].iter().flat_map(|interval| &interval.pieces);
        let fine: f64 = pieces
            .flat_map(|piece| {
                piece.states.windows(2).map(|pair| 0.5 * piece.unit * (pair[0][2].powi(2) + pair[1][2].powi(2)))
            })
            .sum();
        assert!((fine.sqrt() / last.rms - 1.0).abs() < 1e-3, "{fine}");
    }
}

#[test]
fn an_unstable_loop_has_no_figures() {
    let plant = linear(3.0);
    let settings = SampledSettings { periods: 30, samples: 100, harmonics: 3 };
    // h sigma beyond 2; a delay of a whole sample with h sigma near 2; so many oscillators that samples confuse two.
    for (sigma, n_o, step, delay, escapes) in
        [("50", 1, "1/10", 0.0, true), ("19", 1, "1/10", 0.1, true), ("2", 2, "1/4", 0.0, false)]
    {
        let mut sampled = sampled(&plant, sigma, n_o, step, None);
        sampled.converters.delay = delay;
        let mut start = vec![0.1, 0.1, 0.1];
        start.resize(sampled.dimension(), 0.0);
        let simulation = simulate_sampled(&sampled, &start, &settings, &Silent);
        let error = simulation.steady.as_ref().err().unwrap();
        assert!(matches!(error, SampledSteadyError::Unstable { .. }) || error.is_escape(), "{sigma} {n_o}: {error}");
        assert!(!escapes || simulation.is_unstable(), "{sigma} {n_o}");
    }
    // The same with what quantises: no derivative says so, the run does.
    let mut sampled = sampled(&plant, "50", 1, "1/10", None);
    sampled.converters.measured = Some(1e-3);
    let start = vec![0.1; sampled.dimension()];
    assert!(simulate_sampled(&sampled, &start, &settings, &Silent).is_unstable());
    // An uneven number of samples has no period.
    let uneven = self::sampled(&plant, "5", 1, "3/100", None);
    let error = sampled_steady_state(&uneven, &vec![0.0; uneven.dimension()], &Silent).unwrap_err();
    assert!(matches!(error, SampledSteadyError::Uneven { samples } if (samples - 100.0 / 3.0).abs() < 1e-9));
}

/// What quantises stays near what does not, and u takes multiples of its quantum.
#[test]
fn quantised_loops_stay_near() {
    let plant = example();
    let settings = SampledSettings { periods: 40, samples: 100, harmonics: 3 };
    let run = |measured: Option<f64>, put_out: Option<f64>| {
        let mut sampled = sampled(&plant, "4", 1, "1/50", None);
        sampled.converters = Converters { measured, put_out, ..Converters::default() };
        let mut start = vec![1.0, -2.0, 4.0];
        start.resize(sampled.dimension(), 0.0);
        simulate_sampled(&sampled, &start, &settings, &Silent).long.unwrap()
    };
    let exact = run(None, None);
    for (measured, put_out) in [(Some(1e-3), None), (Some(1e-3), Some(0.01))] {
        let quantised = run(measured, put_out);
        let off = (quantised.last_period.rms / exact.last_period.rms - 1.0).abs();
        assert!(off > 1e-7 && off < 0.05, "{off}");
        if let Some(quantum) = put_out {
            for piece in quantised.intervals.iter().flat_map(|interval| &interval.pieces) {
                let multiple = piece.u / quantum;
                assert!((multiple - multiple.round()).abs() < 1e-9, "{}", piece.u);
            }
        }
    }
}
