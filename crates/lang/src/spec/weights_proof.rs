//! Proof that weights satisfy W1-W3 and decrease strictly, or the first l at which they do not.
//!
//! The transfer bound, and with it every claim for all n_o, rests on these conditions.

use super::quantity::Quantity;
use super::weights::Weights;
use rug::Rational;
use sigmastar_exact::enclosure::{MAX_PRECISION, Truth};

/// The parameter of the family or the index of the list that breaks a condition.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Culprit {
    /// The field of this name.
    Field(&'static str),
    /// The listed value n_l.
    Listed(usize),
}

/// A condition on the weights that does not hold, or is not decided.
#[derive(Debug)]
pub(super) struct Failure {
    /// Which parameter or value to blame.
    pub(super) culprit: Culprit,
    /// Whether the condition is refuted, rather than undecided.
    pub(super) refuted: bool,
    /// The condition with its numbers, in one sentence.
    pub(super) message: String,
    /// What would satisfy it.
    pub(super) help: String,
}

impl Weights {
    /// Proves W1-W3 and n_0 > n_1 > ... > 0.
    ///
    /// Power family, n_l = l^-(1+epsilon): W1 for epsilon > 0; l n_l = l^-epsilon decreases; l^2 n_l = l^(1-epsilon)
    /// does not decrease for epsilon <= 1; n_l decreases strictly from n_1 = 1, so n_0 > 1 is what is left.
    ///
    /// Explicit list with tail c l^-p: for c > 0 and 1 < p <= 2 the tail satisfies the three by itself, as above. Left
    /// are W2 and W3 from l to l + 1 inside the list and from its last value to the tail, and n_0 > n_1. The rest of
    /// the strict decrease follows: by W2, n_(l+1) <= n_l l/(l+1) < n_l for l >= 1, since n_l > 0.
    ///
    /// # Errors
    /// The first condition that fails or cannot be decided.
    pub(super) fn prove(&self) -> Result<(), Failure> {
        let (zero, one, two) = (Quantity::rational(0), Quantity::rational(1), Quantity::rational(2));
        match self {
            Weights::Power { n0, epsilon } => {
                let (n0, epsilon) = (Quantity::constant(n0), Quantity::constant(epsilon));
                require(one.lt(&n0), Culprit::Field("n0"), || Statement {
                    condition: "n_0 > n_1".to_owned(),
                    numbers: format!("n_0 = {} and n_1 = 1", n0.shown()),
                    help: "choose n0 greater than 1, as in \"2\"".to_owned(),
                })?;
                require(zero.lt(&epsilon), Culprit::Field("epsilon"), || Statement {
                    condition: "W1 (the sum of n_l = l^-(1 + epsilon) is finite)".to_owned(),
                    numbers: format!("epsilon = {}", epsilon.shown()),
                    help: "choose epsilon in 0 < epsilon <= 1".to_owned(),
                })?;
                require(epsilon.le(&one), Culprit::Field("epsilon"), || Statement {
                    condition: "W3 at l = 1 (l^2 n_l = l^(1 - epsilon) does not decrease)".to_owned(),
                    numbers: format!("epsilon = {}", epsilon.shown()),
                    help: "choose epsilon in 0 < epsilon <= 1".to_owned(),
                })
            }
            Weights::Explicit { values, coefficient, exponent } => {
                let (coefficient, exponent) = (Quantity::constant(coefficient), Quantity::constant(exponent));
                require(zero.lt(&coefficient), Culprit::Field("coefficient"), || Statement {
                    condition: "coefficient > 0".to_owned(),
                    numbers: format!("coefficient = {}", coefficient.shown()),
                    help: "weights are positive numbers".to_owned(),
                })?;
                require(one.lt(&exponent), Culprit::Field("exponent"), || Statement {
                    condition: "W1 (the sum of n_l is finite)".to_owned(),
                    numbers: format!("exponent = {}", exponent.shown()),
                    help: "choose an exponent in 1 < exponent <= 2".to_owned(),
                })?;
                require(exponent.le(&two), Culprit::Field("exponent"), || Statement {
                    condition: format!("W3 at l = {} (l^2 n_l does not decrease)", values.len()),
                    numbers: format!("exponent = {}", exponent.shown()),
                    help: "choose an exponent in 1 < exponent <= 2".to_owned(),
                })?;
                for l in 0..values.len() {
                    let value = self.quantity(l as u64);
                    require(zero.lt(&value), Culprit::Listed(l), || Statement {
                        condition: format!("n_{l} > 0"),
                        numbers: format!("n_{l} = {}", value.shown()),
                        help: "weights are positive numbers".to_owned(),
                    })?;
                }
                self.prove_first_step(values.len())?;
                (1..values.len()).try_for_each(|l| self.prove_step(l, values.len()))
            }
        }
    }

    /// n_0 > n_1, where n_1 belongs to the tail if n_0 alone is listed.
    fn prove_first_step(&self, length: usize) -> Result<(), Failure> {
        let (n0, n1) = (self.quantity(0), self.quantity(1));
        require(n1.lt(&n0), Culprit::Listed(0), || {
            let (n0, n1) = n0.shown_apart(&n1);
            Statement {
                condition: "n_0 > n_1".to_owned(),
                numbers: format!("n_0 = {n0} and n_1 = {n1}{}", origin(1, length)),
                help: format!("choose n_0 greater than {n1}"),
            }
        })
    }

    /// W2 and W3 from l >= 1 to l + 1, which belongs to the tail if l is the last listed index.
    fn prove_step(&self, l: usize, length: usize) -> Result<(), Failure> {
        let next = l + 1;
        // Where the list meets the tail, the last listed value is the one to mend.
        let culprit = Culprit::Listed(next.min(length - 1));
        let (m, m1) = (l as u64, next as u64);
        let scaled = |index: u64, factor: u64| self.quantity(index).times(Quantity::rational(factor));
        // From W2 and W3: (l/(l+1))^2 n_l <= n_(l+1) <= l/(l+1) n_l.
        let help = || {
            let ratio = Rational::from((m, m1));
            let low = self.quantity(m).times(Quantity::rational(Rational::from(ratio.square_ref())));
            let high = self.quantity(m).times(Quantity::rational(ratio));
            format!("with this n_{l}, n_{next} must lie between {} and {}", low.shown(), high.shown())
        };
        let (here, there) = (scaled(m, m), scaled(m1, m1));
        require(there.le(&here), culprit, || {
            let (here, there) = here.shown_apart(&there);
            Statement {
                condition: format!("W2 at l = {l} (l n_l does not increase)"),
                numbers: format!("{l} n_{l} = {here} and {next} n_{next} = {there}{}", origin(next, length)),
                help: help(),
            }
        })?;
        let (here, there) = (scaled(m, m * m), scaled(m1, m1 * m1));
        require(here.le(&there), culprit, || {
            let (here, there) = here.shown_apart(&there);
            Statement {
                condition: format!("W3 at l = {l} (l^2 n_l does not decrease)"),
                numbers: format!("{l}^2 n_{l} = {here} and {next}^2 n_{next} = {there}{}", origin(next, length)),
                help: help(),
            }
        })
    }
}

/// A condition in words, for the case that it is not proved.
struct Statement {
    condition: String,
    numbers: String,
    help: String,
}

/// Says of a weight past the list that it is not listed.
fn origin(l: usize, length: usize) -> &'static str {
    if l < length { "" } else { " (from the tail)" }
}

fn require(holds: Truth, culprit: Culprit, state: impl FnOnce() -> Statement) -> Result<(), Failure> {
    if holds.is_true() {
        return Ok(());
    }
    let Statement { condition, numbers, help } = state();
    Err(if holds.is_false() {
        Failure { culprit, refuted: true, message: format!("{condition} fails: {numbers}"), help }
    } else {
        let message = format!("{condition} cannot be decided at {MAX_PRECISION} bits: {numbers}");
        let help = format!("write the numbers in a form that is compared exactly, or leave a margin; {help}");
        Failure { culprit, refuted: false, message, help }
    })
}

#[cfg(test)]
mod tests {
    use super::super::parts::Constant;
    use super::*;
    use crate::expr::{Expr, Variables};

    fn constant(text: &str) -> Constant {
        let expr = Expr::parse(text, Variables::None).unwrap();
        Constant { text: text.to_owned(), exact: expr.exact(), expr }
    }

    fn power(n0: &str, epsilon: &str) -> Weights {
        Weights::Power { n0: constant(n0), epsilon: constant(epsilon) }
    }

    fn explicit(values: &[&str], coefficient: &str, exponent: &str) -> Weights {
        Weights::Explicit {
            values: values.iter().map(|text| constant(text)).collect(),
            coefficient: constant(coefficient),
            exponent: constant(exponent),
        }
    }

    /// Whether it was refuted, whom to blame, and how the message starts.
    fn fails(weights: &Weights) -> (bool, Culprit, String) {
        let failure = weights.prove().unwrap_err();
        (failure.refuted, failure.culprit, failure.message)
    }

    #[test]
    fn power_family_on_both_sides_of_its_limits() {
        for (n0, epsilon) in [("2", "1/2"), ("1.0000000001", "1"), ("100", "1e-6"), ("pi", "pi - 3"), ("2", "exp(-1)")]
        {
            assert!(power(n0, epsilon).prove().is_ok(), "{n0} {epsilon}");
        }
        for (n0, epsilon, culprit, start) in [
            ("1", "1/2", "n0", "n_0 > n_1 fails"),
            ("0.5", "1/2", "n0", "n_0 > n_1 fails"),
            ("2", "0", "epsilon", "W1"),
            ("2", "-1/2", "epsilon", "W1"),
            ("2", "1.0000000001", "epsilon", "W3 at l = 1"),
            ("2", "pi - 2", "epsilon", "W3 at l = 1"),
        ] {
            let (refuted, blamed, message) = fails(&power(n0, epsilon));
            assert!(refuted && blamed == Culprit::Field(culprit) && message.starts_with(start), "{message}");
        }
        let (refuted, blamed, message) = fails(&power("2", "exp(log(2)) - 1"));
        assert!(!refuted && blamed == Culprit::Field("epsilon") && message.contains("cannot be decided"), "{message}");
    }

    #[test]
    fn lists_on_both_sides_of_their_limits() {
        // Each pair differs in one number, which the accepted one has at its limit where W2 and W3 allow equality.
        type Case = (&'static [&'static str], &'static str, &'static str);
        let pairs: [(Case, Case, Culprit, &str); 10] = [
            // W2 inside: 2 n_2 <= n_1.
            (
                (&["2", "1", "1/2", "2/9"], "1", "3/2"),
                (&["2", "1", "0.5000000001", "2/9"], "1", "3/2"),
                Culprit::Listed(2),
                "W2 at l = 1",
            ),
            // W3 inside: 4 n_2 >= n_1.
            (
                (&["2", "1", "1/4", "1/9"], "1", "2"),
                (&["2", "1", "0.2499999999", "1/9"], "1", "2"),
                Culprit::Listed(2),
                "W3 at l = 1",
            ),
            // W2 at the junction: 3 c 3^-(3/2) <= 2 n_2 with irrational equality c = sqrt(3), n_2 = 1/2.
            (
                (&["2", "1", "1/2"], "sqrt(3)", "3/2"),
                (&["2", "1", "1/2"], "sqrt(3) + 1e-30", "3/2"),
                Culprit::Listed(2),
                "W2 at l = 2",
            ),
            // W3 at the junction: 4 n_2 <= c.
            (
                (&["2", "1", "1/4"], "1", "2"),
                (&["2", "1", "1/4"], "0.9999999999", "2"),
                Culprit::Listed(2),
                "W3 at l = 2",
            ),
            // A list of one: the tail begins at l = 1.
            ((&["2"], "1.9999999999", "3/2"), (&["2"], "2", "3/2"), Culprit::Listed(0), "n_0 > n_1"),
            ((&["2", "1.9999999999"], "2", "3/2"), (&["2", "2"], "2", "3/2"), Culprit::Listed(0), "n_0 > n_1"),
            ((&["2", "1"], "1", "2"), (&["2", "1"], "1", "2.0000000001"), Culprit::Field("exponent"), "W3"),
            ((&["2", "1"], "1", "1.0000000001"), (&["2", "1"], "1", "1"), Culprit::Field("exponent"), "W1"),
            ((&["2", "1"], "1", "3/2"), (&["2", "1"], "0", "3/2"), Culprit::Field("coefficient"), "coefficient > 0"),
            ((&["2", "1"], "1", "3/2"), (&["2", "0"], "1", "3/2"), Culprit::Listed(1), "n_1 > 0"),
        ];
        for (good, bad, culprit, start) in pairs {
            let accepted = explicit(good.0, good.1, good.2).prove();
            assert!(accepted.is_ok(), "{good:?} {accepted:?}");
            let (refuted, blamed, message) = fails(&explicit(bad.0, bad.1, bad.2));
            assert!(refuted && blamed == culprit && message.starts_with(start), "{bad:?} {blamed:?} {message}");
        }
    }

    #[test]
    fn messages_carry_both_numbers() {
        let message = |weights: &Weights| fails(weights).2;
        assert_eq!(
            message(&explicit(&["2", "1", "0.6"], "1", "3/2")),
            "W2 at l = 1 (l n_l does not increase) fails: 1 n_1 = 1 and 2 n_2 = 1.2"
        );
        assert_eq!(
            message(&explicit(&["2", "1", "0.3"], "1/3", "3/2")),
            "W3 at l = 2 (l^2 n_l does not decrease) fails: 2^2 n_2 = 1.2 and 3^2 n_3 = 0.5773502691... (from the tail)"
        );
        let help = explicit(&["2", "1", "0.6"], "1", "3/2").prove().unwrap_err().help;
        assert_eq!(help, "with this n_1, n_2 must lie between 0.25 and 0.5");
    }

    #[test]
    fn an_equality_without_exact_form_is_not_decided() {
        let weights = explicit(&["2", "exp(log(2))/2", "1/2"], "1", "3/2");
        let (refuted, blamed, message) = fails(&weights);
        assert!(!refuted && blamed == Culprit::Listed(2), "{message}");
        assert!(message.contains("cannot be decided at 1024 bits"));
        // With a margin it is decided, exact form or not.
        assert!(explicit(&["2", "exp(log(2))/2", "0.4"], "1", "3/2").prove().is_ok());
        assert!(explicit(&["exp(1)", "exp(0.5)", "exp(-0.5)"], "1.5", "7/5").prove().is_ok());
    }
}
