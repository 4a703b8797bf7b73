//! Bounding functions in doubles between the nodes of a grid, for searches: smooth enough to minimise over, and evaluated
//! only where a search looks.

use crate::search::FloatBound;
use sigmastar_exact::number::Portable;
use sigmastar_lang::spec::Bound;
use sigmastar_plants::bounds::TABLE;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// The place of the rate in [`TABLE`].
pub const RATE: usize = 7;

/// The place of the rate of existence.
pub const RATE_EXISTENCE: usize = 8;

/// Estimates of all of [`TABLE`]; the last one is not a number without a P of existence at one (X, E).
pub type Values = [f64; TABLE.len()];

/// A source of estimates at (X, E).
pub type Source = dyn Fn(f64, f64) -> Values + Send + Sync;

/// Linear interpolation between nodes at 0 and at `unit ratio^k`, k = -`DEPTH`, ...; beyond the last node nothing is known.
pub struct Grid {
    source: Arc<Source>,
    units: [f64; 2],
    ratio: f64,
    nodes: Mutex<HashMap<[u16; 2], Values>>,
}

/// The smallest node is this share of the unit.
const SMALLEST: f64 = 1e-4;

/// The largest node is so many units.
const LARGEST: f64 = 1e6;

impl Grid {
    /// A grid about the size `units` of (X, E).
    #[must_use]
    pub fn new(source: Arc<Source>, units: [f64; 2], ratio: f64) -> Grid {
        Grid { source, units, ratio, nodes: Mutex::new(HashMap::new()) }
    }

    /// The interpolated functions as a search takes them; that of existence where there is a P for it.
    #[must_use]
    pub fn functions(self, existence: bool) -> Vec<(Bound, FloatBound)> {
        let grid = Arc::new(self);
        let function = |(index, bound): (usize, &Bound)| {
            let grid = grid.clone();
            (*bound, FloatBound::Function(Arc::new(move |x, e| grid.at(x, e)[index])))
        };
        let wanted = |bound: &&Bound| existence || **bound != Bound::RateExistence;
        TABLE.iter().filter(wanted).enumerate().map(function).collect()
    }

    /// Estimates at (X, E).
    fn at(&self, x: f64, e: f64) -> Values {
        let unknown = [f64::NAN; TABLE.len()];
        let (Some((i, across)), Some((j, along))) = (self.cell(x, self.units[0]), self.cell(e, self.units[1])) else {
            return unknown;
        };
        let corners = [[i, j], [i + 1, j], [i, j + 1], [i + 1, j + 1]].map(|node| self.node(node));
        std::array::from_fn(|k| {
            let [a, b, c, d] = corners.each_ref().map(|values| values[k]);
            let (low, high) = (a + (b - a) * across, c + (d - c) * across);
            low + (high - low) * along
        })
    }

    /// The node below an argument, and how far the argument is on the way to the next one.
    fn cell(&self, argument: f64, unit: f64) -> Option<(u16, f64)> {
        let steps = (argument / (SMALLEST * unit)).portable_ln() / self.ratio.portable_ln();
        let below = if steps < 0.0 { 0 } else { 1 + steps.floor() as u16 };
        if !(argument >= 0.0 && argument < LARGEST * unit) {
            return None;
        }
        let (low, high) = (self.argument(below, unit), self.argument(below + 1, unit));
        Some((below, ((argument - low) / (high - low)).clamp(0.0, 1.0)))
    }

    fn argument(&self, index: u16, unit: f64) -> f64 {
        if index == 0 { 0.0 } else { SMALLEST * unit * self.ratio.portable_powi(i32::from(index) - 1) }
    }

    fn node(&self, [i, j]: [u16; 2]) -> Values {
        let known = |nodes: &HashMap<[u16; 2], Values>| nodes.get(&[i, j]).copied();
        // A node is a function of its index alone, so that it does not matter who computes it.
        if let Some(values) = known(&self.nodes.lock().unwrap_or_else(PoisonError::into_inner)) {
            return values;
        }
        let values = (self.source)(self.argument(i, self.units[0]), self.argument(j, self.units[1]));
        self.nodes.lock().unwrap_or_else(PoisonError::into_inner).insert([i, j], values);
        values
    }
}
