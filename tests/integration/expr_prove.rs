//! Proofs and refutations of bounding functions, through the public interface.

use rug::Rational;
use sigmastar_exact::number::parse_decimal;
use sigmastar_lang::expr::{
    BoundingFailure, Counterexample, Expr, ProofSettings, Property, Reason, Variables, prove_bounding,
};

fn prove(text: &str, x_max: &str, e_max: &str) -> Result<(), BoundingFailure> {
    let expr = Expr::parse(text, Variables::XAndE).unwrap();
    let [x_max, e_max] = [x_max, e_max].map(|text| parse_decimal(text).unwrap());
    prove_bounding(&expr, &x_max, &e_max, &ProofSettings::default())
}

fn refuted(text: &str, x_max: &str, e_max: &str) -> (Property, Counterexample, Option<String>) {
    match prove(text, x_max, e_max) {
        Err(BoundingFailure::Refuted { property, counterexample, span }) => {
            (property, *counterexample, span.map(|span| text[span].to_owned()))
        }
        other => panic!("{text}: {other:?}"),
    }
}

#[test]
fn bounding_functions_are_proved() {
    for text in [
        "0",
        "7",
        "X^2",
        "sqrt(E)",
        "E*X",
        "X*E^2 + 0*X",
        "-0*X",
        "1 + X - X",
        "abs(X)",
        "abs(X - 1) + X",
        "1 + (X - 1)^3",
        "sqrt(X^2 + E^2)",
        "sqrt(X*E)",
        "sqrt(X^2 + 0.01) - 0.1",
        "sqrt(2)*sqrt(2) - 2 + X",
        "max(X, E)",
        "min(X, E)",
        "max(X - 1, 0)^2",
        "X^2/(1 + X)",
        "E*X^2/(1 + X)",
        "X/(1 + X)",
        "X*E/(1 + X + E)",
        "X/sqrt(1 + X^2)",
        "(X + E)^2/(1 + X + E)",
        "X + E/(1 + X + E)",
        "sqrt(X)/(1 + sqrt(X))",
        "1 - 1/(1 + X)",
        "exp(X) - 1",
        "exp(X^2)",
        "exp(exp(X))",
        "X - sin(X)",
        "X + sin(X)",
        "1 - cos(X/10)",
        "tanh(X)",
        "X*tanh(E)",
        "log(1 + X)",
        "log(1 + X*E)",
        "tan(X/10)",
        "atan(E*(X + 0.189))",
        "4.822 + X + atan(E*(X + 0.189))",
        "sqrt(1 + E^2)*X + 0.2237*X^2",
        "X^3 - 3*X^2 + 3*X",
        "E + X^3 - 3*X^2 + atan(E) + 3*X",
        "(X^3 - 3*X^2 + 3*X)*(1 + E)",
        "sqrt(1 + X^3/3 - X^2/3 + X/9)",
        "X^5/5 - X^4/2 + X^3/3 + E^3 - 3*E^2 + 3*E",
        "X^2*exp(-X/20)",
        "(1 + X)*log(1 + X) - X",
        "X + 0.1*exp(X) - 0.1 + E",
        "log(exp(2)) - 2 + X",
        "X^(1/2)",
        "X^(3/2)*E",
        "(1 + X)^E",
        "2^X",
    ] {
        prove(text, "10", "10").unwrap_or_else(|failure| panic!("{text}: {failure}"));
    }
}

#[test]
fn any_size_of_domain() {
    for text in [
        "X^2",
        "sqrt(E)",
        "X/(1+X)",
        "X^2/(1+X)",
        "X - sin(X)",
        "tanh(X)",
        "log(1+X)",
        "atan(E*(X+0.189))",
        "sqrt(X^2+E^2)",
        "exp(X)-1",
    ] {
        for (x_max, e_max) in
            [("0", "0"), ("0", "1e12"), ("1e12", "0"), ("1e12", "1e12"), ("1e-12", "1e-12"), ("1e300", "3")]
        {
            prove(text, x_max, e_max).unwrap_or_else(|failure| panic!("{text} on {x_max}, {e_max}: {failure}"));
        }
    }
    // What fails only elsewhere does not count.
    prove("1 - X", "0", "10").unwrap();
    prove("X - X^2", "0.5", "10").unwrap();
    prove("sqrt(2 - X) + 2*X", "1", "0").unwrap();
}

#[test]
fn refutations_name_property_point_and_place() {
    for (text, property, place) in [
        ("1/(1 + X)", Property::NondecreasingInX, None),
        ("(X - 1)^2", Property::NondecreasingInX, None),
        ("2 + X + cos(E)", Property::NondecreasingInE, None),
        ("50 + X - E", Property::NondecreasingInE, None),
        ("abs(X - E)", Property::NondecreasingInE, None),
        ("X - 1e-40", Property::Nonnegative, None),
        ("X - 1", Property::Nonnegative, None),
        ("min(X, -X)", Property::Nonnegative, None),
        ("sqrt(2)*sqrt(2) - 2 - 1e-300*cos(X)", Property::Nonnegative, None),
        ("1 + 1/X", Property::Finite, Some("1/X")),
        ("1 + X/(X - 5)^2", Property::Finite, Some("X/(X - 5)^2")),
        ("X + log(E)", Property::Finite, Some("log(E)")),
        ("X^E", Property::Finite, Some("X^E")),
        ("X + sqrt(10 - E)", Property::NondecreasingInE, None),
        ("X + 2*sqrt(X - E)", Property::Finite, Some("sqrt(X - E)")),
        ("1 + E + X*E^-2", Property::Finite, Some("E^-2")),
    ] {
        let (found, _, span) = refuted(text, "10", "10");
        assert_eq!((found, span.as_deref()), (property, place), "{text}");
    }
}

#[test]
fn narrow_dips_are_found() {
    // Decreasing only on a small part of the domain, between the points of any coarse grid.
    let (property, counterexample, _) = refuted("10 + X + sin(50*X)/49", "10", "1");
    assert_eq!(property, Property::NondecreasingInX);
    let Counterexample::Decrease { from, to } = counterexample else { panic!("{counterexample:?}") };
    assert!(from.x < to.x && from.e == to.e && to.value.lt(&from.value).is_true());
    assert_eq!(refuted("1 + X - 0.01*exp(-(1000*(X - 3.3))^2)", "10", "0").0, Property::NondecreasingInX);
}

#[test]
fn undecided_says_where_and_why() {
    // The derivative touches 0 at X = 1, so close to which enclosures do not see its sign.
    for text in ["exp(X)*(X^2 - 4*X + 5)", "X^3*(1 + E) - 3*X^2*(1 + E) + 3*X*(1 + E)"] {
        match prove(text, "10", "0") {
            Err(BoundingFailure::Undecided { property, region, reason, .. }) => {
                assert_eq!((property, reason), (Property::NondecreasingInX, Reason::Depth), "{text}");
                assert!(region.x.iter().all(|end| (end.to_f64() - 1.0).abs() < 1e-6), "{text}: {region}");
            }
            other => panic!("{text}: {other:?}"),
        }
    }
    // Defined up to X = 1, the end of the domain, where rounding makes the root's argument negative.
    match prove("1 + X - sqrt(1 - X/3 - X/3 - X/3)^4", "1", "0") {
        Err(BoundingFailure::Undecided { property: Property::Finite, span, .. }) => {
            assert_eq!(span, Some(8..33));
        }
        other => panic!("{other:?}"),
    }
    let settings = ProofSettings { max_boxes: 10, ..ProofSettings::default() };
    let ten = Rational::from(10);
    let text = "exp(X)*(X^2 - 4*X + 5)";
    let limited = prove_bounding(&Expr::parse(text, Variables::XAndE).unwrap(), &ten, &ten, &settings);
    assert!(matches!(limited, Err(BoundingFailure::Undecided { reason: Reason::Boxes(10), .. })), "{limited:?}");
    assert!(prove("X^3 - 3*X^2 + 3.001*X", "10", "10").is_ok());
    // A little less, and the derivative is negative on an interval of width 0.02 about X = 1.
    assert_eq!(refuted("X^3 - 3*X^2 + 2.9997*X", "10", "10").0, Property::NondecreasingInX);
    assert!(matches!(
        prove("X", "-1", "1"),
        Err(BoundingFailure::Undecided { property: Property::Finite, reason: Reason::Empty, .. })
    ));
}

#[test]
fn failures_are_sentences() {
    assert_eq!(
        prove("X - 1", "2", "2").unwrap_err().to_string(),
        "the expression is not nonnegative: its value at X = 0, E = 0 lies in [-1, -1]"
    );
    assert_eq!(
        prove("1/X", "2", "2").unwrap_err().to_string(),
        "the expression is not finite: it is undefined at X = 0, E = 0"
    );
    assert_eq!(
        prove("2 - E", "2", "1").unwrap_err().to_string(),
        "the expression is not nondecreasing in E: its value at X = 0, E = 0 lies in [2, 2], \
         and its value at X = 0, E = 0.125 lies in [1.875, 1.875]"
    );
}

#[test]
fn the_answer_is_always_the_same() {
    for text in ["X^3 - 3*X^2 + 3*X", "exp(X)*(X^2 - 4*X + 5)", "10 + X + sin(50*X)/49", "X + E"] {
        assert_eq!(prove(text, "10", "1"), prove(text, "10", "1"), "{text}");
    }
}

#[test]
fn polynomials_too_large_to_add_are_not_forgotten() {
    // Each fits the limits of exact factoring, their sum does not; with it the derivative at 1 is about -1.6.
    let large = |digit: &str, end: &str| digit.repeat(649) + end;
    let slopes = format!("{}*X/{} + {}*X/{}", large("7", "1"), large("9", "1"), large("8", "3"), large("9", "7"));
    let text = format!("20 + X^3 - 3*X^2 + 3*X - ({slopes})");
    assert_eq!(refuted(&text, "10", "1").0, Property::NondecreasingInX);
    assert_eq!(prove(&format!("X^3 - 3*X^2 + 3*X + ({slopes})"), "10", "1"), Ok(()));
}
