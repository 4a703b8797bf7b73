//! Doubles as C99 literals that no compiler rounds.

use crate::export::decimal;

/// A constant array.
pub(super) fn array(name: &str, values: &[f64]) -> String {
    let entries: Vec<String> = values.iter().map(|value| format!("    {}", literal(*value))).collect();
    format!("static const double {name}[{}] = {{\n{}\n}};\n", values.len(), entries.join(",\n"))
}

/// The literal, with the decimal beside it for a reader.
pub(super) fn literal(value: f64) -> String {
    format!("{} /* {} */", hexadecimal(value), decimal(value))
}

/// A finite double as a C99 hexadecimal literal.
pub(super) fn hexadecimal(value: f64) -> String {
    let bits = value.to_bits();
    let sign = if value.is_sign_negative() { "-" } else { "" };
    let fraction = bits & ((1 << 52) - 1);
    // Eleven bits fit.
    let exponent = ((bits >> 52) & 0x7ff) as i64;
    match (exponent, fraction) {
        (0, 0) => format!("{sign}0x0p+0"),
        // Subnormal numbers have no leading 1, and the exponent of the smallest normal ones.
        (0, _) => format!("{sign}0x0.{fraction:013x}p-1022"),
        _ => format!("{sign}0x1.{fraction:013x}p{:+}", exponent - 1023),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hexadecimal_literals() {
        for (value, text) in [
            (1.0, "0x1.0000000000000p+0"),
            (-0.1, "-0x1.999999999999ap-4"),
            (0.0, "0x0p+0"),
            (6.5, "0x1.a000000000000p+2"),
            (5e-324, "0x0.0000000000001p-1022"),
        ] {
            assert_eq!(hexadecimal(value), text);
        }
    }
}
