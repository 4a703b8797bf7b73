//! Points at which bounds are held against what they bound; the tests of other crates that do the same include this file.

/// Points of the cube, t/T, y in the unit ball and e/E, with a bias to the boundary.
pub fn random_points(states: usize, count: usize) -> Vec<(f64, Vec<f64>, f64)> {
    let mut state = 1_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 * 2.0 - 1.0
    };
    let point = |index: usize| {
        let mut y: Vec<f64> = (0..states).map(|_| random()).collect();
        let norm = y.iter().map(|y| y * y).sum::<f64>().sqrt();
        if norm > 1.0 || index.is_multiple_of(2) {
            y.iter_mut().for_each(|y| *y /= norm);
        }
        let e = random();
        (random(), y, if index.is_multiple_of(3) { e.signum() } else { e })
    };
    (0..count).map(point).collect()
}
