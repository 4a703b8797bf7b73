//! Every leaf, field and element of shipped certificates, altered in every way that a forger or an accident might.
//!
//! An ordinary run takes some of the places; `SIGMASTAR_CASES=all` all of them, but of certificates that are like others.
//! A mutant may be accepted only in one of the classes of `harmless`, each of which leaves a true claim.

use crate::common::{BOXES, PAPER, certificate, deleted, every, names, rehash, said, text};
use proofs_check::verdict::Verdict;
use proofs_check::{Report, check};
use rug::Rational;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// Why an accepted mutant that is proved with the same numbers is harmless, or `None`: then it is a hole in the checker.
fn harmless(name: &str, pointer: &str, kind: &str) -> Option<&'static str> {
    let below = |prefix: &str| pointer.starts_with(prefix);
    match pointer {
        _ if kind == "reorder fields" => Some("the order of an object's fields has no meaning"),
        _ if kind.starts_with("appended") && (kind.ends_with("re-hashed") || pointer == "/claim/mu") => {
            Some("white space after an expression")
        }
        "/precision_bits" => Some("where the checker starts; it proves the claim at whatever precision it takes"),
        "/tool/name" | "/tool/version" => Some("free text"),
        "/specification/name" | "/specification/description" if kind.ends_with("re-hashed") => {
            Some("words of the specification that no claim rests on")
        }
        _ if below("/specification/relative_degree") && kind.ends_with("re-hashed") => {
            Some("another filter that is Hurwitz too: the claim is about e, whatever it is made of")
        }
        "/specification/bounds/f" if name == "no-x.sharp" && kind.ends_with("re-hashed") => {
            Some("b_f where b_qx = 0: it enters no condition, and a larger one bounds more plants")
        }
        "/specification/q_0/rest_t_rms" if kind.ends_with("re-hashed") => {
            Some("a bound that only exact regulation uses there: that is proved again")
        }
        _ if ["/constants", "/conditions", "/comparison", "/witness/lmi"].into_iter().any(below) => {
            Some("figures: no claim rests on them")
        }
        _ if below("/witness/lyapunov/P")
            || below("/witness/lyapunov/harmonics")
            || below("/witness/lyapunov_existence/P") =>
        {
            Some("another P(t), with which the same triple is proved")
        }
        _ if below("/specification/lyapunov/jacobian") && kind.ends_with("re-hashed") => {
            Some("another Jacobian, for which P(t) proves the same triple")
        }
        "/witness/transfer/K" => Some("another K with which the matched proof is complete"),
        _ if below("/witness/transfer/boxes/") => Some("other boxes that cover the same region and are proved"),
        // A bound may be larger than what is proved, never smaller.
        _ if below("/claim/periodic_solution/") && (kind.starts_with("up") || kind == "one") => {
            Some("a bound larger than it need be")
        }
        _ => None,
    }
}

/// Why an accepted mutant that is proved with other numbers is true, or `None`: then it is a hole.
fn told(pointer: &str, kind: &str) -> Option<&'static str> {
    let below = |prefix: &str| pointer.starts_with(prefix);
    match pointer {
        _ if below("/witness/") => Some("another witness, with which every condition is proved"),
        _ if below("/specification/") && kind.ends_with("re-hashed") => {
            Some("other data, named by their digest, for which every condition is proved")
        }
        _ => None,
    }
}

/// Why a mutant of the claim is harmless: nothing depends on the words that it has, and another number of it is another claim, which the
/// sentence that is printed names and for which every condition is proved.
pub fn of_claim(pointer: &str, mutant: &Value, report: &Report) -> Option<&'static str> {
    if pointer == "/claim/statement" {
        return Some("words for people, on which nothing depends");
    }
    let numbers = ["/claim/sigma", "/claim/gain", "/claim/initial_set/", "/claim/for_n_o/", "/claim/by_n_o/"];
    let value = mutant.pointer(pointer)?;
    let number = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    let is_named = numbers.iter().any(|at| pointer.starts_with(at)) && said(report).contains(&number);
    is_named.then_some("another claim, which the sentence names, and for which every condition is proved")
}

/// All pointers of a value, parents first.
pub fn pointers(value: &Value, at: String, into: &mut Vec<String>) {
    into.push(at.clone());
    let escape = |key: &str| key.replace('~', "~0").replace('/', "~1");
    match value {
        Value::Object(map) => {
            map.iter().for_each(|(key, child)| pointers(child, format!("{at}/{}", escape(key)), into))
        }
        Value::Array(list) => list.iter().enumerate().for_each(|(i, child)| pointers(child, format!("{at}/{i}"), into)),
        _ => {}
    }
}

fn exact(text: &str) -> Option<Rational> {
    let (numerator, denominator) = text.split_once('/').unwrap_or((text, "1"));
    Some(proofs_check::json::decimal(numerator)? / proofs_check::json::decimal(denominator)?)
}

/// What a leaf is replaced by.
pub fn replacements(leaf: &Value) -> Vec<(&'static str, Value)> {
    let number = |q: Rational| Value::String(q.to_string());
    match leaf {
        Value::String(text) => {
            let mut list: Vec<(&str, Value)> = [
                ("empty", ""),
                ("NaN", "NaN"),
                ("inf", "inf"),
                ("huge exponent", "1e999999999"),
                ("tower", "10^10^10"),
            ]
            .map(|(kind, text)| (kind, text.into()))
            .to_vec();
            list.push(("appended", format!("{text} ").into()));
            if let Some(q) = exact(text) {
                let scaled = |n: i64, d: i64| number(Rational::from((n, d)) * &q);
                if q != 0 {
                    list.push(("up 1e-3", scaled(1001, 1000)));
                    list.push(("down 1e-3", scaled(999, 1000)));
                    list.push(("up 1e-9", scaled(1_000_000_001, 1_000_000_000)));
                    list.push(("down 1e-9", scaled(999_999_999, 1_000_000_000)));
                    list.push(("negated", scaled(-1, 1)));
                    list.push(("zero", "0".into()));
                } else {
                    list.push(("one", "1".into()));
                    list.push(("tiny", "-1e-12".into()));
                }
            }
            list
        }
        Value::Number(n) => {
            let n = n.as_i64().unwrap_or(0);
            [("plus one", n + 1), ("minus one", n - 1), ("negated", -n - 1), ("large", 1_000_000_000)]
                .map(|(kind, n)| (kind, n.into()))
                .to_vec()
        }
        Value::Bool(b) => vec![("flipped", (!b).into()), ("text", "true".into())],
        _ => vec![("text", "x".into())],
    }
}

#[derive(Default)]
struct Tally {
    name: String,
    /// How the certificate itself is proved.
    argument: Vec<String>,
    made: usize,
    accepted: BTreeMap<&'static str, usize>,
    holes: Vec<String>,
}

/// The argument without how much work it was.
fn argument(report: &Report) -> Vec<String> {
    report.lines.iter().filter(|line| !line.starts_with("effort: ")).cloned().collect()
}

impl Tally {
    /// Of a certificate that is valid.
    fn new(name: &str) -> Tally {
        let report = check(text("certificates", name).as_bytes());
        assert!(report.is_valid(), "{name}");
        Tally { name: name.to_owned(), argument: argument(&report), ..Tally::default() }
    }

    fn judge(&mut self, pointer: &str, kind: &str, text: &str) {
        self.made += 1;
        let report = check(text.as_bytes());
        if report.verdict != Verdict::Valid {
            return;
        }
        // Ten digits are shown of each number: what is moved by less may look the same.
        let is_same = argument(&report) == self.argument && !kind.contains("1e-9");
        let harmless = harmless(&self.name, pointer, kind);
        let class = if is_same { harmless } else { harmless.or_else(|| told(pointer, kind)) };
        let class = class.or_else(|| of_claim(pointer, &serde_json::from_str(text).ok()?, &report));
        match class {
            Some(class) => *self.accepted.entry(class).or_default() += 1,
            None => self.holes.push(format!("{pointer}: {kind}")),
        }
    }

    fn report(&self) {
        let name = &self.name;
        println!("{name}: {} mutants, {} accepted", self.made, self.accepted.values().sum::<usize>());
        self.accepted.iter().for_each(|(class, count)| println!("  {count:5}  {class}"));
        assert!(self.holes.is_empty(), "{name}: accepted and not known to be harmless:\n{}", self.holes.join("\n"));
    }
}

/// Every `stride`-th place of a certificate; 1 for all of them.
fn mutate(name: &str, stride: usize, offset: usize) -> Tally {
    let mut all = Vec::new();
    pointers(&certificate(name), String::new(), &mut all);
    mutate_at(name, all.iter().skip(1 + offset).step_by(stride))
}

/// These places of a certificate.
fn mutate_at<'p>(name: &str, places: impl Iterator<Item = &'p String>) -> Tally {
    let original = certificate(name);
    let mut tally = Tally::new(name);
    for pointer in places {
        let value = original.pointer(pointer).unwrap();
        if !value.is_object() && !value.is_array() {
            for (kind, replacement) in replacements(value).into_iter().filter(|(_, new)| new != value) {
                let mut mutant = original.clone();
                *mutant.pointer_mut(pointer).unwrap() = replacement;
                tally.judge(pointer, kind, &mutant.to_string());
                if pointer.starts_with("/specification/") {
                    rehash(&mut mutant);
                    tally.judge(pointer, &format!("{kind}, re-hashed"), &mutant.to_string());
                }
            }
        }
        structure(&original, pointer, &mut tally);
    }
    tally
}

/// Whether a claim rests on a place. The others are figures.
fn rests_on(pointer: &str) -> bool {
    ["/specification/", "/claim/", "/witness/"].iter().any(|at| pointer.starts_with(at))
}

/// Deleting, doubling and moving.
fn structure(original: &Value, pointer: &str, tally: &mut Tally) {
    let (parent, _) = pointer.rsplit_once('/').unwrap();
    let last = pointer[parent.len() + 1..].replace("~1", "/").replace("~0", "~");
    let mut mutant = original.clone();
    match mutant.pointer_mut(parent).unwrap() {
        Value::Object(map) => {
            let removed = map.remove(&last).unwrap();
            tally.judge(pointer, "deleted", &mutant.to_string());
            // The same field twice: only the text can say so.
            let field = format!("{}:{removed}", Value::String(last.clone()));
            let text = original.to_string();
            let position = text.find(&field).unwrap();
            let doubled = format!("{}{field},{}", &text[..position], &text[position..]);
            tally.judge(pointer, "doubled", &doubled);
            let map = mutant.pointer_mut(parent).unwrap().as_object_mut().unwrap();
            map.insert(last, removed);
            if pointer.matches('/').count() <= 2 {
                tally.judge(pointer, "reorder fields", &mutant.to_string());
            }
        }
        Value::Array(list) => {
            let index: usize = last.parse().unwrap();
            list.remove(index);
            tally.judge(pointer, "deleted", &mutant.to_string());
            let mut mutant = original.clone();
            let list = mutant.pointer_mut(parent).unwrap().as_array_mut().unwrap();
            list.insert(index, list[index].clone());
            tally.judge(pointer, "doubled", &mutant.to_string());
            let mut mutant = original.clone();
            let list = mutant.pointer_mut(parent).unwrap().as_array_mut().unwrap();
            if index > 0 && list[index] != list[index - 1] {
                list.swap(index - 1, index);
                tally.judge(pointer, "swapped", &mutant.to_string());
            }
        }
        _ => unreachable!("a parent is an object or an array"),
    }
}

/// Places of every kind that a claim rests on, each in the shortest certificate that has it: altered in one way, another from place to
/// place, and left out. Those are of one kind that are the same field of other elements of a list.
#[test]
fn a_place_of_every_kind() {
    let mut names = names("certificates");
    names.sort_by_key(|name| text("certificates", name).len());
    let kind = |pointer: &str| -> Vec<String> {
        let part = |part: &str| if part.parse::<usize>().is_ok() { "*".to_owned() } else { part.to_owned() };
        pointer.split('/').map(part).collect()
    };
    let mut seen = BTreeSet::new();
    for name in names {
        let original = certificate(&name);
        let mut all = Vec::new();
        pointers(&original, String::new(), &mut all);
        let mut tally = Tally::new(&name);
        for pointer in all.iter().filter(|pointer| rests_on(pointer)) {
            if !seen.insert(kind(pointer)) {
                continue;
            }
            let value = original.pointer(pointer).unwrap();
            let others: Vec<_> = replacements(value).into_iter().filter(|(_, new)| new != value).collect();
            let (kind, replacement) = &others[seen.len() % others.len()];
            let mut mutant = original.clone();
            *mutant.pointer_mut(pointer).unwrap() = replacement.clone();
            tally.judge(pointer, kind, &mutant.to_string());
            if pointer.starts_with("/specification/") {
                rehash(&mut mutant);
                tally.judge(pointer, &format!("{kind}, re-hashed"), &mutant.to_string());
            }
            tally.judge(pointer, "deleted", &deleted(&original, pointer).to_string());
        }
        tally.report();
    }
    assert!(seen.len() > 120, "{}", seen.len());
}

#[test]
fn places_of_a_sharp_certificate() {
    mutate(PAPER, every(17), 0).report();
}

#[test]
fn places_of_a_certificate_by_boxes() {
    mutate(BOXES, 10 * every(7), 1).report();
}

/// What a claim by mean squares rests on: the specification, the claim and the witness. The figures are those of the others.
#[test]
fn places_that_a_claim_by_mean_squares_rests_on() {
    for name in names("certificates").iter().filter(|name| name.ends_with(".means")) {
        let mut all = Vec::new();
        pointers(&certificate(name), String::new(), &mut all);
        mutate_at(name, all.iter().filter(|pointer| rests_on(pointer)).step_by(every(13))).report();
    }
}

#[test]
fn places_of_every_other_certificate() {
    for (offset, name) in
        names("certificates").iter().filter(|name| ![PAPER, BOXES].contains(&name.as_str())).enumerate()
    {
        mutate(name, 60 * every(7), offset).report();
    }
}

#[test]
fn the_specifications_of_every_other_certificate() {
    for name in names("certificates").iter().filter(|name| name.ends_with(".sharp") && *name != PAPER) {
        let original = certificate(name);
        let mut all = Vec::new();
        pointers(&original["specification"], "/specification".to_owned(), &mut all);
        let mut tally = Tally::new(name);
        let leaf = |pointer: &String| original.pointer(pointer).is_some_and(|v| !v.is_object() && !v.is_array());
        for pointer in all.into_iter().filter(leaf).step_by(every(7)) {
            for (kind, new) in replacements(original.pointer(&pointer).unwrap()) {
                let mut mutant = original.clone();
                *mutant.pointer_mut(&pointer).unwrap() = new;
                if mutant != original {
                    rehash(&mut mutant);
                    tally.judge(&pointer, &format!("{kind}, re-hashed"), &mutant.to_string());
                }
            }
        }
        tally.report();
    }
}
