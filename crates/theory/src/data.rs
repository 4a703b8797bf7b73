//! The data of a specification, enclosed at one working precision.

use crate::input_gain::InputGain;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::real::{Operand, Real};
pub use sigmastar_lang::spec::Bound;
use sigmastar_lang::spec::model::{Constant, Lyapunov, Specification};
use std::ops::Deref;

/// The numbers of a specification, and the quantities that follow from them alone, over one kind of [`Real`].
///
/// Units: `period` is a time; `alpha`, `mu`, `base_frequency` are 1/time; `p_low`, `p_up` are |x|^-2 times anything;
/// the weights are pure numbers.
#[derive(Clone, Debug)]
pub struct Numbers<R> {
    /// The period T; where an interval of it is known the longest one, T_hi, for every bound in which it stands
    /// grows with T (derivation, 13.3; K_alpha does not, and `repaired` is not evaluated then).
    pub period: R,
    /// P_low.
    pub p_low: R,
    /// P_up.
    pub p_up: R,
    /// alpha.
    pub alpha: R,
    /// mu.
    pub mu: R,
    /// The base frequency w.
    pub base_frequency: R,
    /// c = sqrt(P_up / P_low) >= 1.
    pub c: R,
    /// nu = mu / w; with an input gain that of the smallest one, b_lo mu/w: T_N decreases in nu.
    pub nu: R,
    /// n_0.
    pub n_0: R,
    /// n_1.
    pub n_1: R,
    /// Nbar^2, the sum of all weights.
    pub n_bar_squared: R,
    /// Nbar.
    pub n_bar: R,
    /// Om = 2 pi/T at the longest period: the least one.
    pub fundamental: R,
    /// The largest Om: what multiplies sizes of harmonics, or stands inside a transfer bound.
    pub fastest: R,
    /// c and alpha of the P that serves for the existence of the periodic solution.
    pub existence: ExistenceTriple<R>,
    /// What is known of q(t,0,0), if anything.
    pub q_0: Option<KnownForcing<R>>,
    /// Whether w = Om, proved.
    pub matched: bool,
    /// The interval of the input gain; none where it is 1 (derivation, 13.1).
    pub input_gain: Option<InputGain<R>>,
}

/// c = sqrt(P_up/P_low) and alpha of a P(t) for the zero dynamics.
#[derive(Clone, Debug)]
pub struct ExistenceTriple<R> {
    /// c >= 1.
    pub c: R,
    /// alpha.
    pub alpha: R,
    /// Whether the P is another one than that of stability. A rate is one in a certain P: that of stability then is none here.
    pub separate: bool,
}

impl ExistenceTriple<Enclosure> {
    /// Those of a triple; undefined without one.
    fn new(triple: Option<&Lyapunov>, separate: bool, precision: u32) -> ExistenceTriple<Enclosure> {
        let Some(Lyapunov { p_low, p_up, alpha }) = triple else {
            let undefined = Enclosure::undefined(precision);
            return ExistenceTriple { c: undefined.clone(), alpha: undefined, separate };
        };
        // p_low <= p_up was proved when the triple was read or found, so the ratio is at least 1.
        let at_least_one = Enclosure::entire(precision).max(&Enclosure::one(precision));
        let ratio = p_up.enclose(precision) / p_low.enclose(precision);
        ExistenceTriple { c: ratio.sqrt().intersect(&at_least_one), alpha: alpha.enclose(precision), separate }
    }
}

/// `q(t,0,0) = sum_{|k| <= K} c_k e^{i k Om t} + rest` (derivation, 10.1).
#[derive(Clone, Debug)]
pub struct KnownForcing<R> {
    /// Bounds of |c_0|, ..., |c_K|.
    pub harmonics: Vec<R>,
    /// The weights n_0, ..., n_K.
    pub weights: Vec<R>,
    /// A bound of rms(rest).
    pub rest_rms: R,
    /// A bound of rms(rest').
    pub rest_t_rms: Option<R>,
}

impl<R: Real> Numbers<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// T_N(0) = 1/(nu^2 n_0), the same for every number of oscillators N (derivation, section 2).
    #[must_use]
    pub fn transfer_at_zero(&self) -> R {
        R::int(1) / (self.nu.sqr() * &self.n_0)
    }

    /// kappa_0 = k0/w^2 and kappa_1 = k1/w^4: a transfer bound in the units of omega.
    #[must_use]
    pub fn kappas(&self, k0: &R, k1: &R) -> [R; 2] {
        let w_squared = self.base_frequency.sqr();
        [k0 / &w_squared, k1 / w_squared.sqr()]
    }
}

impl Numbers<Enclosure> {
    /// The middles of the enclosures: what a search in doubles starts from.
    #[must_use]
    pub fn midpoints(&self) -> Numbers<f64> {
        let all = |values: &[Enclosure]| values.iter().map(Enclosure::midpoint_f64).collect();
        let ExistenceTriple { c, alpha, separate } = &self.existence;
        Numbers {
            period: self.period.midpoint_f64(),
            p_low: self.p_low.midpoint_f64(),
            p_up: self.p_up.midpoint_f64(),
            alpha: self.alpha.midpoint_f64(),
            mu: self.mu.midpoint_f64(),
            base_frequency: self.base_frequency.midpoint_f64(),
            c: self.c.midpoint_f64(),
            nu: self.nu.midpoint_f64(),
            n_0: self.n_0.midpoint_f64(),
            n_1: self.n_1.midpoint_f64(),
            n_bar_squared: self.n_bar_squared.midpoint_f64(),
            n_bar: self.n_bar.midpoint_f64(),
            fundamental: self.fundamental.midpoint_f64(),
            fastest: self.fastest.midpoint_f64(),
            existence: ExistenceTriple { c: c.midpoint_f64(), alpha: alpha.midpoint_f64(), separate: *separate },
            q_0: self.q_0.as_ref().map(|known| KnownForcing {
                harmonics: all(&known.harmonics),
                weights: all(&known.weights),
                rest_rms: known.rest_rms.midpoint_f64(),
                rest_t_rms: known.rest_t_rms.as_ref().map(Enclosure::midpoint_f64),
            }),
            matched: self.matched,
            input_gain: self.input_gain.as_ref().map(InputGain::midpoints),
        }
    }
}

/// What the formulas of a derivation are evaluated for: the numbers of a specification, and its bounding functions.
pub trait Problem<R: Real> {
    /// The numbers.
    fn numbers(&self) -> &Numbers<R>;
    /// The value of a bounding function, or of its replacement, at (X, E); unknown where there is neither.
    fn bound(&self, which: Bound, x: &R, e: &R) -> R;
    /// Whether a bounding function itself is given.
    fn given(&self, which: Bound) -> bool;
    /// Exactly 0, at the precision of the numbers: an argument of bounding functions, which are evaluated at the precision of
    /// their arguments.
    fn zero(&self) -> R;
}

/// A specification, enclosed at one working precision.
#[derive(Clone, Debug)]
pub struct Data<'s> {
    /// The specification itself.
    pub spec: &'s Specification,
    /// The working precision in bits.
    pub precision: u32,
    /// Its numbers.
    pub numbers: Numbers<Enclosure>,
}

impl Deref for Data<'_> {
    type Target = Numbers<Enclosure>;

    fn deref(&self) -> &Numbers<Enclosure> {
        &self.numbers
    }
}

impl<'s> Data<'s> {
    /// Encloses the numbers of a specification at the given precision.
    #[must_use]
    pub fn new(spec: &'s Specification, precision: u32) -> Data<'s> {
        let model = &spec.internal_model;
        // Without a proved triple these are undefined, and nothing that needs them can be decided.
        let triple = spec.lyapunov.triple();
        let number = |part: fn(&Lyapunov) -> &Constant| {
            triple.map_or_else(|| Enclosure::undefined(precision), |triple| part(triple).enclose(precision))
        };
        let ExistenceTriple { c, .. } = ExistenceTriple::new(triple, false, precision);
        let p_low = number(|triple| &triple.p_low);
        let p_up = number(|triple| &triple.p_up);
        let mu = model.mu.enclose(precision);
        let base_frequency = model.base_frequency.enclose(precision);
        let n_bar_squared = model.weights.total(precision);
        let existence = {
            let separate = spec.lyapunov.has_second_triple();
            ExistenceTriple::new(spec.lyapunov.existence_triple(), separate, precision)
        };
        // The one place that says which end of the period a formula takes.
        let [shortest, period] = [spec.period.shortest(), spec.period.longest()].map(|end| end.enclose(precision));
        let alpha = number(|triple| &triple.alpha);
        let known = spec.q_0.as_ref().map(|known| KnownForcing {
            harmonics: known.harmonics.iter().map(|bound| bound.enclose(precision)).collect(),
            weights: (0..known.harmonics.len() as u64).map(|l| model.weights.weight(l, precision)).collect(),
            rest_rms: known.rest_rms.enclose(precision),
            rest_t_rms: known.rest_t_rms.as_ref().map(|bound| bound.enclose(precision)),
        });
        let factors = spec.input_gain.as_ref().and_then(|gain| gain.factors(precision));
        let input_gain = factors.map(|[low, high]| InputGain { low, high });
        let nu = &mu / &base_frequency;
        let numbers = Numbers {
            fundamental: 2 * Enclosure::pi(precision) / &period,
            fastest: 2 * Enclosure::pi(precision) / shortest,
            existence,
            q_0: known,
            matched: model.matched,
            period,
            alpha,
            c,
            nu: input_gain.as_ref().map_or_else(|| nu.clone(), |gain| &gain.low * &nu),
            input_gain,
            n_0: model.weights.weight(0, precision),
            n_1: model.weights.weight(1, precision),
            n_bar: n_bar_squared.sqrt(),
            n_bar_squared,
            p_low,
            p_up,
            mu,
            base_frequency,
        };
        Data { spec, precision, numbers }
    }

    /// An exact number at the working precision.
    #[must_use]
    pub fn rational(&self, value: &rug::Rational) -> Enclosure {
        Enclosure::from_rational(value, self.precision)
    }

    /// With the square of the Nbar of given oscillators in the place of that of all of them.
    #[must_use]
    pub fn with_oscillators(&self, n_bar_squared: &Enclosure) -> Data<'s> {
        let numbers =
            Numbers { n_bar: n_bar_squared.sqrt(), n_bar_squared: n_bar_squared.clone(), ..self.numbers.clone() };
        Data { numbers, ..self.clone() }
    }

    /// Exactly 0.
    #[must_use]
    pub fn zero(&self) -> Enclosure {
        Enclosure::zero(self.precision)
    }
}

impl Problem<Enclosure> for Data<'_> {
    fn numbers(&self) -> &Numbers<Enclosure> {
        &self.numbers
    }

    /// Of what bounds a norm the positive part: it does so without its negative values. It matters where a value is 0 and
    /// rounding does not show it.
    ///
    /// Guarantee: contains the value for all X, E in the enclosures. It bounds the plant's function only where
    /// (X, E) lies in the domain of the specification and the bounding function was proved nondecreasing.
    fn bound(&self, which: Bound, x: &Enclosure, e: &Enclosure) -> Enclosure {
        // Without states nothing acts on x: what is not asked for of such a plant is 0.
        let stateless = self.spec.plant().is_some_and(|plant| plant.states() == 0);
        if stateless && matches!(which, Bound::F | Bound::Fxx | Bound::Fex) {
            return self.zero();
        }
        let value = |which: Bound| {
            let value = self.spec.bounds.at(which, x, e);
            if self.given(which) && which.is_signed() { value } else { value.max(&self.zero()) }
        };
        // The sharper one is at most the other one, should the data say otherwise.
        which.supremum(self.spec).map_or_else(|| value(which), |supremum| value(which).min_known(&value(supremum)))
    }

    fn given(&self, which: Bound) -> bool {
        self.spec.bounds.is_given(which)
    }

    fn zero(&self) -> Enclosure {
        Data::zero(self)
    }
}
