//! Bounds of what noise and a disturbance do to the error of the law at samples, for some oscillators (derivation, section 13.6).
//!
//! What is measured is e + v, and d is added to q: any measurable signals with |v| <= v_bar, |d| <= d_bar. By the form of [`sigmastar_decide::rates::at_samples`] with these
//! inputs W of what they add from 0 on stays below `e_low s^2`,
//! `s^2 = (g_d (1+g)^2 d_bar^2 + g_v v_bar^2 + g_r c_d^2 d_bar^2)/(c e_low)`, so that it moves e by at most s at the samples. Between them e is a straight
//! line and at most `(h/2) sup|q + d|` more, |q| <= k_x xi + k_e |e|, xi <= kappa sup|e|, kappa = sqrt(P_up) k_f/a_2: with
//!
//!   `S := (s + (h/2) d_bar)/(1 - (h/2)(k_e + k_x kappa))`,  the denominator being positive,
//!
//! it moves e by at most S at all times. The rest is as in [`crate::rate::noise`], L_0 being the left side of C4 at samples.
//!
//! Of a law that is computed in doubles ([`super::rounding`]) v_bar is that of the double that is measured, D is at most `(1+g) d_bar + b_hi du`, and
//! zs+ is moved by a vector of at most dz besides, which adds `sqrt(z_up) dz` to the root of W. With I what the inputs add to W in a sample and a
//! level with `sqrt((level^2 + I)/(1+c)) + sqrt(z_up) dz <= level`, that root stays below the level, and s is `level/sqrt(e_low)`.

use super::rounding::{Computed, ComputedLaw, Rounded, RoundingWitness, are_zeta_bounds, measured, settled};
use crate::rate::bound::{Place, up};
use crate::rate::control::{RateForm, of_noise};
use crate::rate::noise::{Confinement, NoNoiseBound, NoiseBound, kappa, proved, within_the_box};
use rug::Rational;
use sigmastar_decide::rates::OscillatorMatrix;
use sigmastar_decide::rates::at_samples::{Inputs, SampledDynamics, SampledRateWitness};
use sigmastar_decide::rates::inequality::LoopBounds;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_propose::rates::sampled_noise_search::{Strengths, propose};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::sampled::SampledLaw;

/// What proves bounds under noise at samples.
#[derive(Clone, Debug)]
pub struct SampledNoise {
    /// What proves the form with inputs.
    pub witness: SampledRateWitness,
    /// What is proved besides of a law in doubles.
    pub rounding: Option<RoundingWitness>,
}

/// The best bounds that are found.
///
/// Guarantee: with these oscillators at the gain of `place`, the law and every input gain of the data, and any measurable inputs within the bounds
/// of the specification, every solution that is within the distances of `place` at a sampling instant t_0 has `|e(t) - e_per(t)| <= peak` at all times
/// t >= t_0, between samples too, and a limit superior of that of at most `limit`, e_per being of the periodic solution without inputs; whoever the
/// plant is of which the bounds of the error box hold. Where the specification says so the law is computed in doubles, by the operations of the
/// exported C code, and e_per is that of the loop without rounding.
///
/// # Errors
/// What was not found or not proved.
pub fn noise_bound(
    data: &Data<'_>,
    law: &SampledLaw<Enclosure>,
    place: &Place<'_>,
    confinement: &Confinement<'_>,
    rate: &RateForm<'_>,
) -> Result<NoiseBound<SampledNoise>, NoNoiseBound> {
    let in_doubles = data.spec.disturbances.in_doubles();
    if data.spec.actuator.is_some() {
        return Err(if in_doubles { NoNoiseBound::ActuatorInDoubles } else { NoNoiseBound::Actuator });
    }
    let not_found = NoNoiseBound::NotFound;
    let bounds = LoopBounds::of_error(data, place.error_box).ok_or(not_found)?;
    let oscillators = OscillatorMatrix::new(data, rate.oscillators);
    let dynamics = SampledDynamics::new(data, (&oscillators, law), place.sigma, &bounds).ok_or(not_found)?;
    let number = |value: &Rational| data.rational(value);
    let d_bar = number(&data.spec.d_bar());
    let v_bar = measured(data, &place.error_box.e_b);
    let computed = in_doubles.then(|| Computed {
        law: ComputedLaw::new(data, &dynamics),
        measured: &place.error_box.e_b + &v_bar,
        zeta: confinement.zeta.clone(),
        misled: &data.n_bar * &v_bar,
    });
    let sample = &dynamics.sample;
    let largest_gain = law.input_gain.as_ref().map(|gain| &gain.high);
    let acting = |control: &Enclosure| largest_gain.map_or_else(|| control.clone(), |gain| gain * control);
    // D: what a disturbance adds, and what rounding adds to u.
    let added = |control: Option<&Enclosure>| {
        let of_d = &sample.enlarged * &d_bar;
        control.map_or(of_d.clone(), |control| of_d + acting(control))
    };
    let disturbance = data.spec.d_bar().to_f64();
    let [enlarged, c_d] = [&sample.enlarged, &sample.c_d].map(Enclosure::upper_f64);
    let (sizes, moved) = match computed.as_ref().map(|computed| computed.rounded(&data.zero())) {
        None => ([disturbance, data.spec.v_bar().to_f64()], None),
        Some(Rounded { control, state }) => {
            ([disturbance + acting(&control).upper_f64() / enlarged, v_bar.upper_f64()], Some(state.upper_f64()))
        }
    };
    let strengths = Strengths { sizes, of_d: [enlarged * sizes[0], c_d * disturbance], moved };
    let found = propose(&dynamics, strengths).ok_or(not_found)?;
    // z_low and z_up, of a law in doubles.
    let zeta_bounds = if in_doubles { Some(found.zeta_bounds().ok_or(not_found)?) } else { None };
    let precision = law.step.precision();
    let between = |pi: &[_]| zeta_bounds.as_ref().is_none_or(|of_zeta| are_zeta_bounds(pi, of_zeta, precision));
    let (witness, e_low) = proved(&dynamics, &found, precision, between).ok_or(not_found)?;

    let Inputs { g_d, g_v, g_r } = &witness.inputs;
    let weighed = |weight: &Option<Rational>, size: Enclosure| {
        weight.as_ref().map_or_else(|| data.zero(), |weight| number(weight) * size.sqr())
    };
    let inputs = |control: Option<&Enclosure>| {
        weighed(g_d, added(control)) + weighed(g_v, v_bar.clone()) + weighed(g_r, &sample.c_d * &d_bar)
    };
    let c = number(&witness.c);
    let rounding = match (&computed, zeta_bounds) {
        (Some(computed), Some(of_zeta)) => {
            Some(settled(computed, &c, of_zeta, |rounded| inputs(Some(&rounded.control)))?)
        }
        _ => None,
    };
    // The root of W of the part with the inputs, and what rounding adds to u.
    let (level, of_rounding) = match (&rounding, &computed) {
        (Some(RoundingWitness { level, z_noise, .. }), Some(computed)) => {
            (number(level), computed.rounded(&number(z_noise)).control)
        }
        _ => ((inputs(None) / c).sqrt(), data.zero()),
    };
    let at_samples = &level / number(&e_low).sqrt();
    let error_box = place.error_box;
    let two = data.rational(&Rational::from(2));
    let half = &law.step / &two;
    let k_e = error_box.sector.below.max(&error_box.sector.above);
    let coupling = if bounds.has_x { &error_box.k_x * kappa(data, error_box) } else { data.zero() };
    let bracket = Enclosure::one(data.precision) - &half * (k_e + coupling);
    let s = (at_samples + half * d_bar) / &bracket;
    let misled = rate.misled(data, &v_bar);
    let directly = [&dynamics.noise_gain(), &v_bar, &of_rounding];
    let control = of_noise(data, &dynamics.control(), (&witness.pi, &level), (rate, &misled), directly);
    // Of the part that starts misled that is so at the ends of each sample, and x is 0 at its start, too.
    let misled = up(&(misled / number(rate.e_low).sqrt() / &bracket));
    if !(data.zero().lt(&error_box.rate).is_true() && data.zero().lt(&bracket).is_true()) {
        return Err(not_found);
    }
    let [limit, peak] = within_the_box(data, error_box, confinement, &s)?;
    let misled = misled.ok_or(not_found)?;
    Ok(NoiseBound { proof: SampledNoise { witness, rounding }, e_low, limit, peak, misled, control })
}
