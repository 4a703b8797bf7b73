//! The points for a form with a small peak (derivation, 14.4, 14.5): where the derivatives are extreme, and where what was found does not hold.

use super::joint_program::LookedAt;
use super::peak_program::{FallingForm, PeakOf, PeakProgram};
use super::place::{Place, Places};
use super::pointwise::{Derivatives, Slopes};
use super::suprema::{FloatSuprema, Starts};
use sigmastar_lang::spec::Bound;

/// Points that are added where what was found does not hold, and how often.
const POINTS: usize = 6;
const ROUNDS: usize = 6;

/// The shares of X and E at which the grid is looked at: derivatives may be extreme within.
const SHARES: [[f64; 2]; 5] = [[1.0, 1.0], [1.0, 0.75], [1.0, 0.5], [1.0, 0.25], [0.5, 1.0]];

/// The share of its margins that a form may miss at a point that was not looked at.
const TOLERANCE: f64 = 0.2;

impl FloatSuprema {
    /// A form with a small peak on `|y| <= X`, `|e| <= E` around the orbit of the samples; `program` says what the loop is, and keeps the points that
    /// were needed. `None` where none is found.
    pub fn propose_peak(
        &self,
        at: [f64; 2],
        program: &mut PeakProgram,
        (of, margin, looked): (PeakOf, f64, LookedAt),
    ) -> Option<FallingForm> {
        let all = Places::Stride(1);
        let points = |at: [f64; 2], places: Vec<Place>| {
            self.of_derivatives(at, &Places::listed(places), |derivatives, _| Slopes::from(derivatives))
        };
        program.points.extend(points(
            at,
            self.where_largest(at, &all, [Bound::Fx, Bound::Qx, Bound::Fe, Bound::QeMax, Bound::Qe]),
        ));
        let mut found = program.propose(of, margin)?;
        for _ in 0..ROUNDS {
            let least = TOLERANCE * program.least_margin(&found);
            let mut more = Vec::new();
            for [of_x, of_e] in SHARES {
                let at = [of_x * at[0], of_e * at[1]];
                let mut worst = self.largest_of_derivatives(at, &all, POINTS, |derivatives, _| {
                    program.lack(&found, &Slopes::from(derivatives))
                });
                worst.retain(|(lack, _)| *lack > least);
                more.extend(points(at, worst.into_iter().map(|(_, place)| place).collect()));
            }
            if more.is_empty() {
                break;
            }
            program.points.extend(more);
            found = program.propose(of, margin)?;
        }
        for _ in 0..if looked == LookedAt::Between { ROUNDS } else { 0 } {
            let least = TOLERANCE * program.least_margin(&found);
            let lack = |derivatives: &Derivatives<'_>| program.lack(&found, &Slopes::from(derivatives));
            let mut worst =
                self.refined_points((at, Starts::AtEachTime), lack, |derivatives| Slopes::from(derivatives));
            worst.retain(|(lack, _)| *lack > least);
            if worst.is_empty() {
                break;
            }
            program.points.extend(worst.into_iter().map(|(_, point)| point));
            found = program.propose(of, margin)?;
        }
        Some(found)
    }
}
