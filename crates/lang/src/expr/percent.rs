//! A percentage, which is no number here.

use sigmastar_exact::number::{parse_decimal, write_exact};

/// What to write for a percentage, of which `before` is all that stands in front of its sign.
pub(crate) fn percent(before: &str) -> String {
    let from = before
        .rfind(|c: char| !c.is_ascii_digit() && c != '.')
        .map_or(0, |at| at + before[at..].chars().next().map_or(1, char::len_utf8));
    let number = &before[from..];
    // What is a part of a name or an exponent is no number by itself.
    let part = before[..from].chars().next_back().is_some_and(|c| c.is_alphanumeric() || c == '_');
    let value = parse_decimal(number).ok().filter(|_| !part);
    match value {
        Some(value) => {
            let share = value / 100;
            let (decimal, fraction) = (write_exact(&share), share.to_string());
            let fraction = if share.is_integer() { String::new() } else { format!(" or {fraction}") };
            format!("there are no percentages: write {decimal}{fraction} for {number}%")
        }
        None => "there are no percentages: write 0.15 or 3/20 for 15%".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::percent;

    #[test]
    fn a_percentage_is_written_as_a_number() {
        for (before, said) in [
            ("15", "write 0.15 or 3/20 for 15%"),
            ("e*2.5", "write 0.025 or 1/40 for 2.5%"),
            ("\u{3bc} 200", "write 2 for 200%"),
            ("1e3", "write 0.15 or 3/20 for 15%"),
            ("k2", "write 0.15 or 3/20 for 15%"),
            ("(e)", "write 0.15 or 3/20 for 15%"),
            ("1..5", "write 0.15 or 3/20 for 15%"),
            ("", "write 0.15 or 3/20 for 15%"),
        ] {
            assert_eq!(percent(before), format!("there are no percentages: {said}"), "{before}");
        }
    }
}
