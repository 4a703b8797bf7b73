//! Intervals whose ends are doubles: what an interval is at 53 bits while its ends are 0 or of moderate size.
//!
//! A sum, a product, a quotient and a root of doubles are rounded to nearest (IEEE 754). What such a value is away from the exact one
//! has a sign that doubles give exactly (Knuth, Dekker), so the next double on that side is the other bound of the exact value. Nothing
//! here is so small that anything would be rounded to 0. Each operation gives `None` where an end leaves the range; MPFR computes it then.

#[cfg(all(target_arch = "x86", not(target_feature = "sse2")))]
compile_error!("intervals need doubles that are rounded to 53 bits: build with the target feature sse2");

/// The bits of a double.
pub const BITS: u32 = f64::MANTISSA_DIGITS;

/// The magnitudes of ends that are not 0. Products and quotients of two, and what these are away from the exact ones, are far from the
/// ends of the range of doubles.
const MAGNITUDES: std::ops::RangeInclusive<f64> = 1e-120..=1e120;

/// The lower and the upper end, in order, each 0 or of moderate size.
pub type Ends = [f64; 2];

/// These two as the ends of an interval. 0 has one sign.
pub fn ends(lo: f64, hi: f64) -> Option<Ends> {
    let fits = |x: f64| x == 0.0 || MAGNITUDES.contains(&x.abs());
    (lo <= hi && fits(lo) && fits(hi)).then_some([lo + 0.0, hi + 0.0])
}

/// A value rounded to nearest, and what has to be added to it to have the exact one: by its sign.
#[derive(Clone, Copy)]
struct Nearest {
    value: f64,
    rest: f64,
}

impl Nearest {
    fn down(self) -> f64 {
        if self.rest < 0.0 { self.value.next_down() } else { self.value }
    }

    fn up(self) -> f64 {
        if self.rest > 0.0 { self.value.next_up() } else { self.value }
    }
}

/// `a + b` (Knuth).
fn add(a: f64, b: f64) -> Nearest {
    let value = a + b;
    let of_b = value - a;
    Nearest { value, rest: (a - (value - of_b)) + (b - of_b) }
}

/// `a b` (Dekker).
fn multiply(a: f64, b: f64) -> Nearest {
    // The upper 26 bits of a number, and the rest of it.
    let parts = |x: f64| {
        let scaled = 134_217_729.0 * x;
        let upper = scaled - (scaled - x);
        [upper, x - upper]
    };
    let (value, [a, low_a], [b, low_b]) = (a * b, parts(a), parts(b));
    Nearest { value, rest: (((a * b - value) + a * low_b) + low_a * b) + low_a * low_b }
}

/// `a - b`, for a product that is nearly a: a double.
fn missing(a: f64, Nearest { value, rest }: Nearest) -> f64 {
    (a - value) - rest
}

/// `a/b`; what is missing is `(a - value b)/b`.
fn divide(a: f64, b: f64) -> Nearest {
    let value = a / b;
    Nearest { value, rest: missing(a, multiply(value, b)) * b.signum() }
}

/// From the least to the greatest of what an operation, which rounding does not put out of order, gives for these pairs.
fn extremes(pairs: [[f64; 2]; 4], operation: fn(f64, f64) -> Nearest) -> Option<Ends> {
    let all = pairs.map(|[x, y]| operation(x, y));
    ends(
        all.iter().fold(f64::INFINITY, |least, one| least.min(one.down())),
        all.iter().fold(f64::NEG_INFINITY, |most, one| most.max(one.up())),
    )
}

pub fn opposite([lo, hi]: Ends) -> Ends {
    [0.0 - hi, 0.0 - lo]
}

pub fn sum([a, b]: Ends, [c, d]: Ends) -> Option<Ends> {
    ends(add(a, c).down(), add(b, d).up())
}

/// The extremes are at the ends: at which ones, the signs say, unless there are both in each.
pub fn product([a, b]: Ends, [c, d]: Ends) -> Option<Ends> {
    let [low, high] = match ([a >= 0.0, b <= 0.0], [c >= 0.0, d <= 0.0]) {
        ([true, _], [true, _]) => [[a, c], [b, d]],
        ([true, _], [_, true]) => [[b, c], [a, d]],
        ([true, _], _) => [[b, c], [b, d]],
        ([_, true], [true, _]) => [[a, d], [b, c]],
        ([_, true], [_, true]) => [[b, d], [a, c]],
        ([_, true], _) => [[a, d], [a, c]],
        (_, [true, _]) => [[a, d], [b, d]],
        (_, [_, true]) => [[b, c], [a, c]],
        _ => return extremes([[a, c], [a, d], [b, c], [b, d]], multiply),
    };
    ends(multiply(low[0], low[1]).down(), multiply(high[0], high[1]).up())
}

/// `1 + 2^-30`.
const ABOVE: f64 = 1.0 + 1.0 / (1_u64 << 30) as f64;

/// The most products of a sum.
const MOST_PRODUCTS: usize = 1 << 20;

/// `sum of x y`: by numbers m in x and n in y, from which no number of x and y is farther than r and s, the widths. So the sum of the m n is away from
/// the exact one by at most `sum of |m| s + r (|n| + s)`, and, with k products, as it is rounded by at most `k u/(1 - k u)` of `sum of |m n|`, u = 2^-53
/// (Higham); a sum of numbers that are not negative is rounded by no larger share of itself. `2 k u` and `1 + 2^-30` are above all that. Nothing here is
/// so small that it would not have all its bits: a sum or difference of ends that is not 0 is above 1e-137.
pub fn sum_of_products(pairs: impl Iterator<Item = Option<[Ends; 2]>>) -> Option<Ends> {
    // Halfway: rounding does not put it outside.
    let within = |[lo, hi]: Ends| [(lo + hi) / 2.0, hi - lo];
    let (mut sum, mut size, mut off, mut count) = (0.0, 0.0, 0.0, 0_usize);
    for pair in pairs {
        let [[m, r], [n, s]] = pair?.map(within);
        sum += m * n;
        size += (m * n).abs();
        off += m.abs() * s + r * (n.abs() + s);
        count += 1;
    }
    if count > MOST_PRODUCTS {
        return None;
    }
    let reach = (off + count as f64 * f64::EPSILON * size) * ABOVE;
    if reach == 0.0 { ends(sum, sum) } else { ends((sum - reach).next_down(), (sum + reach).next_up()) }
}

/// By what certainly is not 0; the extremes are at the ends.
pub fn quotient([a, b]: Ends, [c, d]: Ends) -> Option<Ends> {
    if c > 0.0 || d < 0.0 { extremes([[a, c], [a, d], [b, c], [b, d]], divide) } else { None }
}

/// x^n for n > 0 and an x that is not negative, or an odd n: it increases.
pub fn power([lo, hi]: Ends, n: i32) -> Option<Ends> {
    let at = |x: f64| (1..n).try_fold([x, x], |power, _| product(power, [x, x]));
    Some([at(lo)?[0], at(hi)?[1]])
}

/// Of what is not negative; what is missing has the sign of `a - value^2`.
pub fn root([lo, hi]: Ends) -> Option<Ends> {
    let root = |a: f64| {
        let value = a.sqrt();
        Nearest { value, rest: missing(a, multiply(value, value)) }
    };
    ends(root(lo).down(), root(hi).up())
}

#[cfg(test)]
mod tests {
    use super::*;
    use rug::Rational;

    /// Against exact sums, of the ends that make each product least and greatest.
    #[test]
    fn a_sum_of_products_contains_the_exact_ones() {
        let mut state = 1_u64;
        let mut drawn = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        for count in [0, 1, 2, 7, 120] {
            for wide in [0.0, 1e-16, 1e-3, 3.0] {
                let mut interval = |scale: f64| {
                    let [a, b] = [drawn() * scale, drawn().abs() * wide * scale];
                    [a, a + b]
                };
                let pairs: Vec<[Ends; 2]> =
                    (0..count).map(|k| [interval(1.0 / (1 + k) as f64), interval(1.0)]).collect();
                let [lo, hi] = sum_of_products(pairs.iter().copied().map(Some)).unwrap();
                let exact = |x: f64, y: f64| Rational::from_f64(x).unwrap() * Rational::from_f64(y).unwrap();
                let (mut least, mut most) = (Rational::new(), Rational::new());
                for [a, b] in &pairs {
                    let all = a.iter().flat_map(|x| b.iter().map(|y| exact(*x, *y)));
                    least += all.clone().min().unwrap();
                    most += all.max().unwrap();
                }
                assert!(Rational::from_f64(lo).unwrap() <= least && most <= Rational::from_f64(hi).unwrap());
                let width = Rational::from(&most - &least).to_f64();
                assert!(hi - lo <= 5.0 * width + 1e-13, "{count} {wide}: {} {width}", hi - lo);
            }
        }
        assert_eq!(sum_of_products([Some([[0.0; 2]; 2])].into_iter()), Some([0.0, 0.0]));
        assert_eq!(sum_of_products([Some([[1.0; 2]; 2]), None].into_iter()), None);
        // Half an ulp of a sum that is rounded is not lost.
        let [small, one] = [[1e-17; 2], [1.0; 2]];
        let [lo, hi] = sum_of_products([Some([one, one]), Some([small, one])].into_iter()).unwrap();
        assert!(lo <= 1.0 && hi > 1.0);
    }
}
