//! One notation for the numbers of a column.

/// Rewrites the cells so that either none or all of their numbers have an exponent. Digits stay as they are: nothing is
/// rounded. A cell that is not made of numbers alone (an interval, a percentage and a mark are) is left as it is.
pub(super) fn one_notation(cells: &mut [&mut String]) {
    if cells.iter().filter(|cell| is_numeric(cell)).any(|cell| words(cell).any(|word| number(word) == Some(true))) {
        for cell in cells.iter_mut().filter(|cell| is_numeric(cell)) {
            let shown: Vec<String> = words(cell)
                .map(|word| if number(word).is_some() { scientific(word) } else { word.to_owned() })
                .collect();
            **cell = shown.concat();
        }
    }
}

/// The numbers of a cell, and what stands between them.
fn words(cell: &str) -> impl Iterator<Item = &str> {
    cell.split_inclusive([' ', ',', '[', ']', '(']).flat_map(|part| {
        let end = part.trim_end_matches([' ', ',', '[', ']', '(']).len();
        [&part[..end], &part[end..]]
    })
}

/// Whether there is nothing but numbers, brackets and marks in it.
fn is_numeric(cell: &str) -> bool {
    words(cell).all(|word| number(word).is_some() || matches!(word, "" | " " | "," | "[" | "]" | "(" | "%" | "!)"))
}

/// Whether the number has an exponent; `None` for what is no number.
fn number(word: &str) -> Option<bool> {
    let decimal = |text: &str| {
        let size = text.strip_prefix('-').unwrap_or(text);
        let digits = size.bytes().filter(u8::is_ascii_digit).count();
        digits > 0 && size.len() - digits == size.matches('.').count() && size.matches('.').count() <= 1
    };
    match word.split_once('e') {
        None => decimal(word).then_some(false),
        Some((mantissa, exponent)) => {
            let whole = exponent.strip_prefix('-').unwrap_or(exponent);
            let is_whole = !whole.is_empty() && whole.bytes().all(|c| c.is_ascii_digit());
            (decimal(mantissa) && is_whole).then_some(true)
        }
    }
}

/// A number with one digit before the point and an exponent, of the same value; 0 stays 0.
pub(super) fn scientific(number: &str) -> String {
    if number.contains('e') {
        return number.to_owned();
    }
    let (sign, size) = number.strip_prefix('-').map_or(("", number), |size| ("-", size));
    let (whole, fraction) = size.split_once('.').unwrap_or((size, ""));
    let all = format!("{whole}{fraction}");
    let zeros = all.len() - all.trim_start_matches('0').len();
    let mut digits = &all[zeros..];
    if fraction.is_empty() {
        digits = digits.trim_end_matches('0');
    }
    let Some(first) = digits.get(..1) else { return number.to_owned() };
    let exponent = whole.len() as i64 - 1 - zeros as i64;
    let dot = if digits.len() > 1 { "." } else { "" };
    format!("{sign}{first}{dot}{}e{exponent}", &digits[1..])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown<const N: usize>(cells: [&str; N]) -> [String; N] {
        let mut cells = cells.map(str::to_owned);
        one_notation(&mut cells.iter_mut().collect::<Vec<_>>());
        cells
    }

    #[test]
    fn all_numbers_of_a_column_have_an_exponent_or_none() {
        assert_eq!(shown(["0.1779", "1.744e-5", "0", "-", "250"]), ["1.779e-1", "1.744e-5", "0", "-", "2.5e2"]);
        assert_eq!(shown(["[0.0012, 21]", "-3.5e-7 (!)", "10.40 %"]), ["[1.2e-3, 2.1e1]", "-3.5e-7 (!)", "1.040e1 %"]);
        assert_eq!(shown(["-0.02", "1e3"]), ["-2e-2", "1e3"]);
        // Without an exponent, and without a number, nothing is changed.
        for plain in [["0.1779", "250"], ["1/3", "2"], ["(none)", "e"]] {
            assert_eq!(shown(plain), plain);
        }
    }

    #[test]
    fn what_is_not_made_of_numbers_stays() {
        let cells = ["2*pi", "n_o = 10", "undefined", "1/500", "1e", "e5", "1.2.3", "paper-1e5"];
        let with = shown([cells[0], cells[1], cells[2], cells[3], cells[4], cells[5], cells[6], cells[7], "1e5"]);
        assert_eq!(with[..8], cells);
    }
}
