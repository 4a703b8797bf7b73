//! Timings of g_N, T_N and the poles of the internal model.
//!
//! `cargo bench --bench transfer` in this folder prints them; nothing here is asserted.

#![allow(clippy::disallowed_methods, reason = "what is compared need not be the same on every machine")]

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use rug::Rational;
use sigmastar_theory::data::Data;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::Specification;
use sigmastar_theory::transfer::{BoxProof, OscillatorCount, PoleSums, internal_model_poles, smallest_k1};
use std::hint::black_box;

fn sums(criterion: &mut Criterion) {
    let text = include_str!("../specs/paper-example.json");
    let spec = Specification::from_json("paper-example", text).expect("the shipped example is valid");
    let data = Data::new(&spec, 128);
    let x = Enclosure::from_rational(&Rational::from((17, 5)), 128);
    let wide = Enclosure::between(&Rational::from((16, 5)), &Rational::from((17, 5)), 128);

    let mut group = criterion.benchmark_group("T_N(3.4) at 128 bits");
    for (name, count) in [
        ("N = 20", OscillatorCount::Finite(20)),
        ("N = 10^9", OscillatorCount::Finite(1_000_000_000)),
        ("N = oo", OscillatorCount::Infinite),
    ] {
        group.bench_function(BenchmarkId::new("with its preparation", name), |b| {
            b.iter(|| PoleSums::new(&data, count).transfer_at(black_box(&x)));
        });
        let sums = PoleSums::new(&data, count);
        group.bench_function(BenchmarkId::new("prepared", name), |b| b.iter(|| sums.transfer_at(black_box(&x))));
        group.bench_function(BenchmarkId::new("prepared, on [3.2, 3.4]", name), |b| {
            b.iter(|| sums.transfer_at(black_box(&wide)));
        });
    }
    let sums = PoleSums::new(&data, OscillatorCount::Infinite);
    let far = Enclosure::from_rational(&Rational::from((10_001, 3)), 128);
    group.bench_function("x = 3333.7, N = oo, prepared", |b| b.iter(|| sums.transfer_at(black_box(&far))));
    group.finish();

    let mut group = criterion.benchmark_group("poles of the internal model");
    group.sample_size(10);
    for n in [4, 16, 64] {
        group.bench_with_input(BenchmarkId::new("enclosed at 128 bits", n), &n, |b, n| {
            b.iter(|| internal_model_poles(&data, *n));
        });
    }
    group.finish();
}

fn pairs(criterion: &mut Criterion) {
    let text = include_str!("../specs/paper-example.json");
    let spec = Specification::from_json("paper-example", text).expect("the shipped example is valid");
    let data = Data::new(&spec, 128);
    // A little above the optimum for nu = 1/(2 pi), eps = 1/2.
    let exact = |text: &str| Rational::from_str_radix(text, 10).expect("a rational");
    let (k0, k1) = (exact("1978/100"), exact("7485/100"));
    let proof = BoxProof::find(&data, &k0, &k1).expect("it has a proof");

    let mut group = criterion.benchmark_group("k0 = 19.78, k1 = 74.85 at nu = 1/(2 pi)");
    group.sample_size(20);
    group.bench_function("find the proof and decide it", |b| {
        b.iter(|| BoxProof::find(&data, black_box(&k0), black_box(&k1)));
    });
    group.bench_function("decide the proof", |b| b.iter(|| proof.decide(&data, black_box(&k0), black_box(&k1))));
    group.bench_function("smallest k1 for this k0, with its proof", |b| b.iter(|| smallest_k1(&data, black_box(&k0))));
    group.finish();
}

criterion_group!(benches, sums, pairs);
criterion_main!(benches);
