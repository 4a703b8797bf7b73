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
    // Time scales 10^80 apart, and roots 10^-9 apart.
    let wide = [ratio(10, 1).pow(-40), ratio(1, 3), ratio(10, 1).pow(40)];
    let close = [ratio(1, 1), ratio(1_000_000_001, 1_000_000_000), ratio(2, 1)];
    for roots in [&wide[..], &wide[1..], &close, &close[..2]] {
        let a = from_factors(&[], roots);
        let expected = Rational::from(a[0].recip_ref());
        assert_eq!(k_infinity(&a, 128).unwrap(), Enclosure::from_rational(&expected, 128));
        assert_eq!(k_2(&a, 128).unwrap(), Enclosure::from_rational(&expected.square(), 128));
    }
}

/// g has one sign exactly if the real root is no faster than the pair.
#[test]
fn a_slow_real_root_gives_the_reciprocal_of_a_1() {
    let third = |c: Rational| from_factors(&[(ratio(2, 1), ratio(1, 4))], &[c]);
    for c in [ratio(1, 2), ratio(1, 3), ratio(10, 1).pow(-30)] {
        let a = third(c);
        assert_eq!(k_infinity(&a, 128).unwrap(), Enclosure::from_rational(&Rational::from(a[0].recip_ref()), 128));
    }
    let a = third(ratio(6, 10));
    let relative = k_infinity(&a, 128).unwrap() * rational(&a[0]);
    assert!(relative.lower() > 1 && width(&relative) < 1e-10, "{relative:?}");
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

/// Against an integration: pairs that are fast and slow beside a real root, weakly and strongly damped.
#[test]
fn third_order_is_sharp_at_little_cost() {
    for (w, z, c, step, time) in [
        ((1, 1), (1, 2), (3, 1), 1e-3, 60.0),
        ((2, 1), (1, 10), (1, 4), 1e-3, 120.0),
        ((3, 1), (1, 50), (1, 1), 5e-4, 250.0),
        ((1, 1), (9, 10), (20, 1), 2e-4, 30.0),
        ((5, 1), (1, 100), (1, 10), 5e-4, 250.0),
    ] {
        let a = from_factors(&[(Rational::from(w), Rational::from(z))], &[Rational::from(c)]);
        let k = k_infinity(&a, 128).unwrap();
        let float = l1_norm(&a, step, time);
        assert!(width(&k) < 1e-12, "{a:?} {k:?}");
        assert!((k.midpoint_f64() / float - 1.0).abs() < 1e-5, "{a:?} {k:?} {float}");
        assert!(width(&k_2(&a, 128).unwrap()) < 1e-16);
    }
}

/// |p(i w)|^2 = W^3 + f_2 W^2 + f_1 W + f_0 with minima by hand.
#[test]
fn third_order_peaks() {
    // (s + 1)(s^2 + s + 1): (1 + W)(1 - W + W^2) = 1 + W^3, least at 0.
    let a = from_factors(&[(ratio(1, 1), ratio(1, 2))], &[ratio(1, 1)]);
    assert_eq!(k_2(&a, 128).unwrap(), Enclosure::one(128));
    // (s + 2)(s^2 + s + 1): 4 - 3 W + 3 W^2 + W^3, least where W^2 + 2 W = 1, at sqrt(2) - 1: 9 - 4 sqrt(2).
    let a = from_factors(&[(ratio(1, 1), ratio(1, 2))], &[ratio(2, 1)]);
    let exact = (rational(&ratio(9, 1)) - rational(&ratio(2, 1)).sqrt() * 4).recip();
    let k = k_2(&a, 128).unwrap();
    assert!(overlap(&k, &exact) && width(&k) < 1e-35, "{k:?} {exact:?}");
    // f_1 >= 0 > f_2: a local minimum above 0 that is greater than f(0), and one that is less.
    for (a, least) in [(&[(3, 10), (1, 1), (9, 10)], false), (&[(1, 4), (1, 1), (3, 10)], true)] {
        let a: Vec<Rational> = a.iter().map(|x| Rational::from(*x)).collect();
        let f = peak::squared_modulus(&a);
        assert!(f[1] >= 0 && f[2] < 0, "{f:?}");
        let at_zero = Enclosure::from_rational(&Rational::from(f[0].recip_ref()), 128);
        let k = k_2(&a, 128).unwrap();
        assert_eq!((k.lower() > at_zero.upper(), overlap(&k, &at_zero)), (least, !least), "{k:?} {at_zero:?}");
    }
}

#[test]
fn stiff_and_lightly_damped() {
    // A real root at 10^6 acts on the pair as a gain of 10^-6, up to terms of order 10^-6.
    let z = ratio(1, 2);
    let a = from_factors(&[(ratio(1, 1), z.clone())], &[ratio(1_000_000, 1)]);
    let k = k_infinity(&a, 128).unwrap();
    let slow = underdamped(&z).midpoint_f64() * 1e-6;
    assert!(width(&k) < 1e-12 && (k.midpoint_f64() / slow - 1.0).abs() < 1e-5, "{k:?}");
    // A pair that is damped by 10^-3, beside a root that is about as slow.
    let a = from_factors(&[(ratio(1, 1), ratio(1, 1000))], &[ratio(1, 900)]);
    assert!(width(&k_infinity(&a, 128).unwrap()) < 1e-11);
    // So slow that the sum is ended before: the enclosure is wide, but finite.
    let a = from_factors(&[(ratio(1, 1), ratio(1, 1_000_000))], &[ratio(1, 900_000)]);
    let k = k_infinity(&a, 128).unwrap() * rational(&a[0]);
    assert!(k.is_bounded() && width(&k) > 1e-3 && k.upper() > 1, "{k:?}");
    // Two hardly damped roots.
    let z = ratio(1, 1_000_000);
    let a = from_factors(&[(ratio(1, 1), z.clone())], &[]);
    let k = k_infinity(&a, 128).unwrap();
    let exact = underdamped(&z);
    assert!(k.lower() <= exact.lower() && k.upper() >= exact.upper() && width(&k) < 1e-30);
    assert!(width(&k_2(&a, 128).unwrap()) < 1e-16);
    // Beyond the range: typed refusals, no claim.
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
    // s^3 + 3 s^2 + s - 1: array 1 1; 3 -1; 4/3; -1
    assert_eq!(refused(&[-1, 1, 3]), (3, ratio(-1, 1)));
    assert_eq!(refused(&[1, 1, 0]), (1, ratio(0, 1)));
    assert_eq!(check_hurwitz(&[]), Err(RelativeDegreeError::Count { count: 0 }));
    // (s + 1)^4 is Hurwitz, and of relative degree 5.
    let fourth = integers(&[1, 4, 6, 4]);
    for answer in [check_hurwitz(&fourth), k_infinity(&fourth, 128).map(drop), k_2(&fourth, 128).map(drop)] {
        assert_eq!(answer, Err(RelativeDegreeError::Count { count: 4 }));
    }
    assert!(!is_hurwitz(&[]) && !is_hurwitz(&fourth));
    assert!(check_hurwitz(&fourth).unwrap_err().to_string().contains("relative degree 2 to 4"));
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
        // (s+1)^3, and (s^2 - s + 4)(s + 1), all coefficients nonnegative.
        (&[3, 3, 1], true),
        (&[0, 3, 4], false),
    ] {
        assert_eq!(printed_polynomial(&integers(a)).is_ok(), expected, "{a:?}");
    }
}

#[test]
fn hostile_sizes_end_quickly() {
    let (huge, tiny): (Rational, Rational) = (ratio(10, 1).pow(4000), ratio(10, 1).pow(-4000));
    for a in [
        vec![huge.clone(), tiny.clone()],
        vec![tiny.clone(), huge.clone()],
        vec![tiny.clone(), tiny.clone()],
        vec![huge.clone(), huge.clone(), huge.clone()],
        vec![tiny.clone(), tiny.clone(), huge.clone()],
        vec![tiny.clone(), ratio(1, 1), tiny.clone()],
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
