//! A decay rate of the closed loop from any quadratic Lyapunov function that serves in the error box.
//!
//! C4 and C5 keep the solution in the error box of the certificate (derivation, section 5). There the following holds whatever
//! Lyapunov function proved it, so that a rate may come from another one, made for one n_o and one gain. With
//! `zs = N^(1/2) zt`, `b = N^(1/2) M`, `y = (et, zs)`, xi^2 = xt'P_x xt, and u = u_x + u_e the difference of q,
//!
//!   `y' = A_y y + B u`,  `A_y = [[-sigma, mu b'], [0, Phi - mu b b']]`,  `B = (1, -b)`,
//!   `(xi^2)' <= -2 (alpha - gam) xi^2 + 2 sqrt(P_up) xi phi`,  |u_x| <= k_x xi,  |u_e| <= k_e |et|,  0 <= phi <= k_f |et|.
//!
//! For `W = w_x xi^2 + y'Q y` with w_x > 0 and Q positive definite, and for l_x, l_e, l_f > 0, let M be the symmetric matrix of
//!
//!   `2 w_x (alpha - gam - rate) xi^2 - 2 w_x sqrt(P_up) xi phi - y'(Q A_y + A_y'Q + 2 rate Q) y - 2 y'Q B (u_x + u_e)`
//!   `+ l_x (u_x^2 - k_x^2 xi^2) + l_e (u_e^2 - k_e^2 et^2) + l_f (phi^2 - k_f^2 et^2)`
//!
//! in v = (xi, et, zs, u_x, u_e, phi). If M is positive definite, then `W' <= -2 rate W`: the state of the error system tends to 0
//! at least like exp(-rate t), from every initial value of the certificate's set and for all time.
//! Proof: `-(W' + 2 rate W) >= v'M v + l_x (k_x^2 xi^2 - u_x^2) + l_e (k_e^2 et^2 - u_e^2) + l_f (k_f^2 et^2 - phi^2) >= 0`. QED
//!
//! - *Bounds in the harder direction.* The relations above stay true with a smaller alpha - gam and with larger sqrt(P_up) (as
//!   xi phi >= 0 and w_x > 0), k_x, k_e and k_f. So M is written with rational bounds of these five numbers and what it proves
//!   holds for the true ones; no monotonicity of M is needed. mu, w and the roots in b are enclosed: M and Q are proved positive
//!   definite for every value in the enclosures.
//! - *The gain.* A_y has this sigma in it, and Q a product of et and zs, so the rate is claimed for this gain only. The error box
//!   is that of sigma*, and serves every larger gain.
//! - *Signals that vanish.* Where the bound k of a signal is 0 the signal is 0, and its row is left out.
//! - *Without x.* If b_f is 0 on the error box, f = 0 there, so `F = 0` and `P_x' <= -2 alpha P_x`, which no P_x >= P_low I on the
//!   whole line satisfies unless n = 0. Then xi, u_x and phi are left out, and with them the bound alpha - gam of the rate.

use super::oscillators::OscillatorMatrix;
use faer::Mat;
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_matrix::ScaledMatrix;
use sigmastar_theory::data::{Bound, Data, Problem};
use sigmastar_theory::derivation::stability::ErrorBox;

/// What bounds the nonlinear terms in the error box, each in the harder direction.
#[derive(Clone, Debug)]
pub struct LoopBounds {
    /// Whether there may be an x; if not, xi, u_x and phi are 0.
    pub has_x: bool,
    /// A lower bound of a_2 (alpha - gam, or better), in 1/time.
    pub x_decay: Rational,
    /// An upper bound of sqrt(P_up).
    pub root_p_up: Rational,
    /// Upper bounds of k_x, k_e = b_qe, k_f; 0 for a signal that vanishes.
    pub gains: [Rational; 3],
}

impl LoopBounds {
    /// The bounds on an error box; `None` if one of them is not bounded.
    #[must_use]
    pub fn new(data: &Data<'_>, error_box: &ErrorBox<Enclosure>) -> Option<LoopBounds> {
        let has_x = data.bound(Bound::F, &error_box.x_b, &error_box.e_b).upper_rational()? != 0;
        let gain = |k: &Enclosure, present: bool| if present { k.upper_rational() } else { Some(Rational::new()) };
        Some(LoopBounds {
            has_x,
            x_decay: error_box.rate.lower_rational()?,
            root_p_up: data.p_up.sqrt().upper_rational()?,
            gains: [gain(&error_box.k_x, has_x)?, gain(&error_box.sector.below, true)?, gain(&error_box.k_f, has_x)?],
        })
    }
}

/// The error system of one n_o at one gain.
pub struct ErrorDynamics<'a> {
    /// The internal model.
    pub oscillators: &'a OscillatorMatrix,
    /// The gain, in 1/time.
    pub sigma: Rational,
    /// The bounds of the rest.
    pub bounds: &'a LoopBounds,
}

/// The numbers of a proof, each taken as the exact rational that it is.
#[derive(Clone, Debug)]
pub struct RateWitness {
    /// The rate, in 1/time.
    pub rate: Rational,
    /// w_x; of no account without x.
    pub w_x: f64,
    /// Q on (et, zs), of order 2 n_o + 2, of which the lower triangle is read.
    pub q: Mat<f64>,
    /// l_x, l_e, l_f; of no account for a signal that vanishes.
    pub multipliers: [f64; 3],
}

/// The signals of the quadratic form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Signal {
    Xi,
    /// An entry of y = (et, zs).
    Y(usize),
    Ux,
    Ue,
    Phi,
}

impl ErrorDynamics<'_> {
    /// Whether the numbers prove their rate, as the module says.
    ///
    /// Guarantee: if true, then for every solution that stays in the error box W falls at least like exp(-2 rate t), with W
    /// positive definite. If false, nothing is known.
    #[must_use]
    pub fn proves(&self, witness: &RateWitness) -> bool {
        let n = self.oscillators.order() + 1;
        let positive = witness.w_x > 0.0 || !self.bounds.has_x;
        if witness.q.nrows() != n || witness.q.ncols() != n || !positive {
            return false;
        }
        let proved = |matrix: Option<ScaledMatrix>| matrix.is_some_and(|m| m.is_positive_definite() == Truth::True);
        let Some(form) = Form::new(self, witness) else { return false };
        let signals = &form.signals;
        proved(ScaledMatrix::from_doubles(n, |i, j| witness.q[(i, j)], &vec![0.0; n]))
            && proved(ScaledMatrix::from_enclosures(signals.len(), |i, j| form.entry(signals[i], signals[j])))
    }
}

/// The matrix M, entry by entry.
struct Form<'a> {
    dynamics: &'a ErrorDynamics<'a>,
    signals: Vec<Signal>,
    /// Q, row by row.
    q: Vec<Enclosure>,
    /// Q B.
    image: Vec<Enclosure>,
    /// `(0, mu b)`.
    mu_b: Vec<Enclosure>,
    /// For each entry of y the one entry of that column of blkdiag(-sigma, Phi): its row and value.
    columns: Vec<Option<(usize, Enclosure)>>,
    twice_rate: Enclosure,
    w_x: Enclosure,
    multipliers: [Enclosure; 3],
    /// `l k^2` of the three signals, 0 for one that vanishes.
    taken: [Enclosure; 3],
}

impl<'a> Form<'a> {
    /// `None` if a number is not finite.
    fn new(dynamics: &'a ErrorDynamics<'a>, witness: &RateWitness) -> Option<Form<'a>> {
        let oscillators = dynamics.oscillators;
        let precision = oscillators.mu.precision();
        let number = |value: &Rational| Enclosure::from_rational(value, precision);
        let double = |value: f64| Some(number(&Rational::from_f64(value)?));
        let n = oscillators.order() + 1;
        let q: Option<Vec<Enclosure>> =
            (0..n).flat_map(|i| (0..n).map(move |j| (i.max(j), i.min(j)))).map(|at| double(witness.q[at])).collect();
        let q = q?;
        let input = |i: usize| match i.checked_sub(1) {
            None => Enclosure::one(precision),
            Some(state) => oscillators.b[state].negate(),
        };
        // B is zero at every second state.
        let inputs: Vec<(usize, Enclosure)> = (0..n).filter(|j| *j < 2 || j % 2 == 0).map(|j| (j, input(j))).collect();
        let image = (0..n)
            .map(|i| inputs.iter().fold(Enclosure::zero(precision), |sum, (j, b)| sum + &q[i * n + j] * b))
            .collect();
        let mut mu_b = vec![Enclosure::zero(precision)];
        mu_b.extend(oscillators.b.iter().map(|b| &oscillators.mu * b));
        let mut columns = vec![Some((0, number(&dynamics.sigma).negate()))];
        columns.extend((0..n - 1).map(|column| oscillators.phi(column).map(|(row, entry)| (row + 1, entry))));
        let [l_x, l_e, l_f] = witness.multipliers.map(double);
        let multipliers = [l_x?, l_e?, l_f?];
        let [k_x, k_e, k_f] = dynamics.bounds.gains.each_ref().map(|k| number(k).sqr());
        let [l_x, l_e, l_f] = &multipliers;
        let taken = [l_x * k_x, l_e * k_e, l_f * k_f];
        let mut signals = Vec::with_capacity(n + 4);
        signals.extend(dynamics.bounds.has_x.then_some(Signal::Xi));
        signals.extend((0..n).map(Signal::Y));
        let present = [Signal::Ux, Signal::Ue, Signal::Phi].into_iter().zip(&dynamics.bounds.gains);
        signals.extend(present.filter(|(_, k)| **k != 0).map(|(signal, _)| signal));
        Some(Form {
            signals,
            q,
            image,
            mu_b,
            columns,
            twice_rate: number(&witness.rate) * 2,
            w_x: double(witness.w_x)?,
            multipliers,
            taken,
            dynamics,
        })
    }

    fn zero(&self) -> Enclosure {
        Enclosure::zero(self.twice_rate.precision())
    }

    /// The entry of two signals, in either order.
    fn entry(&self, first: Signal, second: Signal) -> Enclosure {
        use Signal::{Phi, Ue, Ux, Xi, Y};
        let [l_x, l_e, l_f] = &self.multipliers;
        let [from_x, from_e, from_f] = &self.taken;
        let number = |value: &Rational| Enclosure::from_rational(value, self.twice_rate.precision());
        match (first, second) {
            (Xi, Xi) => &self.w_x * (number(&self.dynamics.bounds.x_decay) * 2 - &self.twice_rate) - from_x,
            (Xi, Phi) | (Phi, Xi) => (&self.w_x * number(&self.dynamics.bounds.root_p_up)).negate(),
            (Y(0), Y(0)) => self.linear(0, 0) - from_e - from_f,
            (Y(i), Y(j)) => self.linear(i, j),
            (Y(i), Ux | Ue) | (Ux | Ue, Y(i)) => self.image[i].negate(),
            (Ux, Ux) => l_x.clone(),
            (Ue, Ue) => l_e.clone(),
            (Phi, Phi) => l_f.clone(),
            _ => self.zero(),
        }
    }

    /// `-(Q A_y + A_y'Q + 2 rate Q)_ij`, from `A_y = blkdiag(-sigma, Phi) + mu B (0, b)'`.
    fn linear(&self, i: usize, j: usize) -> Enclosure {
        let n = self.image.len();
        let at = |i: usize, j: usize| &self.q[i * n + j];
        let half = |i: usize, j: usize| {
            let feedback = &self.image[i] * &self.mu_b[j];
            match &self.columns[j] {
                Some((row, entry)) => feedback + at(i, *row) * entry,
                None => feedback,
            }
        };
        (half(i, j) + half(j, i) + &self.twice_rate * at(i, j)).negate()
    }
}

#[cfg(test)]
mod tests;
