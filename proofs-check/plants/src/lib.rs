//! Certificates of a plant that is given by its formulas (docs/mathematics.md, section 11).
//!
//! Guarantee of [`prove`]: f and q are periodic and smooth where they are used (P0); x_0 exists, near xb (P1); every entry of
//! `bounds` is true (P2), and the forcing is as `forcing` says (P3). What the claim says of balls and domains is decided in
//! `proofs_core::plant` (P4). What a claim says by the number of oscillators is decided after it, in [`by_n_o`].

pub mod at_samples;
pub mod bounds;
pub mod by_n_o;
pub mod cells;
mod derivative;
mod expansion;
mod form;
pub mod formula;
pub mod harmonics;
pub mod inequality;
pub mod jacobian;
mod linear;
pub mod machine;
pub mod model;
pub mod orbit;
pub mod parts;
pub mod path;
pub mod periodic;
mod powers;
pub mod question;
pub mod read;
pub mod region;
pub mod smooth;
mod still;
pub mod taylor;
mod term;
pub mod time;
mod within;

use form::Said;
use machine::{Cell, Machine, Values};
use model::{Frame, Model};
use proofs_core::interval::Interval;
use proofs_core::plant::entries;
use proofs_core::rules::derivation::Inequalities;
use proofs_core::spec::Specification;
use proofs_core::verdict::{Outcome, Verdict, demand, finding};
use question::{Answer, Question};
use read::Plant;
use region::{Region, Shape};
use rug::{Float, Rational};
use std::rc::Rc;

/// The precision, in bits, of the boxes.
const PRECISION: u32 = 53;
/// Those of Taylor arithmetic and of the Jacobian over time, each tried where the one before does not decide.
const TAYLOR_PRECISIONS: [u32; 2] = [128, 320];
/// The precision, in bits, at which the ends of a region are rounded up.
const ARGUMENT_PRECISION: u32 = 128;
/// How many cells of t there are for the bound of the drift.
const DRIFT_CELLS_LOG: u32 = 6;

/// A question with its region, and what it is about.
struct Asked {
    question: Question,
    region: Region,
    rule: &'static str,
    pointer: String,
    what: String,
}

/// Proves everything that section 11 demands of the formulas, in every cell, and the inequalities of section 13.7 that a claim rests on;
/// `arguments`: the largest X and E at which they are used.
pub fn prove(
    spec: &Specification,
    cells: &[Plant],
    arguments: [&Float; 2],
    inequalities: Inequalities<'_>,
    lines: &mut Vec<String>,
) -> Outcome<()> {
    for (number, cell) in (1..).zip(cells) {
        if cells.len() > 1 {
            lines.push(format!("cell {number} of {}", cells.len()));
        }
        prove_in(spec, cell, arguments, inequalities, lines)?;
    }
    Ok(())
}

/// Proves in one cell what section 11 demands of the formulas, and the inequalities of section 13.7 that a claim rests on.
fn prove_in(
    spec: &Specification,
    plant: &Plant,
    arguments: [&Float; 2],
    inequalities: Inequalities<'_>,
    lines: &mut Vec<String>,
) -> Outcome<()> {
    for formula in plant.f.iter().chain([&plant.q]) {
        let what = "t occurs only inside sin, cos and tan, as A t + B with A period/(2 pi) a whole number";
        demand(
            periodic::is_periodic(&formula.expr, spec.period.nominal.exact.as_ref()),
            "periodicity",
            &formula.pointer,
            what,
        )?;
    }
    lines.push("formulas: periodic in t, by their form".to_owned());
    let mut model = Model::new(plant, Frame::Moving);
    let rest = harmonics::Rest::new(plant, &mut model);
    let defect = path::roots(&mut model.formulas, &model.defect, plant.family.len());
    let mut asked = Vec::new();
    if plant.states() > 0 {
        orbit::radii(&plant.orbit, &plant.lyapunov[0])?;
        asked = of_orbit(plant, &mut model)?;
    }
    let of_the_orbit = asked.len();
    let mut said: Vec<Said> = plant.known.entries.list.iter().map(|entry| of_entry(&mut model, entry)).collect();
    said.extend(inequality::questions(&mut model, inequalities, spec)?);
    let used = largest(arguments, &said);
    asked.extend(said.into_iter().map(|said| on_region(plant, said)));
    let still = still::Still::new(plant, |model| in_states(model, plant, inequalities, spec))?;
    if model.formulas.is_too_large() {
        return too_large("formulas", "/plant");
    }
    let curves = model::curves(plant);
    let circle = |p: u32| {
        let period = spec.period.nominal.enclose(p);
        (Interval::pi(p) * 2 / &period, period)
    };

    let (om, period) = circle(PRECISION);
    let mut machine = Machine::new(&model.formulas, &curves, &om);
    let root = machine.period(&period);
    let mut values = machine.values();
    let count = smoothness(plant, &model, &machine, &root, used.each_ref(), &mut values)?;
    lines.push(format!("formulas: smooth where they are used, by {count} boxes"));
    if plant.states() > 0 {
        let cells = at_rising_precision(|p| {
            let (om, period) = circle(p);
            orbit::defect(plant, &defect, &model, &curves, &om, &period)
        })?;
        lines.push(format!("orbit: defect by {cells} cells of t, at order {}", path::ORDER));
    }
    let cells = at_rising_precision(|p| {
        let (om, period) = circle(p);
        rest.prove(plant, &model, &curves, &om, &period)
    })?;
    lines.push(format!("forcing: harmonics and rest by {cells} cells of t"));
    machine.drift = drift(plant, &model, &machine, &root, &mut values);
    let mut prepared = still.prepared(plant, &curves, &om, &period);
    for (at, Asked { question, region, rule, pointer, what }) in asked.into_iter().enumerate() {
        let which = at.checked_sub(of_the_orbit);
        if let Some(count) = which.and_then(|which| prepared.proves(plant, which, &region)) {
            lines.push(format!("{rule}: {what}, by {count} boxes of the states"));
            continue;
        }
        match question.decide(&machine, &root, &region, question::MAX_PIECES, &mut values) {
            Answer::Proved(count) => lines.push(format!("{rule}: {what}, by {count} boxes")),
            Answer::Refuted(place) => demand(Some(false), rule, &pointer, format!("{what}, at {place}"))?,
            Answer::Open(place) => demand(None, rule, &pointer, format!("{what}, near {place}"))?,
        }
    }
    Ok(())
}

/// The sizes of each P, and its rate in the tube.
fn of_orbit(plant: &Plant, model: &mut Model) -> Outcome<Vec<Asked>> {
    let mut asked = Vec::new();
    for (which, what, question) in orbit::sizes(plant, model)? {
        let region = Region { states: plant.states(), ..Region::of_family(plant, PRECISION) };
        let pointer = plant.lyapunov[which].pointer.clone();
        asked.push(Asked { question, region, rule: orbit::RULE, pointer, what: what.to_owned() });
    }
    for (which, w) in plant.lyapunov.iter().enumerate() {
        let p = model.lyapunov[which].clone();
        let jacobian = model.jacobian.clone();
        let rows = bounds::rate(&mut model.formulas, &w.numbers[2], &p, &jacobian);
        asked.push(Asked {
            question: Question::new(&mut model.formulas, rows, plant.states()),
            region: within(plant, tube(plant), Interval::int(0, PRECISION)),
            rule: orbit::RULE,
            pointer: format!("{}/alpha", w.pointer),
            what: "P' + P J + J'P <= -2 alpha P in the tube".to_owned(),
        });
    }
    Ok(asked)
}

/// The questions of all entries, but for those about the motion of the frame, and of the inequalities that there are.
fn in_states(
    model: &mut Model,
    plant: &Plant,
    inequalities: Inequalities<'_>,
    spec: &Specification,
) -> Outcome<Vec<Option<Question>>> {
    let of = |entry: &entries::Entry| {
        (!entry.name.is_of_motion()).then(|| bounds::question(model, entry.name, &entry.value))
    };
    let mut questions: Vec<Option<Question>> = plant.known.entries.list.iter().map(of).collect();
    let said = inequality::questions(model, inequalities, spec)?;
    questions.extend(said.into_iter().map(|said| Some(said.question)));
    Ok(questions)
}

fn tube(plant: &Plant) -> Interval {
    Interval::rational(&plant.orbit.tube, PRECISION)
}

fn of_entry(model: &mut Model, entry: &entries::Entry) -> Said {
    Said {
        rule: entries::RULE,
        pointer: format!("{}/value", entry.pointer),
        what: entry.label.to_owned(),
        at: entry.arguments.clone(),
        question: bounds::question(model, entry.name, &entry.value),
    }
}

/// On G(X, E).
fn on_region(plant: &Plant, Said { rule, pointer, what, at: [x, e], question }: Said) -> Asked {
    let what = format!("{what} at X = {}, E = {}", x.to_f64(), e.to_f64());
    Asked { question, region: region(plant, &x, &e), rule, pointer, what }
}

/// The largest X and E that anything is used at; NaN, on which nothing is proved, where one is not known.
fn largest(arguments: [&Float; 2], said: &[Said]) -> [Float; 2] {
    let mut largest = arguments.map(Clone::clone);
    for (end, other) in said.iter().flat_map(|said| [0, 1].map(|i| (i, &said.at[i]))) {
        if other.is_nan() || *other > largest[end] {
            largest[end] = other.clone();
        }
    }
    largest
}

fn end(value: &Float) -> Interval {
    Interval::point(value).round(PRECISION)
}

/// X + r.
fn radius(plant: &Plant, x: &Float) -> Interval {
    end(x) + Interval::rational(&plant.orbit.radius, PRECISION)
}

/// G(X, E).
fn region(plant: &Plant, x: &Float, e: &Float) -> Region {
    within(plant, radius(plant, x), end(e))
}

/// All (t, v, e, p) with `|v| <= radius`, `|e| <= output`.
fn within(plant: &Plant, radius: Interval, output: Interval) -> Region {
    let family = Region::of_family(plant, PRECISION);
    Region { states: plant.states(), shape: Shape::Ball(radius), output, ..family }
}

/// On the largest region that anything is used on, and in the tube.
fn smoothness(
    plant: &Plant,
    model: &Model,
    machine: &Machine<'_>,
    root: &Rc<Cell>,
    used: [&Float; 2],
    values: &mut Values,
) -> Outcome<usize> {
    let [x, e] = used;
    let whole = region(plant, x, e);
    let count = smooth::prove(&model.formulas, &model.demands, "/plant", machine, root, &whole, values)?;
    let tube_region = within(plant, tube(plant), Interval::int(0, PRECISION));
    if tube(plant).le(&radius(plant, x)) == Some(true) {
        return Ok(count);
    }
    Ok(count + smooth::prove(&model.formulas, &model.demands, "/plant", machine, root, &tube_region, values)?)
}

/// `eps + r sup|J|` over `|v| <= r`: a bound of `L^-1 (x_0' - xb')`, in every component, as an interval around 0.
fn drift(plant: &Plant, model: &Model, machine: &Machine<'_>, root: &Rc<Cell>, values: &mut Values) -> Interval {
    let zero = Interval::int(0, PRECISION);
    let number = |value: &Rational| Interval::rational(value, PRECISION);
    let (eps, r) = (number(&plant.orbit.defect), number(&plant.orbit.radius));
    let entries: Vec<_> = model.jacobian.iter().flatten().copied().collect();
    let program = machine.program(&entries);
    let ball = vec![time::around(&r); plant.states()];
    let rest = Region::of_family(plant, PRECISION).whole(machine, root.clone()).sides;
    let mut largest = zero.clone();
    for cell in &root.parts(DRIFT_CELLS_LOG) {
        machine.run(&program, machine::At::Box, cell, &ball, &rest, values);
        let value = |id: &formula::Id| machine.get(*id, machine::At::Box, cell, values);
        let square = entries.iter().fold(zero.clone(), |sum, id| sum + value(id).sqr());
        largest = largest.max(&square);
    }
    time::around(&(eps + r * largest.sqrt()))
}

/// That formulas have too many parts for anything to be decided.
fn too_large<T>(rule: &'static str, pointer: &str) -> Outcome<T> {
    let message = "the formulas and their derivatives have too many parts";
    Err(finding(Verdict::Undecided, rule, pointer, message))
}

fn at_rising_precision<T>(attempt: impl Fn(u32) -> Outcome<T>) -> Outcome<T> {
    let mut last = attempt(TAYLOR_PRECISIONS[0]);
    for precision in &TAYLOR_PRECISIONS[1..] {
        if last.as_ref().is_err_and(|finding| finding.verdict == Verdict::Undecided) {
            last = attempt(*precision);
        }
    }
    last
}
