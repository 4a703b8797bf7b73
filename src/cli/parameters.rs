//! Values of parameters from flags.

use super::failure::Failure;
use super::input;
use super::output;
use rug::Rational;
use sigmastar_exact::enclosure::{DEFAULT_PRECISION, Enclosure};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Constant, Interval, nearest};

const FLAG: &str = "--parameter";

/// Reads `NAME=VALUE` of each flag; a name twice is an error.
///
/// # Errors
/// Another form, and what is wrong with a constant, in its place.
fn read(texts: &[String]) -> Result<Vec<(String, Constant)>, Failure> {
    let mut all: Vec<(String, Constant)> = Vec::new();
    for text in texts {
        let Some((name, value)) = text.split_once('=').map(|(name, value)| (name.trim(), value)) else {
            return Err(Failure::call(format!("{FLAG} {text} has no value"), "write NAME=VALUE"));
        };
        if all.iter().any(|(other, _)| other == name) {
            return Err(Failure::call(format!("{FLAG} gives `{name}` twice"), "give each parameter once"));
        }
        all.push((name.to_owned(), input::real(FLAG, value)?));
    }
    Ok(all)
}

/// The rational values of flags.
///
/// # Errors
/// Those of the constants, and one that is not rational.
pub fn rational(texts: &[String]) -> Result<Vec<(String, Rational)>, Failure> {
    let exact = |(name, value): (String, Constant)| match value.as_rational() {
        Some(number) => Ok((name, number.clone())),
        None => Err(Failure::call(
            format!("{FLAG} {name} is not known to be rational"),
            "write it as a decimal or a fraction",
        )),
    };
    read(texts)?.into_iter().map(exact).collect()
}

/// The plant with the values that flags give, and remarks on those that no claim covers.
///
/// # Errors
/// Those of the constants, a name that the plant does not have, and a plant that is none with these values.
pub fn member(plant: &Plant, texts: &[String], quiet: bool) -> Result<Plant, Failure> {
    let values = read(texts)?;
    for (name, value) in &values {
        let names = || plant.parameters.list().iter().map(|one| one.name.as_str());
        let Some(parameter) = plant.parameters.list().iter().find(|one| one.name == *name) else {
            let help = match (names().next(), nearest(name, names())) {
                (None, _) => "the file has no `parameters`: leave the flag out".to_owned(),
                (_, Some(near)) => format!("did you mean `{near}`?"),
                _ => format!("its parameters are {}", names().collect::<Vec<_>>().join(", ")),
            };
            return Err(Failure::call(format!("the plant file has no parameter `{name}`"), help));
        };
        let covered = match &parameter.interval {
            Some(Interval { low, high, .. }) => match value.as_rational() {
                Some(value) => value >= low && value <= high,
                None => {
                    let value = value.enclose(DEFAULT_PRECISION);
                    let [low, high] = [low, high].map(|end| Enclosure::from_rational(end, DEFAULT_PRECISION));
                    low.le(&value).is_true() && value.le(&high).is_true()
                }
            },
            None => {
                let exact = value.exact.as_ref().zip(parameter.value.exact.as_ref());
                value.text == parameter.value.text || exact.is_some_and(|(one, other)| one.equals(other).is_true())
            }
        };
        if !covered && !quiet {
            let text = &value.text;
            output::remark(&format!(
                "`{name}` = {text} is not known to be what the plant file states: no claim about it covers this"
            ));
        }
    }
    if values.is_empty() { Ok(plant.clone()) } else { Ok(plant.with_parameters(&values)?) }
}
