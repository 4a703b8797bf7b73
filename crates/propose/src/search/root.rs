//! Where a function of one unknown changes its sign: the secant method in a bracket.

/// Values are cut off here: a logarithm of a ratio beyond it says no more.
const LARGEST: f64 = 1e4;

/// Steps at most.
const STEPS: usize = 120;

/// An argument between `low` and `high`, where `excess` is positive and not, at which it is not positive; within `width` of a
/// change of sign, or where the function is within `width` of 0.
///
/// The secant of the bracket, halving the value at an end that stays (Illinois); a bisection after two steps that did not
/// halve the bracket. NaN counts as positive.
pub fn crossing(excess: impl Fn(f64) -> f64, low: (f64, f64), high: (f64, f64), width: f64) -> f64 {
    let value_at = |at: f64| {
        let value = excess(at);
        if value.is_nan() { LARGEST } else { value.clamp(-LARGEST, LARGEST) }
    };
    let (mut low, mut high) = ((low.0, low.1.min(LARGEST)), (high.0, high.1.max(-LARGEST)));
    let mut kept = 0_i32;
    let mut nudge = None;
    let mut slow = 0;
    for _ in 0..STEPS {
        let before = high.0 - low.0;
        if before <= width {
            break;
        }
        let middle = 0.5 * (low.0 + high.0);
        let secant = low.0 + before * (low.1 / (low.1 - high.1));
        let wanted = if slow >= 2 { middle } else { nudge.take().unwrap_or(secant) };
        let inside = |at: &f64| *at > low.0 && *at < high.0;
        let Some(at) = [wanted, middle].into_iter().find(inside) else { break };
        let value = value_at(at);
        if value <= 0.0 {
            high = (at, value);
            if value > -width {
                break;
            }
            low.1 *= if kept > 0 { 0.5 } else { 1.0 };
            kept = 1;
        } else {
            // So near that a little more is enough.
            nudge = (value < width).then_some(at + 4.0 * width);
            low = (at, value);
            high.1 *= if kept < 0 { 0.5 } else { 1.0 };
            kept = -1;
        }
        slow = if high.0 - low.0 > 0.5 * before { slow + 1 } else { 0 };
    }
    high.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    fn solve(f: impl Fn(f64) -> f64, low: f64, high: f64) -> (f64, usize) {
        let calls = Cell::new(0);
        let counted = |x: f64| {
            calls.set(calls.get() + 1);
            f(x)
        };
        let root = crossing(counted, (low, f(low)), (high, f(high)), 1e-13);
        assert!(f(root) <= 0.0);
        (root, calls.get())
    }

    #[test]
    fn roots_are_found_in_few_steps() {
        for (f, low, high, expected) in [
            ((|x| 1.0 - x) as fn(f64) -> f64, -600.0, 600.0, 1.0),
            (|x| (-x).exp() - 0.5, -100.0, 700.0, 2f64.ln()),
            (|x| 2.0 - x * x * x, 0.0, 100.0, 2f64.cbrt()),
            (|x| (3.0 - x).min(7.0 * (3.0 - x)), -1e3, 1e3, 3.0),
        ] {
            let (root, calls) = solve(f, low, high);
            assert!((root - expected).abs() < 1e-12 && calls < 50, "{root} after {calls}");
        }
    }

    #[test]
    fn a_jump_is_bisected() {
        let (root, calls) = solve(|x| if x < 0.3 { f64::INFINITY } else { -1.0 }, 0.0, 1.0);
        assert!((root - 0.3).abs() < 1e-12 && calls <= STEPS, "{root} after {calls}");
        let (root, _) = solve(|x| if x < 0.3 { f64::NAN } else { -1.0 }, 0.0, 1.0);
        assert!((root - 0.3).abs() < 1e-12, "{root}");
    }
}
