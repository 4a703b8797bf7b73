//! E15 and E16: sentences that claim too much, constants that are larger than needed.

use super::evidence::Evidence;
use super::evidence::Relation::{Equal, Greater, Less};
use super::kappa::pole_sums;
use super::numbers::{integer, power, quotient, ratio};
use super::{Bearing, Class, Erratum, ForData, is_constant, vanishes};
use rug::Rational;
use sigmastar_theory::data::{Bound, Data};
use sigmastar_theory::derivation::gains;

/// The printed formula of both thresholds, P:eq:ineq_bounds_sigma and P:eq:bound_sigma_inf, for P_up = P_low = alpha = mu =
/// b_fe = b_qx = 1 and b_qe = 0: `(b_fe + b_qx)^2/(2 (1 - rho_0 - h)) + 1/(2h)`.
fn threshold(rho_0: &Rational, h: &Rational) -> Rational {
    let margin = Rational::from(1) - rho_0 - h;
    Rational::from(4) / (margin * 2u32) + Rational::from(h * 2u32).recip()
}

/// rho_0 of P:eq:def_rho_0 for P_up = P_low = 1, x_a = e_a = 1, x_b = 7 (any number will do).
fn rho_0(f_xx: &Rational, f_ex: &Rational) -> Rational {
    (Rational::from(f_xx + f_ex) + Rational::from(f_xx * 8u32)) / 2u32
}

/// E15: three claims.
pub(super) fn e15(data: Option<&Data<'_>>) -> Erratum {
    let (none, h) = (Rational::new(), ratio(1, 4));
    let finite = threshold(&rho_0(&none, &none), &h);
    // rho_0^oo = (P_up/2) b_fxx(x_b, 0) x_b.
    let infinite = threshold(&(Rational::from(&none * 7u32) / 2u32), &h);
    // At a pole T_N(l)/w^2 = 2/(mu^2 n_l): n_100 = 100^-1.5 = 1/1000.
    let n_100 = power(&ratio(1, 10), 3);
    let weights = [Rational::from(2), Rational::from(1)];
    let square = ratio(2, 3);
    let (_, integrator) = pole_sums(&weights[..1], &square);
    let (_, oscillator) = pole_sums(&weights, &square);
    let evidence = vec![
        Evidence::rigorous(
            "$`P_up = P_low = alpha = mu = b_fe = b_qx = 1`$, $`b_fxx = b_fex = b_qe = 0`$, common $`h = 1/4`$: the printed $`sigma*_a`$ and \
             $`sigma*_oo`$",
            (finite, Equal, infinite),
        ),
        Evidence::rigorous(
            "the bound of $`z`$: $`q`$ of frequency $`Om`$, $`mu = 1`$, $`n_l = l^-1.5`$, mean of $`zeta'N zeta`$ per mean of $`q^2`$: with $`w = Om/100`$ and $`n_o >= \
             100`$ it is $`2/n_100`$, with $`w = Om 2/n_1`$",
            (Rational::from(2) / n_100, Greater, 2),
        ),
        Evidence::rigorous(
            "$`q = cos(Om t)`$, $`w = sqrt(3/2) Om`$, $`mu = w`$, $`n_0 = 2`$, $`n_1 = 1`$: $`rms(e)`$ falls with $`1 + nu^2 g^2`$ (P:eq:gain_ek); for $`n_o = 1`$ \
             this is smaller than for $`n_o = 0`$, so the L2 norm increases with $`n_o`$",
            (Rational::from(1) + oscillator, Less, Rational::from(1) + integrator),
        ),
        Evidence::cited(
            "in the paper's second table, $`0.95 * 2 pi`$, the same happens: rms for $`n_o = 3`$ against $`n_o = 2`$",
            (ratio(982, 10_000), Greater, ratio(980, 10_000)),
        ),
    ];
    Erratum {
        id: "E15",
        place: "P:thm2 and the text after it; after P:thm1; abstract",
        class: Class::AClaim,
        printed: "$`sigma*_oo < sigma*`$; the bound of $`z`$ is independent of the frequencies; the L2 norm of $`e`$ is a monotonically \
                  decreasing function of $`n_o`$",
        instead: "$`sigma*_oo <= sigma*_a`$ for a common $`h`$; the bound of $`z`$ depends on $`w`$ (E6); with $`w = 2 pi/T`$ the bound of the L2 norm \
                  decreases (and the norm itself where $`q`$ is a function of $`t`$ alone), otherwise it need not",
        evidence,
        for_data: data.map(e15_for_data),
    }
}

fn e15_for_data(data: &Data<'_>) -> ForData {
    let constant = [Bound::Fe, Bound::Qe, Bound::Qx].iter().all(|&bound| is_constant(data, bound));
    let (bearing, summary) = if vanishes(data, Bound::Fxx) && vanishes(data, Bound::Fex) && constant {
        (
            Bearing::Bites,
            "$`b_fxx = b_fex = 0`$ and constant bounds: the two printed thresholds are equal for a common $`h`$",
        )
    } else if data.spec.internal_model.matched {
        (
            Bearing::Depends,
            "$`w = 2 pi/T`$: the bound of the L2 norm decreases with $`n_o`$; the bound of $`z`$ depends on $`w`$",
        )
    } else {
        (
            Bearing::Depends,
            "$`w`$ is not $`2 pi/T`$: the L2 norm may increase with $`n_o`$; the bound of $`z`$ depends on $`w`$",
        )
    };
    ForData::new(bearing, summary)
        .figure("w", &data.spec.internal_model.base_frequency)
        .figure("$`T_N(0)/w^2`$", data.transfer_at_zero() / data.base_frequency.sqr())
}

/// E16: sound constants that are larger than needed.
pub(super) fn e16(data: Option<&Data<'_>>) -> Erratum {
    // P_up/P_low, alpha and T of the paper's example.
    let c = quotient(15_512, 10_000).sqrt();
    let (alpha, period) = (quotient(58, 100), integer(1));
    let k_alpha = gains::k_alpha(&c, &alpha, &period);
    let sigma = integer(40);
    let beta = gains::beta(&sigma, &period) / gains::beta_s(&sigma, &period);
    let evidence = vec![
        Evidence::rigorous(
            "$`K_alpha`$ against $`c`$, which is enough ($`P_up/P_low = 1.5512`$, $`alpha = 0.58`$, $`T = 1`$): $`K_alpha/c = 1 + (c-1) e^(-alpha T)`$",
            (k_alpha / &c, Greater, 1),
        ),
        Evidence::rigorous(
            "$`beta`$ against $`beta_s = beta/2`$: the quotient at $`sigma = 40`$, $`T = 1`$",
            (beta, Greater, 1),
        ),
        Evidence::rigorous(
            "$`2 b_fxx x_p`$ against $`b_fxx x_p`$ in the contraction matrix: the quotient",
            (2, Greater, 1),
        ),
        Evidence::rigorous(
            "$`54 = 9 (4 + 2)`$ against 1: with $`b_qt = b_qx b_f = b_qe b_q = 1`$ the printed $`3 (1 + 1) + 54`$ against $`(1 + 1 + 1)^2`$",
            (3 * (1 + 1) + 9 * (4 + 2), Greater, 9),
        ),
        Evidence::rigorous("$`T/mu`$ against $`T/(2 mu)`$ in P:pf:L2_zeta: the quotient", (2, Greater, 1)),
        Evidence::rigorous(
            "2 against 4 in the denominator of P:eq:ineq_bounds_sigma: $`rho_12^2/2`$ against $`rho_12^2/4`$ at $`rho_12 = 1`$",
            (ratio(1, 2), Greater, ratio(1, 4)),
        ),
    ];
    let for_data = data.map(|data| {
        let k_alpha = gains::k_alpha(&data.c, &data.alpha, &data.period);
        ForData::new(Bearing::Costs, "all of these are sound here, and larger than needed")
            .figure("$`K_alpha`$", k_alpha.clone())
            .figure("c", data.c.clone())
            .figure("$`K_alpha/c`$", k_alpha / &data.c)
    });
    Erratum {
        id: "E16",
        place: "P:app:Kalpha1, P:eq:beta_definition, P:eq:def_ypsilon, bound of dq/dt, P:pf:L2_zeta, P:eq:ineq_bounds_sigma",
        class: Class::B,
        printed: "$`K_alpha`$, $`beta`$, $`2 b_fxx x_p`$, 54, $`1/mu`$, 2",
        instead: "$`c`$, $`beta/2`$, $`b_fxx x_p`$, 1 (Minkowski), $`1/(2 mu)`$, 4: sections 3 to 5 of the derivation",
        evidence,
        for_data,
    }
}
