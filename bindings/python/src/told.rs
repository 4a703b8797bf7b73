//! What goes to Python: dictionaries of texts and numbers, from which the package makes its objects.

use crate::dict::{Dict, Value};
use sigmastar::{
    BoundedPlant, Certificate, CheckReport, CheckVerdict, Condition, Design, Diagnostic, Error, ErrorKind,
    Falsification, FalsificationOutcome, InitialSet, PeriodicSolution, RegulatorMatrices, Report, ReportFormat,
    SampledRegulator, SamplingPairs, Simulation, StudyCase, TransferStudy, Tuned,
};

/// A result, or why there is none: one of both.
pub fn answer<T: Value>(result: Result<T, Error>) -> Dict {
    let (found, error) = match result {
        Ok(found) => (Some(found), None),
        Err(error) => (None, Some(self::error(&error))),
    };
    Dict::new().with("found", found).with("error", error)
}

/// Why there is no result.
fn error(error: &Error) -> Dict {
    Dict::new()
        .with("kind", kind(error.kind()))
        .with("verdict", error.verdict().to_string())
        .with("text", error.to_string())
        .with("diagnostics", error.diagnostics().iter().map(diagnostic).collect::<Vec<_>>())
        .with("conditions", conditions(error.conditions()))
        .with("reports", error.report().map(reports))
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

fn diagnostic(diagnostic: &Diagnostic) -> Dict {
    let (line, column) = diagnostic.place.unzip();
    Dict::new()
        .with("code", diagnostic.code)
        .with("file", diagnostic.file.clone())
        .with("pointer", diagnostic.pointer.clone())
        .with("line", line)
        .with("column", column)
        .with("message", diagnostic.message.clone())
        .with("expected", diagnostic.expected.clone())
        .with("help", diagnostic.help.clone())
}

fn conditions(all: &[Condition]) -> Vec<Dict> {
    let of = |one: &Condition| {
        let (lhs, rhs): ((f64, f64), (f64, f64)) = (one.lhs().into(), one.rhs().into());
        Dict::new()
            .with("id", one.id().to_owned())
            .with("text", one.text().to_owned())
            .with("lhs", lhs)
            .with("relation", one.relation().to_owned())
            .with("rhs", rhs)
            .with("holds", one.holds())
    };
    all.iter().map(of).collect()
}

/// A report in each of its forms.
pub fn reports(report: &Report) -> Dict {
    Dict::new()
        .with("text", report.render(ReportFormat::Text))
        .with("markdown", report.render(ReportFormat::Markdown))
        .with("html", report.render(ReportFormat::Html))
        .with("json", report.render(ReportFormat::Json))
}

/// A certificate with its claim.
pub fn certificate(certificate: Certificate) -> Dict {
    let (claim, subject) = (certificate.claim(), certificate.subject());
    let PeriodicSolution { x, e, zeta, z, .. } = *claim.periodic_solution();
    let samples = claim.samples().map(|samples| (samples.period.clone(), samples.count, samples.gain.clone()));
    Dict::new()
        .with("sigma_star", (claim.sigma_star_f64(), claim.sigma_star().to_owned()))
        .with("samples", samples)
        .with("statement", claim.statement().to_owned())
        .with("initial_set", sizes(claim.initial_set()))
        .with("ball", claim.initial_set().ball().map(str::to_owned))
        .with("periodic_solution", [x, e, zeta, z])
        .with("sha256", claim.specification_sha256().to_owned())
        .with("name", subject.name().to_owned())
        .with("is_plant", subject.is_plant())
        .with("conditions", conditions(certificate.conditions()))
        .with("remarks", certificate.remarks().to_vec())
        .with("json", certificate.to_json().to_owned())
        .with("subject", subject.to_json())
        .with("reports", reports(certificate.report()))
}

/// A size as a double, rounded down, and exactly.
type Size = (f64, String);

fn sizes(set: &InitialSet) -> (Size, Size, Option<Size>) {
    let (x0, e0, z0) = set.exact();
    let of_z = set.z0().zip(z0.map(str::to_owned));
    ((set.x0(), x0.to_owned()), (set.e0(), e0.to_owned()), of_z)
}

/// The answer of the checker.
pub fn check(report: CheckReport) -> Dict {
    let verdict = match report.verdict() {
        CheckVerdict::Valid => "valid",
        CheckVerdict::Invalid => "invalid",
        CheckVerdict::BadInput => "bad-input",
        _ => "undecided",
    };
    Dict::new()
        .with("verdict", verdict)
        .with("statement", report.statement().map(str::to_owned))
        .with("sha256", report.specification_sha256().map(str::to_owned))
        .with("assumed", report.assumed().to_vec())
        .with("reports", reports(report.report()))
}

/// The transfer bound.
pub fn transfer(study: TransferStudy) -> Dict {
    let bound = study.bound();
    let shares = study.shares().iter().map(|share| (share.n_o, share.ratio[0], share.ratio[1]));
    Dict::new()
        .with("k0", (bound.k0_f64(), bound.k0().to_owned()))
        .with("k1", (bound.k1_f64(), bound.k1().to_owned()))
        .with("excess", bound.excess())
        .with("shares", shares.collect::<Vec<_>>())
        .with("reports", reports(study.report()))
}

/// The regulator in continuous time.
pub fn regulator(regulator: RegulatorMatrices) -> Dict {
    Dict::new()
        .with("sigma", regulator.sigma)
        .with("mu", regulator.mu)
        .with("phi", regulator.phi)
        .with("gamma", regulator.gamma)
        .with("m", regulator.m)
        .with("n", regulator.n_diagonal)
        .with("nominal", regulator.nominal.unwrap_or(1.0))
}

/// The regulator at samples.
pub fn sampled(regulator: SampledRegulator) -> Dict {
    Dict::new()
        .with("step", regulator.step)
        .with("gain", regulator.gain)
        .with("phi", regulator.phi)
        .with("gamma", regulator.gamma)
        .with("c", regulator.c)
        .with("d", regulator.d)
        .with("spectral_radius", regulator.spectral_radius)
}

/// One case of a study.
pub fn case(case: StudyCase) -> Dict {
    Dict::new()
        .with("index", case.index)
        .with("values", case.values)
        .with("json", case.json)
        .with("sha256", case.sha256)
}

/// A bounding specification of a plant.
pub fn bounded(bounded: BoundedPlant) -> Dict {
    let domain: (String, String) = bounded.domain().map(str::to_owned).into();
    Dict::new().with("json", bounded.to_json().to_owned()).with("domain", domain).with("limited", bounded.is_limited())
}

/// Pairs of a gain and a sampling period.
pub fn pairs(pairs: SamplingPairs) -> Dict {
    Dict::new().with("has_pair", pairs.has_pair()).with("reports", reports(pairs.report()))
}

/// Better values of free numbers.
pub fn tuning(tuned: Tuned) -> Dict {
    Dict::new()
        .with("has_claim", tuned.has_claim())
        .with("document", tuned.document().map(str::to_owned))
        .with("reports", reports(tuned.report()))
}

/// A design table.
pub fn designed(design: Design) -> Dict {
    Dict::new()
        .with("sigma", design.sigma().to_owned())
        .with("n_o", design.n_o())
        .with("harmonics", design.harmonics())
        .with("is_met", design.is_met())
        .with("certificate", certificate(design.certificate().clone()))
        .with("reports", reports(design.report()))
}

/// A simulation.
pub fn simulation(simulation: Simulation) -> Dict {
    Dict::new()
        .with("complete", simulation.is_complete())
        .with("csv", simulation.csv().map(str::to_owned))
        .with("reports", reports(simulation.report()))
}

/// What became of a certificate.
pub fn falsification(found: Falsification) -> Dict {
    let outcome = match found.outcome() {
        FalsificationOutcome::Held => "held",
        FalsificationOutcome::Broken => "broken",
        _ => "unfinished",
    };
    Dict::new()
        .with("outcome", outcome)
        .with("counterexample", found.counterexample().map(str::to_owned))
        .with("reports", reports(found.report()))
}
