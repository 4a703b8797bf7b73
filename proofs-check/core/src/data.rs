//! The data of a specification, enclosed at one working precision (docs/mathematics.md, section 1).

use crate::bound::Bound;
use crate::input_gain::Gain;
use crate::interval::Interval;
use crate::period::Ends;
use crate::plant::entries::Name;
use crate::spec::Specification;
use rug::Rational;

/// The numbers of derivation, section 1, under their names there.
pub struct Data<'s> {
    pub spec: &'s Specification,
    pub precision: u32,
    pub period: Ends,
    pub p_low: Interval,
    pub p_up: Interval,
    pub alpha: Interval,
    pub mu: Interval,
    pub w: Interval,
    /// c = sqrt(P_up/P_low) >= 1.
    pub c: Interval,
    /// c and alpha of the triple that serves for existence: the second one, if there is one.
    pub existence: [Interval; 2],
    /// nu = mu/w; with a gain b_lo mu/w, for T_N decreases in nu.
    pub nu: Interval,
    /// The gain, where b is not 1.
    pub gain: Option<Gain>,
    pub n_0: Interval,
    pub n_1: Interval,
    pub n_bar: Interval,
}

impl<'s> Data<'s> {
    /// The numbers of the loop with oscillators at these harmonics: the sum of their weights is that of these alone (14.4, 14.7).
    pub fn of_oscillators(spec: &'s Specification, precision: u32, harmonics: &[u32]) -> Data<'s> {
        let d = Data::new(spec, precision);
        let sum = harmonics.iter().fold(d.int(0), |sum, l| sum + d.weight(u64::from(*l)));
        Data { n_bar: sum.sqrt(), ..d }
    }

    /// Encloses everything at `precision` bits.
    pub fn new(spec: &'s Specification, precision: u32) -> Data<'s> {
        let number = |constant: &crate::constant::Constant| constant.enclose(precision);
        let (p_low, p_up, mu, w) = (
            number(&spec.p_low),
            number(&spec.p_up),
            number(&spec.regulator.mu),
            number(&spec.regulator.base_frequency),
        );
        // P_low <= P_up holds, so c >= 1 does whatever the rounding.
        let root = |p_low: &Interval, p_up: &Interval| (p_up / p_low).sqrt().max(&Interval::int(1, precision));
        let (alpha, c) = (number(&spec.alpha), root(&p_low, &p_up));
        let existence = match &spec.existence {
            Some((_, [p_low, p_up, alpha])) => [root(&number(p_low), &number(p_up)), number(alpha)],
            None => [c.clone(), alpha.clone()],
        };
        let (gain, nu) = (Gain::new(spec.input_gain.as_ref(), precision), &mu / &w);
        Data {
            period: spec.period.ends(precision),
            alpha,
            c,
            existence,
            nu: gain.as_ref().map_or_else(|| nu.clone(), |gain| &gain.low * &nu),
            gain,
            n_0: spec.regulator.weights.weight(0, precision),
            n_1: spec.regulator.weights.weight(1, precision),
            n_bar: spec.regulator.weights.total(precision).sqrt(),
            p_low,
            p_up,
            mu,
            w,
            spec,
            precision,
        }
    }

    /// An exact number.
    pub fn number(&self, value: &Rational) -> Interval {
        Interval::rational(value, self.precision)
    }

    /// An integer.
    pub fn int(&self, value: i64) -> Interval {
        Interval::int(value, self.precision)
    }

    /// A fraction.
    pub fn ratio(&self, numerator: i64, denominator: i64) -> Interval {
        self.number(&Rational::from((numerator, denominator)))
    }

    /// n_l.
    pub fn weight(&self, l: u64) -> Interval {
        self.spec.regulator.weights.weight(l, self.precision)
    }

    /// A number times an end of b, where there is a gain.
    pub fn by_gain(&self, end: fn(&Gain) -> &Interval, value: &Interval) -> Interval {
        self.gain.as_ref().map_or_else(|| value.clone(), |gain| end(gain) * value)
    }

    /// b and `(1-b) sigma` at both ends of b, in words; 1 and 0 without a gain.
    pub fn ends(&self, sigma: &Interval) -> Vec<(&'static str, [Interval; 2])> {
        let Some(gain) = &self.gain else { return vec![("", [1, 0].map(|value| self.int(value)))] };
        let [low, high] = gain.shifts(sigma);
        vec![(", at b_lo", [gain.low.clone(), low]), (", at b_hi", [gain.high.clone(), high])]
    }

    /// A bound of e by q or by q', with a gain over b_m.
    pub fn of_error(&self, bound: Interval) -> Interval {
        self.gain.as_ref().map_or_else(|| bound.clone(), |gain| &bound / gain.of_error())
    }

    /// The positive part of a bounding function at (X, E), undefined if it is not given. A root mean square is at most the supremum, so b_q and b_qt serve
    /// for rms bounds that are not given, or are larger.
    pub fn bound(&self, which: Bound, x: &Interval, e: &Interval) -> Interval {
        let own = self.given(which, x, e);
        let supremum = match which {
            Bound::QRms => self.given(Bound::Q, x, e),
            Bound::QtRms => self.given(Bound::Qt, x, e),
            _ => None,
        };
        match (own, supremum) {
            (Some(own), Some(supremum)) => own.min(&supremum),
            (own, supremum) => own.or(supremum).unwrap_or_else(|| Interval::undefined(self.precision)),
        }
    }

    /// The positive part of a bounding function, if it is given.
    pub fn given(&self, which: Bound, x: &Interval, e: &Interval) -> Option<Interval> {
        self.signed(which, x, e).map(|value| value.max(&self.int(0)))
    }

    /// q_e_max at (X, E), if it is given: it may be negative.
    pub fn q_e_max(&self, x: &Interval, e: &Interval) -> Option<Interval> {
        self.signed(Bound::QeMax, x, e)
    }

    fn signed(&self, which: Bound, x: &Interval, e: &Interval) -> Option<Interval> {
        match &self.spec.plant {
            Some(plant) => plant.entries.at(which, x, e, self.precision),
            None => self.spec.bounds[which as usize].as_ref().map(|expr| expr.enclose(x, e)),
        }
    }

    /// The larger of a rate, which need not be defined for a plant, and the one that is given at (X, E), if one is given: of the P
    /// of stability, or of that of existence.
    pub fn better_rate(&self, rate: &Interval, of_existence: bool, x: &Interval, e: &Interval) -> Interval {
        if let Some(plant) = &self.spec.plant {
            let second = of_existence && plant.two_matrices;
            let name = if second { Name::RateExistence } else { Name::Rate };
            let given = plant.entries.rate(name, x, e, self.precision);
            return given.map_or_else(|| rate.clone(), |given| given.greatest(rate));
        }
        self.spec.rate.as_ref().map_or_else(|| rate.clone(), |expr| expr.enclose(x, e).max(rate))
    }
}
