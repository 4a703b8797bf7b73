//! The regulator at samples (derivation, 12): conditions S0, S1, S2, C4, C5h decided from a rational witness; with matrix inequalities
//! over a plant's derivatives in the place of C5h and beside S2 (13.7). Where a control takes a sample to be computed (13.4) C4d and C5d
//! stand in the place of C4 and C5h, and all is by norms.
//!
//! A claim is about exactly one sigma and one sampling period: nothing here is monotone in either.

mod delay;
pub mod energy;
#[cfg(test)]
pub(super) mod examples;
mod gains;
mod hold;
mod law;
pub mod matrix_inequality;
mod pair;
mod stability;
mod witness;

pub use energy::SampledEnergyNumbers;
pub use gains::SampledGains;
pub use hold::{SampleBounds, SampleNumbers};
pub use law::SampledLaw;
pub use pair::{SampledPair, sampled_trade_off};
pub use stability::{DecayForms, DecayNumbers, Form, Part, Past};
pub use witness::{DelayWitness, SampledWitness};

use super::condition::{self, Condition, Relation};
use super::consequences::ErrorBounds;
use super::control::{self, Control};
use super::harmonics::AtOrigin;
use super::initial_set::{claimed_distances, set_conditions};
use super::mean_squares::{Forcing, Gains, MeanSquares, PeriodicSize, SetBounds, sup_by_mean_squares};
use super::sharp::one_sided;
use super::stability::{ErrorBox, level_condition, level_words};
use super::{domain_conditions, sign_conditions};
use crate::data::Data;
use crate::input_gain::InputGain;
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};

/// The largest relative difference between the mu of a specification and K (1 + theta), as its inverse.
const SAME_MU: u32 = 1_000_000;

/// Everything that is computed from such a witness.
#[derive(Clone, Debug)]
pub struct SampledEvaluation {
    /// h sigma.
    pub product: Enclosure,
    /// The law.
    pub law: SampledLaw<Enclosure>,
    /// The bounding functions at (X_p, E_p).
    pub bounds: SetBounds<Enclosure>,
    /// R_q, R_1, e_per, x_per.
    pub size: PeriodicSize<Enclosure>,
    /// Z.
    pub z: Enclosure,
    /// The error box.
    pub error_box: ErrorBox<Enclosure>,
    /// Q_0 and Q_h.
    pub forms: DecayForms<Enclosure>,
    /// How large the control gets.
    pub control: Control<Enclosure>,
    /// How large |e| gets on the way from the claimed set, between samples too.
    pub peak: Enclosure,
    /// All conditions in order.
    pub conditions: Vec<Condition>,
}

impl SampledEvaluation {
    /// Evaluates all quantities and conditions at the precision of `data`.
    ///
    /// Guarantee: if [`SampledEvaluation::truth`] is `True` and the bounding functions are finite, nonnegative where they bound
    /// norms, and nondecreasing (a rate nonincreasing) up to (max{X_p, X_b}, max{E_p, E_b}), then for this sigma and h, every
    /// n_o < N_s/2 and every phase of the sampling grid there is a T-periodic solution with sup|x| <= x_per,
    /// sup|e| <= e_per, |zeta_k|_N <= Z, and every solution that is in the claimed set at a sampling instant converges to it
    /// exponentially. With a delay the claimed set has |e_0 - et_0| <= h Y_0 besides.
    #[must_use]
    pub fn new(data: &Data<'_>, witness: &SampledWitness) -> SampledEvaluation {
        let number = |value: &Rational| data.rational(value);
        let (sigma, law) = (number(&witness.sigma), SampledLaw::new(data, &witness.sampling, &witness.law));
        // Exactly where h is rational: h sigma = 1 is allowed.
        let product = match witness.sampling.step.as_rational() {
            Some(step) => number(&Rational::from(step * &witness.sigma)),
            None => &law.step * &sigma,
        };
        let origin = AtOrigin::new(data);
        let bounds = SetBounds::new(data, number(&witness.x_p), number(&witness.e_p));
        // Matrix inequalities say nothing of the law with a delay.
        let known = if law.delayed { None } else { energy::proved(data, &origin, witness) };
        let gains = SampledGains::new(&law, &sigma, &data.period).with_energy(known);
        let squares = witness.squares().map(|value| number(value));
        let size = PeriodicSize::new(data, &bounds, &origin, &gains, &squares);
        let z = gains.z_squared(data, &size.forcing, [&number(&witness.k0), &number(&witness.k1)]).sqrt();
        let [d_x, d_e, w_x, eta] = [&witness.d_x, &witness.d_e, &witness.w_x, &witness.eta].map(number);
        let error_box = ErrorBox::new(data, witness.paths, [&size.x_per, &size.e_per], [&d_x, &d_e]);
        let DelayWitness { gm, y_0 } = witness.delay_numbers();
        let (gm, y_0) = (number(&gm), number(&y_0));
        let numbers = DecayNumbers { law: &law, sigma: &sigma, w_x: &w_x, eta: &eta, gm: &gm };
        let forms = DecayForms::new(data, &error_box, &numbers);

        let mut conditions = signs(data, witness);
        conditions.extend(set_conditions(data, &witness.set, &witness.x_p, &witness.e_p, &z));
        conditions.extend(domain_conditions(data, bounds.x_p.max(&error_box.x_b), bounds.e_p.max(&error_box.e_b)));
        conditions.push(SampledPair { law: &law, k0: &witness.k0, k1: &witness.k1 }.condition(data));
        conditions.extend(law_conditions(data, &law, &product));
        conditions.extend(room_condition(data, &law, &gains));
        conditions.extend(too_large_a_sum(data, &law));
        if !law.delayed {
            conditions.extend(energy::conditions(data, witness));
        }
        conditions.extend(match gains.has_energy() {
            true => energy::existence_conditions(data, &bounds, &origin, &gains, &squares),
            false => existence_conditions(data, &bounds, &origin, &gains, &squares),
        });
        let [dist_x, dist_e, dist_z] = claimed_distances(data, &witness.set, [&size.x_per, &size.e_per, &z]);
        let (mut start, exit) = level_condition(data, [&dist_x, &dist_e, &dist_z], [&d_x, &d_e, &w_x, &eta]);
        let with_gain = [&sigma, &law.gain];
        // With a delay u = -sigma et + K M'N R^2 zeta_last.
        let predicted = law.delayed.then(|| gains.largest_prediction(&law, &sigma, &size.forcing));
        let by_parts = control::by_parts(data, with_gain, [predicted.as_ref().unwrap_or(&size.e_per), &z]);
        if law.delayed {
            let y_per = gains.largest_mean(&size.forcing);
            start = start + delay::stored(&law.step, &gm, [&y_0, &y_per]);
        }
        // At the gain b the weight of zeta is b eta: the square is convex in b, so that it is largest at an end.
        let of_past = law.delayed.then(|| control::of_past(with_gain, [&law.step, &law.weight_sum], &gm));
        let reach =
            |eta: &Enclosure, start: &Enclosure| control::reach(data, with_gain, eta, (start, of_past.as_ref()));
        let reach = match &data.input_gain {
            None => reach(&eta, &start),
            Some(InputGain { low, high }) => {
                let least = &start - &eta * (high - low) * dist_z.sqr();
                reach(&(low * &eta), &least).max(&reach(&(high * &eta), &start))
            }
        };
        let answer = law.answer(&sigma, &data.period, &gains.means);
        let nominal = data.spec.input_gain.as_ref().map(|gain| gain.nominal.enclose(data.precision));
        let control = Control { steady: answer.steady(&origin, &size.forcing, &by_parts), transient: reach.transient }
            .over(nominal.as_ref());
        let peak = &size.e_per + reach.error;
        if law.delayed {
            conditions.extend(delay::conditions(data, witness, &law));
        }
        conditions.push(match law.delayed {
            false => Condition::less("C4", level_words(data), start, exit),
            true => Condition::less("C4d", format!("gm h (Y_0 + y_per)^2 + {}", level_words(data)), start, exit),
        });
        match matrix_inequality::proved_for(data, witness).filter(|_| !law.delayed) {
            Some(inequality) => conditions.extend(matrix_inequality::conditions(data, inequality, &error_box)),
            None => {
                conditions.extend(one_sided(data, witness.paths.q.place_of_de(), &error_box.sector_at));
                conditions.extend(form_conditions(data, &forms, if law.delayed { "C5d" } else { "C5h" }));
            }
        }
        conditions.extend(control.condition(data));
        SampledEvaluation { product, law, bounds, size, z, error_box, forms, control, peak, conditions }
    }

    /// Bounds of rms(e) and sup|e| along the periodic solution with n_o oscillators, for each n_o < N_s/2, from 0 on (derivation, 12.2).
    ///
    /// Hypotheses: the evaluation is that of the witness at the precision of `data`, and is proved. Guarantee: they hold for this sigma and h,
    /// between samples too, and do not increase with n_o up to rounding.
    #[must_use]
    pub fn errors(&self, data: &Data<'_>, witness: &SampledWitness) -> Vec<ErrorBounds> {
        let (sigma, origin) = (data.rational(&witness.sigma), AtOrigin::new(data));
        let known = if self.law.delayed { None } else { energy::proved(data, &origin, witness) };
        let e_per = &self.size.e_per;
        let gains = SampledGains::new(&self.law, &sigma, &data.period).with_energy(known);
        gains.by_count(&self.law, &sigma, |gains| {
            let response = gains.response(&origin, &self.size.forcing);
            let [rms, sup] = [response.rms, response.sup].map(|bound| e_per.min(&bound).ceiling());
            ErrorBounds { rms, sup }
        })
    }

    /// The truth of all conditions together.
    #[must_use]
    pub fn truth(&self) -> Truth {
        condition::all(&self.conditions)
    }
}

/// All numbers of a witness are positive; k1 may be 0.
fn signs(data: &Data<'_>, witness: &SampledWitness) -> Vec<Condition> {
    let named = [
        ("sigma", &witness.sigma),
        ("gain", &witness.law.gain),
        ("X_p", &witness.x_p),
        ("E_p", &witness.e_p),
        ("r_x", &witness.r_x),
        ("r_e", &witness.r_e),
        ("r_d", &witness.r_d),
        ("D_x", &witness.d_x),
        ("D_e", &witness.d_e),
        ("w_x", &witness.w_x),
        ("h", &witness.eta),
        ("k0", &witness.k0),
    ];
    let mut conditions = sign_conditions(data, &named);
    if witness.k1 < 0 {
        conditions.push(Condition::at_most("sign", "0 <= k1", data.zero(), data.rational(&witness.k1)));
    }
    conditions
}

/// (S0): the law is one of section 12, for the mu of the specification.
fn law_conditions(data: &Data<'_>, law: &SampledLaw<Enclosure>, product: &Enclosure) -> Vec<Condition> {
    let one = Enclosure::one(data.precision);
    let two = Enclosure::from_integer(2, data.precision);
    let (times, load) = match law.delayed {
        true => ("3 ", law.load() * Enclosure::from_integer(3, data.precision)),
        false => ("", law.load()),
    };
    let gain = if law.input_gain.is_some() { "b_hi K" } else { "K" };
    vec![
        Condition::at_most("S0", "h sigma <= 1", product.clone(), one),
        Condition::at_most("S0b", "Nbar^2 <= weight_sum", data.n_bar_squared.clone(), law.weight_sum.clone()),
        Condition::less("S0c", format!("{times}{gain} h weight_sum < 2"), load, two),
        Condition::at_most(
            "S0d",
            "|K (1 + theta) - mu| <= mu/10^6",
            (&law.nominal_mu - &data.mu).abs(),
            &data.mu / Enclosure::from_integer(i64::from(SAME_MU), data.precision),
        ),
    ]
}

/// With an input gain every harmonic has an answer, and a bound: no denominator vanishes. Told where it is not proved, and without it
/// nothing that a periodic solution needs is.
fn room_condition(data: &Data<'_>, law: &SampledLaw<Enclosure>, gains: &SampledGains<Enclosure>) -> Option<Condition> {
    let what = if law.delayed {
        "0 < 1/(1+th1) - |1-b| sigma/|D_j| for every harmonic j, b = b_lo and b_hi"
    } else {
        "0 < 1/(1+theta) - (1-b) sigma Re D_j/|D_j|^2 for every harmonic j, b = b_lo and b_hi"
    };
    let condition = Condition::less("S0e", what, data.zero(), gains.room.clone()?);
    (!condition.truth().is_true()).then_some(condition)
}

/// Nb2 <= Nbar^2 (1 + 1/10^6), told where it is not proved: a larger sum would let a smaller K pass for the mu that is asked for.
fn too_large_a_sum(data: &Data<'_>, law: &SampledLaw<Enclosure>) -> Option<Condition> {
    let one = Enclosure::one(data.precision);
    let room = &one + &one / Enclosure::from_integer(i64::from(SAME_MU), data.precision);
    let what = "weight_sum <= Nbar^2 (1 + 1/10^6)";
    let condition = Condition::at_most("S0b", what, law.weight_sum.clone(), &data.n_bar_squared * room);
    (!condition.truth().is_true()).then_some(condition)
}

/// (S1) of 10.3, and (S2) of 12.2.
fn existence_conditions(
    data: &Data<'_>,
    bounds: &SetBounds<Enclosure>,
    origin: &AtOrigin<Enclosure>,
    gains: &SampledGains<Enclosure>,
    squares: &MeanSquares<Enclosure>,
) -> Vec<Condition> {
    let response = gains.response(origin, &Forcing::new(bounds, origin, squares));
    let sup = response.sup.min(&sup_by_mean_squares(data, squares));
    let least = [
        ("(c/a_1) b_fe r_e".to_owned(), bounds.x_rms(squares)),
        ("sup|e|".to_owned(), sup),
        ("rms(e)".to_owned(), response.rms),
        ("rms(e')".to_owned(), response.rate_rms),
    ];
    bounds.existence(data, squares, Relation::LessOrEqual, least)
}

/// (C5h), with a delay (C5d).
fn form_conditions(data: &Data<'_>, forms: &DecayForms<Enclosure>, id: &'static str) -> Vec<Condition> {
    let positive = |what: String, value: Enclosure| Condition::less(id, what, data.zero(), value);
    let mut conditions = vec![positive("0 < 1 - h k_e/pi".to_owned(), forms.within.clone())];
    for (name, form) in [("Q_0", &forms.start), ("Q_h", &forms.end)] {
        let minors = form.minors().into_iter().zip(1..);
        conditions.extend(minors.map(|(minor, index)| positive(format!("0 < minor {index} of {name}"), minor)));
    }
    conditions
}
