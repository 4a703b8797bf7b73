//! What a loop in continuous time and one at samples have in common in floating point: a scalar condition, and numbers of a proof.

use super::diagonal;
use faer::Mat;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, Portable, round_f64};

/// The smallest share of the ceiling that is tried: a condition that fails there is taken to fail everywhere.
const TINY: f64 = 1e-9;

/// By what share the numbers of a bound under noise are off the best ones, to the safe side; and their digits.
const ROOM: f64 = 1e-3;
pub(super) const FIGURES: u32 = 6;

/// What keeps a rate from being larger, in floating point: an explanation, and no claim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit {
    /// The rate a_2 at which x decays in the error box.
    Plant(f64),
    /// The slowest eigenvalue of the loop with dq/de in the middle of its bounds, and without x.
    Oscillators(f64),
    /// The slowest eigenvalue of the loop with the first derivatives in the middle of what is known of them together.
    Middle(f64),
}

/// The scalar condition of some oscillators at one gain, under which some numbers prove a rate.
pub trait Condition {
    /// What a proof has beside Pi.
    type Numbers: Numbers;

    /// Steps of the bisection in the rate.
    const BISECTIONS: u32;

    /// The rates of the loop with the uncertain parts in the middle, and of x: from the smaller one on a rate is out of reach.
    fn ceilings(&self) -> [f64; 2];

    /// Whether a rate fulfils the condition.
    fn holds(&self, rate: f64) -> bool;

    /// Numbers for a share of the largest rate; Pi is that of a rate between them, which leaves room for a proof.
    fn propose(&self, largest: f64, share: f64) -> Option<Proposal<Self::Numbers>>;

    /// What the ceiling is set by.
    fn limit(&self) -> Limit {
        let [of_loop, of_x] = self.ceilings();
        if of_x <= of_loop { Limit::Plant(of_x) } else { Limit::Oscillators(of_loop) }
    }

    /// The largest rate of the condition, in 1/time; `None` where not even a tiny one fulfils it.
    fn largest_rate(&self) -> Option<f64> {
        let [of_loop, of_x] = self.ceilings();
        let ceiling = of_loop.min(of_x);
        // NaN and negative ceilings end here too.
        if !(ceiling > 0.0 && ceiling.is_finite() && self.holds(TINY * ceiling)) {
            return None;
        }
        let (mut low, mut up) = (TINY * ceiling, ceiling);
        for _ in 0..Self::BISECTIONS {
            let middle = f64::midpoint(low, up);
            if self.holds(middle) { low = middle } else { up = middle }
        }
        Some(low)
    }
}

/// What a proof has beside Pi, in doubles.
pub trait Numbers {
    /// The numbers of a proof.
    type Witness;

    /// Those with this Pi, to so many digits, without inputs; `None` where one is not finite.
    fn witness(&self, pi: Vec<Vec<Rational>>, digits: u32) -> Option<Self::Witness>;
}

/// The numbers of a proof in doubles.
#[derive(Clone, Debug)]
pub struct Proposal<N> {
    /// Pi.
    pub(super) pi: Mat<f64>,
    /// The rest.
    pub numbers: N,
}

impl<N: Numbers> Proposal<N> {
    /// The witness to so many digits, without inputs; `None` where a number is not finite.
    #[must_use]
    pub fn in_digits(&self, digits: u32) -> Option<N::Witness> {
        self.numbers.witness(in_digits(&self.pi, digits)?, digits)
    }

    /// e_low, e_up and z_up about Pi, rounded to the safe side, about the best for a start within these distances.
    #[must_use]
    pub fn diagonal_bounds(&self, distances: [&Enclosure; 3]) -> Option<[Rational; 3]> {
        diagonal::bounds(&self.pi, distances)
    }

    /// z_low and z_up of the block of zs in Pi, rounded to the safe side.
    #[must_use]
    pub fn zeta_bounds(&self) -> Option<[Rational; 2]> {
        diagonal::bounds_of_zeta(&self.pi)
    }
}

/// Numbers for a bound of what noise does.
pub trait NoiseProposal {
    /// The numbers of a proof.
    type Witness;

    /// The witness for a share of the proposed decay, with Pi to so many digits and inputs, and e_low; `None` where a number is not finite.
    fn in_digits(&self, share: f64, digits: u32) -> Option<(Self::Witness, Rational)>;
}

/// The lower triangle of Pi to so many digits, 0 where an entry is beyond those of its diagonal; `None` if one is not finite.
pub(super) fn in_digits(pi: &Mat<f64>, digits: u32) -> Option<Vec<Vec<Rational>>> {
    let least = 0.1f64.portable_powi(digits as i32 + 1);
    let entry = |i: usize, j: usize| {
        let small = pi[(i, j)].abs() < least * (pi[(i, i)] * pi[(j, j)]).sqrt();
        if small { Some(Rational::new()) } else { round_f64(pi[(i, j)], digits, Direction::Nearest) }
    };
    (0..pi.nrows()).map(|i| (0..=i).map(|j| entry(i, j)).collect()).collect()
}

/// A number that is a little larger.
pub(super) fn above(value: f64) -> Option<Rational> {
    round_f64(value * (1.0 + ROOM), FIGURES, Direction::Up)
}

/// A number that is a little smaller.
pub(super) fn below(value: f64) -> Option<Rational> {
    round_f64(value * (1.0 - ROOM), FIGURES, Direction::Down)
}
