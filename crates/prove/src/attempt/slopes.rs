//! (D) of a ball little larger than one that samples ask for (derivation, 13.6).

use rug::Rational;
use sigmastar_decide::bounds::Engine;
use sigmastar_propose::bounds::FloatSlopes;
use sigmastar_theory::evidence::Slopes;

/// What a ball is enlarged by until it is proved, the boxes that each attempt may take, and the digits of its numbers; the
/// first is for derivatives that do not vary.
const ATTEMPTS: [(f64, usize, u32); 9] = [
    (1e-5, 8, 9),
    (3e-4, 2000, 9),
    (0.001, 2000, 9),
    (0.003, 2000, 9),
    (0.01, 2000, 9),
    (0.03, 3000, 9),
    (0.1, 6000, 9),
    (0.3, 12_000, 9),
    (0.3, 12_000, 15),
];

/// (D) for a ball little larger than this one, which is proved with [`Engine::smooth`]; `None` if none is.
#[must_use]
pub fn prove_slopes(engine: &Engine, slopes: &FloatSlopes, at: [&Rational; 2]) -> Option<Slopes> {
    let [x, e] = at;
    engine.smooth(x, e).ok()?;
    ATTEMPTS.into_iter().find_map(|(slack, effort, digits)| {
        let rounded = slopes.of_share(1.0 + slack).rounded(digits)?;
        engine.decide_slopes(&rounded, at, effort).truth.is_true().then_some(rounded)
    })
}
