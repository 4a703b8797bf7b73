//! Rates for given n_o of plants whose stability is proved by (M) or (Jm) (docs/mathematics.md, 13.6, Propositions R_D and R_P): against the loops themselves.

use super::rates_of_claims::{shares, step};
use crate::support::{every, json, number, program, read};
use serde_json::Value;

/// A plant, 1.5 sigma*, and its period in floating point.
type Case = (&'static str, &'static str, f64);

const PLANTS: [Case; 2] = [
    ("motor-axis", "22.5783", 0.02),
    // (M) on a path with a corner: Proposition R_P.
    ("paper-example", "9.06723", 1.0),
];

/// Those of the search tier.
const MORE: [Case; 3] = [
    ("pendulum", "0.670455", 1.0),
    ("relative-degree-2", "1.509495", 1.0),
    ("relative-degree-2-domain", "3.85647", 1.0),
];

/// Those of a night.
const ALL: [Case; 6] = [
    ("chain", "3.50382", 1.0),
    ("converter", "1316.8455", 0.02),
    ("duffing", "0.488922", 2.0),
    ("paper-example-ball", "37.2858", 1.0),
    ("paper-example-paper-set", "15.9531", 1.0),
    ("paper-example-rotated", "9.085455", 1.0),
];

fn answer(arguments: &[&str]) -> Value {
    json(&program().args(arguments).args(["--format", "json"]).output().expect("it runs").stdout)
}

/// By the median at least 0.3 of the rate at which the loop returns to its periodic solution, and never more than it.
fn assert_near_those_of_the_linearised_loops(plants: &[Case], counts: &str) {
    let mut shares: Vec<(f64, String)> = Vec::new();
    for (name, sigma, period) in plants.iter().copied() {
        let file = format!("specs/plants/{name}.json");
        let report = answer(&["certify", &file, "--sigma", sigma, "--no-alternatives", "--n-o", counts]);
        assert_eq!(report["verdict"], "certified", "{name}");
        let e_0 = number(&report["initial_set"]["E0"]);
        for rate in report["for_n_o"].as_array().expect("asked for") {
            let n_o = rate["n_o"].to_string();
            let simulated = answer(&["simulate", &file, "--sigma", sigma, "--n-o", &n_o]);
            let multiplier = simulated["steady_state"]["multipliers"][0].as_f64().expect("a multiplier");
            // What is not proved counts as 0.
            let share = if rate["rate"].is_null() { 0.0 } else { number(&rate["rate"]) / (-multiplier.ln() / period) };
            assert!(share <= 1.0 + 1e-6, "{name} {n_o}: {share}");
            assert!(share == 0.0 || number(&rate["factor"]) >= e_0, "{name} {n_o}");
            println!("{name} {n_o}: {share:.3}");
            shares.push((share, format!("{name} {n_o}")));
        }
    }
    shares.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert!(shares[shares.len() / 2].0 >= 0.3, "{shares:?}");
}

#[test]
fn rates_are_near_those_of_the_linearised_loops() {
    assert_near_those_of_the_linearised_loops(&PLANTS, "0,4");
}

#[test]
#[ignore = "search tier"]
fn rates_of_all_plants_are_near_those_of_the_linearised_loops() {
    let (plants, counts) = if every(2) == 1 {
        ([&PLANTS[..], &MORE, &ALL].concat(), "0,1,4,10")
    } else {
        ([&PLANTS[..], &MORE].concat(), "0,1,4")
    };
    assert_near_those_of_the_linearised_loops(&plants, counts);
}

/// `(theta, omega, e, z)'` of `specs/plants/pendulum.json` with n_o = 1.
fn pendulum(sigma: f64, time: f64, [theta, omega, e, z0, z1, z2]: [f64; 6]) -> [f64; 6] {
    let turn = std::f64::consts::TAU;
    let q = theta + e / 4.0 + (turn * time).cos() + (2.0 * turn * time).cos() / 3.0;
    let s = 2.0 * (z0 - e) + (z1 - e);
    // Gamma = -(Phi + sigma) M.
    [
        omega,
        -9.0 * theta.sin() - 2.0 * omega + e + (turn * time).sin() / 2.0,
        q - sigma * e + s,
        -sigma * e,
        turn * z2 - sigma * e,
        -turn * z1 + turn * e,
    ]
}

/// Solutions from e on the edge of the set stay below factor exp(-rate t), for 40 periods.
#[test]
fn solutions_decay_as_it_is_claimed() {
    const STEPS: usize = 500;
    let report =
        answer(&["certify", "specs/plants/pendulum.json", "--sigma", "0.8", "--n-o", "1", "--no-alternatives"]);
    let rate = &report["for_n_o"][0];
    let (rate, factor) = (number(&rate["rate"]), number(&rate["factor"]));
    let e_0 = number(&report["initial_set"]["E0"]);
    // The orbit without a regulator and an error, where the set is.
    let field = |time, state| pendulum(0.8, time, state);
    let mut orbit = [0.0; 6];
    for i in 0..60 * STEPS {
        let start = [orbit[0], orbit[1], 0.0, 0.0, 0.0, 0.0];
        orbit = step(&field, (i % STEPS) as f64 / STEPS as f64, 1.0 / STEPS as f64, start);
    }
    let starts = [e_0, -e_0].map(|e| [orbit[0], orbit[1], 0.999 * e, 0.0, 0.0, 0.0]);
    let found = shares(&field, [STEPS, 200], [rate, factor], &starts);
    assert!(found.iter().all(|share| *share <= 1.0 && *share > 1e-4), "{found:?}");
}

/// What proves it is in the certificate, in its shape; a witness that is decided again has rates as well.
#[test]
fn the_certificate_has_the_slopes() {
    let folder = tempfile::tempdir().expect("a folder");
    let [first, again] = ["first.json", "again.json"].map(|name| folder.path().join(name).display().to_string());
    let plant = "specs/plants/motor-axis.json";
    let run = |arguments: &[&str]| program().args(arguments).output().expect("it runs").status.code();
    assert_eq!(run(&["certify", plant, "--sigma", "23", "--n-o", "2,0", "-o", &first, "--no-alternatives"]), Some(0));
    assert_eq!(
        run(&["certify", plant, "--witness", &first, "--n-o", "0,2", "-o", &again, "--no-alternatives"]),
        Some(0)
    );
    let (first, again) = (read(&first), read(&again));
    assert_eq!(first["claim"], again["claim"]);
    assert_eq!(first["witness"], again["witness"]);
    let witness = &first["witness"]["for_n_o"][1];
    // n = 1, n_o = 2.
    let length = |value: &Value| value.as_array().map(Vec::len);
    assert_eq!((length(&witness["Pi"]), length(&witness["Pi"][6])), (Some(7), Some(7)));
    let slopes = ["Q", "G", "H"].map(|name| [0, 1].map(|row| length(&witness["slopes"][name][row])));
    assert_eq!(slopes, [[Some(1), Some(2)], [Some(2), Some(2)], [Some(1), Some(2)]]);
    assert!(witness["x_up"].is_string() && witness.get("w").is_none() && witness.get("l").is_none());
    let statement = first["claim"]["statement"].as_str().expect("words");
    assert!(statement.contains("With n_o = 2 and sigma = 23 exactly, |e(t) - e_per(t)| <= "), "{statement}");
}
