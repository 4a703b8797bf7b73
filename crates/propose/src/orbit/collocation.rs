//! The periodic solution of x' = f(t, x, 0) by Fourier collocation and Newton's method, in doubles.
//!
//! The unknowns are the values at 2K + 1 points; the derivative at a point is that of the trigonometric polynomial through
//! all of them (Fornberg, A Practical Guide to Pseudospectral Methods): with s = t/T,
//! `D_jl = pi (-1)^(j-l) / sin(pi (j-l)/(2K+1))`, and 0 for j = l.

use super::field::Field;
use super::series::FloatSeries;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;

/// Newton's steps for one number of harmonics.
const MAX_STEPS: usize = 30;

/// Halvings of a step that does not help.
const MAX_HALVINGS: usize = 10;

/// Unknowns for which a singular system is solved by its singular values; the effort grows with their cube.
const MAX_SINGULAR: usize = 250;

/// Singular values below this share of the largest count as 0.
const NEGLIGIBLE: f64 = 1e-11;

/// A residual with which Newton's method has converged, relative to the size of the terms.
const CONVERGED: f64 = 1e-14;

/// A residual that is accepted where rounding allows no smaller one.
const ACCEPTED: f64 = 1e-10;

/// Values at the points, their residuals, and the size of the terms in them.
struct Iterate {
    x: DVector<f64>,
    residual: DVector<f64>,
    size: f64,
}

impl Iterate {
    fn error(&self) -> f64 {
        let error = self.residual.amax();
        if error == 0.0 { 0.0 } else { error / self.size }
    }
}

/// The result of Newton's method: a curve, and the largest residual at the points relative to the size of its terms.
pub(super) struct Collocated {
    pub(super) series: FloatSeries,
    pub(super) residual: f64,
}

impl Collocated {
    pub(super) fn converged(&self) -> bool {
        self.residual <= ACCEPTED
    }
}

/// Newton's method for so many harmonics, from the values of a curve; all times in units of the period.
pub(super) fn collocate(field: &mut Field, start: &FloatSeries, harmonics: usize) -> Collocated {
    let n = field.states();
    let points = 2 * harmonics + 1;
    let differences: Vec<f64> = (0..points)
        .map(|d| {
            if d == 0 {
                return 0.0;
            }
            let sign = if d % 2 == 0 { 1.0 } else { -1.0 };
            sign * PI / libm::sin(PI * d as f64 / points as f64)
        })
        .collect();
    // D at (j, l): the differences are antisymmetric, as points is odd.
    let d = |j: usize, l: usize| if j >= l { differences[j - l] } else { -differences[l - j] };
    let evaluate = |field: &mut Field, x: DVector<f64>| {
        let mut residual = DVector::zeros(n * points);
        let mut size = f64::MIN_POSITIVE;
        for j in 0..points {
            field.set(j as f64 / points as f64, &x.as_slice()[n * j..n * (j + 1)], 0.0);
            let f = field.f() * field.period;
            size = size.max(field.size(&x.as_slice()[n * j..n * (j + 1)]));
            for i in 0..n {
                let slope: f64 = (0..points).map(|l| d(j, l) * x[n * l + i]).sum();
                residual[n * j + i] = slope - f[i];
                size = size.max(slope.abs());
            }
        }
        Iterate { x, residual, size }
    };
    let samples = start.samples(points);
    let mut now = evaluate(field, DVector::from_iterator(n * points, samples.into_iter().flatten()));
    for _ in 0..MAX_STEPS {
        if now.error() <= CONVERGED || !now.error().is_finite() {
            break;
        }
        let mut matrix = DMatrix::zeros(n * points, n * points);
        for j in 0..points {
            field.set(j as f64 / points as f64, &now.x.as_slice()[n * j..n * (j + 1)], 0.0);
            let jacobian = field.jacobian() * field.period;
            matrix.view_mut((n * j, n * j), (n, n)).copy_from(&-jacobian);
            for l in (0..points).filter(|l| *l != j) {
                for i in 0..n {
                    matrix[(n * j + i, n * l + i)] = d(j, l);
                }
            }
        }
        if !matrix.iter().all(|entry| entry.is_finite()) {
            break;
        }
        let regular = matrix.clone().lu().solve(&now.residual).and_then(|step| descend(field, &now, &step, evaluate));
        let better = regular.or_else(|| {
            // Where the orbit is not isolated the system is singular, and its least solution is a step.
            if matrix.nrows() > MAX_SINGULAR || now.error() <= ACCEPTED {
                return None;
            }
            let values = matrix.try_svd(true, true, f64::EPSILON, 1000)?;
            let least = NEGLIGIBLE * values.singular_values.max();
            let step = values.solve(&now.residual, least).ok()?;
            descend(field, &now, &step, evaluate)
        });
        let Some(better) = better else { break };
        now = better;
    }
    let samples: Vec<Vec<f64>> = (0..points).map(|j| now.x.as_slice()[n * j..n * (j + 1)].to_vec()).collect();
    Collocated { series: FloatSeries::from_samples(&samples, harmonics), residual: now.error() }
}

/// The first of the halved steps that makes the residual smaller.
fn descend(
    field: &mut Field,
    now: &Iterate,
    step: &DVector<f64>,
    evaluate: impl Fn(&mut Field, DVector<f64>) -> Iterate,
) -> Option<Iterate> {
    if !step.iter().all(|entry| entry.is_finite()) {
        return None;
    }
    let mut share = 1.0;
    for _ in 0..=MAX_HALVINGS {
        let next = evaluate(field, &now.x - step * share);
        // Compared in the same units: the size changes with the iterate.
        if next.residual.amax() < now.residual.amax() {
            return Some(next);
        }
        share /= 2.0;
    }
    None
}
