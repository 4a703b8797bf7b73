//! The Lyapunov triple of a Jacobian, and the zero dynamics of a plant.

use super::error::{Error, ErrorKind};
use super::report::Report;
use super::subject::Subject;
use sigmastar_prove::certify::{Refusal, resolve};
use sigmastar_prove::reduction::{Subject as Read, study};
use sigmastar_report::{LyapunovReport, OrbitReport};

/// Finds and proves the Lyapunov triple of a specification with a Jacobian, or the orbit of a plant with coordinates in which it
/// contracts. The report is that of `sigmastar lyapunov`, and has every number.
///
/// # Errors
/// [`Options`](ErrorKind::Options) for a specification that gives its triple; [`Undecided`](ErrorKind::Undecided) where nothing was
/// found or proved.
pub fn lyapunov(subject: impl Into<Subject>) -> Result<Report, Error> {
    lyapunov_of(&subject.into().read)
}

/// [`lyapunov`] of a document that was read.
///
/// # Errors
/// Those of [`lyapunov`].
pub fn lyapunov_of(subject: &Read) -> Result<Report, Error> {
    let spec = match subject {
        Read::Specification(spec) => spec,
        Read::Plant(plant) => {
            let study = study(plant).map_err(|refusal| Error::documents(&refusal.errors(plant)))?;
            return Ok(Report::of(&OrbitReport { plant, study: &study }));
        }
    };
    let given = || {
        let message = "this specification gives its Lyapunov triple, and there is no Jacobian to find one for";
        Error::new(ErrorKind::Options, message, "write \"lyapunov\": { \"jacobian\": [[...], ...] } in it")
    };
    let resolution = resolve(spec).ok_or_else(given)?;
    let resolution =
        resolution.map_err(|failure| Error::documents(&Refusal::Jacobian(failure.to_string()).errors(spec)))?;
    Ok(Report::of(&LyapunovReport::new(resolution).ok_or_else(given)?))
}
