//! The certificate file: self-contained, the same bytes for the same input.

use super::lyapunov::lyapunov_json;
use super::no_plant::{ExceededBy, NoPlant};
use super::run::{Certification, Derivation};
use crate::data::Data;
use crate::derivation::condition::Condition;
use crate::derivation::exact_regulation::ExactWitness;
use crate::derivation::repaired::RepairedWitness;
use crate::derivation::sharp::{ClaimedSet, SharpWitness};
use crate::derivation::table::{At, Entry, Row, Value as Cell};
use crate::enclosure::Enclosure;
use crate::number::{Direction, round_rational, write_exact};
use crate::spec::model::{InitialSet, LyapunovSource};
use crate::transfer::{TransferProof, closed_form_pair};
use rug::Rational;
use serde_json::{Map, Value};

/// The format of a certificate file.
pub const FORMAT: &str = "sigmastar/certificate";
/// The version that is written and read.
pub const VERSION: u64 = 1;

/// Significant digits of the upper ends in a claim.
const CLAIM_DIGITS: u32 = 12;

/// An object from pairs, in their order.
fn object<const N: usize>(fields: [(&str, Value); N]) -> Value {
    Value::Object(fields.into_iter().map(|(name, value)| (name.to_owned(), value)).collect())
}

fn text(value: impl Into<String>) -> Value {
    Value::String(value.into())
}

fn exact(value: &Rational) -> Value {
    text(write_exact(value))
}

fn interval(value: &Enclosure) -> Value {
    Value::Array(value.decimals().into_iter().map(Value::String).collect())
}

/// An upper end, rounded up; the text "inf" when there is none.
fn upper_end(value: &Enclosure) -> Value {
    match value.upper_rational() {
        Some(upper) => exact(&round_rational(&upper, CLAIM_DIGITS, Direction::Up)),
        None => text("inf"),
    }
}

/// The certificate of a certified run; `None` when nothing was certified.
///
/// It embeds the specification as read, its digest, and the rational witness from which every condition can be decided
/// again without any search. No time stamps and no paths.
#[must_use]
pub fn certificate_json(run: &Certification<'_>) -> Option<Value> {
    let sigma = run.sigma_star()?;
    let set = run.claimed_set()?;
    let [x, e, zeta, z] = run.periodic_solution()?;
    let spec = run.spec;
    let mu = &spec.internal_model.mu;
    let claim = object([
        ("verdict", text(run.verdict.to_string())),
        ("derivation", text(run.options.derivation.name())),
        ("sigma_star", exact(sigma)),
        ("n_o", text("every n_o >= 0")),
        ("mu", text(mu.as_rational().map_or_else(|| mu.text.clone(), write_exact))),
        ("initial_set", set_json(&spec.initial_set, set)),
        (
            "periodic_solution",
            object([("x", upper_end(&x)), ("e", upper_end(&e)), ("zeta", upper_end(&zeta)), ("z", upper_end(&z))]),
        ),
        ("statement", text(statement(run, sigma, set))),
    ]);
    let regulation = run.exact.as_ref().map(|claim| &claim.witness);
    let sharp =
        run.sharp.proved().map(|proof| (proof.precision, &proof.witness, sharp_json(&proof.witness, regulation)));
    let repaired = run.repaired.proved().map(|proof| (proof.precision, &proof.witness, repaired_json(&proof.witness)));
    // The free numbers of the other derivation, without which its column of the constants could not be checked.
    let (witness, precision, comparison, transfer) = match run.options.derivation {
        Derivation::Sharp => {
            let (precision, main, witness) = sharp?;
            let other = repaired.map(|(_, w, witness)| ("repaired", comparison_json(&w.sigma, &w.set, witness)));
            let first = first_comparison(&Data::new(spec, precision), [&main.k0, &main.k1], &main.transfer);
            (witness, precision, other, first)
        }
        Derivation::Repaired => {
            let (precision, main, witness) = repaired?;
            let other = sharp.map(|(_, w, witness)| ("sharp", comparison_json(&w.sigma, &w.set, witness)));
            let first = first_comparison(&Data::new(spec, precision), [&main.k0, &main.k1], &main.transfer);
            (witness, precision, other, first)
        }
        Derivation::Printed => return None,
    };
    let conditions: Vec<Condition> = run
        .conditions()
        .iter()
        .map(|condition| if condition.id == "T" { transfer.clone() } else { condition.clone() })
        .collect();
    let mut witness = witness;
    if let Value::Object(fields) = &mut witness {
        fields.extend(lyapunov_json(spec).map(|value| ("lyapunov".to_owned(), value)));
        fields.extend(multipliers_json(run).map(|value| ("lmi".to_owned(), value)));
    }
    let mut certificate = object([
        ("format", text(FORMAT)),
        ("version", Value::from(VERSION)),
        ("tool", object([("name", text(env!("CARGO_PKG_NAME"))), ("version", text(env!("CARGO_PKG_VERSION")))])),
        ("precision_bits", Value::from(precision)),
        ("specification", spec.document.clone()),
        ("specification_sha256", text(spec.sha256.clone())),
        ("claim", claim),
        ("witness", witness),
    ]);
    // The object was made above.
    if let Value::Object(fields) = &mut certificate {
        fields.extend(run.no_plant.as_ref().map(|reason| ("no_plant".to_owned(), no_plant_json(reason))));
        fields.extend(comparison.map(|(name, part)| ("comparison".to_owned(), object([(name, part)]))));
        fields.insert("conditions".to_owned(), conditions_json(&conditions));
        fields.insert("constants".to_owned(), constants_json(&checkable(&run.constants)));
    }
    Some(certificate)
}

/// Why no plant with a state x satisfies the data: what a checker needs to decide it again.
#[must_use]
pub fn no_plant_json(reason: &NoPlant) -> Value {
    let mut fields = object([("X", exact(&reason.x)), ("rate_at_most", interval(&reason.rate_at_most))]);
    let more = match &reason.exceeded_by {
        ExceededBy::Alpha { .. } => vec![("exceeded_by", text("alpha"))],
        ExceededBy::Jacobian { fraction, column, .. } => {
            vec![("exceeded_by", text("jacobian")), ("t", exact(fraction)), ("column", Value::from(*column))]
        }
    };
    // The object was made above.
    if let Value::Object(fields) = &mut fields {
        fields.extend(more.into_iter().map(|(name, value)| (name.to_owned(), value)));
    }
    fields
}

/// The multipliers with which the matrix inequality of C5 was proved, for a claim of the sharp derivation.
fn multipliers_json(run: &Certification<'_>) -> Option<Value> {
    let checks = (run.options.derivation == Derivation::Sharp).then_some(&run.checks)?;
    let [l_x, l_e, l_f] = checks.decay.iter().flatten().find_map(|check| check.multipliers.as_ref())?;
    Some(object([("l_x", exact(l_x)), ("l_e", exact(l_e)), ("l_f", exact(l_f))]))
}

/// The first comparison of a transfer proof: T_N(0) <= k0, or k0 against the closed form.
///
/// A certificate shows this one, not the tightest: the two sides of a box are no numbers that a checker with other
/// enclosures could find again.
fn first_comparison(data: &Data<'_>, [k0, _]: [&Rational; 2], proof: &TransferProof) -> Condition {
    let at_zero = || data.transfer_at_zero();
    let (what, lhs) = match proof {
        TransferProof::ClosedForm => ("closed form of k0", closed_form_pair(data).0),
        TransferProof::Matched { .. } => ("k = 0: 1/(nu^2 n_0) <= k0", at_zero()),
        TransferProof::Boxes(_) => ("T_N(0) = 1/(nu^2 n_0) <= k0", at_zero()),
    };
    Condition::at_most("T", format!("transfer bound, {}: {what}", proof.name()), lhs, data.rational(k0))
}

/// A witness of the derivation that the claim is not about.
fn comparison_json(sigma: &Rational, set: &ClaimedSet, witness: Value) -> Value {
    let set = object([("X0", exact(&set.x0)), ("E0", exact(&set.e0)), ("Z0", exact(&set.z0))]);
    object([("sigma_star", exact(sigma)), ("initial_set", set), ("witness", witness)])
}

/// The rows without the printed figures at the paper's own free numbers. No claim rests on them, and their free numbers
/// are not in the certificate, so no checker could find them again; the report has them.
fn checkable(rows: &[Row]) -> Vec<Row> {
    let keep = |row: &Row| {
        // What E1 and E2 refute, they refute from the data alone.
        let from_data = ["P:eq:boundx_bounde_1", "P:thm1", "P:eq:bound_sigma_inf"];
        let refuted = |entry: &Entry| matches!(entry.value, Cell::Infeasible(_)) && from_data.contains(&entry.source);
        let printed = row.printed.clone().filter(|entry| row.at != At::Own || refuted(entry));
        Row { printed, ..row.clone() }
    };
    let some = |row: &Row| row.printed.is_some() || row.repaired.is_some() || row.sharp.is_some();
    rows.iter().map(keep).filter(some).collect()
}

/// The claim in words: with what it speaks of (period, regulator, data) and what of that is given and not proved.
#[must_use]
pub fn statement(run: &Certification<'_>, sigma: &Rational, set: &ClaimedSet) -> String {
    let spec = run.spec;
    let model = &spec.internal_model;
    let reach = if model.matched { "" } else { " (which need not match the period)" };
    let domain = spec
        .domain
        .as_ref()
        .map_or_else(String::new, |domain| format!(" (for |x| <= {}, |e| <= {})", domain.x.text, domain.e.text));
    let triple = match &spec.lyapunov {
        LyapunovSource::Given(triple) => format!(
            "with the Lyapunov triple p_low = {}, p_up = {}, alpha = {} (given, not proved)",
            triple.p_low.text, triple.p_up.text, triple.alpha.text
        ),
        LyapunovSource::Wanted(_) | LyapunovSource::Proved { .. } => {
            "whose df/dx(t,0,0) is in the family of the Jacobian (its Lyapunov triple is proved)".to_owned()
        }
    };
    format!(
        "For every number of oscillators n_o >= 0 and every gain sigma >= {}, with period T = {}, mu = {} and base \
         frequency {}{reach}, every plant within the bounding functions{domain} and {triple} has a T-periodic \
         solution of the closed loop to which every solution from |x| <= {}, |e| <= {}, sqrt(z'Nz) <= {}, at \
         any initial time, converges exponentially.",
        write_exact(sigma),
        spec.period.text,
        model.mu.text,
        model.base_frequency.text,
        write_exact(&set.x0),
        write_exact(&set.e0),
        write_exact(&set.z0),
    )
}

fn set_json(asked: &InitialSet, set: &ClaimedSet) -> Value {
    let kind = match asked {
        InitialSet::Paper => "paper",
        InitialSet::AtRest { .. } => "at-rest",
        InitialSet::Box { .. } => "box",
    };
    object([("kind", text(kind)), ("X0", exact(&set.x0)), ("E0", exact(&set.e0)), ("Z0", exact(&set.z0))])
}

fn transfer_json(proof: &TransferProof) -> Value {
    match proof {
        TransferProof::ClosedForm => object([("proof", text(proof.name()))]),
        TransferProof::Matched { k } => object([("proof", text(proof.name())), ("K", Value::from(*k))]),
        TransferProof::Boxes(boxes) => {
            let list = |breaks: &Vec<Rational>| Value::Array(breaks.iter().map(exact).collect());
            object([
                ("proof", text(proof.name())),
                ("m0", Value::from(boxes.m0)),
                ("N0", Value::from(boxes.n0)),
                ("boxes", Value::Array(boxes.breaks.iter().map(list).collect())),
            ])
        }
    }
}

fn sharp_json(witness: &SharpWitness, regulation: Option<&ExactWitness>) -> Value {
    let mut fields = Map::new();
    let numbers = [
        ("X_p", &witness.x_p),
        ("E_p", &witness.e_p),
        ("D_x", &witness.d_x),
        ("D_e", &witness.d_e),
        ("p_x", &witness.p_x),
        ("p_e", &witness.p_e),
        ("w_x", &witness.w_x),
        ("h", &witness.h),
        ("k0", &witness.k0),
        ("k1", &witness.k1),
    ];
    fields.extend(numbers.map(|(name, value)| (name.to_owned(), exact(value))));
    fields.insert("transfer".to_owned(), transfer_json(&witness.transfer));
    if let Some(regulation) = regulation {
        let part = object([
            ("sigma_star_oo", exact(&regulation.sigma)),
            ("D_x", exact(&regulation.d_x)),
            ("D_e", exact(&regulation.d_e)),
            ("w_x", exact(&regulation.w_x)),
            ("h", exact(&regulation.h)),
        ]);
        fields.insert("exact_regulation".to_owned(), part);
    }
    Value::Object(fields)
}

fn repaired_json(witness: &RepairedWitness) -> Value {
    object([
        ("X", exact(&witness.x)),
        ("E", exact(&witness.e)),
        ("L", exact(&witness.level)),
        ("h", exact(&witness.h)),
        ("p_x", exact(&witness.p_x)),
        ("p_e", exact(&witness.p_e)),
        ("k0", exact(&witness.k0)),
        ("k1", exact(&witness.k1)),
        ("transfer", transfer_json(&witness.transfer)),
    ])
}

/// Conditions with outward-rounded sides, and the margin rounded down.
#[must_use]
pub fn conditions_json(conditions: &[Condition]) -> Value {
    let one = |condition: &Condition| {
        object([
            ("id", text(condition.id)),
            ("what", text(condition.what.clone())),
            ("relation", text(condition.relation.to_string())),
            ("lhs", interval(&condition.lhs)),
            ("rhs", interval(&condition.rhs)),
            ("margin", text(condition.margin().lower_decimal(crate::enclosure::DIGITS))),
        ])
    };
    Value::Array(conditions.iter().map(one).collect())
}

/// The table of constants: one object a constant, one entry a derivation.
#[must_use]
pub fn constants_json(rows: &[Row]) -> Value {
    let one = |row: &Row| {
        let mut fields = Map::new();
        fields.insert("evaluated_at".to_owned(), text(row.at.name()));
        for (name, entry) in [("printed", &row.printed), ("repaired", &row.repaired), ("sharp", &row.sharp)] {
            if let Some(entry) = entry {
                fields.insert(name.to_owned(), entry_json(entry));
            }
        }
        (row.name.clone(), Value::Object(fields))
    };
    Value::Object(rows.iter().map(one).collect())
}

fn entry_json(entry: &Entry) -> Value {
    let (name, value) = match &entry.value {
        Cell::Number(value) | Cell::Span(value) => ("value", interval(value)),
        Cell::Infeasible(reason) | Cell::Unavailable(reason) => ("reason", text(reason.clone())),
    };
    object([(name, value), ("status", text(entry.status.name())), ("source", text(entry.source))])
}
