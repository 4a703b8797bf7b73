//! How fast the fastest mode of a closed loop is, and what a fixed step needs for it.

use super::ClosedLoop;
use super::limits::MAX_FIXED_STEPS;
use faer::Mat;
use sigmastar_regulator::spectral_radius;

/// The classical Runge-Kutta method is stable for h |lambda| up to this, wherever lambda is in the left half plane: its
/// region of stability contains that half of the disc.
const STABLE: f64 = 2.6;

/// The spectral radius of the Jacobian of the closed loop at a time and state; what follows y in `state` is left out.
fn fastest_mode(closed_loop: &ClosedLoop, t: f64, state: &[f64]) -> Option<f64> {
    let d = closed_loop.dimension();
    let jacobian = closed_loop.linearise(&mut closed_loop.derivative_evaluator(), t, state.get(..d)?);
    spectral_radius(&Mat::from_fn(d, d, |row, column| jacobian[row * d + column]))
}

/// Steps of a period with h |lambda| <= 1 for the Jacobian at these states, rounded up to two digits: the fastest mode is
/// then resolved and not only damped. At most [`MAX_FIXED_STEPS`]; `None` where those leave h |lambda| above 2.
#[must_use]
pub fn enough_steps(closed_loop: &ClosedLoop, t: f64, states: [&[f64]; 2]) -> Option<u32> {
    let fastest = states.into_iter().filter_map(|state| fastest_mode(closed_loop, t, state)).reduce(f64::max)?;
    let steps = (closed_loop.period * fastest).ceil().max(1.0);
    let unit = libm::pow(10.0, (libm::log10(steps).floor() - 1.0).max(0.0));
    let rounded = (steps / unit).ceil() * unit;
    let most = f64::from(MAX_FIXED_STEPS);
    // With the most steps, h |lambda| <= 2 is stable by a margin.
    (steps <= 2.0 * most).then_some(rounded.min(most) as u32)
}

/// Whether this many classical Runge-Kutta steps of a period are stable for the Jacobian at a state.
#[must_use]
pub fn is_stable(closed_loop: &ClosedLoop, steps: usize, t: f64, state: &[f64]) -> bool {
    fastest_mode(closed_loop, t, state).is_none_or(|fastest| closed_loop.period * fastest <= STABLE * steps as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_complex::Complex;
    use sigmastar_lang::plant::Plant;
    use sigmastar_regulator::Regulator;

    #[test]
    fn the_half_disc_lies_in_the_region_of_stability() {
        // R(z) = 1 + z + z^2/2 + z^3/6 + z^4/24; by the maximum principle the boundary of the half disc is enough.
        let r = |z: Complex<f64>| (1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0)))).norm();
        for k in 0..=2000 {
            let share = f64::from(k) / 2000.0;
            let arc = Complex::from_polar(STABLE, std::f64::consts::PI * (0.5 + share));
            assert!(r(arc) < 1.0 && r(Complex::new(0.0, STABLE * (2.0 * share - 1.0))) <= 1.0, "{share}");
        }
        assert!(r(Complex::new(-2.8, 0.0)) > 1.0);
    }

    #[test]
    fn steps_follow_the_gain() {
        let plant = Plant::from_json("linear", include_str!("../../../../specs/plants/linear.json")).unwrap();
        let steps = |sigma| {
            let closed_loop = ClosedLoop::new(&plant, Regulator::high_gain(sigma));
            (enough_steps(&closed_loop, 0.0, [&[0.0], &[1.0]]), is_stable(&closed_loop, 1000, 0.0, &[0.0]))
        };
        assert_eq!(steps(2.5), (Some(3), true));
        assert_eq!(steps(2599.0), (Some(2600), true));
        assert_eq!(steps(2601.0), (Some(2700), false));
        assert_eq!(steps(1.5e6), (Some(MAX_FIXED_STEPS), false));
        assert_eq!(steps(2.1e6), (None, false));
    }
}
