//! Pi, sine, cosine, tangent and arc tangent.

use super::Enclosure;
use super::ends::End;
use rug::Float;
use rug::float::{Constant, Round};
use std::cmp::Ordering;

/// Arguments beyond this binary exponent are not reduced modulo pi (that would need as many bits); the trivial
/// enclosure is returned instead. Up to it a reduction costs no more than the function itself at the highest
/// precision, so that huge arguments are no dearer than small ones.
const MAX_REDUCED_EXPONENT: i32 = 1 << 8;

impl Enclosure {
    /// The constant pi.
    #[must_use]
    pub fn pi(precision: u32) -> Enclosure {
        Enclosure::new(
            Float::with_val_round(precision, Constant::Pi, Round::Down).0,
            Float::with_val_round(precision, Constant::Pi, Round::Up).0,
        )
    }

    /// Whether both ends are finite and small enough to be reduced modulo pi.
    fn is_reducible(&self) -> bool {
        self.is_bounded() && self.long().iter().all(|x| x.get_exp().is_none_or(|e| e <= MAX_REDUCED_EXPONENT))
    }

    /// The interval in units of pi/2.
    fn quarter_turns(&self) -> Enclosure {
        self / &(Enclosure::pi(self.precision() + 32) / 2)
    }

    /// Whether `offset + k * period` may lie in an interval for some integer k.
    fn may_contain_phase(&self, offset: i64, period: i64) -> bool {
        let periods = (self - offset) / period;
        !periods.is_bounded() || periods.integers().is_some()
    }

    /// The sine.
    #[must_use]
    pub fn sin(&self) -> Enclosure {
        self.wave([1, -1], |x, p| Float::with_val_round(p, x.sin_ref(), Round::Down))
    }

    /// The cosine.
    #[must_use]
    pub fn cos(&self) -> Enclosure {
        self.wave([0, 2], |x, p| Float::with_val_round(p, x.cos_ref(), Round::Down))
    }

    /// The values at the two ends, and 1 or -1 wherever a crest or a trough, given in units of pi/2, may lie in between; from a value rounded down, and
    /// whether that changed it.
    fn wave(&self, [crest, trough]: [i64; 2], below: impl Fn(&Float, u32) -> (Float, Ordering)) -> Enclosure {
        let p = self.precision();
        if !self.is_defined() {
            return Enclosure::undefined(p);
        }
        let [least, most] = [-1, 1].map(|end| Float::with_val(p, end));
        if !self.is_reducible() {
            return Enclosure::new(least, most);
        }
        let [lower, upper] = self.long();
        // What is rounded up is the next number, unless the value is one.
        let around = |x: &Float| {
            let (below, changed) = below(x, p);
            let mut above = below.clone();
            if changed != Ordering::Equal {
                above.next_up();
            }
            [below, above]
        };
        let turns = self.quarter_turns();
        let crest = turns.may_contain_phase(crest, 4);
        let trough = turns.may_contain_phase(trough, 4);
        let [below, above] = around(&lower);
        let [below, above] = if lower == upper {
            [below, above]
        } else {
            let [other_below, other_above] = around(&upper);
            [below.smaller(&other_below, p), above.larger(&other_above, p)]
        };
        Enclosure::new(if trough { least } else { below }, if crest { most } else { above })
    }

    /// The tangent, increasing between its poles; undefined if a pole may lie in the interval.
    #[must_use]
    pub fn tan(&self) -> Enclosure {
        let p = self.precision();
        if !self.is_reducible() || self.quarter_turns().may_contain_phase(1, 2) {
            return Enclosure::undefined(p);
        }
        self.nondecreasing(|x, p, round| Float::with_val_round(p, x.tan_ref(), round).0)
    }

    /// The arc tangent in (-pi/2, pi/2).
    #[must_use]
    pub fn atan(&self) -> Enclosure {
        self.nondecreasing(|x, p, round| Float::with_val_round(p, x.atan_ref(), round).0)
    }
}
