//! From a rate to a bound of the error: `|e(t) - e_per(t)| <= C exp(-rate (t - t_0))` for every start in a set, with given oscillators at one
//! gain (derivation, section 13.6).
//!
//! With the W of [`sigmastar_decide::rates::inequality`], `Pi >= diag(e_low, 0)` and `Pi <= diag(e_up, z_up I)`,
//! `et(t)^2 <= W(t)/e_low <= exp(-2 rate (t - t_0)) W(t_0)/e_low` and `W(t_0) <= w P_up dX^2 + e_up dE^2 + z_up dZ^2` where
//! |xt| <= dX, |et| <= dE and |zt|_N <= dZ at t_0: so C^2 is that sum over e_low.

use rug::Rational;
use sigmastar_decide::rates::OscillatorMatrix;
use sigmastar_decide::rates::inequality::{ErrorDynamics, LoopBounds, RateWitness, is_definite};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_rational};
use sigmastar_lang::spec::Oscillators;
use sigmastar_propose::rates::{Condition, Limit, Numbers, SmallGain};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::stability::ErrorBox;
use sigmastar_theory::evidence::Slopes;

/// The largest number of oscillators, and the largest harmonic, of which a certificate has a rate.
pub const MAX_OSCILLATORS: u32 = 100;

/// The most numbers of oscillators and sets of harmonics of one certificate.
pub const MAX_COUNTS: usize = 8;

/// The most entries of the triangles of all Pi of one certificate, those of x left out: with six states and the most digits that are tried an
/// entry takes 38 bytes on a line of its own, and all of them less than the megabyte of which a document is read. One of [`MAX_OSCILLATORS`]
/// has 20,503.
pub const MAX_ENTRIES: usize = 24_000;

/// Shares of the largest rate that are claimed, in this order; nearer to it C would be large and the numbers long.
pub(super) const SHARES: [f64; 4] = [0.95, 0.8, 0.5, 0.2];

/// Digits of Pi that are tried.
pub(super) const DIGITS: [u32; 4] = [6, 9, 12, 16];

/// Digits of bounds.
const FIGURES: u32 = 6;

/// Where the error lives: what a claim by norms says of its error box, and from how far its solutions start.
pub struct Place<'a> {
    /// The gain of the claim, in 1/time.
    pub sigma: &'a Rational,
    /// The error box, which no solution from the set leaves at this gain.
    pub error_box: &'a ErrorBox<Enclosure>,
    /// dX, dE, dZ.
    pub distances: [&'a Enclosure; 3],
}

/// What proves a rate in continuous time.
#[derive(Clone, Debug)]
pub struct ByForm {
    /// What proves it.
    pub witness: RateWitness,
    /// Whether x counts in W.
    pub has_x: bool,
    /// What it has besides, where it is proved by matrices; Pi is one of (x, e, zs) then, and so are its bounds.
    pub by: Option<ByMatrices>,
}

/// What a bound has besides where it is proved from the derivatives themselves; it has no w and l then.
#[derive(Clone, Debug)]
pub struct ByMatrices {
    /// Q, G and H, of which (D) is proved: of all derivatives, or of those by x and by e apart.
    pub slopes: Vec<Slopes>,
    /// `Pi < diag(x_up I, e_up, z_up I)`; none without states.
    pub x_up: Option<Rational>,
}

/// A bound `|e - e_per| <= factor exp(-rate (t - t_0))` for some oscillators, proved by a P; of the regulator at samples at the sampling instants.
#[derive(Clone, Debug)]
pub struct RateBound<P> {
    /// The oscillators.
    pub oscillators: Oscillators,
    /// The rate, in 1/time; at samples exp(2 h rate) <= 1 + c.
    pub rate: Rational,
    /// What proves it.
    pub proof: P,
    /// e_low: `Pi >= diag(e_low, 0)`.
    pub e_low: Rational,
    /// e_up and z_up: `Pi <= diag(e_up, z_up I)`.
    pub upper: [Rational; 2],
    /// C, in the unit of e.
    pub factor: Rational,
    /// What limits the rate.
    pub limit: Limit,
}

impl<P> RateBound<P> {
    /// The same bound, with what is made of its proof.
    fn with<Q>(self, of: impl FnOnce(P) -> Q) -> RateBound<Q> {
        let RateBound { oscillators, rate, proof, e_low, upper, factor, limit } = self;
        RateBound { oscillators, rate, proof: of(proof), e_low, upper, factor, limit }
    }
}

/// The best bound that is found; `None` where nothing is proved.
///
/// Guarantee: for every solution that stays in the error box of `place` from a start within its distances, at its gain, with these
/// oscillators and every input gain of the data, `|e(t) - e_per(t)| <= factor exp(-rate (t - t_0))`, whoever the plant is of which the
/// bounds of the error box hold.
#[must_use]
pub fn bound(data: &Data<'_>, place: &Place<'_>, oscillators: &Oscillators) -> Option<RateBound<ByForm>> {
    let bounds = LoopBounds::of_error(data, place.error_box)?;
    let matrix = OscillatorMatrix::new(data, oscillators);
    let dynamics = ErrorDynamics::new(data, &matrix, place.sigma, &bounds);
    let proof = |witness| ByForm { witness, has_x: bounds.has_x, by: None };
    best(data, place, oscillators, &dynamics).map(|bound| bound.with(proof))
}

/// The loop of a claim by norms with some oscillators at one gain: in continuous time, or at samples.
pub(super) trait Loop {
    /// The numbers of a proof.
    type Witness;

    /// What says where to look for them.
    type Condition: Condition<Numbers: Numbers<Witness = Self::Witness>>;

    /// The condition in doubles; `None` where a number is not finite.
    fn condition(&self) -> Option<Self::Condition>;

    /// Whether the numbers prove their decay: that of [`ErrorDynamics::proves`], or of the loop at samples.
    fn proves(&self, witness: &Self::Witness) -> bool;

    /// The rate that they prove, in 1/time.
    fn rate(&self, witness: &Self::Witness) -> Option<Rational>;

    /// Their Pi, and w where x counts in W.
    fn parts<'w>(&self, witness: &'w Self::Witness) -> (&'w [Vec<Rational>], Option<&'w Rational>);
}

impl Loop for ErrorDynamics<'_> {
    type Witness = RateWitness;
    type Condition = SmallGain;

    fn condition(&self) -> Option<SmallGain> {
        SmallGain::new(self)
    }

    fn proves(&self, witness: &RateWitness) -> bool {
        ErrorDynamics::proves(self, witness)
    }

    fn rate(&self, witness: &RateWitness) -> Option<Rational> {
        Some(witness.rate.clone())
    }

    fn parts<'w>(&self, witness: &'w RateWitness) -> (&'w [Vec<Rational>], Option<&'w Rational>) {
        (&witness.pi, self.bounds.has_x.then_some(&witness.w))
    }
}

/// The best bound that is found of a loop; `None` where nothing is proved.
///
/// Guarantee: that of [`bound`], of what the loop is; at samples for starts and times that are sampling instants.
pub(super) fn best<L: Loop>(
    data: &Data<'_>,
    place: &Place<'_>,
    oscillators: &Oscillators,
    of: &L,
) -> Option<RateBound<L::Witness>> {
    let condition = of.condition()?;
    let largest = condition.largest_rate()?;
    SHARES.iter().find_map(|share| {
        let proposal = condition.propose(largest, *share)?;
        DIGITS.iter().find_map(|digits| {
            let witness = proposal.in_digits(*digits)?;
            let rate = of.rate(&witness)?;
            if !of.proves(&witness) {
                return None;
            }
            let [e_low, upper @ ..] = proposal.diagonal_bounds(place.distances)?;
            let [e_up, z_up] = &upper;
            let (pi, w) = of.parts(&witness);
            if !lies_between(pi, 0, &e_low, [&Rational::new(), e_up, z_up], data.precision) {
                return None;
            }
            // Where x does not count, W is without it.
            let of_x = w.map_or_else(|| data.zero(), |w| data.rational(w) * &data.p_up);
            let factor = factor(data, [of_x, data.rational(e_up), data.rational(z_up)], place.distances, &e_low)?;
            let oscillators = oscillators.clone();
            Some(RateBound { oscillators, rate, proof: witness, e_low, upper, factor, limit: condition.limit() })
        })
    })
}

/// Whether `diag(0, e_low, 0) < Pi < diag(x_up I, e_up, z_up I)` is proved of a Pi of (x, e, zs), with so many states in x; by its lower
/// triangle.
pub(super) fn lies_between(
    pi: &[Vec<Rational>],
    states: usize,
    e_low: &Rational,
    [x_up, e_up, z_up]: [&Rational; 3],
    precision: u32,
) -> bool {
    let number = |value: &Rational| Enclosure::from_rational(value, precision);
    let entry = |i: usize, j: usize| number(&pi[i.max(j)][i.min(j)]);
    let above = |i: usize, j: usize| match (i, j) == (states, states) {
        true => entry(i, j) - number(e_low),
        false => entry(i, j),
    };
    let below = |i: usize, j: usize| match i == j {
        true if i < states => number(x_up) - entry(i, j),
        true if i == states => number(e_up) - entry(i, j),
        true => number(z_up) - entry(i, j),
        false => entry(i, j).negate(),
    };
    is_definite(pi.len(), above) && is_definite(pi.len(), below)
}

/// C, rounded up: `C^2 = (x_up dX^2 + e_up dE^2 + z_up dZ^2)/e_low`.
pub(super) fn factor(
    data: &Data<'_>,
    upper: [Enclosure; 3],
    distances: [&Enclosure; 3],
    e_low: &Rational,
) -> Option<Rational> {
    let terms = upper.iter().zip(distances).map(|(upper, distance)| upper * distance.sqr());
    let start = terms.fold(data.zero(), |sum, term| sum + term);
    up(&(start / data.rational(e_low)).sqrt())
}

/// The upper end in few digits, rounded up.
pub(super) fn up(value: &Enclosure) -> Option<Rational> {
    value.upper_rational().map(|upper| round_rational(&upper, FIGURES, Direction::Up))
}
