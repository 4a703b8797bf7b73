//! A rate for the closed loop by the paper's constants c and kappa (P:eq:derUs), for comparison.
//!
//! With `zs = N^(1/2) zt`, `zs' = A zs - b u`, |u| <= k_x xi + k_e |et|, `P A + A'P <= -I`, p the largest eigenvalue of P and
//! g = |P b|: `(zs'P zs)' <= -|zs|^2 + 2 g |zs| |u| <= -|zs|^2/2 + 4 g^2 (k_x^2 xi^2 + k_e^2 et^2)`. If the quadratic form of C5 is at
//! least `r_x xi^2 + r_e et^2`, then W = U + eps zs'P zs with `eps <= min{r_x/(8 g^2 k_x^2), r_e/(8 g^2 k_e^2)}` has
//! `W' <= -(r_x/2) xi^2 - (r_e/2) et^2 - (eps/2) |zs|^2`, and `W <= w_x xi^2 + et^2 + (h + eps p) |zs|^2`. So `W' <= -2 rate W` with
//! `rate = min{ r_x/(4 w_x), r_e/4, eps/(4 (h + eps p)) }`, in the error box, where C4 keeps the solution: the state converges at
//! least like exp(-rate t). The paper's W is U + c (N + kappa P), and its limit for kappa -> oo with eps = c kappa is this one; its
//! constant nu/(2[...]) has to be nu/(4[...]), because the sum of the two terms of u counts as in `u^2 <= 2 k_x^2 xi^2 + 2 k_e^2 et^2`.
//!
//! It uses C5 with the weights of the certificate, which at sigma* leave next to nothing: see `sigmastar_prove::rate::inequality`.

use rug::Rational;
use sigmastar_decide::conditions::SharpProof;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_matrix::is_positive_definite;
use sigmastar_prove::lmi::{DecayData, propose_multipliers, verify_decay};
use sigmastar_prove::rate::oscillators::ProvedLyapunov;
use sigmastar_theory::data::Data;

/// Shares of the diagonal that are tried for r_x and r_e, as 1 - 2^-k and then 2^-k.
const HALVINGS: u32 = 30;

/// What does not depend on n_o.
pub struct RateByKappa {
    w_x: Enclosure,
    h: Enclosure,
    k_x: Enclosure,
    /// b_qe, which bounds |dq/de| where the sector is one-sided too.
    k_e: Enclosure,
    r_x: Enclosure,
    r_e: Enclosure,
}

impl RateByKappa {
    /// Proves r_x and r_e at a gain; `None` where C5 is not proved there by its matrix inequality.
    ///
    /// Hypothesis: `sigma >= sigma*` of the proof, so that its error box is that of this gain too.
    #[must_use]
    pub fn new(data: &Data<'_>, proof: &SharpProof, sigma: &Rational) -> Option<RateByKappa> {
        let witness = &proof.witness;
        if *sigma < witness.sigma {
            return None;
        }
        let decay = DecayData::new(data, &proof.evaluation.error_box, &witness.w_x, &witness.h)?;
        let multipliers = propose_multipliers(&decay, sigma).ok()?.exact_multipliers()?;
        if !verify_decay(&decay, sigma, &multipliers) {
            return None;
        }
        // Shares of the diagonal entries 2 w_x (alpha - gam) and 2 sigma, given up from the matrix, exactly.
        let taken = |share: &Rational| {
            let r_x = Rational::from(&decay.w_x * &decay.rate) * 2u32 * share;
            let r_e = Rational::from(sigma * share) * 2u32;
            (r_x, r_e)
        };
        let present = multipliers.iter().zip(decay.present()).filter(|(_, present)| *present);
        let unknowns: Vec<Rational> =
            std::iter::once(sigma.clone()).chain(present.map(|(multiplier, _)| multiplier.clone())).collect();
        let holds = |share: &Rational| {
            let (r_x, r_e) = taken(share);
            decay.mu.iter().all(|mu| {
                let mut rows = decay.matrix(mu).substitute(&unknowns).constant().rows();
                rows[0][0] -= &r_x;
                rows[1][1] -= &r_e;
                is_positive_definite(&rows)
            })
        };
        let mut share = Rational::from(1);
        let mut proved = None;
        for _ in 0..HALVINGS {
            share /= 2u32;
            // Binary search from above: the largest multiple of the step that still holds.
            let next = proved.clone().unwrap_or_default() + &share;
            if holds(&next) {
                proved = Some(next);
            }
        }
        let (r_x, r_e) = taken(&proved?);
        let number = |value: &Rational| Enclosure::from_rational(value, data.precision);
        Some(RateByKappa {
            w_x: number(&decay.w_x),
            h: number(&decay.h),
            k_x: number(&decay.k_x),
            k_e: number(&decay.sector[0]),
            r_x: number(&r_x),
            r_e: number(&r_e),
        })
    }

    /// The rate with P_zeta of one n_o, in 1/time; its lower end is what is proved.
    #[must_use]
    pub fn rate(&self, lemma: &ProvedLyapunov) -> Enclosure {
        let precision = self.h.precision();
        let largest = Enclosure::from_rational(&lemma.largest, precision);
        // A large eps where nothing limits it: the third term then is close to its supremum 1/(4 p).
        let mut eps = &self.h * 1024 / &largest;
        for (r, k) in [(&self.r_x, &self.k_x), (&self.r_e, &self.k_e)] {
            let coupling = (&lemma.gain * k).sqr() * 8;
            // Only where there is surely no coupling there is no limit; one that is not known limits eps to nothing.
            if !coupling.upper().is_zero() {
                eps = eps.min(&(r / coupling));
            }
        }
        // One number: any eps up to the limit is allowed.
        let eps = eps
            .lower_rational()
            .map_or_else(|| Enclosure::undefined(precision), |eps| Enclosure::from_rational(&eps, precision));
        let third = &eps / ((&self.h + &eps * largest) * 4);
        (&self.r_x / (&self.w_x * 4)).min(&(&self.r_e / 4)).min(&third)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// w_x = h = r_x = r_e = 1, P = I/2 and |P b| = 1: without coupling the rate is nearly 1/(4 p) = 1/2, but for r_e/4 = 1/4.
    #[test]
    fn only_a_coupling_of_zero_sets_no_limit() {
        let one = || Enclosure::one(64);
        let rate = |k_x: Enclosure| {
            let by_kappa = RateByKappa { w_x: one(), h: one(), k_x, k_e: Enclosure::zero(64), r_x: one(), r_e: one() };
            by_kappa.rate(&ProvedLyapunov { rate: Rational::new(), largest: Rational::from((1, 2)), gain: one() })
        };
        assert_eq!(rate(Enclosure::zero(64)).lower_f64(), 0.25);
        // eps = 1/8: 1/8 / (4 (1 + 1/16)).
        assert!((rate(one()).lower_f64() - 1.0 / 34.0).abs() < 1e-15);
        for unknown in [Enclosure::between(&Rational::new(), &Rational::from(1), 64), Enclosure::undefined(64)] {
            assert!(!rate(unknown).is_positive().is_true());
        }
    }
}
