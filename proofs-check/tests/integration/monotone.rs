//! Rule: bounding functions are finite, nonnegative and nondecreasing.

use proofs_check::expr::{ARGUMENTS, Expr};
use proofs_check::rules::bounding::prove;
use proofs_check::verdict::Verdict::{self, Invalid, Undecided};
use rug::Rational;

fn verdict(text: &str, x: i64, e: i64) -> Option<Verdict> {
    let expr = Expr::parse(text, ARGUMENTS).unwrap();
    prove("q", &expr, &Rational::from(x), &Rational::from(e), 128).err().map(|finding| finding.verdict)
}

#[test]
fn proved() {
    for text in [
        "0",
        "1",
        "X + E",
        "X*E",
        "X^2 + 3",
        "sqrt(1 + E^2)",
        "sqrt(X)",
        "sqrt(X*E)",
        "X^1.5",
        "X^2/(1 + X)",
        "X/(1 + X)",
        "atan(E*(X + 1))",
        "tanh(X)",
        "exp(X) - 1",
        "log(1 + X)",
        "X - atan(X)",
        "max(X, E)",
        "min(X, 1)",
        "abs(X - 20) + 2*X",
        "2 - cos(X/10)",
        "X*exp(-X/100)",
        "X - X^2/40",
        "1/(11 - X)",
        "(1 + X)^E",
        "sqrt(2) - sqrt(2) + X",
        "5 + sin(X/10)",
        // The growth of e^u, where u is negative.
        "X^2*exp(-X/20)",
        "X^3*E*exp(-X/10 - E/20)",
        // Derivatives that vanish at an edge.
        "(1 + X)*log(1 + X) - X",
        "1 - cos(min(X, 3))",
        "1 - cos(min(X, 3)) + E^2*(1 - cos(min(X, 3)))",
        "X - sin(X)",
        "X^2.5 - X^2/1e9 + X^2",
        // Derivatives that vanish inside.
        "X^3 - 3*X^2 + 3*X",
        "X^3 - X^2 + X/3 + 1",
        "(X^3 - X^2 + X/3)*(1 + E) + atan(X*E)",
        "sqrt(1 + X^3 - X^2 + X/3) - E^2 + E + E^3/3",
        "(X - 1/3)^5 + 1/243 + tanh(E)",
        // Exactly 0 at the origin, which rounding leaves open.
        "X + 0.1*exp(X) - 0.1 + E",
        "X + sqrt(2)*sqrt(3) - sqrt(6)",
    ] {
        assert_eq!(verdict(text, 10, 10), None, "{text}");
    }
    // Smooth in what matters, and far beyond it nearly constant.
    assert_eq!(verdict("tan(min(X, 1)) + 1e-3*E", 1_500_000, 1), None);
    // A box that is a single point has nothing to be monotone along.
    assert_eq!(verdict("2 - X", 0, 0), None);
}

#[test]
fn refuted() {
    for text in [
        "X - 1",
        "-1",
        "1 - X",
        "E - X + 20",
        "cos(X)",
        "abs(X - 1)",
        "20*X - X^2 - X^3",
        "1/(1 + X)",
        "exp(-E)",
        "X^X",
        "max(1, 2 - E)",
        "X^2 - X + 1",
        "(5 + X)/(1 + X)",
        "(5 + E)/(1 + E)",
        "2*X - X^2",
        "exp(X)*exp(-2*X)",
        "sqrt(20 - X)",
        "tanh(X) - X",
        "(2 + X)^(1 - X)",
        "min(X, 5 - X) + 20",
        "X^2*exp(-X/4)",
        "(1 + X)*log(1 + X) - 3*X",
        "X^3 - 3*X^2 + 2.99*X",
        "(X - 1)^2 + 1",
        "(X - 1)^2*(X - 2) + 3",
        "X + 0.1*exp(X) - 0.11 + E",
    ] {
        assert_eq!(verdict(text, 10, 10), Some(Invalid), "{text}");
    }
    // The same is a bounding function on a smaller box.
    assert_eq!(verdict("X - X^2/4", 3, 1), Some(Invalid));
    assert_eq!(verdict("X - X^2/4", 2, 1), None);
}

#[test]
fn not_defined_somewhere_is_never_proved() {
    for text in ["1/(X - 5)", "log(X)", "1/X", "tan(X)", "sqrt(X - 1)", "1/0", "X^(0-1/2)", "0^(X-X)", "1/(10 - X)"] {
        assert!(verdict(text, 10, 10).is_some(), "{text}");
    }
}

#[test]
fn an_unsettled_function_is_undecided_with_its_place() {
    // Nondecreasing, but the derivative vanishes inside at a place that no piece ends at, and it is no polynomial: no cutting
    // proves it. The second has a dip too narrow for the corners of the pieces to find and too real to be proved away.
    for text in ["exp(X)*(X^2 - 8*X/3 + 25/9)", "X + 1e-9*sin(1e12*X)"] {
        let expr = Expr::parse(text, ARGUMENTS).unwrap();
        let finding = prove("q_e", &expr, &Rational::from(2), &Rational::from(2), 128).expect_err(text);
        assert_eq!((finding.verdict, finding.pointer.as_str()), (Undecided, "/specification/bounds/q_e"), "{text}");
        assert_eq!(finding.rule, proofs_check::rules::bounding::RULE);
        assert!(finding.message.contains("is not proved on ["), "{}", finding.message);
    }
}

#[test]
fn polynomials_too_large_to_add_are_not_forgotten() {
    // Each fits the limits, their sum does not: it is a rest as a whole, and with it the derivative at 1 is about -1.6.
    let large = |digit: &str, ends: &str| digit.repeat(649) + ends;
    let slopes = format!("{}*X/{} + {}*X/{}", large("7", "1"), large("9", "1"), large("8", "3"), large("9", "7"));
    assert_eq!(verdict(&format!("X^3 - 3*X^2 + 3*X - ({slopes})"), 10, 1), Some(Invalid));
    assert_eq!(verdict(&format!("X^3 - 3*X^2 + 3*X + ({slopes})"), 10, 1), None);
    assert_eq!(verdict(&format!("X^3 - 3*X^2 + 3*X - ({slopes}) + 2*X"), 10, 1), None);
}
