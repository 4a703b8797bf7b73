//! Drawing plants that touch the bounding functions.

use super::claim::TriedClaim;
use super::family::Family;
use super::fit::fit;
use super::forcing::{fill, harmonics};
use super::jacobian::{self, Clock};
use super::limits::{Limits, SHARE};
use super::random::Random;
use super::shape::{Number, Shape};
use sigmastar_decide::conditions::has_states;
use sigmastar_exact::enclosure::DEFAULT_PRECISION;
use sigmastar_theory::data::{Bound, Data};

/// Draws a plant: each coefficient is a random share of what the bounding functions allow at small arguments, then what
/// exceeds one somewhere is made smaller until nothing does. `None` where the plants of this kind do not fit into the
/// families, or could not be proved to with the operations that are `left`.
///
/// Guarantee: P_x exists, every bounding function holds up to the reach of the claim, the axes included, and q(t,0,0) is
/// as q_0 says, proved for the coefficients as [`Family::texts`] writes them.
#[must_use]
pub fn draw(claim: &TriedClaim, random: &mut Random, left: &mut u64) -> Option<Family> {
    let limits = Limits::new(claim);
    let [reach_x, reach_e] = limits.reach;
    let clock =
        Clock { period: &claim.spec.period.nominal().text, multiple: [1, 1, 2, 3][random.whole(0, 3) as usize] };
    let largest = limits.slope(Bound::F).min(limits.at_zero(Bound::Fx));
    // Only data that speak of no state at all are those of a plant without one.
    let drawn = match has_states(&Data::new(&claim.spec, DEFAULT_PRECISION), &claim.reach) {
        true => jacobian::draw(claim, clock, largest, random)?,
        false => jacobian::Drawn { rows: Vec::new(), norm: Number::default() },
    };
    let n = drawn.rows.len();
    // Where F x alone takes all that f may be, no other coefficient fits, and hardly a proof.
    if n > 0 && SHARE * drawn.norm.value() > 0.999 * largest {
        return None;
    }
    let sector = limits.sector();
    // dq/de grows with |x| on both sides of the middle, so as slowly as the slower end allows.
    let widening =
        limits.slope(Bound::Qe).min(if sector.one_sided { limits.slope(Bound::QeMax) } else { f64::INFINITY });
    // What needs states is 0 without them.
    let mut of_states = |size: f64| if n == 0 { 0.0 } else { size * random.share() };
    let g_size = of_states(limits.at_zero(Bound::Fe));
    let g_1 = of_states(limits.at_zero(Bound::Fex).min(limits.slope(Bound::Fe)));
    let kappa = of_states(limits.at_zero(Bound::Fxx));
    let (beta, delta) = (of_states(limits.at_zero(Bound::Qx)), of_states(widening));
    // A contraction rate is proved of F(t) alone, so df/dx is to be F(t).
    let [g_1, kappa] = if claim.spec.bounds.own(Bound::Rate).is_some() { [0.0; 2] } else { [g_1, kappa] };
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
        damping: Number::new(sector.damping()),
        c: Number::new(SHARE * sector.half_width() * random.share()),
        delta: Number::new(delta),
        saturation: bounded,
        factors: [clock.factor(random), clock.factor(random), clock.factor(random), clock.factor(random)],
        harmonics: harmonics(claim, clock.multiple, Random::share, random),
    };
    fill(&mut family, claim);
    fit(&mut family, claim, left).then_some(family)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::falsify::fit::fits;
    use crate::falsify::limits::SectorEnd;
    use crate::falsify::linear::linear_member;
    use crate::falsify::membership::MAX_OPERATIONS;
    use serde_json::Value;
    use sigmastar_lang::expr::{Evaluator, Expr, PlantExpr, PlantNames, Program, Variables};
    use sigmastar_lang::spec::Specification;
    use std::collections::HashMap;
    use std::sync::Arc;

    fn claim(spec: &str) -> TriedClaim {
        TriedClaim::for_tests(Specification::from_json("test", spec).unwrap(), [3.0, 4.0])
    }

    /// A specification with other fields.
    fn with(spec: &str, fields: &[(&str, &str)]) -> TriedClaim {
        let mut document: Value = serde_json::from_str(spec).unwrap();
        for (pointer, text) in fields {
            let (parent, field) = pointer.rsplit_once('/').unwrap();
            document.pointer_mut(parent).unwrap()[field] = (*text).into();
        }
        claim(&document.to_string())
    }

    /// f and q, for points.
    fn evaluator(family: &Family) -> Evaluator {
        let n = family.states();
        let (f, q) = family.texts();
        let names = PlantNames::new((1..=n).map(|i| format!("x{i}")).collect()).unwrap();
        let parsed: Vec<PlantExpr> = f.iter().chain([&q]).map(|text| PlantExpr::parse(text, &names).unwrap()).collect();
        Evaluator::new(Arc::new(Program::values(&parsed.iter().collect::<Vec<_>>(), n)))
    }

    /// What f, q and their derivatives are at a random point, by difference quotients, with |x| and |e|.
    fn found(n: usize, evaluator: &mut Evaluator, random: &mut Random) -> (Vec<(Bound, f64)>, [f64; 2]) {
        let mut at = |t: f64, x: &[f64], e: f64| {
            let mut values = vec![0.0; n + 1];
            evaluator.set_time(t);
            evaluator.evaluate(x, e, &mut values);
            values
        };
        let norm = |values: &[f64]| values.iter().map(|value| value * value).sum::<f64>().sqrt();
        let (t, e) = (random.uniform(), 4.0 * (2.0 * random.uniform() - 1.0));
        let size = 3.0 * random.uniform();
        let x: Vec<f64> = random.direction(n).iter().map(|part| size * part.value()).collect();
        let along: Vec<f64> = random.direction(n).iter().map(|part| part.value()).collect();
        let step = 1e-4;
        let moved = |by: f64| -> Vec<f64> { x.iter().zip(&along).map(|(x, v)| x + by * v).collect() };
        let here = at(t, &x, e);
        let difference =
            |a: &[f64], b: &[f64]| -> Vec<f64> { a.iter().zip(b).map(|(a, b)| (a - b) / (2.0 * step)).collect() };
        let mut by_e = |t: f64, x: &[f64]| difference(&at(t, x, e + step), &at(t, x, e - step));
        let slope = by_e(t, &x);
        let mixed = difference(&by_e(t, &moved(step)), &by_e(t, &moved(-step)));
        let slope_drift = difference(&by_e(t + step, &x), &by_e(t - step, &x));
        let mut by_x = |t: f64| difference(&at(t, &moved(step), e), &at(t, &moved(-step), e));
        let gradient = by_x(t);
        let gradient_drift = difference(&by_x(t + step), &by_x(t - step));
        let by_t = difference(&at(t + step, &x, e), &at(t - step, &x, e));
        let (up, down) = (at(t, &moved(step), e), at(t, &moved(-step), e));
        let twice: Vec<f64> = (0..n).map(|i| (up[i] - 2.0 * here[i] + down[i]) / (step * step)).collect();
        let found = vec![
            (Bound::F, norm(&here[..n])),
            (Bound::Fe, norm(&slope[..n])),
            (Bound::Fxx, norm(&twice)),
            (Bound::Fex, norm(&mixed[..n])),
            (Bound::Fx, norm(&gradient[..n])),
            (Bound::Q, here[n].abs()),
            (Bound::Qe, slope[n].abs()),
            (Bound::QeMax, slope[n]),
            (Bound::Qx, gradient[n].abs()),
            (Bound::Qt, by_t[n].abs()),
            (Bound::Qtx, gradient_drift[n].abs()),
            (Bound::Qte, slope_drift[n].abs()),
        ];
        (found, [norm(&x), e.abs()])
    }

    /// Checks what a plant is at many points against its own bounds and those of the specification. Returns the largest
    /// share of its own bounds that was found; for the slope from above the least distance from that of the specification.
    fn check(family: &Family, claim: &TriedClaim, random: &mut Random) -> Vec<(Bound, f64)> {
        let parse = |bound| Expr::parse(&family.bound(bound).unwrap().text(), Variables::XAndE).unwrap().to_float();
        let mut own = HashMap::new();
        let allowed: HashMap<_, _> =
            claim.spec.bounds.named().map(|(bound, allowed)| (bound, allowed.to_float())).collect();
        let mut evaluator = evaluator(family);
        let mut touched: Vec<(Bound, f64)> = Vec::new();
        for _ in 0..300 {
            let (found, [x, e]) = found(family.states(), &mut evaluator, random);
            for (index, (bound, found)) in found.into_iter().enumerate() {
                let most = own.entry(bound).or_insert_with(|| parse(bound)).eval(x, e);
                assert!(found <= most * (1.0 + 1e-6) + 2e-5 || bound.is_signed(), "{bound:?}: {found} {most}");
                assert!(found <= most + 2e-5 || !bound.is_signed(), "{bound:?}: {found} {most}");
                let allowed = allowed.get(&bound).map(|allowed| allowed.eval(x, e));
                if let Some(allowed) = allowed {
                    assert!(found <= allowed + 1e-5 * (1.0 + allowed.abs()), "{bound:?}: {found} {allowed}");
                }
                let share = match bound.is_signed() {
                    true => found - allowed.unwrap_or(most),
                    false if most > 1e-3 => found / most,
                    false => 0.0,
                };
                match touched.get_mut(index) {
                    Some((_, most)) => *most = most.max(share),
                    None => touched.push((bound, share)),
                }
            }
        }
        for (bound, allowed) in allowed.into_iter().filter(|(bound, _)| *bound != Bound::Rate) {
            let [most, allowed] = [parse(bound), allowed].map(|expr| expr.eval(3.0, 4.0));
            assert!(most <= allowed, "{bound:?}: {most} {allowed}");
        }
        touched
    }

    #[test]
    fn plants_stay_within_their_bounds() {
        let claim = claim(include_str!("../../../../specs/paper-example.json"));
        let mut random = Random::new(5, 6);
        let (mut kinds, mut touched) = ([0; 4], [0.0_f64; 12]);
        for _ in 0..12 {
            let plant = draw(&claim, &mut random, &mut { MAX_OPERATIONS }).expect("plants fit");
            kinds[plant.states()] += 1;
            let here = check(&plant, &claim, &mut random);
            touched.iter_mut().zip(here).for_each(|(most, (_, share))| *most = most.max(share));
        }
        assert!(kinds[1] > 0 && kinds[2] > 0 && kinds[3] > 0, "{kinds:?}");
        // The bounds are no larger than they have to be.
        let signed = 7;
        let close = |(index, share): (usize, &f64)| *share > if index == signed { -0.1 } else { 0.7 };
        assert!(touched.iter().enumerate().all(close), "{touched:?}");
    }

    /// Optional data: every plant that is drawn satisfies them, and some come close to the one-sided slope.
    #[test]
    fn plants_stay_within_optional_bounds() {
        let paper = include_str!("../../../../specs/paper-example.json");
        let friction = include_str!("../../../../specs/linear.json");
        for (claim, least) in [
            (with(paper, &[("/bounds/q_e_max", "X/2 + 0.05"), ("/bounds/f_x", "2.302 + 0.2237*X + E/2")]), -0.06),
            (with(paper, &[("/bounds/q_e_max", "X - 0.1"), ("/bounds/q_tx", "4"), ("/bounds/q_te", "1 + X")]), -0.06),
            (with(friction, &[("/bounds/q_e_max", "0")]), -0.03),
            (with(friction, &[("/bounds/q_e_max", "-1/8"), ("/bounds/f_x", "2")]), -0.03),
        ] {
            let mut random = Random::new(7, 8);
            let mut closest = f64::NEG_INFINITY;
            for _ in 0..8 {
                let plant =
                    (0..30).find_map(|_| draw(&claim, &mut random, &mut { MAX_OPERATIONS })).expect("a plant fits");
                assert!(fits(&plant, &claim, &mut { MAX_OPERATIONS }));
                let here = check(&plant, &claim, &mut random);
                closest =
                    here.iter().find(|(bound, _)| *bound == Bound::QeMax).map_or(closest, |(_, by)| closest.max(*by));
            }
            assert!(closest > least, "{closest} {least}");
            for end in [SectorEnd::Upper, SectorEnd::Lower] {
                let plant =
                    linear_member(&claim, end, &mut random, &mut { MAX_OPERATIONS }).expect("a linear plant fits");
                check(&plant, &claim, &mut random);
            }
        }
    }

    /// A contraction rate is proved of F alone, and what F cannot have has no plant.
    #[test]
    fn plants_have_the_contraction_rate() {
        let paper = include_str!("../../../../specs/paper-example.json");
        for (rate, drawn) in [("0.58 - X", true), ("0.9 - X/10 - E/10", true), ("5", false), ("0.5 + X", false)] {
            let claim = with(paper, &[("/lyapunov/rate", rate)]);
            let mut random = Random::new(9, 10);
            for _ in 0..20 {
                let Some(plant) = draw(&claim, &mut random, &mut { MAX_OPERATIONS }) else { continue };
                assert!(drawn, "{rate}");
                assert_eq!((plant.g_1.value(), plant.kappa.value()), (0.0, 0.0));
                check(&plant, &claim, &mut random);
            }
            let linear = linear_member(&claim, SectorEnd::Upper, &mut random, &mut { MAX_OPERATIONS });
            assert_eq!(linear.is_some(), drawn, "{rate}");
            let wanted = rate.split(' ').next().unwrap().parse::<f64>().unwrap();
            assert!(linear.is_none_or(|plant| {
                let text = &plant.jacobian[0][0];
                let f = Expr::parse(text, Variables::Time).unwrap().to_float().eval(0.0, 0.0);
                (f + wanted).abs() < 1e-9
            }));
        }
    }

    #[test]
    fn without_states_and_with_a_jacobian() {
        let mut random = Random::new(1, 1);
        let none =
            draw(&claim(include_str!("../../../../specs/no-x.json")), &mut random, &mut { MAX_OPERATIONS }).unwrap();
        assert_eq!((none.states(), none.texts().0.len()), (0, 0));
        // A Jacobian without a proved triple draws nothing.
        assert!(
            draw(&claim(include_str!("../../../../specs/paper-example-jacobian.json")), &mut random, &mut {
                MAX_OPERATIONS
            })
            .is_none()
        );
    }
}
