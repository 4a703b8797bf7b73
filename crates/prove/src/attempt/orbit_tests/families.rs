//! Families of plants (derivation, 13.2): the orbit of every member lies in its tube, and what is too good is refused.

use super::super::*;
use super::paper;
use rug::Rational;
use sigmastar_decide::orbit::*;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Interval, ProvedForcing};
use sigmastar_propose::orbit::*;
use sigmastar_theory::evidence::*;

const PAPER: &str = include_str!("../../../../../specs/plants/paper-example.json");

/// The paper's example with two numbers in intervals.
fn family(k: [&str; 2], c: [&str; 2]) -> Plant {
    let [k, c] = [("1/5", k), ("1/10", c)]
        .map(|(nominal, [low, high])| format!(r#"{{ "nominal": "{nominal}", "low": "{low}", "high": "{high}" }}"#));
    let parameters = format!(r#""parameters": {{ "k": {k}, "c": {c} }}, "states""#);
    let text = PAPER.replacen("x1/5", "k*x1", 1).replacen("x2^2/10", "c*x2^2", 1);
    Plant::from_json("family", &text.replacen("\"states\"", &parameters, 1)).unwrap()
}

pub(super) fn proved(plant: &Plant) -> (Coordinates, OrbitProof, ProvedForcing) {
    let found = find_orbit(plant).unwrap();
    let orbit = round_orbit(plant, &found).unwrap();
    let mut last = None;
    for Rated { coordinates, .. } in propose_coordinates(plant, &found, 0.0, 0.0).unwrap() {
        match prove_orbit(plant, &orbit, &coordinates) {
            Ok(proof) => {
                let forcing = prove_forcing(plant, &coordinates, &proof).unwrap();
                return (coordinates, proof, forcing);
            }
            Err(failure) => last = Some(failure),
        }
    }
    panic!("{last:?}")
}

/// The curve at a point of the box is near the orbit that is found of that member alone.
#[test]
fn the_orbits_of_members_are_followed() {
    let plant = family(["0.18", "0.22"], ["0", "0.2"]);
    let (coordinates, proof, forcing) = proved(&plant);
    // Second order in the width: two thousandths of what the parameters change at first order.
    assert!(proof.defect < Rational::from((1, 10_000)), "{}", proof.defect.to_f64());
    decide_orbit(&plant, &coordinates, &proof).unwrap();
    decide_forcing(&plant, &coordinates, &proof, &forcing).unwrap();
    let inside = [(19, 100), (3, 20)].map(Rational::from).to_vec();
    is_followed(&plant, &coordinates, &proof, [inside]);
}

/// The curve at the corners of the box and at these points lies within the radius of the orbit that is found of the member.
pub(super) fn is_followed(
    plant: &Plant,
    coordinates: &Coordinates,
    proof: &OrbitProof,
    inside: impl IntoIterator<Item = Vec<Rational>>,
) {
    for values in plant.parameters.looked_at().into_iter().chain(inside) {
        let own = find_orbit(&plant.member(&values)).unwrap().series;
        let curve = doubles(&proof.orbit.at(&plant.parameters.deviations(&values)));
        for s in [0.0, 0.2, 0.45, 0.7, 0.9] {
            let (own, near) = (own.at(s).0, curve.at(s).0);
            let difference: Vec<f64> = own.iter().zip(&near).map(|(a, b)| a - b).collect();
            // |L^-1 d| by Cramer's rule.
            let l = |i: usize, j: usize| coordinates.l[i][j].to_f64();
            let determinant = l(0, 0) * l(1, 1) - l(0, 1) * l(1, 0);
            let y = [
                (l(1, 1) * difference[0] - l(0, 1) * difference[1]) / determinant,
                (l(0, 0) * difference[1] - l(1, 0) * difference[0]) / determinant,
            ];
            let radius = proof.radius.to_f64();
            assert!(y[0].hypot(y[1]) <= radius, "{values:?} {s}: {y:?} {radius}");
        }
    }
}

#[test]
fn what_is_too_good_for_a_member_is_refused() {
    let plant = family(["0.18", "0.22"], ["0", "0.2"]);
    let (coordinates, proof, forcing) = proved(&plant);
    let part = |value: &Rational| Rational::from(value / 100_u32);
    for moved in [
        OrbitProof { defect: part(&proof.defect), radius: part(&proof.radius), ..proof.clone() },
        // Without the sensitivity of k.
        OrbitProof {
            orbit: sigmastar_lang::spec::OrbitCurve {
                sensitivities: vec![proof.orbit.sensitivities[1].clone(); 2],
                ..proof.orbit.clone()
            },
            ..proof.clone()
        },
        OrbitProof { orbit: proof.orbit.centre.clone().into(), ..proof.clone() },
    ] {
        assert!(decide_orbit(&plant, &coordinates, &moved).is_err());
    }
    for moved in [
        ProvedForcing { rest: part(&forcing.rest), ..forcing.clone() },
        ProvedForcing { sensitivities: vec![forcing.sensitivities[1].clone(); 2], ..forcing.clone() },
        ProvedForcing { sensitivities: Vec::new(), ..forcing.clone() },
    ] {
        assert!(decide_forcing(&plant, &coordinates, &proof, &moved).is_err());
    }
    // A proof for a narrower box is none for a wider one.
    let wider = family(["0.1", "0.3"], ["-0.3", "0.5"]);
    assert!(decide_orbit(&wider, &coordinates, &proof).is_err());
}

/// A plant with one state and one parameter p.
fn of_one(f: &str, q: &str, [nominal, low, high]: [&str; 3]) -> Plant {
    let parameters = format!(r#"{{ "p": {{ "nominal": "{nominal}", "low": "{low}", "high": "{high}" }} }}"#);
    let text = format!(
        r#"{{ "format": "sigmastar/plant", "version": 1, "name": "one", "period": "1", "states": ["x"], "f": ["{f}"], "q": "{q}",
        "parameters": {parameters}, "internal_model": {{ "mu": "1", "base_frequency": "2*pi", "matched": true,
        "weights": {{ "family": "power", "n0": "2", "epsilon": "1/2" }} }}, "initial": {{ "x": ["2"], "e": "0" }} }}"#
    );
    Plant::from_json("one", &text).unwrap()
}

/// The rate is that of the slowest member, by its own formulas (1, where the nominal one has 3/2) and along its own orbit (at sqrt(p),
/// 3.9497 where the nominal one has 4).
#[test]
fn the_rate_is_that_of_the_slowest_member() {
    for (f, interval, most, [between, tube]) in [
        ("-p*x + cos(2*pi*t)", ["3/2", "1", "2"], (1, 1), [(6, 5), (1, 10)]),
        ("p - x^2", ["4", "3.9", "4.1"], (395, 100), [(3955, 1000), (1, 1000)]),
    ] {
        let plant = of_one(f, "x", interval);
        let (coordinates, proof, _) = proved(&plant);
        assert!(proof.alpha <= Rational::from(most), "{f}: {}", proof.alpha.to_f64());
        let forged = OrbitProof { alpha: Rational::from(between), tube: Rational::from(tube), ..proof };
        let failure = decide_orbit(&plant, &coordinates, &forged).unwrap_err();
        assert!(matches!(failure, OrbitNotProved::Rate { .. }), "{f}: {failure:?}");
    }
}

/// A rate that intervals of the parameter lose all at once, in coordinates in which large numbers cancel, and its halves do not; in each
/// of the halves it is that of the member which is slowest.
#[test]
fn the_rate_is_proved_with_halves_of_the_parameters() {
    let text = r#"{ "format": "sigmastar/plant", "version": 1, "name": "two", "period": "1", "states": ["x", "y"],
        "f": ["-p*x", "-p*y"], "q": "x", "parameters": { "p": { "nominal": "5/2", "low": "2", "high": "3" } },
        "internal_model": { "mu": "1", "base_frequency": "2*pi", "matched": true,
        "weights": { "family": "power", "n0": "2", "epsilon": "1/2" } } }"#;
    let plant = Plant::from_json("two", text).unwrap();
    let (coordinates, proof, _) = proved(&plant);
    // J is -p I in all coordinates; entry by entry, with p an interval, what cancels here does not.
    let l = [[1, 0], [20, 1]].map(|row| row.map(Rational::from).to_vec()).to_vec();
    let skewed = Coordinates { l, ..coordinates };
    let radius = proof.tube.clone() / 2u32;
    let with = |alpha: (i32, i32)| OrbitProof { alpha: Rational::from(alpha), radius: radius.clone(), ..proof.clone() };
    decide_orbit(&plant, &skewed, &with((3, 2))).unwrap();
    // The slowest members are at the other end here.
    let mirrored = Plant::from_json("two", &text.replace("-p*x", "(p - 5)*x").replace("-p*y", "(p - 5)*y")).unwrap();
    decide_orbit(&mirrored, &skewed, &with((3, 2))).unwrap();
    // Beyond the slowest member, and not beyond the nominal one.
    for plant in [&plant, &mirrored] {
        let failure = decide_orbit(plant, &skewed, &with((21, 10))).unwrap_err();
        assert!(matches!(failure, OrbitNotProved::Rate { .. }), "{failure:?}");
    }
}

/// What the distance from xb adds to the rest is that of the member in which q has the largest slope.
#[test]
fn the_rest_is_that_of_the_steepest_member() {
    let plant = of_one("-x + cos(2*pi*t)", "p*x", ["1", "1", "2"]);
    let (coordinates, proof, _) = proved(&plant);
    let far = OrbitProof { radius: Rational::from((1, 100)), tube: Rational::from((1, 50)), ..proof };
    let forcing = prove_forcing(&plant, &coordinates, &far).unwrap();
    let share = coordinates.l[0][0].clone().abs() / 100u32;
    let [least, most] = [(2, 1), (201, 100)].map(|factor| Rational::from(factor) * &share);
    assert!(forcing.rest >= least && forcing.rest < most, "{}", forcing.rest.to_f64());
}

#[test]
fn a_family_of_one_point_is_the_plant() {
    let plant = family(["1/5", "1/5"], ["1/10", "1/10"]);
    assert!(!plant.is_family());
    let [own, other] = [plant, paper()].map(|plant| round_orbit(&plant, &find_orbit(&plant).unwrap()).unwrap());
    assert!(own.sensitivities.is_empty());
    // k*x1 is rounded otherwise than x1/5.
    let difference = Rational::from(&own.centre.mean[0] - &other.centre.mean[0]);
    assert!(difference.abs() < Rational::from((1, 100_000_000)));
    // A corner that is unstable is told.
    let unstable = family(["-3", "1/2"], ["0", "0.2"]);
    assert!(find_orbit(&unstable).is_err());
    let intervals: Vec<Interval> = unstable.parameters.intervals().cloned().collect();
    assert_eq!(intervals[0].nominal, Rational::from((1, 5)));
}

/// Two halves are proved with one rate; each radius follows from it, and each is decided again.
#[test]
fn halves_have_one_rate() {
    let plant = family(["0.1", "0.3"], ["0", "0.2"]);
    let found = find_orbit(&plant).unwrap();
    let coordinates = propose_coordinates(&plant, &found, 0.0, 0.0).unwrap().swap_remove(0).coordinates;
    let [low, middle, high] = [(1, 10), (1, 5), (3, 10)].map(Rational::from);
    let c = [Rational::new(), Rational::from((1, 5))];
    let halves = [[low, middle.clone()], [middle, high]].map(|k| {
        let half = Plant { parameters: plant.parameters.in_cell(&[k, c.clone()]), ..plant.clone() };
        let orbit = round_orbit(&half, &find_orbit(&half).unwrap()).unwrap();
        (half, orbit)
    });
    let cells = halves.each_ref().map(|(half, orbit)| (half, orbit));
    let proofs = prove_orbits(&cells, &coordinates).unwrap();
    let alone = cells.map(|(half, orbit)| prove_orbit(half, orbit, &coordinates).unwrap());
    let least = alone.iter().map(|proof| &proof.alpha).min().unwrap();
    assert!(proofs.iter().all(|proof| proof.alpha == *least) && alone[0].alpha != alone[1].alpha);
    for ((half, _), proof) in cells.iter().zip(&proofs) {
        decide_orbit(half, &coordinates, proof).unwrap();
    }
    // The half with the larger rate pays for the smaller one.
    let larger = usize::from(alone[1].alpha > alone[0].alpha);
    assert!(proofs[larger].radius > alone[larger].radius);
    // The orbit of one half is none of the other.
    assert!(decide_orbit(cells[0].0, &coordinates, &proofs[1]).is_err());
    // What adds most to the defect of the whole box is k.
    let orbit = round_orbit(&plant, &found).unwrap();
    let [of_k, of_c] = defects_by_parameter(&plant, &orbit, &coordinates)[..] else { panic!("two parameters") };
    assert!(of_k > of_c && of_c > 0.0, "{of_k} {of_c}");
}
