//! The points for a form with a small peak (derivation, 14.4, 14.5): where the derivatives are extreme, and where what was found does not hold.

use super::place::{Place, Places};
use super::pointwise::Slopes;
use super::suprema::FloatSuprema;
use crate::peak_program::{FallingForm, PeakOf, PeakProgram};
use sigmastar_lang::spec::Bound;

/// Points that are added where what was found does not hold, and how often.
const POINTS: usize = 6;
const ROUNDS: usize = 6;

/// The share of the level's unit by which a form may miss its margins at a point that was not looked at.
const TOLERANCE: f64 = 1e-9;

impl FloatSuprema {
    /// A form with a small peak on `|y| <= X`, `|e| <= E` around the orbit of the samples; `program` says what the loop is, and keeps the points that
    /// were needed. `None` where none is found.
    pub fn propose_peak(
        &self,
        at: [f64; 2],
        program: &mut PeakProgram,
        (of, margin): (PeakOf, f64),
    ) -> Option<FallingForm> {
        let all = Places::Stride(1);
        let points = |places: Vec<Place>| {
            self.of_derivatives(at, &Places::listed(places), |derivatives, _| Slopes::from(derivatives))
        };
        program.points.extend(points(self.where_largest(at, &all, [Bound::Fx, Bound::Qx, Bound::Fe, Bound::QeMax, Bound::Qe])));
        let mut found = program.propose(of, margin)?;
        for _ in 0..ROUNDS {
            let least = TOLERANCE * found.level;
            let mut worst = self.largest_of_derivatives(at, &all, POINTS, |derivatives, _| {
                program.lack(&found, &Slopes::from(derivatives))
            });
            worst.retain(|(lack, _)| *lack > least);
            if worst.is_empty() {
                break;
            }
            program.points.extend(points(worst.into_iter().map(|(_, place)| place).collect()));
            found = program.propose(of, margin)?;
        }
        Some(found)
    }
}
