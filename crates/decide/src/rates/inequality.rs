//! A decay rate of the closed loop for given oscillators, from any quadratic Lyapunov function that serves in the error box: (R) of
//! derivation, section 13.6.
//!
//! C4 and C5 keep the solution in the error box of the certificate (derivation, section 5). There the following holds whatever
//! Lyapunov function proved it, so that a rate may come from another one, made for some oscillators and one gain. With
//! `zs = N^(1/2) zt`, `b = N^(1/2) M`, `y = (et, zs)`, xi^2 = xt'P_x xt, and delta in [-k_l, m] from dq/de,
//!
//!   `y' = (A + delta B e') y + B u_x`,  `A = [[-sigma, mu b'], [0, Phi - mu b b']]`,  `B = (1, -b)`,  `e = (1, 0)`,
//!   `(xi^2)' <= -2 a_2 xi^2 + 2 sqrt(P_up) k_f xi |et|`,  |u_x| <= k_x xi.
//!
//! For `W = w xi^2 + y'Pi y` with w > 0, Pi positive definite and l > 0, let M(mu, delta) be the symmetric matrix of
//!
//!   `2 w (a_2 - rate) xi^2 - 2 w sqrt(P_up) k_f xi et - 2 y'Pi (A + delta B e' + rate) y - 2 y'Pi B u_x + l (u_x^2 - k_x^2 xi^2)`
//!
//! in v = (xi, y, u_x). If it is positive definite at delta = -k_l and at delta = m, then `W' <= -2 rate W`.
//! Proof: M is affine in delta, so it is positive definite for every delta between; where et < 0 take (xi, -y, -u_x) for v; then
//! `-(W' + 2 rate W) >= v'M v + l (k_x^2 xi^2 - u_x^2) >= 0`. QED
//!
//! *With inputs.* A disturbance d of q enters by B, noise v of the measured e by
//! `B_v = (0, -Phi b - sigma b) - b_u (sigma + mu b'b) B`, b_u being the input gain. Let M be that of the form with
//! `- 2 y'Pi B d - 2 y'Pi B_v v + g_d d^2 + g_v v^2` besides, in (xi, y, u_x, d, v). If it is positive definite at the corners then
//! `W' <= -2 rate W + g_d d^2 + g_v v^2`, by the same proof: d and v change their sign with y. The rate then is the lambda of (N).
//!
//! - *Input gain b* (13.1): the loop is that of gain 1 with b mu for mu and delta + (1-b) sigma for delta. M is affine in
//!   (b, delta), so the four corners serve every b of the interval, with one W.
//! - *Bounds in the harder direction.* The relations above stay true with a smaller a_2 and with larger sqrt(P_up) (as w > 0), k_x,
//!   k_l, m and k_f. So M is written with rational bounds of these numbers and what it proves holds for the true ones; no
//!   monotonicity of M is needed. mu, w and the roots in b are enclosed: M and Pi are proved positive definite for every value in
//!   the enclosures.
//! - *The gain.* A has this sigma in it, and Pi a product of et and zs, so the rate is claimed for this gain only. The error box
//!   is that of sigma*, and serves every larger gain.
//! - *Without k_x* u_x is 0, and has no row. Of et and zs alone xi can then be left out too: their equations do not have it.
//! - *Without x.* If b_f is 0 on the error box, f = 0 there, so `F = 0` and `P_x' <= -2 alpha P_x`, which no P_x >= P_low I on the
//!   whole line satisfies unless n = 0. Then xi and u_x are left out, and with them the bound a_2 of the rate.

use super::oscillators::OscillatorMatrix;
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_matrix::ScaledMatrix;
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::stability::ErrorBox;

/// What bounds the nonlinear terms in the error box, each in the harder direction.
#[derive(Clone, Debug)]
pub struct LoopBounds {
    /// Whether xi counts; if not, xi and u_x are left out.
    pub has_x: bool,
    /// A lower bound of a_2 (alpha - gam, or better), in 1/time.
    pub x_decay: Rational,
    /// An upper bound of sqrt(P_up).
    pub root_p_up: Rational,
    /// An upper bound of k_x.
    pub k_x: Rational,
    /// An upper bound of k_f.
    pub k_f: Rational,
    /// Bounds of dq/de: -k_l and m.
    pub slopes: [Rational; 2],
}

impl LoopBounds {
    /// Those of (e, zeta) on an error box, which x reaches through k_x only; `None` if one of them is not bounded.
    #[must_use]
    pub fn of_error(data: &Data<'_>, error_box: &ErrorBox<Enclosure>) -> Option<LoopBounds> {
        let has_x = error_box.k_x.upper_rational()? != 0;
        let of_x = |k: &Enclosure| if has_x { k.upper_rational() } else { Some(Rational::new()) };
        let sector = &error_box.sector;
        Some(LoopBounds {
            has_x,
            x_decay: if has_x { error_box.rate.lower_rational()? } else { Rational::new() },
            root_p_up: data.p_up.sqrt().upper_rational()?,
            k_x: of_x(&error_box.k_x)?,
            k_f: of_x(&error_box.k_f)?,
            slopes: [-sector.below.upper_rational()?, sector.above.upper_rational()?],
        })
    }
}

/// The error system of some oscillators at one gain.
pub struct ErrorDynamics<'a> {
    /// The internal model.
    pub oscillators: &'a OscillatorMatrix,
    /// The gain, in 1/time.
    pub sigma: Rational,
    /// The bounds of the rest.
    pub bounds: &'a LoopBounds,
    /// The ends of an input gain b that is known to an interval; none where it is 1.
    pub input_gain: Option<[Enclosure; 2]>,
}

/// The numbers of a proof.
#[derive(Clone, Debug)]
pub struct RateWitness {
    /// The rate, in 1/time.
    pub rate: Rational,
    /// w; of no account where xi is left out.
    pub w: Rational,
    /// The lower triangle of Pi on (et, zs), row by row; of order 2 p + 2, with p oscillators beside the integrator.
    pub pi: Vec<Vec<Rational>>,
    /// l; of no account where u_x is left out.
    pub l: Rational,
    /// g_d and g_v of the inputs that are there.
    pub inputs: [Option<Rational>; 2],
}

/// The signals of the quadratic form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Signal {
    /// xi.
    Xi,
    /// An entry of y = (et, zs).
    Y(usize),
    /// u_x.
    Ux,
    /// The disturbance d of q.
    D,
    /// The noise v of the measured e.
    V,
}

/// A corner (b, delta) of what varies.
pub struct Corner {
    /// `(delta, b mu b')`: what comes back to the input B.
    row: Vec<Enclosure>,
    /// Pi B_v.
    noise: Vec<Enclosure>,
}

impl<'a> ErrorDynamics<'a> {
    /// Those of the data.
    #[must_use]
    pub fn new(
        data: &Data<'_>,
        oscillators: &'a OscillatorMatrix,
        sigma: &Rational,
        bounds: &'a LoopBounds,
    ) -> ErrorDynamics<'a> {
        let input_gain = data.input_gain.as_ref().map(|gain| [gain.low.clone(), gain.high.clone()]);
        ErrorDynamics { oscillators, sigma: sigma.clone(), bounds, input_gain }
    }
}

impl ErrorDynamics<'_> {
    /// u as a function of (e, zs), entry by entry: `-sigma e + mu b'zs`.
    #[must_use]
    pub fn control(&self) -> Vec<Enclosure> {
        let OscillatorMatrix { mu, b, .. } = self.oscillators;
        let of_e = Enclosure::from_rational(&self.sigma, mu.precision()).negate();
        std::iter::once(of_e).chain(b.iter().map(|b| mu * b)).collect()
    }

    /// What noise is in u, over -1: `sigma + mu b'b`.
    #[must_use]
    pub fn noise_gain(&self) -> Enclosure {
        let OscillatorMatrix { mu, b, .. } = self.oscillators;
        let of_e = Enclosure::from_rational(&self.sigma, mu.precision());
        b.iter().fold(of_e, |sum, b| sum + mu * b.sqr())
    }

    /// The corners (b, delta): what stands before mu, and what is added at u to e.
    #[must_use]
    pub fn corners(&self) -> Vec<[Enclosure; 2]> {
        let precision = self.oscillators.mu.precision();
        let (one, number) = (Enclosure::one(precision), |value: &Rational| Enclosure::from_rational(value, precision));
        let ends = self.input_gain.as_ref().map_or_else(|| vec![one.clone()], |ends| ends.to_vec());
        let at = |b: &Enclosure, slope: &Rational| {
            let moved = (&one - b) * number(&self.sigma);
            [b.clone(), if self.input_gain.is_some() { moved + number(slope) } else { number(slope) }]
        };
        ends.iter().flat_map(|b| self.bounds.slopes.each_ref().map(|slope| at(b, slope))).collect()
    }

    /// Whether the numbers prove their rate, as the module says.
    ///
    /// Guarantee: if true, then for every solution that stays in the error box W falls at least like exp(-2 rate t), with W
    /// positive definite. If false, nothing is known.
    #[must_use]
    pub fn proves(&self, witness: &RateWitness) -> bool {
        let n = self.oscillators.order() + 1;
        let positive = witness.inputs.iter().flatten().all(|weight| *weight > 0);
        if !is_triangle(&witness.pi, n) || !positive || (self.bounds.has_x && witness.w <= 0) {
            return false;
        }
        let form = Form::new(self, witness);
        is_definite(n, |i, j| form.at(i, j))
            && form.corners().iter().all(|corner| is_definite(form.order(), |i, j| form.entry(corner, i, j)))
    }
}

/// Whether these are the rows of the lower triangle of a matrix of this order.
pub(super) fn is_triangle(pi: &[Vec<Rational>], order: usize) -> bool {
    pi.len() == order && pi.iter().enumerate().all(|(i, row)| row.len() == i + 1)
}

/// A symmetric matrix row by row, from the rows of its lower triangle.
pub(super) fn whole(lower: &[Vec<Rational>], precision: u32) -> Vec<Enclosure> {
    let places = (0..lower.len()).flat_map(|i| (0..lower.len()).map(move |j| (i.max(j), i.min(j))));
    places.map(|(i, j)| Enclosure::from_rational(&lower[i][j], precision)).collect()
}

/// B = (1, -b), where it is not zero: at every second state it is.
pub(super) fn input(oscillators: &OscillatorMatrix) -> Vec<(usize, Enclosure)> {
    let first = (0, Enclosure::one(oscillators.mu.precision()));
    let model = oscillators.b.iter().enumerate().filter(|(state, _)| *state == 0 || state % 2 == 1);
    std::iter::once(first).chain(model.map(|(state, b)| (state + 1, b.negate()))).collect()
}

/// Whether Pi > diag(e_low, 0) is proved; Pi by the rows of its lower triangle.
#[must_use]
pub fn is_above(pi: &[Vec<Rational>], e_low: &Rational, precision: u32) -> bool {
    let number = |value: &Rational| Enclosure::from_rational(value, precision);
    is_definite(pi.len(), |i, j| {
        let entry = number(&pi[i.max(j)][i.min(j)]);
        if (i, j) == (0, 0) { entry - number(e_low) } else { entry }
    })
}

/// Whether a symmetric matrix is proved positive definite.
#[must_use]
pub fn is_definite(order: usize, entry: impl Fn(usize, usize) -> Enclosure + Sync) -> bool {
    ScaledMatrix::from_enclosures(order, entry).is_some_and(|matrix| matrix.is_positive_definite() == Truth::True)
}

/// The matrix M, entry by entry.
pub struct Form<'a> {
    dynamics: &'a ErrorDynamics<'a>,
    /// The signals, in the order of the rows.
    pub signals: Vec<Signal>,
    /// Pi, row by row.
    pi: Vec<Enclosure>,
    /// Pi B.
    image: Vec<Enclosure>,
    /// For each entry of y the one entry of that column of blkdiag(-sigma, Phi): its row and value.
    columns: Vec<Option<(usize, Enclosure)>>,
    twice_rate: Enclosure,
    w: Enclosure,
    l: Enclosure,
    /// g_d and g_v, 0 where there is no such input.
    inputs: [Enclosure; 2],
}

impl<'a> Form<'a> {
    /// Of a witness.
    #[must_use]
    pub fn new(dynamics: &'a ErrorDynamics<'a>, witness: &RateWitness) -> Form<'a> {
        let oscillators = dynamics.oscillators;
        let precision = oscillators.mu.precision();
        let number = |value: &Rational| Enclosure::from_rational(value, precision);
        let n = oscillators.order() + 1;
        let (pi, inputs) = (whole(&witness.pi, precision), input(oscillators));
        let image = (0..n)
            .map(|i| inputs.iter().fold(Enclosure::zero(precision), |sum, (j, b)| sum + &pi[i * n + j] * b))
            .collect();
        let mut columns = vec![Some((0, number(&dynamics.sigma).negate()))];
        columns.extend((0..n - 1).map(|column| oscillators.phi(column).map(|(row, entry)| (row + 1, entry))));
        let mut signals = Vec::with_capacity(n + 2);
        signals.extend(dynamics.bounds.has_x.then_some(Signal::Xi));
        signals.extend((0..n).map(Signal::Y));
        signals.extend((dynamics.bounds.k_x != 0).then_some(Signal::Ux));
        signals.extend(witness.inputs[0].as_ref().map(|_| Signal::D));
        signals.extend(witness.inputs[1].as_ref().map(|_| Signal::V));
        let inputs =
            witness.inputs.each_ref().map(|weight| weight.as_ref().map_or_else(|| number(&Rational::new()), number));
        let (twice_rate, w, l) = (number(&witness.rate) * 2, number(&witness.w), number(&witness.l));
        Form { signals, pi, image, columns, twice_rate, w, l, inputs, dynamics }
    }

    /// The number of signals.
    #[must_use]
    pub fn order(&self) -> usize {
        self.signals.len()
    }

    fn at(&self, i: usize, j: usize) -> Enclosure {
        self.pi[i * self.image.len() + j].clone()
    }

    /// All corners.
    #[must_use]
    pub fn corners(&self) -> Vec<Corner> {
        self.dynamics.corners().iter().map(|corner| self.corner(corner)).collect()
    }

    /// At one corner.
    #[must_use]
    pub fn corner(&self, [gain, slope]: &[Enclosure; 2]) -> Corner {
        let OscillatorMatrix { mu, b, .. } = self.dynamics.oscillators;
        let (n, precision) = (self.image.len(), mu.precision());
        let through = gain * mu;
        let row = std::iter::once(slope.clone()).chain(b.iter().map(|b| &through * b)).collect();
        let sigma = Enclosure::from_rational(&self.dynamics.sigma, precision);
        // (Phi + sigma) b by its states, and sigma + mu b'b.
        let mut fed: Vec<Enclosure> = b.iter().map(|b| &sigma * b).collect();
        for (column, b) in b.iter().enumerate() {
            if let Some((row, entry)) = self.dynamics.oscillators.phi(column) {
                fed[row] = &fed[row] + entry * b;
            }
        }
        let total = b.iter().fold(sigma, |sum, b| sum + mu * b.sqr());
        let control = gain * total;
        let noise = (0..n).map(|i| {
            let of_model = fed
                .iter()
                .enumerate()
                .fold(&control * &self.image[i], |sum, (j, fed)| sum + &self.pi[i * n + j + 1] * fed);
            of_model.negate()
        });
        Corner { row, noise: noise.collect() }
    }

    /// The entry of two of the signals at a corner.
    #[must_use]
    pub fn entry(&self, corner: &Corner, i: usize, j: usize) -> Enclosure {
        self.coefficient(corner, self.signals[i], self.signals[j])
    }

    /// The entry of any two signals at a corner, in either order.
    #[must_use]
    pub fn coefficient(&self, corner: &Corner, first: Signal, second: Signal) -> Enclosure {
        use Signal::{D, Ux, V, Xi, Y};
        let LoopBounds { x_decay, root_p_up, k_x, k_f, .. } = self.dynamics.bounds;
        let number = |value: &Rational| Enclosure::from_rational(value, self.twice_rate.precision());
        match (first, second) {
            (Xi, Xi) => &self.w * (number(x_decay) * 2 - &self.twice_rate) - &self.l * number(k_x).sqr(),
            (Xi, Y(0)) | (Y(0), Xi) => (&self.w * number(root_p_up) * number(k_f)).negate(),
            (Y(i), Y(j)) => self.linear(&corner.row, i, j),
            (Y(i), Ux | D) | (Ux | D, Y(i)) => self.image[i].negate(),
            (Y(i), V) | (V, Y(i)) => corner.noise[i].negate(),
            (Ux, Ux) => self.l.clone(),
            (D, D) => self.inputs[0].clone(),
            (V, V) => self.inputs[1].clone(),
            _ => Enclosure::zero(self.twice_rate.precision()),
        }
    }

    /// `-(Pi A + A'Pi + 2 rate Pi)_ij`, from `A = blkdiag(-sigma, Phi) + B row`.
    fn linear(&self, row: &[Enclosure], i: usize, j: usize) -> Enclosure {
        let n = self.image.len();
        let half = |i: usize, j: usize| {
            let feedback = &self.image[i] * &row[j];
            match &self.columns[j] {
                Some((row, entry)) => feedback + &self.pi[i * n + row] * entry,
                None => feedback,
            }
        };
        (half(i, j) + half(j, i) + &self.twice_rate * &self.pi[i * n + j]).negate()
    }
}
