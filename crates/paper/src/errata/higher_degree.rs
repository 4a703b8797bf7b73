//! E14: relative degree above one, the order of the coefficients.

use super::evidence::Evidence;
use super::evidence::Relation::{Equal, Greater, Less};
use super::numbers::{PRECISION, integer, ratio};
use super::{Bearing, Class, Erratum, ForData, Side};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::relative_degree::{is_hurwitz, printed_polynomial};

/// `det(s I - A)` of the companion matrix with last row `(-a_1, -a_2, -a_3)`, by expansion along the first column.
fn companion_characteristic(a: &[i64; 3], s: i64) -> i64 {
    // [[s, -1, 0], [0, s, -1], [a_1, a_2, s + a_3]]
    s * (s * (s + a[2]) + a[1]) + a[0]
}

/// `s^3 + s^2 + s + 10`.
fn cubic(s: &Rational) -> Rational {
    let mut value = Rational::from(s + 1u32);
    value *= s;
    value += 1u32;
    value *= s;
    value + 10u32
}

/// The real zero of [`cubic`] by bisection with exact signs: the cubic is negative at -2.4 and positive at -2.3.
fn real_zero() -> Enclosure {
    let (mut low, mut high) = (ratio(-24, 10), ratio(-23, 10));
    if cubic(&low) >= 0 || cubic(&high) <= 0 {
        return Enclosure::undefined(PRECISION);
    }
    for _ in 0..64 {
        let middle = Rational::from(&low + &high) / 2u32;
        if cubic(&middle) < 0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    Enclosure::between(&low, &high, PRECISION)
}

/// E14.
pub(super) fn e14(data: Option<&Data<'_>>) -> Erratum {
    let a = [10, 1, 1];
    let zero = real_zero();
    // s^3 + s^2 + s + 10 = (s - r)(s^2 + (1+r) s + (1 + r + r^2)).
    let half = (1 + &zero) / 2;
    let real = -&half;
    let imaginary = (1 + &zero + zero.sqr() - half.sqr()).sqrt();
    let evidence = vec![
        Evidence::rigorous(
            "$`a = (10, 1, 1)`$, the printed $`s^3 + 10 s^2 + s + 1`$: Hurwitz by Routh's criterion, $`a_1 a_2 > a_3`$ with $`a_i > 0`$",
            (a[0] * a[1], Greater, a[2]),
        ),
        Evidence::rigorous(
            "the companion matrix printed beside it has the characteristic polynomial $`s^3 + a_3 s^2 + a_2 s + a_1`$: $`det(2 I - A)`$",
            (companion_characteristic(&a, 2), Equal, Rational::from(8 + a[2] * 4 + a[1] * 2 + a[0])),
        ),
        Evidence::rigorous(
            "$`s^3 + s^2 + s + 10`$ is not Hurwitz: $`a_3 a_2`$ against $`a_1`$",
            (a[2] * a[1], Less, a[0]),
        ),
        Evidence::rigorous("it has the real zero r (signs at rationals)", (zero, Less, 0)),
        Evidence::rigorous("and a pair of zeros with the real part $`-(1+r)/2`$", (real, Greater, 0)),
        Evidence::rigorous(
            "and the imaginary part $`sqrt(1 + r + r^2 - (1+r)^2/4)`$",
            (imaginary, Greater, integer(0)),
        ),
    ];
    Erratum {
        id: "E14",
        place: "P:sec:higher_degree",
        class: Class::A,
        printed: "$`s^(r-1) + a_1 s^(r-2) + ... + a_(r-1)`$ is Hurwitz, and the same order in the equation of $`xi_1^(r)`$",
        instead: "$`s^(r-1) + a_(r-1) s^(r-2) + ... + a_1`$, the polynomial of the companion matrix printed beside it",
        evidence,
        for_data: data.map(for_data),
    }
}

fn for_data(data: &Data<'_>) -> ForData {
    let Some(filter) = &data.spec.relative_degree else {
        return ForData::new(Bearing::Harmless, "the specification has relative degree one");
    };
    let rationals: Option<Vec<Rational>> = filter.a.iter().map(|constant| constant.as_rational().cloned()).collect();
    let Some(a) = rationals else {
        return ForData::new(Bearing::Depends, "the coefficients are not all rational");
    };
    let (bearing, summary) = match (printed_polynomial(&a).is_ok(), is_hurwitz(&a)) {
        (true, false) => (Bearing::Bites, "the printed order accepts the coefficients, but the dynamics are unstable"),
        (false, true) => (Bearing::Bites, "the printed order refuses the coefficients, but the dynamics are stable"),
        (true, true) => (Bearing::Harmless, "the coefficients are Hurwitz in both orders"),
        (false, false) => (Bearing::Harmless, "the coefficients are Hurwitz in neither order"),
    };
    a.into_iter().enumerate().fold(ForData::new(bearing, summary), |for_data, (index, value)| {
        for_data.figure(format!("$`a_{}`$", index + 1), Side::Exact(value))
    })
}
