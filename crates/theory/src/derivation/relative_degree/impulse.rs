//! The L1 norm k_inf of the impulse response of 1/p.

use super::flow::{Flow, State};
use super::negative_part::{Perturbed, Tolerance};
use super::ranges::{NORM_PRECISION, scale};
use super::real_roots::all_real;
use super::{RelativeDegreeError, Routh, Undecided};
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, MAX_PRECISION};

/// The absolute error aimed at, relative to 1/a_1 <= k_inf, as a power of 2.
const TARGET: i32 = -40;

/// Doublings of the first block, so that time scales 2^100 apart are covered.
const MAX_DOUBLINGS: usize = 120;

/// The largest working precision in bits.
const MAX_WORKING_PRECISION: u32 = 6144;

/// Bound of the effort, in multiplications of enclosures at 256 bits (roughly).
const MAX_WORK: u64 = 16_000_000;

/// An enclosure of k_inf = integral_0^oo |g|, with limsup |xi_1| <= k_inf limsup |e| (derivation, section 6).
///
/// Since the integral of g is 1/p(0) = 1/a_1 and |g| = g + 2 max(-g, 0),
///
/// ```text
/// k_inf = 1/a_1 + 2 integral_0^oo max(-g(t), 0) dt.
/// ```
///
/// So 1/a_1 is a lower bound always, and k_inf = 1/a_1 exactly when all roots of p are real (g is then a convolution
/// of positive functions; decided by Sturm's theorem). Otherwise [0, T] is covered by steps; on a step g is its Taylor
/// polynomial at the start plus a bounded error, and the negative part is integrated between proved sign changes.
/// With y' = S y the flow in which exp(S t) is a contraction (Schwarz form of p) and g = y_1/sqrt(P_1):
/// * Taylor remainder: `|y(t+s) - sum_{j<m} (s S)^j y(t)/j!| <= s^m/m! |S^m y(t)|`, as the flow contracts;
/// * tail: for every h with |exp(S h)| <= q < 1, and t = T + k h + s with 0 <= s < h, `|g(t)| <= |y(t)|/sqrt(P_1)`
///   and `|y(t)| <= |exp(S s)| |exp(S h)|^k |y(T)| <= q^k |y(T)|`; summing k = 0, 1, ...,
///
/// ```text
/// integral_T^oo |g| <= h |y(T)| / ((1 - q) sqrt(P_1)).
/// ```
/// The integral of g from T on, which is known from y(T) by linear algebra, keeps the tail from counting twice.
///
/// # Guarantee
/// The enclosure contains k_inf. Its relative width is about 2^-39 (or 2^-`precision`, if that is larger) when the
/// response decays within the bounded effort, which covers damping ratios down to about 10^-3; for smaller ones the
/// tail is bounded from where the effort ended, and the enclosure is finite but wide.
///
/// # Errors
/// [`RelativeDegreeError::Count`] and [`RelativeDegreeError::NotHurwitz`] for unusable coefficients,
/// [`RelativeDegreeError::Undecided`] when time scales are too far apart (beyond about 2^100).
pub fn k_infinity(a: &[Rational], precision: u32) -> Result<Enclosure, RelativeDegreeError> {
    let routh = Routh::new(a)?;
    let output = precision.clamp(64, MAX_PRECISION);
    let integral = Rational::from(a[0].recip_ref());
    if all_real(a) {
        return Ok(Enclosure::from_rational(&integral, output));
    }
    let undecided = RelativeDegreeError::Undecided(Undecided::TimeScales);
    let negative = Response::new(&routh, &a[0], output).and_then(|response| response.negative_part(MAX_WORK));
    let Some(negative) = negative else { return Err(undecided) };
    let working = negative.precision().max(output);
    let result = Enclosure::from_rational(&integral, working) + negative * 2;
    let result = result.at_precision(output);
    if result.is_bounded() { Ok(result) } else { Err(undecided) }
}

/// The binary exponent of a positive number, 0 for others; only for choices of precision and step.
fn exponent(x: &Enclosure) -> i64 {
    x.upper().get_exp().map_or(0, i64::from)
}

pub(super) struct Response {
    pub(super) flow: Flow,
    n: usize,
    /// sqrt(P_1)
    pub(super) weight: Enclosure,
    /// Block lengths with upper bounds of |exp(S h)|, all below 1.
    contractions: Vec<(Enclosure, Enclosure)>,
    /// The total error aimed at, for the integral of y_1.
    goal: Enclosure,
    /// Estimate of the time to cover, for the share of each step in the error; a power of 2.
    horizon: i32,
    /// Order of the Taylor polynomials.
    order: usize,
    /// Bits of the step polynomials.
    polynomial_bits: u32,
}

impl Response {
    pub(super) fn new(routh: &Routh, a_1: &Rational, output: u32) -> Option<Response> {
        let n = routh.b.len();
        let weight = routh.b[1..]
            .iter()
            .fold(Enclosure::one(output + 64), |w, b| w * Enclosure::from_rational(b, output + 64).sqrt());
        let goal = scale(&(&weight / Enclosure::from_rational(a_1, output + 64)), TARGET);
        // A first look, to find the slowest time scale.
        let look = contracting(routh, 256)?;
        let slowest = look.blocks.last()?;
        let spread = look.blocks.len() as u32;
        let decades = (i64::from(slowest.exponent) - exponent(&goal)).clamp(1, 1 << 20);
        let horizon = slowest.exponent + (i64::BITS - decades.leading_zeros()) as i32 + 1;
        // Bits of error allowed on a step; the order that reaches them at |S h| about 2.
        let bits = decades + i64::from(i64::BITS - decades.leading_zeros()) + 8;
        let order = usize::try_from(bits / 4 + 12).ok()?.min(400);
        // A state that has lost its fast modes is smooth up to rounding errors, which grow by (spread)^order/order!.
        let factorial = (2..=order).map(|k| k.ilog2()).sum::<u32>();
        let amplification = (order as u32 * spread).saturating_sub(factorial);
        let wanted = bits + i64::from(spread) + 64 + i64::from(amplification);
        let precision = u32::try_from(wanted).ok()?.clamp(output, MAX_WORKING_PRECISION);
        let flow = contracting(routh, precision)?;
        let one = Enclosure::one(NORM_PRECISION);
        let count = flow.blocks.len();
        let contractions = flow.blocks[count.saturating_sub(6)..]
            .iter()
            .map(|block| (block.length(), block.spectral(n)))
            .filter(|(_, q)| q.lt(&one).is_true())
            .collect();
        let polynomial_bits = u32::try_from(bits).ok()?.saturating_add(48).max(96);
        Some(Response { flow, n, weight, contractions, goal, horizon, order, polynomial_bits })
    }

    /// An enclosure of the integral of max(-g, 0) over t >= 0, with steps up to about `effort`.
    pub(super) fn negative_part(&self, effort: u64) -> Option<Enclosure> {
        let rate = scale(&self.goal, -self.horizon);
        let allowed = scale(&rate, -4);
        let mut total = Enclosure::zero(self.polynomial_bits);
        let mut state = self.flow.start();
        let (mut work, mut level) = (0u64, 0usize);
        let cost = (2 * self.order * self.n + 10 * self.order + self.n * self.n) as u64
            * u64::from(self.flow.precision() / 256 + 1);
        loop {
            let tail = self.tail(&state)?;
            if work >= effort || tail.le(&self.goal).is_true() {
                // Twice the negative part is |y_1| - y_1: integrate, with 0 <= integral of |y_1| <= tail.
                let zero = Enclosure::zero(self.polynomial_bits);
                let twice = zero.hull(&tail) + state.project(&self.flow.inverse_row());
                // It is nonnegative: what the enclosure has below 0 is cut off.
                return Some((total + scale(&twice.max(&zero), -1)) / &self.weight);
            }
            work += cost;
            let (step, chosen) = self.step(&state, level, &rate, &allowed)?;
            total = total + step;
            level = chosen;
            state = self.flow.advance(&state, &self.flow.blocks[level]);
        }
    }

    /// An upper bound of the integral of |y_1| from the state on: the least over the contracting blocks.
    pub(super) fn tail(&self, state: &State) -> Option<Enclosure> {
        let size = state.norm();
        let one = Enclosure::one(NORM_PRECISION);
        let bounds = self.contractions.iter().map(|(h, q)| (h * &size / (&one - q)).ceiling());
        bounds.reduce(|a, b| a.min(&b)).filter(Enclosure::is_bounded)
    }

    /// The integral of max(-y_1, 0) over one step, and the block whose length the step has.
    fn step(&self, state: &State, level: usize, rate: &Enclosure, allowed: &Enclosure) -> Option<(Enclosure, usize)> {
        let mut derivative = state.points();
        let mut response = Vec::with_capacity(self.order);
        let mut factorial = Enclosure::one(NORM_PRECISION);
        for k in 1..=self.order {
            response.push(derivative.get(0));
            derivative = self.flow.apply(&derivative);
            factorial = factorial * (k as i64);
        }
        let size = derivative.norm();
        let remainder = |level: usize| match self.flow.blocks[level].exponent.checked_mul(self.order as i32) {
            Some(exponent) => (scale(&size, exponent) / &factorial).ceiling(),
            None => Enclosure::entire(NORM_PRECISION),
        };
        let mut level = (level + 2).min(self.flow.blocks.len() - 1);
        while level > 0 && !remainder(level).le(allowed).is_true() {
            level -= 1;
        }
        let h = self.flow.blocks[level].exponent;
        let error = (remainder(level) + &state.error).ceiling();
        let mut coefficients = Vec::with_capacity(self.order);
        let mut factorial = Enclosure::one(self.polynomial_bits);
        for (k, value) in response.iter().enumerate() {
            if k > 0 {
                factorial = factorial * (k as i64);
            }
            let exponent = h.checked_mul(k as i32)?;
            coefficients.push(scale(value, exponent).at_precision(self.polynomial_bits) / &factorial);
        }
        let tolerance = Tolerance { size: rate.lower(), area: scale(rate, -5).lower() };
        let area = Perturbed::new(&coefficients, &error, self.polynomial_bits).integral(&tolerance);
        Some((scale(&area, h), level))
    }
}

/// The flow with blocks up to the first one whose Frobenius norm is proved to be at most 1/2.
fn contracting(routh: &Routh, precision: u32) -> Option<Flow> {
    let mut flow = Flow::new(routh, precision)?;
    let half = scale(&Enclosure::one(NORM_PRECISION), -1);
    for _ in 0..MAX_DOUBLINGS {
        if flow.blocks.last()?.frobenius().le(&half).is_true() {
            return Some(flow);
        }
        flow.double()?;
    }
    None
}
