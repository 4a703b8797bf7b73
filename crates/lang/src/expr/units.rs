//! Units behind a number, which stands alone here.

/// Units that have parts and multiples.
const UNITS: [&str; 9] = ["s", "V", "A", "m", "N", "Nm", "W", "Pa", "rad"];

/// Other units.
const OTHERS: [&str; 12] = ["min", "h", "d", "Hz", "kHz", "MHz", "rpm", "deg", "g", "kg", "K", "bar"];

/// Parts and multiples: the sign, and what stands before and behind the number then.
const PREFIXES: [(&str, [&str; 2]); 8] = [
    ("m", ["", "/1000"]),
    ("c", ["", "/100"]),
    ("u", ["", "/1000000"]),
    ("\u{b5}", ["", "/1000000"]),
    ("\u{3bc}", ["", "/1000000"]),
    ("n", ["", "/1000000000"]),
    ("k", ["1000*", ""]),
    ("M", ["1000000*", ""]),
];

/// Whether a name is that of a well-known unit.
pub(super) fn is_unit(name: &str) -> bool {
    UNITS.contains(&name) || OTHERS.contains(&name) || scaled(name).is_some()
}

/// The unit of which a name is a part or a multiple, and what stands before and behind the number in it.
fn scaled(name: &str) -> Option<(&'static str, [&'static str; 2])> {
    PREFIXES.iter().find_map(|(sign, around)| {
        let unit = name.strip_prefix(sign)?;
        UNITS.iter().find(|known| **known == unit).map(|unit| (*unit, *around))
    })
}

/// What to write for a number with a unit. What the unit means is told where the number is `alone` in front of it.
pub(super) fn without(number: &str, unit: &str, alone: bool) -> String {
    let (frequency, time) = match unit.to_lowercase().as_str() {
        "hz" if alone => (number.to_owned(), format!("1/{number}")),
        "khz" if alone => (format!("1000*{number}"), format!("1/(1000*{number})")),
        "rpm" if alone => (format!("{number}/60"), format!("60/{number}")),
        _ => return unscaled(number, unit, alone),
    };
    format!(
        "numbers have no units: with the second as the unit of time, {number} {unit} is {time} as a period or sampling period, and 2*pi*{frequency} as an \
         angular frequency such as `base_frequency`, or as a gain or a rate in 1/s"
    )
}

fn unscaled(number: &str, unit: &str, alone: bool) -> String {
    match scaled(unit).filter(|_| alone) {
        Some(("s", [before, behind])) => {
            format!("numbers have no units: with the second as the unit of time, write {before}{number}{behind}")
        }
        Some((unit, [before, behind])) => {
            format!(
                "numbers have no units: with {unit} as the unit of all data of this kind, write {before}{number}{behind}"
            )
        }
        None => {
            format!("numbers have no units: leave `{unit}` out, and take the same units of time, x and e in all data")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_is_told_apart_from_a_name() {
        for name in ["s", "ms", "\u{b5}s", "mV", "kW", "Nm", "min", "kHz", "kg"] {
            assert!(is_unit(name), "{name}");
        }
        for name in ["S", "k", "gain", "mk", "ks1", "", "sV", "kHzs"] {
            assert!(!is_unit(name), "{name}");
        }
    }

    #[test]
    fn what_to_write_depends_on_the_unit() {
        for (unit, alone, said) in [
            ("mV", true, "with V as the unit of all data of this kind, write 5/1000"),
            ("cm", true, "with m as the unit of all data of this kind, write 5/100"),
            ("kN", true, "with N as the unit of all data of this kind, write 1000*5"),
            ("us", true, "with the second as the unit of time, write 5/1000000"),
            ("Hz", true, "or as a gain or a rate in 1/s"),
            ("V", true, "leave `V` out"),
            ("1/s", true, "leave `1/s` out"),
            // Of `2 + 5 mV` nobody says what the 5 is.
            ("mV", false, "leave `mV` out"),
            ("Hz", false, "leave `Hz` out"),
        ] {
            let advice = without("5", unit, alone);
            assert!(advice.starts_with("numbers have no units: ") && advice.contains(said), "{unit}: {advice}");
        }
    }
}
