//! The numbers of Euler-Maclaurin sums.

use rug::{Complete, Integer, Rational};

/// `B_2k/(2k)!` for k = 1, ..., `count`, exactly, from the tangent numbers T_k: `B_2k = (-1)^(k-1) 2k T_k/(4^k (4^k - 1))`.
/// The tangent numbers come by Brent and Harvey's recurrence in small integer steps.
#[must_use]
pub fn bernoulli_over_factorial(count: usize) -> Vec<Rational> {
    let mut tangent: Vec<Integer> = Vec::with_capacity(count);
    let mut value = Integer::from(1);
    for k in 0..count {
        if k > 0 {
            value *= k as u64;
        }
        tangent.push(value.clone());
    }
    for k in 1..count {
        for j in k..count {
            let left = (&tangent[j - 1] * (j - k) as u64).complete();
            tangent[j] *= (j - k + 2) as u64;
            tangent[j] += left;
        }
    }
    let mut factorial = Integer::from(1);
    let mut result = Vec::with_capacity(count);
    for (index, tangent) in tangent.into_iter().enumerate() {
        let k = index as u32 + 1;
        factorial *= 2 * k - 1;
        // (2k)! = 2k (2k-1)!, and the 2k cancels against the one in the numerator.
        let four = Integer::from(1) << (2 * k);
        let denominator = (&four * (four.clone() - 1u32)) * &factorial;
        let magnitude = Rational::from((tangent, denominator));
        result.push(if k % 2 == 1 { magnitude } else { -magnitude });
        factorial *= 2 * k;
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bernoulli_numbers_are_the_known_ones() {
        let known = [(1, 6), (-1, 30), (1, 42), (-1, 30), (5, 66), (-691, 2730), (7, 6), (-3617, 510)];
        let mut factorial = Integer::from(1);
        for (index, (value, known)) in bernoulli_over_factorial(8).into_iter().zip(known).enumerate() {
            let k = index as u32 + 1;
            factorial *= (2 * k - 1) * (2 * k);
            assert_eq!(value * &factorial, Rational::from(known), "B_{}", 2 * k);
        }
    }
}
