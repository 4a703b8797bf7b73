//! Rule: what rounding adds to the error of some oscillators at samples, where the regulator computes in doubles as its exported C code does
//! (docs/mathematics.md, section 13.6, Proposition A).
//!
//! With m, a double, for the e that is measured, that code does in this order
//!   `z_0 = z_0 - m`, `S = n_0 z_0`; for each harmonic l >= 1 in rising order `a = z_l1 - m`, `b = z_l2`, `z_l1 = c_l a + s_l b`, `z_l2 = c_l b - s_l a`, `S = S + n_l z_l1`;
//!   `u = K S - sigma m`, which is put out over the nominal gain, if there is one; `carry = (1 - h sigma) m`, `z_0 = z_0 + carry`, `z_l1 = z_l1 + carry`.
//! Each constant is the double nearest to its number, each operation rounds to nearest: a factor 1 + delta for each, |delta| <= u0 = 2^-53, k of which
//! are within gamma_k = k u0/(1 - k u0) of 1 (a fused multiply-add has one of them less). With `w = zeta - M v = z - M m`, |w|_N <= w_b, and |m| <= m_b, all at a sample:
//! - z_l1 and z_l2, turned: difference, constant, product and sum, gamma_4 (|c a| + |s b|) <= gamma_4 |w_l|;
//! - S: a constant, a product and at most p sums more, gamma_(p+6) sum n_l |w_l| <= gamma_(p+6) Nbar |w|_N, p the number of these l, whatever they are;
//! - u: K, its product, the difference, the nominal gain and the quotient, gamma_(p+11) (K Nbar w_b + sigma m_b);
//! - z after it: a sum more, gamma_5 |w_l| in both, and in the first one three of carry besides, gamma_3 (1 - h sigma) m_b.
//!
//! What is below the normal numbers is off by 2^-1075 in a product or a quotient, and exact in a sum. Less than 10^3 of these, times K, the weights or the
//! nominal gain, are within `tiny = 2^-1000 (1 + K)(1 + sigma)(1 + Nbar^2)(1 + nominal)`. Guarantee of [`Rounding::errors`]: constants are normal,
//! nothing overflows, and u is off by at most du_b, zeta by dz_b in |.|_N, in every step from a state within z_b, the sum of what is known of |zeta|_N and
//! of z_noise.
//!
//! Guarantee of [`Rounding::level`]: W, from rest, stays below level^2 at all samples, for it does so after each of them, and then |zeta|_N of
//! what noise does is at most z_noise.

use super::claimed::RULE;
use super::noise::Known;
use super::norm::{Norm, positive, power};
use crate::data::Data;
use crate::interval::Interval;
use crate::json::Fields;
use crate::rules::by_n_o::oscillators::Oscillators;
use crate::rules::sampled::law::Law;
use crate::verdict::{Condition, Outcome, invalid};
use rug::Rational;

/// The numbers of a witness by their names.
const NAMES: [&str; 4] = ["z_low", "z_up", "z_noise", "level"];

/// What proves it.
pub struct Rounding {
    pointer: String,
    /// Under [`NAMES`].
    pub(super) numbers: [Rational; 4],
}

impl Rounding {
    /// Takes the numbers out of the part `noise` of a witness, all of them or none.
    pub fn read(fields: &mut Fields<'_>) -> Outcome<Option<Rounding>> {
        let numbers = fields.together(NAMES)?;
        Ok(numbers.map(|numbers| Rounding { pointer: fields.pointer.clone(), numbers }))
    }

    /// That they are there exactly where the file has a regulator that rounds, all above 0.
    pub fn demanded<'w>(d: &Data<'_>, given: Option<&'w Rounding>, pointer: &str) -> Outcome<Option<&'w Rounding>> {
        match (given, d.spec.noise.is_rounded(true)) {
            (None, false) => Ok(None),
            (Some(rounding), true) => {
                let mut named = NAMES.into_iter().zip(&rounding.numbers);
                named.try_for_each(|(name, value)| positive(name, value, pointer)).map(|()| Some(rounding))
            }
            (None, true) => {
                let what = "`z_low`, `z_up`, `z_noise` and `level` are missing";
                invalid(RULE, pointer, format!("{what}, and the file has the arithmetic `double`"))
            }
            (Some(_), false) => {
                invalid(RULE, &format!("{pointer}/level"), "the file has exact arithmetic: there is no rounding")
            }
        }
    }

    /// du_b and dz_b.
    pub fn errors(&self, law: &Law<'_>, known: &Known, oscillators: &Oscillators) -> Outcome<[Interval; 2]> {
        let [_, _, z_noise, _] = self.enclosed(law.d.precision);
        let z_b = &known.zeta + z_noise;
        let w_b = &z_b + &law.d.n_bar * &known.off;
        let m_b = &known.e_b + &known.off;
        ranges(law, oscillators, [&z_b, &w_b, &m_b]).iter().try_for_each(|one| one.demand(RULE, &self.pointer))?;
        Ok(errors(law, oscillators, [&w_b, &m_b]))
    }

    /// A bound of `sqrt(W)`, where a step makes `sqrt((W + sum)/(1 + c))` of it, and at most `sqrt(z_up) dz_b` more: the level, if it is one.
    pub fn level(&self, norm: &Norm, [sum, c, dz_b]: [&Interval; 3]) -> Outcome<Interval> {
        let [z_low, z_up, z_noise, level] = self.enclosed(sum.precision());
        norm.holds_oscillators([&z_low, &z_up])?;
        let after = ((level.sqr() + sum) / (c + 1)).sqrt() + z_up.sqrt() * dz_b;
        let at = format!("{}/level", self.pointer);
        Condition::at_most("A", "sqrt((level^2 + I)/(1 + c)) + sqrt(z_up) dz_b <= level", after, level.clone())
            .demand(RULE, &at)?;
        let reach = z_noise * z_low.sqrt();
        Condition::at_most("A", "level <= z_noise sqrt(z_low)", level.clone(), reach)
            .demand(RULE, &format!("{}/z_noise", self.pointer))?;
        Ok(level)
    }

    fn enclosed(&self, precision: u32) -> [Interval; 4] {
        self.numbers.each_ref().map(|value| Interval::rational(value, precision))
    }
}

/// The nominal gain that is divided by; 1, where nothing is.
fn nominal(d: &Data<'_>) -> Interval {
    d.spec.input_gain.as_ref().map_or_else(|| d.int(1), |gain| gain.nominal.enclose(d.precision))
}

/// du_b and dz_b of a step from |w|_N <= w_b with |m| <= m_b.
pub(super) fn errors(law: &Law<'_>, oscillators: &Oscillators, [w_b, m_b]: [&Interval; 2]) -> [Interval; 2] {
    let d = law.d;
    let gamma = |count: usize| {
        let part = power(d, -53) * count as i64;
        &part / (1 - &part)
    };
    let parts = [&law.gain, &law.sigma, &d.n_bar.sqr(), &nominal(d)];
    let tiny = parts.into_iter().fold(power(d, -1000), |product, part| product * (part + 1));
    let of_u = gamma(oscillators.count() + 10) * (&law.gain * &d.n_bar * w_b + &law.sigma * m_b) + &tiny;
    let of_z = d.int(2).sqrt() * gamma(5) * w_b + gamma(3) * &law.a * m_b * &d.n_bar + tiny;
    [of_u, of_z]
}

/// That the constants are normal doubles, and that nothing overflows.
pub(super) fn ranges(law: &Law<'_>, oscillators: &Oscillators, [z_b, w_b, m_b]: [&Interval; 3]) -> Vec<Condition> {
    let d = law.d;
    let [least, most, largest] = [-900, 900, 1000].map(|exponent| power(d, exponent));
    let weights: Vec<Interval> = oscillators.harmonics().iter().map(|l| d.weight(u64::from(*l))).collect();
    let divisor = nominal(d);
    let named = [("sigma", &law.sigma), ("K", &law.gain), ("nominal", &divisor)];
    let of_weights = weights.iter().map(|weight| ("n_l", weight));
    let mut conditions: Vec<Condition> = named
        .into_iter()
        .chain(of_weights)
        .flat_map(|(name, value)| {
            [
                Condition::less("A", format!("2^-900 < {name}"), least.clone(), value.clone()),
                Condition::less("A", format!("{name} < 2^900"), value.clone(), most.clone()),
            ]
        })
        .collect();
    let of_sum = (&law.gain + 1) * &d.n_bar * w_b + &law.sigma * m_b;
    let what = "(1 + K) Nbar w_b + sigma m_b < 2^1000";
    conditions.push(Condition::less("A", what, of_sum.clone(), largest.clone()));
    let what = "(1 + K) Nbar w_b + sigma m_b < 2^1000 nominal";
    conditions.push(Condition::less("A", what, of_sum, &largest * divisor));
    conditions.extend(weights.iter().map(|weight| {
        let most = z_b / weight.sqrt() + m_b * 2;
        Condition::less("A", "z_b/sqrt(n_l) + 2 m_b < 2^1000", most, largest.clone())
    }));
    conditions
}
