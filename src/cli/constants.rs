//! `sigmastar constants`.

use super::args::ConstantsArgs;
use super::failure::Failure;
use super::output;
use super::subject::{Asked, Subject, proved};
use sigmastar_document::Made;
use sigmastar_lang::spec::{InputGain, Specification};
use sigmastar_prove::certify::{Member, Options, Wanted, certify_member};
use sigmastar_prove::rate::oscillators::lemma;
use sigmastar_report::ConstantsReport;
use sigmastar_theory::data::Data;

/// The numbers of oscillators that Lemma 1 is shown for.
const SHOWN_N_O: [u32; 6] = [0, 1, 2, 5, 10, 20];

/// Runs the command and returns the exit code.
pub fn run(args: &ConstantsArgs) -> Result<u8, Failure> {
    let (report, code) = worked_out(Asked::read(&args.spec)?.subject()?, args.quiet)?;
    Ok(output::data(&output::report(&report, args.format)).err().unwrap_or(code))
}

/// The report on a specification, as a part of another one; none where there is none.
pub fn beside(spec: &Specification) -> Option<Made> {
    worked_out(Subject::Specification(Box::new(spec.clone())), true).ok().map(|(report, _)| report)
}

/// The report, and the exit code.
fn worked_out(subject: Subject, quiet: bool) -> Result<(Made, u8), Failure> {
    if let Subject::Plant(_) = subject {
        let help = "`sigmastar bound FILE -o SPEC` writes those of a plant; then `sigmastar constants SPEC`";
        return Err(Failure::call("the paper's constants are about bounding functions, and this is a plant", help));
    }
    let (spec, start) = proved(subject, quiet)?;
    if let Some(field) = unknown(&spec) {
        let message = format!("the paper's constants know nothing of `{field}`");
        return Err(Failure::call(message, "leave it out, or give one value; `certify` takes it"));
    }
    let options = Options::default();
    let member = Member::new(&spec, start.as_ref(), options);
    let run = certify_member(&member, options, Wanted::default())
        .map_err(|refusal| Failure::Documents(refusal.errors(&spec)))?;
    let data = Data::new(&spec, options.ladder.start);
    let lemma_1 = SHOWN_N_O.map(|n_o| (n_o, lemma(&data, n_o)));
    Ok((Made::of(&ConstantsReport { run: &run, lemma_1: &lemma_1 }), run.verdict.exit_code()))
}

/// A field of the specification of which the paper's formulas know nothing.
fn unknown(spec: &Specification) -> Option<&'static str> {
    let uncertain = spec.input_gain.as_ref().is_some_and(|gain| !InputGain::is_nominal(gain));
    let fields = [
        ("input_gain", uncertain),
        ("actuator", spec.actuator.is_some()),
        ("period", spec.period.interval().is_some()),
    ];
    fields.into_iter().find_map(|(field, is_there)| is_there.then_some(field))
}
