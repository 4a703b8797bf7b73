//! E17: slips without effect.

use super::evidence::Evidence;
use super::evidence::Relation::{Different, Greater, Less, LessOrEqual};
use super::numbers::ratio;
use super::{Class, Erratum};
use rug::Rational;

/// `lambda^2 - b lambda + c`.
fn quadratic(lambda: &Rational, b: &Rational, c: &Rational) -> Rational {
    Rational::from(lambda.square_ref()) - Rational::from(lambda * b) + c
}

/// E17: each slip that is a computation, at the smallest numbers that show it.
pub(super) fn e17() -> Erratum {
    // m = 1: m_m = 3, m_p = 5; r = 1/4, lambda = 1/10: -1/(lambda m_m) + r/((1-lambda) m_m), and with m_p as printed.
    let (lambda, r) = (ratio(1, 10), ratio(1, 4));
    let rest = Rational::from(1) - &lambda;
    let left = |m: u32| Rational::from(&lambda * m).recip();
    let right = |m: u32| Rational::from(&r / &rest) / m;
    let z_a = right(3) - left(3);
    let z_a_printed = right(5) - left(3);
    // b = 5/4, c = 49/400: b^2 - c = (6/5)^2, so the smaller "zero" as printed, without the 4, is (5/4 - 6/5)/2.
    let (b, c) = (ratio(5, 4), ratio(49, 400));
    let printed_zero = (Rational::from(&b) - ratio(6, 5)) / 2u32;
    let evidence = vec![
        Evidence::rigorous(
            "$`S_m(x)`$, bounded by its value at $`x = m`$: the term $`l = 3`$ of its upper part, at $`m = 1`$, is $`1/(9 - x^2)`$, and at $`x = 2`$",
            (Rational::from(9 - 4).recip(), Greater, Rational::from(9 - 1).recip()),
        ),
        Evidence::rigorous(
            "$`z_a`$ with $`m_p`$ for $`m_m`$ in its second term: $`m = 1`$, $`r = 1/4`$, $`lambda = 1/10`$, as printed",
            (z_a_printed, Different, z_a),
        ),
        Evidence::rigorous(
            "$`lambda_b`$ without the 4 in the discriminant: for $`lambda^2 - (5/4) lambda + 49/400`$ the printed $`(b - sqrt(b^2 - c))/2 \
             = 1/40`$ is no zero but smaller than the zero, hence harmless; there the quadratic is",
            (quadratic(&printed_zero, &b, &c), Greater, 0),
        ),
        Evidence::rigorous(
            "$`1/(1-lambda)^2`$ kept in one line and dropped in others: its value at $`lambda = 1/5`$, against $`1/lambda^2`$",
            (ratio(25, 16), Less, 25),
        ),
        Evidence::rigorous(
            "the interval $`[varpi/m, 1/5]`$ for $`lambda`$: only its left end is proved to be below $`lambda_b >= (1/16)/((a+2)(2m+1))`$; \
             at $`a = 1`$, $`m = 1`$ its right end 1/5 is above that bound",
            (ratio(1, 5), Greater, ratio(1, 16) / 9u32),
        ),
        Evidence::rigorous(
            "$`Q_m`$: $`m^2 + 2 m + 1 + (m+2)^2`$ is $`2 m^2 + 6 m + 5`$, not $`2 m^2 + 5 m + 5`$; at $`m = 1`$",
            ((1 + 1) * (1 + 1) + (1 + 2) * (1 + 2), Greater, 2 + 5 + 5),
        ),
        Evidence::rigorous(
            "and the bound 7/2 of the corrected sum at $`m = 1`$, $`0 + 1 + 13/25 + 3/5`$, stands",
            (Rational::from(1) + ratio(13, 25) + ratio(3, 5), LessOrEqual, ratio(7, 2)),
        ),
        Evidence::rigorous(
            "the trace of $`Phi - mu M M'N`$ is $`-mu (n_0 + ...)`$, not $`mu (1 + ...)`$: $`n_o = 0`$, $`mu = 1`$, $`n_0 = 2`$",
            (-2, Different, 1),
        ),
        Evidence::rigorous(
            "$`r/sqrt(sigma)`$ for $`r/sigma`$ in P:eq:boundx_item2: $`r = 1`$, $`sigma = 4`$",
            (ratio(1, 2), Greater, ratio(1, 4)),
        ),
        Evidence::rigorous(
            "$`5 e_b`$ for $`e_b - e_a = 5 e_a`$: with $`e_b = 6 e_a`$, $`e_a = 1`$",
            (5 * 6, Different, 6 - 1),
        ),
        Evidence::rigorous(
            "a factor $`2/mu`$ is missing before $`b_qx^2 |x|^2`$ in theorem 2: at $`mu = 1`$",
            (2, Different, 1),
        ),
        Evidence::rigorous("$`omega_l = 2 pi/T`$ for $`2 pi l/T`$: the quotient at $`l = 2`$", (2, Different, 1)),
        Evidence::rigorous(
            "Fourier sums from $`k = 0`$ for sums over all integers: $`q = cos`$ has $`|q_1|^2 + |q_-1|^2`$, the mean of $`q^2`$,",
            (ratio(1, 4) + ratio(1, 4), Greater, ratio(1, 4)),
        ),
    ];
    Erratum {
        id: "E17",
        place: "P:eq:def_ypsilon ($`K_phi`$), P:76, $`z_a`$, P:lambda_b, P:eq:ineq_lambda, P:boundFno0, $`Q_m`$, trace before \
                P:lemma:hurwitzPhiM, P:eq:boundx_item2, P:eq:temp_cond_xe_O, P:eq:R-lyap1_inf, P:sec:infinite, \
                P:pf_lemma_eq1",
        class: Class::C,
        printed: "$`K_phi`$; $`S_m`$ at $`x = m`$; $`m_p`$ in $`z_a`$; $`1/(1-lambda)^2`$; $`lambda_b`$; $`lambda`$ interval; $`5m`$ in $`Q_m`$; trace; $`r/sqrt(sigma)`$; $`5 e_b`$; \
                  no $`2/mu`$; $`omega_l = 2 pi/T`$; sums from $`k = 0`$",
        instead: "$`K_alpha`$; the upper part of $`S_m`$ increases in $`x`$; $`m_m`$; $`1/(1-lambda)^2 <= 25/16`$ is small; 4 in the discriminant; \
                  $`lambda = varpi/m`$; $`6m`$; $`-mu (n_0 + sum n_l)`$; $`r/sigma`$; $`5 e_a`$; $`2/mu`$; $`2 pi l/T`$; all integers",
        evidence,
        for_data: None,
    }
}
