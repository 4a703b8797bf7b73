//! Rounding: the bounds by their formulas in doubles, and against the steps themselves, in doubles and with 400 bits.

use super::{Oscillators, double, drawn, part, sizes, with_stored};
use crate::data::Data;
use crate::interval::Interval;
use crate::json::parse;
use crate::rules::by_n_o::oscillators::Oscillators as At;
use crate::rules::derivation::Derivation;
use crate::rules::rates::noise::{Known, of_doubles};
use crate::rules::rates::norm::power;
use crate::rules::rates::rounding::{Rounding, errors, ranges};
use crate::rules::rates::{Proof, Witness, reach};
use crate::rules::sampled::law::{Law, Terms};
use crate::rules::stability::ErrorBox;
use rug::Float;

const STORED: [&str; 6] = [
    "arithmetic/all",
    "arithmetic/alone",
    "arithmetic/aligned",
    "arithmetic/input-gain",
    "arithmetic/input-gain-alone",
    "sets/rounded",
];
const U0: f64 = 1.0 / (1_u64 << 53) as f64;

/// A stored certificate: its law, what is known of it with noise, and its witness.
fn each(name: &str, use_it: impl Fn(&Law<'_>, &Derivation, (&ErrorBox, &Known), (&Rounding, &At))) {
    let path = format!("{}/../tests/{name}.json", env!("CARGO_MANIFEST_DIR"));
    let json = parse(&std::fs::read(path).unwrap()).unwrap();
    let sizes = |d: &Data<'_>| sizes(d, part(&json, "claim").json);
    with_stored(name, |d, (derivation, _), error_box, witness: &Witness| {
        let Proof::Sampled(_, Some(proof)) = &witness.proof else { panic!("{name}") };
        let (free, sizes) = (&derivation.free, sizes(d));
        let known = Known::new(d, free, (reach(d, free, &sizes, None), &sizes.zeta), (&error_box.e_b, true));
        let law = Law::new(d, derivation.law().unwrap());
        use_it(&law, derivation, (error_box, &known), (proof.rounding.as_ref().unwrap(), &witness.oscillators));
    });
}

fn close(found: &Interval, expected: f64, what: &str) {
    let found = double(found);
    assert!((found - expected).abs() <= 1e-12 * expected.abs(), "{what}: {found:e} {expected:e}");
}

/// The numbers of the file that bounds of rounding are made of: K, sigma, 1 - h sigma, Nbar and the nominal gain.
fn numbers(law: &Law<'_>, name: &str) -> [f64; 5] {
    let [gain, sigma, h, n_bar] = [&law.gain, &law.sigma, &law.h, &law.d.n_bar].map(double);
    [gain, sigma, 1.0 - h * sigma, n_bar, if name.contains("input-gain") { 2.0 } else { 1.0 }]
}

fn gamma(count: u32) -> f64 {
    f64::from(count) * U0 / (1.0 - f64::from(count) * U0)
}

#[test]
fn the_bounds_are_those_of_the_counts() {
    for name in STORED {
        each(name, |law, _, (error_box, known), (rounding, oscillators)| {
            let p = oscillators.count() as u32 - 1;
            let [gain, sigma, kept, n_bar, nominal] = numbers(law, name);
            let z_b = double(&known.zeta) + rounding.numbers[2].to_f64();
            let [off, e_b] = [&known.off, &error_box.e_b].map(double);
            let [w_b, m_b] = [z_b + n_bar * off, e_b + off];
            let du_b = gamma(p + 11) * (gain * n_bar * w_b + sigma * m_b);
            let dz_b = 2_f64.sqrt() * gamma(5) * w_b + gamma(3) * kept * m_b * n_bar;
            let [of_u, of_z] = rounding.errors(law, known, oscillators).unwrap();
            close(&of_u, du_b, name);
            close(&of_z, dz_b, name);
            // Apart, at numbers that make each term count.
            let d = law.d;
            for at in [[0, 0], [3, 0], [0, 5]] {
                let [w, m] = at.map(|value| d.int(value));
                let tiny = 2_f64.powi(-1000) * (1.0 + gain) * (1.0 + sigma) * (1.0 + n_bar * n_bar) * (1.0 + nominal);
                let [w_b, m_b] = [double(&w), double(&m)];
                let [of_u, of_z] = errors(law, oscillators, [&w, &m]);
                close(&of_u, gamma(p + 11) * (gain * n_bar * w_b + sigma * m_b) + tiny, name);
                close(&of_z, 2_f64.sqrt() * gamma(5) * w_b + gamma(3) * kept * m_b * n_bar + tiny, name);
            }
        });
    }
}

#[test]
fn what_is_measured_is_the_nearest_double() {
    for name in STORED {
        each(name, |law, derivation, (error_box, known), _| {
            let (d, free) = (law.d, &derivation.free);
            let v_bar = d.number(&d.spec.noise.v_bar());
            let own = &known.off - &v_bar;
            close(&own, U0 * (double(&error_box.e_b) + double(&v_bar)), name);
            close(&of_doubles(d, [&d.int(0), &d.int(0)]), 2_f64.powi(-1074), name);
            close(&known.e_b, double(&error_box.e_b), name);
            // L_0 and what it leaves of zeta.
            let [w_x, eta] = [&free.w_x, &free.h].map(|value| value.to_f64());
            let [low, high] = if name.contains("input-gain") { [0.9, 1.1] } else { [1.0; 2] };
            let [x0, e0] = [&free.set.x0, &free.set.e0].map(|value| value.to_f64());
            let (n_bar, off) = (double(&d.n_bar), double(&known.off));
            let moved = free.set.z0.as_ref().map_or(n_bar * off, |z0| z0.to_f64() + n_bar * e0);
            let [x_per, e_per] = [&error_box.x_b - d.number(&free.d_x), &error_box.e_b - d.number(&free.d_e)];
            let zeta = double(&known.zeta) - (double(&known.start) / (low * eta)).sqrt();
            let start = w_x * double(&d.p_up) * (x0 + double(&x_per)).powi(2)
                + (e0 + double(&e_per)).powi(2)
                + high * eta * (moved + zeta).powi(2);
            close(&known.start, start, name);
            // Z of the file, which no gain and no start changes.
            assert!((4.0..9.0).contains(&zeta), "{name} {zeta}");
        });
    }
}

/// Nothing overflows, and the constants are normal: each condition alone.
#[test]
fn each_range_is_demanded() {
    each("arithmetic/input-gain", |law, derivation, _, (_, oscillators)| {
        let d = law.d;
        let failing = |law: &Law<'_>, at: [i32; 3]| {
            let [z, w, m] = at.map(|exponent| power(d, exponent));
            let conditions = ranges(law, oscillators, [&z, &w, &m]);
            let open = conditions.iter().filter(|one| one.truth() != Some(true));
            open.map(|one| one.what.clone()).collect::<Vec<_>>()
        };
        assert!(failing(law, [0; 3]).is_empty());
        let of_sum = "(1 + K) Nbar w_b + sigma m_b < 2^1000";
        let nominal = format!("{of_sum} nominal");
        assert_eq!(failing(law, [0, 1000, 0]), [of_sum, &nominal]);
        // sigma = 40.
        assert_eq!(failing(law, [0, 0, 996]), [of_sum, &nominal]);
        let of_state = "z_b/sqrt(n_l) + 2 m_b < 2^1000";
        // n_0 = 2.
        assert_eq!(failing(law, [1000, 0, 0]), [of_state]);
        assert_eq!(failing(law, [1001, 0, 0]), [of_state; 2]);
        let with = |gain: i32, sigma: i32| {
            let [gain, sigma] = [gain, sigma].map(|exponent| power(d, exponent).lower().unwrap());
            Law::new(d, &Terms { gain, sigma, ..derivation.law().unwrap().clone() })
        };
        assert_eq!(failing(&with(-901, 0), [0; 3]), ["2^-900 < K"]);
        assert_eq!(failing(&with(901, 0), [0; 3]), ["K < 2^900"]);
        assert_eq!(failing(&with(0, -901), [0; 3]), ["2^-900 < sigma"]);
        assert_eq!(failing(&with(0, 901), [0; 3]), ["sigma < 2^900"]);
        // The sum overflows before K makes it small.
        assert_eq!(failing(&with(-100, 0), [0, 1001, 0]), [of_sum, &nominal]);
        assert_eq!(failing(&with(0, -100), [0, 0, 998]), Vec::<String>::new());
        assert_eq!(failing(&with(0, -100), [0, 0, 999]), [of_state; 2]);
    });
}

/// The weights are those of the harmonics of a set: `z_b/sqrt(n_l)` is beyond 2^1000 for l = 3 and l = 5 here, and not for l up to 2.
#[test]
fn ranges_are_those_of_the_harmonics() {
    each("sets/rounded", |law, _, _, (_, oscillators)| {
        let [z, rest] = [999, 0].map(|exponent| power(law.d, exponent));
        let conditions = ranges(law, oscillators, [&z, &rest, &rest]);
        let open = conditions.iter().filter(|one| one.truth() != Some(true)).count();
        assert_eq!(open, usize::from(oscillators.largest() > 2), "{}", oscillators.about());
    });
}

/// A number with 400 bits, which no step below rounds by as much as 2^-300.
fn exact(value: f64) -> Float {
    Float::with_val(400, value)
}

/// The double nearest to what is enclosed.
fn nearest(value: &Interval) -> f64 {
    let [low, high] = [value.lo(), value.hi()].map(|end| end.to_f64());
    assert!((high - low).abs() <= 2.0 * U0 * low.abs());
    low
}

/// Steps of the exported code in doubles, and of the law with 400 bits from the same state: what the former are off by is within the bounds, and
/// these are not idle. Also among numbers below the normal ones, where `tiny` bounds all of it.
#[test]
fn steps_in_doubles_are_within_the_bounds() {
    for name in ["arithmetic/all", "arithmetic/input-gain", "sets/rounded"] {
        each(name, |law, _, _, (_, at)| {
            let n_o = at.about();
            let (d, [_, _, _, _, nominal]) = (law.d, numbers(law, name));
            let oscillators = Oscillators::new(d, at.harmonics());
            let [gain, sigma, kept] = [&law.gain, &law.sigma, &law.a].map(nearest);
            let weights: Vec<Interval> = at.harmonics().iter().map(|l| d.weight(u64::from(*l))).collect();
            let turns: Vec<[Interval; 2]> = at.harmonics()[1..]
                .iter()
                .map(|l| {
                    let angle = Interval::pi(128) * i64::from(2 * *l) / i64::from(law.samples);
                    [angle.cos(), angle.sin()]
                })
                .collect();
            let mid = |value: &Interval| Float::with_val(400, &*value.lo());
            let mut draw = drawn();
            let mut largest = [0.0_f64; 2];
            for case in 0..20_000 {
                let size = if case % 2 == 0 { 1.0 } else { 1e-310 };
                let z: Vec<f64> = (0..oscillators.m.len()).map(|_| size * draw()).collect();
                let m = size * draw();
                // In doubles.
                let mut code = z.clone();
                code[0] -= m;
                let mut sum = nearest(&weights[0]) * code[0];
                for (l, [cos, sin]) in turns.iter().enumerate() {
                    let [c, s] = [cos, sin].map(nearest);
                    let (a, b) = (code[2 * l + 1] - m, code[2 * l + 2]);
                    code[2 * l + 1] = c * a + s * b;
                    code[2 * l + 2] = c * b - s * a;
                    sum += nearest(&weights[l + 1]) * code[2 * l + 1];
                }
                let u = (gain * sum - sigma * m) / nominal;
                let carry = kept * m;
                (0..code.len()).filter(|k| oscillators.m[*k] == 1.0).for_each(|k| code[k] += carry);
                // The law.
                let off = |k: usize| exact(z[k]) - exact(m) * oscillators.m[k];
                let mut next: Vec<Float> = vec![off(0)];
                let mut true_sum = mid(&weights[0]) * off(0);
                let mut square = mid(&weights[0]) * off(0).square();
                for (l, [cos, sin]) in turns.iter().enumerate() {
                    let (a, b) = (off(2 * l + 1), off(2 * l + 2));
                    let first = mid(cos) * &a + mid(sin) * &b;
                    next.extend([first.clone(), mid(cos) * &b - mid(sin) * &a]);
                    true_sum += mid(&weights[l + 1]) * first;
                    square += mid(&weights[l + 1]) * (a.square() + b.square());
                }
                let true_u = mid(&law.gain) * true_sum - mid(&law.sigma) * exact(m);
                let mut of_z = exact(0.0);
                for (k, value) in next.into_iter().enumerate() {
                    let value = value + mid(&law.a) * exact(m) * oscillators.m[k];
                    of_z += mid(&weights[k.div_ceil(2)]) * (exact(code[k]) - value).square();
                }
                let found = [(exact(u) * exact(nominal) - true_u).abs(), of_z.sqrt()];
                let within = |value: &Float| Interval::new(value.clone(), value.clone()).round(128);
                let bounds = errors(law, at, [&within(&square.sqrt()), &within(&exact(m.abs()))]);
                for ((found, bound), largest) in found.iter().zip(&bounds).zip(&mut largest) {
                    assert!(*found <= *bound.lo(), "{name} {n_o} {size}: {found} {}", double(bound));
                    if size == 1.0 {
                        *largest = largest.max(found.to_f64() / double(bound));
                    }
                }
            }
            assert!(largest.iter().all(|share| (0.05..1.0).contains(share)), "{name} {n_o} {largest:?}");
        });
    }
}
