//! Certificates to start from, and edits of them.

use proofs_check::verdict::Verdict;
use proofs_check::{Report, check, sha256};
use serde_json::Value;
use std::path::PathBuf;

pub const PAPER: &str = "paper-example.sharp";
pub const BOXES: &str = "paper-example.boxes";

pub fn folder(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests").join(name)
}

pub fn names(of: &str) -> Vec<String> {
    let stem = |path: PathBuf| path.file_stem().expect("a file").to_string_lossy().into_owned();
    let mut names: Vec<_> = std::fs::read_dir(folder(of)).unwrap().map(|entry| stem(entry.unwrap().path())).collect();
    names.sort();
    assert!(!names.is_empty());
    names
}

pub fn text(of: &str, name: &str) -> String {
    std::fs::read_to_string(folder(of).join(format!("{name}.json"))).unwrap()
}

pub fn parsed(of: &str, name: &str) -> Value {
    serde_json::from_str(&text(of, name)).unwrap()
}

pub fn certificate(name: &str) -> Value {
    parsed("certificates", name)
}

/// `specification` or `plant`.
pub fn about(certificate: &Value) -> &'static str {
    if certificate["plant"].is_null() { "specification" } else { "plant" }
}

/// Puts the right digest of what it is about, and was changed, in.
pub fn rehash(certificate: &mut Value) {
    let about = about(certificate);
    let mut canonical = String::new();
    proofs_check::json::parse(certificate[about].to_string().as_bytes()).unwrap().canonical(&mut canonical);
    certificate[format!("{about}_sha256")] = sha256::hex_digest(canonical.as_bytes()).into();
}

/// The answer after a change at a JSON pointer, with the digest made right again.
pub fn changed(name: &str, pointer: &str, value: impl Into<Value>) -> Report {
    let mut certificate = certificate(name);
    *certificate.pointer_mut(pointer).unwrap_or_else(|| panic!("{pointer} exists")) = value.into();
    rehash(&mut certificate);
    check(certificate.to_string().as_bytes())
}

/// Sets a field that need not be there yet.
pub fn with(name: &str, object: &str, field: &str, value: impl Into<Value>) -> Report {
    let mut certificate = certificate(name);
    certificate.pointer_mut(object).unwrap()[field] = value.into();
    rehash(&mut certificate);
    check(certificate.to_string().as_bytes())
}

/// The answer about a certificate as it is.
pub fn judged(certificate: &Value) -> Report {
    check(certificate.to_string().as_bytes())
}

/// The answer, which is that the claim is proved.
#[track_caller]
pub fn accepted(certificate: &Value) -> Report {
    let report = judged(certificate);
    assert_eq!(report.verdict, Verdict::Valid, "{:?} {}", open(&report), report.text(false));
    report
}

/// Invalid for these conditions, and for no other.
#[track_caller]
pub fn fails(certificate: &Value, conditions: &[&str]) {
    let report = judged(certificate);
    let expected: Vec<String> = conditions.iter().map(ToString::to_string).collect();
    assert_eq!((open(&report), report.verdict), (expected, Verdict::Invalid), "{}", report.text(false));
}

/// The conditions of the claim that fail or are undecided, in order.
pub fn open(report: &Report) -> Vec<String> {
    let open = report.lines.iter().filter(|line| line.contains(" FAILS: ") || line.contains(" undecided: "));
    open.map(|line| line.split_whitespace().next().unwrap().to_owned()).collect()
}

/// The certificate with other values at JSON pointers; without a field where the value is null.
pub fn edited(mut certificate: Value, changes: &[(impl AsRef<str>, Value)]) -> Value {
    for (pointer, value) in changes {
        let (parent, name) = pointer.as_ref().rsplit_once('/').unwrap();
        match (certificate.pointer_mut(parent).unwrap_or_else(|| panic!("{parent} exists")), value) {
            (Value::Array(list), _) => list[name.parse::<usize>().unwrap()] = value.clone(),
            (parent, Value::Null) => drop(parent.as_object_mut().unwrap().remove(name)),
            (parent, _) => parent[name] = value.clone(),
        }
    }
    certificate
}

/// Without what stands at a pointer, a field or an element.
pub fn deleted(original: &Value, pointer: &str) -> Value {
    let (parent, last) = pointer.rsplit_once('/').unwrap();
    let mut mutant = original.clone();
    match mutant.pointer_mut(parent).unwrap() {
        Value::Object(map) => drop(map.remove(&last.replace("~1", "/").replace("~0", "~")).unwrap()),
        Value::Array(list) => drop(list.remove(last.parse().unwrap())),
        _ => unreachable!("a parent is an object or an array"),
    }
    mutant
}

/// Without these fields.
pub fn without(certificate: &Value, pointers: impl IntoIterator<Item = impl AsRef<str>>) -> Value {
    edited(certificate.clone(), &pointers.into_iter().map(|pointer| (pointer, Value::Null)).collect::<Vec<_>>())
}

/// The claim is proved.
#[track_caller]
pub fn assert_valid(report: &Report) {
    assert!(report.is_valid(), "{}", report.text(false));
}

/// The sentence that is printed of a claim that is proved.
#[track_caller]
pub fn said(report: &Report) -> &str {
    &report.subject.as_ref().unwrap_or_else(|| panic!("it is not valid: {}", report.text(false))).statement
}

/// Words of the file in the place of its own change nothing: neither the verdict nor the sentence, in no form of the answer.
#[track_caller]
pub fn assert_words_are_ignored(certificate: &Value, words: &str) {
    assert_ne!(certificate["claim"]["statement"].as_str(), Some(words));
    let forged = edited(certificate.clone(), &[("/claim/statement", words.into())]);
    let [own, forged] = [certificate, &forged].map(judged);
    assert_eq!((own.verdict, said(&forged)), (Verdict::Valid, said(&own)));
    assert_eq!((forged.text(true), forged.json()), (own.text(true), own.json()));
}

/// The certificate is refused with this verdict and rule, at this place.
#[track_caller]
pub fn assert_refused(report: &Report, verdict: Verdict, rule: &str, pointer: &str) {
    let finding = report.finding.as_ref().expect("it must be refused");
    assert_eq!((report.verdict, finding.rule), (verdict, rule), "{}", report.text(false));
    assert!(finding.pointer.starts_with(pointer), "{} is not below {pointer}", finding.pointer);
}

/// Of what takes long an ordinary run takes every so many-th, and `SIGMASTAR_CASES=all` all.
pub fn every(ordinary: usize) -> usize {
    if std::env::var_os("SIGMASTAR_CASES").is_some_and(|cases| cases == "all") { 1 } else { ordinary }
}

/// Numbers in [0, 1) of a case, the same in every run (SplitMix64).
pub fn drawn(case: u64) -> impl FnMut() -> f64 {
    let mut state = case << 32;
    move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}
