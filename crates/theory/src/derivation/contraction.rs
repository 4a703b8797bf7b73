//! The contraction matrix of the existence proof, its spectral radius, Perron weights and the Jury pair.

use sigmastar_exact::real::{Operand, Real};

/// The nonnegative matrix `[[xx, xe], [ex, ee]]` with |(x+, e+)| differences <= matrix times differences
/// (P:eq:def_ypsilon), in sup norms. Entries xx, ee are pure numbers, xe has units |x|/|e|, ex |e|/|x|.
#[derive(Clone, Debug)]
pub struct ContractionMatrix<R> {
    /// Upsilon_xx.
    pub xx: R,
    /// Upsilon_xe.
    pub xe: R,
    /// Upsilon_ex.
    pub ex: R,
    /// Upsilon_ee.
    pub ee: R,
}

impl<R: Real> ContractionMatrix<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// The trace.
    #[must_use]
    pub fn trace(&self) -> R {
        &self.xx + &self.ee
    }

    /// The determinant, negative for the matrices that arise from strong cross couplings.
    #[must_use]
    pub fn determinant(&self) -> R {
        &self.xx * &self.ee - &self.xe * &self.ex
    }

    /// The spectral radius `tr/2 + sqrt(((xx - ee)/2)^2 + xe ex)`, exact for nonnegative matrices (Perron-Frobenius).
    #[must_use]
    pub fn spectral_radius(&self) -> R {
        let half_difference = (&self.xx - &self.ee) / R::int(2);
        self.trace() / R::int(2) + (half_difference.sqr() + &self.xe * &self.ex).sqrt()
    }

    /// `1 - tr + det`, the first Jury quantity; positive together with `det < 1` if and only if the spectral radius
    /// of this nonnegative matrix is below 1.
    #[must_use]
    pub fn jury_first(&self) -> R {
        R::int(1) - self.trace() + self.determinant()
    }

    /// `1 - det`, the second Jury quantity as it should be.
    #[must_use]
    pub fn jury_second(&self) -> R {
        R::int(1) - self.determinant()
    }

    /// `1 + det`: what the printed second inequality `1 > -det` tests (P:eq:ypsilon_xx, erratum E5). It does not
    /// exclude a spectral radius above 1.
    #[must_use]
    pub fn jury_second_printed(&self) -> R {
        R::int(1) + self.determinant()
    }

    /// The two left sides of (C3), `xx p_x + ex p_e` to be below `p_x` and `xe p_x + ee p_e` to be below `p_e`
    /// (Collatz-Wielandt: for positive p this proves a spectral radius below 1).
    #[must_use]
    pub fn weighted_columns(&self, p_x: &R, p_e: &R) -> [R; 2] {
        [&self.xx * p_x + &self.ex * p_e, &self.xe * p_x + &self.ee * p_e]
    }

    /// Weights for which both left sides of (C3) are below p by the shares u, v: `p = (I - M')^-1 (u, v)`, positive where
    /// this matrix is a contraction and u, v are positive.
    #[must_use]
    pub fn perron_weights(&self, u: &R, v: &R) -> [R; 2] {
        let determinant = self.jury_first();
        let free = |entry: &R| R::int(1) - entry;
        [(free(&self.ee) * u + &self.ex * v) / &determinant, (&self.xe * u + free(&self.xx) * v) / determinant]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use rug::Rational;
    use sigmastar_exact::enclosure::{Enclosure, Truth};

    fn matrix(entries: [f64; 4]) -> ContractionMatrix<Enclosure> {
        let [xx, xe, ex, ee] = entries.map(|v| Enclosure::from_rational(&Rational::from_f64(v).unwrap(), 128));
        ContractionMatrix { xx, xe, ex, ee }
    }

    /// Whether the Jury pair proves a spectral radius below 1.
    fn by_jury(m: &ContractionMatrix<Enclosure>) -> Truth {
        m.jury_first().is_positive().and(m.jury_second().is_positive())
    }

    #[test]
    fn the_printed_test_passes_an_expansion() {
        // Erratum E5: [[2, 0.1], [0.1, 2]] has spectral radius 2.1.
        let m = matrix([2.0, 0.125, 0.125, 2.0]);
        assert!(m.jury_first().is_positive().is_true());
        assert!(m.jury_second_printed().is_positive().is_true());
        assert_eq!(by_jury(&m), Truth::False);
        assert_eq!(m.spectral_radius().midpoint_f64(), 2.125);
    }

    #[test]
    fn a_contraction_is_recognised() {
        let m = matrix([0.5, 2.0, 0.0625, 0.25]);
        assert_eq!(by_jury(&m), Truth::True);
        assert!(m.spectral_radius().lt(&Enclosure::one(128)).is_true());
        let [a, b] = m.weighted_columns(&Enclosure::one(128), &Enclosure::from_integer(4, 128));
        assert!(a.lt(&Enclosure::one(128)).is_true());
        assert!(b.lt(&Enclosure::from_integer(4, 128)).is_true());
    }

    proptest! {
        #[test]
        fn jury_and_spectral_radius_agree(xx in 0.0..2.0, xe in 0.0..2.0, ex in 0.0..2.0, ee in 0.0..2.0) {
            let m = matrix([xx, xe, ex, ee]);
            let by_radius = m.spectral_radius().lt(&Enclosure::one(128));
            let by_jury = by_jury(&m);
            prop_assert!(by_radius == by_jury || by_radius.is_undecided() || by_jury.is_undecided());
        }
    }
}
