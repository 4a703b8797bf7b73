//! Random numbers and random texts in every notation of a document.

use super::notations::read;
use proptest::prelude::*;
use rug::Rational;
use sigmastar_lang::spec::{Document, Errors, Notation, Specification, any_constant};
/// A decimal numeral of TOML and of JSON, near the corners: signs, exponents, digits apart.
fn numeral() -> impl Strategy<Value = (String, String)> {
    let digits = prop_oneof!["0", "1", "9{1,30}", "[1-9][0-9]{0,25}", "10{0,20}"];
    let fraction =
        prop_oneof![Just(None), "0{1,20}".prop_map(Some), "[0-9]{1,30}".prop_map(Some), Just(Some("1".to_owned()))];
    let exponent = prop_oneof![
        Just(None),
        ("[eE]", "[+-]?", prop_oneof!["0", "00", "[1-9][0-9]{0,2}", Just("400".to_owned()), Just("0300".to_owned())])
            .prop_map(Some)
    ];
    let sign = prop::sample::select(vec!["", "+", "-"]);
    (sign, digits, fraction, exponent, any::<bool>()).prop_map(|(sign, digits, fraction, exponent, apart)| {
        let exponent = exponent.map_or_else(String::new, |(e, sign, digits)| format!("{e}{sign}{digits}"));
        let fraction_text = |text: &dyn Fn(&str) -> String| {
            fraction.as_ref().map_or_else(String::new, |fraction| format!(".{}", text(fraction)))
        };
        let plain = format!("{digits}{}{exponent}", fraction_text(&str::to_owned));
        let spaced = |text: &str| {
            let all: Vec<String> = text.chars().map(|c| c.to_string()).collect();
            all.join("_")
        };
        let written = match apart {
            true => format!("{}{}{exponent}", spaced(&digits), fraction_text(&spaced)),
            false => plain.clone(),
        };
        (format!("{sign}{written}"), format!("{}{plain}", if sign == "-" { "-" } else { "" }))
    })
}

fn rational(text: &str, notation: Notation) -> Rational {
    let document = read(text, notation);
    let mut errors = Errors::new();
    let constant = any_constant(&document.at("/a").expect("there"), &mut errors);
    let constant = errors.conclude(&document, constant).unwrap_or_else(|errors| panic!("{}", errors.render(false)));
    constant.as_rational().expect("rational").clone()
}

/// A decimal by school arithmetic.
fn by_hand(text: &str) -> Rational {
    let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let value: rug::Integer = format!("{whole}{fraction}").parse().expect("digits");
    let scale = exponent.trim_start_matches('+').parse::<i32>().expect("an exponent") - fraction.len() as i32;
    let power = Rational::from(rug::Integer::from(rug::Integer::u_pow_u(10, scale.unsigned_abs())));
    if scale < 0 { Rational::from(value) / power } else { Rational::from(value) * power }
}

proptest! {
    #[test]
    fn a_number_is_the_same_rational_in_every_notation((toml, json) in numeral()) {
        let expected = by_hand(&json);
        prop_assert_eq!(&rational(&format!("a = {toml}"), Notation::Toml), &expected, "{}", toml);
        let object = format!("{{ \"a\": {json} }}");
        prop_assert_eq!(&rational(&object, Notation::Json), &expected);
        prop_assert_eq!(&rational(&format!("/**/{object}"), Notation::JsonWithComments), &expected);
        let text = read(&format!("a = {toml}"), Notation::Toml).root().canonical();
        prop_assert_eq!(text, format!("{{\"a\":{json}}}"));
    }

    #[test]
    fn arbitrary_text_never_panics(text in "[\\[\\]{}:,\"'\\\\a-c0-9eE.+\\-_=# \u{e9}\t\n/*]{0,80}") {
        for notation in [Notation::JsonWithComments, Notation::Toml] {
            match Document::parse_as("x", &text, notation) {
                Err(errors) => prop_assert!(!errors.render(true).is_empty()),
                Ok(document) => {
                    // What is read is a document in JSON, the same one.
                    let again = Document::parse("x", &document.root().to_json().to_string());
                    prop_assert_eq!(again.expect("JSON").root().canonical(), document.root().canonical());
                    if let Err(errors) = Specification::from_value(&document.root()) {
                        prop_assert!(!errors.render(false).is_empty());
                    }
                }
            }
        }
    }

    #[test]
    fn without_comments_it_is_json(text in "[\\[\\]{}:,\"\\\\a-c0-9eE.+\\- \n]{0,60}") {
        let [plain, other] = [Notation::Json, Notation::JsonWithComments].map(|n| Document::parse_as("x", &text, n));
        prop_assert_eq!(plain.map(|d| d.root().canonical()).ok(), other.map(|d| d.root().canonical()).ok());
    }
}
