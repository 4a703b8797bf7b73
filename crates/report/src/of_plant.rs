//! What was proved from a plant's formulas: the orbit, the coordinates, the values of the bounds.

use super::words;
use rug::Rational;
use serde_json::{Value, json};
use sigmastar_document::number::{estimate, exact};
use sigmastar_document::{Block, Table, clean};
use sigmastar_exact::number::{Direction, write_exact};
use sigmastar_lang::expr::quoted;
use sigmastar_lang::spec::model::{Constant, Lyapunov};
use sigmastar_lang::spec::{
    ExistenceInequality, Interval, JointStability, MatrixInequality, OfPlant, Parameter, ProvedValue, SampledExistence,
    SampledInequalities, SampledInequality, Specification, Splitting, TrigonometricVector,
};
use sigmastar_prove::certificate::{joint_existence_json, joint_stability_json, rows};
use sigmastar_prove::certify::{claimed_ball, nominal_ball};
use sigmastar_theory::derivation::initial_set::ClaimedSet;

/// The section; nothing where the data are those of a specification.
pub(super) fn section(spec: &Specification, set: Option<&ClaimedSet>) -> Vec<Block> {
    let Some(plant) = spec.plant() else { return Vec::new() };
    let mut blocks = vec![Block::heading("From the plant's formulas")];
    let parameters = plant.parameters.list();
    if !parameters.is_empty() {
        let written = parameters.iter().map(|Parameter { name, value, interval }| match interval {
            None => format!("{} = {}", quoted(name), value.words()),
            Some(Interval { low, high, .. }) => {
                let name = quoted(name);
                format!("{name} in [{}, {}] (nominal {})", write_exact(low), write_exact(high), value.words())
            }
        });
        blocks.push(Block::facts([("parameters", written.collect::<Vec<_>>().join(", "))]));
    }
    if let Some([low, high]) = spec.period.interval() {
        let nominal = spec.period.nominal().words();
        let written = format!("T in [{}, {}] (nominal {nominal})", low.words(), high.words());
        blocks.push(Block::facts([("period", clean(&written))]));
        blocks.push(Block::says(
            "Everything below is proved for every constant period in this interval, of which the clock $`v = T_nominal/T`$ is one more \
             parameter: $`xb`$ follows it too, and all of this is about the phase $`2 pi t/T`$.",
        ));
    }
    if parameters.iter().any(|parameter| parameter.interval.is_some()) {
        blocks.push(Block::says(format!(
            "Everything below is proved for every value of the parameters in these intervals, each of them constant in time; $`x_0(t)`$ is that of \
             the member, and $`xb(t)`$ follows it{} as an affine function of the parameters.",
            if is_cut(plant) { ", in each of the cells below," } else { "" }
        )));
    }
    blocks.extend(cut(plant));
    if plant.states() > 0 {
        blocks.push(Block::says(
            "$`x_0(t)`$ is the T-periodic solution of $`x' = f(t,x,0)`$, and $`y = L^-1 (x - x_0)`$ are the coordinates in which all norms are \
             taken. Everything below is proved.",
        ));
        blocks.push(Block::facts(facts(plant, set)));
        blocks.push(matrix("L", &plant.coordinates));
    }
    let (where_, titles) = match spec.state_name() {
        Some(_) => ("$`|y| <= X`$, $`|e| <= E`$", &["<bound", "<of", "$`X`$", "$`E`$", "value"][..]),
        None => ("$`|e| <= E`$", &["<bound", "<of", "$`E`$", "value"][..]),
    };
    blocks.push(Block::says(format!("The bounds that the conditions use, for {where_} and every $`t`$:")));
    let mut table = Table::new(titles);
    for ProvedValue { bound, x, e, value, .. } in &spec.bounds.proved_values().entries {
        // Without states those of f, and of derivatives by x, are of nothing.
        if spec.state_name().is_none() && bound.is_of_state() {
            continue;
        }
        let [x, e] = [x, e].map(|end| exact(end, Direction::Down));
        let direction = if bound.is_rate() { Direction::Down } else { Direction::Up };
        let arguments = words::with_state(spec, [x, e]);
        let names = [bound.field(), bound.of_what()].map(|name| format!("$`{name}`$"));
        table.push(names.into_iter().chain(arguments).chain([exact(value, direction)]));
    }
    blocks.push(Block::Table(table));
    blocks.extend(spec.bounds.proved_values().inequality.as_ref().map(|inequality| {
        let where_ = inequality.arguments().map(|ends| place(spec, ends));
        let [states, error] = &where_;
        let place = match inequality.splitting {
            None => format!("at every point of {states}"),
            Some(_) => format!("with $`df/dx`$, $`dq/dx`$ at every point of {states}, $`df/de`$, $`dq/de`$ at every one of {error},"),
        };
        Block::says(format!(
            "Stability rests on the matrix inequality (M) over the derivatives (section 13.7), which holds from $`sigma = {}`$ on, \
             {place} and every $`t`$. The bounds at the same $`X`$ and $`E`$ are used for the rates of convergence only.",
            exact(&inequality.value, Direction::Up)
        ))
    }));
    blocks.extend(spec.bounds.proved_values().existence.as_ref().map(|existence| {
        let ExistenceInequality { x, e, k_p, c_y, value, .. } = existence;
        let place = place(spec, [x, e]);
        Block::says(format!(
            "Existence rests on the matrix inequality (E) over the derivatives (section 13.7), which holds from $`sigma = {}`$ on, at \
             every point of {place} and every $`t`$: along the periodic solution the root mean square of $`q + mu s`$ is at most {} times \
             that of $`q(t,0,0)`$ without its mean.",
            exact(value, Direction::Up),
            exact(&Rational::from(k_p / c_y), Direction::Up)
        ))
    }));
    let joint = spec.bounds.proved_values().joint_existence.as_ref();
    blocks.extend(joint.map(|joint| {
        let most = joint.metrics().map(|metric| Rational::from(&metric.k_p / &metric.c_y)).into_iter().max();
        Block::says(format!(
            "Existence rests on the joint inequality (Jm) over the derivatives (section 13.7), whose two metrics of $`(y, e)`$ serve \
             from $`sigma = {}`$ on, at every point of {} and every $`t`$: along the periodic solution the root mean square of $`q + mu s`$ is \
             at most {} times that of $`q(t,0,0)`$ without its mean.",
            exact(&joint.value, Direction::Up),
            place(spec, [&joint.x, &joint.e]),
            exact(&most.unwrap_or_default(), Direction::Up)
        ))
    }));
    let joint = spec.bounds.proved_values().joint_stability.as_ref();
    blocks.extend(joint.map(|JointStability { inequality, .. }| {
        Block::says(format!(
            "Stability rests on the joint inequality (Jm) over the derivatives (section 13.7), whose two metrics of $`(y, e)`$ serve \
             from $`sigma = {}`$ on, at every point of {} and every $`t`$.",
            exact(&inequality.value, Direction::Up),
            place(spec, [&inequality.x, &inequality.e])
        ))
    }));
    blocks.extend(at_samples(spec));
    blocks
}

/// Whether the box of the parameters is cut.
fn is_cut(plant: &OfPlant) -> bool {
    plant.cells.len() > 1
}

/// That it is, and why.
fn cut(plant: &OfPlant) -> Option<Block> {
    is_cut(plant).then(|| {
        let why = plant.why_cut.as_ref().map_or_else(|| ".".to_owned(), |why| format!(": {why}."));
        Block::says(format!(
            "The box of the parameters is cut into {} cells, which may overlap. Each has an $`xb(t)`$ and a tube of its own. Every number below is true in all \
             of them{why}",
            plant.cells.len()
        ))
    })
}

/// The matrix inequalities of the regulator at samples.
fn at_samples(spec: &Specification) -> Vec<Block> {
    let SampledInequalities { stability, existence } = &spec.bounds.proved_values().at_samples;
    let of_stability = stability.iter().map(|SampledInequality { x, e, .. }| {
        Block::says(format!(
            "Stability rests on the matrix inequality (Ms) over the derivatives (section 13.7) in the place of C5h, at this gain and \
             sampling period, at every point of {} and every $`t`$. The bounds at the same $`X`$ and $`E`$ are not used.",
            place(spec, [x, e])
        ))
    });
    let of_existence = existence.iter().map(|SampledExistence { x, e, gamma, c_y, .. }| {
        Block::says(format!(
            "Existence rests on the matrix inequality (E) at samples (section 13.7), at every point of {} and every $`t`$: along the \
             periodic solution the mean square of $`y`$ over the samples is at most {} times that of $`q(t,0,0)`$ without its mean.",
            place(spec, [x, e]),
            exact(&Rational::from(gamma / c_y), Direction::Up)
        ))
    });
    of_stability.chain(of_existence).collect()
}

/// The points up to these arguments.
fn place(spec: &Specification, ends: [&Rational; 2]) -> String {
    let [x, e] = ends.map(|end| exact(end, Direction::Down));
    if spec.state_name().is_some() { format!("$`|y| <= {x}`$, $`|e| <= {e}`$") } else { format!("$`|e| <= {e}`$") }
}

/// Where x_0 is, about: its mean and how far it swings, by each state; nothing of a plant without states, or of a specification.
pub(super) fn orbit(spec: &Specification) -> Option<String> {
    let plant = spec.plant()?;
    let nominal = plant.parameters.nominal();
    let cell = plant.cells.iter().find(|cell| cell.parameters.contain(&nominal))?;
    let TrigonometricVector { mean, harmonics } = cell.orbit.approximation.at(&cell.parameters.deviations(&nominal));
    let names = spec.document.pointer("/states")?.as_array()?;
    let of_state = |(state, name): (usize, &Value)| {
        let amplitude = |[cos, sin]: &[Vec<Rational>; 2]| {
            let [a, b] = [cos, sin].map(|part| part[state].to_f64());
            (a * a + b * b).sqrt()
        };
        let swing: f64 = harmonics.iter().map(amplitude).sum();
        let swing = if swing == 0.0 { String::new() } else { format!(" +- {}", estimate(swing)) };
        Some(format!("{} about {}{swing}", quoted(name.as_str()?), estimate(mean[state].to_f64())))
    };
    let states: Vec<String> = names.iter().enumerate().map(of_state).collect::<Option<_>>()?;
    let [whose, others] =
        if nominal.is_empty() { [""; 2] } else { [" (nominal plant)", "; other members have other orbits"] };
    (!states.is_empty()).then(|| format!("$`x_0(t)`${whose}: {}{others}", states.join(", ")))
}

/// So many harmonics, in words.
fn count_of(harmonics: usize) -> String {
    if harmonics == 1 { "1 harmonic".to_owned() } else { format!("{harmonics} harmonics") }
}

fn facts(plant: &OfPlant, set: Option<&ClaimedSet>) -> Vec<(&'static str, String)> {
    let up = |value: &Rational| exact(value, Direction::Up);
    let harmonics = plant.cells.iter().map(|cell| cell.orbit.approximation.harmonics()).max().unwrap_or(0);
    let most = if is_cut(plant) { " at most" } else { "" };
    // Within the tube x_0 is the only one: of cells that is so of all of them up to the smallest.
    let least = if is_cut(plant) { " at least" } else { "" };
    let mut facts = vec![
        (
            "orbit",
            format!(
                "a trigonometric polynomial with{most} {}; $`|L^-1 (x_0 - xb)| <= {}`$ (defect{most} {}, tube{least} {})",
                count_of(harmonics),
                up(&plant.largest(|cell| &cell.orbit.radius)),
                up(&plant.largest(|cell| &cell.orbit.defect)),
                exact(&plant.smallest(|cell| &cell.orbit.tube), Direction::Down)
            ),
        ),
        ("rate along it", format!("$`alpha = {}`$", number(&plant.triple.alpha, Direction::Down))),
    ];
    if !plant.matrix.harmonics.is_empty() {
        facts.push((
            "P(t)",
            format!(
                "{}, $`p_low = {}`$, $`p_up = {}`$",
                count_of(plant.matrix.harmonics.len()),
                number(&plant.triple.p_low, Direction::Down),
                number(&plant.triple.p_up, Direction::Up)
            ),
        ));
    }
    if let Some((triple, _)) = plant.existence.as_deref() {
        let Lyapunov { p_low, p_up, alpha } = triple;
        let [alpha, p_low] = [alpha, p_low].map(|value| number(value, Direction::Down));
        let p_up = number(p_up, Direction::Up);
        facts.push(("P of existence", format!("$`alpha = {alpha}`$, $`p_low = {p_low}`$, $`p_up = {p_up}`$")));
    }
    facts.push((
        "$`q(t, x_0, 0)`$",
        format!(
            "{}{}; the rest is at most {}, its derivative {}",
            if is_cut(plant) { "at most " } else { "" },
            count_of(plant.cells.iter().map(|cell| cell.forcing.harmonics.len()).max().unwrap_or(0)),
            up(&plant.largest(|cell| &cell.forcing.rest)),
            up(&plant.largest(|cell| &cell.forcing.rest_t))
        ),
    ));
    if let Some(ball) = set.and_then(|set| claimed_ball(plant, &set.x0)) {
        facts.push(("the initial set contains", format!("$`|x - x_0| <= {}`$", exact(&ball, Direction::Down))));
    }
    if let Some(ball) = set.and_then(|set| nominal_ball(plant, &set.x0)) {
        let said = format!(
            "$`|x - xb(t)| <= {}`$ about the $`xb`$ of the nominal member{}",
            exact(&ball, Direction::Down),
            if is_cut(plant) { " in the first cell that has it" } else { "" }
        );
        facts.push(("every member's set contains", said));
    }
    facts
}

/// A number of a triple in few digits.
fn number(constant: &Constant, direction: Direction) -> String {
    constant.as_rational().map_or_else(|| constant.text.clone(), |value| exact(value, direction))
}

fn matrix(name: &str, rows: &[Vec<Rational>]) -> Block {
    // Exactly: it is what the norms are of.
    let row = |row: &Vec<Rational>| row.iter().map(write_exact).collect::<Vec<_>>().join(", ");
    let rows: Vec<String> = rows.iter().map(row).collect();
    Block::facts([(name.to_owned(), format!("[{}]", rows.join("; ")))])
}

/// What is proved of a plant, as JSON; null where the data are those of a specification.
pub(super) fn plant_json(spec: &Specification, set: Option<&ClaimedSet>) -> Value {
    let Some(plant) = spec.plant() else { return Value::Null };
    let ball = set.and_then(|set| claimed_ball(plant, &set.x0));
    let harmonics = plant.cells.iter().map(|cell| cell.orbit.approximation.harmonics()).max().unwrap_or(0);
    let values: Vec<Value> = spec
        .bounds
        .proved_values()
        .entries
        .iter()
        .map(|entry| {
            json!({
                "bound": entry.bound.field(), "X": write_exact(&entry.x), "E": write_exact(&entry.e),
                "value": write_exact(&entry.value),
            })
        })
        .collect();
    let mut report = json!({
        "coordinates": rows(&plant.coordinates),
        "orbit": {
            "harmonics": harmonics, "defect": write_exact(&plant.largest(|cell| &cell.orbit.defect)),
            "tube": write_exact(&plant.smallest(|cell| &cell.orbit.tube)),
            "radius": write_exact(&plant.largest(|cell| &cell.orbit.radius)),
        },
        "cells": plant.cells.len(), "cells_because": plant.why_cut,
        "alpha": plant.triple.alpha.text, "ball": ball.as_ref().map(write_exact), "bounds": values,
        "matrix_inequality": spec.bounds.proved_values().inequality.as_ref().map(|inequality| {
            let MatrixInequality { x, e, w_x, h, rate, value, splitting } = inequality;
            json!({
                "X": write_exact(x), "E": write_exact(e), "w_x": write_exact(w_x), "h": write_exact(h),
                "rate": write_exact(rate), "sigma": write_exact(value),
                "splitting": splitting.as_ref().map(|Splitting { x, e, matrix }| {
                    json!({ "X": write_exact(x), "E": write_exact(e), "S": rows(matrix) })
                }),
            })
        }),
        "existence_inequality": spec.bounds.proved_values().existence.as_ref().map(|existence| {
            let ExistenceInequality { x, e, matrix, k_p, c_x, c_y, value } = existence;
            json!({
                "X": write_exact(x), "E": write_exact(e), "P": rows(matrix), "k_p": write_exact(k_p),
                "c_x": write_exact(c_x), "c_y": write_exact(c_y), "sigma": write_exact(value),
            })
        }).or_else(|| spec.bounds.proved_values().joint_existence.as_ref().map(joint_existence_json)),
        "joint_inequality": spec.bounds.proved_values().joint_stability.as_ref().map(joint_stability_json),
    });
    // A single plant has one orbit, about which `ball` is.
    if plant.parameters.intervals().next().is_some() {
        let ball = set.and_then(|set| nominal_ball(plant, &set.x0));
        report["nominal_ball"] = ball.as_ref().map(write_exact).into();
    }
    report
}
