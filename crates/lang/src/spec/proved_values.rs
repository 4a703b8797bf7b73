//! Bounding functions of a plant that is known by its formulas: least upper bounds, proved at a few arguments.

use super::bound::Bound;
use super::existence_inequality::ExistenceInequality;
use super::joint_inequality::{JointInequality, JointStability};
use super::matrix_inequality::MatrixInequality;
use super::sampled_inequality::{SampledExistence, SampledInequality, SampledLoop};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;

/// A value of a bounding function that was proved from a plant's formulas: it bounds what [`Bound`] says on `|x| <= X`,
/// `|e| <= E` (derivation, 11.3).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ProvedValue {
    /// What it bounds.
    pub bound: Bound,
    /// X >= 0.
    pub x: Rational,
    /// E >= 0.
    pub e: Rational,
    /// The bound; of a rate from below.
    pub value: Rational,
    /// What samples reach, where it was sought from them; no claim rests on it.
    pub sampled: Option<Rational>,
}

/// Exact: an argument that is the rational of an entry is reached by it.
fn reaches(argument: &Enclosure, end: &Rational) -> bool {
    argument.upper_rational().is_some_and(|upper| upper <= *end)
}

/// All of them for one plant. The bounding function itself is the least upper bound on each box, so it is monotone by
/// definition, and a value at larger arguments serves at smaller ones.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ProvedValues {
    /// The values.
    pub entries: Vec<ProvedValue>,
    /// The matrix inequality of stability, where there is one.
    pub inequality: Option<MatrixInequality>,
    /// That of existence.
    pub existence: Option<ExistenceInequality>,
    /// The joint inequality of existence.
    pub joint_existence: Option<JointInequality>,
    /// That of stability.
    pub joint_stability: Option<JointStability>,
    /// The matrix inequalities of the regulator at samples.
    pub at_samples: SampledInequalities,
}

/// The matrix inequalities of the regulator at samples.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SampledInequalities {
    /// Of stability, where there is one.
    pub stability: Option<SampledInequality>,
    /// Of existence, where there is one.
    pub existence: Option<SampledExistence>,
}

impl SampledInequalities {
    /// What they are about, where there is one.
    #[must_use]
    pub fn about(&self) -> Option<&SampledLoop> {
        let of_existence = self.existence.as_ref().map(|existence| &existence.at);
        self.stability.as_ref().map(|stability| &stability.at).or(of_existence)
    }
}

impl ProvedValues {
    /// The values, each of which is proved.
    #[must_use]
    pub fn new(entries: Vec<ProvedValue>) -> ProvedValues {
        ProvedValues { entries, ..ProvedValues::default() }
    }

    /// Whether there is one of a bounding function.
    #[must_use]
    pub fn has(&self, which: Bound) -> bool {
        self.entries.iter().any(|entry| entry.bound == which)
    }

    /// The best value at (X, E); undefined where none reaches so far.
    ///
    /// Guarantee: it bounds what `which` says for all X, E in the enclosures.
    #[must_use]
    pub fn at(&self, which: Bound, x: &Enclosure, e: &Enclosure) -> Enclosure {
        let precision = x.precision().max(e.precision());
        let exact = |value: &Rational| Enclosure::from_rational(value, precision);
        let there = self.entries.iter().filter(|entry| entry.bound == which);
        let values = there.filter(|entry| reaches(x, &entry.x) && reaches(e, &entry.e)).map(|entry| &entry.value);
        let best = if which.is_rate() { values.max() } else { values.min() };
        best.map_or_else(|| Enclosure::undefined(precision), exact)
    }

    /// The largest X and E that all values of a bounding function together reach.
    #[must_use]
    pub fn reach(&self) -> Option<[Rational; 2]> {
        let of_inequality = self.inequality.iter().flat_map(MatrixInequality::arguments);
        let of_existence = self.existence.iter().map(|existence| [&existence.x, &existence.e]);
        let stability = self.joint_stability.iter().map(|joint| &joint.inequality);
        let of_joint = self.joint_existence.iter().chain(stability).map(|joint| [&joint.x, &joint.e]);
        let SampledInequalities { stability, existence } = &self.at_samples;
        let sampled = stability.iter().map(|known| [&known.x, &known.e]);
        let sampled = sampled.chain(existence.iter().map(|known| [&known.x, &known.e]));
        let of_entries = self.entries.iter().map(|entry| [&entry.x, &entry.e]);
        let all = of_entries.chain(of_inequality).chain(of_existence).chain(of_joint).chain(sampled);
        let larger = |[x, e]: [_; 2], [other_x, other_e]: [_; 2]| [Ord::max(x, other_x), Ord::max(e, other_e)];
        all.reduce(larger).map(|largest| largest.map(Clone::clone))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(bound: Bound, [x, e, value]: [i32; 3]) -> ProvedValue {
        let [x, e, value] = [x, e, value].map(Rational::from);
        ProvedValue { bound, x, e, value, sampled: None }
    }

    /// The best of those that reach; none beyond.
    #[test]
    fn a_value_serves_at_smaller_arguments_only() {
        let values = ProvedValues::new(vec![
            entry(Bound::Qx, [1, 1, 5]),
            entry(Bound::Qx, [2, 2, 7]),
            entry(Bound::Rate, [1, 0, 3]),
            entry(Bound::Rate, [2, 2, -1]),
        ]);
        let number = |value: f64| Enclosure::from_rational(&Rational::from_f64(value).unwrap(), 64);
        let at = |which, x: f64, e: f64| {
            let value = values.at(which, &number(x), &number(e));
            value.is_defined().then(|| value.midpoint_f64())
        };
        assert_eq!(at(Bound::Qx, 0.5, 1.0), Some(5.0));
        assert_eq!(at(Bound::Qx, 1.0, 1.0), Some(5.0));
        assert_eq!(at(Bound::Qx, 1.0, 1.5), Some(7.0));
        assert_eq!(at(Bound::Qx, 2.5, 0.0), None);
        assert_eq!(at(Bound::Rate, 0.5, 0.0), Some(3.0));
        assert_eq!(at(Bound::Rate, 0.5, 0.1), Some(-1.0));
        assert_eq!(at(Bound::Fe, 0.0, 0.0), None);
        // An enclosure that straddles the end of an entry is beyond it.
        let straddling = Enclosure::between(&Rational::from(1), &Rational::from((101, 100)), 64);
        assert_eq!(values.at(Bound::Qx, &straddling, &number(0.0)).midpoint_f64(), 7.0);
        assert_eq!(values.reach(), Some([Rational::from(2), Rational::from(2)]));
    }
}
