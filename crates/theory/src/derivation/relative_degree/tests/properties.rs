//! Properties of random filters.

use super::*;
use proptest::prelude::*;

/// Frequencies and damping ratios, with real roots: the polynomials up to a degree.
fn roots(degree: usize) -> impl Strategy<Value = Vec<Rational>> {
    let pair = (5i64..40, 15i64..95).prop_map(|(w, z)| (ratio(w, 10), ratio(z, 100)));
    let real = (5i64..40).prop_map(|x| ratio(x, 10));
    (proptest::collection::vec(pair, 0..2), proptest::collection::vec(real, 0..4))
        .prop_filter("a degree", move |(pairs, reals)| (1..=degree).contains(&(2 * pairs.len() + reals.len())))
        .prop_map(|(pairs, reals)| from_factors(&pairs, &reals))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 16, ..ProptestConfig::default() })]

    // The floating-point reference: step 2e-3 (roots up to 4), time 200 (decay at least 0.075): about 1e-5.
    #[test]
    fn k_infinity_agrees_with_integration(a in roots(3)) {
        let k = k_infinity(&a, 128).unwrap();
        prop_assert!(width(&k) < 1e-9);
        prop_assert!(k.lower_rational().unwrap() <= Rational::from(a[0].recip_ref()) * (ratio(1, 1) + k.upper_rational().unwrap() * &a[0]));
        prop_assert!(k.upper_rational().unwrap() >= Rational::from(a[0].recip_ref()));
        let float = l1_norm(&a, 2e-3, 200.0);
        prop_assert!((k.midpoint_f64() / float - 1.0).abs() < 2e-5, "{:?} {}", k, float);
    }

    #[test]
    fn time_scaling(a in roots(3), p in 1i64..30, q in 1i64..30) {
        // t -> lambda t: a_i, the coefficient of s^{i-1}, gets lambda^{n-i+1}; both constants scale.
        let (n, lambda) = (a.len() as u32, ratio(p, q));
        let scaled: Vec<Rational> =
            (0u32..).zip(&a).map(|(i, x)| Rational::from(Pow::pow(&lambda, n - i)) * x).collect();
        let factor = rational(&Rational::from(Pow::pow(&lambda, n)));
        prop_assert!(overlap(&k_infinity(&a, 128).unwrap(), &(k_infinity(&scaled, 128).unwrap() * &factor)));
        prop_assert!(overlap(&k_2(&a, 128).unwrap(), &(k_2(&scaled, 128).unwrap() * factor.sqr())));
    }

    #[test]
    fn norms_are_ordered(a in roots(2), b in roots(1)) {
        // |g|_1 >= sup |1/p(i w)|, and both are submultiplicative under cascades.
        let (k, peak) = (k_infinity(&a, 128).unwrap(), k_2(&a, 128).unwrap());
        prop_assert!(k.sqr().upper() >= peak.lower());
        let full = |a: &[Rational]| a.iter().cloned().chain([ratio(1, 1)]).collect::<Vec<_>>();
        let mut cascade = multiply(&full(&a), &full(&b));
        cascade.pop();
        prop_assert!(k_infinity(&cascade, 128).unwrap().lower() <= (k * k_infinity(&b, 128).unwrap()).upper());
        prop_assert!(k_2(&cascade, 128).unwrap().lower() <= (peak * k_2(&b, 128).unwrap()).upper());
    }
}

proptest! {
    #[test]
    fn k_2_agrees_with_a_scan(a in roots(3)) {
        let k = k_2(&a, 128).unwrap();
        prop_assert!(width(&k) < 1e-15);
        let f: Vec<f64> = peak::squared_modulus(&a).iter().map(Rational::to_f64).collect();
        let value = |w: f64| f.iter().rev().fold(0.0, |sum, c| sum * w + c);
        let least = (0..=40_000).map(|i| value(f64::from(i) * 5e-4)).fold(f64::INFINITY, f64::min);
        prop_assert!((k.midpoint_f64() * least - 1.0).abs() < 1e-4, "{:?} {}", k, 1.0 / least);
        prop_assert!(k.upper_f64() * least >= 1.0 - 1e-9);
    }

    #[test]
    fn the_squared_modulus_is_one(a in proptest::collection::vec(-50i64..50, 1..4), w in -9i64..9) {
        // p(i w) by Horner in Gaussian integers.
        let (mut re, mut im) = (1i64, 0i64);
        for c in a.iter().rev() {
            (re, im) = (-im * w + c, re * w);
        }
        let f = peak::squared_modulus(&integers(&a));
        let value = f.iter().rev().fold(Rational::new(), |sum, c| sum * (w * w) + c);
        prop_assert_eq!(value, Rational::from(re) * re + Rational::from(im) * im);
    }

    #[test]
    fn one_unstable_root_is_found(
        (a, pair) in any::<bool>().prop_flat_map(|pair| (roots(if pair { 1 } else { 2 }), Just(pair))),
        p in 0i64..50,
    ) {
        prop_assert!(is_hurwitz(&a));
        let mut full = a;
        full.push(ratio(1, 1));
        // A root at p/10 >= 0, or a pair with real part p/10 and imaginary part 1.
        let c = ratio(p, 10);
        let factor = if pair {
            vec![Rational::from(c.square_ref()) + 1, -c * 2u32, ratio(1, 1)]
        } else {
            vec![-c, ratio(1, 1)]
        };
        let mut unstable = multiply(&full, &factor);
        unstable.pop();
        prop_assert!(matches!(check_hurwitz(&unstable), Err(RelativeDegreeError::NotHurwitz(_))));
    }

    #[test]
    fn nothing_panics(a in proptest::collection::vec((any::<i64>(), 1i64..i64::MAX), 0..4)) {
        let a: Vec<Rational> = a.into_iter().map(Rational::from).collect();
        prop_assert_eq!(is_hurwitz(&a), check_hurwitz(&a).is_ok());
        if !is_hurwitz(&a) {
            prop_assert!(k_infinity(&a, 64).is_err() && k_2(&a, 64).is_err());
        }
    }
}
