//! Certificates about a sampled regulator, and edits of them.
//!
//! [`made`] is put together here from a shipped certificate in continuous time, with free numbers that were found by a search in
//! floating point apart from both programs.

use crate::common::{certificate, edited, rehash};
use crate::input_gain;
use proofs_check::verdict::Verdict;
use proofs_check::{Report, check};
use serde_json::{Value, json};

/// The words of the claim, from its numbers and those of the specification.
pub fn words(certificate: &Value) -> String {
    let (claim, spec) = (&certificate["claim"], &certificate["specification"]);
    let text = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    let (domain, triple, model, set) =
        (&spec["domain"], &spec["lyapunov"], &spec["internal_model"], &claim["initial_set"]);
    let where_ = if domain.is_null() {
        String::new()
    } else {
        format!(" (for |x| <= {}, |e| <= {})", text(&domain["X"]), text(&domain["E"]))
    };
    let given = |value: Option<&Value>, words: &'static str| value.map_or("", |_| words);
    format!(
        "For the digital regulator {delayed}with the gain sigma = {}, the sampling period h = {} ({samples} samples a period) and K = {}, for \
         every number of oscillators n_o < {samples}/2 and every phase of the sampling grid{}, with period T = {}, mu = {} and base \
         frequency {}, the closed loop of every plant within the bounding functions{where_} and with the Lyapunov triple p_low = {}, p_up = {}, alpha \
         = {} (given, not proved){}{} has a T-periodic solution. Every solution from |x| <= {}, |e| <= \
         {}, sqrt(z'Nz) <= {}, at any sampling instant{start}, converges exponentially to it.",
        text(&claim["sigma"]),
        text(&claim["sampling_period"]),
        text(&claim["gain"]),
        spec.get("input_gain").map_or_else(String::new, input_gain::words),
        text(&spec["period"]),
        text(&model["mu"]),
        text(&model["base_frequency"]),
        text(&triple["p_low"]),
        text(&triple["p_up"]),
        text(&triple["alpha"]),
        given(triple.get("rate"), " and the contraction `rate` (given, not proved)"),
        given(spec.get("q_0"), " and harmonics of q(t,0,0) within `q_0` (given, not proved)"),
        text(&set["X0"]),
        text(&set["E0"]),
        text(&set["Z0"]),
        samples = text(&claim["samples"]),
        delayed =
            if claim["delay_samples"] == 1 { "whose control is computed in the sample before it acts, " } else { "" },
        start = match &certificate["witness"]["Y_0"] {
            y_0 if claim["delay_samples"] == 1 =>
                format!(", with a prediction of e there within h*{} of it", text(y_0)),
            _ => String::new(),
        },
    )
}

/// Puts a claim and a witness of section 12 in the place of those of a certificate in continuous time.
fn sampled(law: [(&str, Value); 4], set: [&str; 3], sizes: [&str; 4], numbers: [(&str, &str); 11]) -> Value {
    let mut made = certificate("paper-example.means");
    let parts = made.as_object_mut().unwrap();
    ["constants", "comparison", "no_plant"].iter().for_each(|part| drop(parts.remove(*part)));
    made["conditions"] = json!([]);
    made["witness"] = json!({ "transfer": { "proof": "sampled" }, "weight_sum": "4.6123753533" });
    numbers.into_iter().for_each(|(name, value)| made["witness"][name] = value.into());
    let claim = made["claim"].as_object_mut().unwrap();
    claim.remove("sigma_star");
    claim.insert("regulator".to_owned(), json!("digital"));
    claim.insert("n_o".to_owned(), json!("every n_o < samples/2"));
    let [x, e, zeta, z] = sizes;
    claim.insert("periodic_solution".to_owned(), json!({ "x": x, "e": e, "zeta": zeta, "z": z }));
    law.into_iter().for_each(|(name, value)| drop(claim.insert(name.to_owned(), value)));
    let [x0, e0, z0] = set;
    made["claim"]["initial_set"] = json!({ "kind": "paper", "X0": x0, "E0": e0, "Z0": z0 });
    made["specification"]["internal_model"]["sampling_period"] = made["claim"]["sampling_period"].clone();
    made
}

/// The paper's example with sigma = 60 and 200 samples a period.
pub fn made() -> Value {
    sampled(
        [
            ("sigma", json!("60")),
            ("sampling_period", json!("1/200")),
            ("samples", json!(200)),
            ("gain", json!("0.988600508451")),
        ],
        ["0.0644918116", "0.230116048", "14.3179109"],
        ["0.03158435651", "0.1150010972", "6.911844782", "7.158826214"],
        [
            ("X_p", "0.03224590549"),
            ("E_p", "0.1150580229"),
            ("r_x", "0.03115966877"),
            ("r_e", "0.06507796355"),
            ("r_d", "0.4103606096"),
            ("D_x", "0.6559399948"),
            ("D_e", "2.61725782739"),
            ("w_x", "15.9207966332"),
            ("h", "0.0137794822489"),
            ("k0", "19.7392088419"),
            ("k1", "59.2225563058"),
        ],
    )
}

/// With `h sigma = 1` exactly: sigma = 100 and 100 samples a period.
pub fn dead_beat() -> Value {
    sampled(
        [
            ("sigma", json!("100")),
            ("sampling_period", json!("1/100")),
            ("samples", json!(100)),
            ("gain", json!("0.977457984419")),
        ],
        ["0.0403752055", "0.149526075", "14.231076"],
        ["0.020", "0.075", "6.96", "7.12"],
        [
            ("X_p", "0.02018760257"),
            ("E_p", "0.07476303657"),
            ("r_x", "0.01807950932"),
            ("r_e", "0.04005281989"),
            ("r_d", "0.2618861385"),
            ("D_x", "0.613344095274"),
            ("D_e", "2.76082414081"),
            ("w_x", "20.261384334"),
            ("h", "0.0161353519235"),
            ("k0", "19.7392088419"),
            ("k1", "59.2371712898"),
        ],
    )
}

/// The answer after the changes, with the digest made right.
pub fn answer(made: Value, changes: &[(&str, Value)]) -> Report {
    let mut made = edited(made, changes);
    rehash(&mut made);
    check(made.to_string().as_bytes())
}

/// The conditions that fail or are undecided, in order.
pub fn open(report: &Report) -> Vec<String> {
    let open = report.lines.iter().filter(|line| line.contains(" FAILS: ") || line.contains(" undecided: "));
    open.map(|line| line.trim().split(": ").take(2).collect::<Vec<_>>().join(": ")).collect()
}

#[track_caller]
pub fn holds(made: Value, changes: &[(&str, Value)]) {
    let report = answer(made, changes);
    assert_eq!(report.verdict, Verdict::Valid, "{changes:?}: {}{:?}", report.text(false), open(&report));
}

/// It is invalid for conditions that begin with these words, and for no other.
#[track_caller]
pub fn fails(made: Value, changes: &[(&str, Value)], conditions: &[&str]) {
    let report = answer(made, changes);
    let found = open(&report);
    let same = found.len() == conditions.len() && found.iter().zip(conditions).all(|(a, b)| a.starts_with(b));
    assert!(report.verdict == Verdict::Invalid && same, "{changes:?}: {found:?}\n{}", report.text(false));
}

/// It is refused with this verdict and rule, at this place, before any condition is written down.
#[track_caller]
pub fn refuses(made: Value, changes: &[(&str, Value)], verdict: Verdict, rule: &str, pointer: &str) {
    let report = answer(made, changes);
    let Some(finding) = report.finding.as_ref() else { panic!("{changes:?} is accepted") };
    assert_eq!((report.verdict, finding.rule), (verdict, rule), "{changes:?}: {}", report.text(false));
    assert!(finding.pointer.starts_with(pointer), "{changes:?}: {} is not below {pointer}", finding.pointer);
}
