//! The certificate file: self-contained, the same bytes for the same input.

use super::by_count::{claimed_counts, count_witness, counts_in_words};
use super::fields::{HARMONICS, NumberFields, paths_json, set_fields};
use super::json::{exact, object, rows, text, upper_end};
use super::of_plant::plant_parts;
use super::rates::{claimed_rates, rate_witnesses};
use super::triple::lyapunov_parts;
use super::words::statement;
use crate::certify::{Certification, Constants, Outcome, claimed_ball};
use serde_json::{Map, Value};
use sigmastar_decide::conditions::{Decided, ExceededBy, NoPlant, Proof, Witness};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::write_exact;
use sigmastar_lang::spec::{Constant, Interval, KEPT_BY, Specification};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::condition::Condition;
use sigmastar_theory::derivation::control::Control;
use sigmastar_theory::derivation::initial_set::ClaimedSet;
use sigmastar_theory::derivation::repaired::RepairedWitness;
use sigmastar_theory::derivation::table::{At, Entry, Row, Value as Cell};
use sigmastar_theory::transfer::{TransferProof, closed_form_pair};

/// The format of a certificate file.
pub const FORMAT: &str = "sigmastar/certificate";
/// The version that is written and read.
pub const VERSION: u64 = 1;

fn interval(value: &Enclosure) -> Value {
    Value::Array(value.decimals().into_iter().map(Value::String).collect())
}

/// A constant exactly, as a number where it is rational.
fn constant(value: &Constant) -> String {
    value.as_rational().map_or_else(|| value.text.clone(), write_exact)
}

/// The certificate of a certified run; `None` when nothing was certified.
///
/// It embeds the specification as read, its digest, and the rational witness from which every condition can be decided
/// again without any search. No time stamps and no paths.
#[must_use]
pub fn certificate_json(run: &Certification<'_>) -> Option<Value> {
    run.claim()?;
    // The numbers of the claim are written at the precision of the table of constants.
    let constants @ Constants { sharp, repaired, .. } = run.constants();
    let run = &Certification { sharp: sharp.clone(), ..run.clone() };
    let claimed = run.claim()?;
    let (sigma, set) = (claimed.sigma, claimed.set);
    let spec = run.spec;
    let mu = &spec.internal_model.mu;
    let heading = [
        ("verdict", text(run.verdict.to_string())),
        ("derivation", text("sharp")),
        (if spec.actuator.is_some() { "sigma" } else { "sigma_star" }, exact(sigma)),
        ("n_o", text("every n_o >= 0")),
        ("mu", text(constant(mu))),
    ];
    let every_set = run.is_for_every_set().then(|| (HARMONICS, text("every finite set that contains 0")));
    let period = spec.period.interval().map(|[low, high]| {
        let ends = [("nominal", spec.period.nominal()), ("low", low), ("high", high)];
        ("period", object(ends.map(|(name, value)| (name, text(constant(value))))))
    });
    let rest = [
        ("initial_set", set_json(spec, set)),
        ("periodic_solution", periodic_json(&run.periodic_solution()?)),
        ("control", control_json(run.control()?)),
    ];
    let counts = claimed_counts(run.by_count.as_ref());
    let of_counts = counts.as_ref().map_or_else(String::new, |(_, part)| counts_in_words(spec, (sigma, None), part));
    let said =
        ("statement", text(statement(spec, sigma, set, run.is_for_every_set()) + &run.rates_in_words() + &of_counts));
    let of_actuator = input_gain_json(spec).into_iter().chain(actuator_json(spec));
    let names = of_actuator.chain(period).chain(parameters_json(spec)).chain(rest);
    let claim = object(
        heading
            .into_iter()
            .chain(every_set)
            .chain(names)
            .chain(claimed_rates(&run.for_n_o))
            .chain(claimed_counts(run.by_count.as_ref()))
            .chain([said]),
    );
    let regulation = run.exact.as_ref().map(|exact| {
        let numbers = exact.witness.json().into_iter().chain([paths_json(exact.witness.paths)]);
        ("exact_regulation", object(numbers))
    });
    let proof = run.sharp.proved()?;
    let refined = proof.witness.refined.as_ref().map(|refined| ("refined", object(refined.json())));
    let multipliers = multipliers_json(run).map(|value| ("lmi", value));
    let of_data = lyapunov_parts(spec).into_iter().chain(plant_parts(spec)).chain(multipliers);
    let parts = refined.into_iter().chain(regulation).chain([paths_json(proof.witness.paths)]).chain(of_data);
    let witness =
        with_witness(proof, parts.chain(rate_witnesses(&run.for_n_o)).chain(count_witness(run.by_count.as_ref())));
    // The free numbers of the repaired derivation, without which its column of the constants could not be checked.
    let comparison = repaired.as_ref().and_then(Outcome::proved).map(|proof| {
        let RepairedWitness { sigma, set, .. } = &proof.witness;
        let witness = with_witness(proof, None);
        let part = [("sigma_star", exact(sigma)), ("initial_set", object(set_fields(set))), ("witness", witness)];
        ("comparison", object([("repaired", object(part))]))
    });
    let transfer = first_comparison(&Data::new(spec, claimed.precision), &claimed);
    let conditions: Vec<Condition> = run
        .conditions()
        .iter()
        .map(|condition| if condition.id == "T" { transfer.clone() } else { condition.clone() })
        .collect();
    let no_plant = run.no_plant.as_ref().map(|reason| ("no_plant", no_plant_json(reason)));
    let decided =
        [("conditions", conditions_json(&conditions)), ("constants", constants_json(&checkable(&constants.rows)))];
    let file = file(spec, claimed.precision, claim, witness).into_iter();
    Some(object(file.chain(no_plant).chain(comparison).chain(decided)))
}

/// What every certificate begins with.
pub(super) fn file(spec: &Specification, precision: u32, claim: Value, witness: Value) -> [(&'static str, Value); 8] {
    let [embedded, digest] = match spec.plant() {
        Some(_) => ["plant", "plant_sha256"],
        None => ["specification", "specification_sha256"],
    };
    [
        ("format", text(FORMAT)),
        ("version", Value::from(VERSION)),
        ("tool", object([("name", text("sigmastar")), ("version", text(env!("CARGO_PKG_VERSION")))])),
        ("precision_bits", Value::from(precision)),
        (embedded, spec.document.clone()),
        (digest, text(spec.sha256.clone())),
        ("claim", claim),
        ("witness", witness),
    ]
}

/// Upper bounds along the periodic solution.
pub(super) fn periodic_json([x, e, zeta, z]: &[Enclosure; 4]) -> Value {
    object([("x", upper_end(x)), ("e", upper_end(e)), ("zeta", upper_end(zeta)), ("z", upper_end(z))])
}

/// The interval of the input gain, for all of which the claim is; none where there is none.
pub(super) fn input_gain_json(spec: &Specification) -> Option<(&'static str, Value)> {
    let written = spec.input_gain.as_ref()?.written();
    Some(("input_gain", object(written.map(|(name, value)| (name, text(value))))))
}

/// What the actuator takes, where the claim keeps to it.
pub(super) fn actuator_json(spec: &Specification) -> Option<(&'static str, Value)> {
    let actuator = spec.actuator.as_ref()?;
    let kept_by = actuator.by_count.then(|| (KEPT_BY[0], KEPT_BY[1].to_owned()));
    let written = actuator.written().into_iter().chain(kept_by);
    Some(("actuator", object(written.map(|(name, value)| (name, text(value))))))
}

/// The intervals of the parameters, for all of which the claim is; none of a single plant.
pub(super) fn parameters_json(spec: &Specification) -> Option<(&'static str, Value)> {
    let intervals: Vec<(&str, Value)> = spec
        .plant()?
        .parameters
        .named_intervals()
        .map(|(name, Interval { nominal, low, high })| {
            let ends = [("nominal", nominal), ("low", low), ("high", high)];
            (name, object(ends.map(|(name, value)| (name, exact(value)))))
        })
        .collect();
    (!intervals.is_empty()).then(|| ("parameters", object(intervals)))
}

/// Why no plant with a state x satisfies the data: what a checker needs to decide it again.
#[must_use]
pub fn no_plant_json(reason: &NoPlant) -> Value {
    let fields = [("X", exact(&reason.x)), ("rate_at_most", interval(&reason.rate_at_most))];
    let more = match &reason.exceeded_by {
        ExceededBy::Alpha { .. } => vec![("exceeded_by", text("alpha"))],
        ExceededBy::Rate { .. } => vec![("exceeded_by", text("rate"))],
        ExceededBy::Jacobian { fraction, column, .. } => {
            vec![("exceeded_by", text("jacobian")), ("t", exact(fraction)), ("column", Value::from(*column))]
        }
    };
    object(fields.into_iter().chain(more))
}

/// The multipliers with which the matrix inequality of C5 was proved, for a claim of the sharp derivation.
fn multipliers_json(run: &Certification<'_>) -> Option<Value> {
    let checks = &run.checks;
    let [l_x, l_e, l_f] = checks.decay.iter().flatten().find_map(|check| check.multipliers.as_ref())?;
    Some(object([("l_x", exact(l_x)), ("l_e", exact(l_e)), ("l_f", exact(l_f))]))
}

/// The first comparison of a transfer proof: T_N(0) <= k0, or k0 against the closed form.
///
/// A certificate shows this one, not the tightest: the two sides of a box are no numbers that a checker with other
/// enclosures could find again.
fn first_comparison(data: &Data<'_>, claim: &Decided<'_>) -> Condition {
    let (proof, [k0, _]) = (claim.transfer, claim.pair);
    let at_zero = || data.transfer_at_zero();
    let (what, lhs) = match proof {
        TransferProof::ClosedForm => ("closed form of k0", closed_form_pair(data).0),
        TransferProof::Matched { .. } => ("k = 0: 1/(nu^2 n_0) <= k0", at_zero()),
        TransferProof::Boxes(_) => ("T_N(0) = 1/(nu^2 n_0) <= k0", at_zero()),
    };
    Condition::at_most("T", format!("transfer bound, {}: {what}", proof.name()), lhs, data.rational(k0))
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

/// Upper bounds of the control.
pub(super) fn control_json(Control { steady, transient }: &Control<Enclosure>) -> Value {
    object([("steady", upper_end(steady)), ("transient", upper_end(transient))])
}

pub(super) fn set_json(spec: &Specification, set: &ClaimedSet) -> Value {
    let kind = spec.initial_set.kind();
    let ball = spec.plant().and_then(|plant| claimed_ball(plant, &set.x0));
    let ball = ball.map(|ball| ("ball", exact(&ball)));
    object([("kind", text(kind))].into_iter().chain(set_fields(set)).chain(ball))
}

fn transfer_json(proof: &TransferProof) -> Value {
    match proof {
        TransferProof::ClosedForm => object([("proof", text(proof.name()))]),
        TransferProof::Matched { k } => object([("proof", text(proof.name())), ("K", Value::from(*k))]),
        TransferProof::Boxes(boxes) => object([
            ("proof", text(proof.name())),
            ("m0", Value::from(boxes.m0)),
            ("N0", Value::from(boxes.n0)),
            ("boxes", rows(&boxes.breaks)),
        ]),
    }
}

/// A proof with its witness as JSON: the numbers, the transfer proof, and further parts.
fn with_witness<W: Witness + NumberFields>(
    proof: &Proof<W>,
    parts: impl IntoIterator<Item = (&'static str, Value)>,
) -> Value {
    let transfer = ("transfer", transfer_json(proof.decided().transfer));
    object(proof.witness.json().into_iter().chain([transfer]).chain(parts))
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
            ("margin", text(condition.margin().lower_decimal(sigmastar_exact::enclosure::DIGITS))),
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
