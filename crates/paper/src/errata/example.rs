//! E18 to E22: the paper's example, its tables and its noise.

use super::evidence::Evidence;
use super::evidence::Relation::{Equal, Greater, GreaterOrEqual, Less};
use super::numbers::{integer, pi, power, quotient, ratio};
use super::{Bearing, Class, Erratum, ForData};
use rug::Rational;
use sigmastar_theory::data::{Bound, Data, Problem};

/// E18: the example has f(t,0,0) != 0.
pub(super) fn e18(data: Option<&Data<'_>>) -> Erratum {
    // At t = 0, exactly: sin 0 = 0, cos 0 = 1.
    let (sine, cosine) = (integer(0).sin(), integer(0).cos());
    let evidence = vec![
        Evidence::rigorous("the first component of $`f(0,0,0)`$, $`sin 0`$", (sine.clone(), Equal, 0)),
        Evidence::rigorous(
            "the second, $`cos 0 (1 + sin 0)`$, which the families need to be 0",
            (cosine * (1 + sine), Equal, 1),
        ),
    ];
    let for_data = data.map(|data| {
        let value = data.bound(Bound::F, &data.zero(), &data.zero());
        if value.is_exact() && value == data.zero() {
            ForData::new(Bearing::Harmless, "$`b_f(0,0) = 0`$, so $`f(t,0,0) = 0`$ holds").figure("$`b_f(0,0)`$", value)
        } else {
            ForData::new(
                Bearing::Depends,
                "$`f(t,0,0) = 0`$ is a hypothesis that $`b_f`$ does not imply; shift the plant first",
            )
            .figure("$`b_f(0,0)`$", value)
        }
    });
    Erratum {
        id: "E18",
        place: "P:eq:example",
        class: Class::AExample,
        printed: "\"the $`f`$, $`q`$ are included in the families\"",
        instead: "$`f(t,0,0) = (sin 2 pi t, cos 4 pi t (1 + sin 2 pi t))`$ is not 0; after the shift by the periodic solution of \
                  $`x' = f(t,x,0)`$ the example fits",
        evidence,
        for_data,
    }
}

/// A printed decimal `digits * 10^-places`, and half a unit of its last place.
fn printed(digits: i64, places: u32) -> (Rational, Rational) {
    let unit = power(&ratio(1, 10), places);
    (Rational::from(&unit * digits), unit / 2u32)
}

/// E19: the second column is an rms.
pub(super) fn e19() -> Erratum {
    let row = |name: &str, sup: (i64, u32), mean: (i64, u32)| {
        let ((sup, sup_half), (mean, mean_half)) = (printed(sup.0, sup.1), printed(mean.0, mean.1));
        // The smallest mean square and the largest supremum that round to the printed digits.
        let largest = sup + sup_half;
        Evidence::rigorous(
            format!(
                "{name}: the \"mean square\", less half a unit of its last place, against the square of the supremum, plus half a unit"
            ),
            (mean - mean_half, Greater, Rational::from(largest.square_ref())),
        )
    };
    let evidence = vec![
        row("first table, $`sigma = 40`$ (0.1181, 0.0572)", (1181, 4), (572, 4)),
        row("first table, $`sigma = 20`$ (0.2248, 0.1126)", (2248, 4), (1126, 4)),
        row("first table, $`sigma = 10`$ (0.400, 0.2166)", (400, 3), (2166, 4)),
        row("second table, $`2 pi`$, $`n_o = 1`$ (0.0917, 0.0549)", (917, 4), (549, 4)),
        row("second table, $`2 pi`$, $`n_o = 4`$ (3.04e-8, 1.66e-8)", (304, 10), (166, 10)),
        Evidence::cited(
            "simulation, $`sigma = 40`$: $`rms(e)`$, which rounds to the printed 0.0572",
            (ratio(5722, 100_000), Less, ratio(5725, 100_000)),
        ),
    ];
    Erratum {
        id: "E19",
        place: "P:table:high-gain, P:table:example-norms, second column",
        class: Class::C,
        printed: "$`(1/T) int e^2`$",
        instead: "its square root: a mean square cannot exceed the square of the supremum",
        evidence,
        for_data: None,
    }
}

/// E20: the weights of the tables.
pub(super) fn e20() -> Erratum {
    let evidence = vec![
        Evidence::rigorous("P:27 asks for $`n_1 < n_0`$; with $`n_0 = 1`$, $`n_1 = 1^-1.5`$", (1, GreaterOrEqual, 1)),
        Evidence::cited(
            "floating-point simulation (shooting): noise-free entries that agree with $`n_0 = 1`$ to the printed digits, out of 28",
            (28, Equal, 28),
        ),
        Evidence::cited(
            "the same with $`n_0 = 2`$: the largest relative difference (rms, $`0.95 * 2 pi`$, $`n_o = 2`$)",
            (ratio(558, 10_000), Greater, 0),
        ),
    ];
    Erratum {
        id: "E20",
        place: "P:table:example-norms, internal-model rows; P:eq:nzk",
        class: Class::C,
        printed: "$`n_z0 = 2`$",
        instead: "the entries were computed with $`n_z0 = 1`$, against P:27; a floating-point simulation shows it, which the \
                  reproduction of the tables repeats: it is not proved here",
        evidence,
        for_data: None,
    }
}

/// E21: a steady state that 150 seconds do not reach.
pub(super) fn e21() -> Erratum {
    let left = power(&ratio(940, 1000), 150);
    let evidence = vec![
        Evidence::cited(
            "with the slow multiplier 0.940 a period (from a simulation) a transient of 1/1000 is, after 150 periods, $`0.940^150/1000`$",
            (left / 1000u32, Greater, printed(304, 10).0),
        ),
        Evidence::cited(
            "simulation from the stated initial condition: the largest $`|e|`$ in the 150th period, against the printed one",
            (printed(150, 8).0, Greater, printed(304, 10).0),
        ),
        Evidence::cited("the exact steady state, by shooting", (printed(30_395, 12).0, Less, printed(3045, 11).0)),
    ];
    Erratum {
        id: "E21",
        place: "P:table:example-norms, row $`n_o = 4`$",
        class: Class::C,
        printed: "3.04e-8 and 1.66e-8 after a simulation of 150 s",
        instead: "the exact steady state; at $`t = 150 s`$ the transient still gives 1.5e-6",
        evidence,
        for_data: None,
    }
}

/// E22: the noise.
pub(super) fn e22() -> Erratum {
    // Noise power 1e-3 at the step 1e-5: variance 100.
    let variance = ratio(1, 1000) / ratio(1, 100_000);
    // P(|N| > 4) >= 2 phi(4) (1/4 - 1/64) for a standard normal N; (1 - p)^n <= e^(-p n), n = 150 s / 1e-5 s.
    let density = integer(-8).exp() / (2 * pi()).sqrt();
    let tail = 2 * density * (quotient(1, 4) - quotient(1, 64));
    let all_inside = (-(integer(15_000_000) * tail)).exp();
    let negligible = power(&ratio(1, 10), 400);
    let evidence = vec![
        Evidence::rigorous("the variance of the samples, noise power over step", (variance, Equal, 100)),
        Evidence::rigorous(
            "independent normal samples with deviation 10, before the filter: the probability that 150 s of them stay within 40 \
             is at most",
            (all_inside, Less, negligible),
        ),
        Evidence::cited(
            "simulation, after the filter, five seeds: the smallest $`sup|v|`$",
            (ratio(529, 10), Greater, 40),
        ),
        Evidence::cited(
            "stationary rms of $`e`$, $`n_o = 0`$: with $`u = -sigma(e+v) + ...`$, against the printed law",
            (ratio(31, 1000), Greater, ratio(12, 1000)),
        ),
    ];
    Erratum {
        id: "E22",
        place: "noise columns of both tables",
        class: Class::C,
        printed: "$`sup|v| <= 40`$; $`u = -sigma e + mu M'N [z - M (e+v)]`$",
        instead: "the stated noise has $`sup|v|`$ of 52 to 61 over 150 s, depending on the seed; $`u = -sigma (e+v) + ...`$ fits the columns \
                  better than the printed law: an indication from simulations, not a proof",
        evidence,
        for_data: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn printed_decimals() {
        assert_eq!(printed(1181, 4), (ratio(1181, 10_000), ratio(1, 20_000)));
        assert!(integer(0).sin().is_exact() && integer(0).cos().is_exact());
    }
}
