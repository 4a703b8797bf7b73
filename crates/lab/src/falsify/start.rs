//! What a trial starts with: a plant, and a point of the boundary of the set.

use super::claim::TriedClaim;
use super::counterexample::counterexample_plant;
use super::draw::draw;
use super::family::Family;
use super::finding::{Finding, Trial};
use super::limits::SectorEnd;
use super::linear::linear_member;
use super::membership::MAX_OPERATIONS;
use super::random::Random;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Oscillators, StartSizes};
use sigmastar_regulator::Regulator;
use sigmastar_theory::data::Bound;

/// Draws before a trial is given up.
const DRAWS: usize = 30;

/// The plant of a trial as a plant file has it.
pub(super) fn file(claim: &TriedClaim, trial: &Trial) -> Result<Plant, Finding> {
    let file = counterexample_plant(claim, trial, None).and_then(|document| Plant::from_value(&document.root()));
    file.map_err(|errors| Finding::Unfinished(errors.to_string()))
}

/// Draws the plant of a trial.
pub(super) fn drawn_plant(claim: &TriedClaim, number: u64, random: &mut Random) -> Option<Family> {
    // The first trial is the linear member with the largest gains. A drawn matrix F may leave no room; another one may,
    // and where none does the linear member is left.
    let linear = |end, random: &mut Random| linear_member(claim, end, random, &mut { MAX_OPERATIONS });
    let first = if number == 1 { linear(SectorEnd::Upper, random) } else { None };
    let mut left = MAX_OPERATIONS;
    let drawn = first.or_else(|| (0..DRAWS).find_map(|_| draw(claim, random, &mut left)));
    drawn.or_else(|| {
        // With one bound on both sides the adverse end is the upper one.
        let one_sided = claim.spec.bounds.own(Bound::QeMax).is_some();
        let end = if one_sided && random.chance(0.5) { SectorEnd::Lower } else { SectorEnd::Upper };
        linear(end, random)
    })
}

/// Why there is no plant to try.
pub(super) fn no_member(claim: &TriedClaim) -> &'static str {
    match claim.spec.bounds.own(Bound::Rate) {
        None => "no plant of the drawn kind is proved to lie within the families",
        Some(_) => {
            "no plant of the drawn kind, whose df/dx depends on t only, is proved to have the contraction rate and to lie \
             within the families"
        }
    }
}

/// A point of the boundary, for n states: |x| = X0, |e| = E0, |z|_N = Z0 or z = M e.
pub(super) fn boundary(claim: &TriedClaim, n: usize, regulator: &Regulator, random: &mut Random) -> Vec<f64> {
    let StartSizes { x0: x_0, e0: e_0, z0: z_0 } = claim.initial;
    let mut start: Vec<f64> = random.direction(n).iter().map(|part| x_0 * part.value()).collect();
    let e = if random.chance(0.5) { e_0 } else { -e_0 };
    start.push(e);
    let Some(z_0) = z_0 else {
        start.extend(regulator.m().iter().map(|m| m * e));
        return start;
    };
    let mut z: Vec<f64> = (0..regulator.dimension()).map(|_| 2.0 * random.uniform() - 1.0).collect();
    let size = regulator.weighted_norm(&z);
    z.iter_mut().for_each(|part| *part *= if size > 0.0 { z_0 / size } else { 0.0 });
    start.extend(z);
    start
}

/// The regulator of the claim in double precision.
pub(super) fn regulator(claim: &TriedClaim, sigma: f64, oscillators: &Oscillators) -> Regulator {
    let model = &claim.spec.internal_model;
    let weights = oscillators.all().map(|l| model.weights.weight_f64(u64::from(l))).collect();
    let base_frequency = model.base_frequency.to_f64();
    let frequencies = oscillators.beyond_mean().iter().map(|l| f64::from(*l) * base_frequency).collect();
    let nominal = claim.spec.input_gain.as_ref().map(|gain| gain.nominal.to_f64());
    Regulator { sigma, mu: model.mu.to_f64(), frequencies, weights, nominal }
}

#[cfg(test)]
mod tests {
    use super::super::checks::norm;
    use super::*;
    use sigmastar_lang::spec::Specification;

    #[test]
    fn trials_start_on_the_boundary() {
        let spec = Specification::from_json("linear", include_str!("../../../../specs/linear.json")).unwrap();
        let mut claim = TriedClaim::for_tests(spec, [3.0, 3.0]);
        claim.initial = StartSizes { x0: 2.0, e0: 0.5, z0: Some(7.0) };
        let mut random = Random::new(3, 4);
        let plant = draw(&claim, &mut random, &mut { MAX_OPERATIONS }).unwrap();
        let regulator = regulator(&claim, claim.sigma, &Oscillators::first(3));
        let n = plant.states();
        let start = boundary(&claim, n, &regulator, &mut random);
        assert!((norm(&start[..n]) - 2.0).abs() < 1e-5 && start[n].abs() == 0.5);
        assert!((regulator.weighted_norm(&start[n + 1..]) - 7.0).abs() < 1e-12);
        assert_eq!(start.len(), n + 1 + 7);
        claim.initial.z0 = None;
        let start = boundary(&claim, n, &regulator, &mut random);
        let e = start[n];
        assert_eq!(start[n..], [e, e, e, 0.0, e, 0.0, e, 0.0]);
    }
}
