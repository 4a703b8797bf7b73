use super::super::riccati;
use super::super::small_gain::SmallGain;
use super::*;
use sigmastar_lang::spec::Specification;
use sigmastar_matrix::AffineMatrix;
use sigmastar_matrix::semidefinite::propose;
use sigmastar_theory::derivation::paths::Paths;

fn specification(text: &str) -> Specification {
    Specification::from_json("test", text).expect("a sound specification")
}

fn example() -> Specification {
    specification(include_str!("../../../../../specs/paper-example.json"))
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
        gains: [rational(3, 1), rational(7, 6), rational(8, 7)],
    }
}

fn sigma() -> Rational {
    rational(48, 1)
}

/// A witness for a share of the largest rate, with that rate.
fn proposed(dynamics: &ErrorDynamics<'_>, share: f64) -> (RateWitness, f64) {
    let eigen = dynamics.oscillators.eigen().expect("finite");
    let condition = SmallGain::new(dynamics, eigen.values());
    let largest = condition.largest_rate().expect("the condition holds");
    (riccati::propose(dynamics, &condition, largest, share).expect("a proposal"), largest)
}

/// Doubles in [-1, 1) from a linear congruence.
fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / 2f64.powi(52) - 1.0
    }
}

/// v'M v against the derivative of W along the differential equations of derivation section 1, written out with zeta itself.
#[test]
fn the_matrix_is_that_of_the_quadratic_form() {
    let spec = example();
    let data = Data::new(&spec, 128);
    let (bounds, sigma) = (bounds(), sigma());
    for n_o in 0..4_u32 {
        let oscillators = OscillatorMatrix::new(&data, n_o);
        let dynamics = ErrorDynamics { oscillators: &oscillators, sigma: sigma.clone(), bounds: &bounds };
        let n = 2 * n_o as usize + 2;
        let mut next = numbers(u64::from(n_o) + 1);
        let random = Mat::from_fn(n, n, |_, _| next());
        let witness = RateWitness {
            rate: Rational::from_f64(next()).expect("finite"),
            w_x: next(),
            q: &random + random.transpose(),
            multipliers: [next(), next(), next()],
        };
        let form = Form::new(&dynamics, &witness).expect("finite");
        let v: Vec<f64> = (0..n + 4).map(|_| next()).collect();
        let value: f64 = (0..n + 4)
            .flat_map(|i| (0..n + 4).map(move |j| (i, j)))
            .map(|(i, j)| v[i] * v[j] * form.entry(form.signals[i], form.signals[j]).midpoint_f64())
            .sum();

        let (xi, y, u_x, u_e, phi) = (v[0], &v[1..=n], v[n + 1], v[n + 2], v[n + 3]);
        let (mu, w) = (1.0, 2.0 * std::f64::consts::PI);
        let weight = |l: usize| if l == 0 { 2.0 } else { (l as f64).powf(-1.5) };
        // zeta = N^(-1/2) zs, state by state; M'N zeta has the first state of every oscillator.
        let oscillator = |state: usize| state.div_ceil(2);
        let first = |state: usize| state == 0 || state % 2 == 1;
        let zeta: Vec<f64> = (0..n - 1).map(|i| y[i + 1] / weight(oscillator(i)).sqrt()).collect();
        let s: f64 = (0..n - 1).filter(|i| first(*i)).map(|i| weight(oscillator(i)) * zeta[i]).sum();
        let u = u_x + u_e;
        let mut derivative = vec![u - 48.0 * y[0] + mu * s];
        for i in 0..n - 1 {
            let turn = oscillator(i) as f64 * w;
            let own = match (i, first(i)) {
                (0, _) => 0.0,
                (_, true) => turn * zeta[i + 1],
                (_, false) => -turn * zeta[i - 1],
            };
            let rest = if first(i) { -mu * s - u } else { 0.0 };
            derivative.push((own + rest) * weight(oscillator(i)).sqrt());
        }
        let q = |a: &[f64], b: &[f64]| -> f64 {
            (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).map(|(i, j)| a[i] * witness.q[(i, j)] * b[j]).sum()
        };
        let rate = witness.rate.to_f64();
        let energy = witness.w_x * xi * xi + q(y, y);
        let change = witness.w_x * (-2.0 * 0.25 * xi * xi + 2.0 * 1.25 * xi * phi) + 2.0 * q(y, &derivative);
        let [l_x, l_e, l_f] = witness.multipliers;
        let sectors = l_x * (u_x * u_x - 9.0 * xi * xi)
            + l_e * (u_e * u_e - (7.0f64 / 6.0).powi(2) * y[0] * y[0])
            + l_f * (phi * phi - (8.0f64 / 7.0).powi(2) * y[0] * y[0]);
        let expected = -change - 2.0 * rate * energy + sectors;
        assert!((value - expected).abs() <= 1e-9 * (1.0 + expected.abs()), "{n_o}: {value} {expected}");
    }
}

/// The largest rate is known: just below it there is a proof, and nothing proves a rate above it.
#[test]
fn a_proof_stops_at_the_largest_rate() {
    let spec = example();
    let data = Data::new(&spec, 128);
    let (bounds, sigma) = (bounds(), sigma());
    for n_o in [0, 1, 2, 5, 20] {
        let oscillators = OscillatorMatrix::new(&data, n_o);
        let dynamics = ErrorDynamics { oscillators: &oscillators, sigma: sigma.clone(), bounds: &bounds };
        let (witness, largest) = proposed(&dynamics, 0.9999);
        assert!(dynamics.proves(&witness), "{n_o}");
        assert!((0.9998..1.0).contains(&(witness.rate.to_f64() / largest)), "{n_o}");
        for share in [1.0001, 1.01, 2.0] {
            let rate = Rational::from_f64(largest * share).expect("finite");
            assert!(!dynamics.proves(&RateWitness { rate, ..witness.clone() }), "{n_o} {share}");
        }
    }
}

/// The same optimum by a semidefinite program over all of w_x, Q and the multipliers, which knows nothing of the scalar condition:
/// with l_x = 1 the largest t with M >= t and Q >= t is positive 1 % below the largest rate and not 1 % above it.
#[test]
fn a_semidefinite_program_finds_the_same_largest_rate() {
    let spec = example();
    let data = Data::new(&spec, 128);
    let (bounds, sigma) = (bounds(), sigma());
    for n_o in [0, 1, 2] {
        let oscillators = OscillatorMatrix::new(&data, n_o);
        let dynamics = ErrorDynamics { oscillators: &oscillators, sigma: sigma.clone(), bounds: &bounds };
        let (found, largest) = proposed(&dynamics, 0.99);
        let n = found.q.nrows();
        let pairs: Vec<(usize, usize)> = (0..n).flat_map(|i| (0..=i).map(move |j| (i, j))).collect();
        // The witness as an image of the unknowns, in units of the proposal's own numbers.
        let witness = |rate: f64, unknowns: &[f64], l_x: f64| {
            let mut q = Mat::zeros(n, n);
            for ((i, j), value) in pairs.iter().zip(unknowns) {
                (q[(*i, *j)], q[(*j, *i)]) = (*value * found.q[(0, 0)], *value * found.q[(0, 0)]);
            }
            let [w_x, l_e, l_f] = [0, 1, 2].map(|k| unknowns[pairs.len() + k]);
            RateWitness {
                rate: Rational::from_f64(rate).expect("finite"),
                w_x: w_x * found.w_x,
                q,
                multipliers: [l_x, l_e * found.multipliers[1], l_f * found.multipliers[2]],
            }
        };
        let variables = pairs.len() + 3;
        let unit = |k: usize| (0..variables).map(|i| if i == k { 1.0 } else { 0.0 }).collect::<Vec<f64>>();
        for (share, expected) in [(0.99, true), (1.01, false)] {
            let rate = largest * share;
            let terms: Vec<RateWitness> = (0..variables).map(|k| witness(rate, &unit(k), 0.0)).collect();
            let constant = witness(rate, &vec![0.0; variables], 1.0);
            let form = |witness: &RateWitness| {
                let form = Form::new(&dynamics, witness).expect("finite");
                let signals = form.signals.clone();
                Mat::from_fn(signals.len(), signals.len(), |i, j| form.entry(signals[i], signals[j]).midpoint_f64())
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
            let positive = AffineMatrix::from_fn(n, variables, |_, _| 0.0, |k, i, j| terms[k].q[(i, j)]);
            let mut cost = vec![0.0; variables + 1];
            cost[variables] = -1.0;
            let solved = propose(&cost, &[decay.minus_identity(), positive.minus_identity()]).expect("solved");
            let margin = solved.x[variables];
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
    let oscillators = OscillatorMatrix::new(&data, 2);
    let dynamics = ErrorDynamics { oscillators: &oscillators, sigma: sigma.clone(), bounds: &plain };
    let (witness, _) = proposed(&dynamics, 0.9999);
    assert!(dynamics.proves(&witness));

    let changed = |change: &dyn Fn(&mut RateWitness)| {
        let mut other = witness.clone();
        change(&mut other);
        dynamics.proves(&other)
    };
    for i in 0..6 {
        assert!(!changed(&|w| w.q[(i, i)] *= 1.02), "{i}");
        assert!(!changed(&|w| w.q[(i, i)] *= -1.0), "{i}");
        assert!(!changed(&|w| w.q[(5, i)] = f64::NAN), "{i}");
    }
    assert!(!changed(&|w| w.q[(1, 0)] += 0.01));
    assert!(!changed(&|w| w.q = Mat::identity(4, 4)));
    for signal in 0..3 {
        for value in [0.0, -1.0, f64::NAN, witness.multipliers[signal] * 1.02, witness.multipliers[signal] / 1.02] {
            assert!(!changed(&|w| w.multipliers[signal] = value), "{signal} {value}");
        }
    }
    for value in [0.0, -1.0, f64::INFINITY, witness.w_x * 1.02, witness.w_x / 1.02] {
        assert!(!changed(&|w| w.w_x = value), "{value}");
    }

    let more = rational(101, 100);
    let under = |change: &dyn Fn(&mut LoopBounds)| {
        let mut bounds = plain.clone();
        change(&mut bounds);
        ErrorDynamics { oscillators: &oscillators, sigma: sigma.clone(), bounds: &bounds }.proves(&witness)
    };
    for signal in 0..3 {
        assert!(!under(&|b| b.gains[signal] *= &more), "{signal}");
        // Smaller than their bounds they may be, as the module says.
        assert!(under(&|b| b.gains[signal] /= &more), "{signal}");
    }
    assert!(!under(&|b| b.root_p_up *= &more) && under(&|b| b.root_p_up /= &more));
    assert!(!under(&|b| b.x_decay /= &more) && under(&|b| b.x_decay *= &more));
    let other = ErrorDynamics { oscillators: &oscillators, sigma: rational(47, 1), bounds: &plain };
    assert!(!other.proves(&witness));
    let other = OscillatorMatrix::new(&data, 3);
    assert!(!ErrorDynamics { oscillators: &other, sigma: sigma.clone(), bounds: &plain }.proves(&witness));
}

/// Linear plants whose u and phi stay within the bounds are no slower than the proved rate, by their eigenvalues.
#[test]
fn no_admissible_linear_plant_is_slower() {
    let spec = example();
    let data = Data::new(&spec, 128);
    for (gains, sigma) in [([3, 1, 1], 48), ([3, 1, 1], 20), ([1, 4, 1], 10), ([6, 0, 2], 70), ([0, 2, 0], 5)] {
        let bounds = LoopBounds { gains: gains.map(|k| rational(k, 1)), ..bounds() };
        for n_o in [0, 1, 2, 5] {
            let oscillators = OscillatorMatrix::new(&data, n_o);
            let dynamics = ErrorDynamics { oscillators: &oscillators, sigma: rational(sigma, 1), bounds: &bounds };
            let (witness, _) = proposed(&dynamics, 0.9999);
            assert!(dynamics.proves(&witness), "{gains:?} {sigma} {n_o}");
            let n = witness.q.nrows();
            let b: Vec<f64> = oscillators.b.iter().map(Enclosure::midpoint_f64).collect();
            let mut slowest = f64::INFINITY;
            for signs in 0..27 {
                let [x, e, f] = [signs % 3, signs / 3 % 3, signs / 9].map(|sign| f64::from(sign - 1));
                let [k_x, k_e, k_f] = gains.map(f64::from);
                // xi' = -(1/4) xi + (5/4) phi, u = x k_x xi + e k_e et, phi = f k_f et.
                let loop_matrix = Mat::from_fn(n + 1, n + 1, |i, j| {
                    let input = |j: usize| [x * k_x, e * k_e].get(j).copied().unwrap_or(0.0);
                    let s = |j: usize| if j >= 2 { b[j - 2] } else { 0.0 };
                    match i {
                        0 => [-0.25, 1.25 * f * k_f].get(j).copied().unwrap_or(0.0),
                        1 => input(j) + s(j) - if j == 1 { f64::from(sigma) } else { 0.0 },
                        _ => {
                            let phi = match j.checked_sub(2).and_then(|column| oscillators.phi(column)) {
                                Some((row, entry)) if row + 2 == i => entry.midpoint_f64(),
                                _ => 0.0,
                            };
                            phi - b[i - 2] * (input(j) + s(j))
                        }
                    }
                });
                let values = loop_matrix.eigenvalues().expect("finite");
                slowest = values.iter().map(|value| -value.re).fold(slowest, f64::min);
            }
            assert!(witness.rate.to_f64() <= slowest * (1.0 + 1e-9), "{gains:?} {sigma} {n_o} {slowest}");
        }
    }
}

/// Bounds of 0 leave out their signals; without x the rate is not held back by alpha.
#[test]
fn signals_that_vanish_are_left_out() {
    let spec = example();
    let data = Data::new(&spec, 128);
    let oscillators = OscillatorMatrix::new(&data, 1);
    for present in 0..8 {
        let mut bounds = bounds();
        for (signal, gain) in bounds.gains.iter_mut().enumerate().filter(|(signal, _)| present >> signal & 1 == 0) {
            *gain = rational(0, 1 + signal as i32);
        }
        let dynamics = ErrorDynamics { oscillators: &oscillators, sigma: sigma(), bounds: &bounds };
        let (witness, _) = proposed(&dynamics, 0.999);
        assert!(dynamics.proves(&witness), "{present}");
        assert!(witness.rate < bounds.x_decay);
    }
    let without = LoopBounds { has_x: false, gains: [Rational::new(), rational(1, 1), Rational::new()], ..bounds() };
    let dynamics = ErrorDynamics { oscillators: &oscillators, sigma: sigma(), bounds: &without };
    let (witness, _) = proposed(&dynamics, 0.999);
    assert!(dynamics.proves(&witness) && witness.rate > without.x_decay);
}

/// Only b_f = 0 says that there is no x.
#[test]
fn a_plant_without_x_is_recognised() {
    let of = |spec: &Specification| {
        let data = Data::new(spec, 128);
        let one = data.rational(&rational(1, 2));
        LoopBounds::new(&data, &ErrorBox::new(&data, Paths::UNNAMED, [&one; 2], [&one; 2])).expect("bounded")
    };
    let without = of(&specification(include_str!("../../../../../specs/no-x.json")));
    assert!(!without.has_x);
    assert_eq!(without.gains, [0, 1, 0].map(|k| rational(k, 1)));
    let with = of(&example());
    assert!(with.has_x && with.gains.iter().all(|k| *k > 0));
    // At (X_b, E_b) = (1, 1): k_x = sqrt(2), k_e = k_f = 1.189.
    assert_eq!(with.gains[1], with.gains[2]);
    assert!((with.gains[1].to_f64() - 1.189).abs() < 1e-15 && (with.gains[0].to_f64() - 2f64.sqrt()).abs() < 1e-15);
}

/// M may be definite with a W that is not: x decays at 1/4 only, and nothing at 100.
#[test]
fn a_w_that_is_not_definite_proves_nothing() {
    let spec = example();
    let data = Data::new(&spec, 128);
    let oscillators = OscillatorMatrix::new(&data, 0);
    let none = || Rational::new();
    let without = LoopBounds { has_x: false, gains: [none(), rational(1, 1), none()], ..bounds() };
    let dynamics = ErrorDynamics { oscillators: &oscillators, sigma: sigma(), bounds: &without };
    let (witness, _) = proposed(&dynamics, 0.999);
    assert!(dynamics.proves(&witness) && witness.rate > 1);
    let with = LoopBounds { has_x: true, ..without };
    let dynamics = ErrorDynamics { oscillators: &oscillators, sigma: sigma(), bounds: &with };
    assert!(!dynamics.proves(&RateWitness { w_x: -1.0, ..witness.clone() }));

    let alone = LoopBounds { has_x: false, gains: [none(), none(), none()], ..bounds() };
    let dynamics = ErrorDynamics { oscillators: &oscillators, sigma: sigma(), bounds: &alone };
    let negative =
        RateWitness { rate: rational(100, 1), q: Mat::from_fn(2, 2, |i, j| -f64::from(u8::from(i == j))), ..witness };
    assert!(!dynamics.proves(&negative));
}
