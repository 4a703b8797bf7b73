//! The transfer T_N itself, and the paper's constants for it.

use super::numbers::{integer, quotient};
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_theory::data::Data;
use sigmastar_theory::transfer::{PrintedTransfer, closed_form_pair, printed_transfer};

/// T_N at x with x^2 = `square`, exactly, for rational weights n_0, ..., n_N; `square` is none of 0, 1, 4, ..., N^2.
///
/// In terms of X = x^2: g_N^2 = X (sum n_l/(l^2 - X))^2 and g_N' = sum n_l (l^2 + X)/(l^2 - X)^2.
pub(super) fn transfer(weights: &[Rational], nu_squared: &Rational, square: &Rational) -> Rational {
    let (slope, g_squared) = pole_sums(weights, square);
    slope / (Rational::from(1) + g_squared * nu_squared)
}

/// (g_N', g_N^2) at x^2 = `square`, exactly.
pub(super) fn pole_sums(weights: &[Rational], square: &Rational) -> (Rational, Rational) {
    let (mut sum, mut slope) = (Rational::new(), Rational::new());
    for (l, weight) in (0u32..).zip(weights) {
        let pole = Rational::from(l) * l;
        let distance = Rational::from(&pole - square);
        sum += Rational::from(weight / &distance);
        slope += Rational::from(&pole + square) * weight / Rational::from(distance.square_ref());
    }
    (slope, Rational::from(sum.square_ref()) * square)
}

/// The paper's constants of P:lemma:transfer_function for its weights (n_0 = 2, n_l = l^-1.5) and mu = 1.
pub(super) fn printed_example() -> PrintedTransfer {
    PrintedTransfer::new(&integer(2), &integer(1), &example_weight(2), &integer(1))
}

/// `l^-1.5`, the paper's n_l for l >= 1 in its example.
pub(super) fn example_weight(l: i64) -> Enclosure {
    let l = quotient(l, 1);
    (&l * l.sqrt()).recip()
}

/// The closed-form pair (k0, k1), pure numbers, and the bound of T_N on |x| <= 1/2 that its proof gives (case m = 0).
pub(super) struct ClosedForm {
    pub(super) k0: Enclosure,
    pub(super) k1: Enclosure,
    pub(super) near_zero: Enclosure,
}

impl ClosedForm {
    /// For n_0, n_1 and nu, valid for every number of oscillators.
    pub(super) fn new(n_0: &Enclosure, n_1: &Enclosure, nu: &Enclosure) -> ClosedForm {
        let inverse = nu.sqr().recip();
        let poles = (Enclosure::pi(n_0.precision()).sqr() - 4) / 2 * n_1;
        let at_zero = (&inverse + n_1.sqr()) / n_0;
        ClosedForm {
            k0: &poles + at_zero.max(&(4 * n_0 - 2 * n_1)),
            k1: 8 / n_1 * (inverse + (2 * n_0 + n_1 / 3).sqr()),
            near_zero: poles + at_zero,
        }
    }

    /// The three comparisons that prove T_N(x) <= big_0 + big_1 x^2 for every N and x: on |x| <= 1/2 T_N <= `near_zero`
    /// <= big_0; elsewhere k0 + k1 x^2 <= big_0 + big_1 x^2, if k1 <= big_1 and it holds at x = 1/2.
    pub(super) fn comparisons(
        &self,
        big_0: &Enclosure,
        big_1: &Enclosure,
    ) -> [(&'static str, Enclosure, Enclosure); 3] {
        [
            ("on $`|x| <= 1/2`$", self.near_zero.clone(), big_0.clone()),
            ("the coefficients of $`x^2`$", self.k1.clone(), big_1.clone()),
            ("at $`x = 1/2`$", &self.k0 + &self.k1 / 4, big_0 + big_1 / 4),
        ]
    }
}

/// Whether the printed pair bounds the true transfer (1/w^2) T_N(omega/w) for this data, in spite of E6 to E8:
/// `True` and `False` are proofs.
pub(super) fn printed_pair_holds(data: &Data<'_>) -> Truth {
    let printed = printed_transfer(data);
    let square = data.base_frequency.sqr();
    let (big_0, big_1) = (&printed.kappa_0 * &square, &printed.kappa_1 * square.sqr());
    let closed = ClosedForm::new(&data.n_0, &data.n_1, &data.nu);
    let holds = closed.comparisons(&big_0, &big_1).iter().fold(Truth::True, |all, (_, lhs, rhs)| all.and(lhs.le(rhs)));
    let refuted = data.transfer_at_zero().gt(&big_0);
    match (holds, refuted) {
        (Truth::True, _) => Truth::True,
        (_, Truth::True) => Truth::False,
        _ => Truth::Undecided,
    }
}

/// kappa_1 of the closed form in the units of omega: k1/w^4.
pub(super) fn proved_kappa_1(data: &Data<'_>) -> Enclosure {
    closed_form_pair(data).1 / data.base_frequency.sqr().sqr()
}
