//! Stability by a matrix inequality over the derivatives of a plant, in the place of C5 (derivation, section 13.7, (M)).

use super::condition::Condition;
use super::stability::ErrorBox;
use crate::data::Data;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::MatrixInequality;

/// The inequality that is proved for the weights w_x and h, if there is one.
#[must_use]
pub fn proved_for<'d>(data: &'d Data<'_>, w_x: &Rational, h: &Rational) -> Option<&'d MatrixInequality> {
    let known = data.spec.bounds.proved_values().inequality();
    known.filter(|known| known.w_x == *w_x && known.h == *h)
}

/// What is left to decide where an inequality is proved: that the error box lies where it holds, and that sigma is larger than its
/// threshold; `of` says of what.
///
/// Guarantee: with all of them true, and the inequality proved of the plant's formulas, `U' <= -rho (|xt|^2 + et^2 + s^2)` for
/// some rho > 0 in the error box, for U = w_x xt'P xt + et^2 + h |zt|_N^2, every n_o and every sigma' >= sigma. For the averages of
/// (J, g, r, d) over the segment from the periodic solution to the point are in the convex hull of what they are on
/// `|y| <= X`, `|e| <= E`; F is affine in them; F at sigma' and without `rate` is F as it is proved, and `2 w_x rate P` and
/// `2 (sigma' - value)` more on its diagonal; with these positive, F v = 0 leaves v = 0, as kp > 0. The points at one t are compact.
#[must_use]
pub fn conditions(
    data: &Data<'_>,
    inequality: &MatrixInequality,
    error_box: &ErrorBox<Enclosure>,
    sigma: &Enclosure,
    of: &str,
) -> [Condition; 3] {
    let [x, e, value] = [&inequality.x, &inequality.e, &inequality.value].map(|number| data.rational(number));
    let what = |text: &str| format!("{of}{text}");
    [
        Condition::at_most("C5x", what("X_b <= X of the matrix inequality"), error_box.x_b.clone(), x),
        Condition::at_most("C5e", what("E_b <= E of the matrix inequality"), error_box.e_b.clone(), e),
        Condition::less("C5m", what("threshold of the matrix inequality < sigma"), value, sigma.clone()),
    ]
}
