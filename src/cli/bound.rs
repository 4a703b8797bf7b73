//! `sigmastar bound`.

use super::args::BoundArgs;
use super::failure::Failure;
use super::files::Input;
use super::progress::working;
use super::subject::Asked;
use super::{input, output};
use rug::Rational;
use sigmastar::program::bounds_of;

/// Runs the command and returns the exit code.
pub fn run(args: &BoundArgs) -> Result<u8, Failure> {
    let file = args.replace.asked(args.output.as_deref(), Input::Plant(&args.plant), "the specification")?;
    let asked = args.domain.as_deref().map(domain).transpose()?;
    let plant = Asked::read(&args.plant)?.plant("`bound`")?;
    let working = working("finding the orbit and proving the plant's bounds", "", args.quiet);
    let bounded = bounds_of(&plant, asked)?;
    drop(working);
    if let Some(file) = file {
        file.write(bounded.to_json())?;
    } else if let Err(code) = output::data(bounded.to_json()) {
        return Ok(code);
    }
    if !args.quiet {
        let [x, e] = bounded.domain();
        let place = args.output.as_deref().map(|path| format!("`{}`: ", output::shown(path))).unwrap_or_default();
        let end = if bounded.is_limited() { ", the domain of the plant" } else { "" };
        output::remark(&format!("{place}every bound is proved for |y| <= {x}, |e| <= {e}{end}"));
    }
    Ok(0)
}

/// `X,E`.
fn domain(text: &str) -> Result<[Rational; 2], Failure> {
    let wrong = || {
        let message = format!("`{text}` is no domain: two positive rational numbers, X and E, are expected");
        Failure::call(message, "write --domain 0.5,2 for |y| <= 0.5, |e| <= 2")
    };
    let (x, e) = text.split_once(',').ok_or_else(wrong)?;
    let number = |part: &str| {
        let constant = input::positive("--domain", part.trim())?;
        constant.as_rational().cloned().ok_or_else(wrong)
    };
    Ok([number(x)?, number(e)?])
}
