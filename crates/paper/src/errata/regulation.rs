//! E10 to E12: what the paper concludes for the size of the periodic error.

use super::evidence::Evidence;
use super::evidence::Relation::{Greater, Less, LessOrEqual};
use super::kappa::{example_weight, printed_example};
use super::numbers::{PRECISION, integer, pi, quotient, ratio, rational, root};
use super::square_wave;
use super::{Bearing, Class, Erratum, ForData};
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_lang::spec::power_tail;
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::gains;
use std::cmp::Ordering;

/// Compares a positive number of the specification with 1, exactly where it has an exact form.
fn against_one(constant: &sigmastar_lang::spec::Constant) -> Option<Ordering> {
    if let Some(value) = constant.as_rational() {
        return Some(value.cmp(&rug::Rational::from(1)));
    }
    let (value, one) = (constant.enclose(PRECISION), integer(1));
    match (value.lt(&one), value.gt(&one)) {
        (Truth::True, _) => Some(Ordering::Less),
        (_, Truth::True) => Some(Ordering::Greater),
        _ => None,
    }
}

/// E10: a factor mu is missing in r_e.
pub(super) fn e10(data: Option<&Data<'_>>) -> Erratum {
    let supremum = square_wave::scaled_supremum();
    // |mu n_0 zeta| <= sup|q| = 1, so sqrt(zeta N zeta) <= sqrt(n_0)/(mu n_0).
    let state = root(2) / 20;
    // sqrt(n_0) sqrt(n_0)/(mu n_0) = 1/mu.
    let by_n_0 = ratio(1, 1) + ratio(1, 10);
    let n_bar = (2 + power_tail(1, &quotient(3, 2), PRECISION)).sqrt();
    let kappa_0 = printed_example().kappa_0;
    let evidence = vec![
        Evidence::rigorous(
            "$`n_o = 0`$, $`n_0 = 2`$, $`mu = 10`$, $`T = 4`$, $`sigma = 4000`$, $`q = tanh(2000 sin(pi t/2))`$: $`sigma sup|e_p|`$ against $`sup|q| + \
             Nbar sup sqrt(zeta'N zeta)`$, with the actual $`sup sqrt(zeta'N zeta) <= sqrt(2)/20`$ and $`Nbar = sqrt(n_0)`$: $`1 + 1/mu`$",
            (supremum.clone(), Greater, by_n_0),
        ),
        Evidence::rigorous(
            "the same with $`Nbar^2 = 2 + zeta(1.5)`$, the sum of all the example's weights",
            (supremum.clone(), Greater, 1 + n_bar * state),
        ),
        Evidence::rigorous(
            "the printed constant in place of the actual supremum is not contradicted: $`zeta_p >= sqrt(kappa_0) sup|q|`$, and \
             $`sigma sup|e_p|`$",
            (supremum, Less, 1 + root(2) * kappa_0.sqrt()),
        ),
    ];
    let for_data = data.map(|data| {
        let (bearing, summary) = match against_one(&data.spec.internal_model.mu) {
            Some(Ordering::Equal) => (Bearing::Harmless, "$`mu = 1`$: the missing factor is 1"),
            Some(Ordering::Greater) => {
                (Bearing::Bites, "the second term of the printed $`r_e`$ is too small by the factor $`mu`$")
            }
            Some(Ordering::Less) => (Bearing::Costs, "$`mu < 1`$: the printed $`r_e`$ is larger than it need be"),
            None => (Bearing::Depends, "$`mu`$ is too close to 1 to tell"),
        };
        ForData::new(bearing, summary).figure("$`mu`$", &data.spec.internal_model.mu)
    });
    Erratum {
        id: "E10",
        place: "end of the proof of P:prop:periodic_solution: $`r_e`$, hence $`psi_1`$ and $`psi_x`$",
        class: Class::AProof,
        printed: "$`sup|e| <= (1/sigma)(sup|q| + sup|M'N zeta_p|)`$, $`r_e = b_q + Nbar zeta_p`$",
        instead: "$`r_e = b_q + mu Nbar zeta_p`$, which depends on $`mu`$; or $`psi_1 = T q1/sqrt(12)`$, independent of $`mu`$ and $`n_o`$",
        evidence,
        for_data,
    }
}

/// `int_0^T e_p^2` for q = cos(101 * 2 pi t/10): T = 10, n_o = 100, sigma = 2, mu = 1, w = 2 pi/T, the example's weights.
///
/// |e_k|^2 = |q_k|^2/((k Om)^2 + sigma^2)/(1 + nu^2 g_N(k)^2) (P:eq:gain_ek), and |q_k| = 1/2 for k = +-101.
fn energy() -> Enclosure {
    let harmonic = 101;
    let omega = pi() / 5;
    let square = harmonic * harmonic;
    let sum = (1..=100).fold(-2 / integer(square), |sum, l| sum + example_weight(l) / (l * l - square));
    let g = harmonic * sum;
    let nu = omega.recip();
    let first_order = (harmonic * &omega).sqr() + 4;
    5 / (first_order * (1 + (nu * g).sqr()))
}

/// E11: a factor T is missing in psi_2.
pub(super) fn e11(data: Option<&Data<'_>>) -> Erratum {
    // psi_2/(n_o+1)^2 with psi_2 = (T/2 pi)^2 sup q^2.
    let printed = (5 / pi()).sqr() / (101 * 101);
    let energy = energy();
    let evidence = vec![
        Evidence::rigorous(
            "$`T = 10`$, $`n_o = 100`$, $`sigma = 2`$, $`mu = 1`$, $`w = 2 pi/T`$, the example's weights, $`q = cos(101 2 pi t/10)`$: $`int e^2`$ against \
             the printed $`psi_2/(n_o+1)^2`$",
            (energy.clone(), Greater, printed.clone()),
        ),
        Evidence::rigorous("and with the factor $`T`$", (energy, LessOrEqual, 10 * printed)),
    ];
    let for_data = data.map(|data| {
        let (bearing, summary) = match against_one(data.spec.period.nominal()) {
            Some(Ordering::Equal) => (Bearing::Harmless, "$`T = 1`$: the missing factor is 1"),
            Some(Ordering::Greater) => (Bearing::Bites, "the printed $`psi_2`$ is too small by the factor $`T`$"),
            Some(Ordering::Less) => {
                (Bearing::Costs, "$`T < 1`$: the printed $`psi_2`$ is larger than it need be by $`1/T`$")
            }
            None => (Bearing::Depends, "$`T`$ is too close to 1 to tell"),
        };
        ForData::new(bearing, summary).figure("T", data.spec.period.nominal())
    });
    Erratum {
        id: "E11",
        place: "P:eq:theorem_2_bound_e2, $`psi_2`$",
        class: Class::A,
        printed: "$`int_0^T e^2 <= psi_2/(n_o+1)^2`$ with $`psi_2 = (T/2 pi)^2 b_q^2`$",
        instead: "$`psi_2 = T (T/2 pi)^2 b_q^2`$: what the proof bounds is $`(1/T) int_0^T e^2`$",
        evidence,
        for_data,
    }
}

/// E12: a misplaced sqrt(T) in K_{alpha,2}.
pub(super) fn e12(data: Option<&Data<'_>>) -> Erratum {
    let (period, one) = (quotient(1, 10), integer(1));
    let k_alpha = gains::k_alpha(&one, &one, &period);
    let norm = rational(&ratio(1, 10)).sqrt();
    let printed = gains::k_alpha_2_printed(&k_alpha, &one, &period) * &norm;
    let repaired = gains::k_alpha_2(&k_alpha, &one, &period) * norm;
    let evidence = vec![
        Evidence::rigorous(
            "$`T = 0.1`$, $`alpha = 1`$, $`F = -1`$, $`g = 1`$: the periodic solution is 1, against the printed $`(K_{alpha,2}/sqrt(alpha)) |g|_2`$",
            (1, Greater, printed),
        ),
        Evidence::rigorous("and without the factor $`T`$", (1, LessOrEqual, repaired)),
    ];
    let for_data = data.map(|data| {
        let k_alpha = gains::k_alpha(&data.c, &data.alpha, &data.period);
        let (bearing, summary) = match against_one(data.spec.period.nominal()) {
            Some(Ordering::Equal) => (Bearing::Harmless, "$`T = 1`$: the extra factor is 1"),
            Some(Ordering::Less) => (
                Bearing::Bites,
                "$`T < 1`$: the printed $`K_{alpha,2}`$ is too small by $`sqrt(T)`$; $`beta`$, where it is used, is right",
            ),
            Some(Ordering::Greater) => (Bearing::Costs, "$`T > 1`$: the printed $`K_{alpha,2}`$ is larger than it need be"),
            None => (Bearing::Depends, "$`T`$ is too close to 1 to tell"),
        };
        ForData::new(bearing, summary)
            .figure("T", data.spec.period.nominal())
            .figure("printed $`K_{alpha,2}`$", gains::k_alpha_2_printed(&k_alpha, &data.alpha, &data.period))
            .figure("without the factor $`T`$", gains::k_alpha_2(&k_alpha, &data.alpha, &data.period))
    });
    Erratum {
        id: "E12",
        place: "P:app:Kalpha2, used in P:11",
        class: Class::A,
        printed: "$`K_{alpha,2} = K_alpha sqrt(T (1+e^(-alpha T))/(2 (1-e^(-alpha T))))`$",
        instead: "no factor $`T`$; $`beta`$ (P:eq:beta_definition), whose $`T`$ comes from $`int q^2 <= T sup q^2`$, is right",
        evidence,
        for_data,
    }
}
