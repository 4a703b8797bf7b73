//! The range of an expression of parameters over the box of their intervals (derivation, 13.2).

use super::parameters::Parameters;
use super::parts::Constant;
use crate::expr::{Enclosing, Formulas, PlantExpr, PlantVariable};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;

/// Into so many parts each interval of one, two, three or four that occur is cut.
const PARTS: [u32; 4] = [1024, 32, 10, 5];

/// The ends are moved by 2 to minus this of themselves.
const SLACK: u32 = 36;

/// Bits of the enclosures.
const PRECISION: u32 = 128;

/// Bits of the ends.
const BITS: u32 = 40;

/// Rational numbers of which the first is below and the second above every value of the expression on the box, and nearer to them than
/// the parts are wide; `None` where it may have none somewhere.
///
/// The ends are moved outward by 2^-36 of themselves and rounded outward to 40 bits: whoever encloses over the same parts finds the same.
pub(super) fn range(expr: &PlantExpr, parameters: &Parameters) -> Option<[Rational; 2]> {
    let mut formulas = Formulas::new();
    let formula = formulas.insert(expr);
    let walk = formulas.walk(&[formula]);
    let occurring = walk.all_variables();
    let ends: Vec<[&Rational; 2]> = parameters.intervals().map(|interval| [&interval.low, &interval.high]).collect();
    let occurs = |at: usize| occurring.has(PlantVariable::Parameter(at));
    let count = (0..ends.len()).filter(|at| occurs(*at)).count();
    let parts = count.checked_sub(1).map_or(1, |last| PARTS[last.min(PARTS.len() - 1)]);
    let none = Enclosure::undefined(PRECISION);
    let part = |at: usize, number: u32| {
        let [low, high] = ends[at];
        let corner = |number: u32| low + Rational::from(high - low) * Rational::from((number, parts));
        Enclosure::between(&corner(number), &corner(number + 1), PRECISION)
    };
    let mut range: Option<Enclosure> = None;
    for cell in 0..parts.pow(u32::try_from(count).ok()?) {
        let mut number = cell;
        let values: Vec<Enclosure> = (0..ends.len())
            .map(|at| {
                if !occurs(at) {
                    return none.clone();
                }
                let of_this = number % parts;
                number /= parts;
                part(at, of_this)
            })
            .collect();
        let mut on_box = Enclosing { t: &none, x: &[], e: &none, p: &values, precision: PRECISION };
        let value = walk.evaluate(&mut on_box).pop()?;
        range = Some(range.map_or_else(|| value.clone(), |range| range.hull(&value)));
    }
    let range = range?;
    let (low, high) = (range.lower_rational()?, range.upper_rational()?);
    let slack = |end: &Rational| Rational::from(end.abs_ref()) >> SLACK;
    let (low, high) = (&low - slack(&low), &high + slack(&high));
    let rounded = |end: &Rational| Enclosure::from_rational(end, BITS);
    Some([rounded(&low).lower_rational()?, rounded(&high).upper_rational()?])
}

/// A number in the place of an expression, with the text of that.
pub(super) fn standing_for(expr: &PlantExpr, value: &Rational) -> Constant {
    Constant { text: expr.text().to_owned(), ..Constant::rational(value) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::{Document, Errors, InputGain, SpecErrors, read_input_gain, read_parameters};

    fn read(gain: &str) -> Result<InputGain, SpecErrors> {
        let parameters = r#"{ "J": { "nominal": "0.2", "low": "0.18", "high": "0.22" }, "g": "3/2", "d": { "nominal": 0, "low": -1, "high": 1 } }"#;
        let text = format!(r#"{{ "parameters": {parameters}, "input_gain": {gain} }}"#);
        let document = Document::parse("plant", &text)?;
        let mut errors = Errors::new();
        let root = document.root();
        let [parameters, gain] = ["parameters", "input_gain"].map(|name| root.member(name).unwrap());
        let outcome = read_parameters(&parameters, &[], &mut errors)
            .and_then(|parameters| read_input_gain(&gain, &parameters, &mut errors));
        errors.conclude(&document, outcome)
    }

    #[test]
    fn the_ends_are_outside_of_the_range_and_near_it() {
        let gain = read(r#"{ "nominal": "g/J", "low": "0.9*g/J", "high": "g/J + d/10" }"#).unwrap();
        assert_eq!(gain.nominal.as_rational(), Some(&Rational::from((15, 2))));
        assert_eq!(gain.written().map(|(_, text)| text), ["7.5", "0.9*(3/2)/J", "(3/2)/J + d/10"]);
        let [low, high] = [&gain.low, &gain.high].map(|end| end.as_rational().unwrap().to_f64());
        let (least, most) = (0.9 * 1.5 / 0.22, 1.5 / 0.18 + 0.1);
        assert!(low < least && low > least * (1.0 - 1e-10), "{low}");
        // Of two parameters the parts are 32 by 32; each occurs once, so nothing is lost.
        assert!(high > most && high < most * (1.0 + 1e-10), "{high}");
        let at = |text: &str| Rational::from_str_radix(text, 10).unwrap();
        let [low, high] = gain.ends_at(&[at("1/5"), at("1/2")]).map(|end| end.to_f64());
        assert!((low - 6.75).abs() < 1e-9 && (high - 7.55).abs() < 1e-9, "{low} {high}");
    }

    #[test]
    fn what_has_no_range_or_is_not_positive_is_told() {
        for (gain, told) in [
            (r#"{ "nominal": "1", "low": "1/(J - 0.2)", "high": "9" }"#, "no value that can be enclosed"),
            (r#"{ "nominal": "1", "low": "d", "high": "9" }"#, "must be positive"),
            (r#"{ "nominal": "1/J", "low": "1/J", "high": "0.5/J" }"#, "`high` = 2.777777777"),
            (r#"{ "nominal": "5.7", "low": "1/J", "high": "6" }"#, ""),
            (r#"{ "nominal": "5", "low": "t/J", "high": "6" }"#, "`t` is not a known name"),
            (r#"{ "nominal": "5", "low": "1/J + x1", "high": "6" }"#, "`x1` is not a known name"),
        ] {
            match read(gain) {
                Ok(_) => assert!(told.is_empty(), "{gain}"),
                Err(error) => assert!(!told.is_empty() && error.to_string().contains(told), "{gain}: {error}"),
            }
        }
    }
}
