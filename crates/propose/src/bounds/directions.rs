//! Along which directions of y the first derivatives change, in doubles: boxes are few where they change along few axes. It
//! proposes, and nothing rests on it.

use super::suprema::FloatSuprema;
use sigmastar_matrix::doubles::eigen;

/// Times of a period.
const TIMES: usize = 16;

/// Both components of a direction between two axes.
const BETWEEN: [[f64; 2]; 4] = {
    const HALF: f64 = std::f64::consts::FRAC_1_SQRT_2;
    [[HALF, HALF], [HALF, -HALF], [-HALF, HALF], [-HALF, -HALF]]
};

/// How the first derivatives change on a tube.
#[derive(Clone, Debug)]
pub struct Directions {
    /// The sum over all derivatives of how much they change along each axis, in units of their own size.
    pub along_axes: f64,
    /// Orthonormal columns: the directions along which they change, the first the most.
    pub principal: Vec<Vec<f64>>,
}

impl FloatSuprema {
    /// How J, g, r and d change on `|y| <= X`, `|e| <= E`.
    #[must_use]
    pub fn directions(&self, at: [f64; 2]) -> Directions {
        let n = self.states();
        let axis = |i: usize, sign: f64| (0..n).map(|j| if i == j { sign } else { 0.0 }).collect::<Vec<f64>>();
        let mut rays: Vec<Vec<f64>> = (0..n).flat_map(|i| [axis(i, 1.0), axis(i, -1.0)]).collect();
        for (i, j) in (0..n).flat_map(|i| (0..i).map(move |j| (i, j))) {
            rays.extend(BETWEEN.map(|[own, other]| {
                let mut ray = axis(i, own);
                ray[j] = other;
                ray
            }));
        }
        // With this weight of the axes the fourth moments of all rays are those of a sphere: what changes along one direction alone
        // has it as an eigenvector.
        let of_an_axis = 2.0 - 0.5 * (n as f64).min(4.0);
        let (mut squares, mut changes) = (vec![vec![0.0; n]; n], Vec::<Vec<f64>>::new());
        let mut sizes: Vec<f64> = Vec::new();
        for (time, e) in (0..TIMES).flat_map(|i| [-1.0, 0.0, 1.0].map(|e| ((i as f64 + 0.5) / TIMES as f64, e))) {
            let points: Vec<(f64, Vec<f64>, f64)> =
                std::iter::once(vec![0.0; n]).chain(rays.iter().cloned()).map(|y| (time, y, e)).collect();
            let mut values: Vec<Vec<f64>> = Vec::new();
            self.largest_of_derivatives_at(at, &points, |derivatives, _| {
                let all = [derivatives.j, derivatives.g, derivatives.r, &[derivatives.d]];
                values.push(all.concat());
                0.0
            });
            let [middle, others @ ..] = &values[..] else { continue };
            sizes.resize(middle.len(), 0.0);
            for value in &values {
                sizes.iter_mut().zip(value).for_each(|(size, value)| *size = size.max(value.abs()));
            }
            changes.extend(others.iter().map(|value| value.iter().zip(middle).map(|(a, b)| a - b).collect()));
        }
        // Derivatives of one kind have one size.
        let blocks = [0..n * n, n * n..n * n + n, n * n + n..n * n + 2 * n, n * n + 2 * n..n * n + 2 * n + 1];
        for block in blocks {
            let largest = sizes[block.clone()].iter().copied().fold(0.0, f64::max);
            sizes[block].iter_mut().for_each(|size| *size = if largest > 0.0 { largest } else { 1.0 });
        }
        let mut along_axes = 0.0;
        for (change, ray) in changes.iter().zip(rays.iter().cycle()) {
            let square: f64 = change.iter().zip(&sizes).map(|(a, size)| (a / size) * (a / size)).sum();
            let is_axis = ray.iter().filter(|entry| **entry != 0.0).count() == 1;
            let weight = if is_axis { of_an_axis * square } else { square };
            for (row, a) in squares.iter_mut().zip(ray) {
                row.iter_mut().zip(ray).for_each(|(entry, b)| *entry += weight * a * b);
            }
            if is_axis {
                along_axes += change.iter().zip(&sizes).map(|(a, size)| a.abs() / size).sum::<f64>();
            }
        }
        let (values, vectors) = eigen(squares);
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by(|&a, &b| values[b].total_cmp(&values[a]));
        let principal = (0..n).map(|i| order.iter().map(|&k| vectors[i][k]).collect()).collect();
        Directions { along_axes, principal }
    }
}
