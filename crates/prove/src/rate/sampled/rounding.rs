//! What the rounding of the exported law does in a sample (derivation, 13.6, Proposition A).
//!
//! The law is computed in doubles, by the operations of the exported C code in their order: with m the double that is measured and `w = z - M m`
//!
//!   `a = z_(2l-1) - m`, `b = z_2l`, `z_(2l-1) = c_l a + s_l b`, `z_2l = c_l b - s_l a`, `S = n_0 z_0 + n_1 z_1 + ...` in this order,
//!   `u = K S - sigma m`, over the nominal gain where there is one, `carry = (1 - h sigma) m`, which is added to z_0 and each z_(2l-1).
//!
//! Every constant is within u0 = 2^-53 of the exact one, relatively, and so is every operation. Of the terms of u none has more than p + 11 such
//! factors, with p oscillators beside the integrator, at whatever harmonics, of those of z_(2l-1) at most 5, of carry in it 3. With `gamma_k = k u0/(1 - k u0)`, |m| <= m_b, |w|_N <= w_b, by Cauchy and Schwarz
//!
//!   `du = gamma_(p+11) (K Nbar w_b + sigma m_b) + tiny`,  `dz = sqrt(2) gamma_5 w_b + gamma_3 (1 - h sigma) m_b Nbar + tiny`,
//!   `tiny = 2^-1000 (1 + K)(1 + sigma)(1 + Nbar^2)(1 + nominal)`
//!
//! bound how far u, times the nominal gain, and in |.|_N the next z are from the exact ones; tiny is far above all that underflow does. It is
//! demanded that the constants are ordinary numbers and that nothing overflows.

use crate::rate::noise::NoNoiseBound;
use rug::Rational;
use sigmastar_decide::rates::at_samples::SampledDynamics;
use sigmastar_decide::rates::inequality::is_definite;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_theory::data::Data;

/// u0 = 2^-53, by what share an operation in doubles is off at most.
const UNIT: i32 = -53;

/// Roundings of a term of u beside one for each weight, of which there are p + 1: the p sums, 4 of the turned state, 2 of n_l and its product, 2 of
/// K (as if it were rounded too) and its product, the last sum, and 2 of the nominal gain and the division by it.
const OF_CONTROL: u32 = 10;

/// The exponents of 2 between which the constants are, and below which every intermediate number is.
const CONSTANTS: [i32; 2] = [-900, 900];
const LARGEST: i32 = 1000;

/// By what share bounds of Pi, the level and z_noise are away from what would do.
const ROOM: f64 = 1e-3;

/// Figures of these numbers.
const FIGURES: u32 = 6;

/// How often z_noise is raised to what the rounding with it asks for.
const TRIES: usize = 60;

/// The bound of the measurement error of the law at samples: v_bar, in doubles `v_bar + u0 (E_b + v_bar) + 2^-1074`, for m is the double next to a
/// number within v_bar of e.
#[must_use]
pub fn measured(data: &Data<'_>, e_b: &Enclosure) -> Enclosure {
    let v_bar = data.rational(&data.spec.v_bar());
    match data.spec.disturbances.in_doubles() {
        false => v_bar,
        true => &v_bar + power(UNIT, data.precision) * (e_b + &v_bar) + power(-1074, data.precision),
    }
}

fn power(exponent: i32, precision: u32) -> Enclosure {
    let one = Rational::from(1);
    Enclosure::from_rational(
        &if exponent < 0 { one >> exponent.unsigned_abs() } else { one << exponent.unsigned_abs() },
        precision,
    )
}

/// The constants of the law in the computer, for some oscillators, exactly.
#[derive(Clone, Debug)]
pub struct ComputedLaw {
    /// sigma, in 1/time.
    pub sigma: Enclosure,
    /// K, in 1/time.
    pub gain: Enclosure,
    /// 1 - h sigma, from 0 to 1.
    pub decay: Enclosure,
    /// What u is divided by; 1 without an input gain.
    pub nominal: Enclosure,
    /// Nbar, the root of a bound of the sum of the weights.
    pub n_bar: Enclosure,
    /// The roots of n_l for each of the harmonics l, 0 the first.
    pub roots: Vec<Enclosure>,
}

/// How far the law in the computer is from the exact one after a sample.
#[derive(Clone, Debug)]
pub struct Rounded {
    /// du: of u, times the nominal gain where it is divided by one.
    pub control: Enclosure,
    /// dz: of the next z, in |.|_N.
    pub state: Enclosure,
}

impl ComputedLaw {
    /// That of a claim.
    #[must_use]
    pub(super) fn new(data: &Data<'_>, dynamics: &SampledDynamics<'_>) -> ComputedLaw {
        let one = Enclosure::one(data.precision);
        let sigma = data.rational(&dynamics.sigma);
        let b = &dynamics.oscillators.b;
        ComputedLaw {
            gain: dynamics.law.gain.clone(),
            decay: &one - &dynamics.law.step * &sigma,
            nominal: data.spec.input_gain.as_ref().map_or(one, |gain| gain.nominal.enclose(data.precision)),
            n_bar: data.n_bar.clone(),
            roots: b
                .iter()
                .enumerate()
                .filter(|(state, _)| *state == 0 || state % 2 == 1)
                .map(|(_, root)| root.clone())
                .collect(),
            sigma,
        }
    }

    /// du and dz for |m| <= m_b and |w|_N <= w_b.
    ///
    /// Guarantee: as the module says, where nothing is [extraordinary](ComputedLaw::extraordinary) with these bounds; with or without fused
    /// multiply-adds and flushing of subnormal numbers.
    #[must_use]
    pub fn rounded(&self, m: &Enclosure, w: &Enclosure) -> Rounded {
        let ComputedLaw { sigma, gain, decay, nominal, n_bar, roots } = self;
        let precision = m.precision();
        let one = Enclosure::one(precision);
        let gamma = |k: u32| {
            let roundings = Enclosure::from_integer(i64::from(k), precision) * power(UNIT, precision);
            &roundings / (&one - &roundings)
        };
        // Of the few oscillators of a certificate the roundings are far below 1/UNIT.
        let of_control = gamma(roots.len() as u32 + OF_CONTROL);
        let tiny =
            power(-LARGEST, precision) * (&one + gain) * (&one + sigma) * (&one + n_bar.sqr()) * (&one + nominal);
        let two = Enclosure::from_integer(2, precision);
        Rounded {
            control: of_control * (gain * n_bar * w + sigma * m) + &tiny,
            state: two.sqrt() * gamma(5) * w + gamma(3) * decay * m * n_bar + tiny,
        }
    }

    /// What is not known to be an ordinary double, with its largest size: a constant below 2^-900 or above 2^900, or something that may overflow
    /// for |m| <= m_b, |w|_N <= w_b and |zeta|_N <= z_b.
    #[must_use]
    pub fn extraordinary(&self, m: &Enclosure, w: &Enclosure, z: &Enclosure) -> Option<(&'static str, f64)> {
        let ComputedLaw { sigma, gain, nominal, n_bar, roots, .. } = self;
        let precision = m.precision();
        let [low, high] = CONSTANTS.map(|exponent| power(exponent, precision));
        let largest = power(LARGEST, precision);
        let of_weights = roots.iter().map(|root| ("a weight", root.sqr()));
        let constants = [("sigma", sigma.clone()), ("K", gain.clone()), ("the nominal gain", nominal.clone())];
        let odd = |(_, value): &(&str, Enclosure)| !(low.lt(value).is_true() && value.lt(&high).is_true());
        let control = (Enclosure::one(precision) + gain) * n_bar * w + sigma * m;
        let states = roots.iter().map(|root| ("a state of the regulator", z / root + m * 2));
        let signals = [("the control", control.clone()), ("the control over the nominal gain", control / nominal)];
        let overflows = |(_, value): &(&str, Enclosure)| !value.lt(&largest).is_true();
        constants
            .into_iter()
            .chain(of_weights)
            .find(odd)
            .or_else(|| signals.into_iter().chain(states).find(overflows))
            .map(|(what, value)| (what, value.upper_f64()))
    }
}

/// What is known of a law in doubles in the error box, whatever rounding adds to zeta.
pub(super) struct Computed {
    pub(super) law: ComputedLaw,
    /// m_b = E_b + v_d.
    pub(super) measured: Enclosure,
    /// Z + sqrt(L_0/eta_w), and Nbar v_d.
    pub(super) zeta: Enclosure,
    pub(super) misled: Enclosure,
}

impl Computed {
    /// du and dz where what noise and rounding add to zeta is at most z_noise.
    pub(super) fn rounded(&self, z_noise: &Enclosure) -> Rounded {
        self.law.rounded(&self.measured, &(&self.zeta + z_noise + &self.misled))
    }

    /// What is not ordinary then.
    fn extraordinary(&self, z_noise: &Enclosure) -> Option<(&'static str, f64)> {
        let z = &self.zeta + z_noise;
        self.law.extraordinary(&self.measured, &(&z + &self.misled), &z)
    }
}

/// What a proof has besides for a law in doubles.
#[derive(Clone, Debug)]
pub struct RoundingWitness {
    /// z_low: `Pi > diag(0, z_low I)`.
    pub z_low: Rational,
    /// z_up: the block of zs in Pi is below z_up I.
    pub z_up: Rational,
    /// What noise and rounding add to |zeta|_N at most.
    pub z_noise: Rational,
    /// What the root of W of that part stays below.
    pub level: Rational,
}

/// Whether `Pi > diag(0, z_low I)` and `Pi_zz < z_up I` are proved.
pub(super) fn are_zeta_bounds(rows: &[Vec<Rational>], [z_low, z_up]: &[Rational; 2], precision: u32) -> bool {
    let number = |value: &Rational| Enclosure::from_rational(value, precision);
    let pi = |i: usize, j: usize| number(&rows[i.max(j)][i.min(j)]);
    is_definite(rows.len(), |i, j| if i == j && i > 0 { pi(i, i) - number(z_low) } else { pi(i, j) })
        && is_definite(rows.len() - 1, |i, j| match i == j {
            true => number(z_up) - pi(i + 1, i + 1),
            false => pi(i + 1, j + 1).negate(),
        })
}

impl RoundingWitness {
    /// Whether `sqrt((level^2 + I)/(1 + c)) + sqrt(z_up) dz <= level <= z_noise sqrt(z_low)`, I and dz being those of z_noise.
    ///
    /// Guarantee: if true, the root of W of the part with the inputs stays below the level from 0 on, and so |zeta|_N of that part below z_noise.
    fn holds(&self, computed: &Computed, c: &Enclosure, of_inputs: impl Fn(&Rounded) -> Enclosure) -> bool {
        let number = |value: &Rational| Enclosure::from_rational(value, c.precision());
        let [z_low, z_up, z_noise, level] = [&self.z_low, &self.z_up, &self.z_noise, &self.level].map(number);
        let rounded = computed.rounded(&z_noise);
        let kept = Enclosure::one(c.precision()) + c;
        let next = ((level.sqr() + of_inputs(&rounded)) / kept).sqrt() + z_up.sqrt() * rounded.state;
        next.le(&level).is_true() && level.le(&(z_noise * z_low.sqrt())).is_true()
    }
}

/// A level and a z_noise that hold, about the least ones.
///
/// # Errors
/// There are none, or the law is not ordinary with them.
pub(super) fn settled(
    computed: &Computed,
    c: &Enclosure,
    [z_low, z_up]: [Rational; 2],
    of_inputs: impl Fn(&Rounded) -> Enclosure,
) -> Result<RoundingWitness, NoNoiseBound> {
    let precision = c.precision();
    let number = |value: &Rational| Enclosure::from_rational(value, precision);
    let (kept, root_low, root_up) = (Enclosure::one(precision) + c, number(&z_low).sqrt(), number(&z_up).sqrt());
    let up = |value: f64| round_f64(value * (1.0 + ROOM), FIGURES, Direction::Up).ok_or(NoNoiseBound::NotFound);
    let mut z_noise = Rational::new();
    for _ in 0..TRIES {
        if let Some((what, size)) = computed.extraordinary(&number(&z_noise)) {
            return Err(NoNoiseBound::BeyondDoubles { what, size });
        }
        let rounded = computed.rounded(&number(&z_noise));
        let moved = &root_up * &rounded.state;
        // Where both sides are equal.
        let least = (&moved * &kept + (moved.sqr() * &kept + c * of_inputs(&rounded)).sqrt()) / c;
        let level = up(least.upper_f64())?;
        let needed = up((number(&level) / &root_low).upper_f64())?;
        if needed <= z_noise {
            let witness = RoundingWitness { z_low, z_up, z_noise, level };
            return if witness.holds(computed, c, of_inputs) { Ok(witness) } else { Err(NoNoiseBound::NotFound) };
        }
        z_noise = up(needed.to_f64())?;
    }
    Err(NoNoiseBound::RoundingGrows)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(value: f64) -> Enclosure {
        Enclosure::from_rational(&Rational::from_f64(value).unwrap(), 128)
    }

    fn computed(weight: f64) -> Computed {
        let law = ComputedLaw {
            sigma: number(60.0),
            gain: number(0.995),
            decay: number(0.88),
            nominal: number(1.0),
            n_bar: number(2.0),
            roots: vec![number(1.5), number(weight)],
        };
        Computed { law, measured: number(1.9), zeta: number(5.0), misled: number(1e-15) }
    }

    /// What D and v add.
    fn inputs(rounded: &Rounded) -> Enclosure {
        number(0.5) * rounded.control.sqr() + number(8e4) * number(1e-16).sqr()
    }

    #[test]
    fn a_level_is_accepted_and_smaller_numbers_are_refused() {
        let (computed, c) = (computed(1.0), number(1e-3));
        let of_zeta = || [9, 33].map(Rational::from);
        let found = settled(&computed, &c, of_zeta(), inputs).unwrap();
        assert!(found.level < 1e-9 && found.holds(&computed, &c, inputs));
        let with = |change: &dyn Fn(&mut RoundingWitness)| {
            let mut witness = found.clone();
            change(&mut witness);
            witness
        };
        let share = |value: &Rational, percent: u32| Rational::from(value * percent) / 100;
        for broken in [
            with(&|witness| witness.level = share(&witness.level, 99)),
            with(&|witness| witness.level = share(&witness.level, 101)),
            with(&|witness| witness.z_noise = share(&witness.z_noise, 99)),
            with(&|witness| witness.z_low = share(&witness.z_low, 98)),
            with(&|witness| witness.z_up = share(&witness.z_up, 102)),
        ] {
            assert!(!broken.holds(&computed, &c, inputs), "{broken:?}");
        }
        // Half as much is taken away in a sample, and twice as much is put in.
        assert!(!found.holds(&computed, &number(5e-4), inputs));
        assert!(!found.holds(&computed, &c, |rounded| inputs(rounded) * 10000));
    }

    #[test]
    fn where_there_is_no_level_the_cause_is_told() {
        let settled = |computed: &Computed, c: f64| settled(computed, &number(c), [9, 33].map(Rational::from), inputs);
        assert_eq!(settled(&computed(1.0), 1e-16).unwrap_err(), NoNoiseBound::RoundingGrows);
        let told = settled(&computed(1e-140), 1e-3).unwrap_err();
        assert!(matches!(told, NoNoiseBound::BeyondDoubles { what: "a weight", .. }), "{told:?}");
        let mut loud = computed(1.0);
        loud.measured = number(1e300) * 10;
        let told = settled(&loud, 1e-3).unwrap_err();
        assert!(matches!(told, NoNoiseBound::BeyondDoubles { what: "the control", .. }), "{told:?}");
        let mut small = computed(1.0);
        small.law.nominal = number(1e-272);
        let told = settled(&small, 1e-3).unwrap_err();
        assert!(matches!(told, NoNoiseBound::BeyondDoubles { what: "the nominal gain", .. }), "{told:?}");
    }

    /// By hand: the least eigenvalue of the Schur complement [[1.75, 0.375], [0.375, 2.9375]] is 1.6415, the largest one of the block 3.0590.
    #[test]
    fn pi_is_between_its_bounds_of_zeta() {
        let rows = [&[4.0][..], &[1.0, 2.0], &[-0.5, 0.25, 3.0]];
        let rows = rows.map(|row| row.iter().map(|entry| Rational::from_f64(*entry).unwrap()).collect::<Vec<_>>());
        let holds = |thousandths: [u32; 2]| {
            are_zeta_bounds(&rows, &thousandths.map(|bound| Rational::from((bound, 1000))), 128)
        };
        assert!(holds([1641, 3060]) && !holds([1642, 3060]) && !holds([1641, 3059]));
    }

    /// Without oscillators by hand, u0 being 2^-53.
    #[test]
    fn the_counts_of_an_integrator() {
        let law = ComputedLaw { roots: vec![number(1.5)], ..computed(1.0).law };
        let Rounded { control, state } = law.rounded(&number(0.25), &number(4.0));
        let unit = 2f64.powi(-53);
        let [of_control, of_state] =
            [11.0 * (0.995 * 2.0 * 4.0 + 60.0 * 0.25), 5.0 * 2f64.sqrt() * 4.0 + 3.0 * 0.88 * 0.25 * 2.0];
        for (bound, expected) in [(control, of_control), (state, of_state)] {
            assert!((bound.midpoint_f64() / (expected * unit) - 1.0).abs() < 1e-12);
        }
    }
}
