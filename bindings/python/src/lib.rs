//! The native part of the Python package `sigmastar`: the front door of the library, call by call.
//!
//! Nothing is decided here. Each function takes the bytes of documents and texts of numbers, and returns a dictionary with what
//! was found, or with the error; `python/sigmastar` makes objects and exceptions of them.

mod told;
mod told_beside;
mod work;

use pyo3::prelude::*;
use sigmastar::{
    Certificate, CertifyOptions, Error, SimulationOptions, Study, Subject, TransferChoice, TransferOptions, TuneGoal,
    TuneOptions,
};
use std::cell::RefCell;
use told::{Told, ToldCase, ToldCertificate, ToldCheck, ToldRates, ToldRegulator, ToldSampled, ToldTransfer};
use told_beside::{ToldBounded, ToldFalsification, ToldPairs, ToldReport, ToldSimulation, ToldTuning};
use work::outside;

/// A document: what errors call it, and its bytes.
type File = (String, Vec<u8>);

/// A study, and its subject where that stands in a file of its own.
type StudyFiles = (File, Option<Vec<u8>>);

fn subject((name, bytes): &File) -> Result<Subject, Error> {
    Subject::from_bytes(name, bytes)
}

fn study(((name, bytes), subject): &StudyFiles) -> Result<Study, Error> {
    Study::from_bytes(name, bytes, |_| subject.clone().ok_or_else(|| "it is in no file".to_owned()))
}

/// The options of `certify`, as they are chosen by name; what is no choice is told by the package.
#[derive(FromPyObject)]
struct Options {
    transfer: String,
    precision_limit: u32,
    compare: bool,
    sigma: Option<String>,
    sampling_period: Option<String>,
    n_o: Vec<u32>,
    steady_error: Option<String>,
    peak_error: Option<String>,
    max_control: Option<String>,
    rate: Option<String>,
}

impl Options {
    fn read(self) -> Result<CertifyOptions, PyErr> {
        let wrong = |what: &str, word: &str, known: &str| {
            Err(pyo3::exceptions::PyValueError::new_err(format!("{what}: `{word}` is none of {known}")))
        };
        let transfer = match self.transfer.as_str() {
            "best" => TransferChoice::Best,
            "boxes" => TransferChoice::Boxes,
            "closed-form" => TransferChoice::ClosedForm,
            other => return wrong("transfer", other, "`best`, `boxes`, `closed-form`"),
        };
        let options = CertifyOptions::new().transfer(transfer).compare(self.compare);
        let options = options.precision_limit(self.precision_limit);
        let options = self.sigma.into_iter().fold(options, CertifyOptions::sigma);
        let options = self.sampling_period.into_iter().fold(options, CertifyOptions::sampling_period);
        let options = self.steady_error.into_iter().fold(options, CertifyOptions::steady_error);
        let options = self.peak_error.into_iter().fold(options, CertifyOptions::peak_error);
        let options = self.max_control.into_iter().fold(options, CertifyOptions::max_control);
        Ok(self.rate.into_iter().fold(options, CertifyOptions::rate).n_o(self.n_o))
    }
}

#[pyfunction]
fn certify(py: Python<'_>, file: File, options: Options) -> PyResult<Told<ToldCertificate>> {
    let options = options.read()?;
    outside(py, move || {
        let certificate: Result<Certificate, Error> =
            subject(&file).and_then(|subject| sigmastar::certify(subject, &options));
        certificate.map(|certificate| ToldCertificate::from(&certificate)).into()
    })
}

#[pyfunction]
fn reread(py: Python<'_>, file: File) -> PyResult<Told<ToldCertificate>> {
    outside(py, move || {
        let certificate = sigmastar::reread(&file.0, &file.1);
        certificate.map(|certificate| ToldCertificate::from(&certificate)).into()
    })
}

#[pyfunction]
fn bound(py: Python<'_>, file: File, domain: Option<(String, String)>) -> PyResult<Told<ToldBounded>> {
    outside(py, move || {
        let domain = domain.as_ref().map(|(x, e)| [x.as_str(), e.as_str()]);
        let bounded = subject(&file).and_then(|subject| sigmastar::bounding_specification(subject, domain));
        bounded.map(|bounded| ToldBounded::from(&bounded)).into()
    })
}

#[pyfunction]
fn lyapunov(py: Python<'_>, file: File) -> PyResult<Told<ToldReport>> {
    outside(py, move || {
        let report = subject(&file).and_then(sigmastar::lyapunov);
        report.map(|report| ToldReport::from(&report)).into()
    })
}

#[pyfunction]
fn sampling(
    py: Python<'_>,
    file: File,
    periods: Option<Vec<String>>,
    sigmas: Option<Vec<String>>,
) -> PyResult<Told<ToldPairs>> {
    outside(py, move || {
        let periods: Option<Vec<&str>> = periods.as_ref().map(|all| all.iter().map(String::as_str).collect());
        let sigmas: Option<Vec<&str>> = sigmas.as_ref().map(|all| all.iter().map(String::as_str).collect());
        let pairs =
            subject(&file).and_then(|subject| sigmastar::sampling(subject, periods.as_deref(), sigmas.as_deref()));
        pairs.map(|pairs| ToldPairs::from(&pairs)).into()
    })
}

#[pyfunction]
fn tune(
    py: Python<'_>,
    file: File,
    over: String,
    feedback: bool,
    error_at: Option<u32>,
    tries: u32,
) -> PyResult<Told<ToldTuning>> {
    let goal = match error_at {
        Some(n_o) => TuneGoal::ErrorAt(n_o),
        None if feedback => TuneGoal::Feedback,
        None => TuneGoal::SigmaStar,
    };
    let options = TuneOptions::new().over(over).goal(goal).tries(tries);
    outside(py, move || {
        let tuned = subject(&file).and_then(|subject| sigmastar::tune(subject, &options));
        tuned.map(|tuned| ToldTuning::from(&tuned)).into()
    })
}

/// The options of `simulate`.
#[derive(FromPyObject)]
struct Run {
    sigma: String,
    n_o: Option<u32>,
    periods: u32,
    samples: u32,
    harmonics: u32,
    sampling_period: Option<String>,
    input_gain: Option<String>,
}

impl From<Run> for SimulationOptions {
    fn from(run: Run) -> SimulationOptions {
        let options = SimulationOptions::new(run.sigma).periods(run.periods).samples(run.samples);
        let options = run.n_o.into_iter().fold(options.harmonics(run.harmonics), SimulationOptions::n_o);
        let options = run.sampling_period.into_iter().fold(options, SimulationOptions::sampling_period);
        run.input_gain.into_iter().fold(options, SimulationOptions::input_gain)
    }
}

#[pyfunction]
fn simulate(py: Python<'_>, file: File, run: Run) -> PyResult<Told<ToldSimulation>> {
    outside(py, move || {
        let simulation = subject(&file).and_then(|plant| sigmastar::simulate(plant, &run.into()));
        simulation.map(|simulation| ToldSimulation::from(&simulation)).into()
    })
}

#[pyfunction]
fn falsify(py: Python<'_>, file: File, trials: u32, seed: u64) -> PyResult<Told<ToldFalsification>> {
    outside(py, move || {
        let found = sigmastar::falsify(&file.0, &file.1, trials, seed);
        found.map(|found| ToldFalsification::from(&found)).into()
    })
}

/// The text of a certificate. Bytes that are none end in a character that no certificate has there, so that the checker refuses
/// them at their place.
fn as_text(bytes: Vec<u8>) -> String {
    String::from_utf8(bytes).unwrap_or_else(|error| {
        let valid = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        String::from_utf8_lossy(valid).into_owned() + "\u{fffd}"
    })
}

#[pyfunction]
fn check(
    py: Python<'_>,
    certificate: Vec<u8>,
    against: Option<File>,
    sampling_period: Option<String>,
) -> PyResult<Told<ToldCheck>> {
    outside(py, move || {
        let text = as_text(certificate);
        let report = match against {
            None => Ok(sigmastar::check(&text)),
            Some(file) => subject(&file)
                .and_then(|subject| match &sampling_period {
                    None => Ok(subject),
                    Some(period) => subject.at_samples(period),
                })
                .map(|subject| sigmastar::check_against(&text, subject)),
        };
        report.map(|report| ToldCheck::from(&report)).into()
    })
}

#[pyfunction]
fn rates(py: Python<'_>, file: File, sigma: Option<String>, n_o: Vec<u32>) -> PyResult<Told<ToldRates>> {
    outside(py, move || {
        let rates = subject(&file).and_then(|subject| sigmastar::rates(subject, sigma.as_deref(), &n_o));
        rates.map(|rates| ToldRates::from(&rates)).into()
    })
}

#[pyfunction]
fn transfer(
    py: Python<'_>,
    file: File,
    k0: Option<String>,
    minimise: Option<(String, String)>,
    n_o: Option<Vec<Option<u64>>>,
) -> PyResult<Told<ToldTransfer>> {
    let options = k0.into_iter().fold(TransferOptions::new(), TransferOptions::k0);
    let options = minimise.into_iter().fold(options, |options, (a, b)| options.cheapest(a, b));
    let options = n_o.into_iter().fold(options, TransferOptions::n_o);
    outside(py, move || {
        let study = subject(&file).and_then(|subject| sigmastar::transfer_study(subject, &options));
        study.map(|study| ToldTransfer::from(&study)).into()
    })
}

#[pyfunction]
fn regulator(file: File, sigma: &str, n_o: u32) -> Told<ToldRegulator> {
    let regulator = subject(&file).and_then(|subject| sigmastar::regulator_matrices(subject, sigma, n_o));
    regulator.map(ToldRegulator::from).into()
}

#[pyfunction]
fn sampled_regulator(file: File, sigma: &str, n_o: u32, step: &str) -> Told<ToldSampled> {
    let regulator = subject(&file).and_then(|subject| sigmastar::sampled_regulator(subject, sigma, n_o, step));
    regulator.map(ToldSampled::from).into()
}

/// The path of the subject of a study, where the study does not have it in it.
#[pyfunction]
fn study_subject(file: File) -> Option<String> {
    let path = RefCell::new(None);
    // What is wrong with the study is told when it is read as a whole.
    let _ = Study::from_bytes(&file.0, &file.1, |named| {
        path.replace(Some(named.to_owned()));
        Err(String::new())
    });
    path.into_inner()
}

#[pyfunction]
fn study_count(files: StudyFiles) -> Told<(String, u64)> {
    study(&files).map(|study| (study.name().to_owned(), study.cases())).into()
}

#[pyfunction]
fn study_case(files: StudyFiles, index: u64) -> Told<ToldCase> {
    study(&files).and_then(|study| study.case(index)).map(ToldCase::from).into()
}

#[pyfunction]
fn run_case(py: Python<'_>, files: StudyFiles, index: u64) -> PyResult<Told<String>> {
    outside(py, move || study(&files).and_then(|study| study.run_case(index)).into())
}

#[pyfunction]
fn study_results(py: Python<'_>, files: StudyFiles, lines: Vec<String>) -> PyResult<Told<String>> {
    outside(py, move || study(&files).and_then(|study| study.results(lines.iter().map(String::as_str))).into())
}

#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("VERSION", sigmastar::VERSION)?;
    module.add("MAX_BYTES", Subject::MAX_BYTES)?;
    module.add("LARGEST_PRECISION_LIMIT", CertifyOptions::LARGEST_PRECISION_LIMIT)?;
    module.add_function(wrap_pyfunction!(certify, module)?)?;
    module.add_function(wrap_pyfunction!(reread, module)?)?;
    module.add_function(wrap_pyfunction!(bound, module)?)?;
    module.add_function(wrap_pyfunction!(lyapunov, module)?)?;
    module.add_function(wrap_pyfunction!(sampling, module)?)?;
    module.add_function(wrap_pyfunction!(tune, module)?)?;
    module.add_function(wrap_pyfunction!(simulate, module)?)?;
    module.add_function(wrap_pyfunction!(falsify, module)?)?;
    module.add_function(wrap_pyfunction!(check, module)?)?;
    module.add_function(wrap_pyfunction!(rates, module)?)?;
    module.add_function(wrap_pyfunction!(transfer, module)?)?;
    module.add_function(wrap_pyfunction!(regulator, module)?)?;
    module.add_function(wrap_pyfunction!(sampled_regulator, module)?)?;
    module.add_function(wrap_pyfunction!(study_subject, module)?)?;
    module.add_function(wrap_pyfunction!(study_count, module)?)?;
    module.add_function(wrap_pyfunction!(study_case, module)?)?;
    module.add_function(wrap_pyfunction!(run_case, module)?)?;
    module.add_function(wrap_pyfunction!(study_results, module)?)?;
    Ok(())
}
