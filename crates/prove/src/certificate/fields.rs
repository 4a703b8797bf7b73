//! The free numbers of every witness: their names in a certificate, listed once for the writer, the reader and messages.
//!
//! A further number of a witness is one line here, beside its field in `derivation`. A part that is nested, or may be
//! missing, is a list of its own; it is read and written as `exact_regulation` is.

use rug::Rational;
use sigmastar_exact::number::{parse_rational, write_exact};
use sigmastar_lang::spec::{
    Bound, ErrorKind, Errors, ExistenceInequality, JointInequality, Level, MatrixInequality, Metric, Object,
    ProvedValue, Reported, SampledExistence, SampledGain, SampledInequality, SampledLoop, Sampling, Splitting, Value,
    any_constant, choose,
};
use sigmastar_theory::derivation::exact_regulation::ExactWitness;
use sigmastar_theory::derivation::initial_set::ClaimedSet;
use sigmastar_theory::derivation::mean_squares::MeanSquares;
use sigmastar_theory::derivation::paths::{Path, Paths};
use sigmastar_theory::derivation::repaired::RepairedWitness;
use sigmastar_theory::derivation::sampled::{DelayWitness, SampledWitness};
use sigmastar_theory::derivation::sharp::SharpWitness;
use sigmastar_theory::transfer::TransferProof;

/// The fields of a witness that only a certificate of a plant has.
pub(super) const PLANT_FIELDS: [&str; 8] =
    ["coordinates", "orbit", "forcing", CELLS, "bounds", INEQUALITY, EXISTENCE_INEQUALITY, JOINT_INEQUALITY];

/// Of which sets of harmonics a claim is, and an entry of what it says by the oscillators.
pub(super) const HARMONICS: &str = "harmonics";

/// The field in the place of `orbit` and `forcing` where the box of the parameters is cut.
pub(super) const CELLS: &str = "cells";

/// The field of the matrix inequality of a plant; its weights are those of the witness.
pub(super) const INEQUALITY: &str = "matrix_inequality";
/// And within it what its two halves are compared with.
pub(super) const SPLITTING: &str = "splitting";

/// The field of `orbit` and of `forcing` with one part for each parameter of which an interval is known.
pub(super) const SENSITIVITIES: &str = "sensitivities";

/// The field of the matrix inequality of existence.
pub(super) const EXISTENCE_INEQUALITY: &str = "existence_inequality";

/// The field of the joint inequality of stability; that of existence has the name of the other one.
pub(super) const JOINT_INEQUALITY: &str = "joint_inequality";

/// A part of a certificate that consists of exact rational numbers, each with a name.
pub trait NumberFields: Sized {
    /// What it holds beside the numbers, which stands elsewhere in the file.
    type Other;

    /// The numbers by their names, in the order of the file.
    fn numbers(&self) -> Vec<(&'static str, &Rational)>;

    /// Reads the numbers, then the rest by `other`.
    ///
    /// # Errors
    /// Every field that is missing or not an exact rational, with its place; and what `other` reports.
    fn read(
        fields: &mut Object<'_>,
        errors: &mut Errors,
        other: impl FnOnce(&mut Object<'_>, &mut Errors) -> Result<Self::Other, Reported>,
    ) -> Result<Self, Reported>;

    /// The numbers as fields of JSON.
    fn json(&self) -> Vec<(&'static str, serde_json::Value)> {
        self.numbers().into_iter().map(|(name, value)| (name, write_exact(value).into())).collect()
    }
}

macro_rules! numbers {
    ($part:ident { $($field:ident: $name:literal),+ } and ($($other:ident: $type:ty),*)) => {
        impl NumberFields for $part {
            type Other = ($($type,)*);

            fn numbers(&self) -> Vec<(&'static str, &Rational)> {
                vec![$(($name, &self.$field)),+]
            }

            fn read(
                fields: &mut Object<'_>,
                errors: &mut Errors,
                other: impl FnOnce(&mut Object<'_>, &mut Errors) -> Result<Self::Other, Reported>,
            ) -> Result<$part, Reported> {
                $(let $field = rational(fields, $name, errors);)+
                let ($($other,)*) = other(fields, errors)?;
                Ok($part { $($field: $field?,)+ $($other),* })
            }
        }
    };
}

numbers!(SharpWitness {
    x_p: "X_p",
    e_p: "E_p",
    r_x: "r_x",
    r_e: "r_e",
    r_d: "r_d",
    kap: "kap",
    d_x: "D_x",
    d_e: "D_e",
    w_x: "w_x",
    h: "h",
    k0: "k0",
    k1: "k1"
} and (sigma: Rational, set: ClaimedSet, transfer: TransferProof, refined: Option<RefinedSquares>, paths: Paths));

/// Mean squares of the periodic solution that are smaller than those of existence.
pub type RefinedSquares = MeanSquares<Rational>;

numbers!(RefinedSquares { x: "r_x", e: "r_e", e_rate: "r_d" } and ());

numbers!(RepairedWitness { x: "X", e: "E", level: "L", h: "h", p_x: "p_x", p_e: "p_e", k0: "k0", k1: "k1" }
    and (sigma: Rational, set: ClaimedSet, transfer: TransferProof));

numbers!(SampledWitness {
    x_p: "X_p",
    e_p: "E_p",
    r_x: "r_x",
    r_e: "r_e",
    r_d: "r_d",
    d_x: "D_x",
    d_e: "D_e",
    w_x: "w_x",
    eta: "h",
    k0: "k0",
    k1: "k1"
} and (sigma: Rational, sampling: Sampling, law: SampledGain, set: ClaimedSet, paths: Paths, delay: Option<DelayWitness>));

numbers!(DelayWitness { gm: "gm", y_0: "Y_0" } and ());

numbers!(ExactWitness { sigma: "sigma_star_oo", d_x: "D_x", d_e: "D_e", w_x: "w_x", h: "h" } and (paths: Paths));

// What a certificate of a plant adds.

numbers!(ProvedValue { x: "X", e: "E", value: "value" } and (bound: Bound, sampled: Option<Rational>));

numbers!(MatrixInequality { x: "X", e: "E", rate: "rate", value: "sigma" }
    and (w_x: Rational, h: Rational, splitting: Option<Splitting>));

numbers!(Splitting { x: "X", e: "E" } and (matrix: Vec<Vec<Rational>>));

numbers!(ExistenceInequality { x: "X", e: "E", k_p: "k_p", c_x: "c_x", c_y: "c_y", value: "sigma" }
    and (matrix: Vec<Vec<Rational>>));

numbers!(JointInequality { x: "X", e: "E", value: "sigma" } and (near: Metric, far: Metric));

numbers!(Metric { weight: "w", k_p: "k_p", c_x: "c_x", c_e: "c_e", c_y: "c_y" }
    and (matrix: Vec<Vec<Rational>>, cross: Vec<Rational>));

numbers!(Level { p_up: "P_up", x_low: "x_low", e_low: "e_low" } and ());

numbers!(SampledInequality { x: "X", e: "E", lambda: "lambda", rate: "rate", c_e: "c_e", c_y: "c_y" }
    and (w_x: Rational, eta: Rational, at: SampledLoop));

numbers!(SampledExistence {
    x: "X",
    e: "E",
    k_p: "k_p",
    c_x: "c_x",
    c_e: "c_e",
    c_y: "c_y",
    gamma: "gamma",
    lambda: "lambda"
} and (matrix: Vec<Vec<Rational>>, at: SampledLoop));

/// The paths of a witness as a field of JSON.
pub(super) fn paths_json(paths: Paths) -> (&'static str, serde_json::Value) {
    ("paths", serde_json::json!({ "f": paths.f.name(), "q": paths.q.name() }))
}

/// The paths of a witness; a certificate that names none is older than they are.
pub(super) fn read_paths(witness: &mut Object<'_>, errors: &mut Errors) -> Result<Paths, Reported> {
    let Some(value) = witness.optional("paths") else { return Ok(Paths::UNNAMED) };
    let mut fields = value.object(errors)?;
    let [f, q] = ["f", "q"].map(|name| {
        let value = fields.required(name, errors)?;
        let name = choose(&value, "path", &Path::ALL.map(Path::name), errors)?;
        // `choose` knows no other names.
        Path::ALL.into_iter().find(|path| path.name() == name).ok_or_else(|| value.wrong_type("a path", errors))
    });
    fields.finish(errors);
    Ok(Paths { f: f?, q: q? })
}

/// The sizes of a claimed set as fields of JSON: without Z_0 where the regulator sets z = M e.
pub fn set_fields(set: &ClaimedSet) -> impl Iterator<Item = (&'static str, serde_json::Value)> {
    set.named().map(|(name, size)| (name, write_exact(size).into()))
}

/// A field that holds an exact rational number.
pub(super) fn rational(object: &mut Object<'_>, name: &'static str, errors: &mut Errors) -> Result<Rational, Reported> {
    let value = object.required(name, errors)?;
    exact_rational(&value, &format!("`{name}`"), errors)
}

/// A value that is an exact rational number, and is written as one: a certificate has no expressions in their place.
pub(super) fn exact_rational(value: &Value<'_>, what: &str, errors: &mut Errors) -> Result<Rational, Reported> {
    if let Some(rational) = value.numeral().or_else(|| value.text()).and_then(parse_rational) {
        return Ok(rational);
    }
    // What is no constant at all is told as that.
    any_constant(value, errors)?;
    let message = format!("{what} is not written as a rational number");
    let expected = "expected a decimal or a fraction of whole numbers, as \"48.7\", \"1e-3\" or \"487/10\"";
    Err(errors.report(value.error(ErrorKind::Range, message).expected(expected)))
}
