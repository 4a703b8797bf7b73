//! Intervals against each other at two precisions, and constants against known digits.

use proofs_check::exact::Exact;
use proofs_check::interval::Interval;
use rug::Rational;

type Unary = fn(&Interval) -> Interval;

#[test]
fn coarse_intervals_contain_fine_ones() {
    let functions: [(&str, Unary); 20] = [
        ("sqr", Interval::sqr),
        ("sqrt", Interval::sqrt),
        ("exp", Interval::exp),
        ("log", Interval::log),
        ("atan", Interval::atan),
        ("tanh", Interval::tanh),
        ("coth", Interval::coth),
        ("cos", Interval::cos),
        ("sin", Interval::sin),
        ("tan", Interval::tan),
        ("recip", Interval::recip),
        ("abs", Interval::abs),
        ("zeta", Interval::zeta),
        ("powi", |x| x.powi(-3)),
        ("exprelr", |x| x.exprelr(0)),
        ("exprelr, differentiated", |x| x.exprelr(1)),
        ("exprelr, five times", |x| x.exprelr(5)),
        ("sinc", |x| x.sinc(0)),
        ("sinc, differentiated", |x| x.sinc(1)),
        ("sinc, five times", |x| x.sinc(5)),
    ];
    for (name, f) in functions {
        let mut defined = 0;
        for numerator in -40..40 {
            let (a, b) = (Rational::from((numerator, 7)), Rational::from((numerator + 3, 7)));
            let wide = f(&Interval::between(&a, &b, 30));
            for step in 0..=3 {
                let fine = f(&Interval::rational(&Rational::from((numerator + step, 7)), 200));
                if wide.is_defined() {
                    assert!(fine.is_defined() && wide.lo() <= fine.lo() && fine.hi() <= wide.hi(), "{name} at {a}");
                    defined += 1;
                }
            }
        }
        assert!(defined > 40, "{name}: {defined}");
    }
}

#[test]
fn undefined_is_contagious_and_decides_nothing() {
    let none = Interval::int(-1, 64).sqrt();
    let one = Interval::int(1, 64);
    let zero = Interval::int(0, 64);
    for value in [
        &none + &one,
        &none * &zero,
        &one / &zero,
        none.min(&one),
        none.max(&one),
        none.hull(&one),
        none.powi(0),
        none.abs(),
        none.sqr(),
        zero.pow(&zero),
        one.zeta(),
        none.cos(),
        none.exprelr(0),
        none.sinc(1),
    ] {
        assert!(!value.is_defined());
        assert_eq!((value.lt(&one), value.le(&one), one.lt(&value)), (None, None, None));
    }
}

#[test]
fn strict_and_loose_comparisons() {
    let one = Interval::int(1, 64);
    assert_eq!((one.lt(&one), one.le(&one)), (Some(false), Some(true)));
    let third = Interval::rational(&Rational::from((1, 3)), 64);
    assert_eq!((third.lt(&third), third.le(&third)), (None, None));
}

#[test]
fn an_infinite_end_decides_nothing_where_it_leaves_no_members() {
    let (one, entire) = (Interval::int(1, 64), Interval::entire(64));
    let from_one = one.hull(&entire).max(&one);
    // An upper bound that is not known, as an interval of its own.
    let (above, below) = (entire.ceiling(), -entire.ceiling());
    for value in [&one, &entire, &from_one, &above, &below] {
        for none in [&above, &below] {
            assert_eq!((value.lt(none), value.le(none)), (None, None), "{value:?}, {none:?}");
            assert_eq!((none.lt(value), none.le(value)), (None, None), "{none:?}, {value:?}");
        }
    }
    // A bound on one side is enough where it lies right.
    let two = Interval::int(2, 64);
    assert_eq!((one.lt(&from_one.max(&two)), from_one.lt(&one), from_one.le(&one)), (Some(true), Some(false), None));
    assert_eq!(Interval::int(0, 64).le(&from_one), Some(true));
}

#[test]
fn exact_numbers() {
    let rational = |n: i64, d: i64| Exact::rational(&Rational::from((n, d))).unwrap();
    let two = rational(2, 1).sqrt().unwrap();
    assert_eq!(two.mul(&two), Some(rational(2, 1)));
    assert_eq!(two.add(&two), rational(8, 1).sqrt());
    assert_eq!(two.add(&two.neg()).unwrap().sign(), 0);
    assert_eq!(two.add(&rational(1, 1)), None);
    assert_eq!(Exact::pi().compare(&rational(3, 1)), None);
    assert_eq!(rational(-3, 2).compare(&rational(-1, 1)), Some(std::cmp::Ordering::Less));
    assert!(
        rational(-1, 1).sqrt().is_none() && rational(0, 1).recip().is_none() && rational(3, 1).pow(1_000_000).is_none()
    );
    assert_eq!(rational(-2, 3).pow(-3), Some(rational(-27, 8)));
}

/// Ends keep all their bits: the result contains what both orders of the operands say, whatever their precisions.
#[test]
fn operands_of_different_precision_lose_nothing() {
    for numerator in [-17, -1, 1, 13] {
        let third = Rational::from((numerator, 3));
        for (p, q) in [(24, 200), (200, 24)] {
            let (a, b) = (Interval::rational(&third, p), Interval::rational(&third, q));
            let coarse = Interval::rational(&third, 24);
            let fine = Interval::rational(&third, 200);
            let least = [&coarse, &fine].map(|x| x.lower().unwrap()).into_iter().min().unwrap();
            let most = [&coarse, &fine].map(|x| x.upper().unwrap()).into_iter().max().unwrap();
            let hull = a.hull(&b);
            assert_eq!((hull.lower().unwrap(), hull.upper().unwrap()), (least, most));
            let common = a.intersect(&b);
            assert!(common.is_defined());
            assert_eq!((common.lower(), common.upper()), (fine.lower(), fine.upper()));
            for extreme in [a.min(&b), a.max(&b), a.clone() + (&b - &b)] {
                assert!(extreme.lower().unwrap() <= third && third <= extreme.upper().unwrap());
            }
        }
    }
    // One number beside another of which it is the nearest neighbour at 24 bits.
    let wide = Interval::between(&Rational::from((-1, 1)), &Rational::from((1, 1)), 24);
    let beyond = Rational::from(1) + Rational::from((1, 1 << 30));
    let narrow = Interval::rational(&beyond, 200);
    assert_eq!(wide.hull(&narrow).upper().unwrap(), beyond);
    assert_eq!(wide.max(&narrow).lower().unwrap(), beyond);
    assert_eq!((-&wide).min(&-&narrow).upper().unwrap(), -beyond.clone());
    assert!(!wide.intersect(&narrow).is_defined() && !narrow.intersect(&wide).is_defined());
}

/// The range of a wave over an interval is met to rounding: where it is monotone, across one extreme, across many.
#[test]
fn waves_have_their_true_ranges() {
    let over = |f: Unary, lo: i64, hi: i64| f(&Interval::between(&Rational::from(lo), &Rational::from(hi), 64));
    let cases: [(Unary, i64, i64, f64, f64); 12] = [
        (Interval::cos, 0, 1, 1f64.cos(), 1.0),
        (Interval::cos, 0, 3, 3f64.cos(), 1.0),
        (Interval::cos, -1, 2, 2f64.cos(), 1.0),
        (Interval::cos, 3, 4, -1.0, 4f64.cos()),
        (Interval::cos, 4, 6, 4f64.cos(), 6f64.cos()),
        (Interval::cos, 0, 7, -1.0, 1.0),
        (Interval::cos, 1_000_001, 1_000_002, 1_000_002f64.cos(), 1_000_001f64.cos()),
        (Interval::sin, 0, 1, 0.0, 1f64.sin()),
        (Interval::sin, -2, 1, -1.0, 1f64.sin()),
        (Interval::sin, 1, 3, 3f64.sin(), 1.0),
        (Interval::sin, 2, 4, 4f64.sin(), 2f64.sin()),
        (Interval::sin, 2, 8, -1.0, 1.0),
    ];
    for (f, lo, hi, least, most) in cases {
        let range = over(f, lo, hi);
        let (below, above) = (range.lo().to_f64(), range.hi().to_f64());
        assert!((below - least).abs() < 1e-15 && (above - most).abs() < 1e-15, "[{lo}, {hi}]: {below} {above}");
    }
    // What is not reduced is within [-1, 1].
    let enormous = over(Interval::sin, 1 << 40, 1 << 40);
    assert_eq!((enormous.lo().to_f64(), enormous.hi().to_f64()), (-1.0, 1.0));
}
