//! The curves of a trial: xhat, ehat and uhat, polynomials in delta whose coefficients are trigonometric polynomials (docs/mathematics.md, section 14.4).
//! delta is `p_i - p_i^0` for the parameters of which intervals are known, in the order of the plant, and, if the gain of the actuator is an
//! interval, last `b - 1`.

use super::claimed::{Entry, RULE};
use crate::json::{Field, Fields};
use crate::spec::Specification;
use crate::verdict::{Outcome, bad, demand};
use crate::wave::Wave;
use rug::Rational;

/// The most harmonics of a curve.
const MOST_HARMONICS: usize = 64;

/// The name of the part about the members of a family, the most powers of delta in it, and the largest sum of exponents.
pub(super) const MEMBERS: &str = "members";
const MOST_MEMBERS: usize = 64;
const MOST_POWERS: u32 = 8;

/// The coefficients of one power of delta.
#[derive(Clone, Debug)]
pub struct Curves {
    /// The exponents, one for each number of which an interval is known.
    pub powers: Vec<u32>,
    /// The components of x.
    pub x: Vec<Wave>,
    /// e.
    pub e: Wave,
    /// u of the law.
    pub u: Wave,
}

/// Of how many numbers intervals are known: of parameters, and of the gain of the actuator.
pub fn intervals(spec: &Specification) -> usize {
    let parameters = spec.plant.as_ref().map_or(0, |plant| plant.parameters.len());
    parameters + usize::from(moves(spec))
}

/// Whether the gain of the actuator is an interval.
pub fn moves(spec: &Specification) -> bool {
    spec.input_gain.as_ref().is_some_and(|gain| !gain.is_nominal())
}

impl Curves {
    /// The number of the last harmonic.
    pub fn degree(&self) -> usize {
        let of_curve = |wave: &Wave| wave.harmonics.len();
        self.x.iter().chain([&self.e, &self.u]).map(of_curve).max().unwrap_or(0)
    }

    /// Takes `x`, with states, `e` and `u` out of an object.
    pub(super) fn take(fields: &mut Fields<'_>, entry: &Entry<'_>, states: usize, powers: Vec<u32>) -> Outcome<Curves> {
        let x = match states {
            0 => Vec::new(),
            _ => fields.required("x")?.object(|fields| Wave::read_all(fields, states, MOST_HARMONICS))?,
        };
        let of_e = fields.required("e")?;
        let e = of_e.object(|fields| Wave::read_without_mean(fields, MOST_HARMONICS))?;
        let of_u = fields.required("u")?;
        let u = of_u.object(|fields| Wave::read(fields, MOST_HARMONICS))?;
        let silent = |wave: &Wave, k: usize| wave.harmonic(k).iter().all(Rational::is_zero);
        let own = |k: &usize| entry.oscillators.contains(*k);
        if entry.or_more {
            demand(Some(e.is_constant()), RULE, &of_e.pointer, format!("no harmonic, for {}", entry.about()))?;
            let within = (1..=u.harmonics.len()).filter(|k| !own(k)).all(|k| silent(&u, k));
            demand(Some(within), RULE, &of_u.pointer, format!("no harmonic above n_o, for {}", entry.about()))?;
        } else {
            let without = (1..=e.harmonics.len()).filter(own).all(|k| silent(&e, k));
            demand(Some(without), RULE, &of_e.pointer, format!("no harmonic of an oscillator, for {}", entry.about()))?;
        }
        Ok(Curves { powers, x, e, u })
    }

    /// Reads the part `members`, to stand after the nominal curves: each power once.
    pub(super) fn read_members(
        field: &Field<'_>,
        entry: &Entry<'_>,
        states: usize,
        nominal: Curves,
    ) -> Outcome<Vec<Curves>> {
        let list = field.elements()?;
        let intervals = nominal.powers.len();
        if intervals == 0 {
            return bad(&field.pointer, "the curves move with what is an interval, and nothing is");
        }
        if list.is_empty() || list.len() > MOST_MEMBERS {
            return bad(&field.pointer, format!("expected 1 to {MOST_MEMBERS} members"));
        }
        let mut all = vec![nominal];
        for field in list {
            let curves = field.object(|fields| {
                let list = fields.required("powers")?;
                let powers = list.list(Field::whole)?;
                if powers.len() != intervals {
                    let what = "one for each parameter, and for the gain of the actuator, that is an interval";
                    return bad(&list.pointer, format!("expected {intervals} exponents, {what}"));
                }
                let sum = powers.iter().fold(0_u32, |sum, power| sum.saturating_add(*power));
                if sum == 0 || sum > MOST_POWERS {
                    return bad(&list.pointer, format!("expected a sum of 1 to {MOST_POWERS}"));
                }
                if all.iter().any(|other| other.powers == powers) {
                    return bad(&list.pointer, "expected each list once");
                }
                Curves::take(fields, entry, states, powers)
            })?;
            all.push(curves);
        }
        Ok(all)
    }
}
