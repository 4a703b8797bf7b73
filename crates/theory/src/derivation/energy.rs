//! Bounds of a periodic solution by a matrix inequality over the derivatives of a plant (derivation, section 13.7, (E)): no gain of
//! one loop has to be small.

use super::condition::Condition;
use super::harmonics::AtOrigin;
use crate::data::Data;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::real::{Operand, Real};
use sigmastar_lang::spec::{ExistenceInequality, JointInequality, Metric};

/// The numbers of a matrix inequality of existence that bounds are made of.
#[derive(Clone, Copy, Debug)]
pub struct EnergyNumbers<R> {
    /// k_p.
    pub k_p: R,
    /// c_x.
    pub c_x: R,
    /// c_y.
    pub c_y: R,
    /// The threshold of sigma.
    pub value: R,
}

/// Bounds of root mean squares along a periodic solution, for y = q + mu s.
///
/// Guarantee, where the inequality holds on `|x| <= X`, `|e| <= E`: they are true of every T-periodic (x, e, zeta) in there of the loop
/// with l q(t,0,0), 0 <= l <= 1, in the place of q(t,0,0), at sigma and every larger gain, for every n_o. For with U = x'P x + e^2 +
/// (k_p mu/2) |zeta|_N^2 the mean of F(x, e, y) over a period is that of `l k_p y q(t,0,0)`, y has the mean 0, and
/// F >= diag(c_x, 2 (sigma - value), c_y).
#[derive(Clone, Debug)]
pub struct EnergyBounds<R> {
    /// r_y = k_p Q_m/c_y, of rms(y).
    pub y: R,
    /// `k_p Q_m/(2 sqrt(2 (sigma - value) c_y))`, of rms(e); unknown where the threshold is not certainly below sigma.
    pub e: R,
    /// `k_p Q_m/(2 sqrt(c_x c_y))`, of rms(x).
    pub x: R,
}

impl<R: Real> EnergyBounds<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// Evaluates the bounds; unknown where no harmonics of q(t,0,0) are known.
    #[must_use]
    pub fn new(numbers: &EnergyNumbers<R>, origin: &AtOrigin<R>, sigma: &R) -> EnergyBounds<R> {
        let EnergyNumbers { k_p, c_x, c_y, value } = numbers;
        let moved = k_p * origin.known.as_ref().map_or_else(R::unknown, |known| known.rms_without_mean.clone());
        let room = sigma - value;
        let room = if room.is_certainly_positive() { R::int(2) * room } else { R::unknown() };
        let half = |weight: &R| &moved / (R::int(2) * (weight * c_y).sqrt());
        EnergyBounds { e: half(&room), x: half(c_x), y: moved / c_y }
    }

    /// Those of two metrics between which that of every larger gain lies (derivation, 13.7, (Jm)): each is the larger one of the two,
    /// for k_p over a concave function of the metric is quasiconvex.
    #[must_use]
    pub fn of_metrics([near, far]: [&MetricNumbers<R>; 2], origin: &AtOrigin<R>) -> EnergyBounds<R> {
        let oscillation = origin.known.as_ref().map_or_else(R::unknown, |known| known.rms_without_mean.clone());
        let of = |MetricNumbers { k_p, c_x, c_e, c_y }: &MetricNumbers<R>| {
            let moved = k_p * &oscillation;
            let half = |weight: &R| &moved / (R::int(2) * (weight * c_y).sqrt());
            EnergyBounds { e: half(c_e), x: half(c_x), y: &moved / c_y }
        };
        let (near, far) = (of(near), of(far));
        EnergyBounds { y: near.y.max(&far.y), e: near.e.max(&far.e), x: near.x.max(&far.x) }
    }
}

/// The numbers of a metric that bounds are made of.
#[derive(Clone, Copy, Debug)]
pub struct MetricNumbers<R> {
    /// k_p.
    pub k_p: R,
    /// c_x.
    pub c_x: R,
    /// c_e.
    pub c_e: R,
    /// c_y.
    pub c_y: R,
}

impl<R> MetricNumbers<R> {
    /// Those of a metric.
    pub fn of(Metric { k_p, c_x, c_e, c_y, .. }: &Metric, number: impl Fn(&Rational) -> R) -> MetricNumbers<R> {
        MetricNumbers { k_p: number(k_p), c_x: number(c_x), c_e: number(c_e), c_y: number(c_y) }
    }
}

/// The bounds of a specification whose data come with a proved inequality.
#[must_use]
pub fn proved(data: &Data<'_>, origin: &AtOrigin<Enclosure>, sigma: &Enclosure) -> Option<EnergyBounds<Enclosure>> {
    if let Some(joint) = &data.spec.bounds.proved_values().joint_existence {
        let [near, far] = joint.metrics().map(|metric| MetricNumbers::of(metric, |number| data.rational(number)));
        return Some(EnergyBounds::of_metrics([&near, &far], origin));
    }
    let ExistenceInequality { k_p, c_x, c_y, value, .. } = data.spec.bounds.proved_values().existence.as_ref()?;
    let [k_p, c_x, c_y, value] = [k_p, c_x, c_y, value].map(|number| data.rational(number));
    Some(EnergyBounds::new(&EnergyNumbers { k_p, c_x, c_y, value }, origin, sigma))
}

/// `inner - outer <= 0`: the difference of rationals is exact, so that equality is decided.
fn difference(data: &Data<'_>, id: &'static str, what: &str, [inner, outer]: [&Rational; 2]) -> Condition {
    Condition::at_most(id, what, data.rational(&Rational::from(inner - outer)), data.zero())
}

/// That (X_p, E_p) lies where an inequality of existence holds.
pub(super) fn within(data: &Data<'_>, [x_p, e_p]: [&Rational; 2], [x, e]: [&Rational; 2]) -> [Condition; 2] {
    [
        difference(data, "E1", "X_p - X of the existence inequality <= 0", [x_p, x]),
        difference(data, "E2", "E_p - E of the existence inequality <= 0", [e_p, e]),
    ]
}

/// What is left to decide of it: that (X_p, E_p) lies where it holds, and that sigma is not below its threshold, and above it where
/// the inequality has no c_e.
///
/// With an input gain the inequality has d + (1-b) threshold in the place of d and is proved at both ends of b; E4 is asked for beside:
/// with 0 for d the block of (e, y) is at least diag(0, c_y). Then F >= diag(c_x, 0, lam c_y) at threshold/lam with lam k_p in the place
/// of k_p, as in [`super::matrix_inequality::conditions`]; so rms(y) and rms(x) are bounded as at the threshold (derivation, 13.1).
#[must_use]
pub fn conditions(data: &Data<'_>, sizes: [&Rational; 2], sigma: &Rational) -> Vec<Condition> {
    let values = data.spec.bounds.proved_values();
    if let Some(JointInequality { x, e, value, .. }) = &values.joint_existence {
        let reached = difference(data, "E3", "threshold of the existence inequality - sigma <= 0", [value, sigma]);
        return within(data, sizes, [x, e]).into_iter().chain([reached]).collect();
    }
    let Some(ExistenceInequality { x, e, k_p, c_y, value, .. }) = &values.existence else { return Vec::new() };
    let [threshold, sigma] = [value, sigma].map(|number| data.rational(number));
    let exceeded = Condition::less("E3", "threshold of the existence inequality < sigma", threshold.clone(), sigma);
    let any_larger = data.input_gain.as_ref().map(|gain| {
        let [k_p, c_y] = [k_p, c_y].map(|number| data.rational(number));
        let [worst, room] = gain.damping(&(k_p / 2), &threshold);
        let what = "(1 + (k_p/2) (1-b) threshold)^2 <= 2 threshold (k_p - c_y) at both ends of b";
        Condition::at_most("E4", what, worst, room - 2 * threshold * c_y)
    });
    within(data, sizes, [x, e]).into_iter().chain([exceeded]).chain(any_larger).collect()
}
