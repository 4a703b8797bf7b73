//! Stability by a matrix inequality over the derivatives of a plant, in the place of C5 (derivation, section 13.7, (M)).

use super::condition::Condition;
use super::paths::Paths;
use super::stability::ErrorBox;
use crate::data::Data;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::MatrixInequality;

/// The inequality that is proved for the weights w_x and h, if there is one.
#[must_use]
pub fn proved_for<'d>(data: &'d Data<'_>, w_x: &Rational, h: &Rational) -> Option<&'d MatrixInequality> {
    let known = data.spec.bounds.proved_values().inequality.as_ref();
    known.filter(|known| known.w_x == *w_x && known.h == *h)
}

/// What is left to decide where an inequality is proved: that the error box around a periodic solution with sup|x| <= x_per and
/// sup|e| <= e_per lies where it holds, and that sigma is larger than its threshold; `of` says of what.
///
/// Guarantee: with all of them true, and the inequality proved of the plant's formulas, `U' <= -rho (|xt|^2 + et^2 + s^2)` for
/// some rho > 0 in the error box, for U = w_x xt'P xt + et^2 + h |zt|_N^2, every n_o and every sigma' >= sigma. For the averages of
/// (J, r) and of (g, d) over the parts of the path from the periodic solution to the point are in the convex hulls of what they
/// are where the inequality holds (with a splitting they are two hulls, on the straight path one of all four); F is affine in
/// them; F at sigma' and without `rate` is F as it is proved, and `2 w_x rate P` and `2 (sigma' - value)` more on its diagonal;
/// with these positive, F v = 0 leaves v = 0, as kp > 0. The points at one t are compact.
///
/// With an input gain F has d + (1-b) value in the place of d, and is proved at both ends of b, in which it is affine. It then moves with
/// sigma, and C5B is asked for beside: L, the block of (e, y) at d = 0, is positive definite at the threshold for both b. At
/// sigma' = value/lam, with lam kp in the place of kp, F is in (x, e/sqrt(lam), y sqrt(lam)) that at the threshold in (x, sqrt(lam) .),
/// and (1 - lam) L more (derivation, 13.1).
#[must_use]
pub fn conditions(
    data: &Data<'_>,
    inequality: &MatrixInequality,
    (paths, periodic, error_box): (Paths, [&Enclosure; 2], &ErrorBox<Enclosure>),
    sigma: &Enclosure,
    of: &str,
) -> Vec<Condition> {
    let [x_per, e_per] = periodic;
    let ErrorBox { x_b, e_b, .. } = error_box;
    let number = |number: &Rational| data.rational(number);
    let mut conditions = Vec::new();
    let mut within = |name: &'static str, text: &str, at: &Enclosure, end: &Rational| {
        conditions.push(Condition::at_most(name, format!("{of}{text}"), at.clone(), number(end)));
    };
    within("C5x", "X_b <= X of the matrix inequality", x_b, &inequality.x);
    within("C5e", "E_b <= E of the matrix inequality", e_b, &inequality.e);
    if let Some(splitting) = &inequality.splitting {
        let path = paths.common();
        within("C5j", "E of df/dx <= E of the splitting", path.e_of_dx(e_per, e_b), &splitting.e);
        within("C5g", "X of df/de <= X of the splitting", path.x_of_de(x_per, x_b), &splitting.x);
    }
    let what = format!("{of}threshold of the matrix inequality < sigma");
    conditions.push(Condition::less("C5m", what, number(&inequality.value), sigma.clone()));
    if let Some(gain) = &data.input_gain {
        let h_over_mu = number(&inequality.h) / &data.mu;
        let [worst, room] = gain.damping(&h_over_mu, &number(&inequality.value));
        let what = format!("{of}(1 + ht (1-b) threshold)^2 < 4 ht threshold at both ends of b, ht = h/mu");
        conditions.push(Condition::less("C5B", what, worst, room));
    }
    conditions
}
