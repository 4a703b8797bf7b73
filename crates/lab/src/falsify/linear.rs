//! The linear member of the families: gains as large as the bounding functions allow, with adverse signs.

use super::claim::TriedClaim;
use super::contraction;
use super::family::Family;
use super::fit::{fit, fits};
use super::forcing::{fill, harmonics};
use super::jacobian::{self, Clock};
use super::limits::{Limits, SectorEnd};
use super::random::Random;
use super::shape::Number;
use sigmastar_lang::spec::model::LyapunovSource;
use sigmastar_theory::data::Bound;

/// Arguments E at which the slope of f is looked at, as shares of the reach.
const SLOPES: [f64; 5] = [1e-6, 1e-3, 0.1, 0.5, 1.0];

/// What is kept of the gains where they are not proved to fit exactly: nine digits are exact to 5e-9.
const ROUNDED: f64 = 1.0 - 1e-7;

/// The plant x' = F x + g e, e' = c e - damping e + beta m'x + A(t) + u with the largest constant g, beta that the bounding
/// functions allow at small arguments, dq/de at an end of its sector, and A as large as it may be. With a triple x is
/// scalar, F = -alpha as it is written (P = 1 then has the condition on P_x with equality), or the contraction rate at the
/// origin where that is larger, and x and e drive each other: g, beta > 0. With a Jacobian F is one of its matrices.
///
/// Without `q_e_max` the lower end is the upper one with the opposite sign.
///
/// A tight f leaves room for no other plant, so nothing is taken from the gains first; where that is not proved to fit, a
/// rounding is, and then what `draw` takes. `None` where nothing could be proved.
///
/// Guarantee: as for `draw`.
#[must_use]
pub fn linear_member(claim: &TriedClaim, end: SectorEnd, random: &mut Random, left: &mut u64) -> Option<Family> {
    let limits = Limits::new(claim);
    let [reach_x, reach_e] = limits.reach;
    let clock = Clock { period: &claim.spec.period.nominal().text, multiple: 1 };
    let (jacobian, jacobian_norm) = match &claim.spec.lyapunov {
        _ if limits.at(Bound::F, reach_x, 0.0) <= 0.0 => (Vec::new(), "0".to_owned()),
        LyapunovSource::Given(triple) => {
            let rate = contraction::wanted(claim, triple)?.text;
            (vec![vec![format!("-({rate})")]], rate)
        }
        _ => {
            let drawn = jacobian::draw(claim, clock, 0.0, random)?;
            (drawn.rows, drawn.norm.to_string())
        }
    };
    let n = jacobian.len();
    let directions = [(); 3].map(|()| if n == 1 { vec![Number::new(1.0)] } else { random.direction(n) });
    let slope = |share: &f64| limits.at(Bound::F, 0.0, share * reach_e) / (share * reach_e);
    let along_e = SLOPES.iter().map(slope).fold(f64::INFINITY, f64::min);
    let harmonics = harmonics(claim, clock.multiple, |_| 1.0, random);
    let sector = limits.sector();
    let of_gains = |kept: f64| {
        let gain = |largest: f64| if largest.is_finite() { kept * largest.max(0.0) } else { 0.0 };
        let of_states = |size: f64| if n == 0 { Number::default() } else { Number::new(gain(size)) };
        let size = of_states(limits.at(Bound::Fe, 0.0, 0.0).min(along_e));
        let (c, damping) = match end {
            SectorEnd::Upper => (gain(sector.above), sector.least_damping() / kept),
            SectorEnd::Lower => (0.0, gain(sector.norm)),
        };
        let mut family = Family {
            period: clock.period.to_owned(),
            jacobian: jacobian.clone(),
            jacobian_norm: jacobian_norm.clone(),
            g: (directions[0].iter().map(|part| part.times(size.value())).collect(), size),
            directions: directions.clone(),
            beta: of_states(limits.at(Bound::Qx, 0.0, 0.0)),
            damping: Number::new(damping),
            c: Number::new(c),
            harmonics: harmonics.clone(),
            // Every shape is linear, every factor 1, and what is not linear is 0.
            ..Family::default()
        };
        fill(&mut family, claim);
        family
    };
    let exact = of_gains(1.0);
    if fits(&exact, claim, left) {
        return Some(exact);
    }
    let mut rounded = of_gains(ROUNDED);
    (fits(&rounded, claim, left) || fit(&mut rounded, claim, left)).then_some(rounded)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::falsify::membership::MAX_OPERATIONS;
    use sigmastar_lang::spec::Specification;

    /// The linear specification with other bounds of f.
    fn claim(alpha: &str, f: &str, f_e: &str) -> TriedClaim {
        let text = include_str!("../../../../specs/linear.json");
        let mut document: serde_json::Value = serde_json::from_str(text).unwrap();
        document["lyapunov"]["alpha"] = alpha.into();
        document["bounds"]["f"] = f.into();
        document["bounds"]["f_e"] = f_e.into();
        TriedClaim::for_tests(Specification::from_json("tight", &document.to_string()).unwrap(), [3.0, 4.0])
    }

    fn member(claim: &TriedClaim, end: SectorEnd) -> Option<Family> {
        linear_member(claim, end, &mut Random::new(1, 1), &mut { MAX_OPERATIONS })
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
            let family = member(&claim(alpha, f, f_e), SectorEnd::Upper).expect(f);
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
        assert!(member(&claim("20", "19.9*X + 2000*E", "2000"), SectorEnd::Upper).is_none());
        assert!(member(&claim("20", "20*X + 2000*E", "2000"), SectorEnd::Upper).is_some());
    }

    /// dq/de = c - damping for certain.
    #[test]
    fn an_end_of_the_sector_is_taken_exactly() {
        let text = include_str!("../../../../specs/linear.json");
        for (q_e_max, end, c, damping) in [
            (None, SectorEnd::Lower, 0.0, 0.25),
            (Some("0"), SectorEnd::Upper, 0.0, 0.0),
            (Some("0"), SectorEnd::Lower, 0.0, 0.25),
            (Some("-1/8"), SectorEnd::Upper, 0.0, 0.125),
            (Some("1/16"), SectorEnd::Upper, 0.0625, 0.0),
            // Not more than q_e allows.
            (Some("1"), SectorEnd::Upper, 0.25, 0.0),
        ] {
            let mut document: serde_json::Value = serde_json::from_str(text).unwrap();
            if let Some(bound) = q_e_max {
                document["bounds"]["q_e_max"] = bound.into();
            }
            let spec = Specification::from_json("sector", &document.to_string()).unwrap();
            let family = member(&TriedClaim::for_tests(spec, [3.0, 4.0]), end).expect("a linear plant fits");
            let kept = (family.c.value(), family.damping.value());
            // Nine digits below the norm or beyond the end, where it is rounded.
            assert!((kept.0 - c).abs() + (kept.1 - damping).abs() < 1e-7, "{q_e_max:?} {end:?}: {kept:?}");
        }
    }

    #[test]
    fn a_sector_that_is_empty_has_no_member() {
        let mut document: serde_json::Value =
            serde_json::from_str(include_str!("../../../../specs/linear.json")).unwrap();
        document["bounds"]["q_e_max"] = "-1/2".into();
        let claim =
            TriedClaim::for_tests(Specification::from_json("empty", &document.to_string()).unwrap(), [3.0, 4.0]);
        assert!([SectorEnd::Upper, SectorEnd::Lower].into_iter().all(|end| member(&claim, end).is_none()));
    }
}
