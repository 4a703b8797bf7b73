//! The fixed-step loop beside the same loop in hand-written C (compiled here with gcc) and in NumPy.
//!
//! `cargo bench --bench simulate` in this folder prints the time of one step of each; nothing here is asserted but that all three
//! compute the same. Where gcc or NumPy is missing, its line is missing.

#![allow(clippy::disallowed_methods, reason = "what is compared need not be the same on every machine")]

use cpu_time::ProcessTime;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use sigmastar_lang::plant::Plant;
use sigmastar_regulator::Regulator;
use sigmastar_lab::simulate::{ClosedLoop, Disturbance, FixedStep};
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

const STEPS_PER_PERIOD: usize = 10_000;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn closed_loop() -> (ClosedLoop, Vec<f64>) {
    let text = include_str!("../specs/plants/paper-example.json");
    let plant = Plant::from_json("paper-example", text).expect("the shipped plant is valid");
    let weights = (0..5).map(|l| if l == 0 { 2.0 } else { f64::from(l).powf(-1.5) }).collect();
    let closed_loop = ClosedLoop::new(&plant, Regulator::new(2.0, 1.0, TAU, weights));
    let start = closed_loop.start(&plant.initial.x, plant.initial.e);
    (closed_loop, start)
}

/// Runs a loop of another language: seconds of processor time, and e at the end; `None` where it does not run here.
fn other(program: &Path, arguments: &[&str], steps: u64) -> Option<(f64, f64)> {
    let output = Command::new(program).args(arguments).arg(steps.to_string()).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    let (seconds, e) = text.trim().split_once(' ')?;
    Some((seconds.parse().ok()?, e.parse().ok()?))
}

fn compiled(folder: &Path) -> Option<PathBuf> {
    let program = folder.join("loop");
    let source = root().join("benches/loops/loop.c");
    let status = Command::new("gcc").args(["-O2", "-o"]).args([&program, &source]).arg("-lm").status().ok()?;
    status.success().then_some(program)
}

fn loops(criterion: &mut Criterion) {
    let (closed_loop, start) = closed_loop();
    let here = {
        let (mut method, mut y) = (FixedStep::new(&closed_loop, STEPS_PER_PERIOD), start.clone());
        (0..20_000).for_each(|step| method.step(step, &mut y, Disturbance::default()));
        y[closed_loop.states()]
    };
    let mut group = criterion.benchmark_group("one Runge-Kutta step of the paper example, n_o = 4");
    group.throughput(Throughput::Elements(1)).sample_size(20);
    group.bench_function("here", |bencher| {
        let (mut method, mut y, mut step) = (FixedStep::new(&closed_loop, STEPS_PER_PERIOD), start.clone(), 0);
        // Processor time, as the other loops measure it.
        bencher.iter_custom(|steps| {
            let start = ProcessTime::now();
            for _ in 0..steps {
                method.step(step, &mut y, Disturbance::default());
                step += 1;
            }
            start.elapsed()
        });
    });
    let folder = tempfile::tempdir().expect("a folder for the compiled loop");
    let script = root().join("benches/loops/loop.py");
    let script = script.to_str().expect("the path of the repository is text");
    let c = compiled(folder.path());
    let programs = [("C, gcc -O2", c.as_deref(), &[][..]), ("NumPy", Some(Path::new("python3")), &[script][..])];
    for (name, program, arguments) in programs {
        let Some(program) = program else { continue };
        let Some((_, e)) = other(program, arguments, 20_000) else { continue };
        assert!((e - here).abs() < 1e-9, "{name} computes another solution: {e} instead of {here}");
        group.bench_function(name, |bencher| {
            bencher.iter_custom(|steps| {
                let seconds = other(program, arguments, steps).map_or(0.0, |(seconds, _)| seconds);
                Duration::from_secs_f64(seconds)
            });
        });
    }
    group.finish();
}

criterion_group!(benches, loops);
criterion_main!(benches);
