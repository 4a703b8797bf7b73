//! Inclusion, undefinedness, comparisons and decimals against arithmetic that shares nothing with the code under test:
//! exact rationals, and single MPFR operations at 2000 bits rounded both ways.

use super::{Enclosure, Truth};
use crate::number::parse_decimal;
use proptest::prelude::*;
use proptest::sample::select;
use proptest::test_runner::RngSeed;
use rug::float::{Constant, Round, Special};
use rug::ops::Pow;
use rug::{Float, Integer, Rational};

/// Bits of the reference values.
const REFERENCE: u32 = 2000;

/// Bits of the numbers that intervals are made of.
const BITS: u32 = 40;

fn config() -> ProptestConfig {
    ProptestConfig { cases: 600, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() }
}

/// Numbers of [`BITS`] bits: zero, one, small integers and their halves, neighbours of multiples of pi/2, tiny and
/// huge ones of both signs.
fn number() -> impl Strategy<Value = Float> {
    let quarter_turns = (-40_i32..40, -1_i32..2).prop_map(|(k, step)| {
        let mut x = Float::with_val(BITS, Constant::Pi) * k / 2u32;
        if step > 0 {
            x.next_up();
        } else if step < 0 {
            x.next_down();
        }
        // The neighbours of 0 would be the smallest numbers there are: as rationals they fill the memory.
        if k == 0 { Float::with_val(BITS, step) >> 1100u32 } else { x }
    });
    let scaled = |shift| (-1_000_000_i64..1_000_000, shift).prop_map(|(n, shift)| Float::with_val(BITS, n) << shift);
    prop_oneof![
        2 => Just(Float::new(BITS)),
        2 => select(vec![1, -1]).prop_map(|n| Float::with_val(BITS, n)),
        3 => (-12_i32..13).prop_map(|n| Float::with_val(BITS, n) / 2u32),
        3 => quarter_turns,
        4 => scaled(-24_i32..-12),
        1 => scaled(-1100_i32..-20),
        1 => scaled(0_i32..1100),
    ]
}

fn precision() -> impl Strategy<Value = u32> {
    select(vec![2, 20, 53, 64, 128])
}

/// An interval with ends of possibly different precisions, and some of the numbers in it.
#[derive(Clone, Debug)]
struct Sample {
    enclosure: Enclosure,
    members: Vec<Float>,
}

/// Points, narrow and wide intervals, half-lines and the whole line.
fn sample() -> impl Strategy<Value = Sample> {
    let ends = prop_oneof![
        3 => number().prop_map(|x| [x.clone(), x]),
        6 => [number(), number()].prop_map(|[a, b]| if a <= b { [a, b] } else { [b, a] }),
        1 => number().prop_map(|x| [x, Float::with_val(BITS, Special::Infinity)]),
        1 => number().prop_map(|x| [Float::with_val(BITS, Special::NegInfinity), x]),
        1 => Just([Special::NegInfinity, Special::Infinity].map(|end| Float::with_val(BITS, end))),
    ];
    (ends, precision(), precision(), [number(), number(), number()]).prop_map(|([a, b], p, q, others)| {
        let lower = Float::with_val_round(p, &a, Round::Down).0;
        let upper = Float::with_val_round(q, &b, Round::Up).0;
        let middle = Float::with_val(REFERENCE, &a + &b) / 2u32;
        let members = [&a, &b, &middle, &lower, &upper]
            .into_iter()
            .chain(&others)
            .filter(|x| x.is_finite() && **x >= lower && **x <= upper)
            .cloned()
            .collect();
        Sample { enclosure: Enclosure::new(lower, upper), members }
    })
}

fn rounded<T>(value: T, round: Round) -> Option<Float>
where
    Float: rug::ops::AssignRound<T, Round = Round, Ordering = std::cmp::Ordering>,
{
    Some(Float::with_val_round(REFERENCE, value, round).0)
}

/// Name, operation, and the function at the reference precision, rounded as told; `None` outside its domain.
type UnaryCase = (&'static str, fn(&Enclosure) -> Enclosure, for<'a> fn(&'a Float, Round) -> Option<Float>);

const UNARY: [UnaryCase; 15] = [
    ("negate", Enclosure::negate, |x, r| rounded(-x, r)),
    ("-", |x| -x, |x, r| rounded(-x, r)),
    ("abs", Enclosure::abs, |x, r| rounded(x.abs_ref(), r)),
    ("recip", Enclosure::recip, |x, r| if x.is_zero() { None } else { rounded(x.recip_ref(), r) }),
    ("sqr", Enclosure::sqr, |x, r| rounded(x.square_ref(), r)),
    ("sqrt", Enclosure::sqrt, |x, r| if *x < 0 { None } else { rounded(x.sqrt_ref(), r) }),
    ("exp", Enclosure::exp, |x, r| rounded(x.exp_ref(), r)),
    ("log", Enclosure::log, |x, r| if *x <= 0 { None } else { rounded(x.ln_ref(), r) }),
    ("sin", Enclosure::sin, |x, r| rounded(x.sin_ref(), r)),
    ("cos", Enclosure::cos, |x, r| rounded(x.cos_ref(), r)),
    ("tan", Enclosure::tan, |x, r| rounded(x.tan_ref(), r)),
    ("atan", Enclosure::atan, |x, r| rounded(x.atan_ref(), r)),
    ("tanh", Enclosure::tanh, |x, r| rounded(x.tanh_ref(), r)),
    ("coth", Enclosure::coth, |x, r| if x.is_zero() { None } else { rounded(x.coth_ref(), r) }),
    ("to itself", |x| x.hull(x).intersect(x), |x, r| rounded(x, r)),
];

type BinaryCase =
    (&'static str, fn(&Enclosure, &Enclosure) -> Enclosure, for<'a> fn((&'a Float, &'a Float), Round) -> Option<Float>);

const BINARY: [BinaryCase; 9] = [
    ("+", |a, b| a + b, |(a, b), r| rounded(a + b, r)),
    ("-", |a, b| a - b, |(a, b), r| rounded(a - b, r)),
    ("*", |a, b| a * b, |(a, b), r| rounded(a * b, r)),
    ("/", |a, b| a / b, |(a, b), r| if b.is_zero() { None } else { rounded(a / b, r) }),
    ("min", Enclosure::min, |(a, b), r| rounded(if a < b { a } else { b }, r)),
    ("max", Enclosure::max, |(a, b), r| rounded(if a > b { a } else { b }, r)),
    ("hull, left", Enclosure::hull, |(a, _), r| rounded(a, r)),
    ("hull, right", Enclosure::hull, |(_, b), r| rounded(b, r)),
    ("pow", Enclosure::pow, |(a, b), r| {
        if *a > 0 {
            rounded(Pow::pow(a, b), r)
        } else if a.is_zero() && *b > 0 {
            Some(Float::new(REFERENCE))
        } else {
            None
        }
    }),
];

/// Whether the enclosure may hold the value: certainly so if the reference is right, whatever the rounding.
fn holds<A: Copy>(found: &Enclosure, reference: impl Fn(A, Round) -> Option<Float>, at: A) -> bool {
    match (reference(at, Round::Down), reference(at, Round::Up)) {
        (Some(down), Some(up)) => !found.is_defined() || (found.lower() <= up && found.upper() >= down),
        _ => !found.is_defined(),
    }
}

/// The invariant of the type.
fn is_well_formed(x: &Enclosure) -> bool {
    let ordered = x.lower() <= x.upper() && x.lower() < f64::INFINITY && x.upper() > f64::NEG_INFINITY;
    ordered || (x.lower().is_nan() && x.upper().is_nan())
}

/// Whether the ends are equal or neighbours at the precision.
fn is_tight(x: &Enclosure) -> bool {
    let mut next = Float::with_val_round(x.precision(), x.lower(), Round::Down).0;
    next.next_up();
    x.is_defined() && x.upper() <= next
}

fn point(x: &Float, precision: u32) -> Enclosure {
    Enclosure::new(Float::with_val(precision, x), Float::with_val(precision, x))
}

fn between(lower: i32, upper: i32, precision: u32) -> Enclosure {
    Enclosure::between(&Rational::from(lower), &Rational::from(upper), precision)
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn unary_operations_include_every_value(a in sample()) {
        for (name, operation, reference) in UNARY {
            let found = operation(&a.enclosure);
            prop_assert!(is_well_formed(&found), "{} {:?}", name, found);
            for x in &a.members {
                prop_assert!(holds(&found, reference, x), "{} of {:?} is {:?}, not so at {:?}", name, a.enclosure, found, x);
            }
        }
    }

    #[test]
    fn binary_operations_include_every_value(a in sample(), b in sample()) {
        for (name, operation, reference) in BINARY {
            let found = operation(&a.enclosure, &b.enclosure);
            prop_assert!(is_well_formed(&found), "{} {:?}", name, found);
            for x in &a.members {
                for y in &b.members {
                    prop_assert!(
                        holds(&found, reference, (x, y)),
                        "{:?} {} {:?} is {:?}, not so at {:?}, {:?}", a.enclosure, name, b.enclosure, found, x, y
                    );
                }
            }
        }
    }

    #[test]
    fn operands_may_be_integers(a in sample(), n in select(vec![0, 1, -1, 2, -3, 720, i64::MAX, i64::MIN])) {
        // As exact as the other one's precision allows.
        let b = Enclosure::from_integer(n, a.enclosure.precision().max(53));
        prop_assert!(b.contains(&Rational::from(n)) && (b.is_exact() || n.unsigned_abs() > 1 << 53));
        prop_assert_eq!([&a.enclosure + n, n + &a.enclosure], [&a.enclosure + &b, &b + &a.enclosure]);
        prop_assert_eq!([&a.enclosure - n, n - &a.enclosure], [&a.enclosure - &b, &b - &a.enclosure]);
        prop_assert_eq!([&a.enclosure * n, n * &a.enclosure], [&a.enclosure * &b, &b * &a.enclosure]);
        prop_assert_eq!([&a.enclosure / n, n / &a.enclosure], [&a.enclosure / &b, &b / &a.enclosure]);
    }

    #[test]
    fn integer_powers_include_every_value(
        a in sample(), n in select(vec![0, 1, 2, 3, -1, -2, -3, 7, 1000, -1001, 1_000_000_000_000_i64, -999_999_999_999])
    ) {
        let n = Integer::from(n);
        let found = a.enclosure.pow_integer(&n);
        prop_assert!(is_well_formed(&found));
        for x in &a.members {
            let outside = n < 0 && x.is_zero();
            let reference = |x: &Float, round| if outside { None } else { rounded(Pow::pow(x, &n), round) };
            prop_assert!(holds(&found, reference, x), "{:?}^{} is {:?}, not so at {:?}", a.enclosure, n, found, x);
        }
    }

    /// A function of a number that is known exactly is known to the last bit: nothing is lost needlessly, and what is
    /// defined is not called undefined.
    #[test]
    fn values_at_numbers_are_tight(x in number(), y in number(), p in select(vec![BITS, 53, 64, 128])) {
        let (a, b) = (point(&x, p), point(&y, p));
        let moderate = |x: &Float| x.get_exp().is_none_or(|e| e < 16);
        for (name, operation, reference) in UNARY {
            let trigonometric = ["sin", "cos", "tan"].contains(&name);
            if reference(&x, Round::Down).is_some() && (!trigonometric || moderate(&x)) {
                prop_assert!(is_tight(&operation(&a)), "{} of {:?} is {:?}", name, x, operation(&a));
            }
        }
        for (name, operation, reference) in BINARY {
            if reference((&x, &y), Round::Down).is_some() && !name.starts_with("hull") {
                prop_assert!(is_tight(&operation(&a, &b)), "{:?} {} {:?} is {:?}", x, name, y, operation(&a, &b));
            }
        }
    }

    /// Both at once are what each by itself is.
    #[test]
    fn cosine_and_sine_are_the_same_together(a in sample()) {
        let x = &a.enclosure;
        let [cos, sin] = x.cos_sin();
        prop_assert_eq!((&cos, &sin), (&x.cos(), &x.sin()));
        prop_assert_eq!([cos.precision(), sin.precision()], [x.precision(); 2]);
    }

    /// Between the ends of an interval there are no values but those of the function: the bounds are attained, up to
    /// rounding, at an end or at an extremum.
    #[test]
    fn ranges_are_attained(a in sample()) {
        let x = &a.enclosure;
        let moderate = [x.lower(), x.upper()].iter().all(|end| end.is_finite() && end.get_exp().is_none_or(|e| e < 16));
        if !moderate || x.precision() < BITS {
            return Ok(());
        }
        let p = x.precision();
        let ends = |f: fn(&Enclosure) -> Enclosure| {
            let (lower, upper) = (f(&point(&x.lower(), p)), f(&point(&x.upper(), p)));
            lower.is_defined().then(|| lower.hull(&upper))
        };
        for f in [Enclosure::exp, Enclosure::atan, Enclosure::tanh, Enclosure::sqrt] {
            prop_assert!(ends(f).is_none_or(|hull| hull == f(x)));
        }
        let one = Float::with_val(p, 1);
        for (f, phase) in [(Enclosure::sin as fn(&Enclosure) -> Enclosure, 1), (Enclosure::cos, 0)] {
            let (found, hull) = (f(x), ends(f).expect("sine and cosine are defined everywhere"));
            // The crests are at phase + 4 k and the troughs at phase + 2 + 4 k quarter turns.
            let quarter = Float::with_val(200, Constant::Pi) / 2u32;
            let turns = |end: &Float, offset: i32| ((Float::with_val(200, end) / &quarter - offset) / 4u32).floor();
            let passes = |offset: i32| turns(&x.lower(), offset) < turns(&x.upper(), offset);
            let touches = |offset: i32| passes(offset) || (offset == 0 && x.contains_zero());
            prop_assert_eq!(found.upper(), if touches(phase) { one.clone() } else { hull.upper() });
            let minus_one = Float::with_val(p, -1);
            prop_assert_eq!(found.lower(), if passes(phase + 2) { minus_one } else { hull.lower() });
        }
    }

    #[test]
    fn predicates_agree_with_exact_comparison(a in sample(), b in sample()) {
        let (x, y) = (&a.enclosure, &b.enclosure);
        let exact = |x: &Float| x.to_rational().expect("members are finite");
        let agrees = |answer: Truth, holds: bool| answer.is_undecided() || answer == Truth::exact(holds);
        for s in &a.members {
            let s = exact(s);
            prop_assert!(x.contains(&s));
            prop_assert!(s != 0 || x.contains_zero());
            prop_assert!(agrees(x.is_positive(), s > 0) && agrees(x.is_nonnegative(), s >= 0));
            prop_assert!(x.lower_rational().is_none_or(|lower| lower <= s));
            prop_assert!(x.upper_rational().is_none_or(|upper| upper >= s));
            prop_assert!(Rational::from_f64(x.lower_f64()).is_none_or(|lower| lower <= s));
            prop_assert!(Rational::from_f64(x.upper_f64()).is_none_or(|upper| upper >= s));
            prop_assert!(x.upper().is_infinite() || x.ceiling().is_exact() && s <= x.ceiling().upper_rational().expect("finite"));
            for t in b.members.iter().map(exact) {
                prop_assert!(agrees(x.lt(y), s < t) && agrees(x.le(y), s <= t));
                prop_assert!(agrees(x.gt(y), s > t) && agrees(x.ge(y), s >= t));
                if s == t {
                    prop_assert!(x.intersect(y).contains(&s));
                }
            }
        }
        if x.is_exact() && y.is_exact() {
            prop_assert!([x.lt(y), x.le(y), x.gt(y), x.ge(y), x.is_positive(), x.is_nonnegative()].iter().all(|t| !t.is_undecided()));
        }
        let common = x.intersect(y);
        prop_assert!(is_well_formed(&common));
        prop_assert_eq!(common.is_defined(), !x.lt(y).is_true() && !y.lt(x).is_true());
    }

    #[test]
    fn conversions_of_rationals_are_the_tightest(n in any::<i64>(), d in 1..i64::MAX, shift in -300_i32..300, p in precision()) {
        let value = Rational::from((n, d)) << shift;
        let found = Enclosure::from_rational(&value, p);
        prop_assert!(found.contains(&value) && is_tight(&found) && found.precision() == p);
        prop_assert_eq!(found.is_exact(), found.lower_rational() == Some(value.clone()));
        let [below, above] = [found.lower_f64(), found.upper_f64()].map(Rational::from_f64);
        prop_assert!(below.is_none_or(|below| below <= value) && above.is_none_or(|above| above >= value));
        let integer = Enclosure::from_integer(n, p);
        prop_assert!(integer.contains(&Rational::from(n)) && is_tight(&integer));
        let wide = Enclosure::between(&value, &(value.clone() + 1u32), p);
        prop_assert!(wide.contains(&value) && wide.contains(&(value + 1u32)));
    }

    /// At a higher precision the same operations give a part of what they gave before.
    #[test]
    fn precision_tightens(n in -100_000_i64..100_000, d in 1_i64..1000, p in 24_u32..200, more in 1_u32..200) {
        let chain = |p: u32| {
            let x = Enclosure::from_rational(&Rational::from((n, d)), p);
            let pi = Enclosure::pi(p);
            let positive = x.sqr() + 1;
            [
                x.sin(), x.cos(), x.atan() * &pi, (&x / 1000).tanh(), (&x / 1000).exp(), positive.log(), positive.sqrt(),
                positive.pow(&(&pi / 3)), positive.pow_integer(&Integer::from(-5)), (&x - &pi).abs().min(&positive),
                (x.sin() * &positive).max(&(&x / &pi)), positive.recip() - x.cos(), positive.coth(), (&x / &positive).atan(),
            ]
        };
        for (coarse, fine) in chain(p).iter().zip(&chain(p + more)) {
            prop_assert!(coarse.lower() <= fine.lower() && fine.upper() <= coarse.upper(), "{:?} {:?}", coarse, fine);
        }
    }

    #[test]
    fn integers_are_all_those_inside(n in -1000_i32..1000, m in 0_i32..40, p in 24_u32..64) {
        let (lower, upper) = (Rational::from((n, 8)), Rational::from((n + m, 8)));
        let inside: Vec<i32> = (-130..140).filter(|k| lower <= *k && upper >= *k).collect();
        let found = Enclosure::between(&lower, &upper, p).integers();
        let expected = inside.first().zip(inside.last()).map(|(a, b)| (Integer::from(*a), Integer::from(*b)));
        prop_assert_eq!(found, expected);
    }

    /// Decimals are on the right side, and by less than a unit in the last digit.
    #[test]
    fn decimals_are_outward_and_close(a in sample(), nines in 0_u32..22, digits in 1_usize..30) {
        // Just below a power of ten, rounding up carries through every digit.
        let carry = Rational::from(Integer::from(10).pow(nines) * 1000u32 - 1u32) / 1000u32;
        let carry = Enclosure::from_rational(&carry, 200);
        for x in [&a.enclosure, &carry, &-&carry, &(&carry / 1_000_000_000)] {
            for (end, text, sign) in [(x.lower(), x.lower_decimal(digits), -1), (x.upper(), x.upper_decimal(digits), 1)] {
                let Some(end) = end.to_rational() else {
                    prop_assert_eq!(text, if sign > 0 { "inf" } else { "-inf" });
                    continue;
                };
                let read = parse_decimal(&text).expect("a decimal");
                let distance: Rational = Rational::from(&read - &end) * sign;
                prop_assert!(distance >= 0, "{} for {:?}", text, end);
                let scale = read.clone().abs().max(end.abs());
                prop_assert!(distance.is_zero() || distance * Integer::from(10).pow(digits as u32 - 1) < scale, "{}", text);
                let mantissa = text.split('e').next().unwrap_or(&text);
                let shown: String = mantissa.chars().filter(char::is_ascii_digit).collect();
                prop_assert!(shown.trim_matches('0').len() <= digits, "{}", text);
            }
        }
    }
}

#[test]
fn undefined_is_contagious() {
    let none = Enclosure::undefined(64);
    for (name, operation, _) in UNARY {
        assert!(!operation(&none).is_defined(), "{name}");
    }
    for other in [Enclosure::zero(64), between(-1, 2, 128), Enclosure::entire(64), none.clone()] {
        for (name, operation, _) in BINARY {
            assert!(!operation(&none, &other).is_defined() && !operation(&other, &none).is_defined(), "{name}");
        }
        assert!(!none.intersect(&other).is_defined() && !other.intersect(&none).is_defined());
        for answer in [none.lt(&other), none.le(&other), none.gt(&other), none.ge(&other), other.lt(&none)] {
            assert!(answer.is_undecided());
        }
    }
    for exponent in [-1, 0, 1] {
        assert!(!none.pow_integer(&Integer::from(exponent)).is_defined());
    }
    assert!(none.is_positive().is_undecided() && none.is_nonnegative().is_undecided());
    assert!(!none.contains(&Rational::new()) && !none.contains_zero() && !none.is_bounded() && !none.is_exact());
    assert!(none.lower_rational().is_none() && none.upper_rational().is_none() && none.integers().is_none());
    assert!(none.lower_f64().is_nan() && none.upper_f64().is_nan() && none.midpoint_f64().is_nan());
    assert!(!none.ceiling().is_defined() && none == none.clone() && none != Enclosure::entire(64));
}

#[test]
fn leaving_the_domain_is_undefined() {
    let (zero, touching, across) = (Enclosure::zero(64), between(0, 1, 64), between(-1, 1, 64));
    for x in [&zero, &touching, &across, &Enclosure::entire(64)] {
        assert!(!x.recip().is_defined() && !x.log().is_defined() && !x.coth().is_defined());
        assert!(!(1 / x).is_defined() && !(x / x).is_defined());
        assert!(
            !x.pow_integer(&Integer::from(-1)).is_defined()
                && !x.pow(&across).is_defined()
                && !x.pow(&zero).is_defined()
        );
        assert_eq!(x.pow_integer(&Integer::new()), Enclosure::one(64));
    }
    assert!(
        touching.sqrt().is_defined() && !across.sqrt().is_defined() && !across.pow(&Enclosure::one(64)).is_defined()
    );
    assert_eq!(zero.pow(&Enclosure::pi(64)), zero);
    assert!(!between(1, 2, 64).tan().is_defined() && !between(-2, -1, 64).tan().is_defined());
    assert!(!Enclosure::entire(64).tan().is_defined() && between(2, 4, 64).tan().is_defined());
    // 355/226 is within 1.4e-7 of pi/2, and still on this side of no pole.
    assert!(Enclosure::from_rational(&Rational::from((355, 226)), 64).tan().is_bounded());
    assert!(!(Enclosure::pi(64) / 2).tan().is_defined());
}

#[test]
fn reversed_or_disjoint_ends_are_undefined() {
    let [one, two] = [1, 2].map(|n| Float::with_val(64, n));
    let [low, high] = [Special::NegInfinity, Special::Infinity].map(|end| Float::with_val(64, end));
    assert!(!Enclosure::new(two.clone(), one.clone()).is_defined());
    assert!(!Enclosure::new(high.clone(), high.clone()).is_defined() && !Enclosure::new(low.clone(), low).is_defined());
    assert!(!Enclosure::new(Float::with_val(64, Special::Nan), one.clone()).is_defined());
    assert!(!Enclosure::between(&Rational::from(2), &Rational::from(1), 64).is_defined());
    assert!(!between(0, 1, 64).intersect(&between(2, 3, 64)).is_defined());
    assert_eq!(between(0, 2, 64).intersect(&between(2, 3, 64)), Enclosure::new(two.clone(), two));
    assert!(!Enclosure::new(one, high).ceiling().is_defined());
}

/// End points are chosen exactly even if the operands have different precisions.
#[test]
fn mixed_precisions_lose_nothing() {
    let x = Enclosure::from_rational(&Rational::from((7, 5)), 128);
    let (zero, two) = (Enclosure::zero(2), Enclosure::from_integer(2, 2));
    assert_eq!([zero.max(&x), two.min(&x), x.max(&zero), x.min(&two)], [(); 4].map(|()| x.clone()));
    // The ends of [-7/5, 1] need different precisions, and that of the absolute value the larger one.
    let across = Enclosure::new(-x.upper(), Float::with_val(2, 1));
    assert_eq!(across.abs().upper(), x.upper());
    for joined in [zero.hull(&zero.negate()), zero.hull(&x), two.max(&x).intersect(&x.max(&two))] {
        assert_eq!(joined.lower().prec(), joined.upper().prec());
    }
}

#[test]
fn another_precision_is_rounded_outward() {
    let third = Enclosure::from_rational(&Rational::from((1, 3)), 128);
    assert_eq!(third.at_precision(53), Enclosure::from_rational(&Rational::from((1, 3)), 53));
    assert_eq!(third.at_precision(200).at_precision(128), third);
    assert!(!Enclosure::undefined(53).at_precision(128).is_defined());
    let end = third.upper();
    assert!(Enclosure::point(&end).is_exact() && Enclosure::point(&end).upper() == end);
}

#[test]
fn huge_arguments_are_not_reduced() {
    let huge = Enclosure::from_rational(&parse_decimal("1e1200").unwrap(), 1024);
    assert_eq!(huge.sin(), between(-1, 1, 64));
    assert_eq!(huge.cos(), between(-1, 1, 64));
    assert!(!huge.tan().is_defined());
}
