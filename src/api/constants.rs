//! The constants of the paper for a specification, and what the repaired derivation makes of them.

use super::error::{Error, ErrorKind};
use super::report::Report;
use sigmastar_lang::spec::{InputGain, Specification};
use sigmastar_prove::certify::{Member, Options, Verdict, Wanted, certify_member};
use sigmastar_prove::rate::oscillators::lemma;
use sigmastar_prove::reduction::Subject;
use sigmastar_report::ConstantsReport;
use sigmastar_theory::data::Data;

/// The numbers of oscillators that Lemma 1 is shown for.
const SHOWN_N_O: [u32; 6] = [0, 1, 2, 5, 10, 20];

/// The report on a specification, and the verdict on it; `proved` is called when its data are proved.
///
/// # Errors
/// [`Options`](ErrorKind::Options) for a plant, and for a specification with fields of which the paper's formulas know nothing; what keeps
/// the data from being proved.
pub fn constants_of(subject: Subject, proved: impl FnOnce()) -> Result<(Report, Verdict), Error> {
    if let Subject::Plant(_) = subject {
        let help = "`sigmastar bound FILE -o SPEC` writes those of a plant; then `sigmastar constants SPEC`";
        let message = "the paper's constants are about bounding functions, and this is a plant";
        return Err(Error::new(ErrorKind::Options, message, help));
    }
    let (spec, start) = subject.proved().map_err(|all| Error::documents(&all))?;
    proved();
    if let Some(field) = unknown(&spec) {
        let message = format!("the paper's constants know nothing of `{field}`");
        return Err(Error::new(ErrorKind::Options, message, "leave it out, or give one value; `certify` takes it"));
    }
    let options = Options::default();
    let member = Member::new(&spec, start.as_ref(), options);
    let run = certify_member(&member, options, Wanted::default())
        .map_err(|refusal| Error::documents(&refusal.errors(&spec)))?;
    let data = Data::new(&spec, options.ladder.start);
    let lemma_1 = SHOWN_N_O.map(|n_o| (n_o, lemma(&data, n_o)));
    Ok((Report::of(&ConstantsReport { run: &run, lemma_1: &lemma_1 }), run.verdict))
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
