//! The named constants of a plant.

use super::constant::{any_constant, exchanged, whole};
use super::document::Value;
use super::error::{ErrorKind, Errors, Reported};
use super::interval::{no_list, no_reach, no_share};
use super::object::{OF_FILE, belongs_above};
use super::parts::Constant;
use crate::expr::{DefinitionError, Definitions, MAX_INTERVALS, occurs, quoted};
use rug::Rational;
use sigmastar_exact::number::write_exact;

/// The most parameters that are read.
pub const MAX_PARAMETERS: usize = 12;

/// A named constant, or a name for a number of which an interval is known.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Its name in formulas.
    pub name: String,
    /// Its value, or its nominal value.
    pub value: Constant,
    /// Where it lies, with `low < high`.
    pub interval: Option<Interval>,
}

/// `low <= nominal <= high`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Interval {
    /// What is expected.
    pub nominal: Rational,
    /// The least value.
    pub low: Rational,
    /// The largest value.
    pub high: Rational,
}

impl Interval {
    /// The least and the largest `p - p^0`, of a value p and the nominal one.
    #[must_use]
    pub fn deviations(&self) -> [Rational; 2] {
        [&self.low, &self.high].map(|end| Rational::from(end - &self.nominal))
    }

    /// The largest `|p - p^0|`.
    #[must_use]
    pub fn reach(&self) -> Rational {
        let [below, above] = self.deviations();
        above.max(-below)
    }
}

/// The named constants of a plant, in the order of the document.
#[derive(Clone, Debug, Default)]
pub struct Parameters {
    list: Vec<Parameter>,
    definitions: Definitions,
    unused: Vec<String>,
    /// The clock of a plant whose period is known to an interval: one more of which an interval is known, after the others.
    clock: Option<Interval>,
}

impl Parameters {
    /// These parameters beside a clock.
    #[must_use]
    pub fn with_clock(self, clock: Option<Interval>) -> Parameters {
        Parameters { clock, ..self }
    }

    /// These parameters with one more of which an interval is known, after the others, that has no name in formulas. Hypothesis: there is no clock.
    #[must_use]
    pub fn and(mut self, interval: Interval) -> Parameters {
        let value = Constant::rational(&interval.nominal);
        self.list.push(Parameter { name: String::new(), value, interval: Some(interval) });
        self
    }

    /// The parameter of formulas that is the clock, which is 1 nominally.
    #[must_use]
    pub fn clock(&self) -> Option<usize> {
        self.clock.as_ref().map(|_| self.named_intervals().count())
    }

    /// The constants.
    #[must_use]
    pub fn list(&self) -> &[Parameter] {
        &self.list
    }

    /// Those of which an interval is known, and the clock, where there is one: parameter i of formulas is the i-th.
    pub fn intervals(&self) -> impl Iterator<Item = &Interval> {
        self.named_intervals().map(|(_, interval)| interval).chain(&self.clock)
    }

    /// The names of those with intervals, and these, in the order of the document.
    pub fn named_intervals(&self) -> impl Iterator<Item = (&str, &Interval)> {
        self.list.iter().filter_map(|parameter| Some((parameter.name.as_str(), parameter.interval.as_ref()?)))
    }

    /// The nominal values of those.
    #[must_use]
    pub fn nominal(&self) -> Vec<Rational> {
        self.intervals().map(|interval| interval.nominal.clone()).collect()
    }

    /// These parameters with numbers in the places of the intervals, in their order, and without a clock.
    #[must_use]
    pub fn fixed(&self, values: &[Rational]) -> Parameters {
        let mut values = values.iter();
        let mut fixed = Parameters { clock: None, ..self.clone() };
        for parameter in fixed.list.iter_mut().filter(|parameter| parameter.interval.is_some()) {
            if let Some(value) = values.next() {
                *parameter = Parameter { value: Constant::rational(value), interval: None, ..parameter.clone() };
            }
        }
        fixed
    }

    /// These parameters with a cell of the box in the place of the named intervals, in their order: about its middle, and with the clock as it is.
    #[must_use]
    pub fn in_cell(&self, ends: &[[Rational; 2]]) -> Parameters {
        let mut ends = ends.iter();
        let mut cell = self.clone();
        for interval in cell.list.iter_mut().filter_map(|parameter| parameter.interval.as_mut()) {
            if let Some([low, high]) = ends.next().cloned() {
                *interval = Interval { nominal: Rational::from(&low + &high) / 2, low, high };
            }
        }
        cell
    }

    /// The ends of the named intervals, in their order.
    #[must_use]
    pub fn named_ends(&self) -> Vec<[Rational; 2]> {
        self.named_intervals().map(|(_, interval)| [interval.low.clone(), interval.high.clone()]).collect()
    }

    /// Whether these values of the parameters with intervals lie in the box.
    #[must_use]
    pub fn contain(&self, values: &[Rational]) -> bool {
        self.intervals().zip(values).all(|(interval, value)| interval.low <= *value && *value <= interval.high)
    }

    /// Members of the family that samples look at: the nominal one, and then all corners of the box.
    #[must_use]
    pub fn looked_at(&self) -> Vec<Vec<Rational>> {
        let mut corners: Vec<Vec<Rational>> = vec![Vec::new()];
        for Interval { low, high, .. } in self.intervals() {
            corners = corners
                .iter()
                .flat_map(|corner| [low, high].map(|end| corner.iter().chain([end]).cloned().collect()))
                .collect();
        }
        let nominal = self.nominal();
        if nominal.is_empty() { vec![nominal] } else { std::iter::once(nominal).chain(corners).collect() }
    }

    /// `p_i - p_i^0` for the parameters with intervals.
    #[must_use]
    pub fn deviations(&self, values: &[Rational]) -> Vec<Rational> {
        self.intervals().zip(values).map(|(interval, value)| Rational::from(value - &interval.nominal)).collect()
    }

    /// What their names stand for.
    #[must_use]
    pub fn definitions(&self) -> &Definitions {
        &self.definitions
    }

    /// What the names stand for where those with intervals have their nominal values.
    #[must_use]
    pub fn nominal_definitions(&self) -> Definitions {
        let mut all = Definitions::default();
        for Parameter { name, value, .. } in &self.list {
            // The names were admitted when they were read.
            let _ = all.define(name, value.expr.clone());
        }
        all
    }

    /// The names that occur nowhere.
    #[must_use]
    pub fn unused(&self) -> &[String] {
        &self.unused
    }

    /// That names occur nowhere, in words; `None` where all do.
    #[must_use]
    pub fn unused_in_words(&self) -> Option<String> {
        let (noun, verb) = match self.unused() {
            [] => return None,
            [_] => ("parameter", "is"),
            _ => ("parameters", "are"),
        };
        let names: Vec<String> = self.unused().iter().map(|name| quoted(name)).collect();
        Some(format!("the {noun} {} {verb} used nowhere in the plant", names.join(", ")))
    }

    /// These parameters, with those marked that occur in none of the texts of these members of the plant.
    #[must_use]
    pub fn used_in(mut self, members: &[&serde_json::Value]) -> Parameters {
        let used = |name: &str| members.iter().any(|member| mentions(name, member));
        self.unused = self.list.iter().map(|one| one.name.clone()).filter(|name| !used(name)).collect();
        self
    }
}

fn mentions(name: &str, value: &serde_json::Value) -> bool {
    match value {
        serde_json::Value::String(text) => occurs(name, text),
        serde_json::Value::Array(list) => list.iter().any(|value| mentions(name, value)),
        serde_json::Value::Object(members) => members.values().any(|value| mentions(name, value)),
        _ => false,
    }
}

/// Reads `parameters`: an object of at most [`MAX_PARAMETERS`] constants, none of which refers to another.
///
/// # Errors
/// Reports names that cannot be used or are those of `states`, and values that are no constants.
pub fn read_parameters(value: &Value<'_>, states: &[String], errors: &mut Errors) -> Result<Parameters, Reported> {
    // The names are the user's: there is none to ask for, and none is unknown.
    drop(value.object(errors)?);
    let members: Vec<(&str, Value<'_>)> = value.members().collect();
    if members.len() > MAX_PARAMETERS {
        let message = format!("{} parameters", members.len());
        return Err(errors
            .report(value.error(ErrorKind::Range, message).expected(format!("expected at most {MAX_PARAMETERS}"))));
    }
    let mut parameters = Parameters::default();
    let mut outcome = Ok(());
    for (name, value) in &members {
        match read_one(name, value, states, &members, errors).and_then(|(constant, interval)| {
            let defined = match &interval {
                None => parameters.definitions.define(name, constant.expr.clone()),
                Some(_) => parameters.definitions.define_interval(name),
            };
            defined.map(|()| (constant, interval)).map_err(|error| refused(value, name, &error, errors))
        }) {
            Ok((value, interval)) => parameters.list.push(Parameter { name: (*name).to_owned(), value, interval }),
            Err(reported) => outcome = Err(reported),
        }
    }
    let count = parameters.named_intervals().count();
    if count > MAX_INTERVALS {
        let message = format!("{count} parameters with intervals");
        let error = value.error(ErrorKind::Range, message).expected(format!("expected at most {MAX_INTERVALS}"));
        return Err(errors.report(error.help("state single numbers for those that matter least")));
    }
    outcome.map(|()| parameters)
}

fn read_one(
    name: &str,
    value: &Value<'_>,
    states: &[String],
    members: &[(&str, Value<'_>)],
    errors: &mut Errors,
) -> Result<(Constant, Option<Interval>), Reported> {
    if states.iter().any(|state| state == name) {
        let message = format!("the parameter `{name}` has the name of a state");
        let error = value.error_at_key(ErrorKind::UnknownName, message);
        return Err(errors.report(error.help("rename one of the two")));
    }
    if matches!(value.type_name(), "an object") {
        let states_an_end = ["nominal", "low", "high"].iter().any(|end| value.member(end).is_some());
        if OF_FILE.contains(&name) && !states_an_end {
            let message = format!("`{name}` stands among the parameters");
            return Err(errors.report(value.error_at_key(ErrorKind::UnknownField, message).help(belongs_above(name))));
        }
        return read_interval(value, name, members, errors);
    }
    no_list(value, errors)?;
    no_reference(value, name, members, errors)?;
    any_constant(value, errors).map(|constant| (constant, None))
}

/// Reads an interval; one of a single point is a constant.
fn read_interval(
    value: &Value<'_>,
    name: &str,
    members: &[(&str, Value<'_>)],
    errors: &mut Errors,
) -> Result<(Constant, Option<Interval>), Reported> {
    no_share(value, errors)?;
    no_reach(value, errors)?;
    let mut object = value.object(errors)?;
    let mut number = |field| {
        let value = object.required(field, errors)?;
        no_reference(&value, name, members, errors)?;
        let constant = any_constant(&value, errors)?;
        match constant.as_rational().cloned() {
            Some(rational) => Ok((value, constant, rational)),
            None => {
                let message = format!("`{field}` is not known to be rational");
                Err(errors.report(whole(&value, ErrorKind::Range, message).expected("expected a rational number")))
            }
        }
    };
    let (nominal, low, high) = (number("nominal"), number("low"), number("high"));
    object.finish(errors);
    let ((place, constant, nominal), (low_place, low_end, low), (_, high_end, high)) = (nominal?, low?, high?);
    if let Some(error) = exchanged(&low_place, &low_end, &high_end) {
        return Err(errors.report(error));
    }
    if low > nominal || nominal > high {
        let [nominal, low, high] = [&nominal, &low, &high].map(write_exact);
        let message =
            format!("the nominal value of `{name}`, {nominal}, is not between `low`, {low}, and `high`, {high}");
        let error = whole(&place, ErrorKind::Range, message).expected("expected low <= nominal <= high");
        return Err(errors.report(error));
    }
    let interval = (low < high).then_some(Interval { nominal, low, high });
    Ok((constant, interval))
}

/// That the text of a value has no name of a parameter in it.
fn no_reference(
    value: &Value<'_>,
    name: &str,
    members: &[(&str, Value<'_>)],
    errors: &mut Errors,
) -> Result<(), Reported> {
    let refers = value.text().and_then(|text| members.iter().map(|member| member.0).find(|name| occurs(name, text)));
    // A name of the language's own is refused for that.
    let Some(other) = refers.filter(|other| Definitions::none().admits(other).is_ok()) else { return Ok(()) };
    let message = format!("the value of `{name}` refers to the parameter `{other}`");
    let error = value.error(ErrorKind::Expression, message);
    Err(errors.report(error.help("write its number: values of parameters do not depend on each other")))
}

fn refused(value: &Value<'_>, name: &str, error: &DefinitionError, errors: &mut Errors) -> Reported {
    let message = format!("the parameter `{}`: {error}", super::error::shown(name));
    let expected = "expected different names such as k or J_1, other than t, e, u, pi and the functions";
    errors.report(value.error_at_key(ErrorKind::UnknownName, message).expected(expected))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::{Document, SpecErrors};

    fn read(text: &str) -> Result<Parameters, SpecErrors> {
        let document = Document::parse("plant", text)?;
        let mut errors = Errors::new();
        let outcome = read_parameters(&document.root(), &["x1".to_owned()], &mut errors);
        errors.conclude(&document, outcome)
    }

    #[test]
    fn constants_under_their_names() {
        let all = read(r#"{ "J": "0.02", "k": 4, "w": "2*pi/3" }"#).unwrap();
        let written: Vec<(&str, &str)> =
            all.list().iter().map(|one| (one.name.as_str(), one.value.text.as_str())).collect();
        assert_eq!(written, [("J", "0.02"), ("k", "4"), ("w", "2*pi/3")]);
        assert!(read("{}").unwrap().list().is_empty());
        let members = [serde_json::json!(["-k*x1"]), serde_json::json!({ "kind": "box", "X0": "w/2" })];
        assert!(all.unused().is_empty());
        assert_eq!(all.used_in(&members.each_ref()).unused(), ["J"]);
    }

    #[test]
    fn what_cannot_be_a_parameter_is_told_in_its_place() {
        let many: Vec<String> = (0..=MAX_PARAMETERS).map(|i| format!("\"k{i}\": 1")).collect();
        let most = many[..MAX_PARAMETERS].join(", ");
        assert_eq!(read(&format!("{{ {most} }}")).unwrap().list().len(), MAX_PARAMETERS);
        for (text, told) in [
            (format!("{{ {} }}", many.join(", ")), "13 parameters"),
            ("[1]".to_owned(), "is an array"),
            (r#"{ "t": 1 }"#.to_owned(), "another meaning"),
            (r#"{ "u": 1 }"#.to_owned(), "another meaning"),
            (r#"{ "sin": "sin(1)" }"#.to_owned(), "another meaning"),
            (r#"{ "2k": 1 }"#.to_owned(), "no name"),
            (r#"{ "x1": 1 }"#.to_owned(), "the name of a state"),
            (r#"{ "k": 1, "k": 2 }"#.to_owned(), "twice"),
            (r#"{ "k": 1, "m": "2*k" }"#.to_owned(), "refers to the parameter `k`"),
            (r#"{ "k": "2*k" }"#.to_owned(), "refers to the parameter `k`"),
            (r#"{ "k": "1/0" }"#.to_owned(), "no value that can be enclosed"),
            (r#"{ "k": "x1" }"#.to_owned(), "not a known name"),
            (r#"{ "k": true }"#.to_owned(), "a boolean"),
        ] {
            let error = read(&text).map(|_| ()).unwrap_err().to_string();
            assert!(error.contains(told), "{text}: {error}");
        }
    }
}
