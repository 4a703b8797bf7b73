//! How far a form of the law at samples is from not being positive definite (derivation, 12).

use sigmastar_theory::derivation::sampled::{Form, Past};

/// The spectral radius of what is off the diagonal of a form that is scaled to 1 on it: below 1 if and only if the form is
/// positive definite. `None` where the diagonal is not positive.
pub(super) fn radius(form: &Form<f64>) -> Option<f64> {
    let Form { xx, ee, yy, xe, xy, ey, past } = form;
    if let Some(Past { pp, xp, ep, yp }) = past {
        return radius_of_four([xx, ee, yy, pp], [[xe, yp], [xy, ep], [ey, xp]]);
    }
    if ![xx, ee, yy].iter().all(|value| **value > 0.0 && value.is_finite()) {
        return None;
    }
    let [a, b, c] = [xe / (2.0 * (xx * ee).sqrt()), xy / (2.0 * (xx * yy).sqrt()), ey / (2.0 * (ee * yy).sqrt())];
    let squares = a * a + b * b + c * c;
    if squares == 0.0 {
        return Some(0.0);
    }
    // The largest root of r^3 - squares r - 2abc, by Newton's method from above.
    let mut r = 2.0 * (squares / 3.0).sqrt();
    for _ in 0..60 {
        let step = (r * r * r - squares * r - 2.0 * a * b * c) / (3.0 * r * r - squares);
        r -= step;
        if step.is_nan() || step.abs() <= 1e-15 * r {
            break;
        }
    }
    r.is_finite().then_some(r)
}

/// The radius of [`radius`] for a form in four variables. `pairs` are the entries off the diagonal, each with the one that shares no
/// variable with it. `None` where the diagonal is not positive.
fn radius_of_four(diagonal: [&f64; 4], pairs: [[&f64; 2]; 3]) -> Option<f64> {
    if !diagonal.iter().all(|value| **value > 0.0 && value.is_finite()) {
        return None;
    }
    let [x, e, y, p] = diagonal.map(|value| value.sqrt());
    let scaled = |value: &f64, scale: f64| value / (2.0 * scale);
    let [[xe, yp], [xy, ep], [ey, xp]] = pairs;
    let [xe, yp, xy] = [scaled(xe, x * e), scaled(yp, y * p), scaled(xy, x * y)];
    let [ep, ey, xp] = [scaled(ep, e * p), scaled(ey, e * y), scaled(xp, x * p)];
    let squares: f64 = [xe, yp, xy, ep, ey, xp].iter().map(|value| value * value).sum();
    if squares == 0.0 {
        return Some(0.0);
    }
    let triangles = xe * ey * xy + xe * ep * xp + xy * yp * xp + ey * yp * ep;
    let [a, b, c] = [xe * yp, xy * ep, ey * xp];
    let determinant = a * a + b * b + c * c - 2.0 * (a * b + a * c + b * c);
    // The largest root of r^4 - squares r^2 - 2 triangles r + determinant, by Newton's method from above: the squares of all four add up
    // to 2 squares, and their sum is 0.
    let mut r = (1.5 * squares).sqrt();
    for _ in 0..60 {
        let value = ((r * r - squares) * r - 2.0 * triangles) * r + determinant;
        let step = value / ((4.0 * r * r - 2.0 * squares) * r - 2.0 * triangles);
        r -= step;
        if step.is_nan() || step.abs() <= 1e-15 * r {
            break;
        }
    }
    r.is_finite().then_some(r)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers in [0, 1), the same ones each time.
    fn numbers(mut state: u64) -> impl FnMut() -> f64 {
        move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / 2f64.powi(24)
        }
    }

    /// In four variables too.
    #[test]
    fn the_radius_of_four_tells_definite_forms_apart() {
        let mut next = numbers(9);
        let mut seen = [0; 2];
        for _ in 0..4000 {
            let scale = 0.2 + next();
            let past = Past { pp: next() + 0.1, xp: scale * next(), ep: scale * next(), yp: scale * next() };
            let [xe, xy, ey] = [0; 3].map(|_| scale * next());
            let [xx, ee, yy] = [0; 3].map(|_| next() + 0.1);
            let form = Form { xx, ee, yy, xe, xy, ey, past: Some(past) };
            let definite = form.minors().iter().all(|minor| *minor > 0.0);
            let radius = radius(&form).unwrap();
            if (radius - 1.0).abs() > 1e-9 {
                assert_eq!(radius < 1.0, definite, "{form:?} {radius}");
                seen[usize::from(definite)] += 1;
            }
        }
        assert!(seen.iter().all(|count| *count > 500), "{seen:?}");
    }

    #[test]
    fn the_radius_tells_definite_forms_apart() {
        let mut next = numbers(7);
        let mut seen = [0; 2];
        for _ in 0..4000 {
            let form = Form {
                xx: next() + 0.1,
                ee: next() + 0.1,
                yy: next() + 0.1,
                xe: next(),
                xy: next(),
                ey: next(),
                past: None,
            };
            let definite = form.minors().iter().all(|minor| *minor > 0.0);
            let radius = radius(&form).unwrap();
            if (radius - 1.0).abs() > 1e-9 {
                assert_eq!(radius < 1.0, definite, "{form:?} {radius}");
                seen[usize::from(definite)] += 1;
            }
        }
        assert!(seen.iter().all(|count| *count > 500), "{seen:?}");
        let free = Form { xx: 1.0, ee: 2.0, yy: 3.0, xe: 0.0, xy: 0.0, ey: 0.0, past: None };
        assert_eq!(radius(&free), Some(0.0));
        assert_eq!(radius(&Form { yy: -1.0, ..free }), None);
    }
}
