//! A percentage, which is no number here.

use sigmastar_exact::number::{parse_decimal, write_exact};

/// What to write for a percentage, of which `before` is all that stands in front of its sign.
pub(crate) fn percent(before: &str) -> String {
    let from = before
        .rfind(|c: char| !c.is_ascii_digit() && c != '.')
        .map_or(0, |at| at + before[at..].chars().next().map_or(1, char::len_utf8));
    let number = &before[from..];
    match parse_decimal(number) {
        Ok(value) => {
            let share = value / 100;
            let (decimal, fraction) = (write_exact(&share), share.to_string());
            let fraction = if share.is_integer() { String::new() } else { format!(" or {fraction}") };
            format!("there are no percentages: write {decimal}{fraction} for {number}%")
        }
        Err(_) => "there are no percentages: write 0.15 or 3/20 for 15%".to_owned(),
    }
}
