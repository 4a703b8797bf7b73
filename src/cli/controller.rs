//! `sigmastar controller`.

use super::args::{ControllerArgs, Format, RegulatorForm};
use super::failure::Failure;
use super::files::{Input, OutputFile, write_together};
use super::input;
use super::output::{self, shown};
use super::subject::Subject;
use sigmastar::certificate::read_witness;
use sigmastar::enclosure::{DEFAULT_PRECISION, Enclosure};
use sigmastar::number::write_exact;
use sigmastar::regulator::export::{self, CSources, Export};
use sigmastar::regulator::{Design, Discrete, Regulator, SampledLoop};
use sigmastar::report::document::clean;
use sigmastar::spec::{Constant, Document};
use std::path::Path;

/// Runs the command and returns the exit code.
pub fn run(args: &ControllerArgs) -> u8 {
    attempt(args).unwrap_or_else(|failure| failure.tell(Format::Text, false))
}

fn attempt(args: &ControllerArgs) -> Result<u8, Failure> {
    let (input, what) = (Input::Specification(&args.spec), "the regulator");
    let output = OutputFile::asked(args.output.as_deref(), input, what)?;
    let header = match args.format {
        RegulatorForm::C => Some(header_path(args)?),
        _ => None,
    };
    let header = OutputFile::asked(header.as_deref(), input, what)?;
    let sigma = input::positive("--sigma", &args.sigma)?;
    let step = args.discretise.as_deref().map(|text| input::positive("--discretise", text)).transpose()?;
    let certificate = args.certificate.as_deref().map(input::document).transpose()?;
    let subject = Subject::read(&input::document(&args.spec)?)?;

    let design = Design::new(subject.internal_model(), &sigma, args.n_o);
    let regulator = design.regulator();
    if let Some(step) = &step {
        design.check_sampling(step).map_err(|error| Failure::call(error.to_string(), error.way_out()))?;
    }
    let discrete = step.map(|step| design.discretise(&step));
    let beyond = || {
        Failure::call(
            "a number of this regulator is beyond double precision",
            "use units of time in which the gains, frequencies and sampling time have ordinary magnitudes",
        )
    };
    if !regulator.is_representable() || !discrete.as_ref().is_none_or(Discrete::is_representable) {
        return Err(beyond());
    }
    let discrete = match discrete {
        None => None,
        Some(discrete) => {
            let sampled = SampledLoop::new(&regulator, &discrete).ok_or_else(beyond)?;
            Some((discrete, sampled))
        }
    };
    if let Some(document) = &certificate {
        compare(document, &subject, &sigma)?;
    }
    if let Some((discrete, sampled)) = &discrete {
        remarks(&regulator, discrete, *sampled);
    }
    let discrete = discrete.as_ref().map(|(discrete, sampled)| (discrete, *sampled));
    let export = Export { name: &clean(subject.name()), regulator: &regulator, discrete };
    let text = match args.format {
        RegulatorForm::Json => output::json_text(&export::json(&export)),
        RegulatorForm::Matlab => export::matlab(&export),
        RegulatorForm::Npz => return npz(&export, output.as_ref()),
        RegulatorForm::C => return c(&export, output.as_ref(), header.as_ref()),
    };
    match output {
        Some(file) => file.write(text).map(|()| 0),
        None => Ok(output::data(&text).map_or_else(|code| code, |()| 0)),
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

/// The header beside the C source.
fn header_path(args: &ControllerArgs) -> Result<std::path::PathBuf, Failure> {
    if args.discretise.is_none() {
        return Err(Failure::call("C code runs at samples", "give the sampling time with --discretise"));
    }
    let path = args.output.as_deref();
    let source = path.filter(|path| path.extension().is_some_and(|extension| extension == "c"));
    let source = source.ok_or_else(|| {
        Failure::call(
            "the C source needs the name of a file",
            "give it with -o, ending in `.c`; the header goes beside it",
        )
    })?;
    Ok(source.with_extension("h"))
}

fn c(export: &Export<'_>, source: Option<&OutputFile>, header: Option<&OutputFile>) -> Result<u8, Failure> {
    let needed = || Failure::call("the C source needs --discretise and -o", "give both");
    let (source, header) = source.zip(header).ok_or_else(needed)?;
    let name = header.name();
    let name = Path::new(&name).file_name().map_or_else(String::new, |name| shown(Path::new(name)));
    if name.contains(['"', '\\']) {
        return Err(Failure::call(format!("`{name}` cannot be included by C code"), "name a file without quotes"));
    }
    let CSources { header: header_text, source: source_text } = export::c_sources(export, &name).ok_or_else(needed)?;
    write_together(&[(header, header_text.as_bytes()), (source, source_text.as_bytes())]).map(|()| 0)
}

/// Says what makes a sampled regulator work badly, or not at all.
fn remarks(regulator: &Regulator, discrete: &Discrete, sampled: SampledLoop) {
    let product = regulator.sigma * discrete.step;
    if product > 1.0 {
        output::remark(&format!(
            "sigma times the sampling time is {product:.3}: above 1 the error changes its sign at every sample; sample faster"
        ));
    }
    if sampled.is_unstable() {
        output::remark(&format!("{sampled}; sample faster, or use fewer oscillators; the export says so too"));
    }
}

/// Says where the certificate does not speak of this regulator.
fn compare(document: &Document, subject: &Subject, sigma: &Constant) -> Result<(), Failure> {
    let witness = read_witness(document)?;
    let sigma_star = witness.sigma();
    let (digest, what) = match subject {
        Subject::Specification(_) => ("/specification_sha256", "specification"),
        Subject::Plant(_) => ("/plant_sha256", "plant"),
    };
    if document.at(digest).is_none_or(|digest| digest.text() != Some(subject.sha256())) {
        output::remark(&format!("the certificate was made for another {what}: it says nothing about this regulator"));
    }
    let sigma = sigma.enclose(DEFAULT_PRECISION);
    if !sigma.ge(&Enclosure::from_rational(sigma_star, DEFAULT_PRECISION)).is_true() {
        output::remark(&format!(
            "sigma = {} is below sigma* = {} of the certificate: nothing is certified with it",
            sigma.midpoint_f64(),
            write_exact(sigma_star)
        ));
    }
    Ok(())
}
