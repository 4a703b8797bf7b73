//! (M), on one region or with a splitting, with the smallest threshold that is proved (derivation, 13.7).

use rug::Rational;
use sigmastar_decide::bounds::Engine;
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_lang::spec::{Constant, MatrixInequality, Splitting};
use sigmastar_propose::bounds::{FloatSuprema, FloatWeights, MatrixArguments};

/// What the least sigma at samples is enlarged by, until it is proved, and the boxes that each attempt may take; the first is for
/// derivatives that do not vary.
const ATTEMPTS: [(f64, usize); 6] =
    [(1e-5, 8), (0.001, 1500), (0.003, 3000), (0.01, 6000), (0.03, 12_000), (0.1, 20_000)];

/// The enlargements and boxes of the attempts from three states on: another program, which may need many times as many boxes, is to decide
/// the inequality again.
const MODEST_ATTEMPTS: [(f64, usize); 6] =
    [(1e-5, 8), (0.001, 500), (0.003, 1000), (0.01, 2000), (0.03, 4000), (0.1, 8000)];

/// Significant digits of a threshold, and of S in units of its diagonal.
const DIGITS: u32 = 6;

/// The inequality with the smallest threshold that is proved and little above that of the samples: by 0.001 %, 0.1 %, 0.3 %, 1 %,
/// 3 % or 10 %; `None` if none is. `samples` must be of the same plant and region, with P = 1; `value` is not used, and of a
/// splitting nothing but its arguments: S is sought. `tried` says how many attempts failed with a similar inequality, and then with
/// this one: all but the last of them are not made again.
#[must_use]
pub fn prove_inequality(
    engine: &Engine,
    samples: &FloatSuprema,
    inequality: &MatrixInequality,
    mu: &Constant,
    tried: &mut usize,
) -> Option<MatrixInequality> {
    let MatrixInequality { w_x, h, rate, .. } = inequality;
    let [states, error] = inequality.arguments();
    let reach = |[x, e]: [&Rational; 2]| [engine.reach(x), e.to_f64()];
    let apart = inequality.splitting.is_some();
    let at = MatrixArguments { apart, states: reach(states), error: reach(error) };
    let weights = FloatWeights { w_x: w_x.to_f64(), k_p: 2.0 * h.to_f64() / mu.to_f64(), rate: rate.to_f64() };
    // The first one costs nothing.
    let ladder = if engine.states() > 2 { MODEST_ATTEMPTS } else { ATTEMPTS };
    let failed = *tried;
    let attempts = ladder.into_iter().enumerate().filter(|(index, _)| *index == 0 || index + 1 >= failed);
    let decided = |(index, inequality): (usize, MatrixInequality), effort: usize, tried: &mut usize| {
        let proved = engine.decide_inequality(&inequality, mu, effort).truth.is_true();
        *tried = if proved { index } else { failed.max(index + 1) };
        proved.then_some(inequality)
    };
    let Some(splitting) = &inequality.splitting else {
        let sampled = samples.refined_threshold(at.states, weights);
        return attempts.into_iter().find_map(|(index, (slack, effort))| {
            let value = round_f64(sampled * (1.0 + slack), DIGITS, Direction::Up)?;
            decided((index, MatrixInequality { value, ..inequality.clone() }), effort, tried)
        });
    };
    let s = samples.propose_splitting(at, weights)?;
    attempts.into_iter().find_map(|(index, (slack, effort))| {
        // A smaller S has room on its own side, and takes it from the other.
        let s = s.iter().map(|row| row.iter().map(|entry| entry * (1.0 - slack)).collect()).collect::<Vec<Vec<_>>>();
        let value = samples.refined_threshold_with(&s, at.error, weights)? * (1.0 + slack);
        let inequality = MatrixInequality {
            value: round_f64(value, DIGITS, Direction::Up)?,
            splitting: Some(Splitting { matrix: rounded(&s)?, ..splitting.clone() }),
            ..inequality.clone()
        };
        decided((index, inequality), effort, tried)
    })
}

/// With short entries.
fn rounded(s: &[Vec<f64>]) -> Option<Vec<Vec<Rational>>> {
    let entry = |i: usize, j: usize| {
        let value = s[i.max(j)][i.min(j)];
        let size = (s[i][i] * s[j][j]).sqrt();
        // So many digits of the size that it could have.
        let digits = f64::from(DIGITS) + libm::log10(value.abs() / size).floor() + 1.0;
        if value == 0.0 || digits < 1.0 {
            Some(Rational::new())
        } else {
            round_f64(value, digits as u32, Direction::Nearest)
        }
    };
    (0..s.len()).map(|i| (0..s.len()).map(|j| entry(i, j)).collect()).collect()
}
