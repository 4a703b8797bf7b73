//! Timings of a whole run, of one rigorous decision, and of the expression evaluators.
//!
//! `cargo bench` in this folder prints them; nothing here is asserted.

#![allow(clippy::disallowed_methods, reason = "what is compared need not be the same on every machine")]

use criterion::{Criterion, criterion_group, criterion_main};
use rug::Rational;
use sigmastar_prove::certify::{Options, certify, recheck};
use sigmastar_decide::conditions::{GivenWitness, Ladder, decide};
use sigmastar_theory::data::Data;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::expr::{Expr, ProofSettings, Variables, prove_bounding};
use sigmastar_lang::spec::Specification;
use std::hint::black_box;

fn paper_example() -> Specification {
    let text = include_str!("../specs/paper-example.json");
    Specification::from_json("paper-example", text).expect("the shipped example is valid")
}

fn runs(criterion: &mut Criterion) {
    let spec = paper_example();
    let run = certify(&spec, Options::default()).expect("its bounding functions are proved");
    let witness = run.sharp.proved().expect("it certifies").witness.clone();
    let file = GivenWitness { witness: Box::new(witness.clone()), exact: None };

    let mut group = criterion.benchmark_group("paper example");
    group.sample_size(10);
    group.bench_function("certify, all derivations", |b| b.iter(|| certify(&spec, Options::default())));
    group.bench_function("certify, sharp only", |b| {
        b.iter(|| certify(&spec, Options { compare: false, ..Options::default() }));
    });
    group.bench_function("decide again from the witness", |b| b.iter(|| recheck(&spec, &file, Options::default())));
    group.bench_function("decide C1-C5 once at 128 bits", |b| {
        b.iter(|| decide(&spec, black_box(witness.clone()), Ladder::default()));
    });
    group.bench_function("enclose the data at 128 bits", |b| b.iter(|| Data::new(&spec, 128)));
    group.finish();
}

fn expressions(criterion: &mut Criterion) {
    let expr = Expr::parse("4.822 + X + atan(E*(X + 0.189))", Variables::XAndE).expect("a valid expression");
    let float = expr.to_float();
    let (x, e) = (Rational::from((3, 10)), Rational::from((7, 10)));
    let (x_point, e_point) = (Enclosure::from_rational(&x, 128), Enclosure::from_rational(&e, 128));
    let ten = Rational::from(10);

    let mut group = criterion.benchmark_group("4.822 + X + atan(E*(X + 0.189))");
    group.bench_function("double", |b| b.iter(|| float.eval(black_box(0.3), black_box(0.7))));
    group
        .bench_function("enclosure at 128 bits", |b| b.iter(|| expr.enclose(black_box(&x_point), black_box(&e_point))));
    group.bench_function("enclosure with slopes", |b| {
        b.iter(|| expr.enclose_slopes(black_box(&x_point), black_box(&e_point)));
    });
    group.bench_function("proof on 10 x 10", |b| {
        b.iter(|| prove_bounding(&expr, &ten, &ten, &ProofSettings::default()));
    });
    group.finish();

    let (a, b) = (Enclosure::pi(128), Enclosure::pi(128).sqrt());
    criterion.bench_function("enclosure product at 128 bits", |bencher| bencher.iter(|| black_box(&a) * black_box(&b)));
}

criterion_group!(benches, runs, expressions);
criterion_main!(benches);
