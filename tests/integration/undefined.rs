//! Every operation that is written must be defined where it is used, whatever it is multiplied with: what is nowhere defined is
//! never certified, in a plant or in a specification, through whichever simplification it goes.

use crate::support::{self, EXAMPLE_TEXT};
use proofs_check::expr::ARGUMENTS;
use proofs_check::verdict::Verdict;
use rug::Rational;
use serde_json::Value;
use sigmastar::{CertifyOptions, ErrorKind, Subject, certify};
use sigmastar_decide::bounds::{Engine, Region};
use sigmastar_lang::expr::{Expr, ProofSettings, Variables, prove_bounding};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{self, TrigonometricVector};

/// Terms that are defined nowhere; `V` is a variable. One for each way in which an operand may be left out: products with 0,
/// powers with exponents 0 and 1 and of bases 0 and 1, differences of equals, quotients of equals and of 0, extremes of which one
/// operand is chosen, constants that are folded, exponents that are read as whole numbers, functions that are constant, and
/// derivatives that are 0.
const TERMS: [&str; 59] = [
    "0/0",
    "0/(1-1)",
    "(1-1)/(1-1)",
    "1/0",
    "0*(0/0)",
    "(0/0)*0",
    "0*(1/0)",
    "0/(0/0)",
    "(0/0)/1",
    "0/sin(pi)",
    "0/cos(pi/2)",
    "0/(sqrt(2)*sqrt(3) - sqrt(6))",
    "0/(sqrt(8) - 2*sqrt(2))",
    "0/log(1)",
    "0/tanh(0)",
    "(0/0)^0",
    "(0/0)^1",
    "(0/0)^2",
    "(0/0)^-1",
    "0^-1*0",
    "0^(1-2)",
    "1^(0/0)",
    "0^(0/0)",
    "2^(0/0)",
    "V^(0/0)",
    "2^(0*(0/0))",
    "(1 + V^2)^(0*(1/0))",
    "2^((0/0)^0)",
    "2^min(1, 0/0)",
    "0*(0-1)^(1/2)",
    "(0-1)^0.5*0",
    "0*(-2)^pi",
    "log(1 + 0/0)",
    "0*log(-1)",
    "0*log(0)",
    "log(0)^0",
    "0*sqrt(-1)",
    "sqrt(-1)^2 + 1",
    "0*tan(pi/2)",
    "tan(pi/2)^0 - 1",
    "min(0, 0/0)",
    "max(0, 0/0)",
    "min(0/0, 1) - min(0/0, 1)",
    "max(1, log(-1)) - 1",
    "0*min(1, sqrt(-1))",
    "0/0 - 0/0",
    "0*abs(0/0)",
    "exp(0/0)*0",
    "atan(0/0) + tanh(1/0)",
    "cos(0*(1/0)) - 1",
    "0*exprelr(0/0)",
    "sinc(1/0)*0 + exprelr(log(0))",
    "sin(V-V)/(V-V) - sinc(V-V)",
    "-(0/0)*0",
    "0*(V/0)",
    "(V-V)/(V-V)",
    "0/(V-V)",
    "0*log(V-V)",
    "(V-V)^-1*0",
];

/// Where the term may stand in an expression: alone, with the result 0, as a factor of 0 and where a derivative drops it.
const PLACES: [&str; 4] = ["TERM", "0*(TERM)", "(TERM)^0 - 1", "V*0*(TERM)"];

fn in_place(index: usize, variable: &str) -> String {
    let term = TERMS[index].replace('V', variable);
    PLACES[index % PLACES.len()].replace("TERM", &term).replace('V', variable)
}

fn plant(f: &str, q: &str) -> String {
    support::plant(&["x"], &[&format!("-x + e/2{f}")], &format!("x/4 + cos(2*pi*t){q}")).to_string()
}

fn refused(what: &str, answer: Result<sigmastar::Certificate, sigmastar::Error>) {
    match answer {
        Ok(_) => panic!("{what} is certified"),
        Err(error) => {
            let honest = [
                ErrorKind::Expression,
                ErrorKind::Range,
                ErrorKind::Undecided,
                ErrorKind::Refuted,
                ErrorKind::NotCertified,
            ];
            assert!(honest.contains(&error.kind()), "{what}: {error}");
        }
    }
}

fn certify_text(text: &str) -> Result<sigmastar::Certificate, sigmastar::Error> {
    certify(Subject::from_json(text)?, &CertifyOptions::new())
}

#[test]
fn the_plant_and_the_specification_are_certified_without() {
    certify_text(&plant("", "")).unwrap();
    certify_text(&plant(" + 0*(x*0)", " + 0^2*e + (e-e)*0 + e^0 - 1")).unwrap();
    certify_text(&plant(" + exprelr(x-x) - 1", " + sinc(0) - exprelr(0) + 0*sinc(e)")).unwrap();
    certify_text(EXAMPLE_TEXT).unwrap();
}

/// In f and in q, of each variable; smoothness refuses it wherever it is asked for, before anything is searched. A
/// quotient of numbers alone is refused where the file is read.
#[test]
fn what_is_undefined_in_a_plant_is_never_smooth() {
    let mut read = [0, 0];
    for index in 0..TERMS.len() {
        for variable in ["x", "e", "t"] {
            let term = in_place(index, variable);
            for [f, q] in [[format!(" + {term}"), String::new()], [String::new(), format!(" + {term}")]] {
                let plant = match Plant::from_json("undefined", &plant(&f, &q)) {
                    Ok(plant) => plant,
                    Err(refused) => {
                        let [error] = refused.errors() else { panic!("{f}{q}: {refused}") };
                        assert_eq!(error.kind, spec::ErrorKind::Expression, "{f}{q}: {error}");
                        assert!(error.message.contains("the divisor is 0"), "{f}{q}: {error}");
                        read[0] += 1;
                        continue;
                    }
                };
                read[1] += 1;
                let still = TrigonometricVector { mean: vec![Rational::new()], harmonics: Vec::new() };
                let region = Region::new(vec![vec![Rational::from(1)]], still, Rational::new()).unwrap();
                let engine = Engine::new(&plant, region, None, None).unwrap();
                for reach in [0, 1].map(Rational::from) {
                    assert!(engine.smooth(&reach, &reach).is_err(), "{f}{q}");
                }
            }
        }
    }
    assert!(read.iter().all(|&count| count > 0), "{read:?}");
}

#[test]
fn what_is_undefined_in_a_plant_is_never_certified() {
    for index in 0..TERMS.len() {
        let variable = ["x", "e"][index % 2];
        let term = format!(" + {}", in_place(index, variable));
        // Every other one in f: both go the same way.
        let text = if index % 4 < 2 { plant(&term, "") } else { plant("", &term) };
        refused(&text, certify_text(&text));
    }
}

/// Every term in a proof of little effort, and one in each field up to the certificate that there must not be.
#[test]
fn what_is_undefined_in_a_bounding_function_is_never_certified() {
    let settings = ProofSettings { max_boxes: 100, max_operations: 2000, ..ProofSettings::default() };
    let fields = ["f", "f_e", "f_xx", "f_ex", "q", "q_e", "q_x", "q_t"];
    let end = Rational::from(2);
    for (index, term) in TERMS.iter().enumerate() {
        for variable in ["X", "E"] {
            let text = format!("1 + X + E + {}", in_place(index, variable));
            let expr = Expr::parse(&text, Variables::XAndE).unwrap();
            assert!(prove_bounding(&expr, &end, &end, &settings).is_err(), "{text}");
        }
        let Some(field) = fields.get(index / 7).filter(|_| index % 7 == 0) else { continue };
        let mut specification: Value = serde_json::from_str(EXAMPLE_TEXT).unwrap();
        let bound = &mut specification["bounds"][*field];
        let text = bound.as_str().unwrap().to_owned();
        *bound = format!("{text} + {}", in_place(index, "X")).into();
        refused(&format!("{field}: {term}"), certify_text(&specification.to_string()));
    }
}

#[test]
fn what_is_undefined_in_a_constant_is_never_certified() {
    for index in (0..TERMS.len()).filter(|index| !TERMS[*index].contains('V')) {
        let places = ["/period", "/lyapunov/alpha", "/lyapunov/p_low", "/internal_model/mu", "/domain/X"];
        let mut specification: Value = serde_json::from_str(EXAMPLE_TEXT).unwrap();
        let constant = specification.pointer_mut(places[index % places.len()]).unwrap();
        *constant = format!("{} + {}", constant.as_str().unwrap(), TERMS[index]).into();
        refused(TERMS[index], certify_text(&specification.to_string()));
    }
}

/// The checker reads a bounding function as the producer does.
#[test]
fn the_checker_proves_nothing_of_a_bounding_function_that_is_undefined() {
    for index in 0..TERMS.len() {
        for variable in ["X", "E"] {
            let text = format!("1 + X + E + {}", in_place(index, variable));
            let Ok(expr) = proofs_check::expr::Expr::parse(&text, ARGUMENTS) else { continue };
            let end = Rational::from(2);
            let prove = || proofs_check::rules::bounding::prove("q", &expr, &end, &end, 128);
            let answer = proofs_check::effort::limited(50_000, prove).0;
            let verdict = answer.map_or_else(|finding| finding.verdict, |()| Verdict::Valid);
            assert!([Verdict::Invalid, Verdict::Undecided].contains(&verdict), "{text}: {verdict:?}");
        }
    }
}
