//! Sampled suprema of a plant's derivatives as a search takes them.

use super::cells::Cells;
use super::estimates::{Density, Estimates};
use super::grid::Values;
use super::tube::TubeOfFamily;
use super::watch::Watch;
use nalgebra::DMatrix;
use rug::Rational;
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::model::Constant;
use sigmastar_lang::spec::{Bound, PeriodicMatrix};
use sigmastar_propose::bounds::{Asked, FloatSuprema, Focus, Places};
use sigmastar_propose::orbit::lower_triangular;
use sigmastar_propose::search::FloatModel;
use sigmastar_theory::evidence::TABLE;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Significant digits of a P of existence.
const DIGITS: u32 = 4;

/// Those of L, in turn, until no more than this share of the rate and of the norms on the orbit is lost.
const DIGITS_OF_L: [u32; 4] = [4, 6, 9, 14];
const LOST: f64 = 1e-3;

/// An entry of L that is a smaller share of its row is 0.
const NEGLIGIBLE: f64 = 1e-9;

/// The share of the changes along the axes that a rotation of y must leave at most.
const WORTH_A_TURN: f64 = 0.9;

/// The suprema along one orbit, for any coordinates.
pub(super) struct Sampling<'a> {
    pub(super) plant: &'a Plant,
    pub(super) cells: &'a Cells,
    /// The model, but for what depends on the coordinates.
    pub(super) model: &'a FloatModel,
    /// Who hears of the stages.
    pub(super) watch: &'a dyn Watch,
    /// What proofs are about beside the orbits.
    pub(super) tube: TubeOfFamily,
    /// In the coordinates x themselves.
    plain: FloatSuprema,
    /// Of |e|.
    unit_e: f64,
    /// X_0 and E_0 that were asked for; 0 where none was.
    asked: [f64; 2],
    /// How many candidates were looked at.
    tried: AtomicUsize,
}

impl<'a> Sampling<'a> {
    /// The ordinary size of e is what q makes of it over a period, or the initial set.
    pub(super) fn new(
        plant: &'a Plant,
        cells: &'a Cells,
        model: &'a FloatModel,
        watch: &'a dyn Watch,
        tube: TubeOfFamily,
    ) -> Sampling<'a> {
        let n = plant.states();
        let known = model.q_0.as_ref();
        let squares = known.map_or(1.0, |known| known.harmonics.iter().map(|c| c * c).sum());
        let [x_0, e_0] = model.set.given().map(|size| size.copied().unwrap_or(0.0));
        let by_forcing = 0.1 * squares.sqrt() * model.period;
        let unit_e = [e_0, by_forcing].into_iter().fold(0.0, f64::max);
        let plain = FloatSuprema::of_cells(plant, cells.in_doubles(), rows(&DMatrix::identity(n, n)), [None; 2]);
        Sampling {
            plant,
            cells,
            model,
            watch,
            tube,
            plain,
            unit_e: if unit_e > 0.0 { unit_e } else { 1.0 },
            asked: [x_0, e_0],
            tried: AtomicUsize::new(0),
        }
    }

    /// The suprema along the orbit with what is proved of the tube in the coordinates that are taken.
    pub(super) fn with_tube(&self, tube: TubeOfFamily) -> Sampling<'a> {
        let tried = AtomicUsize::new(self.tried.load(Ordering::Relaxed));
        Sampling { plain: self.plain.clone(), tube, tried, ..*self }
    }

    /// One more candidate is looked at: tells who waits.
    pub(super) fn count(&self) {
        self.watch.tried(self.tried.fetch_add(1, Ordering::Relaxed) + 1);
    }

    /// Whether the derivatives depend on the states or on the error: else all paths are one.
    pub(super) fn varies(&self) -> bool {
        self.plain.varies()
    }

    /// Ordinary sizes of |y| and |e|.
    pub(super) fn units(&self, l: &DMatrix<f64>) -> [f64; 2] {
        let values = self.estimates(l, [None; 2], &Density::Rough).bounds(0.0, 0.0, Asked::ALL);
        let of = |bound| TABLE.iter().position(|kind| *kind == bound).map_or(0.0, |at| values[at]);
        let (rate, f_e) = (of(Bound::Rate), of(Bound::Fe));
        let size = f_e / rate * self.unit_e;
        let size = if size.is_finite() { size.max(self.asked[0]) } else { self.asked[0] };
        [if size > 0.0 { size } else { 1.0 }, self.unit_e]
    }

    /// The sampler for these coordinates: with P, which is the identity without one, and that of existence.
    pub(super) fn suprema(&self, l: &DMatrix<f64>, [p, second]: [Option<&PeriodicMatrix>; 2]) -> FloatSuprema {
        let identity = identity(l.nrows());
        let matrices = [Some(p.unwrap_or(&identity)), second];
        if matrices.into_iter().flatten().all(|matrix| matrix.harmonics.is_empty()) {
            return self.plain.in_coordinates(rows(l), matrices);
        }
        FloatSuprema::of_cells(self.plant, self.cells.in_doubles(), rows(l), matrices)
    }

    /// The suprema in these coordinates at so many points, about the tube.
    pub(super) fn estimates(
        &self,
        l: &DMatrix<f64>,
        matrices: [Option<&PeriodicMatrix>; 2],
        density: &Density,
    ) -> Estimates {
        let grid = |stride: usize| Focus { places: Places::Stride(stride), corners: None };
        let focus = match density {
            Density::Rough => grid(6),
            Density::Coarse => grid(3),
            Density::Focused(focus) => focus.clone(),
            Density::Fine(corners) => Focus { corners: corners.clone(), ..grid(1) },
        };
        let (radius, stateless) = (self.tube.radius_in(l), l.nrows() == 0);
        Estimates { suprema: self.suprema(l, matrices), focus, radius, stateless }
    }

    /// The model with the initial set and the domain in the norm of y.
    pub(super) fn in_frame(&self, l: &DMatrix<f64>, mut model: FloatModel) -> FloatModel {
        let values = if l.nrows() == 0 { None } else { Some(l.singular_values()) };
        let (largest, smallest) = values.map_or((1.0, 1.0), |values| (values.max(), values.min()));
        if let Some(ball) = &self.plant.ball {
            let covering = ball.to_f64() / smallest;
            model = model.with_set(self.plant.initial_set.map(Constant::to_f64).with_x0(covering));
        }
        if let Some(domain) = &self.plant.domain {
            model.domain = (domain.x.to_f64() / largest, domain.e.to_f64());
        }
        model
    }

    /// L times a rotation, with which the derivatives change along few axes of y; lower triangular where that serves as well. No norm
    /// of y changes.
    pub(super) fn turned(&self, l: &DMatrix<f64>) -> DMatrix<f64> {
        let n = l.nrows();
        let lower = lower_triangular(l);
        if n < 2 {
            return lower;
        }
        let [x, _] = self.units(&lower);
        let directions = |l: &DMatrix<f64>| self.suprema(l, [None; 2]).directions([x, self.unit_e]);
        let known = directions(&lower);
        let turned = &lower * DMatrix::from_fn(n, n, |i, j| known.principal[i][j]);
        let better = directions(&turned).along_axes < known.along_axes * WORTH_A_TURN;
        if better { turned } else { lower }
    }
}

/// A matrix by rows.
fn rows(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    (0..matrix.nrows()).map(|i| (0..matrix.ncols()).map(|j| matrix[(i, j)]).collect()).collect()
}

/// P = I.
fn identity(n: usize) -> PeriodicMatrix {
    let row = |i: usize| (0..n).map(|j| Rational::from(u32::from(i == j))).collect();
    PeriodicMatrix { mean: (0..n).map(row).collect(), harmonics: Vec::new() }
}

/// A constant P with short entries.
pub(super) fn rational_symmetric(matrix: &DMatrix<f64>) -> Option<PeriodicMatrix> {
    let n = matrix.nrows();
    let entry = |i: usize, j: usize| round_f64(matrix[(i.max(j), i.min(j))], DIGITS, Direction::Nearest);
    let rows: Option<Vec<Vec<Rational>>> = (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect();
    Some(PeriodicMatrix { mean: rows?, harmonics: Vec::new() })
}

/// A rational matrix in doubles.
pub(super) fn float_matrix(rows: &[Vec<Rational>]) -> DMatrix<f64> {
    DMatrix::from_fn(rows.len(), rows.len(), |i, j| rows[i][j].to_f64())
}

/// L with short entries. `at_origin` are the bounds on the orbit in given coordinates.
pub(super) fn rational_matrix(
    l: &DMatrix<f64>,
    at_origin: impl Fn(&DMatrix<f64>) -> Values,
) -> Option<Vec<Vec<Rational>>> {
    let n = l.nrows();
    if n == 0 {
        return Some(Vec::new());
    }
    let wanted = at_origin(l);
    let mut last = None;
    for digits in DIGITS_OF_L {
        // Beside the others of its row it does nothing.
        let is_none = |i: usize, j: usize| l[(i, j)].abs() < NEGLIGIBLE * l.row(i).amax();
        let entry = |i: usize, j: usize| match is_none(i, j) {
            true => Some(Rational::new()),
            false => round_f64(l[(i, j)], digits, Direction::Nearest),
        };
        let rows: Vec<Vec<Rational>> = (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect::<Option<_>>()?;
        let found = at_origin(&float_matrix(&rows));
        last = Some(rows);
        let kept = |(index, bound): (usize, &Bound)| match bound {
            Bound::Rate => found[index] >= wanted[index] * (1.0 - LOST),
            Bound::Fe | Bound::Qx => found[index] <= wanted[index] * (1.0 + LOST),
            _ => true,
        };
        if TABLE.iter().enumerate().all(kept) {
            break;
        }
    }
    last
}
