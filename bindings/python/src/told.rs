//! What goes to Python: dictionaries of texts and numbers, from which the package makes its objects.

use pyo3::prelude::*;
use sigmastar::{
    Certificate, CheckReport, CheckVerdict, Condition, Diagnostic, Error, ErrorKind, InitialSet, PeriodicSolution,
    Rate, RateMethod, Rates, RegulatorMatrices, Report, ReportFormat, SampledRegulator, StudyCase, TransferStudy,
};

/// A report in each of its forms.
#[derive(IntoPyObject)]
pub struct Reports {
    text: String,
    markdown: String,
    html: String,
    json: String,
}

impl From<&Report> for Reports {
    fn from(report: &Report) -> Reports {
        Reports {
            text: report.render(ReportFormat::Text),
            markdown: report.render(ReportFormat::Markdown),
            html: report.render(ReportFormat::Html),
            json: report.render(ReportFormat::Json),
        }
    }
}

/// A diagnostic.
#[derive(IntoPyObject)]
pub struct ToldDiagnostic {
    code: String,
    file: String,
    pointer: String,
    line: Option<usize>,
    column: Option<usize>,
    message: String,
    expected: Option<String>,
    help: Option<String>,
}

impl From<&Diagnostic> for ToldDiagnostic {
    fn from(diagnostic: &Diagnostic) -> ToldDiagnostic {
        ToldDiagnostic {
            code: diagnostic.code.to_owned(),
            file: diagnostic.file.clone(),
            pointer: diagnostic.pointer.clone(),
            line: diagnostic.place.map(|(line, _)| line),
            column: diagnostic.place.map(|(_, column)| column),
            message: diagnostic.message.clone(),
            expected: diagnostic.expected.clone(),
            help: diagnostic.help.clone(),
        }
    }
}

/// A condition.
#[derive(IntoPyObject)]
pub struct ToldCondition {
    id: String,
    text: String,
    lhs: (f64, f64),
    relation: String,
    rhs: (f64, f64),
    holds: Option<bool>,
}

impl From<&Condition> for ToldCondition {
    fn from(condition: &Condition) -> ToldCondition {
        ToldCondition {
            id: condition.id().to_owned(),
            text: condition.text().to_owned(),
            lhs: condition.lhs().into(),
            relation: condition.relation().to_owned(),
            rhs: condition.rhs().into(),
            holds: condition.holds(),
        }
    }
}

/// Why there is no result.
#[derive(IntoPyObject)]
pub struct ToldError {
    kind: String,
    verdict: String,
    text: String,
    diagnostics: Vec<ToldDiagnostic>,
    conditions: Vec<ToldCondition>,
    reports: Option<Reports>,
}

impl From<&Error> for ToldError {
    fn from(error: &Error) -> ToldError {
        ToldError {
            kind: kind(error.kind()).to_owned(),
            verdict: error.verdict().to_string(),
            text: error.to_string(),
            diagnostics: error.diagnostics().iter().map(ToldDiagnostic::from).collect(),
            conditions: error.conditions().iter().map(ToldCondition::from).collect(),
            reports: error.report().map(Reports::from),
        }
    }
}

fn kind(kind: ErrorKind) -> &'static str {
    match kind {
        ErrorKind::Document => "document",
        ErrorKind::Format => "format",
        ErrorKind::Field => "field",
        ErrorKind::Expression => "expression",
        ErrorKind::Range => "range",
        ErrorKind::Options => "options",
        ErrorKind::Results => "results",
        ErrorKind::Claim => "claim",
        ErrorKind::Refuted => "refuted",
        ErrorKind::Undecided => "undecided",
        ErrorKind::NotCertified => "not-certified",
        ErrorKind::Overflow => "overflow",
        ErrorKind::NotAvailable => "not-available",
        _ => "other",
    }
}

/// A result, or why there is none: one of both.
#[derive(IntoPyObject)]
pub struct Told<T> {
    found: Option<T>,
    error: Option<ToldError>,
}

impl<T> From<Result<T, Error>> for Told<T> {
    fn from(result: Result<T, Error>) -> Told<T> {
        match result {
            Ok(found) => Told { found: Some(found), error: None },
            Err(error) => Told { found: None, error: Some((&error).into()) },
        }
    }
}

/// A certificate with its claim.
#[derive(IntoPyObject)]
pub struct ToldCertificate {
    sigma_star: (f64, String),
    samples: Option<(String, u32, String)>,
    statement: String,
    initial_set: (Size, Size, Option<Size>),
    ball: Option<String>,
    periodic_solution: [f64; 4],
    sha256: String,
    name: String,
    is_plant: bool,
    conditions: Vec<ToldCondition>,
    remarks: Vec<String>,
    json: String,
    subject: String,
    reports: Reports,
}

impl From<&Certificate> for ToldCertificate {
    fn from(certificate: &Certificate) -> ToldCertificate {
        let (claim, subject) = (certificate.claim(), certificate.subject());
        let PeriodicSolution { x, e, zeta, z, .. } = *claim.periodic_solution();
        ToldCertificate {
            sigma_star: (claim.sigma_star_f64(), claim.sigma_star().to_owned()),
            samples: claim.samples().map(|samples| (samples.period.clone(), samples.count, samples.gain.clone())),
            statement: claim.statement().to_owned(),
            initial_set: sizes(claim.initial_set()),
            ball: claim.initial_set().ball().map(str::to_owned),
            periodic_solution: [x, e, zeta, z],
            sha256: claim.specification_sha256().to_owned(),
            name: subject.name().to_owned(),
            is_plant: subject.is_plant(),
            conditions: certificate.conditions().iter().map(ToldCondition::from).collect(),
            remarks: certificate.remarks().to_vec(),
            json: certificate.to_json().to_owned(),
            subject: subject.to_json(),
            reports: certificate.report().into(),
        }
    }
}

/// A size as a double, rounded down, and exactly.
type Size = (f64, String);

fn sizes(set: &InitialSet) -> (Size, Size, Option<Size>) {
    let (x0, e0, z0) = set.exact();
    let of_z = set.z0().zip(z0.map(str::to_owned));
    ((set.x0(), x0.to_owned()), (set.e0(), e0.to_owned()), of_z)
}

/// The answer of the checker.
#[derive(IntoPyObject)]
pub struct ToldCheck {
    verdict: String,
    flawless: bool,
    statement: Option<String>,
    sha256: Option<String>,
    assumed: Vec<String>,
    reports: Reports,
}

impl From<&CheckReport> for ToldCheck {
    fn from(report: &CheckReport) -> ToldCheck {
        let verdict = match report.verdict() {
            CheckVerdict::Valid => "valid",
            CheckVerdict::Invalid => "invalid",
            CheckVerdict::BadInput => "bad-input",
            _ => "undecided",
        };
        ToldCheck {
            verdict: verdict.to_owned(),
            flawless: report.is_flawless(),
            statement: report.statement().map(str::to_owned),
            sha256: report.specification_sha256().map(str::to_owned),
            assumed: report.assumed().to_vec(),
            reports: report.report().into(),
        }
    }
}

/// The transfer bound.
#[derive(IntoPyObject)]
pub struct ToldTransfer {
    k0: (f64, String),
    k1: (f64, String),
    excess: Option<f64>,
    shares: Vec<(Option<u64>, f64, f64)>,
    reports: Reports,
}

impl From<&TransferStudy> for ToldTransfer {
    fn from(study: &TransferStudy) -> ToldTransfer {
        let bound = study.bound();
        ToldTransfer {
            k0: (bound.k0_f64(), bound.k0().to_owned()),
            k1: (bound.k1_f64(), bound.k1().to_owned()),
            excess: bound.excess(),
            shares: study.shares().iter().map(|share| (share.n_o, share.ratio[0], share.ratio[1])).collect(),
            reports: study.report().into(),
        }
    }
}

/// Rates.
#[derive(IntoPyObject)]
pub struct ToldRates {
    sigma: String,
    sigma_star: String,
    rates: Vec<ToldRate>,
    reports: Reports,
}

/// The rates for one number of oscillators.
#[derive(IntoPyObject)]
pub struct ToldRate {
    n_o: u32,
    closed_loop: Option<(f64, String)>,
    method: Option<String>,
    oscillators: Option<(f64, String)>,
    spectral_estimate: Option<f64>,
}

impl From<&Rates> for ToldRates {
    fn from(rates: &Rates) -> ToldRates {
        ToldRates {
            sigma: rates.sigma().to_owned(),
            sigma_star: rates.sigma_star().to_owned(),
            rates: rates.rates().iter().map(ToldRate::from).collect(),
            reports: rates.report().into(),
        }
    }
}

impl From<&Rate> for ToldRate {
    fn from(rate: &Rate) -> ToldRate {
        let both = |down: Option<f64>, exact: Option<&str>| down.zip(exact.map(str::to_owned));
        let method = |method| match method {
            RateMethod::Riccati => "riccati",
            RateMethod::Kappa => "kappa",
            _ => "other",
        };
        ToldRate {
            n_o: rate.n_o(),
            closed_loop: both(rate.closed_loop_f64(), rate.closed_loop()),
            method: rate.method().map(|found| method(found).to_owned()),
            oscillators: both(rate.oscillators_f64(), rate.oscillators()),
            spectral_estimate: rate.spectral_estimate(),
        }
    }
}

/// The regulator in continuous time.
#[derive(IntoPyObject)]
pub struct ToldRegulator {
    sigma: f64,
    mu: f64,
    phi: Vec<Vec<f64>>,
    gamma: Vec<f64>,
    m: Vec<f64>,
    n: Vec<f64>,
    nominal: f64,
}

impl From<RegulatorMatrices> for ToldRegulator {
    fn from(regulator: RegulatorMatrices) -> ToldRegulator {
        let RegulatorMatrices { sigma, mu, phi, gamma, m, n_diagonal: n, nominal, .. } = regulator;
        ToldRegulator { sigma, mu, phi, gamma, m, n, nominal: nominal.unwrap_or(1.0) }
    }
}

/// The regulator at samples.
#[derive(IntoPyObject)]
pub struct ToldSampled {
    step: f64,
    gain: f64,
    phi: Vec<Vec<f64>>,
    gamma: Vec<f64>,
    c: Vec<f64>,
    d: f64,
    spectral_radius: f64,
}

impl From<SampledRegulator> for ToldSampled {
    fn from(regulator: SampledRegulator) -> ToldSampled {
        let SampledRegulator { step, gain, phi, gamma, c, d, spectral_radius, .. } = regulator;
        ToldSampled { step, gain, phi, gamma, c, d, spectral_radius }
    }
}

/// One case of a study.
#[derive(IntoPyObject)]
pub struct ToldCase {
    index: u64,
    values: Vec<(String, String)>,
    json: String,
    sha256: String,
}

impl From<StudyCase> for ToldCase {
    fn from(case: StudyCase) -> ToldCase {
        let StudyCase { index, values, json, sha256, .. } = case;
        ToldCase { index, values, json, sha256 }
    }
}
