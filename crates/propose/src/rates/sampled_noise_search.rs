//! Pi for the bounds of noise and disturbances at samples, in floating point: the largest one of the condition with inputs, where what it lets
//! through is about least. Nothing here is a claim.

use super::diagonal::largest_of_zeta;
use super::least::{Point, Thoroughness, least};
use super::proposal::{Condition, NoiseProposal, Proposal, above, below};
use super::sampled_condition::{SampledCondition, SampledNumbers};
use faer::linalg::solvers::DenseSolveCore;
use rug::Rational;
use sigmastar_decide::rates::at_samples::{Inputs, SampledDynamics, SampledRateWitness};

/// What is given away of what the scalar condition leaves over, tried in turn: g_r falls with it.
const SLACKS: [f64; 3] = [0.003, 0.05, 0.3];

/// Steps of a search in the rate, in the size of the inputs, and in their ratio.
const STEPS: [usize; 3] = [12, 8, 8];

/// The numbers of a proof.
pub struct ForInputs {
    proposal: Proposal<SampledNumbers>,
    inputs: Inputs<f64>,
    /// 1 over the first entry of the inverse of Pi.
    e_low: f64,
    /// s^2.
    square: f64,
}

/// The sizes of the inputs.
#[derive(Clone, Copy)]
pub struct Strengths {
    /// Of d, of which rounding is a part, and of v.
    pub sizes: [f64; 2],
    /// Of D, and c_d d_bar.
    pub of_d: [f64; 2],
    /// dz, where the law rounds.
    pub moved: Option<f64>,
}

/// Numbers with about the least s: over the rate, the size of the inputs, with both over their ratio, and what is given away. `None` where none
/// are found.
#[must_use]
pub fn propose(dynamics: &SampledDynamics<'_>, strengths: Strengths) -> Option<ForInputs> {
    let condition = SampledCondition::new(dynamics)?;
    let largest = condition.largest_rate()?;
    let solve = |point: Point, slack: f64| {
        let rate = point.rate(largest);
        let multipliers = condition.multipliers(rate, slack)?;
        let Strengths { sizes: [d, v], of_d: [of_d, within], moved } = strengths;
        let [gam_d, gam_v] = point.weights(multipliers.room, strengths.sizes, condition.noise_gain);
        let system = condition.disturbed(rate, &multipliers, [gam_d, gam_v]);
        let pi = system.largest()?;
        let first = pi.partial_piv_lu().inverse()[(0, 0)];
        let inputs = Inputs {
            g_d: (d > 0.0).then_some(1.0 / gam_d),
            g_v: (v > 0.0).then_some(1.0 / gam_v),
            g_r: (within > 0.0 && multipliers.of_x.is_some()).then_some(multipliers.g_r),
        };
        let weighed = |weight: Option<f64>, size: f64| weight.map_or(0.0, |weight| weight * size * size);
        let level = weighed(inputs.g_d, of_d) + weighed(inputs.g_v, v) + weighed(inputs.g_r, within);
        let c = condition.c(rate);
        let square = match moved {
            None => level * first / c,
            Some(moved) => {
                let moved = largest_of_zeta(&pi)?.sqrt() * moved;
                let root = (moved * (1.0 + c) + (moved * moved * (1.0 + c) + c * level).sqrt()) / c;
                root * root * first
            }
        };
        let proposal = Proposal { pi, numbers: multipliers.numbers(c) };
        (square.is_finite() && square > 0.0).then_some(ForInputs { proposal, inputs, e_low: 1.0 / first, square })
    };
    let order = condition.order();
    let thoroughness = Thoroughness { order, steps: STEPS, fewer: 3, last: 6.0, slacks: &SLACKS };
    least(&thoroughness, strengths.sizes, solve, |found| found.square)
}

impl ForInputs {
    /// z_low and z_up of the block of zs in Pi, rounded to the safe side.
    #[must_use]
    pub fn zeta_bounds(&self) -> Option<[Rational; 2]> {
        self.proposal.zeta_bounds()
    }
}

impl NoiseProposal for ForInputs {
    type Witness = SampledRateWitness;

    fn in_digits(&self, share: f64, digits: u32) -> Option<(SampledRateWitness, Rational)> {
        let Proposal { pi, numbers } = &self.proposal;
        let scaled = Proposal { pi: pi.clone(), numbers: SampledNumbers { c: numbers.c * share, ..numbers.clone() } };
        let weight = |weight: Option<f64>| match weight {
            None => Some(None),
            Some(weight) => above(weight).map(Some),
        };
        let Inputs { g_d, g_v, g_r } = self.inputs;
        let inputs = Inputs { g_d: weight(g_d)?, g_v: weight(g_v)?, g_r: weight(g_r)? };
        let witness = SampledRateWitness { inputs, ..scaled.in_digits(digits)? };
        let e_low = below(self.e_low).filter(|e_low| *e_low > 0)?;
        Some((witness, e_low))
    }
}
