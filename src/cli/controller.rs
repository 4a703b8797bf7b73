//! `sigmastar controller`.

use super::args::{ControllerArgs, RegulatorForm};
use super::failure::Failure;
use super::files::{Input, OutputFile, write_together};
use super::given::{Given, Regulated};
use super::input;
use super::output::{self, shown};
use super::subject::Asked;
use sigmastar_document::clean;
use sigmastar_lang::spec::{Actuator, Constant, Oscillators};
use sigmastar_prove::reduction::Subject;
use sigmastar_regulator::export::{self, CNames, CSources, Export, Prefix, Provenance, Scope};
use sigmastar_regulator::{Convergence, Design, Discrete, Regulator};
use std::path::{Path, PathBuf};

/// Runs the command and returns the exit code.
pub fn run(args: &ControllerArgs) -> Result<u8, Failure> {
    let (input, what) = (Input::Specification(&args.spec), "the regulator");
    let output = args.replace.asked(args.output.as_deref(), input, what)?;
    let c = match args.format {
        RegulatorForm::C => Some(CFiles::new(args, input)?),
        _ if args.prefix.is_some() || args.example => {
            return Err(Failure::call("--prefix and --example are for C code", "add --format c, or leave them out"));
        }
        _ => None,
    };
    let sigma = args.sigma.as_deref().map(|text| input::positive("--sigma", text)).transpose()?;
    let step = args.discretise.as_deref().map(|text| input::positive("--discretise", text)).transpose()?;
    let saturation = args.saturation.as_deref().map(|text| input::positive("--saturation", text)).transpose()?;
    let other = args.certificate.as_deref().map(|path| Given::read(&input::written(path)?)).transpose()?;
    let asked = Asked::read(&args.spec)?;
    let (subject, own) = (asked.subject()?, asked.given);
    if own.is_some() && other.is_some() {
        return Err(Failure::call("two certificates are given", "leave --certificate out"));
    }
    let given = own.or(other);
    let from_certificate = given.as_ref().and_then(Given::gain);
    let sigma = sigma.or(from_certificate).ok_or_else(|| {
        Failure::call("no gain is given", "give it with --sigma, or name a certificate, whose sigma* is taken then")
    })?;

    let step = step.or_else(|| given.as_ref().and_then(Given::step).cloned());
    let oscillators = args.oscillators();
    let design = Design::new(subject.internal_model(), &sigma, oscillators.clone()).for_actuator(subject.input_gain());
    let delayed = args.delay_samples.map(|count| count == 1).or(given.as_ref().and_then(Given::delayed));
    let delayed = delayed.unwrap_or(design.is_delayed());
    let design = design.with_delay(delayed);
    let asked = Regulated {
        model: subject.internal_model(),
        sigma: &sigma,
        step: step.as_ref(),
        delayed,
        oscillators: &oscillators,
    };
    let certificate = provenance(args, given.as_ref(), &subject, &asked)?;
    refuse(args, &design, step.as_ref(), certificate.as_ref())?;
    let about = given.as_ref().zip(certificate.as_ref()).filter(|_| !args.quiet);
    if let Some(remark) = about.and_then(|about| nothing_of_count(about, &oscillators)) {
        output::remark(&remark);
    }
    let regulator = design.regulator();
    let beyond = || {
        Failure::call(
            "a number of this regulator is beyond double precision",
            "use units of time in which the gains, frequencies and sampling time have ordinary magnitudes",
        )
    };
    // What the actuator takes, unless another limit is asked for.
    let actuator = subject.actuator().filter(|_| saturation.is_none());
    let limit = saturation.map(|limit| limit.to_f64()).or(actuator.map(Actuator::limit));
    let discrete = step.as_ref().map(|step| design.discretise(step).ok_or_else(beyond)).transpose()?;
    let discrete = discrete.map(|discrete| discrete.saturated(limit));
    if !regulator.is_representable() || !discrete.as_ref().is_none_or(Discrete::is_representable) {
        return Err(beyond());
    }
    let discrete = match discrete.as_ref().zip(step.as_ref()) {
        None => None,
        Some((discrete, step)) => {
            let sampled = Convergence::new(&design, step, &regulator, discrete).ok_or_else(beyond)?;
            if !args.quiet {
                remarks((&design, step), (&regulator, discrete), sampled, certificate.as_ref());
            }
            Some((discrete, sampled))
        }
    };
    let export = Export {
        name: &clean(subject.name()),
        regulator: &regulator,
        oscillators: &oscillators,
        discrete,
        aligned: subject.starts_aligned(),
        actuator,
        middle: subject.actuator().and_then(Actuator::middle).map(|middle| middle.to_f64()),
        certificate: certificate.as_ref(),
    };
    let text = match args.format {
        RegulatorForm::Json => output::json_text(&export::json(&export)),
        RegulatorForm::Matlab => export::matlab(&export),
        RegulatorForm::Npz => return npz(&export, output.as_ref()),
        RegulatorForm::C if discrete.is_none() => {
            return Err(Failure::call("C code runs at samples", "give the sampling time with --discretise"));
        }
        RegulatorForm::C => return c.map_or_else(|| Err(needs_file()), |files| files.write(&export)),
    };
    match output {
        Some(file) => file.write(text).map(|()| 0),
        None => Ok(output::data(&text).err().unwrap_or(0)),
    }
}

/// What the certificate has to do with this regulator; one that is about something else is refused, or told and left out.
fn provenance(
    args: &ControllerArgs,
    given: Option<&Given>,
    subject: &Subject,
    asked: &Regulated<'_>,
) -> Result<Option<Provenance>, Failure> {
    let Some(given) = given else { return Ok(None) };
    if given.is_about(subject.sha256()) {
        return given.provenance(asked).map(Some);
    }
    let message =
        format!("the certificate was made for another {}: it says nothing about this regulator", subject.kind());
    if !args.uncertified {
        let way_out = "certify this one; --uncertified exports it as it is, with the gain of that certificate where none is given";
        return Err(Failure::call(message, way_out));
    }
    output::remark(&format!("{message}; exported because of --uncertified"));
    Ok(None)
}

/// That a certificate which covers the regulator says nothing of its number of oscillators alone.
fn nothing_of_count((given, certificate): (&Given, &Provenance), oscillators: &Oscillators) -> Option<String> {
    let n_o = oscillators.n_o().filter(|n_o| certificate.scope.covers() && !given.says_of(*n_o))?;
    Some(format!(
        "the claim of the certificate covers n_o = {n_o}, but the certificate has no rate and no bounds for this number of oscillators; `certify --n-o \
         {n_o}` seeks them"
    ))
}

/// Refuses what is known to be bad; with `--uncertified` it is told instead.
fn refuse(
    args: &ControllerArgs,
    design: &Design<'_>,
    step: Option<&Constant>,
    certificate: Option<&Provenance>,
) -> Result<(), Failure> {
    let mut reasons: Vec<(String, String)> = Vec::new();
    for error in step.map_or_else(Vec::new, |step| design.sampling_errors(step)) {
        reasons.push((error.to_string(), error.way_out()));
    }
    if let Some(Provenance { sigma_star, scope, .. }) = certificate {
        let way_out = match scope {
            Scope::OtherGain => "leave --sigma out where a certificate is exported",
            Scope::OtherSamples => "leave --sigma and --discretise out, and take harmonics below half of the samples",
            Scope::OtherHarmonics { .. } => {
                "make the certificate with `\"harmonics\": \"every-set\"` in `internal_model`, or take the first n_o harmonics by --n-o"
            }
            _ => "take a gain of at least sigma*, or leave --sigma out where a certificate is exported",
        };
        let message = match scope {
            Scope::BelowSigmaStar => Some(format!("sigma is below sigma* = {sigma_star} of the certificate")),
            _ => scope.obstacle(sigma_star).map(|why| format!("the certificate is not about this regulator: {why}")),
        };
        reasons.extend(message.map(|message| (message, way_out.to_owned())));
    }
    for (message, way_out) in reasons {
        if !args.uncertified {
            return Err(Failure::call(message, format!("{way_out}; --uncertified exports it as it is")));
        }
        output::remark(&format!("{message}; exported because of --uncertified"));
    }
    Ok(())
}

/// Says what the sampling does that is no reason to refuse it.
fn remarks(
    (design, step): (&Design<'_>, &Constant),
    (regulator, discrete): (&Regulator, &Discrete),
    sampled: Convergence,
    certificate: Option<&Provenance>,
) {
    if let Some(Provenance { scope: Scope::Continuous, .. }) = certificate {
        output::remark(&format!(
            "the certificate is about the law in continuous time and does not cover sampling; `certify --sampling-period {}` makes one for \
             the law at samples",
            clean(&step.text)
        ));
    }
    if let Some(samples) = design.uneven_samples(step) {
        output::remark(&format!(
            "a period has {samples:.6} samples, not a whole number: the samples fall differently in every period, and the \
             error at them is not periodic"
        ));
    }
    if sampled.is_unstable() {
        output::remark(&format!("{sampled}; the export says so too"));
    }
    // A computation that is late costs most where an oscillator turns by a quarter of a turn in a sample or more.
    let late = Convergence::late(regulator, discrete).filter(|late| late.is_unstable() || design.turns_far(step));
    if let Some(late) = late {
        let what = if late.is_unstable() { "makes that loop unstable" } else { "brings that loop to the edge" };
        output::remark(&format!(
            "the control has to be put out at its own sample: a computation that takes the whole sample {what} (spectral radius \
             {} on e' = u); `delay_samples` 1 in the internal model, or --delay-samples 1, is the law for that",
            late.spectral_radius()
        ));
    }
}

fn npz(export: &Export<'_>, output: Option<&OutputFile>) -> Result<u8, Failure> {
    let file =
        output.ok_or_else(|| Failure::call("an archive is not text for standard output", "name a file with -o"))?;
    let bytes = export::npz(export).map_err(|error| {
        Failure::call(format!("the archive cannot be made: {error}"), "try another --format, such as json")
    })?;
    file.write(bytes).map(|()| 0)
}

fn needs_file() -> Failure {
    let help = "give it with -o, as `-o regulator.c`; the header goes beside it";
    Failure::call("the C source needs a file whose name ends in `.c`", help)
}

/// The files of C code, checked before the work starts.
struct CFiles {
    source: OutputFile,
    header: OutputFile,
    example: Option<OutputFile>,
    names: CNames,
}

impl CFiles {
    fn new(args: &ControllerArgs, input: Input<'_>) -> Result<CFiles, Failure> {
        let path = args.output.as_deref();
        let path = path.filter(|path| path.extension().is_some_and(|extension| extension == "c"));
        let path = path.ok_or_else(needs_file)?;
        let prefix = match &args.prefix {
            None => Prefix::default(),
            Some(text) => Prefix::new(text).map_err(|error| {
                Failure::call(format!("`{}` cannot begin C names: {error}", shown(Path::new(text))), "such as `axis_1`")
            })?,
        };
        let header = path.with_extension("h");
        let name = header.file_name().map_or_else(String::new, |name| shown(Path::new(name)));
        if name.contains(['"', '\\']) {
            let message = format!("`{name}` cannot be included by C code");
            return Err(Failure::call(message, "name a file without quotes"));
        }
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let example: Option<PathBuf> = args.example.then(|| path.with_file_name(format!("{stem}_example.c")));
        let what = "the regulator";
        Ok(CFiles {
            source: args.replace.file(path, input, what)?,
            header: args.replace.file(&header, input, what)?,
            example: args.replace.asked(example.as_deref(), input, "the example")?,
            names: CNames { header: name, prefix },
        })
    }

    fn write(&self, export: &Export<'_>) -> Result<u8, Failure> {
        let CSources { header, source, example } = export::c_sources(export, &self.names).ok_or_else(needs_file)?;
        let mut files = vec![(&self.header, header.as_bytes()), (&self.source, source.as_bytes())];
        files.extend(self.example.as_ref().map(|file| (file, example.as_bytes())));
        write_together(&files).map(|()| 0)
    }
}
