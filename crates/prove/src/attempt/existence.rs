//! (E) of existence with the largest c_y that is proved (derivation, 13.7).

use sigmastar_decide::bounds::Engine;
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_lang::spec::ExistenceInequality;
use sigmastar_propose::bounds::{EnergyWeights, FloatSuprema};

/// The shares that c_y at samples loses until it is proved, and the boxes that each attempt may take; the first is for derivatives that
/// do not vary.
const ATTEMPTS: [(f64, usize); 6] =
    [(1e-5, 8), (0.002, 1500), (0.01, 3000), (0.04, 6000), (0.15, 12_000), (0.5, 20_000)];

/// Significant digits of c_y.
const DIGITS: u32 = 6;

/// The inequality with the largest c_y that is proved and little below that of the samples; `None` if none is. `samples` must be
/// of the same plant and region; c_y is not used.
#[must_use]
pub fn prove_existence(
    engine: &Engine,
    samples: &FloatSuprema,
    inequality: &ExistenceInequality,
) -> Option<ExistenceInequality> {
    let reach = engine.reach(&inequality.x);
    let weights = EnergyWeights::from(inequality);
    let sampled = samples.refined_margin([reach, inequality.e.to_f64()], &weights);
    ATTEMPTS.into_iter().find_map(|(slack, effort)| {
        let c_y = round_f64(sampled * (1.0 - slack), DIGITS, Direction::Down).filter(|c_y| *c_y > 0)?;
        let inequality = ExistenceInequality { c_y, ..inequality.clone() };
        engine.decide_existence(&inequality, effort).truth.is_true().then_some(inequality)
    })
}
