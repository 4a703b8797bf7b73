use super::{Condition, Proposal, RateNumbers, SmallGain};
use crate::semidefinite::propose;
use faer::Mat;
use rug::Rational;
use sigmastar_decide::rates::OscillatorMatrix;
use sigmastar_decide::rates::inequality::*;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::{Oscillators, Specification};
use sigmastar_matrix::AffineMatrix;
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::paths::Paths;
use sigmastar_theory::derivation::stability::ErrorBox;

fn specification(text: &str) -> Specification {
    Specification::from_json("test", text).expect("a sound specification")
}

fn example() -> Specification {
    specification(include_str!("../../../../specs/paper-example.json"))
}

fn rational(p: i32, q: i32) -> Rational {
    Rational::from((p, q))
}

/// About those of the example's certificate.
fn bounds() -> LoopBounds {
    LoopBounds {
        has_x: true,
        x_decay: rational(1, 4),
        root_p_up: rational(5, 4),
        k_x: rational(3, 1),
        k_f: rational(8, 7),
        slopes: [rational(-7, 6), rational(2, 3)],
    }
}

fn sigma() -> Rational {
    rational(48, 1)
}

fn of<'a>(oscillators: &'a OscillatorMatrix, bounds: &'a LoopBounds, sigma: Rational) -> ErrorDynamics<'a> {
    ErrorDynamics { oscillators, sigma, bounds, input_gain: None }
}

/// A proposal for a share of the largest rate, with that rate.
fn proposal(dynamics: &ErrorDynamics<'_>, share: f64) -> (Proposal<RateNumbers>, f64) {
    let condition = SmallGain::new(dynamics).expect("finite");
    let largest = condition.largest_rate().expect("the condition holds");
    (condition.propose(largest, share).expect("a proposal"), largest)
}

/// Its witness.
fn proposed(dynamics: &ErrorDynamics<'_>, share: f64) -> (RateWitness, f64) {
    let (proposal, largest) = proposal(dynamics, share);
    (proposal.in_digits(16).expect("finite"), largest)
}

fn double(value: f64) -> Rational {
    Rational::from_f64(value).expect("finite")
}

/// Doubles in [-1, 1) from a linear congruence.
fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / 2f64.powi(52) - 1.0
    }
}

/// The first few numbers of oscillators, and sets with gaps.
fn sets() -> impl Iterator<Item = Oscillators> {
    let with_gaps = [&[0, 2][..], &[0, 2, 5]].map(|set| Oscillators::at(set).expect("a set"));
    (0..4).map(Oscillators::first).chain(with_gaps)
}

/// v'M v against the derivative of W along the differential equations of derivation section 1 with a gain b, written out with zeta itself.
#[test]
fn the_matrix_is_that_of_the_quadratic_form() {
    let spec = example();
    let data = Data::new(&spec, 128);
    let (bounds, sigma) = (bounds(), sigma());
    for set in sets() {
        let oscillators = OscillatorMatrix::new(&data, &set);
        let ends = [0.75, 1.5].map(|b| data.rational(&double(b)));
        let dynamics = ErrorDynamics { input_gain: Some(ends), ..of(&oscillators, &bounds, sigma.clone()) };
        let harmonics: Vec<usize> = set.all().map(|l| l as usize).collect();
        let n = 2 * harmonics.len();
        let mut next = numbers(harmonics.len() as u64);
        let witness = RateWitness {
            rate: double(next()),
            w: double(next()),
            pi: (0..n).map(|i| (0..=i).map(|_| double(next())).collect()).collect(),
            l: double(next()),
            inputs: [double(next()), double(next())].map(Some),
        };
        let form = Form::new(&dynamics, &witness);
        let v: Vec<f64> = (0..n + 4).map(|_| next()).collect();
        let corners = [[0.75, -7.0 / 6.0], [0.75, 2.0 / 3.0], [1.5, -7.0 / 6.0], [1.5, 2.0 / 3.0]];
        for ([b, delta], corner) in corners.into_iter().zip(dynamics.corners()) {
            let corner = form.corner(&corner);
            let value: f64 = (0..n + 4)
                .flat_map(|i| (0..n + 4).map(move |j| (i, j)))
                .map(|(i, j)| v[i] * v[j] * form.entry(&corner, i, j).midpoint_f64())
                .sum();

            let (xi, y, u_x, disturbance, noise) = (v[0], &v[1..=n], v[n + 1], v[n + 2], v[n + 3]);
            let (mu, w) = (1.0, 2.0 * std::f64::consts::PI);
            let weight = |l: usize| if l == 0 { 2.0 } else { (l as f64).powf(-1.5) };
            // zeta = N^(-1/2) zs, state by state; M'N z has the first state of every oscillator, z = zeta + M e.
            let oscillator = |state: usize| harmonics[state.div_ceil(2)];
            let first = |state: usize| state == 0 || state % 2 == 1;
            let zeta: Vec<f64> = (0..n - 1).map(|i| y[i + 1] / weight(oscillator(i)).sqrt()).collect();
            let s: f64 = (0..n - 1).filter(|i| first(*i)).map(|i| weight(oscillator(i)) * zeta[i]).sum();
            // u = -sigma (e + v) + mu M'N(z - M (e + v)), z' = Phi z + Gamma (e + v), e' = q + d + b u, Gamma = -(Phi + sigma) M.
            let total: f64 = harmonics.iter().map(|l| weight(*l)).sum();
            let u = -48.0 * (y[0] + noise) + mu * (s - total * noise);
            let e_rate = delta * y[0] + u_x + disturbance + b * u;
            let mut derivative = vec![e_rate];
            for i in 0..n - 1 {
                let turn = oscillator(i) as f64 * w;
                let own = match (i, first(i)) {
                    (0, _) => 0.0,
                    (_, true) => turn * zeta[i + 1],
                    (_, false) => -turn * zeta[i - 1],
                };
                // zeta' = Phi zeta - sigma M e - (Phi + sigma) M v - M e'.
                let rest = if first(i) { -48.0 * (y[0] + noise) - e_rate } else { turn * noise };
                derivative.push((own + rest) * weight(oscillator(i)).sqrt());
            }
            let pi = |a: &[f64], b: &[f64]| -> f64 {
                let at = |i: usize, j: usize| witness.pi[i.max(j)][i.min(j)].to_f64();
                (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).map(|(i, j)| a[i] * at(i, j) * b[j]).sum()
            };
            let (rate, weight_of_x) = (witness.rate.to_f64(), witness.w.to_f64());
            let energy = weight_of_x * xi * xi + pi(y, y);
            let phi = 8.0 / 7.0 * y[0];
            let change = weight_of_x * (-2.0 * 0.25 * xi * xi + 2.0 * 1.25 * xi * phi) + 2.0 * pi(y, &derivative);
            let sector = witness.l.to_f64() * (u_x * u_x - 9.0 * xi * xi);
            let weights = witness.inputs.each_ref().map(|weight| weight.as_ref().expect("given").to_f64());
            let inputs = weights[0] * disturbance * disturbance + weights[1] * noise * noise;
            let expected = -change - 2.0 * rate * energy + sector + inputs;
            assert!((value - expected).abs() <= 1e-9 * (1.0 + expected.abs()), "{set} {b}: {value} {expected}");
        }
    }
}

/// The largest rate is known: just below it there is a proof, and nothing proves a rate above it.
#[test]
fn a_proof_stops_at_the_largest_rate() {
    let spec = example();
    let data = Data::new(&spec, 128);
    let (bounds, sigma) = (bounds(), sigma());
    for n_o in [0, 1, 2, 5, 20] {
        let oscillators = OscillatorMatrix::new(&data, &Oscillators::first(n_o));
        let dynamics = of(&oscillators, &bounds, sigma.clone());
        let (witness, largest) = proposed(&dynamics, 0.9999);
        assert!(dynamics.proves(&witness), "{n_o}");
        assert!((0.9998..1.0).contains(&(witness.rate.to_f64() / largest)), "{n_o}");
        for share in [1.0001, 1.01, 2.0] {
            let rate = Rational::from_f64(largest * share).expect("finite");
            assert!(!dynamics.proves(&RateWitness { rate, ..witness.clone() }), "{n_o} {share}");
        }
    }
}

/// A semidefinite program over all of w, Pi and l, which knows nothing of the scalar condition, finds the same largest rate. With the
/// trace of Pi that of the proposal, the largest t with M >= t at both ends and Pi >= t is positive 1 % below the largest rate, and not
/// 1 % above it.
#[test]
fn a_semidefinite_program_finds_the_same_largest_rate() {
    let spec = example();
    let data = Data::new(&spec, 128);
    let (bounds, sigma) = (bounds(), sigma());
    for n_o in [0, 1, 2] {
        let oscillators = OscillatorMatrix::new(&data, &Oscillators::first(n_o));
        let dynamics = of(&oscillators, &bounds, sigma.clone());
        let (found, largest) = proposed(&dynamics, 0.99);
        let n = found.pi.len();
        let pairs: Vec<(usize, usize)> = (0..n).flat_map(|i| (0..=i).map(move |j| (i, j))).collect();
        let unit_of = |i: usize| found.pi[i][i].to_f64().sqrt();
        // The witness as an image of the unknowns, in units of the proposal's own numbers.
        let witness = |rate: f64, unknowns: &[f64], l: f64| {
            let mut pi: Vec<Vec<Rational>> = (0..n).map(|i| vec![Rational::new(); i + 1]).collect();
            for ((i, j), value) in pairs.iter().zip(unknowns) {
                pi[*i][*j] = double(value * unit_of(*i) * unit_of(*j));
            }
            let w = double(unknowns[pairs.len()]) * &found.w;
            RateWitness { rate: double(rate), w, pi, l: double(l), inputs: [None, None] }
        };
        let variables = pairs.len() + 1;
        let unit = |k: usize| (0..variables).map(|i| if i == k { 1.0 } else { 0.0 }).collect::<Vec<f64>>();
        for (share, expected) in [(0.99, true), (1.01, false)] {
            let rate = largest * share;
            let terms: Vec<RateWitness> = (0..variables).map(|k| witness(rate, &unit(k), 0.0)).collect();
            let constant = witness(rate, &vec![0.0; variables], 1.0);
            let mut constraints = Vec::new();
            for corner in dynamics.corners() {
                let form = |witness: &RateWitness| {
                    let form = Form::new(&dynamics, witness);
                    let corner = form.corner(&corner);
                    Mat::from_fn(form.order(), form.order(), |i, j| form.entry(&corner, i, j).midpoint_f64())
                };
                let (constant, forms) = (form(&constant), terms.iter().map(form).collect::<Vec<_>>());
                let order = constant.nrows();
                // Rows in units of the root of the proposal's diagonal.
                let scale = form(&found);
                let root = |i: usize| scale[(i, i)].sqrt();
                let decay = AffineMatrix::from_fn(
                    order,
                    variables,
                    |i, j| constant[(i, j)] / root(i) / root(j),
                    |k, i, j| forms[k][(i, j)] / root(i) / root(j),
                );
                constraints.push(decay.minus_identity());
            }
            let at = |k: usize, i: usize, j: usize| terms[k].pi[i.max(j)][i.min(j)].to_f64() / unit_of(i) / unit_of(j);
            constraints.push(AffineMatrix::from_fn(n, variables, |_, _| 0.0, at).minus_identity());
            let mut cost = vec![0.0; variables + 1];
            cost[variables] = -1.0;
            let solved = propose(&cost, &constraints).expect("solved");
            // The last point of a solver that stops short is none of its answers.
            let margin = if solved.remark.is_none() { solved.x[variables] } else { f64::NEG_INFINITY };
            assert_eq!(margin > 1e-7, expected, "{n_o} {share} {margin}");
            assert_eq!(dynamics.proves(&witness(rate, &solved.x, 1.0)), expected, "{n_o} {share}");
        }
    }
}

/// Every number of a proof near the optimum matters.
#[test]
fn changed_numbers_prove_nothing() {
    let spec = example();
    let data = Data::new(&spec, 128);
    let (plain, sigma) = (bounds(), sigma());
    let oscillators = OscillatorMatrix::new(&data, &Oscillators::first(2));
    let dynamics = of(&oscillators, &plain, sigma.clone());
    let (witness, _) = proposed(&dynamics, 0.9999);
    assert!(dynamics.proves(&witness));

    let changed = |change: &dyn Fn(&mut RateWitness)| {
        let mut other = witness.clone();
        change(&mut other);
        dynamics.proves(&other)
    };
    let (more, less) = (rational(102, 100), rational(100, 102));
    for i in 0..6 {
        assert!(!changed(&|w| w.pi[i][i] *= &more), "{i}");
        assert!(!changed(&|w| w.pi[i][i] *= -1), "{i}");
        assert!(!changed(&|w| drop(w.pi[i].pop())), "{i}");
    }
    assert!(!changed(&|w| w.pi[1][0] += rational(1, 100)));
    assert!(!changed(&|w| drop(w.pi.pop())));
    for factor in [&Rational::new(), &rational(-1, 1), &more, &less] {
        assert!(!changed(&|w| w.l *= factor), "{factor}");
        assert!(!changed(&|w| w.w *= factor), "{factor}");
    }

    let more = rational(101, 100);
    let under = |change: &dyn Fn(&mut LoopBounds)| {
        let mut bounds = plain.clone();
        change(&mut bounds);
        of(&oscillators, &bounds, sigma.clone()).proves(&witness)
    };
    assert!(!under(&|b| b.k_x *= &more) && under(&|b| b.k_x /= &more));
    assert!(!under(&|b| b.k_f *= &more) && under(&|b| b.k_f /= &more));
    for end in [0, 1] {
        // Closer together they may be, as the module says.
        assert!(!under(&|b| b.slopes[end] *= rational(11, 10)) && under(&|b| b.slopes[end] /= &more), "{end}");
    }
    assert!(!under(&|b| b.root_p_up *= &more) && under(&|b| b.root_p_up /= &more));
    assert!(!under(&|b| b.x_decay /= &more) && under(&|b| b.x_decay *= &more));
    assert!(!of(&oscillators, &plain, rational(46, 1)).proves(&witness));
    let other = OscillatorMatrix::new(&data, &Oscillators::first(3));
    assert!(!of(&other, &plain, sigma.clone()).proves(&witness));
    let ends = [rational(98, 100), rational(102, 100)].map(|b| data.rational(&b));
    assert!(!ErrorDynamics { input_gain: Some(ends), ..dynamics }.proves(&witness));
}

/// Linear plants whose u and phi stay within the bounds are no slower than the proved rate, by their eigenvalues.
#[test]
fn no_admissible_linear_plant_is_slower() {
    let spec = example();
    let data = Data::new(&spec, 128);
    let cases = [
        ([3, 1], [-1, 1], 48, [1.0; 2]),
        ([3, 1], [-1, 0], 20, [1.0; 2]),
        ([1, 1], [-4, 1], 10, [1.0; 2]),
        ([6, 2], [-1, -1], 70, [1.0; 2]),
        ([0, 0], [-2, 2], 5, [1.0; 2]),
        ([1, 1], [-1, 1], 20, [0.9, 1.1]),
        ([1, 1], [-1, 0], 20, [0.8, 1.25]),
    ];
    for ([k_x, k_f], slopes, sigma, gain) in cases {
        let number = |k: i32| rational(k, 1);
        let bounds = LoopBounds { k_x: number(k_x), k_f: number(k_f), slopes: slopes.map(number), ..bounds() };
        for n_o in [0, 1, 2, 5] {
            let oscillators = OscillatorMatrix::new(&data, &Oscillators::first(n_o));
            let ends = gain.map(|b| data.rational(&double(b)));
            let input_gain = (gain[0] < gain[1]).then_some(ends);
            let dynamics = ErrorDynamics { input_gain, ..of(&oscillators, &bounds, number(sigma)) };
            let (witness, _) = proposed(&dynamics, 0.9999);
            assert!(dynamics.proves(&witness), "{k_x} {k_f} {slopes:?} {sigma} {n_o}");
            let n = witness.pi.len();
            let b: Vec<f64> = oscillators.b.iter().map(Enclosure::midpoint_f64).collect();
            let mut slowest = f64::INFINITY;
            for signs in 0..54 {
                let [x, e, f, g] = [signs % 3, signs / 3 % 3, signs / 9 % 3, signs / 27];
                let sign = |k: i32| f64::from(k - 1);
                let (k_x, k_f) = (sign(x) * f64::from(k_x), sign(f) * f64::from(k_f));
                let slope =
                    [f64::from(slopes[0]), f64::from(slopes[0] + slopes[1]) / 2.0, f64::from(slopes[1])][e as usize];
                let (gain, sigma) = (gain[g as usize], f64::from(sigma));
                // xi' = -(1/4) xi + (5/4) phi, phi = k_f et; et' = u + gain (-sigma et + s), zs' = Phi zs - b (sigma et + et').
                let loop_matrix = Mat::from_fn(n + 1, n + 1, |i, j| {
                    let s = if j >= 2 { b[j - 2] } else { 0.0 };
                    let e = if j == 1 { 1.0 } else { 0.0 };
                    let e_rate = [k_x, slope].get(j).copied().unwrap_or(0.0) + gain * (s - sigma * e);
                    match i {
                        0 => [-0.25, 1.25 * k_f].get(j).copied().unwrap_or(0.0),
                        1 => e_rate,
                        _ => {
                            let turn = match j.checked_sub(2).and_then(|column| oscillators.phi(column)) {
                                Some((row, entry)) if row + 2 == i => entry.midpoint_f64(),
                                _ => 0.0,
                            };
                            turn - b[i - 2] * (sigma * e + e_rate)
                        }
                    }
                });
                let values = loop_matrix.eigenvalues().expect("finite");
                slowest = values.iter().map(|value| -value.re).fold(slowest, f64::min);
            }
            assert!(witness.rate.to_f64() <= slowest * (1.0 + 1e-9), "{k_x} {k_f} {slopes:?} {sigma} {n_o} {slowest}");
        }
    }
}

/// Digits that are left off do not undo a proof with room, and are left off.
#[test]
fn few_digits_are_enough() {
    let spec = example();
    let data = Data::new(&spec, 128);
    let bounds = bounds();
    for n_o in [0, 4, 20] {
        let oscillators = OscillatorMatrix::new(&data, &Oscillators::first(n_o));
        let dynamics = of(&oscillators, &bounds, sigma());
        let (proposal, _) = proposal(&dynamics, 0.95);
        let digits =
            (3..16).find(|digits| dynamics.proves(&proposal.in_digits(*digits).expect("finite"))).expect("some");
        assert!(digits <= 9, "{n_o} {digits}");
        let short = proposal.in_digits(6).expect("finite");
        assert!(short.pi.iter().flatten().all(|entry| entry.numer().significant_bits() <= 20 || *entry.denom() == 1));
    }
}

/// Bounds of 0 leave out their signals; without x the rate is not held back by alpha.
#[test]
fn signals_that_vanish_are_left_out() {
    let spec = example();
    let data = Data::new(&spec, 128);
    let oscillators = OscillatorMatrix::new(&data, &Oscillators::first(1));
    let none = Rational::new;
    for present in 0..4 {
        let [k_x, k_f] = [(0, 3), (1, 1)].map(|(bit, k)| if present >> bit & 1 == 1 { rational(k, 1) } else { none() });
        let bounds = LoopBounds { k_x, k_f, ..bounds() };
        let dynamics = of(&oscillators, &bounds, sigma());
        let (witness, _) = proposed(&dynamics, 0.999);
        assert!(dynamics.proves(&witness), "{present}");
        assert!(witness.rate < bounds.x_decay);
    }
    let without = LoopBounds { has_x: false, k_x: none(), k_f: none(), ..bounds() };
    let dynamics = of(&oscillators, &without, sigma());
    let (witness, _) = proposed(&dynamics, 0.999);
    assert!(dynamics.proves(&witness) && witness.rate > without.x_decay);
}

/// Only k_x = 0 says that x has no part in e.
#[test]
fn a_plant_without_x_is_recognised() {
    let bounds_of = |spec: &Specification| {
        let data = Data::new(spec, 128);
        let one = data.rational(&rational(1, 2));
        let error_box = ErrorBox::new(&data, Paths::UNNAMED, [&one; 2], [&one; 2]);
        LoopBounds::of_error(&data, &error_box).expect("bounded")
    };
    let without = bounds_of(&specification(include_str!("../../../../specs/no-x.json")));
    assert!(!without.has_x);
    assert!(without.k_x == 0 && without.k_f == 0 && without.slopes == [-1, 1]);
    let with = bounds_of(&example());
    assert!(with.has_x && with.k_x > 0 && with.k_f > 0);
    // At (X_b, E_b) = (1, 1): k_x = sqrt(2), k_e = k_f = 1.189.
    assert_eq!([&with.slopes[1], &-with.slopes[0].clone()], [&with.k_f; 2]);
    assert!((with.k_f.to_f64() - 1.189).abs() < 1e-15 && (with.k_x.to_f64() - 2f64.sqrt()).abs() < 1e-15);
}

/// M may be definite with a W that is not: x decays at 1/4 only, and nothing at 100.
#[test]
fn a_w_that_is_not_definite_proves_nothing() {
    let spec = example();
    let data = Data::new(&spec, 128);
    let oscillators = OscillatorMatrix::new(&data, &Oscillators::first(0));
    let none = Rational::new;
    let without = LoopBounds { has_x: false, k_x: none(), k_f: none(), ..bounds() };
    let dynamics = of(&oscillators, &without, sigma());
    let (witness, _) = proposed(&dynamics, 0.999);
    assert!(dynamics.proves(&witness) && witness.rate > 1);
    let with = LoopBounds { has_x: true, ..without.clone() };
    let dynamics = of(&oscillators, &with, sigma());
    assert!(!dynamics.proves(&RateWitness { w: rational(-1, 1), ..witness.clone() }));

    let dynamics = of(&oscillators, &without, sigma());
    let pi = vec![vec![rational(-1, 1)], vec![Rational::new(), rational(-1, 1)]];
    assert!(!dynamics.proves(&RateWitness { rate: rational(100, 1), pi, ..witness }));
}
