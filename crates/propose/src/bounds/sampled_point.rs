//! The matrix inequalities of the regulator at samples at sampled points, in doubles: they propose, and nothing rests on them.

use super::place::{Place, Places};
use super::pointwise::{Derivatives, MatrixAt, Slopes};
use super::suprema::FloatSuprema;
use super::weights::Root;
use rug::Rational;
use sigmastar_exact::number::Portable;
use sigmastar_lang::spec::SampledExistence;
use sigmastar_theory::derivation::sampled_form::{AtPoint, Corner, FormNumbers, Less, LoopNumbers, Parts, form};

/// Powers of four by which lambda is tried where its first guess proves nothing, and the logarithm of the factor up to which it is found.
const EXPONENTS: std::ops::RangeInclusive<i32> = -7..=7;
const CLOSE: f64 = 0.02;

/// Points that are added where an inequality is tightest.
const POINTS: usize = 12;

/// The free numbers of the inequality of stability but for lambda, in doubles.
#[derive(Clone, Debug)]
pub struct SampledWeights {
    /// w_x; P is the identity.
    pub w_x: f64,
    /// eta, the weight of zeta.
    pub eta: f64,
    /// The law and the gain.
    pub of: LoopNumbers<f64>,
}

/// What an inequality of stability has at its points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampledRadius {
    /// What e_k needs of sigma (2 - h sigma), as a share: below 1 if and only if the inequality holds strictly.
    pub radius: f64,
    /// The lambda for which it is least.
    pub lambda: f64,
}

/// The free numbers of the inequality of existence but for gamma, in doubles.
#[derive(Clone, Debug)]
pub struct SampledEnergy {
    /// P by rows, in the coordinates y.
    pub p: Vec<Vec<f64>>,
    /// k_p.
    pub k_p: f64,
    /// lambda.
    pub lambda: f64,
    /// c_x.
    pub c_x: f64,
    /// c_e.
    pub c_e: f64,
    /// c_y.
    pub c_y: f64,
}

impl From<&SampledExistence> for SampledEnergy {
    fn from(known: &SampledExistence) -> SampledEnergy {
        let SampledExistence { matrix, k_p, lambda, c_x, c_e, c_y, .. } = known;
        let p = matrix.iter().map(|row| row.iter().map(Rational::to_f64).collect()).collect();
        let [k_p, lambda, c_x, c_e, c_y] = [k_p, lambda, c_x, c_e, c_y].map(Rational::to_f64);
        SampledEnergy { p, k_p, lambda, c_x, c_e, c_y }
    }
}

impl Slopes {
    /// With a constant P, given by its entries: the block of x is `-(P J + J'P) - c_x I`.
    #[must_use]
    pub fn with(&self, p: impl Fn(usize, usize) -> f64, c_x: f64) -> Parts<f64> {
        let n = self.r.len();
        let moved = |i: usize, k: usize| -> f64 { (0..n).map(|m| p(i, m) * self.j[m * n + k]).sum() };
        let upper = (0..n).flat_map(|i| (i..n).map(move |k| (i, k)));
        Parts {
            decay: upper.map(|(i, k)| (i, k, -(moved(i, k) + moved(k, i)) - if i == k { c_x } else { 0.0 })).collect(),
            moved: (0..n).map(|i| (0..n).map(|m| p(i, m) * self.g[m]).sum()).collect(),
            r: self.r.clone(),
            d: self.d,
        }
    }
}

/// Rows of a lower triangle, the last of which is apart: those before it, and it.
struct Bordered {
    before: Vec<f64>,
    last: Vec<f64>,
}

/// The entries with the variables in another order.
fn bordered(entries: &[(usize, usize, f64)], order: &[usize]) -> Bordered {
    let mut place = vec![0; order.len()];
    order.iter().enumerate().for_each(|(new, old)| place[*old] = new);
    let mut lower = vec![0.0; order.len() * (order.len() + 1) / 2];
    for (i, j, value) in entries {
        let (a, b) = (place[*i].max(place[*j]), place[*i].min(place[*j]));
        lower[a * (a + 1) / 2 + b] = *value;
    }
    let last = lower.split_off((order.len() - 1) * order.len() / 2);
    Bordered { before: lower, last }
}

impl SampledWeights {
    /// The radius at one point.
    fn at(&self, point: &Slopes, lambda: f64) -> f64 {
        let n = point.r.len();
        let order: Vec<usize> = (0..n).chain([n + 1, n + 2, n + 3, n]).collect();
        let of_end = |corner: Corner<'_, f64>| {
            let parts = point.with(|i, k| if i == k { self.w_x } else { 0.0 }, 0.0);
            let less = Less { e_k: 0.0, e: 0.0, y: 0.0 };
            let k_p = 2.0 * self.eta / self.of.gain;
            let numbers = FormNumbers { of: &self.of, weight: 1.0, k_p, lambda, less, gamma: None, past: None };
            let Bordered { before, mut last } = bordered(&form(&AtPoint::default(), numbers, &corner, parts), &order);
            let own = last.pop().unwrap_or(f64::NAN);
            match Root::new(before) {
                Ok(root) => 2.0 * root.half_square(&last) / own,
                Err(without) => without,
            }
        };
        self.of.corners(false).map(of_end).fold(0.0, larger)
    }

    fn at_all(&self, points: &[Slopes], lambda: f64) -> f64 {
        points.iter().map(|point| self.at(point, lambda)).fold(0.0, larger)
    }

    /// The least radius of some points, and its lambda: the set of the lambda with a radius below any number is an interval.
    fn least(&self, points: &[Slopes]) -> SampledRadius {
        let [g, r] = Slopes::largest(points);
        let k_p = 2.0 * self.eta / self.of.gain;
        // Between what G needs and what w takes, for x and for e.
        let of_states = if r > 0.0 { self.w_x * g / r } else { 0.0 };
        let middle = of_states.max((k_p * self.of.sigma).sqrt()) / self.of.across;
        let at = |exponent: f64| self.at_all(points, middle * exponent.portable_exp());
        let unit = std::f64::consts::LN_2 * 2.0;
        let (mut radius, mut exponent) = (at(0.0), 0.0);
        if !radius.is_finite() {
            let found = EXPONENTS.map(|k| (at(unit * f64::from(k)), unit * f64::from(k)));
            (radius, exponent) = found.fold((radius, exponent), |best, next| if next.0 < best.0 { next } else { best });
        }
        let mut step = unit;
        while step > CLOSE {
            let sides = [exponent - step, exponent + step].map(|side| (at(side), side));
            match sides.into_iter().find(|(value, _)| *value < radius) {
                Some(better) => (radius, exponent) = better,
                None => step /= 3.0,
            }
        }
        SampledRadius { radius, lambda: middle * exponent.portable_exp() }
    }
}

/// What is not a number counts as infinite.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::INFINITY } else { a.max(b) }
}

impl SampledEnergy {
    /// The least gamma at one point; infinite where there is none.
    pub(super) fn gamma(&self, point: &Slopes, of: &LoopNumbers<f64>) -> f64 {
        let SampledEnergy { p, k_p, lambda, c_x, c_e, c_y } = self;
        let order: Vec<usize> = (0..point.r.len() + 5).collect();
        let of_end = |corner: Corner<'_, f64>| {
            let parts = point.with(|i, k| p[i][k], *c_x);
            let less = Less { e_k: 0.0, e: *c_e, y: *c_y };
            let [k_p, lambda] = [*k_p, *lambda];
            let numbers = FormNumbers { of, weight: 1.0, k_p, lambda, less, gamma: Some(0.0), past: None };
            let Bordered { before, mut last } = bordered(&form(&AtPoint::default(), numbers, &corner, parts), &order);
            last.pop();
            match Root::new(before) {
                Ok(root) => 2.0 * root.half_square(&last),
                Err(without) => without,
            }
        };
        of.corners(false).map(of_end).fold(0.0, larger)
    }
}

impl FloatSuprema {
    /// The least radius of the inequality of stability at these points of the grid, with the best lambda, for P = 1; infinite where
    /// it does not hold without e_k, or P is not the identity.
    #[must_use]
    pub fn sampled_radius(&self, at: [f64; 2], places: &Places, weights: &SampledWeights) -> SampledRadius {
        match self.slopes(at, places) {
            Some(points) => weights.least(&points),
            None => SampledRadius { radius: f64::INFINITY, lambda: f64::NAN },
        }
    }

    /// The places of the whole grid where the radius is largest, beside those that are known.
    #[must_use]
    pub fn with_worst(&self, at: [f64; 2], known: &Places, weights: &SampledWeights, lambda: f64) -> Places {
        let value = |derivatives: &Derivatives<'_>, _: &MatrixAt| weights.at(&Slopes::from(derivatives), lambda);
        let worst = self.largest_of_derivatives(at, &Places::Stride(1), POINTS, value);
        let mut listed: Vec<Place> = worst.into_iter().map(|(_, place)| place).collect();
        if let Places::Listed(known) = known {
            listed.extend(known.iter());
        }
        Places::listed(listed)
    }

    /// The least gamma of the inequality of existence at these points of the grid.
    #[must_use]
    pub fn sampled_gamma(&self, at: [f64; 2], places: &Places, energy: &SampledEnergy, of: &LoopNumbers<f64>) -> f64 {
        let gamma = |derivatives: &Derivatives<'_>, _: &MatrixAt| energy.gamma(&Slopes::from(derivatives), of);
        self.of_derivatives(at, places, gamma).into_iter().fold(0.0, larger)
    }

    /// The least gamma of the inequality of existence by a longer search: local ones start from the best points of the grid.
    #[must_use]
    pub fn refined_gamma(&self, at: [f64; 2], energy: &SampledEnergy, of: &LoopNumbers<f64>) -> f64 {
        self.refined_of_derivatives(at, |derivatives, _| energy.gamma(&Slopes::from(derivatives), of))
    }

    /// The derivatives; none where P is not the identity.
    fn slopes(&self, at: [f64; 2], places: &Places) -> Option<Vec<Slopes>> {
        let slopes = self.of_derivatives(at, places, |derivatives, matrix| {
            let is_identity = derivatives.r.is_empty() || matches!(matrix, MatrixAt::Identity);
            is_identity.then(|| Slopes::from(derivatives))
        });
        slopes.into_iter().collect()
    }
}
