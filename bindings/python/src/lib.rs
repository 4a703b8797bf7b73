//! The native part of the Python package `sigmastar`: the front door of the library, call by call.
//!
//! Nothing is decided here. Each function takes the bytes of documents and texts of numbers, and returns a dictionary with what
//! was found, or with the error; `python/sigmastar` makes objects and exceptions of them.

mod dict;
mod told;
mod work;

use dict::Dict;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use sigmastar::{
    CertifyOptions, DesignOptions, Error, SimulationOptions, Study, Subject, TransferChoice, TransferOptions, TuneGoal,
    TuneOptions,
};
use std::cell::RefCell;
use told::answer;
use work::{outside, outside_telling};

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
    harmonics: Vec<Vec<u32>>,
}

impl Options {
    fn read(self) -> PyResult<CertifyOptions> {
        let transfer = match self.transfer.as_str() {
            "best" => TransferChoice::Best,
            "boxes" => TransferChoice::Boxes,
            "closed-form" => TransferChoice::ClosedForm,
            other => {
                let wrong = format!("transfer: `{other}` is none of `best`, `boxes`, `closed-form`");
                return Err(PyValueError::new_err(wrong));
            }
        };
        let options = CertifyOptions::new().transfer(transfer).compare(self.compare);
        let options = options.precision_limit(self.precision_limit);
        let options = self.sigma.into_iter().fold(options, CertifyOptions::sigma);
        let options = self.sampling_period.into_iter().fold(options, CertifyOptions::sampling_period);
        let options = self.steady_error.into_iter().fold(options, CertifyOptions::steady_error);
        let options = self.peak_error.into_iter().fold(options, CertifyOptions::peak_error);
        let options = self.max_control.into_iter().fold(options, CertifyOptions::max_control);
        let options = self.harmonics.into_iter().fold(options, CertifyOptions::harmonics);
        Ok(self.rate.into_iter().fold(options, CertifyOptions::rate).n_o(self.n_o))
    }
}

#[pyfunction]
fn certify(py: Python<'_>, file: File, options: Options, progress: Option<Py<PyAny>>) -> PyResult<Dict> {
    let options = options.read()?;
    outside_telling(py, progress, move |tell| {
        sigmastar::certify_telling(subject(&file)?, &options, tell).map(told::certificate)
    })
}

#[pyfunction]
fn reread(py: Python<'_>, file: File) -> PyResult<Dict> {
    outside(py, move || sigmastar::reread(&file.0, &file.1).map(told::certificate))
}

#[pyfunction]
fn bound(py: Python<'_>, file: File, domain: Option<(String, String)>) -> PyResult<Dict> {
    outside(py, move || {
        let domain = domain.as_ref().map(|(x, e)| [x.as_str(), e.as_str()]);
        sigmastar::bounding_specification(subject(&file)?, domain).map(told::bounded)
    })
}

#[pyfunction]
fn lyapunov(py: Python<'_>, file: File) -> PyResult<Dict> {
    outside(py, move || {
        let report = sigmastar::lyapunov(subject(&file)?)?;
        Ok(Dict::new().with("reports", told::reports(&report)))
    })
}

#[pyfunction]
fn sampling(py: Python<'_>, file: File, periods: Option<Vec<String>>, sigmas: Option<Vec<String>>) -> PyResult<Dict> {
    outside(py, move || {
        let periods: Option<Vec<&str>> = periods.as_ref().map(|all| all.iter().map(String::as_str).collect());
        let sigmas: Option<Vec<&str>> = sigmas.as_ref().map(|all| all.iter().map(String::as_str).collect());
        sigmastar::sampling(subject(&file)?, periods.as_deref(), sigmas.as_deref()).map(told::pairs)
    })
}

/// The options of `design`.
#[derive(FromPyObject)]
struct Wanted {
    n_o: Option<Vec<u32>>,
    harmonics: Vec<Vec<u32>>,
    sigmas: Vec<String>,
    sampling_period: Option<String>,
    steady_error: Option<String>,
    peak_error: Option<String>,
    max_control: Option<String>,
    settle: Option<String>,
    noise: Option<String>,
    simulate: bool,
    sampling_periods: bool,
    choose: Option<String>,
}

impl From<Wanted> for DesignOptions {
    fn from(wanted: Wanted) -> DesignOptions {
        let options = DesignOptions::new().sigmas(wanted.sigmas).simulate(wanted.simulate);
        let options = options.sampling_periods(wanted.sampling_periods);
        let options = wanted.choose.into_iter().fold(options, DesignOptions::choose);
        let options = wanted.n_o.into_iter().fold(options, DesignOptions::n_o);
        let options = wanted.harmonics.into_iter().fold(options, DesignOptions::harmonics);
        let options = wanted.sampling_period.into_iter().fold(options, DesignOptions::sampling_period);
        let options = wanted.steady_error.into_iter().fold(options, DesignOptions::steady_error);
        let options = wanted.peak_error.into_iter().fold(options, DesignOptions::peak_error);
        let options = wanted.max_control.into_iter().fold(options, DesignOptions::max_control);
        let options = wanted.settle.into_iter().fold(options, DesignOptions::settle);
        wanted.noise.into_iter().fold(options, DesignOptions::noise)
    }
}

#[pyfunction]
fn design(py: Python<'_>, file: File, wanted: Wanted, progress: Option<Py<PyAny>>) -> PyResult<Dict> {
    let options = DesignOptions::from(wanted);
    outside_telling(py, progress, move |tell| {
        sigmastar::design_telling(subject(&file)?, &options, tell).map(told::designed)
    })
}

#[pyfunction]
fn tune(py: Python<'_>, file: File, over: String, feedback: bool, error_at: Option<u32>, tries: u32) -> PyResult<Dict> {
    let goal = match error_at {
        Some(n_o) => TuneGoal::ErrorAt(n_o),
        None if feedback => TuneGoal::Feedback,
        None => TuneGoal::SigmaStar,
    };
    let options = TuneOptions::new().over(over).goal(goal).tries(tries);
    outside(py, move || sigmastar::tune(subject(&file)?, &options).map(told::tuning))
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
fn simulate(py: Python<'_>, file: File, run: Run) -> PyResult<Dict> {
    outside(py, move || sigmastar::simulate(subject(&file)?, &run.into()).map(told::simulation))
}

#[pyfunction]
fn falsify(py: Python<'_>, file: File, trials: u32, seed: u64) -> PyResult<Dict> {
    outside(py, move || sigmastar::falsify(&file.0, &file.1, trials, seed).map(told::falsification))
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
) -> PyResult<Dict> {
    outside(py, move || {
        let text = as_text(certificate);
        let report = match (&against, &sampling_period) {
            (None, _) => sigmastar::check(&text),
            (Some(file), None) => sigmastar::check_against(&text, subject(file)?),
            (Some(file), Some(period)) => sigmastar::check_against(&text, subject(file)?.at_samples(period)?),
        };
        Ok(told::check(report))
    })
}

#[pyfunction]
fn transfer(
    py: Python<'_>,
    file: File,
    k0: Option<String>,
    minimise: Option<(String, String)>,
    n_o: Option<Vec<Option<u64>>>,
) -> PyResult<Dict> {
    let options = k0.into_iter().fold(TransferOptions::new(), TransferOptions::k0);
    let options = minimise.into_iter().fold(options, |options, (a, b)| options.cheapest(a, b));
    let options = n_o.into_iter().fold(options, TransferOptions::n_o);
    outside(py, move || sigmastar::transfer_study(subject(&file)?, &options).map(told::transfer))
}

#[pyfunction]
fn regulator(file: File, sigma: &str, n_o: u32) -> Dict {
    let regulator = subject(&file).and_then(|subject| sigmastar::regulator_matrices(subject, sigma, n_o));
    answer(regulator.map(told::regulator))
}

#[pyfunction]
fn sampled_regulator(file: File, sigma: &str, n_o: u32, step: &str) -> Dict {
    let regulator = subject(&file).and_then(|subject| sigmastar::sampled_regulator(subject, sigma, n_o, step));
    answer(regulator.map(told::sampled))
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
fn study_count(files: StudyFiles) -> Dict {
    answer(study(&files).map(|study| (study.name().to_owned(), study.cases())))
}

#[pyfunction]
fn study_case(files: StudyFiles, index: u64) -> Dict {
    answer(study(&files).and_then(|study| study.case(index)).map(told::case))
}

#[pyfunction]
fn run_case(py: Python<'_>, files: StudyFiles, index: u64) -> PyResult<Dict> {
    outside(py, move || study(&files)?.run_case(index))
}

#[pyfunction]
fn study_results(py: Python<'_>, files: StudyFiles, lines: Vec<String>) -> PyResult<Dict> {
    outside(py, move || study(&files)?.results(lines.iter().map(String::as_str)))
}

#[pymodule]
mod _native {
    #[pymodule_export]
    use super::{
        bound, certify, check, design, falsify, lyapunov, regulator, reread, run_case, sampled_regulator, sampling,
        simulate, study_case, study_count, study_results, study_subject, transfer, tune,
    };
    use sigmastar::{CertifyOptions, Subject};

    #[pymodule_export]
    const VERSION: &str = sigmastar::VERSION;
    #[pymodule_export]
    const MAX_BYTES: usize = Subject::MAX_BYTES;
    #[pymodule_export]
    const LARGEST_PRECISION_LIMIT: u32 = CertifyOptions::LARGEST_PRECISION_LIMIT;
}
