//! Bounding functions in doubles between the nodes of a grid, for searches: smooth enough to minimise over, and evaluated
//! only where a search looks.

use sigmastar_exact::number::Portable;
use sigmastar_lang::spec::Bound;
use sigmastar_propose::bounds::Asked;
use sigmastar_propose::search::FloatBound;
use sigmastar_theory::evidence::TABLE;
use std::sync::{Arc, OnceLock};

/// The place of the rate in [`TABLE`].
pub const RATE: usize = 7;

/// The place of the rate of existence.
pub const RATE_EXISTENCE: usize = 8;

/// Estimates of all of [`TABLE`]; the last one is not a number without a P of existence at one (X, E).
pub type Values = [f64; TABLE.len()];

/// Linear interpolation between nodes at 0 and at `smallest ratio^k`, k = 0, 1, ...; beyond the last node nothing is known.
pub struct Grid<V> {
    source: Box<Make<V>>,
    /// The arguments of the nodes, X and E.
    axes: [Axis; 2],
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
        let axes = units.map(|unit| {
            let node = |k: i32| SMALLEST * unit * ratio.portable_powi(k);
            let within = (0..).map(node).take_while(|node| *node < LARGEST * unit * ratio);
            Axis::new(std::iter::once(0.0).chain(within).collect())
        });
        let nodes = empty(axes[0].nodes.len());
        Grid { source: Box::new(source), axes, nodes }
    }

    /// The first X and the first E of which nothing is known: the last nodes.
    fn ends(&self) -> [f64; 2] {
        self.axes.each_ref().map(|axis| axis.nodes.last().copied().unwrap_or(0.0))
    }

    /// What `value` says of the nodes, at (X, E).
    #[must_use]
    pub fn at(&self, [x, e]: [f64; 2], value: impl Fn(&V) -> f64) -> Option<f64> {
        let [xs, es] = &self.axes;
        let ((i, across), (j, along)) = (xs.cell(x)?, es.cell(e)?);
        // A node that has no part in it is not made.
        let between = |low: f64, high: &dyn Fn() -> f64, part: f64| match part {
            0.0 => low,
            part => low + (high() - low) * part,
        };
        let node = |i: usize, j: usize| value(self.node([i, j]));
        let row = |j: usize| between(node(i, j), &|| node(i + 1, j), across);
        Some(between(row(j), &|| row(j + 1), along))
    }

    fn node(&self, [i, j]: [usize; 2]) -> &V {
        let [xs, es] = &self.axes;
        let row = self.nodes[i].get_or_init(|| empty(es.nodes.len()));
        let place = &row[j];
        if let Some(node) = place.get() {
            return node;
        }
        // Not while the place waits for it: a thread that helps others in the meantime may come back to this very place.
        let made = Box::new((self.source)(xs.nodes[i], es.nodes[j]));
        place.get_or_init(|| made)
    }
}

/// The nodes of one argument, with where to look for it: a search looks some million times.
struct Axis {
    /// In increasing order, from 0.
    nodes: Vec<f64>,
    /// The node below the first number with these leading bits, of those from the first node that is not 0 on.
    below: Vec<usize>,
}

/// Doubles that agree in the bits from this one on, and are positive, are within an eighth of each other.
const LEADING: u32 = 52 - 3;

impl Axis {
    fn new(nodes: Vec<f64>) -> Axis {
        let leading = |node: Option<&f64>| node.map_or(0, |node| node.to_bits() >> LEADING);
        let all = leading(nodes.get(1))..=leading(nodes.last());
        let below = |bits: u64| {
            let first = f64::from_bits(bits << LEADING);
            nodes.partition_point(|node| *node <= first).saturating_sub(1)
        };
        Axis { below: all.map(below).collect(), nodes }
    }

    /// The node below an argument, and how far the argument is on the way to the next one.
    fn cell(&self, argument: f64) -> Option<(usize, f64)> {
        let smallest = self.nodes.get(1)?;
        let mut below = if argument >= *smallest {
            *self.below.get(((argument.to_bits() >> LEADING) - (smallest.to_bits() >> LEADING)) as usize)?
        } else if argument >= 0.0 {
            0
        } else {
            return None;
        };
        while self.nodes.get(below + 1).is_some_and(|node| *node <= argument) {
            below += 1;
        }
        let next = self.nodes.get(below + 1)?;
        Some((below, (argument - self.nodes[below]) / (next - self.nodes[below])))
    }
}

/// The bounds between the nodes of grids about the size `units` of (X, E), one for each group of them, as a search takes them; that of existence
/// where there is a P for it.
#[must_use]
pub fn functions(
    source: impl Fn(f64, f64, Asked) -> Values + Clone + Send + Sync + 'static,
    units: [f64; 2],
    ratio: f64,
    existence: bool,
) -> Vec<(Bound, FloatBound)> {
    let grids = Asked::GROUPS.map(|group| {
        let source = source.clone();
        Arc::new(Grid::new(move |x, e| source(x, e, group), units, ratio))
    });
    let function = |(index, bound): (usize, &Bound)| {
        let grid = grids[Asked::group(*bound)].clone();
        let ends = grid.ends();
        let at = move |x: f64, e: f64| grid.at([x, e], |values: &Values| values[index]).unwrap_or(f64::NAN);
        (*bound, FloatBound::Function { of: Arc::new(at), ends })
    };
    let wanted = |bound: &&Bound| existence || **bound != Bound::RateExistence;
    TABLE.iter().filter(wanted).enumerate().map(function).collect()
}

/// So many places with nothing in them.
fn empty<T, C: FromIterator<OnceLock<T>>>(count: usize) -> C {
    std::iter::repeat_with(OnceLock::new).take(count).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The cell is the one that a search in all nodes finds, at nodes and beside them, below 0 and beyond the last one.
    #[test]
    fn arguments_are_found_between_their_nodes() {
        for (unit, ratio) in [(1.0, 1.02), (3e-7, 1.6), (7e5, 2.5)] {
            let grid = Grid::new(|_, _| (), [unit; 2], ratio);
            let [axis, _] = &grid.axes;
            let beside = axis.nodes.iter().flat_map(|node| [node.next_down(), *node, node.next_up(), node * 1.01]);
            let last = axis.nodes[axis.nodes.len() - 1];
            for argument in beside.chain([f64::NAN, f64::INFINITY, 2.0 * last, 0.5 * unit * SMALLEST, 1e-300]) {
                let above = axis.nodes.partition_point(|node| *node <= argument);
                let known = above.checked_sub(1).filter(|_| above < axis.nodes.len() && !argument.is_nan());
                assert_eq!(axis.cell(argument).map(|(below, _)| below), known, "{argument} of {unit}, {ratio}");
            }
        }
    }

    /// Between nodes it is linear; nodes without a part in it are not made.
    #[test]
    fn what_has_no_part_is_not_made() {
        let grid = Grid::new(|x, e| if e > 0.0 { f64::NAN } else { 2.0 * x }, [1.0; 2], 1.6);
        let value = grid.at([0.3, 0.0], |value| *value);
        assert!(value.is_some_and(|value| (value - 0.6).abs() < 1e-12), "{value:?}");
        assert!(grid.at([0.3, 0.1], |value| *value).is_some_and(f64::is_nan));
    }
}
