//! The known harmonics of q(t,0,0) (derivation, 10.1 and 10.3).

use crate::data::{Bound, KnownForcing, Numbers, Problem};
use sigmastar_exact::real::{Operand, Real};

/// Bounds of q(t,0,0).
#[derive(Clone, Debug)]
pub struct AtOrigin<R> {
    /// Q_0 = min{b_q_rms(0,0), sqrt(C_0^2 + 2 sum_{k>=1} C_k^2) + r_0}, of rms(q(t,0,0)).
    pub q_rms: R,
    /// b_qt_rms(0,0), of rms(dq/dt(t,0,0)).
    pub q_t_rms: R,
    /// What the known harmonics say.
    pub known: Option<Known<R>>,
}

/// Sizes of the known harmonics and of the rest.
#[derive(Clone, Debug)]
pub struct Known<R> {
    /// C_0.
    pub mean: R,
    /// 2 sum_{k>=1} C_k.
    pub sum: R,
    /// Q_m = sqrt(2 sum_{k>=1} C_k^2) + r_0, of the rms of q(t,0,0) without its mean.
    pub rms_without_mean: R,
    /// sqrt(sum_{k>=1} 2 (k Om C_k)^2), of the rms of the harmonics' derivative.
    pub rate_rms: R,
    /// r_0.
    pub rest_rms: R,
    /// r_1.
    pub rest_t_rms: R,
}

impl<R: Real> AtOrigin<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// Evaluates the bounds.
    #[must_use]
    pub fn new(problem: &impl Problem<R>) -> AtOrigin<R> {
        let zero = problem.zero();
        let q_rms = problem.bound(Bound::QRms, &zero, &zero);
        let q_t_rms = problem.bound(Bound::QtRms, &zero, &zero);
        let Some(known) = &problem.numbers().q_0 else { return AtOrigin { q_rms, q_t_rms, known: None } };
        let squares = R::int(2) * sum_of_harmonics(known, &zero, |_, c| c.sqr());
        let by_harmonics = (mean(known).sqr() + &squares).sqrt() + &known.rest_rms;
        AtOrigin {
            q_rms: q_rms.min_known(&by_harmonics),
            q_t_rms,
            known: Some(Known {
                mean: mean(known),
                sum: R::int(2) * sum_of_harmonics(known, &zero, |_, c| c.clone()),
                rms_without_mean: squares.sqrt() + &known.rest_rms,
                rate_rms: rate_rms(problem, known),
                rest_rms: known.rest_rms.clone(),
                rest_t_rms: rest_t_rms(problem, known),
            }),
        }
    }
}

/// The regulator's responses to the known harmonics, for every n_o and mu; the one to k = 0 vanishes. With an input gain both are
/// over b_m (derivation, 13.1).
#[derive(Clone, Debug)]
pub struct Response<R> {
    /// sum_{k>=1} 2 C_k/sqrt(sigma^2 + (k Om)^2), of sup|e|.
    pub sup: R,
    /// sqrt(sum_{k>=1} 2 C_k^2/(sigma^2 + (k Om)^2)), of rms(e).
    pub rms: R,
}

impl<R: Real> Response<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// Evaluates the two sums.
    #[must_use]
    pub fn new(problem: &impl Problem<R>, known: &KnownForcing<R>, sigma: &R) -> Response<R> {
        let Numbers { fundamental, input_gain, .. } = problem.numbers();
        let gain = |k: i64| R::int(1) / (sigma.sqr() + (R::int(k) * fundamental).sqr());
        let sup = sum_of_harmonics(known, &problem.zero(), |k, c| c * gain(k).sqrt());
        let squares = sum_of_harmonics(known, &problem.zero(), |k, c| c.sqr() * gain(k));
        let (sup, rms) = (R::int(2) * sup, (R::int(2) * squares).sqrt());
        match input_gain {
            None => Response { sup, rms },
            Some(input) => Response { sup: sup / input.of_error(), rms: rms / input.of_error() },
        }
    }
}

/// C_0; the list is not empty.
fn mean<R: Real>(known: &KnownForcing<R>) -> R {
    known.harmonics.first().cloned().unwrap_or_else(R::unknown)
}

/// The sum over k >= 1 of a term of k and C_k.
fn sum_of_harmonics<R: Real>(known: &KnownForcing<R>, zero: &R, term: impl Fn(i64, &R) -> R) -> R
where
    for<'a> &'a R: Operand<R>,
{
    (1..).zip(known.harmonics.iter().skip(1)).fold(zero.clone(), |sum, (k, c)| sum + term(k, c))
}

/// sqrt(sum_{k>=1} 2 (k Om C_k)^2), at the largest Om.
fn rate_rms<R: Real>(problem: &impl Problem<R>, known: &KnownForcing<R>) -> R
where
    for<'a> &'a R: Operand<R>,
{
    let fastest = &problem.numbers().fastest;
    let squares = sum_of_harmonics(known, &problem.zero(), |k, c| (R::int(k) * (fastest * c)).sqr());
    (R::int(2) * squares).sqrt()
}

/// r_1, or b_qt_rms(0,0) and the harmonics' derivative together, where that is not given or larger.
#[must_use]
pub fn rest_t_rms<R: Real>(problem: &impl Problem<R>, known: &KnownForcing<R>) -> R
where
    for<'a> &'a R: Operand<R>,
{
    let zero = problem.zero();
    let derived = problem.bound(Bound::QtRms, &zero, &zero) + rate_rms(problem, known);
    known.rest_t_rms.as_ref().map_or(derived.clone(), |given| derived.min_known(given))
}

/// `(1/w) sqrt(sum_{|k| <= K} Tb(|k| Om/w) C_k^2)`: the rms of zeta in the norm of N that answers the known harmonics, with
/// Tb(0) = 1/(nu^2 n_0), Tb(x) = k0 + k1 x^2, and at a matched frequency Tb(k) = 2/(nu^2 n_k) where that is smaller
/// (lemma T'').
#[must_use]
pub fn steady_state_norm<R: Real>(problem: &impl Problem<R>, known: &KnownForcing<R>, [k0, k1]: [&R; 2]) -> R
where
    for<'a> &'a R: Operand<R>,
{
    let numbers = problem.numbers();
    let Numbers { fastest, base_frequency, nu, matched, .. } = numbers;
    let ratio = fastest / base_frequency;
    let bound = |k: i64| {
        let general = k0 + k1 * (R::int(k) * &ratio).sqr();
        match known.weights.get(k as usize) {
            Some(weight) if *matched => general.min(&(R::int(2) / (nu.sqr() * weight))),
            _ => general,
        }
    };
    let squares = sum_of_harmonics(known, &problem.zero(), |k, c| bound(k) * c.sqr());
    (numbers.transfer_at_zero() * mean(known).sqr() + R::int(2) * squares).sqrt() / base_frequency
}

/// `sqrt(C_0^2/n_0 + sum_{k>=1} 4 C_k^2/n_k)`, for exact regulation (derivation, 10.6).
#[must_use]
pub fn weighted_norm<R: Real>(problem: &impl Problem<R>, known: &KnownForcing<R>) -> R
where
    for<'a> &'a R: Operand<R>,
{
    let weight = |k: i64| known.weights.get(k as usize).cloned().unwrap_or_else(R::unknown);
    let squares = sum_of_harmonics(known, &problem.zero(), |k, c| c.sqr() / weight(k));
    (mean(known).sqr() / weight(0) + R::int(4) * squares).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Data;
    use crate::transfer::weights_only::weights_only;
    use sigmastar_lang::spec::Specification;
    use std::f64::consts::TAU;

    /// Of a period from 4/5 to 5/4: rates and transfer bounds at the largest frequency, everything else at the least.
    #[test]
    fn each_formula_takes_its_end_of_the_period() {
        let mut document = weights_only("2", "1/2", "3", "2*pi").document;
        document["q_0"] = serde_json::json!({ "harmonics": ["1", "1/2", "1/4"], "rest_rms": "0" });
        document["period"] = serde_json::json!({ "nominal": "1", "low": "4/5", "high": "5/4" });
        let spec = Specification::from_json("test", &document.to_string()).unwrap();
        let data = Data::new(&spec, 128);
        let close = |value: f64, expected: f64| assert!((value / expected - 1.0).abs() < 1e-12, "{value} {expected}");
        close(data.period.midpoint_f64(), 1.25);
        close(data.fundamental.midpoint_f64(), TAU * 0.8);
        close(data.fastest.midpoint_f64(), TAU * 1.25);
        let known = data.q_0.as_ref().unwrap();
        let squares = |weight: &dyn Fn(f64) -> f64| 2.0 * (0.25 * weight(1.0) + weight(2.0) / 16.0);
        let rate = AtOrigin::new(&data).known.unwrap().rate_rms;
        close(rate.midpoint_f64(), squares(&|k| (k * TAU * 1.25).powi(2)).sqrt());
        let sigma = data.rational(&rug::Rational::from(7));
        let response = Response::new(&data, known, &sigma);
        close(response.rms.midpoint_f64(), squares(&|k| 1.0 / (49.0 + (k * TAU * 0.8).powi(2))).sqrt());
        let [k0, k1] = [2, 3].map(|value| data.rational(&rug::Rational::from(value)));
        let nu = 3.0 / TAU;
        let expected = (1.0 / (nu * nu * 2.0) + squares(&|k| 2.0 + 3.0 * (k * 1.25).powi(2))).sqrt() / TAU;
        close(steady_state_norm(&data, known, [&k0, &k1]).midpoint_f64(), expected);
    }
}
