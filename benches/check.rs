//! Checking a certificate against producing it.
//!
//! `cargo bench --bench check` in this folder prints the times; nothing is asserted.

#![allow(clippy::disallowed_methods, reason = "what is compared need not be the same on every machine")]

use criterion::{Criterion, criterion_group, criterion_main};
use sigmastar::{CertifyOptions, Subject};
use sigmastar_prove::certificate::certificate_json;
use sigmastar_prove::certify::{Options, TransferChoice, certify};
use sigmastar_lang::spec::Specification;
use std::hint::black_box;
use std::path::{Path, PathBuf};

fn check_and_produce(criterion: &mut Criterion) {
    let text = include_str!("../specs/paper-example.json");
    let spec = Specification::from_json("paper-example", text).expect("the shipped example is valid");
    let kinds = [
        ("sharp", Options::default()),
        ("sharp, by boxes", Options { transfer: TransferChoice::Boxes, ..Options::default() }),
    ];
    let mut group = criterion.benchmark_group("paper example");
    group.sample_size(10);
    for (name, options) in kinds {
        let run = certify(&spec, options).expect("its bounding functions are proved");
        let certificate = certificate_json(&run).expect("it certifies").to_string();
        group.bench_function(format!("produce, {name}"), |b| b.iter(|| certify(&spec, options)));
        group.bench_function(format!("check, {name}"), |b| {
            b.iter(|| proofs_check::check(black_box(certificate.as_bytes())));
        });
    }
    group.finish();
}

/// Every shipped plant by its formulas.
fn plants(criterion: &mut Criterion) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../specs/plants");
    let files = std::fs::read_dir(folder).expect("the shipped plants").map(|entry| entry.expect("an entry").path());
    let mut files: Vec<PathBuf> = files.filter(|path| path.extension().is_some_and(|kind| kind == "json")).collect();
    files.sort();
    let mut group = criterion.benchmark_group("plants");
    group.sample_size(10);
    for path in files {
        let text = std::fs::read_to_string(&path).expect("a text");
        let subject = Subject::from_json(&text).expect("the shipped plants are valid");
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let options = CertifyOptions::new();
        let certificate = sigmastar::certify(&subject, &options).expect("it certifies");
        group.bench_function(format!("produce, {name}"), |b| b.iter(|| sigmastar::certify(&subject, &options)));
        group.bench_function(format!("check, {name}"), |b| {
            b.iter(|| proofs_check::check(black_box(certificate.to_json().as_bytes())));
        });
    }
    group.finish();
}

criterion_group!(benches, check_and_produce, plants);
criterion_main!(benches);
