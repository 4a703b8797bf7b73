//! The record `numbers` of `proofs-check/coq/Sizes.v`: specification, claim and witness, field by field.

use super::terms::{Fields, constant, function, number, option, unsupported};
use super::{Parts, plants};
use proofs_core::bound::{BOUND_NAMES, Bound};
use proofs_core::expr::Expr;
use proofs_core::input_gain::factors;
use proofs_core::interval::Interval;
use proofs_core::range::Range;
use proofs_core::rules::inequality::Inequality;
use proofs_core::rules::paths::Path;
use proofs_core::rules::transfer::Proof;
use proofs_core::spec::{Forcing, Size, Specification};
use proofs_core::verdict::Outcome;
use proofs_core::weights::Weights;

/// How many weights are added up before the rest is bounded by three terms (`WeightSum.v`): square roots are quick to enclose, other
/// powers are not.
const TERMS: u32 = 128;
const TERMS_OF_POWERS: u32 = 64;

/// Of the choices that are made here; Coq decides them again.
const PRECISION: u32 = 128;

/// The fields, one a line.
pub fn record(parts: &Parts) -> Outcome<String> {
    let mut fields = of_specification(parts)?;
    fields.extend(of_witness(parts));
    let lines: Vec<String> = fields.into_iter().map(|(name, value)| format!("  {name} := {value}")).collect();
    Ok(lines.join(";\n"))
}

fn of_specification(parts: &Parts) -> Outcome<Fields> {
    let spec = &parts.spec;
    let at = |name: &str| format!("/specification/{name}");
    let triple = [("p_low", &spec.p_low), ("p_up", &spec.p_up), ("alpha", &spec.alpha)];
    let second =
        spec.existence.as_ref().map_or([&spec.p_low, &spec.p_up, &spec.alpha], |(_, triple)| triple.each_ref());
    let mut fields = vec![("period", constant(&spec.period.nominal, &at("period"))?)];
    for (name, value) in triple {
        fields.push((name, constant(value, &at("lyapunov"))?));
    }
    for (name, value) in ["p_low'", "p_up'", "alpha'"].into_iter().zip(second) {
        fields.push((name, constant(value, &at("lyapunov"))?));
    }
    fields.push((
        "gain",
        option(spec.input_gain.as_ref().filter(|gain| !gain.is_nominal()).map(input_gain).transpose()?),
    ));
    fields.push(("mu", constant(&spec.regulator.mu, &at("internal_model/mu"))?));
    fields.push(("w", constant(&spec.regulator.base_frequency, &at("internal_model/base_frequency"))?));
    let matched = matches!(parts.witness.transfer, Proof::Matched(_));
    fields.push(("matched", matched.to_string()));
    fields.extend(weights(&spec.regulator.weights)?);
    fields.push(("forcing", option(spec.q_0.as_ref().map(harmonics).transpose()?)));
    fields.extend(match &spec.plant {
        Some(plant) => plants::known(parts, plant)?,
        None => functions(spec)?,
    });
    Ok(fields)
}

/// The bounding functions of a specification.
fn functions(spec: &Specification) -> Outcome<Fields> {
    let at = |name: &str| format!("/specification/{name}");
    let bound = |bound: Bound| {
        let pointer = at(&format!("bounds/{}", BOUND_NAMES[bound as usize]));
        let print = |expr: &Expr| function(expr, &pointer);
        spec.bounds[bound as usize].as_ref().map(print).transpose()
    };
    let required = |names: &[(&'static str, Bound)]| {
        let mut fields = Fields::new();
        for (name, which) in names {
            let Some(text) = bound(*which)? else {
                return unsupported(&at("bounds"), "a bounding function is missing");
            };
            fields.push((name, text));
        }
        Ok(fields)
    };
    let beyond =
        [("b_f", Bound::F), ("b_fxx", Bound::Fxx), ("b_fex", Bound::Fex), ("b_q", Bound::Q), ("b_qt", Bound::Qt)];
    let beyond: Vec<String> = required(&beyond)?.iter().map(|(name, text)| format!("{name} := {text}")).collect();
    let mut fields = required(&[("b_fe", Bound::Fe), ("b_qe", Bound::Qe), ("b_qx", Bound::Qx)])?;
    fields.push(("known", format!("by_functions {{| {} |}}", beyond.join("; "))));
    let optional =
        [("b_q_rms", Bound::QRms), ("b_qt_rms", Bound::QtRms), ("b_fx", Bound::Fx), ("q_e_max", Bound::QeMax)];
    for (name, which) in optional {
        fields.push((name, option(bound(which)?)));
    }
    let rate = spec.rate.as_ref().map(|expr| function(expr, &at("lyapunov/rate"))).transpose()?;
    fields.push(("rate", option(rate)));
    for (name, which) in [("q_tx", Bound::Qtx), ("q_te", Bound::Qte)] {
        fields.push((name, option(bound(which)?)));
    }
    let domain = match &spec.domain {
        Some([x, e]) => Some(format!("{}, {}", constant(x, &at("domain/X"))?, constant(e, &at("domain/E"))?)),
        None => None,
    };
    fields.push(("domain", option(domain)));
    Ok(fields)
}

/// b_lo and b_hi; what is used where 1/2 <= b_lo is then a condition.
fn input_gain(gain: &Range) -> Outcome<String> {
    let [nominal, low, high] =
        [&gain.nominal, &gain.low, &gain.high].map(|value| constant(value, "/specification/input_gain"));
    let (nominal, [b_lo, _]) = (nominal?, factors(gain, PRECISION));
    let half = Interval::int(1, PRECISION).le(&(b_lo * 2)) == Some(true);
    Ok(format!("{{| low := ({} / {nominal}); high := ({} / {nominal}); half := {half} |}}", low?, high?))
}

/// (E).
fn inequality(given: &Inequality) -> String {
    let [x, e, threshold] = [&given.at[0], &given.at[1], &given.sigma].map(number);
    let form = match &given.far {
        None => {
            let [c_x, _, c_y] = given.metric.least.each_ref().map(number);
            format!("one {} {c_x} {c_y}", plants::k_p(&given.metric))
        }
        Some(far) => format!("two {} {}", plants::metric(&given.metric), plants::metric(far)),
    };
    format!("{{| X_i := {x}; E_i := {e}; tau_i := {threshold}; form_i := {form} |}}")
}

/// n_0, n_1, ... and a number that is at least their sum.
fn weights(given: &Weights) -> Outcome<Fields> {
    let place = "/specification/internal_model/weights";
    let (values, coefficient, exponent) = given.written();
    let values = values.iter().map(|value| constant(value, place)).collect::<Outcome<Vec<_>>>()?;
    // The tail is l^-(1+eps). The theorems about square roots are of `1 / 2` as it is written here.
    let past = u32::from(coefficient.is_some());
    let half = exponent.rational().is_some_and(|exponent| (exponent - past) * 2u32 == 1);
    let eps = match (half, coefficient) {
        (true, _) => "(1 / 2)".to_owned(),
        (false, None) => constant(exponent, place)?,
        (false, Some(_)) => format!("({} - 1)", constant(exponent, place)?),
    };
    let terms = if half { TERMS } else { TERMS_OF_POWERS };
    let [family, total] = match (coefficient, values.first()) {
        (None, Some(n_0)) => [format!("power {n_0} {eps}"), format!("power_total {n_0} {eps} {terms}")],
        (None, None) => return unsupported(place, "no weight is given"),
        (Some(coefficient), _) => {
            let (list, coefficient) = (list(&values), constant(coefficient, place)?);
            ["explicit", "explicit_total"].map(|name| format!("{name} {list} {coefficient} {eps}"))
        }
    };
    let total = if coefficient.is_some() { format!("{total} {terms}") } else { total };
    Ok(vec![("n", family), ("n_bar2", total)])
}

/// A list of terms.
fn list(terms: &[String]) -> String {
    terms.iter().rfold("nil".to_owned(), |rest, term| format!("(cons {term} {rest})"))
}

/// The bounds of `q_0`.
fn harmonics(given: &Forcing) -> Outcome<String> {
    let size = |size: &Size| match size {
        Size::Constant(value) => constant(value, "/specification/q_0"),
        Size::Number(value) => Ok(number(value)),
        Size::Root(square) => Ok(format!("(sqrt {})", number(square))),
    };
    let sizes = given.harmonics.iter().map(size).collect::<Outcome<Vec<_>>>()?;
    let list = list(&sizes);
    let rest_t = option(given.rest_t_rms.as_ref().map(size).transpose()?);
    Ok(format!("{{| C_k := {list}; r_0 := {}; r_t := {rest_t} |}}", size(&given.rest_rms)?))
}

fn of_witness(parts: &Parts) -> Fields {
    let (witness, free) = (&parts.witness, &parts.free);
    let [r_x, r_e, r_d] = &witness.existence.r;
    let damped = (witness.existence.kap > 0).then(|| {
        let kap = &witness.existence.kap;
        // Which form of g_k is used; where it is the smaller one, kap <= (2 - b_lo) sigma is a condition.
        let least = parts
            .spec
            .input_gain
            .as_ref()
            .map_or_else(|| Interval::int(1, PRECISION), |gain| factors(gain, PRECISION)[0].clone());
        let [kap_, sigma] = [kap, &witness.sigma].map(|value| Interval::rational(value, PRECISION));
        let small = kap_.le(&((2 - least) * sigma)) == Some(true);
        format!("{{| kap := {}; kap_small := {small} |}}", number(kap))
    });
    let refined = witness.existence.refined.as_ref().map(|means| means.each_ref().map(number).join(", "));
    let path = |path: Path| {
        let name = match path {
            Path::StateFirst => "x_first",
            Path::ErrorFirst => "e_first",
            Path::Straight => "straight",
        };
        name.to_owned()
    };
    vec![
        ("sigma", number(&witness.sigma)),
        ("X_0", number(&free.set.x0)),
        ("E_0", number(&free.set.e0)),
        ("Z_0", option(free.set.z0.as_ref().map(number))),
        ("X_p", number(&free.x_p)),
        ("E_p", number(&free.e_p)),
        ("r_x", number(r_x)),
        ("r_e", number(r_e)),
        ("r_d", number(r_d)),
        ("damped", option(damped)),
        ("existence", option(parts.inequalities.existence.as_ref().map(inequality))),
        ("refined", option(refined)),
        ("D_x", number(&free.d_x)),
        ("D_e", number(&free.d_e)),
        ("w_x", number(&free.w_x)),
        ("h", number(&free.h)),
        ("k_0", number(&free.k0)),
        ("k_1", number(&free.k1)),
        ("path_f", path(free.paths.f)),
        ("path_q", path(free.paths.q)),
    ]
}
