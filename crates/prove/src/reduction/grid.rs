//! Bounding functions in doubles between the nodes of a grid, for searches: smooth enough to minimise over, and evaluated
//! only where a search looks.

use crate::search::FloatBound;
use sigmastar_exact::number::Portable;
use sigmastar_lang::spec::Bound;
use sigmastar_plants::bounds::{Asked, TABLE};
use std::sync::{Arc, OnceLock};

/// The place of the rate in [`TABLE`].
pub const RATE: usize = 7;

/// The place of the rate of existence.
pub const RATE_EXISTENCE: usize = 8;

/// Estimates of all of [`TABLE`]; the last one is not a number without a P of existence at one (X, E).
pub type Values = [f64; TABLE.len()];

/// A source of the estimates that are asked for at (X, E).
pub type Source = dyn Fn(f64, f64, Asked) -> Values + Send + Sync;

/// Linear interpolation between nodes at 0 and at `smallest ratio^k`, k = 0, 1, ...; beyond the last node nothing is known.
pub struct Grid<V> {
    source: Box<Make<V>>,
    /// The arguments of the nodes, X and E, in increasing order.
    arguments: [Vec<f64>; 2],
    /// A row for each X, made where a search looks: a fine grid has a million nodes. A node is a function of its place alone, so that it
    /// does not matter who computes it.
    nodes: Vec<OnceLock<Row<V>>>,
}

/// What makes a node.
type Make<V> = dyn Fn(f64, f64) -> V + Send + Sync;

/// The nodes of one X.
type Row<V> = Box<[OnceLock<Box<V>>]>;

/// The smallest node is this share of the unit.
const SMALLEST: f64 = 1e-4;

/// The largest node is at least so many units.
const LARGEST: f64 = 1e6;

impl<V> Grid<V> {
    /// A grid about the size `units` of (X, E).
    #[must_use]
    pub fn new(source: impl Fn(f64, f64) -> V + Send + Sync + 'static, units: [f64; 2], ratio: f64) -> Grid<V> {
        let arguments = units.map(|unit| {
            let node = |k: i32| SMALLEST * unit * ratio.portable_powi(k);
            let within = (0..).map(node).take_while(|node| *node < LARGEST * unit * ratio);
            std::iter::once(0.0).chain(within).collect::<Vec<f64>>()
        });
        let nodes = empty(arguments[0].len());
        Grid { source: Box::new(source), arguments, nodes }
    }

    /// What `value` says of the nodes, at (X, E).
    #[must_use]
    pub fn at(&self, [x, e]: [f64; 2], value: impl Fn(&V) -> f64) -> Option<f64> {
        let ((i, across), (j, along)) = (self.cell(0, x)?, self.cell(1, e)?);
        let between = |low: f64, high: f64, part: f64| low + (high - low) * part;
        let node = |i: usize, j: usize| value(self.node([i, j]));
        let low = between(node(i, j), node(i + 1, j), across);
        let high = between(node(i, j + 1), node(i + 1, j + 1), across);
        Some(between(low, high, along))
    }

    /// The node below an argument, and how far the argument is on the way to the next one.
    fn cell(&self, axis: usize, argument: f64) -> Option<(usize, f64)> {
        let nodes = &self.arguments[axis];
        let above = nodes.partition_point(|node| *node <= argument);
        let (below, next) = (above.checked_sub(1)?, nodes.get(above)?);
        Some((below, (argument - nodes[below]) / (next - nodes[below])))
    }

    fn node(&self, [i, j]: [usize; 2]) -> &V {
        let [xs, es] = &self.arguments;
        let row = self.nodes[i].get_or_init(|| empty(es.len()));
        row[j].get_or_init(|| Box::new((self.source)(xs[i], es[j])))
    }
}

/// The bounds between the nodes of grids about the size `units` of (X, E), one for each kind, as a search takes them; that of existence
/// where there is a P for it.
#[must_use]
pub fn functions(source: &Arc<Source>, units: [f64; 2], ratio: f64, existence: bool) -> Vec<(Bound, FloatBound)> {
    let grids = Asked::KINDS.map(|kind| {
        let source = source.clone();
        Arc::new(Grid::new(move |x, e| source(x, e, kind), units, ratio))
    });
    let function = |(index, bound): (usize, &Bound)| {
        let grid = grids[Asked::kind(*bound)].clone();
        let at = move |x: f64, e: f64| grid.at([x, e], |values: &Values| values[index]).unwrap_or(f64::NAN);
        (*bound, FloatBound::Function(Arc::new(at)))
    };
    let wanted = |bound: &&Bound| existence || **bound != Bound::RateExistence;
    TABLE.iter().filter(wanted).enumerate().map(function).collect()
}

/// So many places with nothing in them.
fn empty<T, C: FromIterator<OnceLock<T>>>(count: usize) -> C {
    std::iter::repeat_with(OnceLock::new).take(count).collect()
}
