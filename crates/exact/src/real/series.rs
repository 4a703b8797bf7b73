//! The series of [`super::Real::oscillator_sum`] for small arguments.

/// `|B_{2k+4}|/(2k+4)!` = 2 zeta(2k+4)/(2 pi)^{2k+4}, k = 0, 1, ...: with alternating signs, the coefficients of y^{2k} in
/// [`super::Real::oscillator_sum`], which converges for y < 2 pi.
pub(super) const COEFFICIENTS: [(i64, i64); 8] = [
    (1, 720),
    (-1, 30_240),
    (1, 1_209_600),
    (-1, 47_900_160),
    (691, 1_307_674_368_000),
    (-1, 74_724_249_600),
    (3617, 10_670_622_842_880_000),
    (-43_867, 5_109_094_217_170_944_000),
];

#[cfg(test)]
mod tests {
    use super::COEFFICIENTS;
    use crate::number::bernoulli_over_factorial;
    use rug::Rational;

    #[test]
    fn coefficients_are_those_of_bernoulli() {
        // B_2k/(2k)! from k = 2 on; its sign alternates from a negative one.
        let numbers = bernoulli_over_factorial(COEFFICIENTS.len() + 1);
        for (coefficient, number) in COEFFICIENTS.into_iter().zip(&numbers[1..]) {
            assert_eq!(-Rational::from(coefficient), *number);
        }
    }
}
