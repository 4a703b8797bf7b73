//! The nodes of the Radau IIA method with seven stages, and integrals of its polynomials against rotations.

/// Stages.
pub(super) const STAGES: usize = 7;

/// The nodes c: the zeros of P_7(2 c - 1) - P_6(2 c - 1) with Legendre polynomials. The last is 1: the method is of order
/// 13, and it damps what is much faster than a step (it is L-stable).
pub(super) const NODES: [f64; STAGES] = [
    0.029_316_427_159_784_892,
    0.148_078_599_668_484_3,
    0.336_984_690_281_154_3,
    0.558_671_518_771_550_1,
    0.769_233_862_030_054_5,
    0.926_945_671_319_741_1,
    1.0,
];

/// Points of the rule of Gauss that the integrals are computed with: exact to degree 31, which is far beyond rounding for
/// polynomials of degree 6 against rotations by a few radians.
const POINTS: usize = 16;

/// The points in (0, 1) and weights of the rule of Gauss, by Newton's method from Tricomi's estimates.
fn gauss() -> [(f64, f64); POINTS] {
    std::array::from_fn(|index| {
        let n = POINTS as f64;
        let mut x = libm::cos(std::f64::consts::PI * (index as f64 + 0.75) / (n + 0.5));
        let mut slope = 1.0;
        // Quadratic from a start that is good to three digits.
        for _ in 0..8 {
            let (mut last, mut value) = (1.0, x);
            for k in 2..=POINTS {
                let k = k as f64;
                (last, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * last) / k);
            }
            slope = n * (x * value - last) / (x * x - 1.0);
            x -= value / slope;
        }
        (0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope))
    })
}

/// The polynomials that are 1 at one of the nodes and 0 at the others, at x.
pub(super) fn cardinals(x: f64) -> [f64; STAGES] {
    std::array::from_fn(|j| {
        let others = NODES.iter().enumerate().filter(|(k, _)| *k != j);
        others.fold(1.0, |product, (_, node)| product * (x - node) / (NODES[j] - node))
    })
}

/// The weights of a value at 0 and of values at the nodes in the polynomial of degree 7 through them, at x.
pub(super) fn interpolation(x: f64) -> (f64, [f64; STAGES]) {
    let first = NODES.iter().fold(1.0, |product, node| product * (x - node) / -node);
    let mut others = cardinals(x);
    others.iter_mut().zip(NODES).for_each(|(weight, node)| *weight *= x / node);
    (first, others)
}

/// Integrals over (0, end) of the polynomials of [`cardinals`].
pub(super) struct Integrals {
    end: f64,
    /// Points, and the polynomials there times the weights.
    points: [(f64, [f64; STAGES]); POINTS],
}

impl Integrals {
    pub(super) fn new(end: f64) -> Integrals {
        let points = gauss().map(|(point, weight)| {
            let place = end * point;
            (place, cardinals(place).map(|value| end * weight * value))
        });
        Integrals { end, points }
    }

    /// The integrals of the polynomials themselves.
    pub(super) fn plain(&self) -> [f64; STAGES] {
        std::array::from_fn(|j| self.points.iter().map(|(_, values)| values[j]).sum())
    }

    /// The integrals against cos((end - x) angle), and against sin((end - x) angle).
    pub(super) fn against_rotation(&self, angle: f64) -> [[f64; STAGES]; 2] {
        let mut integrals = [[0.0; STAGES]; 2];
        for (place, values) in &self.points {
            let (sine, cosine) = libm::sincos((self.end - place) * angle);
            for (j, value) in values.iter().enumerate() {
                integrals[0][j] += cosine * value;
                integrals[1][j] += sine * value;
            }
        }
        integrals
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_method_has_the_conditions_of_its_order() {
        // Quadrature of order 2 s - 1, and collocation.
        let weights = Integrals::new(1.0).plain();
        for k in 1..2 * STAGES {
            let sum: f64 = weights.iter().zip(NODES).map(|(weight, node)| weight * node.powi(k as i32 - 1)).sum();
            assert!((sum - 1.0 / k as f64).abs() < 1e-15, "{k}: {sum}");
        }
        for end in NODES {
            let row = Integrals::new(end).plain();
            for k in 1..=STAGES as i32 {
                let sum: f64 = row.iter().zip(NODES).map(|(weight, node)| weight * node.powi(k - 1)).sum();
                assert!((sum - end.powi(k) / f64::from(k)).abs() < 1e-15, "{end} {k}");
            }
        }
    }

    #[test]
    fn rotations_are_integrated() {
        // The polynomial 1 is the sum of all: the integrals are sin(end angle)/angle and (1 - cos(end angle))/angle.
        for (end, angle) in [(1.0, 4.0), (0.4, 0.1), (0.77, -3.0), (1.0, 1e-9)] {
            let [cosines, sines] = Integrals::new(end).against_rotation(angle);
            let (cosine, sine): (f64, f64) = (cosines.iter().sum(), sines.iter().sum());
            let half: f64 = 0.5 * end * angle;
            assert!((cosine - (end * angle).sin() / angle).abs() < 1e-15, "{end} {angle}");
            assert!((sine - 2.0 * half.sin().powi(2) / angle).abs() < 1e-15, "{end} {angle}");
        }
    }

    #[test]
    fn polynomials_of_degree_seven_are_interpolated() {
        for x in [0.0, 0.3, 0.9, 1.0] {
            let (first, others) = interpolation(x);
            let value = |x: f64| 1.0 - x + 3.0 * x.powi(7);
            let sum: f64 = others.iter().zip(NODES).map(|(weight, node)| weight * value(node)).sum();
            assert!((first * value(0.0) + sum - value(x)).abs() < 1e-14, "{x}");
        }
    }
}
