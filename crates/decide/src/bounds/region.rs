//! The tube on which bounds are asked for.

use rug::Rational;
use sigmastar_lang::spec::OrbitCurve;
use sigmastar_matrix::inverse;
use thiserror::Error;

/// Coordinates and orbit: `G(X,E)` is `|L^-1 (x - xb(t;p))| <= X + r`, `|e| <= E` (derivation, 11.1), for every p of a family's box.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Region {
    matrix: Vec<Vec<Rational>>,
    inverse: Vec<Vec<Rational>>,
    orbit: OrbitCurve,
    radius: Rational,
}

/// Why numbers are no region.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum RegionError {
    /// Sizes that do not fit.
    #[error("L and the orbit have not the number of states of the plant")]
    Shape,
    /// No inverse.
    #[error("L is not invertible")]
    Singular,
    /// A negative radius.
    #[error("the radius r around the orbit is negative")]
    Radius,
}

impl Region {
    /// The tube of radius r around an orbit, in coordinates L.
    ///
    /// # Errors
    /// Sizes that do not fit, an L without inverse, a negative radius.
    pub fn new(
        matrix: Vec<Vec<Rational>>,
        orbit: impl Into<OrbitCurve>,
        radius: Rational,
    ) -> Result<Region, RegionError> {
        let orbit = orbit.into();
        let order = matrix.len();
        let fits = |vector: &Vec<Rational>| vector.len() == order;
        if !matrix.iter().all(fits) || !orbit.parts().flat_map(|curve| curve.parts()).all(fits) {
            return Err(RegionError::Shape);
        }
        if radius < 0 {
            return Err(RegionError::Radius);
        }
        let inverse = inverse(&matrix).ok_or(RegionError::Singular)?;
        Ok(Region { matrix, inverse, orbit, radius })
    }

    /// The number of states.
    #[must_use]
    pub fn states(&self) -> usize {
        self.matrix.len()
    }

    /// The rows of L.
    #[must_use]
    pub fn matrix(&self) -> &[Vec<Rational>] {
        &self.matrix
    }

    /// The rows of the inverse of L.
    #[must_use]
    pub fn inverse(&self) -> &[Vec<Rational>] {
        &self.inverse
    }

    /// xb.
    #[must_use]
    pub fn orbit(&self) -> &OrbitCurve {
        &self.orbit
    }

    /// r.
    #[must_use]
    pub fn radius(&self) -> &Rational {
        &self.radius
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sigmastar_lang::spec::TrigonometricVector;

    fn rows(entries: &[&[i32]]) -> Vec<Vec<Rational>> {
        entries.iter().map(|row| row.iter().map(|entry| Rational::from(*entry)).collect()).collect()
    }

    #[test]
    fn the_inverse_is_exact() {
        let region = |entries: &[&[i32]]| {
            let orbit = TrigonometricVector::constant(vec![Rational::new(); entries.len()]);
            Region::new(rows(entries), orbit, Rational::from(1))
        };
        assert_eq!(region(&[&[0, 1], &[1, 1]]).unwrap().inverse(), rows(&[&[-1, 1], &[1, 0]]));
        assert_eq!(region(&[]).unwrap().states(), 0);
        assert_eq!(region(&[&[1, 2], &[2, 4]]), Err(RegionError::Singular));
        assert_eq!(region(&[&[1, 2]]), Err(RegionError::Shape));
    }
}
