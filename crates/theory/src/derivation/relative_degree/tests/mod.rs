use super::flow::Flow;
use super::negative_part::{Perturbed, Tolerance};
use super::ranges::scale;
use super::real_roots::all_real;
use super::*;
use rug::Float;
use rug::ops::Pow;
use sigmastar_exact::enclosure::Enclosure;

mod properties;

fn ratio(numerator: i64, denominator: i64) -> Rational {
    Rational::from((numerator, denominator))
}

fn integers(values: &[i64]) -> Vec<Rational> {
    values.iter().map(|x| ratio(*x, 1)).collect()
}

fn multiply(p: &[Rational], q: &[Rational]) -> Vec<Rational> {
    let mut product = vec![Rational::new(); p.len() + q.len() - 1];
    for (i, x) in p.iter().enumerate() {
        for (j, y) in q.iter().enumerate() {
            product[i + j] += Rational::from(x * y);
        }
    }
    product
}

/// The coefficients a of the product of the factors s^2 + 2 z w s + w^2 for (w, z) and s + x.
fn from_factors(quadratic: &[(Rational, Rational)], linear: &[Rational]) -> Vec<Rational> {
    let one = ratio(1, 1);
    let mut p = vec![one.clone()];
    for (w, z) in quadratic {
        p = multiply(&p, &[Rational::from(w * w), Rational::from(w * z) * 2, one.clone()]);
    }
    for x in linear {
        p = multiply(&p, &[x.clone(), one.clone()]);
    }
    p.pop();
    p
}

/// Upper bound of the relative width.
fn width(x: &Enclosure) -> f64 {
    let ends = Float::with_val(256, x.upper() - x.lower()) / x.lower();
    ends.to_f64_round(rug::float::Round::Up)
}

/// Two enclosures of one number overlap.
fn overlap(x: &Enclosure, y: &Enclosure) -> bool {
    x.lower() <= y.upper() && y.lower() <= x.upper()
}

fn rational(x: &Rational) -> Enclosure {
    Enclosure::from_rational(x, 256)
}

/// k_inf w^2 of s^2 + 2 z w s + w^2 with 0 < z < 1: half-waves of areas 1 + q, q (1 + q), ... with
/// q = exp(-pi z/sqrt(1 - z^2)), so (1 + q)/(1 - q) = coth(pi z/(2 sqrt(1 - z^2))).
fn underdamped(z: &Rational) -> Enclosure {
    let root = rational(&(1 - Rational::from(z * z))).sqrt();
    (Enclosure::pi(256) * rational(z) / (root * 2)).coth()
}

#[test]
fn first_order_is_exact() {
    for a in [ratio(3, 1), ratio(1, 7), ratio(10, 1).pow(300), ratio(10, 1).pow(-300)] {
        let k = k_infinity(std::slice::from_ref(&a), 128).unwrap();
        assert_eq!(k, Enclosure::from_rational(&Rational::from(a.recip_ref()), 128));
        let k = k_2(std::slice::from_ref(&a), 128).unwrap();
        assert_eq!(k, Enclosure::from_rational(&Rational::from(a.square_ref()).recip(), 128));
    }
}

#[test]
fn real_roots_give_the_reciprocal_of_a_1() {
    let cubic = from_factors(&[], &integers(&[1, 1, 1]));
    assert_eq!(cubic, integers(&[1, 3, 3]));
    assert_eq!(k_infinity(&cubic, 128).unwrap(), Enclosure::one(128));
    assert_eq!(k_2(&cubic, 128).unwrap(), Enclosure::one(128));
    let wide: Vec<Rational> = (0..20).map(|k| ratio(10, 1).pow(5 * k - 40)).collect();
    let wide = from_factors(&[], &wide);
    let expected = Enclosure::from_rational(&Rational::from(wide[0].recip_ref()), 128);
    assert_eq!(k_infinity(&wide, 128).unwrap(), expected);
    assert_eq!(k_2(&wide, 128).unwrap(), Enclosure::from_rational(&Rational::from(wide[0].square_ref()).recip(), 128));
}

#[test]
fn second_order_closed_forms() {
    for (z, w) in [((1, 10), (1, 1)), ((1, 2), (3, 1)), ((9, 10), (1, 7)), ((99, 100), (5, 2)), ((1, 40), (1000, 1))] {
        let (z, w) = (Rational::from(z), Rational::from(w));
        let a = from_factors(&[(w.clone(), z.clone())], &[]);
        let k = k_infinity(&a, 128).unwrap();
        let exact = underdamped(&z) / rational(&Rational::from(w.square_ref()));
        assert!(overlap(&k, &exact), "{z} {k:?} {exact:?}");
        assert!(k.lower() <= exact.lower() && k.upper() >= exact.upper(), "{z} {k:?} {exact:?}");
        assert!(width(&k) < 1e-10, "{z} {k:?}");
        let k = k_2(&a, 128).unwrap();
        let (z2, w4) = (Rational::from(z.square_ref()), Rational::from(w.square_ref()).square());
        // 1/(4 z^2 (1 - z^2)) for z^2 < 1/2, and the value at w = 0 from there on.
        let peak = if z2 < ratio(1, 2) { Rational::from(1 - &z2) * &z2 * 4 } else { ratio(1, 1) };
        assert!(k.contains(&Rational::from(&peak * &w4).recip()), "{z} {k:?}");
        assert!(width(&k) < 1e-16, "{z} {k:?}");
    }
}

#[test]
fn sixth_order_is_sharp_at_little_cost() {
    let factors = [(ratio(1, 1), ratio(1, 2)), (ratio(2, 1), ratio(3, 10)), (ratio(3, 1), ratio(7, 10))];
    let a = from_factors(&factors, &[]);
    let k = k_infinity(&a, 128).unwrap();
    let float = l1_norm(&a, 1e-3, 60.0);
    assert!(width(&k) < 1e-10, "{k:?}");
    assert!((k.midpoint_f64() / float - 1.0).abs() < 1e-5, "{k:?} {float}");
    assert!(width(&k_2(&a, 128).unwrap()) < 1e-16);
    // Multiple complex roots: t^2 enters the response.
    let a = from_factors(&vec![(ratio(1, 1), ratio(1, 2)); 3], &[]);
    let (k, float) = (k_infinity(&a, 128).unwrap(), l1_norm(&a, 1e-3, 90.0));
    assert!(width(&k) < 1e-10 && (k.midpoint_f64() / float - 1.0).abs() < 1e-5, "{k:?} {float}");
    // |(1 - W + i sqrt W)|^2 = 1 - W + W^2 >= 3/4, so k_2 = (4/3)^3.
    assert!(k_2(&a, 128).unwrap().contains(&ratio(64, 27)));
}

#[test]
fn stiff_and_lightly_damped() {
    // A fast pair at 10^6 acts on the slow pair as a gain of 10^-12, up to terms of order 10^-6.
    let z = ratio(1, 2);
    let a = from_factors(&[(ratio(1, 1), z.clone()), (ratio(1_000_000, 1), z.clone())], &[]);
    let k = k_infinity(&a, 128).unwrap();
    let slow = underdamped(&z).midpoint_f64() * 1e-12;
    assert!(width(&k) < 1e-9 && (k.midpoint_f64() / slow - 1.0).abs() < 1e-5, "{k:?}");
    // The effort ends before the response has decayed: the enclosure is wide, but finite and right.
    let z = ratio(1, 1_000_000);
    let a = from_factors(&[(ratio(1, 1), z.clone())], &[]);
    let k = k_infinity(&a, 128).unwrap();
    let exact = underdamped(&z);
    assert!(k.lower() <= exact.lower() && k.upper() >= exact.upper() && width(&k) > 1e-3);
    assert!(k.upper() <= Float::with_val(64, exact.upper() * 2u32), "{k:?}");
    assert!(width(&k_2(&a, 128).unwrap()) < 1e-16);
    // Beyond the range: typed refusals, no claim.
    let a = [ratio(1, 1), ratio(10, 1).pow(-60)];
    assert_eq!(k_infinity(&a, 128).unwrap_err(), RelativeDegreeError::Undecided(Undecided::TimeScales));
    let a = [ratio(1, 3), ratio(10, 1).pow(-4000)];
    assert_eq!(k_2(&a, 128).unwrap_err(), RelativeDegreeError::Undecided(Undecided::Resonance));
}

#[test]
fn not_hurwitz_is_refused_with_the_entry() {
    let refused = |a: &[i64]| match check_hurwitz(&integers(a)) {
        Err(RelativeDegreeError::NotHurwitz(NotHurwitz { row, entry })) => {
            assert!(!is_hurwitz(&integers(a)));
            assert!(k_infinity(&integers(a), 128).is_err() && k_2(&integers(a), 128).is_err());
            (row, entry)
        }
        other => panic!("{other:?}"),
    };
    assert_eq!(refused(&[0]), (1, ratio(0, 1)));
    assert_eq!(refused(&[-2]), (1, ratio(-2, 1)));
    assert_eq!(refused(&[1, 0]), (1, ratio(0, 1)));
    assert_eq!(refused(&[0, 1]), (2, ratio(0, 1)));
    // s^3 + s^2 + s + 1 = (s + 1)(s^2 + 1)
    assert_eq!(refused(&[1, 1, 1]), (2, ratio(0, 1)));
    assert_eq!(refused(&[10, 1, 1]), (2, ratio(-9, 1)));
    // s^4 + 2 s^3 + 3 s^2 + 2 s + 5: array 1 3 5; 2 2; 2 5; -3; 5
    assert_eq!(refused(&[5, 2, 3, 2]), (3, ratio(-3, 1)));
    assert_eq!(refused(&[0, 1, 3, 3]), (4, ratio(0, 1)));
    assert_eq!(check_hurwitz(&[]), Err(RelativeDegreeError::Count { count: 0 }));
    assert!(!is_hurwitz(&[]) && !is_hurwitz(&integers(&[1; 21])));
    let error = check_hurwitz(&integers(&[10, 1, 1])).unwrap_err().to_string();
    assert!(error.contains("entry 2") && error.contains("-9"), "{error}");
}

#[test]
fn the_printed_order_is_another_polynomial() {
    let a = integers(&[10, 1, 1]);
    assert_eq!(printed_polynomial(&a), Ok(()));
    assert!(!is_hurwitz(&a));
    let a = integers(&[1, 1, 10]);
    assert!(is_hurwitz(&a) && printed_polynomial(&a).is_err());
    for (a, expected) in [
        (&[1][..], true),
        (&[-1], false),
        (&[0], false),
        (&[1, 1], true),
        (&[0, 1], false),
        // (s^2 + 1)(s + 1) has zeros on the axis.
        (&[1, 1, 1], false),
        // (s+1)^4 and (s+1)^5.
        (&[4, 6, 4, 1], true),
        (&[5, 10, 10, 5, 1], true),
        // (s^2 - s + 1)(s+3)^2, all coefficients nonnegative.
        (&[5, 4, -3, 9], false),
        (&[1, 2, 3, 4], false),
    ] {
        assert_eq!(printed_polynomial(&integers(a)).is_ok(), expected, "{a:?}");
    }
}

#[test]
fn sturm_counts_real_roots() {
    assert!(all_real(&integers(&[-4])));
    assert!(all_real(&integers(&[0, 0, 0])));
    assert!(all_real(&integers(&[1, 2])));
    assert!(!all_real(&integers(&[2, 2])));
    assert!(all_real(&from_factors(&[], &integers(&[1, 1, 2, 2, 2, -3, 0]))));
    let close = [ratio(1, 1), ratio(1_000_000_001, 1_000_000_000)];
    assert!(all_real(&from_factors(&[], &close)));
    let nearly = from_factors(&[(ratio(1, 1), ratio(999_999_999, 1_000_000_000))], &integers(&[1, 2]));
    assert!(!all_real(&nearly));
    assert!(!all_real(&from_factors(&vec![(ratio(1, 1), ratio(1, 2)); 2], &integers(&[3, 3]))));
}

#[test]
fn negative_parts_of_polynomials() {
    let tolerance =
        |bits: i32| Tolerance { size: Float::with_val(64, 1) >> bits, area: Float::with_val(64, 1) >> bits };
    let part = |c: &[(i64, i64)], error: Rational, bits: i32| {
        let c: Vec<Enclosure> = c.iter().map(|x| Enclosure::from_rational(&Rational::from(*x), 128)).collect();
        Perturbed::new(&c, &Enclosure::from_rational(&error, 64), 128).integral(&tolerance(bits))
    };
    let zero = Rational::new();
    let near = |x: &Enclosure, exact: Rational, gap: f64| {
        x.contains(&exact) && Float::with_val(128, x.upper() - x.lower()) < gap
    };
    assert!(near(&part(&[(-1, 2), (1, 1)], zero.clone(), 60), ratio(1, 8), 1e-17));
    assert!(near(&part(&[(1, 2), (-1, 1)], zero.clone(), 60), ratio(1, 8), 1e-17));
    assert_eq!(part(&[(0, 1), (0, 1), (1, 1)], zero.clone(), 60), Enclosure::zero(128));
    assert!(near(&part(&[(-1, 3)], zero.clone(), 60), ratio(1, 3), 1e-30));
    // (s - 1/4)(s - 3/4): integral of the negative part (1/2)^3/6.
    assert!(near(&part(&[(3, 16), (-1, 1), (1, 1)], zero.clone(), 60), ratio(1, 48), 1e-17));
    // (s - 1/2)^2 touches zero; (s - 1/2)^3 crosses flatly.
    assert!(near(&part(&[(1, 4), (-1, 1), (1, 1)], zero.clone(), 60), zero.clone(), 1e-16));
    assert!(near(&part(&[(-1, 8), (3, 4), (-3, 2), (1, 1)], zero.clone(), 60), ratio(1, 64), 1e-16));
    // An error of 1/10 can move s - 1/2 to s - 2/5 or s - 3/5; on -1/3 it is a shift.
    let x = part(&[(-1, 2), (1, 1)], ratio(1, 10), 60);
    assert!(x.contains(&ratio(2, 25)) && x.contains(&ratio(9, 50)) && x.upper_f64() < 0.3, "{x:?}");
    let x = part(&[(-1, 3)], ratio(1, 10), 60);
    assert!(x.contains(&ratio(7, 30)) && x.contains(&ratio(13, 30)));
    // Giving up is sound.
    for bits in [0, 2, 5] {
        assert!(part(&[(3, 16), (-1, 1), (1, 1)], zero.clone(), bits).contains(&ratio(1, 48)));
    }
}

#[test]
fn the_flow_is_the_response() {
    let a = from_factors(&[(ratio(2, 1), ratio(3, 10)), (ratio(1, 1), ratio(1, 5))], &integers(&[3]));
    for a in [a.clone(), from_factors(&[(ratio(2, 1), ratio(3, 10)), (ratio(1, 1), ratio(1, 5))], &[])] {
        let routh = Routh::new(&a).unwrap();
        let mut flow = Flow::new(&routh, 192).unwrap();
        for _ in 0..8 {
            flow.double().unwrap();
        }
        let weight = routh.b[1..].iter().fold(Enclosure::one(192), |w, b| w * Enclosure::from_rational(b, 192).sqrt());
        // -w y(0) is the whole integral: sqrt(P_1)/a_1.
        let start = flow.start();
        let whole = -start.project(&flow.inverse_row());
        assert!(overlap(&whole, &(&weight / rational(&a[0]))) && width(&whole) < 1e-40);
        // One long step and two short ones agree; so does an integration in floating point.
        let (long, short) = (&flow.blocks[8], &flow.blocks[7]);
        let once = flow.advance(&start, long);
        let twice = flow.advance(&flow.advance(&start, short), short);
        assert!(once.error.upper_f64() < 1e-40 && long.frobenius().upper_f64() < 3.0);
        let mut row = vec![Enclosure::zero(192); a.len()];
        row[0] = weight.recip();
        let (once, twice) = (once.project(&row), twice.project(&row));
        assert!(overlap(&once, &twice) && width(&once).abs() < 1e-30);
        let time = long.length().midpoint_f64();
        let float = impulse(&a, time / 4096.0, 4096).last().copied().unwrap();
        assert!((once.midpoint_f64() - float).abs() < 1e-9, "{once:?} {float}");
        assert!(long.spectral(a.len()).upper_f64() <= 1.1 && long.spectral(a.len()).le(&long.frobenius()).is_true());
    }
    assert_eq!(scale(&Enclosure::one(64), -3), rational(&ratio(1, 8)));
}

/// Rounding errors of a coarse flow stay within the bound that it carries, and the bound is not idle.
#[test]
fn error_bounds_cover_a_coarse_flow() {
    let a = from_factors(&[(ratio(2, 1), ratio(1, 50)), (ratio(1, 1), ratio(1, 30))], &integers(&[3]));
    let routh = Routh::new(&a).unwrap();
    let (mut coarse, mut fine) = (Flow::new(&routh, 24).unwrap(), Flow::new(&routh, 256).unwrap());
    let (mut x, mut y) = (coarse.start(), fine.start());
    for round in 0..120 {
        if round < 8 {
            coarse.double().unwrap();
            fine.double().unwrap();
        }
        x = coarse.advance(&x, coarse.blocks.last().unwrap());
        y = fine.advance(&y, fine.blocks.last().unwrap());
        let sum = x.y.iter().zip(&y.y).fold(Float::new(256), |sum, (p, q)| sum + Float::with_val(256, p - q).square());
        let gap = sum.sqrt();
        assert!(gap <= x.error.upper(), "{round} {gap} {:?}", x.error);
        assert!(x.error.upper() < 1e-2 && y.error.upper() < 1e-60 && gap > 0);
    }
}

/// Whenever the effort ends, the tail counts once: from time 0 on the bound of k_inf is that of the tail itself.
#[test]
fn any_effort_is_sound() {
    let z = ratio(1, 10);
    let a = from_factors(&[(ratio(1, 1), z.clone())], &[]);
    let response = impulse::Response::new(&Routh::new(&a).unwrap(), &a[0], 128).unwrap();
    let bound = |effort| response.negative_part(effort).unwrap() * 2 + 1;
    let tail = response.tail(&response.flow.start()).unwrap() / &response.weight;
    assert!(bound(0).upper_f64() <= tail.upper_f64() * (1.0 + 1e-12), "{:?} {tail:?}", bound(0));
    let exact = underdamped(&z);
    for effort in [0, 1, 2_000, 5_000, 10_000, 50_000] {
        let k = bound(effort);
        assert!(k.lower() <= exact.lower() && k.upper() >= exact.upper(), "{effort} {k:?}");
    }
}

#[test]
fn hostile_sizes_end_quickly() {
    let (huge, tiny): (Rational, Rational) = (ratio(10, 1).pow(4000), ratio(10, 1).pow(-4000));
    for a in [
        vec![huge.clone(), tiny.clone()],
        vec![tiny.clone(), huge.clone()],
        vec![tiny.clone(), tiny.clone()],
        vec![huge.clone(), huge.clone(), huge.clone(), huge.clone()],
    ] {
        for k in [k_infinity(&a, 128), k_2(&a, 128)].into_iter().flatten() {
            assert!(k.is_bounded() && k.is_positive().is_true());
        }
    }
    // s^2 + 10^4000 (s + 1)-like: real roots; exact.
    let a = [huge.clone(), huge.clone()];
    assert_eq!(k_infinity(&a, 128).unwrap(), Enclosure::from_rational(&tiny, 128));
    // All the same size: only a change of the unit of time.
    let a = [Rational::from(huge.square_ref()), huge.clone()];
    let k = k_infinity(&a, 128).unwrap() * rational(&Rational::from(huge.square_ref()));
    assert!(overlap(&k, &underdamped(&ratio(1, 2))) && width(&k) < 1e-10);
    assert!(k_2(&a, 0).unwrap().precision() == 64 && k_infinity(&a, u32::MAX).unwrap().precision() == 1024);
}

/// g at multiples of a step, by the classical Runge-Kutta method on the companion form. Independent of the flow.
fn impulse(a: &[Rational], step: f64, count: usize) -> Vec<f64> {
    let a: Vec<f64> = a.iter().map(Rational::to_f64).collect();
    let n = a.len();
    let field = |x: &[f64]| -> Vec<f64> {
        let last: f64 = -a.iter().zip(x).map(|(c, y)| c * y).sum::<f64>();
        x[1..].iter().copied().chain([last]).collect()
    };
    let along = |x: &[f64], v: &[f64], h: f64| -> Vec<f64> { x.iter().zip(v).map(|(p, q)| p + h * q).collect() };
    let mut x = vec![0.0; n];
    x[n - 1] = 1.0;
    let mut values = vec![x[0]];
    for _ in 0..count {
        let k1 = field(&x);
        let k2 = field(&along(&x, &k1, step / 2.0));
        let k3 = field(&along(&x, &k2, step / 2.0));
        let k4 = field(&along(&x, &k3, step));
        for i in 0..n {
            x[i] += step / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
        }
        values.push(x[0]);
    }
    values
}

/// Trapezoidal sum of |g|.
fn l1_norm(a: &[Rational], step: f64, time: f64) -> f64 {
    let g = impulse(a, step, (time / step) as usize);
    g.windows(2).map(|pair| (pair[0].abs() + pair[1].abs()) / 2.0 * step).sum()
}
