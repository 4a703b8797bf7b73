//! Intervals of 53 bits, which have doubles for ends, against exact rationals: their ends are those that MPFR
//! has at 53 bits, and powers contain what they must.

use proofs_check::interval::Interval;
use rug::float::Round;
use rug::ops::Pow;
use rug::{Float, Rational};

const TWO_TO_53: f64 = 9_007_199_254_740_992.0;

/// A sequence that corners are drawn from as often as anything between them.
struct Drawn(u64);

impl Drawn {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.0 >> 11
    }

    fn number(&mut self) -> Float {
        let corners = [0.0, 1.0, -1.0, 2.0, 1e-120, -1e120, 1e-200, 1e200, 3e-130, 1.0 - 1.0 / TWO_TO_53, TWO_TO_53];
        let mantissa = self.bits() as f64 / TWO_TO_53 + 0.5;
        let value = match self.bits() % 6 {
            0 => corners[self.bits() as usize % corners.len()],
            1 => corners[self.bits() as usize % corners.len()].next_up(),
            2 => (self.bits() % 7) as f64 - 3.0,
            3 => (mantissa - 1.0) * 10f64.powi((self.bits() % 260) as i32 - 130),
            _ => (mantissa - 1.0) * 4.0,
        };
        Float::with_val(53, value)
    }

    fn interval(&mut self) -> Interval {
        let first = self.number();
        let second = match self.bits() % 3 {
            0 => first.clone(),
            1 => Float::with_val(53, first.to_f64().next_up()),
            _ => self.number(),
        };
        if first <= second { Interval::new(first, second) } else { Interval::new(second, first) }
    }
}

fn ends(value: &Interval) -> [Rational; 2] {
    [value.lower().unwrap(), value.upper().unwrap()]
}

/// That the interval has 53 bits, and that its ends are these numbers, rounded outward as MPFR does.
fn encloses(found: &Interval, [least, most]: [&Rational; 2], what: &str) {
    let rounded = |x: &Rational, round| Float::with_val_round(53, x, round).0;
    let expected = [rounded(least, Round::Down), rounded(most, Round::Up)];
    assert_eq!(found.precision(), 53, "{what}");
    assert!(
        *found.lo() == expected[0] && *found.hi() == expected[1],
        "{what}: {found:?}, not {expected:?}, for {least} .. {most}"
    );
}

fn extremes(all: [Rational; 4]) -> [Rational; 2] {
    let least = all.iter().min().unwrap().clone();
    [least, all.into_iter().max().unwrap()]
}

#[test]
fn operations_enclose_the_exact_results() {
    let mut drawn = Drawn(20_261_127);
    for case in 0..60_000 {
        let (x, y) = (drawn.interval(), drawn.interval());
        let ([a, b], [c, d]) = (ends(&x), ends(&y));
        let of = |name: &str| format!("{case}: {x:?} {name} {y:?}");
        encloses(&(&x + &y), [&Rational::from(&a + &c), &Rational::from(&b + &d)], &of("+"));
        encloses(&(&x - &y), [&Rational::from(&a - &d), &Rational::from(&b - &c)], &of("-"));
        let products = [&a * &c, &a * &d, &b * &c, &b * &d].map(Rational::from);
        let [least, most] = extremes(products);
        encloses(&(&x * &y), [&least, &most], &of("*"));
        if c > 0 || d < 0 {
            let [least, most] = extremes([&a / &c, &a / &d, &b / &c, &b / &d].map(Rational::from));
            encloses(&(&x / &y), [&least, &most], &of("/"));
        } else {
            assert!(!(&x / &y).is_defined(), "{}", of("/"));
        }
        let both = [&a, &b].map(|end| Rational::from(end.abs_ref()));
        let nearest = if a < 0 && b > 0 { Rational::new() } else { both.iter().min().unwrap().clone() };
        let farthest = both.into_iter().max().unwrap();
        assert_eq!(ends(&x.abs()), [nearest.clone(), farthest.clone()], "{}", of("abs"));
        encloses(&x.sqr(), [&nearest.square(), &farthest.square()], &of("sqr"));
        // Exactly one of the ends.
        for (found, expected) in [
            (x.hull(&y), [(&a).min(&c), (&b).max(&d)]),
            (x.min(&y), [(&a).min(&c), (&b).min(&d)]),
            (x.max(&y), [(&a).max(&c), (&b).max(&d)]),
            (x.floor(), [&a, &a]),
            (x.ceiling(), [&b, &b]),
        ] {
            assert_eq!(ends(&found).each_ref(), expected, "{}", of("ends"));
        }
        let common = x.intersect(&y);
        assert_eq!(common.is_defined(), (&a).max(&c) <= (&b).min(&d), "{}", of("intersect"));
        if common.is_defined() {
            assert_eq!(ends(&common).each_ref(), [(&a).max(&c), (&b).min(&d)], "{}", of("intersect"));
        }
        assert_eq!((x.lt(&y) == Some(true), x.lt(&y) == Some(false)), (b < c, a >= d), "{}", of("<"));
        assert_eq!((x.is_positive(), x.is_nonnegative(), x.is_nonpositive()), (a > 0, a >= 0, b <= 0), "{x:?}");
        assert_eq!((x.is_zero(), x.is_point()), (a == 0 && b == 0, a == b), "{x:?}");
        let (middle, half) = (x.middle(), x.half_width().upper().unwrap());
        let [at, _] = ends(&middle);
        assert!(
            middle.is_point()
                && a <= at
                && at <= b
                && Rational::from(&at - &a) <= half
                && Rational::from(&b - &at) <= half
        );
    }
}

#[test]
fn roots_and_powers_enclose_the_exact_results() {
    let mut drawn = Drawn(20_261_128);
    for case in 0..20_000 {
        let x = drawn.interval();
        let [a, b] = ends(&x);
        let root = x.sqrt();
        assert_eq!(root.is_defined(), a >= 0, "{case}: {x:?}");
        if root.is_defined() {
            let [lo, hi] = ends(&root);
            let tight = |end: &Rational, true_square: &Rational| {
                let off = Rational::from(end.square_ref()) - true_square;
                off.abs() <= Rational::from(true_square / &Rational::from(1_u64 << 50))
            };
            assert!(Rational::from(lo.square_ref()) <= a && b <= Rational::from(hi.square_ref()), "{case}: {x:?}");
            assert!(lo >= 0 && tight(&lo, &a) && tight(&hi, &b), "{case}: {x:?}");
        }
        for n in [1, 2, 3, 4, 7, 8, 9, -1, -3] {
            let power = x.powi(n);
            if n < 0 && a <= 0 && b >= 0 {
                assert!(!power.is_defined(), "{case}: {x:?} ^ {n}");
                continue;
            }
            let at = |end: &Rational| Rational::from(end.pow(n));
            let mut all = vec![at(&a), at(&b)];
            if n > 0 && n % 2 == 0 && a <= 0 && b >= 0 {
                all.push(Rational::new());
            }
            let (least, most) = (all.iter().min().unwrap(), all.iter().max().unwrap());
            let [lo, hi] = ends(&power);
            assert!(lo <= *least && *most <= hi, "{case}: {x:?} ^ {n} = {power:?}");
            let near = |end: &Rational, value: &Rational| {
                Rational::from(end - value).abs() <= Rational::from(value.abs_ref()) / Rational::from(1_u64 << 48)
            };
            assert!(near(&lo, least) && near(&hi, most), "{case}: {x:?} ^ {n} = {power:?}");
        }
    }
}
