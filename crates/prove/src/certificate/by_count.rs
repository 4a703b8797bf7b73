//! What a certificate says of each number of oscillators, and what proves it (derivation, 14).

use super::fields::HARMONICS;
use super::json::{exact, object, rows, series, vector, with_room};
use crate::certify::{ByCount, CountBounds, CountProof, LoopSizes};
use rug::Rational;
use serde_json::{Value, json};
use sigmastar_decide::bounds::{StatesForm, WithinSample};
use sigmastar_decide::linear::Falling;
use sigmastar_decide::trial::{OrMore, Trial, TubeProof, XFirst};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::write_exact;
use sigmastar_lang::plant::CurveTerm;
use sigmastar_lang::spec::{Level, Metric, Oscillators, Specification};

/// The name of both parts.
pub(super) const BY_N_O: &str = "by_n_o";

/// In which field of an entry its oscillators stand, and how.
pub(super) fn place_of(oscillators: &Oscillators) -> (&'static str, Value) {
    match oscillators.n_o() {
        Some(n_o) => ("n_o", n_o.into()),
        None => (HARMONICS, oscillators.all().collect::<Vec<u32>>().into()),
    }
}

/// The part of the claim; none where nothing is claimed.
pub(super) fn claimed_counts(found: Option<&ByCount>) -> Option<(&'static str, Value)> {
    let found = found.filter(|found| found.checked)?;
    let room = found.room();
    let one = |bounds: &CountBounds| {
        let CountBounds { oscillators, or_more, steady_error, mean_square, steady_control, largest, .. } = bounds;
        let numbers = |numbers: &[(&'static str, &Enclosure)]| {
            object(numbers.iter().map(|(name, value)| (*name, with_room(value, room))))
        };
        let mut part = object([place_of(oscillators)]);
        if *or_more {
            part["or_more"] = true.into();
        }
        part["steady"] = numbers(&[("e", steady_error), ("e_rms", mean_square), ("u", steady_control)]);
        if let Some((largest, control)) = largest.as_ref().zip(bounds.largest_control()) {
            part["largest"] = numbers(&[("e", &largest.error), ("u", &control)]);
        }
        part
    };
    Some((BY_N_O, found.counts.iter().map(one).collect()))
}

/// The sentences of the claim about them, each with a space before it, from that part of it; at samples with their number in a period.
pub(super) fn counts_in_words(
    spec: &Specification,
    (sigma, samples): (&Rational, Option<u32>),
    part: &Value,
) -> String {
    let undisturbed = match spec.disturbances.disturb(samples.is_some()) {
        true => " without noise, disturbance and rounding,",
        false => "",
    };
    let below = samples.map_or_else(String::new, |samples| format!(" below {samples}/2"));
    let output = spec.input_gain.as_ref().map_or_else(
        || "u".to_owned(),
        |gain| {
            let nominal = gain.nominal.words();
            // Another quotient or product is one number.
            if nominal.parse::<f64>().is_ok() { format!("u/{nominal}") } else { format!("u/({nominal})") }
        },
    );
    let one = |entry: &Value| {
        let which = match entry[HARMONICS].as_array() {
            Some(all) => {
                let all: Vec<String> = all.iter().map(Value::to_string).collect();
                format!("oscillators at the harmonics {}", all.join(", "))
            }
            None => {
                let n_o = &entry["n_o"];
                if entry["or_more"] == true { format!("every n_o >= {n_o}{below}") } else { format!("n_o = {n_o}") }
            }
        };
        let number = |part: &str, name: &str| {
            let text = entry[part][name].as_str().unwrap_or_default();
            if text.contains('/') { format!("({text})") } else { text.to_owned() }
        };
        let [e, rms, u] = ["e", "e_rms", "u"].map(|name| number("steady", name));
        let largest = entry.get("largest").map_or_else(String::new, |_| {
            let [e, u] = ["e", "u"].map(|name| number("largest", name));
            format!(", and |e| <= {e} and |{output}| <= {u} at all times for these solutions")
        });
        format!(
            " With {which} and sigma = {} exactly,{undisturbed} |e| <= {e} (root mean square <= {rms}) and |{output}| <= {u} along the T-periodic \
             solution{largest}.",
            write_exact(sigma)
        )
    };
    part.as_array().into_iter().flatten().map(one).collect()
}

/// The part of the witness.
pub(super) fn count_witness(found: Option<&ByCount>) -> Option<(&'static str, Value)> {
    let found = found.filter(|found| found.checked)?;
    let sizes = |bounds: &CountBounds, [of_states, of_past]: [bool; 2]| {
        let LoopSizes { states, zeta, mean } = &bounds.sizes;
        let all = [(of_states, "x", states), (true, "zeta", zeta), (of_past, "y", mean)];
        let there = all.into_iter().filter(|(is_there, ..)| *is_there);
        object(there.map(|(_, name, size)| (name, with_room(size, found.room_of_sizes()))))
    };
    let part = match &found.proof {
        CountProof::Linear { forms } => {
            let has_states = forms.iter().any(|form| !form.matrix.is_empty());
            let has_past = forms.iter().any(|form| form.held.as_ref().is_some_and(|held| held.past.is_some()));
            let sizes = found.counts.iter().map(|bounds| sizes(bounds, [has_states, has_past])).collect();
            ("linear", object([("forms", forms.iter().map(falling).collect()), ("sizes", sizes)]))
        }
        CountProof::Trials(trials) => {
            let one = |((trial, proof), bounds): (&(Trial, TubeProof), &CountBounds)| {
                let mut part = of_trial(trial, proof);
                part["sizes"] = sizes(bounds, [proof.states.is_some(), false]);
                part
            };
            ("trials", trials.iter().zip(&found.counts).map(one).collect())
        }
    };
    Some((BY_N_O, object([part])))
}

fn falling(Falling { matrix, p_up, weight, k_p, held }: &Falling) -> Value {
    let numbers = [("P", rows(matrix)), ("p_up", exact(p_up)), ("w", exact(weight)), ("k_p", exact(k_p))];
    let past = held.as_ref().and_then(|held| held.past.as_ref());
    let at_samples = held.iter().map(|held| ("lambda", exact(&held.lambda)));
    object(numbers.into_iter().chain(at_samples).chain(past.map(|past| ("gm", exact(past)))))
}

fn of_trial(trial: &Trial, proof: &TubeProof) -> Value {
    let TubeProof { defects: [d_x, d_q], radii, slopes, forms, states, or_more, x_first, within } = proof;
    let has_states = states.is_some();
    let curves = |CurveTerm { states, error, control, .. }: &CurveTerm| {
        let states = has_states.then(|| ("x", object(series("mean", states, |part| vector(part)))));
        let error = object(series("mean", error, exact).into_iter().filter(|(name, _)| *name != "mean"));
        states.into_iter().chain([("e", error), ("u", object(series("mean", control, exact)))])
    };
    let member = |term: &CurveTerm| object([("powers", json!(term.powers))].into_iter().chain(curves(term)));
    let members: Vec<Value> = trial.terms.iter().skip(1).map(member).collect();
    let members = (!members.is_empty()).then(|| ("members", Value::from(members)));
    let pair = |[x, e]: &[Rational; 2], names: [&'static str; 2]| {
        let x = has_states.then(|| (names[0], exact(x)));
        x.into_iter().chain([(names[1], exact(e))]).collect::<Vec<_>>()
    };
    let form = |(metric, level): &(Metric, Level)| {
        let Metric { matrix, cross, weight, k_p, c_x, c_e, c_y } = metric;
        let Level { p_up, x_low, e_low } = level;
        let numbers = [("w", weight), ("k_p", k_p), ("c_x", c_x), ("c_e", c_e), ("c_y", c_y)];
        let ends = [("P_up", p_up), ("x_low", x_low), ("e_low", e_low)];
        let numbers = numbers.into_iter().chain(ends).map(|(name, value)| (name, exact(value)));
        object([("P", rows(matrix)), ("p", vector(cross))].into_iter().chain(numbers))
    };
    let bound = |StatesForm { matrix, q_low, q_up, c, gamma }: &StatesForm| {
        let numbers = [("Q_low", q_low), ("Q_up", q_up), ("c", c), ("gamma", gamma)];
        object([("Q", rows(matrix))].into_iter().chain(numbers.map(|(name, value)| (name, exact(value)))))
    };
    let curves = trial.terms.first().into_iter().flat_map(curves).chain(members);
    let numbers = pair(&[d_x.clone(), d_q.clone()], ["defect_x", "defect_q"]).into_iter();
    let numbers = numbers.chain([("box", object(pair(radii, ["x", "e"])))]).chain(pair(slopes, ["q_x", "q_e"]));
    let with_sample = |(i, metric_and_level): (usize, &(Metric, Level))| {
        let mut part = form(metric_and_level);
        if let Some(WithinSample { lambda, gamma }) = within.get(i) {
            (part["lambda"], part["gamma"]) = (exact(lambda), exact(gamma));
        }
        part
    };
    let forms = [("forms", forms.iter().enumerate().map(with_sample).collect())];
    let more = or_more.iter().flat_map(|OrMore { defect_t, in_time, states: [f_x, f_e] }| {
        let of_states = has_states.then(|| [("f_x", exact(f_x)), ("f_e", exact(f_e))]);
        let numbers = pair(in_time, ["q_tx", "q_te"]).into_iter().chain(of_states.into_iter().flatten());
        std::iter::once(("defect_q_t", exact(defect_t))).chain(numbers)
    });
    let states = states.as_ref().map(|form| ("states", bound(form)));
    let x_first = x_first.as_ref().map(|XFirst { radii, eta, forms, splittings }| {
        let with_splitting = |(metric_and_level, s): (&(Metric, Level), &Vec<Vec<Rational>>)| {
            let mut part = form(metric_and_level);
            part["S"] = rows(s);
            part
        };
        let forms = ("forms", forms.iter().zip(splittings).map(with_splitting).collect());
        ("x_first", object([("box", object(pair(radii, ["x", "e"]))), ("E", exact(eta)), forms]))
    });
    object(curves.chain(numbers).chain(forms).chain(states).chain(more).chain(x_first))
}
