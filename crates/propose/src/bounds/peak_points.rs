//! The points for a form with a small peak (derivation, 14.4, 14.5): where the derivatives are extreme, and where what was found does not hold.

use super::joint_program::LookedAt;
use super::peak_program::{FallingForm, PeakOf, PeakProgram};
use super::place::{Place, Places};
use super::pointwise::{Derivatives, Slopes};
use super::suprema::{FloatSuprema, Starts};
use crate::semidefinite::propose;
use sigmastar_lang::spec::Bound;
use sigmastar_matrix::doubles::largest;
use sigmastar_matrix::symmetric::{triangle, unit_entry};
use sigmastar_matrix::{AffineMatrix, Symmetric};
use sigmastar_theory::evidence::Part;

/// Points that are added where what was found does not hold, and how often.
const POINTS: usize = 6;
const ROUNDS: usize = 6;

/// The shares of X and E at which the grid is looked at: derivatives may be extreme within.
const SHARES: [[f64; 2]; 5] = [[1.0, 1.0], [1.0, 0.75], [1.0, 0.5], [1.0, 0.25], [0.5, 1.0]];

/// The share of the decay of the states that is enough at a point that was not looked at.
const ENOUGH_DECAY: f64 = 0.9;

/// The share of its margins that a form may miss at a point that was not looked at.
const TOLERANCE: f64 = 0.2;

/// Where a form is to fall.
#[derive(Clone, Copy, Debug)]
pub struct PeakBox {
    /// X and E.
    pub at: [f64; 2],
    /// Along x first, the E of J and r.
    pub x_first: Option<f64>,
}

impl PeakBox {
    /// The derivatives that are taken at the same point, and their X and E.
    fn parts(&self) -> Vec<(Part, [f64; 2])> {
        match self.x_first {
            None => vec![(Part::All, self.at)],
            Some(e) => vec![(Part::States, [self.at[0], e]), (Part::Error, self.at)],
        }
    }
}

impl FloatSuprema {
    /// A small Q with `-(Q J + J'Q) >= 2 I` at the points of a box where that asks most of it; `None` where none is found.
    #[must_use]
    pub fn propose_states(&self, at: [f64; 2]) -> Option<Vec<Vec<f64>>> {
        let all = Places::Stride(1);
        let places = self.where_largest(at, &all, [Bound::Fx]);
        let points = |places: Vec<Place>| {
            self.of_derivatives(at, &Places::listed(places), |derivatives, _| Slopes::from(derivatives))
        };
        let mut known = points(places);
        let mut found = smallest(&known)?;
        for _ in 0..ROUNDS {
            let mut worst = self.largest_of_derivatives(at, &all, POINTS, |derivatives, _| growth(&found, derivatives));
            worst.retain(|(growth, _)| *growth > -2.0 * ENOUGH_DECAY);
            if worst.is_empty() {
                break;
            }
            known.extend(points(worst.into_iter().map(|(_, place)| place).collect()));
            found = smallest(&known)?;
        }
        Some(found)
    }

    /// The least eigenvalue of `-(Q J + J'Q)` that is met at the points of a box.
    #[must_use]
    pub fn least_decay(&self, at: [f64; 2], q: &[Vec<f64>]) -> f64 {
        let all = self.of_derivatives(at, &Places::Stride(1), |derivatives, _| growth(q, derivatives));
        -all.into_iter().fold(f64::NEG_INFINITY, f64::max)
    }

    /// A form with a small peak on a box around the orbit of the samples; `program` says what the loop is, and keeps the points that were needed: with those of
    /// another search on such a box less has to be sought. `None` where none is found.
    pub fn propose_peak(
        &self,
        place: PeakBox,
        program: &mut PeakProgram,
        (of, margin, looked): (PeakOf, f64, LookedAt),
    ) -> Option<FallingForm> {
        let all = Places::Stride(1);
        let points = |(part, at): (Part, [f64; 2]), places: Vec<Place>| {
            self.of_derivatives(at, &Places::listed(places), |derivatives, _| (part, Slopes::from(derivatives)))
        };
        let parts = if program.points.is_empty() { place.parts() } else { Vec::new() };
        for (part, at) in parts {
            let extreme = match part {
                Part::All => self.where_largest(at, &all, [Bound::Fx, Bound::Qx, Bound::Fe, Bound::QeMax, Bound::Qe]),
                Part::States => self.where_largest(at, &all, [Bound::Fx, Bound::Qx]),
                Part::Error => self.where_largest(at, &all, [Bound::Fe, Bound::QeMax, Bound::Qe]),
            };
            program.points.extend(points((part, at), extreme));
        }
        let mut found = program.propose(of, margin)?;
        for _ in 0..ROUNDS {
            let least = TOLERANCE * program.least_margin(&found);
            let mut more = Vec::new();
            for ([of_x, of_e], (part, at)) in
                SHARES.into_iter().flat_map(|share| place.parts().into_iter().map(move |part| (share, part)))
            {
                let at = [of_x * at[0], of_e * at[1]];
                let mut worst = self.largest_of_derivatives(at, &all, POINTS, |derivatives, _| {
                    program.lack_above(&found, (part, &Slopes::from(derivatives)), least)
                });
                worst.retain(|(lack, _)| *lack > least);
                more.extend(points((part, at), worst.into_iter().map(|(_, place)| place).collect()));
            }
            if more.is_empty() {
                break;
            }
            program.points.extend(more);
            found = program.propose(of, margin)?;
        }
        for _ in 0..if looked == LookedAt::Between { ROUNDS } else { 0 } {
            let least = TOLERANCE * program.least_margin(&found);
            let mut more = Vec::new();
            for (part, at) in place.parts() {
                let lack = |derivatives: &Derivatives<'_>| program.lack(&found, (part, &Slopes::from(derivatives)));
                let mut worst = self
                    .refined_points((at, Starts::AtEachTime), lack, |derivatives| (part, Slopes::from(derivatives)));
                worst.retain(|(lack, _)| *lack > least);
                more.extend(worst.into_iter().map(|(_, point)| point));
            }
            if more.is_empty() {
                break;
            }
            program.points.extend(more);
            found = program.propose(of, margin)?;
        }
        Some(found)
    }
}

/// The largest eigenvalue of `Q J + J'Q`.
fn growth(q: &[Vec<f64>], derivatives: &Derivatives<'_>) -> f64 {
    let n = q.len();
    let Slopes { j, .. } = Slopes::from(derivatives);
    let product = |i: usize, k: usize| (0..n).map(|l| q[i][l] * j[l * n + k]).sum::<f64>();
    largest((0..n).map(|i| (0..n).map(|k| product(i, k) + product(k, i)).collect()).collect())
}

/// The Q with the smallest largest eigenvalue that has `-(Q J + J'Q) >= 2 I` at these points.
fn smallest(points: &[Slopes]) -> Option<Vec<Vec<f64>>> {
    let n = points.first()?.r.len();
    let variables: Vec<(usize, usize)> = triangle(n).collect();
    let last = variables.len();
    let own =
        |variable: usize, i: usize, k: usize| variables.get(variable).map_or(0.0, |place| unit_entry(*place, i, k));
    let decay = |Slopes { j, .. }: &Slopes| {
        let constant = |i: usize, k: usize| if i == k { -2.0 } else { 0.0 };
        let term = |variable: usize, i: usize, k: usize| {
            (0..n).map(|l| -own(variable, i, l) * j[l * n + k] - own(variable, k, l) * j[l * n + i]).sum()
        };
        AffineMatrix::from_fn(n, last + 1, constant, term)
    };
    let above = |variable: usize, i: usize, k: usize| f64::from(variable == last && i == k) - own(variable, i, k);
    let above = AffineMatrix::from_fn(n, last + 1, |_, _| 0.0, above);
    let constraints: Vec<AffineMatrix<f64>> = points.iter().map(decay).chain([above]).collect();
    let mut cost = vec![0.0; last + 1];
    cost[last] = 1.0;
    let found = propose(&cost, &constraints).ok()?.x;
    Some(Symmetric::from_entries(n, &found).rows())
}
