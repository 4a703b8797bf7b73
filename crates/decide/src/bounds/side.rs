//! Parts of an interval that is halved again and again.

use rug::{Integer, Rational};

/// One of the `2^level` equal parts of the unit interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Side {
    index: u64,
    pub(super) level: u32,
}

impl Side {
    /// The unit interval.
    pub(super) const WHOLE: Side = Side { index: 0, level: 0 };

    /// The two halves; levels stay below [`MAX_LEVEL`](super::chart::MAX_LEVEL), so nothing overflows.
    pub(super) fn halves(self) -> [Side; 2] {
        [0, 1].map(|half| Side { index: 2 * self.index + half, level: self.level + 1 })
    }

    /// The ends and the middle in [0, 1]: low, middle, high.
    pub(super) fn unit(self) -> [Rational; 3] {
        let at = |eighth: u64| Rational::from(Integer::from(2 * self.index + eighth)) >> (self.level + 1);
        [at(0), at(1), at(2)]
    }

    /// Half the length.
    pub(super) fn half(self) -> Rational {
        Rational::from(1) >> (self.level + 1)
    }

    /// The ends and the middle in [-1, 1].
    pub(super) fn symmetric(self) -> [Rational; 3] {
        self.unit().map(|value| value * 2 - 1)
    }
}
