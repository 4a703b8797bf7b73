//! Numbers of oscillators on the command line: `0,1,5..10,20..100/10,inf`, the same in every `--n-o`.

use super::failure::Failure;
use sigmastar::TransferOptions;
use sigmastar_lang::spec::{NoSet, Oscillators};

/// The largest harmonic of an oscillator that is exported or simulated.
pub const LARGEST_HARMONIC: u32 = 10_000;

/// The most numbers of oscillators that one call looks at.
const MOST: usize = TransferOptions::MOST;

/// Reads a list of numbers (`None` for infinitely many) and ranges (both ends included, `first..last/step` in steps), in the order in which they are
/// written.
///
/// # Errors
/// A part that is neither, an empty range, a step of 0, and more than 10000 numbers.
pub fn counts(text: &str) -> Result<Vec<Option<u64>>, Failure> {
    let wrong = |part: &str| {
        Failure::call(
            format!("`{part}` in --n-o is no number of oscillators and no range of them"),
            "write whole numbers from 0 on and ranges from the smaller to the larger one, such as `0,1,2,10..20`, or \
             `0..100/10` in steps of 10",
        )
    };
    let mut all = Vec::new();
    for part in text.split(',').map(str::trim) {
        let number = |text: &str| text.trim().parse::<u64>().map_err(|_| wrong(part));
        if part == "inf" {
            all.push(None);
        } else if let Some((first, last)) = part.split_once("..") {
            let (last, step) = last.split_once('/').unwrap_or((last, "1"));
            let (first, last, step) = (number(first)?, number(last.trim_start_matches('='))?, number(step)?);
            if first > last || step == 0 {
                return Err(wrong(part));
            }
            let next = |n: &u64| n.checked_add(step).filter(|n| *n <= last);
            all.extend(std::iter::successors(Some(first), next).take(MOST + 1).map(Some));
        } else {
            all.push(Some(number(part)?));
        }
        if all.len() > MOST {
            let message = format!("--n-o has more than {MOST} numbers of oscillators");
            return Err(Failure::call(message, "ask for fewer: what holds for every n_o is said without them"));
        }
    }
    Ok(all)
}

/// Reads such a list where only finite numbers have an answer.
///
/// # Errors
/// Those of [`counts`]; `inf`, and a number that no regulator has.
pub fn finite_counts(text: &str) -> Result<Vec<u32>, Failure> {
    let beyond = |n_o: Option<u64>| {
        let n_o = n_o.map_or_else(|| "infinity".to_owned(), |n_o| n_o.to_string());
        Failure::call(format!("--n-o {n_o}: there is an answer for finite numbers alone"), "ask for smaller numbers")
    };
    let finite = |n_o: Option<u64>| n_o.and_then(|n| u32::try_from(n).ok()).ok_or_else(|| beyond(n_o));
    counts(text)?.into_iter().map(finite).collect()
}

/// Reads the number of oscillators of one regulator, for clap.
///
/// # Errors
/// What is wrong, in words: a list or a range among it, which other commands take.
pub fn one_count(limit: u32) -> impl Fn(&str) -> Result<u32, String> + Clone {
    move |text| {
        let text = text.trim();
        match text.parse::<i64>() {
            Ok(n) => match u32::try_from(n) {
                Ok(small) if small <= limit => Ok(small),
                _ => Err(format!("{n} is not in 0..={limit}")),
            },
            Err(_) if counts(text).is_ok() => {
                Err("this is about one regulator, with one number of oscillators: call it for each of them".to_owned())
            }
            Err(_) => Err(format!("expected a whole number from 0 to {limit}")),
        }
    }
}

/// Reads the harmonics of the oscillators of one regulator, for clap: `0,1,5,7` or `0,1..13/2`, at most so many beside 0, and none above the largest.
///
/// # Errors
/// What is wrong, in words: a list without 0, a harmonic that is there twice or is too large.
pub fn harmonics(most: u32, largest: u32) -> impl Fn(&str) -> Result<Oscillators, String> + Clone {
    move |text| {
        let all = counts(text)
            .map_err(|_| "expected harmonics and ranges of them, such as `0,1,5,7` or `0,1..13/2`".to_owned())?;
        let small = |k: Option<u64>| k.and_then(|k| u32::try_from(k).ok()).filter(|k| *k <= largest);
        let all: Option<Vec<u32>> = all.into_iter().map(small).collect();
        let all = all.ok_or_else(|| format!("a harmonic is a whole number up to {largest} here"))?;
        let oscillators = Oscillators::at(&all).map_err(|error| match error {
            NoSet::WithoutZero => format!("{error}; write `0,{}`", text.trim()),
            NoSet::Twice(_) => error.to_string(),
        })?;
        if oscillators.count() > most as usize {
            return Err(format!("{} harmonics beside 0 are too many: at most {most}", oscillators.count()));
        }
        Ok(oscillators)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_and_ranges_are_read() {
        let finite = |list: &[u64]| list.iter().copied().map(Some).collect::<Vec<_>>();
        assert_eq!(counts("0").unwrap(), finite(&[0]));
        assert_eq!(counts("3, 5..7,1000000000").unwrap(), finite(&[3, 5, 6, 7, 1_000_000_000]));
        assert_eq!(counts("5..=6").unwrap(), finite(&[5, 6]));
        assert_eq!(counts("5 .. 6").unwrap(), finite(&[5, 6]));
        assert_eq!(counts("1,inf").unwrap()[1], None);
        assert_eq!(counts("0..100/25,7").unwrap(), finite(&[0, 25, 50, 75, 100, 7]));
        assert_eq!(counts("3..=10 / 4").unwrap(), finite(&[3, 7]));
        assert_eq!(counts("0..18446744073709551615/18446744073709551615").unwrap(), finite(&[0, u64::MAX]));
        for wrong in ["1..9/0", "9/2", "1..9/", "1..9/-1", "1..9/inf", "1..9/2/2", "0..99999/9"] {
            assert!(counts(wrong).is_err(), "{wrong}");
        }
        for wrong in ["", "1,,2", "-1", "2..1", "a", "1..", "0..18446744073709551615", "1.5"] {
            assert!(counts(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn one_regulator_has_one_number() {
        let read = one_count(200);
        assert_eq!((read("0"), read(" 200 ")), (Ok(0), Ok(200)));
        for (wrong, said) in
            [("201", "0..=200"), ("-1", "0..=200"), ("0..4", "for each"), ("1,2", "for each"), ("x", "whole")]
        {
            let error = read(wrong).unwrap_err();
            assert!(error.contains(said), "{error}");
        }
    }

    #[test]
    fn one_regulator_has_one_set_of_harmonics() {
        let read = harmonics(3, 10_000);
        assert_eq!(read("0,1, 5").unwrap().to_string(), "oscillators at the harmonics 0, 1, 5");
        assert_eq!(read("7,0,3..5/2").unwrap().beyond_mean(), [3, 5, 7]);
        assert_eq!(read("0..3").unwrap().n_o(), Some(3));
        for (wrong, said) in [
            ("1,5", "write `0,1,5`"),
            ("0,5,5", "harmonic 5 is there twice"),
            ("0,inf", "whole number up to"),
            ("0,10001", "up to 10000"),
            ("0..4", "at most 3"),
            ("0,x", "expected harmonics"),
            ("", "expected harmonics"),
        ] {
            let error = read(wrong).unwrap_err();
            assert!(error.contains(said), "{wrong}: {error}");
        }
    }

    #[test]
    fn infinitely_many_have_no_answer_here() {
        assert_eq!(finite_counts("0..2,200").unwrap(), [0, 1, 2, 200]);
        for wrong in ["inf", "0,inf", "4294967296", "-1", "3..1"] {
            assert!(finite_counts(wrong).is_err(), "{wrong}");
        }
    }
}
