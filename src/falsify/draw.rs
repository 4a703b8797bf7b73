//! Drawing plants that touch the bounding functions.

use super::claim::Claim;
use super::family::{CONDITIONS, Family, Harmonic};
use super::jacobian::{self, Clock};
use super::membership::respects;
use super::random::Random;
use super::shape::{Factor, Number, Shape};
use crate::certify::has_states;
use crate::data::{Bound, Data};
use crate::enclosure::DEFAULT_PRECISION;
use crate::expr::{Expr, Variables};
use std::f64::consts::TAU;

/// What is kept of a bounding function at first.
pub(super) const SHARE: f64 = 0.98;

/// What is kept of a coefficient that is too large.
const FACTOR: f64 = 0.93;

/// What is kept of a bounding function in the end.
const ROOM: f64 = 0.99;

/// Points of each side of the grid on which that is looked at.
const GRID: i32 = 40;

/// Times that a plant is made smaller before it is given up.
const ATTEMPTS: usize = 60;

/// A plant with its coefficients, proved to lie within the families of a claim.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnPlant {
    /// The coefficients.
    pub family: Family,
}

/// The positive part, which is what a bounding function is; NaN stays.
fn positive(value: f64) -> f64 {
    if value < 0.0 { 0.0 } else { value }
}

/// The bounding functions of a claim, in the order of [`Family::bounds`]: those that every specification has, or their
/// sharper forms.
pub(super) fn allowed(claim: &Claim) -> Vec<&Expr> {
    [Bound::F, Bound::Fe, Bound::Fxx, Bound::Fex, Bound::Q, Bound::Qe, Bound::Qx, Bound::Qt, Bound::QRms, Bound::QtRms]
        .iter()
        .filter_map(|bound| bound.of(&claim.spec))
        .collect()
}

/// Draws a plant: each coefficient is a random share of what the bounding functions allow at small arguments, then what
/// exceeds one somewhere is made smaller until nothing does. `None` where the plants of this kind do not fit into the
/// families, or could not be proved to with the operations that are `left`.
///
/// Guarantee: P_x exists and every bounding function holds up to the reach of the claim, the axes included, proved for
/// the coefficients as [`Family::texts`] writes them.
#[must_use]
pub fn draw(claim: &Claim, random: &mut Random, left: &mut u64) -> Option<DrawnPlant> {
    let allowed = allowed(claim);
    let [reach_x, reach_e] = claim.reach.each_ref().map(rug::Rational::to_f64);
    let value = |index: usize, x: f64| positive(allowed[index].to_float().eval(x, 0.0));
    let at_zero: Vec<f64> = (0..allowed.len()).map(|index| SHARE * value(index, 0.0)).collect();
    // The slope of a bounding function in X, where it is linear.
    let small = reach_x * 1e-3;
    let slope = |index: usize| SHARE * ((value(index, small) - value(index, 0.0)) / small).max(0.0);

    let clock = Clock { period: &claim.spec.period.text, multiple: [1, 1, 2, 3][random.whole(0, 3) as usize] };
    // Only data that speak of no state at all are those of a plant without one.
    let drawn = match has_states(&Data::new(&claim.spec, DEFAULT_PRECISION), &claim.reach) {
        true => jacobian::draw(claim, clock, slope(0), random)?,
        false => jacobian::Drawn { rows: Vec::new(), norm: Number::default() },
    };
    let n = drawn.rows.len();
    // Where F x alone takes all that f may be, no other coefficient fits, and hardly a proof.
    if n > 0 && SHARE * drawn.norm.value() > 0.999 * slope(0) {
        return None;
    }
    // What needs states is 0 without them.
    let mut of_states = |size: f64| if n == 0 { 0.0 } else { size * random.share() };
    let (g_size, g_1) = (of_states(at_zero[1]), of_states(at_zero[3].min(slope(1))));
    let (kappa, beta, delta) = (of_states(at_zero[2]), of_states(at_zero[6]), of_states(slope(5)));
    let scale = |reach: f64, random: &mut Random| Number::new(reach * libm::exp(-4.0 * random.uniform()));
    let mut shape = |reach: f64| match random.whole(0, 2) {
        0 => Shape::Linear,
        1 => Shape::Tanh(scale(reach, random)),
        _ => Shape::Sin(scale(reach, random)),
    };
    let shapes = [shape(8.0 * reach_x), shape(reach_x)];
    let bounded = match shape(reach_e) {
        Shape::Linear => Shape::Tanh(Number::new(reach_e)),
        other => other,
    };
    let mut family = Family {
        period: clock.period.to_owned(),
        jacobian: drawn.rows,
        jacobian_norm: drawn.norm.to_string(),
        g: (random.direction(n).iter().map(|part| part.times(g_size)).collect(), Number::new(g_size)),
        g_1: Number::new(g_1),
        kappa: Number::new(kappa),
        directions: [random.direction(n), random.direction(n), random.direction(n)],
        shapes,
        wave: random.chance(0.5).then(|| scale(reach_x, random)),
        beta: Number::new(beta),
        c: Number::new(at_zero[5] * random.share()),
        delta: Number::new(delta),
        saturation: bounded,
        factors: [clock.factor(random), clock.factor(random), clock.factor(random), clock.factor(random)],
        harmonics: harmonics(clock.multiple, random),
    };
    fill(&mut family, &at_zero, claim.spec.period.to_f64());
    fit(&mut family, &allowed, claim, left).then_some(DrawnPlant { family })
}

/// Makes a family smaller until nothing exceeds what is allowed; false where that is not proved of any size with the
/// operations that are `left`.
pub(super) fn fit(family: &mut Family, allowed: &[&Expr], claim: &Claim, left: &mut u64) -> bool {
    let reach = claim.reach.each_ref().map(rug::Rational::to_f64);
    // A bound only falls as coefficients become smaller, so what fits once need not be looked at again.
    allowed.iter().enumerate().all(|(index, allowed)| {
        (0..ATTEMPTS).any(|_| {
            let bound = &family.bounds()[index];
            // The norm of F is given, so f may have no room to spare.
            let room = CONDITIONS[index] == "f" || leaves_room(bound, allowed, reach);
            let fits = room && respects(bound, allowed, &claim.reach, left);
            if !fits {
                shrink(family, CONDITIONS[index]);
            }
            fits
        })
    })
}

/// Whether a bound stays a little below what is allowed at the points of a grid, so that the proof is short.
fn leaves_room(bound: &str, allowed: &Expr, reach: [f64; 2]) -> bool {
    let Ok(bound) = Expr::parse(bound, Variables::XAndE) else { return false };
    let (bound, allowed) = (bound.to_float(), allowed.to_float());
    let along = |end: f64, at: i32| if at == GRID { 0.0 } else { end * 0.8_f64.powi(at) };
    (0..=GRID).all(|i| {
        (0..=GRID).all(|j| {
            let (x, e) = (along(reach[0], i), along(reach[1], j));
            bound.eval(x, e) <= ROOM * positive(allowed.eval(x, e))
        })
    })
}

/// One to four harmonics of neighbouring orders, now and then with a constant.
pub(super) fn harmonics(multiple: u32, random: &mut Random) -> Vec<Harmonic> {
    let mut harmonics = Vec::new();
    if random.chance(0.3) {
        harmonics.push(Harmonic { amplitude: Number::new(random.uniform()), factor: Factor::ONE });
    }
    let (first, count) = (random.whole(1, 3), random.whole(1, 4));
    for order in first..first + count {
        let factor = Factor { order: multiple * order, phase: Number::new(TAU * random.uniform()) };
        harmonics.push(Harmonic { amplitude: Number::new(random.uniform() + 1e-3), factor });
    }
    harmonics
}

/// Scales A so that the first of its four bounds is reached.
pub(super) fn fill(family: &mut Family, at_zero: &[f64], period: f64) {
    let speed = |harmonic: &Harmonic| f64::from(harmonic.factor.order) * TAU / period;
    let sizes = |weight: &dyn Fn(&Harmonic) -> f64| {
        let all = family.harmonics.iter().map(|harmonic| harmonic.amplitude.value() * weight(harmonic));
        let sum: f64 = all.clone().sum();
        let mean = family.harmonics.iter().map(|harmonic| if harmonic.factor.order == 0 { 1.0 } else { 0.5 });
        [sum, all.zip(mean).map(|(size, mean)| size * size * mean).sum::<f64>().sqrt()]
    };
    let ([sup, rms], [speed_sup, speed_rms]) = (sizes(&|_| 1.0), sizes(&speed));
    let room = [(4, sup), (7, speed_sup), (8, rms), (9, speed_rms)].map(|(index, here)| at_zero[index] / here);
    let factor = room.into_iter().fold(f64::INFINITY, f64::min);
    let factor = if factor.is_finite() { factor } else { 0.0 };
    family.harmonics.iter_mut().for_each(|harmonic| harmonic.amplitude = harmonic.amplitude.times(factor));
}

/// Makes smaller what a bounding function does not allow.
fn shrink(family: &mut Family, condition: &str) {
    let smaller = |numbers: &mut [&mut Number]| numbers.iter_mut().for_each(|number| **number = number.times(FACTOR));
    let Family { g, g_1, kappa, beta, c, delta, saturation, harmonics, .. } = family;
    let mut input = || {
        g.0.iter_mut().for_each(|part| *part = part.times(FACTOR));
        smaller(&mut [&mut g.1, g_1]);
    };
    match condition {
        "f" => {
            input();
            smaller(&mut [kappa]);
        }
        "f_e" => input(),
        "f_xx" => smaller(&mut [kappa, g_1]),
        "f_ex" => smaller(&mut [g_1]),
        "q_e" => smaller(&mut [c, delta]),
        "q_x" => smaller(&mut [beta, delta]),
        _ => {
            smaller(&mut [beta, c, delta]);
            if let Shape::Tanh(scale) | Shape::Sin(scale) = saturation {
                smaller(&mut [scale]);
            }
            if condition.starts_with("q_t") {
                harmonics.iter_mut().for_each(|harmonic| harmonic.amplitude = harmonic.amplitude.times(FACTOR));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{Evaluator, PlantExpr, PlantNames, Program};
    use crate::falsify::membership::MAX_OPERATIONS;
    use crate::spec::Specification;
    use std::sync::Arc;

    fn claim(spec: &str) -> Claim {
        Claim::for_tests(Specification::from_json("test", spec).unwrap(), [3.0, 4.0])
    }

    /// The largest values that f, q and their derivatives take at points, by difference quotients, against the bounds.
    #[test]
    fn plants_stay_within_their_bounds() {
        let claim = claim(include_str!("../../specs/paper-example.json"));
        let mut random = Random::new(5, 6);
        let (mut kinds, mut touched) = ([0; 4], [0.0_f64; 10]);
        for _ in 0..12 {
            let plant = draw(&claim, &mut random, &mut { MAX_OPERATIONS }).expect("plants fit");
            let family = &plant.family;
            let n = family.states();
            kinds[n] += 1;
            let (f, q) = family.texts();
            let names = PlantNames::new((1..=n).map(|i| format!("x{i}")).collect()).unwrap();
            let parsed: Vec<PlantExpr> =
                f.iter().chain([&q]).map(|text| PlantExpr::parse(text, &names).unwrap()).collect();
            let program = Arc::new(Program::values(&parsed.iter().collect::<Vec<_>>(), n));
            let mut evaluator = Evaluator::new(program);
            let mut at = |t: f64, x: &[f64], e: f64| {
                let mut values = vec![0.0; n + 1];
                evaluator.set_time(t);
                evaluator.evaluate(x, e, &mut values);
                values
            };
            let bounds: Vec<Expr> =
                family.bounds().iter().map(|text| Expr::parse(text, Variables::XAndE).unwrap()).collect();
            let norm = |values: &[f64]| values.iter().map(|value| value * value).sum::<f64>().sqrt();
            for _ in 0..300 {
                let (t, e) = (random.uniform(), 4.0 * (2.0 * random.uniform() - 1.0));
                let size = 3.0 * random.uniform();
                let x: Vec<f64> = random.direction(n).iter().map(|part| size * part.value()).collect();
                let along: Vec<f64> = random.direction(n).iter().map(|part| part.value()).collect();
                let step = 1e-4;
                let moved = |by: f64| -> Vec<f64> { x.iter().zip(&along).map(|(x, v)| x + by * v).collect() };
                let here = at(t, &x, e);
                let difference = |a: &[f64], b: &[f64]| -> Vec<f64> {
                    a.iter().zip(b).map(|(a, b)| (a - b) / (2.0 * step)).collect()
                };
                let by_e = difference(&at(t, &x, e + step), &at(t, &x, e - step));
                let by_x = difference(&at(t, &moved(step), e), &at(t, &moved(-step), e));
                let by_t = difference(&at(t + step, &x, e), &at(t - step, &x, e));
                let (up, down) = (at(t, &moved(step), e), at(t, &moved(-step), e));
                let twice: Vec<f64> = (0..n).map(|i| (up[i] - 2.0 * here[i] + down[i]) / (step * step)).collect();
                let mixed = {
                    let [a, b] = [1.0, -1.0].map(|sign| {
                        difference(&at(t, &moved(sign * step), e + step), &at(t, &moved(sign * step), e - step))
                    });
                    difference(&a, &b)
                };
                let found = [
                    norm(&here[..n]),
                    norm(&by_e[..n]),
                    norm(&twice),
                    norm(&mixed[..n]),
                    here[n].abs(),
                    by_e[n].abs(),
                    by_x[n].abs(),
                    by_t[n].abs(),
                ];
                let size = norm(&x);
                for (index, (found, bound)) in found.iter().zip(&bounds).enumerate() {
                    let bound = bound.to_float().eval(size, e.abs());
                    assert!(*found <= bound * (1.0 + 1e-6) + 1e-5, "{}: {found} {bound}", CONDITIONS[index]);
                    if bound > 1e-3 {
                        touched[index] = touched[index].max(found / bound);
                    }
                }
            }
            for (index, (bound, allowed)) in bounds.iter().zip(allowed(&claim)).enumerate() {
                let [bound, allowed] = [bound, allowed].map(|expr| expr.to_float().eval(3.0, 4.0));
                assert!(bound <= allowed, "{}: {bound} {allowed}", CONDITIONS[index]);
            }
        }
        assert!(kinds[1] > 0 && kinds[2] > 0 && kinds[3] > 0, "{kinds:?}");
        // The bounds are no larger than they have to be.
        assert!(touched[..8].iter().all(|share| *share > 0.7), "{touched:?}");
    }

    #[test]
    fn without_states_and_with_a_jacobian() {
        let mut random = Random::new(1, 1);
        let none = draw(&claim(include_str!("../../specs/no-x.json")), &mut random, &mut { MAX_OPERATIONS }).unwrap();
        assert_eq!((none.family.states(), none.family.texts().0.len()), (0, 0));
        // A Jacobian without a proved triple draws nothing.
        assert!(
            draw(&claim(include_str!("../../specs/paper-example-jacobian.json")), &mut random, &mut { MAX_OPERATIONS })
                .is_none()
        );
    }
}
