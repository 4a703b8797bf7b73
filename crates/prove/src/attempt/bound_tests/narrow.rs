//! A friction that changes over a small part of the errors, at a place that moves.

use super::*;

/// dq/de = 1/(2 width) at e = -w(t), w(t) = (3 + cos(2 pi t))/10; at the shares of E that are looked at it is next to nothing.
#[test]
fn a_narrow_friction_is_found() {
    let orbit = TrigonometricVector { mean: vec![Rational::new()], harmonics: Vec::new() };
    let index = TABLE.iter().position(|bound| *bound == Bound::Qe).unwrap();
    for width in [0.05, 0.01, 0.001] {
        let q = format!("tanh((e + 0.3 + 0.1*cos(2*pi*t))/{width})/2 - x/4");
        let plant = plant(&["x"], &["-x + e/3"], &q);
        let Case { samples, .. } = case(&plant, &[vec![1.0]], orbit.clone(), "0");
        let largest = 0.5 / width;
        let near = |value: f64| (value / largest - 1.0).abs() < 1e-6;
        for e in [0.5, 1.0, 30.0] {
            for stride in [1, 4, 16] {
                let found = samples.survey(1.0, e, &Places::Stride(stride), Asked::only(Bound::Qe))[index];
                assert!(near(found), "{width}, {e}, {stride}: {found} {largest}");
            }
            assert!(near(samples.at(Bound::Qe, 1.0, e)) && near(samples.refined(Bound::Qe, 1.0, e).value));
        }
        // In other coordinates too, of which dq/de knows nothing; and not beyond E.
        let other = samples.in_coordinates(vec![vec![3.0]], [None, None]);
        assert!(near(other.at(Bound::Qe, 1.0, 1.0)));
        let [below, above] = [0.15, 0.25].map(|e| samples.at(Bound::Qe, 1.0, e) / largest);
        assert!(below < 0.5 && above > 0.95, "{width}: {below} {above}");
    }
}
