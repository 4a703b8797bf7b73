//! The bounding specification of a plant as a document.

use super::prove::{DIGITS, PlantBounds};
use rug::Rational;
use serde_json::Value;
use sigmastar_decide::bounds::Majorant;
use sigmastar_exact::number::{Direction, round_rational, write_exact};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::model::{Constant, InitialSet, KnownForcing, SIZES};
use sigmastar_lang::spec::{InputGain, OfPlant, Specification};
use sigmastar_prove::certificate::{exact, members, object};
use sigmastar_prove::reduction::{PlantRefusal, bounds_around};

/// The domain, where none is asked for: what the certificate needs, times this.
const MARGIN: (u32, u32) = (5, 4);

/// Significant digits of the domain.
const DOMAIN_DIGITS: u32 = 3;

/// Those of an end of a plant's own domain that is irrational.
const LONG_DIGITS: u32 = 12;

/// Bits at which the domain of a plant and the sizes of harmonics are enclosed.
const PRECISION: u32 = 128;

/// A bounding specification that was proved from a plant's formulas.
#[derive(Clone, Debug)]
pub struct BoundedPlant {
    /// The document: `sigmastar/bounding-spec`.
    pub document: Value,
    /// X and E of its domain.
    pub domain: [Rational; 2],
    /// Where the bounds may end before the arguments of a gain are reached: the domain is that of the plant itself.
    pub limited: bool,
}

/// The bounding specification of a plant that [`reduce_by_norms`](sigmastar_prove::reduction::reduce_by_norms()) has led to `spec`, on `|y| <= X`,
/// `|e| <= E` with the domain that is asked for, or one quarter larger than what the gain of `spec` needs; never beyond the domain
/// of the plant.
///
/// Guarantee: every number of the document holds for the plant, in the coordinates y of `spec`, relative to its orbit.
///
/// # Errors
/// What is not proved; an operation that is not smooth on the whole domain.
pub fn bounding_specification(
    plant: &Plant,
    spec: &Specification,
    asked: Option<[Rational; 2]>,
) -> Result<BoundedPlant, PlantRefusal> {
    let of_plant = spec.plant().ok_or(PlantRefusal::Coordinates)?;
    let needed = || {
        let reach = spec.bounds.proved_values().reach().unwrap_or_default();
        reach.map(|end| round_rational(&(end * Rational::from(MARGIN)), DOMAIN_DIGITS, Direction::Up))
    };
    let wanted = asked.unwrap_or_else(needed);
    let own = spec.domain.as_ref().map(|domain| {
        [&domain.x, &domain.e].map(|end| match end.as_rational() {
            Some(exact) => exact.clone(),
            None => {
                let lower = end.enclose(PRECISION).lower_rational().unwrap_or_default();
                round_rational(&lower, LONG_DIGITS, Direction::Down)
            }
        })
    });
    let limited = own.as_ref().is_some_and(|own| own.iter().zip(&wanted).any(|(own, wanted)| own < wanted));
    let domain = match own {
        Some([x, e]) => {
            let [wanted_x, wanted_e] = wanted;
            [x.min(wanted_x), e.min(wanted_e)]
        }
        None => wanted,
    };
    let (engine, samples) = bounds_around(plant, of_plant)?;
    engine.smooth(&domain[0], &domain[1])?;
    let bounds = PlantBounds::prove(&engine, &samples, domain.each_ref())?;
    let document = write(plant, spec, of_plant, &bounds, domain.each_ref());
    Ok(BoundedPlant { document, domain, limited })
}

fn write(
    plant: &Plant,
    spec: &Specification,
    of_plant: &OfPlant,
    bounds: &PlantBounds,
    domain: [&Rational; 2],
) -> Value {
    let (fields, rate) = bounds.fields();
    let text = |majorant: &Majorant| Value::from(majorant.text());
    let triple = &of_plant.triple;
    let stated = |constant: &Constant| Value::from(constant.text.clone());
    let lyapunov = object([
        ("p_low", stated(&triple.p_low)),
        ("p_up", stated(&triple.p_up)),
        ("alpha", stated(&triple.alpha)),
        ("rate", text(&rate)),
    ]);
    let nominal = spec.period.nominal();
    let period = match spec.period.interval() {
        None => stated(nominal),
        Some([low, high]) => {
            object([("nominal", nominal), ("low", low), ("high", high)].map(|(name, end)| (name, stated(end))))
        }
    };
    let ends = object([("X", exact(domain[0])), ("E", exact(domain[1]))]);
    let all = [
        ("format", Value::from("sigmastar/bounding-spec")),
        ("version", Value::from(1)),
        ("name", Value::from(format!("{}, bounded", plant.name))),
        ("description", Value::from(description(of_plant))),
        ("period", period),
        ("lyapunov", lyapunov),
        ("bounds", object(fields.iter().map(|(name, majorant)| (*name, text(majorant))))),
    ];
    let forcing = spec.q_0.as_ref().map(|known| ("q_0", forcing(known)));
    let rest =
        [("domain", ends), ("internal_model", internal_model(plant)), ("initial_set", initial_set(&spec.initial_set))];
    let input_gain = spec.input_gain.as_ref().map(|gain| ("input_gain", input_gain(gain)));
    let actuator = plant.actuator.as_ref().map(|actuator| ("actuator", object([("max", stated(&actuator.max))])));
    // They have no names of parameters.
    let disturbed = ["measurement", "disturbance"].map(|name| Some((name, plant.document.get(name)?.clone())));
    let disturbed = disturbed.into_iter().flatten();
    object(all.into_iter().chain(forcing).chain(rest).chain(input_gain).chain(actuator).chain(disturbed))
}

/// The numbers of that of a plant.
fn input_gain(gain: &InputGain) -> Value {
    let InputGain { nominal, low, high, .. } = gain;
    let number = |value: &Constant| value.as_rational().map_or_else(|| Value::String(value.text.clone()), exact);
    object([("nominal", number(nominal)), ("low", number(low)), ("high", number(high))])
}

/// That of the plant, without names of its parameters.
fn internal_model(plant: &Plant) -> Value {
    let mut model = plant.document.get("internal_model").cloned().unwrap_or_default();
    for constant in ["mu", "base_frequency", "sampling_period"] {
        if let Some(text) = model.get_mut(constant)
            && let Some(written) = text.as_str()
            // What was read as a constant can be written so.
            && let Ok(spelled_out) = plant.parameters.definitions().spelled_out(written)
        {
            *text = spelled_out.into();
        }
    }
    model
}

fn description(of_plant: &OfPlant) -> String {
    if of_plant.states() == 0 {
        return "Proved from the formulas of the plant, and rounded up.".to_owned();
    }
    let row = |row: &Vec<Rational>| format!("[{}]", row.iter().map(write_exact).collect::<Vec<_>>().join(", "));
    let rows: Vec<String> = of_plant.coordinates.iter().map(row).collect();
    format!(
        "Proved from the formulas of the plant, and rounded up. |x| here is |y|, x - x_0(t) = L y with the rows of L [{}] and the \
         periodic solution x_0 of x' = f(t,x,0){}.",
        rows.join(", "),
        members(&of_plant.parameters).map_or_else(String::new, |members| format!(", for every plant with {members}"))
    )
}

fn forcing(known: &KnownForcing) -> Value {
    let up = |constant: &Constant| {
        let upper = constant.as_rational().cloned().or_else(|| constant.enclose(PRECISION).upper_rational());
        upper.map_or(Value::Null, |upper| exact(&round_rational(&upper, DIGITS, Direction::Up)))
    };
    let harmonics = known.harmonics.iter().map(up).collect();
    let fields = [("harmonics", harmonics), ("rest_rms", up(&known.rest_rms))];
    object(fields.into_iter().chain(known.rest_t_rms.as_ref().map(|rest| ("rest_t_rms", up(rest)))))
}

fn initial_set(set: &InitialSet) -> Value {
    let mut fields = vec![("kind", Value::from(set.kind()))];
    let _ = set.map_each(|place, size| fields.push((SIZES[place], Value::from(size.text.clone()))));
    object(fields)
}
