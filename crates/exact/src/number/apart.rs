//! Two doubles that differ, in few digits that still tell them apart.

/// Digits after the point, where that is enough.
const DIGITS: usize = 6;

/// Digits after the point that tell any two doubles apart.
const ALL: usize = 16;

/// Two doubles with six digits after the point of an exponent form, and more where they would look alike.
#[must_use]
pub fn told_apart(values: [f64; 2]) -> [String; 2] {
    let written = |digits: usize| values.map(|value| format!("{value:.digits$e}"));
    let differ = |texts: &[String; 2]| texts[0] != texts[1];
    (DIGITS..ALL).map(written).find(differ).unwrap_or_else(|| written(ALL))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_digits_where_they_do_and_more_where_not() {
        assert_eq!(told_apart([1.0, 2.0]), ["1.000000e0", "2.000000e0"]);
        assert_eq!(told_apart([1.0, 1.000_000_02]), ["1.00000000e0", "1.00000002e0"]);
        let next = 1.0 + f64::EPSILON;
        let [a, b] = told_apart([1.0, next]);
        assert!(a != b && b.parse::<f64>() == Ok(next), "{a} {b}");
        assert_eq!(told_apart([f64::NAN, 1.0]), ["NaN", "1.000000e0"]);
    }
}
