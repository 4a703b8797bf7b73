//! (E) at samples with the least gamma that is proved (derivation, 13.7).

use sigmastar_decide::bounds::{Engine, PRECISION};
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_lang::spec::SampledExistence;
use sigmastar_propose::bounds::{FloatSuprema, SampledEnergy};
use sigmastar_theory::derivation::sampled_form::LoopNumbers;

/// The shares that gamma at samples gains until it is proved, and the boxes that each attempt may take at either end; the first is
/// for derivatives that do not vary.
const ATTEMPTS: [(f64, usize); 5] = [(1e-5, 8), (0.02, 1500), (0.08, 4000), (0.3, 12_000), (1.0, 20_000)];

/// Significant digits of gamma.
const DIGITS: u32 = 6;

/// The inequality of existence with the least gamma that is proved and little above that of the samples; `None` if none is. `samples`
/// must be of the same plant and region; gamma is not used.
#[must_use]
pub fn prove_sampled_existence(
    engine: &Engine,
    samples: &FloatSuprema,
    inequality: &SampledExistence,
) -> Option<SampledExistence> {
    let reach = engine.reach(&inequality.x);
    let energy = SampledEnergy::from(inequality);
    let of = LoopNumbers::enclosed(&inequality.at, &engine.period(), engine.moves(), PRECISION).to_f64();
    let sampled = samples.refined_gamma([reach, inequality.e.to_f64()], &energy, &of);
    ATTEMPTS.into_iter().find_map(|(slack, effort)| {
        let gamma = round_f64(sampled * (1.0 + slack), DIGITS, Direction::Up).filter(|gamma| *gamma > 0)?;
        let inequality = SampledExistence { gamma, ..inequality.clone() };
        engine.decide_sampled_existence(&inequality, effort).truth.is_true().then_some(inequality)
    })
}
