//! Verified definiteness: the residual test on matrices of order 400, f64 Cholesky included.

#![allow(clippy::disallowed_methods, reason = "what is compared need not be the same on every machine")]

use criterion::{Criterion, criterion_group, criterion_main};
use faer::Mat;
use sigmastar_exact::enclosure::Truth;
use sigmastar_matrix::ScaledMatrix;
use std::hint::black_box;

/// Q diag(values) Q' with a Householder reflection Q, so that the spectrum is known.
fn with_spectrum(n: usize, values: impl Fn(usize) -> f64) -> Mat<f64> {
    let direction: Vec<f64> = (0..n).map(|i| ((i * i + 3) % 17) as f64 - 8.0).collect();
    let norm: f64 = direction.iter().map(|x| x * x).sum();
    let q = Mat::from_fn(n, n, |i, j| f64::from(i == j) - 2.0 * direction[i] * direction[j] / norm);
    let scaled = Mat::from_fn(n, n, |i, j| q[(i, j)] * values(j));
    &scaled * q.transpose()
}

fn definiteness(c: &mut Criterion) {
    let n = 400;
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool of one thread");
    for exponent in [3, 13] {
        let least = 10f64.powi(-exponent);
        let matrix = with_spectrum(n, |j| least.powf(j as f64 / (n - 1) as f64));
        let verify = || {
            let scaled = ScaledMatrix::from_doubles(n, |i, j| matrix[(i, j)], &vec![0.0; n]);
            scaled.map(|scaled| scaled.is_positive_definite())
        };
        assert_eq!(verify(), Some(Truth::True), "1e-{exponent}");
        c.bench_function(&format!("definite, order 400, least eigenvalue 1e-{exponent}, one thread"), |b| {
            b.iter(|| one_thread.install(|| black_box(verify())));
        });
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10);
    targets = definiteness
}
criterion_main!(benches);
