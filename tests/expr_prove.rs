//! Proofs and refutations of bounding functions, through the public interface.

use rug::Rational;
use sigmastar::expr::{BoundingFailure, Expr, ProofSettings, Variables, prove_bounding};

fn prove(text: &str, x_max: &str, e_max: &str) -> Result<(), BoundingFailure> {
    let expr = Expr::parse(text, Variables::XAndE).unwrap();
    let number = |text: &str| sigmastar::number::parse_decimal(text).unwrap();
    let start = std::time::Instant::now();
    let r = prove_bounding(&expr, &number(x_max), &number(e_max), &ProofSettings::default());
    println!(
        "{text} {x_max} {e_max}: {:?} {}",
        start.elapsed(),
        match &r {
            Ok(()) => "ok".into(),
            Err(e) => e.to_string(),
        }
    );
    r
}

#[test]
fn look() {
    for text in [
        "0",
        "X^2",
        "sqrt(E)",
        "E*X",
        "X*E^2+0*X",
        "abs(X)",
        "sqrt(X^2+E^2)",
        "max(X, E)",
        "1/(1+X)",
        "X^2/(1+X)",
        "X/(1+X)",
        "exp(X)-1",
        "X - sin(X)",
        "tanh(X)",
        "log(1+X)",
        "atan(E*(X+0.189))",
        "(X-1)^2",
        "4.822 + X + atan(E*(X + 0.189))",
        "1/(X-5)",
        "1/(X-pi)",
        "X*E/(1+X)",
        "E*X^2/(1+X)",
        "X^(1/2)",
        "X^(3/2)*E",
        "X^E",
        "(1+X)^E",
        "min(X,E)",
        "X^3-3*X^2+3*X",
        "sqrt(2)*sqrt(2)-2+X",
        "1-1/(1+X)",
        "X^2/(1+X^2)",
        "sqrt(1+X^2)-1",
        "X*exp(E)",
        "log(1+X*E)",
        "1+X*cos(X/100)",
        "X+sin(X)",
        "2*X+sin(X)*cos(E)",
        "X*E-E+E",
        "sqrt(X*E)",
        "abs(X-E)",
        "X^2-X*E+E^2+X*E",
        "tan(X)",
        "sqrt(X)/(1+sqrt(X))",
        "X+E/(1+X+E)",
        "(X+E)^2/(1+X+E)",
        "sqrt(X^2+0.01)-0.1",
        "1e-40-1e-40*X",
        "atan(X)-X/(1+X^2)",
        "-0*X",
        "exp(X^2)",
        "exp(exp(X))",
        "max(X-1,0)^2",
        "abs(X-1)+X",
        "1+(X-1)^3",
        "sinh",
        "X*tanh(X)",
        "X*atan(X)",
        "sqrt(1+E^2)*X + 0.2237*X^2",
    ] {
        if Expr::parse(text, Variables::XAndE).is_err() {
            continue;
        }
        let _ = prove(text, "10", "10");
    }
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
        "1+X-X",
        "(X+E)*(X+E)/(1+X+E)",
    ] {
        for (a, b) in [("0", "0"), ("0", "1e12"), ("1e12", "0"), ("1e12", "1e12"), ("1e-12", "1e-12")] {
            let _ = prove(text, a, b);
        }
    }
}
