//! Where a search for a largest value begins in the unit ball, and how it goes on in time, in the ball and in e.

/// Moves with the same step, at most.
const MOVES: u32 = 4;

/// The first step of the local search, in coordinates of the cube.
const FIRST_STEP: f64 = 0.15;

/// A step in time is so much smaller than one in the ball.
const TIME_SCALE: f64 = 16.0;

/// Points in other directions than those of the axes, for three states and more.
const SPREAD: u32 = 24;

/// A point of the cube: t/T, y and e/E, and the member of the family it is about.
#[derive(Clone, Debug)]
pub(super) struct Point {
    pub(super) time: f64,
    pub(super) y: Vec<f64>,
    pub(super) e: f64,
    pub(super) member: usize,
}

/// A search along the coordinates with steps that are halved when none of them helps: where it ends, and the value there.
pub(super) fn climb(
    mut point: Point,
    mut value: f64,
    halvings: u32,
    errors: bool,
    mut value_at: impl FnMut(&Point) -> f64,
) -> (Point, f64) {
    let mut step = FIRST_STEP;
    for _ in 0..halvings {
        for _ in 0..MOVES {
            let mut moved = false;
            for coordinate in 0..point.y.len() + 2 {
                for sign in [1.0, -1.0] {
                    let mut next = point.clone();
                    match coordinate {
                        0 => next.time += sign * step / TIME_SCALE,
                        1 if !errors => continue,
                        1 => next.e = (next.e + sign * step).clamp(-1.0, 1.0),
                        _ => {
                            next.y[coordinate - 2] += sign * step;
                            let norm = next.y.iter().map(|y| y * y).sum::<f64>().sqrt();
                            if norm > 1.0 {
                                next.y.iter_mut().for_each(|y| *y /= norm);
                            }
                        }
                    }
                    let found = value_at(&next);
                    if found > value {
                        (point, value, moved) = (next, found, true);
                    }
                }
            }
            if !moved {
                break;
            }
        }
        step /= 2.0;
    }
    (point, value)
}

/// Points of the unit ball: its centre, the axes and the corners of the cube on the sphere, and points spread evenly.
pub(super) fn ball_points(order: usize) -> Vec<Vec<f64>> {
    match order {
        0 => vec![Vec::new()],
        1 => [-1.0, -0.5, 0.0, 0.5, 1.0].map(|y| vec![y]).to_vec(),
        2 => {
            let circle = |count: u32, radius: f64| {
                (0..count).map(move |i| {
                    let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(i) / f64::from(count));
                    vec![radius * cos, radius * sin]
                })
            };
            std::iter::once(vec![0.0, 0.0]).chain(circle(12, 1.0)).chain(circle(6, 0.5)).collect()
        }
        _ => {
            let axis = |i: usize, sign: f64| (0..order).map(|j| if i == j { sign } else { 0.0 }).collect::<Vec<f64>>();
            let axes = (0..order).flat_map(|i| [axis(i, 1.0), axis(i, -1.0)]);
            let spread = (1..=SPREAD).map(|k| {
                // An additive recurrence, as even as square roots of odd numbers make it.
                let direction: Vec<f64> =
                    (0..order).map(|j| 2.0 * (f64::from(k) * ((2 * j + 3) as f64).sqrt()).fract() - 1.0).collect();
                let norm = direction.iter().map(|y| y * y).sum::<f64>().sqrt().max(f64::MIN_POSITIVE);
                let radius = if k % 4 == 0 { 0.5 } else { 1.0 };
                direction.into_iter().map(|y| radius * y / norm).collect()
            });
            std::iter::once(vec![0.0; order]).chain(axes).chain(spread).collect()
        }
    }
}
