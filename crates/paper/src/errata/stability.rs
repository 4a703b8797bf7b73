//! E3 and E4: the stability proof.

use super::evidence::Relation::{Equal, Greater, GreaterOrEqual, Less, LessOrEqual};
use super::evidence::{Evidence, Side};
use super::numbers::{binomial, integer, power, ratio, rational, root};
use super::{Bearing, Class, Erratum, ForData, vanishes};
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_theory::data::{Bound, Data};

/// The exponent k of the smooth square wave psi(t) = p(sin 2 pi t), p(s) = C int_0^s (1-u^2)^k du, p(1) = 1.
const FLATNESS: u32 = 19;

/// The coefficients of s, s^3, s^5, ... in p. |p| <= 1 on [-1, 1], because p is odd and increasing there and p(1) = 1.
fn flat_polynomial() -> Vec<Rational> {
    let integral: Vec<Rational> = (0..=FLATNESS)
        .map(|j| {
            let term = binomial(FLATNESS, j) / (2 * j + 1);
            if j % 2 == 0 { term } else { -term }
        })
        .collect();
    let at_one = sum(&integral);
    integral.into_iter().map(|term| term / &at_one).collect()
}

fn sum(terms: &[Rational]) -> Rational {
    terms.iter().fold(Rational::new(), |sum, term| sum + term)
}

/// The mean over a period of p(sin)^2, from the means `binomial(2j, j)/4^j` of sin^(2j).
fn mean_of_square(polynomial: &[Rational]) -> Rational {
    let mut mean = Rational::new();
    for (i, a) in (0u32..).zip(polynomial) {
        for (j, b) in (0u32..).zip(polynomial) {
            let half = i + j + 1;
            mean += Rational::from(a * b) * binomial(2 * half, half) / power(&Rational::from(4), half);
        }
    }
    mean
}

/// E3: the first bracket of rho_0 lacks the factor 2 P_low.
pub(super) fn e3(data: Option<&Data<'_>>) -> Erratum {
    let (p, alpha) = (Rational::from(2), Rational::from(1));
    // k e_a, with b_fex = k and |phi| <= 1.
    let product = ratio(4, 3);
    let printed_rho = &p / Rational::from(&p * 2) * &product;
    let true_rho = Rational::from(&p * &product);
    let allowed = Rational::from(&alpha * &p) / 3u32;
    let polynomial = flat_polynomial();
    let mean = mean_of_square(&polynomial);
    let exponent = Rational::from(&product * &mean) - &alpha;
    let evidence = vec![
        Evidence::rigorous(
            "$`n = 1`$, $`f = -x + k phi(t) x e`$, $`P = 2`$, $`alpha = 1`$, $`k e_a = 4/3`$, $`|phi| <= 1`$: the Lyapunov inequality $`2 P F <= \
             -2 alpha P`$",
            (Rational::from(&p * -2), LessOrEqual, Rational::from(&p * -2) * &alpha),
        ),
        Evidence::rigorous(
            "the printed $`rho_0 = P/(2 P) k e_a`$ passes its test $`rho_0 <= alpha P_low/3`$",
            (printed_rho, LessOrEqual, allowed.clone()),
        ),
        Evidence::rigorous(
            "$`phi(t) = psi(t) = p(sin(2 pi t))`$, $`p(s) = C int_0^s (1-u^2)^19 du`$, is odd and increasing in s, so \
             $`|phi| <= 1`$: $`p(1)`$",
            (sum(&polynomial), Equal, 1),
        ),
        Evidence::rigorous("the mean of $`psi^2`$", (mean, Greater, ratio(3, 4))),
        Evidence::rigorous(
            "with $`x_p = 0`$ and $`e_p = e_a psi(t)`$ (zero mean: for $`n_o = 0`$, or without resonance, the periodic solution \
             for a suitable $`q(t)`$) the zero dynamics are $`x' = (-1 + (4/3) psi^2) x`$; their Floquet exponent",
            (exponent, Greater, 0),
        ),
        Evidence::rigorous("with the factor $`P_up`$ the test refuses: $`P_up k e_a`$", (true_rho, Greater, allowed)),
    ];
    let for_data = data.map(|data| {
        let too_small_by = 2 * &data.p_low;
        let exact = data
            .spec
            .lyapunov
            .triple()
            .and_then(|triple| triple.p_low.as_rational())
            .map(|p_low| Side::Exact(Rational::from(p_low * 2u32)));
        let (bearing, summary) = if vanishes(data, Bound::Fxx) && vanishes(data, Bound::Fex) {
            (Bearing::Harmless, "$`b_fxx = b_fex = 0`$, so $`rho_0 = 0`$ either way")
        } else {
            match too_small_by.gt(&integer(1)) {
                Truth::True => (
                    Bearing::Bites,
                    "the first bracket of the printed $`rho_0`$ is too small by the factor $`2 P_low`$",
                ),
                Truth::False => (Bearing::Harmless, "$`2 P_low <= 1`$, so the printed bracket is not too small"),
                Truth::Undecided => (Bearing::Depends, "$`2 P_low`$ is too close to 1 to tell"),
            }
        };
        ForData::new(bearing, summary).figure("$`2 P_low`$", exact.unwrap_or(Side::Enclosed(too_small_by)))
    });
    Erratum {
        id: "E3",
        place: "P:eq:def_rho_0",
        class: Class::A,
        printed: "$`rho_0 = (P_up/(2 P_low)) [b_fxx x_a + b_fex e_a + P_low b_fxx(x_b,e_a) (x_b + x_a)]`$",
        instead: "the first two terms need the factor $`P_up`$, which is $`2 P_low`$ times larger ($`2 x'P dF x <= 2 P_up |dF| \
                  |x|^2`$); only the third term is right",
        evidence,
        for_data,
    }
}

/// The quadratic forms of a symmetric 2x2 matrix that are to be nonnegative: its diagonal and its determinant.
fn is_nonnegative(matrix: [[i64; 2]; 2]) -> [i64; 3] {
    [matrix[0][0], matrix[1][1], matrix[0][0] * matrix[1][1] - matrix[0][1] * matrix[1][0]]
}

/// `4 X^2 (101 e^-2 - 1)`: by how much the linear flow takes |x|^2 from 4 X^2, at (0, 2 X), in one unit of time.
fn growth(x: &Rational) -> Enclosure {
    4 * rational(x).sqr() * (101 * integer(-2).exp() - 1)
}

/// An upper bound of the time to infinity of y' >= 4 y (5 (y - 4X^2)^3 - 3) from y = 4 X^2 + d with 5 d^3 > 3:
/// y' >= 4 y(0) (5 - 3/d^3) (y - 4X^2)^3, so at most `1/(8 y(0) (5 - 3/d^3) d^2)`.
fn time_to_infinity(x: &Rational) -> Enclosure {
    let d = growth(x);
    let start = 4 * rational(x).sqr() + &d;
    (8 * start * (5 - 3 / (d.sqr() * &d)) * d.sqr()).recip()
}

/// E4: the families are needed on a larger set than printed.
pub(super) fn e4(data: Option<&Data<'_>>) -> Erratum {
    // P = diag(1, 100), F = [[-1, 10], [0, -1]], 2 alpha = 1: -(P F + F'P + P).
    let (p, f) = ([1, 100], [[-1, 10], [0, -1]]);
    let lyapunov = [
        [-(2 * p[0] * f[0][0] + p[0]), -(p[0] * f[0][1] + p[1] * f[1][0])],
        [-(p[0] * f[0][1] + p[1] * f[1][0]), -(2 * p[1] * f[1][1] + p[1])],
    ];
    // F + F' + 12 I: nonnegative means x'F x >= -6 |x|^2.
    let shifted = [[2 * f[0][0] + 12, f[0][1] + f[1][0]], [f[0][1] + f[1][0], 2 * f[1][1] + 12]];
    let mut evidence = Vec::new();
    for (what, matrix) in [
        ("$`P = diag(1,100)`$, $`alpha = 1/2`$, $`F = [[-1,10],[0,-1]]`$: $`-(P F + F'P + 2 alpha P) >= 0`$", lyapunov),
        ("$`x'F x >= -6 |x|^2`$: $`F + F' + 12 I >= 0`$", shifted),
    ] {
        let parts = ["first diagonal entry", "second diagonal entry", "determinant"];
        evidence.extend(
            parts
                .iter()
                .zip(is_nonnegative(matrix))
                .map(|(part, value)| Evidence::rigorous(format!("{what}, {part}"), (value, GreaterOrEqual, 0))),
        );
    }
    for (name, x) in [("0.2", ratio(1, 5)), ("1", ratio(1, 1))] {
        let d = growth(&x);
        evidence.push(Evidence::rigorous(
            format!(
                "$`X = {name}`$: the nonlinear term is radial, so the angle is that of $`exp(F t) = e^-t [[1,10t],[0,1]]`$ and $`|x|`$ is at \
                 least that of the linear flow; from $`(0, 2X)`$ at $`t = 1`$ $`|x|^2 - 4X^2 >= d = 4X^2 (101 e^-2 - 1)`$; $`5 d^3`$ \
                 (increasing in $`X`$)"
            ), (5 * (d.sqr() * &d), Greater, 3)));
        evidence.push(Evidence::rigorous(
            format!(
                "$`X = {name}`$: from there $`(|x|^2)' >= 4 |x|^2 (5 (|x|^2 - 4X^2)^3 - 3)`$, so the solution is gone after a \
                 further time of at most"
            ),
            (time_to_infinity(&x), Less, ratio(1, 100)),
        ));
    }
    Erratum {
        id: "E4",
        place: "P:thm1, P:thm2: the families on (2x, 2e)",
        class: Class::A,
        printed: "$`f`$ in $`F(2x, 2e)`$, $`q`$ in $`Q(2x, 2e)`$",
        instead: "the bounds are needed on $`(x_b, e_b)`$, and at every smaller argument: $`f = F x + 10 ((|x|^2 - 4X^2)_+)^3 x`$ is \
                  linear on $`|x| <= 2X`$, yet for every $`X >= 0.2`$ a solution from $`|x| = 2X`$ escapes in finite time",
        evidence,
        for_data: data.map(for_data_e4),
    }
}

fn for_data_e4(data: &Data<'_>) -> ForData {
    let factor = 3 * root(2) * &data.c + 2;
    let for_data = ForData::new(
        Bearing::Bites,
        "the proof uses the bounding functions at $`x_b`$ and $`6 e_a`$, not at $`2 x_a`$ and $`2 e_a`$; the domain of a certificate covers \
         what it uses",
    );
    let largest = data.spec.domain.as_ref().map(|domain| domain.x.enclose(data.precision) / &factor);
    let for_data =
        for_data.figure("$`x_b/x_a`$ (2 is printed)", factor).figure("$`e_b/e_a`$ (2 is printed)", Side::from(6));
    match largest {
        Some(largest) => for_data.figure("largest $`x_a`$ with $`x_b`$ in the domain", largest),
        None => for_data,
    }
}
