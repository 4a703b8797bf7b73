//! Rotations of y: what changes along one direction alone, and what changes along no direction.

use super::*;

fn directions(f: &[&str], q: &str) -> Directions {
    let names = ["x", "y", "z"];
    let n = f.len();
    let orbit = TrigonometricVector { mean: vec![Rational::new(); n], harmonics: Vec::new() };
    let unit: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| f64::from(i == j)).collect()).collect();
    case(&plant(&names[..n], f, q), &unit, orbit, "0").samples.directions([1.0, 1.0])
}

/// `cos(3x/5 + 4y/5)` and a square of it change along (3, 4)/5 alone.
#[test]
fn the_one_direction_is_the_first() {
    let found = directions(&["-x + sin(0.6*x + 0.8*y)", "-y + e*(0.6*x + 0.8*y)^2"], "x + (0.6*x + 0.8*y)^3");
    let first: Vec<f64> = found.principal.iter().map(|row| row[0]).collect();
    let along = (0.6 * first[0] + 0.8 * first[1]).abs();
    assert!((along - 1.0).abs() < 1e-6, "{found:?}");
    // Beside it nothing is left: the axes see both 3/5 and 4/5 of it.
    let turned = directions(&["-x + sin(x)", "-y + e*x^2"], "x + x^3");
    assert!(turned.along_axes < 0.9 * found.along_axes, "{turned:?} {found:?}");
}

/// Columns are orthonormal, also where nothing changes.
#[test]
fn principal_directions_are_a_rotation() {
    for (f, q) in [
        (&["-x", "-2*y"][..], "x + y"),
        (&["-x + y*z", "-2*y + e*x^2", "-z - z^3"], "sin(x - y)*z"),
        (&["-x - x^3"], "x"),
        (&[], "e"),
    ] {
        let Directions { principal, along_axes } = directions(f, q);
        for i in 0..f.len() {
            for j in 0..f.len() {
                let product: f64 = principal.iter().map(|row| row[i] * row[j]).sum();
                assert!((product - f64::from(i == j)).abs() < 1e-12, "{f:?}: {principal:?}");
            }
        }
        let moves = f.iter().chain([&q]).any(|side| side.contains('^') || side.contains("sin"));
        assert_eq!(along_axes > 1e-12, moves, "{f:?}: {along_axes}");
    }
}
