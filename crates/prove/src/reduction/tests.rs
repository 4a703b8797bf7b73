//! The values in certificates of the shipped plants, against random points.

#[path = "../../../plants/src/bounds/tests/random_points.rs"]
mod random_points;

use super::{Stage, Unwatched, Watch, bounds_around, reduce};
use random_points::random_points;
use rayon::prelude::*;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::ProvedValue;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A value may exceed what random points reach by this part of it; one of the error box beside a matrix inequality, which no
/// condition uses, by as much as a proof tries.
const SLACK: f64 = 0.05;
const SLACK_BESIDE: f64 = 0.11;

/// What no relative comparison can see: q_tx and q_te where they vanish but for the radius of the orbit.
const NOTHING: f64 = 1e-5;

/// No value is below what 20,000 points reach (with `SIGMASTAR_CASES=all` 100,000, and of every plant), and none is more than 5 % above, but for those
/// that vanish on the orbit, and those that no condition uses.
#[test]
fn values_are_above_random_points_and_near_them() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../specs/plants");
    let all = std::env::var_os("SIGMASTAR_CASES").is_some_and(|cases| cases == "all");
    let names = [
        "chain",
        "converter",
        "duffing",
        "linear",
        "motor-axis",
        "paper-example",
        "paper-example-ball",
        "pendulum",
        "relative-degree-2-domain",
    ];
    names.par_iter().step_by(if all { 1 } else { 3 }).for_each(|name| {
        let plant = Plant::load(&folder.join(name).with_extension("json")).unwrap();
        let reduced = reduce(&plant, None, &Unwatched).unwrap();
        let (_, samples) = bounds_around(&plant, reduced.spec.plant().unwrap()).unwrap();
        let radius = reduced.spec.plant().unwrap().largest(|cell| &cell.orbit.radius).to_f64();
        let points = random_points(plant.states(), if all { 100_000 } else { 20_000 });
        let values = reduced.spec.bounds.proved_values();
        for ProvedValue { bound, x, e, value, .. } in values.entries() {
            let place = format!("{name}: {} at ({}, {})", bound.field(), x.to_f64(), e.to_f64());
            if plant.states() == 0 && bound.is_rate() {
                continue;
            }
            let found = samples.largest_at(*bound, [x.to_f64() + radius, e.to_f64()], &points);
            let value = if bound.is_rate() { -value.to_f64() } else { value.to_f64() };
            assert!(value >= found, "{place}: {value} is below {found}");
            let joint = values.joint_stability().map(|joint| &joint.inequality.e);
            let ends = values.inequality().map(|inequality| &inequality.e).or(joint);
            let is_beside = ends == Some(e);
            let slack = if is_beside { SLACK_BESIDE } else { SLACK };
            let near = value - found <= slack * found.abs() || value.abs() < NOTHING;
            assert!(near, "{place}: {value} for {found}");
        }
    });
}

/// Hears how many candidates are tried.
#[derive(Default)]
struct Heard(AtomicUsize);

impl Watch for Heard {
    fn enter(&self, _: Stage) {}

    fn part(&self, _: usize, _: usize) {}

    fn tried(&self, count: usize) {
        self.0.fetch_max(count, Ordering::Relaxed);
    }
}

/// Coordinates, of which a state alone has none to choose, take most of the time: who waits hears that it goes on.
#[test]
fn candidates_are_counted() {
    let tried = |name: &str| {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../specs/plants").join(name);
        let heard = Heard::default();
        reduce(&Plant::load(&file).unwrap(), None, &heard).unwrap();
        heard.0.into_inner()
    };
    let (few, many) = (tried("linear.json"), tried("duffing.json"));
    assert!(few >= 1 && many > 50, "{few} {many}");
}
