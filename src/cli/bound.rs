//! `sigmastar bound`.

use super::args::BoundArgs;
use super::failure::Failure;
use super::files::Input;
use super::progress::working;
use super::subject::Asked;
use super::{input, output};
use rug::Rational;
use sigmastar_exact::number::write_exact;
use sigmastar_prove::reduction::reduce_by_norms;
use sigmastar_studies::bounding::bounding_specification;

/// Runs the command and returns the exit code.
pub fn run(args: &BoundArgs) -> Result<u8, Failure> {
    let file = args.replace.asked(args.output.as_deref(), Input::Plant(&args.plant), "the specification")?;
    let asked = args.domain.as_deref().map(domain).transpose()?;
    let plant = Asked::read(&args.plant)?.plant("`bound`")?;
    let working = working("finding the orbit and proving the plant's bounds", "", args.quiet);
    let refused = |refusal: sigmastar_prove::reduction::PlantRefusal| Failure::Documents(refusal.errors(&plant));
    let reduced = reduce_by_norms(&plant).map_err(refused)?;
    let bounded = bounding_specification(&plant, &reduced.spec, asked).map_err(refused)?;
    drop(working);
    let text = format!("{:#}\n", bounded.document);
    if let Some(file) = file {
        file.write(&text)?;
    } else if let Err(code) = output::data(&text) {
        return Ok(code);
    }
    if !args.quiet {
        let [x, e] = bounded.domain.each_ref().map(write_exact);
        let place = args.output.as_deref().map(|path| format!("`{}`: ", output::shown(path))).unwrap_or_default();
        let end = if bounded.limited { ", the domain of the plant" } else { "" };
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
