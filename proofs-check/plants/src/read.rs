//! A plant and the parts of a witness that are about its formulas, as a file has them (docs/formats.md, "Plant" and "A certificate
//! of a plant"): read and checked in form. What is proved of them is in the other files of this folder.

use super::cells::{self, Cell};
use super::parts::{Forcing, Orbit};
use super::time::Wave;
use proofs_core::actuator;
use proofs_core::constant::{Constant, positive_with};
use proofs_core::expr::{Expr, Named, TIME};
use proofs_core::input_gain;
use proofs_core::jacobian;
use proofs_core::json::{Field, Fields, Json};
use proofs_core::noise::Noise;
use proofs_core::period::Period;
use proofs_core::plant::OfPlant;
use proofs_core::plant::coordinates::Coordinates;
use proofs_core::plant::entries::Entries;
use proofs_core::plant::parameters::Parameter;
use proofs_core::range::Span;
use proofs_core::spec::{self, AskedSet, Specification, header};
use proofs_core::verdict::{Outcome, bad, demand};

/// The most states that are taken.
pub const MAX_STATES: usize = 6;
/// The most characters of the name of a state.
const MAX_NAME: usize = 40;
/// The most named constants of a plant, and how many of them may be intervals.
const MAX_PARAMETERS: usize = 12;
pub const MAX_INTERVALS: usize = 4;
/// What a state may not be called.
#[rustfmt::skip]
const TAKEN: [&str; 17] = [
    "t", "phase", "e", "pi", "sqrt", "exp", "log", "sin", "cos", "tan", "atan", "tanh", "abs", "min", "max",
    "exprelr", "sinc",
];

/// A formula with its place in the file.
#[derive(Clone, Debug)]
pub struct Formula {
    pub pointer: String,
    pub expr: Expr,
}

/// What is given of a plant, in a cell of its family.
#[derive(Clone, Debug)]
pub struct Plant {
    pub f: Vec<Formula>,
    pub q: Formula,
    pub orbit: Orbit,
    /// The P of stability and, if there is one, that of existence.
    pub lyapunov: Vec<jacobian::Witness>,
    pub forcing: Forcing,
    /// What e is measured from, where that is not 0 (section 14.4): of a trial, the nominal one and the others.
    pub error: Vec<Wave>,
    /// The numbers of which intervals are given: the parameters, and after them the clock where the period is an interval, or of a trial the gain of the
    /// actuator over its nominal value where that is one.
    pub family: Vec<Span>,
    /// By which powers of these numbers, less their nominal values, each of the waves but the nominal ones is multiplied.
    pub powers: Vec<Vec<u32>>,
    has_clock: bool,
    /// What a claim needs of it.
    pub known: OfPlant,
}

impl Plant {
    /// The number of states.
    pub fn states(&self) -> usize {
        self.f.len()
    }

    /// The place of the clock in the family, with a period that is an interval.
    pub fn clock(&self) -> Option<usize> {
        if self.has_clock { self.family.len().checked_sub(1) } else { None }
    }

    /// The components of xb_0 and then qb_0, and the same of each sensitivity; of a trial uhat for qb, and after it what e is measured from.
    pub fn waves(&self) -> impl Iterator<Item = Vec<Wave>> {
        let all = self.orbit.waves.iter().zip(&self.forcing.waves).enumerate();
        all.map(|(member, (x, q))| x.iter().chain([q]).chain(self.error.get(member)).cloned().collect())
    }
}

/// Reads a plant, and takes its parts out of the witness: in each of its cells, of which most families have one.
pub fn read(field: &Field<'_>, witness: &mut Fields<'_>) -> Outcome<(Specification, Vec<Plant>)> {
    let mut file = field.fields()?;
    header(&mut file, "sigmastar/plant")?;
    spec::words(&mut file)?;
    let names = states(&file.required("states")?)?;
    let (constants, intervals) = match file.optional("parameters") {
        Some(field) => parameters(&field, &names)?,
        None => Default::default(),
    };
    let period = Period::read(&mut file, &constants)?;
    let clock = period.clock(&format!("{}/period", file.pointer))?;
    let of_family = intervals.iter().map(|parameter| parameter.name.as_str());
    let variables: Vec<&str> = ["e"].into_iter().chain(names.iter().copied()).chain(of_family).collect();
    let formula = |field: &Field<'_>| {
        let expr = period.expression(field, &variables, &constants)?;
        Ok(Formula { pointer: field.pointer.clone(), expr })
    };
    let list = file.required("f")?;
    let f: Vec<Formula> = list.list(formula)?;
    if f.len() != names.len() {
        return bad(&list.pointer, format!("expected {} expressions, one for each state", names.len()));
    }
    let q = formula(&file.required("q")?)?;
    file.part("initial", |field| initial(field, names.len(), &constants))?;
    let (initial_set, ball) = match file.optional("initial_set") {
        Some(field) => spec::read_set(&field, (true, names.is_empty()), &constants)?,
        None => (AskedSet::AtRest([None, None]), None),
    };
    let ends = |fields: &mut Fields<'_>| {
        let mut end = |name| positive_with(&fields.required(name)?, name, &constants);
        Ok([end("x")?, end("e")?])
    };
    let domain = file.part("domain", |field| field.object(ends))?;
    let input_gain = input_gain::read(&mut file, &constants, &intervals)?;
    let actuator = actuator::read(&mut file, &constants, true)?;
    let stated = field.fields()?.optional("input_gain");
    let time: Vec<&str> = TIME.iter().copied().chain(variables.iter().copied()).collect();
    let q = Formula {
        expr: actuator::from_middle(
            q.expr,
            actuator.as_ref(),
            (input_gain.as_ref(), stated.as_ref()),
            &time,
            &constants,
        )?,
        ..q
    };
    let noise = Noise::read(&mut file)?;
    let regulator = spec::InternalModel::read(&file.required("internal_model")?, &period, &constants)?;
    file.finish()?;

    let has_clock = clock.is_some();
    let family: Vec<Span> = intervals.iter().map(|parameter| parameter.span.clone()).chain(clock).collect();
    let order = names.len();
    let coordinates = Coordinates::read_part(&witness.required("coordinates")?, order)?;
    let in_cells = witness.has("cells");
    let cells = cells::read(witness, order, family, intervals.len())?;
    let (first, [p_low, p_up, alpha]) = jacobian::Witness::read(&witness.required("lyapunov")?, order)?;
    let existence = witness.part("lyapunov_existence", |field| jacobian::Witness::read(field, order))?;
    let lyapunov: Vec<_> = [first].into_iter().chain(existence.iter().map(|(second, _)| second.clone())).collect();
    for w in &lyapunov {
        let [low, up, _] = &w.numbers;
        demand(Some(low <= up), jacobian::RULE, &w.pointer, "p_low <= p_up")?;
    }
    let entries = Entries::read(&witness.required("bounds")?, order > 0, lyapunov.len() > 1)?;
    let two_matrices = lyapunov.len() > 1;
    let parameters = intervals;
    let known = OfPlant { states: order, domain, ball, coordinates, entries, parameters, in_cells, two_matrices };
    let specification = Specification {
        period,
        p_low,
        p_up,
        alpha,
        jacobian: None,
        existence,
        rate: None,
        regulator,
        bounds: Default::default(),
        q_0: Some(cells::largest(&cells)),
        domain: None,
        initial_set,
        input_gain,
        actuator,
        noise,
        plant: Some(Box::new(known.clone())),
    };
    let unit = |i: usize, count: usize| (0..count).map(|j| u32::from(i == j)).collect();
    let of_cell = |Cell { family, orbit, forcing }| Plant {
        f: f.clone(),
        q: q.clone(),
        orbit,
        lyapunov: lyapunov.clone(),
        forcing,
        error: Vec::new(),
        powers: (0..family.len()).map(|i| unit(i, family.len())).collect(),
        family,
        has_clock,
        known: known.clone(),
    };
    Ok((specification, cells.into_iter().map(of_cell).collect()))
}

fn states<'a>(list: &Field<'a>) -> Outcome<Vec<&'a str>> {
    let mut names: Vec<&str> = Vec::new();
    for field in list.elements()? {
        let name = field.text()?;
        well_formed(name, &field.pointer)?;
        if TAKEN.contains(&name) || names.contains(&name) {
            return bad(&field.pointer, "this name is taken");
        }
        names.push(name);
    }
    if names.len() > MAX_STATES {
        return bad(&list.pointer, format!("at most {MAX_STATES} states are taken"));
    }
    Ok(names)
}

fn well_formed(name: &str, pointer: &str) -> Outcome<()> {
    let begins = name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
    if begins && name.len() <= MAX_NAME && name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_') {
        return Ok(());
    }
    bad(pointer, format!("expected a name of at most {MAX_NAME} letters, digits and `_`"))
}

/// Named constants: numbers or constant expressions without names of others, and those of which intervals are given. None has the
/// name of a state, of t, e, u, pi or of a function.
fn parameters(field: &Field<'_>, states: &[&str]) -> Outcome<(Vec<Named>, Vec<Parameter>)> {
    let (mut constants, mut intervals) = (Vec::new(), Vec::new());
    for (name, field) in field.fields()?.rest() {
        well_formed(name, &field.pointer)?;
        if name == "u" || TAKEN.contains(&name) || states.contains(&name) {
            return bad(&field.pointer, "this name is taken");
        }
        let constant = match field.json {
            Json::Object(_) => {
                let parameter = Parameter::read(name, &field)?;
                if !parameter.is_constant() {
                    intervals.push(parameter);
                    continue;
                }
                parameter.range.nominal
            }
            _ => Constant::read(&field)?,
        };
        constants.push(Named { name: name.to_owned(), text: constant.text.clone(), value: constant.expr().clone() });
    }
    if constants.len() + intervals.len() > MAX_PARAMETERS || intervals.len() > MAX_INTERVALS {
        let most = format!("at most {MAX_PARAMETERS} parameters are taken, and {MAX_INTERVALS} with intervals");
        return bad(&field.pointer, most);
    }
    Ok((constants, intervals))
}

/// Where simulations start: constants, of which nothing is used.
fn initial(field: &Field<'_>, order: usize, constants: &[Named]) -> Outcome<()> {
    let mut fields = field.fields()?;
    let x = fields.required("x")?;
    let list = x.elements()?;
    if list.len() != order {
        return bad(&x.pointer, format!("expected {order} numbers, one for each state"));
    }
    let z = fields.optional("z").map(|field| field.elements()).transpose()?;
    list.iter().chain(z.iter().flatten()).try_for_each(|field| Constant::read_with(field, constants).map(drop))?;
    Constant::read_with(&fields.required("e")?, constants)?;
    fields.finish()
}
