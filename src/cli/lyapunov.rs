//! `sigmastar lyapunov`.

use super::args::LyapunovArgs;
use super::failure::Failure;
use super::output::Shortened;
use super::subject::{Asked, Subject, seeking_triple};
use sigmastar_lang::plant::Plant;
use sigmastar_prove::certify::{Refusal, resolve};
use sigmastar_prove::reduction::study;
use sigmastar_report::{LyapunovReport, OrbitReport};

/// Runs the command and returns the exit code.
pub fn run(args: &LyapunovArgs) -> Result<u8, Failure> {
    let spec = match Asked::read(&args.spec)?.subject()? {
        Subject::Specification(spec) => spec,
        Subject::Plant(plant) => return of_plant(&plant, args),
    };
    let given = || {
        let message = "this specification gives its Lyapunov triple, and there is no Jacobian to find one for";
        Failure::call(message, "write \"lyapunov\": { \"jacobian\": [[...], ...] } in it")
    };
    let working = seeking_triple("", false);
    let resolution = resolve(&spec).ok_or_else(given)?;
    drop(working);
    let resolution =
        resolution.map_err(|failure| Failure::Documents(Refusal::Jacobian(failure.to_string()).errors(&spec)))?;
    let report = LyapunovReport::new(resolution).ok_or_else(given)?;
    Ok(Shortened::new(&report, args.format, args.full).show(false).err().unwrap_or(0))
}

/// The zero dynamics of a plant.
fn of_plant(plant: &Plant, args: &LyapunovArgs) -> Result<u8, Failure> {
    let study = study(plant).map_err(|refusal| Failure::Documents(refusal.errors(plant)))?;
    let report = OrbitReport { plant, study: &study };
    Ok(Shortened::new(&report, args.format, args.full).show(false).err().unwrap_or(0))
}
