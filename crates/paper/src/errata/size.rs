//! E1 and E2: the size conditions of the two theorems.

use super::evidence::Evidence;
use super::evidence::Relation::{Equal, Greater, Less};
use super::numbers::{integer, quotient, ratio, rational, root};
use super::{Bearing, Class, Erratum, ForData};
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_theory::data::Data;

/// What the two parts of P:eq:boundx_bounde_1 multiply to, at c = sqrt(P_up/P_low): `3.5 (3 sqrt 2/c + 1/(2 c^2))`.
fn product(c: &Enclosure) -> Enclosure {
    quotient(7, 2) * (3 * root(2) / c + (2 * c.sqr()).recip())
}

/// E1: P:eq:boundx_bounde_1 has no solution.
pub(super) fn e1(data: Option<&Data<'_>>) -> Erratum {
    let half = ratio(1, 2);
    // (e_b - e_a)^2/2 with e_b = 6 e_a, less the 9 e_a^2 on the left.
    let left_of_e = Rational::from(&half * 25) - 9;
    // The coefficient of c^2 in (3 sqrt 2 c + 1)^2/2 is 9, that of c is 3 sqrt 2, the constant is 1/2.
    let square_of_c = Rational::from(&half * 18);
    let evidence = vec![
        Evidence::rigorous(
            "second member: $`9 P_up x_a^2 <= ((6-1)^2/2 - 9) e_a^2`$, with the factor",
            (left_of_e, Equal, ratio(7, 2)),
        ),
        Evidence::rigorous(
            "first member: $`P_low (3 sqrt(2) c + 1)^2/2 = 9 P_up + 3 sqrt(2) sqrt(P_up P_low) + P_low/2`$, so that \
             $`9 e_a^2 <= (3 sqrt(2) sqrt(P_up P_low) + P_low/2) x_a^2`$; the factor of $`P_low c^2 = P_up`$",
            (square_of_c, Equal, 9),
        ),
        Evidence::rigorous(
            "the two multiplied: $`81 <= 3.5 (3 sqrt(2)/c + 1/(2 c^2))`$; the right side decreases in $`c >= 1`$, and at $`c = 1`$ it is",
            (product(&integer(1)), Less, 81),
        ),
    ];
    Erratum {
        id: "E1",
        place: "P:eq:boundx_bounde_1 with P:eq:temp_bound_xe2",
        class: Class::A,
        printed: "$`9 P_up x_a^2 + 9 e_a^2 <= (1/2) min{P_low (x_b - x_a)^2, (e_b - e_a)^2}`$ with $`x_b = (3 sqrt(2) c + 2) x_a`$, \
                  $`e_b = 6 e_a`$; \"such $`x_a, e_a > 0`$ always exist\"",
        instead: "no $`x_a, e_a > 0`$ satisfy it, for any $`P_up >= P_low`$; free radii of the error box (C4) replace the \
                  fixed multiples",
        evidence,
        for_data: data.map(|data| {
            ForData::new(Bearing::Bites, "the printed condition has no solution, so theorem 1 gives no gain")
                .figure("$`c = sqrt(P_up/P_low)`$", data.c.clone())
                .figure("$`3.5 (3 sqrt(2)/c + 1/(2 c^2))`$, to be at least 81", product(&data.c))
        }),
    }
}

/// `9 k - 6 sqrt 2 sqrt k - 2`, to be at most 0; increasing for k >= 2/9.
fn excess(ratio: &Enclosure) -> Enclosure {
    9 * ratio - 6 * root(2) * ratio.sqrt() - 2
}

/// `(6 + 4 sqrt 2)/9`, the largest P_up/P_low for which P:eq:bound_xe_inf has a solution.
fn largest_ratio() -> Enclosure {
    (6 + 4 * root(2)) / 9
}

/// E2: P:eq:bound_xe_inf is solvable only for nearly spherical Lyapunov functions.
pub(super) fn e2(data: Option<&Data<'_>>) -> Erratum {
    let four_digits = |value: i64| rational(&ratio(value, 10_000));
    let evidence = vec![
        Evidence::rigorous(
            "with $`k = P_up/P_low`$ it needs $`9 k - 6 sqrt(2) sqrt(k) - 2 <= 0`$, increasing for $`k >= 1`$; at $`k = 1.2952`$ it is",
            (excess(&four_digits(12_952)), Less, 0),
        ),
        Evidence::rigorous("and at $`k = 1.2953`$ it is", (excess(&four_digits(12_953)), Greater, 0)),
        Evidence::rigorous(
            "its root $`sqrt(k) = (sqrt(2) + 2)/3`$, that is $`k = (6 + 4 sqrt(2))/9`$, is above",
            (largest_ratio(), Greater, ratio(12_952, 10_000)),
        ),
        Evidence::rigorous("and below", (largest_ratio(), Less, ratio(12_953, 10_000))),
    ];
    let for_data = data.map(|data| {
        let ratio = &data.p_up / &data.p_low;
        let (bearing, summary) = match ratio.gt(&largest_ratio()) {
            Truth::True => (Bearing::Bites, "the printed condition has no solution, so theorem 2 gives no gain"),
            Truth::False => (Bearing::Harmless, "the printed condition can be met"),
            Truth::Undecided => (Bearing::Depends, "the ratio is too close to the threshold to tell"),
        };
        ForData::new(bearing, summary).figure("$`P_up/P_low`$", ratio).figure("largest ratio", largest_ratio())
    });
    Erratum {
        id: "E2",
        place: "P:eq:bound_xe_inf with P:eq:temp_bound_xe_inf",
        class: Class::A,
        printed: "$`9 P_up x^2 + 9 e^2 <= (1/2) min{P_low x_b^2, e_b^2}`$ with $`x_b = (3 sqrt(2) c + 2) x`$, $`e_b = 6 e`$, for every \
                  $`(P_up, P_low, alpha)`$",
        instead: "solvable only for $`P_up/P_low <= (6 + 4 sqrt(2))/9 = 1.2952..`$; C4 and C5 with $`x_per = e_per = 0`$ hold for \
                  any ratio",
        evidence,
        for_data,
    }
}
