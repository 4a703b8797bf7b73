//! Pi, sine, cosine, tangent and arc tangent.

use super::ends::End;
use super::{Enclosure, Ends};
use rug::Float;
use rug::float::{Constant, Round};
use rug::ops::AssignRound;
use std::cmp::Ordering;
use std::f64::consts::FRAC_2_PI;

/// Arguments beyond this binary exponent are not reduced modulo pi (that would need as many bits); the trivial
/// enclosure is returned instead. Up to it a reduction costs no more than the function itself at the highest
/// precision, so that huge arguments are no dearer than small ones.
const MAX_REDUCED_EXPONENT: i32 = 1 << 8;

/// The least number that has a larger one: 2^256.
const LEAST_TOO_LARGE: f64 = f64::from_bits((1023 + 256) << 52);

/// The quarter turns of an angle of which so many, up to this, are told apart by doubles.
const SURELY_TOLD: f64 = 1_048_576.0;

/// How far a number of quarter turns up to that may be from what doubles make of it; it is less than 1e-9.
const UNSURE: f64 = 1e-8;

/// An interval in units of pi/2.
struct QuarterTurns<'a> {
    angle: &'a Enclosure,
    /// Below the lower end and above the upper one, in doubles: nothing where the angle is large.
    around: Option<[f64; 2]>,
}

impl QuarterTurns<'_> {
    fn of(angle: &Enclosure) -> QuarterTurns<'_> {
        let [lower, upper] = [angle.lower_f64(), angle.upper_f64()].map(|end| end * FRAC_2_PI);
        let told = lower.abs() < SURELY_TOLD && upper.abs() < SURELY_TOLD;
        QuarterTurns { angle, around: told.then_some([lower - UNSURE, upper + UNSURE]) }
    }

    /// Whether `offset + k * period` may lie in the interval for some integer k; the period is 2 or 4.
    fn may_contain(&self, offset: i32, period: i32) -> bool {
        if let Some(ends) = self.around {
            let [lower, upper] = ends.map(|end| (end - f64::from(offset)) / f64::from(period));
            if lower.ceil() > upper.floor() {
                return false;
            }
        }
        let precision = self.angle.precision() + 32;
        let turns = self.angle / &(Enclosure::pi(precision) / 2);
        let periods = (turns - i64::from(offset)) / i64::from(period);
        !periods.is_bounded() || periods.integers().is_some()
    }
}

/// Where a wave has its crests and its troughs, in quarter turns.
struct Extremes {
    crest: i32,
    trough: i32,
}

const OF_SINE: Extremes = Extremes { crest: 1, trough: -1 };
const OF_COSINE: Extremes = Extremes { crest: 0, trough: 2 };

/// The numbers below and above a value that was rounded down: itself and the next one, unless the value is one.
fn around((below, changed): (Float, Ordering)) -> [Float; 2] {
    let mut above = below.clone();
    if changed != Ordering::Equal {
        above.next_up();
    }
    [below, above]
}

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
        let is_small = |end: &Float| end.is_finite() && end.get_exp().is_none_or(|e| e <= MAX_REDUCED_EXPONENT);
        match &self.ends {
            Ends::Short(ends) => ends.iter().all(|end| end.abs() < LEAST_TOO_LARGE),
            Ends::Long(ends) => ends.iter().all(is_small),
        }
    }

    /// The sine.
    #[must_use]
    pub fn sin(&self) -> Enclosure {
        let at = |x: &Float, p| [Float::with_val_round(p, x.sin_ref(), Round::Down)];
        let [sine] = self.waves([OF_SINE], at);
        sine
    }

    /// The cosine.
    #[must_use]
    pub fn cos(&self) -> Enclosure {
        let at = |x: &Float, p| [Float::with_val_round(p, x.cos_ref(), Round::Down)];
        let [cosine] = self.waves([OF_COSINE], at);
        cosine
    }

    /// The cosine and the sine: what [`Enclosure::cos`] and [`Enclosure::sin`] give, with the angle reduced once for both.
    #[must_use]
    pub fn cos_sin(&self) -> [Enclosure; 2] {
        self.waves([OF_COSINE, OF_SINE], |x, p| {
            let (mut sine, mut cosine) = (Float::new(p), Float::new(p));
            let (of_sine, of_cosine) = (&mut sine, &mut cosine).assign_round(x.sin_cos_ref(), Round::Down);
            [(cosine, of_cosine), (sine, of_sine)]
        })
    }

    /// The values of waves at the two ends, and 1 or -1 wherever a crest or a trough may lie in between; from values rounded down, and whether that
    /// changed them.
    fn waves<const N: usize>(
        &self,
        waves: [Extremes; N],
        below: impl Fn(&Float, u32) -> [(Float, Ordering); N],
    ) -> [Enclosure; N] {
        let p = self.precision();
        if !self.is_defined() {
            return waves.map(|_| Enclosure::undefined(p));
        }
        let least_and_most = || [-1, 1].map(|end| Float::with_val(p, end));
        if !self.is_reducible() {
            return waves.map(|_| {
                let [least, most] = least_and_most();
                Enclosure::new(least, most)
            });
        }
        let [lower, upper] = self.long();
        let turns = QuarterTurns::of(self);
        let at_lower = below(&lower, p);
        let mut at_upper = (lower != upper).then(|| below(&upper, p).into_iter());
        let mut at_lower = at_lower.into_iter();
        waves.map(|Extremes { crest, trough }| {
            let [least, most] = least_and_most();
            let Some([below, above]) = at_lower.next().map(around) else { return Enclosure::new(least, most) };
            let [below, above] = match at_upper.as_mut().and_then(Iterator::next).map(around) {
                Some([other_below, other_above]) => [below.smaller(&other_below, p), above.larger(&other_above, p)],
                None => [below, above],
            };
            let [crest, trough] = [crest, trough].map(|phase| turns.may_contain(phase, 4));
            Enclosure::new(if trough { least } else { below }, if crest { most } else { above })
        })
    }

    /// The tangent, increasing between its poles; undefined if a pole may lie in the interval.
    #[must_use]
    pub fn tan(&self) -> Enclosure {
        let p = self.precision();
        if !self.is_reducible() || QuarterTurns::of(self).may_contain(1, 2) {
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
