//! `sigmastar`: from bounding functions of a plant to a gain that provably works for every number of oscillators.
//!
//! The stages, in the order in which data flows through them:
//!
//! - [`spec`]: a bounding specification is read strictly, every number exact;
//! - [`expr`], [`number`], [`enclosure`]: bounding functions, exact numbers, rigorous interval arithmetic over MPFR;
//! - [`real`]: what enclosures and doubles have in common, so that every formula is written once;
//! - [`data`]: the numbers of a specification, enclosed at one precision;
//! - [`transfer`], [`derivation`]: the transfer bound, then the constants and conditions in three derivations;
//! - [`lmi`]: the linear matrix inequality of C5, proposed by a solver and verified exactly, as a cross-check;
//! - [`lyapunov`]: P_x(t) and the Lyapunov triple for a Jacobian, proposed by a solver and proved for every t;
//! - [`search`]: floating-point proposals for the free numbers (they decide nothing);
//! - [`certificate`]: rounding to short rationals, the rigorous decision, the certificate file;
//! - [`rate`]: rates of convergence for a given number of oscillators;
//! - [`report`], [`errata`]: what a person reads;
//! - [`regulator`], [`plant`], [`simulate`], [`reproduce`], [`falsify`]: the regulator itself, and floating-point
//!   simulations that show what a claim speaks of and try to break it; nothing rigorous depends on them;
//! - [`progress`]: how long work says that it goes on.
//!
//! Nothing below the command line knows it, and every arrow goes one way.

pub mod certificate;
pub mod data;
pub mod derivation;
pub mod enclosure;
pub mod errata;
pub mod expr;
pub mod falsify;
pub mod lmi;
pub mod lyapunov;
pub mod number;
pub mod plant;
pub mod plot;
pub mod progress;
pub mod rate;
pub mod real;
pub mod regulator;
pub mod report;
pub mod reproduce;
pub mod search;
pub mod simulate;
pub mod spec;
pub mod transfer;
