//! What is asked beside one claim, as it goes to Python: mostly reports, whose JSON has every number.

use crate::told::Reports;
use pyo3::prelude::*;
use sigmastar::{BoundedPlant, Falsification, FalsificationOutcome, Report, SamplingPairs, Simulation, Tuned};

/// A report that says everything.
#[derive(IntoPyObject)]
pub struct ToldReport {
    reports: Reports,
}

impl From<&Report> for ToldReport {
    fn from(report: &Report) -> ToldReport {
        ToldReport { reports: report.into() }
    }
}

/// A bounding specification of a plant.
#[derive(IntoPyObject)]
pub struct ToldBounded {
    json: String,
    domain: (String, String),
    limited: bool,
}

impl From<&BoundedPlant> for ToldBounded {
    fn from(bounded: &BoundedPlant) -> ToldBounded {
        let domain = bounded.domain().map(str::to_owned).into();
        ToldBounded { json: bounded.to_json().to_owned(), domain, limited: bounded.is_limited() }
    }
}

/// Pairs of a gain and a sampling period.
#[derive(IntoPyObject)]
pub struct ToldPairs {
    has_pair: bool,
    reports: Reports,
}

impl From<&SamplingPairs> for ToldPairs {
    fn from(pairs: &SamplingPairs) -> ToldPairs {
        ToldPairs { has_pair: pairs.has_pair(), reports: pairs.report().into() }
    }
}

/// Better values of free numbers.
#[derive(IntoPyObject)]
pub struct ToldTuning {
    has_claim: bool,
    document: Option<String>,
    reports: Reports,
}

impl From<&Tuned> for ToldTuning {
    fn from(tuned: &Tuned) -> ToldTuning {
        ToldTuning {
            has_claim: tuned.has_claim(),
            document: tuned.document().map(str::to_owned),
            reports: tuned.report().into(),
        }
    }
}

/// A simulation.
#[derive(IntoPyObject)]
pub struct ToldSimulation {
    complete: bool,
    csv: Option<String>,
    reports: Reports,
}

impl From<&Simulation> for ToldSimulation {
    fn from(simulation: &Simulation) -> ToldSimulation {
        ToldSimulation {
            complete: simulation.is_complete(),
            csv: simulation.csv().map(str::to_owned),
            reports: simulation.report().into(),
        }
    }
}

/// What became of a certificate.
#[derive(IntoPyObject)]
pub struct ToldFalsification {
    outcome: String,
    counterexample: Option<String>,
    reports: Reports,
}

impl From<&Falsification> for ToldFalsification {
    fn from(found: &Falsification) -> ToldFalsification {
        let outcome = match found.outcome() {
            FalsificationOutcome::Held => "held",
            FalsificationOutcome::Broken => "broken",
            _ => "unfinished",
        };
        ToldFalsification {
            outcome: outcome.to_owned(),
            counterexample: found.counterexample().map(str::to_owned),
            reports: found.report().into(),
        }
    }
}
