//! The recurrences of Taylor series over enclosures. A series is its coefficients of 1, d, d^2, ..., at least one; those that
//! are not there are 0. With `v = phi(u)` each follows from a differential equation that phi satisfies; the sums are those of
//! Moore (1966) and of Griewank and Walther, Evaluating Derivatives, table 13.2.
//!
//! Guarantee: the coefficients contain those of the result for every choice of functions whose coefficients lie in those of
//! the operands. An operation outside of where it is smooth has an undefined first coefficient, and every later operation
//! on it as well.

use sigmastar_exact::enclosure::Enclosure;

type Series = Vec<Enclosure>;

/// Whether a series is a constant.
fn is_constant(a: &[Enclosure]) -> bool {
    a.len() <= 1
}

/// The coefficients `i u_i` of d u'.
fn weights(u: &[Enclosure]) -> Series {
    u.iter().zip(0_i64..).map(|(u, i)| u * i).collect()
}

/// `sum_{i=1..k} w_i b_{k-i}` over what is there.
fn weighted(w: &[Enclosure], b: &[Enclosure], k: usize, precision: u32) -> Enclosure {
    let terms = (1..=k.min(w.len() - 1)).filter(|i| k - i < b.len());
    terms.fold(Enclosure::zero(precision), |sum, i| sum + &w[i] * &b[k - i])
}

/// `sum_{i=0..k} a_i b_{k-i}` over what is there.
fn product(a: &[Enclosure], b: &[Enclosure], k: usize, precision: u32) -> Enclosure {
    let first = k.saturating_sub(b.len() - 1);
    (first..=k.min(a.len() - 1)).fold(Enclosure::zero(precision), |sum, i| sum + &a[i] * &b[k - i])
}

fn precision(a: &[Enclosure]) -> u32 {
    a[0].precision()
}

/// a + sign b.
pub(super) fn combine(a: &[Enclosure], b: &[Enclosure], sign: i64) -> Series {
    let term = |i: usize| match (a.get(i), b.get(i)) {
        (Some(a), Some(b)) if sign < 0 => a - b,
        (Some(a), Some(b)) => a + b,
        (Some(a), None) => a.clone(),
        (None, Some(b)) if sign < 0 => b.negate(),
        (None, Some(b)) => b.clone(),
        (None, None) => Enclosure::zero(precision(a)),
    };
    (0..a.len().max(b.len())).map(term).collect()
}

/// The product.
pub(super) fn mul(a: &[Enclosure], b: &[Enclosure], order: usize) -> Series {
    let precision = precision(a).max(precision(b));
    (0..(a.len() + b.len() - 1).min(order + 1)).map(|k| product(a, b, k, precision)).collect()
}

/// The quotient: `b v = a`.
pub(super) fn div(a: &[Enclosure], b: &[Enclosure], order: usize) -> Series {
    let precision = precision(a).max(precision(b));
    let mut v: Series = Vec::with_capacity(order + 1);
    let length = if is_constant(b) { a.len() } else { order + 1 };
    for k in 0..length {
        let own = a.get(k).cloned().unwrap_or_else(|| Enclosure::zero(precision));
        let known = (1..=k.min(b.len() - 1)).fold(own, |rest, i| rest - &b[i] * &v[k - i]);
        v.push(known / &b[0]);
    }
    v
}

/// The square root of what is positive: `v^2 = u`.
pub(super) fn sqrt(u: &[Enclosure], order: usize) -> Series {
    let root = if u[0].is_positive().is_true() { u[0].sqrt() } else { Enclosure::undefined(precision(u)) };
    let mut v = vec![root];
    for k in 1..length(u, order) {
        let own = u.get(k).cloned().unwrap_or_else(|| Enclosure::zero(precision(u)));
        let known = (1..k).fold(own, |rest, i| rest - &v[i] * &v[k - i]);
        let next = known / (&v[0] * 2);
        v.push(next);
    }
    v
}

/// How many coefficients a function of a series has.
fn length(u: &[Enclosure], order: usize) -> usize {
    if is_constant(u) { 1 } else { order + 1 }
}

/// The exponential: `v' = u' v`.
pub(super) fn exp(u: &[Enclosure], order: usize) -> Series {
    let mut v = vec![u[0].exp()];
    let w = weights(u);
    for k in 1..length(u, order) {
        let next = weighted(&w, &v, k, precision(u)) / k as i64;
        v.push(next);
    }
    v
}

/// The logarithm of what is positive: `u v' = u'`.
pub(super) fn log(u: &[Enclosure], order: usize) -> Series {
    over(u, u, u[0].log(), order)
}

/// The function with `w v' = u'` and this value.
fn over(u: &[Enclosure], w: &[Enclosure], value: Enclosure, order: usize) -> Series {
    let mut v = vec![value];
    for k in 1..length(u, order) {
        let own = u.get(k).map_or_else(|| Enclosure::zero(precision(u)), |own| own * k as i64);
        let known = (1..k).filter(|i| k - i < w.len()).fold(own, |rest, i| rest - &v[i] * &w[k - i] * i as i64);
        let next = known / k as i64 / &w[0];
        v.push(next);
    }
    v
}

/// Sine and cosine: `s' = u' c`, `c' = -u' s`.
pub(super) fn sin_cos(u: &[Enclosure], order: usize) -> [Series; 2] {
    let [mut cos, mut sin] = u[0].cos_sin().map(|value| vec![value]);
    let w = weights(u);
    for k in 1..length(u, order) {
        let next = [weighted(&w, &cos, k, precision(u)), weighted(&w, &sin, k, precision(u)).negate()];
        let [s, c] = next.map(|sum| sum / k as i64);
        sin.push(s);
        cos.push(c);
    }
    [sin, cos]
}

/// The tangent (`sign` 1) or the hyperbolic tangent (-1): `v' = u' w` with `w = 1 + sign v^2`.
pub(super) fn tangent(u: &[Enclosure], order: usize, sign: i64) -> Series {
    let value = if sign > 0 { u[0].tan() } else { u[0].tanh() };
    let own = weights(u);
    let mut w = vec![1 + value.sqr() * sign];
    let mut v = vec![value];
    for k in 1..length(u, order) {
        let next = weighted(&own, &w, k, precision(u)) / k as i64;
        v.push(next);
        w.push(product(&v, &v, k, precision(u)) * sign);
    }
    v
}

/// The arc tangent: `w v' = u'` with `w = 1 + u^2`.
pub(super) fn atan(u: &[Enclosure], order: usize) -> Series {
    let mut w = mul(u, u, order);
    w[0] = 1 + u[0].sqr();
    over(u, &w, u[0].atan(), order)
}

/// A function of u by its Taylor coefficients c at u_0: the powers of `u - u_0` begin with as many zeros.
fn composed(c: &[Enclosure], u: &[Enclosure], order: usize) -> Series {
    let Some((last, others)) = c.split_last() else { return vec![Enclosure::undefined(precision(u))] };
    let change = &u[1..];
    others.iter().rev().enumerate().fold(vec![last.clone()], |inner, (i, c)| {
        // Of the inner factor no more is needed than leaves room for the powers that it is yet to be multiplied with.
        let length = (inner.len() + change.len() - 1).min(i + 1).min(order);
        let shifted = (0..length).map(|k| product(&inner, change, k, precision(u)));
        std::iter::once(c.clone()).chain(shifted).collect()
    })
}

/// The derivative of order m of `x/(e^x - 1) = 1/E_0(x)`: the reciprocal of the series of E_0 at u_0, which has no singularity.
pub(super) fn exprelr(u: &[Enclosure], m: u32, order: usize) -> Series {
    let value = u[0].exprelr(m);
    if is_constant(u) {
        return vec![value];
    }
    let last = m as usize + order;
    let mut factorials = vec![Enclosure::one(precision(u))];
    for k in 1..=last {
        factorials.push(&factorials[k - 1] * k as i64);
    }
    let series: Series = u[0].exprel_derivatives(last).iter().zip(&factorials).map(|(e, k)| e / k).collect();
    let reciprocal = div(&factorials[..1], &series, last);
    let mut c: Series =
        (0..=order).map(|j| &reciprocal[m as usize + j] * &factorials[m as usize + j] / &factorials[j]).collect();
    c[0] = value;
    composed(&c, u, order)
}

/// The derivative of order m of `sin(x)/x`.
pub(super) fn sinc(u: &[Enclosure], m: u32, order: usize) -> Series {
    if is_constant(u) {
        return vec![u[0].sinc(m)];
    }
    let derivatives = u[0].sinc_derivatives(m as usize + order);
    let mut factorial = Enclosure::one(precision(u));
    let mut c = Series::with_capacity(order + 1);
    for (j, derivative) in derivatives[m as usize..].iter().enumerate() {
        factorial = factorial * (j as i64).max(1);
        c.push(derivative / &factorial);
    }
    composed(&c, u, order)
}

/// The power with an integer exponent, by repeated squaring; `u^0 = 1` where u is defined.
pub(super) fn power(u: &[Enclosure], exponent: i32, order: usize) -> Series {
    let precision = precision(u);
    let one = vec![Enclosure::one(precision)];
    if exponent < 0 {
        // 1/u^|n|; the magnitude of an exponent is at most MAX_EXPONENT.
        return div(&one, &power(u, exponent.saturating_neg(), order), order);
    }
    if exponent == 0 {
        let defined = u.iter().all(Enclosure::is_defined);
        return if defined { one } else { vec![Enclosure::undefined(precision)] };
    }
    let (mut result, mut square, mut rest): (Option<Series>, Series, i32) = (None, u.to_vec(), exponent);
    while rest > 0 {
        if rest & 1 == 1 {
            result = Some(match result {
                None => square.clone(),
                Some(known) => mul(&known, &square, order),
            });
        }
        rest >>= 1;
        if rest > 0 {
            square = mul(&square, &square, order);
        }
    }
    let mut result = result.unwrap_or(one);
    // The value itself without the dependency of its factors on each other.
    result[0] = u[0].pow_integer(&exponent.into());
    result
}
