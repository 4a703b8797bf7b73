//! The parts of a specification, with every number exact.

use crate::expr::{Expr, Monomial, Variables};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::write_exact;

/// A real constant: its text, and its exact form where it has one.
#[derive(Clone, Debug)]
pub struct Constant {
    /// As written in the document.
    pub text: String,
    /// The expression, without variables.
    pub expr: Expr,
    /// The exact value, when the expression has the form c sqrt(r) pi^k.
    pub exact: Option<Monomial>,
}

impl Constant {
    /// An enclosure at the given precision.
    #[must_use]
    pub fn enclose(&self, precision: u32) -> Enclosure {
        match &self.exact {
            Some(exact) => exact.enclose(precision),
            None => self.expr.enclose_constant(precision),
        }
    }

    /// A rational constant.
    #[must_use]
    pub fn rational(value: &Rational) -> Constant {
        let text = write_exact(value);
        // A decimal or a fraction of two integers; should it be beyond the limits of expressions, its value stands alone.
        let expr = Expr::parse(&text, Variables::None).unwrap_or_else(|_| Expr::zero());
        Constant { text, expr, exact: Some(Monomial::rational(value.clone())) }
    }

    /// This constant over a positive whole number; `None` where that cannot be written.
    #[must_use]
    pub fn divided_by(&self, divisor: u32) -> Option<Constant> {
        if let Some(exact) = self.as_rational() {
            return (divisor > 0).then(|| Constant::rational(&Rational::from(exact / divisor)));
        }
        let text = format!("({})/{divisor}", self.text);
        let expr = Expr::parse(&text, Variables::None).ok()?;
        let exact = expr.exact();
        Some(Constant { text, expr, exact })
    }

    /// The exact rational value, if the constant is known to be rational.
    #[must_use]
    pub fn as_rational(&self) -> Option<&Rational> {
        self.exact.as_ref().and_then(Monomial::as_rational)
    }

    /// The nearest double, for searches and display only.
    #[must_use]
    pub fn to_f64(&self) -> f64 {
        self.enclose(64).midpoint_f64()
    }
}

/// `p_low I <= P_x(t) <= p_up I` and `P_x' + P_x F + F' P_x <= -2 alpha P_x` (P:eq:Pass1, P:eq:Pass2), with
/// 0 < p_low <= p_up and alpha > 0 (in 1/time).
#[derive(Clone, Debug)]
pub struct Lyapunov {
    /// Lower bound of P_x.
    pub p_low: Constant,
    /// Upper bound of P_x.
    pub p_up: Constant,
    /// Rate.
    pub alpha: Constant,
}

/// `q(t,0,0) = sum_{|k| <= K} c_k e^{i k Om t} + rest` with Om = 2 pi / period (derivation, 10.1).
#[derive(Clone, Debug)]
pub struct KnownForcing {
    /// Bounds of |c_0|, ..., |c_K|, nonnegative; at least one.
    pub harmonics: Vec<Constant>,
    /// A bound of rms(rest), nonnegative.
    pub rest_rms: Constant,
    /// A bound of the rms of the rest's derivative, nonnegative; one that follows from other data serves without it.
    pub rest_t_rms: Option<Constant>,
}

/// F(t) = df/dx(t,0,0), in 1/time: every matrix function whose entries are as described, each for itself.
#[derive(Clone, Debug)]
pub struct Jacobian {
    /// The rows of a square matrix.
    pub rows: Vec<Vec<JacobianEntry>>,
    /// The period, where it is known exactly; without it every entry is constant or an interval.
    pub period: Option<Monomial>,
}

/// An entry of a Jacobian.
#[derive(Clone, Debug)]
pub enum JacobianEntry {
    /// A constant or a trigonometric polynomial in t with the period of the specification.
    Function(Expr),
    /// Any (continuous) function of time with values between the two, lower <= upper.
    Interval(Box<[Constant; 2]>),
}

/// `P(t) = mean + sum_k (cos_k cos(k w t) + sin_k sin(k w t))`, w = 2 pi / period, with symmetric rational matrices.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PeriodicMatrix {
    /// The rows of the mean.
    pub mean: Vec<Vec<Rational>>,
    /// The rows of (cos_k, sin_k) for k = 1, 2, ...; empty for a constant matrix.
    pub harmonics: Vec<[Vec<Vec<Rational>>; 2]>,
}

/// `mean + sum_k (cos_k cos(k w t) + sin_k sin(k w t))` with exact vectors, w = 2 pi / period.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TrigonometricVector {
    /// The mean.
    pub mean: Vec<Rational>,
    /// (cos_k, sin_k) for k = 1, 2, ...; empty for a constant vector.
    pub harmonics: Vec<[Vec<Rational>; 2]>,
}

/// The box |x| <= X, |e| <= E on which the bounding functions hold; both positive.
#[derive(Clone, Debug)]
pub struct Domain {
    /// The largest |x|.
    pub x: Constant,
    /// The largest |e|.
    pub e: Constant,
}

/// The initial conditions |x| <= X0, |e| <= E0, |z|_N <= Z0 that the domain of attraction must cover.
#[derive(Clone, Copy, Debug)]
pub enum InitialSet<N = Constant> {
    /// X0 = 2 X_p, E0 = 2 E_p, Z0 = 2 (Z + Nbar E_p), as in theorem 1 of the paper.
    Paper,
    /// The controller starts at rest: Z0 = 0; X0 and E0 from the user, or 2 X_p and 2 E_p.
    AtRest {
        /// The user's X0.
        x0: Option<N>,
        /// The user's E0.
        e0: Option<N>,
    },
    /// A box given by the user.
    Box {
        /// X0.
        x0: N,
        /// E0.
        e0: N,
        /// Z0.
        z0: N,
    },
}

impl<N: Clone> InitialSet<N> {
    /// The same kind of set over other numbers.
    #[must_use]
    pub fn map<M>(&self, number: impl Fn(&N) -> M) -> InitialSet<M> {
        self.map_each(|_, size| number(size))
    }

    /// The same, where it matters which number it is: 0 for X_0, 1 for E_0, 2 for Z_0.
    #[must_use]
    pub fn map_each<M>(&self, mut number: impl FnMut(usize, &N) -> M) -> InitialSet<M> {
        match self {
            InitialSet::Paper => InitialSet::Paper,
            InitialSet::AtRest { x0, e0 } => InitialSet::AtRest {
                x0: x0.as_ref().map(|size| number(0, size)),
                e0: e0.as_ref().map(|size| number(1, size)),
            },
            InitialSet::Box { x0, e0, z0 } => {
                InitialSet::Box { x0: number(0, x0), e0: number(1, e0), z0: number(2, z0) }
            }
        }
    }

    /// X_0, E_0, Z_0: `paper`: 2 X_p, 2 E_p, 2 (Z + Nbar E_p); `at-rest`: the user's X_0, E_0 or 2 X_p, 2 E_p, and 0; `box`:
    /// the user's. Given are 2 X_p and 2 E_p, the paper's Z_0, and 0.
    #[must_use]
    pub fn required(&self, [x, e]: [N; 2], z: impl FnOnce() -> N, zero: N) -> [N; 3] {
        match self {
            InitialSet::Paper => [x, e, z()],
            InitialSet::AtRest { x0, e0 } => [x0.clone().unwrap_or(x), e0.clone().unwrap_or(e), zero],
            InitialSet::Box { x0, e0, z0 } => [x0.clone(), e0.clone(), z0.clone()],
        }
    }
}

/// The coefficients a_1, ..., a_{r-1} of e = xi_r + sum a_i xi_i: 1 to 20 rational numbers. That the polynomial
/// s^{r-1} + a_{r-1} s^{r-2} + ... + a_1 is Hurwitz is not checked here.
#[derive(Clone, Debug)]
pub struct RelativeDegree {
    /// a_1, ..., a_{r-1}; not empty.
    pub a: Vec<Constant>,
}
