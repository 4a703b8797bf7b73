//! `sigmastar transfer`.

use super::args::{Format, TransferArgs};
use super::failure::Failure;
use super::input;
use super::output::{self, OutputFile};
use super::progress::Bar;
use sigmastar::certificate::Verdict;
use sigmastar::enclosure::DEFAULT_PRECISION;
use sigmastar::report::{PairChoice, TransferReport, TransferRequest};
use sigmastar::simulate::Progress;
use sigmastar::spec::Specification;
use sigmastar::transfer::{OscillatorCount, PairError};
use std::path::Path;

/// The most numbers of oscillators that one call looks at.
const MOST: usize = 10_000;

/// Runs the command and returns the exit code.
pub fn run(args: &TransferArgs) -> u8 {
    attempt(args).unwrap_or_else(|failure| failure.tell(args.format, args.quiet))
}

fn attempt(args: &TransferArgs) -> Result<u8, Failure> {
    let plot = args.plot.as_deref().map(|path| svg_file(path, &args.spec)).transpose()?;
    let pair = match (&args.k0, &args.minimise) {
        (Some(text), _) => PairChoice::SmallestK1(input::positive("--k0", text)?),
        (None, Some(text)) => {
            let Some((a, b)) = text.split_once(',') else {
                return Err(Failure::call(
                    format!("`{text}` are not two weights"),
                    "write --minimise A,B with positive constants, such as `--minimise 1,2/3`",
                ));
            };
            let [a, b] = [a, b].map(|text| input::positive("--minimise", text.trim()));
            PairChoice::Cheapest { a: a?, b: b? }
        }
        (None, None) => PairChoice::ForData,
    };
    let n_o = counts(&args.n_o)?;
    let spec = Specification::from_value(&input::document(&args.spec)?.root())?;
    let bar = Bar::new(n_o.len() as u64, args.quiet);
    let request = TransferRequest { pair, n_o };
    let report = TransferReport::new(&spec, DEFAULT_PRECISION, &request, || bar.advance());
    bar.finish();
    let report = match report {
        Ok(report) => report,
        Err(error) => return Ok(no_pair(args, &error)),
    };
    if let Some(file) = &plot {
        let svg = report.plot().map_err(|reason| {
            Failure::call(format!("the plot cannot be drawn: {reason}"), "leave --plot out, and report this")
        })?;
        file.write(&svg)?;
        if !args.quiet {
            output::remark(&format!("the plot is in `{}`", file.name()));
        }
    }
    let text = output::report(&report, args.format);
    Ok(output::data(&text).map_or_else(|code| code, |()| Verdict::Certified.exit_code()))
}

/// The file of the plot, whose name says what is in it.
fn svg_file(path: &Path, input: &Path) -> Result<OutputFile, Failure> {
    let file = OutputFile::new(path, input, "the plot")?;
    if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("svg")) {
        return Ok(file);
    }
    let message = format!("`{}` does not end in `.svg`, and the plot is written as SVG only", file.name());
    Err(Failure::call(message, "name a file that ends in `.svg`; other programs turn it into PNG or PDF"))
}

/// Says why there is no pair, and returns the exit code.
fn no_pair(args: &TransferArgs, error: &PairError) -> u8 {
    let (verdict, help) = match error {
        PairError::BelowZeroValue { .. } => (Verdict::Refuted, "choose a k0 that is not below T_N(0)"),
        PairError::OutOfRange { .. } => {
            (Verdict::Undecided, "scale mu, base_frequency or the weights, or choose a k0 within 1e-300 to 1e300")
        }
        PairError::NotFound { .. } => (Verdict::Undecided, "choose a smaller k0, which lets k1 be larger"),
    };
    if args.format == Format::Json {
        let value = serde_json::json!({
            "format": "sigmastar/transfer", "version": 1, "verdict": verdict.to_string(),
            "reason": error.to_string(), "help": help,
        });
        return output::data(&output::json_text(&value)).map_or_else(|code| code, |()| verdict.exit_code());
    }
    output::error(&error.to_string(), help);
    output::remark(&verdict.to_string());
    verdict.exit_code()
}

/// Reads a list such as `0,1,5..10,inf`.
fn counts(text: &str) -> Result<Vec<OscillatorCount>, Failure> {
    let wrong = |part: &str| {
        Failure::call(
            format!("`{part}` is no number of oscillators and no range of them"),
            "write a list such as `0,1,2,10..20,1000000000,inf`",
        )
    };
    let mut all = Vec::new();
    for part in text.split(',').map(str::trim) {
        let number = |text: &str| text.parse::<u64>().map_err(|_| wrong(part));
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
            let message = format!("more than {MOST} numbers of oscillators");
            return Err(Failure::call(message, "ask for fewer: the pair holds for every number of oscillators anyway"));
        }
    }
    Ok(all)
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
        assert_eq!(counts("1,inf").unwrap()[1], OscillatorCount::Infinite);
        for wrong in ["", "1,,2", "-1", "2..1", "a", "1..", "0..18446744073709551615", "1.5"] {
            assert!(counts(wrong).is_err(), "{wrong}");
        }
    }
}
