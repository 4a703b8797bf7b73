//! Formulas along the curve xb(t): their Taylor series on each cell of the period.

use super::cells::{Cells, Wave};
use super::taylor::{Taylor, TaylorAlgebra};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::expr::Walk;
use sigmastar_lang::spec::{Constant, TrigonometricVector};

/// The precision of the enclosures, in bits: cells lose a dozen of them, and a defect is some 40 below the terms.
pub(super) const PRECISION: u32 = 96;

/// The most harmonics of a curve, of a P and of q that are expanded.
pub const MAX_HARMONICS: usize = 1_000;

/// xb(t) over the cells of a period.
pub(super) struct Curve {
    pub(super) cells: Cells,
    pub(super) waves: Vec<Wave>,
    /// T.
    pub(super) period: Enclosure,
}

/// Rational coefficients as a wave.
pub(super) fn wave<'a>(mean: &Rational, harmonics: impl Iterator<Item = [&'a Rational; 2]>) -> Wave {
    let enclose = |value: &Rational| Enclosure::from_rational(value, PRECISION);
    Wave { mean: enclose(mean), harmonics: harmonics.map(|pair| pair.map(enclose)).collect() }
}

/// The components of a vector as waves.
pub(super) fn waves(vector: &TrigonometricVector) -> Vec<Wave> {
    let component = |i: usize| wave(&vector.mean[i], vector.harmonics.iter().map(|[a, b]| [&a[i], &b[i]]));
    (0..vector.mean.len()).map(component).collect()
}

impl Curve {
    /// The curve over `2^exponent` cells; `others` are waves that are to be expanded on them as well, all of them up to `order`.
    pub(super) fn new<'a>(
        waves: &'a [Wave],
        others: impl Iterator<Item = &'a Wave>,
        period: &Constant,
        exponent: u32,
        order: usize,
    ) -> Curve {
        let harmonics = waves.iter().chain(others).map(|wave| wave.harmonics.len()).max().unwrap_or(0);
        Curve {
            cells: Cells::new(exponent, PRECISION, harmonics, order),
            waves: waves.to_vec(),
            period: period.enclose(PRECISION),
        }
    }

    /// The states up to an order about the middle of a cell, and over it.
    pub(super) fn states(&self, cell: usize, order: usize) -> [Vec<Taylor>; 2] {
        let (mut middle, mut over) = (Vec::new(), Vec::new());
        for wave in &self.waves {
            let [about, all] = self.cells.expand(wave, cell, order);
            middle.push(about);
            over.push(all);
        }
        [middle, over]
    }

    /// The outputs of a walk at e = 0 along the given states, up to an order, about the middle of a cell and over it.
    pub(super) fn along(&self, walk: &Walk, cell: usize, states: &[Vec<Taylor>; 2], order: usize) -> [Vec<Taylor>; 2] {
        let time = self.cells.time(cell, &self.period);
        [0, 1].map(|which| {
            let mut algebra = TaylorAlgebra { time: &time[which], states: &states[which], order, precision: PRECISION };
            walk.evaluate(&mut algebra)
        })
    }

    /// Whether the outputs of a walk are proved to be smooth at e = 0 and every point of a box of times and states.
    pub(super) fn in_box(&self, walk: &Walk, time: &Enclosure, states: &[Enclosure]) -> bool {
        // The first coefficient of a series is defined only where the operations are smooth.
        let states: Vec<Taylor> = states.iter().map(|value| vec![value.clone()]).collect();
        let mut algebra = TaylorAlgebra { time: &vec![time.clone()], states: &states, order: 0, precision: PRECISION };
        walk.evaluate(&mut algebra).iter().flatten().all(Enclosure::is_defined)
    }
}
