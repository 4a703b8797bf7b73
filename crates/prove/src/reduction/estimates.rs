//! Sampled estimates in given coordinates.

use super::grid::{RATE, Values};
use sigmastar_propose::bounds::{
    Asked, Corners, EnergyAt, EnergyWeights, FloatSuprema, FloatWeights, Focus, MatrixArguments,
};

/// The points that are listed for each bound, where only the most extreme ones are looked at.
const EXTREME: usize = 6;

/// How densely suprema are sampled.
#[derive(Clone, Debug)]
pub enum Density {
    /// To find a gain at all.
    Rough,
    /// To compare coordinates.
    Coarse,
    /// To compare coordinates near some, at the points that are the most extreme ones there.
    Focused(Focus),
    /// For the coordinates that are taken; with the corners of the matrix inequality near a proposal, where it is sought.
    Fine(Option<Corners>),
}

/// Estimates for given coordinates, as functions of (X, E).
pub(super) struct Estimates {
    /// What samples them.
    pub(super) suprema: FloatSuprema,
    /// Where.
    pub(super) focus: Focus,
    /// r of the tube in these coordinates, which a ball of y around an orbit adds to X.
    pub(super) radius: f64,
    /// Whether there are no states.
    pub(super) stateless: bool,
}

impl Estimates {
    /// Of the bounds that are asked for.
    pub(super) fn bounds(&self, x: f64, e: f64, asked: Asked) -> Values {
        let mut values = self.suprema.survey(x + self.radius, e, &self.focus.places, asked);
        if self.stateless {
            // Without states every rate is as good as any other.
            values[RATE] = 1.0;
        }
        values
    }

    /// Of the threshold of the matrix inequality.
    pub(super) fn threshold(&self, at: MatrixArguments, weights: FloatWeights) -> f64 {
        self.suprema.least_sigma(at.beyond(self.radius), &self.focus, weights)
    }

    /// The points that are the most extreme ones on some `G(X, E)`, and of the matrix inequality.
    pub(super) fn extreme(&self, boxes: &[[f64; 2]], inequality: Option<(MatrixArguments, FloatWeights)>) -> Focus {
        let boxes: Vec<[f64; 2]> = boxes.iter().map(|[x, e]| [x + self.radius, *e]).collect();
        self.suprema.extreme(&boxes, EXTREME, inequality.map(|(at, weights)| (at.beyond(self.radius), weights)))
    }

    /// c_y of the matrix inequality of existence at points of `G(X, E)`, as functions of the threshold.
    pub(super) fn energy_at(&self, [x, e]: [f64; 2], weights: &EnergyWeights) -> Vec<EnergyAt> {
        self.suprema.energy_at([x + self.radius, e], &self.focus.places, weights)
    }

    /// Its free numbers on `G(X, E)` at a threshold.
    pub(super) fn propose_energy(&self, [x, e]: [f64; 2], value: f64) -> Option<EnergyWeights> {
        self.suprema.propose_energy([x + self.radius, e], value)
    }
}
