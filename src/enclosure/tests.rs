//! Tests of the arithmetic that need more than one operation.

use super::Enclosure;
use rug::{Float, Rational};

/// The end points of two precisions: the result is rounded outward, never to nearest at the first one's precision.
#[test]
fn minimum_and_maximum_of_two_precisions_enclose() {
    let third = Rational::from((1, 3));
    let two_thirds = Rational::from((2, 3));
    for (coarse, fine) in [(8, 64), (64, 8), (53, 64)] {
        for value in [&third, &two_thirds, &Rational::from(-&third), &Rational::from(-&two_thirds)] {
            let narrow = Enclosure::from_rational(value, fine);
            let wide = Enclosure::from_integer(100, coarse);
            for result in [wide.min(&narrow), narrow.min(&wide), wide.negate().max(&narrow), narrow.max(&wide.negate())]
            {
                assert!(result.contains(value), "{value} at {coarse} and {fine} bits: {result:?}");
            }
            // Ends of two precisions, as an intersection leaves them.
            let mixed = Enclosure::new(-narrow.upper().clone(), Float::with_val(4, 0.125));
            assert!(mixed.abs().contains(&value.clone().abs()) || *value < 0, "{mixed:?}");
        }
    }
}
