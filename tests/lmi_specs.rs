//! C5 as a matrix inequality against its closed form, on the certificate of every shipped specification.

use rug::Rational;
use sigmastar::certificate::{Options, certify, resolve};
use sigmastar::data::Data;
use sigmastar::derivation::sharp::SharpWitness;
use sigmastar::lmi::cross_check;
use sigmastar::spec::Specification;
use std::path::{Path, PathBuf};

fn specifications() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("specs");
    let mut files: Vec<PathBuf> = std::fs::read_dir(root)
        .expect("the directory is part of the repository")
        .map(|entry| entry.expect("a directory entry").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "json"))
        .collect();
    files.sort();
    files
}

#[test]
fn the_matrix_inequality_confirms_every_certificate() {
    let files = specifications();
    let mut set_by_c5 = 0;
    for path in files {
        let spec = Specification::load(&path).unwrap_or_else(|e| panic!("{}", e.render(false)));
        let spec = match resolve(&spec) {
            Some(found) => found.expect("a triple").spec,
            None => spec,
        };
        let run = certify(&spec, Options { compare: false, ..Options::default() }).expect("not refuted");
        let proof = run.sharp.proved().expect("certified");
        let data = Data::new(&spec, proof.precision);
        let check = cross_check(&proof.evaluation, &proof.witness, &data).expect("solved");
        assert!(check.fixed.relative_difference <= 1e-6, "{}: {check:?}", path.display());
        // The search leaves nothing where C5 sets sigma*: no other weights in the same error box do with a smaller sigma.
        let free = check.free.as_ref().expect("solved");
        assert!(free.relative_difference <= 1e-6 && !check.contradicts(), "{}: {check:?}", path.display());
        let room = 1.0 - free.solver_sigma / check.fixed.solver_sigma;
        let by_c5 = check.fixed.closed_form.upper_f64() > 0.99 * proof.witness.sigma.to_f64();
        assert!(!by_c5 || room.abs() <= 1e-6, "{}: {room:e}", path.display());
        set_by_c5 += usize::from(by_c5);
        assert!(check.multipliers.is_some(), "{}: {check:?}", path.display());
        // Below the threshold nothing is verified.
        let below = check.fixed.closed_form.lower_rational().expect("bounded") * Rational::from((999_999, 1_000_000));
        let tampered = SharpWitness { sigma: below, ..proof.witness.clone() };
        let check = cross_check(&proof.evaluation, &tampered, &data).expect("solved");
        assert!(check.multipliers.is_none(), "{}: {check:?}", path.display());
    }
    assert!(set_by_c5 >= 10, "C5 sets sigma* on {set_by_c5} only");
}
