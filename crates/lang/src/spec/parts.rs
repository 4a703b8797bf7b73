//! The parts of a specification, with every number exact.

use crate::expr::{Expr, Fourier, Monomial, Variables, in_words};
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
        self.over(&Rational::from(divisor))
    }

    /// This constant over a positive rational number; `None` where that cannot be written.
    #[must_use]
    pub fn over(&self, divisor: &Rational) -> Option<Constant> {
        if *divisor <= 0 {
            return None;
        }
        if let Some(exact) = self.as_rational() {
            return Some(Constant::rational(&Rational::from(exact / divisor)));
        }
        let divisor = if divisor.is_integer() { divisor.to_string() } else { format!("({divisor})") };
        let text = format!("({})/{divisor}", self.text);
        let expr = Expr::parse(&text, Variables::None).ok()?;
        let exact = expr.exact();
        Some(Constant { text, expr, exact })
    }

    /// Its text within a sentence.
    #[must_use]
    pub fn words(&self) -> String {
        in_words(&self.text)
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

/// `P(t) = mean + sum_k (cos_k cos(k w t) + sin_k sin(k w t))`, w = 2 pi / period, with symmetric rational matrices,
/// each by its rows.
pub type PeriodicMatrix = Fourier<Vec<Vec<Rational>>>;

/// `mean + sum_k (cos_k cos(k w t) + sin_k sin(k w t))` with exact vectors, w = 2 pi / period.
pub type TrigonometricVector = Fourier<Vec<Rational>>;

/// `centre(t) + sum_i (p_i - p_i^0) sensitivity_i(t)`, for the parameters p of which intervals are known and their nominal values
/// p^0: a curve for each member of a family of plants (derivation, 13.2).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OrbitCurve {
    /// The curve of the nominal plant.
    pub centre: TrigonometricVector,
    /// One for each of these parameters.
    pub sensitivities: Vec<TrigonometricVector>,
}

impl From<TrigonometricVector> for OrbitCurve {
    fn from(centre: TrigonometricVector) -> OrbitCurve {
        OrbitCurve { centre, sensitivities: Vec::new() }
    }
}

impl OrbitCurve {
    /// The centre, and then the sensitivities.
    pub fn parts(&self) -> impl Iterator<Item = &TrigonometricVector> {
        std::iter::once(&self.centre).chain(&self.sensitivities)
    }

    /// The curve at these `p_i - p_i^0`.
    #[must_use]
    pub fn at(&self, deviations: &[Rational]) -> TrigonometricVector {
        let zero = vec![Rational::new(); self.centre.mean.len()];
        self.sensitivities.iter().zip(deviations).fold(self.centre.clone(), |curve, (part, deviation)| {
            curve.with(part, &zero, |own, more| {
                own.iter().zip(more).map(|(own, more)| own + Rational::from(more * deviation)).collect()
            })
        })
    }

    /// The most harmonics of a part.
    #[must_use]
    pub fn harmonics(&self) -> usize {
        self.parts().map(|part| part.harmonics.len()).max().unwrap_or(0)
    }
}

/// The box |x| <= X, |e| <= E on which the bounding functions hold; both positive.
#[derive(Clone, Debug)]
pub struct Domain {
    /// The largest |x|.
    pub x: Constant,
    /// The largest |e|.
    pub e: Constant,
}

/// The initial conditions that the domain of attraction must cover.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
    /// The controller sets z = M e at its first instant (section 13.7); X0 and E0 as at rest.
    Aligned {
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

/// The names of X_0, E_0 and Z_0 in files.
pub const SIZES: [&str; 3] = ["X0", "E0", "Z0"];

/// The initial conditions |x| <= x0, |e| <= e0 and |z|_N <= z0, or z = M e.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StartSizes<N = Rational> {
    /// X_0.
    pub x0: N,
    /// E_0.
    pub e0: N,
    /// Z_0; none where the controller sets z = M e at its first instant.
    pub z0: Option<N>,
}

impl<N> StartSizes<N> {
    /// The sizes of the same set in other numbers.
    #[must_use]
    pub fn map<M>(&self, mut number: impl FnMut(&N) -> M) -> StartSizes<M> {
        StartSizes { x0: number(&self.x0), e0: number(&self.e0), z0: self.z0.as_ref().map(number) }
    }

    /// The sizes that there are, under their names in files.
    pub fn named(&self) -> impl Iterator<Item = (&'static str, &N)> {
        SIZES.into_iter().zip([&self.x0, &self.e0].into_iter().chain(&self.z0))
    }
}

impl<N: Clone> InitialSet<N> {
    /// A set of this kind over other numbers.
    #[must_use]
    pub fn map<M>(&self, number: impl Fn(&N) -> M) -> InitialSet<M> {
        self.map_each(|_, size| number(size))
    }

    /// A set of this kind over other numbers, where it matters which number it is: 0 for X_0, 1 for E_0, 2 for Z_0.
    #[must_use]
    pub fn map_each<M>(&self, mut number: impl FnMut(usize, &N) -> M) -> InitialSet<M> {
        let mut optional = |x0: &Option<N>, e0: &Option<N>| {
            (x0.as_ref().map(|size| number(0, size)), e0.as_ref().map(|size| number(1, size)))
        };
        match self {
            InitialSet::Paper => InitialSet::Paper,
            InitialSet::AtRest { x0, e0 } => {
                let (x0, e0) = optional(x0, e0);
                InitialSet::AtRest { x0, e0 }
            }
            InitialSet::Aligned { x0, e0 } => {
                let (x0, e0) = optional(x0, e0);
                InitialSet::Aligned { x0, e0 }
            }
            InitialSet::Box { x0, e0, z0 } => {
                InitialSet::Box { x0: number(0, x0), e0: number(1, e0), z0: number(2, z0) }
            }
        }
    }

    /// A set of this kind with another X_0; the paper's set has none to replace.
    #[must_use]
    pub fn with_x0(self, x0: N) -> InitialSet<N> {
        match self {
            InitialSet::Paper => InitialSet::Paper,
            InitialSet::AtRest { e0, .. } => InitialSet::AtRest { x0: Some(x0), e0 },
            InitialSet::Aligned { e0, .. } => InitialSet::Aligned { x0: Some(x0), e0 },
            InitialSet::Box { e0, z0, .. } => InitialSet::Box { x0, e0, z0 },
        }
    }

    /// X_0 and E_0 of this set, where it has them, with the controller aligned.
    #[must_use]
    pub fn aligned(self) -> InitialSet<N> {
        match self {
            InitialSet::Paper => InitialSet::Aligned { x0: None, e0: None },
            InitialSet::AtRest { x0, e0 } | InitialSet::Aligned { x0, e0 } => InitialSet::Aligned { x0, e0 },
            InitialSet::Box { x0, e0, .. } => InitialSet::Aligned { x0: Some(x0), e0: Some(e0) },
        }
    }

    /// The X_0 and E_0 that the user gives.
    #[must_use]
    pub fn given(&self) -> [Option<&N>; 2] {
        match self {
            InitialSet::Paper => [None, None],
            InitialSet::AtRest { x0, e0 } | InitialSet::Aligned { x0, e0 } => [x0.as_ref(), e0.as_ref()],
            InitialSet::Box { x0, e0, .. } => [Some(x0), Some(e0)],
        }
    }

    /// The name of its kind in files.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            InitialSet::Paper => "paper",
            InitialSet::AtRest { .. } => "at-rest",
            InitialSet::Aligned { .. } => "aligned",
            InitialSet::Box { .. } => "box",
        }
    }

    /// Whether the controller sets z = M e at its first instant.
    #[must_use]
    pub fn is_aligned(&self) -> bool {
        matches!(self, InitialSet::Aligned { .. })
    }

    /// The sizes: X_0 and E_0 as the user gives them, or 2 X_p and 2 E_p; Z_0 of `paper` 2 (Z + Nbar E_p), of `at-rest` 0, of
    /// `box` the user's, of `aligned` none. Given are 2 X_p and 2 E_p, the paper's Z_0, and 0.
    #[must_use]
    pub fn required(&self, [x, e]: [N; 2], z: impl FnOnce() -> N, zero: N) -> StartSizes<N> {
        let [x0, e0] = self.given();
        let z0 = match self {
            InitialSet::Paper => Some(z()),
            InitialSet::AtRest { .. } => Some(zero),
            InitialSet::Aligned { .. } => None,
            InitialSet::Box { z0, .. } => Some(z0.clone()),
        };
        StartSizes { x0: x0.cloned().unwrap_or(x), e0: e0.cloned().unwrap_or(e), z0 }
    }
}

/// The coefficients a_1, ..., a_{r-1} of e = xi_r + sum a_i xi_i: 1 to 3 rational numbers. That the polynomial
/// s^{r-1} + a_{r-1} s^{r-2} + ... + a_1 is Hurwitz is not checked here.
#[derive(Clone, Debug)]
pub struct RelativeDegree {
    /// a_1, ..., a_{r-1}; not empty.
    pub a: Vec<Constant>,
}
