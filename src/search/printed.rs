//! Free numbers for the printed formulas without the condition that has no solution, for comparison only.

use super::minimise::minimise;
use super::model::FloatModel;
use super::scan;
use super::sharp::{depth_of, parameter_of};
use crate::data::{Bound, Data};
use crate::number::Portable;
use crate::transfer::printed_transfer;

/// x_a, e_a, the share of the largest h, and the figure they give.
#[derive(Clone, Copy, Debug)]
pub struct PrintedProposal {
    /// x_a = x_p.
    pub x_a: f64,
    /// e_a = e_p.
    pub e_a: f64,
    /// h.
    pub h: f64,
    /// max(sigma_p*, sigma_a*) as printed.
    pub sigma: f64,
}

/// The printed sigma at x_a, e_a, `share` of the largest printed h; `None` where a printed condition other than
/// P:eq:boundx_bounde_1 fails or an argument leaves the domain.
fn evaluate(model: &FloatModel, kappas: (f64, f64), x: f64, e: f64, share: f64) -> Option<PrintedProposal> {
    let at = |which| model.bound(which, x, e);
    let c = model.c();
    let gain = c * (1.0 + (c - 1.0) * (-model.alpha * model.period).portable_exp()) / model.alpha;
    let f_xx = model.bound(Bound::Fxx, x, 0.0);
    let (q, q_e, q_x) = (at(Bound::Q), at(Bound::Qe), at(Bound::Qx));
    let bracket = at(Bound::Fex) * e + 2.0 * f_xx * x;
    if gain * (at(Bound::Fe) * e + f_xx * x * x / 2.0) > x || gain * bracket >= 1.0 {
        return None;
    }
    let determinant = gain * (at(Bound::Fe) * q_x - bracket * q_e);
    let beta = |s: f64| 2.0 * model.beta_s(s);
    let mut sigma = model.inverse(beta, e / q);
    if q_e + determinant > 0.0 {
        sigma = sigma.max(model.inverse(beta, (1.0 - gain * bracket) / (q_e + determinant)));
    }
    if determinant < 0.0 {
        return None;
    }
    if determinant > 0.0 {
        sigma = sigma.max(model.inverse(beta, 1.0 / determinant));
    }
    let z2 = (model.period / model.mu + kappas.0 + 54.0 * kappas.1 * q_e * q_e) * q * q
        + 3.0 * kappas.1 * (at(Bound::Qt).powi(2) + (q_x * at(Bound::F)).powi(2));
    let zeta_a = z2.sqrt() + 2.0 * model.n_bar * e;
    let (x_b, e_b) = ((3.0 * std::f64::consts::SQRT_2 * c + 2.0) * x, 6.0 * e);
    if x_b > model.domain.0 || e_b > model.domain.1 {
        return None;
    }
    let rho_0 = model.p_up / (2.0 * model.p_low)
        * (model.bound(Bound::Fxx, x, e) * x
            + at(Bound::Fex) * e
            + model.p_low * model.bound(Bound::Fxx, x_b, e) * (x_b + x));
    if rho_0 > model.alpha * model.p_low / 3.0 * (1.0 - 1e-9) {
        return None;
    }
    let (q_x_b, q_e_b) = (model.bound(Bound::Qx, x_b, e_b), model.bound(Bound::Qe, x_b, e_b));
    let exit = (model.p_low * (x_b - x).powi(2)).min((e_b - e).powi(2)) / (3.0 * zeta_a).powi(2);
    let limit = exit.min(model.mu * model.alpha * model.p_low / (q_x_b * q_x_b)) / 3.0;
    let h = limit * share;
    let curvature = model.alpha * model.p_low - rho_0 - h / model.mu * q_x_b * q_x_b;
    let rho_12 = model.p_up * model.bound(Bound::Fe, x_b, e_b) + q_x_b;
    let sigma_a = rho_12 * rho_12 / (2.0 * curvature) + model.mu / (2.0 * h) + q_e_b + h / model.mu * q_e_b * q_e_b;
    let sigma = sigma.max(sigma_a);
    sigma.is_finite().then_some(PrintedProposal { x_a: x, e_a: e, h, sigma })
}

/// Searches for the smallest figure that the printed formulas give when P:eq:boundx_bounde_1 is left out; `None` when
/// another printed condition fails everywhere.
#[must_use]
pub fn search_printed(data: &Data<'_>, model: &FloatModel) -> Option<PrintedProposal> {
    let effort = model.effort();
    let printed = printed_transfer(data);
    let kappas = (printed.kappa_0.midpoint_f64(), printed.kappa_1.midpoint_f64());
    let gain = |x: f64| {
        let c = model.c();
        let k = c * (1.0 + (c - 1.0) * (-model.alpha * model.period).portable_exp()) / model.alpha;
        (k, model.bound(Bound::Fxx, x, 0.0))
    };
    let largest_e = |x: f64| {
        let (k, f_xx) = gain(x);
        let admissible = |e: f64| {
            k * (model.bound(Bound::Fe, x, e) * e + f_xx * x * x / 2.0) <= x
                && k * (model.bound(Bound::Fex, x, e) * e + 2.0 * f_xx * x) < 1.0
        };
        scan::largest(admissible, model.domain.1 / 6.0)
    };
    let xs = scan::x_values(model.domain.0, effort.x_step);
    let columns = scan::evaluate_all(&xs, |&x| {
        let e_max = largest_e(x)?;
        scan::e_depths(effort.e_step)
            .flat_map(|depth| [1.0, 0.1].map(|share| (depth, share)))
            .filter_map(|(depth, share)| {
                Some((evaluate(model, kappas, x, e_max * (-depth).portable_exp(), share)?, share))
            })
            .min_by(|a, b| a.0.sigma.total_cmp(&b.0.sigma))
    });
    let (start, share) = columns.into_iter().flatten().min_by(|a, b| a.0.sigma.total_cmp(&b.0.sigma))?;
    let decode = |p: &[f64]| {
        let x = scan::in_range(p[0].portable_exp())?;
        let e = largest_e(x)? * (-depth_of(p[1])).portable_exp();
        // A share slightly below 1 keeps h inside its closed interval after rounding.
        evaluate(model, kappas, x, e, (1.0 - 1e-9) * (-p[2] * p[2]).portable_exp())
    };
    let depth = (largest_e(start.x_a)? / start.e_a).portable_ln().max(1e-9);
    let first = [start.x_a.portable_ln(), parameter_of(depth), (-share.portable_ln()).sqrt()];
    let refined = minimise(
        |p| decode(p).map(|f| f.sigma.portable_ln()),
        &first,
        &[0.3, 0.5, 0.3],
        effort.restarts(6),
        effort.iterations,
    );
    refined.and_then(|(best, _)| decode(&best)).filter(|best| best.sigma <= start.sigma).or(Some(start))
}
