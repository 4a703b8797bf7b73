//! Operations on intervals, of the producer and of the checker, against single operations of MPFR at 400 bits that are rounded
//! both ways: 0, ends near multiples of pi/2, huge, tiny and infinite ends, points.

use super::{any, random};
use crate::support::cases;
use proofs_check::interval::Interval;
use rand::RngExt;
use rand::rngs::StdRng;
use rug::float::{Constant, Round, Special};
use rug::ops::Pow;
use rug::{Float, Integer};
use sigmastar_exact::enclosure::Enclosure;

/// Bits of the reference values.
const REFERENCE: u32 = 400;

/// Bits of the numbers that ends are made of.
const BITS: u32 = 40;

/// Points in each operand.
const MEMBERS: usize = 6;

/// The operations of [`ONE`] and [`TWO`] by their places there.
trait Operations {
    fn one(&self, operation: usize) -> Self;
    fn two(&self, other: &Self, operation: usize) -> Self;
}

/// What the two programs' intervals have in common.
trait Arithmetic: Operations + Clone + std::fmt::Debug {
    fn new(lower: Float, upper: Float) -> Self;
    fn ends(&self) -> [Float; 2];
    fn power(&self, exponent: i32) -> Self;
    /// Whether it is certainly less, and less or equal.
    fn compare(&self, other: &Self) -> [Option<bool>; 2];
}

type Value = Option<Float>;
type One = fn(&Float, Round) -> Value;
type Two = fn(&Float, &Float, Round) -> Value;

fn rounded<T>(value: T, round: Round) -> Value
where
    Float: rug::ops::AssignRound<T, Round = Round, Ordering = std::cmp::Ordering>,
{
    Some(Float::with_val_round(REFERENCE, value, round).0)
}

fn within<T>(domain: bool, value: T, round: Round) -> Value
where
    Float: rug::ops::AssignRound<T, Round = Round, Ordering = std::cmp::Ordering>,
{
    domain.then(|| rounded(value, round)).flatten()
}

/// Functions of one argument in the order of [`Operations::one`]; `None` outside of the domain.
const ONE: [(&str, One); 22] = [
    ("neg", |x, r| rounded(-x, r)),
    ("abs", |x, r| rounded(x.abs_ref(), r)),
    ("recip", |x, r| within(!x.is_zero(), x.recip_ref(), r)),
    ("sqr", |x, r| rounded(x.square_ref(), r)),
    ("sqrt", |x, r| within(*x >= 0, x.sqrt_ref(), r)),
    ("exp", |x, r| rounded(x.exp_ref(), r)),
    ("log", |x, r| within(*x > 0, x.ln_ref(), r)),
    ("sin", |x, r| rounded(x.sin_ref(), r)),
    ("cos", |x, r| rounded(x.cos_ref(), r)),
    ("tan", |x, r| rounded(x.tan_ref(), r)),
    ("atan", |x, r| rounded(x.atan_ref(), r)),
    ("tanh", |x, r| rounded(x.tanh_ref(), r)),
    ("coth", |x, r| within(!x.is_zero(), x.coth_ref(), r)),
    ("to itself", |x, r| rounded(x, r)),
    ("exprelr, order 0", |x, r| rounded(exprelr(x, 0, r), r)),
    ("exprelr, order 1", |x, r| rounded(exprelr(x, 1, r), r)),
    ("exprelr, order 2", |x, r| rounded(exprelr(x, 2, r), r)),
    ("exprelr, order 3", |x, r| rounded(exprelr(x, 3, r), r)),
    ("sinc, order 0", |x, r| rounded(sinc(x, 0), r)),
    ("sinc, order 1", |x, r| rounded(sinc(x, 1), r)),
    ("sinc, order 2", |x, r| rounded(sinc(x, 2), r)),
    ("sinc, order 3", |x, r| rounded(sinc(x, 3), r)),
];

/// Bits at which the formulas with a division by x, to some power, keep far more than [`REFERENCE`] of them.
fn divided(x: &Float, order: usize) -> u32 {
    let zeros = x.get_exp().map_or(0, |exponent| (-exponent).max(0).unsigned_abs());
    2 * REFERENCE + 2 * zeros * (order as u32 + 1)
}

/// A derivative of x/(e^x - 1), from `(e^x - 1) b^(k) = x^(k) - sum over j of C(k, j) e^x b^(k-j)`; beyond the exponents of MPFR its limit,
/// moved to the side of the rounding.
fn exprelr(x: &Float, order: usize, round: Round) -> Float {
    let bits = divided(x, order);
    if x.is_zero() {
        return Float::with_val(bits, [12, -6, 2, 0][order]) / 12u32;
    }
    if x.clone().abs() > 1e8 {
        let limit = match order {
            0 if *x < 0 => Float::with_val(bits, -x),
            1 if *x < 0 => Float::with_val(bits, -1),
            _ => Float::new(bits),
        };
        let tiny = Float::with_val(bits, 1) >> 100_000_000u32;
        return if round == Round::Down { limit - tiny } else { limit + tiny };
    }
    let x = Float::with_val(bits, x);
    let (exp, less) = (x.clone().exp(), x.clone().exp_m1());
    let mut all: Vec<Float> = Vec::new();
    for k in 0..=order {
        let own = [x.clone(), Float::with_val(bits, 1)].into_iter().nth(k).unwrap_or_else(|| Float::new(bits));
        let mut binomial = 1;
        let rest = (1..=k).fold(own, |rest, j| {
            binomial = binomial * (k - j + 1) / j;
            rest - exp.clone() * &all[k - j] * binomial as u32
        });
        all.push(rest / &less);
    }
    all.swap_remove(order)
}

/// A derivative of sin(x)/x, from `x s^(k) = (sin x)^(k) - k s^(k-1)`.
fn sinc(x: &Float, order: usize) -> Float {
    let bits = divided(x, order);
    if x.is_zero() {
        return Float::with_val(bits, [3, 0, -1, 0][order]) / 3u32;
    }
    let (sin, cos) = Float::with_val(bits, x).sin_cos(Float::new(bits));
    let waves = [sin.clone(), cos.clone(), -sin, -cos];
    (1..=order).fold(waves[0].clone() / x, |before, k| (waves[k].clone() - before * k as u32) / x)
}

/// Operations on two in the order of [`Operations::two`].
const TWO: [(&str, Two); 9] = [
    ("+", |a, b, r| rounded(a + b, r)),
    ("-", |a, b, r| rounded(a - b, r)),
    ("*", |a, b, r| rounded(a * b, r)),
    ("/", |a, b, r| within(!b.is_zero(), a / b, r)),
    ("min", |a, b, r| rounded(if a < b { a } else { b }, r)),
    ("max", |a, b, r| rounded(if a > b { a } else { b }, r)),
    ("hull, left", |a, _, r| rounded(a, r)),
    ("hull, right", |_, b, r| rounded(b, r)),
    ("pow", |a, b, r| match *a > 0 {
        true => rounded(Pow::pow(a, b), r),
        false => (a.is_zero() && *b > 0).then(|| Float::new(REFERENCE)),
    }),
];

/// The operations of both programs have the same names.
macro_rules! operations {
    ($type:ty) => {
        impl Operations for $type {
            fn one(&self, operation: usize) -> $type {
                match ONE[operation].0 {
                    "neg" => -self,
                    "abs" => self.abs(),
                    "recip" => self.recip(),
                    "sqr" => self.sqr(),
                    "sqrt" => self.sqrt(),
                    "exp" => self.exp(),
                    "log" => self.log(),
                    "sin" => self.sin(),
                    "cos" => self.cos(),
                    "tan" => self.tan(),
                    "atan" => self.atan(),
                    "tanh" => self.tanh(),
                    "coth" => self.coth(),
                    "exprelr, order 0" => self.exprelr(0),
                    "exprelr, order 1" => self.exprelr(1),
                    "exprelr, order 2" => self.exprelr(2),
                    "exprelr, order 3" => self.exprelr(3),
                    "sinc, order 0" => self.sinc(0),
                    "sinc, order 1" => self.sinc(1),
                    "sinc, order 2" => self.sinc(2),
                    "sinc, order 3" => self.sinc(3),
                    _ => self.hull(self).intersect(self),
                }
            }

            fn two(&self, other: &$type, operation: usize) -> $type {
                match TWO[operation].0 {
                    "+" => self + other,
                    "-" => self - other,
                    "*" => self * other,
                    "/" => self / other,
                    "min" => self.min(other),
                    "max" => self.max(other),
                    "pow" => self.pow(other),
                    _ => self.hull(other),
                }
            }
        }
    };
}

operations!(Enclosure);
operations!(Interval);

impl Arithmetic for Enclosure {
    fn new(lower: Float, upper: Float) -> Enclosure {
        Enclosure::new(lower, upper)
    }

    fn ends(&self) -> [Float; 2] {
        [self.lower(), self.upper()]
    }

    fn power(&self, exponent: i32) -> Enclosure {
        self.pow_integer(&Integer::from(exponent))
    }

    fn compare(&self, other: &Enclosure) -> [Option<bool>; 2] {
        [self.lt(other), self.le(other)].map(|truth| match (truth.is_true(), truth.is_false()) {
            (false, false) => None,
            (certain, _) => Some(certain),
        })
    }
}

impl Arithmetic for Interval {
    fn new(lower: Float, upper: Float) -> Interval {
        Interval::new(lower, upper)
    }

    fn ends(&self) -> [Float; 2] {
        [self.lo().into_owned(), self.hi().into_owned()]
    }

    fn power(&self, exponent: i32) -> Interval {
        self.powi(exponent)
    }

    fn compare(&self, other: &Interval) -> [Option<bool>; 2] {
        [self.lt(other), self.le(other)]
    }
}

/// 0, whole numbers and halves, neighbours of multiples of pi/2, tiny and huge ones.
fn number(random: &mut StdRng) -> Float {
    let scaled = |random: &mut StdRng, low: i32, high: i32| {
        Float::with_val(BITS, random.random_range(-1_000_000_i64..1_000_000)) << random.random_range(low..high)
    };
    match random.random_range(0..16) {
        0 | 1 => Float::new(BITS),
        2 => Float::with_val(BITS, *any(random, &[1, -1])),
        3..=5 => Float::with_val(BITS, random.random_range(-12..13)) / 2u32,
        6..=9 => {
            let turns: i64 = match random.random_range(0..3) {
                0 => random.random_range(-1_000_000_000..1_000_000_000),
                _ => random.random_range(-9..10),
            };
            let mut x = Float::with_val(BITS, Constant::Pi) * turns / 2u32;
            match random.random_range(-1..2) {
                // The neighbours of 0 are the smallest numbers there are.
                _ if turns == 0 => x = Float::with_val(BITS, random.random_range(-1..2)) >> 1100u32,
                1 => x.next_up(),
                -1 => x.next_down(),
                _ => {}
            }
            x
        }
        10 | 11 => scaled(random, -1100, -20),
        12 => scaled(random, 0, 1100),
        _ => scaled(random, -24, -12),
    }
}

/// The same ends for both programs, each at a precision of its own, and points between them.
struct Sample {
    enclosure: Enclosure,
    interval: Interval,
    members: Vec<Float>,
}

fn sample(random: &mut StdRng) -> Sample {
    let infinite = |end| Float::with_val(BITS, end);
    let (a, b) = (number(random), number(random));
    let [a, b] = if a <= b { [a, b] } else { [b, a] };
    let [a, b] = match random.random_range(0..12) {
        0..=2 => [a.clone(), a],
        3 => [a, infinite(Special::Infinity)],
        4 => [infinite(Special::NegInfinity), b],
        5 => [infinite(Special::NegInfinity), infinite(Special::Infinity)],
        _ => [a, b],
    };
    // Two ends of 53 bits compute as doubles.
    let [p, q] = [0, 1].map(|_| *any(random, &[24, 53, 53, 53, 64, 128]));
    let lower = Float::with_val_round(p, &a, Round::Down).0;
    let upper = Float::with_val_round(q, &b, Round::Up).0;
    let quarter = Float::with_val(REFERENCE, Constant::Pi) / 2u32;
    let turns = Float::with_val(64, &lower / &quarter).ceil();
    let mut members = vec![a.clone(), b.clone(), Float::with_val(REFERENCE, &a + &b) / 2u32];
    members.extend([lower.clone(), upper.clone(), Float::new(BITS), quarter * turns]);
    members.extend((0..MEMBERS).map(|_| number(random)));
    members.retain(|x| x.is_finite() && *x >= lower && *x <= upper);
    let last = members.len() - 1;
    for i in 0..last {
        members.swap(i, random.random_range(i..=last));
    }
    members.truncate(MEMBERS);
    let interval = <Interval as Arithmetic>::new(lower.clone(), upper.clone());
    Sample { enclosure: <Enclosure as Arithmetic>::new(lower, upper), interval, members }
}

/// That a result is an interval, and holds the value at a point: undefined if there is none.
fn examine<A: Arithmetic>(found: &A, reference: impl Fn(Round) -> Value, what: impl Fn() -> String) {
    let [lower, upper] = found.ends();
    let defined = !(lower.is_nan() && upper.is_nan());
    let formed = lower <= upper && lower < f64::INFINITY && upper > f64::NEG_INFINITY;
    assert!(formed || !defined, "{} is {found:?}", what());
    match (reference(Round::Down), reference(Round::Up)) {
        (Some(down), Some(up)) => assert!(!defined || (lower <= up && upper >= down), "{} is {found:?}", what()),
        _ => assert!(!defined, "{} is {found:?}", what()),
    }
}

fn examine_all<A: Arithmetic>(case: u64, [a, b]: [&A; 2], [of_a, of_b]: [&[Float]; 2]) {
    for (index, (name, reference)) in ONE.iter().enumerate() {
        let found = a.one(index);
        for x in of_a {
            examine(&found, |round| reference(x, round), || format!("case {case}: {name} of {a:?} at {x}"));
        }
    }
    for exponent in [-3, -2, -1, 0, 1, 2, 3, 8] {
        let found = a.power(exponent);
        let reference = |x: &Float, round| match exponent {
            n if n < 0 && x.is_zero() => None,
            n => rounded(Pow::pow(x, n), round),
        };
        for x in of_a {
            examine(&found, |round| reference(x, round), || format!("case {case}: {a:?}^{exponent} at {x}"));
        }
    }
    for (index, (name, reference)) in TWO.iter().enumerate() {
        let found = a.two(b, index);
        for (x, y) in of_a.iter().flat_map(|x| of_b.iter().map(move |y| (x, y))) {
            examine(&found, |r| reference(x, y, r), || format!("case {case}: {a:?} {name} {b:?} at {x}, {y}"));
        }
    }
    let [less, at_most] = a.compare(b);
    for (x, y) in of_a.iter().flat_map(|x| of_b.iter().map(move |y| (x, y))) {
        let right = less.is_none_or(|less| less == (x < y)) && at_most.is_none_or(|at_most| at_most == (x <= y));
        assert!(right, "case {case}: {a:?} against {b:?}: {less:?}, {at_most:?} at {x}, {y}");
    }
}

/// Cases of an ordinary run.
const ORDINARY: u64 = 300;

#[test]
fn fuzz_intervals_of_both_programs() {
    examine_cases(cases(ORDINARY, 150_000));
}

#[test]
#[ignore = "search tier"]
fn more_intervals_of_both_programs() {
    examine_cases(ORDINARY..1500);
}

fn examine_cases(cases: std::ops::Range<u64>) {
    for case in cases {
        let random = &mut random(1, case);
        let (a, b) = (sample(random), sample(random));
        let members = [&a.members[..], &b.members[..]];
        examine_all(case, [&a.enclosure, &b.enclosure], members);
        examine_all(case, [&a.interval, &b.interval], members);
    }
}
