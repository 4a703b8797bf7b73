//! What several tests use: the shipped files, the program, and certificates that are made once.

use crate::agreement::assert_agrees;
use assert_cmd::Command;
use rayon::prelude::*;
use serde_json::{Value, json};
use sigmastar_document::progress::Silent;
use sigmastar_lab::falsify::{Falsification, TrialSettings, TriedClaim, falsify};
use sigmastar_lang::spec::{Document, Specification};
use sigmastar_prove::certificate::certificate_json;
use sigmastar_prove::certify::{Certification, Options, certify, resolve};
use std::collections::HashMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::Output;
use std::sync::{Arc, LazyLock, Mutex, OnceLock};

/// The root of the repository.
pub const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// The specification of the paper's example: its path from the root, and its text.
pub const EXAMPLE: &str = "specs/paper-example.json";
pub const EXAMPLE_TEXT: &str = include_str!("../../specs/paper-example.json");

/// The plant of the paper's example: its path from the root, and its text.
pub const PLANT: &str = "specs/plants/paper-example.json";
pub const PLANT_TEXT: &str = include_str!("../../specs/plants/paper-example.json");

/// The program, in the root, with an environment that does not change what it writes.
pub fn program() -> Command {
    let mut command = Command::cargo_bin("sigmastar").expect("the program is built");
    command.current_dir(ROOT).env_remove("RAYON_NUM_THREADS").env_remove("NO_COLOR");
    command
}

/// The same with these arguments.
pub fn sigmastar(arguments: &[&str]) -> Command {
    let mut command = program();
    command.args(arguments);
    command
}

/// The program, in the root, for tests that need its streams or its process.
pub fn process() -> std::process::Command {
    let mut process = std::process::Command::new(assert_cmd::cargo::cargo_bin("sigmastar"));
    process.current_dir(ROOT);
    process
}

type Outputs = Mutex<HashMap<Vec<String>, Arc<OnceLock<Output>>>>;

/// What the program answers to arguments that name shipped files alone: it is run once for all tests.
pub fn answer(arguments: &[&str]) -> Output {
    static OUTPUTS: LazyLock<Outputs> = LazyLock::new(Outputs::default);
    let key: Vec<String> = arguments.iter().map(|argument| (*argument).to_owned()).collect();
    let place = Arc::clone(OUTPUTS.lock().expect("no test panics in here").entry(key).or_default());
    place.get_or_init(|| program().args(arguments).output().expect("the program runs")).clone()
}

/// What the program answers to such arguments, and the file that it writes, after `-o`: made once for all tests.
pub fn made(arguments: &[&str]) -> (Output, Vec<u8>) {
    let name: String = arguments.join(" ").chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("made-{name}"));
    let output = answer(&[arguments, &["--force", "-o", file.to_str().expect("a plain name")]].concat());
    (output, std::fs::read(&file).unwrap_or_default())
}

/// A certificate of the paper's example with an error box that is too small: decided again, it is refuted.
pub fn refuted_witness() -> &'static str {
    static PATH: LazyLock<String> = LazyLock::new(|| forged("refuted", "/witness/D_e", "1"));
    &PATH
}

/// The path of a certificate of the paper's example with another value in one place.
pub fn forged(name: &str, pointer: &str, value: &str) -> String {
    let text = std::fs::read(Path::new(ROOT).join("proofs-check/tests/certificates/paper-example.sharp.json"));
    let mut certificate = json(&text.expect("shipped"));
    *certificate.pointer_mut(pointer).expect("it is there") = value.into();
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.json"));
    std::fs::write(&path, certificate.to_string()).expect("a folder for tests");
    path.to_str().expect("a plain name").to_owned()
}

/// Of what takes long an ordinary run takes every so many-th, and `SIGMASTAR_CASES=all` all.
pub fn every(ordinary: usize) -> usize {
    if std::env::var_os("SIGMASTAR_CASES").is_some_and(|asked| asked == "all") { 1 } else { ordinary }
}

/// How many cases a property test draws: in an ordinary run, and in a night.
pub fn count(ordinary: u64, night: u64) -> u32 {
    let range = cases(ordinary, night);
    u32::try_from(range.end - range.start).unwrap_or(u32::MAX)
}

/// The numbers of the cases of a campaign: of an ordinary run so many, with `SIGMASTAR_CASES=all` those of a night, with
/// `SIGMASTAR_CASES=COUNT` or `FIRST..END` these.
pub fn cases(ordinary: u64, night: u64) -> Range<u64> {
    let Ok(asked) = std::env::var("SIGMASTAR_CASES") else { return 0..ordinary };
    let number = |text: &str| text.parse().expect("SIGMASTAR_CASES is all, COUNT or FIRST..END");
    match asked.split_once("..") {
        Some((first, end)) => number(first)..number(end),
        None if asked == "all" => 0..night,
        None => 0..number(&asked),
    }
}

/// What was written as JSON.
#[track_caller]
pub fn json(output: &[u8]) -> Value {
    serde_json::from_slice(output).expect("JSON")
}

#[track_caller]
pub fn utf8(output: Vec<u8>) -> String {
    String::from_utf8(output).expect("UTF-8")
}

/// A text with single spaces in the place of its line breaks and indents.
pub fn in_one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The exit code of a call, and both streams in one line.
#[track_caller]
pub fn told(call: &mut Command) -> (i32, String) {
    let output = call.output().expect("the program runs");
    (output.status.code().expect("a code"), in_one_line(&[utf8(output.stdout), utf8(output.stderr)].join("\n")))
}

/// A decimal or a fraction that is written as text.
#[track_caller]
pub fn number(value: &Value) -> f64 {
    let parts = value.as_str().and_then(|text| text.split('/').map(|part| part.parse().ok()).collect());
    let parts: Vec<f64> = parts.unwrap_or_else(|| panic!("{value} is no number"));
    parts.into_iter().reduce(|numerator, denominator| numerator / denominator).expect("a part at least")
}

/// What stands in a file of JSON.
#[track_caller]
pub fn read(path: impl AsRef<Path>) -> Value {
    json(&std::fs::read(path).expect("it is there"))
}

/// Writes a document into a folder.
pub fn stored(folder: &Path, name: &str, document: &Value) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, document.to_string()).expect("a folder for tests");
    path
}

/// Certifies a document, once for all tests: the certificate, written into a folder beside the document, and the report.
#[track_caller]
pub fn certified_in(folder: &Path, document: &Value, flags: &[&str]) -> (PathBuf, Value) {
    type Made = Mutex<HashMap<String, Arc<OnceLock<(Vec<u8>, Value)>>>>;
    static MADE: LazyLock<Made> = LazyLock::new(Made::default);
    let key = format!("{document} {flags:?}");
    // Where a call fails in here, so does every test that wants it.
    let place = Arc::clone(MADE.lock().expect("no test panics in here").entry(key).or_default());
    let (certificate, report) = place.get_or_init(|| {
        let own = tempfile::tempdir().expect("a folder for tests");
        let (certificate, report) = certified_by(program(), own.path(), document, flags);
        (std::fs::read(certificate).expect("it is there"), report)
    });
    stored(folder, "input.json", document);
    let path = folder.join("certificate.json");
    std::fs::write(&path, certificate).expect("a folder for tests");
    (path, report.clone())
}

/// The same by a program that is set up otherwise.
#[track_caller]
pub fn certified_by(mut program: Command, folder: &Path, document: &Value, flags: &[&str]) -> (PathBuf, Value) {
    let (input, certificate) = (stored(folder, "input.json", document), folder.join("certificate.json"));
    program.arg("certify").arg(input).args(flags).args(["--quiet", "--force", "--format", "json", "-o"]);
    let output = program.arg(&certificate).output().expect("the program runs");
    assert_eq!(output.status.code(), Some(0), "{}{}", utf8(output.stderr), utf8(output.stdout));
    (certificate, json(&output.stdout))
}

/// What the program says of a document with the witness of a certificate, decided again: its code and its report.
#[track_caller]
pub fn decided_again(folder: &Path, document: &Value, certificate: &Path) -> (Option<i32>, Value) {
    let call = ["certify", "--quiet", "--no-alternatives", "--format", "json", "--witness"];
    let input = stored(folder, "again.json", document);
    let output = program().args(call).arg(certificate).arg(input).output().expect("the program runs");
    (output.status.code(), json(&output.stdout))
}

/// The checker's answer to a certificate.
#[track_caller]
pub fn checked(certificate: &Path) -> Value {
    json(&program().args(["check", "--format", "json"]).arg(certificate).output().expect("the program runs").stdout)
}

/// Asserts that the checker accepts a certificate, and that what it shows of its conditions and sizes is what is decided.
#[track_caller]
pub fn assert_valid(certificate: &Path) {
    let answer = checked(certificate);
    assert_eq!(answer["verdict"], "valid", "{answer:#}");
    assert_agrees(&read(certificate));
}

/// The claim of a certificate, for trials.
#[track_caller]
pub fn claim(certificate: &Value) -> TriedClaim {
    TriedClaim::from_document(&Document::parse("certificate", &certificate.to_string()).unwrap()).unwrap()
}

/// What so many trials of a claim say.
#[track_caller]
pub fn tried(certificate: &Value, trials: u64, seed: u64) -> Falsification {
    falsify(&claim(certificate), TrialSettings { trials, seed, only: None }, &Silent)
}

/// The JSON files of a folder of the repository, sorted.
pub fn files(folder: &str) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(Path::new(ROOT).join(folder))
        .expect("the folder is part of the repository")
        .map(|entry| entry.expect("a directory entry").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "json"))
        .collect();
    files.sort();
    files
}

/// The name of a file without its extension.
pub fn stem(path: &Path) -> &str {
    path.file_stem().and_then(|stem| stem.to_str()).expect("file names are plain")
}

fn path(name: &str) -> PathBuf {
    Path::new(ROOT).join("specs").join(format!("{name}.json"))
}

/// The text of a shipped specification.
pub fn specification_text(name: &str) -> String {
    std::fs::read_to_string(path(name)).expect("shipped")
}

/// A shipped specification or plant, as a document to change.
pub fn document(name: &str) -> Value {
    json(specification_text(name).as_bytes())
}

/// A shipped specification.
pub fn specification(name: &str) -> Specification {
    Specification::from_json(name, &specification_text(name))
        .unwrap_or_else(|errors| panic!("{}", errors.render(false)))
}

/// A plant with mu = 1 and period 1.
pub fn plant(states: &[&str], f: &[&str], q: &str) -> Value {
    json!({
        "format": "sigmastar/plant", "version": 1, "name": "test", "period": "1", "states": states, "f": f, "q": q,
        "internal_model": { "mu": "1", "base_frequency": "2*pi", "matched": true,
            "weights": { "family": "power", "n0": "2", "epsilon": "1/2" } },
    })
}

/// Without the comparison with the other derivations.
pub fn options() -> Options {
    Options { compare: false, ..Options::default() }
}

pub fn certificate(spec: &Specification) -> Value {
    certificate_json(&certify(spec, options()).unwrap()).expect("certified")
}

/// A shipped specification with its certificate; a Jacobian is replaced by the triple that it gives.
pub struct Shipped {
    pub name: String,
    pub spec: &'static Specification,
    pub run: Certification<'static>,
    pub certificate: Value,
}

/// The certificates of shipped specifications. They are for a `LazyLock`, and so never to be asked for in a thread of
/// rayon's: it may be the one that the lock waits for.
pub fn certify_all<N: AsRef<str> + Sync>(names: &[N]) -> Vec<Shipped> {
    let make = |name: &N| {
        let name = name.as_ref().to_owned();
        let spec = specification(&name);
        let spec = match resolve(&spec) {
            Some(found) => found.expect("a triple").spec,
            None => spec,
        };
        // A run borrows its specification; both last as long as the tests.
        let spec: &'static Specification = Box::leak(Box::new(spec));
        let run = certify(spec, options()).expect("not refuted");
        let certificate = certificate_json(&run).expect("certified");
        Shipped { name, spec, run, certificate }
    };
    names.par_iter().map(make).collect()
}

/// Every shipped specification with its certificate, made once.
pub fn certified() -> &'static [Shipped] {
    static CERTIFIED: LazyLock<Vec<Shipped>> = LazyLock::new(|| {
        let names: Vec<String> = files("specs").iter().map(|path| stem(path).to_owned()).collect();
        certify_all(&names)
    });
    &CERTIFIED
}

/// The guide, its pages one after another.
pub fn guide() -> String {
    let docs = Path::new(ROOT).join("docs");
    let folder = std::fs::read_dir(docs.join("guide"));
    let mut pages: Vec<_> = folder.into_iter().flatten().map(|entry| entry.expect("an entry").path()).collect();
    pages.sort();
    let text = |path| std::fs::read_to_string(path).expect("a page of the guide");
    std::iter::once(docs.join("guide.md")).chain(pages).map(text).collect()
}
