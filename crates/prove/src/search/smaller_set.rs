//! How much smaller an initial set would have to be, in floating point.

use super::model::FloatModel;
use super::sharp::{any_candidate, at_sigma, search_sharp};
use rug::Rational;
use sigmastar_exact::number::{Direction, Portable, round_f64};
use sigmastar_lang::spec::model::InitialSet;

/// The scalings that are tried reach down to 2 to this power.
const LEAST_EXPONENT: f64 = -60.0;

/// Bisections of the exponent: to 60/4096, which is 1 % of the size.
const STEPS: u32 = 12;

/// Digits of the sizes.
const DIGITS: u32 = 3;

/// Initial sets for which a search succeeds where it fails for the set that is asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SmallerSet {
    /// The controller at rest, the rest as in the paper's set.
    AtRest,
    /// A box of these sizes X_0, E_0, Z_0.
    Box([Rational; 3]),
    /// None: it fails for a single point too, or for all but a point.
    None,
}

/// The largest initial set of the shape that is asked for, to about 1 %, for which the search finds a candidate; for the
/// paper's set first the controller at rest.
///
/// Guarantee: none. This is floating point, and what it proposes has to be certified.
#[must_use]
pub fn smaller_set(model: &FloatModel) -> SmallerSet {
    let finds = |set: InitialSet<f64>| any_candidate(&model.with_set(set));
    if matches!(model.set, InitialSet::Paper) && finds(InitialSet::AtRest { x0: None, e0: None }) {
        return SmallerSet::AtRest;
    }
    let point = InitialSet::Box { x0: 0.0, e0: 0.0, z0: 0.0 };
    if !finds(point) {
        return SmallerSet::None;
    }
    let Some([x0, e0, z0]) = shape(model, point) else { return SmallerSet::None };
    let scaled = |exponent: f64| [x0, e0, z0].map(|size| size * 2f64.portable_pow(exponent));
    let succeeds = |exponent: f64| {
        let [x0, e0, z0] = scaled(exponent);
        finds(InitialSet::Box { x0, e0, z0 })
    };
    let (mut low, mut high) = (LEAST_EXPONENT, 0.0);
    if !succeeds(low) {
        return SmallerSet::None;
    }
    for _ in 0..STEPS {
        let middle = 0.5 * (low + high);
        if succeeds(middle) { low = middle } else { high = middle }
    }
    let rounded = scaled(low).map(|size| round_f64(size, DIGITS, Direction::Down));
    match rounded {
        [Some(x0), Some(e0), Some(z0)] => SmallerSet::Box([x0, e0, z0]),
        _ => SmallerSet::None,
    }
}

/// The box that is scaled: the user's numbers, or twice the bounds of the periodic solution where none is given.
fn shape(model: &FloatModel, point: InitialSet<f64>) -> Option<[f64; 3]> {
    let twice = || {
        let model = model.with_set(point);
        let found = search_sharp(&model).ok()?;
        let (set, _) = at_sigma(&model, &found.parameters, found.sigma, 1e-9).ok()?;
        Some([2.0 * set.x_p, 2.0 * set.e_p])
    };
    match model.set {
        InitialSet::Box { x0, e0, z0 } => Some([x0, e0, z0]),
        InitialSet::AtRest { x0: Some(x0), e0: Some(e0) } => Some([x0, e0, 0.0]),
        InitialSet::AtRest { x0, e0 } => twice().map(|[x, e]| [x0.unwrap_or(x), e0.unwrap_or(e), 0.0]),
        InitialSet::Paper => twice().map(|[x, e]| [x, e, 0.0]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sigmastar_lang::spec::Specification;
    use sigmastar_theory::data::Data;
    use sigmastar_theory::transfer::TradeOff;

    /// The paper's example on the domain X = E = 1 with another initial set.
    fn model(set: InitialSet<f64>) -> FloatModel {
        let text = include_str!("../../../../specs/paper-example.json");
        let text = text.replace(r#""X": "10", "E": "10""#, r#""X": "1", "E": "1""#);
        let spec = Specification::from_json("example", &text).unwrap();
        let data = Data::new(&spec, 64);
        FloatModel::new(&data, TradeOff::matched(&data)).with_set(set)
    }

    #[test]
    fn the_size_is_near_the_edge_of_success() {
        let asked = model(InitialSet::Box { x0: 1.0, e0: 4.0, z0: 0.0 });
        assert!(search_sharp(&asked).is_err());
        let SmallerSet::Box(sizes) = smaller_set(&asked) else { panic!("a size is expected") };
        let [x0, e0, z0] = sizes.each_ref().map(Rational::to_f64);
        assert!(x0 > 0.0 && (e0 / x0 - 4.0).abs() < 0.4 && z0 == 0.0, "{x0} {e0} {z0}");
        let succeeds =
            |factor: f64| search_sharp(&model(InitialSet::Box { x0: factor * x0, e0: factor * e0, z0: 0.0 })).is_ok();
        assert!(succeeds(1.0) && !succeeds(1.15), "{x0} {e0}");
    }

    #[test]
    fn no_size_where_a_point_fails() {
        let asked = model(InitialSet::Box { x0: 1.0, e0: 4.0, z0: 0.0 });
        // Data for which no comparison holds.
        let asked = asked.with_triple(1.0, f64::NAN);
        assert_eq!(smaller_set(&asked), SmallerSet::None);
    }
}
