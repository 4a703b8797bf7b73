//! A smaller initial set for which a specification is certified that is not certified as it is.

use super::certification::Certification;
use super::options::{Options, TransferChoice};
use super::pool::Wanted;
use super::produce::{certify, certify_for};
use super::sampled::{SampledCertification, certify_sampled_within};
use rug::Rational;
use sigmastar_decide::conditions::Ladder;
use sigmastar_exact::number::{Direction, round_f64, round_rational};
use sigmastar_lang::spec::Actuator;
use sigmastar_lang::spec::model::{Constant, InitialSet, Specification};
use sigmastar_propose::search::{FloatModel, smaller_set};
use sigmastar_theory::data::Data;
use sigmastar_theory::transfer::TradeOff;

/// The shares, in percent, of a proposed size that are certified in turn until one succeeds: the search that proposes and
/// the one that certifies differ by rounding alone, so the first nearly always does.
const SHARES: [u32; 6] = [100, 98, 95, 90, 75, 50];

/// By what all sizes of a set are divided, in turn, where limits are not kept.
const DIVISORS: [u32; 3] = [2, 8, 64];

/// Digits of the sizes, and of their share of what was asked for.
const DIGITS: u32 = 3;

/// What is known of smaller initial sets.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SmallerChoice {
    /// This one is certified by itself.
    Certified {
        /// The set.
        set: InitialSet<Rational>,
        /// Its certified gain.
        sigma: Rational,
        /// The least share of its sizes in those that were asked for, rounded down, where there are such.
        share: Option<Rational>,
        /// Whether it is the largest that was proposed: the search succeeds at none that is 3 % larger.
        as_proposed: bool,
    },
    /// What the floating-point search proposes, and no certification confirms.
    Proposed(Option<InitialSet<Rational>>),
}

/// The set with all sizes that it states divided, rounded up; `None` where it states none.
fn divided(set: &InitialSet, divisor: u32) -> Option<InitialSet> {
    let mut states = false;
    let set = set.map_each(|_, size| {
        let size = size.to_f64() / f64::from(divisor);
        states |= size > 0.0;
        Constant::rational(&round_f64(size, DIGITS, Direction::Up).unwrap_or_default())
    });
    states.then_some(set)
}

impl SampledCertification<'_> {
    /// [`Certification::divisor_that_keeps`] at samples.
    #[must_use]
    pub fn divisor_that_keeps(&self) -> Option<u32> {
        // Of a smaller set nothing is known by the number of oscillators: neither limits nor an actuator are kept to by that.
        let limits = self.limits.by_conditions();
        DIVISORS.into_iter().find(|divisor| {
            let Some(initial_set) = divided(&self.spec.initial_set, *divisor) else { return false };
            let spec = Specification { initial_set, actuator: by_conditions(self.spec), ..self.spec.clone() };
            let asked = (self.given_gain.as_ref(), &limits);
            let run = certify_sampled_within(&spec, &self.sampling, asked, None, Ladder::default());
            run.is_ok_and(|run| run.claim().is_some())
        })
    }
}

/// The actuator, to be kept to by condition C6.
fn by_conditions(spec: &Specification) -> Option<Actuator> {
    spec.actuator.clone().map(|actuator| Actuator { by_count: false, ..actuator })
}

impl Certification<'_> {
    /// The first of a few numbers by which all sizes of the initial set can be divided for the limits to be kept that are not kept from the set
    /// itself; `None` where none of them does, and where the set states no sizes. Bounds of a plant hold for its smaller sets, too.
    ///
    /// Guarantee: with it a claim that keeps to the limits is proved.
    #[must_use]
    pub fn divisor_that_keeps(&self) -> Option<u32> {
        // Of a smaller set nothing is known by the number of oscillators: neither limits nor an actuator are kept to by that.
        let limits = self.limits.by_conditions();
        DIVISORS.into_iter().find(|divisor| {
            let Some(initial_set) = divided(&self.spec.initial_set, *divisor) else { return false };
            let spec = Specification { initial_set, actuator: by_conditions(self.spec), ..self.spec.clone() };
            let wanted = Wanted { gain: self.given_gain.as_ref(), limits: Some(&limits), start: None };
            let run = certify_for(&spec, Options { compare: false, ..self.options }, wanted);
            run.is_ok_and(|run| run.claim().is_some())
        })
    }

    /// The largest smaller initial set that is certified: a size is proposed in floating point, to about 1 %, and certified
    /// as `certify` of a file with that set does it.
    ///
    /// Guarantee: a set that is called certified is.
    #[must_use]
    pub fn smaller_set(&self) -> SmallerChoice {
        let proposed = self.proposed_smaller_set();
        let certified = proposed.as_ref().and_then(|proposed| {
            SHARES.into_iter().find_map(|share| {
                let part = Rational::from((share, 100));
                let set = proposed.map(|size| round_rational(&Rational::from(size * &part), DIGITS, Direction::Down));
                let sigma = self.with_set(set.map(Constant::rational))?;
                let as_proposed = share == 100 && self.spec.initial_set.is_aligned();
                Some(SmallerChoice::Certified { share: self.share(&set), set, sigma, as_proposed })
            })
        });
        certified.unwrap_or(SmallerChoice::Proposed(proposed))
    }

    /// Which smaller initial set would do, in floating point.
    fn proposed_smaller_set(&self) -> Option<InitialSet<Rational>> {
        // The working precision of what only proposes.
        let data = Data::new(self.spec, 64);
        let matched = self.options.transfer == TransferChoice::Best && self.spec.internal_model.matched;
        let trade_off = if matched { TradeOff::matched(&data) } else { TradeOff::closed_form(&data) };
        smaller_set(&FloatModel::new(&data, trade_off))
    }

    /// The certified gain of the specification with another initial set.
    fn with_set(&self, initial_set: InitialSet) -> Option<Rational> {
        // The bounds of a plant are proved at the arguments of its own set.
        if self.spec.plant().is_some() {
            return None;
        }
        let spec = Specification { initial_set, ..self.spec.clone() };
        let run = certify(&spec, Options { compare: false, ..self.options }).ok()?;
        run.sigma_star().cloned()
    }

    /// The least share of the sizes that were asked for, where one of them is smaller.
    fn share(&self, set: &InitialSet<Rational>) -> Option<Rational> {
        let pairs = self.spec.initial_set.given().into_iter().zip(set.given());
        let pairs = pairs.filter_map(|(asked, size)| Some((asked?, size?))).filter(|(_, size)| **size > 0);
        let share = pairs.map(|(asked, size)| Some(Rational::from(size / asked.as_rational()?)));
        let least = share.collect::<Option<Vec<Rational>>>()?.into_iter().min()?;
        (least < 1).then(|| round_rational(&least, DIGITS, Direction::Down))
    }
}
