//! `sigmastar certify`.

use super::args::CertifyArgs;
use super::counts::finite_counts;
use super::failure::Failure;
use super::files::{Input, OutputFile};
use super::given::Given;
use super::output::{Format, Shortened, shown};
use super::stages::{Stages, Step};
use super::subject::{Asked, Subject, proving};
use super::{input, output};
use sigmastar::program::{Afterwards, Drawn, FIGURE_FILES, decided, not_told_apart, report_of};
use sigmastar_document::number::estimate;
use sigmastar_exact::number::write_exact;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Constant, ErrorKind, Oscillators, SpecErrors};
use sigmastar_prove::certificate::{certificate_of, is_sampled, read_for};
use sigmastar_prove::certify::{FarStart, Limits, NoRatesOfClaim, rate_counts, unusual};
use sigmastar_prove::reduction::{INITIAL_SET, Prepared, Run, Shrunk, Stage, Unwatched, Watch, for_every_set, shrunk};
use sigmastar_report::Origin;
use std::path::Path;

/// How to hear of the stages where standard error is no terminal.
const TOLD_MORE: &str = "; `--progress` tells how far it is";

/// Runs the command and returns the exit code.
pub fn run(args: &CertifyArgs) -> Result<u8, Failure> {
    // What is wrong with the call is said before any work is done.
    let is_page = |path: &&Path| path.extension().is_some_and(|end| end == "html" || end == "htm");
    if let Some(page) = args.output.as_deref().filter(is_page) {
        let message = format!("`-o {}` would write the certificate, which is JSON, into a page", shown(page));
        return Err(Failure::call(message, "the page goes to standard output: `--format html > report.html`"));
    }
    let output = args.replace.asked(args.output.as_deref(), Input::Specification(&args.spec), "the certificate")?;
    if let Some(folder) = &args.plots {
        args.replace.folder(folder, &FIGURE_FILES)?;
    }
    let (targets, limits) = (targets(args)?, limits(args)?);
    let same = args.witness.as_ref().is_some_and(|witness| *witness == args.spec);
    if same && args.spec == Path::new("-") {
        return Err(Failure::call("standard input is read once", "name a file in the place of one `-`"));
    }
    let Asked { mut document, given } = Asked::read(&args.spec)?;
    if same && given.is_none() {
        let message = "the specification and the witness cannot be the same file";
        return Err(Failure::call(message, "--witness names a certificate written with -o"));
    }
    if let Some(text) = &args.sampling_period {
        document = input::with_sampling_period(&document, "--sampling-period", text)?;
    }
    if !args.harmonics.is_empty() {
        document = for_every_set(&document)?;
    }
    let subject = Subject::read(&document)?;
    let witness = args.witness.as_deref().map(input::written).transpose()?;
    let gain = args.sigma.as_deref().map(|text| input::rational("--sigma", text)).transpose()?;
    let sampled = witness.as_ref().map_or(subject.sampling().is_some(), is_sampled);
    let kind = (sampled, subject.internal_model().asks_every_set());
    if let Some([message, help]) = args.options().misfit(kind, "--transfer") {
        return Err(Failure::call(message, help));
    }
    let counts = counts(args)?;
    if let Some([message, help]) = not_told_apart(&args.harmonics, &subject, "--harmonics") {
        return Err(Failure::call(message, help));
    }
    if let Some(given) = given.filter(|_| witness.is_none() && !args.quiet) {
        output::remark(&anew(subject.kind(), &given, (gain.is_some(), &limits)));
    }
    let plant = match &subject {
        Subject::Plant(plant) if !args.quiet => Some(plant),
        _ => None,
    };
    if let Some(unused) = plant.and_then(|plant| plant.parameters.unused_in_words()) {
        // The search may take long.
        output::remark(&unused);
    }
    if !args.quiet {
        let gain = match &subject {
            Subject::Plant(plant) => plant.input_gain.as_ref(),
            Subject::Specification(spec) => spec.input_gain.as_ref(),
        };
        unusual(subject.internal_model(), subject.period(), gain).iter().for_each(|said| output::remark(said));
    }
    let stages = Stages::new(steps(args, &subject), args.progress, args.quiet);
    let working = (!stages.are_told()).then(|| proving(&subject, TOLD_MORE, args.quiet)).flatten();
    let prepared = match &witness {
        None => Prepared::seeking(&subject, gain.clone(), (&limits, &counts), args.options(), &stages),
        Some(certificate) => {
            if subject.as_claimed(certificate).is_some() {
                let message = "the certificate keeps to its actuator by its bounds by the number of oscillators, which --witness does not decide";
                return Err(Failure::call(message, "`sigmastar check` decides it"));
            }
            let witness = read_for(certificate, &subject)?;
            if witness.of_another && !args.quiet {
                let kind = subject.kind();
                output::remark(&format!(
                    "the certificate was made for another {kind}; its witness is tried on this one"
                ));
            }
            stages.begin(Step::Of(first(&subject)));
            Prepared::again(&subject, witness)
        }
    };
    let prepared = match prepared {
        Err(errors) if witness.is_none() && !args.no_alternatives && is_of_set(&errors) => {
            let found = shrunk(&document, gain.as_ref(), (&limits, &counts), args.options(), &stages);
            Err(found.map_or(errors.clone(), |found| {
                errors.into_iter().map(|errors| errors.with_more_help(&in_words(&found))).collect()
            }))
        }
        prepared => prepared,
    };
    drop(working);
    let prepared = prepared.map_err(Failure::Documents)?.with_sets(args.harmonics.clone());
    let watch: &dyn Watch = match &witness {
        None => &stages,
        Some(_) => {
            // Nothing is searched for.
            stages.begin(Step::Decision);
            &Unwatched
        }
    };
    let run = decided(&prepared, (args.options(), &counts), ["--n-o", "--harmonics"], watch, &|next| {
        stages.begin(Step::After(next))
    })?;
    let origin = match (&witness, &args.output) {
        (Some(_), _) => Origin::Witness,
        (None, Some(_)) => Origin::Written,
        (None, None) => Origin::Search,
    };
    let report = report_of(&run, targets, origin, output::extent(args.format, args.full));
    let page = args.format == Format::Html;
    stages.begin(Step::Figures);
    let drawn = (page || args.plots.is_some()).then(|| Drawn::of(&run)).flatten();
    drop(stages);
    if let Some(folder) = &args.plots {
        match drawn.as_ref().map(Drawn::named) {
            None => output::remark(&format!("no figures were written: the verdict is {}", run.verdict())),
            Some(Err(why)) => output::remark(&why),
            Some(Ok(figures)) => {
                args.replace.figures(folder, &figures, Input::Specification(&args.spec), "leave --plots out")?;
            }
        }
    }
    let shown = match drawn.filter(|_| page) {
        Some(drawn) => Shortened::new(&drawn.in_front_of_the_rest(&*report), args.format, args.full),
        None => Shortened::new(&*report, args.format, args.full),
    };
    let code = tell(args, &run, &shown, output.as_ref())?;
    if let Some(remark) = without_bounds(&run, &args.harmonics, args.options().compare).filter(|_| !args.quiet) {
        output::remark(&remark);
    }
    if let Some(far) = plant.and_then(|plant| far_start(&run, plant)) {
        output::remark(&far.describe());
    }
    Ok(code)
}

/// That a certificate is taken for its document alone, and what keeps its gain.
fn anew(kind: &str, given: &Given, (gain, limits): (bool, &Limits)) -> String {
    let (which, keeps) = match (gain, limits.is_empty()) {
        (true, _) => ("this gain", String::new()),
        (false, true) => {
            ("the smallest gain that is found", format!("; `--sigma {}` keeps its gain", write_exact(given.sigma())))
        }
        (false, false) => ("a gain that keeps these limits", String::new()),
    };
    format!(
        "this makes a new claim about the {kind} in the certificate, with {which}{keeps}; `check` decides the claim of the certificate itself"
    )
}

/// Of which sets that were asked for a certified run has no bounds of their own, in words.
fn without_bounds(run: &Run<'_>, sets: &[Oscillators], compare: bool) -> Option<String> {
    run.certified()?;
    let found = match run {
        Run::Continuous(run) => &run.by_count,
        Run::Sampled(run) => &run.by_count,
    };
    let found = found.as_ref().map_or(&[][..], |found| &found.counts);
    let is_missing = |set: &&Oscillators| set.n_o().is_none() && found.iter().all(|bounds| bounds.oscillators != **set);
    let missing: Vec<&Oscillators> = sets.iter().filter(is_missing).collect();
    let said = run.of_counts();
    let have_rates = missing.iter().all(|set| said.iter().any(|said| said.oscillators == *set));
    let but = if have_rates { " but rates" } else { "" };
    let missing: Vec<String> = missing.iter().map(ToString::to_string).collect();
    let why = match run {
        _ if !compare => "`--no-alternatives` leaves them out",
        Run::Sampled(_) => {
            "at samples they are proved of plants by formulas, with a delay of those that are linear in x and e, where the independent checker decides them"
        }
        Run::Continuous(_) => {
            "they are proved of plants with a matched base frequency, where the independent checker decides them"
        }
    };
    (!missing.is_empty()).then(|| {
        format!("no bounds of their own{but} were proved for {}, which the claim covers; {why}", missing.join("; "))
    })
}

/// The start of simulations that the plant states, where it is far outside of what is certified.
fn far_start(run: &Run<'_>, plant: &Plant) -> Option<FarStart> {
    plant.document.get("initial")?;
    let set = run.certified()?.set;
    FarStart::of(run.spec().plant()?, &plant.initial, [&set.x0, &set.e0])
}

/// Whether the initial set that the file states is all that is in the way.
fn is_of_set(errors: &[SpecErrors]) -> bool {
    let mut all = errors.iter().flat_map(SpecErrors::errors);
    all.all(|error| error.kind == ErrorKind::Undecided && error.pointer == INITIAL_SET)
}

/// What was found with smaller sizes of the initial set.
fn in_words(Shrunk { divisor, fails, sizes, sigma }: &Shrunk) -> String {
    let sizes: Vec<String> = sizes.iter().map(|(name, size)| format!("`{name}` {}", estimate(size.to_f64()))).collect();
    let sizes = sizes.join(", ");
    match sigma {
        Some(sigma) => format!(
            "with all sizes divided by {divisor} ({sizes}) the gain {} is certified, with {} none was found",
            write_exact(sigma),
            match divisor / fails {
                2 => "twice them".to_owned(),
                times => format!("{times} times them"),
            }
        ),
        None => format!(
            "with all sizes divided by {divisor} ({sizes}) no gain is found either: something else is in the way, too"
        ),
    }
}

/// The stages that the call will have.
fn steps(args: &CertifyArgs, subject: &Subject) -> Vec<Step> {
    let data = match (subject, args.witness.is_some()) {
        (Subject::Plant(_), false) => vec![Stage::Orbit, Stage::Coordinates, Stage::Bounds],
        (Subject::Plant(_), true) => vec![Stage::Bounds],
        (Subject::Specification(spec), _) if spec.lyapunov.triple().is_none() => vec![Stage::Triple],
        (Subject::Specification(_), _) => Vec::new(),
    };
    let has_rates = args.n_o.is_some() || !args.harmonics.is_empty();
    let after = [Afterwards::Rates, Afterwards::Checked].map(Step::After).into_iter().filter(|_| has_rates);
    let figures = (args.format == Format::Html || args.plots.is_some()).then_some(Step::Figures);
    let claim = if args.witness.is_some() { Step::Decision } else { Step::Of(Stage::Witness) };
    data.into_iter().map(Step::Of).chain([claim]).chain(after).chain(figures).collect()
}

/// The stage in which the data of a witness are proved again.
fn first(subject: &Subject) -> Stage {
    match subject {
        Subject::Plant(_) => Stage::Bounds,
        Subject::Specification(_) => Stage::Triple,
    }
}

/// The numbers of oscillators whose rates are asked for.
fn counts(args: &CertifyArgs) -> Result<Vec<u32>, Failure> {
    let Some(text) = &args.n_o else { return Ok(Vec::new()) };
    rate_counts(&finite_counts(text)?).map_err(no_rates)
}

fn no_rates(reason: NoRatesOfClaim) -> Failure {
    Failure::call(reason.message("--n-o"), reason.help())
}

/// What is to be kept at the gain.
fn limits(args: &CertifyArgs) -> Result<Limits, Failure> {
    let limit = |flag: &str, text: &Option<String>| text.as_deref().map(|text| input::rational(flag, text)).transpose();
    Ok(Limits {
        steady_error: args
            .steady_error
            .as_deref()
            .map(|text| input::steady_error("--steady-error", text))
            .transpose()?,
        peak_error: limit("--peak-error", &args.peak_error)?,
        control: limit("--max-control", &args.max_control)?,
        rate: limit("--rate", &args.rate)?,
        ..Limits::default()
    })
}

/// Targets of sup|e| and rms e.
fn targets(args: &CertifyArgs) -> Result<[Option<Constant>; 2], Failure> {
    let target = |flag, text: &Option<String>| text.as_deref().map(|text| input::positive(flag, text)).transpose();
    Ok([target("--target-sup", &args.target_sup)?, target("--target-rms", &args.target_rms)?])
}

/// Writes the certificate, or says why there is none; shows the report, and what is wrong with the bounding functions.
fn tell(args: &CertifyArgs, run: &Run<'_>, shown: &Shortened, file: Option<&OutputFile>) -> Result<u8, Failure> {
    let verdict = run.verdict();
    match (file, file.and_then(|_| certificate_of(run))) {
        (None, _) => {}
        (Some(file), None) => {
            output::remark(&format!("`{}` was not written: the verdict is {verdict}", file.name()));
        }
        (Some(file), Some(certificate)) => {
            file.write(output::json_text(&certificate))?;
            if !args.quiet {
                output::remark(&format!("the certificate is in `{}`", file.name()));
            }
        }
    }
    if let Err(code) = shown.show(args.quiet) {
        return Ok(code);
    }
    let unproved = run.unproved();
    if !unproved.is_empty() && args.format != Format::Json {
        output::diagnostics(&unproved);
    }
    Ok(verdict.exit_code())
}
