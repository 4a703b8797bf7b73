//! Where along a curve an operation of a right side has no value, or is not smooth: the cause to name where a search or a proof meets
//! it. Doubles look for it, and nothing is claimed by it.

use sigmastar_exact::number::in_digits;
use sigmastar_lang::expr::{Demand, Evaluator, Formulas, PlantVariable, Program};
use sigmastar_lang::plant::Plant;
use std::ops::Range;
use std::sync::Arc;
use thiserror::Error;

/// What demands that something does not vanish because there is a corner.
const CORNERS: [&str; 2] = ["the argument of abs", "the two arguments"];

/// Times of a period at which the operations are looked at.
const TIMES: u32 = 512;

/// A value is 0 where it is this small beside the largest one of the period.
const NOTHING: f64 = 1e-12;

/// The longest argument that is shown in what to write for its magnitude, in bytes.
const LONGEST_ARGUMENT: usize = 30;

/// Halvings of the stretch between two times with values of both signs.
const HALVINGS: usize = 60;

/// An operation that has no value at a time.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("at t/T = {}{} `{part}` has no value: {}", in_digits(*s, 4), at_state(states), reason(what, *zero_over_zero))]
pub struct Undefined {
    /// The index of the right side: a state, or the number of states for q.
    pub index: usize,
    /// The bytes of the operation in its text.
    pub span: Range<usize>,
    /// The operation.
    pub part: String,
    /// What it demands, in words.
    pub what: &'static str,
    /// When, in periods.
    pub s: f64,
    /// The state, where the demand is about it.
    pub states: Option<Vec<f64>>,
    /// Whether it is a quotient of which both members vanish.
    pub zero_over_zero: bool,
}

fn at_state(states: &Option<Vec<f64>>) -> String {
    states.as_ref().map_or_else(String::new, |x| {
        let numbers: Vec<String> = x.iter().map(|x| in_digits(*x, 4)).collect();
        format!(", x = ({}), e = 0", numbers.join(", "))
    })
}

fn reason(what: &str, zero_over_zero: bool) -> String {
    if zero_over_zero { "it is 0/0 there".to_owned() } else { otherwise(what).unwrap_or_else(|| format!("not {what}")) }
}

/// What happens where a demand fails, in words.
#[must_use]
pub fn otherwise(what: &str) -> Option<String> {
    const OTHERWISE: [(&str, &str); 3] =
        [(" does not vanish", " vanishes"), (" is positive", " is not positive"), (" differ", " are equal")];
    OTHERWISE.iter().find_map(|(wanted, other)| Some(format!("{}{other}", what.strip_suffix(wanted)?)))
}

/// What to write in the place of an operation of which this is demanded: its own text says which quotient it is.
#[must_use]
pub fn instead(what: &str, part: &str) -> String {
    const INSTEAD: [(&str, &str); 4] = [
        ("the two arguments", "write (a + b - sqrt((a - b)^2 + 1/100))/2 for min(a, b), with + for max(a, b)"),
        ("the argument of sqrt", "write sqrt(u + 1/100) for sqrt(u), if u is not negative"),
        ("the argument of log", "write log(u + 1/100) for log(u), if u is not negative"),
        ("the argument of tan", "write a function without poles"),
    ];
    if what.starts_with("the divisor") {
        let exprelr = "write a*b*exprelr(u/b) for a*u/(exp(u/b) - 1): exprelr(u) is u/(exp(u) - 1), and 1 at u = 0";
        let sinc = "write sinc(u) for sin(u)/u: it is 1 at u = 0";
        let known = [("exp(", exprelr), ("sin(", sinc)].into_iter().filter(|(name, _)| part.contains(name));
        let other =
            "u*v/(v^2 + 1/100) is smooth, but not u/v: with it the model is another one, in which 0 stands where v = 0";
        return known.map(|(_, text)| text).chain([other]).collect::<Vec<_>>().join("; ");
    }
    if what.starts_with("the argument of abs") {
        return instead_of_abs(part);
    }
    let known = INSTEAD.iter().find(|(start, _)| what.starts_with(start));
    known.map_or("write a smooth function in its place", |(_, text)| text).to_owned()
}

/// What to write for a magnitude, with its argument where that is short.
fn instead_of_abs(part: &str) -> String {
    let argument = part.strip_prefix("abs(").and_then(|rest| rest.strip_suffix(')')).map(str::trim);
    let argument = argument.filter(|argument| argument.len() <= LONGEST_ARGUMENT).unwrap_or("u");
    let is_name = argument.chars().all(|c| c.is_alphanumeric() || c == '_');
    let base = if is_name { argument.to_owned() } else { format!("({argument})") };
    format!(
        "|{argument}| is not smooth where {argument} = 0: write sqrt({base}^2 + 1/100) for abs({argument}), with a smaller number than 1/100 for a sharper \
         corner; the recipes of the user guide have drag, dry friction and dead zones"
    )
}

impl Undefined {
    /// What helps.
    #[must_use]
    pub fn advice(&self) -> String {
        instead(self.what, &self.part)
    }
}

/// What one operation demands, ready to be evaluated.
struct Asked {
    index: usize,
    demand: Demand,
    /// Whether the state has a say in it.
    of_state: bool,
    evaluator: Evaluator,
}

impl Asked {
    /// The demanded value, and the dividend where there is one, at a time in periods.
    fn at(&mut self, s: f64, period: f64, x: &[f64]) -> [f64; 2] {
        let mut values = [f64::NAN; 2];
        self.evaluator.set_time(s * period);
        self.evaluator.evaluate(x, 0.0, &mut values);
        values
    }
}

fn asked(plant: &Plant) -> Vec<Asked> {
    let mut all = Vec::new();
    for (index, side) in plant.f.iter().chain([&plant.q]).enumerate() {
        let mut formulas = Formulas::new();
        let (_, demands) = formulas.insert_with_demands(side);
        // At a corner there is a value.
        let corner = |demand: &Demand| CORNERS.iter().any(|start| demand.what.starts_with(start));
        for demand in demands.into_iter().filter(|demand| !corner(demand)) {
            let variables = formulas.walk(&[demand.of]).all_variables();
            let of_state = (0..plant.states()).any(|j| variables.has(PlantVariable::State(j)));
            let outputs = [demand.of, demand.dividend.unwrap_or(demand.of)];
            let program = Program::of_formulas(&formulas, &outputs, plant.states()).with_parameters(&plant.nominal());
            all.push(Asked { index, demand, of_state, evaluator: Evaluator::new(Arc::new(program)) });
        }
    }
    all
}

/// The first operation that has no value at a time of the period and at e = 0, the states being those of a curve of t/T: first among those
/// about which the states have no say.
#[must_use]
pub fn undefined_along(plant: &Plant, curve: impl Fn(f64) -> Vec<f64>) -> Option<Undefined> {
    let period = plant.period.nominal().to_f64();
    let mut all = asked(plant);
    all.sort_by_key(|asked| asked.of_state);
    all.iter_mut().find_map(|asked| {
        let times = (0..=TIMES).map(|j| f64::from(j) / f64::from(TIMES));
        let values: Vec<(f64, [f64; 2])> = times.map(|s| (s, asked.at(s, period, &curve(s)))).collect();
        let largest = |which: usize| values.iter().map(|(_, v)| v[which].abs()).fold(0.0, f64::max);
        let nothing = [0, 1].map(|which| NOTHING * largest(which));
        let is_logarithm = asked.demand.what.starts_with("the argument of log");
        let fails = |v: f64| match asked.demand.positive {
            _ if v.is_nan() => true,
            true if is_logarithm => v <= 0.0,
            // At its edge a root or a power has the value 0.
            true => v < -nothing[0],
            false => v.abs() <= nothing[0],
        };
        let at_time = values.iter().find(|(_, v)| fails(v[0])).map(|(s, _)| *s);
        let crossed = || {
            let pair = values.windows(2).find(|pair| !asked.demand.positive && pair[0].1[0] * pair[1].1[0] < 0.0)?;
            let (mut low, mut high, sign) = (pair[0].0, pair[1].0, pair[0].1[0]);
            for _ in 0..HALVINGS {
                let middle = (low + high) / 2.0;
                let same = asked.at(middle, period, &curve(middle))[0] * sign > 0.0;
                if same { low = middle } else { high = middle }
            }
            Some((low + high) / 2.0)
        };
        let s = at_time.or_else(crossed)?;
        let [_, dividend] = asked.at(s, period, &curve(s));
        let Asked { index, demand, of_state, .. } = asked;
        // A crossing is met to rounding, and so is a dividend that vanishes with the divisor.
        let zero_over_zero = demand.dividend.is_some() && dividend.abs() <= nothing[1].sqrt() * largest(1).sqrt();
        let side = plant.f.get(*index).unwrap_or(&plant.q);
        let part = side.text().get(demand.span.clone()).unwrap_or_default().to_owned();
        let states = of_state.then(|| curve(s));
        Some(Undefined { index: *index, span: demand.span.clone(), part, what: demand.what, s, states, zero_over_zero })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(f: &str, x: f64) -> Option<Undefined> {
        let text = format!(
            r#"{{ "format": "sigmastar/plant", "version": 1, "name": "test", "period": "50", "states": ["x"], "f": ["{f}"], "q": "x",
            "internal_model": {{ "mu": "1", "base_frequency": "2*pi/50", "matched": true,
            "weights": {{ "family": "power", "n0": "2", "epsilon": "1/2" }} }} }}"#
        );
        undefined_along(&Plant::from_json("test", &text).unwrap(), |_| vec![x])
    }

    #[test]
    fn the_operation_and_its_instant_are_named() {
        for (f, part, s, zero_over_zero) in [
            ("-x + cos(phase)/(exp(cos(phase)) - 1)", "cos(phase)/(exp(cos(phase)) - 1)", 0.25, true),
            ("-x + sin(cos(phase))/cos(phase)", "sin(cos(phase))/cos(phase)", 0.25, true),
            ("-x + 1/(cos(phase) - 1/2)", "1/(cos(phase) - 1/2)", 1.0 / 6.0, false),
            (
                "-x + cos(phase - 1)/(exp(cos(phase - 1)) - 1)",
                "cos(phase - 1)/(exp(cos(phase - 1)) - 1)",
                0.25 + 0.159_154_943,
                true,
            ),
            ("-x + log(cos(phase))", "log(cos(phase))", 0.25, false),
            ("-x + sqrt(cos(phase))", "sqrt(cos(phase))", 0.25, false),
            ("-x/x", "-x/x", 0.0, true),
        ] {
            let undefined = found(f, 0.0).unwrap_or_else(|| panic!("{f}"));
            assert_eq!((undefined.part.as_str(), undefined.zero_over_zero), (part, zero_over_zero), "{f}");
            assert!((undefined.s - s).abs() < 0.003, "{f}: {}", undefined.s);
            assert_eq!(undefined.states.is_some(), f == "-x/x");
        }
        // Nearly: what does not vanish, and what has it built in.
        for f in [
            "-x + 1/(cos(phase) - 1.01)",
            "-x + exprelr(cos(phase))*sinc(cos(phase))",
            "-x/(x + 1)",
            "-x + abs(cos(phase)) + sqrt(x)",
        ] {
            assert_eq!(found(f, 0.0), None, "{f}");
        }
    }

    #[test]
    fn what_to_write_depends_on_the_quotient() {
        let advice = |part: &str| instead("the divisor does not vanish", part);
        assert!(advice("u/(exp(u) - 1)").contains("exprelr(u)") && !advice("u/(exp(u) - 1)").contains("sinc"));
        assert!(advice("sin(u)/u").contains("sinc(u)") && !advice("sin(u)/u").contains("exprelr"));
        assert!(!advice("x/y").contains("exprelr") && !advice("x/y").contains("sinc"));
        for part in ["u/(exp(u) - 1)", "x/y"] {
            assert!(advice(part).contains("the model is another one"), "{part}");
        }
        assert!(!instead("the argument of log is positive", "log(x)").contains("exprelr"));
    }

    #[test]
    fn a_magnitude_is_told_with_its_argument() {
        let long = format!("abs({})", "x + ".repeat(9) + "x");
        for (part, said) in [
            ("abs(e)", "|e| is not smooth where e = 0: write sqrt(e^2 + 1/100) for abs(e)"),
            ("abs( v - 2*e )", "write sqrt((v - 2*e)^2 + 1/100) for abs(v - 2*e)"),
            (long.as_str(), "write sqrt(u^2 + 1/100) for abs(u)"),
        ] {
            let advice = instead("the argument of abs does not vanish", part);
            assert!(advice.contains(said) && advice.contains("dead zones"), "{part}: {advice}");
        }
        assert!(!instead("the argument of sqrt is positive", "sqrt(x)").contains("dead zones"));
    }
}
