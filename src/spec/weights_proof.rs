//! Proof that weights satisfy W1-W3 and decrease strictly, or the first l at which they do not.
//!
//! The transfer bound, and with it every claim for all n_o, rests on these conditions.

use super::quantity::Quantity;
use super::weights::Weights;
use crate::enclosure::{MAX_PRECISION, Truth};
use rug::Rational;

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
