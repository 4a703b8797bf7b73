//! `sigmastar`: from bounding functions of a plant to a gain that provably works for every number of oscillators.
//!
//! A [`Specification`] says what is known of a plant, and a [`Subject`] is one or a plant by its formulas; [`certify`] finds a
//! small gain and proves that it works, and [`check`] decides the [`Certificate`] again with code of its own.
//! [`transfer_bound`] proves the transfer bound by itself,
//! [`regulator_matrices`] and [`sampled_regulator`] give the regulator, a [`Study`] is many cases. [`reread`] decides a stored certificate
//! again, [`design`] proves a table of gains and numbers of oscillators beside what is required, [`bounding_specification`] bounds a plant, [`sampling`] finds pairs of a gain and a sampling period, [`lyapunov`] a
//! triple. What goes wrong is an [`Error`] with a [`kind`](Error::kind).
//!
//! From the text of a file to a claim that others can check:
//!
//! ```
//! use sigmastar::{CertifyOptions, Specification, certify, check_against};
//!
//! # fn main() -> Result<(), sigmastar::Error> {
//! let text = include_str!("../specs/linear.json");
//! let specification = Specification::from_json(text)?;
//! let certificate = certify(&specification, &CertifyOptions::new())?;
//! println!("{}", certificate.claim().statement());
//! println!("sigma* = {}", certificate.claim().sigma_star());
//! assert!(check_against(certificate.to_json(), &specification).is_valid());
//! # Ok(())
//! # }
//! ```
//!
//! The same without a file, and on to the regulator:
//!
//! ```
//! use sigmastar::{BoundingFunction as Bound, CertifyOptions, ErrorKind, Specification, certify, check_against};
//!
//! # fn main() -> Result<(), sigmastar::Error> {
//! let specification = Specification::builder("linear zero dynamics")
//!     .period("1")
//!     .lyapunov("1", "1.5512", "0.58")
//!     .bound(Bound::F, "2*X + E/2")
//!     .bound(Bound::Fe, "1/2")
//!     .bound(Bound::Fxx, "0")
//!     .bound(Bound::Fex, "0")
//!     .bound(Bound::Q, "3 + X + E/4")
//!     .bound(Bound::Qe, "1/4")
//!     .bound(Bound::Qx, "1")
//!     .bound(Bound::Qt, "20")
//!     .mu("1")
//!     .matched_base_frequency("2*pi")
//!     .power_weights("2", "1/2")
//!     .initial_set_of_the_paper()
//!     .build()?;
//!
//! let certificate = certify(&specification, &CertifyOptions::new())?;
//! let claim = certificate.claim();
//! println!("{}", claim.statement());
//! assert!(certificate.conditions().iter().all(|condition| condition.holds() == Some(true)));
//!
//! // The text of the certificate can be stored, and checked by whoever has the specification.
//! assert!(check_against(certificate.to_json(), &specification).is_valid());
//!
//! // The regulator with the certified gain and 4 oscillators: 9 states.
//! let regulator = sigmastar::regulator_matrices(&specification, claim.sigma_star(), 4)?;
//! assert_eq!(regulator.phi.len(), 9);
//!
//! let error = sigmastar::regulator_matrices(&specification, "-1", 4).unwrap_err();
//! assert_eq!(error.kind(), ErrorKind::Range);
//! # Ok(())
//! # }
//! ```
//!
//! Numbers go in and come out as exact text (`"47.2233"`, `"1/3"`, `"2*pi"`); doubles are rounded to the side that is stated
//! with them. Nothing here reads files, prints or exits. What is not on this page is not part of the interface.
//!
//! The feature `cli`, on by default, is for the program alone: a library user turns it off with
//! `default-features = false`. With the feature `lab` there are `simulate` and `falsify`, which are floating point and claim nothing.

#![deny(missing_docs)]
// What tests compare with need not be the same on every machine.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

mod api;

#[doc(hidden)]
pub use api::program;
pub use api::{
    BoundedPlant, BoundingFunction, Certificate, CertifyOptions, CheckReport, CheckVerdict, Claim, ClaimedBounds,
    ClaimedRate, Condition, Design, DesignOptions, Diagnostic, Error, ErrorKind, InitialSet, JacobianEntry,
    OscillatorShare, PeriodicSolution, RegulatorMatrices, Report, ReportFormat, SampledRegulator, Samples,
    SamplingPairs, Specification, SpecificationBuilder, Study, StudyCase, Subject, TransferBound, TransferChoice,
    TransferOptions, TransferStudy, TuneGoal, TuneOptions, Tuned, VERSION, Verdict, bounding_specification, certify,
    certify_telling, check, check_against, design, design_telling, lyapunov, regulator_matrices, reread,
    sampled_regulator, sampling, transfer_bound, transfer_study, tune,
};
#[cfg(feature = "lab")]
pub use api::{Falsification, FalsificationOutcome, Simulation, SimulationOptions, falsify, simulate};
