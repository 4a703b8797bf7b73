//! What a simulation may cost, counted in operations, so that the answer does not depend on the machine.

use super::ClosedLoop;
use super::integration::IntegrationFailure;
use super::limits::MAX_OPERATIONS;
use super::radau;
use std::sync::atomic::Ordering;

/// What a step of order 8 costs outside the right side, for each component and stage: nine additions and multiplications
/// of whole vectors, three of which take as long as one by itself.
const STAGE: u64 = 3;

/// The stages of an implicit step, and the iterations that most of them take.
const STAGES: u64 = radau::STAGES as u64;
const ITERATIONS: u64 = 6;

impl ClosedLoop {
    /// Starts counting anew, for another part of a simulation.
    pub fn renew_effort(&self) {
        self.effort.store(0, Ordering::Relaxed);
    }

    /// Starts counting anew with only so many operations left.
    pub(crate) fn leave(&self, operations: u64) {
        self.effort.store(MAX_OPERATIONS.saturating_sub(operations), Ordering::Relaxed);
    }

    /// The operations that the part of a simulation begun last has taken, of [`MAX_OPERATIONS`].
    #[must_use]
    pub fn spent(&self) -> u64 {
        self.effort.load(Ordering::Relaxed)
    }

    /// The operations of one stage of a step: the right side and what the method does with it.
    pub(super) fn stage_cost(&self) -> u64 {
        self.operations(false) + self.dimension() as u64 * (5 + STAGE)
    }

    /// The stages that are left to be spent.
    pub(super) fn stages_left(&self) -> u64 {
        self.left() / self.stage_cost()
    }

    fn left(&self) -> u64 {
        MAX_OPERATIONS.saturating_sub(self.spent())
    }

    /// The operations of an implicit step, with so many columns of variational equations beside the state: what a system of
    /// stages costs to factor and to solve, some evaluations, and the oscillators; a multiplication with an addition is one.
    pub(super) fn implicit_step_cost(&self, columns: usize) -> u64 {
        let (n, d, columns) = (self.states() as u64 + 1, self.dimension() as u64, columns as u64);
        let size = n * STAGES;
        let iterations =
            STAGES * (self.operations(true) + ITERATIONS * self.operations(false)) + ITERATIONS * size * size;
        let factors = if columns > 0 { 2 } else { 1 } * size * size * size / 3;
        iterations + factors + (1 + columns) * 2 * STAGES * d + columns * size * size
    }

    /// Counts operations that are about to be made at the time t.
    ///
    /// # Errors
    /// [`IntegrationFailure::TooMuchWork`] where they are more than what is left.
    pub(super) fn pay(&self, t: f64, operations: u64) -> Result<(), IntegrationFailure> {
        if operations > self.left() {
            return Err(IntegrationFailure::TooMuchWork { t });
        }
        self.effort.fetch_add(operations, Ordering::Relaxed);
        Ok(())
    }

    /// Counts stages that were made.
    pub(super) fn count_stages(&self, stages: u64) {
        self.effort.fetch_add(stages.saturating_mul(self.stage_cost()), Ordering::Relaxed);
    }

    /// Counts fixed steps of four stages that are about to be made from the time t.
    ///
    /// # Errors
    /// [`IntegrationFailure::TooMuchWork`] where they are more than what is left.
    pub(super) fn pay_fixed(&self, t: f64, steps: usize) -> Result<(), IntegrationFailure> {
        self.pay(t, (4 * steps as u64).saturating_mul(self.stage_cost()))
    }
}
