//! Steady states of the paper's example against an independent simulator and against long simulations.

use crate::support::PLANT_TEXT;
use sigmastar_document::progress::Silent;
use sigmastar_lab::simulate::{
    ClosedLoop, Disturbance, FixedStep, SteadyFigures, SteadyState, SteadyStateError, Tolerance, flow, steady_state,
    trajectory,
};
use sigmastar_lang::plant::Plant;
use sigmastar_regulator::Regulator;
use std::f64::consts::TAU;

fn example() -> Plant {
    Plant::from_json("paper-example", PLANT_TEXT).unwrap()
}

fn regulator(n_0: f64, n_o: u32, base_frequency: f64) -> Regulator {
    let weights = (0..=n_o).map(|l| if l == 0 { n_0 } else { f64::from(l).powf(-1.5) }).collect();
    Regulator::new(2.0, 1.0, base_frequency, weights)
}

fn steady(regulator: Regulator) -> (ClosedLoop, SteadyState, SteadyFigures) {
    let plant = example();
    let closed_loop = ClosedLoop::new(&plant, regulator);
    let start = closed_loop.start(&plant.initial.x, plant.initial.e);
    let steady = steady_state(&closed_loop, &start, &Silent).unwrap();
    let figures = SteadyFigures::new(&closed_loop, &steady, 12).unwrap();
    (closed_loop, steady, figures)
}

/// Agreement to the digits of the reference, which has five.
fn agrees(value: f64, reference: f64) -> bool {
    (value / reference - 1.0).abs() < 6e-5
}

#[test]
fn the_reference_values_are_met() {
    let golden = TAU * (1.0 + 5.0_f64.sqrt()) / 2.0;
    for (n_o, w, of_one, of_two) in [
        (0, TAU, [0.30738, 0.17774], [0.30793, 0.17191]),
        (1, TAU, [0.091740, 0.054919], [0.090917, 0.054012]),
        (2, TAU, [0.017783, 0.0098630], [0.017676, 0.0097812]),
        (3, TAU, [0.0049350, 0.0034815], [0.0049083, 0.0034627]),
        (4, TAU, [3.0395e-8, 1.6610e-8], [3.0263e-8, 1.6552e-8]),
        (3, 0.99 * TAU, [0.083716, 0.036937], [0.081561, 0.035862]),
        (3, 0.95 * TAU, [0.20407, 0.098215], [0.19415, 0.092785]),
        (3, golden, [0.29291, 0.17898], [0.29944, 0.17525]),
    ] {
        for (n_0, [sup, rms]) in [(1.0, of_one), (2.0, of_two)] {
            let (_, state, figures) = steady(regulator(n_0, n_o, w));
            assert!(
                agrees(figures.sup, sup) && agrees(figures.rms, rms),
                "{n_o} {w} {n_0}: {} {}",
                figures.sup,
                figures.rms
            );
            assert!(state.residual <= 1e-13, "{n_o} {w} {n_0}: {}", state.residual);
            assert!(state.multipliers[0] < 1.0, "{n_o} {w} {n_0}: {}", state.multipliers[0]);
            if w == TAU {
                // The oscillators block their harmonics, up to rounding.
                let blocked = &figures.amplitudes[..=n_o as usize];
                assert!(blocked.iter().all(|amplitude| *amplitude < 1e-14), "{n_o} {n_0}: {blocked:?}");
            }
            if (n_o, n_0, w) == (2, 2.0, TAU) {
                for (k, reference) in [(3, 6.4661e-3), (4, 2.4547e-3), (5, 1.0632e-5)] {
                    assert!(agrees(figures.amplitudes[k], reference), "{k}: {}", figures.amplitudes[k]);
                }
            }
            if (n_o, n_0) == (4, 2.0) {
                assert!((state.multipliers[0] - 0.940).abs() < 1e-3, "{}", state.multipliers[0]);
            }
        }
    }
}

#[test]
fn the_high_gain_feedback_too() {
    for (sigma, sup, rms) in [
        (2.0, 1.2555, 0.96574),
        (5.0, 0.65766, 0.40825),
        (10.0, 0.40002, 0.21656),
        (20.0, 0.22480, 0.11262),
        (40.0, 0.11807, 0.057220),
    ] {
        let (_, _, figures) = steady(Regulator::high_gain(sigma));
        assert!(agrees(figures.sup, sup) && agrees(figures.rms, rms), "{sigma}: {} {}", figures.sup, figures.rms);
    }
}

#[test]
fn the_two_methods_arrive_at_the_steady_state() {
    let (closed_loop, steady, _) = steady(regulator(2.0, 1, TAU));
    let plant = example();
    let start = closed_loop.start(&plant.initial.x, plant.initial.e);
    let adaptive = flow(&closed_loop, 0.0, 60.0, &start, Tolerance::ORDINARY).unwrap();
    let mut fixed = FixedStep::new(&closed_loop, 2000);
    let mut y = start;
    (0..60 * 2000).for_each(|step| fixed.step(step, &mut y, Disturbance::default()));
    for ((adaptive, fixed), exact) in adaptive.iter().zip(&y).zip(&steady.start) {
        assert!((adaptive - exact).abs() < 1e-6 && (fixed - exact).abs() < 1e-6, "{adaptive} {fixed} {exact}");
    }
}

#[test]
fn samples_between_steps_are_as_good_as_steps() {
    let (closed_loop, steady, _) = steady(regulator(2.0, 2, TAU));
    let samples = trajectory(&closed_loop, 0.0, 1.0, 4096, &steady.start, Tolerance::TIGHT).unwrap();
    assert_eq!(samples.len(), 4097);
    for at in [1, 517, 1023, 2049, 3001, 4095, 4096] {
        let exact = flow(&closed_loop, 0.0, at as f64 / 4096.0, &steady.start, Tolerance::TIGHT).unwrap();
        let error = exact.iter().zip(&samples[at]).fold(0.0, |largest: f64, (a, b)| largest.max((a - b).abs()));
        assert!(error < 2e-13, "{at}: {error}");
    }
}

/// The end of a trajectory is where the next one starts: as good as any other sample, also where the steps are much
/// shorter than the samples are apart.
#[test]
fn the_last_sample_is_integrated_and_not_extrapolated() {
    let plant = example();
    let closed_loop = ClosedLoop::new(&plant, Regulator { sigma: 500.0, ..regulator(2.0, 2, TAU) });
    let start = closed_loop.start(&plant.initial.x, plant.initial.e);
    for (samples, duration) in [(5, 1.0), (20, 1.0), (200, 1.0), (3, 1e-10), (200, 1e-9)] {
        let sampled = trajectory(&closed_loop, 0.0, duration, samples, &start, Tolerance::ORDINARY).unwrap();
        assert_eq!(sampled.len(), samples + 1);
        let exact = flow(&closed_loop, 0.0, duration, &start, Tolerance::ORDINARY).unwrap();
        let error = exact.iter().zip(&sampled[samples]).fold(0.0, |largest: f64, (a, b)| largest.max((a - b).abs()));
        assert!(error < 1e-7, "{samples} {duration}: {error}");
    }
}

#[test]
fn the_fixed_step_has_order_four() {
    let (closed_loop, ..) = steady(regulator(2.0, 2, TAU));
    let start = closed_loop.start(&[0.3, -0.2], 0.5);
    let exact = flow(&closed_loop, 0.0, 1.0, &start, Tolerance::TIGHT).unwrap();
    let error = |steps: usize| {
        let (mut fixed, mut y) = (FixedStep::new(&closed_loop, steps), start.clone());
        (0..steps).for_each(|step| fixed.step(step, &mut y, Disturbance::default()));
        y.iter().zip(&exact).fold(0.0, |largest: f64, (a, b)| largest.max((a - b).abs()))
    };
    let ratio = error(100) / error(200);
    assert!((14.0..18.0).contains(&ratio), "{ratio}");
}

#[test]
fn escaping_solutions_and_missing_steady_states_are_told() {
    let text = |q: &str, f: &str| {
        format!(
            r#"{{"format": "sigmastar/plant", "version": 1, "name": "n", "period": 1, "states": ["x1"], "f": ["{f}"],
            "q": "{q}", "initial": {{"x": [3], "e": 0}}, "internal_model": {{"mu": 1, "base_frequency": "2*pi",
            "weights": {{"family": "power", "n0": 2, "epsilon": 1}}}}}}"#
        )
    };
    let run = |text: &str| {
        let plant = Plant::from_json("test", text).unwrap_or_else(|errors| panic!("{errors}"));
        let closed_loop = ClosedLoop::new(&plant, Regulator::high_gain(1.0));
        steady_state(&closed_loop, &closed_loop.start(&plant.initial.x, plant.initial.e), &Silent)
    };
    assert!(matches!(run(&text("0", "-x1 + x1^2")), Err(SteadyStateError::Integration(_))));
    assert!(matches!(run(&text("sqrt(x1 - 10)", "-x1")), Err(SteadyStateError::Integration(_))));
    assert!(run(&text("cos(2*pi*t)", "-x1")).is_ok());
}

/// A slow level whose rate grows exponentially: from below, a whole step of Newton's method leads to where no period can be
/// integrated. Damped, it arrives.
#[test]
fn a_step_that_leads_too_far_is_cut() {
    let text = r#"{"format": "sigmastar/plant", "version": 1, "name": "level", "period": 60, "states": ["h"],
        "f": ["(1 - exp((h - 900)/5))/500"], "q": "e/20 + (h - 900)/100000 + sin(2*pi*t/60) + sin(4*pi*t/60)/2",
        "internal_model": {"mu": "1/100", "base_frequency": "2*pi/60",
        "weights": {"family": "power", "n0": 2, "epsilon": "1/2"}}}"#;
    let plant = Plant::from_json("level", text).unwrap();
    let regulator = Regulator::new(2.0, 0.01, std::f64::consts::TAU / 60.0, vec![2.0, 1.0]);
    let closed_loop = ClosedLoop::new(&plant, regulator);
    let steady = steady_state(&closed_loop, &closed_loop.start(&[850.0], 10.0), &Silent).unwrap();
    assert!((steady.start[0] - 900.0).abs() < 1e-6, "{steady:?}");
    assert!((steady.multipliers[0] - (-60.0_f64 / 2500.0).exp()).abs() < 1e-6, "{steady:?}");
}

/// Where the run stays within bounds and there is no periodic solution, that is told, and no larger gain is advised; where the
/// run itself escapes, one may help.
#[test]
fn a_failing_search_is_not_called_an_escape() {
    let failure = |f: &str| {
        let text = format!(
            r#"{{"format": "sigmastar/plant", "version": 1, "name": "n", "period": 1, "states": ["x1"], "f": ["{f}"],
            "q": "0", "internal_model": {{"mu": 1, "base_frequency": "2*pi",
            "weights": {{"family": "power", "n0": 2, "epsilon": 1}}}}}}"#
        );
        let closed_loop = ClosedLoop::new(&Plant::from_json("test", &text).unwrap(), Regulator::high_gain(1.0));
        steady_state(&closed_loop, &closed_loop.start(&[1.0], 0.0), &Silent).unwrap_err()
    };
    let drift = failure("1");
    assert!(matches!(drift, SteadyStateError::Newton { periods: 130, .. }), "{drift}");
    assert!(drift.to_string().contains("the run stays within bounds"), "{drift}");
    let way_out = drift.way_out("--fixed");
    assert!(way_out.contains("`initial`") && !way_out.contains("gain"), "{way_out}");
    let escape = failure("x1^2");
    assert!(matches!(escape, SteadyStateError::Integration(_)), "{escape}");
    assert!(escape.way_out("--fixed").contains("gain"));
}
