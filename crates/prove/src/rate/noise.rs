//! Bounds of what noise and a disturbance do to the error, for some oscillators and one gain (derivation, section 13.6, Proposition N).
//!
//! What is measured is e + v, and d is added to q: any measurable signals with |v| <= v_bar, |d| <= d_bar. (N) is the form of
//! [`sigmastar_decide::rates::inequality`] with these inputs and lam > 0 for the rate, positive definite at the corners, with Pi >= diag(e_low, 0). With
//! `S^2 = (g_d d_bar^2 + g_v v_bar^2)/(2 lam e_low)` and L_0 the left side of C4,
//!
//! - the limit superior of |e - e_per| is at most S, and |e - e_per| <= sqrt(L_0) + S at all times from the start on,
//! - if `sqrt(L_0) + S < D_e` and `(sqrt(L_0/w_x) + kappa S)/sqrt(P_low) < D_x`, `kappa = sqrt(P_up) k_f/a_2`, `a_2 > 0`.
//!
//! Why: while it is in the error box the solution solves a linear system whose slopes are averages of derivatives, of which C5 and (N) speak.
//! (Where the regulator starts with z = M (e + v), zeta is M v then, and L_0 is with `dZ + Nbar v_bar` in the place of dZ.)
//! One part of it has the start and no inputs: U stays below L_0, and W tends to 0. The other starts at 0 and has the inputs: W stays below
//! e_low S^2, and xi below kappa S. Their sum is strictly inside of the box, so the solution never leaves it.

use super::bound::{DIGITS, Loop, Place, up};
use super::control::{RateForm, of_noise};
use rug::Rational;
use sigmastar_decide::rates::OscillatorMatrix;
use sigmastar_decide::rates::inequality::{ErrorDynamics, LoopBounds, RateWitness, is_above};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_f64, write_exact};
use sigmastar_propose::rates::NoiseProposal;
use sigmastar_propose::rates::noise_search::propose;
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::stability::ErrorBox;

/// Shares of the searched decay that are claimed, in this order: what is left makes the form definite.
const SHARES: [f64; 3] = [0.99, 0.9, 0.6];

/// What keeps the undisturbed solutions in the error box: C4 with its numbers.
pub struct Confinement<'a> {
    /// L_0, the left side of C4; of an aligned start that where the e that is measured has noise.
    pub level: Enclosure,
    /// w_x.
    pub w_x: &'a Rational,
    /// D_x, D_e.
    pub radii: [&'a Rational; 2],
    /// Z + sqrt(L_0/h), h the weight of |zeta|_N^2 in U, with an input gain the least one: |zeta|_N is below it without inputs.
    pub zeta: Enclosure,
}

/// What proves (N) in continuous time.
#[derive(Clone, Debug)]
pub struct NoiseByForm {
    /// lambda as the rate, and what proves (N).
    pub witness: RateWitness,
    /// Whether x counts in W.
    pub has_x: bool,
}

/// Bounds for some oscillators, proved by a P.
#[derive(Clone, Debug)]
pub struct NoiseBound<P> {
    /// What proves (N), or the form with inputs at samples.
    pub proof: P,
    /// e_low: `Pi > diag(e_low, 0)`.
    pub e_low: Rational,
    /// S, rounded up, in the unit of e.
    pub limit: Rational,
    /// `sqrt(L_0) + S`, rounded up, in the unit of e.
    pub peak: Rational,
    /// What an aligned start adds to |e - e_per|, as it aligns to the e that is measured ([`RateForm`]), between samples too, in the unit of e.
    pub misled: Rational,
    /// What is added to what is put out at all times, by an aligned start too; none where no bound of it is proved.
    pub control: Option<Rational>,
}

/// Why there are no such bounds. It says nothing about the loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoNoiseBound {
    /// The document has an `actuator`: the bound of the control that keeps to it knows no noise.
    Actuator,
    /// The document has an `actuator`, and its law is computed in doubles: the bound of the control that keeps to the actuator knows neither
    /// noise nor rounding.
    ActuatorInDoubles,
    /// No rate was proved, which a claim has beside.
    NoRate,
    /// The claim rests on the derivatives of a plant, and has no norms of the error system.
    ByMatrices,
    /// No Pi was found for (N).
    NotFound,
    /// With the least S that was found the error box is too small; estimates.
    LeavesBox {
        /// S.
        limit: f64,
        /// How many times as large the box would have to be.
        needed: f64,
    },
    /// The rounding of a law in doubles is not bounded: a number of it is too small or too large for a count of roundings.
    BeyondDoubles {
        /// Which one.
        what: &'static str,
        /// About its size, or the bound of it.
        size: f64,
    },
    /// What rounding adds grows with the state, and faster than the loop takes it away.
    RoundingGrows,
}

impl NoNoiseBound {
    /// The reason in words.
    #[must_use]
    pub fn message(self) -> String {
        match self {
            NoNoiseBound::Actuator => {
                "not with an `actuator`: its bound of the control does not know the noise".to_owned()
            }
            NoNoiseBound::ActuatorInDoubles => {
                "not with an `actuator`: its bound of the control knows neither noise nor the rounding of the law".to_owned()
            }
            NoNoiseBound::NoRate => "not proved, as no rate is".to_owned(),
            NoNoiseBound::ByMatrices => {
                "not for a claim by a matrix inequality: it is proved from norms of the error system; a bounding specification of the plant \
                 (`sigmastar bound`) has them"
                    .to_owned()
            }
            NoNoiseBound::NotFound => "not proved: no Pi was found".to_owned(),
            NoNoiseBound::LeavesBox { limit, .. } => format!(
                "not proved: noise and disturbances may move e by about {}, more than the proved region allows; less of them, fewer oscillators, a \
                 larger gain (which lets more of the noise through) or a larger domain may help",
                shown(limit)
            ),
            NoNoiseBound::BeyondDoubles { what, size } => format!(
                "not proved: {what} may be {size:e}, and rounding is counted of constants from 2^-900 to 2^900 and of signals below 2^1000; \
                 other units may serve"
            ),
            NoNoiseBound::RoundingGrows => {
                "not proved: what rounding adds in a sample may be more than the loop takes away in it; a longer sampling period, or larger weights"
                    .to_owned()
            }
        }
    }
}

/// A number for words, to four digits.
fn shown(value: f64) -> String {
    round_f64(value, 4, Direction::Up).as_ref().map_or_else(|| value.to_string(), write_exact)
}

/// The best bounds that are found.
///
/// Guarantee: with these oscillators at the gain of `place`, every input gain of the data, and any measurable inputs within the bounds of the
/// specification, every solution from a start within the distances of `place` has `|e(t) - e_per(t)| <= peak` at all times from the start on and
/// a limit superior of that of at most `limit`, e_per being of the periodic solution without inputs; whoever the plant is of which the bounds of
/// the error box hold.
///
/// # Errors
/// What was not found or not proved.
pub fn noise_bound(
    data: &Data<'_>,
    place: &Place<'_>,
    confinement: &Confinement<'_>,
    rate: &RateForm<'_>,
) -> Result<NoiseBound<NoiseByForm>, NoNoiseBound> {
    if data.spec.actuator.is_some() {
        return Err(NoNoiseBound::Actuator);
    }
    let bounds = LoopBounds::of_error(data, place.error_box).ok_or(NoNoiseBound::NotFound)?;
    let oscillators = OscillatorMatrix::new(data, rate.oscillators);
    let dynamics = ErrorDynamics::new(data, &oscillators, place.sigma, &bounds);
    let sizes = [data.spec.d_bar(), data.spec.v_bar()];
    let proposal = propose(&dynamics, sizes.each_ref().map(Rational::to_f64)).ok_or(NoNoiseBound::NotFound)?;
    let (witness, e_low) = proved(&dynamics, &proposal, data.precision, |_| true).ok_or(NoNoiseBound::NotFound)?;
    let s = (data.rational(&level(&witness, &sizes)) / data.rational(&e_low)).sqrt();
    let [limit, peak] = within_the_box(data, place.error_box, confinement, &s)?;
    let v_bar = data.rational(&sizes[1]);
    let misled = rate.misled(data, &v_bar);
    let of_inputs = (&witness.pi[..], &(data.rational(&level(&witness, &sizes)).sqrt()));
    let directly = [&dynamics.noise_gain(), &v_bar, &data.zero()];
    let control = of_noise(data, &dynamics.control(), of_inputs, (rate, &misled), directly);
    let misled = up(&(misled / data.rational(rate.e_low).sqrt())).ok_or(NoNoiseBound::NotFound)?;
    Ok(NoiseBound { proof: NoiseByForm { witness, has_x: bounds.has_x }, e_low, limit, peak, misled, control })
}

/// A witness with inputs and e_low of a proposal, both proved, of whose Pi something else is true besides.
pub(super) fn proved<L: Loop>(
    of: &L,
    proposal: &impl NoiseProposal<Witness = L::Witness>,
    precision: u32,
    besides: impl Fn(&[Vec<Rational>]) -> bool,
) -> Option<(L::Witness, Rational)> {
    let one = |share: f64, digits: u32| {
        let (witness, e_low) = proposal.in_digits(share, digits)?;
        let (pi, _) = of.parts(&witness);
        let holds = of.proves(&witness) && is_above(pi, &e_low, precision) && besides(pi);
        holds.then_some((witness, e_low))
    };
    SHARES.iter().find_map(|share| DIGITS.iter().find_map(|digits| one(*share, *digits)))
}

/// kappa, of `xi <= kappa sup|e|` for the part with the inputs.
pub(super) fn kappa(data: &Data<'_>, error_box: &ErrorBox<Enclosure>) -> Enclosure {
    data.p_up.sqrt() * &error_box.k_f / &error_box.rate
}

/// S and sqrt(L_0) + S, rounded up, where the sum of what the start and the inputs do is proved to stay in the error box.
///
/// # Errors
/// The box is too small for this S.
pub(super) fn within_the_box(
    data: &Data<'_>,
    error_box: &ErrorBox<Enclosure>,
    confinement: &Confinement<'_>,
    s: &Enclosure,
) -> Result<[Rational; 2], NoNoiseBound> {
    let number = |value: &Rational| data.rational(value);
    let peak = confinement.level.sqrt() + s;
    let [d_x, d_e] = confinement.radii.map(number);
    let of_x = ((&confinement.level / number(confinement.w_x)).sqrt() + kappa(data, error_box) * s) / data.p_low.sqrt();
    let decays = data.zero().lt(&error_box.rate).is_true();
    if !(decays && peak.lt(&d_e).is_true() && of_x.lt(&d_x).is_true()) {
        let needed = (&peak / d_e).max(&(of_x / d_x)).upper_f64();
        return Err(NoNoiseBound::LeavesBox { limit: s.upper_f64(), needed });
    }
    up(s).zip(up(&peak)).map(|(limit, peak)| [limit, peak]).ok_or(NoNoiseBound::NotFound)
}

/// e_low S^2, which W of the part with the inputs does not exceed.
fn level(witness: &RateWitness, sizes: &[Rational; 2]) -> Rational {
    let terms = witness.inputs.iter().zip(sizes).filter_map(|(weight, size)| {
        let square = Rational::from(size * size);
        weight.as_ref().map(|weight| square * weight)
    });
    terms.fold(Rational::new(), |sum, term| sum + term) / (Rational::from(&witness.rate * 2))
}

#[cfg(test)]
mod tests;
