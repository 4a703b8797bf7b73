//! Which term of C5 sets sigma*.

use super::binding::Binding;
use super::candidate::{AtSigma, Shape};
use super::model::FloatModel;
use super::periodic::PeriodicSet;
use sigmastar_theory::derivation::stability::{DecayTerms, ErrorBox, Sector};

/// The share of ht k_l above which dq/de, and not the start of the internal model, limits h.
const SLOPE_SHARE: f64 = 0.3;

impl Binding {
    /// Which term of the threshold of C5 is the larger one.
    pub(super) fn of_decay(model: &FloatModel, set: &PeriodicSet, at: &AtSigma, sigma: f64) -> Binding {
        let Shape { w_x, weight, error_box, .. } = Shape::of(model, (set.x_per, set.e_per), at);
        let ErrorBox { k_x, k_f, rate, sector, .. } = &error_box;
        let moved = model.input_gain.as_ref().map(|gain| {
            let [below, above] = gain.sector([&sector.below, &sector.above], &(weight / model.mu), &sigma);
            Sector { below, above }
        });
        let in_terms = moved.as_ref().unwrap_or(sector);
        let terms = DecayTerms::new([&w_x, &weight], [rate, &model.mu, &model.p_up.sqrt()], [k_x, k_f], in_terms);
        let by_coupling = terms.cross * terms.cross / (terms.curvature - terms.coupling);
        if by_coupling > 0.5 * at.threshold {
            Binding::Coupling
        } else if terms.h_over_mu * sector.below > SLOPE_SHARE {
            Binding::Slope { one_sided: model.has_one_sided() }
        } else {
            Binding::InternalModel
        }
    }
}
