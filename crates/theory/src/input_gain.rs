//! What an uncertain input gain changes in the formulas (derivation, 13.1): e' = q(t,x,e) + b u, b one unknown constant in
//! `[b_lo, b_hi]`, 0 < b_lo <= 1 <= b_hi.
//!
//! With y := q + (1-b) sigma e + b mu s it is e' = y - sigma e, zeta' = Phi zeta - M y: the plant with gain b is the plant with
//! gain 1, b mu in the place of mu and q + (1-b) sigma e in that of q.

use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::real::{Operand, Real};

/// The interval `[b_lo, b_hi]` of an input gain that is not known exactly.
///
/// Hypothesis: 0 < b_lo <= 1 <= b_hi, and not both are 1: where both are, there is none of these, and every formula is the one without
/// it.
#[derive(Clone, Debug)]
pub struct InputGain<R> {
    /// b_lo.
    pub low: R,
    /// b_hi.
    pub high: R,
}

impl InputGain<Enclosure> {
    /// The middles.
    #[must_use]
    pub fn midpoints(&self) -> InputGain<f64> {
        InputGain { low: self.low.midpoint_f64(), high: self.high.midpoint_f64() }
    }
}

impl<R: Real> InputGain<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// `b_m = min{1, b_lo} = b_lo`: a harmonic of the answer e to q is at most `|q_j|/(b_m sqrt(sigma^2 + om_j^2))`.
    ///
    /// For `|i om + b sigma + i y (i om + sigma)|^2`, least over real y, is `(b sigma^2 + om^2)^2/(sigma^2 + om^2)`.
    #[must_use]
    pub fn of_error(&self) -> &R {
        &self.low
    }

    /// d_b at b_lo: `|om_j e_j| <= d_b |q_j|`; 1 where b_lo is certainly not below 1/2, else the larger one of 1 and
    /// `1/(2 sqrt(b_lo (1 - b_lo)))`, which is never below 1.
    #[must_use]
    pub fn of_error_rate(&self) -> R {
        let one = R::int(1);
        let half = &self.low + &self.low - &one;
        if half.is_certainly_positive() || half.is_zero() {
            return one;
        }
        // It is 1 at b_lo = 1/2, and falls in b below.
        let rest = &one - &self.low;
        (&one / (R::int(2) * (&self.low * rest).sqrt())).max(&one)
    }

    /// `c_m`, the least `c_b` at both ends, with c_b = b up to 1 and `2/sqrt(3 + b)` beyond: `|y_j| sqrt(1 + (b nu g)^2) <= |q_j|/c_b`.
    #[must_use]
    pub fn of_steady_state(&self) -> R {
        self.low.min(&(R::int(2) / (R::int(3) + &self.high).sqrt()))
    }

    /// `b_lo^3`, not above `b c_b^2`: sup - inf of |zeta|_N^2 is at most `T R_q^2/(2 b_lo^3 mu)`.
    #[must_use]
    pub fn of_swing(&self) -> R {
        self.low.sqr() * &self.low
    }

    /// The sector of dq/de + (1-b) sigma over both ends, from that of dq/de, with which C5 is what it is without a gain: from
    /// `-(k_l + (b_hi - 1) sigma)` up to `m + (1 - b_lo) sigma`.
    ///
    /// m is max(m, 0), unless (B): `4 ht sigma >= (1 + ht (1-b) sigma)^2` at both ends, with which m itself serves every larger gain.
    #[must_use]
    pub fn sector(&self, [below, above]: [&R; 2], h_over_mu: &R, sigma: &R) -> [R; 2] {
        let one = R::int(1);
        let above = if self.allows_damping(h_over_mu, sigma) { above.clone() } else { above.max(&(&one - &one)) };
        [below + (&self.high - &one) * sigma, above + (one - &self.low) * sigma]
    }

    /// Both members of (B), `(1 + ht (1-b) sigma)^2` at the worse end and `4 ht sigma`.
    #[must_use]
    pub fn damping(&self, h_over_mu: &R, sigma: &R) -> [R; 2] {
        let moved = h_over_mu * sigma;
        let at = |b: &R| (R::int(1) + &moved * (R::int(1) - b)).sqr();
        [at(&self.low).max(&at(&self.high)), R::int(4) * moved]
    }

    /// Whether (B) is certain.
    fn allows_damping(&self, h_over_mu: &R, sigma: &R) -> bool {
        let [worst, room] = self.damping(h_over_mu, sigma);
        (room - worst).is_certainly_positive()
    }
}
