//! The conditions that a certificate shows, and how tight the sizes in its claim are, against the numbers by which the independent checker
//! decides it. The checker itself does not look at them.

use crate::support::{files, read};
use proofs_check::data::Data;
use proofs_check::interval::Interval;
use proofs_check::json::{Field, parse};
use proofs_check::rules::claim::Claim;
use proofs_check::rules::common::Evaluated;
use proofs_check::rules::control;
use proofs_check::rules::derivation::Derivation;
use proofs_check::spec::Specification;
use proofs_check::verdict::Condition;
use rayon::prelude::*;
use rug::ops::Pow;
use rug::{Float, Rational};
use serde_json::Value;
use std::path::PathBuf;

/// The precisions, in bits, at which they are computed: it is enough that one of them gives the stored ones.
const PRECISIONS: [u32; 3] = [128, 256, 512];
/// That of the numbers that are compared, in bits.
const BITS: u32 = 512;
/// The digits of the ends of an enclosure that are certain, and those of an upper end in a claim.
const DIGITS: [i32; 2] = [15, 11];

/// What the checker evaluates of a certificate; the sizes of its periodic solution, and of the control.
struct Checked {
    conditions: Vec<Condition>,
    sizes: Vec<(&'static str, Interval)>,
    of_plant: bool,
}

fn evaluate(certificate: &Value, precision: u32) -> Checked {
    let text = certificate.to_string();
    let json = parse(text.as_bytes()).expect("JSON");
    let mut file = Field { json: &json, pointer: String::new() }.fields().expect("an object");
    let mut witness = file.required("witness").and_then(|field| field.fields()).expect("a witness");
    let plant = file.optional("plant");
    let spec = match &plant {
        Some(plant) => proofs_check::plants::read::read(plant, &mut witness).map(|(spec, _)| spec),
        None => file.required("specification").and_then(|field| Specification::read(&field, &mut witness)),
    };
    let mut spec = spec.expect("it is read");
    let has_states = spec.plant.as_ref().is_some_and(|plant| plant.states > 0);
    let field = file.required("claim").expect("a claim");
    let claim = Claim::read(&field, has_states).expect("it is read");
    if let Some(actuator) = &mut spec.actuator {
        actuator.by_n_o = claim.keeps_to_actuator_by_n_o().expect("it is read");
    }
    let derivation = match &claim.sampled {
        Some(regulator) => Derivation::read_sampled(&mut witness, regulator, (claim.set.clone(), claim.scope())),
        None => Derivation::read(&mut witness, claim.sigma.clone(), (claim.set.clone(), claim.scope())),
    };
    let d = Data::new(&spec, precision);
    let evaluated = derivation.and_then(|derivation| derivation.evaluate(&d)).expect("it is evaluated");
    let Evaluated { conditions, sizes, control, .. } = evaluated;
    let control = control::NAMES.into_iter().zip(control);
    Checked { conditions, sizes: sizes.named(&d).into_iter().chain(control).collect(), of_plant: plant.is_some() }
}

/// How far apart two numbers may lie that agree to so many digits; that of the program may be enclosed as widely as this one.
fn slack(value: &Interval, digits: i32) -> Float {
    let [lo, hi] = [value.lo().into_owned(), value.hi().into_owned()];
    let size = Float::with_val(BITS, lo.abs_ref()).max(&Float::with_val(BITS, hi.abs_ref()));
    size * Float::with_val(BITS, 10).pow(-digits) + (hi - lo) * 4u32
}

fn number(text: &Value) -> Option<Float> {
    let text = text.as_str()?;
    let (n, d) = text.split_once('/').unwrap_or((text, "1"));
    let [n, d] = [n, d].map(|part| Some(Float::with_val(BITS, Float::parse(part).ok()?)));
    Some(n? / d?)
}

/// Whether the stored ends lie on their sides of a number, and no further from it than their digits make it.
fn encloses(ends: &Value, mine: &Interval) -> bool {
    let [Some(lo), Some(hi)] = [0, 1].map(|end| number(&ends[end])) else { return false };
    let slack = slack(mine, DIGITS[0]);
    let [low, high] = [mine.lo().into_owned(), mine.hi().into_owned()];
    let near = |a: Float, b: Float| a == b || a - b <= slack;
    lo <= high && hi >= low && near(low, lo) && near(hi, high)
}

fn agrees(stored: &Value, mine: &Condition) -> bool {
    let margin = &mine.rhs - &mine.lhs;
    let near = number(&stored["margin"])
        .is_some_and(|stored| (stored - margin.lo().into_owned()).abs() <= slack(&margin, DIGITS[0]));
    stored["id"] == mine.id
        && stored["what"] == mine.what.as_str()
        && stored["relation"] == mine.relation.symbol()
        && encloses(&stored["lhs"], &mine.lhs)
        && encloses(&stored["rhs"], &mine.rhs)
        && near
}

/// What of a certificate is not as the checker has it: conditions, and sizes that are larger than their rounding makes them.
pub fn differing(certificate: &Value) -> Vec<String> {
    let mut all = Vec::new();
    for precision in PRECISIONS {
        all = differing_at(certificate, precision);
        if all.is_empty() {
            break;
        }
    }
    all
}

fn differing_at(certificate: &Value, precision: u32) -> Vec<String> {
    let Checked { conditions, sizes, of_plant } = evaluate(certificate, precision);
    // A ball and a domain of a plant are compared exactly, by matrices, not by these two numbers.
    let compared = |id: &str| !of_plant || !["set", "domain"].contains(&id);
    let mine: Vec<&Condition> = conditions.iter().filter(|condition| compared(condition.id)).collect();
    let stored = certificate["conditions"].as_array().expect("a list");
    let stored: Vec<&Value> = stored.iter().filter(|stored| compared(stored["id"].as_str().expect("a text"))).collect();
    let mut all = Vec::new();
    if stored.len() != mine.len() {
        all.push(format!("{} conditions, not {}", stored.len(), mine.len()));
    }
    all.extend(
        stored
            .iter()
            .zip(mine)
            .filter(|(stored, mine)| !agrees(stored, mine))
            .map(|(stored, mine)| format!("{stored} is not {}", mine.line())),
    );
    for (name, mine) in sizes {
        let claim = &certificate["claim"];
        let stored = [&claim["periodic_solution"][name], &claim["control"][name]].into_iter().find_map(number);
        let is_tight = |stored: Float| stored - mine.hi().into_owned() <= slack(&mine, DIGITS[1]);
        if !stored.is_none_or(is_tight) {
            all.push(format!("{name} is larger than {mine:?}"));
        }
    }
    all
}

/// Asserts that nothing differs.
#[track_caller]
pub fn assert_agrees(certificate: &Value) {
    let found = differing(certificate);
    assert!(found.is_empty(), "{found:#?}");
}

/// The certificates of the program that the checker is shipped with, of every kind; those made by hand show no conditions.
#[test]
fn stored_certificates_show_what_is_decided() {
    let folders = ["certificates", "sampled", "plants", "gain", "rates", "actuator"];
    let all: Vec<(PathBuf, Value)> = folders
        .iter()
        .flat_map(|folder| files(&format!("proofs-check/tests/{folder}")))
        .map(|path| (path.clone(), read(path)))
        .filter(|(_, file)| file["conditions"].as_array().is_some_and(|list| !list.is_empty()))
        .collect();
    assert!(all.len() > 45, "{}", all.len());
    let wrong: Vec<(&PathBuf, Vec<String>)> = all
        .par_iter()
        .map(|(path, certificate)| (path, differing(certificate)))
        .filter(|(_, found)| !found.is_empty())
        .collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// What is wrong is seen, by as little as the digits show.
#[test]
fn wrong_figures_are_seen() {
    let stored = read("proofs-check/tests/certificates/paper-example.sharp.json");
    assert_agrees(&stored);
    let moved = |pointer: &str, factor: Rational| {
        let mut made = stored.clone();
        let place = made.pointer_mut(pointer).expect("it exists");
        let exact = proofs_check::json::rational(place.as_str().expect("a text")).expect("a number") * factor;
        *place = exact.to_string().into();
        differing(&made).len()
    };
    let up = |digits: u32| Rational::from(1) + Rational::from((1, rug::Integer::from(10).pow(digits)));
    for side in ["/conditions/7/lhs/0", "/conditions/7/lhs/1", "/conditions/7/rhs/1", "/conditions/7/margin"] {
        assert_eq!((moved(side, up(13)), moved(side, up(13).recip())), (1, 1), "{side}");
    }
    assert_eq!(moved("/claim/periodic_solution/x", up(9)), 1);
    for (pointer, value) in
        [("/conditions/7/id", "C5"), ("/conditions/7/what", "true"), ("/conditions/13/relation", "<=")]
    {
        let mut made = stored.clone();
        *made.pointer_mut(pointer).unwrap() = value.into();
        assert_eq!(differing(&made).len(), 1, "{pointer}");
    }
    let mut made = stored.clone();
    made["conditions"].as_array_mut().unwrap().pop();
    assert_eq!(differing(&made).len(), 1);
}
