//! The forms in which a regulator is written out. The same input gives the same bytes.

mod c;
mod json;
mod matlab;
mod notice;
mod npz;

pub use c::{CNames, CSources, Prefix, PrefixError, c_sources};
pub use json::{FORMAT, VERSION, VERSIONS, json};
pub use matlab::matlab;
pub use notice::{DELAYED_LAW, Provenance, SAMPLED_LAW, Scope, notice};
pub use npz::npz;

use super::{Convergence, Discrete, Regulator};
use sigmastar_lang::spec::{Actuator, Oscillators};

/// What is written out.
#[derive(Clone, Copy, Debug)]
pub struct Export<'r> {
    /// The name of the plant, one line without control characters.
    pub name: &'r str,
    /// The regulator.
    pub regulator: &'r Regulator,
    /// At which harmonics its oscillators are.
    pub oscillators: &'r Oscillators,
    /// Its discretisation and what that does to the loop, where one was asked for.
    pub discrete: Option<(&'r Discrete, Convergence)>,
    /// Whether it sets z = M e at its first instant (section 13.7); else it starts with z = 0.
    pub aligned: bool,
    /// What the actuator takes, where the document states it and no other limit was asked for.
    pub actuator: Option<&'r Actuator>,
    /// What u is measured from, where that is not 0: the middle of the range of the actuator, which is added to u before it is put out.
    pub middle: Option<f64>,
    /// The certificate, where one was given for this plant.
    pub certificate: Option<&'r Provenance>,
}

/// The law in continuous time, as exports write it; `divided` by the nominal gain of an actuator.
#[must_use]
pub fn continuous_law(divided: bool) -> &'static str {
    match divided {
        false => "z' = Phi z + Gamma e, u = -sigma e + mu M'N(z - M e)",
        true => "z' = Phi z + Gamma e, u = (-sigma e + mu M'N(z - M e))/nominal",
    }
}

/// The law at samples, as exports write it, with or without a delay.
#[must_use]
pub fn sampled_law(delayed: bool, divided: bool) -> String {
    let (law, control) = match delayed {
        false => (SAMPLED_LAW, "-sigma e + K v"),
        true => (DELAYED_LAW, "-sigma e1 + K v"),
    };
    match divided {
        false => law.to_owned(),
        true => law.replace(control, &format!("({control})/nominal")),
    }
}

/// The numbers of a discretisation that has them all, with the names that scripts give them.
fn numbers(discrete: &Discrete) -> [(&'static str, f64); 5] {
    [
        ("step", discrete.step),
        ("K", discrete.gain),
        ("weight_sum", discrete.weight_sum),
        ("decay", discrete.decay),
        ("D_d", discrete.feedthrough),
    ]
}

/// A double in the fewest digits that give it back.
fn decimal(value: f64) -> String {
    let plain = format!("{value:?}");
    plain.strip_suffix(".0").map_or(plain.clone(), str::to_owned)
}
