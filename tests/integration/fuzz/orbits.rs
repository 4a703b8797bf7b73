//! The defect of an approximate orbit and the rests of the forcing, stated 0.1 % below a value which is met: neither program
//! may prove one.

use super::plants::{Drawn, rational};
use super::random;
use crate::support::cases;
use rand::RngExt;
use rug::Rational;
use sigmastar_decide::orbit::{decide_forcing, decide_orbit};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::expr::{Enclosing, Formulas, PlantExpr};
use sigmastar_lang::spec::{ProvedForcing, TrigonometricVector};
use sigmastar_matrix::inverse;
use sigmastar_theory::evidence::OrbitProof;

const PRECISION: u32 = 128;

/// Times of a period at which values are met.
const TIMES: u32 = 150;

/// What is added to a value which is met, and to the largest of them for a true one.
const PARTS: [(f64, bool); 2] = [(-0.001, false), (0.5, true)];

/// The curve and its derivative at a time.
fn at(orbit: &TrigonometricVector, time: &Enclosure) -> [Vec<Enclosure>; 2] {
    let turn = Enclosure::pi(PRECISION) * 2;
    let exact = |value: &Rational| Enclosure::from_rational(value, PRECISION);
    let component = |i: usize| {
        let start = (exact(&orbit.mean[i]), Enclosure::zero(PRECISION));
        orbit.harmonics.iter().zip(1_i64..).fold(start, |(value, slope), ([a, b], k)| {
            let (rate, [a, b]) = (&turn * k, [exact(&a[i]), exact(&b[i])]);
            let angle = &rate * time;
            let [cos, sin] = [angle.cos(), angle.sin()];
            (value + &a * &cos + &b * &sin, slope + (b * cos - a * sin) * rate)
        })
    };
    let (values, slopes) = (0..orbit.mean.len()).map(component).unzip();
    [values, slopes]
}

/// The values of some formulas along the curve at e = 0.
fn along(exprs: &[PlantExpr], orbit: &TrigonometricVector, time: &Enclosure) -> Vec<Enclosure> {
    let mut formulas = Formulas::new();
    let all: Vec<_> = exprs.iter().map(|expr| formulas.insert(expr)).collect();
    let [x, _] = at(orbit, time);
    let zero = Enclosure::zero(PRECISION);
    formulas.walk(&all).evaluate(&mut Enclosing { t: time, x: &x, e: &zero, p: &[], precision: PRECISION })
}

fn times() -> impl Iterator<Item = Enclosure> {
    (0..TIMES).map(|i| Enclosure::from_rational(&Rational::from((i, TIMES)), PRECISION))
}

/// The largest `|L^-1 (f(t,xb,0) - xb')|` that is met.
fn largest_defect(drawn: &Drawn, orbit: &TrigonometricVector) -> f64 {
    let inverse = inverse(&drawn.l).expect("L has an inverse");
    let norm = |time: Enclosure| {
        let (f, [_, slope]) = (along(&drawn.plant.f, orbit, &time), at(orbit, &time));
        let component = |row: &Vec<Rational>| -> f64 {
            let terms = row.iter().zip(f.iter().zip(&slope));
            terms.map(|(weight, (f, slope))| weight.to_f64() * (f - slope).midpoint_f64()).sum()
        };
        inverse.iter().map(|row| component(row).powi(2)).sum::<f64>().sqrt()
    };
    times().map(norm).fold(0.0, f64::max)
}

/// The largest |q(t,x_0,0)| and the largest difference quotient of it that are met.
fn largest_forcing(drawn: &Drawn) -> [f64; 2] {
    let q = std::slice::from_ref(&drawn.plant.q);
    let step = Rational::from((1, 1 << 20));
    let shift = Enclosure::from_rational(&step, PRECISION);
    times().fold([0.0_f64, 0.0], |[value, slope], time| {
        let [here, there] = [time.clone(), &time + &shift].map(|time| along(q, &drawn.orbit, &time).remove(0));
        let quotient = (there - &here).midpoint_f64() / step.to_f64();
        [value.max(here.midpoint_f64().abs()), slope.max(quotient.abs())]
    })
}

fn part_of(value: f64, part: f64) -> Rational {
    Rational::from_f64(value * (1.0 + part)).expect("a finite number")
}

#[test]
fn fuzz_defects_of_orbits() {
    let large = Rational::from(1) << 60;
    let mut accepted = [0, 0];
    let cases = cases(2, 400);
    for case in cases.clone() {
        let random = &mut random(7, case);
        let drawn = Drawn::new(random);
        // A curve beside the orbit.
        let mut orbit = drawn.orbit.clone();
        orbit.harmonics.resize(
            random.random_range(1..4),
            [vec![Rational::new(); drawn.l.len()], vec![Rational::new(); drawn.l.len()]],
        );
        let size = Rational::from(&drawn.tube / random.random_range(10..1000));
        let last = orbit.harmonics.len() - 1;
        let state = random.random_range(0..drawn.l.len());
        orbit.harmonics[last][random.random_range(0..2)][state] += size;
        let largest = largest_defect(&drawn, &orbit);
        for (part, right) in PARTS {
            let defect = part_of(largest, part);
            // sqrt(p_up/p_low) is below 3/2.
            let radius = Rational::from(&defect * 2) / &drawn.alpha[0];
            let tube = Rational::from(&radius * 2).max(drawn.tube.clone());
            let proof = OrbitProof { orbit: orbit.clone().into(), defect, radius, tube, ..drawn.proof() };
            let producer = decide_orbit(&drawn.plant, &drawn.coordinates(), &proof).is_ok();
            let checker = drawn.checked(&drawn.witness(&proof, [&large, &large], &[])) == Some(true);
            if right {
                accepted = [accepted[0] + u64::from(producer), accepted[1] + u64::from(checker)];
            } else {
                let what = || format!("case {case}: {largest} is met: {}", drawn.name());
                assert!(!producer && !checker, "{producer} {checker} {}", what());
            }
        }
    }
    println!("true defects proved: {accepted:?} of {cases:?}");
}

#[test]
fn fuzz_rests_of_the_forcing() {
    let mut accepted = [0, 0];
    let cases = cases(2, 400);
    for case in cases.clone() {
        let random = &mut random(8, case);
        let drawn = Drawn::new(random);
        let largest = largest_forcing(&drawn);
        for (which, (part, right)) in [0, 1].into_iter().flat_map(|which| PARTS.map(|part| (which, part))) {
            let mut rests = [rational("1e9"), rational("1e9")];
            rests[which] = part_of(largest[which], part);
            let [rest, rest_t] = rests.clone();
            let forcing =
                ProvedForcing { mean: Rational::new(), harmonics: Vec::new(), sensitivities: Vec::new(), rest, rest_t };
            let proof = drawn.proof();
            let producer = decide_forcing(&drawn.plant, &drawn.coordinates(), &proof, &forcing).is_ok();
            let checker = drawn.checked(&drawn.witness(&proof, rests.each_ref(), &[])) == Some(true);
            if right {
                accepted = [accepted[0] + u64::from(producer), accepted[1] + u64::from(checker)];
            } else {
                let what = || format!("case {case}: {largest:?} is met: {}", drawn.name());
                assert!(!producer && !checker, "{which}: {producer} {checker} {}", what());
            }
        }
    }
    println!("true rests proved: {accepted:?} of {cases:?}, twice");
}
