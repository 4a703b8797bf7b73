//! The exported C of the law at samples in closed loop with the paper's plant, which an accurate integrator moves between the
//! samples: from the boundary of the certified set every bound of the claim holds, for few and for the most oscillators.

use crate::controller::installed;
use crate::controller_c::gcc;
use crate::sampled::at_samples;
use crate::sampled_falsify::{CERTIFICATE, DELAYED, SAMPLES};
use crate::support::{PLANT_TEXT, json, program, specification_text};
use sigmastar_document::progress::Silent;
use sigmastar_lab::simulate::{Piece, SampledLoop, SampledRun, Tolerance, sampled_steady_state};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Constant, Document};
use sigmastar_prove::certificate::read_claim;
use sigmastar_regulator::{Design, Regulator};
use sigmastar_theory::data::Data;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

/// Periods from the boundary of the set, and states in a sampling interval.
const PERIODS: usize = 6;
const UNITS: usize = 4;

/// Reads z and then an error a line, in bits; answers with the control and z.
const MAIN: &str = r#"#include "law.h"
#include <stdio.h>
#include <string.h>

static void put(double value)
{
    unsigned long long bits;

    memcpy(&bits, &value, sizeof bits);
    printf("%llx ", bits);
}

static int get(double *value)
{
    unsigned long long bits;

    if (scanf("%llx", &bits) != 1) {
        return 0;
    }
    memcpy(value, &bits, sizeof bits);
    return 1;
}

int main(void)
{
    sigmastar_controller controller;
    double e;
    int i;

    sigmastar_reset(&controller);
    for (i = 0; i < SIGMASTAR_STATES; i++) {
        if (!get(&controller.z[i])) {
            return 1;
        }
    }
#ifdef SIGMASTAR_DELAY_SAMPLES
    if (!get(&controller.ahead)) {
        return 1;
    }
#endif
    while (get(&e)) {
        put(sigmastar_step(&controller, e));
        for (i = 0; i < SIGMASTAR_STATES; i++) {
            put(controller.z[i]);
        }
#ifdef SIGMASTAR_DELAY_SAMPLES
        put(controller.ahead);
#endif
        printf("\n");
        fflush(stdout);
    }
    return 0;
}
"#;

/// The C code at work.
struct Exported {
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    z: Vec<f64>,
}

impl Exported {
    fn new(program: &Path, z: &[f64]) -> Exported {
        let mut child = Command::new(program).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
        let (input, output) = (child.stdin.take().unwrap(), BufReader::new(child.stdout.take().unwrap()));
        let mut exported = Exported { child, input, output, z: z.to_vec() };
        z.iter().for_each(|value| writeln!(exported.input, "{:x}", value.to_bits()).unwrap());
        exported
    }

    fn step(&mut self, e: f64) -> f64 {
        writeln!(self.input, "{:x}", e.to_bits()).unwrap();
        let mut line = String::new();
        self.output.read_line(&mut line).unwrap();
        let numbers: Vec<f64> =
            line.split_whitespace().map(|word| f64::from_bits(u64::from_str_radix(word, 16).unwrap())).collect();
        self.z = numbers[1..].to_vec();
        numbers[0]
    }
}

impl Drop for Exported {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The loop over some periods: at each sample zeta, and the plant after it.
fn run(sampled: &SampledLoop, program: &Path, start: &[f64], periods: usize) -> Vec<(Vec<f64>, Piece)> {
    run_measured(sampled, program, start, periods, |_, e| e)
}

/// The same with a converter before the C code.
fn run_measured(
    sampled: &SampledLoop,
    program: &Path,
    start: &[f64],
    periods: usize,
    measured: impl Fn(usize, f64) -> f64,
) -> Vec<(Vec<f64>, Piece)> {
    let n = sampled.states();
    let mut exported = Exported::new(program, &start[n + 1..][..sampled.discrete.dimension()]);
    let mut run = SampledRun::new(sampled, 0, start).unwrap();
    let m = sampled.regulator.m();
    let mut intervals = Vec::new();
    for index in 0..periods * sampled.samples().unwrap() {
        let e = run.plant_state()[n];
        let zeta = exported.z.iter().zip(&m).map(|(z, m)| z - m * e).collect();
        let u = exported.step(measured(index, e));
        let mut pieces = run.advance_with(u, UNITS, Tolerance::TIGHT).unwrap();
        intervals.push((zeta, pieces.remove(0)));
    }
    intervals
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}

/// The C code of the certificate, whose header says that it is about this law, and what it does not cover.
fn export(folder: &Path, (certificate, says): (&Path, [&str; 2]), sigma: &Constant, n_o: u32) -> std::path::PathBuf {
    let (source, main, binary) = (folder.join("law.c"), folder.join("main.c"), folder.join("law"));
    let (n_o, step) = (n_o.to_string(), format!("1/{SAMPLES}"));
    let arguments =
        ["--sigma", &sigma.text, "--n-o", &n_o, "--discretise", &step, "--format", "c", "--example", "--force", "-o"];
    program().arg("controller").arg(certificate).args(arguments).arg(&source).assert().success();
    let header = std::fs::read_to_string(source.with_extension("h")).unwrap();
    let header = header.split_whitespace().filter(|word| *word != "*").collect::<Vec<_>>().join(" ");
    for words in ["The claim is about this law at samples"].into_iter().chain(says) {
        assert!(header.contains(words), "{header}");
    }
    std::fs::write(&main, MAIN).unwrap();
    for other in [&main, &folder.join("law_example.c")] {
        gcc(&[&source, other], &binary);
        if other == &main {
            std::fs::copy(&binary, folder.join("loop")).unwrap();
        }
    }
    folder.join("loop")
}

/// A point of the boundary: |x| = X0, |e| = E0, |z|_N = Z0.
fn boundary(regulator: &Regulator, [x_0, e_0, z_0]: [f64; 3], sign: f64) -> Vec<f64> {
    let mut z: Vec<f64> = (0..regulator.dimension()).map(|i| (1.7 * i as f64 + sign).sin()).collect();
    let size = regulator.weighted_norm(&z);
    z.iter_mut().for_each(|part| *part *= z_0 / size);
    [0.6 * x_0, -0.8 * x_0, sign * e_0].into_iter().chain(z).collect()
}

/// x_0 over a period from the phase on: the states of x' = f(t, x, 0), which attract, in the places of [`run`].
fn at_rest(sampled: &SampledLoop) -> Vec<Vec<[f64; 2]>> {
    let mut document: serde_json::Value = serde_json::from_str(PLANT_TEXT).unwrap();
    document["q"] = "0".into();
    let plant = Plant::from_json("at rest", &document.to_string()).unwrap();
    let mut resting = SampledLoop::new(&plant, sampled.regulator.clone(), sampled.discrete.clone());
    resting.phase = sampled.phase;
    let sampled = resting;
    let mut run = SampledRun::new(&sampled, 0, &vec![0.0; sampled.dimension()]).unwrap();
    let samples = sampled.samples().unwrap();
    for _ in 0..60 * samples {
        run.advance_with(0.0, 1, Tolerance::TIGHT).unwrap();
    }
    let piece = |run: &mut SampledRun<'_>| run.advance_with(0.0, UNITS, Tolerance::TIGHT).unwrap().remove(0);
    (0..samples).map(|_| piece(&mut run).states.iter().map(|y| [y[0], y[1]]).collect()).collect()
}

#[test]
fn the_exported_c_keeps_every_bound_of_the_claim() {
    keeps_every_bound(&CERTIFICATE);
}

#[test]
fn the_exported_c_with_a_delay_keeps_every_bound_of_the_claim() {
    keeps_every_bound(&DELAYED);
}

fn keeps_every_bound(stated: &serde_json::Value) {
    if !installed("gcc", &["--version"]) {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let certificate = folder.path().join("certificate.json");
    std::fs::write(&certificate, stated.to_string()).unwrap();
    let claim = read_claim(&Document::parse("certificate", &stated.to_string()).unwrap()).unwrap();
    let (witness, plant) = (at_samples(&claim), Plant::from_json("paper-example", PLANT_TEXT).unwrap());
    let data = Data::new(&claim.spec, 128);
    let (w_x, eta) = (witness.w_x.to_f64(), witness.eta.to_f64());
    let [low, up] = [w_x * data.p_low.lower_f64(), w_x * data.p_up.upper_f64()];
    let (d_x, d_e) = (witness.d_x.to_f64(), witness.d_e.to_f64());
    let z_0 = witness.set.z0.as_ref().expect("a set that does not start with z = M e");
    let set = [&witness.set.x0, &witness.set.e0, z_0].map(rug::Rational::to_f64);
    let sigma = Constant::rational(&witness.sigma);
    let delay = if witness.delay.is_some() { "put out at the sample k + 1" } else { "a delay" };
    let says = ["No claim covers the rounding", delay];
    for (n_o, phase) in [(0, 0.0), (1, 0.37), (5, 0.0), (20, 0.9), (SAMPLES / 2 - 1, 0.123)] {
        let program = export(folder.path(), (&certificate, says), &sigma, n_o);
        let design = Design::new(&claim.spec.internal_model, &sigma, n_o);
        let discrete = design.discretise(&witness.sampling.step).unwrap();
        assert_eq!(rug::Rational::from_f64(discrete.gain), Some(witness.law.gain.clone()), "the K of the claim");
        let mut sampled = SampledLoop::new(&plant, design.regulator(), discrete);
        sampled.phase = phase;
        let regulator = sampled.regulator.clone();
        // The periodic solution, and the C code on it.
        let rest = vec![0.0; sampled.dimension()];
        let steady = sampled_steady_state(&sampled, &rest, &Silent).unwrap();
        assert!(steady.largest_multiplier().unwrap() < 1.0);
        let orbit = run(&sampled, &program, &steady.start, 1);
        // The x of the specification is the one of the plant file less x_0(t).
        let x_0 = at_rest(&sampled);
        let states = || orbit.iter().flat_map(|(_, piece)| &piece.states);
        let last = orbit.last().unwrap().1.states.last().unwrap();
        assert!(last.iter().zip(&steady.start).all(|(a, b)| (a - b).abs() < 1e-10), "n_o = {n_o}");
        let x = states()
            .zip(x_0.iter().flatten())
            .fold(0.0, |most: f64, (y, x_0)| most.max(norm(&[y[0] - x_0[0], y[1] - x_0[1]])));
        let e = states().fold(0.0, |most: f64, y| most.max(y[2].abs()));
        let zeta = orbit.iter().fold(0.0, |most: f64, (zeta, _)| most.max(regulator.weighted_norm(zeta)));
        let [by_x, by_e, by_zeta, _] = claim.periodic;
        assert!(x <= by_x && e <= by_e && zeta <= by_zeta, "n_o = {n_o}: {x} {e} {zeta} {:?}", claim.periodic);
        for sign in [1.0, -1.0] {
            let mut start = boundary(&regulator, set, sign);
            (start[0], start[1]) = (start[0] + x_0[0][0][0], start[1] + x_0[0][0][1]);
            let start = sampled.starting(start, false);
            // What y of the last sample stores, where nothing is predicted yet.
            let stored = witness.delay.as_ref().map_or(0.0, |delay| {
                // s is -h sigma et, and e - et is h y.
                let [e, ahead] = [steady.start[2], steady.start[3 + regulator.dimension()]];
                let of_orbit = e + ahead / (sampled.step() * sampled.regulator.sigma);
                let off = start[2] - of_orbit;
                delay.gm.to_f64() / sampled.step() * off * off
            });
            let (mut level, mut away, mut distances) = (0.0, [0.0_f64; 2], Vec::new());
            for (index, (zeta, piece)) in run(&sampled, &program, &start, PERIODS).iter().enumerate() {
                let (of_orbit, point) = &orbit[index % orbit.len()];
                let zeta: Vec<f64> = zeta.iter().zip(of_orbit).map(|(a, b)| a - b).collect();
                let energy = eta * regulator.weighted_norm(&zeta).powi(2);
                for (at, (y, point)) in piece.states.iter().zip(&point.states).enumerate() {
                    let x = norm(&[y[0] - point[0], y[1] - point[1]]);
                    let e = y[2] - point[2];
                    away = [away[0].max(x), away[1].max(e.abs())];
                    // The Lyapunov function at samples, and what it has of x and e between them.
                    let rest = e * e + if at == 0 { energy } else { 0.0 };
                    if index + at == 0 {
                        level = up * x * x + rest + stored;
                    }
                    assert!(low * x * x + rest <= level * (1.0 + 1e-9), "n_o = {n_o}, sample {index}");
                }
                distances.push(
                    piece.states[0].iter().zip(&point.states[0]).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs())),
                );
            }
            assert!(away[0] <= d_x && away[1] <= d_e, "n_o = {n_o}: {away:?} {d_x} {d_e}");
            assert!(distances[distances.len() - 1] < 0.5 * distances[0], "n_o = {n_o}");
        }
    }
}

/// Behind a converter of 12 bits the C code keeps the bounds that are claimed of it: from the periodic solution that of the limit, from the boundary
/// of the set that of all times.
#[test]
fn the_exported_c_behind_a_converter_of_12_bits() {
    if !installed("gcc", &["--version"]) {
        return;
    }
    // From -2 to 2.
    const QUANTUM: f64 = 4.0 / 4096.0;
    let folder = tempfile::tempdir().unwrap();
    let (file, certificate) = (folder.path().join("spec.json"), folder.path().join("certificate.json"));
    let mut document = json(specification_text("paper-example-rms-at-rest").as_bytes());
    document["measurement"] = serde_json::json!({ "quantum": "1/1024", "noise": "1/2048" });
    document["arithmetic"] = "double".into();
    std::fs::write(&file, document.to_string()).unwrap();
    let step = format!("1/{SAMPLES}");
    let call = ["--sampling-period", &step, "--sigma", "30", "--n-o", "0,4,10", "--no-alternatives", "--quiet", "-o"];
    program().arg("certify").arg(&file).args(call).arg(&certificate).assert().success();
    let text = std::fs::read_to_string(&certificate).unwrap();
    let stated = json(text.as_bytes());
    let claim = read_claim(&Document::parse("certificate", &text).unwrap()).unwrap();
    let (witness, plant) = (at_samples(&claim), Plant::from_json("paper-example", PLANT_TEXT).unwrap());
    let sigma = Constant::rational(&witness.sigma);
    let set = [&witness.set.x0, &witness.set.e0].map(rug::Rational::to_f64);
    for (entry, n_o) in stated["claim"]["for_n_o"].as_array().unwrap().iter().zip([0, 4, 10]) {
        assert_eq!(entry["n_o"], n_o);
        let [limit, peak] =
            ["limit", "peak"].map(|part| entry["noise"][part].as_str().unwrap().parse::<f64>().unwrap());
        let program =
            export(folder.path(), (&certificate, ["computed in double precision as exported", "a delay"]), &sigma, n_o);
        let design = Design::new(&claim.spec.internal_model, &sigma, n_o);
        let discrete = design.discretise(&witness.sampling.step).unwrap();
        let sampled = SampledLoop::new(&plant, design.regulator(), discrete);
        let steady = sampled_steady_state(&sampled, &vec![0.0; sampled.dimension()], &Silent).unwrap();
        let orbit = run(&sampled, &program, &steady.start, 1);
        // The noise changes its sign every ten periods: the integrator of the regulator follows it.
        let noise = |index: usize| {
            if (index / (10 * SAMPLES as usize)).is_multiple_of(2) { QUANTUM / 2.0 } else { -QUANTUM / 2.0 }
        };
        let measured = |index: usize, e: f64| QUANTUM * ((e + noise(index)) / QUANTUM).round();
        let furthest = |start: &[f64], periods: usize| {
            let run = run_measured(&sampled, &program, start, periods, measured);
            let errors = run.iter().zip(orbit.iter().cycle()).flat_map(|((_, piece), (_, point))| {
                piece.states.iter().zip(&point.states).map(|(y, point)| (y[2] - point[2]).abs())
            });
            errors.fold(0.0, f64::max)
        };
        let found = furthest(&steady.start, 30);
        assert!(found <= limit && found > 0.01 * limit, "n_o = {n_o}: {found} {limit}");
        let x_0 = at_rest(&sampled)[0][0];
        let z = vec![0.0; sampled.regulator.dimension()];
        let start = [0.6 * set[0] + x_0[0], -0.8 * set[0] + x_0[1], set[1]].into_iter().chain(z).collect();
        let found = furthest(&sampled.starting(start, false), PERIODS);
        assert!(found <= peak && found > 0.05 * peak, "n_o = {n_o}: {found} {peak}");
    }
}
