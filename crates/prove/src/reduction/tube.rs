//! The tube in which the orbits of a family are, in the coordinates of a search (derivation, 13.2).

use nalgebra::DMatrix;

/// The tube in which the orbits of all members are, as a ball of y in some coordinates.
#[derive(Clone)]
pub(super) struct TubeOfFamily {
    /// L.
    pub(super) l: DMatrix<f64>,
    /// The largest r of the cells; 0 where there is one member.
    pub(super) radius: f64,
}

impl TubeOfFamily {
    /// r in other coordinates, at most.
    pub(super) fn radius_in(&self, l: &DMatrix<f64>) -> f64 {
        if self.radius == 0.0 || l.nrows() == 0 {
            return 0.0;
        }
        let change = l.clone().try_inverse().map(|inverse| inverse * &self.l);
        change.map_or(f64::INFINITY, |change| self.radius * change.singular_values().max())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `|y| <= r` with `x = L y` is `|y'| <= r |L'^-1 L|` with `x = L' y'`: half of it in coordinates of twice the size, the same in turned ones,
    /// and none where there is one member.
    #[test]
    fn the_tube_in_other_coordinates() {
        let l = DMatrix::from_row_slice(2, 2, &[2.0, 0.0, 1.0, 3.0]);
        let tube = TubeOfFamily { l: l.clone(), radius: 0.5 };
        let turn = DMatrix::from_row_slice(2, 2, &[0.6, -0.8, 0.8, 0.6]);
        let stretch = DMatrix::from_row_slice(2, 2, &[0.25, 0.0, 0.0, 1.0]);
        for (change, radius) in [(2.0 * &turn, 0.25), (turn, 0.5), (stretch, 2.0)] {
            assert!((tube.radius_in(&(&l * change)) - radius).abs() < 1e-14, "{radius}");
        }
        assert_eq!(TubeOfFamily { l: l.clone(), radius: 0.0 }.radius_in(&l), 0.0);
        assert_eq!(tube.radius_in(&DMatrix::zeros(2, 2)), f64::INFINITY);
    }
}
