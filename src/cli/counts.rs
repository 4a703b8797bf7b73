//! Lists of numbers of oscillators: `0,1,5..10,inf`.

use super::failure::Failure;
use sigmastar::transfer::OscillatorCount;

/// The most numbers of oscillators that one call looks at.
const MOST: usize = 10_000;

/// Reads a list of numbers and ranges (both ends included), in the order in which they are written.
///
/// # Errors
/// A part that is neither, an empty range, and more than 10000 numbers.
pub fn counts(text: &str) -> Result<Vec<OscillatorCount>, Failure> {
    let wrong = |part: &str| {
        Failure::call(
            format!("`{part}` in --n-o is no number of oscillators and no range of them"),
            "write whole numbers from 0 on and ranges from the smaller to the larger one, such as `0,1,2,10..20`",
        )
    };
    let mut all = Vec::new();
    for part in text.split(',').map(str::trim) {
        let number = |text: &str| text.trim().parse::<u64>().map_err(|_| wrong(part));
        if part == "inf" {
            all.push(OscillatorCount::Infinite);
        } else if let Some((first, last)) = part.split_once("..") {
            let (first, last) = (number(first)?, number(last.trim_start_matches('='))?);
            if first > last {
                return Err(wrong(part));
            }
            all.extend((first..=last).take(MOST + 1).map(OscillatorCount::Finite));
        } else {
            all.push(OscillatorCount::Finite(number(part)?));
        }
        if all.len() > MOST {
            let message = format!("--n-o has more than {MOST} numbers of oscillators");
            return Err(Failure::call(message, "ask for fewer: what holds for every n_o is said without them"));
        }
    }
    Ok(all)
}

/// Reads such a list where only finite numbers up to a limit have an answer.
///
/// # Errors
/// Those of [`counts`]; `inf`, and a number beyond the limit.
pub fn finite_counts(text: &str, limit: u32) -> Result<Vec<u32>, Failure> {
    let beyond = |n_o: OscillatorCount| {
        Failure::call(format!("--n-o {n_o}: no answer is worked out beyond n_o = {limit}"), "ask for smaller numbers")
    };
    let finite = |n_o: OscillatorCount| match n_o {
        OscillatorCount::Finite(n) => u32::try_from(n).ok().filter(|n| *n <= limit).ok_or_else(|| beyond(n_o)),
        OscillatorCount::Infinite => Err(beyond(n_o)),
    };
    counts(text)?.into_iter().map(finite).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_and_ranges_are_read() {
        let finite = |list: &[u64]| list.iter().copied().map(OscillatorCount::Finite).collect::<Vec<_>>();
        assert_eq!(counts("0").unwrap(), finite(&[0]));
        assert_eq!(counts("3, 5..7,1000000000").unwrap(), finite(&[3, 5, 6, 7, 1_000_000_000]));
        assert_eq!(counts("5..=6").unwrap(), finite(&[5, 6]));
        assert_eq!(counts("5 .. 6").unwrap(), finite(&[5, 6]));
        assert_eq!(counts("1,inf").unwrap()[1], OscillatorCount::Infinite);
        for wrong in ["", "1,,2", "-1", "2..1", "a", "1..", "0..18446744073709551615", "1.5"] {
            assert!(counts(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_limit_refuses_what_is_beyond_it() {
        assert_eq!(finite_counts("0..2,200", 200).unwrap(), [0, 1, 2, 200]);
        for wrong in ["201", "inf", "0..201", "4294967296", "-1", "3..1"] {
            assert!(finite_counts(wrong, 200).is_err(), "{wrong}");
        }
    }
}
