//! Stability by a metric that joins the states and the error, in the place of C4 and C5 (derivation, section 13.7, (Jm)).

use super::condition::Condition;
use super::stability::ErrorBox;
use crate::data::{Data, Problem};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::real::{Operand, Real};
use sigmastar_lang::spec::{JointStability, Level, Metric};

/// Both members of C4 of one metric: `P_up dX^2 + 2 |p| dX dE + w dE^2 + (k_p mu/2) dZ^2` and `min{x_low D_x^2, e_low D_e^2}`.
///
/// Guarantee: the first is not below V on the initial set, the second not above V on the faces `|x| = D_x` and `|e| = D_e` of the error box,
/// for `V = (x, e)' Pi (x, e) + (k_p mu/2) |zeta|_N^2`, where the level is one of the metric.
#[must_use]
pub fn level_condition<R: Real>(
    problem: &impl Problem<R>,
    (metric, level): (&Metric, &Level),
    number: impl Fn(&Rational) -> R,
    distances: [&R; 3],
    [d_x, d_e]: [&R; 2],
) -> (R, R)
where
    for<'a> &'a R: Operand<R>,
{
    let [x_low, e_low] = [&level.x_low, &level.e_low].map(&number);
    let start = at_the_start(problem, (metric, level), number, distances);
    (start, (x_low * d_x.sqr()).min(&(e_low * d_e.sqr())))
}

/// `P_up dX^2 + 2 |p| dX dE + w dE^2 + (k_p mu/2) dZ^2`, which V is not above on the initial set.
pub fn at_the_start<R: Real>(
    problem: &impl Problem<R>,
    (metric, level): (&Metric, &Level),
    number: impl Fn(&Rational) -> R,
    [dist_x, dist_e, dist_z]: [&R; 3],
) -> R
where
    for<'a> &'a R: Operand<R>,
{
    let Metric { cross, weight, k_p, .. } = metric;
    let square: Rational = cross.iter().map(|entry| Rational::from(entry.square_ref())).sum();
    let cross = number(&square).sqrt();
    let of_zeta = number(k_p) * &problem.numbers().mu / R::int(2);
    number(&level.p_up) * dist_x.sqr()
        + R::int(2) * cross * dist_x * dist_e
        + number(weight) * dist_e.sqr()
        + of_zeta * dist_z.sqr()
}

/// What is left to decide where a joint inequality is proved: C4 of both metrics, that the error box lies where the inequality holds,
/// and that sigma is not below its threshold; `of` says of what.
///
/// Guarantee: with all of them true, and the inequality and the levels proved, for every n_o and every sigma' = value/lam >= sigma the
/// form of `Pi(lam) = lam Pi_1 + (1 - lam) Pi_2` and `k_p(lam)` falls in the error box by at least a multiple of |x|^2 + e^2 + y^2, and
/// stays below the level that it has on the faces: its inequality is lam times that of the near metric and (1 - lam) times that of the
/// far one, and `2 value w_2 (1 - lam)^2/lam >= 0` more with e^2; what V is at most on the set is convex in the metric, and what it is
/// at least on the faces concave.
#[must_use]
pub fn conditions(
    data: &Data<'_>,
    JointStability { inequality, levels }: &JointStability,
    distances: [&Enclosure; 3],
    radii: [&Enclosure; 2],
    error_box: &ErrorBox<Enclosure>,
    (sigma, of): (&Rational, &str),
) -> Vec<Condition> {
    let number = |number: &Rational| data.rational(number);
    let what = "P_up dX^2 + 2 |p| dX dE + w dE^2 + (k_p mu/2) dZ^2 < min{x_low D_x^2, e_low D_e^2}";
    let named = [("C4", "near"), ("C4f", "far")];
    let of_levels = named.into_iter().zip(inequality.metrics().into_iter().zip(levels));
    let mut conditions: Vec<Condition> = of_levels
        .map(|((id, which), metric)| {
            let (start, exit) = level_condition(data, metric, number, distances, radii);
            Condition::less(id, format!("{of}{what}, {which}"), start, exit)
        })
        .collect();
    let ErrorBox { x_b, e_b, .. } = error_box;
    let below = Rational::from(&inequality.value - sigma);
    let mut at_most = |id, what: &str, lhs: Enclosure, rhs: Enclosure| {
        conditions.push(Condition::at_most(id, format!("{of}{what}"), lhs, rhs));
    };
    at_most("C5x", "X_b <= X of the joint inequality", x_b.clone(), number(&inequality.x));
    at_most("C5e", "E_b <= E of the joint inequality", e_b.clone(), number(&inequality.e));
    at_most("C5s", "threshold of the joint inequality - sigma <= 0", number(&below), data.zero());
    conditions
}
