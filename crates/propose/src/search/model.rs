//! The specification in floating point, for searches only.

use super::at_samples::AtSamples;
use super::by_energy::ByEnergy;
use super::effort::Effort;
use super::float_bound::FloatBound;
use super::goal::Goal;
use super::obstacle::{Extreme, Failing, Obstacle};
use super::threshold::ByMatrix;
use sigmastar_lang::spec::model::{InitialSet, SIZES, StartSizes};
use sigmastar_theory::data::{Bound, Data, ExistenceTriple, Numbers, Problem};
use sigmastar_theory::derivation::initial_set::paper_z0;
use sigmastar_theory::input_gain::InputGain;
use sigmastar_theory::transfer::TradeOff;
use std::ops::Deref;
use std::sync::Arc;

/// How far inside of the domain an error box stays, so that rounding does not lead beyond.
const INSIDE: f64 = 1.0 - 1e-7;

/// A datum of the specification whose influence on sigma* is reported.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Datum {
    /// alpha (a larger value helps).
    Alpha,
    /// The ratio P_up/P_low, through P_up.
    PUp,
    /// One of the bounding functions.
    Bound(Bound),
    /// The bounds of the harmonics of q(t,0,0) and of the rest, all of them.
    Harmonics,
    /// A size of the initial set that is asked for: X0 (or the ball), E0, Z0.
    Size(usize),
    /// The largest X and E at which the data hold (larger values help).
    Domain,
    /// mu, which may be too large or too small.
    Mu {
        /// Whether a larger one helps.
        larger: bool,
    },
}

impl Datum {
    /// Every datum of which [`FloatModel::improved`] knows the better value.
    pub const ALL: [Datum; 22] = [
        Datum::Alpha,
        Datum::PUp,
        Datum::Bound(Bound::F),
        Datum::Bound(Bound::Fe),
        Datum::Bound(Bound::Fxx),
        Datum::Bound(Bound::Fex),
        Datum::Bound(Bound::Qe),
        Datum::Bound(Bound::Qx),
        Datum::Bound(Bound::QRms),
        Datum::Bound(Bound::QtRms),
        Datum::Bound(Bound::Q),
        Datum::Bound(Bound::QeMax),
        Datum::Bound(Bound::Rate),
        Datum::Bound(Bound::Qt),
        Datum::Bound(Bound::Fx),
        Datum::Bound(Bound::Qtx),
        Datum::Bound(Bound::Qte),
        Datum::Harmonics,
        Datum::Size(0),
        Datum::Size(1),
        Datum::Size(2),
        Datum::Domain,
    ];

    /// Its name in a specification.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Datum::Alpha => "alpha".to_owned(),
            Datum::PUp => "p_up".to_owned(),
            Datum::Bound(bound) => match bound.replacement() {
                Some(other) if !bound.is_signed() => format!("{} (or {})", bound.field(), other.field()),
                _ => bound.field().to_owned(),
            },
            Datum::Harmonics => "q_0".to_owned(),
            Datum::Size(index) => SIZES.get(index).copied().unwrap_or_default().to_owned(),
            Datum::Domain => "domain".to_owned(),
            Datum::Mu { larger } => format!("mu ({})", if larger { "larger" } else { "smaller" }),
        }
    }
}

/// A bounding function.
#[derive(Clone)]
struct ScaledBound {
    /// It, or its replacement.
    function: Option<FloatBound>,
    /// A relative change, for sensitivities.
    change: f64,
    /// Whether it has an expression of its own.
    given: bool,
    /// Whether negative values count.
    signed: bool,
    /// A bound that serves where it is smaller.
    supremum: Option<Bound>,
}

/// All data in floating point.
#[derive(Clone)]
pub struct FloatModel {
    numbers: Numbers<f64>,
    /// The largest X and E allowed, infinite without a domain.
    pub domain: (f64, f64),
    /// The initial set.
    pub set: InitialSet<f64>,
    /// The admissible pairs (k0, k1).
    pub trade_off: TradeOff,
    /// In the order of [`Bound::ALL`].
    bounds: Vec<ScaledBound>,
    /// Whether what is found with it is only compared.
    rough: bool,
    /// The room between both sides of S1 and S2, where it is not that of the effort.
    room: Option<f64>,
    /// What the shape of an error box is chosen for.
    pub goal: Goal,
    /// What stands in the place of C5, if anything.
    pub by_matrix: Option<ByMatrix>,
    /// What bounds the periodic solution beside the gains of loops, if anything.
    pub by_energy: Option<ByEnergy>,
    /// Where the matrix inequalities of stability and of existence of the law at samples come from, where norms do not serve.
    pub at_samples: AtSamples,
}

impl Deref for FloatModel {
    type Target = Numbers<f64>;

    fn deref(&self) -> &Numbers<f64> {
        &self.numbers
    }
}

impl Problem<f64> for FloatModel {
    fn numbers(&self) -> &Numbers<f64> {
        &self.numbers
    }

    /// Of a norm the positive part of the expression; NaN where it is undefined.
    fn bound(&self, which: Bound, x: &f64, e: &f64) -> f64 {
        // There is one for each.
        let bound = &self.bounds[which as usize];
        let Some(function) = &bound.function else { return f64::NAN };
        let value = function.at(*x, *e);
        let value = value + bound.change * value.abs();
        let value = if value < 0.0 && !bound.signed { 0.0 } else { value };
        match bound.supremum.map(|supremum| self.bound(supremum, x, e)) {
            Some(supremum) if supremum < value => supremum,
            _ => value,
        }
    }

    fn given(&self, which: Bound) -> bool {
        self.bounds[which as usize].given
    }

    fn zero(&self) -> f64 {
        0.0
    }
}

impl FloatModel {
    /// Converts the data; `trade_off` says which pairs (k0, k1) may be proposed.
    #[must_use]
    pub fn new(data: &Data<'_>, trade_off: TradeOff) -> FloatModel {
        let float = |constant: &sigmastar_lang::spec::model::Constant| constant.to_f64();
        let spec = data.spec;
        FloatModel {
            numbers: data.numbers.midpoints(),
            domain: spec
                .domain
                .as_ref()
                .map_or((f64::INFINITY, f64::INFINITY), |domain| (float(&domain.x), float(&domain.e))),
            set: spec.initial_set.map(float),
            trade_off,
            bounds: Bound::ALL
                .iter()
                .map(|which| ScaledBound {
                    function: FloatBound::of(spec, *which),
                    change: 0.0,
                    given: spec.bounds.is_given(*which),
                    signed: which.is_signed() && spec.bounds.is_given(*which),
                    supremum: which.supremum(spec),
                })
                .collect(),
            rough: false,
            room: None,
            goal: Goal::default(),
            by_matrix: {
                let values = spec.bounds.proved_values();
                let joint = values.joint_stability.as_ref().map(|joint| ByMatrix::Joint(Arc::new(joint.clone())));
                joint.or_else(|| values.inequality.as_ref().map(|known| ByMatrix::Proved(Arc::new(known.clone()))))
            },
            by_energy: {
                let values = spec.bounds.proved_values();
                let joint = values.joint_existence.as_ref().map(|joint| ByEnergy::Joint(Arc::new(joint.clone())));
                joint.or_else(|| values.existence.as_ref().map(|known| ByEnergy::Proved(Arc::new(known.clone()))))
            },
            at_samples: AtSamples::from(&spec.bounds.proved_values().at_samples),
        }
    }

    /// The model with these bounding functions in the place of its own: those that are listed, and no others.
    #[must_use]
    pub fn with_bounds(&self, functions: Vec<(Bound, FloatBound)>) -> FloatModel {
        let mut bounds: Vec<ScaledBound> = Bound::ALL
            .iter()
            .map(|_| ScaledBound { function: None, change: 0.0, given: false, signed: false, supremum: None })
            .collect();
        for (which, function) in functions {
            let function = Some(function);
            bounds[which as usize] =
                ScaledBound { function, change: 0.0, given: true, signed: which.is_signed(), supremum: None };
        }
        FloatModel { bounds, ..self.clone() }
    }

    /// The model with these inequalities over the derivatives in the place of its own.
    #[must_use]
    pub fn with_inequalities(&self, by_matrix: Option<ByMatrix>, by_energy: Option<ByEnergy>) -> FloatModel {
        FloatModel { by_matrix, by_energy, ..self.clone() }
    }

    fn functions(&self) -> impl Iterator<Item = &FloatBound> {
        self.bounds.iter().filter_map(|bound| bound.function.as_ref())
    }

    /// Whether dq/de has a bound from above of its own.
    #[must_use]
    pub fn has_one_sided(&self) -> bool {
        self.given(Bound::QeMax)
    }

    /// b_qe(0, 0).
    #[must_use]
    pub fn slope_at_origin(&self) -> f64 {
        self.bound(Bound::Qe, &0.0, &0.0)
    }

    /// How thoroughly this model is searched.
    #[must_use]
    pub fn effort(&self) -> Effort {
        let effort = Effort::new(self.functions().map(FloatBound::operations).sum());
        let effort = if self.rough { effort.rough() } else { effort };
        Effort { room: self.room.unwrap_or(effort.room), ..effort }
    }

    /// The model for a search that leaves so much room between both sides of S1 and S2, relatively.
    #[must_use]
    pub fn with_room(self, room: f64) -> FloatModel {
        FloatModel { room: Some(room), ..self }
    }

    /// dZ as C4 has it beside h: with an input gain times sqrt(b_hi), for the weight there is b_hi h.
    #[must_use]
    pub fn weighed(&self, dist_z: f64) -> f64 {
        self.input_gain.as_ref().map_or(dist_z, |gain| dist_z * gain.high.sqrt())
    }

    /// That an error box lies in the domain.
    ///
    /// # Errors
    /// The side on which it reaches out.
    pub fn contains(&self, [x, e]: [f64; 2]) -> Result<(), Obstacle> {
        if x > self.domain.0 * INSIDE {
            return Err(Failing::DomainX.at(x, e));
        }
        if e > self.domain.1 * INSIDE {
            return Err(Failing::DomainE.at(x, e));
        }
        Ok(())
    }

    /// That every number, and every bounding function at X = E = 0, is one that doubles can work with.
    ///
    /// # Errors
    /// The first that is not; and an input gain that no sigma serves.
    pub fn in_range(&self) -> Result<(), Obstacle> {
        // Both ends have an h/mu with (1 + ht (1-b) sigma)^2 < 4 ht sigma, and share one only then.
        if let Some(InputGain { low, high }) = &self.input_gain
            && high.sqrt() >= 2.0 + low.sqrt()
        {
            return Err(Failing::InputGain { low: *low, high: *high }.into());
        }
        let numbers = [
            ("the period", self.period),
            ("p_low", self.p_low),
            ("p_up", self.p_up),
            ("alpha", self.alpha),
            ("mu", self.mu),
            ("base_frequency", self.base_frequency),
            ("Nbar (of the weights)", self.n_bar),
        ];
        let set = self.set.required([0.0; 2], || 0.0, 0.0);
        let extreme = numbers.into_iter().find(|(_, value)| !value.is_normal());
        let extreme =
            extreme.or_else(|| set.named().map(|(name, size)| (name, *size)).find(|(_, size)| !size.is_finite()));
        let bound = || {
            let infinite = |which: &Bound| {
                let function = self.bounds[*which as usize].function.as_ref();
                function.is_some_and(|function| function.at(0.0, 0.0) == f64::INFINITY)
            };
            Bound::ALL.into_iter().find(infinite).map(Extreme::Bound)
        };
        let extreme = extreme.map(|(name, value)| Extreme::Number(name, value)).or_else(bound);
        extreme.map_or(Ok(()), |extreme| Err(Failing::Magnitude(extreme).into()))
    }

    /// That a number which is made of the bounding functions at (X, E) is not finite: with the first of them that is not, and is at
    /// X = E = 0, where there is one; of a plant perhaps because nothing is known of it there.
    #[must_use]
    pub(super) fn not_finite(&self, x: f64, e: f64) -> Obstacle {
        let ends = |which: &Bound| {
            self.bounds[*which as usize].function.is_some()
                && self.bound(*which, &0.0, &0.0).is_finite()
                && !self.bound(*which, &x, &e).is_finite()
        };
        let Some(bound) = Bound::ALL.into_iter().find(ends) else { return Failing::NotFinite(None).at(x, e) };
        let known = self.bounds[bound as usize].function.as_ref().and_then(|function| function.ends_before(x, e));
        known.map_or(Failing::NotFinite(Some(bound)), |known| Failing::Beyond { known, bound }).at(x, e)
    }

    /// The model with one datum improved by the relative amount `by` (alpha, a rate and the domain up, everything else
    /// down). The better value of mu is not known: it is left as it is.
    #[must_use]
    pub fn improved(&self, datum: Datum, by: f64) -> FloatModel {
        let mut model = self.clone();
        match datum {
            Datum::Alpha => {
                model.numbers.alpha *= 1.0 + by;
                model.numbers.existence.alpha *= 1.0 + by;
            }
            Datum::PUp => {
                model.numbers.p_up = (model.p_up * (1.0 - by)).max(model.p_low);
                model.numbers.c = (model.p_up / model.p_low).sqrt();
                model.numbers.existence.c = (self.existence.c * (model.c / self.c)).max(1.0);
            }
            Datum::Bound(which) => {
                // Where it serves in the place of a bound of a derivative from above, that falls too.
                let serves =
                    |bound: Bound| bound.is_signed() && bound.replacement() == Some(which) && !self.given(bound);
                for (bound, kind) in model.bounds.iter_mut().zip(Bound::ALL) {
                    if kind == which || serves(kind) {
                        bound.change = if which.is_rate() { by } else { -by };
                    }
                }
            }
            Datum::Harmonics => {
                if let Some(known) = &mut model.numbers.q_0 {
                    let sizes = known.harmonics.iter_mut().chain([&mut known.rest_rms]).chain(&mut known.rest_t_rms);
                    sizes.for_each(|size| *size *= 1.0 - by);
                }
            }
            Datum::Size(index) => {
                model.set = model.set.map_each(|place, size| if place == index { size * (1.0 - by) } else { *size });
            }
            Datum::Domain => {
                let (x, e) = model.domain;
                model.domain = (x * (1.0 + by), e * (1.0 + by));
            }
            Datum::Mu { .. } => {}
        }
        model
    }

    /// The data that the specification has, of [`Datum::ALL`]; of a plant's formulas what stands in its file: not the
    /// bounds, which follow from them.
    pub fn data(&self, of_plant: bool) -> impl Iterator<Item = Datum> {
        let mut sizes = [None; 3];
        let _ = self.set.map_each(|place, size| sizes[place] = Some(*size));
        Datum::ALL.into_iter().filter(move |datum| match datum {
            Datum::Size(index) => sizes.get(*index).is_some_and(|size| size.is_some_and(|size| size > 0.0)),
            // Beyond the domain of a plant nothing is proved of it yet.
            _ if of_plant => false,
            // Where one is left out, what serves in its place is spoken of under its name.
            Datum::Bound(bound) => self.given(*bound) || (!bound.is_signed() && bound.replacement().is_some()),
            Datum::Alpha | Datum::PUp => true,
            Datum::Harmonics => self.q_0.is_some(),
            Datum::Domain => self.domain.0.is_finite(),
            Datum::Mu { .. } => false,
        })
    }

    /// What is given beyond the data that every specification has.
    #[must_use]
    pub fn optional_data(&self) -> Vec<OptionalDatum> {
        // The rate of existence belongs to its triple.
        let optional = |bound: &Bound| !bound.is_required() && *bound != Bound::RateExistence && self.given(*bound);
        let bounds = Bound::ALL.into_iter().filter(optional);
        let harmonics = self.q_0.is_some().then_some(OptionalDatum::Harmonics);
        bounds.map(OptionalDatum::Bound).chain(harmonics).collect()
    }

    /// The model without one optional datum. The bound that replaces an absent one serves in its place.
    #[must_use]
    pub fn without(&self, datum: OptionalDatum) -> FloatModel {
        let mut model = self.clone();
        match datum {
            OptionalDatum::Harmonics => model.numbers.q_0 = None,
            OptionalDatum::Bound(which) => {
                let serves = which.replacement().map(|other| self.bounds[other as usize].clone());
                let absent = ScaledBound { function: None, change: 0.0, given: false, signed: false, supremum: None };
                model.bounds[which as usize] = ScaledBound { given: false, ..serves.unwrap_or(absent) };
            }
        }
        model
    }

    /// The model with another Lyapunov triple, for existence too: p_low = 1, p_up = `ratio` and `alpha`.
    #[must_use]
    pub fn with_triple(&self, ratio: f64, alpha: f64) -> FloatModel {
        let mut model = self.clone();
        let c = ratio.sqrt();
        let existence = ExistenceTriple { c, alpha, separate: false };
        model.numbers = Numbers { p_low: 1.0, p_up: ratio, c, alpha, existence, ..model.numbers };
        model
    }

    /// The model with another triple for the existence of the periodic solution alone: p_up/p_low = `ratio`, and `alpha`.
    #[must_use]
    pub fn with_existence_triple(&self, ratio: f64, alpha: f64) -> FloatModel {
        let mut model = self.clone();
        model.numbers.existence = ExistenceTriple { c: ratio.sqrt(), alpha, separate: true };
        model
    }

    /// The model with these admissible pairs (k0, k1).
    #[must_use]
    pub fn with_trade_off(&self, trade_off: TradeOff) -> FloatModel {
        FloatModel { trade_off, ..self.clone() }
    }

    /// The model for results that are only compared, to six digits.
    #[must_use]
    pub fn rough(self) -> FloatModel {
        FloatModel { rough: true, ..self }
    }

    /// The model whose error boxes are chosen for this goal.
    #[must_use]
    pub fn with_goal(&self, goal: Goal) -> FloatModel {
        FloatModel { goal, ..self.clone() }
    }

    /// The model with this initial set.
    #[must_use]
    pub fn with_set(&self, set: InitialSet<f64>) -> FloatModel {
        FloatModel { set, ..self.clone() }
    }

    /// The sizes that are asked for, with given X_p, E_p, Z.
    #[must_use]
    pub fn required_set(&self, x_p: f64, e_p: f64, z: f64) -> StartSizes<f64> {
        self.set.required([2.0 * x_p, 2.0 * e_p], || paper_z0(self, &e_p, &z), 0.0)
    }
}

/// What a specification may give beyond the data that every one has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OptionalDatum {
    /// A bounding function.
    Bound(Bound),
    /// The harmonics of q(t,0,0).
    Harmonics,
}

impl OptionalDatum {
    /// The name of its field in a specification.
    #[must_use]
    pub fn field(self) -> &'static str {
        match self {
            OptionalDatum::Bound(bound) => bound.field(),
            OptionalDatum::Harmonics => "q_0",
        }
    }
}

#[cfg(test)]
mod tests {
    use sigmastar_exact::number::Portable;
    use sigmastar_theory::derivation::gains::{beta_s, beta_s_inverse};

    /// The gain and its inverse over the range of scales that specifications have.
    #[test]
    fn the_gain_is_inverted() {
        for period in [1e-40_f64, 1e-30, 1e-3, 1.0, 70.0, 1e30] {
            for exponent in -120..=120 {
                let sigma = 10f64.portable_pow(f64::from(exponent) / 4.0) / period;
                let found = beta_s_inverse(&beta_s(&sigma, &period), &period);
                assert!((found / sigma - 1.0).abs() < 1e-12, "T = {period}, sigma = {sigma}: {found}");
            }
        }
    }
}
