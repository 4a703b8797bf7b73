//! E6 to E9: the transfer from q to the internal model.

use super::evidence::Evidence;
use super::evidence::Relation::{Equal, Greater, GreaterOrEqual, Less, LessOrEqual};
use super::kappa::{ClosedForm, pole_sums, printed_example, printed_pair_holds, proved_kappa_1, transfer};
use super::numbers::{integer, pi, quotient, ratio, rational};
use super::{Bearing, Class, Erratum, ForData};
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_theory::data::Data;
use sigmastar_theory::transfer::printed_transfer;

/// E6: the powers of the base frequency.
pub(super) fn e6(data: Option<&Data<'_>>) -> Erratum {
    let weights = [Rational::from(2), Rational::from(1)];
    let square = ratio(2, 3);
    let w_squared = Rational::from(ratio(3, 100).square_ref());
    // g_1 = 0 there, so nu has no influence; nu = mu/w = 100/3.
    let (slope, g_squared) = pole_sums(&weights, &square);
    let nu_squared = Rational::from(w_squared.recip_ref());
    let actual = transfer(&weights, &nu_squared, &square) / &w_squared;
    let omega_squared = Rational::from(&square * &w_squared);
    let printed = printed_example();
    let bound = &printed.kappa_0 + &printed.kappa_1 * rational(&omega_squared);
    let evidence = vec![
        Evidence::rigorous("$`n_o = 1`$, $`n_0 = 2`$, $`n_1 = 1`$, $`x^2 = 2/3`$: $`g_1(x)^2`$", (g_squared, Equal, 0)),
        Evidence::rigorous("and $`g_1'(x)`$", (slope, Equal, 18)),
        Evidence::rigorous(
            "$`w = 0.03`$, $`mu = 1`$: $`zeta* N zeta/|v|^2 = T(x)/w^2`$ at $`omega = w x`$, against the printed $`kappa_0 + kappa_1 omega^2`$ \
             (weights $`n_0 = 2`$, $`n_l = l^-1.5`$)",
            (actual, Greater, bound),
        ),
    ];
    Erratum {
        id: "E6",
        place: "P:eq:zeta_pk_simplified",
        class: Class::A,
        printed: "$`zeta* N zeta/|v|^2 = T(omega/w)`$, with $`mu`$ in $`T`$ and no powers of $`w`$",
        instead: "$`(1/w^2) T_N(omega/w)`$ at $`nu = mu/w`$ in place of $`mu`$: $`kappa_0 = k0/w^2`$, $`kappa_1 = k1/w^4`$; as printed for $`w = 1`$ only",
        evidence,
        for_data: data.map(e6_for_data),
    }
}

fn e6_for_data(data: &Data<'_>) -> ForData {
    let one = integer(1);
    let matches = data.base_frequency.is_exact() && data.base_frequency == one;
    let (bearing, summary) = match (matches, printed_pair_holds(data)) {
        (true, _) => (Bearing::Harmless, "$`w = 1`$: the printed normalisation is the right one"),
        (_, Truth::True) => (
            Bearing::Harmless,
            "the printed $`kappa_0`$, $`kappa_1`$ bound the true transfer here (proved with the closed form), not by the printed proof",
        ),
        (_, Truth::False) => (Bearing::Bites, "the true transfer at $`omega = 0`$ exceeds the printed $`kappa_0`$"),
        _ => (Bearing::Depends, "$`w`$ is not 1, and the printed constants are neither proved nor refuted here"),
    };
    ForData::new(bearing, summary)
        .figure("w", &data.spec.internal_model.base_frequency)
        .figure("$`nu = mu/w`$", data.nu.clone())
        .figure("missing factor $`1/w^2`$ of $`kappa_0`$", data.base_frequency.sqr().recip())
        .figure("missing factor $`1/w^4`$ of $`kappa_1`$", data.base_frequency.sqr().sqr().recip())
}

/// E7: the value at 0.
pub(super) fn e7(data: Option<&Data<'_>>) -> Erratum {
    // n_o = 0: T(x) = n_0/(x^2 + mu^2 n_0^2), so T(0) = 1/(mu^2 n_0); mu = 1, n_0 = 2.
    let n_0 = Rational::from(2);
    let at_zero = &n_0 / Rational::from(n_0.square_ref());
    let k0 = Rational::from(&n_0 * 7) / 2u32;
    let nu = (2 * pi()).recip();
    let slow = (nu.sqr() * rational(&n_0)).recip();
    let threshold_squared = ratio(2, 7) / Rational::from(n_0.square_ref());
    let evidence = vec![
        Evidence::rigorous(
            "$`n_o = 0`$, $`n_0 = 2`$, $`mu = w = 1`$: $`T(x) = n_0/(x^2 + mu^2 n_0^2)`$, so $`T(0)`$; $`2/(mu^2 n_0)`$ is printed",
            (at_zero.clone(), Less, Rational::from(2) / &n_0),
        ),
        Evidence::rigorous(
            "and then P:eq:bound_zetaNzeta_exact, $`2 l^2/(mu^2 n_1)`$, which is 0 at $`l = 0`$: $`T(0)`$",
            (at_zero.clone(), Greater, 0),
        ),
        Evidence::rigorous(
            "$`nu = 1/(2 pi)`$, $`n_0 = 2`$: $`T(0) = 1/(nu^2 n_0)`$ against the printed $`k0 = 7 n_0/2`$",
            (slow, Greater, k0.clone()),
        ),
        Evidence::rigorous(
            "$`k0`$ fails for $`nu < sqrt(2/7)/n_0`$, where $`T(0) = 1/(nu^2 n_0)`$ passes it: at equality $`T(0)`$",
            ((threshold_squared * &n_0).recip(), Equal, k0.clone()),
        ),
        Evidence::rigorous(
            "in the printed normalisation, $`w = 1`$, $`mu >= 1`$ and $`n_0 = 2`$, $`k0`$ is not contradicted at 0: $`T(0) <=`$ its value at $`mu = 1`$",
            (at_zero, LessOrEqual, k0),
        ),
    ];
    let for_data = data.map(|data| {
        let k0 = 7 * &data.n_0 / 2;
        let at_zero = data.transfer_at_zero();
        let (bearing, summary) = match at_zero.gt(&k0) {
            Truth::True => (
                Bearing::Bites,
                "with the correction E6, $`kappa_0 = k0/w^2`$, the printed $`k0`$ is below the transfer at 0",
            ),
            Truth::False => (Bearing::Harmless, "the printed k0 is not below the transfer at 0"),
            Truth::Undecided => (Bearing::Depends, "the transfer at 0 is too close to the printed k0 to tell"),
        };
        ForData::new(bearing, summary)
            .figure("$`nu`$", data.nu.clone())
            .figure("$`T(0) = 1/(nu^2 n_0)`$", at_zero)
            .figure("$`k0 = 7 n_0/2`$", k0)
    });
    Erratum {
        id: "E7",
        place: "P:lemma:transfer_function, value at 0 and case $`m = 0`$; P:eq:transfer_function2",
        class: Class::A,
        printed: "$`T(0) = 2/(mu^2 n_0)`$ and then a bound that is 0 there; $`lambda >= varpi/m`$ with $`m = 0`$",
        instead: "$`T(0) = 1/(nu^2 n_0)`$; the case $`m = 0`$ is not proved; $`k0 = 7 n_0/2`$ fails for $`nu < sqrt(2/7)/n_0`$",
        evidence,
        for_data,
    }
}

/// E8: a factor lost in a proof.
pub(super) fn e8(data: Option<&Data<'_>>) -> Erratum {
    let factor = Rational::from(ratio(2, 1).square_ref());
    let printed = printed_example();
    let closed = ClosedForm::new(&integer(2), &integer(1), &integer(1));
    let mut evidence = vec![
        Evidence::rigorous(
            "the factor $`(m+1)^2/m^2`$, at $`m = 1`$, disappears between two lines",
            (factor.clone(), Equal, 4),
        ),
        Evidence::rigorous("along that route $`512/mu^2`$ becomes, at $`mu = 1`$,", (factor * 512, Equal, 2048)),
    ];
    for (where_, lhs, rhs) in closed.comparisons(&printed.kappa_0, &printed.kappa_1) {
        evidence.push(Evidence::rigorous(
            format!(
                "the printed pair survives at $`w = mu = 1`$ and the example's weights, being above the proved closed form: {where_}"
            ), (lhs, LessOrEqual, rhs)));
    }
    let for_data = data.map(|data| {
        let (bearing, summary) = match printed_pair_holds(data) {
            Truth::True => {
                (Bearing::Harmless, "the printed $`kappa_0`$, $`kappa_1`$ are proved here by the closed form")
            }
            Truth::False => (Bearing::Bites, "the printed pair fails at $`omega = 0`$ (E6, E7), whatever the factor"),
            Truth::Undecided => (Bearing::Depends, "the printed pair is neither proved nor refuted here"),
        };
        ForData::new(bearing, summary)
            .figure("$`512/(mu^2 n_1)`$", 512 / (data.mu.sqr() * &data.n_1))
            .figure("$`2048/(mu^2 n_1)`$", 2048 / (data.mu.sqr() * &data.n_1))
    });
    Erratum {
        id: "E8",
        place: "P:boundFno in P:lemma:transfer_function",
        class: Class::AProof,
        printed: "$`|F| <= 512/(mu^2 n_m)`$",
        instead: "$`2048/(mu^2 n_m)`$ along that route; only the printed proof fails, the printed $`kappa_1`$ exceeds the proved $`k1`$ at $`w = 1`$",
        evidence,
        for_data,
    }
}

/// E9: the size of kappa_1.
pub(super) fn e9(data: Option<&Data<'_>>) -> Erratum {
    let printed = printed_example();
    let closed = ClosedForm::new(&integer(2), &integer(1), &integer(1));
    // n_o = 1, x = 0.827: (T_1(x) - 7)/x^2, which every k1 that goes with k0 = 7 must reach.
    let square = Rational::from(ratio(827, 1000).square_ref());
    let needed = (transfer(&[Rational::from(2), Rational::from(1)], &Rational::from(1), &square) - 7u32) / square;
    let evidence = vec![
        Evidence::rigorous("the example's weights: S", (printed.s.clone(), Less, ratio(7_220, 1000))),
        Evidence::rigorous("$`a = (2 + sqrt(2)) S`$", (printed.a.clone(), Less, ratio(24_650, 1000))),
        Evidence::rigorous("$`varpi = 1/(48 (a + 2))`$", (printed.varpi.clone(), Less, ratio(782, 1_000_000))),
        Evidence::rigorous("the printed $`kappa_1`$", (printed.kappa_1.clone(), Greater, 13_000_000)),
        Evidence::rigorous(
            "the closed form $`k1`$ at $`nu = 1`$, proved for every $`n_o`$; the printed value divided by it",
            (&printed.kappa_1 / &closed.k1, Greater, 80_000),
        ),
        Evidence::rigorous(
            "with $`k0 = 7`$ no $`k1`$ below 17.59 will do: $`(T_1(x) - 7)/x^2`$ at $`n_o = 1`$, $`x = 0.827`$, $`nu = 1`$",
            (needed.clone(), Greater, ratio(1759, 100)),
        ),
        Evidence::cited(
            "and about 17.6 is enough (grid search over $`n_o`$ and $`x`$)",
            (ratio(176, 10), GreaterOrEqual, needed),
        ),
        Evidence::cited(
            "the state bound grows with the root of $`kappa_1`$: $`sqrt(kappa_1/17.6)`$",
            ((printed.kappa_1 / quotient(176, 10)).sqrt(), Greater, 850),
        ),
    ];
    let for_data = data.map(|data| {
        let printed = printed_transfer(data).kappa_1;
        let proved = proved_kappa_1(data);
        let factor: Enclosure = &printed / &proved;
        let (bearing, summary) = match factor.gt(&integer(1)) {
            Truth::True => (Bearing::Costs, "the printed $`kappa_1`$ is above the proved $`k1/w^4`$ by the factor"),
            Truth::False => (Bearing::Bites, "the printed $`kappa_1`$ is not above the proved $`k1/w^4`$ (E6)"),
            Truth::Undecided => (Bearing::Depends, "the printed $`kappa_1`$ is close to the proved $`k1/w^4`$"),
        };
        ForData::new(bearing, summary)
            .figure("printed $`kappa_1`$", printed)
            .figure("proved $`k1/w^4`$ (closed form)", proved)
            .figure("factor", factor)
    });
    Erratum {
        id: "E9",
        place: "P:lemma:transfer_function, $`kappa_1`$",
        class: Class::B,
        printed: "$`kappa_1 = 4 n_0/varpi^2 + 512/(mu^2 n_1)`$, about 1.3e7 for the example's weights",
        instead: "about 17.6 goes with the printed $`k0 = 7`$ at $`nu = 1`$; the closed form of the repaired chain gives 158.3 with \
                  $`k0 = 8.94`$",
        evidence,
        for_data,
    }
}
