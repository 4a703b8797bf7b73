//! A smaller initial set for which a specification is certified that is not certified as it is.

use super::certification::Certification;
use super::options::{Options, TransferChoice};
use super::produce::certify;
use crate::search::{FloatModel, SmallerSet, smaller_set};
use rug::Rational;
use sigmastar_exact::number::{Direction, round_rational};
use sigmastar_lang::spec::model::{Constant, InitialSet, Specification};
use sigmastar_theory::data::Data;
use sigmastar_theory::transfer::TradeOff;

/// The shares, in percent, of a proposed size that are certified in turn until one succeeds: the search that proposes and
/// the one that certifies differ by rounding alone, so the first nearly always does.
const SHARES: [u32; 6] = [100, 98, 95, 90, 75, 50];

/// Digits of the sizes, and of their share of what was asked for.
const DIGITS: u32 = 3;

/// What is known of smaller initial sets.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SmallerChoice {
    /// This one is certified by itself.
    Certified {
        /// The set.
        set: SmallerSet,
        /// Its certified gain.
        sigma: Rational,
        /// The share of the box that was asked for, rounded down, where one was.
        share: Option<Rational>,
        /// Whether it is the very size that was proposed: the search succeeds at none that is 3 % larger.
        as_proposed: bool,
    },
    /// What the floating-point search proposes, and no certification confirms.
    Proposed(SmallerSet),
}

impl Certification<'_> {
    /// The largest smaller initial set that is certified: a size is proposed in floating point, to about 1 %, and certified
    /// as `certify` of a file with that set does it.
    ///
    /// Guarantee: a set that is called certified is.
    #[must_use]
    pub fn smaller_set(&self) -> SmallerChoice {
        let proposed = self.proposed_smaller_set();
        let certified = match &proposed {
            SmallerSet::None => None,
            SmallerSet::AtRest => self.with_set(InitialSet::AtRest { x0: None, e0: None }).map(|sigma| {
                SmallerChoice::Certified { set: SmallerSet::AtRest, sigma, share: None, as_proposed: true }
            }),
            SmallerSet::Box(sizes) => SHARES.into_iter().find_map(|share| {
                let part =
                    |size: &Rational| round_rational(&(size * Rational::from((share, 100))), DIGITS, Direction::Down);
                let sizes = sizes.each_ref().map(part);
                let [x0, e0, z0] = sizes.each_ref().map(Constant::rational);
                let sigma = self.with_set(InitialSet::Box { x0, e0, z0 })?;
                let (part_of_asked, as_proposed) = (self.share(&sizes), share == 100);
                Some(SmallerChoice::Certified { set: SmallerSet::Box(sizes), sigma, share: part_of_asked, as_proposed })
            }),
        };
        certified.unwrap_or(SmallerChoice::Proposed(proposed))
    }

    /// Which smaller initial set would do, in floating point.
    fn proposed_smaller_set(&self) -> SmallerSet {
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

    /// The least share of a box that was asked for.
    fn share(&self, sizes: &[Rational; 3]) -> Option<Rational> {
        let InitialSet::Box { x0, e0, z0 } = &self.spec.initial_set else { return None };
        let asked = [x0, e0, z0].into_iter().zip(sizes).filter(|(_, size)| **size > 0);
        let share = asked.map(|(asked, size)| Some(Rational::from(size / asked.as_rational()?)));
        let least = share.collect::<Option<Vec<Rational>>>()?.into_iter().min()?;
        Some(round_rational(&least, DIGITS, Direction::Down))
    }
}
