//! Free numbers for the printed formulas without the condition that has no solution, for comparison only.

use super::minimise::minimise;
use super::model::FloatModel;
use super::repaired::largest_e_repaired;
use super::repaired::{depth_of, parameter_of};
use super::scan;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::Portable;
use sigmastar_exact::parallel;
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::printed::{PrintedEvaluation, error_box};
use sigmastar_theory::transfer::printed_transfer;

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

/// By how much h stays below its largest value, so that it still does where x_a, e_a are rounded.
const ROOM: f64 = 1e-7;

/// The printed sigma at x_a, e_a, `share` of the largest printed h; `None` where a printed condition other than
/// P:eq:boundx_bounde_1 fails or an argument leaves the domain.
fn evaluate(model: &FloatModel, kappas: [&f64; 2], x: f64, e: f64, share: f64) -> Option<PrintedProposal> {
    let (x_b, e_b) = error_box(model, &x, &e);
    if x_b > model.domain.0 || e_b > model.domain.1 {
        return None;
    }
    let found = PrintedEvaluation::new(model, kappas, &x, &e, |largest| (1.0 - ROOM) * share * largest);
    let sigma = found.sigma_p.ok()?.max(found.sigma_a.ok()?);
    sigma.is_finite().then_some(PrintedProposal { x_a: x, e_a: e, h: found.point.h, sigma })
}

/// Searches for the smallest figure that the printed formulas give when P:eq:boundx_bounde_1 is left out; `None` when
/// another printed condition fails everywhere.
#[must_use]
pub fn search_printed(data: &Data<'_>, model: &FloatModel) -> Option<PrintedProposal> {
    let effort = model.effort();
    let printed = printed_transfer(data);
    let kappas = [&printed.kappa_0, &printed.kappa_1].map(Enclosure::midpoint_f64);
    let kappas = kappas.each_ref();
    let largest_e = |x: f64| largest_e_repaired(model, x).map(|e| e.min(model.domain.1 / 6.0));
    let xs = scan::x_values(model.domain.0, effort.x_step);
    let columns = parallel::map(&xs, |&x| {
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
        evaluate(model, kappas, x, e, (-p[2] * p[2]).portable_exp())
    };
    let depth = (largest_e(start.x_a)? / start.e_a).portable_ln().max(1e-9);
    let first = [start.x_a.portable_ln(), parameter_of(depth), (-share.portable_ln()).sqrt()];
    let refined = minimise(&|p| decode(p).map(|f| f.sigma.portable_ln()), &first, &[0.3, 0.5, 0.3], effort.descent(6));
    refined.and_then(|(best, _)| decode(&best)).filter(|best| best.sigma <= start.sigma).or(Some(start))
}
