//! Every named constant in the three derivations, side by side.

mod common;
mod limits;
mod own;

use super::printed::{Infeasible, PrintedEvaluation};
use super::repaired::{RepairedEvaluation, RepairedWitness};
use super::sharp::{SharpEvaluation, SharpWitness};
use crate::data::Data;
use common::Common;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;

/// A value of the table.
#[derive(Clone, Debug)]
pub enum Value {
    /// A number, enclosed.
    Number(Enclosure),
    /// All numbers of an interval, enclosed.
    Span(Enclosure),
    /// The defining condition has no solution.
    Infeasible(String),
    /// There is no value here, for the stated reason.
    Unavailable(String),
}

/// What a value is worth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// A theorem rests on it: the derivation proves that it bounds what it says.
    Sound,
    /// Printed, and not proved (or refuted) for these data.
    PrintedUnsound,
    /// Printed, and without a solution.
    PrintedInfeasible,
}

impl Status {
    /// The word in certificates.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Status::Sound => "sound",
            Status::PrintedUnsound => "printed, unsound",
            Status::PrintedInfeasible => "printed, infeasible",
        }
    }
}

/// One cell of the table.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The value.
    pub value: Value,
    /// What it is worth.
    pub status: Status,
    /// The paper's label or the section of the derivation.
    pub source: &'static str,
}

/// One constant.
#[derive(Clone, Debug)]
pub struct Row {
    /// Its name.
    pub name: String,
    /// Where it is evaluated.
    pub at: At,
    /// As printed.
    pub printed: Option<Entry>,
    /// Repaired.
    pub repaired: Option<Entry>,
    /// Sharp.
    pub sharp: Option<Entry>,
}

/// Where a row is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum At {
    /// From the specification alone.
    Data,
    /// All three columns at X_p, E_p, sigma of the certificate, so that they differ by the formula only.
    Common,
    /// Each column at the free numbers that its own derivation found best.
    Own,
}

impl At {
    /// The word in certificates and reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            At::Data => "the data",
            At::Common => "X_p, E_p, sigma of the certificate",
            At::Own => "the free numbers of each derivation",
        }
    }
}

/// What the table is made from.
pub struct TableInput<'a> {
    /// The data.
    pub data: &'a Data<'a>,
    /// The derivation of the claim; the common rows are at its X_p, E_p, sigma.
    pub sharp: (&'a SharpWitness, &'a SharpEvaluation),
    /// The repaired one, when it was proved too.
    pub repaired: Option<(&'a RepairedWitness, &'a RepairedEvaluation)>,
    /// The printed evaluation at its own free numbers, when some were found.
    pub printed: Option<&'a PrintedEvaluation<Enclosure>>,
    /// The figure that the printed conditions but one would give.
    pub printed_sigma: Option<Enclosure>,
    /// sigma*_oo.
    pub sigma_exact: Option<Rational>,
}

fn number(value: Enclosure, status: Status, source: &'static str) -> Option<Entry> {
    Some(Entry { value: Value::Number(value), status, source })
}

fn sound(value: Enclosure, source: &'static str) -> Option<Entry> {
    number(value, Status::Sound, source)
}

/// A printed value: sound where it certainly dominates a sound one.
fn printed(value: Enclosure, dominates: &Enclosure, source: &'static str) -> Option<Entry> {
    let status = if value.ge(dominates).is_true() { Status::Sound } else { Status::PrintedUnsound };
    number(value, status, source)
}

fn infeasible(reason: &Infeasible, source: &'static str) -> Option<Entry> {
    Some(Entry { value: Value::Infeasible(reason.to_string()), status: Status::PrintedInfeasible, source })
}

fn row(name: &str, at: At, printed: Option<Entry>, repaired: Option<Entry>, sharp: Option<Entry>) -> Row {
    Row { name: name.to_owned(), at, printed, repaired, sharp }
}

/// Builds the table.
#[must_use]
pub fn table(input: &TableInput<'_>) -> Vec<Row> {
    let data = input.data;
    let common = Common::new(input);
    let mut rows = common::gain_rows(data, &common);
    rows.extend(common::contraction_rows(data, &common));
    rows.extend(common::transfer_rows(data, &common));
    rows.extend(limits::size_rows(data, &common));
    rows.extend(own::own_rows(input));
    // A derivation that found nothing leaves some rows without any entry.
    rows.retain(|row| row.printed.is_some() || row.repaired.is_some() || row.sharp.is_some());
    rows
}
