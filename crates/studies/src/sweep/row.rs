//! One row of results: the values of a case, and what is proved of it or why nothing is; and the line by which it goes from one process to
//! another.

use serde_json::json;
use sigmastar_exact::enclosure::DIGITS;
use sigmastar_exact::number::write_exact;
use sigmastar_lang::spec::{
    Document, Errors, Object, Reported, SIZES, Sampling, SpecErrors, StartSizes, Value, choose,
};
use sigmastar_prove::certify::Verdict;
use sigmastar_prove::reduction::{Certified, StateStart};

/// The verdicts by their words.
const VERDICTS: [Verdict; 4] = [Verdict::Certified, Verdict::Refuted, Verdict::BadInput, Verdict::Undecided];

/// What X0 of a line bounds: of a specification, of a plant whose set is asked for as a ball, of another plant.
pub const X0_BOUNDS: [&str; 3] = ["|x|", "|x - x_0|", "|L^-1 (x - x_0)|"];

/// What is certified, in the numbers of a certificate.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RowClaim {
    /// The gain: of the regulator in continuous time the smallest one that was found, from which on the claim holds; of the
    /// one at samples the only one that it is about.
    pub sigma_star: String,
    /// The sampling period, where the claim is about the regulator at samples.
    pub sampling_period: Option<String>,
    /// The initial set. Where a plant's is asked for as a ball its X0 is the radius of one that it contains.
    pub initial_set: StartSizes<String>,
    /// What its X0 bounds, one of [`X0_BOUNDS`].
    pub x0_bounds: &'static str,
    /// Upper bounds of |x|, |e|, |zeta|_N and |z|_N along the periodic solution, rounded up.
    pub periodic: [String; 4],
    /// Whether it is proved that no plant with a state has these data, so that the claim says nothing about any.
    pub no_plant: bool,
}

impl RowClaim {
    /// The claim of a run.
    pub(super) fn new(certified: &Certified<'_>) -> RowClaim {
        let mut initial_set = certified.set.map(write_exact);
        let [state, ball, coordinates] = X0_BOUNDS;
        let x0_bounds = match &certified.start {
            StateStart::State => state,
            StateStart::Coordinates => coordinates,
            StateStart::Ball(radius) => {
                initial_set.x0 = write_exact(radius);
                ball
            }
        };
        RowClaim {
            sigma_star: write_exact(certified.sigma),
            sampling_period: certified.sampling.map(Sampling::text),
            initial_set,
            x0_bounds,
            periodic: certified.periodic.each_ref().map(|bound| bound.upper_decimal(DIGITS)),
            no_plant: certified.no_plant,
        }
    }
}

/// Why a case was refused.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RowError {
    /// The kind of the error.
    pub code: String,
    /// The place in the document of the case.
    pub pointer: String,
    /// What is wrong.
    pub message: String,
}

/// One row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// The number of the case.
    pub index: u64,
    /// Its values, in the order of the parameters.
    pub values: Vec<String>,
    /// SHA-256 of the document of the case.
    pub sha256: String,
    /// The verdict.
    pub verdict: Verdict,
    /// What is certified.
    pub claim: Option<RowClaim>,
    /// Why nothing is claimed, in a sentence.
    pub reason: Option<String>,
    /// What is wrong with the document.
    pub errors: Vec<RowError>,
}

impl Row {
    /// The line, without its end.
    #[must_use]
    pub fn line(&self) -> String {
        let mut line = json!({
            "index": self.index, "values": self.values, "sha256": self.sha256, "verdict": self.verdict.to_string(),
        });
        if let Some(claim) = &self.claim {
            let [x, e, zeta, z] = &claim.periodic;
            line["sigma_star"] = json!(claim.sigma_star);
            if let Some(step) = &claim.sampling_period {
                line["sampling_period"] = json!(step);
            }
            line["initial_set"] = claim.initial_set.named().map(|(name, size)| (name, json!(size))).collect();
            line["X0_bounds"] = json!(claim.x0_bounds);
            line["periodic_solution"] = json!({ "x": x, "e": e, "zeta": zeta, "z": z });
            line["no_plant"] = json!(claim.no_plant);
        }
        if let Some(reason) = &self.reason {
            line["reason"] = json!(reason);
        }
        if !self.errors.is_empty() {
            let one =
                |error: &RowError| json!({ "code": error.code, "pointer": error.pointer, "message": error.message });
            line["errors"] = self.errors.iter().map(one).collect();
        }
        line.to_string()
    }

    /// Reads a line.
    ///
    /// # Errors
    /// What is wrong with it.
    pub(super) fn read(line: &str) -> Result<Row, SpecErrors> {
        let document = Document::parse("line", line)?;
        document.root().read(|root, errors| read(root.object(errors)?, errors))
    }
}

fn text(value: &Value<'_>, errors: &mut Errors) -> Result<String, Reported> {
    value.string(errors).map(str::to_owned)
}

fn texts<const N: usize>(
    value: &Value<'_>,
    names: [&'static str; N],
    errors: &mut Errors,
) -> Result<[String; N], Reported> {
    let mut object = value.object(errors)?;
    let read = names.map(|name| object.required(name, errors).and_then(|value| text(&value, errors)));
    object.finish(errors);
    let mut texts = [const { String::new() }; N];
    for (place, text) in texts.iter_mut().zip(read) {
        *place = text?;
    }
    Ok(texts)
}

/// The sizes of an initial set; without Z0 where the regulator sets z = M e.
fn sizes(value: &Value<'_>, errors: &mut Errors) -> Result<StartSizes<String>, Reported> {
    if value.member("Z0").is_none() {
        let [x0, e0] = texts(value, ["X0", "E0"], errors)?;
        return Ok(StartSizes { x0, e0, z0: None });
    }
    let [x0, e0, z0] = texts(value, SIZES, errors)?;
    Ok(StartSizes { x0, e0, z0: Some(z0) })
}

fn read(mut object: Object<'_>, errors: &mut Errors) -> Result<Row, Reported> {
    let index = object.required("index", errors).and_then(|value| value.integer(errors));
    let values = object
        .required("values", errors)
        .and_then(|value| value.array(errors))
        .and_then(|values| values.iter().map(|value| text(value, errors)).collect::<Result<Vec<_>, _>>());
    let sha256 = object.required("sha256", errors).and_then(|value| text(&value, errors));
    let verdict = object.required("verdict", errors).and_then(|value| {
        let word = value.string(errors)?;
        let known = VERDICTS.into_iter().find(|verdict| verdict.to_string() == word);
        known.ok_or_else(|| value.wrong_type("a verdict", errors))
    })?;
    let claim = match verdict {
        Verdict::Certified => Some(claim(&mut object, errors)?),
        _ => None,
    };
    let reason = object.optional("reason").map(|value| text(&value, errors)).transpose();
    let refused = match object.optional("errors") {
        None => Ok(Vec::new()),
        Some(value) => value.array(errors).and_then(|list| {
            let one = |value: &Value<'_>| {
                let [code, pointer, message] = texts(value, ["code", "pointer", "message"], errors)?;
                Ok(RowError { code, pointer, message })
            };
            list.iter().map(one).collect::<Result<Vec<_>, Reported>>()
        }),
    };
    object.finish(errors);
    Ok(Row { index: index?, values: values?, sha256: sha256?, verdict, claim, reason: reason?, errors: refused? })
}

fn claim(object: &mut Object<'_>, errors: &mut Errors) -> Result<RowClaim, Reported> {
    let sigma_star = object.required("sigma_star", errors).and_then(|value| text(&value, errors));
    let sampling_period = object.optional("sampling_period").map(|value| text(&value, errors)).transpose();
    let set = object.required("initial_set", errors).and_then(|value| sizes(&value, errors));
    let x0_bounds = object.required("X0_bounds", errors).and_then(|value| choose(&value, "bound", &X0_BOUNDS, errors));
    let periodic =
        object.required("periodic_solution", errors).and_then(|value| texts(&value, ["x", "e", "zeta", "z"], errors));
    let no_plant = object.required("no_plant", errors).and_then(|value| value.boolean(errors));
    Ok(RowClaim {
        sigma_star: sigma_star?,
        sampling_period: sampling_period?,
        initial_set: set?,
        x0_bounds: x0_bounds?,
        periodic: periodic?,
        no_plant: no_plant?,
    })
}
