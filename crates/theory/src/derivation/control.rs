//! How large the control gets (derivation, 13.5), at the gain of a claim; it grows with the gain, so of a larger one nothing is said.

use super::harmonics::AtOrigin;
use super::joint;
use super::mean_squares::Forcing;
use crate::data::{Numbers, Problem};
use rug::Rational;
use sigmastar_exact::real::{Operand, Real};
use sigmastar_lang::spec::JointStability;

/// Bounds of |u| for every n_o.
#[derive(Clone, Debug)]
pub struct Control<R> {
    /// Of |u| along the periodic solution.
    pub steady: R,
    /// Of |u - u_per(t)| of every solution from the claimed set, at all times.
    pub transient: R,
}

/// What the control makes of the harmonics of q but for the mean, which it answers by its opposite.
#[derive(Clone, Debug)]
pub struct Answer<R> {
    /// F: |u_j| <= F |q_j|.
    pub harmonic: R,
    /// Of the sum of all |u_j| over rms(q').
    pub by_rate: R,
}

impl<R: Real> Answer<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// In continuous time F = 2/sqrt(3) and `F T/sqrt(12) = T/3`, by Cauchy-Schwarz.
    ///
    /// u_j = (P S - 1) q_j where P = i om/(i om + sigma) and S both are on the circle |z - 1/2| = 1/2.
    #[must_use]
    pub fn continuous(problem: &impl Problem<R>) -> Answer<R> {
        let harmonic = R::int(2) / R::int(3).sqrt();
        Answer { harmonic, by_rate: &problem.numbers().period / R::int(3) }
    }

    /// min{ m_0 + F' R_1, m_0 + F 2 sum_{k>=1} C_k + F' (r_1 + d_1), `by_parts` } with m_0 = min{ R_q, C_0 + r_0 + d_0 }, where `by_parts`
    /// bounds |u| by the sizes of e and zeta.
    ///
    /// Hypothesis: `forcing` bounds q along the periodic solution. Guarantee: |u| of that solution is not larger.
    #[must_use]
    pub fn steady(&self, origin: &AtOrigin<R>, forcing: &Forcing<R>, by_parts: &R) -> R {
        let Answer { harmonic, by_rate } = self;
        let Forcing { q_rms, q_rate_rms, change: [change, change_rate] } = forcing;
        let Some(known) = &origin.known else { return (q_rms + by_rate * q_rate_rms).min_known(by_parts) };
        let mean = q_rms.min_known(&(&known.mean + &known.rest_rms + change));
        let superposed = harmonic * &known.sum + by_rate * (&known.rest_t_rms + change_rate);
        (&mean + by_rate * q_rate_rms).min_known(&(&mean + superposed)).min_known(by_parts)
    }
}

/// `sigma e_per + mu Nbar Z`, from u = -sigma e + mu M'N zeta and |M'N zeta| <= Nbar |zeta|_N; at samples with K for mu.
#[must_use]
pub fn by_parts<R: Real>(problem: &impl Problem<R>, [sigma, mu]: [&R; 2], [e_per, z]: [&R; 2]) -> R
where
    for<'a> &'a R: Operand<R>,
{
    sigma * e_per + mu * &problem.numbers().n_bar * z
}

/// sqrt(L_0 (sigma^2 + mu^2 Nbar^2/h)), by Cauchy-Schwarz: U = w_x x'P x + e^2 + h |zeta|_N^2 stays below its value L_0 at the start. At
/// samples K stands for mu, and eta for h.
#[must_use]
pub fn transient<R: Real>(problem: &impl Problem<R>, [sigma, mu]: [&R; 2], h: &R, level: &R) -> R
where
    for<'a> &'a R: Operand<R>,
{
    (level * (sigma.sqr() + (mu * &problem.numbers().n_bar).sqr() / h)).sqrt()
}

/// The same of the metric `lam Pi_1 + (1 - lam) Pi_2`, lam = threshold/sigma (section 13.7, (Jm)): sqrt(V_0 (sigma^2/e_low + 2 mu Nbar^2/k_p)),
/// where V_0 is not above that share of both left sides of C4, and e_low and k_p are that share of both.
#[must_use]
pub fn joint_transient<R: Real>(
    problem: &impl Problem<R>,
    JointStability { inequality, levels }: &JointStability,
    number: impl Fn(&Rational) -> R,
    sigma: &Rational,
    distances: [&R; 3],
) -> R
where
    for<'a> &'a R: Operand<R>,
{
    let Numbers { mu, n_bar, .. } = problem.numbers();
    let near = Rational::from(&inequality.value / sigma);
    let shares = [number(&near), number(&(1 - near))];
    let both = inequality.metrics().into_iter().zip(levels).zip(&shares);
    let [mut start, mut e_low, mut k_p] = [0, 1, 2].map(|_| problem.zero());
    for ((metric, level), share) in both {
        start = start + share * joint::at_the_start(problem, (metric, level), &number, distances);
        e_low = e_low + share * number(&level.e_low);
        k_p = k_p + share * number(&metric.k_p);
    }
    let sigma = number(sigma);
    (start * (sigma.sqr() / e_low + R::int(2) * (mu * n_bar.sqr()) / k_p)).sqrt()
}
