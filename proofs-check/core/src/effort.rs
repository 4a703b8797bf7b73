//! How much work an answer may take, counted in steps and never in time: the same file gets the same answer everywhere.
//!
//! Every operation on intervals is paid for, in proportion to what it costs at its precision. When all is spent, every
//! operation gives the undefined interval, of which nothing can be proved or refuted; whoever asks then says `undecided`.
//! So no rule, whatever a file makes it do, works for longer than the sum allows.

use std::cell::Cell;

/// What a claim may cost, and again what is proposed for it: half a minute of arithmetic. The shipped plants take a quarter of it at
/// most.
pub const LIMIT: u64 = 800_000_000;

/// What an operation of MPFR costs for each word of the precision, where a sum of doubles costs 1.
const WORD: u64 = 8;

thread_local! {
    /// What is left; unlimited outside of [`limited`], for whoever uses an interval by itself.
    static LEFT: Cell<u64> = const { Cell::new(u64::MAX) };
    /// What is left for proposals.
    static ASIDE: Cell<u64> = const { Cell::new(u64::MAX) };
}

fn words(precision: u32) -> u64 {
    u64::from(precision).div_ceil(64)
}

/// Pays for a sum, product or quotient of MPFR.
pub fn arithmetic(precision: u32) -> bool {
    spend(WORD * words(precision))
}

/// Pays for an elementary function at both ends, whose cost grows with the square of the precision.
pub fn elementary(precision: u32) -> bool {
    let words = words(precision);
    spend(WORD * (20 * words + 24 * words * words))
}

/// Pays for what the zeta function costs more: its cost grows with the cube.
pub fn zeta(precision: u32) -> bool {
    spend(WORD * 400 * words(precision).pow(3))
}

/// Pays for operations of doubles, a sum one step; `false` when nothing is left.
pub fn spend(steps: u64) -> bool {
    LEFT.with(|left| {
        let rest = left.get();
        if rest == u64::MAX {
            return true;
        }
        left.set(rest.saturating_sub(steps));
        rest > steps
    })
}

/// Whether everything is spent, by the claim or by its proposals.
pub fn exhausted() -> bool {
    spent() || ASIDE.with(|left| left.get() == 0)
}

/// Whether the claim itself has spent everything: then some operation of it gave the undefined interval.
pub fn spent() -> bool {
    LEFT.with(|left| left.get() == 0)
}

/// Answers a question with at most `steps` steps, and as many for proposals; also says how many the answer itself took.
pub fn limited<T>(steps: u64, question: impl FnOnce() -> T) -> (T, u64) {
    let before = [&LEFT, &ASIDE].map(|left| left.with(|left| left.replace(steps)));
    let answer = question();
    let [left, _] =
        [(&LEFT, before[0]), (&ASIDE, before[1])].map(|(left, before)| left.with(|left| left.replace(before)));
    (answer, steps - left)
}

/// Makes a proposal, which is paid for apart: what it costs takes nothing from the answer.
pub fn aside<T>(proposal: impl FnOnce() -> T) -> T {
    let exchange = || LEFT.with(|left| ASIDE.with(|aside| left.swap(aside)));
    exchange();
    let answer = proposal();
    exchange();
    answer
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interval::Interval;

    #[test]
    fn what_is_spent_proves_nothing() {
        let two = Interval::int(2, 128);
        let (sum, steps) = limited(LIMIT, || &two + &two);
        assert!(sum.is_point() && steps == 2 * WORD, "{steps}");
        let enough = 3 * WORD;
        let ((first, second, done), steps) = limited(enough, || (&two + &two, &two * &two, exhausted()));
        assert!(first.is_point() && !second.is_defined() && done);
        assert_eq!(steps, enough);
        assert_eq!(second.lt(&first), None);
        // Outside, nothing is limited.
        assert!(!exhausted() && (&two * &two).is_point());
    }

    #[test]
    fn doubles_are_paid_for_too() {
        let two = Interval::int(2, 53);
        type Operation = fn(&Interval) -> Interval;
        let operations: [(u64, Operation); 8] = [
            (1, |x| x + x),
            (2, |x| x * x),
            (2, |x| x / x),
            (1, |x| x - 1),
            (4, Interval::sqr),
            (2, Interval::sqrt),
            (8, |x| x.powi(3)),
            (28, |x| x.powi(8)),
        ];
        for (cost, f) in operations {
            let ((first, second), steps) = limited(2 * cost, || (f(&two), f(&two)));
            assert!(first.is_defined() && !second.is_defined());
            assert_eq!(steps, 2 * cost);
        }
    }

    #[test]
    fn functions_and_precision_cost_more() {
        let two = |p| Interval::int(2, p);
        let steps = |p| limited(LIMIT, || two(p).exp()).1;
        let sum = |p| limited(LIMIT, || two(p) + two(p)).1;
        assert!(sum(128) < steps(128) && 32 * steps(128) < steps(4096) && sum(128) < sum(4096));
    }
}
