//! Stability at samples by a matrix inequality over the derivatives of a plant, in the place of C5h (derivation, section 13.7, (Ms)).

use super::witness::SampledWitness;
use crate::data::Data;
use crate::derivation::condition::Condition;
use crate::derivation::stability::ErrorBox;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::SampledInequality;

/// The inequality that is proved for the weights w_x and eta, the gain and the law of a witness, if there is one.
#[must_use]
pub fn proved_for<'d>(data: &'d Data<'_>, witness: &SampledWitness) -> Option<&'d SampledInequality> {
    let known = data.spec.bounds.proved_values().at_samples.stability.as_ref();
    known.filter(|known| known.w_x == witness.w_x && known.eta == witness.eta && known.at == witness.about())
}

/// What is left to decide where it is proved: that the error box lies where it holds.
///
/// Guarantee: with both true, and the inequality proved of the plant's formulas,
/// `U^t - U_k <= -t (c |x|^2 + c_e e_k^2 + c_y y^2)` in the mean over [kh, kh + t] while the solution is in the error box, with c > 0, for
/// U = w_x xt'P xt + et^2 + eta |zt|_N^2, 0 < t <= h and every n_o < N_s/2. For on the straight path from the periodic solution all four
/// derivatives are averages along one segment, in which `|x| <= X_b`, `|e| <= E_b`; F is affine in them and in s, and least over w it
/// does not increase in t.
#[must_use]
pub fn conditions(data: &Data<'_>, inequality: &SampledInequality, error_box: &ErrorBox<Enclosure>) -> Vec<Condition> {
    let ErrorBox { x_b, e_b, .. } = error_box;
    let within = |name, text: &str, at: &Enclosure, end| Condition::at_most(name, text, at.clone(), data.rational(end));
    vec![
        within("C5x", "X_b <= X of the matrix inequality", x_b, &inequality.x),
        within("C5e", "E_b <= E of the matrix inequality", e_b, &inequality.e),
    ]
}
