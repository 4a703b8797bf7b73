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

/// An initial set for which a search succeeds where it fails for the set that is asked for: where that does not have it, the
/// same set with z = M e, which costs nothing; else the largest one of its shape, to about 1 %.
///
/// Guarantee: none. This is floating point, and what it proposes has to be certified. `None` where it fails for a single point
/// too, or for all but a point.
#[must_use]
pub fn smaller_set(model: &FloatModel) -> Option<InitialSet<Rational>> {
    let finds = |set: InitialSet<f64>| any_candidate(&model.with_set(set));
    let aligned = model.set.aligned();
    if !model.set.is_aligned() && finds(aligned) {
        return rounded(&aligned);
    }
    let point = InitialSet::Aligned { x0: Some(0.0), e0: Some(0.0) };
    if !finds(point) {
        return None;
    }
    let shape = shape(model, point)?;
    let scaled = |exponent: f64| shape.map(|size| size * 2f64.portable_pow(exponent));
    let (mut low, mut high) = (LEAST_EXPONENT, 0.0);
    if !finds(scaled(low)) {
        return None;
    }
    for _ in 0..STEPS {
        let middle = 0.5 * (low + high);
        if finds(scaled(middle)) { low = middle } else { high = middle }
    }
    rounded(&scaled(low))
}

/// The set with short sizes, rounded down; none where one is not finite.
fn rounded(set: &InitialSet<f64>) -> Option<InitialSet<Rational>> {
    let mut finite = true;
    let rounded = set.map_each(|_, size| {
        let size = round_f64(*size, DIGITS, Direction::Down);
        finite &= size.is_some();
        size.unwrap_or_default()
    });
    finite.then_some(rounded)
}

/// The set that is scaled: the user's numbers, or twice the bounds of the periodic solution where none is given, with z = M e.
fn shape(model: &FloatModel, point: InitialSet<f64>) -> Option<InitialSet<f64>> {
    let given = model.set.aligned();
    if let InitialSet::Aligned { x0: Some(_), e0: Some(_) } = given {
        return Some(given);
    }
    let model = model.with_set(point);
    let found = search_sharp(&model).ok()?;
    let (set, _) = at_sigma(&model, &found.parameters, found.sigma, 1e-9).ok()?;
    let [x0, e0] = given.given();
    Some(InitialSet::Aligned {
        x0: Some(x0.copied().unwrap_or(2.0 * set.x_p)),
        e0: Some(e0.copied().unwrap_or(2.0 * set.e_p)),
    })
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
        let found = smaller_set(&asked).expect("a size is expected");
        assert!(found.is_aligned());
        let [Some(x0), Some(e0)] = found.given().map(|size| size.map(Rational::to_f64)) else { panic!("two sizes") };
        assert!(x0 > 0.0 && (e0 / x0 - 4.0).abs() < 0.4, "{x0} {e0}");
        let succeeds = |factor: f64| {
            search_sharp(&model(InitialSet::Aligned { x0: Some(factor * x0), e0: Some(factor * e0) })).is_ok()
        };
        assert!(succeeds(1.0) && !succeeds(1.15), "{x0} {e0}");
    }

    #[test]
    fn an_aligned_start_comes_first() {
        // Any Z_0 has a gain, until no double is left for the weight of zeta.
        let asked = model(InitialSet::Box { x0: 0.1, e0: 0.1, z0: 1e200 });
        assert!(search_sharp(&asked).is_err());
        let found = smaller_set(&asked).expect("a set");
        let tenth = Rational::from((1, 10));
        assert_eq!(found, InitialSet::Aligned { x0: Some(tenth.clone()), e0: Some(tenth) });
    }

    #[test]
    fn no_size_where_a_point_fails() {
        let asked = model(InitialSet::Box { x0: 1.0, e0: 4.0, z0: 0.0 });
        // Data for which no comparison holds.
        let asked = asked.with_triple(1.0, f64::NAN);
        assert_eq!(smaller_set(&asked), None);
    }
}
