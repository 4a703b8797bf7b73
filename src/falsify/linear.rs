//! The linear member of the families: gains as large as the bounding functions allow, with adverse signs.

use super::claim::Claim;
use super::draw::{DrawnPlant, SHARE, allowed, fill, fit, harmonics};
use super::family::Family;
use super::jacobian::{self, Clock};
use super::membership::respects;
use super::random::Random;
use super::shape::{Factor, Number, Shape};
use crate::spec::model::LyapunovSource;

/// Arguments E at which the slope of f is looked at, as shares of the reach.
const SLOPES: [f64; 5] = [1e-6, 1e-3, 0.1, 0.5, 1.0];

/// What is kept of the gains where they are not proved to fit exactly: nine digits are exact to 5e-9.
const ROUNDED: f64 = 1.0 - 1e-7;

/// The plant x' = F x + g e, e' = c e + beta m'x + A(t) + u with the largest constant g, c, beta that the bounding functions
/// allow at small arguments. With a triple x is scalar, F = -alpha as it is written (P = 1 then has the condition on P_x
/// with equality), and x and e drive each other: g, c, beta > 0. With a Jacobian F is one of its matrices.
///
/// A tight f leaves room for no other plant, so nothing is taken from the gains first; where that is not proved to fit, a
/// rounding is, and then what `draw` takes. `None` where nothing could be proved.
///
/// Guarantee: as for `draw`.
#[must_use]
pub fn linear_member(claim: &Claim, random: &mut Random, left: &mut u64) -> Option<DrawnPlant> {
    let allowed = allowed(claim);
    let [reach_x, reach_e] = claim.reach.each_ref().map(rug::Rational::to_f64);
    let value = |index: usize, x: f64, e: f64| allowed[index].to_float().eval(x, e);
    let clock = Clock { period: &claim.spec.period.text, multiple: 1 };
    let (jacobian, jacobian_norm) = match &claim.spec.lyapunov {
        _ if value(0, reach_x, 0.0) <= 0.0 => (Vec::new(), "0".to_owned()),
        LyapunovSource::Given(triple) => {
            let alpha = &triple.alpha.text;
            (vec![vec![format!("-({alpha})")]], alpha.clone())
        }
        _ => {
            let drawn = jacobian::draw(claim, clock, 0.0, random)?;
            (drawn.rows, drawn.norm.to_string())
        }
    };
    let n = jacobian.len();
    let directions = [(); 3].map(|()| if n == 1 { vec![Number::new(1.0)] } else { random.direction(n) });
    let along_e =
        SLOPES.iter().map(|share| value(0, 0.0, share * reach_e) / (share * reach_e)).fold(f64::INFINITY, f64::min);
    let harmonics = harmonics(clock.multiple, random);
    let at_zero: Vec<f64> = (0..allowed.len()).map(|index| SHARE * value(index, 0.0, 0.0)).collect();
    let of_gains = |kept: f64| {
        let gain = |largest: f64| if largest.is_finite() { kept * largest.max(0.0) } else { 0.0 };
        let of_states = |size: f64| if n == 0 { Number::default() } else { Number::new(gain(size)) };
        let size = of_states(value(1, 0.0, 0.0).min(along_e));
        let mut family = Family {
            period: clock.period.to_owned(),
            jacobian: jacobian.clone(),
            jacobian_norm: jacobian_norm.clone(),
            g: (directions[0].iter().map(|part| part.times(size.value())).collect(), size),
            g_1: Number::default(),
            kappa: Number::default(),
            directions: directions.clone(),
            shapes: [Shape::Linear; 2],
            wave: None,
            beta: of_states(value(6, 0.0, 0.0)),
            c: Number::new(gain(value(5, 0.0, 0.0))),
            delta: Number::default(),
            saturation: Shape::Linear,
            factors: [Factor::ONE; 4],
            harmonics: harmonics.clone(),
        };
        fill(&mut family, &at_zero, claim.spec.period.to_f64());
        family
    };
    let proved = |family: &Family, left: &mut u64| {
        family.bounds().iter().zip(&allowed).all(|(bound, allowed)| respects(bound, allowed, &claim.reach, left))
    };
    let exact = of_gains(1.0);
    if proved(&exact, left) {
        return Some(DrawnPlant { family: exact });
    }
    let mut rounded = of_gains(ROUNDED);
    (proved(&rounded, left) || fit(&mut rounded, &allowed, claim, left)).then_some(DrawnPlant { family: rounded })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::falsify::membership::MAX_OPERATIONS;
    use crate::spec::Specification;

    /// The linear specification with other bounds of f.
    fn claim(alpha: &str, f: &str, f_e: &str) -> Claim {
        let text = include_str!("../../specs/linear.json");
        let mut document: serde_json::Value = serde_json::from_str(text).unwrap();
        document["lyapunov"]["alpha"] = alpha.into();
        document["bounds"]["f"] = f.into();
        document["bounds"]["f_e"] = f_e.into();
        Claim::for_tests(Specification::from_json("tight", &document.to_string()).unwrap(), [3.0, 4.0])
    }

    #[test]
    fn gains_are_taken_exactly_where_they_are_proved_to_fit() {
        for (alpha, f, f_e, g) in [
            ("20", "20*X + 2000*E", "2000", 2000.0),
            // No doubles: one half of what nine digits say is too large.
            ("1/3", "X/3 + 0.1*E", "1/10", 0.1),
            ("1/3", "X/3 + 2*E/3", "2/3", 0.666_666_6),
            ("1/2", "2*X + min(E, 1)/4", "1/4", 0.25 / 4.0),
        ] {
            let family =
                linear_member(&claim(alpha, f, f_e), &mut Random::new(1, 1), &mut { MAX_OPERATIONS }).expect(f).family;
            assert_eq!(family.jacobian, [[format!("-({alpha})")]]);
            assert!((family.g.1.value() / g - 1.0).abs() < 1e-15, "{f}: {}", family.g.1);
            // q of linear.json: 3 + X + E/4.
            assert_eq!(
                (family.beta.value(), family.c.value()),
                if f_e == "2/3" { (0.999_999_9, 0.249_999_975) } else { (1.0, 0.25) }
            );
        }
    }

    #[test]
    fn a_rate_that_f_does_not_allow_has_no_member() {
        // |F| >= alpha and |F x| <= f contradict each other.
        assert!(
            linear_member(&claim("20", "19.9*X + 2000*E", "2000"), &mut Random::new(1, 1), &mut { MAX_OPERATIONS })
                .is_none()
        );
        assert!(
            linear_member(&claim("20", "20*X + 2000*E", "2000"), &mut Random::new(1, 1), &mut { MAX_OPERATIONS })
                .is_some()
        );
    }
}
