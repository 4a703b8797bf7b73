//! The matrix of C5: defined once, in exact numbers, and decided exactly.

use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_matrix::{AffineMatrix, is_positive_definite};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::stability::ErrorBox;

/// The numbers of C5, each an exact bound in the direction in which C5 is harder (see [`verify_decay`]).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DecayData {
    /// w_x > 0.
    pub w_x: Rational,
    /// h > 0.
    pub h: Rational,
    /// Bounds of mu from below and from above, in 1/time; equal where mu is rational.
    pub mu: [Rational; 2],
    /// A lower bound of a_2 (alpha - gam, or better), in 1/time.
    pub rate: Rational,
    /// An upper bound of sqrt(P_up).
    pub root_p_up: Rational,
    /// An upper bound of k_x; 0 says that u_x vanishes.
    pub k_x: Rational,
    /// Upper bounds of k_l and m, u_e = delta et with -k_l <= delta <= m; 0 and 0 say that u_e vanishes.
    pub sector: [Rational; 2],
    /// An upper bound of k_f; 0 says that phi vanishes.
    pub k_f: Rational,
}

/// The signals of the quadratic form, in the order of the matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Signal {
    /// xi = sqrt(xt'P_x xt).
    X,
    /// et.
    E,
    /// s = M'N zt.
    S,
    /// u_x, |u_x| <= k_x xi.
    Ux,
    /// v = u_e - c_0 et with c_0 = (m - k_l)/2, the middle of the sector: |v| <= r |et|, r = (m + k_l)/2.
    Ue,
    /// phi, |phi| <= k_f |et|.
    Phi,
}

/// The sector, or a slightly larger one where it is nearly a single slope: its multiplier would run to infinity. Where it is
/// exactly one, u_e is that multiple of et, and has neither a row nor a multiplier.
fn open_sector([below, above]: [Rational; 2]) -> [Rational; 2] {
    let room = Rational::from(below.abs_ref()) >> 30u32;
    let least = room - &below;
    let is_single = Rational::from(&below + &above) == 0;
    let above = if !is_single && above < least { least } else { above };
    [below, above]
}

impl DecayData {
    /// The bounds of C5 on an error box; `None` if one of them is not bounded.
    #[must_use]
    pub fn new(data: &Data<'_>, error_box: &ErrorBox<Enclosure>, w_x: &Rational, h: &Rational) -> Option<DecayData> {
        let upper = Enclosure::upper_rational;
        Some(DecayData {
            w_x: w_x.clone(),
            h: h.clone(),
            mu: [data.mu.lower_rational()?, upper(&data.mu)?],
            rate: error_box.rate.lower_rational()?,
            root_p_up: upper(&data.p_up.sqrt())?,
            k_x: upper(&error_box.k_x)?,
            sector: open_sector([upper(&error_box.sector.below)?, upper(&error_box.sector.above)?]),
            k_f: upper(&error_box.k_f)?,
        })
    }

    /// c_0 = (m - k_l)/2, at most 0, and r = (m + k_l)/2.
    #[must_use]
    pub fn middle(&self) -> [Rational; 2] {
        let [below, above] = &self.sector;
        [Rational::from(above - below) / 2u32, Rational::from(above + below) / 2u32]
    }

    /// k_x, r, k_f with the signals they bound, in the order of the multipliers.
    fn sectors(&self) -> [(Signal, Signal, Rational); 3] {
        use Signal::{E, Phi, Ue, Ux, X};
        let [_, radius] = self.middle();
        [(Ux, X, self.k_x.clone()), (Ue, E, radius), (Phi, E, self.k_f.clone())]
    }

    /// Which of u_x, v, phi are rows of the matrix: those whose bound is not 0. (The multiplier of a signal that
    /// vanishes would run to infinity.)
    #[must_use]
    pub fn present(&self) -> [bool; 3] {
        self.sectors().map(|(_, _, k)| k != 0)
    }

    /// The symmetric matrix of
    /// `2 w_x a_2 xi^2 - 2 w_x sqrt(P_up) xi phi + 2 sigma et^2 - 2 et (u_x + u_e) - 2 mu et s + 2 h mu s^2
    /// + 2 h s (u_x + u_e) + l_x (u_x^2 - k_x^2 xi^2) + l_e (u_e - m et)(u_e + k_l et) + l_f (phi^2 - k_f^2 et^2)`
    /// in (xi, et, s, u_x, v, phi) with u_e = c_0 et + v, where the product is `v^2 - r^2 et^2`: et and u_e are nearly parallel
    /// in a narrow sector, et and v are not. Affine in (sigma, l_x, l_e, l_f); rows and multipliers that are not
    /// [`DecayData::present`] are left out.
    #[must_use]
    pub fn matrix(&self, mu: &Rational) -> AffineMatrix<Rational> {
        self.matrix_in_weights(mu).substitute(&[self.w_x.clone(), self.h.clone()])
    }

    /// The matrix of [`DecayData::matrix`], affine in (w_x, h, sigma, l_x, l_e, l_f). The data's own w_x and h are not used.
    #[must_use]
    pub fn matrix_in_weights(&self, mu: &Rational) -> AffineMatrix<Rational> {
        use Signal::{E, Phi, S, Ue, Ux, X};
        let sectors: Vec<_> = self.sectors().into_iter().filter(|(_, _, k)| *k != 0).collect();
        let [middle, _] = self.middle();
        let mut signals = vec![X, E, S];
        signals.extend(sectors.iter().map(|(signal, _, _)| *signal));
        let zero = Rational::new;
        let constant = |row: usize, column: usize| match (signals[row], signals[column]) {
            (E, E) => Rational::from(&middle * -2i32),
            (E, S) => -mu.clone(),
            (E, Ux | Ue) => Rational::from(-1),
            _ => zero(),
        };
        let term = |variable: usize, row: usize, column: usize| {
            let at = (signals[row], signals[column]);
            match (variable, at) {
                (0, (X, X)) => Rational::from(&self.rate * 2u32),
                (0, (X, Phi)) => -self.root_p_up.clone(),
                (1, (S, S)) => Rational::from(mu * 2u32),
                (1, (E, S)) => middle.clone(),
                (1, (S, Ux | Ue)) => Rational::from(1),
                (2, (E, E)) => Rational::from(2),
                (0..=2, _) => zero(),
                (_, (signal, other)) if signal == other => match &sectors[variable - 3] {
                    (bounded, _, _) if signal == *bounded => Rational::from(1),
                    (_, by, k) if signal == *by => -Rational::from(k * k),
                    _ => zero(),
                },
                _ => zero(),
            }
        };
        AffineMatrix::from_fn(signals.len(), 3 + sectors.len(), constant, term)
    }
}

/// Whether sigma and the multipliers (l_x, l_e, l_f) prove C5, decided exactly; those not present are ignored.
///
/// Guarantee: if true, then for every sigma' >= sigma, every mu in the interval, every a_2 at least `rate`, and every
/// sqrt(P_up) between 0 and its bound, the form of C5 is at least rho (xi^2 + et^2 + s^2) with one rho > 0, for all signals
/// with |u_x| <= k_x |xi|, u_e = delta et with -k_l <= delta <= m, |phi| <= k_f |et|.
///
/// Proof. Let M be the matrix at the bounds, positive definite; its diagonal has l_x, l_e, l_f, so they are positive.
/// - a_2 and sigma: raising them adds 2 w_x (..) >= 0 and 2 (..) >= 0 to the diagonal.
/// - k_x, k_f and the sector: what lies within smaller ones lies within these. (Where the bound is 0 the signal is 0 and its
///   row is left out.)
/// - sqrt(P_up) =: p occurs only in the entry (xi, phi), as -w_x p, and phi has no other off-diagonal entry. Changing the
///   sign of phi is a congruence that replaces p by -p, so M(-p) is positive definite as well; M is affine in p and the
///   positive definite matrices are convex, so M(p') is positive definite for |p'| <= p.
/// - mu: M is affine in mu, so positive definite at both ends gives it between them.
///
/// These changes combine: what is added to the diagonal does not depend on p and mu.
/// M is written in v = u_e - c_0 et, which is a congruence.
/// The set of all these parameters with sigma' = sigma and a_2 = rate is compact, so the least eigenvalue of the
/// matrices has a minimum rho > 0 there, and what is added for larger ones is nonnegative. The form of C5 is v'M v minus
/// l_x (u_x^2 - k_x^2 xi^2), l_e (u_e - m et)(u_e + k_l et) and l_f (phi^2 - k_f^2 et^2), each of which is <= 0 on the signals allowed; hence it is >= rho |v|^2. QED
#[must_use]
pub fn verify_decay(data: &DecayData, sigma: &Rational, multipliers: &[Rational; 3]) -> bool {
    let [mu_low, mu_up] = &data.mu;
    let positive = [&data.w_x, &data.h, mu_low].iter().all(|value| **value > 0) && mu_low <= mu_up;
    let [below, above] = &data.sector;
    let nonnegative = [&data.root_p_up, &data.k_x, below, &data.k_f].iter().all(|value| **value >= 0)
        && Rational::from(below + above) >= 0;
    if !positive || !nonnegative {
        return false;
    }
    let mut unknowns = vec![sigma.clone()];
    let present = multipliers.iter().zip(data.present()).filter(|(_, present)| *present);
    unknowns.extend(present.map(|(multiplier, _)| multiplier.clone()));
    let definite = |mu: &Rational| is_positive_definite(&data.matrix(mu).substitute(&unknowns).constant().rows());
    definite(mu_low) && (mu_low == mu_up || definite(mu_up))
}
