//! Plants with the parts of a witness that are about their formulas, and what the rules of section 11 say of them.

use crate::common::parsed;
use proofs_check::effort;
use proofs_check::json::{Field, Json, decimal, parse};
use proofs_check::plants as plant;
use proofs_check::plants::read::Plant;
use proofs_check::rules::derivation::Inequalities;
use proofs_check::rules::inequality::{Inequality, Kind as Of, List};
use proofs_check::rules::rates::{Asked, Kind, Witness};
use proofs_check::rules::sampled::law::Terms;
use proofs_check::scope::Scope;
use proofs_check::spec::Specification;
use proofs_check::verdict::{Outcome, Verdict};
use rug::{Float, Rational};
use serde_json::{Value, json};

/// A file of `tests/plants`: a plant, and parts of a witness.
pub fn stored(name: &str) -> Value {
    parsed("plants", name)
}

pub fn read(parts: &Value) -> Outcome<(Specification, Vec<Plant>)> {
    let parse = |part: &str| -> Json { parse(parts[part].to_string().as_bytes()).unwrap() };
    let (plant, witness) = (parse("plant"), parse("witness"));
    let mut fields = Field { json: &witness, pointer: "/witness".to_owned() }.fields()?;
    let read = plant::read::read(&Field { json: &plant, pointer: "/plant".to_owned() }, &mut fields)?;
    fields.finish().map(|()| read)
}

/// An inequality as a witness with w_x and h has it.
fn inequality(kind: Of, part: &Value, weights: &Value, law: Option<&Rational>) -> Outcome<Inequality> {
    let json = parse(part.to_string().as_bytes()).unwrap();
    let weight =
        |name: &str| weights.get(name).map_or_else(Rational::new, |text| decimal(text.as_str().unwrap()).unwrap());
    let pointer = format!("/witness/{}", kind.rule().replace(' ', "_"));
    Inequality::read(&Field { json: &json, pointer }, kind, [&weight("w_x"), &weight("h")], law)
}

/// All of them, and the law of those at samples.
fn inequalities(parts: &Value) -> Outcome<(List, Option<Terms>)> {
    let none = Value::Null;
    let at_samples = parts.get("at_samples");
    let law = at_samples.map(|parts| {
        let value = |name: &str| decimal(parts[name].as_str().unwrap()).unwrap();
        let samples = u32::try_from(parts["samples"].as_u64().unwrap()).unwrap();
        let (sigma, gain, weight_sum) = (value("sigma"), value("gain"), value("weight_sum"));
        Terms { sigma, samples, gain, weight_sum, delayed: false, scope: Scope::First }
    });
    let read = |kind, part: Option<&Value>, weights: &Value| {
        part.map(|part| inequality(kind, part, weights, law.as_ref().map(|law| &law.sigma))).transpose()
    };
    let (stability, existence) = match at_samples {
        Some(of) => (read(Of::Matrix, of.get("stability"), of)?, read(Of::Existence, of.get("existence"), of)?),
        None => {
            let of = parts.get("inequality").unwrap_or(&none);
            let matrix = read(Of::Matrix, of.get("part"), of)?;
            let joint = read(Of::Joint, parts.get("joint"), &none)?;
            assert!(matrix.is_none() || joint.is_none());
            (matrix.or(joint), read(Of::Existence, parts.get("existence"), &none)?)
        }
    };
    Ok((List { stability, existence }, law))
}

/// Rates as the witness of a claim by a matrix inequality has them, and where that has (J, r), and (g, d).
struct Slopes {
    list: Vec<Witness>,
    at: [[Rational; 2]; 2],
}

impl Slopes {
    fn read(part: &Value) -> Outcome<Slopes> {
        let states = part["list"][0]["Pi"].as_array().unwrap().len() - 2;
        let json = parse(part["list"].to_string().as_bytes()).unwrap();
        let field = Field { json: &json, pointer: "/witness/for_n_o".to_owned() };
        let [own, other] = [part, part.get("splitting").unwrap_or(part)];
        let number = |of: &Value, name: &str| decimal(of[name].as_str().unwrap()).unwrap();
        let at = [[number(own, "X"), number(other, "E")], [number(other, "X"), number(own, "E")]];
        let kind = Kind::Slopes { states, corner: part.get("splitting").is_some() };
        Witness::read_list(Some(&field), kind).map(|list| Slopes { list, at })
    }
}

/// Applies the rules of section 11; the lines of the argument.
pub fn judged(parts: &Value) -> Outcome<Vec<String>> {
    let (spec, plant) = read(parts)?;
    let (list, law) = inequalities(parts)?;
    let slopes = parts.get("slopes").map(Slopes::read).transpose()?;
    let slopes =
        slopes.as_ref().map(|parts| Asked { witnesses: &parts.list, at: parts.at.each_ref().map(<[_; 2]>::each_ref) });
    let inequalities = Inequalities { list: Some(&list), law: law.as_ref(), slopes };
    let none = Float::new(128);
    let mut lines = Vec::new();
    let (answer, steps) =
        effort::limited(effort::LIMIT, || plant::prove(&spec, &plant, [&none, &none], inequalities, &mut lines));
    lines.push(format!("{steps} steps"));
    answer.map(|()| lines)
}

/// A plant with parts of a witness, to be changed.
#[derive(Clone)]
pub struct Parts(pub Value);

impl Parts {
    /// One state, the period 1, L = 1, P = 1 with the rate 1.
    pub fn scalar(f: &str, q: &str) -> Parts {
        Parts(json!({
            "plant": {
                "format": "sigmastar/plant", "version": 1, "name": "a test", "period": "1", "states": ["x"], "f": [f], "q": q,
                "internal_model": {
                    "mu": "1", "base_frequency": "2*pi", "matched": true,
                    "weights": { "family": "power", "n0": "2", "epsilon": "1/2" },
                },
            },
            "witness": {
                "coordinates": [["1"]],
                "orbit": null,
                "lyapunov": { "P": [["1"]], "p_low": "1", "p_up": "1", "alpha": "1" },
                "forcing": null,
                "bounds": [],
            },
        }))
    }

    /// `xb = cos * cos(2 pi t) + sin * sin(2 pi t)`.
    pub fn orbit(self, cos: f64, sin: f64, defect: &str, radius: &str) -> Parts {
        let harmonic = json!([{ "cos": [format!("{cos:.17}")], "sin": [format!("{sin:.17}")] }]);
        let orbit = json!({ "mean": ["0"], "harmonics": harmonic, "defect": defect, "tube": "0.1", "radius": radius });
        self.with("/witness/orbit", orbit)
    }

    /// `qb`, with one harmonic.
    pub fn forcing(self, mean: f64, cos: f64, sin: f64, rest: &str, rest_t: &str) -> Parts {
        let harmonic = json!([{ "cos": format!("{cos:.17}"), "sin": format!("{sin:.17}") }]);
        let forcing = json!({ "mean": format!("{mean}"), "harmonics": harmonic, "rest": rest, "rest_t": rest_t });
        self.with("/witness/forcing", forcing)
    }

    /// Other entries: name, X, E, value.
    pub fn bounds(self, entries: &[(&str, &str, &str, &str)]) -> Parts {
        let entry =
            |(bound, x, e, value): &(&str, &str, &str, &str)| json!({ "bound": bound, "X": x, "E": e, "value": value });
        self.with("/witness/bounds", entries.iter().map(entry).collect())
    }

    /// The inequality with the weights w_x and h, on `|y| <= x`, `|e| <= e`.
    pub fn inequality(self, [w_x, h]: [&str; 2], [x, e]: [&str; 2], rate: &str, sigma: f64) -> Parts {
        let part = json!({ "X": x, "E": e, "rate": rate, "sigma": format!("{sigma:.12}") });
        self.with("/inequality", json!({ "w_x": w_x, "h": h, "part": part }))
    }

    /// Another value at a place, which need not be there yet.
    pub fn with(mut self, at: &str, value: Value) -> Parts {
        let (object, key) = at.rsplit_once('/').unwrap();
        let object = self.0.pointer_mut(object).unwrap();
        match key.parse::<usize>() {
            Ok(index) => object[index] = value,
            Err(_) => object[key] = value,
        }
        self
    }

    #[track_caller]
    pub fn accepted(&self) {
        if let Err(finding) = judged(&self.0) {
            panic!("{}: {finding:?}", self.0["plant"]["q"]);
        }
    }

    /// The verdict and the rule.
    pub fn verdict(&self) -> (Verdict, &'static str) {
        judged(&self.0).map_or_else(|finding| (finding.verdict, finding.rule), |_| (Verdict::Valid, ""))
    }

    /// Refused with this verdict, by this rule (any: empty) and at or below this place.
    #[track_caller]
    pub fn refused(&self, verdict: Verdict, rule: &str, pointer: &str) {
        match judged(&self.0) {
            Ok(_) => panic!("accepted: {}", self.0),
            Err(finding) => {
                let right = finding.verdict == verdict && (rule.is_empty() || finding.rule == rule);
                assert!(right && finding.pointer.starts_with(pointer), "{finding:?}");
            }
        }
    }
}
