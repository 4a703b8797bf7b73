//! Hostile input ends: what is read and worked on is counted in steps, and the counts are what is tested, never the clock.

use crate::support::{EXAMPLE_TEXT, PLANT_TEXT, every, program};
use rug::Rational;
use serde_json::{Value, json};
use sigmastar_decide::conditions::prove_up_to;
use sigmastar_document::progress::Silent;
use sigmastar_exact::enclosure::{Enclosure, MAX_EXACT_EXPONENT};
use sigmastar_lab::simulate::{
    ClosedLoop, IntegrationFailure, MAX_NUMBERS, MAX_OPERATIONS, SteadyStateError, steady_state,
};
use sigmastar_lang::expr::{BoundingFailure, Expr, ProofSettings, Reason, Variables, prove_bounding};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Document, MAX_UNKNOWN, Specification, any_constant};
use sigmastar_propose::lyapunov::MAX_PROGRAM_COST;
use sigmastar_propose::search::{Failing, Obstacle};
use sigmastar_prove::certify::{MAX_SEARCHES, Outcome, certify, resolve};
use sigmastar_regulator::Design;

fn with(pointer: &str, value: Value) -> Value {
    let mut document: Value = serde_json::from_str(EXAMPLE_TEXT).unwrap();
    *document.pointer_mut(pointer).expect("a field of the example") = value;
    document
}

fn read(document: &Value) -> Specification {
    Specification::from_json("hostile", &document.to_string()).unwrap()
}

fn bits(value: &Rational) -> u32 {
    value.numer().significant_bits().max(value.denom().significant_bits())
}

#[test]
fn numbers_become_rationals_of_bounded_size() {
    let at = |text: &str| Expr::parse(text, Variables::None).unwrap().enclose_constant(128);
    let limit = MAX_EXACT_EXPONENT as u32 + 256;
    for text in ["exp(7e8)", "exp(1e10)", "exp(5e18)", "-exp(7e8)", "1e4000^1000"] {
        let value = at(text);
        assert!(value.is_defined(), "{text}");
        let ends = [value.lower_rational(), value.upper_rational()];
        assert!(ends.iter().any(Option::is_none), "{text}");
        assert!(ends.iter().flatten().all(|end| bits(end) <= limit), "{text}");
    }
    for text in ["exp(-7e8)", "exp(-1e10)", "-exp(-7e8)", "1e-4000^1000"] {
        let value = at(text);
        let [lower, upper] = [value.lower_rational().unwrap(), value.upper_rational().unwrap()];
        assert!(bits(&lower) <= limit && bits(&upper) <= limit, "{text}");
        // Still on the outer sides.
        assert!(value.lower() >= lower && value.upper() <= upper && lower < upper, "{text}");
        assert_eq!((lower < 0, upper > 0), (text.starts_with('-'), !text.starts_with('-')), "{text}");
    }
    // What has an ordinary size stays exact, up to the largest product of numerals.
    for exact in [Rational::from((3, 8)), Rational::from(5) << 53_000, Rational::from(5) >> 53_000] {
        let value = Enclosure::from_rational(&exact, 64);
        let same = value.upper_rational().unwrap() == exact && value.lower_rational().unwrap() == exact;
        assert!(same, "{} bits", bits(&exact));
    }
}

/// Each of these ran for minutes, or took more than 1.6 GB.
#[test]
fn huge_and_tiny_bounds_are_undecided_with_what_to_do() {
    let fields = ["f", "f_e", "f_xx", "f_ex", "q", "q_e", "q_x", "q_t"];
    let cases = fields.into_iter().flat_map(|field| ["exp(1e10)", "exp(7e8)"].map(|text| (field, text)));
    for (field, text) in cases.step_by(every(5)) {
        let spec = read(&with(&format!("/bounds/{field}"), json!(text)));
        let run = certify(&spec, Default::default()).unwrap();
        assert_eq!(run.verdict.exit_code(), 3, "{field} {text}");
        let told = matches!(run.sharp, Outcome::NotFound(Obstacle { failing: Failing::Magnitude(_), .. }));
        assert!(told, "{field} {text}");
    }
    for field in ["f_e", "q_e", "q_x"] {
        let spec = read(&with(&format!("/bounds/{field}"), json!("exp(-7e8)")));
        assert!(certify(&spec, Default::default()).unwrap().verdict.exit_code() != 2, "{field}");
    }
}

#[test]
fn a_proof_counts_its_operations() {
    let term = |k: u32| format!("(sin({k}*X*E)^2 + cos({k}*X*E)^2)");
    let long: Vec<String> = (1..100).map(term).collect();
    let ten = Rational::from(10);
    for text in [format!("1e-9*X + E + 10*{}", term(3)), format!("1e-9*X + E + {}", long.join(" + "))] {
        let expr = Expr::parse(&text, Variables::XAndE).unwrap();
        let settings = ProofSettings { max_operations: 100_000, ..ProofSettings::default() };
        let outcome = prove_bounding(&expr, &ten, &ten, &settings);
        let expected = Reason::Operations(100_000);
        assert!(matches!(outcome, Err(BoundingFailure::Undecided { reason, .. }) if reason == expected), "{outcome:?}");
    }
    // A long expression that needs one box is proved all the same.
    let expr = Expr::parse(&["exp(X)"; 1400].join("+"), Variables::XAndE).unwrap();
    assert_eq!(prove_bounding(&expr, &ten, &ten, &ProofSettings::default()), Ok(()));
}

/// The work is shared by what is hard, whatever its order; what is easy does not suffer.
#[test]
fn hard_bounding_functions_share_the_work() {
    let hard = "1e-9*X + E + 10*(sin(3*X*E)^2 + cos(3*X*E)^2)";
    let shares = |fields: &[&str]| -> Vec<(&'static str, Reason)> {
        let mut document = with("/bounds/q", json!("4.822 + X"));
        for field in fields {
            document["bounds"][*field] = json!(hard);
        }
        let ten = Rational::from(10);
        let problems = prove_up_to(&read(&document), &ten, &ten).unwrap_err();
        problems
            .into_iter()
            .map(|problem| match problem.failure {
                BoundingFailure::Undecided { reason, .. } => (problem.which.field(), reason),
                other => panic!("{other}"),
            })
            .collect()
    };
    assert_eq!(shares(&["f"]), [("f", Reason::Operations(600_000))]);
    let all = ["f", "f_e", "f_xx", "f_ex", "q_e", "q_x"];
    assert_eq!(shares(&all), all.map(|field| (field, Reason::Operations(200_000))));
}

#[test]
fn a_few_unknown_fields_are_named_and_the_others_counted() {
    let mut document: Value = serde_json::from_str(EXAMPLE_TEXT).unwrap();
    for k in 0..4000 {
        document[format!("bouns{k}")] = json!(1);
    }
    let errors = Specification::from_json("hostile", &document.to_string()).unwrap_err();
    assert_eq!((errors.errors().len(), errors.omitted()), (MAX_UNKNOWN, 4000 - MAX_UNKNOWN));
    assert!(errors.errors().iter().all(|error| error.message.contains("unknown field")));
    // One that is close to a known name has its suggestion.
    let mut document: Value = serde_json::from_str(EXAMPLE_TEXT).unwrap();
    document["domian"] = json!(1);
    let errors = Specification::from_json("misspelt", &document.to_string()).unwrap_err();
    assert_eq!((errors.errors().len(), errors.omitted()), (1, 0));
    // The other readers go through the same object.
    let text = PLANT_TEXT
        .replace("\"states\"", "\"x1\": 0, \"x2\": 0, \"x3\": 0, \"x4\": 0, \"x5\": 0, \"x6\": 0, \"states\"");
    let errors = Plant::from_json("hostile", &text).unwrap_err();
    assert_eq!((errors.errors().len(), errors.omitted()), (MAX_UNKNOWN, 1));
}

/// Equal periodic entries on the diagonal: 8 and more of them ran for more than 30 s.
#[test]
fn jacobians_take_a_bounded_number_of_programs_and_searches() {
    for (n, entry) in
        [(3, "-1 + cos(2*pi*t)"), (8, "-1 + cos(2*pi*t)/2"), (10, "-1 + cos(2*pi*t)/2"), (12, "-1 + cos(2*pi*t)/2")]
    {
        let rows: Vec<Vec<&str>> = (0..n).map(|i| (0..n).map(|j| if i == j { entry } else { "0" }).collect()).collect();
        let spec = read(&with("/lyapunov", json!({ "jacobian": rows })));
        let resolution = resolve(&spec).unwrap().unwrap();
        assert!(resolution.candidates.cost <= MAX_PROGRAM_COST, "{n}: {}", resolution.candidates.cost);
        assert!((1..=MAX_SEARCHES).contains(&resolution.searches), "{n}: {}", resolution.searches);
        // What is left still proves most of the rate, which is 1.
        let alpha = resolution.spec.lyapunov.triple().unwrap().alpha.to_f64();
        assert!(alpha > 0.5 && alpha < 1.0, "{n}: {alpha}");
    }
}

/// A plant of n states, all coupled, as JSON.
fn large_plant(n: usize) -> String {
    let names: Vec<String> = (1..=n).map(|k| format!("x{k}")).collect();
    let sum = names.join(" + ");
    let mut plant: Value = serde_json::from_str(PLANT_TEXT).unwrap();
    plant["f"] = names.iter().map(|x| json!(format!("-{n}*{x} + 0.3*({sum}) + e"))).collect();
    plant["q"] = json!(format!("1 + {sum} + cos(2*pi*t)"));
    plant["initial"] = json!({ "x": vec!["1"; n], "e": "1" });
    plant["states"] = json!(names);
    plant.to_string()
}

fn simulated(text: &str, n_o: u32) -> (ClosedLoop, Vec<f64>) {
    let plant = Plant::from_json("large", text).unwrap();
    let document = Document::parse("sigma", "50").unwrap();
    let mut errors = sigmastar_lang::spec::Errors::new();
    let read = any_constant(&document.root(), &mut errors);
    let sigma = errors.conclude(&document, read).unwrap();
    let closed_loop = ClosedLoop::new(&plant, Design::new(&plant.internal_model, &sigma, n_o).regulator());
    let start = closed_loop.start_of(&plant.initial).unwrap();
    (closed_loop, start)
}

/// 50 states, and 200 oscillators, take a part of the operations that are allowed: they ran for minutes.
#[test]
fn many_states_and_oscillators_are_simulated_within_the_limit() {
    for (text, n_o) in [(large_plant(50), 2), (PLANT_TEXT.to_owned(), 200)] {
        let (closed_loop, start) = simulated(&text, n_o);
        let steady = steady_state(&closed_loop, &start, &Silent).unwrap();
        assert!(steady.multipliers[0] < 1.0 && steady.multipliers.len() == closed_loop.dimension());
        assert!(closed_loop.spent() < MAX_OPERATIONS / 4 * 3, "{}", closed_loop.spent());
        assert!(steady.uncertainty < 1e-8, "{}", steady.uncertainty);
    }
}

#[test]
fn a_simulation_beyond_the_limit_is_undecided() {
    let (closed_loop, start) = simulated(&large_plant(50), 200);
    let failure = steady_state(&closed_loop, &start, &Silent).unwrap_err();
    assert!(matches!(failure, SteadyStateError::Integration(IntegrationFailure::TooMuchWork { .. })), "{failure}");
    // Two evaluations of the last integration choose its first step.
    assert!(closed_loop.spent() <= MAX_OPERATIONS + MAX_OPERATIONS / 1000, "{}", closed_loop.spent());
    // Samples that would not fit: told before anything is kept.
    let samples = (MAX_NUMBERS / 2 / 9 + 1).to_string();
    program()
        .args(["simulate", "specs/plants/paper-example.json", "--sigma", "2", "--n-o", "2", "--periods", "100000"])
        .args(["--samples", &samples[..samples.len() - 4]])
        .assert()
        .code(3)
        .stdout(predicates::str::contains("33554432 numbers to keep"));
}

/// A sampling time that would take a million million samples, or numbers that would not fit.
#[test]
fn too_many_samples_are_undecided() {
    let plant =
        ["simulate", "specs/plants/paper-example.json", "--sigma", "2", "--n-o", "2", "--quiet", "--format", "json"];
    for (step, more) in [("1e-12", &[][..]), ("1/1000", &["--periods", "100000"])] {
        let output =
            program().args(plant).args(["--sampled", step]).args(more).assert().code(3).get_output().stdout.clone();
        let report: Value = serde_json::from_slice(&output).unwrap();
        let told = report["long_run"]["error"].as_str().unwrap();
        assert!(told.contains("33554432 numbers to keep"), "{told}");
        let steady = &report["steady_state"];
        assert_eq!(steady["error"].is_string(), more.is_empty(), "{steady}");
    }
}
