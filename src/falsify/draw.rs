//! Drawing plants that touch the bounding functions.

use super::claim::Claim;
use super::family::{Family, Harmonic};
use crate::data::Bound;
use crate::expr::FloatExpr;
use rand_core::RngCore;
use rand_xoshiro::Xoshiro256PlusPlus;
use std::f64::consts::TAU;

/// What is kept of a bounding function: the cells of the membership check are two percent wide.
const SHARE: f64 = 0.95;

/// Times that a plant is made smaller before it is given up.
const ATTEMPTS: usize = 60;

/// A plant with its coefficients, within the families of a claim.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnPlant {
    /// The coefficients.
    pub family: Family,
}

/// A number from 0 to 1.
pub(super) fn uniform(random: &mut Xoshiro256PlusPlus) -> f64 {
    (random.next_u64() >> 11) as f64 * 2.0_f64.powi(-53)
}

/// A share of what is allowed: all of it in a third of the cases.
fn share(random: &mut Xoshiro256PlusPlus) -> f64 {
    (1.5 * uniform(random)).min(1.0)
}

fn direction(random: &mut Xoshiro256PlusPlus) -> [f64; 2] {
    let angle = TAU * uniform(random);
    [libm::cos(angle), libm::sin(angle)]
}

/// The bounding functions, in the order of [`Family::bounds`].
pub(super) fn compiled(claim: &Claim) -> Vec<FloatExpr> {
    [Bound::F, Bound::Fe, Bound::Fxx, Bound::Fex, Bound::Q, Bound::Qe, Bound::Qx, Bound::Qt, Bound::QRms, Bound::QtRms]
        .iter()
        .map(|bound| bound.of(&claim.spec).to_float())
        .collect()
}

/// Draws a plant: each coefficient is a random share of what the bounding functions allow at (0, 0), then everything
/// that exceeds one somewhere is made smaller until nothing does, as [`Family::exceeds`] shows. `None` where the plants
/// of this kind do not fit into the families.
///
/// P_x = R diag(p_low, p) R' with p_low <= p <= p_up, and F = P^(-1/2) G P^(1/2) with G = -alpha I - S + rotation,
/// S >= 0 diagonal, so that P_x F + F'P_x = P^(1/2)(G + G')P^(1/2) <= -2 alpha P_x.
#[must_use]
pub fn draw(claim: &Claim, bounds: &[FloatExpr], random: &mut Xoshiro256PlusPlus) -> Option<DrawnPlant> {
    let at_zero: Vec<f64> = bounds.iter().map(|expr| SHARE * expr.eval(0.0, 0.0)).collect();
    let period = claim.spec.period.to_f64();
    let with_states = bounds[0].eval(claim.reach[0], 0.0) > 0.0;
    let g_size = at_zero[1] * share(random);
    let g = direction(random).map(|part| g_size * part);
    // The slope of a bounding function in X, where it is linear.
    let slope = |index: usize| {
        let x = claim.reach[0] * 1e-3;
        (bounds[index].eval(x, 0.0) - bounds[index].eval(0.0, 0.0)).max(0.0) / x
    };
    let mut family = Family {
        jacobian: None,
        jacobian_norm: 0.0,
        g,
        g_1: at_zero[3].min(slope(1)) * share(random),
        kappa: at_zero[2] * share(random),
        directions: [direction(random), direction(random), direction(random)],
        beta: at_zero[6] * share(random),
        c: at_zero[5] * share(random),
        d: SHARE * slope(5) * share(random),
        saturation: claim.reach[1] * libm::exp(-5.0 * uniform(random)),
        harmonics: Vec::new(),
        period,
    };
    if with_states {
        let largest = SHARE * bounds[0].eval(claim.reach[0] * 1e-3, 0.0) / (claim.reach[0] * 1e-3);
        set_jacobian(&mut family, claim, largest, random)?;
    } else {
        (family.g, family.g_1, family.kappa, family.beta, family.d) = ([0.0; 2], 0.0, 0.0, 0.0, 0.0);
    }
    let orders = 1 + (random.next_u64() % 4) as u32;
    let constant = if uniform(random) < 0.3 { 1.0 } else { 0.0 };
    family.harmonics.push(Harmonic { amplitude: constant * uniform(random), order: 0, phase: 0.0 });
    let first = 1 + (random.next_u64() % 3) as u32;
    for order in first..first + orders {
        let phase = TAU * uniform(random);
        family.harmonics.push(Harmonic { amplitude: uniform(random) + 1e-3, order, phase });
    }
    fill(&mut family, &at_zero);
    for _ in 0..ATTEMPTS {
        match family.exceeds(claim, bounds) {
            None => return Some(DrawnPlant { family }),
            Some(condition) => shrink(&mut family, condition),
        }
    }
    None
}

/// Scales A so that the first of its four bounds is reached.
fn fill(family: &mut Family, at_zero: &[f64]) {
    let mut factor = f64::INFINITY;
    let here = family.bounds(0.0, 0.0);
    for index in [4, 7, 8, 9] {
        if here[index] > 0.0 {
            factor = factor.min(at_zero[index] / here[index]);
        }
    }
    let factor = if factor.is_finite() { factor } else { 0.0 };
    family.harmonics.iter_mut().for_each(|harmonic| harmonic.amplitude *= factor);
}

/// Makes smaller what a bounding function does not allow.
fn shrink(family: &mut Family, condition: &str) {
    const FACTOR: f64 = 0.9;
    match condition {
        "f" => {
            family.kappa *= FACTOR;
            family.g_1 *= FACTOR;
            family.g = family.g.map(|part| FACTOR * part);
        }
        "f_e" => {
            family.g_1 *= FACTOR;
            family.g = family.g.map(|part| FACTOR * part);
        }
        "f_xx" => family.kappa *= FACTOR,
        "f_ex" => family.g_1 *= FACTOR,
        "q_e" => (family.c, family.d) = (FACTOR * family.c, FACTOR * family.d),
        "q_x" => (family.beta, family.d) = (FACTOR * family.beta, FACTOR * family.d),
        "q_t" | "q_t_rms" => family.harmonics.iter_mut().for_each(|harmonic| harmonic.amplitude *= FACTOR),
        _ => {
            (family.beta, family.c, family.d) = (FACTOR * family.beta, FACTOR * family.c, FACTOR * family.d);
            family.saturation *= FACTOR;
        }
    }
}

/// Draws P_x and F with a norm of at most `largest`; `None` where alpha alone is more.
fn set_jacobian(family: &mut Family, claim: &Claim, largest: f64, random: &mut Xoshiro256PlusPlus) -> Option<()> {
    let lyapunov = claim.spec.lyapunov.triple()?;
    let (low, up, alpha) = (lyapunov.p_low.to_f64(), lyapunov.p_up.to_f64(), lyapunov.alpha.to_f64());
    let ratio = (1.0 + (up / low - 1.0) * share(random) * 0.999).sqrt();
    let [cosine, sine] = direction(random);
    let slack = [alpha * uniform(random), 0.0];
    let mut rotation = largest * (1.0 + uniform(random));
    for _ in 0..200 {
        // In the axes of P_x: P^(-1/2) G P^(1/2).
        let axes =
            [[-(alpha + slack[0]) * 1.000_001, rotation * ratio], [-rotation / ratio, -(alpha + slack[1]) * 1.000_001]];
        let norm = spectral_norm(axes);
        if norm <= largest {
            let turn = [[cosine, -sine], [sine, cosine]];
            let product = |a: [[f64; 2]; 2], b: [[f64; 2]; 2]| {
                [0, 1].map(|i| [0, 1].map(|j| a[i][0] * b[0][j] + a[i][1] * b[1][j]))
            };
            let back = [[cosine, sine], [-sine, cosine]];
            family.jacobian = Some(product(product(turn, axes), back));
            family.jacobian_norm = norm;
            return Some(());
        }
        rotation *= 0.95;
    }
    None
}

/// The largest singular value of a 2 x 2 matrix.
pub(super) fn spectral_norm([[a, b], [c, d]]: [[f64; 2]; 2]) -> f64 {
    let square = a * a + b * b + c * c + d * d;
    let determinant = a * d - b * c;
    (0.5 * (square + (square * square - 4.0 * determinant * determinant).max(0.0).sqrt())).sqrt()
}

impl DrawnPlant {
    /// f and q as texts in t, x1, x2 and e.
    #[must_use]
    pub fn texts(&self) -> (Vec<String>, String) {
        let family = &self.family;
        let number = |value: f64| format!("({value:?})");
        let [v, w, m] = family.directions;
        let along = |vector: [f64; 2]| format!("({}*x1 + {}*x2)", number(vector[0]), number(vector[1]));
        let saturation = number(family.saturation);
        let error = format!("{saturation}*tanh(e/{saturation})");
        let mut q: Vec<String> = family
            .harmonics
            .iter()
            .filter(|harmonic| harmonic.amplitude != 0.0)
            .map(|Harmonic { amplitude, order, phase }| {
                let period = number(family.period);
                format!("{}*cos({order}*2*pi*t/{period} + {})", number(*amplitude), number(*phase))
            })
            .collect();
        q.push(format!("{}*{error}", number(family.c)));
        let Some(jacobian) = family.jacobian else {
            return (Vec::new(), q.join(" + "));
        };
        q.push(format!("({} + {}*{error})*{}", number(family.beta), number(family.d), along(m)));
        let f = (0..2)
            .map(|i| {
                format!(
                    "{} + e*({} + {}*{}*{}) + {}*{}*{}^2",
                    along(jacobian[i]),
                    number(family.g[i]),
                    number(family.g_1),
                    number(v[i]),
                    along(v),
                    number(0.5 * family.kappa),
                    number(w[i]),
                    along(w)
                )
            })
            .collect();
        (f, q.join(" + "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn norms() {
        assert!((spectral_norm([[3.0, 0.0], [0.0, -2.0]]) - 3.0).abs() < 1e-15);
        assert!((spectral_norm([[0.0, 5.0], [-0.5, 0.0]]) - 5.0).abs() < 1e-15);
        assert!((spectral_norm([[1.0, 1.0], [1.0, 1.0]]) - 2.0).abs() < 1e-15);
    }
}
